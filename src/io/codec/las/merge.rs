//! Merges the headers, records and lattices of several files into those of one file.

use super::header::RECORD_LENGTHS;
use super::raw::until_zero;
use crate::data::{Embedding, LasHead, Lattice, PointInfo};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::little_endian::u16_at;

/// The generating software, as the header states it.
const SOFTWARE: &str = concat!("breakline ", env!("CARGO_PKG_VERSION"));

/// Returns the bytes of a record of a point format, without extra bytes.
pub(super) fn usual_length(point_format: u8) -> u16 {
    RECORD_LENGTHS
        .get(usize::from(point_format))
        .copied()
        .unwrap_or(0)
}

/// What to do with coordinates that are not on the lattice of the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rounding {
    /// Return an error.
    #[default]
    Refuse,
    /// Move them to the nearest lattice point, using the lattice of the first source: by half a
    /// step at most.
    Nearest,
}

/// Returns a field of characters, padded with zeros.
pub(super) fn padded<const N: usize>(text: &str) -> [u8; N] {
    let mut field = [0; N];
    field
        .iter_mut()
        .zip(text.bytes())
        .for_each(|(slot, byte)| *slot = byte);
    field
}

/// Returns the header of a variable length record.
pub(super) fn record_header(user: &str, id: u16, length: u16, description: &str) -> Vec<u8> {
    let mut bytes = vec![0; 2];
    bytes.extend(padded::<16>(user));
    bytes.extend(id.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    bytes.extend(padded::<32>(description));
    bytes
}

/// A conversion of steps of one lattice to those of another.
#[derive(Debug, Clone, Copy)]
pub(super) enum LatticeStep {
    Same,
    Exact(Embedding),
    /// Through the coordinates in the first lattice, rounded.
    Rounded(Lattice),
}

impl LatticeStep {
    /// Returns the conversion from one lattice into another.
    ///
    /// # Errors
    /// If the points do not lie on a lattice, or on one that is not part of the other and rounding
    /// is refused.
    pub(super) fn between(
        from: Option<Lattice>,
        into: &Lattice,
        rounding: Rounding,
    ) -> Result<Self> {
        let from = from.ok_or_else(not_las)?;
        if from == *into {
            return Ok(LatticeStep::Same);
        }
        match (from.embed(into), rounding) {
            (Some(embedding), _) => Ok(LatticeStep::Exact(embedding)),
            (None, Rounding::Nearest) => Ok(LatticeStep::Rounded(from)),
            (None, Rounding::Refuse) => Err(apart(&from, into)),
        }
    }

    /// Returns the steps in the other lattice.
    ///
    /// # Errors
    /// If they do not fit into 32 bits.
    pub(super) fn apply(&self, steps: [i32; 3], into: &Lattice) -> Result<[i32; 3]> {
        match self {
            LatticeStep::Same => Ok(steps),
            LatticeStep::Exact(embedding) => embedding
                .steps(steps)
                .ok_or_else(|| far(steps.map(f64::from))),
            LatticeStep::Rounded(from) => {
                let point = from.point(steps);
                into.nearest(point).ok_or_else(|| far(point))
            }
        }
    }
}

/// Returns the head and the lattice of a file for the points of all sources.
///
/// # Errors
/// If a source has no head, has waveforms, or is incompatible with the first.
pub(super) fn heads(sources: &[&PointInfo], rounding: Rounding) -> Result<(LasHead, Lattice)> {
    let all = sources
        .iter()
        .map(|info| info.head.as_ref().zip(info.lattice).ok_or_else(not_las));
    let all: Vec<(&LasHead, Lattice)> = all.collect::<Result<_>>()?;
    let [(first, _), others @ ..] = all.as_slice() else {
        return Err(Error::usage("no source of points"));
    };
    for (head, _) in &all {
        check(head)?;
    }
    for (other, _) in others {
        agree(first, other)?;
    }
    let lattice = lattice(&all, rounding)?;

    let mut head = (*first).clone();
    let header = &mut head.header;
    header[58..90].copy_from_slice(&padded::<32>(SOFTWARE));
    // Waveforms are in another file, or missing.
    header[6] &= !0b110;
    let heads = || others.iter().map(|(head, _)| *head);
    let date = |head: &LasHead| (u16_at(&head.header, 92), u16_at(&head.header, 90));
    let latest = heads()
        .map(date)
        .chain([date(first)])
        .max()
        .unwrap_or_default();
    header[90..92].copy_from_slice(&latest.1.to_le_bytes());
    header[92..94].copy_from_slice(&latest.0.to_le_bytes());
    for (start, end) in [(4, 6), (8, 24)] {
        if heads().any(|other| other.header[start..end] != first.header[start..end]) {
            header[start..end].fill(0);
        }
    }
    if heads().any(|other| other.header[26..58] != first.header[26..58]) {
        header[26..58].copy_from_slice(&padded::<32>("MERGE"));
    }
    if !others.is_empty() {
        // The newest version, which has all fields of the older ones.
        if let Some(newest) = heads().find(|other| other.header[25] > first.header[25]) {
            return Err(versions(first, newest));
        }
    }
    for other in heads() {
        add_missing(&mut head.records, &other.records);
        add_missing(&mut head.late_records, &other.late_records);
    }
    Ok((head, lattice))
}

/// Adds the records whose user and number do not occur yet.
fn add_missing(records: &mut Vec<Vec<u8>>, others: &[Vec<u8>]) {
    let id = |record: &Vec<u8>| record.get(2..20).map(<[u8]>::to_vec);
    for other in others {
        if !records.iter().any(|known| id(known) == id(other)) {
            records.push(other.clone());
        }
    }
}

fn check(head: &LasHead) -> Result<()> {
    if matches!(head.point_format, 4 | 5 | 9 | 10) {
        return Err(Error::unsupported(format!(
            "point format {} refers to waveforms, which are not copied",
            head.point_format
        ))
        .cure("save it in point format 1, 3, 6 or 8 with a program that supports waveforms"));
    }
    Ok(())
}

/// Returns an error if the points of two files cannot share a file.
fn agree(first: &LasHead, other: &LasHead) -> Result<()> {
    let differ = |what: &str, one: String, two: String| {
        Err(Error::usage(format!(
            "the points of the inputs have different {what}: {one} and {two}"
        ))
        .cure("write the files one by one, or convert them first: no lossy conversion is made"))
    };
    if first.point_format != other.point_format {
        return differ(
            "point formats",
            first.point_format.to_string(),
            other.point_format.to_string(),
        );
    }
    if first.record_length != other.record_length {
        let [one, two] = [first, other].map(|head| format!("{} bytes", head.record_length));
        return differ("extra bytes, with records of", one, two);
    }
    let extra = |head: &LasHead| {
        let is_it = |record: &&Vec<u8>| {
            record.get(2..18).map(until_zero).as_deref() == Some("LASF_Spec")
                && u16_at(record, 18) == 4
        };
        head.records
            .iter()
            .find(is_it)
            .map(|record| record.get(54..).unwrap_or_default().to_vec())
    };
    if extra(first) != extra(other) {
        return differ(
            "extra bytes",
            "one description".to_owned(),
            "another".to_owned(),
        );
    }
    let time = |head: &LasHead| {
        if head.header[6] & 1 == 0 {
            "of the week"
        } else {
            "adjusted standard"
        }
    };
    if time(first) != time(other) {
        return differ(
            "kinds of GPS time",
            time(first).to_owned(),
            time(other).to_owned(),
        );
    }
    Ok(())
}

/// Returns the first lattice that contains the points of all sources. If there is none and rounding
/// is allowed, returns the lattice of the first source.
fn lattice(all: &[(&LasHead, Lattice)], rounding: Rounding) -> Result<Lattice> {
    let has_all = |into: &Lattice| {
        all.iter()
            .all(|(_, from)| from == into || from.embed(into).is_some())
    };
    let first = all[0].1;
    match (
        all.iter().map(|(_, lattice)| *lattice).find(has_all),
        rounding,
    ) {
        (Some(lattice), _) => Ok(lattice),
        (None, Rounding::Nearest) => Ok(first),
        (None, Rounding::Refuse) => {
            let other = all
                .iter()
                .map(|(_, lattice)| *lattice)
                .find(|other| other.embed(&first).is_none());
            Err(apart(&other.unwrap_or(first), &first))
        }
    }
}

/// Returns the error for a point that a lattice does not reach.
#[cold]
pub(super) fn far([x, y, z]: [f64; 3]) -> Error {
    Error::limit(format!(
        "the point at {x} {y} {z} cannot be stored with the scale and offset of the output"
    ))
    .cure("write the files one by one")
}

#[cold]
fn not_las() -> Error {
    Error::unsupported("points are written as LAS or LAZ only if they come from LAS or LAZ, with all their attributes")
        .cure("give LAS or LAZ files, or write text: .xyz, .txt or .csv")
}

#[cold]
fn versions(first: &LasHead, newest: &LasHead) -> Error {
    let [first, newest] = [first, newest].map(|head| head.header[25]);
    Error::usage(format!(
        "the first input is LAS 1.{first}, another one is LAS 1.{newest}"
    ))
    .cure("name a file of the newest version first: the output has its header")
}

#[cold]
fn apart(from: &Lattice, into: &Lattice) -> Error {
    let step = (0..3)
        .map(|k| into.scale[k].abs() / 2.0)
        .fold(0.0, f64::max);
    Error::usage(format!(
        "coordinates in steps of {:?} from {:?} are not all steps of {:?} from {:?}",
        from.scale, from.offset, into.scale, into.offset
    ))
    .cure(wording![
        Setting::Round.on(),
        format!(" moves them to the nearest, by {step} at most; or write the files one by one")
    ])
}
