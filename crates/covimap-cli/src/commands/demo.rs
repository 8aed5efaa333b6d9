//! `covimap demo`: a real robot log that is built in, mapped and compared with the survey.

use std::path::{Path, PathBuf};

use covimap_embed::{Correspondence, Point, ProcrustesOptions, procrustes};
use covimap_map::evaluate::{self, EvaluateParams};
use covimap_map::export::{self, SvgParams};
use covimap_map::{GlobalMap, LogFormat, Mapper, MapperParams, Method, SightingLog, Silent, Truth, output};

use super::evaluate::errors;
use crate::bundled::{PAPER_TRIAL, ROBOT_LOG, ROBOT_TRUTH};
use crate::console::{self, Console};
use crate::interrupt::Deferral;
use crate::options::ThreadArgs;
use crate::{summary, table};

/// Map a real robot log that is built in and compare the map with the survey
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Map the ten sightings printed in the CoviMap paper instead; nobody surveyed them
    #[arg(long)]
    paper: bool,
    /// Where the picture goes
    #[arg(short, long, value_name = "OUT.svg", default_value = "covimap-demo.svg")]
    output: PathBuf,
    #[command(flatten)]
    threads: ThreadArgs,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        self.threads.start()?;
        if self.paper {
            paper(&self.output)?
        } else {
            robot(&self.output)?
        }
        console.say(format_args!("picture written to {}", self.output.display()));
        Ok(())
    }
}

fn robot(picture: &Path) -> anyhow::Result<()> {
    let log = SightingLog::read_from(ROBOT_LOG, "mrclam-1.jsonl", Some(LogFormat::Jsonl), &Silent)?;
    let truth = Truth::parse(ROBOT_TRUTH, "mrclam-1.truth.csv")?;
    let [auto, classical] = [map(&log, Method::Auto)?, map(&log, Method::Classical)?];
    let mut params = SvgParams::default();
    params.title = Some("Five camera robots among 15 barcoded posts".to_owned());
    params.truth = Some(&truth);
    draw(&auto, &params, picture)?;
    Ok(console::print(format_args!(
        "Five camera robots among 15 barcoded posts (UTIAS MRCLAM 1). The log says which posts a robot\n\
         saw together, step by step, and nothing else: no range, no bearing, no pose.\n\n\
         {}\n\n{}\n\n{}",
        summary::of(auto.report()),
        positions_beside(&auto, &truth)?,
        errors_of([("auto", &auto), ("classical", &classical)], &truth)?,
    ))?)
}

fn paper(picture: &Path) -> anyhow::Result<()> {
    let log = SightingLog::read_from(PAPER_TRIAL, "paper-trial-1.jsonl", Some(LogFormat::Jsonl), &Silent)?;
    let auto = map(&log, Method::Auto)?;
    let mut params = SvgParams::default();
    params.title = Some("Ten looks at six coloured cylinders".to_owned());
    draw(&auto, &params, picture)?;
    Ok(console::print(format_args!(
        "Ten looks of a robot at six coloured cylinders (CoviMap paper, table V a, trial 1).\n\n{}\n\n{}",
        summary::of(auto.report()),
        positions(&auto),
    ))?)
}

fn map(log: &SightingLog, method: Method) -> anyhow::Result<GlobalMap> {
    let mut params = MapperParams::default();
    params.method = method;
    Ok(Mapper::new(params)?.build(log, &Silent)?)
}

fn draw(map: &GlobalMap, params: &SvgParams<'_>, picture: &Path) -> anyhow::Result<()> {
    let text = export::svg(map, params)?;
    let _deferral = Deferral::of_writing();
    Ok(output::write_whole(picture, |out| out.write_all(text.as_bytes()))?)
}

/// Landmarks with their positions in map units.
fn positions(map: &GlobalMap) -> String {
    let header = table::row(["landmark", "seen", "partners", "x", "y"]);
    let row = |(id, placed): (&str, &covimap_map::PlacedLandmark)| {
        let [x, y] = placed.position;
        let (seen, partners) = (placed.sightings, placed.partners);
        vec![id.to_owned(), seen.to_string(), partners.to_string(), format!("{x:.3}"), format!("{y:.3}")]
    };
    let rows: Vec<_> = [header].into_iter().chain(map.names().iter().zip(map.landmarks()).map(row)).collect();
    table::render(&rows)
}

/// The map laid over the survey: where each landmark came to lie, where it is, and how far off.
fn positions_beside(map: &GlobalMap, truth: &Truth) -> anyhow::Result<String> {
    let surveyed = |id: &str| truth.names().iter().position(|name| name == id).map(|k| truth.positions()[k]);
    let shared: Vec<(&str, u32, Point, Point)> = map
        .names()
        .iter()
        .zip(map.landmarks())
        .filter_map(|(id, placed)| Some((id, placed.sightings, placed.position, surveyed(id)?)))
        .collect();
    let pairs: Vec<_> =
        shared.iter().map(|&(_, _, source, target)| Correspondence { source, target, weight: 1.0 }).collect();
    let truth_from_map = procrustes(&pairs, ProcrustesOptions::default())?.target_from_source;
    let header = table::row(["landmark", "seen", "map x", "y", "survey x", "y", "off by (m)"]);
    let row = |(id, seen, source, target): (&str, u32, Point, Point)| {
        let found = truth_from_map.apply(source);
        let off = (found[0] - target[0]).hypot(found[1] - target[1]);
        let metres = [found[0], found[1], target[0], target[1], off].map(|value| format!("{value:.2}"));
        [id.to_owned(), seen.to_string()].into_iter().chain(metres).collect()
    };
    let rows: Vec<_> = [header].into_iter().chain(shared.into_iter().map(row)).collect();
    Ok(table::render(&rows))
}

/// The errors of several maps side by side.
fn errors_of<const N: usize>(maps: [(&str, &GlobalMap); N], truth: &Truth) -> anyhow::Result<String> {
    let mut rows = vec![table::row(["error against the survey"])];
    for (method, map) in maps {
        let found = errors(&evaluate::against(map, truth, &EvaluateParams::default())?);
        rows[0].push(method.to_owned());
        rows.resize_with(found.len() + 1, Vec::new);
        for (row, (name, value)) in rows[1..].iter_mut().zip(found) {
            if row.is_empty() {
                row.push(name.to_owned());
            }
            row.push(value);
        }
    }
    Ok(table::render(&rows))
}
