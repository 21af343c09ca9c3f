//! Runge-Kutta steps: Radau IIA for stiff motion, Dormand and Prince's pair for the second opinion.
//!
//! Both find the state at any time inside a step by a shorter step from its start, so that samples and
//! events are as accurate as the steps and do not change them. Radau IIA of order 5: E. Hairer,
//! G. Wanner, "Solving Ordinary Differential Equations II" (1996), IV.5.

use super::dormand_prince::{ERROR, NODES, STAGES, WEIGHTS};
use super::schedule::Cubic;
use crate::drag::{Closure, Drag, TemperatureLaw};

/// Pull of the spring, belt speed, deflection of the bristles.
pub(super) type State = [f64; 3];

const N: usize = 3;

/// The equation of a slipping belt, in time since the start of a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flow<'a> {
    pub drag: &'a Drag,
    /// Branch of the law, or none below the stick speed.
    pub branch: Option<usize>,
    /// Temperature and how the law varies with it.
    pub temperature_law: Option<(Cubic, &'a TemperatureLaw)>,
    pub rate: Cubic,
    pub stiffness: f64,
    pub mass: f64,
    /// Factor of the static force, of a belt that has been released after a rest.
    pub strength: f64,
}

impl Flow<'_> {
    /// The same at one temperature of the law, if it is given.
    pub(super) fn at_temperature(mut self, temperature: Option<f64>) -> Self {
        if let (Some(temperature), Some((course, _))) = (temperature, &mut self.temperature_law) {
            *course = [temperature, 0.0, 0.0, 0.0];
        }
        self
    }

    /// Factors of forces and speeds at time `t`.
    #[inline]
    pub(super) fn factors(&self, t: f64) -> (f64, f64) {
        self.temperature_law.map_or((1.0, 1.0), |(temperature, temperature_law)| {
            let temperature = horner(&temperature, t);
            let speed = temperature_law.speed_factor(temperature).unwrap_or(f64::NAN);
            (temperature_law.force_factor(temperature), speed)
        })
    }

    /// Factor of boundary friction at time `t`.
    #[inline]
    fn boundary_factor(&self, t: f64) -> f64 {
        self.temperature_law.map_or(1.0, |(temperature, temperature_law)| {
            temperature_law.boundary_factor(horner(&temperature, t)).unwrap_or(f64::NAN)
        })
    }

    /// Factor of the forces of the contact below the stick speed at time `t`.
    pub(super) fn below_factor(&self, t: f64) -> f64 {
        if self.temperature_law.is_none() {
            return 1.0;
        }
        self.factors(t).0 * (1.0 + self.drag.boundary_share() * (self.boundary_factor(t) - 1.0))
    }

    /// Factor of the rest of the drive at time `t`.
    #[inline]
    pub(super) fn rest_factor(&self, t: f64) -> f64 {
        if self.drag.rest().is_none() {
            return 1.0; // nothing that could end
        }
        self.temperature_law.map_or(1.0, |(temperature, temperature_law)| {
            temperature_law.rest_factor(horner(&temperature, t)).unwrap_or(f64::NAN)
        })
    }

    /// Steady drag of the contact at `u` and its slope.
    #[inline]
    fn contact_drag(&self, t: f64, u: f64) -> (f64, f64) {
        let (force, speed) = self.factors(t);
        let x = u / speed;
        let (f, slope) = if let Some(branch) = self.branch {
            self.drag.branch_force_and_slope(branch, x, self.boundary_factor(t))
        } else {
            self.drag.strengthened_below(x, self.strength)
        };
        let force = if self.branch.is_some() { force } else { self.below_factor(t) };
        (force * f, force * slope / speed)
    }

    /// Drag and its slopes in speed and deflection, and the rate of deflection with its slopes.
    fn friction(&self, t: f64, y: &State) -> ([f64; 3], [f64; 3]) {
        let (contact, slope) = self.contact_drag(t, y[1]);
        let rest = self.drag.rest().scaled(self.rest_factor(t));
        let Closure::LuGre { bristle_stiffness, bristle_damping } = self.drag.closure() else {
            if rest.is_none() {
                return ([contact, slope, 0.0], [0.0; 3]);
            }
            let (_, speed) = self.factors(t);
            let (share, growth) = if self.branch.is_some() {
                (1.0, 0.0)
            } else {
                self.drag.smoothed_below(y[1] / speed)
            };
            let force = contact + rest.at(y[1]) * share;
            let slope = slope + rest.damping * share + rest.at(y[1]) * growth / speed;
            return ([force, slope, 0.0], [0.0; 3]);
        };
        // bristles bear what is there at rest; what grows with speed is viscous, and acts beside them
        let g = contact + rest.force;
        let (u, z) = (y[1], y[2]);
        let bent = bristle_stiffness * z / g;
        let rate = u * (1.0 - bent);
        let rate_u = 1.0 - bent + u * bent * slope / g;
        let rate_z = -u * bristle_stiffness / g;
        let (_, speed) = self.factors(t);
        let v_s = self.drag.stick_speed() * speed;
        let damping = bristle_damping * (-(u / v_s).powi(2)).exp();
        let force = bristle_stiffness * z + damping * rate + rest.damping * u;
        let force_u = damping * (rate_u - 2.0 * u / (v_s * v_s) * rate) + rest.damping;
        let force_z = bristle_stiffness + damping * rate_z;
        ([force, force_u, force_z], [rate, rate_u, rate_z])
    }

    /// Drag force.
    pub(super) fn force(&self, t: f64, y: &State) -> f64 {
        self.friction(t, y).0[0]
    }

    /// Slope of the drag force in speed, at time 0.
    pub(super) fn force_slope(&self, y: &State) -> f64 {
        self.friction(0.0, y).0[1]
    }

    pub(super) fn rates(&self, t: f64, y: &State) -> State {
        let (force, bristles) = self.friction(t, y);
        let driven = horner(&self.rate, t);
        [driven - self.stiffness * y[1], (y[0] - force[0]) / self.mass, bristles[0]]
    }

    fn jacobian(&self, t: f64, y: &State) -> [[f64; N]; N] {
        let (force, bristles) = self.friction(t, y);
        [
            [0.0, -self.stiffness, 0.0],
            [1.0 / self.mass, -force[1] / self.mass, -force[2] / self.mass],
            [0.0, bristles[1], bristles[2]],
        ]
    }
}

