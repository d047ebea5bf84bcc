use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::AtomicBool;

use super::*;
use crate::data::{EdgeKind, Frame, Mesh};
use crate::error::Kind;
use crate::terrain::{Flat, FlatHeight, GridSurface, HighSide, TinBuilder, Wall};
use crate::triangulation::Level;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}

fn rule(bound: f64) -> SimplifyRule {
    SimplifyRule {
        limit: SimplifyLimit::MaxError(bound),
        line_tolerance: None,
    }
}

fn run(surface: &dyn Surface, rule: &SimplifyRule) -> (Tin, SimplifyReport) {
    simplify(surface, rule, &AtomicBool::new(false)).unwrap()
}

fn run_cells(grid: &Grid, rule: &SimplifyRule) -> (Tin, SimplifyReport) {
    simplify_cells(grid, rule, &AtomicBool::new(false)).unwrap()
}

/// A raster whose cell centers are whole numbers, with row 0 in the north.
fn grid(width: usize, height: usize, mut z: impl FnMut(usize, usize) -> f64) -> Grid {
    let transform = [-0.5, 1.0, 0.0, height as f64 - 0.5, 0.0, -1.0];
    let values = (0..width * height).map(|at| z(at % width, height - 1 - at / width));
    Grid {
        values: values.collect(),
        frame: Frame {
            transform,
            width,
            height,
        },
        crs: None,
    }
}

fn cells_of(grid: &Grid) -> Vec<[f64; 3]> {
    let at = |k: usize| {
        let [column, row] = [k % grid.frame.width, k / grid.frame.width];
        let [x, y] = grid.frame.to_map(column as f64 + 0.5, row as f64 + 0.5);
        [x, y, grid.values[k]]
    };
    (0..grid.values.len())
        .map(at)
        .filter(|p| !p[2].is_nan())
        .collect()
}

fn faces(surface: &dyn Surface) -> Vec<[[f64; 3]; 3]> {
    (0..surface.face_count() as u32)
        .filter_map(|face| surface.triangle(face))
        .collect()
}

/// Faces and edges on lines, whatever their numbers.
fn shape(tin: &Tin) -> BTreeSet<String> {
    let all = (0..tin.face_count() as u32).filter_map(|face| {
        let mut corners = tin.triangle(face)?;
        let edges = [0, 1, 2].map(|i| tin.edge_kind(face, i));
        let first = (0..3).min_by(|&i, &j| corners[i].partial_cmp(&corners[j]).unwrap())?;
        let mut edges = edges;
        corners.rotate_left(first);
        edges.rotate_left(first);
        Some(format!("{corners:?} {edges:?}"))
    });
    all.collect()
}

/// The naive judge, in whole numbers: each point lies in a face, and is within the bound of each
/// face that contains it. Returns the number of points on faces.
fn judge(tin: &Tin, points: &[[f64; 3]], bound: i128) -> usize {
    let whole = |p: [f64; 3]| p.map(|x| x as i128);
    let by_site: BTreeMap<[i128; 2], i128> = points
        .iter()
        .map(|&p| {
            let [x, y, z] = whole(p);
            ([x, y], z)
        })
        .collect();
    let mut found = BTreeSet::new();
    for corners in faces(tin) {
        let [a, b, c] = corners.map(whole);
        let area = |p: [i128; 3], q: [i128; 3], r: [i128; 3]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let all = area(a, b, c);
        assert!(all > 0, "{corners:?}");
        for corner in [a, b, c] {
            assert_eq!(
                by_site.get(&[corner[0], corner[1]]),
                Some(&corner[2]),
                "a vertex is given"
            );
        }
        let range = |axis: usize| {
            let of = [a[axis], b[axis], c[axis]];
            of.into_iter().min().unwrap()..=of.into_iter().max().unwrap()
        };
        for x in range(0) {
            for (&[x, y], &z) in by_site.range([x, *range(1).start()]..=[x, *range(1).end()]) {
                let q = [x, y, z];
                let weights = [area(b, c, q), area(c, a, q), area(a, b, q)];
                if weights.iter().any(|w| *w < 0) {
                    continue;
                }
                found.insert([x, y]);
                let plane = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
                assert!(
                    (plane - z * all).abs() <= bound * all,
                    "{q:?} in {corners:?}"
                );
            }
        }
    }
    assert!(tin.check(Level::Law).is_empty());
    found.len()
}

