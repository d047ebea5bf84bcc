//! Levels of terrain tiles, for viewers of the earth.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use flate2::Compression;
use flate2::write::GzEncoder;

use super::on_earth::Placing;
use super::surface::SurfaceProduct;
use crate::data::{TerrainTile, TilePosition, Tiling};
use crate::error::{Error, Result, Setting, wording};
use crate::io::quantized_mesh::{Extensions, LayerOptions, encode, layer_json, tiles_below};
use crate::io::tiles_3d::{self, TilesetRoot};
use crate::io::{FolderKind, OutputFolder};
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::proj::TransformOptions;
use crate::terrain::{Level, Pyramid, PyramidRule, TileReport, Water, is_height, water_triangles};

/// The file by which a viewer finds quantized meshes, and that by which it finds 3D Tiles.
const LAYER: &str = "layer.json";
const TILESET: &str = "tileset.json";

/// The folders that are replaced.
static TILES: FolderKind = FolderKind {
    name: "terrain tiles",
    marks: &[LAYER, TILESET],
    has: may_be_of_tiles,
};

/// Returns true for the path of a file, in its folder, if folders of tiles have such files.
fn may_be_of_tiles(path: &Path) -> bool {
    let Some(text) = path.to_str() else {
        return false;
    };
    let parts: Vec<&str> = text.split(std::path::MAIN_SEPARATOR).collect();
    let is_number = |part: &str| part.parse::<u32>().is_ok();
    let is_root = |part: &str| part.split('-').count() == 3 && part.split('-').all(is_number);
    let (around, numbers) = match parts[..] {
        [index] => return [LAYER, TILESET].contains(&index),
        [ref around @ .., level, column, row] => (around, [level, column, row]),
        _ => return false,
    };
    let Some((row, extension)) = numbers[2].split_once('.') else {
        return false;
    };
    let has_folder = match (extension, around) {
        ("terrain", []) => true,
        ("glb", ["content"]) | ("subtree", ["subtrees"]) => true,
        ("glb", [root, "content"]) | ("subtree", [root, "subtrees"]) => is_root(root),
        _ => false,
    };
    has_folder && [numbers[0], numbers[1], row].into_iter().all(is_number)
}

/// The folder in which terrain tiles will be: it appears with all of them or not at all.
#[derive(Debug)]
#[must_use = "tiles are to be written into it"]
pub struct TerrainFolder(OutputFolder);

impl TerrainFolder {
    /// Makes sure that tiles can be written to a folder that does not exist.
    ///
    /// # Errors
    /// If it exists, or the folder around it does not exist or cannot be written to.
    pub fn create(target: &Path) -> Result<Self> {
        OutputFolder::create(target, &TILES).map(TerrainFolder)
    }

    /// Makes sure that tiles can be written to a folder. One that exists is replaced if this
    /// program has written it, and it has no other files.
    ///
    /// # Errors
    /// If there is something that is not replaced, or the folder around it does not exist or cannot
    /// be written to.
    pub fn replace(target: &Path) -> Result<Self> {
        OutputFolder::replace(target, &TILES).map(TerrainFolder)
    }
}

/// The format of terrain tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum TerrainFormat {
    /// Quantized meshes with `layer.json`.
    #[default]
    QuantizedMesh,
    /// 3D Tiles 1.1: GLB with implicit tiling.
    Tiles3d,
}

/// Which terrain tiles are written, and how.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TerrainTilesOptions {
    /// The format.
    pub format: TerrainFormat,
    /// The levels, their bounds, and the division into tiles.
    pub rule: PyramidRule,
    /// What is added to heights to get heights above the ellipsoid, in meters: the height of the
    /// geoid, if heights are above it. With `None`, PROJ transforms heights by its grids if the
    /// coordinate system says what they are counted from and the grids are installed; otherwise
    /// nothing is added, and a notice says so.
    pub vertical_offset: Option<f64>,
    /// Quantized meshes are not compressed. 3D Tiles never are.
    pub plain: bool,
    /// How positions and heights are transformed to those of the earth.
    pub transform: TransformOptions,
    /// The name of the terrain; by default that of the folder.
    pub name: Option<String>,
}

impl TerrainTilesOptions {
    /// Returns an error if the options make no sense, whatever the surface is.
    ///
    /// # Errors
    /// Names the setting.
    pub fn check(&self) -> Result<()> {
        self.rule.check()?;
        if self.format == TerrainFormat::Tiles3d && self.rule.tiling != Tiling::Geographic {
            return Err(Error::unsupported(
                "3D Tiles are squares of degrees, and cannot be divided as Web Mercator is",
            ));
        }
        match self.vertical_offset {
            Some(offset) if !is_height(offset) => Err(Error::usage(format!(
                "{offset} is not a height of the geoid above the ellipsoid: one from -20000 to \
                 20000 m is needed"
            ))
            .cure(wording!["pass ", Setting::VerticalOffset.number("METERS")])),
            _ => Ok(()),
        }
    }
}

