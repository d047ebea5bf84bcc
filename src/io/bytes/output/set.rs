use std::cell::{OnceCell, RefCell};
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::driver::OutputDriver;
use super::file::{self, Flushed, Output, Writing};
#[cfg(feature = "gdal")]
use super::target::TargetKind;
use super::temporary::{Renames, Temporary};
use super::{target, temporary};
use crate::error::{Error, Result};

/// Outputs that appear together or not at all.
///
/// ```
/// # fn main() -> breakline::Result<()> {
/// # let folder = tempfile::tempdir()?;
/// # let (ply, obj) = (folder.path().join("a.ply"), folder.path().join("a.obj"));
/// use breakline::data::Mesh;
/// use breakline::io::{OutputSet, mesh};
///
/// let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let surface = Mesh::new(corners, vec![[0, 1, 2]], &[], None)?;
/// let set = OutputSet::default();
/// mesh::write(set.at(&ply), &surface)?;
/// mesh::write(set.at(&obj), &surface)?;
/// assert!(!ply.exists() && !obj.exists());
/// set.commit()?;
/// assert!(ply.exists() && obj.exists());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Default)]
#[must_use = "nothing appears at the targets before `commit`"]
pub struct OutputSet {
    staged: RefCell<Staged>,
    mark: OnceCell<String>,
}

#[derive(Debug, Default)]
struct Staged {
    companions: Vec<Output>,
    outputs: Vec<Output>,
    /// Outputs that are on the disk, and no longer open.
    closed: Vec<Flushed>,
    stale: Vec<PathBuf>,
    /// What is in a database, where it appears last.
    deferred: Vec<Box<dyn Deferred>>,
}

#[cfg(feature = "gdal")]
impl Staged {
    /// Returns true if there is a file for this target.
    fn has(&self, target: &Path) -> bool {
        let files = self
            .companions
            .iter()
            .chain(&self.outputs)
            .map(Output::target);
        let closed = self.closed.iter().map(|file| file.target.as_path());
        files.chain(closed).any(|own| own == target)
    }
}

/// An output that is not a file, such as a table: it appears by a call, or not at all if it is
/// dropped.
pub(crate) trait Deferred: std::fmt::Debug {
    /// Returns its name.
    fn target(&self) -> &Path;

    /// Makes it appear.
    ///
    /// # Errors
    /// If it cannot.
    fn appear(self: Box<Self>) -> Result<()>;
}

impl OutputSet {
    /// Returns a destination at `path` within this set, for a writer.
    pub fn at<'a>(&'a self, path: &'a Path) -> Destination<'a> {
        Destination {
            path,
            extension: None,
            driver: None,
            set: Some(self),
        }
    }

    /// Puts a mark into the names of the temporary files that are created from now on, so that
    /// those of a program that is killed can be [recognized](super::remove_abandoned). The first
    /// mark stays.
    pub fn mark(&self, mark: String) {
        let _ = self.mark.set(mark);
    }

    /// Calls a function with the target of each complete output and the file that will appear
    /// there. Bytes for pipes and devices cannot be read.
    ///
    /// # Errors
    /// Those of the function, and if a file cannot be read.
    pub fn read_back(&self, read: &mut dyn FnMut(&Path, &mut File) -> Result<()>) -> Result<()> {
        let Staged {
            companions,
            outputs,
            ..
        } = &mut *self.staged.borrow_mut();
        for output in companions.iter_mut().chain(outputs) {
            let target = output.target().to_path_buf();
            let file = output
                .read_back()
                .map_err(|e| Error::from(e).in_file(&target))?;
            file.map_or(Ok(()), |file| read(&target, file))
                .map_err(|e| e.in_file(&target))?;
        }
        Ok(())
    }

    /// Adds a complete output.
    pub fn add(&self, output: Output) {
        self.staged.borrow_mut().outputs.push(output);
    }

    /// Flushes the outputs so far to the disk and closes them, for sets of more files than a
    /// process may have open. [`read_back`](Self::read_back) leaves them out.
    ///
    /// # Errors
    /// If the last bytes cannot be written.
    pub(crate) fn close_staged(&self) -> Result<()> {
        let mut staged = self.staged.borrow_mut();
        let open = std::mem::take(&mut staged.outputs);
        for output in open {
            let closed = output.flush_to_disk()?;
            staged.closed.push(closed);
        }
        Ok(())
    }

