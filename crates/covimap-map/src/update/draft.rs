//! The map while it is brought up to date.

use covimap_embed::Point;
use petgraph::unionfind::UnionFind;

use super::Joined;
use super::fit::Fit;
use crate::stitch::SURE;
use crate::{Hinge, LinkGraph, PlacedLandmark, SeamReport, Sensed};

/// Stands for the chart, or the region, of a landmark that has none yet.
pub(super) const NOWHERE: u32 = u32::MAX;

/// Places and more, by landmark of the joined log.
pub(super) struct Draft<'a> {
    pub joined: &'a Joined<'a>,
    /// The old chart that tells the place of a landmark.
    pub chart_of: Vec<u32>,
    /// By component: the old chart whose frame it keeps; `None` for one that the ordinary stages map.
    pub base: Vec<Option<u32>>,
    /// Component and chart of the charts that were carried.
    pub carried: Vec<(u32, u32)>,
    /// Positions of least stress.
    pub polished: Vec<Point>,
    /// The same before anything moved; for landmarks without a chart, where they were put first.
    pub origin: Vec<Point>,
    /// Refined positions.
    pub points: Vec<Point>,
    /// Landmarks that are solved again.
    pub free: Vec<bool>,
    /// By landmark; none of one of which nothing was learnt.
    pub sensed: Vec<Option<Sensed>>,
    pub regions: Regions,
}

/// Regions and branches, under numbers of their own: those of the old map first.
pub(super) struct Regions {
    /// By landmark.
    pub of: Vec<u32>,
    /// Branch of each region; those of different charts differ.
    branch_of: Vec<u32>,
    branches: u32,
    /// Branches that are one.
    alike: Vec<[u32; 2]>,
    /// New hinges.
    pub hinges: Vec<Hinge>,
}

impl<'a> Draft<'a> {
    /// Everything where the old map has it.
    pub fn new(joined: &'a Joined<'a>) -> Self {
        let n = joined.landmarks();
        let old = joined.old_map();
        let mut chart_of = vec![NOWHERE; n];
        let (mut polished, mut points) = (joined.old.ground.polished.clone(), Vec::with_capacity(n));
        let mut sensed = vec![None; n];
        for (id, placed) in (0..).map(crate::LandmarkId).zip(old.landmarks()) {
            chart_of[id.index()] = placed.component;
            points.push(placed.position);
            sensed[id.index()] = old.sensing().map(|sensing| *sensing.of(id));
        }
        polished.resize(n, [0.0; 2]);
        points.resize(n, [0.0; 2]);
        Self {
            joined,
            chart_of,
            base: vec![None; joined.components.len()],
            carried: Vec::new(),
            origin: Vec::new(),
            polished,
            points,
            free: vec![false; n],
            sensed,
            regions: Regions::of_map(old.landmarks(), old.report().regions as usize, n),
        }
    }

    /// Whether a landmark's place is in the frame of its component.
    pub fn is_framed(&self, landmark: u32) -> bool {
        let component = self.joined.component_of[landmark as usize];
        let chart = self.chart_of[landmark as usize];
        self.base[component as usize] == Some(chart) || self.carried.contains(&(component, chart))
    }

    /// Whether a landmark is solved again: because it is free, or anew in a component without a base.
    pub fn is_solved(&self, landmark: u32) -> bool {
        let component = self.joined.component_of[landmark as usize];
        let anew = self.base[component as usize].is_none() && self.joined.is_touched(landmark);
        self.free[landmark as usize] || anew
    }

    /// Landmarks of a component whose place a chart tells.
    fn of_chart(&self, component: u32, chart: u32) -> Vec<u32> {
        let members = &self.joined.components[component as usize];
        members.iter().copied().filter(|&member| self.chart_of[member as usize] == chart).collect()
    }

    /// Carries the chart of a landmark into the frame of its component, where it meets `neighbour`; `evidence` is
    /// what speaks for the handedness on the way there.
    pub fn carry(&mut self, landmark: u32, neighbour: u32, fit: &Fit, evidence: f64) {
        let component = self.joined.component_of[landmark as usize];
        let chart = self.chart_of[landmark as usize];
        let members = self.of_chart(component, chart);
        for &member in &members {
            for places in [&mut self.polished, &mut self.points] {
                places[member as usize] = fit.similarity.apply(places[member as usize]);
            }
        }
        self.carried.push((component, chart));
        let fit = Fit { evidence: fit.evidence.min(evidence), ..*fit };
        self.regions.tie(neighbour, landmark, &fit, members.len());
    }

