//! Queries without an answer: at sites that do not exist, for numbers of nothing, below dimension
//! 2. None of them panics or runs forever; if there is an answer after all, it is the naive one.

use std::cmp::Ordering;

use crate::grid::{Free, Point, build};
use breakline_triangulation::geometry::{Metric, Plane, Space, Weighted};
use breakline_triangulation::kernel::{Exact, Kernel, Wide};
use breakline_triangulation::refine::{Conformity, Domain, Quality, RegionBound};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{
    Basic, Buckets, Compact, CompactError, Constrained, ConstrainedDelaunay, Delaunay, Hierarchy,
    JumpAndWalk, Level, LineId, Locate, Location, Mark, Near, Passage, Regular, StraightLine,
    Triangulation, VoronoiEdge,
};

const SQUARE: [Point; 4] = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];

/// Point sets of each dimension, and two with triangles.
const SETS: [&[Point]; 7] = [
    &[],
    &[[1.0, 2.0]],
    &[[1.0, 2.0], [4.0, 2.0]],
    &[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]],
    &[[2.0, 0.0], [2.0, -1.0], [2.0, 5.0], [2.0, 1.0]],
    &[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]],
    &[
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [2.0, 2.0],
        [2.0, 0.0],
    ],
];

/// Coordinates that are not numbers, that the default kernel does not reach, and ordinary ones.
const COORDINATES: [f64; 11] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e200,
    -1e200,
    f64::MAX,
    1e-200,
    5e-324,
    0.0,
    1.5,
    2.0,
];

fn odd_positions() -> impl Iterator<Item = Point> {
    COORDINATES
        .iter()
        .flat_map(|&x| COORDINATES.iter().map(move |&y| [x, y]))
}

