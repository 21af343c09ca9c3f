//! The motion from call to call: the same as in one go, however often one stops, and whatever changes on the way.

use hersey_core::drag::{Closure, Drag, Mode, Rest, Strengthening, TemperatureLaw};
use hersey_core::motion::{
    self, Cubic, Drive, Drivetrain, Event, Guard, Integrator, Moment, Schedule, Start, State,
    Stepper, System, Trajectory,
};
use hersey_core::{Error, Work};
use proptest::prelude::*;

#[path = "common/random.rs"]
mod random;

use random::Random;

const TOLERANCE: f64 = 1e-8;
const DURATION: f64 = 4.2;
/// The motion in one go is followed for longer: its last piece ends where it does, and rounding in it is another.
const LONGER: f64 = 5.0;
const SAMPLES: usize = 201;

/// A system, where it starts, and how it is integrated.
struct Setting {
    name: String,
    system: System,
    start: Start,
    integrator: Integrator,
}

fn closures() -> [Closure; 4] {
    let bristles = Closure::LuGre { bristle_stiffness: 2e4, bristle_damping: 100.0 };
    [Closure::Retained, Closure::Stiction, Closure::Stribeck, bristles]
}

fn law(closure: Closure, random: &mut Random) -> Drag {
    let force = random.between(8.0, 14.0);
    let (ehl, mixed) = (random.between(-0.9, -0.4), random.between(-1.6, -1.1));
    let rest = Rest { force: random.between(0.0, 2.0), damping: random.between(0.0, 1.0) };
    Drag::new(force, 0.3, ehl, mixed, 0.02, closure)
        .and_then(|drag| drag.with_rest(rest))
        .and_then(|drag| drag.with_temperature_law(TemperatureLaw::powers(373.0, -1.0, 12.0)))
        .unwrap()
}

/// Temperatures that stay, rise and fall, or jump.
fn temperature(kind: usize) -> Option<Schedule> {
    let through = |times: &[f64], values: &[f64]| Schedule::linear("temperature", times, values);
    match kind {
        0 => None,
        1 => through(&[0.0], &[360.0]).ok(),
        2 => through(&[0.5, 2.5, 4.0], &[373.0, 400.0, 355.0]).ok(),
        _ => through(&[1.0, 1.0, 2.3, 2.3, 4.1, 4.1], &[373.0, 390.0, 390.0, 350.0, 350.0, 373.0])
            .ok(),
    }
}

fn drive(kind: usize, grown: f64) -> Drive {
    let through = |times: &[f64], values: &[f64]| Schedule::linear("drive", times, values).unwrap();
    match kind {
        0 => Drive::Speed(Schedule::constant(grown * 0.2)),
        1 => Drive::Speed(through(&[0.0, 2.0, 3.0, 3.0], &[0.05, grown * 0.5, 0.3, 0.1])),
        _ => Drive::Force(through(&[0.0, 1.5, 1.5, 3.0, 5.0], &[2.0, 40.0, 60.0, 70.0, -20.0])),
    }
}

/// All closures, kinds of temperature and of drive; with and without a limit to the grip, a rest that makes the static
/// force grow, a stiff equation and the second integrator.
fn settings() -> Vec<Setting> {
    let mut random = Random(7);
    let mut settings = Vec::new();
    for i in 0..24_usize {
        let (closure, warm, driven) = (closures()[i % 4], (i / 4) % 4, (i + i / 4) % 3);
        let mut drag = law(closure, &mut random);
        let strengthens = i % 8 == 4 || i % 8 == 1;
        if strengthens {
            drag = drag.with_strengthening(Strengthening { growth: 0.05, time: 0.1 }).unwrap();
        }
        let mass = if i % 6 == 5 { 0.01 } else { random.between(0.5, 3.0) };
        let mut train = Drivetrain::new(random.decades(2.0, 2.9), mass).unwrap();
        if i % 5 < 2 {
            train = train.with_grip(random.between(9.0, 16.0)).unwrap();
        }
        let drive = drive(driven, random.between(0.8, 2.0));
        let integrator =
            if i == 8 || i == 21 { Integrator::DormandPrince } else { Integrator::Adaptive };
        settings.push(Setting {
            name: format!("{i}: {closure:?}, {drive:?}, temperature {warm}, {train:?}"),
            system: System::new(train, &drag, drive, temperature(warm)).unwrap(),
            start: Start { belt_speed: random.between(0.0, 0.5), stretch: 0.0 },
            integrator,
        });
    }
    settings
}

