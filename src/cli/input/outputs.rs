//! The files of results, checked before the work starts.

use std::path::{Path, PathBuf};

use super::args::OutputArgs;
use super::inputs::{file_of, identity};
use super::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::describe;
use crate::data::BlockSource;
use crate::error::{Error, Result};
use crate::io::formats::{self, Product};
use crate::io::mesh::MeshSummary;
use crate::io::{self, Destination, Output, OutputSet};
use crate::run::units::bytes;
use crate::run::{self, CellProduct, SurfaceProduct};

/// DEFLATE seldom makes heights smaller than by this factor.
const BEST_COMPRESSION: f64 = 10.0;

/// A file format that a verb can write.
#[derive(Debug)]
pub(in crate::cli) struct Format<F: 'static> {
    pub(in crate::cli) extension: &'static str,
    pub(in crate::cli) kind: F,
    /// Extensions of the files that are written with it.
    pub(in crate::cli) companions: &'static [&'static str],
}

/// Returns the formats that a product can be written in, one for each extension.
pub(in crate::cli) fn formats_of<F>(product: Product, kind: impl Fn(&formats::Format) -> F) -> Vec<Format<F>> {
    let formats = formats::FORMATS.iter().filter(|format| format.writes(product));
    let by_extension = formats.flat_map(|format| format.extensions.iter().map(move |extension| (format, extension)));
    by_extension
        .map(|(format, extension)| Format { extension, kind: kind(format), companions: format.beside })
        .collect()
}

/// A file to write.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::cli) struct Target<F> {
    pub(in crate::cli) path: PathBuf,
    pub(in crate::cli) kind: F,
    /// The extension of its format, whatever the path says.
    pub(in crate::cli) extension: &'static str,
}

impl<F> Target<F> {
    /// Returns the destination for a writer.
    pub(in crate::cli) fn within<'a>(&'a self, set: &'a OutputSet) -> Destination<'a> {
        set.at(&self.path).in_format(self.extension)
    }
}

/// The files that a run writes; all appear at its end, or none.
#[derive(Debug)]
pub(in crate::cli) struct Outputs<F> {
    pub(in crate::cli) targets: Vec<Target<F>>,
    pub(in crate::cli) set: OutputSet,
}

impl<F> Outputs<F> {
    /// Returns the smallest free space, in bytes, of the disks that are written to, and a file that
    /// goes there; `None` if the system does not report it.
    fn free_space(&self) -> Option<(u64, &Path)> {
        let files = self.targets.iter().map(|target| target.path.as_path()).filter(|path| !io::is_stream(path));
        files.filter_map(|path| Some((free_in(folder_of(path))?, path))).min_by_key(|(free, _)| *free)
    }

    /// Adds the tables of crossings and of replaced points, if they were requested.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(in crate::cli) fn add_report(&self, plan: &SurfacePlan, product: &SurfaceProduct) -> Result<()> {
        let Some(built) = &product.built else { return Ok(()) };
        if let Some(path) = &plan.crossing_report {
            self.add_table(path, |out| built.line_names.write_table(&built.tin.crossing_heights, out))?;
        }
        if let Some(path) = &plan.replaced_report {
            self.add_table(path, |out| built.write_replaced(out))?;
        }
        Ok(())
    }

    fn add_table(&self, path: &Path, write: impl FnOnce(&mut Output) -> std::io::Result<()>) -> Result<()> {
        let mut output = Output::create(path)?;
        write(&mut output).map_err(|e| Error::from(e).in_file(path))?;
        self.set.add(output);
        Ok(())
    }

    /// Prints the size of the raster, and makes sure that the disk has room for its cells.
    /// `cell_bytes` returns the bytes of a cell before compression, and how many times they are on
    /// the disk. Of a surface, only the cells that it covers count.
    ///
    /// # Errors
    /// If the cells cannot fit, however well they are compressed.
    pub(in crate::cli) fn announce(
        &self,
        cells: &CellProduct,
        cell_bytes: impl Fn(&F) -> (u64, f64),
        console: &Console,
    ) -> Result<()> {
        let frame = cells.frame();
        let sizes: Vec<(u64, f64)> = self.targets.iter().map(|target| cell_bytes(&target.kind)).collect();
        let all = frame.width as f64 * frame.height as f64;
        let a_cell = sizes.iter().map(|&(bytes, _)| bytes as f64).sum::<f64>();
        let on_disk = sizes.iter().map(|&(bytes, copies)| bytes as f64 * copies).sum::<f64>();
        let stated = bytes((all * a_cell) as u64);
        console.line(format_args!("raster      {}, {stated} before compression", describe(&frame, cells.crs())));
        let Some((free, target)) = self.free_space().filter(|(free, _)| (*free as f64) < all * on_disk) else {
            return Ok(());
        };
        let covered = all.min(cells.covered());
        let stated = bytes((covered * a_cell) as u64);
        let room = format!("{} are free on the disk", bytes(free));
        if covered * on_disk / BEST_COMPRESSION > free as f64 {
            return Err(Error::limit(format!("the cells with a value take {stated} before compression, {room}"))
                .in_file(target)
                .cure("choose larger cells (--resolution), a smaller extent (--te), or another disk"));
        }
        if covered * on_disk > free as f64 {
            console.warning(format_args!("the output may not fit: {stated} before compression, {room}"));
        }
        Ok(())
    }

    /// Makes all files appear, and prints their names.
    ///
    /// # Errors
    /// If one cannot appear; then none does.
    pub(in crate::cli) fn commit(self, console: &Console) -> Result<()> {
        self.set.commit()?.iter().for_each(|path| print_written(path, console));
        Ok(())
    }
}

