//! The trial with a real robot: its first ten lists, as far as the paper prints them.
//!
//! Nobody published where the cylinders stood, so the maps can be looked at but not judged.

use std::io::{self, Write};

use covimap_map::export::{self, SvgParams};
use covimap_map::{GlobalMap, LogFormat, MapError, Mapper, SightingLog, Silent};

use super::experiment::MapMethod;
use crate::bundled::PAPER_TRIAL;

/// Name of the experiment on the command line and of its files.
pub const NAME: &str = "exp";

/// The maps of the trial by the paper's method and by `auto`.
pub struct Trial {
    maps: [(MapMethod, GlobalMap); 2],
}

impl Trial {
    /// Maps the lists.
    ///
    /// # Errors
    /// None but for bugs: the log is built in.
    pub fn new() -> Result<Self, MapError> {
        let log =
            SightingLog::read_from(PAPER_TRIAL, "paper-trial-1.jsonl", Some(LogFormat::Jsonl), &Silent)?;
        let map = |method: MapMethod| Mapper::new(method.params())?.build(&log, &Silent);
        let maps = [(MapMethod::PAPER, map(MapMethod::PAPER)?), (MapMethod::Auto, map(MapMethod::Auto)?)];
        Ok(Self { maps })
    }

    /// A picture of each map: name of its file and SVG.
    ///
    /// # Errors
    /// Those of the export.
    pub fn pictures(&self) -> Result<Vec<(String, String)>, MapError> {
        let picture = |(method, map): &(MapMethod, GlobalMap)| {
            let mut params = SvgParams::default();
            params.title = Some(format!("Ten looks of the paper's robot, {}", method.label()));
            Ok((format!("{NAME}-{}.svg", method.label()), export::svg(map, &params)?))
        };
        self.maps.iter().map(picture).collect()
    }

    /// Writes a row for each method and landmark.
    ///
    /// # Errors
    /// What the output says.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "experiment,method,landmark,sightings,x,y")?;
        for (method, map) in &self.maps {
            for (id, landmark) in map.names().iter().zip(map.landmarks()) {
                let [x, y] = landmark.position;
                writeln!(out, "{NAME},{},{id},{},{x:.5},{y:.5}", method.label(), landmark.sightings)?;
            }
        }
        Ok(())
    }

    /// The positions side by side, in Markdown.
    pub fn table(&self) -> String {
        let mut text =
            "| landmark | sightings | classical x | y | auto x | y |\n|---|---:|---:|---:|---:|---:|\n"
                .to_owned();
        let [(_, classical), (_, auto)] = &self.maps;
        for ((id, theirs), ours) in classical.names().iter().zip(classical.landmarks()).zip(auto.landmarks())
        {
            let ([a, b], [c, d]) = (theirs.position, ours.position);
            text += &format!("| {id} | {} | {a:.2} | {b:.2} | {c:.2} | {d:.2} |\n", theirs.sightings);
        }
        text
    }
}
