//! The kinds without the empty circle property: basic and constrained triangulations, on tiny
//! grids.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Plane, Space, Weighted};
use breakline_triangulation::kernel::Adaptive;
use breakline_triangulation::tds::{CellId, Tds, VertexId};
use breakline_triangulation::{
    Basic, Constrained, ConstrainedDelaunay, ConstrainedEdges, ConstraintError, Delaunay, Inserted,
    Level, MoveError, PointError, Regular, RemovalError, Triangulation,
};
use testkit::random::Random;

type Point = [f64; 2];

fn tiny<const D: usize>(random: &mut Random, side: u64) -> [f64; D] {
    std::array::from_fn(|_| random.below(side) as f64)
}

/// Asserts that there are as many triangles as in the Delaunay triangulation of the same points.
fn fills_the_hull<V, C: Copy + Default>(t: &Triangulation<Plane, 3, V, C>) {
    let points: Vec<Point> = t.tds().vertices().map(|v| *t.point(v)).collect();
    let (delaunay, _) = Delaunay::from_points(Plane::<Adaptive>::default(), &points).unwrap();
    assert_eq!(t.dimension(), delaunay.dimension(), "{points:?}");
    assert_eq!(
        t.finite_cells().count(),
        delaunay.finite_cells().count(),
        "{points:?}"
    );
}

#[test]
fn basic_ones_grow_flip_and_shrink() {
    let mut random = Random(31);
    for _ in 0..400 {
        let side = 1 + random.below(6);
        let mut t: Basic<Plane, 3> = Basic::new(Plane::default());
        for _ in 0..40 {
            match random.below(6) {
                0..3 => _ = t.insert(tiny(&mut random, side)).unwrap(),
                3 | 4 => {
                    let cells: Vec<_> = t.tds().cells().collect();
                    let before: BTreeSet<_> = t.finite_cells().collect();
                    if !cells.is_empty() {
                        let (cell, i) = (random.pick(&cells), random.index(3));
                        let is_flippable = t.is_flippable(cell, i);
                        assert_eq!(t.flip(cell, i), is_flippable);
                        assert_eq!(t.finite_cells().collect::<BTreeSet<_>>(), before);
                    }
                }
                _ => {
                    let vertices: Vec<VertexId> = t.tds().vertices().collect();
                    if !vertices.is_empty() {
                        let vertex = random.pick(&vertices);
                        assert_eq!(t.remove(vertex), Ok(*t.point(vertex)));
                        assert_eq!(t.remove(vertex), Err(RemovalError::NoVertex));
                    }
                }
            }
            assert_eq!(t.check(Level::Law), []);
            fills_the_hull(&t);
        }
    }
}

#[test]
fn basic_ones_in_space() {
    let mut random = Random(32);
    for _ in 0..500 {
        let side = 1 + random.below(4);
        let mut t: Basic<Space, 4> = Basic::new(Space::default());
        for _ in 0..25 {
            t.insert(tiny(&mut random, side)).unwrap();
            assert_eq!(t.check(Level::Law), []);
        }
    }
}

/// Each triangle has the color of the one that it was cut from.
#[test]
fn payloads_are_inherited() {
    let mut random = Random(33);
    let mut t = Basic::<Plane, 3>::new(Plane::default()).with_cell_data(|_| 0u8);
    for p in [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]] {
        t.insert(p).unwrap();
    }
    let colored: Vec<_> = t.finite_cells().collect();
    let shape =
        |t: &Triangulation<Plane, 3, (), u8>, cell| t.tds().corners(cell).map(|v| *t.point(v));
    let parents: Vec<[Point; 3]> = colored.iter().map(|&cell| shape(&t, cell)).collect();
    for (&cell, color) in colored.iter().zip(1..) {
        *t.cell_data_mut(cell) = color;
    }
    for _ in 0..60 {
        t.insert(tiny(&mut random, 9)).unwrap();
    }
    for cell in t.finite_cells() {
        let corners = shape(&t, cell);
        let middle = [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0);
        let parent = parents[usize::from(*t.tds().cell_data(cell)) - 1];
        let turn = |a: Point, b: Point| {
            (b[0] - a[0]) * (middle[1] - a[1]) - (b[1] - a[1]) * (middle[0] - a[0])
        };
        assert!((0..3).all(|k| turn(parent[k], parent[(k + 1) % 3]) > 0.0));
    }
}

fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let turn = |a: Point, b: Point, c: Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

/// Returns the vertices on the segment from one vertex to another, both included, in order.
fn path(
    t: &Triangulation<Plane, 3, (), ConstrainedEdges>,
    a: VertexId,
    b: VertexId,
) -> Vec<VertexId> {
    let (p, q) = (*t.point(a), *t.point(b));
    if a == b {
        return vec![a];
    }
    let along = |v: VertexId| {
        let r = t.point(v);
        let (u, w) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
        let (dot, length) = (u[0] * w[0] + u[1] * w[1], u[0] * u[0] + u[1] * u[1]);
        (u[0] * w[1] == u[1] * w[0] && (0.0..=length).contains(&dot)).then_some(dot as i64)
    };
    let mut path: Vec<(i64, VertexId)> = t
        .tds()
        .vertices()
        .filter_map(|v| Some((along(v)?, v)))
        .collect();
    path.sort_unstable();
    path.into_iter().map(|(_, v)| v).collect()
}

#[test]
fn constraints_hold() {
    let mut random = Random(34);
    for _ in 0..600 {
        let side = 2 + random.below(6);
        let mut t: Constrained<Plane> = Constrained::new(Plane::default());
        // Constraints by their ends; all their sub-constraints are present, and released ones are
        // gone.
        let mut constraints: BTreeSet<[VertexId; 2]> = BTreeSet::new();
        for _ in 0..40 {
            let vertices: Vec<VertexId> = t.tds().vertices().collect();
            if vertices.len() < 3 || random.below(3) == 0 {
                let p = tiny(&mut random, side);
                let vertex = t.insert(p).unwrap();
                let whole: Vec<_> = constraints.iter().copied().collect();
                for [a, b] in whole {
                    if path(&t, a, b).contains(&vertex) && vertex != a && vertex != b {
                        constraints.remove(&[a, b]);
                        constraints.extend([[a, vertex], [vertex, b]].map(|mut ends| {
                            ends.sort_unstable();
                            ends
                        }));
                    }
                }
            } else if random.below(6) == 0 {
                let vertex = random.pick(&vertices);
                let is_end = constraints.iter().flatten().any(|&v| v == vertex);
                let removed = t.remove(vertex);
                assert!(removed.is_err() || !is_end);
            } else if random.below(8) == 0 && !constraints.is_empty() {
                let ends = constraints.pop_first().unwrap();
                assert!(t.release(ends[0], ends[1]));
                assert!(!t.release(ends[0], ends[1]));
            } else {
                let (a, b) = (random.pick(&vertices), random.pick(&vertices));
                let crossed = |&[c, d]: &[VertexId; 2]| {
                    cross(*t.point(a), *t.point(b), *t.point(c), *t.point(d))
                };
                let blocks: BTreeSet<[VertexId; 2]> =
                    constraints.iter().copied().filter(crossed).collect();
                match t.constrain(a, b) {
                    Ok(()) => {
                        assert_eq!(blocks.len(), 0);
                        for pair in path(&t, a, b).windows(2) {
                            constraints.insert([pair[0].min(pair[1]), pair[0].max(pair[1])]);
                        }
                    }
                    Err(ConstraintError::Crosses(ends)) => {
                        assert!(blocks.contains(&ends), "{ends:?} not in {blocks:?}")
                    }
                    Err(error) => assert_eq!(
                        (error, t.dimension() < 2),
                        (ConstraintError::NoTriangles, true)
                    ),
                }
            }
            assert_eq!(t.check(Level::Law), []);
            fills_the_hull(&t);
            assert_eq!(
                t.constrained_edges().collect::<BTreeSet<_>>(),
                constraints,
                "{:?}",
                t.points()
            );
        }
    }
}

