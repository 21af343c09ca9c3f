//! What a caller holds: an instance behind a pointer, where its words go, and the state that it saved.
//!
//! Nothing is shared between handles, so that each may be used by a thread of its own. A call on one that is at work in
//! another call is refused, and so is every call after a fault of the library itself; no panic leaves a call.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};

use crate::instance::{Instance, Saved};
use crate::measured::Crossing;

/// What stands at the beginning of a handle and of a saved state, as long as it is one.
const OF_HANDLE: u64 = 0x6865_7273_6579_2d31;
const OF_STATE: u64 = 0x6865_7273_6579_2d32;

/// Logger of version 3 of the standard.
pub type Logger3 = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
/// Logger of version 2: the message is a format, and may be followed by what it names.
pub type Logger2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// Where words to the caller go.
pub enum Words {
    Version3 {
        logger: Option<Logger3>,
        environment: *mut c_void,
    },
    Version2 {
        logger: Option<Logger2>,
        environment: *mut c_void,
        name: CString,
    },
    /// Kept until the next call, for who asks.
    Kept(Kept),
}

/// Why the last call was refused, and of what the last steps warn.
#[derive(Default)]
pub struct Kept {
    refusal: Mutex<CString>,
    warning: Mutex<CString>,
}

/// What words to the caller are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    Warning,
    Error,
}

impl Severity {
    /// Status and category under which they go to a logger.
    fn status(self) -> (c_int, &'static CStr) {
        match self {
            Self::Warning => (1, c"logStatusWarning"),
            Self::Error => (3, c"logStatusError"),
        }
    }
}

impl Words {
    /// Tell why a call was refused, or what is odd though it goes on; without a logger nobody hears of it.
    #[allow(unsafe_code)] // a function of the caller is called, as the standard has it
    pub fn tell(&self, severity: Severity, words: &str) {
        let (status, category) = severity.status();
        let text = CString::new(words.replace('\0', " ")).unwrap_or_default();
        match self {
            Self::Version3 { logger, environment } => {
                if let Some(logger) = logger {
                    // SAFETY: the caller gave function and environment for this
                    unsafe { logger(*environment, status, category.as_ptr(), text.as_ptr()) };
                }
            }
            Self::Version2 { logger, environment, name } => {
                let format = CString::new(words.replace(['\0', '%'], " ")).unwrap_or_default();
                if let Some(logger) = logger {
                    // SAFETY: as above; the format names no argument
                    unsafe {
                        logger(
                            *environment,
                            name.as_ptr(),
                            status,
                            category.as_ptr(),
                            format.as_ptr(),
                        );
                    }
                }
            }
            Self::Kept(kept) => {
                *kept.of(severity).lock().unwrap_or_else(PoisonError::into_inner) = text;
            }
        }
    }
}

impl Kept {
    fn of(&self, severity: Severity) -> &Mutex<CString> {
        match severity {
            Severity::Warning => &self.warning,
            Severity::Error => &self.refusal,
        }
    }
}

/// An instance and what belongs to it; the mark comes first.
#[repr(C)]
pub struct Handle {
    mark: AtomicU64,
    words: Words,
    instance: Mutex<Instance>,
}

/// Whether a pointer of the caller leads to a mark.
#[allow(unsafe_code)]
fn is_marked(pointer: *const c_void, mark: u64) -> bool {
    let first = pointer.cast::<AtomicU64>();
    if first.is_null() || !first.is_aligned() {
        return false;
    }
    // SAFETY: a caller passes what it was given and did not give back; of what else it may pass, much lacks the mark
    unsafe { &*first }.load(Ordering::Relaxed) == mark
}

/// A call was refused; why has been told.
pub struct Refused;

const FAULT: &str =
    "a fault inside of hersey, which may be reported: this instance can only be freed";
const BUSY: &str = "the instance is at work in another call";

impl Handle {
    /// A pointer to a new handle, or null if there is no instance, and why has been told.
    pub fn created(words: Words, make: impl FnOnce() -> Result<Instance, String>) -> *mut c_void {
        match catch_unwind(AssertUnwindSafe(make)).unwrap_or_else(|_| Err(FAULT.to_owned())) {
            Ok(instance) => {
                let mark = AtomicU64::new(OF_HANDLE);
                let handle = Self { mark, words, instance: Mutex::new(instance) };
                Box::into_raw(Box::new(handle)).cast()
            }
            Err(why) => {
                words.tell(Severity::Error, &why);
                std::ptr::null_mut()
            }
        }
    }

    /// What `pointer` points to, if that is a handle.
    #[allow(unsafe_code)]
    pub fn at<'a>(pointer: *const c_void) -> Option<&'a Self> {
        // SAFETY: the mark says that it was created above and is not yet freed
        is_marked(pointer, OF_HANDLE).then(|| unsafe { &*pointer.cast::<Self>() })
    }

