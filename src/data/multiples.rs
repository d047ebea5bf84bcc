//! Multiples of numbers that are written in decimals.

/// The most decimals that a step is looked for in.
const DECIMALS: i32 = 9;

/// Whole numbers up to this are exact.
const MOST: f64 = (1_u64 << 53) as f64;

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
        let in_decimals = (0..=DECIMALS).find_map(|digits| {
            let over = 10_f64.powi(digits);
            let whole = (step * over).round();
            (whole / over == step && whole.abs() < MOST).then_some(Multiples { whole, over })
        });
        in_decimals.unwrap_or(Multiples {
            whole: step,
            over: 1.0,
        })
    }

    /// Returns the multiple with a whole number: the double nearest to it, if that number is not
    /// huge.
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
        // What is no decimal number is multiplied.
        let third = 1.0 / 3.0;
        assert_eq!(Multiples::of(third).at(7.0), 7.0 * third);
        assert!(Multiples::of(f64::NAN).at(1.0).is_nan());
    }
}
