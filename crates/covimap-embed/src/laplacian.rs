//! The weighted Laplacian of a pair list, factored once.
//!
//! Majorisation solves `V X = Y` with the same `V = sum w_ij (e_i - e_j)(e_i - e_j)'` in every
//! step. `V` is singular: in each connected component it maps constants to zero. One object a
//! component is therefore tied to the origin by an extra diagonal entry. For a right-hand side
//! whose columns sum to zero in every component, which is all that majorisation asks for, the
//! tied solution solves the singular system exactly: summing the equations of a component leaves
//! `c x_tied = 0`.
//!
//! A complete list with equal weights `w` needs no factor: `V = w (n I - 11')`, so that the
//! centred solution is `Y / (w n)`.

use crate::cholesky::{LowerTriangle, SparseCholesky};
use crate::{EmbedError, PairDistances, Point};

/// `V` of a weighted pair list, ready for solves, with the components that it falls into.
pub(crate) struct Laplacian {
    inverse: Inverse,
    /// Component of each object.
    component: Vec<u32>,
    /// Number of objects in each component.
    sizes: Vec<u32>,
}

/// How `V` is inverted on right-hand sides that sum to zero in every component.
enum Inverse {
    /// By this factor: all pairs weigh the same.
    Factor(f64),
    /// By the factor of the tied Laplacian.
    Factored(Box<SparseCholesky<1>>),
}

impl Laplacian {
    /// The Laplacian of a pair list: in closed form where it exists, factored otherwise.
    pub fn of(pairs: &PairDistances) -> Result<Self, EmbedError> {
        let n = pairs.objects();
        if let Some(weight) = pairs.complete_weight() {
            let factor = 1.0 / (n as f64 * weight);
            return Ok(Self {
                inverse: Inverse::Factor(factor),
                component: vec![0; n],
                sizes: vec![n as u32],
            });
        }
        let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
        Self::new(n, &edges)
    }

    /// Factors the Laplacian of `n` objects and weighted edges `(i, j, w)`, `i < j`, ascending.
    pub fn new(n: usize, edges: &[(u32, u32, f64)]) -> Result<Self, EmbedError> {
        let (component, sizes) = components(n, edges.iter().map(|&(i, j, _)| (i, j)));
        let factored = SparseCholesky::new(&tied_laplacian(n, edges, &component))?;
        Ok(Self { inverse: Inverse::Factored(Box::new(factored)), component, sizes })
    }

    /// Component of each object, numbered by its first object.
    pub fn component(&self) -> &[u32] {
        &self.component
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.sizes.len()
    }

    /// Solves `V X = Y` for a `Y` that sums to zero in every component; the solution is centred
    /// at the origin in every component.
    pub fn solve(&self, y: &[Point]) -> Vec<Point> {
        let mut solution = y.to_vec();
        match &self.inverse {
            Inverse::Factor(factor) => solution.as_flattened_mut().iter_mut().for_each(|x| *x *= factor),
            Inverse::Factored(factored) => factored.solve(&mut solution),
        }
        self.centre(&mut solution);
        solution
    }

    /// Moves every component to the origin.
    pub fn centre(&self, points: &mut [Point]) {
        let mut centres = vec![[0.0; 2]; self.sizes.len()];
        for (point, &component) in points.iter().zip(&self.component) {
            let centre = &mut centres[component as usize];
            centre[0] += point[0];
            centre[1] += point[1];
        }
        for (point, &component) in points.iter_mut().zip(&self.component) {
            let size = f64::from(self.sizes[component as usize]);
            point[0] -= centres[component as usize][0] / size;
            point[1] -= centres[component as usize][1] / size;
        }
    }
}

/// Component of each object, numbered by its first object, and the size of each component.
pub(crate) fn components(n: usize, edges: impl Iterator<Item = (u32, u32)>) -> (Vec<u32>, Vec<u32>) {
    let mut parent: Vec<u32> = (0..n as u32).collect();
    fn root(parent: &mut [u32], mut node: u32) -> u32 {
        while parent[node as usize] != node {
            parent[node as usize] = parent[parent[node as usize] as usize];
            node = parent[node as usize];
        }
        node
    }
    for (i, j) in edges {
        let (a, b) = (root(&mut parent, i), root(&mut parent, j));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut component = vec![0; n];
    let mut sizes = Vec::new();
    for node in 0..n as u32 {
        let top = root(&mut parent, node);
        if top == node {
            component[node as usize] = sizes.len() as u32;
            sizes.push(0);
        } else {
            component[node as usize] = component[top as usize];
        }
        sizes[component[node as usize] as usize] += 1;
    }
    (component, sizes)
}

/// Lower triangle of `V` plus the tie of the last object of each component.
pub(crate) fn tied_laplacian(n: usize, edges: &[(u32, u32, f64)], component: &[u32]) -> LowerTriangle<1> {
    let mut diagonal = vec![0.0; n];
    let mut starts = vec![0; n + 1];
    for &(i, j, weight) in edges {
        diagonal[i as usize] += weight;
        diagonal[j as usize] += weight;
        starts[i as usize + 1] += 1;
    }
    let mut last_of = vec![0; n];
    for (node, &c) in component.iter().enumerate() {
        last_of[c as usize] = node;
        starts[node + 1] += starts[node] + 1;
    }
    let mut rows = Vec::with_capacity(n + edges.len());
    let mut blocks = Vec::with_capacity(n + edges.len());
    let mut edges = edges.iter().peekable();
    for node in 0..n {
        rows.push(node as u32);
        blocks.push([[if last_of[component[node] as usize] != node {
            diagonal[node]
        } else if diagonal[node] > 0.0 {
            2.0 * diagonal[node]
        } else {
            // A component of one object has no edge; any positive entry will do.
            1.0
        }]]);
        while let Some(&(_, j, weight)) = edges.next_if(|edge| edge.0 as usize == node) {
            rows.push(j);
            blocks.push([[-weight]]);
        }
    }
    LowerTriangle { starts, rows, blocks }
}

#[cfg(test)]
mod tests;
