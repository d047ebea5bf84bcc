//! Shaded relief.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::crs::{Crs, CrsKind};
use crate::data::{BlockSource, Frame};
use crate::error::{Error, Result};

use super::{Focal, Neighbors, Rule};

/// Meters in one radian of a great circle on the mean earth (6 371 008.8 m, Moritz 2000).
const EARTH_RADIUS: f64 = 6_371_008.8;

/// How the shade of a cell follows from its gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Shading {
    /// The cosine of the angle between the surface and the light, 0 in the shadow.
    #[default]
    Standard,
    /// That angle times the slope, so that steep ground is dark on either side: the combined
    /// shading of `gdaldem`.
    Combined,
    /// Standard shades of four lights, from 225, 270, 315 and 360 degrees, weighted by the share
    /// of the gradient that is along each: the multidirectional shading of `gdaldem`, after Mark
    /// (1992).
    Multidirectional,
    /// Dark where steep ground faces away from the light; level ground is white, so that colors
    /// below stay as they are: the shading of `gdaldem` named after Igor Brejc (Maperitive).
    Igor,
}

impl Shading {
    /// Returns true if shades depend on the direction that the light comes from.
    pub fn has_azimuth(self) -> bool {
        self != Shading::Multidirectional
    }

    /// Returns true if shades depend on the angle of the light above the horizon.
    pub fn has_altitude(self) -> bool {
        self != Shading::Igor
    }
}

/// The direction of the light, how it shades, and the ratio of heights to lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// How shades follow from gradients.
    pub shading: Shading,
    /// The direction that the light comes from, in degrees clockwise from north; not used by
    /// [`Shading::Multidirectional`].
    pub azimuth: f64,
    /// The angle of the light above the horizon, in degrees; not used by [`Shading::Igor`].
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
            shading: Shading::default(),
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

/// The hillshade of a raster of heights: whole numbers from 1 (dark) to 255 (bright), NaN where
/// there is no height.
///
/// Slopes are those of Horn (1981), "Hill shading and the reflectance map": weighted differences
/// over the 3 x 3 cells around each cell, as in `gdaldem hillshade`. At the edge of the data the
/// surface is extrapolated linearly, so that the shade of a plane is constant up to its edge.
/// Frames may be rotated; the direction of the light refers to the map, not to the raster.
pub type Hillshade<S> = Focal<S, Shade>;

/// How light falls on a cell.
#[derive(Debug, Clone, Copy)]
pub struct Shade {
    lights: Lights,
    z_factor: f64,
    x_scale: f64,
}

/// A unit vector towards a light: east, north, up.
type Towards = [f64; 3];

/// What each [`Shading`] needs to know of the light.
#[derive(Debug, Clone, Copy)]
enum Lights {
    Standard(Towards),
    Combined(Towards),
    Multidirectional([Towards; 4]),
    Igor(Towards),
}

/// The azimuths of the lights of [`Shading::Multidirectional`].
const FOUR_AZIMUTHS: [f64; 4] = [225.0, 270.0, 315.0, 360.0];

