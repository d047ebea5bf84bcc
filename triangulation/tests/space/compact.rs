//! The compact triangulation of space: the answers of the one that was written, and errors for
//! whatever is damaged.

use breakline_triangulation::geometry::{Plane, Space, Terrain, WeightedSpace};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{
    Compact, CompactError, CompactSection, ConflictZone, Delaunay, Delaunay3, Law, Level, Location,
    Regular, SpacePassage,
};
use testkit::random::Random;

type Point = [f64; 3];
type Opened<'a> = Compact<Space, &'a [u8], 4>;

const HEADER: usize = 48;

/// Bytes of a cell.
const CELL: usize = 32;

fn build(points: &[Point]) -> Delaunay3 {
    Delaunay::from_points(Space::new(), points).unwrap().0
}

fn bytes(t: &Delaunay3) -> Vec<u8> {
    let mut bytes = Vec::new();
    t.write_compact(&mut bytes).unwrap();
    bytes
}

fn open(bytes: &[u8]) -> Result<Opened<'_>, CompactError> {
    Compact::open(Space::default(), bytes)
}

fn all<T>(
    answers: Result<impl Iterator<Item = Result<T, CompactError>>, CompactError>,
) -> Result<Vec<T>, CompactError> {
    answers?.collect()
}

/// Points on tiny grids of each dimension, or anywhere.
fn points(random: &mut Random, round: usize) -> Vec<Point> {
    let sides = [[3, 3, 3], [4, 4, 1], [5, 1, 1], [0, 0, 0], [2, 2, 2]][round % 5];
    let count = random.index([3, 6, 20][round % 3]);
    let at = |random: &mut Random, side| {
        if side == 0 {
            random.unit() * 3.0
        } else {
            random.below(side) as f64
        }
    };
    (0..count)
        .map(|_| sides.map(|side| at(random, side)))
        .collect()
}

fn site(random: &mut Random) -> Point {
    [0; 3].map(|_| random.below(9) as f64 / 2.0 - 0.5)
}

#[test]
fn answers_are_those_of_the_triangulation_that_was_written() {
    let mut random = Random(1);
    let mut dimensions = [0; 5];
    for round in 0..1500 {
        let t = build(&points(&mut random, round));
        let bytes = bytes(&t);
        let compact = open(&bytes).unwrap();
        assert_eq!(
            (compact.dimension(), compact.vertex_count()),
            (t.dimension(), t.vertex_count())
        );
        assert_eq!(compact.cell_count(), t.tds().cell_count());
        dimensions[(t.dimension() + 1) as usize] += 1;
        assert_eq!(
            (compact.law(), compact.check(Level::Law)),
            (Law::Delaunay, Ok(())),
            "{:?}",
            t.points()
        );
        // Cells are numbered as in the file: without gaps.
        let used: Vec<CellId> = t.tds().cells().collect();
        let dense = |cell| CellId::new(used.binary_search(&cell).unwrap());
        let location = |location| match location {
            Location::Cell { cell, facets } => Location::Cell {
                cell: dense(cell),
                facets,
            },
            Location::OutsideHull { cell } => Location::OutsideHull { cell: dense(cell) },
            other => other,
        };
        let passage = |passage| match passage {
            SpacePassage::Cell(cell) => SpacePassage::Cell(dense(cell)),
            SpacePassage::Facet(cell, i) => SpacePassage::Facet(dense(cell), i),
            SpacePassage::WithinFacet(cell, i) => SpacePassage::WithinFacet(dense(cell), i),
            SpacePassage::Edge((cell, i, j)) => SpacePassage::Edge((dense(cell), i, j)),
            other => other,
        };
        let near = used.first().copied();
        let near_there = near.map(dense);
        let [p, q] = [site(&mut random), site(&mut random)];
        assert_eq!(
            compact.locate(&p, near_there),
            Ok(location(t.locate(&p, near)))
        );
        assert_eq!(compact.within_box([&p, &q]), Ok(t.within_box([&p, &q])));
        let met: Vec<SpacePassage> = t.along([&p, &q], near).map(passage).collect();
        assert_eq!(all(compact.along([&p, &q], near_there)), Ok(met));
        assert_eq!(compact.nearest(&p, near_there), Ok(t.nearest(&p, near)));
        assert_eq!(
            all(compact.nearest_first(&p, None)),
            Ok(t.nearest_first(&p, None).collect())
        );
        assert_eq!(
            all(compact.within(&p, &q)),
            Ok(t.within(&p, &q).collect::<Vec<VertexId>>())
        );
        let zone = t.conflict_zone(&p, near).map(|zone| ConflictZone {
            cells: zone.cells.into_iter().map(dense).collect(),
            border: zone
                .border
                .into_iter()
                .map(|(cell, i)| (dense(cell), i))
                .collect(),
        });
        assert_eq!(compact.conflict_zone(&p, near_there), Ok(zone));
        let vertices: Vec<VertexId> = t.tds().vertices().chain([VertexId::INFINITE]).collect();
        for &vertex in vertices.iter().filter(|_| t.dimension() >= 0) {
            assert_eq!(
                compact.cells_around(vertex),
                Ok(t.tds()
                    .cells_around(vertex)
                    .into_iter()
                    .map(|(cell, i)| (dense(cell), i))
                    .collect())
            );
            assert_eq!(
                compact.vertices_around(vertex),
                Ok(t.tds().vertices_around(vertex))
            );
            let some = [vertex, random.pick(&vertices), random.pick(&vertices)];
            assert_eq!(
                compact.cell_with(&some),
                Ok(t.tds().cell_with(&some).map(dense))
            );
        }
        for (cell, i, j) in t.tds().edges().take(5) {
            let around = t
                .tds()
                .cells_around_edge((cell, i, j))
                .map(|(cell, i, j)| (dense(cell), i, j));
            assert_eq!(
                all(compact.cells_around_edge((dense(cell), i, j))),
                Ok(around.collect())
            );
        }
        let mut again = Vec::new();
        compact.write_compact(&mut again).unwrap();
        assert_eq!(again, bytes);
    }
    assert!(dimensions.iter().all(|&count| count > 20), "{dimensions:?}");
}

