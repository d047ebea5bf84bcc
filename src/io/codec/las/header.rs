//! The header of a LAS file, with checked values.

use super::raw::{MAX_HEADER, MIN_HEADER, RawHeader};
use crate::data::Bounds;
use crate::error::{Error, Result, Wording};

/// Bytes of a record of point formats 0 to 10, without extra bytes.
pub(super) const RECORD_LENGTHS: [u16; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];

/// The bits of the point format byte that LASzip uses.
const COMPRESSED: u8 = 0x80;
const COMPRESSED_OLD: u8 = 0x40;

const DAMAGED: &str =
    "the header was never finished, or it is damaged: get the file again from its producer";

/// The bit of the global encoding for a coordinate system in WKT.
const WKT_BIT: u16 = 1 << 4;

/// The header of a LAS file.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Header {
    /// Major and minor version, (1, 0) to (1, 5).
    pub version: (u8, u8),
    /// Point format, 0 to 10.
    pub point_format: u8,
    /// True if the points are compressed by LASzip.
    pub is_compressed: bool,
    /// Bytes of an uncompressed point record.
    pub record_length: u16,
    /// Number of points, as stated.
    pub count: u64,
    /// Number of points by return number, as stated, from the first return on.
    pub returns: Vec<u64>,
    /// Step of the coordinate lattice, per axis.
    pub scale: [f64; 3],
    /// Origin of the coordinate lattice.
    pub offset: [f64; 3],
    /// Extent, as stated; `None` if it is not a box.
    pub bounds: Option<Bounds>,
    /// System identifier: the instrument, or the operation that created the file.
    pub system: String,
    /// Generating software.
    pub software: String,
    /// Year and day of the year when the file was created, if stated.
    pub created: Option<(u16, u16)>,
    /// True if the header says that the coordinate system is in WKT.
    pub says_wkt: bool,
    /// Records between the header and the points, then those after the points.
    pub records: Vec<RecordInfo>,

    pub(super) layout: FileLayout,
}

/// A variable length record, without its payload.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct RecordInfo {
    /// The organization that defines the record: "LASF_Projection", "copc".
    pub user_id: String,
    /// The number of the record, as assigned by that organization.
    pub record_id: u16,
    /// Length of the payload in bytes.
    pub length: u64,
    /// Description, as written in the file.
    pub description: String,
}

/// Positions within the file, in bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct FileLayout {
    pub(super) vlr_start: u64,
    pub(super) vlr_count: u64,
    pub(super) points_start: u64,
    /// The first byte after the points that belongs to something else, or the end of the file.
    pub(super) points_end: u64,
    pub(super) evlr_start: u64,
    pub(super) evlr_count: u64,
}

impl Header {
    /// Checks the first bytes of a file of `file_length` bytes and returns the header. Oddities
    /// that do not prevent reading are added to `warnings`.
    pub(super) fn check(
        bytes: &[u8],
        file_length: u64,
        warnings: &mut Vec<Wording>,
    ) -> Result<Self> {
        check_signature(bytes)?;
        if bytes.len() < MIN_HEADER {
            return Err(Error::format(format!(
                "the file ends after {} bytes, within its header of at least {MIN_HEADER}",
                bytes.len()
            ))
            .at(format!("byte {}", bytes.len()))
            .cure("the file was cut: copy or download it again"));
        }
        let raw = RawHeader::parse(bytes);
        check_version(&raw, bytes.len())?;
        let point_format = check_format(&raw)?;
        check_lattice(&raw)?;

        let layout = lay_out(&raw, file_length)?;
        let count = count_points(&raw, warnings);
        let extended = raw.version.1 >= 4;
        let mut returns: Vec<u64> = match extended && raw.returns.iter().any(|&n| n > 0) {
            true => raw.returns.to_vec(),
            false => raw.legacy_returns.iter().map(|&n| n.into()).collect(),
        };
        while returns.last() == Some(&0) {
            returns.pop();
        }
        Ok(Header {
            version: raw.version,
            point_format,
            is_compressed: raw.format & COMPRESSED != 0,
            record_length: raw.record_length,
            count,
            returns,
            scale: raw.scale,
            offset: raw.offset,
            bounds: check_bounds(&raw, count, warnings),
            created: (raw.year != 0).then_some((raw.year, raw.day)),
            says_wkt: raw.global_encoding & WKT_BIT != 0,
            system: raw.system,
            software: raw.software,
            records: Vec::new(),
            layout,
        })
    }

    /// Returns true if the file is a cloud optimized point cloud.
    pub fn is_copc(&self) -> bool {
        self.records
            .iter()
            .any(|record| record.user_id == "copc" && record.record_id == 1)
    }

    /// Returns a description such as "LAS 1.4, point format 6, LAZ".
    pub(super) fn format(&self) -> String {
        let packing = match (self.is_compressed, self.is_copc()) {
            (false, _) => "",
            (true, false) => ", LAZ",
            (true, true) => ", COPC",
        };
        let (major, minor) = self.version;
        format!(
            "LAS {major}.{minor}, point format {}{packing}",
            self.point_format
        )
    }
}

fn check_signature(bytes: &[u8]) -> Result<()> {
    if bytes.is_empty() {
        return Err(Error::format("the file is empty")
            .at("byte 0")
            .cure("copy or download it again"));
    }
    let found = &bytes[..bytes.len().min(4)];
    if found != b"LASF" {
        return Err(Error::format(format!(
            "not a LAS file: it begins with \"{}\", expected \"LASF\"",
            found.escape_ascii()
        ))
        .at("byte 0")
        .cure("if its name is wrong, rename it; else get it again from its producer"));
    }
    Ok(())
}

