//! A slip lap at one drive speed, in two halves: forward, and back in time.
//!
//! Whether a lap comes back is asked where it slows down through the transition: forward from the start, and
//! back in time from the slowest point, where the motion forgets what forward it would blow up.
//!
//! Where the roll slips before the belt is as fast as the drive, both meet with just the pull that the grip
//! can hold, at any speed before: the lap then begins there.

use super::secant::Outcome;
use super::slip_lap::SlipLap;
use crate::motion::lanes::{Lanes, arrival};

/// Tolerance of the steps, whose errors add up along a lap, over that asked for, and the tightest.
const SHARE: f64 = 0.1;
const TIGHTEST: f64 = 1e-14;
/// Steps of one lap after which a search is given up.
const MAX_STEPS: u32 = 20_000;
/// Bisections, in logarithms, for the speed where the way back may begin; more would not change the gap.
const MAX_HALVINGS: usize = 12;
/// E-folds by which laps approach the curve of slow motion, after which they are the same.
const FORGOTTEN: f64 = 45.0;
/// Tolerance of each step.
pub(super) fn step_tolerance(tolerance: f64) -> f64 {
    (SHARE * tolerance).max(TIGHTEST)
}

/// A lap on its lane.
pub(super) struct HalfLaps {
    pub lap: SlipLap,
    pub drive_speed: f64,
    pub speed_max: f64,
    /// Pull of the grip with which the lap is to end at the drive speed, and begin anew, if not at its slowest point.
    pub meets: Option<f64>,
    /// Pull with which the forward half has slowed to the section, once it has.
    arrived: Option<f64>,
    /// Drag in steady sliding at the drive speed.
    steady: f64,
    steps: u32,
}

/// What a step of a lap has come to.
pub(super) enum Met {
    Nothing,
    /// The end of the lap.
    End(Outcome),
    /// A lap that cannot be followed.
    Lost,
}

impl HalfLaps {
    /// A lap whose drive speed is still to be said.
    pub(super) fn new(lap: SlipLap) -> Self {
        Self {
            lap,
            drive_speed: f64::NAN,
            speed_max: 0.0,
            meets: None,
            arrived: None,
            steady: f64::NAN,
            steps: 0,
        }
    }

    /// Begin the lap with a pull and a speed.
    pub(super) fn begin(&mut self, lanes: &mut Lanes, l: usize, from: (f64, f64)) {
        (self.arrived, self.speed_max) = (None, 0.0);
        self.steady = self.lap.force(self.drive_speed);
        self.load(lanes, l, from, 1.0);
    }

    pub(super) fn is_on_the_way_back(&self) -> bool {
        self.arrived.is_some()
    }

    /// Whether the way back begins where the slowest point is forgotten.
    pub(super) fn passes_over_the_start(&self) -> bool {
        self.last_point().1 > self.lap.slowest
    }

    /// Speed at which the two halves are compared.
    fn section(&self) -> f64 {
        self.drive_speed.min(1.0)
    }

    fn load(&mut self, lanes: &mut Lanes, l: usize, (pull, speed): (f64, f64), sense: f64) {
        let SlipLap { damping, mixed, ehl, slowest, rest } = self.lap;
        // only where belt and drive meet under a roll that slips
        let fast = speed > 1.0 || (speed >= 1.0 && sense > 0.0);
        let exponent = if fast { ehl } else { mixed };
        self.steps = 0;
        (lanes.time[l], lanes.impulse[l], lanes.sense[l]) = (0.0, 0.0, sense);
        (lanes.pull[l], lanes.speed[l], lanes.rest[l]) = (pull, speed, rest);
        lanes.drag[l] = damping * speed.powf(exponent);
        (lanes.drive[l], lanes.exponent[l], lanes.floor[l]) = (self.drive_speed, exponent, slowest);
        (lanes.lower[l], lanes.upper[l]) = if fast {
            (1.0, f64::INFINITY)
        } else {
            (0.5 * slowest, if sense > 0.0 { 1.0 } else { self.section() })
        };
        let balanced = pull.to_bits() == (lanes.drag[l] + rest * speed).to_bits();
        if balanced {
            lanes.balance(l);
        }
        lanes.turned[l] = f64::from(balanced);
    }