impl Setting {
    fn stepper(&self) -> Stepper {
        Stepper::new(self.system.clone(), self.start, TOLERANCE, self.integrator).unwrap()
    }

    fn in_one_go(&self) -> Trajectory {
        let work = Work::default();
        motion::simulate(
            &self.system,
            self.start,
            LONGER,
            SAMPLES,
            TOLERANCE,
            self.integrator,
            &work,
        )
        .unwrap_or_else(|error| panic!("{error}: {}", self.name))
    }
}

/// On to `until`, whatever happens on the way.
fn go_on(stepper: &mut Stepper, until: f64) -> Vec<Event> {
    let mut events = Vec::new();
    while let Some(event) = stepper.advance(until, &Work::default()).unwrap() {
        events.push(event);
    }
    events
}

#[test]
fn what_is_read_on_the_way_is_the_motion_in_one_go() {
    let (mut seen, mut worst) = (0, 0.0_f64);
    for setting in settings() {
        let run = setting.in_one_go();
        let mut stepper = setting.stepper();
        let mut events = Vec::new();
        for (i, time) in run.time.iter().enumerate().take_while(|(_, time)| **time <= DURATION) {
            events.extend(go_on(&mut stepper, *time));
            let state = stepper.state();
            let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-13 * scale;
            assert!(
                near(state.belt_speed, run.belt_speed[i], 1.0)
                    && near(state.stretch, run.stretch[i], 1.0),
                "{}: {state:?} against {} {}",
                setting.name,
                run.belt_speed[i],
                run.stretch[i]
            );
            worst = worst.max((state.belt_speed - run.belt_speed[i]).abs());
        }
        seen += events.len();
        assert_eq!(events.len(), run.events.partition_point(|event| event.time <= DURATION));
        for (event, other) in events.iter().zip(&run.events) {
            assert_eq!(event, other, "{}", setting.name);
        }
    }
    println!("{seen} events, {worst:e}");
    assert!(seen > 300);
}

fn bits(stepper: &Stepper) -> Vec<u64> {
    stepper.moment().numbers().iter().map(|number| number.to_bits()).collect()
}

/// Through numbers and back, into a stepper that has been elsewhere.
fn saved(setting: &Setting, stepper: &Stepper) -> Stepper {
    let numbers = stepper.moment().numbers();
    let mut other = setting.stepper();
    other.restore(Moment::from_numbers(&numbers).unwrap()).unwrap();
    assert_eq!(bits(&other), bits(stepper), "{}", setting.name);
    assert_eq!(other.state(), stepper.state(), "{}", setting.name);
    other
}

#[test]
fn a_motion_that_was_saved_goes_on_to_the_last_bit_in_every_mode() {
    let mut modes = std::collections::BTreeMap::<_, usize>::new();
    for setting in settings() {
        let mut stepper = setting.stepper();
        let mut random = Random(11);
        while stepper.time() < 4.0 {
            // at every event, and somewhere behind it
            let mut other = saved(&setting, &stepper);
            let until = stepper.time() + random.between(0.0, 0.1);
            let next = stepper.advance(until, &Work::default()).unwrap();
            assert_eq!(other.advance(until, &Work::default()).unwrap(), next, "{}", setting.name);
            assert_eq!(bits(&other), bits(&stepper), "{}", setting.name);
            let numbers = stepper.moment().numbers();
            let State { mode, slipping, .. } = stepper.state();
            *modes.entry((mode as u8, slipping, numbers[6] > 0.5)).or_default() += 1;
        }
    }
    println!("{modes:?}");
    // held, slow, mixed and full film, creeping, and held or slow on a roll that slips
    assert!(modes.len() >= 7, "{modes:?}");
}

