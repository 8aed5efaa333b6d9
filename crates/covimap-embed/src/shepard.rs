//! Which pairs and objects a map fits badly.

use crate::stress::distance;
use crate::{PairDistances, Scaling};

/// One pair in the Shepard diagram: distance and disparity over dissimilarity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShepardPoint {
    /// First object.
    pub i: u32,
    /// Second object.
    pub j: u32,
    /// What was given for the pair.
    pub dissimilarity: f64,
    /// How far apart the two are in the map.
    pub distance: f64,
    /// What the distance is compared with: the dissimilarity after the transformation.
    pub disparity: f64,
}

impl Scaling {
    /// The Shepard diagram of the map of `pairs`, ascending by dissimilarity, then as listed. The
    /// disparities are its curve, the distances the cloud around it.
    ///
    /// # Panics
    /// If `pairs` is not the list that was scaled, and shorter or longer.
    #[must_use]
    pub fn shepard(&self, pairs: &PairDistances) -> Vec<ShepardPoint> {
        assert_eq!(pairs.pairs().len(), self.disparities.len(), "give the list that was scaled");
        let points = &self.embedding.points;
        let of = |(pair, &disparity): (&crate::Pair, &f64)| ShepardPoint {
            i: pair.i,
            j: pair.j,
            dissimilarity: pair.distance,
            distance: distance(points[pair.i as usize], points[pair.j as usize]),
            disparity,
        };
        let mut diagram: Vec<ShepardPoint> = pairs.pairs().iter().zip(&self.disparities).map(of).collect();
        diagram.sort_by(|a, b| a.dissimilarity.total_cmp(&b.dissimilarity));
        diagram
    }

    /// The raw stress by object: half of each pair's `w (e - r)^2` goes to either end, so that the
    /// sum is the raw stress. The largest are the objects that the map places worst.
    ///
    /// # Panics
    /// If `pairs` is not the list that was scaled, and shorter or longer.
    #[must_use]
    pub fn stress_per_point(&self, pairs: &PairDistances) -> Vec<f64> {
        assert_eq!(pairs.pairs().len(), self.disparities.len(), "give the list that was scaled");
        let points = &self.embedding.points;
        let mut stress = vec![0.0; points.len()];
        for (pair, disparity) in pairs.pairs().iter().zip(&self.disparities) {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let miss = distance(points[i], points[j]) - disparity;
            let half = 0.5 * pair.weight * miss * miss;
            stress[i] += half;
            stress[j] += half;
        }
        stress
    }
}

#[cfg(test)]
mod tests {
    use crate::{Embedding, Pair, PairDistances, Scaling, Termination};

    /// A triangle with legs 3 and 4 as the map of distances 9, 5 and 4 with disparities 2, 5, 5.
    fn triangle() -> (PairDistances, Scaling) {
        let pair = |i, j, distance, weight| Pair { i, j, distance, weight };
        let listed = vec![pair(0, 1, 9.0, 2.0), pair(0, 2, 5.0, 1.0), pair(1, 2, 4.0, 1.0)];
        let embedding = Embedding {
            points: vec![[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]],
            stress: 3.0,
            normalised_stress: 3.0 / 58.0,
            stress1: (3.0_f64 / 59.0).sqrt(),
            iterations: 0,
            termination: Termination::IterationLimit,
        };
        let scaling = Scaling { embedding, disparities: vec![2.0, 5.0, 5.0], trace: vec![3.0] };
        (PairDistances::new(3, listed).unwrap(), scaling)
    }

    #[test]
    fn the_diagram_ascends() {
        let (pairs, scaling) = triangle();
        let diagram = scaling.shepard(&pairs);
        let rows: Vec<_> =
            diagram.iter().map(|p| (p.i, p.j, p.dissimilarity, p.distance, p.disparity)).collect();
        assert_eq!(rows, [(1, 2, 4.0, 5.0, 5.0), (0, 2, 5.0, 4.0, 5.0), (0, 1, 9.0, 3.0, 2.0)]);
    }

    #[test]
    fn each_pair_charges_both_ends() {
        // Residuals 2 (3 - 2)^2 = 2 on (0, 1), (4 - 5)^2 = 1 on (0, 2), none on (1, 2).
        let (pairs, scaling) = triangle();
        assert_eq!(scaling.stress_per_point(&pairs), [1.5, 1.0, 0.5]);
    }

    #[test]
    #[should_panic(expected = "give the list that was scaled")]
    fn another_list_is_refused() {
        let (_, scaling) = triangle();
        let _ = scaling.shepard(&PairDistances::new(3, vec![]).unwrap());
    }
}
