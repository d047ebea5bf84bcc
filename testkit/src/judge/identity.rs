//! Checks that the triangulation knows which vertices it added and which lines run along an edge.

use std::collections::{BTreeSet, HashMap, HashSet};

use breakline_triangulation::tds::VertexId;

use super::Verdict;
use crate::subject::Built;

pub(crate) fn judge(built: &Built) -> Verdict {
    let t = &built.triangulation;
    let given: HashSet<VertexId> = built.vertices.iter().copied().collect();
    if let Some(v) = t
        .tds()
        .vertices()
        .find(|v| t.is_added(*v) == given.contains(v))
    {
        return Err(format!(
            "identity: whether vertex {} was added is reported wrongly",
            v.index()
        ));
    }
    let mut lines: HashMap<[VertexId; 2], BTreeSet<usize>> = HashMap::new();
    for (line, chain) in built.chains.iter().enumerate() {
        for step in chain.windows(2) {
            lines
                .entry([step[0].min(step[1]), step[0].max(step[1])])
                .or_default()
                .insert(line);
        }
    }
    for ([a, b], expected) in lines {
        let ids: Vec<usize> = t.lines_through(b, a).map(|line| line.index()).collect();
        if !ids.iter().eq(&expected) {
            return Err(format!(
                "identity: lines {ids:?} run from {} to {}, should be {expected:?}",
                a.index(),
                b.index()
            ));
        }
    }
    Ok(())
}
