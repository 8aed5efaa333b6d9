//! Passes over lists that leave pairs out.

use rayon::prelude::*;

use super::Forces;
use crate::stress::{CHUNK, Incidence, distance};
use crate::{PairDistances, Point};

/// Objects of one parallel task.
const OBJECTS: usize = 256;

/// A pair list and the pairs of each object.
pub(crate) struct ListedPairs<'a> {
    pairs: &'a PairDistances,
    incidence: Incidence,
}

impl<'a> ListedPairs<'a> {
    pub fn new(pairs: &'a PairDistances) -> Self {
        Self { pairs, incidence: Incidence::new(pairs) }
    }

    /// Pair by pair `w (1 - e / r)`, then object by object the sum over its pairs: no two tasks write to
    /// one place, and no pair is measured twice.
    pub fn forces(&self, points: &[Point], disparities: &[f64]) -> Forces {
        let mut pulls = vec![0.0; disparities.len()];
        let partial: Vec<f64> = self
            .pairs
            .pairs()
            .par_chunks(CHUNK)
            .zip(disparities.par_chunks(CHUNK))
            .zip(pulls.par_chunks_mut(CHUNK))
            .map(|((pairs, disparities), pulls)| {
                let mut stress = 0.0;
                for ((pair, disparity), pull) in pairs.iter().zip(disparities).zip(pulls) {
                    let r = distance(points[pair.i as usize], points[pair.j as usize]);
                    let miss = r - disparity;
                    stress += pair.weight * miss * miss;
                    *pull = if r > 0.0 { pair.weight * miss / r } else { 0.0 };
                }
                stress
            })
            .collect();
        let force = |i: usize| {
            let mut sum = [0.0; 2];
            for &(j, pair) in self.incidence.of(i) {
                let pull = pulls[pair as usize];
                sum[0] += pull * (points[i][0] - points[j as usize][0]);
                sum[1] += pull * (points[i][1] - points[j as usize][1]);
            }
            sum
        };
        let forces = (0..points.len()).into_par_iter().with_min_len(OBJECTS).map(force).collect();
        Forces { stress: partial.iter().sum(), forces }
    }
}
