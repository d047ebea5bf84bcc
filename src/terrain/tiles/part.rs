//! The triangulation of a task, as a file of the triangles that it found.

use std::io::Write;

use super::triangle::{TileTriangle, TileVertex};
use crate::data::{EdgeKind, Surface};
use crate::error::Result;
use crate::terrain::lines::kinds::LineKinds;
use crate::terrain::{CompactTin, PartCell, Tin, compact};
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;

/// The triangulation of one task, with the triangles that were final there.
///
/// Those of all tasks together are the surface; no triangle is in two of them. As a
/// [`CompactTin`] it answers queries where it is, and its vertices have
/// the [numbers](CompactTin::number_in_parts) that stand for them in all parts.
#[derive(Debug)]
pub struct TinPart {
    pub(super) tin: Tin,
    /// The cells of the triangles that were emitted, in that order, as the file numbers them.
    emitted: Vec<u32>,
    /// The tile and the number of each vertex.
    numbers: Vec<[u32; 2]>,
    /// The cells that are triangles of the whole, beside those that were emitted: positions among
    /// all cells.
    given: Vec<u32>,
}

impl TinPart {
    /// `kinds` are those of the lines of the triangulation; `numbers` follow its vertices.
    pub(super) fn new(
        triangulation: ConstrainedDelaunay<Terrain>,
        kinds: Vec<EdgeKind>,
        emitted: Vec<u32>,
        numbers: Vec<[u32; 2]>,
    ) -> Self {
        let mut tin = Tin::new(triangulation, LineKinds::new(kinds), None);
        tin.inside.fill(false);
        TinPart {
            tin,
            emitted,
            numbers,
            given: Vec::new(),
        }
    }

    /// Makes triangles that other tasks have found those of this part: cells for which `is_given`
    /// is true, and as faces those that are `inside`.
    pub(super) fn take_over(&mut self, is_given: &[bool], inside: Vec<bool>) {
        let cells = (0..).zip(self.tin.triangulation.tds().cells());
        self.given = cells
            .filter(|(_, cell)| is_given[cell.index()])
            .map(|(at, _)| at)
            .collect();
        self.tin.inside = inside;
    }

    /// Returns the faces that the triangles became, in the order in which they were emitted.
    pub fn faces(&self) -> &[u32] {
        &self.emitted
    }

    /// Returns the triangles of the part, in the order of its faces. Their edges at the rim of the
    /// part are plain. Vertices of fragments have numbers of their own: no other part has them.
    ///
    /// # Complexity
    /// Linear in the vertices once, then constant for each triangle.
    pub fn triangles(&self) -> impl Iterator<Item = TileTriangle> + '_ {
        let tds = self.tin.triangulation.tds();
        let mut number_of = vec![[u32::MAX; 2]; tds.vertex_slots()];
        tds.vertices()
            .zip(&self.numbers)
            .for_each(|(id, number)| number_of[id.index()] = *number);
        let vertex = move |tin: &Tin, vertex: u32| {
            let added = [u32::MAX, vertex.wrapping_sub(number_of.len() as u32)];
            let [tile, number] = number_of.get(vertex as usize).copied().unwrap_or(added);
            TileVertex {
                tile,
                number,
                position: tin.position(vertex),
                is_tight: false,
            }
        };
        (0..self.tin.face_count() as u32).filter_map(move |face| {
            let corners = self.tin.face(face)?.map(|corner| vertex(&self.tin, corner));
            Some(TileTriangle {
                corners,
                edges: [0, 1, 2].map(|i| plain_at_rim(self.tin.edge_kind(face, i))),
            })
        })
    }

    /// Writes the part as a `.tin`. `decided` says of each triangle that was emitted, in the same
    /// order, what it is in the larger surface.
    ///
    /// # Errors
    /// Those of `out`, and if there are too many faces or vertices to be numbered.
    ///
    /// # Complexity
    /// Linear.
    pub fn write(
        mut self,
        decided: impl IntoIterator<Item = PartCell>,
        out: &mut dyn Write,
    ) -> Result<()> {
        let cells: Vec<_> = self.tin.triangulation.tds().cells().collect();
        let mut is_under = vec![false; cells.len()];
        self.given
            .iter()
            .for_each(|&at| is_under[at as usize] = true);
        for (&at, decided) in self.emitted.iter().zip(decided) {
            self.tin.inside[cells[at as usize].index()] = decided == PartCell::Face;
            is_under[at as usize] = decided != PartCell::Elsewhere;
        }
        drop(cells);
        self.tin.write_tin(out)?;
        compact::write_part(&self.numbers, is_under.into_iter(), out)
    }
}

impl<B: AsRef<[u8]> + Sync> CompactTin<B> {
    /// Returns the position of a vertex, with its numbers: see
    /// [`number_in_parts`](Self::number_in_parts).
    ///
    /// Returns `None` if the vertex does not exist, or the file is not a part of a larger surface.
    pub fn tile_vertex(&self, vertex: u32) -> Option<TileVertex> {
        let [tile, number] = self.number_in_parts(vertex)?;
        Some(TileVertex {
            tile,
            number,
            position: self.position(vertex),
            is_tight: false,
        })
    }

    /// Returns the triangles of a part, in the order of its faces. Their edges at the rim of the
    /// part are plain.
    ///
    /// What is damaged is left out; see [`Surface::ensure_intact`].
    ///
    /// # Complexity
    /// Constant for each triangle.
    pub fn tile_triangles(&self) -> impl Iterator<Item = TileTriangle> + '_ {
        (0..self.face_count() as u32).filter_map(|face| {
            let [a, b, c] = self.face(face)?.map(|vertex| self.tile_vertex(vertex));
            Some(TileTriangle {
                corners: [a?, b?, c?],
                edges: [0, 1, 2].map(|i| plain_at_rim(self.edge_kind(face, i))),
            })
        })
    }
}

