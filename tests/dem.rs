//! The raster of a surface: the values of its cells, independent of everything else.

use breakline::data::{BlockSource, Frame, Grid, Mesh, Surface, Window};
use breakline::terrain::{
    Dem, Gradient, Hillshade, Light, Quantity, QuantityMap, Ruggedness, Shading,
};
use rayon::prelude::*;
use testkit::random::Random;

type Lattice = [i64; 2];

fn turn(a: Lattice, b: Lattice, c: Lattice) -> i64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
}

/// Triangles over integer points: a square, divided at random points and with edges flipped at
/// random. Slivers, and edges that run through lattice points, are common.
struct Patchwork {
    points: Vec<Lattice>,
    heights: Vec<f64>,
    faces: Vec<[usize; 3]>,
}

impl Patchwork {
    fn new(seed: u8, side: i64, count: usize) -> Self {
        let mut random = Random(seed.into());
        let mut patches = Patchwork {
            points: vec![[0, 0], [side, 0], [side, side], [0, side]],
            heights: Vec::new(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
        };
        for _ in 0..count {
            let p = [0, 0].map(|_| random.index(side as usize + 1) as i64);
            patches.insert(p);
            patches.flip(random.index(patches.faces.len()), random.index(3));
        }
        patches.heights = patches
            .points
            .iter()
            .map(|_| random.index(1000) as f64 / 8.0)
            .collect();
        patches
    }

    fn corners(&self, face: usize) -> [Lattice; 3] {
        self.faces[face].map(|v| self.points[v])
    }

    fn holds(&self, face: usize, p: Lattice) -> bool {
        let [a, b, c] = self.corners(face);
        turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0
    }

    fn insert(&mut self, p: Lattice) {
        if self.points.contains(&p) {
            return;
        }
        let new = self.points.len();
        self.points.push(p);
        for face in (0..self.faces.len()).rev() {
            if self.holds(face, p) {
                let [a, b, c] = self.faces.swap_remove(face);
                for (q, r) in [(a, b), (b, c), (c, a)] {
                    if turn(self.points[q], self.points[r], p) > 0 {
                        self.faces.push([q, r, new]);
                    }
                }
            }
        }
    }

    fn flip(&mut self, face: usize, i: usize) {
        let at = |k: usize| self.faces[face][(i + k) % 3];
        let (a, b, c) = (at(0), at(1), at(2));
        let across = |f: &[usize; 3]| (0..3).find(|&j| f[(j + 1) % 3] == c && f[(j + 2) % 3] == b);
        let Some((other, j)) =
            (0..self.faces.len()).find_map(|f| Some((f, across(&self.faces[f])?)))
        else {
            return;
        };
        let d = self.faces[other][j];
        let p = |v: usize| self.points[v];
        if turn(p(a), p(b), p(d)) > 0 && turn(p(a), p(d), p(c)) > 0 {
            self.faces[face] = [a, b, d];
            self.faces[other] = [a, d, c];
        }
    }

    /// The mesh with its lattice at `(left, bottom)`, vertices and faces in an order from `seed`.
    fn mesh(&self, left: f64, bottom: f64, step: f64, seed: u8) -> Mesh {
        let mut random = Random(seed.into());
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        let mut faces = self.faces.clone();
        if seed > 0 {
            for i in 0..order.len() {
                order.swap(i, random.index(i + 1));
            }
            for i in 0..faces.len() {
                faces.swap(i, random.index(i + 1));
                faces[i].rotate_left(random.index(3));
            }
        }
        let mut number = vec![0; order.len()];
        let mut vertices = Vec::new();
        for (i, &v) in order.iter().enumerate() {
            number[v] = i as u32;
            let [x, y] = self.points[v].map(|c| c as f64 * step);
            vertices.push([left + x, bottom + y, self.heights[v]]);
        }
        let faces = faces.iter().map(|f| f.map(|v| number[v])).collect();
        Mesh::new(vertices, faces, &[], None).unwrap()
    }

    /// The naive judge: looks at every face.
    fn height(&self, p: Lattice) -> Option<f64> {
        if let Some(v) = self.points.iter().position(|&q| q == p) {
            return Some(self.heights[v]);
        }
        let face = (0..self.faces.len()).find(|&f| self.holds(f, p))?;
        let [a, b, c] = self.corners(face);
        let area = |a: Lattice, b: Lattice, c: Lattice| {
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) as f64
        };
        let weights = [area(b, c, p), area(c, a, p), area(a, b, p)];
        let sum: f64 = (0..3)
            .map(|i| weights[i] * self.heights[self.faces[face][i]])
            .sum();
        Some(sum / area(a, b, c))
    }
}