/// Numbers of vertices that exist, that existed, that never did, and that stand for something else.
fn vertex_numbers<V, C: Copy + Default>(t: &Triangulation<Plane, 3, V, C>) -> Vec<VertexId> {
    let unused = t.tds().cells().flat_map(|cell| *t.tds().corners(cell));
    let numbers = (0..t.tds().vertex_slots() + 3).map(VertexId::new);
    let mut numbers: Vec<_> = numbers
        .chain([VertexId::INFINITE, VertexId::new(VertexId::LIMIT - 1)])
        .collect();
    numbers.extend(unused);
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Numbers of cells of the same sorts.
fn cell_numbers<V, C: Copy + Default>(t: &Triangulation<Plane, 3, V, C>) -> Vec<CellId> {
    let numbers = (0..t.tds().cell_slots() + 3).map(CellId::new);
    numbers.chain([CellId::new(CellId::LIMIT - 1)]).collect()
}

/// Makes the queries of all kinds.
fn asks_the_complex<V, C: Copy + Default>(t: &Triangulation<Plane, 3, V, C>) {
    let (tds, vertices, cells) = (t.tds(), vertex_numbers(t), cell_numbers(t));
    for &v in &vertices {
        let is_there = tds.is_vertex(v) || v == VertexId::INFINITE;
        assert_eq!(tds.cell_of(v).is_some(), is_there && t.dimension() >= 0);
        assert_eq!(
            tds.around(v).next().is_some(),
            is_there && t.dimension() == 2
        );
        assert_eq!(tds.degree(v) > 0, is_there && t.dimension() >= 1);
        assert_eq!(tds.degree(v), tds.edges_around(v).count());
        assert!(is_there || tds.vertices_around(v).next_back().is_none());
        let faces = if tds.is_vertex(v) && t.dimension() == 2 {
            t.finite_cells().count()
        } else {
            0
        };
        assert_eq!(t.faces_from(v).count(), faces, "{v:?}");
        for &w in &vertices {
            assert_eq!(tds.has_edge(v, w), tds.vertices_around(v).any(|u| u == w));
            assert!(tds.edge(v, w).is_none() || tds.has_edge(v, w) && t.dimension() == 2);
            let face = vertices.iter().find_map(|&u| tds.face([v, w, u]));
            assert!(face.is_none_or(|cell| tds.is_used(cell) && t.dimension() == 2));
        }
    }
    for &cell in &cells {
        let is_face = t.dimension() == 2 && tds.is_used(cell) && !tds.is_infinite(cell);
        assert_eq!(t.circumcenter(cell).is_some(), is_face);
        assert!((0..5).all(|i| is_face || !t.is_flippable(cell, i)));
    }
    for q in odd_positions().chain(t.points().to_vec()) {
        for near in [
            None,
            Some(CellId::new(0)),
            Some(CellId::new(7)),
            Some(CellId::new(CellId::LIMIT - 1)),
        ] {
            is_somewhere(t, q, t.locate(&q, near));
        }
        for p in [q, [0.5, 0.25], [f64::NAN, 0.0], [0.0, 1e300]] {
            let found = t.within_rectangle([&p, &q]);
            let between = |k: usize, x: f64| p[k] <= x && x <= q[k] || q[k] <= x && x <= p[k];
            let naive = tds
                .vertices()
                .filter(|&v| (0..2).all(|k| between(k, t.point(v)[k])));
            assert!(found.into_iter().eq(naive), "{p:?} {q:?}");
            let is_asked =
                t.dimension() == 2 && [p, q].as_flattened().iter().all(|&x| is_ordinary(x));
            let passages: Vec<Passage> = t.along([&p, &q], None).collect();
            assert!(
                is_asked || passages.is_empty() && t.edges_crossed(&p, &q).is_empty(),
                "{p:?} {q:?}"
            );
        }
    }
    let edges: Vec<(CellId, usize)> = cells
        .iter()
        .flat_map(|&cell| (0..5).map(move |i| (cell, i)))
        .collect();
    let odd: Vec<Point> = odd_positions()
        .filter(|p| !p.iter().all(|x| x.is_finite()))
        .collect();
    let marks = [
        Mark::Cells(&cells),
        Mark::Edges(&edges),
        Mark::Polygon(&odd),
        Mark::Line(&odd),
        Mark::Line(&odd[..1]),
    ];
    let svg = t.svg(&marks);
    assert_eq!(
        svg.matches("class=\"plain\"").count(),
        tds.finite_edges().count()
    );
    assert_eq!(
        svg.matches("class=\"cell\"").count(),
        t.finite_cells().count()
    );
    assert!(
        !svg.contains("class=\"dot\"") && !svg.contains("NaN") && !svg.contains("inf"),
        "{svg}"
    );
    assert_eq!(t.svg(&[]).matches("<circle").count(), t.vertex_count());
}

fn is_ordinary(x: f64) -> bool {
    <breakline_triangulation::kernel::Adaptive as Kernel>::RANGE.admits(x)
}

/// Points with special coordinates lie nowhere, others somewhere.
fn is_somewhere<V, C: Copy + Default>(
    t: &Triangulation<Plane, 3, V, C>,
    q: Point,
    location: Location,
) {
    let is_site = q.iter().all(|&x| is_ordinary(x));
    assert_eq!(location == Location::Nowhere, !is_site, "{q:?}");
    let has_cell = location.cell(t).is_some();
    assert_eq!(
        has_cell,
        is_site && location != Location::OutsideAffineHull,
        "{q:?}"
    );
}

/// Built, and with vertices removed again.
fn free(points: &[Point]) -> [Free; 2] {
    let mut shrunk = build(&[points, &[[7.0, 8.0], [-3.0, 8.0], [5.0, -6.0]]].concat());
    let extra: Vec<VertexId> = shrunk
        .tds()
        .vertices()
        .filter(|&v| !points.contains(shrunk.point(v)))
        .collect();
    for v in extra {
        shrunk.remove(v).unwrap();
    }
    assert_eq!(shrunk.check(Level::Law), []);
    [build(points), shrunk]
}

#[test]
fn delaunay_triangulations() {
    for points in SETS {
        for t in free(points) {
            asks_the_complex(&t);
            let area: f64 = vertex_numbers(&t)
                .into_iter()
                .map(|v| t.voronoi_cell(v, &SQUARE).area)
                .sum();
            assert_eq!(area, if points.is_empty() { 0.0 } else { 18.0 * 18.0 });
            for v in vertex_numbers(&t) {
                for within in [
                    &[][..],
                    &SQUARE[..2],
                    &[[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]],
                    &[[f64::INFINITY; 2]; 3],
                ] {
                    assert_eq!(t.voronoi_cell(v, within).area, 0.0);
                }
            }
            for cell in cell_numbers(&t) {
                for i in 0..5 {
                    let is_edge = if t.dimension() == 2 {
                        i < 3
                    } else {
                        t.dimension() == 1 && i == 2
                    };
                    let ends =
                        (is_edge && t.tds().is_used(cell)).then(|| t.tds().edge_ends(cell, i));
                    let is_finite = ends.is_some_and(|ends| !ends.contains(&VertexId::INFINITE));
                    let dual = t.voronoi_edge(cell, i);
                    assert_eq!(dual.is_some(), is_finite, "{cell:?} {i}");
                    assert_eq!(
                        matches!(dual, Some(VoronoiEdge::Line { .. })),
                        is_finite && t.dimension() == 1
                    );
                }
            }
            for q in odd_positions() {
                let is_site = q.iter().all(|&x| is_ordinary(x));
                assert_eq!(
                    t.nearest(&q, None).is_some(),
                    is_site && !points.is_empty(),
                    "{q:?}"
                );
                assert_eq!(
                    t.nearest_first(&q, None).count(),
                    if is_site { points.len() } else { 0 }
                );
                for rim in [q, [0.5, 0.25], [f64::NAN, 0.0]] {
                    let is_circle = is_site && rim.iter().all(|&x| is_ordinary(x));
                    assert!(
                        is_circle
                            || t.within(&q, &rim).next().is_none()
                                && t.within(&rim, &q).next().is_none()
                    );
                }
                assert!(is_site || t.conflict_zone(&q, None).is_none());
                assert!(is_site || t.sibson(&q, None).is_none() && t.laplace(&q, None).is_none());
            }
        }
    }
}

/// On a line the border of a zone is vertices, which are not edges: the picture shows the others.
#[test]
fn a_picture_of_a_zone_on_a_line() {
    let t = build(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]);
    let zone = t.conflict_zone(&[2.0, 2.0], None).unwrap();
    let svg = t.svg(&[Mark::Cells(&zone.cells), Mark::Edges(&zone.border)]);
    let count = |class: &str| svg.matches(&format!("class=\"{class}\"")).count();
    assert_eq!(
        [count("cell"), count("edge"), count("plain")],
        [1, 0, 2],
        "{svg}"
    );
}

