//! A TIN in the bytes of its file, used where they are.
//!
//! The file is that of a [`Compact`](crate::triangulation::Compact) triangulation with sections:
//! which cells are faces of the surface, the fragments that a boundary or bounds have left, the
//! coordinate system. `docs/decisions/0030-a-tin-in-its-file.md` says why it is arranged so.

mod attributes;
mod check;
mod index;
mod layout;
mod part;
mod write;

use std::fmt;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::crs::Crs;
use crate::data::{BaseFace, EdgeKind, FaceAcross, Surface, SurfaceFacts};
use crate::error::{Command, Error, Result, wording};
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::tds::{CellId, Complex, VertexId};
use crate::triangulation::{Compact, CompactError, CompactSection, Location};

use super::admitted::searched;
use super::linear::linear;
use attributes::Attributes;
pub use index::{TinIndex, TinIndexPart};
use layout::{
    ATTRIBUTES, FRAGMENT, FRAGMENTS, Fragment, INSIDE, NUMBER, NUMBERS, OpenSide, SIDE, SIDES,
    UNDER, VERTEX, VERTICES,
};
pub use part::PartCell;
pub(super) use write::{write, write_part};

/// A TIN that is used where its bytes are, without being loaded.
///
/// [`Surface::write_tin`] writes it. `B` is anything that can be borrowed as bytes: a vector, or a
/// file that [`io::mapped`](crate::io::mapped) maps to memory. Opening reads a few hundred bytes,
/// however many points there are; then it is a surface with the faces and vertices, in the same
/// order, of the one that was written, so that all results are the same bytes.
///
/// Nothing in the bytes is trusted. What is damaged is not part of the surface, and
/// [`ensure_intact`](Surface::ensure_intact) then returns an error that names the cell or the
/// vertex. A wrong value that is possible leads to a wrong result; [`check`](Self::check) reads all
/// bytes and finds it. No bytes lead to a panic or an endless loop.
///
/// ```
/// use breakline::data::Surface;
/// use breakline::terrain::{CompactTin, TinBuilder};
///
/// let mut builder = TinBuilder::default();
/// builder.add_points(&[0.0, 9.0, 9.0, 0.0], &[0.0, 0.0, 9.0, 9.0], &[1.0, 2.0, 3.0, 5.0]);
/// let tin = builder.build()?;
/// let mut bytes = Vec::new();
/// tin.write_tin(&mut bytes)?;
///
/// let opened = CompactTin::open(bytes, "field.tin")?;
/// assert_eq!(opened.facts().triangles, 2);
/// assert_eq!(opened.face(0), tin.face(0));
/// opened.ensure_intact()?;
/// # Ok::<(), breakline::Error>(())
/// ```
#[derive(Debug)]
pub struct CompactTin<B> {
    triangulation: Compact<Terrain, B>,
    attributes: Attributes,
    inside: Range<usize>,
    vertices: Range<usize>,
    fragments: Range<usize>,
    sides: Range<usize>,
    /// Empty unless it is part of a larger surface.
    numbers: Range<usize>,
    /// Empty as well, then.
    under: Range<usize>,
    /// For messages.
    path: PathBuf,
    damage: OnceLock<Damage>,
}

/// What was found damaged.
#[derive(Debug, Clone, PartialEq)]
enum Damage {
    Triangulation(CompactError),
    /// A vertex of fragments.
    Vertex(u32),
    /// A face whose corners or edges are impossible.
    Face(u32),
    /// A face and the neighbor that the file states for it do not share an edge.
    Link(u32, u32),
    /// The row of an edge of a whole triangle, by its position.
    Side(usize),
    /// The counts or the extent are not those of the faces.
    Facts,
}

/// A face and its corner that is not on an edge.
struct Linked {
    face: u32,
    corner: usize,
    vertex: u32,
}

/// What was read, or the damage there.
type Found<T> = std::result::Result<T, Damage>;

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Damage::Triangulation(error) => error.fmt(f),
            Damage::Vertex(vertex) => write!(f, "vertex {vertex} is damaged"),
            Damage::Face(face) => write!(f, "face {face} is damaged"),
            Damage::Link(face, neighbor) => {
                write!(
                    f,
                    "face {face} does not share an edge with its neighbor {neighbor}"
                )
            }
            Damage::Side(row) => write!(f, "row {row} of section `sides` is damaged"),
            Damage::Facts => f.write_str("the counts or the extent are not those of the faces"),
        }
    }
}

