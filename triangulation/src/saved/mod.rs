//! Serde, behind the feature `serde`: saves a triangulation of the plane or of space as its points,
//! its payloads, and the vertices of its cells.
//!
//! The geometry is not saved: a triangulation that is read has the default one. Vertices keep their
//! numbers, and so do removed ones; cells are numbered anew. Neighbors follow from common facets.
//!
//! Input is not trusted. [Links and manifold](Level::Manifold), orientation and convexity, and the
//! law of the kind are checked with exact predicates, in linear time. Damage is an error, and never
//! a panic. The checks of lines are described in [lines](self::lines).

mod lines;

use std::fmt;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::engine::ConstrainedEdges;
use crate::engine::trace::TraceBuffers;
use crate::error::{InputError, MAX_VERTICES};
use crate::flaw::{Flaw, Level};
use crate::geometry::Geometry;
use crate::kinds::{Basic, Constrained, Delaunay, Regular};
use crate::tds::{CellId, Parts, Tds, VertexId};
use crate::triangulation::Triangulation;

/// What is saved. Written from slices, read into vectors.
#[derive(Serialize, Deserialize)]
struct SavedTriangulation<Points, VertexData, CellData> {
    dimension: i32,
    /// The points by vertex number, including those of removed vertices.
    points: Points,
    vertex_data: VertexData,
    /// Numbers of removed vertices; the next to be reused is the last.
    removed: Vec<u32>,
    /// The vertices of the cells, `dimension + 1` each; the infinite vertex is `None`.
    cells: Vec<Option<u32>>,
    cell_data: CellData,
}

/// The reason why a saved triangulation cannot be read.
enum Damage {
    /// Lengths or numbers do not match.
    Shape(&'static str),
    Point(InputError),
    Flaw(Flaw),
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Damage::Shape(what) => write!(f, "damaged triangulation: {what}"),
            Damage::Point(refused) => write!(f, "damaged triangulation: {refused}"),
            Damage::Flaw(flaw) => write!(f, "damaged triangulation: {flaw}"),
        }
    }
}

fn first(flaws: Vec<Flaw>) -> Result<(), Damage> {
    flaws
        .first()
        .map_or(Ok(()), |&flaw| Err(Damage::Flaw(flaw)))
}

type ReadTriangulation<P, V, C> = SavedTriangulation<Vec<P>, Vec<V>, Vec<C>>;

