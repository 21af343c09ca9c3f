//! A belt on two power branches in units that suit it: its drag, and the speeds that follow from that.
//!
//! Time is scaled by `sqrt(m/k)`, speed by `v_t` and pull by `v_t sqrt(k m)`; what the rest of the drive drags at any speed
//! only shifts the pull, which is counted from there.

use crate::drag::{Closure, Drag};
use crate::motion::Drivetrain;

/// Most iterations for the speed that drags with a given force.
const MAX_NEWTON: usize = 50;

/// What remains of a belt with two power branches once units are chosen to suit it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipLap {
    /// Drag at the transition over `v_t sqrt(k m)`.
    pub damping: f64,
    /// Slowest speed of the lap over `v_t`.
    pub slowest: f64,
    /// Exponent of drag on the mixed branch, negative.
    pub mixed: f64,
    /// Exponent of drag on the EHL branch.
    pub ehl: f64,
    /// Drag of the rest of the drive per speed, over `sqrt(k m)`.
    pub rest: f64,
}

impl SlipLap {
    /// Whether steady sliding just below the transition is an unstable node, `|F'| >= 2` there: then no belt comes
    /// back from below the transition.
    #[must_use]
    pub fn is_node(&self) -> bool {
        -self.mixed * self.damping - self.rest >= 2.0
    }

    /// Drag at `u` on the mixed branch, the rest of the drive counted.
    #[must_use]
    pub fn mixed_force(&self, u: f64) -> f64 {
        self.damping * u.powf(self.mixed) + self.rest * u
    }

    /// Drag at `u`.
    pub(super) fn force(&self, u: f64) -> f64 {
        if u < 1.0 { self.mixed_force(u) } else { self.damping * u.powf(self.ehl) + self.rest * u }
    }

    /// Speed from which on drag rises: the transition, or less where the rest of the drive rises faster than the
    /// mixed branch falls. No swing stays above it.
    #[must_use]
    pub fn rising_from(&self) -> f64 {
        if self.rest == 0.0 {
            return 1.0;
        }
        (self.rest / (-self.mixed * self.damping)).powf(1.0 / (self.mixed - 1.0)).min(1.0)
    }

    /// Speed from which on drag, where it rises, is more than `force`.
    pub(super) fn drags(&self, force: f64) -> f64 {
        let Self { damping, ehl, rest, .. } = *self;
        if rest == 0.0 {
            return (force / damping).powf(1.0 / ehl);
        }
        if force < self.mixed_force(1.0) {
            let (mut low, mut high) = (self.rising_from(), 1.0);
            for _ in 0..MAX_NEWTON {
                let middle = 0.5 * (low + high);
                if self.mixed_force(middle) < force { low = middle } else { high = middle }
            }
            return low;
        }
        // from below, where Newton's method keeps to its side of the root or comes back from the other
        let mut u = (0.5 * force / damping).powf(1.0 / ehl).min(0.5 * force / rest);
        for _ in 0..MAX_NEWTON {
            let contact = damping * u.powf(ehl);
            let next = u - (contact + rest * u - force) / (ehl * contact / u + rest);
            let near = (next - u).abs() <= 2.0 * f64::EPSILON * u;
            u = next;
            if near {
                break;
            }
        }
        u
    }

    /// A drive speed close to the baseline's fold, so that few laps are needed.
    pub(super) fn guess(&self) -> f64 {
        0.45 + 0.52 * self.slowest.powf(-0.26)
    }
}

/// The belt in scaled units, if its drag has two power branches whose force follows the speed at once.
///
/// A constant drag of the rest of the drive only shifts the pull. One that grows with speed must leave drag that
/// falls from the stick speed on.
#[must_use]
pub fn slip_lap(train: &Drivetrain, drag: &Drag) -> Option<SlipLap> {
    let (mixed, ehl) = drag.two_branches()?;
    let memory = matches!(drag.closure(), Closure::LuGre { .. });
    if memory || mixed >= 0.0 || ehl <= 0.0 {
        return None;
    }
    let impedance = train.impedance();
    let lap = SlipLap {
        damping: drag.transition_force() / (drag.transition_speed() * impedance),
        slowest: drag.stick_speed() / drag.transition_speed(),
        mixed,
        ehl,
        rest: drag.rest().damping / impedance,
    };
    (lap.slowest < lap.rising_from()).then_some(lap)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_that_drags_with_a_force_is_found_on_either_branch() {
        for (damping, ehl, rest) in
            [(0.3, 0.3, 0.1), (2.0, 1.7, 5.0), (0.1, 0.5, 0.0), (1.0, 0.3, 0.9)]
        {
            let lap = SlipLap { damping, slowest: 0.01, mixed: -0.2, ehl, rest };
            for u in [0.9, 1.0, 1.5, 40.0] {
                let force = lap.force(u);
                if u > lap.rising_from() {
                    assert!((lap.drags(force) - u).abs() < 1e-12 * u, "{lap:?} {u}");
                }
            }
        }
    }
}
