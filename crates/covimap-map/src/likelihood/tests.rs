use super::*;
use crate::SightingLog;
use crate::fixtures::{counts_of, log_of, looks, on_threads, scattered};

/// Eq. (1), pair by pair: the pools of adjacent violators are found anew after every merge.
fn slow(counts: &CoVisibility, points: &[Point]) -> f64 {
    let n = points.len();
    let mut pairs: Vec<(f64, f64, f64)> = Vec::new();
    for i in 0..n {
        for j in 0..i {
            let both = counts.together(LandmarkId(i as u32), LandmarkId(j as u32));
            let either = counts.sightings()[i] + counts.sightings()[j] - both;
            let length = (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
            pairs.push((length, f64::from(both), f64::from(either)));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pools: Vec<(f64, f64)> = pairs.iter().map(|&(_, both, either)| (both, either)).collect();
    while let Some(k) = (1..pools.len()).find(|&k| pools[k].0 * pools[k - 1].1 > pools[k - 1].0 * pools[k].1)
    {
        let (both, either) = pools.remove(k);
        pools[k - 1] = (pools[k - 1].0 + both, pools[k - 1].1 + either);
    }
    let term = |times: f64, of: f64| if times > 0.0 { times * (times / of).ln() } else { 0.0 };
    pools.iter().map(|&(both, either)| term(both, either) + term(either - both, either)).sum()
}

fn world() -> (CoVisibility, Vec<Point>) {
    let truth = scattered(40, [2.0, 2.0], 5);
    (counts_of(&log_of(&looks(&truth, [2.0, 2.0], 0.5, 300))), truth)
}

fn of_all(counts: &CoVisibility, points: &[Point]) -> f64 {
    let all: Vec<u32> = (0..points.len() as u32).collect();
    log_likelihood(counts, &all, points)
}

#[test]
fn bins_lose_little() {
    // Fewer links than bins: a bin holds one linked pair, and the unlinked ones nearer than it.
    let (counts, truth) = world();
    let (fast, slow) = (of_all(&counts, &truth), slow(&counts, &truth));
    assert!(fast <= slow + 1e-9 * slow.abs() && fast > 1.002 * slow, "{fast} {slow}");
}

#[test]
fn neither_the_unit_nor_threads_nor_a_mirror_matter() {
    let (counts, truth) = world();
    let here = of_all(&counts, &truth);
    let scaled: Vec<Point> = truth.iter().map(|[x, y]| [-8.0 * x, 8.0 * y]).collect();
    assert_eq!(of_all(&counts, &scaled), here);
    assert_eq!(on_threads(1, || of_all(&counts, &truth)), here);
}

#[test]
fn the_truth_tells_more_than_a_fold_and_a_fold_more_than_chance() {
    let (counts, truth) = world();
    let folded: Vec<Point> = truth.iter().map(|&[x, y]| [(x - 1.0).abs(), y]).collect();
    let by_chance = scattered(40, [2.0, 2.0], 6);
    let [right, folded, chance] = [&truth, &folded, &by_chance].map(|at| of_all(&counts, at));
    assert!(0.0 > right && right > 0.8 * folded && folded > chance, "{right} {folded} {chance}");
}

#[test]
fn only_members_have_a_say() {
    let log = SightingLog::from_steps([vec!["A", "B"], vec!["A", "X"], vec!["B", "C"], vec!["C"]]);
    let counts = counts_of(&log);
    // A-B and B-C are seen together in 1 of 3 steps, A-C in none of 4.
    let ids = log.names().iter().zip(0..);
    let members: Vec<u32> = ids.filter(|&(id, _)| id != "X").map(|(_, number)| number).collect();
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    let wanted = 2.0 * (1f64 / 3.0).ln() + 4.0 * (2f64 / 3.0).ln();
    assert!((log_likelihood(&counts, &members, &points) - wanted).abs() < 1e-12);
}

#[test]
fn nothing_to_tell() {
    let counts = counts_of(&SightingLog::from_steps([["A"], ["B"]]));
    assert_eq!(log_likelihood(&counts, &[], &[]), 0.0);
    assert_eq!(log_likelihood(&counts, &[0], &[[0.0, 0.0]]), 0.0);
    assert_eq!(log_likelihood(&counts, &[0, 1], &[[0.0, 0.0], [0.0, 0.0]]), 0.0);
}
