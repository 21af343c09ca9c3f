//! Folds and starts of belts whose drag is a smooth curve, against independent solutions and motions of the laws behind.

use hersey_core::drag::{Closure, Curve, Drag, Rest};
use hersey_core::motion::{Drivetrain, Span, Start, settle};
use hersey_core::stability::{CurveBelt, CurveFold, curve_folds, curve_starts};
use hersey_core::{Error, Work};

const BASE: (f64, f64, f64) = (50.0, 1.0, 0.01);

/// The rounded curve of two powers, `p` sharp; a corner for infinite `p`.
fn rounded(p: f64) -> Curve {
    let (up, down) = (0.3_f64, -0.2_f64);
    let w = -down / (up - down);
    let (first, step) = (f64::ln(0.005), 0.02);
    let values: Vec<f64> = (0..500)
        .map(|i| {
            let x = first + step * f64::from(i);
            let bend = if p.is_infinite() {
                (up * x).max(down * x)
            } else {
                (w * (up * p * x).exp() + (1.0 - w) * (down * p * x).exp()).ln() / p
            };
            BASE.0.ln() + bend
        })
        .collect();
    Curve::new(first, step, &values).unwrap()
}

fn belt(curve: Curve, closure: Closure) -> CurveBelt {
    CurveBelt {
        train: Drivetrain::new(1000.0, 1.0).unwrap(),
        curve,
        stick_speed: BASE.2,
        closure,
        static_ratio: std::f64::consts::E,
        rest: Rest::default(),
    }
}

fn fold(belt: &CurveBelt) -> CurveFold {
    curve_folds(std::slice::from_ref(belt), 1e-7, &Work::default()).unwrap()[0].unwrap()
}

#[test]
fn rounded_curves_have_the_folds_of_an_independent_solution() {
    for (p, upper) in [(1.0, 3.56116), (2.0, 3.28219), (4.0, 2.82374), (8.0, 2.47685)] {
        let found = fold(&belt(rounded(p), Closure::Retained));
        assert!((found.upper - upper).abs() < 6e-6 * upper, "{p}: {found:?}");
        assert!((found.transition - 1.0).abs() < 1e-4, "{p}: {found:?}");
    }
}

#[test]
fn a_corner_is_rounded_over_a_step_alone() {
    let found = fold(&belt(rounded(f64::INFINITY), Closure::Retained));
    assert!((found.upper - 2.173_493).abs() < 2e-4, "{found:?}");
}

#[test]
fn a_belt_that_stops_dead_is_let_go_at_the_greater_force() {
    // field notes: the Karnopp variant of the baseline has its fold at 9.958
    let found = fold(&belt(rounded(f64::INFINITY), Closure::Stiction));
    assert!((found.upper - 9.958).abs() < 3e-3, "{found:?}");
    assert!((found.holding - 341.4).abs() < 0.05);
}

#[test]
fn cycles_have_the_frequency_of_the_reference() {
    let work = Work::default();
    for (closure, drive_speed, frequency) in [
        (Closure::Retained, 0.4, 2.240_799),
        (Closure::Retained, 1.0, 3.940_314),
        (Closure::Retained, 1.9, 4.751_533),
        (Closure::Stiction, 1.0, 1.637_431),
    ] {
        let belt = belt(rounded(f64::INFINITY), closure);
        let found = curve_starts(&[(belt, drive_speed)], 1e-7, &work).unwrap();
        let start = found[0].unwrap();
        let cycle = start.cycle.unwrap();
        // the first slip from rest is released at A = 341.4, and the spring stretches until the belt is as fast
        assert!(start.first_peak > 341.40 && start.first_peak < 355.0, "{start:?}");
        assert!((1.0 / cycle.period / frequency - 1.0).abs() < 2e-4, "{cycle:?}");
    }
    let above = belt(rounded(f64::INFINITY), Closure::Retained);
    let slides = curve_starts(&[(above, 2.5)], 1e-6, &work).unwrap()[0].unwrap();
    assert_eq!(slides.cycle, None);
}

#[test]
fn a_belt_comes_to_the_same_bits_whatever_others_are_asked_for_with_it() {
    let work = Work::default();
    let closures = [Closure::Retained, Closure::Stiction, Closure::Stribeck];
    let belts: Vec<CurveBelt> = (0..50_u8)
        .map(|i| belt(rounded(1.0 + 0.2 * f64::from(i)), closures[usize::from(i) % 3]))
        .collect();
    let together = curve_folds(&belts, 1e-3, &work).unwrap();
    let started: Vec<_> = belts.iter().map(|belt| (belt.clone(), 1.2)).collect();
    let starts = curve_starts(&started, 1e-3, &work).unwrap();
    for (i, belt) in belts.iter().enumerate().rev().step_by(7) {
        let fold = curve_folds(std::slice::from_ref(belt), 1e-3, &work).unwrap()[0];
        let start = curve_starts(&started[i..=i], 1e-3, &work).unwrap()[0];
        assert_eq!((fold, start), (together[i], starts[i]));
    }
}

#[test]
fn each_belt_has_its_own_steps() {
    let belts = [belt(rounded(2.0), Closure::Retained), belt(rounded(4.0), Closure::Stiction)];
    let found = curve_folds(&belts, 1e-3, &Work::unwatched(50)).unwrap();
    assert_eq!(found, vec![Err(Error::WorkSpent { steps: 50 }); 2]);
    let stopped = curve_folds(&belts, 1e-3, &Work::new(u64::MAX, &|| true));
    assert_eq!(stopped, Err(Error::Stopped));
}

#[test]
fn a_belt_that_creeps_sticks_up_to_the_speed_that_its_motion_has() {
    // against the motion of the law with two branches, from rest, settled at drive speeds beside the fold
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Stribeck).unwrap();
    let found = fold(&belt(rounded(f64::INFINITY), Closure::Stribeck));
    let train = Drivetrain::new(1000.0, 1.0).unwrap();
    for (share, sticks) in [(0.995, true), (1.005, false)] {
        let (work, start) = (Work::default(), Start::REST);
        let span = Span::UntilClosed;
        let cycle = settle(&train, &drag, share * found.upper, start, span, 1e-8, &work);
        let slow = cycle.unwrap().speed_min < 0.0101;
        assert_eq!(slow, sticks, "{found:?}");
    }
}

#[test]
fn a_grip_too_weak_stalls_and_a_rest_shifts_the_pull() {
    let mut weak = belt(rounded(4.0), Closure::Stiction);
    weak.train = weak.train.with_grip(200.0).unwrap();
    let found = fold(&weak);
    assert!(found.stalls && (found.upper - found.transition).abs() < 1e-9);
    let mut shifted = belt(rounded(4.0), Closure::Retained);
    shifted.rest = Rest { force: 20.0, damping: 0.0 };
    let found = fold(&shifted);
    // a force that acts at any speed only shifts the pull
    assert!((found.upper - 2.82374).abs() < 2e-5 * 2.82374, "{found:?}");
}
