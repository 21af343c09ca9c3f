//! Speeds of a given force, and the speed from which on the drag rises.

use super::Drag;

impl Drag {
    /// The speeds on either side of the transition at which drag has risen to `force`: below it none, so zero, where
    /// the stick speed is reached first; above it infinite, where drag never gets there.
    ///
    /// On a law that falls to its least force and rises from it these are the only ones; for less force, both are the
    /// speed of least force.
    #[must_use]
    pub fn speeds_of(&self, force: f64) -> (f64, f64) {
        let smooth = self.rest.damping > 0.0 || self.mixed.is_some();
        let foot = if smooth { self.rising_from() } else { self.transition_speed() };
        if force <= self.force(foot) {
            return (foot, foot);
        }
        if smooth {
            return self.searched_speeds(force, foot);
        }
        let force = force - self.rest.force;
        let on = |branch: usize, knot: usize| {
            let ((v, f), exponent) = (self.knots[knot], self.exponents[branch]);
            v * (force / f).powf(1.0 / exponent)
        };
        let slower = (self.branch(self.stick_speed)..=self.transition).rev().find_map(|branch| {
            let low = self.lower_knot(branch).unwrap_or(self.stick_speed);
            (self.branch_force(branch, low) >= force).then(|| on(branch, branch))
        });
        let faster = (self.transition + 1..self.exponents.len()).find_map(|branch| {
            let reached = match self.knots.get(branch) {
                Some((_, end)) => *end >= force,
                None => self.exponents[branch] > 0.0,
            };
            reached.then(|| on(branch, branch - 1))
        });
        (slower.unwrap_or(0.0), faster.unwrap_or(f64::INFINITY))
    }

    /// As `speeds_of`, on either side of the speed of least force, by halving.
    fn searched_speeds(&self, force: f64, foot: f64) -> (f64, f64) {
        let slower = if self.force(self.stick_speed) < force {
            0.0
        } else {
            halved(self.stick_speed, foot, |v| self.force(v) >= force)
        };
        let mut high = 2.0 * foot;
        while self.force(high) < force {
            high *= 2.0;
            if high > HIGHEST * foot {
                return (slower, f64::INFINITY);
            }
        }
        (slower, halved(0.5 * high, high, |v| self.force(v) < force))
    }

    /// Speed from which on the drag rises, the rest of the drive counted: the transition speed, or below it where the
    /// rest rises more than the contact falls; above it the last speed at which it falls.
    #[must_use]
    pub fn rising_from(&self) -> f64 {
        self.rising_from
    }

    pub(super) fn found_rising_from(&self) -> f64 {
        if self.mixed.is_some() {
            return self.mixed_rising_from();
        }
        let mut from = self.stick_speed;
        for branch in self.branch(self.stick_speed)..self.exponents.len() {
            if self.exponents[branch] < 0.0 {
                let end = self.upper_knot(branch).unwrap_or(f64::INFINITY);
                from = from.max(self.branch_rising_from(branch).min(end));
            }
        }
        from
    }

    /// Speed from which on the drag would rise if all of it were as on `branch`, the rest of the drive counted.
    fn branch_rising_from(&self, branch: usize) -> f64 {
        let exponent = self.exponents[branch];
        if exponent > 0.0 {
            return 0.0;
        }
        if self.rest.damping == 0.0 {
            return f64::INFINITY;
        }
        let (speed, force) = self.knots[branch.saturating_sub(1)];
        // where exponent F/v = -damping
        let fall = -exponent * force / speed;
        speed * (fall / self.rest.damping).powf(1.0 / (1.0 - exponent))
    }

    /// How far from `speed`, to either side, the drag is sure to rise with speed, the rest of the drive counted: as far as
    /// its branch of a chain of powers goes. Not positive where it falls.
    pub(crate) fn rises_about(&self, speed: f64) -> f64 {
        if self.mixed.is_some() {
            return 0.0;
        }
        let branch = self.branch(speed);
        let low = self.lower_knot(branch).unwrap_or(self.stick_speed);
        let high = self.upper_knot(branch).unwrap_or(f64::INFINITY);
        (speed - low.max(self.branch_rising_from(branch))).min(high - speed)
    }

    fn mixed_rising_from(&self) -> f64 {
        let transition = self.transition_speed();
        if self.rest.damping == 0.0 {
            return transition;
        }
        let falls = |v: f64| self.slope(v) < 0.0;
        let mut low = transition;
        while !falls(low) {
            if low <= self.stick_speed {
                return self.stick_speed;
            }
            low *= STRIDE;
        }
        halved(low.max(self.stick_speed), (low / STRIDE).min(transition), falls)
    }
}

/// Step in which a speed of least force is looked for, as a factor.
const STRIDE: f64 = 0.97;
/// Most that a speed is looked for beyond that of least force.
const HIGHEST: f64 = 1e12;

/// Where `holds`, which is true at `low` and not at `high`, changes.
fn halved(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::super::Closure;
    use super::*;

    #[test]
    #[allow(clippy::float_cmp)] // limits are given as they are
    fn speeds_of_a_force_have_that_force() {
        let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
        let (slow, fast) = drag.speeds_of(100.0);
        // (v)^-0.2 = 2, (v)^0.3 = 2
        assert!((slow - 1.0 / 32.0).abs() < 1e-15 && (fast - 2_f64.powf(1.0 / 0.3)).abs() < 1e-13);
        assert_eq!(drag.speeds_of(50.0), (1.0, 1.0));
        assert_eq!(drag.speeds_of(10.0), (1.0, 1.0));
        // beyond the drag at the stick speed, 125.6, the belt is held
        assert_eq!(drag.speeds_of(126.0).0, 0.0);
        assert!(drag.speeds_of(125.0).0 > 0.01);
        assert_eq!(drag.speeds_of(f64::INFINITY), (0.0, f64::INFINITY));
        let (speeds, forces) = ([0.01, 0.1, 1.0, 3.0, 9.0], [120.0, 80.0, 50.0, 70.0, 75.0]);
        let table = Drag::tabulated(&speeds, &forces, 0.02, Closure::Retained).unwrap();
        for force in [55.0, 69.0, 72.0, 79.0, 85.0, 100.0] {
            let (slow, fast) = table.speeds_of(force);
            assert!((table.force(slow) / force - 1.0).abs() < 1e-13 && slow < 1.0, "{force}");
            assert!((table.force(fast) / force - 1.0).abs() < 1e-13 && fast > 1.0, "{force}");
        }
        assert_eq!(table.speeds_of(119.0).0, 0.0);
        let falling = Drag::new(50.0, 1.0, -1.1, -1.2, 0.01, Closure::Retained).unwrap();
        assert_eq!(falling.speeds_of(60.0).1, f64::INFINITY);
    }
}
