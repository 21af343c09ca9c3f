//! The contacts that the tests of a mixed law share: one whose film goes as a power of its load, and a soft one.

use hersey_core::lubrication::mixed::Sharing;

pub const SHARING: Sharing = Sharing {
    reference: 0.02,
    film_exponent: 0.6,
    load_exponent: 0.2,
    edge: 0.0,
    roundness: 1.0,
    stiffness: 1000.0,
    boundary: 30.0,
    shear: 1.0,
    rolling: 0.1,
    rolling_exponent: 0.6,
};

#[allow(dead_code)] // each test file takes what it needs
pub const SOFT: Sharing =
    Sharing { edge: 8.0, roundness: 0.7, stiffness: 20.0, rolling_exponent: 0.8, ..SHARING };
