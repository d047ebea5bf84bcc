//! Contours from parts against those of the whole surface, bit for bit, where many heights lie
//! exactly on levels and where rounding shows.

use super::*;
use crate::data::{ContourLine, EdgeKind, Mesh};
use crate::terrain::Levels;
use crate::terrain::contour::contours;
use crate::terrain::contour::join::Joined;
use crate::terrain::contour::line::finish_level;
use crate::terrain::tiles::{self, Residual, Tile, TileTriangle, TileVertex};
use std::collections::HashMap;
use testkit::random::{Random, ulps};

/// The surface of triangles.
fn whole<'a>(triangles: impl IntoIterator<Item = &'a TileTriangle>) -> Mesh {
    let (mut vertices, mut number_of) = (Vec::new(), HashMap::new());
    let mut number = |corner: TileVertex| {
        *number_of
            .entry((corner.tile, corner.number))
            .or_insert_with(|| {
                vertices.push(corner.position);
                vertices.len() as u32 - 1
            })
    };
    let faces = triangles
        .into_iter()
        .map(|triangle| triangle.corners.map(&mut number))
        .collect();
    Mesh::new(vertices, faces, &[], None).unwrap()
}

/// Steps of an `f64` at positions of [`FAR`].
const STEP: f64 = 1.0 / (1 << 30) as f64;
const FAR: [f64; 2] = [4_512_000.0, 5_403_000.0];

/// Points of a grid, some left out, with heights that often lie on multiples of a half.
fn points(random: &mut Random, round: usize) -> Vec<[f64; 3]> {
    let [width, height] = [2 + random.below(7), 2 + random.below(7)];
    let share_left_out = [0.0, 0.0, 0.2][random.index(3)];
    let narrow = STEP * [1.0, 2.0, 3.0, 8.0][random.index(4)];
    let kind = round % 7;
    let mut all = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let z = match kind {
                // Saddles, summits and lakes of all sizes.
                0 => random.below(4) as f64 * 0.5,
                // Plateaus and ridges.
                1 => ((x / 2 + y / 3 + random.below(5) / 4) % 4) as f64 * 0.5,
                // Off the levels, mostly.
                2 | 4 => random.unit() * 2.0,
                // On a level, or beside it by a bit.
                3 => ulps(1.0 + random.below(3) as f64 * 0.5, random.around(1)),
                _ => random.below(13) as f64 * 0.25,
            };
            let [p, q] = [x as f64, y as f64];
            all.push(match kind {
                0 | 1 => [p, q, z],
                2 => [p + 0.3 * z, q - 0.2 * z, z],
                3 => [FAR[0] + p, FAR[1] + q, z],
                // So narrow that crossings coincide.
                4 | 5 => [FAR[0] + narrow * p, FAR[1] + narrow * q, z],
                _ => [
                    FAR[0] + STEP * random.below(20) as f64,
                    FAR[1] + STEP * random.below(20) as f64,
                    z,
                ],
            });
        }
    }
    all.retain(|_| random.unit() >= share_left_out);
    random.shuffle(&mut all);
    all
}

/// The triangles of all points, split pseudo-randomly.
fn split(random: &mut Random, points: &[[f64; 3]]) -> Vec<Vec<TileTriangle>> {
    let tasks = [1, 2, 3, 8, 100][random.index(5)];
    let in_stretches = random.below(2) == 0;
    let mut split = vec![Vec::new(); tasks];
    let mut task = 0;
    let mut emit = |triangle| {
        if !in_stretches || random.below(8) == 0 {
            task = random.index(tasks);
        }
        split[task].push(triangle);
    };
    tiles::leaf(&Tile::PLANE, 0, points, &[], 0.0, &mut emit).unwrap();
    split
}

type Emit<'a> = &'a mut dyn FnMut(TileTriangle);

