//! Contours from parts against those of the whole surface, bit for bit, where many heights lie
//! exactly on levels and where rounding shows.

use super::super::contours;
use super::super::join::Joined;
use super::super::line::finish_level;
use super::*;
use crate::crs::Crs;
use crate::data::{ContourLine, EdgeKind, Surface};
use crate::terrain::Levels;
use crate::terrain::tiles::{self, Residual, Tile, TileTriangle};
use std::collections::HashMap;
use testkit::random::{Random, ulps};

/// Triangles with their neighbors, found naively.
struct Whole {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    face_at: HashMap<[u32; 2], u32>,
}

impl Whole {
    fn new<'a>(triangles: impl IntoIterator<Item = &'a TileTriangle>) -> Self {
        let mut whole = Whole { vertices: Vec::new(), faces: Vec::new(), face_at: HashMap::new() };
        let mut number_of = HashMap::new();
        for triangle in triangles {
            let corners = triangle.corners.map(|corner| {
                *number_of.entry((corner.tile, corner.number)).or_insert_with(|| {
                    whole.vertices.push(corner.position);
                    whole.vertices.len() as u32 - 1
                })
            });
            for i in 0..3 {
                let side = [corners[i], corners[(i + 1) % 3]];
                assert_eq!(whole.face_at.insert(side, whole.faces.len() as u32), None);
            }
            whole.faces.push(corners);
        }
        whole
    }
}

impl Surface for Whole {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.vertices[vertex as usize]
    }

    fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.get(face as usize).copied()
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let corners = self.faces[face as usize];
        self.face_at.get(&[corners[(i + 2) % 3], corners[(i + 1) % 3]]).copied()
    }

    fn edge_kind(&self, _face: u32, _i: usize) -> EdgeKind {
        EdgeKind::Plain
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }
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
                _ => [FAR[0] + STEP * random.below(20) as f64, FAR[1] + STEP * random.below(20) as f64, z],
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
    tiles::leaf(&Tile::PLANE, 0, points, &mut emit).unwrap();
    split
}

/// The triangles of each task of a tree of tiles: leaves, merged in rows, merged at the root.
fn tiled(random: &mut Random, points: &[[f64; 3]]) -> Vec<Vec<TileTriangle>> {
    let mut cuts = |axis: usize| {
        let mut cuts: Vec<f64> = (0..random.below(4)).map(|_| random.pick(points)[axis]).collect();
        cuts.extend([f64::NEG_INFINITY, f64::INFINITY]);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let (columns, rows) = (cuts(0), cuts(1));
    let mut tasks = Vec::new();
    let mut task = |run: &mut dyn FnMut(&mut dyn FnMut(TileTriangle)) -> Residual| {
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
            let tile = Tile { min: [column[0], row[0]], max: [column[1], row[1]] };
            let own: Vec<[f64; 3]> = points.iter().copied().filter(|p| tile.holds([p[0], p[1]])).collect();
            of_leaves.push(task(&mut |emit| tiles::leaf(&tile, number, &own, emit).unwrap()));
            number += 1;
        }
        let tile = Tile { min: [f64::NEG_INFINITY, row[0]], max: [f64::INFINITY, row[1]] };
        of_rows.push(task(&mut |emit| tiles::merge(&tile, &of_leaves, emit).unwrap()));
    }
    task(&mut |emit| tiles::merge(&Tile::PLANE, &of_rows, emit).unwrap());
    tasks
}

fn collected(levels: &Levels, triangles: &[TileTriangle], patch_size: usize) -> ContourParts {
    let mut collector = ContourCollector::with_patch_size(levels, patch_size);
    triangles.iter().for_each(|triangle| collector.add(triangle));
    collector.finish().unwrap()
}

fn stored(parts: &ContourParts) -> Vec<u8> {
    let mut bytes = Vec::new();
    parts.write(&mut bytes).unwrap();
    bytes
}

