//! The press: what drives objects back into the plane.

use super::Lifted;
use crate::cholesky::{Factored, LowerTriangle};
use crate::laplacian::{Laplacian, components, tied_laplacian};
use crate::{EmbedError, PairDistances, Point};

/// The last sum of eq. (1), and `V + mu diag(w_i)` with its factor.
pub(super) struct Press {
    mu: f64,
    /// `w_i`.
    weights: Vec<f64>,
    matrix: LowerTriangle<1>,
    factored: Factored<1>,
}

impl Press {
    /// A press `mu`. `laplacian` is that of the same pairs, whose order the factor takes over.
    pub fn new(pairs: &PairDistances, laplacian: &Laplacian, mu: f64) -> Result<Self, EmbedError> {
        let n = pairs.objects();
        let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
        let (component, _) = components(n, edges.iter().map(|&(i, j, _)| (i, j)));
        let mut weights = vec![0.0; n];
        for &(i, j, weight) in &edges {
            weights[i as usize] += weight;
            weights[j as usize] += weight;
        }
        let mut matrix = tied_laplacian(n, &edges, &component);
        press(&mut matrix, &weights, mu);
        let factored = match laplacian.factored() {
            Some(factored) => factored.another(&matrix),
            None => Factored::new(&matrix),
        }?;
        Ok(Self { mu, weights, matrix, factored })
    }

    /// The same with another press.
    pub fn by(mut self, mu: f64) -> Result<Self, EmbedError> {
        if mu == self.mu {
            return Ok(self);
        }
        press(&mut self.matrix, &self.weights, mu - self.mu);
        let factored = self.factored.refactor(&self.matrix)?;
        Ok(Self { mu, factored, ..self })
    }

    /// What an object adds to the value, and to half of the gradient.
    #[inline(always)]
    pub fn share(&self, own: usize, [_, _, u, v]: Lifted) -> (f64, Lifted) {
        let press = self.mu * self.weights[own];
        (press * (u * u + v * v), [0.0, 0.0, press * u, press * v])
    }

    /// Replaces `y` by `(V + mu diag(w_i))^-1 y`.
    pub fn solve(&self, y: &mut [Point]) {
        self.factored.solve(y);
    }
}

/// Adds `mu diag(w_i)`.
fn press(matrix: &mut LowerTriangle<1>, weights: &[f64], mu: f64) {
    for (&first, weight) in matrix.starts.iter().zip(weights) {
        matrix.blocks[first as usize][0][0] += mu * weight;
    }
}
