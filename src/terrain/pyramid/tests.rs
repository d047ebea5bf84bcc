use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use rustc_hash::FxHashMap;

use super::lines::{chain, height_on};
use super::{Level, Pyramid, PyramidRule, TileReport, ToEarth};
use crate::Result;
use crate::crs::geocentric;
use crate::data::{EdgeKind, Mesh, Surface, TerrainTile, TilePosition, Tiling, corners, faces};
use crate::terrain::{Tin, TinBuilder};
use testkit::random::Random;

static GO_ON: AtomicBool = AtomicBool::new(false);

/// The side of a surface: that of eight tiles of level 13.
const SIDE: f64 = 8.0 * 180.0 / 8192.0;

/// A surface of random heights in degrees; small integers of a lattice, so that vertices lie on
/// borders of tiles, if `on_lines`.
fn surface(seed: u64, count: usize, on_lines: bool) -> Tin {
    let mut random = Random(seed);
    let mut builder = TinBuilder::default();
    // The surface is a square.
    for [x, y] in [[0.0, 0.0], [SIDE, 0.0], [0.0, SIDE], [SIDE, SIDE]] {
        builder.add_points(&[7.0 + x], &[46.0 + y], &[300.0]);
    }
    for _ in 0..count {
        let [x, y] = match on_lines {
            true => [0; 2].map(|_| random.below(64) as f64 * SIDE / 64.0),
            false => [0; 2].map(|_| random.unit() * SIDE),
        };
        let z = 300.0 + 40.0 * (x * 60.0).sin() + 30.0 * (y * 45.0).cos() + random.below(9) as f64;
        builder.add_points(&[7.0 + x], &[46.0 + y], &[z]);
    }
    builder.build().unwrap()
}

fn planned(parts: &[&dyn Surface], convert: &ToEarth, rule: &PyramidRule) -> Result<Pyramid> {
    let each = |take: &mut dyn FnMut(&dyn Surface) -> Result<()>| {
        parts.iter().try_for_each(|&part| take(part))
    };
    Pyramid::new(&each, convert, rule, &std::env::temp_dir(), &GO_ON)
}

fn pyramid(surface: &Tin, rule: &PyramidRule) -> Pyramid {
    let mut pyramid = planned(&[surface], &|_| Ok(()), rule).unwrap();
    // So that tiles of coarse levels have more.
    pyramid.heights.at_once = 200;
    pyramid
}

/// The heights of a surface.
fn vertices(surface: &dyn Surface) -> Vec<[f64; 3]> {
    let numbers = 0..surface.vertex_count() as u32;
    numbers.map(|vertex| surface.position(vertex)).collect()
}

/// The levels that are judged: coarser ones are grids that follow the earth.
fn levels(pyramid: &Pyramid) -> std::ops::Range<usize> {
    7..pyramid.levels().len()
}

/// The tiles of each level, in the order of their positions.
fn collect(pyramid: &mut Pyramid) -> Vec<Vec<(TerrainTile, TileReport)>> {
    let tiles = Mutex::new(Vec::new());
    let mut sums = Vec::new();
    let take = |_: &Level, tile: TerrainTile, report: &TileReport| {
        tiles.lock().unwrap().push((tile, *report));
        Ok(())
    };
    let mut end = |_: &Level, of_level: &TileReport| {
        sums.push(*of_level);
        Ok(())
    };
    pyramid.make(&take, &mut end, &GO_ON).unwrap();
    let mut levels = vec![Vec::new(); pyramid.levels().len()];
    for (tile, report) in tiles.into_inner().unwrap() {
        levels[usize::from(tile.at.level)].push((tile, report));
    }
    for (level, (tiles, sums)) in levels.iter_mut().zip(sums).enumerate() {
        tiles.sort_by_key(|(tile, _)| tile.at);
        let mut all = TileReport::default();
        tiles.iter().for_each(|(_, report)| all.merge(report));
        assert_eq!(all, sums);
        let positions: Vec<TilePosition> = tiles.iter().map(|(tile, _)| tile.at).collect();
        assert_eq!(positions, pyramid.levels()[level].tiles);
    }
    levels
}

