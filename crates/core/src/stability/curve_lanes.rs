//! Slip laps of many belts at once whose drag is a smooth curve, several to a register.
//!
//! Each lane follows one lap of one belt, from its release until it sticks or has escaped. Every lane's arithmetic is its
//! own, so results do not depend on the neighbours, on the instruction set, or on the number of threads.
//!
//! Steps are those of Dormand and Prince, whose last slope is the next one's first.

use super::curve_laps::{CurveBelt, Lap, Laps, Release, SLOWEST};
use crate::drag::{Closure, SMOOTHING};
use crate::motion::dormand_prince::{ERROR, STAGES, WEIGHTS};
use crate::rows::{exponentials, fused, logarithms};

/// Laps that are followed together.
pub(super) const LANES: usize = 16;

type Row = [f64; LANES];

/// Steps over the time scale: the first, and the longest.
const FIRST: f64 = 0.01;
const LONGEST: f64 = 0.2;
/// Share of the longest step down to which a step may be rejected; a shorter one is taken, whatever its error.
const LEAST: f64 = 1e-9;
/// Scale of errors of the speed over that of the drive, where the belt hardly moves.
const SLOW: f64 = 1e-3;

/// What ended a lap; numbers, so that they are found for all lanes at once.
pub(super) mod met {
    /// Nothing yet.
    pub const NONE: f64 = 0.0;
    /// The belt has slowed to its stick speed.
    pub const STICKS: f64 = 1.0;
    /// It speeds up again, or swings too little to come down to where drag is least.
    pub const ESCAPED: f64 = 2.0;
    /// Its motion is no number.
    pub const LOST: f64 = 3.0;
}

/// State and belt of every lane; ones and zeros stand for what holds and what does not.
#[repr(align(64))]
pub(super) struct CurveLanes {
    speed: Row,
    pull: Row,
    time: Row,
    step: Row,
    /// Slopes of speed and pull, first and others; the first is that of the state.
    slopes: [[Row; 2]; STAGES],
    /// Whether the belt slows down above its stick speed, and whether it is still on its way up to that.
    slowing: Row,
    starting: Row,
    least: Row,
    most: Row,
    pub met: Row,
    drive: Row,
    /// Drag of steady sliding.
    steady: Row,
    /// Scales of the errors of speed and pull, over their tolerance.
    slowest: Row,
    release: Row,
    tolerance: Row,
    stiffness: Row,
    per_mass: Row,
    grip: Row,
    stick: Row,
    /// Slowest speed of the curve, where it begins, points per `ln v`, and how many there are.
    floor: Row,
    first: Row,
    per_step: Row,
    last: Row,
    breakaway: Row,
    decay: Row,
    smooth: Row,
    rest_force: Row,
    rest_damping: Row,
    transition: Row,
    longest: Row,
    cells: [Vec<[f64; 4]>; LANES],
}

impl CurveLanes {
    /// Lanes that stand still, for want of work.
    pub(super) fn idle() -> Self {
        let (zero, one) = ([0.0; LANES], [1.0; LANES]);
        Self {
            speed: one,
            pull: one,
            time: zero,
            step: zero,
            slopes: [[zero; 2]; STAGES],
            slowing: zero,
            starting: zero,
            least: zero,
            most: zero,
            met: zero,
            drive: one,
            steady: one,
            slowest: one,
            release: one,
            tolerance: one,
            stiffness: one,
            per_mass: one,
            grip: one,
            stick: one,
            floor: one,
            first: zero,
            per_step: one,
            last: one,
            breakaway: one,
            decay: one,
            smooth: zero,
            rest_force: zero,
            rest_damping: zero,
            transition: one,
            longest: zero,
            cells: std::array::from_fn(|_| vec![[0.0; 4]; 3]),
        }
    }

    /// Seat a belt.
    pub(super) fn board(&mut self, l: usize, laps: &Laps) {
        let CurveBelt { train, curve, stick_speed, closure, rest, .. } = laps.belt;
        let (first, step) = curve.spacing();
        let scale = (train.mass() / train.stiffness()).sqrt();
        curve.write_cells(&mut self.cells[l]);
        #[allow(clippy::cast_precision_loss)] // two cells more than steps
        let last = (self.cells[l].len() - 2) as f64;
        (self.first[l], self.per_step[l], self.last[l]) = (first, 1.0 / step, last);
        (self.stiffness[l], self.per_mass[l]) = (train.stiffness(), 1.0 / train.mass());
        (self.grip[l], self.longest[l]) = (train.grip(), LONGEST * scale);
        (self.stick[l], self.floor[l]) = (*stick_speed, SLOWEST * stick_speed);
        (self.breakaway[l], self.decay[l]) = (laps.breakaway, laps.decay);
        self.smooth[l] = f64::from(u8::from(*closure == Closure::Stribeck));
        (self.rest_force[l], self.rest_damping[l]) = (rest.force, rest.damping);
        (self.tolerance[l], self.transition[l]) = (laps.tolerance, laps.transition());
    }

