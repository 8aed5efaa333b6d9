use super::*;
use crate::fixtures::{counts_of, log_of, looks, scattered};
use crate::{Mapper, MapperParams, Method, Silent};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SOUND: SensorModel = SensorModel { range: 1.0, edge: 0.1, detectability: 0.9, outliers: 1e-3 };

const SENSED: Sensed = Sensed { detectability: 0.5, deviation: 0.1, warp: 0.2 };

#[test]
fn parts_out_of_their_range_are_refused() {
    let refusal = |sensor, sensed: &[Sensed], pairs: &[[u32; 2]]| {
        Sensing::from_parts(vec![sensor], sensed.to_vec(), pairs).unwrap_err().to_string()
    };
    for (sensor, what) in [
        (SensorModel { range: 0.0, ..SOUND }, "range: 0.0"),
        (SensorModel { edge: f64::NAN, ..SOUND }, "edge: NaN"),
        (SensorModel { detectability: 1.0, ..SOUND }, "detectability: 1.0"),
        (SensorModel { outliers: 0.0, ..SOUND }, "outliers: 0.0"),
    ] {
        let text = refusal(sensor, &[SENSED], &[]);
        assert!(text.starts_with("the sensor of component 0 is ") && text.contains(what), "{text}");
    }
    for (wrong, what) in [
        (Sensed { detectability: 1.5, ..SENSED }, "detectability: 1.5"),
        (Sensed { deviation: 0.0, ..SENSED }, "deviation: 0.0"),
        (Sensed { deviation: f64::INFINITY, ..SENSED }, "deviation: inf"),
        (Sensed { warp: -0.1, ..SENSED }, "warp: -0.1"),
        (Sensed { warp: f64::NAN, ..SENSED }, "warp: NaN"),
    ] {
        let text = refusal(SOUND, &[SENSED, wrong], &[]);
        assert!(text.starts_with("what is known of landmark 1 is ") && text.contains(what), "{text}");
    }
    for pair in [[0, 0], [0, 2]] {
        let text = refusal(SOUND, &[SENSED; 2], &[pair]);
        assert!(text.ends_with("of 2 are said to be occluded; build the map again"), "{text}");
    }
}

#[test]
fn occluded_pairs_are_found_from_both_ends() {
    let pairs = [[3, 1], [0, 3], [1, 3]];
    let sensing = Sensing::from_parts(vec![SOUND], vec![SENSED; 4], &pairs).unwrap();
    assert_eq!(sensing.occluded_from(LandmarkId(3)), [0, 1]);
    assert_eq!(sensing.occluded_from(LandmarkId(0)), [3]);
    assert_eq!(sensing.occluded_from(LandmarkId(2)), [0; 0]);
    assert_eq!(sensing.occluded_pairs().collect::<Vec<_>>(), [[0, 3], [1, 3]]);
}

/// What is learnt from looks into a hall, each coordinate off by up to `jitter`.
fn learnt(looks: &[Vec<usize>], truth: &[Point], jitter: f64) -> Sensing {
    let log = log_of(looks);
    let counts = counts_of(&log);
    let graph = LinkGraph::from_counts(&counts);
    let components = graph.components();
    assert_eq!(components.len(), 1);
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut shaken =
        |point: &Point| point.map(|c| if jitter > 0.0 { c + rng.random_range(-jitter..jitter) } else { c });
    let points: Vec<Point> = truth.iter().map(&mut shaken).collect();
    let sets = SeenSets::by_component(&log, &components);
    learn(&counts, &graph, &components, &[&points], &sets, &Silent).unwrap().unwrap()
}

#[test]
fn the_sensor_of_a_hall_is_found_with_its_false_sightings() {
    // Range 0.6, edge 0.048, detectability 0.9.
    let truth = scattered(80, [2.0, 4.0], 4);
    let mut looks = looks(&truth, [2.0, 4.0], 0.6, 6000);
    let clean = learnt(&looks, &truth, 0.0);
    let sensor = clean.sensor(0);
    assert!((sensor.range / 0.6 - 1.0).abs() < 0.05, "{sensor:?}");
    assert!((0.7..1.7).contains(&(sensor.edge / 0.048)), "{sensor:?}");
    assert!((sensor.detectability - 0.9).abs() < 0.05, "{sensor:?}");
    assert!(sensor.outliers < 2e-3, "{sensor:?}");
    assert_eq!(clean.occluded_pairs().count(), 0);
    // One in fifty sightings names any landmark.
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for seen in looks.iter_mut().flatten() {
        if rng.random_bool(0.02) {
            *seen = rng.random_range(0..80);
        }
    }
    looks.iter_mut().for_each(|look| {
        look.sort_unstable();
        look.dedup();
    });
    let noisy = learnt(&looks, &truth, 0.0).sensor(0).outliers;
    assert!((0.01..0.03).contains(&noisy), "{noisy}");
}

