//! Alpha shapes in space (Edelsbrunner and Muecke 1994), in their regularized form: of a volume.

mod classify;

pub use classify::AlphaState;

use rustc_hash::FxHashMap;

use crate::geometry::{Geometry, Space, WeightedSpace};
use crate::kernel::{
    Congruence, Kernel, Orientation3, Predicate, RoundedRadius, SquaredRadii, SquaredRadius,
};
use crate::kinds::{Delaunay, Regular};
use crate::tds::space::OUTWARD;
use crate::tds::{CellId, Tds, VertexId};
use crate::triangulation::Triangulation;

/// All alpha shapes of the points of a triangulation in space.
///
/// For a number *alpha*, the solid consists of the cells whose sphere has a squared radius of at
/// most alpha: the circumscribed sphere, or with weights the one that is orthogonal to those of the
/// vertices. From nothing it grows to the convex hull. What is thinner than a cell, single facets,
/// edges and points, is no part of it.
///
/// ```
/// use breakline_triangulation::Delaunay;
/// use breakline_triangulation::geometry::Space;
///
/// let grid: Vec<[f64; 3]> =
///     (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
/// let (t, _) = Delaunay::from_points(Space::new(), &grid)?;
/// let shapes = t.alpha_shapes();
/// assert_eq!(shapes.alphas(), [0.75], "all cells are parts of unit cubes");
///
/// let shape = shapes.with_components(1).expect("there are cells");
/// assert_eq!((shape.alpha(), shape.volume()), (0.75, 27.0));
/// let boundary = shape.boundary();
/// assert_eq!(boundary.triangles.len(), 6 * 9 * 2);
/// assert!(boundary.is_manifold());
/// assert_eq!(shapes.at(0.5).volume(), 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct AlphaShapes<'t, V = (), C = ()> {
    tds: &'t Tds<4, V, C>,
    /// The sites of the vertices, by index.
    sites: Vec<[f64; 3]>,
    /// The squared radii of finite cells, ascending, each once; rounded.
    alphas: Vec<f64>,
    /// For each cell, by index, the position of its squared radius in `alphas`.
    levels: Vec<u32>,
    /// The finite cells by ascending squared radius.
    cells: Vec<CellId>,
}

/// The level of cells that are in no shape.
const NEVER: u32 = u32::MAX;

/// A solid of cells: one of the [`AlphaShapes`].
#[derive(Debug, Clone, Copy)]
pub struct AlphaShape<'s, V = (), C = ()> {
    shapes: &'s AlphaShapes<'s, V, C>,
    /// The number of squared radii that are at most alpha.
    level: u32,
    alpha: f64,
}

/// The surface of a solid of cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Boundary {
    /// The facets, counter-clockwise as seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
    /// The edges, each with its ends in order, that more than two triangles share.
    pub singular_edges: Vec<[VertexId; 2]>,
    /// The vertices at which parts of the surface touch without sharing an edge.
    pub singular_vertices: Vec<VertexId>,
}

impl Boundary {
    /// Returns true if the surface is a closed manifold: each edge has two triangles, and those
    /// around each vertex are one ring.
    pub fn is_manifold(&self) -> bool {
        self.singular_edges.is_empty() && self.singular_vertices.is_empty()
    }
}

impl<K: Kernel, V, C: Copy + Default> Delaunay<Space<K>, 4, V, C> {
    /// Returns the alpha shapes of the points. Below dimension 3 all of them are empty.
    ///
    /// # Complexity
    /// O(m log m) for m cells, once for all alphas. Radii that floating point cannot distinguish
    /// are compared by exact arithmetic, so that the shapes are those of the points.
    pub fn alpha_shapes(&self) -> AlphaShapes<'_, V, C> {
        AlphaShapes::of(self, |&[x, y, z]| [x, y, z, 0.0])
    }
}

impl<K: Kernel, V, C: Copy + Default> Regular<WeightedSpace<K>, 4, V, C> {
    /// Returns the weighted alpha shapes of the points (Edelsbrunner 1995). Below dimension 3 all
    /// of them are empty. Hidden points have no part in them.
    ///
    /// # Complexity
    /// That of [`Delaunay::alpha_shapes`](crate::Delaunay::alpha_shapes).
    pub fn alpha_shapes(&self) -> AlphaShapes<'_, V, C> {
        AlphaShapes::of(self, |&point| point)
    }
}

