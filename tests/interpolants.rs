//! Heights between the vertices of a surface, by each method: laws, slow judges, and independence
//! of everything but the surface.

use breakline::data::{BlockSource, EdgeKind, Frame, Grid, Mesh, Surface, Window};
use breakline::terrain::{CompactTin, Dem, Interpolant, Method, Tin, TinBuilder};
use testkit::random::Random;

type Point = [f64; 3];
type Site = [f64; 2];

const ALL: [Method; 6] = [
    Method::Linear,
    Method::Nearest,
    Method::Natural,
    Method::Laplace,
    Method::Smooth,
    Method::Idw,
];

/// Those that go through the vertices and reproduce planes.
const EXACT: [Method; 4] = [
    Method::Linear,
    Method::Natural,
    Method::Laplace,
    Method::Smooth,
];

fn builder(points: &[Point]) -> TinBuilder {
    let column = |i: usize| points.iter().map(|p| p[i]).collect::<Vec<_>>();
    let mut builder = TinBuilder::default();
    builder.add_points(&column(0), &column(1), &column(2));
    builder
}

fn tin(points: &[Point], lines: &[Vec<Point>]) -> Tin {
    let mut builder = builder(points);
    lines.iter().for_each(|line| builder.add_breakline(line));
    builder.build().unwrap()
}

fn height(surface: &dyn Surface, method: Method, [x, y]: Site) -> Option<f64> {
    Interpolant::new(surface, method).unwrap().height(x, y)
}

/// Points on a small integer grid: many are cocircular, collinear, or equal to a position.
fn on_grid(random: &mut Random, count: usize, side: i64) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    while points.len() < count {
        let [x, y] = [0, 0].map(|_| random.index(side as usize + 1) as f64);
        if points.iter().all(|p| [p[0], p[1]] != [x, y]) {
            points.push([x, y, random.index(100) as f64]);
        }
    }
    points
}

fn scattered(random: &mut Random, count: usize, side: f64) -> Vec<Point> {
    (0..count)
        .map(|_| {
            [
                side * random.unit(),
                side * random.unit(),
                10.0 * random.unit(),
            ]
        })
        .collect()
}

/// Cuts a convex polygon: keeps what is nearer to `p` than to `r`.
fn nearer(polygon: &[Site], p: Site, r: Site) -> Vec<Site> {
    let excess = |q: Site| {
        let [dp, dr] = [p, r].map(|s| (q[0] - s[0]).powi(2) + (q[1] - s[1]).powi(2));
        dp - dr
    };
    let mut cut = Vec::new();
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (excess(a), excess(b));
        if at_a <= 0.0 {
            cut.push(a);
        }
        if (at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0) {
            let part = at_a / (at_a - at_b);
            cut.push([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
        }
    }
    cut
}

fn area(polygon: &[Site]) -> f64 {
    let turn = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (a[0] - polygon[0][0]) * (b[1] - polygon[0][1])
            - (a[1] - polygon[0][1]) * (b[0] - polygon[0][0])
    };
    (0..polygon.len()).map(turn).sum::<f64>() / 2.0
}

/// The slow judge: Voronoi cells as clipped polygons. `None` if the cell of the position is not
/// bounded well.
fn stolen(points: &[Point], q: Site) -> Option<[f64; 2]> {
    const FAR: f64 = 1e3;
    let site = |p: &Point| [p[0], p[1]];
    let square = vec![[-FAR, -FAR], [FAR, -FAR], [FAR, FAR], [-FAR, FAR]];
    let cell = points
        .iter()
        .fold(square, |cell, p| nearer(&cell, q, site(p)));
    if cell.iter().flatten().any(|c| c.abs() >= FAR) {
        return None;
    }
    let (mut sibson, mut sum) = (0.0, 0.0);
    let (mut laplace, mut lengths) = (0.0, 0.0);
    for p in points {
        let others = points.iter().filter(|r| site(r) != site(p));
        let lost =
            area(&others.fold(cell.clone(), |part, r| nearer(&part, site(p), site(r)))).max(0.0);
        sibson += lost * p[2];
        sum += lost;
        // The part of the border of the cell that lies halfway between the position and the point.
        let on = |c: &Site| {
            let [dq, dp] = [q, site(p)].map(|s| (c[0] - s[0]).hypot(c[1] - s[1]));
            (dq - dp).abs() < 1e-9
        };
        let length: f64 = (0..cell.len())
            .map(|i| (cell[i], cell[(i + 1) % cell.len()]))
            .filter(|(a, b)| on(a) && on(b))
            .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
            .sum();
        let weight = length / (q[0] - p[0]).hypot(q[1] - p[1]);
        laplace += weight * p[2];
        lengths += weight;
    }
    Some([sibson / sum, laplace / lengths])
}

