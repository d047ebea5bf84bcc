//! A geometry of your own, computed in whole numbers: points of a lattice, with predicates in
//! `i128`. `docs/how-to-add-a-geometry.md` of the repository goes through it step by step.

use std::cmp::Ordering;

use breakline_triangulation::geometry::{Coordinates, Crossing, Geometry, Plane};
use breakline_triangulation::num::Sign;
use breakline_triangulation::{ConstrainedDelaunay, Delaunay, Level, OnCrossing};

/// Points with coordinates below 2^21, so that in-circle determinants stay below 2^92.
struct Small;

fn minus(p: [i32; 2], q: [i32; 2]) -> [i128; 2] {
    [0, 1].map(|k| i128::from(p[k]) - i128::from(q[k]))
}

fn cross([a, b]: [i128; 2], [c, d]: [i128; 2]) -> i128 {
    a * d - b * c
}

impl Geometry<3> for Small {
    type Point = [i32; 2];

    fn admits(&self, p: &[i32; 2]) -> bool {
        p.iter().all(|x| x.unsigned_abs() < 1 << 21)
    }

    fn compare(&self, p: &[i32; 2], q: &[i32; 2]) -> Ordering {
        p.cmp(q)
    }

    fn orientation(&self, [a, b, c]: [&[i32; 2]; 3]) -> Sign {
        cross(minus(*b, *a), minus(*c, *a)).cmp(&0).into()
    }

    fn side_of_sphere(&self, simplex: [&[i32; 2]; 3], q: &[i32; 2]) -> Sign {
        let [a, b, c] = simplex.map(|p| minus(*p, *q));
        let lift = |[x, y]: [i128; 2]| x * x + y * y;
        (lift(a) * cross(b, c) + lift(b) * cross(c, a) + lift(c) * cross(a, b))
            .cmp(&0)
            .into()
    }
}

impl Coordinates<3> for Small {
    type Coordinates = [f64; 2];

    fn coordinates(&self, p: &[i32; 2]) -> [f64; 2] {
        p.map(f64::from)
    }
}

impl Crossing for Small {
    fn plan(&self, p: &[i32; 2]) -> [f64; 2] {
        p.map(f64::from)
    }

    fn step(&self) -> f64 {
        1.0
    }

    fn meet(&self, site: [f64; 2], _: &[[&[i32; 2]; 2]]) -> [i32; 2] {
        site.map(|x| x as i32)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Most of them cocircular, some equal: the perturbation decides as in the plane.
    let points: Vec<[i32; 2]> = (0..500).map(|i| [i * i % 23, i * 7 % 19]).collect();
    let (ours, vertices) = Delaunay::from_points(Small, &points)?;
    let sites: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::from)).collect();
    let (theirs, same) = Delaunay::from_points(Plane::new(), &sites)?;
    assert_eq!(vertices, same);
    for cell in ours.finite_cells() {
        let corners = ours.tds().cell_vertices(cell);
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let there = theirs
            .tds()
            .edge(a, b)
            .zip(theirs.tds().edge(b, c))
            .zip(theirs.tds().edge(c, a));
        assert!(
            there.is_some(),
            "the plane has no triangle {a:?} {b:?} {c:?}"
        );
    }

    let square = [[0, 0], [9, 9], [9, 0], [0, 9]];
    let (lines, _) =
        ConstrainedDelaunay::from_lines(Small, &square, &[[0, 1], [2, 3]], OnCrossing::Split)?;
    assert!(lines.check(Level::Law).is_empty());
    assert_eq!(
        lines.point(lines.crossings()[0]),
        &[5, 5],
        "rounded to a whole step"
    );
    Ok(())
}
