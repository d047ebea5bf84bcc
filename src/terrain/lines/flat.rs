//! Lakes: rings at one height.

use crate::error::{Error, Plain, Result, Setting, wording};
use crate::triangulation::num::unsigned_zero;

/// Which height level water has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlatHeight {
    /// That of its shore, which must be the same everywhere, within a tolerance. Their lowest is
    /// used.
    OfShore {
        /// The largest difference between the heights of the shore.
        tolerance: f64,
    },
    /// The lowest height of the shore.
    Lowest,
    /// The mean of the heights of the vertices of the shore; they are summed in ascending order.
    Mean,
    /// This height; the shore needs none.
    Given(f64),
}

/// A lake: an area in which the surface has one height, shore included.
///
/// Points inside are left out, and so are those within a buffer outside. Lines inside get the
/// height of the water. A ring within a ring is the shore of an island.
#[derive(Debug, Clone, PartialEq)]
pub struct Flat {
    pub(crate) rings: Vec<Vec<[f64; 3]>>,
    pub(crate) height: f64,
    pub(crate) buffer: f64,
    spread: f64,
    tolerance: f64,
}

impl Flat {
    /// Returns a lake from its rings, by the even-odd rule; each must end where it begins.
    ///
    /// # Errors
    /// If a ring is open or encloses no area, or if the height is not known: a vertex has none, the
    /// shore is not level, or the given height is not finite.
    pub fn new(rings: &[Vec<[f64; 3]>], height: FlatHeight) -> Result<Self> {
        for ring in rings {
            check_ring(ring)?;
        }
        let mut heights: Vec<f64> = rings
            .iter()
            .flat_map(|ring| ring.iter().skip(1))
            .map(|p| p[2])
            .collect();
        heights.sort_unstable_by(f64::total_cmp);
        let (Some(&lowest), Some(&highest)) = (heights.first(), heights.last()) else {
            return Err(Error::format("the lake has no ring"));
        };
        let is_known = heights.iter().all(|z| z.is_finite());
        let level = match height {
            FlatHeight::Given(height) if height.is_finite() => height,
            FlatHeight::Given(height) => {
                return Err(
                    Error::format(format!("the height of the lake is {height}")).cure(wording![
                        "fill the attribute of ",
                        Setting::FlatHeight,
                        ", or give a number"
                    ]),
                );
            }
            _ if !is_known => {
                return Err(
                    Error::format("the shore has a vertex without a height").cure(wording![
                        "name the attribute with the height (",
                        Setting::Flat.text("FILE:FIELD"),
                        "), or give one with ",
                        Setting::FlatHeight
                    ]),
                );
            }
            FlatHeight::Lowest => lowest,
            FlatHeight::Mean => heights.iter().sum::<f64>() / heights.len() as f64,
            FlatHeight::OfShore { tolerance } if highest - lowest <= tolerance => lowest,
            FlatHeight::OfShore { tolerance } => {
                return Err(Error::format(format!(
                    "the shore is not level: its heights are {lowest} to {highest}, expected within {tolerance}"
                ))
                .cure(wording![
                    "choose a height with ",
                    Setting::FlatHeight.text("lowest"),
                    ", mean or a number"
                ]));
            }
        };
        let rings = rings
            .iter()
            .map(|ring| ring.iter().map(|&[x, y, _]| [x, y, level]).collect())
            .collect();
        Ok(Flat {
            rings,
            height: level,
            buffer: 0.0,
            spread: highest - lowest,
            tolerance: match height {
                FlatHeight::OfShore { tolerance } => tolerance,
                FlatHeight::Lowest | FlatHeight::Mean | FlatHeight::Given(_) => 0.0,
            },
        })
    }

    /// Leaves out points up to a distance outside of the shore, too.
    #[must_use]
    pub fn with_buffer(self, buffer: f64) -> Self {
        Flat {
            buffer: buffer.max(0.0),
            ..self
        }
    }

    /// Returns how far the heights of the shore differed; NaN if it had none.
    pub fn spread(&self) -> f64 {
        self.spread
    }

    /// Returns how far the heights of lakes that are one water may differ from its own.
    pub(crate) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the area in plan within the largest ring.
    pub(crate) fn area(&self) -> f64 {
        let of_ring = |ring: &Vec<[f64; 3]>| {
            let fan = ring.windows(2).map(|pair| cross(ring[0], pair[0], pair[1]));
            fan.sum::<f64>().abs() / 2.0
        };
        self.rings.iter().map(of_ring).fold(0.0, f64::max)
    }

    /// Returns the height of the water.
    pub fn height(&self) -> f64 {
        self.height
    }
}

