//! The map file: a [`GlobalMap`] as JSON.
//!
//! One object, format 1:
//!
//! ```json
//! {"format":1,"generator":"covimap 0.1.0","method":"auto","seed":0,"settings":{"classical":{}},"landmarks":[
//! {"id":"L6","x":0.25,"y":-1.5,"component":0,"region":0,"sightings":412,"partners":9}
//! ],"report":{"steps":5768}}
//! ```
//!
//! A map that knows its sensor has more: `detectability` and `deviation` of each landmark, and after
//! the landmarks `"sensors":[{"range":0.5,"edge":0.04,"detectability":0.93,"outliers":0.001}]`, one a
//! component, and `"occluded":[[0,12]]`, pairs of places in the list of landmarks; see [`Sensing`].
//!
//! A landmark takes a line, so that `diff` and `grep` work. The bytes depend on the map alone.
//! Numbers have the fewest digits that read back as the same number: a map that is saved and
//! loaded is equal, and a file that is loaded and saved has the same bytes.
//!
//! A reader ignores keys that it does not know, so that a later covimap can add some without a
//! new format number.
//!
//! # Failure
//! A file of another format, without a required key, with a coordinate that is no finite number
//! or with an ID that stands there twice is refused; nothing is guessed.

use std::borrow::Cow;
use std::fs;
use std::io::{self, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::{Map, Value};

use crate::{
    BuildReport, GlobalMap, LandmarkId, LandmarkNames, MapError, MapperParams, PlacedLandmark, Sensing,
    SensorModel, output,
};

/// Format number that this build writes and reads.
const FORMAT: u64 = 1;

/// Settings that stand at the top level of the file instead of inside `settings`.
const TOP_LEVEL: [&str; 2] = ["method", "seed"];

#[derive(Serialize, Deserialize)]
struct Row<'a> {
    #[serde(borrow)]
    id: Cow<'a, str>,
    x: f64,
    y: f64,
    component: u32,
    region: u32,
    sightings: u32,
    partners: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    detectability: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    deviation: Option<f64>,
}

#[derive(Deserialize)]
struct Contents<'a> {
    method: Value,
    seed: u64,
    settings: Map<String, Value>,
    #[serde(borrow)]
    landmarks: Vec<Row<'a>>,
    #[serde(default)]
    sensors: Vec<SensorModel>,
    #[serde(default)]
    occluded: Vec<[u32; 2]>,
    report: BuildReport,
}

#[derive(Deserialize)]
struct Header {
    format: u64,
}

