//! Many belts at once: slip laps on the two power branches, several to a register.
//!
//! Each lane is one belt in scaled units: time by `sqrt(m/k)`, speed by `v_t`, pull by `v_t sqrt(k m)`. What
//! is left of the equation is `p' = w - u`, `u' = p - d u^e - r u`, where `r` is how the rest of the drive grows
//! with speed; what it drags at any speed only shifts the pull. A lane runs on the power branches and through
//! the stuck phase at `v_s`; anything rarer (a belt pulled back below `v_s`, reversal, creep) is handed to
//! the caller, which follows it with the full motion and puts the lane back. Every lane's arithmetic is its
//! own, so results do not depend on the neighbours, on the instruction set, or on the number of threads.
//!
//! A step ends at the next level of the speed (`v_s`, `v_t`, the drive speed) or at a turning point, found
//! by Newton's method on the polynomial of the step, on which the speed is monotone.
//!
//! Lanes with `STARTS` start a belt besides: the speed of their drive moves, a step ends at a time of its schedule too,
//! below the stick speed the contact drags as `exp(-u/scale)`, and how hard the spring pulls at most is kept.

pub(crate) use super::lane_series::LANES;
use super::lane_series::{INVERSE, LaneSeries, ORDER, POWERS, Row, step_size, value};
use super::polynomial::{fused, fused_in};
use crate::error::Error;
use crate::work::Work;

/// Newton iterations for an extreme, which need not be met exactly for the step to end near it.
const TURNING_NEWTON: usize = 3;

/// Most Newton iterations for a level, or halvings where they lead out of the step.
const MAX_NEWTON: usize = 60;

/// Relative distance from its level at which a step counts as ended there.
const ARRIVED: f64 = 1e-13;

/// What ended a step; numbers, so that they are found for all lanes at once.
pub(crate) mod arrival {
    /// The step ended for accuracy.
    pub const NONE: f64 = 0.0;
    /// The speed has reached its upper level.
    pub const UPPER: f64 = 1.0;
    /// The speed has an extreme.
    pub const TURNING: f64 = 2.0;
    /// The end of the step was not found.
    pub const LOST: f64 = 3.0;
}

/// The state of all lanes, in scaled units; on lines of the cache, so that no row is read from two.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(crate) struct Lanes {
    pub time: Row,
    pub pull: Row,
    pub speed: Row,
    /// Drag of the contact at the present speed.
    pub drag: Row,
    pub drive: Row,
    /// Exponent of the branch.
    pub exponent: Row,
    /// Drag of the rest of the drive per speed.
    pub rest: Row,
    /// One, or minus one where the motion is followed back in time; `time` and `impulse` count up all the same.
    pub sense: Row,
    /// Next levels of the speed.
    pub upper: Row,
    pub lower: Row,
    /// Slowest speed that matters, the stick speed.
    pub floor: Row,
    /// One where the step starts at an extreme of the speed.
    pub turned: Row,
    /// Integral of the pull.
    pub impulse: Row,
    /// Rate of the drive speed.
    pub ramp: Row,
    /// Time at which a step ends.
    pub end: Row,
    /// Speed over which drag falls by a factor `e`; zero on a power branch.
    pub decay: Row,
    /// Greatest and least pull so far.
    pub most: Row,
    pub least: Row,
    /// See [`arrival`].
    pub arrival: Row,
}

/// One step of every lane, as work for the best instruction set.
struct LaneStep<'a, const STARTS: bool> {
    lanes: &'a mut Lanes,
    series: &'a mut LaneSeries,
    tolerance: f64,
}

impl<const STARTS: bool> pulp::WithSimd for LaneStep<'_, STARTS> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // all of a step is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        self.lanes.step::<S, STARTS>(simd, self.series, self.tolerance);
    }
}

/// Fill the lanes by `admit`, step them, and hand each step to `follow` until it says that its member is done.
///
/// `admit` may pass over members; none means that no more wait. The lanes stop when `work` is stopped; how many
/// steps a member may take is for `follow` to say.
pub(crate) fn run_lanes<const STARTS: bool, R>(
    tolerance: f64,
    work: &Work,
    mut admit: impl FnMut(&mut Lanes, usize) -> Option<R>,
    mut follow: impl FnMut(&mut R, &mut Lanes, usize) -> bool,
) -> Result<(), Error> {
    let work = work.apart(u64::MAX);
    let arch = pulp::Arch::new();
    let (mut lanes, mut series) = (Lanes::idle(), LaneSeries::blank());
    let mut members: [Option<R>; LANES] = std::array::from_fn(|_| None);
    loop {
        for (l, member) in members.iter_mut().enumerate() {
            if member.is_none() {
                *member = admit(&mut lanes, l);
            }
        }
        if members.iter().all(Option::is_none) {
            return Ok(());
        }
        work.take(1)?;
        step_all::<STARTS>(arch, &mut lanes, &mut series, tolerance);
        for (l, seat) in members.iter_mut().enumerate() {
            if seat.as_mut().is_some_and(|member| !follow(member, &mut lanes, l)) {
                *seat = None;
            }
        }
    }
}

