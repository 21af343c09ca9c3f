//! The drag law as an object that Python holds.

use hersey_core::drag::{Closure, Drag, Warming};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::value_error;

/// A drag law.
#[pyclass(frozen, module = "hersey._core")]
pub struct Law(pub Drag);

/// Name, bristle stiffness and bristle damping.
pub type ClosureArguments<'a> = (&'a str, Option<f64>, Option<f64>);

pub fn closure_from((name, stiffness, damping): ClosureArguments) -> PyResult<Closure> {
    match name {
        "retained" => Ok(Closure::Retained),
        "stiction" => Ok(Closure::Stiction),
        "stribeck" => Ok(Closure::Stribeck),
        "lugre" => {
            let missing = |name| PyValueError::new_err(format!("closure 'lugre' needs {name}"));
            Ok(Closure::LuGre {
                bristle_stiffness: stiffness.ok_or_else(|| missing("bristle_stiffness"))?,
                bristle_damping: damping.ok_or_else(|| missing("bristle_damping"))?,
            })
        }
        other => Err(PyValueError::new_err(format!(
            "closure '{other}' is not known: retained, stiction, stribeck or lugre"
        ))),
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
            .map_err(value_error)
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
            .map_err(value_error)
    }

    /// The same law, varying with temperature.
    fn warmed(&self, reference: f64, force_exponent: f64, speed_exponent: f64) -> PyResult<Self> {
        let warming = Warming { reference, force_exponent, speed_exponent };
        self.0.clone().warmed(warming).map(Self).map_err(value_error)
    }

    /// The law at one temperature.
    fn at(&self, temperature: f64) -> PyResult<Self> {
        self.0.at(temperature).map(Self).map_err(value_error)
    }

    /// Drag force in steady sliding at each speed.
    fn force<'py>(
        &self,
        py: Python<'py>,
        speed: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let forces: Vec<f64> = speed.as_array().iter().map(|v| self.0.force(*v)).collect();
        forces.into_pyarray(py)
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
