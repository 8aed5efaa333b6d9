//! Settings of sensors and of their errors.

use serde::{Deserialize, Serialize};

use super::{require, require_not_negative, require_positive, require_share};
use crate::angle::Angle;
use crate::error::SimError;

/// On what it depends whether a landmark in view is recognised.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "by", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Recognition {
    /// Distance `d`: probability `detection / (1 + exp((d - range) / edge))`.
    Range {
        /// Distance of half the chance, metres, `> 0`; default 0.55.
        range: f64,
        /// Softness of the edge, metres, `> 0`; default 0.04.
        edge: f64,
        /// Chance to recognise a landmark close by, 0 to 1; default 0.95.
        detection: f64,
    },
    /// Visual angle `v` of the part that shows: `v > threshold`, or probability `1 / (1 + exp(-K (v - threshold)))`.
    VisualAngle {
        /// Least and greatest threshold, `> 0`, at most 180 degrees; each landmark has its own, uniform
        /// between them. Default 5 degrees for both.
        threshold: [Angle; 2],
        /// Steepness `K` of the logistic curve, per radian, `> 0`; default none, a sharp threshold.
        steepness: Option<f64>,
    },
}

impl Recognition {
    /// By visual angle as in the paper: the same threshold of 5 degrees for all, which a cylinder 48 mm across
    /// that nothing hides reaches at 0.55 m.
    #[must_use]
    pub fn paper() -> Self {
        Self::VisualAngle { threshold: [Angle::from_deg(5.0); 2], steepness: None }
    }
}

/// What the robot recognises.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorSpec {
    /// What decides; default the distance.
    pub recognition: Recognition,
    /// Field of view, half of it to either side of the heading, `> 0` to 360 degrees; default 360 degrees.
    pub view: Angle,
    /// Least and greatest detectability, 0 to 1: each landmark has its own, uniform between them, and its
    /// chance to be recognised is multiplied by it. Default 1 for both.
    pub detectability: [f64; 2],
    /// Noise of ranges, `>= 0`: every step tells the distance to the middle of each landmark seen, `d exp(noise z)` for a standard normal
    /// `z`, so that .05 is about five per cent. Default none: no ranges.
    pub range_noise: Option<f64>,
}

impl Default for SensorSpec {
    fn default() -> Self {
        Self {
            recognition: Recognition::Range { range: 0.55, edge: 0.04, detection: 0.95 },
            view: Angle::FULL,
            detectability: [1.0; 2],
            range_noise: None,
        }
    }
}

impl SensorSpec {
    pub(super) fn check(&self) -> Result<(), SimError> {
        let view = self.view.rad();
        let fine = view > 0.0 && view <= Angle::FULL.rad();
        require(fine, "view", self.view.deg(), "more than 0 and at most 360 degrees")?;
        let [low, high] = self.detectability;
        require_share("least detectability", low)?;
        require((low..=1.0).contains(&high), "greatest detectability", high, "between the least and 1")?;
        if let Some(noise) = self.range_noise {
            require_not_negative("range noise", noise)?;
        }
        match self.recognition {
            Recognition::Range { range, edge, detection } => {
                require_positive("range", range)?;
                require_positive("edge", edge)?;
                require_share("detection", detection)
            }
            Recognition::VisualAngle { threshold, steepness } => {
                let [low, high] = threshold.map(Angle::deg);
                require(low > 0.0 && low <= 180.0, "least threshold", low, "above 0, at most 180 degrees")?;
                require(
                    (low..=180.0).contains(&high),
                    "greatest threshold",
                    high,
                    "the least to 180 degrees",
                )?;
                steepness.map_or(Ok(()), |steepness| require_positive("steepness", steepness))
            }
        }
    }
}

/// Recognition errors, both 0 by default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ErrorSpec {
    /// Non-recognition: share of sightings that are lost, 0 to 1.
    pub missed: f64,
    /// Misrecognition: share of the sightings left that turn into another, random landmark, 0 to 1.
    pub mistaken: f64,
}

impl ErrorSpec {
    pub(super) fn check(&self) -> Result<(), SimError> {
        require_share("missed", self.missed)?;
        require_share("mistaken", self.mistaken)
    }
}
