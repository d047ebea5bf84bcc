//! Variable length records, between the header and the points, and after the points.

use std::io::{BufReader, Read, Seek, SeekFrom};

use super::header::{FileLayout, Header, RecordInfo};
use super::input::Input;
use super::raw::{EVLR_HEADER, RawRecordHeader, VLR_HEADER};
use crate::error::{Result, Wording};

/// Limit for the number of records; more are ignored, since no file has a use for them.
const MAX_RECORDS: u64 = 10_000;

/// Limit for the payloads that are loaded, in bytes. Coordinate systems are texts of a few
/// kilobytes; the limit guards against false lengths.
const MAX_PAYLOAD_BYTES: u64 = 1 << 20;

/// The payloads that a reader of points needs.
#[derive(Debug, Default)]
pub(super) struct Payloads {
    /// `laszip encoded`, 22204.
    pub(super) laszip: Option<Vec<u8>>,
    /// `LASF_Projection`, 2112.
    pub(super) wkt: Option<Vec<u8>>,
    /// `LASF_Projection`, 34735 to 34737.
    pub(super) geo_directory: Option<Vec<u8>>,
    pub(super) geo_doubles: Option<Vec<u8>>,
    pub(super) geo_ascii: Option<Vec<u8>>,
    /// `copc`, 1.
    pub(super) copc: Option<Vec<u8>>,
}

impl Payloads {
    /// Returns where to store a payload, if it is needed; the first record of a kind counts.
    fn slot(&mut self, record: &RawRecordHeader) -> Option<&mut Option<Vec<u8>>> {
        let slot = match (record.user_id.as_str(), record.record_id) {
            ("laszip encoded", 22204) => &mut self.laszip,
            ("LASF_Projection", 2112) => &mut self.wkt,
            ("LASF_Projection", 34735) => &mut self.geo_directory,
            ("LASF_Projection", 34736) => &mut self.geo_doubles,
            ("LASF_Projection", 34737) => &mut self.geo_ascii,
            ("copc", 1) => &mut self.copc,
            _ => return None,
        };
        slot.is_none().then_some(slot)
    }
}

/// Reads both kinds of records, as far as they exist: the counts in the header are not trusted.
pub(super) fn read(
    input: &Input,
    header: &mut Header,
    warnings: &mut Vec<Wording>,
) -> Result<Payloads> {
    let FileLayout {
        vlr_start,
        vlr_count,
        points_start,
        evlr_start,
        evlr_count,
        ..
    } = header.layout;
    let mut payloads = Payloads::default();
    let short = Records {
        name: "variable length",
        start: vlr_start,
        end: points_start,
        limit: "the points begin",
        count: vlr_count,
    };
    short.read(input, header, &mut payloads, warnings, |source| {
        let mut bytes = [0; VLR_HEADER];
        source.read_exact(&mut bytes)?;
        Ok((RawRecordHeader::parse(&bytes), VLR_HEADER))
    })?;
    if evlr_count > 0 {
        let long = Records {
            name: "extended variable length",
            start: evlr_start,
            end: input.length,
            limit: "the file ends",
            count: evlr_count,
        };
        long.read(input, header, &mut payloads, warnings, |source| {
            let mut bytes = [0; EVLR_HEADER];
            source.read_exact(&mut bytes)?;
            Ok((RawRecordHeader::parse_extended(&bytes), EVLR_HEADER))
        })?;
    }
    Ok(payloads)
}

/// A sequence of records of one kind.
struct Records {
    name: &'static str,
    start: u64,
    end: u64,
    /// What is at the end, for messages.
    limit: &'static str,
    count: u64,
}

impl Records {
    fn read<'a>(
        &self,
        input: &'a Input,
        header: &mut Header,
        payloads: &mut Payloads,
        warnings: &mut Vec<Wording>,
        next: impl Fn(&mut BufReader<&'a std::fs::File>) -> std::io::Result<(RawRecordHeader, usize)>,
    ) -> Result<()> {
        let Records {
            name,
            start,
            end,
            limit,
            count,
        } = *self;
        if start > end {
            warnings.push(
                format!("the header states {count} {name} records at byte {start}, but {limit} at byte {end}; they are ignored")
                    .into(),
            );
            return Ok(());
        }
        let mut source = BufReader::new(&input.file);
        source.seek(SeekFrom::Start(start))?;
        let mut position = start;
        let mut found = 0;
        while found < count.min(MAX_RECORDS) {
            let Ok((record, size)) = next(&mut source) else {
                break;
            };
            let payload = position.saturating_add(size as u64);
            if payload > end {
                break;
            }
            if record.length > end - payload {
                warnings.push(
                    format!(
                        "{name} record {} ({}, {}) states {} bytes, but {} are left for it; it is ignored",
                        found + 1,
                        record.user_id,
                        record.record_id,
                        record.length,
                        end - payload
                    )
                    .into(),
                );
                return Ok(());
            }
            let wanted = payloads
                .slot(&record)
                .filter(|_| record.length <= MAX_PAYLOAD_BYTES);
            if let Some(slot) = wanted {
                let mut bytes = vec![0; record.length as usize];
                source.read_exact(&mut bytes)?;
                *slot = Some(bytes);
            } else {
                // Cannot overflow: the length is at most that of the file.
                source.seek_relative(record.length as i64)?;
            }
            position = payload + record.length;
            found += 1;
            let RawRecordHeader {
                user_id,
                record_id,
                length,
                description,
            } = record;
            header.records.push(RecordInfo {
                user_id,
                record_id,
                length,
                description,
            });
        }
        if found < count {
            warnings.push(
                format!("the header states {count} {name} records; {found} were found, from byte {start} to {position}").into(),
            );
        }
        Ok(())
    }
}
