//! Colors by height.

use serde::{Deserialize, Serialize};

/// Red, green, blue and opacity, each from 0 to 255.
pub type Rgba = [u8; 4];

/// The color of cells that have none.
const TRANSPARENT: Rgba = [0; 4];

/// Colors at heights, as a ramp file lists them. [`Colors`] says what becomes of other heights.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ColorRamp {
    /// The colors, in any order. Of two at one height, the first ends what is below, and the last
    /// begins at that height.
    pub stops: Vec<ColorStop>,
}

/// A color of a [`ColorRamp`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ColorStop {
    /// What has this color.
    pub at: StopAt,
    /// The color.
    pub color: Rgba,
}

/// What has the color of a [`ColorStop`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum StopAt {
    /// A height, in its units.
    Height(f64),
    /// A height between the lowest of all cells (0) and the highest (100).
    Percent(f64),
    /// Cells without a height; transparent if no stop says otherwise.
    NoHeight,
}

/// The color of a height between those of a [`ColorRamp`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ColorMatch {
    /// Between the colors at the heights below and above, in proportion.
    #[default]
    Linear,
    /// That of the nearest height; in the middle, of the upper one.
    Nearest,
    /// None: only heights of the ramp have a color, compared as 32-bit floats.
    Exact,
}

impl ColorRamp {
    /// Returns true if colors depend on the lowest and the highest of all cells.
    pub fn has_percents(&self) -> bool {
        self.stops
            .iter()
            .any(|stop| matches!(stop.at, StopAt::Percent(_)))
    }

    /// Returns the colors of all heights. `range` are the lowest and the highest of all cells;
    /// without it, stops in percent are left out.
    ///
    /// # Complexity
    /// That of sorting the stops.
    pub fn over(&self, range: Option<[f64; 2]>, matching: ColorMatch) -> Colors {
        let mut colors = Colors {
            stops: Vec::with_capacity(self.stops.len()),
            missing: TRANSPARENT,
            matching,
        };
        for &ColorStop { at, color } in &self.stops {
            let height = match (at, range) {
                (StopAt::Height(height), _) => height,
                (StopAt::Percent(percent), Some([low, high])) => {
                    low + percent / 100.0 * (high - low)
                }
                (StopAt::Percent(_), None) => continue,
                (StopAt::NoHeight, _) => {
                    colors.missing = color;
                    continue;
                }
            };
            colors.stops.push((height, color));
        }
        // Stable: stops at one height keep their order.
        colors.stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        colors
    }
}

/// The colors of all heights, see [`ColorRamp::over`].
#[derive(Debug, Clone, PartialEq)]
pub struct Colors {
    /// From the lowest to the highest.
    stops: Vec<(f64, Rgba)>,
    missing: Rgba,
    matching: ColorMatch,
}

impl Colors {
    /// Returns the color of a height. Below the lowest stop it is that of the lowest, above the
    /// highest that of the highest; NaN is a missing height.
    ///
    /// # Complexity
    /// Logarithmic in the stops.
    pub fn of(&self, height: f32) -> Rgba {
        if height.is_nan() {
            return self.missing;
        }
        if self.matching == ColorMatch::Exact {
            // The last of those that are equal.
            let behind = self.stops.partition_point(|stop| stop.0 as f32 <= height);
            return match behind.checked_sub(1).map(|last| self.stops[last]) {
                Some((at, color)) if at as f32 == height => color,
                _ => TRANSPARENT,
            };
        }
        let height = f64::from(height);
        let behind = self.stops.partition_point(|stop| stop.0 <= height);
        let below = behind.checked_sub(1).map(|last| self.stops[last]);
        match (below, self.stops.get(behind).copied()) {
            (Some(low), Some(high)) => self.between(low, high, height),
            (Some((_, color)), None) | (None, Some((_, color))) => color,
            (None, None) => TRANSPARENT,
        }
    }

