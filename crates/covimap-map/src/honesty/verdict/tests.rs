use super::*;
use crate::fixtures::{counts_of, log_of, looks, scattered};
use crate::honesty::error_rate;

fn hall() -> CoVisibility {
    let points = scattered(120, [3.0, 4.0], 1);
    counts_of(&log_of(&looks(&points, [3.0, 4.0], 0.6, 3000)))
}

/// Support by its definition.
fn slow_support(backbone: &Backbone, i: u32, j: u32) -> u8 {
    let [of_i, of_j] = [i, j].map(|landmark| backbone.partners.of(landmark));
    if of_i.contains(&j) || of_j.contains(&i) {
        return BACKBONE;
    }
    let neighbours =
        |k: u32, l: u32| backbone.partners.of(k).contains(&l) || backbone.partners.of(l).contains(&k);
    match of_i.iter().filter(|k| of_j.contains(k)).count() {
        0 => u8::from(of_i.iter().any(|&k| of_j.iter().any(|&l| neighbours(k, l)))),
        common => MOST_SUPPORT.min(common + 1) as u8,
    }
}

#[test]
fn supports_are_those_of_the_definition() {
    let counts = hall();
    let backbone = Backbone::new(&counts, error_rate::upper_bound(&counts));
    let supports = supports(&counts, &backbone);
    let mut pairs = [0.0; SUPPORTS];
    pairs[0] = 120.0 * 119.0 / 2.0;
    for i in 0..120 {
        for (&j, &support) in counts.row(LandmarkId(i)).0.iter().zip(&supports[i as usize]) {
            assert_eq!(support, slow_support(&backbone, i, j), "{i}, {j}");
        }
        for j in i + 1..120 {
            match slow_support(&backbone, i, j) {
                0 | BACKBONE => {}
                support => pairs[support as usize] += 1.0,
            }
        }
    }
    // All supports occur, and of so few landmarks all pairs are counted, linked or not.
    assert!(pairs.iter().all(|&pairs| pairs > 20.0), "{pairs:?}");
    assert_eq!(pairs_by_support(&backbone, 120), pairs);
}

#[test]
fn cuts_computed_by_hand() {
    let share = 0.01;
    // 1000 pairs. Bucket 40 stands for p = exp(-10) = 4.54e-5: 0.0454 links by chance, a hundredth of 5 at
    // most; nothing else is there.
    let mut links = [0.0; BUCKETS];
    links[40] = 4.0;
    assert_eq!(cut(&links, 1000.0, share), BUCKETS - 1);
    links[40] = 5.0;
    assert_eq!(cut(&links, 1000.0, share), 40);
    // 400 more in bucket 20, p = exp(-5) = 6.74e-3: 6.7 by chance, more than 4.05. Of 700, 7.05 are allowed.
    links[20] = 400.0;
    assert_eq!(cut(&links, 1000.0, share), 40);
    links[20] = 700.0;
    assert_eq!(cut(&links, 1000.0, share), 20);
    // Nothing there, nothing kept but what no chance can make.
    assert_eq!(cut(&[0.0; BUCKETS], 1000.0, share), BUCKETS - 1);
}

#[test]
fn false_sightings_computed_by_hand() {
    // T = 100 steps, S = 40 sightings; x = 0.01, so that the mean is 1 a landmark and F = 4 in all.
    let pairs = [(0, 1, 4), (0, 2, 6), (0, 3, 5)].map(|(i, j, n)| (LandmarkId(i), LandmarkId(j), n));
    let counts = CoVisibility::from_counts(100, vec![16, 8, 8, 8], pairs).unwrap();
    let supports: Vec<Box<[u8]>> =
        vec![Box::new([0, 0, BACKBONE]), Box::new([0]), Box::new([0]), Box::new([BACKBONE])];
    let found = false_sightings(&counts, &supports, 0.01);
    // C_0 = 10: (100 * 10 - 16 * 4) / 40 = 23.4, less twice its root: 13.73; C_1 = 4: (400 - 32) / 40 = 9.2,
    // 9.2 - 6.07 = 3.13; C_2 = 6: 14.2 - 7.54 = 6.66; landmark 3 has no unsupported link: the mean.
    for (found, wanted) in found.iter().zip([13.7253, 3.1337, 6.6634, 1.0]) {
        assert!((found - wanted).abs() < 1e-4, "{found}, {wanted}");
    }
}
