//! Tiles with lines, against the constrained triangulation in one piece.

use rustc_hash::FxHashMap;

use super::tests::{Found, Tasks, Triangle, Unchanged, canonical, count, tiled, tiled_by};
use super::*;
use crate::data::EdgeKind;
use crate::error::Result;
use crate::triangulation::geometry::{Geometry, Plane};
use crate::triangulation::num::Sign;
use crate::triangulation::{ConstrainedDelaunay2, OnCrossing};
use testkit::random::Random;

const KINDS: [EdgeKind; 4] = [
    EdgeKind::Breakline,
    EdgeKind::Soft,
    EdgeKind::Wall,
    EdgeKind::Clip,
];

/// The constrained triangulation of all points and lines, whose ends are points.
pub(super) fn whole(points: &[[f64; 3]], constraints: &[SubConstraint]) -> Vec<Triangle> {
    let sites: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
    let numbers: FxHashMap<[u64; 2], u32> = (0..)
        .zip(&sites)
        .map(|(k, site)| (site.map(f64::to_bits), k))
        .collect();
    let number = |end: [f64; 2]| numbers[&end.map(f64::to_bits)];
    let lines: Vec<[u32; 2]> = constraints
        .iter()
        .map(|constraint| constraint.ends.map(number))
        .collect();
    let (t, _) =
        ConstrainedDelaunay2::from_lines(Plane::default(), &sites, &lines, OnCrossing::Reject)
            .unwrap();
    if t.dimension() < 2 {
        return Vec::new();
    }
    let kind = |[a, b]: [_; 2]| {
        let kinds = t
            .lines_through(a, b)
            .map(|line| constraints[line.index()].kind);
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
        let [a, b] = t
            .ends
            .map(|end| plane.orientation([&s.ends[0], &s.ends[1], &end]));
        a != Sign::Zero && b != Sign::Zero && a != b
    };
    are_apart(s, t) && are_apart(t, s)
}

/// A set of points and lines on a small grid, and where it is cut.
pub(super) struct Case {
    pub points: Vec<[f64; 3]>,
    pub constraints: Vec<SubConstraint>,
    pub cuts: [Vec<f64>; 2],
    pub fan: usize,
}

impl Case {
    pub(super) fn of(round: usize, random: &mut Random) -> Self {
        let side = [3, 6, 12, 40][round % 4];
        let far = [0.0, 1e6, -0.3][round % 3];
        let scale = [1.0, 0.1, 1e-3][round / 4 % 3];
        let at = |steps: f64| far + scale * steps;
        // Through points, and beside them; some tiles are empty, some one point thick.
        let mut cuts = [0, 1].map(|_| {
            (0..random.below(5))
                .map(
                    |_| at(random.below(2 * side + 2) as f64 * 0.5 - 0.25 * random.below(2) as f64),
                )
                .collect::<Vec<f64>>()
        });
        for cuts in &mut cuts {
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
        }
        let site = |random: &mut Random| [0, 1].map(|_| at(random.below(side + 1) as f64));
        let mut sites: Vec<[f64; 2]> = (0..round % 60).map(|_| site(random)).collect();
        if round.is_multiple_of(10) {
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
                1 if !cuts[axis].is_empty() => {
                    ends[1][axis] = cuts[axis][random.index(cuts[axis].len())]
                }
                // A chain, straight or not.
                2 | 3 if !constraints.is_empty() => {
                    let [a, b] = constraints[random.index(constraints.len())].ends;
                    ends[0] = b;
                    if random.below(2) == 0 {
                        ends[1] = [2.0 * b[0] - a[0], 2.0 * b[1] - a[1]];
                    }
                }
                // Between points that others use.
                4 | 5 if !sites.is_empty() => {
                    ends = [0, 1].map(|_| sites[random.index(sites.len())])
                }
                _ => {}
            }
            let constraint = SubConstraint {
                ends,
                kind: KINDS[random.index(KINDS.len())],
            };
            if ends[0] != ends[1] && constraints.iter().all(|other| !cross(other, &constraint)) {
                sites.extend(ends);
                constraints.push(constraint);
            }
        }
        for k in (1..sites.len()).rev() {
            sites.swap(k, random.index(k + 1));
        }
        let points = sites.iter().map(|p| [p[0], p[1], p[0]]).collect();
        Case {
            points,
            constraints,
            cuts,
            fan: 2 + round % 3,
        }
    }

    pub(super) fn found(&self, tasks: &impl Tasks) -> Result<Found> {
        let cuts = self.cuts.each_ref().map(|cuts| &cuts[..]);
        tiled_by(tasks, &self.points, &self.constraints, cuts, self.fan)
    }
}

