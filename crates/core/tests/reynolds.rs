//! Line contacts against limits and refinement.

use hersey_core::lubrication::reynolds::elasticity::{Kernel, layer_factor};
use hersey_core::lubrication::reynolds::{Fluid, Foundation, LineContact, Thickening};
use hersey_core::{Error, Work};

fn contact(contact_modulus: f64, entrainment_speed: f64) -> LineContact {
    LineContact {
        radius: 0.015,
        contact_modulus,
        foundation: Foundation::HalfSpace,
        load: 1000.0,
        entrainment_speed,
        sliding_speed: 2.0 * entrainment_speed,
        fluid: Fluid {
            viscosity: 0.1,
            pressure_viscosity: 0.0,
            thickening: Thickening::Barus,
            compressible: false,
        },
    }
}

#[test]
fn rigid_roll_is_martin() {
    let case = contact(1e14, 0.01);
    let film = case.solve(401, &Work::default()).expect("rigid").summary;
    let number = film.minimum * case.load / (case.fluid.viscosity * 0.01 * case.radius);
    assert!((number / 4.892 - 1.0).abs() < 2e-3, "{number}");
}

#[test]
fn least_film_converges_at_second_order() {
    let least =
        |nodes| contact(1e6, 0.1).solve(nodes, &Work::default()).expect("soft").summary.minimum;
    let films = [101, 201, 401].map(least);
    let order = ((films[1] - films[0]) / (films[2] - films[1])).log2();
    println!("order {order:.2}");
    assert!((order - 2.0).abs() < 0.35, "{order}");
}

#[test]
fn exponents_are_those_of_neighbouring_solutions() {
    let at = |factor: f64, load: f64| {
        let mut case = contact(1e6, 0.1 * factor);
        case.load *= load;
        case.solve(401, &Work::default()).expect("soft")
    };
    let (here, faster, heavier) = (at(1.0, 1.0), at(1.2, 1.0), at(1.0, 1.2));
    let slope = |a: f64, b: f64| (b / a).ln() / 1.2_f64.ln();
    let speed = slope(here.summary.central, faster.summary.central);
    let load = slope(here.summary.central, heavier.summary.central);
    assert!((here.by_speed.central - speed).abs() < 5e-3, "{speed}");
    assert!((here.by_load.central - load).abs() < 1e-2, "{load}");
}

/// Compliances of a layer at long and short waves: Winkler's, the incompressible one and that of a half space.
#[test]
fn layer_has_its_limits() {
    let kappa = 1e-3;
    let winkler = |nu: f64| 0.5 * kappa * (1.0 - 2.0 * nu) / ((1.0 - nu) * (1.0 - nu));
    for nu in [0.0, 0.3, 0.45] {
        assert!((layer_factor(kappa, nu) / winkler(nu) - 1.0).abs() < 1e-3, "{nu}");
    }
    let thin = 2.0 / 3.0 * kappa * kappa * kappa;
    assert!((layer_factor(kappa, 0.5) / thin - 1.0).abs() < 1e-4);
    assert!((layer_factor(20.0, 0.4) - 1.0).abs() < 1e-12);
}

/// A wave of pressure on many nodes is answered by the compliance it was made from.
#[test]
fn influence_answers_a_wave_with_its_compliance() {
    let (wave, poisson) = (1.3_f64, 0.47);
    let kernel = Kernel::new(Foundation::Layer { thickness: 1.0, poisson });
    let nodes: Vec<f64> = (0..=1600_u32).map(|i| f64::from(i) * 0.05 - 40.0).collect();
    let influence = kernel.influence(&nodes, &Work::default()).unwrap();
    let deflection: f64 =
        nodes.iter().zip(influence.hats.row(800)).map(|(x, hat)| hat * (wave * x).cos()).sum();
    let expected = std::f64::consts::PI * layer_factor(wave, poisson) / wave;
    assert!((deflection / expected - 1.0).abs() < 2e-3, "{deflection} for {expected}");
}

#[test]
fn what_cannot_be_solved_says_so() {
    assert!(matches!(
        LineContact { load: -1.0, ..contact(1e6, 0.1) }.solve(101, &Work::default()),
        Err(Error::TooSmall { quantity: "load", .. })
    ));
    assert!(matches!(
        contact(1e6, 0.1).solve(3, &Work::default()),
        Err(Error::TooSmall { quantity: "nodes", .. })
    ));
    let wide = Foundation::Layer { thickness: 1e-3, poisson: 0.6 };
    assert!(matches!(
        LineContact { foundation: wide, ..contact(1e6, 0.1) }.solve(101, &Work::default()),
        Err(Error::TooLarge { quantity: "poisson", .. })
    ));
}
