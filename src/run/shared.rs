//! Several products that share surfaces, written together.

use std::path::PathBuf;

use super::context::Context;
use super::context::memory;
use super::job;
use super::opened::open_surface;
use super::products::surface::{Source, SurfaceProduct, SurfaceRequest, surface_for};
use super::products::tin::ReplacedPoints;
use super::verbs::targets::{Outputs, Targets};
use super::verbs::{Keeps, Summary, SurfaceOptions, TileUse, WriteRequest};
use super::write::{self, SurfaceReport};
use crate::error::{Command, Error, Result, wording};
use crate::io::OutputSet;
use crate::terrain::Method;

/// Surfaces that several products are made of. Each is built or read once, when it is first needed.
///
/// A surface is named by the number that [`add`](Self::add) returned; methods panic for any other.
#[derive(Debug, Default)]
pub struct SharedSurfaces {
    memory: Option<u64>,
    list: Vec<SharedSurface>,
}

/// One of the surfaces that several products are made of.
#[derive(Debug)]
struct SharedSurface {
    request: SurfaceRequest,
    method: Method,
    /// The reason, if it has to be built in one piece.
    whole: Option<Error>,
    opened: Option<SurfaceProduct>,
}

/// An estimate of what a surface will need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceEstimate {
    /// The points that are used, as far as headers say.
    pub points: u64,
    /// The memory for all of them at once, in bytes.
    pub memory: u64,
    /// True if the surface is built in tiles and used in its files.
    pub in_files: bool,
}

impl SharedSurfaces {
    /// Returns a list without surfaces. Those that are built share this much memory, in bytes; if
    /// it is `None`, each takes up to half of what is free.
    pub fn new(memory: Option<u64>) -> Self {
        SharedSurfaces {
            memory,
            list: Vec::new(),
        }
    }

    /// Adds the surface of a request for heights by a method, unless it is there, and returns its
    /// number. `whole` is the reason if it has to be built in one piece.
    pub fn add(&mut self, request: &SurfaceRequest, method: Method, whole: Option<Error>) -> usize {
        let key = of_all_points(request);
        let has_all = needs_all(request, method);
        let same = self.list.iter().position(|known| {
            key.is_some()
                && of_all_points(&known.request) == key
                && has_all == needs_all(&known.request, known.method)
        });
        let number = same.unwrap_or_else(|| {
            self.list.push(SharedSurface {
                request: request.clone(),
                method: if has_all { method } else { Method::Linear },
                whole: None,
                opened: None,
            });
            self.list.len() - 1
        });
        let shared = &mut self.list[number];
        shared.whole = shared.whole.take().or(whole);
        if let (Source::Points(own), Source::Points(wanted)) =
            (&mut shared.request.source, &request.source)
            && wanted.replaced == ReplacedPoints::Keep
        {
            own.replaced = ReplacedPoints::Keep;
        }
        number
    }

    /// Returns how many surfaces there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns true if there are no surfaces.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the files that a surface is built or read from.
    pub fn files(&self, number: usize) -> Vec<PathBuf> {
        self.list[number].request.files()
    }

    /// Returns an estimate of what a surface will need; `None` if it is read from a file.
    ///
    /// # Errors
    /// If a file of points cannot be opened.
    pub fn estimate(&self, number: usize, context: &Context) -> Result<Option<SurfaceEstimate>> {
        let shared = &self.list[number];
        let Source::Points(_) = &shared.request.source else {
            return Ok(None);
        };
        let as_parts = WriteRequest::new(shared.request.clone(), SurfaceOptions::default());
        let points = job::points_used(&as_parts, context)?;
        let may_be_in_files = shared.whole.is_none() && shared.method == Method::Linear;
        Ok(Some(SurfaceEstimate {
            points,
            memory: memory::need_of(points),
            in_files: may_be_in_files
                && write::is_larger(&as_parts, self.memory_of_each(), context),
        }))
    }

    /// Builds or reads a surface. Returns what it is if that was not done before.
    ///
    /// # Errors
    /// Those of [`open_surface`].
    pub fn open(&mut self, number: usize, context: &Context) -> Result<Option<SurfaceReport>> {
        let memory = self.memory_of_each();
        let SharedSurface {
            request,
            method,
            whole,
            opened,
        } = &mut self.list[number];
        if opened.is_some() {
            return Ok(None);
        }
        let mut product = match whole {
            Some(why) => {
                write::without_tiles(memory, why, context);
                surface_for(*method, request, context)?
            }
            None => open_surface(request, *method, memory, context)?,
        };
        // The report takes it, but verbs and tables need it, too.
        let built = product.built.clone();
        let report = SurfaceReport::take(&mut product)?;
        product.built = built;
        *opened = Some(product);
        Ok(Some(report))
    }

