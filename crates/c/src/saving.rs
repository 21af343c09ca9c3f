//! A saved instance as bytes, and back: only what is whole, and of the same drive, is taken.

use hersey_core::drag::Mode;

use crate::account::Account;
use crate::description::sum;
use crate::instance::{Discrete, Phase, Saved};
use crate::variables::COUNT;

/// What such bytes begin with; the last is the number of the format.
const BEGIN: [u8; 8] = *b"hersey\0\x02";
/// Words before the numbers of the motion: begin, drive, phase, mode and slip, whether there is a motion.
const HEAD: usize = 5;
/// Numbers of an instance: its values, two slopes, three times, what adds up, what is outside of its range.
const NUMBERS: usize = COUNT + 2 + 3 + Account::NUMBERS + 3;
/// More numbers than a motion has.
const MOST: usize = 1000;
const MODES: [Mode; 4] = [Mode::Ehl, Mode::Mixed, Mode::Microslip, Mode::Stuck];
/// Marks that nothing was shown yet.
const UNSEEN: u64 = 8;

/// Bytes of `saved`, of the drive with the sum `drive`.
pub fn written(saved: &Saved, drive: u64) -> Vec<u8> {
    let seen = saved.seen.map_or(UNSEEN, |seen| seen.mode as u64 + 4 * u64::from(seen.slipping));
    let phase = Phase::ALL.iter().position(|phase| *phase == saved.phase).unwrap_or_default();
    let words =
        [u64::from_le_bytes(BEGIN), drive, phase as u64, seen, u64::from(saved.moment.is_some())];
    let outside = saved.outside.map(|is_outside| f64::from(u8::from(is_outside)));
    let numbers = saved
        .values
        .into_iter()
        .chain(saved.slopes)
        .chain([saved.origin, saved.time, saved.stop])
        .chain(saved.account.numbers())
        .chain(outside);
    let motion = saved.moment.iter().flatten().copied();
    let all = words.into_iter().chain(numbers.chain(motion).map(f64::to_bits));
    let mut bytes: Vec<u8> = all.flat_map(u64::to_le_bytes).collect();
    bytes.extend(sum(&bytes).to_le_bytes());
    bytes
}

/// What `bytes` hold, if they are whole and of the drive with the sum `drive`.
pub fn read(bytes: &[u8], drive: u64) -> Result<Saved, String> {
    let broken = || "these bytes are no saved state of a drive, or not all of one".to_owned();
    let (chunks, rest) = bytes.as_chunks::<8>();
    let words: Vec<u64> =
        chunks.iter().take(MOST).map(|chunk| u64::from_le_bytes(*chunk)).collect();
    let least = HEAD + NUMBERS + 1;
    if !rest.is_empty() || words.len() < least || words[0] != u64::from_le_bytes(BEGIN) {
        return Err(broken());
    }
    let end = bytes.len() - 8;
    if chunks.len() > MOST || words[words.len() - 1] != sum(&bytes[..end]) {
        return Err(broken());
    }
    if words[1] != drive {
        return Err("this state was saved of another drive".to_owned());
    }
    let small = |word: u64| usize::try_from(word).map_err(|_| broken());
    let phase = *Phase::ALL.get(small(words[2])?).ok_or_else(broken)?;
    let seen = match words[3] {
        UNSEEN => None,
        code => Some(Discrete {
            mode: MODES[small(code % 4)?],
            slipping: if code < UNSEEN { code >= 4 } else { return Err(broken()) },
        }),
    };
    let numbers: Vec<f64> =
        words[HEAD..words.len() - 1].iter().map(|bits| f64::from_bits(*bits)).collect();
    let (own, motion) = numbers.split_at(NUMBERS);
    let (values, others) = own.split_at(COUNT);
    let (others, outside) = others.split_at(5 + Account::NUMBERS);
    let sums = others[5..].try_into().map_err(|_| broken())?;
    let outside: [f64; 3] = outside.try_into().map_err(|_| broken())?;
    if !outside.iter().all(|mark| [0.0, 1.0].contains(mark)) {
        return Err(broken());
    }
    let moment = match words[4] {
        0 if motion.is_empty() => None,
        1 => Some(motion.try_into().map_err(|_| broken())?),
        _ => return Err(broken()),
    };
    Ok(Saved {
        phase,
        values: values.try_into().map_err(|_| broken())?,
        slopes: [others[0], others[1]],
        origin: others[2],
        time: others[3],
        stop: others[4],
        seen,
        account: Account::from_numbers(sums).ok_or_else(broken)?,
        outside: outside.map(|mark| mark > 0.5),
        moment,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instance::Instance;
    use crate::samples::WARMED;

    #[test]
    fn bytes_come_back_whole_or_not_at_all() {
        let mut instance = Instance::new(WARMED).unwrap();
        instance.begin(Phase::Step).unwrap();
        instance.advance(0.4, 0.0, false).unwrap();
        let (saved, drive) = (instance.saved(), instance.identity().0);
        let bytes = written(&saved, drive);
        let again = written(&read(&bytes, drive).unwrap(), drive);
        assert_eq!(bytes, again);
        assert!(read(&bytes, drive + 1).unwrap_err().contains("another drive"));
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length], drive).is_err(), "{length}");
        }
        for i in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[i] ^= 0x10;
            assert!(read(&damaged, drive).is_err(), "{i}");
        }
    }

    #[test]
    fn numbers_made_up_do_no_harm() {
        let mut instance = Instance::new(WARMED).unwrap();
        instance.begin(Phase::Step).unwrap();
        instance.advance(0.4, 0.0, false).unwrap();
        let good = instance.saved();
        let drive = instance.identity().0;
        let words = written(&good, drive).len() / 8 - 1;
        for at in HEAD..words {
            for number in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300] {
                let mut bytes = written(&good, drive);
                bytes[8 * at..8 * at + 8].copy_from_slice(&number.to_bits().to_le_bytes());
                let end = bytes.len() - 8;
                let right = sum(&bytes[..end]).to_le_bytes();
                bytes[end..].copy_from_slice(&right);
                let _ = read(&bytes, drive).and_then(|made_up| {
                    instance.restore(&made_up)?;
                    instance.advance(instance.time() + 0.01, 0.0, false)
                });
                instance.restore(&good).unwrap();
            }
        }
        assert_eq!(written(&instance.saved(), drive), written(&good, drive));
    }
}