    /// Begin a lap of the belt that is seated.
    pub(super) fn begin(&mut self, l: usize, laps: &Laps, drive_speed: f64, release: Release) {
        let Release { pull, speed } = release;
        let (stick, grip) = (self.stick[l], self.grip[l]);
        let starting = speed < stick;
        (self.speed[l], self.pull[l], self.time[l]) = (speed, pull, 0.0);
        (self.slowing[l], self.starting[l]) = (0.0, f64::from(u8::from(starting)));
        (self.least[l], self.most[l], self.met[l]) = (pull, pull, met::NONE);
        (self.drive[l], self.steady[l]) = (drive_speed, laps.drag(drive_speed, false));
        (self.slowest[l], self.release[l]) = (stick.max(SLOW * drive_speed), pull);
        self.step[l] = FIRST / LONGEST * self.longest[l];
        let slips = pull >= grip && speed < drive_speed;
        let growth = if slips { 0.0 } else { self.stiffness[l] * (drive_speed - speed) };
        let net = (pull.min(grip) - laps.drag(speed, starting)) * self.per_mass[l];
        (self.slopes[0][0][l], self.slopes[0][1][l]) = (net, growth);
    }

    /// The lap that has just ended.
    pub(super) fn lap(&self, l: usize) -> Lap {
        let sticks = (self.met[l] == met::STICKS).then_some(self.pull[l]);
        Lap { sticks, duration: self.time[l], pull: (self.least[l], self.most[l]) }
    }

    /// One step of every lane.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)]
    pub(super) fn step(&mut self) {
        let (mut u, mut p) = (self.speed, self.pull);
        for stage in 1..STAGES {
            let (mut du, mut dp) = ([0.0; LANES], [0.0; LANES]);
            for before in 0..stage {
                let weight = WEIGHTS[stage][before];
                for l in 0..LANES {
                    du[l] = fused(weight, self.slopes[before][0][l], du[l]);
                    dp[l] = fused(weight, self.slopes[before][1][l], dp[l]);
                }
            }
            for l in 0..LANES {
                u[l] = fused(self.step[l], du[l], self.speed[l]);
                p[l] = fused(self.step[l], dp[l], self.pull[l]);
            }
            self.slopes[stage] = self.rate(&u, &p);
        }
        let (mut of_speed, mut of_pull) = ([0.0; LANES], [0.0; LANES]);
        for stage in 0..STAGES {
            for l in 0..LANES {
                of_speed[l] = fused(ERROR[stage], self.slopes[stage][0][l], of_speed[l]);
                of_pull[l] = fused(ERROR[stage], self.slopes[stage][1][l], of_pull[l]);
            }
        }
        let mut off = [0.0; LANES];
        for l in 0..LANES {
            let moves = self.speed[l].abs();
            let scale = if moves > self.slowest[l] { moves } else { self.slowest[l] };
            let (a, b) = ((of_speed[l] / scale).abs(), (of_pull[l] / self.release[l]).abs());
            off[l] = (if a > b { a } else { b }) * self.step[l] / self.tolerance[l];
        }
        self.arrive(&u, &p, &off);
    }

