//! A surface in parts: opened where it is, and asked as one.

mod contours;
mod heights;
mod join;
mod joined;
mod seams;
mod unjoined;
mod written;

pub(crate) use contours::contours;
pub(crate) use heights::elevations;
use joined::JoinedTin;
pub use written::WrittenParts;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::crs::Crs;
use crate::data::{Bounds, Frame, SurfaceFacts};
use crate::error::{Command, Error, Result, wording};
use crate::io::Temporary;
use crate::io::mapped::{self, Mapped};
use crate::terrain::{CompactTin, DemOfParts, TinIndex};

/// A surface in parts, each of which is a TIN in a file. [`TinIndex`] says which.
///
/// Rasters with linear heights, contours, heights at positions and along lines, and volumes are
/// computed where the parts are, and so need not have the surface in memory. For all else the parts
/// are joined.
pub struct TinParts {
    path: PathBuf,
    folder: PathBuf,
    index: TinIndex,
    joined: OnceLock<JoinedTin>,
    /// A folder with all of these files that is removed with this, if nobody else needs them.
    owned: Option<Temporary>,
    /// Opens a part, for rasters that outlive the call that asks for them.
    open: Box<dyn Fn(usize) -> Result<CompactTin<Mapped>> + Send + Sync>,
}

/// Returns the folder of the parts of a surface; `None` unless a file is the index of one.
pub(crate) fn parts_folder(path: &Path) -> Option<PathBuf> {
    // By its name first: other inputs may be many, and far away.
    let format =
        crate::io::formats::of_name(path).filter(|format| format.extensions.contains(&"tins"));
    let text = format
        .and_then(|_| crate::io::mesh::read_tin_index(path))?
        .ok()?;
    TinIndex::from_text(&text)
        .ok()
        .map(|index| path.with_file_name(index.folder))
}

impl TinParts {
    /// Opens a surface by the text of its index.
    ///
    /// # Errors
    /// If the index is damaged, or a part is missing or has another length.
    pub(crate) fn open(path: &Path, text: &[u8]) -> Result<Self> {
        let index = TinIndex::from_text(text).map_err(|e| {
            e.in_file(path)
                .cure(wording!["write the surface again with ", Command::Tin])
        })?;
        let wrong = |what: &str| {
            Error::format(format!("{what} of the parts are not those of the surface"))
                .in_file(path)
                .cure(wording!["write the surface again with ", Command::Tin])
        };
        if index
            .parts
            .iter()
            .fold(0_u64, |sum, part| sum.saturating_add(part.triangles))
            != index.facts.triangles as u64
        {
            return Err(wrong("the counts"));
        }
        let mut extent = Bounds::default();
        index
            .parts
            .iter()
            .for_each(|part| extent.merge(&part.extent));
        if extent != index.facts.extent {
            return Err(wrong("the extents"));
        }
        let folder = path.with_file_name(&index.folder);
        for part in &index.parts {
            let file = folder.join(&part.file);
            let length = std::fs::metadata(&file)
                .map_err(|e| missing(e, path, &file))?
                .len();
            if length != part.bytes {
                return Err(Error::format(format!(
                    "{length} bytes, but the index states {}",
                    part.bytes
                ))
                .in_file(file)
                .cure("copy the index together with its folder, or write the surface again"));
            }
        }
        let files: Vec<PathBuf> = index
            .parts
            .iter()
            .map(|part| folder.join(&part.file))
            .collect();
        let open = Box::new(move |part: usize| open_file(&files[part]));
        Ok(TinParts {
            path: path.to_path_buf(),
            folder,
            index,
            joined: OnceLock::new(),
            owned: None,
            open,
        })
    }

    /// Returns what is true of the whole.
    pub fn index(&self) -> &TinIndex {
        &self.index
    }

    /// Returns the folder of the parts.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the coordinate system, if it is known.
    pub fn crs(&self) -> Option<&Crs> {
        self.index.crs.as_ref()
    }

    /// Returns the counts and the extent that the index states.
    pub fn facts(&self) -> &SurfaceFacts {
        &self.index.facts
    }

    /// Takes the folder that contains all files of the surface.
    pub(crate) fn own(&mut self, folder: Temporary) {
        self.owned = Some(folder);
    }

    pub(crate) fn set_crs(&mut self, crs: Option<Crs>) {
        self.index.crs = crs;
    }

    /// Opens a part, by its position in the index.
    ///
    /// # Errors
    /// If it is damaged, or not a part of a surface.
    ///
    /// # Complexity
    /// Constant: the file is mapped to memory.
    pub fn part(&self, number: usize) -> Result<CompactTin<Mapped>> {
        (self.open)(number)
    }

    /// Returns a raster of linear heights, and of the gradients of faces.
    ///
    /// # Errors
    /// Those of [`DemOfParts::new`].
    pub(crate) fn dem(&self, frame: Frame) -> Result<DemOfParts<'_, CompactTin<Mapped>>> {
        let extents: Vec<Bounds> = self.index.parts.iter().map(|part| part.extent).collect();
        DemOfParts::new(frame, self.index.crs.clone(), &extents, &*self.open)
    }
}

impl std::fmt::Debug for TinParts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TinParts")
            .field("path", &self.path)
            .field("index", &self.index)
            .finish_non_exhaustive()
    }
}

fn open_file(file: &Path) -> Result<CompactTin<Mapped>> {
    let tin = CompactTin::open(mapped::open(file)?, file)?;
    if tin.is_part() {
        Ok(tin)
    } else {
        Err(Error::format("the TIN is not part of a larger one").in_file(file))
    }
}

#[cold]
fn missing(error: std::io::Error, index: &Path, part: &Path) -> Error {
    Error::from(error)
        .in_file(part)
        .cure(format!("{} needs its folder next to it", index.display()))
}
