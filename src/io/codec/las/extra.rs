//! Extra bytes: numbers that are appended to the records of points, and their descriptions.

use super::merge::{record_header, usual_length};
use super::raw::{VLR_HEADER, until_zero};
use crate::data::{LasHead, PointBatch};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::little_endian::u16_at;

/// The user and the number of the record that describes extra bytes.
const USER: &str = "LASF_Spec";
const NUMBER: u16 = 4;

/// Bytes of a description.
const DESCRIPTION: usize = 192;

/// Bytes of a name in a description.
const NAME: usize = 32;

/// The type of bytes without a meaning, whose count is in the options.
const UNDOCUMENTED: u8 = 0;

/// The type of a number of 64 bits, and its bytes.
const DOUBLE: u8 = 10;
const DOUBLE_BYTES: u16 = 8;

/// Bytes of each type of number from 1 on; types 11 to 20 and 21 to 30, no longer in use, are pairs
/// and triples of these.
const SIZES: [u32; 10] = [1, 1, 2, 2, 4, 4, 8, 8, 4, 8];

/// Adds the descriptions of numbers that are appended to each record, and makes the records longer.
/// [`append_numbers`] appends them. The head keeps all else, also extra bytes that it has already;
/// if several records describe these, one does afterwards.
///
/// # Errors
/// If there is a dimension of that name already, a name is longer than 32 bytes, the descriptions
/// of the file do not fit its records, or there are too many.
pub fn add_numbers(head: &mut LasHead, names: &[String]) -> Result<()> {
    let is_it = |record: &Vec<u8>| {
        record.get(2..18).map(until_zero).as_deref() == Some(USER) && u16_at(record, 18) == NUMBER
    };
    let at = head.records.iter().position(is_it);
    let payloads = head.records.iter().filter(|record| is_it(record));
    let mut described: Vec<u8> = payloads
        .filter_map(|record| record.get(VLR_HEADER..))
        .flat_map(|payload| payload.as_chunks::<DESCRIPTION>().0)
        .flatten()
        .copied()
        .collect();
    let usual = usual_length(head.point_format);
    let there = u32::from(head.record_length.saturating_sub(usual));
    let mut undescribed = there
        .checked_sub(described.chunks_exact(DESCRIPTION).map(bytes_of).sum())
        .ok_or_else(|| {
            Error::format(format!(
                "the descriptions of extra bytes exceed the {there} that a record has"
            ))
            .cure("remove the descriptions, or write the points as text")
        })?;
    // Descriptions count from the first extra byte.
    while undescribed > 0 {
        let some = undescribed.min(u8::MAX.into());
        described.extend(description(UNDOCUMENTED, some as u8, ""));
        undescribed -= some;
    }
    for name in names {
        let is_same =
            |other: &[u8]| until_zero(&other[4..4 + NAME]).eq_ignore_ascii_case(name.as_str());
        if described.chunks_exact(DESCRIPTION).any(is_same) {
            return Err(
                Error::usage(format!("there is a dimension {name} already")).cure(wording![
                    "give the new ones other names with ",
                    Setting::Prefix.text("new_")
                ]),
            );
        }
        if name.len() > NAME {
            return Err(Error::usage(format!(
                "the name {name} has more than the {NAME} bytes of a dimension of LAS"
            ))
            .cure(wording!["shorten ", Setting::Prefix]));
        }
        described.extend(description(DOUBLE, 0, name));
    }
    let too_many = || {
        Error::limit("too many extra bytes for a record of LAS")
            .cure("add fewer columns, or write the points as text")
    };
    let payload = u16::try_from(described.len()).map_err(|_| too_many())?;
    let added = u16::try_from(names.len())
        .ok()
        .and_then(|count| count.checked_mul(DOUBLE_BYTES));
    let length = added
        .and_then(|added| head.record_length.checked_add(added))
        .ok_or_else(too_many)?;
    match at {
        Some(at) => {
            let record = &mut head.records[at];
            record.truncate(VLR_HEADER);
            record[20..22].copy_from_slice(&payload.to_le_bytes());
            record.extend(described);
            let mut number = 0..;
            let is_kept = |record: &Vec<u8>| number.next() <= Some(at) || !is_it(record);
            head.records.retain(is_kept);
        }
        None => {
            let mut record = record_header(USER, NUMBER, payload, "Extra Bytes");
            record.extend(described);
            head.records.push(record);
        }
    }
    head.record_length = length;
    if let Some(bytes) = head.header.get_mut(105..107) {
        bytes.copy_from_slice(&length.to_le_bytes());
    }
    Ok(())
}

/// Appends numbers to the records of a batch, `count` to each, point by point; NaN where one is
/// missing.
pub fn append_numbers(batch: &mut PointBatch, numbers: &[f64], count: usize) {
    let points = batch.len();
    let stride = batch.records.len() / points.max(1);
    if stride == 0 || count == 0 {
        return;
    }
    let mut records = Vec::with_capacity(batch.records.len() + numbers.len() * 8);
    let of_points = numbers.chunks_exact(count);
    for (record, numbers) in batch.records.chunks_exact(stride).zip(of_points) {
        records.extend_from_slice(record);
        numbers
            .iter()
            .for_each(|number| records.extend(number.to_le_bytes()));
    }
    batch.records = records;
}