/// 20 x 20 points, in any order: 400 vertices, two triangles to each of 19 x 19 squares.
#[test]
fn a_grid_of_twenty() {
    let mut random = Random(35);
    let mut points: Vec<Point> = (0..400)
        .map(|k| [f64::from(k % 20), f64::from(k / 20)])
        .collect();
    random.shuffle(&mut points);
    let mut basic: Basic<Plane, 3> = Basic::new(Plane::default());
    let mut delaunay: Delaunay<Plane, 3> = Delaunay::new(Plane::default());
    let mut regular: Regular<Weighted, 3> = Regular::new(Weighted::default());
    for &p in &points {
        basic.insert(p).unwrap();
        delaunay.insert(p).unwrap();
        regular.insert([p[0], p[1], 3.0]).unwrap();
    }
    let counts = |t: &Tds<3>| {
        (
            t.vertex_count(),
            t.cells().filter(|&cell| !t.is_infinite(cell)).count(),
            t.hull().count(),
        )
    };
    for tds in [basic.tds(), delaunay.tds(), regular.tds()] {
        assert_eq!(counts(tds), (400, 722, 76));
    }
    assert_eq!(
        (
            basic.check(Level::Law),
            delaunay.check(Level::Law),
            regular.check(Level::Law)
        ),
        Default::default()
    );
}

/// Constraints need no law: with weighted points, too, any triangulation fills the hole of a
/// crossed region.
#[test]
fn constraints_among_weighted_points() {
    let mut random = Random(36);
    for _ in 0..300 {
        let mut t: Constrained<Weighted> = Constrained::new(Weighted::default());
        for _ in 0..9 {
            let [x, y]: Point = tiny(&mut random, 6);
            t.insert([x, y, random.below(40) as f64]).unwrap();
        }
        let vertices: Vec<VertexId> = t.tds().vertices().collect();
        for _ in 0..4 {
            let _ = t.constrain(random.pick(&vertices), random.pick(&vertices));
            assert_eq!(t.check(Level::Law), [], "{:?}", t.points());
        }
    }
}

#[test]
fn what_is_not_there_is_answered() {
    let mut t: Constrained<Plane> = Constrained::new(Plane::default());
    for p in [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]] {
        t.insert(p).unwrap();
    }
    let (there, absent) = (VertexId::new(0), VertexId::new(9));
    assert!(!t.release(absent, there) && !t.release(there, absent) && t.remove(absent).is_err());
    assert_eq!(
        t.constrain(there, absent),
        Err(ConstraintError::NoVertex(absent))
    );
    assert_eq!(
        ConstraintError::NoTriangles.to_string(),
        "there are no triangles to hold a constraint"
    );
}

/// Inserts, inserts again at the same site, moves, and moves onto another site, with the same
/// result in all kinds.
macro_rules! judge_insertions {
    ($new:expr, $at:expr) => {{
        let (mut t, at) = ($new, $at);
        let sites = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0], [4.0, 3.0]].map(at);
        for (k, p) in sites.into_iter().enumerate() {
            assert_eq!(
                t.insert_with(p, k).map(|inserted| inserted.is_new()),
                Ok(true)
            );
        }
        let there = t.insert_with(sites[4], 70).unwrap();
        assert_eq!(
            (
                there.is_new(),
                there.unused,
                *t.tds().vertex_data(there.vertex)
            ),
            (false, Some(70), 4)
        );
        let near = t.tds().cell_of(there.vertex);
        assert_eq!(
            t.insert_near(sites[4], 71, near),
            Ok(Inserted {
                vertex: there.vertex,
                unused: Some(71)
            })
        );
        assert_eq!(
            t.insert_near(at([f64::NAN, 0.0]), 72, near),
            Err(PointError::NotFinite)
        );

        assert_eq!(t.move_to(there.vertex, at([5.0, 6.0])), Ok(there.vertex));
        assert_eq!(
            (*t.point(there.vertex), *t.tds().vertex_data(there.vertex)),
            (at([5.0, 6.0]), 4)
        );
        assert_eq!(t.check(Level::Law), []);
        let corner = t.insert_with(sites[3], 73).unwrap().vertex;
        assert_eq!(t.move_to(there.vertex, sites[3]), Ok(corner));
        assert_eq!((t.vertex_count(), t.check(Level::Law)), (4, vec![]));
        let gone = Err(MoveError::Vertex(RemovalError::NoVertex));
        assert_eq!(t.move_to(there.vertex, at([1.0, 1.0])), gone);
        assert_eq!(t.remove(there.vertex), Err(RemovalError::NoVertex));
    }};
}

