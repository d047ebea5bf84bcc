//! The cells while points are inserted: walk, conflict zone, star.

use crate::num::Sign;
use crate::num::lanes::{self, prefetch};

use super::blocks::Block;
use super::cell::{Cell, Corner, DUMMY, FACETS};
use super::predicates::{Precision, Predicates};
use super::source::Source;
use super::sphere::{self, Arrow, Frame, MARKED, Origin, Query, Sphere, UNKNOWN};
use super::weights::Weights;

/// What all meshes of the same points have in common.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    pub(super) frame: Frame,
    precision: Precision,
    /// The least and the greatest weight.
    weights: [f64; 2],
}

impl Extent {
    pub(super) fn of(source: Source) -> Self {
        let (mut min, mut max) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        for site in (0..source.count as u32).map(source.site) {
            for axis in 0..4 {
                min[axis] = min[axis].min(site[axis]);
                max[axis] = max[axis].max(site[axis]);
            }
        }
        let [x, y, z] = [0, 1, 2].map(|axis| max[axis] - min[axis]);
        let frame = Frame {
            middle: [0, 1, 2].map(|axis| 0.5 * min[axis] + 0.5 * max[axis]),
            scale: 2.0 / x.max(y).max(z),
        };
        let positions = (0..source.count as u32).map(|rank| source.position(rank));
        Extent {
            frame,
            precision: Precision::of([x, y, z], positions.flatten()),
            weights: [min[3], max[3]],
        }
    }
}

/// The largest number of cells: their faces are numbered in 32 bits.
const MAX_CELLS: usize = 1 << 30;

/// Why an insertion failed.
#[derive(Debug)]
pub(super) enum Failure {
    /// The predicates contradict each other.
    Inexact,
    /// There would be more than [`MAX_CELLS`].
    TooManyCells,
}

/// The number of vertices up to which a table of all pairs of them links a star.
const FEW: usize = 64;

/// The last index in that table; as a mask it saves the check of the bounds.
const LAST: usize = FEW * FEW - 1;

pub(super) struct Mesh<'a> {
    predicates: Predicates<'a>,
    /// The finite vertices, then the infinite one, whose site is not a number.
    corners: Vec<Corner>,
    weights: Weights,
    cells: Vec<Cell>,
    spheres: Vec<Sphere>,
    /// Cells that are not in use.
    unused: Vec<u32>,
    frame: Frame,
    /// A cell of the last star.
    last: u32,
    /// The state of the generator that chooses the direction of walks.
    random: u32,
    /// Tags of the next star start here.
    base: u32,
    buffers: InsertionBuffers,
}

/// What one insertion uses; kept for the next one.
struct InsertionBuffers {
    /// The cells of the conflict zone, then those of the star.
    cells: Vec<u32>,
    /// The boundary of the zone: three vertices as seen from within, and the neighbor beyond.
    facets: Vec<[u32; 4]>,
    /// The vertices of each facet by their numbers in the star.
    numbers: Vec<[u32; 3]>,
    /// The vertices of the star.
    vertices: Vec<u32>,
    /// Seen from the new point.
    arrows: Vec<Arrow>,
    /// The face of the star with a directed edge in it, for each pair of numbers.
    faces: Box<[u32; FEW * FEW]>,
    /// An open hash table for stars with many vertices: edges, and a face of each.
    edges: Vec<u64>,
    faces_of_edges: Vec<u32>,
}

impl InsertionBuffers {
    fn new() -> Self {
        InsertionBuffers {
            cells: vec![DUMMY; 64],
            facets: vec![[0; 4]; 64],
            numbers: Vec::new(),
            vertices: Vec::new(),
            arrows: Vec::new(),
            faces: Box::new([0; FEW * FEW]),
            edges: Vec::new(),
            faces_of_edges: Vec::new(),
        }
    }

    /// Makes room for a greater zone.
    #[cold]
    fn make_room(&mut self) {
        self.cells.resize(2 * self.cells.len(), DUMMY);
        self.facets.resize(2 * self.facets.len(), [0; 4]);
    }
}