    /// Do something with the instance; `function` is the name by which it was asked for.
    ///
    /// What it warns of is told once the instance is free again.
    pub fn call<T>(
        &self,
        function: &str,
        action: impl FnOnce(&mut Instance) -> Result<T, String>,
    ) -> Result<T, Refused> {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            // a guard that is dropped by a panic marks the instance for good
            let mut instance = self.instance.try_lock().map_err(|error| match error {
                TryLockError::Poisoned(_) => FAULT.to_owned(),
                TryLockError::WouldBlock => BUSY.to_owned(),
            })?;
            let outcome = action(&mut instance);
            Ok((outcome, instance.take_crossings()))
        }));
        let outcome = outcome.unwrap_or_else(|_| Err(FAULT.to_owned()));
        let outcome = outcome.and_then(|(outcome, crossings)| {
            self.warn(function, &crossings);
            outcome
        });
        outcome.map_err(|why| {
            self.words.tell(Severity::Error, &format!("{function}: {why}"));
            Refused
        })
    }

    /// Tell what has left the range in which the law was measured: each by itself, or all at once where they are kept.
    fn warn(&self, function: &str, crossings: &[Crossing]) {
        let lines: Vec<String> =
            crossings.iter().map(|crossing| format!("{function}: {crossing}")).collect();
        if matches!(self.words, Words::Kept(_)) && !lines.is_empty() {
            self.words.tell(Severity::Warning, &lines.join("\n"));
            return;
        }
        for line in &lines {
            self.words.tell(Severity::Warning, line);
        }
    }

    /// Forget the warnings that are kept.
    pub fn forget_warning(&self) {
        if matches!(self.words, Words::Kept(_)) {
            self.words.tell(Severity::Warning, "");
        }
    }

    /// The last words of a kind, if they are kept.
    pub fn kept(&self, severity: Severity) -> *const c_char {
        match &self.words {
            Words::Kept(kept) => {
                kept.of(severity).lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
            }
            _ => std::ptr::null(),
        }
    }

    /// Give it back.
    #[allow(unsafe_code)]
    pub fn freed(pointer: *mut c_void) {
        if let Some(handle) = Self::at(pointer) {
            handle.mark.store(0, Ordering::Relaxed);
            // SAFETY: it was made by a box, and its mark, now gone, said that it is not yet freed
            drop(unsafe { Box::from_raw(pointer.cast::<Self>()) });
        }
    }
}

/// A state that a caller keeps.
#[repr(C)]
pub struct State {
    mark: AtomicU64,
    pub saved: Saved,
}

impl State {
    pub fn created(saved: Saved) -> *mut c_void {
        Box::into_raw(Box::new(Self { mark: AtomicU64::new(OF_STATE), saved })).cast()
    }

    /// The state at `pointer`, if there is one.
    #[allow(unsafe_code)]
    pub fn at<'a>(pointer: *const c_void) -> Result<&'a Self, String> {
        if is_marked(pointer, OF_STATE) {
            // SAFETY: as for handles
            return Ok(unsafe { &*pointer.cast::<Self>() });
        }
        Err("there is no saved state at the pointer".to_owned())
    }

    #[allow(unsafe_code)]
    pub fn freed(pointer: *mut c_void) -> Result<(), String> {
        Self::at(pointer)?.mark.store(0, Ordering::Relaxed);
        // SAFETY: as for handles
        drop(unsafe { Box::from_raw(pointer.cast::<Self>()) });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::BASELINE;

    #[test]
    fn a_fault_inside_ends_the_instance_and_nothing_else() {
        let words = || Words::Kept(Kept::default());
        let [one, other] = [(); 2].map(|()| Handle::created(words(), || Instance::new(BASELINE)));
        let handle = Handle::at(one).unwrap();
        assert!(handle.call("whole", |_| Ok(())).is_ok());
        assert!(handle.call::<()>("faulty", |_| panic!("on purpose, for the test")).is_err());
        assert!(handle.call("after", |_| Ok(())).is_err());
        #[allow(unsafe_code)] // SAFETY: words kept until the next call
        let kept = unsafe { CStr::from_ptr(handle.kept(Severity::Error)) };
        assert_eq!(kept.to_str(), Ok(&*format!("after: {FAULT}")));
        assert!(Handle::at(other).unwrap().call("whole", |_| Ok(())).is_ok());
        Handle::freed(one);
        Handle::freed(other);
        assert!(Handle::created(words(), || panic!("on purpose, for the test")).is_null());
    }

    #[test]
    fn an_instance_at_work_is_not_entered_again() {
        let words = Words::Kept(Kept::default());
        let pointer = Handle::created(words, || Instance::new(BASELINE));
        let handle = Handle::at(pointer).unwrap();
        let inner = handle.call("outer", |_| Ok(handle.call("inner", |_| Ok(())).is_err()));
        assert!(matches!(inner, Ok(true)));
        assert!(handle.call("later", |_| Ok(())).is_ok());
        Handle::freed(pointer);
    }

    #[test]
    fn what_is_no_handle_is_not_taken_for_one() {
        let state = State::created(Instance::new(BASELINE).unwrap().saved());
        assert!(Handle::at(state).is_none() && Handle::at(std::ptr::null()).is_none());
        assert!(Handle::at(std::ptr::without_provenance(3)).is_none());
        assert!(State::at(std::ptr::null()).is_err() && State::freed(state).is_ok());
    }
}
