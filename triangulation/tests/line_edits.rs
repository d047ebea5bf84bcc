//! Lines with ids: whatever is added, removed, divided and joined, the triangulation is that of
//! what remains.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Plane, distance_to_segment};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    ConstrainedDelaunay, GapError, InputError, Level, LineId, OnCrossing,
};
use testkit::random::{Random, ulps};

type Point = [f64; 2];
type Constrained = ConstrainedDelaunay<Plane>;
type Bits = [u64; 2];
type SiteSets = BTreeSet<Vec<Bits>>;

fn bits(p: &Point) -> Bits {
    p.map(|x| (x + 0.0).to_bits())
}

/// What is observable of a triangulation, independent of its numbering: triangles, constrained
/// edges, and the lines' chains.
fn seen(t: &Constrained, lines: &[LineId]) -> (SiteSets, SiteSets, Vec<Vec<Bits>>) {
    let at = |v: &VertexId| bits(t.point(*v));
    let sorted = |vertices: &[VertexId]| {
        let mut sites: Vec<Bits> = vertices.iter().map(at).collect();
        sites.sort_unstable();
        sites
    };
    let triangles = t
        .finite_cells()
        .map(|cell| sorted(t.tds().cell_vertices(cell)))
        .collect();
    let edges = t.constrained_edges().map(|edge| sorted(&edge)).collect();
    (
        triangles,
        edges,
        lines
            .iter()
            .map(|&line| t.chain(line).iter().map(at).collect())
            .collect(),
    )
}

fn built(points: &[Point], lines: &[Vec<Point>]) -> (Constrained, Vec<LineId>) {
    let mut all = points.to_vec();
    let indexed: Vec<Vec<u32>> = lines
        .iter()
        .map(|line| {
            let from = all.len() as u32;
            all.extend(line);
            (from..all.len() as u32).collect()
        })
        .collect();
    let (t, _) =
        Constrained::from_lines(Plane::default(), &all, &indexed, OnCrossing::Split).unwrap();
    let ids = t.lines().collect();
    (t, ids)
}

/// Adds and removes pseudo-random lines and points, and compares with bulk construction.
fn edits(seed: u64, rounds: usize, site: impl Fn(&mut Random) -> Point) {
    let mut random = Random(seed);
    for round in 0..rounds {
        let mut points: Vec<Point> = (0..3 + random.index(6))
            .map(|_| site(&mut random))
            .collect();
        let mut t = Constrained::from_points(Plane::default(), &points)
            .unwrap()
            .0;
        let mut lines: Vec<(LineId, Vec<Point>)> = Vec::new();
        for step in 0..12 {
            match random.below(5) {
                0 | 1 => {
                    let count = 1 + random.index(2);
                    let line = |random: &mut Random| {
                        (0..2 + random.index(3)).map(|_| site(random)).collect()
                    };
                    let new: Vec<Vec<Point>> = (0..count).map(|_| line(&mut random)).collect();
                    let ids = t.insert_lines(&new).unwrap();
                    lines.extend(ids.into_iter().zip(new));
                }
                2 if !lines.is_empty() => {
                    let (line, _) = lines.remove(random.index(lines.len()));
                    assert!(t.remove_line(line));
                    assert!(!t.remove_line(line));
                    assert_eq!(t.chain(line), []);
                }
                3 if !lines.is_empty() => {
                    let at = random.index(lines.len());
                    let vertex = random.index(lines[at].1.len());
                    if let Some(rest) = t.split_line(lines[at].0, vertex) {
                        let tail = lines[at].1[vertex..].to_vec();
                        lines[at].1.truncate(vertex + 1);
                        lines.push((rest, tail));
                    }
                    let (i, j) = (random.index(lines.len()), random.index(lines.len()));
                    if t.join_lines(lines[i].0, lines[j].0) {
                        let tail = lines[j].1[1..].to_vec();
                        lines[i].1.extend(tail);
                        lines.remove(j);
                    }
                }
                _ => {
                    let p = site(&mut random);
                    points.push(p);
                    t.insert(p).unwrap();
                }
            }
            let (ids, drawn): (Vec<LineId>, Vec<Vec<Point>>) = lines.iter().cloned().unzip();
            let (fresh, fresh_ids) = built(&points, &drawn);
            assert_eq!(
                t.check(Level::Law),
                [],
                "round {round}, step {step}: {points:?} {drawn:?}"
            );
            assert_eq!(
                fresh.check(Level::Law),
                [],
                "round {round}, step {step}: {points:?} {drawn:?}"
            );
            if fresh.dimension() == 2 {
                assert_eq!(
                    seen(&t, &ids),
                    seen(&fresh, &fresh_ids),
                    "round {round}, step {step}: {points:?} {drawn:?}"
                );
            }
        }
    }
}

