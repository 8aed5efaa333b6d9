//! The majorisation loop, the only one: for all kinds of lists and transformations.
//!
//! Two moves alternate, and neither raises `sigma = sum w_ij (e_ij - |x_i - x_j|)^2`:
//!
//! 1. with the disparities `e` fixed, the [Guttman transform](crate::smacof) `X+ = V^+ B(X) X`,
//!    or the relaxed step beyond it;
//! 2. with the points fixed, the [disparities](crate::Transformation) that fit best.
//!
//! # Lead-in
//! From a start that knows nothing of the dissimilarities, the disparities that fit it best know
//! as little: a random start would be admired for what it is. The loop therefore begins with the
//! dissimilarities as disparities, until a step gains less than a tenth of the stress. All
//! transformations admit them, so that the change to fitted ones does not raise the stress.
//!
//! # Relaxed steps
//! The quadratic that lies above `sigma` is as high at `2 X+ - X` as at `X`, so that going twice
//! as far is safe as well, and about halves the number of steps. But `X+` does not depend on the
//! size of `X`: an error of size would come back with the other sign, step after step. So the
//! step starts from `c X`, where `c = tr X'B(X)X / tr X'VX` is the size that fits best, component
//! by component:
//!
//! `X <- 2 X+ - c X`.  (1)
//!
//! Both traces come from what a step has anyhow. With `F = B(X) X` the first is `sum x_i f_i`,
//! and as `V X+ = F`, (1) turns `h = tr X'VX` into
//!
//! `h <- 4 sum x+_i f_i - 3 (sum x_i f_i)^2 / h`.  (2)
//!
//! # References
//! J. de Leeuw, W. J. Heiser, "Multidimensional scaling with restrictions on the configuration",
//! in Multivariate Analysis V, 1980.

use crate::disparity::Disparities;
use crate::forces::PairLayout;
use crate::laplacian::Laplacian;
use crate::solve::{check_start, negligible_stress};
use crate::stress::distance;
use crate::{EmbedError, PairDistances, Point, Smacof, Termination};

/// The lead-in ends with a step that gains less than this share of the stress.
const LEAD_IN: f64 = 0.1;

/// A problem with everything that is the same in every step and from every start.
pub(crate) struct Majoriser<'a> {
    pairs: &'a PairDistances,
    layout: PairLayout<'a>,
    laplacian: Laplacian,
    disparities: Disparities<'a>,
}

/// Where the loop ended.
pub(crate) struct Majorised {
    pub points: Vec<Point>,
    pub disparities: Vec<f64>,
    /// Stress before the first step and after each but the last.
    pub trace: Vec<f64>,
    pub iterations: usize,
    pub termination: Termination,
}

impl<'a> Majoriser<'a> {
    pub fn new(pairs: &'a PairDistances, how: &'a Smacof) -> Result<Self, EmbedError> {
        Ok(Self {
            pairs,
            layout: PairLayout::new(pairs),
            laplacian: Laplacian::of(pairs)?,
            disparities: Disparities::new(pairs, &how.transformation)?,
        })
    }

    /// Runs the loop from `start`. The last step is a plain one: it has the size that fits.
    pub fn run(&self, start: &[Point], how: &Smacof) -> Result<Majorised, EmbedError> {
        check_start(self.pairs, start)?;
        let stop = how.stop;
        let negligible = negligible_stress(self.pairs);
        let mut relaxation = how.relax.then(|| Relaxation::new(self.pairs, &self.laplacian, start));
        let mut points = start.to_vec();
        let mut disparities = self.disparities.first();
        let mut leading = !how.warm && self.disparities.are_fitted();
        if !leading {
            self.disparities.fit(&points, &mut disparities);
        }
        let mut state = self.layout.forces(&points, &disparities);
        let mut trace = vec![state.stress];
        let mut iterations = 0;
        let mut termination = Termination::IterationLimit;
        while iterations < stop.max_iterations {
            iterations += 1;
            let guttman = self.laplacian.solve(&state.forces);
            let moved = match &mut relaxation {
                Some(relaxation) => relaxation.step(&points, &state.forces, &guttman),
                None => guttman.clone(),
            };
            if !leading {
                self.disparities.fit(&moved, &mut disparities);
            }
            let before = state.stress;
            state = self.layout.forces(&moved, &disparities);
            let gain = before - state.stress;
            if !leading && gain <= stop.tolerance * before || state.stress <= negligible {
                termination = Termination::Converged;
            }
            leading &= gain > LEAD_IN * before;
            if termination == Termination::Converged || iterations == stop.max_iterations {
                self.disparities.fit(&guttman, &mut disparities);
                points = guttman;
                break;
            }
            trace.push(state.stress);
            points = moved;
        }
        Ok(Majorised { points, disparities, trace, iterations, termination })
    }
}

/// Steps by eq. (1).
struct Relaxation<'a> {
    /// Component of each object.
    component: &'a [u32],
    /// `h` of each component.
    sizes: Vec<f64>,
}

impl<'a> Relaxation<'a> {
    fn new(pairs: &PairDistances, laplacian: &'a Laplacian, start: &[Point]) -> Self {
        let component = laplacian.component();
        let mut sizes = vec![0.0; laplacian.components()];
        for pair in pairs.pairs() {
            let r = distance(start[pair.i as usize], start[pair.j as usize]);
            sizes[component[pair.i as usize] as usize] += pair.weight * r * r;
        }
        Self { component, sizes }
    }

    fn step(&mut self, points: &[Point], forces: &[Point], guttman: &[Point]) -> Vec<Point> {
        let present = self.products(points, forces);
        let next = self.products(guttman, forces);
        let mut scales = vec![1.0; present.len()];
        for (((h, scale), present), next) in self.sizes.iter_mut().zip(&mut scales).zip(present).zip(next) {
            if *h > 0.0 {
                *scale = present / *h;
                *h = 4.0 * next - 3.0 * present * *scale;
            }
        }
        let step = |((point, guttman), &component): ((&Point, &Point), &u32)| {
            let scale = scales[component as usize];
            [2.0 * guttman[0] - scale * point[0], 2.0 * guttman[1] - scale * point[1]]
        };
        points.iter().zip(guttman).zip(self.component).map(step).collect()
    }

    /// `sum a_i b_i` over each component.
    fn products(&self, a: &[Point], b: &[Point]) -> Vec<f64> {
        let mut sums = vec![0.0; self.sizes.len()];
        for ((a, b), &component) in a.iter().zip(b).zip(self.component) {
            sums[component as usize] += a[0] * b[0] + a[1] * b[1];
        }
        sums
    }
}

#[cfg(test)]
mod tests;
