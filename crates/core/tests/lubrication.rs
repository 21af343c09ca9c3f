//! Limits and invariants of the contact and of the film laws.

use std::f64::consts::PI;

use hersey_core::Error;
use hersey_core::lubrication::contact::{
    Solid, effective_modulus, hertz_line, hertz_point, reduced_radius, shore_a_modulus,
};
use hersey_core::lubrication::correction::{inlet_heating, shear_thinning, starvation};
use hersey_core::lubrication::film::{LineContact, Regime, layer_factor};
use hersey_core::lubrication::layer::{HALF_WIDTH_MAX, LayerContact, nip};
use hersey_core::lubrication::paper::Nip;
use hersey_core::lubrication::traction::{Edge, soft_traction};
use hersey_core::lubrication::viscosity::{Carreau, TemperatureLaw, at_pressure};
use proptest::prelude::*;

fn close(value: f64, reference: f64, tolerance: f64) {
    assert!((value / reference - 1.0).abs() <= tolerance, "{value} is not {reference}");
}

/// Value at infinite width of a series in t/a, from widths that double.
fn extrapolated(values: [f64; 4]) -> f64 {
    let [a, b, c, d] = values;
    let (ab, bc, cd) = (2.0 * b - a, 2.0 * c - b, 2.0 * d - c);
    let (abc, bcd) = ((4.0 * bc - ab) / 3.0, (4.0 * cd - bc) / 3.0);
    (8.0 * bcd - abc) / 7.0
}

#[test]
fn a_thick_layer_is_a_half_space() {
    for nu in [0.0, 0.3, 0.49, 0.5] {
        let contact = LayerContact::of_width(0.02, nu).unwrap();
        close(contact.load, PI / 4.0 * 0.02 * 0.02, 1e-3);
        close(contact.edge, 1.0, 1e-3);
        close(contact.pressure(0.5), 0.75_f64.sqrt(), 1e-3);
    }
}

#[test]
fn a_thin_compressible_layer_is_a_bed_of_springs() {
    for nu in [0.0, 0.2, 0.3] {
        let ratio = |width: f64| {
            let law = 2.0 / 3.0 * width.powi(3) * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
            LayerContact::of_width(width, nu).unwrap().load * (1.0 / (1.0 - nu * nu)) / law
        };
        close(extrapolated([5.0, 10.0, 20.0, 40.0].map(ratio)), 1.0, 1e-3);
    }
}

#[test]
fn a_thin_incompressible_layer_flows() {
    // w = 2 G a^5/(15 R t^3), G = E/3, E* = 4E/3.
    let ratio = |width: f64| {
        LayerContact::of_width(width, 0.5).unwrap().load * (4.0 / 3.0)
            / (2.0 / 45.0 * width.powi(5))
    };
    close(extrapolated([5.0, 10.0, 20.0, 40.0].map(ratio)), 1.0, 1e-3);
}

#[test]
fn pressure_carries_the_load() {
    for (width, nu) in [(0.1, 0.3), (1.0, 0.5), (5.0, 0.49), (20.0, 0.5)] {
        let contact = LayerContact::of_width(width, nu).unwrap();
        let panels = 4000;
        let sum: f64 = (0..panels)
            .map(|i| {
                let angle = PI * (f64::from(i) + 0.5) / f64::from(panels);
                contact.pressure(angle.cos()) * angle.sin()
            })
            .sum();
        // W = w R/(E* t^2) = (a/t)^2/2 times the integral of p over P.
        close(sum * PI / f64::from(panels) * width * width / 2.0, contact.load, 1e-6);
        close(contact.pressure(0.0), contact.centre_pressure, 1e-12);
    }
}

#[test]
fn load_gives_the_width_that_gave_it() {
    for nu in [0.0, 0.45, 0.5] {
        for width in [1e-4, 0.3, 2.0, 12.0, 39.0] {
            let contact = LayerContact::of_width(width, nu).unwrap();
            close(LayerContact::of_load(contact.load, nu).unwrap().half_width, width, 1e-9);
        }
        assert!(LayerContact::of_load(1e12, nu).is_err());
    }
}

#[test]
fn the_paper_chain_composes() {
    let nip = Nip {
        pressure_viscosity: 2e-8,
        viscosity: 0.1,
        speed: 0.1,
        load: 250.0,
        length: 0.22,
        thickness: 3.5e-3,
        radius: 15e-3,
        modulus: 2.0e6 / (1.0 - 0.48 * 0.48),
    };
    let nip = nip.checked().unwrap();
    close(nip.torque(), nip.torque_in_full(), 1e-3);
    close(nip.damping() * nip.speed, nip.torque_in_full(), 1e-12);
    close(nip.nip_width(), 5.7e-3, 0.01);
}

