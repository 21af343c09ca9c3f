//! Viscosity, contact and film thickness, over arrays.

use hersey_core::Error;
use hersey_core::lubrication::contact::{self, Solid};
use hersey_core::lubrication::correction;
use hersey_core::lubrication::film::{self, EllipticContact, LineContact, Regime};
use hersey_core::lubrication::layer as bonded;
use hersey_core::lubrication::paper::Nip;
use hersey_core::lubrication::traction::{self, Edge};
use hersey_core::lubrication::viscosity::{self, Carreau, Point, TemperatureLaw, ViscosityKind};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{raised, raised_at, refused, unreadable};
use crate::interrupt::{copied, interruptible};

/// Arrays of one shape, one for each quantity.
pub type Columns<'py, const N: usize> = [PyReadonlyArrayDyn<'py, f64>; N];
/// An array of that shape.
pub type Array = Py<PyArrayDyn<f64>>;

/// What a rule costs at a point, in steps of work: the dearest solves a contact anew.
const POINT: u64 = 16;

/// What a rule makes of the points of some arrays.
pub struct Mapped<R> {
    shape: Vec<usize>,
    results: Vec<R>,
}

impl<R> Mapped<R> {
    /// One number of each point, in the shape of the arrays.
    pub fn of<T: numpy::Element>(
        &self,
        py: Python<'_>,
        of: impl Fn(&R) -> T,
    ) -> PyResult<Py<PyArrayDyn<T>>> {
        py.check_signals()?;
        let flat: Vec<T> = self.results.iter().map(of).collect();
        Ok(flat.into_pyarray(py).reshape(self.shape.as_slice())?.unbind())
    }
}

/// What a rule makes of each point; the message names the point if there are several.
pub fn mapped<const IN: usize, R: Send>(
    py: Python<'_>,
    columns: &Columns<'_, IN>,
    mut rule: impl FnMut([f64; IN]) -> Result<R, Error> + Send,
) -> PyResult<Mapped<R>> {
    let shape = columns[0].as_array().shape().to_vec();
    if columns.iter().any(|column| column.as_array().shape() != shape) {
        return Err(refused("shape", "the arrays differ in shape".to_owned()));
    }
    let columns: Vec<Vec<f64>> =
        columns.iter().map(|column| copied(py, column)).collect::<PyResult<_>>()?;
    let points = columns.first().map_or(0, Vec::len);
    let results = interruptible(py, u64::MAX, |work| {
        let point = |i: usize| {
            work.take(POINT)?;
            Ok(rule(std::array::from_fn(|c| columns[c][i])).map_err(|e| (i, e)))
        };
        (0..points).map(point).collect::<Result<Result<Vec<_>, _>, _>>()
    })?;
    let results = results.map_err(|(i, error)| match points {
        1 => raised(error),
        _ => raised_at("point", i, error),
    })?;
    Ok(Mapped { shape, results })
}

/// A factor on film thickness, and whether the rule behind it holds.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Correction {
    factor: Array,
    valid: Py<PyArrayDyn<bool>>,
}

fn corrected<const IN: usize>(
    py: Python<'_>,
    columns: &Columns<'_, IN>,
    rule: impl FnMut([f64; IN]) -> Result<correction::Correction, Error> + Send,
) -> PyResult<Correction> {
    let found = mapped(py, columns, rule)?;
    Ok(Correction { factor: found.of(py, |c| c.factor)?, valid: found.of(py, |c| c.valid)? })
}

/// Viscosity (Pa s) and d ln eta/d ln T.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Viscosity {
    viscosity: Array,
    temperature_exponent: Array,
}

/// Half-width or radius (m) and greatest pressure (Pa) of a contact.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Hertz {
    half_width: Array,
    pressure_max: Array,
}

/// A roll pressed into a bonded layer.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct LayerNip {
    width: Array,
    pressure_max: Array,
    edge: Array,
    curvature: Array,
    width_over_hertz: Array,
}

/// Force of a soft film on the belt: factor on the shear of the central film, and rolling part (N/m).
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Traction {
    shear_factor: Array,
    rolling: Array,
}

/// Films of a line contact by each law, by the names of the regimes, and the index of the one that holds.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct LineFilm {
    g_v: Array,
    g_e: Array,
    minimum: Py<PyDict>,
    central: Py<PyDict>,
    regime: Py<PyArrayDyn<u8>>,
}

