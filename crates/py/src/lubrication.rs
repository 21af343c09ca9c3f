//! Viscosity, contact and film thickness, over arrays.

use hersey_core::Error;
use hersey_core::lubrication::contact::{self, Solid};
use hersey_core::lubrication::correction::{self, Correction};
use hersey_core::lubrication::film::{self, EllipticContact, LineContact, Regime};
use hersey_core::lubrication::layer::LayerContact;
use hersey_core::lubrication::paper::Nip;
use hersey_core::lubrication::viscosity::{Carreau, Point, TemperatureLaw};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::value_error;

/// Columns of one length, one for each quantity.
type Columns<'py, const N: usize> = [PyReadonlyArray1<'py, f64>; N];
/// Rows of numbers, one column for each point.
type Rows<'py> = Bound<'py, PyArray2<f64>>;

/// What a rule makes of each point, as rows; the message names the point if there are several.
fn mapped<'py, const IN: usize, const OUT: usize>(
    py: Python<'py>,
    columns: &Columns<'py, IN>,
    mut rule: impl FnMut([f64; IN]) -> Result<[f64; OUT], Error> + Send,
) -> PyResult<Rows<'py>> {
    let columns: Vec<Vec<f64>> =
        columns.iter().map(|column| column.as_array().iter().copied().collect()).collect();
    let points = columns.first().map_or(0, Vec::len);
    if columns.iter().any(|column| column.len() != points) {
        return Err(PyValueError::new_err("the columns differ in length"));
    }
    let flat = py.detach(|| {
        let mut flat = vec![0.0; OUT * points];
        for i in 0..points {
            let row = rule(std::array::from_fn(|c| columns[c][i])).map_err(|error| (i, error))?;
            for (c, value) in row.into_iter().enumerate() {
                flat[c * points + i] = value;
            }
        }
        Ok(flat)
    });
    let flat = flat.map_err(|(i, error)| match points {
        1 => value_error(error),
        _ => PyValueError::new_err(format!("point {i}: {error}")),
    })?;
    flat.into_pyarray(py).reshape([OUT, points])
}

fn row_of(found: Correction) -> [f64; 2] {
    [found.factor, f64::from(u8::from(found.valid))]
}

/// How viscosity falls with temperature.
#[pyclass(frozen, module = "hersey._core")]
pub struct ViscosityLaw(TemperatureLaw);

#[pymethods]
impl ViscosityLaw {
    /// Through two points (K, Pa s).
    #[staticmethod]
    fn arrhenius(points: [Point; 2]) -> PyResult<Self> {
        TemperatureLaw::arrhenius(points).map(Self).map_err(value_error)
    }

    /// Through three points (K, Pa s).
    #[staticmethod]
    fn vogel(points: [Point; 3]) -> PyResult<Self> {
        TemperatureLaw::vogel(points).map(Self).map_err(value_error)
    }

    /// Through two points (K, m^2/s), at a density in kg/m^3.
    #[staticmethod]
    fn walther(points: [Point; 2], density: f64) -> PyResult<Self> {
        TemperatureLaw::walther(points, density).map(Self).map_err(value_error)
    }

    /// Viscosity (Pa s) and d ln eta/d ln T at temperatures (K).
    fn at<'py>(
        &self,
        py: Python<'py>,
        temperature: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Rows<'py>> {
        mapped(py, &[temperature], |[t]| {
            Ok([self.0.viscosity(t)?, self.0.temperature_exponent(t)?])
        })
    }

    /// The coefficients by name.
    #[getter]
    fn coefficients(&self) -> Vec<(&'static str, f64)> {
        match self.0 {
            TemperatureLaw::Arrhenius { prefactor, activation_energy } => {
                vec![("prefactor", prefactor), ("activation_energy", activation_energy)]
            }
            TemperatureLaw::Vogel { prefactor, slope, zero } => {
                vec![("prefactor", prefactor), ("slope", slope), ("zero", zero)]
            }
            TemperatureLaw::Walther { a, b, density } => {
                vec![("a", a), ("b", b), ("density", density)]
            }
        }
    }
}

