//! Contours of a raster that stays in its file: rows are searched one after another, and what they
//! say about each level waits in a file until its lines are joined.

use std::cell::RefCell;
use std::io::{Read, Seek, SeekFrom, Write};

use crate::data::ContourLine;
use crate::error::{Error, Result};
use crate::run::context::{Context, Size, Stage};
use crate::run::sources::raster_file::RasterFile;
use crate::terrain::contour::parts::{BendFinder, Bends, LevelParts, join_level, parts_of_rows};
use crate::terrain::{GridSurface, Levels};

/// Where parts wait: a file or memory.
pub(super) trait Scratch: Read + Write + Seek {}

impl<T: Read + Write + Seek> Scratch for T {}

/// Calls `take` for the lines, with the number of their edges. They are those of the raster in
/// memory.
///
/// # Errors
/// If a block of the raster is damaged, there are too many levels, the scratch file cannot be
/// written, or the run is canceled; and those of `take`.
///
/// # Complexity
/// Memory: that of some rows, of two million arcs in them (or those of one level, if it has more),
/// and of the lines of one level.
pub(super) fn draw<T>(
    raster: &RasterFile,
    levels: &Levels,
    scratch: Box<dyn Scratch>,
    context: &Context,
    take: impl FnOnce(&mut dyn Iterator<Item = ContourLine>, u64) -> Result<T>,
) -> Result<T> {
    let finding = context.start(Stage::FindingContours, Size::Uncounted)?;
    let mut found = FoundParts::new(scratch);
    let mut heights = [f64::INFINITY, f64::NEG_INFINITY];
    raster.each_rows(&mut |rows, first_row| {
        context.check()?;
        let surface = GridSurface::of_rows(rows, first_row)?;
        let [low, high] = parts_of_rows(&surface, levels, |parts| {
            context.check()?;
            found.add(parts)
        })?;
        heights = [heights[0].min(low), heights[1].max(high)];
        Ok(())
    })?;
    levels.within(heights[0], heights[1])?;
    finding.end()?;
    found.draw(context, take)
}

/// The parts of a level in the scratch file.
struct Block {
    level: f64,
    start: u64,
    length: usize,
    may_bend: bool,
}

/// The parts of all rows so far.
struct FoundParts {
    scratch: Box<dyn Scratch>,
    blocks: Vec<Block>,
    end: u64,
    /// The number of edges of all lines.
    edges: u64,
    /// Memory that is kept from one call of [`add`](Self::add) to the next.
    bytes: Vec<u8>,
}

impl FoundParts {
    fn new(scratch: Box<dyn Scratch>) -> Self {
        FoundParts {
            scratch,
            blocks: Vec::new(),
            end: 0,
            edges: 0,
            bytes: Vec::new(),
        }
    }

    fn add(&mut self, parts: &LevelParts) -> Result<()> {
        self.bytes.clear();
        parts.write(&mut self.bytes)?;
        self.scratch.write_all(&self.bytes)?;
        self.blocks.push(Block {
            level: parts.level(),
            start: self.end,
            length: self.bytes.len(),
            may_bend: parts.may_bend(),
        });
        self.end += self.bytes.len() as u64;
        self.edges += parts.edge_count() as u64;
        Ok(())
    }

    /// Returns where arcs are bent, lest they cross those of other levels.
    fn bends(&mut self, context: &Context) -> Result<Bends> {
        let mut finder = BendFinder::default();
        for blocks in self.blocks.chunk_by(|a, b| a.level == b.level) {
            if blocks.iter().any(|block| block.may_bend) {
                context.check()?;
                let (level, parts) = read(&mut self.scratch, blocks)?;
                finder.add(level, parts)?;
            }
        }
        Ok(finder.finish())
    }

    /// Joins the lines of each level, when they are asked for.
    fn draw<T>(
        mut self,
        context: &Context,
        take: impl FnOnce(&mut dyn Iterator<Item = ContourLine>, u64) -> Result<T>,
    ) -> Result<T> {
        self.blocks.sort_by(|a, b| a.level.total_cmp(&b.level));
        let bends = self.bends(context)?;
        let drawing = context.start(Stage::DrawingContours, Size::Items(self.edges))?;
        // Lines are taken by a writer, so an error has to wait until it ends.
        let failed = RefCell::new(Ok(()));
        let fail = |error: Error| *failed.borrow_mut() = Err(error);
        let scratch = &mut self.scratch;
        let mut lines = self
            .blocks
            .chunk_by(|a, b| a.level == b.level)
            .flat_map(|blocks| {
                let parts = read(scratch, blocks);
                let lines = parts.and_then(|(level, parts)| join_level(level, parts, &bends));
                lines.map_err(fail).unwrap_or_default()
            })
            .take_while(|line| failed.borrow().is_ok() && drawing.add(line.edge_count()).is_ok());
        let taken = take(&mut lines, self.edges);
        drop(lines);
        failed.into_inner()?;
        drawing.end()?;
        taken
    }
}

/// Reads the parts of a level.
fn read(scratch: &mut Box<dyn Scratch>, blocks: &[Block]) -> Result<(f64, Vec<LevelParts>)> {
    let level = blocks.first().map_or(0.0, |block| block.level);
    let mut bytes = Vec::new();
    let mut parts = Vec::new();
    for block in blocks {
        bytes.resize(block.length, 0);
        scratch.seek(SeekFrom::Start(block.start))?;
        scratch.read_exact(&mut bytes)?;
        parts.push(LevelParts::read(level, &bytes)?);
    }
    Ok((level, parts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Grid;
    use crate::io::geotiff;
    use crate::run::{ContourOptions, HillshadeOptions, Model, SurfaceProduct, contour, hillshade};
    use std::path::Path;

    #[test]
    fn a_raster_in_its_file_gives_the_lines_and_shades_of_one_in_memory() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/dem.tif");
        let open = || geotiff::open(&path).unwrap();
        let context = Context::default();
        let products = |model: Model| {
            let product = SurfaceProduct::from(model);
            let options = ContourOptions {
                interval: Some(0.25),
                ..ContourOptions::default()
            };
            let lines = contour(&product, &options, &context).unwrap();
            let shades = hillshade(&product, &HillshadeOptions::default(), &context).unwrap();
            let Grid { values, .. } = shades.collect(&context).unwrap();
            let shades: Vec<u64> = values.iter().map(|shade| shade.to_bits()).collect();
            (product.extent(), lines.collect(&context).unwrap(), shades)
        };
        let expected = products(Model::Raster(Box::new(open().read_grid().unwrap())));
        assert!(expected.1.len() > 1000);
        for rows in [1, 2, 37, 10_000] {
            let raster = RasterFile::new(open(), &|_| Ok(())).unwrap();
            let found = products(Model::RasterFile(Box::new(raster.with_rows(rows))));
            assert!(found == expected, "{rows} rows at a time");
        }
    }
}
