//! Heights along lines: against rational numbers, known lines and laws.

mod judge;

use breakline::data::{Frame, Grid, LinePoint, Mesh, Stretch, Surface, WithoutLines};
use breakline::terrain::{CompactTin, GridSurface, Locator, TinBuilder};
use dashu_ratio::RBig;
use rayon::prelude::*;
use testkit::random::Random;

use crate::judge::{Judged, exact, judge};

type Line = Vec<[f64; 2]>;

/// Points on a small grid, of which lines pass through edges and vertices again and again.
fn points(random: &mut Random, shift: [f64; 2], step: f64) -> Vec<[f64; 3]> {
    (0..4 + random.index(14))
        .map(|_| {
            let [x, y, z] = [4, 4, 3].map(|n| random.around(n) as f64);
            [shift[0] + step * x, shift[1] + step * y, z / 2.0]
        })
        .collect()
}

/// A surface over the triangulation of points, without some of its faces; `None` if nothing is
/// left.
fn surface(points: &[[f64; 3]], is_kept: &mut dyn FnMut() -> bool) -> Option<Mesh> {
    let mut builder = TinBuilder::default();
    let column = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
    builder.add_points(&column(0), &column(1), &column(2));
    let tin = builder.build().ok()?;
    let vertices = (0..tin.vertex_count() as u32)
        .map(|v| tin.position(v))
        .collect();
    let faces: Vec<[u32; 3]> = (0..tin.face_count() as u32)
        .filter_map(|face| tin.face(face))
        .filter(|_| is_kept())
        .collect();
    let has_faces = !faces.is_empty();
    has_faces.then(|| Mesh::new(vertices, faces, &[], None).unwrap())
}

fn line(random: &mut Random, shift: [f64; 2], step: f64) -> Line {
    let halves = random.pick(&[1, 2]);
    (0..2 + random.index(4))
        .map(|_| {
            let [x, y] = [0, 1].map(|_| random.around(6 * halves) as f64 / halves as f64);
            [shift[0] + step * x, shift[1] + step * y]
        })
        .collect()
}

/// A point of a line as numbers: its distance along the line, and its position.
type Numbers = [f64; 4];

/// Returns stretches without what rounding may hide: points, stretches and gaps with hardly any
/// length.
fn seen(stretches: Vec<Vec<Numbers>>, hardly: f64) -> Vec<Vec<Numbers>> {
    let mut all: Vec<Vec<Numbers>> = Vec::new();
    for stretch in stretches {
        match all.last_mut() {
            Some(known) if stretch[0][0] - known[known.len() - 1][0] < hardly => {
                known.extend(stretch);
            }
            _ => all.push(stretch),
        }
    }
    all.iter_mut()
        .for_each(|stretch| stretch.dedup_by(|q, p| q[0] - p[0] < hardly));
    all.retain(|stretch| stretch.len() > 1);
    all
}

/// Compares the points of a line with those of the judge. With coordinates that are whole numbers,
/// all are there.
#[track_caller]
fn assert_judged(surface: &dyn Surface, line: &[[f64; 2]], is_whole: bool, what: &str) {
    let mut found = along(surface, line);
    assert!(
        found
            .iter()
            .all(|stretch| stretch.windows(2).all(|p| p[0][0] <= p[1][0])),
        "{what}: {found:?}"
    );
    let length = |number: usize| {
        let [x, y] = [0, 1].map(|k| line[number + 1][k] - line[number][k]);
        x.hypot(y)
    };
    let number = |Judged { along, at }: &Judged| {
        let before: f64 = (0..along.0).map(length).sum();
        let [x, y, z] = [0, 1, 2].map(|k| at[k].to_f64().value());
        [before + along.1.to_f64().value() * length(along.0), x, y, z]
    };
    let judged = judge(surface, line);
    let mut expected: Vec<Vec<Numbers>> = judged
        .iter()
        .map(|part| part.iter().map(number).collect())
        .collect();
    let largest = line
        .iter()
        .flatten()
        .fold(8.0, |most: f64, c| most.max(c.abs()));
    if !is_whole {
        let hardly = 1e-14 * largest;
        (found, expected) = (seen(found, hardly), seen(expected, hardly));
    }
    let counts = |all: &[Vec<Numbers>]| all.iter().map(Vec::len).collect::<Vec<usize>>();
    assert_eq!(
        counts(&found),
        counts(&expected),
        "{what}: {found:?} for {expected:?}"
    );
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        for k in 0..4 {
            let bound = match k {
                0..3 => 1e-15 * largest,
                _ if is_whole => 1e-14,
                // The steepest slope, at a position that is rounded.
                _ => 1e-14 + 100.0 * 1e-15 * largest,
            };
            let error = (found[k] - expected[k]).abs();
            assert!(
                error <= bound,
                "{what}: {found:?} for {expected:?}, off by {error}"
            );
        }
    }
}

