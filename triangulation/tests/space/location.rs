//! Strategies of point location in space: the same answer by each, on grids where points lie on
//! vertices, edges, facets and lines.

use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Geometry, Space, WeightedSpace};
use breakline_triangulation::kernel::{Exact, Wide};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    Basic, Buckets, Delaunay, JumpAndWalk, Level, Locate, Location, Near, Regular, SpacePassage,
    StraightLine, Triangulation,
};
use testkit::random::Random;

use crate::TINY;

type Point = [f64; 3];

/// A location independent of the cell that expresses it.
#[derive(Debug, PartialEq, Eq)]
enum Position {
    /// In the interior of what these vertices span.
    On(BTreeSet<VertexId>),
    Outside,
    OffTheFlat,
}

/// Returns the position, and asserts that it is correct.
fn position<G: Geometry<4, Point = Point>, C: Copy + Default>(
    t: &Triangulation<G, 4, (), C>,
    location: Location,
    q: Point,
) -> Position {
    let exact = Space::<Exact>::default();
    match location {
        Location::Vertex(vertex) => {
            assert_eq!(*t.point(vertex), q);
            Position::On([vertex].into())
        }
        Location::Cell { cell, facets } => {
            for i in (0..4).filter(|_| t.dimension() == 3) {
                let mut simplex = t.cell_points(cell).unwrap();
                simplex[i] = &q;
                let expected = if facets.contains(i) {
                    Sign::Zero
                } else {
                    Sign::Positive
                };
                assert_eq!(exact.orientation(simplex), expected);
            }
            let corners = t.tds().cell_vertices(cell).iter().enumerate();
            Position::On(
                corners
                    .filter(|(i, _)| !facets.contains(*i))
                    .map(|(_, &v)| v)
                    .collect(),
            )
        }
        Location::OutsideHull { cell } => {
            let infinite = t.tds().index_of(cell, VertexId::INFINITE).unwrap();
            if t.dimension() == 3 {
                let simplex: [&Point; 4] = std::array::from_fn(|i| {
                    if i == infinite {
                        &q
                    } else {
                        t.point(t.tds().vertex(cell, i))
                    }
                });
                assert_eq!(
                    exact.orientation(simplex),
                    Sign::Positive,
                    "in sight of the facet of the hull"
                );
            }
            Position::Outside
        }
        Location::OutsideAffineHull => Position::OffTheFlat,
        Location::Nowhere => panic!("{q:?} is a position"),
    }
}

/// Asserts that every strategy agrees with the default one.
fn same_by_all<C: Copy + Default>(
    t: &Triangulation<Space<Wide>, 4, (), C>,
    buckets: &Buckets,
    start: Option<VertexId>,
    q: Point,
) -> Position {
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
        buckets.locate(t, &q),
        Buckets::of(t).locate(t, &q),
    ];
    for (k, location) in found.into_iter().enumerate() {
        assert_eq!(
            position(t, location, q),
            expected,
            "strategy {k}, {q:?} in {:?}",
            t.points()
        );
    }
    expected
}

#[test]
fn small_grids_that_grow_and_shrink() {
    let mut random = Random(51);
    let mut seen = [0; 6];
    for round in 0..60 {
        let sizes = [[3, 3, 3], [4, 4, 1], [6, 1, 1], [4, 3, 2], [2, 2, 2]][round % 5];
        let scale = [1.0, TINY, 2f64.powi(1010)][round % 3];
        let mut t = Delaunay::<Space<Wide>, 4>::new(Space::default());
        let mut basic = Basic::<Space<Wide>, 4>::new(Space::default());
        let mut buckets = Buckets::over(
            [[0.0; 3], sizes.map(|size| size as f64 * scale)],
            1 + round % 9,
        );
        for _ in 0..40 {
            let p = sizes.map(|size| random.below(size) as f64 * scale);
            if random.below(5) > 0 {
                let vertex = t.insert_by(&mut buckets, p, ()).unwrap().vertex;
                assert_eq!(*t.point(vertex), p);
                basic.insert(p).unwrap();
            } else if let Location::Vertex(vertex) = t.locate(&p, None) {
                assert_eq!(t.remove(vertex), Ok(p));
            }
            for _ in 0..3 {
                let q = sizes.map(|size| (random.below(4 * size) as f64 * 0.25 - 0.5) * scale);
                let start = (t.tds().vertex_slots() > 0)
                    .then(|| VertexId::new(random.index(t.tds().vertex_slots())));
                match same_by_all(&t, &buckets, start, q) {
                    Position::On(corners) => seen[corners.len() - 1] += 1,
                    Position::Outside => seen[4] += 1,
                    Position::OffTheFlat => seen[5] += 1,
                }
                same_by_all(&basic, &buckets, start, q);
            }
        }
        assert_eq!(t.check(Level::Law), []);
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

#[test]
fn of_a_regular_triangulation() {
    let mut random = Random(52);
    for _ in 0..40 {
        let mut draw = || [0; 4].map(|_| random.below(5) as f64);
        let points: Vec<[f64; 4]> = (0..30).map(|_| draw()).collect();
        let (t, _) = Regular::<_, 4>::from_points(<WeightedSpace>::new(), &points).unwrap();
        let buckets = Buckets::of(&t);
        for _ in 0..20 {
            let q = draw();
            let start = t.tds().vertices().nth(q[3] as usize);
            let cells = |location: Location| {
                let Ok(cells) = location.cells(t.tds());
                BTreeSet::from_iter(cells)
            };
            let expected = cells(t.locate(&q, None));
            assert_eq!(cells(StraightLine(start).locate(&t, &q)), expected);
            assert_eq!(cells(buckets.locate(&t, &q)), expected);
        }
    }
}

/// Space, with orientations counted, and without numbers that direct walks.
#[derive(Debug, Clone, Copy, Default)]
struct Counting(Space);

thread_local!(static ASKED: Cell<usize> = const { Cell::new(0) });

impl Geometry<4> for Counting {
    type Point = Point;

    fn admits(&self, p: &Point) -> bool {
        self.0.admits(p)
    }

    fn compare(&self, p: &Point, q: &Point) -> Ordering {
        self.0.compare(p, q)
    }

    fn orientation(&self, simplex: [&Point; 4]) -> Sign {
        ASKED.set(ASKED.get() + 1);
        self.0.orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&Point; 4], q: &Point) -> Sign {
        self.0.side_of_sphere(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&Point]) -> Sign {
        self.0.orientation_in_flat(simplex)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&Point], q: &Point) -> Sign {
        self.0.side_of_sphere_in_flat(simplex, q)
    }
}