#[test]
fn the_rigid_constants_follow_from_reynolds() {
    // Rigid cylinder with Reynolds' exit: x = sqrt(2 R h) tan(t), p' = cos^2 - cos^4/cos^2(exit).
    let steps = 200_000;
    let (start, step) = (-PI / 2.0, 1e-5);
    let pressure = |exit: f64| {
        let (mut p, mut most, mut load, mut t) = (0.0, 0.0_f64, 0.0, start);
        for _ in 0..steps {
            let middle = t + 0.5 * step;
            let c = middle.cos().powi(2);
            p += step * (c - c * c / exit.cos().powi(2));
            t += step;
            most = most.max(p);
            load += step * p / t.cos().powi(2);
            if t >= exit {
                break;
            }
        }
        (p, most, load)
    };
    let (mut low, mut high) = (0.3, 0.6);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if pressure(middle).0 > 0.0 { low = middle } else { high = middle }
    }
    let (_, most, load) = pressure(low);
    let contact = LineContact {
        pressure_viscosity: 2e-8,
        viscosity: 0.05,
        speed: 2.0,
        load: 1e3,
        radius: 0.01,
        modulus: 2e11,
    };
    let film = contact.film(1.0).unwrap();
    let martin = 24.0 * load * contact.viscosity * contact.speed * contact.radius / contact.load;
    close(film.minimum[0], martin, 2e-3);
    let group = contact.pressure_viscosity * contact.viscosity * contact.speed / contact.radius;
    let blok = (12.0 * 2.0_f64.sqrt() * most * group).powf(2.0 / 3.0) * contact.radius;
    close(film.minimum[1], blok, 5e-3);
}

#[test]
fn the_hard_central_film_agrees_with_ertel() {
    // Ertel and Grubin: the inlet of a Hertz gap raises the reduced pressure to 1/alpha at the edge.
    for (u, g, w) in [(1e-11, 5000.0, 1e-4), (1e-12, 4000.0, 5e-5), (5e-12, 3000.0, 2e-4)] {
        let modulus = 2e11;
        let (radius, viscosity) = (0.01, 0.1);
        let contact = LineContact {
            pressure_viscosity: g / modulus,
            viscosity,
            speed: u * modulus * radius / viscosity,
            load: w * modulus * radius,
            radius,
            modulus,
        };
        let a = hertz_line(contact.load, radius, modulus).unwrap().half_width;
        let reduced = |h: f64| {
            let (mut sum, ratio) = (0.0, 1.002_f64);
            let mut x = 1e-7;
            while x < 50.0 {
                let next = x * ratio;
                let s: f64 = 1.0 + 0.5 * (x + next);
                let root = (s * s - 1.0).sqrt();
                let gap = a * a / (2.0 * radius) * (s * root - (s + root).ln());
                sum += (next - x) * a * gap / (gap + h).powi(3);
                x = next;
            }
            12.0 * viscosity * contact.speed * sum
        };
        let (mut low, mut high) = (1e-12_f64, 1e-3_f64);
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            if reduced(middle) > 1.0 / contact.pressure_viscosity {
                low = middle;
            } else {
                high = middle;
            }
        }
        let film = contact.film(1.0).unwrap();
        assert_eq!(film.regime, Regime::PiezoviscousElastic);
        close(film.central[3], low, 0.25);
        assert!(film.central[3] > film.minimum[3]);
    }
}

#[test]
fn each_regime_has_its_corner() {
    let film = |alpha: f64, modulus: f64, load: f64| {
        LineContact {
            pressure_viscosity: alpha,
            viscosity: 0.1,
            speed: 1.0,
            load,
            radius: 0.01,
            modulus,
        }
        .film(1.0)
        .unwrap()
    };
    assert_eq!(film(0.0, 1e14, 1e2).regime, Regime::IsoviscousRigid);
    assert_eq!(film(2e-8, 1e14, 1e5).regime, Regime::PiezoviscousRigid);
    assert_eq!(film(2e-8, 1e6, 1e3).regime, Regime::IsoviscousElastic);
    assert_eq!(film(2e-8, 2e11, 1e5).regime, Regime::PiezoviscousElastic);
    let stiff = film(2e-8, 1e17, 1e5);
    assert_eq!(stiff.regime, Regime::PiezoviscousRigid);
}

