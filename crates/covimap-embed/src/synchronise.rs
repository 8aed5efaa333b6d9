//! One frame for all: many pairwise similarities over a graph become a frame for each node.
//!
//! Given estimates `M_ab` of where node `b` lies in the frame of node `a`, find similarities `G_a`
//! with
//!
//! `G_b = G_a M_ab`  (1)
//!
//! as nearly as the edges allow, though some of them are wrong. With `G x -> s R(t) F^m x + u`
//! (mirror, turn, scale, shift) and `M` written alike, (1) falls apart into
//!
//! | part | equation | unknown |
//! |---|---|---|
//! | mirroring | `m_b = m_a xor m_ab` | one bit a node |
//! | rotation | `t_b = t_a + t_ab` (`- t_ab` where `a` is mirrored), modulo a turn | one angle |
//! | scale | `ln s_b = ln s_a + ln s_ab` | one number |
//! | shift | `u_b = u_a + s_a R(t_a) F^m_a u_ab` | two numbers |
//!
//! # Algorithm
//! 1. Nodes are merged into clusters, best agreement first; between clusters all edges vote. This
//!    gives the mirroring of every node and a first rotation (`voting.rs`, `merging.rs`,
//!    `cycles.rs`).
//! 2. An edge of the wrong handedness takes its estimate of the other handedness, if it has one;
//!    otherwise it is dropped.
//! 3. Rotations, scales and shifts follow in turn from a robust fit of differences on the graph,
//!    by graduated non-convexity (`graduated.rs`). What an edge loses in trust in one of them it lacks in the next.
//!
//! The spectral method, the usual other way, needs the leading eigenvectors of a matrix that has
//! them twice, and a gap that closes as the graph grows; solving on the graph needs neither.
//!
//! # Complexity
//! For `m` edges `O(m log^2 m)`, then some thirty sparse factorisations of the graph's Laplacian
//! for each part, which are near-linear on graphs that lie in the plane. Components run in
//! parallel.
//!
//! # Determinism
//! No random choice; each component is computed on one thread.
//!
//! # References
//! M. Cucuringu, Y. Lipman, A. Singer, "Sensor network localization by eigenvector
//! synchronization over the Euclidean group", ACM Trans. Sensor Netw. 8(3), 2012.
//! A. Chatterjee, V. M. Govindu, "Robust relative rotation averaging", IEEE PAMI 40(4), 2018.

use rayon::prelude::*;

use crate::laplacian::components;
use crate::{EmbedError, Similarity};

mod bridges;
mod cycles;
mod graduated;
mod merging;
mod orientation;
mod part;
mod voting;

use part::{Part, parts};

/// `cos^2 + sin^2` of a rotation may differ from 1 by this.
const ROTATION_SLACK: f64 = 1e-6;

/// An estimate of where node `b` lies in the frame of node `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeFrame {
    /// First node.
    pub a: u32,
    /// Second node, different from `a`. Two nodes may have several edges.
    pub b: u32,
    /// The estimate of the likelier handedness.
    pub a_from_b: Similarity,
    /// The estimate of the other handedness, to be used where the graph as a whole asks for it.
    pub alternative: Option<Similarity>,
    /// How much likelier the first handedness is, `>= 0`: a log-likelihood ratio, or 1 throughout.
    /// Zero leaves the choice to the other edges.
    pub evidence: f64,
    /// Weight of rotation, scale and shift, `> 0`; best an inverse variance.
    pub weight: f64,
}

/// What synchronisation assumes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SynchroniseOptions {
    /// Weight of a pull of every scale towards a common one, in units of the edges' weights,
    /// `>= 0`: it adds `scale_pull sum_a (ln s_a - mean)^2`. 0 (default) for free scales, infinity
    /// where all nodes have the same unit: scales of 1 then, whatever the edges say.
    pub scale_pull: f64,
}

impl Default for SynchroniseOptions {
    fn default() -> Self {
        Self { scale_pull: 0.0 }
    }
}

/// A frame for each node.
#[derive(Debug, Clone, PartialEq)]
pub struct Synchronised {
    /// The frame of each node in that of its component, which is the frame of the component's
    /// first node.
    pub global_from_node: Vec<Similarity>,
    /// Component of each node; components are numbered by their first node.
    pub component: Vec<u32>,
    /// What became of each edge, in the order given.
    pub edges: Vec<EdgeReport>,
}

/// What became of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeReport {
    /// The estimate that was used.
    pub used: Estimate,
    /// Share of the weight that the edge kept, in `[0, 1]`; 0 if no estimate was used. A quarter is
    /// left to an edge that is off by three times the noise of good edges.
    pub trust: f64,
    /// Whether the edge lies on no cycle of edges in use: nothing checks it.
    pub bridge: bool,
    /// Rotation left, `t_ab - (t_b - t_a)`, in rad, in `[-pi, pi]`.
    pub rotation: f64,
    /// Logarithm of the scale left.
    pub log_scale: f64,
    /// Distance between the two places of the origin of `b`, in units of the component.
    pub shift: f64,
}

