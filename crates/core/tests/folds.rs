//! Folds of belts whose drive drags with speed and whose roll may slip, against motions followed one by one.

#[path = "common/random.rs"]
mod random;

use hersey_core::Work;
use hersey_core::drag::{Closure, Drag, Rest};
use hersey_core::motion::{Belt, CycleKind, Drivetrain, Span, Start, ensemble, settle, stick_slip};
use hersey_core::stability::{Band, Method, bands, swings};
use random::Random;

const TOLERANCE: f64 = 1e-11;

/// A belt like those of machines: a rest of the drive that grows with speed, and a grip that may matter.
fn belt(random: &mut Random) -> (Drivetrain, Drag) {
    let (k, m) = (random.decades(2.0, 4.0), random.decades(-1.0, 1.0));
    let speed = random.decades(-2.0, 0.0);
    let impedance = f64::sqrt(k * m);
    let force = random.decades(-0.8, 0.5) * impedance * speed;
    let (mixed, ehl) = (random.between(-2.1, -1.15), random.between(-0.8, -0.4));
    let stick = speed * random.decades(-1.7, -0.7);
    let rest = Rest {
        force: force * random.between(0.0, 3.0),
        damping: impedance * random.decades(-3.0, -1.0),
    };
    let drag = Drag::new(force, speed, ehl, mixed, stick, Closure::Retained).unwrap();
    let drag = drag.with_rest(rest).unwrap();
    // from where a belt that sticks is just released
    let grip = drag.holding_force(stick) * random.between(1.02, 3.0);
    (Drivetrain::new(k, m).unwrap().with_grip(grip).unwrap(), drag)
}

fn band_of(train: Drivetrain, drag: &Drag, lower: bool) -> Band {
    bands(&[(train, drag.clone())], lower, TOLERANCE, &Work::default()).unwrap().remove(0).unwrap()
}

/// Whether a belt that has just been released goes on to slow down to the stick speed, or to slip on its roll.
fn is_rough(train: &Drivetrain, drag: &Drag, drive_speed: f64) -> bool {
    let belt_speed = drag.stick_speed();
    let start = Start { belt_speed, stretch: drag.holding_force(belt_speed) / train.stiffness() };
    let cycle = stick_slip(train, drag, drive_speed, start, TOLERANCE).unwrap();
    let sticks = cycle.kind != CycleKind::SteadySliding
        && cycle.speed_min <= drag.stick_speed() * (1.0 + 1e-9);
    sticks || cycle.grip_slip_duration > 0.0
}

#[test]
fn stick_slip_ends_where_half_laps_meet() {
    let mut random = Random(15);
    let (mut slipping, mut fast) = (0, 0);
    for i in 0..100 {
        let (train, drag) = belt(&mut random);
        let band = band_of(train, &drag, false);
        let free = Drivetrain::new(train.stiffness(), train.mass()).unwrap();
        if band.method != Method::HalfLaps || !band.upper.is_finite() {
            continue;
        }
        fast += 1;
        slipping += usize::from(band.upper < 0.999 * band_of(free, &drag, false).upper);
        assert!(is_rough(&train, &drag, band.upper * (1.0 - 3e-5)), "{i}: {band:?} {drag:?}");
        assert!(!is_rough(&train, &drag, band.upper * (1.0 + 3e-5)), "{i}: {band:?} {drag:?}");
    }
    assert!(fast > 90 && slipping > 15, "{fast} {slipping}");
}

#[test]
fn a_loose_tolerance_finds_the_fold_of_a_tight_one() {
    let mut random = Random(8);
    for i in 0..300 {
        let (train, drag) = belt(&mut random);
        let belts = [(train, drag)];
        let at = |tolerance: f64| {
            bands(&belts, true, tolerance, &Work::default()).unwrap().remove(0).unwrap()
        };
        let (tight, loose) = (at(1e-13), at(1e-8));
        assert_eq!((tight.method, tight.deeper), (loose.method, loose.deeper), "{i}");
        for (a, b, accuracy) in [
            (tight.upper, loose.upper, loose.upper_accuracy),
            (tight.lower, loose.lower, loose.lower_accuracy),
        ] {
            assert!((a - b).abs() <= accuracy * a, "{i}: {tight:?} {loose:?}");
        }
    }
}

