//! Taylor series of the belts on all lanes: their values, and how far they hold.

use super::polynomial::{counted, fused};

/// Belts that step together.
pub(crate) const LANES: usize = 16;

/// Order of the Taylor steps.
pub(super) const ORDER: usize = 12;

/// Longest step in scaled time.
const LONGEST_STEP: f64 = 2.0;

/// A number of each lane.
pub(super) type Row = [f64; LANES];
/// The coefficients of one quantity on all lanes, by their powers.
type Rows = [Row; ORDER + 1];

/// Taylor coefficients of every lane.
#[repr(align(64))]
pub(super) struct LaneSeries {
    pub pull: Rows,
    pub speed: Rows,
    /// Coefficients of the speed, each times its power.
    pub weighted_speed: Rows,
    pub drag: Rows,
}

impl LaneSeries {
    /// To be written.
    pub fn blank() -> Self {
        let none = [[0.0; LANES]; ORDER + 1];
        Self { pull: none, speed: none, weighted_speed: none, drag: none }
    }
}

/// The powers, as numbers.
pub(super) const POWERS: [f64; ORDER + 1] = counted();

/// One over each power; zero for the first.
#[allow(clippy::cast_precision_loss)] // small
pub(super) const INVERSE: [f64; ORDER + 2] = {
    let mut inverse = [0.0; ORDER + 2];
    let mut i = 1;
    while i <= ORDER + 1 {
        inverse[i] = 1.0 / i as f64;
        i += 1;
    }
    inverse
};

/// Sum of `c_n t^(n - first)` for `n` from `first` on; even and odd powers apart, which shortens the chain.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(super) fn value(c: &Rows, first: usize, t: &Row) -> Row {
    let mut square = [0.0; LANES];
    for l in 0..LANES {
        square[l] = t[l] * t[l];
    }
    let (mut even, mut odd) = ([0.0; LANES], [0.0; LANES]);
    for k in (0..=(ORDER - first) / 2).rev() {
        let n = first + 2 * k;
        for l in 0..LANES {
            even[l] = fused(even[l], square[l], c[n][l]);
        }
        if n < ORDER {
            for l in 0..LANES {
                odd[l] = fused(odd[l], square[l], c[n + 1][l]);
            }
        }
    }
    for l in 0..LANES {
        even[l] = fused(t[l], odd[l], even[l]);
    }
    even
}

/// Upper half of the bits of 1.0, as a number.
const ONE: f64 = 1_072_693_248.0;

/// A number that grows as the logarithm of `x > 0`: the upper half of its bits.
#[inline(always)]
#[allow(clippy::inline_always, clippy::cast_possible_truncation)]
fn rough_logarithm(x: f64) -> f64 {
    f64::from((x.to_bits() >> 32) as i32)
}

/// The longest steps for which the last two terms stay below `tolerance` times the scales.
#[inline(always)]
#[allow(
    clippy::inline_always,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss
)]
pub(super) fn step_size(p: &Rows, u: &Rows, floor: &Row, tolerance: f64) -> Row {
    let mut h = [0.0; LANES];
    for l in 0..LANES {
        let speed_scale = if u[0][l] > floor[l] { u[0][l] } else { floor[l] };
        let pull = p[0][l].abs();
        let pull_scale = if pull > speed_scale { pull } else { speed_scale };
        let (per_speed, per_pull) = (1.0 / speed_scale, 1.0 / pull_scale);
        let relative = |n: usize| {
            let (a, b) = (u[n][l].abs() * per_speed, p[n][l].abs() * per_pull);
            // never nil, so that it has a logarithm
            (if a > b { a } else { b }) + 1e-280
        };
        let of = |n: usize| (rough_logarithm(tolerance) - rough_logarithm(relative(n))) / n as f64;
        let (last, before) = (of(ORDER), of(ORDER - 1));
        let log = ONE + if last < before { last } else { before };
        let step = f64::from_bits(u64::from(log as u32) << 32);
        h[l] = if step < LONGEST_STEP { step } else { LONGEST_STEP };
    }
    h
}
