//! Neighborhoods in the plane, in every dimension, compared with sets computed from the faces
//! alone.

use std::collections::BTreeSet;

use crate::grid::{Free, build};
use breakline_triangulation::geometry::Geometry;
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::{Tds, VertexId};
use testkit::random::Random;

/// Returns points of a tiny grid; every third time on one line, and with some removed again, so
/// that numbers have gaps.
fn random(random: &mut Random, round: usize) -> Free {
    let side = 1 + random.below(5);
    let points: Vec<[f64; 2]> = (0..random.below(20))
        .map(|_| {
            [
                random.below(side) as f64,
                if round.is_multiple_of(3) {
                    2.0
                } else {
                    random.below(side) as f64
                },
            ]
        })
        .collect();
    let mut t = build(&points);
    for v in t.tds().vertices().collect::<Vec<_>>() {
        if random.below(4) == 0 {
            let _ = t.remove(v);
        }
    }
    t
}

fn with_infinite(tds: &Tds<3>) -> impl Iterator<Item = VertexId> + '_ {
    let infinite = (tds.dimension() >= 0).then_some(VertexId::INFINITE);
    tds.vertices().chain(infinite)
}

/// Returns the edges as sorted pairs, from the cells.
fn naive_edges(tds: &Tds<3>) -> BTreeSet<[VertexId; 2]> {
    let mut edges = BTreeSet::new();
    for cell in tds.cells().filter(|_| tds.dimension() > 0) {
        let vertices = tds.cell_vertices(cell);
        for &a in vertices {
            edges.extend(vertices.iter().filter(|&&b| a < b).map(|&b| [a, b]));
        }
    }
    edges
}

fn sorted(mut ends: [VertexId; 2]) -> [VertexId; 2] {
    ends.sort();
    ends
}

#[test]
fn edges_come_once_and_in_order() {
    let mut dice = Random(1);
    for round in 0..2000 {
        let t = random(&mut dice, round);
        let tds = t.tds();
        let edges: Vec<_> = tds.edges().collect();
        assert_eq!(tds.edges().len(), edges.len());
        assert!(edges.is_sorted());
        let ends: BTreeSet<_> = edges
            .iter()
            .map(|&(cell, i)| sorted(tds.edge_ends(cell, i)))
            .collect();
        assert_eq!(ends.len(), edges.len());
        assert_eq!(ends, naive_edges(tds));
        let finite = tds.finite_edges().count();
        assert_eq!(
            finite,
            ends.iter()
                .filter(|ends| ends[1] != VertexId::INFINITE)
                .count()
        );
        if tds.dimension() > 0 {
            assert_eq!(finite + tds.degree(VertexId::INFINITE), edges.len());
        }
        assert_eq!(tds.cells().len(), tds.cells().count());
        assert_eq!(tds.vertices().len(), tds.vertices().count());
    }
}

#[test]
fn around_a_vertex_in_both_directions() {
    let mut dice = Random(2);
    for round in 0..2000 {
        let t = random(&mut dice, round);
        let tds = t.tds();
        let edges = naive_edges(tds);
        for v in with_infinite(tds) {
            let around: Vec<VertexId> = tds.vertices_around(v).collect();
            let expected: BTreeSet<VertexId> = edges
                .iter()
                .filter_map(|&[a, b]| {
                    if a == v {
                        Some(b)
                    } else {
                        (b == v).then_some(a)
                    }
                })
                .collect();
            assert_eq!(
                (tds.degree(v), around.len()),
                (expected.len(), expected.len())
            );
            assert_eq!(around.iter().copied().collect::<BTreeSet<_>>(), expected);
            for u in with_infinite(tds) {
                assert_eq!(tds.has_edge(v, u), expected.contains(&u), "{v:?} {u:?}");
            }
            let ends: Vec<[VertexId; 2]> = tds
                .edges_around(v)
                .map(|(cell, i)| tds.edge_ends(cell, i))
                .collect();
            if tds.dimension() == 2 {
                assert!(ends.iter().copied().eq(around.iter().map(|&u| [v, u])));
                // Consecutive ones: a face lies between.
                for (k, cell) in tds.around(v).enumerate() {
                    assert_eq!(
                        tds.face([around[k], v, around[(k + 1) % around.len()]]),
                        Some(cell)
                    );
                }
            } else {
                assert_eq!(tds.around(v).count(), 0);
                assert!(
                    ends.iter()
                        .map(|&ends| sorted(ends))
                        .eq(around.iter().map(|&u| sorted([u, v])))
                );
            }
            let reversed = |mut items: Vec<VertexId>| {
                items.reverse();
                items
            };
            assert_eq!(reversed(tds.vertices_around(v).rev().collect()), around);
            // From both ends at once.
            let (mut both, mut front, mut back) = (tds.vertices_around(v), Vec::new(), Vec::new());
            while let Some(u) = both.next() {
                front.push(u);
                back.extend(both.next_back());
            }
            assert!(both.next_back().is_none());
            front.extend(reversed(back));
            assert_eq!(front, around);
        }
    }
}

