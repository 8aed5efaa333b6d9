//! Landmarks by their string IDs, and what a mistyped ID may have meant.

use std::hash::{BuildHasher, BuildHasherDefault};

use covimap_map::{LandmarkId, LandmarkNames};
use hashbrown::HashTable;
use rayon::prelude::*;
use rustc_hash::FxHasher;

use crate::{MapIndex, PlanError};

/// What names a landmark: its string ID, or its number.
pub trait LandmarkRef {
    /// The number that the landmark has in this map. `O(1)`, or `O(n)` for an ID that is not in the map.
    ///
    /// # Errors
    /// [`PlanError::UnknownLandmark`] for an ID that the map does not have, with the most similar one;
    /// [`PlanError::UnknownNumber`] for a number past the last.
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError>;
}

impl LandmarkRef for LandmarkId {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        let landmarks = index.map().len();
        if self.index() < landmarks {
            Ok(*self)
        } else {
            Err(PlanError::UnknownNumber { number: self.0, landmarks })
        }
    }
}

impl LandmarkRef for str {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        index.lookup(self).ok_or_else(|| PlanError::UnknownLandmark {
            id: self.to_owned(),
            nearest: most_similar(index.map().names(), self).map(str::to_owned),
        })
    }
}

impl LandmarkRef for String {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        self.as_str().find_in(index)
    }
}

impl<T: LandmarkRef + ?Sized> LandmarkRef for &T {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        (**self).find_in(index)
    }
}

/// The numbers of landmarks, found by their names. Holds no text of its own.
#[derive(Debug, Clone)]
pub(crate) struct NameTable {
    numbers: HashTable<u32>,
}

impl NameTable {
    /// In `O(n)` for `n` names, all different.
    pub fn new(names: &LandmarkNames) -> Self {
        let mut numbers = HashTable::with_capacity(names.len());
        for (number, name) in (0..).zip(names.iter()) {
            numbers.insert_unique(hash(name), number, |&other| hash(names.name(LandmarkId(other))));
        }
        Self { numbers }
    }

    /// The landmark of that name, in `O(1)`.
    pub fn find(&self, names: &LandmarkNames, name: &str) -> Option<LandmarkId> {
        let same = |&number: &u32| names.name(LandmarkId(number)) == name;
        self.numbers.find(hash(name), same).map(|&number| LandmarkId(number))
    }
}

fn hash(name: &str) -> u64 {
    BuildHasherDefault::<FxHasher>::default().hash_one(name)
}

/// The name that takes the fewest edits (insert, delete, replace, swap neighbours) to become `wanted`,
/// the first one among equals; none if it takes more than a third of the letters.
///
/// `O(n)` comparisons.
pub(crate) fn most_similar<'a>(names: &'a LandmarkNames, wanted: &str) -> Option<&'a str> {
    let letters = wanted.chars().count();
    let most = (letters / 3).max(1);
    (0..names.len() as u32)
        .into_par_iter()
        .map(|number| names.name(LandmarkId(number)))
        .filter(|name| name.chars().count().abs_diff(letters) <= most)
        .map(|name| (strsim::osa_distance(name, wanted), name))
        .filter(|&(edits, name)| edits <= most && edits < name.chars().count().max(letters))
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_and_no_other() {
        let names: LandmarkNames = ["shelf-1", "shelf-2", "", "door"].into_iter().collect();
        let table = NameTable::new(&names);
        for (number, name) in (0..).zip(names.iter()) {
            assert_eq!(table.find(&names, name), Some(LandmarkId(number)));
        }
        assert_eq!(table.find(&names, "shelf"), None);
        let none = LandmarkNames::default();
        assert_eq!(NameTable::new(&none).find(&none, ""), None);
    }

    #[test]
    fn a_mistyped_name_finds_its_nearest() {
        let names: LandmarkNames = ["shelf-1", "shelf-2", "door", "A", "B"].into_iter().collect();
        assert_eq!(most_similar(&names, "shlef-2"), Some("shelf-2"));
        // As near to shelf-1 as to shelf-2: the first.
        assert_eq!(most_similar(&names, "shelf-3"), Some("shelf-1"));
        assert_eq!(most_similar(&names, "dorr"), Some("door"));
        // One letter replaced by another is a different name, not a similar one.
        assert_eq!(most_similar(&names, "C"), None);
        assert_eq!(most_similar(&names, "window"), None);
        assert_eq!(most_similar(&LandmarkNames::default(), "A"), None);
    }
}
