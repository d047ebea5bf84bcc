use super::{Extensions, SHORT, decode, tiles_below};
use crate::crs::{SEMI_AXES, geocentric};
use crate::data::{TerrainTile, TilePosition, Tiling, WaterMask};
use crate::error::Result;
use testkit::random::Random;

/// The bytes of a tile without further extensions.
fn encode(tile: &TerrainTile, tiling: Tiling) -> Result<Vec<u8>> {
    super::encode(tile, tiling, &Extensions::default())
}

/// Two triangles over a tile.
fn square(level: u8) -> TerrainTile {
    let all = TerrainTile::STEPS;
    TerrainTile {
        at: TilePosition {
            level,
            column: 1,
            row: 0,
        },
        step: 0.25,
        lowest: -3,
        vertices: vec![[0, 0, 5], [all, 0, 0], [0, all, 9], [all, all, all]],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        normals: Vec::new(),
    }
}

/// A strip of triangles along the south of a tile.
fn strip(count: usize) -> TerrainTile {
    let mut random = Random(count as u64);
    let vertices: Vec<[u16; 3]> = (0..count)
        .map(|i| {
            let steps = |random: &mut Random| random.below(32_768) as u16;
            [(i % 32_768) as u16, steps(&mut random), steps(&mut random)]
        })
        .collect();
    let triangles = (2..count as u32).map(|v| [v - 2, v - 1, v]).collect();
    TerrainTile {
        vertices,
        triangles,
        ..square(3)
    }
}

#[test]
fn a_tile_comes_back() {
    for tile in [
        square(0),
        square(9),
        strip(3),
        strip(1000),
        strip(SHORT),
        strip(SHORT + 1),
    ] {
        let read = decode(&encode(&tile, Tiling::Geographic).unwrap()).unwrap();
        assert_eq!(read.vertices, tile.vertices);
        assert_eq!(read.triangles, tile.triangles);
        assert_eq!(read.range, tile.range());
        for (vertex, steps) in (0..).zip(&tile.vertices) {
            assert_eq!(read.height(vertex), tile.height(steps[2]));
        }
    }
    let read = decode(&encode(&square(2), Tiling::WebMercator).unwrap()).unwrap();
    assert_eq!(
        read.borders,
        [vec![0, 2], vec![0, 1], vec![1, 3], vec![2, 3]]
    );
}

#[test]
fn a_vertex_that_does_not_exist_is_refused() {
    let mut tile = square(4);
    tile.triangles[1][0] = 4;
    let refused = encode(&tile, Tiling::Geographic).unwrap_err().to_string();
    assert!(refused.contains("vertex 4 of a tile"), "{refused}");
    assert!(crate::io::tiles_3d::content(&tile, Tiling::Geographic, 1.0).is_err());
}

#[test]
fn vertices_are_put_in_the_order_of_their_use() {
    let mut tile = square(4);
    tile.triangles = vec![[3, 2, 1], [2, 0, 1]];
    let read = decode(&encode(&tile, Tiling::Geographic).unwrap()).unwrap();
    let position = |mesh: &[[u16; 3]], face: [u32; 3]| face.map(|v| mesh[v as usize]);
    let before: Vec<_> = tile
        .triangles
        .iter()
        .map(|&f| position(&tile.vertices, f))
        .collect();
    let after: Vec<_> = read
        .triangles
        .iter()
        .map(|&f| position(&read.vertices, f))
        .collect();
    assert_eq!(before, after);
}

