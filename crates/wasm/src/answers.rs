//! What the exported functions answer. Each question begins with the steps of work that are allowed.

use hersey_core::drag::Drag;
use hersey_core::motion::{
    Drive, Drivetrain, Integrator, Schedule, Span, System, settle, simulate,
};
use hersey_core::stability::{self, Band, Method};

use crate::law::{AskedLaw, drag};
use crate::question::{MOST, Question};
use crate::refusal::Refusal;

type Answer = Result<Vec<f64>, Refusal>;

/// Law. Answer: force and speed of the transition, stick speed, force that the contact bears at rest, that with the
/// rest of the drive, force and damping of the rest, speed from which on drag rises.
pub fn law(question: &mut Question) -> Answer {
    let drag = drag(question)?;
    let rest = drag.rest();
    Ok(vec![
        drag.transition_force(),
        drag.transition_speed(),
        drag.stick_speed(),
        drag.breakaway_force(),
        drag.holding_force(0.0),
        rest.force,
        rest.damping,
        drag.rising_from(),
    ])
}

/// Law, list of speeds. Answer: the drag at each.
pub fn forces(question: &mut Question) -> Answer {
    let drag = drag(question)?;
    Ok(question.list()?.iter().map(|speed| drag.force(*speed)).collect())
}

/// Steps, train, law, tolerance, duration, samples, list of times of the drive, list of its speeds, start. Answer: steps
/// taken, samples, events; of each sample time, then of each belt speed, spring force, mode (0 EHL, 1 mixed, 2 microslip,
/// 3 stuck) and whether the roll slips; of each event time, modes before and after, guard, stretch, belt speed.
#[allow(clippy::cast_precision_loss)] // counts
pub fn motion(question: &mut Question) -> Answer {
    let work = question.work()?;
    let (train, drag) = (question.train()?, drag(question)?);
    let [tolerance, duration] = question.numbers()?;
    let samples = question.count("samples")?;
    let (times, speeds) = (question.list()?, question.list()?);
    let schedule = Schedule::linear("drive_speed", times, speeds)?;
    let start = question.start(&train, &drag, schedule.at(0.0))?;
    let system = System::new(train, &drag, Drive::Speed(schedule), None)?;
    let run = simulate(&system, start, duration, samples, tolerance, Integrator::Adaptive, &work)?;
    if run.events.len() > MOST {
        return Err(Refusal::Malformed("more than 4 million changes of mode"));
    }
    let mut answer = Vec::with_capacity(3 + 5 * samples + 6 * run.events.len());
    answer.extend([run.steps as f64, samples as f64, run.events.len() as f64]);
    answer.extend(&run.time);
    answer.extend(&run.belt_speed);
    answer.extend(run.stretch.iter().map(|stretch| train.stiffness() * stretch));
    for state in [
        run.mode.iter().map(|mode| f64::from(*mode as u8)).collect::<Vec<_>>(),
        run.slipping.iter().map(|slips| f64::from(u8::from(*slips))).collect(),
    ] {
        answer.extend(&state);
        // a change of mode just at the end leaves the last sample without one
        answer.extend(state.last().into_iter().cycle().take(samples - state.len()));
    }
    for event in &run.events {
        let [from, to] = [event.from, event.to].map(|mode| f64::from(mode as u8));
        let guard = f64::from(event.guard as u8);
        answer.extend([event.time, from, to, guard, event.stretch, event.belt_speed]);
    }
    Ok(answer)
}

/// Steps, train, law, tolerance, drive speed, start. Answer: kind (0 steady sliding, 1 oscillation, 2 stick-slip,
/// 3 unsettled, 4 stalled, 5 grip slip), frequency, durations of slip and stick, least and greatest speed, least and
/// greatest stretch, duration of the roll's slip, work of drag, laps a period, laps.
#[allow(clippy::cast_precision_loss)] // counts
pub fn cycle(question: &mut Question) -> Answer {
    let work = question.work()?;
    let (train, drag) = (question.train()?, drag(question)?);
    let [tolerance, drive_speed] = question.numbers()?;
    let start = question.start(&train, &drag, drive_speed)?;
    let found = settle(&train, &drag, drive_speed, start, Span::UntilClosed, tolerance, &work)?;
    Ok(vec![
        f64::from(found.kind as u8),
        found.frequency,
        found.slip_duration,
        found.stick_duration,
        found.speed_min,
        found.speed_max,
        found.stretch_min,
        found.stretch_max,
        found.grip_slip_duration,
        found.drag_work,
        found.laps_per_period as f64,
        found.laps as f64,
    ])
}