#[test]
fn exponents_are_those_of_the_regimes() {
    let contact = |speed: f64| LineContact {
        pressure_viscosity: 2e-8,
        viscosity: 0.05,
        speed,
        load: 1e4,
        radius: 0.01,
        modulus: 2e11,
    };
    let (slow, fast) = (contact(1.0).film(1.0).unwrap(), contact(1.01).film(1.0).unwrap());
    for (i, regime) in Regime::ALL.into_iter().enumerate() {
        let exponent = (fast.minimum[i] / slow.minimum[i]).ln() / 1.01_f64.ln();
        assert!((exponent - regime.speed_exponent()).abs() < 1e-9, "{regime:?}");
    }
    close(layer_factor(1.0, 1.0), 1.0, 0.0);
}

#[test]
fn corrections_have_their_limits() {
    close(starvation(1e-3, 1e-6, 3.0).unwrap().factor, 1.0, 1e-6);
    close(starvation(1e-9, 1e-6, 3.0).unwrap().factor, 1e-3, 1e-6);
    close(inlet_heating(0.1, 0.03, 0.0, 0.14, 0.0).unwrap().factor, 1.0, 0.0);
    assert!(!inlet_heating(1.0, 0.03, 10.0, 0.14, 2.0).unwrap().valid);
    close(shear_thinning(1e-6, 1.0, 0.6, Carreau::NONE).unwrap().factor, 1.0, 1e-12);
    // Deep in the power law h = h_0 (lambda U/h)^(n (m-1)) is explicit.
    let thin = shear_thinning(1e-6, 1.0, 0.6, Carreau::new(1.0, 0.5, 0.0).unwrap()).unwrap();
    close(thin.factor, (1e6_f64).powf(-0.3 / (1.0 - 0.3)), 1e-6);
    assert!(!thin.valid);
}

#[test]
fn viscosity_laws_pass_through_their_points() {
    let points = [(303.15, 0.153), (333.15, 0.034), (373.15, 0.0091)];
    let vogel = TemperatureLaw::vogel(points).unwrap();
    for (t, eta) in points {
        close(vogel.viscosity(t).unwrap(), eta, 1e-10);
    }
    let arrhenius = TemperatureLaw::arrhenius([points[0], points[2]]).unwrap();
    close(arrhenius.viscosity(373.15).unwrap(), 0.0091, 1e-12);
    let kinematic = [(313.15, 1e-4), (373.15, 3e-7)];
    let walther = TemperatureLaw::walther(kinematic, 900.0).unwrap();
    for (t, nu) in kinematic {
        close(walther.viscosity(t).unwrap(), 900.0 * nu, 1e-9);
    }
    for law in [vogel, arrhenius, walther] {
        let step = 1e-4;
        let (up, down) = (
            law.viscosity(340.0 * (1.0 + step)).unwrap(),
            law.viscosity(340.0 * (1.0 - step)).unwrap(),
        );
        let numeric = (up / down).ln() / ((1.0 + step) / (1.0 - step)).ln();
        close(law.temperature_exponent(340.0).unwrap(), numeric, 1e-5);
    }
    assert!(TemperatureLaw::vogel([(300.0, 1.0), (350.0, 0.5), (400.0, 0.01)]).is_err());
    assert!(TemperatureLaw::arrhenius([(300.0, 1.0), (350.0, 2.0)]).is_err());
}

