//! An office: square rooms behind thin walls, one door in each wall between two rooms.

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Rect, Segment};

/// A wall between two rooms, numbered row by row.
struct SharedWall {
    rooms: [usize; 2],
    wall: Segment,
}

/// `k x k` rooms of about the given side, `k` rounded, the side then fitted to the area.
///
/// Every shared wall has a door of the given width at a random place, but for a share `missing` of them
/// (rounded down), which are chosen at random among those that leave every room reachable.
pub(super) fn plan(area: f64, room: f64, door: f64, missing: f64, rng: &mut ChaCha8Rng) -> FloorPlan {
    let count = (area.sqrt() / room).round().max(1.0) as usize;
    let side = area.sqrt() / count as f64;
    let lines: Vec<f64> = (0..=count).map(|index| index as f64 * side).collect();
    let mut tiles = Vec::new();
    let mut shared = Vec::new();
    for row in 0..count {
        for column in 0..count {
            let min = [lines[column], lines[row]];
            let max = [lines[column + 1], lines[row + 1]];
            let here = tiles.len();
            if column + 1 < count {
                let wall = Segment { a: [max[0], min[1]], b: max };
                shared.push(SharedWall { rooms: [here, here + 1], wall });
            }
            if row + 1 < count {
                let wall = Segment { a: [min[0], max[1]], b: max };
                shared.push(SharedWall { rooms: [here, here + count], wall });
            }
            tiles.push(Rect { min, max });
        }
    }
    shared.shuffle(rng);
    let partitions = partitions(&shared, tiles.len(), door, missing, rng);
    FloorPlan::new(tiles, &partitions)
}

fn partitions(
    shared: &[SharedWall],
    rooms: usize,
    door: f64,
    missing: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<Segment> {
    let mut groups: Vec<usize> = (0..rooms).collect();
    let mut closable = (missing * shared.len() as f64).floor() as usize;
    let mut partitions = Vec::new();
    for SharedWall { rooms, wall } in shared {
        let needed = join(&mut groups, rooms[0], rooms[1]);
        if !needed && closable > 0 {
            closable -= 1;
            partitions.push(*wall);
        } else {
            partitions.extend(wall_with_door(*wall, door, rng));
        }
    }
    partitions
}

/// Joins the groups of two rooms; tells whether they were apart.
fn join(groups: &mut [usize], a: usize, b: usize) -> bool {
    let root = |groups: &[usize], mut room: usize| {
        while groups[room] != room {
            room = groups[room];
        }
        room
    };
    let (a, b) = (root(groups, a), root(groups, b));
    groups[a.max(b)] = a.min(b);
    a != b
}

/// The two pieces of a wall beside a door, which stands at a random place.
pub(super) fn wall_with_door(wall: Segment, door: f64, rng: &mut ChaCha8Rng) -> [Segment; 2] {
    let length = (wall.b[0] - wall.a[0]).hypot(wall.b[1] - wall.a[1]);
    let start = rng.random::<f64>() * (length - door);
    let at = |distance: f64| -> Point {
        let share = distance / length;
        [wall.a[0] + share * (wall.b[0] - wall.a[0]), wall.a[1] + share * (wall.b[1] - wall.a[1])]
    };
    [Segment { a: wall.a, b: at(start) }, Segment { a: at(start + door), b: wall.b }]
}