/// The normals of a tile on a side, in the order of their vertices, as bits.
fn normals_of_side(tile: &TerrainTile, axis: usize, at: u16) -> Vec<(u16, [u64; 3])> {
    let with_normals = tile.vertices.iter().zip(&tile.normals);
    let mut side: Vec<(u16, [u64; 3])> = with_normals
        .filter(|(v, _)| v[axis] == at)
        .map(|(v, normal)| (v[1 - axis], normal.map(f64::to_bits)))
        .collect();
    side.sort_unstable();
    side
}

/// The vertices of a tile on a side, with the bits of their positions and heights.
fn side(tile: &TerrainTile, axis: usize, at: u16) -> Vec<[u64; 2]> {
    let mut side: Vec<[u64; 2]> = tile
        .vertices
        .iter()
        .filter(|v| v[axis] == at)
        .map(|v| [u64::from(v[1 - axis]), tile.height(v[2]).to_bits()])
        .collect();
    side.sort_unstable();
    side
}

fn rules() -> [PyramidRule; 3] {
    let rule = PyramidRule {
        finest: Some(13),
        ..PyramidRule::default()
    };
    [
        rule,
        PyramidRule {
            max_error: Some(0.5),
            finest: Some(12),
            ..rule
        },
        PyramidRule {
            fill: Some(-20.0),
            ..rule
        },
    ]
}

/// Tiles whose steps along y are not those of the map that divides the earth.
const MERCATOR: PyramidRule = PyramidRule {
    tiling: Tiling::WebMercator,
    finest: Some(12),
    max_error: Some(0.5),
    fill: None,
};

#[test]
fn borders_of_a_level_are_equal_to_the_bit() {
    let mut compared = 0;
    for (seed, rule) in (0..).zip(rules().into_iter().chain([MERCATOR])) {
        for on_lines in [false, true] {
            let surface = surface(seed, 900, on_lines);
            let mut pyramid = pyramid(&surface, &rule);
            let levels_of_tiles = collect(&mut pyramid);
            for level in levels(&pyramid) {
                let tiles = &levels_of_tiles[level];
                let by_position: FxHashMap<TilePosition, &TerrainTile> =
                    tiles.iter().map(|(tile, _)| (tile.at, tile)).collect();
                for (tile, _) in tiles {
                    let TilePosition { level, column, row } = tile.at;
                    let others = [(column + 1, row), (column, row + 1)];
                    for (axis, (column, row)) in others.into_iter().enumerate() {
                        let Some(other) = by_position.get(&TilePosition { level, column, row })
                        else {
                            continue;
                        };
                        let own = side(tile, axis, TerrainTile::STEPS);
                        assert_eq!(own, side(other, axis, 0), "{:?}", tile.at);
                        let [own_normals, normals] = [(tile, TerrainTile::STEPS), (other, 0)]
                            .map(|(tile, at)| normals_of_side(tile, axis, at));
                        assert_eq!(own_normals, normals);
                        compared += own.len();
                    }
                }
            }
        }
    }
    assert!(compared > 2000, "{compared}");
}

/// The height of a side of a tile at a position in steps.
fn height_along(side: &[[u64; 2]], t: f64) -> f64 {
    let after = side.partition_point(|&[at, _]| (at as f64) < t).max(1);
    let [[a, from], [b, to]] = [side[after - 1], side[after]];
    let [from, to] = [from, to].map(f64::from_bits);
    from + (t - a as f64) / (b - a) as f64 * (to - from)
}

