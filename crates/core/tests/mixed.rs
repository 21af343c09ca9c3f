//! Mixed lubrication: independent numbers, limits and what must hold for every contact.

use hersey_core::Error;
use hersey_core::lubrication::mixed::{MixedLaw, Shared, Sharing, asperity_integral};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn close(value: f64, reference: f64, tolerance: f64) {
    assert!((value / reference - 1.0).abs() <= tolerance, "{value} is not {reference}");
}

#[path = "common/sharing.rs"]
mod sharing;

use sharing::{SHARING, SOFT};

/// (lambda, F, F') with 30 digits from parabolic cylinder functions:
/// `F = Gamma(7/2)/sqrt(2 pi) exp(-lambda^2/4) D_(-7/2)(lambda)`; checked there against the integral.
const INTEGRAL: [(f64, f64, f64); 8] = [
    (0.0, 0.616_634_218_996_843_9, -1.075_049_984_155_649),
    (0.5, 0.240_401_570_674_072_1, -0.488_009_009_359_476_6),
    (1.0, 0.080_562_335_570_811_47, -0.189_170_443_477_437_7),
    (2.0, 5.423_705_197_484_414e-3, -1.662_044_405_896_773e-2),
    (3.0, 1.708_729_962_144_244e-4, -6.599_188_856_736_682e-4),
    (4.0, 2.353_381_052_587_606e-6, -1.109_788_989_634_813e-5),
    (6.0, 3.142_968_531_919_884e-11, -2.050_895_147_453_791e-10),
    (10.0, 7.501_244_003_924_727e-26, -7.753_016_271_682_923e-25),
];

#[test]
fn the_integral_has_its_values() {
    for (lambda, value, slope) in INTEGRAL {
        let (found, fall) = asperity_integral(lambda);
        close(found, value, 4e-15);
        close(fall, slope, 4e-15);
    }
    assert_eq!(asperity_integral(1e9), asperity_integral(f64::INFINITY));
    assert!(asperity_integral(39.0).0 < 1e-300 && asperity_integral(f64::NAN).0.is_nan());
}

/// `F'' + lambda F' - 5/2 F = 0`, F'' by differences of the derivative.
#[test]
fn the_integral_solves_its_equation() {
    let step = 1e-3;
    for i in 1..400 {
        let lambda = 0.02 * f64::from(i);
        let at = |e: f64| asperity_integral(lambda + e * step).1;
        let second = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
        let (value, slope) = asperity_integral(lambda);
        close(second, 2.5 * value - lambda * slope, 1e-9);
    }
}

/// (X, lambda, force, slope) of `SHARING` from bisection with 40 digits.
#[test]
fn the_law_has_its_values() {
    let law = MixedLaw::new(SHARING).unwrap();
    for (x, lambda, force, slope) in [
        (0.01, 2.517_834_812_838_834, 30.003_971_370_018_43, 19.853_886_105_800_6),
        (0.5, 2.518_190_854_600_228, 30.161_603_757_800_43, 8.774_379_848_970_82),
        (2.0, 2.540_437_641_109_198, 28.530_592_264_845_78, -142.449_954_693_505),
        (5.0, 2.835_884_560_189_757, 11.497_050_283_243_78, -288.746_957_977_315),
        (20.0, 6.034_176_366_877_053, 3.917_872_373_170_249, 4.219_537_567_438_49),
    ] {
        let product = x * SHARING.reference;
        let (found, rise) = law.force_and_slope(product);
        close(law.lambda(product), lambda, 1e-14);
        close(found, force, 1e-14);
        close(rise, slope, 1e-13);
    }
    let rest = law.at(0.0);
    close(rest.force(), 30.0, 1e-14);
    close(rest.share, 1.0, 1e-14);
    close(rest.lambda, law.dry_lambda(), 1e-14);
}

/// The transition of `SHARING` from the same, and its shift with each number from 1e-4 of it.
#[test]
fn the_transition_has_its_values() {
    let found = MixedLaw::new(SHARING).unwrap().transition().unwrap();
    close(found.product, 0.192_131_378_887_635_7, 1e-13);
    close(found.force, 2.975_326_107_221_792, 1e-13);
    close(found.lambda, 3.889_413_929_043_982, 1e-13);
    let known = [
        (0, 1.0),
        (1, -1.823_451_688_19),
        (2, -0.004_317_498_106_51),
        (5, 0.098_114_328_396_7),
        (6, 0.103_714_275_177),
        (7, -0.083_211_643_634_5),
        (8, -0.020_502_631_241_3),
        (9, -0.046_990_739_151_3),
    ];
    for (number, shift) in known {
        close(found.sensitivity[number], shift, 1e-7);
    }
    // Forces of one scale move the transition nowhere.
    assert!(found.sensitivity[6..9].iter().sum::<f64>().abs() < 1e-10);
}

