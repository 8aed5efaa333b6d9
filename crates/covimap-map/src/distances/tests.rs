use covimap_embed::{DistanceFunction, InverseSquare, Lens};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::{distance, log_of, looks, on_threads, scattered};
use crate::{DistanceChoice, GlobalMap, Mapper, MapperParams, SightingLog, Silent};

fn params(distance: DistanceChoice) -> MapperParams {
    let mut params = MapperParams::default();
    params.auto.distance = distance;
    params.auto.refine_iterations = 0;
    params
}

fn build(log: &SightingLog, distance: DistanceChoice) -> GlobalMap {
    Mapper::new(params(distance)).unwrap().build(log, &Silent).unwrap()
}

fn report(map: &GlobalMap) -> &DistanceReport {
    map.report().components[0].distances.as_ref().unwrap()
}

fn hall(seed: u64) -> (Vec<Point>, SightingLog) {
    let truth = scattered(60, [2.0, 2.5], seed);
    let log = log_of(&looks(&truth, [2.0, 2.5], 0.6, 3000));
    (truth, log)
}

/// Pairs at random distances, each looked at 25 times in every block of time.
fn synthetic(curve: &DistanceCurve, farthest: f64) -> (Sample, Vec<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let distances: Vec<f64> = (0..3000).map(|_| rng.random_range(0.05..farthest)).collect();
    let count = |&distance: &f64| {
        let f = curve.frequency(distance);
        let together = |_| (0..25).filter(|_| rng.random_bool(f)).count() as u32;
        std::array::from_fn(together).map(|together| PairCount { together, either: 25 })
    };
    let blocks = distances.iter().map(count).collect();
    (Sample::of_blocks(blocks), distances)
}

#[test]
fn the_family_that_made_the_counts_is_chosen() {
    let log = StretchedExponential { nearest: 0.8, length: 0.6, exponent: 2.0 };
    for (curve, farthest) in [
        (DistanceCurve::Log(log), 1.1),
        (DistanceCurve::Inverse(InverseSquare { nearest: 0.7, length: 0.4 }), 1.1),
        (DistanceCurve::Lens(Lens { range: 0.7, detectability: 0.8 }), 1.3),
        (DistanceCurve::Power(StretchedExponential { exponent: 1.3, ..log }), 1.1),
    ] {
        let (sample, distances) = synthetic(&curve, farthest);
        let (chosen, scores) = choose(&DistanceFamily::ALL, &sample, &distances, 1.0).unwrap();
        assert_eq!(chosen.family(), curve.family(), "{scores:?}");
        assert_eq!(scores.len(), 6);
    }
}

#[test]
fn no_family_fits_equal_distances_or_no_pairs() {
    let blocks = [PairCount { together: 1, either: 4 }; 16];
    let sample = Sample::of_blocks(vec![blocks; 40]);
    let equal = vec![1.0; 40];
    assert!(choose(&DistanceFamily::ALL, &sample, &equal, 1.0).is_none());
    assert!(choose(&DistanceFamily::ALL, &Sample::of_blocks(Vec::new()), &[], 1.0).is_none());
}

#[test]
fn weights_are_worked_by_hand() {
    let curve = DistanceCurve::Log(StretchedExponential { nearest: 1.0, length: 1.0, exponent: 2.0 });
    // f = 12.5 / 50 = 0.25, e = sqrt(0.25 * 0.75 / 50) = 0.0612372; phi(0.1887628) = 1.2912259,
    // phi(0.3112372) = 1.0803702, v = (0.2108557 / 2)^2 = 0.01111503.
    let count = PairCount { together: 12, either: 49 };
    let trust = Trust { repetition: 1.0, misfit: 0.1, usual: 1.0 };
    let phi = curve.distance(0.25);
    let (weight, kept) = trust.weight(&curve, count, phi);
    assert!((weight - 1.0 / 0.021_115_03).abs() < 1e-4, "{weight}");
    assert_eq!(kept, 1.0);
    // Too short by any length is believed; too long by three sigma keeps a quarter.
    assert_eq!(trust.weight(&curve, count, phi + 5.0).1, 1.0);
    let sigma = 0.021_115_03_f64.sqrt();
    assert!((trust.weight(&curve, count, phi - 3.0 * sigma).1 - 0.25).abs() < 1e-5);
    let strict = Trust { usual: 0.5, ..trust };
    assert_eq!(strict.weight(&curve, count, phi - 1.1).1, weights::KEPT);
}

#[test]
fn a_frequency_above_that_of_no_distance_is_not_a_certainty() {
    let curve = DistanceCurve::Log(StretchedExponential { nearest: 0.3, length: 1.0, exponent: 2.0 });
    let trust = Trust { repetition: 1.0, misfit: 0.0, usual: 1.0 };
    let weight = |together| trust.weight(&curve, PairCount { together, either: 49 }, 0.5).0;
    // Hardly more than that of f = 0.25, where the curve is steep.
    assert!(weight(40) < 10.0 * weight(12), "{} {}", weight(40), weight(12));
}

