//! CONE PROGRAMS: the two half-steps.
//!
//! ```text
//! (H1)  normal:    min ½ s_N·G_NN s_N + s_N·(û_N + G_NT t_T − g₀)    s.t.  s_N ≤ 0
//! (H2)  friction:  min ½ s_T·G_TT s_T + s_T·(û_T + G_TN t_N)         s.t.  ‖s_T,i‖ ≤ −μ_i t_N,i
//! ```