pub(super) fn horner(c: &Cubic, t: f64) -> f64 {
    c[0] + t * (c[1] + t * (c[2] + t * c[3]))
}

/// Which formula makes the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Formula {
    Radau,
    DormandPrince,
}

impl Formula {
    /// State after `h` from `y` at time 0, and the error of each component; none if the step fails.
    pub(super) fn step(
        self,
        flow: &Flow,
        y: &State,
        h: f64,
        scales: &State,
        tolerance: f64,
    ) -> Option<(State, State)> {
        let stepped = match self {
            Self::DormandPrince => dormand_prince(flow, y, h),
            Self::Radau => {
                let whole = radau(flow, 0.0, y, h, scales, tolerance)?;
                let half = radau(flow, 0.0, y, 0.5 * h, scales, tolerance)?;
                let halves = radau(flow, 0.5 * h, &half, 0.5 * h, scales, tolerance)?;
                (halves, [0, 1, 2].map(|i| (halves[i] - whole[i]) / 31.0))
            }
        };
        stepped.0.iter().all(|x| x.is_finite()).then_some(stepped)
    }

    /// State at `t` inside a step that succeeded.
    pub(super) fn at(
        self,
        flow: &Flow,
        y: &State,
        t: f64,
        scales: &State,
        tolerance: f64,
    ) -> State {
        if t == 0.0 {
            return *y;
        }
        let found = match self {
            Self::DormandPrince => Some(dormand_prince(flow, y, t).0),
            Self::Radau => radau(flow, 0.0, y, 0.5 * t, scales, tolerance)
                .and_then(|half| radau(flow, 0.5 * t, &half, 0.5 * t, scales, tolerance)),
        };
        found.unwrap_or_else(|| dormand_prince(flow, y, t).0)
    }
}

/// Growth of a step whose error is `error` times what is allowed.
pub(super) fn growth(error: f64) -> f64 {
    (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0)
}

/// Iterations of the simplified Newton method before a step is given up.
const MAX_NEWTON: usize = 12;

const ROOT6: f64 = 2.449_489_742_783_178;
const RADAU_C: [f64; 3] = [(4.0 - ROOT6) / 10.0, (4.0 + ROOT6) / 10.0, 1.0];
const RADAU_A: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT6) / 360.0, (296.0 - 169.0 * ROOT6) / 1800.0, (-2.0 + 3.0 * ROOT6) / 225.0],
    [(296.0 + 169.0 * ROOT6) / 1800.0, (88.0 + 7.0 * ROOT6) / 360.0, (-2.0 - 3.0 * ROOT6) / 225.0],
    [(16.0 - ROOT6) / 36.0, (16.0 + ROOT6) / 36.0, 1.0 / 9.0],
];
/// That matrix times itself.
const RADAU_A2: [[f64; 3]; 3] = squared(&RADAU_A);

const fn squared(a: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut square = [[0.0; 3]; 3];
    let mut i = 0;
    while i < 9 {
        let (row, column) = (i / 3, i % 3);
        square[row][column] =
            a[row][0] * a[0][column] + a[row][1] * a[1][column] + a[row][2] * a[2][column];
        i += 1;
    }
    square
}

/// One step of Radau IIA, order 5.
///
/// The pull follows from the speed by `p' = driven - k u`, so only speeds and deflections of the stages are solved for.
fn radau(flow: &Flow, t: f64, y: &State, h: f64, scales: &State, tolerance: f64) -> Option<State> {
    if flow.drag.closure().has_memory() {
        radau_of::<6>(flow, t, y, h, scales, tolerance)
    } else {
        radau_of::<3>(flow, t, y, h, scales, tolerance)
    }
}

