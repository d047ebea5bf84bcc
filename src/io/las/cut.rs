use crate::error::{Error, Result};

/// What to do with a file that has fewer points than its header states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cut {
    /// Return an error.
    #[default]
    Refuse,
    /// Read the points that are there, with a warning.
    Accept,
}

impl Cut {
    /// Reports that points are missing from `byte` on: as an error or a warning.
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
