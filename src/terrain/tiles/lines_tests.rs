//! Tiles with lines, against the constrained triangulation in one piece.

use super::tests::{Triangle, canonical, count, tiled};
use super::*;
use crate::data::EdgeKind;
use crate::triangulation::geometry::{Geometry, Plane};
use crate::triangulation::num::Sign;
use crate::triangulation::{ConstrainedDelaunay2, OnCrossing};
use testkit::random::Random;

const KINDS: [EdgeKind; 4] = [EdgeKind::Breakline, EdgeKind::Soft, EdgeKind::Wall, EdgeKind::Clip];

/// The constrained triangulation of all points and lines, whose ends are points.
fn whole(points: &[[f64; 3]], constraints: &[SubConstraint]) -> Vec<Triangle> {
    let sites: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
    let number = |end: [f64; 2]| sites.iter().position(|&site| site == end).unwrap() as u32;
    let lines: Vec<[u32; 2]> = constraints.iter().map(|constraint| constraint.ends.map(number)).collect();
    let (t, _) = ConstrainedDelaunay2::from_lines(Plane::default(), &sites, &lines, OnCrossing::Reject).unwrap();
    if t.dimension() < 2 {
        return Vec::new();
    }
    let kind = |[a, b]: [_; 2]| {
        let kinds = t.lines_through(a, b).map(|line| constraints[line.index()].kind);
        kinds.min_by_key(|kind| kind.rank()).unwrap_or_default()
    };
    let of_cell = |cell| {
        let edges = [0, 1, 2].map(|i| kind(t.tds().edge_ends(cell, i)));
        canonical(t.tds().corners(cell).map(|v| *t.point(v)), edges)
    };
    let mut triangles: Vec<Triangle> = t.finite_cells().map(of_cell).collect();
    triangles.sort_unstable();
    triangles
}

/// Returns true if two segments cross between their ends, exactly.
fn cross(s: &SubConstraint, t: &SubConstraint) -> bool {
    let plane: Plane = Plane::default();
    let are_apart = |s: &SubConstraint, t: &SubConstraint| {
        let [a, b] = t.ends.map(|end| plane.orientation([&s.ends[0], &s.ends[1], &end]));
        a != Sign::Zero && b != Sign::Zero && a != b
    };
    are_apart(s, t) && are_apart(t, s)
}

/// A set of points and lines on a small grid, and where it is cut.
struct Case {
    points: Vec<[f64; 3]>,
    constraints: Vec<SubConstraint>,
    cuts: [Vec<f64>; 2],
    fan: usize,
}

impl Case {
    fn of(round: usize, random: &mut Random) -> Self {
        let side = [3, 6, 12, 40][round % 4];
        let far = [0.0, 1e6, -0.3][round % 3];
        let scale = [1.0, 0.1, 1e-3][round / 4 % 3];
        let at = |steps: f64| far + scale * steps;
        // Through points, and beside them; some tiles are empty, some one point thick.
        let mut cuts = [0, 1].map(|_| {
            (0..random.below(5))
                .map(|_| at(random.below(2 * side + 2) as f64 * 0.5 - 0.25 * random.below(2) as f64))
                .collect::<Vec<f64>>()
        });
        for cuts in &mut cuts {
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
        }
        let site = |random: &mut Random| [0, 1].map(|_| at(random.below(side + 1) as f64));
        let mut sites: Vec<[f64; 2]> = (0..round % 60).map(|_| site(random)).collect();
        if round % 10 == 0 {
            sites.iter_mut().for_each(|site| site[1] = far); // on a line
        }
        let mut constraints: Vec<SubConstraint> = Vec::new();
        let most = [2, 8, 30][round / 2 % 3];
        for _ in 0..random.below(most) + 1 {
            let mut ends = [site(random), site(random)];
            let axis = random.index(2);
            match random.below(8) {
                // Along a cut, or up to it.
                0 if !cuts[axis].is_empty() => {
                    let cut = cuts[axis][random.index(cuts[axis].len())];
                    ends.iter_mut().for_each(|end| end[axis] = cut);
                }
                1 if !cuts[axis].is_empty() => ends[1][axis] = cuts[axis][random.index(cuts[axis].len())],
                // A chain, straight or not.
                2 | 3 if !constraints.is_empty() => {
                    let [a, b] = constraints[random.index(constraints.len())].ends;
                    ends[0] = b;
                    if random.below(2) == 0 {
                        ends[1] = [2.0 * b[0] - a[0], 2.0 * b[1] - a[1]];
                    }
                }
                // Between points that others use.
                4 | 5 if !sites.is_empty() => ends = [0, 1].map(|_| sites[random.index(sites.len())]),
                _ => {}
            }
            let constraint = SubConstraint { ends, kind: KINDS[random.index(KINDS.len())] };
            if ends[0] != ends[1] && constraints.iter().all(|other| !cross(other, &constraint)) {
                sites.extend(ends);
                constraints.push(constraint);
            }
        }
        for k in (1..sites.len()).rev() {
            sites.swap(k, random.index(k + 1));
        }
        let points = sites.iter().map(|p| [p[0], p[1], p[0]]).collect();
        Case { points, constraints, cuts, fan: 2 + round % 3 }
    }

    fn found(&self) -> (Vec<Triangle>, usize) {
        tiled(&self.points, &self.constraints, self.cuts.each_ref().map(|cuts| &cuts[..]), self.fan)
    }
}

#[test]
fn tiles_with_lines_give_the_triangles_of_the_whole() {
    let mut random = Random(17);
    let mut held = 0;
    for round in 0..count() {
        let case = Case::of(round, &mut random);
        let Case { points, constraints, cuts, fan } = &case;
        let expected = whole(points, constraints);
        held += usize::from(expected != whole(points, &[]));
        let (found, _) = case.found();
        assert_eq!(found, expected, "round {round}: {points:?}, {constraints:?}, cut at {cuts:?}, fan {fan}");
    }
    assert!(held > count() / 2, "lines matter in {held} sets only");
}