#[test]
fn natural_neighbors_agree_with_clipped_voronoi_cells() {
    let mut judged = 0;
    for round in 0..60 {
        let mut random = Random(round);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 25, 7)
        } else {
            scattered(&mut random, 30, 7.0)
        };
        let tin = tin(&points, &[]);
        let natural = Interpolant::new(&tin, Method::Natural).unwrap();
        let laplace = Interpolant::new(&tin, Method::Laplace).unwrap();
        for _ in 0..30 {
            // On the grid, halves and quarters: on edges, on circles, at vertices.
            let [x, y] = [0, 0].map(|_| match round % 2 {
                0 => random.index(29) as f64 / 4.0,
                _ => 7.0 * random.unit(),
            });
            if points.iter().any(|p| [p[0], p[1]] == [x, y]) {
                continue;
            }
            let (Some(z), Some([by_area, by_length])) =
                (natural.height(x, y), stolen(&points, [x, y]))
            else {
                continue;
            };
            assert!(
                (z - by_area).abs() < 1e-7,
                "round {round}: {z} at {x} {y}, expected {by_area}"
            );
            let z = laplace.height(x, y).unwrap();
            assert!(
                (z - by_length).abs() < 1e-6,
                "round {round}: {z} at {x} {y}, expected {by_length}"
            );
            judged += 1;
        }
    }
    assert!(judged > 500, "{judged}");
}

/// A bent line across everything, and one that ends inside.
fn lines(side: f64, z: impl Fn(f64, f64) -> f64) -> Vec<Vec<Point>> {
    let point = |x: f64, y: f64| [x * side, y * side, z(x * side, y * side)];
    // No vertex of a grid is next to them.
    vec![
        vec![
            point(0.0, 0.4137),
            point(0.3129, 0.4571),
            point(0.7043, 0.3189),
            point(1.0, 0.5077),
        ],
        vec![
            point(0.2069, 0.9031),
            point(0.5113, 0.7057),
            point(0.8171, 0.7611),
        ],
    ]
}

#[test]
fn planes_and_vertices_are_reproduced() {
    for round in 0..40 {
        let mut random = Random(round);
        // Far from the origin, as coordinates of maps are.
        let (left, bottom) = if round % 4 < 2 {
            (0.0, 0.0)
        } else {
            (688_000.0, 5_261_000.0)
        };
        let plane = |x: f64, y: f64| 100.0 + 0.5 * (x - left) - 0.25 * (y - bottom);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 60, 16)
        } else {
            scattered(&mut random, 200, 16.0)
        };
        let points: Vec<Point> = points
            .iter()
            .map(|p| {
                [
                    left + p[0],
                    bottom + p[1],
                    plane(left + p[0], bottom + p[1]),
                ]
            })
            .collect();
        let shifted = |line: Vec<Point>| -> Vec<Point> {
            line.into_iter()
                .map(|[x, y, _]| [left + x, bottom + y, plane(left + x, bottom + y)])
                .collect()
        };
        let lines: Vec<Vec<Point>> = lines(16.0, |_, _| 0.0).into_iter().map(shifted).collect();
        let tin = tin(&points, &lines);
        for method in EXACT {
            let interpolant = Interpolant::new(&tin, method).unwrap();
            for p in points.iter().chain(lines.iter().flatten()) {
                assert_eq!(
                    interpolant.height(p[0], p[1]),
                    Some(p[2]),
                    "{method:?}, round {round}"
                );
            }
            for _ in 0..200 {
                let [x, y] = [left + 16.0 * random.unit(), bottom + 16.0 * random.unit()];
                let Some(z) = interpolant.height(x, y) else {
                    continue;
                };
                let error = (z - plane(x, y)).abs() / 100.0;
                assert!(
                    error < 1e-9,
                    "{method:?}, round {round}: off by {error:e} at {x} {y}"
                );
            }
        }
    }
}

