//! Changes of mode: which one holds at the start, which guard ends it, and which follows.

use super::event::Guard;
use super::hybrid::Motion;
use super::piece::{Condition, Phase, Piece};
use super::thermal::ThermalFactors;
use crate::drag::{Closure, Mode};

/// Relative difference of belt and roll from which they are as fast as each other.
const MET: f64 = 1e-9;
/// Fall of what holds a belt, over itself and per e-fold of speed, that is none.
const LEVEL: f64 = 1e-6;

impl Motion<'_> {
    /// Bristles of a sliding belt are bent as in steady sliding.
    pub(super) fn bend_bristles(&mut self) {
        if let Closure::LuGre { bristle_stiffness, .. } = self.now.system.drag.closure()
            && self.phase.speed >= self.now.speed(self.now.system.drag.stick_speed())
        {
            let still = self.now.contact_drag(self.phase.speed) + self.now.rest(0.0);
            self.phase.bristle = still / bristle_stiffness;
        }
    }

    /// Whether the roll slips at the start, where the spring pulls as hard as its grip bears, or harder.
    pub(super) fn take_grip(&mut self) {
        self.phase.slipping = false;
        let Some(grip) = self.now.system.grip() else { return };
        let towards = self.phase.pull.signum();
        if towards * self.phase.pull >= grip {
            self.phase.pull = towards * grip;
            let stiffness = self.now.system.train.stiffness();
            let ahead = self.drive_rate()[0] - stiffness * self.phase.speed;
            self.phase.slipping = towards * ahead > 0.0;
        }
    }

    /// Lose or regain the roll's grip on the belt; the mode of the belt stays.
    #[cold]
    fn change_grip(&mut self, lost: bool, crept: bool) -> Mode {
        let towards = self.phase.pull.signum();
        self.phase.pull = towards * self.now.system.train.grip();
        self.phase.slipping = lost;
        if crept {
            return self.still_creeping();
        }
        let (rate, stiffness) = (self.drive_rate()[0], self.now.system.train.stiffness());
        // where the drive has jumped below the belt the two have not met: the pull falls by itself
        let met = self.are_level();
        if !lost && met && self.phase.mode != Mode::Stuck {
            // as fast as the roll to the last bit, or the grip would be lost again at once
            self.phase.speed = rate / stiffness;
            if towards * (rate - stiffness * self.phase.speed) > 0.0 {
                let up = towards > 0.0;
                let speed = self.phase.speed;
                self.phase.speed = if up { speed.next_up() } else { speed.next_down() };
            }
        }
        self.phase.mode
    }

    /// Enter the mode that pull and speed ask for.
    pub(super) fn enter_mode_at_start(&mut self) {
        let drag = &self.now.system.drag;
        let Phase { pull, speed, .. } = self.phase;
        let v_s = self.now.speed(drag.stick_speed());
        if speed < v_s {
            if drag.closure() == Closure::Stiction {
                self.phase.mode = self.mode_below_stick_speed();
            } else {
                let held =
                    !drag.closure().is_smooth() && pull.abs() <= self.now.holding_force(speed);
                self.phase.mode = if held { Mode::Stuck } else { Mode::Microslip };
            }
            return;
        }
        // on a boundary the motion itself says which side it belongs to: m u' and, where that is nil, u''
        let net_force = pull - self.now.steady_drag(speed);
        let onward = self.rate()[0] - self.stiffness() * speed;
        let rising = net_force > 0.0 || (net_force == 0.0 && onward >= 0.0);
        let x = self.now.at_reference(speed);
        let mut branch = self.now.sliding_branch(speed);
        if !rising && branch > 0 && drag.upper_knot(branch - 1) == Some(x) && x > drag.stick_speed()
        {
            branch -= 1;
        }
        self.phase.branch = branch;
        self.phase.mode = if rising || speed > v_s {
            drag.branch_mode(branch)
        } else {
            self.mode_below_stick_speed()
        };
    }

    /// Enter the mode that pull and speed ask for, where the law or the pull has jumped: a held belt stays so if it can.
    #[cold]
    pub(super) fn enter_mode_after_jump(&mut self) {
        (self.phase.released, self.phase.creeping) = (false, false);
        self.next_step = f64::INFINITY;
        let Phase { mode: from, pull, speed, .. } = self.phase;
        if from == Mode::Stuck {
            if pull.abs() <= self.holding_force() {
                return;
            }
            self.phase.strength = self.strength_now();
            if speed == 0.0 && pull < 0.0 {
                self.mirror();
            }
        }
        let slow = speed < self.now.speed(self.now.system.drag.stick_speed());
        let closure = self.now.system.drag.closure();
        if slow && closure != Closure::Stiction && !closure.is_smooth() {
            // what holds it is its own drag, which a rest before has made larger
            let held = from != Mode::Stuck && pull.abs() <= self.microslip_drag();
            self.phase.mode = if held { Mode::Stuck } else { Mode::Microslip };
        } else {
            self.enter_mode_at_start();
        }
        if self.phase.mode != Mode::Microslip {
            self.phase.strength = 1.0;
        }
        if self.phase.mode == Mode::Stuck {
            self.phase.at_rest_since = self.now.time;
        }
    }

    /// Drag of a belt that is slower than the stick speed.
    fn microslip_drag(&self) -> f64 {
        let Phase { speed, strength, .. } = self.phase;
        let x = self.now.at_reference(speed);
        let contact = self.now.system.drag.strengthened_below(x, strength).0;
        self.now.force_below(contact) + self.now.rest(speed)
    }

    /// Mode of a belt that has slowed to the stick speed; with `Stiction` it stops dead if it can be held.
    fn mode_below_stick_speed(&mut self) -> Mode {
        let drag = &self.now.system.drag;
        let closure = drag.closure();
        let holding = self.now.holding_force(self.now.speed(drag.stick_speed()));
        if closure.is_smooth() || self.phase.pull.abs() > holding {
            return Mode::Microslip;
        }
        if closure == Closure::Stiction {
            self.stop_dead();
        }
        Mode::Stuck
    }

    fn stop_dead(&mut self) {
        let lost = 0.5 * self.now.system.train.mass() * self.phase.speed * self.phase.speed;
        self.stopped += lost;
        if let Some(heat) = &mut self.now.heat {
            heat.take(lost);
        }
        self.phase.speed = 0.0;
    }

    /// Enter the mode behind `guard`, on it exactly.
    pub(super) fn cross(&mut self, guard: Guard) {
        let crept = self.phase.creeping;
        (self.phase.released, self.phase.creeping) = (false, false);
        if !matches!(guard, Guard::GripLost | Guard::GripRegained) {
            self.phase.strength = 1.0;
        }
        self.next_step = f64::INFINITY;
        self.phase.mode = match (guard, self.phase.mode) {
            (Guard::TransitionSpeed | Guard::TablePoint, _) => self.over_knot(),
            (Guard::StickSpeed, from) => self.over_stick_speed(from),
            (Guard::HoldingForce, Mode::Stuck) => self.released(),
            (Guard::HoldingForce, _) if crept => self.held_again(),
            (Guard::HoldingForce, _) => self.caught(),
            (Guard::Reversal, _) => self.turned(crept),
            (Guard::GripLost, _) => self.change_grip(true, crept),
            (Guard::GripRegained, _) => self.change_grip(false, crept),
        };
    }

    /// Onto the next branch of the law.
    fn over_knot(&mut self) -> Mode {
        let drag = &self.now.system.drag;
        if self.now.transition_moves() {
            self.phase.branch = 1 - self.phase.branch; // it lies where the piece has found it
            return drag.branch_mode(self.phase.branch);
        }
        let x = self.now.at_reference(self.phase.speed);
        let above = drag.upper_knot(self.phase.branch);
        let below = drag.lower_knot(self.phase.branch);
        // the knot that was reached is the nearer one
        let up = match (above, below) {
            (Some(a), Some(b)) => (a - x).abs() <= (x - b).abs(),
            (above, _) => above.is_some(),
        };
        let knot = if up { above } else { below };
        self.phase.speed = self.now.speed(knot.unwrap_or(x));
        self.phase.branch = if up { self.phase.branch + 1 } else { self.phase.branch - 1 };
        drag.branch_mode(self.phase.branch)
    }

    /// Past the stick speed, up out of the microslip or down from sliding.
    fn over_stick_speed(&mut self, from: Mode) -> Mode {
        let drag = &self.now.system.drag;
        self.phase.speed = self.now.speed(drag.stick_speed());
        if from != Mode::Microslip {
            return self.mode_below_stick_speed();
        }
        self.phase.branch = drag.branch(drag.stick_speed());
        drag.branch_mode(self.phase.branch)
    }

    /// Held by just what it is pulled with.
    fn caught(&mut self) -> Mode {
        self.phase.pull = self.now.holding_force(self.phase.speed).copysign(self.phase.pull);
        if self.now.system.drag.closure() == Closure::Stiction {
            self.stop_dead();
        }
        Mode::Stuck
    }

    /// The backward pull falls short of what holds a belt that crept: both are equal now.
    fn held_again(&mut self) -> Mode {
        self.follow_creep();
        self.phase.released = true;
        Mode::Stuck
    }

    /// A belt that creeps goes on to, unless nothing moves what holds it while the roll slips.
    fn still_creeping(&mut self) -> Mode {
        if self.phase.slipping && self.now.thermal.is_none() {
            return self.held_again();
        }
        self.phase.creeping = true;
        Mode::Microslip
    }

    /// The speed at which the backward pull is just the holding force, which the series meets but for its tolerance.
    fn follow_creep(&mut self) {
        for _ in 0..2 {
            let speed = self.phase.speed;
            let slope = self.now.holding_slope(self.now.held_branch(speed, false), speed);
            let next = speed - (self.now.holding_force(speed) + self.phase.pull) / slope;
            if next > 0.5 * speed && next < 2.0 * speed {
                self.phase.speed = next;
            }
        }
    }

    /// Creep on, but where the law has left the belt at a speed at which what holds it does not fall: there it slides.
    pub(super) fn creep_on(&mut self) {
        self.follow_creep();
        let Phase { speed, pull, .. } = self.phase;
        let branch = self.creep_branch();
        let scale = speed.max(self.now.speed(self.now.system.drag.stick_speed()));
        if self.now.holding_slope(branch, speed) * scale <= -LEVEL * pull.abs() {
            return;
        }
        self.phase.creeping = false;
        if branch.is_some() && self.now.held_branch(speed, false).is_none() {
            self.phase.mode = self.held_again(); // the stick speed passes below it, where the law rises
        } else if branch.is_some() {
            let branch = self.now.sliding_branch(speed);
            self.phase.branch = branch;
            self.phase.mode = self.now.system.drag.branch_mode(branch);
        }
    }

    /// At rest for an instant: held there, or off the other way.
    fn turned(&mut self, crept: bool) -> Mode {
        self.phase.speed = 0.0;
        if crept {
            return self.released();
        }
        let held = self.now.system.drag.closure() == Closure::Stiction
            && self.phase.pull.abs() <= self.now.holding_force(0.0);
        if held {
            return Mode::Stuck;
        }
        self.mirror();
        Mode::Microslip
    }

    /// Leave the stuck phase with the spring force exactly at the holding force, unless it was beyond it at once.
    fn released(&mut self) -> Mode {
        let drag = &self.now.system.drag;
        self.phase.strength = self.strength_now();
        let holding = self.holding_force();
        // the heat of a belt that stopped dead has weakened what holds it: to lower the pull would lose the spring's energy
        let is_pulled_harder =
            self.phase.speed == 0.0 && self.phase.pull.abs() > holding * (1.0 + self.tolerance);
        if !is_pulled_harder {
            self.phase.pull = holding.copysign(self.phase.pull);
        }
        let forward = self.phase.pull > 0.0;
        if self.phase.speed == 0.0 && !forward {
            self.mirror();
        }
        self.phase.creeping = self.phase.speed > 0.0 && !forward;
        self.phase.released = !self.phase.creeping && !is_pulled_harder;
        if forward && self.phase.speed >= self.now.speed(drag.stick_speed()) {
            self.phase.branch = self.now.sliding_branch(self.phase.speed);
            drag.branch_mode(self.phase.branch)
        } else {
            Mode::Microslip
        }
    }

    fn mirror(&mut self) {
        self.phase.direction = -self.phase.direction;
        self.phase.pull = -self.phase.pull;
        self.phase.bristle = -self.phase.bristle;
    }

    /// The guard that the piece crosses first, if it crosses any.
    pub(super) fn first_guard(&self, piece: &Piece) -> Option<(f64, Guard)> {
        if piece.duration.is_infinite() {
            return None;
        }
        let mut watch = Watch::over(piece, self.now.thermal.as_ref());
        let drag = &self.now.system.drag;
        if let Some(grip) = self.now.system.grip() {
            if self.phase.slipping {
                let (mut rate, stiffness) = (self.drive_rate(), self.now.system.train.stiffness());
                if self.are_level() {
                    rate[0] = stiffness * self.phase.speed; // rounding must not say who is ahead
                }
                watch.look(Condition::Ahead(rate, stiffness), Guard::GripRegained);
            } else if piece.pull_range().is_none_or(|(low, high)| !(low > -grip && high < grip)) {
                // where roll and belt have just met the pull leaves that limit, whatever rounding says
                let forward = self.phase.pull > 0.0;
                let met = self.has_just_met(grip) && !piece.pulls_harder();
                if !(met && forward) {
                    watch.look(Condition::GripsForward(grip), Guard::GripLost);
                }
                if !met || forward {
                    watch.look(Condition::GripsBack(grip), Guard::GripLost);
                }
            }
        }
        match self.phase.mode {
            // pull and holding force stay as they are
            Mode::Stuck if self.phase.slipping && self.now.thermal.is_none() => {}
            Mode::Stuck => {
                watch.look(Condition::HeldForward, Guard::HoldingForce);
                watch.look(Condition::HeldBack, Guard::HoldingForce);
            }
            Mode::Microslip if self.phase.creeping => {
                watch.look(Condition::Slowing, Guard::HoldingForce);
                watch.look(Condition::Faster(0.0), Guard::Reversal);
            }
            Mode::Microslip => {
                watch.look(Condition::Slower(drag.stick_speed()), Guard::StickSpeed);
                match drag.closure() {
                    Closure::Retained => watch.look(Condition::Overcome, Guard::HoldingForce),
                    Closure::Stiction => {
                        let holding = Condition::Pulled(drag.breakaway_force(), drag.rest().force);
                        watch.look(holding, Guard::HoldingForce);
                    }
                    Closure::Stribeck | Closure::LuGre { .. } => {}
                }
                watch.look(Condition::Faster(0.0), Guard::Reversal);
            }
            Mode::Ehl | Mode::Mixed => self.watch_branch(&mut watch),
        }
        watch.first
    }

    /// Whether roll and belt have just met: the pull is that of the grip, and rounding says whether it grows or falls.
    fn has_just_met(&self, grip: f64) -> bool {
        self.phase.pull.abs() >= grip && self.are_level()
    }

    /// Whether belt and roll are as fast as each other, but for rounding.
    fn are_level(&self) -> bool {
        let (rate, train) = (self.drive_rate(), &self.now.system.train);
        let slow = train.stiffness() * self.now.speed(self.now.system.drag.stick_speed());
        let scale = rate[0].abs() + rate[1].abs() * train.time_scale() + slow;
        (rate[0] - train.stiffness() * self.phase.speed).abs() <= MET * scale
    }

    /// Watch the ends of the branch of the law.
    #[inline]
    fn watch_branch(&self, watch: &mut Watch) {
        let (drag, branch) = (&self.now.system.drag, self.phase.branch);
        if self.now.transition_moves() {
            let sign = if branch == 0 { -1.0 } else { 1.0 };
            watch.look(Condition::Beyond(sign), Guard::TransitionSpeed);
            return watch.look(Condition::Faster(drag.stick_speed()), Guard::StickSpeed);
        }
        let named = |is_transition: bool| {
            if is_transition { Guard::TransitionSpeed } else { Guard::TablePoint }
        };
        if let Some(knot) = drag.upper_knot(branch) {
            watch.look(Condition::Slower(knot), named(drag.is_transition(branch)));
        }
        match drag.lower_knot(branch) {
            Some(knot) => {
                watch.look(Condition::Faster(knot), named(drag.is_transition(branch - 1)));
            }
            None => watch.look(Condition::Faster(drag.stick_speed()), Guard::StickSpeed),
        }
    }
}

/// The earliest guard met along a piece.
struct Watch<'p> {
    piece: &'p Piece<'p>,
    thermal: Option<&'p ThermalFactors>,
    /// Speeds on the piece, where they are known at once.
    range: Option<(f64, f64)>,
    first: Option<(f64, Guard)>,
}

impl<'p> Watch<'p> {
    fn over(piece: &'p Piece<'p>, thermal: Option<&'p ThermalFactors>) -> Self {
        let range = if thermal.is_none() { piece.speed_range() } else { None };
        Self { piece, thermal, range, first: None }
    }

    /// See whether `condition`, under which the mode goes on, ends on the piece, and before the others do.
    fn look(&mut self, condition: Condition, guard: Guard) {
        if self.range.is_some_and(|range| condition.holds_over(range)) {
            return;
        }
        if let Some(elapsed) = self.piece.end_of(condition, self.thermal)
            && self.first.is_none_or(|(earliest, _)| elapsed < earliest)
        {
            self.first = Some((elapsed, guard));
        }
    }
}
