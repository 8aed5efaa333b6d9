//! What to simulate: world, motion, sensor and errors, with defaults and checks.

use serde::{Deserialize, Serialize};

use crate::error::SimError;

/// The shape of the free space. Its area is `landmarks / density`; lengths are in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Floor {
    /// A square without inner walls.
    Hall {},
    /// A corridor around a square block; the corridor is a fifth of the outer side wide.
    Ring {},
    /// The ring without one side, like a letter C.
    Horseshoe {},
    /// Streets around square buildings.
    Blocks {
        /// Width of a street.
        street: f64,
        /// Side of a building.
        building: f64,
    },
    /// One corridor that winds outwards around its inner end.
    Spiral {
        /// Width of the corridor.
        corridor: f64,
        /// Thickness of the wall between two turns.
        wall: f64,
    },
    /// Square rooms with thin walls and one door in each wall between two rooms.
    Office {
        /// Side of a room, before it is fitted to the area.
        room: f64,
        /// Width of a door.
        door: f64,
        /// Share of shared walls without a door; every room stays reachable.
        missing_doors: f64,
    },
    /// Two square rooms joined by one door.
    TwoRooms {
        /// Width of the door.
        door: f64,
    },
    /// Corridors that branch and never meet again.
    CorridorTree {
        /// Width of a corridor.
        corridor: f64,
        /// Distance between the middles of two neighbouring crossings.
        pitch: f64,
    },
}

impl Floor {
    /// Every floor with its default lengths.
    pub const ALL: [Self; 8] = [
        Self::Hall {},
        Self::Ring {},
        Self::Horseshoe {},
        Self::Blocks { street: 1.0, building: 2.0 },
        Self::Spiral { corridor: 1.0, wall: 0.2 },
        Self::Office { room: 3.0, door: 0.9, missing_doors: 0.1 },
        Self::TwoRooms { door: 0.9 },
        Self::CorridorTree { corridor: 1.0, pitch: 3.0 },
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Hall {} => "hall",
            Self::Ring {} => "ring",
            Self::Horseshoe {} => "horseshoe",
            Self::Blocks { .. } => "blocks",
            Self::Spiral { .. } => "spiral",
            Self::Office { .. } => "office",
            Self::TwoRooms { .. } => "two-rooms",
            Self::CorridorTree { .. } => "corridor-tree",
        }
    }

    /// The floor of this name with its default lengths.
    ///
    /// # Errors
    /// [`SimError::UnknownWorld`] if there is none.
    pub fn named(name: &str) -> Result<Self, SimError> {
        Self::ALL.into_iter().find(|floor| floor.name() == name).ok_or_else(|| SimError::UnknownWorld {
            name: name.to_owned(),
            known: Self::ALL.map(|floor| floor.name()).join(", "),
        })
    }
}

/// A floor and how landmarks stand on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldSpec {
    /// Shape of the free space.
    pub floor: Floor,
    /// Number of landmarks, `>= 1`.
    pub landmarks: usize,
    /// Landmarks per square metre of free space, `> 0`; default 10.
    pub density: f64,
    /// Diameter of a landmark, metres, `>= 0`; default 0, a point.
    pub diameter: f64,
    /// Least free distance between two landmarks' surfaces, and to a wall, metres, `>= 0`; default 0.
    pub min_gap: f64,
    /// What landmark IDs start with; default `L`.
    pub id_prefix: String,
}

impl WorldSpec {
    /// A large world of point landmarks at 10 per square metre.
    #[must_use]
    pub fn large(floor: Floor, landmarks: usize) -> Self {
        Self { floor, landmarks, density: 10.0, diameter: 0.0, min_gap: 0.0, id_prefix: "L".to_owned() }
    }

    pub(crate) fn check(&self) -> Result<(), SimError> {
        Ok(())
    }
}

/// How a robot takes a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepSpec {
    /// Largest turn to either side, radians.
    pub turn: f64,
    /// Shortest step, metres.
    pub shortest: f64,
    /// Longest step, metres.
    pub longest: f64,
    /// Distance that the robot's middle keeps from walls and landmarks' surfaces, metres.
    pub clearance: f64,
}

/// Recognition by distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RangeSpec {
    /// Distance of even chance, metres.
    pub range: f64,
    /// Softness of the edge, metres.
    pub edge: f64,
    /// Chance to recognise a landmark close by.
    pub detection: f64,
}

/// A robot's run through a world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSpec {
    /// Number of observations.
    pub steps: u64,
    /// Steps.
    pub step: StepSpec,
    /// Sensor.
    pub range: RangeSpec,
}

impl RunSpec {
    /// A robot that wanders through a large world.
    #[must_use]
    pub fn large(steps: u64) -> Self {
        Self {
            steps,
            step: StepSpec {
                turn: std::f64::consts::FRAC_PI_4,
                shortest: 0.1,
                longest: 0.2,
                clearance: 0.05,
            },
            range: RangeSpec { range: 0.55, edge: 0.04, detection: 0.95 },
        }
    }
}
