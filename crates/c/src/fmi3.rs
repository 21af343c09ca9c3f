//! Co-simulation by version 3.0 of the Functional Mock-up Interface; its other ways are refused with words.
//!
//! The signatures are those of `fmi3FunctionTypes.h`; a Boolean is a byte here, since a caller may pass any.

#![allow(unsafe_code)] // the names, and what the caller's pointers point to

use std::ffi::{c_char, c_void};
use std::path::Path;

use crate::exchange::{
    deserialized, done, dropped, got, instance_at, kept, none_of_kind, refused, serialized, set,
    size,
};
use crate::handle::{Handle, Logger3, Words};
use crate::instance::Instance as Drive;
use crate::instance::Phase::{Event, Initialization, Instantiated, Step, Terminated};
use crate::memory::{Given, place, text};
use crate::variables::Kind;

type Instance = *mut c_void;
type References = *const u32;

/// Version of the standard.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Categories of what is logged.
const CATEGORIES: [&str; 3] = ["logStatusError", "logStatusWarning", "logAll"];

#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(
    instance: Instance,
    on: u8,
    count: usize,
    categories: *const *const c_char,
) -> i32 {
    done(instance, "fmi3SetDebugLogging", |instance| {
        set_logging(instance, on != 0, count, categories)
    })
}

/// Turn warnings on or off, of all categories or those named; refuse one of which nothing is ever logged.
///
/// Why a call is refused is always told: without that the caller could not know it.
pub fn set_logging(
    instance: &mut Drive,
    on: bool,
    count: usize,
    categories: *const *const c_char,
) -> Result<(), String> {
    let mut warnings = count == 0;
    for category in Given::new("categories", categories, count)?.iter() {
        let category = text("category", category)?;
        if !CATEGORIES.contains(&category) {
            return Err(format!("'{category:.40}' is no category: {}", CATEGORIES.join(", ")));
        }
        warnings |= category != CATEGORIES[0];
    }
    if warnings {
        instance.warns = on;
    }
    Ok(())
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: u8,
    _logging_on: u8,
    event_mode: u8,
    early_return: u8,
    _required: References,
    required_count: usize,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _intermediate_update: *const c_void,
) -> Instance {
    Handle::created(Words::Version3 { logger, environment }, || {
        text("instanceName", name)?;
        if required_count > 0 {
            return Err("there are no intermediate updates".to_owned());
        }
        let folder = Path::new(text("resourcePath", resources)?);
        let mut instance = instance_at(folder, Some(text("instantiationToken", token)?))?;
        (instance.event_mode, instance.early_return) = (event_mode != 0, early_return != 0);
        Ok(instance)
    })
}

