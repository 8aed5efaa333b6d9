//! String IDs in, dense numbers out.

use hashbrown::HashTable;
use rustc_hash::FxHasher;
use std::hash::Hasher;

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
