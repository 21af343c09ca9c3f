//! The one table of variables, of which the C interface, the units for other tools and their descriptions are made.

use std::ffi::{CStr, CString};
use std::fmt::Write;
use std::sync::LazyLock;

/// How a value is passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Float64,
    Enumeration,
    Boolean,
}

/// Names of the states of lubrication, by their number.
pub const MODES: [&str; 4] = ["ehl", "mixed", "microslip", "stuck"];

/// How a drive that is given a speed meets the tool outside: which variables belong to which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Port {
    /// A speed of the belt's side of the roll, m/s.
    Translational,
    /// The roll as a shaft: its speed in, the torque that it asks for out.
    Rotational,
}

impl Port {
    fn name(self) -> &'static str {
        match self {
            Self::Translational => "translational",
            Self::Rotational => "rotational",
        }
    }
}

/// What a variable is to the tool outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    Independent,
    Input,
    Output,
    Parameter,
}

/// One variable; its start is of the drive's description where none stands here.
#[derive(Debug, Clone, Copy)]
pub struct Variable {
    pub reference: u32,
    pub name: &'static str,
    pub kind: Kind,
    pub causality: Causality,
    pub unit: &'static str,
    pub start: Option<f64>,
    /// The port that it is of; none if a drive has it whatever its port.
    pub port: Option<Port>,
    pub description: &'static str,
}

impl Variable {
    fn variability(&self) -> &'static str {
        match (self.causality, self.kind) {
            (Causality::Parameter, _) => "fixed",
            (_, Kind::Float64) => "continuous",
            _ => "discrete",
        }
    }

    fn causality_name(&self) -> &'static str {
        match self.causality {
            Causality::Independent => "independent",
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::Parameter => "parameter",
        }
    }
}

const fn real(
    reference: u32,
    name: &'static str,
    causality: Causality,
    unit: &'static str,
    description: &'static str,
) -> Variable {
    let (kind, start, port) = (Kind::Float64, None, None);
    Variable { reference, name, kind, causality, unit, start, port, description }
}

const fn input(
    reference: u32,
    name: &'static str,
    unit: &'static str,
    description: &'static str,
) -> Variable {
    real(reference, name, Causality::Input, unit, description)
}

const fn output(
    reference: u32,
    name: &'static str,
    unit: &'static str,
    description: &'static str,
) -> Variable {
    real(reference, name, Causality::Output, unit, description)
}

const fn discrete(
    reference: u32,
    name: &'static str,
    kind: Kind,
    description: &'static str,
) -> Variable {
    let (causality, start, port) = (Causality::Output, None, None);
    Variable { reference, name, kind, causality, unit: "", start, port, description }
}

const fn parameter(
    reference: u32,
    name: &'static str,
    unit: &'static str,
    description: &'static str,
) -> Variable {
    real(reference, name, Causality::Parameter, unit, description)
}

const fn optional(start: f64, variable: Variable) -> Variable {
    Variable { start: Some(start), ..variable }
}

const fn of_port(port: Port, variable: Variable) -> Variable {
    Variable { port: Some(port), ..variable }
}

/// Places in the table of what is more than a number of the drive.
pub const TIME: usize = 0;
pub const DRIVE_SPEED: usize = 1;
pub const DRIVE_TORQUE: usize = 2;
pub const TEMPERATURE: usize = 3;
pub const ROLL_SPEED: usize = 4;
pub const TOLERANCE: usize = COUNT - 1;

/// How many there are.
pub const COUNT: usize = 48;

