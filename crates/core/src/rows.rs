//! Logarithms and exponentials of several numbers at once, with the same bits by every instruction set.
//!
//! Loops over arrays, which are compiled to registers where their caller is dispatched to an instruction set. Errors stay
//! below two units of the last place. The logarithm is that of FreeBSD's `e_log.c` (Sun Microsystems, 1993).

/// `a b + c` rounded once, which is one instruction on all machines but the web's.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn fused(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_arch = "wasm32") { a * b + c } else { a.mul_add(b, c) }
}

/// ln 2 in two parts, of which the first has a few bits to spare.
const LN_2: (f64, f64) = (6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10);
/// Bits of one, and what takes the square root of a half there.
const ONE: u64 = 0x3ff0_0000_0000_0000;
const FROM_ROOT: u64 = ONE - 0x3fe6_a09e_667f_3bcd;
/// Bits of a fraction.
const FRACTION: u32 = 52;
/// Bits of 2^52, whose last bits are its ones, and it with the offset of an exponent.
const WHOLE: u64 = 0x4330_0000_0000_0000;
const OFFSET: f64 = 4_503_599_627_370_496.0 + 1023.0;
/// Half as much again as 2^52: what is added to it is rounded to a whole number.
const ROUNDS: f64 = 6_755_399_441_055_744.0;
/// Logarithm beyond which a power is not looked at.
const FARTHEST: f64 = 700.0;

/// `ln((1 + s)/(1 - s))/s - 2`, by powers of `s^2` from the first on.
const SERIES: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];

/// One over each factorial.
#[allow(clippy::cast_precision_loss)] // small
const INVERSE: [f64; 14] = {
    let (mut inverse, mut factorial, mut i) = ([1.0; 14], 1.0, 1);
    while i < 14 {
        factorial *= i as f64;
        inverse[i] = 1.0 / factorial;
        i += 1;
    }
    inverse
};

/// `ln x` of normal numbers above zero.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn logarithms<const N: usize>(x: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for l in 0..N {
        // x = 2^k (1 + f), 1 + f from the root of a half to that of two
        let exponent = x[l].to_bits().wrapping_add(FROM_ROOT) >> FRACTION;
        let mantissa = x[l].to_bits().wrapping_sub(exponent << FRACTION).wrapping_add(ONE);
        let k = f64::from_bits(exponent | WHOLE) - OFFSET;
        let f = f64::from_bits(mantissa) - 1.0;
        let s = f / (2.0 + f);
        let square = s * s;
        let fourth = square * square;
        let [a, b, c, d, e, g, h] = SERIES;
        let odd = fused(fourth, fused(fourth, fused(fourth, h, e), c), a) * square;
        let even = fused(fourth, fused(fourth, g, d), b) * fourth;
        let half = 0.5 * f * f;
        let small = fused(s, half + (odd + even), k * LN_2.1) - half;
        out[l] = fused(k, LN_2.0, small + f);
    }
    out
}

/// `exp x`, as of 700 beyond that, either way.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn exponentials<const N: usize>(x: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for l in 0..N {
        let most = if x[l] < FARTHEST { x[l] } else { FARTHEST };
        let x = if most > -FARTHEST { most } else { -FARTHEST };
        let rounded = fused(x, std::f64::consts::LOG2_E, ROUNDS);
        let k = rounded - ROUNDS;
        let r = fused(-k, LN_2.1, fused(-k, LN_2.0, x));
        let square = r * r;
        let (mut even, mut odd) = (INVERSE[12], INVERSE[13]);
        for n in (1..6).rev() {
            even = fused(even, square, INVERSE[2 * n]);
            odd = fused(odd, square, INVERSE[2 * n + 1]);
        }
        // exp r - 1 = r + r^2 (even + r odd)', added to one at the end
        let tail = fused(r, odd, even);
        let power = 1.0 + fused(square, tail, r);
        out[l] = f64::from_bits(power.to_bits().wrapping_add(rounded.to_bits() << FRACTION));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_and_exponentials_are_those_of_the_system_but_for_the_last_bits() {
        for i in 0..20_000 {
            let x = -650.0 + 0.065 * f64::from(i);
            let [power] = exponentials(&[x]);
            assert!((power / x.exp() - 1.0).abs() <= 4.5e-16, "{x}");
            let number = x.exp() * (1.0 + 1e-3 * f64::from(i % 997));
            let [log] = logarithms(&[number]);
            let off = (log - number.ln()).abs();
            assert!(off <= 4.5e-16 * number.ln().abs(), "{number}");
        }
    }

    #[test]
    fn near_one_no_digit_is_lost() {
        for i in 1..1000 {
            let x = 1.0 + 1e-6 * f64::from(i) * if i % 2 == 0 { 1.0 } else { -1.0 };
            let [log] = logarithms(&[x]);
            assert!((log - x.ln()).abs() <= 4.5e-16 * x.ln().abs(), "{x}");
        }
        let bits = |row: [f64; 2]| row.map(f64::to_bits);
        assert_eq!(bits(logarithms(&[1.0; 2])), bits([0.0; 2]));
        assert_eq!(bits(exponentials(&[0.0, 1e9])), bits([1.0, exponentials(&[700.0])[0]]));
    }
}
