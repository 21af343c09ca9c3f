//! What both versions of the Functional Mock-up Interface share: values by reference, saved states, where a unit's own
//! description lies.

use std::ffi::c_void;
use std::fs;
use std::path::Path;

use crate::handle::{Handle, Refused, State};
use crate::instance::Instance;
use crate::memory::{Asked, Given, place, same_length};
use crate::saving;
use crate::variables::Kind;

/// Name of the description among the resources of a unit.
const DESCRIPTION: &str = "drive.txt";

/// Outcomes of a call, as both versions number them.
pub const OK: i32 = 0;
pub const DISCARD: i32 = 2;
pub const ERROR: i32 = 3;

/// Do something with the instance behind a pointer: a status for the caller.
pub fn done(
    instance: *mut c_void,
    function: &str,
    action: impl FnOnce(&mut Instance) -> Result<(), String>,
) -> i32 {
    let outcome = Handle::at(instance).map(|handle| handle.call(function, action));
    if let Some(Ok(())) = outcome { OK } else { ERROR }
}

/// The instance described among the resources at `folder`, for a tool that knows it by `token`.
pub fn instance_at(folder: &Path, token: Option<&str>) -> Result<Instance, String> {
    let path = folder.join(DESCRIPTION);
    let text = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let text = String::from_utf8(text).map_err(|_| format!("{}: not in UTF-8", path.display()))?;
    let instance = Instance::new(&text).map_err(|why| format!("{}: {why}", path.display()))?;
    match (instance.identity().1, token) {
        (Some(own), other) if other != Some(own) => {
            Err(format!("the token is {}, but that of the unit is {own}", other.unwrap_or("none")))
        }
        _ => Ok(instance),
    }
}

/// Values of variables of one kind, each written as `written` makes it.
pub fn got<T>(
    instance: &mut Instance,
    references: (*const u32, usize),
    values: (*mut T, usize),
    kind: Kind,
    written: impl Fn(f64) -> T,
) -> Result<(), String> {
    same_length(references.1, values.1)?;
    let references = Given::new("valueReferences", references.0, references.1)?;
    let values = Asked::new("values", values.0, values.1)?;
    for (index, reference) in references.iter().enumerate() {
        let place = instance.place(reference, kind)?;
        values.write(index, written(instance.get(place)?));
    }
    Ok(())
}

/// Set variables of one kind: all of them, or none if one is refused.
pub fn set<T: Copy>(
    instance: &mut Instance,
    references: (*const u32, usize),
    values: (*const T, usize),
    kind: Kind,
    read: impl Fn(T) -> f64,
) -> Result<(), String> {
    same_length(references.1, values.1)?;
    let references = Given::new("valueReferences", references.0, references.1)?;
    let values = Given::new("values", values.0, values.1)?;
    for (reference, value) in references.iter().zip(values.iter()) {
        instance.check(instance.place(reference, kind)?, read(value))?;
    }
    for (reference, value) in references.iter().zip(values.iter()) {
        instance.set(instance.place(reference, kind)?, read(value))?;
    }
    Ok(())
}

/// Refuse variables of a kind of which there are none.
pub fn none_of_kind(kind: &str, references: *const u32, count: usize) -> Result<(), String> {
    let references = Given::new("valueReferences", references, count)?;
    references.iter().next().map_or(Ok(()), |first| {
        Err(format!("no variable is {kind}, also not value reference {first}"))
    })
}

/// Keep the state of the instance, in place of the one that the caller may hold already.
pub fn kept(instance: &mut Instance, state: *mut *mut c_void) -> Result<(), String> {
    let place = place("FMUState", state)?;
    let held = Given::new("FMUState", state, 1)?.iter().next().filter(|held| !held.is_null());
    if let Some(held) = held {
        State::freed(held)?;
    }
    place.write(0, State::created(instance.saved()));
    Ok(())
}

/// Give a kept state back.
pub fn dropped(state: *mut *mut c_void) -> Result<(), String> {
    let place = place("FMUState", state)?;
    let held = Given::new("FMUState", state, 1)?.iter().next().filter(|held| !held.is_null());
    if let Some(held) = held {
        State::freed(held)?;
    }
    place.write(0, std::ptr::null_mut());
    Ok(())
}

fn bytes(instance: &Instance, state: *mut c_void) -> Result<Vec<u8>, String> {
    Ok(saving::written(&State::at(state)?.saved, instance.identity().0))
}

/// How many bytes a kept state has.
pub fn size(instance: &Instance, state: *mut c_void, size: *mut usize) -> Result<(), String> {
    place("size", size)?.write(0, bytes(instance, state)?.len());
    Ok(())
}

/// A kept state as bytes.
pub fn serialized(
    instance: &Instance,
    state: *mut c_void,
    to: *mut u8,
    size: usize,
) -> Result<(), String> {
    let bytes = bytes(instance, state)?;
    if size < bytes.len() {
        return Err(format!("{} bytes are needed, there are {size}", bytes.len()));
    }
    let to = Asked::new("serializedState", to, size)?;
    for (index, byte) in bytes.iter().enumerate() {
        to.write(index, *byte);
    }
    Ok(())
}

/// A kept state from bytes.
pub fn deserialized(
    instance: &mut Instance,
    from: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> Result<(), String> {
    let place = place("FMUState", state)?;
    let bytes: Vec<u8> = Given::new("serializedState", from, size)?.iter().collect();
    let saved = saving::read(&bytes, instance.identity().0)?;
    place.write(0, State::created(saved));
    Ok(())
}

/// A call that is refused: its instance says why.
pub fn refused(instance: *mut c_void, function: &str, why: &str) -> i32 {
    done(instance, function, |_| Err(why.to_owned()))
}

/// The instance behind a pointer, for what answers more than a status.
pub fn asked<T>(
    instance: *mut c_void,
    function: &str,
    action: impl FnOnce(&mut Instance) -> Result<T, String>,
) -> Result<T, Refused> {
    Handle::at(instance).ok_or(Refused)?.call(function, action)
}
