//! The description of a drive: text of lines `name = value`, read and checked.
//!
//! The format stands in `include/hersey.h`, for those who write it.

use crate::variables::{
    COUNT, Causality, DRIVE_SPEED, DRIVE_TORQUE, Port, ROLL_SPEED, TEMPERATURE, VARIABLES, place_of,
};
use hersey_core::drag::ClosureKind;
use hersey_core::drag::form::{Belongs, CHOICES, Kinds, LISTS, ShapeKind, TemperatureKind};
use hersey_core::wire::Unreadable;
use hersey_core::work::MOST_STEPS;

/// The format that this library reads.
const FORMAT: &str = "1";
/// Longest text, and most numbers of a list: no drive needs more.
const MOST_BYTES: usize = 4_000_000;
const MOST_NUMBERS: usize = 100_000;

/// Values of all variables, in the order of the table; not a number where there is none.
pub type Values = [f64; COUNT];

/// Declares a choice with the word that the text has for each.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident { $($case:ident = $word:literal),* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name { $($case),* }

        impl $name {
            fn of(line: &Line) -> Result<Self, String> {
                match line.value {
                    $($word => Ok(Self::$case),)*
                    _ => Err(line.refused(&format!("is none of {}", [$($word),*].join(", ")))),
                }
            }
        }
    };
}

choice! {
    /// What moves the belt.
    Drive { Speed = "speed", Torque = "torque" }
}
choice! {
    /// How a drive that is given a speed is coupled.
    Coupling { Translational = "translational", Rotational = "rotational" }
}
choice! {
    /// Where the motion starts.
    Start { Rest = "rest", Steady = "steady", Given = "given" }
}

/// The choices of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choices {
    pub drive: Drive,
    pub coupling: Coupling,
    /// Those of its drag.
    pub drag: Kinds,
    pub start: Start,
}

impl Choices {
    /// The port of a drive that is given a speed.
    pub fn port(self) -> Option<Port> {
        match (self.drive, self.coupling) {
            (Drive::Torque, _) => None,
            (Drive::Speed, Coupling::Translational) => Some(Port::Translational),
            (Drive::Speed, Coupling::Rotational) => Some(Port::Rotational),
        }
    }

    /// Whether the law varies with temperature.
    fn varies(self) -> bool {
        self.drag.temperature != TemperatureKind::None
    }

    /// Whether a variable is one of such a drive, and if so whether it needs a value.
    fn belongs(self, name: &str) -> Belongs {
        let needed = match name {
            "drive_speed" => self.port() == Some(Port::Translational),
            "roll_speed" => self.port() == Some(Port::Rotational),
            "drive_torque" => self.drive == Drive::Torque,
            "roll_radius" => self.port() != Some(Port::Translational),
            "temperature" => self.varies(),
            "start_belt_speed" | "start_stretch" => self.start == Start::Given,
            "stiffness" | "mass" => true,
            "grip" if self.drive == Drive::Speed => return Belongs::Optional,
            "tolerance" => return Belongs::Optional,
            _ => return self.drag.belongs(name),
        };
        if needed { Belongs::Needed } else { Belongs::No }
    }
}

/// Least and greatest value at which the law was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measured {
    /// Of the belt speed, m/s.
    pub speed: Option<[f64; 2]>,
    /// K.
    pub temperature: Option<[f64; 2]>,
}

/// A drive as its text describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    pub choices: Choices,
    /// What the variables start with.
    pub values: Values,
    /// The lists of the drag, in the order of the core's names.
    pub lists: [Vec<f64>; LISTS.len()],
    /// Least and greatest belt speed and temperature at which the law was measured, if they are known.
    pub measured: Measured,
    /// The word by which a tool makes sure that library and unit belong together.
    pub token: Option<String>,
    /// Steps that one call may take.
    pub most_steps: u64,
    /// Sum of the text, by which a saved state is known to be of this drive.
    pub sum: u64,
}

/// One line of the text.
struct Line<'a> {
    number: usize,
    name: &'a str,
    value: &'a str,
}

