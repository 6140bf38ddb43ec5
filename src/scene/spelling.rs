//! The known name that is spelt most like an unknown one.

/// Longest name that is compared, in bytes: the work grows with the product of two lengths.
const LONGEST: usize = 200;

/// Nearest name by edit distance, case aside; none where nothing comes close.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST {
        return None;
    }
    let letters: Vec<char> = name.to_lowercase().chars().collect();
    known
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| {
            let other: Vec<char> = candidate.to_lowercase().chars().collect();
            let accepted = letters.len().max(other.len()).div_ceil(3);
            (edit_distance(&letters, &other), accepted, candidate)
        })
        .filter(|&(distance, accepted, _)| distance <= accepted)
        .min_by_key(|&(distance, ..)| distance)
        .map(|(.., candidate)| candidate)
}

/// Levenshtein's distance: fewest insertions, removals and replacements of one letter.
fn edit_distance(left: &[char], right: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in right.iter().enumerate() {
            let replaced = diagonal + usize::from(a != b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[right.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_single_letters() {
        // kitten → sitten → sittin → sitting.
        let letters = |word: &str| word.chars().collect::<Vec<_>>();
        assert_eq!(edit_distance(&letters("kitten"), &letters("sitting")), 3);
        assert_eq!(edit_distance(&letters(""), &letters("top")), 3);
    }

    #[test]
    fn the_nearest_name_is_found_and_a_far_one_is_not() {
        let known = ["contact", "top", "sym"];
        assert_eq!(nearest("Contcat", known.into_iter()), Some("contact"));
        assert_eq!(nearest("pressure", known.into_iter()), None);
        assert_eq!(nearest("top", std::iter::empty()), None);
    }
}
