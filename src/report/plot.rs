//! One column of a table against another, as a line in SVG.

use super::Table;
use crate::error::Error;

/// Width and height of the drawing, and of the margins around its frame.
const SIZE: [f64; 2] = [720.0, 480.0];
const MARGIN: [f64; 2] = [90.0, 50.0];

/// Marks along an axis, about this many.
const MARKS: f64 = 6.0;

/// Draws column `y` of a table against column `x`, in the order of the rows.
///
/// # Errors
///
/// [`Error::UnknownName`] for a column that the table does not have, [`Error::Empty`] if it
/// has no row of finite numbers.
pub fn plot(table: &Table, x: &str, y: &str) -> Result<String, Error> {
    let points = column(table, x)?.into_iter().zip(column(table, y)?);
    let finite = points.filter(|(x, y)| x.is_finite() && y.is_finite());
    let (xs, ys): (Vec<f64>, Vec<f64>) = finite.unzip();
    if xs.is_empty() {
        return Err(Error::Empty {
            place: format!("plot of {y} against {x}"),
        });
    }
    let axes = [Axis::new(&xs), Axis::new(&ys)];
    let place = |x: f64, y: f64| {
        let [across, up] = [axes[0].part(x), axes[1].part(y)];
        let [width, height] = [SIZE[0] - 2.0 * MARGIN[0], SIZE[1] - 2.0 * MARGIN[1]];
        [
            MARGIN[0] + across * width,
            SIZE[1] - MARGIN[1] - up * height,
        ]
    };
    let [left, right] = [MARGIN[0], SIZE[0] - MARGIN[0]];
    let [top, bottom] = [MARGIN[1], SIZE[1] - MARGIN[1]];
    let mut drawing = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        SIZE[0], SIZE[1]
    );
    for mark in axes[0].marks() {
        let [at, _] = place(mark, axes[1].low);
        drawing += &line([at, top, at, bottom]);
        drawing += &text([at, bottom + 18.0], "middle", &label(mark));
    }
    for mark in axes[1].marks() {
        let [_, at] = place(axes[0].low, mark);
        drawing += &line([left, at, right, at]);
        drawing += &text([left - 6.0, at + 4.0], "end", &label(mark));
    }
    drawing += &text([0.5 * SIZE[0], SIZE[1] - 8.0], "middle", x);
    drawing += &text([left, top - 14.0], "start", y);
    let points = xs.iter().zip(&ys).map(|(&x, &y)| {
        let [x, y] = place(x, y);
        format!("{x:.2},{y:.2}")
    });
    let points: Vec<String> = points.collect();
    drawing += &format!(
        "<polyline fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.5\" points=\"{}\"/>\n</svg>\n",
        points.join(" ")
    );
    Ok(drawing)
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

/// Range of an axis; one value alone is given a range around it.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    fn new(values: &[f64]) -> Self {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if high > low {
            return Self { low, high };
        }
        let around = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
        Self {
            low: low - around,
            high: high + around,
        }
    }

    fn part(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Multiples of 1, 2 or 5 times a power of ten.
    fn marks(&self) -> Vec<f64> {
        let rough = (self.high - self.low) / MARKS;
        let power = 10.0_f64.powf(rough.log10().floor());
        let sizes = [1.0, 2.0, 5.0, 10.0].map(|size| size * power);
        let step = sizes
            .into_iter()
            .find(|size| *size >= rough)
            .unwrap_or(rough);
        let first = (self.low / step).ceil();
        let count = ((self.high / step).floor() - first).clamp(0.0, 2.0 * MARKS) as usize;
        (0..=count).map(|k| (first + k as f64) * step).collect()
    }
}

fn line([x, y, to_x, to_y]: [f64; 4]) -> String {
    format!("<path d=\"M{x:.2} {y:.2}L{to_x:.2} {to_y:.2}\" stroke=\"#ccc\"/>\n")
}

fn text([x, y]: [f64; 2], anchor: &str, words: &str) -> String {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    format!("<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{words}</text>\n")
}

/// Four digits, without the round-off of a multiple.
fn label(mark: f64) -> String {
    let size = mark.abs();
    if mark == 0.0 || (1e-3..1e5).contains(&size) {
        let rounded: f64 = format!("{mark:.3e}").parse().unwrap_or(mark);
        rounded.to_string()
    } else {
        format!("{mark:.1e}")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::report::Cell;

    fn table(rows: &[[f64; 2]]) -> Table {
        Table {
            columns: vec!["at".to_owned(), "normal".to_owned()],
            rows: rows
                .iter()
                .map(|row| row.map(Cell::Number).to_vec())
                .collect(),
        }
    }

    #[test]
    fn corners_of_the_data_are_corners_of_the_frame() {
        let drawing = plot(&table(&[[0.0, -1.0], [2.0, 3.0]]), "at", "normal").unwrap();
        assert!(
            drawing.contains("points=\"90.00,430.00 630.00,50.00\""),
            "{drawing}"
        );
        assert_eq!(drawing.matches(">0<").count(), 2);
    }

    #[test]
    fn marks_are_round_numbers_in_the_range() {
        let axis = Axis::new(&[0.13, 0.87]);
        let marks: Vec<String> = axis.marks().into_iter().map(label).collect();
        assert_eq!(marks, ["0.2", "0.4", "0.6", "0.8"]);
        assert!(Axis::new(&[5.0]).marks().contains(&5.0));
    }

    #[test]
    fn a_column_that_is_not_there_is_named_with_those_that_are() {
        let refused = plot(&table(&[[0.0, 1.0]]), "time", "normal")
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("no column `time`") && refused.contains("at"),
            "{refused}"
        );
        assert!(plot(&table(&[]), "at", "normal").is_err());
        assert!(plot(&table(&[[f64::NAN, 1.0]]), "at", "normal").is_err());
    }
}
