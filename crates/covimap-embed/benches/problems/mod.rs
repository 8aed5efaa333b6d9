//! Problems of fixed seed for measurements of speed.

#![allow(dead_code, reason = "each user takes some of them")]

use covimap_embed::{Pair, PairDistances, Point};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// All distances of `n` points of a cube, which fit no plane.
pub fn complete(n: u32, weighted: bool) -> PairDistances {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let points: Vec<[f64; 3]> = (0..n).map(|_| [rng.random(), rng.random(), rng.random()]).collect();
    let pair = |(i, j): (u32, u32)| {
        let (a, b) = (points[i as usize], points[j as usize]);
        let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
        Pair { i, j, distance, weight: if weighted { 1.0 / distance } else { 1.0 } }
    };
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).map(pair).collect();
    PairDistances::new(n as usize, pairs).expect("distances of points (bug in covimap)")
}

/// 100 000 objects on a shaken lattice, numbered at random, each with ten neighbours, and a start near
/// the truth.
pub fn neighbours() -> (PairDistances, Vec<Point>) {
    const WIDTH: i32 = 400;
    const HEIGHT: i32 = 250;
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut number: Vec<u32> = (0..(WIDTH * HEIGHT) as u32).collect();
    number.shuffle(&mut rng);
    let mut truth = vec![[0.0; 2]; number.len()];
    for (place, &object) in number.iter().enumerate() {
        let (x, y) = (place as i32 % WIDTH, place as i32 / WIDTH);
        truth[object as usize] = [x, y].map(|k| f64::from(k) + rng.random_range(-0.3..0.3));
    }
    let mut pairs = Vec::new();
    for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
        for (dx, dy) in [(1, 0), (2, 0), (-1, 1), (0, 1), (1, 1)] {
            let (u, v) = (x + dx, y + dy);
            if (0..WIDTH).contains(&u) && v < HEIGHT {
                let [a, b] = [(x, y), (u, v)].map(|(x, y)| number[(y * WIDTH + x) as usize]);
                let [p, q] = [a, b].map(|object| truth[object as usize]);
                let distance = (p[0] - q[0]).hypot(p[1] - q[1]) * rng.random_range(0.9..1.1);
                pairs.push(Pair { i: a.min(b), j: a.max(b), distance, weight: 1.0 / distance });
            }
        }
    }
    pairs.sort_by_key(|pair| (pair.i, pair.j));
    let start = truth.iter().map(|p| p.map(|x| x + rng.random_range(-0.5..0.5))).collect();
    (PairDistances::new(number.len(), pairs).expect("a lattice (bug in covimap)"), start)
}

/// Ten million values that rise but for noise over a tenth of their range.
pub fn rising() -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    (0..10_000_000).map(|k| 1e-6 * f64::from(k) + rng.random::<f64>()).collect()
}