#[test]
fn edits_on_tiny_grids() {
    edits(1, 300, |random| {
        [random.below(5) as f64, random.below(5) as f64]
    });
}

#[test]
fn edits_in_centimeters_far_away() {
    edits(2, 150, |random| {
        [
            500_000.0 + random.below(300) as f64 * 0.01,
            4_649_000.0 + random.below(8) as f64 * 0.01,
        ]
    });
}

#[test]
fn edits_a_rounding_apart() {
    edits(3, 300, |random| {
        [
            ulps(500_000.37, random.around(3)),
            ulps(4_649_000.12, random.around(3)),
        ]
    });
}

#[test]
fn edits_off_the_grid() {
    // Fine coordinates among coarse ones.
    edits(4, 300, |random| {
        let fine = |random: &mut Random| {
            ulps(0.5, random.around(3)) * if random.below(4) == 0 { 64.0 } else { 1.0 }
        };
        [fine(random), fine(random)]
    });
    edits(5, 150, |random| [random.unit() - 0.5, random.unit() - 0.5]);
}

/// The same lines in a hundred pseudo-random orders, some of them reversed.
#[test]
fn a_hundred_orders_give_one_triangulation() {
    let mut random = Random(7);
    let utm = |random: &mut Random| {
        [
            500_000.0 + random.unit() * 50.0,
            4_649_000.0 + random.unit() * 50.0,
        ]
    };
    let grid = |random: &mut Random| [random.below(9) as f64, random.below(9) as f64];
    let near_zero = |random: &mut Random| {
        [
            random.unit() - 0.5,
            ulps(0.5, random.around(20)) - 0.5 * random.unit(),
        ]
    };
    for site in [utm as fn(&mut Random) -> Point, grid, near_zero] {
        let points: Vec<Point> = (0..30).map(|_| site(&mut random)).collect();
        let mut lines: Vec<Vec<Point>> = (0..40)
            .map(|_| (0..3).map(|_| site(&mut random)).collect())
            .collect();
        let (first, _) = built(&points, &lines);
        assert!(first.crossings().len() > 100 || first.constrained_edges().count() > 100);
        let expected = seen(&first, &[]);
        for _ in 0..100 {
            random.shuffle(&mut lines);
            let at = random.index(lines.len());
            lines[at].reverse();
            assert_eq!(seen(&built(&points, &lines).0, &[]), expected);
        }
    }
}

#[test]
fn lines_know_their_edges_and_edges_their_lines() {
    let points = [
        [0.0, 0.0],
        [4.0, 0.0],
        [2.0, 0.0],
        [2.0, 3.0],
        [2.0, -3.0],
        [0.0, 4.0],
        [4.0, 4.0],
    ];
    // Along the axis, again and in reverse as far as the middle, and across it.
    let lines: [&[u32]; 3] = [&[0, 1], &[2, 0], &[3, 4]];
    let (t, v) =
        Constrained::from_lines(Plane::default(), &points, &lines, OnCrossing::Split).unwrap();
    let ids: Vec<LineId> = t.lines().collect();
    assert_eq!(t.chain(ids[0]), [v[0], v[2], v[1]]);
    assert_eq!(t.chain(ids[1]), [v[2], v[0]]);
    assert_eq!(t.chain(ids[2]), [v[3], v[2], v[4]]);
    assert_eq!(t.line_vertices(ids[0]), [v[0], v[1]]);
    assert!(t.lines_through(v[0], v[2]).eq([ids[0], ids[1]]));
    assert!(t.lines_through(v[2], v[1]).eq([ids[0]]));
    assert!(t.lines_through(v[5], v[6]).eq([]));
    assert!(!t.is_added(v[2]) && t.crossings().is_empty());
}

