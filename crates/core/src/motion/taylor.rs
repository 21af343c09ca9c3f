//! One slip step: the Taylor series of pull and belt speed.
//!
//! The drag term is advanced by the recurrence of its own differential equation (powers and
//! exponentials of a series), so a step costs one call of `pow` or `exp`. See Jorba and Zou, "A
//! software package for the numerical integration of ODEs by means of high-order Taylor methods",
//! Experimental Mathematics 14 (2005).

use super::polynomial::{INVERSE, ORDER, POWERS, Polynomial, fused};
use super::recurrence::{Recurrence, drag_term, product};
use super::schedule::Cubic;
use super::sharing::{SharingSeries, SharingStart};
use super::thermal::ThermalFactors;
use crate::drag::Rest;

/// Series of a step, in time since its start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Series {
    /// Pull of the spring.
    pub pull: Polynomial,
    /// Belt speed.
    pub speed: Polynomial,
    /// Drag force; of a held belt, the force that could hold it.
    pub drag: Polynomial,
}

/// The factor of what does not move.
pub(super) const UNCHANGED: Polynomial = {
    let mut c = [0.0; ORDER + 1];
    c[0] = 1.0;
    c
};

/// What a slip step starts from.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlipStart<'a> {
    pub stiffness: f64,
    pub mass: f64,
    /// Rate of the pull if the belt stood still, about the start of the step.
    pub rate: Cubic,
    pub pull: f64,
    pub speed: f64,
    /// Drag of the contact at the start, before temperature has any part in it.
    pub force: f64,
    /// Drag at the start, all of it.
    pub total: f64,
    pub law: Recurrence,
    /// What stands in for `law` where film and asperities share the load.
    pub sharing: Option<SharingStart<'a>>,
    pub rest: Rest,
    pub thermal: Option<&'a ThermalFactors>,
    /// Whether the law is that below the stick speed.
    pub below: bool,
}

impl SlipStart<'_> {
    /// Factor of the forces of the contact.
    fn factor(&self) -> Option<&Polynomial> {
        self.thermal.map(|thermal| if self.below { &thermal.below } else { &thermal.force })
    }
}

/// A slip series and where to write it, as work for the best instruction set.
pub(super) struct Slip<'a>(pub &'a SlipStart<'a>, pub &'a mut Series);

impl pulp::WithSimd for Slip<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, _: S) {
        slip_series(self.0, self.1);
    }
}

/// Series of `p' = rate(t) - k u`, `m u' = p - F(u, t)`.
#[inline(always)]
#[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
fn slip_series(start: &SlipStart, series: &mut Series) {
    match start.thermal {
        None if start.sharing.is_none() => plain_series(start, series),
        _ => *series = full_series(start),
    }
}

/// Without temperature, and by one law of drag.
#[inline(always)]
#[allow(clippy::inline_always)]
fn plain_series(start: &SlipStart, series: &mut Series) {
    let mut series = PlainSeries::starting(start, series);
    if cfg!(target_arch = "wasm32") {
        // small rather than quick
        for n in 2..=ORDER {
            series.add(n);
        }
    } else {
        // one at a time, so that all indices are known
        macro_rules! coefficients {
            ($($n:literal)*) => { $(series.add($n);)* };
        }
        coefficients!(2 3 4 5 6 7 8 9 10 11 12 13 14);
        const { assert!(ORDER == 14) };
    }
    let PlainSeries { series, contact, damping, .. } = series;
    let all = series.drag.iter_mut().zip(&series.speed).zip(contact);
    for ((drag, speed), contact) in all.skip(1) {
        *drag = fused(damping, *speed, contact);
    }
}

/// As far as it is known.
struct PlainSeries<'s> {
    series: &'s mut Series,
    driven: Cubic,
    stiffness: f64,
    per_mass: f64,
    /// Of the law, with its inverse.
    weight: f64,
    back: f64,
    /// What the rest of the drive drags per speed.
    damping: f64,
    /// Coefficients of the speed times their power.
    rate: Polynomial,
    /// Drag of the contact.
    contact: Polynomial,
}

impl<'s> PlainSeries<'s> {
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn starting(start: &SlipStart, series: &'s mut Series) -> Self {
        let Recurrence { weight, back, inverse } = start.law;
        let (weight, back) = (weight * inverse, back * inverse);
        let per_mass = 1.0 / start.mass;
        let (mut rate, mut contact) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
        (series.pull[0], series.speed[0], series.drag[0]) = (start.pull, start.speed, start.total);
        contact[0] = start.total - start.rest.at(start.speed);
        // not fused: at a release the two forces are equal, and their difference is exactly nil
        rate[1] = (start.pull - start.total) * per_mass;
        series.speed[1] = rate[1];
        series.pull[1] = start.rate[0] - start.stiffness * start.speed;
        contact[1] = (weight - back) * contact[0] * rate[1];
        let (driven, stiffness, damping) = (start.rate, start.stiffness, start.rest.damping);
        Self { series, driven, stiffness, per_mass, weight, back, damping, rate, contact }
    }

