//! A stretch of smooth motion: the state along it, the conditions that end it, and its turning points.

use super::polynomial::{ORDER, Polynomial, derivative, first_crossing, subtracted_from, value};
use super::runge_kutta::{Flow, Formula, State, horner};
use super::schedule::Cubic;
use super::taylor::Series;
use super::thermal::ThermalFactors;
use crate::drag::Mode;

/// A moment of the motion, mirrored so that `speed >= 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Phase {
    pub mode: Mode,
    /// Branch of the drag law, above the stick speed.
    pub branch: usize,
    /// The motion has just left the stuck phase: pull and drag are equal.
    pub released: bool,
    /// In microslip: the spring pulls back with just the holding force (see `creep_series`).
    pub creeping: bool,
    /// The roll slips on the belt: the pull keeps at what the grip bears.
    pub slipping: bool,
    /// When the belt came to rest, and by how much that has made the static force larger at the release.
    pub at_rest_since: f64,
    pub strength: f64,
    pub direction: f64,
    pub pull: f64,
    pub speed: f64,
    pub bristle: f64,
}

impl Phase {
    pub(super) fn state(&self) -> State {
        [self.pull, self.speed, self.bristle]
    }
}

/// Relative difference of a speed and the transition from which the belt has just met it.
const MET: f64 = 1e-9;

/// Halvings of a step in search of a moment when a condition that starts from nil holds.
const MAX_HALVINGS: usize = 50;

/// How the state is known along a piece.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::large_enum_variant)] // the large one is the common one, and lives on the stack
pub(super) enum Path {
    Series(Series),
    /// With the length of the step and the state at its end.
    Steps {
        formula: Formula,
        scales: State,
        tolerance: f64,
        end: (f64, State),
    },
}

impl Path {
    /// A series to be written.
    pub(super) fn series(&mut self) -> &mut Series {
        loop {
            match self {
                Self::Series(series) => return series,
                Self::Steps { .. } => *self = Self::Series(Series::still(0.0, 0.0)),
            }
        }
    }
}

/// A stretch of smooth motion from `time` on, `duration` long.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    pub time: f64,
    pub duration: f64,
    pub start: Phase,
    pub flow: Flow<'a>,
    pub path: Path,
    /// Whether the temperature is a state, known to its series only.
    pub heated: bool,
}

/// A quantity that is positive while the motion goes on.
#[derive(Debug, Clone, Copy)]
pub(super) enum Condition {
    /// The belt is faster than this speed of the drag law.
    Faster(f64),
    /// The belt is slower than this speed of the drag law.
    Slower(f64),
    /// The spring pulls harder than this force of the drag law and of the rest of the drive.
    Pulled(f64, f64),
    /// The spring pulls harder than the drag.
    Overcome,
    /// The held belt is pulled forward by less than can hold it.
    HeldForward,
    /// The held belt is pulled back by less than can hold it.
    HeldBack,
    /// The belt is faster than the transition of a mixed contact, which moves by itself, or with -1 slower.
    Beyond(f64),
    /// The creeping belt slows down.
    Slowing,
    /// The spring pulls forward by less than the roll's grip on the belt bears.
    GripsForward(f64),
    /// The spring pulls back by less than that.
    GripsBack(f64),
    /// The roll, which slips, is ahead of the belt in the direction of the pull: rate of the pull if the belt stood
    /// still and the roll gripped, and stiffness.
    Ahead(Cubic, f64),
}

