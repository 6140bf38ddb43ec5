//! Numbers for people: two digits of what should be zero, six of what should not.

/// Two digits: the size of what should be zero.
pub(super) fn size(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else {
        format!("{value:.1e}")
    }
}

/// Six digits, in powers of ten only where plain digits would be long.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&size) {
        // Of the six digits themselves: 9.9999999 is 10.
        let rounded: f64 = format!("{size:.5e}").parse().unwrap_or(size);
        let decimals = (5 - rounded.log10().floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.5e}")
    }
}
