//! The context of a run: the monitor of its progress and notices, and the flag that cancels it.

pub(crate) mod event;
pub(crate) mod large_files;
pub(crate) mod memory;
pub(crate) mod notice;
mod notice_lists;
mod notice_systems;
mod notice_text;
pub(crate) mod units;
pub(crate) mod watched;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::error::{Error, Result, Wording};
use crate::run::context::event::Event;
use crate::run::context::notice::Notice;

/// A flag that is never set.
static NEVER: AtomicBool = AtomicBool::new(false);

/// The monitor of a run and the flag that cancels it. By default nothing is reported and nothing is
/// canceled.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Receives progress and notices as they occur.
    pub monitor: &'a dyn Monitor,
    /// The flag that cancels the run. When any thread sets it to true, the run soon returns an
    /// error of the kind [`Canceled`](crate::error::Kind::Canceled), and nothing is written.
    ///
    /// It is polled after each batch of points, each megabyte of a mesh or of a layer (GeoJSON:
    /// 1024 features), each few blocks of a raster, each range of 16 384 points and each 256
    /// sub-constraints of a triangulation, each 2048 faces that are written. It is not polled while
    /// points are sorted, the triangles of a file are linked, or the finished surface is clipped.
    pub cancel: &'a AtomicBool,
}

/// Receives progress and notices while a run works.
///
/// ```
/// use breakline::run::{Monitor, Notice, Progress, Size, Stage};
///
/// /// Prints every notice; progress is not shown.
/// struct Print;
///
/// impl Monitor for Print {
///     fn start(&self, _stage: Stage, _size: Size) -> Box<dyn Progress> {
///         Box::new(())
///     }
///
///     fn notice(&self, notice: &Notice) {
///         eprintln!("{notice:?}");
///     }
/// }
/// ```
pub trait Monitor: Sync {
    /// Called when a stage of the work begins. The returned value counts the items of the stage,
    /// and is dropped when the stage ends.
    fn start(&self, stage: Stage, size: Size) -> Box<dyn Progress>;

    /// Called for everything that is assumed or looks wrong, as soon as it is found.
    fn notice(&self, notice: &Notice);

    /// Called for what happens while files are written. Nobody has to show it.
    fn event(&self, _event: &Event) {}
}

/// Counts the items of a stage. `()` counts nothing.
pub trait Progress: Send + Sync {
    /// Adds items that are done. Called from many threads, between a few and some thousand times a
    /// second.
    fn add(&self, items: u64);
}

/// A stage of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// Points are read, counted in points.
    ReadingPoints,
    /// Points are read and written, counted in points read.
    WritingPoints,
    /// A vector layer is read, counted in bytes where the format allows it.
    ReadingLayer,
    /// A raster is read, counted in cells.
    ReadingCells,
    /// A mesh is read, counted in bytes.
    ReadingTriangles,
    /// Points and segments of the plane are read, counted in bytes.
    Reading,
    /// The ground is searched among points.
    FindingGround,
    /// Points and lines are triangulated.
    Triangulating,
    /// A surface is simplified.
    Simplifying,
    /// The surface is checked, counted in faces, once for each law.
    CheckingFaces,
    /// A mesh is written, counted in faces.
    WritingFaces,
    /// A raster is computed and written, counted in cells.
    WritingCells,
    /// A hillshade is computed and written, counted in cells.
    ShadingCells,
    /// The triangles that contours cross are searched.
    FindingContours,
    /// Contours are drawn and written, counted in edges of contours.
    DrawingContours,
    /// Terrain tiles are made and written, counted in tiles.
    WritingTiles,
    /// Files are written, without a count.
    Writing,
    /// Heights are computed, counted in positions.
    ComputingHeights,
    /// Volumes are computed, counted in faces, each of which is visited a few times.
    ComputingVolumes,
    /// The triangles of two surfaces are compared.
    ComparingTriangles,
    /// Lines are followed over a surface, counted in lines.
    FollowingLines,
    /// The tasks of a job run, counted in tasks.
    RunningTasks,
}