    /// Flushes all outputs to the disk, then renames them to their targets and returns the targets.
    /// Files that others need are renamed first, and come last in the result.
    ///
    /// # Errors
    /// If the last bytes cannot be written or a rename fails. All previous files are then restored;
    /// bytes that went to a pipe or a device are gone.
    pub fn commit(self) -> Result<Vec<PathBuf>> {
        self.commit_if(&|| Ok(()))
    }

    /// Like [`commit`](Self::commit), but renames nothing if a function fails, which is called once
    /// all outputs are on the disk: that may take long.
    ///
    /// # Errors
    /// Also those of the function.
    pub(crate) fn commit_if(self, confirm: &dyn Fn() -> Result<()>) -> Result<Vec<PathBuf>> {
        let Staged {
            companions,
            outputs,
            closed,
            stale,
            deferred,
        } = self.staged.into_inner();
        let companion_count = companions.len();
        let companions = companions.into_iter().map(Output::flush_to_disk);
        let closed = closed.into_iter().map(Ok);
        let outputs = outputs.into_iter().map(Output::flush_to_disk);
        let all = companions.chain(closed).chain(outputs);
        let flushed: Vec<Flushed> = all.collect::<Result<_>>()?;
        confirm()?;
        // Dropped before `flushed`, whose remains are removed under the same lock.
        let mut renames = Renames::begin();
        let mut moves = Vec::new();
        let names: Vec<PathBuf> = deferred
            .iter()
            .map(|of| of.target().to_path_buf())
            .collect();
        let replaced = replace_all(&flushed, &stale, &mut moves, &mut renames);
        // Renames can be undone, the end of a transaction cannot.
        let appear = || deferred.into_iter().try_for_each(Deferred::appear);
        match replaced.and_then(|()| appear()) {
            Ok(()) => {
                moves.iter().for_each(Move::forget);
                drop(renames);
                let mut targets: Vec<PathBuf> =
                    flushed.into_iter().map(|file| file.target).collect();
                targets.rotate_left(companion_count);
                targets.extend(names);
                Ok(targets)
            }
            Err(error) => Err(moves
                .iter()
                .rev()
                .fold(error, |error, done| match done.undo() {
                    Ok(()) => error,
                    Err(kept) => error.cure(kept),
                })),
        }
    }
}

/// Where a writer puts its files: at a path, as soon as they are complete; or, through
/// [`OutputSet::at`], together with the other files of a set.
#[derive(Debug, Clone, Copy)]
pub struct Destination<'a> {
    path: &'a Path,
    extension: Option<&'a str>,
    driver: Option<&'a OutputDriver>,
    set: Option<&'a OutputSet>,
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for Destination<'a> {
    fn from(path: &'a P) -> Self {
        Destination {
            path: path.as_ref(),
            extension: None,
            driver: None,
            set: None,
        }
    }
}

