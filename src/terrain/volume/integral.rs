//! The volume between two surfaces over a polygon on which the difference of heights is linear.

use crate::terrain::overlay::{Corner, Number};

/// Volumes and areas over a polygon: where the first surface is higher, and where the second is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::terrain) struct Integral {
    /// Of each surface: the volume below it and above the other one.
    pub(in crate::terrain) volumes: [f64; 2],
    /// The areas of these.
    pub(in crate::terrain) areas: [f64; 2],
    /// The area of the polygon.
    pub(in crate::terrain) area: f64,
}

/// Returns the volumes and areas over a convex polygon, counter-clockwise.
///
/// With the surfaces exchanged, the same numbers are exchanged.
pub(in crate::terrain) fn integral<T: Number>(corners: &[Corner<T>]) -> Integral {
    let mut sum = Integral::default();
    let Some((first, others)) = corners.split_first() else {
        return sum;
    };
    for pair in others.windows(2) {
        sum.add_triangle([first, &pair[0], &pair[1]]);
    }
    sum
}

impl Integral {
    fn add_triangle<T: Number>(&mut self, corners: [&Corner<T>; 3]) {
        let [a, b, c] = corners.map(|corner| corner.at);
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        // Less than 0 by rounding only.
        let area = match twice.value() > 0.0 {
            true => twice * T::of(0.5),
            false => T::of(0.0),
        };
        let above = corners.map(|corner| corner.heights[0] - corner.heights[1]);
        let whole = area * ((above[0] + above[1] + above[2]) / T::of(3.0));
        self.area += area.value();
        let signs = above.map(T::value);
        let is_mixed = signs.iter().any(|&d| d > 0.0) && signs.iter().any(|&d| d < 0.0);
        if !is_mixed {
            self.add_part(whole.value(), area.value());
            return;
        }
        // One corner is alone on its side of the line on which both are equally high.
        // (Signs are compared: products of small numbers may be 0.)
        let is_alone = |i: usize| {
            let [d, e, f] = [signs[i], signs[(i + 1) % 3], signs[(i + 2) % 3]];
            d > 0.0 && e <= 0.0 && f <= 0.0 || d < 0.0 && e >= 0.0 && f >= 0.0
        };
        let alone = (0..3).find(|&i| is_alone(i)).unwrap_or(0);
        let [d, e, f] = [0, 1, 2].map(|k| above[(alone + k) % 3]);
        let tip = area * (d / (d - e)) * (d / (d - f));
        let of_tip = tip * (d / T::of(3.0));
        self.add_part(of_tip.value(), tip.value());
        self.add_part((whole - of_tip).value(), (area - tip).value());
    }

    /// Adds a volume over an area in which one surface is nowhere below the other.
    fn add_part(&mut self, volume: f64, area: f64) {
        if volume == 0.0 {
            return;
        }
        let higher = usize::from(volume < 0.0);
        self.volumes[higher] += volume.abs();
        self.areas[higher] += area;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(at: [f64; 2], above: f64) -> Corner {
        Corner {
            at,
            heights: [above, 0.0],
        }
    }

    #[test]
    fn a_triangle_is_divided_where_both_are_equally_high() {
        // Of corners that differ by 1, -1, -1, a quarter of the area is above.
        for scale in [1.0, 1e-200] {
            let corners = [
                corner([0.0, 0.0], scale),
                corner([2.0, 0.0], -scale),
                corner([0.0, 2.0], -scale),
            ];
            let found = integral(&corners);
            assert_eq!(found.areas, [0.5, 1.5]);
            assert!((found.volumes[0] / scale - 1.0 / 6.0).abs() < 1e-15);
            assert!((found.volumes[1] / scale - 5.0 / 6.0).abs() < 1e-15);
        }
    }

    #[test]
    fn exchanged_surfaces_exchange_all_numbers() {
        for above in [
            [0.3, -0.7, 0.2],
            [0.0, 0.1, -0.4],
            [0.0, 0.0, 0.9],
            [-1.0, 0.0, 0.5],
        ] {
            let corners = |sign: f64| {
                let at = [[0.1, 0.2], [7.3, 0.4], [3.1, 5.9]];
                [0, 1, 2].map(|i| corner(at[i], sign * above[i]))
            };
            let [found, other] = [1.0, -1.0].map(|sign| integral(&corners(sign)));
            assert_eq!(found.volumes, [other.volumes[1], other.volumes[0]]);
            assert_eq!(found.areas, [other.areas[1], other.areas[0]]);
            assert_eq!(found.area, other.area);
        }
    }
}
