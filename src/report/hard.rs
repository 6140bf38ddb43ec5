//! Which of the hard cases ended as they should, as it is reported.

use std::fmt::Write;

use serde::Serialize;

use super::ReportedStatus;

/// A battery of cases that were built to break the method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HardCases {
    /// Every case ended as it should.
    pub passed: bool,
    /// Case by case.
    pub cases: Vec<HardCase>,
}

/// One of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HardCase {
    /// What makes it hard.
    pub family: &'static str,
    /// Which one.
    pub name: String,
    /// Number of contacts.
    pub contacts: usize,
    /// How it ended.
    pub status: ReportedStatus,
    /// The judge's residual of the state that was returned.
    pub residual: f64,
    /// Condition of the compliance; `null` if it is singular or was not needed.
    pub condition: Option<f64>,
    /// Sweeps of the outer loop.
    pub sweeps: usize,
    /// Newton steps.
    pub newton_steps: usize,
    /// Time of the outer loop alone, in second.
    pub contact_seconds: f64,
    /// Time in all, in second.
    pub seconds: f64,
    /// What did not hold, in words; empty if it ended as it should.
    pub missed: Vec<String>,
}

impl HardCases {
    /// Counts the cases that passed.
    #[must_use]
    pub fn new(cases: Vec<HardCase>) -> Self {
        let passed = cases.iter().all(HardCase::passes);
        Self { passed, cases }
    }

    /// The battery as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain structs with string keys: there is nothing that could fail to serialise.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// How many passed, family by family, and those that did not.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = format!(
            "{:<22}{:>7}{:>7}{:>13}{:>8}{:>8}{:>10}\n",
            "family", "cases", "pass", "residual", "sweeps", "Newton", "seconds"
        );
        let mut rest = self.cases.as_slice();
        while let Some(first) = rest.first() {
            let count = rest.iter().take_while(|case| case.family == first.family);
            let (family, others) = rest.split_at(count.count());
            rest = others;
            let most = |of: fn(&HardCase) -> usize| family.iter().map(of).max().unwrap_or(0);
            let settled = family
                .iter()
                .filter(|case| case.status == ReportedStatus::Certified);
            let residual = settled.map(|case| case.residual).fold(0.0, f64::max);
            let seconds: f64 = family.iter().map(|case| case.seconds).sum();
            let _ = writeln!(
                text,
                "{:<22}{:>7}{:>7}{:>13}{:>8}{:>8}{seconds:>10.2}",
                first.family,
                family.len(),
                family.iter().filter(|case| case.passes()).count(),
                format!("<= {residual:.0e}"),
                format!("<= {}", most(|case| case.sweeps)),
                format!("<= {}", most(|case| case.newton_steps)),
            );
        }
        for case in self.cases.iter().filter(|case| !case.passes()) {
            text.push_str(&case.row());
            text.push('\n');
        }
        let passed = self.cases.iter().filter(|case| case.passes()).count();
        let _ = writeln!(text, "{passed} of {} cases pass", self.cases.len());
        text
    }
}

impl HardCase {
    fn passes(&self) -> bool {
        self.missed.is_empty()
    }

    /// Name, contacts, status, residual, sweeps, seconds, and what was missed.
    #[must_use]
    pub fn row(&self) -> String {
        let status = match self.status {
            ReportedStatus::Certified => "certified",
            ReportedStatus::NotConverged => "not converged",
            ReportedStatus::NoEquilibrium => "no equilibrium",
            ReportedStatus::CouplingFault => "coupling fault",
        };
        let verdict = match self.missed.is_empty() {
            true => "pass".to_owned(),
            false => format!("FAIL: {}", self.missed.join("; ")),
        };
        format!(
            "{}: {:<44}{:>6} {status:<15}{:>9.1e}{:>4} sw{:>5} nw{:>9.3} s  {verdict}",
            self.family,
            self.name,
            self.contacts,
            self.residual,
            self.sweeps,
            self.newton_steps,
            self.seconds
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_case_that_fails_fails_the_battery_and_is_named() {
        let case = |name: &str, missed: &[&str]| HardCase {
            family: "gap",
            name: name.to_owned(),
            contacts: 4,
            status: ReportedStatus::Certified,
            residual: 1e-15,
            condition: None,
            sweeps: 1,
            newton_steps: 2,
            contact_seconds: 0.1,
            seconds: 0.2,
            missed: missed.iter().map(|&what| what.to_owned()).collect(),
        };
        let good = HardCases::new(vec![case("none", &[]), case("far", &[])]);
        let said = good.summary();
        assert!(good.passed && said.contains("2 of 2 cases pass"), "{said}");
        let bad = HardCases::new(vec![
            case("far", &[]),
            case("small", &["no force off by 1"]),
        ]);
        assert!(!bad.passed && bad.summary().contains("FAIL: no force off by 1"));
    }
}
