//! Queries of triangulations of the plane compared with naive answers, on tiny grids where ties are
//! the rule.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use crate::grid::{Point, build, grid_point, points, site};
use breakline_triangulation::geometry::{Geometry, Metric, Plane, Steps, Terrain};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{ConstrainedDelaunay, Mark, OnCrossing, Passage, Triangulation};
use testkit::cells::{by_vertices, vertices};
use testkit::picture::OnFailure;
use testkit::random::Random;

type Lined = ConstrainedDelaunay<Plane>;

fn plane() -> Plane {
    Plane::default()
}

/// Inserts all pairs of some points as lines, so that they overlap and touch; some cross.
fn constrained(dice: &mut Random, points: &[Point]) -> Lined {
    let index = |dice: &mut Random| dice.index(points.len()) as u32;
    let lines: Vec<Vec<u32>> = if points.is_empty() {
        Vec::new()
    } else {
        (0..dice.below(5))
            .map(|_| vec![index(dice), index(dice)])
            .collect()
    };
    Lined::from_lines(Plane::default(), points, &lines, OnCrossing::Split)
        .unwrap()
        .0
}

/// Returns the expected conflict zone, given the triangulation with the point inserted.
fn judge_zone<V, C: Copy + Default>(
    before: &Triangulation<Plane, 3, V, C>,
    after: &Triangulation<Plane, 3, V, C>,
    zone: &breakline_triangulation::ConflictZone,
) {
    let destroyed: BTreeSet<_> = by_vertices(before)
        .difference(&by_vertices(after))
        .cloned()
        .collect();
    assert_eq!(zone.cells.len(), destroyed.len());
    assert_eq!(
        zone.cells
            .iter()
            .map(|&cell| vertices(before, cell))
            .collect::<BTreeSet<_>>(),
        destroyed
    );
    let tds = before.tds();
    for &(cell, i) in &zone.border {
        assert!(zone.cells.contains(&cell) && !zone.cells.contains(&tds.neighbor(cell, i)));
    }
    if before.dimension() == 1 {
        assert_eq!(zone.border.len(), 2);
        return;
    }
    assert_eq!(zone.border.len(), zone.cells.len() + 2);
    for (k, &(cell, i)) in zone.border.iter().enumerate() {
        let (next, j) = zone.border[(k + 1) % zone.border.len()];
        assert_eq!(tds.edge_ends(cell, i)[1], tds.edge_ends(next, j)[0]);
    }
}

#[test]
fn conflict_zones_are_what_insertion_destroys() {
    let mut dice = Random(1);
    for round in 0..4000 {
        let t = build(&points(&mut dice, round));
        let q = site(&mut dice);
        let mut after = t.clone();
        after.insert(q).unwrap();
        match t.conflict_zone(&q, None) {
            Some(zone) => {
                let marks = [
                    Mark::Cells(&zone.cells),
                    Mark::Edges(&zone.border),
                    Mark::Line(&[q]),
                ];
                let _picture = OnFailure {
                    name: "conflict_zone",
                    svg: || t.svg(&marks),
                };
                judge_zone(&t, &after, &zone);
            }
            None => assert!(
                after.vertex_count() == t.vertex_count() || after.dimension() > t.dimension()
            ),
        }
    }
}

#[test]
fn constraints_bound_conflict_zones() {
    let mut dice = Random(2);
    for round in 0..4000 {
        let points = points(&mut dice, round);
        let t = constrained(&mut dice, &points);
        if !t.crossings().is_empty() {
            continue; // a point may lie on lines that were bent, which insertion moves onto it
        }
        let q = site(&mut dice);
        let mut after = t.clone();
        after.insert(q).unwrap();
        match t.conflict_zone(&q, None) {
            Some(zone) => judge_zone(&t, &after, &zone),
            None => assert!(
                after.vertex_count() == t.vertex_count() || after.dimension() > t.dimension()
            ),
        }
    }
}

fn squared(p: Point, q: Point) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
}