impl<'a> Destination<'a> {
    /// Returns the path of the main file.
    pub fn path(self) -> &'a Path {
        self.path
    }

    /// Returns this destination with the format of an extension, for paths whose own names no
    /// format.
    #[must_use]
    pub fn in_format(self, extension: &'a str) -> Self {
        Destination {
            extension: Some(extension),
            ..self
        }
    }

    /// Returns this destination, written by a driver of GDAL.
    #[must_use]
    pub(crate) fn by_driver(self, driver: Option<&'a OutputDriver>) -> Self {
        Destination { driver, ..self }
    }

    /// Returns the driver of GDAL that writes the output; `None` if this crate does.
    pub(crate) fn driver(self) -> Option<&'a OutputDriver> {
        self.driver
    }

    /// Opens the output, as [`Output::create`] does.
    ///
    /// # Errors
    /// As [`Output::create`].
    pub fn create(self) -> Result<Output> {
        self.create_beside(self.path)
    }

    /// Opens the output, as [`Output::create_seekable`] does.
    ///
    /// # Errors
    /// As [`Output::create`].
    pub fn create_seekable(self) -> Result<Output> {
        self.create_seekable_beside(self.path)
    }

    /// Opens another output of the same set.
    ///
    /// # Errors
    /// As [`Output::create`].
    pub(crate) fn create_beside(self, path: &Path) -> Result<Output> {
        Output::open(path, self.mark(), Writing::InOrder)
    }

    /// Opens another output of the same set, as [`Output::create_seekable`] does.
    ///
    /// # Errors
    /// As [`Output::create`].
    pub(crate) fn create_seekable_beside(self, path: &Path) -> Result<Output> {
        Output::open(path, self.mark(), Writing::AnyOrder)
    }

    /// Returns how the name of a temporary file or folder next to the output begins.
    pub(crate) fn temporary_prefix(self) -> String {
        temporary::prefix(self.mark())
    }

    fn mark(self) -> Option<&'a str> {
        self.set.and_then(|set| set.mark.get()).map(String::as_str)
    }

    /// Returns a path whose extension names the format.
    pub(crate) fn format_path(self) -> PathBuf {
        match self.extension {
            Some(extension) => self.path.with_extension(extension),
            None => self.path.to_path_buf(),
        }
    }

    /// Returns an empty file without a name, on the disk of the output, for what is needed until it
    /// is complete.
    ///
    /// # Errors
    /// If it cannot be created.
    pub(crate) fn scratch(self) -> Result<File> {
        file::scratch_for(self.path).map_err(|e| e.in_file(self.path))
    }

    /// Runs a writer and takes the files that it has written, unless it fails. This covers writers
    /// that are stopped by their source without noticing.
    ///
    /// # Errors
    /// Those of the writer and of [`OutputSet::commit`].
    pub(crate) fn put_whole<T>(self, write: impl FnOnce(Destination) -> Result<T>) -> Result<T> {
        let own = OutputSet::default();
        let written = write(Destination {
            set: Some(self.set.unwrap_or(&own)),
            ..self
        })?;
        own.commit()?;
        Ok(written)
    }

    /// Creates an output, calls a function that writes it, and takes it.
    ///
    /// # Errors
    /// Those of the function, of [`Output::create`] and of [`OutputSet::commit`].
    pub(crate) fn write_with<T>(
        self,
        write: impl FnOnce(&mut Output) -> std::io::Result<T>,
    ) -> Result<T> {
        let mut output = self.create()?;
        let written = write(&mut output).map_err(|e| Error::from(e).in_file(self.path))?;
        self.put(output)?;
        Ok(written)
    }

    /// Takes a complete output.
    ///
    /// # Errors
    /// As [`OutputSet::commit`].
    pub fn put(self, output: Output) -> Result<()> {
        self.put_all([], output, [])
    }

    /// Takes an output with the files that it needs, and removes files that would be wrong next to
    /// it.
    ///
    /// # Errors
    /// As [`OutputSet::commit`].
    pub(crate) fn put_all(
        self,
        companions: impl IntoIterator<Item = Output>,
        output: Output,
        stale: impl IntoIterator<Item = PathBuf>,
    ) -> Result<()> {
        let own = OutputSet::default();
        let mut staged = self.set.unwrap_or(&own).staged.borrow_mut();
        staged.companions.extend(companions);
        staged.outputs.push(output);
        staged.stale.extend(stale);
        drop(staged);
        own.commit().map(drop)
    }
}

