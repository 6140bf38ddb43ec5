//! Names of physical groups.

use std::collections::BTreeMap;

use super::fields::quote;
use super::lines::Lines;
use crate::error::Error;

/// Reads lines such as `2 100 "body"`.
pub(super) fn read(
    lines: &mut Lines<'_>,
    names: &mut BTreeMap<(u8, u32), String>,
) -> Result<(), Error> {
    let mut head = lines.fields(&"the number of physical names")?;
    let count: usize = head.size("number of physical names")?;
    for at in 0..count {
        let line = lines.line(&format_args!("physical name {} of {count}", at + 1))?;
        let named = line
            .split_once('"')
            .and_then(|(numbers, rest)| Some((numbers, rest.strip_suffix('"')?)));
        let Some((numbers, name)) = named else {
            return Err(lines.error(format!(
                "expected dimension, number and quoted name, found {}",
                quote(line)
            )));
        };
        let key: Vec<i32> = numbers
            .split_ascii_whitespace()
            .map_while(|word| word.parse().ok())
            .collect();
        let &[dimension @ 0..=3, number] = &key[..] else {
            return Err(lines.error(format!(
                "expected a dimension from 0 to 3 and a number, found {}",
                quote(numbers)
            )));
        };
        let key = (dimension as u8, number.unsigned_abs());
        if names.insert(key, name.to_owned()).is_some() {
            return Err(lines.error(format!(
                "physical group {number} of dimension {dimension} is named twice"
            )));
        }
    }
    Ok(())
}
