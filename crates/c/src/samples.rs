//! Drives for the tests.

/// Stick-slip of the paper's law.
pub const BASELINE: &str = "# a belt
format = 1
drive = speed
law = power
closure = retained
temperature_law = none
stiffness = 1000.0
mass = 1.0
transition_force = 50.0
transition_speed = 1.0
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = 1.0
";

/// The same under a torque.
pub const TORQUE: &str = "format = 1
drive = torque
law = power
closure = stiction
temperature_law = none
stiffness = 1000.0
mass = 1.0
roll_radius = 0.02
transition_force = 50.0
transition_speed = 1.0
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_torque = 3.0
start = rest
";

/// The same, of a law that varies with temperature, with a grip and a rest of the drive.
pub const WARMED: &str = "format = 1
token = {of-this-unit}
drive = speed
law = power
closure = stiction
temperature_law = power
stiffness = 1000.0
mass = 1.0
grip = 120.0
transition_force = 50.0
transition_speed = 1.0
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
rest_force = 2.0
reference_temperature = 330.0
force_temperature_exponent = -1.0
speed_temperature_exponent = 2.0
drive_speed = 1.0
temperature = 330.0
";
