//! Where a robot is, given which landmarks it sees.
//!
//! The map says from where each landmark is seen ([`covimap_map::Sensing`]). A look shows a set `S`; from
//! a place `y` of a chart it has the probability
//!
//! `L(y) = prod_{i in S} (e + (1 - e) q p_i v_i(y)) prod_{j not in S, in sight} (1 - q p_j v_j(y))`  (1)
//!
//! | symbol | meaning |
//! |---|---|
//! | `v_i(y)` | visibility curve of the chart, its edge widened by the deviation of the landmark's own place |
//! | `p_i` | detectability of the landmark |
//! | `e` | chance that a false sighting names just this landmark: the share of false sightings times the size of the set over the number of landmarks |
//! | `q` | quality of the look: 1 as a rule, less for one that shows only part of what is in sight |
//! | in sight | near, and not occluded from half or more of those seen nearby: not seeing what a wall hides says nothing |
//!
//! The prior is uniform over the charts. The posterior may have several *modes*; each has a probability, a
//! mean and a covariance, in which the bend of the chart as a whole is contained. Against all places stands one more hypothesis: that the robot is *lost*, at no place of
//! the map, and sees any landmarks at random, or new ones.
//!
//! # Algorithm
//! 1. Landmarks seen within two ranges of one among them make a crowd; around the middle of every crowd of half the size of the
//!    largest or more, (1) is taken on a coarse grid, and summed over the qualities by their priors.
//! 2. Cells that matter are cut into finer ones, and (1) is taken again.
//! 3. The cells that hold 99.9 % of the posterior fall into connected pieces: the modes.
//!
//! # Complexity
//! `O(k c)` for `k` landmarks near and about 1000 cells; the size of the map enters by its logarithm.

mod modes;
mod sight;
mod surroundings;
mod tracker;

use std::sync::Arc;

use covimap_embed::Point;
use covimap_map::{LandmarkId, Sensing};

use crate::{MapIndex, PlanError};
pub use modes::Mode;
use modes::Patch;
use surroundings::Surroundings;
pub use tracker::{TrackParams, Tracker};

/// Share of false sightings that is reckoned with, whatever the log had: the field is harder.
const FALSE_SHARE: f64 = 0.02;
/// Prior probability of being lost.
const LOST: f64 = 1e-3;
/// Chances of an ID that the map does not have: of a lost robot, and of one that is on the map.
const UNKNOWN: [f64; 2] = [0.5, 0.05];
/// Probability of the best mode below which a place is ambiguous.
const SURE: f64 = 0.9;
/// Crowds with fewer members than this share of the largest one are passed over.
const CROWD: f64 = 0.5;
/// Most landmarks that crowds are looked for among; of more, some evenly spread.
const CROWDED: usize = 256;

/// Most hashes that the names of the copies of an ID are looked for with.
const MOST_HASHES: usize = 4;

/// What one look shows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Look {
    /// Landmarks of the map, ascending, each once.
    pub known: Vec<LandmarkId>,
    /// IDs that several landmarks of the map bear, each with these landmarks.
    pub copies: Vec<Vec<LandmarkId>>,
    /// IDs that the map does not have, in the order given, each once.
    pub unknown: Vec<String>,
}

impl Look {
    /// Number of IDs that the map has.
    fn ids(&self) -> usize {
        self.known.len() + self.copies.len()
    }

    /// Every landmark that may have been seen, ascending.
    fn candidates(&self) -> Vec<LandmarkId> {
        let mut all: Vec<LandmarkId> =
            self.known.iter().chain(self.copies.iter().flatten()).copied().collect();
        all.sort_unstable();
        all
    }
}

/// Where the robot may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Location {
    /// The modes of the posterior, the most likely first. Their probabilities sum to 1 unless there is none:
    /// then no known landmark was seen.
    pub modes: Vec<Mode>,
    /// Probability of being at no place of the map; 1 without a mode.
    pub lost: f64,
    /// How many of the known landmarks seen can be seen from the best mode.
    pub fits: usize,
    /// Those that cannot, ascending: false sightings, if the robot is there. Of an ID that several landmarks bear,
    /// the first.
    pub misfits: Vec<LandmarkId>,
}

impl Location {
    /// The most likely mode.
    #[must_use]
    pub fn best(&self) -> Option<&Mode> {
        self.modes.first()
    }

    /// Whether another mode than the best one has more than a tenth of the probability.
    #[must_use]
    pub fn is_ambiguous(&self) -> bool {
        self.best().is_some_and(|mode| mode.probability < SURE)
    }

