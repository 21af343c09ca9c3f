//! What a lubricated nip should do: viscosity, contact, film thickness and the drag that follows.
//!
//! | module       | responsibility                                                                   |
//! |--------------|----------------------------------------------------------------------------------|
//! | `viscosity`  | viscosity against temperature, pressure and shear rate                           |
//! | `contact`    | moduli, Hertz, rubber hardness                                                   |
//! | `layer`      | a rigid cylinder pressed into a bonded elastic layer: nip width and pressure     |
//! | `paper`      | Eqs. 5-10 of the paper                                                           |
//! | `film`       | the four regimes of a line contact, elliptic contacts                            |
//! | `traction`   | shear and rolling part of the force that a soft film takes from the belt           |
//! | `correction` | starvation, inlet heating and shear thinning as factors, each with its validity  |
//! | `mixed`      | film and asperities share the load: force, lambda, transition                     |
//! | `reynolds`   | the Reynolds equation and elasticity of a line contact, solved numerically        |
//!
//! Conventions: SI; entrainment speed is the mean (u1 + u2)/2; the effective modulus E' is
//! 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2], the contact modulus E* is E'/2; loads are per length.

pub mod contact;
pub mod correction;
pub mod film;
pub mod layer;
pub mod mixed;
pub mod paper;
pub mod reynolds;
pub mod traction;
pub mod viscosity;