/// Returns four slots of a list from an index on; `None` if there are fewer.
#[inline(always)]
fn four<T>(list: &mut [T], from: usize) -> Option<&mut [T; 4]> {
    list.get_mut(from..)?.first_chunk_mut()
}

impl<'a> Mesh<'a> {
    /// Returns the mesh of a positive cell and the infinite cells around it. Vertex `i` is the
    /// point of rank `ranks[i]`. Ranks ascend, so that vertices close in space are close in memory.
    pub(super) fn new(
        source: Source<'a>,
        extent: Extent,
        ranks: &'a [u32],
        first: [u32; 4],
    ) -> Self {
        let count = ranks.len();
        let mut corners: Vec<Corner> = Vec::with_capacity(count + 1);
        corners.extend(ranks.iter().map(|&rank| Corner {
            site: source.position(rank),
            tag: 0,
        }));
        corners.push(Corner {
            site: [f64::NAN; 3],
            tag: 0,
        });
        let weights = Weights::new(
            extent.weights,
            ranks.iter().map(|&rank| (source.site)(rank)[3]),
        );

        let room = 7 * count + count / 4 + 64;
        let (mut cells, mut spheres) = (Vec::with_capacity(room), Vec::with_capacity(room));
        let infinite = count as u32;
        let alone = |vertices| Cell {
            neighbors: [0; 4],
            vertices,
        };
        cells.extend([Cell::UNUSED, alone(first)]);
        cells.extend(FACETS.map(|[i, j, k]| alone([first[j], first[i], first[k], infinite])));
        spheres.resize(cells.len(), UNKNOWN);
        let mut mesh = Mesh {
            predicates: Predicates {
                source,
                ranks,
                precision: extent.precision,
                may_hide: weights.may_hide(),
            },
            corners,
            weights,
            cells,
            spheres,
            unused: Vec::new(),
            frame: extent.frame,
            last: 1,
            random: 1,
            base: 1,
            buffers: InsertionBuffers::new(),
        };
        mesh.link_first();
        mesh
    }

    /// Links the first five cells: any two of them share a facet.
    fn link_first(&mut self) {
        for (a, b) in (1..6)
            .flat_map(|a| (1..6).map(move |b| (a, b)))
            .filter(|(a, b)| a != b)
        {
            let (of_a, of_b) = (self.cells[a].vertices, self.cells[b].vertices);
            let lacks = |vertices: [u32; 4], others: [u32; 4]| {
                vertices.iter().position(|v| !others.contains(v))
            };
            if let (Some(i), Some(j)) = (lacks(of_a, of_b), lacks(of_b, of_a)) {
                self.cells[a].neighbors[i] = 4 * b as u32 + j as u32;
            }
        }
    }

    /// Returns the cells, and those of them that are not in use.
    pub(super) fn into_cells(self) -> (Vec<Cell>, Vec<u32>) {
        (self.cells, self.unused)
    }

    /// Returns the cells that a point outside of the block may be in conflict with, if all vertices
    /// are points of the block.
    ///
    /// Such a point is outside of the convex hull, so that its conflict zone is connected and
    /// contains an infinite cell. Hence a flood from these through cells whose spheres are not sure
    /// to lie within the block reaches all; what it does not reach need not be tested.
    pub(super) fn open_cells(&self, block: &Block) -> Vec<u32> {
        let infinite = self.corners.len() as u32 - 1;
        let is_infinite = |cell: &Cell| cell.vertices.contains(&infinite);
        let mut is_open = vec![false; self.cells.len()];
        // One infinite cell: from there the flood finds the others.
        let mut open: Vec<u32> = self
            .cells
            .iter()
            .position(is_infinite)
            .map(|cell| cell as u32)
            .into_iter()
            .collect();
        open.iter().for_each(|&cell| is_open[cell as usize] = true);
        let mut done = 0;
        while let Some(&cell) = open.get(done) {
            done += 1;
            for neighbor in self.cells[cell as usize]
                .neighbors
                .map(|neighbor| neighbor >> 2)
            {
                if !is_open[neighbor as usize] && !block.contains(self.spheres[neighbor as usize]) {
                    is_open[neighbor as usize] = true;
                    open.push(neighbor);
                }
            }
        }
        open
    }

