//! SVG: a picture of the map.
//!
//! From back to front: regions as soft shapes, Delaunay edges as thin lines, landmarks as dots,
//! surveyed positions as rings with a line to their landmark, IDs. Components are charts of
//! their own, packed side by side at a common scale. A map that is drawn beside the truth takes
//! its frame, so that the picture is the right way round.
//!
//! Strokes and dots follow the typical distance of Delaunay neighbours, and large maps leave out
//! what could not be told apart: IDs, tool tips and in the end edges.

mod chart;
mod hull;
mod labels;
mod layout;
mod page;
mod scene;

use super::{ComponentGraph, palette, xml_text};
use crate::{GlobalMap, MapError, Truth};

/// A place on the page, in pixels; y points down.
type Pixel = [f64; 2];

/// What to draw besides the map.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SvgParams<'a> {
    /// Headline; `None`: "Co-visibility map".
    pub title: Option<String>,
    /// Surveyed positions to draw beside the map's own; default none.
    pub truth: Option<&'a Truth>,
}

/// Draws a map as the text of an SVG file.
///
/// # Errors
/// With a truth, those of [`crate::evaluate::against`]; else none.
///
/// # Complexity
/// `O(n log n)`, and `O(n^2)` for the few landmarks whose IDs are placed.
pub fn svg(map: &GlobalMap, params: &SvgParams<'_>) -> Result<String, MapError> {
    let graphs = ComponentGraph::all(map);
    let colours = palette::by_region(map, &graphs);
    let charts = chart::charts(map, graphs, params.truth)?;
    let scene = scene::Scene::new(map, &charts, &colours);
    Ok(page::compose(map, params, &scene))
}

fn counted(count: usize, noun: &str) -> String {
    format!("{} {noun}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// Digits in groups of three, as the SI writes them.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.char_indices() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests;
