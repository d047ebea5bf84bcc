//! Queries of many positions at once: on all threads of the pool, in an order that keeps walks
//! short.

use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};

use breakline::triangulation::tds::{CellId, Complex, Neighbors, Tds, VertexId};
use breakline::triangulation::{Location, spatial_order};
use numpy::ndarray::ArrayView2;
use rayon::prelude::*;

use super::mesh::{CHUNK, Dimension, Mesh, NONE};

/// So many queries are answered one by one, on the calling thread.
pub(super) const FEW: usize = 64;

/// Queries whose successors lie this many simplices away on average are sorted first.
const FAR: f64 = 8.0;

/// The number of pairs of successive queries whose distance is looked at.
const SAMPLES: usize = 1 << 10;

/// The most simplices that a search for one within a tolerance looks at.
const PATIENCE: usize = 1 << 8;

/// A simplex is flat if its volume, times `D!`, is at most this part of that of a cube around it.
/// Along a straight side whose points are rounded, all simplices at the hull are. Barycentric
/// coordinates in them are mere rounding errors.
const FLAT: f64 = 1e-10;

/// How far outside of a neighbor of a flat simplex a position in that simplex may be, in
/// barycentric coordinates; as in scipy.
const BROAD: f64 = 1.5e-8;

/// Values at the vertices: `width` numbers for each.
pub(super) struct Field {
    values: Vec<f64>,
    width: usize,
}

impl Field {
    fn at(&self, vertex: VertexId) -> &[f64] {
        &self.values[vertex.index() * self.width..][..self.width]
    }

    /// Returns the weighted mean of values, exactly the value where only one weight is not zero.
    fn mean(&self, weights: impl Iterator<Item = (VertexId, f64)>, mean: &mut [f64]) {
        let mut weights = weights.filter(|&(_, weight)| weight != 0.0);
        let Some((first, _)) = weights.next() else { return };
        // Relative to one of them, so that constant values are reproduced.
        let origin = self.at(first);
        mean.copy_from_slice(origin);
        for (vertex, weight) in weights {
            for ((mean, value), origin) in mean.iter_mut().zip(self.at(vertex)).zip(origin) {
                *mean += weight * (value - origin);
            }
        }
    }
}

/// Where a position is.
enum Site<const N: usize> {
    Vertex(VertexId),
    /// In this cell, by these barycentric coordinates, which are not negative and sum up to 1.
    Cell(CellId, [f64; N]),
    Outside,
}

impl<G: Dimension<N, D>, const N: usize, const D: usize> Mesh<G, N, D> {
    /// Returns the values of points, one row for each, as those of the vertices.
    pub(super) fn field(&self, values: ArrayView2<'_, f64>) -> Field {
        let width = values.ncols();
        let mut of_vertices = vec![0.0; self.point_of.len() * width];
        if width > 0 {
            let rows = of_vertices.par_chunks_exact_mut(width).with_min_len(CHUNK).zip(&self.point_of);
            rows.filter(|(_, point)| **point != NONE).for_each(|(row, &point)| {
                row.iter_mut().zip(values.row(point as usize)).for_each(|(to, from)| *to = *from);
            });
        }
        Field { values: of_vertices, width }
    }

    /// Returns the simplex at each position; [`NONE`] outside of the hull. Outside by at most a
    /// tolerance, in barycentric coordinates, counts as inside.
    pub(super) fn find(&self, queries: &[[f64; D]], tolerance: f64, cancel: &AtomicBool) -> Vec<i32> {
        self.each(queries, &[NONE], cancel, |q, near, found| {
            let (site, near) = self.site(q, near, tolerance);
            found[0] = match site {
                Site::Vertex(_) => near.map_or(NONE, |cell| self.simplex(cell)),
                Site::Cell(cell, _) => self.simplex(cell),
                Site::Outside => NONE,
            };
            near
        })
    }

    /// Returns values that are linear on each simplex, and `outside` beyond the hull.
    pub(super) fn linear(
        &self,
        queries: &[[f64; D]],
        field: &Field,
        outside: &[f64],
        tolerance: f64,
        cancel: &AtomicBool,
    ) -> Vec<f64> {
        self.each(queries, outside, cancel, |q, near, mean| self.linear_at(q, near, field, tolerance, mean))
    }

    fn linear_at(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
        field: &Field,
        tolerance: f64,
        mean: &mut [f64],
    ) -> Option<CellId> {
        let (site, near) = self.site(q, near, tolerance);
        match site {
            Site::Vertex(vertex) => mean.copy_from_slice(field.at(vertex)),
            Site::Cell(cell, weights) => {
                field.mean(self.t.tds().corners(cell).iter().copied().zip(weights), mean);
            }
            Site::Outside => {}
        }
        near
    }