#[test]
fn tiles_with_lines_give_the_triangles_of_the_whole() {
    let mut random = Random(17);
    let mut held = 0;
    for round in 0..count() {
        let case = Case::of(round, &mut random);
        let Case {
            points,
            constraints,
            cuts,
            fan,
        } = &case;
        let expected = whole(points, constraints);
        held += usize::from(expected != whole(points, &[]));
        let found = case.found(&Unchanged).unwrap();
        assert_eq!(found.doubled, 0, "a site has two vertices");
        assert_eq!(
            found.triangles, expected,
            "round {round}: {points:?}, {constraints:?}, cut at {cuts:?}, fan {fan}"
        );
    }
    assert!(held > count() / 2, "lines matter in {held} sets only");
}

/// A fence of short segments that runs through all tiles, and a cable from end to end.
#[test]
fn few_vertices_are_handed_up_beside_lines() {
    let mut random = Random(4);
    let mut points: Vec<[f64; 3]> = (0..20_000)
        .map(|_| [random.unit(), random.unit(), 0.0])
        .collect();
    let cuts = [0.25, 0.5, 0.75];
    let line = |ends: [[f64; 2]; 2], kind| SubConstraint { ends, kind };
    let mut fences = Vec::new();
    for row in [0.1, 0.3, 0.5, 0.9] {
        let posts: Vec<[f64; 2]> = (0..=200)
            .map(|k| [f64::from(k) / 200.0, row + 0.001 * f64::from(k % 7)])
            .collect();
        points.extend(posts.iter().map(|post| [post[0], post[1], 1.0]));
        fences.extend(
            posts
                .windows(2)
                .map(|pair| line([pair[0], pair[1]], EdgeKind::Breakline)),
        );
    }
    let (found, handed_up) = tiled(&points, &fences, [&cuts, &cuts], 4);
    assert_eq!(found, whole(&points, &fences));
    // As many as without lines: sub-constraints across the borders are as short as edges.
    assert!((1_000..3_300).contains(&handed_up), "{handed_up}");

    let cable = [[0.01, 0.6], [0.99, 0.8]];
    points.extend(cable.map(|end| [end[0], end[1], 2.0]));
    fences.push(line(cable, EdgeKind::Soft));
    let (found, with_cable) = tiled(&points, &fences, [&cuts, &cuts], 2);
    assert_eq!(found, whole(&points, &fences));
    // It waits for both of its ends, and so do the triangles that it crosses.
    assert!(
        (handed_up + 100..handed_up + 600).contains(&with_cable),
        "{handed_up} {with_cable}"
    );
}

/// The judge takes positions along the segment that include all at which it passes a side of the
/// tile, and one between each two of these.
#[test]
fn a_tile_is_met_if_a_position_in_it_is_on_the_line() {
    let mut random = Random(8);
    let mut met = [0; 2];
    for _ in 0..4_000 {
        let mut numbers = |least: i64| [0, 1].map(|_| least + random.below(7) as i64);
        // The sides of the tile are multiples of a half.
        let ([a, b], low) = ([numbers(0), numbers(0)], numbers(0));
        let size = numbers(1);
        let steps = 2
            * (0..2)
                .map(|axis| 2 * (b[axis] - a[axis]).abs().max(1))
                .product::<i64>();
        let is_inside = |k: i64| {
            (0..2).all(|axis| {
                let at = 2 * (a[axis] * steps + k * (b[axis] - a[axis]));
                (low[axis] * steps..(low[axis] + size[axis]) * steps).contains(&at)
            })
        };
        let expected = (0..=steps).any(is_inside);
        let min = low.map(|x| x as f64 / 2.0);
        let tile = Tile {
            min,
            max: [0, 1].map(|axis| min[axis] + size[axis] as f64 / 2.0),
        };
        let ends = [a, b].map(|end| end.map(|x| x as f64));
        let own = lines::of_tile(
            &tile,
            &[SubConstraint {
                ends,
                kind: EdgeKind::Soft,
            }],
        )
        .unwrap();
        assert_eq!(own.len() == 1, expected && a != b, "{ends:?} {tile:?}");
        met[usize::from(expected)] += 1;
    }
    assert!(met.iter().all(|&count| count > 500), "{met:?}");
}

