//! Sliding drag against belt speed (Eqs. 17-30 of the paper).
//!
//! A law is a chain of power branches `F = F_k (v/v_k)^p` that meet at knots `(v_k, F_k)`. Two branches
//! that meet at the transition are the paper's law; a chain through measured points is a tabulated one,
//! monotone between its points. Drag is odd in speed: reversal works.
//!
//! Below the stick speed `v_s` drag falls from the force `A` that breaks a belt at rest away to that of the law at
//! `v_s`: `A exp(-k |v|/v_s)` with `k = ln(A/F(v_s))`. The paper's `A = e F(v_s)` makes `k = 1` (Eqs. 28-30).
//!
//! With temperature the law keeps its shape: all forces vary as `(T/T_0)^b`, all speeds, the stick speed
//! among them, as `(T/T_0)^d`. Two fitted surfaces `B = a T^b w^c` that meet at a transition are of this form.
//!
//! A third law is that of mixed lubrication, where film and asperities share the load: smooth, it falls and rises by
//! itself, and its knot is the speed of least force. It hangs on viscosity times speed, which moves its speeds with
//! temperature, and on boundary friction.
//!
//! Beside the lubricated contact stands the rest of the drive, `r_0 + r_1 v`: bearings, gears, the roll's own losses.
//!
//! | module          | responsibility                                                      |
//! |-----------------|---------------------------------------------------------------------|
//! | `law`           | the law: its knots and branches, its closure, its values and slopes |
//! | `mode`          | states of lubrication                                               |
//! | `closure`       | what the drag does below the stick speed                            |
//! | `curve`         | drag as a smooth curve through points, for laws without a formula   |
//! | `strengthening` | a static force that grows at rest                                   |
//! | `rest`          | what moves with the belt besides the contact                        |
//! | `mixed_contact` | a contact whose load film and asperities share                      |
//! | `speeds`        | speeds of a given force, and from which on the drag rises           |
//! | `temperature`   | how the law varies with temperature                                 |
//! | `at_temperature` | the law as it is at one temperature                                |
//! | `form`          | a drag as plain values by name, as all ways into the core hand it over |

mod at_temperature;
mod closure;
mod curve;
pub mod form;
mod law;
mod mixed_contact;
mod mode;
mod rest;
mod speeds;
mod strengthening;
mod temperature;

pub(crate) use closure::SMOOTHING;
pub use closure::{Closure, ClosureKind};
pub use curve::Curve;
pub use form::DragForm;
pub use law::Drag;
pub(crate) use mixed_contact::MixedContact;
pub use mode::Mode;
pub use rest::Rest;
pub use strengthening::Strengthening;
pub use temperature::{SpeedLaw, TemperatureLaw};
