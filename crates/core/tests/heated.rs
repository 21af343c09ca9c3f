//! Temperature as a state, where it is known beforehand, and where the law of drag ends.

use hersey_core::Error;
use hersey_core::Work;
use hersey_core::drag::{Closure, Drag, Rest, SpeedLaw, TemperatureLaw};
use hersey_core::lubrication::mixed::MixedLaw;
use hersey_core::lubrication::viscosity;
use hersey_core::motion::{
    Drive, Drivetrain, HeatBalance, Heater, Integrator, Schedule, Start, System, Trajectory,
    simulate,
};

#[path = "common/sharing.rs"]
mod sharing;

use sharing::SHARING;

fn train() -> Drivetrain {
    Drivetrain::new(1000.0, 1.0).unwrap()
}

fn at_speed(speed: f64) -> Drive {
    Drive::Speed(Schedule::constant(speed))
}

fn mixed(closure: Closure, boundary_slope: f64) -> Drag {
    let law = TemperatureLaw { boundary_slope, ..TemperatureLaw::powers(373.0, -1.0, 2.0) };
    let drag = Drag::mixed(MixedLaw::new(SHARING).unwrap(), 0.1, 0.01, closure).unwrap();
    drag.with_temperature_law(law).unwrap()
}

/// Bodies that nothing warms or cools, but for `heater`.
fn bodies(temperature: f64, capacity: f64, heater: Heater) -> HeatBalance {
    let none = || Schedule::constant(0.0);
    HeatBalance {
        capacity: [capacity, 1.0],
        exchange: 0.0,
        loss: [0.0, 0.0],
        surroundings: temperature,
        heater,
        load: [none(), none()],
        start: [temperature; 2],
        temperature_zero: 0.0,
    }
}

fn unheated() -> Heater {
    Heater::Power(Schedule::constant(0.0))
}

fn followed(system: &System, start: Start, duration: f64) -> Result<Trajectory, Error> {
    simulate(system, start, duration, 41, 1e-12, Integrator::Adaptive, &Work::default())
}

