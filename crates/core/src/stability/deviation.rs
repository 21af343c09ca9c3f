//! What becomes of a small deviation along a lap.
//!
//! Two neighbouring motions at one drive speed enclose an area with the flow that changes as `exp(-integral of F' dt)`; a
//! drive that is a little faster adds the integral of the gain in speed, which shrinks likewise from where it is added.

use crate::motion::lanes::Lanes;

/// A state on the way, with what the quadrature of a step takes from it.
#[derive(Clone, Copy)]
pub(super) struct Point {
    time: f64,
    sense: f64,
    /// Rate of the speed, in the time of the motion.
    pub gain: f64,
    /// How much faster the drive is.
    ahead: f64,
    /// How steeply drag rises with speed, and the first two derivatives of that in the time of the motion.
    slope: [f64; 3],
}

impl Point {
    /// Where a lane is, whose drag is a power of the speed there.
    pub(super) fn of(lanes: &Lanes, l: usize, exponent: f64) -> Self {
        let (speed, contact) = (lanes.speed[l], lanes.drag[l]);
        let gain = lanes.pull[l] - contact - lanes.rest[l] * speed;
        let ahead = lanes.drive[l] - speed;
        let per = 1.0 / speed;
        let of_contact = exponent * contact * per;
        let bend = (exponent - 1.0) * of_contact * per;
        let slope = of_contact + lanes.rest[l];
        let second = (exponent - 2.0) * gain * gain * per + ahead - slope * gain;
        Self {
            time: lanes.time[l],
            sense: lanes.sense[l],
            gain,
            ahead,
            slope: [slope, bend * gain, bend * second],
        }
    }

    /// The gain in speed and its first two derivatives, weighed by what a deviation shrinks by from the start of a step.
    fn weighed_gain(&self, weight: f64) -> [f64; 3] {
        [self.gain, self.ahead, self.slope[0] * self.ahead - self.gain].map(|v| v * weight)
    }
}

/// What a way from the slowest point, forward or back in time, has made of a deviation.
#[derive(Clone, Copy)]
pub(super) struct Deviation {
    /// Share that is left of what there was at first.
    pub kept: f64,
    /// What a faster drive has added.
    pub added: f64,
    /// Most e-folds by which one step has changed it.
    steepest: f64,
}

impl Deviation {
    pub(super) const NEW: Self = Self { kept: 1.0, added: 0.0, steepest: 0.0 };

    /// Follow it over one step.
    pub(super) fn pass(&mut self, from: &Point, to: &Point) {
        let (h, sense) = (to.time - from.time, from.sense);
        let folds = sense * integral(h, sense, from.slope, to.slope);
        let shrinks = folds.exp();
        self.kept /= shrinks;
        let added = integral(h, sense, from.weighed_gain(1.0), to.weighed_gain(shrinks));
        self.added = (self.added + added) / shrinks;
        self.steepest = self.steepest.max(folds.abs());
    }

    /// Relative error of what is added: that of the quadrature over an exponential.
    pub(super) fn error(&self) -> f64 {
        (1e-5 * self.steepest.powi(6)).min(1.0)
    }
}

/// Hermite's quadrature of the sixth order over a time `h`, from values and derivatives at its ends.
fn integral(h: f64, sense: f64, from: [f64; 3], to: [f64; 3]) -> f64 {
    let bent = h / 120.0 * (from[2] + to[2]);
    h * (0.5 * (from[0] + to[0]) + h * (0.1 * sense * (from[1] - to[1]) + bent))
}
