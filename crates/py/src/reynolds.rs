//! The numerical film of a line contact.

use hersey_core::lubrication::reynolds::{Exponents, Fluid, Foundation, LineContact, Thickening};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::value_error;

/// x, pressure and film thickness at the nodes.
type Profiles<'py> = [Bound<'py, PyArray1<f64>>; 3];
/// central, minimum, couette, poiseuille, `traction_1`, `traction_2`, `greatest_pressure`, outlet, offset, length,
/// `load_residual`, `flow_residual`, `grid_error`
type Numbers = [f64; 13];

fn thickening_from(name: &str) -> PyResult<Thickening> {
    match name {
        "barus" => Ok(Thickening::Barus),
        "roelands" => Ok(Thickening::Roelands),
        _ => Err(PyValueError::new_err(format!("thickening is {name:?}: barus or roelands"))),
    }
}

fn row(exponents: &Exponents) -> [f64; 4] {
    [exponents.central, exponents.minimum, exponents.traction_1, exponents.traction_2]
}

/// Profiles, numbers, exponents by speed and by load, Newton steps and stations of one contact.
#[pyfunction]
#[allow(clippy::type_complexity)] // named in the stub
pub fn line_contact(
    py: Python<'_>,
    roll: (f64, f64, f64),
    layer: Option<(f64, f64)>,
    speeds: (f64, f64),
    fluid: (f64, f64, String, bool),
    nodes: usize,
) -> PyResult<(Profiles<'_>, Numbers, [f64; 4], [f64; 4], (usize, usize))> {
    let (radius, contact_modulus, load) = roll;
    let (viscosity, pressure_viscosity, thickening, compressible) = fluid;
    let thickening = thickening_from(&thickening)?;
    let contact = LineContact {
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
    let found = py.detach(|| contact.solve(nodes)).map_err(value_error)?;
    let summary = found.summary;
    let numbers = [
        summary.central,
        summary.minimum,
        summary.couette,
        summary.poiseuille,
        summary.traction_1(),
        summary.traction_2(),
        found.greatest_pressure,
        found.outlet,
        found.offset,
        found.length,
        found.load_residual,
        found.flow_residual,
        found.grid_error,
    ];
    let work = (found.iterations, found.stations);
    let exponents = (row(&found.by_speed), row(&found.by_load));
    let profiles = [found.x, found.pressure, found.film_thickness].map(|v| v.into_pyarray(py));
    Ok((profiles, numbers, exponents.0, exponents.1, work))
}
