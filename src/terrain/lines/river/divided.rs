//! Triangles of a simple polygon.

use crate::terrain::arranged::arranged;
use crate::triangulation::tds::VertexId;

/// Divides a simple polygon into triangles between its vertices; `None` if it has no area.
///
/// # Complexity
/// O(n log n) for n vertices.
pub(super) fn divided(polygon: &[[f64; 3]]) -> Option<Vec<[[f64; 3]; 3]>> {
    let count = polygon.len() as u32;
    let sides: Vec<[u32; 2]> = (0..count).map(|k| [k, (k + 1) % count]).collect();
    let triangulation = arranged(polygon, &sides).ok()?;
    if triangulation.dimension() != 2 {
        return None;
    }
    let tds = triangulation.tds();
    // From outside across the sides of the polygon, so that rounding decides nothing.
    let mut is_inside: Vec<Option<bool>> = vec![None; tds.cell_slots()];
    let mut next = vec![(tds.cell_of(VertexId::INFINITE)?, false)];
    while let Some((cell, inside)) = next.pop() {
        if is_inside[cell.index()].replace(inside).is_none() {
            let beyond = |side: usize| {
                (
                    tds.neighbor(cell, side),
                    inside != triangulation.is_constrained(cell, side),
                )
            };
            next.extend([0, 1, 2].map(beyond));
        }
    }
    let cells = tds
        .cells()
        .filter(|cell| is_inside[cell.index()] == Some(true));
    Some(
        cells
            .map(|cell| tds.corners(cell).map(|vertex| *triangulation.point(vertex)))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::orientation;
    use crate::triangulation::num::Sign;

    #[test]
    fn triangles_cover_the_polygon_once() {
        let bent = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [3.0, 1.0],
            [2.0, 1.0],
            [1.0, 1.5],
            [0.0, 3.0],
        ]
        .map(|[x, y]| [x, y, x]);
        let mut turned = bent;
        turned.reverse();
        for polygon in [bent, turned] {
            let triangles = divided(&polygon).unwrap();
            assert_eq!(triangles.len(), 5);
            assert!(
                triangles
                    .iter()
                    .flatten()
                    .all(|corner| polygon.contains(corner))
            );
            let area: f64 = triangles
                .iter()
                .map(|[a, b, c]| {
                    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0
                })
                .sum();
            assert!((area - 6.5).abs() < 1e-12, "{area}");
        }
        assert_eq!(divided(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), None);
    }

    /// A vertex that rounding put beside a side: the triangle between them is outside.
    #[test]
    fn triangles_as_thin_as_rounding_are_on_the_right_side() {
        let area = |[a, b, c]: [[f64; 3]; 3]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        for part in (1..50).map(|k| f64::from(k) / 50.0) {
            for nudge in [f64::next_up, f64::next_down] {
                let beside = [33.0 + 0.7 * part, nudge(4.81 - 0.13 * part), 1.0];
                let polygon = [
                    [33.0, 4.81, 1.0],
                    beside,
                    [33.7, 4.68, 1.0],
                    [33.7, -11.0, 9.0],
                    [31.5, -11.0, 9.0],
                ];
                let triangles = divided(&polygon).unwrap();
                let thin = triangles
                    .iter()
                    .filter(|corners| area(**corners).abs() < 1e-9)
                    .count();
                let is_dent = orientation([polygon[0], polygon[1], polygon[2]]) == Sign::Positive;
                assert!(!is_dent || thin == 0, "{beside:?}");
            }
        }
    }
}
