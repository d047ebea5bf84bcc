//! The error type of everything outside of the triangulations, and the texts of errors and notices.
//!
//! Errors are sorted by who can act on them ([`Kind`]). Each says where it happened, what was
//! found, what was expected and, if there is one, the cure, which is worded where the error is made
//! ([`Error::cure`]). The triangulations have error types of their own: they refuse invalid input,
//! and cannot fail on input that they accepted.
//!
//! Texts do not know how they will be read. A [`Wording`] mentions settings of requests, commands
//! and features of a build as data ([`Setting`], [`Term`]); the command line shows them as options,
//! Python as parameters.

mod plain;
mod setting;
mod stored;
mod wording;

use std::fmt;
use std::path::{Path, PathBuf};

pub(crate) use plain::MANY_DIGITS;
pub use plain::Plain;
pub use setting::{Command, Feature, Setting, Term};
pub(crate) use wording::wording;
pub use wording::{Part, Wording};

/// The result of an operation that can fail with an [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Who can act on an [`Error`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The data breaks the rules of its format; the file has to be repaired.
    Format,
    /// The data is valid, but this program (or this build of it) cannot read it.
    Unsupported,
    /// The caller asked for something that makes no sense.
    Usage,
    /// A documented limit was exceeded.
    Limit,
    /// The operating system failed.
    Io,
    /// The caller canceled the work.
    Canceled,
    /// Something that has to be done before is not done: the same may work later.
    NotYet,
    /// A folder has another job than the one that was meant.
    OtherJob,
}

/// What went wrong, where, and what to do about it.
///
/// Displayed as `path: location: message`. The [cure](Error::cure_text) is not part of the message,
/// so that the command line can print it on a line of its own. Messages are lower case, without a
/// full stop. Settings have plain names when displayed; [`render`](Error::render) takes others.
#[derive(Debug)]
pub struct Error {
    inner: Box<Inner>,
}

#[derive(Debug)]
struct Inner {
    kind: Kind,
    message: Wording,
    path: Option<PathBuf>,
    location: Option<String>,
    cure: Option<Wording>,
    source: Option<Box<dyn std::error::Error + Send + Sync>>,
}

impl Error {
    #[cold]
    fn new(kind: Kind, message: impl Into<Wording>) -> Self {
        Error {
            inner: Box::new(Inner {
                kind,
                message: message.into(),
                path: None,
                location: None,
                cure: None,
                source: None,
            }),
        }
    }

    /// Creates an error for data that breaks the rules of its format.
    #[cold]
    pub fn format(message: impl Into<Wording>) -> Self {
        Self::new(Kind::Format, message)
    }

    /// Creates an error for data that uses an unsupported feature; the message should name it.
    #[cold]
    pub fn unsupported(message: impl Into<Wording>) -> Self {
        Self::new(Kind::Unsupported, message)
    }

    /// Creates an error for a request that makes no sense.
    #[cold]
    pub fn usage(message: impl Into<Wording>) -> Self {
        Self::new(Kind::Usage, message)
    }

    /// Creates an error for an exceeded limit; the message should name the limit and the value.
    #[cold]
    pub fn limit(message: impl Into<Wording>) -> Self {
        Self::new(Kind::Limit, message)
    }

    /// Creates the error that canceled work ends with. It has no path and no location, because they
    /// mean nothing to the user.
    #[cold]
    pub fn canceled() -> Self {
        Self::new(Kind::Canceled, "canceled")
    }

    /// Creates an error for work that needs other work, which is not done.
    #[cold]
    pub fn not_yet(message: impl Into<Wording>) -> Self {
        Self::new(Kind::NotYet, message)
    }

    /// Creates an error for a folder that has another job than the one that was meant.
    #[cold]
    pub fn other_job(message: impl Into<Wording>) -> Self {
        Self::new(Kind::OtherJob, message)
    }

    /// Wraps an error of the operating system or of a library; its text becomes the message.
    #[cold]
    pub fn caused_by(kind: Kind, source: impl std::error::Error + Send + Sync + 'static) -> Self {
        let mut error = Self::new(kind, source.to_string());
        error.inner.source = Some(Box::new(source));
        error
    }

    /// Adds the path of the file, unless there is one already: the innermost is the most exact.
    #[must_use]
    pub fn in_file(mut self, path: impl AsRef<Path>) -> Self {
        if self.inner.kind != Kind::Canceled {
            self.inner
                .path
                .get_or_insert_with(|| path.as_ref().to_path_buf());
        }
        self
    }

