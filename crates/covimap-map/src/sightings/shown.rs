//! What lines of a log show, before IDs become numbers.

use std::borrow::Cow;

/// What lines show.
#[derive(Debug, Default)]
pub(super) struct Shown<'a> {
    pub ids: Vec<Cow<'a, str>>,
    /// Place in `ids` and metres of every range.
    pub ranges: Vec<(usize, f64)>,
}

impl Shown<'_> {
    /// Takes back all but the first IDs.
    pub fn truncate(&mut self, ids: usize) {
        self.ids.truncate(ids);
        self.ranges.retain(|range| range.0 < ids);
    }
}
