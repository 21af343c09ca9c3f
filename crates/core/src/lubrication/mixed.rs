//! Mixed lubrication of a sliding line contact: the film and the asperities share the load.
//!
//! Everything hangs on `x = eta v`, the product of viscosity and speed, taken as `X = x/reference`, and on lambda,
//! the film over the composite rms roughness:
//!
//! - alone and flooded the film would be `lambda_free = X^n`;
//! - asperities carry the share `s = stiffness F(lambda)` of the load, with the integral of J. A. Greenwood and
//!   J. H. Tripp (Proc. Inst. Mech. Engrs 185 (1970) 625), `F(l) = int_l^inf (z-l)^(5/2) exp(-z^2/2) dz/sqrt(2 pi)`;
//! - the film carries the rest and is thicker for it, `lambda = lambda_free (1 - s)^(-b)` (K. L. Johnson,
//!   J. A. Greenwood and S. Y. Poon, Wear 19 (1972) 91; E. R. M. Gelinck and D. J. Schipper, Tribol. Int. 33
//!   (2000) 175);
//! - force `boundary s + shear X/lambda + rolling X^r (1 - s)`.
//!
//! With the share of the film `c = (lambda_free/lambda)^(1/b)` the first three lines are one,
//! `stiffness F(lambda) + c(lambda) = 1`. Both terms fall with lambda and are convex, so Newton's method from
//! below climbs to the one root without a bracket.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::error::{Error, above, at_least, at_most, finite};

/// Square of the step, exact, and number of nodes of the trapezoid rule: the aliases of the integrand and its tail
/// are below 1e-16 of the sum for lambda up to 25, below 1e-10 where the exponential underflows.
const SQUARE: f64 = 1.0 / 128.0;
const NODES: usize = 36;
/// Nodes from one exponential to the next; those between follow by products, which would lose digits over more.
const BLOCK: usize = 6;
/// Lambda beyond which no asperity touches, to the last number that a float can hold.
const FAR: f64 = 39.0;
/// The largest stiffness: asperities that carry the load at lambda = 11.
const STIFFEST: f64 = 1e30;
/// `X` beyond which the laws of the film have long ended, and its inverse, which is rest: every term stays finite.
const LARGEST: f64 = 1e100;

/// Mean pressure of two rough faces over `(sigma beta D)^2 sqrt(sigma/beta) E* F(lambda)`, `16 sqrt(2) pi/15`: D summits
/// per area and of radius beta on each, E* the contact modulus of the faces. Two summits meet as spheres of radius
/// beta/2, aside by any distance.
pub const GREENWOOD_TRIPP: f64 = 16.0 * std::f64::consts::SQRT_2 * PI / 15.0;

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
    let lambda = lambda.clamp(0.0, FAR);
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
    let front = (-0.5 * lambda * lambda).exp();
    (front * sixth, -2.5 * front * fourth)
}

/// The numbers of a contact that shares its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// Product of viscosity and speed at which the film alone is as thick as the composite roughness, Pa m.
    pub reference: f64,
    /// n: exponent of film thickness in viscosity times speed.
    pub film_exponent: f64,
    /// b: film thickness goes as load to the power -b.
    pub load_exponent: f64,
    /// Share of the load that asperities carry, over F(lambda): their pressure over the mean pressure.
    pub stiffness: f64,
    /// Force where asperities carry all: boundary friction times load, N.
    pub boundary: f64,
    /// Force that shears a film of lambda = 1 at the reference, N.
    pub shear: f64,
    /// Force of the rolling (Poiseuille) part at the reference where the film carries all, N; may be 0.
    pub rolling: f64,
    /// Exponent of that force in viscosity times speed.
    pub rolling_exponent: f64,
}

impl Sharing {
    /// The names of the numbers, in the order of the fields.
    pub const NAMES: [&str; 8] = [
        "reference",
        "film_exponent",
        "load_exponent",
        "stiffness",
        "boundary",
        "shear",
        "rolling",
        "rolling_exponent",
    ];

    fn each(&mut self) -> [&mut f64; 8] {
        [
            &mut self.reference,
            &mut self.film_exponent,
            &mut self.load_exponent,
            &mut self.stiffness,
            &mut self.boundary,
            &mut self.shear,
            &mut self.rolling,
            &mut self.rolling_exponent,
        ]
    }

    fn asperities(&self, lambda: f64) -> (f64, f64) {
        let (integral, slope) = asperity_integral(lambda);
        (self.stiffness * integral, self.stiffness * slope)
    }

    /// `X` at a lambda, from the share of the asperities.
    fn product(&self, lambda: f64, share: f64) -> f64 {
        (lambda * (1.0 - share).powf(self.load_exponent)).powf(1.0 / self.film_exponent)
    }

