//! `layer.json`: what a viewer asks for first.

use serde_json::{Value, json};

use crate::data::{TilePosition, Tiling};

/// What `layer.json` says besides the tiles that exist.
#[derive(Debug, Clone)]
pub struct LayerOptions {
    /// The name of the terrain.
    pub name: String,
    /// The smallest longitude and latitude of the surface, and the largest, in degrees.
    pub bounds: [[f64; 2]; 2],
    /// The names of the extensions that tiles have. With "metadata", tiles [list](tiles_below)
    /// those below them.
    pub extensions: Vec<&'static str>,
}

/// Returns the text of `layer.json` for the tiles of each level, which are in the order of columns,
/// then rows.
pub fn layer_json(tiling: Tiling, levels: &[&[TilePosition]], options: &LayerOptions) -> String {
    let [[west, south], [east, north]] = options.bounds;
    let available: Vec<Value> = levels.iter().map(|tiles| json!(ranges(tiles))).collect();
    let mut layer = json!({
        "tilejson": "2.1.0",
        "name": options.name,
        "version": "1.0.0",
        "format": "quantized-mesh-1.0",
        "scheme": "tms",
        "tiles": ["{z}/{x}/{y}.terrain?v={version}"],
        "projection": format!("EPSG:{}", tiling.epsg()),
        "bounds": [west, south, east, north],
        "minzoom": 0,
        "maxzoom": levels.len().saturating_sub(1),
        "available": available,
        "generator": format!("breakline {}", env!("CARGO_PKG_VERSION")),
    });
    if let Some(layer) = layer.as_object_mut()
        && !options.extensions.is_empty()
    {
        layer.insert("extensions".to_owned(), json!(options.extensions));
        if options.extensions.contains(&"metadata") {
            layer.insert("metadataAvailability".to_owned(), json!(LISTED));
        }
    }
    format!("{layer:#}\n")
}

/// So many levels of tiles are listed in one above them.
const LISTED: u8 = 10;

/// Returns the text by which a tile lists the tiles below it, for the next ten levels; `None` for a
/// tile that has no list, because one above it has these tiles. `levels` are those of
/// [`layer_json`].
pub fn tiles_below(at: TilePosition, levels: &[&[TilePosition]]) -> Option<String> {
    if !at.level.is_multiple_of(LISTED) {
        return None;
    }
    let below = |deeper: u8| {
        let tiles = levels.get(usize::from(at.level) + usize::from(deeper))?;
        let range = |n: u32| u64::from(n) << deeper..(u64::from(n) + 1) << deeper;
        let [columns, rows] = [at.column, at.row].map(range);
        let [first, end] = [columns.start, columns.end]
            .map(|column| tiles.partition_point(|tile| u64::from(tile.column) < column));
        let inside = tiles[first..end]
            .iter()
            .filter(|tile| rows.contains(&u64::from(tile.row)));
        Some(ranges(&inside.copied().collect::<Vec<_>>()))
    };
    let available: Vec<Vec<Value>> = (1..=LISTED).map_while(below).collect();
    Some(json!({ "available": available }).to_string())
}

/// A rectangle of tiles: its first and its last column and row.
type Range = [[u32; 2]; 2];

/// Returns rectangles that cover tiles, each once.
fn ranges(tiles: &[TilePosition]) -> Vec<Value> {
    let mut closed: Vec<Range> = Vec::new();
    // Those that end at the column before, or at this one.
    let mut open: Vec<Range> = Vec::new();
    for column in tiles.chunk_by(|a, b| a.column == b.column) {
        let mut next: Vec<Range> = Vec::new();
        for rows in column.chunk_by(|a, b| a.row + 1 == b.row) {
            let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
                continue;
            };
            let is_before = |range: &Range| {
                range[1][0] + 1 == first.column
                    && [range[0][1], range[1][1]] == [first.row, last.row]
            };
            match open.iter().position(is_before) {
                Some(found) => {
                    let mut range = open.swap_remove(found);
                    range[1][0] = first.column;
                    next.push(range);
                }
                None => next.push([[first.column, first.row], [last.column, last.row]]),
            }
        }
        closed.append(&mut open);
        open = next;
    }
    closed.append(&mut open);
    closed.sort_unstable();
    let value = |[[x, y], [to_x, to_y]]: Range| json!({ "startX": x, "startY": y, "endX": to_x, "endY": to_y });
    closed.into_iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    #[test]
    fn ranges_cover_each_tile_once() {
        let mut random = Random(3);
        for _ in 0..200 {
            let mut tiles: Vec<TilePosition> = (0..40)
                .map(|_| TilePosition {
                    level: 5,
                    column: random.below(6) as u32,
                    row: random.below(6) as u32,
                })
                .collect();
            tiles.sort_unstable();
            tiles.dedup();
            let mut covered = Vec::new();
            for range in ranges(&tiles) {
                let number = |name: &str| range[name].as_u64().unwrap() as u32;
                for column in number("startX")..=number("endX") {
                    covered.extend((number("startY")..=number("endY")).map(|row| TilePosition {
                        level: 5,
                        column,
                        row,
                    }));
                }
            }
            covered.sort_unstable();
            assert_eq!(covered, tiles);
        }
    }
}
