//! Point location by a hierarchy of samples.

use rustc_hash::FxHashMap;

use crate::engine::Inserted;
use crate::engine::removal::Removal;
use crate::geometry::Geometry;
use crate::kinds::Delaunay;
use crate::locate::Dice;
use crate::locate::{Locate, Location};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// The ratio of vertices to those in the next smaller sample.
const RATIO: usize = 30;

/// The Delaunay hierarchy (Devillers 2002): samples of samples of the vertices, each triangulated.
///
/// ```text
///   level 2     o                 o       one vertex in 900
///   level 1     o     o      o    o       one vertex in 30
///   all         o o o o o oo o o oo o
/// ```
///
/// A point is located from the top down; on each level the walk starts at the vertex that was found
/// nearest on the level above. So it takes expected `O(log n)` steps on any Delaunay triangulation
/// whose points came in random order, however they are spread (O(n) if a line from there goes
/// through all cells). Memory grows by a thirtieth.
///
/// The geometry of the samples is one for the same type of points, in which a point is the same
/// site. It is the geometry of the triangulation itself, except for weighted points: their samples
/// use one that ignores weights, [`Unweighted`](crate::geometry::Unweighted).
///
/// The samples are pseudo-random, and the same in every run.
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Delaunay, Hierarchy, Locate, Location};
///
/// let plane: Plane = Plane::default();
/// let (mut t, mut hierarchy) = (Delaunay::new(plane), Hierarchy::new(plane));
/// for i in 0..1000 {
///     t.insert_by(&mut hierarchy, [f64::from(i * 7919 % 1000), f64::from(i * 104_729 % 997)], ())?;
/// }
/// assert!(matches!(hierarchy.locate(&t, &[500.5, 500.5]), Location::Cell { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Hierarchy<L: Geometry<N>, const N: usize> {
    geometry: L,
    /// The largest sample first.
    levels: Vec<SampleLevel<L, N>>,
    dice: Dice,
}

#[derive(Debug, Clone)]
struct SampleLevel<L: Geometry<N>, const N: usize> {
    /// The payload of each vertex is the same vertex in the level below.
    sample: Delaunay<L, N, VertexId>,
    /// Maps a vertex of the level below to its vertex in this sample.
    of_below: FxHashMap<VertexId, VertexId>,
}

impl<L: Geometry<N>, const N: usize> SampleLevel<L, N> {
    /// Returns a cell at a point and a vertex near it, given a vertex to start from.
    fn nearest(&self, q: &L::Point, start: Option<VertexId>) -> (Option<CellId>, Option<VertexId>) {
        let tds = self.sample.tds();
        let cell = self
            .sample
            .approach(q, start.and_then(|vertex| tds.cell_of(vertex)));
        let nearest = match cell {
            Some(cell) => {
                let finite = tds
                    .cell_vertices(cell)
                    .iter()
                    .copied()
                    .filter(|&v| v != VertexId::INFINITE);
                let far = |v: VertexId| {
                    self.sample
                        .geometry()
                        .rough_distance(self.sample.point(v), q)
                };
                finite
                    .map(|v| (v, far(v)))
                    .reduce(|p, q| if q.1 < p.1 { q } else { p })
                    .map(|(v, _)| v)
            }
            None => tds.vertices().next(),
        };
        (cell, nearest)
    }

    fn below(&self, vertex: VertexId) -> VertexId {
        *self.sample.tds().vertex_data(vertex)
    }
}

impl<L: Geometry<N> + Clone, const N: usize> Hierarchy<L, N> {
    /// Returns a hierarchy for a triangulation that is still empty.
    pub fn new(geometry: L) -> Self {
        Hierarchy {
            geometry,
            levels: Vec::new(),
            dice: Dice::default(),
        }
    }

    /// Returns a hierarchy for the vertices of a triangulation. O(n).
    pub fn of<G, V, C>(geometry: L, triangulation: &Triangulation<G, N, V, C>) -> Self
    where
        G: Geometry<N, Point = L::Point>,
        C: Copy + Default,
    {
        let mut hierarchy = Self::new(geometry);
        for vertex in triangulation.tds.vertices() {
            hierarchy.sample(vertex, triangulation.point(vertex));
        }
        hierarchy
    }

    /// Draws the number of samples that a vertex belongs to, and inserts it into them.
    fn sample(&mut self, vertex: VertexId, point: &L::Point) {
        let mut height = 0;
        while height <= self.levels.len() && self.dice.below(RATIO) == 0 {
            height += 1;
        }
        if height == 0 {
            return;
        }
        if height > self.levels.len() {
            let sample = Delaunay::new(self.geometry.clone());
            self.levels.push(SampleLevel {
                sample,
                of_below: FxHashMap::default(),
            });
        }
        let mut near = Vec::with_capacity(self.levels.len());
        self.descend(point, |cell| near.push(cell));
        let mut below = vertex;
        for (level, near) in self.levels[..height].iter_mut().zip(near.into_iter().rev()) {
            let Ok(Inserted { vertex, .. }) = level.sample.insert_near(*point, below, near) else {
                return;
            };
            // If the site is taken, then by a vertex whose removal was not reported.
            *level.sample.inner.tds.vertex_data_mut(vertex) = below;
            level.of_below.insert(below, vertex);
            below = vertex;
        }
    }
}

impl<L: Geometry<N>, const N: usize> Hierarchy<L, N> {
    /// Returns the number of vertices in each sample, the largest first.
    pub fn sample_sizes(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.levels.iter().map(|level| level.sample.vertex_count())
    }

    /// Returns a vertex of the triangulation near a point. Calls `show` with a cell near the point
    /// on each level, from the top down.
    fn descend(&self, q: &L::Point, mut show: impl FnMut(Option<CellId>)) -> Option<VertexId> {
        self.levels.iter().rev().fold(None, |start, level| {
            let (cell, nearest) = level.nearest(q, start);
            show(cell);
            nearest.map(|vertex| level.below(vertex))
        })
    }
}

impl<G, L, const N: usize> Locate<G, N> for Hierarchy<L, N>
where
    G: Geometry<N>,
    L: Geometry<N, Point = G::Point> + Clone,
    Triangulation<L, N, VertexId>: Removal,
{
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, N, V, C>,
        q: &G::Point,
    ) -> Location {
        let nearest = self
            .descend(q, |_| ())
            .filter(|&vertex| triangulation.tds.is_vertex(vertex));
        triangulation.locate(
            q,
            nearest.and_then(|vertex| triangulation.tds.cell_of(vertex)),
        )
    }

    fn inserted(&mut self, _: &G, vertex: VertexId, point: &G::Point) {
        self.sample(vertex, point);
    }

    fn removed(&mut self, vertex: VertexId) {
        let mut below = vertex;
        for level in &mut self.levels {
            let Some(vertex) = level.of_below.remove(&below) else {
                return;
            };
            let _ = level.sample.remove(vertex); // it was there
            below = vertex;
        }
    }
}
