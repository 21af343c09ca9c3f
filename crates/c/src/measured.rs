//! Whether a motion is still where its law was measured; leaving that range is reported once.

use std::fmt;

use crate::description::Measured;

/// Share of its width by which a quantity must be back inside its range before it is reported again.
const BACK: f64 = 0.01;

/// A quantity that is watched, in its place among the marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watched {
    /// Speed of the drive, each time that it leaves the range; a drive that stands is no extrapolation.
    Drive,
    /// Temperature, each time.
    Temperature,
    /// Belt speed above the range, once a run: a belt that slips would be reported every lap.
    Belt,
}

impl Watched {
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Drive => ("the speed of the drive", "m/s"),
            Self::Temperature => ("the temperature", "K"),
            Self::Belt => ("the belt speed", "m/s"),
        }
    }
}

/// Which of them have left their range.
pub type Outside = [bool; 3];

/// A quantity has left the range in which the law was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    pub watched: Watched,
    pub time: f64,
    pub value: f64,
    pub range: [f64; 2],
}

/// A number to six digits.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plain = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        write!(f, "{plain}")
    }
}

impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { watched, range: [low, high], .. } = self;
        let (name, unit) = watched.words();
        let (time, value) = (Short(self.time), Short(self.value));
        let (low, high) = (Short(*low), Short(*high));
        write!(
            f,
            "{name} is {value} {unit} at {time} s; drag is known from {low} to {high} {unit}, and is extrapolated"
        )
    }
}

impl Measured {
    /// Mark whether a quantity is outside of its range, and return the range if it has just left it.
    ///
    /// A value that is none is inside.
    pub fn left(&self, outside: &mut Outside, watched: Watched, value: f64) -> Option<[f64; 2]> {
        let range = if watched == Watched::Temperature { self.temperature } else { self.speed };
        let [low, high] = range?;
        let (value, margin) = (value.abs(), BACK * (high - low));
        let (is_below, is_back) = match watched {
            Watched::Drive => (value > 0.0 && value < low, value == 0.0 || value >= low + margin),
            Watched::Temperature => (value < low, value >= low + margin),
            Watched::Belt => (false, false),
        };
        let mark = &mut outside[watched as usize];
        if *mark {
            *mark = !(is_back && value <= high - margin);
            return None;
        }
        *mark = is_below || value > high;
        mark.then_some([low, high])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGES: Measured =
        Measured { speed: Some([0.1, 1.1]), temperature: Some([300.0, 400.0]) };

    fn reported(watched: Watched, values: &[f64]) -> Vec<bool> {
        let mut outside = Outside::default();
        values.iter().map(|value| RANGES.left(&mut outside, watched, *value).is_some()).collect()
    }

    #[test]
    fn each_crossing_is_reported_once() {
        let values = [350.0, 401.0, 402.0, 399.5, 401.0, 350.0, 299.0, 450.0, 350.0, 401.0];
        let expected = [false, true, false, false, false, false, true, false, false, true];
        assert_eq!(reported(Watched::Temperature, &values), expected);
    }

    #[test]
    fn a_drive_that_stands_is_inside_and_its_direction_does_not_matter() {
        let values = [0.0, 0.05, 0.5, -1.0, -1.2, 0.0, 1.2];
        let expected = [false, true, false, false, true, false, true];
        assert_eq!(reported(Watched::Drive, &values), expected);
    }

    #[test]
    fn a_belt_that_slips_again_and_again_is_reported_once_a_run() {
        let values = [0.0, 0.01, 1.2, 0.0, 0.5, 1.2];
        assert_eq!(reported(Watched::Belt, &values), [false, false, true, false, false, false]);
    }

    #[test]
    fn nothing_is_reported_without_a_range() {
        let mut outside = Outside::default();
        assert_eq!(Measured::default().left(&mut outside, Watched::Drive, 1e9), None);
    }

    #[test]
    fn a_crossing_says_what_is_where() {
        let crossing = Crossing {
            watched: Watched::Temperature,
            time: 0.25,
            value: 481.123_456_7,
            range: [363.15, 453.15],
        };
        assert_eq!(
            crossing.to_string(),
            "the temperature is 481.123 K at 0.25 s; drag is known from 363.15 to 453.15 K, and is extrapolated"
        );
    }
}