    /// Returns values by Sibson's coordinates, and `outside` beyond the hull.
    pub(super) fn natural(
        &self,
        queries: &[[f64; D]],
        field: &Field,
        outside: &[f64],
        tolerance: f64,
        cancel: &AtomicBool,
    ) -> Vec<f64> {
        self.each(queries, outside, cancel, |q, near, mean| {
            let location = self.t.locate(q, near);
            let near = location.cell(&self.t).or(near);
            let is_at_rim = matches!(location, Location::Cell { cell, .. } if self.is_at_rim(cell, q));
            let Some(weights) = (if is_at_rim { None } else { G::sibson(&self.t, q, near) }) else {
                // On the hull up to a rounding error, where the limit is linear; outside; or where
                // squares overflow or underflow.
                return self.linear_at(q, near, field, tolerance, mean);
            };
            field.mean(weights.iter().copied(), mean);
            weights.first().and_then(|&(vertex, _)| self.t.tds().cell_of(vertex))
        })
    }

    /// Returns the point nearest to each position; of several, the first by their coordinates.
    /// [`NONE`] for a position that is not finite.
    pub(super) fn nearest(&self, queries: &[[f64; D]], cancel: &AtomicBool) -> Vec<i32>
    where
        Tds<N>: Neighbors<N, Error = Infallible>,
    {
        self.each(queries, &[NONE], cancel, |q, near, nearest| {
            let vertex = self.t.nearest(q, near)?;
            nearest[0] = self.point_of[vertex.index()];
            self.t.tds().cell_of(vertex)
        })
    }

    /// Calls `work` for each position with a cell from which to search and the numbers of its
    /// result, which are those of `blank`; it returns the cell that it found.
    ///
    /// Results do not depend on the number of threads: tasks are the same for any number of them.
    fn each<T: Copy + Send + Sync>(
        &self,
        queries: &[[f64; D]],
        blank: &[T],
        cancel: &AtomicBool,
        work: impl Fn(&[f64; D], Option<CellId>, &mut [T]) -> Option<CellId> + Sync,
    ) -> Vec<T> {
        let mut results = blank.repeat(queries.len());
        let width = blank.len();
        if width == 0 {
            return results;
        }
        let answer = |results: &mut [T], index: &dyn Fn(usize) -> usize| {
            let mut near = None;
            for (rank, result) in results.chunks_exact_mut(width).enumerate() {
                near = work(&queries[index(rank)], near, result).or(near);
            }
        };
        if queries.len() <= FEW {
            answer(&mut results, &|rank| rank);
            return results;
        }
        let order = if self.are_far_apart(queries) { self.order_of(queries) } else { None };
        results.par_chunks_mut(CHUNK * width).enumerate().for_each(|(chunk, results)| {
            if cancel.load(Ordering::Relaxed) {
                return;
            }
            let start = chunk * CHUNK;
            match &order {
                Some(order) => answer(results, &|rank| order[start + rank] as usize),
                None => answer(results, &|rank| start + rank),
            }
        });
        let Some(order) = order else { return results };
        let mut in_given_order = blank.repeat(queries.len());
        for (result, &index) in results.chunks_exact(width).zip(&order) {
            in_given_order[index as usize * width..][..width].copy_from_slice(result);
        }
        in_given_order
    }

    /// Returns true if walks from each query to the next would be long, by a sample.
    fn are_far_apart(&self, queries: &[[f64; D]]) -> bool {
        let [low, high] = &self.bounds;
        let step = queries.len().div_ceil(SAMPLES).max(1);
        let pairs = queries.windows(2).step_by(step);
        let count = pairs.len() as f64;
        let largest = |p: &[f64; D], q: &[f64; D]| {
            let part = |axis: usize| ((p[axis] - q[axis]) / (high[axis] - low[axis])).abs();
            (0..D).map(part).fold(0.0, f64::max).min(1.0)
        };
        let sum: f64 = pairs.map(|pair| largest(&pair[0], &pair[1])).sum();
        // The width of a simplex, if all are alike.
        let width = (self.t.vertex_count().max(1) as f64).powf(-1.0 / D as f64);
        sum > FAR * width * count
    }