#[test]
fn gaps_close_and_hidden_points_are_left_out() {
    let mut random = Random(2);
    for round in 0..200 {
        let mut t = build(&points(&mut random, round));
        for _ in 0..random.below(6) {
            let slots = t.tds().vertex_slots();
            if slots > 0 {
                let _ = t.remove(VertexId::new(random.index(slots)));
            }
        }
        let bytes = bytes(&t);
        let compact = open(&bytes).unwrap();
        assert_eq!(compact.check(Level::Law), Ok(()));
        let points =
            (0..compact.vertex_count()).map(|index| compact.point(VertexId::new(index)).unwrap());
        assert!(points.eq(t.tds().vertices().map(|v| *t.point(v))));
    }
    let corners = [
        [0.0; 4],
        [4.0, 0.0, 0.0, 0.0],
        [0.0, 4.0, 0.0, 0.0],
        [0.0, 0.0, 4.0, 0.0],
        [1.0, 1.0, 1.0, -99.0],
    ];
    let (t, _) = Regular::from_points(WeightedSpace::new(), &corners).unwrap();
    let mut bytes = Vec::new();
    t.write_compact(&mut bytes).unwrap();
    let compact = Compact::<WeightedSpace, _, 4>::open(WeightedSpace::new(), bytes).unwrap();
    assert_eq!(
        (
            compact.law(),
            compact.vertex_count(),
            compact.check(Level::Orientation)
        ),
        (Law::None, 4, Ok(()))
    );
}

/// A terrain has three coordinates, too: the file says which of both it is.
#[test]
fn the_plane_is_not_space() {
    let heights = [[0.0, 0.0, 1.0], [4.0, 0.0, 2.0], [0.0, 4.0, 1.0]];
    let (terrain, _) = Delaunay::from_points(Terrain::new(), &heights).unwrap();
    let mut plane = Vec::new();
    terrain.write_compact(&mut plane).unwrap();
    let space = bytes(&build(&heights));
    assert_eq!(
        open(&plane).err(),
        Some(CompactError::Space {
            expected: 4,
            found: 3
        })
    );
    let other = Compact::open(Terrain::new(), &space[..]).err();
    assert_eq!(
        other,
        Some(CompactError::Space {
            expected: 3,
            found: 4
        })
    );
    assert_eq!(
        other.unwrap().to_string(),
        "a triangulation of space; one of the plane is expected"
    );
    assert!(Compact::open(Plane::new(), &space[..]).is_err());
}

/// Compares the bytes with the page on formats.
#[test]
fn the_format() {
    let t = build(&[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ]);
    let mut bytes = bytes(&t);
    assert_eq!(bytes.len(), HEADER + 4 * 24 + 16 + 5 * CELL);
    let mut expected = b"brkTIN\n\x1a".to_vec();
    for number in [2u32, 4, 3, 1] {
        expected.extend(number.to_le_bytes()); // version, vertices to a cell, doubles to a point, law
    }
    expected.extend(4u64.to_le_bytes());
    expected.extend(5u64.to_le_bytes());
    assert_eq!(bytes[..40], expected);
    assert_eq!(bytes[44..48], [1, 0, 0, 0]);
    CompactSection {
        tag: *b"note    ",
        contents: b"x",
    }
    .write(&mut bytes)
    .unwrap();
    assert_eq!(open(&bytes).unwrap().section(*b"note    "), Some(&b"x"[..]));
}

const SITES: [Point; 3] = [[0.5, 0.5, 0.5], [9.0, 1.0, 1.0], [1.0, 1.0, 0.0]];

