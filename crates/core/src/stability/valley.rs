//! The bottom of the curve `w(s)`, from laps that do not quite come back.
//!
//! Newton's method for `w` and the secant method for the slope go on together, by one lap each time. Where the curve is a
//! parabola that is the shortest way. Where swings creep it is flat on one side and steep on the other: then steps
//! grow until the slope has changed its sign, and halve what lies between.

/// Laps after which the bottom is given up.
const MOST_LAPS: usize = 16;
/// Error of `w`, foretold from the last laps, at which a search ends.
const FOUND: f64 = 1e-12;
/// Relative error of a slope, or of its change, up to which it counts.
const LARGEST_ERROR: f64 = 0.25;
/// Step over the room left, where the slope is almost nil and the second derivative is not known.
const STRIDE: f64 = 0.3;
/// Share of the slope before from which on a step was too small, and by how much the next is longer.
const STALLED: f64 = 0.25;
const LONGER: f64 = 3.0;
/// Share of a slowest speed that is at least left in a step.
const LEFT: f64 = 0.3;
/// Share of the way from the slowest speed to that from which on drag rises below which no cycle's drive is.
const SLOWEST_DRIVE: f64 = 0.4;

/// A lower edge, and what it took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LowerEdge {
    /// Drive speed over `v_t`.
    pub drive_speed: f64,
    /// Laps followed.
    pub laps: usize,
}

/// What a lap says of the cycle whose slowest speed is its own.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    pub slowest: f64,
    pub drive_speed: f64,
    /// How much faster the drive of the cycle is than that of the lap, and the relative error of that from the lap's
    /// integrals.
    pub correction: f64,
    pub error: f64,
    /// Slope of `w(s)`.
    pub slope: f64,
}

pub(super) enum Step {
    /// A lap of such a slowest speed at such a drive speed is to follow.
    Try(f64, f64),
    Found(LowerEdge),
    Nowhere,
}

/// One search.
pub(super) struct Valley {
    /// Slowest speed of all cycles, and the one from which on drag rises.
    least: f64,
    rises: f64,
    /// Second derivative of `w(s)`.
    bend: f64,
    last: Option<Trial>,
    /// Slowest speeds nearest to the bottom at which `w(s)` is known to fall and to rise.
    falls: Option<f64>,
    climbs: Option<f64>,
    /// How far apart they were when that had last halved, and laps since.
    width: f64,
    since: usize,
    laps: usize,
}

impl Valley {
    /// Between two slowest speeds, from a first one and its drive speed.
    pub(super) fn new(least: f64, rises: f64, (slowest, drive_speed): (f64, f64)) -> Self {
        Self {
            least,
            rises,
            bend: 2.0 * (rises - drive_speed) / (rises - slowest).powi(2),
            last: None,
            falls: None,
            climbs: None,
            width: f64::INFINITY,
            since: 0,
            laps: 0,
        }
    }

    pub(super) fn take(&mut self, trial: &Trial) -> Step {
        self.laps += 1;
        let uncertainty = self.learn(trial);
        let near = FOUND * trial.drive_speed;
        let next = self.next(trial, uncertainty, near);
        let Trial { slowest, drive_speed, correction, slope, .. } = *trial;
        let ends = slowest <= self.least && slope >= 0.0;
        let drop = if ends { 0.0 } else { 0.5 * slope * slope / self.bend };
        let drop_error = drop * uncertainty.max((next - slowest).abs() / slowest);
        let drop_error = drop_error.min(slope.abs() * self.room(trial));
        if correction.abs() * (trial.error + self.relative_gap(trial)) + drop_error <= near {
            let drive_speed = (drive_speed + correction - drop).min(self.rises);
            return Step::Found(LowerEdge { drive_speed, laps: self.laps });
        }
        let step = next - slowest;
        let drive = drive_speed + correction + step * (slope + 0.5 * self.bend * step);
        if self.laps == MOST_LAPS || !drive.is_finite() {
            return Step::Nowhere;
        }
        self.last = Some(*trial);
        let slowest_drive = next + SLOWEST_DRIVE * (self.rises - next);
        Step::Try(next, drive.min(1.5 * drive_speed).max(slowest_drive))
    }

    /// Correction of a lap over what lies between its drive speed and the greatest.
    fn relative_gap(&self, trial: &Trial) -> f64 {
        (trial.correction / (self.rises - trial.drive_speed)).abs()
    }

    /// Error that the gap of a lap brings into its slope.
    fn slope_error(&self, trial: &Trial) -> f64 {
        self.relative_gap(trial) * (trial.slope.abs() + self.bend * (self.rises - trial.slowest))
    }

    /// Learn from a lap and the one before how `w(s)` bends; the relative uncertainty of that, one if
    /// they do not show it.
    fn learn(&mut self, trial: &Trial) -> f64 {
        if self.slope_error(trial) < LARGEST_ERROR * trial.slope.abs() {
            let side = if trial.slope < 0.0 { &mut self.falls } else { &mut self.climbs };
            *side = Some(trial.slowest);
            let width = self.above() - self.below();
            (self.width, self.since) =
                if width <= 0.5 * self.width { (width, 0) } else { (self.width, self.since + 1) };
        }
        let Some(last) = self.last else { return 1.0 };
        let distance = trial.slowest - last.slowest;
        let change = trial.slope - last.slope;
        let bend_error = (self.slope_error(trial) + self.slope_error(&last)) / change.abs();
        let bend = change / distance;
        if !(bend > 0.0 && bend_error < LARGEST_ERROR && distance.abs() < trial.slowest) {
            return 1.0;
        }
        self.bend = bend;
        distance.abs() / trial.slowest + bend_error
    }

    /// Slowest speed of the next lap.
    fn next(&self, trial: &Trial, uncertainty: f64, near: f64) -> f64 {
        let Trial { slowest, slope, .. } = *trial;
        let last_step = self.last.map_or(0.0, |last| (slowest - last.slowest).abs());
        let mut step = (slope / self.bend).abs();
        let stalls = self.last.is_some_and(|last| slope / last.slope > STALLED);
        if stalls && self.slope_error(trial) < LARGEST_ERROR * slope.abs() {
            step = step.max(LONGER * last_step);
        }
        if uncertainty >= 1.0
            && 0.5 * slope.abs() * step <= near
            && slope.abs() * self.room(trial) > near
        {
            step = STRIDE * self.room(trial);
        }
        let next = if slope > 0.0 { slowest - step } else { slowest + step };
        let (below, above) = (self.below(), self.above());
        let middle = 0.5 * (below + above);
        let next = match (self.falls, self.climbs) {
            (Some(_), Some(_)) => {
                let outside = next <= below || next >= above;
                if outside || self.since > 1 && step > 0.5 * last_step { middle } else { next }
            }
            (Some(_), None) => next.max(0.5 * (slowest + below)).min(0.5 * (slowest + above)),
            _ => next.max(below).min(0.5 * (slowest + above)),
        };
        next.clamp(LEFT * slowest, slowest / LEFT)
    }

    /// Greatest distance of the bottom from the slowest speed of a lap.
    fn room(&self, trial: &Trial) -> f64 {
        if trial.slope > 0.0 { trial.slowest - self.below() } else { self.above() - trial.slowest }
    }

    fn below(&self) -> f64 {
        self.falls.unwrap_or(self.least)
    }

    fn above(&self) -> f64 {
        self.climbs.unwrap_or(self.rises)
    }
}
