//! Near pairs that are seen together far less often than open sight would have it.

use std::f64::consts::FRAC_2_PI;

use covimap_embed::Point;
use rayon::prelude::*;

use super::SensorModel;
use crate::{CoVisibility, LandmarkId};

/// Pairs further apart than this, as a share of the range, are not asked for: they are seldom seen together
/// with open sight too.
const REACH: f64 = 1.2;
/// Share of the co-sightings of open sight below which a pair is occluded.
const SHARE: f64 = 1.0 / 3.0;
/// Fewest co-sightings that open sight must promise: by chance fewer than a third of ten are then seen in
/// one of a hundred pairs (Poisson).
const FEWEST: f64 = 10.0;

/// The occluded pairs of a component, each once, by their numbers in the whole map.
///
/// In open sight the places that see `i` lie within `R` of it, and of those the share
/// `(2 / pi) (acos u - u sqrt(1 - u^2))`, `u = d / 2R`, lies within `R` of `j` as well. So
/// `n_ij = min(n_i p_j, n_j p_i)` times that share is to be expected.
///
/// Time `O(n k)` for `k` landmarks within reach.
pub(crate) fn pairs(
    counts: &CoVisibility,
    members: &[u32],
    points: &[Point],
    sensor: &SensorModel,
    detectability: &[f64],
) -> Vec<[u32; 2]> {
    let cells = Cells::new(points, REACH * sensor.range);
    let sightings = |i: usize| f64::from(counts.sightings()[members[i] as usize]);
    let of = |i: usize| {
        let mut found = Vec::new();
        cells.for_each_near(points, i, |j, distance| {
            let open = (sightings(i) * detectability[j]).min(sightings(j) * detectability[i])
                * shared_view(distance / (2.0 * sensor.range));
            if j > i && open >= FEWEST {
                let seen = counts.together(LandmarkId(members[i]), LandmarkId(members[j]));
                if f64::from(seen) < SHARE * open {
                    found.push([members[i], members[j]]);
                }
            }
        });
        found.sort_unstable();
        found
    };
    (0..points.len()).into_par_iter().flat_map_iter(of).collect()
}

/// Share of a disc that lies in another one, their middles `2 u` radii apart.
fn shared_view(u: f64) -> f64 {
    if u < 1.0 { FRAC_2_PI * (u.acos() - u * (1.0 - u * u).sqrt()) } else { 0.0 }
}

/// Points by square cells as wide as the reach.
struct Cells {
    side: f64,
    /// Cell and number of every point, ascending.
    filled: Vec<([i64; 2], u32)>,
}

impl Cells {
    fn new(points: &[Point], side: f64) -> Self {
        let cell = |point: &Point| point.map(|c| (c / side).floor() as i64);
        let mut filled: Vec<_> = (0..).zip(points).map(|(number, point)| (cell(point), number)).collect();
        filled.par_sort_unstable();
        Self { side, filled }
    }

    /// Calls `visit` with number and distance of every other point within a side's length.
    fn for_each_near(&self, points: &[Point], i: usize, mut visit: impl FnMut(usize, f64)) {
        let [column, row] = points[i].map(|c| (c / self.side).floor() as i64);
        for column in column - 1..=column + 1 {
            let from = self.filled.partition_point(|entry| entry.0 < [column, row - 1]);
            let near = self.filled[from..].iter().take_while(|entry| entry.0 <= [column, row + 1]);
            for j in near.map(|entry| entry.1 as usize).filter(|&j| j != i) {
                let distance = (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
                if distance < self.side {
                    visit(j, distance);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{cases, distance, scattered};
    use proptest::prelude::*;

    #[test]
    fn discs_share_what_geometry_says() {
        assert_eq!(shared_view(0.0), 1.0);
        assert_eq!(shared_view(1.0), 0.0);
        assert_eq!(shared_view(1.5), 0.0);
        // Middles one radius apart: 2/3 - sqrt(3) / (2 pi) = 0.3910022.
        assert!((shared_view(0.5) - 0.391_002_2).abs() < 1e-7);
    }

    proptest! {
        #![proptest_config(cases(20))]
        #[test]
        fn cells_find_what_a_look_at_all_points_finds(seed in 0u64..1000, side in 0.05..3.0f64) {
            let points: Vec<Point> =
                scattered(60, [2.0, 1.0], seed).iter().map(|[x, y]| [x - 1.0, y - 0.5]).collect();
            let cells = Cells::new(&points, side);
            for i in 0..points.len() {
                let mut found = Vec::new();
                cells.for_each_near(&points, i, |j, _| found.push(j));
                found.sort_unstable();
                let near = |&j: &usize| j != i && distance(points[i], points[j]) < side;
                prop_assert_eq!(found, (0..points.len()).filter(near).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn a_near_pair_that_is_seldom_seen_together_is_occluded() {
        let sensor = SensorModel { range: 1.0, edge: 0.1, detectability: 0.9, outliers: 1e-3 };
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.1], [3.0, 0.0]];
        // Open sight: min(100, 100) * 0.9 * 0.391 = 35.2 for 0 and 1, a third of it is 11.7. For 0 and 2,
        // u = 0.55: 100 * 0.9 * 0.337 = 30.3. 3 is out of reach of all.
        let found = |n01: u32, n02: u32| {
            let pairs = [(0, 1, n01), (0, 2, n02), (1, 2, 50)];
            let pairs = pairs.map(|(a, b, both)| (LandmarkId(a), LandmarkId(b), both));
            let counts = CoVisibility::from_counts(400, vec![100; 4], pairs).unwrap();
            super::pairs(&counts, &[0, 1, 2, 3], &points, &sensor, &[0.9; 4])
        };
        assert_eq!(found(12, 11), Vec::<[u32; 2]>::new());
        assert_eq!(found(11, 11), [[0, 1]]);
        assert_eq!(found(1, 10), [[0, 1], [0, 2]]);
    }

    #[test]
    fn few_sightings_prove_nothing() {
        let sensor = SensorModel { range: 1.0, edge: 0.1, detectability: 0.9, outliers: 1e-3 };
        // 20 * 0.9 * 0.391 = 7.0 < 10.
        let pairs = [(LandmarkId(0), LandmarkId(1), 1)];
        let counts = CoVisibility::from_counts(40, vec![20; 2], pairs).unwrap();
        assert!(super::pairs(&counts, &[0, 1], &[[0.0; 2], [1.0, 0.0]], &sensor, &[0.9; 2]).is_empty());
        assert!(super::pairs(&counts, &[], &[], &sensor, &[]).is_empty());
    }
}