/// A belt at these inputs, from rest.
fn driven(drive: f64, temperature: Option<f64>) -> Stepper {
    let drag = law(Closure::Retained, &mut Random(5));
    let train = Drivetrain::new(60.0, 0.4).unwrap();
    let drive = Drive::Speed(Schedule::constant(drive));
    let system = System::new(train, &drag, drive, temperature.map(Schedule::constant)).unwrap();
    Stepper::new(system, Start::REST, TOLERANCE, Integrator::Adaptive).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]
    #[test]
    fn a_moment_takes_its_inputs_along(
        inputs in [0.05..0.5_f64, 0.05..0.5_f64, 0.05..0.5_f64],
        heats in [350.0..400.0_f64, 350.0..400.0_f64, 350.0..400.0_f64],
        warmed in any::<[bool; 2]>(),
        times in [0.0..2.0_f64, 0.0..2.0_f64, 0.0..2.0_f64],
        changed in any::<[bool; 2]>(),
    ) {
        let heat = |i: usize| warmed[i % 2].then_some(heats[i]);
        let mut stepper = driven(inputs[0], heat(0));
        go_on(&mut stepper, times[0]);
        let drive = changed[0].then_some([inputs[1], 0.0, 0.0, 0.0]);
        let temperature = changed[1].then_some([heats[1], 0.0, 0.0, 0.0]);
        stepper.set_inputs(drive, temperature).unwrap();
        go_on(&mut stepper, times[0] + times[1]);
        // into one that began, and was driven, otherwise
        let mut other = driven(inputs[2], heat(1));
        go_on(&mut other, times[2]);
        other.set_inputs(Some([inputs[1], 0.1, 0.0, 0.0]), Some([heats[2], 0.5, 0.0, 0.0])).unwrap();
        other.restore(Moment::from_numbers(&stepper.moment().numbers()).unwrap()).unwrap();
        prop_assert_eq!(bits(&other), bits(&stepper));
        let end = times[0] + times[1] + 1.5;
        prop_assert_eq!(go_on(&mut other, end), go_on(&mut stepper, end));
        prop_assert_eq!(bits(&other), bits(&stepper));
        prop_assert_eq!(other.state(), stepper.state());
    }

    #[test]
    fn where_one_stops_changes_nothing(
        which in 0..24_usize,
        mut stops in prop::collection::vec(0.0..3.0_f64, 0..60),
    ) {
        let setting = &settings()[which];
        let mut once = setting.stepper();
        let events = go_on(&mut once, 3.0);
        stops.sort_by(f64::total_cmp);
        let mut often = setting.stepper();
        let mut seen = Vec::new();
        for stop in stops {
            seen.extend(go_on(&mut often, stop));
        }
        seen.extend(go_on(&mut often, 3.0));
        prop_assert_eq!(seen, events);
        prop_assert_eq!(bits(&often), bits(&once));
    }
}

fn through(times: &[f64], values: &[f64]) -> Schedule {
    Schedule::linear("drive", times, values).unwrap()
}

/// Straight lines through `(time, value)`, given to a stepper one after the other.
fn lines(times: &[f64], values: &[f64]) -> Vec<(f64, Cubic)> {
    let mut lines = Vec::new();
    for i in 1..times.len() {
        let span = times[i] - times[i - 1];
        if span > 0.0 {
            let slope = (values[i] - values[i - 1]) / span;
            lines.push((times[i - 1], [values[i - 1], slope, 0.0, 0.0]));
        }
    }
    lines.push((*times.last().unwrap(), [*values.last().unwrap(), 0.0, 0.0, 0.0]));
    lines
}