fn check_version(raw: &RawHeader, available: usize) -> Result<()> {
    let (major, minor) = raw.version;
    if major != 1 || minor > 5 {
        return Err(Error::unsupported(format!(
            "LAS version {major}.{minor}; supported are 1.0 to 1.5"
        ))
        .at("byte 24")
        .cure("save it as LAS 1.4"));
    }
    let least = if minor >= 4 { MAX_HEADER } else { MIN_HEADER };
    if usize::from(raw.header_size) < least || available < least {
        let found = available.min(raw.header_size.into());
        return Err(Error::format(format!(
            "the header has {found} bytes, a LAS {major}.{minor} header has at least {least}"
        ))
        .at("byte 94")
        .cure(DAMAGED));
    }
    Ok(())
}

fn check_format(raw: &RawHeader) -> Result<u8> {
    if raw.format & COMPRESSED_OLD != 0 {
        return Err(Error::unsupported(format!(
            "point format byte {:#04x}: compressed by a pre-release LASzip",
            raw.format
        ))
        .at("byte 104")
        .cure("decompress it with the program that made it"));
    }
    let format = raw.format & !COMPRESSED;
    let Some(&least) = RECORD_LENGTHS.get(usize::from(format)) else {
        return Err(
            Error::unsupported(format!("point format {format}; supported are 0 to 10"))
                .at("byte 104")
                .cure("save it with one of them"),
        );
    };
    if raw.record_length < least {
        return Err(Error::format(format!(
            "point records of {} bytes; point format {format} has at least {least}",
            raw.record_length
        ))
        .at("byte 105")
        .cure(DAMAGED));
    }
    Ok(format)
}

fn check_lattice(raw: &RawHeader) -> Result<()> {
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (scale, offset) = (raw.scale[axis], raw.offset[axis]);
        if !scale.is_finite() || scale == 0.0 {
            return Err(Error::format(format!(
                "{name} scale is {scale}, expected a finite number other than 0"
            ))
            .at(format!("byte {}", 131 + 8 * axis))
            .cure(DAMAGED));
        }
        if !offset.is_finite() {
            return Err(Error::format(format!(
                "{name} offset is {offset}, expected a finite number"
            ))
            .at(format!("byte {}", 155 + 8 * axis))
            .cure(DAMAGED));
        }
        let farthest = scale.abs() * f64::from(1_u32 << 31) + offset.abs();
        if !farthest.is_finite() {
            return Err(Error::format(format!(
                "{name} scale {scale} and offset {offset} lead to infinite coordinates"
            ))
            .at(format!("byte {}", 131 + 8 * axis))
            .cure(DAMAGED));
        }
    }
    Ok(())
}

fn lay_out(raw: &RawHeader, file_length: u64) -> Result<FileLayout> {
    let vlr_start = u64::from(raw.header_size);
    let points_start = u64::from(raw.points_start);
    if points_start < vlr_start {
        return Err(Error::format(format!(
            "the points are said to begin at byte {points_start}, within the header of {vlr_start} bytes"
        ))
        .at("byte 96")
        .cure(DAMAGED));
    }
    if points_start > file_length {
        return Err(Error::format(format!(
            "the points are said to begin at byte {points_start}, but the file has {file_length} bytes"
        ))
        .at("byte 96")
        .cure("the file was cut or its header is damaged: copy or download it again"));
    }
    let (evlr_start, evlr_count) = match raw.version.1 {
        4.. => (raw.evlr_start, u64::from(raw.evlr_count)),
        _ => (0, 0),
    };
    let waveform_start = if raw.version.1 >= 3 {
        raw.waveform_start
    } else {
        0
    };
    let points_end = [(evlr_count > 0).then_some(evlr_start), Some(waveform_start)]
        .into_iter()
        .flatten()
        .filter(|&end| end > points_start)
        .fold(file_length, u64::min);
    Ok(FileLayout {
        vlr_start,
        vlr_count: raw.vlr_count.into(),
        points_start,
        points_end,
        evlr_start,
        evlr_count,
    })
}

/// Returns the number of points. LAS 1.4 has two counts: one of 64 bits, and one of 32 bits for old
/// readers, which may be zero.
fn count_points(raw: &RawHeader, warnings: &mut Vec<Wording>) -> u64 {
    let legacy = u64::from(raw.legacy_count);
    if raw.version.1 < 4 || (raw.count == 0 && legacy > 0) {
        return legacy;
    }
    if legacy > 0 && legacy != raw.count {
        warnings.push(
            format!(
                "the header states {} points, and {legacy} for old readers; the first is taken",
                raw.count
            )
            .into(),
        );
    }
    raw.count
}

fn check_bounds(raw: &RawHeader, count: u64, warnings: &mut Vec<Wording>) -> Option<Bounds> {
    let bounds = Bounds {
        min: raw.min,
        max: raw.max,
    };
    let is_box = (0..3).all(|axis| {
        raw.min[axis].is_finite() && raw.max[axis].is_finite() && raw.min[axis] <= raw.max[axis]
    });
    if !is_box && count > 0 {
        warnings.push(
            "the extent in the header is not a box (a minimum exceeds its maximum) and is ignored"
                .into(),
        );
    }
    is_box.then_some(bounds)
}
