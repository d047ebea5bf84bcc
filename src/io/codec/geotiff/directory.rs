//! Writes the header of a TIFF or BigTIFF file, little-endian: the directories of all its images.

use super::tags;
use crate::crs::GeoKeys;
use crate::data::Frame;

/// Width of the offsets in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Offsets {
    /// Classic TIFF: up to 4 GiB.
    Bits32,
    /// BigTIFF.
    Bits64,
}

impl Offsets {
    /// Returns the bytes of an offset.
    fn width(self) -> usize {
        match self {
            Offsets::Bits32 => 4,
            Offsets::Bits64 => 8,
        }
    }

    /// Appends a number as wide as an offset.
    fn put(self, out: &mut Vec<u8>, value: usize) {
        out.extend_from_slice(&(value as u64).to_le_bytes()[..self.width()]);
    }
}

/// The values of one tag.
#[derive(Debug, Clone)]
pub(super) enum Values {
    Short(Vec<u16>),
    Long(Vec<u32>),
    /// LONG8 in a BigTIFF, LONG in a classic file.
    Offset(Vec<u64>),
    Double(Vec<f64>),
    Text(String),
}

impl Values {
    fn kind_and_count(&self, offsets: Offsets) -> (u16, usize) {
        match self {
            Values::Text(text) => (2, text.len() + 1),
            Values::Short(values) => (3, values.len()),
            Values::Long(values) => (4, values.len()),
            Values::Offset(values) if offsets == Offsets::Bits32 => (4, values.len()),
            Values::Offset(values) => (16, values.len()),
            Values::Double(values) => (12, values.len()),
        }
    }

    fn bytes(&self, offsets: Offsets) -> Vec<u8> {
        match self {
            Values::Text(text) => text.bytes().chain([0]).collect(),
            Values::Short(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Values::Long(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Values::Offset(values) if offsets == Offsets::Bits32 => values
                .iter()
                .flat_map(|&v| (v as u32).to_le_bytes())
                .collect(),
            Values::Offset(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Values::Double(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        }
    }
}

/// What GDAL writes behind the header of a cloud-optimized GeoTIFF: readers need not look for
/// directories elsewhere, and can read a tile with its length at once. The number is that of the
/// bytes after its line.
const LAYOUT: &[u8] = b"GDAL_STRUCTURAL_METADATA_SIZE=000140 bytes\n\
    LAYOUT=IFDS_BEFORE_DATA\nBLOCK_ORDER=ROW_MAJOR\nBLOCK_LEADER=SIZE_AS_UINT4\n\
    BLOCK_TRAILER=LAST_4_BYTES_REPEATED\nKNOWN_INCOMPATIBLE_EDITION=NO\n ";

/// Returns the header, and the directories of all images with their values, the largest image
/// first. The length depends only on the number of values, so the header can be rewritten once they
/// are known.
pub(super) fn header(offsets: Offsets, images: &[Vec<(u16, Values)>]) -> Vec<u8> {
    let mut out = Vec::new();
    out.extend_from_slice(b"II");
    match offsets {
        Offsets::Bits32 => out.extend_from_slice(&42u16.to_le_bytes()),
        Offsets::Bits64 => [43u16, 8, 0]
            .iter()
            .for_each(|field| out.extend_from_slice(&field.to_le_bytes())),
    }
    let first = (out.len() + offsets.width() + LAYOUT.len()).next_multiple_of(8);
    offsets.put(&mut out, first);
    out.extend_from_slice(LAYOUT);
    for (i, tags) in images.iter().enumerate() {
        out.resize(out.len().next_multiple_of(8), 0);
        let at = out.len();
        let is_last = i + 1 == images.len();
        out.extend_from_slice(&directory(offsets, tags, at, is_last));
    }
    out
}

/// Returns a directory that begins at byte `at`, and its values. The next one follows, unless it is
/// the last.
fn directory(offsets: Offsets, tags: &[(u16, Values)], at: usize, is_last: bool) -> Vec<u8> {
    debug_assert!(tags.is_sorted_by_key(|(tag, _)| *tag));
    let width = offsets.width();
    let (count_size, entry_size) = match offsets {
        Offsets::Bits32 => (2, 12),
        Offsets::Bits64 => (8, 20),
    };
    let mut out = (tags.len() as u64).to_le_bytes()[..count_size].to_vec();
    let end = at + count_size + tags.len() * entry_size + width;
    let mut values_at = end.next_multiple_of(8);
    let mut behind = vec![0; values_at - end];
    for (tag, values) in tags {
        let (kind, count) = values.kind_and_count(offsets);
        out.extend_from_slice(&tag.to_le_bytes());
        out.extend_from_slice(&kind.to_le_bytes());
        offsets.put(&mut out, count);
        let mut bytes = values.bytes(offsets);
        if bytes.len() <= width {
            bytes.resize(width, 0);
            out.extend_from_slice(&bytes);
        } else {
            offsets.put(&mut out, values_at);
            bytes.resize(bytes.len().next_multiple_of(8), 0);
            values_at += bytes.len();
            behind.extend_from_slice(&bytes);
        }
    }
    offsets.put(&mut out, if is_last { 0 } else { values_at });
    out.extend_from_slice(&behind);
    out
}

/// Returns the tags that locate a raster: a pixel scale and a tiepoint if they suffice (north up),
/// else the full transformation.
pub(super) fn placement(frame: &Frame) -> Vec<(u16, Values)> {
    let t = frame.transform;
    if frame.is_north_up() {
        return vec![
            (
                tags::MODEL_PIXEL_SCALE,
                Values::Double(vec![t[1], -t[5], 0.0]),
            ),
            (
                tags::MODEL_TIEPOINT,
                Values::Double(vec![0.0, 0.0, 0.0, t[0], t[3], 0.0]),
            ),
        ];
    }
    let rows = [
        [t[1], t[2], 0.0, t[0]],
        [t[4], t[5], 0.0, t[3]],
        [0.0; 4],
        [0.0, 0.0, 0.0, 1.0],
    ];
    vec![(tags::MODEL_TRANSFORMATION, Values::Double(rows.concat()))]
}

/// Returns the tags of a coordinate system.
pub(super) fn geo_keys(keys: GeoKeys) -> Vec<(u16, Values)> {
    let mut out = Vec::new();
    if !keys.directory.is_empty() {
        out.push((tags::GEO_KEY_DIRECTORY, Values::Short(keys.directory)));
        if !keys.doubles.is_empty() {
            out.push((tags::GEO_DOUBLE_PARAMS, Values::Double(keys.doubles)));
        }
        if !keys.ascii.is_empty() {
            out.push((tags::GEO_ASCII_PARAMS, Values::Text(keys.ascii)));
        }
    }
    out
}
