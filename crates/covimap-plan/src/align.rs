//! A map in a frame that is known from outside.
//!
//! A log of co-visibility tells neither metres nor north nor left from right. Whoever knows something of that
//! kind can give it, component by component:
//!
//! - *positions* of some landmarks: the similarity of least squares carries the component onto them, mirrored if it
//!   must be. Three that are not in line are needed, or two and a turn;
//! - *distances* between some landmarks, where no positions are known: the scale of least squares,
//!   `s = sum(d m) / sum(m^2)` over the known distances d and their lengths m on the map;
//! - *turns*: three landmarks that are known to turn left, which settles whether the component is a mirror image.
//!
//! A component of which too little is known stays as it is.

use covimap_embed::{Correspondence, Point, ProcrustesOptions, Reflection, Similarity, procrustes};
use covimap_map::{ChartFit, GlobalMap, LandmarkId, Truth};

use crate::confidence::length;
use crate::relations::Turn;
use crate::{MapIndex, PlanError};

/// How sure the turn of three landmarks on the map must be to tell its handedness.
const SURE_TURN: f64 = 0.9;

/// What is known from outside.
#[derive(Debug, Clone, Copy, Default)]
pub struct Known<'a> {
    /// Positions, in any unit and frame; those of landmarks that the map does not have are left out.
    pub positions: Option<&'a Truth>,
    /// Distances, in any unit; used for components that the positions do not place.
    pub distances: &'a [KnownDistance],
    /// Landmarks a, b, c of which c is to the left of the line from a to b.
    pub left_turns: &'a [[String; 3]],
}

/// A distance between two landmarks.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownDistance {
    /// String ID of one.
    pub from: String,
    /// String ID of the other.
    pub to: String,
    /// How far they are apart, `> 0`.
    pub distance: f64,
}

/// A map that was carried into a known frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Aligned {
    /// The map; [`GlobalMap::alignment`] tells which components were carried, and how well they fit.
    pub map: GlobalMap,
    /// The components that this call carried, ascending.
    pub carried: Vec<u32>,
    /// Landmarks of known position in these components and how far they are from it, in known units.
    pub residuals: Vec<(LandmarkId, f64)>,
    /// Known positions of landmarks that the map does not have.
    pub unknown: usize,
}

