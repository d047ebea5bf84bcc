//! Strategies of point location: the same answer by each, on grids where points lie on vertices,
//! edges and lines.

use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Geometry, Mapped, Plane, Space, Steps, Terrain, Weighted};
use breakline_triangulation::kernel::{Adaptive, Lattice, Wide};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::{CellId, Tds, VertexId};
use breakline_triangulation::{
    Basic, Buckets, Delaunay, Hierarchy, JumpAndWalk, Level, Locate, Location, Near, StraightLine,
    Triangulation,
};
use testkit::random::Random;

type Point = [f64; 2];
type Free = Delaunay<Plane, 3>;

/// A location independent of the cell that expresses it.
#[derive(Debug, PartialEq, Eq)]
enum Position {
    /// In the interior of what these vertices span.
    On(BTreeSet<VertexId>),
    Outside,
    OffTheFlat,
}

/// Asserts that the cells at a location are those that have all of the vertices around it.
fn judge_cells<const N: usize>(tds: &Tds<N>, location: Location, around: &BTreeSet<VertexId>) {
    let Ok(mut cells) = location.cells(tds);
    cells.sort_unstable();
    let has_all = |cell: &CellId| around.iter().all(|v| tds.cell_vertices(*cell).contains(v));
    assert!(
        cells.into_iter().eq(tds.cells().filter(has_all)),
        "{location:?}"
    );
}

/// Returns the position, and asserts that it is correct.
fn position<G: Geometry<3, Point = Point>>(
    t: &Triangulation<G, 3>,
    location: Location,
    q: Point,
) -> Position {
    let tds: &Tds<3> = t.tds();
    let plane = Plane::<breakline_triangulation::kernel::Exact>::default();
    match location {
        Location::Vertex(vertex) => {
            assert_eq!(*t.point(vertex), q);
            judge_cells(t.tds(), location, &[vertex].into());
            Position::On([vertex].into())
        }
        Location::Cell { cell, facets } => {
            let corners = tds.cell_vertices(cell);
            let spanned = corners
                .iter()
                .enumerate()
                .filter(|(i, _)| !facets.contains(*i))
                .map(|(_, &v)| v);
            for i in (0..3).filter(|_| t.dimension() == 2) {
                let mut simplex = [0, 1, 2].map(|k| t.point(corners[k]));
                simplex[i] = &q;
                let expected = if facets.contains(i) {
                    Sign::Zero
                } else {
                    Sign::Positive
                };
                assert_eq!(plane.orientation(simplex), expected);
            }
            let spanned: BTreeSet<VertexId> = spanned.collect();
            judge_cells(t.tds(), location, &spanned);
            Position::On(spanned)
        }
        Location::OutsideHull { cell } => {
            let infinite = tds.index_of(cell, VertexId::INFINITE).unwrap();
            if t.dimension() == 2 {
                let [a, b] = tds.edge_ends(cell, infinite).map(|v| t.point(v));
                assert_eq!(
                    plane.orientation([a, b, &q]),
                    Sign::Positive,
                    "in sight of the hull edge"
                );
            }
            Position::Outside
        }
        Location::OutsideAffineHull => Position::OffTheFlat,
        Location::Nowhere => panic!("{q:?} is a position"),
    }
}

/// Asserts that every strategy agrees with the default one.
fn same_by_all(
    t: &Free,
    hierarchy: &Hierarchy<Plane, 3>,
    buckets: &Buckets,
    start: Option<VertexId>,
    q: Point,
) {
    let expected = position(t, t.locate(&q, None), q);
    let near = Near(
        start
            .filter(|&v| t.tds().is_vertex(v))
            .and_then(|v| t.tds().cell_of(v)),
    );
    let found = [
        near.locate(t, &q),
        JumpAndWalk.locate(t, &q),
        StraightLine(None).locate(t, &q),
        StraightLine(start).locate(t, &q),
        hierarchy.locate(t, &q),
        buckets.locate(t, &q),
    ];
    for (k, location) in found.into_iter().enumerate() {
        assert_eq!(
            position(t, location, q),
            expected,
            "strategy {k}, {q:?} in {:?}",
            t.points()
        );
    }
}

fn tiny(random: &mut Random, side: u64) -> Point {
    [random.below(side) as f64, random.below(side) as f64]
}