    /// Rates of speed and pull.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn rate(&self, u: &Row, p: &Row) -> [Row; 2] {
        let drag = self.drag(u);
        let (mut net, mut growth) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let slips = p[l] >= self.grip[l] && u[l] < self.drive[l];
            let held = if p[l] < self.grip[l] { p[l] } else { self.grip[l] };
            let stretches = self.stiffness[l] * (self.drive[l] - u[l]);
            growth[l] = if slips { 0.0 } else { stretches };
            net[l] = (held - drag[l]) * self.per_mass[l];
        }
        [net, growth]
    }

    /// Pull that the drag of each belt balances.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::cast_possible_truncation)]
    fn drag(&self, u: &Row) -> Row {
        let mut speed = [0.0; LANES];
        for l in 0..LANES {
            speed[l] = if u[l] > self.floor[l] { u[l] } else { self.floor[l] };
        }
        let log = logarithms(&speed);
        let (mut place, mut index) = ([0.0; LANES], [0_u64; LANES]);
        for l in 0..LANES {
            place[l] = (log[l] - self.first[l]) * self.per_step[l];
            // rounded down by what is too large a number for halves; the cell before the first is number nought
            let low = if place[l] > -0.5 { place[l] } else { -0.5 };
            let inside = if low < self.last[l] + 0.5 { low } else { self.last[l] + 0.5 };
            let whole = (inside + 0.5) + WHOLE;
            index[l] = whole.to_bits();
            let begins = whole - WHOLE - 1.0;
            place[l] -= if begins > 0.0 { begins } else { 0.0 };
        }
        let mut cubic = [[0.0; LANES]; 4];
        for l in 0..LANES {
            let cell = self.cells[l][(index[l] & 0xffff_ffff) as usize];
            for n in 0..4 {
                cubic[n][l] = cell[n];
            }
        }
        let [a, b, c, d] = &cubic;
        let (mut power, mut below, mut any) = ([0.0; LANES], [0.0; LANES], 0);
        for l in 0..LANES {
            let t = place[l];
            let curve = fused(t, fused(t, fused(t, d[l], c[l]), b[l]), a[l]);
            let starts = if u[l] < self.stick[l] { self.starting[l] } else { 0.0 };
            below[l] = starts;
            power[l] = if starts > 0.0 { -self.decay[l] * u[l] } else { curve };
            any |= (starts * self.smooth[l]).to_bits();
        }
        let power = exponentials(&power);
        let mut drag = [0.0; LANES];
        for l in 0..LANES {
            let contact = if below[l] > 0.0 { self.breakaway[l] * power[l] } else { power[l] };
            drag[l] = contact + fused(self.rest_damping[l], u[l], self.rest_force[l]);
        }
        if any != 0 {
            let mut steep = [0.0; LANES];
            for l in 0..LANES {
                steep[l] = 2.0 / SMOOTHING * u[l] / self.stick[l];
            }
            let steep = exponentials(&steep);
            for l in 0..LANES {
                let share = 1.0 - 2.0 / (steep[l] + 1.0);
                drag[l] *= if below[l] * self.smooth[l] > 0.0 { share } else { 1.0 };
            }
        }
        drag
    }

    /// Take the steps that are good enough to where they lead, and say which laps end there.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn arrive(&mut self, after: &Row, pulled: &Row, off: &Row) {
        let mut size = [0.0; LANES];
        for l in 0..LANES {
            let large = if off[l] > 1e-9 { off[l] } else { 1e-9 };
            size[l] = if large < 1e300 { large } else { 1e300 };
        }
        let power = exponentials(&logarithms(&size).map(|log| -0.2 * log));
        for l in 0..LANES {
            let taken = self.step[l];
            let good = off[l] <= 1.0 || taken <= LEAST * self.longest[l];
            let (low, high) = if good { (0.3, 4.0) } else { (0.1, 0.7) };
            let factor = 0.9 * power[l];
            let factor = if factor > low { factor } else { low };
            let next = taken * if factor < high { factor } else { high };
            self.step[l] = if next < self.longest[l] { next } else { self.longest[l] };
            let (speed, stick) = (self.speed[l], self.stick[l]);
            let slows = good && self.slowing[l] > 0.0;
            let sticks = slows && after[l] <= stick;
            let escapes = slows && !sticks && after[l] > speed;
            // straight in between: the step is short, as the drag is steep there
            let share = (speed - stick) / (speed - after[l]);
            let share = if share > 0.0 { share } else { 0.0 };
            let share = if share < 1.0 { share } else { 1.0 };
            let meets = fused(share, pulled[l] - self.pull[l], self.pull[l]);
            let held = if pulled[l] < self.grip[l] { pulled[l] } else { self.grip[l] };
            let moves = good && !escapes;
            let pull = if sticks { meets } else { held };
            let (least, most) = (self.least[l], self.most[l]);
            self.least[l] = if moves && pull < least { pull } else { least };
            self.most[l] = if moves && !sticks && pull > most { pull } else { most };
            let passed = if sticks { share * taken } else { taken };
            self.time[l] += if moves { passed } else { 0.0 };
            let comes_down = moves && after[l] < speed && after[l] > stick;
            self.slowing[l] = if comes_down { 1.0 } else { self.slowing[l] };
            let arrives = moves && after[l] >= stick;
            self.starting[l] = if arrives { 0.0 } else { self.starting[l] };
            self.speed[l] = if moves { after[l] } else { speed };
            self.pull[l] = if moves { pull } else { self.pull[l] };
            for of in 0..2 {
                let (first, last) = (self.slopes[0][of][l], self.slopes[STAGES - 1][of][l]);
                self.slopes[0][of][l] = if moves { last } else { first };
            }
            let number = (self.speed[l] + self.pull[l]).abs() < f64::INFINITY;
            let still = self.dies_out(l);
            let ends = if escapes || (moves && still) { met::ESCAPED } else { met::NONE };
            let ends = if number { ends } else { met::LOST };
            self.met[l] = if sticks { met::STICKS } else { ends };
        }
    }

    /// As `Laps::dies_out`.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn dies_out(&self, l: usize) -> bool {
        let ahead = self.speed[l] - self.drive[l];
        let margin = self.drive[l] - self.transition[l];
        let off = self.pull[l] - self.steady[l];
        let swing = ahead * ahead + off * off * self.per_mass[l] / self.stiffness[l];
        margin > 0.0
            && ahead.abs() < margin
            && self.steady[l] < self.grip[l]
            && swing < margin * margin
    }
}

/// 2^52, from which on there are whole numbers only.
const WHOLE: f64 = 4_503_599_627_370_496.0;
