//! Writes points as text.

use std::io::Write;

use crate::data::{PointBatch, PointInfo, PointSink, PointSummary};
use crate::error::{Error, Result};
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::output::{Destination, Output};

/// A writer of points as text, made by [`create`].
#[derive(Debug)]
pub struct TextWriter<'a> {
    target: Destination<'a>,
    output: Output,
    separator: char,
    has_classes: bool,
    line: Vec<u8>,
    summary: PointSummary,
}

/// Starts a text file with one point per line; the numbers read back as the same doubles.
///
/// With the extension `.csv` the file has a header and commas as separators, and the class as the
/// fourth column if all sources have it. Otherwise it has x, y and z separated by blanks.
///
/// # Errors
/// If the target cannot be written.
pub fn create<'a>(
    target: impl Into<Destination<'a>>,
    sources: &[&PointInfo],
) -> Result<TextWriter<'a>> {
    let target = target.into();
    let is_table = target
        .format_path()
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let has_classes = is_table && sources.iter().all(|info| info.has_classes);
    let mut output = target.create()?;
    let header = match (is_table, has_classes) {
        (false, _) => "",
        (true, false) => "x,y,z\n",
        (true, true) => "x,y,z,class\n",
    };
    output
        .write_all(header.as_bytes())
        .map_err(|e| Error::from(e).in_file(target.path()))?;
    let separator = if is_table { ',' } else { ' ' };
    Ok(TextWriter {
        target,
        output,
        separator,
        has_classes,
        line: Vec::new(),
        summary: PointSummary::default(),
    })
}

impl PointSink for TextWriter<'_> {
    fn next_source(&mut self, _: &PointInfo) -> Result<()> {
        Ok(())
    }

    fn write(&mut self, batch: &PointBatch) -> Result<()> {
        let TextWriter {
            output,
            separator,
            line,
            ..
        } = self;
        let mut write = || -> std::io::Result<()> {
            for i in 0..batch.len() {
                line.clear();
                let [x, y, z] = [batch.x[i], batch.y[i], batch.z[i]].map(Decimal);
                write!(line, "{x}{separator}{y}{separator}{z}")?;
                if self.has_classes {
                    write!(line, "{separator}{}", batch.class[i])?;
                }
                line.push(b'\n');
                output.write_all(line)?;
                self.summary
                    .bounds
                    .add([batch.x[i], batch.y[i], batch.z[i]]);
            }
            Ok(())
        };
        write().map_err(|e| Error::from(e).in_file(self.target.path()))?;
        self.summary.count += batch.len() as u64;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<PointSummary> {
        self.target.put(self.output)?;
        Ok(self.summary)
    }
}
