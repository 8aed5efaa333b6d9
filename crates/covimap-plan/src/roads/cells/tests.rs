use super::*;
use crate::RoadParams;
use crate::fixtures::{index_of, lines_among, scattered};
use crate::roads::Bound;

/// Checks all that cells promise.
fn check(cells: &Cells, roads: &Roads<'_>, most: usize) {
    let mut all = cells.order.clone();
    all.sort_unstable();
    assert_eq!(all, (0..all.len() as u32).map(LandmarkId).collect::<Vec<_>>());
    assert!((0..all.len() as u32).all(|place| cells.place(cells.order[place as usize]) == place));
    for cell in 0..cells.count() as u32 {
        let places = cells.places(cell);
        assert!((1..=most).contains(&places.len()), "{places:?}");
        for place in places.clone() {
            assert_eq!(cells.of(place), cell);
            let mut ends = roads.lines(cells.order[place as usize]).map(|(line, _)| cells.place(line.to));
            assert_eq!(ends.any(|end| !places.contains(&end)), cells.border(cell).contains(&place));
        }
    }
}

#[test]
fn every_landmark_is_in_one_cell_and_those_with_roads_out_come_first() {
    for n in [1, 2, 3, 4, 50, 333] {
        let points = scattered(n, 5);
        let mut lines = if n < 3 { Vec::new() } else { lines_among(&points, 6) };
        lines.truncate(1000);
        let index = index_of(&points, &lines);
        // One landmark has no road, and a map of one no line of sight.
        let bound = Bound::of_lengths(index.map());
        let roads =
            Roads { index: &index, params: RoadParams::default(), costs: Vec::new(), bound, overlay: None };
        for most in [1, 2, 7, 100, 1000] {
            check(&Cells::new(&roads, most), &roads, most);
        }
    }
}

#[test]
fn landmarks_at_one_place_are_cut_apart_by_number() {
    let index = index_of(&[[3.0, 4.0]; 5], &[(0, 1, 9), (1, 2, 9), (2, 3, 9), (3, 4, 9)]);
    let roads = Roads::new(&index, RoadParams::default()).unwrap();
    let cells = Cells::new(&roads, 3);
    check(&cells, &roads, 3);
    assert_eq!(cells.order.iter().map(|id| id.0).collect::<Vec<_>>(), [1, 0, 2, 3, 4]);
}

#[test]
fn cuts_are_at_walls() {
    // Twelve columns of five, all joined to the next ones; between columns 4 and 5 only one road is open.
    let number = |x: u32, y: u32| 5 * x + y;
    let mut points = Vec::new();
    let mut lines = Vec::new();
    for x in 0..12 {
        for y in 0..5 {
            points.push([f64::from(x), f64::from(y)]);
            if x < 11 && (x != 4 || y == 2) {
                lines.push((number(x, y), number(x + 1, y), 9));
            }
            if y < 4 {
                lines.push((number(x, y), number(x, y + 1), 9));
            }
        }
    }
    let index = index_of(&points, &lines);
    let roads = Roads::new(&index, RoadParams::default()).unwrap();
    let cells = Cells::new(&roads, 35);
    check(&cells, &roads, 35);
    assert_eq!((cells.count(), cells.places(0).len()), (2, 25));
    assert_eq!(cells.order[cells.border(0).start as usize], LandmarkId(number(4, 2)));
    assert_eq!((cells.border(0).len(), cells.border(1).len()), (1, 1));
}