#[test]
fn tiny_grids_that_grow_and_shrink() {
    let mut random = Random(11);
    for round in 0..300 {
        let side = 1 + random.below(6);
        let (mut t, mut hierarchy) = (
            Free::new(Plane::default()),
            Hierarchy::new(Plane::default()),
        );
        let mut buckets = Buckets::over([[0.0; 2], [side as f64; 2]], 1 + round % 9);
        for _ in 0..60 {
            let p = tiny(&mut random, side);
            if random.below(3) > 0 {
                let vertex = t.insert_by(&mut hierarchy, p, ()).unwrap().vertex;
                buckets.inserted(t.geometry(), vertex, &p);
            } else if let Location::Vertex(vertex) = t.locate(&p, None) {
                // Half of the time the hierarchy is not notified.
                let is_reported = random.below(2) == 0;
                let removed = if is_reported {
                    t.remove_by(&mut hierarchy, vertex)
                } else {
                    t.remove(vertex)
                };
                assert_eq!(removed, Ok(p));
            }
            for _ in 0..4 {
                let q = tiny(&mut random, 2 * side + 1).map(|x| x - 0.5 * side as f64);
                let start = (t.tds().vertex_slots() > 0)
                    .then(|| VertexId::new(random.index(t.tds().vertex_slots())));
                same_by_all(&t, &hierarchy, &buckets, start, q);
            }
        }
        assert_eq!(t.check(Level::Law), []);
    }
}

/// On vertices, edges and faces of tetrahedra, inside and outside of them.
#[test]
fn cells_at_points_in_space() {
    let mut random = Random(9);
    let mut seen = [0; 5];
    for _ in 0..60 {
        let mut draw = || {
            [
                random.below(3) as f64,
                random.below(3) as f64,
                random.below(3) as f64,
            ]
        };
        let points: Vec<[f64; 3]> = (0..12).map(|_| draw()).collect();
        let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
        for q in (0..20).map(|_| draw().map(|x| x * 0.75)) {
            let location = t.locate(&q, None);
            let around: BTreeSet<VertexId> = match location {
                Location::Vertex(vertex) => [vertex].into(),
                Location::Cell { cell, facets } => {
                    let corners = t.tds().cell_vertices(cell).iter().enumerate();
                    corners
                        .filter(|(i, _)| !facets.contains(*i))
                        .map(|(_, &v)| v)
                        .collect()
                }
                _ => {
                    assert_eq!(location.cells(t.tds()), Ok(Vec::new()));
                    continue;
                }
            };
            judge_cells(t.tds(), location, &around);
            assert_eq!(
                location.facets().count() + around.len(),
                if location.vertex().is_some() { 1 } else { 4 }
            );
            seen[around.len()] += 1;
        }
    }
    assert!(seen[1..].iter().all(|&count| count > 5), "{seen:?}");
}

#[test]
fn thousands_of_points() {
    let mut random = Random(12);
    let sets: [Vec<Point>; 3] = [
        (0..20_000)
            .map(|_| [random.unit(), random.unit()])
            .collect(),
        (0..20_000)
            .map(|_| random.unit() - 0.5)
            .map(|x| [x, x * x])
            .collect(),
        (0..20_000)
            .map(|i| [f64::from(i % 200), f64::from(i / 200)])
            .collect(),
    ];
    for points in sets {
        let (t, _) = Free::from_points(Plane::default(), &points).unwrap();
        let (hierarchy, buckets) = (Hierarchy::of(Plane::default(), &t), Buckets::of(&t));
        let mut one_by_one = (
            Free::new(Plane::default()),
            Hierarchy::new(Plane::default()),
        );
        for &p in &points {
            one_by_one.0.insert_by(&mut one_by_one.1, p, ()).unwrap();
        }
        assert_eq!(one_by_one.0.check(Level::Law), []);
        for _ in 0..2000 {
            let q = random
                .pick(&points)
                .map(|x| x + (random.below(3) as f64 - 1.0) * 0.5);
            let start = VertexId::new(random.index(points.len()));
            same_by_all(&t, &hierarchy, &buckets, Some(start), q);
            same_by_all(&one_by_one.0, &one_by_one.1, &buckets, Some(start), q);
        }
    }
}