#[test]
fn around_is_counter_clockwise() {
    let t = build(&[
        [0.0, 0.0],
        [2.0, 1.0],
        [-1.0, 2.0],
        [-2.0, -1.0],
        [1.0, -2.0],
    ]);
    let center = t
        .tds()
        .vertices()
        .find(|&v| *t.point(v) == [0.0, 0.0])
        .unwrap();
    let around: Vec<[f64; 2]> = t
        .tds()
        .vertices_around(center)
        .map(|v| *t.point(v))
        .collect();
    for k in 0..4 {
        let turn = t
            .geometry()
            .orientation([&[0.0, 0.0], &around[k], &around[(k + 1) % 4]]);
        assert_eq!(turn, Sign::Positive, "{around:?}");
    }
}

#[test]
fn the_hull_is_a_ring_of_all_vertices_on_it() {
    let mut dice = Random(3);
    for round in 0..2000 {
        let t = random(&mut dice, round);
        let (tds, g) = (t.tds(), t.geometry());
        let hull: Vec<VertexId> = tds.hull().collect();
        let turn = |a: VertexId, b: VertexId, c: VertexId| {
            g.orientation([t.point(a), t.point(b), t.point(c)])
        };
        let mut extremes: Vec<VertexId> = tds.vertices().collect();
        match t.dimension() {
            -1 => assert_eq!(hull, []),
            0 => assert_eq!(hull, extremes),
            1 => {
                extremes.sort_by(|&a, &b| g.compare(t.point(a), t.point(b)));
                let ends = [extremes[0], extremes[extremes.len() - 1]];
                assert_eq!(hull.iter().copied().collect::<BTreeSet<_>>(), ends.into());
            }
            _ => {
                for (k, &a) in hull.iter().enumerate() {
                    let b = hull[(k + 1) % hull.len()];
                    for v in tds.vertices().filter(|&v| v != a && v != b) {
                        // Everything lies to the left of the side; what is on its line does not lie
                        // between its ends.
                        let between =
                            g.side_of_sphere_in_flat(&[t.point(a), t.point(b)], t.point(v));
                        let side = turn(a, b, v);
                        assert!(
                            side == Sign::Positive
                                || side == Sign::Zero && between == Sign::Negative
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn faces_and_edges_by_their_vertices() {
    let mut dice = Random(4);
    for round in 0..300 {
        let t = random(&mut dice, round);
        let tds = t.tds();
        let mut faces = BTreeSet::new();
        for cell in tds.cells().filter(|_| tds.dimension() == 2) {
            let mut corners = *tds.corners(cell);
            corners.sort();
            faces.insert(corners);
        }
        let all: Vec<VertexId> = with_infinite(tds).collect();
        for &a in &all {
            for &b in &all {
                for &c in &all {
                    let mut corners = [a, b, c];
                    corners.sort();
                    assert_eq!(
                        tds.is_face([a, b, c]),
                        faces.contains(&corners),
                        "{a:?} {b:?} {c:?}"
                    );
                }
            }
        }
    }
}

/// x^2 + y^2 = 325^2 has 60 solutions in whole numbers.
#[test]
fn lattice_points_of_a_circle() {
    let mut points = Vec::new();
    for x in -325i32..=325 {
        for y in -325i32..=325 {
            if x * x + y * y == 325 * 325 {
                points.push([f64::from(x), f64::from(y)]);
            }
        }
    }
    let t = build(&points);
    assert_eq!(
        (
            points.len(),
            t.tds().hull().count(),
            t.finite_cells().count()
        ),
        (60, 60, 58)
    );
    assert_eq!(t.tds().finite_edges().count(), 60 + 57);
}

#[test]
fn five_collinear_points() {
    let t = build(&[[0.0, 0.0], [1.0, 1.0], [4.0, 4.0], [2.0, 2.0], [3.0, 3.0]]);
    assert_eq!(
        (
            t.dimension(),
            t.vertex_count(),
            t.tds().edges().len(),
            t.tds().finite_edges().count()
        ),
        (1, 5, 6, 4)
    );
}