/// Films of an elliptic contact by each law, m.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct EllipticFilm {
    hard_minimum: Array,
    hard_central: Array,
    soft_minimum: Array,
}

/// Rise of temperature in a sheared film, K.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct ShearHeating {
    greatest: Array,
    mean: Array,
}

/// How viscosity falls with temperature.
#[pyclass(frozen, module = "hersey._core")]
pub struct ViscosityLaw(pub TemperatureLaw);

#[pymethods]
impl ViscosityLaw {
    /// Of a kind, through points (K, Pa s); density in kg/m^3, where the law is one of kinematic viscosity.
    #[staticmethod]
    #[pyo3(signature = (kind, points, density=None))]
    fn through(kind: &str, points: Vec<Point>, density: Option<f64>) -> PyResult<Self> {
        let law = ViscosityKind::of(kind)
            .and_then(|kind| TemperatureLaw::through(kind, &points, density));
        law.map(Self).map_err(unreadable)
    }

    /// Viscosity (Pa s) and d ln eta/d ln T at temperatures (K).
    fn at(&self, py: Python<'_>, temperature: PyReadonlyArrayDyn<'_, f64>) -> PyResult<Viscosity> {
        let found = mapped(py, &[temperature], |[t]| {
            Ok((self.0.viscosity(t)?, self.0.temperature_exponent(t)?))
        })?;
        Ok(Viscosity {
            viscosity: found.of(py, |point| point.0)?,
            temperature_exponent: found.of(py, |point| point.1)?,
        })
    }

    /// Its word among the laws.
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind().word()
    }

    /// The coefficients by name.
    #[getter]
    fn coefficients(&self) -> Vec<(&'static str, f64)> {
        self.0.kind().form().coefficients.iter().copied().zip(self.0.coefficients()).collect()
    }
}

/// What a law of viscosity is made of.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct ViscosityForm {
    /// Points through which it goes.
    points: usize,
    /// Whether it is one of kinematic viscosity, so that it needs a density.
    kinematic: bool,
    /// Names of its coefficients.
    coefficients: Vec<&'static str>,
}

/// The laws of viscosity by their words.
pub fn viscosity_laws(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let laws = PyDict::new(py);
    for kind in ViscosityKind::ALL {
        let viscosity::Form { points, kinematic, coefficients } = kind.form();
        let coefficients = coefficients.to_vec();
        laws.set_item(kind.word(), ViscosityForm { points, kinematic, coefficients })?;
    }
    Ok(laws)
}

/// Share of viscosity left at a shear rate: rate, relaxation time, exponent, limit.
#[pyfunction]
pub fn carreau(py: Python<'_>, columns: Columns<'_, 4>) -> PyResult<Array> {
    mapped(py, &columns, |[rate, time, exponent, limit]| {
        Ok(Carreau::new(time, exponent, limit)?.share(rate))
    })?
    .of(py, |share| *share)
}

/// Effective modulus E' of two bodies, each (Young's modulus, Poisson's ratio).
#[pyfunction]
pub fn effective_modulus(one: (f64, f64), other: (f64, f64)) -> PyResult<f64> {
    let solid = |(modulus, poisson_ratio)| Solid { modulus, poisson_ratio };
    contact::effective_modulus(solid(one), solid(other)).map_err(raised)
}

/// Young's modulus of a Shore A hardness.
#[pyfunction]
pub fn shore_a_modulus(hardness: f64) -> PyResult<f64> {
    contact::shore_a_modulus(hardness).map_err(raised)
}

/// Reduced radius of two.
#[pyfunction]
pub fn reduced_radius(one: f64, other: f64) -> PyResult<f64> {
    contact::reduced_radius(one, other).map_err(raised)
}

/// Hertz's contact, from load (per length, if a line), radius and effective modulus.
#[pyfunction]
pub fn hertz(py: Python<'_>, columns: Columns<'_, 3>, line: bool) -> PyResult<Hertz> {
    let rule = if line { contact::hertz_line } else { contact::hertz_point };
    let found = mapped(py, &columns, |[load, radius, modulus]| rule(load, radius, modulus))?;
    Ok(Hertz {
        half_width: found.of(py, |h| h.half_width)?,
        pressure_max: found.of(py, |h| h.pressure_max)?,
    })
}

