//! Synchronisation of one connected component.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::bridges::bridges;
use super::graduated::{Difference, Kind, fit};
use super::orientation::{Orientation, Vote};
use super::voting::settle;
use super::{EdgeReport, Estimate, RelativeFrame, SynchroniseOptions};
use crate::{EmbedError, Similarity};

/// Edges that the voted rotations miss by more than this count little in the first fit, rad.
const VOTED_WITHIN: f64 = 1.0;
/// Vote of an edge without evidence, as a share of the largest: it decides if no other speaks.
const LEAST_VOTE: f64 = 1e-9;

/// A connected part of the graph with nodes numbered from 0.
pub(super) struct Part {
    /// The nodes, as the caller numbers them, ascending.
    pub(super) nodes: Vec<u32>,
    /// The edges, as the caller numbers them, ascending.
    pub(super) given: Vec<usize>,
    /// The edges between nodes numbered from 0.
    edges: Vec<RelativeFrame>,
}

/// The connected parts; node `i` is in part `component[i]` of `count`.
pub(super) fn parts(component: &[u32], count: usize, edges: &[RelativeFrame]) -> Vec<Part> {
    let empty = || Part { nodes: Vec::new(), given: Vec::new(), edges: Vec::new() };
    let mut parts: Vec<Part> = (0..count).map(|_| empty()).collect();
    let mut place = vec![0; component.len()];
    for (node, &own) in component.iter().enumerate() {
        let nodes = &mut parts[own as usize].nodes;
        place[node] = nodes.len() as u32;
        nodes.push(node as u32);
    }
    for (k, edge) in edges.iter().enumerate() {
        let part = &mut parts[component[edge.a as usize] as usize];
        part.given.push(k);
        part.edges.push(RelativeFrame { a: place[edge.a as usize], b: place[edge.b as usize], ..*edge });
    }
    parts
}

/// An edge in use.
struct Link {
    edge: usize,
    a_from_b: Similarity,
    trust: f64,
}

impl Part {
    /// Frames of the handedness and about the rotation that the edges vote for.
    pub(super) fn voted(&self) -> Vec<Similarity> {
        let most = self.edges.iter().fold(0.0, |most: f64, edge| most.max(edge.evidence));
        let votes: Vec<Vote> = self.edges.iter().map(|edge| vote_of(edge, most)).collect();
        settle(self.nodes.len(), &votes).into_iter().map(frame_of).collect()
    }

    /// The frames of the nodes and the reports of the edges.
    pub(super) fn solve(
        &self,
        options: SynchroniseOptions,
    ) -> Result<(Vec<Similarity>, Vec<EdgeReport>), EmbedError> {
        let mut frames = self.voted();
        let estimates: Vec<_> = self.edges.iter().map(|edge| estimate_for(edge, &frames)).collect();
        let in_use = estimates.iter().enumerate().filter(|(_, (used, _))| *used != Estimate::Neither);
        let mut links: Vec<Link> =
            in_use.map(|(edge, &(_, a_from_b))| Link { edge, a_from_b, trust: 1.0 }).collect();
        if !links.is_empty() {
            self.fit_rotations(&mut frames, &mut links)?;
            if options.scale_pull < f64::INFINITY {
                self.fit_scales(&mut frames, &mut links, options.scale_pull)?;
            }
            self.fit_shifts(&mut frames, &mut links)?;
        }
        let reports = self.reports(&frames, &links, &estimates);
        Ok((frames, reports))
    }

    fn fit_rotations(&self, frames: &mut [Similarity], links: &mut [Link]) -> Result<(), EmbedError> {
        let kind = Kind { period: Some(TAU), unit: 1.0, first_sigma: VOTED_WITHIN, pull: 0.0 };
        let start = frames.iter().map(|frame| [angle(frame)]).collect();
        let angles = self.fit(start, links, &kind, |a, link| {
            [if frames[a].mirrored { -angle(&link.a_from_b) } else { angle(&link.a_from_b) }]
        })?;
        for (frame, [angle]) in frames.iter_mut().zip(angles) {
            (frame.sin, frame.cos) = angle.sin_cos();
        }
        Ok(())
    }

    fn fit_scales(&self, frames: &mut [Similarity], links: &mut [Link], pull: f64) -> Result<(), EmbedError> {
        let kind = Kind { period: None, unit: 1.0, first_sigma: f64::INFINITY, pull };
        let start = vec![[0.0]; frames.len()];
        let logs = self.fit(start, links, &kind, |_, link| [link.a_from_b.scale.ln()])?;
        frames.iter_mut().zip(logs).for_each(|(frame, [log])| frame.scale = log.exp());
        Ok(())
    }

