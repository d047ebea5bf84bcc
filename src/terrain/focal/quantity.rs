//! Slope, aspect, curvature and roughness.

use super::{Focal, Neighbors, Rule};
use crate::data::BlockSource;
use crate::error::{Error, Result, Setting, wording};

/// What is computed of the surface around each cell of a raster.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Quantity {
    /// The steepest slope, in degrees above the horizon.
    SlopeDegrees(Gradient),
    /// The steepest slope, in percent: 100 is 45 degrees.
    SlopePercent(Gradient),
    /// The direction in which the surface falls, in degrees clockwise from north; NaN where it is
    /// level.
    Aspect(Gradient),
    /// The curvature along the steepest slope, per unit of length: positive where the slope gets
    /// steeper on the way down, 0 where the surface is level. Zevenbergen and Thorne (1987).
    ProfileCurvature,
    /// The curvature across the steepest slope, per unit of length: positive on spurs, negative in
    /// valleys, 0 where the surface is level. Zevenbergen and Thorne (1987).
    PlanCurvature,
    /// The difference of the highest and the lowest of the nine cells, in units of height.
    Roughness,
    /// The terrain ruggedness index, in units of height.
    Ruggedness(Ruggedness),
    /// The topographic position index: the height above the mean of the eight cells around, in
    /// units of height.
    Position,
}

impl Quantity {
    /// Returns the name, as a verb has it.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::SlopeDegrees(_) | Quantity::SlopePercent(_) => "slope",
            Quantity::Aspect(_) => "aspect",
            Quantity::ProfileCurvature | Quantity::PlanCurvature => "curvature",
            Quantity::Roughness => "roughness",
            Quantity::Ruggedness(_) => "tri",
            Quantity::Position => "tpi",
        }
    }

    /// Returns how the gradient is computed that the quantity follows from alone, if it does.
    pub fn gradient(self) -> Option<Gradient> {
        match self {
            Quantity::SlopeDegrees(by) | Quantity::SlopePercent(by) | Quantity::Aspect(by) => {
                Some(by)
            }
            _ => None,
        }
    }

    /// Returns true if values depend on the ratio of heights to lengths.
    pub fn has_lengths(self) -> bool {
        match self {
            Quantity::SlopeDegrees(_)
            | Quantity::SlopePercent(_)
            | Quantity::Aspect(_)
            | Quantity::ProfileCurvature
            | Quantity::PlanCurvature => true,
            Quantity::Roughness | Quantity::Ruggedness(_) | Quantity::Position => false,
        }
    }
}

/// How the gradient of a cell is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Gradient {
    /// From all eight cells around, weighted 1, 2, 1: Horn (1981). For rough surfaces.
    #[default]
    Horn,
    /// From the four cells beside: Zevenbergen and Thorne (1987). For smooth surfaces.
    ZevenbergenThorne,
    /// That of the face which has the center of the cell: of a surface of triangles, see
    /// [`FaceSlopes`](crate::terrain::FaceSlopes).
    Faces,
}

/// How ruggedness is computed from the differences of the eight cells around and the one between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Ruggedness {
    /// The root of the sum of their squares: Riley, DeGloria and Elliot (1999).
    #[default]
    Riley,
    /// The mean of their amounts: Wilson and others (2007), for the sea floor.
    Wilson,
}

/// A quantity in each cell of a raster, as `gdaldem` computes it where all of the nine cells have
/// heights.
///
/// Frames may be rotated; directions refer to the map, not to the raster.
pub type QuantityMap<S> = Focal<S, Scaled>;

/// A quantity, with the units of its heights.
#[derive(Debug, Clone, Copy)]
pub struct Scaled {
    quantity: Quantity,
    z_factor: f64,
    x_scale: f64,
}

impl<S: BlockSource> QuantityMap<S> {
    /// Creates the raster of a quantity of `source`: a DEM, a grid, or a reference to one.
    ///
    /// `z_factor` are the units of y per unit of z, `x_scale` those per unit of x, see
    /// [`Light`](super::Light). Roughness, ruggedness and position do not depend on them.
    ///
    /// # Errors
    /// If the frame of the source has no inverse, or the quantity is that of
    /// [faces](Gradient::Faces).
    pub fn of(source: S, quantity: Quantity, z_factor: f64, x_scale: f64) -> Result<Self> {
        if quantity.gradient() == Some(Gradient::Faces) {
            return Err(Error::usage(wording![
                Setting::Formula,
                " is that of faces, and a raster has none"
            ])
            .cure(wording![
                "choose another ",
                Setting::Formula,
                ", or pass points, a .tin or a .ply"
            ]));
        }
        Focal::of_rule(
            source,
            Scaled {
                quantity,
                z_factor,
                x_scale,
            },
        )
    }
}

