//! The map file: a [`GlobalMap`] as JSON, or in fewer bytes (see [`binary`]).
//!
//! A file whose name ends in `.covimap` is written in the binary form, any other as JSON. A reader
//! tells the two apart by their first bytes.
//!
//! JSON is one object, format 1:
//!
//! ```json
//! {"format":1,"generator":"covimap 0.1.0","method":"auto","seed":0,"settings":{"classical":{}},"landmarks":[
//! {"id":"L6","x":0.25,"y":-1.5,"component":0,"region":0,"sightings":412,"partners":9,"links":[[1,40]],"branch":0,"loose":false},
//! {"id":"L9","x":0.5,"y":-1.25,"component":0,"region":0,"sightings":377,"partners":7,"branch":0,"loose":false}
//! ],"report":{"steps":5768}}
//! ```
//!
//! `links` are the lines of sight ([`crate::SightLines`]) to landmarks that come later: the number of the
//! other landmark, counted from 0 in the order of the file, and the steps that show both. A row without
//! any has no such key, and neither has an older file. A map in a frame known from outside has the key
//! `alignment` ([`ChartFit`]) before `landmarks`.
//! A map that knows its sensor has more: `detectability`, `deviation` and `warp` of each landmark, and after
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

use crate::state;
use crate::{
    BuildReport, ChartFit, GlobalMap, LandmarkId, LandmarkNames, MapError, MapperParams, PlacedLandmark,
    Sensed, Sensing, SensorModel, SightLines, output,
};

mod binary;

use binary::BINARY_EXTENSION;

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
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    links: Vec<(u32, u32)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    detectability: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    deviation: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    warp: Option<f64>,
    #[serde(default)]
    branch: u32,
    #[serde(default)]
    loose: bool,
}

#[derive(Deserialize)]
struct Contents<'a> {
    method: Value,
    seed: u64,
    settings: Map<String, Value>,
    #[serde(default)]
    alignment: Vec<ChartFit>,
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
    /// Writes the map file at `path`, whole or not at all; `-` is standard output. A name that ends in
    /// `.covimap` takes the binary form, which loads fastest; any other JSON.
    ///
    /// # Errors
    /// [`MapError::Unwritable`] when the path cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), MapError> {
        output::write_whole(path, |out| self.write_as(path, out))
    }

    /// Writes the map in the form that a file at `path` has.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_as(&self, path: &Path, out: &mut dyn Write) -> io::Result<()> {
        if path.extension().is_some_and(|extension| extension == BINARY_EXTENSION) {
            self.write_binary(out)
        } else {
            self.write_json(out)
        }
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
        write!(out, ",\"settings\":{}", Value::Object(settings))?;
        if !self.alignment().is_empty() {
            write!(out, ",\"alignment\":{}", serde_json::to_string(self.alignment())?)?;
        }
        out.write_all(b",\"landmarks\":[")?;
        for number in (0..self.len() as u32).map(LandmarkId) {
            out.write_all(if number.0 == 0 { b"\n" } else { b",\n" })?;
            serde_json::to_writer(&mut out, &Row::new(self, number))?;
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

    /// Reads the map file at `path`, JSON or binary; `-` is standard input.
    ///
    /// # Errors
    /// [`MapError::Io`] when the file cannot be read, [`MapError::DamagedMap`] for a binary file that is not
    /// as it was written, else those of [`GlobalMap::parse_json`].
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
        if binary::is_binary(&bytes) {
            Self::parse_binary(&bytes, &name)
        } else {
            Self::parse_json(&bytes, &name)
        }
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
        let mut names = LandmarkNames::default();
        let mut landmarks = Vec::with_capacity(contents.landmarks.len());
        let mut links = Vec::new();
        for (number, row) in (0..).map(LandmarkId).zip(&contents.landmarks) {
            names.push(&row.id);
            landmarks.push(row.placed());
            links.extend(row.links.iter().map(|&(to, steps)| (number, LandmarkId(to), steps)));
        }
        let sensed = contents.landmarks.iter().map(Row::sensed).collect();
        let parts = Parts { names, landmarks, sensed, links };
        let Contents { report, alignment, sensors, occluded, .. } = contents;
        let head = Head { settings, report, alignment, sensors, occluded, sensed: SENSED };
        head.complete(parts).map_err(|error| in_file(error, file))
    }
}

