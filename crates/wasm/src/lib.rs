//! The core in a page: every question is a buffer of numbers, and so is every answer.
//!
//! | module     | responsibility                                                     |
//! |------------|--------------------------------------------------------------------|
//! | `buffers`  | the buffer of the question, that of the answer, and its words      |
//! | `question` | numbers in the order in which they were asked, as drive and law    |
//! | `law`      | the law of drag of a question, and the names of its parts          |
//! | `answers`  | what each exported function computes: calls of the core, no more   |
//! | `refusal`  | an error of the core as JSON, with its fields                      |
//!
//! A page calls `hersey_question(n)`, writes `n` numbers where that points, calls one of the functions below, and reads
//! `hersey_answer_length()` numbers at `hersey_answer()` if it returned 0, else that many bytes of JSON at
//! `hersey_refusal()`. The order of the numbers stands at each function of `answers`; not a number says that a value
//! is not given. There are no imports, no clock and no default: how much work is allowed is the first number of
//! each question.

mod answers;
mod buffers;
mod law;
mod question;
mod refusal;

use answers::{bands, cycle, forces, law, motion, unstable};
use buffers::{answered, ask};

/// Room for a question of `length` numbers.
#[allow(unsafe_code)] // the name, here and below, is all that is unsafe
#[unsafe(no_mangle)]
pub extern "C" fn hersey_question(length: usize) -> *mut f64 {
    ask(length)
}

/// Where the answer is.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn hersey_answer() -> *const f64 {
    buffers::answer()
}

/// Write the names of which a law of drag is made, as JSON, to where the words of a refusal are.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn hersey_names() {
    buffers::say(law::names());
}

/// Where the words of a refusal are.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn hersey_refusal() -> *const u8 {
    buffers::refusal()
}

/// Numbers of the answer, or bytes of the refusal.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn hersey_answer_length() -> usize {
    buffers::length()
}

/// Functions that answer the question that was written: 0 if they did, 1 if they refused.
macro_rules! exported {
    ($($(#[$doc:meta])* $name:ident = $answer:ident;)*) => {$(
        $(#[$doc])*
        #[allow(unsafe_code)]
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> u32 {
            answered($answer)
        }
    )*};
}

exported! {
    /// The law of drag at its temperature.
    hersey_law = law;
    /// Steady drag at speeds.
    hersey_forces = forces;
    /// Motion at equally spaced times.
    hersey_motion = motion;
    /// What the motion settles to.
    hersey_cycle = cycle;
    /// Edges of the behaviour, of one belt or at many temperatures.
    hersey_bands = bands;
    /// The cycle between sliding and sticking.
    hersey_unstable = unstable;
}
