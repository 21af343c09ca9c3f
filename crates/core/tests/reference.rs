//! The paper's baseline against the exact solution of its equations (published numbers at 1e-12).

mod common;

use hersey_core::drag::{Closure, Drag, Mode, Rest, Strengthening};
use hersey_core::motion::{CycleKind, Drivetrain, Start, System, stick_slip};

use common::simulate;

fn baseline() -> (Drivetrain, Drag) {
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    (Drivetrain::new(1000.0, 1.0).unwrap(), drag)
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected}");
}

#[test]
fn breakaway_force_of_eq_29() {
    assert_close(baseline().1.breakaway_force(), 341.400_762_1, 1e-9);
}

#[test]
fn baseline_cycle() {
    let (train, drag) = baseline();
    let cycle = stick_slip(&train, &drag, 1.0, Start::REST, 1e-9).unwrap();
    assert_eq!(cycle.kind, CycleKind::StickSlip);
    assert_close(cycle.frequency, 3.940_313_951_318_513, 1e-8);
    assert_close(cycle.speed_max, 3.152_923_049_536_937, 1e-8);
    assert_close(cycle.stick_duration * cycle.frequency, 0.474_319_010_585_888_6, 1e-8);
    assert_close(cycle.stretch_max, 0.135_348_711_865_784_5, 1e-8);
    assert_close(cycle.stretch_min, -0.001_354_996_194_663_639_4, 1e-7);
}

#[test]
fn first_events_from_rest() {
    // the first slip swings back harder than A/e, so the belt sticks below the stick speed
    let (train, drag) = baseline();
    let run = simulate(&train, &drag, 1.0, Start::REST, 1.1, 100, 1e-11).unwrap();
    let held: Vec<_> =
        run.events.iter().filter(|e| e.from == Mode::Stuck || e.to == Mode::Stuck).collect();
    let expected = [
        (0.341_400_762_1, 0.341_400_762_1, 0.0),
        (0.449_312_772_3, -0.161_400_179_1, 0.007_491_701_8),
        (0.774_549_708_6, 0.161_400_179_1, 0.007_491_701_8),
        (0.896_892_482_5, -0.018_292_045_4, 0.01),
        (1.042_232_247_0, 0.125_594_321_6, 0.01),
    ];
    assert_eq!(held.len(), expected.len());
    for (event, (time, stretch, belt_speed)) in held.iter().zip(expected) {
        assert_close(event.time, time, 1e-8);
        assert_close(event.stretch, stretch, 1e-8);
        assert!((event.belt_speed - belt_speed).abs() < 1e-9);
    }
}

#[test]
fn a_small_oscillation_survives_just_below_the_transition() {
    let (train, drag) = baseline();
    let start = Start { belt_speed: 0.99, stretch: drag.force(0.99) / 1000.0 * 1.001 };
    let cycle = stick_slip(&train, &drag, 0.99, start, 1e-9).unwrap();
    assert_eq!(cycle.kind, CycleKind::Oscillation);
    assert_close(cycle.speed_min, 0.9122, 1e-4);
    assert_close(cycle.speed_max, 1.0674, 1e-4);
}

#[test]
fn first_stick_from_near_steady_sliding() {
    let (train, drag) = baseline();
    for (drive_speed, expected) in [(0.98, 12.285), (0.97, 4.160)] {
        let start =
            Start { belt_speed: 1.001 * drive_speed, stretch: drag.force(drive_speed) / 1000.0 };
        let run = simulate(&train, &drag, drive_speed, start, 20.0, 2, 1e-12).unwrap();
        let stick = run.events.iter().find(|e| e.to == Mode::Stuck).unwrap();
        assert!((stick.time - expected).abs() < 2e-3, "{} is not {expected}", stick.time);
    }
}

#[test]
fn the_past_decides_between_the_transition_and_the_fold() {
    // Fig. 13: at 1.9 v_t the belt still sticks when it comes from below; Fig. 14: not from above
    let (train, drag) = baseline();
    let from_below = stick_slip(&train, &drag, 1.9, Start::REST, 1e-9).unwrap();
    assert_eq!(from_below.kind, CycleKind::StickSlip);
    let above = Start { belt_speed: 2.5, stretch: drag.force(2.5) / 1000.0 };
    let from_above = stick_slip(&train, &drag, 1.9, above, 1e-9).unwrap();
    assert_eq!(from_above.kind, CycleKind::SteadySliding);
    let beyond_fold = stick_slip(&train, &drag, 2.2, Start::REST, 1e-9).unwrap();
    assert_eq!(beyond_fold.kind, CycleKind::SteadySliding);
}

#[test]
fn steady_sliding_exactly_at_the_transition_speed_stays() {
    let (train, drag) = baseline();
    let start = Start { belt_speed: 1.0, stretch: 0.05 };
    let run = simulate(&train, &drag, 1.0, start, 50.0, 11, 1e-9).unwrap();
    assert!(run.belt_speed.iter().all(|v| (v - 1.0).abs() < 1e-9));
}

#[test]
fn samples_do_not_change_the_motion() {
    let (train, drag) = baseline();
    let coarse = simulate(&train, &drag, 1.0, Start::REST, 3.0, 4, 1e-9).unwrap();
    let fine = simulate(&train, &drag, 1.0, Start::REST, 3.0, 30_001, 1e-9).unwrap();
    assert_eq!(coarse.events, fine.events);
    assert_eq!(coarse.belt_speed[2].to_bits(), fine.belt_speed[20_000].to_bits());
}