#[test]
fn strategies() {
    for points in SETS {
        let t = &free(points)[1];
        let (hierarchy, buckets) = (
            Hierarchy::<Plane, 3>::of(Plane::default(), t),
            Buckets::of(t),
        );
        for q in odd_positions() {
            for v in vertex_numbers(t).into_iter().map(Some).chain([None]) {
                is_somewhere(t, q, StraightLine(v).locate(t, &q));
            }
            for cell in cell_numbers(t) {
                is_somewhere(t, q, Near(Some(cell)).locate(t, &q));
            }
            is_somewhere(t, q, JumpAndWalk.locate(t, &q));
            is_somewhere(t, q, hierarchy.locate(t, &q));
            is_somewhere(t, q, buckets.locate(t, &q));
            is_somewhere(t, q, Buckets::over([q, [1.0, 1.0]], 9).locate(t, &q));
        }
    }
    // Samples with triangles of their own.
    let grid: Vec<Point> = (0..9000)
        .map(|k| [f64::from(k % 90), f64::from(k / 90)])
        .collect();
    let t = build(&grid);
    let hierarchy = Hierarchy::<Plane, 3>::of(Plane::default(), &t);
    assert!(
        hierarchy
            .sample_sizes()
            .next()
            .is_some_and(|size| size > 200)
    );
    for q in odd_positions() {
        is_somewhere(&t, q, hierarchy.locate(&t, &q));
        is_somewhere(&t, q, StraightLine(None).locate(&t, &q));
    }
}

