//! The motion sampled at given times, with its event table and its energies.

use super::event::Event;
use super::hybrid::Motion;
use super::piece::{GAUSS, Path, Piece};
use super::polynomial::{ORDER, Polynomial, fused, value};
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
}

/// Longest panel of the quadrature of the energies, in units of `sqrt(m/k)`.
const LONGEST_PANEL: f64 = 0.5;

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
    let time = sample_times(duration, samples);
    let (mut speed, mut pull) = (vec![0.0; samples], vec![0.0; samples]);
    let (mut mode, mut slipping) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let mut temperature = Vec::new();
    let (mut events, mut elapsed) = (Vec::new(), Vec::new());
    let mut energy = Energy::default();
    // what was asked for is read, however much it is
    let reading = work.apart(u64::MAX);
    // what the spring pulls beyond the grip is lost before anything moves
    let mut end_state = (start.belt_speed, motion.phase().direction * motion.phase().pull);
    let initial = stored(system, end_state, 0.0);
    while motion.time() < duration {
        let (piece, event) = motion.advance(duration - motion.time())?;
        let last = motion.time() >= duration;
        let end = if last { f64::INFINITY } else { piece.time + piece.duration };
        let begin = mode.len();
        let count = time[begin..].iter().take_while(|t| **t < end).count();
        let range = begin..begin + count;
        elapsed.clear();
        elapsed.extend(time[range.clone()].iter().map(|t| t - piece.time));
        let (speeds, pulls) = (&mut speed[range.clone()], &mut pull[range]);
        let blocks = speeds.chunks_mut(AT_ONCE).zip(pulls.chunks_mut(AT_ONCE));
        for (times, (speeds, pulls)) in elapsed.chunks(AT_ONCE).zip(blocks) {
            reading.take(1)?;
            sample(arch, &piece, times, speeds, pulls);
        }
        mode.resize(begin + count, piece.start.mode);
        slipping.resize(begin + count, piece.start.slipping);
        if piece.heated {
            let courses = &motion.temperatures;
            temperature
                .extend(elapsed.iter().map(|t| [value(&courses[0], *t), value(&courses[1], *t)]));
        }
        let course = piece.heated.then(|| motion.law_temperature());
        energy.add(&piece, system, arch, course.as_ref());
        end_state = piece.at(piece.duration);
        if let Some(event) = event {
            events.push(event);
            end_state.0 = event.belt_speed;
        }
    }
    let end = stored(system, end_state, duration);
    energy.dissipated += motion.stopped;
    energy.owed = motion.owed();
    energy.stored = (end.0 - initial.0) + (end.1 - initial.1);
    energy.turnover += energy.stored.abs();
    let stretch = time.iter().zip(&pull).map(|(t, p)| system.stretch(*p, *t)).collect();
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

impl Energy {
    fn add(
        &mut self,
        piece: &Piece,
        system: &System,
        arch: pulp::Arch,
        course: Option<&Polynomial>,
    ) {
        let panels = match piece.path {
            _ if piece.start.mode == Mode::Stuck => 1.0,
            // nothing changes on the way
            Path::Series(ref series) if series.is_still() => 1.0,
            // each state inside a Runge-Kutta step costs a step, and a step is smooth however long it is
            Path::Steps { .. } => 2.0,
            Path::Series(_) => {
                (piece.duration / (LONGEST_PANEL * system.train.time_scale())).ceil().max(1.0)
            }
        };
        let panel = piece.duration / panels;
        let schedule = system.drive.schedule();
        let segment = schedule.segment(piece.time + 0.5 * piece.duration);
        let driven = schedule.about(segment, piece.time);
        if piece.start.creeping {
            let (start, end) = (piece.at(0.0).0, piece.at(piece.duration).0);
            self.dissipated -= 0.5 * piece.flow.mass * (end - start) * (end + start);
        }
        let mut begin = 0.0;
        while begin < piece.duration * (1.0 - 1e-9) {
            self.add_panel(piece, system, arch, &driven, course, begin, panel);
            begin += panel;
        }
    }

    #[allow(clippy::too_many_arguments)] // one place calls it
    fn add_panel(
        &mut self,
        piece: &Piece,
        system: &System,
        arch: pulp::Arch,
        driven: &Cubic,
        course: Option<&Polynomial>,
        begin: f64,
        panel: f64,
    ) {
        let times = GAUSS.map(|(x, _)| begin + x * panel);
        let (mut speed, mut pull) = ([0.0; GAUSS.len()], [0.0; GAUSS.len()]);
        sample(arch, piece, &times, &mut speed, &mut pull);
        for (i, (t, (_, weight))) in times.into_iter().zip(GAUSS).enumerate() {
            let (speed, pull) = (speed[i], pull[i]);
            // a held belt is braked by just the pull, and a creeping one by that and its own slowing down
            let held = piece.start.mode == Mode::Stuck || piece.start.creeping;
            let friction = match course {
                _ if held => pull,
                Some(course) => piece.friction_at(value(course, t), t, pull, speed),
                None => piece.friction(t, pull, speed),
            };
            let given = driven[0] + t * (driven[1] + t * (driven[2] + t * driven[3]));
            let power = match system.drive {
                Drive::Speed(_) => pull * given,
                Drive::Force(_) => speed * given,
            };
            let span = weight * panel;
            self.work += span * power;
            self.dissipated += span * friction * speed;
            let slip = if piece.start.slipping { pull * (given - speed) } else { 0.0 };
            self.slipped += span * slip;
            self.turnover += span * (power.abs() + (friction * speed).abs() + slip.abs());
        }
    }
}

/// Speed and pull of a piece at `times` since its start, signed.
fn sample(arch: pulp::Arch, piece: &Piece, times: &[f64], speed: &mut [f64], pull: &mut [f64]) {
    if let Path::Series(series) = &piece.path {
        let direction = piece.start.direction;
        arch.dispatch(Sampling { series, direction, times, speed, pull });
        return;
    }
    for (i, t) in times.iter().enumerate() {
        (speed[i], pull[i]) = piece.at(*t);
    }
}

/// Samples of a series, as work for the best instruction set.
struct Sampling<'a> {
    series: &'a Series,
    direction: f64,
    times: &'a [f64],
    speed: &'a mut [f64],
    pull: &'a mut [f64],
}

impl pulp::WithSimd for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let (u, p) = (&self.series.speed, &self.series.pull);
        let outputs = self.speed.chunks_mut(BLOCK).zip(self.pull.chunks_mut(BLOCK));
        for (times, (speed, pull)) in self.times.chunks(BLOCK).zip(outputs) {
            let mut t = [0.0; BLOCK];
            t[..times.len()].copy_from_slice(times);
            let (mut v, mut q) = ([u[ORDER]; BLOCK], [p[ORDER]; BLOCK]);
            for i in (0..ORDER).rev() {
                for l in 0..BLOCK {
                    v[l] = fused(v[l], t[l], u[i]);
                    q[l] = fused(q[l], t[l], p[i]);
                }
            }
            for l in 0..times.len() {
                (speed[l], pull[l]) = (self.direction * v[l], self.direction * q[l]);
            }
        }
    }
}

/// Samples between two looks at whether to stop.
const AT_ONCE: usize = 64;

/// Samples that are evaluated at once.
const BLOCK: usize = 8;

#[allow(clippy::cast_precision_loss)] // more samples than 2^53 do not fit in memory
fn sample_times(duration: f64, samples: usize) -> Vec<f64> {
    let last = samples.saturating_sub(1).max(1) as f64;
    (0..samples).map(|i| duration * (i as f64 / last)).collect()
}
