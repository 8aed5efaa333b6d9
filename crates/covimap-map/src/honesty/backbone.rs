//! The backbone: a few links of every landmark that no recognition error can have made.
//!
//! Landmark i keeps its `m_i` strongest partners, by `n_ij^2 / (n_i n_j)`, among those with which it
//! was seen together too often for chance. Twice as many as it is usually seen with, `m_i = 2 k_i`,
//! reach about as far as one look does, however dense the landmarks stand. A false link does not
//! get there: a landmark is misread for another now and then, but seen with its neighbours always.

use rayon::prelude::*;

use super::poisson::Significance;
use crate::{CoVisibility, LandmarkId};

/// Expected number of chance links among all that are called too strong for chance.
const CHANCE_LINKS: f64 = 0.05;
/// Fewest partners looked for: a place in the plane is held by about so many.
const FEWEST: usize = 8;

/// A list of landmarks for every landmark.
pub(super) struct Lists {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    fn new(lists: Vec<Vec<u32>>) -> Self {
        let mut starts = vec![0];
        starts.extend(lists.iter().scan(0, |end, list| {
            *end += list.len();
            Some(*end)
        }));
        Self { starts, items: lists.into_iter().flatten().collect() }
    }

    pub fn of(&self, landmark: u32) -> &[u32] {
        &self.items[self.starts[landmark as usize]..self.starts[landmark as usize + 1]]
    }

    /// Who has landmark i in its list, ascending.
    fn transposed(&self) -> Self {
        let n = self.starts.len() - 1;
        let mut starts = vec![0; n + 1];
        for &item in &self.items {
            starts[item as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let (mut items, mut next) = (vec![0; self.items.len()], starts.clone());
        for i in 0..n as u32 {
            for &item in self.of(i) {
                items[next[item as usize]] = i;
                next[item as usize] += 1;
            }
        }
        Self { starts, items }
    }
}

/// The backbone of a log. Two landmarks are neighbours in it if one is in the list of the other.
pub(super) struct Backbone {
    /// The strongest partners of each landmark.
    pub partners: Lists,
    /// Whose strongest partner each landmark is.
    pub partner_of: Lists,
    /// Connected part of each landmark.
    pub part: Vec<u32>,
    pub parts: Vec<Part>,
}

/// A connected part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Part {
    pub landmarks: u64,
    /// Sum of their `n_i`.
    pub sightings: u64,
}

impl Backbone {
    /// `chance` is an upper bound of the error rate as [`super::error_rate`] has it: two landmarks
    /// are seen together by chance `chance (n_i + n_j)` times.
    ///
    /// `O(m log k)` for `m` links, in parallel by rows.
    pub fn new(counts: &CoVisibility, chance: f64) -> Self {
        let n = counts.landmarks();
        let pairs = n as f64 * (n as f64 - 1.0) / 2.0;
        let significance = Significance::new((CHANCE_LINKS / pairs).ln());
        let strongest = |i: u32| strongest(counts, LandmarkId(i), chance, &significance);
        let partners = Lists::new((0..n as u32).into_par_iter().map(strongest).collect());
        let mut backbone =
            Self { partner_of: partners.transposed(), partners, part: Vec::new(), parts: Vec::new() };
        backbone.find_parts(counts.sightings());
        backbone
    }

    /// Neighbours in the backbone; those in both lists come twice.
    pub fn neighbours(&self, landmark: u32) -> impl Iterator<Item = u32> {
        self.partners.of(landmark).iter().chain(self.partner_of.of(landmark)).copied()
    }

    fn find_parts(&mut self, sightings: &[u32]) {
        const NONE: u32 = u32::MAX;
        let mut part = vec![NONE; sightings.len()];
        let mut parts = Vec::new();
        for first in 0..sightings.len() as u32 {
            if part[first as usize] != NONE {
                continue;
            }
            let number = parts.len() as u32;
            let mut found = Part::default();
            let mut open = vec![first];
            part[first as usize] = number;
            while let Some(landmark) = open.pop() {
                found.landmarks += 1;
                found.sightings += u64::from(sightings[landmark as usize]);
                for next in self.neighbours(landmark) {
                    if std::mem::replace(&mut part[next as usize], number) == NONE {
                        open.push(next);
                    }
                }
            }
            parts.push(found);
        }
        (self.part, self.parts) = (part, parts);
    }
}

/// The strongest partners of a landmark, ascending; of equal ones the first.
fn strongest(counts: &CoVisibility, id: LandmarkId, chance: f64, significance: &Significance) -> Vec<u32> {
    let (partners, together) = counts.row(id);
    let sightings = |j: u32| f64::from(counts.sightings()[j as usize]);
    let own = sightings(id.0);
    let sum: u64 = together.iter().map(|&both| u64::from(both)).sum();
    let wanted = FEWEST.max((2.0 * sum as f64 / own).ceil() as usize);
    let strength = |(&to, &both): (&u32, &u32)| {
        let others = sightings(to);
        let strong = significance.is_too_high(both, chance * (own + others));
        strong.then(|| (f64::from(both) * f64::from(both) / others, to))
    };
    let mut strong: Vec<(f64, u32)> = partners.iter().zip(together).filter_map(strength).collect();
    if strong.len() > wanted {
        strong.select_nth_unstable_by(wanted, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        strong.truncate(wanted);
    }
    let mut strongest: Vec<u32> = strong.into_iter().map(|(_, to)| to).collect();
    strongest.sort_unstable();
    strongest
}
