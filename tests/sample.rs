//! Heights and gradients at positions: against cells of rasters, a search of all faces, and laws.

use breakline::data::{BlockSource, Bounds, Frame, Grid, Mesh, Surface, Window};
use breakline::terrain::{
    CompactTin, Dem, FaceSlopes, Gradient, GradientMap, GridSurface, Method, Quantity, QuantityMap,
    Sample, Sampler, Tin, TinBuilder,
};
use testkit::random::Random;

/// Points on a small grid, where ties are the rule.
fn points(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    (0..count)
        .map(|_| [9, 9, 5].map(|n| random.around(n) as f64))
        .collect()
}

fn tin(points: &[[f64; 3]], bounds: Option<Bounds>) -> Option<Tin> {
    let mut builder = TinBuilder::default();
    builder.add_owned_points(points.to_vec());
    if let Some(bounds) = bounds {
        let [[x0, y0, _], [x1, y1, _]] = [bounds.min, bounds.max];
        builder.add_boundary(&[vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]]);
    }
    builder
        .build()
        .ok()
        .filter(|tin| tin.report().triangles > 0)
}

/// Returns a surface of the same triangles, whose vertices and faces have other numbers, and which
/// begin at other corners.
fn renumbered(surface: &dyn Surface) -> Mesh {
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for face in (0..surface.face_count() as u32).rev() {
        if let Some([a, b, c]) = surface.face(face) {
            let corners = [b, c, a].map(|v| {
                let p = surface.position(v);
                vertices.iter().position(|q| *q == p).unwrap_or_else(|| {
                    vertices.push(p);
                    vertices.len() - 1
                }) as u32
            });
            faces.push(corners);
        }
    }
    Mesh::new(vertices, faces, &[], None).unwrap()
}

fn samples(surface: &dyn Surface, positions: &[[f64; 2]]) -> Vec<Sample> {
    let sampler = Sampler::new(surface, Method::Linear).unwrap();
    sampler.samples(positions).unwrap()
}

fn bits(samples: &[Sample]) -> Vec<[u64; 3]> {
    let of = |sample: &Sample| {
        [sample.height, sample.gradient[0], sample.gradient[1]].map(|number| {
            match number.is_nan() {
                true => 0,
                false => number.to_bits(),
            }
        })
    };
    samples.iter().map(of).collect()
}

/// All faces that contain a position on a grid of quarters, in whole numbers.
fn faces_at(surface: &dyn Surface, q: [f64; 2]) -> Vec<[[f64; 3]; 3]> {
    let whole = |c: f64| (c * 4.0) as i64;
    let turn = |p: [f64; 3], r: [f64; 3]| {
        let [px, py, rx, ry] = [p[0], p[1], r[0], r[1]].map(whole);
        let [x, y] = q.map(whole);
        (rx - px) * (y - py) - (ry - py) * (x - px)
    };
    let holds =
        |[a, b, c]: &[[f64; 3]; 3]| turn(*a, *b) >= 0 && turn(*b, *c) >= 0 && turn(*c, *a) >= 0;
    (0..surface.face_count() as u32)
        .filter_map(|face| surface.triangle(face))
        .filter(holds)
        .collect()
}