impl Piece<'_> {
    /// State at `elapsed` since the start, mirrored.
    pub(super) fn state(&self, elapsed: f64) -> State {
        match &self.path {
            Path::Series(series) => {
                [value(&series.pull, elapsed), value(&series.speed, elapsed), self.start.bristle]
            }
            // what the step itself has found, to the last bit
            Path::Steps { end: (time, end), .. } if elapsed.to_bits() == time.to_bits() => *end,
            Path::Steps { formula, scales, tolerance, .. } => {
                formula.at(&self.flow, &self.start.state(), elapsed, scales, *tolerance)
            }
        }
    }

    /// (belt speed, pull) at `elapsed` since the start, signed.
    pub(super) fn at(&self, elapsed: f64) -> (f64, f64) {
        let [pull, speed, _] = self.state(elapsed);
        (self.start.direction * speed, self.start.direction * pull)
    }

    /// Drag at `elapsed` since the start, from the law itself; `pull` and `speed` are signed, as the result.
    pub(super) fn friction(&self, elapsed: f64, pull: f64, speed: f64) -> f64 {
        self.friction_of(&self.flow, elapsed, pull, speed)
    }

    /// The same at a temperature of the law, where that is a state.
    pub(super) fn friction_at(&self, temperature: f64, elapsed: f64, pull: f64, speed: f64) -> f64 {
        self.friction_of(&self.flow.at_temperature(Some(temperature)), elapsed, pull, speed)
    }

    fn friction_of(&self, flow: &Flow, elapsed: f64, pull: f64, speed: f64) -> f64 {
        let d = self.start.direction;
        let bristle = match self.path {
            Path::Series(_) => self.start.bristle,
            Path::Steps { .. } => self.state(elapsed)[2],
        };
        d * flow.force(elapsed, &[d * pull, d * speed, bristle])
    }

    /// Whether the pull, which does not move at the start, grows from there on.
    pub(super) fn pulls_harder(&self) -> bool {
        let growth = match &self.path {
            Path::Series(series) => series.pull[2..].iter().find(|c| **c != 0.0).copied(),
            Path::Steps { .. } => {
                let Flow { rate, stiffness, .. } = self.flow;
                Some(rate[1] - stiffness * self.flow.rates(0.0, &self.start.state())[1])
            }
        };
        growth.is_some_and(|growth| growth * self.start.pull > 0.0)
    }

    /// When `condition` ends first within the piece.
    pub(super) fn end_of(
        &self,
        condition: Condition,
        thermal: Option<&ThermalFactors>,
    ) -> Option<f64> {
        if let Condition::Beyond(sign) = condition {
            return self.end_beyond(sign, thermal?);
        }
        match &self.path {
            Path::Series(series) => {
                let mut g = condition.series(series, thermal, self.start.pull.signum());
                if self.start.released && matches!(condition, Condition::HeldBack) {
                    g[1] = g[1].max(0.0); // a belt that crept is held because this does not fall
                }
                first_crossing(&g, self.duration)
            }
            Path::Steps { .. } => {
                let towards = self.start.pull.signum();
                let slope = condition.slope(&self.flow, &self.start.state(), towards);
                let g = |t: f64| condition.value(&self.flow, t, &self.state(t), towards);
                // at a release pull and drag are equal by definition
                let at_once = matches!(condition, Condition::Overcome) && self.start.released;
                let begin = if at_once { 0.0 } else { g(0.0) };
                self.first_zero(g, begin, slope)
            }
        }
    }

    /// When the belt passes the transition of a mixed contact that moves by itself.
    #[cold]
    fn end_beyond(&self, sign: f64, thermal: &ThermalFactors) -> Option<f64> {
        let contact = self.flow.drag.mixed_contact()?;
        let transition = |t: f64| {
            contact.transition_speed(value(&thermal.boundary, t)) * value(&thermal.speed, t)
        };
        let ends = [transition(0.0), transition(self.duration)];
        if let Some((low, high)) = self.speed_range()
            && (ends.iter().all(|v| *v < low) || ends.iter().all(|v| *v > high))
        {
            return if sign * (low - ends[0]) > 0.0 { None } else { Some(0.0) };
        }
        let g = |t: f64| sign * (self.state(t)[1] - transition(t));
        let begin = if g(0.0).abs() <= MET * ends[0] { 0.0 } else { g(0.0) };
        self.first_zero(g, begin, 0.0)
    }

    /// First zero of `g` along a piece made of steps; a zero at the start counts only if `g` falls there.
    fn first_zero(&self, g: impl Fn(f64) -> f64, begin: f64, slope: f64) -> Option<f64> {
        let (mut start, mut before) = (0.0, begin);
        if before < 0.0 || (before == 0.0 && slope < 0.0) {
            return Some(0.0);
        }
        if before == 0.0 {
            // it leaves its zero upwards: begin where it is seen to be positive
            start = 0.25 * self.duration;
            before = g(start);
            for _ in 0..MAX_HALVINGS {
                if before > 0.0 {
                    break;
                }
                start *= 0.5;
                before = g(start);
            }
            before = before.max(f64::MIN_POSITIVE);
        }
        for share in [0.25, 0.5, 0.75, 1.0] {
            let end = share * self.duration;
            if end <= start {
                continue;
            }
            let after = g(end);
            if after.is_nan() || after < 0.0 {
                return Some(falling_zero(&g, (start, before), (end, after)));
            }
            (start, before) = (end, after);
        }
        None
    }

    /// Bounds of the speed over a piece that has a series.
    pub(super) fn speed_range(&self) -> Option<(f64, f64)> {
        let Path::Series(series) = &self.path else { return None };
        Some(bounds(&series.speed, self.duration))
    }

    /// The same of the pull.
    pub(super) fn pull_range(&self) -> Option<(f64, f64)> {
        let Path::Series(series) = &self.path else { return None };
        Some(bounds(&series.pull, self.duration))
    }

    /// When the belt overtakes a drive of constant speed, if it does.
    pub(super) fn overtaking(&self, drive_speed: f64) -> Option<f64> {
        let drive = self.start.direction * drive_speed;
        if self.start.mode == Mode::Stuck || self.start.speed >= drive {
            return None;
        }
        match &self.path {
            Path::Series(series) => {
                first_crossing(&subtracted_from(drive, &series.speed), self.duration)
            }
            Path::Steps { .. } => {
                self.first_zero(|t| drive - self.state(t)[1], drive - self.start.speed, 0.0)
            }
        }
    }

    /// When speed and pull turn, if they do.
    pub(super) fn turning_points(&self) -> [Option<f64>; 2] {
        match &self.path {
            Path::Series(series) => [&series.speed, &series.pull].map(|c| {
                let rate = derivative(c);
                let rising = if rate[0] < 0.0 { rate.map(|c| -c) } else { rate };
                first_crossing(&rising, self.duration)
            }),
            Path::Steps { .. } => [1, 0].map(|which| {
                let rate = |t: f64| self.flow.rates(t, &self.state(t))[which];
                let sign = rate(0.0).signum();
                let end = sign * rate(self.duration);
                (end < 0.0).then(|| {
                    let g = |t: f64| sign * rate(t);
                    falling_zero(&g, (0.0, sign * rate(0.0)), (self.duration, end))
                })
            }),
        }
    }

    /// Integral of the pull over the piece from `begin` on, signed.
    pub(super) fn impulse(&self, begin: f64) -> f64 {
        self.start.direction * self.integral(begin, 0)
    }

    /// Way of the belt over the piece from `begin` on, signed.
    pub(super) fn way(&self, begin: f64) -> f64 {
        self.start.direction * self.integral(begin, 1)
    }

    /// Integral of a component of the state over the piece from `begin` on, mirrored.
    fn integral(&self, begin: f64, component: usize) -> f64 {
        match &self.path {
            Path::Series(series) => {
                let c = if component == 0 { &series.pull } else { &series.speed };
                let antiderivative = |t: f64| {
                    let sum = (0..=ORDER)
                        .rev()
                        .fold(0.0, |sum, i| sum * t + c[i] * super::polynomial::INVERSE_NEXT[i]);
                    sum * t
                };
                antiderivative(self.duration) - antiderivative(begin)
            }
            Path::Steps { .. } => {
                let span = self.duration - begin;
                GAUSS.iter().map(|(x, w)| w * span * self.state(begin + x * span)[component]).sum()
            }
        }
    }
}

