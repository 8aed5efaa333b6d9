//! Spring embedder: every pair a spring, every object where its springs push it.
//!
//! A spring of rest length `d_ij` and stiffness `w_ij` joins each known pair; its energy is the
//! raw stress. In every step each object goes half the way to the weighted mean of the places
//! where its springs would have it,
//!
//! `x_i+ = x_i + 1/2 (sum_j w_ij (d_ij - r_ij) u_ij) / (sum_j w_ij)`,  (1)
//!
//! `r_ij` the present length and `u_ij` the unit vector from `j` to `i`. Half the way, because that
//! is the majorisation step of [`smacof`](crate::smacof) with the Laplacian `V` replaced by `2 diag
//! V`, which lies above it: so the stress never rises, and no temperature has to be chosen. A step
//! costs one pass over the pairs and feels only neighbours: cheap and local, but bends that reach
//! across the map take some `n` steps to straighten, where SMACOF takes a few.
//!
//! # Determinism
//! All objects move at once; the result does not depend on the number of threads.
//!
//! # References
//! P. Eades, "A heuristic for graph drawing", Congressus Numerantium 42, 1984. T. Kamada, S. Kawai,
//! "An algorithm for drawing general undirected graphs", Inf. Process. Lett. 31, 1989.

use rayon::prelude::*;

use crate::solve::check_start;
use crate::stress::{Incidence, raw_stress};
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};

/// Objects of one parallel task.
const OBJECTS: usize = 256;
/// Turn between the directions in which objects that coincide are pushed apart, rad.
const GOLDEN_TURN: f64 = 2.399_963_229_728_653;

/// Lowers the energy of the springs from `start`.
///
/// Objects may coincide at the start, even all of them: they are pushed apart in fixed directions.
/// Objects without springs stay where they are.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit.
///
/// # Examples
/// ```
/// use covimap_embed::{Pair, PairDistances, StopRule, spring_embedding};
///
/// let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
/// let triangle = PairDistances::new(3, vec![pair(0, 1, 3.0), pair(0, 2, 4.0), pair(1, 2, 5.0)])?;
/// let stop = StopRule { max_iterations: 500, tolerance: 1e-9 };
/// let solved = spring_embedding(&triangle, &[[0.0; 2]; 3], stop)?;
/// assert!(solved.stress < 1e-9);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn spring_embedding(
    pairs: &PairDistances,
    start: &[Point],
    stop: StopRule,
) -> Result<Embedding, EmbedError> {
    check_start(pairs, start)?;
    let incidence = Incidence::new(pairs);
    let mut points = start.to_vec();
    let mut stress = raw_stress(pairs, &points);
    let mut termination = Termination::IterationLimit;
    let mut iterations = 0;
    while iterations < stop.max_iterations {
        points = pushed(pairs, &incidence, &points);
        iterations += 1;
        let before = std::mem::replace(&mut stress, raw_stress(pairs, &points));
        if before - stress <= stop.tolerance * before {
            termination = Termination::Converged;
            break;
        }
    }
    Ok(Embedding::of_distances(pairs, points, iterations, termination))
}

/// Eq. (1) for all objects.
fn pushed(pairs: &PairDistances, incidence: &Incidence, points: &[Point]) -> Vec<Point> {
    let push = |i: usize| {
        let (mut push, mut stiffness) = ([0.0; 2], 0.0);
        for &(j, pair) in incidence.of(i) {
            let spring = pairs.pairs()[pair as usize];
            let [x, y] = pull_of(spring.distance, points, i, j as usize);
            push[0] += spring.weight * x;
            push[1] += spring.weight * y;
            stiffness += spring.weight;
        }
        if stiffness == 0.0 {
            return points[i];
        }
        [points[i][0] + 0.5 * push[0] / stiffness, points[i][1] + 0.5 * push[1] / stiffness]
    };
    (0..points.len()).into_par_iter().with_min_len(OBJECTS).map(push).collect()
}