#[test]
fn small_grids_with_ties_are_within_the_bound_everywhere() {
    let mut random = Random(1);
    let mut vertices = [0, 0];
    for round in 0..120 {
        let [width, height] = [2 + random.below(24), 2 + random.below(24)].map(|n| n as usize);
        let steps = 1 + random.below(9);
        let slope = random.below(3) as f64;
        let grid = grid(width, height, |x, y| {
            slope * (x + y) as f64 + random.below(steps) as f64
        });
        let bound = 1 + round % 4;
        let (tin, report) = run_cells(&grid, &rule(bound as f64));
        let cells = cells_of(&grid);
        assert_eq!(judge(&tin, &cells, bound), cells.len());
        assert_eq!(
            (report.sites, report.vertices),
            (cells.len(), tin.report().vertices)
        );
        assert!(report.root_mean_square <= report.largest && report.largest <= report.bound);
        vertices[0] += report.vertices;
        vertices[1] += cells.len();
    }
    assert!(2 * vertices[0] < vertices[1], "{vertices:?}");
}

#[test]
fn what_is_exactly_at_the_bound_is_within_it() {
    // Every second cell is one higher than the plane of the others.
    let roof = grid(9, 9, |x, y| f64::from((x % 2 == 1 && y % 2 == 1) as u8));
    let (tin, report) = run_cells(&roof, &rule(1.0));
    assert_eq!((tin.report().vertices, report.largest), (4, 1.0));
    let (tin, _) = run_cells(&roof, &rule(1.0_f64.next_down()));
    assert!(tin.report().vertices > 4);
}

#[test]
fn blocks_are_joined_without_a_crack() {
    let mut random = Random(2);
    let grid = grid(200, 140, |x, y| {
        let hill = 40.0 * ((x as f64 / 37.0).sin() + (y as f64 / 23.0).cos());
        hill.round() + random.below(3) as f64
    });
    let cells = cells_of(&grid);
    for bound in [1, 2, 8] {
        let (tin, report) = run_cells(&grid, &rule(bound as f64));
        assert_eq!(judge(&tin, &cells, bound), cells.len());
        // More than a block's vertices were left only because of its border otherwise.
        assert!(report.vertices < cells.len() / 2, "{report:?}");
    }
}

#[test]
fn the_result_is_one_for_any_order_and_any_number_of_threads() {
    let mut random = Random(3);
    let mut points: Vec<[f64; 3]> = (0..22_000)
        .map(|_| {
            let [x, y] = [random.below(400) as f64, random.below(400) as f64];
            [x, y, ((x * y) / 700.0).round() + random.below(2) as f64]
        })
        .collect();
    let of = |points: &[[f64; 3]]| {
        let mut builder = TinBuilder::default();
        builder.add_owned_points(points.to_vec());
        let tin = builder.build().unwrap();
        run(&tin, &rule(2.0))
    };
    let (tin, report) = of(&points);
    let first = shape(&tin);
    assert!(report.vertices < report.sites / 3);
    for threads in [1, 2, 5] {
        points.reverse();
        let middle = points.len() / (1 + threads);
        points.rotate_left(middle);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let (tin, again) = pool.install(|| of(&points));
        assert_eq!((again, shape(&tin) == first), (report, true));
    }
    let mut lowest: BTreeMap<[u64; 2], f64> = BTreeMap::new();
    for [x, y, z] in points {
        let height = lowest.entry([x.to_bits(), y.to_bits()]).or_insert(z);
        *height = height.min(z);
    }
    let sites: Vec<[f64; 3]> = lowest
        .iter()
        .map(|(at, z)| [f64::from_bits(at[0]), f64::from_bits(at[1]), *z])
        .collect();
    assert_eq!(judge(&tin, &sites, 2), sites.len());
}