impl<P, V, C: Copy + Default> ReadTriangulation<P, V, C> {
    /// Returns the triangulation, or what is wrong with the data. Does not check the law, nor that
    /// every point that is in no cell is hidden.
    fn restore<const N: usize, G: Geometry<N, Point = P> + Default>(
        self,
    ) -> Result<Triangulation<G, N, V, C>, Damage> {
        let SavedTriangulation {
            dimension,
            points,
            vertex_data,
            removed,
            cells,
            cell_data,
        } = self;
        let geometry = G::default();
        if !(-1..N as i32).contains(&dimension) {
            return Err(Damage::Shape(
                "the dimension is below -1, or above that of the plane or space",
            ));
        }
        if points.len() > MAX_VERTICES {
            return Err(Damage::Point(InputError::TooMany));
        }
        if let Some(error) = InputError::of_points(&geometry, &points) {
            return Err(Damage::Point(error));
        }
        if vertex_data.len() != points.len() {
            return Err(Damage::Shape("there are not as many payloads as points"));
        }
        let is_complete = cells.len() == cell_data.len() * (dimension + 1) as usize;
        if !is_complete
            || cell_data.len() >= CellId::LIMIT
            || dimension == -1 && !cell_data.is_empty()
        {
            return Err(Damage::Shape("the number of cells does not fit"));
        }
        let vertex = |number: u32| match (number as usize) < points.len() {
            true => Ok(VertexId::new(number as usize)),
            false => Err(Damage::Shape("a number is not that of a vertex")),
        };
        let cells = cells
            .into_iter()
            .map(|number| number.map_or(Ok(VertexId::INFINITE), vertex));
        let cells = cells.collect::<Result<Vec<_>, _>>()?;
        let free = removed
            .into_iter()
            .map(vertex)
            .collect::<Result<Vec<_>, _>>()?;
        let parts = Parts {
            dimension,
            cells,
            cell_data,
            vertex_data,
            free,
        };
        let tds = Tds::from_parts(parts).map_err(|error| Damage::Flaw(Flaw::Structure(error)))?;
        let restored = Triangulation {
            geometry,
            tds,
            points,
            zone: None,
            last: None,
        };
        first(restored.flaws(Level::Orientation, |_, _| false))?;
        Ok(restored)
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    fn save(&self) -> SavedTriangulation<&[G::Point], &[V], Vec<C>> {
        let number = |v: &VertexId| (*v != VertexId::INFINITE).then(|| v.index() as u32);
        SavedTriangulation {
            dimension: self.dimension(),
            points: &self.points,
            vertex_data: self.tds.payloads(),
            removed: self
                .tds
                .free_vertices()
                .iter()
                .map(|v| v.index() as u32)
                .collect(),
            cells: self
                .tds
                .cells()
                .flat_map(|cell| self.tds.cell_vertices(cell).iter().map(number))
                .collect(),
            cell_data: self
                .tds
                .cells()
                .map(|cell| *self.tds.cell_data(cell))
                .collect(),
        }
    }

    fn has_no_hidden_points(&self) -> Result<(), Damage> {
        match self.tds.detached_vertices()[..] {
            [] => Ok(()),
            _ => Err(Damage::Shape("a vertex is in no cell")),
        }
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, ConstrainedEdges<C>> {
    fn constrains_edges_only(&self) -> Result<(), Damage> {
        let is_edge = |cell, i: usize| {
            i < 3
                && self.dimension() == 2
                && !self.tds.edge_ends(cell, i).contains(&VertexId::INFINITE)
        };
        match self
            .tds
            .cells()
            .any(|cell| (0..8).any(|i| self.is_constrained(cell, i) && !is_edge(cell, i)))
        {
            true => Err(Damage::Shape("an edge that does not exist is constrained")),
            false => Ok(()),
        }
    }
}

/// Reads a triangulation of some kind; `finish` does what remains for that kind.
fn read<'de, D: Deserializer<'de>, G, const N: usize, V, C, T>(
    deserializer: D,
    finish: impl FnOnce(Triangulation<G, N, V, C>) -> Result<T, Damage>,
) -> Result<T, D::Error>
where
    G: Geometry<N, Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    let saved = ReadTriangulation::<G::Point, V, C>::deserialize(deserializer)?;
    saved.restore().and_then(finish).map_err(D::Error::custom)
}

impl<G, const N: usize, V: Serialize, C> Serialize for Basic<G, N, V, C>
where
    G: Geometry<N, Point: Serialize>,
    C: Serialize + Copy + Default,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.save().serialize(serializer)
    }
}

impl<'de, G, const N: usize, V, C> Deserialize<'de> for Basic<G, N, V, C>
where
    G: Geometry<N, Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer, |inner| {
            inner.has_no_hidden_points().map(|()| Basic { inner })
        })
    }
}

impl<G, const N: usize, V: Serialize, C> Serialize for Delaunay<G, N, V, C>
where
    G: Geometry<N, Point: Serialize>,
    C: Serialize + Copy + Default,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.inner.save().serialize(serializer)
    }
}

impl<'de, G, const N: usize, V, C> Deserialize<'de> for Delaunay<G, N, V, C>
where
    G: Geometry<N, Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer, |inner| {
            inner.has_no_hidden_points()?;
            let t = Delaunay { inner };
            first(t.check(Level::Law)).map(|()| t)
        })
    }
}

impl<G, const N: usize, V: Serialize, C> Serialize for Regular<G, N, V, C>
where
    G: Geometry<N, Point: Serialize>,
    C: Serialize + Copy + Default,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.save().serialize(serializer)
    }
}

impl<'de, G, const N: usize, V, C> Deserialize<'de> for Regular<G, N, V, C>
where
    G: Geometry<N, Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer, |inner| {
            first(inner.flaws(Level::Law, |_, _| true))?;
            let seen = inner.vertex_count();
            let t = Regular::with_hidden(inner);
            if t.vertex_count() != seen {
                return Err(Damage::Shape(
                    "a vertex is in no cell, and nothing hides it",
                ));
            }
            first(t.check(Level::Law)).map(|()| t)
        })
    }
}

impl<G: Geometry<3, Point: Serialize>, V: Serialize, C: Serialize + Copy + Default> Serialize
    for Constrained<G, V, C>
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.save().serialize(serializer)
    }
}

impl<'de, G, V, C> Deserialize<'de> for Constrained<G, V, C>
where
    G: Geometry<3, Point: Deserialize<'de>> + Default,
    V: Deserialize<'de>,
    C: Deserialize<'de> + Copy + Default,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer, |inner| {
            inner.has_no_hidden_points()?;
            inner.constrains_edges_only()?;
            let t = Constrained {
                inner,
                buffers: TraceBuffers::default(),
            };
            first(t.check(Level::Law)).map(|()| t)
        })
    }
}
