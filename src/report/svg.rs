//! What the drawings share: words and numbers in SVG.

use std::fmt::Write;

/// Words at a place; `anchor` is `start`, `middle` or `end`.
pub(super) fn text(svg: &mut String, [x, y]: [f64; 2], anchor: &str, words: &str) {
    let words = escaped(words);
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>"
    );
}

/// Words as they stand in SVG and HTML.
pub(super) fn escaped(words: &str) -> String {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    words.replace('>', "&gt;").replace('"', "&quot;")
}

/// Three digits, without the round-off of a multiple.
pub(super) fn plain(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e5).contains(&size) {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        rounded.to_string()
    } else {
        format!("{value:.0e}")
    }
}
