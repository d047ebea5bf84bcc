//! `tileset.json`: the roots of the tree.

use serde_json::{Value, json};

use super::SUBTREE_LEVELS;
use crate::data::{TilePosition, Tiling};

/// The largest tile of a tree of squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TilesetRoot {
    /// Which tile it is.
    pub at: TilePosition,
    /// The bound of its level, in meters; half of it with each level below.
    pub bound: f64,
    /// The lowest height of all tiles and their skirts, and the highest.
    pub range: [f64; 2],
}

impl TilesetRoot {
    /// Returns where a tile is below the root: the root is 0, 0, 0. `None` if it is not below it.
    pub fn relative(&self, at: TilePosition) -> Option<TilePosition> {
        let depth = at.level.checked_sub(self.at.level)?;
        if depth > Tiling::MAX_LEVEL {
            return None;
        }
        let is_below = [at.column >> depth, at.row >> depth] == [self.at.column, self.at.row];
        is_below.then(|| TilePosition {
            level: depth,
            column: at.column & ((1 << depth) - 1),
            row: at.row & ((1 << depth) - 1),
        })
    }

    /// Returns the folder of its files, if there are `count` roots: its own, unless it is alone.
    pub fn folder(&self, count: usize) -> String {
        let TilePosition { level, column, row } = self.at;
        match count {
            1 => String::new(),
            _ => format!("{level}-{column}-{row}/"),
        }
    }
}

/// Returns the roots of the smallest trees that have all tiles: the one tile of the finest level
/// that has only one, else those of the coarsest level that have tiles below them.
pub fn roots(levels: &[&[TilePosition]]) -> Vec<TilePosition> {
    let finer = levels.get(1).copied().unwrap_or_default();
    let has_finer = |at: &&TilePosition| {
        let is_parent =
            |finer: &TilePosition| [finer.column / 2, finer.row / 2] == [at.column, at.row];
        finer.is_empty() || finer.iter().any(is_parent)
    };
    let coarsest = levels.first().copied().unwrap_or_default();
    let mut roots: Vec<TilePosition> = coarsest.iter().filter(has_finer).copied().collect();
    if roots.len() == 1 {
        for level in &levels[1..] {
            if let [only] = level[..] {
                roots = vec![only];
            }
        }
    }
    roots
}

/// Returns the text of `tileset.json` for trees of `depth` levels.
pub fn tileset_json(roots: &[TilesetRoot], finest: u8) -> String {
    let tiling = Tiling::Geographic;
    let region = |at: TilePosition| {
        let [min, max] = tiling.bounds(at);
        [min, max].map(|corner| corner.map(f64::to_radians))
    };
    let all = roots.iter().map(|root| region(root.at)).reduce(|a, b| {
        let pick = |k: usize, choose: fn(f64, f64) -> f64| {
            [0, 1].map(|axis| choose(a[k][axis], b[k][axis]))
        };
        [pick(0, f64::min), pick(1, f64::max)]
    });
    let range = roots
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |range, root| {
            [range[0].min(root.range[0]), range[1].max(root.range[1])]
        });
    let volume = |[[west, south], [east, north]]: [[f64; 2]; 2], [low, high]: [f64; 2]| json!({ "region": [west, south, east, north, low, high] });
    let bound = roots.iter().fold(0.0, |bound, root| root.bound.max(bound));
    let tree = |root: &TilesetRoot| {
        let folder = root.folder(roots.len());
        json!({
            "boundingVolume": volume(region(root.at), root.range),
            "geometricError": root.bound,
            "refine": "REPLACE",
            "content": { "uri": format!("{folder}content/{{level}}/{{x}}/{{y}}.glb") },
            "implicitTiling": {
                "subdivisionScheme": "QUADTREE",
                "subtreeLevels": SUBTREE_LEVELS,
                "availableLevels": u32::from(finest.saturating_sub(root.at.level)) + 1,
                "subtrees": { "uri": format!("{folder}subtrees/{{level}}/{{x}}/{{y}}.subtree") },
            },
        })
    };
    let trees: Vec<Value> = roots.iter().map(tree).collect();
    let root = match &trees[..] {
        [tree] => tree.clone(),
        _ => json!({
            "boundingVolume": volume(all.unwrap_or_default(), range),
            "geometricError": 2.0 * bound,
            "refine": "REPLACE",
            "children": trees,
        }),
    };
    let tileset = json!({
        "asset": {
            "version": "1.1",
            "generator": format!("breakline {}", env!("CARGO_PKG_VERSION")),
        },
        "geometricError": 4.0 * bound,
        "root": root,
    });
    format!("{tileset:#}\n")
}
