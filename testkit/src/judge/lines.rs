//! Checks that the constrained edges are the chains of the lines, and the chains follow the lines.

use std::collections::HashSet;

use super::Verdict;
use super::scene::{Number, Scene, magnitude};

/// Returns an error unless:
///
/// - A chain visits the points of its line, in order, and its steps are constrained edges.
/// - Between two of those, its vertices lie within the bound of the given segment: the segment
///   meets the box around each. It is monotone on each axis.
/// - It visits all input points that lie exactly on the segment.
/// - All constrained edges are steps of chains.
pub(crate) fn judge<N: Number>(scene: &Scene<N>) -> Verdict {
    let mut by_x: Vec<usize> = scene.vertices.clone();
    by_x.sort_by(|&a, &b| scene.sites[a][0].cmp(&scene.sites[b][0]));
    by_x.dedup();
    let mut steps = HashSet::with_capacity(scene.constrained.len());
    for (k, chain) in scene.chains.iter().enumerate() {
        for (ends, part) in parts(scene, k)? {
            judge_part(scene, ends, part, &by_x).map_err(|what| format!("line {k}: {what}"))?;
        }
        steps.extend(
            chain
                .windows(2)
                .map(|step| [step[0].min(step[1]), step[0].max(step[1])]),
        );
    }
    if scene.is_collinear {
        return Ok(()); // without triangles no edge can be one of a constraint
    }
    if let Some([a, b]) = steps.difference(&scene.constrained).next() {
        return Err(format!(
            "missing edge: {} to {} is not constrained",
            scene.name(*a),
            scene.name(*b)
        ));
    }
    if let Some([a, b]) = scene.constrained.difference(&steps).next() {
        return Err(format!(
            "stray edge: {} to {} is constrained by no line",
            scene.name(*a),
            scene.name(*b)
        ));
    }
    Ok(())
}

/// Returns the parts of a chain between the vertices of its line. The chain must consist of them. A
/// vertex that is repeated counts once.
#[expect(clippy::type_complexity)]
pub(crate) fn parts<'a, N: Number>(
    scene: &'a Scene<N>,
    line: usize,
) -> Result<Vec<([usize; 2], &'a [usize])>, String> {
    let chain = &scene.chains[line][..];
    let mut stops: Vec<usize> = scene.case.lines[line]
        .iter()
        .map(|&i| scene.vertices[i as usize])
        .collect();
    stops.dedup();
    if chain.first() != stops.first() {
        return Err(format!(
            "line {line}: chain begins at {:?}, not {:?}",
            chain.first(),
            stops.first()
        ));
    }
    let mut at = 0;
    let mut parts = Vec::with_capacity(stops.len());
    for ends in stops.windows(2) {
        let Some(steps) = chain[at + 1..].iter().position(|&v| v == ends[1]) else {
            return Err(format!(
                "line {line}: chain does not reach {}",
                scene.name(ends[1])
            ));
        };
        parts.push(([ends[0], ends[1]], &chain[at..=at + 1 + steps]));
        at += 1 + steps;
    }
    if at + 1 < chain.len() {
        return Err(format!("line {line}: chain goes on beyond the last point"));
    }
    Ok(parts)
}

fn judge_part<N: Number>(
    scene: &Scene<N>,
    [a, b]: [usize; 2],
    part: &[usize],
    by_x: &[usize],
) -> Verdict {
    for &v in &part[1..part.len() - 1] {
        if !is_beside(scene, v, [a, b]) {
            return Err(format!(
                "too far: {} from {} - {}",
                scene.name(v),
                scene.name(a),
                scene.name(b)
            ));
        }
    }
    let vector = scene.difference(a, b);
    for step in part.windows(2) {
        let step_vector = scene.difference(step[0], step[1]);
        for (axis, ahead) in step_vector.into_iter().enumerate() {
            let limit = scene.back[axis].clone();
            let backward = match vector[axis].cmp(&N::from(0)) {
                std::cmp::Ordering::Greater => -ahead,
                std::cmp::Ordering::Less => ahead,
                std::cmp::Ordering::Equal => magnitude(ahead),
            };
            if backward > limit {
                return Err(format!(
                    "goes back: from {} to {}",
                    scene.name(step[0]),
                    scene.name(step[1])
                ));
            }
        }
    }
    let visited: HashSet<usize> = part.iter().copied().collect();
    if visited.len() < part.len() {
        return Err(format!(
            "visits a vertex twice between {} and {}",
            scene.name(a),
            scene.name(b)
        ));
    }
    let [low, high] = if scene.sites[a][0] < scene.sites[b][0] {
        [a, b]
    } else {
        [b, a]
    };
    let first = by_x.partition_point(|&v| scene.sites[v][0] < scene.sites[low][0]);
    let none = [N::from(0), N::from(0)];
    let near = by_x[first..]
        .iter()
        .take_while(|&&v| scene.sites[v][0] <= scene.sites[high][0]);
    for &v in near.filter(|v| !visited.contains(v)) {
        if scene.is_within(v, [a, b], &none) && scene.turn(a, b, v) == N::from(0) {
            return Err(format!(
                "passes by: {} lies on {} - {}",
                scene.name(v),
                scene.name(a),
                scene.name(b)
            ));
        }
    }
    Ok(())
}

/// Returns true if the closed box around the vertex meets the segment: if they are disjoint, they
/// are separated along an axis or along the segment's normal.
fn is_beside<N: Number>(scene: &Scene<N>, v: usize, [a, b]: [usize; 2]) -> bool {
    let [dx, dy] = scene.difference(a, b).map(magnitude);
    let [bx, by] = scene.bound.clone();
    scene.is_within(v, [a, b], &scene.bound) && magnitude(scene.turn(a, b, v)) <= dx * by + dy * bx
}
