//! Queries of many positions at once: on all threads of the pool, in an order that keeps walks
//! short.

use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};

use breakline::triangulation::tds::{CellId, Neighbors, Tds, VertexId};
use breakline::triangulation::{Location, spatial_order};
use numpy::ndarray::ArrayView2;
use rayon::prelude::*;

use super::lists::CHUNK;
use super::mesh::{Dimension, Mesh, NONE};

/// So many queries are answered in the order in which they are given.
const FEW: usize = 64;

/// Queries whose successors lie this many simplices away on average are sorted first.
const FAR: f64 = 8.0;

/// The number of pairs of successive queries whose distance is looked at.
const SAMPLES: usize = 1 << 10;

/// The most simplices that a search for one within a tolerance looks at.
const PATIENCE: usize = 1 << 8;

/// Barycentric coordinates are computed exactly in a simplex whose volume, times `D!`, is at most
/// this part of that of a cube around it: doubles would keep fewer than 40 bits of them.
const THIN: f64 = 1e-3;

/// In thinner simplices at the hull, natural neighbors are linear: the areas (volumes) that they
/// are differences of are so large that nothing would be left.
const FLAT: f64 = 1e-10;

/// A simplex is there by rounding if it would have no volume with corners moved along each axis by
/// about as many roundings of the largest coordinate. Along a straight side whose points are
/// rounded, all simplices at the hull are.
const ROUNDINGS: f64 = 4.0;

/// A position is in a simplex for certain if it is inside of each facet by more than this part of
/// the volume, unless the simplex is [`THIN`]: in a cube around it the errors of rounded volumes
/// are less than a hundredth of that, and no coordinate is so small that products underflow.
const CLEAR: f64 = 1e-10;

/// How far outside of a neighbor of such a simplex a position in it may be, in barycentric
/// coordinates; as in scipy.
const BROAD: f64 = 1.5e-8;

/// From where a position is searched.
pub(super) enum Start<const N: usize> {
    /// It is in this cell, and so far inside of each facet: an exact search would find the same.
    In(CellId, [f64; N]),
    /// A cell that was found for the position before, if one was.
    Near(Option<CellId>),
}

impl<const N: usize> Start<N> {
    fn cell(self) -> Option<CellId> {
        match self {
            Start::In(cell, _) => Some(cell),
            Start::Near(cell) => cell,
        }
    }
}

/// Values at the vertices: `width` numbers for each.
pub(super) struct Field {
    values: Vec<f64>,
    width: usize,
}

impl Field {
    /// The number of columns.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn at(&self, vertex: VertexId) -> &[f64] {
        &self.values[vertex.index() * self.width..][..self.width]
    }

    /// Returns the weighted mean of values, exactly the value where only one weight is not zero.
    #[inline(always)]
    fn mean(&self, weights: &[(VertexId, f64)], mean: &mut [f64]) {
        let mut weights = weights.iter().filter(|(_, weight)| *weight != 0.0);
        let Some(&(first, _)) = weights.next() else {
            return;
        };
        for (column, mean) in mean.iter_mut().enumerate() {
            // Relative to one of them, so that constant values are reproduced.
            let origin = self.at(first)[column];
            *mean = weights.clone().fold(origin, |mean, &(vertex, weight)| {
                mean + weight * (self.at(vertex)[column] - origin)
            });
        }
    }
}

