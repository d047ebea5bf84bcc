//! Shaded relief.

use crate::crs::{Crs, CrsKind};
use crate::data::{BlockSource, Frame};
use crate::error::{Error, Result};

use super::{Focal, Neighbors, Rule};

/// Meters in one radian of a great circle on the mean earth (6 371 008.8 m, Moritz 2000).
const EARTH_RADIUS: f64 = 6_371_008.8;

/// The direction of the light, and the ratio of heights to lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// The direction that the light comes from, in degrees clockwise from north.
    pub azimuth: f64,
    /// The angle of the light above the horizon, in degrees.
    pub altitude: f64,
    /// The factor for heights: units of y per unit of z, times any exaggeration.
    pub z_factor: f64,
    /// The length of a unit of x, in units of y; below 1 if they are degrees.
    pub x_scale: f64,
}

impl Default for Light {
    /// Light from the northwest at 45 degrees, as is usual on maps.
    fn default() -> Self {
        Light {
            azimuth: 315.0,
            altitude: 45.0,
            z_factor: 1.0,
            x_scale: 1.0,
        }
    }
}

/// The largest latitude at which the length of a degree of longitude is used: at the poles it is 0.
const MOST_LATITUDE: f64 = 89.0;

impl Light {
    /// Returns the default light with a z factor for the units of a coordinate system.
    ///
    /// A vertical unit that is not stated is assumed to be that of x and y, or the meter if those
    /// are angles. Angles have the lengths that they have on a sphere at the latitude in the middle
    /// of `frame`, which is not used otherwise.
    pub fn for_crs(crs: Option<&Crs>, frame: &Frame) -> Self {
        let z_factor = crs.map_or(1.0, |crs| {
            let vertical = crs.vertical_unit.as_ref().map(|unit| unit.factor);
            match crs.kind {
                CrsKind::Geographic => vertical.unwrap_or(1.0) / (crs.unit.factor * EARTH_RADIUS),
                _ => vertical.unwrap_or(crs.unit.factor) / crs.unit.factor,
            }
        });
        let x_scale = crs
            .filter(|crs| crs.kind == CrsKind::Geographic)
            .map_or(1.0, |crs| {
                let [_, middle] = frame.to_map(0.5 * frame.width as f64, 0.5 * frame.height as f64);
                let most = MOST_LATITUDE.to_radians();
                (middle * crs.unit.factor).clamp(-most, most).cos()
            });
        Light {
            z_factor,
            x_scale,
            ..Light::default()
        }
    }
}

/// The hillshade of a raster of heights: whole numbers from 1 (dark) to 255 (facing the light), NaN
/// where there is no height.
///
/// Slopes are those of Horn (1981), "Hill shading and the reflectance map": weighted differences
/// over the 3 x 3 cells around each cell, as in `gdaldem hillshade`. At the edge of the data the
/// surface is extrapolated linearly, so that the shade of a plane is constant up to its edge.
/// Frames may be rotated; the direction of the light refers to the map, not to the raster.
pub type Hillshade<S> = Focal<S, Shade>;

/// How light falls on a cell.
#[derive(Debug, Clone, Copy)]
pub struct Shade {
    /// The unit vector towards the light: east, north, up.
    towards: [f64; 3],
    z_factor: f64,
    x_scale: f64,
}

impl<S: BlockSource> Hillshade<S> {
    /// Creates the hillshade of `source`: a DEM, a grid, or a reference to one.
    ///
    /// # Errors
    /// If a number of `light` is not finite, or the frame of the source has no inverse.
    pub fn new(source: S, light: Light) -> Result<Self> {
        let Light {
            azimuth,
            altitude,
            z_factor,
            x_scale,
        } = light;
        for (name, value) in [
            ("azimuth", azimuth),
            ("altitude", altitude),
            ("z factor", z_factor),
            ("x scale", x_scale),
        ] {
            if !value.is_finite() {
                return Err(Error::usage(format!(
                    "the {name} of the light is {value}, expected a number"
                )));
            }
        }
        let (east, north) = azimuth.to_radians().sin_cos();
        let (up, flat) = altitude.to_radians().sin_cos();
        let rule = Shade {
            towards: [east * flat, north * flat, up],
            z_factor,
            x_scale,
        };
        Focal::of_rule(source, rule)
    }
}

