//! Contours of the surface over the cells of a raster.

use super::surface::Faces;
use super::{bits, draw, judge, signed_area};
use breakline::data::{ContourLine, Frame, Grid, Surface};
use breakline::terrain::{GridSurface, Levels, contours};
use proptest::prelude::*;
use std::path::Path;
use testkit::shared;

const X: f64 = f64::NAN;

fn raster(width: usize, values: &[f64], transform: [f64; 6]) -> Grid {
    let frame = Frame {
        width,
        height: values.len() / width,
        transform,
    };
    Grid {
        frame,
        crs: None,
        values: values.to_vec(),
    }
}

/// The surface as a list of faces, with links found by the test; checks those of the grid.
fn copied(surface: &GridSurface<'_>) -> Faces {
    let vertices = (0..surface.vertex_count())
        .map(|v| surface.position(v as u32))
        .collect();
    let used: Vec<u32> = (0..surface.face_count() as u32)
        .filter(|&f| surface.face(f).is_some())
        .collect();
    let faces = Faces::new(
        vertices,
        used.iter().map(|&f| surface.face(f).unwrap()).collect(),
    );
    for (i, &face) in used.iter().enumerate() {
        let [a, b, c] = surface.face(face).unwrap().map(|v| surface.position(v));
        assert!(
            (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]),
            "face {face} is not counter-clockwise"
        );
        for side in 0..3 {
            let expected = faces.neighbor(i as u32, side).map(|n| used[n as usize]);
            assert_eq!(
                surface.neighbor(face, side),
                expected,
                "across side {side} of face {face}"
            );
        }
    }
    faces
}

const NORTH_UP: [f64; 6] = [100.0, 2.0, 0.0, 200.0, 0.0, -2.0];

fn cell() -> impl Strategy<Value = f64> {
    prop_oneof![4 => (0..4).prop_map(f64::from), 1 => Just(X)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn faces_are_linked_and_turned(values in prop::collection::vec(cell(), 20), turn in 0..8) {
        let [a, b, c, d] = [[2, 1, -1, 2], [2, 1, 1, -2], [-3, 0, 0, -3], [0, 1, 1, 0], [0, 1, -1, 0],
            [1, 0, 0, 1], [1, 0, 0, -1], [-1, 3, 2, 1]][turn as usize].map(f64::from);
        for width in [1, 4, 5, 20] {
            copied(&GridSurface::new(&raster(width, &values, [10.0, a, b, 20.0, c, d])).unwrap());
        }
    }

    /// South-up, mirrored and transposed rasters of the same ground give the same lines.
    #[test]
    fn storage_does_not_matter(values in prop::collection::vec(cell(), 24)) {
        let (width, height) = (6, 4);
        let at = |column: usize, row: usize| values[row * width + column];
        let stored = |width: usize, at: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..24).map(|i| at(i % width, i / width)).collect()
        };
        let (left, right, top, bottom) = (100.0, 112.0, 200.0, 192.0);
        let all = [
            raster(6, &values, NORTH_UP),
            raster(6, &stored(6, &|c, r| at(c, height - 1 - r)), [left, 2.0, 0.0, bottom, 0.0, 2.0]),
            raster(6, &stored(6, &|c, r| at(width - 1 - c, r)), [right, -2.0, 0.0, top, 0.0, -2.0]),
            raster(4, &stored(4, &|c, r| at(r, c)), [left, 0.0, 2.0, top, -2.0, 0.0]),
        ];
        let drawn = all.each_ref().map(|grid| draw(&GridSurface::new(grid).unwrap(), &[0.5, 1.0, 1.75, 2.0, 2.2]));
        for other in &drawn[1..] {
            prop_assert_eq!(&drawn[0], other);
        }
    }
}

/// Cells of a raster whose contours lie on the judge's lattice: heights between four cells are
/// whole numbers as well.
const OF_THE_JUDGE: [f64; 6] = [100.0, 4.0, 0.0, 200.0, 0.0, -4.0];

/// Compares a raster's contours to the judge's, at levels between its heights, on them and beyond.
fn judged(width: usize, values: &[f64]) {
    let grid = raster(width, values, OF_THE_JUDGE);
    let surface = GridSurface::new(&grid).unwrap();
    let faces = copied(&surface);
    for half_level in -1..=9 {
        let lines = draw(&surface, &[f64::from(half_level) / 2.0]);
        assert_eq!(
            judge::arcs_of(&lines),
            judge::arcs(&faces, half_level.into())
        );
        judge::check_lines(&faces, half_level.into(), &lines);
    }
}