fn cells(surface: &impl Surface, frame: Frame) -> Vec<f64> {
    Grid::collect(&Dem::new(surface, frame).unwrap())
        .unwrap()
        .values
}

fn bits(cells: &[f64]) -> Vec<u64> {
    cells.iter().map(|v| v.to_bits()).collect()
}

/// Frames over the lattice points -3 ..= side + 3, a cell's center on each, and for each cell the
/// point. North-up, south-up, mirrored, and turned by a quarter both ways.
fn frames(side: i64, left: f64, bottom: f64, step: f64) -> Vec<(Frame, Vec<Lattice>)> {
    let n = side + 7;
    let (low, high) = (-3.5 * step, (side as f64 + 3.5) * step);
    let turns = [
        [left + low, step, 0.0, bottom + high, 0.0, -step],
        [left + low, step, 0.0, bottom + low, 0.0, step],
        [left + high, -step, 0.0, bottom + high, 0.0, -step],
        [left + low, 0.0, step, bottom + low, step, 0.0],
        [left + high, 0.0, -step, bottom + low, step, 0.0],
    ];
    turns
        .into_iter()
        .map(|transform| {
            let frame = Frame {
                width: n as usize,
                height: n as usize,
                transform,
            };
            let point = |i: i64| {
                let [x, y] = frame.center((i % n) as usize, (i / n) as usize);
                [
                    ((x - left) / step).round() as i64,
                    ((y - bottom) / step).round() as i64,
                ]
            };
            (frame, (0..n * n).map(point).collect())
        })
        .collect()
}

#[test]
fn cells_are_those_of_the_naive_judge() {
    for (seed, side, count) in [
        (1, 6, 5),
        (2, 9, 30),
        (3, 20, 12),
        (4, 20, 200),
        (5, 40, 150),
        (6, 40, 1200),
    ] {
        let patches = Patchwork::new(seed, side, count);
        let mesh = patches.mesh(500_000.0, 5_400_000.0, 0.25, 0);
        for (frame, points) in frames(side, 500_000.0, 5_400_000.0, 0.25) {
            for (value, point) in cells(&mesh, frame).iter().zip(&points) {
                match patches.height(*point) {
                    None => assert!(
                        value.is_nan(),
                        "{value} at {point:?}, which lies outside ({seed})"
                    ),
                    Some(z) if patches.points.contains(point) => {
                        assert_eq!(*value, z, "at {point:?}")
                    }
                    Some(z) => assert!(
                        (value - z).abs() < 1e-5,
                        "{value} at {point:?}, not {z} ({seed})"
                    ),
                }
            }
        }
    }
}

#[test]
fn numbering_changes_no_bit() {
    for seed in 1..5 {
        let patches = Patchwork::new(seed, 30, 400);
        let odd = Frame {
            width: 61,
            height: 47,
            transform: [-3.3, 0.61, 0.13, 33.3, 0.17, -0.83],
        };
        let mut frames: Vec<Frame> = frames(30, 0.0, 0.0, 1.0)
            .into_iter()
            .map(|(frame, _)| frame)
            .collect();
        frames.extend([odd, Frame::north_up(-1.0, 31.0, 0.3, 110, 110)]);
        for frame in frames {
            let expected = bits(&cells(&patches.mesh(0.0, 0.0, 1.0, 0), frame));
            for order in 1..4 {
                assert_eq!(
                    bits(&cells(&patches.mesh(0.0, 0.0, 1.0, order), frame)),
                    expected
                );
            }
        }
    }
}

