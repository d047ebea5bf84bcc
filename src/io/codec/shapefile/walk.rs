//! Walks through the records of a `.shp` file.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

use super::header::HEADER;
use super::index::Index;
use super::record::{self, Flaw, Oddities, Parsed};
use crate::data::Shape;
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::io::OnDamage;
use crate::io::bytes::watch::{Meter, Watch};

/// A record that was found, readable or not.
#[derive(Debug)]
pub(super) struct Record {
    /// Offset of its header, in bytes.
    pub(super) offset: u64,
    /// The number in its header; `None` if the header is damaged.
    pub(super) number: Option<i32>,
    /// The shape; `None` if the record is damaged.
    pub(super) shape: Option<Shape>,
}

/// Everything that a `.shp` contains.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// The records, in the order of the file.
    pub(super) records: Vec<Record>,
    /// The number of shapes per type code, without null shapes.
    pub(super) types: BTreeMap<i32, usize>,
    /// What could not be read.
    pub(super) damage: Damage,
    /// Where reading ended, if that was before the end of the file.
    pub(super) end: Option<u64>,
    /// A warning about what follows the last record, if the header does not count it.
    pub(super) trailing: Option<Wording>,
    pub(super) odd: Oddities,
}

/// What could not be read: a message for each of the first damages, and how many more there are.
#[derive(Debug, Default)]
pub(super) struct Damage {
    pub(super) reported: Vec<Wording>,
    pub(super) more: usize,
}

/// A `.shp` that is read.
pub(super) struct Shp {
    pub(super) file: BufReader<File>,
    /// Its length in bytes.
    pub(super) size: u64,
    /// The length that its header states.
    pub(super) stated: u64,
    /// The type of shapes that its header states.
    pub(super) code: i32,
}

impl Damage {
    const MAX_REPORTED: usize = 10;

    fn add(&mut self, location: &str, why: &str) {
        if self.reported.len() < Self::MAX_REPORTED {
            self.reported.push(format!("{location}: {why}").into());
        } else {
            self.more += 1;
        }
    }

    /// Reports the damage: as an error, or as warnings.
    ///
    /// # Errors
    /// If there is damage and it is not accepted.
    pub(super) fn refuse_or_warn(self, cut: OnDamage, warnings: &mut Vec<Wording>) -> Result<()> {
        let Damage { reported, more } = self;
        if let (OnDamage::Refuse, [first, others @ ..]) = (cut, &reported[..]) {
            let text = match others.len() + more {
                0 => first.clone(),
                count => wording![
                    first.clone(),
                    format!("; and {count} more parts cannot be read")
                ],
            };
            return Err(Error::format(text).cure(wording![
                "copy or download the file again, or use what is there with ",
                Setting::Partial.on()
            ]));
        }
        warnings.extend(reported);
        if more > 0 {
            warnings.push(format!("and {more} more parts that could not be read").into());
        }
        Ok(())
    }
}

/// Reads the records after the header.
///
/// A damaged record is left out and reported. After a header that makes no sense, reading continues
/// at the next record that `index` lists and whose length agrees; without an index it ends there.
/// If that is after all records that the index lists, nothing is missing; without an index, if it
/// is beyond the length that the header states, or too short for a record of the file's type.
///
/// # Errors
/// If reading fails, or a coordinate is not a number; that of the watch.
pub(super) fn walk(shp: &mut Shp, index: Option<&Index>, watch: Watch) -> Result<Walk> {
    let Shp {
        file,
        size,
        stated,
        code,
    } = shp;
    let size = *size;
    let mut walk = Walk::default();
    let mut meter = Meter::new(watch, size as usize);
    let mut content = Vec::new();
    let mut at = HEADER;
    file.seek(SeekFrom::Start(at))?;
    while at < size {
        meter.left((size - at) as usize)?;
        let number = walk.records.len() + 1;
        let location = || format!("record {number} (byte {at})");
        let (id, length) = match header(file, size - at)? {
            Ok(header) => header,
            Err(why) => {
                let is_beyond = match index {
                    Some(index) => !index.lists_from(at),
                    None => at >= *stated || size - at < record::least_bytes(*code),
                };
                if is_beyond && !walk.records.is_empty() {
                    walk.trailing = Some(format!("{}: {why}", location()).into());
                    walk.end = Some(at);
                    break;
                }
                walk.damage.add(&location(), &why);
                let Some((skipped, next)) = resync(file, size, at, index)? else {
                    walk.end = Some(at);
                    break;
                };
                let lost = |offset| Record {
                    offset,
                    number: None,
                    shape: None,
                };
                walk.records
                    .extend([at].into_iter().chain(skipped).map(lost));
                at = next;
                continue;
            }
        };
        content.clear();
        // Not `vec![0; length]`, which would allocate more than the file contains.
        file.by_ref().take(length).read_to_end(&mut content)?;
        let shape = match record::parse(&content, &mut walk.odd) {
            Ok(Parsed { code, shape }) => {
                if code != 0 {
                    *walk.types.entry(code).or_default() += 1;
                }
                Some(shape)
            }
            Err(Flaw::Damaged(why)) => {
                walk.damage.add(&location(), &why);
                None
            }
            Err(Flaw::NotFinite {
                vertex,
                axis,
                value,
            }) => {
                return Err(
                    Error::format(format!("{axis} of vertex {vertex} is {value}"))
                        .at(location())
                        .cure("repair or remove the record, then try again"),
                );
            }
        };
        walk.records.push(Record {
            offset: at,
            number: Some(id),
            shape,
        });
        at += 8 + length;
    }
    Ok(walk)
}

/// Reads a record's number and the length of its content, or returns why this is not a record.
fn header(file: &mut impl Read, left: u64) -> Result<std::result::Result<(i32, u64), String>> {
    if left < 8 {
        return Ok(Err(format!("{left} bytes, too few for a record")));
    }
    let mut bytes = [0; 8];
    file.read_exact(&mut bytes)?;
    let [a, b, c, d, e, f, g, h] = bytes;
    let length = 2 * i64::from(i32::from_be_bytes([e, f, g, h]));
    Ok(match u64::try_from(length) {
        Ok(length) if length > left - 8 => Err(format!(
            "content of {length} bytes extends beyond the end of the file, which has {} more",
            left - 8
        )),
        Ok(length) if length >= 4 => Ok((i32::from_be_bytes([a, b, c, d]), length)),
        _ => Err(format!("content of {length} bytes")),
    })
}

/// Seeks to the next record that the index lists and that exists. Returns the offsets of the listed
/// records before it that do not exist, and its own offset.
fn resync(
    file: &mut BufReader<File>,
    size: u64,
    from: u64,
    index: Option<&Index>,
) -> Result<Option<(Vec<u64>, u64)>> {
    let mut skipped = Vec::new();
    let mut at = from;
    while let Some((offset, length)) = index
        .and_then(|index| index.next_after(at))
        .filter(|next| next.0 < size)
    {
        file.seek(SeekFrom::Start(offset))?;
        if header(file, size - offset)?.is_ok_and(|found| found.1 == length) {
            file.seek(SeekFrom::Start(offset))?;
            return Ok(Some((skipped, offset)));
        }
        skipped.push(offset);
        at = offset;
    }
    Ok(None)
}
