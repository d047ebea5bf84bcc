//! Which stored samples mean "no value", and how the others are converted to values.

use super::layout::{SampleKind, SampleType};

/// The nodata value of a file, parsed from its text, in forms that can be compared with each sample
/// type.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Nodata {
    /// The value as a number.
    pub(super) value: Option<f64>,
    /// The value if it is an integer: 64-bit integers do not fit into `value`.
    whole: Option<i128>,
}

impl Nodata {
    /// Parses tag 42113: a number, "nan", "inf" or "-inf", possibly surrounded by blanks or NULs.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
        let value = match text.to_ascii_lowercase().as_str() {
            "1.#qnan" | "-1.#ind" | "-nan" => f64::NAN,
            lower => lower.parse::<f64>().ok()?,
        };
        let is_whole = value.fract() == 0.0 && value.abs() < 1e30;
        let whole = text
            .parse::<i128>()
            .ok()
            .or_else(|| is_whole.then_some(value as i128));
        Some(Nodata {
            value: Some(value),
            whole,
        })
    }

    /// Returns the value of cells whose block was left out of the file: NaN, or 0 if the file has
    /// no nodata value, as in GDAL.
    pub(super) fn of_missing_blocks(&self) -> f64 {
        if self.value.is_some() { f64::NAN } else { 0.0 }
    }

    /// Returns the value as an integer type, if it can be represented.
    pub(super) fn integer<T: TryFrom<i128>>(&self) -> Option<T> {
        self.whole.and_then(|whole| T::try_from(whole).ok())
    }

    /// Returns the value as stored in a 32-bit float.
    pub(super) fn single(&self) -> Option<f32> {
        self.value.map(|value| value as f32)
    }

    /// Returns true if a half precision sample is the value, converted to half precision by
    /// rounding or, as in GDAL, by truncation.
    pub(super) fn is_half(&self, sample: f64) -> bool {
        self.value.is_some_and(|value| {
            let exponent = (value.to_bits() >> 52 & 0x7ff) as i32 - 1023;
            // The step from one half precision number to the next: 10 fraction bits, none below
            // 2^-24.
            let step = 2f64.powi(exponent.max(-14) - 10);
            value == sample || (value - sample).abs() < step
        })
    }

    /// Returns true if no sample of this type can equal the value.
    pub(super) fn is_out_of_range(&self, sample: SampleType) -> bool {
        let Some(value) = self.value else {
            return false;
        };
        let bits = i32::from(sample.bits);
        match sample.kind {
            SampleKind::Float => value.is_finite() && bits <= 32 && !(value as f32).is_finite(),
            SampleKind::Unsigned => {
                !(value.fract() == 0.0 && 0.0 <= value && value < 2f64.powi(bits))
            }
            SampleKind::Signed => {
                let end = 2f64.powi(bits - 1);
                !(value.fract() == 0.0 && -end <= value && value < end)
            }
        }
    }
}

/// Returns scale and offset of band 1 from GDAL's metadata (tag 42112):
/// `<Item name="SCALE" sample="0" role="scale">0.1</Item>`.
pub(super) fn scale_and_offset(metadata: &str) -> (Option<f64>, Option<f64>) {
    let (mut scale, mut offset) = (None, None);
    for item in metadata.split("<Item").skip(1) {
        let Some((head, rest)) = item.split_once('>') else {
            continue;
        };
        let Some((text, _)) = rest.split_once("</Item") else {
            continue;
        };
        if attribute(head, "sample").unwrap_or("0") != "0" {
            continue;
        }
        let value = text
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite());
        match attribute(head, "role") {
            Some("scale") => scale = value,
            Some("offset") => offset = value,
            _ => {}
        }
    }
    (scale, offset)
}

fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let start = head.find(&format!("{name}=\""))? + name.len() + 2;
    head[start..].split('"').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BYTE: SampleType = SampleType {
        kind: SampleKind::Unsigned,
        bits: 8,
    };
    const SHORT: SampleType = SampleType {
        kind: SampleKind::Signed,
        bits: 16,
    };
    const SINGLE: SampleType = SampleType {
        kind: SampleKind::Float,
        bits: 32,
    };

    #[test]
    fn texts_of_every_kind_are_read() {
        assert_eq!(
            Nodata::parse("-9999").unwrap().integer::<i16>(),
            Some(-9999)
        );
        assert_eq!(Nodata::parse(" 0.0 \0").unwrap().integer::<u8>(), Some(0));
        assert_eq!(
            Nodata::parse("-3.4028230607370965e+38").unwrap().single(),
            Some(-3.402_823e38)
        );
        assert_eq!(
            Nodata::parse("-3.40282346639e+38").unwrap().single(),
            Some(f32::MIN)
        );
        assert!(Nodata::parse("nan").unwrap().value.unwrap().is_nan());
        assert!(Nodata::parse("NaN ").unwrap().single().unwrap().is_nan());
        assert_eq!(
            Nodata::parse("-inf").unwrap().value,
            Some(f64::NEG_INFINITY)
        );
        assert_eq!(Nodata::parse("inf").unwrap().integer::<u64>(), None);
        assert_eq!(
            Nodata::parse("18446744073709551615")
                .unwrap()
                .integer::<u64>(),
            Some(u64::MAX)
        );
        assert_eq!(
            Nodata::parse("-9223372036854775807")
                .unwrap()
                .integer::<i64>(),
            Some(i64::MIN + 1)
        );
        assert_eq!(Nodata::parse("none"), None);
        assert_eq!(Nodata::parse(""), None);
    }

    #[test]
    fn values_that_a_type_cannot_hold_match_nothing() {
        let below = Nodata::parse("-9999").unwrap();
        assert_eq!(below.integer::<u8>(), None);
        assert!(
            below.is_out_of_range(BYTE)
                && !below.is_out_of_range(SHORT)
                && !below.is_out_of_range(SINGLE)
        );
        assert!(Nodata::parse("0.5").unwrap().is_out_of_range(SHORT));
        assert!(
            Nodata::parse("-1.7976931348623157e308")
                .unwrap()
                .is_out_of_range(SINGLE)
        );
        assert!(!Nodata::parse("-inf").unwrap().is_out_of_range(SINGLE));
        assert!(Nodata::parse("nan").unwrap().is_out_of_range(BYTE));
    }

    #[test]
    fn half_precision_is_compared_in_half_precision() {
        // -9999 is not a half precision number; its neighbors are -10000 and -9992.
        let nodata = Nodata::parse("-9999").unwrap();
        assert!(nodata.is_half(-10000.0) && nodata.is_half(-9992.0));
        assert!(!nodata.is_half(-10008.0) && !nodata.is_half(-9984.0) && !nodata.is_half(5.0));
    }

    #[test]
    fn scale_and_offset_are_those_of_the_first_band() {
        let text = r#"<GDALMetadata>
            <Item name="OFFSET" sample="1" role="offset">2000</Item>
            <Item name="OFFSET" sample="0" role="offset">1000</Item>
            <Item name="SCALE" sample="0" role="scale">0.0001</Item>
            <Item name="DESCRIPTION" sample="0" role="description">scale</Item>
        </GDALMetadata>"#;
        assert_eq!(scale_and_offset(text), (Some(0.0001), Some(1000.0)));
        assert_eq!(
            scale_and_offset("<Item role=\"scale\">x</Item>"),
            (None, None)
        );
        assert_eq!(scale_and_offset("<Item role=\"scale\""), (None, None));
    }
}
