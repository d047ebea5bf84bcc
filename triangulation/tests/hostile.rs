//! The hostile sets of ../shared/bench/triangulation/hostile.py, from a generator of our own. The
//! result is valid and contains every constraint, or the set is refused with a reason that names
//! the point.
//!
//! `HOSTILE=FOLDER cargo test --release --test hostile -- --nocapture` tries the sets that the
//! script itself wrote.
#![allow(clippy::print_stdout)]

use std::path::Path;

use breakline_triangulation::InputError;
use testkit::case::{Case, Point};
use testkit::judge;
use testkit::random::{Random, ulps};
use testkit::subject::build;

/// A set by name; `lines` is empty if it has points only.
type Named = (&'static str, Case);

fn points_only(points: Vec<Point>) -> Case {
    Case {
        points,
        lines: Vec::new(),
    }
}

fn scaled(random: &mut Random, scale: f64) -> Case {
    points_only(
        (0..1000)
            .map(|_| [random.unit() * scale, random.unit() * scale])
            .collect(),
    )
}

fn with_one(bad: f64, random: &mut Random) -> Case {
    let mut points: Vec<Point> = (0..201).map(|_| [random.unit(), random.unit()]).collect();
    points[100] = [bad, 0.5];
    points_only(points)
}

fn tilted_grid(side: u32, [x, y]: Point) -> Case {
    let (sine, cosine) = 302.328f64.to_radians().sin_cos();
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| [f64::from(i), f64::from(j)]));
    points_only(
        cells
            .map(|[i, j]| [x + i * cosine - j * sine, y + i * sine + j * cosine])
            .collect(),
    )
}

fn of_points() -> Vec<Named> {
    let mut random = Random(5);
    let mut diagonal: Vec<Point> = (0..1000)
        .map(|i| [f64::from(i), 2.0 * f64::from(i)])
        .collect();
    random.shuffle(&mut diagonal);
    let base: Vec<Point> = (0..1000).map(|_| [random.unit(), random.unit()]).collect();
    let mixed = |random: &mut Random| random.unit() * 10f64.powf(60.0 * random.unit() - 30.0);
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / 2000.0;
    let whole = (-1105i32..=1105).flat_map(|i| (-1105i32..=1105).map(move |j| (i, j)));
    let mut circle: Vec<Point> = whole
        .filter(|(i, j)| i * i + j * j == 1105 * 1105)
        .map(|(i, j)| [f64::from(i), f64::from(j)])
        .collect();
    circle.push([0.0, 0.0]);
    let mut cluster: Vec<Point> = (0..1000)
        .map(|_| [ulps(0.5, random.around(20)), ulps(0.5, random.around(20))])
        .collect();
    cluster.extend([[12.0, 12.0], [24.0, 24.0], [12.0, 24.0], [24.0, 12.0]]);
    vec![
        (
            "collinear_x",
            points_only((0..1000).map(|i| [f64::from(i), 0.0]).collect()),
        ),
        ("collinear_diag", points_only(diagonal)),
        (
            "near_collinear",
            points_only(
                (0..1000)
                    .map(|i| [f64::from(i) * 0.1, f64::from(i) * 0.3])
                    .collect(),
            ),
        ),
        ("identical_1k", points_only(vec![[1.5, 2.5]; 1000])),
        (
            "dup_1M_of_1000",
            points_only((0..1_000_000).map(|_| random.pick(&base)).collect()),
        ),
        ("big_1e300", scaled(&mut random, 1e300)),
        ("big_1e150", scaled(&mut random, 1e150)),
        ("big_1e100", scaled(&mut random, 1e100)),
        ("denormal_1e-310", scaled(&mut random, 1e-310)),
        ("tiny_1e-160", scaled(&mut random, 1e-160)),
        ("tiny_1e-100", scaled(&mut random, 1e-100)),
        (
            "mixed_scale",
            points_only(
                (0..2000)
                    .map(|_| [mixed(&mut random), mixed(&mut random)])
                    .collect(),
            ),
        ),
        ("nan", with_one(f64::NAN, &mut random)),
        ("inf", with_one(f64::INFINITY, &mut random)),
        (
            "grid_1000x1000",
            points_only(
                (0..1_000_000)
                    .map(|i| [f64::from(i % 1000), f64::from(i / 1000)])
                    .collect(),
            ),
        ),
        ("tilted_grid_100", tilted_grid(100, [0.0, 0.0])),
        ("tilted_grid_utm", tilted_grid(200, [5e5, 4.6e6])),
        (
            "circle_2000",
            points_only(
                (0..2000)
                    .map(|i| [angle(i).cos(), angle(i).sin()])
                    .collect(),
            ),
        ),
        ("circle_int", points_only(circle)),
        ("ulp_cluster", points_only(cluster)),
        ("two_points", points_only(vec![[0.0, 0.0], [1.0, 1.0]])),
        ("empty", Case::default()),
    ]
}

