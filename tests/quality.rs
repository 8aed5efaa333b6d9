//! exploration
use covimap::evaluate::{self, EvaluateParams};
use covimap::{CoVisibility, LinkGraph, Mapper, MapperParams, Method, SightingLog, Silent, Truth};
use covimap_embed::{StopRule, newton, raw_stress};
use covimap_sim::{Floor, SimSpec, Simulation, World};
use std::time::Instant;

fn world(floor: Floor, n: usize, seed: u64) -> (SightingLog, Truth, Vec<[f64; 2]>) {
    let spec = SimSpec::large(floor, n, 40);
    let world = World::new(&spec.world, seed).unwrap();
    let rec = Simulation::new(&world, &spec.run, seed).unwrap().record();
    let log = SightingLog::from_steps(
        rec.steps().map(|s| s.seen.iter().map(|i| format!("L{i}")).collect::<Vec<_>>()),
    );
    let mut text = String::from("id,x,y\n");
    for (i, p) in world.landmarks().iter().enumerate() {
        text += &format!("L{i},{},{}\n", p[0], p[1]);
    }
    let by_log = log
        .names()
        .iter()
        .map(|n| {
            let p = world.landmarks()[n[1..].parse::<usize>().unwrap()];
            [p[0], p[1]]
        })
        .collect();
    (log, Truth::parse(text.as_bytes(), "truth").unwrap(), by_log)
}

#[test]
fn explore() {
    for n in [300, 800] {
        for floor in Floor::ALL {
            for seed in 1..=3 {
                let t = Instant::now();
                let (log, truth, points) = world(floor, n, seed);
                let sim = t.elapsed().as_secs_f64();
                let mut line = String::new();
                let mut stress = 0.0;
                for (method, its) in [(Method::Auto, 4), (Method::Auto, 0), (Method::Classical, 0)] {
                    let mut p = MapperParams::default();
                    p.method = method;
                    p.auto.refine_iterations = its;
                    let t = Instant::now();
                    let map = Mapper::new(p).unwrap().build(&log, &Silent).unwrap();
                    let sec = t.elapsed().as_secs_f64();
                    let e = evaluate::against(&map, &truth, &EvaluateParams::default()).unwrap();
                    if its == 0 && method == Method::Auto {
                        let pairs =
                            LinkGraph::from_counts(&CoVisibility::count(&log, &Silent).unwrap()).to_pairs();
                        let pts: Vec<_> = map.landmarks().iter().map(|l| l.position).collect();
                        let own = raw_stress(&pairs, &pts);
                        // truth scaled
                        let start: Vec<_> = points.iter().map(|p| [p[0] * 1.0, p[1] * 1.0]).collect();
                        let best = newton(&pairs, &start, StopRule { max_iterations: 200, tolerance: 1e-9 })
                            .unwrap();
                        stress = own / best.stress;
                    }
                    line += &format!(
                        " | {:.4} {:.4} {:.4} {:.4} {:.2}s",
                        e.orientation_error.unwrap(),
                        e.local_orientation_error.unwrap(),
                        e.delaunay_error,
                        e.rmse,
                        sec
                    );
                }
                println!("{n} {:13} {seed} sim {sim:.2} stress {stress:.5}{line}", floor.name());
            }
        }
    }
}
