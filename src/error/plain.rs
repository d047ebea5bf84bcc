/// From here on, and below its inverse, numbers are written with an exponent.
pub(crate) const MANY_DIGITS: f64 = 1e17;

/// A number for a message: digit by digit, unless there were more of them than can be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plain(pub f64);

impl std::fmt::Display for Plain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Plain(value) = self;
        let size = value.abs();
        if size >= MANY_DIGITS || size != 0.0 && size < 1.0 / MANY_DIGITS {
            write!(f, "{value:e}")
        } else {
            write!(f, "{value}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_has_three_hundred_digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.25, "-0.25"),
            (1e16, "10000000000000000"),
            (-1e300, "-1e300"),
            (2.5e-300, "2.5e-300"),
            (f64::INFINITY, "inf"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(Plain(value).to_string(), text);
        }
    }
}