/// All variables; a drive has those of them that belong to its kinds.
pub static VARIABLES: [Variable; COUNT] = [
    real(0, "time", Causality::Independent, "s", "Time"),
    of_port(
        Port::Translational,
        input(1, "drive_speed", "m/s", "Speed of the drive, at the far end of the spring"),
    ),
    input(2, "drive_torque", "N.m", "Torque on the roll, which a spring holds to the ground"),
    input(3, "temperature", "K", "Temperature of the contact"),
    of_port(
        Port::Rotational,
        input(
            4,
            "roll_speed",
            "rad/s",
            "Speed of the roll that drives the belt through the spring",
        ),
    ),
    output(10, "belt_speed", "m/s", "Speed of the belt"),
    output(11, "spring_force", "N", "Stiffness times stretch"),
    output(12, "drag", "N", "Drag on the belt, that of the rest of the drive included"),
    output(13, "stretch", "m", "Stretch of the spring"),
    output(14, "friction_power", "W", "Heat of all drag on the belt; never negative"),
    output(
        15,
        "contact_power",
        "W",
        "The part of it in the lubricated contact, which heats the film",
    ),
    output(16, "slip_power", "W", "Heat of the roll slipping on the belt"),
    output(17, "friction_energy", "J", "Heat of all drag on the belt since the start"),
    output(18, "contact_energy", "J", "Heat of the lubricated contact since the start"),
    output(19, "slip_energy", "J", "Heat of the roll slipping on the belt since the start"),
    discrete(
        20,
        "mode",
        Kind::Enumeration,
        "State of lubrication: full film, mixed, below the stick speed and moving freely, held",
    ),
    discrete(21, "stuck", Kind::Boolean, "Whether the drag holds the belt"),
    discrete(22, "slipping", Kind::Boolean, "Whether the roll slips on the belt"),
    output(23, "belt_position", "m", "Way of the belt since the start"),
    of_port(
        Port::Translational,
        output(24, "drive_position", "m", "Way of the drive since the start"),
    ),
    of_port(
        Port::Rotational,
        output(
            25,
            "reaction_torque",
            "N.m",
            "Torque that the belt asks of the roll's shaft, brakes it",
        ),
    ),
    of_port(
        Port::Rotational,
        output(26, "roll_angle", "rad", "Angle that the roll has turned by since the start"),
    ),
    parameter(100, "stiffness", "N/m", "Stiffness of the spring between drive and belt"),
    parameter(101, "mass", "kg", "Moving mass"),
    parameter(102, "grip", "N", "Force up to which the roll grips the belt"),
    parameter(103, "roll_radius", "m", "Radius of the roll that drives the belt"),
    parameter(110, "transition_force", "N", "Drag at the transition speed"),
    parameter(111, "transition_speed", "m/s", "Speed between mixed lubrication and full film"),
    parameter(112, "ehl_exponent", "1", "Exponent of damping in speed above the transition"),
    parameter(113, "mixed_exponent", "1", "Exponent of damping in speed below the transition"),
    parameter(114, "viscosity", "Pa.s", "Viscosity of the lubricant in a contact that shares load"),
    parameter(115, "stick_speed", "m/s", "Speed below which the closure holds"),
    parameter(116, "static_force", "N", "Drag of the contact that a belt at rest can bear"),
    optional(0.0, parameter(117, "rest_force", "N", "Drag of the rest of the drive at any speed")),
    optional(
        0.0,
        parameter(118, "rest_damping", "N.s/m", "Drag of the rest of the drive per speed"),
    ),
    parameter(119, "bristle_stiffness", "N/m", "Force per deflection of the bristles"),
    parameter(120, "bristle_damping", "N.s/m", "Force per rate of deflection of the bristles"),
    parameter(
        121,
        "static_growth",
        "1",
        "Growth of the static force per e-fold of the time at rest",
    ),
    parameter(122, "static_growth_time", "s", "Time at rest from which on the static force grows"),
    parameter(130, "reference_temperature", "K", "Temperature at which the law of drag is given"),
    optional(
        0.0,
        parameter(131, "temperature_zero", "K", "Zero of the temperature scale of the powers"),
    ),
    parameter(132, "force_temperature_exponent", "1", "Exponent of the forces in temperature"),
    parameter(133, "speed_temperature_exponent", "1", "Exponent of the speeds in temperature"),
    optional(
        0.0,
        parameter(134, "boundary_temperature_slope", "1/K", "Relative change of boundary friction"),
    ),
    optional(
        0.0,
        parameter(135, "rest_temperature_slope", "1/K", "Relative change of the rest of the drive"),
    ),
    parameter(140, "start_belt_speed", "m/s", "Speed of the belt at the start"),
    parameter(141, "start_stretch", "m", "Stretch of the spring at the start"),
    optional(1e-9, parameter(150, "tolerance", "1", "Relative tolerance of the steps")),
];

/// Place of a variable in the table.
pub fn place_of(name: &str) -> Option<usize> {
    VARIABLES.iter().position(|variable| variable.name == name)
}

/// Place of the variable that a tool names by its number.
pub fn place_at(reference: u32) -> Option<usize> {
    VARIABLES.iter().position(|variable| variable.reference == reference)
}

/// The table as text: a line each, its fields separated by tabs.
pub fn as_text() -> &'static CStr {
    static TEXT: LazyLock<CString> = LazyLock::new(|| {
        let mut text = String::new();
        for variable in &VARIABLES {
            let Variable { reference, name, kind, unit, description, port, .. } = variable;
            let port = port.map(Port::name).unwrap_or_default();
            let items = if *kind == Kind::Enumeration { MODES.join(" ") } else { String::new() };
            let (causality, variability) = (variable.causality_name(), variable.variability());
            let start = variable.start.map(|start| format!("{start:?}")).unwrap_or_default();
            let _ = writeln!(
                text,
                "{reference}\t{name}\t{kind:?}\t{causality}\t{variability}\t{unit}\t{start}\t{description}\t{port}\t{items}"
            );
        }
        CString::new(text).unwrap_or_default()
    });
    &TEXT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_references_are_told_apart() {
        for (place, variable) in VARIABLES.iter().enumerate() {
            assert_eq!(place_of(variable.name), Some(place));
            assert_eq!(place_at(variable.reference), Some(place));
        }
        let special = [TIME, DRIVE_SPEED, DRIVE_TORQUE, TEMPERATURE, ROLL_SPEED, TOLERANCE];
        assert_eq!(
            special.map(|place| VARIABLES[place].name),
            ["time", "drive_speed", "drive_torque", "temperature", "roll_speed", "tolerance"]
        );
    }

    #[test]
    fn the_text_has_a_line_of_ten_fields_a_variable() {
        let text = as_text().to_str().unwrap();
        assert_eq!(text.lines().count(), COUNT);
        assert!(text.lines().all(|line| line.split('\t').count() == 10));
        assert!(text.contains("held\t\tehl mixed microslip stuck\n"));
        assert!(text.contains("since the start\trotational\t\n"));
        assert!(text.contains("150\ttolerance\tFloat64\tparameter\tfixed\t1\t1e-9\t"));
    }
}
