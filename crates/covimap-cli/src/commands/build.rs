//! `covimap build`: the main job, a log in and a map out.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use covimap_embed::DistanceFamily;
use covimap_map::{
    DistanceChoice, GlobalMap, LogFormat, MapError, MapState, Mapper, MapperParams, MemoryEstimate, Method,
    Phi, SightingLog, Stage, output::Output,
};

use crate::console::{self, Console};
use crate::interrupt::Deferral;
use crate::options::{LogArgs, ThreadArgs, conflict, size};
use crate::progress::{self, Progress};
use crate::summary;

/// Make a map from one or more logs
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: LogArgs,
    /// Where the map goes; `-` is stdout [default: the log's name with .map.json, in this folder]
    #[arg(short, long, value_name = "MAP.json")]
    output: Option<PathBuf>,
    /// Also write what `covimap update` needs to add steps to the map later
    #[arg(long, value_name = "STATE")]
    state: Option<PathBuf>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    threads: ThreadArgs,
    /// Refuse a log whose map would take more memory than this, such as 800M or 4G [default: no limit]
    #[arg(long, value_name = "SIZE", value_parser = size)]
    max_memory: Option<u64>,
    /// Print the report as one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Debug, clap::Args)]
struct Settings {
    /// Estimator
    #[arg(long, value_enum, value_name = "METHOD", default_value = "auto")]
    method: MethodName,
    /// Seed of every random choice
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Auto only: distance function, fitted to the log [default: auto, the family that foretells it best]
    #[arg(long, value_enum, value_name = "FAMILY")]
    distance: Option<DistanceName>,
    /// Auto only: make an ID that is seen in several places as many landmarks, A#1, A#2 and so on
    #[arg(long)]
    split_aliases: bool,
    /// Classical only: distance function [default: phi2]
    #[arg(long, value_enum, value_name = "PHI")]
    phi: Option<PhiName>,
    /// Classical only: factor of the distance function [default: 0.05 for phi1, 0.3 for phi2]
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    alpha: Option<f64>,
    /// Classical only: smallest squared distance [default: 0.1]
    #[arg(long, value_name = "D2", allow_negative_numbers = true)]
    lo: Option<f64>,
    /// Classical only: largest squared distance, that of a pair never seen together [default: 2]
    #[arg(long, value_name = "D2", allow_negative_numbers = true)]
    hi: Option<f64>,
    /// Classical only: no triangle-inequality constraint
    #[arg(long)]
    no_tic: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum MethodName {
    /// Regions, local maps, stitching and polish: the best there is, at any size
    Auto,
    /// The CoviMap paper to the letter: dense, for small logs and comparison
    Classical,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum DistanceName {
    /// The family that foretells held-out counts best
    Auto,
    /// sqrt(-0.3 ln f), not fitted
    FixedLog,
    /// f = f0 exp(-(d/a)^2)
    Log,
    /// 1/f = 1/f0 + (d/a)^2
    Inverse,
    /// A sensor with a sharp range
    Lens,
    /// f = f0 exp(-(d/a)^c)
    Power,
    /// A rising spline for -ln f
    Spline,
    /// Any falling curve
    Isotonic,
}

impl From<DistanceName> for DistanceChoice {
    fn from(name: DistanceName) -> Self {
        match name {
            DistanceName::Auto => Self::Auto,
            DistanceName::FixedLog => Self::FixedLog,
            DistanceName::Log => Self::Family(DistanceFamily::Log),
            DistanceName::Inverse => Self::Family(DistanceFamily::Inverse),
            DistanceName::Lens => Self::Family(DistanceFamily::Lens),
            DistanceName::Power => Self::Family(DistanceFamily::Power),
            DistanceName::Spline => Self::Family(DistanceFamily::Spline),
            DistanceName::Isotonic => Self::Family(DistanceFamily::Isotonic),
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PhiName {
    /// alpha (1/f - 1)
    Phi1,
    /// -alpha ln f
    Phi2,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let params = self.settings.params()?;
        let mapper = Mapper::new(params.clone())?;
        let path = self.output.clone().unwrap_or_else(|| default_output(&self.input.logs[0]));
        self.check_output(&path)?;
        self.threads.start()?;

        let progress = Progress::new(console);
        let log = SightingLog::read(&self.input.logs, self.input.format(), &progress)?;
        let mut times = progress.end();
        let memory = MemoryEstimate::of(&log, &params, rayon::current_num_threads());
        memory.require(self.max_memory.unwrap_or(u64::MAX))?;
        console.say(format_args!("memory: about {} MB", memory.peak().div_ceil(1_000_000)));

        let progress = Progress::new(console);
        let made = match &self.state {
            Some(file) => Made::State(file, Box::new(mapper.build_with_state(log, &progress)?)),
            None => Made::Map(Box::new(mapper.build(&log, &progress)?)),
        };
        times.extend(progress.end());

        let deferral = Deferral::of_writing();
        made.save(&path)?;
        drop(deferral);
        let map = made.map();
        console.say(summary::of(map.report()));
        console.say(times_line(&times));
        if path != Path::new("-") {
            console.say(next_steps(&path));
        }
        if self.json { Ok(console::print(json(map, &path, &memory, &times))?) } else { Ok(()) }
    }

    fn check_state(&self, state: &Path, path: &Path) -> anyhow::Result<()> {
        if state == Path::new("-") {
            return Err(conflict("the state is read again by `update`, so it must be a file; give its name"));
        }
        if state == path || same_file(state, path) {
            return Err(conflict("--state and --output are the same file; give two"));
        }
        if let Some(log) = self.input.logs.iter().find(|log| same_file(log, state)) {
            let log = log.display();
            return Err(conflict(format_args!(
                "the state would replace the log {log}; give another --state"
            )));
        }
        drop(Output::open(state)?);
        Ok(())
    }

    /// Finds out before the work whether its result can be put in place.
    fn check_output(&self, path: &Path) -> anyhow::Result<()> {
        if self.json && path == Path::new("-") {
            return Err(conflict("--json and --output - both want stdout; give the map a file"));
        }
        if let Some(log) = self.input.logs.iter().find(|log| same_file(log, path)) {
            let log = log.display();
            return Err(conflict(format_args!("the map would replace the log {log}; give another --output")));
        }
        if let Some(state) = &self.state {
            self.check_state(state, path)?;
        }
        // Dropped at once: a build that is killed leaves no temporary file behind.
        drop(Output::open(path)?);
        Ok(())
    }
}

/// What a build has made.
enum Made<'a> {
    Map(Box<GlobalMap>),
    /// With what is needed to go on, and where that goes.
    State(&'a Path, Box<MapState>),
}

impl Made<'_> {
    fn map(&self) -> &GlobalMap {
        match self {
            Self::Map(map) => map,
            Self::State(_, state) => state.map(),
        }
    }

    /// Writes the map, and the state if there is one: both or neither.
    fn save(&self, path: &Path) -> Result<(), MapError> {
        match self {
            Self::Map(map) => map.save(path),
            Self::State(file, state) => save_both(state, file, path),
        }
    }
}

/// Writes a state and its map, each complete before the first takes its place.
pub fn save_both(state: &MapState, file: &Path, map: &Path) -> Result<(), MapError> {
    let kept = Output::open(file)?.fill(|out| state.write(out))?;
    Output::open(map)?.fill(|out| state.map().write_as(map, out))?.keep()?;
    kept.keep()
}

impl Settings {
    fn params(&self) -> anyhow::Result<MapperParams> {
        let mut params = MapperParams::default();
        params.seed = self.seed;
        params.method = match self.method {
            MethodName::Auto => Method::Auto,
            MethodName::Classical => Method::Classical,
        };
        if params.method != Method::Classical
            && let Some(flag) = self.classical_flag()
        {
            return Err(conflict(format_args!(
                "{flag} is a setting of --method classical; add that or leave {flag} out"
            )));
        }
        if params.method != Method::Auto && self.distance.is_some() {
            return Err(conflict("--distance is a setting of --method auto; leave one of the two out"));
        }
        params.auto.split_aliases = self.split_aliases;
        params.auto.distance = self.distance.map_or(params.auto.distance, DistanceChoice::from);
        let classical = &mut params.classical;
        classical.alpha = self.alpha;
        classical.lo = self.lo.unwrap_or(classical.lo);
        classical.hi = self.hi.unwrap_or(classical.hi);
        classical.tic = !self.no_tic;
        if let Some(phi) = self.phi {
            classical.phi = match phi {
                PhiName::Phi1 => Phi::Phi1,
                PhiName::Phi2 => Phi::Phi2,
            };
        }
        Ok(params)
    }

    /// The first option given that only the classical method reads.
    fn classical_flag(&self) -> Option<&'static str> {
        let given = [
            ("--phi", self.phi.is_some()),
            ("--alpha", self.alpha.is_some()),
            ("--lo", self.lo.is_some()),
            ("--hi", self.hi.is_some()),
            ("--no-tic", self.no_tic),
        ];
        given.into_iter().find_map(|(flag, given)| given.then_some(flag))
    }
}

/// The log's name in the current folder, `.map.json` in the place of what tells format and packing.
fn default_output(log: &Path) -> PathBuf {
    if log == Path::new("-") {
        return "stdin.map.json".into();
    }
    let mut name = PathBuf::from(log.file_name().unwrap_or_default());
    if name.extension().is_some_and(|packing| packing == "gz" || packing == "zst") {
        name.set_extension("");
    }
    if LogFormat::from_path(&name).is_some() {
        name.set_extension("");
    }
    name.as_mut_os_string().push(".map.json");
    name
}

/// Whether two paths are the same existing file.
pub fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

pub fn times_line(times: &[(Stage, Duration)]) -> String {
    let part =
        |(stage, time): &(Stage, Duration)| format!("{} {:.2} s", progress::name(*stage), time.as_secs_f64());
    format!("time: {}", times.iter().map(part).collect::<Vec<_>>().join(", "))
}

fn next_steps(map: &Path) -> String {
    let map = map.display();
    format!(
        "map written to {map}\n\
         next: covimap info {map}\n      \
         covimap export {map} --to svg -o map.svg\n      \
         covimap evaluate {map} TRUTH.csv"
    )
}

fn json(
    map: &GlobalMap,
    path: &Path,
    memory: &MemoryEstimate,
    times: &[(Stage, Duration)],
) -> serde_json::Value {
    serde_json::json!({
        "map": path.display().to_string(),
        "method": map.params().method,
        "seed": map.params().seed,
        "report": map.report(),
        "memory_estimate": memory.peak(),
        "seconds": seconds(times),
    })
}

/// Seconds that each stage took, by its name.
pub fn seconds(times: &[(Stage, Duration)]) -> serde_json::Map<String, serde_json::Value> {
    let entry = |(stage, time): &(Stage, Duration)| {
        (progress::name(*stage).replace(' ', "_"), time.as_secs_f64().into())
    };
    times.iter().map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_is_named_after_the_log_and_put_in_the_current_folder() {
        for (log, map) in [
            ("run.jsonl", "run.map.json"),
            ("/data/run.2.jsonl.gz", "run.2.map.json"),
            ("../day.1.csv.zst", "day.1.map.json"),
            ("walk.txt", "walk.map.json"),
            ("sightings.log", "sightings.log.map.json"),
            ("sightings.gz", "sightings.map.json"),
            ("plain", "plain.map.json"),
            ("-", "stdin.map.json"),
        ] {
            assert_eq!(default_output(Path::new(log)), Path::new(map), "{log}");
        }
    }
}
