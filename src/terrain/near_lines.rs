//! Lines in plan, prepared to find out whether one passes a position.

use super::boxes::{Boxed, Boxes, Extent};
use super::nearest::squared_distance;

/// Segments in plan, prepared for queries whether one passes a position.
#[derive(Debug)]
pub(crate) struct NearLines(Boxes<Segment>);

#[derive(Debug, Clone, Copy)]
struct Segment([[f64; 2]; 2]);

impl Boxed for Segment {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.0)
    }
}

impl NearLines {
    /// # Complexity
    /// O(n log n) for n segments.
    pub(crate) fn new(segments: impl IntoIterator<Item = [[f64; 2]; 2]>) -> Self {
        NearLines(Boxes::new(segments.into_iter().map(Segment).collect()))
    }

    /// Returns true if a segment passes a position at no more than a distance.
    ///
    /// # Complexity
    /// O(log n) for n segments, if few of them are close.
    pub(crate) fn pass(&self, [x, y]: [f64; 2], distance: f64) -> bool {
        let extent = Extent {
            min: [x - distance, y - distance],
            max: [x + distance, y + distance],
        };
        let passes = |segment: &Segment| squared_distance(segment.0, [x, y]) <= distance * distance;
        self.0
            .find_in(extent, |segment| passes(segment).then_some(()))
            .is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    #[test]
    fn all_segments_one_after_the_other_agree() {
        let mut random = Random(3);
        for _ in 0..300 {
            let mut at = || [0, 1].map(|_| random.index(9) as f64);
            let segments: Vec<[[f64; 2]; 2]> = (0..30).map(|_| [at(), at()]).collect();
            let segments = &segments[..random.index(segments.len() + 1)];
            let near = NearLines::new(segments.iter().copied());
            for x in -1..10 {
                for y in -1..10 {
                    let p = [f64::from(x), f64::from(y)];
                    for distance in [0.0, 0.5, 1.0, 2.0] {
                        let wanted = segments
                            .iter()
                            .any(|&s| squared_distance(s, p) <= distance * distance);
                        assert_eq!(
                            near.pass(p, distance),
                            wanted,
                            "{segments:?} {p:?} {distance}"
                        );
                    }
                }
            }
        }
        let near = NearLines::new([[[0.0; 2], [1.0; 2]]]);
        for odd in [
            [f64::NAN, 0.0],
            [0.0, f64::NAN],
            [f64::INFINITY, 0.0],
            [0.0, f64::NEG_INFINITY],
        ] {
            assert!(!near.pass(odd, 1.0));
        }
    }
}
