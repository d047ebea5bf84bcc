use serde_json::json;

use super::pair;
use super::product::in_lines;
use crate::cli::Exit;
use crate::cli::input::args::{TerrainFormatArg, TerrainTilesArgs, TilingArg};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::summary::counted;
use crate::data::Tiling;
use crate::error::Result;
use crate::run::{self, Degrees, LevelReport, TerrainFolder, TerrainFormat, TerrainTilesOptions};
use crate::terrain::{Method, PyramidRule};

/// Writes a surface as levels of terrain tiles.
pub(crate) fn run(args: &TerrainTilesArgs, console: &Console) -> Result<Exit> {
    pair::refuse_tables(&args.surface, "terrain-tiles")?;
    let options = options(args);
    options.check()?;
    // Before the surface, which may take minutes.
    let folder = match args.overwrite {
        true => TerrainFolder::replace(&args.output)?,
        false => TerrainFolder::create(&args.output)?,
    };
    let mut plan = SurfacePlan::resolve(&args.surface, console)?;
    // Tiles are in degrees.
    plan.request.systems.degrees = Degrees::Allow;
    let surface = pair::open(&plan, Method::Linear, &args.memory, console)?;
    let report = run::write_terrain_tiles(&surface, &options, folder, &console.context())?;
    for level in &report.levels {
        console.line(format_args!("{:11} {}", name_of(level), text(level)));
    }
    console.line(format_args!("{}", args.output.display()));
    if args.json {
        let levels: Vec<_> = report.levels.iter().map(as_json).collect();
        let all = json!({ "folder": args.output.display().to_string(), "levels": levels });
        print(&in_lines(&all))?;
    }
    Ok(Exit::Done)
}

fn options(args: &TerrainTilesArgs) -> TerrainTilesOptions {
    TerrainTilesOptions {
        format: match args.format {
            TerrainFormatArg::QuantizedMesh => TerrainFormat::QuantizedMesh,
            TerrainFormatArg::Tiles3d => TerrainFormat::Tiles3d,
        },
        rule: PyramidRule {
            tiling: match args.tiling {
                TilingArg::Geographic => Tiling::Geographic,
                TilingArg::Mercator => Tiling::WebMercator,
            },
            finest: args.max_level,
            max_error: args.max_error,
            fill: args.fill,
        },
        vertical_offset: args.vertical_offset,
        plain: args.no_gzip,
        transform: (&args.surface.systems.transform).into(),
        name: None,
    }
}

fn name_of(level: &LevelReport) -> String {
    format!("level {}", level.level)
}

fn text(level: &LevelReport) -> String {
    format!(
        "{}, {}, {} bytes, within {:.3} m",
        counted(level.tiles as u64, "tile"),
        counted(level.sums.triangles as u64, "triangle"),
        level.bytes,
        level.within,
    )
}

fn as_json(level: &LevelReport) -> serde_json::Value {
    json!({
        "level": level.level,
        "bound": level.bound,
        "within": level.within,
        "tiles": level.tiles,
        "bytes": level.bytes,
        "vertices": level.sums.vertices,
        "triangles": level.sums.triangles,
        "heights": level.sums.heights,
        "largest": level.sums.largest,
        "beyond": level.sums.beyond,
    })
}