impl Rule for Shade {
    fn value(&self, around: &Neighbors) -> f32 {
        let [dx, dy] = around.gradient_by_horn(self.z_factor);
        let dx = dx / self.x_scale;
        let [east, north, up] = self.towards;
        let lit = (up - dx * east - dy * north) / (1.0 + dx * dx + dy * dy).sqrt();
        (1.0 + 254.0 * lit.max(0.0)).round() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::Unit;
    use crate::data::{Grid, Window};

    fn grid(frame: Frame, height: impl Fn(f64, f64) -> f64) -> Grid {
        let values = (0..frame.width * frame.height)
            .map(|i| {
                let [x, y] = frame.center(i % frame.width, i / frame.width);
                height(x, y)
            })
            .collect();
        Grid {
            frame,
            crs: None,
            values,
        }
    }

    fn shades(grid: &Grid, light: Light) -> Vec<f64> {
        Grid::collect(&Hillshade::new(grid, light).unwrap())
            .unwrap()
            .values
    }

    #[test]
    fn nine_cells_by_hand() {
        // dz/dx = ((3 + 2*6 + 9.5) - (1 + 2*4 + 7)) / (8 * 2) = 0.53125
        // dz/dy = ((1 + 2*2 + 3) - (7 + 2*8 + 9.5)) / (8 * 2) = -1.53125
        // lit = (0.70711 + 0.5 * 0.53125 - 0.5 * -1.53125) / sqrt(1 + 0.28223 + 2.34473)
        //     = 1.73836 / 1.90446 = 0.91279, and 1 + 254 * that = 232.85
        let values = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.5];
        let grid = Grid {
            frame: Frame::north_up(0.0, 0.0, 2.0, 3, 3),
            crs: None,
            values,
        };
        assert_eq!(shades(&grid, Light::default())[4], 233.0);
        // A tenth of the height: (0.70711 + 0.02656 + 0.07656) / sqrt(1 + 0.00282 + 0.02345) =
        // 0.79980
        let gentle = Light {
            z_factor: 0.1,
            ..Light::default()
        };
        assert_eq!(shades(&grid, gentle)[4], 204.0);
    }

    #[test]
    fn a_plane_has_one_shade_however_its_raster_lies() {
        let plane = |x: f64, y: f64| 0.3 * x - 0.4 * y;
        // It rises to the east and falls to the north, so it faces the light in the north-west.
        let lit = (0.5f64.sqrt() + 0.5 * 0.3 + 0.5 * 0.4) / 1.25f64.sqrt();
        let expected = (1.0 + 254.0 * lit).round();
        for t in [
            [1.0, 0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0, 1.0],
            [-2.0, 0.0, 0.0, 0.5],
            [0.6, 0.8, 0.8, -0.6],
        ] {
            let transform = [10.0, t[0], t[1], 20.0, t[2], t[3]];
            let mut grid = grid(
                Frame {
                    width: 9,
                    height: 7,
                    transform,
                },
                plane,
            );
            grid.values[30] = f64::NAN;
            for (i, shade) in shades(&grid, Light::default()).into_iter().enumerate() {
                assert!(
                    if i == 30 {
                        shade.is_nan()
                    } else {
                        shade == expected
                    },
                    "{shade}, not {expected}, at {i}"
                );
            }
        }
    }

