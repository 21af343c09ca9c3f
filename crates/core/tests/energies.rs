//! Energies of a run against closed forms, and against Simpson's rule over the law of drag along the samples.

use hersey_core::Work;
use hersey_core::drag::{Closure, Drag, TemperatureLaw};
use hersey_core::motion::{
    Drive, Drivetrain, Integrator, Schedule, Start, System, Trajectory, simulate,
};

const STIFFNESS: f64 = 1000.0;
const SPEED: f64 = 3.0;
/// Force at the transition, which is at 1 m/s, and the temperature where it has that force, K.
const FORCE: f64 = 50.0;
const REFERENCE: f64 = 373.0;
/// The force varies with this power of temperature.
const EXPONENT: f64 = -2.0;
/// Temperatures where a run begins and one second later, K.
const WARMING: [f64; 2] = [373.0, 393.0];

/// A belt that slides in EHL at 3 m/s, where drag rises with speed to the power 0.3.
fn slide(stretched: f64, duration: f64, tolerance: f64, warming: bool) -> Trajectory {
    let train = Drivetrain::new(STIFFNESS, 1.0).unwrap();
    let law = TemperatureLaw::powers(REFERENCE, EXPONENT, 0.0);
    let drag = Drag::new(FORCE, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    let steady = Start::steady(&train, &drag, SPEED).unwrap();
    let start = Start { stretch: steady.stretch + stretched, ..steady };
    let drag = drag.with_temperature_law(law).unwrap();
    let course = if warming {
        Schedule::linear("temperature", &[0.0, 1.0], &WARMING).unwrap()
    } else {
        Schedule::constant(REFERENCE)
    };
    let drive = Drive::Speed(Schedule::constant(SPEED));
    let system = System::new(train, &drag, drive, Some(course)).unwrap();
    let (work, integrator) = (Work::default(), Integrator::Adaptive);
    let run = simulate(&system, start, duration, 4001, tolerance, integrator, &work).unwrap();
    assert!(run.events.is_empty() && run.belt_speed.iter().all(|speed| *speed > 1.0));
    run
}

/// Drag at a sample, N.
fn drag(run: &Trajectory, i: usize, warming: bool) -> f64 {
    let [begin, end] = WARMING;
    let temperature = if warming { begin + (end - begin) * run.time[i] } else { REFERENCE };
    FORCE * (temperature / REFERENCE).powf(EXPONENT) * run.belt_speed[i].powf(0.3)
}

/// Integral over the samples by Simpson's rule.
fn integral(run: &Trajectory, of: impl Fn(usize) -> f64) -> f64 {
    let spans = run.time.as_chunks::<2>().0.len();
    let pairs = (0..spans).map(|k| of(2 * k) + 4.0 * of(2 * k + 1) + of(2 * k + 2));
    pairs.sum::<f64>() * run.time[1] / 3.0
}

#[test]
fn steady_sliding_dissipates_force_times_way() {
    let run = slide(0.0, 1.0, 1e-9, false);
    let expected = FORCE * SPEED.powf(0.3) * SPEED;
    for energy in [run.energy.work, run.energy.dissipated] {
        assert!((energy - expected).abs() <= 1e-14 * expected, "{energy} is not {expected}");
    }
    assert!(run.energy.stored.abs() <= 1e-14 * expected);
}

#[test]
fn what_is_missing_is_what_the_law_dissipates_beyond_the_motion() {
    for (duration, tolerance, warming) in [
        (1.0, 1e-3, false), // eleven steps
        (1.0, 1e-6, false),
        (0.05, 1e-3, false), // one step
        (1.0, 1e-3, true),
        (1.0, 1e-6, true),
        (0.05, 1e-3, true),
    ] {
        let run = slide(0.02, duration, tolerance, warming);
        let energy = run.energy;
        let work = integral(&run, |i| STIFFNESS * run.stretch[i] * SPEED);
        let dissipated = integral(&run, |i| drag(&run, i, warming) * run.belt_speed[i]);
        let kinetic = |i: usize| 0.5 * run.belt_speed[i].powi(2);
        let spring = |i: usize| 0.5 * STIFFNESS * run.stretch[i].powi(2);
        let stored = kinetic(4000) + spring(4000) - kinetic(0) - spring(0);
        let missing = work - dissipated - stored;
        let found = energy.residual() * energy.turnover;
        assert!(
            (found - missing).abs() <= 0.05 * missing.abs(),
            "{found:e} J are not {missing:e}: {duration} s at {tolerance:e}, warming {warming}"
        );
    }
}
