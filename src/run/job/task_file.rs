//! The file that a task writes: named sections, facts, and checksums of all of it.
//!
//! A task is done when its file has its name. It gets it by a rename, once it is complete, so a
//! task that is killed leaves nothing that counts. The end names the job and the task, so that no
//! file counts in the place of another, and has the checksums of what the task was made from.
//! Whatever is read in one go has a checksum of its own: bytes are compared with it as they are
//! read, and no byte is read for that alone.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::Crc;
use serde_json::{Value, json};
use tempfile::NamedTempFile;

use super::planned_file::FileState;
use super::task_facts::TaskFacts;
use crate::error::{Command, Error, Kind, Result, Setting, Wording, wording};
use crate::run::sources::checksum::{Summed, checksum};

/// The last bytes of a complete file.
const MAGIC: &[u8; 8] = b"BRKTASK5";

/// What the last bytes of complete files of all versions begin with.
const ANY_MAGIC: &[u8] = b"BRKTASK";

/// The end of names of files that are not complete.
pub(super) const UNFINISHED: &str = ".unfinished";

/// The begin of the names of such files.
const UNFINISHED_BEGIN: &str = ".breakline-";

/// The bytes after the facts: their length, the checksum of both, the magic.
const END: u64 = 8 + 4 + 8;

/// Creates a file that is not complete, under a name of its own.
pub(super) fn unfinished_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED_BEGIN).suffix(UNFINISHED);
    // Others may go on with the job: only the umask limits who may read the file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Returns true if a file has a name that [`unfinished_in`] gives.
pub(super) fn is_unfinished(path: &Path) -> bool {
    let name = path
        .file_name()
        .and_then(|name| name.to_str())
        .unwrap_or_default();
    name.starts_with(UNFINISHED_BEGIN) && name.ends_with(UNFINISHED)
}

/// Returns true if a file ends as the file of a task does, of whatever version.
pub(super) fn looks_like_task(path: &Path) -> bool {
    let mut end = [0; MAGIC.len()];
    let read = File::open(path).and_then(|mut file| {
        file.seek(SeekFrom::End(-(MAGIC.len() as i64)))?;
        file.read_exact(&mut end)
    });
    read.is_ok() && end.starts_with(ANY_MAGIC)
}

/// Whose file it is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TaskName {
    pub(super) path: PathBuf,
    /// What names the job.
    pub(super) job: u64,
    /// The key of the task.
    pub(super) task: String,
}

/// Bytes that are read in one go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    /// The position of the first one.
    pub(super) at: u64,
    pub(super) length: u64,
    /// Their CRC-32.
    pub(super) sum: u32,
}

impl Block {
    fn end(&self) -> Option<u64> {
        self.at.checked_add(self.length)
    }
}

/// What there is under the name of the file of a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    Whole,
    /// What is damaged, by its checksums.
    Damaged,
    /// Nothing, or the file of another job or task.
    Nothing,
}

impl TaskName {
    /// Reads the file and says what it is.
    ///
    /// # Errors
    /// If it cannot be read.
    pub(super) fn found(&self) -> Result<Found> {
        match TaskFile::open(self).and_then(|file| file.map(|mut file| file.verify()).transpose()) {
            Ok(Some(())) => Ok(Found::Whole),
            Ok(None) => Ok(Found::Nothing),
            Err(error) => match error.kind() {
                Kind::Format => Ok(Found::Damaged),
                Kind::NotYet => Ok(Found::Nothing),
                _ => Err(error),
            },
        }
    }

    /// Reads the file, removes it if it is damaged, and says what was found.
    ///
    /// # Errors
    /// If it cannot be read or removed.
    pub(super) fn remove_if_damaged(&self) -> Result<Found> {
        let found = self.found()?;
        if found != Found::Damaged {
            return Ok(found);
        }
        // Another process may have made it again since it was read: so it is renamed and read once
        // more before it goes.
        let named = |e: std::io::Error| Error::from(e).in_file(&self.path);
        let aside = unfinished_in(self.path.parent().unwrap_or(Path::new(".")))
            .map_err(named)?
            .into_temp_path();
        match std::fs::rename(&self.path, &aside) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Found::Nothing);
            }
            renamed => renamed.map_err(named)?,
        }
        let found = TaskName {
            path: aside.to_path_buf(),
            ..self.clone()
        }
        .found()?;
        if found != Found::Damaged {
            aside.persist(&self.path).map_err(|e| named(e.error))?;
        }
        Ok(found)
    }
}