    #[test]
    fn level_ground_is_lit_from_above_and_slopes_away_from_the_light_are_dark() {
        let frame = Frame::north_up(0.0, 0.0, 1.0, 4, 4);
        assert!(
            shades(&grid(frame, |_, _| 7.0), Light::default())
                .iter()
                .all(|&v| v == 181.0)
        );
        let cliff = grid(frame, |x, y| 100.0 * (y - x));
        assert!(shades(&cliff, Light::default()).iter().all(|&v| v == 1.0));
        let overhead = Light {
            altitude: 90.0,
            ..Light::default()
        };
        assert!(
            shades(&grid(frame, |_, _| 7.0), overhead)
                .iter()
                .all(|&v| v == 255.0)
        );
    }

    #[test]
    fn blocks_do_not_show() {
        let grid = grid(Frame::north_up(0.0, 0.0, 1.0, 30, 20), |x, y| {
            (x * 1.7).sin() * 3.0 + (y * x / 9.0).cos()
        });
        let whole = shades(&grid, Light::default());
        let source = Hillshade::new(&grid, Light::default()).unwrap();
        for (column, row, width, height) in [
            (0, 0, 1, 1),
            (29, 19, 1, 1),
            (3, 0, 20, 4),
            (0, 5, 30, 15),
            (7, 7, 5, 5),
        ] {
            let mut block = vec![0.0; width * height];
            source
                .fill(
                    Window {
                        column,
                        row,
                        width,
                        height,
                    },
                    &mut block,
                )
                .unwrap();
            for (i, value) in block.iter().enumerate() {
                assert_eq!(
                    f64::from(*value),
                    whole[(row + i / width) * 30 + column + i % width]
                );
            }
        }
    }

    #[test]
    fn units_make_the_z_factor() {
        let unit = |factor| Unit {
            name: String::new(),
            factor,
        };
        let mut crs = Crs {
            name: String::new(),
            epsg: None,
            vertical_epsg: None,
            kind: CrsKind::Projected,
            unit: unit(0.3048),
            vertical_unit: None,
            wkt: None,
        };
        let frame = Frame::north_up(10.0, 62.0, 0.5, 8, 8);
        let of = |crs: &Crs| Light::for_crs(Some(crs), &frame);
        assert_eq!(of(&crs).z_factor, 1.0);
        crs.vertical_unit = Some(unit(1.0));
        assert_eq!((of(&crs).z_factor, of(&crs).x_scale), (1.0 / 0.3048, 1.0));
        crs.kind = CrsKind::Geographic;
        crs.unit = unit(1f64.to_radians());
        assert!((1.0 / of(&crs).z_factor - 111_195.0).abs() < 1.0);
        // Between 58 and 62 degrees north, a degree of longitude is half as long.
        assert!((of(&crs).x_scale - 0.5).abs() < 1e-12);
        // Numbers that are no latitudes are no error.
        let wide = Frame::north_up(0.0, 4e6, 0.5, 8, 8);
        assert!(Light::for_crs(Some(&crs), &wide).x_scale > 0.01);
    }

    /// A plane that rises as much per meter to the east as to the north, 60 degrees north.
    #[test]
    fn degrees_of_longitude_are_shorter() {
        let frame = Frame::north_up(-1.0, 61.0, 0.25, 8, 8);
        let steep = |light| shades(&grid(frame, |x, y| 0.5 * x + y), light)[9];
        let light = |x_scale| Light {
            azimuth: 225.0,
            x_scale,
            ..Light::default()
        };
        let even = shades(&grid(frame, |x, y| x + y), light(1.0))[9];
        assert_eq!(steep(light(0.5)), even);
        assert_ne!(steep(light(1.0)), even);
    }

    #[test]
    fn refuses_light_that_is_no_number() {
        let grid = grid(Frame::north_up(0.0, 0.0, 1.0, 4, 4), |_, _| 0.0);
        let error = Hillshade::new(
            &grid,
            Light {
                altitude: f64::NAN,
                ..Light::default()
            },
        )
        .unwrap_err();
        assert_eq!(
            error.to_string(),
            "the altitude of the light is NaN, expected a number"
        );
    }
}
