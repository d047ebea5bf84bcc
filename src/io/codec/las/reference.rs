//! Reads the coordinate system of a LAS file, from WKT or GeoTIFF keys.

use super::raw::until_zero;
use super::record::words;
use super::records::Payloads;
use crate::crs::{Crs, GeoKeys};
use crate::error::Wording;
use crate::io::bytes::little_endian::f64_at;

/// The coordinate system that a record states, or what it states if that is not understood.
type Stated = std::result::Result<Crs, String>;

/// Returns the coordinate system that the file states, and what it states if nothing of it is
/// understood.
///
/// If a file has both kinds of records, the WKT bit of the header decides (LAS 1.4, global
/// encoding); if they disagree, there is a warning. A coordinate system that cannot be understood
/// is skipped with a warning, because the points can be used without it.
pub(super) fn choose(
    payloads: &Payloads,
    says_wkt: bool,
    warnings: &mut Vec<Wording>,
) -> (Option<Crs>, Option<String>) {
    let wkt = payloads
        .wkt
        .as_deref()
        .and_then(|bytes| from_wkt(bytes, warnings));
    let keys = payloads
        .geo_directory
        .as_deref()
        .and_then(|directory| from_keys(directory, payloads, warnings));
    let (wkt, keys) = match (wkt, keys) {
        (Some(Ok(wkt)), Some(Ok(keys))) => (wkt, keys),
        (Some(Ok(crs)), _) | (_, Some(Ok(crs))) => return (Some(crs), None),
        (wkt, keys) => return (None, wkt.or(keys).and_then(Stated::err)),
    };
    let (wkt, keys) = (&wkt, &keys);
    let (taken, other, reason) = match says_wkt {
        true => (
            (wkt, "WKT"),
            (keys, "GeoTIFF keys"),
            "the header's WKT bit is set",
        ),
        false => (
            (keys, "GeoTIFF keys"),
            (wkt, "WKT"),
            "the header's WKT bit is not set",
        ),
    };
    if !wkt.is_same(keys) {
        warnings.push(
            format!(
                "two coordinate systems: {} by its {}, {} by its {}; the first is taken, because {reason}",
                taken.0, taken.1, other.0, other.1
            )
            .into(),
        );
    }
    (Some(taken.0.clone()), None)
}

fn from_wkt(bytes: &[u8], warnings: &mut Vec<Wording>) -> Option<Stated> {
    let text = until_zero(bytes);
    let text = text.trim();
    if text.is_empty() {
        warnings.push("the record for a coordinate system in WKT is empty".into());
        return None;
    }
    match Crs::from_wkt(text) {
        Ok(crs) => Some(Ok(crs)),
        Err(error) => {
            warnings.push(
                format!("the coordinate system in WKT is not understood and is ignored: {error}")
                    .into(),
            );
            Some(Err(text.to_owned()))
        }
    }
}

fn from_keys(directory: &[u8], payloads: &Payloads, warnings: &mut Vec<Wording>) -> Option<Stated> {
    let doubles = payloads.geo_doubles.as_deref().unwrap_or_default();
    let ascii = payloads.geo_ascii.as_deref().unwrap_or_default();
    let keys = GeoKeys {
        directory: words(directory),
        doubles: doubles
            .chunks_exact(8)
            .map(|bytes| f64_at(bytes, 0))
            .collect(),
        // Keys refer to positions in bytes, so every byte becomes one character.
        ascii: ascii
            .iter()
            .map(|&byte| {
                if byte.is_ascii() {
                    char::from(byte)
                } else {
                    '?'
                }
            })
            .collect(),
    };
    match keys.crs() {
        Ok(crs) => crs.map(Ok),
        Err(error) => {
            warnings.push(
                format!("the GeoTIFF keys of the coordinate system are not understood and are ignored: {error}").into(),
            );
            Some(Err(format!("{keys:?}")))
        }
    }
}