#[test]
fn cells_without_heights_stay_outside() {
    let mut random = Random(4);
    for round in 0..60 {
        let [width, height] = [3 + random.below(30), 3 + random.below(30)].map(|n| n as usize);
        let share = 2 + random.below(40);
        let grid = grid(width, height, |x, y| match random.below(share) {
            0 => f64::NAN,
            _ => (x + y) as f64 + random.below(3) as f64,
        });
        let Ok((tin, _)) = simplify_cells(&grid, &rule(2.0), &AtomicBool::new(false)) else {
            continue;
        };
        let given = GridSurface::new(&grid).unwrap();
        let area = |surface: &dyn Surface| -> f64 {
            let twice = |[a, b, c]: [[f64; 3]; 3]| {
                (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
            };
            faces(surface).into_iter().map(twice).sum()
        };
        assert_eq!(area(&tin), area(&given), "round {round}");
        let used = given.census().used;
        let cells = cells_of(&grid);
        let is_used = |p: &[f64; 3]| {
            let vertex = (height as f64 - 1.0 - p[1]) * width as f64 + p[0];
            used[vertex as usize]
        };
        let used: Vec<[f64; 3]> = cells.into_iter().filter(is_used).collect();
        assert_eq!(judge(&tin, &used, 2), used.len(), "round {round}");
    }
}

#[test]
fn rasters_of_any_direction_are_one_surface() {
    let z = |x: usize, y: usize| ((x * x + 3 * y) % 7) as f64;
    let north_up = grid(40, 30, z);
    let (first, _) = run_cells(&north_up, &rule(2.0));
    let mut south_up = north_up.clone();
    south_up.frame.transform[3] = -0.5;
    south_up.frame.transform[5] = 1.0;
    let rows = north_up.values.chunks(40).rev().flatten().copied();
    south_up.values = rows.collect();
    let mut mirrored = north_up.clone();
    mirrored.frame.transform[0] = 39.5;
    mirrored.frame.transform[1] = -1.0;
    for row in mirrored.values.chunks_mut(40) {
        row.reverse();
    }
    for other in [south_up, mirrored] {
        let (tin, _) = run_cells(&other, &rule(2.0));
        assert_eq!(shape(&tin), shape(&first));
    }
}

/// Points on a ramp with noise, and a breakline from west to east with a vertex at each x.
fn with_breakline(size: usize, seed: u64) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let mut random = Random(seed);
    let line: Vec<[f64; 3]> = (0..size)
        .map(|x| {
            let y = size as f64 / 2.0 + random.below(3) as f64;
            [x as f64, y, 5.0 + random.below(2) as f64]
        })
        .collect();
    let points = (0..size * size)
        .map(|at| {
            let [x, y] = [(at % size) as f64, (at / size) as f64];
            [
                x,
                y,
                (y - size as f64 / 2.0).abs().round() + random.below(2) as f64,
            ]
        })
        .collect();
    (points, line)
}

/// The lines of a surface as edges between positions.
fn line_edges(tin: &Tin, kind: EdgeKind) -> BTreeSet<[[i64; 2]; 2]> {
    let mut edges = BTreeSet::new();
    for face in 0..tin.face_count() as u32 {
        let Some(corners) = tin.triangle(face) else {
            continue;
        };
        for i in 0..3 {
            if tin.edge_kind(face, i) == kind {
                let mut ends =
                    [corners[ccw(i)], corners[cw(i)]].map(|p| [p[0] as i64, p[1] as i64]);
                ends.sort_unstable();
                edges.insert(ends);
            }
        }
    }
    edges
}

