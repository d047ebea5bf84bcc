//! Additional vertices on lines.

/// Returns a line with additional vertices, evenly spaced on each segment, so that no two are
/// farther apart in plan than `spacing`. Heights are linear between the given vertices, which stay
/// as they are.
///
/// Returns the line itself if `spacing` is not a number above zero.
///
/// # Complexity
/// Linear in the number of vertices of the result.
pub fn densified(line: &[[f64; 3]], spacing: f64) -> Vec<[f64; 3]> {
    let Some((first, rest)) = line.split_first() else {
        return Vec::new();
    };
    let mut dense = vec![*first];
    let mut from = *first;
    for &to in rest {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let count = if spacing > 0.0 && length.is_finite() {
            (length / spacing).ceil().clamp(1.0, MOST)
        } else {
            1.0
        };
        let inner = (1..count as u32).map(|k| f64::from(k) / count);
        dense.extend(
            inner.map(|part| [0, 1, 2].map(|axis| from[axis] + part * (to[axis] - from[axis]))),
        );
        dense.push(to);
        from = to;
    }
    dense
}

/// The largest number of parts of a segment: a mistyped spacing must not fill the memory.
const MOST: f64 = 1e6;

#[cfg(test)]
mod tests {
    use super::densified;

    #[test]
    fn no_segment_is_longer_than_the_spacing() {
        let line = [[0.0, 0.0, 0.0], [3.0, 4.0, 10.0], [3.0, 5.0, 0.0]];
        let dense = densified(&line, 2.0);
        assert_eq!(dense.len(), 5);
        let expected = [5.0 / 3.0, 5.0 / 3.0, 5.0 / 3.0, 1.0];
        for (pair, length) in dense.windows(2).zip(expected) {
            assert!(
                ((pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]) - length).abs() < 1e-12
            );
        }
        assert!((dense[1][2] - 10.0 / 3.0).abs() < 1e-12);
        assert_eq!([dense[0], dense[3], dense[4]], line);
    }

    #[test]
    fn without_a_spacing_the_line_stays() {
        let line = [[0.0, 0.0, 0.0], [9.0, 0.0, 1.0]];
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY, 9.0] {
            assert_eq!(densified(&line, spacing), line);
        }
        assert_eq!(densified(&[], 1.0), Vec::<[f64; 3]>::new());
    }
}
