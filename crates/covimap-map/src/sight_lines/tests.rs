use super::*;
use crate::fixtures::{counts_of, distance, links_where, log_of, looks, scattered};

fn at(points: &[Point]) -> Vec<PlacedLandmark> {
    let placed = |&position| PlacedLandmark {
        position,
        component: 0,
        region: 0,
        sightings: 9,
        partners: 1,
        ..Default::default()
    };
    points.iter().map(placed).collect()
}

fn numbers(lines: &SightLines) -> Vec<(u32, u32, u32)> {
    lines.pairs().map(|(a, b, steps)| (a.0, b.0, steps)).collect()
}

fn from_pairs(landmarks: usize, pairs: &[(u32, u32, u32)]) -> Result<SightLines, MapError> {
    SightLines::from_pairs(landmarks, pairs.iter().map(|&(a, b, n)| (LandmarkId(a), LandmarkId(b), n)))
}

#[test]
fn rows_hold_both_ends_of_every_pair() {
    let lines = from_pairs(4, &[(2, 1, 5), (0, 1, 7)]).unwrap();
    assert_eq!(numbers(&lines), [(0, 1, 7), (1, 2, 5)]);
    let row = |i| lines.of(LandmarkId(i)).iter().map(|line| (line.to.0, line.steps)).collect::<Vec<_>>();
    assert_eq!([row(0), row(1), row(2), row(3)], [vec![(1, 7)], vec![(0, 7), (2, 5)], vec![(1, 5)], vec![]]);
    assert_eq!(lines.count(), 2);
    let none = SightLines::default();
    assert_eq!((none.count(), none.of(LandmarkId(3)).len(), none.pairs().count()), (0, 0, 0));
    assert_eq!(from_pairs(0, &[]).unwrap().count(), 0);
}

#[test]
fn pairs_that_cannot_be_are_refused() {
    for (pairs, told) in [
        (&[(0, 3, 1)][..], "0 and 3 has 1 steps among 3 landmarks"),
        (&[(1, 1, 1)], "1 and 1 has 1 steps"),
        (&[(0, 1, 0)], "0 and 1 has 0 steps"),
        (&[(0, 1, 2), (1, 0, 2)], "0 and 1 stands there twice"),
    ] {
        let refusal = from_pairs(3, pairs).unwrap_err().to_string();
        assert!(refusal.contains(told), "{refusal}");
    }
}

#[test]
fn lines_that_contradict_the_landmarks_are_refused() {
    let mut landmarks = at(&[[0.0; 2], [1.0, 0.0]]);
    let refusal = |lines: SightLines, landmarks: &[_]| lines.check(landmarks).unwrap_err().to_string();
    let lines = from_pairs(2, &[(0, 1, 9)]).unwrap();
    assert!(lines.check(&landmarks).is_ok());
    assert!(refusal(lines.clone(), &landmarks[..1]).contains("of 2 landmarks for a map of 1"));
    landmarks[1].sightings = 8;
    assert!(refusal(lines.clone(), &landmarks).contains("has 9 steps, the landmarks allow 8"));
    landmarks[0].component = 1;
    assert!(refusal(lines, &landmarks).contains("joins two components"));
}

/// Linked pairs of a square with one diagonal, given by their corners.
fn square(linked: &[(usize, usize)]) -> Vec<(u32, u32)> {
    // Corner 3 is pushed out, so that the diagonal of the Delaunay graph is 0-2.
    let corners = at(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-0.2, 1.2]]);
    let graph = links_where(4, |i, j| linked.contains(&(i, j)).then_some((i + j) as f64));
    let found = joined_neighbours(&[0, 1, 2, 3], &corners, &graph);
    let mut found: Vec<_> = found.into_iter().map(|(a, b)| (a.0.min(b.0), a.0.max(b.0))).collect();
    found.sort_unstable();
    found
}

#[test]
fn neighbours_never_seen_together_are_not_joined() {
    let all = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2), (1, 3)];
    assert_eq!(square(&all), [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)]);
    // A wall from 1-2 to 0-2: the way round stays.
    assert_eq!(square(&[(0, 1), (2, 3), (0, 3), (1, 3)]), [(0, 1), (0, 3), (2, 3)]);
}

#[test]
fn pieces_are_joined_by_their_shortest_links() {
    // Of 0-1 and 2-3 apart, only 1-3 joins: it is no Delaunay edge.
    assert_eq!(square(&[(0, 1), (2, 3), (1, 3)]), [(0, 1), (1, 3), (2, 3)]);
    assert_eq!(square(&[(1, 3)]), [(1, 3)]);
    assert_eq!(square(&[]), []);
}

#[test]
fn in_a_hall_they_are_delaunay_edges_with_their_counts_and_join_everything() {
    let points = scattered(80, [2.0, 3.0], 4);
    let counts = counts_of(&log_of(&looks(&points, [2.0, 3.0], 0.7, 900)));
    let graph = LinkGraph::from_counts(&counts);
    let components = graph.components();
    let lines = SightLines::find(&at(&points), &counts, &graph, &components);
    let delaunay = delaunay_edges(&points).unwrap();
    let mut pieces = UnionFind::new(80);
    for (a, b, steps) in lines.pairs() {
        assert_eq!(steps, counts.together(a, b));
        let bridge = pieces.union(a.0, b.0);
        assert!(delaunay.contains(&(a.0, b.0)) || bridge, "{a:?} {b:?}");
        assert!(distance(points[a.index()], points[b.index()]) < 2.0);
    }
    for (member, component) in components.iter().flat_map(|c| c.iter().map(move |&m| (m, c[0]))) {
        assert!(pieces.equiv(member, component));
    }
    for &(a, b) in &delaunay {
        let [a, b] = [a, b].map(LandmarkId);
        let joined = lines.of(a).iter().any(|line| line.to == b);
        assert_eq!(joined, counts.together(a, b) > 0, "{a:?} {b:?}");
    }
}