/// The nip of a roll on a layer, from load per length, radius, thickness, Young's modulus and Poisson's ratio.
#[pyfunction]
pub fn layer(py: Python<'_>, columns: Columns<'_, 5>) -> PyResult<LayerNip> {
    let mut last: Option<([u64; 5], bonded::LayerNip)> = None;
    let found = mapped(py, &columns, |point| {
        let bits = point.map(f64::to_bits);
        if let Some((_, nip)) = last.filter(|(same, _)| *same == bits) {
            return Ok(nip);
        }
        let [load, radius, thickness, modulus, poisson_ratio] = point;
        let nip = bonded::nip(load, radius, thickness, Solid { modulus, poisson_ratio })?;
        last = Some((bits, nip));
        Ok(nip)
    })?;
    Ok(LayerNip {
        width: found.of(py, |nip| nip.width)?,
        pressure_max: found.of(py, |nip| nip.pressure_max)?,
        edge: found.of(py, |nip| nip.edge)?,
        curvature: found.of(py, |nip| nip.curvature)?,
        width_over_hertz: found.of(py, |nip| nip.width_over_hertz)?,
    })
}

/// One of Eqs. 5-10, from alpha, eta, mean speed, load, length, thickness, radius and effective modulus.
#[pyfunction]
pub fn paper(py: Python<'_>, equation: u8, columns: Columns<'_, 8>) -> PyResult<Array> {
    let rule: fn(&Nip) -> f64 = match equation {
        5 => Nip::film_thickness,
        6 => Nip::shear_stress,
        7 => Nip::torque,
        8 => Nip::nip_width,
        9 => Nip::torque_in_full,
        10 => Nip::damping,
        _ => return Err(refused("equation", format!("equation {equation}: 5 to 10 are known"))),
    };
    mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, length, thickness, radius, modulus] =
            column;
        let nip =
            Nip { pressure_viscosity, viscosity, speed, load, length, thickness, radius, modulus };
        nip.checked().map(|nip| rule(&nip))
    })?
    .of(py, |value| *value)
}

/// The films of a line contact, from alpha, eta, mean speed, load per length, radius, effective modulus and the
/// factor of the layer.
#[pyfunction]
pub fn line_film(py: Python<'_>, columns: Columns<'_, 7>) -> PyResult<LineFilm> {
    let found = mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, radius, modulus, softness] = column;
        let contact = LineContact { pressure_viscosity, viscosity, speed, load, radius, modulus };
        contact.film(softness)
    })?;
    let by_regime = |of: fn(&film::LineFilm) -> [f64; 4]| {
        let films = PyDict::new(py);
        for (i, name) in REGIMES.iter().enumerate() {
            films.set_item(name, found.of(py, |film| of(film)[i])?)?;
        }
        PyResult::Ok(films.unbind())
    };
    Ok(LineFilm {
        g_v: found.of(py, |film| film.g_v)?,
        g_e: found.of(py, |film| film.g_e)?,
        minimum: by_regime(|film| film.minimum)?,
        central: by_regime(|film| film.central)?,
        regime: found.of(py, |film| film.regime as u8)?,
    })
}

/// Factor of a layer on the soft film, from the slope at the edge and the width over that of a half-space.
#[pyfunction]
pub fn layer_factor(edge: f64, width: f64) -> f64 {
    film::layer_factor(edge, width)
}

/// Length of the inlet, from eta, mean speed, radius, effective modulus, slope at the edge and half-width.
#[pyfunction]
pub fn inlet_length(py: Python<'_>, columns: Columns<'_, 6>) -> PyResult<Array> {
    mapped(py, &columns, |[viscosity, speed, radius, modulus, edge, half_width]| {
        let contact =
            LineContact { pressure_viscosity: 0.0, viscosity, speed, load: 0.0, radius, modulus };
        Ok(film::inlet_length(&contact, edge, half_width))
    })?
    .of(py, |length| *length)
}

