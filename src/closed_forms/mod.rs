//! CLOSED FORMS: answers that need no mesh, to hold computed ones against.
//!
//! ```text
//! (E1)  1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂,   1/R = 1/R₁ + 1/R₂,
//!       Θ = (2−ν₁)/G₁ + (2−ν₂)/G₂                                              moduli.rs
//! (E2)  β = [(1−2ν₁)/G₁ − (1−2ν₂)/G₂] / (2 [(1−ν₁)/G₁ + (1−ν₂)/G₂])           moduli.rs
//! (E3)  a = √(4 P R/(π E*)),  p₀ = 2 P/(π a),  p = p₀ √(1 − x²/a²)             hertz_line.rs
//! (E4)  a = (3 P R/(4 E*))^⅓,  p₀ = 3 P/(2 π a²),  δ = a²/R                    hertz_sphere.rs
//! (E5)  c/a = (1 − Q/(μ P))^n,  q = μ (p₀/a) [√(a²−x²) − √(c²−x²)]             cattaneo_mindlin.rs
//!       round: δ_t = 3 μ P Θ/(16 a) [1 − (1 − Q/(μ P))^⅔]                      cattaneo_mindlin.rs
//! (E6)  p = P/(π √(a²−x²)),   p = P/(2 π a √(a²−r²)),  δ = P/(2 a E*)          flat_punch.rs
//! (E7)  K(k) = π/(2 agm(1, √(1−k²)))                                           elliptic.rs
//! (E8)  μ = β K(c)/K(c'),     μ = β ln((1+c)/(1−c))/(2 c K(c')),  c' = √(1−c²)  stick_ratio.rs
//! (E9)  ε_x = [(1−ν²) σ_x − ν (1+ν) σ_y]/E, and x, y exchanged                  uniform_patch.rs
//! (E10) F/W = (tan α + μ)/(1 − μ tan α)                                        wedge.rs
//! (E11) N = W cos α,  T = W sin α;  sticks: tan α ≤ μ;  tips: tan α > width/height   incline.rs
//! (E12) u_z = P/(4πG) [z²/ρ³ + 2 (1−ν)/ρ],  u_r = P/(4πG) [r z/ρ³ − (1−2ν) r/(ρ (ρ+z))]   boussinesq.rs
//! ```
//!
//! Units are those of one consistent system; forces of plane problems are per metre of depth.
//! Half-planes and half-spaces are elastic and isotropic, strains small, plane states those of
//! plane strain. Pressure is positive. Where two forms stand, the first is plane, the second
//! axisymmetric.
//!
//! Every function refuses arguments for which its form does not hold: a NaN, a length that is not
//! positive, a tangential load beyond friction.
//!
//! (E1)–(E6), (E12): Johnson, Contact Mechanics, Cambridge 1985, ch. 2–5 and 7.
//! (E7): Abramowitz, Stegun, Handbook of Mathematical Functions, 1964, §17.6.
//! (E8): Goodman, J. Appl. Mech. 29 (1962) 515–522; Spence, J. Elasticity 5 (1975) 297–319.
//! (E10): NAFEMS CGS-4.

mod boussinesq;
mod cattaneo_mindlin;
mod elliptic;
mod flat_punch;
mod hertz_line;
mod hertz_sphere;
mod incline;
mod moduli;
#[cfg(test)]
mod quadrature;
mod range;
mod stick_ratio;
mod uniform_patch;
mod wedge;

pub use boussinesq::Boussinesq;
pub use cattaneo_mindlin::{CattaneoMindlin, mindlin_displacement};
pub use flat_punch::{FlatLinePunch, FlatRoundPunch};
pub use hertz_line::HertzLine;
pub use hertz_sphere::HertzSphere;
pub use incline::Incline;
pub use moduli::Elastic;
#[cfg(feature = "cli")]
pub(crate) use moduli::contact_radius;
pub use stick_ratio::{friction_of_stick_line, friction_of_stick_sphere};
pub use stick_ratio::{stick_ratio_line, stick_ratio_sphere};
pub use uniform_patch::uniform_strain;
pub use wedge::wedge_pull;
