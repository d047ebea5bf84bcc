//! What becomes of crossings.

use crate::arrangement::Arrangement;

/// What to do with lines that cross between their vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnCrossing {
    /// Returns an error that names the first crossing; nothing is triangulated.
    Reject,
    /// Gives them a common vertex, rounded to the grid.
    #[default]
    Split,
}

/// How the crossings of lines were rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rounding {
    /// The unit of the grid on each axis: the last place of the largest coordinate of a line's
    /// vertex.
    pub unit: [f64; 2],
    /// True if all vertices of lines, and all points on lines that cross others, lie on the grid.
    /// Then each line is displaced by at most half a unit on each axis; this is proven.
    pub on_grid: bool,
}

impl Rounding {
    /// Returns how an arrangement rounded crossings; `None` without any.
    pub(crate) fn of(arrangement: &Arrangement) -> Option<Self> {
        let has_crossings = !arrangement.crossings().is_empty();
        has_crossings.then(|| Rounding {
            unit: arrangement.unit(),
            on_grid: arrangement.is_on_grid(),
        })
    }
}
