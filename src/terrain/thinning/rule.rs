//! Rules to thin points by.

use crate::error::{Error, Result, Setting, wording};

/// Which points of a cloud are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thinning {
    /// One point of each square cell in plan. Cells begin at multiples of their size, so that those
    /// of several files agree.
    Grid {
        /// The side of a cell, in units of the coordinates.
        size: f64,
        /// The point of a cell that is kept.
        keep: CellPoint,
    },
    /// Points that are at least a distance apart in plan; each other point is closer than that to
    /// one of them. Points are taken in a pseudo-random order of positions.
    Poisson {
        /// The distance, in units of the coordinates.
        distance: f64,
        /// Each seed has its own order.
        seed: u64,
    },
    /// The first point, and each n-th one after it.
    Nth(u64),
    /// A share of the points, by a hash of their positions. A smaller share is a part of a larger
    /// one with the same seed.
    Random {
        /// The share, above 0 and at most 1.
        share: f64,
        /// Each seed makes its own choice.
        seed: u64,
    },
}

/// Which point of a cell is kept. Of several, the one of the smallest x, then y, then z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CellPoint {
    /// The point nearest to the center of the cell, in plan.
    #[default]
    Center,
    /// The lowest point.
    Lowest,
    /// The highest point.
    Highest,
}

impl Thinning {
    /// Parses `grid:SIZE`, `poisson:DISTANCE`, `nth:N` or `random:SHARE`, with the point nearest to
    /// the center of a cell and the seed 0; see [`with`](Self::with) for others.
    ///
    /// # Errors
    /// If the text is none of these, or the number is not in the range of the rule; the error says
    /// what is expected.
    pub fn parse(text: &str) -> std::result::Result<Self, String> {
        let text = text.trim();
        let unknown = || {
            format!(
                "`{text}` is no thinning: expected `grid:SIZE`, `poisson:DISTANCE`, `nth:N` or `random:SHARE`"
            )
        };
        let (rule, value) = text.split_once(':').ok_or_else(unknown)?;
        let value = value.trim();
        let number = || {
            value
                .parse::<f64>()
                .map_err(|_| format!("`{value}` is not a number"))
        };
        let seed = 0;
        let thinning = match rule.trim().to_ascii_lowercase().as_str() {
            "grid" => Thinning::Grid {
                size: number()?,
                keep: CellPoint::default(),
            },
            "poisson" => Thinning::Poisson {
                distance: number()?,
                seed,
            },
            "nth" => Thinning::Nth(value.parse().map_err(|_| {
                format!("`{value}` is not a whole number above zero that fits into 64 bits")
            })?),
            "random" => Thinning::Random {
                share: number()?,
                seed,
            },
            _ => return Err(unknown()),
        };
        thinning.flaw().map_or(Ok(thinning), Err)
    }

    /// Returns the rule with another point of each cell, or another seed.
    ///
    /// # Errors
    /// If the rule has no cells, or no seed.
    pub fn with(mut self, keep: Option<CellPoint>, seed: Option<u64>) -> Result<Self> {
        if let Some(wanted) = keep {
            let Thinning::Grid { keep, .. } = &mut self else {
                return Err(Error::usage(wording![
                    Setting::ThinKeep,
                    " chooses the point of a cell, but there are no cells"
                ])
                .cure(wording![
                    "leave it out, or use ",
                    Setting::Thin.text("grid:SIZE")
                ]));
            };
            *keep = wanted;
        }
        if let Some(wanted) = seed {
            let (Thinning::Poisson { seed, .. } | Thinning::Random { seed, .. }) = &mut self else {
                return Err(Error::usage(wording![
                    Setting::Seed,
                    " is of pseudo-random choices, and this thinning has none"
                ])
                .cure(wording![
                    "leave it out, or use ",
                    Setting::Thin.text("poisson:DISTANCE"),
                    " or ",
                    Setting::Thin.text("random:SHARE")
                ]));
            };
            *seed = wanted;
        }
        Ok(self)
    }

    /// Returns what is wrong with the number of the rule, if anything.
    pub(super) fn flaw(&self) -> Option<String> {
        match *self {
            Thinning::Grid { size, .. } => of_length(size, "the size of a cell"),
            Thinning::Poisson { distance, .. } => of_length(distance, "the distance"),
            Thinning::Nth(0) => Some("every 0th point: expected a whole number above zero".into()),
            Thinning::Random { share, .. } if !(share > 0.0 && share <= 1.0) => Some(format!(
                "{share} is not a share of points: expected a number above 0, at most 1"
            )),
            Thinning::Nth(_) | Thinning::Random { .. } => None,
        }
    }
}

fn of_length(length: f64, what: &str) -> Option<String> {
    let is_length = length > 0.0 && length.is_finite();
    (!is_length).then(|| format!("{what} is {length}: expected a finite number above zero"))
}
