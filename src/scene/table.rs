//! Tables over the instants of a load history.

use crate::error::{Error, check_finite, check_length};

/// Values over rising instants, linear between them and constant outside.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// Instant first, then the values.
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Checks the rows of a table of `values` columns behind the instants.
    pub(super) fn new(place: &str, rows: &[Vec<f64>], values: usize) -> Result<Self, Error> {
        if rows.is_empty() {
            return Err(Error::Empty {
                place: place.to_owned(),
            });
        }
        for (number, row) in rows.iter().enumerate() {
            let place = format!("{place}[{number}]");
            check_length(&place, 1 + values, row.len())?;
            check_finite(&place, row)?;
            if number > 0 && rows[number - 1][0] >= row[0] {
                return Err(Error::OutOfRange {
                    place: format!("{place}[0]"),
                    value: row[0],
                    accepted: "an instant after that of the row before",
                });
            }
        }
        Ok(Self {
            rows: rows.to_vec(),
        })
    }

    /// The values at an instant.
    pub(super) fn at(&self, instant: f64) -> Vec<f64> {
        let next = self.rows.partition_point(|row| row[0] <= instant);
        match (
            next.checked_sub(1).map(|k| &self.rows[k]),
            self.rows.get(next),
        ) {
            (Some(before), Some(after)) => {
                let part = (instant - before[0]) / (after[0] - before[0]);
                let pairs = before[1..].iter().zip(&after[1..]);
                pairs.map(|(a, b)| a + part * (b - a)).collect()
            }
            (Some(only), None) | (None, Some(only)) => only[1..].to_vec(),
            (None, None) => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn refused(rows: &[Vec<f64>]) -> String {
        Table::new("steps.factors.x", rows, 1)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn values_are_linear_between_rows_and_constant_outside() {
        let table = Table::new("", &[vec![1.0, 10.0], vec![3.0, 20.0]], 1).unwrap();
        let found = [0.0, 1.0, 1.5, 3.0, 4.0].map(|instant| table.at(instant)[0]);
        assert_eq!(found, [10.0, 10.0, 12.5, 20.0, 20.0]);
    }

    #[test]
    fn rows_that_are_no_table_are_refused_by_place() {
        assert!(refused(&[]).contains("steps.factors.x: empty"));
        let unsorted = refused(&[vec![1.0, 0.0], vec![1.0, 1.0]]);
        assert!(unsorted.contains("steps.factors.x[1][0]: 1 is not accepted"));
        assert!(refused(&[vec![1.0, f64::NAN]]).contains("NaN is not a finite number"));
        assert!(refused(&[vec![1.0]]).contains("expected 2 entries, found 1"));
    }
}
