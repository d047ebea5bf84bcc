//! The triangulations of the tasks as one surface: a TIN in parts.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::bytes::{NumberReader, put_u32};
use super::task_file::{TaskWriter, UNFINISHED};
use super::{Job, JobReport, Task};
use crate::data::{EdgeKind, LineEdges, Surface, SurfaceFacts};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::run::context::{Context, Size, Stage};
use crate::run::sources::checksum::{Summed, checksum};
use crate::run::sources::tin_parts::WrittenParts;
use crate::run::verbs::Keeps;
use crate::terrain::tiles::{TinPart, Work};
use crate::terrain::{CompactTin, PartCell, TinIndex, TinIndexPart};

/// The sections of a task: its triangulation, the cells in it that wait, and of the task that
/// decides about these, what each is.
const PART: &str = "part";
const WAITING: &str = "faces";
const KEPT: &str = "kept";

/// What the triangles of a task are in the surface, in the order in which they were found.
#[derive(Debug, Default)]
pub(super) struct PartFaces {
    decided: Vec<PartCell>,
    /// The positions of those that are decided later.
    waiting: Vec<u32>,
}

impl PartFaces {
    pub(super) fn add(&mut self, decided: PartCell) {
        self.decided.push(decided);
    }

    pub(super) fn wait(&mut self) {
        self.waiting.push(self.decided.len() as u32);
        self.decided.push(PartCell::Elsewhere);
    }

    /// Writes the triangulation and its faces. Without a triangulation, the triangles waited in
    /// other tasks, and only the decision about each is written.
    pub(super) fn finish(self, part: Option<TinPart>, writer: &mut TaskWriter) -> Result<()> {
        let Some(part) = part else {
            writer.begin(KEPT);
            return writer.put(&self.decided.into_iter().map(to_byte).collect::<Vec<_>>());
        };
        let mut waiting = Vec::with_capacity(4 * self.waiting.len());
        self.waiting
            .iter()
            .for_each(|&at| put_u32(&mut waiting, part.faces()[at as usize]));
        writer.begin(WAITING);
        writer.put(&waiting)?;
        writer.begin(PART);
        part.write(self.decided, writer)
    }
}

/// The byte that stands for what a cell is.
fn to_byte(decided: PartCell) -> u8 {
    match decided {
        PartCell::Under => 0,
        PartCell::Face => 1,
        PartCell::Elsewhere => 2,
    }
}

fn from_byte(byte: u8) -> Option<PartCell> {
    [PartCell::Under, PartCell::Face, PartCell::Elsewhere]
        .into_iter()
        .find(|&decided| to_byte(decided) == byte)
}

/// A vertex, by its tile and its number.
type VertexKey = [u32; 2];

/// An edge on a line, by its ends, the smaller first.
type LineEdge = ([VertexKey; 2], EdgeKind);

/// A part that was written, and what others may have, too.
struct Written {
    row: TinIndexPart,
    facts: SurfaceFacts,
    /// Vertices of triangles between tiles: those of this part.
    shared: Vec<VertexKey>,
    /// Edges on lines at the rim of the part.
    at_rim: Vec<LineEdge>,
}

/// Returns the folder and the files of the surface in parts that an index names, if they are its
/// own: an index may have been copied, or damaged.
fn parts_of(index: &Path, name: &str) -> Option<(PathBuf, Vec<PathBuf>)> {
    let TinIndex { folder, parts, .. } = TinIndex::from_text(&std::fs::read(index).ok()?).ok()?;
    let sum = folder.strip_prefix(name)?.strip_prefix('.')?;
    let is_own = sum.len() == 8 && sum.bytes().all(|byte| byte.is_ascii_hexdigit());
    let folder = index.with_file_name(folder);
    let files = parts
        .into_iter()
        .map(|part| folder.join(part.file))
        .collect();
    is_own.then_some((folder, files))
}

/// Returns true if a folder has all parts of an index, with their checksums.
fn has_all(folder: &Path, index: &TinIndex) -> bool {
    index.parts.iter().all(|part| {
        let bytes = std::fs::read(folder.join(&part.file));
        bytes.is_ok_and(|bytes| {
            bytes.len() as u64 == part.bytes && checksum(&bytes) == part.checksum
        })
    })
}

/// Returns true if an index and all its parts are there as they were written.
pub(super) fn has_all_parts(index: &Path) -> bool {
    let text = std::fs::read(index).ok();
    let read = text.and_then(|text| TinIndex::from_text(&text).ok());
    read.is_some_and(|read| has_all(&index.with_file_name(&read.folder), &read))
}

