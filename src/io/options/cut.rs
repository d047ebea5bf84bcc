use crate::error::{Error, Result, Setting, Wording, wording};

/// What to do with a file of which a part is missing or damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum OnDamage {
    /// Return an error.
    #[default]
    Refuse,
    /// Read what is intact, with a warning.
    Accept,
}

impl OnDamage {
    /// Reports that something is missing from a location on ("byte 4096"): as an error or a
    /// warning.
    pub(crate) fn refuse_or_warn(
        self,
        text: String,
        location: &str,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        match self {
            OnDamage::Accept => warnings.push(text.into()),
            OnDamage::Refuse => {
                return Err(Error::format(text).at(location).cure(wording![
                    "copy or download the file again, or use what is there with ",
                    Setting::Partial.on()
                ]));
            }
        }
        Ok(())
    }
}

/// The warning for a text whose last line has no end.
pub(crate) const OPEN_LINE: &str =
    "the last line has no line end: if the file was cut, its last number may be wrong";

/// Returns [`OPEN_LINE`] if the last line of a text has no end, and has more than a comment (`#`).
pub(crate) fn open_line(text: &[u8]) -> Option<Wording> {
    let line = text.rsplit(|&byte| byte == b'\n' || byte == b'\r').next()?;
    let values = line.split(|&byte| byte == b'#').next()?.trim_ascii();
    (!values.is_empty()).then(|| OPEN_LINE.into())
}
