//! The buffers that the page writes and reads; one page, one thread, one question at a time.

use std::cell::RefCell;

use crate::question::Question;
use crate::refusal::Refusal;

#[derive(Default)]
struct Buffers {
    question: Vec<f64>,
    answer: Vec<f64>,
    refusal: String,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

/// Room for so many numbers, of which none is left from the question before.
pub fn ask(length: usize) -> *mut f64 {
    BUFFERS.with_borrow_mut(|buffers| {
        buffers.question.clear();
        buffers.question.resize(length, f64::NAN);
        buffers.question.as_mut_ptr()
    })
}

pub fn answer() -> *const f64 {
    BUFFERS.with_borrow(|buffers| buffers.answer.as_ptr())
}

pub fn refusal() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.refusal.as_ptr())
}

/// Length of whichever of the two there is.
pub fn length() -> usize {
    BUFFERS.with_borrow(|buffers| buffers.answer.len().max(buffers.refusal.len()))
}

/// Let `function` answer the question; whether it refused.
pub fn answered(function: fn(&mut Question) -> Result<Vec<f64>, Refusal>) -> u32 {
    BUFFERS.with_borrow_mut(|buffers| {
        // what was answered before is given back first
        (buffers.answer, buffers.refusal) = (Vec::new(), String::new());
        match function(&mut Question::new(&buffers.question)) {
            Ok(answer) => {
                buffers.answer = answer;
                0
            }
            Err(refusal) => {
                buffers.refusal = refusal.json();
                1
            }
        }
    })
}

/// Put words where those of a refusal stand.
pub fn say(words: String) {
    BUFFERS.with_borrow_mut(|buffers| {
        (buffers.answer, buffers.refusal) = (Vec::new(), words);
    });
}
