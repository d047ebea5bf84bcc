//! Clips of tiles, against the clip of the surface in one piece.

use super::lines_tests::Case;
use super::tests::{Tasks, count};
use super::*;
use crate::data::{Bounds, EdgeKind, Surface};
use crate::error::Result;
use crate::terrain::TinBuilder;
use crate::triangulation::OnCrossing;
use testkit::random::Random;

/// A triangle by the bits of its corners, from the smallest on, and the ranks of the edges opposite
/// them.
type Face = ([[u64; 3]; 3], [u8; 3]);

fn canonical(corners: [[f64; 3]; 3], edges: [EdgeKind; 3]) -> Face {
    let bits = corners.map(|p| p.map(f64::to_bits));
    let first = (0..3).min_by_key(|&i| bits[i]).unwrap();
    let order = [0, 1, 2].map(|k| (first + k) % 3);
    let plain = |kind: EdgeKind| {
        if kind == EdgeKind::Rim {
            EdgeKind::Plain
        } else {
            kind
        }
    };
    (
        order.map(|i| bits[i]),
        order.map(|i| plain(edges[i]).rank()),
    )
}

fn of_tile(triangle: &TileTriangle) -> Face {
    canonical(
        triangle.corners.map(|corner| corner.position),
        triangle.edges,
    )
}

/// Adds rings, bounds and lines to a builder: through points, along edges, over each other, and
/// outside.
fn add_clip(builder: &mut TinBuilder, sites: &[[f64; 3]], round: usize, random: &mut Random) {
    let extent = sites.iter().fold(Bounds::default(), |mut extent, p| {
        extent.add(*p);
        extent
    });
    // Some far beyond the points, where doubles are coarse.
    let far = if round.is_multiple_of(7) {
        10.0_f64.powi(random.index(18) as i32)
    } else {
        1.0
    };
    let corner = |random: &mut Random| match random.below(4) {
        0 => sites[random.index(sites.len())],
        1 => [0, 1, 2]
            .map(|k| extent.min[k] + (random.unit() - 0.5) * far * (extent.max[k] - extent.min[k])),
        _ => [0, 1, 2]
            .map(|k| extent.min[k] + (extent.max[k] - extent.min[k]) * (random.unit() * 1.4 - 0.2)),
    };
    let ring = |random: &mut Random| -> Vec<[f64; 2]> {
        (0..3 + random.index(4))
            .map(|_| corner(random))
            .map(|[x, y, _]| [x, y])
            .collect()
    };
    for _ in 0..[1, 0, 2][round % 3] {
        let rings: Vec<Vec<[f64; 2]>> = (0..1 + random.index(2)).map(|_| ring(random)).collect();
        builder.add_boundary(&rings);
    }
    if round % 2 == 1 {
        let [a, b] = [ring(random)[0], ring(random)[1]];
        let (min, max) = (
            [a[0].min(b[0]), a[1].min(b[1])],
            [a[0].max(b[0]), a[1].max(b[1])],
        );
        builder.bounds = Some(Bounds {
            min: [min[0], min[1], f64::NEG_INFINITY],
            max: [max[0], max[1], f64::INFINITY],
        });
    }
    if round.is_multiple_of(5) {
        builder.add_hole(&[ring(random)]);
    }
    if round.is_multiple_of(4) {
        builder.add_draped_line(&ring(random));
    }
}

/// The tasks of a surface that is clipped: they mark tight vertices.
struct Marking(f64);

impl Tasks for Marking {
    fn leaf(
        &self,
        tile: &Tile,
        number: u32,
        points: &[[f64; 3]],
        constraints: &[SubConstraint],
        emit: &mut dyn FnMut(TileTriangle),
    ) -> Result<Residual> {
        leaf(tile, number, points, constraints, self.0, emit)
    }

    fn merge(
        &self,
        tile: &Tile,
        parts: &[Residual],
        emit: &mut dyn FnMut(TileTriangle),
    ) -> Result<Residual> {
        merge(tile, parts, self.0, emit)
    }
}

