//! Triangulates records of your own, without conversion: a name and coordinates.

use breakline_triangulation::geometry::{Geometry, Plane};
use breakline_triangulation::{Delaunay, num::Sign};

#[derive(Debug, Clone, Copy)]
struct Tree(&'static str, [f64; 2]);
struct Forest(Plane);

#[rustfmt::skip]
impl Geometry<3> for Forest {
    type Point = Tree;
    fn admits(&self, p: &Tree) -> bool { self.0.admits(&p.1) }
    fn compare(&self, p: &Tree, q: &Tree) -> std::cmp::Ordering { self.0.compare(&p.1, &q.1) }
    fn orientation(&self, s: [&Tree; 3]) -> Sign { self.0.orientation(s.map(|p| &p.1)) }
    fn side_of_sphere(&self, s: [&Tree; 3], q: &Tree) -> Sign { self.0.side_of_sphere(s.map(|p| &p.1), &q.1) }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut trees = Delaunay::new(Forest(Plane::default()));
    let forest = [
        Tree("oak", [0.0, 0.0]),
        Tree("elm", [9.0, 1.0]),
        Tree("ash", [4.0, 7.0]),
    ];
    forest
        .into_iter()
        .try_for_each(|tree| trees.insert(tree).map(drop))?;
    assert!(trees.tds().hull().any(|v| trees.point(v).0 == "elm"));
    Ok(())
}
