//! The drag law as an object that Python holds.

use hersey_core::drag::{Closure, Drag, TemperatureLaw};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{raised, refused};
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
    match name {
        "retained" => Ok(Closure::Retained),
        "stiction" => Ok(Closure::Stiction),
        "stribeck" => Ok(Closure::Stribeck),
        "lugre" => {
            let missing = |name| refused(name, format!("closure 'lugre' needs {name}"));
            Ok(Closure::LuGre {
                bristle_stiffness: stiffness.ok_or_else(|| missing("bristle_stiffness"))?,
                bristle_damping: damping.ok_or_else(|| missing("bristle_damping"))?,
            })
        }
        other => {
            let known = "retained, stiction, stribeck or lugre";
            Err(refused("closure", format!("closure '{other}' is not known: {known}")))
        }
    }
}

#[pymethods]
impl Law {
    /// Two branches that meet at the transition.
    #[new]
    fn new(
        transition: (f64, f64),
        ehl_exponent: f64,
        mixed_exponent: f64,
        stick_speed: f64,
        closure: ClosureArguments<'_>,
    ) -> PyResult<Self> {
        let (force, speed) = transition;
        let closure = closure_from(closure)?;
        Drag::new(force, speed, ehl_exponent, mixed_exponent, stick_speed, closure)
            .map(Self)
            .map_err(raised)
    }

    /// A chain of branches through measured points.
    #[staticmethod]
    fn tabulated(
        speeds: Vec<f64>,
        forces: Vec<f64>,
        stick_speed: f64,
        closure: ClosureArguments<'_>,
    ) -> PyResult<Self> {
        Drag::tabulated(&speeds, &forces, stick_speed, closure_from(closure)?)
            .map(Self)
            .map_err(raised)
    }

    /// The same law, varying with temperature.
    fn with_temperature_law(
        &self,
        reference: f64,
        force_exponent: f64,
        speed_exponent: f64,
    ) -> PyResult<Self> {
        let temperature_law = TemperatureLaw { reference, force_exponent, speed_exponent };
        self.0.clone().with_temperature_law(temperature_law).map(Self).map_err(raised)
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

    /// Drag that a belt at rest can bear.
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
