//! Room for the condensed problem: its compliance is dense.

use crate::contact::ContactSurface;
use crate::error::Error;

/// The compliance G, the matrix of a Newton step on it, and what half-steps hold.
const MATRICES: usize = 3;

/// Bytes that any machine has.
const MODEST: usize = 1 << 30;

/// Bytes that the dense matrices of a contact surface take: those of n unknowns are n × n.
///
/// # Errors
///
/// [`Error::NoRoom`] where the machine refuses one of them.
pub(crate) fn dense_bytes(surface: &ContactSurface) -> Result<usize, Error> {
    let unknowns = surface.nodes.iter().map(|contact| 1 + contact.tangents);
    room(surface.nodes.len(), unknowns.sum())
}

fn room(contacts: usize, unknowns: usize) -> Result<usize, Error> {
    let refused = || Error::NoRoom {
        contacts,
        unknowns,
        gigabytes: MATRICES as f64 * (unknowns as f64).powi(2) * 8e-9,
    };
    let entries = unknowns.checked_mul(unknowns).ok_or_else(refused)?;
    let bytes = entries.checked_mul(8).ok_or_else(refused)?;
    // Asked for and given back untouched, which costs nothing.
    if bytes > MODEST && Vec::<f64>::new().try_reserve_exact(entries).is_err() {
        return Err(refused());
    }
    bytes.checked_mul(MATRICES).ok_or_else(refused)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_no_machine_has_is_refused_before_it_is_needed() {
        assert_eq!(room(961, 2883), Ok(3 * 8 * 2883 * 2883));
        // A million contacts in 3D: 72 terabytes a matrix; then more than can be counted.
        let refused = room(1_000_000, 3_000_000).unwrap_err().to_string();
        assert!(refused.contains("takes 216000.0 GB"), "{refused}");
        assert!(room(1 << 40, 1 << 40).is_err());
    }
}
