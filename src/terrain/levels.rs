use crate::data::{EXACT, in_decimals};
use crate::error::{Error, Plain, Result};
use crate::triangulation::num::unsigned_zero;

/// The largest number of levels in one run: far more than on any map, but few enough for memory.
pub const MAX_LEVELS: usize = 1_000_000;

/// The heights at which contours are drawn, in the units of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels(Choice);

#[derive(Debug, Clone, PartialEq)]
enum Choice {
    Every { interval: f64, base: f64 },
    Listed(Vec<f64>),
}

impl Levels {
    /// Creates the levels `base + k * interval` for every whole `k`.
    ///
    /// Each level is computed independently, so that rounding errors do not accumulate. If interval
    /// and base have at most nine decimals, a level is the double nearest to its decimal value: the
    /// third level of interval 0.1 is 0.3 as it is read from a text, not `3.0 * 0.1`, which is
    /// larger.
    ///
    /// # Errors
    /// If the interval is not positive and finite, or the base is not finite.
    pub fn every(interval: f64, base: f64) -> Result<Self> {
        if !(interval > 0.0 && interval.is_finite()) {
            return Err(Error::usage(format!(
                "contour interval is {interval}, expected a positive number"
            ))
            .cure("use a number above zero"));
        }
        if !base.is_finite() {
            return Err(Error::usage(format!(
                "contour base is {base}, expected a finite number"
            )));
        }
        Ok(Levels(Choice::Every { interval, base }))
    }

    /// Creates levels from a list in any order; duplicates are removed.
    ///
    /// # Errors
    /// If one is not finite, or there are more than [`MAX_LEVELS`].
    pub fn listed(levels: &[f64]) -> Result<Self> {
        if let Some(level) = levels.iter().find(|level| !level.is_finite()) {
            return Err(Error::usage(format!(
                "contour level is {level}, expected a finite number"
            )));
        }
        let mut levels: Vec<f64> = levels.iter().map(|&level| plain_zero(level)).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        if levels.len() > MAX_LEVELS {
            return Err(Error::limit(format!(
                "{} contour levels, expected at most {MAX_LEVELS}",
                levels.len()
            )));
        }
        Ok(Levels(Choice::Listed(levels)))
    }

    /// Returns the interval, or the smallest difference of listed levels; 1 if there are fewer than
    /// two.
    pub fn interval(&self) -> f64 {
        let step = self.smallest_step();
        if step.is_finite() { step } else { 1.0 }
    }

    /// Returns the smallest difference of two levels; infinity if there is one level at most.
    pub(super) fn smallest_step(&self) -> f64 {
        match &self.0 {
            Choice::Every { interval, .. } => *interval,
            Choice::Listed(levels) => smallest_difference(levels),
        }
    }

    /// Returns the difference of a level and the nearest other one; infinity if there is none.
    pub(super) fn step_around(&self, level: f64) -> f64 {
        match &self.0 {
            Choice::Every { interval, .. } => *interval,
            Choice::Listed(levels) => {
                let at = levels.partition_point(|&other| other < level);
                smallest_difference(&levels[at.saturating_sub(1)..levels.len().min(at + 2)])
            }
        }
    }

    /// Returns how many intervals a level is above the base, or its position in the list.
    pub(super) fn number_of(&self, level: f64) -> i64 {
        match &self.0 {
            Choice::Every { interval, base } => ((level - base) / interval).round() as i64,
            Choice::Listed(levels) => levels.partition_point(|&other| other < level) as i64,
        }
    }

    /// Returns the last level at a height or below, and the first one above; `None` where a list
    /// has no such level.
    pub(super) fn around(&self, height: f64) -> [Option<f64>; 2] {
        match &self.0 {
            Choice::Every { interval, base } => {
                let progression = Progression::new(*interval, *base);
                let near = ((height - base) / interval).floor();
                if near.abs() >= EXACT {
                    return [None; 2];
                }
                let around: Vec<f64> = (near as i64 - 1..=near as i64 + 2)
                    .map(|k| progression.level(k))
                    .collect();
                let above = around.partition_point(|&level| level <= height);
                [above.checked_sub(1), Some(above)].map(|k| around.get(k?).copied())
            }
            Choice::Listed(levels) => {
                let above = levels.partition_point(|&level| level <= height);
                [above.checked_sub(1), Some(above)].map(|k| levels.get(k?).copied())
            }
        }
    }

    /// Returns the levels from `low` to `high`, both included, ascending; none if `low > high`.
    ///
    /// # Errors
    /// If there are more than [`MAX_LEVELS`], or they are so far from the base that doubles cannot
    /// distinguish them.
    pub fn within(&self, low: f64, high: f64) -> Result<Vec<f64>> {
        match &self.0 {
            _ if low > high || low.is_nan() || high.is_nan() => Ok(Vec::new()),
            Choice::Every { interval, base } => every_within(*interval, *base, low, high),
            Choice::Listed(levels) => Ok(levels
                .iter()
                .copied()
                .filter(|&level| low <= level && level <= high)
                .collect()),
        }
    }
}

fn smallest_difference(levels: &[f64]) -> f64 {
    let differences = levels.windows(2).map(|pair| pair[1] - pair[0]);
    differences.fold(f64::INFINITY, f64::min)
}

