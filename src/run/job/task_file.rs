//! The file that a task writes: named sections, facts, and a checksum over all of it.
//!
//! A task is done when its file has its name. It gets it by a rename, once it is complete, so a
//! task that is killed leaves nothing that counts. The length and the checksum at the end reveal a
//! file that was damaged later.

use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::Crc;
use serde_json::{Map, Value, json};
use tempfile::NamedTempFile;

use super::planned_file::FileState;
use crate::error::{Error, Result};
use crate::run::checksum::Summed;

/// The last bytes of a complete file.
const MAGIC: &[u8; 8] = b"BRKTASK1";

/// The end of names of files that are not complete.
pub(super) const UNFINISHED: &str = ".unfinished";

/// The fact that has the state of the file of points that a task has read.
pub(super) const INPUT: &str = "input";

/// The bytes after the facts: their length, the checksum, the magic.
const END: u64 = 8 + 4 + 8;

/// Creates a file that is not complete, under a name of its own.
pub(super) fn unfinished_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".").suffix(UNFINISHED);
    // Others may go on with the job: only the umask limits who may read the file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Writes the file of a task.
pub(super) struct TaskWriter {
    out: Summed<BufWriter<NamedTempFile>>,
    /// Names, with the positions of their first bytes.
    sections: Vec<(&'static str, u64)>,
    target: PathBuf,
}

/// The checksum covers what is written.
impl Write for TaskWriter {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl TaskWriter {
    pub(super) fn create(target: &Path) -> Result<Self> {
        let folder = target.parent().unwrap_or(Path::new("."));
        let file = unfinished_in(folder).map_err(|e| Error::from(e).in_file(target))?;
        let out = Summed::new(BufWriter::with_capacity(1 << 18, file));
        Ok(TaskWriter { out, sections: Vec::new(), target: target.to_path_buf() })
    }

    /// Begins a section; it ends where the next one begins.
    pub(super) fn begin(&mut self, name: &'static str) {
        self.sections.push((name, self.position()));
    }

    /// Returns the position of the next byte.
    pub(super) fn position(&self) -> u64 {
        self.out.length()
    }

    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.put_with(|out| out.write_all(bytes))
    }

    /// Writes what a function writes.
    pub(super) fn put_with(&mut self, write: impl FnOnce(&mut Self) -> std::io::Result<()>) -> Result<()> {
        write(self).map_err(|e| Error::from(e).in_file(&self.target))
    }

    /// Writes the facts and gives the file its name.
    pub(super) fn finish(mut self, facts: Map<String, Value>) -> Result<()> {
        let end = self.position();
        let ends = self.sections.iter().skip(1).map(|(_, at)| *at).chain([end]);
        let sections: Vec<Value> =
            self.sections.iter().zip(ends).map(|((name, from), to)| json!([name, from, to])).collect();
        let facts = json!({ "sections": sections, "facts": facts }).to_string();
        self.put(facts.as_bytes())?;
        self.put(&(facts.len() as u64).to_le_bytes())?;
        let checksum = self.out.sum();
        self.put(&checksum.to_le_bytes())?;
        self.put(MAGIC)?;
        let target = self.target;
        let named = |e: std::io::Error| Error::from(e).in_file(&target);
        let file = self.out.into_inner().into_inner().map_err(|e| named(e.into_error()))?;
        file.persist(&target).map(drop).map_err(|e| named(e.error))
    }
}

/// The file of a task that is done.
#[derive(Debug)]
pub(super) struct TaskFile {
    file: File,
    path: PathBuf,
    sections: Vec<(String, u64, u64)>,
    /// What the task found out.
    pub(super) facts: Map<String, Value>,
}

impl TaskFile {
    /// Opens a file; `None` if there is none.
    ///
    /// # Errors
    /// If it is not complete.
    pub(super) fn open(path: &Path) -> Result<Option<Self>> {
        match File::open(path) {
            Ok(file) => Self::read_end(file, path).map(Some).map_err(|e| e.in_file(path)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Error::from(error).in_file(path)),
        }
    }

    /// Opens the file of a task that is done.
    ///
    /// # Errors
    /// If the file is missing or not complete.
    pub(super) fn open_done(path: &Path) -> Result<Self> {
        Self::open(path)?.ok_or_else(|| {
            Error::format("the file of a task is missing").in_file(path).cure("run the job again with --resume")
        })
    }

    fn read_end(mut file: File, path: &Path) -> Result<Self> {
        let length = file.metadata()?.len();
        let mut end = [0; END as usize];
        let from = length.checked_sub(END).ok_or_else(damaged)?;
        read_at(&mut file, from, &mut end)?;
        let facts_length = u64::from_le_bytes(std::array::from_fn(|i| end[i]));
        let facts_from = from.checked_sub(facts_length).ok_or_else(damaged)?;
        if &end[12..] != MAGIC || facts_length > 1 << 26 {
            return Err(damaged());
        }
        let mut text = vec![0; facts_length as usize];
        read_at(&mut file, facts_from, &mut text)?;
        let mut value: Value = serde_json::from_slice(&text).map_err(|_| damaged())?;
        let section = |value: &Value| {
            let (from, to) = (value[1].as_u64()?, value[2].as_u64()?);
            (from <= to && to <= facts_from).then(|| Some((value[0].as_str()?.to_owned(), from, to)))?
        };
        let sections: Option<Vec<_>> = value["sections"].as_array().and_then(|all| all.iter().map(section).collect());
        let facts = value.get_mut("facts").map(Value::take);
        let (Some(sections), Some(Value::Object(facts))) = (sections, facts) else { return Err(damaged()) };
        Ok(TaskFile { file, path: path.to_path_buf(), sections, facts })
    }