#[test]
fn between_levels_borders_are_within_the_sum_of_the_bounds() {
    let mut random = Random(21);
    let mut judged = 0;
    for (seed, rule) in (40..).zip(rules()) {
        let surface = surface(seed, 900, seed % 2 == 0);
        let mut pyramid = pyramid(&surface, &rule);
        let levels_of_tiles = collect(&mut pyramid);
        for level in levels(&pyramid) {
            let [coarse, fine] = [&levels_of_tiles[level - 1], &levels_of_tiles[level]];
            let bounds = [level - 1, level].map(|level| pyramid.levels()[level].allowance);
            for (tile, _) in fine {
                let TilePosition { column, row, .. } = tile.at;
                let above = |other: &&(TerrainTile, TileReport)| {
                    [other.0.at.column, other.0.at.row] == [column / 2, row / 2]
                };
                let (parent, _) = coarse.iter().find(above).unwrap();
                for (axis, at) in [(0, column), (1, row)] {
                    // The side of the tile that is on one of the tile above it.
                    let side_at = if at % 2 == 0 { 0 } else { TerrainTile::STEPS };
                    let [own, other] = [tile, parent].map(|tile| side(tile, axis, side_at));
                    // Which half of the side above.
                    let half = f64::from([row, column][axis] % 2);
                    for _ in 0..200 {
                        let t = random.unit();
                        let heights = [
                            height_along(&own, t * 32_767.0),
                            height_along(&other, (t + half) / 2.0 * 32_767.0),
                        ];
                        let gap = (heights[0] - heights[1]).abs();
                        assert!(gap <= bounds[0] + bounds[1], "{:?} {gap}", tile.at);
                        judged += 1;
                    }
                }
            }
        }
    }
    assert!(judged > 10_000, "{judged}");
}

/// The height of a tile at a position in steps, by a search of all triangles.
fn height_of(tile: &TerrainTile, at: [f64; 2]) -> Option<f64> {
    tile.triangles.iter().find_map(|face| {
        let corners = face.map(|v| {
            let [x, y, z] = tile.vertices[v as usize];
            [f64::from(x), f64::from(y), tile.height(z)]
        });
        let side = |i: usize| {
            let [p, q] = [corners[i], corners[(i + 1) % 3]];
            (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0])
        };
        let is_inside = (0..3).all(|i| side(i) >= -1e-6);
        is_inside.then(|| height_on(corners, at))
    })
}

#[test]
fn the_bound_holds_at_each_height_of_each_level() {
    for rule in rules().into_iter().chain([MERCATOR]) {
        let surface = surface(5, 700, false);
        let mut pyramid = pyramid(&surface, &rule);
        let levels_of_tiles = collect(&mut pyramid);
        assert!(!pyramid.heights.few.is_empty());
        let points = vertices(&surface);
        for level in levels(&pyramid) {
            let bound = pyramid.levels()[level].bound;
            let tiles = &levels_of_tiles[level];
            let mut judged = 0;
            for (tile, report) in tiles {
                assert_eq!(report.beyond, 0, "{:?} {report:?}", tile.at);
                let [min, max] = rule.tiling.bounds(tile.at);
                for &[x, y, z] in &points {
                    if x < min[0] || x > max[0] || y < min[1] || y > max[1] {
                        continue;
                    }
                    let steps = |c: f64, k: usize| (c - min[k]) / (max[k] - min[k]) * 32_767.0;
                    let height = height_of(tile, [steps(x, 0), steps(y, 1)]).unwrap();
                    assert!(
                        (height - z).abs() <= bound,
                        "level {level}: {height} {z} {bound}"
                    );
                    judged += 1;
                }
            }
            assert!(judged >= points.len());
        }
    }
}

/// In the middle of each triangle, the earth is above it by no more than the share of the bound.
#[test]
fn coarse_tiles_follow_the_earth() {
    let mut pyramid = pyramid(&surface(3, 50, false), &rules()[0]);
    let levels_of_tiles = collect(&mut pyramid);
    for level in [0, 1, 4] {
        let Level {
            bound, allowance, ..
        } = pyramid.levels()[level];
        for (tile, _) in &levels_of_tiles[level] {
            for face in &tile.triangles {
                let corners =
                    face.map(|v| tile.position(Tiling::Geographic, tile.vertices[v as usize]));
                let middle = |of: [[f64; 3]; 3]| {
                    [0, 1, 2].map(|k| of.iter().map(|p| p[k]).sum::<f64>() / 3.0)
                };
                let flat = middle(corners.map(geocentric));
                let curved = geocentric(middle(corners));
                let length = |p: [f64; 3]| p.iter().map(|c| c * c).sum::<f64>().sqrt();
                let above = length(curved) - length(flat);
                assert!(above < (bound - allowance) * 1.01 + 1.0, "{level} {above}");
            }
        }
    }
}