    /// Coefficient `n`. It waits for the one before through two operations only: what else it takes is summed before,
    /// from the middle outwards, for the terms at the ends are the last to be known.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn add(&mut self, n: usize) {
        let (weight, back) = (self.weight, self.back);
        let (per_mass, damping) = (self.per_mass, self.damping);
        let (pull, speed) = (&self.series.pull, &self.series.speed);
        let (rate, contact) = (&self.rate, &self.contact);
        let driven = if n < 5 { self.driven[n - 1] } else { 0.0 };
        let share = weight * INVERSE[n];
        let mut sums = [[0.0; 2]; 2];
        let middle = usize::midpoint(n, 1);
        for i in (2..middle).rev() {
            sums[0][0] = fused(rate[i], contact[n - i], sums[0][0]);
            sums[0][1] = fused(speed[i], contact[n - i], sums[0][1]);
        }
        for i in middle.max(2)..n - 1 {
            sums[1][0] = fused(rate[i], contact[n - i], sums[1][0]);
            sums[1][1] = fused(speed[i], contact[n - i], sums[1][1]);
        }
        let early = share * (sums[0][0] + sums[1][0]) - back * (sums[0][1] + sums[1][1]);
        let early = if n == 2 {
            early // its one term is that with the last drag
        } else {
            fused(contact[1] * (share - back * INVERSE[n - 1]), rate[n - 1], early)
        };
        let undriven =
            fused(-damping * per_mass * INVERSE[n - 1], rate[n - 1], per_mass * pull[n - 1]);
        let now = fused(-per_mass, contact[n - 1], undriven);
        let late = fused(speed[1] * (share - back), contact[n - 1], early);
        let pulled = (driven - self.stiffness * speed[n - 1]) * INVERSE[n];
        self.contact[n] = fused(contact[0] * (weight - back) * INVERSE[n], now, late);
        self.rate[n] = now;
        (self.series.pull[n], self.series.speed[n]) = (pulled, now * INVERSE[n]);
    }
}

/// The same with a law that moves with temperature, or whose load film and asperities share.
#[inline(never)]
fn full_series(start: &SlipStart) -> Series {
    let (mut p, mut u, mut f) = ([0.0; ORDER + 1], [0.0; ORDER + 1], [0.0; ORDER + 1]);
    (p[0], u[0], f[0]) = (start.pull, start.speed, start.total);
    let mut drag = DragSeries::starting(start);
    for n in 1..=ORDER {
        u[n] = (p[n - 1] - f[n - 1]) / start.mass * INVERSE[n];
        let driven = if n < 5 { start.rate[n - 1] } else { 0.0 };
        p[n] = (driven - start.stiffness * u[n - 1]) * INVERSE[n];
        f[n] = drag.force(n, &u);
    }
    Series { pull: p, speed: u, drag: f }
}

/// All drag along a speed, as far as it is known: speeds of the law enter as `q = u/v(T)`, its forces as a factor.
struct DragSeries<'s> {
    start: &'s SlipStart<'s>,
    q: Polynomial,
    /// Coefficients of `q` times their power.
    rate: Polynomial,
    /// Drag of the contact before temperature has any part in it.
    contact: Polynomial,
    sharing: Option<SharingSeries>,
}

impl<'s> DragSeries<'s> {
    fn starting(start: &'s SlipStart<'s>) -> Self {
        let (mut q, mut contact) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
        q[0] = start.speed * start.thermal.map_or(1.0, |thermal| thermal.slowness[0]);
        contact[0] = start.force;
        let sharing = start.sharing.map(|sharing| SharingSeries::starting(sharing, q[0]));
        Self { start, q, rate: [0.0; ORDER + 1], contact, sharing }
    }

    /// Coefficient `n > 0` along the speed `u`, known up to there; it may be asked for again with another `u[n]`.
    fn force(&mut self, n: usize, u: &Polynomial) -> f64 {
        let Self { start, q, rate, contact, sharing } = self;
        q[n] = start.thermal.map_or(u[n], |thermal| product(u, &thermal.slowness, n));
        rate[n] = POWERS[n] * q[n];
        contact[n] = match sharing {
            Some(sharing) => {
                sharing.force(n, q, start.thermal.map_or(&UNCHANGED, |thermal| &thermal.boundary))
            }
            None => drag_term(start.law, n, q, rate, contact),
        };
        start.factor().map_or(contact[n], |factor| product(contact, factor, n))
            + rest_term(start, u, n)
    }
}

