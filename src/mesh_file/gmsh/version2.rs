//! Sections of MSH 2.2: an element carries its physical group.

use super::contents::{Contents, Element, MOST_NODES, Shape};
use super::lines::Lines;
use crate::error::Error;

/// Reads lines `tag x y z`.
pub(super) fn nodes(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let mut head = lines.fields(&"the number of nodes")?;
    let count: usize = head.integer("number of nodes")?;
    head.end()?;
    // Grows with what is really there: the announced count may be absurd.
    let mut listed = Vec::new();
    for at in 0..count {
        let mut fields = lines.fields(&format_args!("node {} of {count}", at + 1))?;
        listed.push((fields.integer("node tag")?, fields.position()?));
        fields.end()?;
    }
    contents.keep_nodes(listed, lines)
}

/// Reads lines `tag type n tag₁ … tagₙ nodes`, where tag₁ is the physical group (0: none).
pub(super) fn elements(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let mut head = lines.fields(&"the number of elements")?;
    let count: usize = head.integer("number of elements")?;
    head.end()?;
    let mut elements = Vec::new();
    for at in 0..count {
        let mut fields = lines.fields(&format_args!("element {} of {count}", at + 1))?;
        fields.integer::<u64>("element tag")?;
        let (shape, nodes) =
            Shape::from_type(fields.integer("element type")?).map_err(|e| lines.error(e))?;
        let tags: usize = fields.integer("number of tags")?;
        let mut physical = 0;
        for tag in 0..tags {
            let value: i32 = fields.integer("element's group or entity")?;
            if tag == 0 {
                physical = value;
            }
        }
        let mut slots = [u32::MAX; MOST_NODES];
        for slot in &mut slots[..nodes] {
            *slot = contents.node(fields.integer("node tag")?, lines)?;
        }
        fields.end()?;
        if physical != 0 {
            contents
                .groups_of_entity
                .entry((shape.dimension(), physical))
                .or_insert_with(|| vec![physical.unsigned_abs()]);
        }
        elements.push(Element {
            line: lines.number(),
            shape,
            entity: physical,
            count: nodes,
            slots,
        });
    }
    contents.keep_elements(elements, lines)
}
