//! Slender rods.
pub mod assembly; pub mod curve; pub mod element; pub mod error; pub mod fit; pub mod interpolation; pub mod joint; pub mod lagrange;
pub mod linear_solver; pub mod load; pub mod model; pub mod newton; pub mod quadrature; pub mod recorder; pub mod rod; pub mod rotation; pub mod scene; pub mod section; pub mod solution; pub mod state; pub mod statics;
