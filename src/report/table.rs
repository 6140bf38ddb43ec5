//! Totals of many states: a row per load step or per case.

use std::borrow::Cow;

use serde::Serialize;
use serde_json::Value;

use super::Report;

/// An entry of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A number; one that is not finite is written as nothing.
    Number(f64),
    /// A count.
    Count(usize),
    /// A word.
    Word(Cow<'static, str>),
}

/// Rows under named columns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Table {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows, an entry per column.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// Appends the totals of a report, behind `given` values; all of one table have the same.
    pub fn push(&mut self, given: &[(String, Cell)], report: &Report) {
        self.add(given.iter().cloned().chain(totals(report)));
    }

    /// Appends a row of named entries; all of one table have the same names.
    pub(crate) fn add(&mut self, row: impl IntoIterator<Item = (String, Cell)>) {
        let (columns, row) = row.into_iter().unzip();
        self.columns = columns;
        self.rows.push(row);
    }

    /// Appends the rows of a table that has the same columns, or of the first one.
    pub(crate) fn append(&mut self, other: Self) {
        self.columns = other.columns;
        self.rows.extend(other.rows);
    }

    /// Values of a column; those that are no numbers are NaN. None if there is no such column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.columns.iter().position(|column| column == name)?;
        let numbers = self.rows.iter().map(|row| match row.get(at) {
            Some(Cell::Number(value)) => *value,
            Some(Cell::Count(count)) => *count as f64,
            Some(Cell::Word(_)) | None => f64::NAN,
        });
        Some(numbers.collect())
    }

    /// Reads a table that was written as CSV or JSON; none where the text is no such table.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let table = match text.starts_with('{') {
            true => Self::of_json(text)?,
            false => Self::of_csv(text)?,
        };
        let width = table.columns.len();
        let whole = table.rows.iter().all(|row| row.len() == width);
        whole.then_some(table)
    }

    fn of_csv(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let columns = entries(lines.next()?);
        let rows = lines.map(|line| {
            entries(line)
                .iter()
                .map(|entry| Cell::of_text(entry))
                .collect()
        });
        Some(Self {
            columns,
            rows: rows.collect(),
        })
    }

    fn of_json(text: &str) -> Option<Self> {
        let read: Value = serde_json::from_str(text).ok()?;
        let columns = read.get("columns")?.as_array()?.iter();
        let columns = columns.map(|name| name.as_str().map(str::to_owned));
        let rows = read.get("rows")?.as_array()?.iter();
        let rows = rows.map(|row| Some(row.as_array()?.iter().map(Cell::of_value).collect()));
        Some(Self {
            columns: columns.collect::<Option<_>>()?,
            rows: rows.collect::<Option<_>>()?,
        })
    }

    /// The table as comma-separated values, every number with all its digits; names and words that hold a
    /// comma or a quotation mark stand in quotation marks (RFC 4180).
    #[must_use]
    pub fn to_csv(&self) -> String {
        let columns: Vec<String> = self.columns.iter().map(|name| quoted(name)).collect();
        let mut text = columns.join(",") + "\n";
        for row in &self.rows {
            let entries: Vec<String> = row.iter().map(|cell| quoted(&cell.text())).collect();
            text += &(entries.join(",") + "\n");
        }
        text
    }

    /// The table as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

/// An entry as it stands in a line; lines are not broken.
fn quoted(entry: &str) -> String {
    let entry = entry.replace(['\n', '\r'], " ");
    match entry.contains([',', '"']) {
        true => format!("\"{}\"", entry.replace('"', "\"\"")),
        false => entry,
    }
}

/// The entries of a line, as [`quoted`] wrote them.
fn entries(line: &str) -> Vec<String> {
    let (mut entries, mut inside) = (vec![String::new()], false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        let Some(entry) = entries.last_mut() else {
            break;
        };
        match letter {
            '"' if inside && letters.peek() == Some(&'"') => {
                letters.next();
                entry.push('"');
            }
            '"' => inside = !inside,
            ',' if !inside => entries.push(String::new()),
            letter => entry.push(letter),
        }
    }
    entries
}

impl Cell {
    fn text(&self) -> String {
        match self {
            Self::Number(value) if value.is_finite() => format!("{value:?}"),
            Self::Number(_) => String::new(),
            Self::Count(count) => count.to_string(),
            Self::Word(word) => word.to_string(),
        }
    }

    /// Reads what [`text`](Self::text) writes.
    fn of_text(text: &str) -> Self {
        match (text, text.parse(), text.parse()) {
            ("", ..) => Self::Number(f64::NAN),
            (_, Ok(count), _) => Self::Count(count),
            (_, Err(_), Ok(number)) => Self::Number(number),
            (word, Err(_), Err(_)) => Self::Word(Cow::Owned(word.to_owned())),
        }
    }

    /// Reads what is serialised.
    fn of_value(value: &Value) -> Self {
        match value {
            Value::Number(number) => Self::of_text(&number.to_string()),
            Value::String(word) => Self::Word(Cow::Owned(word.clone())),
            _ => Self::Number(f64::NAN),
        }
    }
}

