//! Certified frictional contact of elastic bodies by condensation and cone programs.

pub mod body;
pub mod condensation;
pub mod cone;
pub mod dpana;
pub mod error;
pub mod kkt;
pub mod pipeline;
pub mod report;
pub mod scene;

pub use condensation::ContactProblem;
pub use dpana::{Outcome, Settings, Status};
pub use error::Error;
pub use kkt::{Certificate, Judge};
pub use pipeline::{Solution, solve};
pub use scene::Scene;
