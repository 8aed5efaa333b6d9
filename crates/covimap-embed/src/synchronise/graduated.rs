//! Node values from measured differences, some of which are wrong.
//!
//! Finds `x` that minimises, over the edges `(a, b)` with measurement `d` and weight `w`,
//!
//! `sum w rho(r)`, `r = d - (x_b - x_a)`, `rho(r) = r^2 sigma^2 / (sigma^2 + r^2)`  (1)
//!
//! # Algorithm
//! Graduated non-convexity: Gauss and Newton's step on the weighted Laplacian, weights
//! `w (sigma^2 / (sigma^2 + r^2))^2` from the step before, while `sigma` shrinks from a value at
//! which every edge counts to [`TUNING`] times the noise of good edges. That noise is
//!
//! `1.48 median(r) sqrt(m / (m - n + 1))`  (2)
//!
//! over the `m` edges that lie on cycles through `n` nodes: the last factor makes up for what the
//! fit has taken out of the residuals, so that a single loop is not torn open at one edge.
//! Residuals are scaled by the root of their relative weight before they are compared.
//!
//! # References
//! H. Yang, P. Antonante, V. Tzoumas, L. Carlone, "Graduated non-convexity for robust spatial
//! perception", IEEE RA-L 5(2), 2020.

use super::bridges::bridges;
use crate::EmbedError;
use crate::cholesky::SparseCholesky;
use crate::laplacian::tied_laplacian;

/// Steps before the fit stands as it is.
const MAX_STEPS: usize = 60;
/// `sigma` shrinks by this factor a step.
const SHRINK: f64 = 0.5;
/// Multiple of the noise at which an edge loses three quarters of its weight.
const TUNING: f64 = 3.0;
/// Least noise believed in, as a share of the unit of the measurements.
const LEAST_NOISE: f64 = 1e-9;
/// The fit is done when the mean trust changes by less than this, and `sigma` by less than this
/// share.
const SETTLED: f64 = 1e-3;
/// Least share of its weight that an edge has in a step, so that the system keeps full rank.
const LEAST_TRUST: f64 = 1e-12;

/// A measured difference of two nodes, `x_b - x_a`.
#[derive(Clone, Copy)]
pub(super) struct Difference<const K: usize> {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) measured: [f64; K],
    pub(super) weight: f64,
    /// Share of the weight that is left to the edge before this fit, in `[0, 1]`.
    pub(super) prior: f64,
}

/// What kind of value is fitted.
pub(super) struct Kind {
    /// Period of the values, for angles.
    pub(super) period: Option<f64>,
    /// A difference that is neither large nor small.
    pub(super) unit: f64,
    /// First `sigma`: infinite where the start says nothing.
    pub(super) first_sigma: f64,
    /// Weight of a pull of every node towards one common value, `>= 0`.
    pub(super) pull: f64,
}

/// Values of all nodes, node 0 at zero, and the trust that this fit leaves in each edge, in
/// `[0, 1]`.
pub(super) struct Fitted<const K: usize> {
    pub(super) values: Vec<[f64; K]>,
    pub(super) trust: Vec<f64>,
}

/// Minimises (1) from `start`, on a connected graph with at least one edge.
pub(super) fn fit<const K: usize>(
    start: Vec<[f64; K]>,
    edges: &[Difference<K>],
    kind: &Kind,
) -> Result<Fitted<K>, EmbedError> {
    let nodes = start.len();
    let noise = Noise::new(nodes, edges);
    let pulls = pulls_of(nodes, kind.pull);
    let mut system = System::new(nodes + usize::from(!pulls.is_empty()), edges.iter().chain(&pulls));
    let mut values = start;
    values.resize(system.nodes, [0.0; K]);
    let mut trust = vec![0.0; edges.len()];
    let mut sigma = kind.first_sigma;
    for _ in 0..MAX_STEPS {
        let sizes = noise.standardised(&residuals(&values, edges, kind.period));
        let before = std::mem::replace(&mut trust, noise.trusts(&sizes, sigma));
        let weighted = edges.iter().zip(&trust).map(|(edge, trust)| Difference {
            weight: edge.weight * (edge.prior * trust).max(LEAST_TRUST),
            ..*edge
        });
        let weighted: Vec<_> = weighted.chain(pulls.iter().copied()).collect();
        system.step(&mut values, &weighted, kind.period)?;
        let sizes = noise.standardised(&residuals(&values, edges, kind.period));
        let largest = sizes.iter().fold(0.0, |most: f64, &r| most.max(r));
        let floor = LEAST_NOISE * kind.unit;
        let least = TUNING * noise.of(&sizes).max(floor);
        let change = trust.iter().zip(&before).map(|(a, b)| (a - b).abs()).sum::<f64>() / edges.len() as f64;
        if largest <= floor || change <= SETTLED && sigma <= least * (1.0 + SETTLED) {
            break;
        }
        sigma = (SHRINK * sigma.min(largest)).max(least);
    }
    let first = values[0];
    values.truncate(nodes);
    values.iter_mut().flat_map(|value| value.iter_mut().zip(&first)).for_each(|(x, x0)| *x -= x0);
    Ok(Fitted { values, trust })
}

