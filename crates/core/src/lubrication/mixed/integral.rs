//! The integral of J. A. Greenwood and J. H. Tripp (Proc. Inst. Mech. Engrs 185 (1970) 625),
//! `F(l) = int_l^inf (z-l)^(5/2) exp(-z^2/2) dz/sqrt(2 pi)`.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Square of the step, exact, and number of nodes of the trapezoid rule: the aliases of the integrand and its tail
/// are below 1e-16 of the sum for lambda up to 25, below 1e-10 where the exponential underflows.
const SQUARE: f64 = 1.0 / 128.0;
const NODES: usize = 36;
/// Nodes from one exponential to the next; those between follow by products, which would lose digits over more.
const BLOCK: usize = 6;
/// Lambda beyond which no asperity touches, to the last number that a float can hold.
pub(super) const FAR: f64 = 39.0;

/// (t^2, weight) of each node but that at 0, where the integrand is nil.
static RULE: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| {
    let front = 2.0 * (SQUARE / (2.0 * PI)).sqrt();
    let mut node = 0.0;
    std::array::from_fn(|_| {
        node += 1.0;
        let square = SQUARE * node * node;
        (square, front * square.powi(2) * (-0.5 * square.powi(2)).exp())
    })
});

/// Greenwood and Tripp's integral F(lambda) and its derivative, lambda from 0 on.
///
/// With `z = lambda + t^2` it is `exp(-lambda^2/2)/sqrt(2 pi)` times the integral over all t of the even, entire
/// `t^6 exp(-lambda t^2 - t^4/2)`, which the trapezoid rule takes to rounding; its derivative has `-5/2 t^4`.
/// `F'' + lambda F' - 5/2 F = 0`.
#[must_use]
pub fn asperity_integral(lambda: f64) -> (f64, f64) {
    let (front, fourth, sixth) = moments(lambda.clamp(0.0, FAR));
    (front * sixth, -2.5 * front * fourth)
}

/// F(lambda) and its steepness `-d ln F/d ln lambda`, which keeps its digits where F underflows.
pub(super) fn steepness(lambda: f64) -> (f64, f64) {
    let lambda = lambda.clamp(0.0, FAR);
    let (front, fourth, sixth) = moments(lambda);
    (front * sixth, 2.5 * lambda * fourth / sixth)
}

/// First and second derivative of the steepness by ln lambda, from the equation of F.
pub(super) fn steepening(lambda: f64, steepness: f64) -> (f64, f64) {
    let square = lambda * lambda;
    let first = steepness * (1.0 + steepness - square) - 2.5 * square;
    let second = first * (1.0 + 2.0 * steepness - square) - square * (2.0 * steepness + 5.0);
    (first, second)
}

/// The factor `exp(-lambda^2/2)`, and the sums of the fourth and sixth power of t.
fn moments(lambda: f64) -> (f64, f64, f64) {
    let (mut fourth, mut sixth) = (0.0, 0.0);
    // The ratio of exp(-lambda t^2) at a node to that before it falls by the same factor from node to node.
    let factor = (-2.0 * SQUARE * lambda).exp();
    for block in RULE.chunks_exact(BLOCK) {
        let mut decay = (-lambda * block[0].0).exp();
        let mut ratio = (-lambda * (block[1].0 - block[0].0)).exp();
        for (square, weight) in block {
            fourth += weight * decay;
            sixth += weight * decay * square;
            decay *= ratio;
            ratio *= factor;
        }
    }
    ((-0.5 * lambda * lambda).exp(), fourth, sixth)
}