/// Carries a map into the frame of what is known. `O(n + k log k)` for `k` things known.
///
/// # Errors
/// - [`PlanError::NothingKnown`], [`PlanError::BadDistance`]; [`PlanError::UnknownLandmark`],
///   [`PlanError::Repeated`] or [`PlanError::Apart`] for distances and turns that the map cannot have.
/// - [`PlanError::UncertainTurn`] for a known turn of landmarks that are nearly in line on the map,
///   [`PlanError::TurnContradicted`] when it is contradicted by another one or by the known positions.
/// - [`PlanError::TooFewAnchors`] when the known positions place no component and nothing else is known.
/// - [`PlanError::NoLength`] when known distances are between landmarks at one place of the map.
/// - [`PlanError::Embed`] for positions that coincide or are beyond all measure.
pub fn align(index: &MapIndex, known: &Known) -> Result<Aligned, PlanError> {
    if known.positions.is_none() && known.distances.is_empty() && known.left_turns.is_empty() {
        return Err(PlanError::NothingKnown);
    }
    let map = index.map();
    let component_of = |id: LandmarkId| index.placed(id).component;
    let (mut anchors, unknown) = anchors(index, known.positions);
    anchors.sort_by_key(|anchor| component_of(anchor.0));
    let mut rulers = rulers(index, known.distances)?;
    rulers.sort_by_key(|ruler| component_of(ruler.0));
    let mut turns = turns(index, known.left_turns)?;
    turns.sort_by_key(|turn| component_of(turn.0[0]));
    let mut positions: Vec<Point> = map.landmarks().iter().map(|placed| placed.position).collect();
    let mut alignment = map.alignment().to_vec();
    let (mut carried, mut residuals) = (Vec::new(), Vec::new());
    for component in index.components() {
        let evidence = Evidence {
            component,
            anchors: of(&anchors, component, |anchor| component_of(anchor.0)),
            rulers: of(&rulers, component, |ruler| component_of(ruler.0)),
            turns: of(&turns, component, |turn| component_of(turn.0[0])),
        };
        let Some((known_from_map, mut fit)) = evidence.fit(index)? else { continue };
        for id in index.component(component)? {
            positions[id.index()] = known_from_map.apply(positions[id.index()]);
        }
        if fit.anchors > 0 {
            residuals.extend(
                evidence.anchors.iter().map(|&(id, known)| (id, apart(positions[id.index()], known))),
            );
        }
        if let Some(place) = alignment.iter().position(|before| before.component == component) {
            let before = alignment.remove(place);
            if before.handed && fit.anchors == 0 && known_from_map.mirrored {
                return Err(contradicted(index, &evidence.turns[0].0));
            }
            if fit.anchors + fit.distances == 0 {
                // A turn has nothing to say of lengths: they are as exact as they were.
                fit = ChartFit { handed: true, ..before };
            } else {
                fit.scale *= before.scale;
                fit.handed |= before.handed;
            }
        }
        alignment.push(fit);
        carried.push(component);
    }
    if carried.is_empty() {
        return Err(PlanError::TooFewAnchors { anchors: anchors.len() });
    }
    alignment.sort_by_key(|fit| fit.component);
    let map = GlobalMap::clone(map).with_positions(&positions, alignment)?;
    Ok(Aligned { map, carried, residuals, unknown })
}

/// What is known of one component.
struct Evidence<'a> {
    component: u32,
    anchors: &'a [(LandmarkId, Point)],
    rulers: &'a [(LandmarkId, LandmarkId, f64)],
    turns: &'a [([LandmarkId; 3], Turn)],
}

/// Those of one component, of evidence in the order of components.
fn of<T>(all: &[T], component: u32, component_of: impl Fn(&T) -> u32) -> &[T] {
    let from = all.partition_point(|one| component_of(one) < component);
    let length = all[from..].partition_point(|one| component_of(one) == component);
    &all[from..from + length]
}

