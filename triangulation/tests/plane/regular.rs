//! Regular triangulations of tiny grids, where weights, sites and powers tie all the time, compared
//! with the lower hull.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Geometry, Weighted};
use breakline_triangulation::kernel::Adaptive;
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Flaw, Level, Regular, RemovalError};
use dashu_int::IBig;
use testkit::random::Random;

/// x, y and weight.
type Point = [i64; 3];

/// A user's own geometry, in whole numbers. With a number, that many different hashes.
#[derive(Default, Clone, Copy, Debug)]
struct Grid(Option<u64>);

fn lift([x, y, w]: Point) -> i64 {
    x * x + y * y - w
}

fn turn([a, b, c]: [Point; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

impl Geometry<3> for Grid {
    type Point = Point;

    fn admits(&self, p: &Point) -> bool {
        p.iter().all(|x| x.abs() < 1000)
    }

    fn compare(&self, p: &Point, q: &Point) -> Ordering {
        p[..2].cmp(&q[..2])
    }

    fn point_hash(&self, p: &Point) -> Option<u64> {
        self.0
            .map(|hashes| p.iter().fold(0, |hash, &x| 31 * hash + x.unsigned_abs()) % hashes)
    }

    fn orientation(&self, simplex: [&Point; 3]) -> Sign {
        turn(simplex.map(|p| *p)).cmp(&0).into()
    }

    fn side_of_sphere(&self, [a, b, c]: [&Point; 3], q: &Point) -> Sign {
        let (a, b, c, q) = (*a, *b, *c, *q);
        let value =
            turn([q, b, c]) * lift(a) + turn([a, q, c]) * lift(b) + turn([a, b, q]) * lift(c);
        (value - turn([a, b, c]) * lift(q)).cmp(&0).into()
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&Point], q: &Point) -> Sign {
        match simplex {
            [a] => q[2].cmp(&a[2]).into(),
            [a, b] => {
                let axis = usize::from(a[0] == b[0]);
                let (s, t) = (q[axis] - a[axis], b[axis] - q[axis]);
                let value = t * lift(**a) + s * lift(**b) - (s + t) * lift(*q);
                (value * (s + t).signum()).cmp(&0).into()
            }
            _ => Sign::Negative,
        }
    }
}

/// Returns the faces of the lower hull of the lifted points. Ties are broken by raising the lifts
/// by powers of a small number, the largest point most.
fn lower_hull(points: &BTreeSet<Point>) -> BTreeSet<[Point; 3]> {
    // In order of site and weight, the heaviest of a site last; raised by whole numbers far below a
    // step of the lift.
    let sites: Vec<Point> = {
        let sorted: Vec<Point> = points.iter().copied().collect();
        let heaviest = |k: &usize| {
            sorted
                .get(k + 1)
                .is_none_or(|next| next[..2] != sorted[*k][..2])
        };
        (0..sorted.len())
            .filter(heaviest)
            .map(|k| sorted[k])
            .collect()
    };
    let lifts: Vec<IBig> = (sites.iter().zip(0..))
        .map(|(&p, rank)| {
            (IBig::from(lift(p)) << (16 * sites.len() + 16)) + (IBig::ONE << (16 * rank))
        })
        .collect();
    let mut faces = BTreeSet::new();
    for i in 0..sites.len() {
        for j in i + 1..sites.len() {
            for k in j + 1..sites.len() {
                let area = turn([i, j, k].map(|at| sites[at]));
                let above = |q: usize| {
                    let at = |corners: [usize; 3]| IBig::from(turn(corners.map(|at| sites[at])));
                    let plane = at([q, j, k]) * &lifts[i]
                        + at([i, q, k]) * &lifts[j]
                        + at([i, j, q]) * &lifts[k];
                    (plane - IBig::from(area) * &lifts[q]) * IBig::from(area.signum()) < IBig::ZERO
                };
                if area != 0 && (0..sites.len()).all(|q| [i, j, k].contains(&q) || above(q)) {
                    faces.insert([i, j, k].map(|at| sites[at]));
                }
            }
        }
    }
    faces
}

fn cells(t: &Regular<Grid, 3>) -> BTreeSet<[Point; 3]> {
    let corners = |cell| {
        let mut corners = t.tds().corners(cell).map(|v| *t.point(v));
        corners.sort_unstable();
        corners
    };
    t.finite_cells().map(corners).collect()
}

fn is_lower_hull(t: &Regular<Grid, 3>, points: &BTreeSet<Point>) {
    assert_eq!(t.check(Level::Law), [], "{points:?}");
    assert_eq!(
        t.vertex_count() + t.hidden().len(),
        points.len(),
        "{points:?}"
    );
    let there: BTreeSet<Point> = t
        .tds()
        .vertices()
        .chain(t.hidden())
        .map(|v| *t.point(v))
        .collect();
    assert_eq!(there, *points);
    let expected = lower_hull(points);
    if t.dimension() == 2 {
        assert_eq!(cells(t), expected, "{points:?}");
        let seen: BTreeSet<Point> = t.tds().vertices().map(|v| *t.point(v)).collect();
        assert_eq!(seen, expected.into_iter().flatten().collect(), "{points:?}");
    } else {
        assert_eq!(expected.len(), 0, "{points:?}");
    }
}

/// Like the test above, in floating point, whose sums are exact here.
#[test]
fn the_weighted_plane_is_the_same() {
    let mut random = Random(22);
    for _ in 0..2000 {
        let (side, weights) = (1 + random.below(6), 1 + random.below(20));
        let points: Vec<Point> = (0..1 + random.index(20))
            .map(|_| {
                [
                    random.below(side),
                    random.below(side),
                    random.below(weights),
                ]
                .map(|x| x as i64)
            })
            .collect();
        let mut expected: Regular<Grid, 3> = Regular::new(Grid::default());
        points.iter().for_each(|&p| _ = expected.insert(p).unwrap());
        let doubles: Vec<[f64; 3]> = points
            .iter()
            .map(|p| [p[0] as f64, p[1] as f64, p[2] as f64])
            .collect();
        let (t, vertices) =
            Regular::<_, 3>::from_points(Weighted::<Adaptive>::default(), &doubles).unwrap();
        assert_eq!(t.check(Level::Law), []);
        assert!(vertices.iter().zip(&doubles).all(|(&v, p)| t.point(v) == p));
        let whole = |v: VertexId| t.point(v).map(|x| x as i64);
        let seen: BTreeSet<Point> = t.tds().vertices().map(whole).collect();
        assert_eq!(
            seen,
            expected
                .tds()
                .vertices()
                .map(|v| *expected.point(v))
                .collect()
        );
        assert_eq!(
            t.hidden().map(whole).collect::<BTreeSet<_>>(),
            expected.hidden().map(|v| *expected.point(v)).collect()
        );
        if t.dimension() == 2 {
            let corners = |cell| {
                let mut corners = t.tds().corners(cell).map(whole);
                corners.sort_unstable();
                corners
            };
            assert_eq!(
                t.finite_cells().map(corners).collect::<BTreeSet<_>>(),
                cells(&expected)
            );
        }
    }
}

#[test]
fn points_come_and_go() {
    let mut random = Random(21);
    for round in 0..1500 {
        let (side, weights) = (1 + random.below(5), 1 + random.below(12));
        let mut t: Regular<Grid, 3> =
            Regular::new(Grid([None, Some(1), Some(3), Some(10_000)][round % 4]));
        let mut points = BTreeSet::new();
        for _ in 0..30 {
            let p = [
                random.below(side),
                random.below(side),
                random.below(weights),
            ]
            .map(|x| x as i64);
            if points.len() < 10 && random.below(5) > 1 {
                let is_new = points.insert(p);
                let slots = t.tds().vertex_slots();
                let vertex = t.insert(p).unwrap();
                assert_eq!(*t.point(vertex), p);
                assert!(is_new || t.tds().vertex_slots() == slots);
            } else {
                let all: Vec<VertexId> = t.tds().vertices().chain(t.hidden()).collect();
                if !all.is_empty() {
                    let vertex = random.pick(&all);
                    assert!(points.remove(t.point(vertex)));
                    if random.below(2) == 0 {
                        let moved = t.move_to(vertex, p).unwrap();
                        assert_eq!((*t.point(moved), moved == vertex), (p, points.insert(p)));
                    } else {
                        t.remove(vertex).unwrap();
                        assert_eq!(t.remove(vertex), Err(RemovalError::NoVertex));
                    }
                }
            }
            is_lower_hull(&t, &points);
        }
    }
}

/// The outcome of each kind of insertion: on a site, on an edge, in a face.
#[test]
fn hiding_on_vertex_edge_and_face() {
    for (site, seen) in [([0, 0], 1), ([2, 0], 3), ([1, 1], 3)] {
        for weight in -3..6 {
            let mut t: Regular<Grid, 3> = Regular::new(Grid::default());
            for [x, y] in [[0, 0], [4, 0], [0, 4]] {
                t.insert([x, y, 0]).unwrap();
            }
            let p = [site[0], site[1], weight];
            let vertex = t.insert(p).unwrap();
            // On the corner by weight; on the edge below 4 - 4 = 0 by power; in the face likewise
            // below its power.
            let power = lift([site[0], site[1], 0]) - 4 * (site[0] + site[1]);
            let is_seen = if site == [0, 0] {
                weight > 0
            } else {
                power - weight <= 0
            };
            assert_eq!(
                !t.is_hidden(vertex),
                is_seen || site == [0, 0] && weight == 0,
                "{p:?}"
            );
            let expected = if site == [0, 0] || !is_seen {
                1
            } else if site == [2, 0] {
                2
            } else {
                seen
            };
            assert_eq!(t.finite_cells().count(), expected, "{p:?}");
            let points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], p].into();
            is_lower_hull(&t, &points);
        }
    }
}