/// With a kernel for all finite numbers, answers are correct however far away the site is.
#[test]
fn from_as_far_as_numbers_go() {
    let grid: Vec<Point> = (0..25)
        .map(|k| [f64::from(k % 5), f64::from(k / 5)])
        .collect();
    let (t, _) = Delaunay::from_points(Plane::<Wide>::default(), &grid).unwrap();
    let (hierarchy, buckets) = (Hierarchy::of(Plane::<Wide>::default(), &t), Buckets::of(&t));
    let mut bytes = Vec::new();
    t.write_compact(&mut bytes).unwrap();
    let compact = Compact::open(Plane::<Wide>::default(), &bytes[..]).unwrap();
    let exact = Plane::<Exact>::default();
    for q in odd_positions() {
        let is_finite = q.iter().all(|x| x.is_finite());
        let nearer = |&v: &VertexId, &w: &VertexId| {
            let order = exact.compare_distance(&q, t.point(v), t.point(w));
            order.then_with(|| {
                t.point(v)
                    .partial_cmp(t.point(w))
                    .unwrap_or(Ordering::Equal)
            })
        };
        let mut naive: Vec<VertexId> = if is_finite {
            t.tds().vertices().collect()
        } else {
            Vec::new()
        };
        naive.sort_by(nearer);
        assert_eq!(t.nearest(&q, None), naive.first().copied(), "{q:?}");
        assert!(t.nearest_first(&q, None).eq(naive.iter().copied()), "{q:?}");
        let within = t.within(&q, &[2.0, 2.0]);
        let is_within = |v: &VertexId| exact.compare_distance(&q, t.point(*v), &[2.0, 2.0]).is_le();
        assert!(within.eq(naive.iter().copied().filter(is_within)), "{q:?}");
        let is_around = |v: &VertexId| exact.compare_distance(&[2.0, 2.0], t.point(*v), &q).is_le();
        let around = if is_finite {
            t.tds().vertices().filter(is_around).count()
        } else {
            0
        };
        assert_eq!(t.within(&[2.0, 2.0], &q).count(), around, "{q:?}");
        let nearest = compact
            .nearest(&q, None)
            .unwrap()
            .map(|v| compact.point(v).unwrap());
        assert_eq!(nearest, naive.first().map(|&v| *t.point(v)));

        let is_outside = q.iter().any(|x| !(0.0..=4.0).contains(x));
        for location in [
            t.locate(&q, None),
            JumpAndWalk.locate(&t, &q),
            StraightLine(None).locate(&t, &q),
            hierarchy.locate(&t, &q),
            buckets.locate(&t, &q),
            compact.locate(&q, None).unwrap(),
        ] {
            match location {
                Location::Nowhere => assert!(!is_finite, "{q:?}"),
                Location::OutsideHull { .. } => assert!(is_finite && is_outside, "{q:?}"),
                Location::Cell { .. } | Location::Vertex(_) => assert!(!is_outside, "{q:?}"),
                Location::OutsideAffineHull => panic!("{q:?}"),
            }
        }
    }
}

#[test]
fn the_other_kinds() {
    for points in SETS {
        let mut basic: Basic<Plane, 3> = Basic::new(Plane::default());
        let mut constrained: Constrained<Plane> = Constrained::new(Plane::default());
        for &p in points {
            basic.insert(p).unwrap();
            constrained.insert(p).unwrap();
        }
        asks_the_complex(&basic);
        for v in vertex_numbers(&constrained) {
            for w in vertex_numbers(&constrained) {
                let is_there =
                    v != w && constrained.tds().is_vertex(v) && constrained.tds().is_vertex(w);
                assert!(
                    constrained.constrain(v, w).is_err()
                        || is_there && constrained.dimension() == 2
                        || v == w
                );
            }
            assert!(
                constrained.tds().is_vertex(v)
                    || constrained.constrained_around(v).next().is_none()
            );
            assert!(
                !constrained.release(v, VertexId::INFINITE)
                    && !constrained.release(VertexId::INFINITE, v)
            );
        }
        asks_the_complex(&constrained);
    }
}

