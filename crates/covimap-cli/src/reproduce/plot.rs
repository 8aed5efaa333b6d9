//! Draws figures of one or more panels as SVG.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;

/// Colours that people with colour-blindness can tell apart (M. Okabe and K. Ito), the weakest left out.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];
const INK: RGBColor = RGBColor(40, 40, 40);
const FONT: &str = "sans-serif";

/// Pixels.
const PANEL: (u32, u32) = (460, 420);
const LEGEND_WIDTH: u32 = 170;
const TITLE_HEIGHT: u32 = 40;
const LEGEND_LINE: i32 = 24;
const MARKER: i32 = 3;

/// A picture: panels in two columns, one legend for all of them.
#[derive(Debug, Clone)]
pub struct Figure {
    pub title: String,
    pub panels: Vec<Panel>,
    pub legend: Vec<Key>,
}

/// A pair of axes and what is drawn there.
#[derive(Debug, Clone)]
pub struct Panel {
    pub title: String,
    pub x_label: &'static str,
    pub y_label: &'static str,
    pub x_axis: XAxis,
    pub marks: Vec<Mark>,
}

/// Where the x axis begins, and how it is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum XAxis {
    /// At 0.
    FromZero,
    /// Somewhat before the least x.
    FromData,
    /// At the least x, which is positive; logarithmic.
    Logarithmic,
}

/// A curve or a cloud of dots.
#[derive(Debug, Clone)]
pub struct Mark {
    pub look: Look,
    pub points: Vec<[f64; 2]>,
}

/// An entry of the legend.
#[derive(Debug, Clone)]
pub struct Key {
    pub text: String,
    pub look: Look,
}

/// How a mark is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Place in the palette.
    pub colour: usize,
    pub line: Line,
    pub dots: Dots,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    None,
    Solid,
    Dashed,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dots {
    None,
    Filled,
    Hollow,
}

impl Look {
    fn colour(self) -> RGBColor {
        COLOURS[self.colour % COLOURS.len()]
    }

    fn stroke(self) -> ShapeStyle {
        self.colour().stroke_width(2)
    }

    fn dot<C>(self, at: C) -> Circle<C, i32> {
        let style =
            if self.dots == Dots::Filled { self.colour().filled() } else { self.colour().stroke_width(1) };
        Circle::new(at, MARKER, style)
    }
}

/// The picture as SVG text.
pub fn svg(figure: &Figure) -> String {
    let rows = figure.panels.len().div_ceil(2);
    let size = (2 * PANEL.0 + LEGEND_WIDTH, rows as u32 * PANEL.1 + TITLE_HEIGHT);
    let mut text = String::new();
    {
        let page = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw(figure, rows, &page).expect("text takes all drawing (bug in covimap)");
    }
    text
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(figure: &Figure, rows: usize, page: &Area<'_>) -> Drawn {
    page.fill(&WHITE)?;
    let title = (FONT, 22).into_font().color(&INK);
    page.draw_text(&figure.title, &title, (14, 12))?;
    let (_, below) = page.split_vertically(TITLE_HEIGHT);
    let (left, legend) = below.split_horizontally(2 * PANEL.0);
    for (panel, area) in figure.panels.iter().zip(left.split_evenly((rows, 2))) {
        let ([least, greatest], top) = ranges(panel);
        let margin = 0.05 * (greatest - least);
        match panel.x_axis {
            XAxis::FromZero => draw_panel(panel, &area, 0.0..greatest, top)?,
            XAxis::FromData => draw_panel(panel, &area, least - margin..greatest + margin, top)?,
            XAxis::Logarithmic => draw_panel(panel, &area, (least..greatest).log_scale(), top)?,
        }
    }
    draw_legend(&figure.legend, &legend)?;
    Ok(page.present()?)
}

/// Least and greatest x, and the end of the y axis, which begins at 0.
fn ranges(panel: &Panel) -> ([f64; 2], f64) {
    let points = || panel.marks.iter().flat_map(|mark| &mark.points);
    let greatest = |axis: usize| points().map(|point| point[axis]).fold(f64::MIN_POSITIVE, f64::max);
    let least = points().map(|point| point[0]).fold(greatest(0), f64::min);
    ([least, greatest(0)], 1.05 * greatest(1))
}

fn draw_panel<X>(panel: &Panel, area: &Area<'_>, xs: X, top: f64) -> Drawn
where
    X: AsRangedCoord<Value = f64>,
    X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, (FONT, 15).into_font().color(&INK))
        .margin(10)
        .margin_right(18)
        .x_label_area_size(46)
        .y_label_area_size(58)
        .build_cartesian_2d(xs, 0.0..top)?;
    chart
        .configure_mesh()
        .x_desc(panel.x_label)
        .y_desc(panel.y_label)
        .x_label_formatter(&|&x| number(x))
        .y_label_formatter(&|&y| number(y))
        .x_labels(6)
        .y_labels(6)
        .max_light_lines(0)
        .bold_line_style(RGBColor(225, 225, 225))
        .axis_style(INK)
        .label_style((FONT, 13).into_font().color(&INK))
        .axis_desc_style((FONT, 15).into_font().color(&INK))
        .draw()?;
    for Mark { look, points } in &panel.marks {
        let points = points.iter().map(|&[x, y]| (x, y));
        match look.line {
            Line::None => {}
            Line::Solid => {
                chart.draw_series(LineSeries::new(points.clone(), look.stroke()))?;
            }
            Line::Dashed => {
                chart.draw_series(DashedLineSeries::new(points.clone(), 6, 4, look.stroke()))?;
            }
        }
        if look.dots != Dots::None {
            chart.draw_series(points.map(|point| look.dot(point)))?;
        }
    }
    Ok(())
}

