//! What every support carries.

use super::body_state::BodyState;
use super::tied::TieForces;
use crate::body::Source;
use crate::error::Error;

/// Contact forces and support reactions s (K4) on a body, per unknown, in newton: what contacts of its own
/// nodes and of surfaces that it stands opposite to give it, and what holds it.
///
/// # Errors
///
/// Those of [`balance`](super::balance()).
pub(crate) fn nodal_forces(state: &BodyState<'_>) -> Result<[Vec<f64>; 2], Error> {
    state.check()?;
    let contact = state.contact_forces();
    let held = state.held_reactions(&contact);
    Ok([contact, held])
}

/// Sum of the support reactions s (K4) of every support of a body on it, in newton, in global axes.
/// A displacement that several supports give is carried by the first of them.
///
/// # Errors
///
/// Those of [`balance`](super::balance()).
pub(crate) fn support_forces(state: &BodyState<'_>) -> Result<Vec<[f64; 3]>, Error> {
    state.check()?;
    let supports = &state.body.supports;
    if supports.is_empty() {
        return Ok(Vec::new());
    }
    let axes = state.dimension();
    if !state.equations.is_empty() {
        let reactions = state.support_reactions(&state.contact_forces());
        let forces = TieForces::new(state, &reactions);
        let sums = (0..supports.len()).map(|index| {
            let mut sum = [0.0; 3];
            forces.visit(state, Source::Support(index), |unknown, force| {
                sum[unknown % axes] += force;
            });
            sum
        });
        return Ok(sums.collect());
    }
    let mut reactions = state.held_reactions(&state.contact_forces());
    let sums = supports.iter().map(|support| {
        let mut sum = [0.0; 3];
        for &node in &support.nodes {
            for axis in (0..axes).filter(|axis| support.displacement[*axis].is_some()) {
                sum[axis] += std::mem::take(&mut reactions[node * axes + axis]);
            }
        }
        sum
    });
    Ok(sums.collect())
}
