//! How landmarks lie to each other, in words: left or right, next to, in which order around a place.
//!
//! These relations are what a map from co-visibility tells best: they need no metre and survive a good
//! deal of distortion (sections II-B and IV of the paper).
//!
//! The turn of a triple is the sign of `s = (b - a) x (c - a)`, twice the area of the triangle. With positions
//! that are uncertain by the covariances of [`MapIndex::covariance`], independent of each other, `s` has to first
//! order the variance
//!
//! ```text
//! v = (1 + L / 4 u) (g_a' C_a g_a + g_b' C_b g_b + g_c' C_c g_c),
//! g_a = J (c - b), g_b = J (a - c), g_c = J (b - a),
//! ```
//!
//! `J` being a quarter turn and the first factor the bending of the map over the longest side L, `u` the
//! length of a map unit. The sign of `s` is right with the probability `Phi(|s| / sqrt(v))`.
//!
//! **A map may be a mirror image**, in which left and right are exchanged all over, unless its
//! handedness is known from outside ([`MapIndex::is_handed`]). Order around a place is then told in the
//! other sense of rotation; the probability is about the map as it stands.

use std::f64::consts::TAU;

use covimap_embed::Point;
use covimap_map::LandmarkId;
use serde::Serialize;

use crate::index::each;
use crate::{LandmarkRef, MapIndex, PlanError};

/// Directions that differ by less are the same, in radians.
const SAME_DIRECTION: f64 = 1e-12;

/// The way a triple turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Turn {
    /// Counter-clockwise in the map.
    Left,
    /// Clockwise in the map.
    Right,
}

/// On which side of the line from a to b landmark c is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Orientation {
    /// Left when a, b, c turn counter-clockwise in the map; also when they are in line.
    pub orientation: Turn,
    /// How likely that is, in `[0.5, 1]`: 0.5 in line.
    pub probability: f64,
}

impl MapIndex {
    /// On which side of the line from `a` to `b` landmark `c` is, and how certain that is.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`]; [`PlanError::Repeated`] unless the three differ; [`PlanError::Apart`] unless
    /// they are of one component.
    pub fn orientation(
        &self,
        a: impl LandmarkRef,
        b: impl LandmarkRef,
        c: impl LandmarkRef,
    ) -> Result<Orientation, PlanError> {
        let ids = [self.id(a)?, self.id(b)?, self.id(c)?];
        self.check_different(&ids)?;
        let [a, b, c] = ids;
        self.check_together(a, b)?;
        self.check_together(a, c)?;
        Ok(self.turn(ids))
    }

    /// [`MapIndex::orientation`] of many triples, on all threads.
    ///
    /// # Errors
    /// Those of the first triple that has some.
    pub fn orientation_of_each<L>(&self, triples: &[[L; 3]]) -> Result<Vec<Orientation>, PlanError>
    where
        L: LandmarkRef + Sync,
    {
        // Once, before all threads ask for it.
        self.confidence();
        each(triples, |[a, b, c]| self.orientation(a, b, c))
    }

    /// On which side of the line from `a` to `b` each of `others` is.
    ///
    /// # Errors
    /// Those of [`MapIndex::orientation`].
    pub fn sides<L>(
        &self,
        a: impl LandmarkRef,
        b: impl LandmarkRef,
        others: &[L],
    ) -> Result<Vec<Orientation>, PlanError>
    where
        L: LandmarkRef + Sync,
    {
        let [a, b] = [self.id(a)?, self.id(b)?];
        self.confidence();
        each(others, |other| self.orientation(a, b, other))
    }

    /// Whether two landmarks share a Delaunay edge: no third one lies between them.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`]; [`PlanError::Repeated`] for a landmark and itself. Landmarks of different
    /// components are not next to each other as far as the map knows.
    pub fn is_next_to(&self, a: impl LandmarkRef, b: impl LandmarkRef) -> Result<bool, PlanError> {
        let ids = [self.id(a)?, self.id(b)?];
        self.check_different(&ids)?;
        Ok(self.neighbours(ids[0])?.binary_search(&ids[1]).is_ok())
    }

