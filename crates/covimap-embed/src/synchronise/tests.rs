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
        let found = synchronise(self.truth.len(), &self.edges, FREE).unwrap();
        let mirrored: Vec<bool> = found.global_from_node.iter().map(|frame| frame.mirrored).collect();
        assert_eq!(handedness(self.truth.len(), &self.edges).unwrap(), mirrored);
        found
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

/// Each of `nodes` nodes on a ring joined to the next `reach` ones.
fn circulant(nodes: u32, reach: u32) -> Vec<(u32, u32)> {
    (0..nodes).flat_map(|a| (1..=reach).map(move |step| (a, (a + step) % nodes))).collect()
}

fn edge(a: u32, b: u32, a_from_b: Similarity) -> RelativeFrame {
    RelativeFrame { a, b, a_from_b, alternative: None, evidence: 1.0, weight: 1.0 }
}

fn scaled(scale: f64) -> Similarity {
    Similarity { scale, ..Similarity::IDENTITY }
}

#[test]
fn exact_edges_are_reproduced() {
    let graphs = [(2, vec![(1, 0)]), (10, circulant(10, 1)), (49, grid(7, false)), (400, grid(20, true))];
    for (nodes, ends) in graphs {
        for seed in 0..5 {
            let world = World::new(nodes, &ends, seed);
            let found = world.solve();
            assert!(world.worst_error(&found) < 1e-10, "{nodes} nodes, seed {seed}");
            assert!(found.edges.iter().all(|edge| edge.used == Estimate::Given && edge.trust == 1.0));
            assert_eq!(found.global_from_node[0], Similarity::IDENTITY);
        }
    }
}

#[test]
fn a_fifth_of_wrong_edges_is_found_and_does_no_harm() {
    for seed in 0..10 {
        let (world, wrong) = World::new(60, &circulant(60, 5), seed).with_outliers(0.2);
        let found = world.solve();
        assert!(world.worst_error(&found) < 1e-8, "seed {seed}");
        for (edge, wrong) in found.edges.iter().zip(wrong) {
            assert_eq!(edge.trust < 0.5, wrong, "seed {seed}: {edge:?}");
            assert!(wrong || edge.rotation.abs() + edge.log_scale.abs() + edge.shift < 1e-8);
        }
    }
}

#[test]
fn handedness_is_right_wherever_edges_can_tell_it() {
    // A node of the grid has up to six edges. Where four or more of them are right, they are the
    // majority or agree where the wrong ones do not.
    let (mut told, mut missed) = (0, 0);
    for seed in 0..4 {
        let (world, wrong) = World::new(900, &grid(30, true), seed).with_outliers(0.2);
        let found = world.solve();
        let mut right_edges = vec![0; 900];
        for (edge, _) in world.edges.iter().zip(&wrong).filter(|(_, wrong)| !**wrong) {
            right_edges[edge.a as usize] += 1;
            right_edges[edge.b as usize] += 1;
        }
        let differs: Vec<bool> =
            found.global_from_node.iter().zip(&world.truth).map(|(f, t)| f.mirrored != t.mirrored).collect();
        let most = differs.iter().filter(|&&d| d).count() > 450;
        for node in (0..900).filter(|&node| right_edges[node] >= 4) {
            told += 1;
            missed += usize::from(differs[node] != most);
        }
    }
    assert!(told > 3000 && missed <= 3, "{missed} of {told}");
}

#[test]
fn noise_is_averaged_and_not_taken_for_outliers() {
    let world = World::new(400, &grid(20, true), 3).with_noise(0.01);
    let found = world.solve();
    let root_mean = |of: fn(&EdgeReport) -> f64| {
        (found.edges.iter().map(|edge| of(edge).powi(2)).sum::<f64>() / found.edges.len() as f64).sqrt()
    };
    // 1121 edges, 399 unknowns: residuals keep sqrt(722 / 1121) = 0.80 of the noise.
    for residual in [root_mean(|edge| edge.rotation), root_mean(|edge| edge.log_scale)] {
        assert!((0.007..0.0095).contains(&residual), "{residual}");
    }
    // Three parts with 0.55 to 0.95 of the trust each, on average.
    let mean = found.edges.iter().map(|edge| edge.trust).sum::<f64>() / found.edges.len() as f64;
    assert!(mean > 0.5, "{mean}");
}

#[test]
fn a_ring_closes_by_sharing_its_gap() {
    // Twenty edges of 1/20 of a turn and one step, but for 0.2 rad in all.
    let angle = (std::f64::consts::TAU - 0.2) / 20.0;
    let step = Similarity { cos: angle.cos(), sin: angle.sin(), shift: [1.0, 0.0], ..Similarity::IDENTITY };
    let edges: Vec<_> = circulant(20, 1).into_iter().map(|(a, b)| edge(a, b, step)).collect();
    let found = synchronise(20, &edges, FREE).unwrap();
    for edge in &found.edges {
        // 0.01 rad an edge, of the sign of what is missing.
        assert!((edge.rotation + 0.01).abs() < 1e-4, "{}", edge.rotation);
        assert!(!edge.bridge && edge.trust > 0.3 && edge.shift < 1e-9);
    }
}

