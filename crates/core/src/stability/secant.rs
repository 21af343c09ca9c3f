//! The drive speed at which a lap just comes back, from what laps at other drive speeds do: the secant method, within a
//! bracket once there is one.

/// Laps after which a search is given up.
const MAX_LAPS: usize = 80;
/// Greatest drive speed looked at, over `v_t`; a fold beyond is said to lie at infinity.
const FASTEST: f64 = 1e4;
/// Error of the drive speed, foretold by the secant method, at which it ends.
const FOUND: f64 = 1e-12;

/// What a lap did at the drive speed that is looked at.
#[derive(Clone, Copy)]
pub(super) enum Outcome {
    /// Pull at the section less that of the lap which just comes back: negative if the belt sticks.
    Gap(f64),
    /// The belt ends in steady sliding or a smaller swing.
    Escapes,
}

/// A root of the gap by the secant method, kept inside a bracket once there is one.
///
/// The gap is negative where the belt sticks, and has no value where it escapes.
pub(super) struct Search {
    /// Drive speed that is looked at.
    pub at: f64,
    /// Drive speed above which none is looked for.
    pub most: f64,
    pub sticks: f64,
    pub escapes: Option<f64>,
    last: Option<(f64, f64)>,
    pub laps: usize,
}

pub(super) enum Step {
    Again,
    At(f64),
    Nowhere,
}

impl Search {
    pub(super) fn new(sticks: f64, at: f64) -> Self {
        Self { at, most: f64::INFINITY, sticks, escapes: None, last: None, laps: 0 }
    }

    pub(super) fn take(&mut self, outcome: Outcome) -> Step {
        self.laps += 1;
        let x = self.at;
        let gap = match outcome {
            Outcome::Gap(gap) => Some(gap),
            Outcome::Escapes => None,
        };
        let sticks = gap.is_some_and(|g| g < 0.0);
        if gap == Some(0.0) || (sticks && x >= self.most) {
            return Step::At(x);
        }
        if sticks {
            self.sticks = self.sticks.max(x);
        } else {
            self.escapes = Some(self.escapes.map_or(x, |e| e.min(x)));
        }
        let middle = self.escapes.map_or(1.5 * x, |e| 0.5 * (self.sticks + e));
        let inside = |y: f64| y > self.sticks && self.escapes.is_none_or(|e| y < e);
        let secant = gap.zip(self.last).map(|(g, (y, h))| x - g * (x - y) / (g - h));
        if let (Some(y), Some((before, _))) = (secant, self.last)
            && (y - x).abs() * (x - before).abs() <= FOUND * x * x
            && (y - x).abs() <= 1e-3 * x
        {
            return Step::At(y);
        }
        if self.escapes.is_some_and(|e| e - self.sticks <= FOUND * e) {
            return Step::At(middle);
        }
        // without a slope yet, a first guess at it
        let nearby = gap.map(|_| x * if sticks { 1.03 } else { 0.97 });
        let fits = |y: &f64| inside(*y) && *y <= 2.0 * x;
        let next = secant.or(nearby).filter(fits).unwrap_or(middle);
        if next > FASTEST {
            return Step::At(f64::INFINITY);
        }
        if self.laps >= MAX_LAPS || !next.is_finite() {
            return Step::Nowhere;
        }
        self.last = gap.map(|g| (x, g)).or(self.last);
        self.at = next;
        Step::Again
    }
}

/// Bottom of the parabola through the least point and its neighbours, if it lies between them.
pub(super) fn below_three(points: &[(f64, f64)]) -> Option<f64> {
    let least = (0..points.len()).min_by(|i, j| points[*i].1.total_cmp(&points[*j].1))?;
    if least == 0 || least + 1 == points.len() {
        return None;
    }
    let [(a, fa), (b, fb), (c, fc)] = [points[least - 1], points[least], points[least + 1]];
    let (left, right) = ((b - a) * (fb - fc), (b - c) * (fb - fa));
    let bottom = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right);
    let apart = |x: f64| (x - b).abs() > 1e-6 * b;
    (bottom > a && bottom < c && apart(bottom)).then_some(bottom)
}