    /// Whether the landmarks seen do not go together: no place of the map explains them better than chance,
    /// or none explains more than half of them.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        let most_misfit = !self.misfits.is_empty() && self.misfits.len() >= self.fits;
        self.modes.is_empty() || self.lost > 0.5 || most_misfit
    }
}

/// Finds places on one map. Immutable: threads share one behind an [`Arc`].
#[derive(Debug, Clone)]
pub struct Localiser {
    index: Arc<MapIndex>,
    surroundings: Surroundings,
    /// Area of all charts, each in squares of its range.
    area: f64,
}

impl Localiser {
    /// Makes a map ready, in `O(n log n)` for `n` landmarks.
    ///
    /// # Errors
    /// [`PlanError::NoSensor`] for a map that does not know its sensor.
    pub fn new(index: Arc<MapIndex>) -> Result<Self, PlanError> {
        let map = index.map();
        let sensing = map.sensing().ok_or(PlanError::NoSensor { landmarks: map.len() })?;
        let surroundings = Surroundings::new(map, sensing);
        // A look shows `density pi R^2 p` landmarks in the mean.
        let in_a_look = (map.report().sightings as f64 / map.report().steps.max(1) as f64).max(1.0);
        let seen = |placed: &covimap_map::PlacedLandmark| sensing.sensor(placed.component).detectability;
        let area = std::f64::consts::PI * map.landmarks().iter().map(seen).sum::<f64>() / in_a_look;
        Ok(Self { index, surroundings, area })
    }

    /// The map that places are found on.
    #[must_use]
    pub fn index(&self) -> &Arc<MapIndex> {
        &self.index
    }

