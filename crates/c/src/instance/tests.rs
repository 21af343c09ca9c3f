//! Tests of an instance.

use super::*;
use crate::samples::{BASELINE, TORQUE, WARMED};
use crate::variables::place_of;

fn begun(text: &str) -> Instance {
    let mut instance = Instance::new(text).unwrap();
    instance.begin(Phase::Step).unwrap();
    instance
}

fn value(instance: &mut Instance, name: &str) -> f64 {
    instance.get(place_of(name).unwrap()).unwrap()
}

/// Everything that moves, to the bit.
fn moving(instance: &mut Instance) -> [u64; 5] {
    ["time", "belt_speed", "stretch", "drag", "mode"].map(|name| value(instance, name).to_bits())
}

#[test]
fn where_one_stops_changes_no_bit() {
    for text in [BASELINE, TORQUE, WARMED] {
        let (mut one, mut other) = (begun(text), begun(text));
        one.advance(1.0, 0.0, false).unwrap();
        for i in 1..=1000 {
            other.advance(f64::from(i) / 1000.0, 0.0, false).unwrap();
            value(&mut other, "drag");
        }
        assert_eq!(moving(&mut one), moving(&mut other));
    }
}

#[test]
fn a_state_goes_on_to_the_last_bit_also_elsewhere() {
    for text in [BASELINE, TORQUE, WARMED] {
        let mut one = begun(text);
        one.advance(0.37, 0.0, false).unwrap();
        let saved = one.saved();
        one.set(one.description.drive_place(), 0.7).unwrap();
        one.advance(0.5, 0.0, false).unwrap();
        let (reached, later) = (moving(&mut one), one.saved());
        one.advance(0.9, 0.0, false).unwrap();
        let end = moving(&mut one);
        let mut other = Instance::new(text).unwrap();
        for instance in [&mut one, &mut other] {
            instance.restore(&saved).unwrap();
            instance.set(instance.description.drive_place(), 0.7).unwrap();
            instance.advance(0.5, 0.0, false).unwrap();
            assert_eq!(moving(instance), reached);
            instance.restore(&later).unwrap();
            instance.advance(0.9, 0.0, false).unwrap();
            assert_eq!(moving(instance), end);
        }
    }
}

#[test]
fn a_state_brings_its_inputs_into_an_instance_that_began_with_others() {
    for text in [BASELINE, TORQUE, WARMED] {
        let mut one = Instance::new(text).unwrap();
        let drive = one.description.drive_place();
        let warmed = one.has(TEMPERATURE);
        let set = |instance: &mut Instance, factor: f64, kelvin: f64| {
            let value = factor * instance.values[drive];
            instance.set(drive, value).unwrap();
            if warmed {
                instance.set(TEMPERATURE, kelvin).unwrap();
            }
        };
        set(&mut one, 0.8, 420.0);
        one.begin(Phase::Step).unwrap();
        one.advance(0.3, 0.0, false).unwrap();
        let saved = one.saved();
        one.advance(0.8, 0.0, false).unwrap();
        // one that is new, one with other inputs from the start, and one that was driven otherwise on the way
        let (fresh, mut started, mut driven) =
            (Instance::new(text).unwrap(), Instance::new(text).unwrap(), begun(text));
        set(&mut started, 1.7, 380.0);
        started.begin(Phase::Step).unwrap();
        driven.advance(0.2, 0.0, false).unwrap();
        set(&mut driven, 1.3, 390.0);
        driven.advance(0.4, 0.0, false).unwrap();
        for mut other in [fresh, started, driven] {
            other.restore(&saved).unwrap();
            other.advance(0.8, 0.0, false).unwrap();
            assert_eq!(moving(&mut other), moving(&mut one));
        }
    }
}

#[test]
fn a_parameter_of_the_saved_state_comes_back_with_it() {
    let mut one = Instance::new(BASELINE).unwrap();
    one.set(place_of("mass").unwrap(), 2.0).unwrap();
    one.begin(Phase::Step).unwrap();
    one.advance(0.5, 0.0, false).unwrap();
    let (saved, there) = (one.saved(), moving(&mut one));
    let mut other = begun(BASELINE);
    other.advance(0.5, 0.0, false).unwrap();
    assert_ne!(moving(&mut other), there);
    other.restore(&saved).unwrap();
    assert_eq!(moving(&mut other), there);
    one.advance(0.95, 0.0, false).unwrap();
    other.advance(0.95, 0.0, false).unwrap();
    assert!(value(&mut one, "mode") < 0.5);
    assert_eq!(moving(&mut one), moving(&mut other));
}