/// (X, lambda, least film, share, force, slope) of `SOFT` from bisection with 40 digits: common/sharing.py.
#[test]
#[allow(clippy::excessive_precision)]
fn the_soft_law_has_its_values() {
    let law = MixedLaw::new(SOFT).unwrap();
    for (x, lambda, minimum, share, force, slope) in [
        (
            0.001,
            1.077_255_914_361_229_6,
            1.028_794_366_071_08,
            0.999_999_847_253_318_8,
            30.000_923_702_190_232,
            45.799_320_559_941_137,
        ),
        (
            0.1,
            1.107_843_283_246_655_8,
            1.056_998_607_032_981_8,
            0.971_168_581_481_760_59,
            29.225_779_866_472_667,
            -953.407_443_930_055_66,
        ),
        (
            2.0,
            1.796_153_986_408_636_4,
            1.647_555_465_973_112_3,
            0.194_194_820_516_067_47,
            7.079_633_723_140_853_7,
            -173.341_497_336_427_63,
        ),
        (
            5.0,
            2.633_351_367_604_307,
            2.192_378_704_999_184,
            0.013_302_385_072_097_641,
            2.655_361_908_816_689_4,
            -10.468_490_701_383_477,
        ),
        (
            10.0,
            3.981_074_055_578_399_9,
            3.146_826_321_664_501_5,
            5.145_314_361_490_328_1e-5,
            3.144_353_422_783_075,
            7.462_784_464_329_727,
        ),
        (
            40.0,
            9.146_101_038_546_526_9,
            7.225_419_820_451_756_3,
            7.176_260_916_303_175_8e-21,
            6.286_153_295_353_186_2,
            4.099_429_147_466_630_1,
        ),
    ] {
        let product = x * SOFT.reference;
        let found = law.at(product);
        close(found.lambda, lambda, 1e-14);
        close(found.minimum, minimum, 1e-14);
        close(found.share, share, 2e-13);
        close(found.force(), force, 1e-14);
        close(found.slope, slope, 1e-13);
    }
    let rest = law.at(0.0);
    close(rest.force(), 30.0, 1e-14);
    close(rest.share, 1.0, 1e-14);
    close(rest.lambda, law.dry_lambda(), 1e-14);
}

/// The transition of `SOFT` from the same.
#[test]
fn the_soft_transition_has_its_values() {
    let found = MixedLaw::new(SOFT).unwrap().transition().unwrap();
    close(found.product, 0.114_228_876_064_948_06, 1e-13);
    close(found.lambda, 2.846_977_192_941_223, 1e-13);
    close(found.force, 2.589_974_561_365_868, 1e-13);
    let forces: f64 = found.sensitivity[6..9].iter().sum();
    assert!(forces.abs() < 1e-10, "{forces}");
}

/// With a film that asperities set alone, of steepness n, `lambda^2` goes as `eta v` times their pressure.
#[test]
fn asperities_that_set_the_film_make_it_a_square_root() {
    let law = MixedLaw::new(Sharing { edge: 1e6, stiffness: 1e4, ..SOFT }).unwrap();
    let (one, other) = (law.at(0.003 * SOFT.reference), law.at(0.03 * SOFT.reference));
    assert!(one.share < 0.1 && other.share < 0.01, "{} {}", one.share, other.share);
    let pressing = |lambda: f64| {
        let (value, slope) = asperity_integral(lambda);
        value / (2.84 - lambda * slope / value)
    };
    let pressed = pressing(other.lambda) / pressing(one.lambda);
    close((other.lambda / one.lambda).powi(2), 10.0 * pressed, 0.02);
}

#[test]
fn a_force_that_never_falls_has_no_transition() {
    for changed in [
        Sharing { boundary: 0.1, ..SHARING },
        // An isoviscous-rigid film is sheared alike at every speed.
        Sharing { film_exponent: 1.0, load_exponent: 1.0, rolling: 0.0, ..SHARING },
    ] {
        assert_eq!(MixedLaw::new(changed).unwrap().transition(), None);
    }
}