#[test]
fn lines_and_meshes() {
    for points in SETS {
        let indices: Vec<u32> = (0..points.len() as u32).collect();
        let lines = [
            indices.clone(),
            Vec::new(),
            indices.first().copied().into_iter().collect(),
        ];
        let (mut t, _) = ConstrainedDelaunay::<Plane>::from_lines(
            Plane::default(),
            points,
            &lines,
            Default::default(),
        )
        .unwrap();
        for line in [
            t.insert_lines(&[[[6.0, 6.0], [6.0, 7.0]]]).unwrap()[0],
            LineId::new(2),
        ] {
            assert!(t.remove_line(line) && !t.remove_line(line));
        }
        asks_the_complex(&t);
        for line in (0..6)
            .map(LineId::new)
            .chain([LineId::new(LineId::LIMIT - 1)])
        {
            assert_eq!(
                t.chain(line).is_empty(),
                line.index() > 0 || points.is_empty()
            );
            assert_eq!(
                t.line_vertices(line).is_empty(),
                line.index() > 0 || points.is_empty()
            );
            assert!(t.clone().split_line(line, 9).is_none() && !t.clone().join_lines(line, line));
            for tolerance in [f64::NAN, -1.0, 0.0] {
                t.clone().simplify_line(line, tolerance);
            }
        }
        for v in vertex_numbers(&t) {
            let _ = (t.is_added(v), t.constrained_around(v).count());
            for w in vertex_numbers(&t) {
                let _ = (t.segment_chain(v, w), t.lines_through(v, w).count());
            }
        }
        assert_eq!(t.nesting().len(), t.tds().cell_slots());
        assert!(t.nesting_of([LineId::new(1), LineId::new(9)]).is_ok());
        for q in odd_positions() {
            let is_site = q.iter().all(|&x| is_ordinary(x));
            assert!(is_site || t.conflict_zone(&q, None).is_none());
        }

        for conformity in [Conformity::Delaunay, Conformity::Gabriel] {
            let mesh = t.clone().conformed(conformity);
            assert!(
                cell_numbers(&mesh)
                    .into_iter()
                    .all(|cell| !mesh.is_inside(cell) || mesh.tds().is_used(cell))
            );
        }
        for q in odd_positions() {
            let regions = vec![
                RegionBound {
                    seed: q,
                    max_area: f64::NAN,
                },
                RegionBound {
                    seed: [1.0, 1.0],
                    max_area: q[0],
                },
            ];
            let domains = [
                Domain::Hull { holes: vec![q] },
                Domain::Seeded { seeds: vec![q] },
            ];
            for domain in domains {
                let quality = Quality {
                    min_angle: q[0],
                    max_area: q[1],
                    regions: regions.clone(),
                    domain,
                    max_added: 20,
                    area_at: None,
                    cancel: None,
                };
                let mesh = t.clone().refined(&quality);
                assert!(mesh.added().len() <= 20);
                for cell in cell_numbers(&mesh) {
                    assert!(
                        !mesh.is_inside(cell)
                            || mesh.tds().is_used(cell) && !mesh.tds().is_infinite(cell)
                    );
                    assert!(mesh.region(cell).is_none() || mesh.is_inside(cell));
                }
            }
        }
    }
}

#[test]
fn weighted_points() {
    for points in SETS {
        let mut t: Regular<Weighted, 3> = Regular::new(Weighted::default());
        for (k, &[x, y]) in points.iter().enumerate() {
            t.insert([x, y, k as f64]).unwrap();
        }
        let gone =
            [[6.0, 6.0, 1.0], [-6.0, 7.0, 0.0], [2.0, -7.0, 0.0]].map(|p| t.insert(p).unwrap());
        gone.into_iter()
            .for_each(|v| assert!(t.remove(v).is_ok() && t.remove(v).is_err()));
        assert_eq!(t.check(Level::Law), []);
        let cells = (0..t.tds().cell_slots() + 3)
            .map(CellId::new)
            .chain([CellId::new(CellId::LIMIT - 1)]);
        for cell in cells {
            let is_face = t.dimension() == 2 && t.tds().is_used(cell) && !t.tds().is_infinite(cell);
            assert_eq!(t.power_center(cell).is_some(), is_face);
            for i in 0..5 {
                let is_edge = t.tds().finite_edges().any(|edge| edge == (cell, i));
                assert!(t.power_edge(cell, i).is_some() || !is_edge, "{cell:?} {i}");
                assert!(t.power_edge(cell, i).is_none() || t.dimension() == 2 || is_edge);
            }
            assert!(t.tds().is_used(cell) || t.hidden_under(cell).is_empty());
        }
        let vertices = (0..t.tds().vertex_slots() + 3)
            .map(VertexId::new)
            .chain([VertexId::INFINITE]);
        let area: f64 = vertices
            .clone()
            .map(|v| t.power_cell(v, &SQUARE).area)
            .sum();
        assert!(
            (area - if points.is_empty() { 0.0 } else { 324.0 }).abs() < 1e-9,
            "{area}"
        );
        for v in vertices {
            assert!(t.power_cell(v, &[[f64::NAN; 2]; 4]).corners.is_empty());
            assert!(t.is_hidden(v) != t.tds().is_vertex(v) || !t.is_hidden(v));
        }
        for [x, y] in odd_positions() {
            for weight in [0.0, f64::NAN, 1e300] {
                let is_site = [x, y, weight].into_iter().all(is_ordinary);
                let q = [x, y, weight];
                assert_eq!(
                    t.nearest(&q).is_some(),
                    is_site && !points.is_empty(),
                    "{q:?}"
                );
                assert_eq!(t.locate(&q, None) == Location::Nowhere, !is_site);
            }
        }
    }
}

