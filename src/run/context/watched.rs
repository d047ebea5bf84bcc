//! Sources that report progress, and that end when the run is canceled.

use std::io::{self, Write};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::crs::Crs;
use crate::data::{BlockSource, Census, EdgeKind, Face, FaceAcross, Frame, Surface, Window};
use crate::error::{Error, Result};
use crate::run::context::{Context, Size, Stage, Work};

/// A source that reports progress while a writer or a check reads from it.
///
/// When the run is canceled, a source of cells returns an error. A surface returns empty batches of
/// faces, so that the reader soon ends; [`end`](Self::end) then returns the error.
pub(crate) struct Watched<'a, S: ?Sized> {
    source: &'a S,
    work: Work<'a>,
    /// Kept here, so that no faces are returned again if the flag is cleared.
    is_canceled: AtomicBool,
}

impl<'a, S: ?Sized> Watched<'a, S> {
    fn new(source: &'a S, stage: Stage, size: Size, context: &Context<'a>) -> Result<Self> {
        Ok(Watched {
            source,
            work: context.start(stage, size)?,
            is_canceled: AtomicBool::new(false),
        })
    }

    /// Counts faces; returns false once the run is canceled.
    fn goes_on(&self, faces: usize) -> bool {
        if self.work.add(faces as u64).is_err() {
            self.is_canceled.store(true, Ordering::Relaxed);
        }
        !self.is_canceled.load(Ordering::Relaxed)
    }
}

impl<'a, S: BlockSource + ?Sized> Watched<'a, S> {
    /// A source of cells that reports progress in cells.
    pub(crate) fn cells(source: &'a S, stage: Stage, context: &Context<'a>) -> Result<Self> {
        let Frame { width, height, .. } = source.frame();
        Self::new(
            source,
            stage,
            Size::Items(width as u64 * height as u64),
            context,
        )
    }
}

impl<'a, S: Surface + ?Sized> Watched<'a, S> {
    /// A surface that reports progress in faces, each of which is visited `times` times.
    pub(crate) fn faces(
        source: &'a S,
        times: u64,
        stage: Stage,
        context: &Context<'a>,
    ) -> Result<Self> {
        Self::new(
            source,
            stage,
            Size::Items(times * source.face_count() as u64),
            context,
        )
    }

    /// Ends the stage.
    ///
    /// # Errors
    /// If the run was canceled, or something in the surface was found damaged; what was read from
    /// it is then incomplete.
    pub(crate) fn end(self) -> Result<()> {
        if self.is_canceled.into_inner() {
            return Err(Error::canceled());
        }
        self.work.end()?;
        self.source.ensure_intact()
    }

    /// A surface that is part of a stage in progress and reports nothing itself.
    pub(crate) fn polled(source: &'a S, context: &Context<'a>) -> Result<Self> {
        context.check()?;
        Ok(Watched {
            source,
            work: Work::silent(context),
            is_canceled: AtomicBool::new(false),
        })
    }
}

impl<S: BlockSource + ?Sized> BlockSource for Watched<'_, S> {
    fn frame(&self) -> Frame {
        self.source.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.source.fill(window, out)?;
        self.work.add(window.width as u64 * window.height as u64)
    }
}

impl<S: Surface + ?Sized> Surface for Watched<'_, S> {
    fn vertex_count(&self) -> usize {
        self.source.vertex_count()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.source.position(vertex)
    }

    fn face_count(&self) -> usize {
        self.source.face_count()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.source.face(face)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        self.source.neighbor(face, i)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        self.source.across(face, i)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.source.edge_kind(face, i)
    }

    fn has_lines(&self) -> bool {
        self.source.has_lines()
    }

    fn is_fragment(&self, face: u32) -> bool {
        self.source.is_fragment(face)
    }

    fn is_between(&self, vertex: u32) -> bool {
        self.source.is_between(vertex)
    }

    fn least_width(&self) -> f64 {
        self.source.least_width()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn ensure_intact(&self) -> Result<()> {
        self.source.ensure_intact()
    }

    fn faces_at(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        self.source.faces_at(q, near, faces)
    }

    fn write_tin(&self, out: &mut dyn Write) -> Result<()> {
        self.source.write_tin(&mut Polled {
            out,
            work: &self.work,
        })
    }

    fn census(&self) -> Census {
        if self.goes_on(self.source.face_count()) {
            return self.source.census();
        }
        Census {
            used: vec![false; self.source.vertex_count()],
            ..Census::default()
        }
    }

    fn corners_in(&self, numbers: Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
        if self.goes_on(numbers.len()) {
            self.source.corners_in(numbers, faces);
        }
    }

    fn triangles_in(&self, numbers: Range<u32>, triangles: &mut Vec<(u32, [[f64; 3]; 3])>) {
        if self.goes_on(numbers.len()) {
            self.source.triangles_in(numbers, triangles);
        }
    }

    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        if self.goes_on(numbers.len()) {
            self.source.faces_in(numbers, faces);
        }
    }

    fn heights_in(
        &self,
        numbers: Range<u32>,
        is_wanted: &dyn Fn(f64, f64) -> bool,
        faces: &mut Vec<(u32, [f64; 3])>,
    ) {
        if self.goes_on(numbers.len()) {
            self.source.heights_in(numbers, is_wanted, faces);
        }
    }
}