/// Returns how many bytes a description describes.
fn bytes_of(description: &[u8]) -> u32 {
    match description[2] {
        UNDOCUMENTED => description[3].into(),
        kind => {
            let kind = usize::from(kind - 1);
            let times = (kind / SIZES.len() + 1) as u32;
            SIZES[kind % SIZES.len()] * times
        }
    }
}

fn description(kind: u8, options: u8, name: &str) -> [u8; DESCRIPTION] {
    let mut bytes = [0; DESCRIPTION];
    bytes[2] = kind;
    bytes[3] = options;
    bytes[4..4 + NAME]
        .iter_mut()
        .zip(name.bytes())
        .for_each(|(slot, byte)| *slot = byte);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(extra: u16, descriptions: &[[u8; DESCRIPTION]]) -> LasHead {
        let payload = descriptions.concat();
        let mut record = record_header(USER, NUMBER, payload.len() as u16, "");
        record.extend(&payload);
        LasHead {
            header: vec![0; 227],
            point_format: 0,
            record_length: 20 + extra,
            records: if descriptions.is_empty() {
                Vec::new()
            } else {
                vec![record]
            },
            late_records: Vec::new(),
        }
    }

    fn names(head: &LasHead) -> Vec<(u8, String)> {
        let payload = &head.records[0][VLR_HEADER..];
        assert_eq!(usize::from(u16_at(&head.records[0], 20)), payload.len());
        let chunks = payload.chunks_exact(DESCRIPTION);
        chunks
            .map(|one| (one[2], until_zero(&one[4..36]).into_owned()))
            .collect()
    }

    #[test]
    fn descriptions_are_added_after_those_that_are_there() {
        let new = ["z".to_owned(), "slope".to_owned()];
        let mut without = head(0, &[]);
        add_numbers(&mut without, &new).unwrap();
        assert_eq!(
            (without.record_length, u16_at(&without.header, 105)),
            (36, 36)
        );
        assert_eq!(names(&without), [(10, "z".into()), (10, "slope".into())]);

        // A short integer is described, and three bytes are not.
        let mut with = head(5, &[description(3, 0, "amplitude")]);
        add_numbers(&mut with, &new[..1]).unwrap();
        assert_eq!(with.record_length, 33);
        let expected = [
            (3, "amplitude".into()),
            (0, String::new()),
            (10, "z".into()),
        ];
        assert_eq!(names(&with), expected);
        assert_eq!(with.records[0][VLR_HEADER + DESCRIPTION + 3], 3);

        // Two records, with another one between them.
        let mut split = head(10, &[description(3, 0, "amplitude")]);
        let other = head(10, &[description(10, 0, "width")]);
        split.records.push(record_header("other", 4, 0, ""));
        split.records.extend(other.records);
        add_numbers(&mut split, &new[..1]).unwrap();
        let expected = [
            (3, "amplitude".into()),
            (10, "width".into()),
            (10, "z".into()),
        ];
        assert_eq!(names(&split), expected);
        assert_eq!((split.records.len(), split.record_length), (2, 38));
        assert!(add_numbers(&mut split, &["WIDTH".to_owned()]).is_err());
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut taken = head(8, &[description(10, 0, "Z")]);
        assert!(add_numbers(&mut taken, &["z".to_owned()]).is_err());
        let mut short = head(1, &[description(10, 0, "a")]);
        assert!(add_numbers(&mut short, &["z".to_owned()]).is_err());
        assert!(add_numbers(&mut head(0, &[]), &["n".repeat(33)]).is_err());
        let many: Vec<String> = (0..400).map(|i| i.to_string()).collect();
        assert!(add_numbers(&mut head(0, &[]), &many).is_err());
        let triples = head(24, &[description(30, 0, "old")]);
        assert!(add_numbers(&mut triples.clone(), &["z".to_owned()]).is_ok());
        // Types that do not exist are as long as they would be.
        let mut odd = head(3, &[description(255, 0, "odd")]);
        assert!(add_numbers(&mut odd, &["z".to_owned()]).is_err());
    }

    #[test]
    fn numbers_follow_each_record() {
        let mut batch = PointBatch {
            x: vec![1.0, 2.0],
            y: vec![1.0, 2.0],
            z: vec![1.0, 2.0],
            records: vec![1, 2],
            ..PointBatch::default()
        };
        append_numbers(&mut batch, &[0.5, f64::NAN], 1);
        let mut expected = vec![1];
        expected.extend(0.5_f64.to_le_bytes());
        expected.push(2);
        expected.extend(f64::NAN.to_le_bytes());
        assert_eq!(batch.records, expected);
        append_numbers(&mut PointBatch::default(), &[], 1);
    }
}
