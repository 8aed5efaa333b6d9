//! The paper's method against the values of an independent implementation.

use std::path::{Path, PathBuf};

use covimap_embed::{Correspondence, Point, ProcrustesOptions, Reflection, classical_scaling, procrustes};
use covimap_map::{ClassicalParams, CoVisibility, LandmarkId, Phi, SightingLog, Silent, squared_distances};
use serde_json::Value;

fn data(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/golden-classical").join(file)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// A room with the landmarks of our log in the order of the expected file.
struct Room {
    expected: Value,
    counts: CoVisibility,
    order: Vec<u32>,
}

fn room(name: &str) -> Room {
    let text = std::fs::read_to_string(data(&format!("{name}.expected.json"))).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let log = SightingLog::read(&[data(&format!("{name}.jsonl"))], None, &Silent).unwrap();
    let counts = CoVisibility::count(&log, &Silent).unwrap();
    let place = |id: &str| log.names().iter().position(|name| name == id).unwrap() as u32;
    let order = expected["ids"].as_array().unwrap().iter().map(|id| place(id.as_str().unwrap())).collect();
    Room { expected, counts, order }
}

fn params(run: &Value) -> ClassicalParams {
    let mut params = ClassicalParams::default();
    params.phi = if run["phi"] == "phi1" { Phi::Phi1 } else { Phi::Phi2 };
    params.tic = run["tic"].as_bool().unwrap();
    params
}

#[test]
fn counts_are_those_of_the_independent_implementation() {
    for name in ["room10", "room30"] {
        let Room { expected, counts, order } = room(name);
        assert_eq!(counts.landmarks(), order.len());
        for (i, &a) in order.iter().enumerate() {
            assert_eq!(u64::from(counts.sightings()[a as usize]), expected["n_i"][i].as_u64().unwrap());
            for (j, &b) in order.iter().enumerate().filter(|&(j, _)| j != i) {
                let together = u64::from(counts.together(LandmarkId(a), LandmarkId(b)));
                assert_eq!(together, expected["n_ij"][i][j].as_u64().unwrap(), "{name} {i} {j}");
            }
        }
    }
}

#[test]
fn distances_eigenvalues_and_positions_are_those_of_the_independent_implementation() {
    let mut runs = 0;
    for name in ["room10", "room30"] {
        let Room { expected, counts, order } = room(name);
        for run in expected["runs"].as_array().unwrap() {
            let squared = squared_distances(&counts, &order, &params(run)).unwrap();
            for (i, row) in run["squared_distances"].as_array().unwrap().iter().enumerate() {
                for (j, wanted) in numbers(row).into_iter().enumerate() {
                    assert!((squared.get(i, j) - wanted).abs() < 1e-8, "{name} {i} {j}");
                }
            }
            let scaling = classical_scaling(&squared).unwrap();
            for (got, wanted) in scaling.eigenvalues.iter().zip(numbers(&run["eigenvalues"])) {
                assert!((got - wanted).abs() < 1e-8, "{name}: eigenvalue {got}, wanted {wanted}");
            }
            assert!(largest_miss(&scaling.points, &run["positions"]) < 1e-6, "{name}");
            runs += 1;
        }
    }
    assert_eq!(runs, 8);
}

/// Largest distance of a point from its wanted place after the best rotation or reflection.
fn largest_miss(points: &[Point], wanted: &Value) -> f64 {
    let pairs: Vec<Correspondence> = points
        .iter()
        .zip(wanted.as_array().unwrap())
        .map(|(&source, target)| {
            let target = numbers(target);
            Correspondence { source, target: [target[0], target[1]], weight: 1.0 }
        })
        .collect();
    let fit = procrustes(&pairs, ProcrustesOptions { scale: false, reflection: Reflection::Allow }).unwrap();
    pairs.iter().fold(0.0, |most: f64, pair| {
        let moved = fit.target_from_source.apply(pair.source);
        most.max((moved[0] - pair.target[0]).hypot(moved[1] - pair.target[1]))
    })
}