/// What a map file says of the map as a whole, in either form.
#[derive(Serialize, Deserialize)]
struct Head {
    settings: Map<String, Value>,
    report: BuildReport,
    alignment: Vec<ChartFit>,
    /// None if the map does not know its sensor.
    sensors: Vec<SensorModel>,
    occluded: Vec<[u32; 2]>,
    /// How many numbers of [`Sensed`] the binary form has: the warp came last.
    #[serde(default = "without_warp")]
    sensed: usize,
}

/// Numbers of [`Sensed`].
const SENSED: usize = 3;

fn without_warp() -> usize {
    SENSED - 1
}

/// What a map file says of the landmarks, in either form.
struct Parts {
    names: LandmarkNames,
    landmarks: Vec<PlacedLandmark>,
    /// Of no meaning without sensors.
    sensed: Vec<Sensed>,
    links: Vec<(LandmarkId, LandmarkId, u32)>,
}

impl Head {
    fn complete(self, parts: Parts) -> Result<GlobalMap, MapError> {
        let params = known_settings(self.settings).map_err(|error| MapError::InvalidMap {
            what: format!("the settings cannot be read, {error}; build the map again"),
        })?;
        let Parts { names, landmarks, sensed, links } = parts;
        let lines = SightLines::from_pairs(names.len(), links)?;
        let mut map =
            GlobalMap::from_parts(names, landmarks, params, self.report)?.with_sight_lines(lines)?;
        if !self.sensors.is_empty() {
            map = map.with_sensing(Sensing::from_parts(self.sensors, sensed, &self.occluded)?)?;
        }
        map.alignment = self.alignment;
        Ok(map)
    }
}

/// Parts that contradict each other, with the name of the file that holds them.
fn in_file(error: MapError, file: &str) -> MapError {
    match error {
        MapError::InvalidMap { what } => MapError::InvalidMap { what: format!("{file}: {what}") },
        other => other,
    }
}

impl<'a> Row<'a> {
    fn new(map: &'a GlobalMap, number: LandmarkId) -> Self {
        let PlacedLandmark { position: [x, y], component, region, sightings, partners, branch, loose } =
            map.landmarks()[number.index()];
        let later = map.sight_lines().of(number).iter().filter(|line| line.to > number);
        let sensed = map.sensing().map(|sensing| *sensing.of(number));
        Self {
            id: Cow::Borrowed(map.names().name(number)),
            x,
            y,
            component,
            region,
            sightings,
            partners,
            links: later.map(|line| (line.to.0, line.steps)).collect(),
            detectability: sensed.map(|sensed| sensed.detectability),
            deviation: sensed.map(|sensed| sensed.deviation),
            warp: sensed.map(|sensed| sensed.warp),
            branch,
            loose,
        }
    }

    /// A number that is missing is as bad as one out of its range, save for the warp.
    fn sensed(&self) -> Sensed {
        let [detectability, deviation] = [self.detectability, self.deviation].map(|n| n.unwrap_or(f64::NAN));
        Sensed { detectability, deviation, warp: self.warp.unwrap_or(0.0) }
    }

    fn placed(&self) -> PlacedLandmark {
        let Self { x, y, component, region, sightings, partners, branch, loose, .. } = *self;
        PlacedLandmark { position: [x, y], component, region, sightings, partners, branch, loose }
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

fn parse<'a, T: Deserialize<'a>>(bytes: &'a [u8], file: &str) -> Result<T, MapError> {
    serde_json::from_slice(bytes).map_err(|error| {
        // The position stands in front of our message already.
        let text = error.to_string();
        let what = text.split(" at line ").next().unwrap_or(&text);
        let line = error.line().max(1) as u64;
        let what = if state::is_state(bytes) {
            "this is a state, not a map; give the map that was written with it (`-o`)".to_owned()
        } else {
            format!("not a whole map file, {what}; give a file that `covimap build` wrote")
        };
        MapError::BadLine { file: file.to_owned(), line, what }
    })
}

#[cfg(test)]
mod tests;