#[test]
fn the_fold_of_a_heavy_belt_is_as_accurate_as_it_says() {
    let mut random = Random(21);
    let (mut far, mut worst) = (0, 0.0_f64);
    for i in 0..150 {
        let (train, drag) = belt(&mut random);
        let train =
            Drivetrain::new(train.stiffness(), train.mass() * random.decades(0.0, 3.0)).unwrap();
        let belts = [(train, drag)];
        let at =
            |tolerance: f64| bands(&belts, false, tolerance, &Work::default()).unwrap().remove(0);
        let (Ok(tight), Ok(loose)) = (at(1e-13), at(1e-8)) else { continue };
        if (tight.method, loose.method) != (Method::HalfLaps, Method::HalfLaps) {
            continue;
        }
        far += usize::from(tight.upper > 20.0 * tight.transition);
        let off = (tight.upper - loose.upper).abs() / tight.upper;
        assert!(off <= loose.upper_accuracy, "{i}: {tight:?} {loose:?}");
        worst = worst.max(off / loose.upper_accuracy);
    }
    assert!(far > 3 && worst > 0.1, "{far} {worst}");
}

#[test]
fn a_nudged_belt_sticks_below_the_lower_edge_and_swings_on_above() {
    let mut random = Random(3);
    for i in 0..4 {
        let (train, drag) = belt(&mut random);
        let train = Drivetrain::new(train.stiffness(), train.mass()).unwrap();
        let lower = band_of(train, &drag, true).lower;
        assert!(lower <= drag.rising_from());
        let sticks = |drive_speed: f64| {
            let start = Start::steady(&train, &drag, drive_speed).unwrap().nudged();
            let cycle = stick_slip(&train, &drag, drive_speed, start, TOLERANCE).unwrap();
            cycle.kind == CycleKind::StickSlip
        };
        assert!(sticks(lower * 0.999) && !sticks(lower * 1.001), "{i}: {lower} {drag:?}");
    }
}

#[test]
fn no_start_matters_where_the_slowest_swing_is_the_one_that_just_sticks() {
    // faster swings ask for a faster drive, so the lower edge is where the upper one is
    let drag = Drag::new(6.61, 1.0, -0.511, -1.146, 0.197, Closure::Retained).unwrap();
    let drag = drag.with_rest(Rest { force: 0.0, damping: 0.0036 }).unwrap();
    let train = Drivetrain::new(1.0, 1.0).unwrap();
    let band = band_of(train, &drag, true);
    assert!(band.lower <= band.upper && band.lower > band.upper * (1.0 - 1e-9), "{band:?}");
    let sticks = |drive_speed: f64| {
        let start = Start::steady(&train, &drag, drive_speed).unwrap().nudged();
        stick_slip(&train, &drag, drive_speed, start, TOLERANCE).unwrap().kind
            == CycleKind::StickSlip
    };
    assert!(sticks(band.lower * 0.9999) && !sticks(band.lower * 1.0001), "{band:?}");
}

#[test]
fn belts_in_lanes_settle_as_they_do_alone() {
    let mut random = Random(4);
    let belts: Vec<Belt> = (0..200)
        .map(|_| {
            let (train, drag) = belt(&mut random);
            let drive_speed = drag.transition_speed() * random.decades(-0.5, 0.7);
            Belt { train, drag, drive_speed, start: Start::REST }
        })
        .collect();
    let work = Work::default();
    let together = ensemble(&belts, Span::UntilClosed, TOLERANCE, &work).unwrap();
    for (i, (belt, found)) in belts.iter().zip(together).enumerate() {
        let Belt { train, drag, drive_speed, start } = belt;
        let span = Span::UntilClosed;
        let alone = settle(train, drag, *drive_speed, *start, span, TOLERANCE, &work).unwrap();
        let found = found.unwrap();
        assert_eq!(found.kind, alone.kind, "{i}: {belt:?}");
        let pairs = [
            (found.frequency, alone.frequency),
            (found.speed_min, alone.speed_min),
            (found.speed_max, alone.speed_max),
            (found.stretch_max, alone.stretch_max),
            (found.drag_work, alone.drag_work),
            (found.stick_duration, alone.stick_duration),
        ];
        for (a, b) in pairs {
            assert!((a - b).abs() <= 1e-7 * b.abs(), "{i}: {found:?} {alone:?}");
        }
        // the least may be nil, or nearly
        assert!((found.stretch_min - alone.stretch_min).abs() <= 1e-7 * alone.stretch_max, "{i}");
    }
}

