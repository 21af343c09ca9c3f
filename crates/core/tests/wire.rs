//! The wire form: every kind can be written and read again, and what is missing or unknown is named.

#[path = "common/sharing.rs"]
mod sharing;

use std::cell::RefCell;
use std::collections::BTreeSet;

use hersey_core::drag::form::{Belongs, Kinds, LISTS, NUMBERS, ShapeKind, TemperatureKind};
use hersey_core::drag::{Closure, ClosureKind, Drag, DragForm, Rest};
use hersey_core::lubrication::viscosity::{Point, TemperatureLaw, ViscosityKind};
use hersey_core::wire::{Unreadable, Values};
use sharing::SHARING;

/// Viscosities of one oil, Pa s.
const OIL: [Point; 3] = [(303.15, 0.81), (333.15, 0.135), (373.15, 0.0268)];

fn oil(kind: ViscosityKind) -> TemperatureLaw {
    TemperatureLaw::through(kind, &OIL[..kind.form().points], Some(870.0)).unwrap()
}

#[test]
fn every_law_of_viscosity_is_made_again_of_its_kind_and_coefficients() {
    for kind in ViscosityKind::ALL {
        let law = oil(kind);
        assert_eq!(law.kind(), kind);
        assert_eq!(ViscosityKind::of(kind.word()), Ok(kind));
        let numbers = law.coefficients();
        assert_eq!(numbers.len(), kind.form().coefficients.len());
        assert_eq!(TemperatureLaw::from_coefficients(kind, &numbers), Ok(law));
        let more = [numbers, vec![1.0]].concat();
        let refused = TemperatureLaw::from_coefficients(kind, &more).unwrap_err();
        assert_eq!(refused.field(), Some("viscosity_numbers"));
        for (temperature, viscosity) in &OIL[..kind.form().points] {
            let found = law.viscosity(*temperature).unwrap();
            assert!((found / viscosity - 1.0).abs() < 1e-9, "{kind:?} {temperature}");
        }
        let density = TemperatureLaw::through(kind, &OIL[..kind.form().points], None);
        assert_eq!(density.is_err(), kind.form().kinematic);
        let points = TemperatureLaw::through(kind, &OIL[..1], Some(870.0)).unwrap_err();
        assert_eq!(points.field(), Some("points"));
    }
}

#[test]
fn a_law_that_is_not_known_is_named_with_those_that_are() {
    let refused = TemperatureKind::of("roelands").unwrap_err().to_string();
    assert!(refused.contains("temperature_law 'roelands' is not known"), "{refused}");
    for kind in TemperatureKind::all() {
        assert!(refused.contains(kind.word()), "{refused}");
        assert_eq!(TemperatureKind::of(kind.word()), Ok(kind));
    }
}

/// Values of a drag of some kinds: all fields but one; what is asked for is written down.
struct Sample<'a> {
    kinds: Kinds,
    without: &'a str,
    sharing: [f64; 10],
    viscosity: Vec<f64>,
    asked: RefCell<BTreeSet<String>>,
}

impl<'a> Sample<'a> {
    fn new(kinds: Kinds, without: &'a str) -> Self {
        let s = SHARING;
        let sharing = [
            s.reference,
            s.film_exponent,
            s.load_exponent,
            s.edge,
            s.roundness,
            s.stiffness,
            s.boundary,
            s.shear,
            s.rolling,
            s.rolling_exponent,
        ];
        let viscosity = match kinds.temperature {
            TemperatureKind::Viscosity(kind) => oil(kind).coefficients(),
            _ => Vec::new(),
        };
        Self { kinds, without, sharing, viscosity, asked: RefCell::default() }
    }

    fn gives(&self, field: &str) -> bool {
        self.asked.borrow_mut().insert(field.to_owned());
        field != self.without && self.kinds.belongs(field) != Belongs::No
    }
}

