//! Several curves over linear or logarithmic axes, as SVG that stands alone.

use std::fmt::Write;

use super::Table;
use super::svg::{escaped, plain, text};
use crate::error::Error;

/// Width and height of the drawing.
const SIZE: [f64; 2] = [880.0, 440.0];

/// Left, right, top and bottom of the frame; the legend stands to its right.
const FRAME: [f64; 4] = [84.0, 596.0, 46.0, 382.0];

/// Part of an axis that is left free at both ends.
const FREE: f64 = 0.05;

/// Colours that differ for every kind of colour vision (Okabe, Ito 2008, yellow and grey darkened),
/// and marks that differ without colour.
const COLOURS: [&str; 12] = [
    "#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#b58900", "#56b4e9", "#7f3b08",
    "#6a3d9a", "#999999", "#e31a1c", "#00441b",
];
const MARKS: [Mark; 4] = [Mark::Disc, Mark::Square, Mark::Diamond, Mark::Triangle];

/// Curves over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What is shown, in a few words.
    pub title: String,
    /// The horizontal axis.
    pub across: Axis,
    /// The vertical axis.
    pub up: Axis,
    /// The curves, in the order of the legend.
    pub curves: Vec<Curve>,
    /// What open marks mean; shown in the legend if there are any.
    pub open: &'static str,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Decades in place of differences; what is not positive is then not drawn.
    pub logarithmic: bool,
}

/// Points joined by a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// The points, in the order of the line; those that are not finite are not drawn.
    pub points: Vec<Point>,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Place along the axes.
    pub at: [f64; 2],
    /// Drawn as an open mark.
    pub open: bool,
}

/// Points of a curve that have a mark, the last always, so that long curves stay readable.
const MARKED: usize = 24;

#[derive(Clone, Copy)]
enum Mark {
    Disc,
    Square,
    Diamond,
    Triangle,
}

impl Figure {
    /// The drawing; a frame alone where no point can be drawn.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let axes = [&self.across, &self.up];
        let drawable = |point: &&Point| {
            let mut pairs = axes.iter().zip(point.at);
            pairs.all(|(axis, value)| value.is_finite() && (!axis.logarithmic || value > 0.0))
        };
        let curves: Vec<Vec<Point>> = self
            .curves
            .iter()
            .map(|curve| curve.points.iter().filter(drawable).copied().collect())
            .collect();
        let scales = [0, 1].map(|axis| {
            let values = curves.iter().flatten().map(|point| point.at[axis]);
            Scale::new(axes[axis].logarithmic, values)
        });
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" \
             font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            SIZE[0],
            SIZE[1],
            escaped(&self.title)
        );
        self.draw_axes(&mut svg, &scales);
        for (number, points) in curves.iter().enumerate() {
            draw_curve(&mut svg, number, points, &scales);
        }
        let open = curves.iter().flatten().any(|point| point.open);
        self.draw_legend(&mut svg, open);
        svg + "</svg>\n"
    }

    fn draw_axes(&self, svg: &mut String, scales: &[Scale; 2]) {
        let [left, right, top, bottom] = FRAME;
        for (value, label) in scales[0].ticks() {
            let x = across(scales[0].part(value));
            line(svg, [x, top, x, bottom]);
            text(svg, [x, bottom + 19.0], "middle", &label);
        }
        for (value, label) in scales[1].ticks() {
            let y = up(scales[1].part(value));
            line(svg, [left, y, right, y]);
            text(svg, [left - 7.0, y + 4.5], "end", &label);
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>",
            right - left,
            bottom - top
        );
        let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        text(
            svg,
            [middle[0], bottom + 44.0],
            "middle",
            &self.across.label,
        );
        let _ = writeln!(
            svg,
            "<text transform=\"translate(20 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            middle[1],
            escaped(&self.up.label)
        );
        let _ = writeln!(
            svg,
            "<text x=\"{left}\" y=\"{:.1}\" font-size=\"16\" font-weight=\"bold\">{}</text>",
            top - 18.0,
            escaped(&self.title)
        );
    }

    fn draw_legend(&self, svg: &mut String, open: bool) {
        let [x, mut y] = [FRAME[1] + 18.0, FRAME[2] + 10.0];
        for (number, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            let _ = writeln!(
                svg,
                "<path d=\"M{x} {y}h26\" stroke=\"{colour}\" stroke-width=\"2\"{}/>",
                dashes(number)
            );
            draw_mark(svg, number, [x + 13.0, y], false);
            text(svg, [x + 34.0, y + 4.5], "start", &curve.name);
            y += 23.0;
        }
        if open {
            draw_mark(svg, 0, [x + 13.0, y + 6.0], true);
            text(svg, [x + 34.0, y + 10.5], "start", self.open);
        }
    }
}