/// A finite cell while cells are sorted.
#[derive(Clone, Copy)]
struct Candidate {
    cell: CellId,
    radius: RoundedRadius,
}

/// Returns how many of the first candidates, which come by the lower bounds of their radii, may
/// have the same radius, or are linked by others that may.
fn count_of_alike(candidates: &[Candidate]) -> usize {
    let mut high = f64::NEG_INFINITY;
    let is_alike = |(position, candidate): &(usize, &Candidate)| {
        let is_alike = *position == 0 || candidate.radius.low <= high;
        high = high.max(candidate.radius.high);
        is_alike
    };
    candidates.iter().enumerate().take_while(is_alike).count()
}

/// Sorts candidates by their radii, compared without rounding, and then by their cells. Each comes
/// with a number that ascends with its radius.
///
/// Only one of those that are congruent is compared: in a lattice there are few.
fn ranked(
    candidates: &[Candidate],
    radii: &SquaredRadii,
    corners: impl Fn(CellId) -> [[f64; 4]; 4],
) -> Vec<(usize, Candidate)> {
    let mut classes: Vec<(SquaredRadius, CellId)> = Vec::new();
    let mut class_of: FxHashMap<Congruence, usize> = FxHashMap::default();
    let mut sorted: Vec<(usize, Candidate)> = Vec::with_capacity(candidates.len());
    for &candidate in candidates {
        let corners = corners(candidate.cell);
        let next = classes.len();
        let class = radii.congruence(corners).map_or(next, |congruence| {
            *class_of.entry(congruence).or_insert(next)
        });
        if class == next {
            classes.push((radii.to_compare(corners), candidate.cell));
        }
        sorted.push((class, candidate));
    }
    let compare = |&p: &usize, &q: &usize| {
        let ((p, a), (q, b)) = (&classes[p], &classes[q]);
        p.compare(q, || corners(*a), || corners(*b))
    };
    let mut order: Vec<usize> = (0..classes.len()).collect();
    order.sort_unstable_by(|p, q| compare(p, q).then(p.cmp(q)));
    let mut rank_of = vec![0; classes.len()];
    for (rank, equal) in order.chunk_by(|p, q| compare(p, q).is_eq()).enumerate() {
        equal.iter().for_each(|&class| rank_of[class] = rank);
    }
    for (class, _) in &mut sorted {
        *class = rank_of[*class];
    }
    sorted.sort_unstable_by_key(|(rank, candidate)| (*rank, candidate.cell));
    sorted
}