/// The height and the gradient of a plane.
fn plane([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> (f64, [f64; 2]) {
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let area = u[0] * v[1] - u[1] * v[0];
    let gradient = [
        (u[2] * v[1] - v[2] * u[1]) / area,
        (u[0] * v[2] - v[0] * u[2]) / area,
    ];
    let height = a[2] + gradient[0] * (q[0] - a[0]) + gradient[1] * (q[1] - a[1]);
    (height, gradient)
}

fn assert_judged(surface: &dyn Surface, positions: &[[f64; 2]]) -> usize {
    let found = samples(surface, positions);
    let mut inside = 0;
    for (sample, &q) in found.iter().zip(positions) {
        let planes: Vec<_> = faces_at(surface, q)
            .into_iter()
            .map(|face| plane(face, q))
            .collect();
        assert_eq!(sample.is_some(), !planes.is_empty(), "{q:?}");
        let square = |[x, y]: [f64; 2]| x * x + y * y;
        let steepest = planes
            .iter()
            .map(|(_, gradient)| square(*gradient))
            .fold(0.0, f64::max);
        for (height, _) in &planes {
            assert!((sample.height - height).abs() < 1e-12, "{q:?}");
        }
        if !planes.is_empty() {
            inside += 1;
            assert!((square(sample.gradient) - steepest).abs() < 1e-9, "{q:?}");
            let is_one = |(_, gradient): &(f64, [f64; 2])| {
                (0..2).all(|k| (gradient[k] - sample.gradient[k]).abs() < 1e-9)
            };
            assert!(planes.iter().any(is_one), "{q:?}");
        }
    }
    inside
}

/// Positions on vertices, on edges, within and outside, at quarters.
fn positions() -> Vec<[f64; 2]> {
    let at = |i: usize| i as f64 / 4.0 - 10.0;
    (0..81)
        .flat_map(|row| (0..81).map(move |column| [at(column), at(row)]))
        .collect()
}

#[test]
fn samples_are_those_of_all_faces_searched() {
    let mut random = Random(90);
    let mut judged = 0;
    for round in 0..24 {
        let Some(tin) = tin(&points(&mut random, 3 + 2 * round), None) else {
            continue;
        };
        judged += assert_judged(&tin, &positions());
        judged += assert_judged(&renumbered(&tin), &positions());
    }
    assert!(judged > 10_000, "{judged}");
}

#[test]
fn a_sample_does_not_depend_on_how_the_surface_is_kept_or_on_the_order() {
    let mut random = Random(91);
    let bounds = Bounds {
        min: [-5.0, -4.5, 0.0],
        max: [6.25, 7.0, 0.0],
    };
    let mut compared = 0;
    for round in 0..12 {
        for bounds in [None, Some(bounds)] {
            let Some(tin) = tin(&points(&mut random, 5 + 4 * round), bounds) else {
                continue;
            };
            let positions = positions();
            let found = samples(&tin, &positions);
            compared += found.iter().filter(|sample| sample.is_some()).count();
            let mut file = Vec::new();
            tin.write_tin(&mut file).unwrap();
            let compact = CompactTin::open(file, "bytes").unwrap();
            assert_eq!(bits(&found), bits(&samples(&compact, &positions)));
            assert_eq!(bits(&found), bits(&samples(&renumbered(&tin), &positions)));
            let backwards: Vec<_> = positions.iter().rev().copied().collect();
            let mut reversed = samples(&tin, &backwards);
            reversed.reverse();
            assert_eq!(bits(&found), bits(&reversed));
            let alone: Vec<Sample> = positions
                .iter()
                .step_by(97)
                .flat_map(|&q| samples(&tin, &[q]))
                .collect();
            let some: Vec<Sample> = found.into_iter().step_by(97).collect();
            assert_eq!(bits(&some), bits(&alone));
        }
    }
    assert!(compared > 10_000, "{compared}");
}

/// Returns a quantity of faces in cells, as 32-bit floats.
fn of_faces(surface: &dyn Surface, frame: Frame, quantity: Quantity) -> Vec<f32> {
    let map = GradientMap::new(surface, frame).unwrap();
    let slopes = FaceSlopes::of(map, quantity, 2.0, 4.0).unwrap();
    let cells = Grid::collect(&slopes).unwrap().values;
    let some = Window {
        column: 3,
        row: 2,
        width: 11,
        height: 7,
    };
    let mut window = vec![0.0; some.width * some.height];
    slopes.fill(some, &mut window).unwrap();
    let of_window = (0..some.height).flat_map(|row| {
        let first = (some.row + row) * frame.width + some.column;
        &cells[first..first + some.width]
    });
    let bits = |cell: f32| if cell.is_nan() { 0 } else { cell.to_bits() };
    assert!(
        of_window
            .map(|c| bits(*c as f32))
            .eq(window.into_iter().map(bits))
    );
    cells.into_iter().map(|cell| cell as f32).collect()
}

/// The slopes of faces are those of samples, and of planes solved for each face at the center.
#[test]
fn slopes_of_faces_in_cells_are_those_of_samples() {
    let mut random = Random(98);
    let bounds = Bounds {
        min: [-5.0, -4.5, 0.0],
        max: [6.25, 7.0, 0.0],
    };
    // Centers on vertices and edges; at quarters; south up; rotated with exact numbers.
    let frames = [
        Frame::north_up(-9.5, 9.5, 1.0, 19, 19),
        Frame::north_up(-9.125, 9.125, 0.25, 70, 70),
        Frame {
            width: 30,
            height: 28,
            transform: [-9.5, 0.5, 0.0, -8.25, 0.0, 0.5],
        },
        Frame {
            width: 24,
            height: 24,
            transform: [0.0, 0.5, -0.5, -10.0, 0.5, 0.5],
        },
    ];
    let mut compared = 0;
    for round in 0..6 {
        for bounds in [None, Some(bounds)] {
            let Some(tin) = tin(&points(&mut random, 5 + 8 * round), bounds) else {
                continue;
            };
            let mut file = Vec::new();
            tin.write_tin(&mut file).unwrap();
            let compact = CompactTin::open(file, "bytes").unwrap();
            let other = renumbered(&tin);
            // On edges that were cut a rotated raster rounds in its own way.
            let exact = if bounds.is_some() { 3 } else { 4 };
            for &frame in &frames[..exact] {
                let centers: Vec<[f64; 2]> = (0..frame.width * frame.height)
                    .map(|i| frame.center(i % frame.width, i / frame.width))
                    .collect();
                let found = samples(&tin, &centers);
                for (quantity, expected) in [
                    (Quantity::SlopeDegrees(Gradient::Faces), 0),
                    (Quantity::SlopePercent(Gradient::Faces), 1),
                    (Quantity::Aspect(Gradient::Faces), 2),
                ] {
                    let surfaces: [&dyn Surface; 3] = [&tin, &compact, &other];
                    let all = surfaces.map(|surface| of_faces(surface, frame, quantity));
                    for (i, sample) in found.iter().enumerate() {
                        let [slope, aspect] = sample.slope_and_aspect(2.0, 4.0);
                        let value =
                            [slope.atan().to_degrees(), 100.0 * slope, aspect][expected] as f32;
                        let is_same = |cell: f32| {
                            cell.to_bits() == value.to_bits() || cell.is_nan() && value.is_nan()
                        };
                        assert!(
                            all.iter().all(|cells| is_same(cells[i])),
                            "{value} at {:?} of {frame:?}",
                            centers[i]
                        );
                        compared += usize::from(!value.is_nan());
                    }
                }
                if bounds.is_some() || frame.transform[1] < 0.5 {
                    continue;
                }
                // Independently: planes through the faces that have the center, in whole numbers.
                let slopes = of_faces(&tin, frame, Quantity::SlopePercent(Gradient::Faces));
                for (slope, &q) in slopes.iter().zip(&centers) {
                    let steepest = faces_at(&tin, q)
                        .into_iter()
                        .map(|face| plane(face, q).1)
                        .map(|[x, y]| 100.0 * (x * 0.5).hypot(y * 2.0));
                    let expected: Vec<f64> = steepest.collect();
                    assert_eq!(slope.is_nan(), expected.is_empty(), "{q:?}");
                    let near = |e: &f64| (f64::from(*slope) - e).abs() <= 1e-6 * e.max(1.0);
                    assert!(expected.is_empty() || expected.iter().any(near), "{q:?}");
                }
            }
        }
    }
    assert!(compared > 50_000, "{compared}");
}

#[test]
fn slopes_of_faces_are_refused_where_there_are_none() {
    let grid = Grid {
        frame: Frame::north_up(0.0, 2.0, 1.0, 2, 2),
        crs: None,
        values: vec![0.0; 4],
    };
    let of_cells = QuantityMap::of(&grid, Quantity::SlopeDegrees(Gradient::Faces), 1.0, 1.0);
    let error = of_cells.unwrap_err().to_string();
    assert!(error.contains("a raster has none"), "{error}");
    let tin = tin(&points(&mut Random(1), 9), None).unwrap();
    let map = GradientMap::new(&tin, grid.frame).unwrap();
    assert!(FaceSlopes::of(map, Quantity::Roughness, 1.0, 1.0).is_err());
}

fn assert_as_cells(surface: &dyn Surface, frame: Frame, method: Method) -> usize {
    let dem = Dem::new(surface, frame)
        .unwrap()
        .with_method(method)
        .unwrap();
    let cells = Grid::collect(&dem).unwrap();
    let centers: Vec<[f64; 2]> = (0..frame.height)
        .flat_map(|row| (0..frame.width).map(move |column| frame.center(column, row)))
        .collect();
    let found = Sampler::new(surface, method)
        .unwrap()
        .samples(&centers)
        .unwrap();
    for ((cell, sample), q) in cells.values.iter().zip(&found).zip(&centers) {
        // Cells have 32 bits.
        let height = sample.height as f32;
        let cell = *cell as f32;
        assert!(
            height.to_bits() == cell.to_bits() || height.is_nan() && cell.is_nan(),
            "{height} for {cell} at {q:?} by {method:?}"
        );
    }
    found.iter().filter(|sample| sample.is_some()).count()
}

#[test]
fn heights_are_those_of_cells_bit_for_bit() {
    let mut random = Random(92);
    let bounds = Bounds {
        min: [-5.3, -4.1, 0.0],
        max: [6.7, 7.9, 0.0],
    };
    let frames = [
        Frame::north_up(-10.5, 10.5, 1.0, 21, 21),
        Frame::north_up(-10.0, 10.0, 0.3, 67, 67),
        Frame::north_up(-9.9, 9.7, 0.7, 28, 28),
    ];
    let mut compared = 0;
    for round in 0..6 {
        let whole = points(&mut random, 8 + 12 * round);
        let scattered: Vec<[f64; 3]> = (0..40 * round + 5)
            .map(|_| [0, 1, 2].map(|_| random.unit() * 20.0 - 10.0))
            .collect();
        for points in [whole, scattered] {
            for bounds in [None, Some(bounds)] {
                let Some(tin) = tin(&points, bounds) else {
                    continue;
                };
                for frame in frames {
                    compared += assert_as_cells(&tin, frame, Method::Linear);
                    compared += assert_as_cells(&renumbered(&tin), frame, Method::Linear);
                }
                for method in [Method::Nearest, Method::Natural, Method::Smooth] {
                    compared += assert_as_cells(&tin, frames[0], method);
                }
            }
        }
    }
    assert!(compared > 50_000, "{compared}");
}

#[test]
fn a_raster_has_its_cells_at_their_centers_and_holes_where_they_are() {
    let mut random = Random(93);
    for transform in [
        [500.0, 0.5, 0.0, 800.0, 0.0, -0.5],
        [500.0, 0.5, 0.0, 800.0, 0.0, 0.5],
        [10.0, 0.6, -0.8, 20.0, 0.8, 0.6],
    ] {
        let frame = Frame {
            width: 17,
            height: 13,
            transform,
        };
        let values: Vec<f64> = (0..17 * 13)
            .map(|_| match random.below(6) {
                0 => f64::NAN,
                _ => random.around(40) as f64 / 4.0,
            })
            .collect();
        let grid = Grid {
            frame,
            crs: None,
            values: values.clone(),
        };
        let surface = GridSurface::new(&grid).unwrap();
        let at = |column: f64, row: f64| frame.to_map(column + 0.5, row + 0.5);
        let centers: Vec<[f64; 2]> = (0..13)
            .flat_map(|row| (0..17).map(move |column| at(column as f64, row as f64)))
            .collect();
        let mesh = renumbered(&surface);
        let found = samples(&surface, &centers);
        let of_mesh = samples(&mesh, &centers);
        for ((sample, other), value) in found.iter().zip(&of_mesh).zip(&values) {
            // A cell among missing ones is not part of a triangle.
            assert_eq!(sample.is_some(), other.is_some());
            assert!(!sample.is_some() || sample.height.to_bits() == value.to_bits());
        }
        let between: Vec<[f64; 2]> = (0..3000)
            .map(|_| at(random.unit() * 19.0 - 1.5, random.unit() * 15.0 - 1.5))
            .collect();
        assert_eq!(
            bits(&samples(&surface, &between)),
            bits(&samples(&mesh, &between))
        );
        let nearest = Sampler::new(&surface, Method::Nearest).unwrap();
        let found = nearest.samples(&between).unwrap();
        let mut counted = 0;
        for (sample, &q) in found.iter().zip(&between).filter(|(s, _)| s.is_some()) {
            let away = |cell: usize| (centers[cell][0] - q[0]).hypot(centers[cell][1] - q[1]);
            let known = (0..values.len()).filter(|&cell| values[cell].is_finite());
            let cell = known.min_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap();
            // A cell among missing ones is not part of a triangle, and so none of the nearest.
            if samples(&surface, &[centers[cell]])[0].is_some() {
                assert_eq!(sample.height, values[cell]);
                counted += 1;
            }
        }
        assert!(counted > 1000, "{counted}");
    }
}

#[test]
fn what_is_not_finite_or_far_away_is_outside() {
    let tin = tin(&[[0.0, 0.0, 1.0], [4.0, 0.0, 2.0], [0.0, 4.0, 3.0]], None).unwrap();
    let odd = [
        [f64::NAN, 1.0],
        [1.0, f64::INFINITY],
        [1e308, 1.0],
        [-1e-320, 1.0],
        [1.0, 1.0],
    ];
    for surface in [&tin as &dyn Surface, &renumbered(&tin)] {
        let found = samples(surface, &odd);
        let heights: Vec<bool> = found.iter().map(Sample::is_some).collect();
        // A coordinate below the range of the arithmetic counts as 0.
        assert_eq!(heights, [false, false, false, true, true]);
        assert_eq!(found[4].gradient, [0.25, 0.5]);
        assert_eq!(samples(surface, &[]).len(), 0);
    }
}
