//! The numerical film of a line contact.

use hersey_core::lubrication::reynolds::{self, Fluid, Foundation, LineSolution, Thickening};
use hersey_core::work::MOST_STEPS;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

use crate::errors::refused;
use crate::interrupt::interruptible;

/// Exponents of speed or load.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Exponents {
    central: f64,
    minimum: f64,
    traction_1: f64,
    traction_2: f64,
}

impl From<reynolds::Exponents> for Exponents {
    fn from(of: reynolds::Exponents) -> Self {
        let reynolds::Exponents { central, minimum, traction_1, traction_2 } = of;
        Self { central, minimum, traction_1, traction_2 }
    }
}

/// Profiles, films, forces, exponents and the work that it took.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct LineContact {
    x: Py<PyArray1<f64>>,
    pressure: Py<PyArray1<f64>>,
    film_thickness: Py<PyArray1<f64>>,
    central: f64,
    minimum: f64,
    couette: f64,
    poiseuille: f64,
    traction_1: f64,
    traction_2: f64,
    greatest_pressure: f64,
    outlet: f64,
    offset: f64,
    length: f64,
    load_residual: f64,
    flow_residual: f64,
    grid_error: f64,
    by_speed: Py<Exponents>,
    by_load: Py<Exponents>,
    iterations: usize,
    stations: usize,
}

impl LineContact {
    fn new(py: Python<'_>, found: LineSolution) -> PyResult<Self> {
        let array = |values: Vec<f64>| values.into_pyarray(py).unbind();
        let summary = found.summary;
        Ok(Self {
            x: array(found.x),
            pressure: array(found.pressure),
            film_thickness: array(found.film_thickness),
            central: summary.central,
            minimum: summary.minimum,
            couette: summary.couette,
            poiseuille: summary.poiseuille,
            traction_1: summary.traction_1(),
            traction_2: summary.traction_2(),
            greatest_pressure: found.greatest_pressure,
            outlet: found.outlet,
            offset: found.offset,
            length: found.length,
            load_residual: found.load_residual,
            flow_residual: found.flow_residual,
            grid_error: found.grid_error,
            by_speed: Py::new(py, Exponents::from(found.by_speed))?,
            by_load: Py::new(py, Exponents::from(found.by_load))?,
            iterations: found.iterations,
            stations: found.stations,
        })
    }
}

fn thickening_from(name: &str) -> PyResult<Thickening> {
    match name {
        "barus" => Ok(Thickening::Barus),
        "roelands" => Ok(Thickening::Roelands),
        _ => Err(refused("thickening", format!("thickening is {name:?}: barus or roelands"))),
    }
}

/// The film of a roll of radius, contact modulus E* and load per length.
#[pyfunction]
pub fn line_contact(
    py: Python<'_>,
    roll: (f64, f64, f64),
    layer: Option<(f64, f64)>,
    speeds: (f64, f64),
    fluid: (f64, f64, String, bool),
    nodes: usize,
) -> PyResult<LineContact> {
    let (radius, contact_modulus, load) = roll;
    let (viscosity, pressure_viscosity, thickening, compressible) = fluid;
    let thickening = thickening_from(&thickening)?;
    let contact = reynolds::LineContact {
        radius,
        contact_modulus,
        load,
        foundation: layer.map_or(Foundation::HalfSpace, |(thickness, poisson)| Foundation::Layer {
            thickness,
            poisson,
        }),
        entrainment_speed: speeds.0,
        sliding_speed: speeds.1,
        fluid: Fluid { viscosity, pressure_viscosity, thickening, compressible },
    };
    let found = interruptible(py, MOST_STEPS, |work| contact.solve(nodes, work))?;
    LineContact::new(py, found)
}
