//! `hersey._core`: conversion between Python and `hersey-core`, and nothing else.

#![allow(clippy::needless_pass_by_value)] // arguments arrive from Python as values

mod curves;
mod drag;
mod ensemble;
mod errors;
mod interrupt;
mod lubrication;
mod mixed;
mod motion;
mod reynolds;
mod stability;
mod start_up;
mod stepper;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use super::curves::{
        CurveFolds, CurveStartUps, CurveStarts, curve_folds, curve_start_ups, curve_starts,
    };
    #[pymodule_export]
    use super::drag::{Law, Pair};
    #[pymodule_export]
    use super::ensemble::{Sweep, sweep};
    #[pymodule_export]
    use super::errors::Failure;
    #[pymodule_export]
    use super::lubrication::{
        Correction, EllipticFilm, Hertz, LayerNip, LineFilm, ShearHeating, Traction, Viscosity,
        ViscosityForm, ViscosityLaw, carreau, effective_modulus, elliptic_film, ellipticity, hertz,
        inlet_heating, inlet_length, layer, layer_factor, line_film, paper, reduced_radius,
        shear_heating, shear_thinning, shore_a_modulus, soft_traction, starvation,
    };
    #[pymodule_export]
    use super::mixed::{
        Mixed, MixedTransition, asperity_integral, mixed_contact, mixed_transition,
    };
    #[pymodule_export]
    use super::motion::{
        Cycle, Energy, Events, State, Trajectory, simulate, steady_start, stick_slip,
    };
    #[pymodule_export]
    use super::reynolds::{Exponents, LineContact, line_contact};
    #[pymodule_export]
    use super::stability::{Band, Bands, Swings, band, bands, swings};
    #[pymodule_export]
    use super::start_up::{StartingBelt, start_ups};
    #[pymodule_export]
    use super::stepper::Stepper;

    use numpy::PyArrayMethods;
    use pyo3::prelude::*;

    /// The names behind the indices of modes and kinds, and the version of the crate.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        use hersey_core::drag::Mode;
        // what NumPy must import is imported now: the crate panics where an interrupt cuts in
        module.py().import("numpy")?;
        module.py().check_signals()?;
        numpy::PyArray1::<f64>::zeros(module.py(), 0, false).readonly();
        let modes = [Mode::Ehl, Mode::Mixed, Mode::Microslip, Mode::Stuck];
        module.add("MODES", modes.map(super::motion::mode_name))?;
        module.add("KINDS", super::ensemble::KINDS)?;
        module.add("REGIMES", super::lubrication::REGIMES)?;
        module.add("FILM_CONSTANTS", super::lubrication::FILM_CONSTANTS)?;
        module.add("FILM_SPEED_EXPONENTS", super::lubrication::speed_exponents())?;
        module.add("FILM_LOAD_EXPONENTS", super::lubrication::load_exponents())?;
        module.add("CLOSURES", hersey_core::drag::ClosureKind::WORDS)?;
        module.add("VISCOSITY_LAWS", super::lubrication::viscosity_laws(module.py())?)?;
        module.add("SHARING", hersey_core::lubrication::mixed::Sharing::NAMES)?;
        module.add("GREENWOOD_TRIPP", hersey_core::lubrication::mixed::GREENWOOD_TRIPP)?;
        module.add("GAS_CONSTANT", hersey_core::lubrication::viscosity::GAS_CONSTANT)?;
        module.add("MOST_STEPS", hersey_core::work::MOST_STEPS)?;
        module.add("NUDGE", hersey_core::motion::NUDGE)?;
        module.add("NIP_RATIO_RANGE", hersey_core::lubrication::paper::NIP_RATIO_RANGE)?;
        module.add("VERSION", env!("CARGO_PKG_VERSION"))
    }
}