#[test]
fn no_swing_stays_where_drag_rises() {
    let train = Drivetrain::new(1000.0, 1.0).unwrap();
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    let drag = drag.with_rest(Rest { force: 5.0, damping: 15.0 }).unwrap();
    let foot = drag.rising_from();
    assert!(foot > 0.5 && foot < 0.9);
    let slowest = [0.9 * foot, 1.01 * foot];
    let found = swings(&train, &drag, &slowest, TOLERANCE, &Work::default()).unwrap().unwrap();
    assert!(found[0].drive_speed > 0.95 * foot && found[0].drive_speed < 1.05 * foot);
    assert!(found[1].drive_speed.is_nan() && !found[1].stable);
}

#[test]
fn the_drag_work_of_a_small_cycle_is_that_of_one_lap() {
    let train = Drivetrain::new(1.0, 1.0).unwrap();
    let drag = Drag::new(3.11, 1.0, -0.661, -1.251, 0.183, Closure::Retained).unwrap();
    let start = Start { belt_speed: 0.85, stretch: drag.force(0.85) };
    let cycle = stick_slip(&train, &drag, 0.991_338_038_002_153, start, TOLERANCE).unwrap();
    assert_eq!(cycle.kind, CycleKind::Oscillation);
    // SciPy's DOP853: drive speed times the integral of the pull over one period
    assert!((cycle.drag_work - 22.450_588_164).abs() < 1e-6, "{cycle:?}");
}

/// A table that falls by 9 N s/m about from 0.1 to 0.3 m/s, and by 48 further on.
fn falling_table() -> Drag {
    let (speeds, forces) = ([0.01, 0.1, 0.3, 1.0, 3.0], [60.0, 50.0, 48.0, 20.0, 30.0]);
    Drag::tabulated(&speeds, &forces, 0.02, Closure::Retained).unwrap()
}

#[test]
fn a_belt_slides_steadily_where_a_table_that_falls_falls_by_less_than_the_rest_rises() {
    let drag = falling_table().with_rest(Rest { force: 0.0, damping: 30.0 }).unwrap();
    let train = Drivetrain::new(1000.0, 1.0).unwrap();
    let nudged = |drive_speed: f64| {
        let start = Start::steady(&train, &drag, drive_speed).unwrap().nudged();
        stick_slip(&train, &drag, drive_speed, start, TOLERANCE).unwrap()
    };
    let steady = nudged(0.2);
    assert_eq!(steady.kind, CycleKind::SteadySliding);
    assert!(steady.laps < 10, "{}", steady.laps);
    assert_ne!(nudged(0.5).kind, CycleKind::SteadySliding);
}

#[test]
fn near_the_fold_rounding_does_not_lengthen_the_period() {
    // at a loose tolerance rounding decides there whether a lap just comes down to the stick speed
    let (drag, train) = (falling_table(), Drivetrain::new(1000.0, 1.0).unwrap());
    let (mut low, mut high) = (3.0, 3.2);
    while high - low > 1e-12 * high {
        let middle = 0.5 * (low + high);
        let cycle = stick_slip(&train, &drag, middle, Start::REST, 1e-8).unwrap();
        assert!(cycle.kind != CycleKind::Unsettled && cycle.laps < 1000, "{middle}: {cycle:?}");
        assert_eq!(cycle.laps_per_period, 1, "{middle}: {cycle:?}");
        if cycle.kind == CycleKind::StickSlip { low = middle } else { high = middle }
    }
}

#[test]
fn a_lap_that_rounding_lets_stick_is_as_long_as_one_of_tight_steps() {
    let (drag, train) = (falling_table(), Drivetrain::new(1000.0, 1.0).unwrap());
    let at = |tolerance: f64| {
        stick_slip(&train, &drag, 3.077_691_523_684_189, Start::REST, tolerance).unwrap()
    };
    let (loose, tight) = (at(1e-8), at(1e-9));
    assert_eq!((loose.kind, tight.kind), (CycleKind::StickSlip, CycleKind::StickSlip));
    for (a, b) in [
        (loose.frequency, tight.frequency),
        (loose.drag_work, tight.drag_work),
        (loose.speed_min, tight.speed_min),
        (loose.speed_max, tight.speed_max),
    ] {
        assert!((a - b).abs() <= 1e-7 * b, "{loose:?} {tight:?}");
    }
}