/// Draws column `y` of a table against column `x`, in the order of the rows.
///
/// # Errors
///
/// [`Error::UnknownName`] for a column that the table does not have, [`Error::Empty`] if it
/// has no row of finite numbers.
pub fn plot(table: &Table, x: &str, y: &str) -> Result<String, Error> {
    let pairs = column(table, x)?.into_iter().zip(column(table, y)?);
    let finite = pairs.filter(|(x, y)| x.is_finite() && y.is_finite());
    let points = finite.map(|(x, y)| Point {
        at: [x, y],
        open: false,
    });
    let points: Vec<Point> = points.collect();
    if points.is_empty() {
        return Err(Error::Empty {
            place: format!("plot of {y} against {x}"),
        });
    }
    let [across, up] = [x, y].map(|label| Axis {
        label: label.to_owned(),
        logarithmic: false,
    });
    let figure = Figure {
        title: format!("{y} against {x}"),
        across,
        up,
        curves: vec![Curve {
            name: y.to_owned(),
            points,
        }],
        open: "",
    };
    Ok(figure.to_svg())
}

fn column(table: &Table, name: &str) -> Result<Vec<f64>, Error> {
    table.column(name).ok_or_else(|| Error::UnknownName {
        place: "plot".to_owned(),
        what: "column",
        name: name.to_owned(),
        nearest: None,
        known: table.columns.clone(),
    })
}

/// Range of an axis, of logarithms where it has decades.
struct Scale {
    logarithmic: bool,
    low: f64,
    high: f64,
}

impl Scale {
    /// Around the values, with some room.
    fn new(logarithmic: bool, values: impl Iterator<Item = f64>) -> Self {
        let values = values.map(|value| if logarithmic { value.log10() } else { value });
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = match (low < high, low.is_finite()) {
            (true, _) => (low, high),
            (false, true) => (low - 0.5, low + 0.5),
            (false, false) => (0.0, 1.0),
        };
        let room = FREE * (high - low);
        Self {
            logarithmic,
            low: low - room,
            high: high + room,
        }
    }

    /// Part of the axis before a value.
    fn part(&self, value: f64) -> f64 {
        let value = if self.logarithmic {
            value.log10()
        } else {
            value
        };
        (value - self.low) / (self.high - self.low)
    }

    /// Four to ten values with their labels: powers of ten, with 2 and 5 between where those are
    /// few, or multiples of 1, 2, 5 times one.
    fn ticks(&self) -> Vec<(f64, String)> {
        let range = self.high - self.low;
        if !self.logarithmic || range < 0.7 {
            return self.even_ticks();
        }
        let step = (range / 8.0).ceil();
        let first = (self.low / step).ceil();
        let last = (self.high / step).floor();
        let powers = (0..=(last - first).max(0.0) as usize).map(|k| step * (first + k as f64));
        let few = range < 3.0;
        let label = |power: f64| match few {
            true => plain(10.0_f64.powf(power)),
            false => power_of_ten(power as i32),
        };
        let mut ticks: Vec<(f64, String)> = powers
            .filter(|power| (self.low..=self.high).contains(power))
            .map(|power| (10.0_f64.powf(power), label(power)))
            .collect();
        if few {
            let decades = self.low.floor() as i32..=self.high.floor() as i32;
            for value in decades.flat_map(|d| [2.0, 5.0].map(|m| m * 10.0_f64.powi(d))) {
                if (self.low..=self.high).contains(&value.log10()) {
                    ticks.push((value, plain(value)));
                }
            }
        }
        ticks
    }

    fn even_ticks(&self) -> Vec<(f64, String)> {
        let ends = [self.low, self.high].map(|end| match self.logarithmic {
            true => 10.0_f64.powf(end),
            false => end,
        });
        let rough = (ends[1] - ends[0]) / 6.0;
        let power = 10.0_f64.powf(rough.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|size| size * power);
        let step = steps
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(rough);
        let first = (ends[0] / step).ceil();
        let count = ((ends[1] / step).floor() - first).clamp(0.0, 12.0) as usize;
        let values = (0..=count).map(|k| (first + k as f64) * step);
        values.map(|value| (value, plain(value))).collect()
    }
}

fn across(part: f64) -> f64 {
    FRAME[0] + part * (FRAME[1] - FRAME[0])
}

fn up(part: f64) -> f64 {
    FRAME[3] - part * (FRAME[3] - FRAME[2])
}

fn draw_curve(svg: &mut String, number: usize, points: &[Point], scales: &[Scale; 2]) {
    let places: Vec<[f64; 2]> = points
        .iter()
        .map(|point| {
            [
                across(scales[0].part(point.at[0])),
                up(scales[1].part(point.at[1])),
            ]
        })
        .collect();
    if places.len() > 1 {
        let words = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}"));
        let _ = writeln!(
            svg,
            "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"{} points=\"{}\"/>",
            COLOURS[number % COLOURS.len()],
            dashes(number),
            words.collect::<Vec<_>>().join(" ")
        );
    }
    let every = points.len().div_ceil(MARKED).max(1);
    let marked = points.iter().zip(places).rev().step_by(every);
    for (point, place) in marked {
        draw_mark(svg, number, place, point.open);
    }
}

