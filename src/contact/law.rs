//! What the contacts of a pair obey beside one coefficient of friction, per area: the laws of the problem (its `law`)
//! before areas, tangents and places are known.

use std::collections::HashMap;

use super::node::ContactNode;
use crate::body::Facet;
use crate::error::Error;

/// A law of contact per area; the default is Coulomb's with the pair's coefficient.
#[derive(Clone, Debug, PartialEq)]
pub struct PairLaw {
    /// Coefficients that differ from place to place.
    pub places: Option<Places>,
    /// The sides neither part nor come closer, whatever gap they are drawn with.
    pub bilateral: bool,
    /// No slip while pressed; if bilateral, ever.
    pub sticks: bool,
    /// Tension that is borne, in pascal.
    pub tension: f64,
    /// Shear that is borne without pressure, in pascal.
    pub shear: f64,
    /// Shear that is borne at most, in pascal; infinite without.
    pub cap: f64,
    /// Coefficient across a direction over that along it, and the direction in global axes.
    pub ellipse: Option<(f64, [f64; 3])>,
    /// Displacement per traction of the surface itself, normal and tangential, in m/Pa.
    pub compliance: [f64; 2],
}

/// Coefficients of friction by place.
#[derive(Clone, Debug, PartialEq)]
pub enum Places {
    /// On facets of a body; where several of the regions meet, their mean.
    Regions(Vec<Region>),
    /// Over the coordinate along a direction of unit length, in metre: rising, linear between rows and constant beyond.
    Along {
        /// The direction.
        direction: [f64; 3],
        /// Coordinate and coefficient.
        rows: Vec<[f64; 2]>,
    },
}

/// Facets with a coefficient of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Index of the body.
    pub body: usize,
    /// Its facets.
    pub facets: Vec<Facet>,
    /// Coefficient, `μ ≥ 0`.
    pub friction: f64,
}

impl Default for PairLaw {
    fn default() -> Self {
        Self {
            places: None,
            bilateral: false,
            sticks: false,
            tension: 0.0,
            shear: 0.0,
            cap: f64::INFINITY,
            ellipse: None,
            compliance: [0.0; 2],
        }
    }
}

impl PairLaw {
    /// The law in words, beside the pair's coefficient; none of Coulomb's with one coefficient.
    #[must_use]
    pub fn words(&self, friction: f64) -> Option<String> {
        if *self == Self::default() {
            return None;
        }
        let mut words = match (self.bilateral, self.sticks) {
            (true, true) => "bonded".to_owned(),
            (true, false) => format!("no separation, friction {friction}"),
            (false, true) => "rough".to_owned(),
            (false, false) if self.tension > 0.0 => {
                let (tension, shear) = (self.tension, self.shear);
                format!("cohesion, tension {tension}, shear {shear}, friction {friction}")
            }
            (false, false) if self.shear > 0.0 && friction == 0.0 => {
                format!("given bound, shear {}", self.shear)
            }
            (false, false) if self.shear > 0.0 => {
                format!("cohesion, shear {}, friction {friction}", self.shear)
            }
            (false, false) => format!("Coulomb, friction {friction}"),
        };
        match &self.places {
            None => {}
            Some(Places::Regions(regions)) => {
                words += &format!(" but in {} regions", regions.len());
            }
            Some(Places::Along { .. }) => words += " at most, by place",
        }
        if let Some((ratio, _)) = self.ellipse {
            words += &format!(" along a direction, {} across", ratio * friction);
        }
        if self.cap.is_finite() {
            words += &format!(", shear at most {}", self.cap);
        }
        if self.compliance != [0.0; 2] {
            let [normal, tangential] = self.compliance;
            words += &format!(", compliance {normal} normal, {tangential} tangential");
        }
        Some(words)
    }

    /// Bounds are Coulomb's, with one coefficient or several: those of limit analysis.
    #[must_use]
    pub fn is_coulomb(&self) -> bool {
        let plain = Self {
            places: self.places.clone(),
            compliance: self.compliance,
            ..Self::default()
        };
        *self == plain
    }
}

impl PairLaw {
    /// Whether no friction acts anywhere: its contacts have no tangents.
    pub(super) fn is_smooth(&self, friction: f64) -> bool {
        let anywhere = match &self.places {
            None => false,
            Some(Places::Regions(regions)) => regions.iter().any(|region| region.friction > 0.0),
            Some(Places::Along { rows, .. }) => rows.iter().any(|row| row[1] > 0.0),
        };
        friction == 0.0 && !anywhere && !self.sticks && self.shear == 0.0
    }

