//! One slip step: the Taylor series of stretch and belt speed.
//!
//! The drag term is advanced by the recurrence of its own differential equation (powers and
//! exponentials of a series), so a step costs one call of `pow` or `exp`. See Jorba and Zou, "A
//! software package for the numerical integration of ODEs by means of high-order Taylor methods",
//! Experimental Mathematics 14 (2005).

use super::polynomial::{ORDER, Polynomial};

/// Drag along the motion, for speeds `u >= 0`.
#[derive(Debug, Clone, Copy)]
pub(super) enum SlipDrag {
    /// Drag `force` at the start of the step, varying as `u^exponent`.
    Power { force: f64, exponent: f64 },
    /// Drag `force` at the start of the step, varying as `exp(-u/speed)`.
    Exponential { force: f64, speed: f64 },
}

/// Series of a step, in time since its start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Series {
    /// Spring stretch.
    pub stretch: Polynomial,
    /// Belt speed.
    pub speed: Polynomial,
    /// Drag force.
    pub drag: Polynomial,
}

/// Series of `s' = drive_speed - u`, `m u' = k s - F(u)` from (`stretch`, `speed`).
#[allow(clippy::cast_precision_loss)] // powers are at most ORDER
pub(super) fn slip_series(
    stiffness: f64,
    mass: f64,
    drive_speed: f64,
    law: SlipDrag,
    stretch: f64,
    speed: f64,
) -> Series {
    let (mut y, mut u, mut f) = ([0.0; ORDER + 1], [0.0; ORDER + 1], [0.0; ORDER + 1]);
    (y[0], u[0]) = (stretch, speed);
    f[0] = match law {
        SlipDrag::Power { force, .. } | SlipDrag::Exponential { force, .. } => force,
    };
    for j in 0..ORDER {
        let n = (j + 1) as f64;
        // not fused: at a release the two forces are equal, and their difference is exactly nil
        u[j + 1] = (stiffness * y[j] - f[j]) / (mass * n);
        y[j + 1] = if j == 0 { drive_speed - u[0] } else { -u[j] / n };
        f[j + 1] = match law {
            SlipDrag::Power { exponent, .. } => {
                let sum: f64 = (1..=j + 1)
                    .map(|i| (exponent * i as f64 - (j + 1 - i) as f64) * u[i] * f[j + 1 - i])
                    .sum();
                sum / (n * u[0])
            }
            SlipDrag::Exponential { speed, .. } => {
                let sum: f64 = (1..=j + 1).map(|i| i as f64 * u[i] * f[j + 1 - i]).sum();
                -sum / (n * speed)
            }
        };
    }
    Series { stretch: y, speed: u, drag: f }
}

/// Series of creep, where the belt slows just as fast as the growing backward pull allows.
///
/// A belt that moves at `speed < v_s` against the pull of the spring cannot leave the holding force
/// `A exp(-u/v_s)`: any faster and it is held, any slower and it slips. So `A exp(-u/v_s) = -k s` stays
/// true while `s' = drive_speed - u`, that is `u' = -v_s (ln(-s))'`.
#[allow(clippy::cast_precision_loss)] // powers are at most ORDER
pub(super) fn creep_series(drive_speed: f64, stick_speed: f64, stretch: f64, speed: f64) -> Series {
    let (mut y, mut u) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
    let mut log = [0.0; ORDER + 1];
    (y[0], u[0]) = (stretch, speed);
    for j in 0..ORDER {
        let n = (j + 1) as f64;
        y[j + 1] = if j == 0 { drive_speed - u[0] } else { -u[j] / n };
        let sum: f64 = (1..=j).map(|i| i as f64 * log[i] * y[j + 1 - i]).sum();
        log[j + 1] = (y[j + 1] - sum / n) / y[0];
        u[j + 1] = -stick_speed * log[j + 1];
    }
    Series { stretch: y, speed: u, drag: [0.0; ORDER + 1] }
}

impl Series {
    /// Longest step for which the last two terms stay below `tolerance` times the scales.
    pub(super) fn step_size(&self, tolerance: f64, stretch_scale: f64, speed_scale: f64) -> f64 {
        let mut step = f64::INFINITY;
        for (series, scale) in [(&self.stretch, stretch_scale), (&self.speed, speed_scale)] {
            for power in [ORDER - 1, ORDER] {
                #[allow(clippy::cast_precision_loss)] // at most ORDER
                let root = 1.0 / power as f64;
                if series[power] != 0.0 {
                    step = step.min((tolerance * scale / series[power].abs()).powf(root));
                }
            }
        }
        step
    }
}
