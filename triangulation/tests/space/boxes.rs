//! Cells within boxes whose sides lie between vertices, in bisectors, and through Voronoi vertices:
//! their volumes against exact ones.

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::{Delaunay, Regular};
use testkit::boxes::{count, judge, sites, window};
use testkit::random::Random;

/// Centers that are not far away.
fn near(centers: impl Iterator<Item = [f64; 3]>, site: [f64; 3]) -> Vec<[f64; 3]> {
    centers
        .filter(|center| (0..3).all(|k| (center[k] - site[k]).abs() < 9.0))
        .collect()
}

#[test]
fn voronoi_cells() {
    let mut random = Random(361);
    for round in 0..count() {
        let sites = sites(&mut random, round, false);
        let points: Vec<[f64; 3]> = sites.iter().map(|&(site, _)| site).collect();
        let (t, vertices) = Delaunay::from_points(Space::new(), &points).unwrap();
        let centers = near(
            t.tds().cells().filter_map(|cell| t.circumcenter(cell)),
            points[0],
        );
        let within = window(&mut random, round / 6, &sites, &centers);
        let volumes: Vec<f64> = vertices
            .iter()
            .map(|&v| t.voronoi_cell(v, within).volume)
            .collect();
        judge(&sites, within, &volumes);
    }
}

#[test]
fn power_cells() {
    let mut random = Random(362);
    for round in 0..count() {
        let sites = sites(&mut random, round, true);
        let points: Vec<[f64; 4]> = sites
            .iter()
            .map(|&([x, y, z], weight)| [x, y, z, weight])
            .collect();
        let (t, vertices) = Regular::from_points(WeightedSpace::new(), &points).unwrap();
        let centers = near(
            t.tds().cells().filter_map(|cell| t.power_center(cell)),
            sites[0].0,
        );
        let within = window(&mut random, round / 6, &sites, &centers);
        let volumes: Vec<f64> = vertices
            .iter()
            .map(|&v| t.power_cell(v, within).volume)
            .collect();
        judge(&sites, within, &volumes);
    }
}

/// Of 27 points on a grid, the one in the middle has a cube, and the box is that cube, a part of
/// it, one that shares a side with it, or has its corners in Voronoi vertices.
#[test]
fn a_facet_in_a_side_of_the_box_counts_once() {
    let points: Vec<[f64; 3]> = (0..27)
        .map(|k| [k % 3, k / 3 % 3, k / 9].map(f64::from))
        .collect();
    let (t, v) = Delaunay::from_points(Space::new(), &points).unwrap();
    for (low, high, of_the_middle) in [
        ([0.5, 0.5, 0.5], [1.5, 1.5, 1.5], 1.0),
        ([0.5, 0.5, 0.5], [1.5, 1.5, 1.0], 0.5),
        ([1.0, 1.0, 1.0], [1.5, 1.5, 1.5], 0.125),
        ([1.5, 0.5, 0.5], [2.5, 1.5, 1.5], 0.0),
        ([1.5, 1.5, 1.5], [2.5, 2.5, 2.5], 0.0),
        ([0.5, -0.5, 0.5], [1.5, 2.5, 1.5], 1.0),
        ([-0.5, -0.5, -0.5], [2.5, 2.5, 2.5], 1.0),
    ] {
        let cells: Vec<_> = v.iter().map(|&v| t.voronoi_cell(v, [low, high])).collect();
        assert_eq!(cells[13].volume, of_the_middle, "{low:?}");
        let sum: f64 = cells.iter().map(|cell| cell.volume).sum();
        assert_eq!(
            sum,
            (0..3).map(|k| high[k] - low[k]).product::<f64>(),
            "{low:?}"
        );
        for cell in &cells {
            assert!(
                cell.facets.len() == 6 || cell.facets.is_empty() && cell.volume == 0.0,
                "{cell:?}"
            );
        }
    }
    let middle = t.voronoi_cell(v[13], [[0.5; 3], [1.5; 3]]);
    assert!(
        middle.facets.iter().all(|facet| facet.beyond.is_none()),
        "what lies in a side is on the box"
    );
}