#[test]
fn nearest_vertices_in_order() {
    let mut dice = Random(3);
    for round in 0..4000 {
        let t = build(&points(&mut dice, round));
        let (q, rim) = (site(&mut dice), site(&mut dice));
        let mut expected: Vec<VertexId> = t.tds().vertices().collect();
        let far = |v: VertexId| squared(*t.point(v), q);
        expected.sort_by(|&u, &v| {
            far(u)
                .total_cmp(&far(v))
                .then_with(|| plane().compare(t.point(u), t.point(v)))
        });
        let near = t.tds().cells().next();
        assert_eq!(t.nearest(&q, near), expected.first().copied());
        assert!(t.nearest_first(&q, near).eq(expected.iter().copied()));
        let within = expected.into_iter().filter(|&v| far(v) <= squared(q, rim));
        assert!(t.within(&q, &rim).eq(within));
    }
}

#[test]
fn metrics_agree() {
    let mut dice = Random(4);
    for _ in 0..1000 {
        let sites: [Point; 3] = [0; 3].map(|_| grid_point(&mut dice, 5));
        let [q, a, b] = sites;
        let expected = squared(q, a).total_cmp(&squared(q, b));
        assert_eq!(plane().compare_distance(&q, &a, &b), expected);
        let [q, a, b] = sites.map(|[x, y]| [x, y, dice.unit()]);
        assert_eq!(
            Terrain::<breakline_triangulation::kernel::Exact>::default()
                .compare_distance(&q, &a, &b),
            expected
        );
        let [q, a, b] = sites.map(|[x, y]| [x as i32, y as i32, dice.below(9) as i32]);
        assert_eq!(
            Steps::<breakline_triangulation::kernel::Lattice>::default()
                .compare_distance(&q, &a, &b),
            expected
        );
    }
}

#[test]
fn rectangles() {
    let mut dice = Random(5);
    for round in 0..4000 {
        let points = points(&mut dice, round);
        let t = constrained(&mut dice, &points);
        let corners @ [p, q] = [site(&mut dice), site(&mut dice)];
        let is_within = |v: &VertexId| {
            (0..2).all(|k| {
                let x = t.point(*v)[k];
                p[k].min(q[k]) <= x && x <= p[k].max(q[k])
            })
        };
        let expected: Vec<VertexId> = t.tds().vertices().filter(is_within).collect();
        assert_eq!(
            t.within_rectangle(corners.each_ref()),
            expected,
            "{points:?} {corners:?}"
        );
    }
}

/// Returns true if the segment meets the face, edge or vertex with these corners, without its
/// border.
fn meets(part: &[Point], [a, b]: [Point; 2]) -> bool {
    let turn = |p: &Point, q: &Point, r: &Point| plane().orientation([p, q, r]);
    let holds = |p: &Point| match part {
        [v] => v == p,
        [u, v] => {
            turn(u, v, p) == Sign::Zero
                && plane().side_of_sphere_in_flat(&[u, v], p) == Sign::Positive
        }
        _ => (0..3)
            .all(|i| turn(&part[i], &part[(i + 1) % 3], p) == turn(&part[0], &part[1], &part[2])),
    };
    if holds(&a) || holds(&b) {
        return true;
    }
    if a == b {
        return false;
    }
    let is_between = |p: &Point| plane().side_of_sphere_in_flat(&[&a, &b], p) == Sign::Positive;
    match part {
        [v] => turn(&a, &b, v) == Sign::Zero && is_between(v),
        [u, v] => {
            let crosses = |a, b, c, d| turn(a, b, c) * turn(a, b, d) == Sign::Negative;
            let is_along = turn(u, v, &a) == Sign::Zero && turn(u, v, &b) == Sign::Zero;
            let sorted = |p: Point, q: Point| {
                if plane().compare(&p, &q).is_lt() {
                    [p, q]
                } else {
                    [q, p]
                }
            };
            let [s, t] = [sorted(a, b), sorted(*u, *v)];
            let overlaps = is_along
                && plane().compare(&s[0], &t[1]).is_lt()
                && plane().compare(&t[0], &s[1]).is_lt();
            crosses(&a, &b, u, v) && crosses(u, v, &a, &b) || overlaps
        }
        // Ends outside: it goes through two of the six parts of the border, which are not on one
        // closed side.
        [u, v, w] => {
            let sides = [[u, v], [v, w], [w, u]];
            let on = |s: &[&Point; 2], p: &Point| turn(s[0], s[1], p) == Sign::Zero;
            let corners: Vec<&Point> = [u, v, w]
                .into_iter()
                .filter(|p| meets(&[**p], [a, b]))
                .collect();
            let edges: Vec<&[&Point; 2]> = sides
                .iter()
                .filter(|s| meets(&[*s[0], *s[1]], [a, b]))
                .collect();
            let apart = corners.iter().any(|p| edges.iter().any(|s| !on(s, p)));
            edges.len() == 2 || apart
        }
        _ => unreachable!(),
    }
}

