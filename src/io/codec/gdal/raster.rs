use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use gdal::raster::GdalDataType;
use gdal::{Dataset, DatasetOptions, GdalOpenFlags};

use super::{messages, names};
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Grid, Window};
use crate::error::{Error, Result, Wording};
use crate::io::bytes::watch::{Watch, unwatched};

/// Limit for the cells of one read; 8 bytes each.
const MAX_CELLS: usize = 1 << 31;

/// Cells that are read before the watch is called, roughly.
const CELLS_AT_ONCE: usize = 1 << 22;

/// A raster that GDAL has open. Its first band is read: values are stored sample x scale + offset,
/// and NaN for nodata (by its nodata value or its mask).
#[derive(Debug)]
pub struct Raster {
    path: PathBuf,
    /// In a mutex because GDAL's datasets must be used by one thread at a time.
    dataset: Mutex<Dataset>,
    description: String,
    frame: Frame,
    crs: Option<Crs>,
    nodata: Option<f64>,
    /// True if samples are f32; the nodata value is then compared as f32.
    is_single: bool,
    has_mask: bool,
    scale: f64,
    offset: f64,
    warnings: Vec<Wording>,
}

/// Opens a raster of any format that GDAL supports, or a subdataset (`NETCDF:file.nc:z`).
///
/// # Errors
/// If GDAL cannot open it, or it has no band.
pub fn open_raster(path: impl AsRef<Path>) -> Result<Raster> {
    let path = &*names::shown(path.as_ref());
    messages::listen();
    let options = DatasetOptions {
        open_flags: GdalOpenFlags::GDAL_OF_RASTER | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR,
        ..DatasetOptions::default()
    };
    let dataset = Dataset::open_ex(names::with_secrets(path), options)
        .map_err(|error| messages::cannot_open(path, "raster", error))?;
    let in_file = |error| messages::error(path, error);
    if dataset.raster_count() == 0 {
        return Err(Error::format("a raster without bands")
            .in_file(path)
            .cure("name one of its subdatasets, which `gdalinfo` lists"));
    }
    let band = dataset.rasterband(1).map_err(in_file)?;
    let kind = band.band_type();
    let nodata = match kind {
        GdalDataType::Int64 => band.no_data_value_i64().map(|value| value as f64),
        GdalDataType::UInt64 => band.no_data_value_u64().map(|value| value as f64),
        _ => band.no_data_value(),
    };
    let mask = band.mask_flags().map_err(in_file)?;
    let has_mask = !mask.is_all_valid() && !mask.is_nodata();
    let (scale, offset) = (band.scale().unwrap_or(1.0), band.offset().unwrap_or(0.0));
    let mut warnings = messages::warnings();
    let (width, height) = dataset.raster_size();
    let transform = dataset.geo_transform().unwrap_or_else(|_| {
        warnings.push("no georeferencing: coordinates are columns and rows".into());
        [0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    });
    let wkt = dataset.projection();
    let crs = match wkt.is_empty() {
        true => None,
        false => Crs::from_wkt(&wkt)
            .map_err(|error| {
                warnings.push(format!("the coordinate system is not understood: {error}").into())
            })
            .ok(),
    };
    let bands = dataset.raster_count();
    Ok(Raster {
        path: path.to_path_buf(),
        description: format!(
            "GDAL {}, {kind}, {bands} {}",
            dataset.driver().short_name(),
            if bands == 1 { "band" } else { "bands" }
        ),
        frame: Frame {
            width,
            height,
            transform,
        },
        crs,
        nodata,
        is_single: kind == GdalDataType::Float32,
        has_mask,
        scale: if scale == 0.0 { 1.0 } else { scale },
        offset,
        warnings,
        dataset: Mutex::new(dataset),
    })
}

impl Raster {
    /// Returns a description such as "GDAL AAIGrid, Float32, 1 band".
    pub fn description(&self) -> String {
        self.description.clone()
    }

    /// Returns the size and position.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Returns the coordinate system, if known.
    pub fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    /// Returns warnings for the user.
    pub fn warnings(&self) -> &[Wording] {
        &self.warnings
    }

    /// Reads the values of a window, row by row; NaN is nodata.
    ///
    /// # Errors
    /// If the window is not within the raster, is larger than 2^31 cells, or GDAL fails to read it.
    pub fn read_window(&self, window: Window) -> Result<Vec<f64>> {
        let Window {
            column,
            row,
            width,
            height,
        } = window;
        let within = |start: usize, length: usize, end: usize| {
            start.checked_add(length).is_some_and(|last| last <= end)
        };
        if !within(column, width, self.frame.width) || !within(row, height, self.frame.height) {
            let Frame { width, height, .. } = self.frame;
            return Err(
                Error::usage(format!("{window:?} is not within {width} x {height} cells"))
                    .in_file(&self.path),
            );
        }
        let cells = width
            .checked_mul(height)
            .filter(|&cells| cells <= MAX_CELLS)
            .ok_or_else(|| {
                let message = format!(
                    "a window of {width} x {height} cells, at most {MAX_CELLS} are read at once"
                );
                Error::limit(message).in_file(&self.path)
            })?;
        let mut values = self.buffer(cells)?;
        if cells == 0 {
            return Ok(values);
        }
        values.resize(cells, 0.0);
        messages::listen();
        let dataset = self.lock();
        let in_file = |error| messages::error(&self.path, error);
        let (start, size) = ((column as isize, row as isize), (width, height));
        let band = dataset.rasterband(1).map_err(in_file)?;
        band.read_into_slice(start, size, size, &mut values, None)
            .map_err(in_file)?;
        let mask: Option<Vec<u8>> = match self.has_mask {
            true => {
                let mask = band.open_mask_band().map_err(in_file)?;
                Some(
                    mask.read_as(start, size, size, None)
                        .map_err(in_file)?
                        .data()
                        .to_vec(),
                )
            }
            false => None,
        };
        for (i, value) in values.iter_mut().enumerate() {
            let is_hidden = mask.as_ref().is_some_and(|mask| mask[i] == 0);
            *value = if is_hidden || self.is_nodata(*value) {
                f64::NAN
            } else {
                *value * self.scale + self.offset
            };
        }
        Ok(values)
    }

    /// Reads all values.
    ///
    /// # Errors
    /// As [`read_window`](Raster::read_window).
    pub fn read_grid(&self) -> Result<Grid> {
        self.read_grid_with(&unwatched)
    }

    /// Like [`read_grid`](Self::read_grid), but watched: cells are counted.
    ///
    /// # Errors
    /// Those of [`read_grid`](Self::read_grid), and that of the watch.
    pub fn read_grid_with(&self, watch: Watch) -> Result<Grid> {
        let Frame { width, height, .. } = self.frame;
        let mut values = self.buffer(width.saturating_mul(height))?;
        let rows = (CELLS_AT_ONCE / width.max(1)).max(1);
        for row in (0..height).step_by(rows) {
            let height = rows.min(height - row);
            values.extend(self.read_window(Window {
                column: 0,
                row,
                width,
                height,
            })?);
            watch((width * height) as u64)?;
        }
        Ok(Grid {
            frame: self.frame,
            crs: self.crs.clone(),
            values,
        })
    }

    fn is_nodata(&self, value: f64) -> bool {
        match self.nodata {
            Some(nodata) if self.is_single => value as f32 == nodata as f32,
            Some(nodata) => value == nodata,
            None => false,
        }
    }

    fn buffer(&self, cells: usize) -> Result<Vec<f64>> {
        let mut buffer = Vec::new();
        buffer.try_reserve_exact(cells).map_err(|_| {
            Error::limit(format!("no memory for {cells} cells"))
                .in_file(&self.path)
                .cure("read a part of the raster")
        })?;
        Ok(buffer)
    }

    fn lock(&self) -> MutexGuard<'_, Dataset> {
        self.dataset.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl BlockSource for Raster {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        let values = self.read_window(window)?;
        out.iter_mut()
            .zip(values)
            .for_each(|(out, value)| *out = value as f32);
        Ok(())
    }
}
