//! What must hold for every drivetrain and drag law.

mod common;

use hersey_core::drag::{Closure, Drag, Mode};
use hersey_core::motion::{CycleKind, Drivetrain, Start, stick_slip};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use common::simulate;

/// (stiffness, mass, transition force, transition speed, EHL exponent, mixed exponent, `v_s/v_t`, `drive/v_t`)
type Case = (f64, f64, f64, f64, f64, f64, f64, f64);

fn case() -> impl Strategy<Value = Case> {
    (
        (2.0..4.0_f64).prop_map(|x| 10_f64.powf(x)),
        (-1.0..1.0_f64).prop_map(|x| 10_f64.powf(x)),
        (0.5..2.5_f64).prop_map(|x| 10_f64.powf(x)),
        0.1..10.0_f64,
        -0.9..-0.3_f64,
        -1.6..-1.05_f64,
        1e-3..0.2_f64,
        0.2..3.0_f64,
    )
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(20151),
        failure_persistence: None,
        ..Default::default()
    }
}

fn built((k, m, force, v_t, ehl, mixed, stick, _): Case) -> (Drivetrain, Drag) {
    let drag = Drag::new(force, v_t, ehl, mixed, stick * v_t, Closure::Retained).unwrap();
    (Drivetrain::new(k, m).unwrap(), drag)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn work_of_the_drive_is_stored_or_dissipated(case in case()) {
        let (train, drag) = built(case);
        let drive_speed = case.7 * case.3;
        let duration = 10.0 * train.time_scale();
        let run = simulate(&train, &drag, drive_speed, Start::REST, duration, 400_001, 1e-10).unwrap();
        // a belt that creeps against the pull of the spring is braked by the rule, not by the drag law
        prop_assume!(!run.events.iter().any(|e| e.from == Mode::Stuck && e.stretch * e.belt_speed < 0.0));
        let step = duration / 400_000.0;
        let (mut work, mut dissipated) = (0.0, 0.0);
        for i in 1..run.time.len() {
            let pull = |j: usize| train.stiffness() * run.stretch[j];
            // in the stuck phase drag is whatever holds the belt, so it balances the spring
            let drag_at = |j: usize| match run.mode[j] {
                Mode::Stuck => pull(j),
                _ => drag.force(run.belt_speed[j]),
            };
            work += 0.5 * step * (pull(i) + pull(i - 1)) * drive_speed;
            dissipated += 0.5 * step
                * (drag_at(i) * run.belt_speed[i] + drag_at(i - 1) * run.belt_speed[i - 1]);
        }
        let last = run.time.len() - 1;
        let stored = 0.5 * train.mass() * run.belt_speed[last].powi(2)
            + 0.5 * train.stiffness() * run.stretch[last].powi(2);
        prop_assert!((work - dissipated - stored).abs() < 1e-4 * work.abs().max(stored));
    }

    #[test]
    fn similar_systems_have_the_same_cycle(case in case(), time in 0.1..10.0_f64, length in 0.1..10.0_f64) {
        // measuring time and length in other units changes every number but not the motion
        let (train, drag) = built(case);
        let (k, m, force, v_t, ehl, mixed, stick, drive) = case;
        let speed = length / time;
        let scaled_train = Drivetrain::new(k / time.powi(2), m).unwrap();
        let scaled_drag = Drag::new(
            force * speed / time, v_t * speed, ehl, mixed, stick * v_t * speed, Closure::Retained,
        ).unwrap();
        let cycle = stick_slip(&train, &drag, drive * v_t, Start::REST, 1e-10).unwrap();
        let scaled =
            stick_slip(&scaled_train, &scaled_drag, drive * v_t * speed, Start::REST, 1e-10).unwrap();
        prop_assert_eq!(cycle.kind, scaled.kind);
        prop_assert!((cycle.frequency - scaled.frequency * time).abs() <= 1e-6 * cycle.frequency);
        prop_assert!((cycle.speed_max * speed - scaled.speed_max).abs() <= 1e-6 * scaled.speed_max);
    }

    #[test]
    fn reversal_mirrors_the_motion(case in case()) {
        let (train, drag) = built(case);
        let drive_speed = case.7 * case.3;
        let duration = 20.0 * train.time_scale();
        let ahead = simulate(&train, &drag, drive_speed, Start::REST, duration, 101, 1e-9).unwrap();
        let back = simulate(&train, &drag, -drive_speed, Start::REST, duration, 101, 1e-9).unwrap();
        prop_assert_eq!(ahead.events.len(), back.events.len());
        for (a, b) in ahead.belt_speed.iter().zip(&back.belt_speed) {
            prop_assert!((a + b).abs() <= 0.0);
        }
    }

    #[test]
    fn every_cycle_settles_to_finite_numbers(case in case()) {
        let (train, drag) = built(case);
        let cycle = stick_slip(&train, &drag, case.7 * case.3, Start::REST, 1e-9).unwrap();
        prop_assert_ne!(cycle.kind, CycleKind::Unsettled);
        prop_assert!(cycle.speed_max.is_finite() && cycle.stretch_min.is_finite());
        prop_assert!(cycle.frequency >= 0.0 && cycle.stick_duration >= 0.0);
    }
}