#[test]
fn what_is_given_on_the_way_is_what_a_schedule_gives() {
    let mut random = Random(3);
    let (mut jumps, mut seen) = (0, 0);
    for i in 0..24_usize {
        let drag = law(closures()[i % 4], &mut random);
        let train = Drivetrain::new(random.between(100.0, 900.0), random.between(0.5, 3.0));
        let train = train.and_then(|train| train.with_grip(random.between(9.0, 30.0))).unwrap();
        let times = [0.0, 0.8, 1.7, 1.7, 2.6, 3.0, 3.0];
        let (low, high) = if i % 3 == 2 { (-20.0, 60.0) } else { (0.05, 0.8) };
        let driven = times.map(|_| random.between(low, high));
        let mut warmth = times.map(|_| random.between(355.0, 395.0));
        if i % 2 == 0 {
            // steady between jumps
            (warmth[1], warmth[2], warmth[4], warmth[5]) =
                (warmth[0], warmth[0], warmth[3], warmth[3]);
        }
        let drive: fn(Schedule) -> Drive = if i % 3 == 2 { Drive::Force } else { Drive::Speed };
        let given = System::new(
            train,
            &drag,
            drive(through(&times, &driven)),
            Some(through(&times, &warmth)),
        )
        .unwrap();
        let start = Start { belt_speed: 0.1, stretch: 0.02 };
        let work = Work::default();
        let run = motion::simulate(&given, start, 4.0, 81, TOLERANCE, Integrator::Adaptive, &work)
            .unwrap();
        let first = Schedule::constant(driven[0]);
        let as_warm = Some(Schedule::constant(warmth[0]));
        let system = System::new(train, &drag, drive(first), as_warm).unwrap();
        let mut stepper = Stepper::new(system, start, TOLERANCE, Integrator::Adaptive).unwrap();
        let mut changes: Vec<(f64, Cubic, Cubic)> = lines(&times, &driven)
            .iter()
            .zip(lines(&times, &warmth))
            .map(|((time, driven), (_, warmth))| (*time, *driven, warmth))
            .collect();
        changes.reverse();
        let mut events = Vec::new();
        for (i, time) in run.time.iter().enumerate() {
            while let Some((change, driven, warmth)) =
                changes.pop_if(|(change, ..)| *change <= *time)
            {
                events.extend(go_on(&mut stepper, change));
                let before = stepper.state();
                let jump = stepper.set_inputs(Some(driven), Some(warmth)).unwrap();
                let after = stepper.state();
                jumps += usize::from(jump.is_some());
                events.extend(jump);
                // no force is infinite; a belt that is slower than its closure lets it be stops dead
                let dead = drag.closure() == Closure::Stiction && after.mode == Mode::Stuck;
                assert!(
                    (before.belt_speed - after.belt_speed).abs() < f64::MIN_POSITIVE || dead,
                    "{before:?} {after:?}"
                );
                assert!((before.stretch - after.stretch).abs() < 1e-14, "{before:?} {after:?}");
            }
            events.extend(go_on(&mut stepper, *time));
            let state = stepper.state();
            let off = (state.belt_speed - run.belt_speed[i]).abs();
            let far = (state.stretch - run.stretch[i]).abs();
            assert!(off < 2e-6 && far < 2e-6, "{i} {time} {off:e} {far:e} {:?}", drag.closure());
        }
        // bristles that swing out about nil do so in the last bits
        let told = |event: &&Event| !drag.closure().is_smooth() || event.guard != Guard::Reversal;
        let named = |events: &[Event]| -> Vec<(Mode, Mode, Guard)> {
            events.iter().filter(told).map(|event| (event.from, event.to, event.guard)).collect()
        };
        assert_eq!(named(&events), named(&run.events), "{i} {:?}", drag.closure());
        for (event, other) in events.iter().filter(told).zip(run.events.iter().filter(told)) {
            assert!((event.time - other.time).abs() < 1e-6, "{event:?} {other:?}");
        }
        seen += events.len();
    }
    println!("{seen} events, {jumps} of them by jumps");
    assert!(jumps > 2 && seen > 200);
}

