//! Polynomials in local time, as the Taylor steps leave them, and their first root.

pub(super) use crate::rows::fused;

/// Highest power kept.
pub(super) const ORDER: usize = 14;

/// `a b + c` rounded once, for each of a register.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(super) fn fused_in<S: pulp::Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
    if cfg!(target_arch = "wasm32") {
        simd.add_f64s(simd.mul_f64s(a, b), c)
    } else {
        simd.mul_add_f64s(a, b, c)
    }
}

/// The powers, as numbers.
pub(super) const POWERS: [f64; ORDER + 1] = counted();

/// The numbers from zero on.
#[allow(clippy::cast_precision_loss)] // of a few powers
pub(super) const fn counted<const N: usize>() -> [f64; N] {
    let mut numbers = [0.0; N];
    let mut i = 0;
    while i < N {
        numbers[i] = i as f64;
        i += 1;
    }
    numbers
}

/// One over each power; zero for the first.
pub(super) const INVERSE: [f64; ORDER + 1] = {
    let mut inverse = [0.0; ORDER + 1];
    let mut i = 1;
    while i <= ORDER {
        inverse[i] = 1.0 / POWERS[i];
        i += 1;
    }
    inverse
};

/// One over each power plus one.
pub(super) const INVERSE_NEXT: [f64; ORDER + 1] = {
    let mut inverse = [0.0; ORDER + 1];
    let mut i = 0;
    while i <= ORDER {
        inverse[i] = 1.0 / (POWERS[i] + 1.0);
        i += 1;
    }
    inverse
};

/// Coefficients of `sum c_i t^i`.
pub(super) type Polynomial = [f64; ORDER + 1];

/// Halvings before an interval counts as a point.
const MAX_DEPTH: u32 = 60;

/// Value at `t`, by even and odd powers apart, which shortens the chain: with `x = t^2`, `c = e(x) + t o(x)`.
pub(super) fn value(c: &Polynomial, t: f64) -> f64 {
    let square = t * t;
    let (mut even, mut odd) = (c[ORDER], 0.0);
    for pair in c[..ORDER].chunks_exact(2).rev() {
        even = even * square + pair[0];
        odd = odd * square + pair[1];
    }
    even + t * odd
}

/// Times at which polynomials are evaluated at once.
pub(super) const BLOCK: usize = 8;

/// Values of several polynomials at several times.
#[inline(always)]
#[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
pub(super) fn values<S: pulp::Simd, const N: usize>(
    simd: S,
    of: [&Polynomial; N],
    times: &[f64; BLOCK],
) -> [[f64; BLOCK]; N] {
    let mut out = [[0.0; BLOCK]; N];
    let (registers, _) = S::as_simd_f64s(times);
    for (r, t) in registers.iter().enumerate() {
        let mut sums = of.map(|c| simd.splat_f64s(c[ORDER]));
        for n in (0..ORDER).rev() {
            for (sum, c) in sums.iter_mut().zip(of) {
                *sum = fused_in(simd, *sum, *t, simd.splat_f64s(c[n]));
            }
        }
        for (out, sum) in out.iter_mut().zip(sums) {
            S::as_mut_simd_f64s(out).0[r] = sum;
        }
    }
    out
}

/// `constant - c`.
pub(super) fn subtracted_from(constant: f64, c: &Polynomial) -> Polynomial {
    let mut out = c.map(|ci| -ci);
    out[0] += constant;
    out
}

/// Derivative.
pub(super) fn derivative(c: &Polynomial) -> Polynomial {
    let mut out = [0.0; ORDER + 1];
    for i in 1..=ORDER {
        out[i - 1] = c[i] * POWERS[i];
    }
    out
}

/// First time in `[0, end]` at which `g`, positive at the start, stops being positive.
///
/// A step that starts on its own guard has `g(0) = 0`, exactly: those leading terms are divided out,
/// and what is left says at once whether the motion enters or leaves the region.
pub(super) fn first_crossing(g: &Polynomial, end: f64) -> Option<f64> {
    let zeros = g.iter().position(|ci| *ci != 0.0)?;
    // in units of the interval
    let (mut c, mut power) = ([0.0; ORDER + 1], 1.0);
    for (unit, ci) in c.iter_mut().zip(&g[zeros..]) {
        *unit = ci * power;
        power *= end;
    }
    if lowest(&c) > 0.0 {
        return None;
    }
    let beyond = !c.iter().all(|ci| ci.is_finite()); // an event at once, which ends the motion with an error
    if c[0] < 0.0 || beyond {
        return Some(0.0);
    }
    let root = falling_crossing(&c).or_else(|| crossing_within(&c, MAX_DEPTH))?;
    Some(root * end)
}

/// The crossing on the unit interval, if the polynomial is found to fall from its start to there.
fn falling_crossing(c: &Polynomial) -> Option<f64> {
    let end = value(c, 1.0);
    if end > 0.0 {
        return None;
    }
    let root = falling_root(c, end);
    // the slope stays below its first term and what the others can add up to
    let (mut slope, mut power) = (c[1], root);
    for (ci, n) in c.iter().zip(POWERS).skip(2) {
        slope += n * (ci * power).max(0.0);
        power *= root;
    }
    (slope < 0.0).then_some(root)
}

/// A bound of the values on the unit interval from below; not a number if a coefficient is beyond range.
fn lowest(c: &Polynomial) -> f64 {
    let mut sums = [0.0; 4];
    for (i, ci) in c.iter().enumerate().skip(1) {
        sums[i % 4] += ci - ci.abs();
    }
    c[0] + 0.5 * ((sums[0] + sums[1]) + (sums[2] + sums[3]))
}

