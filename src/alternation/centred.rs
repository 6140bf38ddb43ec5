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
//!
//! Glue that bears far more than is asked of it costs digits, as t' is then far from zero: where they are missing, c is
//! made so much less that it still is out of reach.

use faer::Mat;

use super::finish as newton;
use super::{Outcome, Settings, Shortfall, Status};
use crate::error::Error;
use crate::kkt::Judge;
use crate::problem::{ContactProblem, Ellipse, Floating, Law, Operator};

/// Glue out of reach bears so many times the largest reaction.
const OUT_OF_REACH: f64 = 4.0;

/// All digits: the tolerance of a second solve where the first one has too few.
const CLOSEST: f64 = 1e-15;

/// A problem and the one that is solved in its place (D15), with what turns reactions and displacements of one into
/// those of the other.
pub struct Centred<'a> {
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
    if centred.moved.is_none() {
        return solve(stated, &centred);
    }
    let found = as_centred(&centred, settings, &solve)?;
    let weaker = match found.status {
        Status::NotConverged => centred.weaker(&found.reaction)?,
        _ => None,
    };
    let Some(weaker) = weaker else {
        return Ok(found);
    };
    let again = as_centred(&weaker, settings, &solve)?;
    Ok(match again.status {
        Status::Certified => again.after(found),
        _ => found,
    })
}

fn as_centred(
    centred: &Centred<'_>,
    settings: &Settings,
    solve: impl Fn(&ContactProblem, &Centred<'_>) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    let found = solve(centred.solved(), centred)?;
    let outcome = centred.as_stated(found.clone(), settings);
    let (asked, left) = (settings.tolerance, outcome.verdict.certificate.residual());
    if found.status != Status::Certified || left <= asked {
        return Ok(outcome);
    }
    // Lengths of t and t' differ.
    let closer = Settings {
        tolerance: CLOSEST,
        ..*settings
    };
    let again = newton(centred.solved(), &closer, &found.reaction, &found.motion)?;
    Ok(centred.as_stated(again.after(found), settings))
}

impl<'a> Centred<'a> {
    /// Of a problem as it is stated.
    ///
    /// # Errors
    ///
    /// Numbers that overflow as they are turned.
    pub fn new(stated: &'a ContactProblem) -> Result<Self, Error> {
        let laws = stated.laws().unwrap_or_default();
        let off = |law: &Law| law.tension > 0.0 || law.ellipse.is_some();
        let moved = match laws.iter().any(off) {
            false => None,
            true => Some(Moved::new(stated, laws)?),
        };
        Ok(Self { stated, moved })
    }

    /// With glue that bears less wherever it is far from what it bears under a reaction; none where that is nowhere.
    fn weaker(&self, reaction: &[f64]) -> Result<Option<Self>, Error> {
        let Some(moved) = &self.moved else {
            return Ok(None);
        };
        let bears = OUT_OF_REACH * reaction.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
        let mut laws = moved.laws.clone();
        for (law, &normal) in laws.iter_mut().zip(self.stated.normals()) {
            if OUT_OF_REACH * reaction[normal] < law.tension {
                law.tension = law.tension.min(bears);
            }
        }
        if bears == 0.0 || laws == moved.laws {
            return Ok(None);
        }
        Ok(Some(Self {
            moved: Some(Moved::new(self.stated, &laws)?),
            ..*self
        }))
    }

    pub(super) fn stated(&self) -> &'a ContactProblem {
        self.stated
    }

    pub(super) fn solved(&self) -> &ContactProblem {
        self.moved
            .as_ref()
            .map_or(self.stated, |moved| &moved.problem)
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

    /// Changes of reactions `B ṫ'`, in place.
    pub(super) fn turn_back(&self, reaction: &mut [f64]) {
        if let Some(moved) = &self.moved {
            moved.turn_by(reaction, axes);
        }
    }

    /// Changes of displacements `B⁻ᵀ u̇'`, in place.
    pub(super) fn turn_back_displacement(&self, displacement: &mut [f64]) {
        if let Some(moved) = &self.moved {
            moved.turn_by(displacement, |ellipse| {
                let ratio = ellipse.ratio.recip();
                axes(Ellipse { ratio, ..ellipse })
            });
        }
    }

    /// What was found, as it was asked for.
    fn as_stated(&self, mut outcome: Outcome, settings: &Settings) -> Outcome {
        let Some(moved) = &self.moved else {
            return outcome;
        };
        moved.turn_by(&mut outcome.reaction, axes);
        for (&normal, law) in self.stated.normals().iter().zip(&moved.laws) {
            outcome.reaction[normal] += law.tension;
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
            Status::NotConverged if within => {
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
        self.turn_by(displacement, |ellipse| {
            let [[a, b], [c, d]] = axes(ellipse);
            [[a, c], [b, d]]
        });
    }

    /// The matrix of each ellipse times the tangential part, in place.
    fn turn_by(&self, vector: &mut [f64], matrix: impl Fn(Ellipse) -> [[f64; 2]; 2]) {
        for (contact, law) in self.laws.iter().enumerate() {
            let block = &mut vector[self.problem.block(contact)];
            if let (Some(ellipse), [_, x, y]) = (law.ellipse, block) {
                let [[a, b], [c, d]] = matrix(ellipse);
                (*x, *y) = (a * *x + b * *y, c * *x + d * *y);
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
