//! One motion from call to call.

use hersey_core::motion::{self, Cubic, Drive, Integrator, Moment, Schedule, Start, System};
use pyo3::prelude::*;

use crate::drag::Law;
use crate::errors::raised;
use crate::interrupt::interruptible;
use crate::motion::{TrainArguments, drivetrain_from, mode_name};

/// A motion that goes on from call to call.
#[pyclass(module = "hersey._core")]
pub struct Stepper(motion::Stepper);

/// Time, modes before and after, guard, stretch and belt speed of a change of mode.
type Change = (f64, &'static str, &'static str, &'static str, f64, f64);

fn change(event: motion::Event) -> Change {
    let motion::Event { time, from, to, guard, stretch, belt_speed } = event;
    (time, mode_name(from), mode_name(to), guard.name(), stretch, belt_speed)
}

#[pymethods]
impl Stepper {
    /// From a start, at a drive and a temperature that stay until others are given.
    #[new]
    fn new(
        train: TrainArguments,
        drag: &Law,
        drive: (&str, f64),
        temperature: Option<f64>,
        start: (f64, f64),
        tolerance: f64,
    ) -> PyResult<Self> {
        let train = drivetrain_from(train)?;
        let schedule = |name, value| Schedule::linear(name, &[0.0], &[value]).map_err(raised);
        let drive = match drive {
            ("speed", speed) => Drive::Speed(schedule("drive_speed", speed)?),
            (_, torque) => Drive::Force(schedule("drive_torque", torque)?),
        };
        let temperature = temperature.map(|t| schedule("temperature", t)).transpose()?;
        let start = Start { belt_speed: start.0, stretch: start.1 };
        System::new(train, &drag.0, drive, temperature)
            .and_then(|system| motion::Stepper::new(system, start, tolerance, Integrator::Adaptive))
            .map(Self)
            .map_err(raised)
    }

    /// On to a time, or to the first change of mode before or at it, which is returned.
    fn advance(&mut self, py: Python<'_>, until: f64, most_steps: u64) -> PyResult<Option<Change>> {
        let event = interruptible(py, most_steps, |work| self.0.advance(until, work))?;
        Ok(event.map(change))
    }

    /// Drive and temperature from now on, as cubics in the time from now; the change of mode that they make, if any.
    fn set_inputs(
        &mut self,
        drive: Option<Cubic>,
        temperature: Option<Cubic>,
    ) -> PyResult<Option<Change>> {
        let event = self.0.set_inputs(drive, temperature).map_err(raised)?;
        Ok(event.map(change))
    }

    /// Time, mode, whether the roll slips, belt speed, stretch and drag.
    fn state(&self) -> (f64, &'static str, bool, f64, f64, f64) {
        let motion::State { time, mode, slipping, belt_speed, stretch, drag, .. } = self.0.state();
        (time, mode_name(mode), slipping, belt_speed, stretch, drag)
    }

    /// All that changes.
    fn numbers(&self) -> Vec<f64> {
        self.0.moment().numbers().to_vec()
    }

    /// Go on from the numbers of this motion or of another of the same arguments.
    fn restore(&mut self, numbers: Vec<f64>) -> PyResult<()> {
        Moment::from_numbers(&numbers).and_then(|moment| self.0.restore(moment)).map_err(raised)
    }
}
