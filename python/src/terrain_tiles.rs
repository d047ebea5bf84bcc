//! Levels of terrain tiles, in a folder.

use std::path::PathBuf;

use breakline::data::Tiling;
use breakline::run::proj::TransformOptions;
use breakline::run::{self, TerrainFolder, TerrainFormat, TerrainTilesOptions};
use breakline::terrain::PyramidRule;
use pyo3::prelude::*;

use crate::errors::Result;
use crate::requests;
use crate::surface::Surface;
use crate::work::{self, Call};

/// A level in Python: its number, its bound, the one that holds and the largest distance, and the
/// numbers of tiles, bytes, vertices, triangles, heights, and heights beyond the bound.
type Level = (u8, [f64; 3], [u64; 6]);

/// What is written, under the names in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct TerrainArguments {
    format: String,
    tiling: String,
    max_error: Option<f64>,
    max_level: Option<u8>,
    fill: Option<f64>,
    vertical_offset: Option<f64>,
    no_gzip: bool,
    require_grids: bool,
    epoch: Option<f64>,
}

/// Writes a surface as levels of terrain tiles.
#[pyfunction]
pub(crate) fn terrain_tiles(
    py: Python<'_>,
    surface: PyRef<'_, Surface>,
    given: TerrainArguments,
    folder: (PathBuf, bool),
    call: Call,
) -> PyResult<Vec<Level>> {
    let options = TerrainTilesOptions {
        format: requests::choose(
            "format",
            &given.format,
            &[
                ("quantized-mesh", TerrainFormat::QuantizedMesh),
                ("3dtiles", TerrainFormat::Tiles3d),
            ],
        )?,
        rule: PyramidRule {
            tiling: requests::choose(
                "tiling",
                &given.tiling,
                &[
                    ("geographic", Tiling::Geographic),
                    ("mercator", Tiling::WebMercator),
                ],
            )?,
            finest: given.max_level,
            max_error: given.max_error,
            fill: given.fill,
        },
        vertical_offset: given.vertical_offset,
        plain: given.no_gzip,
        transform: TransformOptions {
            require_grids: given.require_grids,
            epoch: given.epoch,
        },
        name: None,
    };
    let surface = surface.product();
    let (target, overwrite) = folder;
    let report = work::run(py, &call, |context| -> Result<_> {
        let folder = match overwrite {
            true => TerrainFolder::replace(&target)?,
            false => TerrainFolder::create(&target)?,
        };
        Ok(run::write_terrain_tiles(
            &surface, &options, folder, context,
        )?)
    })?;
    let level = |level: &run::LevelReport| {
        let sums = &level.sums;
        let counts = [
            level.tiles as u64,
            level.bytes,
            sums.vertices as u64,
            sums.triangles as u64,
            sums.heights as u64,
            sums.beyond as u64,
        ];
        (
            level.level,
            [level.bound, level.within, sums.largest],
            counts,
        )
    };
    Ok(report.levels.iter().map(level).collect())
}
