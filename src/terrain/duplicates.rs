use crate::error::{Error, Result};
use crate::triangulation::num::unsigned_zero;
use crate::triangulation::spatial_order;

/// Which height is used where several points share a site in plan.
///
/// With [`Lowest`](Self::Lowest), [`Highest`](Self::Highest) and [`Mean`](Self::Mean) the result
/// does not depend on the order of the input.
///
/// Where lines have a vertex at the site, the points do not count: the rule chooses among the
/// heights of the lines, of those kinds that count first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
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

/// Returns one point for each site, in spatial order, with the height of a rule.
///
/// # Errors
/// If there are more points than 32-bit numbers can count.
///
/// # Complexity
/// O(n log n).
pub(crate) fn one_per_site(points: &[[f64; 3]], rule: DuplicateRule) -> Result<Vec<[f64; 3]>> {
    // Neither zero is the lower one.
    let site = |i: u32| [0, 1].map(|k| unsigned_zero(points[i as usize][k]));
    let order =
        spatial_order(points.len(), |i| site(i as u32)).map_err(|e| Error::limit(e.to_string()))?;
    let mut heights = Vec::new();
    let of_site = |group: &[u32]| {
        heights.clear();
        heights.extend(group.iter().map(|&i| unsigned_zero(points[i as usize][2])));
        let [x, y] = site(group[0]);
        [x, y, rule.choose(&mut heights)]
    };
    Ok(order
        .chunk_by(|&i, &j| site(i) == site(j))
        .map(of_site)
        .collect())
}
