//! What a reader of the numbers should know about the contact surface.

use super::ReportParts;
use crate::kkt::ContactStatus;

/// How many nodes a note names before it only counts them.
const NAMED: usize = 5;

/// Round-off times condition from which a note says so, as a part of the reaction.
const UNCERTAIN: f64 = 1e-8;

/// Notes on the contact surface, after those that the scene's own stages made.
pub(super) fn notes(parts: &ReportParts<'_>) -> Vec<String> {
    let mut notes = parts.notes.to_vec();
    for nodes in named_by_body(parts, &parts.surface.left_out) {
        notes.push(format!(
            "{nodes}: no contact here, a support holds the normal displacement"
        ));
    }
    let contacts = parts
        .surface
        .nodes
        .iter()
        .zip(&parts.outcome.verdict.status);
    let at_rim: Vec<(usize, usize)> = contacts
        .filter(|(contact, status)| contact.rim && **status != ContactStatus::Open)
        // What is tied ends where it is said to.
        .filter(|(contact, _)| {
            !parts
                .pairs
                .get(contact.pair)
                .is_some_and(|pair| pair.law.bilateral)
        })
        .map(|(contact, _)| (contact.body, contact.node))
        .collect();
    for nodes in named_by_body(parts, &at_rim) {
        notes.push(format!(
            "{nodes}: contact reaches the rim of the assumed contact surface; enlarge \
             it, the true contact may go on beyond"
        ));
    }
    notes.extend(parts.outcome.condition.and_then(uncertain));
    notes
}

/// What a large condition of the compliance does to single reactions.
fn uncertain(condition: f64) -> Option<String> {
    if condition.is_infinite() {
        return Some(
            "forces of single contacts are not unique, as the bodies cannot tell some contacts \
             apart; their sums and all displacements are"
                .to_owned(),
        );
    }
    let digits = condition * f64::EPSILON;
    (digits > UNCERTAIN).then(|| {
        format!(
            "ill-conditioned ({condition:.0e}): forces of single contacts are certain to a part in \
             {:.0e} of the largest, sums and displacements to more",
            digits.recip()
        )
    })
}

/// Nodes in words, body by body; the body's name only says something beside another body.
fn named_by_body(parts: &ReportParts<'_>, nodes: &[(usize, usize)]) -> Vec<String> {
    let mut words = Vec::new();
    for (index, body) in parts.bodies.iter().enumerate() {
        let of_body = nodes.iter().filter(|(body, _)| *body == index);
        let of_body: Vec<usize> = of_body.map(|&(_, node)| node).collect();
        match (of_body.is_empty(), parts.bodies.len()) {
            (true, _) => {}
            (false, 1) => words.push(named(&of_body)),
            (false, _) => words.push(format!("body `{}`, {}", body.name, named(&of_body))),
        }
    }
    words
}

/// `node 4`, `nodes 4, 7` or `12 nodes (1, 2, 3, 4, 5, ...)`, counted from 0.
fn named(nodes: &[usize]) -> String {
    let shown: Vec<String> = nodes.iter().take(NAMED).map(usize::to_string).collect();
    let shown = shown.join(", ");
    match nodes.len() {
        1 => format!("node {shown}"),
        count if count <= NAMED => format!("nodes {shown}"),
        count => format!("{count} nodes ({shown}, ...)"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_condition_takes_of_the_digits_is_said() {
        assert_eq!(uncertain(1e6), None);
        // 2.2e-16 · 1e10 = 2.2e-6: one part in 4.5e5.
        assert!(uncertain(1e10).is_some_and(|note| note.contains("a part in 5e5")));
        assert!(uncertain(f64::INFINITY).is_some_and(|note| note.contains("not unique")));
    }

    #[test]
    fn a_few_nodes_are_named_and_many_are_counted() {
        assert_eq!(named(&[4]), "node 4");
        assert_eq!(named(&[4, 7]), "nodes 4, 7");
        assert_eq!(named(&[0, 1, 2, 3, 4, 5]), "6 nodes (0, 1, 2, 3, 4, ...)");
    }
}