/// Turns a case by the angle of a triangle with sides 3, 4 and 5: points that were on a line are
/// next to one.
fn turn(case: &mut Case, random: &mut Random) {
    let turned = |[x, y]: [f64; 2]| [(3.0 * x - 4.0 * y) / 5.0, (4.0 * x + 3.0 * y) / 5.0];
    for p in &mut case.points {
        [p[0], p[1]] = turned([p[0], p[1]]);
    }
    case.constraints
        .iter_mut()
        .for_each(|constraint| constraint.ends = constraint.ends.map(turned));
    for axis in 0..2 {
        let count = random.index(4).min(case.points.len());
        let mut cuts: Vec<f64> = (0..count)
            .map(|_| case.points[random.index(case.points.len())][axis])
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        case.cuts[axis] = cuts;
    }
}

#[test]
fn clipped_tiles_are_the_clipped_whole() {
    let mut random = Random(23);
    let (mut cut, mut near, mut all, mut tight) = (0, 0, 0, 0);
    for round in 0..count() / 2 {
        let mut case = Case::of(round, &mut random);
        if round / 12 % 3 == 1 {
            turn(&mut case, &mut random);
        }
        case.constraints
            .iter_mut()
            .for_each(|constraint| constraint.kind = EdgeKind::Breakline);
        let height = |[x, y]: [f64; 2]| ((x * 7.0 + y * 13.0) * 0.7).sin();
        case.points
            .iter_mut()
            .for_each(|p| p[2] = height([p[0], p[1]]));
        if case.points.len() < 3 {
            continue;
        }
        let mut builder = TinBuilder::default();
        // Tasks get lines that were arranged; else a point next to a line bends it.
        builder.on_crossing = OnCrossing::Reject;
        builder.add_owned_points(case.points.clone());
        for SubConstraint { ends, .. } in &case.constraints {
            builder.add_breakline(&ends.map(|end| [end[0], end[1], height(end)]));
        }
        add_clip(&mut builder, &case.points, round, &mut random);
        let extent = case.points.iter().fold(Bounds::default(), |mut extent, p| {
            extent.add(*p);
            extent
        });
        let Some(clip) = TileClip::take_from(&mut builder.clone(), &extent).unwrap() else {
            continue;
        };
        // Points on a line span no surface.
        let Ok(tin) = builder.build() else { continue };
        let of_face = |face: u32| {
            Some(canonical(
                tin.triangle(face)?,
                [0, 1, 2].map(|i| tin.edge_kind(face, i)),
            ))
        };
        let mut expected: Vec<Face> = (0..tin.face_count() as u32).filter_map(of_face).collect();

        let (mut found, mut beside) = (Vec::new(), Vec::new());
        for triangle in case.found(&Marking(clip.tight())).unwrap().emitted {
            all += 1;
            tight += usize::from(triangle.corners.iter().any(|corner| corner.is_tight));
            match clip.side_of_triangle(&triangle) {
                ClipSide::Kept => found.push(of_tile(&triangle)),
                ClipSide::Outside => {}
                ClipSide::Near => beside.push((triangle, true)),
            }
        }
        near += beside.len();
        let reach = [0, 1].map(|k: usize| extent.min[k].abs().max(extent.max[k].abs()));
        let part = clip
            .cut(&beside, reach)
            .unwrap_or_else(|error| panic!("round {round}: {error}"));
        found.extend(
            part.iter()
                .flat_map(TinPart::triangles)
                .map(|triangle| of_tile(&triangle)),
        );
        cut += usize::from(tin.report().faces_cut > 0);
        expected.sort_unstable();
        found.sort_unstable();
        assert!(
            found == expected,
            "round {round}: {} of {} triangles, {:?}, {:?}, {clip:?}",
            found.len(),
            expected.len(),
            case.points,
            case.constraints
        );
    }
    assert!(cut > count() / 4, "{cut} sets are cut");
    assert!(near < all, "{near} of {all} triangles are near lines");
    assert!(
        tight > 0 && tight * 2 < all,
        "{tight} of {all} triangles are at tight vertices"
    );
}

