//! The compact triangulation: the answers of the one that was written, and errors for whatever is
//! damaged.

use crate::grid::{Free, Point, build, points, site};
use breakline_triangulation::geometry::{Plane, Terrain};
use breakline_triangulation::tds::{CellId, Complex, VertexId};
use breakline_triangulation::{
    Compact, CompactError, CompactSection, ConflictZone, Constrained, ConstrainedDelaunay,
    Delaunay, Law, Level, Location, OnCrossing, Passage, Regular, Triangulation,
};
use testkit::random::Random;

type Lined = ConstrainedDelaunay<Plane>;
type Opened<'a> = Compact<Plane, &'a [u8]>;

const HEADER: usize = 48;

fn bytes(t: &Free) -> Vec<u8> {
    let mut bytes = Vec::new();
    t.write_compact(&mut bytes).unwrap();
    bytes
}

fn open(bytes: &[u8]) -> Result<Opened<'_>, CompactError> {
    Compact::open(Plane::default(), bytes)
}

fn all<T>(
    answers: Result<impl Iterator<Item = Result<T, CompactError>>, CompactError>,
) -> Result<Vec<T>, CompactError> {
    answers?.collect()
}

/// The answers of a triangulation, with its cells numbered as in the file: without gaps.
struct Dense<'a, V, C>(&'a Triangulation<Plane, 3, V, C>);

impl<V, C: Copy + Default> Dense<'_, V, C> {
    fn cell(&self, cell: CellId) -> CellId {
        CellId::new(self.0.tds().cells().position(|c| c == cell).unwrap())
    }

    fn location(&self, location: Location) -> Location {
        match location {
            Location::Cell { cell, facets } => Location::Cell {
                cell: self.cell(cell),
                facets,
            },
            Location::OutsideHull { cell } => Location::OutsideHull {
                cell: self.cell(cell),
            },
            other => other,
        }
    }

    fn passage(&self, passage: Passage) -> Passage {
        match passage {
            Passage::Face(cell) => Passage::Face(self.cell(cell)),
            Passage::Edge(cell, i) => Passage::Edge(self.cell(cell), i),
            other => other,
        }
    }

    fn zone(&self, zone: Option<ConflictZone>) -> Option<ConflictZone> {
        zone.map(|zone| ConflictZone {
            cells: zone.cells.into_iter().map(|cell| self.cell(cell)).collect(),
            border: zone
                .border
                .into_iter()
                .map(|(cell, i)| (self.cell(cell), i))
                .collect(),
        })
    }

    /// Where walks start in the triangulation, and in the file.
    fn near(&self) -> [Option<CellId>; 2] {
        let first = self.0.tds().cells().next();
        [first, first.map(|_| CellId::new(0))]
    }
}

/// Queries that every kind answers.
fn judge_lawless<V, C: Copy + Default>(
    t: &Triangulation<Plane, 3, V, C>,
    compact: &Opened<'_>,
    [p, q]: [Point; 2],
) {
    let dense = Dense(t);
    let [near, near_there] = dense.near();
    assert_eq!(
        compact.locate(&p, near_there),
        Ok(dense.location(t.locate(&p, near)))
    );
    assert_eq!(
        compact.within_rectangle([&p, &q]),
        Ok(t.within_rectangle([&p, &q]))
    );
    let met: Vec<Passage> = t
        .along([&p, &q], near)
        .map(|passage| dense.passage(passage))
        .collect();
    assert_eq!(all(compact.along([&p, &q], near_there)), Ok(met));
}

fn judge(t: &Free, compact: &Opened<'_>, [p, q]: [Point; 2]) {
    judge_lawless(t, compact, [p, q]);
    let dense = Dense(t);
    let [near, near_there] = dense.near();
    assert_eq!(compact.nearest(&p, near_there), Ok(t.nearest(&p, near)));
    assert_eq!(
        compact.conflict_zone(&p, near_there),
        Ok(dense.zone(t.conflict_zone(&p, near)))
    );
    assert_eq!(
        all(compact.within(&p, &q)),
        Ok(t.within(&p, &q).collect::<Vec<VertexId>>())
    );
}