#[test]
fn deviations_fall_with_the_root_of_the_steps() {
    let truth = scattered(80, [2.0, 4.0], 4);
    let mean = |steps| {
        let sensing = learnt(&looks(&truth, [2.0, 4.0], 0.6, steps), &truth, 0.0);
        (0..80).map(|i| sensing.of(LandmarkId(i)).deviation).sum::<f64>() / 80.0
    };
    // Four times the steps, and so many that most are only stood for.
    let ratio = mean(1500) / mean(6000);
    assert!((1.7..2.3).contains(&ratio), "{ratio}");
}

#[test]
fn warps_fall_with_the_steps_and_are_least_in_the_middle_of_a_long_hall() {
    let truth = scattered(160, [1.0, 8.0], 4);
    let [few, many] = [1500, 6000].map(|steps| learnt(&looks(&truth, [1.0, 8.0], 0.6, steps), &truth, 0.0));
    let rms = |sensing: &Sensing, from: f64, to: f64| {
        let there = (0..160).filter(|&i| (from..to).contains(&truth[i as usize][1]));
        let squares: Vec<f64> = there.map(|i| sensing.of(LandmarkId(i)).warp.powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    // Four times the steps halve what is chance, and leave what the walls make wrong.
    let ratio = rms(&few, 0.0, 8.0) / rms(&many, 0.0, 8.0);
    assert!((1.2..2.0).contains(&ratio), "{ratio}");
    for sensing in [&few, &many] {
        let middle = rms(sensing, 1.5, 2.5);
        assert!(rms(sensing, 0.0, 0.5) > 1.3 * middle && rms(sensing, 7.5, 8.0) > 1.3 * middle);
    }
}

#[test]
fn a_wall_occludes_the_pairs_across_it() {
    // Two halls side by side, of which one sees nothing of the other but through landmark 0 and 40.
    let truth: Vec<Point> = scattered(80, [2.0, 2.0], 4);
    let side = |i: usize| truth[i][0] < 1.0;
    let split: Vec<Vec<usize>> = looks(&truth, [2.0, 2.0], 0.6, 4000)
        .into_iter()
        .map(|look| {
            let Some(&first) = look.first() else { return look };
            // A doorway at the upper end through which all is seen.
            if truth[first][1] > 1.5 {
                return look;
            }
            look.into_iter().filter(|&i| side(i) == side(first)).collect()
        })
        .collect();
    let sensing = learnt(&split, &truth, 0.0);
    let across = |[a, b]: [u32; 2]| side(a as usize) != side(b as usize);
    let (wall, open): (Vec<_>, Vec<_>) = sensing.occluded_pairs().partition(|&pair| across(pair));
    assert!(wall.len() > 30 && open.len() <= wall.len() / 10, "{} across, {} not", wall.len(), open.len());
}

#[test]
fn small_components_borrow_the_sensor_and_a_map_of_pairs_has_none() {
    let truth = scattered(40, [2.0, 2.0], 4);
    let mut looks = looks(&truth, [2.0, 2.0], 0.6, 600);
    looks.extend(vec![vec![40, 41]; 9]);
    for method in [Method::Auto, Method::Classical] {
        let params = MapperParams { method, ..MapperParams::default() };
        let map = Mapper::new(params.clone()).unwrap().build(&log_of(&looks), &Silent).unwrap();
        let sensing = map.sensing().unwrap();
        assert_eq!(sensing.sensor(0), sensing.sensor(1));
        assert_eq!(*sensing.of(LandmarkId(41)), sensing.sensor(1).unseen());
        let pair = Mapper::new(params).unwrap().build(&log_of(&vec![vec![0, 1]; 3]), &Silent).unwrap();
        assert_eq!(pair.sensing(), None);
    }
}

#[test]
fn three_landmarks_and_a_pile_of_them_are_learnt_without_a_fuss() {
    let looks = [vec![0, 1], vec![1, 2], vec![0, 1, 2], vec![2]];
    for truth in [[[0.0, 0.0], [0.4, 0.0], [0.8, 0.1]], [[0.0, 0.0], [0.0, 0.0], [0.8, 0.1]]] {
        let sensing = learnt(&looks, &truth, 0.0);
        assert!(sensing.sensor(0).is_sound());
    }
}
