//! What an update did to a map.

use serde::{Deserialize, Serialize};

/// What was new, and how much of the map was solved again for it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct UpdateReport {
    /// Steps that were new.
    pub steps: u64,
    /// Landmarks that were new.
    pub landmarks: u64,
    /// Landmarks that were solved again, the new ones among them; the others kept their places.
    pub solved: u64,
    /// Charts that new steps joined to others, and that were carried into the frames of those.
    pub carried: u64,
    /// Why everything was solved again and the result laid onto the old map, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole: Option<String>,
}