impl<'t, V, C: Copy + Default> AlphaShapes<'t, V, C> {
    fn of<G>(t: &'t Triangulation<G, 4, V, C>, weighted: impl Fn(&G::Point) -> [f64; 4]) -> Self
    where
        G: Geometry<4>,
    {
        let tds = t.tds();
        let mut sites = vec![[f64::NAN; 3]; tds.vertex_slots()];
        for vertex in tds.vertices() {
            let [site @ .., _] = weighted(t.point(vertex));
            sites[vertex.index()] = site;
        }
        let mut shapes = AlphaShapes {
            tds,
            sites,
            alphas: Vec::new(),
            levels: vec![NEVER; tds.cell_slots()],
            cells: Vec::new(),
        };
        if tds.dimension() < 3 {
            return shapes;
        }
        let corners = |cell: CellId| tds.corners(cell).map(|vertex| weighted(t.point(vertex)));
        let radii = SquaredRadii::among(tds.vertices().map(|vertex| weighted(t.point(vertex))));
        let candidate = |cell: CellId| Candidate {
            cell,
            radius: radii.rounded(corners(cell)),
        };
        let mut candidates: Vec<Candidate> = tds
            .cells()
            .filter(|&cell| !tds.is_infinite(cell))
            .map(candidate)
            .collect();
        candidates.sort_unstable_by(|a, b| {
            a.radius
                .low
                .total_cmp(&b.radius.low)
                .then(a.cell.cmp(&b.cell))
        });
        shapes.cells.reserve_exact(candidates.len());
        let mut rest = &candidates[..];
        while let (alike @ [first, ..], others) = rest.split_at(count_of_alike(rest)) {
            rest = others;
            if alike.len() == 1 {
                shapes.push_level(first.radius.value, [first.cell]);
                continue;
            }
            for equal in ranked(alike, &radii, corners).chunk_by(|p, q| p.0 == q.0) {
                shapes.push_level(
                    equal[0].1.radius.value,
                    equal.iter().map(|(_, candidate)| candidate.cell),
                );
            }
        }
        shapes
    }

    /// Adds the cells of the next larger squared radius.
    fn push_level(&mut self, value: f64, cells: impl IntoIterator<Item = CellId>) {
        let level = self.alphas.len() as u32;
        for cell in cells {
            self.levels[cell.index()] = level;
            self.cells.push(cell);
        }
        // Rounded numbers may come out of order.
        self.alphas
            .push(self.alphas.last().map_or(value, |last| last.max(value)));
    }

    /// Returns the numbers at which the solid grows, ascending; rounded, so that some that differ
    /// may look alike.
    pub fn alphas(&self) -> &[f64] {
        &self.alphas
    }

    /// Returns the shape of a number, in the unit of squared coordinates.
    ///
    /// The number is compared with the rounded ones of [`alphas`](Self::alphas). O(log m).
    pub fn at(&self, alpha: f64) -> AlphaShape<'_, V, C> {
        AlphaShape {
            shapes: self,
            level: self.alphas.partition_point(|&at| at <= alpha) as u32,
            alpha,
        }
    }

    /// Returns the smallest shape that contains all vertices, as corners at least, and has no more
    /// than so many [components](AlphaShape::components). `None` if there are no cells, or if
    /// `components` is zero.
    ///
    /// It is the optimal one of CGAL's `find_optimal_alpha`, which bisects: where a cell that
    /// appears on its own makes the number of components grow again, CGAL's may be larger. O(m) for
    /// m cells.
    pub fn with_components(&self, components: usize) -> Option<AlphaShape<'_, V, C>> {
        let solid = self.smallest_with_all_vertices()?;
        let mut forest = Forest::new(self.levels.len());
        let mut count = 0;
        for same in self.cells.chunk_by(|&a, &b| self.level(a) == self.level(b)) {
            for &cell in same {
                count = count + 1 - self.join(&mut forest, cell);
            }
            let level = self.level(same[0]);
            if level >= solid && count <= components {
                return Some(AlphaShape {
                    shapes: self,
                    level: level + 1,
                    alpha: self.alphas[level as usize],
                });
            }
        }
        None
    }

    fn level(&self, cell: CellId) -> u32 {
        self.levels[cell.index()]
    }

    /// Joins a cell with its neighbors of its level and below. Returns the number of trees that
    /// this has joined to another.
    fn join(&self, forest: &mut Forest, cell: CellId) -> usize {
        let neighbors = self.tds.cell_neighbors(cell);
        let joined = neighbors.iter().filter(|&&neighbor| {
            // Of two cells of one level the later in the order joins them.
            let (ours, theirs) = ((self.level(cell), cell), (self.level(neighbor), neighbor));
            theirs < ours && forest.join(cell.index(), neighbor.index())
        });
        joined.count()
    }

    /// Returns the first level at which each vertex has a cell.
    fn smallest_with_all_vertices(&self) -> Option<u32> {
        let mut first = vec![NEVER; self.sites.len()];
        for &cell in &self.cells {
            for vertex in self.tds.corners(cell) {
                let first = &mut first[vertex.index()];
                *first = self.level(cell).min(*first);
            }
        }
        first.into_iter().filter(|&level| level != NEVER).max()
    }
}

impl<'s, V, C: Copy + Default> AlphaShape<'s, V, C> {
    /// Returns the number that it is the shape of.
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Returns true if a cell is part of the solid; infinite cells and numbers without a cell never
    /// are.
    pub fn contains(&self, cell: CellId) -> bool {
        self.shapes
            .levels
            .get(cell.index())
            .is_some_and(|&level| level < self.level)
    }

