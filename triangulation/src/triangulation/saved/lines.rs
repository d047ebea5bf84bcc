//! Constrained Delaunay triangulations, with their lines: beside the triangulation, the tables that tell the ways of
//! lines, and which vertices came with lines or were added where they cross.
//!
//! *What is checked.* Constraints stand on both sides of an edge, and the law holds between them. Every line's way from
//! one of its vertices to the next ends there, meets no vertex twice, and consists of constrained edges; where it bends,
//! it runs in order on both axes. The tables hold nothing that is on no way. Added vertices lie on constraints, and
//! were not given with a line.
//!
//! Not checked is what would take the arrangement of all lines: whether a way is the one that the rounding of the
//! crossings asks for. The next edit that arranges the lines makes it so.

use rustc_hash::{FxHashMap, FxHashSet};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::geometry::Crossing;
use crate::tds::VertexId;

use super::super::lines::constrain::Scratch;
use super::super::lines::paths::{Lines, segments_of, undirected};
use super::super::{ConstrainedDelaunay, Level, LineId, Rounding, Walls};
use super::{Damage, Owned, first};

/// What is saved. Vertices are told by their numbers.
#[derive(Serialize, Deserialize)]
struct WithLines<T> {
    triangulation: T,
    /// By their ids: the vertices that each was given by; `None` where a line has been removed.
    lines: Vec<Option<Vec<u32>>>,
    /// Segments of lines that are led through sites, from the smaller end through all of them to the larger.
    led: Vec<Vec<u32>>,
    /// Pieces of ways that were split: the smaller end, the larger, and the vertex between.
    splits: Vec<[u32; 3]>,
    /// Constraints among collinear points.
    waiting: Vec<[u32; 2]>,
    /// Vertices that were added where lines cross, in order.
    added: Vec<u32>,
    /// Vertices that go with the last of their lines, in order.
    lent: Vec<u32>,
    rounding: Option<Rounding>,
    was_tangled: bool,
}

fn number(v: &VertexId) -> u32 {
    v.index() as u32
}

impl<G: Crossing, V, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// The segments of all lines, each once, from the smaller vertex to the larger.
    fn segments(&self) -> Vec<[VertexId; 2]> {
        let segments = segments_of(self.lines.each(), |v| number(&v));
        segments.into_iter().map(|ends| ends.map(|i| VertexId::new(i as usize))).collect()
    }

    /// The sites that a segment is led through, its ends with them.
    fn led(&self, [a, b]: [VertexId; 2]) -> Vec<VertexId> {
        let between = self.lines.led.get(&[a, b]).into_iter().flatten().copied();
        [a].into_iter().chain(between).chain([b]).collect()
    }

    /// Whether the ways of all segments lead over constraints to their ends, and nothing else is in the tables.
    fn check_ways(&self, segments: &[[VertexId; 2]], constraints: &FxHashSet<[VertexId; 2]>) -> Result<(), Damage> {
        let mut splits: FxHashSet<[VertexId; 2]> = FxHashSet::default();
        let mut led = 0;
        for &ends in segments {
            led += usize::from(self.lines.led.contains_key(&ends));
            let sites = self.led(ends);
            let mut met: FxHashSet<VertexId> = sites.iter().copied().collect();
            let is_in_order = sites.windows(2).all(|pair| self.runs_along(ends, [pair[0], pair[1]]));
            if met.len() < sites.len() || !is_in_order {
                return Err(Damage::Shape("the sites of a line's segment are not in order"));
            }
            let mut pieces: Vec<[VertexId; 2]> = sites.windows(2).map(|pair| undirected(pair[0], pair[1])).collect();
            while let Some(piece) = pieces.pop() {
                match self.lines.splits.get(&piece) {
                    Some(&between) if met.insert(between) => {
                        splits.insert(piece);
                        pieces.extend(piece.map(|end| undirected(end, between)));
                    }
                    Some(_) => return Err(Damage::Shape("the way of a line's segment meets a vertex twice")),
                    None if constraints.contains(&piece) => {}
                    None => return Err(Damage::Shape("the way of a line's segment is not constrained")),
                }
            }
        }
        match (led, splits.len()) == (self.lines.led.len(), self.lines.splits.len()) {
            true => Ok(()),
            false => Err(Damage::Shape("what is told of a segment belongs to no line")),
        }
    }

    /// Whether a piece runs no other way than a segment, on either axis.
    fn runs_along(&self, segment: [VertexId; 2], piece: [VertexId; 2]) -> bool {
        let [[a, b], [p, q]] = [segment, piece].map(|ends| ends.map(|v| self.inner.geometry.plan(self.point(v))));
        (0..2).all(|axis| p[axis] == q[axis] || (p[axis] < q[axis]) == (a[axis] < b[axis]) && a[axis] != b[axis])
    }

    /// Whether what is told of the rounding can be.
    fn check_rounding(&self, segments: &[[VertexId; 2]]) -> Result<(), Damage> {
        let on_grid = self.rounding.is_some_and(|rounding| rounding.on_grid);
        if self.was_tangled && (on_grid || self.rounding.is_none()) {
            return Err(Damage::Shape("lines cannot have crossed after rounding"));
        }
        let Some(Rounding { unit, .. }) = self.rounding else { return Ok(()) };
        let is_power_of_two = |x: f64| {
            let bits = x.to_bits();
            x > 0.0 && x.is_finite() && (bits.trailing_zeros() >= 52 || bits.is_power_of_two())
        };
        let is_multiple = |v: VertexId| {
            let place = self.inner.geometry.plan(self.point(v));
            (0..2).all(|axis| place[axis] % unit[axis] == 0.0)
        };
        let mut sites = segments.iter().flat_map(|&ends| self.led(ends));
        match unit.into_iter().all(is_power_of_two) && (!on_grid || sites.all(is_multiple)) {
            true => Ok(()),
            false => Err(Damage::Shape("the unit of the grid does not fit")),
        }
    }

    /// Everything that lines ask for beyond the law of the triangulation.
    fn check_lines(&self) -> Result<(), Damage> {
        let constraints: FxHashSet<[VertexId; 2]> = match self.dimension() {
            2 if !self.waiting.is_empty() => return Err(Damage::Shape("a constraint waits for triangles")),
            2 => self.constrained_edges().collect(),
            _ => self.waiting.iter().map(|&[a, b]| undirected(a, b)).collect(),
        };
        let segments = self.segments();
        self.check_ways(&segments, &constraints)?;
        self.check_rounding(&segments)?;
        let named: FxHashSet<VertexId> = self.lines.each().flatten().copied().collect();
        let constrained: FxHashSet<VertexId> = constraints.into_iter().flatten().collect();
        if !self.crossings.iter().all(|v| constrained.contains(v) && !named.contains(v)) {
            return Err(Damage::Shape("lines do not cross in a vertex that was added for it"));
        }
        if !self.lent.iter().all(|v| named.contains(v)) {
            return Err(Damage::Shape("a vertex came with no line"));
        }
        Ok(())
    }
}