    /// Landmarks in the order in which they are seen from the place of a landmark, turning left; the first of
    /// `others` stays the first. Those in one direction come nearest first.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`]; [`PlanError::Apart`] for a landmark of another component,
    /// [`PlanError::NoDirection`] for one at the very place.
    pub fn cyclic_order<L>(&self, from: impl LandmarkRef, others: &[L]) -> Result<Vec<LandmarkId>, PlanError>
    where
        L: LandmarkRef,
    {
        let from = self.id(from)?;
        let placed = self.placed(from);
        self.cyclic_order_at(placed.component, placed.position, others)
    }

    /// Landmarks in the order in which they are seen from a place, as [`MapIndex::cyclic_order`].
    ///
    /// # Errors
    /// As [`MapIndex::cyclic_order`]; [`PlanError::UnknownComponent`], [`PlanError::Nowhere`].
    pub fn cyclic_order_at<L>(
        &self,
        component: u32,
        place: Point,
        others: &[L],
    ) -> Result<Vec<LandmarkId>, PlanError>
    where
        L: LandmarkRef,
    {
        // Knows the component and the place.
        self.nearest_to(component, place, 0)?;
        let mut seen = Vec::with_capacity(others.len());
        let mut first = None;
        for other in others {
            let id = self.id(other)?;
            let placed = self.placed(id);
            if placed.component != component {
                let members = self.component(component)?;
                self.check_together(members[0], id)?;
            }
            let [dx, dy] = [placed.position[0] - place[0], placed.position[1] - place[1]];
            if dx == 0.0 && dy == 0.0 {
                return Err(PlanError::NoDirection { id: self.name(id).to_owned() });
            }
            let direction = dy.atan2(dx);
            let from_first = direction - *first.get_or_insert(direction);
            // What is in one direction but for rounding turns by nothing, not by nearly a whole turn.
            let turned = if from_first.abs() < SAME_DIRECTION { 0.0 } else { from_first.rem_euclid(TAU) };
            let turned = if TAU - turned < SAME_DIRECTION { 0.0 } else { turned };
            seen.push((turned, dx.hypot(dy), id));
        }
        // The sorts are stable, so that of several in one direction and distance the order stays.
        if let Some((_, others)) = seen.split_first_mut() {
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            for same in others.chunk_by_mut(|a, b| b.0 - a.0 < SAME_DIRECTION) {
                same.sort_by(|a, b| a.1.total_cmp(&b.1));
            }
        }
        Ok(seen.into_iter().map(|(_, _, id)| id).collect())
    }

    /// Whether a component is known not to be a mirror image, so that its left is left.
    #[must_use]
    pub fn is_handed(&self, component: u32) -> bool {
        self.map().alignment().iter().any(|fit| fit.component == component && fit.handed)
    }

    fn turn(&self, ids: [LandmarkId; 3]) -> Orientation {
        let position = |id: LandmarkId| self.placed(id).position;
        let [a, b, c] = ids.map(position);
        // In one order always, so that triples nearly in line turn the same way from whichever landmark one begins.
        let mut ascending = ids;
        ascending.sort_unstable();
        let is_even = (0..3).any(|k| [ids[k], ids[(k + 1) % 3], ids[(k + 2) % 3]] == ascending);
        let [first, second, third] = ascending.map(position);
        let area = doubled_area(first, second, third) * if is_even { 1.0 } else { -1.0 };
        let gradients = [(b, c), (c, a), (a, b)].map(|(p, q)| [p[1] - q[1], q[0] - p[0]]);
        let independent: f64 =
            ids.iter().zip(gradients).map(|(&id, gradient)| self.covariance_of(id).along(gradient)).sum();
        let reach = gradients.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
        let variance = independent * self.growth(self.placed(ids[0]).component, reach);
        Orientation {
            orientation: if area < 0.0 { Turn::Right } else { Turn::Left },
            probability: sign_is_right(area.abs(), variance),
        }
    }

    pub(crate) fn check_different(&self, ids: &[LandmarkId]) -> Result<(), PlanError> {
        for (place, id) in ids.iter().enumerate() {
            if ids[..place].contains(id) {
                return Err(PlanError::Repeated { id: self.name(*id).to_owned() });
            }
        }
        Ok(())
    }
}

/// `(b - a) x (c - a)`: above 0 when a, b, c turn left.
pub(crate) fn doubled_area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// How likely a normal value of this size and variance has the right sign.
fn sign_is_right(size: f64, variance: f64) -> f64 {
    if variance > 0.0 { 0.5 * libm::erfc(-size / (2.0 * variance).sqrt()) } else { 0.5 }
}

#[cfg(test)]
mod tests;
