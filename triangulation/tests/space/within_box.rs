//! The vertices in a box, against a search through all, on grids where its faces run through
//! points.

use std::cell::Cell;
use std::cmp::Ordering;

use breakline_triangulation::geometry::{Coordinates, Geometry, Space, WeightedSpace};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Basic, Delaunay, Regular, Triangulation};
use testkit::random::Random;

use crate::TINY;

fn judge<G: Coordinates<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    corners: [&G::Point; 2],
) {
    let site =
        |p: &G::Point| -> [f64; 3] { t.geometry().coordinates(p).as_ref().try_into().unwrap() };
    let [p, q] = corners.map(site);
    let is_within = |v: &VertexId| {
        let at = site(t.point(*v));
        (0..3).all(|k| {
            p[k].min(q[k]) <= at[k] && at[k] <= p[k].max(q[k]) && !p[k].is_nan() && !q[k].is_nan()
        })
    };
    let expected: Vec<VertexId> = t.tds().vertices().filter(is_within).collect();
    assert_eq!(
        t.within_box(corners),
        expected,
        "{corners:?} {:?}",
        t.points()
    );
}

#[test]
fn boxes() {
    let mut random = Random(71);
    for round in 0..1500 {
        let sizes = [[4, 4, 4], [6, 3, 2], [5, 5, 1], [7, 1, 1], [2, 2, 2]][round % 5];
        let scale = [1.0, TINY, 2f64.powi(1000)][round % 3];
        let count = random.index(40);
        let mut draw = |margin: u64| {
            sizes.map(|size| {
                (random.below((size + 2 * margin) * (1 + margin)) as f64 / (1 + margin) as f64
                    - margin as f64)
                    * scale
            })
        };
        let points: Vec<[f64; 3]> = (0..count).map(|_| draw(0)).collect();
        let boxes: Vec<[[f64; 3]; 2]> = (0..8).map(|_| [draw(1), draw(1)]).collect();
        let space = Space::<Wide>::default();
        if round % 4 == 0 {
            let (t, _) = Basic::<_, 4>::from_points(space, &points).unwrap();
            boxes
                .iter()
                .for_each(|corners| judge(&t, corners.each_ref()));
        } else {
            let (t, _) = Delaunay::<_, 4>::from_points(space, &points).unwrap();
            boxes
                .iter()
                .for_each(|corners| judge(&t, corners.each_ref()));
        }
    }
}

#[test]
fn of_a_regular_triangulation() {
    let mut random = Random(72);
    for _ in 0..100 {
        let mut draw = || [0; 4].map(|_| random.below(5) as f64);
        let points: Vec<[f64; 4]> = (0..30).map(|_| draw()).collect();
        let (t, _) = Regular::<_, 4>::from_points(<WeightedSpace>::new(), &points).unwrap();
        for _ in 0..8 {
            judge(&t, [&draw(), &draw()]);
        }
    }
}

#[test]
fn boxes_without_end_and_without_meaning() {
    let points: Vec<[f64; 3]> = (0..27)
        .map(|k| [k % 3, k / 3 % 3, k / 9].map(f64::from))
        .collect();
    let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
    let (far, nan) = (f64::INFINITY, f64::NAN);
    for [p, q] in [
        [[-far; 3], [far; 3]],
        [[1.0, -far, 1.0], [far, 1.0, 1.0]],
        [[far, 0.0, 0.0], [far, 2.0, 2.0]],
        [[nan, 0.0, 0.0], [2.0; 3]],
        [[0.0; 3], [2.0, 2.0, nan]],
        [[-f64::MAX; 3], [f64::MAX; 3]],
        [[5e-324; 3], [1.0; 3]],
    ] {
        judge(&t, [&p, &q]);
        judge(&t, [&q, &p]);
    }
}

/// Space, with calls counted.
#[derive(Debug, Clone, Copy, Default)]
struct Counting(Space);

thread_local!(static LOOKED: Cell<usize> = const { Cell::new(0) });

impl Geometry<4> for Counting {
    type Point = [f64; 3];

    fn admits(&self, p: &[f64; 3]) -> bool {
        self.0.admits(p)
    }

    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        self.0.compare(p, q)
    }

    fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
        self.0.orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
        self.0.side_of_sphere(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
        self.0.orientation_in_flat(simplex)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        self.0.side_of_sphere_in_flat(simplex, q)
    }
}

impl Coordinates<4> for Counting {
    type Coordinates = [f64; 3];

    fn coordinates(&self, p: &[f64; 3]) -> [f64; 3] {
        LOOKED.set(LOOKED.get() + 1);
        *p
    }

    fn exact_site(&self, p: &[f64; 3]) -> Option<[f64; 4]> {
        self.0.exact_site(p)
    }
}

/// A small box in many points, and one that reaches beyond the hull: few cells are looked at.
#[test]
fn the_rest_is_not_looked_at() {
    let mut random = Random(73);
    let points: Vec<[f64; 3]> = (0..20_000).map(|_| [0; 3].map(|_| random.unit())).collect();
    let (t, _) = Delaunay::<_, 4>::from_points(Counting::default(), &points).unwrap();
    assert_eq!(t.dimension(), 3);
    for corners in [[[0.4; 3], [0.45; 3]], [[0.97; 3], [1.5; 3]]] {
        LOOKED.set(0);
        let found = t.within_box(corners.each_ref());
        let looked = LOOKED.get();
        assert!(
            looked < 5000 + 500 * found.len(),
            "{looked} coordinates for {} vertices",
            found.len()
        );
        judge(&t, corners.each_ref());
    }
}