/// A tile is one square of triangles, without gaps and overlaps: its area is that of the square,
/// and each edge inside has two triangles.
#[test]
fn a_tile_is_covered_once() {
    let surface = surface(2, 500, true);
    let mut pyramid = pyramid(&surface, &rules()[1]);
    let levels_of_tiles = collect(&mut pyramid);
    for level in levels(&pyramid) {
        for (tile, _) in &levels_of_tiles[level] {
            // No triangle along a border is as thin as rounding.
            for &[x, y, _] in &tile.vertices {
                let apart = [x, y].map(|c| c.min(TerrainTile::STEPS - c));
                assert!(apart.contains(&0) || apart.iter().all(|&steps| steps >= 8));
            }
            let mut doubled = 0;
            let mut edges: FxHashMap<[u32; 2], i32> = FxHashMap::default();
            for face in &tile.triangles {
                let corners = face.map(|v| tile.vertices[v as usize].map(i64::from));
                let [a, b, c] = corners;
                let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                assert!(area > 0);
                doubled += area;
                for i in 0..3 {
                    let [p, q] = [face[i], face[(i + 1) % 3]];
                    *edges.entry([p.min(q), p.max(q)]).or_default() += 1;
                }
            }
            assert_eq!(doubled, 2 * 32_767 * 32_767);
            let is_at_side = |v: u32| {
                let [x, y, _] = tile.vertices[v as usize];
                [x, y].iter().any(|&c| c == 0 || c == TerrainTile::STEPS)
            };
            assert!(edges.iter().all(|([p, q], &count)| {
                count == 2 || count == 1 && is_at_side(*p) && is_at_side(*q)
            }));
        }
    }
}

#[test]
fn a_border_depends_on_its_heights_alone_and_is_near_to_all() {
    let mut random = Random(11);
    for _ in 0..300 {
        let count = 1 + random.index(60);
        let mut heights: Vec<[f64; 2]> = (0..count)
            .map(|_| {
                let at = 1 + random.below(2000);
                [at as f64 * 16.25, random.below(50) as f64]
            })
            .collect();
        heights.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        heights.dedup_by(|a, b| a[0] == b[0]);
        let ends = [(0, 80), (32_767, 40)];
        let bound = 0.5 + random.below(20) as f64;
        let found = chain(&heights, &ends, 0.25, bound);
        assert!(ends.iter().all(|end| found.contains(end)));
        for &[t, z] in &heights {
            let after = found.partition_point(|&(at, _)| f64::from(at) < t).max(1);
            let [(a, from), (b, to)] = [found[after - 1], found[after]];
            let along = (t - f64::from(a)) / f64::from(b - a);
            let height = 0.25 * (f64::from(from) + along * f64::from(to - from));
            assert!((height - z).abs() <= bound + 1e-9);
        }
    }
}

/// What is stated holds, also if more is asked for than tiles of a level can have.
#[test]
fn the_curve_of_the_earth_is_stated() {
    let fine = PyramidRule {
        finest: Some(3),
        max_error: Some(0.1),
        ..PyramidRule::default()
    };
    let pyramid = pyramid(&surface(3, 50, false), &fine);
    for level in pyramid.levels() {
        let angle =
            std::f64::consts::SQRT_2 * std::f64::consts::PI / f64::from(level.grid << level.level);
        let above = 6_378_137.0 * (1.0 - (angle / 2.0).cos());
        assert!(level.curve > 0.99 * above, "{} {above}", level.curve);
        let within = level.within(&TileReport::default());
        assert!(
            within >= level.bound.max(level.allowance + 0.99 * above),
            "{level:?}"
        );
    }
    assert!(pyramid.levels()[0].curve > pyramid.levels()[0].bound);
}

/// The range that a tile states is not much larger than that of its heights.
#[test]
fn the_range_of_a_tile_is_its_own() {
    let mut pyramid = pyramid(&surface(6, 700, false), &rules()[1]);
    for (tile, _) in collect(&mut pyramid).iter().flatten() {
        let heights = tile.vertices.iter().map(|v| tile.height(v[2]));
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = tile.range();
        assert!(
            high - low < (2.0 * (highest - low)).max(32.0),
            "{:?}",
            tile.at
        );
        assert!([low, high].iter().all(|&z| f64::from(z as f32) == z));
    }
}

