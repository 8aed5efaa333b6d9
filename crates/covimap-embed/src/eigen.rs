//! The eigenpairs of symmetric matrices that scaling needs.
//!
//! [`symmetric_eigen`] decomposes a small matrix completely. [`leading_eigenpairs`] finds the
//! largest few of a large one that is only known by its product with vectors.
//!
//! # Algorithm
//! The large solver is a block Davidson method without preconditioner, which is block Lanczos
//! with full orthogonalisation and thick restarts:
//! 1. Rayleigh and Ritz: diagonalise `H = V' B V` on the basis `V`;
//! 2. stop when the residuals `B x - theta x` of the wanted pairs are small;
//! 3. when the basis is full, keep its leading Ritz vectors only;
//! 4. append the residuals of the leading block, made orthonormal to `V`.
//!
//! It works on a block because the leading pair of a round map is nearly degenerate: a method
//! that follows a single vector may return the third eigenvector in place of the second.
//!
//! # References
//! Y. Saad, "Numerical Methods for Large Eigenvalue Problems", 2nd ed., SIAM 2011, ch. 8.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{self, ComputeEigenvectors};
use faer::prelude::default;
use faer::{Mat, MatRef, Par};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Vectors that are multiplied together.
pub(crate) const BLOCK: usize = 8;
/// Ritz vectors that survive a restart.
const KEPT: usize = 2 * BLOCK;
/// Largest basis.
const BASIS: usize = 5 * BLOCK;
/// Products with a block of vectors before the solver gives up.
const MAX_PRODUCTS: usize = 300;

/// Eigenpairs in descending order of the eigenvalue.
pub(crate) struct Eigenpairs {
    pub(crate) values: Vec<f64>,
    /// `vectors[k]` is the unit eigenvector of `values[k]`.
    pub(crate) vectors: Vec<Vec<f64>>,
}

/// Decomposes the symmetric matrix of `n` rows in `entries`, all finite. `O(n^3)`, on one thread.
pub(crate) fn symmetric_eigen(n: usize, entries: &[f64]) -> Eigenpairs {
    let matrix = MatRef::from_row_major_slice(entries, n, n);
    let mut values = Diag::zeros(n);
    let mut vectors = Mat::zeros(n, n);
    let scratch = evd::self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, default());
    evd::self_adjoint_evd(
        matrix,
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        default(),
    )
    .expect("the eigenvalues of a finite symmetric matrix converge (bug in covimap)");
    Eigenpairs {
        values: values.column_vector().iter().rev().copied().collect(),
        vectors: (0..n).rev().map(|k| vectors.col(k).iter().copied().collect()).collect(),
    }
}

/// The largest eigenpairs of the symmetric operator `product` on `n` numbers, one for each of
/// `tolerances`: pair `k` is accepted when its residual is at most `tolerances[k]` times the
/// largest absolute Ritz value. `None` if that does not happen within [`MAX_PRODUCTS`].
///
/// `product` maps the rows of an `n x BLOCK` matrix to those of its product with the operator.
pub(crate) fn leading_eigenpairs(
    n: usize,
    tolerances: &[f64],
    product: impl Fn(&[[f64; BLOCK]]) -> Vec<[f64; BLOCK]>,
) -> Option<Eigenpairs> {
    let mut basis = Basis { vectors: Vec::new(), images: Vec::new() };
    let mut fresh = random_block(n);
    for _ in 0..MAX_PRODUCTS {
        basis.append(fresh, &product);
        let ritz = basis.ritz_pairs();
        let largest = ritz.values.iter().fold(0.0, |most: f64, theta| most.max(theta.abs()));
        fresh = (0..BLOCK.min(ritz.values.len())).map(|k| basis.residual(&ritz, k)).collect();
        let small = |(r, tolerance): (&Vec<f64>, &f64)| dot(r, r).sqrt() <= tolerance * largest;
        if fresh.iter().zip(tolerances).all(small) {
            let vectors = ritz.vectors.iter().take(tolerances.len());
            let vectors = vectors.map(|y| combine(&basis.vectors, y)).collect();
            return Some(Eigenpairs { values: ritz.values[..tolerances.len()].to_vec(), vectors });
        }
        if basis.vectors.len() + BLOCK > BASIS {
            basis.restart(&ritz);
        }
    }
    None
}

/// An orthonormal basis `V` and its images `B V`.
struct Basis {
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

impl Basis {
    /// Appends what the vectors of `fresh` add to the span of the basis.
    fn append(&mut self, fresh: Vec<Vec<f64>>, product: &impl Fn(&[[f64; BLOCK]]) -> Vec<[f64; BLOCK]>) {
        let old = self.vectors.len();
        for mut vector in fresh {
            if orthonormalise(&mut vector, &self.vectors) {
                self.vectors.push(vector);
            }
        }
        let added = &self.vectors[old..];
        let n = self.vectors[0].len();
        let rows: Vec<[f64; BLOCK]> =
            (0..n).map(|i| std::array::from_fn(|k| added.get(k).map_or(0.0, |vector| vector[i]))).collect();
        let image = product(&rows);
        self.images.extend((0..added.len()).map(|k| image.iter().map(|row| row[k]).collect()));
    }

    /// Eigenpairs of `V' B V`.
    fn ritz_pairs(&self) -> Eigenpairs {
        let m = self.vectors.len();
        let mut projected = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..=i {
                let entry = dot(&self.vectors[i], &self.images[j]);
                projected[i * m + j] = entry;
                projected[j * m + i] = entry;
            }
        }
        symmetric_eigen(m, &projected)
    }

