//! Certified frictional contact of elastic bodies by condensation and cone programs.
//!
//! Elastic bodies meet rigid obstacles and each other along their contact surface. Reactions `t` and
//! relative displacements `u` there obey the laws of Signorini and Coulomb, and the bodies enter
//! only through their compliance `G`:
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
//! | scene | [`scene`], [`mod@deck`] | bodies and contact pairs from JSON, code or an Abaqus deck |
//! | mechanics | [`body`], [`mesh_file`] | mesh, stiffness and load of a body |
//! | contact surface | [`contact`] | contacts: frames, gaps, the nodes of either side |
//! | condensation | [`condensation`] | compliance G and free displacement û, seen from the contacts |
//! | the problem | [`problem`] | the [`ContactProblem`]: G, û, gaps, friction |
//! | cone programs | [`cone`] | the two half-steps, normal and friction |
//! | limit analysis | [`limit`](mod@limit) | whether contact can hold the bodies at all |
//! | outer loop | [`alternation`] | reactions, by sweeps and a Newton finish |
//! | trust | [`trust`] | what a solved state is worth: other states, jumps, limits |
//! | half-space | [`half_space`] | a contact per cell of a grid, by convolution, with loop and judge of its own |
//! | judge | [`kkt`] | the [`Certificate`]: every law, measured on the original problem |
//! | report | [`report`] | JSON, VTU, a summary |
//! | validity | [`validity`] | what mesh and theory cannot give, with numbers |
//! | closed forms | [`closed_forms`] | answers that need no mesh |
//! | study | [`mod@study`] | a scene over meshes, tolerances, friction and loops |
//! | verification | [`mod@verify`] | scenes whose answers are known, on ladders of meshes |
//!
//! # Ways in
//!
//! Each page has a program that runs:
//!
//! | what is at hand | start |
//! |---|---|
//! | a scene in JSON | [`Scene::from_json`], [`solve`] |
//! | meshes and arrays in memory | [`Scene::new`], [`body::Mesh::from_arrays`], [`solve`] |
//! | a condensed problem of another code | [`ContactProblem`], [`alternation::solve`](alternation::solve()) |
//! | a load history | [`solve_steps`] |
//! | the question how wrong the mesh leaves a total | [`solve_within`] |
//! | many values of friction, loads, gaps | [`cases`] |
//! | the question what a little more of anything does | [`Solution::sensitivities`] |
//! | a measured total, and the friction or load wanted that gives it | [`find`] |
//! | the question how much load or friction it takes | [`limit`](limit()) |
//! | the question what theory says | [`closed_forms`] |
//! | bodies whose factors one machine cannot hold | [`Ranks`] |
//!
//! The README has the signs and the scene format. Without the feature `cli`, which is there by default,
//! the crate is the library alone: no command line, JSON Schema, gallery, studies or figures. With `mumps`, which
//! is not, MUMPS of the system divides factors among the processes of an MPI run.

pub mod alternation;
pub mod body;
pub mod closed_forms;
pub mod condensation;
pub mod cone;
pub mod contact;
pub mod deck;
mod error;
pub mod half_space;
pub mod kkt;
pub mod limit;
pub mod mesh_file;
mod pipeline;
pub mod problem;
mod processor;
mod random;
pub mod report;
pub mod scene;
pub mod stage;
#[cfg(feature = "cli")]
pub mod study;
pub mod trust;
pub mod validity;
#[cfg(feature = "cli")]
pub mod verify;

pub use alternation::{Outcome, Settings, Status};
pub use condensation::{Engine, Ranks};
pub use error::Error;
pub use kkt::{Certificate, Judge};
pub use pipeline::{
    Acting, BodyStress, Checked, Measured, Request, Search, Solution, SolvedStep, Variation, cases,
    cases_watched, check, find, half_space_cases, limit, rigid_limit, solve, solve_half_space,
    solve_steps, solve_within,
};
pub use problem::ContactProblem;
pub use scene::Scene;
#[cfg(feature = "cli")]
pub use study::study;
#[cfg(feature = "cli")]
pub use verify::verify;

#[doc = include_str!("method.md")]
#[doc = include_str!("constants.md")]
pub mod method {}

/// Dense matrices: what an operator and free modes are made of.
pub use faer;
/// Sparse matrices: what a body's stiffness is.
pub use sprs;

/// The programs of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
