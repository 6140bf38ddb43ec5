//! How the two sides of a pair lie before loading, seen from the meshes alone.
//!
//! Samples are the nodes and centres of the facets of both sides, and on a facet that the other side covers in part the
//! middle of those there, each with the nearest point of the other side that faces it. A sample that lies beside the other side, or whose nearest point is another
//! one that does not face it, is none.

use std::sync::OnceLock;

use nalgebra::Vector3;

use super::rigid::Sight;
use super::skin::{Place, Skin};
use crate::body::Body;
use crate::contact::{ContactPair, Opposite};

/// Part of the distance by which a foot may lie beside the perpendicular and be one.
const UPRIGHT: f64 = 1e-3;

/// Part of a facet's size that is round-off.
const ROUNDED: f64 = 1e-9;

/// Part of a facet's size by which a sample may lie beyond the end of the other side.
const BESIDE: f64 = 1e-6;

/// Least cosine between a side's normal and the way to the other.
const FACING: f64 = 0.1;

/// Both sides of a pair, and where one is seen from the other.
#[derive(Clone, Debug)]
pub(super) struct Meeting {
    /// The pair's first side, and its second unless that is an obstacle.
    pub(super) skins: Vec<Skin>,
    pub(super) samples: Vec<Sample>,
    /// Samples on each face of either side.
    of_face: [Vec<Vec<usize>>; 2],
    /// How far the distance is off linear over each face of either side, in metre; once somebody asks.
    curved: [OnceLock<Vec<f64>>; 2],
}

/// A point of one side and the point of the other that is nearest to it.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    /// On the first side, and on the second; none on an obstacle.
    pub(super) places: [Option<Place>; 2],
    /// From the first side to the second.
    pub(super) towards: Vector3<f64>,
    /// In metre, negative where the sides overlap.
    pub(super) distance: f64,
}

impl Meeting {
    pub(super) fn new(bodies: &[Body], pair: &ContactPair) -> Self {
        let skin = |index: usize, facets| {
            let body = bodies.get(index);
            body.map(|body| Skin::new(index, body, facets))
        };
        let mut skins: Vec<Skin> = skin(pair.body, &pair.facets).into_iter().collect();
        if let Opposite::Surface { body, facets } = &pair.opposite {
            skins.extend(skin(*body, facets));
        }
        let mut samples: Vec<Sample> = match (&pair.opposite, &skins[..]) {
            (Opposite::Obstacle(obstacle), [own]) => {
                let sight = Sight::new(obstacle);
                let places = own.samples();
                places.filter_map(|place| face(place, &sight)).collect()
            }
            (_, [first, second]) => {
                let there = first.samples().filter_map(|place| meet(place, second));
                let back = second.samples().filter_map(|place| meet(place, first));
                let mut samples: Vec<Sample> = there.chain(back.map(Sample::turned)).collect();
                let [own, across] = [0, 1].map(|side| middles(&samples, side, &skins[side]));
                samples.extend(own.into_iter().filter_map(|place| meet(place, second)));
                let back = across.into_iter().filter_map(|place| meet(place, first));
                samples.extend(back.map(Sample::turned));
                samples
            }
            _ => Vec::new(),
        };
        if pair.law.bilateral {
            // Tied as they are drawn: what is between the sides is none of the contact's business.
            samples.iter_mut().for_each(|sample| sample.distance = 0.0);
        }
        let mut of_face = [0, 1].map(|side| {
            let faces = skins.get(side).map_or(0, |skin: &Skin| skin.faces.len());
            vec![Vec::new(); faces]
        });
        for (number, sample) in samples.iter().enumerate() {
            for (side, place) in sample.places.iter().enumerate() {
                if let Some(place) = place {
                    of_face[side][place.face].push(number);
                }
            }
        }
        Self {
            skins,
            samples,
            of_face,
            curved: Default::default(),
        }
    }

