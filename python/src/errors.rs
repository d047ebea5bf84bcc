//! Exceptions: from errors of the library, and for arguments that cannot be used.
//!
//! The classes are those of `breakline/_errors.py`.

use std::any::Any;
use std::error::Error as _;
use std::ffi::OsStr;

use breakline::error::Kind;
use pyo3::prelude::*;

use crate::names::name;

/// An error of the library on its way to an exception: a type of this crate, so that `?` converts.
pub(crate) struct Failure(pub(crate) breakline::Error);

/// What work in this crate returns.
pub(crate) type Result<T> = std::result::Result<T, Failure>;

impl From<breakline::Error> for Failure {
    fn from(error: breakline::Error) -> Self {
        Failure(error)
    }
}

impl From<Failure> for PyErr {
    fn from(Failure(error): Failure) -> Self {
        let class = match error.kind() {
            Kind::Format => "FormatError",
            Kind::Unsupported => "UnsupportedError",
            Kind::Usage => "UsageError",
            Kind::NotYet => "NotYetError",
            Kind::OtherJob => "OtherJobError",
            Kind::Limit => "LimitError",
            Kind::Io => "FileError",
            Kind::Canceled => "CanceledError",
        };
        let mut causes = Vec::new();
        let mut cause = error.source();
        while let Some(source) = cause {
            causes.push(source.to_string());
            cause = source.source();
        }
        let errno = error
            .source()
            .and_then(|e| e.downcast_ref::<std::io::Error>())
            .and_then(|e| {
                e.raw_os_error().or(match e.kind() {
                    std::io::ErrorKind::NotFound => Some(2),
                    std::io::ErrorKind::AlreadyExists => Some(17),
                    _ => None,
                })
            });
        create(Parts {
            class,
            message: &error.message().render(&name),
            file: error.path().map(|path| path.as_os_str()),
            location: error.location(),
            value: None,
            cure: error.cure_text().map(|cure| cure.render(&name)).as_deref(),
            causes: &causes,
            errno,
        })
    }
}

/// The attributes of an exception.
#[derive(IntoPyObject)]
struct Parts<'a> {
    class: &'a str,
    message: &'a str,
    file: Option<&'a OsStr>,
    location: Option<&'a str>,
    value: Option<&'a str>,
    cure: Option<&'a str>,
    causes: &'a [String],
    errno: Option<i32>,
}

/// Creates an exception; if that fails, the exception that says why.
fn create(parts: Parts<'_>) -> PyErr {
    Python::attach(|py| {
        let create = py
            .import("breakline._errors")
            .and_then(|module| module.getattr("create"));
        match create.and_then(|create| create.call1((parts,))) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    })
}

fn with_value(class: &str, message: &str, value: Option<&str>, cure: Option<&str>) -> PyErr {
    create(Parts {
        class,
        message,
        file: None,
        location: None,
        value,
        cure,
        causes: &[],
        errno: None,
    })
}

/// Returns a `UsageError` about an argument, its value and the cure.
#[cold]
pub(crate) fn usage(message: &str, value: &str, cure: &str) -> PyErr {
    with_value("UsageError", message, Some(value), Some(cure))
}

/// Returns a `LimitError`.
#[cold]
pub(crate) fn limit(message: &str) -> PyErr {
    with_value("LimitError", message, None, None)
}

/// Returns an `InternalError` for a panic that was caught.
#[cold]
pub(crate) fn internal(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    with_value(
        "InternalError",
        text,
        None,
        Some("this is a defect of breakline: please report it with the data"),
    )
}