#[test]
fn points_of_a_viscosity_ascend_in_temperature_and_fall_in_viscosity() {
    let quantity =
        |points: [(f64, f64); 3]| TemperatureLaw::vogel(points).unwrap_err().quantity().unwrap();
    let sequence = "sequence of temperatures of the viscosities";
    let fall = "viscosity at the higher temperature";
    assert_eq!(quantity([(300.0, 3.0), (300.0, 2.0), (400.0, 1.0)]), sequence);
    assert_eq!(quantity([(300.0, 3.0), (350.0, 2.0), (340.0, 1.0)]), sequence);
    assert_eq!(quantity([(300.0, 3.0), (350.0, 3.0), (400.0, 1.0)]), fall);
    assert_eq!(quantity([(300.0, 3.0), (350.0, 2.0), (400.0, 2.5)]), fall);
    assert_eq!(quantity([(0.0, 3.0), (350.0, 2.0), (400.0, 1.0)]), "temperature of a viscosity");
    assert_eq!(quantity([(300.0, 3.0), (350.0, 2.0), (400.0, 0.0)]), "viscosity");
    // the first may be anything, and the index is that of the one that goes back
    let back = TemperatureLaw::arrhenius([(300.0, 2.0), (290.0, 1.0)]).unwrap_err();
    assert!(matches!(back, Error::Backwards { index: 1, value, .. } if value < 290.5));
    let kinematic = |low| TemperatureLaw::walther([(313.15, 1e-5), (373.15, low)], 900.0);
    assert!(kinematic(0.211e-6).is_ok() && kinematic(0.209e-6).is_err());
    let vogel = TemperatureLaw::Vogel { prefactor: 1e-4, slope: 900.0, zero: 180.0 };
    assert!(vogel.viscosity(180.0).is_err() && vogel.viscosity(190.0).is_ok());
    assert!(vogel.temperature_exponent(180.0).is_err());
}

#[test]
fn ranges_are_closed_where_they_say_so() {
    let share = |exponent, limit| Carreau::new(0.0, exponent, limit);
    assert!(share(1.0, 0.0).is_ok() && share(1.0, 1.0).is_ok() && share(0.0, 0.5).is_err());
    assert!(share(0.5, -0.1).is_err() && share(0.5, 1.1).is_err() && share(1.1, 0.5).is_err());
    assert!(at_pressure(1.0, 0.0, 0.0).is_ok() && at_pressure(1.0, -1.0, 0.0).is_err());
    assert!(starvation(1.0, 1.0, 2.0).is_ok() && starvation(1.0, 1.0, 5.0).is_ok());
    assert!(starvation(1.0, 1.0, 1.9).is_err() && starvation(1.0, 1.0, 5.1).is_err());
    assert!(shear_thinning(1.0, 0.0, 1.0, Carreau::NONE).is_ok());
    assert!(shear_thinning(1.0, 0.0, 1.1, Carreau::NONE).is_err());
    // viscosity at just half counts as too little
    let half = Carreau::new(1.0, 0.1, 0.5).unwrap();
    let thinned = shear_thinning(1e-6, 1e100, 0.5, half).unwrap();
    assert!(half.share(1e100).to_bits() == 0.5_f64.to_bits() && !thinned.valid);
    let rubber = |poisson_ratio| Solid { modulus: 1e6, poisson_ratio };
    assert!(effective_modulus(rubber(0.0), rubber(0.5)).is_ok());
    assert!(effective_modulus(rubber(-0.01), rubber(0.5)).is_err());
    assert!(effective_modulus(rubber(0.0), rubber(0.51)).is_err());
    let rigid = Solid { modulus: f64::INFINITY, poisson_ratio: 0.3 };
    assert!(effective_modulus(rigid, rigid).is_err());
    assert!(shore_a_modulus(20.0).is_ok() && shore_a_modulus(80.0).is_ok());
    assert!(shore_a_modulus(19.9).is_err() && shore_a_modulus(80.1).is_err());
    assert!(reduced_radius(0.01, -0.01).is_err() && reduced_radius(0.01, -0.005).is_err());
    for bad in [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1.0, f64::INFINITY, 1.0)] {
        assert!(
            hertz_line(bad.0, bad.1, bad.2).is_err() && hertz_point(bad.0, bad.1, bad.2).is_err()
        );
    }
    assert!(LayerContact::of_width(HALF_WIDTH_MAX, 0.3).is_ok());
    assert!(LayerContact::of_width(HALF_WIDTH_MAX * 1.01, 0.3).is_err());
    assert!(
        LayerContact::of_width(0.0, 0.3).is_err() && LayerContact::of_width(1.0, 0.51).is_err()
    );
    let edge = LayerContact::of_width(2.0, 0.3).unwrap();
    assert!(edge.pressure(1.0).abs() < f64::MIN_POSITIVE && edge.pressure(-1.5).abs() < 1e-300);
    assert!(edge.pressure(0.99) > 0.0 && (edge.pressure(0.3) - edge.pressure(-0.3)).abs() < 1e-12);
}