impl GlobalMap {
    /// Writes the map file at `path`, whole or not at all; `-` is standard output.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when the path cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), MapError> {
        output::write_whole(path, |out| self.write_json(out))
    }

    /// Writes the text of the map file, a landmark at a time.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_json(&self, mut out: &mut dyn Write) -> io::Result<()> {
        let mut settings = object(self.params())?;
        let [method, seed] = TOP_LEVEL.map(|key| settings.remove(key).unwrap_or_default());
        let generator = format!("covimap {}", env!("CARGO_PKG_VERSION"));
        write!(
            out,
            "{{\"format\":{FORMAT},\"generator\":\"{generator}\",\"method\":{method},\"seed\":{seed}"
        )?;
        write!(out, ",\"settings\":{},\"landmarks\":[", Value::Object(settings))?;
        for (index, (id, placed)) in self.names().iter().zip(self.landmarks()).enumerate() {
            out.write_all(if index == 0 { b"\n" } else { b",\n" })?;
            let row = Row::new(id, placed).with_sensing(self.sensing(), LandmarkId(index as u32));
            serde_json::to_writer(&mut out, &row)?;
        }
        if let Some(sensing) = self.sensing() {
            out.write_all(b"\n],\"sensors\":")?;
            serde_json::to_writer(&mut out, sensing.sensors())?;
            out.write_all(b",\"occluded\":[")?;
            for (index, [a, b]) in sensing.occluded_pairs().enumerate() {
                write!(out, "{}[{a},{b}]", if index == 0 { "" } else { "," })?;
            }
        }
        out.write_all(b"\n],\"report\":")?;
        serde_json::to_writer(&mut out, self.report())?;
        out.write_all(b"}\n")
    }

    /// Reads the map file at `path`; `-` is standard input.
    ///
    /// # Errors
    /// [`MapError::Io`] when the file cannot be read, else those of [`GlobalMap::parse_json`].
    pub fn load(path: &Path) -> Result<Self, MapError> {
        let (bytes, name) = if path == Path::new("-") {
            let mut bytes = Vec::new();
            (io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes), "<stdin>".to_owned())
        } else {
            (fs::read(path), path.display().to_string())
        };
        let bytes = bytes.map_err(|source| MapError::Io {
            path: path.to_owned(),
            what: "cannot be read; give a map file, as `covimap build` writes it".to_owned(),
            source,
        })?;
        Self::parse_json(&bytes, &name)
    }

    /// Reads the text of a map file; `file` is what errors call it.
    ///
    /// # Errors
    /// [`MapError::MapFormat`] for a file of another format, [`MapError::BadLine`] for text that is no
    /// map file (line of the first fault), [`MapError::InvalidMap`] for landmarks that contradict each other.
    pub fn parse_json(text: &[u8], file: &str) -> Result<Self, MapError> {
        let header: Header = parse(text, file)?;
        if header.format != FORMAT {
            return Err(MapError::MapFormat { file: file.to_owned(), found: header.format, known: FORMAT });
        }
        let contents: Contents = parse(text, file)?;
        let mut settings = contents.settings;
        settings
            .extend(TOP_LEVEL.map(str::to_owned).into_iter().zip([contents.method, contents.seed.into()]));
        let params = known_settings(settings).map_err(|error| MapError::InvalidMap {
            what: format!("{file}: the settings cannot be read, {error}; build the map again"),
        })?;
        let mut names = LandmarkNames::default();
        let mut landmarks = Vec::with_capacity(contents.landmarks.len());
        for row in &contents.landmarks {
            names.push(&row.id);
            landmarks.push(row.placed());
        }
        let map = Self::from_parts(names, landmarks, params, contents.report);
        let map = if contents.sensors.is_empty() {
            map
        } else {
            // A number that is missing is as bad as one out of its range.
            let column = |of: fn(&Row) -> Option<f64>| {
                contents.landmarks.iter().map(|row| of(row).unwrap_or(f64::NAN)).collect()
            };
            let (detectability, deviation) = (column(|row| row.detectability), column(|row| row.deviation));
            Sensing::from_parts(contents.sensors, detectability, deviation, &contents.occluded)
                .and_then(|sensing| map?.with_sensing(sensing))
        };
        map.map_err(|error| match error {
            MapError::InvalidMap { what } => MapError::InvalidMap { what: format!("{file}: {what}") },
            other => other,
        })
    }
}

impl<'a> Row<'a> {
    fn new(id: &'a str, placed: &PlacedLandmark) -> Self {
        let [x, y] = placed.position;
        let PlacedLandmark { component, region, sightings, partners, .. } = *placed;
        let (detectability, deviation) = (None, None);
        let id = Cow::Borrowed(id);
        Self { id, x, y, component, region, sightings, partners, detectability, deviation }
    }

    fn with_sensing(self, sensing: Option<&Sensing>, id: LandmarkId) -> Self {
        let Some(sensing) = sensing else { return self };
        let (detectability, deviation) = (sensing.detectability(id), sensing.deviation(id));
        Self { detectability: Some(detectability), deviation: Some(deviation), ..self }
    }

    fn placed(&self) -> PlacedLandmark {
        let Self { x, y, component, region, sightings, partners, .. } = *self;
        PlacedLandmark { position: [x, y], component, region, sightings, partners }
    }
}

fn object(params: &MapperParams) -> serde_json::Result<Map<String, Value>> {
    serde_json::from_value(serde_json::to_value(params)?)
}

/// Settings without the keys that this build does not know.
fn known_settings<T: DeserializeOwned + Serialize + Default>(
    settings: Map<String, Value>,
) -> serde_json::Result<T> {
    let mut settings = Value::Object(settings);
    retain_known(&mut settings, &serde_json::to_value(T::default())?);
    serde_json::from_value(settings)
}

fn retain_known(value: &mut Value, pattern: &Value) {
    if let (Value::Object(value), Value::Object(pattern)) = (value, pattern) {
        value.retain(|key, _| pattern.contains_key(key));
        for (key, inner) in value {
            retain_known(inner, &pattern[key]);
        }
    }
}

fn parse<'a, T: Deserialize<'a>>(text: &'a [u8], file: &str) -> Result<T, MapError> {
    serde_json::from_slice(text).map_err(|error| {
        // The position stands in front of our message already.
        let text = error.to_string();
        let what = text.split(" at line ").next().unwrap_or(&text);
        let line = error.line().max(1) as u64;
        let what = format!("not a whole map file, {what}; give a file that `covimap build` wrote");
        MapError::BadLine { file: file.to_owned(), line, what }
    })
}

#[cfg(test)]
mod tests;