    /// Pull and speed from which the lap is followed back in time.
    ///
    /// Back in time laps close in on the curve of slow motion, `p = F + u'` with `u' = (w - u)/F'`, by the
    /// factor `exp(-integral of F'^2/(w - u) du)` up to the section. Where little is left of the rest, the
    /// stiff part of the way is passed over.
    fn last_point(&self) -> (f64, f64) {
        let SlipLap { damping, mixed, slowest, rest, .. } = self.lap;
        let power = 2.0 * mixed - 1.0;
        let steepness = (mixed * damping).powi(2) / (self.drive_speed * -power);
        let section = self.section().min(self.lap.rising_from());
        // as if nothing but the contact dragged, whose slope is the steeper one
        let begin = (section.powf(power) + FORGOTTEN / steepness).powf(1.0 / power);
        if begin <= slowest {
            return (self.lap.mixed_force(slowest), slowest);
        }
        let begin = if rest == 0.0 { begin } else { self.begin_beside_rest(section, begin) };
        let begin = begin.min(0.9 * section).max(slowest);
        let slope = mixed * (damping * begin.powf(mixed)) / begin + rest;
        (self.lap.mixed_force(begin) + (self.drive_speed - begin) / slope, begin)
    }

    /// Where the way back begins, at `most` or slower, if the rest of the drive takes from the slope of the drag.
    fn begin_beside_rest(&self, section: f64, most: f64) -> f64 {
        let SlipLap { damping, mixed, slowest, rest, .. } = self.lap;
        let steep = -mixed * damping;
        // integral of F'^2, up to a constant
        let forgets = |u: f64| {
            let fall = steep * u.powf(mixed) / u;
            u * (fall * fall / (2.0 * mixed - 1.0) - 2.0 * rest * fall / mixed + rest * rest)
        };
        let enough = forgets(section) - FORGOTTEN * self.drive_speed;
        let (mut low, mut high) = (slowest, most);
        for _ in 0..MAX_HALVINGS {
            let middle = (low * high).sqrt();
            if forgets(middle) < enough { low = middle } else { high = middle }
        }
        low
    }

    /// Go on from where a step of the lap has ended.
    pub(super) fn meet(&mut self, lanes: &mut Lanes, l: usize) -> Met {
        self.steps += 1;
        let met = lanes.arrival[l];
        if met == arrival::LOST || self.steps > MAX_STEPS {
            return Met::Lost;
        }
        if self.creeps_to_the_drive(lanes, l) || self.dies_out(lanes, l) {
            return Met::End(Outcome::Escapes);
        }
        if met == arrival::NONE {
            return Met::Nothing;
        }
        if let Some(pull) = self.arrived {
            if self.goes_on_back(lanes, l) {
                return Met::Nothing;
            }
            // back in time from the slowest point the belt has reached the section
            return Met::End(Outcome::Gap(pull - lanes.pull[l]));
        }
        let SlipLap { damping, mixed, ehl, rest, .. } = self.lap;
        if met == arrival::UPPER {
            (lanes.drag[l], lanes.exponent[l]) = (damping, ehl);
            (lanes.lower[l], lanes.upper[l]) = (1.0, f64::INFINITY);
            return Met::Nothing;
        }
        if met == arrival::TURNING {
            if self.speed_max > 0.0 {
                // the belt speeds up again before it has slowed to the section: it has escaped
                return Met::End(Outcome::Escapes);
            }
            self.speed_max = lanes.speed[l];
            if self.speed_max < 1.0 {
                lanes.lower[l] = self.section();
            }
            return Met::Nothing;
        }
        if lanes.speed[l] > self.section() {
            (lanes.drag[l], lanes.exponent[l]) = (damping, mixed);
            (lanes.lower[l], lanes.upper[l]) = (self.section(), 1.0);
            return Met::Nothing;
        }
        let drive = self.drive_speed;
        let contact = damping * drive.powf(mixed);
        if drive <= 1.0 && -mixed * contact - rest * drive >= 2.0 * drive {
            // steady sliding is an unstable node: whatever falls below it sticks, and back in time laps end there
            let steady = contact + rest * drive;
            return Met::End(Outcome::Gap(lanes.pull[l] - steady));
        }
        self.arrived = Some(lanes.pull[l]);
        let last = self.last_point();
        self.load(lanes, l, self.meets.map_or(last, |grip| (grip, drive)), -1.0);
        if self.meets.is_some() && drive <= 1.0 {
            lanes.lower[l] = last.1;
        }
        Met::Nothing
    }

