//! Attaches colors to vertices, and reads them back through a Voronoi cell.

use breakline_triangulation::Delaunay;
use breakline_triangulation::geometry::Plane;

#[derive(Debug, PartialEq)]
enum Color {
    Red,
    Green,
    Blue,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut t = Delaunay::new(Plane::new());
    for (site, color) in [
        ([1.0, 1.0], Color::Red),
        ([5.0, 1.0], Color::Green),
        ([3.0, 5.0], Color::Blue),
    ] {
        t.insert_with(site, color)?;
    }
    let sheet = [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]];
    let painted = |color| {
        t.tds()
            .vertices()
            .find(|&v| *t.tds().vertex_data(v) == color)
    };
    let cell = t.voronoi_cell(painted(Color::Blue).expect("it is there"), &sheet);
    assert!(cell.corners.contains(&[0.0, 6.0]) && cell.area < 36.0 / 2.0);
    let nearest = t.nearest(&[4.0, 2.0], None).expect("there are three");
    assert_eq!(*t.tds().vertex_data(nearest), Color::Green);
    Ok(())
}
