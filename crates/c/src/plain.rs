//! Plain functions for C, as `include/hersey.h` declares and explains them.

#![allow(unsafe_code)] // the names, and what the caller's pointers point to

use std::ffi::{CStr, c_char, c_int, c_void};

use crate::exchange::asked;
use crate::handle::{Handle, Kept, Severity, Words};
use crate::instance::{Instance, Phase};
use crate::memory::{Asked, Given, place, text};
use crate::saving;
use crate::variables::{as_text, place_of};

type Drive = *mut c_void;

/// Version, with the nul at its end.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");

const NO_DRIVE: &CStr = c"there is no drive at the pointer";

/// What a function returns: it did, it came to a change of mode before, it refused.
const DONE: c_int = 0;
const CHANGED: c_int = 1;
const REFUSED: c_int = -1;

#[unsafe(no_mangle)]
extern "C" fn hersey_version() -> *const c_char {
    VERSION.as_ptr().cast()
}

#[unsafe(no_mangle)]
extern "C" fn hersey_variables() -> *const c_char {
    as_text().as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn hersey_drive_read(
    description: *const c_char,
    why: *mut c_char,
    room: usize,
) -> Drive {
    let mut refusal = String::new();
    let words = Words::Kept(Kept::default());
    let drive = Handle::created(words, || {
        let read = text("text", description).and_then(Instance::new);
        read.inspect_err(|why| refusal.clone_from(why))
    });
    if let (true, Ok(why)) = (drive.is_null() && room > 0, Asked::new("why", why, room)) {
        let kept = refusal.bytes().take(room - 1).chain([0]);
        for (index, byte) in kept.enumerate() {
            why.write(index, byte.cast_signed());
        }
    }
    drive
}

#[unsafe(no_mangle)]
extern "C" fn hersey_why(drive: Drive) -> *const c_char {
    Handle::at(drive).map_or(NO_DRIVE.as_ptr(), |handle| handle.kept(Severity::Error))
}

#[unsafe(no_mangle)]
extern "C" fn hersey_warning(drive: Drive) -> *const c_char {
    Handle::at(drive).map_or(NO_DRIVE.as_ptr(), |handle| handle.kept(Severity::Warning))
}

#[unsafe(no_mangle)]
extern "C" fn hersey_free(drive: Drive) {
    Handle::freed(drive);
}

fn done(
    drive: Drive,
    function: &str,
    action: impl FnOnce(&mut Instance) -> Result<(), String>,
) -> c_int {
    asked(drive, function, action).map_or(REFUSED, |()| DONE)
}

/// Steps warn of what has happened in them alone.
fn forget_warning(drive: Drive) {
    if let Some(handle) = Handle::at(drive) {
        handle.forget_warning();
    }
}

/// Place of a variable that the drive has.
fn place_in(instance: &Instance, name: *const c_char) -> Result<usize, String> {
    let name = text("name", name)?;
    let place = place_of(name).filter(|place| instance.has(*place));
    place.ok_or_else(|| format!("the drive has no variable '{name:.40}'"))
}

#[unsafe(no_mangle)]
extern "C" fn hersey_set(drive: Drive, name: *const c_char, value: f64) -> c_int {
    done(drive, "hersey_set", |instance| instance.set(place_in(instance, name)?, value))
}

#[unsafe(no_mangle)]
extern "C" fn hersey_slope(drive: Drive, name: *const c_char, slope: f64) -> c_int {
    done(drive, "hersey_slope", |instance| instance.set_slope(place_in(instance, name)?, slope))
}

#[unsafe(no_mangle)]
extern "C" fn hersey_get(drive: Drive, name: *const c_char, value: *mut f64) -> c_int {
    done(drive, "hersey_get", |instance| {
        let value = place("value", value)?;
        value.write(0, instance.get(place_in(instance, name)?)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn hersey_begin(drive: Drive, time: f64) -> c_int {
    forget_warning(drive);
    done(drive, "hersey_begin", |instance| {
        instance.set_up(time, None, None)?;
        instance.begin(Phase::Step)
    })
}

#[unsafe(no_mangle)]
extern "C" fn hersey_advance(drive: Drive, until: f64, stop_at_changes: c_int) -> c_int {
    forget_warning(drive);
    let reached = asked(drive, "hersey_advance", |instance| {
        instance.advance(until, 0.0, stop_at_changes != 0)
    });
    reached.map_or(REFUSED, |reached| if reached.early { CHANGED } else { DONE })
}

fn bytes(instance: &Instance) -> Vec<u8> {
    saving::written(&instance.saved(), instance.identity().0)
}

#[unsafe(no_mangle)]
extern "C" fn hersey_saved_size(drive: Drive) -> usize {
    asked(drive, "hersey_saved_size", |instance| Ok(bytes(instance).len())).unwrap_or(0)
}

#[unsafe(no_mangle)]
extern "C" fn hersey_save(drive: Drive, to: *mut u8, size: usize) -> c_int {
    done(drive, "hersey_save", |instance| {
        let bytes = bytes(instance);
        if size < bytes.len() {
            return Err(format!("{} bytes are needed, there are {size}", bytes.len()));
        }
        let to = Asked::new("bytes", to, size)?;
        for (index, byte) in bytes.iter().enumerate() {
            to.write(index, *byte);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn hersey_restore(drive: Drive, from: *const u8, size: usize) -> c_int {
    done(drive, "hersey_restore", |instance| {
        let bytes: Vec<u8> = Given::new("bytes", from, size)?.iter().collect();
        instance.restore(&saving::read(&bytes, instance.identity().0)?)
    })
}
