//! The files of results, checked before the work starts.

#[cfg(feature = "cli")]
use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::output_formats::find;
pub(crate) use super::output_formats::{Format, Formats, TABLES};
#[cfg(feature = "cli")]
pub(crate) use super::output_formats::{PROFILES, formats_of};
use crate::error::{Error, Result, Setting, wording};
use crate::io::formats::{self, Product};
use crate::io::gdal;
use crate::io::{
    self, Destination, DriverOptions, Output, OutputDriver, OutputSet, contours, layer,
};
use crate::run::context::Context;
use crate::run::context::notice::Notice;
use crate::run::context::units::bytes;
use crate::run::products::surface::SurfaceProduct;
use crate::run::sources::tin_parts;

/// The files to write, and what becomes of those that are there.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Targets {
    /// The outputs; the extension of each names its format.
    pub files: Vec<PathBuf>,
    /// What becomes of files that exist there.
    pub existing: Existing,
    /// A table of all points where breaklines meet with different heights.
    pub crossings: Option<PathBuf>,
    /// A table of the points that water and walls replaced, which the request has to
    /// [keep](crate::run::ReplacedPoints).
    pub replaced: Option<PathBuf>,
    /// The labels of contours.
    #[serde(default)]
    pub labels: Option<PathBuf>,
    /// Files that are read besides those of the request, such as lists of inputs: no output may
    /// replace them.
    pub also_read: Vec<PathBuf>,
    /// The driver of GDAL that writes the outputs, and its options.
    #[serde(default)]
    pub driver: DriverOptions,
}

/// What happens to a file that exists at the path of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Existing {
    /// It stays, and is an error.
    #[default]
    Keep,
    /// It is replaced.
    Replace,
}

impl Existing {
    /// Returns what an option to overwrite means.
    pub fn of(overwrite: bool) -> Self {
        if overwrite {
            Existing::Replace
        } else {
            Existing::Keep
        }
    }
}

impl Targets {
    /// Returns the target that is one file.
    pub fn of(file: impl Into<PathBuf>) -> Self {
        Targets {
            files: vec![file.into()],
            ..Targets::default()
        }
    }

    /// Returns the tables that are written with the results.
    pub(crate) fn tables(&self) -> impl Iterator<Item = &Path> {
        [&self.crossings, &self.replaced]
            .into_iter()
            .flatten()
            .map(PathBuf::as_path)
    }

    /// Returns the folder that a job for these outputs has by default; `None` if there is no
    /// output.
    pub fn job_folder(&self) -> Option<PathBuf> {
        let mut name = self.files.first()?.as_os_str().to_owned();
        name.push(".job");
        Some(name.into())
    }

    /// Returns the files that are read for a request, with those that are read besides.
    pub(crate) fn with_lists(&self, mut files: Vec<PathBuf>) -> Vec<PathBuf> {
        files.extend(self.also_read.iter().cloned());
        files
    }

    /// Calls a function with the name of each file that is written, or read besides the request.
    pub(crate) fn each_file(&mut self, visit: &mut dyn FnMut(&mut PathBuf)) {
        let Targets {
            files,
            existing: _,
            crossings,
            replaced,
            labels,
            also_read,
            driver: _,
        } = self;
        files
            .iter_mut()
            .chain(crossings)
            .chain(replaced)
            .chain(labels)
            .chain(also_read)
            .for_each(visit);
    }

    /// Finds the format of each output and makes sure that no file is lost that should be kept.
    /// `read` are the files that the request reads. `is_own` returns true for a file that may be
    /// replaced in any case.
    ///
    /// # Errors
    /// If an extension is not that of a format for the product, an output is an input or named
    /// twice, its folder does not exist, or it exists and may not be replaced.
    pub(crate) fn resolve(
        &self,
        product: Product,
        read: &[PathBuf],
        is_own: &dyn Fn(&Path) -> bool,
    ) -> Result<Outputs> {
        let may_replace = |file: &Path| self.existing == Existing::Replace || is_own(file);
        let formats = Formats::of_product(product, &self.driver);
        let mut outputs = resolve(&self.files, &may_replace, &formats, read)?;
        if let Some(labels) = &self.labels {
            let formats = Formats::of_product(Product::Lines, &self.driver);
            let found = resolve(std::slice::from_ref(labels), &may_replace, &formats, read)?;
            outputs.labels = found.targets.into_iter().next();
            if let Some(labels) = &mut outputs.labels {
                match outputs
                    .targets
                    .iter()
                    .find(|own| is_same(&own.path, &labels.path))
                {
                    // One spelling for one file: writers compare paths.
                    Some(own)
                        if product == Product::Contours
                            && own.driver.is_none()
                            && contours::takes_labels(&labels.path) =>
                    {
                        labels.path.clone_from(&own.path);
                    }
                    Some(_) => {
                        return Err(named_twice(&labels.path)
                            .cure("give labels another name, or write both as .gpkg or .dxf"));
                    }
                    None => require_own_files(labels, &outputs.targets)?,
                }
            }
        }
        self.check_tables(read)?;
        let is_target = |table: &&Path| {
            outputs
                .targets
                .iter()
                .any(|target| is_same(&target.path, table))
        };
        match self.tables().find(is_target) {
            Some(table) => Err(named_twice(table).cure(OTHER_NAME)),
            None => Ok(outputs),
        }
    }