    /// Iterates over the cells of the solid, by ascending squared radius.
    pub fn cells(&self) -> impl Iterator<Item = CellId> + 's {
        let (shapes, level) = (self.shapes, self.level);
        let count = shapes
            .cells
            .partition_point(|&cell| shapes.level(cell) < level);
        shapes.cells[..count].iter().copied()
    }

    /// Returns the number of parts that are connected through facets. O(m) for m cells.
    pub fn components(&self) -> usize {
        let mut forest = Forest::new(self.shapes.levels.len());
        self.cells().fold(0, |count, cell| {
            count + 1 - self.shapes.join(&mut forest, cell)
        })
    }

    /// Returns the volume of the solid: the sum of those of its cells, each with an error of a few
    /// roundings of its largest product. O(m) for m cells.
    pub fn volume(&self) -> f64 {
        let six_times = |cell: CellId| {
            let corners = self
                .shapes
                .tds
                .corners(cell)
                .map(|vertex| self.shapes.sites[vertex.index()]);
            Orientation3(corners).value(|x, y| x - y).abs()
        };
        // The sum of nothing would be negative zero.
        self.cells()
            .map(six_times)
            .fold(0.0, |sum, volume| sum + volume)
            / 6.0
    }

    /// Returns the surface, with the edges and vertices where it is not a manifold. O(m) for m
    /// cells.
    pub fn boundary(&self) -> Boundary {
        let tds = self.shapes.tds;
        let mut triangles = Vec::new();
        for cell in self.cells() {
            let corners = tds.corners(cell);
            for (i, &neighbor) in tds.cell_neighbors(cell).iter().enumerate() {
                if !self.contains(neighbor) {
                    triangles.push(OUTWARD[i].map(|k| corners[k]));
                }
            }
        }
        let (singular_edges, singular_vertices) = singular(&triangles);
        Boundary {
            triangles,
            singular_edges,
            singular_vertices,
        }
    }
}

/// Returns the edges of more than two triangles, and the vertices around which triangles are not
/// connected by edges.
fn singular(triangles: &[[VertexId; 3]]) -> (Vec<[VertexId; 2]>, Vec<VertexId>) {
    // Each corner of a triangle is a node; those at one vertex are joined across edges.
    let mut forest = Forest::new(3 * triangles.len());
    let mut of_edges: FxHashMap<[VertexId; 2], (usize, [usize; 2])> = FxHashMap::default();
    for (number, triangle) in triangles.iter().enumerate() {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (i, j) = if triangle[i] < triangle[j] {
                (i, j)
            } else {
                (j, i)
            };
            let nodes = [3 * number + i, 3 * number + j];
            let (count, first) = of_edges
                .entry([triangle[i], triangle[j]])
                .or_insert((0, nodes));
            *count += 1;
            forest.join(nodes[0], first[0]);
            forest.join(nodes[1], first[1]);
        }
    }
    let mut edges: Vec<_> = of_edges
        .iter()
        .filter(|(_, (count, _))| *count > 2)
        .map(|(&edge, _)| edge)
        .collect();
    edges.sort_unstable();
    let mut of_vertices: FxHashMap<VertexId, usize> = FxHashMap::default();
    let mut vertices = Vec::new();
    for (node, &vertex) in triangles.as_flattened().iter().enumerate() {
        let root = forest.root(node);
        if *of_vertices.entry(vertex).or_insert(root) != root {
            vertices.push(vertex);
        }
    }
    vertices.sort_unstable();
    vertices.dedup();
    (edges, vertices)
}

/// Disjoint sets of numbers (Tarjan 1975).
struct Forest(Vec<u32>);

impl Forest {
    fn new(count: usize) -> Self {
        Forest((0..count as u32).collect())
    }

    fn root(&mut self, number: usize) -> usize {
        let mut at = number as u32;
        while self.0[at as usize] != at {
            let above = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = above;
            at = above;
        }
        at as usize
    }

    /// Joins the sets of two numbers. Returns false if they were one.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        // The lower number becomes the root: fewer steps for numbers that are joined in order.
        self.0[a.max(b)] = a.min(b) as u32;
        a != b
    }
}