#[test]
fn lines_have_the_points_of_rational_numbers() {
    let count = std::env::var("BREAKLINE_PROFILES").map_or(600, |n| n.parse().unwrap());
    let judged: usize = (0..count)
        .into_par_iter()
        .map(|seed| {
            let mut random = Random(seed);
            let shift = random.pick(&[[0.0; 2], [885_000.25, 6_297_000.5]]);
            let step = random.pick(&[1.0, 0.37]);
            let points = points(&mut random, shift, step);
            let kept = random.pick(&[1, 2, 4, 1000]);
            let mut is_kept = || random.below(kept + 1) > 0;
            let Some(surface) = surface(&points, &mut is_kept) else {
                return 0;
            };
            for i in 0..6 {
                let line = line(&mut random, shift, step);
                assert_judged(
                    &surface,
                    &line,
                    step == 1.0,
                    &format!("seed {seed}, line {i}"),
                );
            }
            1
        })
        .sum();
    assert!(judged > count as usize * 8 / 10, "{judged}");
}

#[test]
fn a_line_has_the_same_points_in_the_other_direction() {
    for seed in 0..500 {
        let mut random = Random(seed);
        let shift = [885_000.25, 6_297_000.5];
        let points = points(&mut random, shift, 0.37);
        let mut is_kept = || random.below(4) > 0;
        let Some(surface) = surface(&points, &mut is_kept) else {
            continue;
        };
        let locator = Locator::new(&surface).unwrap();
        let line = line(&mut random, shift, 0.37);
        let there = locator.along(&line).unwrap();
        let reversed: Line = line.iter().rev().copied().collect();
        let mut back = locator.along(&reversed).unwrap();
        back.reverse();
        back.iter_mut().for_each(|stretch| stretch.reverse());
        let at = |stretches: &[Stretch]| -> Vec<Vec<[f64; 3]>> {
            let of = |stretch: &Stretch| stretch.iter().map(|p| p.at).collect();
            stretches.iter().map(of).collect()
        };
        assert_eq!(at(&there), at(&back), "seed {seed}");
    }
}

#[test]
fn numbers_of_faces_make_no_difference() {
    for seed in 0..300 {
        let mut random = Random(seed);
        let points = points(&mut random, [0.0; 2], 0.37);
        let mut kept = Vec::new();
        let mut is_kept = || {
            kept.push(());
            kept.len() % 5 != 0
        };
        let Some(one) = surface(&points, &mut is_kept) else {
            continue;
        };
        let mut faces: Vec<[u32; 3]> = (0..one.face_count() as u32)
            .filter_map(|face| one.face(face))
            .collect();
        random.shuffle(&mut faces);
        faces
            .iter_mut()
            .for_each(|face| face.rotate_left(random.index(3)));
        let vertices = (0..one.vertex_count() as u32).map(|v| one.position(v));
        let other = Mesh::new(vertices.collect(), faces, &[], None).unwrap();
        let line = line(&mut random, [0.0; 2], 0.37);
        let [one, other] =
            [one, other].map(|mesh| Locator::new(&mesh).unwrap().along(&line).unwrap());
        assert_eq!(one, other, "seed {seed}");
    }
}

/// The number, the corner and the apex of a face across an edge, one by one.
fn across(surface: &dyn Surface, face: u32, i: usize) -> Option<(u32, usize, [f64; 3])> {
    let next = surface.neighbor(face, i)?;
    let own = surface.face(face)?;
    let theirs = surface.face(next)?;
    let beyond = |k: &usize| !own.contains(&theirs[*k]) || theirs[*k] == own[i];
    let corner = (0..3).find(beyond)?;
    Some((next, corner, surface.position(theirs[corner])))
}

