//! Measures loading and questions on a large map.
//!
//! ```text
//! cargo run --release -p covimap-plan --example million -- hall 1000000
//! cargo run --release -p covimap-plan --example million -- MAP
//! ```
//!
//! saves and loads a map in both forms, and asks for neighbours, turns, routes and places. The map is one that was
//! built, or made up: of that many landmarks, ten a square metre. `hall` is an open floor; `rooms` has walls every ten
//! metres with a door of 1.5 m in each, which lines of sight pass through alone. Landmarks are numbered strip by strip, as a
//! robot that sweeps the floor meets them. Times are of the processor, user and system, over all threads: they do not
//! depend on what else runs. Questions are about the largest component.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use covimap_map::{
    BuildReport, GlobalMap, LandmarkId, LandmarkNames, MapperParams, PlacedLandmark, Sensed, Sensing,
    SensorModel, SightLines, delaunay_edges,
};
use covimap_plan::{Localiser, MapIndex, Objective, RoadParams, Roads};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

type Point = [f64; 2];

const PER_SQUARE_METRE: f64 = 10.0;
const RANGE: f64 = 1.2;
const SEEN: f64 = RANGE / 2.0;
const DETECTED: f64 = 0.9;
const ROOM: f64 = 10.0;
const DOOR: f64 = 1.5;
const SIGHTINGS: u32 = 300;
const STRIP: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let map = match &arguments[..] {
        [map] => GlobalMap::load(Path::new(map))?,
        [kind, landmarks] => make_up(landmarks.parse()?, kind == "rooms")?,
        _ => return Err("usage: million MAP, or million hall|rooms LANDMARKS".into()),
    };
    println!("{} landmarks, {} lines of sight", map.len(), map.sight_lines().count());
    let folder = tempfile::tempdir()?;
    for name in ["map.covimap", "map.json"] {
        let path = folder.path().join(name);
        map.save(&path)?;
        let megabytes = path.metadata()?.len() as f64 / 1e6;
        let loaded = timed(&format!("load {name}, {megabytes:.0} MB"), 1, || GlobalMap::load(&path))?;
        assert_eq!(loaded, map);
    }
    let range = map.sensing().map_or(SEEN, |sensing| sensing.sensor(0).range);
    let placed = (0..).map(LandmarkId).zip(map.landmarks());
    let asked: Vec<LandmarkId> =
        placed.filter(|(_, placed)| placed.component == 0).map(|(id, _)| id).collect();
    let index = Arc::new(timed("index", 1, || MapIndex::new(Arc::new(map))));
    timed("covariances", 1, || index.covariance(LandmarkId(0)))?;
    timed("Delaunay graph", 1, || index.neighbours(LandmarkId(0)).map(<[_]>::len))?;
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let ids: Vec<LandmarkId> = (0..100_000).map(|_| asked[random.random_range(0..asked.len())]).collect();
    timed("10 nearest", ids.len(), || ids.iter().try_for_each(|&id| index.nearest(id, 10).map(drop)))?;
    let distinct = |t: &&[LandmarkId]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let triples: Vec<_> = ids.windows(3).filter(distinct).map(|t| [t[0], t[1], t[2]]).collect();
    timed("orientation", triples.len(), || {
        triples.iter().try_for_each(|&[a, b, c]| index.orientation(a, b, c).map(drop))
    })?;
    let localiser = timed("localiser", 1, || Localiser::new(Arc::clone(&index)))?;
    let looks = ids[..1000].iter().map(|&id| {
        let near = index.within(id, range)?.into_iter().filter(|_| random.random_bool(DETECTED));
        Ok(localiser.look(near.map(|near| index.name(near.landmark))))
    });
    let looks = looks.collect::<Result<Vec<_>, covimap_plan::PlanError>>()?;
    let found: usize = timed("locate", looks.len(), || {
        looks.iter().filter(|look| localiser.locate(look).best().is_some()).count()
    });
    println!("  {found} of {} looks located", looks.len());
    for objective in [Objective::Shortest, Objective::Safest] {
        let mut params = RoadParams::default();
        params.objective = objective;
        let roads = timed("road map", 1, || Roads::new(&index, params))?;
        let pairs = ids[..200].as_chunks::<2>().0;
        let ways =
            |roads: &Roads<'_>| pairs.iter().map(|&[a, b]| roads.route(a, b)).collect::<Result<Vec<_>, _>>();
        let found = timed(&format!("{objective:?} route"), pairs.len(), || ways(&roads))?;
        let length: usize = found.iter().map(|route| route.landmarks.len()).sum();
        println!("  over {} landmarks in the mean", length / found.len());
        let before = resident_megabytes();
        let roads = timed("roads prepared", 1, || roads.prepare());
        println!("  {:.0} MB", resident_megabytes() - before);
        let again = timed(&format!("{objective:?} route, prepared"), pairs.len(), || ways(&roads))?;
        assert!(found.iter().zip(&again).all(|(a, b)| (a.cost - b.cost).abs() < 1e-9 * a.cost));
    }
    Ok(())
}

