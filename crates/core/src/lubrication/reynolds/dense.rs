//! Dense linear equations: LU decomposition with partial pivoting, eight columns at a time.

use crate::error::Error;
use crate::work::Work;

/// Entries of a matrix from which eight columns are eliminated in the time of one step of work.
const ENTRIES: usize = 300;

/// Columns that are eliminated together, so that a row is read once for all of them.
const PANEL: usize = 8;

/// A square matrix, by rows.
#[derive(Debug, Clone)]
pub struct Matrix {
    order: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// The zero matrix of that order.
    #[must_use]
    pub fn zeros(order: usize) -> Self {
        Self { order, entries: vec![0.0; order * order] }
    }

    /// Row `i`.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.order..(i + 1) * self.order]
    }

    /// Row `i`, to write.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.entries[i * self.order..(i + 1) * self.order]
    }

    /// Rows `i` and, after it, `j`.
    fn two_rows(&mut self, i: usize, j: usize) -> (&mut [f64], &mut [f64]) {
        let n = self.order;
        let (head, tail) = self.entries.split_at_mut(j * n);
        (&mut head[i * n..(i + 1) * n], &mut tail[..n])
    }
}

/// A factored matrix.
#[derive(Debug, Clone)]
pub struct Factors {
    matrix: Matrix,
    /// The row that was exchanged with each.
    exchanges: Vec<usize>,
}

impl Factors {
    /// Factors of `matrix`, or nothing if it is singular or not finite.
    ///
    /// # Errors
    /// If `work` ends before.
    pub fn new(mut matrix: Matrix, work: &Work) -> Result<Option<Self>, Error> {
        let n = matrix.order;
        let arch = pulp::Arch::new();
        let mut exchanges = Vec::with_capacity(n);
        for start in (0..n).step_by(PANEL) {
            let end = (start + PANEL).min(n);
            work.take(panel_work(n - start))?;
            for k in start..end {
                let Some(exchanged) = eliminate_in_panel(&mut matrix, k, end) else {
                    return Ok(None);
                };
                exchanges.push(exchanged);
            }
            for k in start..end {
                for i in k + 1..end {
                    let (pivot, row) = matrix.two_rows(k, i);
                    let factor = row[k];
                    subtract(&mut row[end..], factor, &pivot[end..]);
                }
            }
            arch.dispatch(|| update(&mut matrix, start, end));
        }
        Ok(Some(Self { matrix, exchanges }))
    }

    /// Put the solution of the equations in place of their right-hand side.
    pub fn solve(&self, side: &mut [f64]) {
        let n = self.matrix.order;
        for (k, &other) in self.exchanges.iter().enumerate() {
            side.swap(k, other);
        }
        for i in 1..n {
            side[i] -= dot(&self.matrix.row(i)[..i], &side[..i]);
        }
        for i in (0..n).rev() {
            let row = self.matrix.row(i);
            side[i] = (side[i] - dot(&row[i + 1..], &side[i + 1..])) / row[i];
        }
    }
}

/// Work of eliminating a panel from a matrix of that order.
fn panel_work(order: usize) -> u64 {
    (1 + order * order / ENTRIES) as u64
}

/// Work of the factors of a matrix of that order, about.
#[must_use]
pub fn factors_work(order: usize) -> u64 {
    (order / PANEL) as u64 * panel_work(order) / 3
}