/// What a table tells of a state.
fn totals(report: &Report) -> impl Iterator<Item = (String, Cell)> {
    let (totals, number) = (&report.totals, |name: &str, value| {
        (name.to_owned(), Cell::Number(value))
    });
    let count = |name: &str, value| (name.to_owned(), Cell::Count(value));
    let vector = |name: &'static str, components: &[f64]| {
        let axes = ["x", "y", "z"].into_iter().zip(components.to_vec());
        axes.map(move |(axis, value)| (format!("{name}_{axis}"), Cell::Number(value)))
            .collect::<Vec<_>>()
    };
    let mut row = vec![("status".to_owned(), Cell::Word(report.status.word().into()))];
    row.extend([
        number("natural_map", report.certificate.natural_map),
        count("open", totals.open),
        count("stick", totals.stick),
        count("slip", totals.slip),
        number("normal", totals.normal),
    ]);
    row.extend(vector("friction", &totals.friction));
    row.extend(vector("contact_force", &totals.contact_force));
    row.extend([
        number("contact_area", totals.contact_area),
        number("slip_area", totals.slip_area),
        number("peak_pressure", totals.peak_pressure),
        number(
            "least_gap",
            extreme(report, |contact| contact.gap, f64::min),
        ),
        number(
            "largest_gap",
            extreme(report, |contact| contact.gap, f64::max),
        ),
        number(
            "largest_slip",
            extreme(report, |contact| length(&contact.slip), f64::max),
        ),
        count("sweeps", report.work.sweeps),
        count("newton_steps", report.work.newton_steps),
        count("factorisations", report.work.factorisations),
    ]);
    row.extend(report.bolts.iter().flat_map(|bolt| {
        let of = [("force", bolt.force), ("shortening", bolt.shortening)];
        of.map(|(what, value)| number(&format!("{what} {}", bolt.name), value))
    }));
    if let Some(step) = &report.step {
        row.extend([
            number("work_of_loads", step.total.loads),
            number("work_of_supports", step.total.supports),
            number("work_of_obstacles", step.total.obstacles),
            number("work_of_fits", step.total.fits),
            number("elastic_energy", step.total.elastic),
            number("dissipation", step.total.dissipation),
            number("closure", step.total.closure),
            count("parts", step.halving.map_or(1, |halving| halving.parts)),
            number(
                "halving",
                step.halving.map_or(f64::NAN, |halving| halving.dissipation),
            ),
        ]);
    }
    let derivatives = report.sensitivity.iter().flat_map(|sensitivity| {
        let of = sensitivity.derivatives.iter();
        of.map(|derivative| {
            let name = format!("d({})/d({})", derivative.of, sensitivity.parameter);
            (name, Cell::Number(derivative.growing))
        })
    });
    row.extend(derivatives);
    row.into_iter()
}

fn extreme(
    report: &Report,
    value: impl Fn(&super::Contact) -> f64,
    of_two: fn(f64, f64) -> f64,
) -> f64 {
    let values = report.contacts.iter().map(value);
    values.reduce(of_two).unwrap_or(f64::NAN)
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0, |size: f64, u| size.hypot(*u))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_table_that_was_written_is_read_to_the_last_digit() {
        let numbers = [0.1 + 0.2, -0.0, 5e-324, 3.0, f64::MAX, -1e-7];
        let row = |number| {
            let word = Cell::Word(Cow::Borrowed("certified"));
            vec![Cell::Number(number), Cell::Count(3), word]
        };
        let mut table = Table {
            columns: ["at", "open", "status"].map(str::to_owned).to_vec(),
            rows: numbers.map(row).to_vec(),
        };
        assert_eq!(Table::read(&table.to_csv()).unwrap(), table);
        assert_eq!(Table::read(&table.to_json()).unwrap(), table);
        // Nothing is written for what is not finite.
        table.rows.push(row(f64::NAN));
        for text in [table.to_csv(), table.to_json()] {
            assert!(Table::read(&text).unwrap().column("at").unwrap()[6].is_nan());
        }
    }

    #[test]
    fn names_and_words_with_commas_stay_one_entry() {
        // "plain, inexact" is a loop of studies.
        let words = ["plain, inexact", "said \"so\"", "certified"];
        let table = Table {
            columns: vec!["a, b".to_owned(), "c".to_owned(), "d".to_owned()],
            rows: vec![words.map(|word| Cell::Word(Cow::Borrowed(word))).to_vec()],
        };
        let text = table.to_csv();
        assert_eq!(
            text,
            "\"a, b\",c,d\n\"plain, inexact\",\"said \"\"so\"\"\",certified\n"
        );
        assert_eq!(Table::read(&text).unwrap(), table);
    }

    #[test]
    fn text_that_is_no_table_is_not_read() {
        for text in ["", "a,b\n1\n", "{", "{\"columns\": [1], \"rows\": []}"] {
            assert_eq!(Table::read(text), None, "{text}");
        }
    }
}