#[test]
fn a_temperature_that_stays_is_a_fixed_one() {
    for closure in [Closure::Retained, Closure::Stiction] {
        for slope in [-5e-3, 5e-3] {
            let drag = mixed(closure, slope);
            let drive = || at_speed(2.0);
            let fixed = System::new(train(), &drag, drive(), Some(Schedule::constant(400.0)));
            let state = System::with_heat(train(), &drag, drive(), bodies(400.0, 1e15, unheated()));
            // a course that moves later
            let course = Schedule::linear("temperature", &[9.0, 10.0], &[400.0, 410.0]).unwrap();
            let course = System::new(train(), &drag, drive(), Some(course));
            let expected = followed(&fixed.unwrap(), Start::REST, 0.6).unwrap();
            assert!(expected.events.len() > 5, "{closure:?}");
            for other in [state, course] {
                let found = followed(&other.unwrap(), Start::REST, 0.6).unwrap();
                assert_eq!(found.mode, expected.mode);
                assert_eq!(found.events.len(), expected.events.len(), "{closure:?} {slope}");
                for (a, b) in found.events.iter().zip(&expected.events) {
                    assert_eq!((a.guard, a.to), (b.guard, b.to));
                    assert!((a.time - b.time).abs() < 1e-9, "{a:?} {b:?}");
                    assert!((a.belt_speed - b.belt_speed).abs() < 1e-9, "{a:?} {b:?}");
                }
                for (a, b) in found.belt_speed.iter().zip(&expected.belt_speed) {
                    assert!((a - b).abs() < 1e-9, "{closure:?} {slope}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_law_that_ends_where_friction_leads_is_refused() {
    // boundary friction fades as it warms until drag falls nowhere
    let drag = mixed(Closure::Stiction, -9e-3);
    let heat = bodies(373.0, 20.0, Heater::Power(Schedule::constant(500.0)));
    let system = System::with_heat(train(), &drag, at_speed(0.1), heat).unwrap();
    let error = followed(&system, Start::REST, 10.0).unwrap_err();
    assert!(!error.is_unfinished(), "{error}");
    // a law whose rest of the drive would turn negative
    let law = TemperatureLaw { rest_slope: -0.01, ..TemperatureLaw::powers(373.0, -1.0, 2.0) };
    let drag = Drag::new(10.0, 0.1, -0.7, -1.4, 0.01, Closure::Stiction).unwrap();
    let drag = drag.with_rest(Rest { force: 1.0, damping: 0.0 }).unwrap();
    let drag = drag.with_temperature_law(law).unwrap();
    let heat = bodies(373.0, 20.0, Heater::Power(Schedule::constant(500.0)));
    let system = System::with_heat(train(), &drag, at_speed(0.1), heat).unwrap();
    let error = followed(&system, Start::REST, 10.0).unwrap_err();
    assert!(error.to_string().starts_with("rest of the drive at this temperature"), "{error}");
}

#[test]
fn a_viscosity_is_asked_at_an_absolute_temperature_only() {
    let vogel = viscosity::TemperatureLaw::vogel([(313.0, 0.5), (373.0, 0.06), (453.0, 0.02)]);
    let speed = SpeedLaw::Viscosity(vogel.unwrap());
    let law = TemperatureLaw { speed, ..TemperatureLaw::powers(373.0, -1.0, 0.0) };
    let drag = Drag::new(10.0, 0.1, -0.7, -1.4, 0.01, Closure::Retained).unwrap();
    let drag = drag.with_temperature_law(law).unwrap();
    let heat = HeatBalance { temperature_zero: 20.0, ..bodies(400.0, 20.0, unheated()) };
    let error = System::with_heat(train(), &drag, at_speed(0.1), heat).unwrap_err();
    assert!(error.to_string().contains("absolute"), "{error}");
    // cooled to where the law diverges
    let mut heat = bodies(400.0, 20.0, unheated());
    heat.load[0] = Schedule::constant(400.0);
    let system = System::with_heat(train(), &drag, at_speed(0.0), heat).unwrap();
    let error = followed(&system, Start::REST, 20.0).unwrap_err();
    assert!(!error.is_unfinished(), "{error}");
}

#[test]
fn a_heater_at_its_set_point_heats_or_rests_but_never_cools() {
    let controlled = || Heater::Controlled { setpoint: 400.0, most: 2000.0, gain: 500.0 };
    let drag = Drag::new(10.0, 0.1, -0.7, -1.4, 0.01, Closure::Retained).unwrap();
    let drag = drag.with_temperature_law(TemperatureLaw::powers(400.0, -1.0, 2.0)).unwrap();
    let film = |heat: HeatBalance, speed: f64| -> Vec<f64> {
        let system = System::with_heat(train(), &drag, at_speed(speed), heat).unwrap();
        let start = Start::steady(&train(), &drag, speed).unwrap();
        let run = followed(&system, if speed > 0.0 { start } else { Start::REST }, 2.0).unwrap();
        run.temperature.iter().map(|t| t[0]).collect()
    };
    // friction warms it: as if there were none
    let warmed = film(bodies(400.0, 20.0, controlled()), 0.5);
    assert!(warmed[40] > 400.1, "{}", warmed[40]);
    for (a, b) in warmed.iter().zip(film(bodies(400.0, 20.0, unheated()), 0.5)) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    // losses cool it: it comes to rest where power and losses are equal
    let lossy =
        HeatBalance { loss: [2.0, 0.0], surroundings: 300.0, ..bodies(400.0, 20.0, controlled()) };
    let still = 400.0 - 200.0 / 502.0;
    for (i, t) in film(lossy, 0.0).iter().enumerate() {
        let time = 0.05 * f64::from(u8::try_from(i).unwrap());
        let exact = still + (400.0 - still) * (-502.0 / 20.0 * time).exp();
        assert!((t - exact).abs() < 1e-8, "{t} {exact}");
    }
}

fn power_law(rest: Rest) -> Drag {
    let law = TemperatureLaw { rest_slope: -4e-3, ..TemperatureLaw::powers(373.0, -1.0, 0.0) };
    let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
    drag.with_rest(rest).unwrap().with_temperature_law(law).unwrap()
}

/// The film is warmed by the contact alone, however the rest of the drive changes within a step.
#[test]
fn the_heat_of_the_contact_leaves_out_the_rest_as_it_is_when_warm() {
    let drag = power_law(Rest { force: 200.0, damping: 20.0 });
    let system =
        System::with_heat(train(), &drag, at_speed(1.5), bodies(373.0, 2.0, unheated())).unwrap();
    let warm = |tolerance: f64| {
        let start = Start { belt_speed: 1.5, stretch: 0.28 };
        let work = Work::default();
        let run =
            simulate(&system, start, 5.0, 11, tolerance, Integrator::Adaptive, &work).unwrap();
        run.temperature[10][0]
    };
    let (coarse, fine) = (warm(1e-7), warm(1e-12));
    assert!((coarse - fine).abs() < 1e-3, "{coarse} {fine}");
}

/// A belt without a rest of the drive has none whose change with temperature could end the law.
#[test]
fn a_rest_that_is_not_there_does_not_end_the_law() {
    assert!(power_law(Rest::default()).at(700.0).is_ok());
}

/// Nothing but warmth moves a belt that starts in balance.
#[test]
fn a_belt_in_balance_is_moved_by_the_warmth_of_its_friction() {
    let drag = power_law(Rest::default());
    let system =
        System::with_heat(train(), &drag, at_speed(1.5), bodies(373.0, 2.0, unheated())).unwrap();
    let start = Start::steady(&train(), &drag, 1.5).unwrap();
    let run = followed(&system, start, 0.1).unwrap();
    assert!(run.energy.residual().abs() < 1e-10, "{:e}", run.energy.residual());
}
