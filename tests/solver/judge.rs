//! What the judge says does not depend on how a problem is written down, and a state is
//! certified exactly when it solves the problem.

use dpana::Judge;
use dpana::kkt::{ContactStatus, Verdict};
use dpana::problem::{ContactProblem, Operator};
use faer::Mat;
use proptest::collection::vec;
use proptest::prelude::*;

/// A random problem and any state of it; every contact has two tangents.
#[derive(Clone, Debug)]
struct State {
    friction: Vec<f64>,
    gap: Vec<f64>,
    free: Vec<f64>,
    compliance: Mat<f64>,
    reaction: Vec<f64>,
}

impl State {
    fn problem(&self) -> ContactProblem {
        let operator = Operator::from_compliance(self.compliance.clone()).unwrap();
        let (friction, gap, free) = (self.friction.clone(), self.gap.clone(), self.free.clone());
        ContactProblem::new(&vec![2; self.gap.len()], friction, gap, free, operator).unwrap()
    }

    fn judged(&self) -> Verdict {
        Judge::new(&self.problem()).measure(&self.reaction)
    }

    /// The same state with unknown `k` written as `Σ_j T_kj (old unknown j)`.
    fn transformed(&self, t: &Mat<f64>) -> Self {
        let vector = |v: &[f64]| -> Vec<f64> {
            (0..v.len())
                .map(|k| (0..v.len()).map(|j| t[(k, j)] * v[j]).sum())
                .collect()
        };
        let product = t * &self.compliance * t.transpose();
        Self {
            free: vector(&self.free),
            reaction: vector(&self.reaction),
            compliance: Mat::from_fn(t.nrows(), t.nrows(), |i, j| {
                0.5 * (product[(i, j)] + product[(j, i)])
            }),
            ..self.clone()
        }
    }
}

/// G = A Aᵀ + I/10 with entries of A in (−1, 1), gaps, displacements and reactions of order one.
fn state() -> impl Strategy<Value = State> {
    (1_usize..6).prop_flat_map(|contacts| {
        let unknowns = 3 * contacts;
        let entries = vec(-1.0..1.0, unknowns * unknowns);
        let per_contact = (vec(0.0..2.0, contacts), vec(-1.0..1.0, contacts));
        let per_unknown = (vec(-1.0..1.0, unknowns), vec(-1.0..1.0, unknowns));
        (entries, per_contact, per_unknown).prop_map(
            move |(entries, (friction, gap), (free, reaction))| {
                let a = Mat::from_fn(unknowns, unknowns, |i, j| entries[i + unknowns * j]);
                let compliance = &a * a.transpose()
                    + Mat::<f64>::identity(unknowns, unknowns) * faer::Scale(0.1);
                State {
                    friction,
                    gap,
                    free,
                    compliance,
                    reaction,
                }
            },
        )
    })
}

/// Every number of the certificate that must not depend on the units.
fn scaled(verdict: &Verdict) -> [f64; 6] {
    let found = verdict.certificate;
    [
        found.natural_map,
        found.penetration.scaled,
        found.tension.scaled,
        found.complementarity.scaled,
        found.disc_excess.scaled,
        found.dissipation_defect.scaled,
    ]
}

