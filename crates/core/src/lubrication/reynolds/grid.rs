//! Nodes between inlet and outlet: dense where pressure and film bend.

/// Greatest root of a relative curvature that draws nodes, in 1/a: a spike is met, not chased.
const SHARPEST: f64 = 20.0;
/// Passes of the three-point average that smooths a density.
const SMOOTHING: usize = 6;

/// Places of `cells + 1` nodes as shares of the way from the first of `points` to the last, so that between two
/// neighbours there is the same integral of `density`, given at `points` and linear between them.
#[must_use]
pub fn equidistributed(points: &[f64], density: &[f64], cells: usize) -> Vec<f64> {
    let mut area = vec![0.0];
    for i in 1..points.len() {
        let step = 0.5 * (density[i] + density[i - 1]) * (points[i] - points[i - 1]);
        area.push(area[i - 1] + step);
    }
    let (first, span) = (points[0], points[points.len() - 1] - points[0]);
    let total = area[area.len() - 1];
    let mut i = 1;
    let mut shares: Vec<f64> = (0..=cells)
        .map(|k| {
            let target = total * ratio(k, cells);
            while i + 1 < area.len() && area[i] < target {
                i += 1;
            }
            let (low, high) = (density[i - 1], density[i]);
            let width = points[i] - points[i - 1];
            // low s + (high - low) s^2/2 = what is missing, s the share of this interval
            let missing = (target - area[i - 1]) / width;
            let root = (low * low + 2.0 * (high - low) * missing).max(0.0).sqrt();
            let share = 2.0 * missing / (low + root);
            (points[i - 1] + share * width - first) / span
        })
        .collect();
    shares[0] = 0.0;
    shares[cells] = 1.0;
    shares
}

/// Density of nodes that resolves `pressure` and `film` at `x` alike: the root of their relative curvatures.
#[must_use]
pub fn density(x: &[f64], pressure: &[f64], film: &[f64]) -> Vec<f64> {
    let n = x.len();
    let top = pressure.iter().fold(f64::MIN_POSITIVE, |a, &p| a.max(p));
    let mut density: Vec<f64> = (0..n)
        .map(|i| {
            let i = i.clamp(1, n - 2);
            let bend = (curvature(x, pressure, i).abs() / top).sqrt();
            let open = (curvature(x, film, i).abs() / film[i]).sqrt();
            bend.min(SHARPEST) + open.min(SHARPEST) + 1.0 / (0.5 + x[i].abs())
        })
        .collect();
    for _ in 0..SMOOTHING {
        let old = density.clone();
        for i in 1..n - 1 {
            density[i] = 0.25 * old[i - 1] + 0.5 * old[i] + 0.25 * old[i + 1];
        }
        density[0] = old[1];
        density[n - 1] = old[n - 2];
    }
    density
}

/// Second derivative of the parabola through three neighbours.
fn curvature(x: &[f64], y: &[f64], i: usize) -> f64 {
    let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
    2.0 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left) / (left + right)
}

/// `y` given at `x`, at each of `places`: cubic Hermite interpolation with slopes that do not overshoot.
#[must_use]
pub fn interpolated(x: &[f64], y: &[f64], places: &[f64]) -> Vec<f64> {
    let n = x.len();
    let chord = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    let slope = |i: usize| {
        if i == 0 || i == n - 1 {
            return chord(i.min(n - 2));
        }
        let (before, after) = (chord(i - 1), chord(i));
        let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        if before * after <= 0.0 {
            return 0.0;
        }
        let (a, b) = (left + 2.0 * right, 2.0 * left + right);
        (a + b) / (a / before + b / after)
    };
    let mut i = 0;
    places
        .iter()
        .map(|&place| {
            while i + 2 < n && x[i + 1] < place {
                i += 1;
            }
            let width = x[i + 1] - x[i];
            let t = ((place - x[i]) / width).clamp(0.0, 1.0);
            let (start, end) = (slope(i) * width, slope(i + 1) * width);
            let gap = y[i + 1] - y[i];
            y[i] + t * (start + t * (3.0 * gap - 2.0 * start - end + t * (start + end - 2.0 * gap)))
        })
        .collect()
}

