//! Tiles of small integer grids, where ties are the rule, against the triangulation in one piece.

use rustc_hash::FxHashMap;

use super::*;
use crate::data::EdgeKind;
use crate::error::Result;
use crate::triangulation::Delaunay2;
use crate::triangulation::geometry::Plane;
use testkit::random::Random;

/// A triangle by its corners in plan, from the smallest on, and the ranks of the edges opposite
/// them.
pub(super) type Triangle = ([[u64; 2]; 3], [u8; 3]);

pub(super) fn canonical(corners: [[f64; 2]; 3], edges: [EdgeKind; 3]) -> Triangle {
    let bits = corners.map(|p| p.map(f64::to_bits));
    let first = (0..3).min_by_key(|&i| bits[i]).unwrap_or(0);
    let order = [0, 1, 2].map(|k| (first + k) % 3);
    (order.map(|i| bits[i]), order.map(|i| edges[i].rank()))
}

const PLAIN: [EdgeKind; 3] = [EdgeKind::Plain; 3];

/// The triangulation of all points.
fn whole(points: &[[f64; 3]]) -> Vec<Triangle> {
    let sites: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
    let (t, _) = Delaunay2::from_points(Plane::default(), &sites).unwrap();
    if t.dimension() < 2 {
        return Vec::new();
    }
    let mut triangles: Vec<Triangle> = t
        .finite_cells()
        .map(|cell| canonical(t.tds().corners(cell).map(|v| *t.point(v)), PLAIN))
        .collect();
    triangles.sort_unstable();
    triangles
}

