use super::*;
use crate::fixtures::{counts_of, log_of, looks, scattered};

fn room(n: usize, side: f64, steps: usize) -> SightingLog {
    log_of(&looks(&scattered(n, [side, side], 1), [side, side], 0.6, steps))
}

fn estimate(log: &SightingLog, method: Method) -> MemoryEstimate {
    MemoryEstimate::of(log, &MapperParams { method, ..MapperParams::default() }, 1)
}

#[test]
fn pairs_of_a_small_log_are_counted_and_those_of_a_large_one_estimated() {
    for (n, side, steps) in [(40, 2.0, 300), (1500, 12.0, 4000)] {
        let log = room(n, side, steps);
        let exact = counts_of(&log).pair_count() as f64;
        let found = estimated_pairs(&log) as f64;
        let tolerance = if n <= SAMPLE { 0.5 } else { 0.1 * exact };
        assert!((found - exact).abs() < tolerance, "{found} of {exact}");
    }
}

#[test]
fn an_estimate_by_hand() {
    // N = 3, T = 2, S = 4, M = 2; each ID takes 1 + 48 bytes: 4 * 4 + 8 * 2 + 3 * 49 + 16 * 2 = 211 are held.
    let log = SightingLog::from_steps([["A", "B"], ["B", "C"]]);
    let found = estimate(&log, Method::Classical);
    assert_eq!((found.landmarks, found.pairs), (3, 2));
    // 211 + 4 * 4 + 4 * 3 = 239, by 1.25; 211 + 96 * 2 + 40 * 9 = 763, by 1.25.
    assert_eq!((found.counting, found.mapping), (32_000_298, 32_000_953));
    assert_eq!(found.peak(), 32_000_953);
    // N / d = 3 / (4 / 3) = 2.25, log2 = 1.169925: 8 * 4.5 * 3 * 4 / 3 * 1.169925 = 168.5 for the factor, and
    // 211 + 96 * 2 + 4 * 4 + 12 * 2 + 128 * 2 + 48 * 3 = 843, and 100 * 3 * 3 for paths; 1911.5 by 1.25.
    assert_eq!(estimate(&log, Method::Auto).mapping, 32_002_389);
}

#[test]
fn logs_without_pairs_take_next_to_nothing() {
    let none: [[&str; 0]; 0] = [];
    for log in [SightingLog::from_steps(none), SightingLog::from_steps([["A"], ["A"]])] {
        let found = estimate(&log, Method::Auto);
        assert_eq!(found.pairs, 0);
        assert!(found.peak() < 33_000_000, "{found:?}");
    }
}

#[test]
fn a_build_that_takes_too_much_is_refused() {
    let found = MemoryEstimate { landmarks: 100_000, pairs: 2_000_000, counting: 5, mapping: 9_300_000_000 };
    assert!(found.require(9_300_000_000).is_ok());
    let refused = found.require(4_000_000_000).unwrap_err();
    assert!(matches!(refused, MapError::TooLittleMemory { needed: 9_300_000_000, .. }));
    assert_eq!(
        refused.to_string(),
        "the build may take 9300 MB of memory, 4000 MB are allowed - 100000 landmarks, about 2000000 pairs; \
         allow more or map parts of the log"
    );
}