#[test]
fn a_block_holds_the_cells_of_the_whole() {
    let patches = Patchwork::new(7, 40, 700);
    let mesh = patches.mesh(0.0, 0.0, 1.0, 0);
    let turned = Frame {
        width: 150,
        height: 140,
        transform: [-3.3, 0.31, 0.13, 33.3, 0.11, -0.33],
    };
    for frame in [Frame::north_up(-1.5, 41.5, 0.25, 172, 172), turned] {
        let dem = Dem::new(&mesh, frame).unwrap();
        let mut whole = vec![0.0; frame.width * frame.height];
        dem.fill(frame.window(), &mut whole).unwrap();
        let mut random = Random(8);
        let windows: Vec<Window> = (0..400)
            .map(|_| {
                let (column, row) = (random.index(frame.width), random.index(frame.height));
                let width = random.index(frame.width - column + 1);
                let height = random.index(frame.height - row + 1);
                Window {
                    column,
                    row,
                    width,
                    height,
                }
            })
            .collect();
        // From many threads, as writers ask.
        windows.par_iter().for_each(|window| {
            let mut block = vec![0.0f32; window.width * window.height];
            dem.fill(*window, &mut block).unwrap();
            for (i, value) in block.iter().enumerate() {
                let (row, column) = (
                    window.row + i / window.width,
                    window.column + i % window.width,
                );
                assert_eq!(
                    value.to_bits(),
                    whole[row * frame.width + column].to_bits(),
                    "{window:?}"
                );
            }
        });
    }
}

#[test]
fn a_plane_stays_a_plane_at_map_coordinates() {
    let patches = Patchwork::new(9, 64, 900);
    let (left, bottom) = (612_345.67, 5_432_109.88);
    let plane = |x: f64, y: f64| 812.5 + 0.37 * (x - left) - 0.21 * (y - bottom);
    let skeleton = patches.mesh(left, bottom, 1.37, 0);
    let vertices: Vec<[f64; 3]> = (0..skeleton.vertex_count() as u32)
        .map(|v| {
            let [x, y, _] = skeleton.position(v);
            [x, y, plane(x, y)]
        })
        .collect();
    let faces = (0..skeleton.face_count() as u32)
        .map(|f| skeleton.face(f).unwrap())
        .collect();
    let mesh = Mesh::new(vertices, faces, &[], None).unwrap();
    let (cosine, sine) = (0.8, 0.6);
    let frames = [
        Frame::north_up(612_340.0, 5_432_210.0, 0.7, 160, 160),
        Frame {
            width: 200,
            height: 200,
            transform: [612_250.0, cosine, sine, 5_432_174.0, sine, -cosine],
        },
    ];
    for frame in frames {
        let mut inside = 0;
        for (i, value) in cells(&mesh, frame).into_iter().enumerate() {
            let [x, y] = frame.center(i % frame.width, i / frame.width);
            let depth = [
                x - left,
                left + 64.0 * 1.37 - x,
                y - bottom,
                bottom + 64.0 * 1.37 - y,
            ];
            let depth = depth.into_iter().fold(f64::INFINITY, f64::min);
            if depth.abs() < 1e-6 {
                continue;
            }
            assert_eq!(value.is_nan(), depth < 0.0, "at {x} {y}");
            if depth > 0.0 {
                let expected = plane(x, y);
                // Half a step of f32 at 800, and what the coordinates are rounded to.
                assert!(
                    (value - expected).abs() <= 3.1e-5 + 1e-8,
                    "{value} at {x} {y}, not {expected}"
                );
                inside += 1;
            }
        }
        assert!(inside > 6000);
    }
}

#[test]
fn a_level_face_is_level_to_the_bit() {
    let vertices = vec![
        [0.1, 0.2, 2733.985],
        [977.3, 11.9, 2733.985],
        [400.7, 810.4, 2733.985],
    ];
    let mesh = Mesh::new(vertices, vec![[0, 1, 2]], &[], None).unwrap();
    let values = cells(&mesh, Frame::north_up(0.0, 820.0, 1.0, 980, 820));
    assert!(
        values
            .iter()
            .all(|v| v.is_nan() || *v == f64::from(2733.985f32))
    );
    let filled = values.iter().filter(|v| !v.is_nan()).count() as f64;
    let area = ((977.2 * 810.2 - 11.7 * 400.6) / 2.0f64).abs();
    assert!((filled - area).abs() < 10.0, "{filled} cells, area {area}");
}