/// Values between which the polynomial stays up to `end`.
fn bounds(c: &Polynomial, end: f64) -> (f64, f64) {
    // by odd and even powers, which shortens the chain
    let (mut odd, mut even, square) = (0.0, 0.0, end * end);
    for pair in c[1..].chunks_exact(2).rev() {
        odd = odd * square + pair[0].abs();
        even = even * square + pair[1].abs();
    }
    let reach = end * odd + square * even;
    (c[0] - reach, c[0] + reach)
}

/// Nodes and weights of Gauss's quadrature with four points on the unit interval.
pub(super) const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Condition {
    /// Whether a law that does not move keeps the condition for all speeds within bounds.
    pub(super) fn holds_over(self, (low, high): (f64, f64)) -> bool {
        match self {
            Self::Faster(limit) => low > limit,
            Self::Slower(limit) => high < limit,
            _ => false,
        }
    }

    fn series(self, series: &Series, thermal: Option<&ThermalFactors>, towards: f64) -> Polynomial {
        let scaled = |base: f64, factor: fn(&ThermalFactors) -> &Polynomial| {
            if let Some(thermal) = thermal {
                return factor(thermal).map(|c| base * c);
            }
            let mut constant = [0.0; ORDER + 1];
            constant[0] = base;
            constant
        };
        let difference = |a: &Polynomial, b: &Polynomial| std::array::from_fn(|i| a[i] - b[i]);
        match self {
            Self::Faster(limit) => difference(&series.speed, &scaled(limit, |w| &w.speed)),
            Self::Slower(limit) => difference(&scaled(limit, |w| &w.speed), &series.speed),
            Self::Pulled(limit, rest) => {
                // together as where the pull was set to them, so that a release starts from nil
                let holding = scaled(limit, |w| &w.below);
                let rest = scaled(rest, |w| &w.rest);
                std::array::from_fn(|i| towards * series.pull[i] - (holding[i] + rest[i]))
            }
            Self::GripsForward(grip) => subtracted_from(grip, &series.pull),
            Self::GripsBack(grip) => subtracted_from(grip, &series.pull.map(|c| -c)),
            Self::Ahead(rate, stiffness) => std::array::from_fn(|i| {
                let driven = rate.get(i).copied().unwrap_or(0.0);
                towards * (driven - stiffness * series.speed[i])
            }),
            Self::Overcome => difference(&series.pull.map(|c| towards * c), &series.drag),
            Self::Beyond(_) => [f64::NAN; ORDER + 1], // of the piece, which knows the contact
            Self::Slowing => derivative(&series.speed).map(|c| -c),
            Self::HeldForward => difference(&series.drag, &series.pull),
            Self::HeldBack => std::array::from_fn(|i| series.drag[i] + series.pull[i]),
        }
    }

    /// Rate at which the condition changes at the start of a piece.
    fn slope(self, flow: &Flow, y: &State, towards: f64) -> f64 {
        let rates = flow.rates(0.0, y);
        match self {
            Self::Faster(_) => rates[1],
            Self::Slower(_) => -rates[1],
            Self::Pulled(..) => towards * rates[0],
            Self::GripsForward(_) => -rates[0],
            Self::GripsBack(_) => rates[0],
            Self::Ahead(rate, stiffness) => towards * (rate[1] - stiffness * rates[1]),
            Self::Overcome => towards * rates[0] - flow.force_slope(y) * rates[1],
            Self::Beyond(_) | Self::Slowing | Self::HeldForward | Self::HeldBack => f64::NAN,
        }
    }

    fn value(self, flow: &Flow, t: f64, y: &State, towards: f64) -> f64 {
        let (_, speed) = flow.factors(t);
        match self {
            Self::Faster(limit) => y[1] - limit * speed,
            Self::Slower(limit) => limit * speed - y[1],
            Self::Pulled(limit, rest) => {
                towards * y[0] - (limit * flow.below_factor(t) + rest * flow.rest_factor(t))
            }
            Self::GripsForward(grip) => grip - y[0],
            Self::GripsBack(grip) => grip + y[0],
            Self::Ahead(rate, stiffness) => towards * (horner(&rate, t) - stiffness * y[1]),
            Self::Overcome => towards * y[0] - flow.force(t, y),
            // a held or creeping belt has a series, and a transition that moves is the piece's
            Self::Beyond(_) | Self::Slowing | Self::HeldForward | Self::HeldBack => f64::NAN,
        }
    }
}

/// Zero of `g` between a point where it is positive and one where it is not: regula falsi, Illinois.
fn falling_zero(g: &impl Fn(f64) -> f64, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    let mut side = 0;
    for _ in 0..80 {
        if (b.0 - a.0).abs() <= 2.0 * f64::EPSILON * b.0.abs() || b.1 == 0.0 {
            break;
        }
        let secant = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let inside = secant > a.0 && secant < b.0;
        let t = if inside { secant } else { 0.5 * (a.0 + b.0) };
        if t <= a.0 || t >= b.0 {
            break;
        }
        let v = g(t);
        if v > 0.0 {
            a = (t, v);
            if side == 1 {
                b.1 *= 0.5;
            }
            side = 1;
        } else {
            b = (t, v);
            if side == -1 {
                a.1 *= 0.5;
            }
            side = -1;
        }
    }
    b.0
}
