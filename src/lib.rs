//! Certified frictional contact of elastic bodies by condensation and cone programs.
//!
//! An elastic body meets rigid obstacles along its contact surface. Reactions `t` and
//! displacements `u` there obey the laws of Signorini and Coulomb, and the body enters
//! only through its compliance `G`:
//!
//! ```text
//! (L1)  t_N ≤ 0,   u_N − g₀ ≤ 0,   t_N (u_N − g₀) = 0
//! (L2)  ‖t_T‖ ≤ −μ t_N
//! (L3)  −μ t_N ‖u_T‖ + t_T · u_T = 0
//! (C1)  u = û + G t
//! ```
//!
//! [`solve`] takes a [`Scene`] through the stages and returns a [`Solution`], whose
//! [`Status`] says whether the [`Judge`] certified it:
//!
//! | stage | module | what it makes |
//! |---|---|---|
//! | scene | [`scene`] | bodies and contact pairs from JSON or code |
//! | mechanics | [`body`] | stiffness and load of a body |
//! | condensation | [`condensation`] | the [`ContactProblem`]: G, û, gaps, friction |
//! | cone programs | [`cone`] | the two half-steps, normal and friction |
//! | outer loop | [`mod@dpana`] | reactions, by sweeps and a Newton finish |
//! | judge | [`kkt`] | the [`Certificate`]: every law, measured on the original problem |
//! | report | [`report`] | JSON, VTU, a summary |
//! | closed forms | [`closed_forms`] | answers that need no mesh |
//! | study | [`mod@study`] | a scene over meshes, tolerances, friction and loops |
//! | verification | [`mod@verify`] | scenes whose answers are known, on ladders of meshes |
//!
//! A problem that another code condensed goes straight to [`dpana::solve`](dpana::solve()).
//! The README has a program for either way, the signs, and the scene format.

pub mod body;
pub mod closed_forms;
pub mod condensation;
pub mod cone;
pub mod dpana;
pub mod error;
pub mod kkt;
pub mod pipeline;
pub mod report;
pub mod scene;
pub mod study;
pub mod verify;

pub use condensation::ContactProblem;
pub use dpana::{Outcome, Settings, Status};
pub use error::Error;
pub use kkt::{Certificate, Judge};
pub use pipeline::{Solution, Variation, limit, solve, solve_steps, sweep, sweep_watched};
pub use scene::Scene;
pub use study::study;
pub use verify::verify;

/// The programs of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
