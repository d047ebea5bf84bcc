//! The nearest point of a segment.

/// Returns the part of a segment, from 0 to 1, at which it is nearest to a position; 0 if it has no
/// length.
pub(super) fn nearest_part([a, b]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let part = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length;
    if part.is_finite() {
        part.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Returns the square of the distance between a segment and a position.
pub(super) fn squared_distance([a, b]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> f64 {
    let part = nearest_part([a, b], [x, y]);
    let away = [
        a[0] + part * (b[0] - a[0]) - x,
        a[1] + part * (b[1] - a[1]) - y,
    ];
    away[0] * away[0] + away[1] * away[1]
}

/// Returns the part of a segment at which the line through two positions passes it, from 0 to 1, or
/// outside of that if it does not pass the segment.
pub(super) fn part_before([from, to]: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let turn = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let [before, after] = [turn(from), turn(to)];
    before / (before - after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_count_and_so_does_the_foot_between() {
        let segment = [[0.0, 0.0], [4.0, 0.0]];
        for (q, part, squared) in [
            ([1.0, 2.0], 0.25, 4.0),
            ([-3.0, 4.0], 0.0, 25.0),
            ([5.0, 0.0], 1.0, 1.0),
            ([2.0, 0.0], 0.5, 0.0),
        ] {
            assert_eq!(
                (nearest_part(segment, q), squared_distance(segment, q)),
                (part, squared),
                "{q:?}"
            );
        }
        assert_eq!(nearest_part([[1.0, 1.0]; 2], [4.0, 5.0]), 0.0);
        assert_eq!(squared_distance([[1.0, 1.0]; 2], [4.0, 5.0]), 25.0);
    }
}
