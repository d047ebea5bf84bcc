//! Records of points, in memory or in a file without a name.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};

/// Bytes that are read of a file at once, about.
const BLOCK: usize = 1 << 20;

/// Records of one length, in the order in which they were added.
#[derive(Debug)]
pub(super) struct List {
    stride: usize,
    body: Body,
    bytes: u64,
}

#[derive(Debug)]
enum Body {
    Held(Vec<u8>),
    Filed(BufWriter<File>),
}

impl List {
    /// Returns a list of these records, in memory.
    pub(super) fn held(stride: usize, records: Vec<u8>) -> Self {
        List {
            stride,
            bytes: records.len() as u64,
            body: Body::Held(records),
        }
    }

    /// Returns an empty list in a file, which has to be empty, too.
    pub(super) fn filed(stride: usize, file: File) -> Self {
        List {
            stride,
            body: Body::Filed(BufWriter::new(file)),
            bytes: 0,
        }
    }

    /// Moves the records to a file.
    pub(super) fn file(self, file: File) -> io::Result<Self> {
        let mut filed = List::filed(self.stride, file);
        if let Body::Held(held) = &self.body {
            filed.push(held)?;
            return Ok(filed);
        }
        Ok(self)
    }

    /// Adds whole records.
    pub(super) fn push(&mut self, records: &[u8]) -> io::Result<()> {
        self.bytes += records.len() as u64;
        match &mut self.body {
            Body::Held(held) => held.extend_from_slice(records),
            Body::Filed(file) => file.write_all(records)?,
        }
        Ok(())
    }

    pub(super) fn is_held(&self) -> bool {
        matches!(self.body, Body::Held(_))
    }

    /// Returns the bytes of all records.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns how many records there are.
    pub(super) fn count(&self) -> u64 {
        self.bytes / self.stride as u64
    }

    /// Calls a function with each record and its number.
    pub(super) fn each(
        &mut self,
        mut take: impl FnMut(u64, &[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let stride = self.stride;
        let mut numbers = 0..;
        let mut block = |records: &[u8]| {
            let mut numbered = records.chunks_exact(stride).zip(&mut numbers);
            numbered.try_for_each(|(record, number)| take(number, record))
        };
        match &mut self.body {
            Body::Held(held) => block(held),
            Body::Filed(file) => {
                file.flush()?;
                let file = file.get_mut();
                file.rewind()?;
                let size = (BLOCK / stride).max(1) * stride;
                let mut records = Vec::with_capacity(size);
                let mut left = self.bytes;
                while left > 0 {
                    records.clear();
                    file.take(left.min(size as u64)).read_to_end(&mut records)?;
                    if records.is_empty() {
                        return Err(io::ErrorKind::UnexpectedEof.into());
                    }
                    left -= records.len() as u64;
                    block(&records)?;
                }
                Ok(())
            }
        }
    }

    /// Returns all records in memory.
    pub(super) fn into_bytes(self) -> io::Result<Vec<u8>> {
        match self.body {
            Body::Held(held) => Ok(held),
            Body::Filed(file) => {
                let mut file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
                file.rewind()?;
                let mut records = Vec::with_capacity(self.bytes as usize);
                file.read_to_end(&mut records)?;
                Ok(records)
            }
        }
    }
}