fn every_within(interval: f64, base: f64, low: f64, high: f64) -> Result<Vec<f64>> {
    // One more on each side, because the quotients are rounded.
    let first = ((low - base) / interval).floor() - 1.0;
    let last = ((high - base) / interval).ceil() + 1.0;
    let steps = last - first;
    if steps > MAX_LEVELS as f64 + 4.0 {
        return Err(Error::limit(format!(
            "contour interval {} gives {} levels between {} and {}, at most {MAX_LEVELS} are drawn",
            Plain(interval),
            Plain((steps - 3.0).max(0.0)),
            Plain(low),
            Plain(high)
        ))
        .cure("use a larger interval, or list the levels"));
    }
    if !(first.abs() < EXACT && last.abs() < EXACT) {
        return Err(Error::usage(format!(
            "contour base {} is too far from the heights ({} to {}) for interval {}",
            Plain(base),
            Plain(low),
            Plain(high),
            Plain(interval)
        )));
    }
    let progression = Progression::new(interval, base);
    let mut levels: Vec<f64> = (first as i64..=last as i64)
        .map(|k| progression.level(k))
        .collect();
    levels.retain(|&level| low <= level && level <= high);
    levels.dedup();
    if levels.len() > MAX_LEVELS {
        return Err(Error::limit(format!(
            "contour interval {interval} gives {} levels between {low} and {high}, at most {MAX_LEVELS} are drawn",
            levels.len()
        ))
        .cure("use a larger interval, or list the levels"));
    }
    Ok(levels)
}

/// How `base + k * interval` is computed.
enum Progression {
    /// In whole multiples of `1 / unit`, where `unit` is a power of ten.
    Decimal {
        interval: i64,
        base: i64,
        unit: f64,
    },
    Binary {
        interval: f64,
        base: f64,
    },
}

impl Progression {
    fn new(interval: f64, base: f64) -> Self {
        match in_decimals([interval, base]) {
            Some((whole, unit)) => {
                let [interval, base] = whole.map(|count| count as i64);
                Progression::Decimal {
                    interval,
                    base,
                    unit,
                }
            }
            None => Progression::Binary { interval, base },
        }
    }

    fn level(&self, k: i64) -> f64 {
        plain_zero(match *self {
            Progression::Decimal {
                interval,
                base,
                unit,
            } => {
                // Below 2^107, and rounded only above 2^53.
                (i128::from(k) * i128::from(interval) + i128::from(base)) as f64 / unit
            }
            Progression::Binary { interval, base } => (k as f64).mul_add(interval, base),
        })
    }
}

/// Replaces -0 by 0, so that equal levels are written alike.
fn plain_zero(value: f64) -> f64 {
    unsigned_zero(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;

    fn within(interval: f64, base: f64, low: f64, high: f64) -> Vec<f64> {
        Levels::every(interval, base)
            .unwrap()
            .within(low, high)
            .unwrap()
    }

    #[test]
    fn both_ends_are_included() {
        assert_eq!(within(1.0, 0.0, 2.0, 5.0), [2.0, 3.0, 4.0, 5.0]);
        assert_eq!(within(5.0, 2.0, -9.0, 8.0), [-8.0, -3.0, 2.0, 7.0]);
        assert_eq!(within(1.0, 0.0, 2.25, 2.75), [0.0; 0]);
        assert_eq!(within(1.0, 0.0, 3.0, 3.0), [3.0]);
        assert_eq!(within(1.0, 0.0, f64::INFINITY, f64::NEG_INFINITY), [0.0; 0]);
    }

    #[test]
    fn decimal_levels_are_those_that_one_types() {
        for (interval, decimals) in [(0.1, 1), (0.05, 2), (0.3048, 4), (0.7, 1)] {
            for (i, level) in within(interval, 0.0, 0.0, 100.0 * interval)
                .iter()
                .enumerate()
            {
                let typed: f64 = format!("{:.decimals$}", i as f64 * interval)
                    .parse()
                    .unwrap();
                assert_eq!(level.to_bits(), typed.to_bits(), "{i} times {interval}");
            }
        }
    }

    #[test]
    fn zero_has_no_sign() {
        assert!(within(1.0, -0.0, -1.0, 1.0)[1].is_sign_positive());
        assert!(Levels::listed(&[-0.0]).unwrap().within(-1.0, 1.0).unwrap()[0].is_sign_positive());
    }

    #[test]
    fn a_list_is_sorted_and_each_level_counts_once() {
        let levels = Levels::listed(&[3.0, 1.0, 0.0, 3.0, -0.0, 9.0]).unwrap();
        assert_eq!(levels.within(0.0, 3.0).unwrap(), [0.0, 1.0, 3.0]);
    }

    #[test]
    fn nonsense_is_refused() {
        for interval in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(
                Levels::every(interval, 0.0).unwrap_err().kind(),
                Kind::Usage
            );
        }
        assert_eq!(
            Levels::every(1.0, f64::NAN).unwrap_err().kind(),
            Kind::Usage
        );
        assert_eq!(
            Levels::listed(&[1.0, f64::NAN]).unwrap_err().kind(),
            Kind::Usage
        );
        assert_eq!(
            Levels::every(1.0, 1e300)
                .unwrap()
                .within(0.0, 9.0)
                .unwrap_err()
                .kind(),
            Kind::Usage
        );
    }

    #[test]
    fn too_many_levels_are_counted_and_refused() {
        let error = Levels::every(1e-4, 0.0)
            .unwrap()
            .within(0.0, 1000.0)
            .unwrap_err();
        assert_eq!(error.kind(), Kind::Limit);
        assert!(
            error.to_string().contains("0.0001") && error.to_string().contains("1000000"),
            "{error}"
        );
        assert_eq!(
            Levels::every(f64::MIN_POSITIVE, 0.0)
                .unwrap()
                .within(0.0, 1.0)
                .unwrap_err()
                .kind(),
            Kind::Limit
        );
        assert_eq!(within(1.0, 0.0, 1.0, 1_000_000.0).len(), MAX_LEVELS);
    }
}
