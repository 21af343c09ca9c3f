//! How much work a computation may do, and whether anybody still waits for it.
//!
//! Work is counted in steps: one is a Taylor step of a motion, about a microsecond, and what costs more counts for
//! more. No clock takes part, so that the same input ends in the same way on every machine. Whether to stop is asked
//! of the caller every so many steps; that alone may depend on the time.

use std::cell::Cell;

use crate::error::Error;

/// Steps of one motion, or of the way to one film, unless the caller allows others: some seconds.
pub const MOST_STEPS: u64 = 5_000_000;

/// Steps between two questions whether to stop.
const BETWEEN: u64 = 256;

/// The steps that are allowed, those that are done, and the question whether to stop.
pub struct Work<'a> {
    allowed: u64,
    done: Cell<u64>,
    /// Steps at which is asked again.
    next_question: Cell<u64>,
    stop: Option<&'a dyn Fn() -> bool>,
}

impl<'a> Work<'a> {
    /// So many steps, unless `stop` tells otherwise before; once it has, it must go on to do so.
    #[must_use]
    pub fn new(allowed: u64, stop: &'a dyn Fn() -> bool) -> Self {
        Self { stop: Some(stop), ..Self::unwatched(allowed) }
    }

    /// So many steps, which nobody stops.
    #[must_use]
    pub fn unwatched(allowed: u64) -> Self {
        Self { allowed, done: Cell::new(0), next_question: Cell::new(0), stop: None }
    }

    /// Work of its own that the same question stops.
    #[must_use]
    pub fn apart(&self, allowed: u64) -> Self {
        Self { stop: self.stop, ..Self::unwatched(allowed) }
    }

    /// The steps that are allowed.
    #[must_use]
    pub fn allowed(&self) -> u64 {
        self.allowed
    }

    /// The steps that are done.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done.get()
    }

    /// The steps that are left.
    #[must_use]
    pub fn left(&self) -> u64 {
        self.allowed.saturating_sub(self.done.get())
    }

    /// Count `steps` more.
    ///
    /// # Errors
    /// `WorkSpent` if they are more than allowed, `Stopped` if nobody waits any longer.
    #[inline]
    pub fn take(&self, steps: u64) -> Result<(), Error> {
        let done = self.done.get().saturating_add(steps);
        self.done.set(done);
        if done >= self.next_question.get() {
            self.ask(done)?;
        }
        if done > self.allowed { Err(Error::WorkSpent { steps: self.allowed }) } else { Ok(()) }
    }

    #[cold]
    fn ask(&self, done: u64) -> Result<(), Error> {
        self.next_question.set(done.saturating_add(BETWEEN));
        if self.stop.is_some_and(|stop| stop()) { Err(Error::Stopped) } else { Ok(()) }
    }
}

impl Default for Work<'_> {
    fn default() -> Self {
        Self::unwatched(MOST_STEPS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_allowed_can_be_done_and_no_more() {
        let work = Work::unwatched(10);
        assert_eq!((work.take(4), work.take(6), work.left()), (Ok(()), Ok(()), 0));
        assert_eq!(work.take(1), Err(Error::WorkSpent { steps: 10 }));
        assert_eq!(work.take(u64::MAX), Err(Error::WorkSpent { steps: 10 }));
    }

    #[test]
    fn the_question_is_asked_at_once_and_then_now_and_then() {
        let asked = Cell::new(0);
        let stop = || {
            asked.set(asked.get() + 1);
            asked.get() > 2
        };
        let work = Work::new(u64::MAX, &stop);
        let steps = (0..9 * BETWEEN).take_while(|_| work.take(1).is_ok()).count();
        assert_eq!((u64::try_from(steps).unwrap(), asked.get()), (2 * BETWEEN, 3));
        assert_eq!(work.apart(5).take(1), Err(Error::Stopped));
    }
}
