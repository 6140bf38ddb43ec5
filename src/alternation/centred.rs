//! Sets of reactions that lie off their cone, or are no discs, are solved for where they are.
//!
//! ```text
//! (D15)  t = c n + B t',    B = 1, or Q diag(1, μ₂/μ) in the tangents of an ellipse with the axes Q
//!        û' = Bᵀ (û + G c n),   G' = Bᵀ G B,   R' = Bᵀ R,   e' = e + Rᵀ c n,   a' = a − μ c
//! ```
//!
//! The laws (L4), (L5) of t and u are then those of t' and u' = Bᵀ u without tension and ellipse: the gaps are the
//! same, and so is the work t · u but for that of glue, which bears c whatever happens. The answer is judged as it
//! was asked for, in t.

use faer::Mat;

use super::finish as newton;
use super::{Outcome, Settings, Shortfall, Status};
use crate::error::Error;
use crate::kkt::Judge;
use crate::problem::{ContactProblem, Ellipse, Floating, Law, Operator};

/// Part of the residual that is left over the one that is asked for, to which a second solve goes.
const CLOSER: f64 = 0.3;

/// What turns reactions and displacements into those of the problem that is solved.
pub(super) struct Centred<'a> {
    stated: &'a ContactProblem,
    /// None where nothing has to be moved.
    moved: Option<Moved>,
}

struct Moved {
    problem: ContactProblem,
    laws: Vec<Law>,
}

