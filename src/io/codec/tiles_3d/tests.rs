use serde_json::Value;

use super::{SUBTREE_LEVELS, TilesetRoot, content, roots, subtrees, tileset_json};
use crate::crs::geocentric;
use crate::data::{TerrainTile, TilePosition, Tiling};
use testkit::random::Random;

fn at(level: u8, column: u32, row: u32) -> TilePosition {
    TilePosition { level, column, row }
}

/// The tiles of each level above some tiles.
fn levels_above(finest: &[TilePosition]) -> Vec<Vec<TilePosition>> {
    let mut levels = vec![finest.to_vec()];
    while levels[0][0].level > 0 {
        let mut above: Vec<TilePosition> = levels[0]
            .iter()
            .map(|t| at(t.level - 1, t.column / 2, t.row / 2))
            .collect();
        if above[0].level == 0 {
            above.extend([at(0, 0, 0), at(0, 1, 0)]);
        }
        above.sort_unstable();
        above.dedup();
        levels.insert(0, above);
    }
    levels
}

fn root_at(at: TilePosition) -> TilesetRoot {
    TilesetRoot {
        at,
        bound: 8.0,
        range: [0.0, 9.0],
    }
}

/// Whether a tile exists, as a viewer finds it out: by the subtrees on the way down.
fn exists(files: &[(TilePosition, Vec<u8>)], wanted: TilePosition) -> bool {
    let mut top = at(0, 0, 0);
    loop {
        let Some((_, bytes)) = files.iter().find(|(position, _)| *position == top) else {
            return false;
        };
        assert_eq!(&bytes[..4], b"subt");
        let length = |k: usize| u64::from_le_bytes(bytes[k..k + 8].try_into().unwrap()) as usize;
        let (text, bits) = (length(8), length(16));
        assert!(text.is_multiple_of(8) && bits.is_multiple_of(8));
        assert_eq!(bytes.len(), 24 + text + bits);
        let json: Value = serde_json::from_slice(&bytes[24..24 + text]).unwrap();
        let bit = |of: &Value, index: usize| match of.get("constant") {
            Some(constant) => constant == 1,
            None => {
                let view = &json["bufferViews"][of["bitstream"].as_u64().unwrap() as usize];
                let start = view["byteOffset"].as_u64().unwrap() as usize;
                bytes[24 + text + start + index / 8] >> (index % 8) & 1 == 1
            }
        };
        let morton = |at: TilePosition, depth: u8| {
            let [x, y] = [
                at.column - (top.column << depth),
                at.row - (top.row << depth),
            ];
            (0..16).fold(0, |code, k| {
                code | (x >> k & 1) << (2 * k) | (y >> k & 1) << (2 * k + 1)
            })
        };
        let depth = wanted.level - top.level;
        if depth < SUBTREE_LEVELS {
            let before = ((1_usize << (2 * depth)) - 1) / 3;
            let index = before + morton(wanted, depth) as usize;
            let own = bit(&json["tileAvailability"], index);
            assert_eq!(own, bit(&json["contentAvailability"][0], index));
            return own;
        }
        let up = depth - SUBTREE_LEVELS;
        let next = at(wanted.level - up, wanted.column >> up, wanted.row >> up);
        if !bit(
            &json["childSubtreeAvailability"],
            morton(next, SUBTREE_LEVELS) as usize,
        ) {
            return false;
        }
        top = next;
    }
}

#[test]
fn viewers_find_the_tiles_that_exist_and_no_others() {
    let mut random = Random(4);
    for level in [1, 3, 5, 6, 7, 11, 13] {
        let around = 1_u32 << level;
        let mut finest: Vec<TilePosition> = (0..30)
            .map(|_| {
                let near = |random: &mut Random| random.below(u64::from(around.min(9))) as u32;
                at(
                    level,
                    around / 3 + near(&mut random) % around,
                    near(&mut random) % around,
                )
            })
            .collect();
        finest.sort_unstable();
        finest.dedup();
        let levels = levels_above(&finest);
        let all: Vec<&[TilePosition]> = levels.iter().map(Vec::as_slice).collect();
        for root in roots(&all) {
            let root = root_at(root);
            let files = subtrees(&root, &all);
            let below: Vec<TilePosition> = levels
                .iter()
                .flatten()
                .filter_map(|&t| root.relative(t))
                .collect();
            assert!(below.iter().all(|&t| exists(&files, t)));
            let deep = level - root.at.level;
            for _ in 0..300 {
                let side = 1_u64 << deep;
                let t = at(deep, random.below(side) as u32, random.below(side) as u32);
                assert_eq!(exists(&files, t), below.contains(&t), "{t:?}");
            }
        }
    }
}