impl Stage {
    /// Returns what is done, as a text before a progress bar: "reading points".
    pub fn title(self) -> &'static str {
        match self {
            Stage::ReadingPoints => "reading points",
            Stage::WritingPoints => "writing points",
            Stage::ReadingLayer => "reading lines",
            Stage::ReadingCells => "reading cells",
            Stage::ReadingTriangles => "reading triangles",
            Stage::Reading => "reading",
            Stage::FindingGround => "finding the ground",
            Stage::Triangulating => "triangulating",
            Stage::Simplifying => "simplifying",
            Stage::CheckingFaces => "checking faces",
            Stage::WritingFaces => "writing faces",
            Stage::WritingCells => "writing cells",
            Stage::ShadingCells => "shading cells",
            Stage::FindingContours => "finding contours",
            Stage::DrawingContours => "drawing contours",
            Stage::WritingTiles => "writing tiles",
            Stage::Writing => "writing",
            Stage::ComputingHeights => "computing heights",
            Stage::ComputingVolumes => "computing volumes",
            Stage::ComparingTriangles => "comparing triangles",
            Stage::FollowingLines => "following lines",
            Stage::RunningTasks => "running tasks",
        }
    }
}

/// The number of items of a stage, if it is known when the stage begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// This many items.
    Items(u64),
    /// Items are counted, but their number is not known.
    Unknown,
    /// No items are counted.
    Uncounted,
}

/// A [`Monitor`] that ignores everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Monitor for Silent {
    fn start(&self, _stage: Stage, _size: Size) -> Box<dyn Progress> {
        Box::new(())
    }

    fn notice(&self, _notice: &Notice) {}
}

impl Progress for () {
    fn add(&self, _items: u64) {}
}

impl Default for Context<'_> {
    fn default() -> Self {
        Context {
            monitor: &Silent,
            cancel: &NEVER,
        }
    }
}

impl std::fmt::Debug for Context<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context")
            .field("cancel", &self.cancel)
            .finish_non_exhaustive()
    }
}

impl<'a> Context<'a> {
    /// Returns `Ok` as long as the run is not canceled.
    ///
    /// # Errors
    /// An error of the kind [`Canceled`](crate::error::Kind::Canceled) once the flag is set.
    pub fn check(&self) -> Result<()> {
        if self.cancel.load(Ordering::Relaxed) {
            Err(Error::canceled())
        } else {
            Ok(())
        }
    }

    /// Returns a context that reports nothing, and is canceled together with this one.
    pub(crate) fn quiet(&self) -> Self {
        Context {
            cancel: self.cancel,
            ..Context::default()
        }
    }

    /// Begins a stage; returns an error if the run is canceled.
    pub(crate) fn start(&self, stage: Stage, size: Size) -> Result<Work<'a>> {
        self.check()?;
        Ok(Work {
            progress: self.monitor.start(stage, size),
            context: *self,
        })
    }
}

/// A stage in progress; it ends when this is dropped.
pub(crate) struct Work<'a> {
    progress: Box<dyn Progress>,
    context: Context<'a>,
}

impl<'a> Work<'a> {
    /// A stage that is not reported.
    pub(crate) fn silent(context: &Context<'a>) -> Self {
        Work {
            progress: Box::new(()),
            context: *context,
        }
    }

    /// Counts items that are done; returns an error once the run is canceled.
    pub(crate) fn add(&self, items: u64) -> Result<()> {
        self.progress.add(items);
        self.context.check()
    }

    /// Ends the stage; returns an error if the run was canceled meanwhile.
    pub(crate) fn end(self) -> Result<()> {
        self.context.check()
    }
}

/// The context of a run that keeps its notices for the report.
pub(crate) struct Journal<'a> {
    pub(crate) context: Context<'a>,
    notices: Mutex<Vec<Notice>>,
}

impl<'a> Journal<'a> {
    pub(crate) fn new(context: &Context<'a>) -> Self {
        Journal {
            context: *context,
            notices: Mutex::default(),
        }
    }

    /// Adds a notice if there are classes that no point has. `unread` is the number of files that
    /// were not read.
    pub(crate) fn add_missing_classes(&self, missing: impl Iterator<Item = u8>, unread: usize) {
        let mut missing: Vec<u8> = missing.collect();
        missing.sort_unstable();
        missing.dedup();
        if !missing.is_empty() {
            self.add(Notice::NoPointOfClass {
                classes: missing,
                unread,
            });
        }
    }

