//! Slender rods: the Petrov–Galerkin Cosserat rod finite element with nodal non-unit quaternions of
//! J. Harsch and S. R. Eugster, *Non-unit quaternion parametrization of a Petrov–Galerkin Cosserat rod finite
//! element*. Numbers in parentheses, as in eq. (11), are the equations of that paper.
//!
//! # What is solved
//!
//! A rod is a centreline r(ξ) with a cross-section orientation A(ξ), ξ ∈ [0, 1]. Its strains and its stress
//! resultants are
//!
//! ```text
//! γ = Aᵀ r,ξ / J       n = K_γ (γ − γ⁰)       K_γ = diag(EA, k GA, k GA)        dilatation and shear
//! κ = j⁻¹(Aᵀ A,ξ) / J  m = K_κ (κ − κ⁰)       K_κ = diag(G I_t, E I_y, E I_z)   torsion and bending
//! ```
//!
//! with J = ‖r⁰,ξ‖. An element has p + 1 nodes, each with a position r_i and a quaternion P_i of any non-zero norm.
//! Positions and matrices A(P_i) (5) are interpolated by the Lagrange basis N_i (6), virtual displacements and
//! virtual rotations by the same basis (8), which gives the forces on the nodes
//!
//! ```text
//! f_r,i = −∫ N_i,ξ A n dξ                                     + loads     [N], inertial basis      (11), (12)
//! f_φ,i = −∫ N_i,ξ m − N_i (γ̄ × n + κ̄ × m) dξ                + loads     [N m], body basis
//! ```
//!
//! integrated with p Gauss points. Statics is f = 0 (16), by Newton's iteration along the load factor. Because the
//! virtual rotations are not the variation of (6), f is not the gradient of the discrete energy and its tangent is
//! unsymmetric: linear momentum holds exactly, energy and angular momentum to the order of the discretisation.
//!
//! In motion the nodes have velocities u_i = (v_i, ω_i), interpolated by the same basis (9), so that the mass matrix
//! (13) is constant and symmetric, and rigid bodies are nodes of their own. With perfect joints g(q) = 0, G = ∂g/∂q:
//!
//! ```text
//! q̇ = B(q) u                                         ṙ = v,  Ṗ = Q(P) ω                                     (10)
//! M u̇ + fᵍʸʳ(u) = f(t, q) + Gᵀ λ,  g(q) = 0           fᵍʸʳ = ∫ N_i ω × I_ρ ω J dξ                      (13), (14)
//! (K − ω² M) x = Gᵀ μ,  G x = 0                       small vibrations about an equilibrium, K = −∂(f + Gᵀ λ)/∂q
//! ```
//!
//! (eq. (15) prints the gyroscopic force with the other sign, which does not conserve angular momentum). [`dynamics`]
//! integrates them at position level by generalized-α, or by Radau IIA for answers whose time error can be told from
//! the space error; [`modes`] finds the lowest frequencies.
//!
//! # Notation
//!
//! | here | meaning | unit |
//! |---|---|---|
//! | ξ, x | centreline parameter of the rod, of one element; both in [0, 1] | – |
//! | r, A, P | position, A_IK (cross-section → inertial), quaternion (w, x, y, z) | m, –, – |
//! | γ̄ = J γ, κ̄ = J κ | strains per parameter | m, rad |
//! | n, m | contact force and moment, cross-section basis | N, N m |
//! | δr, δφ | nodal increment: δr inertial, δA = A δφ̃ | m, rad |
//! | v, ω | velocity, inertial; angular velocity, body basis | m/s, rad/s |
//! | g, G, λ | gaps of the joints, their derivative, multipliers | m or –, –, N or N m |
//! | K, I | cross-section and inertial basis | |
//!
//! SI units throughout; six-vectors have the translation first; quaternions are scalar first and lead from the
//! cross-section to the inertial basis.
//!
//! # Use
//!
//! ```
//! use cosserat::Scene;
//! use cosserat::{Model, statics};
//!
//! let scene = Scene::from_toml(r#"
//!     [[rod]]
//!     name = "beam"
//!     curve = { kind = "line", length = 1.0 }
//!     section = { kind = "circle", diameter = 0.01 }
//!     material = { young_modulus = 2.1e11, poisson_ratio = 0.3 }
//!     elements = 8
//!     degree = 3
//!
//!     [[joint]]
//!     kind = "rigid"
//!     between = ["ground", "beam@0"]
//!
//!     [[load]]
//!     kind = "force"
//!     on = "beam@1"
//!     value = [0.0, 0.0, -50.0]
//!
//!     [[probe]]
//!     name = "tip"
//!     on = "beam@1"
//!
//!     [statics]
//! "#)?;
//! let model = Model::new(&scene)?;
//! let options = scene.statics.clone().unwrap_or_default();
//! let solution = statics::solve(&model, &options, &mut |_, _| ())?;
//! let tip = solution.rows.last().map(|row| row.probes[0].position);
//! assert!(tip.is_some_and(|tip| tip[2] < -0.1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Units stand in brackets, [m]; they are no links.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod accuracy;
pub mod assembly;
pub mod body;
pub mod constraint;
pub mod curve;
pub mod dynamics;
pub mod element;
pub mod error;
pub mod fit;
pub mod inertia;
pub mod interpolation;
pub mod joint;
pub mod lagrange;
pub mod lanes;
pub mod linear_solver;
pub mod load;
pub mod model;
pub mod modes;
pub mod newton;
pub mod output;
pub mod quadrature;
mod recorder;
pub mod rod;
pub mod rotation;
pub mod scene;
pub mod section;
pub mod solution;
pub mod state;
pub mod statics;
pub mod study;

pub use error::{Error, SceneError};
pub use model::Model;
pub use scene::Scene;
pub use solution::{Solution, SolveFailure};