fn of_lines() -> Vec<Named> {
    let mut random = Random(6);
    let around: Vec<Point> = (0..300)
        .map(|_| [random.unit() * 20.0 - 2.0, random.unit() * 20.0 - 10.0])
        .collect();
    let among = |points: &[Point], lines: &[[u32; 2]]| Case {
        points: [points, &around].concat(),
        lines: lines.iter().map(|line| line.to_vec()).collect(),
    };
    let touch = |y: f64| {
        among(
            &[[0.0, 0.0], [3.0, 1.0], [1.5, y], [1.5, 7.0]],
            &[[0, 1], [2, 3]],
        )
    };
    let square = [[0.0, 0.0], [10.0, 10.0]];
    let mut rounded = Case::default();
    for i in 0..200 {
        let (ax, down) = (0.1 * f64::from(i), 3.0 * f64::from(i));
        let (bx, by, t) = (ax + 3.0 * random.unit(), 1.0 + random.unit(), random.unit());
        let (mx, my) = (ax + (bx - ax) * t, by * t);
        rounded.draw(&[[ax, -down], [bx, by - down]]);
        rounded.draw(&[[mx, my - down], [mx + 1.0, my.next_up() - down]]);
    }
    let mut crossing = Case::default();
    (0..300).for_each(|_| crossing.draw(&[0, 1].map(|_| [random.unit(), random.unit()])));
    let mut bundle = Case::default();
    (0..60).for_each(|i| bundle.draw(&[[0.0, ulps(0.5, i)], [1.0, ulps(0.5, 60 - i)]]));
    let mut utm = Case::default();
    for i in 0..60 {
        let [low, high] = [i, 60 - i].map(|k| 4.6e6 + f64::from(k) * 1e-9);
        utm.draw(&[
            [5e5 + random.unit(), low],
            [5e5 + 100.0 + random.unit(), high],
        ]);
    }
    let level = [[0.0, 0.0], [10.0, 0.0]];
    vec![
        (
            "c_overlap_collinear",
            among(
                &[level[0], level[1], [5.0, 0.0], [15.0, 0.0]],
                &[[0, 1], [2, 3]],
            ),
        ),
        (
            "c_overlap_diag",
            among(
                &[[0.0, 0.0], [9.0, 3.0], [3.0, 1.0], [15.0, 5.0]],
                &[[0, 1], [2, 3]],
            ),
        ),
        (
            "c_through_vertex",
            among(&[level[0], level[1], [5.0, 0.0], [4.0, 0.0]], &[[0, 1]]),
        ),
        (
            "c_crossing",
            among(
                &[square[0], square[1], [0.0, 10.0], [10.0, 0.0]],
                &[[0, 1], [2, 3]],
            ),
        ),
        ("c_zero_length", among(&square, &[[0, 0], [0, 1]])),
        (
            "c_dup_vertex",
            among(
                &[square[0], square[1], [0.0, 0.0], [10.0, -3.0]],
                &[[0, 1], [2, 3], [0, 2]],
            ),
        ),
        (
            "c_dup_constraint",
            among(&square, &[[0, 1], [1, 0], [0, 1]]),
        ),
        ("c_index_out_of_range", among(&square, &[[0, 100_000]])),
        (
            "c_touch_T_exact",
            among(
                &[level[0], level[1], [5.0, 0.0], [5.0, 7.0]],
                &[[0, 1], [2, 3]],
            ),
        ),
        ("c_touch_1ulp_below", touch(0.5f64.next_down())),
        ("c_touch_1ulp_above", touch(0.5f64.next_up())),
        ("c_touch_rounded_200", rounded),
        ("c_random_crossing_300", crossing),
        ("c_ulp_bundle_60", bundle),
        ("c_utm_bundle_60", utm),
    ]
}