#[test]
fn answers_are_those_of_the_triangulation_that_was_written() {
    let mut dice = Random(1);
    let mut dimensions = [0; 4];
    for round in 0..4000 {
        let t = build(&points(&mut dice, round));
        let bytes = bytes(&t);
        let compact = open(&bytes).unwrap();
        assert_eq!(
            (compact.dimension(), compact.vertex_count()),
            (t.dimension(), t.vertex_count())
        );
        dimensions[(t.dimension() + 1) as usize] += 1;
        assert_eq!(compact.check(Level::Law), Ok(()));
        let [p, q] = [site(&mut dice), site(&mut dice)];
        judge(&t, &compact, [p, q]);
        assert_eq!(
            all(compact.nearest_first(&p, None)),
            Ok(t.nearest_first(&p, None).collect())
        );
        let vertices: Vec<VertexId> = t.tds().vertices().chain([VertexId::INFINITE]).collect();
        for &vertex in &vertices {
            let [b, c] = [dice.pick(&vertices), dice.pick(&vertices)];
            let edge = t
                .tds()
                .edge(vertex, b)
                .map(|(cell, i)| (Dense(&t).cell(cell), i));
            assert_eq!(compact.edge(vertex, b), Ok(edge));
            assert_eq!(
                compact.face([vertex, b, c]),
                Ok(t.tds()
                    .face([vertex, b, c])
                    .map(|cell| Dense(&t).cell(cell)))
            );
            let around: Vec<VertexId> = t.tds().vertices_around(vertex).collect();
            assert_eq!(all(compact.vertices_around(vertex)), Ok(around));
            let faces = t
                .faces_from(vertex)
                .map(|cell| Dense(&t).cell(cell))
                .collect();
            let exists = vertex != VertexId::INFINITE;
            assert_eq!(
                all(compact.faces_from(vertex)),
                if exists {
                    Ok(faces)
                } else {
                    Err(CompactError::Vertex(vertex))
                }
            );
        }
    }
    assert!(dimensions.iter().all(|&count| count > 20), "{dimensions:?}");
}

#[test]
fn many_points() {
    let mut dice = Random(2);
    let points: Vec<Point> = (0..20_000).map(|_| [dice.unit(), dice.unit()]).collect();
    let t = build(&points);
    let bytes = bytes(&t);
    let compact = open(&bytes).unwrap();
    assert_eq!(compact.check(Level::Law), Ok(()));
    for _ in 0..500 {
        let p = [dice.unit(), dice.unit()].map(|x| 1.2 * x - 0.1);
        judge(&t, &compact, [p, p.map(|x| x + 0.1 * dice.unit())]);
        assert_eq!(
            compact.locate(&p, None),
            Ok(t.locate(&p, None)),
            "the long way"
        );
    }
}

#[test]
fn constraints_are_there() {
    let mut dice = Random(3);
    let mut constrained = 0;
    for round in 0..1000 {
        let mut points = points(&mut dice, round);
        points.push([1.0, 1.0]);
        let lines: Vec<Vec<u32>> = (0..4)
            .map(|_| vec![dice.index(points.len()) as u32; 2])
            .collect();
        let lines: Vec<Vec<u32>> = lines
            .iter()
            .map(|l| vec![l[0], dice.index(points.len()) as u32])
            .collect();
        let t = Lined::from_lines(Plane::default(), &points, &lines, OnCrossing::Split)
            .unwrap()
            .0;
        let mut bytes = Vec::new();
        t.write_compact(&mut bytes).unwrap();
        let compact = open(&bytes).unwrap();
        assert_eq!(
            (compact.law(), compact.check(Level::Law)),
            (Law::ConstrainedDelaunay, Ok(()))
        );
        let [p, q] = [site(&mut dice), site(&mut dice)];
        judge_lawless(&t, &compact, [p, q]);
        let dense = Dense(&t);
        let [near, near_there] = dense.near();
        assert_eq!(
            compact.conflict_zone(&p, near_there),
            Ok(dense.zone(t.conflict_zone(&p, near)))
        );
        assert_eq!(
            compact.nearest(&p, None),
            Err(CompactError::Unanswerable(Law::ConstrainedDelaunay))
        );
        for cell in t.tds().cells().filter(|_| t.dimension() == 2) {
            for i in 0..3 {
                assert_eq!(
                    compact.is_constrained(dense.cell(cell), i),
                    Ok(t.is_constrained(cell, i))
                );
                constrained += usize::from(t.is_constrained(cell, i));
            }
        }
    }
    assert!(constrained > 1000);
}