    /// Returns the queries in spatial order; `None` if they are too many to be sorted.
    fn order_of(&self, queries: &[[f64; D]]) -> Option<Vec<u32>> {
        let [low, high] = &self.bounds;
        // Positions far away must not make the curve coarse; nor what is not a number.
        let within = |i: usize| -> [f64; D] {
            let q = &queries[i];
            std::array::from_fn(|axis| q[axis].max(low[axis]).min(high[axis]))
        };
        spatial_order(queries.len(), within).ok()
    }

    /// Returns where a position is, and a finite cell there or nearby.
    fn site(&self, q: &[f64; D], near: Option<CellId>, tolerance: f64) -> (Site<N>, Option<CellId>) {
        let tds = self.t.tds();
        match self.t.locate(q, near) {
            Location::Vertex(vertex) => {
                let cell = tds.cell_of(vertex).map(|cell| self.inside_of(cell));
                (Site::Vertex(vertex), cell)
            }
            Location::Cell { cell, facets } => {
                let mut sides = self.sides(cell, q);
                if facets.is_empty() && self.is_flat(cell, &sides) {
                    let beside = self.within_tolerance(q, cell, BROAD);
                    if let Site::Cell(..) = beside {
                        return (beside, Some(cell));
                    }
                }
                (0..N).filter(|&i| facets.contains(i)).for_each(|i| sides[i] = 0.0);
                (Site::Cell(cell, weights(sides)), Some(cell))
            }
            Location::OutsideHull { cell } => {
                let inside = self.inside_of(cell);
                (self.within_tolerance(q, inside, tolerance), Some(inside))
            }
            Location::OutsideAffineHull | Location::Nowhere => (Site::Outside, None),
        }
    }

    /// Returns the cell itself if it is finite, or the finite one across the hull.
    fn inside_of(&self, cell: CellId) -> CellId {
        let Ok(inside) = self.t.tds().inner(cell);
        inside
    }

    /// Returns about how far a position lies inside of each facet of a finite cell: volumes.
    fn sides(&self, cell: CellId, q: &[f64; D]) -> [f64; N] {
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        self.t.geometry().rough_sides(corners, q).unwrap_or([f64::NAN; N])
    }

    /// Returns true if barycentric coordinates in a cell are not reliable; given its volumes.
    fn is_flat(&self, cell: CellId, sides: &[f64; N]) -> bool {
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let width = |axis: usize| {
            let (low, high) = corners
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
            high - low
        };
        let width = (0..D).map(width).fold(0.0, f64::max);
        let volume: f64 = sides.iter().sum();
        volume <= FLAT * width.powi(D as i32)
    }

    /// Returns true if a position in a cell is at the hull, or in or beside a flat cell there, up
    /// to rounding errors.
    fn is_at_rim(&self, cell: CellId, q: &[f64; D]) -> bool {
        let sides = self.sides(cell, q);
        let sum: f64 = sides.iter().sum();
        let is_rim = |beyond: CellId| self.t.tds().is_infinite(beyond) || self.is_flat(beyond, &self.sides(beyond, q));
        self.is_flat(cell, &sides) || (0..N).any(|i| sides[i] <= BROAD * sum && is_rim(self.t.tds().neighbor(cell, i)))
    }

    /// Searches near a cell for one that is not flat and that contains a position, up to a
    /// tolerance; flat cells are passed to all sides.
    fn within_tolerance(&self, q: &[f64; D], start: CellId, tolerance: f64) -> Site<N> {
        let tds = self.t.tds();
        let mut seen = vec![start];
        let mut next = 0;
        while next < seen.len().min(PATIENCE) {
            let cell = seen[next];
            next += 1;
            let sides = self.sides(cell, q);
            let is_flat = self.is_flat(cell, &sides);
            let least = (0..N).min_by(|&i, &j| sides[i].total_cmp(&sides[j])).unwrap_or(0);
            if !is_flat && sides[least] >= -tolerance * sides.iter().sum::<f64>() {
                return Site::Cell(cell, weights(sides));
            }
            for i in (0..N).filter(|&i| is_flat || i == least) {
                let beyond = tds.neighbor(cell, i);
                if !tds.is_infinite(beyond) && !seen.contains(&beyond) {
                    seen.push(beyond);
                }
            }
        }
        Site::Outside
    }
}

/// Returns barycentric coordinates in proportion to volumes. In a cell that is too small for a
/// double to hold its volume, all corners are as good as one.
fn weights<const N: usize>(sides: [f64; N]) -> [f64; N] {
    let sides = sides.map(|side| side.max(0.0));
    let sum: f64 = sides.iter().sum();
    if sum > 0.0 && sum.is_finite() {
        return sides.map(|side| side / sum);
    }
    std::array::from_fn(|i| if i == 0 { 1.0 } else { 0.0 })
}
