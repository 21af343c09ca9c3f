//! What would take for ever ends after the steps that are allowed, and any work stops when it is asked to.

use std::cell::Cell;

use hersey_core::drag::{Closure, Drag};
use hersey_core::lubrication::reynolds::{Fluid, Foundation, LineContact, Thickening};
use hersey_core::motion::{
    Belt, Drivetrain, Integrator, Schedule, Span, Start, System, ensemble, settle, simulate,
};
use hersey_core::stability::{bands, swings};
use hersey_core::{Error, Work};

const BRISTLES: Closure = Closure::LuGre { bristle_stiffness: 1e5, bristle_damping: 100.0 };
/// Work that tells only how it ended.
type Call = fn(&Work) -> Result<(), Error>;
/// Longer than anybody waits.
const FOR_EVER: f64 = 1e300;

fn belt(closure: Closure) -> (Drivetrain, Drag) {
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, closure).unwrap();
    (Drivetrain::new(1000.0, 1.0).unwrap(), drag)
}

fn motion(closure: Closure, work: &Work) -> Result<(), Error> {
    let (train, drag) = belt(closure);
    let system = System::at_speed(train, &drag, 1.0).unwrap();
    simulate(&system, Start::REST, FOR_EVER, 11, 1e-9, Integrator::Adaptive, work).map(drop)
}

fn lasting(closure: Closure, work: &Work) -> Result<(), Error> {
    let (train, drag) = belt(closure);
    let belts = [Belt { train, drag, drive_speed: 1.0, start: Start::REST }];
    ensemble(&belts, Span::Lasting(FOR_EVER), 1e-9, work)?.remove(0).map(drop)
}

fn film(nodes: usize, work: &Work) -> Result<(), Error> {
    let fluid = Fluid {
        viscosity: 0.1,
        pressure_viscosity: 0.0,
        thickening: Thickening::Barus,
        compressible: false,
    };
    let contact = LineContact {
        radius: 0.015,
        contact_modulus: 1e6,
        foundation: Foundation::HalfSpace,
        load: 1000.0,
        entrainment_speed: 0.1,
        sliding_speed: 0.2,
        fluid,
    };
    contact.solve(nodes, work).map(drop)
}

/// Everything that can last, by name.
fn long_calls() -> Vec<(&'static str, Call)> {
    vec![
        ("motion", |work| motion(Closure::Retained, work)),
        ("motion with bristles", |work| motion(BRISTLES, work)),
        ("lap", |work| {
            let (train, drag) = belt(BRISTLES);
            settle(&train, &drag, 1.0, Start::REST, Span::Lasting(FOR_EVER), 1e-9, work).map(drop)
        }),
        ("ensemble", |work| lasting(Closure::Retained, work)),
        ("ensemble with bristles", |work| lasting(BRISTLES, work)),
        ("band", |work| bands(&[belt(BRISTLES)], true, 1e-11, work)?.remove(0).map(drop)),
        ("film", |work| film(101, work)),
    ]
}

#[test]
fn what_would_last_for_ever_ends_with_the_work_allowed() {
    for (name, call) in long_calls() {
        let error = call(&Work::unwatched(3000)).expect_err(name);
        assert!(error.is_unfinished(), "{name}: {error}");
        assert!(error.steps().is_some_and(|steps| steps >= 3000), "{name}: {error}");
    }
}

#[test]
fn the_time_that_a_motion_has_reached_grows_with_its_work() {
    let reached = |steps| match motion(Closure::Retained, &Work::unwatched(steps)) {
        Err(Error::TooLong { time, .. }) => time,
        other => panic!("{other:?}"),
    };
    let (early, late) = (reached(1000), reached(4000));
    assert!(early > 1.0 && late > 3.0 * early, "{early} {late}");
}

#[test]
fn whatever_lasts_stops_when_it_is_asked_to() {
    let many = |work: &Work| bands(&vec![belt(Closure::Retained); 9], true, 1e-11, work).map(drop);
    let swing = |work: &Work| {
        let (train, drag) = belt(Closure::Retained);
        swings(&train, &drag, &[0.1; 99], 1e-11, work).map(drop)
    };
    let mut calls = long_calls();
    calls.extend([("bands", many as Call), ("swings", swing as Call)]);
    for (name, call) in calls {
        // at once, and somewhere on the way
        for patience in [0, 1, 7] {
            let asked = Cell::new(0);
            let stop = || asked.replace(asked.get() + 1) >= patience;
            assert_eq!(call(&Work::new(u64::MAX, &stop)), Err(Error::Stopped), "{name}");
            // it is not asked on and on once it has said so
            assert!(asked.get() <= patience + 30, "{name}: {} {patience}", asked.get());
        }
    }
}

#[test]
fn a_fine_grid_stops_within_its_film() {
    let coarse = Cell::new(0_u32);
    let count = || {
        coarse.set(coarse.get() + 1);
        false
    };
    film(101, &Work::new(u64::MAX, &count)).unwrap();
    let fine = Cell::new(0_u32);
    let stop = || fine.replace(fine.get() + 1) > coarse.get() + 500;
    assert_eq!(film(1601, &Work::new(u64::MAX, &stop)), Err(Error::Stopped));
}

#[test]
fn equal_exponents_divide_nothing() {
    for (ehl, mixed) in [(-0.7, -0.7), (-1.2, -1.2), (-1.2, -0.7)] {
        let drag = Drag::new(50.0, 1.0, ehl, mixed, 0.01, Closure::Retained).unwrap();
        let train = Drivetrain::new(1000.0, 1.0).unwrap();
        let band = bands(&[(train, drag)], true, 1e-11, &Work::unwatched(0)).unwrap().remove(0);
        let refused = Error::NotBelow { quantity: "mixed_exponent", value: mixed, limit: ehl };
        assert_eq!(band, Err(refused));
    }
}

#[test]
fn more_samples_than_memory_are_refused() {
    let (train, drag) = belt(Closure::Retained);
    let system = System::at_speed(train, &drag, 1.0).unwrap();
    let run = simulate(
        &system,
        Start::REST,
        1.0,
        1_000_000_000_000,
        1e-9,
        Integrator::Adaptive,
        &Work::default(),
    );
    assert!(matches!(run, Err(Error::TooLarge { quantity: "samples", .. })));
}

#[test]
#[allow(clippy::float_cmp)] // small whole numbers
fn a_schedule_s_range_reaches_beyond_its_ends() {
    // t^3 - 3 t falls from 0 to -2 at t = 1, and has risen to -1.125 at its end
    let ends = (&[0.0, 1.5], &[[0.0, -3.0, 0.0, 1.0]]);
    let schedule = Schedule::piecewise("temperature", ends.0, ends.1, -1.125).unwrap();
    assert_eq!(schedule.range(), (-2.0, 0.0));
}
