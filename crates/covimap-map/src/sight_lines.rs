//! Lines of sight: which neighbours on the map were seen together, and how often.
//!
//! Two landmarks that a robot saw in one look have no wall between them and the robot. Two that are
//! next to each other on the map and were never seen together may well have one. A way through the
//! map should therefore go from landmark to landmark along *lines of sight*:
//!
//! - the Delaunay edges of a component whose two ends were seen together, and
//! - where these leave a component in pieces, the links of greatest co-visibility between the pieces
//!   (a minimum spanning forest), so that all landmarks of a component are joined.
//!
//! The rest of the links is not kept: a map of `n` landmarks has less than `3 n` lines of sight,
//! and often 20 times as many links.

use covimap_embed::Point;
use petgraph::unionfind::UnionFind;

use crate::{CoVisibility, LandmarkId, LinkGraph, MapError, PlacedLandmark, delaunay_edges};

/// One end of a line of sight, as stored in the row of the other end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SightLine {
    /// The landmark at the other end.
    pub to: LandmarkId,
    /// Steps that show both, `n_ij >= 1`.
    pub steps: u32,
}

/// The lines of sight of a map, one ascending row a landmark. Empty for a map that does not know them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SightLines {
    /// Row i is `lines[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    lines: Vec<SightLine>,
}

impl SightLines {
    /// From every pair once, in any order, with the number of steps that show both. `O(n + m log m)` for `m`
    /// pairs of `n` landmarks.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] when a pair names a landmark beyond the last, names one twice, stands
    /// there twice, or counts no step.
    pub fn from_pairs(
        landmarks: usize,
        pairs: impl IntoIterator<Item = (LandmarkId, LandmarkId, u32)>,
    ) -> Result<Self, MapError> {
        let mut ends = Vec::new();
        for (a, b, steps) in pairs {
            if a == b || a.index().max(b.index()) >= landmarks || steps == 0 {
                return invalid(a, b, &format!("has {steps} steps among {landmarks} landmarks"));
            }
            ends.extend([(a, SightLine { to: b, steps }), (b, SightLine { to: a, steps })]);
        }
        if ends.is_empty() {
            return Ok(Self::default());
        }
        ends.sort_unstable_by_key(|(from, line)| (*from, line.to));
        if let Some(twice) = ends.windows(2).find(|two| (two[0].0, two[0].1.to) == (two[1].0, two[1].1.to)) {
            return invalid(twice[0].0, twice[0].1.to, "stands there twice");
        }
        let mut starts = vec![0; landmarks + 1];
        for (from, _) in &ends {
            starts[from.index() + 1] += 1;
        }
        for i in 0..landmarks {
            starts[i + 1] += starts[i];
        }
        Ok(Self { starts, lines: ends.into_iter().map(|(_, line)| line).collect() })
    }

    /// Number of lines of sight.
    #[must_use]
    pub fn count(&self) -> usize {
        self.lines.len() / 2
    }

    /// The lines of sight of one landmark, ascending; none in a map that does not know them.
    #[must_use]
    pub fn of(&self, landmark: LandmarkId) -> &[SightLine] {
        &self.lines[self.row(landmark)]
    }

    /// Where the lines of a landmark stand in a list of those of all landmarks, one landmark after the other: each line of sight is
    /// in it twice.
    #[must_use]
    pub fn row(&self, landmark: LandmarkId) -> std::ops::Range<usize> {
        match self.starts.get(landmark.index()..landmark.index() + 2) {
            Some(ends) => ends[0] as usize..ends[1] as usize,
            None => 0..0,
        }
    }

    /// Every line of sight once, `(a, b, n_ab)` with `a < b`, ascending.
    pub fn pairs(&self) -> impl Iterator<Item = (LandmarkId, LandmarkId, u32)> {
        (0..self.starts.len().saturating_sub(1) as u32).map(LandmarkId).flat_map(|from| {
            self.of(from)
                .iter()
                .filter(move |line| line.to > from)
                .map(move |line| (from, line.to, line.steps))
        })
    }

    /// Whether the lines agree with what the landmarks say: one component, and no more steps than show
    /// either end.
    pub(crate) fn check(&self, landmarks: &[PlacedLandmark]) -> Result<(), MapError> {
        if !self.starts.is_empty() && self.starts.len() != landmarks.len() + 1 {
            let (lines, map) = (self.starts.len() - 1, landmarks.len());
            let what = format!("lines of sight of {lines} landmarks for a map of {map}; build the map again");
            return Err(MapError::InvalidMap { what });
        }
        for (a, b, steps) in self.pairs() {
            let (from, to) = (landmarks[a.index()], landmarks[b.index()]);
            if from.component != to.component {
                return invalid(a, b, "joins two components");
            }
            let most = from.sightings.min(to.sightings);
            if steps > most {
                return invalid(a, b, &format!("has {steps} steps, the landmarks allow {most}"));
            }
        }
        Ok(())
    }

    /// The lines of sight of a finished map: see the module.
    pub(crate) fn find(
        landmarks: &[PlacedLandmark],
        counts: &CoVisibility,
        graph: &LinkGraph,
        components: &[Vec<u32>],
    ) -> Self {
        let pairs = components.iter().flat_map(|members| joined_neighbours(members, landmarks, graph));
        let counted = pairs.map(|(a, b)| (a, b, counts.together(a, b)));
        Self::from_pairs(landmarks.len(), counted).expect("links are pairs seen together (bug in covimap)")
    }
}

fn invalid<T>(a: LandmarkId, b: LandmarkId, what: &str) -> Result<T, MapError> {
    let what = format!("the line of sight between landmarks {} and {} {what}; build the map again", a.0, b.0);
    Err(MapError::InvalidMap { what })
}

/// Linked Delaunay neighbours of a component, and the shortest links that join what is left apart.
fn joined_neighbours(
    members: &[u32],
    landmarks: &[PlacedLandmark],
    graph: &LinkGraph,
) -> Vec<(LandmarkId, LandmarkId)> {
    let points: Vec<Point> = members.iter().map(|&i| landmarks[i as usize].position).collect();
    let mut edges = delaunay_edges(&points).expect("positions of a map are finite (bug in covimap)");
    let linked = |a: u32, b: u32| graph.of(a).binary_search_by_key(&b, |link| link.to).is_ok();
    edges.retain(|&(a, b)| linked(members[a as usize], members[b as usize]));
    let mut pieces = UnionFind::new(members.len());
    let joins = edges.iter().filter(|&&(a, b)| pieces.union(a, b)).count();
    if joins + 1 < members.len() {
        let mut bridges = links_between(members, graph, &pieces);
        bridges.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        edges.extend(bridges.iter().filter(|&&(_, a, b)| pieces.union(a, b)).map(|&(_, a, b)| (a, b)));
    }
    let number = |place: u32| LandmarkId(members[place as usize]);
    edges.into_iter().map(|(a, b)| (number(a), number(b))).collect()
}

/// Links whose ends lie in different pieces: their distances, and places in `members`.
fn links_between(members: &[u32], graph: &LinkGraph, pieces: &UnionFind<u32>) -> Vec<(f64, u32, u32)> {
    let mut found = Vec::new();
    for (a, &member) in (0..).zip(members) {
        for link in graph.of(member).iter().filter(|link| link.to > member) {
            let b =
                members.binary_search(&link.to).expect("links stay in a component (bug in covimap)") as u32;
            if !pieces.equiv(a, b) {
                found.push((link.distance, a, b));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests;