    /// Adds the location in the file ("record 12", "byte 4096", "line 3"), unless there is one
    /// already.
    #[must_use]
    pub fn at(mut self, location: impl Into<String>) -> Self {
        if self.inner.kind != Kind::Canceled {
            self.inner.location.get_or_insert_with(|| location.into());
        }
        self
    }

    /// Adds the larger part that the location is in, such as a tile, in front of it.
    #[must_use]
    pub fn within(mut self, part: impl fmt::Display) -> Self {
        if self.inner.kind != Kind::Canceled {
            self.inner.location = Some(match self.inner.location {
                Some(location) => format!("{part}, {location}"),
                None => part.to_string(),
            });
        }
        self
    }

    /// Names another file, of which the one of the error is only a part or a copy.
    #[must_use]
    pub(crate) fn moved(mut self, path: &Path, part: impl fmt::Display) -> Self {
        self.inner.path = None;
        self.in_file(path).within(part)
    }

    /// Names the file that was read. If that is damaged, and no other cure is known, adds one.
    #[must_use]
    pub(crate) fn in_input(self, path: impl AsRef<Path>) -> Self {
        let is_bare = self.inner.kind == Kind::Format && self.inner.cure.is_none();
        let error = self.in_file(path);
        match is_bare {
            true => error.cure("save the file again with the program that it comes from"),
            false => error,
        }
    }

    /// Adds what the user can do about it.
    #[must_use]
    pub fn cure(mut self, cure: impl Into<Wording>) -> Self {
        self.inner.cure = Some(cure.into());
        self
    }

    /// Returns who can act on the error.
    pub fn kind(&self) -> Kind {
        self.inner.kind
    }

    /// Returns what the user can do about it, if anything is known.
    pub fn cure_text(&self) -> Option<&Wording> {
        self.inner.cure.as_ref()
    }

    /// Returns what was found, without the path and the location.
    pub fn message(&self) -> &Wording {
        &self.inner.message
    }

    /// Returns the location in the file, if any.
    pub fn location(&self) -> Option<&str> {
        self.inner.location.as_deref()
    }

    /// Returns the path of the file that the error is about, if any.
    pub fn path(&self) -> Option<&Path> {
        self.inner.path.as_deref()
    }

    /// Returns the error as it is displayed, with the names that a caller has for terms.
    pub fn render(&self, name: &dyn Fn(&Term) -> String) -> String {
        let path = self
            .inner
            .path
            .as_ref()
            .map(|path| path.display().to_string());
        let message = self.inner.message.render(name);
        let parts = [path, self.inner.location.clone(), Some(message)];
        parts.into_iter().flatten().collect::<Vec<_>>().join(": ")
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&Term::plain))
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.inner.source.as_ref().map(|e| e.as_ref() as _)
    }
}

impl From<std::io::Error> for Error {
    #[cold]
    fn from(source: std::io::Error) -> Self {
        let plain = plain_words(&source);
        let mut error = Self::caused_by(Kind::Io, source);
        if let Some((message, cure)) = plain {
            error.inner.message = message.into();
            error.inner.cure = Some(cure.into());
        }
        error
    }
}

/// A plain message and a cure for the errors of the operating system that a user can act on.
fn plain_words(error: &std::io::Error) -> Option<(&'static str, &'static str)> {
    use std::io::ErrorKind;
    // Errors without a code of the system come from this crate, and say more themselves.
    error.raw_os_error()?;
    match error.kind() {
        ErrorKind::StorageFull => Some((
            "the disk is full",
            "free some space, or write to another disk",
        )),
        ErrorKind::QuotaExceeded => Some((
            "your share of the disk is used up",
            "free some space, or write elsewhere",
        )),
        ErrorKind::FileTooLarge => Some((
            "the file would be larger than is allowed here",
            "raise the limit (ulimit -f), or write to another disk",
        )),
        ErrorKind::ReadOnlyFilesystem => {
            Some(("the disk can only be read", "write to another disk"))
        }
        ErrorKind::PermissionDenied => Some((
            "no permission",
            "ask the owner for it: `ls -ld` shows who may read and write",
        )),
        ErrorKind::BrokenPipe => Some((
            "the program that read it has ended",
            "see what that program says",
        )),
        _ => None,
    }
}