#[test]
fn impossible_numbers_are_refused() {
    let nan = f64::NAN;
    for (bad, quantity) in [
        (Sharing { reference: 0.0, ..SHARING }, "reference of the film"),
        (Sharing { film_exponent: 0.05, ..SHARING }, "film exponent"),
        (Sharing { film_exponent: 1.1, ..SHARING }, "film exponent"),
        (Sharing { load_exponent: 0.7, ..SHARING }, "load exponent"),
        (Sharing { load_exponent: 0.0, ..SHARING }, "load exponent"),
        (Sharing { edge: -1.0, ..SOFT }, "edge"),
        (Sharing { edge: nan, ..SOFT }, "edge"),
        (Sharing { roundness: 0.0, ..SOFT }, "roundness"),
        (Sharing { roundness: 1.01, ..SOFT }, "roundness"),
        (Sharing { stiffness: 1.62, ..SHARING }, "stiffness of the asperities"),
        // p_max/p_mean of this roundness is 1.341: asperities carry all at 2.175.
        (Sharing { stiffness: 2.17, ..SOFT }, "stiffness of the asperities"),
        (Sharing { stiffness: 1e31, ..SHARING }, "stiffness of the asperities"),
        (Sharing { boundary: -1.0, ..SHARING }, "boundary force"),
        (Sharing { shear: nan, ..SHARING }, "shear force"),
        (Sharing { rolling: -1.0, ..SHARING }, "rolling force"),
        (Sharing { rolling_exponent: 2.1, ..SHARING }, "rolling exponent"),
        (Sharing { boundary: f64::MAX, shear: f64::MAX, ..SHARING }, "force"),
    ] {
        let error: Error = MixedLaw::new(bad).unwrap_err();
        assert_eq!(error.quantity(), Some(quantity), "{bad:?}");
    }
}

fn sharing() -> impl Strategy<Value = Sharing> {
    (
        -4.0..1.0_f64,
        0.1..1.0_f64,
        0.02..1.0_f64,
        0.22..8.0_f64,
        -2.0..3.0_f64,
        -3.0..2.0_f64,
        0.0..1.0_f64,
        0.0..2.0_f64,
        prop_oneof![Just(None), (0.0..3.0_f64, 0.05..1.0_f64).prop_map(Some)],
    )
        .prop_map(|(x, n, b, s, boundary, shear, rolling, rolling_exponent, soft)| Sharing {
            reference: 10_f64.powf(x),
            film_exponent: n,
            load_exponent: (b * n).max(0.01),
            edge: soft.map_or(0.0, |(edge, _)| 10_f64.powf(edge)),
            roundness: soft.map_or(1.0, |(_, roundness)| roundness),
            stiffness: 10_f64.powf(s + 0.2),
            boundary: 10_f64.powf(boundary),
            shear: 10_f64.powf(shear),
            rolling,
            rolling_exponent,
        })
}

