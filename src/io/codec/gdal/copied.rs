//! Writes rasters by a driver of GDAL.

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};

use gdal::raster::RasterCreationOptions;
use gdal::{Dataset, Driver};

use super::drivers::AS_GEOTIFF;
use super::raster::open_raster;
use super::{DriverContent, drivers, messages};
use crate::data::{BlockSource, Window};
use crate::error::{Error, Result};
use crate::io::bytes::appended::appended;
use crate::io::bytes::output::{Destination, OutputDriver};
use crate::io::bytes::watch::Watch;
use crate::io::codec::geotiff::{self, CellFormat, Overviews, RasterSummary, WriteOptions};
use crate::io::codec::xml;

/// Writes a raster by the driver of the destination. Returns a summary of its cells, and warnings.
///
/// The cells are computed once, for a GeoTIFF next to the output, which GDAL then copies: so every
/// driver gets data type, nodata, coordinate system and position as it knows them from its own
/// files, whichever order it writes rows in, and memory stays small.
///
/// # Errors
/// If the driver cannot store such cells, the source fails, or a file cannot be written; that of
/// the watch.
pub(crate) fn write_raster(
    target: Destination,
    driver: &OutputDriver,
    source: &dyn BlockSource,
    cells: CellFormat,
    watch: Watch,
) -> Result<(RasterSummary, Vec<String>)> {
    let write = || {
        let own = drivers::get(&driver.name)?;
        let (content, usual) = match cells {
            CellFormat::Heights => (DriverContent::Heights, "Float32"),
            CellFormat::Shades => (DriverContent::Shades, "Byte"),
            CellFormat::Colors(_) => (DriverContent::Colors, "Byte"),
        };
        let stored = drivers::cell_type(&own, content)?;
        let folder = target.staging_folder()?;
        let cells_file = folder.path().join("cells.tif");
        let options = WriteOptions {
            overviews: Overviews::None,
            watch,
            ..cells.into()
        };
        let summary = geotiff::write(&cells_file, source, options)?;
        let mut warnings = Vec::new();
        let is_rounded = content == DriverContent::Heights && stored.starts_with("Int");
        if is_rounded {
            require_range(stored, &summary, &driver.name)?;
            warnings.push(format!(
                "heights are rounded: the driver {} stores whole numbers",
                driver.name
            ));
        }
        let done = folder.path().join("done");
        std::fs::create_dir(&done)?;
        let path = done.join(target.path().file_name().unwrap_or_default());
        messages::listen();
        let in_file = |error| messages::error(target.path(), error);
        let mut given = Dataset::open(&cells_file).map_err(in_file)?;
        if stored != usual {
            let of_type = as_type(&given, &cells_file, stored)?;
            given = Dataset::open(of_type).map_err(in_file)?;
        }
        let copy = Copy {
            given: &given,
            driver: &own,
            options: &driver.creation,
        };
        copy.write(&path, target.path(), watch)?;
        warnings.extend(messages::warning_texts(&path, target.path()));
        drop(given);
        warnings.extend(losses(&cells_file, &path, target.path())?);
        if content != DriverContent::Colors
            && let Some(difference) = Difference::of(&cells_file, &path, watch)?
        {
            warnings.extend(difference.judged(&summary, is_rounded, &driver.name)?);
        }
        let stale = [".aux.xml", ".ovr", ".msk"].map(|end| appended(target.path(), end));
        target.put_staged(&done, &stale)?;
        Ok((summary, warnings))
    };
    write().map_err(|error: Error| error.in_file(target.path()))
}

/// Returns an error if heights are beyond the whole numbers of a type.
fn require_range(stored: &str, summary: &RasterSummary, driver: &str) -> Result<()> {
    let (low, high) = match stored {
        "Int16" => (f64::from(i16::MIN), f64::from(i16::MAX)),
        _ => (f64::from(i32::MIN), f64::from(i32::MAX)),
    };
    match summary.min < low || summary.max > high {
        true => Err(Error::limit(format!(
            "heights from {} to {}, where the driver {driver} stores whole numbers from {low} \
             to {high}",
            summary.min, summary.max
        ))
        .cure(AS_GEOTIFF)),
        false => Ok(()),
    }
}