/// Bounds without an area keep nothing, wherever they are.
#[test]
fn bounds_without_an_area_keep_nothing() {
    let at = |i: usize| 1e6 + (i % 5) as f64;
    let points: Vec<[f64; 3]> = (0..25).map(|i| [at(i), at(i / 5), at(i * 3)]).collect();
    let extent = Bounds {
        min: [1e6, 1e6, 1e6],
        max: [1e6 + 4.0; 3],
    };
    for (a, b) in (0..50)
        .map(|i| 1e6 + f64::from(i % 10) * 0.5)
        .zip((0..50).map(|i| 1e6 + f64::from(i / 10)))
    {
        for far in [[a, b], [a + 1.0, b], [a, b + 1.5]] {
            let mut builder = TinBuilder::default();
            builder.add_owned_points(points.clone());
            builder.bounds = Some(Bounds {
                min: [a, b, f64::NEG_INFINITY],
                max: [far[0], far[1], f64::INFINITY],
            });
            let clip = TileClip::take_from(&mut builder.clone(), &extent)
                .unwrap()
                .unwrap();
            let whole = builder.build().map_or(0, |tin| tin.report().triangles);
            let (mut beside, mut kept) = (Vec::new(), 0);
            let mut sort = |triangle| match clip.side_of_triangle(&triangle) {
                ClipSide::Kept => kept += 1,
                ClipSide::Outside => {}
                ClipSide::Near => beside.push((triangle, true)),
            };
            leaf(&Tile::PLANE, 0, &points, &[], 0.0, &mut sort).unwrap();
            let part = clip.cut(&beside, [1e6 + 4.0; 2]).unwrap();
            kept += part.iter().flat_map(TinPart::triangles).count();
            assert_eq!((kept, whole), (0, 0), "{a} {b} {far:?}");
        }
    }
}

/// Far from lines, nothing waits; a line has many boxes where it is long.
#[test]
fn only_triangles_at_lines_wait() {
    let mut random = Random(8);
    let points: Vec<[f64; 3]> = (0..20_000)
        .map(|_| {
            [
                5e5 + 100.0 * random.unit(),
                5e6 + 100.0 * random.unit(),
                random.unit(),
            ]
        })
        .collect();
    let mut builder = TinBuilder::default();
    builder.add_owned_points(points.clone());
    builder.add_boundary(&[vec![
        [5e5 + 11.0, 5e6 + 7.0],
        [5e5 + 93.0, 5e6 + 31.0],
        [5e5 + 40.0, 5e6 + 88.0],
    ]]);
    let extent = points.iter().fold(Bounds::default(), |mut extent, p| {
        extent.add(*p);
        extent
    });
    let clip = TileClip::take_from(&mut builder, &extent).unwrap().unwrap();
    let mut counts = [0; 3];
    leaf(&Tile::PLANE, 0, &points, &[], 0.0, &mut |triangle| {
        counts[clip.side_of_triangle(&triangle) as usize] += 1
    })
    .unwrap();
    let [kept, outside, near] = counts;
    assert!(near < 1500 && kept > 8000 && outside > 15_000, "{counts:?}");
    // A triangle that is far away from all others has not come from the same triangulation.
    let of = |numbers: [u32; 3], at: [[f64; 2]; 3]| {
        let corners = [0, 1, 2].map(|i| TileVertex {
            tile: 0,
            number: numbers[i],
            position: [at[i][0], at[i][1], 0.0],
            is_tight: false,
        });
        (
            TileTriangle {
                corners,
                edges: [EdgeKind::Plain; 3],
            },
            true,
        )
    };
    let crossing = [
        of([0, 1, 2], [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]),
        of([3, 4, 5], [[1.0, 1.0], [9.0, 1.0], [9.0, 9.0]]),
    ];
    assert!(clip.cut(&crossing, [9.0; 2]).is_err());
    assert!(clip.cut(&[], [9.0; 2]).unwrap().is_none());
}
