//! Checks that the same set in another order, some lines backwards, gives the same triangulation.

use std::collections::BTreeSet;

use super::Verdict;
use crate::case::{Case, Point};
use crate::random::Random;
use crate::subject::{Built, build};

/// A position as a key that can be compared: zeros have one sign.
type Key = [u64; 2];

fn key(p: &Point) -> Key {
    p.map(|x| (x + 0.0).to_bits())
}

fn triangles(built: &Built) -> BTreeSet<Vec<Key>> {
    let t = &built.triangulation;
    let corners = |cell| t.tds().cell_vertices(cell).iter().map(|&v| key(t.point(v)));
    let sorted = |cell| {
        let mut corners: Vec<Key> = corners(cell).collect();
        corners.sort_unstable();
        corners
    };
    t.finite_cells().map(sorted).collect()
}

fn constrained_edges(built: &Built) -> BTreeSet<[Key; 2]> {
    let t = &built.triangulation;
    let sorted = |[a, b]: [Key; 2]| if a < b { [a, b] } else { [b, a] };
    t.constrained_edges()
        .map(|edge| sorted(edge.map(|v| key(t.point(v)))))
        .collect()
}

fn chain(built: &Built, line: usize) -> Vec<Key> {
    built.chains[line]
        .iter()
        .map(|&v| key(built.triangulation.point(v)))
        .collect()
}

/// Returns the case in another order, the old number of each of its lines, and for each old line
/// whether it runs backwards.
fn shuffled(case: &Case, random: &mut Random) -> (Case, Vec<usize>, Vec<bool>) {
    let mut points: Vec<usize> = (0..case.points.len()).collect();
    let mut lines: Vec<usize> = (0..case.lines.len()).collect();
    random.shuffle(&mut points);
    random.shuffle(&mut lines);
    let mut position = vec![0; points.len()];
    points
        .iter()
        .enumerate()
        .for_each(|(new, &old)| position[old] = new as u32);
    let turned: Vec<bool> = case.lines.iter().map(|_| random.below(2) == 0).collect();
    let line = |&old: &usize| {
        let mut line: Vec<u32> = case.lines[old]
            .iter()
            .map(|&i| position[i as usize])
            .collect();
        if turned[old] {
            line.reverse();
        }
        line
    };
    let other = Case {
        points: points.iter().map(|&i| case.points[i]).collect(),
        lines: lines.iter().map(line).collect(),
    };
    (other, lines, turned)
}

pub(crate) fn judge(case: &Case, built: &Built, random: &mut Random) -> Verdict {
    let (other_case, lines, turned) = shuffled(case, random);
    let other = build(&other_case)
        .map_err(|refused| format!("order: refused in another order: {refused}"))?;
    if constrained_edges(&other) != constrained_edges(built) {
        return Err("order: different constrained edges".to_owned());
    }
    for (new, &old) in lines.iter().enumerate() {
        let mut expected = chain(built, old);
        if turned[old] {
            expected.reverse();
        }
        if chain(&other, new) != expected {
            return Err(format!("order: different chain for line {old}"));
        }
    }
    if triangles(&other) != triangles(built) {
        return Err("order: different triangles".to_owned());
    }
    Ok(())
}