/// Calls `each` with the faces and edges of a surface that have a face on both sides.
fn each_edge(surface: &dyn Surface, mut each: impl FnMut([Point; 2], Point, Point, EdgeKind)) {
    for face in (0..surface.face_count() as u32).filter(|&face| surface.face(face).is_some()) {
        let corners = surface.triangle(face).unwrap();
        for i in 0..3 {
            let Some(beyond) = surface.neighbor(face, i).filter(|&beyond| face < beyond) else {
                continue;
            };
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let other = surface
                .triangle(beyond)
                .unwrap()
                .into_iter()
                .find(|p| *p != a && *p != b)
                .unwrap();
            each([a, b], corners[i], other, surface.edge_kind(face, i));
        }
    }
}

fn between<const N: usize>(a: [f64; N], b: [f64; N], part: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + part * (b[i] - a[i]))
}

/// The position at a distance from `q` towards `p`.
fn towards(q: Point, p: Point, distance: f64) -> Site {
    let length = (p[0] - q[0]).hypot(p[1] - q[1]);
    let [x, y, _] = between(q, p, distance / length);
    [x, y]
}

#[test]
fn heights_are_continuous_and_those_of_a_breakline_on_it() {
    let mut hard = 0;
    for round in 0..12 {
        let mut random = Random(round);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 40, 12)
        } else {
            scattered(&mut random, 60, 12.0)
        };
        let tin = tin(&points, &lines(12.0, |x, y| 20.0 + (3.0 * x + y) % 7.0));
        for method in EXACT {
            let interpolant = Interpolant::new(&tin, method).unwrap();
            each_edge(&tin, |[a, b], left, right, kind| {
                for part in [0.1, 0.5, 0.83] {
                    let on = between(a, b, part);
                    let [z_left, z_right] = [left, right].map(|p| {
                        // Nearer than the height of a sliver at the rim, in whose circle heights
                        // may change at once.
                        let [x, y] = towards(on, p, 1e-12);
                        interpolant.height(x, y).unwrap()
                    });
                    assert!(
                        (z_left - z_right).abs() < 1e-5,
                        "{method:?}, round {round}: {z_left} {z_right} at {on:?}"
                    );
                    let z = interpolant.height(on[0], on[1]).unwrap();
                    assert!(
                        (z - z_left).abs() < 1e-5,
                        "{method:?}, round {round}: {z_left} and {z} at {on:?}"
                    );
                    if kind.is_hard() {
                        assert!(
                            (z - on[2]).abs() < 1e-9,
                            "{method:?}, round {round}: {z} at {on:?}"
                        );
                        hard += 1;
                    }
                }
            });
        }
    }
    assert!(hard > 500, "{hard}");
}

