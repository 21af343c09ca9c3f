//! The lap that parts the starts which come to slide from those which come to stick.
//!
//! The lap begins where the belt overtakes the drive. How hard the spring then pulls says all of what comes, so a lap
//! maps one pull to the next, and cannot swap two. The pull that comes back to itself, weaker ones coming back weaker
//! and stronger ones stronger, is that of the unstable lap. Where no lap without sticking comes back so, the last one that
//! just slows down to the stick speed parts the starts, if the belt, once it has stuck, goes on to do so.

use crate::drag::Drag;
use crate::error::{Error, above};
use crate::motion::{Drivetrain, Return, Start, System, checked_tolerance, next_return};
use crate::work::Work;

/// Doublings of the swing that are looked at, and its first size over that of a free swing as wide as the drive speed.
const DOUBLINGS: usize = 40;
const SMALLEST: f64 = 1e-3;
/// Share of the swing to which the pull is found, and laps at most.
const FOUND: f64 = 1e-13;
const MOST_LAPS: usize = 200;

/// A lap from where the belt overtakes the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnstableLap {
    /// Where it begins.
    pub start: Start,
    /// How long it is.
    pub duration: f64,
    /// Whether it comes back to where it began; otherwise it is the one that just slows down to the stick speed.
    pub closed: bool,
}

/// Which way the pull goes from lap to lap.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// Down to sliding with the drive, by so much in this lap.
    Falls(f64),
    /// Up, or to sticking; by so much if it slides all the lap.
    Grows(Option<f64>),
}

/// The unstable lap of a belt at a constant drive speed, if there is one: none where all starts lead to one motion.
///
/// # Errors
/// If a value is out of range, the belt cannot be followed, or `work` ends before.
pub fn unstable_lap(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    tolerance: f64,
    work: &Work,
) -> Result<Option<UnstableLap>, Error> {
    checked_tolerance(tolerance)?;
    above("drive_speed", drive_speed, 0.0)?;
    let system = System::at_speed(*train, drag, drive_speed)?;
    let steady = drag.force(drive_speed);
    let lap = |swing: f64, through: bool| {
        next_return(&system, drive_speed, steady + swing, through, tolerance, work)
    };
    let way = |swing: f64| -> Result<Way, Error> {
        Ok(match lap(swing, false)? {
            Return::Dies => Way::Falls(swing),
            Return::Slid(_, pull) if pull - steady < swing => Way::Falls(swing - (pull - steady)),
            Return::Slid(_, pull) => Way::Grows(Some(pull - steady - swing)),
            Return::Stuck(..) | Return::Held => Way::Grows(None),
        })
    };
    let most = train.grip() - steady;
    let Some((mut low, mut high)) = between(train, drive_speed, most, way)? else {
        return Ok(None);
    };
    // false position, and halving where that has no value or closes in from one side only
    for count in 0..MOST_LAPS {
        let middle = 0.5 * (low.0 + high.0);
        if high.0 - low.0 <= FOUND * high.0 || middle <= low.0 || middle >= high.0 {
            break;
        }
        let secant = high.1.map(|rise| low.0 + (high.0 - low.0) * low.1 / (low.1 + rise));
        let swing = secant.filter(|s| count % 3 < 2 && *s > low.0 && *s < high.0).unwrap_or(middle);
        match way(swing)? {
            Way::Falls(fall) => low = (swing, fall),
            Way::Grows(rise) => high = (swing, rise),
        }
    }
    let closed = high.1.is_some();
    // without a closed lap the belt must stick again and again
    if !closed
        && let Return::Stuck(_, pull) = lap(high.0, true)?
        && pull - steady < high.0
    {
        return Ok(None);
    }
    let swing = low.0;
    let Return::Slid(duration, _) = lap(swing, false)? else { return Ok(None) };
    let start = Start { belt_speed: drive_speed, stretch: (steady + swing) / train.stiffness() };
    Ok(Some(UnstableLap { start, duration, closed }))
}

type Bracket = ((f64, f64), (f64, Option<f64>));

/// Two swings, from the smaller of which laps fall and from the larger grow.
fn between(
    train: &Drivetrain,
    drive_speed: f64,
    most: f64,
    way: impl Fn(f64) -> Result<Way, Error>,
) -> Result<Option<Bracket>, Error> {
    let mut swing = SMALLEST * drive_speed * train.impedance();
    let mut falls: Option<(f64, f64)> = None;
    for _ in 0..DOUBLINGS {
        let reached = swing.min(most);
        if reached <= 0.0 {
            return Ok(None);
        }
        match (way(reached)?, falls) {
            (Way::Falls(fall), _) => falls = Some((reached, fall)),
            (Way::Grows(rise), Some(low)) => return Ok(Some((low, (reached, rise)))),
            (Way::Grows(None), None) => return Ok(None),
            (Way::Grows(Some(_)), None) => {}
        }
        if reached >= most {
            return Ok(None);
        }
        swing *= 2.0;
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::Closure;
    use crate::motion::{Integrator, simulate};
    use crate::stability::swings;

    const TOLERANCE: f64 = 1e-11;

    fn belt(closure: Closure) -> (Drivetrain, Drag) {
        let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, closure).unwrap();
        (Drivetrain::new(1000.0, 1.0).unwrap(), drag)
    }

    fn found(belt: &(Drivetrain, Drag), drive_speed: f64) -> Option<UnstableLap> {
        unstable_lap(&belt.0, &belt.1, drive_speed, TOLERANCE, &Work::default()).unwrap()
    }

    #[test]
    fn the_lap_is_the_swing_that_asks_for_its_drive_speed() {
        let belt = belt(Closure::Retained);
        let slowest = [0.05, 0.2, 0.5, 0.66];
        let work = Work::default();
        let swings = swings(&belt.0, &belt.1, &slowest, TOLERANCE, &work).unwrap().unwrap();
        for swing in swings {
            let lap = found(&belt, swing.drive_speed).unwrap();
            let system = System::at_speed(belt.0, &belt.1, swing.drive_speed).unwrap();
            let Start { belt_speed, stretch } = lap.start;
            let run = simulate(
                &system,
                lap.start,
                lap.duration * (1.0 - 1e-12),
                20_001,
                TOLERANCE,
                Integrator::Adaptive,
                &work,
            )
            .unwrap();
            let least = run.belt_speed.iter().copied().fold(f64::INFINITY, f64::min);
            let most = run.belt_speed.iter().copied().fold(0.0, f64::max);
            assert!(lap.closed && (least / swing.slowest - 1.0).abs() < 1e-5, "{least}");
            assert!((most / swing.fastest - 1.0).abs() < 1e-6, "{most}");
            assert!((run.belt_speed[20_000] / belt_speed - 1.0).abs() < 1e-6);
            assert!((run.stretch[20_000] / stretch - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn where_one_motion_is_all_there_is_no_lap() {
        let retained = belt(Closure::Retained);
        assert_eq!([0.9, 2.2, 5.0].map(|w| found(&retained, w)), [None; 3]);
        assert!(found(&retained, 2.17).is_some());
        let closure = Closure::Stiction;
        // released much higher, a belt that sticks goes on to stick though no lap above the stick speed comes back
        assert!(found(&belt(closure), 2.2).is_some_and(|lap| !lap.closed));
        let (train, drag) = retained;
        let slips = (train.with_grip(80.0).unwrap(), drag);
        assert_eq!(found(&slips, 1.5), None);
        let never = Drag::new(50.0, 1.0, -0.7, -0.9, 0.01, closure).unwrap();
        assert_eq!(found(&(train, never), 1.5), None);
    }
}
