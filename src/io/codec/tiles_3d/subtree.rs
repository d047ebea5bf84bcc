//! Files of subtrees: which tiles exist, as bits.

use rustc_hash::FxHashSet;
use serde_json::{Value, json};

use super::{SUBTREE_LEVELS, TilesetRoot};
use crate::data::TilePosition;

/// The tiles of a level as a square of so many columns and rows, below a root.
type Relative = TilePosition;

/// Returns the files of the subtrees below a root, each with its position in the tree of the root.
///
/// # Complexity
/// Linear in the tiles.
pub fn subtrees(root: &TilesetRoot, levels: &[&[TilePosition]]) -> Vec<(TilePosition, Vec<u8>)> {
    let tiles: FxHashSet<Relative> = levels
        .iter()
        .copied()
        .flatten()
        .filter_map(|&at| root.relative(at))
        .collect();
    let mut tops: Vec<Relative> = tiles
        .iter()
        .copied()
        .filter(|at| at.level.is_multiple_of(SUBTREE_LEVELS))
        .collect();
    tops.sort_unstable();
    let file = |top: Relative| (top, subtree(top, &tiles));
    tops.into_iter().map(file).collect()
}

fn subtree(top: Relative, tiles: &FxHashSet<Relative>) -> Vec<u8> {
    let own: Vec<bool> = (0..SUBTREE_LEVELS)
        .flat_map(|depth| below(top, depth))
        .map(|at| tiles.contains(&at))
        .collect();
    let children: Vec<bool> = below(top, SUBTREE_LEVELS)
        .map(|at| tiles.contains(&at))
        .collect();
    let mut bits = Vec::new();
    let mut views = Vec::new();
    let mut available = |flags: &[bool]| -> Value {
        let count = flags.iter().filter(|&&flag| flag).count();
        if count == 0 || count == flags.len() {
            return json!({ "constant": usize::from(count > 0) });
        }
        let packed: Vec<u8> = flags
            .chunks(8)
            .map(|flags| {
                (0..)
                    .zip(flags)
                    .fold(0, |byte, (k, &flag)| byte | u8::from(flag) << k)
            })
            .collect();
        views.push(json!({ "buffer": 0, "byteOffset": bits.len(), "byteLength": packed.len() }));
        bits.extend(packed);
        bits.resize(bits.len().next_multiple_of(8), 0);
        json!({ "bitstream": views.len() - 1, "availableCount": count })
    };
    let (own, children) = (available(&own), available(&children));
    let mut text = json!({
        "tileAvailability": own,
        "contentAvailability": [own],
        "childSubtreeAvailability": children,
    });
    if let Some(text) = text.as_object_mut()
        && !bits.is_empty()
    {
        text.insert("buffers".to_owned(), json!([{ "byteLength": bits.len() }]));
        text.insert("bufferViews".to_owned(), json!(views));
    }
    let mut text = text.to_string();
    while !text.len().is_multiple_of(8) {
        text.push(' ');
    }
    let mut bytes = b"subt".to_vec();
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend((text.len() as u64).to_le_bytes());
    bytes.extend((bits.len() as u64).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(bits);
    bytes
}

/// The tiles so many levels below another, along a Z-curve.
fn below(top: Relative, depth: u8) -> impl Iterator<Item = Relative> {
    let half = |code: u32| (0..16).fold(0, |number, bit| number | (code >> (2 * bit) & 1) << bit);
    (0..1_u32 << (2 * depth)).map(move |code| TilePosition {
        level: top.level + depth,
        column: (top.column << depth) + half(code),
        row: (top.row << depth) + half(code >> 1),
    })
}