impl<P, V, C: Copy + Default> WithLines<Owned<P, V, Walls<C>>> {
    fn restore<G: Crossing<Point = P> + Default>(self) -> Result<ConstrainedDelaunay<G, V, C>, Damage> {
        let inner = self.triangulation.restore::<G>()?;
        inner.has_no_hidden_points()?;
        inner.has_walls_on_edges_only()?;
        first(inner.flaws(Level::Law, |cell, i| !inner.is_constrained(cell, i)))?;
        first(inner.one_sided_walls())?;
        if self.lines.len() >= LineId::LIMIT {
            return Err(Damage::Shape("there are too many lines"));
        }

        let vertex = |&number: &u32| match (number as usize) < inner.tds.vertex_slots() {
            true => Some(VertexId::new(number as usize)).filter(|&v| inner.tds.is_vertex(v)),
            false => None,
        };
        let vertices = |numbers: &[u32]| {
            let vertices: Option<Vec<VertexId>> = numbers.iter().map(vertex).collect();
            vertices.ok_or(Damage::Shape("a line names a vertex that is not there"))
        };
        let in_order = |numbers: &[u32]| match numbers.is_sorted_by(|a, b| a < b) {
            true => vertices(numbers),
            false => Err(Damage::Shape("numbers of vertices are not in order")),
        };
        let mut lines = Lines::default();
        for line in &self.lines {
            lines.given.push(line.as_deref().map(vertices).transpose()?.map(|vertices| vertices[..].into()));
        }
        for way in &self.led {
            let is_new = match vertices(way)?[..] {
                [a, ref between @ .., b] => a < b && lines.led.insert([a, b], between.into()).is_none(),
                _ => false,
            };
            is_new.then_some(()).ok_or(Damage::Shape("a segment is led twice, or the other way"))?;
        }
        for split in &self.splits {
            let is_new = match vertices(split)?[..] {
                [a, b, between] => a < b && lines.splits.insert([a, b], between).is_none(),
                _ => false,
            };
            is_new.then_some(()).ok_or(Damage::Shape("a piece is split twice, or the other way"))?;
        }
        let mut waiting = Vec::with_capacity(self.waiting.len());
        for ends in &self.waiting {
            match vertices(ends)?[..] {
                [a, b] if a != b => waiting.push([a, b]),
                _ => return Err(Damage::Shape("a constraint leads nowhere")),
            }
        }
        let t = ConstrainedDelaunay {
            waiting,
            crossings: in_order(&self.added)?,
            left_out: Vec::new(),
            lines,
            rounding: self.rounding,
            lent: in_order(&self.lent)?.into_iter().collect(),
            was_tangled: self.was_tangled,
            scratch: Scratch::default(),
            inner,
        };
        t.check_lines().map(|()| t)
    }
}

impl<G: Crossing<Point: Serialize>, V: Serialize, C: Serialize + Copy + Default> Serialize
    for ConstrainedDelaunay<G, V, C>
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = |vertices: &[VertexId]| vertices.iter().map(number).collect::<Vec<u32>>();
        let segments = self.segments();
        let mut splits = FxHashMap::default();
        for &ends in &segments {
            let sites = self.led(ends);
            sites.windows(2).for_each(|piece| self.lines.copy_splits(piece[0], piece[1], &mut splits));
        }
        let mut splits: Vec<[u32; 3]> = splits.iter().map(|([a, b], between)| [a, b, between].map(number)).collect();
        splits.sort_unstable();
        let mut lent: Vec<u32> = self.lent.iter().map(number).collect();
        lent.sort_unstable();
        let led = segments.iter().filter(|ends| self.lines.led.contains_key(*ends));
        let saved = WithLines {
            triangulation: self.save(),
            lines: self.lines.given.iter().map(|line| line.as_deref().map(numbers)).collect(),
            led: led.map(|&ends| numbers(&self.led(ends))).collect(),
            splits,
            waiting: self.waiting.iter().map(|ends| ends.each_ref().map(number)).collect(),
            added: numbers(&self.crossings),
            lent,
            rounding: self.rounding,
            was_tangled: self.was_tangled,
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
        let saved = WithLines::<Owned<G::Point, V, Walls<C>>>::deserialize(deserializer)?;
        saved.restore().map_err(D::Error::custom)
    }
}