    /// Returns the finite cells, each with its sphere.
    pub(super) fn spheres(&self) -> impl Iterator<Item = ([u32; 4], Sphere)> {
        let infinite = self.corners.len() as u32 - 1;
        let cells = self
            .cells
            .iter()
            .zip(&self.spheres)
            .map(|(cell, &sphere)| (cell.vertices, sphere));
        cells.filter(move |(vertices, _)| vertices.iter().all(|&vertex| vertex < infinite))
    }

    /// Inserts a vertex, which must not be on the site of another one. If it is hidden, nothing
    /// changes; vertices that it hides lose their cells.
    ///
    /// # Errors
    /// If the predicates contradict each other, or there are too many cells. The mesh must not be
    /// used any more.
    #[inline(always)]
    pub(super) fn insert(&mut self, vertex: u32) -> Result<(), Failure> {
        let site = self.corners[vertex as usize].site;
        let origin = self.frame.of(site);
        let lack = self.weights.lack(vertex) * self.frame.scale * self.frame.scale;
        let q = sphere::query(origin, lack);
        let Some(first) = self.locate(vertex, q)? else {
            return Ok(());
        };
        let (zone, facets) = self.grow(first, vertex, q);
        self.assign_cells(zone, facets)?;
        let is_small = facets <= 2 * FEW - 4;
        let numbered = self.number(vertex, facets, is_small);
        // The zone is a ball, and its boundary a sphere (Euler).
        if numbered != facets / 2 + 2 {
            return Err(Failure::Inexact);
        }
        self.aim(vertex, numbered);
        self.wrap(facets, origin, lack);
        let is_linked = if is_small {
            self.link(facets)
        } else {
            self.link_many(facets)
        };
        if !is_linked {
            return Err(Failure::Inexact);
        }
        self.last = self.buffers.cells[0];
        Ok(())
    }

