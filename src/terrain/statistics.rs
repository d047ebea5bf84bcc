//! Statistics of vertical differences.

/// The factor that makes the median absolute deviation of a normal distribution its standard
/// deviation.
const NORMAL: f64 = 1.4826;

/// The largest number of bins of a [`Histogram`].
const MOST_BINS: f64 = 20.0;

/// Values that differ by no more than this part of the largest are equal but for rounding.
const EQUAL: f64 = 1e-9;

/// Statistics of differences between a surface and points that are known better.
///
/// The numbers do not depend on the order of the differences.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ErrorStatistics {
    /// How many differences there are.
    pub count: usize,
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
    /// The mean: the systematic error.
    pub mean: f64,
    /// The median; of an even number, the mean of the two in the middle.
    pub median: f64,
    /// The standard deviation of a sample, with n - 1; NaN of a single difference.
    pub standard_deviation: f64,
    /// The root of the mean square.
    pub rmse: f64,
    /// The normalized median absolute deviation: 1.4826 times the median of the distances from the
    /// median (Höhle and Höhle 2009). As large as the standard deviation if errors are normally
    /// distributed, and hardly changed by outliers.
    pub nmad: f64,
    /// The 95th percentile of the amounts, linear between ranks: the rank is 0.95 (n - 1) + 1, as
    /// in the standards of ASPRS.
    pub percentile_95: f64,
    /// The skewness of a sample (adjusted Fisher-Pearson): 0 if errors are symmetric; NaN of fewer
    /// than three differences, and if all are equal.
    pub skew: f64,
}

impl ErrorStatistics {
    /// The names of the [values](Self::values), in their order.
    pub const NAMES: [&'static str; 9] = [
        "mean",
        "median",
        "standard_deviation",
        "rmse",
        "nmad",
        "percentile_95",
        "min",
        "max",
        "skew",
    ];

    /// Returns all numbers but the count, in the order of [their names](Self::NAMES). The unit is
    /// that of the differences; the skewness has none.
    pub fn values(&self) -> [f64; 9] {
        [
            self.mean,
            self.median,
            self.standard_deviation,
            self.rmse,
            self.nmad,
            self.percentile_95,
            self.min,
            self.max,
            self.skew,
        ]
    }

    /// Returns the statistics; `None` if there are no differences, or one is not finite.
    ///
    /// # Complexity
    /// O(n log n).
    pub fn of(differences: &[f64]) -> Option<Self> {
        let sorted = sorted(differences.iter().copied());
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        if !(min.is_finite() && max.is_finite()) {
            return None;
        }
        let count = sorted.len();
        let n = count as f64;
        let mean = sum(sorted.iter().copied()) / n;
        let median = quantile(&sorted, 0.5);
        let power = |exponent: i32| sum(sorted.iter().map(|d| (d - mean).powi(exponent)));
        let standard_deviation = match count {
            1 => f64::NAN,
            _ => (power(2) / (n - 1.0)).sqrt(),
        };
        let deviations = sorted.iter().map(|d| (d - median).abs());
        Some(ErrorStatistics {
            count,
            min,
            max,
            mean,
            median,
            standard_deviation,
            rmse: (sum(sorted.iter().map(|d| d * d)) / n).sqrt(),
            nmad: NORMAL * quantile(&self::sorted(deviations), 0.5),
            percentile_95: quantile(&self::sorted(sorted.iter().map(|d| d.abs())), 0.95),
            skew: match count > 2 && standard_deviation > 0.0 {
                true => n * power(3) / ((n - 1.0) * (n - 2.0) * standard_deviation.powi(3)),
                false => f64::NAN,
            },
        })
    }

    /// Returns the RMSE that a product is to be stated with, where the points themselves were
    /// surveyed with an RMSE: the root of the sum of both squares (ASPRS 2023, edition 2).
    pub fn rmse_with(&self, checkpoint_rmse: f64) -> f64 {
        self.rmse.hypot(checkpoint_rmse)
    }
}