/// Heavier and heavier points on one site hide each other, in each dimension, and become visible
/// again.
#[test]
fn one_site_on_another() {
    for others in [
        vec![],
        vec![[3, 0, 0]],
        vec![[3, 0, 0], [-3, 0, 0]],
        vec![[3, 0, 0], [-3, 0, 0], [0, 3, 0], [0, -3, 0]],
    ] {
        let mut t: Regular<Grid, 3> = Regular::new(Grid::default());
        for &p in &others {
            t.insert(p).unwrap();
        }
        let stack: Vec<VertexId> = (0..5).map(|w| t.insert([0, 0, w]).unwrap()).collect();
        assert!(t.hidden().eq(stack[..4].iter().copied()));
        for k in (0..5).rev() {
            assert!(t.tds().is_vertex(stack[k]) && t.hidden().len() == k);
            assert_eq!(t.insert([0, 0, k as i64]).unwrap(), stack[k], "it is there");
            let _ = t.remove(stack[k]);
        }
        assert_eq!(t.check(Level::Law), []);
        assert_eq!(t.vertex_count(), others.len());
    }
}

/// Points on a line: one kind hides the lightest, the other hides none.
#[test]
fn a_check_finds_points_that_ought_to_be_hidden() {
    let mut regular: Regular<Weighted, 3> = Regular::new(Weighted::default());
    let mut delaunay: Delaunay<Weighted, 3> = Delaunay::new(Weighted::default());
    for p in [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, -9.0]] {
        assert_eq!(delaunay.check(Level::Law), []);
        regular.insert(p).unwrap();
        delaunay.insert(p).unwrap();
    }
    assert_eq!(
        (
            regular.check(Level::Law),
            delaunay.check(Level::Orientation)
        ),
        (vec![], vec![])
    );
    assert!(matches!(
        delaunay.check(Level::Law)[..],
        [Flaw::NotDelaunay(..), Flaw::NotDelaunay(..)]
    ));
}
