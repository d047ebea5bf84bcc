/// Which height stands where several points share one place in plan.
///
/// Under the first three the result does not depend on the order of the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DuplicateRule {
    /// The lowest: what is left of vegetation and noise lies above the ground.
    #[default]
    Lowest,
    /// The highest.
    Highest,
    /// The mean, summed from the lowest up.
    Mean,
    /// The one that came first.
    First,
    /// The one that came last.
    Last,
}

impl DuplicateRule {
    /// The height that stands, of heights in order of appearance. Sorts them where that helps.
    ///
    /// # Panics
    /// If there is none.
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