/// A number without the digits that only rounding put there.
fn number(value: f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}

fn draw_legend(keys: &[Key], area: &Area<'_>) -> Drawn {
    let style = (FONT, 15).into_font().color(&INK);
    for (place, Key { text, look }) in keys.iter().enumerate() {
        let y = 30 + LEGEND_LINE * place as i32;
        let (start, end) = (8, 40);
        match look.line {
            Line::None => {}
            Line::Solid => area.draw(&PathElement::new([(start, y), (end, y)], look.stroke()))?,
            Line::Dashed => {
                for dash in (start..end).step_by(10) {
                    area.draw(&PathElement::new([(dash, y), (end.min(dash + 6), y)], look.stroke()))?;
                }
            }
        }
        if look.dots != Dots::None {
            area.draw(&look.dot(((start + end) / 2, y)))?;
        }
        area.draw_text(text, &style, (end + 8, y - 7))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(x_axis: XAxis) -> Figure {
        let look = Look { colour: 1, line: Line::Solid, dots: Dots::Hollow };
        let mark = Mark { look, points: vec![[10.0, 0.5], [1000.0, 0.25]] };
        let dashed = Mark { look: Look { line: Line::Dashed, dots: Dots::None, ..look }, ..mark.clone() };
        let panel = Panel {
            title: "(a)".into(),
            x_label: "Steps",
            y_label: "Error",
            x_axis,
            marks: vec![mark, dashed],
        };
        let key = Key { text: "10 % <missed>".into(), look };
        Figure { title: "Two curves".into(), panels: vec![panel.clone(), panel], legend: vec![key] }
    }

    #[test]
    fn a_figure_has_its_titles_axes_curves_and_legend() {
        for x_axis in [XAxis::FromZero, XAxis::FromData, XAxis::Logarithmic] {
            let text = svg(&figure(x_axis));
            for wanted in ["Two curves", "Steps", "Error", "10 % &lt;missed&gt;", "<polyline"] {
                assert!(text.contains(wanted), "{wanted}");
            }
            // Two dots in each panel and one in the legend.
            assert_eq!(text.matches("<circle").count(), 5);
            assert!(text.trim_end().ends_with("</svg>"));
        }
    }

    #[test]
    fn a_figure_without_points_is_drawn_empty() {
        let mut empty = figure(XAxis::FromZero);
        empty.panels.iter_mut().for_each(|panel| panel.marks.clear());
        assert!(svg(&empty).contains("Two curves"));
    }

    #[test]
    fn axes_reach_over_all_points() {
        assert_eq!(ranges(&figure(XAxis::FromZero).panels[0]), ([10.0, 1000.0], 0.525));
    }
}