    /// Puts new landmarks into the regions of those that they are linked to most.
    pub fn join_regions(&mut self, graph: &LinkGraph, fresh: &[u32]) {
        let mut left = fresh.to_vec();
        while !left.is_empty() {
            let of = &self.regions.of;
            let known = |&landmark: &u32| {
                let linked = graph.of(landmark).iter().filter(|link| of[link.to as usize] != NOWHERE);
                let nearest = linked.max_by(|a, b| a.weight.total_cmp(&b.weight))?;
                Some((landmark, of[nearest.to as usize]))
            };
            let found: Vec<(u32, u32)> = left.iter().filter_map(known).collect();
            found.iter().for_each(|&(landmark, region)| self.regions.of[landmark as usize] = region);
            left.retain(|&landmark| self.regions.of[landmark as usize] == NOWHERE);
        }
    }

    /// Gives new landmarks regions of their own, one for each number that `region` gives.
    pub fn open_regions(&mut self, graph: &LinkGraph, fresh: &[u32], region: impl Fn(u32) -> u32, fit: &Fit) {
        let placed = |&landmark: &u32| {
            let linked = graph.of(landmark).iter().map(|link| link.to);
            linked.into_iter().find(|&to| self.chart_of[to as usize] != NOWHERE).map(|to| (to, landmark))
        };
        let (neighbour, landmark) =
            fresh.iter().find_map(placed).expect("a piece is linked to what is placed (bug in covimap)");
        self.regions.open(fresh, region);
        self.regions.tie(neighbour, landmark, fit, fresh.len());
    }
}

impl Regions {
    fn of_map(landmarks: &[PlacedLandmark], regions: usize, n: usize) -> Self {
        let charts = landmarks.iter().map(|placed| placed.component as usize + 1).max().unwrap_or(0);
        let mut branches = vec![1; charts];
        for placed in landmarks {
            let most = &mut branches[placed.component as usize];
            *most = placed.branch.max(*most - 1) + 1;
        }
        let first: Vec<u32> = branches
            .iter()
            .scan(0, |next, count| {
                let first = *next;
                *next += count;
                Some(first)
            })
            .collect();
        let mut branch_of = vec![0; regions];
        let mut of = vec![NOWHERE; n];
        for (place, placed) in landmarks.iter().enumerate() {
            of[place] = placed.region;
            branch_of[placed.region as usize] = first[placed.component as usize] + placed.branch;
        }
        Self { of, branch_of, branches: branches.iter().sum(), alike: Vec::new(), hinges: Vec::new() }
    }

    /// New regions in one new branch.
    fn open(&mut self, landmarks: &[u32], region: impl Fn(u32) -> u32) {
        let mut numbers: Vec<u32> = landmarks.iter().map(|&landmark| region(landmark)).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let first = self.branch_of.len() as u32;
        for &landmark in landmarks {
            let rank = numbers.partition_point(|&number| number < region(landmark)) as u32;
            self.of[landmark as usize] = first + rank;
        }
        self.branch_of.extend(numbers.iter().map(|_| self.branches));
        self.branches += 1;
    }

    /// The regions of two landmarks are of one branch if a fit is sure of its handedness; else there is a
    /// hinge between them, beyond which so many landmarks lie.
    fn tie(&mut self, a: u32, b: u32, fit: &Fit, landmarks: usize) {
        let regions = [a, b].map(|landmark| self.of[landmark as usize]);
        if fit.evidence >= SURE {
            self.alike.push(regions.map(|region| self.branch_of[region as usize]));
        } else {
            let &Fit { shared, residual, condition, evidence, .. } = fit;
            let seam =
                SeamReport { regions, shared: shared as u32, residual, condition, evidence, trust: 1.0 };
            self.hinges.push(Hinge { seam, landmarks: landmarks as u32 });
        }
    }

    /// Branch of every region, those that are one under one number.
    pub fn branches(&self) -> Vec<u32> {
        let mut parts = UnionFind::<u32>::new(self.branches as usize);
        self.alike.iter().for_each(|&[a, b]| {
            parts.union(a, b);
        });
        self.branch_of.iter().map(|&branch| parts.find(branch)).collect()
    }
}