/// What was written of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LevelReport {
    /// 0 for the level with the largest tiles.
    pub level: u8,
    /// The bound in meters.
    pub bound: f64,
    /// No vertex of the surface and no line of it is further from the triangles than this, in
    /// meters: the bound, or what was measured if that is more. Then a [`Notice::BeyondBound`] says
    /// why.
    pub within: f64,
    /// The number of tiles.
    pub tiles: usize,
    /// The bytes of all tiles.
    pub bytes: u64,
    /// The sums of all tiles. A height on a border is measured against one of the tiles.
    pub sums: TileReport,
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TerrainTilesReport {
    /// The levels, the coarsest first.
    pub levels: Vec<LevelReport>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Writes a surface as levels of tiles, in a folder that appears at the end or not at all.
///
/// Heights are measured against the triangles as they are written: no vertex of the surface and no
/// line of it is further from them than the bound of the level, unless a [`Notice::BeyondBound`]
/// says so. A surface in parts stays in its files, and its tiles are those of the whole, byte for
/// byte.
///
/// # Errors
/// If the coordinate system is not known or cannot be transformed (which needs the feature `proj`,
/// unless it is that of the tiles), the surface is a large raster, there would be too many tiles,
/// a file cannot be written, or the run is canceled.
///
/// # Complexity
/// O(n log n) for n vertices, on all threads. In files without a name beside the folder, about 100
/// bytes for each vertex, which vanish with them; in memory what [`Pyramid::make`] needs.
pub fn write_terrain_tiles(
    surface: &SurfaceProduct,
    options: &TerrainTilesOptions,
    folder: TerrainFolder,
    context: &Context,
) -> Result<TerrainTilesReport> {
    let journal = Journal::new(context);
    options.check()?;
    let folder = folder.0;
    let placing = Placing::new(
        surface.crs(),
        options.vertical_offset,
        &options.transform,
        &journal,
    )?;
    let mut pyramid = Pyramid::new(
        &|take| surface.with_each_part(context, take),
        &|points| placing.apply(points),
        &options.rule,
        folder.around(),
        context.cancel,
    )?;
    let water = match options.format {
        TerrainFormat::QuantizedMesh => water_of(surface, &placing, context)?,
        TerrainFormat::Tiles3d => Water::new([]),
    };
    placing.warn(&journal);
    let mut layout = Layout::new(options, &pyramid, water, folder.target())?;
    let (levels, deepest) = write_levels(&mut pyramid, &layout, options, &folder, &journal)?;
    layout.measured(&pyramid, &levels, deepest);
    for (path, bytes) in layout.index(&pyramid)? {
        folder.write(&path, &bytes)?;
    }
    folder.commit()?;
    Ok(TerrainTilesReport {
        levels,
        notices: journal.take(),
    })
}

/// Returns the water of a surface, in degrees.
fn water_of(surface: &SurfaceProduct, placing: &Placing, context: &Context) -> Result<Water> {
    if !surface.has_lines()? {
        return Ok(Water::new([]));
    }
    surface.with_linked_faces(context, |faces| {
        let mut triangles = water_triangles(faces, &|| context.check())?;
        faces.ensure_intact()?;
        for triangle in &mut triangles {
            placing.apply(triangle)?;
        }
        let in_plan = triangles
            .iter()
            .map(|corners| corners.map(|[x, y, _]| [x, y]));
        Ok(Water::new(in_plan))
    })
}

/// Writes all tiles, and returns what was measured, and the depth of the deepest skirt.
fn write_levels(
    pyramid: &mut Pyramid,
    layout: &Layout,
    options: &TerrainTilesOptions,
    folder: &OutputFolder,
    journal: &Journal,
) -> Result<(Vec<LevelReport>, f64)> {
    let count: usize = pyramid.levels().iter().map(|level| level.tiles.len()).sum();
    let work = journal.start(Stage::WritingTiles, Size::Items(count as u64))?;
    let [tiles, bytes] = [(); 2].map(|()| AtomicU64::new(0));
    let heights = pyramid.heights();
    // What was measured of the level above, and the depth of the deepest skirt so far.
    let skirts = Mutex::new((Coarser::default(), 0.0_f64));
    let locked = || skirts.lock().unwrap_or_else(PoisonError::into_inner);
    // Servers send GLB as it is.
    let is_compressed = !options.plain && options.format == TerrainFormat::QuantizedMesh;
    let take = |level: &Level, tile: TerrainTile, report: &TileReport| {
        if let Some(path) = layout.path(tile.at) {
            let depth = {
                let (coarser, deepest) = &mut *locked();
                let depth = coarser.skirt(level, report, heights);
                *deepest = deepest.max(depth);
                depth
            };
            let mut written = layout.bytes(&tile, depth)?;
            if is_compressed {
                written = compressed(&written)?;
            }
            folder.write(&path, &written)?;
            tiles.fetch_add(1, Ordering::Relaxed);
            bytes.fetch_add(written.len() as u64, Ordering::Relaxed);
        }
        work.add(1)
    };
    let mut levels = Vec::new();
    let mut end = |level: &Level, sums: &TileReport| {
        let [tiles, bytes] = [&tiles, &bytes].map(|count| count.swap(0, Ordering::Relaxed));
        let within = level.within(sums);
        locked().0 = Coarser {
            within,
            curve: level.curve,
            step: level.step,
        };
        if tiles == 0 {
            return Ok(());
        }
        if within > level.bound {
            journal.add(Notice::BeyondBound {
                level: level.level,
                count: sums.beyond,
                within,
                bound: level.bound,
            });
        }
        levels.push(LevelReport {
            level: level.level,
            bound: level.bound,
            within,
            tiles: tiles as usize,
            bytes,
            sums: *sums,
        });
        Ok(())
    };
    pyramid.make(&take, &mut end, journal.context.cancel)?;
    work.end()?;
    let deepest = locked().1;
    Ok((levels, deepest))
}

/// Returns bytes compressed by gzip, as servers and viewers expect quantized meshes.
fn compressed(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::new(9));
    gzip.write_all(bytes)?;
    Ok(gzip.finish()?)
}