#[test]
fn all_kinds_and_geometries() {
    let square = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    let mut bytes = Vec::new();
    let mut constrained: Constrained<Plane> = Constrained::new(Plane::default());
    let v = square.map(|p| constrained.insert(p).unwrap());
    constrained.constrain(v[0], v[2]).unwrap();
    constrained.write_compact(&mut bytes).unwrap();
    let compact = open(&bytes).unwrap();
    assert_eq!(
        (compact.law(), compact.check(Level::Law)),
        (Law::Constrained, Ok(()))
    );
    let is_constrained = |cell: CellId, i| compact.is_constrained(cell, i).unwrap();
    assert_eq!(
        (0..6)
            .map(CellId::new)
            .flat_map(|c| (0..3).map(move |i| (c, i)))
            .filter(|&(c, i)| is_constrained(c, i))
            .count(),
        2
    );
    assert_eq!(
        compact.conflict_zone(&[1.0, 1.0], None),
        Err(CompactError::Unanswerable(Law::Constrained))
    );

    // A hidden vertex is not written.
    let mut regular: Regular<breakline_triangulation::geometry::Weighted, 3> =
        Regular::new(Default::default());
    for (k, [x, y]) in square.into_iter().chain([[2.0, 2.0]]).enumerate() {
        regular
            .insert([x, y, if k == 4 { -100.0 } else { 0.0 }])
            .unwrap();
    }
    bytes.clear();
    regular.write_compact(&mut bytes).unwrap();
    let weighted = Compact::open(
        breakline_triangulation::geometry::Weighted::<breakline_triangulation::kernel::Adaptive>::default(),
        &bytes,
    )
    .unwrap();
    assert_eq!((weighted.law(), weighted.vertex_count()), (Law::None, 4));
    assert_eq!(weighted.check(Level::Orientation), Ok(()));

    let heights = square.map(|[x, y]| [x, y, x * y]);
    let terrain: Terrain = Terrain::default();
    let (t, v) = Delaunay::from_points(terrain, &heights).unwrap();
    bytes.clear();
    t.write_compact(&mut bytes).unwrap();
    assert_eq!(
        open(&bytes).err(),
        Some(CompactError::Coordinates {
            expected: 2,
            found: 3
        })
    );
    let owned = Compact::open(terrain, bytes).unwrap();
    assert_eq!(owned.point(v[2]), Ok([5.0, 3.0, 15.0]));
    assert_eq!(owned.nearest(&[5.0, 2.0, 0.0], None), Ok(Some(v[2])));
}

#[test]
fn gaps_close() {
    let mut dice = Random(4);
    for round in 0..500 {
        let mut t = build(&points(&mut dice, round));
        for _ in 0..dice.below(6) {
            let slots = t.tds().vertex_slots();
            if slots > 0 {
                let _ = t.remove(VertexId::new(dice.index(slots)));
            }
        }
        let bytes = bytes(&t);
        let compact = open(&bytes).unwrap();
        assert_eq!(compact.check(Level::Law), Ok(()));
        let points =
            (0..compact.vertex_count()).map(|index| compact.point(VertexId::new(index)).unwrap());
        assert!(points.eq(t.tds().vertices().map(|v| *t.point(v))));
    }
}