/// The triangles of each task of a tree of tiles: leaves, merged in rows, merged at the root.
fn tiled(random: &mut Random, points: &[[f64; 3]]) -> Vec<Vec<TileTriangle>> {
    let mut cuts = |axis: usize| {
        let mut cuts: Vec<f64> = (0..random.below(4))
            .map(|_| random.pick(points)[axis])
            .collect();
        cuts.extend([f64::NEG_INFINITY, f64::INFINITY]);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let (columns, rows) = (cuts(0), cuts(1));
    let mut tasks = Vec::new();
    let mut task = |run: &mut dyn FnMut(Emit) -> Residual| {
        let mut triangles = Vec::new();
        let rest = run(&mut |triangle| triangles.push(triangle));
        tasks.push(triangles);
        rest
    };
    let mut number = 0;
    let mut of_rows = Vec::new();
    for row in rows.windows(2) {
        let mut of_leaves = Vec::new();
        for column in columns.windows(2) {
            let tile = Tile {
                min: [column[0], row[0]],
                max: [column[1], row[1]],
            };
            let own: Vec<[f64; 3]> = points
                .iter()
                .copied()
                .filter(|p| tile.holds([p[0], p[1]]))
                .collect();
            of_leaves.push(task(&mut |emit| {
                tiles::leaf(&tile, number, &own, &[], 0.0, emit).unwrap()
            }));
            number += 1;
        }
        let tile = Tile {
            min: [f64::NEG_INFINITY, row[0]],
            max: [f64::INFINITY, row[1]],
        };
        of_rows.push(task(&mut |emit| {
            tiles::merge(&tile, &of_leaves, 0.0, emit).unwrap()
        }));
    }
    task(&mut |emit| tiles::merge(&Tile::PLANE, &of_rows, 0.0, emit).unwrap());
    tasks
}

fn collected(levels: &Levels, triangles: &[TileTriangle], patch_size: usize) -> ContourParts {
    let mut collector = ContourCollector::with_patch_size(levels, patch_size);
    triangles
        .iter()
        .for_each(|triangle| collector.add(triangle));
    collector.finish().unwrap()
}

fn stored(parts: &ContourParts) -> Vec<u8> {
    let mut bytes = Vec::new();
    parts.write(&mut bytes).unwrap();
    bytes
}

/// The contours of the whole from stored parts, and where they are bent.
fn joined(levels: &Levels, files: &[Vec<u8>]) -> (Vec<ContourLine>, Bends) {
    let tasks: Vec<StoredParts> = files
        .iter()
        .map(|file| StoredParts::new(file).unwrap())
        .collect();
    let low = tasks
        .iter()
        .map(|task| task.heights()[0])
        .fold(f64::INFINITY, f64::min);
    let high = tasks
        .iter()
        .map(|task| task.heights()[1])
        .fold(f64::NEG_INFINITY, f64::max);
    let parts_of = |level| {
        let parts = tasks.iter().map(|task| task.level(level).unwrap());
        parts.flatten().collect::<Vec<_>>()
    };
    let within = levels.within(low, high).unwrap();
    let mut finder = BendFinder::default();
    for &level in &within {
        finder.add(level, parts_of(level)).unwrap();
    }
    let bends = finder.finish();
    let of_level = |level| join_level(level, parts_of(level), &bends).unwrap();
    let lines = within.into_iter().flat_map(of_level).collect();
    (lines, bends)
}

fn bits(lines: &[ContourLine]) -> Vec<(u64, Vec<[u64; 2]>)> {
    let bits = |p: &[f64; 2]| p.map(f64::to_bits);
    lines
        .iter()
        .map(|line| (line.level.to_bits(), line.points.iter().map(bits).collect()))
        .collect()
}

/// The number of sets, which the environment sets:
/// `BREAKLINE_PARTS=20000 cargo test --lib contour::parts`.
fn count() -> usize {
    std::env::var("BREAKLINE_PARTS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(300)
}

/// How often something happened that a wrong join would get wrong.
#[derive(Debug, Default)]
struct SeenCases {
    lines: usize,
    /// Arcs along edges between two tasks.
    arcs_between: usize,
    /// Vertices at which lines of several parts meet.
    shared_vertices: usize,
    /// Levels to which the rule is applied once more, because a crossing is at a vertex.
    touching: usize,
    /// Surfaces of which arcs are bent.
    bent: usize,
    /// Levels of which coordinates would give other lines.
    ambiguous: usize,
}

impl SeenCases {
    fn add(&mut self, lines: &[ContourLine], tasks: &[ContourParts]) {
        self.lines += lines.len();
        for of_level in lines.chunk_by(|a, b| a.level == b.level) {
            let line = |line: &ContourLine| Joined {
                points: line.points.clone(),
                closed: line.is_closed(),
            };
            let again = finish_level(
                of_level[0].level,
                of_level.iter().map(line).collect(),
                true,
                &Bends::default(),
            );
            self.ambiguous += usize::from(bits(&again) != bits(of_level));
        }
        let all: Vec<&LevelParts> = tasks.iter().flat_map(|task| &task.levels).collect();
        let mut levels: Vec<f64> = all.iter().map(|parts| parts.level).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        for level in levels {
            let parts: Vec<_> = all.iter().filter(|parts| parts.level == level).collect();
            self.touching += usize::from(parts.iter().any(|parts| parts.touches_vertices));
            let mut sides = HashMap::new();
            for side in parts.iter().flat_map(|parts| &parts.sides) {
                let [a, b] = side.vertices;
                let was_high = sides.insert([a.min(b), a.max(b)], side.is_high);
                self.arcs_between += usize::from(was_high == Some(!side.is_high));
            }
            let mut at_vertices = HashMap::new();
            for end in parts
                .iter()
                .flat_map(|parts| &parts.open)
                .flat_map(|line| &line.ends)
            {
                if let LineEnd::Vertex { vertex, .. } = end {
                    *at_vertices.entry(*vertex).or_insert(0) += 1;
                }
            }
            self.shared_vertices += at_vertices.values().filter(|&&ends| ends > 1).count();
        }
    }
}

#[test]
fn parts_give_the_contours_of_the_whole() {
    let mut random = Random(17);
    let mut seen = SeenCases::default();
    let rounds = count();
    for round in 0..rounds {
        let points = points(&mut random, round);
        if points.is_empty() {
            continue;
        }
        let mut tasks = if round % 3 == 0 {
            tiled(&mut random, &points)
        } else {
            split(&mut random, &points)
        };
        let share_of_holes = [0.0, 0.0, 0.1, 0.4][random.index(4)];
        tasks
            .iter_mut()
            .for_each(|task| task.retain(|_| random.unit() >= share_of_holes));

        let levels = match round % 4 {
            0 => Levels::listed(&[0.5, 1.0, 1.5]),
            1 => Levels::every(0.25, 0.0),
            _ => Levels::every(0.5, 0.0),
        };
        let levels = levels.unwrap();
        let expected: Vec<ContourLine> = contours(&whole(tasks.iter().flatten()), &levels)
            .unwrap()
            .collect();

        let patch_size = [1, 2, 7, 1000][random.index(4)];
        let mut parts: Vec<ContourParts> = tasks
            .iter()
            .map(|task| collected(&levels, task, patch_size))
            .collect();
        seen.add(&expected, &parts);
        parts
            .iter()
            .for_each(|parts| assert_eq!(ContourParts::read(&stored(parts)).unwrap(), *parts));
        random.shuffle(&mut parts);
        if random.below(2) == 0 {
            let some = parts.split_off(random.index(parts.len() + 1));
            parts.push(ContourParts::merged(some).unwrap());
        }
        let files: Vec<Vec<u8>> = parts.iter().map(stored).collect();
        let (lines, bends) = joined(&levels, &files);
        assert_eq!(bits(&lines), bits(&expected), "round {round}: {points:?}");
        seen.bent += usize::from(bends != Bends::default());
    }
    let often = [
        seen.lines,
        seen.arcs_between,
        seen.shared_vertices,
        seen.touching,
    ];
    assert!(
        often.into_iter().all(|count| count > rounds / 4),
        "{seen:?}"
    );
    assert!(seen.bent > rounds / 30, "{seen:?}");
    // Rare, with a test of its own.
    assert!(seen.ambiguous > 0 || rounds < 300, "{seen:?}");
}

/// A spur, so narrow at its root that both of its sides have their first crossing at one position.
/// The links between faces lead around the spur, and the loop rule cuts it off, as coordinates
/// would.
///
/// ```text
///        t         q       v and m are above the level, the others below
///        | /    /  |
///        v -- m -- p
///          \  s /
/// ```
#[test]
fn a_spur_without_width_is_cut_off() {
    let at = |x: i32, y: i32, z: f64| {
        [
            FAR[0] + STEP * f64::from(x),
            FAR[1] + STEP * f64::from(y),
            z,
        ]
    };
    let low = 1.0 - 0.5 / 0.15;
    let all = [
        at(0, 0, 1.0),
        at(4, 1, 3.0),
        at(8, 1, low),
        at(8, 3, low),
        at(4, -8, low),
        at(0, 8, low),
    ];
    let vertex = |number: u32| TileVertex {
        tile: 0,
        number,
        position: all[number as usize],
        is_tight: false,
    };
    let triangles =
        [[0, 2, 1], [1, 2, 3], [0, 1, 3], [0, 4, 2], [0, 3, 5]].map(|corners| TileTriangle {
            corners: corners.map(vertex),
            edges: [EdgeKind::Plain; 3],
        });
    let levels = Levels::listed(&[0.5]).unwrap();
    let expected: Vec<ContourLine> = contours(&whole(&triangles), &levels).unwrap().collect();
    assert_eq!(expected.len(), 2);
    assert!(expected.iter().any(ContourLine::is_closed));
    let files = triangles.map(|triangle| stored(&collected(&levels, &[triangle], 1000)));
    assert_eq!(bits(&joined(&levels, &files).0), bits(&expected));
    let rejoined = expected.iter().map(|line| Joined {
        points: line.points.clone(),
        closed: line.is_closed(),
    });
    let by_coordinates = finish_level(0.5, rejoined.collect(), true, &Bends::default());
    assert_eq!(bits(&by_coordinates), bits(&expected));
}

/// Half of all saddles around a vertex on the level, whole and with gaps, each split
/// pseudo-randomly.
#[test]
fn wheels_from_parts() {
    const RING: [[f64; 2]; 8] = [
        [2.0, 0.0],
        [2.0, 2.0],
        [0.0, 2.0],
        [-2.0, 2.0],
        [-2.0, 0.0],
        [-2.0, -2.0],
        [0.0, -2.0],
        [2.0, -2.0],
    ];
    let mut random = Random(4);
    let levels = Levels::listed(&[0.0]).unwrap();
    for number in (0..3_u32.pow(8)).step_by(2) {
        let corner = |at: u32| {
            let ([x, y], height) = (RING[at as usize], number / 3_u32.pow(at) % 3);
            TileVertex {
                tile: at % 2,
                number: at,
                position: [x, y, f64::from(height) - 1.0],
                is_tight: false,
            }
        };
        let center = TileVertex {
            tile: 1,
            number: 8,
            position: [0.0; 3],
            is_tight: false,
        };
        let [keep, tasks] = [random.bits() | random.bits(), random.bits()];
        let all: Vec<(usize, TileTriangle)> = (0..8)
            .filter(|at| keep >> at & 1 == 1)
            .map(|at| {
                let corners = [center, corner(at), corner((at + 1) % 8)];
                (
                    (tasks >> (2 * at) & 3) as usize,
                    TileTriangle {
                        corners,
                        edges: [EdgeKind::Plain; 3],
                    },
                )
            })
            .collect();
        let expected: Vec<ContourLine> =
            contours(&whole(all.iter().map(|(_, triangle)| triangle)), &levels)
                .unwrap()
                .collect();
        let file = |task| {
            let own: Vec<TileTriangle> = all
                .iter()
                .filter(|(of, _)| *of == task)
                .map(|(_, t)| *t)
                .collect();
            stored(&collected(&levels, &own, 1000))
        };
        assert_eq!(
            bits(&joined(&levels, &[0, 1, 2, 3].map(file)).0),
            bits(&expected),
            "{number} {keep:b} {tasks:b}"
        );
    }
}

/// Parts with everything that there can be.
fn rich() -> ContourParts {
    let mut random = Random(2);
    let points: Vec<[f64; 3]> = (0..144)
        .map(|i| [f64::from(i % 12), f64::from(i / 12), random.below(4) as f64])
        .collect();
    let mut triangles = Vec::new();
    tiles::leaf(&Tile::PLANE, 0, &points, &[], 0.0, &mut |triangle| {
        triangles.push(triangle)
    })
    .unwrap();
    triangles.retain(|_| random.below(10) > 0);
    let parts = collected(&Levels::every(0.5, 0.0).unwrap(), &triangles, 1000);
    let has_all = |parts: &LevelParts| {
        !(parts.closed.is_empty() || parts.open.is_empty() || parts.sides.is_empty())
    };
    assert!(parts.levels.iter().any(has_all));
    parts
}

#[test]
fn damaged_bytes_are_refused_or_read() {
    let mut random = Random(6);
    let bytes = stored(&rich());
    for end in 0..bytes.len() {
        assert!(ContourParts::read(&bytes[..end]).is_err(), "{end} bytes");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(
        ContourParts::read(&longer).unwrap_err().to_string(),
        "parts of contours are damaged"
    );
    let (mut refused, mut contradicted) = (0, 0);
    for _ in 0..2000 {
        let mut damaged = bytes.clone();
        for _ in 0..1 + random.below(3) {
            let at = random.index(damaged.len());
            let any = random.bits() as u8;
            damaged[at] = random.pick(&[0, 1, 0x7f, 0x80, 0xf0, 0xff, any]);
        }
        let Ok(read) = ContourParts::read(&damaged) else {
            refused += 1;
            continue;
        };
        for parts in &read.levels {
            contradicted += usize::from(
                join_level(parts.level, vec![parts.clone()], &Bends::default()).is_err(),
            );
        }
        let _ = ContourParts::merged(vec![read]);
    }
    assert!(
        refused > 200 && contradicted > 10,
        "{refused} {contradicted}"
    );
}

#[test]
fn what_is_given_twice_is_refused() {
    let parts = rich();
    let error = ContourParts::merged(vec![parts.clone(), parts.clone()])
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("the parts of level 0 contradict each other at ["),
        "{error}"
    );
    let level = parts.levels[0].clone();
    assert!(
        join_level(
            level.level,
            vec![level.clone(), level.clone()],
            &Bends::default()
        )
        .is_err()
    );
    let error = join_level(17.0, vec![level], &Bends::default())
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "parts of several levels are joined, expected level 17 only"
    );

    let vertex = |number, position| TileVertex {
        tile: 0,
        number,
        position,
        is_tight: false,
    };
    let corners = [
        vertex(0, [0.0, 0.0, 0.0]),
        vertex(1, [1.0, 0.0, 0.0]),
        vertex(2, [0.0, 1.0, 2.0]),
    ];
    let triangle = TileTriangle {
        corners,
        edges: [EdgeKind::Plain; 3],
    };
    let mut collector = ContourCollector::new(&Levels::every(1.0, 0.0).unwrap());
    collector.add(&triangle);
    collector.add(&triangle);
    let error = collector.finish().unwrap_err().to_string();
    assert!(
        error.starts_with("two triangles are on the same side of the edge from ["),
        "{error}"
    );
}

/// A slope whose heights come in ascending order, by steps below the interval.
#[test]
fn levels_are_found_while_heights_rise() {
    let mut triangles = Vec::new();
    let points: Vec<[f64; 3]> = (0..2000)
        .map(|i| [f64::from(i % 2), f64::from(i / 2), 1e-3 * f64::from(i)])
        .collect();
    tiles::leaf(&Tile::PLANE, 0, &points, &[], 0.0, &mut |triangle| {
        triangles.push(triangle)
    })
    .unwrap();
    triangles.sort_by(|a, b| a.corners[0].position[2].total_cmp(&b.corners[0].position[2]));
    let many: Vec<f64> = (0..3000).map(|i| 1e-3 * f64::from(i)).collect();
    for levels in [
        Levels::every(1e-4, 0.0),
        Levels::every(0.1, 7.0),
        Levels::listed(&many),
    ] {
        let levels = levels.unwrap();
        let expected: Vec<ContourLine> = contours(&whole(&triangles), &levels).unwrap().collect();
        for step in [1, -1] {
            triangles.sort_by(|a, b| a.corners[0].position[2].total_cmp(&b.corners[0].position[2]));
            if step < 0 {
                triangles.reverse();
            }
            let file = stored(&collected(&levels, &triangles, 100));
            assert_eq!(bits(&joined(&levels, &[file]).0), bits(&expected));
        }
    }
}

#[test]
fn too_many_levels_and_invalid_heights_are_refused() {
    let vertex = |number, position| TileVertex {
        tile: 0,
        number,
        position,
        is_tight: false,
    };
    let finished = |height| {
        let corners = [
            vertex(0, [0.0, 0.0, 0.0]),
            vertex(1, [1.0, 0.0, 0.0]),
            vertex(2, [0.0, 1.0, height]),
        ];
        let mut collector = ContourCollector::new(&Levels::every(0.1, 0.0).unwrap());
        collector.add(&TileTriangle {
            corners,
            edges: [EdgeKind::Plain; 3],
        });
        collector.finish()
    };
    assert!(
        finished(1e6)
            .unwrap_err()
            .to_string()
            .starts_with("contour interval 0.1 gives ")
    );
    assert!(
        finished(f64::NAN)
            .unwrap_err()
            .to_string()
            .ends_with("is not a finite point")
    );
    // Most of what is allowed: nothing far beyond the heights is asked for.
    assert_eq!(finished(4e4).unwrap().levels.len(), 400_000);
    let none = ContourCollector::new(&Levels::every(0.1, 0.0).unwrap())
        .finish()
        .unwrap();
    assert_eq!(ContourParts::read(&stored(&none)).unwrap(), none);
}
