//! Temperature as a state: two bodies that exchange heat, warmed by a heater and by the friction that they shape.
//!
//! The first body is what the film is part of (heater, belt, film), the second the roll: with temperatures `T`,
//! `C_1 T_1' = P + q - W_1 - H (T_1 - T_2) - G_1 (T_1 - T_0)` and
//! `C_2 T_2' = H (T_1 - T_2) - W_2 - G_2 (T_2 - T_0)`: heater power `P`, friction of the contact `q`, what paper takes
//! `W`, exchange `H`, losses `G` to surroundings of `T_0`. The drag law follows `T_1`, and heats it: each piece of the
//! motion is made anew until the temperature that it assumed is the one that its own friction makes.
//!
//! A contact that holds a belt at a small speed, as the paper's rule has it, may push it on: its power is negative then.
//! Friction cools nothing, so such energy is owed, and what friction takes afterwards pays it back before it heats.

use super::piece::{Path, Piece};
use super::polynomial::{
    INVERSE, INVERSE_NEXT, ORDER, Polynomial, derivative, first_crossing, value,
};
use super::recurrence::product;
use super::schedule::Schedule;
use super::taylor::rough_root;
use crate::drag::Mode;
use crate::error::{Error, above, at_least, finite};

/// What heats the first body.
#[derive(Debug, Clone, PartialEq)]
pub enum Heater {
    /// Given power, W.
    Power(Schedule),
    /// Power in proportion to what is missing to a set temperature, between nothing and the most there is.
    Controlled {
        /// Temperature held, K.
        setpoint: f64,
        /// W.
        most: f64,
        /// W/K.
        gain: f64,
    },
}

/// Two bodies that exchange heat.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatBalance {
    /// Heat capacities, J/K.
    pub capacity: [f64; 2],
    /// Between the bodies, W/K.
    pub exchange: f64,
    /// To the surroundings, W/K.
    pub loss: [f64; 2],
    /// Temperature of the surroundings, K.
    pub surroundings: f64,
    /// What heats the first.
    pub heater: Heater,
    /// What is taken from each, as by paper, W.
    pub load: [Schedule; 2],
    /// Temperatures at the start, K.
    pub start: [f64; 2],
    /// Zero of the temperature scale of the drag law, K.
    pub temperature_zero: f64,
}

impl HeatBalance {
    pub(super) fn check(&self) -> Result<(), Error> {
        for i in 0..2 {
            above("heat capacity", self.capacity[i], 0.0)?;
            at_least("heat loss", self.loss[i], 0.0)?;
            above("temperature at the start", self.start[i], 0.0)?;
        }
        at_least("heat exchange", self.exchange, 0.0)?;
        above("temperature of the surroundings", self.surroundings, 0.0)?;
        finite("zero of the temperature scale", self.temperature_zero)?;
        if let Heater::Controlled { setpoint, most, gain } = self.heater {
            above("temperature of the heater", setpoint, 0.0)?;
            at_least("power of the heater", most, 0.0)?;
            above("gain of the heater", gain, 0.0)?;
        }
        Ok(())
    }
}

/// Share of a debt that is rounding.
const PAID: f64 = 1e-12;

/// Which law the heater follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Heating {
    Given,
    Off,
    Proportional,
    Full,
}

/// The bodies at the time that the motion has reached.
pub(super) struct Heat<'a> {
    balance: &'a HeatBalance,
    /// Temperatures from now on.
    pub courses: [Polynomial; 2],
    heating: Heating,
    /// Energy that the contact has given the belt and not got back, J, and the power that changes it from now on.
    pub owed: f64,
    owing: Polynomial,
    /// Segments of heater power and loads that hold now.
    segments: [usize; 3],
}

impl<'a> Heat<'a> {
    pub(super) fn at_start(balance: &'a HeatBalance) -> Self {
        let courses = balance.start.map(|t| {
            let mut course = [0.0; ORDER + 1];
            course[0] = t;
            course
        });
        let (heating, owing) = (Heating::Given, [0.0; ORDER + 1]);
        let mut heat = Self { balance, courses, heating, owed: 0.0, owing, segments: [0; 3] };
        heat.segments = heat.schedules().map(|s| s.map_or(0, |s| s.segment(0.0)));
        heat.choose_heating();
        heat
    }

    /// Heater power, if it is given, and what is taken from each body.
    fn schedules(&self) -> [Option<&'a Schedule>; 3] {
        let power = match &self.balance.heater {
            Heater::Power(schedule) => Some(schedule),
            Heater::Controlled { .. } => None,
        };
        [power, Some(&self.balance.load[0]), Some(&self.balance.load[1])]
    }