impl Rule for Scaled {
    fn value(&self, around: &Neighbors) -> f32 {
        let heights = &around.heights;
        let beside = || [0, 1, 2, 3, 5, 6, 7, 8].map(|i| heights[i] - heights[4]);
        let value = match self.quantity {
            Quantity::SlopeDegrees(by) => self.slope(by, around).atan().to_degrees(),
            Quantity::SlopePercent(by) => 100.0 * self.slope(by, around),
            Quantity::Aspect(by) => direction(self.gradient(by, around)),
            Quantity::ProfileCurvature => self.curvature(around, |[p, q], [xx, xy, yy]| {
                -(xx * p * p + 2.0 * xy * p * q + yy * q * q)
            }),
            Quantity::PlanCurvature => self.curvature(around, |[p, q], [xx, xy, yy]| {
                -(xx * q * q - 2.0 * xy * p * q + yy * p * p)
            }),
            Quantity::Roughness => {
                let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
                highest - lowest
            }
            Quantity::Ruggedness(Ruggedness::Riley) => {
                beside().iter().map(|d| d * d).sum::<f64>().sqrt()
            }
            Quantity::Ruggedness(Ruggedness::Wilson) => {
                beside().iter().map(|d| d.abs()).sum::<f64>() / 8.0
            }
            Quantity::Position => -beside().iter().sum::<f64>() / 8.0,
        };
        // A level surface has 0, not -0.0.
        (value + 0.0) as f32
    }
}

impl Scaled {
    fn slope(&self, by: Gradient, around: &Neighbors) -> f64 {
        let [p, q] = self.gradient(by, around);
        // `PERF:` faster than `hypot`; heights are 32-bit floats, so that squares do not overflow.
        (p * p + q * q).sqrt()
    }

    /// Returns the rise per length along x and y.
    fn gradient(&self, by: Gradient, around: &Neighbors) -> [f64; 2] {
        let [p, q] = match by {
            Gradient::Horn => around.gradient_by_horn(self.z_factor),
            Gradient::ZevenbergenThorne => {
                let [_, n, _, w, _, e, _, s, _] = around.heights;
                let [per_column, per_row] = [e - w, s - n].map(|d| d / 2.0 * self.z_factor);
                around.to_pixels.gradient(per_column, per_row)
            }
            // Refused by `of`.
            Gradient::Faces => [f64::NAN; 2],
        };
        [p / self.x_scale, q]
    }

    /// Returns a quadratic form of the gradient and the second derivatives (xx, xy, yy), divided by
    /// the square of the gradient: by the surface of fourth degree through the nine cells.
    fn curvature(&self, around: &Neighbors, form: impl Fn([f64; 2], [f64; 3]) -> f64) -> f64 {
        let gradient = self.gradient(Gradient::ZevenbergenThorne, around);
        let square = gradient[0] * gradient[0] + gradient[1] * gradient[1];
        if square == 0.0 {
            return 0.0;
        }
        let [nw, n, ne, w, center, e, sw, s, se] = around.heights;
        let columns = w + e - 2.0 * center;
        let rows = n + s - 2.0 * center;
        let mixed = (nw + se - ne - sw) / 4.0;
        let derived = |[a, b]: [f64; 2]| around.to_pixels.gradient(a, b);
        // Of both partial derivatives, along columns and rows; then along x and y.
        let [along_columns, along_rows] = [derived([columns, mixed]), derived([mixed, rows])];
        let [xx, xy] = derived([along_columns[0], along_rows[0]]);
        let [_, yy] = derived([along_columns[1], along_rows[1]]);
        let [z, x] = [self.z_factor, self.x_scale];
        form(gradient, [xx * z / (x * x), xy * z / x, yy * z]) / square
    }
}