    /// Makes sure that the tables can be written, and that nothing is lost by it.
    ///
    /// # Errors
    /// Those of [`resolve`](Self::resolve).
    pub(crate) fn check_tables(&self, read: &[PathBuf]) -> Result<()> {
        let may_replace = |_: &Path| self.existing == Existing::Replace;
        self.tables()
            .try_for_each(|table| require_free(table, find(table, TABLES)?, &may_replace, read))
    }

    /// Writes the tables of crossings and of replaced points, if they were requested.
    ///
    /// # Errors
    /// If one cannot be written.
    pub(crate) fn write_tables(&self, product: &SurfaceProduct, set: &OutputSet) -> Result<()> {
        let Some(built) = &product.built else {
            return Ok(());
        };
        if let Some(path) = &self.crossings {
            add_table(path, set, |out| {
                built
                    .line_names
                    .write_table(&built.tin.crossing_heights, out)
            })?;
        }
        if let Some(path) = &self.replaced {
            add_table(path, set, |out| built.write_replaced(out))?;
        }
        Ok(())
    }
}

/// Writes a table to a file that appears with the others of a set.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn add_table(
    path: &Path,
    set: &OutputSet,
    write: impl FnOnce(&mut Output) -> std::io::Result<()>,
) -> Result<()> {
    let mut output = Output::create(path)?;
    write(&mut output).map_err(|e| Error::from(e).in_file(path))?;
    set.add(output);
    Ok(())
}

/// A file to write, whose format is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Target<F = ()> {
    /// Where it appears.
    pub path: PathBuf,
    pub(crate) kind: F,
    /// The extension of its format, whatever the path says; empty if a driver of GDAL writes it.
    pub extension: &'static str,
    /// Extensions of the files that are written with it.
    pub(crate) companions: &'static [&'static str],
    /// The driver of GDAL that writes it, and whichever files it writes beside; `None` if this
    /// crate does.
    pub(crate) driver: Option<OutputDriver>,
}

impl<F> Target<F> {
    /// Returns the paths of the file and of those that are known to be written with it.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let files = formats::with_companions(&self.path, self.extension, self.companions);
        files.into_iter().map(|(path, _)| path)
    }

    /// Returns the destination for a writer.
    pub fn within<'a>(&'a self, set: &'a OutputSet) -> Destination<'a> {
        let target = set.at(&self.path).in_format(self.extension);
        target.by_driver(self.driver.as_ref())
    }
}

/// The files that a run writes; all appear at its end, or none.
#[derive(Debug)]
pub struct Outputs<F = ()> {
    /// The files, with their formats.
    pub targets: Vec<Target<F>>,
    /// The file for the labels of contours.
    pub labels: Option<Target<F>>,
    /// What a writer adds them to.
    pub set: OutputSet,
}

impl<F> Outputs<F> {
    /// Returns the paths of all files, with those that are written with them.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let targets = self.targets.iter().chain(&self.labels);
        targets.flat_map(Target::files).collect()
    }

    /// Returns the smallest free space, in bytes, of the disks that are written to, and a file that
    /// goes there; `None` if the system does not report it.
    pub(crate) fn free_space(&self) -> Option<(u64, &Path)> {
        let files = self
            .targets
            .iter()
            .map(|target| target.path.as_path())
            .filter(|path| !io::is_stream(path));
        files
            .filter_map(|path| Some((free_in(folder_of(path))?, path)))
            .min_by_key(|(free, _)| *free)
    }
}

