//! Points of a constrained Delaunay triangulation: inserted, moved and removed among lines that
//! come and go. After each edit the triangulation is that of building anew, and each payload is at
//! the vertex to which it was given.

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::Adaptive;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    ConstrainedDelaunay, Hierarchy, Inserted, Level, LineId, MoveError, OnCrossing, PointError,
    RemovalError,
};
use testkit::random::Random;

type Point = [f64; 2];
type Site = [u64; 2];

fn site(p: &Point) -> Site {
    p.map(|x| (x + 0.0).to_bits())
}

/// Edges as pairs of sites, with the constrained ones apart; and the chains of lines.
type Seen = (BTreeSet<[Site; 2]>, BTreeSet<[Site; 2]>, Vec<Vec<Site>>);

fn seen<V: Default>(t: &ConstrainedDelaunay<Plane, V>, lines: &[LineId]) -> Seen {
    let at = |v: VertexId| site(t.point(v));
    let sorted = |ends: [VertexId; 2]| {
        let mut ends = ends.map(at);
        ends.sort_unstable();
        ends
    };
    let cells = t
        .finite_cells()
        .flat_map(|cell| (0..3).map(move |i| (cell, i)));
    let edges = cells
        .filter(|_| t.dimension() == 2)
        .map(|(cell, i)| sorted(t.tds().edge_ends(cell, i)));
    let chains = lines
        .iter()
        .map(|&line| t.chain(line).into_iter().map(at).collect());
    (
        edges.collect(),
        t.constrained_edges().map(sorted).collect(),
        chains.collect(),
    )
}

/// What was given, and what is expected of it.
#[derive(Default)]
struct Model {
    /// The payload of each given vertex; 0 if the vertex was that of lines before.
    given: BTreeMap<VertexId, (Point, u32)>,
    lines: Vec<(LineId, Vec<Point>)>,
}

impl Model {
    fn insert(&mut self, p: Point, data: u32, Inserted { vertex, unused }: Inserted<u32>) {
        assert!(unused.is_none_or(|unused| unused == data));
        let payload = if unused.is_none() { data } else { 0 };
        let (at, _) = *self.given.entry(vertex).or_insert((p, payload));
        assert_eq!(site(&at), site(&p));
    }

    fn judge(&self, t: &ConstrainedDelaunay<Plane, u32>) {
        assert_eq!(t.check(Level::Law), []);
        let mut points: Vec<Point> = self.given.values().map(|(p, _)| *p).collect();
        let mut indexed: Vec<Vec<u32>> = Vec::new();
        for (_, line) in &self.lines {
            indexed.push((0..).skip(points.len()).take(line.len()).collect());
            points.extend(line);
        }
        let (anew, _) = ConstrainedDelaunay::from_lines(
            Plane::<_>::default(),
            &points,
            &indexed,
            OnCrossing::Split,
        )
        .unwrap();
        let ids: Vec<LineId> = self.lines.iter().map(|(id, _)| *id).collect();
        assert_eq!(
            seen(t, &ids),
            seen(&anew, &anew.lines().collect::<Vec<_>>()),
            "{points:?} {indexed:?}"
        );
        assert_eq!(t.vertex_count(), anew.vertex_count());
        for v in t.tds().vertices() {
            let (at, data) = self.given.get(&v).copied().unwrap_or((*t.point(v), 0));
            assert_eq!(
                (site(t.point(v)), *t.tds().vertex_data(v)),
                (site(&at), data),
                "{v:?}"
            );
        }
    }
}

#[test]
fn payloads_and_numbers_stay_where_they_belong() {
    let mut random = Random(71);
    let (mut moved, mut at_crossings) = (0, 0);
    for _ in 0..120 {
        let side = 3 + random.below(5);
        let mut t = ConstrainedDelaunay::<Plane, u32>::with_capacity(Plane::default(), 20);
        let mut model = Model::default();
        let mut strategy = Hierarchy::new(Plane::<Adaptive>::default());
        for next in 1..40 {
            let mut p: Point = [random.below(side) as f64, random.below(side) as f64];
            if random.below(4) == 0 && !t.crossings().is_empty() {
                p = *t.point(random.pick(t.crossings()));
            }
            let vertices: Vec<VertexId> = t.tds().vertices().collect();
            match random.below(8) {
                0 => model.insert(p, next, t.insert_with(p, next).unwrap()),
                1 => {
                    let near = vertices.first().and_then(|&v| t.tds().cell_of(v));
                    model.insert(p, next, t.insert_near(p, next, near).unwrap());
                }
                2 => model.insert(p, next, t.insert_by(&mut strategy, p, next).unwrap()),
                3 | 4 if !vertices.is_empty() => {
                    let vertex = random.pick(&vertices);
                    let there = vertices
                        .iter()
                        .copied()
                        .find(|&v| site(t.point(v)) == site(&p));
                    let is_free =
                        t.constrained_around(vertex).next().is_none() && t.dimension() == 2;
                    let anew = t.rearrangements();
                    match t.move_to(vertex, p) {
                        Ok(to) if to == vertex && there == Some(vertex) => {}
                        Ok(to) => {
                            let (_, data) = model.given.remove(&vertex).unwrap();
                            // A crossing there may have left together with the vertex.
                            let is_new =
                                there != Some(to) || data != 0 && *t.tds().vertex_data(to) == data;
                            model.insert(
                                p,
                                data,
                                Inserted {
                                    vertex: to,
                                    unused: (!is_new).then_some(data),
                                },
                            );
                            assert!(
                                !(is_new && is_free && t.rearrangements() == anew) || to == vertex,
                                "{p:?}"
                            );
                            moved += 1;
                        }
                        Err(MoveError::Vertex(RemovalError::Crossing)) => {
                            assert!(t.is_added(vertex))
                        }
                        Err(error) => {
                            let MoveError::Vertex(RemovalError::Line(line)) = error else {
                                panic!("{error}")
                            };
                            assert!(t.line_vertices(line).contains(&vertex));
                        }
                    }
                }
                5 if !vertices.is_empty() => {
                    let vertex = random.pick(&vertices);
                    if t.remove_by(&mut strategy, vertex).is_ok() {
                        model.given.remove(&vertex);
                        at_crossings += usize::from(t.is_added(vertex));
                    }
                }
                6 if model.lines.len() > 6 => {
                    let (line, _) = model.lines.swap_remove(random.index(model.lines.len()));
                    assert!(t.remove_line(line));
                }
                _ => {
                    let line = vec![p, [random.below(side) as f64, random.below(side) as f64]];
                    model.lines.extend(
                        t.insert_lines(&[&line])
                            .unwrap()
                            .into_iter()
                            .map(|id| (id, line.clone())),
                    );
                }
            }
            model.judge(&t);
        }
    }
    assert!(
        moved > 100 && at_crossings > 5,
        "{moved} moves, {at_crossings} removals of points on crossings"
    );
}