/// The files of a format: where tiles are, and by which files viewers find them.
enum Layout {
    QuantizedMesh {
        tiling: Tiling,
        name: String,
        /// The tiles of each level, the coarsest first.
        tiles: Vec<Vec<TilePosition>>,
        water: Water,
    },
    Tiles3d {
        roots: Vec<TilesetRoot>,
    },
}

impl Layout {
    fn new(
        options: &TerrainTilesOptions,
        pyramid: &Pyramid,
        water: Water,
        target: &Path,
    ) -> Result<Self> {
        let tiling = pyramid.tiling();
        match options.format {
            TerrainFormat::QuantizedMesh => {
                let of_folder = target.file_name().map(|name| name.to_string_lossy());
                let name = options.name.clone().unwrap_or_else(|| {
                    of_folder.map_or_else(|| "terrain".to_owned(), |name| name.into_owned())
                });
                Ok(Layout::QuantizedMesh {
                    tiling,
                    name,
                    tiles: tiles_of(pyramid).into_iter().map(<[_]>::to_vec).collect(),
                    water,
                })
            }
            TerrainFormat::Tiles3d => {
                let of_level = |at: TilePosition| TilesetRoot {
                    at,
                    bound: pyramid.levels()[usize::from(at.level)].bound,
                    range: pyramid.heights(),
                };
                let roots = tiles_3d::roots(&tiles_of(pyramid));
                Ok(Layout::Tiles3d {
                    roots: roots.into_iter().map(of_level).collect(),
                })
            }
        }
    }

    /// Returns where a tile is in the folder; `None` if the format does not have it.
    fn path(&self, at: TilePosition) -> Option<PathBuf> {
        match self {
            Layout::QuantizedMesh { .. } => Some(PathBuf::from(format!("{}.terrain", numbers(at)))),
            Layout::Tiles3d { roots } => roots.iter().find_map(|root| {
                let at = root.relative(at)?;
                let folder = root.folder(roots.len());
                Some(PathBuf::from(format!(
                    "{folder}content/{}.glb",
                    numbers(at)
                )))
            }),
        }
    }

    /// Returns the file of a tile, with a skirt of this depth in meters if viewers hang none.
    fn bytes(&self, tile: &TerrainTile, depth: f64) -> Result<Vec<u8>> {
        match self {
            Layout::QuantizedMesh {
                tiling,
                tiles,
                water,
                ..
            } => {
                let mask = (!water.is_empty()).then(|| water.mask(tiling.bounds(tile.at)));
                let slices: Vec<&[TilePosition]> = tiles.iter().map(Vec::as_slice).collect();
                let below = tiles_below(tile.at, &slices);
                let extensions = Extensions {
                    water: mask.as_ref(),
                    metadata: below.as_deref(),
                };
                encode(tile, *tiling, &extensions)
            }
            Layout::Tiles3d { .. } => tiles_3d::content(tile, Tiling::Geographic, depth),
        }
    }

