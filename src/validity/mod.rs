//! VALIDITY: what mesh and theory cannot give, said with numbers.
//!
//! The judge certifies the laws on the mesh as it is. What the mesh does not resolve, and what small
//! displacements leave out, no residual shows: it is looked for here, in what a solve has found anyway.
//!
//! | what | file |
//! |---|---|
//! | facets that turn too far, or stand off by as much as bodies approach (V1) | `facets` |
//! | one contact that carries all, sides in each other between contacts, deep obstacles, nothing that touches, a first step | `resolution` |
//! | facets that meet the same side in two contacts, contacts of two that have one motion | `stated_twice` |
//! | strain, rotation, slip and approach beyond small displacements | `small_displacement` |

mod facets;
mod resolution;
mod small_displacement;
mod stated_twice;

use crate::contact::ContactNode;
use crate::kkt::ContactStatus;
use crate::report::ReportParts;

/// What is in doubt about a solved scene, in words with numbers; nothing is said of one without
/// equilibrium.
#[must_use]
pub fn notes(parts: &ReportParts<'_>) -> Vec<String> {
    if parts.outcome.failure.is_some() {
        return Vec::new();
    }
    let mut notes = Vec::new();
    for (index, pair) in parts.pairs.iter().enumerate() {
        let pressed = pressed(parts, index);
        let straight = facets::facets(parts, index, &pressed);
        let between = || resolution::between_contacts(parts, index);
        let found = [
            resolution::single(parts, &pressed),
            resolution::beside_a_seam(parts, &pressed),
            straight.or_else(between),
            facets::corner(parts, index, &pressed),
            resolution::deep(parts, index),
            stated_twice::stated_twice(parts, index)
                .or_else(|| stated_twice::one_motion(parts, index)),
        ];
        let found = found.into_iter().flatten();
        notes.extend(found.map(|note| format!("{}: {note}", pair.place)));
    }
    notes.extend(resolution::nothing_touches(parts));
    notes.extend(resolution::first_step(parts));
    notes.extend(small_displacement::notes(parts));
    notes
}

/// Contacts of a pair that carry.
fn pressed<'a>(parts: &ReportParts<'a>, pair: usize) -> Vec<&'a ContactNode> {
    pressed_of(parts, pair)
        .map(|i| &parts.surface.nodes[i])
        .collect()
}

/// Their numbers.
fn pressed_of<'p>(parts: &'p ReportParts<'_>, pair: usize) -> impl Iterator<Item = usize> + 'p {
    let contacts = parts
        .surface
        .nodes
        .iter()
        .zip(&parts.outcome.verdict.status);
    let pressed = contacts.enumerate().filter(move |(_, (contact, status))| {
        contact.pair == pair && **status != ContactStatus::Open
    });
    pressed.map(|(i, _)| i)
}