/// Returns the path of a virtual raster that has the first band of a file in cells of another type.
fn as_type(given: &Dataset, file: &Path, cell_type: &str) -> Result<PathBuf> {
    let (width, height) = given.raster_size();
    let mut text = format!("<VRTDataset rasterXSize=\"{width}\" rasterYSize=\"{height}\">");
    let system = given.projection();
    if !system.is_empty() {
        text += &format!("<SRS>{}</SRS>", xml::escaped(&system));
    }
    if let Ok(transform) = given.geo_transform() {
        let numbers = transform.map(|number| format!("{number:?}"));
        text += &format!("<GeoTransform>{}</GeoTransform>", numbers.join(", "));
    }
    text += &format!("<VRTRasterBand dataType=\"{cell_type}\" band=\"1\">");
    let nodata = given
        .rasterband(1)
        .ok()
        .and_then(|band| band.no_data_value());
    if let Some(nodata) = nodata {
        text += &format!("<NoDataValue>{nodata}</NoDataValue>");
    }
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    text += &format!(
        "<SimpleSource><SourceFilename relativeToVRT=\"1\">{name}</SourceFilename>\
         <SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>"
    );
    let path = file.with_extension("vrt");
    std::fs::write(&path, text)?;
    Ok(path)
}

/// Returns what a copy has lost beside cells, as far as GDAL reads it: texts for the user.
///
/// # Errors
/// If bands are missing.
fn losses(given: &Path, copy: &Path, target: &Path) -> Result<Vec<String>> {
    messages::listen();
    // Some drivers only write.
    let (Ok(given), Ok(copy)) = (Dataset::open(given), Dataset::open(copy)) else {
        return Ok(Vec::new());
    };
    let driver = copy.driver().short_name();
    let (wanted, found) = (given.raster_count(), copy.raster_count());
    if found < wanted {
        let error = format!("the driver {driver} keeps {found} of {wanted} bands");
        return Err(Error::usage(error).in_file(target).cure(AS_GEOTIFF));
    }
    let mut lost = Vec::new();
    if !given.projection().is_empty() && copy.projection().is_empty() {
        lost.push("its coordinate system");
    }
    if given.geo_transform().is_ok() && copy.geo_transform().is_err() {
        lost.push("its position");
    }
    Ok(match lost.is_empty() {
        true => Vec::new(),
        false => vec![format!(
            "without {}: the driver {driver} keeps none",
            lost.join(" and ")
        )],
    })
}

/// Cells that are compared at a time, roughly.
const COMPARED: usize = 1 << 20;

/// The largest part of the range of heights by which a copy may differ.
const TOLERATED: f64 = 0.01;

/// How the cells of a copy differ.
#[derive(Debug, Default, PartialEq)]
struct Difference {
    largest: f64,
    /// Cells that have a value only in the copy.
    invented: u64,
    /// Cells that have none in the copy.
    lost: u64,
}

impl Difference {
    /// Compares a copy, as GDAL reads it; `None` if it does not, or there are other cells: some
    /// drivers make a pyramid in another coordinate system.
    fn of(given: &Path, copy: &Path, watch: Watch) -> Result<Option<Self>> {
        let (Ok(given), Ok(copy)) = (open_raster(given), open_raster(copy)) else {
            return Ok(None);
        };
        let frame = given.frame();
        let of_copy = copy.frame();
        if [frame.width, frame.height] != [of_copy.width, of_copy.height] {
            return Ok(None);
        }
        let mut found = Difference::default();
        let rows = (COMPARED / frame.width.max(1)).max(1);
        for row in (0..frame.height).step_by(rows) {
            watch(0)?;
            let window = Window {
                row,
                height: rows.min(frame.height - row),
                ..frame.window()
            };
            let cells = given.read_window(window)?.into_iter();
            cells
                .zip(copy.read_window(window)?)
                .for_each(|(given, copy)| found.add(given, copy));
        }
        Ok(Some(found))
    }

    fn add(&mut self, given: f64, copy: f64) {
        match (given.is_nan(), copy.is_nan()) {
            (true, false) => self.invented += 1,
            (false, true) => self.lost += 1,
            (false, false) => self.largest = self.largest.max((given - copy).abs()),
            (true, true) => {}
        }
    }