/// Returns how the set behaves; `Err` if it is neither sound nor refused for its actual fault.
fn behavior(case: &Case) -> Result<String, String> {
    let bad_point = case
        .points
        .iter()
        .position(|p| !p.iter().all(|x| x.is_finite()));
    let bad_line = case
        .lines
        .iter()
        .position(|line| line.iter().any(|&i| i as usize >= case.points.len()));
    let built = match build(case) {
        Ok(_) if bad_point.is_some() || bad_line.is_some() => return Err("accepted".to_owned()),
        Ok(built) => built,
        Err(refused) => return judge_refusal(refused, bad_point, bad_line),
    };
    judge::judge(case, &built)?;
    if case.points.len() <= 5000 {
        judge::judge_slowly(case, &built)?;
        judge::judge_order(case, &built, &mut Random(1))?;
    }
    let t = &built.triangulation;
    let triangles = if t.dimension() == 2 {
        t.finite_cells().count()
    } else {
        0
    };
    Ok(format!(
        "{} vertices, {triangles} triangles, {} constrained",
        t.vertex_count(),
        t.constrained_edges().count()
    ))
}

fn judge_refusal(
    refused: InputError,
    point: Option<usize>,
    line: Option<usize>,
) -> Result<String, String> {
    let is_right = match refused {
        InputError::NotFinite(at) | InputError::Coordinate(at) => Some(at) == point,
        _ => line.is_some(),
    };
    if is_right {
        Ok(format!("refused: {refused}"))
    } else {
        Err(format!("refused: {refused}"))
    }
}

fn check(sets: &[Named]) {
    let mut faults = Vec::new();
    for (name, case) in sets {
        let behavior = behavior(case);
        println!(
            "| {name} | {} |",
            behavior.as_ref().unwrap_or_else(|what| what)
        );
        faults.extend(behavior.err().map(|what| format!("{name}: {what}")));
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn points() {
    check(&of_points());
}

#[test]
fn lines() {
    check(&of_lines());
}

/// Reads little-endian pairs of doubles from `NAME.xy`, and pairs of positions from `NAME.seg`.
fn read(folder: &Path, name: &str) -> Case {
    let bytes = std::fs::read(folder.join(name).with_extension("xy")).unwrap();
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    let points = bytes
        .chunks_exact(16)
        .map(|pair| [number(&pair[..8]), number(&pair[8..])])
        .collect();
    let bytes = std::fs::read(folder.join(name).with_extension("seg")).unwrap_or_default();
    let index = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    let lines = bytes
        .chunks_exact(8)
        .map(|pair| vec![index(&pair[..4]), index(&pair[4..])])
        .collect();
    Case { points, lines }
}

#[test]
fn those_of_the_script() {
    let Some(folder) = std::env::var_os("HOSTILE") else {
        eprintln!("skipped: HOSTILE names no folder");
        return;
    };
    let names = of_points()
        .into_iter()
        .chain(of_lines())
        .map(|(name, _)| name);
    check(
        &names
            .map(|name| (name, read(Path::new(&folder), name)))
            .collect::<Vec<_>>(),
    );
}
