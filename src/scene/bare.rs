//! A bare condensed problem as JSON, in the convention of rigid-body codes.
//!
//! ```text
//! v = W r + q,   r_N ≥ 0 pressed,  v_N ≥ 0 opens,  ‖r_T‖ ≤ μ r_N        theirs
//! r_N = −t_N,    v_N = g₀ − u_N,   g₀ = 0,         G = D W D,  û = D q    ours, D = diag(−1, 1, 1, …)
//! ```

use faer::Mat;
use serde::Deserialize;

use super::json;
use crate::error::{Error, check_length};
use crate::problem::{ContactProblem, Operator};

/// Most unknowns of a problem: W is dense in memory, 3.2 GB there.
const MOST_UNKNOWNS: usize = 20_000;

/// A discrete frictional contact problem: contact-major, normal first.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BareProblem {
    /// Name for messages and tables.
    pub name: String,
    /// Where it comes from.
    pub source: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// The convention above, in words.
    pub convention: String,
    /// Rows of the entries of W, both triangles.
    pub w_rows: Vec<usize>,
    /// Columns of the entries of W.
    pub w_cols: Vec<usize>,
    /// Entries of W; entries at one place add up.
    pub w_values: Vec<f64>,
    /// Velocity or displacement without contact.
    pub q: Vec<f64>,
    /// Coefficient of friction per contact.
    pub mu: Vec<f64>,
    /// A reaction that solves the problem, where one is published.
    pub reference_reaction: Option<Vec<f64>>,
    /// What is to be known of it.
    pub reference_note: Option<String>,
}

impl BareProblem {
    /// Reads a problem; `name` stands for the file in messages.
    ///
    /// # Errors
    ///
    /// Text that is no such problem, with line and column.
    pub fn from_json(text: &str, name: &str) -> Result<Self, Error> {
        json::parse(text, name)
    }

    /// The same with `(W + Wᵀ)/2` in place of W: for matrices that are symmetric but for the rounding of the code
    /// that wrote them. What is solved and judged then is that problem; where W is not symmetric by its mechanics,
    /// it is another.
    ///
    /// ```
    /// # use dpana::scene::BareProblem;
    /// let bare = r#"{"name": "rounded", "source": "", "dimension": 2, "contacts": 1, "convention": "",
    ///     "w_rows": [0, 1, 0, 1], "w_cols": [0, 1, 1, 0], "w_values": [1, 1, 0.5, 0.5000001],
    ///     "q": [-1, 0], "mu": [0.5]}"#;
    /// let bare = BareProblem::from_json(bare, "")?;
    /// let refused = bare.to_problem().unwrap_err().to_string();
    /// assert!(refused.contains("not symmetric by 1.0e-7 of its largest entry"));
    /// assert!(bare.symmetrised().to_problem().is_ok());
    /// # Ok::<(), dpana::Error>(())
    /// ```
    #[must_use]
    pub fn symmetrised(&self) -> Self {
        let mut half = self.clone();
        half.w_rows.extend(&self.w_cols);
        half.w_cols.extend(&self.w_rows);
        half.w_values.extend(&self.w_values);
        half.w_values.iter_mut().for_each(|w| *w *= 0.5);
        half
    }

    /// The problem in our signs.
    ///
    /// # Errors
    ///
    /// Arrays that do not fit together, more than 20,000 unknowns, and all that [`Operator::from_compliance`] and
    /// [`ContactProblem::new`] refuse.
    pub fn to_problem(&self) -> Result<ContactProblem, Error> {
        if !(2..=3).contains(&self.dimension) {
            return Err(Error::OutOfRange {
                place: "dimension".into(),
                value: self.dimension as f64,
                accepted: "2 or 3",
            });
        }
        let unknowns = self.unknowns()?;
        check_length("q", unknowns, self.q.len())?;
        check_length("w_rows", self.w_values.len(), self.w_rows.len())?;
        check_length("w_cols", self.w_values.len(), self.w_cols.len())?;
        let sign = |unknown: usize| {
            if unknown.is_multiple_of(self.dimension) {
                -1.0
            } else {
                1.0
            }
        };
        let mut compliance = Mat::zeros(unknowns, unknowns);
        for ((&i, &j), w) in self.w_rows.iter().zip(&self.w_cols).zip(&self.w_values) {
            if i.max(j) >= unknowns {
                return Err(Error::OutOfRange {
                    place: "w_rows, w_cols".into(),
                    value: i.max(j) as f64,
                    accepted: "an index below contacts × dimension",
                });
            }
            compliance[(i, j)] += sign(i) * w * sign(j);
        }
        ContactProblem::new(
            &vec![self.dimension - 1; self.contacts],
            self.mu.clone(),
            vec![0.0; self.contacts],
            self.q
                .iter()
                .enumerate()
                .map(|(i, q)| sign(i) * q)
                .collect(),
            Operator::from_compliance(compliance)?,
        )
    }

    fn unknowns(&self) -> Result<usize, Error> {
        let unknowns = self.contacts.checked_mul(self.dimension);
        unknowns
            .filter(|&unknowns| unknowns <= MOST_UNKNOWNS)
            .ok_or_else(|| Error::OutOfRange {
                place: "contacts".into(),
                value: self.contacts as f64,
                accepted: "contacts × dimension <= 20000",
            })
    }
}
