//! Files of points, written again with the classes that a filter of the ground finds.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::new_folder::NewFolder;
use super::output_formats::Format;
use super::targets::{self, Existing, Target};
use crate::crs::Crs;
use crate::data::{PointBatch, PointInfo, PointSource, Return};
use crate::error::{Command, Error, Kind, Result, wording};
use crate::io::las::{self, Packing};
use crate::run::context::large_files::folder_of_large_files;
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage, Work};
use crate::run::products::ground::{
    GROUND, HIGH_NOISE, LOW_NOISE, UNCLASSIFIED, class_number, ground_classes, ground_in_tiles,
};
use crate::run::request::input::is_read_once;
use crate::run::sources::open::is_lidar;
use crate::run::sources::systems::{self, Degrees, Stated, SystemOptions};
use crate::terrain::ground::{GroundOptions, PointClass, Take};

/// The point formats from this one on have a class for high noise.
const FIRST_EXTENDED: u8 = 6;

/// The formats that are written.
const FORMATS: &[Format<()>] = &[Format::named("las", &[]), Format::named("laz", &[])];

/// Which points of files are classified, and how. By default those of the classes 0, 1 and 2.
#[derive(Debug, Clone, Default)]
pub struct GroundRequest {
    /// Files of LAS, LAZ or COPC. They are one area: the points of all are filtered together.
    pub files: Vec<PathBuf>,
    /// The classes whose points get a new one: 2 on the ground, else 1. Points of other classes
    /// keep theirs, and the filter does not see them. Neither does it see points that are flagged
    /// as withheld. The default, if empty, are 0, 1 and 2.
    pub from_classes: Vec<u8>,
    /// The returns that may be ground; all if empty. Others get class 1, and the filter does not
    /// see them.
    pub returns: Vec<Return>,
    /// How the ground is found. If noise is asked for, it gets class 7 (low) or 18 (high), and in
    /// point formats 0 to 5, which have no 18, class 7.
    pub options: GroundOptions,
    /// Bytes of memory for the points. What needs more is filtered in tiles. The default is half of
    /// what is free.
    pub memory: Option<u64>,
    /// The coordinate system of the points, whatever the files state: what is found depends on its
    /// units. It is not written.
    pub crs: Option<Crs>,
}

impl GroundRequest {
    fn from(&self) -> [bool; 256] {
        let usual = [0, UNCLASSIFIED, GROUND];
        let named = match self.from_classes.is_empty() {
            true => &usual[..],
            false => &self.from_classes,
        };
        let mut from = [false; 256];
        named
            .iter()
            .for_each(|&class| from[usize::from(class)] = true);
        from
    }
}

/// The files that were written.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct GroundReport {
    /// Each file, in the order of the request.
    pub files: Vec<GroundFile>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// A file before and after.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct GroundFile {
    /// The file that was read.
    pub path: PathBuf,
    /// The file that was written.
    pub output: PathBuf,
    /// Points of each class that were read.
    pub before: BTreeMap<u8, u64>,
    /// Points of each class that were written.
    pub after: BTreeMap<u8, u64>,
    /// Points that the filter saw.
    pub filtered: u64,
}

impl GroundFile {
    /// Returns the number of points.
    pub fn points(&self) -> u64 {
        self.before.values().sum()
    }
}