#[test]
fn compact_triangulations() {
    for points in SETS {
        let t = &build(points);
        let mut bytes = Vec::new();
        t.write_compact(&mut bytes).unwrap();
        let compact = Compact::open(
            Plane::<breakline_triangulation::kernel::Adaptive>::default(),
            &bytes[..],
        )
        .unwrap();
        let all = |q: Point, rim: Point| -> Result<_, CompactError> {
            Ok((
                compact.nearest(&q, None)?,
                compact
                    .nearest_first(&q, None)?
                    .collect::<Result<Vec<_>, _>>()?
                    .len(),
                compact
                    .within(&q, &rim)?
                    .collect::<Result<Vec<_>, _>>()?
                    .len(),
                compact
                    .conflict_zone(&q, None)?
                    .map(|zone| zone.cells.len()),
                compact
                    .along([&q, &rim], None)?
                    .collect::<Result<Vec<_>, _>>()?
                    .len(),
                compact.within_rectangle([&q, &rim])?.len(),
            ))
        };
        for q in odd_positions() {
            for rim in [q, [0.5, 0.25], [f64::INFINITY, 0.0]] {
                let expected = (
                    t.nearest(&q, None),
                    t.nearest_first(&q, None).count(),
                    t.within(&q, &rim).count(),
                    t.conflict_zone(&q, None).map(|zone| zone.cells.len()),
                    t.along([&q, &rim], None).count(),
                    t.within_rectangle([&q, &rim]).len(),
                );
                assert_eq!(all(q, rim), Ok(expected), "{q:?} {rim:?}");
            }
        }
        for v in vertex_numbers(t) {
            let faces = compact
                .faces_from(v)
                .and_then(Iterator::collect::<Result<Vec<_>, _>>);
            let expected = if t.tds().is_vertex(v) {
                Ok(t.faces_from(v).count())
            } else {
                Err(CompactError::Vertex(v))
            };
            assert_eq!(faces.map(|faces| faces.len()), expected);
            let neighbors = compact.vertices_around(v).map(Iterator::count);
            let is_there = t.tds().is_vertex(v) || v == VertexId::INFINITE;
            assert_eq!(
                neighbors,
                if is_there || t.dimension() < 1 {
                    Ok(t.tds().degree(v))
                } else {
                    Err(CompactError::Vertex(v))
                }
            );
            for w in vertex_numbers(t) {
                let _ = (compact.edge(v, w), compact.face([v, w, VertexId::INFINITE]));
            }
        }
    }
}

#[test]
fn in_space() {
    let corners = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 1.0, 1.0],
    ];
    for count in 0..=corners.len() {
        let (t, _) = Delaunay::from_points(
            Space::<breakline_triangulation::kernel::Adaptive>::default(),
            &corners[..count],
        )
        .unwrap();
        for [x, y] in odd_positions() {
            for z in COORDINATES {
                let is_site = [x, y, z].into_iter().all(is_ordinary);
                for location in [
                    t.locate(&[x, y, z], None),
                    JumpAndWalk.locate(&t, &[x, y, z]),
                ] {
                    assert_eq!(location == Location::Nowhere, !is_site, "{x} {y} {z}");
                    assert!(is_site || location.cell(&t).is_none());
                }
            }
        }
    }
}
