//! Mixed lubrication, over arrays.

use hersey_core::lubrication::mixed::{self, MixedLaw, Sharing};
use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::lubrication::{Array, Columns, mapped};

/// A contact whose load film and asperities share: lambda, least film over roughness, share, forces (N), slope of
/// the force, N/(Pa m), and its derivative by ln of `edge`, N.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Mixed {
    lambda_ratio: Array,
    minimum: Array,
    share: Array,
    boundary: Array,
    shear: Array,
    rolling: Array,
    slope: Array,
    by_edge: Array,
}

/// Where the force is least; not a number where it falls nowhere.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct MixedTransition {
    product: Array,
    lambda_ratio: Array,
    force: Array,
    sensitivity: Py<PyDict>,
}

/// Greenwood and Tripp's integral.
#[pyfunction]
pub fn asperity_integral(
    py: Python<'_>,
    lambda_ratio: PyReadonlyArrayDyn<'_, f64>,
) -> PyResult<Array> {
    mapped(py, &[lambda_ratio], |[lambda]| Ok(mixed::asperity_integral(lambda).0))?
        .of(py, |value| *value)
}

/// A mixed contact, from the product of viscosity and speed and the numbers of the law in the order of `SHARING`.
#[pyfunction]
pub fn mixed_contact(py: Python<'_>, columns: Columns<'_, 11>) -> PyResult<Mixed> {
    let mut last: Option<([u64; 10], MixedLaw)> = None;
    let found = mapped(py, &columns, |[product, numbers @ ..]| {
        let bits = numbers.map(f64::to_bits);
        let same = last.filter(|(same, _)| *same == bits);
        let law =
            same.map_or_else(|| MixedLaw::new(Sharing::from_numbers(numbers)), |(_, law)| Ok(law))?;
        last = Some((bits, law));
        Ok(law.at(product))
    })?;
    Ok(Mixed {
        lambda_ratio: found.of(py, |state| state.lambda)?,
        minimum: found.of(py, |state| state.minimum)?,
        share: found.of(py, |state| state.share)?,
        boundary: found.of(py, |state| state.boundary)?,
        shear: found.of(py, |state| state.shear)?,
        rolling: found.of(py, |state| state.rolling)?,
        slope: found.of(py, |state| state.slope)?,
        by_edge: found.of(py, |state| state.by_edge)?,
    })
}

/// The transition of a mixed contact, from the numbers of the law in the order of `SHARING`.
#[pyfunction]
pub fn mixed_transition(py: Python<'_>, columns: Columns<'_, 10>) -> PyResult<MixedTransition> {
    let found = mapped(py, &columns, |numbers| {
        Ok(MixedLaw::new(Sharing::from_numbers(numbers))?.transition())
    })?;
    let array = |of: fn(&mixed::Transition) -> f64| {
        found.of(py, |transition| transition.as_ref().map_or(f64::NAN, of))
    };
    let sensitivity = PyDict::new(py);
    for (i, name) in Sharing::NAMES.iter().enumerate() {
        let shift = found.of(py, |each| each.map_or(f64::NAN, |each| each.sensitivity[i]))?;
        sensitivity.set_item(name, shift)?;
    }
    Ok(MixedTransition {
        product: array(|each| each.product)?,
        lambda_ratio: array(|each| each.lambda)?,
        force: array(|each| each.force)?,
        sensitivity: sensitivity.unbind(),
    })
}
