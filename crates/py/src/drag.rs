//! The drag law as an object that Python holds.

use hersey_core::Error;
use hersey_core::drag::form::{CHOICES, LISTS, NUMBERS, Shape};
use hersey_core::drag::{Closure, ClosureKind, Drag, DragForm, Rest};
use hersey_core::wire::Values;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PySequence, PyString};

use crate::errors::{raised, refused, unreadable};
use crate::interrupt::{copied, interruptible};

/// A drag law.
#[pyclass(frozen, module = "hersey._core")]
pub struct Law(pub Drag);

/// Two speeds, one on either side of the transition.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Pair {
    /// Zero if the belt is held before.
    slower: f64,
    /// Infinite if drag never rises so far.
    faster: f64,
}

/// Name, bristle stiffness and bristle damping.
pub type ClosureArguments<'a> = (&'a str, Option<f64>, Option<f64>);

pub fn closure_from((name, stiffness, damping): ClosureArguments) -> PyResult<Closure> {
    let closure = ClosureKind::of(name).and_then(|kind| Closure::of(kind, (stiffness, damping)));
    closure.map_err(unreadable)
}

/// One value of the wire form.
enum Value {
    Word(String),
    Number(f64),
    Numbers(Vec<f64>),
}

impl Value {
    /// Words first: what is no word and no sequence is a number.
    fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(word) = value.cast::<PyString>() {
            return Ok(Self::Word(word.to_str()?.to_owned()));
        }
        if value.is_instance_of::<PyFloat>() || value.cast::<PySequence>().is_err() {
            return value.extract().map(Self::Number);
        }
        value.extract().map(Self::Numbers)
    }
}

/// Values by name, all of them fields of a drag.
struct Given(Vec<(&'static str, Value)>);

fn fields() -> impl Iterator<Item = &'static str> {
    CHOICES.into_iter().chain(NUMBERS).chain(LISTS)
}

impl Given {
    fn new(values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut given = Vec::with_capacity(values.len());
        for (name, value) in values {
            let name = name.cast_into::<PyString>()?;
            let name = name.to_str()?;
            let field = fields().find(|field| *field == name).ok_or_else(|| {
                let known = fields().collect::<Vec<_>>().join(", ");
                refused("drag", format!("'{name}' is no value of a drag: {known}"))
            })?;
            if !value.is_none() {
                given.push((field, Value::of(&value)?));
            }
        }
        Ok(Self(given))
    }

    fn get(&self, field: &str) -> Option<&Value> {
        self.0.iter().find(|(name, _)| *name == field).map(|(_, value)| value)
    }
}

impl Values for Given {
    fn word(&self, field: &str) -> Option<&str> {
        if let Some(Value::Word(word)) = self.get(field) { Some(word) } else { None }
    }

    fn number(&self, field: &str) -> Option<f64> {
        if let Some(Value::Number(number)) = self.get(field) { Some(*number) } else { None }
    }

    fn numbers(&self, field: &str) -> Option<&[f64]> {
        if let Some(Value::Numbers(numbers)) = self.get(field) { Some(numbers) } else { None }
    }
}

/// Static force, if it is not that which makes drag continuous, and force and damping of the rest of the drive.
pub type CommonArguments = (Option<f64>, f64, f64);

/// The law of one of many sets: force and speed of the transition, both exponents and the stick speed.
pub fn two_branches(
    [transition_force, transition_speed, ehl_exponent, mixed_exponent, stick_speed]: [f64; 5],
    closure: Closure,
    (static_force, force, damping): CommonArguments,
) -> Result<Drag, Error> {
    let shape = Shape::Power { transition_force, transition_speed, ehl_exponent, mixed_exponent };
    let rest = Rest { force, damping };
    let (strengthening, temperature_law) = (None, None);
    DragForm { shape, stick_speed, closure, static_force, rest, strengthening, temperature_law }
        .law()
}

/// `CommonArguments` of each of many sets, from columns in that order; not a number where there is no static force.
pub fn beside_from(
    py: Python<'_>,
    columns: Option<[PyReadonlyArray1<'_, f64>; 3]>,
) -> PyResult<impl Fn(usize) -> CommonArguments + Sync + use<>> {
    let columns = columns.map(|c| -> PyResult<Vec<Vec<f64>>> {
        c.iter().map(|column| copied(py, column)).collect()
    });
    let columns = columns.transpose()?;
    Ok(move |i: usize| match &columns {
        None => (None, 0.0, 0.0),
        Some(c) => (Some(c[0][i]).filter(|force| !force.is_nan()), c[1][i], c[2][i]),
    })
}

#[pymethods]
impl Law {
    /// From plain values by name: the wire form of the core.
    #[new]
    fn new(values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let form = DragForm::read(&Given::new(values)?);
        form.and_then(|form| Ok(form.law()?)).map(Self).map_err(unreadable)
    }

    /// The law at one temperature.
    fn at(&self, temperature: f64) -> PyResult<Self> {
        self.0.at(temperature).map(Self).map_err(raised)
    }

    /// Drag force in steady sliding at each speed.
    fn force<'py>(
        &self,
        py: Python<'py>,
        speed: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let speeds = copied(py, &speed)?;
        let forces = interruptible(py, u64::MAX, |work| {
            speeds
                .iter()
                .map(|v| work.take(1).map(|()| self.0.force(*v)))
                .collect::<Result<Vec<_>, _>>()
        })?;
        Ok(forces.into_pyarray(py))
    }

    /// Speeds below and above the transition with a drag of `force`.
    fn speeds_of(&self, force: f64) -> Pair {
        let (slower, faster) = self.0.speeds_of(force);
        Pair { slower, faster }
    }

    /// Drag of the contact at the transition speed.
    #[getter]
    fn transition_force(&self) -> f64 {
        self.0.transition_force()
    }

    /// Drag of the rest of the drive at rest, and per speed.
    #[getter]
    fn rest(&self) -> (f64, f64) {
        let Rest { force, damping } = self.0.rest();
        (force, damping)
    }

    /// Force that holds a belt at rest, the rest of the drive counted.
    #[getter]
    fn holding_force(&self) -> f64 {
        self.0.holding_force(0.0)
    }

    /// Drag of the contact that a belt at rest can bear.
    #[getter]
    fn breakaway_force(&self) -> f64 {
        self.0.breakaway_force()
    }

    /// Speed below which the closure holds.
    #[getter]
    fn stick_speed(&self) -> f64 {
        self.0.stick_speed()
    }

    /// Speed at which the mixed and the EHL branch meet.
    #[getter]
    fn transition_speed(&self) -> f64 {
        self.0.transition_speed()
    }
}
