//! Slip laps of a belt whose drag is a smooth curve, and the drive speed at which they die out.
//!
//! A stuck belt is let go at one pull, whatever its closure: the laps of all closures differ by the pull and the speed
//! at which they begin. A lap that slows to the stick speed sticks; one that speeds up again before has escaped, and
//! as laps do not cross it comes no nearer later. The greatest drive speed at which a lap sticks is `V*`.

use crate::drag::{Closure, Curve, Rest};
use crate::error::{Error, above, at_least};
use crate::motion::Drivetrain;

/// A belt whose drag is a curve, from its stick speed up.
#[derive(Debug, Clone)]
pub struct CurveBelt {
    /// Spring, mass and grip.
    pub train: Drivetrain,
    /// Drag of the contact in steady sliding.
    pub curve: Curve,
    /// Speed `v_s` below which the closure holds.
    pub stick_speed: f64,
    /// What the belt does below it; bristles count as `Stiction`.
    pub closure: Closure,
    /// Force that breaks a belt at rest away, over the drag at the stick speed: `e` in the paper.
    pub static_ratio: f64,
    /// What else moves with the belt.
    pub rest: Rest,
}

/// Where the behaviour of a belt changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveFold {
    /// Speed of least drag.
    pub transition: f64,
    /// `V*`: the greatest drive speed at which the belt goes on to stick; the transition where there is none,
    /// infinite beyond 10,000 times that.
    pub upper: f64,
    /// Pull at which a belt at rest is let go.
    pub holding: f64,
    /// Whether the grip does not let it go.
    pub stalls: bool,
}

/// What becomes of a belt that is started from rest by a step of its drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveStart {
    /// Greatest pull of the spring before the belt slows down for the first time; what holds it if it stalls.
    pub first_peak: f64,
    /// Whether it is never let go.
    pub stalls: bool,
    /// The cycle to which it settles; none if it ends sliding.
    pub cycle: Option<CurveCycle>,
}

/// The cycle of a belt that sticks and slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveCycle {
    /// Duration of a cycle.
    pub period: f64,
    /// Greatest pull of the spring.
    pub pull_max: f64,
    /// Least pull of the spring.
    pub pull_min: f64,
    /// Time in which the belt is held.
    pub stuck: f64,
    /// Rate at which the pull grows while it is held.
    pub slope: f64,
}

/// Steps of one lap after which it is given up.
pub(super) const MOST_STEPS: usize = 20_000;
/// Error of a step, over its state, against the accuracy asked of the fold.
const SHARE: f64 = 0.02;
/// Slowest speed of the curve that is looked at, over the stick speed.
pub(super) const SLOWEST: f64 = 0.02;
/// Speeds below the stick speed, over it, of which the one with the greatest drag of the smooth closure is taken.
const CREEPS: (usize, f64) = (64, 0.004);
/// Relative excess of pull with which a belt leaves the crest of the smooth closure.
const OVER_THE_CREST: f64 = 1e-6;

/// One lap: what became of it, and what was seen on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lap {
    /// Pull with which the belt came to the stick speed; none if it escaped.
    pub sticks: Option<f64>,
    pub duration: f64,
    /// Least and greatest.
    pub pull: (f64, f64),
}

/// Where a lap begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Release {
    pub pull: f64,
    pub speed: f64,
}

pub(super) struct Laps<'a> {
    pub belt: &'a CurveBelt,
    pub accuracy: f64,
    pub tolerance: f64,
    /// Drag of the contact at rest, and how it decays up to the stick speed.
    pub breakaway: f64,
    pub decay: f64,
    transition: f64,
    releases: (Release, Release),
}

impl<'a> Laps<'a> {
    pub(super) fn new(belt: &'a CurveBelt, accuracy: f64) -> Result<Self, Error> {
        Self::under(belt, f64::INFINITY, accuracy)
    }

