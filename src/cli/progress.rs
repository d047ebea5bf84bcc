//! How far the work has come: bars on a terminal, and sources that move them.

use std::fmt::Write;
use std::ops::Range;
use std::time::Duration;

use indicatif::style::ProgressTracker;
use indicatif::{HumanCount, MultiProgress, ProgressBar, ProgressState, ProgressStyle};

use super::talk::Talk;
use crate::crs::Crs;
use crate::data::{BlockSource, EdgeKind, Face, Frame, Surface, Window};
use crate::error::Result;

/// Work that is shown while it goes on; dropped, it is gone from the terminal.
#[derive(Debug)]
pub(super) struct Progress(ProgressBar);

/// How much of the work is known before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    /// So many items.
    Items(u64),
    /// Items are counted.
    Unknown,
    /// Nothing is counted.
    Uncounted,
}

impl Progress {
    pub(super) fn new(bars: &MultiProgress, what: &'static str, size: Size) -> Self {
        let (bar, template) = match size {
            Size::Items(count) => {
                (ProgressBar::new(count), "{msg} [{bar:30}] {human_pos} of {human_len}, {rate}, {eta} left")
            }
            Size::Unknown => (ProgressBar::no_length(), "{msg} {spinner} {human_pos}, {rate}, {elapsed}"),
            Size::Uncounted => (ProgressBar::no_length(), "{msg} {spinner} {elapsed}"),
        };
        let bar = bars.add(bar);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> ").with_key("rate", Rate));
        }
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress(bar)
    }

    /// Counts items that are done.
    pub(super) fn add(&self, items: u64) {
        self.0.inc(items);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Whole items a second.
#[derive(Clone)]
struct Rate;

impl ProgressTracker for Rate {
    fn clone_box(&self) -> Box<dyn ProgressTracker> {
        Box::new(self.clone())
    }

    fn tick(&mut self, _: &ProgressState, _: std::time::Instant) {}

    fn reset(&mut self, _: &ProgressState, _: std::time::Instant) {}

    fn write(&self, state: &ProgressState, out: &mut dyn Write) {
        // The text is shown or not; there is nobody to tell.
        let _ = write!(out, "{}/s", HumanCount(state.per_sec() as u64));
    }
}

/// A source whose progress shows while a writer or a check takes from it.
pub(super) struct Watched<'a, S: ?Sized> {
    source: &'a S,
    progress: Progress,
}

impl<'a> Watched<'a, dyn BlockSource + 'a> {
    /// Counts cells.
    pub(super) fn cells(source: &'a dyn BlockSource, what: &'static str, talk: &Talk) -> Self {
        let Frame { width, height, .. } = source.frame();
        Watched { source, progress: talk.progress(what, Size::Items(width as u64 * height as u64)) }
    }
}

impl<'a> Watched<'a, dyn Surface + 'a> {
    /// Counts faces, each of which is asked for so many times.
    pub(super) fn faces(source: &'a dyn Surface, times: u64, what: &'static str, talk: &Talk) -> Self {
        Watched { source, progress: talk.progress(what, Size::Items(times * source.face_count() as u64)) }
    }

    fn taken(&self, numbers: Range<u32>) {
        self.progress.add(numbers.len() as u64);
    }
}

impl BlockSource for Watched<'_, dyn BlockSource + '_> {
    fn frame(&self) -> Frame {
        self.source.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.source.fill(window, out)?;
        self.progress.add(window.width as u64 * window.height as u64);
        Ok(())
    }
}

impl Surface for Watched<'_, dyn Surface + '_> {
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

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.source.edge_kind(face, i)
    }

    fn has_lines(&self) -> bool {
        self.source.has_lines()
    }

    fn is_piece(&self, face: u32) -> bool {
        self.source.is_piece(face)
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn corners_in(&self, numbers: Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
        self.source.corners_in(numbers.clone(), faces);
        self.taken(numbers);
    }

    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        self.source.faces_in(numbers.clone(), faces);
        self.taken(numbers);
    }

    fn heights_in(&self, numbers: Range<u32>, is_wanted: &dyn Fn(f64, f64) -> bool, faces: &mut Vec<(u32, [f64; 3])>) {
        self.source.heights_in(numbers.clone(), is_wanted, faces);
        self.taken(numbers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::TalkArgs;
    use crate::data::{Grid, Mesh};
    use crate::io::{geotiff, mesh};
    use crate::terrain;

    fn talk() -> Talk {
        Talk::new(&TalkArgs { quiet: true, verbose: false, threads: None })
    }

    fn done(progress: &Progress) -> (u64, Option<u64>) {
        (progress.0.position(), progress.0.length())
    }

    #[test]
    fn bars_are_full_when_the_work_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let corners = vec![[0.0, 0.0, 1.0], [9.0, 0.0, 2.0], [9.0, 9.0, 3.0], [0.0, 9.0, 5.0]];
        let square = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]], &[], None).unwrap();
        for name in ["a.ply", "a.obj", "a.off", "a.stl"] {
            let watched = Watched::faces(&square, 2, "", &talk());
            mesh::write(folder.path().join(name).as_path(), &watched).unwrap();
            assert_eq!(done(&watched.progress), (4, Some(4)), "{name}");
        }
        let watched = Watched::faces(&square, 5, "", &talk());
        assert_eq!(terrain::surface_flaws(&watched), []);
        assert_eq!(done(&watched.progress), (10, Some(10)));

        let frame = Frame::north_up(0.0, 0.0, 1.0, 300, 20);
        let grid = Grid { frame, crs: None, values: vec![1.0; 6000] };
        let watched = Watched::cells(&grid, "", &talk());
        geotiff::write(folder.path().join("a.tif").as_path(), &watched, geotiff::WriteOptions::default()).unwrap();
        assert_eq!(done(&watched.progress), (6000, Some(6000)));
    }
}
