//! Coordinates that start fine and grow.

/// Coordinates from 0 to `end`: cells of size `fine` up to `even`, then each larger by `growth`.
///
/// All positive, `fine <= even < end`.
pub(super) fn growing(fine: f64, even: f64, end: f64, growth: f64) -> Vec<f64> {
    let count = (even / fine).round();
    let mut lines: Vec<f64> = (0..=count as usize)
        .map(|k| k as f64 * even / count)
        .collect();
    let (mut size, mut last) = (even / count, even);
    while last < end - 2.0 * size {
        size *= 1.0 + growth;
        last += size;
        lines.push(last);
    }
    lines.push(end);
    lines
}

/// The same from `-end` up to 0, fine at 0.
pub(super) fn falling(fine: f64, even: f64, end: f64, growth: f64) -> Vec<f64> {
    let depths = growing(fine, even, end, growth);
    depths.iter().rev().map(|depth| 0.0 - depth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_grow_from_the_fine_end_and_fill_the_length() {
        let lines = growing(0.5, 1.0, 10.0, 0.5);
        assert_eq!(lines[..3], [0.0, 0.5, 1.0]);
        assert_eq!(lines.last(), Some(&10.0));
        let sizes: Vec<f64> = lines.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // No cell but the last, which closes the length, is more than half as large again.
        let (_, grown) = sizes.split_last().unwrap_or((&0.0, &[]));
        assert!(
            grown
                .windows(2)
                .all(|pair| (1.0..1.5 + 1e-12).contains(&(pair[1] / pair[0])))
        );
        assert!(sizes.iter().all(|size| *size > 0.0));
        assert_eq!(falling(0.5, 1.0, 10.0, 0.5).last(), Some(&0.0));
    }
}