#[test]
fn no_point_changes_the_side_of_a_breakline() {
    for seed in 0..24 {
        let size = 12 + 2 * (seed as usize % 20);
        let (points, line) = with_breakline(size, seed);
        let mut builder = TinBuilder::default();
        builder.add_owned_points(points.clone());
        builder.add_breakline(&line);
        let given = builder.build().unwrap();
        let rule = SimplifyRule {
            line_tolerance: Some(1.0 + (seed % 3) as f64),
            ..rule(2.0)
        };
        let (tin, report) = run(&given, &rule);
        let [before, after] = report.line_vertices;
        assert!(before >= size && after < before, "{report:?}");
        assert_eq!(judge_given(&tin, &given), given.report().vertices);
        // The new line: one edge above each x.
        let edges = line_edges(&tin, EdgeKind::Breakline);
        let side = |edges: &BTreeSet<[[i64; 2]; 2]>, [x, y]: [i64; 2]| {
            let over = edges
                .iter()
                .filter(|[a, b]| a[0] <= x && x <= b[0] && a[0] < b[0]);
            let sides: BTreeSet<i64> = over
                .map(|[a, b]| {
                    let area = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
                    area.signum()
                })
                .collect();
            sides
        };
        let given_edges: BTreeSet<[[i64; 2]; 2]> = line_edges(&given, EdgeKind::Breakline);
        let on_line: BTreeSet<[i64; 2]> = given_edges.iter().flatten().copied().collect();
        for p in &points {
            let at = [p[0] as i64, p[1] as i64];
            if !on_line.contains(&at) {
                assert_eq!(side(&edges, at), side(&given_edges, at), "{at:?} of {seed}");
            }
        }
    }
}

/// Judges a surface by the vertices of another one.
fn judge_given(tin: &Tin, given: &Tin) -> usize {
    let used = given.census().used;
    let vertices = (0..used.len() as u32).filter(|&vertex| used[vertex as usize]);
    let points: Vec<[f64; 3]> = vertices.map(|vertex| given.position(vertex)).collect();
    judge(tin, &points, 2)
}

#[test]
fn without_a_tolerance_a_line_loses_what_is_on_it_only() {
    let mut builder = TinBuilder::default();
    let points = (0..400).map(|k| [(k % 20) as f64, (k / 20) as f64, 0.0]);
    builder.add_owned_points(points.collect());
    builder.add_breakline(&[
        [2.0, 2.0, 0.0],
        [5.0, 5.0, 0.0],
        [9.0, 9.0, 0.0],
        [9.0, 15.0, 0.0],
    ]);
    let given = builder.build().unwrap();
    let exact = SimplifyRule {
        line_tolerance: Some(0.0),
        ..rule(1.0)
    };
    let (tin, report) = run(&given, &exact);
    assert_eq!(report.line_vertices, [14, 3]);
    assert_eq!(
        line_edges(&tin, EdgeKind::Breakline),
        BTreeSet::from([[[2, 2], [9, 9]], [[9, 9], [9, 15]]])
    );
}

#[test]
fn lakes_stay_level_and_walls_stand() {
    let mut random = Random(5);
    let points: Vec<[f64; 3]> = (0..1600)
        .map(|k| {
            let [x, y] = [(k % 40) as f64, (k / 40) as f64];
            [
                x,
                y,
                if x > 20.0 { 20.0 } else { 8.0 } + random.below(3) as f64,
            ]
        })
        .collect();
    let mut builder = TinBuilder::default();
    builder.add_owned_points(points);
    let shore: Vec<[f64; 3]> = (0..40)
        .map(|k| {
            let angle = f64::from(k) / 40.0 * std::f64::consts::TAU;
            [10.5 + 6.0 * angle.cos(), 20.5 + 6.0 * angle.sin(), 7.0]
        })
        .collect();
    let ring: Vec<[f64; 3]> = shore.iter().chain(&shore[..1]).copied().collect();
    builder.add_flat(Flat::new(&[ring], FlatHeight::Given(7.0)).unwrap());
    let upper: Vec<[f64; 3]> = (2..37).map(|y| [20.75, f64::from(y), 20.0]).collect();
    let wall = Wall::new(&upper, &[8.0; 35], 0.5, HighSide::Right).unwrap();
    builder.add_wall(&wall);
    let given = builder.build().unwrap();
    let (tin, report) = run(&given, &rule(3.0));
    let [before, after] = report.line_vertices;
    assert!(after < before / 2, "{report:?}");
    let heights = |kind: EdgeKind| -> BTreeSet<i64> {
        let mut heights = BTreeSet::new();
        for face in 0..tin.face_count() as u32 {
            for i in 0..3 {
                if tin.face(face).is_some() && tin.edge_kind(face, i) == kind {
                    let corners = tin.triangle(face).unwrap();
                    heights.extend([corners[ccw(i)][2], corners[cw(i)][2]].map(|z| z as i64));
                }
            }
        }
        heights
    };
    assert_eq!(heights(EdgeKind::Shore), BTreeSet::from([7]));
    assert_eq!(heights(EdgeKind::Wall), BTreeSet::from([8, 20]));
    assert_eq!(tin.elevation(10.5, 20.5), Some(7.0));
    assert_eq!(tin.elevation(12.0, 23.0), Some(7.0));
    for y in 3..36 {
        let y = f64::from(y) + 0.5;
        assert_eq!(
            [20.25, 20.75].map(|x| tin.elevation(x, y)),
            [Some(8.0), Some(20.0)]
        );
    }
}

