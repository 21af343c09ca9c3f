//! Mixed lubrication of a sliding line contact: the film and the asperities share the load.
//!
//! | module     | responsibility                                                            |
//! |------------|---------------------------------------------------------------------------|
//! | `sharing`  | the numbers of such a contact                                             |
//! | `integral` | Greenwood and Tripp's integral F                                          |
//! | `inlet`    | soft contacts: the film is made where the dry pressure exceeds that of asperities |
//! | `power`    | others: the film is made under the load that asperities leave             |
//! | `carried`  | both laws alike: who carries what at a product or at a lambda             |
//!
//! Everything depends on `x = eta v`, the product of viscosity and speed, taken as `X = x/reference`, and on lambda,
//! the central film over the composite rms roughness:
//!
//! - alone and flooded the film would be `lambda_free = X^n`;
//! - asperities press with `stiffness F(lambda)` times the mean pressure of the nip, which makes their share s of the
//!   load;
//! - the film is thicker for it, by the law of `inlet` where `edge` is above 0, else by that of `power`;
//! - force `boundary s + shear X/lambda + rolling X^r (1 - s)`.

mod carried;
mod inlet;
mod integral;
mod power;
mod sharing;

use std::f64::consts::PI;

use crate::error::{Error, above, at_least, at_most, finite};

use carried::Carried;
pub(crate) use inlet::{Inlet, OFFSET, SHARPNESS, peak};
pub use integral::asperity_integral;
pub(crate) use power::film as power_film;
pub use sharing::Sharing;

/// The smallest lambda at rest, where asperities only just carry the load.
const THINNEST: f64 = 1e-9;
/// The largest mean pressure over `K sqrt(l)`.
const WIDEST: f64 = 1e6;
/// The largest stiffness: asperities that carry the load at lambda = 11.
const STIFFEST: f64 = 1e30;
/// `X` beyond which the laws of the film have long ended, and its inverse, which is rest: every term stays finite.
const LARGEST: f64 = 1e100;

/// Mean pressure of two rough faces over `(sigma beta D)^2 sqrt(sigma/beta) E* F(lambda)`, `16 sqrt(2) pi/15`: D summits
/// per area and of radius beta on each, E* the contact modulus of the faces. Two summits meet as spheres of radius
/// beta/2, aside by any distance.
pub const GREENWOOD_TRIPP: f64 = 16.0 * std::f64::consts::SQRT_2 * PI / 15.0;

impl Sharing {
    /// Pressure of the asperities over the mean pressure where they carry all.
    fn most(&self) -> f64 {
        if self.is_soft() { peak(self.roundness) } else { 1.0 }
    }

    /// Lambda at rest, where asperities carry all.
    fn dry(&self) -> f64 {
        // ln(stiffness F) is concave and falls: Newton's method comes down to its root from beyond it.
        let mut dry = 0.0;
        for _ in 0..60 {
            let (share, slope) = power::asperities(self, dry);
            let next = (dry - share * (share / self.most()).ln() / slope).clamp(0.0, 30.0);
            let done = (next - dry).abs() <= 2.0 * f64::EPSILON * next;
            dry = next;
            if done {
                break;
            }
        }
        dry.max(THINNEST)
    }

    /// `d force/d ln X`, which the transition nils.
    fn rise(&self, at: &Carried) -> f64 {
        let product = at.product(self);
        let rolled = self.rolling * product.powf(self.rolling_exponent);
        let fall = at.fall * at.growth;
        self.shear * product / at.lambda * (1.0 - at.growth) - self.boundary * fall
            + rolled * (self.rolling_exponent * at.film + fall)
    }
}