#[test]
fn all_rasters_of_six_cells() {
    for number in 0..3_usize.pow(6) {
        let cells: Vec<f64> = (0..6)
            .map(|i| [0.0, 4.0, X][number / 3_usize.pow(i) % 3])
            .collect();
        judged(2, &cells);
        judged(3, &cells);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    /// Flat ground, holes and saddles at every level.
    #[test]
    fn rasters_against_the_judge(
        cells in prop::collection::vec(prop_oneof![3 => Just(0.0), 3 => Just(4.0), 1 => Just(X)], 42),
    ) {
        judged(6, &cells);
    }
}

/// More than one stretch of faces: the lines are those of single faces, with any number of threads.
#[test]
fn a_raster_is_its_faces() {
    let height = |i: u32| match i.wrapping_mul(2_654_435_769) >> 20 {
        hole if hole < 40 => X,
        flat if (i / 150) % 7 < 3 => f64::from(flat % 2),
        rough => f64::from(rough % 9) / 4.0,
    };
    let grid = raster(
        150,
        &(0..150 * 90).map(height).collect::<Vec<_>>(),
        NORTH_UP,
    );
    let surface = GridSurface::new(&grid).unwrap();
    let levels = [0.0, 0.25, 0.6, 1.0, 1.5, 2.0];
    let drawing = contours(&surface, &Levels::listed(&levels).unwrap()).unwrap();
    let count = drawing.arc_count();
    let lines = bits(&drawing.collect::<Vec<_>>());
    let drawn = lines
        .iter()
        .map(|(_, points)| points.len() - 1)
        .sum::<usize>();
    assert!(
        drawn <= count && count <= drawn + drawn / 100,
        "{count} arcs counted, {drawn} drawn"
    );
    assert_eq!(lines, bits(&draw(&copied(&surface), &levels)));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(3)
        .build()
        .unwrap();
    assert_eq!(lines, pool.install(|| bits(&draw(&surface, &levels))));
}

/// The number of lines of a raster, and a sum over all of their bits.
fn sum(path: &Path, interval: f64) -> (usize, u64) {
    let grid = breakline::io::raster::open(path)
        .unwrap()
        .read_grid()
        .unwrap();
    let surface = GridSurface::new(&grid).unwrap();
    let lines: Vec<_> = contours(&surface, &Levels::every(interval, 0.0).unwrap())
        .unwrap()
        .collect();
    let all = bits(&lines)
        .into_iter()
        .flat_map(|(level, points)| points.into_iter().flatten().chain([level]));
    (
        lines.len(),
        all.fold(0, |sum, bits| {
            (sum.rotate_left(5) ^ bits).wrapping_mul(0x517c_c1b7_2722_0a95)
        }),
    )
}

/// The lines of revision 3b6a284, bit by bit.
#[test]
fn lines_of_the_fixture_stay() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/dem.tif");
    assert_eq!(sum(&path, 1.0), (304, 15_558_705_505_747_641_504));
}

/// Like the test above, but with ties, flat ground, holes and arbitrary coordinates; since lines
/// are cut into loops, and flat ground ends at the diagonals of cells.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn lines_of_real_rasters_stay() {
    let files = [
        ("dem/lidar_sinks/dem.tif", 0.5),
        ("dem/zh_dem_25.tif", 10.0),
        ("dem/qgis_3d/dtm_with_holes.tif", 10.0),
        ("dem/hintereisferner/hef_srtm.tif", 100.0),
    ];
    assert_eq!(
        files.map(|(file, interval)| sum(&shared(file), interval)),
        [
            (310, 15_234_578_986_242_980_343),
            (287, 4_954_673_133_411_936_542),
            (53, 14_285_448_228_539_015_835),
            (374, 683_389_882_940_552_889),
        ]
    );
}

#[test]
fn three_cells_make_a_triangle() {
    let grid = raster(2, &[0.0, X, 2.0, 2.0], NORTH_UP);
    let lines = draw(&GridSurface::new(&grid).unwrap(), &[1.0]);
    // Cell centers are at 101 and 103, 199 and 197. High ground, the south, is on the right.
    let expected = ContourLine {
        level: 1.0,
        points: vec![[101.0, 198.0], [102.0, 198.0]],
    };
    assert_eq!(lines, [expected]);
    assert!(
        draw(
            &GridSurface::new(&raster(2, &[0.0, X, X, 2.0], NORTH_UP)).unwrap(),
            &[1.0]
        )
        .is_empty()
    );
}