    /// Returns a cell in conflict with a vertex, by a walk from the last star (Devillers, Pion and
    /// Teillaud 2002). It ends as soon as a sphere is known to contain the vertex. `None` if the
    /// vertex is hidden.
    #[inline(always)]
    fn locate(&mut self, vertex: u32, q: Query) -> Result<Option<u32>, Failure> {
        let Mesh {
            predicates,
            corners,
            cells,
            spheres,
            last,
            random,
            ..
        } = self;
        let (cells, spheres) = (&cells[..], &spheres[..cells.len()]);
        let infinite = corners.len() as u32 - 1;
        let mut cell = *last;
        if let Some(i) = cells[cell as usize]
            .vertices
            .iter()
            .position(|&v| v == infinite)
        {
            cell = cells[cell as usize].neighbors[i] >> 2;
        }
        let mut from = DUMMY;
        // A random walk ends with probability 1. One as long as this does not expect to: the
        // predicates contradict each other.
        'walk: for _ in 0..8 * cells.len() + 64 {
            if sphere::is_inside(spheres[cell as usize], q) {
                return Ok(Some(cell));
            }
            let Cell {
                neighbors,
                vertices,
            } = cells[cell as usize];
            if vertices.contains(&infinite) {
                return Ok(Some(cell));
            }
            *random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let start = (*random >> 30) as usize;
            for i in (start..start + 4).map(|i| i & 3) {
                let next = neighbors[i] >> 2;
                if next != from
                    && predicates.orientation(corners, FACETS[i].map(|k| vertices[k]), vertex)
                        == Sign::Negative
                {
                    (from, cell) = (cell, next);
                    continue 'walk;
                }
            }
            let is_hidden =
                predicates.may_hide && !predicates.conflict(corners, cells[cell as usize], vertex);
            return Ok((!is_hidden).then_some(cell));
        }
        Err(Failure::Inexact)
    }

    /// Finds the conflict zone of a vertex from one of its cells. Returns the number of its cells
    /// and that of the facets of its boundary, both in `buffers`.
    ///
    /// `PERF:` the four neighbors of a cell are tested at once, and those chosen appended without
    /// branches: all four are written, each at the end of those chosen before it. Each of the four
    /// is soon read or linked: asking for their memory early saves 3 % in a cube, 9 % on a surface
    /// and 20 % on the moment curve. The sphere of each of the four is written back, marked or not.
    /// To write the marks of the others to a dummy cell took 3 to 4 % more time, since its address
    /// is known late and reads that follow wait for it; a table of the ends took another 4 % then.
    #[inline(always)]
    fn grow(&mut self, first: u32, vertex: u32, q: Query) -> (usize, usize) {
        let Mesh {
            predicates,
            corners,
            cells,
            spheres,
            buffers,
            ..
        } = self;
        let (corners, cells) = (&corners[..], &cells[..]);
        let spheres = &mut spheres[..cells.len()];
        let (mut zone, mut facets, mut done) = (1, 0, 0);
        spheres[first as usize] = MARKED;
        buffers.cells[0] = first;
        loop {
            let (list, boundary) = (&mut buffers.cells[..], &mut buffers.facets[..]);
            while done < zone {
                let cell = list[done];
                let (Some(slots), Some(rows)) = (four(list, zone), four(boundary, facets)) else {
                    break;
                };
                done += 1;
                let Cell {
                    neighbors: n,
                    vertices: v,
                } = cells[cell as usize];
                let beyond = n.map(|neighbor| neighbor >> 2);
                beyond
                    .iter()
                    .for_each(|&cell| prefetch(&cells[cell as usize]));
                let [a, b, c, d] = beyond;
                let around = [
                    spheres[a as usize],
                    spheres[b as usize],
                    spheres[c as usize],
                    spheres[d as usize],
                ];
                let sides = sphere::sides(around, q);
                let new = !sides.marked & 15;
                let mut taken = sides.inside & sides.sure & new;
                let mut open = !sides.sure & new;
                while open != 0 {
                    let lane = open.trailing_zeros() as usize & 3;
                    open &= open - 1;
                    let cell = cells[beyond[lane] as usize];
                    taken |= u32::from(predicates.conflict(corners, cell, vertex)) << lane;
                }

                let boundary = !taken & new;
                let bit = |mask: u32, lane: usize| (mask >> lane & 1) as usize;
                for lane in 0..4 {
                    spheres[beyond[lane] as usize] = sphere::marked_if(around[lane], taken >> lane);
                }
                let ends = |mask| {
                    let (a, b, c) = (bit(mask, 0), bit(mask, 1), bit(mask, 2));
                    [a, a + b, a + b + c, a + b + c + bit(mask, 3)]
                };
                let end = ends(taken);
                slots[0] = beyond[0];
                slots[end[0]] = beyond[1];
                slots[end[1]] = beyond[2];
                slots[end[2] & 3] = beyond[3];
                zone += end[3];
                let end = ends(boundary);
                let faces = lanes::facets(v, n);
                rows[0] = faces[0];
                rows[end[0]] = faces[1];
                rows[end[1]] = faces[2];
                rows[end[2] & 3] = faces[3];
                facets += end[3];
            }
            if done == zone {
                return (zone, facets);
            }
            buffers.make_room();
        }
    }

    /// Assigns a cell to each facet: those of the zone, then unused ones, then new ones.
    ///
    /// # Errors
    /// If there would be too many cells.
    #[inline(always)]
    fn assign_cells(&mut self, mut zone: usize, facets: usize) -> Result<(), Failure> {
        let Mesh {
            cells,
            spheres,
            unused,
            buffers,
            ..
        } = self;
        if buffers.cells.len() < facets + 4 {
            buffers.cells.resize(2 * facets + 4, 0);
        }
        if cells.len() + facets > MAX_CELLS {
            return Err(Failure::TooManyCells);
        }
        while zone < facets {
            buffers.cells[zone] = unused.pop().unwrap_or_else(|| {
                cells.push(Cell::UNUSED);
                spheres.push(UNKNOWN);
                cells.len() as u32 - 1
            });
            zone += 1;
        }
        for &cell in &buffers.cells[facets..zone] {
            cells[cell as usize] = Cell::UNUSED;
            unused.push(cell);
        }
        Ok(())
    }

    /// Numbers the vertices of the boundary and writes the cells of the star, except their links to
    /// each other. With `is_small`, the table of faces is filled. Returns the number of vertices.
    #[inline(always)]
    fn number(&mut self, vertex: u32, facets: usize, is_small: bool) -> usize {
        let Mesh {
            corners,
            cells,
            buffers,
            base,
            ..
        } = self;
        if buffers.numbers.len() < facets + 4 {
            buffers.numbers.resize(2 * facets + 4, [0; 3]);
            buffers.vertices.resize(6 * facets + 1, 0);
        }
        if *base > u32::MAX - 3 * facets as u32 - 3 {
            *base = 1;
            corners.iter_mut().for_each(|corner| corner.tag = 0);
        }
        let InsertionBuffers {
            cells: star,
            facets: boundary,
            numbers,
            vertices,
            faces,
            ..
        } = buffers;
        let (star, boundary, numbers) =
            (&star[..facets], &boundary[..facets], &mut numbers[..facets]);
        let (corners, cells, vertices) = (&mut corners[..], &mut cells[..], &mut vertices[..]);
        let (first, mut count) = (*base, 0);
        for ((&cell, &facet), numbers) in star.iter().zip(boundary).zip(numbers) {
            let [a, b, c, beyond] = facet;
            let mut number = |v: u32| {
                // PERF: without a branch on whether the vertex has a number already.
                let tag = &mut corners[v as usize].tag;
                vertices[count as usize] = v;
                let (number, is_new) = tag.overflowing_sub(first);
                let number = if is_new { count } else { number };
                *tag = first + number;
                count += u32::from(is_new);
                number
            };
            *numbers = [number(a), number(b), number(c)];
            cells[cell as usize].vertices = lanes::with_last(facet, vertex);
            cells[cell as usize].neighbors[3] = beyond;
            cells[(beyond >> 2) as usize].neighbors[(beyond & 3) as usize] = 4 * cell + 3;
            if is_small {
                let [a, b, c] = numbers.map(|number| number as usize);
                faces[(b * FEW + c) & LAST] = 4 * cell;
                faces[(c * FEW + a) & LAST] = 4 * cell + 1;
                faces[(a * FEW + b) & LAST] = 4 * cell + 2;
            }
        }
        *base += count;
        count as usize
    }

    /// Computes the vectors from the new vertex to the others of the star.
    #[inline(always)]
    fn aim(&mut self, vertex: u32, count: usize) {
        let (site, weight) = (self.corners[vertex as usize].site, self.weights.of(vertex));
        let InsertionBuffers {
            arrows, vertices, ..
        } = &mut self.buffers;
        if arrows.len() < count {
            arrows.resize(2 * count, [0.0; 4]);
        }
        for (arrow, &vertex) in arrows.iter_mut().zip(&vertices[..count]) {
            *arrow = sphere::arrow(site, self.corners[vertex as usize].site);
        }
        if self.weights.may_hide() {
            for (arrow, &vertex) in arrows.iter_mut().zip(&vertices[..count]) {
                arrow[3] -= self.weights.of(vertex) - weight;
            }
        }
    }

    /// Computes the spheres of the star, four at a time.
    ///
    /// `PERF:` pairs of `f64`, and lists as slices, save a tenth of all instructions and 4 % of the
    /// time. Four spheres at once in `f64` need more registers than there are.
    #[inline(always)]
    fn wrap(&mut self, facets: usize, origin: [f64; 3], lack: f64) {
        let Mesh {
            buffers,
            spheres,
            frame,
            weights,
            ..
        } = self;
        let origin = Origin {
            at: origin,
            lack,
            range: weights.range(),
        };
        // The last four may be fewer: the rest repeats the last one, for the dummy.
        let padded = facets.next_multiple_of(4);
        let last = buffers.numbers[facets - 1];
        buffers.numbers[facets..][..3].copy_from_slice(&[last; 3]);
        buffers.cells[facets..][..3].copy_from_slice(&[DUMMY; 3]);
        let InsertionBuffers {
            cells,
            numbers,
            arrows,
            ..
        } = &*buffers;
        let (cells, numbers) = (
            cells[..padded].as_chunks::<4>().0,
            numbers[..padded].as_chunks::<4>().0,
        );
        let (arrows, spheres) = (&arrows[..], &mut spheres[..]);
        for (&cells, numbers) in cells.iter().zip(numbers) {
            let ends = |[a, b, c]: [u32; 3]| {
                [
                    &arrows[a as usize],
                    &arrows[b as usize],
                    &arrows[c as usize],
                ]
            };
            let corners = [
                ends(numbers[0]),
                ends(numbers[1]),
                ends(numbers[2]),
                ends(numbers[3]),
            ];
            let rows = sphere::through(corners, origin, frame.scale);
            for (cell, row) in cells.into_iter().zip(rows) {
                spheres[cell as usize] = row;
            }
        }
    }

    /// Links the cells of a star with few vertices. Returns false if an edge has not exactly two
    /// facets.
    ///
    /// Every entry of the table that is read has been written for this star, so that it is never
    /// cleared. Then each of its faces is read exactly once, and the sums are equal. If two facets
    /// had the same directed edge, one would be missing (and the sums differ but for a chance of
    /// `2^-32`, with predicates that contradict each other).
    #[inline(always)]
    fn link(&mut self, facets: usize) -> bool {
        let Mesh { buffers, cells, .. } = self;
        let (star, numbers, faces) = (
            &buffers.cells[..facets],
            &buffers.numbers[..facets],
            &*buffers.faces,
        );
        let cells = &mut cells[..];
        let (mut written, mut read) = (0u32, 0u32);
        for (&cell, &number) in star.iter().zip(numbers) {
            let [a, b, c] = number.map(|number| number as usize);
            let neighbors = &mut cells[cell as usize].neighbors;
            neighbors[0] = faces[(c * FEW + b) & LAST];
            neighbors[1] = faces[(a * FEW + c) & LAST];
            neighbors[2] = faces[(b * FEW + a) & LAST];
            written = written.wrapping_add(cell.wrapping_mul(12).wrapping_add(3));
            read = read
                .wrapping_add(neighbors[0])
                .wrapping_add(neighbors[1])
                .wrapping_add(neighbors[2]);
        }
        written == read
    }

    /// Links the cells of a star with many vertices, by a hash table of its edges. Returns false if
    /// an edge has not exactly two facets.
    #[cold]
    fn link_many(&mut self, facets: usize) -> bool {
        const NONE: u64 = u64::MAX;
        const LINKED: u32 = u32::MAX;
        let Mesh {
            buffers:
                InsertionBuffers {
                    cells: star,
                    numbers,
                    edges,
                    faces_of_edges,
                    ..
                },
            cells,
            ..
        } = self;
        let slots = (3 * facets).next_power_of_two();
        let shift = 64 - slots.trailing_zeros();
        if edges.len() < slots {
            edges.resize(slots, NONE);
            faces_of_edges.resize(slots, 0);
        }
        let edges = &mut edges[..slots];
        edges.fill(NONE);
        let mut pairs = 0;
        for (&cell, &[a, b, c]) in star.iter().zip(&numbers[..facets]) {
            for (i, [from, to]) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
                let face = 4 * cell + i as u32;
                let edge = u64::from(from.min(to)) << 32 | u64::from(from.max(to));
                let mut slot = (edge.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as usize;
                while edges[slot] != NONE && edges[slot] != edge {
                    slot = (slot + 1) & (slots - 1);
                }
                if edges[slot] == NONE {
                    edges[slot] = edge;
                    faces_of_edges[slot] = face;
                } else {
                    let other = std::mem::replace(&mut faces_of_edges[slot], LINKED);
                    if other == LINKED {
                        return false;
                    }
                    pairs += 1;
                    cells[cell as usize].neighbors[i] = other;
                    cells[(other >> 2) as usize].neighbors[(other & 3) as usize] = face;
                }
            }
        }
        2 * pairs == 3 * facets
    }
}
