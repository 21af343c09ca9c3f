//! The motion sampled at given times, with its event table and its energies.

use super::event::Event;
use super::hybrid::Motion;
use super::piece::{GAUSS, Path, Piece};
use super::polynomial::{BLOCK, ORDER, POWERS, Polynomial, value, values};
use super::runge_kutta::horner;
use super::schedule::Cubic;
use super::system::{Drive, Integrator, Start, System};
use super::taylor::Series;
use crate::drag::Mode;
use crate::error::{Error, above, at_most};
use crate::work::Work;

/// Motion at equally spaced times from 0 to the duration.
#[derive(Debug, Clone)]
pub struct Trajectory {
    /// Time of each sample.
    pub time: Vec<f64>,
    /// Belt speed at each sample.
    pub belt_speed: Vec<f64>,
    /// Spring stretch at each sample; with a drive of given force, position of the mass.
    pub stretch: Vec<f64>,
    /// Mode at each sample.
    pub mode: Vec<Mode>,
    /// Whether the roll slips on the belt at each sample.
    pub slipping: Vec<bool>,
    /// Temperatures of film and roll at each sample, K, if they are states.
    pub temperature: Vec<[f64; 2]>,
    /// Every change of mode.
    pub events: Vec<Event>,
    /// Where the work of the drive went.
    pub energy: Energy,
    /// Steps taken.
    pub steps: usize,
}

/// Energies of a run, each by its own integral.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Work done by the drive.
    pub work: f64,
    /// Work done against drag.
    pub dissipated: f64,
    /// Work lost where the roll slipped on the belt.
    pub slipped: f64,
    /// Growth of kinetic and spring energy.
    pub stored: f64,
    /// What the contact has given the belt and not got back, where the temperature is a state: of what was dissipated it
    /// has not heated the film.
    pub owed: f64,
    /// Sum of the magnitudes of all work done, the measure of the residual.
    pub turnover: f64,
}

impl Energy {
    /// What is missing, as a share of the energy turned over.
    #[must_use]
    pub fn residual(&self) -> f64 {
        let missing = self.work - self.dissipated - self.slipped - self.stored;
        if missing == 0.0 { 0.0 } else { missing / self.turnover }
    }

    /// Add the works of drive, drag and roll.
    fn take(&mut self, [work, dissipated, slipped, turnover]: [f64; 4]) {
        self.work += work;
        self.dissipated += dissipated;
        self.slipped += slipped;
        self.turnover += turnover;
    }
}

/// Samples of one motion: their arrays fit in a gigabyte.
const MOST_SAMPLES: usize = 20_000_000;

/// Motion of `system` from `start` over `duration`, at `samples` equally spaced times.
///
/// Events are located to rounding, and the samples are read from the steps as they are:
/// neither depends on how densely the output is asked for.
///
/// # Errors
/// If a value is not finite or out of range, the motion switches mode without end, or `work` ends before it.
pub fn simulate(
    system: &System,
    start: Start,
    duration: f64,
    samples: usize,
    tolerance: f64,
    integrator: Integrator,
    work: &Work,
) -> Result<Trajectory, Error> {
    above("duration", duration, 0.0)?;
    #[allow(clippy::cast_precision_loss)] // counts for the message
    at_most("samples", samples as f64, MOST_SAMPLES as f64)?;
    let mut motion = Motion::new(system, start, tolerance, integrator, work)?;
    let arch = pulp::Arch::new();
    let mut time = sample_times(duration, samples);
    // samples are written in blocks, of which the last may run on: what it writes there the next piece writes anew
    time.resize(samples + BLOCK, duration);
    let (mut speed, mut pull) = (vec![0.0; time.len()], vec![0.0; time.len()]);
    let (mut mode, mut slipping) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let mut temperature = Vec::new();
    let mut events = Vec::new();
    let mut account = Account { energy: Energy::default(), departure: None };
    // what was asked for is read, however much it is
    let reading = work.apart(u64::MAX);
    // what the spring pulls beyond the grip is lost before anything moves
    let mut end_state = (start.belt_speed, motion.phase().direction * motion.phase().pull);
    let initial = stored(system, end_state, 0.0);
    let mut piece = motion.no_piece();
    while motion.time() < duration {
        let event = motion.advance(duration - motion.time(), &mut piece)?;
        let last = motion.time() >= duration;
        let end = if last { f64::INFINITY } else { piece.time + piece.duration };
        let begin = mode.len();
        let count = time[begin..samples].iter().take_while(|t| **t < end).count();
        let range = begin..begin + count;
        for at in range.clone().step_by(AT_ONCE) {
            reading.take(1)?;
            let count = AT_ONCE.min(range.end - at);
            sample(arch, &piece, count, &time[at..], &mut speed[at..], &mut pull[at..]);
        }
        mode.resize(range.end, piece.start.mode);
        slipping.resize(range.end, piece.start.slipping);
        if piece.heated {
            let courses = &motion.temperatures;
            let elapsed = time[range].iter().map(|t| t - piece.time);
            temperature.extend(elapsed.map(|t| [value(&courses[0], t), value(&courses[1], t)]));
        }
        let course = piece.heated.then(|| motion.law_temperature());
        account.add(&piece, system, arch, course.as_ref(), motion.goes_on && !last);
        if last {
            end_state = piece.at(piece.duration);
        }
        if let Some(event) = event {
            events.push(event);
            end_state.0 = event.belt_speed;
        }
    }
    let end = stored(system, end_state, duration);
    let mut energy = account.energy;
    energy.dissipated += motion.stopped;
    energy.owed = motion.owed();
    energy.stored = (end.0 - initial.0) + (end.1 - initial.1);
    energy.turnover += energy.stored.abs();
    for padded in [&mut time, &mut speed, &mut pull] {
        padded.truncate(samples);
    }
    let mut stretch = pull;
    for (stretch, t) in stretch.iter_mut().zip(&time) {
        *stretch = system.stretch(*stretch, *t);
    }
    let steps = motion.steps;
    let belt_speed = speed;
    Ok(Trajectory { time, belt_speed, stretch, mode, slipping, temperature, events, energy, steps })
}