/// Returns the corners of a face, edge or vertex, sorted.
fn part<V, C: Copy + Default>(
    t: &Triangulation<Plane, 3, V, C>,
    passage: Passage,
) -> Vec<VertexId> {
    let mut corners = match passage {
        Passage::Face(cell) => t.tds().corners(cell).to_vec(),
        Passage::Edge(cell, i) => t.tds().edge_ends(cell, i).to_vec(),
        Passage::Along(ends) => ends.to_vec(),
        Passage::Vertex(vertex) => vec![vertex],
    };
    corners.sort();
    corners
}

#[test]
fn segments_meet_what_they_meet_in_order() {
    let mut dice = Random(6);
    let mut kinds = [0; 4];
    for round in 0..6000 {
        // Every other time, most are nearly on lines: the judge is exact.
        let scale = if round % 2 == 0 { 1.0 } else { 0.37 };
        let points: Vec<Point> = points(&mut dice, round)
            .into_iter()
            .map(|p| p.map(|x| x * scale))
            .collect();
        let t = constrained(&mut dice, &points);
        let [a, b] = [0; 2].map(|_| site(&mut dice).map(|x| x * scale));
        let _picture = OnFailure {
            name: "along",
            svg: || t.svg(&[Mark::Line(&[a, b]), Mark::Line(&[a])]),
        };
        let met: Vec<Passage> = t.along([&a, &b], None).collect();
        let returned: Vec<Vec<VertexId>> = met.iter().map(|&passage| part(&t, passage)).collect();
        let mut parts: BTreeSet<Vec<VertexId>> = BTreeSet::new();
        if t.dimension() == 2 {
            parts.extend(t.tds().vertices().map(|v| vec![v]));
            parts.extend(
                t.tds()
                    .finite_edges()
                    .map(|(cell, i)| part(&t, Passage::Edge(cell, i))),
            );
            parts.extend(t.finite_cells().map(|cell| part(&t, Passage::Face(cell))));
        }
        parts.retain(|part| {
            meets(
                &part.iter().map(|&v| *t.point(v)).collect::<Vec<_>>(),
                [a, b],
            )
        });
        assert_eq!(
            returned.iter().cloned().collect::<BTreeSet<_>>(),
            parts,
            "{points:?} {a:?} {b:?}"
        );
        assert_eq!(returned.len(), parts.len(), "nothing twice");
        // Each lies on the border of the one before, or vice versa: together with the set that is
        // met, this leaves one order and its reverse.
        for pair in returned.windows(2) {
            let [p, q] = [&pair[0], &pair[1]];
            assert!(
                p.iter().all(|v| q.contains(v)) || q.iter().all(|v| p.contains(v)),
                "{returned:?}"
            );
        }
        if let [first, .., last] = &returned[..] {
            let first_from_a = meets(
                &first.iter().map(|&v| *t.point(v)).collect::<Vec<_>>(),
                [a, a],
            );
            let last_from_a = meets(
                &last.iter().map(|&v| *t.point(v)).collect::<Vec<_>>(),
                [a, a],
            );
            assert!(first_from_a || !last_from_a);
        }
        // In the opposite direction: the same in reverse order.
        let mut back: Vec<Vec<VertexId>> = t
            .along([&b, &a], None)
            .map(|passage| part(&t, passage))
            .collect();
        back.reverse();
        assert_eq!(back, returned, "{points:?} {a:?} {b:?}");
        for passage in met {
            match passage {
                Passage::Face(_) => kinds[0] += 1,
                Passage::Edge(cell, i) => {
                    kinds[1] += 1;
                    // From the cell outward.
                    let [u, v] = t.tds().edge_ends(cell, i).map(|v| *t.point(v));
                    assert_ne!(plane().orientation([&u, &v, &b]), Sign::Positive);
                    assert_ne!(plane().orientation([&u, &v, &a]), Sign::Negative);
                }
                Passage::Along([from, to]) => {
                    kinds[2] += 1;
                    let towards = plane().compare(t.point(from), t.point(to));
                    assert_eq!(towards, plane().compare(&a, &b));
                    assert_ne!(towards, Ordering::Equal);
                }
                Passage::Vertex(_) => kinds[3] += 1,
            }
        }
    }
    assert!(kinds.iter().all(|&count| count > 50), "{kinds:?}");
}