#[test]
fn what_cannot_be_tiled_is_refused() {
    let corners = vec![[7.0, 46.0, 1.0], [8.0, 46.0, 1.0], [7.0, 47.0, 1.0]];
    let mesh = Mesh::new(corners, vec![[0, 1, 2]], &[], None).unwrap();
    let refused = |convert: &ToEarth, rule: PyramidRule| {
        planned(&[&mesh], convert, &rule).err().unwrap().to_string()
    };
    let rule = PyramidRule::default();
    let far = |points: &mut [[f64; 3]]| {
        points.iter_mut().for_each(|p| p[0] += 400.0);
        Ok(())
    };
    assert!(refused(&far, rule).contains("beyond all tiles of EPSG:4326"));
    let lost = |points: &mut [[f64; 3]]| {
        points[0][1] = f64::NAN;
        Ok(())
    };
    assert!(refused(&lost, rule).contains("no position on the earth"));
    let here = |_: &mut [[f64; 3]]| Ok(());
    let level = |finest| PyramidRule {
        finest: Some(finest),
        ..rule
    };
    assert!(refused(&here, level(29)).contains("there is no level 29"));
    assert!(refused(&here, level(28)).contains("tiles of the surface"));
    let tiny = PyramidRule {
        max_error: Some(1e-12),
        ..rule
    };
    assert!(refused(&here, tiny).contains("tiles of the surface"));
    let bound = PyramidRule {
        max_error: Some(0.0),
        ..rule
    };
    assert!(refused(&here, bound).contains("is not a bound"));
}

/// The triangles of a surface as several, with other numbers and other first corners.
fn divided(surface: &dyn Surface, count: u32) -> Vec<Mesh> {
    let part = |of_part: u32| {
        let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
        let mut positions = Vec::new();
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        for (face, corners) in corners(surface).filter(|(face, _)| face % count == of_part) {
            let turned = [0, 1, 2].map(|k| corners[(k + face as usize) % 3]);
            triangles.push(turned.map(|vertex| {
                *numbers.entry(vertex).or_insert_with(|| {
                    positions.push(surface.position(vertex));
                    positions.len() as u32 - 1
                })
            }));
        }
        triangles.reverse();
        Mesh::new(positions, triangles, &[], None).unwrap()
    };
    (0..count).map(part).collect()
}

#[test]
fn parts_of_a_surface_have_the_tiles_of_the_whole() {
    for (seed, rule) in (70..).zip([rules()[1], MERCATOR]) {
        let surface = surface(seed, 900, seed % 2 == 0);
        let whole = collect(&mut pyramid(&surface, &rule));
        for count in [2, 7] {
            let meshes = divided(&surface, count);
            let parts: Vec<&dyn Surface> = meshes.iter().map(|part| part as &dyn Surface).collect();
            let mut divided = planned(&parts, &|_| Ok(()), &rule).unwrap();
            divided.heights.at_once = 200;
            assert!(collect(&mut divided) == whole, "{seed} {count}");
        }
    }
}

/// Tiles that are made from few heights have about as many vertices as those from all.
#[test]
fn few_heights_choose_nearly_as_few_vertices() {
    let rule = rules()[1];
    let surface = surface(12, 6000, false);
    let counts = [200, usize::MAX].map(|at_once| {
        let mut pyramid = pyramid(&surface, &rule);
        pyramid.heights.at_once = at_once;
        let levels = collect(&mut pyramid);
        let coarse = 9..levels.len() - 1;
        let tiles = levels[coarse].iter().flatten();
        tiles.map(|(_, report)| report.vertices).sum::<usize>()
    });
    let [few, all] = counts;
    assert!(few as f64 <= 1.1 * all as f64, "{few} {all}");
}

