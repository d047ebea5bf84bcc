//! From a triangulation to the contents of Triangle's files: numbers of vertices, attributes,
//! boundary markers.

use rustc_hash::FxHashMap;

use super::between::Between;
use super::build::Built;
use crate::io::triangle::{Edge, LineGraph, Nodes, Triangulated};

/// Returns the kept triangles with their vertices, edges, segments, attributes and markers.
pub(super) fn assemble(
    graph: &LineGraph,
    built: &Built,
    is_kept: &[bool],
    attributes: &[f64],
) -> Triangulated {
    let mut nodes = graph.nodes.clone();
    let node_of = number_nodes(graph, built, &mut nodes);
    let markers = segment_markers(graph, built);
    let marker_of = |ends: [u32; 2]| markers.get(&sorted(ends)).copied().unwrap_or(0);

    let mut new_number = vec![None; is_kept.len()];
    let kept = (0..is_kept.len()).filter(|&face| is_kept[face]);
    for (new, face) in (0u32..).zip(kept.clone()) {
        new_number[face] = Some(new);
    }
    let count = kept.clone().count();
    let mut triangulated = Triangulated {
        triangles: Vec::with_capacity(count),
        neighbors: Vec::with_capacity(count),
        // Three for each two triangles, and a few.
        edges: Vec::with_capacity(2 * count),
        holes: graph.holes.clone(),
        regions: graph.regions.clone(),
        ..Default::default()
    };
    let mut rim = Vec::new();
    for face in kept {
        let this = &built.faces[face];
        let neighbors = this
            .neighbors
            .map(|beside| beside.and_then(|beside| new_number[beside as usize]));
        triangulated
            .triangles
            .push(this.corners.map(|v| node_of[v as usize]));
        triangulated.neighbors.push(neighbors);
        triangulated.attributes.extend(attributes.get(face));
        for (i, beside) in neighbors.into_iter().enumerate() {
            if beside.is_some_and(|beside| Some(beside) < new_number[face]) {
                continue; // listed from the other side
            }
            let ends = [this.corners[(i + 1) % 3], this.corners[(i + 2) % 3]];
            let mut edge = Edge {
                ends: ends.map(|v| node_of[v as usize]),
                marker: marker_of(ends),
            };
            if beside.is_none() {
                rim.extend(edge.ends);
                edge.marker = if edge.marker == 0 { 1 } else { edge.marker };
            }
            triangulated.edges.push(edge);
            if this.is_constrained[i] || beside.is_none() {
                triangulated.segments.push(edge);
            }
        }
    }
    if built.faces.is_empty() {
        triangulated.segments = collinear_segments(built, &node_of, &marker_of);
    }

    // The vertex's own marker comes first, then that of a segment, then 1 on the rim.
    for (segment, chain) in graph.segments.iter().zip(&built.chains) {
        for &v in chain {
            set_if_zero(
                &mut nodes.markers[node_of[v as usize] as usize],
                segment.marker,
            );
        }
    }
    rim.into_iter()
        .for_each(|node| set_if_zero(&mut nodes.markers[node as usize], 1));
    triangulated.nodes = nodes;
    triangulated
}

/// Returns the number of each vertex's node; of points at the same position, the first counts. Adds
/// nodes for vertices that are not points of the input, with attributes interpolated on the first
/// segment through them.
fn number_nodes(graph: &LineGraph, built: &Built, nodes: &mut Nodes) -> Vec<u32> {
    let mut node_of = vec![None; built.vertices.len()];
    for (node, &vertex) in (0u32..).zip(&built.vertex_of) {
        node_of[vertex as usize].get_or_insert(node);
    }
    let mut segment_of = vec![None; built.vertices.len()];
    for (segment, chain) in graph.segments.iter().zip(&built.chains) {
        chain
            .iter()
            .for_each(|&vertex| _ = segment_of[vertex as usize].get_or_insert(segment));
    }
    let mut between = built.between.iter().peekable();
    let mut numbered = Vec::with_capacity(node_of.len());
    for (vertex, node) in node_of.into_iter().enumerate() {
        numbered.push(node.unwrap_or_else(|| {
            let at = built.vertices[vertex];
            let within = between.next_if(|within| within.vertex == vertex as u32);
            if let Some(segment) = segment_of[vertex] {
                add_attributes_between(nodes, segment.ends.map(|end| end as usize), at);
            } else {
                // The corners were there before, so that they have smaller numbers.
                add_attributes_within(nodes, within, |corner| numbered[corner as usize]);
            }
            nodes.points.push(at);
            nodes.markers.push(0);
            nodes.points.len() as u32 - 1
        }));
    }
    numbered
}

/// Adds the attributes of an added vertex, linear in the triangle that contained it before.
fn add_attributes_within(
    nodes: &mut Nodes,
    within: Option<&Between<u32>>,
    node_of: impl Fn(u32) -> u32,
) {
    let (count, start) = (nodes.attribute_count, nodes.attributes.len());
    nodes.attributes.resize(start + count, 0.0);
    let (given, added) = nodes.attributes.split_at_mut(start);
    for (corner, weight) in within.iter().flat_map(|b| b.corners.iter().zip(b.weights)) {
        let values = &given[node_of(*corner) as usize * count..][..count];
        added
            .iter_mut()
            .zip(values)
            .for_each(|(sum, value)| *sum += weight * value);
    }
}

/// Adds the attributes at a position between two vertices, linear in the distance.
fn add_attributes_between(nodes: &mut Nodes, [a, b]: [usize; 2], at: [f64; 2]) {
    let (from, to) = (nodes.points[a], nodes.points[b]);
    // Halves, so that no difference is larger than a double can hold.
    let half = [0, 1].map(|axis| to[axis] / 2.0 - from[axis] / 2.0);
    let axis = usize::from(half[1].abs() > half[0].abs());
    let along = ((at[axis] / 2.0 - from[axis] / 2.0) / half[axis]).clamp(0.0, 1.0);
    for k in 0..nodes.attribute_count {
        let [from, to] = [a, b].map(|end| nodes.attributes[end * nodes.attribute_count + k]);
        nodes.attributes.push(if from == to {
            from
        } else {
            from * (1.0 - along) + to * along
        });
    }
}

/// Returns the marker of each constrained edge: that of the first segment through it that has one.
fn segment_markers(graph: &LineGraph, built: &Built) -> FxHashMap<[u32; 2], i32> {
    let mut markers = FxHashMap::default();
    for (segment, chain) in graph
        .segments
        .iter()
        .zip(&built.chains)
        .filter(|(segment, _)| segment.marker != 0)
    {
        for pair in chain.windows(2) {
            markers
                .entry(sorted([pair[0], pair[1]]))
                .or_insert(segment.marker);
        }
    }
    markers
}

/// Returns the segments of a triangulation without triangles; each constrained edge once.
fn collinear_segments(
    built: &Built,
    node_of: &[u32],
    marker_of: &impl Fn([u32; 2]) -> i32,
) -> Vec<Edge> {
    let mut sub_constraints: Vec<[u32; 2]> = built
        .chains
        .iter()
        .flat_map(|chain| chain.windows(2).map(|pair| sorted([pair[0], pair[1]])))
        .collect();
    sub_constraints.sort_unstable();
    sub_constraints.dedup();
    let edge = |ends: [u32; 2]| Edge {
        ends: ends.map(|v| node_of[v as usize]),
        marker: marker_of(ends),
    };
    sub_constraints.into_iter().map(edge).collect()
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn set_if_zero(marker: &mut i32, value: i32) {
    if *marker == 0 {
        *marker = value;
    }
}