    /// The samples on a face of a side.
    pub(super) fn on(&self, side: usize, face: usize) -> impl Iterator<Item = usize> + '_ {
        self.of_face[side][face].iter().copied()
    }

    /// How far the distance at the middle of a face is from the mean of those at its corners, in metre: what a facet
    /// does not follow of the other side. Zero unless all of these see the other side.
    pub(super) fn curved(&self, side: usize, face: usize) -> f64 {
        self.curved[side].get_or_init(|| {
            let faces = 0..self.of_face[side].len();
            faces.map(|face| self.off_linear(side, face)).collect()
        })[face]
    }

    fn off_linear(&self, side: usize, number: usize) -> f64 {
        let Some(face) = self.skins.get(side).and_then(|skin| skin.faces.get(number)) else {
            return 0.0;
        };
        let near = ROUNDED * face.size;
        let at = |x: Vector3<f64>| {
            let samples = self.on(side, number).map(|k| &self.samples[k]);
            let mut there = samples.filter(|sample| {
                let place = sample.places[side].as_ref();
                place.is_some_and(|place| (place.position - x).norm() <= near)
            });
            there.next().map(|sample| sample.distance)
        };
        let corners: Option<Vec<f64>> = face.corners().map(at).collect();
        match (corners, at(face.middle())) {
            (Some(corners), Some(middle)) => {
                (corners.iter().sum::<f64>() / corners.len() as f64 - middle).abs()
            }
            _ => 0.0,
        }
    }

    /// The sagittas of the faces that a sample is on, in metre.
    pub(super) fn sagitta(&self, sample: &Sample) -> f64 {
        let places = sample.places.iter().zip(&self.skins);
        let sagittas = places.filter_map(|(place, skin)| {
            let place = place.as_ref()?;
            Some(skin.faces[place.face].sagitta)
        });
        sagittas.sum()
    }
}

impl Sample {
    /// The normals of both sides there, turned from the first to the second.
    pub(super) fn normals(&self) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let signs = [1.0, -1.0];
        let places = self.places.iter().zip(signs);
        let of_sides = places.filter_map(|(place, sign)| Some(place.as_ref()?.normal * sign));
        of_sides.chain([self.towards])
    }

    /// The same, seen from the other side.
    fn turned(self) -> Self {
        let [first, second] = self.places;
        Self {
            places: [second, first],
            towards: -self.towards,
            distance: self.distance,
        }
    }
}

/// The middles of the samples on faces of a side that see the other one at some of their corners only. Where a side ends
/// within a face on which displacements are quadratic, both ends of the cover are in the other body if the mean is not.
fn middles(samples: &[Sample], side: usize, skin: &Skin) -> Vec<Place> {
    let mut met = vec![Vec::new(); skin.faces.len()];
    for place in samples.iter().filter_map(|of| of.places[side].as_ref()) {
        met[place.face].push(place.position);
    }
    let middle = |(number, met): (usize, &Vec<Vector3<f64>>)| {
        let face = &skin.faces[number];
        let near = |a: Vector3<f64>, b: &Vector3<f64>| (a - b).norm() <= ROUNDED * face.size;
        let unseen = |corner| !met.iter().any(|at| near(corner, at));
        if met.is_empty() || !face.corners().any(unseen) {
            return None;
        }
        let middle = met.iter().sum::<Vector3<f64>>() / met.len() as f64;
        skin.foot(middle, None).filter(|foot| foot.face == number)
    };
    met.iter().enumerate().filter_map(middle).collect()
}

/// A place and the obstacle in front of it.
fn face(place: Place, sight: &Sight<'_>) -> Option<Sample> {
    let (distance, towards) = sight.see(place.position)?;
    (place.normal.dot(&towards) > FACING).then_some(Sample {
        places: [Some(place), None],
        towards,
        distance,
    })
}

