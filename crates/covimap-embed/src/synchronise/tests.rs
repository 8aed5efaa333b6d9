use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

const FREE: SynchroniseOptions = SynchroniseOptions { scale_pull: 0.0 };

fn random_frame(rng: &mut ChaCha8Rng) -> Similarity {
    let (sin, cos) = rng.random_range(-3.0..3.0_f64).sin_cos();
    let scale = rng.random_range(-0.7..0.7_f64).exp();
    let shift = [rng.random_range(-9.0..9.0), rng.random_range(-9.0..9.0)];
    Similarity { cos, sin, mirrored: rng.random(), scale, shift }
}

/// Frames and the exact edges between them.
struct World {
    truth: Vec<Similarity>,
    edges: Vec<RelativeFrame>,
    rng: ChaCha8Rng,
}

impl World {
    fn new(nodes: usize, ends: &[(u32, u32)], seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth: Vec<_> = (0..nodes).map(|_| random_frame(&mut rng)).collect();
        let edge = |&(a, b): &(u32, u32)| RelativeFrame {
            a,
            b,
            a_from_b: truth[a as usize].inverse().after(&truth[b as usize]),
            alternative: None,
            evidence: 1.0,
            weight: 1.0,
        };
        Self { edges: ends.iter().map(edge).collect(), truth, rng }
    }

    /// Replaces a share of the edges by anything.
    fn with_outliers(mut self, share: f64) -> (Self, Vec<bool>) {
        let mut wrong = Vec::new();
        for edge in &mut self.edges {
            wrong.push(self.rng.random_bool(share));
            if wrong[wrong.len() - 1] {
                edge.a_from_b = random_frame(&mut self.rng);
            }
        }
        (self, wrong)
    }

    /// Turns, scales and shifts every edge a little.
    fn with_noise(mut self, sigma: f64) -> Self {
        for edge in &mut self.edges {
            let mut draw = || (0..12).map(|_| self.rng.random_range(-0.5..0.5)).sum::<f64>() * sigma;
            let (sin, cos) = draw().sin_cos();
            let slip = Similarity { cos, sin, mirrored: false, scale: draw().exp(), shift: [draw(), draw()] };
            edge.a_from_b = edge.a_from_b.after(&slip);
        }
        self
    }

    fn solve(&self) -> Synchronised {
        synchronise(self.truth.len(), &self.edges, FREE).unwrap()
    }

    /// Largest distance of two images of the unit points between truth and result, seen from the
    /// first node of each component.
    fn worst_error(&self, found: &Synchronised) -> f64 {
        let mut worst: f64 = 0.0;
        for (node, frame) in found.global_from_node.iter().enumerate() {
            let first = found.component.iter().position(|&c| c == found.component[node]).unwrap();
            let truth = self.truth[first].inverse().after(&self.truth[node]);
            for point in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
                let (is, ought) = (frame.apply(point), truth.apply(point));
                worst = worst.max((is[0] - ought[0]).hypot(is[1] - ought[1]));
            }
        }
        worst
    }
}

fn grid(side: u32, diagonals: bool) -> Vec<(u32, u32)> {
    let mut ends = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let node = y * side + x;
            if x + 1 < side {
                ends.push((node, node + 1));
            }
            if y + 1 < side {
                ends.push((node + side, node));
            }
            if diagonals && x + 1 < side && y + 1 < side {
                ends.push((node, node + side + 1));
            }
        }
    }
    ends
}

#[test]
fn probe() {
    for diagonals in [true, false] {
        for share in [0.0, 0.1, 0.2, 0.3, 0.4] {
            for side in [5, 15, 40] {
                let mut line = String::new();
                for seed in 0..4 {
                    let (world, wrong) =
                        World::new((side * side) as usize, &grid(side, diagonals), seed).with_outliers(share);
                    let t = std::time::Instant::now();
                    let found = world.solve();
                    let t = t.elapsed();
                    let signs = found
                        .global_from_node
                        .iter()
                        .zip(&world.truth)
                        .filter(|(f, t)| f.mirrored != (t.mirrored != world.truth[0].mirrored))
                        .count();
                    let ang = found.edges.iter().zip(&wrong).filter(|(e, w)| !**w && e.trust < 0.5).count();
                    let trusted =
                        found.edges.iter().zip(&wrong).filter(|(e, w)| **w && e.trust > 0.5).count();
                    let flip = signs > world.truth.len() / 2;
                    let mut hist = [0; 8];
                    for (i, (f, t)) in found.global_from_node.iter().zip(&world.truth).enumerate() {
                        if (f.mirrored != (t.mirrored != world.truth[0].mirrored)) != flip {
                            let good = world
                                .edges
                                .iter()
                                .zip(&wrong)
                                .filter(|(e, w)| !**w && (e.a == i as u32 || e.b == i as u32))
                                .count();
                            hist[good.min(7)] += 1;
                        }
                    }
                    line += &format!("{hist:?}");
                    line +=
                        &format!(" [{signs} {ang} {trusted} {:.0e} {:.0?}]", world.worst_error(&found), t);
                }
                println!("diag {diagonals} share {share} side {side}: {line}");
            }
        }
    }
}
