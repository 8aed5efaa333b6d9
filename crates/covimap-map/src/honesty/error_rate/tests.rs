use super::*;
use crate::fixtures::{counts_of, log_of, looks, scattered};

#[test]
fn the_bound_computed_by_hand() {
    // Three landmarks of 10 sightings, one pair of three linked: 3 exp(-20 x) = 2.5, x = ln(1.2) / 20.
    let pairs = [(LandmarkId(0), LandmarkId(1), 1)];
    let counts = CoVisibility::from_counts(1000, vec![10; 3], pairs).unwrap();
    assert!((upper_bound(&counts) - 1.2f64.ln() / 20.0).abs() < 1e-12);
    // No link at all: no error.
    let counts = CoVisibility::from_counts(1000, vec![10; 3], []).unwrap();
    assert!(upper_bound(&counts) < 1e-15);
}

/// Shells that show so many co-sightings at an exposure of 100 each.
fn shells(together: &[u64]) -> Shells {
    let mut shells = Shells::default();
    for (shell, &together) in shells.iter_mut().zip(together) {
        *shell = Shell { together, exposure: 100 };
    }
    shells
}

#[test]
fn far_is_where_the_rate_does_not_fall_any_more() {
    // From 4 steps on the rate is level: 3 + 2 + 4 of 300.
    let level = far_pairs(&shells(&[99, 80, 60, 40, 3, 2, 4])).unwrap();
    assert_eq!(level, Shell { together: 9, exposure: 300 });
    // At 4 steps it is 30 where the two beyond have 2.5 in the mean.
    let later = far_pairs(&shells(&[99, 80, 60, 40, 30, 3, 2])).unwrap();
    assert_eq!(later, Shell { together: 5, exposure: 200 });
    // Nothing beyond 4 steps: true links may reach there.
    assert_eq!(far_pairs(&shells(&[99, 80, 60, 40, 3])), None);
    assert_eq!(far_pairs(&shells(&[])), None);
    // Halved at every step, down to the last shell: that one alone is left.
    let falling: Vec<u64> = (0..FARTHEST + 2).map(|h| 4u64.pow((FARTHEST + 1 - h) as u32)).collect();
    assert_eq!(far_pairs(&shells(&falling)), Some(Shell { together: 1, exposure: 100 }));
}

#[test]
fn shells_are_those_of_a_slow_search() {
    // A long corridor, so that all shells occur, and a part of the map that is not reached.
    let mut points = scattered(150, [30.0, 0.5], 1);
    points.extend(scattered(40, [2.0, 2.0], 2).iter().map(|[x, y]| [x + 40.0, *y]));
    let mut seen = looks(&points[..150], [30.0, 0.5], 0.6, 3000);
    let apart: Vec<_> = points[150..].iter().map(|[x, y]| [x - 40.0, *y]).collect();
    seen.extend(
        looks(&apart, [2.0, 2.0], 0.6, 900).iter().map(|look| look.iter().map(|i| i + 150).collect()),
    );
    let counts = counts_of(&log_of(&seen));
    let backbone = Backbone::new(&counts, upper_bound(&counts));
    let n = 190;
    let mut walk = Walk::new(n);
    let mut all_beyond = 0;
    for start in [0u32, 3, 77, 160] {
        // Bellman-Ford on the steps.
        let mut steps = vec![usize::MAX; n];
        steps[start as usize] = 0;
        for _ in 0..n {
            for i in 0..n {
                for to in backbone.neighbours(i as u32) {
                    steps[to as usize] = steps[to as usize].min(steps[i].saturating_add(1));
                }
            }
        }
        let mut wanted = Shells::default();
        for j in 0..n {
            if steps[j] < usize::MAX {
                let both = if j == start as usize {
                    0
                } else {
                    counts.together(LandmarkId(start), LandmarkId(j as u32))
                };
                let exposure = [start as usize, j].map(|i| u64::from(counts.sightings()[i])).iter().sum();
                wanted[steps[j].min(FARTHEST + 1)].add(u64::from(both), exposure);
            }
        }
        assert_eq!(walk.shells(&counts, &backbone, start), wanted, "from {start}");
        all_beyond += wanted[FARTHEST + 1].exposure;
    }
    assert!(all_beyond > 0);
}