/// The samples of the hierarchy follow the vertices: removed vertices leave nothing behind.
#[test]
fn numbers_used_again() {
    let mut random = Random(13);
    let (mut t, mut hierarchy) = (
        Free::new(Plane::default()),
        Hierarchy::<Plane, 3>::new(Plane::default()),
    );
    for _ in 0..5 {
        let mut vertices: Vec<VertexId> = (0..3000)
            .map(|_| [random.unit(), random.unit()])
            .map(|p| t.insert_by(&mut hierarchy, p, ()).unwrap().vertex)
            .collect();
        random.shuffle(&mut vertices);
        for vertex in vertices {
            let p = *t.point(vertex);
            assert_eq!(hierarchy.locate(&t, &p), Location::Vertex(vertex));
            assert_eq!(t.remove_by(&mut hierarchy, vertex), Ok(p));
        }
        assert_eq!(hierarchy.sample_sizes().sum::<usize>(), 0);
    }
}

/// A grid over a tiny box has no more squares than any other.
#[test]
fn buckets_of_any_size() {
    for size in [0.0, 1e-300, 1e-170, 1.0, 1e200] {
        let points = [[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]];
        let mut buckets = Buckets::over([points[0], points[2]], 1 << 10);
        let mut t: Delaunay<Plane<Wide>, 3> = Delaunay::new(Plane::default());
        for p in points {
            t.insert_by(&mut buckets, p, ()).unwrap();
        }
        assert!(
            points
                .iter()
                .all(|p| matches!(buckets.locate(&t, p), Location::Vertex(_)))
        );
    }
}

type Sides<'a> = &'a dyn Fn([&Point; 3], &Point) -> Option<[f64; 3]>;

/// The plane, with rounded sides of a test's own that direct walks. One type for all tests, so that
/// triangulations are compiled once.
#[derive(Clone, Copy)]
struct RoughSides<'a>(Sides<'a>);

impl Geometry<3> for RoughSides<'_> {
    type Point = Point;

    fn admits(&self, p: &Point) -> bool {
        Plane::<Adaptive>::default().admits(p)
    }

    fn compare(&self, p: &Point, q: &Point) -> Ordering {
        Plane::<Adaptive>::default().compare(p, q)
    }

    fn orientation(&self, simplex: [&Point; 3]) -> Sign {
        ASKED.set(ASKED.get() + 1);
        Plane::<Adaptive>::default().orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&Point; 3], q: &Point) -> Sign {
        ASKED.set(ASKED.get() + 1);
        Plane::<Adaptive>::default().side_of_sphere(simplex, q)
    }

    fn rough_distance(&self, p: &Point, q: &Point) -> Option<f64> {
        Plane::<Adaptive>::default().rough_distance(p, q)
    }

    fn rough_sides(&self, simplex: [&Point; 3], q: &Point) -> Option<[f64; 3]> {
        ASKED.set(ASKED.get() + 1);
        (self.0)(simplex, q)
    }
}

/// Returns the rounded sides of the plane.
fn rightly(simplex: [&Point; 3], q: &Point) -> Option<[f64; 3]> {
    Plane::<Adaptive>::default().rough_sides(simplex, q)
}

/// Contradicts itself about [`NOWHERE`](Self::NOWHERE): it lies outside of any triangle, and beyond
/// no edge of the hull. A straight line that leads there goes around [`PIVOT`](Self::PIVOT).
#[derive(Clone, Copy)]
struct Contradictory;

impl Contradictory {
    const NOWHERE: Point = [0.5, 0.25];
    const START: Point = [2.0, 1.0];
    const PIVOT: Point = [2.0, 2.0];
    /// The vertices are the sites of a lattice, and the corners of a square with this largest
    /// coordinate: no triangle has two edges of the hull.
    const REACH: f64 = 10.0;
}

impl Geometry<3> for Contradictory {
    type Point = Point;

    fn admits(&self, p: &Point) -> bool {
        Plane::<Adaptive>::default().admits(p)
    }

    fn compare(&self, p: &Point, q: &Point) -> Ordering {
        Plane::<Adaptive>::default().compare(p, q)
    }

