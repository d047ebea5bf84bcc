//! Sizes as people write them.

/// Less does not suffice for the program itself.
const LEAST_MEMORY: f64 = 16e6;

/// Parses a number of bytes of memory, such as `500MB` or `1.5GiB`.
///
/// # Errors
/// Says what was expected.
pub fn memory_of(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let factor = match unit.trim().to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kb" => 1e3,
        "m" | "mb" => 1e6,
        "g" | "gb" => 1e9,
        "t" | "tb" => 1e12,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => {
            return Err(format!(
                "`{unit}` is not a unit of memory; expected a size such as 500MB, 2GB or 2GiB"
            ));
        }
    };
    match number.parse::<f64>() {
        Ok(count) if count * factor >= LEAST_MEMORY && count * factor < 1e18 => {
            Ok((count * factor) as u64)
        }
        Ok(_) => Err("expected at least 16MB".to_owned()),
        Err(_) => Err(format!(
            "`{text}` is not a size; expected one such as 500MB, 2GB or 2GiB"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_understood() {
        assert_eq!(memory_of("64MB"), Ok(64_000_000));
        assert_eq!(memory_of("1.5 GiB"), Ok(1_610_612_736));
        assert_eq!(memory_of("16000000"), Ok(16_000_000));
        for wrong in ["2XB", "GB", "1MB", "-5GB", "1e3MB"] {
            assert!(memory_of(wrong).is_err(), "{wrong}");
        }
    }
}
