//! Faces under construction: edges are numbered, and the slots for neighbors hold the twin of an
//! edge.

use std::num::NonZeroU32;

use crate::geometry::Coordinates;
use crate::tds::{CellId, Links, VertexId};

use super::filter::PlanePredicates;
use super::grain::Grain;
use super::order::Keys;

/// The edge of a face from the vertex in a slot to the next one, as the number
/// `4 * face + slot + 1`.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Edge(NonZeroU32);

impl Edge {
    #[inline(always)]
    pub(super) fn new(face: u32, slot: usize) -> Self {
        const SLOTS: [NonZeroU32; 3] = [
            NonZeroU32::MIN,
            NonZeroU32::new(2).unwrap(),
            NonZeroU32::new(3).unwrap(),
        ];
        Edge(SLOTS[slot] | face << 2)
    }

    #[inline(always)]
    pub(super) fn face(self) -> u32 {
        self.0.get() >> 2
    }

    #[inline(always)]
    pub(super) fn slot(self) -> usize {
        (self.0.get() as usize & 3).wrapping_sub(1)
    }

    /// Returns the slot of the next edge of the face.
    ///
    /// `PERF:` a table in a constant. The compiler turns `if slot == 2 { 0 } else { slot + 1 }`
    /// into a branch, which is two mispredictions a point.
    #[inline(always)]
    pub(super) fn next_slot(self) -> usize {
        (0b00_10_01_00 >> (2 * (self.0.get() & 3)) & 3) as usize
    }

    /// Returns the slot of the previous edge, which is also that of the vertex opposite.
    #[inline(always)]
    pub(super) fn previous_slot(self) -> usize {
        (0b01_00_10_00 >> (2 * (self.0.get() & 3)) & 3) as usize
    }

    /// Returns the edge as the slots for neighbors store it.
    #[inline(always)]
    fn kept(self) -> CellId {
        CellId::from_stored(self.0)
    }

    /// Returns the edge that a slot for neighbors stores.
    #[inline(always)]
    pub(super) fn of(kept: CellId) -> Self {
        Edge(kept.stored())
    }
}

/// The faces of a range of points, and what is needed to build them.
///
/// `PERF:` indexes are checked. Without the checks there are 7 % fewer instructions, and no
/// difference in time beyond the noise (183 against 185 ns a point of 100 000).
pub(super) struct Range<'a, G: Coordinates<N>, const N: usize, const FILTERED: bool> {
    pub(super) predicates: &'a PlanePredicates<'a, G, N, FILTERED>,
    /// Keys of the points from number `first` on.
    pub(super) keys: &'a Keys,
    pub(super) first: usize,
    /// The faces from number `offset` on.
    pub(super) faces: &'a mut [Links<3>],
    pub(super) offset: usize,
    pub(super) grain: Grain<'a>,
    /// The number of ranges with equal keys around this one.
    pub(super) nesting: usize,
}

impl<G: Coordinates<N>, const N: usize, const FILTERED: bool> Range<'_, G, N, FILTERED> {
    #[inline(always)]
    pub(super) fn face(&self, face: u32) -> &Links<3> {
        &self.faces[(face as usize).wrapping_sub(self.offset)]
    }

    #[inline(always)]
    pub(super) fn face_mut(&mut self, face: u32) -> &mut Links<3> {
        &mut self.faces[(face as usize).wrapping_sub(self.offset)]
    }

    #[inline(always)]
    pub(super) fn vertex(&self, face: u32, slot: usize) -> VertexId {
        self.face(face).vertices[slot]
    }

    /// Returns the same edge as the face on its other side has it.
    #[inline(always)]
    pub(super) fn twin(&self, face: u32, slot: usize) -> Edge {
        Edge::of(self.face(face).neighbors[slot])
    }

    /// Returns the vertex opposite an edge in its face.
    #[inline(always)]
    pub(super) fn opposite(&self, edge: Edge) -> VertexId {
        self.vertex(edge.face(), edge.previous_slot())
    }

    /// Makes two edges twins, each given by face and slot.
    #[inline(always)]
    pub(super) fn link(&mut self, a: (u32, usize), b: (u32, usize)) {
        self.face_mut(a.0).neighbors[a.1] = Edge::new(b.0, b.1).kept();
        self.face_mut(b.0).neighbors[b.1] = Edge::new(a.0, a.1).kept();
    }

    /// Makes an edge, given by face and slot, the twin of another one.
    #[inline(always)]
    pub(super) fn link_to(&mut self, a: (u32, usize), edge: Edge) {
        self.face_mut(a.0).neighbors[a.1] = edge.kept();
        self.face_mut(edge.face()).neighbors[edge.slot()] = Edge::new(a.0, a.1).kept();
    }
}