/// Force of a soft film on the belt, from eta, mean speed, radius, effective modulus, slope and curvature of pressure at
/// the edge, half-width and thickness of the layer.
#[pyfunction]
pub fn soft_traction(py: Python<'_>, columns: Columns<'_, 8>) -> PyResult<Traction> {
    let found = mapped(py, &columns, |column| {
        let [viscosity, speed, radius, modulus, slope, curvature, half_width, thickness] = column;
        let contact =
            LineContact { pressure_viscosity: 0.0, viscosity, speed, load: 0.0, radius, modulus };
        traction::soft_traction(&contact, Edge { slope, curvature, half_width, thickness })
    })?;
    Ok(Traction {
        shear_factor: found.of(py, |force| force.shear_factor)?,
        rolling: found.of(py, |force| force.rolling)?,
    })
}

/// Ellipticity from the reduced radii along and across the motion.
#[pyfunction]
pub fn ellipticity(along: f64, across: f64) -> PyResult<f64> {
    film::ellipticity(along, across).map_err(raised)
}

/// The films of an elliptic contact, from alpha, eta, mean speed, load, radius along the motion, effective modulus
/// and ellipticity.
#[pyfunction]
pub fn elliptic_film(py: Python<'_>, columns: Columns<'_, 7>) -> PyResult<EllipticFilm> {
    let found = mapped(py, &columns, |column| {
        let [pressure_viscosity, viscosity, speed, load, radius, modulus, ellipticity] = column;
        EllipticContact { pressure_viscosity, viscosity, speed, load, radius, modulus, ellipticity }
            .film()
    })?;
    Ok(EllipticFilm {
        hard_minimum: found.of(py, |film| film.hard_minimum)?,
        hard_central: found.of(py, |film| film.hard_central)?,
        soft_minimum: found.of(py, |film| film.soft_minimum)?,
    })
}

/// Starvation, from the supplied layer, the flooded film and the sharpness.
#[pyfunction]
pub fn starvation(py: Python<'_>, columns: Columns<'_, 3>) -> PyResult<Correction> {
    corrected(py, &columns, |[supply, flooded, gamma]| {
        correction::starvation(supply, flooded, gamma)
    })
}

/// Inlet heating, from viscosity, its fall with temperature, mean speed, conductivity and slide-to-roll ratio.
#[pyfunction]
pub fn inlet_heating(py: Python<'_>, columns: Columns<'_, 5>) -> PyResult<Correction> {
    corrected(py, &columns, |[viscosity, fall, speed, conductivity, slide]| {
        correction::inlet_heating(viscosity, fall, speed, conductivity, slide)
    })
}

/// Rise of temperature, from viscosity, sliding speed and conductivity.
#[pyfunction]
pub fn shear_heating(py: Python<'_>, columns: Columns<'_, 3>) -> PyResult<ShearHeating> {
    let found = mapped(py, &columns, |[viscosity, sliding, conductivity]| {
        correction::shear_heating(viscosity, sliding, conductivity)
    })?;
    Ok(ShearHeating { greatest: found.of(py, |rise| rise.0)?, mean: found.of(py, |rise| rise.1)? })
}

/// Shear thinning, from the Newtonian film, the sliding speed, the exponent of the film in viscosity, and Carreau's
/// relaxation time, exponent and limit.
#[pyfunction]
pub fn shear_thinning(py: Python<'_>, columns: Columns<'_, 6>) -> PyResult<Correction> {
    corrected(py, &columns, |[film, sliding, exponent, time, power, limit]| {
        let thinning = Carreau::new(time, power, limit)?;
        correction::shear_thinning(film, sliding, exponent, thinning)
    })
}

/// Names of the regimes, in the order of their indices.
pub const REGIMES: [&str; 4] =
    ["isoviscous-rigid", "piezoviscous-rigid", "isoviscous-elastic", "piezoviscous-elastic"];

/// Exponent of film thickness in speed of each regime.
pub fn speed_exponents() -> [f64; 4] {
    Regime::ALL.map(Regime::speed_exponent)
}

/// Exponent by which film thickness falls with load in each regime.
pub fn load_exponents() -> [f64; 4] {
    Regime::ALL.map(Regime::load_exponent)
}

/// (minimum, centre) constant of each regime; that of the hard centre belongs to a law of its own.
pub const FILM_CONSTANTS: [(f64, f64); 4] = [
    (film::constant::MARTIN, film::constant::MARTIN),
    (film::constant::BLOK, film::constant::BLOK),
    (film::constant::HERREBRUGH, film::constant::HERREBRUGH_CENTRE),
    (film::constant::DOWSON_HIGGINSON, film::constant::DOWSON_TOYODA),
];
