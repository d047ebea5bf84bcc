//! Checksums of what jobs and surfaces in parts write.

use std::io::{Read, Result, Write};

use flate2::Crc;

/// Returns the CRC-32 of some bytes.
pub(crate) fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = Crc::new();
    sum.update(bytes);
    sum.sum()
}

/// Returns the length and the CRC-32 of what is left to read of a file.
pub(crate) fn sum_of_file(file: &mut impl Read) -> Result<(u64, u32)> {
    let mut summed = Summed::new(std::io::sink());
    std::io::copy(
        &mut std::io::BufReader::with_capacity(1 << 18, file),
        &mut summed,
    )?;
    Ok((summed.length(), summed.sum()))
}

/// A writer that sums up what goes through it.
pub(crate) struct Summed<W> {
    out: W,
    sum: Crc,
    length: u64,
}

impl<W: Write> Summed<W> {
    pub(crate) fn new(out: W) -> Self {
        Summed {
            out,
            sum: Crc::new(),
            length: 0,
        }
    }

    /// Returns the CRC-32 of all bytes so far.
    pub(crate) fn sum(&self) -> u32 {
        self.sum.sum()
    }

    /// Returns the CRC-32 of the bytes since it was called last.
    pub(crate) fn take_sum(&mut self) -> u32 {
        let sum = self.sum.sum();
        self.sum.reset();
        sum
    }

    /// Returns the number of bytes so far. It is counted here because a checksum counts in 32 bits.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    pub(crate) fn into_inner(self) -> W {
        self.out
    }
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.out.write_all(bytes)?;
        self.sum.update(bytes);
        self.length += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        self.out.flush()
    }
}