impl Line<'_> {
    fn refused(&self, why: &str) -> String {
        let value: String = self.value.chars().take(40).collect();
        format!("line {} of the drive: {} '{value}' {why}", self.number, self.name)
    }

    fn number(&self) -> Result<f64, String> {
        let number = self.value.parse().map_err(|_| self.refused("is no number"))?;
        if f64::is_finite(number) { Ok(number) } else { Err(self.refused("is not finite")) }
    }

    fn numbers(&self) -> Result<Vec<f64>, String> {
        let one = |value| Line { value, ..*self }.number();
        let numbers: Vec<f64> = self
            .value
            .split_whitespace()
            .take(MOST_NUMBERS + 1)
            .map(one)
            .collect::<Result<_, _>>()?;
        let many = || self.refused(&format!("has more than {MOST_NUMBERS} numbers"));
        if numbers.len() > MOST_NUMBERS { Err(many()) } else { Ok(numbers) }
    }

    /// The kind of a word, of those that the core has.
    fn kind<K>(&self, of: fn(&str) -> Result<K, Unreadable>) -> Result<K, String> {
        of(self.value).map_err(|error| match error {
            Unreadable::Unknown { known, .. } => {
                self.refused(&format!("is none of {}", known.join(", ")))
            }
            other => self.refused(&other.to_string()),
        })
    }

    /// So many numbers.
    fn exactly(&self, count: usize) -> Result<Vec<f64>, String> {
        let numbers = self.numbers()?;
        let found = numbers.len();
        let other = || self.refused(&format!("has {found} numbers: {count} are needed"));
        if found == count { Ok(numbers) } else { Err(other()) }
    }
}

/// The lines of a text, by their names.
struct Lines<'a>(Vec<Line<'a>>);

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Result<Self, String> {
        if text.len() > MOST_BYTES {
            return Err(format!(
                "the drive has {} bytes: at most {MOST_BYTES} are read",
                text.len()
            ));
        }
        let mut lines: Vec<Line<'a>> = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let (number, line) = (index + 1, line.trim());
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let (name, value) = line
                .split_once('=')
                .ok_or_else(|| format!("line {number} of the drive is not 'name = value'"))?;
            let line = Line { number, name: name.trim(), value: value.trim() };
            if !is_known(line.name) && settable(line.name).is_none() {
                return Err(format!(
                    "line {number} of the drive: '{:.40}' is no name of it",
                    line.name
                ));
            }
            if let Some(first) = lines.iter().find(|other| other.name == line.name) {
                return Err(line.refused(&format!("stands already in line {}", first.number)));
            }
            lines.push(line);
        }
        Ok(Self(lines))
    }

    fn find(&self, name: &str) -> Option<&Line<'a>> {
        self.0.iter().find(|line| line.name == name)
    }

    fn needed(&self, name: &str) -> Result<&Line<'a>, String> {
        self.find(name).ok_or_else(|| format!("the drive has no line '{name} = ...'"))
    }

    /// The numbers of a list that goes with a choice: as many as needed, any if that is none, or no line at all.
    fn list(&self, name: &str, belongs: bool, count: Option<usize>) -> Result<Vec<f64>, String> {
        match (belongs, self.find(name)) {
            (false, None) => Ok(Vec::new()),
            (false, Some(line)) => Err(line.refused(OUT_OF_PLACE)),
            (true, _) => {
                let line = self.needed(name)?;
                count.map_or_else(|| line.numbers(), |count| line.exactly(count))
            }
        }
    }
}

impl Lines<'_> {
    /// Two positive numbers, the second not below the first.
    fn range(&self, name: &str, belongs: bool) -> Result<Option<[f64; 2]>, String> {
        let Some(line) = self.find(name) else { return Ok(None) };
        match self.list(name, belongs, Some(2))?[..] {
            [low, high] if low >= 0.0 && low <= high => Ok(Some([low, high])),
            _ => Err(line.refused("is no range: give the least and the greatest value")),
        }
    }
}

const OUT_OF_PLACE: &str = "does not belong to the other choices of the drive";

/// Names of the drive that are neither variables nor of the drag.
const KNOWN: [&str; 8] = [
    "format",
    "token",
    "drive",
    "port",
    "start",
    "measured_speeds",
    "measured_temperatures",
    "most_steps",
];