    fn orientation(&self, simplex: [&Point; 3]) -> Sign {
        let others: Vec<&Point> = simplex
            .into_iter()
            .filter(|&p| *p != Self::NOWHERE)
            .collect();
        let [p, q] = others[..] else {
            return Plane::<Adaptive>::default().orientation(simplex);
        };
        ASKED.set(ASKED.get() + 1);
        assert!(ASKED.get() < 100_000, "goes around forever");
        if (0..2).any(|k| p[k] == q[k] && p[k].abs() == Self::REACH) {
            Plane::<Adaptive>::default().orientation(simplex)
        } else if simplex.map(|p| *p) == [Self::START, Self::NOWHERE, Self::PIVOT] {
            Sign::Positive
        } else {
            Sign::Negative
        }
    }

    fn side_of_sphere(&self, simplex: [&Point; 3], q: &Point) -> Sign {
        Plane::<Adaptive>::default().side_of_sphere(simplex, q)
    }
}

/// Walks end even if predicates contradict each other, as those of bare floating point may.
#[test]
fn contradictions_end() {
    type Contradicting = Delaunay<Contradictory, 3>;
    let mut t = Contradicting::new(Contradictory);
    for k in 0..25 {
        t.insert([k % 5, k / 5].map(f64::from)).unwrap();
    }
    for k in 0..4 {
        let corner = [k % 2, k / 2].map(|k| (2.0 * f64::from(k) - 1.0) * Contradictory::REACH);
        t.insert(corner).unwrap();
    }
    let start = t.locate(&Contradictory::START, None).vertex();
    ASKED.set(0);
    let q = &Contradictory::NOWHERE;
    let found = [
        t.locate(q, None),
        JumpAndWalk.locate(&t, q),
        StraightLine(start).locate(&t, q),
    ];
    for location in found {
        assert!(
            location.cell(&t).is_some_and(|cell| t.tds().is_used(cell)),
            "{location:?}"
        );
    }
    assert!(ASKED.get() > 3_000, "nothing went around");
}

thread_local!(static ASKED: Cell<usize> = const { Cell::new(0) });

/// Returns the number of predicates for each of some points that are inserted in pseudo-random
/// order, without a strategy.
fn asked_one_by_one(position: impl Fn(f64) -> Point) -> usize {
    const COUNT: usize = 20_000;
    let mut random = Random(31);
    let mut t = Delaunay::<_, 3>::new(RoughSides(&rightly));
    ASKED.set(0);
    for _ in 0..COUNT {
        t.insert(position(random.unit())).unwrap();
    }
    ASKED.get() / COUNT
}

/// A walk along a curve has to pass all vertices in between.
#[test]
fn walks_along_curves_are_cut_short() {
    let other = std::cell::RefCell::new(Random(32));
    let spread = asked_one_by_one(|x| [x, other.borrow_mut().unit()]);
    let parabola = asked_one_by_one(|x| [x - 0.5, (x - 0.5).powi(2)]);
    let spiral = asked_one_by_one(|x| {
        [
            x.sqrt() * (40.0 * x.sqrt()).cos(),
            x.sqrt() * (40.0 * x.sqrt()).sin(),
        ]
    });
    assert!(spread < 300, "{spread} questions a point in a square");
    for curved in [parabola, spiral] {
        assert!(
            curved < 3 * spread,
            "{curved} questions a point on a curve, {spread} in a square"
        );
    }
}

/// Rounded numbers lead across long edges first, and from far outside of a curve all long edges
/// lead along it: a walk that did not look for an exit from the hull would pass all vertices.
#[test]
fn walks_from_a_curve_look_for_an_exit() {
    const COUNT: usize = 20_000;
    let mut random = Random(36);
    let (mut t, mut hierarchy) = (
        Delaunay::<_, 3>::new(RoughSides(&rightly)),
        Hierarchy::new(RoughSides(&rightly)),
    );
    for _ in 0..COUNT {
        let x = random.unit() - 0.5;
        t.insert_by(&mut hierarchy, [x, x * x], ()).unwrap();
    }
    ASKED.set(0);
    for _ in 0..1000 {
        hierarchy.locate(&t, &[0, 1].map(|_| 2e6 * (random.unit() - 0.5)));
    }
    let asked = ASKED.get() / 1000;
    assert!(
        asked < 200,
        "{asked} questions for a position far outside of {COUNT} points"
    );
}

