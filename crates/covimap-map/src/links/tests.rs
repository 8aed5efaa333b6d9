use petgraph::algo::connected_components;
use petgraph::visit::EdgeRef;
use proptest::prelude::*;

use super::*;
use crate::{SightingLog, Silent};

fn graph_of(steps: &[Vec<u32>]) -> LinkGraph {
    let log = SightingLog::from_steps(steps.iter().map(|step| step.iter().map(u32::to_string)));
    LinkGraph::from_counts(&CoVisibility::count(&log, &Silent).unwrap())
}

/// Logs of few landmarks, many of them in several components.
fn steps() -> impl Strategy<Value = Vec<Vec<u32>>> {
    prop::collection::vec(prop::collection::vec(0..25_u32, 1..4), 1..30)
}

#[test]
fn distance_and_weight_computed_by_hand() {
    let log = SightingLog::from_steps([vec!["A", "B"], vec!["A", "B", "C"], vec!["A"], vec!["B", "D"]]);
    let graph = LinkGraph::from_counts(&CoVisibility::count(&log, &Silent).unwrap());
    assert_eq!((graph.landmarks(), graph.link_count()), (4, 4));
    let link = |a: u32, b: u32| *graph.of(a).iter().find(|link| link.to == b).unwrap();
    // A and B: n_A = 3, n_B = 3, n_AB = 2, so f = (2 + 1/2) / (3 + 3 - 2 + 1) = 1/2 and
    // d = sqrt(0.3 ln 2) = sqrt(0.2079442) = 0.4560090; the weight is sqrt 2.
    assert!((link(0, 1).distance - 0.456_009_0).abs() < 1e-7);
    assert_eq!(link(0, 1).weight, 2.0_f64.sqrt());
    // A and C: n_A = 3, n_C = 1, n_AC = 1, so f = 1.5 / 4 and d = sqrt(0.3 * 0.9808293) = 0.5424470.
    assert!((link(2, 0).distance - 0.542_447_0).abs() < 1e-7);
    assert_eq!(link(2, 0).weight, 1.0);
    assert_eq!(graph.of(3), [Link { to: 1, ..link(3, 1) }]);
}

#[test]
fn landmarks_that_are_always_seen_together_are_still_apart() {
    // f = (n + 1/2) / (n + 1) < 1 for every n: the distance shrinks with the evidence.
    let distance = |n: usize| graph_of(&vec![vec![0, 1]; n]).of(0)[0].distance;
    assert!(distance(1) > distance(10) && distance(10) > distance(1000) && distance(1000) > 0.0);
}

proptest! {
    #[test]
    fn links_are_those_of_the_counts_and_the_same_from_both_ends(steps in steps()) {
        let graph = graph_of(&steps);
        let mut ends = 0;
        for i in 0..graph.landmarks() as u32 {
            prop_assert!(graph.of(i).is_sorted_by(|a, b| a.to < b.to));
            for link in graph.of(i) {
                let back = graph.of(link.to).iter().find(|back| back.to == i).unwrap();
                prop_assert_eq!((back.distance, back.weight), (link.distance, link.weight));
                prop_assert!(link.distance > 0.0 && link.weight > 0.0 && link.to != i);
                ends += 1;
            }
        }
        prop_assert_eq!(graph.link_count(), ends / 2);
    }

    #[test]
    fn a_restriction_keeps_the_links_inside(
        steps in steps(), mut members in prop::collection::btree_set(0..25_u32, 0..12),
    ) {
        let graph = graph_of(&steps);
        members.retain(|&member| (member as usize) < graph.landmarks());
        let members: Vec<u32> = members.into_iter().collect();
        let part = graph.restricted_to(&members);
        prop_assert_eq!(part.landmarks(), members.len());
        for (place, &member) in members.iter().enumerate() {
            let wanted: Vec<Link> = graph
                .of(member)
                .iter()
                .filter_map(|link| {
                    let to = members.iter().position(|&other| other == link.to)? as u32;
                    Some(Link { to, ..*link })
                })
                .collect();
            prop_assert_eq!(part.of(place as u32), wanted);
        }
    }

    #[test]
    fn components_are_those_of_petgraph(steps in steps()) {
        let graph = graph_of(&steps);
        let components = graph.components();
        prop_assert_eq!(components.len(), connected_components(&graph.to_petgraph()));
        let mut component_of = vec![usize::MAX; graph.landmarks()];
        for (number, members) in components.iter().enumerate() {
            prop_assert!(members.is_sorted_by(|a, b| a < b));
            for &member in members {
                prop_assert_eq!(std::mem::replace(&mut component_of[member as usize], number), usize::MAX);
            }
        }
        for i in 0..graph.landmarks() {
            prop_assert!(component_of[i] < components.len());
            prop_assert!(graph.of(i as u32).iter().all(|link| component_of[link.to as usize] == component_of[i]));
        }
        // The largest first, equal ones by their first landmark.
        let order = components.iter().map(|members| (std::cmp::Reverse(members.len()), members[0]));
        prop_assert!(order.is_sorted());
    }

    #[test]
    fn pairs_and_edges_list_every_link_once(steps in steps()) {
        let graph = graph_of(&steps);
        let pairs = graph.to_pairs();
        prop_assert_eq!((pairs.objects(), pairs.pairs().len()), (graph.landmarks(), graph.link_count()));
        let edges = graph.to_petgraph();
        prop_assert_eq!(edges.node_count(), graph.landmarks());
        prop_assert_eq!(edges.edge_count(), graph.link_count());
        for (pair, edge) in pairs.pairs().iter().zip(edges.edge_references()) {
            let link = graph.of(pair.i).iter().find(|link| link.to == pair.j).unwrap();
            prop_assert_eq!((pair.distance, pair.weight), (link.distance, link.weight));
            prop_assert_eq!((edge.source().index() as u32, edge.target().index() as u32), (pair.i, pair.j));
            prop_assert_eq!(*edge.weight(), link.distance);
        }
        let other = graph.to_pairs_with(|i, j| (f64::from(i), f64::from(j)));
        prop_assert!(other.pairs().iter().all(|p| p.distance == f64::from(p.i) && p.weight == f64::from(p.j)));
    }
}

#[test]
fn no_landmark_and_a_lone_one() {
    let none = graph_of(&[]);
    assert_eq!((none.landmarks(), none.components().len()), (0, 0));
    let lone = graph_of(&[vec![7]]);
    assert_eq!((lone.landmarks(), lone.link_count()), (1, 0));
    assert_eq!(lone.components(), [[0]]);
    assert!(lone.to_pairs().pairs().is_empty());
}
