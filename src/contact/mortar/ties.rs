//! Choices that round-off does not make: of equals the first one is taken.

/// Difference that is round-off of positions a thousand sizes away.
pub(super) const EQUAL: f64 = 1e-9;

/// The first of the items whose value, of size one, is the largest but for round-off.
pub(super) fn first_largest<T>(
    items: impl IntoIterator<Item = T>,
    value: impl Fn(&T) -> f64,
) -> Option<T> {
    let items: Vec<T> = items.into_iter().collect();
    let most = items.iter().map(&value).fold(f64::NEG_INFINITY, f64::max);
    items.into_iter().find(|item| value(item) >= most - EQUAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equals_the_first_is_taken() {
        let found = first_largest([0.3, 1.0 - 1e-15, 1.0, 0.9], |x| *x);
        assert_eq!(found, Some(1.0 - 1e-15));
        assert_eq!(first_largest([0.0; 0], |x| *x), None);
    }
}
