use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::solve::tests::{cases, random_points};

/// `V X`, edge by edge.
fn times_laplacian(edges: &[(u32, u32, f64)], points: &[Point]) -> Vec<Point> {
    let mut sums = vec![[0.0; 2]; points.len()];
    for &(i, j, weight) in edges {
        let (a, b) = (points[i as usize], points[j as usize]);
        let pull = [weight * (a[0] - b[0]), weight * (a[1] - b[1])];
        for (object, sign) in [(i, 1.0), (j, -1.0)] {
            let sum = &mut sums[object as usize];
            *sum = [sum[0] + sign * pull[0], sum[1] + sign * pull[1]];
        }
    }
    sums
}

#[test]
fn solves_the_singular_system_in_every_component() {
    // Two components {0, 1, 2} and {3, 4}, and 5 alone.
    let edges = [(0, 1, 2.0), (0, 2, 1.0), (1, 2, 0.5), (3, 4, 3.0)];
    let wanted = [[1.0, 0.0], [-2.0, 1.0], [1.0, -1.0], [0.5, 2.0], [-0.5, -2.0], [0.0, 0.0]];
    let y = times_laplacian(&edges, &wanted);
    let solved = Laplacian::new(6, &edges).unwrap().solve(&y);
    for (got, want) in solved.iter().zip(&wanted) {
        assert!((got[0] - want[0]).hypot(got[1] - want[1]) < 1e-12, "{got:?} for {want:?}");
    }
}

#[test]
fn components_are_numbered_by_their_first_object() {
    let (component, sizes) = components(6, [(4, 5), (0, 3), (3, 5)].into_iter());
    assert_eq!(component, [0, 1, 2, 0, 0, 0]);
    assert_eq!(sizes, [4, 1, 1]);
}

#[test]
fn no_object_at_all() {
    assert!(Laplacian::new(0, &[]).unwrap().solve(&[]).is_empty());
}

proptest! {
    #![proptest_config(cases(64))]

    /// Whatever the graph: `V` times the solution is the right-hand side, and it is centred.
    #[test]
    fn the_solution_solves(n in 1_u32..40, density in 0.0..0.3, seed in 0_u64..1000) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut edges = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
            if rng.random_bool(density) {
                edges.push((i, j, 10f64.powf(rng.random_range(-3.0..3.0))));
            }
        }
        // Pulls along the edges sum to zero in every component.
        let wanted = random_points(n as usize, &mut rng);
        let right = times_laplacian(&edges, &wanted);
        let solved = Laplacian::new(n as usize, &edges).unwrap().solve(&right);
        let left = times_laplacian(&edges, &solved);
        for (got, wanted) in left.iter().flatten().zip(right.iter().flatten()) {
            prop_assert!((got - wanted).abs() < 1e-8, "{} for {}", got, wanted);
        }
        let (component, sizes) = components(n as usize, edges.iter().map(|&(i, j, _)| (i, j)));
        for wanted in 0..sizes.len() as u32 {
            let own = solved.iter().zip(&component).filter(|&(_, &c)| c == wanted);
            let sum = own.fold([0.0; 2], |sum, (point, _)| [sum[0] + point[0], sum[1] + point[1]]);
            prop_assert!(sum[0].hypot(sum[1]) < 1e-6, "{:?}", sum);
        }
    }
}
