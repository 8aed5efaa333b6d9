//! Which family of distance functions the log asks for.

use covimap_embed::{DistanceCurve, DistanceFamily, EmbedError, Observation};
use serde::{Deserialize, Serialize};

use super::counts::Sample;

/// A family must be better than a simpler one by more natural units than this: less is chance.
const CLEARLY: f64 = 2.0;

/// How well a family foretells counts that it was not fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FamilyScore {
    /// The family.
    pub family: DistanceFamily,
    /// Log-likelihood of the counts held out, natural units, over the number of steps that tell as
    /// much as one.
    pub held_out: f64,
}

/// The curve of the family with the best score, and the scores.
///
/// `None` where no family can be fitted, or where pairs that one half of the time links are hardly
/// ever together in the other, less than once in the mean: such links are chance.
pub(super) fn choose(
    families: &[DistanceFamily],
    sample: &Sample,
    distances: &[f64],
    repetition: f64,
) -> Option<(DistanceCurve, Vec<FamilyScore>)> {
    let halves = [false, true].map(|odd| sample.half(distances, odd));
    let observations = halves.concat();
    let together: f64 = observations.iter().map(|observation| observation.together).sum();
    if together < observations.len() as f64 {
        return None;
    }
    let scores: Vec<FamilyScore> = families
        .iter()
        .filter_map(|&family| Some(FamilyScore { family, held_out: held_out(family, &halves)? / repetition }))
        .collect();
    let best = scores.iter().map(|score| score.held_out).fold(f64::NEG_INFINITY, f64::max);
    let simplest = scores.iter().find(|score| score.held_out >= best - CLEARLY)?;
    let curve = simplest.family.fit(&observations).ok()?;
    Some((curve, scores))
}

/// Log-likelihood of each half of the time under the curve fitted to the other.
fn held_out(family: DistanceFamily, [even, odd]: &[Vec<Observation>; 2]) -> Option<f64> {
    let judge = |fitted: &[Observation], judged: &[Observation]| -> Result<f64, EmbedError> {
        let curve = family.fit(fitted)?;
        Ok(judged.iter().map(|observation| observation.log_likelihood(&curve)).sum())
    };
    Some(judge(even, odd).ok()? + judge(odd, even).ok()?)
}
