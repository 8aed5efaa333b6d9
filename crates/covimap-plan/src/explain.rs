//! What holds a landmark in its place, and what would help.

use covimap_map::LandmarkId;
use serde::Serialize;

use crate::confidence::{frequency, length};
use crate::{LandmarkRef, MapIndex, PlanError};

/// A landmark this many times less certain than the median of its component is told to be loose.
const LOOSE: f64 = 2.0;

/// Neighbours named in an advice at most.
const MOST_NAMED: usize = 5;

/// A line of sight that holds a landmark.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hold {
    /// String ID of the other landmark.
    pub id: String,
    /// Steps that show both.
    pub steps: u32,
    /// The share of the steps that show either which show both, drawn a little from 0 and 1.
    pub frequency: f64,
    /// How far the other is, in units of the map.
    pub distance: f64,
    /// Whether the other is of another region: then the line is part of a seam.
    pub seam: bool,
}

/// Something that would make a position more certain.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Advice {
    /// Stable name: `never_together`, `seen_once`, `few_partners`, `loose` or `unseen_neighbours`.
    pub kind: &'static str,
    /// What is the matter and what to do.
    pub message: String,
}

/// What holds a landmark in its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// String ID.
    pub id: String,
    /// Component, and how many landmarks it has.
    pub component: u32,
    /// Landmarks of the component.
    pub component_landmarks: usize,
    /// Region of which it is a core member.
    pub region: u32,
    /// Core members of the region.
    pub region_landmarks: usize,
    /// Steps that show it.
    pub sightings: u32,
    /// Other landmarks it was seen together with.
    pub partners: u32,
    /// Standard deviation against its surroundings, root mean square over the directions, in units of the map.
    pub deviation: f64,
    /// Standard deviations along the principal axes, the greater first.
    pub axes: [f64; 2],
    /// Direction of the first axis, in degrees from the x axis.
    pub direction: f64,
    /// Median of the deviations of the component.
    pub typical_deviation: f64,
    /// Its lines of sight, those of greatest frequency first.
    pub holds: Vec<Hold>,
    /// What would help; nothing if it is held as well as others.
    pub advice: Vec<Advice>,
}

/// Explains the place of a landmark. `O(n log n)` the first time, for the Delaunay graph.
///
/// # Errors
/// Those of [`MapIndex::id`].
pub fn explain(index: &MapIndex, landmark: impl LandmarkRef) -> Result<Explanation, PlanError> {
    let id = index.id(landmark)?;
    let placed = index.placed(id);
    let covariance = index.covariance_of(id);
    let (major, minor, direction) = covariance.axes();
    let members = index.component(placed.component)?;
    let mut explanation = Explanation {
        id: index.name(id).to_owned(),
        component: placed.component,
        component_landmarks: members.len(),
        region: placed.region,
        region_landmarks: index.region(placed.region).len(),
        sightings: placed.sightings,
        partners: placed.partners,
        deviation: covariance.deviation(),
        axes: [major, minor],
        direction: direction.to_degrees(),
        typical_deviation: typical_deviation(index, members),
        holds: holds(index, id),
        advice: Vec::new(),
    };
    explanation.advice = advice(index, id, &explanation)?;
    Ok(explanation)
}

/// Median of the standard deviations of these landmarks.
pub(crate) fn typical_deviation(index: &MapIndex, members: &[LandmarkId]) -> f64 {
    let mut deviations: Vec<f64> = members.iter().map(|&id| index.covariance_of(id).deviation()).collect();
    let middle = deviations.len() / 2;
    *deviations.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn holds(index: &MapIndex, id: LandmarkId) -> Vec<Hold> {
    let map = index.map();
    let hold = |line: &covimap_map::SightLine| Hold {
        id: index.name(line.to).to_owned(),
        steps: line.steps,
        frequency: frequency(map, id, line),
        distance: length(map, id, line.to),
        seam: index.placed(line.to).region != index.placed(id).region,
    };
    let mut holds: Vec<Hold> = map.sight_lines().of(id).iter().map(hold).collect();
    holds.sort_by(|a, b| b.frequency.total_cmp(&a.frequency));
    holds
}

fn advice(index: &MapIndex, id: LandmarkId, found: &Explanation) -> Result<Vec<Advice>, PlanError> {
    let mut advice = Vec::new();
    let mut say = |kind, message| advice.push(Advice { kind, message });
    if found.partners == 0 {
        say(
            "never_together",
            "never seen with another landmark, so its place means nothing; look when others are in view"
                .to_owned(),
        );
        return Ok(advice);
    }
    if found.sightings == 1 {
        say("seen_once", "a single look cannot tell near from far; look again from other places".to_owned());
    }
    if found.partners < 3 {
        let message = format!(
            "seen with {} other landmarks only, which leaves it two places or more; look when a third is in view",
            found.partners
        );
        say("few_partners", message);
    }
    if found.deviation > LOOSE * found.typical_deviation {
        let message = format!(
            "{:.1} times as uncertain as the median, most of all along {:.0} degrees; look from places that way",
            found.deviation / found.typical_deviation,
            found.direction
        );
        say("loose", message);
    }
    let lines = index.map().sight_lines();
    let is_seen = |other: &LandmarkId| lines.of(id).binary_search_by_key(other, |line| line.to).is_ok();
    let unseen = index.neighbours(id)?.iter().filter(|other| !is_seen(other));
    let names: Vec<&str> = unseen.map(|&other| index.name(other)).collect();
    if lines.count() > 0 && !names.is_empty() {
        let (named, more) = names.split_at(names.len().min(MOST_NAMED));
        let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
        let message = format!(
            "never seen with its neighbours {}{more}: a wall may be between; if there is none, look at both",
            named.join(", ")
        );
        say("unseen_neighbours", message);
    }
    Ok(advice)
}

#[cfg(test)]
mod tests;