/// Along the lower side of a square, (0, 0) to (4, 0), with a vertex in its middle, and on its line
/// beyond both ends: start, end, and what is met. Each segment is followed in both directions.
#[test]
fn collinear_edges_of_the_hull() {
    let t = build(&[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0]]);
    // Vertices by their x, edges along the side by that of their middle.
    let table: [(f64, f64, &[f64]); 12] = [
        (-3.0, -1.0, &[]),
        (-1.0, 0.0, &[0.0]),
        (-1.0, 1.0, &[0.0, 1.0]),
        (-1.0, 2.0, &[0.0, 1.0, 2.0]),
        (-1.0, 3.0, &[0.0, 1.0, 2.0, 3.0]),
        (-1.0, 5.0, &[0.0, 1.0, 2.0, 3.0, 4.0]),
        (0.0, 2.0, &[0.0, 1.0, 2.0]),
        (0.5, 1.5, &[1.0]),
        (0.5, 2.0, &[1.0, 2.0]),
        (1.0, 3.0, &[1.0, 2.0, 3.0]),
        (2.0, 5.0, &[2.0, 3.0, 4.0]),
        (4.0, 5.0, &[4.0]),
    ];
    let walk = |a: f64, b: f64| -> Vec<f64> {
        let x = |v: VertexId| t.point(v)[0];
        let name = |passage| match passage {
            Passage::Vertex(v) => x(v),
            Passage::Along([u, v]) => (x(u) + x(v)) / 2.0,
            other => panic!("{other:?}"),
        };
        t.along([&[a, 0.0], &[b, 0.0]], None).map(name).collect()
    };
    for (a, b, met) in table {
        assert_eq!(walk(a, b), met, "from {a} to {b}");
        assert!(walk(b, a).iter().eq(met.iter().rev()), "from {b} to {a}");
    }
}

/// A walk across a grid of squares, each with a diagonal: through vertices only, or past them.
#[test]
fn walks_across_a_grid() {
    let points: Vec<Point> = (0..400)
        .map(|k| [f64::from(k % 20), f64::from(k / 20)])
        .collect();
    let t = build(&points);
    let count = |a, b| {
        let met: Vec<Passage> = t.along([&a, &b], None).collect();
        let of = |is: fn(&Passage) -> bool| met.iter().filter(|p| is(p)).count();
        [
            of(|p| matches!(p, Passage::Face(_))),
            of(|p| matches!(p, Passage::Edge(..))),
            of(|p| matches!(p, Passage::Along(_))),
            of(|p| matches!(p, Passage::Vertex(_))),
        ]
    };
    assert_eq!(count([-1.0, 7.0], [25.0, 7.0]), [0, 0, 19, 20]);
    assert_eq!(count([7.0, 25.0], [7.0, -1.0]), [0, 0, 19, 20]);
    assert_eq!(count([-1.0, 7.5], [25.0, 7.5]), [38, 39, 0, 0]);
    let [faces, edges, along, through] = count([-1.0, -1.0], [20.0, 20.0]);
    assert_eq!((through, faces / 2 + along), (20, 19));
    assert_eq!(faces, 2 * edges);
}

#[test]
fn pictures_show_what_is_there_in_every_dimension() {
    let mut dice = Random(7);
    for round in 0..500 {
        let t = build(&points(&mut dice, round));
        let (cells, edges): (Vec<CellId>, Vec<_>) =
            (t.tds().cells().collect(), t.tds().edges().collect());
        let svg = t.svg(&[
            Mark::Cells(&cells),
            Mark::Edges(&edges),
            Mark::Polygon(&[]),
            Mark::Line(&[[1.0, 2.0]]),
        ]);
        let count = |what: &str| svg.matches(what).count();
        let finite = t.tds().finite_edges().count();
        assert_eq!(count("<line"), 2 * finite);
        assert_eq!(count("class=\"edge\""), finite);
        assert_eq!(count("class=\"cell\""), t.finite_cells().count());
        assert_eq!(
            (count("<text"), count("<circle")),
            (t.vertex_count(), t.vertex_count() + 1)
        );
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
