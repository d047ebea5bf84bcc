use crate::error::{Error, Result};

/// What becomes of a file that has fewer points than its header states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cut {
    /// It is an error.
    #[default]
    Refuse,
    /// The points that are there are read, with a warning.
    Accept,
}

impl Cut {
    /// Tells that points are missing from this byte on.
    pub(super) fn refuse_or_warn(self, text: String, byte: u64, warnings: &mut Vec<String>) -> Result<()> {
        match self {
            Cut::Accept => warnings.push(text),
            Cut::Refuse => {
                return Err(Error::format(text)
                    .at(format!("byte {byte}"))
                    .cure("copy or download the file again, or take the points that are there with --partial"));
            }
        }
        Ok(())
    }
}
