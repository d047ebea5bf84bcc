use super::join::Joined;
use crate::data::ContourLine;

/// The line without pieces that vanished when its points were rounded, begun at a point that its
/// shape alone decides; none if nothing is left.
pub(super) fn finish(level: f64, line: Joined) -> Option<ContourLine> {
    let mut points = line.points;
    cancel(&mut points);
    if line.closed {
        points.pop();
        cancel_around(&mut points);
        start_at_smallest(&mut points);
        points.extend_from_within(..points.len().min(1));
    }
    (points.len() > 1).then_some(ContourLine { level, points })
}

/// Removes pieces of no length, and a way there with the way back on it, again and again.
fn cancel(points: &mut Vec<[f64; 2]>) {
    let mut kept = 0;
    for i in 0..points.len() {
        let point = points[i];
        if kept > 0 && points[kept - 1] == point {
            continue;
        }
        if kept > 1 && points[kept - 2] == point {
            kept -= 1;
            continue;
        }
        points[kept] = point;
        kept += 1;
    }
    points.truncate(kept);
}

/// The same where the end of a ring (its first point not repeated) meets its beginning.
fn cancel_around(ring: &mut Vec<[f64; 2]>) {
    let (mut first, mut end) = (0, ring.len());
    while end - first > 1 && ring[first] == ring[end - 1] {
        end -= 1;
    }
    while end - first > 2 {
        if ring[first + 1] == ring[end - 1] {
            // There and back, turning at the first point.
            first += 1;
            end -= 1;
        } else if ring[first] == ring[end - 2] {
            // Turning at the last point.
            end -= 2;
        } else {
            break;
        }
    }
    let left = if end - first > 2 { first..end } else { 0..0 };
    ring.truncate(left.end);
    ring.drain(..left.start);
}

/// Begins a ring at its smallest point; where that is passed more than once, at the one from which
/// the ring as a whole is smallest.
fn start_at_smallest(ring: &mut [[f64; 2]]) {
    let from = |start: usize| ring[start..].iter().chain(&ring[..start]);
    let best = (0..ring.len()).min_by(|&a, &b| {
        let by_point = ring[a].partial_cmp(&ring[b]).filter(|order| order.is_ne());
        by_point.or_else(|| from(a).partial_cmp(from(b))).unwrap_or(std::cmp::Ordering::Equal)
    });
    ring.rotate_left(best.unwrap_or(0));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finished(names: &str, closed: bool) -> String {
        let points = names.bytes().map(|b| [f64::from(b), 0.0]).collect();
        let line = finish(0.0, Joined { points, closed });
        line.map_or_else(String::new, |line| line.points.iter().map(|p| p[0] as u8 as char).collect())
    }

    #[test]
    fn open_lines_lose_what_has_no_length() {
        assert_eq!(finished("abc", false), "abc");
        assert_eq!(finished("aabbbc", false), "abc");
        assert_eq!(finished("aaa", false), "");
        assert_eq!(finished("abac", false), "ac");
        assert_eq!(finished("abcbbad", false), "ad");
        assert_eq!(finished("abcba", false), "");
    }

    #[test]
    fn rings_start_at_their_smallest_point() {
        assert_eq!(finished("cdbc", true), "bcdb");
        assert_eq!(finished("zxyz", true), "xyzx");
    }

    #[test]
    fn rings_lose_what_has_no_length() {
        assert_eq!(finished("aba", true), "");
        assert_eq!(finished("abcdcba", true), "");
        assert_eq!(finished("abcdba", true), "bcdb");
        assert_eq!(finished("cdbabc", true), "bcdb");
        assert_eq!(finished("aabbccaa", true), "abca");
    }

    #[test]
    fn a_ring_that_passes_its_start_twice_takes_the_smaller_loop_first() {
        assert_eq!(finished("adeabca", true), "abcadea");
        assert_eq!(finished("eabcade", true), "abcadea");
    }
}
