//! Sections of MSH 4.1: blocks of nodes and elements per geometric entity.

use super::super::elements::{Contents, Element, MOST_NODES, Shape};
use super::fields::Fields;
use super::lines::Lines;
use crate::error::Error;

/// Reads the physical groups of points, curves, surfaces and volumes.
///
/// ```text
/// point:   tag x y z                             groups g₁ … g_groups
/// others:  tag minX minY minZ maxX maxY maxZ     groups g₁ … g_groups  bounding entities
/// ```
pub(super) fn entities(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let mut head = lines.record(&"the numbers of points, curves, surfaces and volumes")?;
    let mut counts = [0_usize; 4];
    for count in &mut counts {
        *count = head.size("number of entities")?;
    }
    lines.close(head)?;
    for (dimension, count) in (0_u8..).zip(counts) {
        for at in 0..count {
            let mut fields = lines.record(&format_args!(
                "entity {} of {count} of dimension {dimension}",
                at + 1
            ))?;
            let tag: i32 = fields.int("entity tag")?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                fields.coordinate()?;
            }
            let groups: usize = fields.size("number of physical groups")?;
            let mut physical = Vec::new();
            for _ in 0..groups {
                // A minus marks a reversed orientation.
                physical.push(fields.int::<i32>("physical group")?.unsigned_abs());
            }
            if lines.binary() {
                // A line simply ends; bare numbers have to be passed over.
                for _ in 0..bounding(&mut fields, dimension)? {
                    fields.int::<i32>("bounding entity")?;
                }
                lines.close(fields)?;
            }
            if contents
                .groups_of_entity
                .insert((dimension, tag), physical)
                .is_some()
            {
                return Err(lines.error(format!(
                    "entity {tag} of dimension {dimension} is listed twice"
                )));
            }
        }
    }
    Ok(())
}

/// Number of entities that bound an entity.
fn bounding(fields: &mut Fields<'_>, dimension: u8) -> Result<u64, Error> {
    if dimension == 0 {
        return Ok(0);
    }
    fields.size("number of bounding entities")
}

/// Counts of a section of blocks, from its first line.
struct Head {
    blocks: usize,
    total: usize,
}

fn head(lines: &mut Lines<'_>, what: &str) -> Result<Head, Error> {
    let mut fields = lines.record(&format_args!("the numbers of blocks and {what}"))?;
    let head = Head {
        blocks: fields.size("number of blocks")?,
        total: fields.size("total count")?,
    };
    fields.size::<u64>("smallest tag")?;
    fields.size::<u64>("largest tag")?;
    lines.close(fields)?;
    Ok(head)
}

/// First line of a block.
struct Block {
    dimension: u8,
    entity: i32,
    kind: u32,
    count: usize,
}

fn block(lines: &mut Lines<'_>, at: usize, blocks: usize) -> Result<Block, Error> {
    let mut fields = lines.record(&format_args!("block {} of {blocks}", at + 1))?;
    let block = Block {
        dimension: fields.int("dimension from 0 to 3")?,
        entity: fields.int("entity tag")?,
        kind: fields.int("parametric flag or element type")?,
        count: fields.size("number of entries")?,
    };
    lines.close(fields)?;
    if block.dimension > 3 {
        return Err(lines.error(format!(
            "{} is not a dimension from 0 to 3",
            block.dimension
        )));
    }
    Ok(block)
}

fn check_total(lines: &Lines<'_>, what: &str, total: usize, found: usize) -> Result<(), Error> {
    if total == found {
        return Ok(());
    }
    Err(lines.error(format!(
        "the section announces {total} {what}, its blocks hold {found}"
    )))
}

/// Reads blocks of node tags, then positions.
pub(super) fn nodes(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let Head { blocks, total } = head(lines, "nodes")?;
    // Grows with what is really there: the announced count may be absurd.
    let mut listed: Vec<(u64, [f64; 3])> = Vec::new();
    for at in 0..blocks {
        let block = block(lines, at, blocks)?;
        let start = listed.len();
        for node in 0..block.count {
            let of = block.count;
            let mut fields = lines.record(&format_args!("tag of node {} of {of}", node + 1))?;
            listed.push((fields.size("node tag")?, [0.0; 3]));
            lines.close(fields)?;
        }
        for entry in &mut listed[start..] {
            let mut fields = lines.record(&format_args!("position of node {}", entry.0))?;
            entry.1 = fields.position()?;
            // A parametric block adds the node's coordinates on its entity.
            for _ in 0..if block.kind == 0 { 0 } else { block.dimension } {
                fields.coordinate()?;
            }
            lines.close(fields)?;
        }
    }
    check_total(lines, "nodes", total, listed.len())?;
    contents.keep_nodes(listed, lines)
}

/// Reads blocks of lines `tag nodes`, one element type per block.
pub(super) fn elements(lines: &mut Lines<'_>, contents: &mut Contents) -> Result<(), Error> {
    let Head { blocks, total } = head(lines, "elements")?;
    let mut elements = Vec::new();
    for at in 0..blocks {
        let block = block(lines, at, blocks)?;
        let (shape, nodes) = Shape::from_type(block.kind).map_err(|e| lines.error(e))?;
        if shape.dimension() != block.dimension {
            return Err(lines.error(format!(
                "element type {} does not fit an entity of dimension {}",
                block.kind, block.dimension
            )));
        }
        let known = &contents.groups_of_entity;
        if !known.is_empty() && !known.contains_key(&(block.dimension, block.entity)) {
            return Err(lines.error(format!(
                "entity {} of dimension {} is not listed in `$Entities`",
                block.entity, block.dimension
            )));
        }
        for element in 0..block.count {
            let of = block.count;
            let mut fields = lines.record(&format_args!("element {} of {of}", element + 1))?;
            fields.size::<u64>("element tag")?;
            let mut slots = [u32::MAX; MOST_NODES];
            for slot in &mut slots[..nodes] {
                *slot = contents.node(fields.size("node tag")?, lines)?;
            }
            lines.close(fields)?;
            elements.push(Element {
                place: lines.place(),
                shape,
                entity: block.entity,
                count: nodes,
                slots,
            });
        }
    }
    check_total(lines, "elements", total, elements.len())?;
    contents.keep_elements(elements, lines)
}