/// Steps of each motion, train, law (without temperature), whether with the lower edge, tolerance, stick speed at every
/// temperature (or that of the law), list of temperatures (empty: the law as it is). Answer for each: lower edge,
/// transition, upper edge, whether it stalls, greatest speed, accuracies of lower and upper, whether by half laps,
/// whether deeper, laps, what a belt at rest bears; not a number where there is none. If no temperature has a band, why
/// the first has not.
pub fn bands(question: &mut Question) -> Answer {
    let work = question.work()?;
    let (train, asked) = (question.train()?, AskedLaw::read(question)?);
    let (lower, tolerance) = (question.flag()?, question.number()?);
    let stick_speed = question.given()?;
    let temperatures = question.list()?;
    let each: Vec<Option<f64>> = match temperatures {
        [] => vec![None],
        many => many.iter().copied().map(Some).collect(),
    };
    let mut belts: Vec<(Drivetrain, Drag)> = Vec::new();
    let mut why: Option<Refusal> = None;
    let mut places = Vec::new();
    for (place, temperature) in each.iter().enumerate() {
        match asked.at(*temperature, stick_speed) {
            Ok(drag) => {
                places.push(place);
                belts.push((train, drag));
            }
            Err(refusal) => why = why.or(Some(refusal)),
        }
    }
    let found = stability::bands(&belts, lower, tolerance, &work)?;
    let mut answer = vec![[f64::NAN; 11]; each.len()];
    let mut any = false;
    for ((place, band), (_, drag)) in places.into_iter().zip(found).zip(&belts) {
        answer[place][10] = drag.holding_force(0.0);
        match band {
            Ok(band) => {
                answer[place][..10].copy_from_slice(&row(&band));
                any = true;
            }
            Err(error) => why = why.or(Some(error.into())),
        }
    }
    match why {
        Some(refusal) if !any => Err(refusal),
        _ => Ok(answer.into_flattened()),
    }
}

#[allow(clippy::cast_precision_loss)] // counts
fn row(band: &Band) -> [f64; 10] {
    let flag = |holds: bool| f64::from(u8::from(holds));
    [
        band.lower,
        band.transition,
        band.upper,
        flag(band.stalls),
        band.speed_max,
        band.lower_accuracy,
        band.upper_accuracy,
        flag(band.method == Method::HalfLaps),
        flag(band.deeper),
        band.laps as f64,
    ]
}

/// Steps of each motion, train, law, tolerance, drive speed, samples. Answer: whether the lap closes; of each sample along
/// it belt speed, then of each spring force; nothing where there is no such lap.
pub fn unstable(question: &mut Question) -> Answer {
    let work = question.work()?;
    let (train, drag) = (question.train()?, drag(question)?);
    let [tolerance, drive_speed] = question.numbers()?;
    let samples = question.count("samples")?;
    let Some(lap) = stability::unstable_lap(&train, &drag, drive_speed, tolerance, &work)? else {
        return Ok(Vec::new());
    };
    let (system, adaptive) = (System::at_speed(train, &drag, drive_speed)?, Integrator::Adaptive);
    let mut run = simulate(&system, lap.start, lap.duration, samples, tolerance, adaptive, &work)?;
    if lap.closed && samples > 0 {
        (run.belt_speed[samples - 1], run.stretch[samples - 1]) = (drive_speed, lap.start.stretch);
    }
    let mut answer = vec![f64::from(u8::from(lap.closed))];
    answer.extend(&run.belt_speed);
    answer.extend(run.stretch.iter().map(|stretch| train.stiffness() * stretch));
    Ok(answer)
}
