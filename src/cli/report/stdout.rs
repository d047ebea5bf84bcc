//! Data on stdout.

use std::io::{self, BufWriter, ErrorKind, Write};

use super::escape;
use crate::error::Result;

/// Writes data to stdout. A closed pipe (`| head`) is not an error.
pub(crate) fn print(text: &str) -> Result<()> {
    match std::io::stdout().write_all(escape::lines(text).as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Bytes on stdout, as they are.
#[derive(Debug)]
pub(crate) struct Stdout {
    out: BufWriter<io::Stdout>,
    is_closed: bool,
}

impl Stdout {
    pub(crate) fn new() -> Self {
        Stdout {
            out: BufWriter::with_capacity(1 << 18, io::stdout()),
            is_closed: false,
        }
    }

    /// Returns true if nobody reads any longer (`| head`), which was an error of a write but is
    /// none of the run.
    pub(crate) fn is_closed(&self) -> bool {
        self.is_closed
    }

    fn noting<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        let is_closed = |error: &io::Error| error.kind() == ErrorKind::BrokenPipe;
        self.is_closed |= result.as_ref().is_err_and(is_closed);
        result
    }
}

impl Write for Stdout {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.out.write(bytes);
        self.noting(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.out.flush();
        self.noting(result)
    }
}
