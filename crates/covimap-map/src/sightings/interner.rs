//! String IDs in, dense numbers out.

use std::borrow::Cow;
use std::hash::Hasher;

use hashbrown::HashTable;
use rustc_hash::FxHasher;

use crate::{LandmarkId, LandmarkNames};

/// Numbers strings in the order of their first appearance.
///
/// The strings lie in one piece of memory; the table holds 8 bytes an entry. Its order is never
/// looked at, so the numbers depend on the input alone.
#[derive(Debug, Default)]
pub(super) struct Interner {
    names: LandmarkNames,
    table: HashTable<Slot>,
}

/// The hash is kept so that growing the table and most failed comparisons touch no string.
#[derive(Debug, Clone, Copy)]
struct Slot {
    hash: NameHash,
    number: u32,
}

/// 32 bits of a string's hash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NameHash(u32);

impl NameHash {
    pub(super) fn of(name: &str) -> Self {
        let mut hasher = FxHasher::default();
        hasher.write(name.as_bytes());
        let hash = hasher.finish();
        #[expect(clippy::cast_possible_truncation, reason = "folding 64 bits into 32")]
        Self((hash ^ (hash >> 32)) as u32)
    }

    /// The table takes its bucket from the low bits and its tag from the high ones.
    fn spread(self) -> u64 {
        u64::from(self.0) | u64::from(self.0) << 32
    }
}

impl Interner {
    pub(super) fn len(&self) -> u32 {
        u32::try_from(self.names.len()).expect("fewer than 2^32 names (bug in covimap)")
    }

    pub(super) fn names(&self) -> &LandmarkNames {
        &self.names
    }

    pub(super) fn into_names(self) -> LandmarkNames {
        self.names
    }

    /// The number of a string, if it has one.
    pub(super) fn find(&self, hash: NameHash, name: &str) -> Option<u32> {
        let is_it = |slot: &Slot| slot.hash == hash && self.names.name(LandmarkId(slot.number)) == name;
        self.table.find(hash.spread(), is_it).map(|slot| slot.number)
    }

    /// The numbers of several strings, `None` for a string that has none.
    ///
    /// Among a million strings, look-ups wait for memory. All visits to the table come first and
    /// all comparisons after them, so that these waits overlap.
    pub(super) fn find_all<'s>(
        &'s self,
        hashes: &'s [NameHash],
        names: &'s [Cow<'_, str>],
    ) -> impl Iterator<Item = Option<u32>> + 's {
        let same_hash = |&hash: &NameHash| {
            let slot = self.table.find(hash.spread(), |slot| slot.hash == hash);
            slot.map(|slot| slot.number)
        };
        let candidates: Vec<_> = hashes.iter().map(same_hash).collect();
        candidates.into_iter().zip(hashes).zip(names).map(|((candidate, &hash), name)| {
            let is_it = self.names.name(LandmarkId(candidate?)) == name;
            if is_it { candidate } else { self.find(hash, name) }
        })
    }

    /// The number of a string; a new string gets the next one.
    pub(super) fn intern(&mut self, hash: NameHash, name: &str) -> u32 {
        if let Some(number) = self.find(hash, name) {
            return number;
        }
        let number = self.names.push(name).0;
        self.table.insert_unique(hash.spread(), Slot { hash, number }, |slot| slot.hash.spread());
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_numbered_in_order_and_found_again() {
        let mut interner = Interner::default();
        let names: Vec<String> = (0..5000).map(|i| format!("name {}", i * i % 3001)).collect();
        let mut expected: Vec<&str> = Vec::new();
        for name in &names {
            let number = interner.intern(NameHash::of(name), name);
            if number as usize == expected.len() {
                expected.push(name);
            }
            assert_eq!(expected[number as usize], name);
        }
        assert_eq!(interner.names().iter().collect::<Vec<_>>(), expected);
        assert_eq!(interner.find(NameHash::of("name"), "name"), None);
    }

    #[test]
    fn strings_of_the_same_hash_are_kept_apart() {
        let hash = NameHash(7);
        let mut interner = Interner::default();
        assert_eq!(interner.intern(hash, "A"), 0);
        assert_eq!(interner.intern(hash, "B"), 1);
        assert_eq!(interner.intern(hash, "A"), 0);
        let names = ["B", "C", "A"].map(Cow::Borrowed);
        let found: Vec<_> = interner.find_all(&[hash; 3], &names).collect();
        assert_eq!(found, [Some(1), None, Some(0)]);
    }
}