/// How many values lie in each of some bins of equal width.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Histogram {
    /// Where the first bin begins, in the unit of the values: a multiple of the width.
    pub start: f64,
    /// The width of each bin: 1, 2 or 5 times a power of ten.
    pub width: f64,
    /// The values in each bin: those from its lower end on, without the upper one.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// Returns at most 21 bins for all values; `None` if there are no values, or one is not finite.
    ///
    /// # Complexity
    /// Linear.
    pub fn of(values: &[f64]) -> Option<Self> {
        let low = values.iter().copied().reduce(f64::min)?;
        let high = values.iter().copied().fold(low, f64::max);
        if !values.iter().all(|value| value.is_finite()) || !(high - low).is_finite() {
            return None;
        }
        let most = low.abs().max(high.abs());
        let width = match high - low > EQUAL * most {
            true => step((high - low) / MOST_BINS)?,
            false => step(most / MOST_BINS).unwrap_or(1.0),
        };
        let first = (low / width).floor();
        let bin = |value: f64| ((value / width).floor() - first).max(0.0) as usize;
        let mut counts = vec![0; bin(high) + 1];
        values.iter().for_each(|&value| {
            if let Some(count) = counts.get_mut(bin(value)) {
                *count += 1;
            }
        });
        Some(Histogram {
            start: first * width,
            width,
            counts,
        })
    }

    /// Returns where a bin begins, or where the last one ends.
    pub fn edge(&self, bin: usize) -> f64 {
        let first = (self.start / self.width).round();
        (first + bin as f64) * self.width
    }
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is at least a positive number.
fn step(least: f64) -> Option<f64> {
    let power = 10f64.powi(least.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    steps
        .into_iter()
        .find(|step| *step >= least)
        .filter(|step| step.is_normal())
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

/// Returns the value at a part of sorted values, linear between ranks.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let at = part * (sorted.len() - 1) as f64;
    let below = at.floor() as usize;
    let (low, high) = (sorted[below], sorted[(below + 1).min(sorted.len() - 1)]);
    low + (at - below as f64) * (high - low)
}

/// Returns a sum, with what each addition rounds off added at the end (Neumaier 1974).
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for value in values {
        let next = sum + value;
        lost += match sum.abs() >= value.abs() {
            true => (sum - next) + value,
            false => (value - next) + sum,
        };
        sum = next;
    }
    sum + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn near(found: f64, expected: f64, within: f64) {
        assert!(
            (found - expected).abs() <= within,
            "{found}, not {expected}"
        );
    }

    /// Residuals in elevation of seven checkpoints, with the standard deviation that is printed
    /// there: Photogrammetric Engineering and Remote Sensing 80 (5), May 2014, page 397, table 3.
    #[test]
    fn a_published_example() {
        let residuals = [0.055, -0.006, -0.017, 0.042, -0.011, 0.013, 0.048];
        let found = ErrorStatistics::of(&residuals).unwrap();
        assert_eq!(found.count, 7);
        near(found.standard_deviation, 0.030, 5e-4);
        // 0.124 / 7, and the root of 0.007 708 / 7.
        near(found.mean, 0.124 / 7.0, 1e-15);
        near(found.rmse, (0.007_708_f64 / 7.0).sqrt(), 1e-15);
        assert_eq!((found.median, found.min, found.max), (0.013, -0.017, 0.055));
    }

    #[test]
    fn small_samples_by_hand() {
        let found = ErrorStatistics::of(&[1.0, -2.0, 4.0, 3.0]).unwrap();
        assert_eq!((found.mean, found.median), (1.5, 2.0));
        near(found.rmse, 7.5_f64.sqrt(), 1e-15);
        near(found.standard_deviation, 7.0_f64.sqrt(), 1e-15);
        // Distances from the median: 1, 4, 2, 1.
        near(found.nmad, 1.4826 * 1.5, 1e-15);
        // Amounts 1, 2, 3, 4: 0.85 of the way from 3 to 4.
        near(found.percentile_95, 3.85, 1e-12);
        // Cubes of -0.5, -3.5, 2.5, 1.5: -24, times 4 / (3 * 2 * 7^1.5).
        near(found.skew, -96.0 / (6.0 * 7.0_f64.powf(1.5)), 1e-12);
        near(found.rmse_with(1.0), 8.5_f64.sqrt(), 1e-15);
    }

    #[test]
    fn statistics_do_not_depend_on_the_order_and_follow_the_unit() {
        let values: Vec<f64> = (0..200)
            .map(|i| f64::from(i * i % 83) / 7.0 - 3.0)
            .collect();
        let found = ErrorStatistics::of(&values).unwrap();
        let mut others = values.clone();
        others.reverse();
        others.rotate_left(61);
        assert_eq!(ErrorStatistics::of(&others), Some(found));
        let doubled: Vec<f64> = values.iter().map(|value| 2.0 * value).collect();
        let doubled = ErrorStatistics::of(&doubled).unwrap();
        assert_eq!(doubled.rmse, 2.0 * found.rmse);
        assert_eq!(doubled.nmad, 2.0 * found.nmad);
        assert_eq!(doubled.percentile_95, 2.0 * found.percentile_95);
        assert_eq!(doubled.skew, found.skew);
        // RMSE^2 = mean^2 + (n - 1) / n s^2
        let square = found.mean.powi(2) + 199.0 / 200.0 * found.standard_deviation.powi(2);
        near(found.rmse.powi(2), square, 1e-12);
    }

    #[test]
    fn few_or_equal_differences_have_no_spread() {
        assert_eq!(ErrorStatistics::of(&[]), None);
        assert_eq!(ErrorStatistics::of(&[1.0, f64::NAN]), None);
        assert_eq!(ErrorStatistics::of(&[f64::INFINITY]), None);
        let one = ErrorStatistics::of(&[-0.5]).unwrap();
        assert_eq!(
            (one.mean, one.rmse, one.nmad, one.percentile_95),
            (-0.5, 0.5, 0.0, 0.5)
        );
        assert!(one.standard_deviation.is_nan() && one.skew.is_nan());
        let equal = ErrorStatistics::of(&[2.0; 5]).unwrap();
        assert_eq!((equal.standard_deviation, equal.rmse), (0.0, 2.0));
        assert!(equal.skew.is_nan());
    }

    #[test]
    fn each_value_is_in_one_bin() {
        assert_eq!(Histogram::of(&[]), None);
        assert_eq!(Histogram::of(&[1.0, f64::NAN]), None);
        for values in [
            vec![0.0],
            vec![-0.07],
            vec![0.3, 0.3],
            vec![-1e-300, 1e-300],
            vec![-1e300, 1e300],
            (0..100)
                .map(|i| f64::from(i * 37 % 101) / 50.0 - 1.0)
                .collect(),
        ] {
            let found = Histogram::of(&values).unwrap();
            assert_eq!(found.counts.iter().sum::<usize>(), values.len());
            assert!(found.counts.len() <= 22, "{found:?}");
            let count = |bin: usize| {
                let is_in = |value: &&f64| {
                    let slack = 1e-9 * found.width;
                    found.edge(bin) - slack <= **value && **value <= found.edge(bin + 1) + slack
                };
                values.iter().filter(is_in).count()
            };
            assert!((0..found.counts.len()).all(|bin| count(bin) >= found.counts[bin]));
        }
        let nearly = [13.0 - 13.3, 11.0 - 11.3, 1.0 - 1.3];
        let found = Histogram::of(&nearly).unwrap();
        assert!(nearly[0] != nearly[2] && found.width == 0.02 && found.counts.len() <= 2);
        let found = Histogram::of(&[-0.02, 0.0, 0.019, 0.02, 0.1]).unwrap();
        assert_eq!((found.start, found.width), (-0.02, 0.01));
    }
}