    /// Returns a surface that is [open](Self::open).
    pub fn get(&self, number: usize) -> Option<&SurfaceProduct> {
        self.list[number].opened.as_ref()
    }

    /// Removes a surface from memory and its files from the disk: no other product needs it.
    pub fn close(&mut self, number: usize) {
        self.list[number].opened = None;
    }

    /// Returns the memory that was given, divided by the surfaces that are built.
    fn memory_of_each(&self) -> Option<u64> {
        let is_built = |shared: &&SharedSurface| matches!(shared.request.source, Source::Points(_));
        let built = self.list.iter().filter(is_built).count() as u64;
        self.memory.map(|all| all / built.max(1))
    }
}

/// Returns a text that is equal for requests of one surface, also if only one of them keeps the
/// points that water replaced; `None` for points in memory, which have no text.
fn of_all_points(request: &SurfaceRequest) -> Option<String> {
    let mut request = request.clone();
    if let Source::Points(points) = &mut request.source {
        points.replaced = ReplacedPoints::Drop;
    }
    serde_json::to_string(&request).ok()
}

/// Returns true if heights by a method need points that a surface within bounds leaves out.
fn needs_all(request: &SurfaceRequest, method: Method) -> bool {
    let has_bounds = match &request.source {
        Source::Points(points) => points.bounds.is_some(),
        Source::Mesh(_) | Source::Raster(_) => false,
    };
    has_bounds && method != Method::Linear
}

/// What a verb makes of a surface that other products share. Its outputs are checked.
#[derive(Debug)]
pub struct SharedProduct {
    request: WriteRequest,
    targets: Targets,
    outputs: Outputs,
}

impl SharedProduct {
    /// Checks a request and its outputs.
    ///
    /// # Errors
    /// Those of [`write()`](super::write()) before it builds the surface; and for a TIN in parts.
    pub fn new(request: WriteRequest, targets: Targets) -> Result<Self> {
        let verb = &request.verb;
        verb.check()?;
        verb.takes(&request.surface.source)?;
        let outputs = write::resolved(&request, &targets, &Default::default())?;
        if let (TileUse::Always, [target, ..]) =
            (verb.use_of_tiles(&outputs.targets)?, &outputs.targets[..])
        {
            return Err(Error::usage("a TIN in parts is written alone")
                .in_file(&target.path)
                .cure(wording![
                    "write it first, with ",
                    Command::Tin,
                    ", and name it as the surface of the others"
                ]));
        }
        Ok(SharedProduct {
            request,
            targets,
            outputs,
        })
    }

    /// Returns the surface that it is made of.
    pub fn surface(&self) -> &SurfaceRequest {
        &self.request.surface
    }

    /// Returns how heights between vertices are computed.
    pub fn method(&self) -> Method {
        self.request.verb.method()
    }

    /// Returns the reason if the surface has to be built in one piece: a table of how it was built
    /// is written, or its vertices and triangles, which have another order in a TIN in parts.
    pub fn needs_whole(&self) -> Option<Error> {
        let verb = &self.request.verb;
        write::refused(&self.targets).or_else(|| {
            match (verb.keeps(), verb.use_of_tiles(&self.outputs.targets)) {
                (Keeps::Triangles, Ok(TileUse::Never(why))) => Some(why),
                _ => None,
            }
        })
    }

    /// Returns all files that are read.
    pub fn reads(&self) -> Vec<PathBuf> {
        self.targets.with_lists(self.request.files())
    }

    /// Returns all files that are written, with those that formats write beside.
    pub fn writes(&self) -> Vec<PathBuf> {
        let mut files = self.outputs.files();
        files.extend(self.targets.tables().map(PathBuf::from));
        files
    }

    /// Makes it of a surface, and adds its files to a set.
    ///
    /// # Errors
    /// If it cannot be made or written, or the run is canceled. Nothing of the set appears then.
    pub fn write(
        &self,
        surface: &SurfaceProduct,
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Summary> {
        let outputs = Outputs {
            targets: self.outputs.targets.clone(),
            labels: self.outputs.labels.clone(),
            set: std::mem::take(set),
        };
        let other = self.request.instead_of(surface, context)?;
        let surface = other.as_ref().unwrap_or(surface);
        self.targets.write_tables(surface, &outputs.set)?;
        let summary = self.request.verb.write(surface, &outputs, context)?;
        *set = outputs.set;
        Ok(summary)
    }
}