impl Job {
    /// Writes the surface as a TIN in parts, once all tasks are done: a folder with a file for each
    /// task, and the index `target`, which appears last.
    ///
    /// # Errors
    /// If a task is not done, if no triangle is left, if the job makes another product, if a file
    /// cannot be written, or if the run is canceled.
    ///
    /// # Complexity
    /// Linear in the triangles; in memory is one part for each thread.
    pub(super) fn write_surface(
        &self,
        report: &JobReport,
        target: Destination,
        context: &Context,
    ) -> Result<WrittenParts> {
        self.require_triangles(report)?;
        if !matches!(self.verb.keeps(), Keeps::Triangles) {
            return Err(Error::usage("the job makes no surface"));
        }
        let path = target.path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .ok_or_else(|| {
                Error::unsupported("the name is not valid Unicode, which the index of parts needs")
                    .in_file(path)
            })?;
        let superseded = parts_of(path, name);
        let parent = path
            .parent()
            .filter(|parent| !parent.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        let prefix = target.temporary_prefix();
        builder.prefix(&prefix).suffix(UNFINISHED);
        // Others may read the parts: only the umask limits who.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let staged = builder
            .tempdir_in(parent)
            .map_err(|e| Error::from(e).in_file(path))?;
        let parts = self.write_parts(staged.path(), report, context)?;
        let mut index = self.index_of(parts, report);
        index.folder = format!("{name}.{:08x}", checksum(index.to_text().as_bytes()));
        let folder = path.with_file_name(&index.folder);
        let is_there = folder.exists() && has_all(&folder, &index);
        if !is_there {
            let named = |e: std::io::Error| Error::from(e).in_file(&folder);
            if folder.exists() {
                // What is damaged goes with the temporary folder.
                let aside = builder.tempdir_in(parent).map_err(named)?;
                std::fs::rename(&folder, aside.path().join("damaged")).map_err(named)?;
            }
            std::fs::rename(staged.keep(), &folder).map_err(named)?;
        }
        let superseded = superseded.filter(|(old, _)| *old != folder);
        let written = WrittenParts::new(index, (!is_there).then_some(folder), superseded);
        let mut output = target.create()?;
        output
            .write_all(written.index.to_text().as_bytes())
            .map_err(|e| Error::from(e).in_file(path))?;
        target.put(output)?;
        Ok(written)
    }

    /// Writes the part of each task that has triangles, be they faces or not, those between tiles
    /// first: what they share with others is then known.
    fn write_parts(
        &self,
        folder: &Path,
        report: &JobReport,
        context: &Context,
    ) -> Result<Vec<Written>> {
        let decided = self.decided_at_rim()?;
        let is_leaf = |task: &usize| self.tile_of(*task).is_some();
        let (leaves, others): (Vec<usize>, Vec<usize>) =
            (self.first_step()..self.task_count()).partition(is_leaf);
        let writing = context.start(Stage::WritingFaces, Size::Items(report.triangles))?;
        let write = |task: &usize, shared: &FxHashSet<VertexKey>| {
            let decided = decided
                .get(*task - self.first_step())
                .map(Vec::as_slice)
                .unwrap_or_default();
            let part = self.write_part(*task, decided, shared, folder, report)?;
            writing.add(part.as_ref().map_or(0, |part| part.row.triangles))?;
            Ok(part)
        };
        let none = FxHashSet::default();
        let mut written: Vec<Written> = others
            .par_iter()
            .filter_map(|task| write(task, &none).transpose())
            .collect::<Result<_>>()?;
        let shared: FxHashSet<VertexKey> = written
            .iter()
            .flat_map(|part| part.shared.iter().copied())
            .collect();
        let of_leaves: Vec<Written> = leaves
            .par_iter()
            .filter_map(|task| write(task, &shared).transpose())
            .collect::<Result<_>>()?;
        written.extend(of_leaves);
        writing.end()?;
        Ok(written)
    }

    /// The tile that a task triangulates; `None` for other tasks.
    pub(super) fn tile_of(&self, task: usize) -> Option<u32> {
        match self.task(task) {
            Task::Triangulate(step) => match self.steps[step].work {
                Work::Leaf(tile) => Some(tile),
                Work::Merge(_) => None,
            },
            Task::Divide(_) | Task::Lines | Task::Rim | Task::Cut => None,
        }
    }

    /// Returns, for each step, what each of its triangles that waited is.
    fn decided_at_rim(&self) -> Result<Vec<Vec<PartCell>>> {
        let mut all = vec![Vec::new(); self.steps.len()];
        let Some(rim) = self.rim_task() else {
            return Ok(all);
        };
        let mut rim = self.open_task(rim)?;
        let decided = rim.section(KEPT)?;
        let mut rest = &decided[..];
        for (step, cells) in all.iter_mut().enumerate() {
            let count = self.open_task(self.task_of_step(step))?.facts.waiting as usize;
            let (own, others) = rest.split_at_checked(count).ok_or_else(|| rim.damaged())?;
            *cells = own
                .iter()
                .map(|&byte| from_byte(byte))
                .collect::<Option<_>>()
                .ok_or_else(|| rim.damaged())?;
            rest = others;
        }
        if !rest.is_empty() {
            return Err(rim.damaged());
        }
        Ok(all)
    }

    fn write_part(
        &self,
        task: usize,
        decided: &[PartCell],
        shared: &FxHashSet<VertexKey>,
        folder: &Path,
        report: &JobReport,
    ) -> Result<Option<Written>> {
        let mut file_of_task = self.open_task(task)?;
        let bytes = file_of_task.section(PART)?;
        if bytes.is_empty() {
            return Ok(None);
        }
        let waiting = file_of_task.section(WAITING)?;
        let mut reader = NumberReader::new(&waiting);
        let mut cells = Vec::with_capacity(decided.len());
        for &decided in decided {
            cells.push((reader.u32().ok_or_else(|| file_of_task.damaged())?, decided));
        }
        let mut tin = CompactTin::open_with_cells(bytes, &self.task_file(task).path, &cells)?;
        tin.set_crs(report.crs.clone());
        let facts = tin.facts().clone();
        if !tin.has_triangles() {
            return Ok(None);
        }
        let tile = self.tile_of(task);
        let file = format!("{:06}.tin", task - self.first_step());
        let path = folder.join(&file);
        let written = || -> Result<Summed<_>> {
            let mut out = Summed::new(BufWriter::with_capacity(1 << 18, File::create_new(&path)?));
            tin.write_tin(&mut out)?;
            out.flush()?;
            Ok(out)
        };
        let out = written().map_err(|e| e.in_file(&path))?;
        let (bytes, checksum) = (out.length(), out.sum());
        let row = TinIndexPart {
            file,
            tile,
            bytes,
            checksum,
            triangles: facts.triangles as u64,
            extent: facts.extent,
        };
        let is_shared = |key: &VertexKey| tile.is_none() || shared.contains(key);
        Ok(Some(Written {
            row,
            facts,
            shared: used_vertices(&tin, is_shared),
            at_rim: line_edges_at_rim(&tin),
        }))
    }

    /// Puts together what is true of the whole, without the name of the folder.
    fn index_of(&self, parts: Vec<Written>, report: &JobReport) -> TinIndex {
        let mut facts = SurfaceFacts {
            vertices: 0,
            triangles: 0,
            edges: LineEdges::default(),
            extent: report.extent,
        };
        let (mut shared, mut at_rim) = (FxHashSet::default(), FxHashMap::default());
        let mut rows = Vec::with_capacity(parts.len());
        for part in parts {
            facts.triangles += part.facts.triangles;
            facts.vertices += part.facts.vertices - part.shared.len();
            shared.extend(part.shared);
            for (kind, count) in part.facts.edges.kinds() {
                let own = part
                    .at_rim
                    .iter()
                    .filter(|(_, of_edge)| *of_edge == kind)
                    .count();
                facts.edges.add_edges(kind, count - own);
            }
            at_rim.extend(part.at_rim);
            rows.push(part.row);
        }
        facts.vertices += shared.len();
        at_rim
            .values()
            .for_each(|kind| facts.edges.add_edges(*kind, 1));
        rows.sort_unstable_by(|a: &TinIndexPart, b| a.file.cmp(&b.file));
        TinIndex {
            crs: report.crs.clone(),
            facts,
            area: report.area,
            folder: String::new(),
            parts: rows,
        }
    }
}

/// Returns the keys of those vertices that faces use and that others may have, too.
fn used_vertices(
    tin: &CompactTin<Vec<u8>>,
    is_shared: impl Fn(&VertexKey) -> bool,
) -> Vec<VertexKey> {
    let mut is_used = vec![false; tin.vertex_count()];
    for face in 0..tin.face_count() as u32 {
        tin.face(face)
            .into_iter()
            .flatten()
            .for_each(|vertex| is_used[vertex as usize] = true);
    }
    let used = (0..)
        .zip(is_used)
        .filter(|(_, is_used)| *is_used)
        .map(|(vertex, _)| vertex);
    used.filter_map(|vertex| tin.number_in_parts(vertex))
        .filter(is_shared)
        .collect()
}

/// Returns the edges on lines that have a face on one side only: another part may have one beyond.
fn line_edges_at_rim(tin: &CompactTin<Vec<u8>>) -> Vec<LineEdge> {
    let mut edges = Vec::new();
    if !tin.has_lines() {
        return edges;
    }
    for face in 0..tin.face_count() as u32 {
        let Some(corners) = tin.face(face) else {
            continue;
        };
        for i in 0..3 {
            let kind = tin.edge_kind(face, i);
            if kind.is_constrained() && tin.neighbor(face, i).is_none() {
                let ends = [corners[(i + 1) % 3], corners[(i + 2) % 3]]
                    .map(|vertex| tin.number_in_parts(vertex));
                if let [Some(a), Some(b)] = ends {
                    edges.push(([a.min(b), a.max(b)], kind));
                }
            }
        }
    }
    edges
}