/// Compares the bytes with the page on formats.
#[test]
fn the_format() {
    let t = build(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let bytes = bytes(&t);
    assert_eq!(bytes.len(), HEADER + 3 * 16 + 16 + 4 * 24);
    let mut expected = b"brkTIN\n\x1a".to_vec();
    for number in [2u32, 3, 2, 1] {
        expected.extend(number.to_le_bytes()); // version, vertices to a cell, doubles to a point, law
    }
    expected.extend(3u64.to_le_bytes());
    expected.extend(4u64.to_le_bytes());
    assert_eq!(bytes[..40], expected);
    assert_eq!(bytes[44..48], [0; 4]);
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let infinite_cell = number(40) as usize;
    assert!((0..3).any(|slot| number(112 + 24 * infinite_cell + 4 * slot) == u32::MAX));
    assert_eq!(
        f64::from_le_bytes(bytes[48..56].try_into().unwrap()),
        t.point(VertexId::new(0))[0]
    );
    for vertex in 0..3 {
        let cell = number(96 + 4 * vertex) as usize;
        assert!((0..3).any(|slot| number(112 + 24 * cell + 4 * slot) == vertex as u32));
    }
}

/// A tag and contents.
type Section = ([u8; 8], Vec<u8>);

/// A triangulation with some sections, of all lengths up to a multiple of 8 and beyond.
fn with_sections(t: &Free) -> (Vec<u8>, Vec<Section>) {
    let sections: Vec<Section> = (0..11u8)
        .map(|n| ([b'a' + n % 9; 8], vec![n; usize::from(n)]))
        .collect();
    let mut bytes = bytes(t);
    for (tag, contents) in &sections {
        CompactSection {
            tag: *tag,
            contents,
        }
        .write(&mut bytes)
        .unwrap();
    }
    (bytes, sections)
}

#[test]
fn sections_are_found_and_the_triangulation_does_not_change() {
    for t in samples() {
        let (whole, sections) = with_sections(&t);
        let compact = open(&whole).unwrap();
        assert_eq!(compact.check(Level::Law), Ok(()));
        let listed: Vec<Section> = compact
            .sections()
            .map(|s| (s.tag, s.contents.to_vec()))
            .collect();
        assert_eq!(listed, sections);
        assert_eq!(compact.section([b'c'; 8]), Some(&[2, 2][..]));
        assert_eq!(
            compact.section([b'a'; 8]),
            Some(&[][..]),
            "the first of two"
        );
        assert_eq!(compact.section([b'j'; 8]), None);
        for (tag, _) in &sections {
            let range = compact.section_range(*tag).unwrap();
            assert_eq!(Some(&compact.bytes()[range]), compact.section(*tag));
        }
        assert_eq!(compact.section_range([b'j'; 8]), None);
        let mut again = Vec::new();
        compact.write_compact(&mut again).unwrap();
        assert_eq!(again, bytes(&t));
    }
}

#[test]
fn incomplete_sections_are_not_opened() {
    let t = build(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let (whole, sections) = with_sections(&t);
    let mut ends = vec![bytes(&t).len()];
    for (_, contents) in &sections {
        ends.push(ends[ends.len() - 1] + 16 + contents.len().next_multiple_of(8));
    }
    assert_eq!(ends.last(), Some(&whole.len()));
    for length in ends[0]..=whole.len() {
        let opened = open(&whole[..length]);
        // A whole section less is not noticed: the program that needs it looks for it.
        assert_eq!(opened.is_ok(), ends.contains(&length), "{length} bytes");
        if let Err(error) = opened {
            let CompactError::Length { expected, found } = error else {
                panic!("{error}")
            };
            assert!(
                found == length as u64 && expected > found && expected <= whole.len() as u64,
                "{error}"
            );
        }
    }
    // A length near the end of all numbers.
    for length in [
        u64::MAX,
        u64::MAX - 7,
        u64::MAX - 16,
        u64::MAX - 40,
        1 << 63,
        1,
    ] {
        let mut bytes = bytes(&t);
        bytes.extend([b'x'; 8]);
        bytes.extend(length.to_le_bytes());
        assert!(
            matches!(open(&bytes), Err(CompactError::Length { .. })),
            "{length}"
        );
    }
}

#[test]
fn other_versions_are_refused_by_their_number() {
    for version in [0u32, 1, 3, u32::MAX] {
        let mut bytes = bytes(&build(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
        bytes[8..12].copy_from_slice(&version.to_le_bytes());
        let error = open(&bytes).unwrap_err();
        assert_eq!(error, CompactError::Version(version));
        assert!(
            error
                .to_string()
                .contains(&format!("version {version}; the known version is 2")),
            "{error}"
        );
    }
}

/// Makes every query, at sites in and around a small triangulation; returns true if there was any
/// error.
fn ask_everything(compact: &Opened<'_>, sites: &[Point]) -> bool {
    let mut is_damaged = compact.check(Level::Law).is_err();
    let mut note = |failed: bool| is_damaged |= failed;
    for cell in (0..compact.cell_slots() + 2).map(CellId::new) {
        note(compact.is_constrained(cell, 1).is_err());
    }
    for (k, p) in sites.iter().enumerate() {
        let q = &sites[(k + 1) % sites.len()];
        let near = (k > 0).then(|| CellId::new(k));
        if let Ok(Location::Cell { cell, .. }) = compact.locate(p, near) {
            assert!(compact.is_used(cell));
        }
        note(compact.locate(p, near).is_err());
        note(compact.nearest(p, near).is_err());
        note(all(compact.nearest_first(p, near)).is_err());
        note(all(compact.within(p, q)).is_err());
        note(compact.within_rectangle([p, q]).is_err());
        note(all(compact.along([p, q], near)).is_err());
        note(compact.conflict_zone(p, near).is_err());
    }
    for vertex in (0..compact.vertex_slots() + 2)
        .map(VertexId::new)
        .chain([VertexId::INFINITE])
    {
        note(all(compact.vertices_around(vertex)).is_err());
        note(all(compact.faces_from(vertex)).is_err());
        note(compact.edge(vertex, VertexId::new(0)).is_err());
        note(
            compact
                .face([vertex, VertexId::INFINITE, VertexId::new(0)])
                .is_err(),
        );
    }
    is_damaged
}

/// Small ones of each dimension, with ties.
fn samples() -> Vec<Free> {
    let grid: Vec<Point> = (0..9)
        .map(|k| [f64::from(k % 3), f64::from(k / 3)])
        .collect();
    [
        &grid[..],
        &grid[..3],
        &grid[..2],
        &grid[..1],
        &[],
        &[[0.0, 0.0], [4.0, 0.0], [1.0, 3.0], [7.0, 5.0]],
    ]
    .map(build)
    .into()
}

const SITES: [Point; 6] = [
    [0.5, 0.5],
    [1.0, 1.0],
    [-1.0, -1.0],
    [0.25, 1.0],
    [1.5, 1.25],
    [9.0, 1.0],
];

#[test]
fn no_truncation_is_opened() {
    for t in samples() {
        let mut bytes = bytes(&t);
        for length in 0..bytes.len() {
            assert!(open(&bytes[..length]).is_err());
        }
        bytes.push(0);
        assert!(open(&bytes).is_err());
    }
}

#[test]
fn every_damaged_byte_is_an_error_or_an_answer() {
    for t in samples() {
        let sound = bytes(&t);
        let cells = sound.len() - 24 * t.tds().cell_count();
        for at in 0..sound.len() {
            for value in (0..8)
                .map(|bit| sound[at] ^ 1 << bit)
                .chain([0, 1, 2, 0x7F, 0x80, 0xFE, 0xFF])
            {
                let mut damaged = sound.clone();
                damaged[at] = value;
                let Ok(compact) = open(&damaged) else {
                    continue;
                };
                let is_damaged = ask_everything(&compact, &SITES);
                // Unused slots below dimension 2 have no meaning.
                if at >= cells && value != sound[at] && t.dimension() == 2 {
                    assert!(
                        compact.check(Level::Manifold).is_err(),
                        "byte {at} as {value}"
                    );
                    assert!(is_damaged);
                }
            }
        }
        assert_eq!(open(&sound).unwrap().check(Level::Law), Ok(()));
    }
}

/// Numbers that exist, in the wrong slots: only the links themselves can reveal this.
#[test]
fn wrong_links() {
    let mut dice = Random(5);
    let mut errors = 0;
    for round in 0..6000 {
        let t = build(&points(&mut dice, 2 * round + 1));
        let (cells, vertices) = (t.tds().cell_count(), t.vertex_count());
        let mut bytes = bytes(&t);
        let start = bytes.len() - 24 * cells;
        for _ in 0..1 + dice.below(12) {
            let slot = dice.index(6);
            let number = dice.index(if slot < 3 { vertices } else { cells }.max(1)) as u32;
            let number = if slot < 3 && dice.below(5) == 0 {
                u32::MAX
            } else {
                number
            };
            if cells > 0 {
                let at = start + 24 * dice.index(cells) + 4 * slot;
                bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
            }
        }
        let sites: Vec<Point> = (0..4).map(|_| site(&mut dice)).collect();
        errors += usize::from(ask_everything(&open(&bytes).unwrap(), &sites));
    }
    assert!(errors > 3000, "{errors}");
}

/// Opening reads the header alone: whatever comes after it may be anything.
#[test]
fn only_the_header_is_looked_at_when_opened() {
    let t = build(&[[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]]);
    for garbage in [0, 0x55, 0xFF] {
        let mut bytes = bytes(&t);
        bytes[HEADER..].fill(garbage);
        let compact = open(&bytes).unwrap();
        assert!(compact.check(Level::Links).is_err());
        assert!(ask_everything(&compact, &SITES));
    }
}

/// Many threads may query at once.
#[test]
fn shared_between_threads() {
    let mut dice = Random(6);
    let points: Vec<Point> = (0..1000).map(|_| [dice.unit(), dice.unit()]).collect();
    let t = build(&points);
    let bytes = bytes(&t);
    let compact = open(&bytes).unwrap();
    std::thread::scope(|scope| {
        let compact = &compact;
        for part in points.chunks(250) {
            scope.spawn(move || {
                for p in part {
                    let found = compact.nearest(p, None).unwrap().unwrap();
                    assert_eq!(compact.point(found), Ok(*p));
                }
            });
        }
    });
}