    /// Returns the color of a height from that of `low` to below that of `high`.
    fn between(&self, low: (f64, Rgba), high: (f64, Rgba), height: f64) -> Rgba {
        let [up, down] = [height - low.0, high.0 - height];
        if self.matching == ColorMatch::Nearest {
            return if up < down { low.1 } else { high.1 };
        }
        let share = up / (high.0 - low.0);
        std::array::from_fn(|i| {
            let [from, to] = [low.1[i], high.1[i]].map(f64::from);
            // Rounded half up, as in gdaldem.
            (0.5 + from + share * (to - from)) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(stops: &[(StopAt, Rgba)]) -> ColorRamp {
        ColorRamp {
            stops: stops
                .iter()
                .map(|&(at, color)| ColorStop { at, color })
                .collect(),
        }
    }

    fn red(value: u8) -> Rgba {
        [value, 0, 0, 255]
    }

    /// The naive judge: looks at every pair of stops.
    fn judged(stops: &[(f64, u8)], matching: ColorMatch, height: f64) -> Option<u8> {
        let at = stops.iter().rev().find(|stop| stop.0 == height);
        let low = stops.iter().rev().filter(|stop| stop.0 < height);
        let low = low.max_by(|a, b| a.0.total_cmp(&b.0).then(std::cmp::Ordering::Greater));
        let high = stops.iter().filter(|stop| stop.0 > height);
        let high = high.min_by(|a, b| a.0.total_cmp(&b.0));
        match (at, matching, low, high) {
            (Some(stop), ..) => Some(stop.1),
            (None, ColorMatch::Exact, ..) => None,
            (None, _, None, other) | (None, _, other, None) => other.map(|stop| stop.1),
            (None, ColorMatch::Nearest, Some(low), Some(high)) => {
                Some(if height - low.0 < high.0 - height {
                    low.1
                } else {
                    high.1
                })
            }
            (None, ColorMatch::Linear, Some(low), Some(high)) => {
                let [a, b] = [low.1, high.1].map(f64::from);
                Some((a + (height - low.0) / (high.0 - low.0) * (b - a) + 0.5).floor() as u8)
            }
        }
    }

    #[test]
    fn colors_are_those_of_the_naive_judge() {
        // All lists of three stops at heights 0 to 3, so that equal ones are common.
        for i in 0..64 {
            let stops = [0, 1, 2].map(|k| {
                let height = f64::from(i / [1, 4, 16][k] % 4);
                (height, [10u8, 255, 90][k])
            });
            let listed: Vec<_> = stops
                .iter()
                .map(|&(height, value)| (StopAt::Height(height), red(value)))
                .collect();
            for matching in [ColorMatch::Linear, ColorMatch::Nearest, ColorMatch::Exact] {
                let colors = ramp(&listed).over(None, matching);
                for eighth in -8..32 {
                    let height = f64::from(eighth) / 8.0;
                    let expected = judged(&stops, matching, height).map_or([0; 4], red);
                    assert_eq!(
                        colors.of(height as f32),
                        expected,
                        "{matching:?} at {height} of {stops:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn percents_are_of_the_range_and_missing_heights_have_a_color_of_their_own() {
        let relative = ramp(&[
            (StopAt::Percent(100.0), red(200)),
            (StopAt::Percent(0.0), red(0)),
            (StopAt::Height(15.0), red(50)),
        ]);
        assert!(relative.has_percents());
        let colors = relative.over(Some([10.0, 20.0]), ColorMatch::Linear);
        assert_eq!(
            [9.0, 10.0, 12.5, 15.0, 17.5, 30.0].map(|z| colors.of(z)[0]),
            [0, 0, 25, 50, 125, 200]
        );
        assert_eq!(colors.of(f32::NAN), [0; 4]);
        // No cell has a height: only stops at heights count.
        assert_eq!(relative.over(None, ColorMatch::Linear).of(3.0), red(50));
        let gray = ramp(&[(StopAt::NoHeight, [9, 9, 9, 9])]);
        let colors = gray.over(None, ColorMatch::Linear);
        assert_eq!((colors.of(f32::NAN), colors.of(1.0)), ([9; 4], [0; 4]));
    }

    #[test]
    fn exact_heights_are_compared_as_cells_have_them() {
        let tenth = ramp(&[(StopAt::Height(0.1), red(7))]);
        let colors = tenth.over(None, ColorMatch::Exact);
        assert_eq!((colors.of(0.1), colors.of(0.100001)), (red(7), [0; 4]));
    }
}
