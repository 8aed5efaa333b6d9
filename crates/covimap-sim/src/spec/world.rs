//! Settings of worlds.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{Motion, require, require_not_negative, require_positive, require_share};
use crate::error::SimError;

/// The shape of the free space. Its area is `landmarks / density`; lengths are in metres.
///
/// [`Floor::from_str`] gives the defaults stated here.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Floor {
    /// A square without inner walls.
    Hall {},
    /// A corridor around a square block; the corridor is a fifth of the outer side wide.
    Ring {},
    /// The ring without one side, like a letter C.
    Horseshoe {},
    /// A grid of streets around square buildings.
    Blocks {
        /// Width of a street before both lengths are scaled to the area; default 1.
        street: f64,
        /// Side of a building before scaling; default 2.
        building: f64,
    },
    /// One corridor that winds outwards around its inner end.
    Spiral {
        /// Width of the corridor; default 1.6: about three ranges of the sensor.
        corridor: f64,
        /// Thickness of the wall between two turns; default 0.2.
        wall: f64,
    },
    /// Square rooms with thin walls and one door in each wall between two rooms.
    Office {
        /// Side of a room before it is fitted to the area; default 3.
        room: f64,
        /// Width of a door; default 0.9.
        door: f64,
        /// Share of shared walls without a door, default 0.1; every room stays reachable.
        missing_doors: f64,
    },
    /// Two square rooms joined by one door.
    TwoRooms {
        /// Width of the door; default 0.9.
        door: f64,
    },
    /// Corridors that branch and never meet again.
    CorridorTree {
        /// Width of a corridor before both lengths are scaled to the area; default 1.
        corridor: f64,
        /// Distance between neighbouring crossings before scaling, `> corridor`; default 3.
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
        Self::Spiral { corridor: 1.6, wall: 0.2 },
        Self::Office { room: 3.0, door: 0.9, missing_doors: 0.1 },
        Self::TwoRooms { door: 0.9 },
        Self::CorridorTree { corridor: 1.0, pitch: 3.0 },
    ];

    /// The name on the command line and in files.
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

    /// The motion that covers the floor with 40 steps a landmark at any size: wandering, but patrolling where
    /// the way through grows in proportion to the area, which a random walk does not get to the end of.
    #[must_use]
    pub fn motion(&self) -> Motion {
        match self {
            Self::Spiral { .. } | Self::CorridorTree { .. } => Motion::Patrol {},
            _ => Motion::Wander {},
        }
    }

    fn check(&self) -> Result<(), SimError> {
        match *self {
            Self::Hall {} | Self::Ring {} | Self::Horseshoe {} => Ok(()),
            Self::Blocks { street, building } => {
                require_positive("street", street)?;
                require_positive("building", building)
            }
            Self::Spiral { corridor, wall } => {
                require_positive("corridor", corridor)?;
                require_positive("wall", wall)
            }
            Self::Office { room, door, missing_doors } => {
                require_positive("room", room)?;
                require_positive("door", door)?;
                require_share("missing_doors", missing_doors)
            }
            Self::TwoRooms { door } => require_positive("door", door),
            Self::CorridorTree { corridor, pitch } => {
                require_positive("corridor", corridor)?;
                let fine = pitch > corridor && pitch.is_finite();
                require(fine, "pitch", pitch, "wider than the corridor, and finite")
            }
        }
    }
}

impl FromStr for Floor {
    type Err = SimError;

    /// The floor of this name with its default lengths, or [`SimError::UnknownName`].
    fn from_str(name: &str) -> Result<Self, SimError> {
        Self::ALL.into_iter().find(|floor| floor.name() == name).ok_or_else(|| SimError::UnknownName {
            kind: "world",
            name: name.to_owned(),
            known: Self::ALL.map(|floor| floor.name()).join(", "),
        })
    }
}

/// A floor and how landmarks stand on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorldSpec {
    /// Shape of the free space; default a hall.
    pub floor: Floor,
    /// Number of landmarks, 1 to 2^32 - 1; default 800.
    pub landmarks: usize,
    /// Landmarks per square metre of free space, `> 0`; default 10.
    pub density: f64,
    /// How many times denser landmarks stand at the right end than at the left, 0.001 to 1000; default 1.
    /// In between the logarithm of the density rises evenly; the mean over the area stays `density`.
    pub contrast: f64,
    /// Diameter of a landmark, metres, `>= 0`; default 0. Landmarks with a diameter are solid: the robot goes
    /// round them.
    pub diameter: f64,
    /// Least free distance between two landmarks' surfaces, and to a wall, metres, `>= 0`; default 0.
    pub min_gap: f64,
    /// What landmark IDs start with, before their number: letters, digits, `-`, `_`; default `L`.
    pub id_prefix: String,
}

impl Default for WorldSpec {
    fn default() -> Self {
        Self {
            floor: Floor::Hall {},
            landmarks: 800,
            density: 10.0,
            contrast: 1.0,
            diameter: 0.0,
            min_gap: 0.0,
            id_prefix: "L".to_owned(),
        }
    }
}

impl WorldSpec {
    pub(crate) fn check(&self) -> Result<(), SimError> {
        let countable = self.landmarks >= 1 && u32::try_from(self.landmarks).is_ok();
        require(countable, "landmarks", self.landmarks as f64, "between 1 and 2^32 - 1")?;
        require_positive("density", self.density)?;
        let moderate = (1e-3..=1e3).contains(&self.contrast);
        require(moderate, "contrast", self.contrast, "between 0.001 and 1000")?;
        require_not_negative("diameter", self.diameter)?;
        require_not_negative("min_gap", self.min_gap)?;
        let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
        if !self.id_prefix.chars().all(plain) {
            return Err(SimError::IdPrefix { prefix: self.id_prefix.clone() });
        }
        self.floor.check()
    }
}
