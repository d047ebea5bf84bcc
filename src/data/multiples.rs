//! Multiples of numbers that are written in decimals.

/// The most decimals that are looked for.
const DECIMALS: i32 = 9;

/// Whole numbers up to this are exact in an `f64`.
pub(crate) const EXACT: f64 = (1_u64 << 53) as f64;

/// Returns numbers times a power of ten, the least by which all of them are whole, and that power;
/// `None` if one has more than nine decimals or too many digits.
pub(crate) fn in_decimals<const N: usize>(numbers: [f64; N]) -> Option<([f64; N], f64)> {
    (0..=DECIMALS).find_map(|digits| {
        let over = 10_f64.powi(digits);
        let whole = numbers.map(|number| (number * over).round());
        let is_exact = |k: usize| whole[k] / over == numbers[k] && whole[k].abs() < EXACT;
        (0..N).all(is_exact).then_some((whole, over))
    })
}

/// The multiples of a step, as they are written: three times 0.1 is 0.3, and not
/// 0.30000000000000004.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Multiples {
    /// The step times `over`, a power of ten.
    whole: f64,
    over: f64,
}

impl Multiples {
    /// Returns the multiples of a step.
    pub(crate) fn of(step: f64) -> Self {
        let ([whole], over) = in_decimals([step]).unwrap_or(([step], 1.0));
        Multiples { whole, over }
    }

    /// Returns the step times a whole number: the double nearest to the product in decimals, if
    /// that has at most 15 digits.
    pub(crate) fn at(self, number: f64) -> f64 {
        number * self.whole / self.over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_are_as_they_are_written() {
        for (step, digits) in [
            (0.1, 1),
            (0.7, 1),
            (2.5, 1),
            (0.025, 3),
            (20.0, 0),
            (1e-9, 9),
        ] {
            for number in -2000..2000 {
                let found = Multiples::of(step).at(f64::from(number));
                let written = format!("{:.digits$}", f64::from(number) * step);
                assert_eq!(found, written.parse::<f64>().unwrap(), "{number} x {step}");
            }
        }
        assert_ne!(3.0 * 0.1, Multiples::of(0.1).at(3.0));
        // A step with more decimals is multiplied as it is.
        let third = 1.0 / 3.0;
        assert_eq!(Multiples::of(third).at(7.0), 7.0 * third);
        assert!(Multiples::of(f64::NAN).at(1.0).is_nan());
    }
}