/// The border of flat ground follows the diagonals of cells, not a staircase along them; at its own
/// height, above and below.
#[test]
fn flat_ground_has_no_staircase() {
    let size = 20;
    let slope = |flat: f64, other: f64| -> Vec<f64> {
        let height = |i: usize| {
            if i % size + i / size < size {
                flat
            } else {
                other
            }
        };
        (0..size * size).map(height).collect()
    };
    let length = |line: &ContourLine| -> f64 {
        let edges = line.points.windows(2);
        edges
            .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
            .sum()
    };
    for (values, level) in [
        (slope(3.0, 2.0), 3.0),
        (slope(2.0, 3.0), 3.0),
        (slope(3.0, 2.0), 2.5),
        (slope(3.0, 2.0), 2.125),
    ] {
        let grid = raster(size, &values, NORTH_UP);
        let lines = draw(&GridSurface::new(&grid).unwrap(), &[level]);
        assert_eq!(lines.len(), 1, "{level}");
        let [first, last] = [lines[0].points[0], *lines[0].points.last().unwrap()];
        let straight = (last[0] - first[0]).hypot(last[1] - first[1]);
        assert!(straight > 50.0);
        assert!(
            (length(&lines[0]) / straight - 1.0).abs() < 1e-12,
            "{level}"
        );
    }
}

#[test]
fn a_missing_cell_is_an_edge_of_the_data() {
    #[rustfmt::skip]
    let grid = raster(4, &[
        0.0, 0.0, 0.0, 0.0,
        0.0, 4.0, 0.0, 0.0,
        0.0, 0.0, 0.0, X,
        0.0, 0.0, 0.0, X,
    ], NORTH_UP);
    let lines = draw(&GridSurface::new(&grid).unwrap(), &[2.0]);
    assert_eq!(lines.len(), 1);
    assert!(lines[0].is_closed() && signed_area(&lines[0]) < 0.0);
    // The four crossings on the edges to the neighbors: half way.
    for p in [
        [102.0, 197.0],
        [104.0, 197.0],
        [103.0, 196.0],
        [103.0, 198.0],
    ] {
        assert!(lines[0].points.contains(&p), "{p:?} in {lines:?}");
    }
}

#[test]
fn a_cone_gives_circles() {
    let (size, step) = (201, 0.5);
    let center = step * f64::from(size) / 2.0;
    let frame = Frame::north_up(
        0.0,
        step * f64::from(size),
        step,
        size as usize,
        size as usize,
    );
    let height = |i: i32| {
        let [x, y] = frame.to_map(f64::from(i % size) + 0.5, f64::from(i / size) + 0.5);
        -(x - center).hypot(y - center)
    };
    let grid = Grid {
        frame,
        crs: None,
        values: (0..size * size).map(height).collect(),
    };
    for level in 5..45 {
        let radius = f64::from(level);
        let lines = draw(&GridSurface::new(&grid).unwrap(), &[-radius]);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].is_closed());
        for p in &lines[0].points {
            // Linear interpolation over a diagonal of a cell: off by its square over 8 radii, at
            // most.
            let off = (p[0] - center).hypot(p[1] - center) - radius;
            assert!(
                off.abs() < 2.0 * step * step / (8.0 * (radius - step)) + 1e-9,
                "{off} at radius {radius}"
            );
        }
        let circle = -std::f64::consts::PI * radius * radius;
        assert!((signed_area(&lines[0]) / circle - 1.0).abs() < 3e-3);
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let skewed = raster(2, &[0.0; 4], [0.0, 1.0, 1.0, 0.0, 2.0, 2.0]);
    assert!(
        GridSurface::new(&skewed)
            .unwrap_err()
            .to_string()
            .contains("without area")
    );
    let mut short = raster(2, &[0.0; 4], NORTH_UP);
    short.frame.height = 3;
    assert!(
        GridSurface::new(&short)
            .unwrap_err()
            .to_string()
            .contains("2 x 3")
    );
    short.frame.width = usize::MAX;
    assert!(GridSurface::new(&short).is_err());
    assert_eq!(
        GridSurface::new(&raster(1, &[0.0; 0], NORTH_UP))
            .unwrap()
            .face_count(),
        0
    );
}