/// Where a position is.
pub(super) enum Site<const N: usize> {
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
            let rows = of_vertices
                .par_chunks_exact_mut(width)
                .with_min_len(CHUNK)
                .zip(&self.point_of);
            rows.filter(|(_, point)| **point != NONE)
                .for_each(|(row, &point)| {
                    row.iter_mut()
                        .zip(values.row(point as usize))
                        .for_each(|(to, from)| *to = *from);
                });
        }
        Field {
            values: of_vertices,
            width,
        }
    }

    /// Returns the simplex at each position, which is the one that contains it; [`NONE`] outside of
    /// the hull. Outside by at most a tolerance, in barycentric coordinates, counts as inside.
    pub(super) fn find(
        &self,
        queries: &[[f64; D]],
        tolerance: f64,
        cancel: &AtomicBool,
    ) -> Vec<i32> {
        self.each(queries, &[NONE], cancel, || {
            |q, start, found: &mut [i32]| {
                let near = match start {
                    Start::In(cell, _) => {
                        found[0] = self.simplex(cell);
                        return Some(cell);
                    }
                    Start::Near(near) => near,
                };
                let (cell, near) = match self.t.locate(q, near) {
                    Location::Cell { cell, .. } => (Some(cell), Some(cell)),
                    Location::Vertex(vertex) => {
                        let cell = self.inside_at(vertex);
                        (cell, cell)
                    }
                    Location::OutsideHull { cell } => {
                        let inside = self.inside_of(cell);
                        (self.within_tolerance(q, inside, tolerance), Some(inside))
                    }
                    Location::OutsideAffineHull | Location::Nowhere => (None, None),
                };
                found[0] = cell.map_or(NONE, |cell| self.simplex(cell));
                near
            }
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
        self.each(queries, outside, cancel, || {
            |q, start, mean: &mut [f64]| self.linear_at(q, start, (field, tolerance), mean)
        })
    }

    #[inline(always)]
    fn linear_at(
        &self,
        q: &[f64; D],
        start: Start<N>,
        (field, tolerance): (&Field, f64),
        mean: &mut [f64],
    ) -> Option<CellId> {
        let (site, near) = self.site(q, start, tolerance);
        match site {
            Site::Vertex(vertex) => mean.copy_from_slice(field.at(vertex)),
            Site::Cell(cell, weights) => {
                let corners = self.t.tds().corners(cell);
                let weights: [_; N] = std::array::from_fn(|i| (corners[i], weights[i]));
                field.mean(&weights, mean);
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
        self.each(queries, outside, cancel, || {
            |q, start, mean: &mut [f64]| {
                let near = start.cell();
                let location = self.t.locate(q, near);
                let near = location.cell(&self.t).or(near);
                let is_at_rim =
                    matches!(location, Location::Cell { cell, .. } if self.is_at_rim(cell, q));
                let Some(weights) = (if is_at_rim {
                    None
                } else {
                    G::sibson(&self.t, q, near)
                }) else {
                    // On the hull up to a rounding error, where the limit is linear; outside; or
                    // where squares overflow or underflow.
                    return self.linear_at(q, Start::Near(near), (field, tolerance), mean);
                };
                field.mean(&weights, mean);
                weights
                    .first()
                    .and_then(|&(vertex, _)| self.t.tds().cell_of(vertex))
            }
        })
    }

    /// Returns the point nearest to each position; of several, the first by their coordinates.
    /// [`NONE`] for a position that is not finite.
    pub(super) fn nearest(&self, queries: &[[f64; D]], cancel: &AtomicBool) -> Vec<i32>
    where
        Tds<N>: Neighbors<N, Error = Infallible>,
    {
        self.each(queries, &[NONE], cancel, || {
            |q, start, nearest: &mut [i32]| {
                let vertex = self.t.nearest(q, start.cell())?;
                nearest[0] = self.point_of[vertex.index()];
                self.t.tds().cell_of(vertex)
            }
        })
    }

    /// Calls `work` for each position with the start of its search and the numbers of its result,
    /// which are those of `blank`; it returns the cell that it found. Each task has a `work` of its
    /// own, which may remember what it has found.
    ///
    /// Results do not depend on the number of threads: tasks are the same for any number of them.
    pub(super) fn each<T: Copy + Send + Sync, W>(
        &self,
        queries: &[[f64; D]],
        blank: &[T],
        cancel: &AtomicBool,
        work: impl Fn() -> W + Sync,
    ) -> Vec<T>
    where
        W: FnMut(&[f64; D], Start<N>, &mut [T]) -> Option<CellId>,
    {
        let mut results = blank.repeat(queries.len());
        let width = blank.len();
        if width == 0 {
            return results;
        }
        let answer = |results: &mut [T], positions: &[[f64; D]]| {
            let guesses = self.guesses(positions);
            let (mut near, mut work) = (None, work());
            let rows = results.chunks_exact_mut(width);
            for ((q, guess), result) in positions.iter().zip(guesses).zip(rows) {
                let clear = guess.and_then(|cell| self.clearly_in(q, cell));
                let start = clear.unwrap_or(Start::Near(near));
                near = work(q, start, result).or(near);
            }
        };
        if queries.len() <= FEW {
            answer(&mut results, queries);
            return results;
        }
        let order = if self.are_far_apart(queries) {
            self.order_of(queries)
        } else {
            None
        };
        results
            .par_chunks_mut(CHUNK * width)
            .enumerate()
            .for_each(|(chunk, results)| {
                if cancel.load(Ordering::Relaxed) {
                    return;
                }
                let start = chunk * CHUNK;
                let ranks = start..start + results.len() / width;
                match &order {
                    Some(order) => {
                        let ordered = order[ranks].iter().map(|&index| queries[index as usize]);
                        answer(results, &ordered.collect::<Vec<_>>());
                    }
                    None => answer(results, &queries[ranks]),
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

    /// Returns where a position has its value, and a finite cell there or nearby.
    ///
    /// That is where it is, except in simplices that are at the hull by rounding: values there are
    /// those of a neighbor, so that they do not depend on which points of a straight side are
    /// rounded inward.
    #[inline(always)]
    pub(super) fn site(
        &self,
        q: &[f64; D],
        start: Start<N>,
        tolerance: f64,
    ) -> (Site<N>, Option<CellId>) {
        match start {
            Start::In(cell, sides) => (Site::Cell(cell, weights(sides)), Some(cell)),
            Start::Near(near) => self.located_site(q, near, tolerance),
        }
    }

    /// Like `site`, by an exact search from a cell.
    fn located_site(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
        tolerance: f64,
    ) -> (Site<N>, Option<CellId>) {
        let in_cell = |cell: CellId| Site::Cell(cell, weights(self.sides(cell, q)));
        match self.t.locate(q, near) {
            Location::Vertex(vertex) => (Site::Vertex(vertex), self.inside_at(vertex)),
            Location::Cell { cell, facets } => {
                let mut sides = self.sides(cell, q);
                let mut on = (0..N).filter(|&i| facets.contains(i));
                let is_not_shared =
                    on.all(|i| self.t.tds().is_infinite(self.t.tds().neighbor(cell, i)));
                if is_not_shared
                    && self.is_by_rounding(&self.widths(cell), volume(&sides))
                    && self.reaches_hull(cell, q, |cell, volume| {
                        self.is_by_rounding(&self.widths(cell), volume)
                    })
                    && let Some(beside) = self.within_tolerance(q, cell, BROAD)
                {
                    return (in_cell(beside), Some(cell));
                }
                (0..N)
                    .filter(|&i| facets.contains(i))
                    .for_each(|i| sides[i] = 0.0);
                (Site::Cell(cell, weights(sides)), Some(cell))
            }
            Location::OutsideHull { cell } => {
                let inside = self.inside_of(cell);
                (
                    self.within_tolerance(q, inside, tolerance)
                        .map_or(Site::Outside, in_cell),
                    Some(inside),
                )
            }
            Location::OutsideAffineHull | Location::Nowhere => (Site::Outside, None),
        }
    }

    /// Returns a finite cell as the start if a position is in it. By rounded numbers, but only
    /// where these leave no doubt: an exact search would find the same cell and numbers.
    #[inline(always)]
    fn clearly_in(&self, q: &[f64; D], cell: CellId) -> Option<Start<N>> {
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let sides = self.t.geometry().rough_sides(corners, q)?;
        let least = sides[1..].iter().fold(
            sides[0],
            |least, &side| {
                if side < least { side } else { least }
            },
        );
        let volume = volume(&sides);
        let bounds = box_around(corners);
        let widths = widths(&bounds);
        let is_clear = least > CLEAR * volume
            && !Self::is_thin(&widths, volume, THIN)
            && !self.is_by_rounding(&widths, volume)
            && is_within(&bounds, q);
        is_clear.then_some(Start::In(cell, sides))
    }

    /// Returns a finite cell at a vertex.
    fn inside_at(&self, vertex: VertexId) -> Option<CellId> {
        self.t
            .tds()
            .cell_of(vertex)
            .map(|cell| self.inside_of(cell))
    }

    /// Returns how far a position lies inside of each facet of a finite cell, as the volume, times
    /// `D!`, that both span. For a position in the cell, each is right to 12 digits of their sum,
    /// the volume of the cell.
    fn sides(&self, cell: CellId, q: &[f64; D]) -> [f64; N] {
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let rough = self.t.geometry().rough_sides(corners, q);
        rough
            .filter(|sides| !Self::is_thin(&self.widths(cell), volume(sides), THIN))
            .unwrap_or_else(|| G::sides(corners.map(|p| *p), *q))
    }

    /// Returns the smallest and the largest coordinates of the corners of a cell.
    fn box_around(&self, cell: CellId) -> [[f64; D]; 2] {
        box_around(self.t.tds().corners(cell).map(|v| self.t.point(v)))
    }

    /// Returns how wide a cell is along each axis.
    fn widths(&self, cell: CellId) -> [f64; D] {
        widths(&self.box_around(cell))
    }

    /// Returns true if the volume of a cell is at most a part of that of a cube around it.
    fn is_thin(widths: &[f64; D], volume: f64, part: f64) -> bool {
        volume <= part * cube_around(widths)
    }

    /// Returns true if a cell would not be there if its corners were not rounded, for all that is
    /// known; given its widths and its volume.
    fn is_by_rounding(&self, widths: &[f64; D], volume: f64) -> bool {
        volume <= self.volume_by_rounding(widths)
    }

    /// Returns the volume that a cell with these widths may have by rounding only.
    #[inline]
    fn volume_by_rounding(&self, widths: &[f64; D]) -> f64 {
        let moved = |axis: usize| {
            (0..D)
                .filter(|&other| other != axis)
                .fold(self.roundings[axis], |volume, other| volume * widths[other])
        };
        ROUNDINGS * (0..D).map(moved).sum::<f64>()
    }

    /// Returns true if a cell is infinite, or cells of a kind lead from it to an infinite one,
    /// given by its volume.
    fn reaches_hull(
        &self,
        start: CellId,
        q: &[f64; D],
        is_kind: impl Fn(CellId, f64) -> bool,
    ) -> bool {
        let tds = self.t.tds();
        let mut seen = vec![start];
        let mut next = 0;
        while next < seen.len().min(PATIENCE) {
            let cell = seen[next];
            next += 1;
            if tds.is_infinite(cell) {
                return true;
            }
            if is_kind(cell, volume(&self.sides(cell, q))) {
                let beside = (0..N).map(|i| tds.neighbor(cell, i));
                let new: Vec<CellId> = beside.filter(|beyond| !seen.contains(beyond)).collect();
                seen.extend(new);
            }
        }
        false
    }

    /// Returns true if a position in a cell is at the hull, or in or beside flat cells there, up to
    /// rounding errors. Flat cells elsewhere, as between cubes of a grid, are no rim.
    fn is_at_rim(&self, cell: CellId, q: &[f64; D]) -> bool {
        let sides = self.sides(cell, q);
        let sum = volume(&sides);
        let is_rim = |cell: CellId| {
            self.reaches_hull(cell, q, |cell, volume| {
                Self::is_thin(&self.widths(cell), volume, FLAT)
            })
        };
        is_rim(cell)
            || (0..N).any(|i| sides[i] <= BROAD * sum && is_rim(self.t.tds().neighbor(cell, i)))
    }

    /// Searches near a cell for one that contains a position up to a tolerance, and is not there by
    /// rounding; those that are there by rounding are passed to all sides, and are second choice.
    fn within_tolerance(&self, q: &[f64; D], start: CellId, tolerance: f64) -> Option<CellId> {
        if tolerance == 0.0 || self.is_far_outside(q, start, tolerance) {
            return None;
        }
        let tds = self.t.tds();
        let mut second = None;
        let (mut seen, mut open) = (vec![start], vec![(0.0_f64, start)]);
        while seen.len() < PATIENCE {
            // Next is the one whose box is nearest to the position.
            let nearest = (0..open.len()).min_by(|&i, &j| open[i].0.total_cmp(&open[j].0));
            let Some(nearest) = nearest else { break };
            let (_, cell) = open.swap_remove(nearest);
            let sides = self.sides(cell, q);
            let volume = volume(&sides);
            let is_by_rounding = self.is_by_rounding(&self.widths(cell), volume);
            let least = -tolerance * volume;
            if sides.iter().all(|&side| side >= least) {
                if !is_by_rounding {
                    return Some(cell);
                }
                second = second.or(Some(cell));
            }
            for i in (0..N).filter(|&i| is_by_rounding || sides[i] < least) {
                let beyond = tds.neighbor(cell, i);
                if !tds.is_infinite(beyond) && !seen.contains(&beyond) {
                    seen.push(beyond);
                    open.push((self.distance_from_box(beyond, q), beyond));
                }
            }
        }
        second
    }

    /// Returns how far a position is outside of the box around a cell, along the axis on which it
    /// is farthest.
    fn distance_from_box(&self, cell: CellId, q: &[f64; D]) -> f64 {
        let [low, high] = self.box_around(cell);
        let outside = |axis: usize| (low[axis] - q[axis]).max(q[axis] - high[axis]);
        (0..D).map(outside).fold(0.0, f64::max)
    }

    /// Returns true if a position is so far beyond a facet of a cell on the hull that it is in no
    /// cell up to a tolerance: cells are at most as high as the bounding box is wide, in all
    /// directions together.
    fn is_far_outside(&self, q: &[f64; D], cell: CellId, tolerance: f64) -> bool {
        let sides = self.sides(cell, q);
        let [low, high] = &self.bounds;
        let size: f64 = (0..D).map(|axis| high[axis] - low[axis]).sum();
        // At least the size of a facet, times `(D - 1)!`, and the distance of a corner from it.
        let facet = self.widths(cell).iter().sum::<f64>().powi(D as i32 - 1);
        let is_hull = |i: usize| self.t.tds().is_infinite(self.t.tds().neighbor(cell, i));
        (0..N).any(|i| is_hull(i) && -sides[i] > tolerance * size * facet)
    }
}

/// Returns the smallest and the largest coordinates of the corners of a cell.
#[inline]
fn box_around<const N: usize, const D: usize>(corners: [&[f64; D]; N]) -> [[f64; D]; 2] {
    let (mut low, mut high) = (*corners[0], *corners[0]);
    // `PERF:` one instruction each, unlike `min` and `max`: coordinates are numbers.
    for p in &corners[1..] {
        for axis in 0..D {
            low[axis] = if p[axis] < low[axis] {
                p[axis]
            } else {
                low[axis]
            };
            high[axis] = if p[axis] > high[axis] {
                p[axis]
            } else {
                high[axis]
            };
        }
    }
    [low, high]
}

/// Returns true if a position is in a box.
#[inline]
fn is_within<const D: usize>([low, high]: &[[f64; D]; 2], q: &[f64; D]) -> bool {
    (0..D).all(|axis| low[axis] <= q[axis] && q[axis] <= high[axis])
}

/// Returns how wide a box is along each axis.
fn widths<const D: usize>([low, high]: &[[f64; D]; 2]) -> [f64; D] {
    std::array::from_fn(|axis| high[axis] - low[axis])
}

/// Returns the volume of a cube around a box.
fn cube_around<const D: usize>(widths: &[f64; D]) -> f64 {
    widths.iter().copied().fold(0.0, f64::max).powi(D as i32)
}

/// Returns the volume of a cell, times `D!`: the sum of those that its facets span with a position.
fn volume<const N: usize>(sides: &[f64; N]) -> f64 {
    sides.iter().sum()
}

/// Returns barycentric coordinates in proportion to volumes.
fn weights<const N: usize>(sides: [f64; N]) -> [f64; N] {
    let sides = sides.map(|side| side.max(0.0));
    let sum: f64 = sides.iter().sum();
    sides.map(|side| side / sum)
}