#[test]
fn pairs_on_the_curve_are_not_doubted() {
    let curve = DistanceCurve::Log(StretchedExponential { nearest: 1.0, length: 1.0, exponent: 2.0 });
    let pairs: Vec<_> = (1..30)
        .map(|together| {
            let count = PairCount { together, either: 40 };
            (count, curve.distance(count.frequency()))
        })
        .collect();
    let trust = Trust::learn(&curve, 1.0, &pairs);
    for (count, in_map) in pairs {
        let (weight, kept) = trust.weight(&curve, count, in_map);
        assert!(weight > 0.0 && weight.is_finite() && kept == 1.0);
    }
}

#[test]
fn a_learnt_curve_makes_a_better_map_than_the_fixed_logarithm() {
    let options =
        covimap_embed::ProcrustesOptions { scale: true, reflection: covimap_embed::Reflection::Allow };
    let error = |seed, choice| {
        let (truth, log) = hall(seed);
        let map = build(&log, choice);
        let pairs: Vec<_> = (0..60)
            .map(|i| covimap_embed::Correspondence {
                source: map.landmarks()[i].position,
                target: truth[i],
                weight: 1.0,
            })
            .collect();
        covimap_embed::procrustes(&pairs, options).unwrap().rmse
    };
    let [fixed, learnt] = [DistanceChoice::FixedLog, DistanceChoice::Auto]
        .map(|choice| (3..8).map(|seed| error(seed, choice)).sum::<f64>());
    assert!(learnt < 0.8 * fixed, "{learnt} {fixed}");
}

#[test]
fn the_report_shows_the_curve_and_the_map() {
    let (_, log) = hall(3);
    let map = build(&log, DistanceChoice::Auto);
    let DistanceReport { learnt, curve, scores, sample, shepard, .. } = report(&map);
    assert!(learnt);
    assert_eq!(*sample, map.report().pairs);
    assert_eq!(shepard.iter().map(|row| row.pairs).sum::<u64>(), *sample);
    assert!(shepard.windows(2).all(|rows| rows[0].frequency >= rows[1].frequency));
    for row in shepard {
        assert_eq!(row.expected, curve.distance(row.frequency));
        assert!(row.distances.windows(2).all(|two| two[0] <= two[1]), "{row:?}");
        assert!((row.expected / row.distances[2] - 1.0).abs() < 0.25, "{row:?}");
    }
    let best = scores.iter().map(|score| score.held_out).fold(f64::MIN, f64::max);
    let chosen = scores.iter().find(|score| score.family == curve.family()).unwrap();
    assert!(chosen.held_out >= best - 2.0);
}

#[test]
fn a_family_that_is_asked_for_is_used() {
    let (_, log) = hall(3);
    for family in DistanceFamily::ALL {
        let map = build(&log, DistanceChoice::Family(family));
        assert_eq!((report(&map).learnt, report(&map).curve.family()), (true, family));
        assert_eq!(report(&map).scores.len(), 1);
    }
    let map = build(&log, DistanceChoice::FixedLog);
    assert!(!report(&map).learnt && report(&map).scores.is_empty());
    assert_eq!(report(&map).curve, fixed_log());
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    let (_, log) = hall(3);
    let run = |threads| on_threads(threads, || build(&log, DistanceChoice::Auto));
    assert_eq!(run(1), run(3));
}

#[test]
fn logs_that_teach_nothing_keep_the_logarithm() {
    // Too few links.
    let map = build(&SightingLog::from_steps([["A", "B"], ["B", "C"]]), DistanceChoice::Auto);
    assert_eq!(map.report().components[0].distances, None);
    // Every two of eight landmarks together once: no pair is together in both halves of the time.
    let pairs = || (0..8).flat_map(|i| (0..i).map(move |j| [i.to_string(), j.to_string()]));
    let map = build(&SightingLog::from_steps(pairs()), DistanceChoice::Auto);
    assert!(!report(&map).learnt);
    // As often as any other two: all frequencies are equal.
    let again = SightingLog::from_steps((0..6).flat_map(|_| pairs()));
    let map = build(&again, DistanceChoice::Auto);
    assert!(map.landmarks().iter().all(|landmark| landmark.position.iter().all(|c| c.is_finite())));
    // Two landmarks that are always together, f near 1, among others.
    let (_, log) = hall(3);
    let twins = log.iter().map(|seen| {
        let names = seen.iter().map(|i| log.names().name(crate::LandmarkId(*i)).to_owned());
        let twin = seen.contains(&7).then(|| "twin".to_owned());
        names.chain(twin).collect::<Vec<_>>()
    });
    let log = SightingLog::from_steps(twins.collect::<Vec<_>>());
    let map = build(&log, DistanceChoice::Auto);
    let place =
        |name: &str| map.landmarks()[map.names().iter().position(|other| other == name).unwrap()].position;
    assert!(distance(place("twin"), place("7")) < 0.1);
}

#[test]
fn pairs_that_no_map_tells_of_are_left_out_of_the_sample() {
    let block = |together| [PairCount { together, either: 9 }; 16];
    let sample = Sample::of_blocks(vec![block(1), block(2), block(3)]);
    let (told, lengths) = sample.told(&[Some(0.5), None, Some(0.25)]);
    assert_eq!((told.links.as_slice(), lengths), (&[0, 2][..], vec![0.5, 0.25]));
    let together: Vec<f64> = told.half(&[0.5, 0.25], false).iter().map(|seen| seen.together).collect();
    assert_eq!(together, [8.0, 24.0]);
}
