//! The numbers of a contact whose load film and asperities share.

/// The numbers of a contact that shares its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// Product of viscosity and speed at which the film alone is as thick as the composite roughness, Pa m.
    pub reference: f64,
    /// n: exponent of film thickness in viscosity times speed.
    pub film_exponent: f64,
    /// b: film thickness goes as load to the power -b. Only where `edge` is 0.
    pub load_exponent: f64,
    /// Mean pressure of the dry nip over `K sqrt(l)`: K is the slope of pressure at its edge, `p = K sqrt(d)`, and l the
    /// length of the inlet at the reference, `(eta u E*^2/K^3)^0.4` with the mean speed u. 0: the film goes as a power
    /// of its share of the load.
    pub edge: f64,
    /// k of the dry pressure, `K^2 a/(2 p_max^2)` with the half-width a: 1 for an ellipse, 0 for a parabola. Only where
    /// `edge` is above 0.
    pub roundness: f64,
    /// Pressure of the asperities over the mean pressure of the nip and over F(lambda).
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
    pub const NAMES: [&str; 10] = [
        "reference",
        "film_exponent",
        "load_exponent",
        "edge",
        "roundness",
        "stiffness",
        "boundary",
        "shear",
        "rolling",
        "rolling_exponent",
    ];

    /// From the numbers in the order of `NAMES`.
    #[must_use]
    pub fn from_numbers(numbers: [f64; 10]) -> Self {
        let [reference, film_exponent, load_exponent, edge, roundness, stiffness, forces @ ..] =
            numbers;
        let [boundary, shear, rolling, rolling_exponent] = forces;
        Self {
            reference,
            film_exponent,
            load_exponent,
            edge,
            roundness,
            stiffness,
            boundary,
            shear,
            rolling,
            rolling_exponent,
        }
    }

    /// The numbers in the order of `NAMES`.
    pub(super) fn each(&mut self) -> [&mut f64; 10] {
        [
            &mut self.reference,
            &mut self.film_exponent,
            &mut self.load_exponent,
            &mut self.edge,
            &mut self.roundness,
            &mut self.stiffness,
            &mut self.boundary,
            &mut self.shear,
            &mut self.rolling,
            &mut self.rolling_exponent,
        ]
    }

    /// Whether the law is that of a soft contact.
    pub(crate) fn is_soft(&self) -> bool {
        self.edge > 0.0
    }
}