#[test]
fn errors_name_the_quantity() {
    let stiffness = Drivetrain::new(-1.0, 1.0).unwrap_err();
    assert_eq!(stiffness.to_string(), "stiffness is -1: it must be greater than 0");
    let none =
        System::at_speed(Drivetrain::new(0.0, 1.0).unwrap(), &baseline().1, 1.0).unwrap_err();
    assert_eq!(none.to_string(), "stiffness is 0: it must be greater than 0");
    let stick = Drag::new(50.0, 1.0, -0.7, -1.2, 2.0, Closure::Retained).unwrap_err();
    assert_eq!(stick.to_string(), "stick_speed is 2: it must be less than 1");
    let (train, drag) = baseline();
    assert!(simulate(&train, &drag, f64::NAN, Start::REST, 1.0, 10, 1e-9).is_err());
    assert!(simulate(&train, &drag, 1.0, Start::REST, 1.0, 10, 0.1).is_err());
}

#[test]
fn steady_sliding_is_recognised_by_its_energy() {
    // hardly damped, so that waiting for the swing to die out would take thousands of laps
    let drag = Drag::new(0.5, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    let train = Drivetrain::new(1000.0, 1.0).unwrap();
    let cycle = stick_slip(&train, &drag, 5.0, Start::REST, 1e-9).unwrap();
    assert_eq!(cycle.kind, CycleKind::SteadySliding);
    assert!(cycle.laps < 200);
    assert_close(cycle.speed_max, 5.0, 0.0);
    assert_close(cycle.stretch_max, drag.force(5.0) / 1000.0, 1e-12);
}

#[test]
fn an_unstable_balance_does_not_count_as_motion() {
    // at 0.5 v_t steady sliding is unstable: a nudge grows into stick-slip
    let (train, drag) = baseline();
    let start = Start { belt_speed: 0.5 * 1.001, stretch: drag.force(0.5) / 1000.0 };
    assert_eq!(stick_slip(&train, &drag, 0.5, start, 1e-9).unwrap().kind, CycleKind::StickSlip);
}

#[test]
fn absurd_values_end_with_an_error_or_a_result_but_do_end() {
    for (k, m, force, v_t, stick, drive) in [
        (1e308, 1.0, 50.0, 1.0, 0.01, 1.0),
        (1000.0, 1e-300, 50.0, 1.0, 0.01, 1.0),
        (1000.0, 1.0, 50.0, 1.0, 1e-300, 1.0),
        (1000.0, 1.0, 50.0, 1.0, 0.01, 1e300),
        (1e-300, 1e300, 50.0, 1.0, 0.01, 1.0),
        (1000.0, 1.0, 1e-300, 1e-150, 1e-160, 1.0),
    ] {
        let drag = Drag::new(force, v_t, -0.7, -1.2, stick, Closure::Retained).unwrap();
        let train = Drivetrain::new(k, m).unwrap();
        let _ = stick_slip(&train, &drag, drive, Start::REST, 1e-9);
        let _ = simulate(&train, &drag, drive, Start::REST, 1.0, 11, 1e-9);
    }
}

#[test]
fn an_event_just_at_the_end_leaves_no_sample_out() {
    let train = Drivetrain::new(1000.0, 1.0).unwrap();
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    let over =
        |duration: f64| simulate(&train, &drag, 1.0, Start::REST, duration, 5, 1e-12).unwrap();
    for event in over(1.0).events {
        let run = over(event.time);
        assert_eq!((run.mode.len(), run.slipping.len()), (5, 5));
        assert!((run.stretch[4] - event.stretch).abs() < 1e-12, "{event:?}");
        assert!((run.belt_speed[4] - event.belt_speed).abs() < 1e-9, "{event:?}");
    }
}

/// A static force that has grown for three hours throws the belt so far that it turns back three times, too fast to be
/// caught by the force that has not grown. Computed with `SciPy`, DOP853, from rest to rest.
#[test]
fn a_belt_that_is_caught_in_its_fourth_swing() {
    let train = Drivetrain::new(0.084_058_963_594_911_45, 35.508_066_131_046_92).unwrap();
    let drag = Drag::new(
        1.927_192_670_601_642_2,
        0.778_461_043_523_370_9,
        -0.745_755_568_572_81,
        -2.050_263_292_666_207_4,
        0.009_457_265_691_432_366,
        Closure::Stiction,
    )
    .unwrap();
    let growth =
        Strengthening { growth: 0.017_916_461_729_098_308, time: 0.011_029_508_259_350_012 };
    let drag = drag.with_breakaway_force(438.110_484_147_041_75).unwrap();
    let drag = drag.with_strengthening(growth).unwrap();
    let rest = Rest { force: 0.269_052_719_096_333_6, damping: 0.0 };
    let drag = drag.with_rest(rest).unwrap();
    let cycle = stick_slip(&train, &drag, 1.090_557_288_820_508_6, Start::REST, 1e-9).unwrap();
    assert_eq!((cycle.kind, cycle.laps_per_period), (CycleKind::StickSlip, 4));
    assert_close(4.0 * cycle.stick_duration, 10_658.81, 3e-6);
    assert_close(4.0 / cycle.frequency, 10_658.81 + 452.156_2, 3e-6);
}
