//! A map in a planner's hands: what is near, left or right, and a way round a wall, found by our own
//! search and by the `pathfinding` crate.
//!
//! `cargo run --release --example 03_plan_a_route`

use std::error::Error;
use std::sync::Arc;

use covimap::plan::{MapIndex, RoadParams, Roads, RouteSearch, SearchGraph};
use covimap::{LandmarkId, Mapper, MapperParams, SightingLog, Silent};

/// The wall stands between columns 5 and 6, and leaves the last two rows open.
const WALL: i32 = 6;
const OPEN: i32 = 10;

/// A search of somebody else. Its costs must be whole numbers: billionths of the units of the map.
struct Pathfinding;

impl<G: SearchGraph> RouteSearch<G> for Pathfinding {
    fn search(&self, graph: &G, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>> {
        let whole = |cost: f64| (cost * 1e9) as u64;
        let roads =
            |at: &LandmarkId| graph.roads_from(*at).map(|(to, cost)| (to, whole(cost))).collect::<Vec<_>>();
        let bound = |at: &LandmarkId| whole(graph.at_least(*at, to));
        let (way, _) = pathfinding::directed::astar::astar(&from, roads, bound, |&at| at == to)?;
        Some(way)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let map = Mapper::new(MapperParams::default())?.build(&board(), &Silent)?;
    let index = MapIndex::new(Arc::new(map));

    let near = index.nearest("3-3", 4)?;
    println!("nearest to 3-3: {:?}", near.iter().map(|near| index.name(near.landmark)).collect::<Vec<_>>());
    let side = index.orientation("0-0", "11-11", "11-0")?;
    println!(
        "11-0 is to the {:?} of the diagonal, with probability {:.3}",
        side.orientation, side.probability
    );

    let roads = Roads::new(&index, RoadParams::default())?;
    let [ours, theirs] = [roads.route("0-4", "0-7")?, roads.route_by(&Pathfinding, "0-4", "0-7")?];
    println!(
        "from 0-4 to 0-7 round the wall: {:.3} map units, {} way-points",
        ours.length,
        ours.waypoints.len()
    );
    println!("  {:?}", ours.landmarks.iter().map(|&id| index.name(id)).collect::<Vec<_>>());
    assert!((ours.cost - theirs.cost).abs() < 1e-6, "both find a way of least cost");
    assert!(
        ours.landmarks.iter().any(|&id| index.name(id).starts_with("10-")),
        "no way leads through the wall"
    );
    Ok(())
}

/// A robot drives along the squares of a board, up and down, and sees the squares around it that no wall hides.
fn board() -> SightingLog {
    let mut steps = Vec::new();
    for (row, column) in (0..12_i32).flat_map(|row| (0..12_i32).map(move |column| (row, column))) {
        let around = (-2..=2).flat_map(|down| (-2..=2).map(move |right| (row + down, column + right)));
        let near = around.filter(|(r, c)| (r - row).pow(2) + (c - column).pow(2) <= 4);
        let open = |r: i32| r >= OPEN && row >= OPEN;
        let seen = near.filter(|&(r, c)| (c < WALL) == (column < WALL) || open(r));
        let on_board = seen.filter(|(r, c)| (0..12).contains(r) && (0..12).contains(c));
        steps.push(on_board.map(|(r, c)| format!("{r}-{c}")).collect::<Vec<_>>());
    }
    SightingLog::from_steps(steps)
}