    /// `d force/d ln X` at a lambda, which the transition nils.
    fn rise(&self, lambda: f64) -> f64 {
        let (share, slope) = self.asperities(lambda);
        let film = 1.0 - share;
        let steep = -slope * lambda;
        let growth = self.film_exponent * film / (film + self.load_exponent * steep);
        let product = self.product(lambda, share);
        let rolled = self.rolling * product.powf(self.rolling_exponent);
        self.shear * product / lambda * (1.0 - growth) - self.boundary * steep * growth
            + rolled * (self.rolling_exponent * film + steep * growth)
    }
}

/// The contact at one product of viscosity and speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shared {
    /// Film over roughness.
    pub lambda: f64,
    /// Share of the load that asperities carry.
    pub share: f64,
    /// Force of the asperities, N.
    pub boundary: f64,
    /// Force that shears the film, N.
    pub shear: f64,
    /// Force of the rolling part, N.
    pub rolling: f64,
    /// Derivative of the force by the product of viscosity and speed, N/(Pa m).
    pub slope: f64,
}

impl Shared {
    /// The whole force, N.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.boundary + self.shear + self.rolling
    }
}

/// The transition: where the force, falling with speed, begins to rise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    /// Product of viscosity and speed, Pa m.
    pub product: f64,
    /// Film over roughness.
    pub lambda: f64,
    /// The least force, N.
    pub force: f64,
    /// `d ln product/d ln` of each number of `Sharing`, in the order of its names.
    pub sensitivity: [f64; 8],
}

/// The force of a mixed contact against viscosity times speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixedLaw {
    sharing: Sharing,
    dry: f64,
}

impl MixedLaw {
    /// The law of some numbers.
    ///
    /// # Errors
    /// If a number is out of range: reference, boundary and shear above 0, `0.01 <= b <= n`, `0.1 <= n <= 1`, rolling not
    /// negative, its exponent from 0 to 2, and a stiffness at which asperities carry the load before the mean
    /// planes meet, `stiffness F(0) > 1`.
    pub fn new(sharing: Sharing) -> Result<Self, Error> {
        above("reference of the film", sharing.reference, 0.0)?;
        at_most("film exponent", at_least("film exponent", sharing.film_exponent, 0.1)?, 1.0)?;
        let load = at_least("load exponent", sharing.load_exponent, 0.01)?;
        at_most("load exponent", load, sharing.film_exponent)?;
        above("stiffness of the asperities", sharing.stiffness, 1.0 / asperity_integral(0.0).0)?;
        at_most("stiffness of the asperities", sharing.stiffness, STIFFEST)?;
        above("boundary force", sharing.boundary, 0.0)?;
        above("shear force", sharing.shear, 0.0)?;
        at_least("rolling force", sharing.rolling, 0.0)?;
        at_least("rolling exponent", sharing.rolling_exponent, 0.0)?;
        at_most("rolling exponent", sharing.rolling_exponent, 2.0)?;
        finite("force", sharing.boundary + sharing.shear + sharing.rolling)?;
        // ln(stiffness F) is concave and falls: Newton's method comes down to its root from beyond it.
        let mut dry = 0.0;
        for _ in 0..60 {
            let (share, slope) = sharing.asperities(dry);
            let next = (dry - share * share.ln() / slope).clamp(0.0, 30.0);
            let done = (next - dry).abs() <= 2.0 * f64::EPSILON * next;
            dry = next;
            if done {
                break;
            }
        }
        Ok(Self { sharing, dry })
    }

    /// The same law with forces `factor` times as large, and boundary friction `boundary` times more.
    #[must_use]
    pub(crate) fn with_forces(mut self, factor: f64, boundary: f64) -> Self {
        self.sharing.boundary *= factor * boundary;
        self.sharing.shear *= factor;
        self.sharing.rolling *= factor;
        self
    }

    /// The numbers.
    #[must_use]
    pub fn sharing(&self) -> Sharing {
        self.sharing
    }

    /// Lambda at rest, where asperities carry all.
    #[must_use]
    pub fn dry_lambda(&self) -> f64 {
        self.dry
    }

    /// Film over roughness at a product of viscosity and speed; anything below 0 counts as rest.
    #[must_use]
    pub fn lambda(&self, product: f64) -> f64 {
        self.solved(self.scaled(product))
    }

    /// Share of the load that asperities carry.
    #[must_use]
    pub fn share(&self, product: f64) -> f64 {
        self.at(product).share
    }

    /// The force, N.
    #[must_use]
    pub fn force(&self, product: f64) -> f64 {
        self.at(product).force()
    }

    /// The force, N, and its derivative by the product.
    #[must_use]
    pub fn force_and_slope(&self, product: f64) -> (f64, f64) {
        let state = self.at(product);
        (state.force(), state.slope)
    }

