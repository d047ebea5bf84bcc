//! Sequences of insertions and removals in space, with every exact arithmetic, on tiny grids: what
//! remains is the triangulation of the remaining points.
//!
//! `BREAKLINE_SEQUENCES` sets the number of sequences of each kind and arithmetic.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Coordinates, Geometry, Space, WeightedSpace};
use breakline_triangulation::kernel::{
    Adaptive, Exact, Expansions, Fixed, Interval, Kernel, Lattice, Wide,
};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level, Regular, Triangulation};
use testkit::random::Random;

/// A geometry of points with `D` coordinates whose arithmetic is chosen at run time, so that
/// triangulations are compiled once for all kernels.
#[derive(Debug, Clone, Copy)]
struct Chosen<const D: usize> {
    admits: fn(&[f64; D]) -> bool,
    orientation: fn([&[f64; D]; 4]) -> Sign,
    side_of_sphere: fn([&[f64; D]; 4], &[f64; D]) -> Sign,
    orientation_in_flat: fn(&[&[f64; D]]) -> Sign,
    in_flat: fn(&[&[f64; D]], &[f64; D]) -> Sign,
    exact_site: fn(&[f64; D]) -> Option<[f64; 4]>,
}

fn of<G: Coordinates<4, Point = [f64; D]> + Default, const D: usize>() -> Chosen<D> {
    Chosen {
        admits: |p| G::default().admits(p),
        orientation: |simplex| G::default().orientation(simplex),
        side_of_sphere: |simplex, q| G::default().side_of_sphere(simplex, q),
        orientation_in_flat: |simplex| G::default().orientation_in_flat(simplex),
        in_flat: |simplex, q| G::default().side_of_sphere_in_flat(simplex, q),
        exact_site: |p| G::default().exact_site(p),
    }
}

fn space<K: Kernel>() -> Chosen<3> {
    of::<Space<K>, 3>()
}

fn weighted<K: Kernel>() -> Chosen<4> {
    of::<WeightedSpace<K>, 4>()
}

impl<const D: usize> Geometry<4> for Chosen<D> {
    type Point = [f64; D];

    fn admits(&self, p: &[f64; D]) -> bool {
        (self.admits)(p)
    }

    fn compare(&self, p: &[f64; D], q: &[f64; D]) -> Ordering {
        Space::<Adaptive>::default().compare(&self.coordinates(p), &self.coordinates(q))
    }

    fn orientation(&self, simplex: [&[f64; D]; 4]) -> Sign {
        (self.orientation)(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; D]; 4], q: &[f64; D]) -> Sign {
        (self.side_of_sphere)(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; D]]) -> Sign {
        (self.orientation_in_flat)(simplex)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; D]], q: &[f64; D]) -> Sign {
        (self.in_flat)(simplex, q)
    }
}

impl<const D: usize> Coordinates<4> for Chosen<D> {
    type Coordinates = [f64; 3];

    fn coordinates(&self, p: &[f64; D]) -> [f64; 3] {
        [p[0], p[1], p[2]]
    }

    fn exact_site(&self, p: &[f64; D]) -> Option<[f64; 4]> {
        (self.exact_site)(p)
    }
}

fn sequences() -> usize {
    std::env::var("BREAKLINE_SEQUENCES")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(300)
}

/// The dimension, the finite cells as sorted points, and the visible points.
type Shape<const D: usize> = (i32, BTreeSet<Vec<[i64; D]>>, BTreeSet<[i64; D]>);

fn shape<const D: usize>(t: &Triangulation<Chosen<D>, 4>) -> Shape<D> {
    let point = |&v: &VertexId| t.point(v).map(|x| x as i64);
    let cell = |cell| {
        let mut corners: Vec<[i64; D]> = t.tds().cell_vertices(cell).iter().map(point).collect();
        corners.sort_unstable();
        corners
    };
    (
        t.dimension(),
        t.finite_cells().map(cell).collect(),
        t.tds().vertices().map(|v| point(&v)).collect(),
    )
}

