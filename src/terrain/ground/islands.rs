//! Large roofs: level ground whose rim drops everywhere.

use super::graph::Graph;
use super::parts::Parts;
use super::recipe::Recipe;

/// Calls those parts of the ground objects that stand above all that is around them.
///
/// A part hangs together without steps of half of [`Recipe::drop`]. It is an object if nine tenths
/// of its border are steps down by the whole; steps up to objects do not count, the rim of the
/// raster counts as no step. So roofs are found that are wider than the widest window.
pub(super) fn remove(objects: &mut [bool], graph: &Graph, heights: &[f32], recipe: &Recipe) {
    let drop = recipe.drop as f32;
    let mut parts = Parts::of(objects.len());
    let pairs = || {
        graph
            .neighbors
            .iter()
            .map(|pair| (pair.nodes, i64::from(pair.faces)))
    };
    for (nodes, _) in pairs() {
        let [a, b] = nodes.map(|node| node as usize);
        if !objects[a] && !objects[b] && (heights[a] - heights[b]).abs() < 0.5 * drop {
            parts.join(nodes);
        }
    }
    // Faces of the border that step down, and others.
    let mut borders = vec![[0i64; 2]; objects.len()];
    for (nodes, faces) in pairs() {
        for [inner, outer] in [nodes, [nodes[1], nodes[0]]] {
            if objects[inner as usize] || parts.root(inner) == parts.root(outer) {
                continue;
            }
            let rise = heights[outer as usize] - heights[inner as usize];
            let border = &mut borders[parts.root(inner) as usize];
            if rise <= -drop {
                border[0] += faces;
            } else if !objects[outer as usize] || rise < 0.5 * drop {
                border[1] += faces;
            }
        }
    }
    for node in 0..objects.len() {
        borders[parts.root(node as u32) as usize][1] += i64::from(graph.rims[node]);
    }
    for node in 0..objects.len() {
        let [down, other] = borders[parts.root(node as u32) as usize];
        objects[node] |= down > 9 * other;
    }
}
