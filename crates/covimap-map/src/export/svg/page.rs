//! The scene as SVG elements.

use ::svg::Document;
use ::svg::node::element::{Circle, Group, Line, Path, Rectangle, Text, Title};

use super::scene::{Mark, Scene, Shape};
use super::{Pixel, SvgParams, counted, grouped, labels, palette, xml_text};
use crate::GlobalMap;

const FONT: &str =
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Noto Sans', sans-serif";
const INK: &str = "#1d2733";
const GREY: &str = "#667382";
const EDGE: &str = "#bcc6d2";
const SURVEYED: &str = "#1d2733";
/// Margins, in pixels: at the sides, for the headline, for the legend.
const SIDE: f64 = 36.0;
const HEAD: f64 = 92.0;
const FOOT: f64 = 60.0;
/// Narrowest page that holds headline and legend.
const NARROWEST: f64 = 640.0;
/// Most dots that are elements of their own, with a tool tip.
const SINGLE_DOTS: usize = 2000;

/// The whole page.
pub(super) fn compose(map: &GlobalMap, params: &SvgParams<'_>, scene: &Scene) -> String {
    let title = params.title.as_deref().unwrap_or("Co-visibility map");
    let summary = summary(map, scene);
    let needed = [(title, 22.0), (&*summary, 13.0)].map(|(text, size)| labels::width(text) * size);
    let width =
        needed.into_iter().fold(NARROWEST - 2.0 * SIDE, f64::max).min(1120.0).max(scene.width) + 2.0 * SIDE;
    let height = scene.height + HEAD + FOOT;
    let left = 0.5 * (width - scene.width);
    let drawing = Group::new()
        .set("transform", format!("translate({} {HEAD})", short(left)))
        .add(regions(scene))
        .add(edges(scene))
        .add(dots(map, scene))
        .add(surveyed(scene))
        .add(texts(scene));
    let document = Document::new()
        .set("viewBox", format!("0 0 {} {}", short(width), short(height)))
        .set("width", short(width))
        .set("height", short(height))
        .set("font-family", FONT)
        .add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#fff"))
        .add(text(title, [SIDE, 46.0], 22.0, INK).set("font-weight", 600))
        .add(text(&summary, [SIDE, 69.0], 13.0, GREY))
        .add(drawing)
        .add(legend(scene).set("transform", format!("translate({SIDE} {})", short(height - 26.0))));
    format!("{document}\n")
}

/// One line that says what the map is made of.
fn summary(map: &GlobalMap, scene: &Scene) -> String {
    let report = map.report();
    let mut parts = vec![counted(map.len(), "landmark")];
    parts.push(counted(scene.components, "component"));
    parts.push(counted(report.regions as usize, "region"));
    parts.push(format!("{} co-seen pairs", grouped(report.pairs as usize)));
    parts.push(format!("stress-1 {:.3}", report.stress1));
    if scene.left_out > 0 {
        parts.push(format!("{} more components not drawn", scene.left_out));
    }
    parts.join("  ·  ")
}

fn regions(scene: &Scene) -> Group {
    let shape = |shape: &Shape| {
        let colour = colour(shape.colour);
        Path::new().set("d", polygon(&shape.corners)).set("fill", colour.clone()).set("stroke", colour)
    };
    let group = Group::new()
        .set("opacity", 0.13)
        .set("stroke-width", short(2.0 * scene.reach))
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round");
    scene.shapes.iter().fold(group, |group, region| group.add(shape(region)))
}

fn edges(scene: &Scene) -> Group {
    let group = Group::new()
        .set("fill", "none")
        .set("stroke", EDGE)
        .set("stroke-width", short((0.22 * scene.dot).clamp(0.25, 1.1)));
    let [ordinary, long] = &scene.edges;
    let path = |edges: &[(Pixel, Pixel)]| Path::new().set("d", edges.iter().map(segment).collect::<String>());
    group.add(path(ordinary)).add(path(long).set("stroke-opacity", 0.35))
}

fn dots(map: &GlobalMap, scene: &Scene) -> Group {
    if scene.marks.len() <= SINGLE_DOTS {
        let group = Group::new().set("stroke", "#fff").set("stroke-width", short(0.25 * scene.dot));
        return scene.marks.iter().fold(group, |group, mark| group.add(dot(map, scene, mark)));
    }
    // A dot is a line without length but with round ends; dots on the same half pixel are one.
    let group = Group::new().set("stroke-linecap", "round").set("stroke-width", short(2.0 * scene.dot));
    let mut of_colour = vec![Vec::new(); palette::COLOURS.len()];
    for mark in &scene.marks {
        of_colour[mark.colour].push(mark.at.map(|v| (2.0 * v).round() as i32));
    }
    let paths = of_colour.into_iter().enumerate().filter(|(_, dots)| !dots.is_empty());
    paths.fold(group, |group, (index, mut dots)| {
        dots.sort_unstable();
        dots.dedup();
        let points = dots.iter().map(|&[x, y]| format!("M{} {}h0", f64::from(x) / 2.0, f64::from(y) / 2.0));
        group.add(Path::new().set("d", points.collect::<String>()).set("stroke", colour(index)))
    })
}

