//! A robot that somebody else steers: for planners that close the loop.

use crate::angle::Angle;
use crate::error::SimError;
use crate::geometry::{Point, Pose};
use crate::motion::{Walker, bearing};
use crate::seed::{Stream, stream};
use crate::sensor::Observer;
use crate::spec::RunSpec;
use crate::world::World;

/// A robot in a world, which turns, goes and looks as it is told.
///
/// ```
/// use covimap_sim::{Angle, Floor, Rover, SimSpec, World};
///
/// let spec = SimSpec::large(Floor::Hall {}, 50, 40);
/// let world = World::new(&spec.world, 1)?;
/// let mut rover = Rover::new(&world, &spec.run, 1)?;
/// rover.turn(Angle::from_deg(90.0));
/// if !rover.go(0.1) {
///     rover.turn(Angle::from_deg(180.0));
/// }
/// assert!(rover.look().len() < 50);
/// # Ok::<(), covimap_sim::SimError>(())
/// ```
pub struct Rover<'w> {
    walker: Walker<'w>,
    observer: Observer,
    pose: Pose,
    longest: f64,
    seen: Vec<u32>,
    landmarks: &'w [Point],
}

impl<'w> Rover<'w> {
    /// Puts a robot at a random free place. Of the settings those of steps, sensor and errors count; how many
    /// steps it takes and where to is the caller's business.
    ///
    /// # Errors
    /// Those of [`crate::Simulation::new`] but [`SimError::OutOfReach`].
    pub fn new(world: &'w World, spec: &RunSpec, seed: u64) -> Result<Self, SimError> {
        spec.check()?;
        let mut walker = Walker::new(world, spec.step, stream(seed, Stream::Motion))?;
        let observer = Observer::new(world, &spec.sensor, spec.errors, seed)?;
        let pose = walker.start();
        Ok(Self {
            walker,
            observer,
            pose,
            longest: spec.step.longest,
            seen: Vec::new(),
            landmarks: world.landmarks(),
        })
    }

    /// Where it truly is: for whoever judges, not for whoever steers.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Numbers of the landmarks that it recognises now, ascending, each once.
    pub fn look(&mut self) -> &[u32] {
        self.observer.observe(self.pose, &mut self.seen);
        &self.seen
    }

    /// Takes a step in about the direction that is turned by this from the last one, as the settings of steps say, and
    /// round whatever is in the way. With no turn at all this is [`crate::Motion::Wander`]: the same seed and settings
    /// give the same way.
    pub fn head(&mut self, by: Angle) {
        self.pose = self.walker.step(self.pose, self.pose.heading + by.rad());
    }

    /// Takes a step in about the direction of a landmark that the last look showed, as the settings of steps say,
    /// and round whatever is in the way. Tells whether the landmark was in that look: of others the robot does not know
    /// the direction, and stays.
    pub fn approach(&mut self, landmark: u32) -> bool {
        let in_sight = self.seen.binary_search(&landmark).is_ok();
        if in_sight {
            let wanted = bearing(self.pose.at, self.landmarks[landmark as usize]);
            self.pose = self.walker.step(self.pose, wanted);
        }
        in_sight
    }

    /// Turns on the spot, counter-clockwise.
    pub fn turn(&mut self, by: Angle) {
        self.pose.heading = (self.pose.heading + by.rad()).rem_euclid(std::f64::consts::TAU);
    }

    /// Goes straight ahead, at most as far as the longest step and never back. Tells whether it could: if
    /// anything is in the way it stays where it is.
    pub fn go(&mut self, length: f64) -> bool {
        let length = length.clamp(0.0, self.longest);
        let (sin, cos) = self.pose.heading.sin_cos();
        let to = [self.pose.at[0] + length * cos, self.pose.at[1] + length * sin];
        let free = self.walker.is_free(self.pose.at, to);
        if free {
            self.pose.at = to;
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Floor, SimSpec};

    fn in_hall(run: impl FnOnce(&mut Rover, &World)) {
        let spec = SimSpec::large(Floor::Hall {}, 100, 40);
        let world = World::new(&spec.world, 3).unwrap();
        run(&mut Rover::new(&world, &spec.run, 3).unwrap(), &world);
    }

    #[test]
    fn it_goes_where_it_is_told_and_stops_at_walls() {
        in_hall(|rover, world| {
            let start = rover.pose();
            rover.turn(Angle::from_deg(90.0));
            if rover.go(0.1) {
                let moved = [rover.pose().at[0] - start.at[0], rover.pose().at[1] - start.at[1]];
                // To the left of where it looked.
                assert!((moved[0] + 0.1 * start.heading.sin()).abs() < 1e-12);
                assert!((moved[1] - 0.1 * start.heading.cos()).abs() < 1e-12);
            }
            // No longer than the longest step, and not back.
            let from = rover.pose().at;
            assert!(
                !rover.go(f64::INFINITY)
                    || (rover.pose().at[0] - from[0]).hypot(rover.pose().at[1] - from[1]) < 0.2001
            );
            let from = rover.pose().at;
            rover.go(-1.0);
            assert_eq!(rover.pose().at, from);
            let steps = (0..1000).take_while(|_| rover.go(0.2)).count();
            assert!(steps < 100 && !rover.go(0.2), "{steps}");
            assert!(world.plan().bounds().contains(rover.pose().at));
        });
    }

    #[test]
    fn without_turns_it_wanders_as_the_motion_does() {
        let spec = SimSpec::large(Floor::Hall {}, 100, 40);
        let world = World::new(&spec.world, 3).unwrap();
        let walk = crate::Simulation::new(&world, &spec.run, 5).unwrap().record();
        let mut rover = Rover::new(&world, &spec.run, 5).unwrap();
        for step in walk.steps().take(300) {
            assert_eq!((rover.pose(), rover.look()), (step.pose, step.seen));
            rover.head(Angle::from_rad(0.0));
        }
    }

    #[test]
    fn it_comes_nearer_to_what_it_sees_and_knows_no_way_to_what_it_does_not() {
        in_hall(|rover, world| {
            let away = |rover: &Rover, number: u32| {
                let ([x, y], at) = (world.landmarks()[number as usize], rover.pose().at);
                (x - at[0]).hypot(y - at[1])
            };
            let seen = rover.look().to_vec();
            let hidden = (0..100).find(|number| !seen.contains(number)).unwrap();
            let before = rover.pose();
            assert!(!rover.approach(hidden) && rover.pose() == before);
            let far = *seen.iter().max_by(|&&a, &&b| away(rover, a).total_cmp(&away(rover, b))).unwrap();
            let start = away(rover, far);
            for _ in 0..3 {
                rover.look();
                if away(rover, far) < 0.2 {
                    break;
                }
                rover.approach(far);
            }
            assert!(away(rover, far) < 0.8 * start, "{} from {start}", away(rover, far));
        });
    }

    #[test]
    fn it_sees_what_is_near() {
        in_hall(|rover, world| {
            let at = rover.pose().at;
            let seen = rover.look().to_vec();
            assert!(!seen.is_empty() && seen.is_sorted());
            for number in seen {
                let [x, y] = world.landmarks()[number as usize];
                assert!((x - at[0]).hypot(y - at[1]) < 0.55 + 8.0 * 0.04);
            }
        });
    }
}