/// One step of every lane: compiled once for all that run lanes.
#[inline(never)]
fn step_all<const STARTS: bool>(
    arch: pulp::Arch,
    lanes: &mut Lanes,
    series: &mut LaneSeries,
    tolerance: f64,
) {
    arch.dispatch(LaneStep::<STARTS> { lanes, series, tolerance });
}

impl Lanes {
    /// Lanes that stand still, for want of work.
    pub(crate) fn idle() -> Self {
        Self {
            time: [0.0; LANES],
            pull: [1.0; LANES],
            speed: [2.0; LANES],
            drag: [1.0; LANES],
            drive: [2.0; LANES],
            exponent: [0.3; LANES],
            rest: [0.0; LANES],
            sense: [1.0; LANES],
            upper: [f64::INFINITY; LANES],
            lower: [0.5; LANES],
            floor: [0.01; LANES],
            turned: [0.0; LANES],
            impulse: [0.0; LANES],
            ramp: [0.0; LANES],
            end: [f64::INFINITY; LANES],
            decay: [0.0; LANES],
            most: [0.0; LANES],
            least: [0.0; LANES],
            arrival: [arrival::NONE; LANES],
        }
    }

    /// Give lane `l` the drag that its pull just balances, to the last bit.
    pub(crate) fn balance(&mut self, l: usize) {
        self.drag[l] = fused(-self.rest[l], self.speed[l], self.pull[l]);
    }

    /// One step of every lane.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::float_cmp)] // the time that is left was assigned
    fn step<S: pulp::Simd, const STARTS: bool>(
        &mut self,
        simd: S,
        series: &mut LaneSeries,
        tolerance: f64,
    ) {
        self.expand::<S, STARTS>(simd, series);
        let series = &*series;
        let mut h = step_size(&series.pull, &series.speed, &self.floor, tolerance);
        let mut left = [f64::INFINITY; LANES];
        if STARTS {
            for l in 0..LANES {
                left[l] = self.end[l] - self.time[l];
                h[l] = if h[l] < left[l] { h[l] } else { left[l] };
            }
        }
        let (turning, rate) = self.end_at_extreme(series, &mut h);
        let mut end = value(&series.speed, 0, &h);
        let (crossing, lost) = self.end_at_level(series, &rate, &mut h, &mut end);
        let (pull, drag) = (value(&series.pull, 0, &h), value(&series.drag, 0, &h));
        if STARTS {
            self.keep_pull(series, &h, &end, &pull);
        }
        let mut impulse = [0.0; LANES];
        for n in (0..=ORDER).rev() {
            for l in 0..LANES {
                impulse[l] = fused(impulse[l], h[l], series.pull[n][l] * INVERSE[n + 1]);
            }
        }
        for l in 0..LANES {
            self.time[l] =
                if STARTS && h[l] == left[l] { self.end[l] } else { self.time[l] + h[l] };
            self.pull[l] = pull[l];
            self.drag[l] = drag[l];
            self.speed[l] = end[l];
            self.impulse[l] += impulse[l] * h[l];
            let turned = if crossing[l] == 0.0 { turning[l] } else { 0.0 };
            self.turned[l] = turned;
            let met = if turned > 0.0 { arrival::TURNING } else { crossing[l] };
            self.arrival[l] = if lost[l] > 0.0 { arrival::LOST } else { met };
        }
    }

