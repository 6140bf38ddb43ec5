//! A parameter that was found, as it is reported.

use serde::Serialize;

use super::digits::number;

/// The value of a parameter at which a total is what was asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Found {
    /// Name of the parameter.
    pub parameter: String,
    /// Its value.
    pub value: f64,
    /// Name of the total.
    pub total: String,
    /// What it should be.
    pub target: f64,
    /// What it is.
    pub reached: f64,
    /// What it gains per unit of the parameter there; `null` where it has no derivative.
    pub derivative: Option<f64>,
    /// States that were solved.
    pub states: usize,
}

impl Found {
    /// As the summary says it.
    #[must_use]
    pub fn words(&self) -> String {
        let slope = self.derivative.map_or_else(String::new, |slope| {
            format!(", and changes by {} per unit", number(slope))
        });
        format!(
            "{} = {} makes {} {}{slope} ({} states)",
            self.parameter,
            number(self.value),
            self.total,
            number(self.reached),
            self.states
        )
    }
}
