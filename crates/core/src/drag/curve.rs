//! Drag as a smooth curve through points: a law that no formula describes.
//!
//! The points are evenly spaced in `ln v`. Between them `ln F` is a cubic with the slopes of the neighbouring chords
//! (Catmull and Rom), beyond them it goes on straight, as a power of speed.

use crate::error::{Error, at_least, finite};

/// Fewest points of a curve.
const FEWEST: usize = 4;
/// Halvings of the range in which the least force lies.
const HALVINGS: usize = 60;

/// `ln F` at evenly spaced `ln v`.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    first: f64,
    step: f64,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Curve {
    /// The curve through `values` of `ln F` from `ln v = first` on, `step` apart.
    ///
    /// # Errors
    /// If there are fewer than four points, a value is not finite, or the step is not positive.
    pub fn new(first: f64, step: f64, values: &[f64]) -> Result<Self, Error> {
        if values.len() < FEWEST {
            return Err(Error::TooFew { quantity: "points of the drag curve", needed: FEWEST });
        }
        finite("ln v of the drag curve", first)?;
        at_least("step of ln v of the drag curve", step, 1e-6)?;
        for value in values {
            finite("ln F of the drag curve", *value)?;
        }
        let last = values.len() - 1;
        let slopes = (0..=last)
            .map(|i| {
                let (low, high) = (i.saturating_sub(1), (i + 1).min(last));
                (values[high] - values[low]) / (if high - low == 2 { 2.0 } else { 1.0 } * step)
            })
            .collect();
        Ok(Self { first, step, values: values.to_vec(), slopes })
    }

    /// `ln F` at `ln v`.
    #[inline]
    #[must_use]
    pub fn at(&self, log_speed: f64) -> f64 {
        let place = (log_speed - self.first) / self.step;
        let last = self.values.len() - 1;
        if place <= 0.0 {
            return self.values[0] + self.slopes[0] * (log_speed - self.first);
        }
        #[allow(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss
        )]
        let (i, t) = {
            if place >= last as f64 {
                let end = self.first + self.step * last as f64;
                return self.values[last] + self.slopes[last] * (log_speed - end);
            }
            let i = place as usize;
            (i, place - i as f64)
        };
        let (a, b) = (self.values[i], self.values[i + 1]);
        let (da, db) = (self.slopes[i] * self.step, self.slopes[i + 1] * self.step);
        let rise = b - a;
        a + t * (da + t * (3.0 * rise - 2.0 * da - db + t * (da + db - 2.0 * rise)))
    }

    /// The first `ln v`, and how far apart the others are.
    pub(crate) fn spacing(&self) -> (f64, f64) {
        (self.first, self.step)
    }

    /// Write `ln F` as cubics of the place, in steps of `ln v`: from each point to the next, before them what leads to the
    /// first, and at the end what goes on from the last.
    pub(crate) fn write_cells(&self, cells: &mut Vec<[f64; 4]>) {
        let last = self.values.len() - 1;
        let straight = |i: usize| [self.values[i], self.slopes[i] * self.step, 0.0, 0.0];
        let cubic = |i: usize| {
            let (a, rise) = (self.values[i], self.values[i + 1] - self.values[i]);
            let (da, db) = (self.slopes[i] * self.step, self.slopes[i + 1] * self.step);
            [a, da, 3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise]
        };
        cells.clear();
        cells.push(straight(0));
        cells.extend((0..last).map(cubic));
        cells.push(straight(last));
    }

    /// Force at a speed above zero.
    #[inline]
    #[must_use]
    pub fn force(&self, speed: f64) -> f64 {
        self.at(speed.ln()).exp()
    }

    /// Speed from `low` on at which force with `damping` times the speed is least, the slowest of them.
    #[must_use]
    pub fn least(&self, low: f64, damping: f64) -> f64 {
        self.least_below(low, damping, f64::INFINITY).unwrap_or(low)
    }

    /// The same; none as soon as it is sure to be no less than `speed`.
    #[must_use]
    pub(crate) fn least_below(&self, low: f64, damping: f64, speed: f64) -> Option<f64> {
        #[allow(clippy::cast_precision_loss)]
        let end = self.first + self.step * (self.values.len() - 1) as f64;
        let force = |x: f64| self.at(x).exp() + damping * x.exp();
        let begin = low.ln();
        if begin >= end {
            return Some(low);
        }
        #[allow(clippy::cast_precision_loss)]
        let look = |i: usize| begin + (end - begin) * i as f64 / LOOKS as f64;
        // the least is looked for beside the least of the looks
        let slower = (0..LOOKS).take_while(|i| look(*i) < speed.ln()).count() + 2;
        if slower <= LOOKS {
            let least = (0..slower).map(|i| force(look(i))).fold(f64::INFINITY, f64::min);
            if (slower..=LOOKS).any(|i| force(look(i)) < least) {
                return None;
            }
        }
        let best =
            (0..=LOOKS).min_by(|i, j| force(look(*i)).total_cmp(&force(look(*j)))).unwrap_or(0);
        let (mut a, mut b) = (look(best.saturating_sub(1)), look((best + 1).min(LOOKS)));
        for _ in 0..HALVINGS {
            let (c, d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
            if force(c) <= force(d) { b = d } else { a = c }
        }
        Some((0.5 * (a + b)).exp())
    }
}

/// Speeds at which the least force is looked for first, and the golden section by which it is closed in on.
const LOOKS: usize = 96;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_of_speed_is_kept_exactly() {
        let values: Vec<f64> = (0..9).map(|i| 1.0 - 0.2 * 0.5 * f64::from(i)).collect();
        let curve = Curve::new(-2.0, 0.5, &values).unwrap();
        for x in [-5.0, -2.0, -1.7, 0.3, 1.99, 4.0] {
            assert!((curve.at(x) - (1.0 - 0.2 * (x + 2.0))).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn the_least_force_is_found() {
        // ln F = x^2 has its least at v = 1, which a cubic through x^2 keeps
        let values: Vec<f64> = (0..41).map(|i| (-2.0 + 0.1 * f64::from(i)).powi(2)).collect();
        let curve = Curve::new(-2.0, 0.1, &values).unwrap();
        assert!((curve.least(0.2, 0.0) - 1.0).abs() < 1e-7);
        assert!((curve.least(1.5, 0.0) - 1.5).abs() < 1e-6);
        assert_eq!(curve.least_below(0.2, 0.0, 0.9), None);
        for speed in [1.01, 2.0, 1e3] {
            assert_eq!(curve.least_below(0.2, 0.0, speed), Some(curve.least(0.2, 0.0)));
        }
        // exp(x^2) + exp(x) is least where 2 x exp(x^2) = -exp(x), at x = -0.3250334087
        assert!((curve.least(0.2, 1.0).ln() + 0.325_033_408_7).abs() < 1e-4);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        assert!(Curve::new(0.0, 0.1, &[1.0, 2.0, 3.0]).is_err());
        assert!(Curve::new(0.0, 0.0, &[1.0; 5]).is_err());
        assert!(Curve::new(0.0, 0.1, &[1.0, f64::NAN, 1.0, 1.0]).is_err());
    }
}
