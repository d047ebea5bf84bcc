//! A quadric through weighted points.

/// The number of coefficients of a quadric.
const TERMS: usize = 6;

/// What keeps the system solvable if the points are on a conic, relative to the sum of weights.
const RIDGE: f64 = 1e-5;

/// The sums of a weighted fit of a quadric.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fit {
    /// The lower triangle of the normal matrix.
    matrix: [[f64; TERMS]; TERMS],
    right: [f64; TERMS],
    /// The number of points.
    pub(super) count: usize,
}

impl Fit {
    /// Adds a point at a position relative to the center, with its value and weight.
    #[inline]
    pub(super) fn add(&mut self, [x, y]: [f64; 2], value: f64, weight: f64) {
        let terms = [1.0, x, y, x * x, x * y, y * y];
        for (i, &term) in terms.iter().enumerate() {
            let weighted = weight * term;
            self.right[i] += weighted * value;
            for (sum, other) in self.matrix[i][..=i].iter_mut().zip(&terms) {
                *sum += weighted * other;
            }
        }
        self.count += 1;
    }

    /// Returns the distance of the weighted mean of the positions from the center.
    pub(super) fn eccentricity(&self) -> f64 {
        self.matrix[1][0].hypot(self.matrix[2][0]) / self.matrix[0][0]
    }

    /// Returns the value of the quadric at the center, by the method of Cholesky.
    pub(super) fn at_center(&self) -> f64 {
        let (mut lower, mut solved) = (self.matrix, self.right);
        let ridge = RIDGE * self.matrix[0][0];
        for i in 0..TERMS {
            if i > 0 {
                lower[i][i] += ridge;
            }
            for k in 0..=i {
                let products = (0..k).map(|c| lower[i][c] * lower[k][c]);
                let rest = products.fold(lower[i][k], |sum, product| sum - product);
                lower[i][k] = if i == k {
                    rest.max(1e-12 * ridge).sqrt()
                } else {
                    rest / lower[k][k]
                };
            }
        }
        for i in 0..TERMS {
            let known = (0..i).map(|c| lower[i][c] * solved[c]);
            let rest = known.fold(solved[i], |sum, product| sum - product);
            solved[i] = rest / lower[i][i];
        }
        for i in (0..TERMS).rev() {
            let known = (i + 1..TERMS).map(|c| lower[c][i] * solved[c]);
            let rest = known.fold(solved[i], |sum, product| sum - product);
            solved[i] = rest / lower[i][i];
        }
        solved[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadric_is_found_again() {
        let quadric = |x: f64, y: f64| 3.0 + 0.5 * x - 0.25 * y + x * x - 0.5 * x * y + 2.0 * y * y;
        let mut fit = Fit::default();
        for i in -4..=4 {
            for k in -4..=4 {
                let [x, y] = [i, k].map(|c| f64::from(c) / 4.0);
                fit.add([x, y], quadric(x, y), 1.0 / (1.0 + x * x + y * y));
            }
        }
        assert!((fit.at_center() - 3.0).abs() < 1e-4, "{}", fit.at_center());
        assert!(fit.eccentricity() < 1e-12 && fit.count == 81);
    }

    #[test]
    fn points_on_a_line_give_a_finite_value() {
        let mut fit = Fit::default();
        for i in 0..9 {
            fit.add([f64::from(i) / 8.0, 0.0], 7.0, 1.0);
        }
        assert!((fit.at_center() - 7.0).abs() < 0.01, "{}", fit.at_center());
    }
}
