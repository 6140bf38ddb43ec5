//! What the solve took: counts, seconds by stage, sweep by sweep.

use serde::Serialize;

use super::ReportParts;
use crate::alternation::SweepRecord;
use crate::condensation::{Fallback, RankMemory};

/// What the stages around the outer loop took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageWork {
    /// Factorisations of the body's stiffness.
    pub factorisations: usize,
    /// Factors that are in single precision.
    pub single_factors: usize,
    /// Rounds by which bodies and contacts were set right where factors have few digits.
    pub corrections: usize,
    /// Why single precision was given up, where it was.
    pub fallback: Option<Fallback>,
    /// Seconds of stiffness and loads.
    pub assembly: f64,
    /// Seconds of the fill-reducing ordering.
    pub ordering: f64,
    /// Seconds of the factorisation, symbolic and numeric.
    pub factorisation: f64,
    /// Seconds of the condensed operator and the free displacement.
    pub condensation: f64,
    /// Seconds of the recovery of the whole displacement and its balance.
    pub recovery: f64,
}

/// Counts over the whole solve.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedWork {
    /// Factorisations of the body's stiffness.
    pub factorisations: usize,
    /// Factors that are in single precision.
    pub single_factors: usize,
    /// Rounds by which bodies and contacts were set right where factors have few digits.
    pub corrections: usize,
    /// Why single precision was given up for double precision; left out where it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fallback: Option<String>,
    /// Gauss–Seidel passes of the prediction.
    pub passes: usize,
    /// Sweeps of the outer loop.
    pub sweeps: usize,
    /// Programs over all Coulomb cones, for bodies that supports do not hold.
    pub coulomb_programs: usize,
    /// Normal half-steps solved as cone programs.
    pub normal_programs: usize,
    /// Friction half-steps solved as cone programs.
    pub friction_programs: usize,
    /// Largest number of contacts that a friction program held.
    pub friction_program_contacts: usize,
    /// Interior-point iterations over all programs.
    pub cone_iterations: usize,
    /// Newton steps.
    pub newton_steps: usize,
    /// Wall time by stage.
    pub seconds: ReportedSeconds,
    /// Memory of every rank for the factors; left out where one process factorises.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ranks: Vec<ReportedRank>,
}

/// Memory of a rank for the factors of all bodies.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedRank {
    /// As estimated before anything was factorised, in bytes.
    pub estimated_bytes: f64,
    /// As it was in the end, in bytes.
    pub bytes: f64,
}

/// Wall time by stage in the order of the pipeline, in second.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedSeconds {
    /// Stiffness and loads.
    pub assembly: f64,
    /// Fill-reducing ordering.
    pub ordering: f64,
    /// Factorisation, symbolic and numeric.
    pub factorisation: f64,
    /// Condensed operator and free displacement.
    pub condensation: f64,
    /// Prediction.
    pub predict: f64,
    /// Equilibrium of floating bodies, and the programs over all Coulomb cones.
    pub coulomb: f64,
    /// Normal half-steps.
    pub normal: f64,
    /// Friction half-steps.
    pub friction: f64,
    /// Newton finish.
    pub finish: f64,
    /// Judge.
    pub judge: f64,
    /// Recovery of the whole displacement and its balance.
    pub recovery: f64,
    /// Sum of the stages.
    pub total: f64,
}

/// One sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedSweep {
    /// The judge's residual at its end.
    pub residual: f64,
    /// Interior-point iterations of the program over all Coulomb cones.
    pub coulomb_iterations: usize,
    /// Interior-point iterations of the normal half-step.
    pub normal_iterations: usize,
    /// Interior-point iterations of the friction half-step.
    pub friction_iterations: usize,
    /// Newton steps tried after the half-steps.
    pub newton_steps: usize,
    /// Open contacts at its end.
    pub open: usize,
    /// Sticking contacts at its end.
    pub stick: usize,
    /// Slipping contacts at its end.
    pub slip: usize,
    /// Wall time, in second.
    pub seconds: f64,
}

impl ReportedWork {
    pub(super) fn new(parts: &ReportParts<'_>) -> Self {
        let (stages, work) = (parts.stages, &parts.outcome.work);
        Self {
            factorisations: stages.factorisations,
            single_factors: stages.single_factors,
            corrections: stages.corrections,
            fallback: stages.fallback.map(|sign| sign.to_string()),
            passes: work.passes,
            sweeps: work.sweeps,
            coulomb_programs: work.coulomb_programs,
            normal_programs: work.normal_programs,
            friction_programs: work.friction_programs,
            friction_program_contacts: work.friction_program_contacts,
            cone_iterations: work.cone_iterations,
            newton_steps: work.newton_steps,
            seconds: ReportedSeconds::new(parts),
            ranks: parts.ranks.iter().map(ReportedRank::from).collect(),
        }
    }

    /// Ranks and their memory in words; none where one process factorises.
    pub(super) fn ranks_in_words(&self) -> Option<String> {
        let most = |of: fn(&ReportedRank) -> f64| {
            let all = self.ranks.iter().map(of);
            1e-6 * all.fold(0.0, f64::max)
        };
        let [used, estimated] = [most(|rank| rank.bytes), most(|rank| rank.estimated_bytes)];
        let all: f64 = self.ranks.iter().map(|rank| 1e-6 * rank.bytes).sum();
        (!self.ranks.is_empty()).then(|| {
            format!(
                "{}: factors of {used:.0} MB on the largest (estimated {estimated:.0}), {all:.0} in all",
                self.ranks.len()
            )
        })
    }
}

impl From<&RankMemory> for ReportedRank {
    fn from(memory: &RankMemory) -> Self {
        Self {
            estimated_bytes: memory.estimated,
            bytes: memory.used,
        }
    }
}

impl ReportedSeconds {
    fn new(parts: &ReportParts<'_>) -> Self {
        let (stages, outer) = (parts.stages, parts.outcome.work.seconds);
        let mut seconds = Self {
            assembly: stages.assembly,
            ordering: stages.ordering,
            factorisation: stages.factorisation,
            condensation: stages.condensation,
            predict: outer.predict,
            coulomb: outer.coulomb,
            normal: outer.normal,
            friction: outer.friction,
            finish: outer.finish,
            judge: outer.judge,
            recovery: stages.recovery,
            total: 0.0,
        };
        seconds.total = seconds.by_stage().iter().map(|(_, spent)| spent).sum();
        seconds
    }

    /// The stages by name, in the order of the pipeline.
    pub(super) fn by_stage(&self) -> [(&'static str, f64); 11] {
        [
            ("assembly", self.assembly),
            ("ordering", self.ordering),
            ("factorisation", self.factorisation),
            ("condensation", self.condensation),
            ("predict", self.predict),
            ("coulomb", self.coulomb),
            ("normal", self.normal),
            ("friction", self.friction),
            ("finish", self.finish),
            ("judge", self.judge),
            ("recovery", self.recovery),
        ]
    }
}

impl From<&SweepRecord> for ReportedSweep {
    fn from(record: &SweepRecord) -> Self {
        let [open, stick, slip] = record.open_stick_slip;
        Self {
            residual: record.residual,
            coulomb_iterations: record.coulomb_iterations,
            normal_iterations: record.normal_iterations,
            friction_iterations: record.friction_iterations,
            newton_steps: record.newton_steps,
            open,
            stick,
            slip,
            seconds: record.seconds,
        }
    }
}
