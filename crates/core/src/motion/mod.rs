//! Motion of a belt drawn through a spring by a drive (Eqs. 11-16, 24-30).
//!
//! | module        | responsibility                                                            |
//! |---------------|---------------------------------------------------------------------------|
//! | `schedule`    | drive speed, torque and temperature against time                          |
//! | `system`      | drivetrain, drag, drive and temperature: the equation to solve            |
//! | `polynomial`  | Taylor polynomials of fixed order; first root in an interval              |
//! | `recurrence`  | products, powers and exponentials of such polynomials, coefficient by coefficient |
//! | `thermal`     | how the law of drag moves while the temperature does, as series           |
//! | `heat`        | temperature as a state: two bodies, a heater and friction                 |
//! | `sharing`     | series of the force of a contact whose load film and asperities share     |
//! | `shared_by_inlet`, `shared_by_power` | the series of its film, by either law      |
//! | `taylor`      | one slip step as a Taylor series with its own dense output                |
//! | `dormand_prince` | coefficients of that Runge-Kutta pair                                  |
//! | `runge_kutta` | steps for stiff motion (Radau IIA) and for the second opinion             |
//! | `piece`       | a stretch of smooth motion: state, conditions and turning points along it |
//! | `event`       | changes of mode and the conditions that cause them                        |
//! | `surroundings` | drive, temperature and law of drag at the time that the motion has reached |
//! | `modes`       | modes, the guards that end them, and which mode follows                   |
//! | `steps`       | the next piece: held, as a Taylor series, or by a Runge-Kutta step        |
//! | `hybrid`      | the motion as a chain of pieces between located events                    |
//! | `moment`      | all of a motion that changes, as numbers                                 |
//! | `stepper`     | the motion from call to call, its drive and temperature given on the way  |
//! | `trajectory`  | the motion sampled at given times, with its event table and energies      |
//! | `lanes`       | slip laps of many belts at once, several to a register                    |
//! | `lane_series` | Taylor series of the belts on all lanes                                   |
//! | `ensemble`    | what thousands of belts settle to                                         |
//! | `stick_slip_cycle` | what a motion has settled to: its kind, and the numbers of its lap    |
//! | `lap`         | one lap: its sections, its extremes, and where the laps are heading       |
//! | `cycle`       | what the motion settles to: steady sliding, oscillation, stick-slip       |
//! | `overtakings` | a motion seen only where the belt overtakes the drive                     |
//! | `returning`   | where a belt that overtakes the drive overtakes it again                  |
//! | `start_up`    | from when on a belt that starts from rest slides for good                 |
//! | `start_ups`   | many of them at once, in lanes                                            |
//!
//! The state is the pull of the spring and the belt speed (and the deflection of the bristles, with
//! `LuGre`). A torque on a rotor is the same equation: `J` for the mass, `K` for the stiffness.

mod cycle;
pub(crate) mod dormand_prince;
mod ensemble;
mod event;
mod heat;
mod hybrid;
mod lane_series;
pub(crate) mod lanes;
mod lap;
mod modes;
mod moment;
mod overtakings;
mod piece;
mod polynomial;
mod recurrence;
mod returning;
mod runge_kutta;
mod schedule;
mod shared_by_inlet;
mod shared_by_power;
mod sharing;
mod start_up;
mod start_ups;
mod stepper;
mod steps;
mod stick_slip_cycle;
mod surroundings;
mod system;
mod taylor;
mod thermal;
mod trajectory;

pub use cycle::{Span, settle, stick_slip};
pub use ensemble::{Belt, Outcome, ensemble};
pub use event::{Event, Guard};
pub use heat::{HeatBalance, Heater};
pub(crate) use hybrid::first_slide;
pub use moment::Moment;
pub(crate) use overtakings::Overtakings;
pub(crate) use returning::{Return, next_return};
pub use schedule::{Cubic, Schedule};
pub use start_up::{Ending, StartUp, Started, start_up};
pub use start_ups::{BeltAtRest, Starting, start_ups};
pub use stepper::{State, Stepper};
pub use stick_slip_cycle::{CycleKind, StickSlipCycle};
pub(crate) use system::checked_tolerance;
pub use system::{Drive, Drivetrain, Integrator, NUDGE, Start, System};
pub use trajectory::{Energy, Trajectory, simulate};