/// Which estimate of an edge was used. Without one, the residuals are those of the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Estimate {
    /// [`RelativeFrame::a_from_b`].
    Given,
    /// [`RelativeFrame::alternative`]: the handedness was the other one.
    Alternative,
    /// None: the handedness contradicts the graph and there is no alternative.
    Neither,
}

/// Finds a frame for each of `nodes` nodes.
///
/// Nodes that no path connects have unrelated frames; a node without edges has the identity.
///
/// # Errors
/// - [`EmbedError::BadRelativeFrame`] for an edge that names no two different nodes, or whose
///   numbers are out of range.
/// - [`EmbedError::Singular`] or [`EmbedError::OutOfMemory`] from a factorisation.
///
/// # Examples
/// ```
/// use covimap_embed::{RelativeFrame, Similarity, SynchroniseOptions, synchronise};
///
/// let shifted = |a, b, x| RelativeFrame {
///     a,
///     b,
///     a_from_b: Similarity { shift: [x, 0.0], ..Similarity::IDENTITY },
///     alternative: None,
///     evidence: 1.0,
///     weight: 1.0,
/// };
/// let edges = [shifted(0, 1, 1.0), shifted(1, 2, 1.0), shifted(2, 0, -2.0)];
/// let frames = synchronise(3, &edges, SynchroniseOptions::default())?;
/// assert!((frames.global_from_node[2].shift[0] - 2.0).abs() < 1e-9);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn synchronise(
    nodes: usize,
    edges: &[RelativeFrame],
    options: SynchroniseOptions,
) -> Result<Synchronised, EmbedError> {
    check(nodes, edges)?;
    let (component, sizes) = components(nodes, edges.iter().map(|edge| (edge.a, edge.b)));
    let parts = parts(&component, sizes.len(), edges);
    let solved: Vec<_> = parts.par_iter().map(|part| part.solve(options)).collect::<Result<_, _>>()?;
    let mut global_from_node = vec![Similarity::IDENTITY; nodes];
    let mut reports = vec![None; edges.len()];
    for (part, (frames, part_reports)) in parts.iter().zip(solved) {
        part.nodes.iter().zip(frames).for_each(|(&node, frame)| global_from_node[node as usize] = frame);
        part.given.iter().zip(part_reports).for_each(|(&edge, report)| reports[edge] = Some(report));
    }
    let edges =
        reports.into_iter().map(|report| report.expect("every edge has a component (bug in covimap)"));
    Ok(Synchronised { global_from_node, component, edges: edges.collect() })
}

/// Which of the frames that [`synchronise`] finds are mirrored, without the rest of them.
///
/// # Errors
/// As from [`synchronise`], but none of a factorisation.
pub fn handedness(nodes: usize, edges: &[RelativeFrame]) -> Result<Vec<bool>, EmbedError> {
    check(nodes, edges)?;
    let (component, sizes) = components(nodes, edges.iter().map(|edge| (edge.a, edge.b)));
    let parts = parts(&component, sizes.len(), edges);
    let voted: Vec<_> = parts.par_iter().map(Part::voted).collect();
    let mut mirrored = vec![false; nodes];
    for (part, frames) in parts.iter().zip(voted) {
        part.nodes.iter().zip(frames).for_each(|(&node, frame)| mirrored[node as usize] = frame.mirrored);
    }
    Ok(mirrored)
}

fn check(nodes: usize, edges: &[RelativeFrame]) -> Result<(), EmbedError> {
    for (index, edge) in edges.iter().enumerate() {
        let bad = |what| Err(EmbedError::BadRelativeFrame { index, a: edge.a, b: edge.b, nodes, what });
        if edge.a == edge.b || edge.a.max(edge.b) as usize >= nodes {
            return bad("an edge joins two different nodes below the number of nodes");
        }
        if !(edge.weight > 0.0 && edge.weight.is_finite()) {
            return bad("the weight must be finite and positive; leave the edge out instead");
        }
        if !(edge.evidence >= 0.0 && edge.evidence.is_finite()) {
            return bad("the evidence must be finite and not negative; exchange the estimates instead");
        }
        if !std::iter::once(&edge.a_from_b).chain(&edge.alternative).all(sound) {
            return bad("an estimate must be a similarity: cos^2 + sin^2 = 1, scale > 0, all finite");
        }
        if edge.alternative.is_some_and(|other| other.mirrored == edge.a_from_b.mirrored) {
            return bad("the alternative must have the other handedness");
        }
    }
    Ok(())
}

fn sound(frame: &Similarity) -> bool {
    (frame.cos * frame.cos + frame.sin * frame.sin - 1.0).abs() <= ROTATION_SLACK
        && frame.scale > 0.0
        && frame.scale.is_finite()
        && frame.shift.iter().all(|x| x.is_finite())
}

#[cfg(test)]
mod tests;
