//! Edits by the kinds, in space and in the plane, beside calls that do the same.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Plane, Space, Unweighted, Weighted, WeightedSpace};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{
    Basic, Basic3, Delaunay, Hierarchy, Level, Locate, Location, Regular, RemovalError,
};
use testkit::random::Random;

fn sorted_cells(t: &Basic3) -> BTreeSet<[VertexId; 4]> {
    let corners = |cell| {
        let mut corners = *t.tds().corners(cell);
        corners.sort_unstable();
        corners
    };
    t.finite_cells().map(corners).collect()
}

fn volume(corners: [[f64; 3]; 4]) -> f64 {
    let [u, v, w] =
        [1, 2, 3].map(|k: usize| [0, 1, 2].map(|axis| corners[k][axis] - corners[0][axis]));
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Of the five vertices, two tetrahedra fill the same body as three others if the volumes agree.
#[test]
fn a_facet_is_flipped_if_three_cells_fill_its_two() {
    let mut random = Random(41);
    let (mut flipped, mut refused, mut inverted) = (0, 0, 0);
    for round in 0..120 {
        let side = [4, 9, 30][round % 3];
        let points: Vec<[f64; 3]> = (0..12)
            .map(|_| [0; 3].map(|_| random.below(side) as f64))
            .collect();
        let (mut t, _) = Basic::<Space, 4>::from_points(Space::default(), &points).unwrap();
        if t.dimension() < 3 {
            assert!(!t.flip(CellId::new(0), 0));
            continue;
        }
        for _ in 0..30 {
            let cells: Vec<_> = t.tds().cells().collect();
            let (cell, i) = (random.pick(&cells), random.index(4));
            let (tds, before) = (t.tds(), sorted_cells(&t));
            let beside = tds.neighbor(cell, i);
            let far = tds.vertex(beside, tds.index_of_neighbor(beside, cell));
            let near = tds.vertex(cell, i);
            let corners = *tds.corners(cell);
            let is_finite = !tds.is_infinite(cell) && !tds.is_infinite(beside);
            let size = |corners: [VertexId; 4]| volume(corners.map(|v| *t.point(v))).abs();
            let without =
                |k: usize| std::array::from_fn(|slot| if slot == k { far } else { corners[slot] });
            let expected = is_finite && {
                let parts: Vec<f64> = (0..4)
                    .filter(|&k| k != i)
                    .map(|k| size(without(k)))
                    .collect();
                parts.iter().all(|&part| part > 0.0)
                    && parts.iter().sum::<f64>() == size(corners) + size(without(i))
            };
            assert_eq!(t.is_facet_flippable(cell, i), expected);
            assert_eq!(t.flip(cell, i), expected);
            assert_eq!(t.check(Level::Orientation), []);
            t.locate(&points[0], None);
            if !expected {
                assert_eq!(sorted_cells(&t), before);
                refused += 1;
                continue;
            }
            flipped += 1;
            assert_eq!(sorted_cells(&t).len(), before.len() + 1);
            if random.below(2) == 0 {
                assert!(t.is_edge_flippable([far, near]) && t.flip_edge([near, far]));
                assert_eq!(sorted_cells(&t), before);
                inverted += 1;
            }
        }
        for edge in t.tds().edges().collect::<Vec<_>>() {
            if t.tds().is_used(edge.0) && t.flip_edge(t.tds().edge_ends(edge)) {
                assert_eq!(t.check(Level::Orientation), []);
            }
        }
        assert!(!t.is_facet_flippable(CellId::new(9999), 0));
        assert!(!t.flip_edge([VertexId::new(9999), VertexId::new(0)]));
        assert!(!t.flip_edge([VertexId::INFINITE, VertexId::new(0)]));
    }
    assert!(
        flipped > 100 && refused > 300 && inverted > 40,
        "{flipped} {refused} {inverted}: hardly a test"
    );
}

#[test]
fn many_vertices_are_removed_or_none() {
    let mut random = Random(42);
    let weighted: Vec<[f64; 4]> = (0..80)
        .map(|_| [0; 4].map(|_| random.below(6) as f64))
        .collect();
    let (mut t, v) =
        Regular::<WeightedSpace, 4>::from_points(WeightedSpace::new(), &weighted).unwrap();
    let there: BTreeSet<VertexId> = v.iter().copied().collect();
    let (some, rest): (Vec<VertexId>, Vec<VertexId>) =
        there.iter().partition(|v| v.index() % 3 == 0);
    assert!(t.hidden().len() > 5);
    let bad = [some[0], VertexId::new(5000)];
    assert_eq!(t.remove_all(&bad), Err(RemovalError::NoVertex));
    assert_eq!(t.vertex_count() + t.hidden().len(), there.len());
    let twice: Vec<VertexId> = some.iter().chain(&some).copied().collect();
    let points = t.remove_all(&twice).unwrap();
    assert!(points.iter().zip(&twice).all(|(p, &v)| p == t.point(v)));
    let mut left: Vec<VertexId> = t.tds().vertices().chain(t.hidden()).collect();
    left.sort_unstable();
    assert_eq!(left, rest);
    assert_eq!(t.check(Level::Law), []);
    assert_eq!(
        t.remove_all(&rest).map(|points| points.len()),
        Ok(rest.len())
    );
    assert_eq!(t.dimension(), -1);
}

/// Zones of the point, of another one, and of an earlier state.
#[test]
fn a_zone_that_is_out_of_date_does_no_harm() {
    let mut random = Random(43);
    let mut t = Delaunay::<Plane, 3>::new(Plane::new());
    let mut zone = None;
    for step in 0..400 {
        let p = [0; 2].map(|_| random.below(30) as f64);
        if step % 3 != 0 {
            zone = t.conflict_zone(&p, None).or(zone);
        }
        let count = t.vertex_count();
        let is_there = t.tds().vertices().any(|v| *t.point(v) == p);
        let inserted = match &zone {
            Some(zone) => t.insert_in_zone(p, (), zone).unwrap(),
            None => t.insert_with(p, ()).unwrap(),
        };
        assert_eq!(
            (*t.point(inserted.vertex), inserted.is_new()),
            (p, !is_there)
        );
        assert_eq!(t.vertex_count(), count + usize::from(!is_there));
        if step % 5 == 0 {
            t.remove(inserted.vertex).unwrap();
        }
    }
    assert_eq!(t.check(Level::Law), []);
}

#[test]
fn samples_of_weighted_points_ignore_weights() {
    let mut random = Random(44);
    let points: Vec<[f64; 3]> = (0..2000)
        .map(|_| [0; 3].map(|_| random.below(60) as f64))
        .collect();
    let mut t = Regular::<Weighted, 3>::new(Weighted::new());
    let mut hierarchy = Hierarchy::<Unweighted, 3>::new(Unweighted::new());
    let vertices: Vec<VertexId> = points
        .iter()
        .map(|&p| t.insert_by(&mut hierarchy, p, ()).unwrap().vertex)
        .collect();
    let removed: BTreeSet<VertexId> = vertices.iter().copied().step_by(3).collect();
    for &vertex in &removed {
        t.remove_by(&mut hierarchy, vertex).unwrap();
    }
    assert!(
        hierarchy
            .sample_sizes()
            .next()
            .is_some_and(|size| size > 10)
    );
    assert_eq!(t.check(Level::Law), []);
    for q in &points {
        let by_walk = t.locate(q, None);
        let found = hierarchy.locate(&t, q);
        assert_eq!(found.vertex(), by_walk.vertex());
        assert_eq!(
            matches!(found, Location::OutsideHull { .. }),
            matches!(by_walk, Location::OutsideHull { .. })
        );
    }
}