fn check_ring(ring: &[[f64; 3]]) -> Result<()> {
    let (Some(first), Some(last)) = (ring.first(), ring.last()) else {
        return Err(Error::format("the shore has no vertex"));
    };
    if first[..2] != last[..2] {
        return Err(Error::format(format!(
            "the shore is open: it begins at {} {} and ends at {} {}",
            Plain(first[0]),
            Plain(first[1]),
            Plain(last[0]),
            Plain(last[1])
        ))
        .cure("a lake needs a closed ring: join its ends, or pass polygons"));
    }
    // Twice the areas of a fan of triangles; rings like an 8 have parts of both signs.
    let area: f64 = ring
        .windows(2)
        .map(|pair| cross(*first, pair[0], pair[1]).abs())
        .sum();
    let extent = ring.iter().fold(0.0_f64, |most, p| {
        most.max((p[0] - first[0]).abs())
            .max((p[1] - first[1]).abs())
    });
    // What is drawn twice encloses nothing.
    let bits = |p: &[f64; 3]| [p[0], p[1]].map(|c| unsigned_zero(c).to_bits());
    let side = |pair: &[[f64; 3]]| {
        [
            bits(&pair[0]).min(bits(&pair[1])),
            bits(&pair[0]).max(bits(&pair[1])),
        ]
    };
    let mut sides: Vec<[[u64; 2]; 2]> = ring.windows(2).map(side).collect();
    sides.sort_unstable();
    let odd = sides
        .chunk_by(|p, q| p == q)
        .filter(|same| same.len() % 2 == 1 && same[0][0] != same[0][1])
        .count();
    if odd < 3 || area <= extent * extent * f64::EPSILON {
        return Err(Error::format(format!(
            "the shore at {} {} encloses nothing",
            first[0], first[1]
        ))
        .cure("remove the record, or give the ring its vertices"));
    }
    Ok(())
}

fn cross(o: [f64; 3], p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(heights: [f64; 4]) -> Vec<[f64; 3]> {
        let sites = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 0.0]];
        sites
            .iter()
            .zip(heights)
            .map(|(p, z)| [p[0], p[1], z])
            .collect()
    }

    #[test]
    fn each_rule_has_its_height() {
        let rings = [ring([2.0, 2.5, 3.0, 2.0])];
        for (rule, expected) in [
            (FlatHeight::Lowest, 2.0),
            (FlatHeight::Mean, 2.5),
            (FlatHeight::Given(7.0), 7.0),
            (FlatHeight::OfShore { tolerance: 1.0 }, 2.0),
        ] {
            let flat = Flat::new(&rings, rule).unwrap();
            assert_eq!(flat.height(), expected);
            assert!(flat.rings[0].iter().all(|p| p[2] == expected));
        }
        let error = Flat::new(&rings, FlatHeight::OfShore { tolerance: 0.5 }).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the shore is not level: its heights are 2 to 3, expected within 0.5"
        );
    }

    #[test]
    fn what_is_no_lake_is_refused() {
        let message = |ring: Vec<[f64; 3]>, rule| Flat::new(&[ring], rule).unwrap_err().to_string();
        let open = ring([1.0; 4])[..3].to_vec();
        assert_eq!(
            message(open, FlatHeight::Lowest),
            "the shore is open: it begins at 0 0 and ends at 4 4"
        );
        let thin = vec![
            [0.0, 0.0, 1.0],
            [4.0, 4.0, 1.0],
            [2.0, 2.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        assert_eq!(
            message(thin, FlatHeight::Lowest),
            "the shore at 0 0 encloses nothing"
        );
        assert!(
            message(ring([1.0, f64::NAN, 1.0, 1.0]), FlatHeight::Lowest)
                .contains("without a height")
        );
        assert!(message(ring([1.0; 4]), FlatHeight::Given(f64::NAN)).contains("NaN"));
        assert!(Flat::new(&[ring([f64::NAN; 4])], FlatHeight::Given(1.0)).is_ok());
        assert!(Flat::new(&[], FlatHeight::Lowest).is_err());
        let twice = [
            [0.0, 0.0, 1.0],
            [4.0, 0.0, 1.0],
            [4.0, 4.0, 1.0],
            [4.0, 0.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        assert_eq!(
            message(twice.to_vec(), FlatHeight::Lowest),
            "the shore at 0 0 encloses nothing"
        );
        let eight = [
            [0.0, 0.0, 1.0],
            [4.0, 4.0, 1.0],
            [4.0, 0.0, 1.0],
            [0.0, 4.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        assert!(Flat::new(&[eight.to_vec()], FlatHeight::Lowest).is_ok());
    }
}