#[test]
fn a_crossing_is_rejected_by_name() {
    let points = [[0.0, 0.0], [4.0, 4.0], [9.0, 9.0], [0.0, 4.0], [4.0, 0.0]];
    let lines: [&[u32]; 2] = [&[3, 4], &[2, 1, 0]];
    let refused =
        Constrained::from_lines(Plane::default(), &points, &lines, OnCrossing::Reject).unwrap_err();
    let InputError::Crossing {
        mut segments,
        at: site,
    } = refused
    else {
        panic!("{refused}")
    };
    segments.sort_unstable();
    assert_eq!((segments, site), ([(0, 0), (1, 1)], [2.0, 2.0]));
    let out = Constrained::from_lines(Plane::default(), &points, &[[0, 9]], OnCrossing::Split)
        .unwrap_err();
    assert_eq!(out, InputError::Index { line: 0, index: 9 });
    // Touching is not crossing, and at an existing point nothing is split that would not be split
    // anyway.
    for points in [
        &points[..],
        &[[0.0, 0.0], [2.0, 2.0], [9.0, 9.0], [0.0, 4.0], [4.0, 0.0]],
    ] {
        let lines: [&[u32]; 2] = [&[0, 1, 2], &[3, 1]];
        assert!(
            Constrained::from_lines(Plane::default(), points, &lines, OnCrossing::Reject).is_ok()
        );
        let lines: [&[u32]; 2] = [&[0, 2], &[3, 4]];
        let at_point = points[1] == [2.0, 2.0];
        let built = Constrained::from_lines(Plane::default(), points, &lines, OnCrossing::Reject);
        assert_eq!(built.is_ok(), at_point);
    }
}

/// Without a crossing nothing is arranged; where lines cross at vertices, all are. Lines touch,
/// overlap, pass through points and cross, at points and elsewhere; some points are collinear.
#[test]
fn lines_that_may_not_cross_are_triangulated_like_others() {
    let mut random = Random(21);
    let [mut apart, mut at_points, mut refused] = [0; 3];
    for round in 0..2_000 {
        let side = [3, 6, 12][round % 3];
        let step = [1.0, 0.1][round / 3 % 2];
        let mut point = || [0, 1].map(|_| step * random.below(side) as f64);
        let mut points: Vec<Point> = (0..2 + round % 25).map(|_| point()).collect();
        if round % 11 == 0 {
            points.iter_mut().for_each(|p| p[1] = 0.0);
        }
        let mut lines: Vec<Vec<u32>> = (0..1 + round % 4)
            .map(|_| {
                (0..2 + random.index(2))
                    .map(|_| random.index(points.len()) as u32)
                    .collect()
            })
            .collect();
        if round % 5 == 0 {
            let first = points.len() as u32;
            points.extend([[1.0, 1.0], [0.0, 1.0], [2.0, 1.0], [1.0, 0.0], [1.0, 2.0]]);
            lines.extend([vec![first + 1, first + 2], vec![first + 3, first + 4]]);
        }
        let [strict, split] = [OnCrossing::Reject, OnCrossing::Split].map(|on_crossing| {
            Constrained::from_lines(Plane::default(), &points, &lines, on_crossing)
        });
        let (split, of_split) = split.unwrap();
        let Ok((strict, of_strict)) = strict else {
            assert!(split.rounding().is_some(), "{points:?} {lines:?}");
            refused += 1;
            continue;
        };
        assert!(strict.check(Level::Law).is_empty(), "{points:?} {lines:?}");
        assert_eq!(
            (strict.points(), of_strict),
            (split.points(), of_split),
            "{points:?} {lines:?}"
        );
        assert!(
            strict.constrained_edges().eq(split.constrained_edges()),
            "{points:?} {lines:?}"
        );
        assert!(
            strict
                .lines()
                .all(|line| strict.chain(line) == split.chain(line)),
            "{points:?} {lines:?}"
        );
        assert_eq!(strict.rounding(), split.rounding(), "{points:?} {lines:?}");
        *(if split.rounding().is_some() {
            &mut at_points
        } else {
            &mut apart
        }) += 1;
    }
    assert!(
        [apart, at_points, refused].iter().all(|&count| count > 50),
        "{apart} {at_points} {refused}"
    );
}

