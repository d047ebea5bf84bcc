//! Positions from the center of the earth, for viewers: on the ellipsoid of WGS 84.

const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// The semi-axes of the ellipsoid, in meters: those along X and Y, and that along Z.
pub(crate) const SEMI_AXES: [f64; 3] = [6_378_137.0, 6_378_137.0, 6_378_137.0 * (1.0 - FLATTENING)];

/// Returns X, Y and Z from the center of the earth of a longitude and a latitude in degrees, and a
/// height above the ellipsoid, all lengths in meters (EPSG method 9602).
pub(crate) fn geocentric([longitude, latitude, height]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = latitude.to_radians().sin_cos();
    let (sin_longitude, cos_longitude) = longitude.to_radians().sin_cos();
    let square = FLATTENING * (2.0 - FLATTENING);
    let radius = SEMI_AXES[0] / (1.0 - square * sin * sin).sqrt();
    [
        (radius + height) * cos * cos_longitude,
        (radius + height) * cos * sin_longitude,
        (radius * (1.0 - square) + height) * sin,
    ]
}

/// Turns a vector at a longitude and a latitude in degrees: from the directions east, north and up
/// there to X, Y and Z.
pub(crate) fn from_local([longitude, latitude]: [f64; 2], [east, north, up]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = latitude.to_radians().sin_cos();
    let (sin_longitude, cos_longitude) = longitude.to_radians().sin_cos();
    let outward = up * cos - north * sin;
    [
        outward * cos_longitude - east * sin_longitude,
        outward * sin_longitude + east * cos_longitude,
        north * cos + up * sin,
    ]
}

#[cfg(test)]
mod tests {
    use super::{SEMI_AXES, from_local, geocentric};

    /// The example of EPSG's guidance note 7-2 for the method 9602.
    #[test]
    fn the_published_example() {
        let degrees = |d: f64, m: f64, s: f64| d + m / 60.0 + s / 3600.0;
        let [latitude, longitude] = [degrees(53.0, 48.0, 33.82), degrees(2.0, 7.0, 46.38)];
        let [x, y, z] = geocentric([longitude, latitude, 73.0]);
        let published = [3_771_793.968, 140_253.342, 5_124_304.349];
        for (found, expected) in [x, y, z].into_iter().zip(published) {
            assert!((found - expected).abs() < 0.01, "{found} {expected}");
        }
        let [_, _, pole] = geocentric([0.0, 90.0, 0.0]);
        assert!((pole - SEMI_AXES[2]).abs() < 1e-6);
    }

    /// Up is where a position goes with its height.
    #[test]
    fn local_directions_are_those_of_positions() {
        for [longitude, latitude] in [[7.0, 46.0], [-120.0, -33.0], [0.0, 0.0], [179.0, 80.0]] {
            let step = [1e-5, 1e-5, 1.0];
            for axis in 0..3 {
                let mut moved = [longitude, latitude, 100.0];
                moved[axis] += step[axis];
                let [from, to] = [[longitude, latitude, 100.0], moved].map(geocentric);
                let moved_by = [0, 1, 2].map(|k| to[k] - from[k]);
                let length = moved_by.iter().map(|c| c * c).sum::<f64>().sqrt();
                let mut local = [0.0; 3];
                local[axis] = length;
                let turned = from_local([longitude, latitude], local);
                assert!((0..3).all(|k| (turned[k] - moved_by[k]).abs() < 1e-5 * length));
            }
        }
    }
}
