use std::fmt;

/// A number displayed with the fewest digits that read back as the same double. Where plain
/// notation would be long, an exponent is used: readers of Triangle's files accept about a thousand
/// bytes per line.
pub(crate) struct Decimal(pub(crate) f64);

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.abs();
        if magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Decimal;

    #[test]
    fn the_same_double_comes_back() {
        for x in [
            0.0,
            -0.0,
            0.1,
            -1.5,
            1e-5,
            9.9e-6,
            1e15,
            1e16,
            1.0 / 3.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
        ] {
            for x in [x, -x, x.next_up().min(f64::MAX)] {
                let text = Decimal(x).to_string();
                assert_eq!(
                    text.parse::<f64>().unwrap().to_bits(),
                    x.to_bits(),
                    "{text}"
                );
                assert!(text.len() < 26, "{text}");
            }
        }
        assert_eq!(Decimal(512_000.5).to_string(), "512000.5");
        assert_eq!(Decimal(1e300).to_string(), "1e300");
    }
}