impl<S: BlockSource> Hillshade<S> {
    /// Creates the hillshade of `source`: a DEM, a grid, or a reference to one.
    ///
    /// # Errors
    /// If a number of `light` is not finite, or the frame of the source has no inverse.
    pub fn new(source: S, light: Light) -> Result<Self> {
        let Light {
            shading,
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
        let lights = match shading {
            Shading::Standard => Lights::Standard(towards(azimuth, altitude)),
            Shading::Combined => Lights::Combined(towards(azimuth, altitude)),
            Shading::Multidirectional => {
                Lights::Multidirectional(FOUR_AZIMUTHS.map(|azimuth| towards(azimuth, altitude)))
            }
            Shading::Igor => Lights::Igor(towards(azimuth, 0.0)),
        };
        let rule = Shade {
            lights,
            z_factor,
            x_scale,
        };
        Focal::of_rule(source, rule)
    }
}

/// Returns the unit vector towards a light; angles are in degrees.
fn towards(azimuth: f64, altitude: f64) -> Towards {
    let (east, north) = azimuth.to_radians().sin_cos();
    let (up, flat) = altitude.to_radians().sin_cos();
    [east * flat, north * flat, up]
}

impl Rule for Shade {
    fn value(&self, around: &Neighbors) -> f32 {
        let [dx, dy] = around.gradient_by_horn(self.z_factor);
        let gradient = [dx / self.x_scale, dy];
        let shade = match &self.lights {
            Lights::Standard(towards) => 1.0 + 254.0 * cosine(gradient, towards),
            Lights::Combined(towards) => 1.0 + 254.0 * combined(gradient, towards),
            Lights::Multidirectional(lights) => 1.0 + 254.0 * of_four(gradient, lights),
            Lights::Igor(towards) => 255.0 * (1.0 - shadow(gradient, towards)),
        };
        // 0 is for cells without a height.
        shade.max(1.0).round() as f32
    }
}

/// Returns the cosine of the angle between the normal of a surface with this gradient and the
/// light; negative if the light is behind it.
fn cosine([p, q]: [f64; 2], [east, north, up]: &Towards) -> f64 {
    (up - p * east - q * north) / (1.0 + p * p + q * q).sqrt()
}

/// Returns 1 minus the product of the slope and the angle between normal and light, both as parts
/// of a right angle.
fn combined(gradient: [f64; 2], towards: &Towards) -> f64 {
    let [p, q] = gradient;
    let angle = cosine(gradient, towards).clamp(-1.0, 1.0).acos();
    1.0 - angle * p.hypot(q).atan() / FRAC_PI_2.powi(2)
}

/// Returns the weighted mean of the cosines of four lights, 0 for those behind the surface. The
/// weight of a light is the square of the gradient along it; these squares sum up to twice the
/// square of the gradient.
fn of_four(gradient: [f64; 2], lights: &[Towards; 4]) -> f64 {
    let [p, q] = gradient;
    let (mut sum, mut weights) = (0.0, 0.0);
    for light in lights {
        let [east, north, _] = light;
        let along = p * east + q * north;
        sum += along * along * cosine(gradient, light).max(0.0);
        weights += along * along;
    }
    if weights == 0.0 {
        // Level ground, or a light overhead: all four are the same.
        return cosine(gradient, &lights[0]).max(0.0);
    }
    sum / weights
}

/// Returns the slope as a part of a right angle, times 1 where the surface faces away from the
/// light, 0 where it faces the light.
fn shadow([p, q]: [f64; 2], [east, north, _]: &Towards) -> f64 {
    // The angle between the direction of fall and the one away from the light.
    let (across, along) = (p * north - q * east, p * east + q * north);
    let away = across.atan2(along).abs();
    p.hypot(q).atan() / FRAC_PI_2 * (1.0 - away / PI)
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

    const ALL: [Shading; 4] = [
        Shading::Standard,
        Shading::Combined,
        Shading::Multidirectional,
        Shading::Igor,
    ];

    /// The naive judge: shades by angles, as the documentation of `gdaldem` has them.
    fn by_angles([p, q]: [f64; 2], light: &Light) -> f64 {
        let [altitude, slope] = [light.altitude.to_radians(), p.hypot(q).atan()];
        // The direction of fall, clockwise from north.
        let aspect = (-p).atan2(-q);
        let lit = |azimuth: f64| {
            altitude.sin() * slope.cos()
                + altitude.cos() * slope.sin() * (azimuth.to_radians() - aspect).cos()
        };
        match light.shading {
            Shading::Standard => 1.0 + 254.0 * lit(light.azimuth).max(0.0),
            Shading::Combined => {
                let angle = lit(light.azimuth).clamp(-1.0, 1.0).acos();
                (1.0 + 254.0 * (1.0 - (angle / 90f64.to_radians()) * (slope / 90f64.to_radians())))
                    .max(1.0)
            }
            Shading::Multidirectional if slope == 0.0 => 1.0 + 254.0 * altitude.sin(),
            Shading::Multidirectional => {
                let weighted = FOUR_AZIMUTHS.map(|azimuth| {
                    (azimuth.to_radians() - aspect).cos().powi(2) * lit(azimuth).max(0.0)
                });
                1.0 + 254.0 * 0.5 * weighted.iter().sum::<f64>()
            }
            Shading::Igor => {
                let away = (light.azimuth - 180.0 - aspect.to_degrees()).rem_euclid(360.0);
                let strength = 1.0 - away.min(360.0 - away) / 180.0;
                (255.0 * (1.0 - slope.to_degrees() / 90.0 * strength)).max(1.0)
            }
        }
    }

    #[test]
    fn shades_are_those_of_angles() {
        let frame = Frame::north_up(0.0, 0.0, 1.0, 3, 3);
        // All gradients of small whole numbers, in which slopes along lights and level ground are
        // common.
        for shading in ALL {
            for (azimuth, altitude) in [(315.0, 45.0), (90.0, 20.0), (200.0, 90.0)] {
                let light = Light {
                    shading,
                    azimuth,
                    altitude,
                    ..Light::default()
                };
                for i in 0..81 {
                    let [p, q] = [f64::from(i % 9 - 4), f64::from(i / 9 - 4)];
                    let plane = grid(frame, |x, y| p * x + q * y);
                    let (found, expected) = (shades(&plane, light)[4], by_angles([p, q], &light));
                    assert!(
                        (found - expected).abs() <= 0.5 + 1e-9,
                        "{light:?} on ({p}, {q}): {found}, not {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_shading_depends_on_how_the_raster_lies() {
        let plane = |x: f64, y: f64| 0.8 * x - 0.4 * y;
        for shading in ALL {
            let light = Light {
                shading,
                azimuth: 20.0,
                ..Light::default()
            };
            let expected = by_angles([0.8, -0.4], &light).round();
            for t in [
                [1.0, 0.0, 0.0, -1.0],
                [-2.0, 0.0, 0.0, 0.5],
                [0.6, 0.8, 0.8, -0.6],
            ] {
                let frame = Frame {
                    width: 4,
                    height: 4,
                    transform: [10.0, t[0], t[1], 20.0, t[2], t[3]],
                };
                for shade in shades(&grid(frame, plane), light) {
                    assert_eq!(shade, expected, "{shading:?} in {frame:?}");
                }
            }
        }
    }

    #[test]
    fn level_ground_is_white_where_only_shadows_are_drawn() {
        let frame = Frame::north_up(0.0, 0.0, 1.0, 4, 4);
        let of = |shading, altitude| {
            let light = Light {
                shading,
                altitude,
                ..Light::default()
            };
            shades(&grid(frame, |_, _| 7.0), light)[5]
        };
        assert_eq!(of(Shading::Combined, 45.0), 255.0);
        assert_eq!(of(Shading::Igor, 45.0), 255.0);
        assert_eq!(of(Shading::Multidirectional, 45.0), 181.0);
        assert_eq!(of(Shading::Multidirectional, 90.0), 255.0);
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
