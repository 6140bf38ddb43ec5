//! Amplitudes: by what a load is multiplied over time, linear between given points.

use std::collections::BTreeMap;

use super::statement::Stated;
use crate::error::Error;
use crate::mesh_file::abaqus::Card;

/// A table of factors over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Amplitude {
    /// Whether times count from the start of the deck, and not of the step.
    pub(super) total: bool,
    points: Vec<[f64; 2]>,
}

/// The amplitudes of a deck, by name.
pub(super) type Amplitudes = BTreeMap<String, Amplitude>;

/// Reads them all, wherever they stand.
pub(super) fn amplitudes(model: &[Stated<'_, '_>]) -> Result<Amplitudes, Error> {
    let mut found = Amplitudes::new();
    for (_, card) in model.iter().filter(|(_, card)| card.name == "AMPLITUDE") {
        let name = card.need("NAME")?.to_owned();
        if found.insert(name, Amplitude::read(card)?).is_some() {
            return Err(card.error("an amplitude of this name stands before"));
        }
    }
    Ok(found)
}

impl Amplitude {
    fn read(card: &Card<'_>) -> Result<Self, Error> {
        card.only(&["NAME", "TIME", "VALUE", "DEFINITION"])?;
        card.one_of("TIME", &["STEPTIME", "TOTALTIME"])?;
        card.one_of("VALUE", &["RELATIVE"])?;
        card.one_of("DEFINITION", &["TABULAR"])?;
        let mut numbers = Vec::new();
        for row in card.rows(0) {
            for word in row.words() {
                numbers.push(row.number_of(word, "a time or a factor")?);
            }
        }
        let (points, rest) = numbers.as_chunks::<2>();
        let rising = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if points.is_empty() || !rest.is_empty() || !rising {
            return Err(card.error("expected pairs of a time and a factor, at rising times"));
        }
        Ok(Self {
            total: card.get("TIME") == Some("TOTALTIME"),
            points: points.to_vec(),
        })
    }

    /// The same later by a time.
    pub(super) fn delayed(&self, by: f64) -> Self {
        let points = self
            .points
            .iter()
            .map(|[time, factor]| [time + by, *factor]);
        Self {
            points: points.collect(),
            ..*self
        }
    }

    /// The factor at a time.
    pub(super) fn at(&self, time: f64) -> f64 {
        let next = self.points.partition_point(|point| point[0] <= time);
        match (
            next.checked_sub(1).map(|at| self.points[at]),
            self.points.get(next),
        ) {
            (Some(before), Some(after)) => {
                let part = (time - before[0]) / (after[0] - before[0]);
                before[1] + part * (after[1] - before[1])
            }
            (Some([_, factor]), None) => factor,
            (None, first) => first.map_or(0.0, |point| point[1]),
        }
    }

    /// Its times inside an open interval.
    pub(super) fn times(&self, start: f64, end: f64) -> impl Iterator<Item = f64> {
        let times = self.points.iter().map(|point| point[0]);
        times.filter(move |time| start < *time && *time < end)
    }
}