fn is_known(name: &str) -> bool {
    [&KNOWN[..], &CHOICES, &LISTS].concat().contains(&name)
}

/// Place of a variable that a text may give.
fn settable(name: &str) -> Option<usize> {
    use crate::variables::Causality::{Input, Parameter};
    place_of(name).filter(|place| matches!(VARIABLES[*place].causality, Input | Parameter))
}

impl Description {
    /// Read a text.
    pub fn read(text: &str) -> Result<Self, String> {
        let lines = Lines::of(text)?;
        let format = lines.needed("format")?;
        if format.value != FORMAT {
            return Err(
                format.refused(&format!("is not the format {FORMAT}, which this library reads"))
            );
        }
        let choices = Choices {
            drive: Drive::of(lines.needed("drive")?)?,
            coupling: lines.find("port").map_or(Ok(Coupling::Translational), Coupling::of)?,
            drag: Kinds {
                shape: lines.needed("law")?.kind(ShapeKind::of)?,
                closure: lines.needed("closure")?.kind(ClosureKind::of)?,
                temperature: lines.needed("temperature_law")?.kind(TemperatureKind::of)?,
            },
            start: lines.find("start").map_or(Ok(Start::Rest), Start::of)?,
        };
        if let (Drive::Torque, Start::Steady, Some(line)) =
            (choices.drive, choices.start, lines.find("start"))
        {
            return Err(line.refused("needs drive = speed"));
        }
        if let (Drive::Torque, Coupling::Rotational, Some(line)) =
            (choices.drive, choices.coupling, lines.find("port"))
        {
            return Err(line.refused("needs drive = speed: a torque acts on the roll already"));
        }
        let mut lists = [const { Vec::new() }; LISTS.len()];
        for (list, name) in lists.iter_mut().zip(LISTS) {
            let belongs = choices.drag.belongs(name) != Belongs::No;
            *list = lines.list(name, belongs, choices.drag.count(name))?;
        }
        Ok(Self {
            choices,
            values: values(&lines, choices)?,
            lists,
            measured: Measured {
                speed: lines.range("measured_speeds", true)?,
                temperature: lines.range("measured_temperatures", choices.varies())?,
            },
            token: lines.find("token").map(|line| line.value.to_owned()),
            most_steps: lines.find("most_steps").map_or(Ok(MOST_STEPS), |line| {
                line.value.parse().map_err(|_| line.refused("is no whole number"))
            })?,
            sum: sum(text.as_bytes()),
        })
    }

    /// Place of the variable that moves the belt.
    pub fn drive_place(&self) -> usize {
        match self.choices.port() {
            Some(Port::Translational) => DRIVE_SPEED,
            Some(Port::Rotational) => ROLL_SPEED,
            None => DRIVE_TORQUE,
        }
    }

    /// Whether such a drive has a variable that is computed: those of another port it has not.
    pub fn computes(&self, place: usize) -> bool {
        let variable = &VARIABLES[place];
        let is_computed = matches!(variable.causality, Causality::Independent | Causality::Output);
        is_computed && (variable.port.is_none() || variable.port == self.choices.port())
    }

    /// Whether the law varies with temperature.
    pub fn is_warmed(&self) -> bool {
        !self.values[TEMPERATURE].is_nan()
    }
}

fn values(lines: &Lines, choices: Choices) -> Result<Values, String> {
    let mut values = [f64::NAN; COUNT];
    for (variable, value) in VARIABLES.iter().zip(&mut values) {
        if settable(variable.name).is_none() {
            continue;
        }
        let line = lines.find(variable.name);
        *value = match (choices.belongs(variable.name), line) {
            (Belongs::No, Some(line)) => return Err(line.refused(OUT_OF_PLACE)),
            (Belongs::No, None) => continue,
            (_, Some(line)) => line.number()?,
            (Belongs::Needed, None) => lines.needed(variable.name)?.number()?,
            (Belongs::Optional, None) => variable.start.unwrap_or(f64::NAN),
        };
    }
    Ok(values)
}