/// Coefficient `n` of the drag of the rest of the drive along the speed `u`.
fn rest_term(start: &SlipStart, u: &Polynomial, n: usize) -> f64 {
    let Rest { force, damping } = start.rest;
    match start.thermal {
        _ if start.rest.is_none() => 0.0,
        None => damping * u[n],
        Some(thermal) => force * thermal.rest[n] + damping * product(u, &thermal.rest, n),
    }
}

/// Series of a held belt, which keeps `speed`: the pull grows as the drive says.
pub(super) fn held_series(start: &SlipStart) -> Series {
    let (mut p, mut u, mut f) = ([0.0; ORDER + 1], [0.0; ORDER + 1], [0.0; ORDER + 1]);
    (p[0], u[0], f[0]) = (start.pull, start.speed, start.total);
    for (j, driven) in start.rate.iter().enumerate() {
        let pulled = if j == 0 { driven - start.stiffness * start.speed } else { *driven };
        p[j + 1] = pulled * INVERSE[j + 1];
    }
    if start.thermal.is_some() {
        let mut drag = DragSeries::starting(start);
        for (n, c) in f.iter_mut().enumerate().skip(1) {
            *c = drag.force(n, &u);
        }
    }
    Series { pull: p, speed: u, drag: f }
}

/// Series of creep, where the belt slows just as fast as the growing backward pull allows.
///
/// A belt that moves at `u` against the pull of the spring cannot leave the force that holds it, `F(u, T) + r(u, T)` with
/// `r` that of the rest of the drive: any faster and it is held, any slower and it slips. So `F + r = -p` stays true
/// while `p' = rate - k u`. Each coefficient of `F + r` holds the same share of that of `u`, its `slope` in speed.
pub(super) fn creep_series(start: &SlipStart, slope: f64) -> Series {
    let (mut p, mut u) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
    (p[0], u[0]) = (start.pull, start.speed);
    let mut drag = DragSeries::starting(start);
    for n in 1..=ORDER {
        let driven = if n < 5 { start.rate[n - 1] } else { 0.0 };
        p[n] = (driven - start.stiffness * u[n - 1]) * INVERSE[n];
        let held = drag.force(n, &u);
        u[n] = (-p[n] - held) / slope;
        drag.force(n, &u);
    }
    Series { pull: p, speed: u, drag: p.map(|c| -c) }
}

/// Exponent bits of 1.0.
const ONE: u64 = 0x3FF0_0000_0000_0000;

/// `x^(1/n)` within some per cent: the exponent bits divided. Enough for a step size.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(super) fn rough_root(x: f64, n: u64) -> f64 {
    f64::from_bits((x.to_bits() / n).wrapping_add(ONE - ONE / n))
}

impl Series {
    /// Nothing moves.
    pub(super) fn still(pull: f64, speed: f64) -> Self {
        let constant = |value: f64| {
            let mut c = [0.0; ORDER + 1];
            c[0] = value;
            c
        };
        Self { pull: constant(pull), speed: constant(speed), drag: constant(pull) }
    }

    /// Longest step for which the last two terms stay below `tolerance` times the scales.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    pub(super) fn step_size(&self, tolerance: f64, pull_scale: f64, speed_scale: f64) -> f64 {
        let (per_pull, per_speed) = (1.0 / pull_scale, 1.0 / speed_scale);
        let relative =
            |n: usize| (self.pull[n] * per_pull).abs().max((self.speed[n] * per_speed).abs());
        let (last, before) = (relative(ORDER), relative(ORDER - 1));
        let by_last =
            if last > 0.0 { rough_root(tolerance / last, ORDER as u64) } else { f64::INFINITY };
        let by_before = if before > 0.0 {
            rough_root(tolerance / before, ORDER as u64 - 1)
        } else {
            f64::INFINITY
        };
        by_last.min(by_before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_to_a_series_beside_a_rest_agree() {
        let rest = Rest { force: 3.0, damping: 0.7 };
        for law in [Recurrence::power(-0.98, 0.4), Recurrence::exponential(0.1)] {
            let start = SlipStart {
                stiffness: 20.0,
                mass: 1.3,
                rate: [9.0, 0.5, -0.2, 0.1],
                pull: 11.0,
                speed: 0.4,
                force: 6.0,
                total: 6.0 + rest.at(0.4),
                law,
                sharing: None,
                rest,
                thermal: None,
                below: false,
            };
            let (mut quick, full) = (Series::still(0.0, 0.0), full_series(&start));
            plain_series(&start, &mut quick);
            for (a, b) in
                [(quick.pull, full.pull), (quick.speed, full.speed), (quick.drag, full.drag)]
            {
                assert!(
                    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs()),
                    "{a:?} {b:?}"
                );
            }
        }
    }
}
