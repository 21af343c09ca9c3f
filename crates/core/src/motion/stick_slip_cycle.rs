//! What a motion has settled to: its kind, and the numbers of its lap.

/// What the motion settles to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleKind {
    /// The belt moves at drive speed.
    SteadySliding,
    /// The belt speed swings about drive speed without sticking; the roll may slip on it meanwhile.
    Oscillation,
    /// The belt sticks and slips in turn; the roll may slip on it meanwhile.
    StickSlip,
    /// No periodic motion was reached within the laps allowed.
    Unsettled,
    /// The belt is held, or creeps below the stick speed where the closure never holds it, and the roll slips on it
    /// for good.
    Stalled,
    /// The belt slides steadily at the stick speed or faster, more slowly than the roll that slips on it for good.
    GripSlip,
}

/// The settled motion; of `Unsettled` motion, its last lap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickSlipCycle {
    /// Which of the outcomes it is.
    pub kind: CycleKind,
    /// Laps per unit time; zero in steady sliding.
    pub frequency: f64,
    /// Time slipping per lap.
    pub slip_duration: f64,
    /// Time stuck per lap.
    pub stick_duration: f64,
    /// Least belt speed.
    pub speed_min: f64,
    /// Greatest belt speed.
    pub speed_max: f64,
    /// Least spring stretch.
    pub stretch_min: f64,
    /// Greatest spring stretch.
    pub stretch_max: f64,
    /// Time per lap during which the roll slips on the belt; zero where it always does, or never.
    pub grip_slip_duration: f64,
    /// Work against drag per lap; zero in steady sliding, which has no laps.
    pub drag_work: f64,
    /// Laps after which the motion repeats itself; of several, durations and work are means and extremes those of all.
    pub laps_per_period: usize,
    /// Laps simulated.
    pub laps: usize,
}

impl StickSlipCycle {
    /// Steady sliding at `drive_speed`, after so many laps.
    pub(super) fn steady(drive_speed: f64, stretch: f64, laps: usize) -> Self {
        Self {
            kind: CycleKind::SteadySliding,
            frequency: 0.0,
            slip_duration: 0.0,
            stick_duration: 0.0,
            speed_min: drive_speed,
            speed_max: drive_speed,
            stretch_min: stretch,
            stretch_max: stretch,
            grip_slip_duration: 0.0,
            drag_work: 0.0,
            laps_per_period: 1,
            laps,
        }
    }

    /// The same at another speed of the belt, on which the roll slips.
    pub(super) fn slipping(belt_speed: f64, stuck: bool, stretch: f64, laps: usize) -> Self {
        let kind = if stuck { CycleKind::Stalled } else { CycleKind::GripSlip };
        Self { kind, ..Self::steady(belt_speed, stretch, laps) }
    }
}