fn dot(map: &GlobalMap, scene: &Scene, mark: &Mark) -> Circle {
    let placed = &map.landmarks()[mark.id.index()];
    let tip = format!(
        "{} · region {} · seen {} times with {} others",
        xml_text(map.names().name(mark.id)),
        placed.region,
        placed.sightings,
        placed.partners
    );
    circle(mark.at, scene.dot).set("fill", colour(mark.colour)).add(Title::new(tip))
}

fn surveyed(scene: &Scene) -> Group {
    let width = short((0.26 * scene.dot).clamp(0.4, 1.3));
    let group = Group::new().set("fill", "none").set("stroke", SURVEYED).set("stroke-width", width);
    scene.surveyed.iter().fold(group, |group, &(ring, landmark)| {
        let line = line(ring, landmark).set("stroke-opacity", 0.55);
        group.add(line).add(circle(ring, scene.dot))
    })
}

fn texts(scene: &Scene) -> Group {
    let ids = Group::new()
        .set("stroke", "#fff")
        .set("stroke-width", 3)
        .set("stroke-linejoin", "round")
        .set("paint-order", "stroke");
    let ids =
        scene.labels.iter().fold(ids, |group, label| group.add(text(&label.text, label.at, scene.font, INK)));
    scene.captions.iter().fold(Group::new().add(ids), |group, (at, caption)| {
        group.add(text(caption, *at, 11.5, GREY).set("text-anchor", "middle"))
    })
}

/// A row of samples, each with its name.
fn legend(scene: &Scene) -> Group {
    let mut left = 0.0;
    samples(scene).into_iter().fold(Group::new(), |group, (sample, name)| {
        let entry = Group::new()
            .set("transform", format!("translate({} 0)", short(left)))
            .add(sample)
            .add(text(name, [26.0, 4.0], 12.0, GREY));
        left += 26.0 + 12.0 * labels::width(name) + 22.0;
        group.add(entry)
    })
}

/// What the picture holds, drawn 18 pixels wide around the line y = 0.
fn samples(scene: &Scene) -> Vec<(Group, &'static str)> {
    let mut samples = Vec::new();
    let colours = scene.shapes.len().clamp(1, 3);
    let dots = (0..colours)
        .map(|i| circle([12.0 + 6.0 * i as f64 - 3.0 * colours as f64, 0.0], 4.5).set("fill", colour(i)));
    let name = if colours > 1 { "landmark, coloured by region" } else { "landmark" };
    samples.push((dots.fold(Group::new().set("stroke", "#fff"), Group::add), name));
    let shape = Rectangle::new().set("y", -7).set("width", 18).set("height", 14).set("rx", 5);
    samples.push((Group::new().add(shape.set("fill", colour(0)).set("opacity", 0.16)), "region"));
    if !scene.edges[0].is_empty() {
        let edge = line([0.0, 0.0], [18.0, 0.0]).set("stroke", EDGE).set("stroke-width", 1.5);
        samples.push((Group::new().add(edge), "Delaunay edge"));
    }
    if !scene.surveyed.is_empty() {
        let residual = line([14.0, -2.0], [0.0, 4.0]).set("stroke-opacity", 0.55);
        let both = Group::new().add(residual).add(circle([14.0, -2.0], 5.0));
        let both = both.set("fill", "none").set("stroke", SURVEYED).set("stroke-width", 1.3);
        samples.push((both, "surveyed position"));
    }
    samples
}

fn text(content: &str, at: Pixel, size: f64, fill: &str) -> Text {
    Text::new(xml_text(content))
        .set("x", short(at[0]))
        .set("y", short(at[1]))
        .set("font-size", size)
        .set("fill", fill)
}

fn circle(at: Pixel, radius: f64) -> Circle {
    Circle::new().set("cx", short(at[0])).set("cy", short(at[1])).set("r", short(radius))
}

fn line(from: Pixel, to: Pixel) -> Line {
    Line::new()
        .set("x1", short(from[0]))
        .set("y1", short(from[1]))
        .set("x2", short(to[0]))
        .set("y2", short(to[1]))
}

fn polygon(corners: &[Pixel]) -> String {
    let points: Vec<String> = corners.iter().map(|[x, y]| format!("{} {}", short(*x), short(*y))).collect();
    format!("M{}Z", points.join("L"))
}

fn segment((a, b): &(Pixel, Pixel)) -> String {
    format!("M{} {}L{} {}", short(a[0]), short(a[1]), short(b[0]), short(b[1]))
}

fn colour(index: usize) -> String {
    let [red, green, blue] = palette::COLOURS[index];
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A tenth of a pixel is enough; fine strokes get a hundredth.
fn short(value: f64) -> f64 {
    let digits = if value.abs() < 10.0 { 100.0 } else { 10.0 };
    // Adding zero turns -0 into 0.
    (digits * value).round() / digits + 0.0
}