    fn fit_shifts(&self, frames: &mut [Similarity], links: &mut [Link]) -> Result<(), EmbedError> {
        // The shifts of the frames are still zero.
        let measured = |a: usize, link: &Link| frames[a].apply(link.a_from_b.shift);
        let length = |link: &Link| {
            let [x, y] = measured(self.edges[link.edge].a as usize, link);
            x.hypot(y)
        };
        let mut lengths: Vec<f64> = links.iter().map(length).collect();
        let middle = lengths.len() / 2;
        let unit = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
        let kind = Kind { period: None, unit, first_sigma: f64::INFINITY, pull: 0.0 };
        let shifts = self.fit(vec![[0.0; 2]; frames.len()], links, &kind, measured)?;
        frames.iter_mut().zip(shifts).for_each(|(frame, shift)| frame.shift = shift);
        Ok(())
    }

    /// Fits node values to what `measured` makes of each link; the links lose trust accordingly.
    fn fit<const K: usize>(
        &self,
        start: Vec<[f64; K]>,
        links: &mut [Link],
        kind: &Kind,
        measured: impl Fn(usize, &Link) -> [f64; K],
    ) -> Result<Vec<[f64; K]>, EmbedError> {
        let difference = |link: &Link| {
            let RelativeFrame { a, b, weight, .. } = self.edges[link.edge];
            Difference { a, b, measured: measured(a as usize, link), weight, prior: link.trust }
        };
        let differences: Vec<_> = links.iter().map(difference).collect();
        let fitted = fit(start, &differences, kind)?;
        links.iter_mut().zip(fitted.trust).for_each(|(link, trust)| link.trust *= trust);
        Ok(fitted.values)
    }

    fn reports(
        &self,
        frames: &[Similarity],
        links: &[Link],
        estimates: &[(Estimate, Similarity)],
    ) -> Vec<EdgeReport> {
        let report = |(edge, &(used, a_from_b)): (&RelativeFrame, &(Estimate, Similarity))| {
            let expected = frames[edge.a as usize].after(&a_from_b);
            let found = &frames[edge.b as usize];
            let turn = angle(&expected) - angle(found);
            EdgeReport {
                used,
                trust: 0.0,
                bridge: false,
                rotation: turn - TAU * (turn / TAU).round(),
                log_scale: (expected.scale / found.scale).ln(),
                shift: (expected.shift[0] - found.shift[0]).hypot(expected.shift[1] - found.shift[1]),
            }
        };
        let mut reports: Vec<_> = self.edges.iter().zip(estimates).map(report).collect();
        let ends: Vec<_> =
            links.iter().map(|link| (self.edges[link.edge].a, self.edges[link.edge].b)).collect();
        for (link, bridge) in links.iter().zip(bridges(self.nodes.len(), &ends)) {
            reports[link.edge].trust = link.trust;
            reports[link.edge].bridge = bridge;
        }
        reports
    }
}

/// The vote of an edge for its likelier estimate; `most` is the largest evidence of all edges.
fn vote_of(edge: &RelativeFrame, most: f64) -> Vote {
    let Similarity { cos, sin, mirrored, .. } = edge.a_from_b;
    let a_from_b = Orientation { rotation: Complex::new(cos, sin), mirrored };
    let weight = if edge.evidence > 0.0 { edge.evidence / most } else { 0.0 };
    Vote { a: edge.a, b: edge.b, a_from_b, weight: weight.max(LEAST_VOTE) }
}

fn frame_of(orientation: Orientation) -> Similarity {
    let Orientation { rotation, mirrored } = orientation;
    Similarity { cos: rotation.re, sin: rotation.im, mirrored, ..Similarity::IDENTITY }
}

/// The estimate of an edge that has the handedness of the frames; if it has none, the given one.
fn estimate_for(edge: &RelativeFrame, frames: &[Similarity]) -> (Estimate, Similarity) {
    let mirrored = frames[edge.a as usize].mirrored != frames[edge.b as usize].mirrored;
    match edge.alternative {
        _ if edge.a_from_b.mirrored == mirrored => (Estimate::Given, edge.a_from_b),
        Some(alternative) => (Estimate::Alternative, alternative),
        None => (Estimate::Neither, edge.a_from_b),
    }
}

fn angle(frame: &Similarity) -> f64 {
    frame.sin.atan2(frame.cos)
}