impl From<CompactError> for Damage {
    fn from(error: CompactError) -> Self {
        Damage::Triangulation(error)
    }
}

impl<B: AsRef<[u8]>> CompactTin<B> {
    /// Opens a TIN; `path` is its name in messages.
    ///
    /// # Errors
    /// If the bytes are not those of a TIN, have another version, or are incomplete.
    ///
    /// # Complexity
    /// Constant.
    pub fn open(bytes: B, path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::opened(bytes, path).map_err(|error| {
            let error = error.in_file(path);
            if error.cure_text().is_some() {
                error
            } else {
                error.cure(wording!["write the file again with ", Command::Tin])
            }
        })
    }

    fn opened(bytes: B, path: &Path) -> Result<Self> {
        let triangulation =
            Compact::open(Terrain::default(), bytes).map_err(|e| Error::format(e.to_string()))?;
        if triangulation.dimension() != 2 {
            return Err(Error::format("the triangulation has no triangle"));
        }
        let section = |tag: [u8; 8]| {
            let name = tag.escape_ascii().to_string();
            triangulation.section_range(tag).ok_or_else(|| {
                Error::format(format!(
                    "a triangulation without the section `{}` of a TIN",
                    name.trim_end()
                ))
            })
        };
        let rows = |tag: [u8; 8], size: usize| match section(tag)? {
            range if range.len() % size == 0 => Ok(range),
            range => Err(
                Error::format(format!("{} bytes of rows of {size}", range.len())).at(format!(
                    "section `{}`",
                    tag.escape_ascii().to_string().trim_end()
                )),
            ),
        };
        let bits = |tag: [u8; 8]| match (section(tag)?, triangulation.cell_count().div_ceil(8)) {
            (range, expected) if range.len() == expected => Ok(range),
            (range, expected) => {
                Err(
                    Error::format(format!("{} bytes, expected {expected}", range.len())).at(
                        format!("section `{}`", tag.escape_ascii().to_string().trim_end()),
                    ),
                )
            }
        };
        let inside = bits(INSIDE)?;
        let vertices = rows(VERTICES, VERTEX)?;
        let fragments = rows(FRAGMENTS, FRAGMENT)?;
        let sides = rows(SIDES, SIDE)?;
        let numbers = triangulation.section_range(NUMBERS).unwrap_or_default();
        let vertex_count = triangulation.vertex_count();
        if !numbers.is_empty() && numbers.len() != NUMBER * vertex_count {
            return Err(Error::format(format!(
                "{} bytes for {vertex_count} vertices",
                numbers.len()
            ))
            .at("section `numbers`"));
        }
        let under = if numbers.is_empty() {
            0..0
        } else {
            bits(UNDER)?
        };
        let attributes = &triangulation.bytes()[section(ATTRIBUTES)?];
        let attributes = Attributes::from_json(attributes).map_err(|e| e.at("section `tin`"))?;
        let tin = CompactTin {
            attributes,
            inside,
            vertices,
            fragments,
            sides,
            numbers,
            under,
            path: path.to_path_buf(),
            damage: OnceLock::new(),
            triangulation,
        };
        // Numbers fit into 32 bits, and one is left for "none".
        if tin.face_numbers() >= u32::MAX as usize || tin.vertex_numbers() >= u32::MAX as usize {
            return Err(Error::format("more faces or vertices than have numbers"));
        }
        Ok(tin)
    }

    /// Returns the underlying triangulation, for queries.
    ///
    /// It covers the whole convex hull, and is not cut by a boundary or bounds.
    pub fn triangulation(&self) -> &Compact<Terrain, B> {
        &self.triangulation
    }

    /// Returns the counts and the extent that the file states; [`check`](Self::check) compares them
    /// with the faces.
    pub fn facts(&self) -> &SurfaceFacts {
        &self.attributes.facts
    }

    /// Sets the coordinate system; coordinates do not change.
    pub fn set_crs(&mut self, crs: Option<Crs>) {
        self.attributes.crs = crs;
    }

    /// Returns true if a boundary or bounds have cut triangles, and the surface contains fragments
    /// of them.
    pub fn has_fragments(&self) -> bool {
        !self.fragments.is_empty()
    }

    /// Returns the height at a position in plan, linear on the whole triangle there; `None` outside
    /// of the whole triangles of the surface. [`Interpolant`](super::Interpolant) finds heights in
    /// fragments, too.
    ///
    /// The walk begins at the cell `near` and leaves the one at the position there, see
    /// [`Tin::elevation_near`](super::Tin::elevation_near).
    pub fn elevation_in_whole(&self, q: [f64; 2], near: &mut Option<CellId>) -> Option<f64> {
        self.or_record(self.find_elevation(q, near), None)
    }