#[test]
fn a_step_ends_early_at_a_change_and_shows_it_once_it_is_updated() {
    let mut instance = Instance::new(BASELINE).unwrap();
    (instance.event_mode, instance.early_return) = (true, true);
    instance.begin(Phase::Step).unwrap();
    let reached = instance.step(0.0, 0.5).unwrap();
    assert!(reached.early && reached.changed && (reached.time - 0.341_400_762).abs() < 1e-9);
    assert!((value(&mut instance, "stuck") - 1.0).abs() < 1e-300);
    instance.enter(Phase::Event, &[Phase::Step]).unwrap();
    assert!((value(&mut instance, "mode") - 3.0).abs() < 1e-300);
    instance.show().unwrap();
    assert!((value(&mut instance, "mode") - 2.0).abs() < 1e-300);
    assert!(instance.step(reached.time, 0.1).unwrap_err().contains("at an event"));
    instance.enter(Phase::Step, &[Phase::Event]).unwrap();
    let next = instance.step(reached.time, 0.5 - reached.time).unwrap();
    assert!(next.early && next.time > reached.time && next.time < 0.342);
    // without early return the step is whole, and what has changed in it waits for the event mode
    instance.reset();
    instance.early_return = false;
    instance.begin(Phase::Step).unwrap();
    let whole = instance.step(0.0, 0.4).unwrap();
    assert!(whole.changed && !whole.early && value(&mut instance, "stuck") > 0.5);
    assert!((whole.time - 0.4).abs() < 1e-300);
    // and without event mode all is shown at once
    instance.reset();
    instance.event_mode = false;
    instance.begin(Phase::Step).unwrap();
    instance.step(0.0, 0.4).unwrap();
    assert!(value(&mut instance, "stuck") < 0.5 && value(&mut instance, "mode") < 0.5);
}

#[test]
fn an_input_goes_on_with_its_slope_for_one_step() {
    let mut instance = begun(BASELINE);
    let drive = instance.description.drive_place();
    instance.set_slope(drive, 0.5).unwrap();
    instance.advance(0.2, 0.0, false).unwrap();
    assert!((value(&mut instance, "drive_speed") - 1.1).abs() < 1e-12);
    // stuck: the spring has followed the drive, of which the belt keeps next to nothing
    assert!((value(&mut instance, "stretch") - (0.2 + 0.25 * 0.04)).abs() < 1e-9);
    instance.advance(0.3, 0.0, false).unwrap();
    assert!((value(&mut instance, "stretch") - (0.21 + 0.11)).abs() < 1e-9);
    assert!(instance.set_slope(place_of("mass").unwrap(), 1.0).unwrap_err().contains("no input"));
}

#[test]
fn what_fails_leaves_all_as_it_was() {
    let mut instance = begun(WARMED);
    instance.advance(0.3, 0.0, false).unwrap();
    let before = moving(&mut instance);
    for temperature in [-5.0, 0.0] {
        assert!(instance.set(TEMPERATURE, temperature).is_err());
    }
    assert_eq!(moving(&mut instance), before);
    instance.advance(0.4, 0.0, false).unwrap();
    let mut undisturbed = begun(WARMED);
    undisturbed.advance(0.4, 0.0, false).unwrap();
    assert_eq!(moving(&mut instance), moving(&mut undisturbed));
    let mut short = begun(&format!("{BASELINE}most_steps = 30\n"));
    short.advance(0.35, 0.0, false).unwrap();
    let before = moving(&mut short);
    let words = short.advance(100.0, 0.0, false).unwrap_err();
    assert!(words.contains("after 30 steps"), "{words}");
    assert_eq!(moving(&mut short), before);
}

#[test]
fn steps_that_are_none_are_refused() {
    let mut instance = Instance::new(BASELINE).unwrap();
    assert!(instance.step(0.0, 0.1).unwrap_err().contains("before its initialization"));
    instance.set_up(2.0, Some(3.0), None).unwrap();
    instance.begin(Phase::Step).unwrap();
    for (from, length) in [
        (2.0, 0.0),
        (2.0, -0.1),
        (2.0, f64::NAN),
        (f64::NAN, 0.1),
        (2.0, f64::INFINITY),
        (2.01, 0.1),
        (1.99, 0.1),
        (2.0, 1.5),
    ] {
        assert!(instance.step(from, length).is_err(), "{from} {length}");
    }
    for i in 0..100 {
        // the rounding of a tool that counts in steps
        instance.step(2.0 + f64::from(i) * 0.01, 0.01).unwrap();
    }
    assert!(instance.step(3.0, 0.01).unwrap_err().contains("stop time"));
    let refused = Instance::new(BASELINE).unwrap().set_up(1.0, Some(0.5), None);
    assert!(refused.unwrap_err().contains("is not after start time"));
}

