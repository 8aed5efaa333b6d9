//! Honest links: which co-sightings are true, and how often landmarks are misread.
//!
//! A landmark that is misread for another is seen together with landmarks it never stands near. One
//! such link is a shortcut across the map. With one sighting in fifty misread, four links in
//! five are false; but each is weak, and they join anything with anything, while a
//! weak true link joins landmarks that share their neighbours. What weak and sharing mean is
//! learnt from the log; `docs/maths/links.md` has the equations.
//!
//! # Algorithm
//! 1. The number of pairs never seen together bounds the error rate from above ([`error_rate`]).
//! 2. Links too strong for that rate make the backbone of the map ([`backbone`]).
//! 3. Pairs far apart on the backbone are seen together by chance alone: they tell the error rate
//!    ([`error_rate`]). If it is zero, or the log cannot tell, all links are kept.
//! 4. The other links are kept if chance would make too few of their kind ([`verdict`]).
//!
//! # Failure
//! Never. In a room where everything is seen with everything no pair is far, and in a log of few
//! looks nothing is too strong for chance: then no rate can be told, and no link is set aside.

mod backbone;
mod error_rate;
mod poisson;
mod verdict;

use serde::{Deserialize, Serialize};

use crate::{CoVisibility, LandmarkId};
use backbone::Backbone;
use verdict::Kept;

/// What the log says of its own errors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HonestyReport {
    /// Pairs whose co-sightings are taken for recognition errors: they have no link.
    pub set_aside: u64,
    /// Share of sightings, in `[0, 1]`, that show another landmark than was there. `None` if the log is
    /// too small or too thin to tell.
    pub misrecognition: Option<f64>,
}

/// The verdict on every link of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct HonestLinks {
    /// `None`: all are kept.
    kept: Option<Kept>,
    report: HonestyReport,
}

impl HonestLinks {
    /// Judges the links that counts make.
    ///
    /// `O(m k)` for `m` links and steps of `k` landmarks, `O(m)` if the log shows no errors; in parallel
    /// by rows, and the same for any number of threads.
    #[must_use]
    pub fn judge(counts: &CoVisibility) -> Self {
        if counts.pair_count() == 0 {
            return Self { kept: None, report: HonestyReport::default() };
        }
        let backbone = Backbone::new(counts, error_rate::upper_bound(counts));
        let rate = error_rate::estimate(counts, &backbone);
        let kept = rate.filter(|&x| x > 0.0).map(|x| verdict::judge(counts, &backbone, x));
        let sightings: f64 = counts.sightings().iter().map(|&n| f64::from(n)).sum();
        let all_false = |x: f64| x * counts.landmarks() as f64 * counts.steps() as f64;
        let links = |kept: &Kept| kept.iter().flatten().filter(|&&kept| !kept).count() as u64 / 2;
        let report = HonestyReport {
            set_aside: kept.as_ref().map_or(0, links),
            misrecognition: rate.map(|x| (all_false(x) / sightings).min(1.0)),
        };
        Self { kept, report }
    }

    /// Whether the link of a landmark with the partner at this place of its row is kept.
    #[must_use]
    pub fn keeps(&self, landmark: LandmarkId, place: usize) -> bool {
        self.kept.as_ref().is_none_or(|kept| kept[landmark.index()][place])
    }

    /// What the log says of its own errors.
    #[must_use]
    pub fn report(&self) -> HonestyReport {
        self.report
    }
}

#[cfg(test)]
mod tests;
