//! The contact that the tests of a mixed law share.

use hersey_core::lubrication::mixed::Sharing;

pub const SHARING: Sharing = Sharing {
    reference: 0.02,
    film_exponent: 0.6,
    load_exponent: 0.2,
    stiffness: 1000.0,
    boundary: 30.0,
    shear: 1.0,
    rolling: 0.1,
    rolling_exponent: 0.6,
};