/// Finds the format of each output and makes sure that no file is lost that should be kept.
/// `may_replace` returns true for a file that may be replaced.
///
/// # Errors
/// If an extension is not among the formats, an output is an input or named twice, its folder does
/// not exist, or it exists and may not be replaced.
pub(crate) fn resolve<F: Copy>(
    files: &[PathBuf],
    may_replace: &dyn Fn(&Path) -> bool,
    formats: &Formats<F>,
    inputs: &[PathBuf],
) -> Result<Outputs<F>> {
    let mut targets: Vec<Target<F>> = Vec::new();
    for path in files {
        let (format, driver) = formats.choose(path)?;
        if driver.is_none() || !gdal::is_connection(path) {
            require_name(path)?;
            require_free(path, &format, may_replace, inputs)?;
        }
        if targets.iter().any(|target| is_same(&target.path, path)) {
            return Err(named_twice(path).cure(OTHER_NAME));
        }
        let driver = driver.map(|options| OutputDriver {
            name: options.name.unwrap_or_default(),
            creation: options.creation,
            layer: options.layer,
            replaces: may_replace(path),
            read: inputs.iter().map(|path| identity(path)).collect(),
        });
        let target = Target {
            path: path.clone(),
            kind: format.kind,
            extension: format.extension,
            companions: format.companions,
            driver,
        };
        require_own_files(&target, &targets)?;
        targets.push(target);
    }
    Ok(Outputs {
        targets,
        labels: None,
        set: OutputSet::default(),
    })
}

/// The cure for outputs that are one file.
const OTHER_NAME: &str = "give one of them another name";

#[cold]
fn named_twice(path: &Path) -> Error {
    Error::usage("the output is named twice").in_file(path)
}

/// Returns an error if a file that is written with a target is also written with another one, as
/// `a.dbf` with `a.shp` and `a.SHP`. Formats that differ may share files: they say the same.
fn require_own_files<F>(target: &Target<F>, others: &[Target<F>]) -> Result<()> {
    let others: Vec<PathBuf> = others
        .iter()
        .filter(|other| other.extension == target.extension && other.driver.is_none())
        .flat_map(Target::files)
        .collect();
    let mut own = target.files();
    match own.find(|file| others.iter().any(|other| is_same(file, other))) {
        Some(file) => {
            let error = format!("another output writes {}, too", file.display());
            Err(Error::usage(error).in_file(&target.path).cure(OTHER_NAME))
        }
        None => Ok(()),
    }
}

/// The part of what is announced for the files of tasks that is written at least: few points may be
/// ground, and triangles may cover little of the extents of files.
const LEAST_SHARE: f64 = 0.1;

