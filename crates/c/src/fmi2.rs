//! Co-simulation by version 2.0 of the Functional Mock-up Interface; model exchange is refused with words.
//!
//! The signatures are those of `fmi2FunctionTypes.h`. Events inside a step are passed; an input may go on with a slope.

#![allow(unsafe_code)] // the names, and what the caller's pointers point to

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::PathBuf;

use crate::exchange::{
    DISCARD, deserialized, done, dropped, got, instance_at, kept, none_of_kind, refused,
    serialized, set, size,
};
use crate::fmi3::set_logging;
use crate::handle::{Handle, Logger2, State, Words};
use crate::instance::Phase::{Initialization, Instantiated, Step, Terminated};
use crate::memory::{Given, place, text};
use crate::variables::Kind;

type Component = *mut c_void;
type References = *const u32;

/// What a tool is called back by.
#[repr(C)]
#[derive(Clone, Copy)]
struct Callbacks {
    logger: Option<Logger2>,
    _allocate_memory: *const c_void,
    _free_memory: *const c_void,
    _step_finished: *const c_void,
    environment: *mut c_void,
}

/// Which of the kinds of units is asked for.
const CO_SIMULATION: c_int = 1;
/// Kinds of status that a tool may ask for.
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetDebugLogging(
    component: Component,
    on: c_int,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    done(component, "fmi2SetDebugLogging", |instance| {
        set_logging(instance, on != 0, count, categories)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging_on: c_int,
) -> Component {
    let callbacks =
        Given::new("functions", callbacks, 1).ok().and_then(|given| given.iter().next());
    let own_name = text("instanceName", name);
    let name = CString::new(own_name.clone().unwrap_or_default()).unwrap_or_default();
    let (logger, environment) = callbacks.map_or((None, std::ptr::null_mut()), |callbacks| {
        (callbacks.logger, callbacks.environment)
    });
    Handle::created(Words::Version2 { logger, environment, name }, || {
        own_name?;
        if callbacks.is_none() {
            return Err("functions is null".to_owned());
        }
        if kind != CO_SIMULATION {
            return Err("it is for co-simulation only, not for model exchange".to_owned());
        }
        let folder = folder_of(text("fmuResourceLocation", resources)?)?;
        instance_at(&folder, Some(text("fmuGUID", token)?))
    })
}

/// The folder that a URI of a file names.
fn folder_of(uri: &str) -> Result<PathBuf, String> {
    let rest =
        uri.strip_prefix("file:").ok_or_else(|| format!("'{uri:.80}' is no URI file:///..."))?;
    let path = match rest.strip_prefix("//") {
        Some(host_and_path) => host_and_path.find('/').map_or("", |slash| &host_and_path[slash..]),
        None => rest,
    };
    let mut bytes = Vec::with_capacity(path.len());
    let mut left = path.as_bytes();
    while let [first, others @ ..] = left {
        left = others;
        let escaped = || std::str::from_utf8(others.get(..2)?).ok();
        match escaped().filter(|_| *first == b'%').and_then(|hex| u8::from_str_radix(hex, 16).ok())
        {
            Some(byte) => {
                bytes.push(byte);
                left = &others[2..];
            }
            None => bytes.push(*first),
        }
    }
    let path = String::from_utf8(bytes).map_err(|_| format!("'{uri:.80}' is not in UTF-8"))?;
    // before the letter of a drive, a slash is of the URI
    let of_windows = cfg!(windows) && path.as_bytes().get(2) == Some(&b':');
    Ok(PathBuf::from(if of_windows { &path[1..] } else { &path }))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeInstance(component: Component) {
    Handle::freed(component);
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    component: Component,
    tolerance_defined: c_int,
    tolerance: f64,
    start: f64,
    stop_defined: c_int,
    stop: f64,
) -> c_int {
    done(component, "fmi2SetupExperiment", |instance| {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        instance.set_up(start, (stop_defined != 0).then_some(stop), tolerance)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2EnterInitializationMode(component: Component) -> c_int {
    done(component, "fmi2EnterInitializationMode", |instance| {
        instance.enter(Initialization, &[Instantiated])
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2ExitInitializationMode(component: Component) -> c_int {
    done(component, "fmi2ExitInitializationMode", |instance| {
        instance.must_be(&[Initialization])?;
        instance.begin(Step)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Terminate(component: Component) -> c_int {
    done(component, "fmi2Terminate", |instance| instance.enter(Terminated, &[Step]))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Reset(component: Component) -> c_int {
    done(component, "fmi2Reset", |instance| {
        instance.reset();
        Ok(())
    })
}

/// Getter and setter of a kind of which there are variables.
macro_rules! values {
    ($($get:ident, $set:ident: $type:ty = $kind:ident, $written:expr, $read:expr;)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $get(component: Component, references: References, count: usize, values: *mut $type) -> c_int {
            done(component, stringify!($get), |instance| {
                got(instance, (references, count), (values, count), Kind::$kind, $written)
            })
        }

        #[unsafe(no_mangle)]
        extern "C" fn $set(component: Component, references: References, count: usize, values: *const $type) -> c_int {
            done(component, stringify!($set), |instance| {
                set(instance, (references, count), (values, count), Kind::$kind, $read)
            })
        }
    )*};
}

#[allow(clippy::cast_possible_truncation)] // the number of a mode
fn whole(value: f64) -> c_int {
    value as c_int
}

values! {
    fmi2GetReal, fmi2SetReal: f64 = Float64, |value| value, |value| value;
    fmi2GetInteger, fmi2SetInteger: c_int = Enumeration, whole, f64::from;
    fmi2GetBoolean, fmi2SetBoolean: c_int = Boolean, whole, f64::from;
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetString(
    component: Component,
    references: References,
    count: usize,
    _values: *mut *const c_char,
) -> c_int {
    done(component, "fmi2GetString", |_| none_of_kind("String", references, count))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetString(
    component: Component,
    references: References,
    count: usize,
    _values: *const *const c_char,
) -> c_int {
    done(component, "fmi2SetString", |_| none_of_kind("String", references, count))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetFMUstate(component: Component, state: *mut *mut c_void) -> c_int {
    done(component, "fmi2GetFMUstate", |instance| kept(instance, state))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetFMUstate(component: Component, state: *mut c_void) -> c_int {
    done(component, "fmi2SetFMUstate", |instance| instance.restore(&State::at(state)?.saved))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut *mut c_void) -> c_int {
    done(component, "fmi2FreeFMUstate", |_| dropped(state))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SerializedFMUstateSize(
    component: Component,
    state: *mut c_void,
    bytes: *mut usize,
) -> c_int {
    done(component, "fmi2SerializedFMUstateSize", |instance| size(instance, state, bytes))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    done(component, "fmi2SerializeFMUstate", |instance| serialized(instance, state, bytes, size))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    done(component, "fmi2DeSerializeFMUstate", |instance| {
        deserialized(instance, bytes, size, state)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    references: References,
    count: usize,
    orders: *const c_int,
    values: *const f64,
) -> c_int {
    done(component, "fmi2SetRealInputDerivatives", |instance| {
        let references = Given::new("vr", references, count)?;
        let (orders, values) =
            (Given::new("order", orders, count)?, Given::new("value", values, count)?);
        if let Some(order) = orders.iter().find(|order| *order != 1) {
            return Err(format!(
                "derivatives of order {order} are not taken, those of order 1 are"
            ));
        }
        for (reference, slope) in references.iter().zip(values.iter()) {
            instance.set_slope(instance.place(reference, Kind::Float64)?, slope)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(
    component: Component,
    from: f64,
    length: f64,
    _no_state_before: c_int,
) -> c_int {
    done(component, "fmi2DoStep", |instance| instance.step(from, length).map(|_| ()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2CancelStep(component: Component) -> c_int {
    refused(component, "fmi2CancelStep", "no step is under way: each ends before it returns")
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetRealStatus(component: Component, kind: c_int, value: *mut f64) -> c_int {
    if kind != LAST_SUCCESSFUL_TIME {
        return discarded(component, "fmi2GetRealStatus");
    }
    done(component, "fmi2GetRealStatus", |instance| {
        place("value", value)?.write(0, instance.time());
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetBooleanStatus(component: Component, kind: c_int, value: *mut c_int) -> c_int {
    if kind != TERMINATED {
        return discarded(component, "fmi2GetBooleanStatus");
    }
    done(component, "fmi2GetBooleanStatus", |_| {
        place("value", value)?.write(0, 0);
        Ok(())
    })
}

const NO_STATUS: &str = "there is no such status, since no step goes on behind a call";

/// The answer to a question after a status that there is not.
fn discarded(component: Component, function: &str) -> c_int {
    let status = refused(component, function, NO_STATUS);
    if Handle::at(component).is_some() { DISCARD } else { status }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetStatus(component: Component, _: c_int, _: *mut c_int) -> c_int {
    discarded(component, "fmi2GetStatus")
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetIntegerStatus(component: Component, _: c_int, _: *mut c_int) -> c_int {
    discarded(component, "fmi2GetIntegerStatus")
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetStringStatus(component: Component, _: c_int, _: *mut *const c_char) -> c_int {
    discarded(component, "fmi2GetStringStatus")
}

/// Functions of what this library has not.
macro_rules! unsupported {
    ($($function:ident($($type:ty),*): $why:expr;)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $function(component: Component $(, _: $type)*) -> c_int {
            refused(component, stringify!($function), $why)
        }
    )*};
}

const MODEL_EXCHANGE: &str = "it is for co-simulation only, not for model exchange";
const DERIVATIVES: &str = "derivatives are not provided";

unsupported! {
    fmi2GetDirectionalDerivative(References, usize, References, usize, *const f64, *mut f64): DERIVATIVES;
    fmi2GetRealOutputDerivatives(References, usize, *const c_int, *mut f64): DERIVATIVES;
    fmi2EnterEventMode(): MODEL_EXCHANGE;
    fmi2NewDiscreteStates(*mut c_void): MODEL_EXCHANGE;
    fmi2EnterContinuousTimeMode(): MODEL_EXCHANGE;
    fmi2CompletedIntegratorStep(c_int, *mut c_int, *mut c_int): MODEL_EXCHANGE;
    fmi2SetTime(f64): MODEL_EXCHANGE;
    fmi2SetContinuousStates(*const f64, usize): MODEL_EXCHANGE;
    fmi2GetDerivatives(*mut f64, usize): MODEL_EXCHANGE;
    fmi2GetEventIndicators(*mut f64, usize): MODEL_EXCHANGE;
    fmi2GetContinuousStates(*mut f64, usize): MODEL_EXCHANGE;
    fmi2GetNominalsOfContinuousStates(*mut f64, usize): MODEL_EXCHANGE;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_read_from_its_uri() {
        for (uri, path) in [
            ("file:///a/b%20c/d", "/a/b c/d"),
            ("file:/a/b", "/a/b"),
            ("file://localhost/a", "/a"),
            ("file:///a/100%", "/a/100%"),
            ("file:///a/%c3%a9", "/a/é"),
            ("file://", ""),
        ] {
            assert_eq!(folder_of(uri), Ok(PathBuf::from(path)), "{uri}");
        }
        assert!(folder_of("http://a/b").is_err() && folder_of("file:///%ff").is_err());
    }
}