/// `(d - r) u` for a spring of rest length `rest` on object `i`, held by object `j`. Where the two
/// coincide, any direction will do, if it is the opposite one for the other.
fn pull_of(rest: f64, points: &[Point], i: usize, j: usize) -> Point {
    let (dx, dy) = (points[i][0] - points[j][0], points[i][1] - points[j][1]);
    let length = (dx * dx + dy * dy).sqrt();
    if length > 0.0 {
        let stretch = rest / length - 1.0;
        return [stretch * dx, stretch * dy];
    }
    let (sin, cos) = ((i + j) as f64 * GOLDEN_TURN).sin_cos();
    if i < j { [rest * cos, rest * sin] } else { [-rest * cos, -rest * sin] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pair, smacof};
    use proptest::prelude::*;

    const PATIENT: StopRule = StopRule { max_iterations: 5000, tolerance: 0.0 };

    fn once() -> StopRule {
        StopRule { max_iterations: 1, tolerance: 0.0 }
    }

    fn pairs_of(n: usize, pairs: &[(u32, u32, f64, f64)]) -> PairDistances {
        let pair = |&(i, j, distance, weight): &(u32, u32, f64, f64)| Pair { i, j, distance, weight };
        PairDistances::new(n, pairs.iter().map(pair).collect()).unwrap()
    }

    proptest! {
        #[test]
        fn the_stress_never_rises(
            springs in prop::collection::btree_map((0_u32..8, 0_u32..8), (0.0..4.0_f64, 0.01..9.0_f64), 1..20),
            start in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 8),
        ) {
            let springs = springs.iter().filter(|((i, j), _)| i < j);
            let springs: Vec<_> = springs.map(|(&(i, j), &(d, w))| (i, j, d, w)).collect();
            let pairs = pairs_of(8, &springs);
            // A stress that should be zero is this large by rounding.
            let rounding = 1e-30 * springs.iter().map(|&(_, _, d, w)| w * d * d).sum::<f64>();
            let mut points: Vec<Point> = start.into_iter().map(|(x, y)| [x, y]).collect();
            for _ in 0..20 {
                let before = raw_stress(&pairs, &points);
                let solved = spring_embedding(&pairs, &points, once()).unwrap();
                prop_assert!(solved.stress <= before * (1.0 + 1e-12) + rounding);
                prop_assert_eq!(solved.stress, raw_stress(&pairs, &solved.points));
                points = solved.points;
            }
        }
    }

    #[test]
    fn one_step_worked_by_hand() {
        // Springs of length 1 and 4 pull object 0 at the origin to 1 and -1: with weights 1 and 3,
        // forces 1 (1 - 2) in -x direction of (2, 0), hence +1, and 3 (4 - 3) away from (0, 3),
        // hence (0, -3). Half the mean: (1, -3) / (2 * 4).
        let pairs = pairs_of(3, &[(0, 1, 1.0, 1.0), (0, 2, 4.0, 3.0)]);
        let start = [[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]];
        let solved = spring_embedding(&pairs, &start, once()).unwrap();
        assert!((solved.points[0][0] - 0.125).abs() < 1e-15 && (solved.points[0][1] + 0.375).abs() < 1e-15);
        assert_eq!((solved.iterations, solved.termination), (1, Termination::IterationLimit));
    }

    #[test]
    fn majorisation_finds_no_lower_stress_nearby() {
        // Six objects that fit no plane: all distances 1.
        let all: Vec<_> = (0..6).flat_map(|i| (i + 1..6).map(move |j| (i, j, 1.0, 1.0))).collect();
        let pairs = pairs_of(6, &all);
        let sprung = spring_embedding(&pairs, &[[0.0; 2]; 6], PATIENT).unwrap();
        let further = smacof(&pairs, &sprung.points, PATIENT).unwrap();
        assert!(sprung.stress - further.stress < 1e-9 * sprung.stress);
        assert_eq!(sprung.termination, Termination::Converged);
    }

    #[test]
    fn objects_without_springs_stay() {
        let pairs = pairs_of(3, &[(0, 1, 1.0, 1.0)]);
        let solved = spring_embedding(&pairs, &[[0.0; 2], [0.0; 2], [7.0, 7.0]], PATIENT).unwrap();
        assert_eq!(solved.points[2], [7.0, 7.0]);
        assert!(solved.stress < 1e-20);
    }

    #[test]
    fn no_object_and_a_start_that_does_not_fit() {
        let none = pairs_of(0, &[]);
        assert!(spring_embedding(&none, &[], PATIENT).unwrap().points.is_empty());
        let short = spring_embedding(&pairs_of(2, &[]), &[[0.0; 2]], PATIENT);
        assert!(matches!(short, Err(EmbedError::BadStart { found: 1, wanted: 2, .. })));
    }
}
