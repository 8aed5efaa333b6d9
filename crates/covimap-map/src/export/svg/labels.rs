//! Where IDs stand so that they can be read.
//!
//! Every ID has eight places around its dot. A place costs what it covers: other IDs most, then
//! dots, then edges; right of the dot is the natural one. Starting from the cheapest place in
//! turn, each ID moves to a cheaper one while any gains (at most [`SWEEPS`] rounds). What still
//! overlaps after that is left out, so no picture is a smear.

use super::Pixel;

/// Height of a line of text over the font size, and of the part above the base line.
const LINE: f64 = 1.05;
const ASCENT: f64 = 0.8;
const SWEEPS: usize = 6;
/// Costs: a covered ID, a covered dot, a crossed edge, a place off the page.
const ON_LABEL: f64 = 100.0;
const ON_DOT: f64 = 30.0;
const ON_EDGE: f64 = 1.0;
const OFF_PAGE: f64 = 1000.0;
/// Directions of the eight places, in order of preference, and what they cost by themselves.
const PLACES: [(Pixel, f64); 8] = [
    ([1.0, 0.0], 0.0),
    ([-1.0, 0.0], 0.3),
    ([0.0, -1.0], 0.4),
    ([0.0, 1.0], 0.4),
    ([0.8, -0.8], 0.2),
    ([0.8, 0.8], 0.3),
    ([-0.8, -0.8], 0.5),
    ([-0.8, 0.8], 0.5),
];

/// An ID beside its dot: base line, left end.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    pub text: String,
    pub at: Pixel,
}

/// What labels should not cover.
pub(super) struct Obstacles<'a> {
    /// Centres of dots and rings, all of one radius.
    pub dots: &'a [Pixel],
    pub radius: f64,
    pub edges: &'a [(Pixel, Pixel)],
    /// Width and height of the drawn area.
    pub page: Pixel,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Box {
    low: Pixel,
    high: Pixel,
}

/// Places `texts` beside the dots at `anchors`; those that find no room are left out.
pub(super) fn place(texts: &[String], anchors: &[Pixel], size: f64, around: &Obstacles) -> Vec<Label> {
    let options: Vec<[(Box, f64); 8]> = texts
        .iter()
        .zip(anchors)
        .map(|(text, &anchor)| {
            let extent = [width(text) * size, LINE * size];
            PLACES.map(|(direction, price)| {
                let place = Box::beside(anchor, direction, extent, around.radius + 3.0);
                (place, price + around.cost(&place))
            })
        })
        .collect();
    let mut chosen: Vec<Option<usize>> = vec![None; texts.len()];
    for _ in 0..SWEEPS {
        let before = chosen.clone();
        for label in 0..texts.len() {
            chosen[label] = Some(cheapest(&options, &chosen, label));
        }
        if chosen == before {
            break;
        }
    }
    leave_out_overlaps(&options, &mut chosen);
    let places = chosen.iter().enumerate().filter_map(|(label, place)| Some((label, (*place)?)));
    places
        .map(|(label, place)| {
            let Box { low, .. } = options[label][place].0;
            Label { text: texts[label].clone(), at: [low[0], low[1] + ASCENT * size] }
        })
        .collect()
}

/// The place of `label` that costs least beside the places chosen for the others.
fn cheapest(options: &[[(Box, f64); 8]], chosen: &[Option<usize>], label: usize) -> usize {
    let cost = |place: usize| {
        let (ours, price) = options[label][place];
        let covered = taken(options, chosen, label).filter(|other| ours.overlaps(other)).count();
        price + ON_LABEL * covered as f64
    };
    (0..PLACES.len()).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).expect("eight places (bug in covimap)")
}

/// Places of all labels but one.
fn taken<'a>(
    options: &'a [[(Box, f64); 8]],
    chosen: &'a [Option<usize>],
    but: usize,
) -> impl Iterator<Item = Box> + 'a {
    let placed = chosen.iter().enumerate().filter(move |(label, _)| *label != but);
    placed.filter_map(|(label, place)| Some(options[label][(*place)?].0))
}

fn leave_out_overlaps(options: &[[(Box, f64); 8]], chosen: &mut [Option<usize>]) {
    for label in (0..chosen.len()).rev() {
        let Some(place) = chosen[label] else { continue };
        let ours = options[label][place].0;
        if taken(options, chosen, label).any(|other| ours.overlaps(&other)) {
            chosen[label] = None;
        }
    }
}

impl Obstacles<'_> {
    fn cost(&self, place: &Box) -> f64 {
        let dots = self.dots.iter().filter(|&&dot| place.distance(dot) < self.radius).count();
        let edges = self.edges.iter().filter(|(a, b)| place.crossed(*a, *b)).count();
        let outside = place.low.iter().any(|&v| v < 0.0)
            || place.high[0] > self.page[0]
            || place.high[1] > self.page[1];
        ON_DOT * dots as f64 + ON_EDGE * edges as f64 + if outside { OFF_PAGE } else { 0.0 }
    }
}