/// Makes sure that a disk has room for the files of tasks, about `need` bytes in a folder, which
/// need not exist yet. `there` are bytes that some of them have already.
///
/// # Errors
/// If they cannot fit.
pub(crate) fn require_room(need: u64, there: u64, folder: &Path, context: &Context) -> Result<()> {
    let disk = folder.ancestors().map(|folder| {
        if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        }
    });
    let Some(free) = disk.filter(|folder| folder.is_dir()).find_map(free_in) else {
        return Ok(());
    };
    let room = free.saturating_add(there) as f64;
    if need as f64 * LEAST_SHARE > room {
        let stated = format!(
            "the files of the tasks take about {}, {} are free on the disk",
            bytes(need),
            bytes(free)
        );
        return Err(Error::limit(stated).in_file(folder).cure(wording![
            "choose larger cells (",
            Setting::Resolution,
            "), a smaller extent (",
            Setting::Extent,
            "), or a folder on another disk (",
            Setting::Job,
            ")"
        ]));
    }
    if need as f64 > room {
        context
            .monitor
            .notice(&Notice::TasksMayNotFit { need, free });
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

/// Returns a path that is the same for all names of one file.
pub(crate) fn identity(path: &Path) -> PathBuf {
    let file = file_of(path).unwrap_or(path);
    let missing = || {
        let followed = io::followed(file);
        let folder = folder_of(&followed).canonicalize();
        match folder.ok().zip(followed.file_name()) {
            // A link to a file that does not exist yet.
            Some((folder, name)) if followed != file => folder.join(name),
            _ => file.to_path_buf(),
        }
    };
    file.canonicalize().unwrap_or_else(|_| missing())
}

/// Returns the path of an existing file, without the layer and the field that may follow its name.
pub(crate) fn file_of(path: &Path) -> Option<&Path> {
    if path.exists() {
        return Some(path);
    }
    Some(layer::file_of(path.to_str()?)).filter(|file| file.exists())
}

/// Returns true if two paths name the same file, whether it exists or not.
pub(crate) fn is_same(path: &Path, other: &Path) -> bool {
    let [path, other] = [path, other].map(|path| {
        let folder = identity(folder_of(path));
        identity(&folder.join(path.file_name().unwrap_or_default()))
    });
    path == other
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Returns an error for a path that ends with a separator, and so names a folder.
fn require_name(path: &Path) -> Result<()> {
    let text = path.to_string_lossy();
    let name = text.trim_end_matches(std::path::is_separator);
    if name.len() == text.len() {
        return Ok(());
    }
    let error = Error::usage("the output is a file, but its name ends like that of a folder");
    let cure = match Path::new(name).is_dir() {
        true => format!("name a file in it, such as {text}out{}", extension_of(name)),
        false => format!("leave the separator out: {name}"),
    };
    Err(error.in_file(path).cure(cure))
}

/// Returns the extension of a name with its dot; empty if it has none.
fn extension_of(name: &str) -> String {
    let extension = Path::new(name).extension().unwrap_or_default();
    match extension.is_empty() {
        true => String::new(),
        false => format!(".{}", extension.to_string_lossy()),
    }
}

/// The cure for a product that reads what another one would write.
#[cfg(feature = "cli")]
const OF_ANOTHER: &str = "give it another name: products do not read what others of their run make; \
    that takes a second run";

/// The files of one of several products.
#[cfg(feature = "cli")]
#[derive(Debug, Default)]
pub(crate) struct ProductFiles {
    pub(crate) writes: Vec<PathBuf>,
    pub(crate) reads: Vec<PathBuf>,
}

/// Makes sure that what each of several products writes is not written or read by another one.
/// Returns an error with the number of the product that it is about.
#[cfg(feature = "cli")]
pub(crate) fn require_apart(products: &[&ProductFiles]) -> std::result::Result<(), (usize, Error)> {
    let mut written: HashSet<PathBuf> = HashSet::new();
    for (number, product) in products.iter().enumerate() {
        // A link is not followed here: of two products with one name, only one would be left.
        let absolute =
            |path: &PathBuf| identity(folder_of(path)).join(path.file_name().unwrap_or_default());
        let own: HashSet<PathBuf> = product.writes.iter().map(absolute).collect();
        let again = |path: &&PathBuf| {
            written.contains(&absolute(path)) || written.contains(&identity(path))
        };
        if let Some(path) = product.writes.iter().find(again) {
            let error = Error::usage("another product writes this file, too").in_file(path);
            return Err((number, error.cure(OTHER_NAME)));
        }
        written.extend(own);
        written.extend(product.writes.iter().map(|path| identity(path)));
    }
    for (number, product) in products.iter().enumerate() {
        let own: HashSet<&PathBuf> = product.reads.iter().collect();
        let others = products.iter().flat_map(|other| &other.reads);
        let others: HashSet<&PathBuf> = others.filter(|read| !own.contains(read)).collect();
        let others: Vec<PathBuf> = others.into_iter().cloned().collect();
        let refused = |path: &PathBuf| {
            require_no_input(path, &others).and_then(|()| require_not_read_along(path, &others))
        };
        product
            .writes
            .iter()
            .try_for_each(refused)
            .map_err(|error| (number, error.cure(OF_ANOTHER)))?;
    }
    Ok(())
}

/// Makes sure that a file and its companions can be written, and that nothing is lost by it.
fn require_free<F>(
    path: &Path,
    format: &Format<F>,
    may_replace: &dyn Fn(&Path) -> bool,
    inputs: &[PathBuf],
) -> Result<()> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        let missing =
            std::io::Error::new(std::io::ErrorKind::NotFound, "the folder does not exist");
        return Err(Error::from(missing)
            .in_file(path)
            .cure(format!("mkdir -p {}", folder.display())));
    }
    let files = formats::with_companions(path, format.extension, format.companions);
    files
        .iter()
        .try_for_each(|(file, _)| require_no_input(file, inputs))?;
    files
        .iter()
        .try_for_each(|(file, _)| require_not_read_along(file, inputs))?;
    for (file, _) in files {
        if !may_replace(&file) {
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
        true => Err(Error::usage("the output is one of the inputs")
            .in_file(file)
            .cure("give it another name")),
        false => Ok(()),
    }
}

/// Returns an error if a file is read along with an input, as `roads.dbf` is with `roads.shp`: also
/// one that does not exist yet, since it would be read from then on.
fn require_not_read_along(file: &Path, inputs: &[PathBuf]) -> Result<()> {
    let (own, folder) = (identity(file), identity(folder_of(file)));
    let is_own = |along: &PathBuf| {
        let [name, own_name] = [along, file].map(|path| path.file_name().unwrap_or_default());
        identity(along) == own
            || name.eq_ignore_ascii_case(own_name) && identity(folder_of(along)) == folder
    };
    let is_along = |main: &Path| {
        let is_part =
            || tin_parts::parts_folder(main).is_some_and(|parts| identity(&parts) == folder);
        formats::read_along_with(main).iter().any(is_own) || is_part()
    };
    match inputs
        .iter()
        .map(|input| file_of(input).unwrap_or(input))
        .find(|main| is_along(main))
    {
        Some(main) => Err(Error::usage(format!(
            "a file of this name is read with an input, {}",
            main.display()
        ))
        .in_file(file)
        .cure("give it another name")),
        None => Ok(()),
    }
}