    /// Changes the bounds and the ranges of heights that are stated to what was measured. `deepest`
    /// is the depth of the deepest skirt, in meters.
    fn measured(&mut self, pyramid: &Pyramid, levels: &[LevelReport], deepest: f64) {
        let Layout::Tiles3d { roots } = self else {
            return;
        };
        let all = pyramid.levels();
        let step = all.iter().map(|level| level.step).fold(0.0, f64::max);
        let [low, high] = pyramid.heights();
        for root in roots {
            let below = levels.iter().filter(|level| level.level >= root.at.level);
            // Viewers halve the error of the root with each level.
            let doubled = |level: &LevelReport| {
                level.within * f64::from(1_u32 << (level.level - root.at.level))
            };
            root.bound = below.map(doubled).fold(root.bound, f64::max);
            let curve = all[usize::from(root.at.level)].curve;
            root.range = [low - deepest - curve - step, high + step];
        }
    }

    /// Returns the files by which viewers find the tiles.
    fn index(&self, pyramid: &Pyramid) -> Result<Vec<(PathBuf, Vec<u8>)>> {
        let all = tiles_of(pyramid);
        match self {
            Layout::QuantizedMesh {
                tiling,
                name,
                water,
                ..
            } => {
                let mut extensions = vec!["octvertexnormals", "metadata"];
                extensions.extend((!water.is_empty()).then_some("watermask"));
                let layer = LayerOptions {
                    name: name.clone(),
                    bounds: pyramid.bounds(),
                    extensions,
                };
                let text = layer_json(*tiling, &all, &layer);
                Ok(vec![(PathBuf::from(LAYER), text.into_bytes())])
            }
            Layout::Tiles3d { roots } => {
                let finest = pyramid.levels().len().saturating_sub(1) as u8;
                let text = tiles_3d::tileset_json(roots, finest);
                let mut files = vec![(PathBuf::from(TILESET), text.into_bytes())];
                for root in roots {
                    let folder = root.folder(roots.len());
                    let path = |at| format!("{folder}subtrees/{}.subtree", numbers(at)).into();
                    let subtrees = tiles_3d::subtrees(root, &all).into_iter();
                    files.extend(subtrees.map(|(at, bytes)| (path(at), bytes)));
                }
                Ok(files)
            }
        }
    }
}

/// What was measured of the next coarser level: with it, skirts become as deep as a gap can be.
#[derive(Debug, Clone, Copy, Default)]
struct Coarser {
    /// See [`LevelReport::within`].
    within: f64,
    /// See [`Level::curve`].
    curve: f64,
    /// See [`Level::step`].
    step: f64,
}

impl Coarser {
    /// Returns the depth of the skirts of a tile, in meters: the largest gap to a tile of the
    /// coarser level. Both are within what was measured of the surface. Also, they are no further
    /// from each other than the lowest and the highest height, apart from the curve of the earth
    /// and steps.
    fn skirt(self, level: &Level, report: &TileReport, [low, high]: [f64; 2]) -> f64 {
        let sum = level.within(report) + self.within;
        sum.min(high - low + level.curve + self.curve + level.step + self.step)
    }
}

/// Returns the tiles of each level, the coarsest first.
fn tiles_of(pyramid: &Pyramid) -> Vec<&[TilePosition]> {
    let levels = pyramid.levels().iter();
    levels.map(|level| level.tiles.as_slice()).collect()
}

/// Returns the numbers of a tile as paths have them.
fn numbers(TilePosition { level, column, row }: TilePosition) -> String {
    format!("{level}/{column}/{row}")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::may_be_of_tiles;

    #[test]
    fn files_of_tiles_are_known_by_their_paths() {
        let own = [
            "layer.json",
            "tileset.json",
            "0/1/0.terrain",
            "content/0/0/0.glb",
            "subtrees/12/3/4.subtree",
            "3-4-5/content/0/0/0.glb",
            "3-4-5/subtrees/0/0/0.subtree",
        ];
        let others = [
            "index.html",
            "web/layer.json",
            "photos/a.jpg",
            "0/1.terrain",
            "0/1/x.terrain",
            "0/1/0.glb",
            "content/0/0/0.terrain",
            "a-b-c/content/0/0/0.glb",
            "web/0/1/0.terrain",
            "0/1/0.terrain.bak",
        ];
        let is_own = |path: &&str| {
            let native: std::path::PathBuf = Path::new(path).components().collect();
            may_be_of_tiles(&native)
        };
        assert!(own.iter().all(is_own));
        let taken = others.iter().find(|path| is_own(path));
        assert_eq!(taken, None);
    }
}