    /// Returns the state of the file of points that the task has read; `None` if it reads none.
    pub(super) fn state_of_input(&self) -> Option<FileState> {
        self.facts.get(INPUT).and_then(FileState::from_json)
    }

    /// Returns an error if the checksum is not that of the bytes.
    pub(super) fn verify(&mut self) -> Result<()> {
        self.checked().map_err(|e| e.in_file(&self.path))
    }

    fn checked(&mut self) -> Result<()> {
        let length = self.file.metadata()?.len();
        self.file.seek(SeekFrom::Start(0))?;
        let mut checksum = Crc::new();
        let mut buffer = vec![0; 1 << 18];
        // All but the checksum itself and the magic.
        let mut left = length.saturating_sub(END - 8);
        while left > 0 {
            let count = left.min(buffer.len() as u64) as usize;
            self.file.read_exact(&mut buffer[..count])?;
            checksum.update(&buffer[..count]);
            left -= count as u64;
        }
        let mut stated = [0; 4];
        self.file.read_exact(&mut stated)?;
        if checksum.sum() == u32::from_le_bytes(stated) { Ok(()) } else { Err(damaged()) }
    }

    /// Returns the position and the length of a section; both 0 if there is none.
    pub(super) fn range(&self, name: &str) -> (u64, u64) {
        self.sections.iter().find(|(known, ..)| known == name).map_or((0, 0), |(_, from, to)| (*from, to - from))
    }

    /// Returns the bytes of a section; none if it does not exist.
    pub(super) fn section(&mut self, name: &str) -> Result<Vec<u8>> {
        let (from, length) = self.range(name);
        let mut bytes = vec![0; length as usize];
        self.read(from, &mut bytes)?;
        Ok(bytes)
    }

    /// Reads bytes from a position on.
    pub(super) fn read(&mut self, from: u64, bytes: &mut [u8]) -> Result<()> {
        read_at(&mut self.file, from, bytes).map_err(|e| e.in_file(&self.path))
    }

    /// Returns a reader of the bytes from a position on.
    pub(super) fn reader(&mut self, from: u64) -> Result<impl Read + '_> {
        self.file.seek(SeekFrom::Start(from)).map_err(|e| Error::from(e).in_file(&self.path))?;
        Ok(std::io::BufReader::new(&mut self.file))
    }

    /// Returns a number among the facts; 0 if there is none.
    pub(super) fn count(&self, name: &str) -> u64 {
        self.facts.get(name).and_then(Value::as_u64).unwrap_or(0)
    }

    /// Returns an error that says that a section contains something else than was written.
    #[cold]
    pub(super) fn damaged(&self) -> Error {
        damaged().in_file(&self.path)
    }
}

fn read_at(file: &mut File, from: u64, bytes: &mut [u8]) -> Result<()> {
    file.seek(SeekFrom::Start(from))?;
    Ok(file.read_exact(bytes)?)
}

#[cold]
fn damaged() -> Error {
    Error::format("the file of a task is damaged").cure("remove it, and run the job again with --resume")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(path: &Path) {
        let mut writer = TaskWriter::create(path).unwrap();
        writer.begin("one");
        writer.put(b"abc").unwrap();
        writer.begin("none");
        writer.begin("two");
        writer.put(b"defgh").unwrap();
        let facts = Map::from_iter([("points".to_owned(), json!(7))]);
        writer.finish(facts).unwrap();
    }

    #[test]
    fn sections_and_facts_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("1.task");
        assert!(TaskFile::open(&path).unwrap().is_none());
        drop(TaskWriter::create(&path).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        written(&path);
        let mut file = TaskFile::open(&path).unwrap().unwrap();
        file.verify().unwrap();
        assert_eq!(file.section("one").unwrap(), b"abc");
        assert_eq!(file.section("two").unwrap(), b"defgh");
        assert!(file.section("none").unwrap().is_empty() && file.section("three").unwrap().is_empty());
        assert_eq!((file.count("points"), file.count("lines")), (7, 0));
    }

    /// Every byte that changes and every end that is missing is noticed.
    #[test]
    fn damage_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("1.task");
        written(&path);
        let whole = std::fs::read(&path).unwrap();
        for i in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[i] ^= 0x11;
            std::fs::write(&path, &bytes).unwrap();
            let checked = TaskFile::open(&path).and_then(|file| file.unwrap().verify());
            assert!(checked.is_err(), "byte {i}");
            std::fs::write(&path, &whole[..i]).unwrap();
            assert!(TaskFile::open(&path).and_then(|file| file.unwrap().verify()).is_err(), "length {i}");
        }
    }
}
