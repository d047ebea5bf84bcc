//! Writes a coordinate system into the head of a LAS file.

use super::merge::record_header;
use super::raw::until_zero;
use crate::crs::{Crs, GeoKeys};
use crate::data::LasHead;
use crate::error::{Error, Result};
use crate::io::bytes::little_endian::u16_at;

const USER: &str = "LASF_Projection";
/// The math transform and the coordinate system in WKT; keys, numbers and text of GeoTIFF.
const RECORDS: [u16; 5] = [2111, 2112, 34735, 34736, 34737];
/// The bit of the global encoding that says that the system is in WKT.
pub(super) const WKT_BIT: u8 = 1 << 4;

/// Returns true if a record states a coordinate system, or a part of one.
pub(super) fn is_of_system(record: &[u8]) -> bool {
    record.get(2..18).map(until_zero).as_deref() == Some(USER)
        && RECORDS.contains(&u16_at(record, 18))
}

/// States a coordinate system in the head of a file, instead of what it states.
///
/// It is stated by GeoTIFF keys, which most programs read, in files of point formats 0 to 5; by WKT
/// in those of formats 6 to 10, as LAS 1.4 requires, and where keys cannot represent the system.
///
/// # Errors
/// If the system needs WKT, and the version of LAS is below 1.4.
pub fn state_system(head: &mut LasHead, crs: &Crs) -> Result<()> {
    head.records.retain(|record| !is_of_system(record));
    head.late_records.retain(|record| !is_of_system(record));
    let keys = (head.point_format < 6)
        .then(|| GeoKeys::from_crs(crs))
        .filter(|keys| states(keys, crs));
    let version = head.header.get(25).copied().unwrap_or_default();
    let payloads = match &keys {
        Some(keys) => of_keys(keys),
        None if version >= 4 => vec![(
            2112,
            "OGC coordinate system WKT",
            [crs.to_wkt_with_unit_of_heights().as_bytes(), &[0]].concat(),
        )],
        None => {
            return Err(Error::unsupported(format!(
                "{crs} cannot be stated in LAS 1.{version}, which has no WKT"
            ))
            .cure("convert the file to LAS 1.4 first, or write text"));
        }
    };
    if let Some(encoding) = head.header.get_mut(6) {
        *encoding = if keys.is_some() {
            *encoding & !WKT_BIT
        } else {
            *encoding | WKT_BIT
        };
    }
    for (id, description, payload) in payloads {
        let length = u16::try_from(payload.len()).map_err(|_| {
            Error::limit(format!(
                "the definition of {crs} has more than {} bytes",
                u16::MAX
            ))
        })?;
        head.records
            .push([record_header(USER, id, length, description), payload].concat());
    }
    Ok(())
}

/// Returns true if a reader of the keys gets this system.
fn states(keys: &GeoKeys, crs: &Crs) -> bool {
    keys.crs()
        .is_ok_and(|read| read.is_some_and(|read| read.is_same(crs)))
}

/// Returns the records of keys: id, description, content.
fn of_keys(keys: &GeoKeys) -> Vec<(u16, &'static str, Vec<u8>)> {
    let directory = keys
        .directory
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    let doubles: Vec<u8> = keys
        .doubles
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let ascii = keys.ascii.as_bytes().to_vec();
    let optional = [
        (34736, "GeoTiff GeoDoubleParamsTag", doubles),
        (34737, "GeoTiff GeoAsciiParamsTag", ascii),
    ];
    let mut records = vec![(34735, "GeoTiff GeoKeyDirectoryTag", directory)];
    records.extend(
        optional
            .into_iter()
            .filter(|(_, _, payload)| !payload.is_empty()),
    );
    records
}