    /// Reads a look. An ID that is repeated counts once. Where the build split an ID, so that the map has `A#1`, `A#2` and so on
    /// instead of `A`, the look shows one of them.
    pub fn look<'a>(&self, ids: impl IntoIterator<Item = &'a str>) -> Look {
        let mut look = Look::default();
        for id in ids {
            match self.index.lookup(id) {
                Some(landmark) => look.known.push(landmark),
                None => match self.copies(id) {
                    copies if copies.len() > 1 => look.copies.push(copies),
                    _ if look.unknown.iter().any(|other| other == id) => (),
                    _ => look.unknown.push(id.to_owned()),
                },
            }
        }
        look.known.sort_unstable();
        look.known.dedup();
        look.copies.sort_unstable();
        look.copies.dedup();
        look
    }

    /// The landmarks that the map made of an ID which several bear.
    fn copies(&self, id: &str) -> Vec<LandmarkId> {
        if !self.index.map().params().auto.split_aliases {
            return Vec::new();
        }
        let with = |mark: &str| -> Vec<LandmarkId> {
            (1..).map_while(|number| self.index.lookup(&format!("{id}{mark}{number}"))).collect()
        };
        // Where the log has IDs of its own with one hash, copies have two.
        let mut marked = (1..=MOST_HASHES).rev().map(|hashes| with(&"#".repeat(hashes)));
        marked.find(|found| !found.is_empty()).unwrap_or_default()
    }

    /// Where a robot may be that sees this.
    #[must_use]
    pub fn locate(&self, look: &Look) -> Location {
        let mut crowds = self.crowds(&look.candidates());
        crowds.sort_by_key(|crowd| crowd.0);
        let patch = |crowds: &[(u32, Point)]| {
            let sight = |&(component, middle)| (self.sight(look, component, middle), middle);
            Patch::around(crowds[0].0, &crowds.iter().map(sight).collect::<Vec<_>>())
        };
        let patches: Vec<Patch> = crowds.chunk_by(|a, b| a.0 == b.0).map(patch).collect();
        let best = patches.iter().map(Patch::log_evidence).fold(f64::NEG_INFINITY, f64::max);
        let evidence: f64 = patches.iter().map(|patch| (patch.log_evidence() - best).exp()).sum();
        self.location(look, modes::modes(&patches), best + evidence.ln() - self.area.ln())
    }

    /// These modes, each with the bend of its chart there, by the log of the evidence for being anywhere on the map.
    fn location(&self, look: &Look, mut modes: Vec<Mode>, on_map: f64) -> Location {
        for mode in &mut modes {
            let warp = self.warp(mode.component, mode.position);
            mode.covariance[0] += warp;
            mode.covariance[2] += warp;
        }
        let lost = self.lost(look, on_map);
        let misfits = modes.first().map_or(Vec::new(), |best| self.misfits(look, best));
        Location { modes, lost, fits: look.ids() - misfits.len(), misfits }
    }

    /// Variance of a coordinate of a place by what bends the chart: that of the landmarks within the range, in the mean,
    /// or else of the nearest one.
    fn warp(&self, component: u32, place: Point) -> f64 {
        let range = self.sensing().sensor(component).range;
        let variance = |id: LandmarkId| self.sensing().of(id).warp.powi(2);
        let is_near = |id: &LandmarkId| distance(self.index.placed(*id).position, place) <= range;
        let near = self.surroundings.around(component, place, range).filter(is_near);
        let (sum, count) = near.fold((0.0, 0.0), |(sum, count), id| (sum + variance(id), count + 1.0));
        if count > 0.0 {
            return sum / count;
        }
        let nearest = self.index.nearest_to(component, place, 1).unwrap_or_default();
        nearest.first().map_or(0.0, |near| variance(near.landmark))
    }

    fn misfits(&self, look: &Look, mode: &Mode) -> Vec<LandmarkId> {
        let sight = self.sight(look, mode.component, mode.position);
        let explains = |landmark: LandmarkId| sight.explains(landmark, mode.position);
        let copies = look.copies.iter().filter(|copies| !copies.iter().any(|&copy| explains(copy)));
        let known = look.known.iter().copied().filter(|&landmark| !explains(landmark));
        let mut misfits: Vec<LandmarkId> = known.chain(copies.map(|copies| copies[0])).collect();
        misfits.sort_unstable();
        misfits
    }

    /// Probability of being lost, by the log of the evidence for being anywhere on the map.
    fn lost(&self, look: &Look, on_map: f64) -> f64 {
        let (known, unknown) = (look.ids() as f64, look.unknown.len() as f64);
        let any = ((known + unknown).max(1.0) / self.index.map().len().max(1) as f64).min(1.0);
        let lost = LOST.ln() + known * ((1.0 - UNKNOWN[0]) * any).ln() + unknown * UNKNOWN[0].ln();
        let found = (1.0 - LOST).ln() + on_map + known * (1.0 - UNKNOWN[1]).ln() + unknown * UNKNOWN[1].ln();
        // No evidence of any place: nothing known was seen, or the map has no landmark.
        if found.is_finite() { 1.0 / (1.0 + (found - lost).exp()) } else { 1.0 }
    }

    /// Component and middle of every crowd among the landmarks seen, the largest crowd first.
    fn crowds(&self, known: &[LandmarkId]) -> Vec<(u32, Point)> {
        let placed = self.index.map().landmarks();
        let stride = known.len().div_ceil(CROWDED).max(1);
        let mut left: Vec<LandmarkId> = known.iter().copied().step_by(stride).collect();
        let mut crowds = Vec::new();
        let mut largest = 0;
        while !left.is_empty() {
            let near = |a: LandmarkId, b: LandmarkId| {
                let (a, b) = (&placed[a.index()], &placed[b.index()]);
                let reach = 2.0 * self.sensing().sensor(a.component).range;
                a.component == b.component && distance(a.position, b.position) < reach
            };
            let company = |a: LandmarkId| left.iter().filter(|&&b| near(a, b)).count();
            // The first of those with most company.
            let leader = left
                .iter()
                .copied()
                .rev()
                .max_by_key(|&a| company(a))
                .expect("some are left (bug in covimap)");
            let (crowd, others): (Vec<LandmarkId>, Vec<_>) = left.iter().partition(|&&b| near(leader, b));
            if (crowd.len() as f64) < CROWD * f64::from(largest) {
                break;
            }
            largest = largest.max(crowd.len() as u32);
            let middle = [0, 1].map(|axis| median(crowd.iter().map(|id| placed[id.index()].position[axis])));
            crowds.push((placed[leader.index()].component, middle));
            left = others;
        }
        crowds
    }

    fn sight(&self, look: &Look, component: u32, middle: Point) -> sight::Sight {
        let sensor = self.sensing().sensor(component);
        let seen = (look.ids() + look.unknown.len()) as f64;
        let falsely = (sensor.outliers.max(FALSE_SHARE) * seen / self.index.map().len() as f64).min(0.5);
        sight::Sight::new(&self.surroundings, self.index.map(), look, component, middle, falsely)
    }

    fn sensing(&self) -> &Sensing {
        self.index.map().sensing().expect("checked when made (bug in covimap)")
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { (values[half - 1] + values[half]) / 2.0 }
}

#[cfg(test)]
mod tests;
