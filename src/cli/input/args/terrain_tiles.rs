use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::parse::positive;
use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;

/// How the earth is divided into tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum TilingArg {
    /// Degrees (EPSG:4326), from two tiles
    #[default]
    Geographic,
    /// Web Mercator (EPSG:3857), from one tile
    Mercator,
}

/// The format of terrain tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum TerrainFormatArg {
    /// Quantized meshes with `layer.json`
    #[default]
    QuantizedMesh,
    /// 3D Tiles 1.1: GLB with implicit tiling
    #[value(name = "3dtiles")]
    Tiles3d,
}

/// Write a surface as levels of tiles for web globes such as CesiumJS
///
/// The surface is a TIN (.tin, .ply, .obj), a DEM (a surface between the centers of its cells) or
/// points, of which a TIN is built by the options below. It is written as quantized meshes with a
/// `layer.json`, in a folder that a web server can serve as it is. No vertex of the surface and no
/// line of it is further from the triangles of a level than its bound, which is measured on the
/// tiles as they are written. Where it does not hold, a warning says which one does. Tiles of a
/// level have the same vertices on a common border. Of points that would not fit into memory, a TIN
/// is built in files first; the tiles are the same.
///
/// Positions are transformed to longitude and latitude by PROJ, in a build that has it. Heights
/// must be above the ellipsoid of WGS 84, see --vertical-offset.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline terrain-tiles ground.tin -o tiles --vertical-offset 47.3
  breakline terrain-tiles dem.tif --a-srs EPSG:4326 --max-error 0.5 -o tiles")]
pub(crate) struct TerrainTilesArgs {
    /// Folder to write
    ///
    /// It appears with all its files at the end, or not at all.
    #[arg(short, long, required = true, value_name = "FOLDER")]
    pub(crate) output: PathBuf,

    /// Replace the folder, if this program has written tiles into it, and it has no other files
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Format of the tiles
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "FORMAT",
        help_heading = "Tiles"
    )]
    pub(crate) format: TerrainFormatArg,

    /// Division of the earth into tiles
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "TILING",
        help_heading = "Tiles"
    )]
    pub(crate) tiling: TilingArg,

    /// Bound of the finest level in meters; it doubles with each coarser level [default: by level]
    ///
    /// By default it is what viewers expect of a level: 0.29 m at level 18, 1.2 m at level 16.
    /// Alone, the option also chooses the finest level: the first one of which viewers expect no
    /// more.
    #[arg(long, value_name = "METERS", value_parser = positive, allow_negative_numbers = true, help_heading = "Tiles")]
    pub(crate) max_error: Option<f64>,

    /// Finest level [default: the first one with at most 64 heights along a side of its tiles]
    #[arg(long, value_name = "LEVEL", help_heading = "Tiles")]
    pub(crate) max_level: Option<u8>,

    /// Height around the surface, above the ellipsoid [default: the lowest of the surface]
    #[arg(
        long,
        value_name = "METERS",
        allow_negative_numbers = true,
        help_heading = "Tiles"
    )]
    pub(crate) fill: Option<f64>,

    /// Height of the geoid above the ellipsoid, which is added to heights
    ///
    /// Viewers need heights above the ellipsoid of WGS 84. Most surveys have heights above the
    /// geoid or another level of the sea, which is up to 105 m below and 85 m above it. Pass 0 if
    /// the heights are above the ellipsoid. Without this option, a build with PROJ transforms
    /// heights, if the coordinate system states their datum and the grid is installed.
    #[arg(
        long,
        value_name = "METERS",
        allow_negative_numbers = true,
        help_heading = "Tiles"
    )]
    pub(crate) vertical_offset: Option<f64>,

    /// Do not compress quantized meshes
    ///
    /// They are compressed by gzip, so a web server must send `Content-Encoding: gzip` with them.
    /// 3D Tiles are never compressed.
    #[arg(long, help_heading = "Tiles")]
    pub(crate) no_gzip: bool,

    /// Print a JSON object with the levels
    #[arg(long, help_heading = "Tiles")]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}
