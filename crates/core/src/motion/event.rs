//! Changes of mode, and the conditions that cause them.

use crate::drag::Mode;

/// Deviation from a corner of the law, relative, that is lost in rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// The condition whose crossing ends a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// Belt speed passes the transition speed `v_t`.
    TransitionSpeed,
    /// Belt speed passes the stick speed `v_s`.
    StickSpeed,
    /// Spring force passes the force that drag can hold (Eqs. 25-26).
    HoldingForce,
    /// Belt speed passes zero.
    Reversal,
    /// Belt speed passes a point of a tabulated law; the mode does not change.
    TablePoint,
    /// The spring pulls as hard as the roll's grip on the belt bears: the roll begins to slip.
    GripLost,
    /// The belt is as fast as the roll that slipped on it: the roll grips it again.
    GripRegained,
}

impl Guard {
    /// The condition that parts two modes, for a change that something jumped has made.
    pub(super) fn between(from: Mode, to: Mode) -> Self {
        match (from, to) {
            (Mode::Ehl | Mode::Mixed, Mode::Ehl | Mode::Mixed) => Self::TransitionSpeed,
            (Mode::Stuck, _) | (Mode::Microslip, Mode::Stuck) => Self::HoldingForce,
            _ => Self::StickSpeed,
        }
    }

    /// Name of the guard as documents print it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::TransitionSpeed => "transition_speed",
            Self::StickSpeed => "stick_speed",
            Self::HoldingForce => "holding_force",
            Self::Reversal => "reversal",
            Self::TablePoint => "table_point",
            Self::GripLost => "grip_lost",
            Self::GripRegained => "grip_regained",
        }
    }
}

/// A change of mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When it happens.
    pub time: f64,
    /// Mode before.
    pub from: Mode,
    /// Mode after.
    pub to: Mode,
    /// The condition that was crossed.
    pub guard: Guard,
    /// Spring stretch at the event.
    pub stretch: f64,
    /// Belt speed at the event.
    pub belt_speed: f64,
}