/// Kinetic energy and energy of the spring.
fn stored(system: &System, (speed, pull): (f64, f64), time: f64) -> (f64, f64) {
    let stretch = system.stretch(pull, time);
    let spring = 0.5 * system.train.stiffness() * stretch * stretch;
    (0.5 * system.train.mass() * speed * speed, spring)
}

/// The energies so far.
struct Account {
    energy: Energy,
    /// The series of the last piece may depart from the law: its drag at the end, and what a difference there comes to.
    departure: Option<(f64, f64)>,
}

impl Account {
    /// Add a piece; whether the next one goes on where it ends.
    fn add(
        &mut self,
        piece: &Piece,
        system: &System,
        arch: pulp::Arch,
        course: Option<&Polynomial>,
        goes_on: bool,
    ) {
        if let Some((drag, weight)) = self.departure.take() {
            let law = match &piece.path {
                Path::Series(series) => piece.start.direction * series.drag[0],
                Path::Steps { .. } => {
                    let (speed, pull) = piece.at(0.0);
                    piece.friction(0.0, pull, speed)
                }
            };
            self.energy.dissipated += (law - drag) * weight;
        }
        let schedule = system.drive.schedule();
        let segment = schedule.segment(piece.time + 0.5 * piece.duration);
        let given = Given { drive: &system.drive, course: schedule.about(segment, piece.time) };
        match &piece.path {
            Path::Series(series) => self.add_series(piece, series, &given, arch, course, goes_on),
            Path::Steps { .. } => self.add_steps(piece, &given, course),
        }
    }

    /// By quadrature of the series, which is smooth however long the piece is. That the series departs from the law of
    /// drag, by a power more than its last, is seen where the departure is largest, at the end.
    fn add_series(
        &mut self,
        piece: &Piece,
        series: &Series,
        given: &Given,
        arch: pulp::Arch,
        course: Option<&Polynomial>,
        goes_on: bool,
    ) {
        let end = piece.duration;
        // a held belt is braked by just the pull, and a creeping one by that and its own slowing down
        let held = piece.start.mode == Mode::Stuck || piece.start.creeping;
        let (done, [pull, speed, drag]) = arch.dispatch(Quadrature { piece, series, given, held });
        let energy = &mut self.energy;
        energy.take(done);
        if piece.start.creeping {
            let start = piece.at(0.0).0;
            energy.dissipated -= 0.5 * piece.flow.mass * (speed - start) * (speed + start);
        }
        let weight = speed * end * LATE;
        if goes_on && !held {
            self.departure = Some((drag, weight));
        } else if !held {
            let law = law_along(piece, course, end, pull, speed);
            energy.dissipated += (law - drag) * weight;
        }
    }

    /// By values inside the steps, each of which costs a step.
    fn add_steps(&mut self, piece: &Piece, given: &Given, course: Option<&Polynomial>) {
        let span = 0.5 * piece.duration;
        for begin in [0.0, span] {
            for (x, weight) in GAUSS {
                let t = begin + x * span;
                let (speed, pull) = piece.at(t);
                let friction = law_along(piece, course, t, pull, speed);
                let powers = given.powers(piece, t, [speed, pull, friction]);
                self.energy.take(works(weight * span, powers));
            }
        }
    }
}

/// Friction of the law at one time of a piece, on the course of its temperature if that is a state.
fn law_along(piece: &Piece, course: Option<&Polynomial>, t: f64, pull: f64, speed: f64) -> f64 {
    match course {
        Some(course) => piece.friction_at(value(course, t), t, pull, speed),
        None => piece.friction(t, pull, speed),
    }
}

