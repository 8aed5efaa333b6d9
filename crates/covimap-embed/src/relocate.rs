//! Other places for single objects: a way out of poor local minima.
//!
//! A map whose stress no small move lowers may still hold an object on the wrong side of the
//! others: the way round leads through higher stress. With all others and the disparities `e`
//! held, the share of object `i`, `f_i(x) = sum_j w_ij (|x - x_j| - e_ij)^2`, has a few minima,
//! found by its own majorisation step
//!
//! `x <- sum_j w_ij (x_j + e_ij (x - x_j) / |x - x_j|) / sum_j w_ij`  (1)
//!
//! from a ring of places. The best one away from where the object is, is its *alternative*; a run
//! of all objects from there tells whether the map is better with it.

use rayon::prelude::*;

use crate::stress::{Incidence, distance};
use crate::{PairDistances, Point};

/// Places on the ring.
const DIRECTIONS: usize = 8;
/// Steps (1) from each.
const STEPS: usize = 30;
/// A place is another one if it is farther off than this share of the ring's radius.
const APART: f64 = 0.1;

/// Another place for one object.
pub(crate) struct Alternative {
    pub object: usize,
    pub place: Point,
    /// What its share of the stress becomes, less what it is.
    change: f64,
}

/// The alternative of each object that has one, those that promise most first. `O(m)` for `m`
/// pairs, some five hundred times that of a pass.
pub(crate) fn alternatives(pairs: &PairDistances, points: &[Point], disparities: &[f64]) -> Vec<Alternative> {
    let incidence = Incidence::new(pairs);
    let of_object = |object: usize| {
        let spring = |&(other, pair): &(u32, u32)| Spring {
            to: points[other as usize],
            weight: pairs.pairs()[pair as usize].weight,
            length: disparities[pair as usize],
        };
        let springs: Vec<Spring> = incidence.of(object).iter().map(spring).collect();
        let (change, place) = alternative(&springs, points[object])?;
        Some(Alternative { object, place, change })
    };
    let mut found: Vec<Alternative> = (0..points.len()).into_par_iter().filter_map(of_object).collect();
    // Equal ones stay in the order of the objects.
    found.sort_by(|a, b| a.change.total_cmp(&b.change));
    found
}

/// A pair, as one of its objects feels it.
struct Spring {
    to: Point,
    weight: f64,
    length: f64,
}

/// Change of the share and the place, or none if all ways lead back.
fn alternative(springs: &[Spring], present: Point) -> Option<(f64, Point)> {
    let total: f64 = springs.iter().map(|spring| spring.weight).sum();
    let mean = |of: &dyn Fn(&Spring) -> f64| {
        springs.iter().map(|spring| spring.weight * of(spring)).sum::<f64>() / total
    };
    let centre = [mean(&|spring| spring.to[0]), mean(&|spring| spring.to[1])];
    let radius = mean(&|spring| spring.length * spring.length).sqrt();
    let share = |place: Point| {
        springs
            .iter()
            .map(|spring| spring.weight * (distance(place, spring.to) - spring.length).powi(2))
            .sum::<f64>()
    };
    let step = |place: Point| {
        let pulled = |axis: usize| {
            mean(&|spring| {
                let r = distance(place, spring.to);
                let stretch = if r > 0.0 { spring.length / r } else { 0.0 };
                spring.to[axis] + stretch * (place[axis] - spring.to[axis])
            })
        };
        [pulled(0), pulled(1)]
    };
    (0..DIRECTIONS)
        .map(|direction| {
            let (sin, cos) = (direction as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
            (0..STEPS).fold([centre[0] + radius * cos, centre[1] + radius * sin], |place, _| step(place))
        })
        .filter(|&place| distance(place, present) > APART * radius)
        .map(|place| (share(place) - share(present), place))
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;

    /// Objects 0, 1 and 2 in a row and object 3 off it, with distances to the row only.
    fn beside_a_row(weight_across: f64) -> (PairDistances, Vec<Point>) {
        let pair = |i, j, distance, weight| Pair { i, j, distance, weight };
        let side = 2f64.sqrt();
        let mut pairs = vec![
            pair(0, 1, 1.0, 1.0),
            pair(0, 2, 2.0, 1.0),
            pair(0, 3, side, 1.0),
            pair(1, 2, 1.0, 1.0),
            pair(1, 3, 1.0, 1.0),
            pair(2, 3, side, 1.0),
        ];
        // Object 4 above the row says on which side 3 is: below, 2 away.
        pairs.push(pair(3, 4, 2.0, weight_across));
        pairs.sort_by_key(|pair| (pair.i, pair.j));
        let points = vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 1.0], [1.0, 1.0]];
        (PairDistances::new(5, pairs).unwrap(), points)
    }

    #[test]
    fn the_mirrored_place_is_found_with_its_gain() {
        let (pairs, points) = beside_a_row(0.5);
        let targets: Vec<f64> = pairs.pairs().iter().map(|pair| pair.distance).collect();
        let found = alternatives(&pairs, &points, &targets);
        let of_three = found.iter().find(|alternative| alternative.object == 3).unwrap();
        assert!(distance(of_three.place, [1.0, -1.0]) < 1e-6, "{:?}", of_three.place);
        // The share was 0.5 (0 - 2)^2 = 2 and becomes zero.
        assert!((of_three.change + 2.0).abs() < 1e-6);
        assert!(found.is_sorted_by(|a, b| a.change <= b.change));
    }

    #[test]
    fn an_object_without_pairs_has_no_alternative() {
        let pairs = PairDistances::new(3, vec![Pair { i: 0, j: 1, distance: 1.0, weight: 1.0 }]).unwrap();
        let found = alternatives(&pairs, &[[0.0, 0.0], [1.0, 0.0], [5.0, 5.0]], &[1.0]);
        assert!(found.iter().all(|alternative| alternative.object != 2));
    }
}
