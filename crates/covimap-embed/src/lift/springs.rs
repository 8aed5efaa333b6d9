//! What pulls at each object.

use crate::PairDistances;
use crate::stress::Incidence;

/// The springs of object `i` are `springs[starts[i]..starts[i + 1]]`, ascending.
pub(super) struct Springs {
    starts: Vec<usize>,
    springs: Vec<Spring>,
}

/// Length and weight need not be more precise: a lift ends near a minimum only, and passes over all springs take as long
/// as reading them does.
#[derive(Clone, Copy)]
pub(super) struct Spring {
    /// The object at the other end.
    pub to: u32,
    pub length: f32,
    pub weight: f32,
}

impl Springs {
    /// Of objects that nothing pulls at.
    pub fn none(objects: usize) -> Self {
        Self { starts: vec![0; objects + 1], springs: Vec::new() }
    }

    /// Of a pair list.
    pub fn of_pairs(pairs: &PairDistances) -> Self {
        let incidence = Incidence::new(pairs);
        let row = |own| {
            let spring = |&(to, pair): &(u32, u32)| {
                let pair = pairs.pairs()[pair as usize];
                Spring { to, length: pair.distance as f32, weight: pair.weight as f32 }
            };
            incidence.of(own).iter().map(spring)
        };
        Self::of_rows(2 * pairs.pairs().len(), (0..pairs.objects()).map(row))
    }

    /// Of a row an object, with so many springs in all.
    pub fn of_rows(springs: usize, rows: impl Iterator<Item = impl IntoIterator<Item = Spring>>) -> Self {
        let mut all = Self { starts: vec![0], springs: Vec::with_capacity(springs) };
        for row in rows {
            all.springs.extend(row);
            all.starts.push(all.springs.len());
        }
        all
    }

    #[inline(always)]
    pub fn of(&self, object: usize) -> &[Spring] {
        &self.springs[self.starts[object]..self.starts[object + 1]]
    }
}
