//! What a surface loses with the triangles that are left out at its rim.

use rustc_hash::{FxHashMap, FxHashSet};

use super::linear::plan_distance;
use crate::data::area_of;
use crate::triangulation::tds::{ccw, cw};

/// What a surface loses with the triangles that the [rule of the rim](super::RimRule) leaves out,
/// and with the caps among them: those without an edge longer than the limit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LostAtRim {
    /// The area in plan of all that is left out, as a share of the convex hull: from 0 to 1.
    pub share: f64,
    /// What is lost with caps.
    pub caps: LostCaps,
}

/// What a surface loses with caps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LostCaps {
    /// Their number.
    pub faces: u64,
    /// Their area in plan, as a share of itself and the area that stays, before the surface is
    /// clipped: from 0 to 1.
    pub share: f64,
    /// Vertices of caps all of whose triangles were left out at the rim.
    pub vertices: u64,
}

/// A collection of what is left out at the rim, to find out what the surface loses.
///
/// A vertex has lost all of its triangles if each edge at it has nothing else on either side: a
/// triangle that was left out, or the outside of the hull.
#[derive(Debug, Clone, Default)]
pub struct LeftOutAtRim {
    /// Edges longer than this are open, whatever the shape of a triangle is.
    limit: Option<f64>,
    /// How many of the two sides of an edge are left out or outside, by the numbers of its ends.
    sides: FxHashMap<[u64; 2], u8>,
    hull: Vec<[[f64; 3]; 2]>,
    /// The vertices of caps.
    vertices: FxHashSet<u64>,
    faces: u64,
    area_of_caps: f64,
    area_of_all: f64,
}

impl LeftOutAtRim {
    /// Creates a collection for a longest edge.
    pub fn new(limit: Option<f64>) -> Self {
        LeftOutAtRim {
            limit,
            ..LeftOutAtRim::default()
        }
    }

    /// Adds a triangle that is left out, by the numbers of its vertices and their positions.
    pub fn add(&mut self, vertices: [u64; 3], corners: [[f64; 3]; 3]) {
        let area = area_of(corners).abs();
        self.area_of_all += area;
        let is_long = |i: usize| {
            let length = plan_distance(corners[ccw(i)], corners[cw(i)]);
            self.limit.is_some_and(|limit| length > limit)
        };
        if !(0..3).any(is_long) {
            self.faces += 1;
            self.area_of_caps += area;
            self.vertices.extend(vertices);
        }
        (0..3).for_each(|i| self.add_side([vertices[ccw(i)], vertices[cw(i)]]));
    }

    /// Adds an edge of the hull, by the numbers of its ends and their positions.
    pub fn add_hull(&mut self, ends: [u64; 2], positions: [[f64; 3]; 2]) {
        self.hull.push(positions);
        self.add_side(ends);
    }

    fn add_side(&mut self, [a, b]: [u64; 2]) {
        *self.sides.entry([a.min(b), a.max(b)]).or_default() += 1;
    }

    /// Returns what the surface loses, once all of the hull and all that is left out was added.
    pub fn lost(mut self) -> LostAtRim {
        for (ends, sides) in &self.sides {
            if *sides < 2 {
                ends.iter().for_each(|end| _ = self.vertices.remove(end));
            }
        }
        let kept = (self.area_of_hull() - self.area_of_all).max(0.0);
        let share = |lost: f64| {
            let all = kept + lost;
            match all > 0.0 && all.is_finite() {
                true => lost / all,
                false => 0.0,
            }
        };
        LostAtRim {
            share: share(self.area_of_all),
            caps: LostCaps {
                faces: self.faces,
                share: share(self.area_of_caps),
                vertices: self.vertices.len() as u64,
            },
        }
    }

    /// The hull is convex: triangles from a point within to its edges cover it.
    fn area_of_hull(&self) -> f64 {
        let count = self.hull.len().max(1) as f64;
        let mean = |k: usize| self.hull.iter().map(|[p, _]| p[k] / count).sum();
        let within = [mean(0), mean(1), 0.0];
        let from_within = |&[p, q]: &[[f64; 3]; 2]| area_of([within, p, q]).abs();
        self.hull.iter().map(from_within).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::TinBuilder;

    /// Rails beside a square of points: 0.5 apart, with a point each 10.
    #[test]
    fn rows_as_close_as_rails_are_lost_with_all_of_their_points() {
        let lost = |has_square: bool, limit: f64| {
            let mut builder = TinBuilder::default();
            for i in 0..20 {
                let x = 10.0 * f64::from(i);
                builder.add_points(&[x, x + 3.0], &[0.0, 0.5], &[1.0, 2.0]);
            }
            if has_square {
                for i in 0..400 {
                    let [x, y] = [i % 20, i / 20].map(f64::from);
                    let row = 0.1 * ((x * 7.0 + y * 3.0) % 5.0);
                    builder.add_points(&[10.0 * x + row], &[200.0 + 10.0 * y], &[0.0]);
                }
            }
            (builder.max_edge, builder.leave_out_caps) = (Some(limit), true);
            builder.build().unwrap().report().clone()
        };
        let both = lost(true, 50.0).lost_at_rim.caps;
        assert_eq!(both.vertices, 40, "{both:?}");
        assert!(both.faces > 30 && both.share < 0.01, "{both:?}");
        // What long edges reach is not due to the shape.
        let long = lost(true, 5.0);
        assert_eq!(long.lost_at_rim.caps, LostCaps::default());
        let alone = lost(false, 50.0).lost_at_rim.caps;
        assert!(alone.share > 0.9 && alone.vertices > 30, "{alone:?}");
    }

    /// A square of 3 by 3, and a point 9 beside it.
    #[test]
    fn the_share_of_what_is_left_out_is_that_of_the_hull() {
        let mut builder = TinBuilder::default();
        for i in 0..16 {
            let [x, y] = [i % 4, i / 4].map(f64::from);
            builder.add_points(&[x], &[y], &[x + y]);
        }
        builder.add_points(&[12.0], &[0.0], &[0.0]);
        let share = |max_edge, leave_out_caps| {
            let mut builder = builder.clone();
            (builder.max_edge, builder.leave_out_caps) = (max_edge, leave_out_caps);
            builder.build().unwrap().report().lost_at_rim.share
        };
        // Beside the square is a triangle of 3 by 9.
        assert!((share(Some(5.0), false) - 13.5 / 22.5).abs() < 1e-12);
        assert!((share(Some(5.0), true) - 13.5 / 22.5).abs() < 1e-12);
        assert_eq!(share(Some(50.0), false), 0.0);
        assert_eq!(share(None, false), 0.0);
    }
}