/// Finds the ground in files of points and writes them again with its classes. Every other byte of
/// them stays, see [`las::copy_with_classes`].
///
/// `output` is a file, or for several inputs a folder, which is created if it does not exist: its
/// files have the names of the inputs. LAS stays LAS and LAZ stays LAZ, unless the name of the
/// output says otherwise. Of COPC, the octree is left out. All files appear together, or none.
///
/// # Complexity
/// That of the filter, and the files are read twice; three times if the points need more memory
/// than they may use. They are sorted into files in `TMPDIR` (else in `/var/tmp`) then, of 80 bytes
/// a point, and filtered in tiles, see
/// [`classify_in_tiles`](crate::terrain::ground::classify_in_tiles). One byte a point stays in
/// memory.
///
/// # Errors
/// If a file is not LAS, LAZ or COPC, is damaged, or is the standard input or a pipe; if files are
/// in different coordinate systems; if memory is short; if an output exists and is not to be
/// replaced, or is an input; or if the run is canceled. Nothing is written then.
pub fn write_ground(
    request: &GroundRequest,
    output: &Path,
    existing: Existing,
    context: &Context,
) -> Result<GroundReport> {
    let journal = Journal::new(context);
    let folder = folder_of(output, request.files.len())?;
    let files = request
        .files
        .iter()
        .map(|path| Source::open(path, &journal).map_err(|e| e.in_file(path)))
        .collect::<Result<Vec<_>>>()?;
    let count: u64 = files.iter().map(|file| file.count).sum();
    let memory = request.memory.unwrap_or_else(memory::half_of_free);
    let is_in_tiles = count > memory::filtered_in(memory) as u64;
    let stated: Vec<Stated> = files.iter().map(|file| file.stated.clone()).collect();
    let options = SystemOptions {
        assign: request.crs.clone(),
        degrees: Degrees::Allow,
        ..SystemOptions::default()
    };
    let crs = systems::reconcile(&stated, &options, &journal)?.crs;

    let named: Vec<PathBuf> = files
        .iter()
        .map(|file| match &folder {
            Some(folder) => folder.path().join(file.name()),
            None => output.to_path_buf(),
        })
        .collect();
    let may_replace = |_: &Path| existing == Existing::Replace;
    let outputs = targets::resolve(&named, &may_replace, &FORMATS.into(), &request.files)?;
    outputs.targets.iter().try_for_each(refuse_octree)?;

    let chosen = Chosen::of(request);
    let in_tiles = || {
        let pass = |take: &mut Take| chosen.pass(&files, count, &journal, take);
        let folder = folder_of_large_files();
        let (options, crs) = (&request.options, crs.as_ref());
        ground_in_tiles(&pass, crs, options, memory, &folder, &journal)
    };
    let classes = match is_in_tiles {
        true => in_tiles(),
        false => {
            let points = chosen.read(&files, count, &journal)?;
            match ground_classes(&points, crs.as_ref(), &request.options, context) {
                // Points are too far apart for one grid.
                Err(error) if error.kind() == Kind::Limit => in_tiles(),
                found => found,
            }
        }
    };
    let classes = classes.map_err(|error| match (&request.files[..], error.path()) {
        ([file], None) => error.in_file(file),
        _ => error,
    })?;
    let work = journal.start(Stage::WritingPoints, Size::Items(count))?;
    let mut found = classes.into_iter();
    let mut report = GroundReport::default();
    for (file, target) in files.iter().zip(&outputs.targets) {
        let mut written = GroundFile {
            path: file.path.clone(),
            output: target.path.clone(),
            ..GroundFile::default()
        };
        let classify =
            &mut |batch: &mut PointBatch| chosen.put(batch, file, &mut found, &mut written, &work);
        let packing = packing_of(&target.path);
        las::copy_with_classes(&file.path, target.within(&outputs.set), packing, classify)?;
        file.require_unchanged()?;
        outputs.set.close_staged()?;
        if file.is_copc {
            journal.add(Notice::OctreeLeftOut(target.path.clone()));
        }
        report.files.push(written);
    }
    work.end()?;
    if found.next().is_some() {
        return Err(changed());
    }
    outputs.set.commit()?;
    if let Some(folder) = folder {
        folder.keep();
    }
    report.notices = journal.take();
    Ok(report)
}

/// COPC has its points in another order.
fn refuse_octree(target: &Target) -> Result<()> {
    let name = target.path.to_string_lossy().to_ascii_lowercase();
    match name.ends_with(".copc.laz") {
        true => Err(Error::usage(
            "points keep their order, and those of COPC are in the order of an octree",
        )
        .in_file(&target.path)
        .cure(wording![
            "name it .laz; ",
            Command::Points,
            " makes COPC of that"
        ])),
        false => Ok(()),
    }
}

#[cold]
fn changed() -> Error {
    Error::format("the file changed while it was read").cure("run it again once it is complete")
}

/// Returns the folder that an output for so many files names; `None` if it names a file.
///
/// # Errors
/// If a folder is needed and it is a file, or it cannot be created.
fn folder_of(output: &Path, files: usize) -> Result<Option<NewFolder>> {
    let ends_like_one = output.to_string_lossy().ends_with(std::path::is_separator);
    let is_one = output.is_dir() || ends_like_one || output.extension().is_none();
    if output.exists() && !output.is_dir() || !is_one {
        return match files {
            1 => Ok(None),
            _ => Err(Error::usage(format!(
                "{files} files are classified, each into a file of its own, and one output is named"
            ))
            .in_file(output)
            .cure("name a folder for them")),
        };
    }
    NewFolder::at(output).map(Some)
}

/// A file to be classified, by its header.
struct Source {
    path: PathBuf,
    count: u64,
    point_format: u8,
    is_compressed: bool,
    is_copc: bool,
    stated: Stated,
    /// The length, and when it was changed last.
    state: (u64, Option<SystemTime>),
}

impl Source {
    fn open(path: &Path, journal: &Journal) -> Result<Self> {
        if is_read_once(path) {
            return Err(
                Error::usage("points are read twice, and this can be read only once")
                    .cure("copy it to a file"),
            );
        }
        if !is_lidar(path) {
            return Err(Error::unsupported(
                "classes are written to LAS and LAZ only, and this is neither",
            )
            .cure(wording![
                Command::Tin,
                " and the other commands that build a surface find the ground of any points"
            ]));
        }
        let state = state_of(path)?;
        let reader = las::open(path)?;
        let info: &PointInfo = reader.info();
        journal.add(Notice::Opened(path.to_path_buf(), info.format.clone()));
        journal.add_warnings(path, &info.warnings);
        let header = reader.header();
        Ok(Source {
            path: path.to_path_buf(),
            count: header.count,
            point_format: header.point_format,
            is_compressed: header.is_compressed,
            is_copc: header.is_copc(),
            stated: Stated::by_points(path, info),
            state,
        })
    }

