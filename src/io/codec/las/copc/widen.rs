//! Point formats 0 to 3 as those of LAS 1.4 that have the same fields, 6 and 7.

use crate::error::{Error, Result};
use crate::io::codec::las::merge::usual_length;

/// Degrees of a step of the scan angle.
const ANGLE: f64 = 0.006;

/// How records of a point format of LAS 1.0 to 1.3 become those of LAS 1.4.
///
/// All fields stay: the return number and their count, flags, class, scan angle, time and colors
/// have the same values, at other places. A time that a format does not have is zero.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Widening {
    from: u8,
    pub(in super::super) from_length: u16,
}

impl Widening {
    /// Returns how records have to be changed; `None` if they are of LAS 1.4.
    pub(super) fn of(format: u8, length: u16) -> Option<Self> {
        (format < 4).then_some(Widening {
            from: format,
            from_length: length,
        })
    }

    pub(super) fn format(self) -> u8 {
        if self.has_colors() { 7 } else { 6 }
    }

    fn has_time(self) -> bool {
        matches!(self.from, 1 | 3)
    }

    fn has_colors(self) -> bool {
        matches!(self.from, 2 | 3)
    }

    /// Returns the length of the new records.
    ///
    /// # Errors
    /// If they have too many extra bytes.
    pub(super) fn length(self) -> Result<u16> {
        let extra = self.from_length.saturating_sub(usual_length(self.from));
        usual_length(self.format())
            .checked_add(extra)
            .ok_or_else(|| {
                Error::limit("too many extra bytes for a record of LAS 1.4")
                    .cure("write it as .laz")
            })
    }

    /// Appends a record in the new format.
    pub(in super::super) fn append(self, record: &[u8], to: &mut Vec<u8>) {
        let Some((fields, rest)) = record.split_first_chunk::<20>() else {
            return;
        };
        let (returns, class) = (fields[14], fields[15]);
        to.extend_from_slice(&fields[..14]);
        to.push(returns & 0x07 | (returns >> 3 & 0x07) << 4);
        // Flags; direction of the scan and edge of a flight line.
        to.push(class >> 5 | returns & 0xc0);
        to.push(class & 0x1f);
        to.push(fields[17]);
        let degrees = f64::from(fields[16].cast_signed());
        to.extend(((degrees / ANGLE).round() as i16).to_le_bytes());
        to.extend_from_slice(&fields[18..]);
        let (time, rest) = match (self.has_time(), rest.split_first_chunk::<8>()) {
            (true, Some((time, rest))) => (*time, rest),
            _ => ([0; 8], rest),
        };
        to.extend(time);
        to.extend_from_slice(rest);
    }
}