/// `d - (x_b - x_a)`, taken into the period.
fn residuals<const K: usize>(
    values: &[[f64; K]],
    edges: &[Difference<K>],
    period: Option<f64>,
) -> Vec<[f64; K]> {
    let residual = |edge: &Difference<K>| {
        let (from, to) = (&values[edge.a as usize], &values[edge.b as usize]);
        std::array::from_fn(|k| {
            let r = edge.measured[k] - (to[k] - from[k]);
            period.map_or(r, |period| r - period * (r / period).round())
        })
    };
    edges.iter().map(residual).collect()
}

/// Edges of weight `pull` from one more node to all others; none if the weight is zero.
fn pulls_of<const K: usize>(nodes: usize, pull: f64) -> Vec<Difference<K>> {
    let common = nodes as u32;
    let count = if pull > 0.0 { common } else { 0 };
    (0..count).map(|b| Difference { a: common, b, measured: [0.0; K], weight: pull, prior: 1.0 }).collect()
}

/// Estimates the noise of good edges from the residuals of all.
struct Noise {
    /// Root of the weight of each edge over the mean weight.
    roots: Vec<f64>,
    /// Edges that lie on a cycle.
    cyclic: Vec<usize>,
    /// The last factor of (2) and the one before the median.
    factor: f64,
}

impl Noise {
    fn new<const K: usize>(nodes: usize, edges: &[Difference<K>]) -> Self {
        let mean = edges.iter().map(|edge| edge.weight).sum::<f64>() / edges.len() as f64;
        let ends: Vec<(u32, u32)> = edges.iter().map(|edge| (edge.a, edge.b)).collect();
        let bridge = bridges(nodes, &ends);
        let cyclic: Vec<usize> = (0..edges.len()).filter(|&k| !bridge[k]).collect();
        let excess = (edges.len() + 1 - nodes) as f64;
        Self {
            roots: edges.iter().map(|edge| (edge.weight / mean).sqrt()).collect(),
            factor: 1.48 * (cyclic.len() as f64 / excess).sqrt(),
            cyclic,
        }
    }

    fn standardised<const K: usize>(&self, residuals: &[[f64; K]]) -> Vec<f64> {
        let length = |r: &[f64; K]| r.iter().map(|x| x * x).sum::<f64>().sqrt();
        residuals.iter().zip(&self.roots).map(|(r, root)| root * length(r)).collect()
    }

    /// Trust in each edge; full trust in bridges, which nothing speaks against.
    fn trusts(&self, sizes: &[f64], sigma: f64) -> Vec<f64> {
        let mut trust = vec![1.0; sizes.len()];
        if sigma.is_finite() {
            for &k in &self.cyclic {
                trust[k] = (sigma * sigma / (sigma * sigma + sizes[k] * sizes[k])).powi(2);
            }
        }
        trust
    }

