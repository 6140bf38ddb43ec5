//! What a reader of the numbers should know about the contact surface.

use super::ReportParts;
use crate::kkt::ContactStatus;

/// How many nodes a note names before it only counts them.
const NAMED: usize = 5;

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
        .map(|(contact, _)| (contact.body, contact.node))
        .collect();
    for nodes in named_by_body(parts, &at_rim) {
        notes.push(format!(
            "{nodes}: contact reaches the rim of the assumed contact surface; enlarge \
             it, the true contact may go on beyond"
        ));
    }
    notes
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
    fn a_few_nodes_are_named_and_many_are_counted() {
        assert_eq!(named(&[4]), "node 4");
        assert_eq!(named(&[4, 7]), "nodes 4, 7");
        assert_eq!(named(&[0, 1, 2, 3, 4, 5]), "6 nodes (0, 1, 2, 3, 4, ...)");
    }
}