fn close(left: [f64; 6], right: [f64; 6], tolerance: f64) -> bool {
    left.iter()
        .zip(right)
        .all(|(a, b)| (a - b).abs() <= tolerance * (1.0 + a.abs()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn units_do_not_matter(state in state(), length in -12_i32..12, force in -12_i32..12) {
        let (length, force) = (10.0_f64.powi(length), 10.0_f64.powi(force));
        let by = |v: &[f64], scale: f64| -> Vec<f64> { v.iter().map(|x| x * scale).collect() };
        let other = State {
            gap: by(&state.gap, length),
            free: by(&state.free, length),
            reaction: by(&state.reaction, force),
            compliance: &state.compliance * faer::Scale(length / force),
            ..state.clone()
        };
        prop_assert!(close(scaled(&state.judged()), scaled(&other.judged()), 1e-12));
    }

    #[test]
    fn the_order_of_the_contacts_does_not_matter(state in state()) {
        let contacts = state.gap.len();
        let turned = |k: usize| (contacts - 1 - k / 3) * 3 + k % 3;
        let t = Mat::from_fn(3 * contacts, 3 * contacts, |i, j| f64::from(u8::from(turned(i) == j)));
        let mut other = state.transformed(&t);
        other.gap.reverse();
        other.friction.reverse();
        let (found, expected) = (other.judged(), state.judged());
        prop_assert!(close(scaled(&found), scaled(&expected), 1e-12));
        let status: Vec<_> = expected.status.into_iter().rev().collect();
        prop_assert_eq!(found.status, status);
    }

    #[test]
    fn the_direction_of_the_tangents_does_not_matter(state in state(), angle in 0.0..6.3_f64) {
        let (sin, cos) = angle.sin_cos();
        let turn = [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]];
        let t = Mat::from_fn(state.free.len(), state.free.len(), |i, j| {
            if i / 3 == j / 3 { turn[i % 3][j % 3] } else { 0.0 }
        });
        let other = state.transformed(&t);
        // ε times the condition of G, 75/0.1, twice: the scale of an energy is a force times a length.
        prop_assert!(close(scaled(&other.judged()), scaled(&state.judged()), 1e-10));
    }

    /// A solution made to order: any reaction on its laws, and the free displacement that goes
    /// with it. It is certified to round-off, with the states it was made of, and is no longer
    /// once a reaction is off by a millionth.
    #[test]
    fn a_solution_is_certified_and_its_neighbour_is_not(
        state in state(),
        kinds in vec(0_usize..3, 5),
        at in 0_usize..15,
    ) {
        let solution = solution(state, &kinds);
        let verdict = solution.judged();
        let certificate = verdict.certificate;
        prop_assert!(certificate.natural_map < 1e-13, "{}", certificate.natural_map);
        prop_assert!(certificate.bipotential_gap.abs() <= 1e-12 * (1.0 + certificate.reaction_energy));
        prop_assert!(scaled(&verdict).iter().all(|&residual| residual < 1e-13));
        let expected = kinds.iter().map(|kind| [ContactStatus::Open, ContactStatus::Stick, ContactStatus::Slip][*kind]);
        let expected: Vec<_> = expected.take(solution.gap.len()).collect();
        prop_assert_eq!(verdict.status, expected);

        let mut off = solution.clone();
        let at = at % off.reaction.len();
        // The displacement changes by that times 0.1 to 75, the range of eigenvalues of G.
        off.reaction[at] += 1e-6;
        prop_assert!(off.judged().certificate.natural_map > 1e-9);
    }
}

/// Makes contact `i` open, stick or slip (0, 1, 2) and chooses û so that (L1)–(L3) hold.
fn solution(mut state: State, kinds: &[usize]) -> State {
    let mut displacement = vec![0.0; state.free.len()];
    for i in 0..state.gap.len() {
        state.friction[i] += 0.1;
        let (size, direction) = (state.reaction[3 * i].abs() + 0.1, state.free[3 * i] * 3.0);
        let bound = state.friction[i] * size;
        let (reaction, u) = (
            &mut state.reaction[3 * i..3 * i + 3],
            &mut displacement[3 * i..3 * i + 3],
        );
        let (sin, cos) = direction.sin_cos();
        match kinds[i] {
            0 => {
                reaction.fill(0.0);
                u.copy_from_slice(&[state.gap[i] - size, sin, cos]);
            }
            1 => {
                reaction.copy_from_slice(&[-size, 0.5 * bound * sin, 0.5 * bound * cos]);
                u[0] = state.gap[i];
            }
            _ => {
                reaction.copy_from_slice(&[-size, bound * sin, bound * cos]);
                u.copy_from_slice(&[state.gap[i], -0.2 * sin, -0.2 * cos]);
            }
        }
    }
    for k in 0..displacement.len() {
        let response: f64 = (0..displacement.len())
            .map(|j| state.compliance[(k, j)] * state.reaction[j])
            .sum();
        state.free[k] = displacement[k] - response;
    }
    state
}