    /// Passes a notice to the monitor and keeps it.
    pub(crate) fn add(&self, notice: Notice) {
        self.context.monitor.notice(&notice);
        self.notices
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(notice);
    }

    /// Adds the warnings that the reader of a file gave.
    pub(crate) fn add_warnings(&self, path: &Path, warnings: &[Wording]) {
        warnings
            .iter()
            .for_each(|text| self.add(Notice::Reader(path.to_path_buf(), text.clone())));
    }

    /// Begins a stage, see [`Context::start`].
    pub(crate) fn start(&self, stage: Stage, size: Size) -> Result<Work<'a>> {
        self.context.start(stage, size)
    }

    /// Removes and returns the notices so far.
    pub(crate) fn take(&self) -> Vec<Notice> {
        std::mem::take(&mut self.notices.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;
    use crate::run::{
        ContourOptions, DemOptions, HillshadeOptions, Input, Source, SurfaceRequest, TinRequest,
        check, contour, dem, hillshade, triangles, write_mesh,
    };

    /// Cancels when a given stage begins, and lists the stages.
    struct Canceler {
        cancel: AtomicBool,
        at: Option<Stage>,
        stages: Mutex<Vec<Stage>>,
    }

    impl Monitor for Canceler {
        fn start(&self, stage: Stage, _: Size) -> Box<dyn Progress> {
            self.cancel.store(self.at == Some(stage), Ordering::Relaxed);
            self.stages.lock().unwrap().push(stage);
            Box::new(())
        }

        fn notice(&self, _: &Notice) {}
    }

    /// Everything that can be done with a surface, into a folder.
    fn everything(folder: &Path, context: &Context) -> Result<()> {
        let points: Vec<[f64; 3]> = (0..400)
            .map(|i| [f64::from(i % 20), f64::from(i / 20), f64::from(i % 7)])
            .collect();
        let tin = TinRequest {
            points: vec![Input::of_points(&points, None)],
            ..TinRequest::default()
        };
        let request = SurfaceRequest {
            source: Source::Points(Box::new(tin)),
            ..SurfaceRequest::default()
        };
        let product = triangles(&request, context)?;
        contour(&product, &ContourOptions::default(), context)?
            .write(folder.join("a.geojson").as_path().into(), context)?;
        hillshade(&product, &HillshadeOptions::default(), context)?
            .write_picture(folder.join("a.png").as_path().into(), context)?;
        dem(&product, &DemOptions::default(), context)?
            .write(folder.join("a.tif").as_path().into(), context)?;
        write_mesh(
            product.triangles()?,
            folder.join("a.ply").as_path().into(),
            context,
        )?;
        check(&request, context).map(drop)
    }

    #[test]
    fn a_run_that_is_canceled_at_any_stage_is_an_error_and_writes_nothing_from_then_on() {
        let run = |at: Option<Stage>| {
            let folder = tempfile::tempdir().unwrap();
            let canceler = Canceler {
                cancel: AtomicBool::new(false),
                at,
                stages: Mutex::default(),
            };
            let context = Context {
                monitor: &canceler,
                cancel: &canceler.cancel,
            };
            let done = everything(folder.path(), &context);
            let files = std::fs::read_dir(folder.path()).unwrap().count();
            (done, files, canceler.stages.into_inner().unwrap())
        };
        let (done, all, stages) = run(None);
        done.unwrap();
        assert_eq!(all, 5, "the picture comes with a world file");
        for (stage, files) in [
            (Stage::ReadingPoints, 0),
            (Stage::Triangulating, 0),
            (Stage::FindingContours, 0),
            (Stage::DrawingContours, 0),
            (Stage::ShadingCells, 1),
            (Stage::WritingCells, 3),
            (Stage::WritingFaces, 4),
            (Stage::CheckingFaces, 5),
        ] {
            assert!(stages.contains(&stage), "{stage:?}");
            let (done, written, _) = run(Some(stage));
            assert_eq!(
                (done.unwrap_err().kind(), written),
                (Kind::Canceled, files),
                "{stage:?}"
            );
        }
    }
}
