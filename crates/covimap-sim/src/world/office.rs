//! An office: square rooms behind thin walls, one door in each wall between two rooms.

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::doors::with_door;
use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::{Rect, Segment};

/// A wall between two rooms; rooms are numbered row by row.
struct SharedWall {
    rooms: [usize; 2],
    wall: Segment,
}

/// `k x k` rooms of about the given side, `k` rounded, the side then fitted to the area.
///
/// Every shared wall has a door of the given width at a random place, but for a share `missing` of them
/// (rounded down, as far as there are so many), which are chosen at random among those that leave every
/// room reachable.
pub(super) fn plan(
    area: f64,
    room: f64,
    door: f64,
    missing: f64,
    rng: &mut ChaCha8Rng,
) -> Result<FloorPlan, SimError> {
    let count = (area.sqrt() / room).round().max(1.0) as usize;
    let side = area.sqrt() / count as f64;
    let lines: Vec<f64> = (0..=count).map(|index| index as f64 * side).collect();
    let mut rooms = Vec::new();
    let mut shared = Vec::new();
    for row in 0..count {
        for column in 0..count {
            let (min, max) = ([lines[column], lines[row]], [lines[column + 1], lines[row + 1]]);
            let here = rooms.len();
            if column + 1 < count {
                let wall = Segment { a: [max[0], min[1]], b: max };
                shared.push(SharedWall { rooms: [here, here + 1], wall });
            }
            if row + 1 < count {
                let wall = Segment { a: [min[0], max[1]], b: max };
                shared.push(SharedWall { rooms: [here, here + count], wall });
            }
            rooms.push(Rect { min, max });
        }
    }
    shared.shuffle(rng);
    let partitions = partitions(&shared, rooms.len(), door, missing, rng)?;
    Ok(FloorPlan::new(rooms, partitions))
}

/// Goes through the shuffled walls: one that first joins two groups of rooms always gets its door.
fn partitions(
    shared: &[SharedWall],
    rooms: usize,
    door: f64,
    missing: f64,
    rng: &mut ChaCha8Rng,
) -> Result<Vec<Segment>, SimError> {
    let mut groups: Vec<usize> = (0..rooms).collect();
    let mut closable = (missing * shared.len() as f64).floor() as usize;
    let mut partitions = Vec::new();
    for &SharedWall { rooms: [a, b], wall } in shared {
        let needed = join(&mut groups, a, b);
        if !needed && closable > 0 {
            closable -= 1;
            partitions.push(wall);
        } else {
            partitions.extend(with_door(wall, door, rng)?);
        }
    }
    Ok(partitions)
}

/// Joins the groups of two rooms; tells whether they were apart.
fn join(groups: &mut [usize], a: usize, b: usize) -> bool {
    let (a, b) = (first_of_group(groups, a), first_of_group(groups, b));
    groups[a.max(b)] = a.min(b);
    a != b
}

/// The room that stands for the group; halves the way to it for the next time.
fn first_of_group(groups: &mut [usize], mut room: usize) -> usize {
    while groups[room] != room {
        groups[room] = groups[groups[room]];
        room = groups[room];
    }
    room
}