/// Share of viscosity left at a shear rate: rate, relaxation time, exponent, limit.
#[pyfunction]
pub fn carreau<'py>(
    py: Python<'py>,
    columns: Columns<'py, 4>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rows = mapped(py, &columns, |[rate, time, exponent, limit]| {
        Ok([Carreau::new(time, exponent, limit)?.share(rate)])
    })?;
    Ok(rows.readonly().as_array().row(0).to_vec().into_pyarray(py))
}

/// Effective modulus E' of two bodies, each (Young's modulus, Poisson's ratio).
#[pyfunction]
pub fn effective_modulus(one: (f64, f64), other: (f64, f64)) -> PyResult<f64> {
    let solid = |(modulus, poisson_ratio)| Solid { modulus, poisson_ratio };
    contact::effective_modulus(solid(one), solid(other)).map_err(value_error)
}

/// Young's modulus of a Shore A hardness.
#[pyfunction]
pub fn shore_a_modulus(hardness: f64) -> PyResult<f64> {
    contact::shore_a_modulus(hardness).map_err(value_error)
}

/// Reduced radius of two.
#[pyfunction]
pub fn reduced_radius(one: f64, other: f64) -> PyResult<f64> {
    contact::reduced_radius(one, other).map_err(value_error)
}

/// (half-width, greatest pressure) from load (per length, if a line), radius, effective modulus.
#[pyfunction]
pub fn hertz<'py>(py: Python<'py>, columns: Columns<'py, 3>, line: bool) -> PyResult<Rows<'py>> {
    let rule = if line { contact::hertz_line } else { contact::hertz_point };
    mapped(py, &columns, |[load, radius, modulus]| {
        rule(load, radius, modulus).map(|found| [found.half_width, found.pressure_max])
    })
}

/// (nip width, pressure at its centre, slope of pressure at the edge over that of a half-space contact of the
/// same width, width over that of the half-space contact of the same load), from load per length, radius,
/// thickness, Young's modulus and Poisson's ratio of the layer.
#[pyfunction]
pub fn layer<'py>(py: Python<'py>, columns: Columns<'py, 5>) -> PyResult<Rows<'py>> {
    let mut last: Option<([f64; 5], [f64; 4])> = None;
    mapped(py, &columns, |point| {
        if let Some((same, row)) = last
            && same.map(f64::to_bits) == point.map(f64::to_bits)
        {
            return Ok(row);
        }
        let [load, radius, thickness, young, poisson_ratio] = point;
        let solid = Solid { modulus: young, poisson_ratio };
        let rigid = Solid { modulus: f64::INFINITY, poisson_ratio: 0.5 };
        let effective = contact::effective_modulus(solid, rigid)?;
        let half = contact::hertz_line(load, radius, effective)?.half_width;
        let star = 0.5 * effective;
        let found =
            LayerContact::of_load(load * radius / (star * thickness * thickness), poisson_ratio)?;
        let width = found.half_width * thickness;
        let centre = found.centre_pressure * star * width / (2.0 * radius);
        let row = [2.0 * width, centre, found.edge, width / half];
        last = Some((point, row));
        Ok(row)
    })
}

/// One of Eqs. 5-10, from alpha, eta, mean speed, load, length, thickness, radius and effective modulus.
#[pyfunction]
pub fn paper<'py>(
    py: Python<'py>,
    equation: u8,
    columns: Columns<'py, 8>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rule: fn(&Nip) -> f64 = match equation {
        5 => Nip::film_thickness,
        6 => Nip::shear_stress,
        7 => Nip::torque,
        8 => Nip::nip_width,
        9 => Nip::torque_in_full,
        10 => Nip::damping,
        _ => return Err(PyValueError::new_err(format!("equation {equation}: 5 to 10 are known"))),
    };
    let rows = mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, length, thickness, radius, modulus] =
            column;
        let nip =
            Nip { pressure_viscosity, viscosity, speed, load, length, thickness, radius, modulus };
        nip.checked().map(|nip| [rule(&nip)])
    })?;
    Ok(rows.readonly().as_array().row(0).to_vec().into_pyarray(py))
}

/// (viscosity and elasticity parameter, four minimum films, four central films, index of the regime), from alpha,
/// eta, mean speed, load per length, radius, effective modulus and the factor of the layer.
#[pyfunction]
pub fn line_film<'py>(py: Python<'py>, columns: Columns<'py, 7>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, radius, modulus, softness] = column;
        let contact = LineContact { pressure_viscosity, viscosity, speed, load, radius, modulus };
        let found = contact.film(softness)?;
        let (low, mid) = (found.minimum, found.central);
        let regime = f64::from(found.regime as u8);
        Ok([
            found.g_v, found.g_e, low[0], low[1], low[2], low[3], mid[0], mid[1], mid[2], mid[3],
            regime,
        ])
    })
}