/// The contact at one product of viscosity and speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shared {
    /// Film over roughness.
    pub lambda: f64,
    /// The least film, at the exit, over roughness; not a number where no law of it is known (`edge` 0).
    pub minimum: f64,
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
    /// Derivative of the force by the logarithm of `edge`, N.
    pub by_edge: f64,
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
    pub sensitivity: [f64; 10],
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
    /// If a number is out of range: reference, boundary and shear above 0, `0.1 <= n <= 1`, `0.01 <= b <= n`, edge from 0
    /// to 1e6, roundness from 0.01 to 1, rolling not negative, its exponent from 0 to 2, and a stiffness at which
    /// asperities carry the load before the mean planes meet: `stiffness F(0)` above 1, with an edge above `p_max/p_mean`.
    pub fn new(sharing: Sharing) -> Result<Self, Error> {
        above("reference of the film", sharing.reference, 0.0)?;
        at_most("film exponent", at_least("film exponent", sharing.film_exponent, 0.1)?, 1.0)?;
        let load = at_least("load exponent", sharing.load_exponent, 0.01)?;
        at_most("load exponent", load, sharing.film_exponent)?;
        at_most("edge", at_least("edge", sharing.edge, 0.0)?, WIDEST)?;
        at_most("roundness", at_least("roundness", sharing.roundness, 0.01)?, 1.0)?;
        let least = sharing.most() / asperity_integral(0.0).0;
        above("stiffness of the asperities", sharing.stiffness, least)?;
        at_most("stiffness of the asperities", sharing.stiffness, STIFFEST)?;
        above("boundary force", sharing.boundary, 0.0)?;
        above("shear force", sharing.shear, 0.0)?;
        at_least("rolling force", sharing.rolling, 0.0)?;
        at_least("rolling exponent", sharing.rolling_exponent, 0.0)?;
        at_most("rolling exponent", sharing.rolling_exponent, 2.0)?;
        finite("force", sharing.boundary + sharing.shear + sharing.rolling)?;
        Ok(Self { sharing, dry: sharing.dry() })
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
        Carried::at_product(&self.sharing, self.dry, self.scaled(product)).lambda
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
        let at = Carried::at_product(law, self.dry, x);
        let rolled = law.rolling * x.powf(law.rolling_exponent);
        let fall = at.fall * at.growth;
        let slope = law.shear / at.lambda * (1.0 - at.growth) - law.boundary * fall / x
            + rolled * (law.rolling_exponent * at.film + fall) / x;
        Shared {
            lambda: at.lambda,
            minimum: at.minimum,
            share: at.share,
            boundary: law.boundary * at.share,
            shear: law.shear * x / at.lambda,
            rolling: rolled * at.film,
            slope: slope / law.reference,
            by_edge: at.by_edge * ((rolled - law.boundary) * at.fall - law.shear * x / at.lambda),
        }
    }

    /// The soft contact at a product of viscosity and speed, and the weight of asperities in its film.
    pub(crate) fn inlet(&self, product: f64) -> (Inlet, f64) {
        let free = inlet::alone(&self.sharing, self.scaled(product));
        let state = Inlet::solved(&self.sharing, self.dry, free);
        (state, state.weight(free).weight)
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
        law.reference * Carried::at_gap(law, self.dry, (lambda / self.dry - 1.0).ln()).product(law)
    }

    fn transition_lambda(&self) -> Option<f64> {
        // Lambda over that at rest: where no asperity touches, and where next to no film carries.
        const WIDE: f64 = 12.0;
        const NARROW: f64 = 1e-6;
        const RATIO: f64 = 0.98;
        let law = &self.sharing;
        let falls =
            |gap: f64| law.rise(&Carried::at_gap(law, self.dry, (gap / self.dry).ln())) < 0.0;
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
    fn sensitivity(&self, lambda: f64) -> [f64; 10] {
        // Differences of the fourth order.
        const SMALL: f64 = 2e-4;
        let partial = |of: &dyn Fn(f64) -> f64| {
            (8.0 * (of(SMALL) - of(-SMALL)) - (of(2.0 * SMALL) - of(-2.0 * SMALL))) / (12.0 * SMALL)
        };
        let law = self.sharing;
        let same = |law: &Sharing| {
            (law.stiffness, law.roundness) == (self.sharing.stiffness, self.sharing.roundness)
        };
        // Along ln(lambda/dry - 1), which no difference takes below the lambda at rest.
        let gap = (lambda / self.dry - 1.0).ln();
        let state = |law: &Sharing, gap: f64| {
            let dry = if same(law) { self.dry } else { law.dry() };
            Carried::at_gap(law, dry, gap)
        };
        let rise = |law: &Sharing, gap: f64| law.rise(&state(law, gap));
        let log_product =
            |law: &Sharing, gap: f64| law.reference.ln() + state(law, gap).free / law.film_exponent;
        let steep = partial(&|e| rise(&law, gap + e));
        let along = partial(&|e| log_product(&law, gap + e));
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
            let shift = -partial(&|e| rise(&changed(e), gap)) / steep;
            partial(&|e| log_product(&changed(e), gap)) + along * shift
        })
    }

    fn scaled(&self, product: f64) -> f64 {
        // `max` takes what is not a number for rest, too.
        let scaled = (product / self.sharing.reference).max(1.0 / LARGEST);
        if scaled < LARGEST { scaled } else { LARGEST }
    }
}