/// No instance of another kind than co-simulation.
fn no_instance(environment: *mut c_void, logger: Option<Logger3>, why: &str) -> Instance {
    Handle::created(Words::Version3 { logger, environment }, || Err(why.to_owned()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging_on: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
) -> Instance {
    no_instance(environment, logger, "fmi3InstantiateModelExchange: it is for co-simulation only")
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging_on: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Instance {
    no_instance(
        environment,
        logger,
        "fmi3InstantiateScheduledExecution: it is for co-simulation only",
    )
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeInstance(instance: Instance) {
    Handle::freed(instance);
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: Instance,
    tolerance_defined: u8,
    tolerance: f64,
    start: f64,
    stop_defined: u8,
    stop: f64,
) -> i32 {
    done(instance, "fmi3EnterInitializationMode", |instance| {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        instance.set_up(start, (stop_defined != 0).then_some(stop), tolerance)?;
        instance.enter(Initialization, &[Instantiated])
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3ExitInitializationMode(instance: Instance) -> i32 {
    done(instance, "fmi3ExitInitializationMode", |instance| {
        instance.must_be(&[Initialization])?;
        instance.begin(if instance.event_mode { Event } else { Step })
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterEventMode(instance: Instance) -> i32 {
    done(instance, "fmi3EnterEventMode", |instance| {
        if !instance.event_mode {
            return Err("it was instantiated without event mode".to_owned());
        }
        instance.enter(Event, &[Step])
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterStepMode(instance: Instance) -> i32 {
    done(instance, "fmi3EnterStepMode", |instance| instance.enter(Step, &[Event]))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Terminate(instance: Instance) -> i32 {
    done(instance, "fmi3Terminate", |instance| instance.enter(Terminated, &[Event, Step]))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Reset(instance: Instance) -> i32 {
    done(instance, "fmi3Reset", |instance| {
        instance.reset();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EvaluateDiscreteStates(instance: Instance) -> i32 {
    done(instance, "fmi3EvaluateDiscreteStates", |instance| {
        instance.must_be(&[Initialization, Event])
    })
}

/// Mode and slip are shown as they are now: after that nothing is left to update, and no event has a known time.
#[unsafe(no_mangle)]
extern "C" fn fmi3UpdateDiscreteStates(
    instance: Instance,
    need_update: *mut u8,
    terminate: *mut u8,
    nominals_changed: *mut u8,
    values_changed: *mut u8,
    next_defined: *mut u8,
    next: *mut f64,
) -> i32 {
    done(instance, "fmi3UpdateDiscreteStates", |instance| {
        instance.must_be(&[Event])?;
        let flags = [
            place("discreteStatesNeedUpdate", need_update)?,
            place("terminateSimulation", terminate)?,
            place("nominalsOfContinuousStatesChanged", nominals_changed)?,
            place("valuesOfContinuousStatesChanged", values_changed)?,
            place("nextEventTimeDefined", next_defined)?,
        ];
        let next = place("nextEventTime", next)?;
        instance.show()?;
        for flag in &flags {
            flag.write(0, 0);
        }
        next.write(0, 0.0);
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3DoStep(
    instance: Instance,
    from: f64,
    length: f64,
    _no_state_before: u8,
    event_needed: *mut u8,
    terminate: *mut u8,
    early_return: *mut u8,
    last_time: *mut f64,
) -> i32 {
    done(instance, "fmi3DoStep", |instance| {
        let flags = [
            place("eventHandlingNeeded", event_needed)?,
            place("terminateSimulation", terminate)?,
            place("earlyReturn", early_return)?,
        ];
        let last_time = place("lastSuccessfulTime", last_time)?;
        for flag in &flags {
            flag.write(0, 0);
        }
        last_time.write(0, instance.time());
        let reached = instance.step(from, length)?;
        flags[0].write(0, u8::from(instance.event_mode && reached.changed));
        flags[2].write(0, u8::from(reached.early));
        last_time.write(0, reached.time);
        Ok(())
    })
}

/// Getter and setter of a kind of which there are variables.
macro_rules! values {
    ($($get:ident, $set:ident: $type:ty = $kind:ident, $written:expr, $read:expr;)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $get(
            instance: Instance, references: References, count: usize, values: *mut $type, values_count: usize,
        ) -> i32 {
            done(instance, stringify!($get), |instance| {
                got(instance, (references, count), (values, values_count), Kind::$kind, $written)
            })
        }

        #[unsafe(no_mangle)]
        extern "C" fn $set(
            instance: Instance, references: References, count: usize, values: *const $type, values_count: usize,
        ) -> i32 {
            done(instance, stringify!($set), |instance| {
                set(instance, (references, count), (values, values_count), Kind::$kind, $read)
            })
        }
    )*};
}

#[allow(clippy::cast_possible_truncation)] // the number of a mode
fn whole(value: f64) -> i64 {
    value as i64
}

#[allow(clippy::cast_precision_loss)] // no enumeration can be set
fn number(value: i64) -> f64 {
    value as f64
}

values! {
    fmi3GetFloat64, fmi3SetFloat64: f64 = Float64, |value| value, |value| value;
    fmi3GetInt64, fmi3SetInt64: i64 = Enumeration, whole, number;
    fmi3GetBoolean, fmi3SetBoolean: u8 = Boolean, |value| u8::from(value != 0.0), |value| f64::from(u8::from(value != 0));
}

/// Getter and setter of a kind of which there are none.
macro_rules! no_values {
    ($($function:ident, $kind:literal ($($type:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $function(
            instance: Instance, references: References, count: usize $(, _: $type)*
        ) -> i32 {
            done(instance, stringify!($function), |_| none_of_kind($kind, references, count))
        }
    )*};
}

no_values! {
    fmi3GetFloat32, "Float32" (*mut c_void, usize);
    fmi3GetInt8, "Int8" (*mut c_void, usize);
    fmi3GetUInt8, "UInt8" (*mut c_void, usize);
    fmi3GetInt16, "Int16" (*mut c_void, usize);
    fmi3GetUInt16, "UInt16" (*mut c_void, usize);
    fmi3GetInt32, "Int32" (*mut c_void, usize);
    fmi3GetUInt32, "UInt32" (*mut c_void, usize);
    fmi3GetUInt64, "UInt64" (*mut c_void, usize);
    fmi3GetString, "String" (*mut c_void, usize);
    fmi3GetBinary, "Binary" (*mut usize, *mut c_void, usize);
    fmi3GetClock, "Clock" (*mut c_void);
    fmi3SetFloat32, "Float32" (*const c_void, usize);
    fmi3SetInt8, "Int8" (*const c_void, usize);
    fmi3SetUInt8, "UInt8" (*const c_void, usize);
    fmi3SetInt16, "Int16" (*const c_void, usize);
    fmi3SetUInt16, "UInt16" (*const c_void, usize);
    fmi3SetInt32, "Int32" (*const c_void, usize);
    fmi3SetUInt32, "UInt32" (*const c_void, usize);
    fmi3SetUInt64, "UInt64" (*const c_void, usize);
    fmi3SetString, "String" (*const c_void, usize);
    fmi3SetBinary, "Binary" (*const usize, *const c_void, usize);
    fmi3SetClock, "Clock" (*const c_void);
    fmi3GetIntervalDecimal, "Clock" (*mut f64, *mut i32);
    fmi3GetIntervalFraction, "Clock" (*mut u64, *mut u64, *mut i32);
    fmi3GetShiftDecimal, "Clock" (*mut f64);
    fmi3GetShiftFraction, "Clock" (*mut u64, *mut u64);
    fmi3SetIntervalDecimal, "Clock" (*const f64);
    fmi3SetIntervalFraction, "Clock" (*const u64, *const u64);
    fmi3SetShiftDecimal, "Clock" (*const f64);
    fmi3SetShiftFraction, "Clock" (*const u64, *const u64);
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetFMUState(instance: Instance, state: *mut *mut c_void) -> i32 {
    done(instance, "fmi3GetFMUState", |instance| kept(instance, state))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetFMUState(instance: Instance, state: *mut c_void) -> i32 {
    done(instance, "fmi3SetFMUState", |instance| {
        instance.restore(&crate::handle::State::at(state)?.saved)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeFMUState(instance: Instance, state: *mut *mut c_void) -> i32 {
    done(instance, "fmi3FreeFMUState", |_| dropped(state))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SerializedFMUStateSize(
    instance: Instance,
    state: *mut c_void,
    bytes: *mut usize,
) -> i32 {
    done(instance, "fmi3SerializedFMUStateSize", |instance| size(instance, state, bytes))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SerializeFMUState(
    instance: Instance,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> i32 {
    done(instance, "fmi3SerializeFMUState", |instance| serialized(instance, state, bytes, size))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3DeserializeFMUState(
    instance: Instance,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> i32 {
    done(instance, "fmi3DeserializeFMUState", |instance| deserialized(instance, bytes, size, state))
}

/// Functions of what this library has not.
macro_rules! unsupported {
    ($($function:ident($($type:ty),*): $why:expr;)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $function(instance: Instance $(, _: $type)*) -> i32 {
            refused(instance, stringify!($function), $why)
        }
    )*};
}

const MODEL_EXCHANGE: &str = "it is for co-simulation only, not for model exchange";
const DERIVATIVES: &str = "derivatives are not provided";
const STRUCTURE: &str = "there are no structural parameters";
const DEPENDENCIES: &str = "dependencies of elements are not provided";

unsupported! {
    fmi3GetNumberOfVariableDependencies(u32, *mut usize): DEPENDENCIES;
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize): DEPENDENCIES;
    fmi3GetDirectionalDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize): DERIVATIVES;
    fmi3GetAdjointDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize): DERIVATIVES;
    fmi3GetOutputDerivatives(References, usize, *const i32, *mut f64, usize): DERIVATIVES;
    fmi3EnterConfigurationMode(): STRUCTURE;
    fmi3ExitConfigurationMode(): STRUCTURE;
    fmi3EnterContinuousTimeMode(): MODEL_EXCHANGE;
    fmi3CompletedIntegratorStep(u8, *mut u8, *mut u8): MODEL_EXCHANGE;
    fmi3SetTime(f64): MODEL_EXCHANGE;
    fmi3SetContinuousStates(*const f64, usize): MODEL_EXCHANGE;
    fmi3GetContinuousStateDerivatives(*mut f64, usize): MODEL_EXCHANGE;
    fmi3GetEventIndicators(*mut f64, usize): MODEL_EXCHANGE;
    fmi3GetContinuousStates(*mut f64, usize): MODEL_EXCHANGE;
    fmi3GetNominalsOfContinuousStates(*mut f64, usize): MODEL_EXCHANGE;
    fmi3GetNumberOfEventIndicators(*mut usize): MODEL_EXCHANGE;
    fmi3GetNumberOfContinuousStates(*mut usize): MODEL_EXCHANGE;
    fmi3ActivateModelPartition(u32, f64): "it is for co-simulation only, not for scheduled execution";
}
