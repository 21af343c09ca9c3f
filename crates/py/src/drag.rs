//! The drag law as an object that Python holds.

use hersey_core::Error;
use hersey_core::drag::{Closure, Drag, Rest, SpeedLaw, Strengthening, TemperatureLaw};
use hersey_core::lubrication::mixed::{MixedLaw, Sharing};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{raised, refused};
use crate::interrupt::{copied, interruptible};
use crate::lubrication::ViscosityLaw;

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

/// Static force, if it is not that which makes drag continuous, and force and damping of the rest of the drive.
pub type CommonArguments = (Option<f64>, f64, f64);

pub fn with_common(drag: Drag, (force, rest, damping): CommonArguments) -> Result<Drag, Error> {
    let drag = match force {
        Some(force) => drag.with_breakaway_force(force)?,
        None => drag,
    };
    drag.with_rest(Rest { force: rest, damping })
}

/// The same of each of many sets, from columns in that order; not a number where there is no static force.
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

    /// A contact whose load film and asperities share, from the numbers of `MixedLaw` and a viscosity.
    #[staticmethod]
    fn mixed(
        numbers: [f64; 10],
        viscosity: f64,
        stick_speed: f64,
        closure: ClosureArguments<'_>,
    ) -> PyResult<Self> {
        let law = MixedLaw::new(Sharing::from_numbers(numbers));
        let closure = closure_from(closure)?;
        law.and_then(|law| Drag::mixed(law, viscosity, stick_speed, closure))
            .map(Self)
            .map_err(raised)
    }

    /// The same law, its speeds varying as the inverse of a viscosity, at temperatures in K.
    fn with_viscosity_law(
        &self,
        reference: f64,
        viscosity: &ViscosityLaw,
        boundary_slope: f64,
        rest_slope: f64,
    ) -> PyResult<Self> {
        let speed = SpeedLaw::Viscosity(viscosity.0);
        let temperature_law =
            TemperatureLaw { reference, force_exponent: 0.0, speed, boundary_slope, rest_slope };
        self.0.clone().with_temperature_law(temperature_law).map(Self).map_err(raised)
    }

    /// The same law, varying with temperature.
    fn with_temperature_law(
        &self,
        reference: f64,
        force_exponent: f64,
        speed_exponent: f64,
        rest_slope: f64,
    ) -> PyResult<Self> {
        let powers = TemperatureLaw::powers(reference, force_exponent, speed_exponent);
        let temperature_law = TemperatureLaw { rest_slope, ..powers };
        self.0.clone().with_temperature_law(temperature_law).map(Self).map_err(raised)
    }

    /// The same law with another static force, unless there is none, and the rest of the drive beside it.
    fn with_common(&self, common: CommonArguments) -> PyResult<Self> {
        with_common(self.0.clone(), common).map(Self).map_err(raised)
    }

    /// The same law with a static force that grows with the time at rest.
    fn with_strengthening(&self, growth: f64, time: f64) -> PyResult<Self> {
        let strengthening = Strengthening { growth, time };
        self.0.clone().with_strengthening(strengthening).map(Self).map_err(raised)
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