const SIZES: [[u64; 3]; 6] = [
    [2, 2, 2],
    [3, 3, 3],
    [4, 4, 1],
    [3, 2, 2],
    [6, 1, 1],
    [5, 5, 5],
];

fn site(random: &mut Random, sizes: [u64; 3]) -> [f64; 3] {
    sizes.map(|size| random.below(size) as f64)
}

fn delaunay(random: &mut Random, geometry: Chosen<3>) {
    // Ties everywhere, or hardly any.
    let sizes = if random.below(4) == 0 {
        [1 << 20; 3]
    } else {
        random.pick(&SIZES)
    };
    let mut t: Delaunay<Chosen<3>, 4> = Delaunay::new(geometry);
    let mut points: Vec<([f64; 3], VertexId)> = Vec::new();
    for _ in 0..5 + random.index(20) {
        if points.is_empty() || random.below(5) > 1 {
            let p = site(random, sizes);
            let vertex = t.insert(p).unwrap();
            if !points.iter().any(|&(_, other)| other == vertex) {
                points.push((p, vertex));
            }
        } else {
            let (p, vertex) = points.swap_remove(random.index(points.len()));
            assert_eq!(t.remove(vertex), Ok(p));
        }
    }
    assert_eq!(t.check(Level::Law), []);
    let points: Vec<[f64; 3]> = points.into_iter().map(|(p, _)| p).collect();
    let (fresh, _) = Delaunay::from_points(geometry, &points).unwrap();
    assert_eq!(shape(&t), shape(&fresh), "{points:?}");
}

fn regular(random: &mut Random, geometry: Chosen<4>) {
    let sizes = if random.below(4) == 0 {
        [1 << 10; 3]
    } else {
        random.pick(&SIZES)
    };
    let weights = 1 + random.below(12);
    let mut t: Regular<Chosen<4>, 4> = Regular::new(geometry);
    let mut points: Vec<([f64; 4], VertexId)> = Vec::new();
    for _ in 0..5 + random.index(20) {
        if points.is_empty() || random.below(5) > 1 {
            let [x, y, z] = site(random, sizes);
            let p = [x, y, z, random.below(weights) as f64];
            let vertex = t.insert(p).unwrap();
            if !points.iter().any(|&(_, other)| other == vertex) {
                points.push((p, vertex));
            }
        } else {
            let (p, vertex) = points.swap_remove(random.index(points.len()));
            assert_eq!(t.remove(vertex), Ok(p));
        }
    }
    assert_eq!(t.check(Level::Law), []);
    let points: Vec<[f64; 4]> = points.into_iter().map(|(p, _)| p).collect();
    let (fresh, _) = Regular::from_points(geometry, &points).unwrap();
    assert_eq!(shape(&t), shape(&fresh), "{points:?}");
    let hidden = |t: &Regular<Chosen<4>, 4>| {
        t.hidden()
            .map(|v| t.point(v).map(|x| x as i64))
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(hidden(&t), hidden(&fresh), "{points:?}");
}

/// Every exact arithmetic.
macro_rules! each {
    ($geometry:ident) => {
        [
            $geometry::<Adaptive>(),
            $geometry::<Exact>(),
            $geometry::<Expansions>(),
            $geometry::<Interval>(),
            $geometry::<Fixed>(),
            $geometry::<Lattice>(),
            $geometry::<Wide>(),
        ]
    };
}

#[test]
fn of_delaunay() {
    for (seed, geometry) in (410..).zip(each!(space)) {
        let mut random = Random(seed);
        (0..sequences()).for_each(|_| delaunay(&mut random, geometry));
    }
}

#[test]
fn of_regular() {
    for (seed, geometry) in (420..).zip(each!(weighted)) {
        let mut random = Random(seed);
        (0..sequences()).for_each(|_| regular(&mut random, geometry));
    }
}
