//! What several tests of motion need.

use hersey_core::drag::Drag;
use hersey_core::motion::{self, Drivetrain, Integrator, Start, System, Trajectory};
use hersey_core::{Error, Work};

/// Motion at constant drive speed.
///
/// # Errors
/// As `motion::simulate`.
pub fn simulate(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    start: Start,
    duration: f64,
    samples: usize,
    tolerance: f64,
) -> Result<Trajectory, Error> {
    let system = System::at_speed(*train, drag, drive_speed)?;
    motion::simulate(
        &system,
        start,
        duration,
        samples,
        tolerance,
        Integrator::Adaptive,
        &Work::default(),
    )
}
