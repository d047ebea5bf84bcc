/// Which height is used where several points share a site in plan.
///
/// With [`Lowest`](Self::Lowest), [`Highest`](Self::Highest) and [`Mean`](Self::Mean) the result
/// does not depend on the order of the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DuplicateRule {
    /// The lowest: remaining vegetation and noise lie above the ground.
    #[default]
    Lowest,
    /// The highest.
    Highest,
    /// The mean; heights are summed in ascending order.
    Mean,
    /// The first in the input.
    First,
    /// The last in the input.
    Last,
}

impl DuplicateRule {
    /// Returns the height to use, given the heights in the order of the input. May reorder them.
    ///
    /// # Panics
    /// If `heights` is empty.
    pub(super) fn choose(self, heights: &mut [f64]) -> f64 {
        match self {
            DuplicateRule::First => heights[0],
            DuplicateRule::Last => heights[heights.len() - 1],
            DuplicateRule::Lowest => heights.iter().copied().fold(f64::INFINITY, f64::min),
            DuplicateRule::Highest => heights.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            DuplicateRule::Mean => {
                heights.sort_unstable_by(f64::total_cmp);
                heights.iter().sum::<f64>() / heights.len() as f64
            }
        }
    }
}