/// What happens to a file that exists at the path of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Existing {
    Keep,
    Replace,
}

impl Existing {
    pub(in crate::cli) fn of(overwrite: bool) -> Self {
        if overwrite { Existing::Replace } else { Existing::Keep }
    }
}

const REPORTS: &[Format<()>] = &[Format { extension: "csv", kind: (), companions: &[] }];

/// Finds the format of each output and makes sure that no file is lost that should be kept.
///
/// # Errors
/// If an extension is not among the formats, an output is an input or named twice, its folder does
/// not exist, or it exists and may not be replaced.
pub(in crate::cli) fn resolve<F: Copy>(
    args: &OutputArgs,
    formats: &[Format<F>],
    inputs: &[PathBuf],
) -> Result<Outputs<F>> {
    let existing = Existing::of(args.overwrite);
    let mut targets: Vec<Target<F>> = Vec::new();
    for path in &args.output {
        let format = find(path, formats)?;
        if targets.iter().any(|target| is_same(&target.path, path)) {
            return Err(Error::usage("the output is named twice").in_file(path));
        }
        require_free(path, format, existing, inputs)?;
        targets.push(Target { path: path.clone(), kind: format.kind, extension: format.extension });
    }
    Ok(Outputs { targets, set: OutputSet::default() })
}

/// Like [`resolve`], for a verb that builds a surface; also checks the path of the crossing report,
/// if any.
///
/// # Errors
/// Those of [`resolve`], for the report as well.
pub(in crate::cli) fn resolve_with_report<F: Copy>(
    args: &OutputArgs,
    formats: &[Format<F>],
    plan: &SurfacePlan,
) -> Result<Outputs<F>> {
    let outputs = resolve(args, formats, &plan.inputs)?;
    resolve_report(Existing::of(args.overwrite), plan)?;
    let is_target = |report: &&Path| outputs.targets.iter().any(|target| is_same(&target.path, report));
    match plan.reports().find(is_target) {
        Some(report) => Err(Error::usage("the output is named twice").in_file(report)),
        None => Ok(outputs),
    }
}

/// Like [`resolve`], for a verb whose only output is the crossing report, if any.
///
/// # Errors
/// Those of [`resolve`].
pub(in crate::cli) fn resolve_report(existing: Existing, plan: &SurfacePlan) -> Result<Outputs<()>> {
    for report in plan.reports() {
        require_free(report, find(report, REPORTS)?, existing, &plan.inputs)?;
    }
    Ok(Outputs { targets: Vec::new(), set: OutputSet::default() })
}

/// The part of what is announced for the files of tasks that is written at least: few points may be
/// ground, and triangles may cover little of the extents of files.
const LEAST_SHARE: f64 = 0.1;

/// Makes sure that a disk has room for the files of tasks, about `need` bytes in a folder, which
/// need not exist yet. `there` are bytes that some of them have already.
///
/// # Errors
/// If they cannot fit.
pub(in crate::cli) fn require_room(need: u64, there: u64, folder: &Path, console: &Console) -> Result<()> {
    let disk = folder.ancestors().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let Some(free) = disk.filter(|folder| folder.is_dir()).find_map(free_in) else { return Ok(()) };
    let room = free.saturating_add(there) as f64;
    let stated = format!("the files of the tasks take about {}, {} are free on the disk", bytes(need), bytes(free));
    if need as f64 * LEAST_SHARE > room {
        return Err(Error::limit(stated)
            .in_file(folder)
            .cure("choose larger cells (--resolution), a smaller extent (--te), or a folder on another disk (--job)"));
    }
    if need as f64 > room {
        console.warning(format_args!("the files of the tasks may not fit: {stated}"));
    }
    Ok(())
}