impl Box {
    /// The box that touches a circle around `anchor` in a direction.
    fn beside(anchor: Pixel, direction: Pixel, extent: Pixel, reach: f64) -> Self {
        let low = [0, 1].map(|axis| {
            let side = direction[axis];
            let aligned = 0.5 * (side.signum() * f64::from(side != 0.0) - 1.0);
            anchor[axis] + side * reach + aligned * extent[axis]
        });
        Self { low, high: [low[0] + extent[0], low[1] + extent[1]] }
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
    }

    fn distance(&self, point: Pixel) -> f64 {
        let gap = |axis: usize| (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]).max(0.0);
        gap(0).hypot(gap(1))
    }

    /// Whether a line segment meets the box (slab test).
    fn crossed(&self, a: Pixel, b: Pixel) -> bool {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let step = b[axis] - a[axis];
            let [near, far] = [self.low[axis], self.high[axis]].map(|side| (side - a[axis]) / step);
            if step == 0.0 {
                if a[axis] < self.low[axis] || a[axis] > self.high[axis] {
                    return false;
                }
                continue;
            }
            from = from.max(near.min(far));
            to = to.min(near.max(far));
        }
        from <= to
    }
}

/// Estimated width of a text over its font size, a little on the wide side.
pub(super) fn width(text: &str) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.33,
        'f' | 'r' | 't' | '(' | ')' | '[' | ']' | '-' => 0.42,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.95,
        'A'..='Z' => 0.7,
        ' '..='~' => 0.62,
        '\u{80}'..='\u{10ff}' => 0.7,
        _ => 1.05,
    };
    text.chars().map(of).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free(page: Pixel) -> Obstacles<'static> {
        Obstacles { dots: &[], radius: 4.0, edges: &[], page }
    }

    fn boxes(labels: &[Label], size: f64) -> Vec<Box> {
        let of = |label: &Label| {
            let low = [label.at[0], label.at[1] - ASCENT * size];
            Box { low, high: [low[0] + width(&label.text) * size, low[1] + LINE * size] }
        };
        labels.iter().map(of).collect()
    }

    #[test]
    fn a_lone_label_stands_right_of_its_dot() {
        let labels = place(&["ab".to_owned()], &[[50.0, 50.0]], 10.0, &free([100.0, 100.0]));
        // Radius 4 and a gap of 3; half a line of 10.5 up, the base line 8 below that.
        assert_eq!(labels, [Label { text: "ab".to_owned(), at: [57.0, 52.75] }]);
    }

    #[test]
    fn a_label_at_the_edge_of_the_page_goes_left() {
        let labels = place(&["ab".to_owned()], &[[95.0, 50.0]], 10.0, &free([100.0, 100.0]));
        assert!(labels[0].at[0] + 12.4 < 95.0);
    }

    #[test]
    fn dots_and_edges_are_kept_clear_where_there_is_room() {
        let dots = [[50.0, 50.0], [62.0, 50.0]];
        let edges = [([0.0, 50.0], [50.0, 50.0]), ([50.0, 0.0], [50.0, 50.0])];
        let around = Obstacles { dots: &dots, radius: 4.0, edges: &edges, page: [100.0, 100.0] };
        let labels = place(&["ab".to_owned()], &dots[..1], 10.0, &around);
        let [place] = boxes(&labels, 10.0)[..] else { panic!("one label") };
        assert!(dots.iter().all(|&dot| place.distance(dot) >= 4.0));
        assert!(edges.iter().all(|&(a, b)| !place.crossed(a, b)));
    }

    #[test]
    fn crowded_labels_are_left_out_and_the_rest_do_not_overlap() {
        let texts: Vec<String> = (0..40).map(|i| format!("landmark {i}")).collect();
        let anchors: Vec<Pixel> =
            (0..40).map(|i| [100.0 + f64::from(i % 7) * 9.0, 100.0 + f64::from(i / 7) * 9.0]).collect();
        let around = Obstacles { dots: &anchors, radius: 4.0, edges: &[], page: [400.0, 400.0] };
        let labels = place(&texts, &anchors, 12.0, &around);
        assert!(labels.len() > 5 && labels.len() < 40, "{}", labels.len());
        let boxes = boxes(&labels, 12.0);
        for (index, place) in boxes.iter().enumerate() {
            assert!(boxes[..index].iter().all(|other| !place.overlaps(other)));
        }
    }

    #[test]
    fn segments_meet_boxes_they_cross_touch_or_start_in() {
        let place = Box { low: [1.0, 1.0], high: [3.0, 2.0] };
        for (a, b) in [([0.0, 0.0], [4.0, 3.0]), ([2.0, 1.5], [9.0, 9.0]), ([0.0, 1.0], [4.0, 1.0])] {
            assert!(place.crossed(a, b) && place.crossed(b, a), "{a:?} {b:?}");
        }
        for (a, b) in [([0.0, 0.0], [4.0, 0.5]), ([0.0, 1.5], [0.5, 1.5]), ([2.0, 3.0], [2.0, 9.0])] {
            assert!(!place.crossed(a, b) && !place.crossed(b, a), "{a:?} {b:?}");
        }
    }
}