/// `part` of `whole`.
#[allow(clippy::cast_precision_loss)] // counts of nodes
fn ratio(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_share_the_integral_of_the_density() {
        // density 1 + 3 x on [0, 1]: the integral x + 1.5 x^2 grows by 0.25 from node to node of ten cells
        let shares = equidistributed(&[2.0, 3.0], &[1.0, 4.0], 10);
        assert_eq!((shares.len(), shares[0], shares[10]), (11, 0.0, 1.0));
        for (k, x) in shares.iter().enumerate() {
            assert!((x + 1.5 * x * x - 0.25 * ratio(k, 1)).abs() < 1e-14, "{k}: {x}");
        }
        // three stretches of other densities: half of the cells lie in the dense one
        let shares = equidistributed(&[0.0, 1.0, 1.0 + 1e-9, 2.0], &[1.0, 1.0, 3.0, 3.0], 8);
        assert!((shares[2] - 0.5).abs() < 1e-6 && (shares[5] - 0.75).abs() < 1e-6, "{shares:?}");
    }

    #[test]
    fn density_is_the_root_of_the_relative_curvatures() {
        // p = 1 - x^2 and h = 1 + x^2: on even nodes the curvatures are 2
        let x: Vec<f64> = (-20..=20).map(|i| f64::from(i) * 0.05).collect();
        let p: Vec<f64> = x.iter().map(|x| 1.0 - x * x).collect();
        let h: Vec<f64> = x.iter().map(|x| 1.0 + x * x).collect();
        let found = density(&x, &p, &h);
        let exact = |x: f64| 2_f64.sqrt() + (2.0 / (1.0 + x * x)).sqrt() + 1.0 / (0.5 + x.abs());
        for i in [8, 12, 28, 32] {
            assert!((found[i] / exact(x[i]) - 1.0).abs() < 0.01, "{}: {}", x[i], found[i]);
        }
        // what is too sharp draws no more than so many
        let spike = density(&[-1.0, 0.0, 1e-6, 1.0], &[0.0, 0.0, 1.0, 0.0], &[1.0; 4]);
        assert!(spike.iter().all(|d| *d <= 2.0 * SHARPEST + 2.0 && *d > 1.0), "{spike:?}");
    }

    #[test]
    fn interpolation_keeps_lines_and_does_not_overshoot() {
        let (x, line) = ([0.0, 0.5, 2.0, 2.5, 4.0], [1.0, 2.0, 5.0, 6.0, 9.0]);
        let places = [-1.0, 0.0, 0.2, 1.0, 2.0, 2.1, 3.9, 4.0, 5.0];
        for (place, y) in places.iter().zip(interpolated(&x, &line, &places)) {
            let within = place.clamp(0.0, 4.0);
            assert!((y - (1.0 + 2.0 * within)).abs() < 1e-14, "{place}: {y}");
        }
        let step = interpolated(&[0.0, 1.0, 2.0, 3.0], &[0.0, 0.0, 1.0, 1.0], &[0.5, 1.5, 2.5]);
        assert_eq!(step, [0.0, 0.5, 1.0]);
        // slopes between: the harmonic mean of the chords, weighted by what lies beyond (Fritsch and Butland)
        let curve = interpolated(&[0.0, 1.0, 3.0], &[0.0, 1.0, 9.0], &[0.5, 2.0]);
        // slope at 1 is (5 + 4)/(5/1 + 4/4) = 1.5
        assert!((curve[0] - (0.5 + 0.125 * (1.0 - 1.5))).abs() < 1e-14, "{curve:?}");
        assert!((curve[1] - (5.0 + 0.25 * (1.5 - 4.0))).abs() < 1e-14, "{curve:?}");
    }
}
