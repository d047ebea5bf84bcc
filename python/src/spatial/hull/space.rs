//! In space: one point after the other, each time the farthest outside of some facet (Barber,
//! Dobkin and Huhdanpaa 1996), with exact predicates: a facet is visible if the point is outside of
//! its plane, so that new facets are never flat.

use std::sync::atomic::{AtomicBool, Ordering};

use breakline::triangulation::InputError;
use breakline::triangulation::geometry::{Geometry, Space};
use breakline::triangulation::kernel::{Adaptive, Kernel, Orientation3};
use breakline::triangulation::num::{Bounded, Sign};
use rayon::prelude::*;

use super::flat::{Facet, in_flat_sides};
use super::inner_box::{Bounds, bounds, not_inside};
use super::listed::{Hull, equation};
use crate::spatial::lists::CHUNK;

/// A facet of the hull of the points so far.
struct Growing {
    facet: Facet,
    plane: Rounded,
    /// Points outside of its plane, each at one facet only, and the farthest of them.
    outside: Vec<u32>,
    farthest: Option<(u32, f64)>,
    /// The last point that was compared with its plane, and if it is outside.
    seen: (u32, bool),
}

/// The plane of a facet in floating-point numbers.
#[derive(Clone, Copy)]
struct Rounded {
    /// The first corner.
    at: [f64; 3],
    /// Outward; its length is twice the area.
    normal: [f64; 3],
    /// A bound on the error of heights of points in the bounding box.
    error: f64,
}

impl Rounded {
    fn new([a, b, c]: [[f64; 3]; 3], bounds: &Bounds) -> Self {
        let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| Bounded::difference(p[k], q[k]));
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
        // Errors grow with the distances along the axes: at most those from a corner of the box.
        let along = |axis: usize| {
            let [to_low, to_high] = [0, 1].map(|end| bounds[end][axis] - a[axis]);
            let far = if to_high > -to_low { 1 } else { 0 };
            normal[axis] * Bounded::difference(bounds[far][axis], a[axis])
        };
        Rounded {
            at: a,
            normal: normal.map(Bounded::value),
            error: (along(0) + along(1) + along(2)).error(),
        }
    }

    /// Returns how far a point is outside, times the length of the normal.
    #[inline]
    fn height(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, minus(p, self.at))
    }
}

/// The hull of the points so far.
struct Quickhull<'a> {
    points: &'a [[f64; 3]],
    /// The box around all points.
    bounds: Bounds,
    facets: Vec<Growing>,
    /// Facets that are no more.
    free: Vec<u32>,
    /// Facets that may have points outside.
    open: Vec<u32>,
    /// The new facet at each vertex of the horizon that starts with it.
    starts_at: Vec<u32>,
}

/// Returns the hull; `None` if the points are coplanar.
pub(super) fn hull(
    points: &[[f64; 3]],
    cancel: &AtomicBool,
) -> Result<Option<Hull<3>>, InputError> {
    let bounds = bounds(points);
    let candidates = not_inside(points, &bounds);
    if cancel.load(Ordering::Relaxed) {
        return Err(InputError::Canceled);
    }
    let Some(solid) = first_solid(points, &candidates) else {
        return Ok(None);
    };
    let mut growing = Quickhull::new(points, bounds, solid, &candidates);
    while let Some(facet) = growing.open.pop() {
        if cancel.load(Ordering::Relaxed) {
            return Err(InputError::Canceled);
        }
        if let Some((point, _)) = growing.facets[facet as usize].farthest {
            growing.add(point, facet);
        }
    }
    Ok(Some(listed(
        points,
        &in_flat_sides(points, growing.ended()),
    )))
}

fn minus(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| p[axis] - q[axis])
}

fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i])
}

