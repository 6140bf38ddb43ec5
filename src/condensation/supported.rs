//! The supported body: which displacements are unknown, and how they are condensed.

use std::time::Instant;

use faer::Mat;
use sprs::CsMat;

use super::columns::Matrix;
use super::condensed_body::{CondensedBody, FactoredBody};
use super::engine::{BodyFactor, By};
use super::factor::{Breakdown, Factor, Precision, count};
use super::grounding::Grounding;
use super::interface::Interface;
use super::load_case::Given;
use super::local_axes::{Frames, InterfaceNode};
use super::mumps::{Divided, Refusal, Whole};
use super::ordering::{Ordering, Role};
use super::work::{CondensationWork, Fallback};
use crate::body::{Body, Dependence};
use crate::error::Error;
use crate::stage::Stage;

/// Unknowns from which on a factor in single precision pays.
const WORTH: usize = 8_000;

/// The assembled body, before it is condensed.
pub(super) struct SupportedBody<'a> {
    pub(super) name: &'a str,
    pub(super) nodes: &'a [[f64; 3]],
    pub(super) dimension: usize,
    pub(super) stiffness: CsMat<f64>,
    pub(super) load: Vec<f64>,
    pub(super) given: Given,
    pub(super) dependence: Option<Dependence>,
    pub(super) grounding: Grounding,
}

/// What the factor of a body will take.
pub(super) struct Counted {
    pub(super) unknowns: usize,
    /// Those that the body is condensed onto.
    pub(super) condensed: usize,
    /// Stored entries.
    pub(super) entries: usize,
    /// Multiplications, each with an addition.
    pub(super) operations: f64,
    /// That the entries will have.
    pub(super) precision: Precision,
}

