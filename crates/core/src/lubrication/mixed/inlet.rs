//! Soft contacts: asperities press with one pressure on the flat film, and the inlet moves in.
//!
//! The dry pressure p rises as `K sqrt(d)` with the distance d from the edge. Asperities press with P on all of the flat
//! film, so the film carries only where p is above P. There p has a finite slope, `K^2/(2 P)` near the edge, while the
//! film alone starts at the edge and is made over `l = (eta u E*^2/K^3)^0.4`. Hence the film depends on
//! `A = P/(K sqrt(l))`, and on how steeply asperities let go, `n = -d ln F/d ln lambda`:
//!
//! `lambda = lambda_free [1 + (c A/(Phi (n + m)))^q]^(1/2q)`
//!
//! For large A the film goes as `sqrt(A/n)`, that is as `(eta u)^0.5` at one P. Phi is the slope of p where p is P over
//! that of `K sqrt(d)`. For it the dry pressure is a mixture of ellipse and parabola, `p^2 = p_max^2 [k v + (1-k) v^2]`
//! with `v = 1 - (x/a)^2` and the roundness `k = K^2 a/(2 p_max^2)`, which is 1 on a half-space.
//! c, m and q are fitted to a numerical solution of the whole contact; see docs/theory/mixed.md.

use std::f64::consts::PI;

use super::Sharing;
use super::integral::{steepening, steepness};

/// c, m and q of the law.
const INLET: f64 = 3.89;
pub(crate) const OFFSET: f64 = 2.84;
pub(crate) const SHARPNESS: f64 = 1.34;
/// What the least film is below the central one if alone, and how fast asperities close the constriction.
const CONSTRICTION: f64 = 0.21;
const CLOSING: f64 = 3.82;
const CLOSING_EXPONENT: f64 = 0.58;
/// ln of a film alone that no float tells from rest beside the asperities.
const REST: f64 = -150.0;
/// Newton's step after which the next would be lost in rounding.
const SETTLED: f64 = 1e-8;
/// `n gap` below which the rest of the pressure comes from a series about that at rest.
const NEAR: f64 = 1e-3;

/// A soft contact at one lambda.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inlet {
    /// Film over roughness.
    pub lambda: f64,
    /// n: `-d ln F/d ln lambda`.
    pub steepness: f64,
    /// Pressure of the asperities over the largest dry pressure.
    pub pressure: f64,
    /// 1 less that pressure, with its digits towards rest.
    pub room: f64,
    /// Square of the half-width over which the film carries, over that of the dry contact: `1 - v` is the distance.
    pub inside: f64,
    /// ln of `c A/(Phi (n + m))` at `X = 1`.
    level: f64,
}

/// How much of the film comes of asperities: 0 if alone, 1 where they set it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weight {
    /// `ln(lambda/lambda_free)`.
    raised: f64,
    pub weight: f64,
}

/// ln of the film alone over roughness at a scaled product; so little at rest that every term stays a number.
pub(super) fn alone(law: &Sharing, x: f64) -> f64 {
    (law.film_exponent * x.ln()).max(REST)
}

/// Largest dry pressure over the mean one, of the mixture of ellipse and parabola, to 2 %.
pub(crate) fn peak(roundness: f64) -> f64 {
    1.5 - (1.5 - 4.0 / PI) * roundness
}

impl Inlet {
    /// The contact at `lambda = dry (1 + exp(gap))`.
    pub(super) fn at(law: &Sharing, dry: f64, gap: f64) -> Self {
        let gap = gap.exp();
        let lambda = dry * (1.0 + gap);
        let near = gap < NEAR && steepness(dry).1 * gap < NEAR;
        let (steepness, fallen) = if near {
            let steep = steepness(dry).1;
            let (first, second) = steepening(dry, steep);
            let l = gap.ln_1p();
            let fallen = l * (steep + l * (first / 2.0 + l * second / 6.0));
            (steep + l * (first + l * second / 2.0), fallen)
        } else {
            let (integral, steep) = steepness(lambda);
            (steep, (peak(law.roundness) / (law.stiffness * integral)).ln())
        };
        let pressure = (-fallen).exp();
        let room = -(-fallen).exp_m1();
        let k = law.roundness;
        let square = pressure * pressure;
        let root = (k * k + 4.0 * (1.0 - k) * square).sqrt();
        // 1 - v of p^2 = k v + (1-k) v^2 = square, from 1 - square = (1-v) (1 + (1-k) v)
        let v = 2.0 * square / (root + k);
        let inside = room * (1.0 + pressure) / (1.0 + (1.0 - k) * v);
        let slope = inside.sqrt() * root / k;
        let mean = peak(k) * pressure;
        let level = (INLET * law.edge * mean / (slope * (steepness + OFFSET))).ln();
        Self { lambda, steepness, pressure, room, inside, level }
    }