    /// Laps under a drive of at most this speed, for which a speed of least drag beyond it is as good as another.
    pub(super) fn under(
        belt: &'a CurveBelt,
        drive_speed: f64,
        accuracy: f64,
    ) -> Result<Self, Error> {
        above("stick_speed", belt.stick_speed, 0.0)?;
        above("static_ratio", belt.static_ratio, 1.0)?;
        at_least("rest_force", belt.rest.force, 0.0)?;
        at_least("rest_damping", belt.rest.damping, 0.0)?;
        let sliding = belt.curve.force(belt.stick_speed);
        let least = belt.curve.least_below(belt.stick_speed, belt.rest.damping, drive_speed);
        let breakaway = belt.static_ratio * sliding;
        let at_rest = Release { pull: breakaway + belt.rest.force, speed: 0.0 };
        let kept =
            Release { pull: sliding + belt.rest.at(belt.stick_speed), speed: belt.stick_speed };
        let mut laps = Self {
            belt,
            accuracy,
            tolerance: SHARE * accuracy,
            breakaway,
            decay: belt.static_ratio.ln() / belt.stick_speed,
            transition: least.unwrap_or(drive_speed),
            releases: match belt.closure {
                Closure::Retained => (kept, at_rest),
                _ => (at_rest, at_rest),
            },
        };
        if belt.closure == Closure::Stribeck {
            let crest = laps.crest();
            laps.releases = (crest, crest);
        }
        Ok(laps)
    }

    /// Pull that the drag of a sliding belt balances.
    #[inline]
    pub(super) fn drag(&self, speed: f64, starting: bool) -> f64 {
        let belt = self.belt;
        if speed >= belt.stick_speed || !starting {
            return belt.curve.force(speed.max(SLOWEST * belt.stick_speed)) + belt.rest.at(speed);
        }
        let share = match belt.closure {
            Closure::Stribeck => belt.closure.share(speed / belt.stick_speed),
            _ => 1.0,
        };
        (self.breakaway * (-self.decay * speed).exp() + belt.rest.at(speed)) * share
    }

    /// The crest of the smooth closure, below which a belt creeps.
    fn crest(&self) -> Release {
        let (count, apart) = CREEPS;
        #[allow(clippy::cast_precision_loss)] // they are few
        let speeds = (1..=count).map(|i| apart * i as f64 * self.belt.stick_speed);
        let crest = speeds.map(|speed| Release { pull: self.drag(speed, true), speed });
        let Release { pull, speed } =
            crest.fold(Release { pull: 0.0, speed: 0.0 }, |best, next| {
                if next.pull > best.pull { next } else { best }
            });
        Release { pull: pull * (1.0 + OVER_THE_CREST), speed }
    }

    /// Speed of least drag.
    pub(super) fn transition(&self) -> f64 {
        self.transition
    }

    /// Where the laps of the closure begin, and where the first from rest does.
    pub(super) fn releases(&self) -> (Release, Release) {
        self.releases
    }

    /// The speed that a belt of the paper's rule keeps where it comes to rest with this pull, and its next release.
    pub(super) fn held(&self, pull: f64) -> Release {
        let rest = self.belt.rest;
        let (kept, _) = self.releases();
        if self.belt.closure != Closure::Retained || pull.abs() <= kept.pull {
            return kept;
        }
        // it slows on until A exp(-decay u) + rest bears the pull: Newton's method from the stick speed
        let mut speed = self.belt.stick_speed;
        for _ in 0..40 {
            let contact = self.breakaway * (-self.decay * speed).exp();
            let off = contact + rest.at(speed) - pull.abs();
            let next = speed - off / (rest.damping - self.decay * contact);
            if (next - speed).abs() <= 1e-12 * self.belt.stick_speed {
                break;
            }
            speed = next;
        }
        let speed = speed.clamp(0.0, self.belt.stick_speed);
        Release { pull: pull.abs(), speed }
    }

    /// Whether the belt has too little energy about steady sliding to come down to the speed of least drag ever again:
    /// above it drag rises, and takes energy from the swing.
    pub(super) fn dies_out(&self, speed: f64, drive_speed: f64, pull: f64) -> bool {
        let (k, m) = (self.belt.train.stiffness(), self.belt.train.mass());
        let (ahead, margin) = (speed - drive_speed, drive_speed - self.transition);
        if margin <= 0.0 || ahead.abs() >= margin {
            return false;
        }
        let steady = self.drag(drive_speed, false);
        let off = pull - steady;
        steady < self.belt.train.grip() && ahead * ahead + off * off / (k * m) < margin * margin
    }
}