impl SupportedBody<'_> {
    /// Orders, factorises and condenses onto the interface: the body, and its G there, in m/N.
    pub(super) fn condense(
        self,
        interface: &Interface,
        by: By<'_>,
        work: &mut CondensationWork,
    ) -> Result<(CondensedBody, Mat<f64>), Error> {
        Stage::Ordering.begin();
        let start = Instant::now();
        let nodes = interface.condensed_nodes();
        let frames = Frames::new(self.dimension, self.nodes.len(), nodes);
        let (roles, contact) = self.roles(nodes);
        let tied = self.dependence.as_ref();
        let reduced = tied.map(|tied| tied.reduce(&self.stiffness));
        let stiffness = reduced.as_ref().unwrap_or(&self.stiffness);
        let ordering = Ordering::new(stiffness, (self.nodes, self.dimension), &roles, &contact)
            .ok_or_else(|| self.too_large("ordering"))?;
        work.ordering_seconds += start.elapsed().as_secs_f64();

        Stage::Factorisation.begin();
        let start = Instant::now();
        let grounded = self.grounding.ground(stiffness, &self.stiffness);
        let matrix = Matrix {
            stiffness: &grounded,
            frames: &frames,
            ordering: &ordering,
            border: &interface.border,
        };
        let mut factor = match by {
            By::Faer(wanted) => BodyFactor::Faer(self.factorise(&matrix, wanted, work)?),
            By::Mumps(body, index) => {
                let divided = self.divide(&matrix, (body, index))?;
                work.factorisations += 1;
                work.numeric_seconds += divided.numeric_seconds();
                BodyFactor::Mumps(divided)
            }
        };
        work.factorisation_seconds += start.elapsed().as_secs_f64();
        work.unknowns += ordering.unknowns();
        work.condensed_unknowns += factor.contact_unknowns();
        work.factor_entries += factor.entries();
        work.factor_bytes += factor.bytes();

        Stage::Condensation.begin();
        let start = Instant::now();
        let compliance = factor.compliance();
        let factored = FactoredBody {
            stiffness: self.stiffness,
            dependence: self.dependence,
            frames,
            ordering,
            factor,
            grounding: self.grounding,
        };
        let body = CondensedBody::new(factored, self.load, self.given);
        work.substitutions += 1;
        work.condensation_seconds += start.elapsed().as_secs_f64();
        Ok((body, compliance))
    }

    /// The factor, in double precision where single precision is not enough for one.
    fn factorise(
        &self,
        matrix: &Matrix<'_>,
        wanted: Precision,
        work: &mut CondensationWork,
    ) -> Result<Factor, Error> {
        let precision = self.worth(wanted, matrix.ordering);
        let mut made = Factor::new(matrix, self.dimension, precision);
        work.factorisations += 1;
        if let (
            Precision::Single,
            Err(Breakdown::Pivot {
                pivot, diagonal, ..
            }),
        ) = (precision, &made)
        {
            let part = pivot / diagonal;
            work.fallback = Some(Fallback::Pivot { part });
            made = Factor::new(matrix, self.dimension, Precision::Double);
            work.factorisations += 1;
        }
        let factor = made.map_err(|breakdown| self.explain(breakdown))?;
        work.single_factors += usize::from(factor.precision() == Precision::Single);
        work.numeric_seconds += factor.numeric_seconds;
        Ok(factor)
    }

    /// The factor that ranks share.
    fn divide(&self, matrix: &Matrix<'_>, (body, index): (&Body, usize)) -> Result<Divided, Error> {
        let divided = Divided::new(&Whole {
            body,
            index,
            stiffness: matrix.stiffness,
            springs: &self.grounding.springs,
            ordering: matrix.ordering,
            border: matrix.border,
        });
        divided.map_err(|refusal| self.refuse(refusal))
    }

    /// Single precision only where it pays.
    fn worth(&self, wanted: Precision, ordering: &Ordering) -> Precision {
        match self.dimension == 3 && ordering.unknowns() >= WORTH {
            true => wanted,
            false => Precision::Double,
        }
    }

    /// Orders, and counts what the factor will take.
    pub(super) fn count(self, interface: &Interface, wanted: Precision) -> Result<Counted, Error> {
        let nodes = interface.condensed_nodes();
        let frames = Frames::new(self.dimension, self.nodes.len(), nodes);
        let (roles, contact) = self.roles(nodes);
        let ordering = Ordering::new(
            &self.stiffness,
            (self.nodes, self.dimension),
            &roles,
            &contact,
        )
        .ok_or_else(|| self.too_large("ordering"))?;
        let grounded = self.grounding.ground(&self.stiffness, &self.stiffness);
        let matrix = Matrix {
            stiffness: &grounded,
            frames: &frames,
            ordering: &ordering,
            border: &interface.border,
        };
        let (entries, operations) =
            count(&matrix, self.dimension).map_err(|breakdown| self.explain(breakdown))?;
        Ok(Counted {
            unknowns: ordering.unknowns(),
            condensed: ordering.contact_unknowns + interface.border.len(),
            entries,
            operations,
            precision: self.worth(wanted, &ordering),
        })
    }

    /// The role of each degree of freedom in the frames, and the interface unknowns in order.
    fn roles(&self, interface: &[InterfaceNode]) -> (Vec<Role>, Vec<usize>) {
        let role = |held: bool| if held { Role::Held } else { Role::Ordinary };
        let prescribed = &self.given.prescribed;
        let depends = |dof| {
            self.dependence
                .as_ref()
                .is_some_and(|tied| tied.of(dof).is_some())
        };
        let mut roles: Vec<Role> = (0..prescribed.len())
            .map(|dof| role(prescribed[dof].is_some() || depends(dof)))
            .collect();
        let mut contact = Vec::new();
        for node in interface {
            let first = node.node * self.dimension;
            let supported = &prescribed[first..first + self.dimension];
            for (row, direction) in node.frame[..self.dimension].iter().enumerate() {
                let mut along = direction.iter().zip(supported);
                roles[first + row] = if row < node.kept {
                    contact.push(first + row);
                    Role::Contact
                } else {
                    // Held tangents are global axes: the component is one or zero.
                    role(along.any(|(d, u)| u.is_some() && d.abs() > 0.5))
                };
            }
        }
        (roles, contact)
    }

    fn too_large(&self, stage: &'static str) -> Error {
        Error::TooLarge {
            body: self.name.to_owned(),
            stage,
            unknowns: self.load.len(),
        }
    }

    fn explain(&self, breakdown: Breakdown) -> Error {
        match breakdown {
            Breakdown::TooLarge => self.too_large("factorisation"),
            Breakdown::Pivot {
                dof,
                pivot,
                diagonal,
            } => self.moves(dof, pivot, diagonal),
        }
    }

    fn refuse(&self, refusal: Refusal) -> Error {
        match refusal {
            Refusal::TooLarge => self.too_large("factorisation"),
            Refusal::Moves {
                dof,
                resistance,
                diagonal,
            } => self.moves(dof, resistance, diagonal),
            Refusal::Says(found) => Error::NotAccepted {
                place: self.name.to_owned(),
                found,
                accepted: "a factorisation by MUMPS on all ranks".to_owned(),
            },
        }
    }

    fn moves(&self, dof: usize, pivot: f64, diagonal: f64) -> Error {
        Error::NotPositiveDefinite {
            body: self.name.to_owned(),
            node: dof / self.dimension,
            position: self.nodes[dof / self.dimension],
            pivot,
            diagonal,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::condensation::tests::bed::{Bed, dense};
    use faer::Mat;
    use faer::linalg::solvers::Solve;

    fn beds() -> Vec<Bed> {
        let mut beds = Vec::new();
        for cells in [[9, 6, 0], [4, 3, 4]] {
            for tilt in [0.0, 0.4] {
                for friction in [true, false] {
                    beds.push(Bed::new(cells, tilt, friction));
                }
            }
        }
        beds
    }

    fn assert_close(found: &Mat<f64>, expected: &Mat<f64>) {
        let difference = (found - expected).norm_max();
        assert!(difference < 1e-12 * expected.norm_max(), "{difference:e}");
    }

    #[test]
    fn the_compliance_is_the_displacement_under_unit_contact_forces() {
        for bed in beds() {
            let directions = bed.contact_directions();
            let expected = directions.transpose() * bed.solve(&directions, false);
            assert_close(bed.condense().unwrap().problem.compliance(), &expected);
        }
    }

    #[test]
    fn the_stiffness_is_the_schur_complement_of_the_contact_unknowns() {
        // Flat bed, so the frames are global axes up to sign: S = K_cc − K_co K_oo⁻¹ K_oc.
        let bed = Bed::new([9, 6, 0], 0.0, true);
        let directions = bed.contact_directions();
        let matrix = dense(&bed.lattice.stiffness());
        let touches = |dof: usize| (0..directions.ncols()).any(|c| directions[(dof, c)] != 0.0);
        let ordinary: Vec<usize> = (0..matrix.nrows())
            .filter(|&dof| bed.prescribed[dof].is_none() && !touches(dof))
            .collect();
        let size = ordinary.len();
        let k_oo = Mat::from_fn(size, size, |i, j| matrix[(ordinary[i], ordinary[j])]);
        let turned = &matrix * &directions;
        let k_oc = Mat::from_fn(size, directions.ncols(), |i, j| turned[(ordinary[i], j)]);
        let k_cc = directions.transpose() * &turned;
        let expected = k_cc - k_oc.transpose() * k_oo.partial_piv_lu().solve(&k_oc);
        let condensed = bed.condense().unwrap();
        assert_close(condensed.problem.operator().stiffness().unwrap(), &expected);
    }

    #[test]
    fn the_free_displacement_follows_load_and_moved_supports() {
        for bed in beds() {
            let expected =
                bed.contact_directions().transpose() * bed.solve(&bed.load_column(), true);
            let condensed = bed.condense().unwrap();
            let found = condensed.problem.free_displacement();
            let found = Mat::from_fn(found.len(), 1, |i, _| found[i]);
            assert_close(&found, &expected);
        }
    }

    #[test]
    fn the_recovered_body_is_that_of_the_load_and_the_contact_forces() {
        for bed in beds() {
            let condensed = bed.condense().unwrap();
            let directions = bed.contact_directions();
            let count = directions.ncols();
            let reaction: Vec<f64> = (0..count).map(|i| ((5 * i) % 11) as f64 - 5.0).collect();
            let forces = Mat::from_fn(count, 1, |i, _| reaction[i]);
            let found = condensed.recover(&reaction);
            let found = Mat::from_fn(found.len(), 1, |i, _| found[i]);
            let expected = bed.solve(&(bed.load_column() + &directions * &forces), true);
            assert_close(&found, &expected);
            // (C1): the contact's part of it is û + G t.
            let problem = &condensed.problem;
            let free = problem.free_displacement();
            let free = Mat::from_fn(count, 1, |i, _| free[i]);
            let contact = free + problem.compliance() * &forces;
            assert_close(&(directions.transpose() * &found), &contact);
        }
    }

    #[test]
    fn without_friction_the_compliance_is_the_normal_part_of_that_with_friction() {
        for (cells, block) in [([9, 6, 0], 2), ([4, 3, 4], 3)] {
            let rough = Bed::new(cells, 0.4, true).condense().unwrap();
            let smooth = Bed::new(cells, 0.4, false).condense().unwrap();
            let offsets = rough.problem.offsets();
            assert_eq!(
                offsets[offsets.len() - 1] - offsets[offsets.len() - 2],
                block
            );
            let all = rough.problem.compliance();
            let contacts = smooth.problem.contacts();
            let normal = Mat::from_fn(contacts, contacts, |i, j| all[(offsets[i], offsets[j])]);
            assert_eq!(smooth.problem.unknowns(), contacts);
            assert_close(smooth.problem.compliance(), &normal);
        }
    }

    #[test]
    fn a_symmetry_plane_keeps_one_tangent_less() {
        let flat = Bed::new([9, 6, 0], 0.0, true).condense().unwrap();
        // Listed against the node numbers: the node at x = 9 comes first, held along x.
        let offsets = flat.problem.offsets();
        assert_eq!((offsets[1], offsets[2]), (1, 3));
    }

    #[test]
    fn a_body_without_supports_is_refused_with_the_node_where_it_breaks_down() {
        let mut bed = Bed::new([6, 5, 0], 0.0, true);
        bed.prescribed.fill(None);
        let found = bed.condense().unwrap_err();
        assert!(
            matches!(found, Error::NotPositiveDefinite { .. }),
            "{found}"
        );
    }

    #[test]
    fn a_load_that_is_not_a_number_is_refused() {
        let mut bed = Bed::new([3, 3, 0], 0.0, true);
        bed.load[5] = f64::NAN;
        assert!(bed.condense().is_err());
    }
}
