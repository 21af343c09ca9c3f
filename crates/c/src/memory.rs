//! Memory of the caller: read and written only through these, which refuse what can be seen to be wrong.

use std::ffi::{CStr, c_char};

/// Refuse a pointer to `count` values that is none.
fn checked<T>(name: &str, pointer: *const T, count: usize) -> Result<(), String> {
    if count == 0 {
        return Ok(());
    }
    if pointer.is_null() {
        return Err(format!("{name} is null"));
    }
    let size = size_of::<T>().checked_mul(count).filter(|size| isize::try_from(*size).is_ok());
    if !pointer.is_aligned() || size.is_none() {
        return Err(format!("{name} is no array of {count} values"));
    }
    Ok(())
}

/// An array of the caller to read from.
pub struct Given<T> {
    pointer: *const T,
    count: usize,
}

impl<T: Copy> Given<T> {
    pub fn new(name: &str, pointer: *const T, count: usize) -> Result<Self, String> {
        checked(name, pointer, count)?;
        Ok(Self { pointer, count })
    }

    #[allow(unsafe_code)]
    pub fn iter(&self) -> impl Iterator<Item = T> {
        // SAFETY: the caller says that so many values are there, and the pointer was checked; nothing is kept
        (0..self.count).map(|i| unsafe { self.pointer.add(i).read() })
    }
}

/// An array of the caller to write to.
pub struct Asked<T> {
    pointer: *mut T,
    count: usize,
}

impl<T> Asked<T> {
    pub fn new(name: &str, pointer: *mut T, count: usize) -> Result<Self, String> {
        checked(name, pointer, count)?;
        Ok(Self { pointer, count })
    }

    #[allow(unsafe_code)]
    pub fn write(&self, index: usize, value: T) {
        if index < self.count {
            // SAFETY: as for what is read
            unsafe { self.pointer.add(index).write(value) };
        }
    }
}

/// One value of the caller to write to.
pub fn place<T>(name: &str, pointer: *mut T) -> Result<Asked<T>, String> {
    Asked::new(name, pointer, 1)
}

/// A text of the caller.
#[allow(unsafe_code)]
pub fn text<'a>(name: &str, pointer: *const c_char) -> Result<&'a str, String> {
    checked(name, pointer, 1)?;
    // SAFETY: the caller says that it ends in a nul; it is used within the call only
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| format!("{name} is not in UTF-8"))
}

/// Length of two arrays that belong together.
pub fn same_length(one: usize, other: usize) -> Result<(), String> {
    if one == other { Ok(()) } else { Err(format!("{one} value references, but {other} values")) }
}