    /// `B x - theta x` of the `k`-th Ritz pair.
    fn residual(&self, ritz: &Eigenpairs, k: usize) -> Vec<f64> {
        let mut residual = combine(&self.images, &ritz.vectors[k]);
        subtract(&mut residual, ritz.values[k], &combine(&self.vectors, &ritz.vectors[k]));
        residual
    }

    /// Keeps the leading Ritz vectors only.
    fn restart(&mut self, ritz: &Eigenpairs) {
        let kept = &ritz.vectors[..KEPT.min(ritz.vectors.len())];
        self.vectors = kept.iter().map(|y| combine(&self.vectors, y)).collect();
        self.images = kept.iter().map(|y| combine(&self.images, y)).collect();
    }
}

/// Vectors with entries from a fixed seed.
fn random_block(n: usize) -> Vec<Vec<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    (0..BLOCK).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect()
}

/// Makes `vector` a unit vector orthogonal to `others`; false if it lies in their span, up to
/// rounding. Gram and Schmidt, twice.
fn orthonormalise(vector: &mut [f64], others: &[Vec<f64>]) -> bool {
    let before = dot(vector, vector).sqrt();
    for _ in 0..2 {
        for other in others {
            subtract(vector, dot(vector, other), other);
        }
    }
    let after = dot(vector, vector).sqrt();
    if after <= 1e-14 * before {
        return false;
    }
    vector.iter_mut().for_each(|x| *x /= after);
    true
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn subtract(from: &mut [f64], factor: f64, vector: &[f64]) {
    from.iter_mut().zip(vector).for_each(|(x, y)| *x -= factor * y);
}

/// `sum_k coefficients_k vectors_k`.
fn combine(vectors: &[Vec<f64>], coefficients: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; vectors[0].len()];
    for (vector, coefficient) in vectors.iter().zip(coefficients) {
        subtract(&mut sum, -coefficient, vector);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A symmetric matrix with the given eigenvalues: reflected diagonal, `Q = I - 2 v v' / v'v`.
    fn reflected_diagonal(eigenvalues: &[f64]) -> Vec<f64> {
        let n = eigenvalues.len();
        let v: Vec<f64> = (0..n).map(|i| ((i * i) as f64 * 0.7).sin() + 0.1).collect();
        let norm = dot(&v, &v);
        let q = |i: usize, k: usize| f64::from(u8::from(i == k)) - 2.0 * v[i] * v[k] / norm;
        let entry = |i, j| (0..n).map(|k| q(i, k) * eigenvalues[k] * q(j, k)).sum();
        (0..n * n).map(|at| entry(at / n, at % n)).collect()
    }

    fn product_with(n: usize, matrix: &[f64]) -> impl Fn(&[[f64; BLOCK]]) -> Vec<[f64; BLOCK]> {
        move |block| {
            let entry = |i: usize, k: usize| (0..n).map(|j| matrix[i * n + j] * block[j][k]).sum();
            (0..n).map(|i| std::array::from_fn(|k| entry(i, k))).collect()
        }
    }

    #[test]
    fn a_known_spectrum_is_found_with_its_vectors() {
        let matrix = reflected_diagonal(&[-5.0, 2.0, 0.5, 2.0]);
        let found = symmetric_eigen(4, &matrix);
        for (value, expected) in found.values.iter().zip([2.0, 2.0, 0.5, -5.0]) {
            assert!((value - expected).abs() < 1e-14);
        }
        for (value, vector) in found.values.iter().zip(&found.vectors) {
            for (i, x) in vector.iter().enumerate() {
                assert!((dot(&matrix[4 * i..4 * i + 4], vector) - value * x).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_degenerate_leading_pair_is_found_twice() {
        // Leading pair equal, a third one 1 % below it and a larger negative one.
        let mut eigenvalues: Vec<f64> = (0..120).map(|k| 0.5 * (-0.1 * k as f64).exp()).collect();
        eigenvalues[..4].copy_from_slice(&[1.0, 1.0, 0.99, -3.0]);
        let matrix = reflected_diagonal(&eigenvalues);
        let found = leading_eigenpairs(120, &[1e-12; 3], product_with(120, &matrix)).unwrap();
        for (value, expected) in found.values.iter().zip([1.0, 1.0, 0.99]) {
            assert!((value - expected).abs() < 1e-11, "{value}");
        }
        assert!(dot(&found.vectors[0], &found.vectors[1]).abs() < 1e-12);
    }

    #[test]
    fn a_space_that_the_operator_does_not_fill_is_no_obstacle() {
        let mut eigenvalues = vec![0.0; 50];
        eigenvalues[7] = 4.0;
        let matrix = reflected_diagonal(&eigenvalues);
        let found = leading_eigenpairs(50, &[1e-12; 3], product_with(50, &matrix)).unwrap();
        assert!((found.values[0] - 4.0).abs() < 1e-12 && found.values[1].abs() < 1e-12);
    }

    #[test]
    fn an_impossible_tolerance_is_reported() {
        let matrix = reflected_diagonal(&(0..60).map(f64::from).collect::<Vec<_>>());
        assert!(leading_eigenpairs(60, &[0.0; 2], product_with(60, &matrix)).is_none());
    }
}
