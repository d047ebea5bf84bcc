//! Lines parallel to others.

/// How much farther than the distance a corner may be, as a factor: sharper corners are cut off.
const LONGEST_MITER: f64 = 2.0;

/// Returns a line parallel to one in plan, at a distance to its left (to its right if negative),
/// with a vertex for each of its vertices. A line that ends where it begins stays closed.
///
/// Corners are mitered. Consecutive vertices must differ in plan.
///
/// # Complexity
/// Linear.
pub(super) fn offset(line: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    let normals: Vec<[f64; 2]> = line.windows(2).map(|pair| normal([pair[0], pair[1]])).collect();
    let (Some(&first), Some(&last)) = (normals.first(), normals.last()) else { return Vec::new() };
    let is_closed = line.len() > 2 && line.first() == line.last();
    let at = |k: usize| {
        let before = k.checked_sub(1).map_or(if is_closed { last } else { first }, |k| normals[k]);
        let after = normals.get(k).copied().unwrap_or(if is_closed { first } else { last });
        let sum = [before[0] + after[0], before[1] + after[1]];
        // The miter is 1 / cos(half the turn), and the sum of the normals twice that cosine.
        let half_cosine = sum[0].hypot(sum[1]) / 2.0;
        let scale = distance / half_cosine.max(1.0 / LONGEST_MITER);
        let direction = if half_cosine > 0.0 { sum.map(|c| c / (2.0 * half_cosine)) } else { after };
        [line[k][0] + scale * direction[0], line[k][1] + scale * direction[1]]
    };
    (0..line.len()).map(at).collect()
}

/// The unit vector to the left of a segment.
fn normal([[ax, ay], [bx, by]]: [[f64; 2]; 2]) -> [f64; 2] {
    let length = (bx - ax).hypot(by - ay);
    [-(by - ay) / length, (bx - ax) / length]
}

#[cfg(test)]
mod tests {
    use super::offset;

    #[test]
    fn corners_are_mitered() {
        let line = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]];
        assert_eq!(offset(&line, 1.0), [[0.0, 1.0], [3.0, 1.0], [3.0, 4.0]].map(near(&offset(&line, 1.0))));
        assert_eq!(offset(&line, -1.0), [[0.0, -1.0], [5.0, -1.0], [5.0, 4.0]].map(near(&offset(&line, -1.0))));
    }

    #[test]
    fn a_ring_stays_closed_and_a_hairpin_is_cut_off() {
        let ring = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let inner = offset(&ring, 1.0);
        assert_eq!(inner[0], inner[4]);
        assert_eq!(inner, [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [1.0, 1.0]].map(near(&inner)));
        let hairpin = offset(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0001]], 1.0);
        assert!((hairpin[1][0] - 4.0).hypot(hairpin[1][1]) < 2.001);
        assert!(offset(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0]], 1.0).iter().flatten().all(|c| c.is_finite()));
        assert!(offset(&[[1.0, 1.0]], 1.0).is_empty());
    }

    /// Maps an expected point to the computed one that is within a rounding of it.
    fn near(computed: &[[f64; 2]]) -> impl Fn([f64; 2]) -> [f64; 2] + '_ {
        |[x, y]| *computed.iter().find(|p| (p[0] - x).hypot(p[1] - y) < 1e-12).unwrap_or(&[x, y])
    }
}
