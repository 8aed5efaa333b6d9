//! A robot drives from landmark to landmark through streets between blocks, by the map and by what it sees.
//!
//! It knows the log of an earlier tour, what its eyes show now, and its own moves: how far it turned and
//! went since the last look. It has no compass, and nobody tells it where it is. The map says which way to go
//! in its own frame, whose direction, unit and handedness mean nothing to the robot's wheels; how the two frames
//! lie to each other comes out of the way itself, by laying the last moves over the places found.
//!
//! `cargo run --release --example 04_drive_by_sight`

use std::collections::VecDeque;
use std::error::Error;
use std::sync::Arc;

use covimap::embed::{Correspondence, Point, ProcrustesOptions, Similarity, procrustes};
use covimap::plan::{Localiser, MapIndex, RoadParams, Roads, TrackParams, Tracker};
use covimap::{LandmarkId, Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Angle, Floor, Rover, SimSpec, Simulation, World};

/// Length of a step, metres.
const STEP: f64 = 0.12;
/// Steps that tell how the robot's frame lies in the map's.
const MEMORY: usize = 24;
/// A way-point is reached when it is nearer than this, in visibility ranges.
const REACHED: f64 = 0.5;
/// Steps after which a drive counts as failed.
const MOST_STEPS: usize = 3000;

fn main() -> Result<(), Box<dyn Error>> {
    let spec = SimSpec::large(Floor::Blocks { street: 1.0, building: 2.0 }, 300, 40);
    let world = World::new(&spec.world, 4)?;
    let names = world.names();
    let tour = Simulation::new(&world, &spec.run, 4)?.record();
    let look = |seen: &[u32]| seen.iter().map(|&n| names.name(LandmarkId(n)).to_owned()).collect::<Vec<_>>();
    let log = SightingLog::from_steps(tour.steps().map(|step| look(step.seen)));
    let map = Mapper::new(MapperParams::default())?.build(&log, &Silent)?;
    println!("a map of {} landmarks from {} looks", map.len(), tour.len());

    let index = Arc::new(MapIndex::new(Arc::new(map)));
    let localiser = Arc::new(Localiser::new(Arc::clone(&index))?);
    let mut driver = Driver {
        tracker: Tracker::new(Arc::clone(&localiser), TrackParams::default())?,
        localiser,
        rover: Rover::new(&world, &spec.run, 5)?,
        heading: 0.0,
        at: [0.0; 2],
        way: VecDeque::new(),
    };
    let roads = Roads::new(&index, RoadParams::default())?;
    for goal in [17, 140, 260, 75].map(|number| names.name(LandmarkId(number))) {
        let steps = driver.drive_to(&index, &roads, goal, &look)?;
        let truth = world.landmarks()[goal[1..].parse::<usize>()?];
        let [x, y] = driver.rover.pose().at;
        let away = (truth[0] - x).hypot(truth[1] - y);
        println!("arrived at {goal} after {steps} steps; in truth it is {away:.2} m away");
        assert!(away < 0.6, "{goal} is {away} m away");
    }
    Ok(())
}

/// Steers the robot.
struct Driver<'w> {
    tracker: Tracker,
    localiser: Arc<Localiser>,
    rover: Rover<'w>,
    /// Direction and place by its own reckoning, from where it began.
    heading: f64,
    at: Point,
    /// The last places by its own reckoning and on the map.
    way: VecDeque<(Point, Point)>,
}

impl Driver<'_> {
    /// Drives until the goal is near, and returns the number of steps.
    fn drive_to(
        &mut self,
        index: &MapIndex,
        roads: &Roads,
        goal: &str,
        look: &impl Fn(&[u32]) -> Vec<String>,
    ) -> Result<usize, Box<dyn Error>> {
        let goal_at = index.landmark(goal)?.position;
        let mut targets: VecDeque<Point> = VecDeque::new();
        for step in 0..MOST_STEPS {
            let ids = look(self.rover.look());
            let seen = self.localiser.look(ids.iter().map(String::as_str));
            let location = self.tracker.update(&seen);
            let Some(here) = location.best().filter(|_| !location.is_ambiguous()) else {
                self.step(0.4);
                continue;
            };
            let range = index.map().sensing().ok_or("the map knows no sensor")?.sensor(here.component).range;
            self.way.push_back((self.at, here.position));
            if self.way.len() > MEMORY {
                self.way.pop_front();
            }
            let away = |to: Point| (to[0] - here.position[0]).hypot(to[1] - here.position[1]);
            if away(goal_at) < REACHED * range && ids.iter().any(|id| id == goal) {
                return Ok(step);
            }
            // A new plan at the beginning, and whenever the way was lost.
            if targets.front().is_none_or(|&next| away(next) > 3.0 * range) {
                let start = index.nearest_to(here.component, here.position, 1)?[0].landmark;
                let route = roads.route(start, index.id(goal)?)?;
                targets = route.waypoints.iter().map(|waypoint| waypoint.position).chain([goal_at]).collect();
            }
            while targets.len() > 1 && away(targets[0]) < REACHED * range {
                targets.pop_front();
            }
            let turn = match self.map_from_own() {
                Some(frame) => {
                    let to = frame.inverse().apply(targets[0]);
                    let from = frame.inverse().apply(here.position);
                    (to[1] - from[1]).atan2(to[0] - from[0]) - self.heading
                }
                // Some way in a bow, to learn how the frames lie.
                None => 0.3,
            };
            self.step(turn);
        }
        Err(format!("{goal} was not reached in {MOST_STEPS} steps").into())
    }

    /// How the map's frame lies in the robot's own.
    fn map_from_own(&self) -> Option<Similarity> {
        let pair = |&(source, target): &(Point, Point)| Correspondence { source, target, weight: 1.0 };
        let pairs: Vec<_> = self.way.iter().map(pair).collect();
        let fit = procrustes(&pairs, ProcrustesOptions::default()).ok()?;
        (self.way.len() >= MEMORY / 3).then_some(fit.target_from_source)
    }

    /// Turns and goes a step; round whatever is in the way.
    fn step(&mut self, turn: f64) {
        for aside in [0.0, 0.6, -0.6, 1.2, -1.2, 1.8, -1.8, 2.4, -2.4, 3.1] {
            let turn = Angle::from_rad(turn + aside);
            self.rover.turn(turn);
            if self.rover.go(STEP) {
                self.heading += turn.rad();
                self.at = [self.at[0] + STEP * self.heading.cos(), self.at[1] + STEP * self.heading.sin()];
                return;
            }
            self.rover.turn(Angle::from_rad(-turn.rad()));
        }
    }
}
