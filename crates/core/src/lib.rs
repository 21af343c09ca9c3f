//! The physics of hersey, in the order of the computation.
//!
//! | module   | responsibility                                                                     |
//! |----------|------------------------------------------------------------------------------------|
//! | `error`  | the closed list of ways an input can be wrong                                      |
//! | `lubrication` | viscosity, contact, film thickness and the drag that follows                  |
//! | `drag`   | sliding drag against belt speed: EHL and mixed branches, closure near zero speed   |
//! | `motion` | spring-driven belt: Taylor steps, located events, trajectories, stick-slip cycles  |
//!
//! Conventions: any consistent set of units (SI inside the product); speeds and forces are signed,
//! positive along the drive; stretch is drive position minus belt position. The crate does no I/O,
//! starts no threads and does not panic on what a user can pass.

pub mod drag;
pub mod error;
pub mod lubrication;
pub mod motion;
pub mod stability;

pub use error::Error;