#[test]
fn every_kind_of_surface_finds_the_face_across_an_edge() {
    let mut linked = 0;
    for seed in 0..200 {
        let mut random = Random(seed);
        let points = points(&mut random, [0.0; 2], 1.0);
        let column = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
        let mut builder = TinBuilder::default();
        builder.add_points(&column(0), &column(1), &column(2));
        if seed % 2 == 0 {
            builder.add_boundary(&[line(&mut random, [0.0; 2], 1.0)]);
        }
        let Ok(tin) = builder.build() else {
            continue;
        };
        let mut bytes = Vec::new();
        tin.write_tin(&mut bytes).unwrap();
        let opened = CompactTin::open(bytes, "a.tin").unwrap();
        let surfaces: [&dyn Surface; 3] = [&tin, &opened, &WithoutLines(&tin)];
        for surface in surfaces {
            let faces = 0..surface.face_count() as u32;
            for face in faces.filter(|&face| surface.face(face).is_some()) {
                for i in 0..3 {
                    let found = surface
                        .across(face, i)
                        .map(|a| (a.number, a.corner, a.apex));
                    assert_eq!(found, across(surface, face, i), "seed {seed}: {face} {i}");
                    linked += usize::from(found.is_some());
                }
            }
        }
        opened.ensure_intact().unwrap();
        let line = line(&mut random, [0.0; 2], 1.0);
        assert_eq!(along(&tin, &line), along(&opened, &line), "seed {seed}");
    }
    assert!(linked > 5000, "{linked}");
}

#[test]
fn heights_at_positions_are_those_of_lines() {
    for seed in 0..20 {
        let mut random = Random(seed);
        let points = points(&mut random, [0.0; 2], 1.0);
        let mut is_kept = || random.below(4) > 0;
        let Some(surface) = surface(&points, &mut is_kept) else {
            continue;
        };
        let locator = Locator::new(&surface).unwrap();
        for x in -10..=10 {
            for y in -10..=10 {
                let q = [f64::from(x) / 2.0, f64::from(y) / 2.0];
                let faces = (0..surface.face_count() as u32).filter_map(|f| surface.triangle(f));
                let around: Vec<RBig> = faces.filter_map(|face| judged_height(&face, q)).collect();
                let found = locator.height(q);
                assert_eq!(found.is_some(), !around.is_empty(), "seed {seed} at {q:?}");
                assert_eq!(locator.face(q).is_some(), found.is_some());
                if let (Some(found), Some(first)) = (found, around.first()) {
                    let error = (exact(found) - first).to_f64().value().abs();
                    assert!(error <= 1e-14, "seed {seed} at {q:?}: {found}");
                }
            }
        }
    }
}

/// The height of a triangle at a position in it; `None` outside.
fn judged_height(triangle: &[[f64; 3]; 3], q: [f64; 2]) -> Option<RBig> {
    let corners = triangle.map(|p| p.map(exact));
    let q = q.map(exact);
    let turn = |a: usize, b: usize| {
        let (a, b) = (&corners[a], &corners[b]);
        (&b[0] - &a[0]) * (&q[1] - &a[1]) - (&b[1] - &a[1]) * (&q[0] - &a[0])
    };
    let parts = [turn(1, 2), turn(2, 0), turn(0, 1)];
    let all = &parts[0] + &parts[1] + &parts[2];
    let height = (0..3).fold(RBig::ZERO, |sum, i| sum + &parts[i] * &corners[i][2]);
    parts
        .iter()
        .all(|part| *part >= RBig::ZERO)
        .then(|| height / all)
}

fn along(surface: &dyn Surface, line: &[[f64; 2]]) -> Vec<Vec<Numbers>> {
    let found = Locator::new(surface).unwrap().along(line).unwrap();
    let of = |p: &LinePoint| [p.along, p.at[0], p.at[1], p.at[2]];
    found
        .iter()
        .map(|stretch| stretch.iter().map(of).collect())
        .collect()
}

/// Two squares next to each other, each of two faces, with a step of 5 between them: they have no
/// vertex in common.
fn step() -> Mesh {
    let square = |x: f64, z: f64| {
        [
            [x, 0.0, z],
            [x + 2.0, 0.0, z],
            [x + 2.0, 2.0, z],
            [x, 2.0, z],
        ]
    };
    let vertices = [square(0.0, 1.0), square(2.0, 6.0)].concat();
    let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    Mesh::new(vertices, faces, &[], None).unwrap()
}

#[test]
fn a_step_of_the_surface_has_both_heights() {
    let step = step();
    let expected = [
        [0.0, 0.0, 0.5, 1.0],
        [0.5, 0.5, 0.5, 1.0],
        [2.0, 2.0, 0.5, 1.0],
        [2.0, 2.0, 0.5, 6.0],
        [2.5, 2.5, 0.5, 6.0],
        [4.0, 4.0, 0.5, 6.0],
    ];
    assert_eq!(along(&step, &[[0.0, 0.5], [4.0, 0.5]]), [expected]);
    // Along the step, the face to the left counts.
    let heights = |line: [[f64; 2]; 2]| -> Vec<f64> {
        along(&step, &line).concat().iter().map(|p| p[3]).collect()
    };
    assert_eq!(heights([[2.0, 0.0], [2.0, 2.0]]), [1.0, 1.0]);
    assert_eq!(heights([[2.0, 2.0], [2.0, 0.0]]), [6.0, 6.0]);
    assert_eq!(heights([[2.0, 3.0], [2.0, -3.0]]), [6.0, 6.0]);
    assert_eq!(heights([[2.0, 0.5], [2.0, 1.5]]), [1.0, 1.0]);
}