/// Cuts an axis at some coordinates: the lowest and the highest of each part.
fn parts(cuts: &[f64]) -> Vec<[f64; 2]> {
    let bounds: Vec<f64> = [f64::NEG_INFINITY]
        .into_iter()
        .chain(cuts.iter().copied())
        .chain([f64::INFINITY])
        .collect();
    bounds.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The tasks that a triangulation in tiles consists of. A test that breaks a rule overrides one.
pub(super) trait Tasks {
    /// Returns the tile of a task, from the one between the cuts.
    fn tile(&self, tile: Tile) -> Tile {
        tile
    }

    fn leaf(
        &self,
        tile: &Tile,
        number: u32,
        points: &[[f64; 3]],
        constraints: &[SubConstraint],
        emit: &mut dyn FnMut(TileTriangle),
    ) -> Result<Residual> {
        leaf(tile, number, points, constraints, 0.0, emit)
    }

    fn merge(
        &self,
        tile: &Tile,
        parts: &[Residual],
        emit: &mut dyn FnMut(TileTriangle),
    ) -> Result<Residual> {
        merge(tile, parts, 0.0, emit)
    }
}

/// The tasks as they should be.
pub(super) struct Unchanged;

impl Tasks for Unchanged {}

/// What all tasks find together.
pub(super) struct Found {
    pub triangles: Vec<Triangle>,
    /// What the tasks emit, in order.
    pub emitted: Vec<TileTriangle>,
    /// The number of vertices that leaves hand up.
    pub handed_up: usize,
    /// The number of vertices that the root gets.
    pub at_root: usize,
    /// The number of corners at a site where other triangles have another vertex.
    pub doubled: usize,
}

/// Returns the triangles that tiles find, and the number of vertices that leaves hand up.
pub(super) fn tiled(
    points: &[[f64; 3]],
    constraints: &[SubConstraint],
    cuts: [&[f64]; 2],
    fan: usize,
) -> (Vec<Triangle>, usize) {
    let found = tiled_by(&Unchanged, points, constraints, cuts, fan).unwrap();
    assert_eq!(found.doubled, 0, "a site has two vertices");
    (found.triangles, found.handed_up)
}

/// Runs tasks. Each merge joins `fan` by `fan` tiles, until one is left.
pub(super) fn tiled_by(
    tasks: &impl Tasks,
    points: &[[f64; 3]],
    constraints: &[SubConstraint],
    cuts: [&[f64]; 2],
    fan: usize,
) -> Result<Found> {
    let mut emitted: Vec<TileTriangle> = Vec::new();
    let mut vertex_at: FxHashMap<[u64; 2], [u32; 2]> = FxHashMap::default();
    let mut doubled = 0;
    let mut emit = |triangle: TileTriangle| {
        for corner in triangle.corners {
            let vertex = [corner.tile, corner.number];
            let first = vertex_at
                .entry(corner.site().map(f64::to_bits))
                .or_insert(vertex);
            doubled += usize::from(*first != vertex);
        }
        emitted.push(triangle);
    };
    let [mut columns, mut rows] = cuts.map(parts);
    let mut level: Vec<Residual> = Vec::new();
    for row in &rows {
        for column in &columns {
            let tile = tasks.tile(Tile {
                min: [column[0], row[0]],
                max: [column[1], row[1]],
            });
            let own: Vec<[f64; 3]> = points
                .iter()
                .copied()
                .filter(|p| tile.holds([p[0], p[1]]))
                .collect();
            level.push(tasks.leaf(&tile, level.len() as u32, &own, constraints, &mut emit)?);
        }
    }
    let vertices = |level: &[Residual]| level.iter().map(|residual| residual.vertices.len()).sum();
    let handed_up = vertices(&level);
    let mut at_root = 0;
    let joined = |parts: &[[f64; 2]]| [parts[0][0], parts[parts.len() - 1][1]];
    while level.len() > 1 {
        at_root = vertices(&level);
        let width = columns.len();
        let mut above = Vec::new();
        for i in (0..rows.len()).step_by(fan) {
            let i = i..rows.len().min(i + fan);
            for j in (0..width).step_by(fan) {
                let j = j..width.min(j + fan);
                let (row, column) = (joined(&rows[i.clone()]), joined(&columns[j.clone()]));
                let tile = tasks.tile(Tile {
                    min: [column[0], row[0]],
                    max: [column[1], row[1]],
                });
                let of = i
                    .clone()
                    .flat_map(|i| j.clone().map(move |j| i * width + j));
                let parts: Vec<Residual> = of.map(|k| level[k].clone()).collect();
                above.push(tasks.merge(&tile, &parts, &mut emit)?);
            }
        }
        columns = columns.chunks(fan).map(joined).collect();
        rows = rows.chunks(fan).map(joined).collect();
        level = above;
    }
    for rest in &level {
        assert!(rest.edges.iter().all(|edge| edge.is_seam) && rest.pending.is_empty());
        assert_eq!(rest.edges.len(), rest.vertices.len(), "the hull");
    }
    let of = |triangle: &TileTriangle| {
        canonical(triangle.corners.map(|corner| corner.site()), triangle.edges)
    };
    let mut triangles: Vec<Triangle> = emitted.iter().map(of).collect();
    triangles.sort_unstable();
    Ok(Found {
        triangles,
        emitted,
        handed_up,
        at_root,
        doubled,
    })
}

/// The number of sets, which the environment sets:
/// `BREAKLINE_TILES=20000 cargo test --release --lib tiles`.
pub(super) fn count() -> usize {
    std::env::var("BREAKLINE_TILES")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(400)
}

#[test]
fn tiles_give_the_triangles_of_the_whole() {
    let mut random = Random(11);
    for round in 0..count() {
        let side = [3, 6, 12, 40][round % 4];
        let far = [0.0, 1e6, -0.3][round % 3];
        let scale = [1.0, 0.1, 1e-3][round / 4 % 3];
        let mut coordinate = || far + scale * random.below(side as u64 + 1) as f64;
        let all: Vec<[f64; 2]> = (0..2 + round % 60)
            .map(|_| [coordinate(), coordinate()])
            .collect();
        // On a line, or on a circle, now and then.
        let all: Vec<[f64; 3]> = match round % 10 {
            0 => all.iter().map(|p| [p[0], far, 1.0]).collect(),
            1 => (0..40)
                .map(|k| f64::from(k).sin_cos())
                .map(|(y, x)| {
                    [
                        far + scale * (5.0 * x).round(),
                        far + scale * (5.0 * y).round(),
                        0.0,
                    ]
                })
                .collect(),
            _ => all.iter().map(|p| [p[0], p[1], p[0]]).collect(),
        };
        // Cuts through points, and beside them; some tiles are empty, some one point thick.
        let mut cut = || {
            let mut cuts: Vec<f64> = (0..random.below(5))
                .map(|_| {
                    far + scale
                        * (random.below(2 * side as u64 + 2) as f64 * 0.5
                            - 0.25 * random.below(2) as f64)
                })
                .collect();
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
            cuts
        };
        let (x, y) = (cut(), cut());
        let fan = 2 + round % 3;
        let (found, _) = tiled(&all, &[], [&x, &y], fan);
        assert_eq!(
            found,
            whole(&all),
            "round {round}: {all:?}, cut at {x:?} and {y:?}, fan {fan}"
        );
    }
}

#[test]
fn few_vertices_are_handed_up() {
    let mut random = Random(3);
    let points: Vec<[f64; 3]> = (0..20_000)
        .map(|_| [random.unit(), random.unit(), 0.0])
        .collect();
    let cuts = [0.25, 0.5, 0.75];
    let (found, handed_up) = tiled(&points, &[], [&cuts, &cuts], 4);
    assert_eq!(found, whole(&points));
    // 5.64 sqrt(n) for a tile with neighbors all around; less at the rim.
    assert!((1_000..3_300).contains(&handed_up), "{handed_up}");
}

#[test]
fn a_point_outside_of_its_tile_is_named() {
    let tile = Tile {
        min: [0.0, 0.0],
        max: [4.0, 4.0],
    };
    let error = leaf(
        &tile,
        7,
        &[[1.0, 1.0, 0.0], [4.0, 1.0, 0.0]],
        &[],
        0.0,
        &mut |_| (),
    )
    .unwrap_err()
    .to_string();
    assert!(
        error.starts_with("point 1 of tile 7 is at 4 1, expected x from 0 to below 4"),
        "{error}"
    );
}

#[test]
fn heights_and_seams_that_make_no_sense_are_refused() {
    let error = leaf(
        &Tile::PLANE,
        0,
        &[[1.0, 2.0, f64::NAN]],
        &[],
        0.0,
        &mut |_| (),
    )
    .unwrap_err()
    .to_string();
    assert_eq!(error, "point 0: [1.0, 2.0, NaN] is not a finite point");
    let vertex = TileVertex {
        tile: 0,
        number: 0,
        position: [0.0; 3],
        is_tight: false,
    };
    let seam = ResidualEdge {
        ends: [0, 1],
        is_seam: true,
        kind: EdgeKind::Plain,
    };
    let damaged = Residual {
        vertices: vec![vertex],
        edges: vec![seam],
        ..Residual::default()
    };
    let error = merge(&Tile::PLANE, &[damaged], 0.0, &mut |_| ())
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "an edge of part 0 ends at vertex 1, expected less than 1"
    );
}

/// Residuals of different points, and a seam that is turned around.
#[test]
fn residuals_that_contradict_each_other_are_refused() {
    let mut random = Random(9);
    let mut points = || {
        (0..60)
            .map(|_| [8.0 * random.unit(), 8.0 * random.unit(), 0.0])
            .collect::<Vec<_>>()
    };
    let tile = Tile {
        min: [0.0, 0.0],
        max: [8.0, 8.0],
    };
    let rest = leaf(&tile, 0, &points(), &[], 0.0, &mut |_| ()).unwrap();
    assert!(!rest.edges.is_empty());
    let other = leaf(&tile, 1, &points(), &[], 0.0, &mut |_| ()).unwrap();
    let error = merge(&Tile::PLANE, &[rest.clone(), other], 0.0, &mut |_| ())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no edge joins") || error.contains("do not close"),
        "{error}"
    );
    let mut turned = rest;
    turned.edges.iter_mut().for_each(|seam| seam.ends.reverse());
    let error = merge(&Tile::PLANE, &[turned], 0.0, &mut |_| ())
        .unwrap_err()
        .to_string();
    assert!(error.contains("do not close"), "{error}");
}