/// Many points at once, among lines that cross, some of them on crossings and on segments.
#[test]
fn many_points_among_lines() {
    let mut random = Random(72);
    for _ in 0..200 {
        let mut draw = || -> Point { [random.below(6) as f64, random.below(6) as f64] };
        let ends: Vec<Point> = (0..12).map(|_| draw()).collect();
        let more: Vec<Point> = (0..20).map(|_| draw()).collect();
        let lines: Vec<[u32; 2]> = (0..6).map(|k| [2 * k, 2 * k + 1]).collect();
        let built = |points: &[Point]| {
            ConstrainedDelaunay::from_lines(
                Plane::<_>::default(),
                points,
                &lines,
                OnCrossing::Split,
            )
            .unwrap()
            .0
        };
        let mut t = built(&ends);
        let vertices = t.insert_all(&more).unwrap();
        assert!(
            vertices
                .iter()
                .zip(&more)
                .all(|(&v, p)| t.point(v) == p && !t.is_added(v))
        );
        assert_eq!(t.check(Level::Law), []);
        assert!(t.rearrangements() <= 1);
        let anew = built(&[ends, more].concat());
        assert_eq!(
            seen(&t, &t.lines().collect::<Vec<_>>()),
            seen(&anew, &anew.lines().collect::<Vec<_>>())
        );
        assert_eq!(t.vertex_count(), anew.vertex_count());
    }
    let mut t = ConstrainedDelaunay::new(Plane::new());
    assert!(t.insert_all(&[[0.0, 0.0], [f64::NAN, 0.0]]).is_err() && t.vertex_count() == 0);
}

/// The first point on a site gives the payload; crossings have the default one.
#[test]
fn payloads_come_with_points() {
    let points = [
        [0.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [1.0, 3.0],
    ];
    let mut asked = Vec::new();
    let payload = |k: usize| {
        asked.push(k);
        k as u32 + 10
    };
    let geometry: Plane = Plane::new();
    let (t, v) = ConstrainedDelaunay::from_lines_with(
        geometry,
        &points,
        &[[0, 1], [2, 3]],
        OnCrossing::Split,
        payload,
    )
    .unwrap();
    assert_eq!(
        v.iter()
            .map(|&v| *t.tds().vertex_data(v))
            .collect::<Vec<_>>(),
        [10, 11, 12, 13, 11, 15]
    );
    assert_eq!(
        t.crossings()
            .iter()
            .map(|&v| *t.tds().vertex_data(v))
            .collect::<Vec<_>>(),
        [0]
    );
    assert_eq!(asked, [0, 1, 2, 3, 5]);

    let mut t = t.with_vertex_data(|v| (v.index() + 1).to_string());
    assert!(
        t.tds()
            .vertices()
            .all(|v| *t.tds().vertex_data(v) == (v.index() + 1).to_string())
    );
    t.vertex_data_mut(v[5]).push('!');
    let moved = t.move_to(v[5], [3.0, 2.0]).unwrap();
    assert!(t.tds().vertex_data(moved).ends_with('!'));
    assert_eq!(
        t.insert_with([f64::NAN, 0.0], String::new()),
        Err(PointError::NotFinite)
    );
    assert_eq!(t.check(Level::Law), []);

    let (t, v) = ConstrainedDelaunay::from_points_with(geometry, &points, |k| k).unwrap();
    assert_eq!(
        v.iter()
            .map(|&v| *t.tds().vertex_data(v))
            .collect::<Vec<_>>(),
        [0, 1, 2, 3, 1, 5]
    );
}