#[test]
fn a_nip_on_a_thick_layer_is_that_of_hertz() {
    let rubber = Solid { modulus: 2e6, poisson_ratio: 0.45 };
    let rigid = Solid { modulus: f64::INFINITY, poisson_ratio: 0.5 };
    let hertz = hertz_line(1000.0, 0.015, effective_modulus(rubber, rigid).unwrap()).unwrap();
    let thick = nip(1000.0, 0.015, 1.0, rubber).unwrap();
    close(thick.width, 2.0 * hertz.half_width, 1e-3);
    close(thick.pressure_max, hertz.pressure_max, 1e-3);
    close(thick.width_over_hertz, 1.0, 1e-3);
    // on 3 mm the same roll makes the nip of the scaled contact
    let thin = nip(1000.0, 0.015, 3e-3, rubber).unwrap();
    let star = 2e6 / (1.0 - 0.45 * 0.45);
    let scaled = LayerContact::of_width(0.5 * thin.width / 3e-3, 0.45).unwrap();
    close(scaled.load * star * 9e-6 / 0.015, 1000.0, 1e-9);
    close(thin.pressure_max, scaled.pressure(0.0) * star * 0.5 * thin.width / 0.03, 1e-9);
    close(thin.width_over_hertz, 0.5 * thin.width / hertz.half_width, 1e-12);
    close(thin.edge, scaled.edge, 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_passed_nothing_panics_and_answers_are_numbers(
        values in prop::array::uniform7(prop_oneof![
            Just(0.0), Just(f64::NAN), Just(f64::INFINITY), Just(-1.0), Just(1e300), Just(1e-300),
            1e-12..1e12f64,
        ]),
    ) {
        let [pressure_viscosity, viscosity, speed, load, radius, modulus, x] = values;
        let contact = LineContact { pressure_viscosity, viscosity, speed, load, radius, modulus };
        if let Ok(film) = contact.film(x) {
            prop_assert!(film.minimum.iter().all(|h| h.is_finite()));
        }
        if let Ok(found) = LayerContact::of_width(x, viscosity) {
            prop_assert!(found.load.is_finite() && found.edge.is_finite());
        }
        if let Ok(found) = LayerContact::of_load(load.min(1e3), 0.5) {
            prop_assert!(found.half_width.is_finite());
        }
        let solid = |modulus| Solid { modulus, poisson_ratio: 0.3 };
        if let Ok(found) = effective_modulus(solid(modulus), solid(load)) {
            prop_assert!(found > 0.0);
        }
        if let Ok(law) = TemperatureLaw::walther([(speed, load), (radius, modulus)], viscosity) {
            let _ = law.viscosity(x);
        }
        if let Ok(law) = TemperatureLaw::vogel([(speed, load), (radius, modulus), (viscosity, x)]) {
            let _ = law.viscosity(x);
        }
    }
}

#[test]
fn a_soft_film_takes_shear_and_rolling() {
    let contact = |viscosity| LineContact {
        pressure_viscosity: 0.0,
        viscosity,
        speed: 0.1,
        load: 1000.0,
        radius: 0.015,
        modulus: 2e6,
    };
    let edge = Edge { slope: 1.0, curvature: -0.25, half_width: 3e-3, thickness: 1.0 };
    let at = |viscosity| soft_traction(&contact(viscosity), edge).unwrap();
    // A short inlet leaves eta U 2a/h_c, and a logarithm of its length with the factor that the film gives.
    assert!((at(1e-9).shear_factor - 1.0).abs() < 1e-4);
    let scaled = |viscosity: f64| at(viscosity).rolling / viscosity.powf(0.8);
    let film = 3.78 / (4.0 * PI).powf(0.2);
    let scale = 0.1_f64.powf(0.8) * 1e6_f64.powf(0.6);
    let k = 0.5 * 1e6 / 0.015 * 6e-3_f64.sqrt();
    let step = (scaled(1e-14) - scaled(1e-13)) / (scale * k.powf(-0.4)) / (0.4 * 10.0_f64.ln());
    close(step, film.powi(3) / 48.0, 1e-3);
    // Wider than any layer that was solved, and longer than any inlet: finite and positive.
    for curvature in [-0.25, 2.0, 50.0] {
        for viscosity in [1e-12, 1e-3, 1e6] {
            let thin = Edge { curvature, thickness: 1e-4, ..edge };
            let force = soft_traction(&contact(viscosity), thin).unwrap();
            assert!(force.shear_factor >= 1.0 && force.rolling > 0.0);
        }
    }
    assert!(soft_traction(&contact(0.0), edge).is_err());
    assert!(soft_traction(&contact(0.1), Edge { slope: f64::NAN, ..edge }).is_err());
}