#[test]
fn a_number_of_vertices_is_kept_to() {
    let grid = grid(120, 90, |x, y| {
        30.0 * ((x as f64 / 17.0).sin() * (y as f64 / 11.0).cos())
            + ((x * 7 + y * 13) % 5) as f64 / 10.0
    });
    for target in [10, 100, 1000, 5000] {
        let rule = SimplifyRule {
            limit: SimplifyLimit::Target(target),
            line_tolerance: None,
        };
        let (tin, report) = run_cells(&grid, &rule);
        let count = tin.report().vertices as u64;
        assert!(
            count <= target && count * 10 >= target * 9,
            "{target}: {report:?}"
        );
        assert!(report.largest <= report.bound);
    }
    let all = SimplifyRule {
        limit: SimplifyLimit::Target(1 << 40),
        line_tolerance: None,
    };
    let (_, report) = run_cells(&grid, &all);
    assert!(report.largest < 1e-9, "{report:?}");
}

#[test]
fn what_has_no_surface_is_refused() {
    let refused = |grid: &Grid, rule: &SimplifyRule| {
        simplify_cells(grid, rule, &AtomicBool::new(false)).unwrap_err()
    };
    let flat = grid(5, 5, |_, _| 1.0);
    for bound in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(&flat, &rule(bound)).kind(), Kind::Usage, "{bound}");
    }
    let few = SimplifyRule {
        limit: SimplifyLimit::Target(2),
        line_tolerance: None,
    };
    assert_eq!(refused(&flat, &few).kind(), Kind::Usage);
    let tolerance = SimplifyRule {
        line_tolerance: Some(f64::NAN),
        ..rule(1.0)
    };
    assert_eq!(refused(&flat, &tolerance).kind(), Kind::Usage);
    for grid in [
        grid(5, 1, |_, _| 1.0),
        grid(1, 5, |_, _| 1.0),
        grid(5, 5, |_, _| f64::NAN),
        grid(0, 0, |_, _| 1.0),
    ] {
        assert_eq!(refused(&grid, &rule(1.0)).kind(), Kind::Format);
    }
    let huge = grid(3, 3, |x, _| if x == 1 { 1e300 } else { 0.0 });
    assert_eq!(refused(&huge, &rule(1.0)).kind(), Kind::Limit);
    let canceled = simplify_cells(&flat, &rule(1.0), &AtomicBool::new(true)).unwrap_err();
    assert_eq!(canceled.kind(), Kind::Canceled);
}

/// The area of a surface in plan.
fn area(surface: &dyn Surface) -> f64 {
    let triangles = (0..surface.face_count() as u32).filter_map(|face| surface.face(face));
    triangles
        .map(|corners| crate::data::area_of(corners.map(|vertex| surface.position(vertex))))
        .sum()
}

