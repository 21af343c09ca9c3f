//! Polynomials in local time, as the Taylor steps leave them, and their first root.

/// Highest power kept.
pub(super) const ORDER: usize = 14;

/// Coefficients of `sum c_i t^i`.
pub(super) type Polynomial = [f64; ORDER + 1];

/// Halvings before an interval counts as a point.
const MAX_DEPTH: u32 = 60;

/// Value at `t`.
pub(super) fn value(c: &Polynomial, t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, ci| sum.mul_add(t, *ci))
}

/// `constant - c`.
pub(super) fn subtracted_from(constant: f64, c: &Polynomial) -> Polynomial {
    let mut out = c.map(|ci| -ci);
    out[0] += constant;
    out
}

/// First time in `[0, end]` at which `g`, positive at the start, stops being positive.
///
/// A step that starts on its own guard has `g(0) = 0`, exactly: those leading terms are divided out,
/// and what is left says at once whether the motion enters or leaves the region.
pub(super) fn first_crossing(g: &Polynomial, end: f64) -> Option<f64> {
    if !g.iter().all(|ci| ci.is_finite()) || !end.is_finite() {
        return Some(0.0); // numbers beyond range: an event at once, which ends the motion with an error
    }
    let zeros = g.iter().position(|ci| *ci != 0.0)?;
    let mut c = [0.0; ORDER + 1];
    c[..=ORDER - zeros].copy_from_slice(&g[zeros..]);
    if c[0] < 0.0 { Some(0.0) } else { crossing_within(&c, 0.0, end, MAX_DEPTH) }
}

/// As `first_crossing`, for a polynomial that is positive at `start`: bounds prove an interval free of
/// roots or monotone, otherwise it is halved and the earlier half searched first.
fn crossing_within(c: &Polynomial, start: f64, end: f64, depth: u32) -> Option<f64> {
    let local = shifted(c, start);
    let width = end - start;
    let (mut lowest, mut steepest, mut power) = (local[0], 0.0, 1.0);
    for (i, ci) in local.iter().enumerate().skip(1) {
        #[allow(clippy::cast_precision_loss)] // at most ORDER
        let slope = ci * i as f64 * power;
        steepest += if i == 1 { slope } else { slope.max(0.0) };
        power *= width;
        lowest += (ci * power).min(0.0);
    }
    if lowest > 0.0 {
        return None;
    }
    if !(lowest.is_finite() && steepest.is_finite()) {
        return Some(start); // beyond the range of numbers, where no bound can be had
    }
    if steepest < 0.0 || depth == 0 {
        return (value(&local, width) <= 0.0).then(|| start + falling_root(&local, width));
    }
    let middle = 0.5 * (start + end);
    crossing_within(c, start, middle, depth - 1)
        .or_else(|| crossing_within(c, middle, end, depth - 1))
}

/// Root of `c`, falling from positive at 0 to non-positive at `end`: Newton kept inside a bracket.
fn falling_root(c: &Polynomial, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    let mut t = 0.5 * end;
    for _ in 0..100 {
        let (v, slope) = value_and_slope(c, t);
        (low, high) = if v > 0.0 { (t, high) } else { (low, t) };
        let newton = t - v / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= f64::EPSILON * end {
            return next;
        }
        t = next;
    }
    t
}

fn value_and_slope(c: &Polynomial, t: f64) -> (f64, f64) {
    c.iter().rev().fold((0.0, 0.0), |(v, slope), ci| (v.mul_add(t, *ci), slope.mul_add(t, v)))
}

/// Coefficients about `origin`.
fn shifted(c: &Polynomial, origin: f64) -> Polynomial {
    let mut out = *c;
    if origin != 0.0 {
        for i in 0..ORDER {
            for j in (i..ORDER).rev() {
                out[j] = out[j + 1].mul_add(origin, out[j]);
            }
        }
    }
    out
}

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