#[test]
fn insertion_gives_back_a_payload_that_it_does_not_use() {
    let plane = |p: [f64; 2]| p;
    judge_insertions!(Basic::<Plane, 3, usize>::new(Plane::default()), plane);
    judge_insertions!(
        Delaunay::<Plane, 3, usize>::with_capacity(Plane::default(), 9),
        plane
    );
    judge_insertions!(
        Regular::<Weighted, 3, usize>::new(Weighted::default()),
        |[x, y]: [f64; 2]| [x, y, 2.0]
    );
    judge_insertions!(Constrained::<Plane, usize>::new(Plane::default()), plane);
    judge_insertions!(
        ConstrainedDelaunay::<Plane, usize>::new(Plane::default()),
        plane
    );
}

/// A vertex that moves onto a constraint splits it; a vertex that was on a constraint stays.
#[test]
fn a_vertex_moves_onto_a_constraint() {
    let points = [[0.0, 0.0], [8.0, 0.0], [4.0, 6.0], [4.0, -6.0], [6.0, 2.0]];
    let (mut t, v) =
        Constrained::<Plane>::from_points_with(Plane::default(), &points, |k| k).unwrap();
    t.constrain(v[0], v[1]).unwrap();
    assert_eq!(t.move_to(v[4], [2.0, 0.0]), Ok(v[4]));
    let halves = [[v[0], v[4]], [v[4], v[1]]].map(|[a, b]| [a.min(b), a.max(b)]);
    assert_eq!(
        t.constrained_edges().collect::<BTreeSet<_>>(),
        BTreeSet::from(halves)
    );
    assert_eq!(t.check(Level::Law), []);
    let held = Err(MoveError::Vertex(RemovalError::Constraint));
    assert_eq!(
        (t.move_to(v[4], [6.0, 2.0]), t.move_to(v[0], [-1.0, 0.0])),
        (held, held)
    );
    assert!((0..5).all(|k| *t.tds().vertex_data(v[k]) == k));
}

/// Each message states its own part; the sources state the rest of the chain.
#[test]
fn errors_do_not_repeat_their_source() {
    let error = MoveError::from(RemovalError::Constraint);
    let source = std::error::Error::source(&error).unwrap().to_string();
    assert_eq!(
        error.to_string(),
        "the vertex cannot be moved from where it is"
    );
    assert_eq!(source, "a constraint needs the vertex");
    assert_eq!(
        PointError::TooMany.to_string(),
        "more than 2147483646 points"
    );
}

/// The points of cells and edges, also for numbers of nothing.
#[test]
fn cells_and_edges_have_points() {
    let (t, v) =
        Delaunay::from_points(Plane::new(), &[[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]).unwrap();
    for cell in (0..9).map(CellId::new) {
        let is_finite = t.tds().is_used(cell) && !t.tds().is_infinite(cell);
        assert_eq!(t.cell_points(cell).is_some(), is_finite);
        for i in 0..4 {
            let Some(points) = t.edge_points(cell, i) else {
                assert!(!is_finite || i == 3);
                continue;
            };
            assert_eq!(points, t.tds().edge_ends(cell, i).map(|v| t.point(v)));
        }
    }
    let edges = t
        .tds()
        .cells()
        .flat_map(|cell| (0..3).map(move |i| (cell, i)));
    assert_eq!(
        edges
            .filter(|&(cell, i)| t.edge_points(cell, i).is_some())
            .count(),
        6
    );
    assert_eq!(t.locate(&[0.0, 0.0], None).vertex(), Some(v[0]));
    let on_edge = t.locate(&[2.0, 0.0], None);
    let ends: Vec<_> = on_edge
        .facets()
        .map(|(cell, i)| t.edge_points(cell, i).map(|ends| ends.map(|p| p[1])))
        .collect();
    assert_eq!((ends, on_edge.vertex()), (vec![Some([0.0, 0.0])], None));
    let mut line = Basic::<Plane, 3>::new(Plane::new());
    line.insert_all(&[[0.0, 0.0], [1.0, 0.0]]).unwrap();
    assert!(
        line.tds()
            .cells()
            .all(|cell| line.cell_points(cell).is_none() && line.edge_points(cell, 0).is_none())
    );
}
