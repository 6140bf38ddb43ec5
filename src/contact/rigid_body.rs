//! A rigid body that carries obstacles, and how each component of its motion is given.
//!
//! ```text
//! d(x) = a + ω × (x − c)        c: reference point, a: its displacement, ω: small rotation
//! d(x) = s m                    between the faces of a cut: s: shortening, m: from its first face to the second
//! ```
//!
//! The faces of a cut are tied to each other, but for s: what is between them has no compliance, and carries a given
//! force along m or is of a given length. So a bolt is preloaded.

/// A small motion of a rigid body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidMotion {
    /// Displacement of the reference point, in metre.
    pub translation: [f64; 3],
    /// Rotation about the axes, in radian.
    pub rotation: [f64; 3],
    /// The reference point, in metre.
    pub about: [f64; 3],
}

/// How a component of the motion of a rigid body is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Component {
    /// Displacement in metre, or rotation in radian.
    Given(f64),
    /// Free under a force in newton, or a moment in newton metre.
    Free(f64),
}

/// A body without compliance, which moves as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Where the scene says so, for messages, such as `rigid_bodies[0]`.
    pub place: String,
    /// Name for messages and reports.
    pub name: String,
    /// Point that displacements, forces and moments are stated of, in metre.
    pub reference: [f64; 3],
    /// Translations along x, y, z, then rotations about them.
    pub components: [Component; 6],
    /// Contact pairs whose obstacles it carries, or the pair of the faces that it is between.
    pub pairs: Vec<usize>,
    /// It is what is between the faces of a cut; none if it carries obstacles.
    pub cut: Option<Cut>,
}

/// A cut through a bolt, the shortening of which stands in place of the first component of a rigid body; the
/// others are held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// m, of length one: from the first face of the pair to the second.
    pub towards: [f64; 3],
    /// Instant of a load history after which the shortening stays what it was then.
    pub locked_from: Option<f64>,
}

impl RigidMotion {
    /// Displacement at a position, in metre.
    #[must_use]
    pub fn at(&self, position: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|axis| position[axis] - self.about[axis]);
        let ([a, b, c], [u, v, w]) = (self.rotation, self.translation);
        [u + b * z - c * y, v + c * x - a * z, w + a * y - b * x]
    }
}

impl RigidBody {
    /// The motion of this value per component.
    #[must_use]
    pub fn motion(&self, [u, v, w, a, b, c]: [f64; 6]) -> RigidMotion {
        RigidMotion {
            translation: self.cut.map_or([u, v, w], |cut| cut.towards.map(|m| u * m)),
            rotation: [a, b, c],
            about: self.reference,
        }
    }

    /// A motion along every component that is free or moved.
    pub(crate) fn possible_motions(&self) -> impl Iterator<Item = RigidMotion> {
        let still = |component: &Component| *component == Component::Given(0.0);
        let moves = (0..6).filter(move |k| !still(&self.components[*k]));
        moves.map(|k| self.motion(std::array::from_fn(|at| f64::from(u8::from(at == k)))))
    }

    /// How much shorter a motion makes the bolt that is cut, in metre; zero without a cut.
    #[must_use]
    pub fn shortening(&self, motion: &RigidMotion) -> f64 {
        self.along(motion.translation)
    }

    /// Component of a vector from the first face of its cut to the second; zero without a cut.
    #[must_use]
    pub fn along(&self, vector: [f64; 3]) -> f64 {
        let towards = self.cut.map_or([0.0; 3], |cut| cut.towards);
        vector.iter().zip(towards).map(|(v, m)| v * m).sum()
    }

    /// Force and moment of these values per component, in global axes.
    #[must_use]
    pub fn wrench(&self, [u, v, w, a, b, c]: [f64; 6]) -> [[f64; 3]; 2] {
        let force = self.cut.map_or([u, v, w], |cut| cut.towards.map(|m| u * m));
        [force, [a, b, c]]
    }

    /// The part of a force that free components answer.
    #[must_use]
    pub fn freely(&self, force: [f64; 3]) -> [f64; 3] {
        let free = |k| matches!(self.components[k], Component::Free(_));
        match self.cut {
            Some(Cut { towards, .. }) if free(0) => towards.map(|m| self.along(force) * m),
            Some(_) => [0.0; 3],
            None => [0, 1, 2].map(|k| if free(k) { force[k] } else { 0.0 }),
        }
    }

    /// Numbers of the components that can move in 2D or 3D.
    pub(crate) fn movable(&self, dimension: usize) -> impl Iterator<Item = usize> + use<> {
        let cut = self.cut.is_some();
        (0..6).filter(move |k| match cut {
            true => *k == 0,
            false => dimension == 3 || [0, 1, 5].contains(k),
        })
    }

    /// Where a scene in 2D or 3D states a component, such as `rigid_bodies[0].force[1]`.
    #[must_use]
    pub fn component_place(&self, component: usize, dimension: usize) -> String {
        if self.cut.is_some() {
            let key = match self.components[component] {
                Component::Given(_) => "shortening",
                Component::Free(_) => "force",
            };
            return format!("{}.{key}", self.place);
        }
        let key = match (self.components[component], component < 3) {
            (Component::Given(_), true) => "displacement",
            (Component::Free(_), true) => "force",
            (Component::Given(_), false) => "rotation",
            (Component::Free(_), false) => "moment",
        };
        let entry = match (component, dimension) {
            (0..3, _) => component,
            (_, 2) => 0,
            _ => component - 3,
        };
        format!("{}.{key}[{entry}]", self.place)
    }

    /// Numbers of the components that are free.
    pub fn free(&self) -> impl Iterator<Item = usize> + '_ {
        let free = |k: &usize| matches!(self.components[*k], Component::Free(_));
        (0..6).filter(free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_body_moves_across_the_arm() {
        // A quarter of a radian about z through (1, 0, 0): (1, 2, 0) goes by −0.5 along x.
        let motion = RigidMotion {
            translation: [0.0, 3.0, 0.0],
            rotation: [0.0, 0.0, 0.25],
            about: [1.0, 0.0, 0.0],
        };
        assert_eq!(motion.at([1.0, 2.0, 0.0]), [-0.5, 3.0, 0.0]);
        // About x through the same point: (1, 2, 0) rises along z.
        let motion = RigidMotion {
            rotation: [0.25, 0.0, 0.0],
            translation: [0.0; 3],
            ..motion
        };
        assert_eq!(motion.at([1.0, 2.0, 0.0]), [0.0, 0.0, 0.5]);
    }
}