/// A sum by which two runs of bytes are told apart: FNV-1a.
pub fn sum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{BASELINE, TORQUE, WARMED};

    fn refusal(text: &str) -> String {
        Description::read(text).unwrap_err()
    }

    #[test]
    fn a_text_is_read_with_what_it_leaves_out() {
        let read = Description::read(BASELINE).unwrap();
        assert_eq!(read.choices.drag.closure, ClosureKind::Retained);
        assert!((read.values[place_of("stiffness").unwrap()] - 1000.0).abs() < 1e-12);
        assert!(read.values[place_of("rest_force").unwrap()].abs() < 1e-300);
        assert!(read.values[place_of("grip").unwrap()].is_nan() && !read.is_warmed());
        assert_eq!((read.most_steps, read.drive_place()), (MOST_STEPS, DRIVE_SPEED));
        assert!(Description::read(WARMED).unwrap().is_warmed());
        assert_eq!(Description::read(TORQUE).unwrap().drive_place(), DRIVE_TORQUE);
        let again = Description::read(&BASELINE.replace('\n', "\r\n")).unwrap();
        assert_eq!(again.values.map(f64::to_bits), read.values.map(f64::to_bits));
    }

    #[test]
    fn every_number_of_a_drag_is_a_parameter() {
        for name in hersey_core::drag::form::NUMBERS {
            assert!(settable(name).is_some(), "{name} is in no place of the table of variables");
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (from, to, words) in [
            ("mass = 1.0", "mass = one", "mass 'one' is no number"),
            ("mass = 1.0", "mass = inf", "mass 'inf' is not finite"),
            ("mass = 1.0", "", "the drive has no line 'mass = ...'"),
            ("mass = 1.0", "mas = 1.0", "'mas' is no name of it"),
            ("mass = 1.0", "mass", "is not 'name = value'"),
            ("mass = 1.0", "mass = 1.0\nmass = 2", "stands already in line"),
            ("mass = 1.0", "mass = 1.0\nbelt_speed = 2", "'belt_speed' is no name of it"),
            ("mass = 1.0", "mass = 1.0\ntemperature = 300", OUT_OF_PLACE),
            ("mass = 1.0", "mass = 1.0\nspeeds = 1 2", OUT_OF_PLACE),
            ("law = power", "law = spline", "law 'spline' is none of power, table, mixed"),
            ("law = power", "law = table", "the drive has no line 'speeds = ...'"),
            (
                "temperature_law = none",
                "temperature_law = roelands\nviscosity_numbers = 1 2 3",
                "temperature_law 'roelands' is none of none, power, arrhenius, vogel, walther",
            ),
            (
                "temperature_law = none",
                "viscosity_numbers = 1 2 3",
                "the drive has no line 'temperature_law = ...'",
            ),
            (
                "temperature_law = none",
                "temperature_law = arrhenius\nviscosity_numbers = 1 2 3",
                "has 3 numbers: 2 are needed",
            ),
            ("mass = 1.0", "mass = 1.0\nroll_speed = 2", OUT_OF_PLACE),
            ("mass = 1.0", "mass = 1.0\nmeasured_speeds = 2 1", "is no range"),
            ("mass = 1.0", "mass = 1.0\nmeasured_speeds = 2", "has 1 numbers: 2 are needed"),
            ("mass = 1.0", "mass = 1.0\nmeasured_temperatures = 300 400", OUT_OF_PLACE),
            (
                "drive = speed",
                "drive = speed\nport = rotational",
                "drive_speed '1.0' does not belong",
            ),
            ("format = 1", "format = 2", "is not the format 1"),
        ] {
            let words_found = refusal(&BASELINE.replace(from, to));
            assert!(words_found.contains(words), "{to}: {words_found}");
        }
        assert!(
            refusal(&TORQUE.replace("start = rest", "start = steady")).contains("drive = speed")
        );
        let rotational = TORQUE.replace("drive = torque", "drive = torque\nport = rotational");
        assert!(refusal(&rotational).contains("needs drive = speed"));
        assert!(refusal("").contains("format"));
        assert!(refusal(&"#".repeat(MOST_BYTES + 1)).contains("bytes"));
    }
}