/// As `first_crossing`, on the unit interval, for a polynomial that is positive at 0.
///
/// Its graph lies in the hull of its Bernstein coefficients: they prove the interval free of roots or the
/// polynomial falling, otherwise it is halved and the earlier half searched first.
fn crossing_within(c: &Polynomial, depth: u32) -> Option<f64> {
    let hull = weighed(c, &BERNSTEIN);
    if hull.iter().all(|b| *b > 0.0) {
        return None;
    }
    if hull.windows(2).all(|b| b[1] < b[0]) || depth == 0 {
        let end = hull[ORDER];
        return (end <= 0.0).then(|| falling_root(c, end));
    }
    let (mut left, mut half) = (*c, 1.0);
    for ci in &mut left {
        *ci *= half;
        half *= 0.5;
    }
    if let Some(root) = crossing_within(&left, depth - 1) {
        return Some(0.5 * root);
    }
    Some(0.5 + 0.5 * crossing_within(&weighed(&left, &BINOMIALS), depth - 1)?)
}

/// Root of `c`, falling from positive at 0 to the non-positive value `end` at 1: Newton kept inside a bracket.
fn falling_root(c: &Polynomial, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let (mut t, mut last) = (c[0] / (c[0] - end), 1.0);
    for _ in 0..100 {
        let (v, slope) = value_and_slope(c, t);
        (low, high) = if v > 0.0 { (t, high) } else { (low, t) };
        let newton = t - v / slope;
        if newton.to_bits() == t.to_bits() {
            break; // to the last digit; the bracket has closed on it, and halving would lead away
        }
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - t).abs();
        t = next;
        // quadratic convergence foretells the next step; near the root nothing but rounding is left of them
        let next_step = step * (step / last) * (step / last);
        if next_step <= 0.1 * f64::EPSILON * t || (step < 1e-14 && step >= last) {
            break;
        }
        last = step;
    }
    t
}

/// Value and slope at `t`, by even and odd powers apart too.
fn value_and_slope(c: &Polynomial, t: f64) -> (f64, f64) {
    let square = t * t;
    let (mut even, mut odd, mut even_slope, mut odd_slope) = (c[ORDER], 0.0, 0.0, 0.0);
    for pair in c[..ORDER].chunks_exact(2).rev() {
        odd_slope = odd_slope * square + odd;
        even_slope = even_slope * square + even;
        even = even * square + pair[0];
        odd = odd * square + pair[1];
    }
    (even + t * odd, odd + 2.0 * (t * even_slope + square * odd_slope))
}

/// Sum of the rows of `table`, each times its coefficient.
fn weighed(c: &Polynomial, table: &[Polynomial; ORDER + 1]) -> Polynomial {
    let mut out = [0.0; ORDER + 1];
    for (row, ci) in table.iter().zip(c) {
        for (o, weight) in out.iter_mut().zip(row) {
            *o += weight * ci;
        }
    }
    out
}

/// Bernstein coefficients of each power on the unit interval: `C(j, i)/C(ORDER, i)`.
const BERNSTEIN: [Polynomial; ORDER + 1] = {
    let mut rows = [[0.0; ORDER + 1]; ORDER + 1];
    let mut i = 0;
    while i <= ORDER {
        let mut j = i;
        while j <= ORDER {
            rows[i][j] = BINOMIALS[j][i] / BINOMIALS[ORDER][i];
            j += 1;
        }
        i += 1;
    }
    rows
};

/// Pascal's triangle: coefficients of each power about 1.
const BINOMIALS: [[f64; ORDER + 1]; ORDER + 1] = {
    let mut rows = [[0.0; ORDER + 1]; ORDER + 1];
    let mut n = 0;
    while n <= ORDER {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn from_roots(roots: &[f64]) -> Polynomial {
        let mut c = [0.0; ORDER + 1];
        c[0] = 1.0;
        for root in roots {
            let old = c;
            for i in 0..=ORDER {
                c[i] = old[i] - if i == 0 { 0.0 } else { old[i - 1] / root };
            }
        }
        c
    }

    #[test]
    fn two_roots_inside_one_step_are_not_missed() {
        let c = from_roots(&[0.3, 0.300_001]);
        let root = first_crossing(&c, 1.0).expect("the polynomial dips below zero");
        assert!((root - 0.3).abs() < 1e-9);
    }

    #[test]
    #[allow(clippy::excessive_precision)]
    fn a_nearly_straight_line_is_met_to_rounding_whatever_the_interval() {
        let mut c = [0.0; ORDER + 1];
        (c[0], c[1], c[2], c[3]) =
            (11.992_468_576, -230.008_686_525, 0.018_916_186, -0.004_153_311);
        for i in 1..2000 {
            let end = 0.0522 + 1e-4 * f64::from(i);
            let root = first_crossing(&c, end).unwrap();
            assert!(value(&c, root).abs() < 1e-13, "{end}: {root}");
        }
    }

    #[test]
    fn a_start_on_the_guard_is_no_event() {
        let mut c = [0.0; ORDER + 1];
        (c[1], c[2]) = (2.0, -1.0);
        assert_eq!(first_crossing(&c, 1.0), None);
        assert!((first_crossing(&c, 3.0).unwrap() - 2.0).abs() < 1e-14);
        assert_eq!(first_crossing(&c.map(|ci| -ci), 1.0), Some(0.0));
    }

    proptest! {
        #[test]
        fn the_earliest_of_many_roots_is_found(mut roots in prop::collection::vec(0.05..2.0_f64, 1..6)) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|w| w[1] - w[0] > 1e-2));
            let found = first_crossing(&from_roots(&roots), 1.0);
            if roots[0] <= 0.999 {
                prop_assert!((found.unwrap() - roots[0]).abs() < 1e-9);
            } else if roots[0] > 1.001 {
                prop_assert_eq!(found, None);
            }
        }
    }
}
