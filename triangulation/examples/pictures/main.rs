//! Draws the pictures of the documentation:
//! `cargo run --example pictures -- triangulation/docs/pictures`.

mod space;

use std::fs;
use std::path::Path;

use breakline_triangulation::geometry::{Plane, Weighted};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{
    ConstrainedDelaunay, Delaunay, InputError, Mark, OnCrossing, Passage, Regular,
};

type Site = [f64; 2];

/// A function that returns the text of an SVG file.
type Draw = fn() -> Result<String, Box<dyn std::error::Error>>;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("the folder for the pictures is missing")?;
    fs::create_dir_all(&folder)?;
    let pictures: [(&str, Draw); 7] = [
        ("conflict-zone", conflict_zone),
        ("walk", walk),
        ("voronoi-cell", voronoi_cell),
        ("regular", regular),
        ("constrained", constrained),
        ("conflict-zone-in-space", space::conflict_zone),
        ("alpha-shape", space::alpha_shape),
    ];
    for (name, draw) in pictures {
        fs::write(Path::new(&folder).join(name).with_extension("svg"), draw()?)?;
    }
    Ok(())
}

/// Returns points spread evenly over a square of side 100, in an order of the R2 sequence (Roberts
/// 2018): no two are close.
fn spread(count: u32) -> Vec<Site> {
    let at = |k: u32, step: f64| (f64::from(k) * step).fract() * 100.0;
    (1..=count)
        .map(|k| [at(k, 0.754_877_666), at(k, 0.569_840_291)].map(f64::round))
        .collect()
}

fn delaunay(count: u32) -> Result<Delaunay<Plane, 3>, InputError> {
    Ok(Delaunay::from_points(Plane::default(), &spread(count))?.0)
}

/// Draws the triangles that a new point would destroy, and the border of its star.
fn conflict_zone() -> Result<String, Box<dyn std::error::Error>> {
    let (t, q) = (delaunay(24)?, [40.0, 36.0]);
    let zone = t
        .conflict_zone(&q, None)
        .expect("it is inside of the hull, and no vertex");
    Ok(t.svg(&[
        Mark::Cells(&zone.cells),
        Mark::Edges(&zone.border),
        Mark::Line(&[q]),
    ]))
}

/// Draws the triangles that a straight line meets.
fn walk() -> Result<String, Box<dyn std::error::Error>> {
    let (t, ends) = (delaunay(30)?, [[14.0, 12.0], [88.0, 79.0]]);
    let face = |passage| {
        if let Passage::Face(cell) = passage {
            Some(cell)
        } else {
            None
        }
    };
    let met: Vec<CellId> = t
        .along([&ends[0], &ends[1]], None)
        .filter_map(face)
        .collect();
    Ok(t.svg(&[Mark::Cells(&met), Mark::Line(&ends), Mark::Line(&ends[1..])]))
}

/// Draws the Voronoi cell of the vertex in the middle, and those of its neighbors.
fn voronoi_cell() -> Result<String, Box<dyn std::error::Error>> {
    let t = delaunay(20)?;
    let sheet = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]];
    let middle = t.nearest(&[50.0, 50.0], None).expect("there are vertices");
    let around = t
        .tds()
        .vertices_around(middle)
        .filter(|&v| v != VertexId::INFINITE);
    let cells: Vec<Vec<Site>> = [middle]
        .into_iter()
        .chain(around)
        .map(|v| t.voronoi_cell(v, &sheet).corners)
        .collect();
    let outlines: Vec<Vec<Site>> = cells[1..].iter().map(|cell| closed(cell)).collect();
    let lines = outlines.iter().map(|outline| Mark::Line(outline));
    Ok(t.svg(
        &[Mark::Polygon(&cells[0])]
            .into_iter()
            .chain(lines)
            .collect::<Vec<_>>(),
    ))
}

fn closed(ring: &[Site]) -> Vec<Site> {
    ring.iter().chain(ring.first()).copied().collect()
}

/// Draws weighted points; the hidden ones as dots without edges, in the triangles that hide them.
fn regular() -> Result<String, Box<dyn std::error::Error>> {
    let weighted = |(k, [x, y]): (usize, Site)| [x, y, if k % 5 == 2 { 1200.0 } else { 0.0 }];
    let points: Vec<[f64; 3]> = spread(28).into_iter().enumerate().map(weighted).collect();
    let (t, _) = Regular::<Weighted, 3>::from_points(Weighted::default(), &points)?;
    let hosts: Vec<CellId> = t
        .finite_cells()
        .filter(|&cell| !t.hidden_under(cell).is_empty())
        .collect();
    let hidden: Vec<[Site; 1]> = t
        .hidden()
        .map(|v| [[t.point(v)[0], t.point(v)[1]]])
        .collect();
    let dots = hidden.iter().map(|site| Mark::Line(site));
    Ok(t.svg(
        &[Mark::Cells(&hosts)]
            .into_iter()
            .chain(dots)
            .collect::<Vec<_>>(),
    ))
}

/// Draws a plate with a hole and a crack that crosses its rim; areas at odd nesting levels are
/// filled.
fn constrained() -> Result<String, Box<dyn std::error::Error>> {
    let mut points = vec![[0.0, 0.0], [100.0, 10.0], [90.0, 100.0], [10.0, 90.0]];
    points.extend([[35.0, 35.0], [65.0, 40.0], [60.0, 70.0], [30.0, 60.0]]);
    points.extend([[15.0, 75.0], [50.0, 50.0], [80.0, 25.0]]);
    points.extend([[50.0, 18.0], [80.0, 60.0], [18.0, 30.0], [55.0, 85.0]]);
    let lines = [vec![0, 1, 2, 3, 0], vec![4, 5, 6, 7, 4], vec![8, 9, 10]];
    let (t, _) = ConstrainedDelaunay::<Plane>::from_lines(
        Plane::default(),
        &points,
        &lines,
        OnCrossing::Split,
    )?;
    let rings = t.lines().take(2);
    let levels = t.nesting_of(rings)?;
    let inside: Vec<CellId> = t
        .finite_cells()
        .filter(|cell| levels[cell.index()] % 2 == 1)
        .collect();
    let edges: Vec<_> = t
        .constrained_edges()
        .filter_map(|[a, b]| t.tds().edge(a, b))
        .collect();
    Ok(t.svg(&[Mark::Cells(&inside), Mark::Edges(&edges)]))
}