fn draw_mark(svg: &mut String, number: usize, [x, y]: [f64; 2], open: bool) {
    let colour = COLOURS[number % COLOURS.len()];
    let fill = if open { "#fff" } else { colour };
    let paint = format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.5\"");
    let _ = match MARKS[number % MARKS.len()] {
        Mark::Disc => writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.8\" {paint}/>"
        ),
        Mark::Square => writeln!(
            svg,
            "<path d=\"M{:.1} {:.1}h7v7h-7z\" {paint}/>",
            x - 3.5,
            y - 3.5
        ),
        Mark::Diamond => writeln!(
            svg,
            "<path d=\"M{x:.1} {:.1}l4.8 4.8l-4.8 4.8l-4.8-4.8z\" {paint}/>",
            y - 4.8
        ),
        Mark::Triangle => writeln!(
            svg,
            "<path d=\"M{x:.1} {:.1}l4.6 8h-9.2z\" {paint}/>",
            y - 4.8
        ),
    };
}

/// A thin line between two places.
fn line(svg: &mut String, [x, y, to_x, to_y]: [f64; 4]) {
    let _ = writeln!(
        svg,
        "<path d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\" stroke=\"#ddd\"/>"
    );
}

/// The second half of the colours is dashed.
fn dashes(number: usize) -> &'static str {
    match number {
        0..=4 => "",
        _ => " stroke-dasharray=\"7 3\"",
    }
}

/// `10⁻⁸`, and the number itself from 0.01 to 100.
fn power_of_ten(power: i32) -> String {
    if (-2..=2).contains(&power) {
        return plain(10.0_f64.powi(power));
    }
    let digits = power.to_string();
    let raised = digits.chars().map(|digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32(digit as u32 - '0' as u32 + '⁰' as u32).unwrap_or(digit),
    });
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::report::Cell;

    fn figure(logarithmic: bool, points: &[[f64; 2]]) -> Figure {
        let axis = |label: &str| Axis {
            label: label.to_owned(),
            logarithmic,
        };
        let point = |at: &[f64; 2]| Point {
            at: *at,
            open: at[0] > 50.0,
        };
        Figure {
            title: "a < b".to_owned(),
            across: axis("seconds"),
            up: axis("error"),
            curves: vec![Curve {
                name: "one".to_owned(),
                points: points.iter().map(point).collect(),
            }],
            open: "not certified",
        }
    }

    #[test]
    fn what_is_not_positive_is_left_out_of_decades() {
        let points = [[1.0, 1e-3], [10.0, 0.0], [f64::NAN, 1.0], [100.0, 1e-6]];
        let svg = figure(true, &points).to_svg();
        // Two points and the legend's disc, and one more of it for the open mark.
        assert_eq!(svg.matches("<circle").count(), 4);
        assert!(
            svg.contains("not certified") && svg.contains(">10⁻⁶<"),
            "{svg}"
        );
        assert!(svg.contains("a &lt; b"));
        let even = figure(false, &points).to_svg();
        assert_eq!(even.matches("<circle").count(), 5);
    }

    #[test]
    fn the_corners_of_the_data_are_a_twentieth_inside_the_frame() {
        let scale = Scale::new(true, [1.0, 100.0].into_iter());
        assert!((scale.part(1.0) - 0.05 / 1.1).abs() < 1e-15);
        assert!((scale.part(10.0) - 0.5).abs() < 1e-15);
        let labels: Vec<String> = scale.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["1", "10", "100", "2", "5", "20", "50"]);
    }

    #[test]
    fn axes_of_any_range_have_few_round_labels() {
        for (low, high) in [(1e-15, 1e3), (0.5, 0.6), (1e-3, 1.0), (3.0, 3.0)] {
            for logarithmic in [true, false] {
                let ticks = Scale::new(logarithmic, [low, high].into_iter()).ticks();
                assert!((2..=14).contains(&ticks.len()), "{low} {high}: {ticks:?}");
            }
        }
        assert!(figure(true, &[]).to_svg().ends_with("</svg>\n"));
    }

    fn table(rows: &[[f64; 2]]) -> Table {
        let row = |row: &[f64; 2]| row.map(Cell::Number).to_vec();
        Table {
            columns: vec!["at".to_owned(), "normal".to_owned()],
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn a_column_against_another_is_one_curve_on_even_axes() {
        let rows = [[0.0, -1.0], [f64::NAN, 5.0], [2.0, 3.0]];
        let svg = plot(&table(&rows), "at", "normal").unwrap();
        // A twentieth of the range is free at both ends of the frame, 84 to 596 by 46 to 382.
        assert!(svg.contains("points=\"107.3,366.7 572.7,61.3\""), "{svg}");
    }

    #[test]
    fn a_column_that_is_not_there_is_named_with_those_that_are() {
        let refused = plot(&table(&[[0.0, 1.0]]), "time", "normal");
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.contains("no column `time`") && refused.contains("at"),
            "{refused}"
        );
        assert!(plot(&table(&[]), "at", "normal").is_err());
        assert!(plot(&table(&[[f64::NAN, 1.0]]), "at", "normal").is_err());
    }
}