    /// When a schedule changes its formula.
    pub(super) fn next_change(&self) -> f64 {
        let ends = self.schedules().into_iter().zip(self.segments);
        ends.filter_map(|(s, segment)| Some(s?.end(segment))).fold(f64::INFINITY, f64::min)
    }

    /// Enter the segments that begin at `time`.
    pub(super) fn pass_change(&mut self, time: f64) {
        let schedules = self.schedules();
        for (schedule, segment) in schedules.into_iter().zip(&mut self.segments) {
            if schedule.is_some_and(|s| s.end(*segment) <= time) {
                *segment += 1;
            }
        }
    }

    /// Temperatures at which the heater begins to give less than the most, and nothing.
    fn switches(&self) -> Option<(f64, f64)> {
        match self.balance.heater {
            Heater::Power(_) => None,
            Heater::Controlled { setpoint, most, gain } => Some((setpoint - most / gain, setpoint)),
        }
    }

    #[allow(clippy::float_cmp)] // a limit is reached by assigning it
    fn choose_heating(&mut self) {
        let Some((full, off)) = self.switches() else { return };
        let (now, rising) = (self.courses[0][0], self.courses[0][1] > 0.0);
        let below = |limit: f64| if now == limit { !rising } else { now < limit };
        self.heating = match (below(full), below(off)) {
            (true, _) => Heating::Full,
            (false, true) => Heating::Proportional,
            (false, false) => Heating::Off,
        };
    }

    /// What of the `power` of the contact heats from now on, and how long that is so within `span`.
    pub(super) fn heating_part(&mut self, power: &Polynomial, span: f64) -> (Polynomial, f64) {
        let span = if span.is_finite() { span } else { 1e9 };
        let first = power.iter().find(|c| **c != 0.0).copied().unwrap_or(0.0);
        if self.owed == 0.0 && first >= 0.0 {
            self.owing = [0.0; ORDER + 1];
            return (*power, first_crossing(power, span).unwrap_or(f64::INFINITY));
        }
        self.owing = *power;
        let mut debt = [0.0; ORDER + 1];
        debt[0] = self.owed;
        for n in 0..ORDER {
            debt[n + 1] = -power[n] * INVERSE_NEXT[n];
        }
        ([0.0; ORDER + 1], first_crossing(&debt, span).unwrap_or(f64::INFINITY))
    }

    /// Take up energy at once.
    pub(super) fn take(&mut self, energy: f64) {
        let paid = energy.min(self.owed);
        self.owed -= paid;
        self.courses[0][0] += (energy - paid) / self.balance.capacity[0];
    }

    /// Temperatures from `time` on under the heat of friction, and how long their first `terms` powers are good for: to the
    /// precision asked for, and until the heater changes its law.
    pub(super) fn foreseen(
        &mut self,
        time: f64,
        friction: &Polynomial,
        terms: usize,
        tolerance: f64,
    ) -> ([Polynomial; 2], f64) {
        let b = self.balance;
        let mut t = [[0.0; ORDER + 1]; 2];
        (t[0][0], t[1][0]) = (self.courses[0][0], self.courses[1][0]);
        let given = self.schedules().into_iter().zip(self.segments);
        let mut flows = given.map(|(s, segment)| s.map_or([0.0; 4], |s| s.about(segment, time)));
        let mut next = || flows.next().unwrap_or([0.0; 4]);
        let (power, loads) = (next(), [next(), next()]);
        for n in 0..ORDER {
            let of = |cubic: &[f64; 4]| cubic.get(n).copied().unwrap_or(0.0);
            let once = |value: f64| if n == 0 { value } else { 0.0 };
            let heater = match (&b.heater, self.heating) {
                (Heater::Controlled { setpoint, gain, .. }, Heating::Proportional) => {
                    gain * (once(*setpoint) - t[0][n])
                }
                (Heater::Controlled { most, .. }, Heating::Full) => once(*most),
                (Heater::Controlled { .. }, _) => 0.0,
                (Heater::Power(_), _) => of(&power),
            };
            let exchanged = b.exchange * (t[0][n] - t[1][n]);
            let lost = |i: usize| b.loss[i] * (t[i][n] - once(b.surroundings)) + of(&loads[i]);
            let flow = [heater + friction[n] - exchanged - lost(0), exchanged - lost(1)];
            for i in 0..2 {
                t[i][n + 1] = flow[i] * INVERSE[n + 1] / b.capacity[i];
            }
            if n == 0 {
                // at the limit of two laws of the heater, where both give the same, it is known now which one follows
                self.courses[0][1] = t[0][1];
                self.choose_heating();
            }
        }
        let mut good = f64::INFINITY;
        for course in &t {
            for power in [terms, ORDER] {
                let last = (course[power] / course[0]).abs();
                if last > 0.0 {
                    good = good.min(rough_root(tolerance / last, power as u64));
                }
            }
        }
        (t, good.min(self.until_switched(&t[0], good)))
    }