impl breakline_triangulation::geometry::Coordinates<4> for Counting {
    type Coordinates = Point;

    fn coordinates(&self, p: &Point) -> Point {
        *p
    }

    fn exact_site(&self, p: &Point) -> Option<[f64; 4]> {
        self.0.exact_site(p)
    }
}

/// A straight line takes four orientations for each cell that it meets, and some more at its ends
/// and where it meets an edge or a vertex, as it does on a lattice. From a bucket it is not far.
#[test]
fn thousands_of_points() {
    let mut random = Random(53);
    let uniform: Vec<Point> = (0..20_000).map(|_| [0; 3].map(|_| random.unit())).collect();
    let lattice: Vec<Point> = (0..8000)
        .map(|k| [k / 400, k / 20 % 20, k % 20].map(f64::from))
        .collect();
    for (points, most) in [(uniform, [60, 60]), (lattice, [120, 20])] {
        let (t, v) = Delaunay::<_, 4>::from_points(Counting::default(), &points).unwrap();
        let buckets = Buckets::of(&t);
        assert_eq!(t.dimension(), 3);
        let (mut asked, mut cells) = ([0; 2], 0);
        for _ in 0..300 {
            let [p, q] = [0; 2].map(|_| random.index(points.len()));
            let q = [0, 1, 2].map(|k| (points[p][k] + points[q][k]) / 2.0);
            let start = random.pick(&v);
            let expected = position(&t, t.locate(&q, None), q);
            let met = t.along([t.point(start), &q], None);
            cells += met
                .filter(|passage| matches!(passage, SpacePassage::Cell(_)))
                .count();
            ASKED.set(0);
            let straight = StraightLine(Some(start)).locate(&t, &q);
            asked[0] += ASKED.replace(0);
            let bucket = buckets.locate(&t, &q);
            asked[1] += ASKED.get();
            assert_eq!(position(&t, straight, q), expected);
            assert_eq!(position(&t, bucket, q), expected);
        }
        assert!(
            (4 * cells..4 * cells + 300 * most[0]).contains(&asked[0]),
            "{} for {cells} cells",
            asked[0]
        );
        assert!(asked[1] < 300 * most[1], "{} from buckets", asked[1]);
    }
}

/// A grid over a tiny, flat or huge box has no more buckets than any other.
#[test]
fn buckets_of_any_size() {
    let lengths = [0.0, 5e-324, 1e-170, 1.0, 1e200, 1.7e308];
    for size in (0..216).map(|k| [k % 6, k / 6 % 6, k / 36].map(|i| lengths[i])) {
        let mut buckets = Buckets::over([[0.0; 3], size], 1 << 10);
        let mut t: Delaunay<Space<Wide>, 4> = Delaunay::new(Space::default());
        let points =
            (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { size[axis] } else { 0.0 }));
        for p in points.clone() {
            t.insert_by(&mut buckets, p, ()).unwrap();
        }
        for p in points {
            assert!(matches!(buckets.locate(&t, &p), Location::Vertex(_)));
            assert!(matches!(
                StraightLine(None).locate(&t, &p),
                Location::Vertex(_)
            ));
        }
    }
}

#[test]
fn what_is_not_a_position() {
    let mut t = Delaunay::<Space, 4>::new(Space::new());
    for p in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        for q in [[f64::NAN; 3], [0.0, f64::INFINITY, 0.0], [1e300, 0.0, 0.0]] {
            assert_eq!(StraightLine(None).locate(&t, &q), Location::Nowhere);
            assert_eq!(Buckets::of(&t).locate(&t, &q), Location::Nowhere);
        }
        t.insert(p).unwrap();
    }
}