fn message(result: Result<Residual>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn lines_that_make_no_sense_are_refused() {
    let tile = Tile {
        min: [0.0, 0.0],
        max: [8.0, 8.0],
    };
    let points = [
        [1.0, 1.0, 0.0],
        [5.0, 1.0, 0.0],
        [5.0, 5.0, 0.0],
        [1.0, 5.0, 0.0],
    ];
    let line = |a, b| SubConstraint {
        ends: [a, b],
        kind: EdgeKind::Breakline,
    };
    let leaf = |lines: &[SubConstraint]| message(leaf(&tile, 0, &points, lines, 0.0, &mut |_| ()));

    let error = leaf(&[line([1.0, 1.0], [4.0, 4.0])]);
    assert_eq!(
        error,
        "a line ends at [4.0, 4.0], where its tile has no point"
    );
    let error = leaf(&[line([1.0, 1.0], [5.0, 5.0]), line([1.0, 5.0], [5.0, 1.0])]);
    assert_eq!(error, "two lines, or a line and a seam, cross near 3 3");
    let error = leaf(&[line([f64::NAN, 1.0], [5.0, 5.0])]);
    assert_eq!(
        error,
        "an end of a line: [NaN, 1.0, 0.0] is not a finite point"
    );
    let error = leaf(&[SubConstraint {
        kind: EdgeKind::Rim,
        ..line([1.0, 1.0], [5.0, 5.0])
    }]);
    assert_eq!(
        error,
        "the line from [1.0, 1.0] to [5.0, 5.0] has the kind Rim"
    );
    // At the root no end can be missing.
    let rest = super::leaf(
        &tile,
        0,
        &points,
        &[line([1.0, 1.0], [9.0, 9.0])],
        0.0,
        &mut |_| (),
    )
    .unwrap();
    assert_eq!(rest.pending.len(), 1);
    let error = message(merge(&Tile::PLANE, &[rest], 0.0, &mut |_| ()));
    assert_eq!(
        error,
        "a line ends at [9.0, 9.0], where its tile has no point"
    );
}

/// Residuals are damaged in all their parts. What comes out may be wrong, as numbers without a
/// check sum are believed; but it comes out, or an error does.
#[test]
fn damaged_residuals_with_lines_do_not_panic() {
    let mut random = Random(23);
    let mut refused = 0;
    for round in 0..count() {
        let Case {
            points,
            constraints,
            ..
        } = Case::of(round, &mut random);
        let middle = points.get(points.len() / 2).map_or(0.0, |p| p[0]);
        let mut left = Tile::PLANE;
        let mut right = Tile::PLANE;
        (left.max[0], right.min[0]) = (middle, middle);
        let mut parts = [left, right].map(|tile| {
            let own: Vec<[f64; 3]> = points
                .iter()
                .copied()
                .filter(|p| tile.holds([p[0], p[1]]))
                .collect();
            leaf(&tile, 0, &own, &constraints, 0.0, &mut |_| ()).unwrap()
        });
        let part = &mut parts[random.index(2)];
        let [vertices, edges, pending] =
            [part.vertices.len(), part.edges.len(), part.pending.len()];
        match random.below(6) {
            0 if edges > 0 => _ = part.edges.swap_remove(random.index(edges)),
            1 if edges > 0 => {
                part.edges[random.index(edges)].ends[0] = random.index(vertices) as u32
            }
            2 if edges > 0 => part.edges[random.index(edges)].is_seam ^= true,
            3 if pending > 0 => part.pending[random.index(pending)].ends[0] = [1.0, 2.0],
            4 if vertices > 0 => part.vertices[random.index(vertices)].position[0] += 1.0,
            _ => part.has_lines ^= true,
        }
        refused += usize::from(merge(&Tile::PLANE, &parts, 0.0, &mut |_| ()).is_err());
    }
    assert!(refused > count() / 10, "{refused}");
}