#[test]
fn faces_much_larger_and_much_smaller_than_cells() {
    let patches = Patchwork::new(11, 30, 300);
    let fine = patches.mesh(0.0, 0.0, 0.01, 0);
    let dem = cells(&fine, Frame::north_up(0.0, 1.0, 0.1, 10, 10));
    assert_eq!(dem.iter().filter(|v| !v.is_nan()).count(), 9);
    let sliver = Mesh::new(
        vec![[0.0, 0.0, 0.0], [1e6, 1e6, 1e6], [1e6, 1e6 - 3.0, 1e6]],
        vec![[0, 1, 2]],
        &[],
        None,
    );
    let sliver = sliver.unwrap();
    let frame = Frame::north_up(-0.5, 1e6 + 0.5, 1.0, 1_000_001, 1_000_001);
    let dem = Dem::new(&sliver, frame).unwrap();
    for column in [0, 1, 333_333, 777_777, 999_999, 1_000_000usize] {
        let mut block = vec![0.0; 16];
        let row = (1_000_000 - column).min(1_000_001 - 16);
        dem.fill(
            Window {
                column,
                row,
                width: 1,
                height: 16,
            },
            &mut block,
        )
        .unwrap();
        let on_diagonal = block[1_000_000 - column - row];
        assert!(
            (on_diagonal - column as f32).abs() < 0.1,
            "{block:?} in column {column}"
        );
        // The centers below the diagonal and inside: y >= x (1 - 3e-6).
        let below = (column as f64 * 3e-6) as usize;
        let filled = block.iter().filter(|v| !v.is_nan()).count();
        assert_eq!(filled, (below + 1).min(16), "column {column}: {block:?}");
    }
}

#[test]
fn refuses_frames_and_windows_that_make_no_sense() {
    let mesh = Patchwork::new(1, 6, 5).mesh(0.0, 0.0, 1.0, 0);
    let flat = Frame {
        width: 2,
        height: 2,
        transform: [0.0, 1.0, 2.0, 0.0, 1.0, 2.0],
    };
    let error = Dem::new(&mesh, flat).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the geotransform [0.0, 1.0, 2.0, 0.0, 1.0, 2.0] has no inverse"
    );
    let dem = Dem::new(&mesh, Frame::north_up(0.0, 6.0, 1.0, 6, 6)).unwrap();
    let mut block = vec![0.0; 4];
    let error = dem
        .fill(
            Window {
                column: 5,
                row: 0,
                width: 2,
                height: 2,
            },
            &mut block,
        )
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "a window of 2 x 2 cells at column 5 and row 0 of a raster of 6 x 6"
    );
}

/// Writes an Arc/Info ASCII grid, which needs nothing of ours.
fn ascii_grid(grid: &Grid) -> String {
    let Frame {
        width,
        height,
        transform: t,
    } = grid.frame;
    let bottom = t[3] + height as f64 * t[5];
    let mut text = format!(
        "ncols {width}\nnrows {height}\nxllcorner {}\nyllcorner {bottom}\ncellsize {}\n",
        t[0], t[1]
    );
    text.push_str("NODATA_value -9999\n");
    for row in grid.values.chunks(width) {
        let row: Vec<String> = row
            .iter()
            .map(|v| {
                if v.is_nan() {
                    "-9999".into()
                } else {
                    v.to_string()
                }
            })
            .collect();
        text.push_str(&row.join(" "));
        text.push('\n');
    }
    text
}

/// Hills with a hole, in the north-up frame of a projected system.
fn hills() -> Grid {
    let frame = Frame::north_up(500_000.0, 5_400_000.0, 2.5, 90, 70);
    let values = (0..90 * 70)
        .map(|i| {
            let (x, y) = (f64::from(i % 90), f64::from(i / 90));
            let hole = (x - 40.0).hypot(y - 30.0) < 6.0;
            if hole {
                f64::NAN
            } else {
                f64::from((40.0 * (x / 9.0).sin() * (y / 7.0).cos() + x - y) as f32)
            }
        })
        .collect();
    Grid {
        frame,
        crs: None,
        values,
    }
}