/// A place and the point of another side that is nearest to it.
fn meet(place: Place, other: &Skin) -> Option<Sample> {
    let foot = other.foot(place.position, Some(place.normal))?;
    let size = other.faces[foot.face].size;
    let apart = foot.position - place.position;
    let inward = -foot.normal;
    let along = apart.dot(&inward);
    let aside = (apart - inward * along).norm();
    if foot.on_rim && aside > BESIDE * size {
        return None;
    }
    let length = apart.norm();
    let (distance, towards) = match aside <= (UPRIGHT * length).max(ROUNDED * size) {
        true => (along, inward),
        false => {
            let sign = apart.dot(&place.normal).signum();
            (sign * length, apart * (sign / length))
        }
    };
    if place.normal.dot(&towards) < FACING {
        return None;
    }
    if distance < -ROUNDED * size {
        let nearest = other.foot(place.position, None)?;
        let nearer = (nearest.position - place.position).norm();
        if nearer < (1.0 - UPRIGHT) * length {
            return None;
        }
    }
    Some(Sample {
        places: [Some(place), Some(foot)],
        towards,
        distance,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::CellKind;
    use crate::body::tests::samples::{block, facets};

    /// Two sample blocks, the second one below the first and moved by a part of its width and by a distance.
    fn stack(kind: CellKind, [aside, apart]: [f64; 2]) -> (Vec<Body>, ContactPair) {
        let (upper, mut lower) = (block(kind), block(kind));
        let up = kind.dimension() - 1;
        let along = |axis: usize| {
            let at = lower.mesh.nodes.iter().map(move |x| x[axis]);
            let ends = at.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            ends[1] - ends[0]
        };
        let (width, height) = (along(0), along(up));
        for x in &mut lower.mesh.nodes {
            x[0] += aside * width;
            x[up] -= height + apart;
        }
        let pair = ContactPair {
            body: 0,
            facets: facets(&upper.mesh, "bottom"),
            opposite: Opposite::Surface {
                body: 1,
                facets: facets(&lower.mesh, "top"),
            },
            ..crate::kkt::tests::samples::pairs().remove(0)
        };
        (vec![upper, lower], pair)
    }

    #[test]
    fn flat_sides_see_each_other_at_their_distance_and_not_beside_their_ends() {
        for kind in CellKind::all() {
            for apart in [0.25, 0.0, -0.01] {
                let (bodies, pair) = stack(kind, [0.5, apart]);
                let meeting = Meeting::new(&bodies, &pair);
                assert!(!meeting.samples.is_empty(), "{kind:?}");
                let up = kind.dimension() - 1;
                for sample in &meeting.samples {
                    assert!(
                        (sample.distance - apart).abs() < 1e-12,
                        "{kind:?} {sample:?}"
                    );
                    assert!((sample.towards[up] + 1.0).abs() < 1e-12);
                    assert!(meeting.sagitta(sample) < 1e-12);
                }
                // Half of the facets lie over the other side, or nearly.
                let all: usize = meeting
                    .skins
                    .iter()
                    .map(|skin| skin.samples().count())
                    .sum();
                assert!(meeting.samples.len() < all, "{kind:?}");
            }
        }
    }

    #[test]
    fn whole_skins_see_each_other_where_they_face() {
        for kind in CellKind::all() {
            let (mut bodies, mut pair) = stack(kind, [0.0, 0.25]);
            pair.facets = bodies[0].mesh.boundary_facets();
            pair.opposite = Opposite::Surface {
                body: 1,
                facets: bodies[1].mesh.boundary_facets(),
            };
            let far = Meeting::new(&bodies, &pair).samples;
            assert!(!far.is_empty() && far.iter().all(|s| (s.distance - 0.25).abs() < 1e-12));
            // In each other by a hundredth: nothing else of the skins counts as overlap.
            let up = kind.dimension() - 1;
            bodies[1].mesh.nodes.iter_mut().for_each(|x| x[up] += 0.26);
            let fit = Meeting::new(&bodies, &pair).samples;
            let overlaps = fit.iter().filter(|sample| sample.distance < 0.0);
            assert!(overlaps.clone().count() > 0, "{kind:?}");
            assert!(
                overlaps.clone().all(|s| (s.distance + 0.01).abs() < 1e-12),
                "{kind:?}"
            );
        }
    }
}
