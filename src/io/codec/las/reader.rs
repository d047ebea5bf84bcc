use std::io::Read;
use std::path::{Path, PathBuf};

use super::header::Header;
use super::input::Input;
use super::laz::Laz;
use super::plain::Plain;
use super::raw::MAX_HEADER;
use super::records::Payloads;
use super::{head, records, reference};
use crate::data::{Bounds, Lattice, PartRead, PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result, Wording};
use crate::io::options::las::{Detail, ReadOptions};

/// A reader for the points of a LAS or LAZ file, made by [`open`](super::open).
#[derive(Debug)]
pub struct LasReader {
    name: PathBuf,
    header: Header,
    info: PointInfo,
    points: Points,
    warnings: Vec<Wording>,
}

/// The points of a file that are left to read.
#[derive(Debug)]
pub(super) enum Points {
    Plain(Plain),
    Compressed(Box<Laz>),
    /// The last point was read, or an error occurred.
    Done,
}

impl Points {
    /// Starts to read the points of a file.
    ///
    /// # Errors
    /// If points are missing, and that is not accepted, or they cannot be decompressed.
    pub(super) fn open(
        input: Input,
        header: &Header,
        payloads: Payloads,
        options: ReadOptions,
        warnings: &mut Vec<Wording>,
    ) -> Result<Self> {
        if header.is_compressed {
            let laz = Laz::new(input, header, payloads, options, warnings)?;
            return Ok(Points::Compressed(Box::new(laz)));
        }
        Plain::new(input, header, options, warnings).map(Points::Plain)
    }

    /// Reads the next points; none at the end.
    ///
    /// # Errors
    /// If they are damaged. No more are read then.
    pub(super) fn read(
        &mut self,
        batch: &mut PointBatch,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        batch.clear();
        let result = match self {
            Points::Plain(plain) => plain.read(batch, warnings),
            Points::Compressed(laz) => laz.read(batch, warnings),
            Points::Done => Ok(()),
        };
        if result.is_err() || batch.is_empty() {
            *self = Points::Done;
        }
        result
    }
}

impl LasReader {
    pub(super) fn new(input: Input, options: ReadOptions) -> Result<Self> {
        let name = input.name.clone();
        Self::start(input, options).map_err(|error| error.in_file(name))
    }

    fn start(mut input: Input, options: ReadOptions) -> Result<Self> {
        let name = input.name.clone();
        let mut warnings = Vec::new();
        let bytes = input.bytes(0, MAX_HEADER)?;
        let mut header = Header::check(&bytes, input.length, &mut warnings)?;
        let payloads = records::read(&input, &mut header, &mut warnings)?;
        let (crs, unread_crs) = reference::choose(&payloads, header.says_wkt, &mut warnings);
        let head = match options.detail {
            Detail::Columns => None,
            Detail::Records => Some(head::read(&mut input, &header)?),
        };
        let points = Points::open(input, &header, payloads, options, &mut warnings)?;
        let info = PointInfo {
            columns: None,
            format: header.format(),
            count: Some(header.count),
            bounds: header.bounds,
            crs,
            unread_crs,
            has_classes: true,
            lattice: Some(Lattice {
                scale: header.scale,
                offset: header.offset,
            }),
            head,
            warnings,
        };
        Ok(LasReader {
            name,
            header,
            info,
            points,
            warnings: Vec::new(),
        })
    }

    /// Returns the header of the file.
    pub fn header(&self) -> &Header {
        &self.header
    }
}

impl PointSource for LasReader {
    fn info(&self) -> &PointInfo {
        &self.info
    }

    fn read(&mut self, batch: &mut PointBatch) -> Result<()> {
        let read = self.points.read(batch, &mut self.warnings);
        read.map_err(|error| error.in_file(&self.name))
    }

    fn thin(&mut self, spacing: u64) -> bool {
        match &mut self.points {
            Points::Plain(plain) => plain.thin(spacing),
            Points::Compressed(laz) => laz.thin(spacing),
            Points::Done => true,
        }
    }

    fn narrow(&mut self, window: &Bounds) -> Result<Option<PartRead>> {
        let narrowed = match &mut self.points {
            Points::Compressed(laz) => laz.narrow(window, &mut self.warnings),
            Points::Plain(_) | Points::Done => Ok(None),
        };
        narrowed.map_err(|error| error.in_file(&self.name))
    }

    fn coarsen(&mut self, spacing: f64) -> Result<Option<PartRead>> {
        let coarsened = match &mut self.points {
            Points::Compressed(laz) => laz.coarsen(spacing, &mut self.warnings),
            Points::Plain(_) | Points::Done => Ok(None),
        };
        let part = coarsened.map_err(|error| error.in_file(&self.name))?;
        if let Some(part) = part {
            self.info.count = Some(part.points);
        }
        Ok(part)
    }

    fn warnings(&self) -> &[Wording] {
        &self.warnings
    }
}

/// Opens a LAS or LAZ file of any size; `-` is the standard input.
///
/// Compressed points are decoded by all threads of the current `rayon` pool. Input without random
/// access (a pipe, the standard input) is first copied to a temporary file.
///
/// # Errors
/// If the file cannot be read, was cut short, or its header is damaged in a way that the
/// [module](super) lists as an error.
pub fn open(path: impl AsRef<Path>) -> Result<LasReader> {
    open_with(path, ReadOptions::default())
}

/// Like [`open`], but with options; an [`OnDamage`](crate::io::OnDamage) can be passed in their
/// stead.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: impl AsRef<Path>, options: impl Into<ReadOptions>) -> Result<LasReader> {
    LasReader::new(Input::open(path.as_ref())?, options.into())
}

/// Returns what the header of a LAS or LAZ file states, also if its points are damaged or missing;
/// without the coordinate system, if the records before the points are damaged, too.
///
/// # Errors
/// If the file cannot be read, or its header is damaged.
pub fn stated(path: impl AsRef<Path>) -> Result<PointInfo> {
    let path = path.as_ref();
    let read = || {
        let mut input = Input::open(path)?;
        let mut warnings = Vec::new();
        let bytes = input.bytes(0, MAX_HEADER)?;
        let mut header = Header::check(&bytes, input.length, &mut warnings)?;
        let payloads = records::read(&input, &mut header, &mut warnings).ok();
        let system =
            payloads.map(|payloads| reference::choose(&payloads, header.says_wkt, &mut warnings));
        let (crs, unread_crs) = system.unwrap_or_default();
        Ok(PointInfo {
            format: header.format(),
            count: Some(header.count),
            bounds: header.bounds,
            crs,
            unread_crs,
            has_classes: true,
            warnings,
            ..PointInfo::default()
        })
    };
    read().map_err(|error: Error| error.in_file(path))
}

/// Reads a stream by copying it to a temporary file; messages call it `name`.
///
/// # Errors
/// As [`open`].
pub fn from_stream(stream: impl Read, name: impl AsRef<Path>) -> Result<LasReader> {
    from_stream_with(stream, name, ReadOptions::default())
}

/// Like [`from_stream`], but with options; an [`OnDamage`](crate::io::OnDamage) can be passed in
/// their stead.
///
/// # Errors
/// As [`open`].
pub fn from_stream_with(
    stream: impl Read,
    name: impl AsRef<Path>,
    options: impl Into<ReadOptions>,
) -> Result<LasReader> {
    LasReader::new(Input::spool(stream, name.as_ref())?, options.into())
}