/// The same with `M` unknowns: the speeds of the three stages, and with bristles their deflections.
fn radau_of<const M: usize>(
    flow: &Flow,
    t: f64,
    y: &State,
    h: f64,
    scales: &State,
    tolerance: f64,
) -> Option<State> {
    let jacobian = flow.jacobian(t, y);
    let pulled = h * h * flow.stiffness / flow.mass;
    let mut matrix = [[0.0; M]; M];
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let identity = f64::from(u8::from(i == j));
            let (stage, other) = (i % 3, j % 3);
            *entry = identity - h * RADAU_A[stage][other] * jacobian[1 + i / 3][1 + j / 3];
            if i < 3 && j < 3 {
                *entry += pulled * RADAU_A2[stage][other];
            }
        }
    }
    let pivots = factorised(&mut matrix)?;
    let mut z = [[0.0; N]; 3];
    let mut last = f64::INFINITY;
    for _ in 0..MAX_NEWTON {
        let rates: [State; 3] = std::array::from_fn(|i| {
            flow.rates(t + RADAU_C[i] * h, &std::array::from_fn(|l| y[l] + z[i][l]))
        });
        let off = |stage: usize, l: usize| {
            let sum: f64 = (0..3).map(|j| RADAU_A[stage][j] * rates[j][l]).sum();
            h * sum - z[stage][l]
        };
        let pulls: [f64; 3] = std::array::from_fn(|stage| off(stage, 0));
        let weighted = |stage: usize, of: &[f64]| -> f64 {
            RADAU_A[stage].iter().zip(of).map(|(a, x)| h * a * x).sum()
        };
        let mut correction: [f64; M] = std::array::from_fn(|i| {
            let own = off(i % 3, 1 + i / 3);
            if i < 3 { own + weighted(i, &pulls) / flow.mass } else { own }
        });
        solve(&matrix, &pivots, &mut correction);
        let mut size = 0.0_f64;
        let mut correct = |stage: usize, l: usize, c: f64| {
            z[stage][l] += c;
            size = size.max(c.abs() / scales[l]);
        };
        for (stage, pull) in pulls.iter().enumerate() {
            let speeds = weighted(stage, &correction[..3]);
            correct(stage, 0, pull - flow.stiffness * speeds);
        }
        for (i, c) in correction.iter().enumerate() {
            correct(i % 3, 1 + i / 3, *c);
        }
        // the iteration has done what it can when corrections no longer shrink
        if size <= 1e-3 * tolerance || (size >= 0.5 * last && size <= 0.1 * tolerance) {
            return Some(std::array::from_fn(|l| y[l] + z[2][l]));
        }
        if !size.is_finite() || size > 2.0 * last {
            return None;
        }
        last = size;
    }
    None
}

/// LU factors in place, with the order of the rows.
fn factorised<const M: usize>(a: &mut [[f64; M]; M]) -> Option<[usize; M]> {
    let mut rows: [usize; M] = std::array::from_fn(|i| i);
    for column in 0..M {
        let pivot =
            (column..M).max_by(|i, j| a[*i][column].abs().total_cmp(&a[*j][column].abs()))?;
        a.swap(column, pivot);
        rows.swap(column, pivot);
        let diagonal = a[column][column];
        if !diagonal.is_finite() || diagonal == 0.0 {
            return None;
        }
        for row in column + 1..M {
            let factor = a[row][column] / diagonal;
            a[row][column] = factor;
            let pivot_row = a[column];
            for (entry, above) in a[row].iter_mut().zip(pivot_row).skip(column + 1) {
                *entry -= factor * above;
            }
        }
    }
    Some(rows)
}

fn solve<const M: usize>(lu: &[[f64; M]; M], rows: &[usize; M], b: &mut [f64; M]) {
    let mut x: [f64; M] = std::array::from_fn(|i| b[rows[i]]);
    for i in 1..M {
        for j in 0..i {
            x[i] -= lu[i][j] * x[j];
        }
    }
    for i in (0..M).rev() {
        for j in i + 1..M {
            x[i] -= lu[i][j] * x[j];
        }
        x[i] /= lu[i][i];
    }
    *b = x;
}

/// One step of Dormand and Prince's pair: the state of order 5 and its difference to order 4.
fn dormand_prince(flow: &Flow, y: &State, h: f64) -> (State, State) {
    let mut k = [[0.0; N]; STAGES];
    let mut stage = *y;
    for i in 0..STAGES {
        stage = std::array::from_fn(|l| {
            y[l] + h * (0..i).map(|j| WEIGHTS[i][j] * k[j][l]).sum::<f64>()
        });
        k[i] = flow.rates(NODES[i] * h, &stage);
    }
    let error = std::array::from_fn(|l| h * (0..STAGES).map(|j| ERROR[j] * k[j][l]).sum::<f64>());
    (stage, error)
}