/// Between the vertices of a breakline, too.
#[test]
fn the_bound_holds_along_lines() {
    for (seed, rule) in (90..).zip(rules().into_iter().chain([MERCATOR])) {
        let mut random = Random(seed);
        let mut builder = TinBuilder::default();
        for [x, y] in [[0.0, 0.0], [SIDE, 0.0], [0.0, SIDE], [SIDE, SIDE]] {
            builder.add_points(&[7.0 + x], &[46.0 + y], &[300.0]);
        }
        for number in 0..300 {
            // Not nearer to the crests than a few steps of level 7.
            let band = [0.0, 0.4, 0.8][number % 3];
            let [x, y] = [random.unit(), band + 0.17 * random.unit()].map(|along| along * SIDE);
            builder.add_points(&[7.0 + x], &[46.0 + y], &[random.below(9) as f64]);
        }
        // Crests through all of it.
        for along in [0.3, 0.7] {
            let at = |t: f64, bend: f64| [7.0 + t * SIDE, 46.0 + (along + bend) * SIDE, 420.0];
            builder.add_breakline(&[at(0.02, 0.0), at(0.6, 0.05), at(0.97, -0.1)]);
        }
        let surface = builder.build().unwrap();
        let mut pyramid = pyramid(&surface, &rule);
        let levels_of_tiles = collect(&mut pyramid);
        let constrained: Vec<[[f64; 3]; 2]> = faces(&surface)
            .flat_map(|face| {
                let on_line = (0..3).filter(move |&i| face.edges[i] == EdgeKind::Breakline);
                on_line.map(move |i| [(i + 1) % 3, (i + 2) % 3].map(|k| face.corners[k]))
            })
            .map(|ends| ends.map(|vertex| surface.position(vertex)))
            .collect();
        assert!(constrained.len() >= 8);
        let mut judged = 0;
        for level in levels(&pyramid) {
            let bound = pyramid.levels()[level].bound;
            for (tile, report) in &levels_of_tiles[level] {
                assert_eq!(report.beyond, 0, "{:?} {report:?}", tile.at);
                let [min, max] = rule.tiling.bounds(tile.at);
                for [p, q] in &constrained {
                    for _ in 0..25 {
                        let t = random.unit();
                        let [x, y, z] = [0, 1, 2].map(|k| p[k] + t * (q[k] - p[k]));
                        if x < min[0] || x > max[0] || y < min[1] || y > max[1] {
                            continue;
                        }
                        let steps = |c: f64, k: usize| (c - min[k]) / (max[k] - min[k]) * 32_767.0;
                        let height = height_of(tile, [steps(x, 0), steps(y, 1)]).unwrap();
                        assert!((height - z).abs() <= bound, "{level} {height} {z} {bound}");
                        judged += 1;
                    }
                }
            }
        }
        assert!(judged > 500, "{judged}");
    }
}

/// The tile bends in a vertex that lies exactly under the line.
#[test]
fn a_line_through_vertices_of_a_tile_is_measured_there() {
    let rule = PyramidRule {
        max_error: Some(20.0),
        finest: Some(6),
        ..PyramidRule::default()
    };
    // The diagonal of a tile at each level; beside it, spikes that are rounded to it.
    let step = 180.0 / 64.0 / f64::from(TerrainTile::STEPS);
    let [begin, end] = [0.25, 0.6875];
    let mut builder = TinBuilder::default();
    for [x, y] in [[0.2, 0.2], [0.75, 0.2], [0.2, 0.75], [0.75, 0.75]] {
        builder.add_points(&[x], &[y], &[100.0]);
    }
    for k in [4000.0, 5111.0, 6500.0] {
        builder.add_points(&[(k + 0.4) * step], &[k * step], &[1100.0]);
    }
    builder.add_breakline(&[[begin, begin, 100.0], [end, end, 100.0]]);
    let surface = builder.build().unwrap();
    let mut largest = 0.0_f64;
    for (tile, report) in collect(&mut pyramid(&surface, &rule)).iter().flatten() {
        let [[west, south], _] = rule.tiling.bounds(tile.at);
        for &[u, v, z] in &tile.vertices {
            let [x, y, z] = tile.position(rule.tiling, [u, v, z]);
            if west == south && u == v && (begin..end).contains(&x) && x == y {
                let off = (z - 100.0).abs();
                largest = largest.max(off);
                assert!(report.largest >= off * (1.0 - 1e-9), "{:?} {off}", tile.at);
            }
        }
    }
    assert!(largest > 500.0, "{largest}");
}
