//! Reading that reports progress and can be canceled.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};

/// A function that is called while a file is read, with what was read since the last call: bytes of
/// a file, or cells of a raster; 0 if nothing was counted. Reading ends with the error that it
/// returns.
pub type Watch<'a> = &'a (dyn Fn(u64) -> Result<()> + Sync);

/// A [`Watch`] that never ends anything.
pub(crate) fn unwatched(_: u64) -> Result<()> {
    Ok(())
}

/// Bytes between two calls: some milliseconds of parsing.
const OFTEN: u64 = 1 << 20;

/// Passes on how many bytes of a file were parsed, from time to time.
#[derive(Clone, Copy)]
pub(crate) struct Meter<'a> {
    watch: Watch<'a>,
    /// The bytes that were left at the last call.
    left: u64,
}

impl<'a> Meter<'a> {
    /// Starts with this many bytes to parse.
    pub(crate) fn new(watch: Watch<'a>, left: usize) -> Self {
        Meter {
            watch,
            left: left as u64,
        }
    }

    /// Reports the bytes that are left.
    ///
    /// # Errors
    /// That of the watch.
    #[inline]
    pub(crate) fn left(&mut self, left: usize) -> Result<()> {
        let parsed = self.left.saturating_sub(left as u64);
        if parsed < OFTEN {
            return Ok(());
        }
        self.left = left as u64;
        (self.watch)(parsed)
    }
}

/// Returns the bytes of a file. The watch is called between parts, but nothing is counted: parsing
/// takes longer.
///
/// # Errors
/// If the file cannot be read; that of the watch.
pub(crate) fn bytes_of(path: &Path, watch: Watch) -> Result<Vec<u8>> {
    const PART: u64 = 1 << 24;
    let failed = |e: std::io::Error| Error::from(e).in_file(path);
    let mut file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // Exact for a file, and no more than a hint: a device or a pipe states 0.
    let stated = file.metadata().map_err(failed)?.len();
    bytes
        .try_reserve_exact(
            usize::try_from(stated)
                .unwrap_or(usize::MAX)
                .saturating_add(1),
        )
        .map_err(|_| Error::limit(format!("not enough memory for {stated} bytes")).in_file(path))?;
    while file
        .by_ref()
        .take(PART)
        .read_to_end(&mut bytes)
        .map_err(failed)?
        > 0
    {
        watch(0)?;
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn bytes_are_reported_in_parts_and_an_error_ends_reading() {
        let sum = AtomicU64::new(0);
        let watch = |bytes| {
            let before = sum.fetch_add(bytes, Ordering::Relaxed);
            if before + bytes > 3 << 20 {
                Err(Error::canceled())
            } else {
                Ok(())
            }
        };
        let mut meter = Meter::new(&watch, 10 << 20);
        meter.left((10 << 20) - 1).unwrap();
        assert_eq!(sum.load(Ordering::Relaxed), 0);
        meter.left((10 << 20) - (2 << 20)).unwrap();
        assert_eq!(sum.load(Ordering::Relaxed), 2 << 20);
        meter.left((7 << 20) + 1).unwrap();
        assert!(meter.left(5 << 20).is_err());

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, vec![7; 1 << 25]).unwrap();
        assert_eq!(bytes_of(&path, &unwatched).unwrap(), vec![7; 1 << 25]);
        let error = bytes_of(&path, &|_| Err(Error::canceled())).unwrap_err();
        assert_eq!(error.to_string(), "canceled");
    }
}
