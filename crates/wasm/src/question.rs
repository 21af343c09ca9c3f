//! A question read number by number, in the order in which the page wrote it.

use hersey_core::drag::Drag;
use hersey_core::motion::{Drivetrain, Start};
use hersey_core::{Error, Work};

use crate::refusal::Refusal;

/// Most numbers of one list of a question or of an answer, for the memory of a page: half a gigabyte in all.
pub const MOST: usize = 4_000_000;

/// The numbers that are not yet read.
pub struct Question<'a> {
    left: &'a [f64],
}

impl<'a> Question<'a> {
    pub fn new(numbers: &'a [f64]) -> Self {
        Self { left: numbers }
    }

    pub fn number(&mut self) -> Result<f64, Refusal> {
        let (first, rest) =
            self.left.split_first().ok_or(Refusal::Malformed("the question ends too early"))?;
        self.left = rest;
        Ok(*first)
    }

    pub fn numbers<const N: usize>(&mut self) -> Result<[f64; N], Refusal> {
        let mut found = [0.0; N];
        for place in &mut found {
            *place = self.number()?;
        }
        Ok(found)
    }

    /// A number, none if it is not given.
    pub fn given(&mut self) -> Result<Option<f64>, Refusal> {
        Ok(Some(self.number()?).filter(|number| !number.is_nan()))
    }

    /// A number that counts.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub fn count(&mut self, quantity: &'static str) -> Result<usize, Refusal> {
        let (value, limit) = (self.number()?, MOST as f64);
        if !(value >= 0.0 && value.fract() == 0.0) {
            return Err(Refusal::Malformed("a count is negative or broken"));
        }
        if value > limit {
            Err(Error::TooLarge { quantity, value, limit }.into())
        } else {
            Ok(value as usize)
        }
    }

    /// One of some kinds, by its place among them.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // anything else is none of them
    pub fn one_of<K>(&mut self, kinds: impl IntoIterator<Item = K>) -> Result<K, Refusal> {
        let place = self.number()?;
        let known = place >= 0.0 && place.fract() == 0.0;
        let kind = known.then(|| kinds.into_iter().nth(place as usize)).flatten();
        kind.ok_or(Refusal::Malformed("a choice of no known kind"))
    }

    pub fn flag(&mut self) -> Result<bool, Refusal> {
        Ok(self.number()? != 0.0)
    }

    /// So many numbers as the first says.
    pub fn list(&mut self) -> Result<&'a [f64], Refusal> {
        let count = self.count("numbers of a list")?;
        let (list, rest) = self
            .left
            .split_at_checked(count)
            .ok_or(Refusal::Malformed("the question ends too early"))?;
        self.left = rest;
        Ok(list)
    }

    /// Steps that are allowed.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a float becomes the nearest number of steps
    pub fn work(&mut self) -> Result<Work<'static>, Refusal> {
        Ok(Work::unwatched(self.number()? as u64))
    }

    /// Stiffness, mass, grip (or none).
    pub fn train(&mut self) -> Result<Drivetrain, Refusal> {
        let [stiffness, mass] = self.numbers()?;
        let train = Drivetrain::new(stiffness, mass)?;
        let grip = self.given()?;
        Ok(grip.map_or(Ok(train), |grip| train.with_grip(grip))?)
    }

    /// 0 at rest, 1 sliding steadily at `speed`, 2 the same but for a nudge, 3 as the two numbers that follow say: belt
    /// speed and stretch.
    pub fn start(&mut self, train: &Drivetrain, drag: &Drag, speed: f64) -> Result<Start, Refusal> {
        let [kind, belt_speed, stretch] = self.numbers()?;
        match kind {
            0.0 => Ok(Start::REST),
            1.0 => Ok(Start::steady(train, drag, speed)?),
            2.0 => Ok(Start::steady(train, drag, speed)?.nudged()),
            3.0 => Ok(Start { belt_speed, stretch }),
            _ => Err(Refusal::Malformed("a start of no known kind")),
        }
    }
}
