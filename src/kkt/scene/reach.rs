//! Whether pressures and friction on what touches can have the resultant that a side receives.
//!
//! ```text
//! (K14)  (Σ f, Σ (x − c) × f) = Σ_k λ_k (r_k, (x_k − c) × r_k),   λ ≥ 0
//! ```
//!
//! with rays `r_k` of the friction cone at the samples around pressed contacts: in space those of an octagon
//! around the disc, and that around the ellipse where friction differs along and across. No pressure has its resultant
//! beyond the end of what it acts on: a block whose weight lies beyond the edge of what it stands on topples. At a node that a support holds, what goes along the support
//! counts either way: on a plane of symmetry facets lean out of the plane, and their mirror images lean back.

use nalgebra::{Vector3, Vector6};

use super::forces::Forces;
use super::hull::distance;
use super::measure::Measure;
use super::meeting::{Meeting, Sample};
use super::supported::Supported;

/// Least value of a node's shape function at a sample that counts as the node's.
const OF_NODE: f64 = 0.5;

/// Directions of friction in space.
const DIRECTIONS: usize = 8;

/// Where a pair touches.
pub(super) struct Touching<'a> {
    pub(super) meeting: &'a Meeting,
    /// Side that carries the contacts.
    pub(super) side: usize,
    /// Its faces around pressed contacts, which may be named several times.
    pub(super) faces: Vec<usize>,
    /// Largest coefficient along any direction.
    pub(super) friction: f64,
    pub(super) supported: &'a Supported,
}

impl Touching<'_> {
    /// How far the resultant of the first side is outside, in metre.
    pub(super) fn reach(&self, forces: &Forces, part: f64, at: usize) -> Measure {
        let force = Vector3::from(forces.sides[0].force);
        let [_, noise] = forces.defect(part);
        if force.norm() <= noise {
            return Measure::default();
        }
        let (mut faces, meeting) = (self.faces.clone(), self.meeting);
        faces.sort_unstable();
        faces.dedup();
        let on = |face: usize| meeting.on(self.side, face);
        let mut numbers: Vec<usize> = faces.into_iter().flat_map(on).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let samples = || numbers.iter().map(|&number| &meeting.samples[number]);
        let from = Vector3::from(forces.centre);
        // Lengths in units of what touches, so that forces and moments are of one size.
        let unit = samples().filter_map(|sample| Some((first(sample)? - from).norm()));
        let unit = unit.fold(forces.reach * part, f64::max);
        let moment = Vector3::from(forces.sides[0].moment);
        let rays = samples().filter_map(|sample| {
            let arm = (first(sample)? - from) / unit;
            let rays = self.rays(sample).into_iter().chain(self.held(sample));
            Some(rays.map(move |ray| joined(ray, arm.cross(&ray))))
        });
        let rays: Vec<Vector6<f64>> = rays.flatten().collect();
        let sought = joined(force, moment / unit);
        let sagitta = samples()
            .map(|sample| meeting.sagitta(sample))
            .fold(0.0, f64::max);
        let missed = distance(&rays, sought) / force.norm() * unit;
        let rounded = (part.sqrt() + noise / force.norm()) * unit;
        Measure::new(missed, rounded + 4.0 * sagitta, at)
    }

    /// Both ways along what supports hold at the nodes of a sample.
    fn held(&self, sample: &Sample) -> Vec<Vector3<f64>> {
        let places = sample.places.iter().zip(&self.meeting.skins);
        let nodes = places.filter_map(|(place, skin)| {
            let place = place.as_ref()?;
            let nodes = skin.faces[place.face].nodes.iter().zip(&place.shape);
            let mut of_sample = nodes.filter(|(_, shape)| **shape > OF_NODE);
            of_sample.next().map(|(&node, _)| (skin.body, node))
        });
        let held = nodes.flat_map(|(body, node)| self.supported.at(body, node));
        held.flat_map(|way| [*way, -way]).collect()
    }

    /// The friction cone around the force on the first side: its axis, and unit vectors along its edges, which are all
    /// that is left of them where friction is as good as glue.
    fn rays(&self, sample: &Sample) -> Vec<Vector3<f64>> {
        let normal = -sample.towards;
        if self.friction == 0.0 {
            return vec![normal];
        }
        let edge = |tangent: Vector3<f64>, radius: f64| (normal + tangent * radius).normalize();
        let plane = self.meeting.skins.iter().all(|skin| skin.dimension == 2);
        if plane {
            let tangent = normal.cross(&Vector3::z());
            return vec![
                normal,
                edge(tangent, self.friction),
                edge(-tangent, self.friction),
            ];
        }
        let mut least = Vector3::zeros();
        least[normal.abs().imin()] = 1.0;
        let first = normal.cross(&least).normalize();
        let second = normal.cross(&first);
        let half = std::f64::consts::PI / DIRECTIONS as f64;
        let radius = self.friction / half.cos();
        let edges = (0..DIRECTIONS).map(|k| {
            let (sin, cos) = (2.0 * half * k as f64).sin_cos();
            edge(first * cos + second * sin, radius)
        });
        edges.chain([normal]).collect()
    }
}

/// The point of the first side.
fn first(sample: &Sample) -> Option<Vector3<f64>> {
    sample.places[0].as_ref().map(|place| place.position)
}

fn joined(force: Vector3<f64>, moment: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