    pub(super) fn check(&self, place: &str, friction: f64) -> Result<(), Error> {
        let law = self;
        let refuse = |key: &str, value: f64, accepted| {
            let place = format!("{place}.{key}");
            Err(Error::OutOfRange {
                place,
                value,
                accepted,
            })
        };
        for (key, value) in [
            ("law.tension", law.tension),
            ("law.shear", law.shear),
            ("compliance.normal", law.compliance[0]),
            ("compliance.tangential", law.compliance[1]),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(key, value, "0 <= number < infinity");
            }
        }
        if law.cap.is_nan() || law.cap < law.shear || law.cap == 0.0 {
            return refuse(
                "law.shear_cap",
                law.cap,
                "a cap > 0 that is not below shear",
            );
        }
        if law.shear < friction * law.tension {
            let accepted = "shear >= friction × tension, so that what pulls can still hold";
            return refuse("law.shear", law.shear, accepted);
        }
        Ok(())
    }

    /// Coefficient of friction at a contact of a pair with this coefficient.
    #[must_use]
    pub fn friction_at(&self, friction: f64, contact: &ContactNode) -> f64 {
        match &self.places {
            None => friction,
            Some(Places::Along { direction, rows }) => {
                let along = direction.iter().zip(contact.position);
                at(rows, along.map(|(d, x)| d * x).sum())
            }
            Some(Places::Regions(regions)) => friction_in(friction, regions, contact),
        }
    }
}

/// The mean of the nodes that the contact moves with, on the side where the regions are; of two sides of one body, the one
/// that is in a region.
fn friction_in(elsewhere: f64, regions: &[Region], contact: &ContactNode) -> f64 {
    let opposite = contact.opposite.iter();
    let opposite = opposite.map(|opposite| (opposite.body, &opposite.nodes));
    let sides = std::iter::once((contact.body, &contact.own)).chain(opposite);
    let mut of_sides = sides.map(|(body, nodes)| {
        let mut of_node: HashMap<usize, [f64; 2]> = HashMap::new();
        for region in regions.iter().filter(|region| region.body == body) {
            for &node in region.facets.iter().flat_map(|facet| &facet.nodes) {
                let [sum, count] = of_node.entry(node).or_default();
                (*sum, *count) = (*sum + region.friction, *count + 1.0);
            }
        }
        (nodes, of_node)
    });
    let inside =
        of_sides.find(|(nodes, of_node)| nodes.iter().any(|(node, _)| of_node.contains_key(node)));
    let Some((nodes, of_node)) = inside else {
        return elsewhere;
    };
    let friction = |node: &usize| of_node.get(node).map_or(elsewhere, |[sum, n]| sum / n);
    let values = || nodes.iter().map(|(node, weight)| (friction(node), *weight));
    let mean: f64 = values().map(|(mu, weight)| weight * mu).sum();
    // Weights may be negative.
    let least = values().fold(f64::INFINITY, |least, (mu, _)| least.min(mu));
    let most = values().fold(0.0, |most: f64, (mu, _)| most.max(mu));
    mean.max(least).min(most)
}

/// A value of rising rows.
fn at(rows: &[[f64; 2]], x: f64) -> f64 {
    let next = rows.partition_point(|row| row[0] <= x);
    match (
        next.checked_sub(1).and_then(|k| rows.get(k)),
        rows.get(next),
    ) {
        (Some([a, low]), Some([b, high])) => low + (x - a) / (b - a) * (high - low),
        (Some([_, only]), None) | (None, Some([_, only])) => *only,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_rows_and_constant_beyond() {
        let rows = [[1.0, 0.1], [3.0, 0.5]];
        let found = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| at(&rows, x));
        for (found, expected) in found.into_iter().zip([0.1, 0.1, 0.3, 0.5, 0.5]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn laws_are_named() {
        let words = |law: PairLaw, friction| law.words(friction).unwrap_or_default();
        assert_eq!(words(PairLaw::default(), 0.3), "");
        let given = PairLaw {
            shear: 5.0,
            ..PairLaw::default()
        };
        assert_eq!(words(given, 0.0), "given bound, shear 5");
        let bonded = PairLaw {
            bilateral: true,
            sticks: true,
            ..PairLaw::default()
        };
        assert_eq!(words(bonded, 0.0), "bonded");
    }
}