#[cfg(feature = "gdal")]
impl Destination<'_> {
    /// Returns a hidden folder on the disk of the output, for files that a library writes by path.
    ///
    /// # Errors
    /// If it cannot be created.
    pub(crate) fn staging_folder(self) -> Result<Temporary> {
        let created = match TargetKind::of(self.path).map_err(|e| e.in_file(self.path))? {
            TargetKind::File(path) => Temporary::folder_beside(&path, &self.temporary_prefix()),
            TargetKind::Stream => Temporary::folder_in(&std::env::temp_dir()),
        };
        created.map_err(|e| Error::from(e).in_file(self.path))
    }

    /// Takes what a library has written in a [staging folder](Self::staging_folder): files and
    /// folders, each of which will appear next to the output, under its own name. Old files that
    /// would be wrong next to it are removed.
    ///
    /// # Errors
    /// If what is there must stay, if there is a folder where one is to appear, or as
    /// [`OutputSet::commit`].
    pub(crate) fn put_staged(self, folder: &Path, stale: &[PathBuf]) -> Result<()> {
        let in_file = |error: std::io::Error| Error::from(error).in_file(self.path);
        let (mut outputs, mut folders) = (Vec::new(), Vec::new());
        let mut entries: Vec<_> = std::fs::read_dir(folder)
            .and_then(Iterator::collect)
            .map_err(in_file)?;
        entries.sort_unstable_by_key(std::fs::DirEntry::file_name);
        for entry in entries {
            let target = match Some(entry.file_name().as_os_str()) == self.path.file_name() {
                true => self.path.to_path_buf(),
                false => self.path.with_file_name(entry.file_name()),
            };
            let is_main = target == self.path;
            // A pipe or a device has nothing beside it.
            if !is_main && file::is_stream(self.path) {
                continue;
            }
            if !is_main && let Some(driver) = self.driver {
                driver.require_free(&target)?;
            }
            if entry.file_type().map_err(in_file)?.is_dir() {
                folders.push(self.adopted_folder(&entry.path(), target)?);
            } else {
                let output = Output::adopt(&entry.path(), &target, self.mark())?;
                outputs.push((is_main, output));
            }
        }
        // What others need comes first: the output itself is the last.
        outputs.sort_by_key(|(is_main, _)| *is_main);
        let is_written = |path: &&PathBuf| !outputs.iter().any(|(_, own)| own.target() == *path);
        let stale: Vec<PathBuf> = stale.iter().filter(is_written).cloned().collect();
        let own = OutputSet::default();
        let mut staged = self.set.unwrap_or(&own).staged.borrow_mut();
        if let Some((_, twice)) = outputs.iter().find(|(_, new)| staged.has(new.target())) {
            let error = "another output of this run writes this file, too";
            return Err(Error::usage(error)
                .in_file(twice.target())
                .cure("give one of them another name"));
        }
        for (is_main, output) in outputs {
            match is_main {
                true => staged.outputs.push(output),
                false => staged.companions.push(output),
            }
        }
        staged.closed.extend(folders);
        staged.stale.extend(stale);
        drop(staged);
        own.commit().map(drop)
    }

    /// Returns a complete folder under a hidden name, next to where it will appear.
    fn adopted_folder(self, folder: &Path, target: PathBuf) -> Result<Flushed> {
        let adopt = || -> Result<Temporary> {
            if target.symlink_metadata().is_ok() {
                return Err(target::folder_error());
            }
            let hidden = Temporary::folder_beside(&target, &self.temporary_prefix())?;
            // In the place of one that is empty.
            std::fs::rename(folder, hidden.path())?;
            Ok(hidden)
        };
        match adopt() {
            Ok(hidden) => Ok(Flushed {
                renamed: Some((hidden, target.clone())),
                target,
            }),
            Err(error) => Err(error.in_file(&target)),
        }
    }

    /// Takes an output that is not a file.
    ///
    /// # Errors
    /// As [`OutputSet::commit`].
    pub(crate) fn put_deferred(self, output: Box<dyn Deferred>) -> Result<()> {
        let own = OutputSet::default();
        let set = self.set.unwrap_or(&own);
        set.staged.borrow_mut().deferred.push(output);
        own.commit().map(drop)
    }
}

/// A step of a commit: what it did to a path.
struct Move<'a> {
    target: &'a Path,
    /// Where the previous file is now.
    before: Option<PathBuf>,
}

impl Move<'_> {
    fn forget(&self) {
        if let Some(before) = &self.before {
            let _ = std::fs::remove_file(before);
        }
    }

    /// Restores the previous file.
    ///
    /// # Errors
    /// If that is impossible; the message says where the previous file is.
    fn undo(&self) -> std::result::Result<(), String> {
        let Some(before) = &self.before else {
            let _ = match self.target.is_dir() && !self.target.is_symlink() {
                true => std::fs::remove_dir_all(self.target),
                false => std::fs::remove_file(self.target),
            };
            return Ok(());
        };
        std::fs::rename(before, self.target).map_err(|_| {
            format!(
                "{} was not restored: it is kept as {}",
                self.target.display(),
                before.display()
            )
        })?;
        // A rename between two names of one file does nothing.
        self.forget();
        Ok(())
    }
}

fn replace_all<'a>(
    flushed: &'a [Flushed],
    stale: &'a [PathBuf],
    moves: &mut Vec<Move<'a>>,
    renames: &mut Renames,
) -> Result<()> {
    let files = || {
        flushed
            .iter()
            .filter_map(|file| Some((file, file.renamed.as_ref()?)))
    };
    // One hidden name per file, derived from those of the set's own files.
    if let Some((_, (first, _))) = files().next() {
        for (i, path) in stale.iter().enumerate() {
            if path.is_dir() {
                return Err(target::folder_error().in_file(path));
            }
            let before = beside(path, &first.other_backup(i));
            match std::fs::rename(path, &before) {
                Ok(()) => moves.push(Move {
                    target: path,
                    before: Some(before),
                }),
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(Error::from(error).in_file(path)),
            }
        }
    }
    for (file, (temporary, path)) in files() {
        let before = set_aside(temporary, path).map_err(|e| e.in_file(&file.target))?;
        let renamed = renames.rename(temporary, path);
        if renamed.is_ok() || before.is_some() {
            moves.push(Move {
                target: path,
                before,
            });
        }
        renamed.map_err(|e| Error::from(e).in_file(&file.target))?;
    }
    Ok(())
}

