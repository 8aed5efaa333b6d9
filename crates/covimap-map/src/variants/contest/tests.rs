use super::*;
use crate::distances::{ComponentSteps, Distances, Law, Membership};
use crate::fixtures::{counts_of, log_of, looks, scattered};
use crate::local_map::LocalMap;
use crate::surveyor::Surveyor;
use crate::{AutoParams, CoVisibility, LinkGraph, RegionParams, SightingLog, Silent};

const WIDTH: f64 = 14.0;
/// Where what may lie mirrored begins.
const BORDER: f64 = 7.5;

/// A long room.
struct Room {
    truth: Vec<Point>,
    log: SightingLog,
    counts: CoVisibility,
    graph: LinkGraph,
    cover: RegionCover,
    pieces: RegionCover,
}

impl Room {
    fn new() -> Self {
        let truth = scattered(1400, [WIDTH, 7.0], 3);
        let log = log_of(&looks(&truth, [WIDTH, 7.0], 0.8, 9000));
        let counts = counts_of(&log);
        let graph = LinkGraph::from_counts(&counts);
        assert_eq!(graph.components().len(), 1);
        let cut = |core, members| {
            RegionCover::new(&graph, RegionParams { core, members, ..RegionParams::default() })
        };
        let (cover, pieces) = (cut(12, 120), cut(PIECE[0], PIECE[1]));
        Self { truth, log, counts, cover, pieces, graph }
    }

    /// Whether more than half of the core of each region is beyond the border.
    fn beyond(&self) -> Vec<bool> {
        let right = |&member: &u32| self.truth[member as usize][0] > BORDER;
        let beyond = |core: &Vec<u32>| 2 * core.iter().filter(|member| right(member)).count() > core.len();
        self.cover.regions().iter().map(|region| beyond(&region.core)).collect()
    }

    /// The true map, with what is beyond the border mirrored along it or not.
    fn layout(&self, mirrored: bool) -> Vec<Point> {
        let place = |&[x, y]: &Point| if mirrored && x > BORDER { [x, 7.0 - y] } else { [x, y] };
        self.truth.iter().map(place).collect()
    }

    fn with_contest<T>(&self, run: impl FnOnce(&Contest) -> T) -> T {
        let components = self.graph.components();
        let membership = Membership::new(self.truth.len(), &components);
        let steps = &ComponentSteps::of_all(&self.log, &membership, 1)[0];
        let fixed = self.graph.to_pairs();
        let distances = Distances::new(&self.graph, &fixed, &self.counts, &components[0], steps, 0).unwrap();
        let params = AutoParams::default();
        let surveyor = Surveyor {
            graph: &self.graph,
            distances: Some(&distances),
            params: &params,
            seed: 0,
            observer: &Silent,
        };
        let maps = surveyor.local_maps(&self.cover, None).unwrap();
        let law: Law = surveyor.law(&params.distance.families(), &self.cover, &maps).unwrap();
        let of_piece = |piece: &crate::Region| {
            let points = piece.members.iter().map(|&member| self.truth[member as usize]).collect();
            LocalMap { points, stress1: 0.0 }
        };
        let best: Vec<LocalMap> = self.pieces.regions().iter().map(of_piece).collect();
        let contest = Contest {
            trial: Trial { surveyor: &surveyor, law: &law, lifted: true, unseen: &distances.unseen(&law) },
            cover: &self.cover,
            patchwork: &Patchwork::new(&self.graph, &self.cover, &maps, &Silent),
            pieces: &self.pieces,
            of_pieces: &Patchwork::new(&self.graph, &self.pieces, &best, &Silent),
            witnesses: &Witnesses::new(&self.cover, &maps, &self.pieces, &best),
        };
        run(&contest)
    }
}

#[test]
fn parts_are_what_differs_or_what_does_not_if_that_is_less() {
    let room = Room::new();
    room.with_contest(|contest| {
        let (none, mut beyond) = (vec![false; room.cover.regions().len()], room.beyond());
        let part: Vec<u32> =
            (0..).zip(&beyond).filter(|(_, beyond)| **beyond).map(|(region, _)| region).collect();
        assert_eq!(contest.parts_that_differ(&none, &beyond), std::slice::from_ref(&part));
        beyond.iter_mut().for_each(|side| *side ^= true);
        assert_eq!(contest.parts_that_differ(&none, &beyond), [part]);
        // What is smaller than a piece is left alone.
        let mut one = none.clone();
        one[5] = true;
        assert!(contest.parts_that_differ(&none, &one).is_empty());
        assert!(contest.parts_that_differ(&none, &none).is_empty());
    });
}

#[test]
fn a_part_that_lies_mirrored_loses_to_one_that_does_not() {
    let room = Room::new();
    room.with_contest(|contest| {
        let part: Vec<u32> =
            (0..).zip(room.beyond()).filter(|(_, beyond)| *beyond).map(|(region, _)| region).collect();
        let (right, wrong) = (room.layout(false), room.layout(true));
        assert!(contest.is_better(&part, &wrong, &right).unwrap());
        assert!(!contest.is_better(&part, &right, &wrong).unwrap());
        assert!(!contest.is_better(&part, &right, &right).unwrap());
        // The whole has no border.
        let all: Vec<u32> = (0..room.cover.regions().len() as u32).collect();
        assert!(!contest.is_better(&all, &wrong, &right).unwrap());
    });
}

#[test]
fn what_is_settled_is_the_map_of_the_pieces() {
    let room = Room::new();
    room.with_contest(|contest| {
        let (sides, points) = contest.settled().unwrap();
        assert_eq!(sides.len(), room.cover.regions().len());
        let far = |i: usize, j: usize| {
            let length = |of: &[Point]| (of[i][0] - of[j][0]).hypot(of[i][1] - of[j][1]);
            (length(&points) - length(&room.truth)).abs()
        };
        let worst = (1..1400).map(|i| far(i - 1, i)).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst}");
    });
}
