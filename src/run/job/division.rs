//! Which tiles there are, as somebody asks for them.

use std::str::FromStr;

/// Which tiles there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Division {
    /// The files, if they are separate and small enough; else tiles with about as many points each
    /// as fit into memory.
    #[default]
    Auto,
    /// This many columns and rows of tiles.
    Grid([usize; 2]),
}

/// The most tiles: each takes some hundred bytes of the plan.
const MOST_TILES: usize = 1_000_000;

/// Parses `auto`, or columns and rows, such as `8x8`.
impl FromStr for Division {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("auto") {
            return Ok(Division::Auto);
        }
        let count = |text: &str| {
            text.trim()
                .parse()
                .ok()
                .filter(|count| (1..=MOST_TILES).contains(count))
        };
        let counts = text
            .split_once(['x', 'X'])
            .and_then(|(columns, rows)| Some([count(columns)?, count(rows)?]));
        let counts = counts.filter(|[columns, rows]| columns * rows <= MOST_TILES);
        counts.map(Division::Grid).ok_or_else(|| {
            format!("expected `auto`, or columns and rows, such as `8x8`: up to {MOST_TILES} tiles")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_understood() {
        assert_eq!("8x3".parse(), Ok(Division::Grid([8, 3])));
        assert_eq!("AUTO".parse(), Ok(Division::Auto));
        for wrong in ["8", "0x3", "3x", "axb", "2000000x1", "2000x2000"] {
            assert!(wrong.parse::<Division>().is_err(), "{wrong}");
        }
    }
}