/// Returns what the file of a task says that its job and its task are; `None` if that cannot be
/// read.
pub(super) fn name_in(path: &Path) -> Option<(u64, String)> {
    let (_, value, _) = read_value(File::open(path).ok()?).ok()?;
    Some((value["job"].as_u64()?, value["task"].as_str()?.to_owned()))
}

/// Writes the file of a task.
pub(super) struct TaskWriter {
    out: Summed<BufWriter<NamedTempFile>>,
    /// The sections that are complete.
    sections: Vec<(&'static str, Block)>,
    /// The section that is being written, and where it begins.
    open: Option<(&'static str, u64)>,
    name: TaskName,
}

/// The checksums cover what is written.
impl Write for TaskWriter {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl TaskWriter {
    pub(super) fn create(name: TaskName) -> Result<Self> {
        let folder = name.path.parent().unwrap_or(Path::new("."));
        let file = unfinished_in(folder).map_err(|e| Error::from(e).in_file(&name.path))?;
        let out = Summed::new(BufWriter::with_capacity(1 << 18, file));
        Ok(TaskWriter {
            out,
            sections: Vec::new(),
            open: None,
            name,
        })
    }

    /// Begins a section; it ends where the next one begins.
    pub(super) fn begin(&mut self, name: &'static str) {
        self.end_section();
        self.open = Some((name, self.out.length()));
    }

    fn end_section(&mut self) {
        let (end, sum) = (self.out.length(), self.out.take_sum());
        if let Some((name, at)) = self.open.take() {
            self.sections.push((
                name,
                Block {
                    at,
                    length: end - at,
                    sum,
                },
            ));
        }
    }

    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.put_with(|out| out.write_all(bytes))
    }

    /// Writes bytes that will be read in one go, and not with the rest of the section.
    pub(super) fn put_block(&mut self, bytes: &[u8]) -> Result<Block> {
        let block = Block {
            at: self.out.length(),
            length: bytes.len() as u64,
            sum: checksum(bytes),
        };
        self.put(bytes).map(|()| block)
    }

    /// Writes what a function writes.
    pub(super) fn put_with(
        &mut self,
        write: impl FnOnce(&mut Self) -> std::io::Result<()>,
    ) -> Result<()> {
        write(self).map_err(|e| Error::from(e).in_file(&self.name.path))
    }

    /// Writes the facts and gives the file its name, unless `confirm` fails, which is called right
    /// before that. `sources` is the checksum of what the task was made from.
    pub(super) fn finish(
        mut self,
        facts: &TaskFacts,
        sources: u32,
        confirm: &dyn Fn() -> Result<()>,
    ) -> Result<()> {
        self.end_section();
        let facts = kept(facts).map_err(|e| e.in_file(&self.name.path))?;
        let section =
            |(name, block): &(&str, Block)| json!([name, block.at, block.length, block.sum]);
        let sections: Vec<Value> = self.sections.iter().map(section).collect();
        let TaskName { job, task, .. } = &self.name;
        let content = checksum(json!([sections, facts]).to_string().as_bytes());
        let end = json!({
            "job": job, "task": task, "sources": sources, "content": content, "sections": sections, "facts": facts
        });
        let end = end.to_string();
        self.put(end.as_bytes())?;
        self.put(&(end.len() as u64).to_le_bytes())?;
        let sum = self.out.take_sum();
        self.put(&sum.to_le_bytes())?;
        self.put(MAGIC)?;
        let target = self.name.path;
        let named = |e: std::io::Error| Error::from(e).in_file(&target);
        let file = self
            .out
            .into_inner()
            .into_inner()
            .map_err(|e| named(e.into_error()))?;
        confirm()?;
        file.persist(&target).map(drop).map_err(|e| named(e.error))
    }
}

/// Returns facts as they are kept.
///
/// # Errors
/// If they could not be read again: a number is not finite.
fn kept(facts: &TaskFacts) -> Result<Value> {
    let stored = serde_json::to_value(facts).map_err(std::io::Error::from)?;
    match serde_json::from_value::<TaskFacts>(stored.clone()) {
        Ok(_) => Ok(stored),
        Err(_) => Err(Error::limit("what a task found out has a number that is not finite")
            .cure("check the heights of the points and lines: some are too far apart to be subtracted")),
    }
}

/// A file of which some bytes are read, often those behind the ones that were read before: small
/// blocks then do not cost two system calls each.
#[derive(Debug)]
struct FileReader {
    file: BufReader<File>,
    /// Where it goes on; `None` if that is not known.
    at: Option<u64>,
}

impl FileReader {
    fn new(file: File) -> Self {
        FileReader {
            file: BufReader::new(file),
            at: Some(0),
        }
    }

    /// Reads the bytes from a position on.
    fn read(&mut self, from: u64, bytes: &mut [u8]) -> Result<()> {
        match self.at.take() {
            // This keeps what is in memory already.
            Some(at) => self.file.seek_relative(from.wrapping_sub(at) as i64)?,
            None => self.file.seek(SeekFrom::Start(from)).map(drop)?,
        }
        self.file.read_exact(bytes)?;
        self.at = Some(from + bytes.len() as u64);
        Ok(())
    }
}

/// The file of a task that is done.
#[derive(Debug)]
pub(super) struct TaskFile {
    reader: FileReader,
    path: PathBuf,
    sections: Vec<(String, Block)>,
    /// The bytes before the end.
    length: u64,
    /// The checksum of what was found out and of the checksums of all sections, and so of all that
    /// the task has made.
    pub(super) sum: u32,
    /// The checksum of what the task was made from.
    pub(super) sources: u32,
    /// What the task found out.
    pub(super) facts: TaskFacts,
}

impl TaskFile {
    /// Opens a file; `None` if there is none.
    ///
    /// # Errors
    /// If it is not complete, or the file of another job or task.
    pub(super) fn open(name: &TaskName) -> Result<Option<Self>> {
        match File::open(&name.path) {
            Ok(file) => Self::read_end(file, name)
                .map(Some)
                .map_err(|e| e.in_file(&name.path)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Error::from(error).in_file(&name.path)),
        }
    }

    /// Opens the file of a task that is done.
    ///
    /// # Errors
    /// If the file is missing, not complete, or that of another job or task.
    pub(super) fn open_done(name: &TaskName) -> Result<Self> {
        Self::open(name)?.ok_or_else(|| {
            Error::not_yet("the file of a task is missing")
                .in_file(&name.path)
                .cure(wording!["run the job again with ", Setting::Resume.on()])
        })
    }

    fn read_end(file: File, name: &TaskName) -> Result<Self> {
        let (reader, mut value, text_from) = read_value(file)?;
        let (Some(job), Some(task)) = (value["job"].as_u64(), value["task"].as_str()) else {
            return Err(damaged());
        };
        if job != name.job {
            return Err(Error::not_yet("this is the file of another job").cure(make_again()));
        }
        if task != name.task {
            let message = "this is the file of another task, or was made from other inputs";
            return Err(Error::not_yet(message).cure(make_again()));
        }
        let number = |value: &Value| u32::try_from(value.as_u64()?).ok();
        let section = |value: &Value| {
            let block = Block {
                at: value[1].as_u64()?,
                length: value[2].as_u64()?,
                sum: number(&value[3])?,
            };
            Some((value[0].as_str()?.to_owned(), block))
        };
        let sections: Option<Vec<_>> = value["sections"]
            .as_array()
            .and_then(|all| all.iter().map(section).collect());
        let sources = number(&value["sources"]);
        let facts = value
            .get_mut("facts")
            .map(Value::take)
            .and_then(|facts| serde_json::from_value(facts).ok());
        let content = number(&value["content"]);
        let (Some(sections), Some(sources), Some(sum), Some(facts)) =
            (sections, sources, content, facts)
        else {
            return Err(damaged());
        };
        Ok(TaskFile {
            reader,
            path: name.path.clone(),
            sections,
            length: text_from,
            sum,
            sources,
            facts,
        })
    }

    /// Returns the state of the file of points that the task has read; `None` if it reads none.
    pub(super) fn state_of_input(&self) -> Option<FileState> {
        self.facts.read().map(|read| read.state)
    }

    /// Returns an error unless all bytes are those that were written.
    pub(super) fn verify(&mut self) -> Result<()> {
        let mut end = 0;
        let mut buffer = vec![0; 1 << 18];
        for (_, section) in &self.sections {
            if section.at != end || section.end().is_none_or(|end| end > self.length) {
                return Err(self.damaged());
            }
            end += section.length;
            let mut sum = Crc::new();
            let mut left = section.length;
            while left > 0 {
                let count = left.min(buffer.len() as u64) as usize;
                let at = end - left;
                self.reader
                    .read(at, &mut buffer[..count])
                    .map_err(|e| e.in_file(&self.path))?;
                sum.update(&buffer[..count]);
                left -= count as u64;
            }
            if sum.sum() != section.sum {
                return Err(self.damaged());
            }
        }
        if end == self.length {
            Ok(())
        } else {
            Err(self.damaged())
        }
    }

    /// Returns the bytes of a section; none if it does not exist.
    ///
    /// # Errors
    /// If they cannot be read, or are not those that were written.
    pub(super) fn section(&mut self, name: &str) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        if let Some(&(_, block)) = self.sections.iter().find(|(known, _)| known == name) {
            self.read(block, &mut bytes)?;
        }
        Ok(bytes)
    }

    /// Reads the bytes of a block, which replace those in `bytes`.
    ///
    /// # Errors
    /// If they cannot be read, or are not those that were written.
    pub(super) fn read(&mut self, block: Block, bytes: &mut Vec<u8>) -> Result<()> {
        if block.end().is_none_or(|end| end > self.length) {
            return Err(self.damaged());
        }
        bytes.resize(block.length as usize, 0);
        self.reader
            .read(block.at, bytes)
            .map_err(|e| e.in_file(&self.path))?;
        if checksum(bytes) == block.sum {
            Ok(())
        } else {
            Err(self.damaged())
        }
    }

    /// Returns an error that says that the file contains something else than was written.
    #[cold]
    pub(super) fn damaged(&self) -> Error {
        damaged().in_file(&self.path)
    }
}

/// Reads the end of the file of a task. Returns a reader of the file, the end, and the position
/// where that begins.
fn read_value(file: File) -> Result<(FileReader, Value, u64)> {
    let length = file.metadata()?.len();
    let mut reader = FileReader::new(file);
    let mut end = [0; END as usize];
    let from = length.checked_sub(END).ok_or_else(damaged)?;
    reader.read(from, &mut end)?;
    let text_length = u64::from_le_bytes(std::array::from_fn(|i| end[i]));
    let stated = u32::from_le_bytes(std::array::from_fn(|i| end[8 + i]));
    let text_from = from.checked_sub(text_length).ok_or_else(damaged)?;
    if &end[12..] != MAGIC || text_length > 1 << 26 {
        return Err(damaged());
    }
    let mut text = vec![0; text_length as usize];
    reader.read(text_from, &mut text)?;
    let mut sum = Crc::new();
    sum.update(&text);
    sum.update(&end[..8]);
    if sum.sum() != stated {
        return Err(damaged());
    }
    let value: Value = serde_json::from_slice(&text).map_err(|_| damaged())?;
    Ok((reader, value, text_from))
}

/// What makes a file again.
fn make_again() -> Wording {
    wording![
        "run the job again with ",
        Setting::Resume.on(),
        ", or do this task again (",
        Command::JobRun,
        ")"
    ]
}

#[cold]
fn damaged() -> Error {
    Error::format("the file of a task is damaged").cure(wording![
        "run the job again with ",
        Setting::Resume.on(),
        "; or ",
        Command::JobVerify,
        " removes it, so that the task is done again"
    ])
}

#[cfg(test)]
mod tests {
    use super::super::task_facts::{FileFacts, ReadFacts};
    use super::*;

