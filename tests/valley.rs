//! The fixtures through the library: the surface has the counts of another program, and matches the
//! ground.

#[path = "../examples/fixtures/mod.rs"]
mod fixtures;

use breakline::data::{Bounds, Frame, Grid, Shape};
use breakline::terrain::{Dem, Selection, Tin, TinBuilder};
use fixtures::valley;

fn fixture(name: &str) -> String {
    format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn parts(name: &str) -> Vec<Vec<[f64; 3]>> {
    let layer = breakline::io::layer::read(&fixture(name)).unwrap();
    let parts = layer.shapes.into_iter().flat_map(|shape| match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => parts,
        other => panic!("{:?} in {name}", other.kind()),
    });
    parts.collect()
}

/// Ground points, and breaklines or none.
fn builder(breaklines: &[Vec<[f64; 3]>]) -> TinBuilder {
    let mut selection = Selection::default();
    selection
        .add_source(&mut *breakline::io::points::open(fixture("valley.laz")).unwrap())
        .unwrap();
    let mut builder = TinBuilder::default();
    builder.add_owned_points(selection.finish().0);
    breaklines
        .iter()
        .for_each(|line| builder.add_breakline(line));
    builder
}

fn tin(breaklines: &[Vec<[f64; 3]>]) -> Tin {
    builder(breaklines).build().unwrap()
}

/// Root mean square and largest difference from the known height, at the centers of cells of half a
/// meter within the boundary.
fn error(tin: &Tin) -> [f64; 2] {
    let [west, south] = valley::ORIGIN;
    let [width, height] = valley::SIZE;
    let bounds = Bounds {
        min: [west, south, 0.0],
        max: [west + width, south + height, 0.0],
    };
    let frame = Frame::snapped(&bounds, 0.5).unwrap();
    let grid = Grid::collect(&Dem::new(tin, frame).unwrap()).unwrap();
    let ring = fixtures::boundary();
    let (mut sum, mut count, mut worst) = (0.0, 0, 0.0_f64);
    for row in 0..frame.height {
        for column in 0..frame.width {
            let (z, [x, y]) = (grid.value(column, row), frame.center(column, row));
            let (u, v) = (x - west, y - south);
            // A cell on the rim of a clipped surface may lie beside it by a rounding.
            if fixtures::is_inside(&ring, [u, v]) && !z.is_nan() {
                let off = z - valley::height(u, v);
                sum += off * off;
                count += 1;
                worst = worst.max(off.abs());
            }
        }
    }
    assert!(count > 400_000, "{count} cells");
    [(sum / f64::from(count)).sqrt(), worst]
}

#[test]
fn the_surface_has_the_counts_of_triangle() {
    let report = tin(&parts("breaklines.shp")).report().clone();
    assert_eq!([report.vertices, report.triangles], [60_492, 120_954]);
    assert_eq!(
        [report.breaklines, report.edges.total(), report.crossings],
        [9, 1334, 0]
    );
    assert_eq!(
        [
            report.points,
            report.duplicates,
            report.points_on_breaklines
        ],
        [59_177, 25, 0]
    );
}

/// The bounds are what a TIN by Triangle has, see `fixtures/README.md`.
#[test]
fn breaklines_bring_the_surface_to_the_ground() {
    let [rms, worst] = error(&tin(&parts("breaklines.shp")));
    assert!(rms < 0.0315 && worst < 0.81, "{rms} {worst}");
    let [rms, worst] = error(&tin(&[]));
    assert!(
        rms > 0.09 && worst > 5.0,
        "without breaklines: {rms} {worst}"
    );
}

#[test]
fn the_lake_is_level() {
    let tin = tin(&parts("breaklines.shp"));
    for angle in 0..36 {
        let [u, v] = valley::lake_shore(f64::from(angle) * 0.1745);
        let [cu, cv] = valley::LAKE_CENTER;
        for share in [0.0, 0.5, 0.9] {
            let at = [
                valley::ORIGIN[0] + cu + share * (u - cu),
                valley::ORIGIN[1] + cv + share * (v - cv),
            ];
            assert_eq!(tin.elevation(at[0], at[1]), Some(valley::LAKE_LEVEL));
        }
    }
}

/// A boundary of segments of 20 m across everything in the valley does not change the surface.
#[test]
fn a_boundary_leaves_the_surface_as_it_is() {
    let mut builder = builder(&parts("breaklines.shp"));
    builder.add_boundary(&[parts("boundary.shp")
        .remove(0)
        .iter()
        .map(|p| [p[0], p[1]])
        .collect()]);
    let [rms, worst] = error(&builder.build().unwrap());
    assert!(rms < 0.0315 && worst < 0.81, "{rms} {worst}");
}