/// Lambda of the soft law from a lambda, and the share there, as docs/theory/mixed.md writes them.
fn soft_law(law: &Sharing, lambda: f64, x: f64) -> (f64, f64) {
    let (integral, slope) = asperity_integral(lambda);
    let k = law.roundness;
    let most = 1.5 - (1.5 - 4.0 / std::f64::consts::PI) * k;
    let pressure = (law.stiffness * integral / most).min(1.0);
    let v =
        2.0 * pressure * pressure / ((k * k + 4.0 * (1.0 - k) * pressure * pressure).sqrt() + k);
    let finite = (1.0 - v).sqrt() * (k + 2.0 * (1.0 - k) * v) / k;
    let a = law.edge * law.stiffness * integral * x.powf(-law.film_exponent / 3.0);
    let thicker = 3.89 * a / (finite * (2.84 - lambda * slope / integral));
    let raised = (1.0 + thicker.powf(1.34)).powf(0.5 / 1.34);
    (x.powf(law.film_exponent) * raised, 1.0 - (1.0 - pressure).powf(most))
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 256,
        rng_seed: RngSeed::Fixed(20151),
        failure_persistence: None,
        ..Default::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn film_and_asperities_carry_the_load(sharing in sharing(), x in -3.0..4.0_f64) {
        let law = MixedLaw::new(sharing).unwrap();
        let x = 10_f64.powf(x);
        let Shared { lambda, share, .. } = law.at(x * sharing.reference);
        let free = x.powf(sharing.film_exponent);
        let floor = free.max(law.dry_lambda());
        prop_assert!(lambda >= floor - 1e-14 * (1.0 + floor));
        if sharing.edge > 0.0 {
            if share < 0.99 && lambda < 25.0 {
                let (again, carried) = soft_law(&sharing, lambda, x);
                prop_assert!((again / lambda - 1.0).abs() < 1e-11, "{again} {lambda}");
                prop_assert!((carried - share).abs() < 1e-12, "{carried} {share}");
            }
        } else {
            let film = (free / lambda).powf(1.0 / sharing.load_exponent);
            prop_assert!((share + film - 1.0).abs() < 1e-13, "{share} {film}");
        }
        prop_assert!((share - law.share(x * sharing.reference)).abs() < 1e-15);
    }

    #[test]
    fn film_grows_and_asperities_let_go_as_speed_grows(sharing in sharing(), x in -3.0..4.0_f64) {
        let law = MixedLaw::new(sharing).unwrap();
        let x = 10_f64.powf(x) * sharing.reference;
        let (slow, fast) = (law.at(x), law.at(1.001 * x));
        prop_assert!(fast.lambda >= slow.lambda * (1.0 - 1e-15));
        prop_assert!(fast.share <= slow.share + 1e-13);
    }

    #[test]
    fn the_slope_is_that_of_the_force(sharing in sharing(), x in -2.0..3.0_f64) {
        let law = MixedLaw::new(sharing).unwrap();
        let x = 10_f64.powf(x) * sharing.reference;
        let step = 1e-4 * x;
        let at = |e: f64| law.force(x + e * step);
        let difference =
            (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
        let (force, slope) = law.force_and_slope(x);
        let scale = (force / x).abs() + slope.abs();
        prop_assert!((slope - difference).abs() < 1e-8 * scale, "{slope} {difference}");
        let at = |e: f64| {
            let changed = Sharing { edge: sharing.edge * (1.0 + 1e-4 * e), ..sharing };
            MixedLaw::new(changed).unwrap().force(x)
        };
        let difference = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-4;
        prop_assert!((law.at(x).by_edge - difference).abs() < 1e-8 * force, "{difference}");
    }

    #[test]
    fn a_thick_film_is_alone(sharing in sharing(), x in 5.0..40.0_f64) {
        // Asperities that a nip of rubber or steel can have, and boundary friction up to 300 times the film's.
        let sharing = Sharing {
            stiffness: sharing.stiffness.min(1e4),
            boundary: sharing.boundary.min(300.0 * sharing.shear),
            ..sharing
        };
        let law = MixedLaw::new(sharing).unwrap();
        let x = x.powf(1.0 / sharing.film_exponent);
        let shear = sharing.shear * x.powf(1.0 - sharing.film_exponent);
        let alone = shear + sharing.rolling * x.powf(sharing.rolling_exponent);
        prop_assert!((law.force(x * sharing.reference) / alone - 1.0).abs() < 5e-3);
    }

    #[test]
    fn at_rest_asperities_are_alone(sharing in sharing()) {
        let law = MixedLaw::new(sharing).unwrap();
        let slow = law.force(1e-30 * sharing.reference);
        prop_assert!((slow / sharing.boundary - 1.0).abs() < 5e-3);
        for product in [0.0, -1.0, f64::NAN, 1e-320, 1e300, f64::INFINITY] {
            let state = law.at(product);
            prop_assert!(state.force().is_finite() && state.slope.is_finite(), "{product} {state:?}");
        }
    }

    #[test]
    fn the_transition_is_a_minimum(sharing in sharing()) {
        let law = MixedLaw::new(sharing).unwrap();
        if let Some(found) = law.transition() {
            let (force, slope) = law.force_and_slope(found.product);
            prop_assert!(slope.abs() * found.product < 1e-7 * force, "{found:?} {slope}");
            prop_assert!(law.force(0.99 * found.product) >= force * (1.0 - 1e-14));
            prop_assert!(law.force(1.01 * found.product) >= force * (1.0 - 1e-14));
            prop_assert!(found.sensitivity.iter().all(|each| each.is_finite()));
            prop_assert!((found.sensitivity[0] - 1.0).abs() < 1e-10);
        }
    }
}