#[test]
fn faces_with_vertices_of_their_own_are_one_surface() {
    let height = |x: u32, y: u32| f64::from(x * x + 3 * y) / 40.0;
    let corner = |x: u32, y: u32| [f64::from(x), f64::from(y), height(x, y)];
    let mut triangles: Vec<[[f64; 3]; 3]> = Vec::new();
    for (x, y) in (0..12).flat_map(|x| (0..12).map(move |y| (x, y))) {
        let [a, b, c, d] =
            [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| corner(x, y));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let soup = |triangles: &[[[f64; 3]; 3]]| {
        let faces = (0..triangles.len() as u32).map(|face| [0, 1, 2].map(|k| 3 * face + k));
        Mesh::new(
            triangles.as_flattened().to_vec(),
            faces.collect(),
            &[],
            None,
        )
        .unwrap()
    };
    let forward = soup(&triangles);
    triangles.reverse();
    let backward = soup(&triangles);
    let mut counts = BTreeSet::new();
    for mesh in [forward, backward] {
        let (tin, report) = run(&mesh, &rule(0.3));
        assert_eq!(area(&tin), 144.0);
        assert!(report.largest <= 0.3);
        counts.insert(tin.vertex_count());
    }
    assert!(
        counts.len() == 1 && counts.first() < Some(&120),
        "{counts:?}"
    );
}

#[test]
fn a_long_straight_line_ends_as_one_edge() {
    let mut builder = TinBuilder::default();
    let count = 600;
    let along = |y: f64| (0..=count).map(move |k| [f64::from(k), y, 0.0]);
    builder.add_owned_points(along(0.0).chain(along(9.0)).collect());
    builder.add_breakline(&along(4.0).collect::<Vec<_>>());
    let tin = builder.build().unwrap();
    let (simplified, _) = run(&tin, &rule(0.1));
    assert_eq!(simplified.vertex_count(), 6);
}

#[test]
fn triangles_on_a_lattice_are_measured_as_cell_by_cell() {
    use super::error::Worst;
    use super::lattice::Lattice;
    let mut random = Random(7);
    let mut left_out = 0;
    for round in 0..40 {
        let [columns, rows] = [1 + random.below(90), 1 + random.below(90)].map(|n| n as usize);
        let slope = random.below(3) as f64 / 4.0;
        // Level water or an even slope, with a few rocks and gaps.
        let heights: Vec<f64> = (0..columns * rows)
            .map(|site| match random.below(400) {
                0 => f64::NAN,
                1 => random.below(9) as f64,
                _ => 1.25 + slope * (site / rows) as f64,
            })
            .collect();
        let lattice = Lattice::new(rows as u32, heights.clone());
        for _ in 0..60 {
            let corners = [0; 3].map(|_| random.below(heights.len() as u64) as u32);
            let at = |site: u32| [i64::from(site) / rows as i64, i64::from(site) % rows as i64];
            let turn = |a: u32, b: u32, c: u32| {
                let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(at);
                (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            };
            let [a, b, c] = corners;
            if turn(a, b, c) == 0 || corners.iter().any(|&k| heights[k as usize].is_nan()) {
                assert!(turn(a, b, c) != 0 || lattice.columns(corners).is_err());
                continue;
            }
            let contains = |q: &u32| {
                let sides = [turn(a, b, *q), turn(b, c, *q), turn(c, a, *q)];
                sides.iter().all(|s| *s >= 0) || sides.iter().all(|s| *s <= 0)
            };
            let cells: Vec<u32> = (0..heights.len() as u32).filter(contains).collect();
            let (mut found, mut naive) = (Vec::new(), Worst::NONE);
            for column in lattice.columns(corners).unwrap().all() {
                for k in 0..column.heights.len() {
                    found.push(column.first + k as u32);
                    let error = column.residual(k).abs();
                    if error > naive.error {
                        naive = Worst {
                            error,
                            site: column.first + k as u32,
                        };
                    }
                }
            }
            assert_eq!(found, cells, "round {round}, {corners:?}");
            assert_eq!(lattice.worst(corners, f64::INFINITY).0, naive);
            let limit = random.below(8) as f64;
            let (worst, _) = lattice.worst(corners, limit);
            assert_eq!(worst.error > limit, naive.error > limit);
            left_out += found.len();
            let mut some = lattice.columns(corners).unwrap();
            while let Some(column) = some.next_above(naive.error) {
                left_out -= column.heights.len();
            }
        }
    }
    assert!(left_out > 10_000, "{left_out}");
}