    /// All there is to say at a product of viscosity and speed (Pa m).
    #[must_use]
    pub fn at(&self, product: f64) -> Shared {
        let law = &self.sharing;
        let x = self.scaled(product);
        let lambda = self.solved(x);
        let (share, slope) = law.asperities(lambda);
        // From the film's side, as 1 - share would lose its digits towards rest.
        let per_load = 1.0 / law.load_exponent;
        let film = (x.powf(law.film_exponent) / lambda).powf(per_load);
        let steep = -slope * lambda;
        // growth = d ln lambda/d ln X
        let growth = law.film_exponent * film / (film + law.load_exponent * steep);
        let rolled = law.rolling * x.powf(law.rolling_exponent);
        let slope = law.shear / lambda * (1.0 - growth) - law.boundary * steep * growth / x
            + rolled * (law.rolling_exponent * film + steep * growth) / x;
        Shared {
            lambda,
            share,
            boundary: law.boundary * share,
            shear: law.shear * x / lambda,
            rolling: rolled * film,
            slope: slope / law.reference,
        }
    }

    /// The transition, if the force falls anywhere: the last minimum of the force in speed.
    ///
    /// Below it the force falls, down to the shear of the film that is held between the asperities.
    #[must_use]
    pub fn transition(&self) -> Option<Transition> {
        let lambda = self.transition_lambda()?;
        let product = self.product(lambda);
        let sensitivity = self.sensitivity(lambda);
        Some(Transition { product, lambda, force: self.force(product), sensitivity })
    }

    /// Product of viscosity and speed at the transition with `boundary` times the boundary friction.
    pub(crate) fn transition_product(&self, boundary: f64) -> Option<f64> {
        let law = self.with_forces(1.0, boundary);
        law.transition_lambda().map(|lambda| law.product(lambda))
    }

    fn product(&self, lambda: f64) -> f64 {
        let law = &self.sharing;
        law.reference * law.product(lambda, law.asperities(lambda).0)
    }

    fn transition_lambda(&self) -> Option<f64> {
        // Lambda over that at rest: where no asperity touches, and where next to no film carries.
        const WIDE: f64 = 12.0;
        const NARROW: f64 = 1e-6;
        const RATIO: f64 = 0.98;
        let law = &self.sharing;
        let falls = |gap: f64| law.rise(self.dry + gap) < 0.0;
        let (mut high, mut low) = (WIDE, WIDE);
        while !falls(low) {
            if low < NARROW {
                return None;
            }
            (high, low) = (low, low * RATIO);
        }
        if low >= WIDE {
            return None;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if falls(middle) { low = middle } else { high = middle }
        }
        Some(self.dry + high)
    }

    /// By the theorem of implicit functions: along `rise = 0`, each partial by a difference of an analytic function.
    fn sensitivity(&self, lambda: f64) -> [f64; 8] {
        // Differences of the fourth order.
        const SMALL: f64 = 2e-4;
        let partial = |of: &dyn Fn(f64) -> f64| {
            (8.0 * (of(SMALL) - of(-SMALL)) - (of(2.0 * SMALL) - of(-2.0 * SMALL))) / (12.0 * SMALL)
        };
        let law = self.sharing;
        let log_product = |law: &Sharing, lambda: f64| {
            law.reference.ln() + law.product(lambda, law.asperities(lambda).0).ln()
        };
        let steep = partial(&|e| law.rise(lambda * (1.0 + e)));
        let along = partial(&|e| log_product(&law, lambda * (1.0 + e)));
        std::array::from_fn(|i| {
            let changed = |e: f64| {
                let mut other = law;
                for (at, value) in other.each().into_iter().enumerate() {
                    if at == i {
                        *value *= 1.0 + e;
                    }
                }
                other
            };
            let shift = -partial(&|e| changed(e).rise(lambda)) / steep;
            partial(&|e| log_product(&changed(e), lambda)) + along * shift
        })
    }

    fn scaled(&self, product: f64) -> f64 {
        // `max` takes what is not a number for rest, too.
        let scaled = (product / self.sharing.reference).max(1.0 / LARGEST);
        if scaled < LARGEST { scaled } else { LARGEST }
    }

    /// The lambda at which both shares make the whole load.
    fn solved(&self, x: f64) -> f64 {
        let law = &self.sharing;
        let free = x.powf(law.film_exponent);
        let mut lambda = free.max(self.dry);
        for _ in 0..80 {
            let (share, slope) = law.asperities(lambda);
            let film = (free / lambda).powf(1.0 / law.load_exponent);
            let excess = share + film - 1.0;
            let step = excess / (film / (law.load_exponent * lambda) - slope);
            lambda += step;
            if step <= 2.0 * f64::EPSILON * lambda {
                break;
            }
        }
        lambda
    }
}