/// Works of drive, drag and roll over a time at constant power, and the sum of their magnitudes.
#[inline(always)]
#[allow(clippy::inline_always)]
fn works(span: f64, powers: [f64; 3]) -> [f64; 4] {
    let [power, braked, slip] = powers.map(|power| span * power);
    [power, braked, slip, power.abs() + braked.abs() + slip.abs()]
}

/// The drive along a piece, in time since its start.
struct Given<'a> {
    drive: &'a Drive,
    course: Cubic,
}

impl Given<'_> {
    /// Power of the drive, of the drag and of the roll that slips, at one time.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn powers(&self, piece: &Piece, t: f64, [speed, pull, friction]: [f64; 3]) -> [f64; 3] {
        let driven = horner(&self.course, t);
        let power = match self.drive {
            Drive::Speed(_) => pull * driven,
            Drive::Force(_) => speed * driven,
        };
        let slip = if piece.start.slipping { pull * (driven - speed) } else { 0.0 };
        [power, friction * speed, slip]
    }
}

/// Nodes and weights of Gauss's quadrature with seven points on the unit interval, and its end, which has no weight.
const NODES: [(f64, f64); BLOCK] = [
    (0.025_446_043_828_620_7, 0.064_742_483_084_434_87),
    (0.129_234_407_200_302_77, 0.139_852_695_744_638_32),
    (0.297_077_424_311_301_4, 0.190_915_025_252_559_46),
    (0.5, 0.208_979_591_836_734_7),
    (0.702_922_575_688_698_5, 0.190_915_025_252_559_46),
    (0.870_765_592_799_697_2, 0.139_852_695_744_638_32),
    (0.974_553_956_171_379_3, 0.064_742_483_084_434_87),
    (1.0, 0.0),
];

/// Integral over the unit interval of the first power that a series leaves out.
const LATE: f64 = 1.0 / (POWERS[ORDER] + 2.0);

/// What is done along a series, as work for the best instruction set, and its pull, speed and drag at the end, signed.
struct Quadrature<'a> {
    piece: &'a Piece<'a>,
    series: &'a Series,
    given: &'a Given<'a>,
    held: bool,
}

impl pulp::WithSimd for Quadrature<'_> {
    type Output = ([f64; 4], [f64; 3]);

    #[inline(always)]
    #[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
        let Self { piece, series, given, held } = self;
        let Series { pull, speed, drag } = series;
        let times = NODES.map(|(x, _)| x * piece.duration);
        let values = values(simd, [pull, speed, drag], &times);
        let [pull, speed, drag] = values.map(|of| of.map(|value| piece.start.direction * value));
        let mut done = [[0.0; BLOCK]; 4];
        for i in 0..BLOCK {
            let friction = if held { pull[i] } else { drag[i] };
            let powers = given.powers(piece, times[i], [speed[i], pull[i], friction]);
            let works = works(NODES[i].1 * piece.duration, powers);
            for (of, work) in done.iter_mut().zip(works) {
                of[i] = work;
            }
        }
        let done = done.map(|d| ((d[0] + d[4]) + (d[2] + d[6])) + ((d[1] + d[5]) + (d[3] + d[7])));
        (done, [pull, speed, drag].map(|of| of[BLOCK - 1]))
    }
}

/// Speed and pull of a piece at the first `count` of `times`, signed; at some more where they come in blocks.
fn sample(
    arch: pulp::Arch,
    piece: &Piece,
    count: usize,
    times: &[f64],
    speed: &mut [f64],
    pull: &mut [f64],
) {
    if let Path::Series(series) = &piece.path {
        arch.dispatch(Sampling { piece, series, count, times, speed, pull });
        return;
    }
    for (i, t) in times[..count].iter().enumerate() {
        (speed[i], pull[i]) = piece.at(t - piece.time);
    }
}

/// Samples of a series, as work for the best instruction set.
struct Sampling<'a> {
    piece: &'a Piece<'a>,
    series: &'a Series,
    count: usize,
    times: &'a [f64],
    speed: &'a mut [f64],
    pull: &'a mut [f64],
}

impl pulp::WithSimd for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let of = [&self.series.speed, &self.series.pull];
        let (direction, begin) = (self.piece.start.direction, self.piece.time);
        let (speeds, pulls) = (self.speed.as_chunks_mut().0, self.pull.as_chunks_mut().0);
        let blocks = self.times.as_chunks::<BLOCK>().0.iter().zip(speeds.iter_mut().zip(pulls));
        for (times, (speed, pull)) in blocks.take(self.count.div_ceil(BLOCK)) {
            let found = values(simd, of, &times.map(|time| time - begin));
            [*speed, *pull] = found.map(|of| of.map(|value| direction * value));
        }
    }
}

/// Samples between two looks at whether to stop.
const AT_ONCE: usize = 64;

#[allow(clippy::cast_precision_loss)] // more samples than 2^53 do not fit in memory
fn sample_times(duration: f64, samples: usize) -> Vec<f64> {
    let last = samples.saturating_sub(1).max(1) as f64;
    (0..samples).map(|i| duration * (i as f64 / last)).collect()
}