/// Asks everything; returns true if there was an error.
fn ask_everything(compact: &Opened<'_>) -> bool {
    let mut is_damaged = false;
    let mut note = |is_error: bool| is_damaged |= is_error;
    note(compact.check(Level::Law).is_err());
    for near in [None, Some(CellId::new(0)), Some(CellId::new(999))] {
        for p in SITES {
            note(compact.locate(&p, near).is_err());
            note(all(compact.along([&p, &SITES[0]], near)).is_err());
            note(compact.nearest(&p, near).is_err());
            note(compact.conflict_zone(&p, near).is_err());
            note(compact.within_box([&p, &SITES[0]]).is_err());
            note(all(compact.nearest_first(&p, near)).is_err());
            note(all(compact.within(&p, &SITES[0])).is_err());
        }
    }
    for vertex in (0..8).map(VertexId::new).chain([VertexId::INFINITE]) {
        note(compact.cells_around(vertex).is_err());
        note(compact.vertices_around(vertex).is_err());
        note(
            compact
                .cell_with(&[vertex, VertexId::new(1), VertexId::new(2)])
                .is_err(),
        );
    }
    for cell in (0..6).map(CellId::new) {
        note(all(compact.cells_around_edge((cell, 0, 3))).is_err());
    }
    is_damaged
}

fn samples() -> Vec<Delaunay3> {
    let corners = [
        [0.0; 3],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 0.0, 2.0],
        [2.0, 2.0, 2.0],
    ];
    let line: Vec<Point> = (0..4).map(|k| [f64::from(k); 3]).collect();
    vec![
        build(&[]),
        build(&corners[..1]),
        build(&line),
        build(&corners[..4]),
        build(&corners),
    ]
}

#[test]
fn every_damaged_byte_is_an_error_or_an_answer() {
    for t in samples() {
        let sound = bytes(&t);
        let cells = sound.len() - CELL * t.tds().cell_count();
        for at in 0..sound.len() {
            for value in (0..8)
                .map(|bit| sound[at] ^ 1 << bit)
                .chain([0, 1, 2, 0x7F, 0xFE, 0xFF])
            {
                let mut damaged = sound.clone();
                damaged[at] = value;
                let Ok(compact) = open(&damaged) else {
                    continue;
                };
                let is_damaged = ask_everything(&compact);
                // Unused slots below dimension 3 have no meaning.
                if at >= cells && value != sound[at] && t.dimension() == 3 {
                    assert!(
                        compact.check(Level::Manifold).is_err(),
                        "byte {at} as {value}"
                    );
                    assert!(is_damaged);
                }
            }
        }
        for length in 0..sound.len() {
            assert!(open(&sound[..length]).is_err());
        }
        assert_eq!(open(&sound).unwrap().check(Level::Law), Ok(()));
    }
}

/// Numbers that exist, in the wrong slots: only the links themselves can reveal this.
#[test]
fn wrong_links() {
    let mut random = Random(5);
    let mut errors = 0;
    for round in 0..1500 {
        let t = build(&points(&mut random, 5 * round));
        let (cells, vertices) = (t.tds().cell_count(), t.vertex_count());
        let mut bytes = bytes(&t);
        let start = bytes.len() - CELL * cells;
        for _ in 0..1 + random.below(12) {
            let slot = random.index(8);
            let number = random.index(if slot < 4 { vertices } else { cells }.max(1)) as u32;
            let number = if slot < 4 && random.below(5) == 0 {
                u32::MAX
            } else {
                number
            };
            if cells > 0 {
                let at = start + CELL * random.index(cells) + 4 * slot;
                bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
            }
        }
        errors += usize::from(ask_everything(&open(&bytes).unwrap()));
    }
    assert!(errors > 700, "{errors}");
}

/// Points that are moved are found by the levels that need points.
#[test]
fn moved_points() {
    let t = build(&[
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 1.0, 1.0],
        [9.0; 3],
    ]);
    let sound = bytes(&t);
    let moved = |t: &Delaunay3, vertex: VertexId, to: Point| {
        let mut damaged = bytes(t);
        for (k, x) in to.iter().enumerate() {
            let at = HEADER + 24 * vertex.index() + 8 * k;
            damaged[at..at + 8].copy_from_slice(&x.to_le_bytes());
        }
        [Level::Manifold, Level::Orientation, Level::Law]
            .map(|level| open(&damaged).unwrap().check(level).is_ok())
    };
    let vertex = t
        .tds()
        .vertices()
        .find(|&v| *t.point(v) == [1.0; 3])
        .unwrap();
    assert!(open(&sound).unwrap().check(Level::Law).is_ok());
    assert_eq!(moved(&t, vertex, [-1.0, 1.0, 1.0]), [true, false, false]);
    let far = t
        .tds()
        .vertices()
        .find(|&v| *t.point(v) == [9.0; 3])
        .unwrap();
    assert_eq!(moved(&t, far, [20.0; 3]), [true, true, false]);

    let flat = build(&[
        [0.0, 0.0, 1.0],
        [4.0, 0.0, 1.0],
        [0.0, 4.0, 1.0],
        [4.0, 4.0, 1.0],
    ]);
    assert_eq!(
        moved(&flat, VertexId::new(2), [0.0, 4.0, 2.0]),
        [true, false, false]
    );
}