#[test]
fn components_have_frames_of_their_own() {
    let mut ends = circulant(5, 2);
    ends.extend(circulant(6, 2).into_iter().map(|(a, b)| (a + 6, b + 6)));
    // Node 5 has no edge.
    let world = World::new(12, &ends, 9);
    let found = world.solve();
    assert_eq!(found.component, [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    assert!(world.worst_error(&found) < 1e-12);
    for first in [0, 5, 6] {
        assert_eq!(found.global_from_node[first], Similarity::IDENTITY);
    }
}

#[test]
fn no_node_and_one_node() {
    let none = synchronise(0, &[], FREE).unwrap();
    assert!(none.global_from_node.is_empty() && none.component.is_empty() && none.edges.is_empty());
    let one = synchronise(1, &[], FREE).unwrap();
    assert_eq!((one.global_from_node, one.component), (vec![Similarity::IDENTITY], vec![0]));
}

#[test]
fn of_parallel_edges_the_majority_counts() {
    let (right, wrong) = (scaled(2.0), Similarity { mirrored: true, ..scaled(0.5) });
    let edges = [edge(0, 1, wrong), edge(0, 1, right), edge(1, 0, right.inverse())];
    let found = synchronise(2, &edges, FREE).unwrap();
    assert!((found.global_from_node[1].scale - 2.0).abs() < 1e-12);
    assert_eq!(found.edges[0].used, Estimate::Neither);
    assert_eq!((found.edges[0].trust, found.edges[1].trust), (0.0, 1.0));
    assert!((found.edges[0].log_scale - f64::ln(0.25)).abs() < 1e-12);
    assert!(!found.edges[1].bridge && !found.edges[2].bridge);
}

#[test]
fn an_alternative_is_used_where_the_graph_asks_for_it() {
    let mut world = World::new(8, &circulant(8, 2), 5);
    let right = world.edges[3].a_from_b;
    let doubtful = RelativeFrame {
        a_from_b: Similarity { mirrored: !right.mirrored, ..right },
        alternative: Some(right),
        evidence: 0.1,
        ..world.edges[3]
    };
    world.edges[3] = doubtful;
    let found = world.solve();
    assert!(world.worst_error(&found) < 1e-12);
    assert_eq!((found.edges[3].used, found.edges[3].trust), (Estimate::Alternative, 1.0));
    // Without an alternative the edge is dropped and the rest does.
    world.edges[3].alternative = None;
    let found = world.solve();
    assert!(world.worst_error(&found) < 1e-12);
    assert_eq!((found.edges[3].used, found.edges[3].trust), (Estimate::Neither, 0.0));
}

#[test]
fn edges_without_evidence_leave_handedness_to_the_others() {
    let mut world = World::new(6, &circulant(6, 2), 8);
    for edge in &mut world.edges[..4] {
        edge.evidence = 0.0;
        edge.alternative = Some(edge.a_from_b);
        edge.a_from_b.mirrored = !edge.a_from_b.mirrored;
    }
    let found = world.solve();
    assert!(world.worst_error(&found) < 1e-12);
    assert!(found.edges[..4].iter().all(|edge| edge.used == Estimate::Alternative));
}

#[test]
fn bridges_are_reported() {
    let mut ends = circulant(3, 1);
    ends.push((2, 3));
    let found = World::new(4, &ends, 1).solve();
    assert_eq!(found.edges.iter().map(|edge| edge.bridge).collect::<Vec<_>>(), [false, false, false, true]);
}

#[test]
fn scales_are_pulled_together() {
    let edges = [edge(0, 1, Similarity { shift: [1.0, 0.0], ..scaled(f64::exp(0.4)) })];
    let with = |scale_pull| {
        let found = synchronise(2, &edges, SynchroniseOptions { scale_pull }).unwrap();
        (found.global_from_node[1].scale.ln(), found.edges[0].log_scale)
    };
    let close = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-9 && (b - d).abs() < 1e-9;
    assert!(close(with(0.0), (0.4, 0.0)));
    assert!(close(with(f64::INFINITY), (0.0, 0.4)));
    // With pull 1 the logarithms -x/2 and x/2 minimise (0.4 - x)^2 + 2 (x/2)^2: x = 0.8/3.
    assert!(close(with(1.0), (0.8 / 3.0, 0.4 - 0.8 / 3.0)));
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let ends: Vec<_> = (0..4)
        .flat_map(|part| circulant(20, 3).into_iter().map(move |(a, b)| (a + 20 * part, b + 20 * part)))
        .collect();
    let (world, _) = World::new(80, &ends, 2).with_noise(0.02).with_outliers(0.1);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| world.solve())
    };
    assert_eq!(run(1), run(4));
}

#[test]
fn unusable_edges_are_refused_with_their_place() {
    let good = edge(0, 1, Similarity::IDENTITY);
    let with = |a_from_b| RelativeFrame { a_from_b, ..good };
    let unit = Similarity::IDENTITY;
    let bad = [
        RelativeFrame { b: 0, ..good },
        RelativeFrame { b: 2, ..good },
        RelativeFrame { weight: 0.0, ..good },
        RelativeFrame { weight: f64::NAN, ..good },
        RelativeFrame { evidence: -1.0, ..good },
        RelativeFrame { evidence: f64::INFINITY, ..good },
        RelativeFrame { alternative: Some(unit), ..good },
        with(Similarity { cos: 0.9, ..unit }),
        with(Similarity { sin: f64::NAN, ..unit }),
        with(Similarity { scale: 0.0, ..unit }),
        with(Similarity { scale: f64::INFINITY, ..unit }),
        with(Similarity { shift: [0.0, f64::NAN], ..unit }),
    ];
    for bad in bad {
        let error = synchronise(2, &[good, bad], FREE).unwrap_err();
        assert!(matches!(error, EmbedError::BadRelativeFrame { index: 1, nodes: 2, .. }), "{bad:?}: {error}");
    }
    let text = synchronise(1, &[good], FREE).unwrap_err().to_string();
    assert!(text.starts_with("edge 0, from frame 0 to 1 of 1: an edge joins two different nodes"));
}
