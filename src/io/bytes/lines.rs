//! Lines of text that are made by all threads, and rows of bytes.

use std::io::{Result, Write};

use rayon::prelude::*;

use crate::io::Output;

/// Lines that a task writes; there are as many tasks at a time as cores.
const LINES: usize = 1 << 14;

/// Rows of bytes that are put together before they are written.
const ROWS: usize = 1 << 14;

/// Writes rows of bytes, many at a time.
pub(crate) fn write_rows<const N: usize>(
    output: &mut dyn Write,
    rows: impl Iterator<Item = [u8; N]>,
) -> Result<()> {
    let mut batch: Vec<u8> = Vec::with_capacity(N * ROWS);
    for row in rows {
        batch.extend_from_slice(&row);
        if batch.len() >= N * ROWS {
            output.write_all(&batch)?;
            batch.clear();
        }
    }
    output.write_all(&batch)
}

/// Returns the row of three numbers, given by their bytes.
pub(crate) fn row_of([a, b, c]: [[u8; 4]; 3]) -> [u8; 12] {
    let mut row = [0; 12];
    row[..4].copy_from_slice(&a);
    row[4..8].copy_from_slice(&b);
    row[8..].copy_from_slice(&c);
    row
}

/// Writes one line per item, in order, using all threads.
pub(crate) fn write_lines<T: Copy + Sync>(
    output: &mut Output,
    mut items: impl Iterator<Item = T>,
    line: impl Fn(&mut Vec<u8>, T) -> Result<()> + Sync,
) -> Result<()> {
    let mut batch = Vec::new();
    loop {
        batch.clear();
        batch.extend(items.by_ref().take(LINES * rayon::current_num_threads()));
        if batch.is_empty() {
            return Ok(());
        }
        let texts: Vec<Result<Vec<u8>>> = batch
            .par_chunks(LINES)
            .map(|chunk| {
                let mut text = Vec::with_capacity(chunk.len() * 40);
                chunk.iter().try_for_each(|&item| line(&mut text, item))?;
                Ok(text)
            })
            .collect();
        for text in texts {
            output.write_all(&text?)?;
        }
    }
}