    /// Eq. (2); zero without cycles.
    fn of(&self, sizes: &[f64]) -> f64 {
        if self.cyclic.is_empty() {
            return 0.0;
        }
        let mut sizes: Vec<f64> = self.cyclic.iter().map(|&k| sizes[k]).collect();
        let middle = sizes.len() / 2;
        self.factor * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// The normal equations: the places of their entries stay, the weights change.
struct System {
    nodes: usize,
    /// Pairs of nodes that edges connect, `i < j`, ascending.
    pairs: Vec<(u32, u32)>,
    /// The pair of each edge.
    pair_of: Vec<usize>,
    factored: Option<SparseCholesky<1>>,
}

impl System {
    fn new<'a, const K: usize>(nodes: usize, edges: impl Iterator<Item = &'a Difference<K>>) -> Self {
        let ends: Vec<(u32, u32)> = edges.map(|edge| (edge.a.min(edge.b), edge.a.max(edge.b))).collect();
        let mut pairs = ends.clone();
        pairs.sort_unstable();
        pairs.dedup();
        let place = |end| pairs.binary_search(end).expect("every edge has its pair (bug in covimap)");
        let pair_of = ends.iter().map(place).collect();
        Self { nodes, pairs, pair_of, factored: None }
    }

    /// Adds the step that minimises `sum w |r - (dx_b - dx_a)|^2`.
    fn step<const K: usize>(
        &mut self,
        values: &mut [[f64; K]],
        edges: &[Difference<K>],
        period: Option<f64>,
    ) -> Result<(), EmbedError> {
        let mut pairs: Vec<(u32, u32, f64)> = self.pairs.iter().map(|&(i, j)| (i, j, 0.0)).collect();
        let mut rhs = vec![[0.0; K]; self.nodes];
        for ((edge, r), &pair) in edges.iter().zip(residuals(values, edges, period)).zip(&self.pair_of) {
            pairs[pair].2 += edge.weight;
            for (k, r) in r.iter().enumerate() {
                rhs[edge.b as usize][k] += edge.weight * r;
                rhs[edge.a as usize][k] -= edge.weight * r;
            }
        }
        let matrix = tied_laplacian(self.nodes, &pairs, &vec![0; self.nodes]);
        let factored = match self.factored.take() {
            None => SparseCholesky::new(&matrix)?,
            Some(factored) => factored.refactor(&matrix)?,
        };
        factored.solve(&mut rhs);
        self.factored = Some(factored);
        for (value, step) in values.iter_mut().zip(rhs) {
            value.iter_mut().zip(step).for_each(|(x, step)| *x += step);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: Kind = Kind { period: None, unit: 1.0, first_sigma: f64::INFINITY, pull: 0.0 };

    fn difference(a: u32, b: u32, measured: f64, weight: f64) -> Difference<1> {
        Difference { a, b, measured: [measured], weight, prior: 1.0 }
    }

    fn assert_values(fitted: &Fitted<1>, expected: &[f64]) {
        for ([found], expected) in fitted.values.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{:?}", fitted.values);
        }
    }

    #[test]
    fn a_loop_shares_its_gap() {
        // 1 + 1 against 2.3: the gap of 0.3 falls on three equal edges.
        let edges = [difference(0, 1, 1.0, 1.0), difference(1, 2, 1.0, 1.0), difference(0, 2, 2.3, 1.0)];
        let fitted = fit(vec![[0.0]; 3], &edges, &FREE).unwrap();
        assert_values(&fitted, &[0.0, 1.1, 2.2]);
        assert!((fitted.trust[0] - fitted.trust[2]).abs() < 1e-9);
    }

    #[test]
    fn of_a_loop_the_weak_edge_gives_way() {
        // Weights 2, 2, 1 share the gap of 0.3 as 1/2 : 1/2 : 1, in the least-squares fit.
        let edges = [difference(0, 1, 1.0, 2.0), difference(1, 2, 1.0, 2.0), difference(0, 2, 2.3, 1.0)];
        let noise = Noise::new(3, &edges);
        let mut values = vec![[0.0]; 3];
        System::new(3, edges.iter()).step(&mut values, &edges, None).unwrap();
        assert!((values[1][0] - values[0][0] - 1.075).abs() < 1e-12);
        let left = residuals(&values, &edges, None);
        assert!((left[2][0] - 0.15).abs() < 1e-12);
        // Eq. (2) with m = n = 3. The sizes are 0.075, 0.075 and 0.15 times the roots of the
        // weights over their mean of 5/3; the median is 0.075 sqrt(6/5).
        let expected = 1.48 * f64::sqrt(3.0) * 0.075 * f64::sqrt(1.2);
        assert!((noise.of(&noise.standardised(&left)) - expected).abs() < 1e-12);
    }

    #[test]
    fn a_wrong_difference_among_right_ones_is_left_out() {
        let mut edges = Vec::new();
        for a in 0..5 {
            edges.extend((a + 1..5).map(|b| difference(a, b, f64::from(b - a), 1.0)));
        }
        edges[2].measured[0] = 50.0;
        let fitted = fit(vec![[0.0]; 5], &edges, &FREE).unwrap();
        assert_values(&fitted, &[0.0, 1.0, 2.0, 3.0, 4.0]);
        assert!(
            fitted.trust.iter().enumerate().all(|(k, &trust)| (trust < 1e-6) == (k == 2)),
            "{:?}",
            fitted.trust
        );
    }

    #[test]
    fn without_loops_every_edge_is_believed() {
        let edges = [difference(1, 0, -7.0, 1.0), difference(1, 2, 1e-3, 5.0)];
        let fitted = fit(vec![[0.0]; 3], &edges, &FREE).unwrap();
        assert_values(&fitted, &[0.0, 7.0, 7.001]);
        assert_eq!(fitted.trust, [1.0; 2]);
    }

    #[test]
    fn a_period_is_minded() {
        let edges = [difference(0, 1, 3.0, 1.0), difference(1, 2, 3.0, 1.0), difference(2, 0, 4.0, 1.0)];
        let kind = Kind { period: Some(10.0), ..FREE };
        let start = vec![[0.0], [2.0], [7.5]];
        assert_values(&fit(start, &edges, &kind).unwrap(), &[0.0, 3.0, 6.0]);
    }
}