    /// Returns texts for the user.
    ///
    /// # Errors
    /// If values differ by more than rounding can explain.
    fn judged(
        &self,
        summary: &RasterSummary,
        is_rounded: bool,
        driver: &str,
    ) -> Result<Vec<String>> {
        let rounding = if is_rounded { 0.5 } else { 0.0 };
        let range = summary.max - summary.min;
        if self.largest > rounding + TOLERATED * range {
            let error = format!(
                "the driver {driver} changes values by up to {}, where all are within {range}",
                self.largest
            );
            return Err(Error::usage(error).cure(AS_GEOTIFF));
        }
        let mut texts = Vec::new();
        if self.largest > rounding {
            texts.push(format!(
                "values differ by up to {}, as the driver {driver} stores them",
                self.largest
            ));
        }
        if self.invented > 0 {
            texts.push(format!(
                "cells without a value ({}) have one: the driver {driver} has no mark for them",
                self.invented
            ));
        }
        if self.lost > 0 {
            texts.push(format!(
                "cells with a value ({}) have none, as the driver {driver} stores them",
                self.lost
            ));
        }
        Ok(texts)
    }
}

/// What a copy calls while it goes on.
struct Progress<'a> {
    watch: Watch<'a>,
    /// What ended it.
    error: Option<Error>,
}

/// Calls the watch of a copy; GDAL ends the copy if 0 is returned.
extern "C" fn proceed(_share: f64, _message: *const c_char, progress: *mut c_void) -> c_int {
    #[allow(unsafe_code)]
    // SAFETY: it is the `Progress` that `Copy::write` has passed, which nothing else uses until
    // GDAL returns.
    let progress = unsafe { &mut *progress.cast::<Progress>() };
    match (progress.watch)(0) {
        Ok(()) => 1,
        Err(error) => {
            progress.error = Some(error);
            0
        }
    }
}

/// A copy of a raster by a driver.
struct Copy<'a> {
    given: &'a Dataset,
    driver: &'a Driver,
    options: &'a [String],
}

impl Copy<'_> {
    /// Writes the copy to a path; messages name `target`. What a driver that copies itself cannot
    /// keep is an error.
    #[allow(unsafe_code)]
    fn write(&self, path: &Path, target: &Path, watch: Watch) -> Result<()> {
        // For others, GDAL would refuse what is not lost, such as that a band is gray.
        let is_strict = drivers::copies_itself(self.driver);
        let options = RasterCreationOptions::from_iter(self.options.iter().map(String::as_str));
        let name = CString::new(path.as_os_str().as_encoded_bytes())
            .map_err(|_| Error::usage("the name contains a zero"))?;
        let mut progress = Progress { watch, error: None };
        // `Dataset::create_copy` of the crate `gdal` is neither strict nor can it be canceled.
        // SAFETY: all pointers are those of live values, which GDAL uses until it returns.
        let copy = unsafe {
            gdal_sys::GDALCreateCopy(
                self.driver.c_driver(),
                name.as_ptr(),
                self.given.c_dataset(),
                c_int::from(is_strict),
                options.as_ptr(),
                Some(proceed),
                (&raw mut progress).cast(),
            )
        };
        if !copy.is_null() {
            // SAFETY: the data set is ours, and not used again; closing it writes what is left.
            unsafe { gdal_sys::GDALClose(copy) };
        }
        if let Some(error) = progress.error {
            return Err(error);
        }
        // What was wrong may only be found when it is closed.
        match messages::refusal(path, target) {
            Some(error) => Err(error),
            None if copy.is_null() => Err(Error::unsupported(format!(
                "the driver {} wrote nothing, and does not say why",
                self.driver.short_name()
            ))),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_copy_changes_is_said_or_refused() {
        let summary = RasterSummary {
            min: 100.0,
            max: 200.0,
            valid: 9,
        };
        let judged = |pairs: &[(f64, f64)], is_rounded| {
            let mut difference = Difference::default();
            pairs
                .iter()
                .for_each(|&(given, copy)| difference.add(given, copy));
            difference.judged(&summary, is_rounded, "X")
        };
        let none = f64::NAN;
        assert!(
            judged(&[(150.0, 150.0), (none, none)], false)
                .unwrap()
                .is_empty()
        );
        assert!(judged(&[(150.25, 150.0)], true).unwrap().is_empty());
        let texts = judged(&[(150.0, 150.75), (none, 0.0), (101.0, none)], false).unwrap();
        let starts = [
            "values differ by up to 0.75",
            "cells without a value (1)",
            "cells with a value (1)",
        ];
        assert_eq!(texts.len(), 3);
        assert!(
            texts
                .iter()
                .zip(starts)
                .all(|(text, start)| text.starts_with(start)),
            "{texts:?}"
        );
        for (given, is_rounded) in [(151.25, false), (151.75, true)] {
            let error = judged(&[(given, 150.0)], is_rounded).unwrap_err();
            assert!(
                error.to_string().contains("changes values by up to 1."),
                "{error}"
            );
        }
    }
}
