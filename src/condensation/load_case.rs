//! What acts on a body, and what comes of it where no contact does.
//!
//! ```text
//! (C5)   L y = P Qᵀ (f − K u_p),   v̂ = L_cc⁻ᵀ y_c             u_p: prescribed displacement
//! (C27)  L y = P Qᵀ Tᵀ (f − K E b)                            where displacements depend on others (B17)
//! ```

use crate::body::{Dependence, Source};

/// Load and given displacements of a body, and its answer (C5).
#[derive(Clone, Debug)]
pub(super) struct Action {
    /// f per degree of freedom, in newton.
    pub(super) load: Vec<f64>,
    /// u_p per degree of freedom, in metre; `None` where free.
    pub(super) prescribed: Vec<Option<f64>>,
    /// b and `E b` of (B17), in metre; empty where no displacement depends on others.
    pub(super) values: Vec<f64>,
    pub(super) constant: Vec<f64>,
    /// y.
    pub(super) half_solved: Vec<f64>,
    /// v̂ per interface unknown, in metre.
    pub(super) free_displacement: Vec<f64>,
}

/// Given displacements of a body, in metre.
#[derive(Clone, Debug, Default)]
pub(super) struct Given {
    /// u_p per degree of freedom; `None` where free.
    pub(super) prescribed: Vec<Option<f64>>,
    /// b of (B17); empty where no displacement depends on others.
    pub(super) values: Vec<f64>,
}

impl Given {
    /// What the equations of a body give, as far as some of their sources act.
    pub(super) fn of(dependence: &Dependence, acts: impl Fn(Source) -> bool) -> Self {
        let values = dependence.values(|by| f64::from(u8::from(acts(by))));
        Self {
            prescribed: dependence.given(&values),
            values,
        }
    }
}

impl Action {
    /// The part of a displacement that is given, in metre.
    pub(super) fn given(&self, dof: usize) -> f64 {
        let constant = self.constant.get(dof).copied();
        constant.or(self.prescribed[dof]).unwrap_or_default()
    }

    /// Adds a multiple of another action on the same body: (C5) is linear.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        let add = |sum: &mut [f64], part: &[f64]| {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += factor * part;
            }
        };
        add(&mut self.load, &other.load);
        add(&mut self.values, &other.values);
        add(&mut self.constant, &other.constant);
        add(&mut self.half_solved, &other.half_solved);
        add(&mut self.free_displacement, &other.free_displacement);
        for (sum, part) in self.prescribed.iter_mut().zip(&other.prescribed) {
            if let (Some(sum), Some(part)) = (sum, part) {
                *sum += factor * part;
            }
        }
    }
}