#[test]
fn a_straight_breakline_divides_the_surface_in_two() {
    for round in 0..20 {
        let mut random = Random(round);
        let mut points = if round % 2 == 0 {
            on_grid(&mut random, 50, 10)
        } else {
            scattered(&mut random, 80, 10.0)
        };
        points.retain(|p| p[1] != 5.0);
        let line: Vec<Point> = (0..=4)
            .map(|i| [2.5 * f64::from(i), 5.0, f64::from(i * i)])
            .collect();
        let all = tin(&points, std::slice::from_ref(&line));
        let below: Vec<Point> = points
            .iter()
            .copied()
            .filter(|p| p[1] < 5.0)
            .chain(line)
            .collect();
        let part = tin(&below, &[]);
        for method in [Method::Natural, Method::Laplace] {
            let (all, part) = (
                Interpolant::new(&all, method).unwrap(),
                Interpolant::new(&part, method).unwrap(),
            );
            for _ in 0..100 {
                let (x, y) = (10.0 * random.unit(), 5.0 * random.unit());
                if let Some(z) = part.height(x, y) {
                    let found = all.height(x, y).unwrap();
                    assert!(
                        (found - z).abs() < 1e-9,
                        "{method:?}, round {round}: {found}, expected {z} at {x} {y}"
                    );
                }
            }
        }
    }
}

#[test]
fn natural_neighbors_do_not_overshoot() {
    for round in 0..30 {
        let mut random = Random(round);
        let points = on_grid(&mut random, 40, 9);
        let tin = tin(&points, &lines(9.0, |x, _| x));
        for method in [
            Method::Natural,
            Method::Laplace,
            Method::Idw,
            Method::Nearest,
        ] {
            let interpolant = Interpolant::new(&tin, method).unwrap();
            for k in 0..37 * 37 {
                let (x, y) = (f64::from(k % 37) / 4.0, f64::from(k / 37) / 4.0);
                if let Some(z) = interpolant.height(x, y) {
                    assert!(
                        (-1e-9..=99.0 + 1e-9).contains(&z),
                        "{method:?}, round {round}: {z} at {x} {y}"
                    );
                }
            }
        }
    }
}

/// The gradient of a method on one side of an edge: from differences along and across it.
fn gradient_beside(interpolant: &Interpolant<Tin>, on: Point, inward: Point) -> Site {
    const STEP: f64 = 1e-4;
    let z = |[x, y]: Site| interpolant.height(x, y).unwrap();
    let direction = {
        let length = (inward[0] - on[0]).hypot(inward[1] - on[1]);
        [(inward[0] - on[0]) / length, (inward[1] - on[1]) / length]
    };
    // Two one-sided differences of second order, in directions 20 degrees apart.
    let along = |turn: f64| {
        let (sin, cos) = turn.sin_cos();
        let d = [
            direction[0] * cos - direction[1] * sin,
            direction[0] * sin + direction[1] * cos,
        ];
        let at = |k: f64| z([on[0] + k * STEP * d[0], on[1] + k * STEP * d[1]]);
        (
            d,
            (-11.0 * at(0.0) + 18.0 * at(1.0) - 9.0 * at(2.0) + 2.0 * at(3.0)) / (6.0 * STEP),
        )
    };
    let ((u, along_u), (v, along_v)) = (along(-0.2), along(0.2));
    let determinant = u[0] * v[1] - u[1] * v[0];
    [
        (along_u * v[1] - along_v * u[1]) / determinant,
        (u[0] * along_v - v[0] * along_u) / determinant,
    ]
}

#[test]
fn a_smooth_surface_has_kinks_at_breaklines_only() {
    let (mut free, mut hard, mut kinks) = (0, 0, 0);
    for round in 0..8 {
        let mut random = Random(round);
        let points = on_grid(&mut random, 70, 24);
        let tin = tin(&points, &lines(24.0, |x, y| 50.0 + (x - y).sin()));
        let smooth = Interpolant::new(&tin, Method::Smooth).unwrap();
        each_edge(&tin, |[a, b], left, right, kind| {
            for part in [0.25, 0.5, 0.7] {
                let on = between(a, b, part);
                // Straight across, unless a triangle is too narrow for the differences.
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let width =
                    |p: Point| ((p[0] - a[0]) * dy - (p[1] - a[1]) * dx).abs() / dx.hypot(dy);
                if width(left).min(width(right)) < 0.2 || dx.hypot(dy) < 0.2 {
                    continue;
                }
                let sides = [[on[0] + dy, on[1] - dx, 0.0], [on[0] - dy, on[1] + dx, 0.0]];
                let [g, h] = sides.map(|inward| gradient_beside(&smooth, on, inward));
                let step = (g[0] - h[0]).hypot(g[1] - h[1]);
                if kind.is_hard() {
                    hard += 1;
                    kinks += usize::from(step > 0.05);
                } else {
                    free += 1;
                    assert!(
                        step < 1e-6 * (1.0 + g[0].hypot(g[1])),
                        "round {round}: {g:?} and {h:?} at {on:?}"
                    );
                }
            }
        });
    }
    assert!(
        free > 1000 && hard > 50 && kinks > hard * 9 / 10,
        "{free} {hard} {kinks}"
    );
}