    /// Share of the load that the film carries: `(1 - P/p_max)^(p_max/p_mean)`.
    pub(crate) fn film(&self, law: &Sharing) -> f64 {
        self.room.powf(peak(law.roundness))
    }

    /// Share of the load that asperities carry.
    pub(crate) fn share(&self, law: &Sharing) -> f64 {
        -(peak(law.roundness) * (-self.pressure).ln_1p()).exp_m1()
    }

    /// `-d share/d ln lambda`.
    pub(super) fn fall(&self, law: &Sharing) -> f64 {
        peak(law.roundness) * self.steepness * self.pressure * self.film(law) / self.room
    }

    /// The least film over the roughness, at the exit.
    pub(super) fn minimum(&self, law: &Sharing) -> f64 {
        let closed = CLOSING * peak(law.roundness) * self.pressure * self.steepness;
        self.lambda * (1.0 - CONSTRICTION / (1.0 + closed).powf(CLOSING_EXPONENT))
    }

    /// The part of asperities in the film where the film alone is `exp(free)`.
    pub(super) fn weight(&self, free: f64) -> Weight {
        let power = SHARPNESS * (self.level - free / 3.0);
        // ln(1 + e^power) without overflow
        let raised = power.max(0.0) + (-power.abs()).exp().ln_1p();
        Weight { raised: raised / (2.0 * SHARPNESS), weight: 1.0 / (1.0 + (-power).exp()) }
    }

    /// ln of the film alone with which this lambda comes out.
    pub(super) fn free(&self) -> f64 {
        let goal = self.lambda.ln();
        // Both asymptotes are above the root of a convex function that rises: Newton's method comes down to it.
        let mut free = goal.min(1.2 * (goal - 0.5 * self.level));
        for _ in 0..60 {
            let Weight { raised, weight } = self.weight(free);
            let step = (free + raised - goal) / (1.0 - weight / 6.0);
            free -= step;
            if step <= 1e-9 {
                break;
            }
        }
        free
    }

    /// `d ln lambda/d ln lambda_free` for a weight.
    pub(super) fn growth(&self, law: &Sharing, weight: f64) -> f64 {
        self.inside * (1.0 - weight / 6.0) / self.resisting(law, weight)
    }

    /// `d ln lambda/d ln edge` at one product.
    pub(super) fn by_edge(&self, law: &Sharing, weight: f64) -> f64 {
        0.5 * weight * self.inside / self.resisting(law, weight)
    }

    /// `inside (1 - d ln[...]^(1/2q)/d ln lambda)`.
    fn resisting(&self, law: &Sharing, weight: f64) -> f64 {
        let k = law.roundness;
        let v = 1.0 - self.inside;
        let root = k + 2.0 * (1.0 - k) * v;
        let bent = steepening(self.lambda, self.steepness).0 / (self.steepness + OFFSET);
        let sloped = (k / root).powi(2) * self.inside + v * (k + (1.0 - k) * v) / root;
        self.inside + 0.5 * weight * (self.steepness * sloped + self.inside * bent)
    }

    /// The contact where the film alone is `exp(free)`.
    pub(super) fn solved(law: &Sharing, dry: f64, free: f64) -> Self {
        // In ln(lambda/dry - 1) both ends are straight: Newton's method, within a bracket.
        let start = free.exp() / dry;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut gap = if start > 1.01 { (start - 1.0).ln() } else { -1.0 };
        let mut state = Self::at(law, dry, gap);
        for _ in 0..100 {
            let Weight { raised, weight } = state.weight(free);
            let excess = state.lambda.ln() - free - raised;
            if excess > 0.0 {
                high = gap;
            } else {
                low = gap;
            }
            let far = gap.exp();
            let rise = state.resisting(law, weight) / state.inside * far / (1.0 + far);
            let step = -(excess / rise).clamp(-200.0, 200.0);
            let next = gap + step;
            let settled = step.abs() < SETTLED;
            gap = if settled || (low < next && next < high) { next } else { 0.5 * (low + high) };
            if !gap.is_finite() {
                break;
            }
            state = Self::at(law, dry, gap);
            if settled {
                break;
            }
        }
        state
    }
}