    /// Whether the lap back from where the roll slips goes on: over the transition, past its slowest point, or,
    /// where that is slower than any that matters, from there.
    fn goes_on_back(&mut self, lanes: &mut Lanes, l: usize) -> bool {
        if self.meets.is_none() || lanes.arrival[l] == arrival::UPPER {
            return false;
        }
        let SlipLap { damping, mixed, .. } = self.lap;
        if lanes.arrival[l] == arrival::TURNING {
            return true;
        }
        let last = self.last_point();
        if lanes.speed[l] > last.1 {
            (lanes.drag[l], lanes.exponent[l]) = (damping, mixed);
            (lanes.lower[l], lanes.upper[l]) = (last.1, 1.0);
        } else {
            self.load(lanes, l, last, -1.0);
        }
        true
    }

    /// Whether the belt slows down so gently that it cannot fall below a drive faster than the transition.
    ///
    /// With `y = u - w > 0` the EHL branch gives `y'' = -y - c y'`, where the damping `c = e F/u + r` only grows as
    /// the belt slows down. From `c >= 2` and `y' >= -y` on, `y' >= -y` holds for good and `y` never passes zero.
    fn creeps_to_the_drive(&self, lanes: &Lanes, l: usize) -> bool {
        let (speed, ahead) = (lanes.speed[l], lanes.speed[l] - self.drive_speed);
        self.drive_speed >= 1.0
            && self.speed_max > 0.0
            && speed >= 1.0
            && self.arrived.is_none()
            && self.lap.ehl * lanes.drag[l] + self.lap.rest * speed >= 2.0 * speed
            && lanes.pull[l] - (lanes.drag[l] + self.lap.rest * speed) >= -ahead
    }

    /// Whether the belt has too little energy about steady sliding to slow down to the transition ever again: on the
    /// rising branch that energy only falls.
    fn dies_out(&self, lanes: &Lanes, l: usize) -> bool {
        let margin = self.drive_speed - 1.0;
        let (ahead, off) = (lanes.speed[l] - self.drive_speed, lanes.pull[l] - self.steady);
        margin > 0.0
            && self.speed_max > 0.0
            && lanes.speed[l] >= 1.0
            && self.arrived.is_none()
            && ahead * ahead + off * off < margin * margin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_back_begins_where_the_rest_is_forgotten() {
        let lap = SlipLap { damping: 20.0, slowest: 1e-4, mixed: -0.09, ehl: 0.3, rest: 0.3 };
        let halves = HalfLaps { drive_speed: 1.5, ..HalfLaps::new(lap) };
        let begin = halves.begin_beside_rest(1.0, 0.9);
        let slope = |u: f64| lap.mixed * lap.damping * u.powf(lap.mixed - 1.0) + lap.rest;
        let step = (1.0 - begin) / 1e5;
        let forgotten: f64 = (0..100_000)
            .map(|i| slope(begin + (f64::from(i) + 0.5) * step).powi(2) / halves.drive_speed * step)
            .sum();
        assert!((forgotten - FORGOTTEN).abs() < 0.5, "{begin} {forgotten}");
    }
}
