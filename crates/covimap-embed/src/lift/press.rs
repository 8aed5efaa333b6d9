//! The press: what drives objects back into the plane.

use super::Lifted;
use crate::laplacian::{Factored, LowerTriangle, components, tied_laplacian};
use crate::{EmbedError, PairDistances, Point};

/// The last sum of eq. (1), and `V + mu diag(w_i)` with its factor.
pub(super) struct Press {
    mu: f64,
    /// `w_i`.
    weights: Vec<f64>,
    laplacian: LowerTriangle,
    factored: Option<Factored>,
}

impl Press {
    /// There is no press as yet.
    pub fn new(pairs: &PairDistances) -> Self {
        let n = pairs.objects();
        let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
        let (component, _) = components(n, edges.iter().map(|&(i, j, _)| (i, j)));
        let mut weights = vec![0.0; n];
        for &(i, j, weight) in &edges {
            weights[i as usize] += weight;
            weights[j as usize] += weight;
        }
        Self { mu: 0.0, weights, laplacian: tied_laplacian(n, &edges, &component), factored: None }
    }

    /// Sets the press.
    pub fn by(&mut self, mu: f64) -> Result<(), EmbedError> {
        if mu == self.mu {
            return Ok(());
        }
        for (&first, weight) in self.laplacian.starts.iter().zip(&self.weights) {
            self.laplacian.values[first] += (mu - self.mu) * weight;
        }
        self.mu = mu;
        self.factored = Some(match self.factored.take() {
            None => Factored::for_points(&self.laplacian),
            Some(last) => last.refactor(&self.laplacian),
        }?);
        Ok(())
    }

    /// What an object adds to the value, and to half of the gradient.
    pub fn share(&self, own: usize, [_, _, u, v]: Lifted) -> (f64, Lifted) {
        let press = self.mu * self.weights[own];
        (press * (u * u + v * v), [0.0, 0.0, press * u, press * v])
    }

    /// `(V + mu diag(w_i))^-1 y`.
    pub fn solve(&self, y: &[Point]) -> Vec<Point> {
        self.factored.as_ref().expect("pressed before it is solved (bug in covimap)").solve_points(y)
    }
}