/// Gives the file at a path, if there is one, a second name; where links are not supported, renames
/// it.
fn set_aside(temporary: &Temporary, path: &Path) -> Result<Option<PathBuf>> {
    match std::fs::symlink_metadata(path) {
        Ok(data) if data.is_dir() => return Err(target::folder_error()),
        Ok(_) => {}
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.into()),
    }
    let before = temporary.backup();
    std::fs::hard_link(path, &before).or_else(|_| std::fs::rename(path, &before))?;
    Ok(Some(before))
}

/// Returns the path of `name` in the folder of `path`.
fn beside(path: &Path, name: &Path) -> PathBuf {
    path.with_file_name(name.file_name().unwrap_or_default())
}

impl Output {
    /// Flushes the file and renames it to the target, replacing any file there.
    ///
    /// # Errors
    /// If the last bytes cannot be written or the rename fails.
    pub fn commit(self) -> Result<()> {
        let set = OutputSet::default();
        set.add(self);
        set.commit().map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn staged(set: &OutputSet, path: &Path, text: &str) {
        let mut output = Output::create(path).unwrap();
        output.write_all(text.as_bytes()).unwrap();
        set.at(path).put(output).unwrap();
    }

    fn listed(folder: &Path) -> Vec<(String, String)> {
        let text = |path: &Path| std::fs::read_to_string(path).unwrap_or_else(|_| "/".to_owned());
        let mut all: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| {
                (
                    entry.file_name().into_string().unwrap(),
                    text(&entry.path()),
                )
            })
            .collect();
        all.sort();
        all
    }

    #[test]
    fn a_set_appears_whole() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name));
        std::fs::write(&a, "old").unwrap();
        std::fs::write(&c, "stale").unwrap();
        let set = OutputSet::default();
        staged(&set, &a, "new");
        let output = Output::create(&b).unwrap();
        set.at(&b)
            .put_all([], output, [c, folder.path().join("nothing")])
            .unwrap();
        set.commit().unwrap();
        assert_eq!(
            listed(folder.path()),
            [("a", "new"), ("b", "")].map(|(n, t)| (n.to_owned(), t.to_owned()))
        );
    }

    #[test]
    fn a_rename_that_fails_restores_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b, c, stale] = ["a", "b", "c", "s"].map(|name| folder.path().join(name));
        std::fs::write(&a, "old").unwrap();
        std::fs::write(&stale, "kept").unwrap();
        let set = OutputSet::default();
        staged(&set, &a, "new");
        staged(&set, &b, "new");
        let output = Output::create(&c).unwrap();
        set.at(&c).put_all([], output, [stale]).unwrap();
        // Appears after the check.
        std::fs::create_dir(&c).unwrap();
        let error = set.commit().unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with("c: there is a folder with this name"),
            "{error}"
        );
        let expected =
            [("a", "old"), ("c", "/"), ("s", "kept")].map(|(n, t)| (n.to_owned(), t.to_owned()));
        assert_eq!(listed(folder.path()), expected);
    }

    /// The disk may have taken long, and another process may have the right to the outputs since.
    #[test]
    fn what_is_not_confirmed_does_not_appear() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, "old").unwrap();
        let set = OutputSet::default();
        staged(&set, &path, "new");
        let confirm = || {
            let found = listed(folder.path());
            assert!(found.iter().any(|(_, text)| text == "new"), "{found:?}");
            assert!(found.contains(&("a".to_owned(), "old".to_owned())));
            Err(Error::not_yet("it belongs to others"))
        };
        let error = set.commit_if(&confirm).unwrap_err();
        assert_eq!(error.to_string(), "it belongs to others");
        assert_eq!(listed(folder.path()), [("a".to_owned(), "old".to_owned())]);
    }

    #[test]
    fn what_is_dropped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let set = OutputSet::default();
        staged(&set, &folder.path().join("a"), "new");
        assert_eq!(listed(folder.path()).len(), 1);
        drop(set);
        assert_eq!(listed(folder.path()), []);
    }
}