#[cfg(unix)]
fn free_in(folder: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

#[cfg(not(unix))]
fn free_in(_folder: &Path) -> Option<u64> {
    None
}

/// Returns true if two paths name the same file, whether it exists or not.
fn is_same(path: &Path, other: &Path) -> bool {
    let [path, other] = [path, other].map(|path| {
        let folder = identity(folder_of(path));
        identity(&folder.join(path.file_name().unwrap_or_default()))
    });
    path == other
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes sure that a file and its companions can be written, and that nothing is lost by it.
fn require_free<F>(path: &Path, format: &Format<F>, existing: Existing, inputs: &[PathBuf]) -> Result<()> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        let missing = std::io::Error::new(std::io::ErrorKind::NotFound, "the folder does not exist");
        return Err(Error::from(missing).in_file(path).cure(format!("mkdir -p {}", folder.display())));
    }
    let files = formats::with_companions(path, format.extension, format.companions);
    files.iter().try_for_each(|(file, _)| require_no_input(file, inputs))?;
    files.iter().try_for_each(|(file, _)| require_not_read_along(file, inputs))?;
    for (file, _) in files {
        if existing == Existing::Keep {
            io::require_absent(&file)?;
        }
        if !io::is_stream(&file) {
            io::probe(&file)?;
        }
    }
    Ok(())
}

/// Returns an error if a file is one of the inputs.
fn require_no_input(file: &Path, inputs: &[PathBuf]) -> Result<()> {
    let own = identity(file);
    match inputs.iter().any(|input| identity(input) == own) {
        true => Err(Error::usage("the output is one of the inputs").in_file(file).cure("give it another name")),
        false => Ok(()),
    }
}

/// Returns an error if a file is read along with an input, as `roads.dbf` is with `roads.shp`: also
/// one that does not exist yet, since it would be read from then on.
fn require_not_read_along(file: &Path, inputs: &[PathBuf]) -> Result<()> {
    let (own, folder) = (identity(file), identity(folder_of(file)));
    let is_own = |along: &PathBuf| {
        let [name, own_name] = [along, file].map(|path| path.file_name().unwrap_or_default());
        identity(along) == own || name.eq_ignore_ascii_case(own_name) && identity(folder_of(along)) == folder
    };
    let is_along = |main: &Path| {
        let is_part = || run::parts_folder(main).is_some_and(|parts| identity(&parts) == folder);
        formats::read_along_with(main).iter().any(is_own) || is_part()
    };
    match inputs.iter().map(|input| file_of(input).unwrap_or(input)).find(|main| is_along(main)) {
        Some(main) => Err(Error::usage(format!("a file of this name is read with an input, {}", main.display()))
            .in_file(file)
            .cure("give it another name")),
        None => Ok(()),
    }
}

/// Returns the companions of a target, then the target itself.
pub(in crate::cli) fn files_of<F: Copy>(target: &Target<F>, formats: &[Format<F>]) -> Vec<Target<F>> {
    let format = formats.iter().find(|format| format.extension == target.extension);
    let companions = format.map_or(&[][..], |format| format.companions);
    let mut files = formats::with_companions(&target.path, target.extension, companions);
    files.rotate_left(1);
    files.into_iter().map(|(path, extension)| Target { path, kind: target.kind, extension }).collect()
}

fn find<'a, F>(path: &Path, formats: &'a [Format<F>]) -> Result<&'a Format<F>> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let named = |format: &&Format<F>| format.extension.eq_ignore_ascii_case(extension);
    // `/dev/stdout` names no format.
    let is_nameless = extension.is_empty() && io::is_stream(path);
    let default = || formats.iter().find(|format| is_nameless && format.companions.is_empty());
    formats.iter().find(named).or_else(default).ok_or_else(|| {
        let known: Vec<String> = formats.iter().map(|format| format!(".{}", format.extension)).collect();
        let found = match extension {
            "" => "the output has no extension, which would select its format".to_owned(),
            _ => format!("`.{extension}` is not a format that can be written here"),
        };
        Error::usage(found).in_file(path).cure(format!("use one of {}", known.join(", ")))
    })
}

/// Prints a note if the format of a mesh does not store which edges are on lines, and there are
/// any; and a note if its coordinates are relative to an origin.
pub(in crate::cli) fn note_mesh(file: &Path, written: &MeshSummary, cure: &str, console: &Console) {
    let path = file.display();
    let edges = written.lost_edges;
    if edges > 0 {
        console.note(format_args!(
            "{path}: {edges} edges on breaklines or clip lines are not marked in this format; {cure}"
        ));
    }
    if let Some(([x, y, z], beside)) = &written.origin {
        let beside = beside.display();
        console.note(format_args!("{path}: coordinates are relative to {x} {y} {z}, see {beside}"));
    }
}

/// Prints the name and size of a file that was written.
fn print_written(file: &Path, console: &Console) {
    let path = file.display();
    match std::fs::metadata(file) {
        Ok(data) if data.is_file() => {
            console.line(format_args!("written     {path} ({} kB)", data.len().div_ceil(1000)))
        }
        _ => console.line(format_args!("written     {path}")),
    }
}