    fn name(folder: &Path) -> TaskName {
        TaskName {
            path: folder.join("1.task"),
            job: 0xfeed_beef,
            task: "one".to_owned(),
        }
    }

    /// A file with two blocks in its first section.
    fn written(name: &TaskName) -> [Block; 2] {
        let mut writer = TaskWriter::create(name.clone()).unwrap();
        writer.begin("one");
        let blocks = [b"ab", b"cd"].map(|bytes| writer.put_block(bytes).unwrap());
        writer.begin("none");
        writer.begin("two");
        writer.put(b"efgh").unwrap();
        writer
            .finish(
                &TaskFacts {
                    duplicates: 7,
                    ..TaskFacts::default()
                },
                5,
                &|| Ok(()),
            )
            .unwrap();
        blocks
    }

    #[test]
    fn sections_and_facts_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        assert!(TaskFile::open(&name).unwrap().is_none());
        drop(TaskWriter::create(name.clone()).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let blocks = written(&name);
        let mut file = TaskFile::open(&name).unwrap().unwrap();
        file.verify().unwrap();
        assert_eq!(file.section("one").unwrap(), b"abcd");
        assert_eq!(file.section("two").unwrap(), b"efgh");
        assert!(
            file.section("none").unwrap().is_empty() && file.section("three").unwrap().is_empty()
        );
        assert_eq!(
            (file.facts.duplicates, file.facts.line_edges, file.sources),
            (7, 0, 5)
        );
        let mut bytes = b"what was there before".to_vec();
        file.read(blocks[1], &mut bytes).unwrap();
        assert_eq!(bytes, b"cd");
    }