/// What the header promises, judged by its meaning: the sphere is around all vertices, and from
/// where the horizon point is hidden by the ellipsoid, so is each vertex.
#[test]
fn what_the_header_promises_holds() {
    let mut random = Random(8);
    for level in 0..16 {
        let tile = square(level);
        let bytes = encode(&tile, Tiling::Geographic).unwrap();
        let double = |k: usize| f64::from_le_bytes(bytes[k..k + 8].try_into().unwrap());
        let triple = |k: usize| [double(k), double(k + 8), double(k + 16)];
        let (center, radius, horizon) = (triple(32), double(56), triple(64));
        let corners: Vec<[f64; 3]> = tile
            .vertices
            .iter()
            .map(|&v| geocentric(tile.position(Tiling::Geographic, v)))
            .collect();
        let off = |p: &[f64; 3]| {
            (0..3)
                .map(|k| (p[k] - center[k]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        assert!(corners.iter().all(|p| off(p) <= radius * (1.0 + 1e-12)));
        // On the unit sphere, a point is hidden if it is beyond the tangent plane and in its cone.
        let is_hidden = |eye: [f64; 3], p: [f64; 3]| {
            let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
            let to = [0, 1, 2].map(|k| p[k] - eye[k]);
            let beyond = dot(eye, eye) - 1.0;
            let along = -dot(to, eye);
            along > beyond && along * along > beyond * dot(to, to)
        };
        let scaled: Vec<[f64; 3]> = corners
            .iter()
            .map(|p| [0, 1, 2].map(|k| p[k] / SEMI_AXES[k] * (1.0 - 1e-9)))
            .collect();
        for _ in 0..500 {
            let eye = [0; 3].map(|_| 6.0 * random.unit() - 3.0);
            let length = eye.iter().map(|c| c * c).sum::<f64>().sqrt();
            if length > 1.001 && is_hidden(eye, horizon) {
                assert!(
                    scaled.iter().all(|&p| is_hidden(eye, p)),
                    "level {level} from {eye:?}"
                );
            }
        }
    }
}

#[test]
fn damaged_tiles_are_refused_without_a_panic() {
    let mut random = Random(77);
    let good = encode(&strip(200), Tiling::Geographic).unwrap();
    for length in 0..good.len() {
        assert!(decode(&good[..length]).is_err(), "{length}");
    }
    for _ in 0..2000 {
        let mut bad = good.clone();
        for _ in 0..1 + random.below(4) {
            let at = random.index(bad.len());
            bad[at] = random.bits() as u8;
        }
        if let Ok(read) = decode(&bad) {
            let count = read.vertices.len() as u32;
            assert!(read.triangles.iter().flatten().all(|&v| v < count));
        }
    }
    assert!(
        decode(&[0x1f, 0x8b, 8])
            .unwrap_err()
            .to_string()
            .contains("gzip")
    );
}

#[test]
fn normals_come_back_up_to_a_step_of_their_bytes() {
    let mut random = Random(31);
    let mut tile = strip(500);
    tile.normals = (0..500)
        .map(|_| {
            let direction = [0; 3].map(|_| 2.0 * random.unit() - 1.0);
            crate::data::unit(direction).unwrap()
        })
        .collect();
    tile.normals[0] = [0.0, 0.0, -1.0];
    let read = decode(&encode(&tile, Tiling::Geographic).unwrap()).unwrap();
    assert_eq!(read.extensions, [1]);
    for (normal, bytes) in tile.normals.iter().zip(read.normals) {
        // As in the paper, and in CesiumJS.
        let [x, y] = bytes.map(|byte| f64::from(byte) / 255.0 * 2.0 - 1.0);
        let z = 1.0 - x.abs() - y.abs();
        let [x, y] = match z < 0.0 {
            true => [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)],
            false => [x, y],
        };
        let back = crate::data::unit([x, y, z]).unwrap();
        let cos: f64 = (0..3).map(|k| normal[k] * back[k]).sum();
        assert!(cos > 0.9998, "{normal:?} {back:?}");
    }
    let mut bytes = encode(&tile, Tiling::Geographic).unwrap();
    let at = bytes.len() - 1000 - 4;
    bytes[at..at + 4].copy_from_slice(&998_u32.to_le_bytes());
    bytes.truncate(at + 4 + 998);
    let refused = decode(&bytes).unwrap_err().to_string();
    assert!(
        refused.contains("998 bytes of normals for 500 vertices"),
        "{refused}"
    );
}

#[test]
fn water_and_metadata_come_back() {
    let mut random = Random(12);
    let side = WaterMask::SIDE;
    let cells: Vec<bool> = (0..side * side).map(|_| random.below(2) == 0).collect();
    let mut tile = square(5);
    tile.normals = vec![[0.0, 0.0, 1.0]; 4];
    for water in [
        WaterMask::Land,
        WaterMask::Water,
        WaterMask::of_cells(cells),
    ] {
        let extensions = Extensions {
            water: Some(&water),
            metadata: Some(r#"{"available":[]}"#),
        };
        let bytes = super::encode(&tile, Tiling::Geographic, &extensions).unwrap();
        let read = decode(&bytes).unwrap();
        assert_eq!(read.extensions, [1, 2, 4]);
        assert_eq!(read.water.as_ref(), extensions.water);
        assert_eq!(read.metadata.as_deref(), extensions.metadata);
        for length in encode(&tile, Tiling::Geographic).unwrap().len() + 1..bytes.len() {
            let is_between = decode(&bytes[..length]).is_ok_and(|read| read.metadata.is_none());
            assert!(is_between || decode(&bytes[..length]).is_err(), "{length}");
        }
    }
    assert_eq!(WaterMask::of_cells(vec![false; 4]), WaterMask::Land);
    assert_eq!(WaterMask::of_cells(vec![true; 4]), WaterMask::Water);
}

#[test]
fn a_tile_lists_those_below_it() {
    let mut random = Random(40);
    let tile = |level, column, row| TilePosition { level, column, row };
    let levels: Vec<Vec<TilePosition>> = (0..13_u8)
        .map(|level| {
            let mut tiles: Vec<TilePosition> = (0..60)
                .map(|_| [2_u64, 1].map(|sides| random.below(sides << level) as u32))
                .map(|[column, row]| tile(level, column, row))
                .collect();
            tiles.sort_unstable();
            tiles.dedup();
            tiles
        })
        .collect();
    let slices: Vec<&[TilePosition]> = levels.iter().map(Vec::as_slice).collect();
    assert_eq!(tiles_below(tile(1, 0, 0), &slices), None);
    for (at, last) in [(tile(0, 1, 0), 10), (tile(10, 9, 3), 12)] {
        let text = tiles_below(at, &slices).unwrap();
        let read: serde_json::Value = serde_json::from_str(&text).unwrap();
        let listed = read["available"].as_array().unwrap();
        assert_eq!(listed.len(), usize::from(last - at.level));
        for (level, ranges) in (at.level + 1..).zip(listed) {
            let mut found = Vec::new();
            for range in ranges.as_array().unwrap() {
                let number = |name: &str| range[name].as_u64().unwrap() as u32;
                for column in number("startX")..=number("endX") {
                    let rows = number("startY")..=number("endY");
                    found.extend(rows.map(|row| tile(level, column, row)));
                }
            }
            found.sort_unstable();
            let up = level - at.level;
            let is_below =
                |one: &&TilePosition| [one.column >> up, one.row >> up] == [at.column, at.row];
            let expected: Vec<TilePosition> = levels[usize::from(level)]
                .iter()
                .filter(is_below)
                .copied()
                .collect();
            assert_eq!(found, expected, "{at:?} {level}");
        }
    }
}