#[test]
fn what_cannot_be_set_is_refused() {
    let mut instance = begun(BASELINE);
    for (name, words) in [
        ("mass", "fixed"),
        ("belt_speed", "computed"),
        ("time", "computed"),
        ("drive_speed", "finite"),
    ] {
        let refused = instance.set(place_of(name).unwrap(), f64::NAN).unwrap_err();
        assert!(refused.contains(words), "{refused}");
    }
    for (reference, kind, words) in [
        (9999, Kind::Float64, "no variable"),
        (102, Kind::Float64, "no variable"),
        (10, Kind::Enumeration, "belt_speed (value reference 10) is Float64, not Enumeration"),
        (20, Kind::Float64, "not Float64"),
    ] {
        assert!(instance.place(reference, kind).unwrap_err().contains(words));
    }
    let mut heavy = Instance::new(BASELINE).unwrap();
    heavy.set(place_of("mass").unwrap(), -1.0).unwrap();
    assert!(heavy.begin(Phase::Step).unwrap_err().contains("mass is -1"));
}

#[test]
fn a_tolerance_is_taken_if_it_is_tighter() {
    for (given, taken) in [(1e-4, 1e-9), (1e-12, 1e-12), (1e-20, 1e-14)] {
        let mut instance = Instance::new(BASELINE).unwrap();
        instance.set_up(0.0, None, Some(given)).unwrap();
        assert!((value(&mut instance, "tolerance") / taken - 1.0).abs() < 1e-12);
    }
    assert!(Instance::new(BASELINE).unwrap().set_up(0.0, None, Some(0.0)).is_err());
}

#[test]
fn a_temperature_below_the_scale_of_the_law_is_refused_with_its_zero() {
    let celsius = WARMED.replace("temperature = 330.0", "temperature = 300.0");
    let mut instance = begun(&format!("{celsius}temperature_zero = 273.15\n"));
    let words = instance.set(TEMPERATURE, 253.15).unwrap_err();
    assert_eq!(words, "temperature is 253.15 K: the law begins above 273.15 K");
}

#[test]
fn at_an_event_outputs_answer_to_the_inputs_and_the_motion_follows_once_they_are_settled() {
    let mut instance = Instance::new(&WARMED.replace("grip = 120.0\n", "")).unwrap();
    (instance.event_mode, instance.early_return) = (true, true);
    instance.begin(Phase::Event).unwrap();
    instance.enter(Phase::Step, &[Phase::Event]).unwrap();
    let reached = instance.step(0.0, 0.5).unwrap();
    // who goes on without looking is told
    let words = instance.step(reached.time, 0.1).unwrap_err();
    assert!(words.contains("an event waits"), "{words}");
    instance.enter(Phase::Event, &[Phase::Step]).unwrap();
    instance.show().unwrap();
    let (saved, drag) = (instance.saved(), value(&mut instance, "drag"));
    // tried values leave no trace
    for temperature in [500.0, 380.0] {
        instance.set(TEMPERATURE, temperature).unwrap();
        assert!((value(&mut instance, "drag") - drag).abs() > 1.0, "{temperature}");
    }
    assert_eq!(instance.saved().moment, saved.moment);
    instance.set(TEMPERATURE, 330.0).unwrap();
    assert_eq!(value(&mut instance, "drag").to_bits(), drag.to_bits());
    // settled, the motion follows, and the next step begins without a jump of its own
    instance.set(TEMPERATURE, 380.0).unwrap();
    let drag = value(&mut instance, "drag");
    instance.show().unwrap();
    instance.enter(Phase::Step, &[Phase::Event]).unwrap();
    assert_eq!(value(&mut instance, "drag").to_bits(), drag.to_bits());
    assert!(instance.step(reached.time, 1e-6).unwrap().time > reached.time);
}

#[test]
fn a_motion_that_is_no_longer_finite_is_refused() {
    let mut instance = Instance::new(BASELINE).unwrap();
    instance.event_mode = true;
    instance.begin(Phase::Step).unwrap();
    instance.step(0.0, 0.35).unwrap();
    instance.show().unwrap();
    instance.early_return = true;
    let before = moving(&mut instance);
    // a mode changes next, while the state that it changes at is out of all numbers
    instance.set(instance.description.drive_place(), 1e308).unwrap();
    let words = instance.step(0.35, 0.1).unwrap_err();
    assert!(words.contains("no longer finite"), "{words}");
    assert_eq!(moving(&mut instance), before);
}

#[test]
fn a_torque_pulls_at_the_radius_of_the_roll() {
    let mut instance = begun(TORQUE);
    // held at rest: 3 N m at 20 mm, which the drag balances
    assert!(value(&mut instance, "stuck") > 0.5);
    assert!((value(&mut instance, "drag") - 3.0 / 0.02).abs() < 1e-12);
}
