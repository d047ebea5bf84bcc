//! What is known of the nodes of a graph and of pairs of them.

/// Two nodes whose surroundings, the cells nearest to them, share a border.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Neighbors {
    /// The one with the lower number first.
    pub(super) nodes: [u32; 2],
    /// The sides of cells that the border consists of.
    pub(super) faces: u32,
}

/// What is known of each node.
pub(super) struct Nodes<'a> {
    /// The lowest points; heights are above a datum.
    pub(super) points: &'a [[f64; 3]],
    pub(super) heights: &'a [f32],
    /// What it costs to call a node ground or, if it is negative, to call it an object.
    pub(super) evidence: &'a [f32],
    /// How far the terrain counts as steep, from 0 to 1.
    pub(super) steep: &'a [f32],
}