#[test]
fn what_has_no_length_is_left_out() {
    let step = step();
    // It touches a corner; it ends at the rim; it is beside it.
    for line in [
        [[-1.0, 1.0], [1.0, -1.0]],
        [[-1.0, 1.0], [0.0, 1.0]],
        [[-1.0, -1.0], [5.0, -1.0]],
    ] {
        assert_eq!(along(&step, &line), Vec::<Vec<Numbers>>::new(), "{line:?}");
    }
    assert_eq!(along(&step, &[[1.0, 1.0]]), Vec::<Vec<Numbers>>::new());
    assert_eq!(along(&step, &[]), Vec::<Vec<Numbers>>::new());
    assert_eq!(
        along(&step, &[[1.0, 1.0], [1.0, 1.0]]),
        Vec::<Vec<Numbers>>::new()
    );
    let none = Mesh::default();
    assert_eq!(
        along(&none, &[[0.0, 0.0], [1.0, 1.0]]),
        Vec::<Vec<Numbers>>::new()
    );
    // Along the rim, in both directions.
    let found = along(&step, &[[0.0, 0.0], [2.0, 0.0], [2.0, 0.0], [0.0, 0.0]]);
    let expected = [
        [0.0, 0.0, 0.0, 1.0],
        [2.0, 2.0, 0.0, 1.0],
        [4.0, 0.0, 0.0, 1.0],
    ];
    assert_eq!(found, [expected]);
}

#[test]
fn a_raster_is_a_surface_with_gaps_where_cells_are_missing() {
    let frame = Frame::north_up(-0.5, 2.5, 1.0, 4, 3);
    let mut values = vec![0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];
    let plane = Grid {
        frame,
        crs: None,
        values: values.clone(),
    };
    let surface = GridSurface::new(&plane).unwrap();
    for line in [
        [[0.0, 1.0], [3.0, 1.0]],
        [[0.0, 0.5], [3.0, 0.5]],
        [[3.0, 2.0], [0.0, 0.0]],
    ] {
        assert_judged(&surface, &line, true, "a plane");
        for [_, x, _, z] in along(&surface, &line).concat() {
            assert!((x - z).abs() < 1e-15);
        }
    }
    values[5] = f64::NAN;
    let holed = Grid {
        frame,
        crs: None,
        values,
    };
    let surface = GridSurface::new(&holed).unwrap();
    assert_judged(&surface, &[[0.0, 1.0], [3.0, 1.0]], true, "a hole");
    let ends: Vec<[f64; 2]> = along(&surface, &[[0.0, 1.0], [3.0, 1.0]])
        .iter()
        .map(|stretch| [stretch[0][0], stretch[stretch.len() - 1][0]])
        .collect();
    assert_eq!(ends, [[2.0, 3.0]]);
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let step = step();
    let locator = Locator::new(&step).unwrap();
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = locator.along(&[[0.0, 0.0], [1.0, wrong]]).unwrap_err();
        assert!(
            error.to_string().starts_with("vertex 2 of the line at 1 "),
            "{error}"
        );
        assert_eq!(locator.height([wrong, 0.0]), None);
    }
    for far in [1e-300, 1e150, 1e300, f64::MAX] {
        let found = along(&step, &[[-far, 1.0], [far, 1.0]]).concat();
        assert!(far < 1.0 || found.len() == 6, "{far}: {found:?}");
        assert_eq!(
            !along(&step, &[[far, far * 0.5], [-far, far * 0.75]]).is_empty(),
            far < 1.0
        );
    }
}

#[test]
fn gradients_are_those_of_the_faces() {
    let vertices = vec![[0.0, 0.0, 1.0], [4.0, 0.0, 3.0], [0.0, 4.0, 0.0]];
    let slope = Mesh::new(vertices, vec![[0, 1, 2]], &[], None).unwrap();
    let locator = Locator::new(&slope).unwrap();
    assert_eq!(locator.gradient([1.0, 1.0]), Some([0.5, -0.25]));
    assert_eq!(locator.gradient([4.0, 4.0]), None);
}
