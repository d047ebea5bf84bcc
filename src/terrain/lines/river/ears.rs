//! Triangles of a simple polygon.

use super::{contains, flat};
use crate::data::orientation;
use crate::triangulation::num::Sign;

/// Divides a simple polygon into triangles between its vertices; `None` if it is not simple.
///
/// # Complexity
/// Quadratic in the number of vertices, cubic at worst.
pub(super) fn ears(polygon: &[[f64; 3]]) -> Option<Vec<[[f64; 3]; 3]>> {
    let mut left = polygon.to_vec();
    let direction = turning(&left)?;
    let mut triangles = Vec::with_capacity(left.len());
    while left.len() > 3 {
        let count = left.len();
        let corner = |k: usize| [left[(k + count - 1) % count], left[k], left[(k + 1) % count]];
        let is_ear = |k: &usize| {
            let corners = corner(*k);
            let is_own = |p: &[f64; 3]| corners.iter().any(|corner| flat(*corner) == flat(*p));
            orientation(corners) == direction && !left.iter().any(|p| !is_own(p) && contains(corners, flat(*p)))
        };
        let ear = (0..count).find(is_ear)?;
        triangles.push(corner(ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}

/// The direction in which a polygon turns at its lowest vertex; `None` if it has no area there.
fn turning(polygon: &[[f64; 3]]) -> Option<Sign> {
    let count = polygon.len();
    let lowest = (0..count)
        .min_by(|&p, &q| polygon[p][1].total_cmp(&polygon[q][1]).then(polygon[p][0].total_cmp(&polygon[q][0])))?;
    let turn = orientation([polygon[(lowest + count - 1) % count], polygon[lowest], polygon[(lowest + 1) % count]]);
    (count > 2 && turn != Sign::Zero).then_some(turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_cover_the_polygon_once() {
        let bent = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [3.0, 1.0], [2.0, 1.0], [1.0, 1.5], [0.0, 3.0]]
            .map(|[x, y]| [x, y, x]);
        let mut turned = bent;
        turned.reverse();
        for polygon in [bent, turned] {
            let triangles = ears(&polygon).unwrap();
            assert_eq!(triangles.len(), 5);
            let area: f64 = triangles
                .iter()
                .map(|[a, b, c]| ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0)
                .sum();
            assert!((area - 6.5).abs() < 1e-12, "{area}");
        }
        assert_eq!(ears(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), None);
        let eight = [[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]].map(|[x, y]| [x, y, 0.0]);
        assert!(ears(&eight).is_none_or(|triangles| triangles.len() == 2));
    }
}