/// Landmarks at random, with lines of sight between neighbours in range that no wall parts.
fn make_up(n: u32, walls: bool) -> Result<GlobalMap, Box<dyn Error>> {
    let side = (f64::from(n) / PER_SQUARE_METRE).sqrt();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut points: Vec<Point> =
        (0..n).map(|_| [random.random_range(0.0..side), random.random_range(0.0..side)]).collect();
    points.sort_by(|a, b| {
        (a[1] / STRIP).floor().total_cmp(&(b[1] / STRIP).floor()).then(a[0].total_cmp(&b[0]))
    });
    let lines = delaunay_edges(&points)?.into_iter().filter_map(|(a, b)| {
        let [p, q] = [a, b].map(|i| points[i as usize]);
        let apart = (p[0] - q[0]).hypot(p[1] - q[1]);
        let open = !walls || (passes(p, q, 0) && passes(p, q, 1));
        let both = f64::from(SIGHTINGS) * (1.0 - apart / RANGE);
        (open && both >= 1.0).then_some((LandmarkId(a), LandmarkId(b), both as u32))
    });
    let lines = SightLines::from_pairs(points.len(), lines)?;
    let placed = |&position: &Point| PlacedLandmark {
        position,
        component: 0,
        region: 0,
        sightings: SIGHTINGS,
        partners: 20,
        ..Default::default()
    };
    let landmarks = points.iter().map(placed).collect();
    let mut names = LandmarkNames::default();
    for i in 0..n {
        names.push(&format!("L{i:07}"));
    }
    let map = GlobalMap::from_parts(names, landmarks, MapperParams::default(), BuildReport::default())?;
    let n = map.len();
    let sensor = SensorModel { range: SEEN, edge: 0.05, detectability: DETECTED, outliers: 0.001 };
    let sensed = Sensed { detectability: DETECTED, deviation: 0.02, warp: 0.02 };
    let sensing = Sensing::from_parts(vec![sensor], vec![sensed; n], &[])?;
    Ok(map.with_sight_lines(lines)?.with_sensing(sensing)?)
}

/// Whether a line meets no wall across an axis, or goes through the door in its middle.
fn passes(p: Point, q: Point, axis: usize) -> bool {
    let [from, to] = [p, q].map(|point| (point[axis] / ROOM).floor());
    if from == to {
        return true;
    }
    let wall = ROOM * from.max(to);
    let t = (wall - p[axis]) / (q[axis] - p[axis]);
    let along = p[1 - axis] + t * (q[1 - axis] - p[1 - axis]);
    (along.rem_euclid(ROOM) - 0.5 * ROOM).abs() < 0.5 * DOOR
}

fn timed<T>(what: &str, times: usize, run: impl FnOnce() -> T) -> T {
    let start = processor_seconds();
    let result = run();
    let each = (processor_seconds() - start) / times as f64;
    let (value, unit) = if each < 1e-3 { (each * 1e6, "us") } else { (each * 1e3, "ms") };
    println!("{what:<28} {value:>10.2} {unit}");
    result
}

/// User and system time of this process, to a hundredth of a second, as Linux tells it.
fn processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = text.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(11).take(2).filter_map(|field| field.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// Memory of this process, as Linux tells it.
fn resident_megabytes() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = text.split_whitespace().nth(1).and_then(|field| field.parse::<f64>().ok());
    pages.unwrap_or_default() * 4096.0 / 1e6
}