/// A zigzag next to an island in one of its bays, and one next to nothing.
#[test]
fn simplified_lines_cross_no_other() {
    let zigzag: Vec<Point> = (0..9).map(|i| [f64::from(i), f64::from(i % 2)]).collect();
    let island = vec![[2.9, 0.4], [3.1, 0.4], [3.0, 0.6], [2.9, 0.4]];
    let frame = [[-9.0, -9.0], [20.0, -9.0], [20.0, 9.0], [-9.0, 9.0]];
    for (others, tolerance, left) in [
        (vec![], 0.5, 9),
        (vec![], 1.0, 2),
        (vec![island.clone()], 1.0, 3),
    ] {
        let (mut t, _) = built(&frame, &[]);
        let line = t.insert_lines(std::slice::from_ref(&zigzag)).unwrap()[0];
        let others = t.insert_lines(&others).unwrap();
        let gone = t.simplify_line(line, tolerance);
        assert_eq!(
            (t.line_vertices(line).len(), gone),
            (left, 9 - left),
            "{tolerance} {}",
            others.len()
        );
        assert_eq!(t.crossings(), []);
        assert_eq!(t.check(Level::Law), []);
        let lines: Vec<LineId> = t.lines().collect();
        let drawn: Vec<Vec<Point>> = lines
            .iter()
            .map(|&l| t.line_vertices(l).iter().map(|&v| *t.point(v)).collect())
            .collect();
        let (fresh, ids) = built(&frame, &drawn);
        assert_eq!(seen(&t, &lines), seen(&fresh, &ids));
    }
}

/// Pseudo-random lines, simplified one after the other: no two of them cross that did not before,
/// and none is further off than the tolerance.
#[test]
fn simplification_keeps_the_topology() {
    let mut random = Random(6);
    let mut taken = 0;
    for _ in 0..200 {
        let mut lines: Vec<Vec<Point>> = Vec::new();
        for i in 0..4 {
            let height = |random: &mut Random| f64::from(3 * i) + random.below(7) as f64 * 0.5;
            lines.push(
                (0..12)
                    .map(|x| [f64::from(x), height(&mut random)])
                    .collect(),
            );
        }
        let (mut t, _) = built(
            &[[-5.0, -5.0], [20.0, -5.0], [20.0, 25.0], [-5.0, 25.0]],
            &[],
        );
        let ids = t.insert_lines(&lines).unwrap();
        let before = t.crossings().len();
        for (&line, drawn) in ids.iter().zip(&lines) {
            taken += t.simplify_line(line, 0.75);
            let left: Vec<Point> = t.line_vertices(line).iter().map(|&v| *t.point(v)).collect();
            for p in drawn {
                let far = left
                    .windows(2)
                    .map(|pair| distance_to_segment(*p, [pair[0], pair[1]]));
                assert!(
                    far.fold(f64::INFINITY, f64::min) <= 0.75 + 1e-12,
                    "{lines:?}"
                );
            }
        }
        assert!(t.crossings().len() <= before, "{lines:?}");
        assert_eq!(t.check(Level::Law), [], "{lines:?}");
    }
    assert!(taken > 500, "{taken}");
}