/// A writer that fails once the run is canceled.
struct Polled<'a, 'b> {
    out: &'a mut dyn Write,
    work: &'a Work<'b>,
}

impl Write for Polled<'_, '_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.work.add(0).map_err(io::Error::other)?;
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Grid, Mesh};
    use crate::error::Kind;
    use crate::io::{geotiff, mesh};
    use crate::run::context::notice::Notice;
    use crate::run::context::{Monitor, Progress};
    use crate::terrain;
    use std::sync::Arc;
    use std::sync::atomic::AtomicU64;

    /// Counts what is done of the last stage.
    #[derive(Default)]
    struct Counter(Arc<AtomicU64>);

    impl Monitor for Counter {
        fn start(&self, _: Stage, _: Size) -> Box<dyn Progress> {
            self.0.store(0, Ordering::Relaxed);
            Box::new(Items(self.0.clone()))
        }

        fn notice(&self, _: &Notice) {}
    }

    struct Items(Arc<AtomicU64>);

    impl Progress for Items {
        fn add(&self, items: u64) {
            self.0.fetch_add(items, Ordering::Relaxed);
        }
    }

    fn square() -> Mesh {
        let corners = vec![
            [0.0, 0.0, 1.0],
            [9.0, 0.0, 2.0],
            [9.0, 9.0, 3.0],
            [0.0, 9.0, 5.0],
        ];
        Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]], &[], None).unwrap()
    }

    #[test]
    fn all_items_are_counted_when_the_work_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let counter = Counter::default();
        let context = Context {
            monitor: &counter,
            ..Context::default()
        };
        let done = || counter.0.load(Ordering::Relaxed);
        let square = square();
        for name in ["a.ply", "a.obj", "a.off", "a.stl"] {
            let watched = Watched::faces(&square, 2, Stage::WritingFaces, &context).unwrap();
            mesh::write(folder.path().join(name).as_path(), &watched).unwrap();
            assert_eq!(done(), 4, "{name}");
        }
        let watched = Watched::faces(&square, 7, Stage::CheckingFaces, &context).unwrap();
        assert_eq!(terrain::surface_flaws(&watched), []);
        assert_eq!(done(), 14);

        let frame = Frame::north_up(0.0, 0.0, 1.0, 300, 20);
        let grid = Grid {
            frame,
            crs: None,
            values: vec![1.0; 6000],
        };
        let watched = Watched::cells(&grid, Stage::WritingCells, &context).unwrap();
        geotiff::write(
            folder.path().join("a.tif").as_path(),
            &watched,
            geotiff::WriteOptions::default(),
        )
        .unwrap();
        assert_eq!(done(), 6000);
    }

    #[test]
    fn a_tin_is_written_until_the_run_is_canceled() {
        let mut builder = terrain::TinBuilder::default();
        builder.add_points(&[0.0, 9.0, 9.0], &[0.0, 0.0, 9.0], &[1.0; 3]);
        let tin = builder.build().unwrap();
        let cancel = AtomicBool::new(false);
        let context = Context {
            cancel: &cancel,
            ..Context::default()
        };
        let watched = Watched::faces(&tin, 2, Stage::WritingFaces, &context).unwrap();
        watched.write_tin(&mut Vec::new()).unwrap();
        cancel.store(true, Ordering::Relaxed);
        assert!(watched.write_tin(&mut Vec::new()).is_err());
        assert_eq!(watched.end().unwrap_err().kind(), Kind::Canceled);
    }

    #[test]
    fn a_canceled_source_gives_no_more_and_stays_canceled() {
        let cancel = AtomicBool::new(false);
        let context = Context {
            cancel: &cancel,
            ..Context::default()
        };
        let square = square();
        let watched = Watched::faces(&square, 1, Stage::WritingFaces, &context).unwrap();
        let faces = || {
            let mut faces = Vec::new();
            watched.corners_in(0..2, &mut faces);
            faces.len()
        };
        assert_eq!(faces(), 2);
        cancel.store(true, Ordering::Relaxed);
        assert_eq!(faces(), 0);
        cancel.store(false, Ordering::Relaxed);
        assert_eq!(faces(), 0);
        assert_eq!(watched.end().unwrap_err().kind(), Kind::Canceled);

        let grid = Grid {
            frame: Frame::north_up(0.0, 0.0, 1.0, 2, 2),
            crs: None,
            values: vec![1.0; 4],
        };
        let watched = Watched::cells(&grid, Stage::WritingCells, &context).unwrap();
        cancel.store(true, Ordering::Relaxed);
        let error = watched
            .fill(grid.frame.window(), &mut [0.0; 4])
            .unwrap_err();
        assert_eq!(error.kind(), Kind::Canceled);
        assert!(Watched::cells(&grid, Stage::WritingCells, &context).is_err());
    }
}
