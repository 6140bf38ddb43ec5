//! Sections of MSH 2.2: an element carries its physical group.

use super::super::elements::{Contents, Element, MOST_NODES, Shape};
use super::fields::Fields;
use super::lines::Lines;
use crate::error::Error;

/// Reads lines `tag x y z`.
pub(super) fn nodes(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let mut head = lines.fields(&"the number of nodes")?;
    let count: usize = head.size("number of nodes")?;
    lines.close(head)?;
    // Grows with what is really there: the announced count may be absurd.
    let mut listed = Vec::new();
    for at in 0..count {
        let mut fields = lines.record(&format_args!("node {} of {count}", at + 1))?;
        listed.push((fields.int::<u64>("node tag")?, fields.position()?));
        lines.close(fields)?;
    }
    contents.keep_nodes(listed, lines)
}

/// Reads the elements, in a binary file in blocks of one shape.
///
/// ```text
/// ASCII:   tag type n tag₁ … tagₙ nodes, where tag₁ is the physical group (0: none)
/// binary:  type count n, then count times: tag tag₁ … tagₙ nodes
/// ```
pub(super) fn elements(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let mut head = lines.fields(&"the number of elements")?;
    let count: usize = head.size("number of elements")?;
    lines.close(head)?;
    let mut elements = Vec::new();
    while elements.len() < count {
        let of = format_args!("element {} of {count}", elements.len() + 1);
        let mut fields = lines.record(&of)?;
        if lines.binary() {
            let block = block(&mut fields, lines)?;
            lines.close(fields)?;
            let room = count - elements.len();
            if block.count > room {
                return Err(lines.error(format!(
                    "a block of {} elements where the announced count leaves {room}",
                    block.count
                )));
            }
            for _ in 0..block.count {
                let mut fields = lines.record(&"")?;
                fields.int::<i32>("element tag")?;
                let element = element(&mut fields, &block, lines, contents)?;
                elements.push(element);
                lines.close(fields)?;
            }
        } else {
            fields.int::<u64>("element tag")?;
            let (shape, nodes) = shape(&mut fields, lines)?;
            let tags = fields.int("number of tags")?;
            let alone = Block {
                shape,
                nodes,
                count: 1,
                tags,
            };
            let element = element(&mut fields, &alone, lines, contents)?;
            elements.push(element);
            lines.close(fields)?;
        }
    }
    contents.keep_elements(elements, lines)
}

/// Elements of one shape with as many tags each.
struct Block {
    shape: Shape,
    /// Number of nodes of the shape.
    nodes: usize,
    count: usize,
    tags: usize,
}

fn shape(fields: &mut Fields<'_>, lines: &Lines<'_>) -> Result<(Shape, usize), Error> {
    Shape::from_type(fields.int("element type")?).map_err(|reason| lines.error(reason))
}

/// Reads the head of a block of a binary file.
fn block(fields: &mut Fields<'_>, lines: &Lines<'_>) -> Result<Block, Error> {
    let (shape, nodes) = shape(fields, lines)?;
    Ok(Block {
        shape,
        nodes,
        count: fields.int("number of elements")?,
        tags: fields.int("number of tags")?,
    })
}

/// Reads the tags and nodes of an element.
fn element(
    fields: &mut Fields<'_>,
    block: &Block,
    lines: &Lines<'_>,
    contents: &mut Contents,
) -> Result<Element, Error> {
    let mut physical = 0;
    for tag in 0..block.tags {
        let value: i32 = fields.int("element's group or entity")?;
        if tag == 0 {
            physical = value;
        }
    }
    let mut slots = [u32::MAX; MOST_NODES];
    for slot in &mut slots[..block.nodes] {
        *slot = contents.node(fields.int("node tag")?, lines)?;
    }
    if physical != 0 {
        contents
            .groups_of_entity
            .entry((block.shape.dimension(), physical))
            .or_insert_with(|| vec![physical.unsigned_abs()]);
    }
    Ok(Element {
        place: lines.place(),
        shape: block.shape,
        entity: physical,
        count: block.nodes,
        slots,
    })
}
