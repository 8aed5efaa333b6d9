//! The map in pixels.

use std::collections::BTreeMap;

use covimap_embed::Point;

use super::chart::Chart;
use super::labels::{self, Label, Obstacles};
use super::layout::{Layout, Need, Room};
use super::{Pixel, counted, hull};
use crate::{GlobalMap, LandmarkId};

/// Fewest landmarks that fill a page.
const ROOMY: usize = 12;
/// Most landmarks whose IDs are drawn.
const LABELLED: usize = 150;
/// Most charts that are drawn, and that have a caption; the rest is counted.
const CHARTS: usize = 100;
const CAPTIONED: usize = 12;
/// Most edges that are drawn.
const EDGES: usize = 150_000;
/// Longest ID that is drawn in full, in characters.
const LONGEST: usize = 18;
/// Neighbours further apart than this many typical ones are hardly neighbours.
const LONG: f64 = 4.0;

/// A landmark.
pub(super) struct Mark {
    pub id: LandmarkId,
    pub at: Pixel,
    /// Index into the palette.
    pub colour: usize,
}

/// A region: where its members are.
pub(super) struct Shape {
    pub corners: Vec<Pixel>,
    pub colour: usize,
}

/// All that is drawn, in pixels from the corner of the drawn area.
#[derive(Default)]
pub(super) struct Scene {
    pub width: f64,
    pub height: f64,
    pub shapes: Vec<Shape>,
    /// Delaunay edges of ordinary length, and the long ones.
    pub edges: [Vec<(Pixel, Pixel)>; 2],
    pub marks: Vec<Mark>,
    /// Surveyed positions, each with the place of its landmark.
    pub surveyed: Vec<(Pixel, Pixel)>,
    pub labels: Vec<Label>,
    /// Centres of the base lines, and texts.
    pub captions: Vec<(Pixel, String)>,
    /// Components of the map, and how many of them found no place.
    pub components: usize,
    pub left_out: usize,
    /// Radius of a dot.
    pub dot: f64,
    /// How far a region reaches beyond its landmarks.
    pub reach: f64,
    /// Size of the IDs.
    pub font: f64,
}

impl Scene {
    pub fn new(map: &GlobalMap, charts: &[Chart], colours: &[usize]) -> Self {
        let labelled = map.len() <= LABELLED;
        let components = charts.len();
        let charts = &charts[..components.min(CHARTS)];
        let bounds: Vec<[Point; 2]> = charts.iter().map(Chart::bounds).collect();
        let needs: Vec<Need> = bounds
            .iter()
            .enumerate()
            .map(|(index, [low, high])| Need {
                extent: [0, 1].map(|axis| (high[axis] - low[axis]).min(f64::MAX)),
                room: room(labelled, charts.len() > 1 && index < CAPTIONED),
            })
            .collect();
        // A few landmarks need no large page.
        let layout = Layout::new(&needs, (map.len() as f64 / ROOMY as f64).sqrt().clamp(0.4, 1.0));
        let mut scene = Self {
            width: layout.width,
            height: layout.height,
            components,
            left_out: components - charts.len(),
            dot: 5.0,
            reach: 10.0,
            font: if map.len() <= 60 { 12.5 } else { 11.0 },
            ..Self::default()
        };
        for (((chart, cell), need), [low, high]) in charts.iter().zip(&layout.cells).zip(&needs).zip(&bounds)
        {
            let middle = [cell.x + 0.5 * cell.width, cell.y + 0.5 * (cell.height - need.room.caption)];
            let to_pixel = |[x, y]: Point| -> Pixel {
                [
                    middle[0] + layout.scale * (x - (0.5 * low[0] + 0.5 * high[0])),
                    middle[1] - layout.scale * (y - (0.5 * low[1] + 0.5 * high[1])),
                ]
            };
            scene.add(map, chart, colours, to_pixel);
            if need.room.caption > 0.0 {
                let size = counted(chart.graph.landmarks.len(), "landmark");
                let text = format!("component {} · {size}", chart.graph.component);
                scene.captions.push(([middle[0], cell.y + cell.height - 4.0], text));
            }
        }
        scene.fit_strokes();
        if labelled {
            scene.label(map);
        }
        scene
    }

    fn add(&mut self, map: &GlobalMap, chart: &Chart, colours: &[usize], to_pixel: impl Fn(Point) -> Pixel) {
        let at: Vec<Pixel> = chart.graph.points.iter().map(|&point| to_pixel(point)).collect();
        let mut regions = BTreeMap::<u32, (usize, Vec<Pixel>)>::new();
        for (&id, &at) in chart.graph.landmarks.iter().zip(&at) {
            let colour = colours[id.index()];
            let region = regions.entry(map.landmarks()[id.index()].region);
            region.or_insert_with(|| (colour, Vec::new())).1.push(at);
            self.marks.push(Mark { id, at, colour });
        }
        let shapes = regions.into_values().map(|(colour, at)| Shape { corners: hull::convex(at), colour });
        self.shapes.extend(shapes);
        self.surveyed.extend(chart.surveyed.iter().map(|&(index, point)| (to_pixel(point), at[index])));
        let edges = chart.graph.edges.iter().map(|&(a, b)| (at[a as usize], at[b as usize]));
        self.edges[0].extend(edges);
    }

    /// Dots that leave room between typical neighbours; long edges apart from the others.
    fn fit_strokes(&mut self) {
        let mut lengths: Vec<f64> = self.edges[0].iter().map(length).collect();
        let middle = lengths.len() / 2;
        let Some((_, &mut typical, _)) =
            (!lengths.is_empty()).then(|| lengths.select_nth_unstable_by(middle, f64::total_cmp))
        else {
            return;
        };
        self.dot = (0.14 * typical).clamp(0.8, 5.0);
        self.reach = self.dot + (0.4 * typical).min(5.0);
        let (long, short) = self.edges[0].iter().partition(|edge| length(edge) > LONG * typical);
        self.edges = if self.edges[0].len() > EDGES { Default::default() } else { [short, long] };
    }

    fn label(&mut self, map: &GlobalMap) {
        let texts: Vec<String> = self.marks.iter().map(|mark| shortened(map.names().name(mark.id))).collect();
        let anchors: Vec<Pixel> = self.marks.iter().map(|mark| mark.at).collect();
        let rings = self.surveyed.iter().map(|&(ring, _)| ring);
        let dots: Vec<Pixel> = anchors.iter().copied().chain(rings).collect();
        let edges: Vec<_> = self.edges.iter().flatten().copied().collect();
        let page = [self.width, self.height];
        let around = Obstacles { dots: &dots, radius: self.dot, edges: &edges, page };
        self.labels = labels::place(&texts, &anchors, self.font, &around);
    }
}

/// Room for IDs beside the outer dots, and for a caption.
fn room(labelled: bool, captioned: bool) -> Room {
    let padding = match (labelled, captioned) {
        (true, _) => 34.0,
        (false, true) => 20.0,
        (false, false) => 14.0,
    };
    if captioned {
        Room { padding, caption: 16.0, narrowest: 175.0 }
    } else {
        Room { padding, caption: 0.0, narrowest: 0.0 }
    }
}

fn length((a, b): &(Pixel, Pixel)) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn shortened(id: &str) -> String {
    let mut characters = id.chars();
    let start: String = characters.by_ref().take(LONGEST).collect();
    if characters.next().is_some() { start + "…" } else { start }
}