    #[test]
    fn a_file_that_could_not_be_read_again_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let rings = ReadFacts {
            rings: vec![(0, 1, 1e308 - -1e308)],
            ..ReadFacts::default()
        };
        for facts in [
            TaskFacts {
                file: Some(FileFacts::Read(rings)),
                ..TaskFacts::default()
            },
            TaskFacts {
                reach: [f64::INFINITY, 0.0],
                ..TaskFacts::default()
            },
            TaskFacts {
                holes: vec![[[f64::NAN; 2]; 2]],
                ..TaskFacts::default()
            },
        ] {
            let error = TaskWriter::create(name.clone())
                .unwrap()
                .finish(&facts, 5, &|| Ok(()))
                .unwrap_err();
            assert!(
                error.to_string().contains("a number that is not finite"),
                "{error}"
            );
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }

    /// Reads all of a file, as tasks do.
    fn read(name: &TaskName, blocks: [Block; 2]) -> Result<()> {
        let mut file = TaskFile::open_done(name)?;
        blocks
            .iter()
            .try_for_each(|block| file.read(*block, &mut Vec::new()))?;
        file.section("two").map(drop)
    }

    /// Every byte that changes and every end that is missing is noticed, by whoever reads it.
    #[test]
    fn damage_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let blocks = written(&name);
        read(&name, blocks).unwrap();
        let whole = std::fs::read(&name.path).unwrap();
        let is_damaged = |bytes: &[u8]| {
            std::fs::write(&name.path, bytes).unwrap();
            let verified = TaskFile::open_done(&name).and_then(|mut file| file.verify());
            [verified, read(&name, blocks)].iter().all(|checked| {
                checked.as_ref().is_err_and(|error| {
                    error
                        .to_string()
                        .ends_with("1.task: the file of a task is damaged")
                })
            })
        };
        for i in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[i] ^= 0x11;
            assert!(is_damaged(&bytes), "byte {i}");
            assert!(is_damaged(&whole[..i]), "length {i}");
        }
        // What was written is where it was, but there is more.
        std::fs::write(&name.path, [&whole[..], &whole[..]].concat()).unwrap();
        assert!(TaskFile::open_done(&name).unwrap().verify().is_err());
    }

    #[test]
    fn a_file_counts_for_its_own_job_and_task_only() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        written(&name);
        let said = |name: TaskName| TaskFile::open(&name).unwrap_err().to_string();
        let of_other_job = said(TaskName {
            job: 0xfeed_beee,
            ..name.clone()
        });
        assert!(
            of_other_job.ends_with("1.task: this is the file of another job"),
            "{of_other_job}"
        );
        let of_other_task = said(TaskName {
            task: "two".to_owned(),
            ..name.clone()
        });
        assert!(
            of_other_task
                .ends_with("this is the file of another task, or was made from other inputs"),
            "{of_other_task}"
        );
    }

    #[test]
    fn a_block_beyond_the_file_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let name = name(folder.path());
        let [block, _] = written(&name);
        let mut file = TaskFile::open_done(&name).unwrap();
        for block in [
            Block {
                length: u64::MAX,
                ..block
            },
            Block {
                at: u64::MAX,
                ..block
            },
            Block {
                at: 1 << 40,
                ..block
            },
        ] {
            assert!(file.read(block, &mut Vec::new()).is_err());
        }
    }
}
