//! Steering by what is seen: on to what came into sight last as long as it is news, and straight on where nothing is.
//!
//! A robot that goes straight on until something is in its way is a good explorer of open floors, but a slow one at the start:
//! it turns back into ground that it has just crossed while new ground lies beside it. So it is sent to news, and left to
//! wander else. At look t a landmark that was last seen in look l comes as news if it was never seen, or if
//!
//! `t - l >= max(100, t / 2)`,  (3)
//!
//! and stays news for three looks. Of the news in sight the robot heads for that which came last: it stands at the far edge
//! of what is in sight, so that the way is straight, and leads on as long as new ground lies ahead. Three looks are less
//! than the way to the landmark: the robot turns away before it is in the corner, where looks gain least.
//!
//! As the log grows, news become rare and the robot wanders: on ground that is known there is nothing better. What was seen
//! long ago is news again, so that far parts of a large floor are not forgotten.
//!
//! No map is needed, and no knowledge of where the robot is: it must be able to turn towards a landmark that it sees, no
//! more. What else was tried is told in `docs/maths/exploration.md`.

use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Looks for which a landmark is news.
const NEWS: u64 = 3;
/// Looks out of sight that make a landmark news again, at least.
const AWAY: u64 = 100;

/// What is remembered of a landmark.
#[derive(Debug, Clone, Default)]
struct Memory {
    /// The last look that showed it, counted from 1; 0 for none.
    last: u64,
    /// The look in which it came as news.
    came: u64,
    /// Looks that have shown it since.
    shown: u64,
}

/// Sends a wandering robot to where there is something new to see.
///
/// ```
/// use covimap_plan::Explorer;
///
/// let mut explorer = Explorer::default();
/// assert_eq!(explorer.next(["door"]), Some("door"));
/// // The lamp came into sight later.
/// assert_eq!(explorer.next(["door", "lamp"]), Some("lamp"));
/// assert_eq!(explorer.next([]), None);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Explorer {
    looks: u64,
    known: BTreeMap<String, Memory>,
}

impl Explorer {
    /// Takes in a look: the landmark of it towards which to go, or `None` to wander on. Of landmarks that came into sight
    /// together the one that was seen in fewer looks since is chosen, then the first by its ID. An ID that is given twice
    /// counts once. `O(m log n)` for m landmarks in sight of n known.
    pub fn next<'a>(&mut self, seen: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
        self.looks += 1;
        let mut newest = None;
        for id in seen {
            let memory = self.remember(id);
            if memory.shown <= NEWS {
                newest = newest.max(Some((memory.came, Reverse(memory.shown), Reverse(id))));
            }
        }
        newest.map(|(_, _, Reverse(id))| id)
    }

    /// What is known of a landmark, this look included.
    fn remember(&mut self, id: &str) -> &Memory {
        if !self.known.contains_key(id) {
            self.known.insert(id.to_owned(), Memory::default());
        }
        let memory = self.known.get_mut(id).expect("it was put there (bug in covimap)");
        if memory.last == self.looks {
            return memory;
        }
        let away = self.looks - memory.last;
        // Eq. (3).
        if memory.last == 0 || (away >= AWAY && 2 * away >= self.looks) {
            *memory = Memory { came: self.looks, ..Memory::default() };
        }
        memory.last = self.looks;
        memory.shown += 1;
        memory
    }
}