fn dot(p: [f64; 3], q: [f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

/// Returns the one of some points with the largest measure, the first of several.
fn largest(
    points: &[[f64; 3]],
    of: &[u32],
    measure: impl Fn([f64; 3]) -> f64 + Sync,
) -> Option<u32> {
    let larger = |p: (u32, f64), q: (u32, f64)| {
        if q.1 > p.1 || (q.1 == p.1 && q.0 < p.0) {
            q
        } else {
            p
        }
    };
    let all = of.par_iter().with_min_len(CHUNK);
    all.map(|&k| (k, measure(points[k as usize])))
        .reduce_with(larger)
        .map(|(k, _)| k)
}

/// Returns four of some points that are not coplanar, positively oriented and about as far from
/// each other as points are; `None` if there are none.
fn first_solid(points: &[[f64; 3]], of: &[u32]) -> Option<[u32; 4]> {
    let at = |p: u32| points[p as usize];
    // By floating-point numbers if these find some, otherwise the first.
    let chosen = |p: Option<u32>, is_good: &dyn Fn(u32) -> bool| {
        p.filter(|&p| is_good(p))
            .or_else(|| of.iter().copied().find(|&p| is_good(p)))
    };
    let a = largest(points, of, |p| -p[0])?;
    let b = largest(points, of, |p| {
        let d = minus(p, at(a));
        dot(d, d)
    });
    let b = chosen(b, &|p| at(p) != at(a))?;
    let along = minus(at(b), at(a));
    let c = largest(points, of, |p| {
        let normal = cross(along, minus(p, at(a)));
        dot(normal, normal)
    });
    let spans = |p: u32| Space::new().orientation_in_flat(&[&at(a), &at(b), &at(p)]);
    let c = chosen(c, &|p| spans(p) != Sign::Zero)?;
    let normal = cross(along, minus(at(c), at(a)));
    let d = largest(points, of, |p| dot(normal, minus(p, at(a))).abs());
    let side = |p: u32| Adaptive::sign(&Orientation3([a, b, c, p].map(at)));
    let d = chosen(d, &|p| side(p) != Sign::Zero)?;
    Some(if side(d) == Sign::Positive {
        [a, b, c, d]
    } else {
        [a, c, b, d]
    })
}

impl<'a> Quickhull<'a> {
    /// Begins with a solid of four of some points; the others are inside of the hull.
    fn new(points: &'a [[f64; 3]], bounds: Bounds, [a, b, c, d]: [u32; 4], of: &[u32]) -> Self {
        // Facet `k` is opposite corner `k` of `a b c d`: corners, and the facet opposite each.
        let facets = [
            ([b, c, d], [1, 2, 3]),
            ([a, d, c], [0, 3, 2]),
            ([a, b, d], [0, 1, 3]),
            ([a, c, b], [0, 2, 1]),
        ];
        let facets = facets.map(|(corners, neighbors)| Facet { corners, neighbors });
        let mut hull = Quickhull {
            points,
            bounds,
            facets: Vec::new(),
            free: Vec::new(),
            open: Vec::new(),
            starts_at: vec![0; points.len()],
        };
        let new: Vec<u32> = facets.into_iter().map(|facet| hull.push(facet)).collect();
        hull.assign(of, &new);
        hull
    }

    /// Returns about how far a point is outside of a facet, compared with other points; `None` if
    /// it is not outside, which is exact.
    fn height(&self, facet: u32, point: u32) -> Option<f64> {
        let Growing { facet, plane, .. } = &self.facets[facet as usize];
        let height = plane.height(self.points[point as usize]);
        let is_outside = if height.abs() > plane.error {
            height > 0.0
        } else {
            let [a, b, c] = facet.corners;
            let corners = [a, b, c, point].map(|p| self.points[p as usize]);
            Adaptive::sign(&Orientation3(corners)) == Sign::Positive
        };
        is_outside.then_some(height)
    }

    fn push(&mut self, facet: Facet) -> u32 {
        let corners = facet.corners.map(|p| self.points[p as usize]);
        let new = Growing {
            facet,
            plane: Rounded::new(corners, &self.bounds),
            outside: Vec::new(),
            farthest: None,
            seen: (u32::MAX, false),
        };
        match self.free.pop() {
            Some(free) => {
                self.facets[free as usize] = new;
                free
            }
            None => {
                self.facets.push(new);
                self.facets.len() as u32 - 1
            }
        }
    }

    /// Gives each of some points to one of new facets that it is outside of; those that are outside
    /// of none are in the hull.
    fn assign(&mut self, points: &[u32], new: &[u32]) {
        let this = &*self;
        let facet_of = |&point: &u32| {
            new.iter()
                .find_map(|&facet| Some((facet, this.height(facet, point)?)))
        };
        let found: Vec<Option<(u32, f64)>> = if points.len() < CHUNK {
            points.iter().map(facet_of).collect()
        } else {
            let all = points.par_iter().with_min_len(CHUNK);
            all.map(facet_of).collect()
        };
        for (&point, found) in points.iter().zip(found) {
            let Some((facet, height)) = found else {
                continue;
            };
            let of = &mut self.facets[facet as usize];
            of.outside.push(point);
            if of.farthest.is_none_or(|(_, most)| height > most) {
                of.farthest = Some((point, height));
            }
        }
        let open = new
            .iter()
            .filter(|&&facet| self.facets[facet as usize].farthest.is_some());
        self.open.extend(open);
    }

    /// Adds a point that is outside of a facet.
    fn add(&mut self, point: u32, facet: u32) {
        let mut visible = vec![facet];
        // Facets that are not visible, and the side that they share with one that is.
        let mut horizon: Vec<(u32, [u32; 2])> = Vec::new();
        self.facets[facet as usize].seen = (point, true);
        let mut next = 0;
        while let Some(&here) = visible.get(next) {
            next += 1;
            let Facet { corners, neighbors } = self.facets[here as usize].facet;
            for (k, beyond) in neighbors.into_iter().enumerate() {
                if self.facets[beyond as usize].seen.0 != point {
                    let is_visible = self.height(beyond, point).is_some();
                    self.facets[beyond as usize].seen = (point, is_visible);
                    visible.extend(is_visible.then_some(beyond));
                }
                if !self.facets[beyond as usize].seen.1 {
                    horizon.push((beyond, [corners[(k + 1) % 3], corners[(k + 2) % 3]]));
                }
            }
        }
        let mut orphans = Vec::new();
        for &gone in &visible {
            let gone = &mut self.facets[gone as usize];
            orphans.append(&mut gone.outside);
            gone.farthest = None;
        }
        let new = self.cone(point, &horizon);
        self.free.extend(visible);
        self.assign(&orphans, &new);
    }

    /// Joins a point to the horizon, and returns the new facets.
    fn cone(&mut self, apex: u32, horizon: &[(u32, [u32; 2])]) -> Vec<u32> {
        let mut new = Vec::with_capacity(horizon.len());
        for &(beyond, [a, b]) in horizon {
            let facet = self.push(Facet {
                corners: [a, b, apex],
                neighbors: [u32::MAX, u32::MAX, beyond],
            });
            let other = &mut self.facets[beyond as usize].facet;
            let side = (0..3).find(|&k| other.corners[k] != a && other.corners[k] != b);
            other.neighbors[side.unwrap_or_default()] = facet;
            self.starts_at[a as usize] = facet;
            new.push(facet);
        }
        // The horizon is a ring: the side after `a b` starts at `b`.
        for &facet in &new {
            let after = self.starts_at[self.facets[facet as usize].facet.corners[1] as usize];
            self.facets[facet as usize].facet.neighbors[0] = after;
            self.facets[after as usize].facet.neighbors[1] = facet;
        }
        new
    }

    /// Returns the facets, numbered anew without those that are no more.
    fn ended(self) -> Vec<Facet> {
        let mut is_free = vec![false; self.facets.len()];
        for free in self.free {
            is_free[free as usize] = true;
        }
        let mut count = 0;
        let numbers: Vec<u32> = is_free
            .iter()
            .map(|is_free| {
                let number = count;
                count += u32::from(!is_free);
                number
            })
            .collect();
        let kept = self.facets.into_iter().zip(is_free);
        kept.filter(|(_, is_free)| !is_free)
            .map(|(growing, _)| Facet {
                corners: growing.facet.corners,
                neighbors: growing.facet.neighbors.map(|facet| numbers[facet as usize]),
            })
            .collect()
    }
}

/// Returns a hull by its facets.
fn listed(points: &[[f64; 3]], facets: &[Facet]) -> Hull<3> {
    let mut vertices: Vec<i32> = facets
        .iter()
        .flat_map(|f| f.corners)
        .map(|p| p as i32)
        .collect();
    vertices.par_sort_unstable();
    vertices.dedup();
    let origin = vertices.first().map_or([0.0; 3], |&p| points[p as usize]);
    let (mut six_volumes, mut area) = (0.0, 0.0);
    let mut normals = Vec::with_capacity(facets.len());
    for facet in facets {
        let corners = facet.corners.map(|p| points[p as usize]);
        let normal = normal(corners);
        six_volumes += dot(normal, minus(corners[0], origin));
        area += dot(normal, normal).sqrt() / 2.0;
        normals.push(equation(normal, corners[0]));
    }
    Hull {
        vertices,
        facets: facets.iter().map(|f| f.corners.map(|p| p as i32)).collect(),
        neighbors: facets
            .iter()
            .map(|f| f.neighbors.map(|f| f as i32))
            .collect(),
        normals,
        volume: six_volumes / 6.0,
        area,
    }
}

/// Returns the cross product of two sides, each coordinate correct to the last bits, however thin
/// the triangle is.
fn normal(corners: [[f64; 3]; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let [a, b, c] = corners.map(|p| [p[i], p[j]]);
        breakline::triangulation::kernel::twice_area(a, b, c)
    })
}