/// Returns the direction in which a surface with a gradient falls, in degrees clockwise from north
/// and below 360; NaN if it is level.
pub(crate) fn direction([p, q]: [f64; 2]) -> f64 {
    if p == 0.0 && q == 0.0 {
        return f64::NAN;
    }
    let degrees = (-p).atan2(-q).to_degrees();
    // 0 also for the -0.0 of a fall to the north.
    let degrees = if degrees < 0.0 {
        degrees + 360.0
    } else {
        degrees + 0.0
    };
    if degrees as f32 >= 360.0 {
        0.0
    } else {
        degrees
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Frame, Grid};

    fn value(values: [f64; 9], transform: [f64; 6], quantity: Quantity) -> f64 {
        let grid = Grid {
            frame: Frame {
                width: 3,
                height: 3,
                transform,
            },
            crs: None,
            values: values.to_vec(),
        };
        let map = QuantityMap::of(&grid, quantity, 1.0, 1.0).unwrap();
        Grid::collect(&map).unwrap().values[4]
    }

    /// Cells of 2, north up.
    const USUAL: [f64; 6] = [0.0, 2.0, 0.0, 0.0, 0.0, -2.0];

    const NINE: [f64; 9] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.5];

    #[test]
    fn nine_cells_by_hand() {
        let horn = Gradient::Horn;
        let near = |quantity, expected: f64| {
            let found = value(NINE, USUAL, quantity);
            assert!(
                (found - expected).abs() <= 1e-7 * expected.abs().max(1.0),
                "{quantity:?}: {found}, not {expected}"
            );
        };
        // 0.53125 to the east and 1.53125 to the south.
        near(Quantity::SlopePercent(horn), 162.078_78);
        near(Quantity::SlopeDegrees(horn), 58.32608);
        near(Quantity::Aspect(horn), 340.86636);
        let of_four = Gradient::ZevenbergenThorne;
        // 0.5 to the east, 1.5 to the south.
        near(Quantity::SlopePercent(of_four), 158.113_88);
        near(Quantity::Aspect(of_four), 341.565_05);
        // All second derivatives are 0 but the mixed one: (9.5 + 1 - 3 - 7) / 4 / 4, to the
        // south-east.
        near(Quantity::ProfileCurvature, -2.0 * 0.5 * 1.5 * 0.03125 / 2.5);
        near(Quantity::PlanCurvature, 2.0 * 0.5 * 1.5 * 0.03125 / 2.5);
        near(Quantity::Roughness, 8.5);
        near(
            Quantity::Ruggedness(Ruggedness::Riley),
            (16.0 + 9.0 + 4.0 + 1.0 + 1.0 + 4.0 + 9.0 + 20.25f64).sqrt(),
        );
        near(Quantity::Ruggedness(Ruggedness::Wilson), 20.5 / 8.0);
        near(Quantity::Position, 5.0 - 40.5 / 8.0);
    }

    /// However the raster lies, values are those of the map.
    #[test]
    fn the_lie_of_the_raster_does_not_show() {
        // z = x^2 / 10 - x y / 5 + 3 x + y, at (1, 2): gradient (2.8, 0.8), xx 0.2, xy -0.2, yy 0.
        let height = |x: f64, y: f64| x * x / 10.0 - x * y / 5.0 + 3.0 * x + y;
        let (p, q, xx, xy) = (2.8f64, 0.8f64, 0.2f64, -0.2f64);
        let square = p * p + q * q;
        let expected = [
            (
                Quantity::SlopePercent(Gradient::ZevenbergenThorne),
                100.0 * square.sqrt(),
            ),
            (
                Quantity::Aspect(Gradient::ZevenbergenThorne),
                180.0 + p.atan2(q).to_degrees(),
            ),
            (
                Quantity::ProfileCurvature,
                -(xx * p * p + 2.0 * xy * p * q) / square,
            ),
            (
                Quantity::PlanCurvature,
                -(xx * q * q - 2.0 * xy * p * q) / square,
            ),
        ];
        for [a, b, d, e] in [
            [1.0, 0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0, 1.0],
            [-2.0, 0.0, 0.0, 0.5],
            [0.6, 0.8, 0.8, -0.6],
        ] {
            // The center of the middle cell is at (1, 2).
            let transform = [1.0 - 1.5 * (a + b), a, b, 2.0 - 1.5 * (d + e), d, e];
            let at = |i: usize| {
                let [column, row] = [(i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0];
                height(1.0 + a * column + b * row, 2.0 + d * column + e * row)
            };
            let values = std::array::from_fn(at);
            for (quantity, expected) in expected {
                let found = value(values, transform, quantity);
                assert!(
                    (found - expected).abs() < 1e-4,
                    "{quantity:?} in {transform:?}: {found}, not {expected}"
                );
            }
        }
    }

    #[test]
    fn directions_are_below_a_full_turn_and_level_ground_has_none() {
        for (gradient, expected) in [
            ([0.0, -1.0], 0.0),
            ([-1.0, 0.0], 90.0),
            ([0.0, 1.0], 180.0),
            ([1.0, 0.0], 270.0),
            ([-0.0, -1.0], 0.0),
            ([1e-30, -1.0], 0.0),
        ] {
            let found = direction(gradient);
            assert!(
                found == expected && found.is_sign_positive(),
                "{gradient:?}: {found}"
            );
        }
        for level in [[0.0, 0.0], [-0.0, 0.0]] {
            assert!(direction(level).is_nan());
        }
        for quantity in [Quantity::ProfileCurvature, Quantity::PlanCurvature] {
            assert_eq!(value([3.0; 9], USUAL, quantity), 0.0);
        }
        assert!(value([3.0; 9], USUAL, Quantity::Aspect(Gradient::Horn)).is_nan());
    }
}
