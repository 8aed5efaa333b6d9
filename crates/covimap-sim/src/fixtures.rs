//! Small named logs with their truth, for tests: a few kilobytes each, the same for ever.

use covimap_map::JsonlWriter;

use crate::error::SimError;
use crate::geometry::Point;
use crate::simulation::Simulation;
use crate::spec::{Floor, SimSpec};
use crate::world::World;

const MEMORY: &str = "memory takes every byte (bug in covimap)";

/// What was seen, and where the landmarks truly are.
#[derive(Debug, Clone, PartialEq)]
pub struct Fixture {
    /// Where each landmark stands, metres, by number.
    pub truth: Vec<Point>,
    /// Numbers of the landmarks seen in each step, ascending.
    pub sets: Vec<Vec<u32>>,
}

impl Fixture {
    /// The log as canonical JSONL; landmark 3 is called `L3`.
    #[must_use]
    pub fn jsonl(&self) -> String {
        let mut writer = JsonlWriter::new(Vec::new());
        for seen in &self.sets {
            writer.step(None, seen.iter().map(|number| format!("L{number}"))).expect(MEMORY);
        }
        String::from_utf8(writer.finish().expect(MEMORY)).expect("the log is ASCII (bug in covimap)")
    }

    /// The truth as CSV, `id,x,y`.
    #[must_use]
    pub fn truth_csv(&self) -> String {
        let rows = self.truth.iter().enumerate().map(|(number, [x, y])| format!("L{number},{x},{y}\n"));
        ["id,x,y\n".to_owned()].into_iter().chain(rows).collect()
    }

    fn simulate(spec: &SimSpec, seed: u64) -> Self {
        let run = || -> Result<Self, SimError> {
            let world = World::new(&spec.world, seed)?;
            let recording = Simulation::new(&world, &spec.run, seed)?.record();
            let sets = recording.steps().map(|step| step.seen.to_vec()).collect();
            Ok(Self { truth: world.landmarks().to_vec(), sets })
        };
        run().expect("the settings of fixtures are sound (bug in covimap)")
    }
}

/// The paper's room: 12 cylinders on 1.5 m x 1.5 m, 200 steps.
#[must_use]
pub fn square_room() -> Fixture {
    Fixture::simulate(&SimSpec::paper_room(12, 1.5, 200), 1)
}

/// A corridor around a block: 40 landmarks at 10 per square metre, 400 steps.
#[must_use]
pub fn ring_corridor() -> Fixture {
    Fixture::simulate(&SimSpec::large(Floor::Ring {}, 40, 10), 1)
}

/// Two halls far apart, 15 landmarks and 150 steps each: one log, no landmark of both in any step. The second
/// hall has the numbers from 15 on and stands 100 m to the right.
#[must_use]
pub fn two_islands() -> Fixture {
    let spec = SimSpec::large(Floor::Hall {}, 15, 10);
    let mut both = Fixture::simulate(&spec, 1);
    let second = Fixture::simulate(&spec, 2);
    both.truth.extend(second.truth.iter().map(|[x, y]| [x + 100.0, *y]));
    both.sets.extend(second.sets.iter().map(|seen| seen.iter().map(|number| number + 15).collect()));
    both
}

/// Ten landmarks on a line, 0.2 m apart; a robot passes along the line in 59 steps of a thirtieth of a metre
/// and sees whatever is within 0.45 m.
#[must_use]
pub fn collinear() -> Fixture {
    let place = |number: u32| f64::from(number) * 0.2;
    let seen_from = |at: f64| (0..10).filter(|&number| (place(number) - at).abs() < 0.45).collect();
    Fixture {
        truth: (0..10).map(|number| [place(number), 0.0]).collect(),
        sets: (0..59).map(|step| seen_from(f64::from(step) * 1.8 / 58.0)).collect(),
    }
}

/// The corners of a right triangle with legs of 3 and 4 m, and how often each pair of them was seen together:
/// the legs' ends 8 and 6 times, those of the hypotenuse 5 times, each corner 3 times alone, once nothing.
#[must_use]
pub fn triangle() -> Fixture {
    let times = |count: usize, seen: &[u32]| vec![seen.to_vec(); count];
    let sets = [
        times(8, &[0, 1]),
        times(6, &[0, 2]),
        times(5, &[1, 2]),
        times(3, &[0]),
        times(3, &[1]),
        times(3, &[2]),
        times(1, &[]),
    ];
    Fixture { truth: vec![[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]], sets: sets.concat() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(fixture: &Fixture) -> usize {
        fixture.jsonl().len() + fixture.truth_csv().len()
    }

    #[test]
    fn fixtures_are_small_and_show_every_landmark() {
        for fixture in [square_room(), ring_corridor(), two_islands(), collinear(), triangle()] {
            assert!((200..20_000).contains(&bytes(&fixture)), "{} bytes", bytes(&fixture));
            for number in 0..u32::try_from(fixture.truth.len()).unwrap() {
                assert!(fixture.sets.iter().any(|seen| seen.contains(&number)), "landmark {number}");
            }
        }
    }

    #[test]
    fn no_step_shows_landmarks_of_both_islands() {
        let Fixture { truth, sets } = two_islands();
        assert_eq!(truth.len(), 30);
        assert!(sets.iter().all(|seen| seen.iter().all(|&n| n < 15) || seen.iter().all(|&n| n >= 15)));
    }

    #[test]
    fn files_of_the_triangle_read_as_written_here() {
        assert!(triangle().jsonl().starts_with("{\"seen\": [\"L0\", \"L1\"]}\n"));
        assert!(triangle().jsonl().ends_with("{\"seen\": []}\n"));
        assert_eq!(triangle().truth_csv(), "id,x,y\nL0,0,0\nL1,3,0\nL2,0,4\n");
    }
}