/// What the law at `temperature` says of a belt that it has not moved in.
fn holds(drag: &Drag, state: &State) -> bool {
    let speed = state.belt_speed.abs();
    let bears = if drag.closure() == Closure::Stiction {
        drag.holding_force(0.0)
    } else if speed > drag.stick_speed() {
        drag.force(speed)
    } else {
        drag.holding_force(speed)
    };
    state.pull.abs() <= bears * (1.0 + 1e-12)
}

#[test]
fn a_jump_of_temperature_or_force_moves_neither_belt_nor_spring() {
    let mut random = Random(5);
    let mut changes = std::collections::BTreeMap::<_, usize>::new();
    for i in 0..60_usize {
        let closure = [Closure::Retained, Closure::Stiction, Closure::Stribeck][i % 3];
        let drag = law(closure, &mut random);
        let train = Drivetrain::new(random.between(50.0, 500.0), random.between(0.2, 3.0)).unwrap();
        let by_force = i % 2 == 0;
        let drive = if by_force {
            Drive::Force(Schedule::constant(15.0))
        } else {
            Drive::Speed(Schedule::constant(random.between(0.02, 0.4)))
        };
        let system = System::new(train, &drag, drive, Some(Schedule::constant(373.0))).unwrap();
        let start = Start { belt_speed: random.between(-0.3, 0.5), stretch: 0.0 };
        let mut stepper = Stepper::new(system, start, TOLERANCE, Integrator::Adaptive).unwrap();
        for _ in 0..60 {
            let until = stepper.time() + random.between(0.0, 0.3);
            // now and then just where an event has led
            if stepper.advance(until, &Work::default()).unwrap().is_none() || random.unit() < 0.7 {
                go_on(&mut stepper, until);
            }
            let before = stepper.state();
            let temperature = random.between(340.0, 410.0);
            let force = by_force.then(|| [random.between(-30.0, 30.0), 0.0, 0.0, 0.0]);
            let told = stepper.set_inputs(force, Some([temperature, 0.0, 0.0, 0.0])).unwrap();
            let after = stepper.state();
            let drag = drag.at(temperature).unwrap();
            let dead = closure == Closure::Stiction && after.mode == Mode::Stuck;
            assert!(
                (before.belt_speed - after.belt_speed).abs() < f64::MIN_POSITIVE || dead,
                "{before:?} {after:?}"
            );
            assert!((after.stretch - before.stretch).abs() < 1e-13, "{before:?} {after:?}");
            assert_eq!(told.is_some(), before.mode != after.mode);
            let speed = after.belt_speed.abs();
            match after.mode {
                Mode::Stuck => assert!(holds(&drag, &after), "{after:?}"),
                Mode::Microslip => assert!(speed <= drag.stick_speed() * (1.0 + 1e-12)),
                Mode::Mixed => assert!(
                    (drag.stick_speed()..=drag.transition_speed()).contains(&speed),
                    "{after:?}"
                ),
                Mode::Ehl => assert!(speed >= drag.transition_speed(), "{after:?}"),
            }
            if after.mode == Mode::Microslip && closure == Closure::Retained {
                let equal = (after.pull.abs() - drag.holding_force(speed)).abs() < 1e-9;
                assert!(!holds(&drag, &after) || equal, "{after:?}");
            }
            *changes.entry((before.mode as u8, after.mode as u8)).or_default() += 1;
        }
    }
    println!("{changes:?}");
    assert!(changes.len() >= 11, "{changes:?}");
}

fn at_speed(speed: f64) -> Stepper {
    let drag = law(Closure::Retained, &mut Random(1));
    let drag = drag.with_temperature_law(TemperatureLaw::powers(373.0, -1.0, 2.0)).unwrap();
    let train = Drivetrain::new(500.0, 1.0).unwrap();
    let drive = Drive::Speed(Schedule::constant(speed));
    let system = System::new(train, &drag, drive, Some(Schedule::constant(373.0))).unwrap();
    Stepper::new(system, Start::REST, TOLERANCE, Integrator::Adaptive).unwrap()
}