    fn find_elevation(&self, q: [f64; 2], near: &mut Option<CellId>) -> Found<Option<f64>> {
        let q = searched(q);
        let location = self.triangulation.locate(&[q[0], q[1], 0.0], *near)?;
        *near = location.cell_in(&self.triangulation)?.or(*near);
        // The first of them, however they were reached: rounded heights of two cells may differ.
        let inside = location
            .cells(&self.triangulation)?
            .into_iter()
            .filter(|cell| self.is_inside(cell.index()));
        let inside = inside.min_by_key(|cell| cell.index());
        let Some(cell) = inside else { return Ok(None) };
        if let Location::Vertex(vertex) = location {
            return self.point(vertex.index() as u32).map(|[_, _, z]| Some(z));
        }
        let [a, b, c] = self
            .triangulation
            .corners(cell)?
            .map(|vertex| self.point(vertex.index() as u32));
        Ok(Some(linear([a?, b?, c?], q)))
    }

    /// Appends the faces at a position; returns false if fragments may be there, which are not
    /// linked to a search.
    fn find_faces(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> Found<bool> {
        let start = near.map(|cell| CellId::new(cell as usize));
        let location = self.triangulation.locate(&[q[0], q[1], 0.0], start)?;
        if let Some(cell) = location.cell_in(&self.triangulation)? {
            *near = Some(cell.index() as u32);
        }
        let cells = match location {
            Location::Cell { cell, facets } if facets.is_empty() => vec![cell],
            _ => location.cells(&self.triangulation)?,
        };
        let is_inside = |cell: &CellId| self.is_inside(cell.index());
        let is_whole = !cells.is_empty() && cells.iter().all(is_inside);
        if self.has_fragments() && !is_whole {
            return Ok(false);
        }
        let inside = cells.into_iter().filter(is_inside);
        faces.extend(inside.map(|cell| cell.index() as u32));
        Ok(true)
    }

    fn face_numbers(&self) -> usize {
        self.triangulation.cell_count() + self.fragments.len() / FRAGMENT
    }

    fn vertex_numbers(&self) -> usize {
        self.triangulation.vertex_count() + self.vertices.len() / VERTEX
    }

    /// Returns a row of a section; `None` beyond its end.
    #[inline]
    fn row<const W: usize>(&self, section: &Range<usize>, row: usize) -> Option<&[u8; W]> {
        self.triangulation
            .bytes()
            .get(section.clone())?
            .get(W * row..)?
            .first_chunk()
    }

    /// Returns true if a whole cell is a face.
    #[inline]
    fn is_inside(&self, cell: usize) -> bool {
        self.has_bit(&self.inside, cell)
    }

    /// Returns the bit of a cell in a section; false beyond all cells.
    #[inline]
    fn has_bit(&self, section: &Range<usize>, cell: usize) -> bool {
        cell < self.triangulation.cell_count()
            && self
                .row(section, cell / 8)
                .is_some_and(|[bits]| bits >> (cell % 8) & 1 == 1)
    }

    /// The number of a fragment; `None` for whole cells.
    #[inline]
    fn fragment_number(&self, face: u32) -> Option<usize> {
        (face as usize).checked_sub(self.triangulation.cell_count())
    }

    fn fragment(&self, face: u32, number: usize) -> Found<Fragment> {
        self.row(&self.fragments, number)
            .and_then(Fragment::read)
            .ok_or(Damage::Face(face))
    }

    #[inline]
    fn corners(&self, face: u32) -> Found<Option<[u32; 3]>> {
        let [a, b, c] = match self.fragment_number(face) {
            None if self.is_inside(face as usize) => {
                let number = |v: VertexId| {
                    if v == VertexId::INFINITE {
                        u32::MAX
                    } else {
                        v.index() as u32
                    }
                };
                self.triangulation
                    .corners(CellId::new(face as usize))?
                    .map(number)
            }
            Some(number) if (face as usize) < self.face_numbers() => {
                self.fragment(face, number)?.corners
            }
            None | Some(_) => return Ok(None),
        };
        let is_face =
            a != b && b != c && c != a && (a.max(b).max(c) as usize) < self.vertex_numbers();
        if is_face {
            Ok(Some([a, b, c]))
        } else {
            Err(Damage::Face(face))
        }
    }

    #[inline]
    fn point(&self, vertex: u32) -> Found<[f64; 3]> {
        let point = match (vertex as usize).checked_sub(self.triangulation.vertex_count()) {
            None => self.triangulation.point(VertexId::new(vertex as usize))?,
            Some(number) => {
                let row: &[u8; VERTEX] = self
                    .row(&self.vertices, number)
                    .ok_or(Damage::Vertex(vertex))?;
                let mut point = [0.0; 3];
                for (x, bytes) in point.iter_mut().zip(row.as_chunks().0) {
                    *x = f64::from_le_bytes(*bytes);
                }
                point
            }
        };
        // The geometry does not look at heights.
        let is_point = point[2].is_finite() && self.triangulation.geometry().admits(&point);
        if is_point {
            Ok(point)
        } else {
            Err(Damage::Vertex(vertex))
        }
    }

    /// The row of an edge of a whole triangle.
    fn side(&self, face: u32, corner: usize) -> Found<Option<OpenSide>> {
        let rows = self
            .triangulation
            .bytes()
            .get(self.sides.clone())
            .unwrap_or_default()
            .as_chunks::<SIDE>()
            .0;
        let key = (face, corner as u8);
        let at = rows.partition_point(|row| OpenSide::key(row) < key);
        match rows.get(at).filter(|row| OpenSide::key(row) == key) {
            Some(row) => OpenSide::read(row).map(Some).ok_or(Damage::Side(at)),
            None => Ok(None),
        }
    }

    /// The face that the file states across an edge, which may not link back.
    fn stated_neighbor(&self, face: u32, i: usize) -> Found<Option<u32>> {
        if let Some(number) = self.fragment_number(face) {
            return Ok(self.fragment(face, number)?.neighbors[i]);
        }
        let beside = self
            .triangulation
            .neighbor(CellId::new(face as usize), i)?
            .index();
        if self.is_inside(beside) {
            Ok(Some(beside as u32))
        } else {
            Ok(self.side(face, i)?.and_then(|side| side.neighbor))
        }
    }

    /// The face across an edge. It links back, so that no walk from face to face is endless.
    fn linked_neighbor(&self, face: u32, i: usize) -> Found<Option<Linked>> {
        let Some(corners) = self.corners(face)?.filter(|_| i < 3) else {
            return Ok(None);
        };
        let Some(beside) = self.stated_neighbor(face, i)? else {
            return Ok(None);
        };
        let broken = || Damage::Link(face, beside);
        let theirs = self.corners(beside)?.ok_or_else(broken)?;
        let edge = [corners[(i + 2) % 3], corners[(i + 1) % 3]];
        let j = (0..3)
            .find(|j| [theirs[(j + 1) % 3], theirs[(j + 2) % 3]] == edge)
            .ok_or_else(broken)?;
        if beside != face && self.stated_neighbor(beside, j)? == Some(face) {
            Ok(Some(Linked {
                face: beside,
                corner: j,
                vertex: theirs[j],
            }))
        } else {
            Err(broken())
        }
    }

    /// Returns the face across an edge, with the corner beyond it.
    fn face_across(&self, face: u32, i: usize) -> Found<Option<FaceAcross>> {
        let Some(linked) = self.linked_neighbor(face, i)? else {
            return Ok(None);
        };
        Ok(Some(FaceAcross {
            number: linked.face,
            corner: linked.corner,
            apex: self.point(linked.vertex)?,
        }))
    }

    /// The kind of an edge of a whole triangle, if the file states kinds beside the triangulation.
    fn stated_kind(&self, face: u32, i: usize) -> Found<Option<EdgeKind>> {
        Ok(if self.sides.is_empty() {
            None
        } else {
            self.side(face, i)?.map(|side| side.kind)
        })
    }

    fn kind(&self, face: u32, i: usize) -> Found<EdgeKind> {
        if i > 2 || face as usize >= self.face_numbers() {
            return Ok(EdgeKind::Rim);
        }
        if let Some(number) = self.fragment_number(face) {
            return Ok(self.fragment(face, number)?.edges[i]);
        }
        if let Some(kind) = self.stated_kind(face, i)? {
            return Ok(kind);
        }
        let cell = CellId::new(face as usize);
        if self.triangulation.is_constrained(cell, i)? {
            Ok(EdgeKind::Breakline)
        } else if self.is_inside(self.triangulation.neighbor(cell, i)?.index()) {
            Ok(EdgeKind::Plain)
        } else {
            Ok(self.side(face, i)?.map_or(EdgeKind::Rim, |side| side.kind))
        }
    }

    /// The whole triangle with a number, be it a face of the surface or not; `None` for an infinite
    /// cell.
    fn base_face(&self, number: u32) -> Found<Option<BaseFace>> {
        let cell = CellId::new(number as usize);
        let is_infinite = |corners: [VertexId; 3]| corners.contains(&VertexId::INFINITE);
        let corners = self.triangulation.corners(cell)?;
        if is_infinite(corners) {
            return Ok(None);
        }
        let mut face = BaseFace {
            number,
            corners: corners.map(|v| v.index() as u32),
            neighbors: [None; 3],
            edges: [EdgeKind::Plain; 3],
        };
        for i in 0..3 {
            let beside = self.triangulation.neighbor(cell, i)?;
            if !is_infinite(self.triangulation.corners(beside)?) {
                face.neighbors[i] = Some(beside.index() as u32);
            }
            face.edges[i] = match (
                self.triangulation.is_constrained(cell, i)?,
                face.neighbors[i],
            ) {
                (true, _) => self.stated_kind(number, i)?.unwrap_or(EdgeKind::Breakline),
                (false, Some(_)) => EdgeKind::Plain,
                (false, None) => EdgeKind::Rim,
            };
        }
        Ok(Some(face))
    }

    /// Returns what was found, or records the damage and returns a value that any caller can use.
    #[inline]
    fn or_record<T>(&self, found: Found<T>, instead: T) -> T {
        found.unwrap_or_else(|damage| {
            self.damage.get_or_init(|| damage);
            instead
        })
    }

    #[cold]
    fn error(&self, damage: &Damage) -> Error {
        Error::format(damage.to_string())
            .in_file(&self.path)
            .cure(wording![
                "copy the file again, or write it again with ",
                Command::Tin,
                "; ",
                Command::Check.on(self.path.display().to_string()),
                " reads all of it"
            ])
    }
}

impl<B: AsRef<[u8]> + Sync> Surface for CompactTin<B> {
    fn vertex_count(&self) -> usize {
        self.vertex_numbers()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.or_record(self.point(vertex), [0.0; 3])
    }