#[test]
fn the_root_is_the_smallest_square_with_all_tiles() {
    let levels = levels_above(&[at(9, 800, 300), at(9, 801, 301)]);
    let all: Vec<&[TilePosition]> = levels.iter().map(Vec::as_slice).collect();
    assert_eq!(roots(&all), [at(8, 400, 150)]);
    // On both sides of Greenwich.
    let levels = levels_above(&[at(9, 511, 300), at(9, 512, 300)]);
    let all: Vec<&[TilePosition]> = levels.iter().map(Vec::as_slice).collect();
    assert_eq!(roots(&all), [at(0, 0, 0), at(0, 1, 0)]);

    let text = tileset_json(&[root_at(at(8, 400, 150))], 9);
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["asset"]["version"], "1.1");
    assert_eq!(json["root"]["implicitTiling"]["availableLevels"], 2);
    assert_eq!(json["root"]["refine"], "REPLACE");
    assert_eq!(
        json["root"]["content"]["uri"],
        "content/{level}/{x}/{y}.glb"
    );
    let west = json["root"]["boundingVolume"]["region"][0]
        .as_f64()
        .unwrap();
    assert!((west.to_degrees() - (-180.0 + 400.0 * 180.0 / 256.0)).abs() < 1e-9);
    let two = tileset_json(&[root_at(at(0, 0, 0)), root_at(at(0, 1, 0))], 9);
    let json: Value = serde_json::from_str(&two).unwrap();
    assert_eq!(json["root"]["children"].as_array().unwrap().len(), 2);
}

/// The GLB is read by its own reader: with the origin of its node, and turned back, its positions
/// are on the earth, those of skirts below the borders; all triangles are seen from outside.
#[test]
fn a_tile_is_on_the_earth_with_skirts_around_it() {
    let all = TerrainTile::STEPS;
    let tile = TerrainTile {
        at: at(14, 17_000, 11_000),
        step: 0.125,
        lowest: 800,
        vertices: vec![
            [0, 0, 5],
            [all, 0, 0],
            [0, all, 9],
            [all, all, 400],
            [900, 700, 80],
        ],
        triangles: vec![[0, 1, 4], [1, 3, 4], [3, 2, 4], [2, 0, 4]],
        normals: vec![[0.0, 0.0, 1.0]; 5],
    };
    let bytes = content(&tile, Tiling::Geographic, 7.0).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let bin = &bytes[28 + length..];
    let origin: Vec<f64> = json["nodes"][0]["translation"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c.as_f64().unwrap())
        .collect();
    let float = |k: usize| f64::from(f32::from_le_bytes(bin[k..k + 4].try_into().unwrap()));
    let read = |v: usize| {
        let [x, up, south] = [0, 1, 2].map(|k| float(12 * v + 4 * k) + origin[k]);
        [x, -south, up]
    };
    let on_earth = |steps: [u16; 3], below: f64| {
        let [x, y, z] = tile.position(Tiling::Geographic, steps);
        geocentric([x, y, z - below])
    };
    let far = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
    assert_eq!(json["accessors"][0]["count"], 9);
    for (v, &steps) in tile.vertices.iter().enumerate() {
        assert!(far(read(v), on_earth(steps, 0.0)) < 1e-3);
    }
    let corners = |p: [f64; 3]| {
        tile.vertices[..4]
            .iter()
            .any(|&v| far(p, on_earth(v, 7.0)) < 1e-3)
    };
    assert!((5..9).all(|v| corners(read(v))));
    assert_eq!(json["accessors"][2]["count"], 3 * (4 + 8));
    let index = |k: usize| {
        let k = 24 * 9 + 4 * k;
        u32::from_le_bytes(bin[k..k + 4].try_into().unwrap()) as usize
    };
    let middle = on_earth([all / 2, all / 2, 0], 3.0);
    for face in 0..12 {
        let [a, b, c] = [0, 1, 2].map(|k| read(index(3 * face + k)));
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let normal = [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            u[i] * v[j] - u[j] * v[i]
        });
        let out: f64 = (0..3).map(|k| normal[k] * (a[k] - middle[k])).sum();
        assert!(out > 0.0, "{face}");
    }
}