/// Whatever rounded numbers say, the answer is the same: with the Delaunay law, and without any.
fn same_for_any_rough_sides(sides: Sides<'_>) {
    let mut random = Random(33);
    for round in 0..40 {
        let side = 2 + round % 12;
        let (mut t, mut rough) = (
            Free::new(Plane::default()),
            Delaunay::<_, 3>::new(RoughSides(sides)),
        );
        let (mut lazy, mut lazy_rough) = (
            Basic::<Plane, 3>::new(Plane::default()),
            Basic::new(RoughSides(sides)),
        );
        let mut hierarchy = Hierarchy::new(RoughSides(sides));
        for _ in 0..side * side {
            let p = tiny(&mut random, side);
            assert_eq!(
                rough
                    .insert_by(&mut hierarchy, p, ())
                    .map(|inserted| inserted.vertex),
                t.insert(p)
            );
            assert_eq!(lazy_rough.insert(p), lazy.insert(p));
        }
        assert_eq!(rough.check(Level::Law), []);
        for _ in 0..100 {
            let q = tiny(&mut random, 4 * side).map(|x| 0.5 * x - 0.5 * side as f64);
            let expected = position(&t, t.locate(&q, None), q);
            let start = random.pick(&rough.tds().cells().collect::<Vec<_>>());
            for location in [rough.locate(&q, Some(start)), hierarchy.locate(&rough, &q)] {
                assert_eq!(
                    position(&rough, location, q),
                    expected,
                    "{q:?} in {:?}",
                    t.points()
                );
            }
            let start = random.pick(&lazy_rough.tds().cells().collect::<Vec<_>>());
            position(&lazy_rough, lazy_rough.locate(&q, Some(start)), q);
        }
    }
}

#[test]
fn rounded_numbers_change_no_answer() {
    let dice = Cell::new(34);
    let thrown = || {
        let mut random = Random(dice.get());
        let number = random.pick(&[-1.0, 0.0, 1.0, f64::NAN, f64::INFINITY, -f64::INFINITY]);
        dice.set(random.0);
        number
    };
    same_for_any_rough_sides(&|_, _| None);
    same_for_any_rough_sides(&|_, _| Some([f64::NAN; 3]));
    same_for_any_rough_sides(&|_, _| Some([1.0; 3])); // always there
    same_for_any_rough_sides(&|_, _| Some([-1.0, 1.0, 1.0])); // always over the same edge
    same_for_any_rough_sides(&|simplex, q| rightly(simplex, q).map(|sides| sides.map(|x| -x))); // away
    same_for_any_rough_sides(&|_, _| Some([thrown(), thrown(), thrown()]));
}

/// Small whole numbers are not rounded: the signs of the sides are those of the orientations.
fn sides_are_right<G: Geometry<N>, const N: usize>(
    geometry: &G,
    mut point: impl FnMut() -> G::Point,
) {
    for _ in 0..2000 {
        let simplex: [G::Point; N] = std::array::from_fn(|_| point());
        let q = point();
        let sides = geometry.rough_sides(simplex.each_ref(), &q).unwrap();
        for (i, side) in sides.into_iter().enumerate() {
            let mut moved = simplex.each_ref();
            moved[i] = &q;
            assert_eq!(
                Sign::of(&side),
                geometry.orientation(moved),
                "{i} of {simplex:?}, {q:?}"
            );
        }
    }
}

#[test]
fn rounded_sides_are_those_of_each_geometry() {
    let random = std::cell::RefCell::new(Random(35));
    let whole = || random.borrow_mut().below(7) as f64;
    sides_are_right(&Plane::<Adaptive>::default(), || [whole(), whole()]);
    sides_are_right(&Terrain::<Adaptive>::default(), || {
        [whole(), whole(), whole()]
    });
    sides_are_right(&Weighted::<Adaptive>::default(), || {
        [whole(), whole(), whole()]
    });
    sides_are_right(&Steps::<Lattice>::default(), || {
        [whole() as i32, whole() as i32, whole() as i32]
    });
    sides_are_right(&Mapped::new(|p: &[f64; 2]| [p[1], -p[0]]), || {
        [whole(), whole()]
    });
    sides_are_right(&Space::<Adaptive>::default(), || {
        [whole(), whole(), whole()]
    });
}
