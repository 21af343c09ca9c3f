//! All of a motion that changes, as numbers.

use super::piece::Phase;
use super::schedule::Cubic;
use crate::drag::Mode;
use crate::error::{Error, above, at_least, at_most, finite};

/// Where a motion stands: its state at the start of the smooth piece under way, the time that it has reached there, and
/// what drives it.
///
/// A motion made from it goes on to the last bit as the one that it was taken from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    pub(super) phase: Phase,
    /// When the piece under way has begun.
    pub(super) start: f64,
    /// The time reached.
    pub(super) time: f64,
    /// Segments of the schedules of drive and temperature.
    pub(super) segments: [usize; 2],
    /// Length that the next Runge-Kutta step should have; infinite where nothing is known.
    pub(super) next_step: f64,
    pub(super) events_at_once: u32,
    pub(super) crawled: u32,
    /// Drive and temperature: since when, and the course from there. None where they are those that the motion began
    /// with, and in a saved moment only where those are no one value.
    pub(super) drive: Option<(f64, Cubic)>,
    pub(super) temperature: Option<(f64, Cubic)>,
}

const MODES: [Mode; 4] = [Mode::Ehl, Mode::Mixed, Mode::Microslip, Mode::Stuck];

/// What the numbers are called, in their order.
const NAMES: [&str; Moment::NUMBERS] = [
    "layout of a moment",
    "start of the piece under way",
    "time",
    "mode",
    "branch",
    "released",
    "creeping",
    "slipping",
    "time since when at rest",
    "strength",
    "direction",
    "pull",
    "belt_speed",
    "bristle",
    "next step",
    "events at once",
    "pieces without progress",
    "segment of the drive",
    "segment of the temperature",
    "drive given",
    "time since when driven so",
    "drive",
    "slope of the drive",
    "second coefficient of the drive",
    "third coefficient of the drive",
    "temperature given",
    "time since when as warm",
    "temperature",
    "slope of the temperature",
    "second coefficient of the temperature",
    "third coefficient of the temperature",
];

/// The first number, by which others of another layout are told.
const LAYOUT: f64 = 2.0;

impl Moment {
    /// How many numbers a moment is.
    pub const NUMBERS: usize = 31;

    /// The time reached.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The moment as finite numbers, which `from_numbers` takes back without loss.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // branches and segments are few
    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let flag = |set: bool| f64::from(u8::from(set));
        let Phase { mode, branch, released, creeping, slipping, .. } = self.phase;
        let Phase { at_rest_since, strength, direction, pull, speed, bristle, .. } = self.phase;
        let next_step = if self.next_step.is_finite() { self.next_step } else { 0.0 };
        let [drive_segment, temperature_segment] = self.segments.map(|segment| segment as f64);
        let (driven, drive) = self.drive.unwrap_or_default();
        let (warmed, temperature) = self.temperature.unwrap_or_default();
        [
            LAYOUT,
            self.start,
            self.time,
            f64::from(mode as u8),
            branch as f64,
            flag(released),
            flag(creeping),
            flag(slipping),
            at_rest_since,
            strength,
            direction,
            pull,
            speed,
            bristle,
            next_step,
            f64::from(self.events_at_once),
            f64::from(self.crawled),
            drive_segment,
            temperature_segment,
            flag(self.drive.is_some()),
            driven,
            drive[0],
            drive[1],
            drive[2],
            drive[3],
            flag(self.temperature.is_some()),
            warmed,
            temperature[0],
            temperature[1],
            temperature[2],
            temperature[3],
        ]
    }

    /// The moment that these numbers are.
    ///
    /// # Errors
    /// If they are not as many, one is not finite, or one is nothing that a motion can have.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self, Error> {
        let quantity = "numbers of a moment";
        let Ok(n) = <&[f64; Self::NUMBERS]>::try_from(numbers) else {
            if numbers.len() < Self::NUMBERS {
                return Err(Error::TooFew { quantity, needed: Self::NUMBERS });
            }
            #[allow(clippy::cast_precision_loss)] // counts for the message
            let (value, limit) = (numbers.len() as f64, Self::NUMBERS as f64);
            return Err(Error::TooLarge { quantity, value, limit });
        };
        for (name, number) in NAMES.iter().zip(n) {
            finite(name, *number)?;
        }
        at_most(NAMES[0], at_least(NAMES[0], n[0], LAYOUT)?, LAYOUT)?;
        at_least(NAMES[2], n[2], n[1])?;
        at_least(NAMES[14], n[14], 0.0)?;
        above(NAMES[9], n[9], 0.0)?;
        let backwards = count(10, 0.5 * (n[10] + 1.0), 1)? == 0;
        let flag = |i: usize| count(i, n[i], 1).map(|flag| flag == 1);
        let course = |i: usize| {
            let course = (n[i + 1], [n[i + 2], n[i + 3], n[i + 4], n[i + 5]]);
            flag(i).map(|given| given.then_some(course))
        };
        Ok(Self {
            phase: Phase {
                mode: MODES[count(3, n[3], 3)? as usize],
                branch: count(4, n[4], u32::MAX)? as usize,
                released: flag(5)?,
                creeping: flag(6)?,
                slipping: flag(7)?,
                at_rest_since: n[8],
                strength: n[9],
                direction: if backwards { -1.0 } else { 1.0 },
                pull: n[11],
                speed: n[12],
                bristle: n[13],
            },
            start: n[1],
            time: n[2],
            segments: [count(17, n[17], u32::MAX)? as usize, count(18, n[18], u32::MAX)? as usize],
            next_step: if n[14] == 0.0 { f64::INFINITY } else { n[14] },
            events_at_once: count(15, n[15], u32::MAX)?,
            crawled: count(16, n[16], u32::MAX)?,
            drive: course(19)?,
            temperature: course(25)?,
        })
    }
}

/// Number `i` as one to count with, up to `most`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within range, and whole
fn count(i: usize, number: f64, most: u32) -> Result<u32, Error> {
    at_most(NAMES[i], at_least(NAMES[i], number, 0.0)?, f64::from(most))?;
    if number.fract() == 0.0 {
        Ok(number as u32)
    } else {
        Err(Error::TooLarge { quantity: NAMES[i], value: number, limit: number.floor() })
    }
}
