//! Relaxed steps: twice as far.
//!
//! The quadratic that lies above `sigma` is as high at `2 X+ - X` as at `X`, so that going twice
//! as far is safe as well, and about halves the number of steps. But `X+` does not depend on the
//! size of `X`: an error of size would come back with the other sign, step after step. So the
//! step starts from `c X`, where `c = sum w e r / sum w r^2` is the size that fits best, component
//! by component:
//!
//! `X <- 2 X+ - c X`.  (1)
//!
//! # References
//! J. de Leeuw, W. J. Heiser, "Multidimensional scaling with restrictions on the configuration",
//! in Multivariate Analysis V, 1980.

use super::{Majoriser, State};
use crate::Point;
use crate::stress::distance;

impl Majoriser<'_> {
    /// Eq. (1); `step` is `X - X+`.
    pub(super) fn relaxed(&self, state: &State, step: &[Point]) -> Vec<Point> {
        let component = self.laplacian.component();
        let mut sums = vec![[0.0; 2]; self.laplacian.components()];
        for (pair, e) in self.pairs.pairs().iter().zip(state.disparities.iter()) {
            let r = distance(state.points[pair.i as usize], state.points[pair.j as usize]);
            let [fit, extent] = &mut sums[component[pair.i as usize] as usize];
            *fit += pair.weight * e * r;
            *extent += pair.weight * r * r;
        }
        // 2 X+ - c X = (2 - c) X - 2 (X - X+).
        let keep: Vec<f64> =
            sums.iter().map(|[fit, extent]| if *extent > 0.0 { 2.0 - fit / extent } else { 1.0 }).collect();
        let kept = state.points.iter().zip(component).map(|(point, &c)| point.map(|x| keep[c as usize] * x));
        kept.zip(step).map(|(kept, step)| [kept[0] - 2.0 * step[0], kept[1] - 2.0 * step[1]]).collect()
    }
}
