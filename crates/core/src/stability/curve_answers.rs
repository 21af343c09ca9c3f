//! Belts on a curve that ask for lap after lap until they know what they want, many at once.

use super::curve_lanes::{CurveLanes, LANES, met};
use super::curve_laps::{Lap, Laps, MOST_STEPS, Release};
use crate::error::Error;
use crate::work::Work;

/// A belt that asks for lap after lap.
pub(super) trait Asks {
    /// What it wants to know.
    type Answer;
    /// The belt.
    fn laps(&self) -> &Laps<'_>;
    /// What it asks for first.
    fn first(&mut self) -> Next<Self::Answer>;
    /// What it makes of the lap that it asked for.
    fn take(&mut self, lap: Lap) -> Next<Self::Answer>;
}

/// A lap, by its drive speed and where it begins, or what comes of those before.
pub(super) enum Next<T> {
    Lap(f64, Release),
    Answer(T),
}

/// What each of the belts comes to; what `work` allows is for each of them.
///
/// # Errors
/// If `work` is stopped.
pub(super) fn answers<A: Asks>(
    asking: impl Iterator<Item = Result<A, Error>>,
    work: &Work,
) -> Result<Vec<Result<A::Answer, Error>>, Error> {
    let (arch, watched) = (pulp::Arch::new(), work.apart(u64::MAX));
    let (mut lanes, mut found) = (CurveLanes::idle(), Vec::new());
    let mut riders: [Option<Rider<A>>; LANES] = std::array::from_fn(|_| None);
    let mut waiting = asking.enumerate();
    loop {
        for (l, seat) in riders.iter_mut().enumerate().filter(|(_, seat)| seat.is_none()) {
            *seat = waiting.find_map(|(index, each)| {
                found.push(None);
                let rider = each.map(|asks| Rider { index, asks, steps: 0, done: 0 });
                let begun = rider.map(|mut rider| (rider.asks.first(), rider));
                match begun {
                    Ok((Next::Lap(drive_speed, release), rider)) => {
                        lanes.board(l, rider.asks.laps());
                        lanes.begin(l, rider.asks.laps(), drive_speed, release);
                        return Some(rider);
                    }
                    Ok((Next::Answer(answer), _)) => found[index] = Some(Ok(answer)),
                    Err(error) => found[index] = Some(Err(error)),
                }
                None
            });
        }
        if riders.iter().all(Option::is_none) {
            return Ok(found.into_iter().flatten().collect());
        }
        watched.take(1)?;
        arch.dispatch(LapStep(&mut lanes));
        for (l, seat) in riders.iter_mut().enumerate() {
            if let Some(answer) = seat.as_mut().and_then(|rider| rider.follow(&mut lanes, l, work))
            {
                found[seat.take().map_or(0, |rider| rider.index)] = Some(answer);
            }
        }
    }
}

/// A belt on its lane.
struct Rider<A> {
    index: usize,
    asks: A,
    /// Steps of this lap, and of those before.
    steps: usize,
    done: u64,
}

impl<A: Asks> Rider<A> {
    /// What the belt comes to, if that is known after a step of its lane.
    fn follow(
        &mut self,
        lanes: &mut CurveLanes,
        l: usize,
        work: &Work,
    ) -> Option<Result<A::Answer, Error>> {
        (self.steps, self.done) = (self.steps + 1, self.done + 1);
        let met = lanes.met[l];
        let goes_on = met == met::NONE;
        if met == met::LOST || (goes_on && self.steps >= MOST_STEPS) || self.done > work.allowed() {
            return Some(Err(Error::WorkSpent { steps: work.allowed() }));
        }
        if goes_on {
            return None;
        }
        match self.asks.take(lanes.lap(l)) {
            Next::Answer(answer) => Some(Ok(answer)),
            Next::Lap(drive_speed, release) => {
                lanes.begin(l, self.asks.laps(), drive_speed, release);
                self.steps = 0;
                None
            }
        }
    }
}

/// One step of every lane, as work for the best instruction set.
struct LapStep<'a>(&'a mut CurveLanes);

impl pulp::WithSimd for LapStep<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)] // all of a step is compiled for the instruction set it is dispatched to
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.0.step();
    }
}