impl Values for Sample<'_> {
    fn word(&self, field: &str) -> Option<&str> {
        match field {
            "law" => Some(self.kinds.shape.word()),
            "closure" => Some(self.kinds.closure.word()),
            "temperature_law" => Some(self.kinds.temperature.word()),
            _ => None,
        }
    }

    fn number(&self, field: &str) -> Option<f64> {
        let value = match field {
            "stick_speed" => 0.01,
            "transition_force" => 50.0,
            "transition_speed" => 1.0,
            "ehl_exponent" => -0.7,
            "mixed_exponent" => -1.2,
            "viscosity" => 0.03,
            "bristle_stiffness" => 1e5,
            "bristle_damping" => 30.0,
            "static_force" => 500.0,
            "rest_force" => 2.0,
            "rest_damping" => 0.1,
            "static_growth" => 0.05,
            "static_growth_time" => 0.2,
            "reference_temperature" => 350.0,
            "temperature_zero" => 10.0,
            "force_temperature_exponent" => -0.4,
            "speed_temperature_exponent" => 1.5,
            "boundary_temperature_slope" => 1e-3,
            "rest_temperature_slope" => 2e-3,
            _ => panic!("{field} is no number of a drag that this test knows"),
        };
        self.gives(field).then_some(value)
    }

    fn numbers(&self, field: &str) -> Option<&[f64]> {
        let list: &[f64] = match field {
            "speeds" => &[0.01, 0.1, 1.0, 3.0],
            "forces" => &[120.0, 80.0, 50.0, 70.0],
            "numbers" => &self.sharing,
            "viscosity_numbers" => &self.viscosity,
            _ => panic!("{field} is no list of a drag that this test knows"),
        };
        self.gives(field).then_some(list)
    }
}

fn all_kinds() -> Vec<Kinds> {
    let mut found = Vec::new();
    for shape in ShapeKind::ALL {
        for closure in ClosureKind::ALL {
            for temperature in TemperatureKind::all() {
                found.push(Kinds { shape, closure, temperature });
            }
        }
    }
    found
}

#[test]
fn what_belongs_to_a_drag_is_what_is_read_of_it() {
    let mut ever = BTreeSet::new();
    for kinds in all_kinds() {
        let whole = Sample::new(kinds, "");
        let form = DragForm::read(&whole).unwrap();
        assert_eq!(form.closure.kind(), kinds.closure);
        let drag = form.law().unwrap_or_else(|error| panic!("{kinds:?}: {error}"));
        assert_eq!(drag.temperature_law().is_some(), kinds.temperature != TemperatureKind::None);
        let asked = whole.asked.take();
        for field in NUMBERS.into_iter().chain(LISTS) {
            let belongs = kinds.belongs(field);
            let without = DragForm::read(&Sample::new(kinds, field));
            match belongs {
                Belongs::Needed => {
                    let missing = matches!(&without, Err(Unreadable::Missing { field: named, .. }) if *named == field);
                    assert!(missing, "{kinds:?} {field}: {without:?}");
                }
                // its other half needs it
                Belongs::Optional if field == "static_growth_time" => assert!(without.is_err()),
                // mixed numbers without a slope are numbers nonetheless
                Belongs::Optional => assert_ne!(without.unwrap(), form, "{kinds:?} {field}"),
                Belongs::No => continue,
            }
            assert!(asked.contains(field), "{kinds:?}: {field} belongs, but is not read");
            ever.insert(field);
        }
    }
    let all: BTreeSet<_> = NUMBERS.into_iter().chain(LISTS).collect();
    assert_eq!(ever, all);
}

#[test]
fn the_law_is_that_of_its_values() {
    let kinds = Kinds {
        shape: ShapeKind::Power,
        closure: ClosureKind::LuGre,
        temperature: TemperatureKind::Power,
    };
    let closure = Closure::LuGre { bristle_stiffness: 1e5, bristle_damping: 30.0 };
    let powers = hersey_core::drag::TemperatureLaw::powers(350.0 - 10.0, -0.4, 1.5);
    let own = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, closure)
        .and_then(|drag| drag.with_breakaway_force(500.0))
        .and_then(|drag| drag.with_rest(Rest { force: 2.0, damping: 0.1 }))
        .and_then(|drag| {
            let law = hersey_core::drag::TemperatureLaw { rest_slope: 2e-3, ..powers };
            drag.with_temperature_law(law)
        });
    let read = DragForm::read(&Sample::new(kinds, "")).unwrap().law();
    assert_eq!(read, own);
}
