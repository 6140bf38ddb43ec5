//! Groups from whole numbers per cell or point.

use std::collections::BTreeMap;

/// Most values of an array that makes groups: with more it numbers things.
const MOST: usize = 1000;

/// What meshio puts between the names of sets: the first that is in none of them.
const BETWEEN: [char; 5] = ['-', '_', '#', '+', '/'];

/// The values of an array, and the set of each that makes one.
pub(super) struct Numbered {
    values: Vec<i64>,
    sets: BTreeMap<i64, u32>,
}

/// Whether an array of this name may make groups.
pub(super) fn may_group(name: &str) -> bool {
    let of_gmsh = name.starts_with("gmsh:") && name != "gmsh:physical";
    let ids = [
        "GlobalNodeId",
        "GlobalElementId",
        "GlobalIds",
        "PedigreeIds",
    ];
    !(name.is_empty() || of_gmsh || name.starts_with("vtk") || ids.contains(&name))
}

/// The sets of an array; `number` gives that of a name.
pub(super) fn numbered(
    name: &str,
    values: Vec<i64>,
    mut number: impl FnMut(&str) -> u32,
) -> Option<Numbered> {
    let mut sets = BTreeMap::new();
    for &value in &values {
        sets.entry(value).or_insert(0);
        if sets.len() > MOST {
            return None;
        }
    }
    let (least, most) = (*sets.keys().next()?, *sets.keys().next_back()?);
    let parts = joined(name, least, most);
    sets.retain(|&value, set| {
        let named = match &parts {
            _ if name == "gmsh:physical" => (value != 0).then(|| value.to_string()),
            Some(parts) => usize::try_from(value).ok().map(|at| parts[at].to_owned()),
            None => Some(format!("{name}:{value}")),
        };
        named.map(|named| *set = number(&named)).is_some()
    });
    Some(Numbered { values, sets })
}

/// The sets of entry number `at`.
pub(super) fn of_entry(arrays: &[Numbered], at: usize) -> Vec<u32> {
    let of_array = |array: &Numbered| array.sets.get(&array.values[at]).copied();
    let mut sets: Vec<u32> = arrays.iter().filter_map(of_array).collect();
    sets.sort_unstable();
    sets.dedup();
    sets
}

/// The names that an array's name is made of, if its numbers count them from 0, with −1 for none.
fn joined(name: &str, least: i64, most: i64) -> Option<Vec<&str>> {
    let count = usize::try_from(most).ok()?.checked_add(1)?;
    if least < -1 {
        return None;
    }
    for sign in BETWEEN {
        let parts: Vec<&str> = name.split(sign).collect();
        if parts.len() == count && !parts.contains(&"") {
            return Some(parts);
        }
        // The next sign stands between names only if this one is in them.
        if !name.contains(sign) {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Names of the sets of every entry.
    fn names(name: &str, values: &[i64]) -> Vec<Vec<String>> {
        let mut known: Vec<String> = Vec::new();
        let number = |name: &str| {
            known.push(name.to_owned());
            known.len() as u32 - 1
        };
        let arrays = [numbered(name, values.to_vec(), number).unwrap()];
        let of_entry = |at| of_entry(&arrays, at).into_iter();
        let entries = 0..values.len();
        let name = |set: u32| known[set as usize].clone();
        entries.map(|at| of_entry(at).map(name).collect()).collect()
    }

    #[test]
    fn names_of_sets_are_taken_apart_as_meshio_joins_them() {
        let none: [&str; 0] = [];
        assert_eq!(names("left-right", &[1, -1, 0])[0], ["right"]);
        assert_eq!(names("left-right", &[1, -1, 0])[1], none);
        assert_eq!(names("a-b_c", &[1, 0])[0], ["b_c"]);
        // A hyphen within a name: an underline stands between the names.
        assert_eq!(names("a-1_b_c", &[2, 0, 1])[1], ["a-1"]);
        assert_eq!(names("base", &[-1, 0])[1], ["base"]);
    }

    #[test]
    fn other_numbers_are_named_by_array_and_value() {
        assert_eq!(names("material_id", &[1, 0])[0], ["material_id:1"]);
        assert_eq!(names("part-id", &[7, 0])[0], ["part-id:7"]);
        assert_eq!(names("gmsh:physical", &[7, 0])[0], ["7"]);
        assert!(names("gmsh:physical", &[7, 0])[1].is_empty());
    }

    #[test]
    fn what_only_numbers_things_makes_no_groups() {
        assert!(!may_group("gmsh:geometrical") && !may_group("vtkOriginalCellIds"));
        assert!(numbered("node", (0..2000).collect(), |_| 0).is_none());
        assert!(numbered("none", Vec::new(), |_| 0).is_none());
    }
}