    /// When the heater changes its law within `good`, if it does.
    fn until_switched(&self, course: &Polynomial, good: f64) -> f64 {
        let Some((full, off)) = self.switches() else { return f64::INFINITY };
        let above = |limit: f64| {
            let mut gap = *course;
            gap[0] -= limit;
            gap
        };
        let below = |limit: f64| above(limit).map(|c| -c);
        let gaps = match self.heating {
            Heating::Given => vec![],
            Heating::Full => vec![below(full)],
            Heating::Off => vec![above(off)],
            Heating::Proportional => vec![above(full), below(off)],
        };
        let span = if good.is_finite() { good } else { 1e9 };
        gaps.iter()
            .filter_map(|gap| first_crossing(gap, span))
            .filter(|t| *t > 0.0)
            .fold(f64::INFINITY, f64::min)
    }

    /// Go on by `elapsed` along the courses.
    pub(super) fn pass(&mut self, elapsed: f64) {
        let given = elapsed
            * (0..=ORDER).rev().fold(0.0, |sum, n| sum * elapsed + self.owing[n] * INVERSE_NEXT[n]);
        // paid back but for rounding is paid
        let left = self.owed - given;
        self.owed = if left > PAID * (self.owed + given.abs()) { left } else { 0.0 };
        for course in &mut self.courses {
            let (now, rate) = (value(course, elapsed), value(&derivative(course), elapsed));
            *course = [0.0; ORDER + 1];
            (course[0], course[1]) = (now, rate);
        }
        if let Some((full, off)) = self.switches() {
            let now = &mut self.courses[0][0];
            for limit in [full, off] {
                if (*now - limit).abs() <= 1e-13 * limit {
                    *now = limit;
                }
            }
        }
        self.choose_heating();
    }

    /// The temperature that the drag law follows, in its scale.
    pub(super) fn course_of_law(&self) -> Polynomial {
        let mut course = self.courses[0];
        course[0] -= self.balance.temperature_zero;
        course
    }
}

impl Piece<'_> {
    /// Power that the contact takes from the belt over the piece, `factor` that of the rest of the drive along it; of one
    /// made of steps, by its values at four times.
    pub(super) fn power_of_contact(&self, factor: &Polynomial) -> Polynomial {
        let rest = self.flow.drag.rest();
        match &self.path {
            Path::Series(series) => {
                // a held belt is braked by just the pull, and a creeping one by that and its own slowing down
                let mut contact = match self.start.mode {
                    Mode::Stuck => series.pull,
                    _ if self.start.creeping => {
                        let slowing = derivative(&series.speed);
                        std::array::from_fn(|n| series.pull[n] - self.flow.mass * slowing[n])
                    }
                    _ => series.drag,
                };
                for (n, c) in contact.iter_mut().enumerate() {
                    *c -= rest.force * factor[n] + rest.damping * product(&series.speed, factor, n);
                }
                let mut heat = [0.0; ORDER + 1];
                for (n, c) in heat.iter_mut().enumerate() {
                    *c = product(&contact, &series.speed, n);
                }
                heat
            }
            Path::Steps { .. } => {
                let times = [0.0, 1.0, 2.0, 3.0].map(|i| i / 3.0 * self.duration);
                let powers = times.map(|t| {
                    let state = self.state(t);
                    let rest = self.flow.rest_factor(t) * rest.at(state[1]);
                    (self.flow.force(t, &state) - rest) * state[1]
                });
                through(&powers, self.duration / 3.0)
            }
        }
    }
}

/// The cubic through four values `step` apart.
fn through(y: &[f64; 4], step: f64) -> Polynomial {
    let first = [y[1] - y[0], y[2] - y[1], y[3] - y[2]];
    let second = [first[1] - first[0], first[2] - first[1]];
    let third = second[1] - second[0];
    // Newton's form in s = t/step
    let (a, b, c) = (first[0], 0.5 * second[0], third / 6.0);
    let mut cubic = [0.0; ORDER + 1];
    cubic[0] = y[0];
    cubic[1] = (a - b + 2.0 * c) / step;
    cubic[2] = (b - 3.0 * c) / (step * step);
    cubic[3] = c / (step * step * step);
    cubic
}
