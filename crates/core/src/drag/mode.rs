//! States of lubrication.

/// State of lubrication, which decides the equation of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Full film: speed at or above the transition speed.
    Ehl,
    /// Mixed lubrication: between the stick speed and the transition speed.
    Mixed,
    /// Slower than the stick speed, and moving as the forces say.
    Microslip,
    /// Slower than the stick speed, and held by the drag.
    Stuck,
}