#[test]
fn what_does_not_change_moves_no_bit() {
    let (mut once, mut often) = (at_speed(0.2), at_speed(0.2));
    go_on(&mut once, 2.0);
    for i in 1..=200 {
        go_on(&mut often, 0.01 * f64::from(i));
        assert_eq!(
            often.set_inputs(Some([0.2, 0.0, 0.0, 0.0]), Some([373.0, 0.0, 0.0, 0.0])),
            Ok(None)
        );
    }
    assert_eq!(bits(&once), bits(&often));
}

#[test]
fn a_drive_that_stands_leaves_the_belt_held_for_ever() {
    let mut stepper = at_speed(0.0);
    assert_eq!(stepper.advance(1e6, &Work::default()), Ok(None));
    let state = stepper.state();
    assert_eq!((state.mode, state.belt_speed, state.drag), (Mode::Stuck, 0.0, state.pull));
    // and one that begins to creep up later is not missed
    stepper.set_drive([0.0, 1e-3, 0.0, 0.0]).unwrap();
    let event = stepper.advance(2e6, &Work::default()).unwrap().unwrap();
    assert_eq!((event.from, event.guard), (Mode::Stuck, Guard::HoldingForce));
    let pull = 500.0 * 0.5e-3 * (event.time - 1e6).powi(2);
    assert!((pull - stepper.state().pull).abs() < 1e-6 * pull);
}

#[test]
fn a_temperature_that_leads_out_of_the_law_is_refused_where_it_does() {
    let mut stepper = at_speed(0.2);
    go_on(&mut stepper, 0.5);
    stepper.set_temperature([373.0, -100.0, 0.0, 0.0]).unwrap();
    go_on_or(&mut stepper, 4.2).unwrap();
    let error = go_on_or(&mut stepper, 5.0).unwrap_err();
    assert!(matches!(error, Error::TooSmall { .. } | Error::Stalled { .. }), "{error}");
    assert!(stepper.time() > 4.2 && stepper.time() < 4.2301, "{}", stepper.time());
    assert!(stepper.state().belt_speed.is_finite());
    // another temperature leads on
    stepper.set_temperature([373.0, 0.0, 0.0, 0.0]).unwrap();
    go_on(&mut stepper, 5.0);
}

fn go_on_or(stepper: &mut Stepper, until: f64) -> Result<(), Error> {
    while stepper.advance(until, &Work::default())?.is_some() {}
    Ok(())
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut stepper = at_speed(0.2);
    go_on(&mut stepper, 1.0);
    let before = bits(&stepper);
    for (i, number) in [
        (0, 1.0),
        (0, 3.0),
        (1, 9.0),
        (3, 4.0),
        (3, 0.5),
        (4, 2.0),
        (4, -1.0),
        (5, 2.0),
        (7, 1.0),
        (9, 0.0),
        (10, 0.5),
        (11, f64::NAN),
        (12, f64::INFINITY),
        (14, -1.0),
        (17, 1.0),
        (19, 3.0),
    ] {
        let mut numbers = stepper.moment().numbers();
        numbers[i] = number;
        let refused = Moment::from_numbers(&numbers).and_then(|moment| stepper.restore(moment));
        assert!(refused.is_err(), "{i} {number}");
    }
    let numbers = stepper.moment().numbers();
    assert!(
        Moment::from_numbers(&numbers[1..]).is_err() && Moment::from_numbers(&[0.0; 32]).is_err()
    );
    let mut far = numbers;
    far[2] = 1e9; // beyond the piece under way
    assert!(Moment::from_numbers(&far).and_then(|moment| stepper.restore(moment)).is_err());
    assert!(stepper.set_temperature([-3.0, 0.0, 0.0, 0.0]).is_err());
    assert!(stepper.set_drive([f64::NAN, 0.0, 0.0, 0.0]).is_err());
    assert!(stepper.advance(0.5, &Work::default()).is_err());
    assert!(stepper.advance(f64::INFINITY, &Work::default()).is_err());
    assert_eq!(bits(&stepper), before);
}