#[test]
fn smooth_methods_are_closer_to_a_smooth_surface() {
    let hill = |x: f64, y: f64| 5.0 * (x / 3.0).sin() * (y / 4.0).cos() + 0.1 * x * y;
    let mut random = Random(7);
    let mut points = scattered(&mut random, 1500, 30.0);
    points.iter_mut().for_each(|p| p[2] = hill(p[0], p[1]));
    let tin = tin(&points, &[]);
    let error = |method: Method| {
        let interpolant = Interpolant::new(&tin, method).unwrap();
        let squares = (0..5000).filter_map(|k| {
            let (x, y) = (
                3.0 + 24.0 * f64::from(k % 71) / 71.0,
                3.0 + 24.0 * f64::from(k / 71) / 71.0,
            );
            Some((interpolant.height(x, y)? - hill(x, y)).powi(2))
        });
        (squares.sum::<f64>() / 5000.0).sqrt()
    };
    let [linear, nearest, natural, laplace, smooth, idw] = [
        Method::Linear,
        Method::Nearest,
        Method::Natural,
        Method::Laplace,
        Method::Smooth,
        Method::Idw,
    ]
    .map(error);
    let all = format!(
        "linear {linear:.2e}, nearest {nearest:.2e}, natural {natural:.2e}, laplace {laplace:.2e}, smooth {smooth:.2e}, idw {idw:.2e}"
    );
    assert!(
        smooth < 0.5 * linear && natural < 1.1 * linear && laplace < 1.2 * linear,
        "{all}"
    );
    assert!(nearest > 5.0 * linear && idw > linear, "{all}");
}

#[test]
fn nearest_and_weighted_heights_are_those_of_all_vertices_sorted() {
    for round in 0..20 {
        let mut random = Random(round);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 60, 9)
        } else {
            scattered(&mut random, 90, 9.0)
        };
        let tin = tin(&points, &[]);
        let nearest = Interpolant::new(&tin, Method::Nearest).unwrap();
        let weighted = Interpolant::new(&tin, Method::Idw).unwrap();
        for k in 0..19 * 19 {
            let (x, y) = (f64::from(k % 19) / 2.0, f64::from(k / 19) / 2.0);
            let Some(z) = nearest.height(x, y) else {
                continue;
            };
            let mut sorted: Vec<(f64, f64, f64, f64)> = points
                .iter()
                .map(|p| ((p[0] - x).powi(2) + (p[1] - y).powi(2), p[0], p[1], p[2]))
                .collect();
            sorted.sort_by(|a, b| a.partial_cmp(b).unwrap());
            assert_eq!(z, sorted[0].3);
            let used = sorted.iter().filter(|p| p.0 <= sorted[11].0);
            let (weights, heights) = used.fold((0.0, 0.0), |(weights, heights), p| {
                (weights + 1.0 / p.0, heights + p.3 / p.0)
            });
            let expected = if sorted[0].0 == 0.0 {
                sorted[0].3
            } else {
                heights / weights
            };
            assert!(
                (weighted.height(x, y).unwrap() - expected).abs() < 1e-9,
                "round {round} at {x} {y}"
            );
        }
    }
}

