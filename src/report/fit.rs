//! Whether the sides of the contact pairs are in the state that is reported, under stable names.

use serde::Serialize;

use super::ReportParts;
use super::digits::size;
use crate::kkt;

/// What the judge finds of a pair in meshes and displacements; see [`kkt::PairFit`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedPairFit {
    /// What is left of the sum of both sides' forces, by the cells of their bodies.
    pub force: ReportedMeasure,
    /// What is left of the sum of both sides' moments.
    pub moment: ReportedMeasure,
    /// Depth of a side in the other, after loading.
    pub overlap: ReportedMeasure,
    /// Distance across which something presses, after loading.
    pub distance: ReportedMeasure,
    /// How far a contact's gap before loading, or its weights, are from the meshes.
    pub misplacement: ReportedMeasure,
    /// How far the resultant is outside of what touches.
    pub reach: ReportedMeasure,
}

/// A departure and what explains it: rounding, and what facets and cells do not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedMeasure {
    /// Its size, in the scene's units.
    pub value: f64,
    /// How large it may be.
    pub explained: f64,
    /// Contact, as an index into `contacts`.
    pub contact: usize,
}

impl From<kkt::Measure> for ReportedMeasure {
    fn from(measure: kkt::Measure) -> Self {
        let kkt::Measure {
            value,
            explained,
            contact,
        } = measure;
        Self {
            value,
            explained,
            contact,
        }
    }
}

impl From<&kkt::PairFit> for ReportedPairFit {
    fn from(fit: &kkt::PairFit) -> Self {
        Self {
            force: fit.force.into(),
            moment: fit.moment.into(),
            overlap: fit.overlap.into(),
            distance: fit.distance.into(),
            misplacement: fit.misplacement.into(),
            reach: fit.reach.into(),
        }
    }
}

/// What is wrong with the bodies, in words.
pub(super) fn fault(parts: &ReportParts<'_>) -> String {
    let pairs = parts.pairs.iter().zip(parts.fits);
    let mut faults = pairs.filter_map(|(pair, fit)| Some((pair, fit.fault()?)));
    let Some((pair, (name, measure))) = faults.next() else {
        return format!(
            "contacts of the recovered bodies move by {} otherwise than the contact problem says: look \
             for cells of very different size or stiffness in one body",
            size(parts.departure.value)
        );
    };
    let (value, explained) = (size(measure.value), size(measure.explained));
    let (what, cure) = match name {
        "force" => (
            "the forces on its two sides differ by",
            "please report this scene",
        ),
        "moment" if pair.law.bilateral => (
            "the moments on its two sides differ by",
            "shear that crosses a distance has a moment: draw sides that are one together",
        ),
        "moment" => (
            "the moments on its two sides differ by",
            "please report this scene",
        ),
        "overlap" => ("a side is in the other by", "refine the facets there"),
        "distance" => ("something presses across", "refine the facets there"),
        "misplacement" => (
            "a contact is off what the meshes say by",
            "refine the facets there",
        ),
        _ => (
            "the resultant is outside of what touches by",
            "refine the facets there",
        ),
    };
    format!(
        "{}: {what} {value} near contact {}, of which rounding and mesh explain {explained}: {cure}, \
         or make the coarser of the two sides the finer one",
        pair.place, measure.contact
    )
}