impl Evidence<'_> {
    /// The similarity that the evidence asks for, if it asks for one.
    fn fit(&self, index: &MapIndex) -> Result<Option<(Similarity, ChartFit)>, PlanError> {
        let mirrored = self.mirrored(index)?;
        let fit = ChartFit {
            component: self.component,
            scale: 1.0,
            anchors: 0,
            distances: 0,
            rmse: 0.0,
            handed: mirrored.is_some(),
        };
        if let Some(placed) = self.onto_anchors(index, mirrored, &fit)? {
            return Ok(Some(placed));
        }
        let mirror = Similarity { mirrored: mirrored == Some(true), ..Similarity::IDENTITY };
        if !self.rulers.is_empty() {
            let (scale, rmse) = self.scale(index)?;
            let fit = ChartFit { scale, rmse, distances: self.rulers.len() as u64, ..fit };
            return Ok(Some((Similarity { scale, ..mirror }, fit)));
        }
        Ok(mirrored.map(|_| (mirror, fit)))
    }

    /// Whether the known turns say that the component is a mirror image.
    fn mirrored(&self, index: &MapIndex) -> Result<Option<bool>, PlanError> {
        let Some(&(_, first)) = self.turns.first() else { return Ok(None) };
        if let Some((ids, _)) = self.turns.iter().find(|(_, turn)| *turn != first) {
            return Err(contradicted(index, ids));
        }
        Ok(Some(first == Turn::Right))
    }

    fn onto_anchors(
        &self,
        index: &MapIndex,
        mirrored: Option<bool>,
        fit: &ChartFit,
    ) -> Result<Option<(Similarity, ChartFit)>, PlanError> {
        if self.anchors.len() < 2 {
            return Ok(None);
        }
        let pair = |&(id, target): &(LandmarkId, Point)| Correspondence {
            source: index.placed(id).position,
            target,
            weight: 1.0,
        };
        let pairs: Vec<Correspondence> = self.anchors.iter().map(pair).collect();
        let reflection = match mirrored {
            None => Reflection::Allow,
            Some(false) => Reflection::Forbid,
            Some(true) => Reflection::Require,
        };
        let found = procrustes(&pairs, ProcrustesOptions { scale: true, reflection })?;
        if mirrored.is_none() && !found.handedness_determined {
            return Ok(None);
        }
        if found.handedness_determined && found.rmse_other < found.rmse {
            return Err(contradicted(index, &self.turns[0].0));
        }
        let scale = found.target_from_source.scale;
        let anchors = pairs.len() as u64;
        let fit = ChartFit { scale, rmse: found.rmse, anchors, handed: true, ..fit.clone() };
        Ok(Some((found.target_from_source, fit)))
    }

    /// The scale of least squares and what it leaves of the distances, root mean square.
    fn scale(&self, index: &MapIndex) -> Result<(f64, f64), PlanError> {
        let lengths = self.rulers.iter().map(|&(from, to, known)| (length(index.map(), from, to), known));
        let squares: f64 = lengths.clone().map(|(on_map, _)| on_map * on_map).sum();
        if squares == 0.0 {
            return Err(PlanError::NoLength { component: self.component });
        }
        let scale = lengths.clone().map(|(on_map, known)| on_map * known).sum::<f64>() / squares;
        let left: f64 = lengths.map(|(on_map, known)| (scale * on_map - known).powi(2)).sum();
        Ok((scale, (left / self.rulers.len() as f64).sqrt()))
    }
}

/// Known positions of landmarks of the map, and how many are of others.
fn anchors(index: &MapIndex, positions: Option<&Truth>) -> (Vec<(LandmarkId, Point)>, usize) {
    let Some(truth) = positions else { return (Vec::new(), 0) };
    let known = truth.names().iter().zip(truth.positions());
    let found: Vec<_> = known.filter_map(|(name, &at)| index.lookup(name).map(|id| (id, at))).collect();
    let unknown = truth.names().len() - found.len();
    (found, unknown)
}

fn rulers(
    index: &MapIndex,
    distances: &[KnownDistance],
) -> Result<Vec<(LandmarkId, LandmarkId, f64)>, PlanError> {
    let ruler = |known: &KnownDistance| {
        let KnownDistance { from, to, distance } = known;
        let (a, b) = (index.id(from)?, index.id(to)?);
        index.check_different(&[a, b])?;
        index.check_together(a, b)?;
        if !(distance.is_finite() && *distance > 0.0) {
            return Err(PlanError::BadDistance { from: from.clone(), to: to.clone(), distance: *distance });
        }
        Ok((a, b, *distance))
    };
    distances.iter().map(ruler).collect()
}

/// Triples that are known to turn left, and how they turn on the map.
fn turns(index: &MapIndex, left_turns: &[[String; 3]]) -> Result<Vec<([LandmarkId; 3], Turn)>, PlanError> {
    let turn = |ids: &[String; 3]| {
        let [a, b, c] = ids;
        let found = index.orientation(a, b, c)?;
        if found.probability < SURE_TURN {
            return Err(PlanError::UncertainTurn { ids: ids.clone(), probability: found.probability });
        }
        Ok(([index.id(a)?, index.id(b)?, index.id(c)?], found.orientation))
    };
    left_turns.iter().map(turn).collect()
}

fn contradicted(index: &MapIndex, ids: &[LandmarkId; 3]) -> PlanError {
    PlanError::TurnContradicted { ids: ids.map(|id| index.name(id).to_owned()) }
}

fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests;
