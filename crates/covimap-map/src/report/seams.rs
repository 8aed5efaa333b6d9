//! Where a map hangs together, and where it does so by little.

use serde::{Deserialize, Serialize};

/// How two overlapping regions lie to each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeamReport {
    /// The two regions.
    pub regions: [u32; 2],
    /// Landmarks in both.
    pub shared: u32,
    /// Root mean square misfit over shared landmarks and links across, in map units, of the fit that was
    /// used; of the likelier one where none was.
    pub residual: f64,
    /// Least over greatest spread of the shared landmarks, in `[0, 1]`: 0 on a line, where a fit and its
    /// mirror image cannot be told apart by them.
    pub condition: f64,
    /// How much likelier this side is than the mirror image, as the logarithm of the ratio.
    pub evidence: f64,
    /// Share of its weight that the seam kept when all seams were made to agree, in `[0, 1]`.
    pub trust: f64,
}

/// A seam that alone decides the side of all that lies beyond it, on little evidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hinge {
    /// The likeliest of the seams between the two parts.
    pub seam: SeamReport,
    /// Landmarks of the smaller part.
    pub landmarks: u32,
}

/// The seams of a component.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SeamsReport {
    /// Number of all seams.
    pub count: u64,
    /// Those that contradict the others and were left out.
    pub dropped: Vec<SeamReport>,
    /// Those that the side of a part of the map hangs on.
    pub hinges: Vec<Hinge>,
}

impl SeamsReport {
    /// The same with all regions numbered from `first`.
    pub(crate) fn numbered_from(mut self, first: u32) -> Self {
        let hinges = self.hinges.iter_mut().map(|hinge| &mut hinge.seam);
        for seam in self.dropped.iter_mut().chain(hinges) {
            seam.regions = seam.regions.map(|region| region + first);
        }
        self
    }
}

/// The seams of charts that have become one, and new hinges; `place` gives regions their new numbers, `None` to those
/// that are not in it.
pub(crate) fn joined_seams<'a>(
    charts: impl Iterator<Item = &'a SeamsReport>,
    hinges: &[Hinge],
    place: impl Fn(u32) -> Option<u32>,
) -> SeamsReport {
    let seam = |seam: &SeamReport| {
        let [a, b] = seam.regions.map(&place);
        Some(SeamReport { regions: [a?, b?], ..seam.clone() })
    };
    let hinge = |hinge: &Hinge| Some(Hinge { seam: seam(&hinge.seam)?, landmarks: hinge.landmarks });
    let mut joined = SeamsReport::default();
    for chart in charts {
        joined.count += chart.count;
        joined.dropped.extend(chart.dropped.iter().filter_map(seam));
        joined.hinges.extend(chart.hinges.iter().filter_map(hinge));
    }
    joined.hinges.extend(hinges.iter().filter_map(hinge));
    joined
}