/// What is at the rim of a part need not be at that of the surface.
fn plain_at_rim(kind: EdgeKind) -> EdgeKind {
    if kind == EdgeKind::Rim {
        EdgeKind::Plain
    } else {
        kind
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::tiles::{Residual, SubConstraint, Tile, leaf_with_part, merge_with_part};
    use testkit::random::Random;

    fn key(triangle: &TileTriangle) -> ([[u32; 2]; 3], [u8; 3]) {
        let numbers = triangle.corners.map(|corner| [corner.tile, corner.number]);
        let first = (0..3).min_by_key(|&i| numbers[i]).unwrap();
        let order = [0, 1, 2].map(|k| (first + k) % 3);
        (
            order.map(|i| numbers[i]),
            order.map(|i| triangle.edges[i].rank()),
        )
    }

    /// Writes a part with every second of its triangles, some of which are under the surface, and
    /// opens it with all of them.
    fn opened(part: TinPart) -> CompactTin<Vec<u8>> {
        let faces = part.faces().to_vec();
        let mut bytes = Vec::new();
        let decided = |at: usize| {
            [
                PartCell::Face,
                PartCell::Elsewhere,
                PartCell::Under,
                PartCell::Elsewhere,
            ][at % 4]
        };
        part.write((0..faces.len()).map(decided), &mut bytes)
            .unwrap();
        let some = CompactTin::open(bytes.clone(), "part").unwrap();
        some.check().unwrap();
        assert_eq!(some.tile_triangles().count(), faces.len().div_ceil(4));
        assert_eq!(some.faces_under_whole().count(), faces.len().div_ceil(2));
        assert_eq!(some.has_triangles(), !faces.is_empty());
        let cells: Vec<(u32, PartCell)> =
            faces.iter().map(|&face| (face, PartCell::Face)).collect();
        let all = CompactTin::open_with_cells(bytes, "part", &cells).unwrap();
        all.check().unwrap();
        assert_eq!(all.faces_under_whole().count(), faces.len());
        let beyond = [(u32::MAX, PartCell::Face)];
        assert!(
            CompactTin::open_with_cells(all.triangulation().bytes().to_vec(), "part", &beyond)
                .is_err()
        );
        // A copy has the numbers, too.
        let mut copy = Vec::new();
        all.write_tin(&mut copy).unwrap();
        CompactTin::open(copy, "copy").unwrap()
    }

    /// The parts of all tasks have the triangles that were emitted, with their numbers and the
    /// kinds of their edges.
    #[test]
    fn parts_have_the_triangles_of_their_tasks() {
        let mut random = Random(5);
        let mut walls = 0;
        for round in 0..200 {
            let side = [4, 9, 30][round % 3];
            let mut site = || [0, 1].map(|_| f64::from(random.below(side) as u32));
            let mut points: Vec<[f64; 3]> = (0..round % 50)
                .map(|_| site())
                .map(|[x, y]| [x, y, x - y])
                .collect();
            // Lines side by side do not cross; some are short, and end within a tile.
            let lines: Vec<SubConstraint> = (0..round % 4)
                .map(|row| {
                    let (y, ends) = (row as f64 + 0.5, [site()[0], site()[0] + 1.0]);
                    let kind = [EdgeKind::Breakline, EdgeKind::Wall][row % 2];
                    SubConstraint {
                        ends: ends.map(|x| [x, y]),
                        kind,
                    }
                })
                .collect();
            points.extend(
                lines
                    .iter()
                    .flat_map(|line| line.ends)
                    .map(|[x, y]| [x, y, 1.0]),
            );
            points.sort_by(|a, b| a.partial_cmp(b).unwrap());
            points.dedup_by_key(|p| [p[0], p[1]]);
            let cut = [
                f64::NEG_INFINITY,
                f64::from(side as u32) / 2.0,
                f64::INFINITY,
            ];
            let (mut emitted, mut parts) = (Vec::new(), Vec::new());
            let mut emit = |triangle: TileTriangle| emitted.push(key(&triangle));
            let residuals: Vec<Residual> = (0..2)
                .map(|k| {
                    let tile = Tile {
                        min: [cut[k], cut[0]],
                        max: [cut[k + 1], cut[2]],
                    };
                    let own: Vec<[f64; 3]> = points
                        .iter()
                        .copied()
                        .filter(|p| tile.holds([p[0], p[1]]))
                        .collect();
                    let (residual, part) =
                        leaf_with_part(&tile, k as u32, &own, &lines, 0.0, &mut emit).unwrap();
                    parts.extend(part);
                    residual
                })
                .collect();
            parts.extend(
                merge_with_part(&Tile::PLANE, &residuals, 0.0, &mut emit)
                    .unwrap()
                    .1,
            );
            let opened: Vec<CompactTin<Vec<u8>>> = parts.into_iter().map(opened).collect();
            let mut found: Vec<_> = opened
                .iter()
                .flat_map(|part| part.tile_triangles())
                .map(|t| key(&t))
                .collect();
            found.sort_unstable();
            emitted.sort_unstable();
            assert_eq!(found, emitted, "round {round}: {points:?} {lines:?}");
            walls += found
                .iter()
                .filter(|(_, edges)| edges.contains(&EdgeKind::Wall.rank()))
                .count();
        }
        assert!(walls > 100, "{walls} triangles at walls");
    }
}