/// The contours of the whole from stored parts.
fn joined(levels: &Levels, files: &[Vec<u8>]) -> Vec<ContourLine> {
    let tasks: Vec<StoredParts> = files.iter().map(|file| StoredParts::new(file).unwrap()).collect();
    let low = tasks.iter().map(|task| task.heights()[0]).fold(f64::INFINITY, f64::min);
    let high = tasks.iter().map(|task| task.heights()[1]).fold(f64::NEG_INFINITY, f64::max);
    let of_level = |level| {
        let parts = tasks.iter().filter_map(|task| task.level(level).unwrap()).collect();
        join_level(level, parts).unwrap()
    };
    levels.within(low, high).unwrap().into_iter().flat_map(of_level).collect()
}

fn bits(lines: &[ContourLine]) -> Vec<(u64, Vec<[u64; 2]>)> {
    let bits = |p: &[f64; 2]| p.map(f64::to_bits);
    lines.iter().map(|line| (line.level.to_bits(), line.points.iter().map(bits).collect())).collect()
}

/// The number of sets, which the environment sets:
/// `BREAKLINE_PARTS=20000 cargo test --lib contour::parts`.
fn count() -> usize {
    std::env::var("BREAKLINE_PARTS").ok().and_then(|n| n.parse().ok()).unwrap_or(600)
}

/// How often something happened that a wrong join would get wrong.
#[derive(Debug, Default)]
struct Seen {
    lines: usize,
    /// Arcs along edges between two tasks.
    arcs_between: usize,
    /// Vertices at which lines of several parts meet.
    shared_vertices: usize,
    /// Levels to which the rule is applied once more, because a crossing is at a vertex.
    touching: usize,
    /// Levels of which coordinates would give other lines.
    ambiguous: usize,
}

impl Seen {
    fn add(&mut self, lines: &[ContourLine], tasks: &[ContourParts]) {
        self.lines += lines.len();
        for of_level in lines.chunk_by(|a, b| a.level == b.level) {
            let line = |line: &ContourLine| Joined { points: line.points.clone(), closed: line.is_closed() };
            let again = finish_level(of_level[0].level, of_level.iter().map(line).collect(), true);
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
            for end in parts.iter().flat_map(|parts| &parts.open).flat_map(|line| &line.ends) {
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
    let mut seen = Seen::default();
    let rounds = count();
    for round in 0..rounds {
        let points = points(&mut random, round);
        if points.is_empty() {
            continue;
        }
        let mut tasks = if round % 3 == 0 { tiled(&mut random, &points) } else { split(&mut random, &points) };
        let share_of_holes = [0.0, 0.0, 0.1, 0.4][random.index(4)];
        tasks.iter_mut().for_each(|task| task.retain(|_| random.unit() >= share_of_holes));

        let levels = match round % 4 {
            0 => Levels::listed(&[0.5, 1.0, 1.5]),
            1 => Levels::every(0.25, 0.0),
            _ => Levels::every(0.5, 0.0),
        };
        let levels = levels.unwrap();
        let expected: Vec<ContourLine> = contours(&Whole::new(tasks.iter().flatten()), &levels).unwrap().collect();

        let patch_size = [1, 2, 7, 1000][random.index(4)];
        let mut parts: Vec<ContourParts> = tasks.iter().map(|task| collected(&levels, task, patch_size)).collect();
        seen.add(&expected, &parts);
        parts.iter().for_each(|parts| assert_eq!(ContourParts::read(&stored(parts)).unwrap(), *parts));
        random.shuffle(&mut parts);
        if random.below(2) == 0 {
            let some = parts.split_off(random.index(parts.len() + 1));
            parts.push(ContourParts::merged(some).unwrap());
        }
        let files: Vec<Vec<u8>> = parts.iter().map(stored).collect();
        assert_eq!(bits(&joined(&levels, &files)), bits(&expected), "round {round}: {points:?}");
    }
    println!("{rounds} rounds: {seen:?}");
    let Seen { lines, arcs_between, shared_vertices, touching, ambiguous } = seen;
    assert!([lines, arcs_between, shared_vertices, touching].into_iter().min() > Some(rounds / 4) && ambiguous > 0);
}