/// Solves a problem whose sets are cones, discs and what bounds them; `solve` gets it, and what turns
/// reactions and displacements into its own.
pub(super) fn on_centred_sets(
    stated: &ContactProblem,
    settings: &Settings,
    solve: impl Fn(&ContactProblem, &Centred<'_>) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    let centred = Centred::new(stated)?;
    let Some(moved) = &centred.moved else {
        return solve(stated, &centred);
    };
    let found = solve(&moved.problem, &centred)?;
    let outcome = centred.as_stated(found.clone(), settings);
    let (asked, left) = (settings.tolerance, outcome.verdict.certificate.residual());
    if found.status != Status::Certified || left <= asked {
        return Ok(outcome);
    }
    // Lengths of t and t' differ: some digits more.
    let closer = Settings {
        tolerance: (CLOSER * asked * asked / left).max(1e-15),
        ..*settings
    };
    let again = newton(&moved.problem, &closer, &found.reaction, &found.motion)?;
    Ok(centred.as_stated(again.after(found), settings))
}

impl<'a> Centred<'a> {
    fn new(stated: &'a ContactProblem) -> Result<Self, Error> {
        let laws = stated.laws().unwrap_or_default();
        let off = |law: &Law| law.tension > 0.0 || law.ellipse.is_some();
        let moved = match laws.iter().any(off) {
            false => None,
            true => Some(Moved::new(stated, laws)?),
        };
        Ok(Self { stated, moved })
    }

    /// `t'`, in newton per unknown.
    pub(super) fn reaction(&self, stated: &[f64]) -> Vec<f64> {
        let mut reaction = stated.to_vec();
        let Some(moved) = &self.moved else {
            return reaction;
        };
        for (contact, law) in moved.laws.iter().enumerate() {
            let block = &mut reaction[self.stated.block(contact)];
            block[0] -= law.tension;
            if let (Some(ellipse), [_, t_1, t_2]) = (law.ellipse, block) {
                let ([c, s], [x, y]) = (ellipse.direction, [*t_1, *t_2]);
                (*t_1, *t_2) = (c * x + s * y, (c * y - s * x) / ellipse.ratio);
            }
        }
        reaction
    }

    /// `u'`, in metre per unknown.
    pub(super) fn displacement(&self, stated: &[f64]) -> Vec<f64> {
        let mut displacement = stated.to_vec();
        if let Some(moved) = &self.moved {
            moved.turn(&mut displacement);
        }
        displacement
    }

    /// What was found, as it was asked for.
    fn as_stated(&self, mut outcome: Outcome, settings: &Settings) -> Outcome {
        let Some(moved) = &self.moved else {
            return outcome;
        };
        for (contact, law) in moved.laws.iter().enumerate() {
            let block = &mut outcome.reaction[self.stated.block(contact)];
            block[0] += law.tension;
            if let (Some(ellipse), [_, t_1, t_2]) = (law.ellipse, block) {
                let [[a, b], [c, d]] = axes(ellipse);
                (*t_1, *t_2) = (a * *t_1 + b * *t_2, c * *t_1 + d * *t_2);
            }
        }
        let (reaction, motion) = (&outcome.reaction, &outcome.motion);
        outcome.verdict =
            Judge::new(self.stated).measure_moved(reaction, motion, &outcome.motion_left_out);
        let residual = outcome.verdict.certificate.residual();
        let within = residual <= settings.tolerance;
        match outcome.status {
            Status::Certified if !within => {
                outcome.status = Status::NotConverged;
                outcome.shortfall = Some(Shortfall::RoundOff { floor: residual });
            }
            // What more digits were asked of for their own sake.
            Status::NotConverged if within && outcome.shortfall == Some(Shortfall::SweepLimit) => {
                (outcome.status, outcome.shortfall) = (Status::Certified, None);
            }
            _ => {}
        }
        outcome
    }
}

impl Moved {
    fn new(stated: &ContactProblem, laws: &[Law]) -> Result<Self, Error> {
        let mut glue = vec![0.0; stated.unknowns()];
        for (&normal, law) in stated.normals().iter().zip(laws) {
            glue[normal] = law.tension;
        }
        let centred = laws.iter().zip(stated.friction()).map(|(law, mu)| Law {
            tension: 0.0,
            shear: (law.shear - mu * law.tension).max(0.0),
            ellipse: None,
            ..*law
        });
        let mut moved = Self {
            problem: stated.under(Some(centred.collect())),
            laws: laws.to_vec(),
        };
        let mut free = stated.displacement(&glue);
        moved.turn(&mut free);
        if laws.iter().any(|law| law.ellipse.is_some()) {
            let operator = Operator::from_bodies(moved.turned(stated.compliance()))?;
            moved.problem = moved.problem.with_operator(operator);
        }
        moved.problem = moved.problem.step(free, vec![0.0; stated.unknowns()])?;
        if let Some(floating) = stated.floating() {
            let mut modes = floating.modes().to_owned();
            let carried = modes.col_iter().zip(floating.load());
            let load = carried
                .map(|(mode, e)| e + mode.iter().zip(&glue).map(|(r, c)| r * c).sum::<f64>());
            let load: Vec<f64> = load.collect();
            for k in 0..modes.ncols() {
                moved.turn(modes.col_as_slice_mut(k));
            }
            moved.problem = moved.problem.float(Floating::of_bodies(modes, load)?)?;
        }
        Ok(moved)
    }

    /// `Bᵀ u`, in place.
    fn turn(&self, displacement: &mut [f64]) {
        for (contact, law) in self.laws.iter().enumerate() {
            let block = &mut displacement[self.problem.block(contact)];
            if let (Some(ellipse), [_, u_1, u_2]) = (law.ellipse, block) {
                let [[a, b], [c, d]] = axes(ellipse);
                (*u_1, *u_2) = (a * *u_1 + c * *u_2, b * *u_1 + d * *u_2);
            }
        }
    }

    /// `Bᵀ G B`.
    fn turned(&self, compliance: &Mat<f64>) -> Mat<f64> {
        let half = |matrix: &Mat<f64>| {
            let mut turned = matrix.clone();
            for k in 0..turned.ncols() {
                self.turn(turned.col_as_slice_mut(k));
            }
            turned.transpose().to_owned()
        };
        let both = half(&half(compliance));
        // Rounding has left it as good as symmetric.
        Mat::from_fn(both.nrows(), both.ncols(), |i, j| {
            0.5 * (both[(i, j)] + both[(j, i)])
        })
    }
}

/// `Q diag(1, ratio)`, row by row.
fn axes(ellipse: Ellipse) -> [[f64; 2]; 2] {
    let [c, s] = ellipse.direction;
    [[c, -s * ellipse.ratio], [s, c * ellipse.ratio]]
}