fn cells(surface: &dyn Surface, frame: Frame, method: Method) -> Vec<u64> {
    let dem = Dem::new(surface, frame)
        .unwrap()
        .with_method(method)
        .unwrap();
    Grid::collect(&dem)
        .unwrap()
        .values
        .into_iter()
        .map(f64::to_bits)
        .collect()
}

/// The faces of a surface as a mesh, numbered in an order of its own.
fn shuffled(surface: &dyn Surface, random: &mut Random) -> Mesh {
    let mut order: Vec<u32> = (0..surface.vertex_count() as u32).collect();
    random.shuffle(&mut order);
    let mut number = vec![0; order.len()];
    order
        .iter()
        .zip(0..)
        .for_each(|(&v, i)| number[v as usize] = i);
    let vertices = order.iter().map(|&v| surface.position(v)).collect();
    let (mut faces, mut breaklines) = (Vec::new(), Vec::new());
    for face in 0..surface.face_count() as u32 {
        let Some(corners) = surface.face(face) else {
            continue;
        };
        let mut corners = corners.map(|v| number[v as usize]);
        for i in (0..3).filter(|&i| surface.edge_kind(face, i).is_hard()) {
            breaklines.push([corners[(i + 1) % 3], corners[(i + 2) % 3]]);
        }
        corners.rotate_left(random.index(3));
        faces.push(corners);
    }
    random.shuffle(&mut faces);
    Mesh::new(vertices, faces, &breaklines, None).unwrap()
}

#[test]
fn heights_do_not_depend_on_numbers_blocks_or_the_file() {
    for round in 0..10 {
        let mut random = Random(round);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 60, 14)
        } else {
            scattered(&mut random, 90, 14.0)
        };
        let tin = tin(&points, &lines(14.0, |x, y| x + y));
        let mesh = shuffled(&tin, &mut random);
        let mut bytes = Vec::new();
        tin.write_tin(&mut bytes).unwrap();
        let opened = CompactTin::open(bytes, "some.tin").unwrap();
        // A quarter of the cells is on integers.
        let frame = Frame::north_up(-0.75, 14.75, 0.5, 31, 31);
        for method in ALL {
            let of_tin = cells(&tin, frame, method);
            assert!(
                of_tin
                    .iter()
                    .filter(|z| !f64::from_bits(**z).is_nan())
                    .count()
                    > 300
            );
            assert!(
                of_tin == cells(&mesh, frame, method),
                "{method:?}, round {round}"
            );
            assert!(
                of_tin == cells(&opened, frame, method),
                "{method:?}, round {round}"
            );
            let dem = Dem::new(&tin, frame).unwrap().with_method(method).unwrap();
            let single = Interpolant::new(&tin, method).unwrap();
            for _ in 0..20 {
                let (column, row) = (random.index(31), random.index(31));
                let window = Window {
                    column,
                    row,
                    width: 1 + random.index(31 - column),
                    height: 1 + random.index(31 - row),
                };
                let mut block = vec![0.0; window.width * window.height];
                dem.fill(window, &mut block).unwrap();
                for (i, z) in block.into_iter().enumerate() {
                    let (column, row) = (column + i % window.width, row + i / window.width);
                    assert_eq!(f64::from(z).to_bits(), of_tin[31 * row + column]);
                    let [x, y] = frame.center(column, row);
                    let expected = single.height(x, y);
                    assert_eq!(
                        expected.is_none(),
                        z.is_nan(),
                        "{method:?}, round {round} at {x} {y}"
                    );
                    assert!(expected.is_none_or(|expected| (expected - f64::from(z)).abs() < 1e-5));
                }
            }
        }
    }
}

