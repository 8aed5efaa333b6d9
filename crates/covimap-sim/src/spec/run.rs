//! Settings of a robot's run.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{ErrorSpec, SensorSpec, require, require_not_negative, require_positive};
use crate::angle::Angle;
use crate::error::SimError;

/// How the robot chooses its way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Motion {
    /// On and on in about the last direction: the paper's robot.
    Wander {},
    /// Always towards the neighbouring patch of floor that it left longest ago.
    Patrol {},
    /// By a short way to one random place after the other.
    Waypoints {},
    /// To and fro in parallel lanes, tile by tile, over and over.
    Sweep {
        /// Distance between two lanes, metres, `> 0`; default 0.5.
        lane: f64,
    },
    /// No way at all: every observation is made from an independent random place and direction.
    Scatter {},
}

impl Motion {
    /// Every motion with its defaults.
    pub const ALL: [Self; 5] =
        [Self::Wander {}, Self::Patrol {}, Self::Waypoints {}, Self::Sweep { lane: 0.5 }, Self::Scatter {}];

    /// The name on the command line and in files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Wander {} => "wander",
            Self::Patrol {} => "patrol",
            Self::Waypoints {} => "waypoints",
            Self::Sweep { .. } => "sweep",
            Self::Scatter {} => "scatter",
        }
    }
}

impl FromStr for Motion {
    type Err = SimError;

    /// The motion of this name with its defaults, or [`SimError::UnknownName`].
    fn from_str(name: &str) -> Result<Self, SimError> {
        Self::ALL.into_iter().find(|motion| motion.name() == name).ok_or_else(|| SimError::UnknownName {
            kind: "motion",
            name: name.to_owned(),
            known: Self::ALL.map(|motion| motion.name()).join(", "),
        })
    }
}

/// How a robot takes a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StepSpec {
    /// Largest turn to either side of the wanted direction, 0 to 180 degrees; default 45 degrees.
    pub turn: Angle,
    /// Shortest step, metres, `> 0`; default 0.1.
    pub shortest: f64,
    /// Longest step, metres, `>= shortest`; default 0.2. Lengths are uniform between the two.
    pub longest: f64,
    /// Distance that the robot's middle keeps from walls and from landmarks' surfaces, metres, `>= 0`;
    /// default 0.05.
    pub clearance: f64,
}

impl Default for StepSpec {
    fn default() -> Self {
        Self { turn: Angle::from_deg(45.0), shortest: 0.1, longest: 0.2, clearance: 0.05 }
    }
}

/// A robot's run through a world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunSpec {
    /// Number of observations, the first one at the start; default 32 000.
    pub steps: u64,
    /// How the robot chooses its way; default wandering.
    pub motion: Motion,
    /// Number of robots that go one after another from random places, each for an equal share of the steps,
    /// `>= 1`; default 1.
    pub robots: u32,
    /// How it takes a step.
    pub step: StepSpec,
    /// What it recognises.
    pub sensor: SensorSpec,
    /// What goes wrong with that.
    pub errors: ErrorSpec,
}

impl Default for RunSpec {
    fn default() -> Self {
        Self {
            steps: 32_000,
            motion: Motion::Wander {},
            robots: 1,
            step: StepSpec::default(),
            sensor: SensorSpec::default(),
            errors: ErrorSpec::default(),
        }
    }
}

impl RunSpec {
    pub(crate) fn check(&self) -> Result<(), SimError> {
        let StepSpec { turn, shortest, longest, clearance } = self.step;
        require((0.0..=180.0).contains(&turn.deg()), "turn", turn.deg(), "between 0 and 180 degrees")?;
        require_positive("shortest", shortest)?;
        let fine = longest >= shortest && longest.is_finite();
        require(fine, "longest", longest, "at least the shortest step, and finite")?;
        require_not_negative("clearance", clearance)?;
        require(self.robots >= 1, "robots", f64::from(self.robots), "at least 1")?;
        if let Motion::Sweep { lane } = self.motion {
            require_positive("lane", lane)?;
        }
        self.sensor.check()?;
        self.errors.check()
    }
}
