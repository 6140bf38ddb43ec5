//! What acts on a body, and what comes of it where no contact does.
//!
//! ```text
//! (C5)   L y = P Qᵀ (f − K u_p),   v̂ = L_cc⁻ᵀ y_c             u_p: prescribed displacement
//! ```

/// Load and given displacements of a body, and its answer (C5).
#[derive(Clone, Debug)]
pub(super) struct Action {
    /// f per degree of freedom, in newton.
    pub(super) load: Vec<f64>,
    /// u_p per degree of freedom, in metre; `None` where free.
    pub(super) prescribed: Vec<Option<f64>>,
    /// y.
    pub(super) half_solved: Vec<f64>,
    /// v̂ per interface unknown, in metre.
    pub(super) free_displacement: Vec<f64>,
}

impl Action {
    /// Adds a multiple of another action on the same body: (C5) is linear.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        let add = |sum: &mut [f64], part: &[f64]| {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += factor * part;
            }
        };
        add(&mut self.load, &other.load);
        add(&mut self.half_solved, &other.half_solved);
        add(&mut self.free_displacement, &other.free_displacement);
        for (sum, part) in self.prescribed.iter_mut().zip(&other.prescribed) {
            if let (Some(sum), Some(part)) = (sum, part) {
                *sum += factor * part;
            }
        }
    }
}
