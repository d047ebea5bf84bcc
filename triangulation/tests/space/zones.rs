//! Conflict zones in space are what insertion destroys, and their borders are spheres.

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::geometry::{Geometry, Space, WeightedSpace};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{ConflictZone, Delaunay, Regular, Triangulation};
use testkit::random::Random;

fn sorted(mut vertices: Vec<VertexId>) -> Vec<VertexId> {
    vertices.sort_unstable();
    vertices
}

fn corners<G: Geometry<4>>(t: &Triangulation<G, 4>, cell: CellId) -> Vec<VertexId> {
    sorted(t.tds().cell_vertices(cell).to_vec())
}

fn facet<G: Geometry<4>>(t: &Triangulation<G, 4>, (cell, i): (CellId, usize)) -> Vec<VertexId> {
    let vertices = t.tds().cell_vertices(cell).iter().enumerate();
    sorted(vertices.filter(|&(k, _)| k != i).map(|(_, &v)| v).collect())
}

/// Compares the zone with the cells that the insertion has destroyed.
fn judge<G: Geometry<4>>(
    before: &Triangulation<G, 4>,
    after: &Triangulation<G, 4>,
    zone: &ConflictZone,
) {
    let all = |t: &Triangulation<G, 4>| -> BTreeSet<Vec<VertexId>> {
        t.tds().cells().map(|cell| corners(t, cell)).collect()
    };
    let destroyed: BTreeSet<_> = all(before).difference(&all(after)).cloned().collect();
    assert_eq!(zone.cells.len(), destroyed.len());
    assert_eq!(
        zone.cells
            .iter()
            .map(|&cell| corners(before, cell))
            .collect::<BTreeSet<_>>(),
        destroyed
    );

    let tds = before.tds();
    let width = before.dimension() as usize + 1;
    for &(cell, i) in &zone.border {
        assert!(zone.cells.contains(&cell) && !zone.cells.contains(&tds.neighbor(cell, i)));
    }
    let Ok(internal) = zone.internal_facets(tds);
    for &(cell, i) in &internal {
        assert!(zone.cells.contains(&cell) && zone.cells.contains(&tds.neighbor(cell, i)));
    }
    assert_eq!(
        width * zone.cells.len(),
        zone.border.len() + 2 * internal.len()
    );
    let facets: BTreeSet<_> = internal.iter().map(|&side| facet(before, side)).collect();
    assert!(width < 4 || facets.len() == internal.len());

    let border: Vec<Vec<VertexId>> = zone
        .border
        .iter()
        .map(|&side| facet(before, side))
        .collect();
    let vertices: BTreeSet<VertexId> = border.iter().flatten().copied().collect();
    match before.dimension() {
        3 => assert_eq!(border.len(), 2 * vertices.len() - 4),
        2 => assert_eq!(border.len(), vertices.len()),
        1 => assert_eq!(border.len(), 2),
        _ => assert_eq!(border.len(), 1), // a site where a heavier point takes over
    }
    if width < 3 {
        return;
    }
    let mut ridges: BTreeMap<Vec<VertexId>, usize> = BTreeMap::new();
    for facet in &border {
        for left_out in facet {
            let ridge = facet.iter().filter(|v| *v != left_out).copied().collect();
            *ridges.entry(ridge).or_default() += 1;
        }
    }
    assert!(
        ridges.values().all(|&count| count == 2),
        "the border is closed"
    );
}

fn site(random: &mut Random, sizes: [u64; 3]) -> [f64; 3] {
    sizes.map(|size| random.below(size) as f64)
}

const SIZES: [[u64; 3]; 5] = [[3, 3, 3], [5, 5, 5], [5, 5, 1], [6, 1, 1], [4, 3, 2]];

#[test]
fn of_delaunay() {
    let mut random = Random(81);
    let mut full = 0;
    for round in 0..1500 {
        let sizes = SIZES[round % 5];
        let points: Vec<[f64; 3]> = (0..random.index(30))
            .map(|_| site(&mut random, sizes))
            .collect();
        let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
        let q = site(&mut random, if round % 3 == 0 { [6, 6, 6] } else { sizes });
        let mut after = t.clone();
        after.insert(q).unwrap();
        match t.conflict_zone(&q, t.tds().cells().last()) {
            Some(zone) => {
                full += usize::from(t.dimension() == 3);
                judge(&t, &after, &zone);
            }
            None => assert!(
                after.vertex_count() == t.vertex_count() || after.dimension() > t.dimension()
            ),
        }
    }
    assert!(full > 300, "{full}");
}

#[test]
fn of_regular() {
    let mut random = Random(82);
    let (mut full, mut lost) = (0, 0);
    for round in 0..1500 {
        let (sizes, weights) = (SIZES[round % 5], 1 + random.below(12));
        let point = |random: &mut Random, sizes| {
            let [x, y, z] = site(random, sizes);
            [x, y, z, random.below(weights) as f64]
        };
        let points: Vec<[f64; 4]> = (0..random.index(30))
            .map(|_| point(&mut random, sizes))
            .collect();
        let (t, _) = Regular::from_points(WeightedSpace::new(), &points).unwrap();
        let q = point(&mut random, if round % 3 == 0 { [6, 6, 6] } else { sizes });
        let mut after = t.clone();
        let vertex = after.insert(q).unwrap();
        match t.conflict_zone(&q, t.tds().cells().last()) {
            Some(zone) => {
                full += usize::from(t.dimension() == 3);
                lost += usize::from(after.vertex_count() <= t.vertex_count());
                judge(&t, &after, &zone);
            }
            None => assert!(
                after.is_hidden(vertex)
                    || t.tds().is_vertex(vertex)
                    || after.dimension() > t.dimension(),
                "{points:?} {q:?}"
            ),
        }
    }
    assert!(full > 300 && lost > 50, "{full} {lost}");
}

#[test]
fn of_points_far_out_and_of_none() {
    let (t, _) =
        Delaunay::from_points(Space::new(), &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).unwrap();
    assert_eq!(t.conflict_zone(&[0.0, 0.0, 1.0], None), None);
    assert_eq!(t.conflict_zone(&[f64::NAN; 3], None), None);
    assert_eq!(t.conflict_zone(&[1e300, 0.0, 0.0], None), None);
    assert!(t.conflict_zone(&[1e50, 1e50, 0.0], None).is_some());
    assert_eq!(
        Delaunay::<Space, 4>::new(Space::new()).conflict_zone(&[0.0; 3], None),
        None
    );
}