    /// The motion from the present state on; `u f' = e f u'` gives the drag `f` of the contact.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop, clippy::float_cmp)] // senses are assigned
    fn expand<S: pulp::Simd, const STARTS: bool>(&self, simd: S, series: &mut LaneSeries) {
        (series.pull[0], series.speed[0], series.drag[0]) = (self.pull, self.speed, self.drag);
        let (mut weight, mut back) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            // an exponential `f' = -f u'/decay` beside the power
            let power = !STARTS || self.decay[l] == 0.0;
            let inverse = 1.0 / if power { self.speed[l] } else { self.decay[l] };
            weight[l] = if power { (self.exponent[l] + 1.0) * inverse } else { -inverse };
            back[l] = if power { inverse } else { 0.0 };
        }
        let law = [&weight, &back];
        if cfg!(target_arch = "wasm32") {
            // small rather than quick
            for n in 1..=ORDER {
                self.add::<S, STARTS>(simd, n, law, series);
            }
        } else {
            // one at a time, so that all indices are known
            macro_rules! coefficients {
                ($($n:literal)*) => { $(self.add::<S, STARTS>(simd, $n, law, series);)* };
            }
            coefficients!(1 2 3 4 5 6 7 8 9 10 11 12);
            const { assert!(ORDER == 12) };
        }
        if self.sense == [1.0; LANES] {
            return;
        }
        let LaneSeries { pull, speed, weighted_speed, drag } = series;
        for n in (1..=ORDER).step_by(2) {
            for rows in [&mut *pull, &mut *speed, &mut *weighted_speed, &mut *drag] {
                for l in 0..LANES {
                    rows[n][l] *= self.sense[l];
                }
            }
        }
    }

    /// Coefficient `n`, which waits for the one before through two operations only: what else it takes is summed before,
    /// from the middle outwards, for the terms at the ends are the last to be known.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn add<S: pulp::Simd, const STARTS: bool>(
        &self,
        simd: S,
        n: usize,
        [weight, back]: [&Row; 2],
        series: &mut LaneSeries,
    ) {
        let per = simd.splat_f64s(INVERSE[n]);
        for r in 0..LANES / S::F64_LANES {
            let of = |row: &Row| S::as_simd_f64s(row).0[r];
            let LaneSeries { pull: p, speed: u, weighted_speed: iu, drag: f } = &*series;
            let mut sums = [[simd.splat_f64s(0.0); 2]; 2];
            let middle = usize::midpoint(n, 1);
            for i in (2..middle).rev() {
                sums[0][0] = fused_in(simd, of(&iu[i]), of(&f[n - i]), sums[0][0]);
                sums[0][1] = fused_in(simd, of(&u[i]), of(&f[n - i]), sums[0][1]);
            }
            for i in middle.max(2)..n {
                sums[1][0] = fused_in(simd, of(&iu[i]), of(&f[n - i]), sums[1][0]);
                sums[1][1] = fused_in(simd, of(&u[i]), of(&f[n - i]), sums[1][1]);
            }
            let weighted = simd.add_f64s(sums[0][0], sums[1][0]);
            let plain = simd.add_f64s(sums[0][1], sums[1][1]);
            let (share, back) = (simd.mul_f64s(of(weight), per), of(back));
            let early = simd.sub_f64s(simd.mul_f64s(share, weighted), simd.mul_f64s(back, plain));
            let rate = simd.sub_f64s(share, simd.mul_f64s(back, per));
            let from_rate = simd.mul_f64s(of(&f[0]), rate);
            let still = fused_in(simd, simd.neg_f64s(of(&self.rest)), of(&u[n - 1]), of(&p[n - 1]));
            let net = simd.sub_f64s(still, of(&f[n - 1]));
            let late = if n > 1 {
                let from_last = simd.mul_f64s(of(&u[1]), simd.sub_f64s(share, back));
                fused_in(simd, from_last, of(&f[n - 1]), early)
            } else {
                early
            };
            let driven = match n {
                1 => simd.sub_f64s(of(&self.drive), of(&self.speed)),
                2 if STARTS => simd.sub_f64s(of(&self.ramp), of(&u[1])),
                _ => simd.neg_f64s(of(&u[n - 1])),
            };
            let drag = fused_in(simd, from_rate, net, late);
            for (rows, value) in [
                (&mut series.weighted_speed, net),
                (&mut series.speed, simd.mul_f64s(net, per)),
                (&mut series.pull, simd.mul_f64s(driven, per)),
                (&mut series.drag, drag),
            ] {
                S::as_mut_simd_f64s(&mut rows[n]).0[r] = value;
            }
        }
    }

    /// End steps over an extreme of the speed there: one for each lane that does, and how fast the speed changes at the
    /// end of each step.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)]
    fn end_at_extreme(&self, series: &LaneSeries, h: &mut Row) -> (Row, Row) {
        let LaneSeries { speed: u, weighted_speed: iu, .. } = series;
        let mut slope = value(iu, 1, h);
        let mut turning: Row = [0.0; LANES];
        let mut any = 0;
        for l in 0..LANES {
            let toward = if self.turned[l] > 0.0 { u[2][l] } else { u[1][l] };
            turning[l] = if toward * slope[l] < 0.0 { 1.0 } else { 0.0 };
            any |= turning[l].to_bits();
        }
        if any == 0 {
            return (turning, slope);
        }
        let mut t = [0.0; LANES];
        for l in 0..LANES {
            let share = u[1][l].abs() / (u[1][l].abs() + slope[l].abs());
            t[l] = if self.turned[l] > 0.0 { 0.5 * h[l] } else { share * h[l] };
        }
        let mut curved = [[0.0; LANES]; ORDER + 1];
        for n in 2..=ORDER {
            for l in 0..LANES {
                curved[n][l] = iu[n][l] * POWERS[n - 1];
            }
        }
        for _ in 0..TURNING_NEWTON {
            let (rate, change) = (value(iu, 1, &t), value(&curved, 2, &t));
            for l in 0..LANES {
                let next = t[l] - rate[l] / change[l];
                t[l] = if next > 0.0 && next < h[l] { next } else { t[l] };
            }
        }
        for l in 0..LANES {
            h[l] = if turning[l] > 0.0 { t[l] } else { h[l] };
            slope[l] = if turning[l] > 0.0 { 0.0 } else { slope[l] };
        }
        (turning, slope)
    }

    /// Keep the greatest and the least pull over a step to where the belt has the speed `end`, and bring its drive there.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)]
    fn keep_pull(&mut self, series: &LaneSeries, h: &Row, end: &Row, pull: &Row) {
        let mut t = [0.0; LANES];
        let mut any = 0;
        for l in 0..LANES {
            let (before, after) =
                (self.drive[l] - self.speed[l], self.drive[l] + self.ramp[l] * h[l] - end[l]);
            let turns = before * after < 0.0;
            t[l] = if turns { h[l] * before / (before - after) } else { 0.0 };
            any |= t[l].to_bits();
        }
        let mut extreme = *pull;
        if any != 0 {
            for _ in 0..TURNING_NEWTON {
                let (v, rate) = (value(&series.speed, 0, &t), value(&series.weighted_speed, 1, &t));
                for l in 0..LANES {
                    let off = self.drive[l] + self.ramp[l] * t[l] - v[l];
                    let next = t[l] - off / (self.ramp[l] - rate[l]);
                    t[l] = if t[l] > 0.0 && next > 0.0 && next < h[l] { next } else { t[l] };
                }
            }
            let turned = value(&series.pull, 0, &t);
            for l in 0..LANES {
                extreme[l] = if t[l] > 0.0 { turned[l] } else { pull[l] };
            }
        }
        for l in 0..LANES {
            let (low, high) =
                if extreme[l] < pull[l] { (extreme[l], pull[l]) } else { (pull[l], extreme[l]) };
            self.most[l] = if high > self.most[l] { high } else { self.most[l] };
            self.least[l] = if low < self.least[l] { low } else { self.least[l] };
            self.drive[l] += self.ramp[l] * h[l];
        }
    }

    /// End steps over a level there, on it exactly: +1 or -1 for each lane that does, and one for each lane
    /// whose crossing was not found.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn end_at_level(
        &self,
        series: &LaneSeries,
        rate: &Row,
        h: &mut Row,
        end: &mut Row,
    ) -> (Row, Row) {
        let mut crossing: Row = [0.0; LANES];
        let mut lost: Row = [0.0; LANES];
        let mut any = 0;
        for l in 0..LANES {
            let up = if end[l] >= self.upper[l] { 1.0 } else { 0.0 };
            let down = if end[l] <= self.lower[l] { 1.0 } else { 0.0 };
            crossing[l] = up - down;
            any |= crossing[l].to_bits();
        }
        if any == 0 {
            return (crossing, lost);
        }
        let (mut t, mut level) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            level[l] = if crossing[l] > 0.0 { self.upper[l] } else { self.lower[l] };
            // time as a cubic of the speed between the ends; a straight line where one of them is an extreme
            let rise = end[l] - self.speed[l];
            let share = (level[l] - self.speed[l]) / rise;
            let left = 1.0 - share;
            let (first, last) = (rise / series.speed[1][l], rise / rate[l]);
            let bent = share * left * (left * first - share * last + (2.0 * share - 1.0) * h[l]);
            let line = h[l] * share;
            let cubic = line + bent;
            t[l] = if cubic > 0.0 && cubic < h[l] { cubic } else { line };
        }
        let (mut before, mut after) = ([0.0; LANES], *h);
        for _ in 0..MAX_NEWTON {
            let (v, rate) = (value(&series.speed, 0, &t), value(&series.weighted_speed, 1, &t));
            any = 0;
            for l in 0..LANES {
                let off = v[l] - level[l];
                let newton = t[l] - off / rate[l];
                let early = off * crossing[l] < 0.0;
                before[l] = if early { t[l] } else { before[l] };
                after[l] = if early { after[l] } else { t[l] };
                let inside = newton >= 0.0 && newton <= h[l];
                let next = if inside { newton } else { 0.5 * (before[l] + after[l]) };
                // a lane that has arrived keeps its time, however long the others take
                let open = crossing[l] != 0.0 && off.abs() > ARRIVED * level[l];
                t[l] = if open { next } else { t[l] };
                lost[l] = if open { 1.0 } else { 0.0 };
                any |= lost[l].to_bits();
            }
            if any == 0 {
                break;
            }
        }
        for l in 0..LANES {
            h[l] = if crossing[l] == 0.0 { h[l] } else { t[l] };
            end[l] = if crossing[l] == 0.0 { end[l] } else { level[l] };
        }
        (crossing, lost)
    }
}