/// What a mode of `gdaldem` computes of a grid; `None` if the program is not here.
fn by_gdaldem(grid: &Grid, mode: &str, options: &[&str]) -> Option<Vec<f64>> {
    let folder = tempfile::tempdir().unwrap();
    let (input, output) = (folder.path().join("dem.asc"), folder.path().join("out.asc"));
    std::fs::write(&input, ascii_grid(grid)).unwrap();
    let run = std::process::Command::new("gdaldem")
        .args([mode, "-q", "-of", "AAIGrid"])
        .args([&input, &output])
        .args(options)
        .output();
    let Ok(run) = run else {
        eprintln!("skipped: gdaldem is not here");
        return None;
    };
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let text = std::fs::read_to_string(&output).unwrap();
    let numbers = text
        .lines()
        .filter(|line| !line.starts_with(|c: char| c.is_alphabetic()))
        .flat_map(str::split_whitespace)
        .map(|word| word.parse().unwrap());
    Some(numbers.collect())
}

#[test]
fn hillshades_are_those_of_gdaldem() {
    let grid = hills();
    for (options, light) in [
        (&[][..], Light::default()),
        (
            &["-az", "100", "-alt", "25", "-z", "0.4"],
            Light {
                azimuth: 100.0,
                altitude: 25.0,
                z_factor: 0.4,
                ..Light::default()
            },
        ),
        (
            &["-combined", "-az", "200", "-z", "3"],
            Light {
                shading: Shading::Combined,
                azimuth: 200.0,
                z_factor: 3.0,
                ..Light::default()
            },
        ),
        (
            &["-multidirectional", "-alt", "30"],
            Light {
                shading: Shading::Multidirectional,
                altitude: 30.0,
                ..Light::default()
            },
        ),
        (
            &["-igor", "-az", "100"],
            Light {
                shading: Shading::Igor,
                azimuth: 100.0,
                ..Light::default()
            },
        ),
    ] {
        let Some(theirs) = by_gdaldem(&grid, "hillshade", options) else {
            return;
        };
        let ours = Grid::collect(&Hillshade::new(&grid, light).unwrap())
            .unwrap()
            .values;
        assert_eq!(theirs.len(), ours.len());
        let mut compared = 0;
        for (i, (theirs, ours)) in theirs.iter().zip(&ours).enumerate() {
            // gdaldem leaves out the border of the data.
            if *theirs != 0.0 {
                assert!(
                    (theirs - ours).abs() <= 1.0,
                    "{ours} in cell {i}, gdaldem says {theirs}"
                );
                compared += 1;
            }
        }
        assert!(compared > 5500, "{compared}");
    }
}

#[test]
fn quantities_are_those_of_gdaldem() {
    let grid = hills();
    let by_four = Gradient::ZevenbergenThorne;
    let four = &["-alg", "ZevenbergenThorne"][..];
    for (mode, options, quantity) in [
        ("slope", &[][..], Quantity::SlopeDegrees(Gradient::Horn)),
        ("slope", &["-p"], Quantity::SlopePercent(Gradient::Horn)),
        ("slope", four, Quantity::SlopeDegrees(by_four)),
        ("aspect", &[], Quantity::Aspect(Gradient::Horn)),
        ("aspect", four, Quantity::Aspect(by_four)),
        ("roughness", &[], Quantity::Roughness),
        (
            "TRI",
            &["-alg", "Riley"],
            Quantity::Ruggedness(Ruggedness::Riley),
        ),
        (
            "TRI",
            &["-alg", "Wilson"],
            Quantity::Ruggedness(Ruggedness::Wilson),
        ),
        ("TPI", &[], Quantity::Position),
    ] {
        let Some(theirs) = by_gdaldem(&grid, mode, options) else {
            return;
        };
        let map = QuantityMap::of(&grid, quantity, 1.0, 1.0).unwrap();
        let ours = Grid::collect(&map).unwrap().values;
        assert_eq!(theirs.len(), ours.len());
        let mut compared = 0;
        for (i, (theirs, ours)) in theirs.iter().zip(&ours).enumerate() {
            // gdaldem leaves out the border of the data.
            if *theirs != -9999.0 {
                assert!(
                    (theirs - ours).abs() <= 1e-4 * ours.abs().max(1.0),
                    "{quantity:?}: {ours} in cell {i}, gdaldem says {theirs}"
                );
                compared += 1;
            }
        }
        assert!(compared > 5500, "{quantity:?}: {compared}");
    }
}
