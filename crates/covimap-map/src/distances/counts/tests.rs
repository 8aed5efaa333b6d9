use super::*;
use crate::distances::Membership;
use crate::fixtures::{counts_of, log_of, looks, scattered};
use crate::{LinkGraph, SightingLog};

/// A small hall, looked at from random places; every look so many times in a row.
fn hall(times: usize) -> SightingLog {
    let looks = looks(&scattered(40, [2.0, 2.0], 1), [2.0, 2.0], 0.6, 1600);
    let repeated: Vec<Vec<usize>> = looks.into_iter().flat_map(|look| vec![look; times]).collect();
    log_of(&repeated)
}

fn drawn(log: &SightingLog) -> (LinkGraph, Sample) {
    let graph = LinkGraph::from_counts(&counts_of(log));
    let members = vec![(0..graph.landmarks() as u32).collect()];
    let membership = Membership::new(graph.landmarks(), &members);
    let steps = ComponentSteps::of_all(log, &membership, 1).pop().unwrap();
    let sample = Sample::draw(&graph.to_pairs(), &steps, 0);
    (graph, sample)
}

#[test]
fn links_are_counted_as_the_log_has_them() {
    // n_A = 3, n_B = 3, n_C = 2; AB together twice, AC once, BC once.
    let log = SightingLog::from_steps([vec!["A", "B"], vec!["A", "B"], vec!["A", "C"], vec!["B", "C"]]);
    let counts = counts_of(&log);
    let links = of_links(&LinkGraph::from_counts(&counts), &counts, &[0, 1, 2]);
    let found: Vec<_> = links.iter().map(|link| (link.together, link.either)).collect();
    assert_eq!(found, [(2, 4), (1, 4), (1, 4)]);
    assert!((links[0].frequency() - 2.5 / 5.0).abs() < 1e-15);
}

#[test]
fn blocks_add_up_to_the_counts_of_the_log() {
    let log = hall(1);
    let (graph, sample) = drawn(&log);
    let members: Vec<u32> = (0..40).collect();
    let links = of_links(&graph, &counts_of(&log), &members);
    assert_eq!(sample.len(), graph.link_count());
    for (blocks, link) in sample.blocks.iter().zip(&links) {
        let sum = |of: fn(&PairCount) -> u32| blocks.iter().map(of).sum::<u32>();
        assert_eq!((sum(|b| b.together), sum(|b| b.either)), (link.together, link.either));
    }
}

#[test]
fn a_half_holds_the_pairs_that_the_other_half_links() {
    let blocks = |together: [u32; BLOCKS]| together.map(|together| PairCount { together, either: 10 });
    let (mut both, mut even) = ([0; BLOCKS], [0; BLOCKS]);
    (both[0], both[1], even[2]) = (3, 4, 5);
    let sample =
        Sample { links: vec![0, 1], ends: vec![[0, 1], [0, 2]], blocks: vec![blocks(both), blocks(even)] };
    let found = |odd| {
        let half = sample.half(&[0.5, 0.7], odd);
        half.iter().map(|o| (o.distance, o.together, o.either)).collect::<Vec<_>>()
    };
    assert_eq!(found(false), [(0.5, 3.0, 80.0)]);
    assert_eq!(found(true), [(0.5, 4.0, 80.0), (0.7, 0.0, 80.0)]);
}

#[test]
fn a_robot_that_repeats_itself_tells_less() {
    let [once, four] = [1, 4].map(|times| drawn(&hall(times)).1.repetition());
    assert!((once - 1.0).abs() < 0.25, "{once}");
    assert!((four / once - 4.0).abs() < 0.6, "{four} {once}");
}

#[test]
fn repetition_is_one_where_the_log_cannot_tell() {
    // Always together: no variance at all.
    let blocks = [PairCount { together: 2, either: 2 }; BLOCKS];
    assert_eq!(Sample { links: vec![0], ends: vec![[0, 1]], blocks: vec![blocks] }.repetition(), 1.0);
    assert_eq!(Sample { links: vec![], ends: vec![], blocks: vec![] }.repetition(), 1.0);
}
