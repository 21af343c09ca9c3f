//! A quantity given against time: drive speed, drive torque, temperature.

use crate::error::{Error, finite};

/// Coefficients of a cubic in time since the start of its segment.
pub type Cubic = [f64; 4];

/// A piecewise cubic function of time, constant before its first and after its last time.
///
/// Two equal times in a row make a jump.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    /// Start of each segment; the first is minus infinity.
    starts: Vec<f64>,
    /// Origin and coefficients of each segment.
    segments: Vec<(f64, Cubic)>,
}

impl Schedule {
    /// The same `value` at all times.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { starts: vec![f64::NEG_INFINITY], segments: vec![(0.0, [value, 0.0, 0.0, 0.0])] }
    }

    /// A cubic in the time from `origin` on, for good.
    pub(super) fn onward(origin: f64, cubic: Cubic) -> Self {
        Self { starts: vec![f64::NEG_INFINITY], segments: vec![(origin, cubic)] }
    }

    /// Whether it goes on for good as `cubic` does, in the time from `time` on, where `segment` holds.
    #[allow(clippy::float_cmp)] // the same to the last bit
    pub(super) fn goes_on_as(&self, segment: usize, time: f64, cubic: &Cubic) -> bool {
        self.end(segment).is_infinite() && self.about(segment, time) == *cubic
    }

    /// Straight lines through `(time, value)`.
    ///
    /// # Errors
    /// If there is no point, a number is not finite, or time runs backwards. `quantity` names the schedule.
    pub fn linear(quantity: &'static str, times: &[f64], values: &[f64]) -> Result<Self, Error> {
        let lines: Vec<Cubic> = (1..values.len().min(times.len()))
            .map(|i| {
                let span = times[i] - times[i - 1];
                let slope = if span > 0.0 { (values[i] - values[i - 1]) / span } else { 0.0 };
                [values[i - 1], slope, 0.0, 0.0]
            })
            .collect();
        let last = values.last().copied().unwrap_or_default();
        Self::piecewise(quantity, times, &lines, last)
    }

    /// Cubics between `times`, one fewer than times, each in time since its start; `last` holds afterwards.
    ///
    /// # Errors
    /// As for [`Schedule::linear`].
    pub fn piecewise(
        quantity: &'static str,
        times: &[f64],
        cubics: &[Cubic],
        last: f64,
    ) -> Result<Self, Error> {
        if times.is_empty() || cubics.len() + 1 != times.len() {
            return Err(Error::TooFew { quantity, needed: 1 });
        }
        for (index, time) in times.iter().enumerate() {
            finite(quantity, *time)?;
            if index > 0 && *time < times[index - 1] {
                return Err(Error::Backwards { quantity, index, value: *time });
            }
        }
        for coefficient in cubics.iter().flatten().chain([&last]) {
            finite(quantity, *coefficient)?;
        }
        let first = cubics.first().map_or(last, |cubic| cubic[0]);
        let mut schedule = Self::constant(first);
        for (i, cubic) in cubics.iter().enumerate() {
            if times[i + 1] > times[i] {
                schedule.starts.push(times[i]);
                schedule.segments.push((times[i], *cubic));
            }
        }
        schedule.starts.push(times[times.len() - 1]);
        schedule.segments.push((0.0, [last, 0.0, 0.0, 0.0]));
        Ok(schedule)
    }

    /// Segment that holds from `time` on.
    pub(super) fn segment(&self, time: f64) -> usize {
        self.starts.partition_point(|start| *start <= time).saturating_sub(1)
    }

    /// When `segment` ends.
    pub(super) fn end(&self, segment: usize) -> f64 {
        self.starts.get(segment + 1).copied().unwrap_or(f64::INFINITY)
    }

    /// Coefficients of `segment` about `time`.
    pub(super) fn about(&self, segment: usize, time: f64) -> Cubic {
        let (origin, [a, b, c, d]) = self.segments[segment];
        if b == 0.0 && c == 0.0 && d == 0.0 {
            return [a, b, c, d];
        }
        let t = time - origin;
        [a + t * (b + t * (c + t * d)), b + t * (2.0 * c + t * 3.0 * d), c + t * 3.0 * d, d]
    }

    /// Value at `time`, after the jump if there is one.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        self.about(self.segment(time), time)[0]
    }

    /// The one value that holds at all times, if it does.
    #[must_use]
    #[allow(clippy::float_cmp)] // a schedule that is constant to the last bit
    pub fn steady(&self) -> Option<f64> {
        let value = self.segments[0].1[0];
        self.segments.iter().all(|(_, c)| *c == [value, 0.0, 0.0, 0.0]).then_some(value)
    }

    /// The same, its time counted from `time` on.
    pub(super) fn from(&self, time: f64) -> Self {
        Self {
            starts: self.starts.iter().map(|start| start - time).collect(),
            segments: self.segments.iter().map(|(origin, cubic)| (origin - time, *cubic)).collect(),
        }
    }

    /// Whether it is made of straight lines.
    pub(super) fn is_linear(&self) -> bool {
        self.segments.iter().all(|(_, [_, _, c, d])| *c == 0.0 && *d == 0.0)
    }

    /// Least and greatest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for (segment, (origin, [_, b, c, d])) in self.segments.iter().enumerate() {
            let start = self.starts[segment].max(*origin);
            let end = self.end(segment);
            let root = (c * c - 3.0 * b * d).sqrt();
            // extremes of a cubic: ends, and where its slope is nil
            let turning = [-b / (c + root), -b / (c - root)].map(|t| origin + t);
            for time in [start, end, turning[0], turning[1]] {
                if (start..=end).contains(&time) && time.is_finite() {
                    let value = self.about(segment, time)[0];
                    range = (range.0.min(value), range.1.max(value));
                }
            }
            if !end.is_finite() || !self.starts[segment].is_finite() {
                let value = self.segments[segment].1[0];
                range = (range.0.min(value), range.1.max(value));
            }
        }
        range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_jumps_and_ends() {
        let s = Schedule::linear("w", &[1.0, 3.0, 3.0, 4.0], &[2.0, 6.0, 1.0, 0.0]).unwrap();
        let values: Vec<f64> = [0.0, 1.0, 2.0, 3.0, 3.5, 9.0].iter().map(|t| s.at(*t)).collect();
        assert_eq!(values, [2.0, 2.0, 4.0, 1.0, 0.5, 0.0]);
        assert_eq!(s.range(), (0.0, 6.0));
        assert_eq!(s.steady(), None);
        assert_eq!(Schedule::constant(3.0).steady(), Some(3.0));
    }

    #[test]
    fn the_extremes_of_a_cubic_are_inside_it() {
        // t^3 - 3 t from -2 to 2 has its extremes -2 and 2 also at 1 and -1
        let s = Schedule::piecewise("w", &[0.0, 4.0], &[[-2.0, 9.0, -6.0, 1.0]], 2.0).unwrap();
        assert_eq!(s.range(), (-2.0, 2.0));
        assert!((s.at(1.0) - 2.0).abs() < 1e-15 && (s.at(3.0) + 2.0).abs() < 1e-15);
    }

    #[test]
    #[allow(clippy::float_cmp)] // small whole numbers
    fn a_cubic_about_another_time_is_the_same_cubic() {
        // 1 + 2 t - 3 t^2 + 0.5 t^3 has at t = 2 the value -3, the slope -4, half the curvature 0 and the same 0.5
        let s = Schedule::piecewise("w", &[1.0, 5.0], &[[1.0, 2.0, -3.0, 0.5]], 0.0).unwrap();
        assert_eq!(s.about(1, 3.0), [-3.0, -4.0, 0.0, 0.5]);
        for since in [0.0_f64, 0.5, 1.5, 2.0, 3.25] {
            let [a, b, c, d] = s.about(1, 1.0 + since);
            for ahead in [-0.5, 0.25, 0.75] {
                let t = since + ahead;
                let value = 1.0 + t * (2.0 + t * (-3.0 + t * 0.5));
                assert!((a + ahead * (b + ahead * (c + ahead * d)) - value).abs() < 1e-13, "{t}");
            }
        }
        // before its first time and after its last it is constant
        assert_eq!((s.at(-9.0), s.at(0.999), s.at(5.0), s.at(9.0)), (1.0, 1.0, 0.0, 0.0));
    }

    #[test]
    fn what_is_no_schedule_is_refused_by_name() {
        let backwards = Schedule::linear("drive_speed", &[1.0, 0.5], &[0.0, 1.0]).unwrap_err();
        assert!(backwards.to_string().starts_with("drive_speed runs backwards"));
        assert!(Schedule::linear("drive_speed", &[], &[]).is_err());
        assert!(Schedule::linear("drive_speed", &[0.0, 1.0], &[0.0, f64::NAN]).is_err());
    }
}
