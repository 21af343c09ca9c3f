//! The physics of hersey, in the order of the computation.
//!
//! | module                    | responsibility                                                                     |
//! |---------------------------|------------------------------------------------------------------------------------|
//! | `error`                   | the closed list of ways an input can be wrong, or a computation can end unfinished |
//! | `work`                    | how much work a computation may do, and whether anybody still waits for it         |
//! | `rows`                    | logarithms and exponentials of several numbers at once                             |
//! | `wire`                    | values by name, as all ways into the core hand them over, and what is wrong with them |
//! | `lubrication::viscosity`  | viscosity against temperature, pressure and shear rate                             |
//! | `lubrication::contact`    | moduli, Hertz, rubber hardness                                                     |
//! | `lubrication::layer`      | a rigid cylinder pressed into a bonded elastic layer: nip width and pressure       |
//! | `lubrication::paper`      | Eqs. 5-10 of the paper                                                             |
//! | `lubrication::film`       | the four regimes of a line contact, elliptic contacts                              |
//! | `lubrication::correction` | starvation, inlet heating and shear thinning as factors                            |
//! | `lubrication::mixed`      | film and asperities share the load: force, lambda, transition                      |
//! | `lubrication::reynolds`   | the Reynolds equation and elasticity of a line contact, solved numerically         |
//! | `drag`                    | drag against belt speed and temperature: EHL and mixed branches                    |
//! | `drag::closure`           | what the drag does below the stick speed                                           |
//! | `drag::curve`             | drag as a smooth curve through points                                              |
//! | `drag::form`              | a drag as plain values by name                                                     |
//! | `motion::schedule`        | drive speed, torque and temperature against time                                   |
//! | `motion::system`          | drivetrain, drag, drive and temperature: the equation to solve                     |
//! | `motion::surroundings`    | drive, temperature and law of drag at one time of the motion                       |
//! | `motion::polynomial`      | Taylor polynomials of fixed order; first root in an interval                       |
//! | `motion::taylor`          | one slip step as a Taylor series with its own dense output                         |
//! | `motion::runge_kutta`     | steps for stiff motion (Radau IIA) and for the second opinion                      |
//! | `motion::piece`           | a stretch of smooth motion: state, conditions and turning points along it          |
//! | `motion::event`           | changes of mode and the conditions that cause them                                 |
//! | `motion::modes`           | modes, the guards that end them, and which mode follows                            |
//! | `motion::steps`           | the next piece: held, as a Taylor series, or by a Runge-Kutta step                 |
//! | `motion::hybrid`          | the motion as a chain of pieces between located events                             |
//! | `motion::trajectory`      | the motion sampled at given times, with its event table and energies               |
//! | `motion::lap`             | one lap: its sections, its extremes, and where the laps are heading                |
//! | `motion::cycle`           | what the motion settles to: steady sliding, oscillation, stick-slip                |
//! | `motion::overtakings`     | a motion seen only where the belt overtakes the drive                              |
//! | `motion::returning`       | where a belt that overtakes the drive overtakes it again                           |
//! | `motion::lanes`           | slip laps of many belts at once, several to a register                             |
//! | `motion::ensemble`        | what thousands of belts settle to                                                  |
//! | `stability::fold`         | drive speed at which a slip lap comes back to its start, many at once              |
//! | `stability::cycles`       | swings that never stick, by their slowest speed                                    |
//! | `stability::band`         | lower edge, transition and upper fold of a belt, for every closure                 |
//! | `stability::curve_laps`   | slip laps and fold of a belt whose drag is a smooth curve                          |
//! | `stability::curve_start_up` | what a profile of drive speed does to such a belt                             |
//! | `stability::unstable`     | the lap between the starts that come to slide and those that come to stick         |
//!
//! Conventions: any consistent set of units (SI inside the product); speeds and forces are signed,
//! positive along the drive; stretch is drive position minus belt position. The crate does no I/O,
//! starts no threads and does not panic on what a user can pass.

pub mod drag;
pub mod error;
pub mod lubrication;
pub mod motion;
mod rows;
pub mod stability;
pub mod wire;
pub mod work;

pub use error::Error;
pub use work::Work;
