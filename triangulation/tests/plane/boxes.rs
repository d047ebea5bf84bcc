//! Cells within rectangles whose sides lie between vertices, in bisectors, and through Voronoi
//! vertices: their areas against exact ones.

use breakline_triangulation::geometry::{Plane, Weighted};
use breakline_triangulation::{Delaunay, Regular};
use testkit::boxes::{count, judge, sites, window};
use testkit::random::Random;

/// Centers that are not far away.
fn near(centers: impl Iterator<Item = [f64; 2]>, site: [f64; 2]) -> Vec<[f64; 2]> {
    centers
        .filter(|center| (0..2).all(|k| (center[k] - site[k]).abs() < 9.0))
        .collect()
}

/// Returns the corners of a rectangle, counter-clockwise.
fn corners([[west, south], [east, north]]: [[f64; 2]; 2]) -> [[f64; 2]; 4] {
    [[west, south], [east, south], [east, north], [west, north]]
}

#[test]
fn voronoi_cells() {
    let mut random = Random(363);
    for round in 0..count() {
        let sites = sites(&mut random, round, false);
        let points: Vec<[f64; 2]> = sites.iter().map(|&(site, _)| site).collect();
        let (t, vertices) = Delaunay::from_points(Plane::new(), &points).unwrap();
        let centers = near(
            t.tds().cells().filter_map(|cell| t.circumcenter(cell)),
            points[0],
        );
        let within = window(&mut random, round / 6, &sites, &centers);
        let areas: Vec<f64> = vertices
            .iter()
            .map(|&v| t.voronoi_cell(v, &corners(within)).area)
            .collect();
        judge(&sites, within, &areas);
    }
}

#[test]
fn power_cells() {
    let mut random = Random(364);
    for round in 0..count() {
        let sites = sites(&mut random, round, true);
        let points: Vec<[f64; 3]> = sites
            .iter()
            .map(|&([x, y], weight)| [x, y, weight])
            .collect();
        let (t, vertices) = Regular::from_points(Weighted::new(), &points).unwrap();
        let centers = near(
            t.tds().cells().filter_map(|cell| t.power_center(cell)),
            sites[0].0,
        );
        let within = window(&mut random, round / 6, &sites, &centers);
        let areas: Vec<f64> = vertices
            .iter()
            .map(|&v| t.power_cell(v, &corners(within)).area)
            .collect();
        judge(&sites, within, &areas);
    }
}
