//! The motion of bodies that nothing holds, in numbers and in words.

use serde::Serialize;

use crate::body::Body;
use crate::condensation::PartMotion;
use crate::contact::RigidBody;

/// What is left of a motion below this part of it is nothing.
const NOTHING: f64 = 1e-3;

/// How a body, or one unconnected part of it, moves: `translation + rotation × (x − centre)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedMotion {
    /// Name of the body.
    pub body: String,
    /// Mean position of the moving nodes, in metre.
    pub centre: [f64; 3],
    /// Velocity of the centre, of the order of one.
    pub translation: [f64; 3],
    /// Rotation, in 1/m.
    pub rotation: [f64; 3],
    /// The same in words, such as `slides along +x`.
    pub words: String,
}

/// Names of bodies as motions number them: rigid ones after the others.
pub(crate) fn names<'a>(bodies: &'a [Body], rigid: &'a [RigidBody]) -> Vec<&'a str> {
    let names = bodies.iter().map(|body| body.name.as_str());
    names
        .chain(rigid.iter().map(|body| body.name.as_str()))
        .collect()
}

/// The parts that move at all, of bodies with these names; `slides` where a contact slides, else contacts only open.
pub(crate) fn motions(names: &[&str], parts: &[PartMotion], slides: bool) -> Vec<ReportedMotion> {
    let largest = parts.iter().map(reach).fold(0.0, f64::max);
    let moving = parts.iter().filter(|part| reach(part) > NOTHING * largest);
    let named = moving.filter_map(|part| Some((names.get(part.body)?, part)));
    named
        .map(|(name, part)| ReportedMotion {
            body: (*name).to_owned(),
            centre: part.centre,
            translation: part.translation,
            rotation: part.rotation,
            words: words(part, slides, NOTHING * largest),
        })
        .collect()
}

/// `block slides along +x, lid tips about -z through (0.5, 0, 0)`.
pub(crate) fn sentence(motions: &[ReportedMotion]) -> String {
    let each = motions.iter().map(|m| format!("{} {}", m.body, m.words));
    each.collect::<Vec<_>>().join(", ")
}

/// Largest speed a point of the part may have.
fn reach(part: &PartMotion) -> f64 {
    length(part.translation) + length(part.rotation) * part.size
}

fn words(part: &PartMotion, slides: bool, nothing: f64) -> String {
    let (v, w) = (part.translation, part.rotation);
    let turning = length(w);
    if turning * part.size <= nothing {
        let verb = if slides { "slides" } else { "moves off" };
        return format!("{verb} along {}", direction(v));
    }
    let verb = if slides { "turns" } else { "tips" };
    let arm = cross(w, v);
    let near = |x: f64| {
        if x.abs() < NOTHING * part.size {
            0.0
        } else {
            x
        }
    };
    let axis = [0, 1, 2].map(|k| significant(near(part.centre[k] + arm[k] / (turning * turning))));
    let mut words = format!(
        "{verb} about {} through ({})",
        direction(w),
        axis.join(", ")
    );
    let advance = (0..3).map(|k| w[k] * v[k]).sum::<f64>() / turning;
    if advance.abs() > nothing {
        words += &format!(" and along {}", direction(w.map(|w| w * advance)));
    }
    words
}

/// `+x` for a direction along an axis, otherwise its components.
fn direction(vector: [f64; 3]) -> String {
    let unit = vector.map(|x| x / length(vector));
    for (name, x) in ["x", "y", "z"].into_iter().zip(unit) {
        if x.abs() > 1.0 - NOTHING * NOTHING {
            return format!("{}{name}", if x > 0.0 { '+' } else { '-' });
        }
    }
    let [x, y, z] = unit.map(|x| if x.abs() < NOTHING { 0.0 } else { x });
    format!("({x:.3}, {y:.3}, {z:.3})")
}

/// Four significant digits, without needless zeros.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{value:.3e}");
    }
    let rounded = format!("{value:.*}", (3 - exponent).max(0) as usize);
    if !rounded.contains('.') {
        return rounded;
    }
    let trimmed = rounded.trim_end_matches('0').trim_end_matches('.');
    trimmed.to_owned()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(translation: [f64; 3], rotation: [f64; 3]) -> PartMotion {
        PartMotion {
            body: 0,
            centre: [0.0, 1.0, 0.0],
            size: 1.5,
            translation,
            rotation,
        }
    }

    #[test]
    fn a_translation_slides_or_moves_off() {
        let along = part([3.0, 0.0, 0.0], [0.0; 3]);
        assert_eq!(words(&along, true, 0.003), "slides along +x");
        assert_eq!(words(&along, false, 0.003), "moves off along +x");
    }

    #[test]
    fn a_rotation_is_told_by_its_axis() {
        // Centre (0, 1, 0) moves with ω × (c − p), ω = −z, p = (0.5, 0, 0): −z × (−0.5, 1, 0)
        // = (1, 0.5, 0).
        let tipping = part([1.0, 0.5, 0.0], [0.0, 0.0, -1.0]);
        assert_eq!(
            words(&tipping, false, 0.001),
            "tips about -z through (0.5, 0, 0)"
        );
    }

    #[test]
    fn a_screw_also_advances() {
        let screw = part([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]);
        let expected = "turns about +z through (0, 1, 0) and along +z";
        assert_eq!(words(&screw, true, 0.001), expected);
    }

    #[test]
    fn numbers_and_directions_read_well() {
        let found = [36.000_04, 1234.56, -0.25, 1.0e7, 3.2e-9, 0.0].map(significant);
        assert_eq!(found, ["36", "1235", "-0.25", "1.000e7", "3.200e-9", "0"]);
        assert_eq!(direction([0.0, -3.0, 0.0]), "-y");
        assert_eq!(direction([3.0, 0.0, 4.0]), "(0.600, 0.000, 0.800)");
    }
}