    fn face_count(&self) -> usize {
        self.face_numbers()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.or_record(self.corners(face), None)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let linked = self.or_record(self.linked_neighbor(face, i), None);
        linked.map(|linked| linked.face)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        self.or_record(self.face_across(face, i), None)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.or_record(self.kind(face, i), EdgeKind::Rim)
    }

    fn has_lines(&self) -> bool {
        self.attributes.facts.edges.total() > 0 || !self.fragments.is_empty()
    }

    fn is_fragment(&self, face: u32) -> bool {
        self.fragment_number(face).is_some()
    }

    fn crs(&self) -> Option<&Crs> {
        self.attributes.crs.as_ref()
    }

    fn faces_at(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        self.or_record(self.find_faces(q, near, faces), true)
    }

    fn base_count(&self) -> usize {
        self.triangulation.cell_count()
    }

    fn base_faces_in(&self, numbers: Range<u32>, faces: &mut Vec<BaseFace>) {
        faces.extend(numbers.filter_map(|number| self.or_record(self.base_face(number), None)));
    }

    fn ensure_intact(&self) -> Result<()> {
        match self.damage.get() {
            Some(damage) => Err(self.error(damage)),
            None => Ok(()),
        }
    }

    /// Copies the file; only the coordinate system may have changed.
    fn write_tin(&self, mut out: &mut dyn Write) -> Result<()> {
        self.triangulation.write_compact(&mut out)?;
        for (tag, range) in [
            (INSIDE, &self.inside),
            (VERTICES, &self.vertices),
            (FRAGMENTS, &self.fragments),
            (SIDES, &self.sides),
        ] {
            let contents = self
                .triangulation
                .bytes()
                .get(range.clone())
                .unwrap_or_default();
            CompactSection { tag, contents }.write(&mut out)?;
        }
        write::write_attributes(&self.attributes, &mut out)?;
        for (tag, range) in [(NUMBERS, &self.numbers), (UNDER, &self.under)]
            .into_iter()
            .filter(|_| self.is_part())
        {
            let contents = self
                .triangulation
                .bytes()
                .get(range.clone())
                .unwrap_or_default();
            CompactSection { tag, contents }.write(&mut out)?;
        }
        Ok(())
    }
}