/// Factor of a layer on the soft film, from the slope at the edge and the width over that of a half-space.
#[pyfunction]
pub fn layer_factor(edge: f64, width: f64) -> f64 {
    film::layer_factor(edge, width)
}

/// Length of the inlet, from eta, mean speed, radius, effective modulus, slope at the edge and half-width.
#[pyfunction]
pub fn inlet_length<'py>(py: Python<'py>, columns: Columns<'py, 6>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |[viscosity, speed, radius, modulus, edge, half_width]| {
        let contact =
            LineContact { pressure_viscosity: 0.0, viscosity, speed, load: 0.0, radius, modulus };
        Ok([film::inlet_length(&contact, edge, half_width)])
    })
}

/// Ellipticity from the reduced radii along and across the motion.
#[pyfunction]
pub fn ellipticity(along: f64, across: f64) -> PyResult<f64> {
    film::ellipticity(along, across).map_err(value_error)
}

/// (hard minimum, hard central, soft minimum), from alpha, eta, mean speed, load, radius along the motion,
/// effective modulus and ellipticity.
#[pyfunction]
pub fn elliptic_film<'py>(py: Python<'py>, columns: Columns<'py, 7>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, radius, modulus, ellipticity] = column;
        let contact = EllipticContact {
            pressure_viscosity,
            viscosity,
            speed,
            load,
            radius,
            modulus,
            ellipticity,
        };
        contact.film().map(|found| [found.hard_minimum, found.hard_central, found.soft_minimum])
    })
}

/// (factor, valid), from the supplied layer, the flooded film and the sharpness.
#[pyfunction]
pub fn starvation<'py>(py: Python<'py>, columns: Columns<'py, 3>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |[supply, flooded, gamma]| {
        correction::starvation(supply, flooded, gamma).map(row_of)
    })
}

/// (factor, valid), from viscosity, its fall with temperature, mean speed, conductivity and slide-to-roll ratio.
#[pyfunction]
pub fn inlet_heating<'py>(py: Python<'py>, columns: Columns<'py, 5>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |[viscosity, fall, speed, conductivity, slide]| {
        correction::inlet_heating(viscosity, fall, speed, conductivity, slide).map(row_of)
    })
}

/// (greatest, mean) rise of temperature, from viscosity, sliding speed and conductivity.
#[pyfunction]
pub fn shear_heating<'py>(py: Python<'py>, columns: Columns<'py, 3>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |[viscosity, sliding, conductivity]| {
        correction::shear_heating(viscosity, sliding, conductivity).map(|(most, mean)| [most, mean])
    })
}

/// (factor, valid), from the Newtonian film, the sliding speed, the exponent of the film in viscosity, and
/// Carreau's relaxation time, exponent and limit.
#[pyfunction]
pub fn shear_thinning<'py>(py: Python<'py>, columns: Columns<'py, 6>) -> PyResult<Rows<'py>> {
    mapped(py, &columns, |[film, sliding, exponent, time, power, limit]| {
        let thinning = Carreau::new(time, power, limit)?;
        correction::shear_thinning(film, sliding, exponent, thinning).map(row_of)
    })
}

/// Names of the regimes, in the order of their indices.
pub const REGIMES: [&str; 4] =
    ["isoviscous-rigid", "piezoviscous-rigid", "isoviscous-elastic", "piezoviscous-elastic"];

/// Exponent of film thickness in speed of each regime.
pub fn speed_exponents() -> [f64; 4] {
    Regime::ALL.map(Regime::speed_exponent)
}

/// (minimum, centre) constant of each regime; that of the hard centre belongs to a law of its own.
pub const FILM_CONSTANTS: [(f64, f64); 4] = [
    (film::constant::MARTIN, film::constant::MARTIN),
    (film::constant::BLOK, film::constant::BLOK),
    (film::constant::HERREBRUGH, film::constant::HERREBRUGH_CENTRE),
    (film::constant::DOWSON_HIGGINSON, film::constant::DOWSON_TOYODA),
];