/// A square with a hole and an island in it.
#[test]
fn nesting_counts_the_lines_from_outside() {
    let square = |r: f64| vec![[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]];
    let (t, ids) = built(
        &[[-9.0, 0.0], [9.0, 0.0]],
        &[square(1.0), square(3.0), square(6.0)],
    );
    let levels = t.nesting();
    for cell in t.finite_cells() {
        let corners = t.tds().corners(cell).map(|v| *t.point(v));
        let middle = [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0);
        let far = middle[0].abs().max(middle[1].abs());
        let level = [6.0, 3.0, 1.0].iter().filter(|&&r| far < r).count() as u32;
        assert_eq!(levels[cell.index()], level, "{middle:?}");
    }
    assert!(
        t.nesting_of([ids[1]])
            .unwrap()
            .iter()
            .all(|&level| level <= 1)
    );
    let (t, ids) = built(
        &[],
        &[
            vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]],
            vec![[4.0, 4.0], [0.5, 0.0]],
        ],
    );
    assert!(matches!(
        t.nesting_of(ids),
        Err(GapError { ends: [_, _], .. })
    ));
}

/// Edits give the same result as a new construction, also below dimension 2, and with a point where
/// lines cross.
#[test]
fn edits_at_the_edges() {
    use breakline_triangulation::geometry::{Plane, Terrain};
    use breakline_triangulation::{ConstrainedDelaunay, Level, OnCrossing};

    let mut t = ConstrainedDelaunay::<_>::new(<Plane>::default());
    let ids = t.insert_lines(&[[[0.0, 0.0], [1.0, 0.0]]]).unwrap();
    assert_eq!(t.vertex_count(), 2);
    assert!(t.remove_line(ids[0]));
    assert_eq!((t.vertex_count(), t.dimension()), (0, -1));
    for p in [[5.0, 5.0], [6.0, 5.0], [5.0, 6.0]] {
        t.insert(p).unwrap();
    }
    assert_eq!((t.vertex_count(), t.finite_cells().count()), (3, 1));
    assert_eq!(t.check(Level::Law), []);

    let points = [
        [0.0, 0.0, 0.0],
        [4.0, 4.0, 0.0],
        [0.0, 4.0, 0.0],
        [4.0, 0.0, 0.0],
    ];
    let lines = [[0, 1], [2, 3]];
    let (mut t, _) = ConstrainedDelaunay::<_>::from_lines(
        <Terrain>::default(),
        &points,
        &lines,
        OnCrossing::Split,
    )
    .unwrap();
    let [crossing] = t.crossings()[..] else {
        panic!("they cross once")
    };
    assert_eq!(t.point(crossing)[2], 0.0);
    assert_eq!(t.insert([2.0, 2.0, 9.0]).unwrap(), crossing);
    assert_eq!((t.point(crossing)[2], t.is_added(crossing)), (9.0, false));
}

/// Points that are collinear for a while have no triangles that could hold a line; what lay on its
/// chain before is forgotten.
#[test]
fn lines_between_dimensions() {
    let mut t = Constrained::new(Plane::default());
    let long = t.insert_lines(&[[[0.0, 0.0], [0.0, 2.0]]]).unwrap()[0];
    let halves = t
        .insert_lines(&[[[0.0, 0.0], [0.0, 1.0], [0.0, 2.0]]])
        .unwrap()[0];
    let beside = t.insert_lines(&[[[1.0, 2.0], [2.0, 1.0]]]).unwrap()[0];
    assert_eq!(t.chain(long).len(), 3);
    assert!(t.remove_line(beside) && t.remove_line(halves));
    assert_eq!(
        (t.dimension(), t.vertex_count(), t.chain(long).len()),
        (1, 2, 2)
    );
    t.insert([2.0, 1.0]).unwrap();
    assert_eq!((t.chain(long).len(), t.check(Level::Law)), (2, vec![]));

    // The vertex on its chain is one that was given, and is removed after the triangles.
    let mut t = Constrained::new(Plane::default());
    let above = t
        .insert_lines(&[[[4.0, 4.0], [4.0, 3.0], [2.0, 2.0]]])
        .unwrap()[0];
    let between = t.insert([2.0, 2.0]).unwrap();
    let long = t.insert_lines(&[[[3.0, 2.0], [1.0, 2.0]]]).unwrap()[0];
    assert!(t.remove_line(above));
    assert_eq!((t.dimension(), t.remove(between)), (1, Ok([2.0, 2.0])));
    t.insert([2.0, 1.0]).unwrap();
    assert_eq!((t.chain(long).len(), t.check(Level::Law)), (2, vec![]));
}
