//! Serde for constrained Delaunay triangulations with their lines. Saved with the triangulation are
//! the tables of the chains of lines, and of the vertices that lines own or that were added where
//! lines cross.
//!
//! *What is checked.* Constraints are set on both sides of an edge, and the law holds between them.
//! Every line's chain from one of its vertices to the next ends there, meets no vertex twice, and
//! consists of constrained edges; where it bends, it is monotone on both axes. Every entry of the
//! tables belongs to a chain. Added vertices lie on constraints, and were not given with a line.
//!
//! *What is not checked*, because it would take the arrangement of all lines, is that chains are
//! those that the rounding of the crossings demands. The next edit that arranges the lines makes
//! them so.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::engine::ConstrainedEdges;
use crate::flaw::Level;
use crate::geometry::Crossing;
use crate::lines::Lines;
use crate::lines::saved_tables::SavedTables;
use crate::lines::{ConstrainedDelaunay, Rounding};
use crate::tds::VertexId;

use super::{Damage, ReadTriangulation, first};

/// What is saved: the names of these fields are those of the format. Vertices are written as their
/// numbers.
#[derive(Serialize, Deserialize)]
struct SavedWithLines<T> {
    triangulation: T,
    /// The vertices that each line was given by, by line id; `None` where a line has been removed.
    lines: Vec<Option<Vec<u32>>>,
    /// Segments that go through other sites, from the smaller end through all of these to the
    /// larger end.
    bent: Vec<Vec<u32>>,
    /// Split sub-constraints: the smaller end, the larger end, and the vertex between them.
    splits: Vec<[u32; 3]>,
    /// Constraints among collinear points.
    waiting: Vec<[u32; 2]>,
    /// Vertices that were added where lines cross, in order of their numbers.
    added: Vec<u32>,
    /// Vertices that are removed with the last of their lines, in order of their numbers.
    owned: Vec<u32>,
    rounding: Option<Rounding>,
    recrossed: bool,
}

fn number(v: &VertexId) -> u32 {
    v.index() as u32
}

impl<P, V, C: Copy + Default> SavedWithLines<ReadTriangulation<P, V, ConstrainedEdges<C>>> {
    fn restore<G: Crossing<Point = P> + Default>(
        self,
    ) -> Result<ConstrainedDelaunay<G, V, C>, Damage> {
        let inner = self.triangulation.restore::<3, G>()?;
        inner.has_no_hidden_points()?;
        inner.constrains_edges_only()?;
        first(inner.flaws(Level::Law, |cell, i| !inner.is_constrained(cell, i)))?;
        first(inner.one_sided_constraints())?;

        let vertex = |&number: &u32| match (number as usize) < inner.tds.vertex_slots() {
            true => Some(VertexId::new(number as usize)).filter(|&v| inner.tds.is_vertex(v)),
            false => None,
        };
        let vertices = |numbers: &[u32]| {
            let vertices: Option<Vec<VertexId>> = numbers.iter().map(vertex).collect();
            vertices.ok_or(Damage::Shape("a line names a vertex that does not exist"))
        };
        fn all<const K: usize>(vertices: Vec<VertexId>) -> Result<[VertexId; K], Damage> {
            vertices
                .try_into()
                .map_err(|_| Damage::Shape("a line names too few vertices"))
        }
        let in_order = |numbers: &[u32]| match numbers.is_sorted_by(|a, b| a < b) {
            true => vertices(numbers),
            false => Err(Damage::Shape("numbers of vertices are not in order")),
        };
        let parts = SavedTables {
            given: self
                .lines
                .iter()
                .map(|line| line.as_deref().map(vertices).transpose())
                .collect::<Result<_, _>>()?,
            bent: self
                .bent
                .iter()
                .map(|chain| vertices(chain))
                .collect::<Result<_, _>>()?,
            splits: self
                .splits
                .iter()
                .map(|split| all(vertices(split)?))
                .collect::<Result<_, _>>()?,
            waiting: self
                .waiting
                .iter()
                .map(|ends| all(vertices(ends)?))
                .collect::<Result<_, _>>()?,
            added: in_order(&self.added)?,
            owned: in_order(&self.owned)?,
            rounding: self.rounding,
            recrossed: self.recrossed,
        };
        let lines = Lines::from_saved_tables(parts).map_err(Damage::Shape)?;
        first(lines.check(&inner))?;
        Ok(ConstrainedDelaunay { inner, lines })
    }
}

impl<G: Crossing<Point: Serialize>, V: Serialize, C: Serialize + Copy + Default> Serialize
    for ConstrainedDelaunay<G, V, C>
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = |vertices: &[VertexId]| vertices.iter().map(number).collect::<Vec<u32>>();
        let parts = self.lines.saved_tables();
        let saved = SavedWithLines {
            triangulation: self.save(),
            lines: parts
                .given
                .iter()
                .map(|line| line.as_deref().map(numbers))
                .collect(),
            bent: parts.bent.iter().map(|chain| numbers(chain)).collect(),
            splits: parts
                .splits
                .iter()
                .map(|split| split.each_ref().map(number))
                .collect(),
            waiting: parts
                .waiting
                .iter()
                .map(|ends| ends.each_ref().map(number))
                .collect(),
            added: numbers(&parts.added),
            owned: numbers(&parts.owned),
            rounding: parts.rounding,
            recrossed: parts.recrossed,
        };
        saved.serialize(serializer)
    }
}

impl<'de, G, V, C> Deserialize<'de> for ConstrainedDelaunay<G, V, C>
where
    G: Crossing<Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let saved =
            SavedWithLines::<ReadTriangulation<G::Point, V, ConstrainedEdges<C>>>::deserialize(
                deserializer,
            )?;
        saved.restore().map_err(D::Error::custom)
    }
}