#[test]
fn clipping_changes_no_height() {
    for round in 0..10 {
        let mut random = Random(round);
        let points = if round % 2 == 0 {
            on_grid(&mut random, 60, 14)
        } else {
            scattered(&mut random, 90, 14.0)
        };
        let lines = lines(14.0, |x, y| x + y);
        let whole = tin(&points, &lines);
        let clipped = {
            let mut builder = builder(&points);
            lines.iter().for_each(|line| builder.add_breakline(line));
            let corners = [
                [2.1, 3.3],
                [11.7, 2.2],
                [12.2, 10.9],
                [6.6, 12.8],
                [7.0, 7.0],
            ];
            builder.add_boundary(&[corners.to_vec()]);
            builder.build().unwrap()
        };
        let mut bytes = Vec::new();
        clipped.write_tin(&mut bytes).unwrap();
        let opened = CompactTin::open(bytes, "some.tin").unwrap();
        let frame = Frame::north_up(0.0, 14.0, 0.25, 56, 56);
        for method in ALL {
            let (all, part) = (cells(&whole, frame, method), cells(&clipped, frame, method));
            assert!(
                part == cells(&opened, frame, method),
                "{method:?}, round {round}"
            );
            let (mut kept, mut left_out) = (0, 0);
            for (a, b) in all.into_iter().zip(part) {
                let (a, b) = (f64::from_bits(a), f64::from_bits(b));
                if b.is_nan() {
                    left_out += usize::from(!a.is_nan());
                    continue;
                }
                kept += 1;
                assert!(
                    (a - b).abs() < 1e-5,
                    "{method:?}, round {round}: {b}, expected {a}"
                );
            }
            assert!(kept > 500 && left_out > 500, "{kept} {left_out}");
        }
    }
}

#[test]
fn any_position_and_any_mesh_have_an_answer() {
    let points = [
        [0.0, 0.0, 1.0],
        [4.0, 0.0, 2.0],
        [4.0, 3.0, 5.0],
        [0.0, 3.0, 3.0],
    ];
    let square = tin(&points, &[]);
    // One triangle; a fold that is not Delaunay; faces apart; huge and tiny coordinates.
    let mesh = |vertices: &[Point], faces: &[[u32; 3]]| {
        Mesh::new(vertices.to_vec(), faces.to_vec(), &[], None).unwrap()
    };
    let flat = [
        [0.0, 0.0, 0.0],
        [9.0, -1.0, 4.0],
        [18.0, 0.0, 0.0],
        [9.0, 1.0, 4.0],
    ];
    let scaled = |factor: f64| points.map(|[x, y, z]| [x * factor, y * factor, z]);
    let surfaces = [
        mesh(&points, &[[0, 1, 2]]),
        mesh(&flat, &[[0, 1, 2], [0, 2, 3]]),
        mesh(&scaled(1e150), &[[0, 1, 2], [0, 2, 3]]),
        mesh(&scaled(1e-150), &[[0, 1, 2], [0, 2, 3]]),
        mesh(&[], &[]),
    ];
    for method in ALL {
        for (x, y) in [
            (f64::NAN, 1.0),
            (1.0, f64::INFINITY),
            (-1.0, 1.0),
            (1e300, -1e300),
        ] {
            assert_eq!(height(&square, method, [x, y]), None);
        }
        assert!(height(&square, method, [1e-300, 0.0]).is_some());
        for surface in &surfaces {
            let Some([a, b, c]) = surface.triangle(0) else {
                continue;
            };
            let [x, y] = [0, 1].map(|i| a[i] / 2.0 + b[i] / 4.0 + c[i] / 4.0);
            let z = height(surface, method, [x, y]).unwrap();
            let [low, high] = [f64::min, f64::max].map(|pick| pick(pick(a[2], b[2]), c[2]));
            assert!(
                (low - 0.3 * (high - low)..=high + 0.3 * (high - low)).contains(&z),
                "{method:?}: {z}"
            );
        }
        // The fold is kept by the natural methods: its edge is not Delaunay.
        if matches!(method, Method::Natural | Method::Laplace) {
            assert_eq!(height(&surfaces[1], method, [9.0, 0.0]), Some(0.0));
        }
    }
}