/// Sum of products.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; PANEL];
    let (whole, rest) = a.as_chunks::<PANEL>();
    let (other, other_rest) = b.as_chunks::<PANEL>();
    for (x, y) in whole.iter().zip(other) {
        for lane in 0..PANEL {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    let tail: f64 = rest.iter().zip(other_rest).map(|(x, y)| x * y).sum();
    lanes.iter().sum::<f64>() + tail
}

fn subtract(row: &mut [f64], factor: f64, pivot: &[f64]) {
    for (x, y) in row.iter_mut().zip(pivot) {
        *x -= factor * y;
    }
}

/// Choose the pivot of column `k` and eliminate below it within the panel that ends at `end`; the row exchanged.
fn eliminate_in_panel(matrix: &mut Matrix, k: usize, end: usize) -> Option<usize> {
    let n = matrix.order;
    let size = |i: usize| matrix.entries[i * n + k].abs();
    let best = (k..n).max_by(|&i, &j| size(i).total_cmp(&size(j)))?;
    if size(best) == 0.0 || !size(best).is_finite() {
        return None;
    }
    if best != k {
        let (a, b) = matrix.two_rows(k, best);
        a.swap_with_slice(b);
    }
    for i in k + 1..n {
        let (pivot, row) = matrix.two_rows(k, i);
        row[k] /= pivot[k];
        let factor = row[k];
        subtract(&mut row[k + 1..end], factor, &pivot[k + 1..end]);
    }
    Some(best)
}

/// Subtract from all rows below `end` what the rows of the panel leave in the columns after it.
#[allow(clippy::inline_always)] // so that it is compiled for the instruction set it is dispatched to
#[allow(clippy::needless_range_loop)] // nine rows side by side
#[inline(always)]
fn update(matrix: &mut Matrix, start: usize, end: usize) {
    let n = matrix.order;
    let width = n - end;
    if end - start < PANEL || width == 0 {
        return;
    }
    let (head, tail) = matrix.entries.split_at_mut(end * n);
    let pivots: [&[f64]; PANEL] = std::array::from_fn(|k| &head[(start + k) * n + end..][..width]);
    let [p0, p1, p2, p3, p4, p5, p6, p7] = pivots;
    for row in tail.chunks_exact_mut(n) {
        let f: [f64; PANEL] = std::array::from_fn(|k| row[start + k]);
        let row = &mut row[end..][..width];
        for j in 0..width {
            let first = f[0] * p0[j] + f[1] * p1[j] + f[2] * p2[j] + f[3] * p3[j];
            let second = f[4] * p4[j] + f[5] * p5[j] + f[6] * p6[j] + f[7] * p7[j];
            row[j] -= first + second;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factorisation_stops_within() {
        let order = 801;
        let mut matrix = Matrix::zeros(order);
        (0..order).for_each(|i| matrix.row_mut(i)[i] = 1.0);
        let asked = std::cell::Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) >= 20;
        let stopped = Factors::new(matrix.clone(), &Work::new(u64::MAX, &stop));
        assert_eq!(stopped.map(|_| ()), Err(Error::Stopped));
        let spent = Factors::new(matrix.clone(), &Work::unwatched(factors_work(order) / 2));
        assert!(matches!(spent, Err(Error::WorkSpent { .. })));
        assert!(Factors::new(matrix, &Work::unwatched(2 * factors_work(order))).is_ok());
    }

    #[test]
    fn solves_what_it_factors() {
        for order in [1, 7, 8, 9, 40, 67] {
            let mut matrix = Matrix::zeros(order);
            let mut seed = 1_u64;
            for entry in &mut matrix.entries {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                *entry = f64::from((seed >> 40) as u32) / f64::from(1_u32 << 24) - 0.5;
            }
            let known: Vec<f64> =
                (0..order).map(|i| 1.0 + [0.0, 1.0, 2.0, 3.0, 4.0][i % 5]).collect();
            let mut side: Vec<f64> = (0..order).map(|i| dot(matrix.row(i), &known)).collect();
            let factors = Factors::new(matrix, &Work::default()).expect("nobody stops it");
            factors.expect("random matrices are regular").solve(&mut side);
            for (x, y) in side.iter().zip(&known) {
                assert!((x - y).abs() < 1e-10, "{order}: {x} for {y}");
            }
        }
        assert!(Factors::new(Matrix::zeros(3), &Work::default()).is_ok_and(|f| f.is_none()));
    }
}