    /// Returns an error if the file is not the one that was opened: the classes are of its points.
    fn require_unchanged(&self) -> Result<()> {
        match state_of(&self.path)? == self.state {
            true => Ok(()),
            false => Err(changed().in_file(&self.path)),
        }
    }

    /// Returns the name of the file in a folder of outputs.
    fn name(&self) -> PathBuf {
        let name = PathBuf::from(self.path.file_name().unwrap_or_default());
        let plain = name.with_extension("");
        if has_extension(&plain, "copc") {
            return plain.with_extension("laz");
        }
        match ["las", "laz"]
            .iter()
            .any(|known| has_extension(&name, known))
        {
            true => name,
            false => name.with_extension(if self.is_compressed { "laz" } else { "las" }),
        }
    }
}

/// Returns the length of a file, and when it was changed last.
fn state_of(path: &Path) -> Result<(u64, Option<SystemTime>)> {
    let data = std::fs::metadata(path).map_err(|e| Error::from(e).in_file(path))?;
    Ok((data.len(), data.modified().ok()))
}

/// Returns how the points of an output are compressed, by its extension.
fn packing_of(output: &Path) -> Packing {
    match has_extension(output, "laz") {
        true => Packing::Compressed,
        false => Packing::Plain,
    }
}

fn has_extension(path: &Path, known: &str) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case(known))
}

/// Which points get a class.
struct Chosen<'a> {
    from: [bool; 256],
    returns: &'a [Return],
}

/// What becomes of a point.
enum Fate {
    Keep,
    /// It gets class 1, whatever the filter would find.
    NoGround,
    Filter,
}

impl<'a> Chosen<'a> {
    fn of(request: &'a GroundRequest) -> Self {
        Chosen {
            from: request.from(),
            returns: &request.returns,
        }
    }

    fn fate(&self, batch: &PointBatch, i: usize) -> Fate {
        let is_withheld = batch.flags.get(i).is_some_and(|flags| flags.is_withheld());
        if is_withheld || !self.from[usize::from(batch.class[i])] {
            return Fate::Keep;
        }
        let is_wanted =
            |(number, count)| self.returns.iter().any(|wanted| wanted.is(number, count));
        match self.returns.is_empty() || batch.return_of(i).is_none_or(is_wanted) {
            true => Fate::Filter,
            false => Fate::NoGround,
        }
    }

    /// Returns the points of all files that the filter sees.
    fn read(&self, files: &[Source], count: u64, journal: &Journal) -> Result<Vec<[f64; 3]>> {
        let mut points = Vec::new();
        points
            .try_reserve_exact(count as usize)
            .map_err(|_| Error::limit(format!("not enough memory for {count} points")))?;
        self.pass(files, count, journal, &mut |batch| {
            points.extend_from_slice(batch);
            Ok(())
        })?;
        Ok(points)
    }

    /// Passes on the points of all files that the filter sees, in batches.
    fn pass(&self, files: &[Source], count: u64, journal: &Journal, take: &mut Take) -> Result<()> {
        let work = journal.start(Stage::ReadingPoints, Size::Items(count))?;
        let (mut batch, mut seen) = (PointBatch::default(), Vec::new());
        for file in files {
            let mut source = las::open(&file.path)?;
            loop {
                source.read(&mut batch)?;
                if batch.is_empty() {
                    break;
                }
                let is_seen = |&i: &usize| matches!(self.fate(&batch, i), Fate::Filter);
                let of_batch = (0..batch.len()).filter(is_seen);
                seen.clear();
                seen.extend(of_batch.map(|i| [batch.x[i], batch.y[i], batch.z[i]]));
                take(&seen)?;
                work.add(batch.len() as u64)?;
            }
            journal.add_warnings(&file.path, source.warnings());
        }
        work.end()
    }

    /// Replaces the classes of a batch of points of a file by those that were found, and counts
    /// them.
    fn put(
        &self,
        batch: &mut PointBatch,
        file: &Source,
        found: &mut dyn Iterator<Item = PointClass>,
        written: &mut GroundFile,
        work: &Work,
    ) -> Result<()> {
        // A look into a map for each point would take as long as the rest.
        let mut counts = [[0u64; 256]; 2];
        for i in 0..batch.len() {
            let before = batch.class[i];
            let after = match self.fate(batch, i) {
                Fate::Keep => before,
                Fate::NoGround => UNCLASSIFIED,
                Fate::Filter => {
                    written.filtered += 1;
                    let class = found.next().ok_or_else(|| changed().in_file(&file.path))?;
                    match class_number(class) {
                        HIGH_NOISE if file.point_format < FIRST_EXTENDED => LOW_NOISE,
                        class => class,
                    }
                }
            };
            batch.class[i] = after;
            counts[0][usize::from(before)] += 1;
            counts[1][usize::from(after)] += 1;
        }
        for (map, counts) in [&mut written.before, &mut written.after]
            .into_iter()
            .zip(counts)
        {
            let counted = (0..=u8::MAX).zip(counts).filter(|(_, count)| *count > 0);
            counted.for_each(|(class, count)| *map.entry(class).or_default() += count);
        }
        work.add(batch.len() as u64)
    }
}
