//! What a job was planned for, kept with it: whoever finds the folder can do its tasks.

use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::TileOptions;
use super::folder::{COMMAND, StoredPlan};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::run::checksum::checksum;
use crate::run::surface::SurfaceRequest;
use crate::run::targets::Targets;
use crate::run::verbs::{self, WriteRequest};

/// What a job was planned for.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct JobCommand {
    /// The request.
    pub request: WriteRequest,
    /// The outputs.
    pub targets: Targets,
    /// The options of the tiles, without the folder of the job.
    pub tiles: TileOptions,
    /// The folder in which relative paths begin.
    pub folder: PathBuf,
    /// The words of a command line, to be shown; none if it was not typed.
    pub words: Vec<String>,
}

impl JobCommand {
    /// Reads what the job in a folder was planned for; `None` if the folder has no job.
    ///
    /// # Errors
    /// If that was not kept with the job, or is damaged, or that of another job; or if the plan is.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let Some(stored) = StoredPlan::read(folder)? else { return Ok(None) };
        let path = folder.join(COMMAND);
        let Some(sum) = stored.command else {
            return Err(Error::usage("the job in this folder is that of a command which goes on itself")
                .in_file(folder)
                .cure(wording!["repeat that command with ", Setting::Resume.on(), " and ", Setting::Job]));
        };
        let text = std::fs::read_to_string(&path).map_err(|e| Error::from(e).in_file(&path))?;
        let command = if u64::from(checksum(text.as_bytes())) == sum { serde_json::from_str(&text).ok() } else { None };
        command.map(Some).ok_or_else(|| {
            Error::format("the command of the job is damaged, or that of another one").in_file(path).cure(wording![
                "plan the job again: ",
                Command::JobClean,
                " removes this one"
            ])
        })
    }

    /// Returns the text that is kept.
    ///
    /// # Errors
    /// If something of it cannot be stored: lines in memory, a name that is not Unicode, a number
    /// that is not finite.
    pub(super) fn to_text(&self) -> Result<String> {
        let read = self.targets.read_with(&self.request.surface);
        let mut paths = read.iter().chain(&self.targets.files).chain([&self.folder]);
        if let Some(path) = paths.find(|path| path.to_str().is_none()) {
            return Err(Error::unsupported("the name is not valid Unicode, which a job needs").in_file(path));
        }
        let refused = |e: serde_json::Error| {
            Error::unsupported(format!("the request cannot be kept with a job: {e}"))
                .cure("write what is in memory to a file first, and use numbers that are finite")
        };
        let text = serde_json::to_string(self).map_err(refused)?;
        // Numbers that are not finite have no form of their own.
        serde_json::from_str::<JobCommand>(&text).map_err(refused)?;
        Ok(text)
    }
}

/// A request as it is stored.
#[derive(Serialize, Deserialize)]
struct StoredRequest {
    surface: SurfaceRequest,
    verb: String,
    options: Value,
}

impl Serialize for WriteRequest {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        let WriteRequest { surface, verb } = self;
        let verb = verb.as_ref();
        StoredRequest { surface: surface.clone(), verb: verb.name().to_owned(), options: verb.to_json() }.serialize(to)
    }
}

impl<'de> Deserialize<'de> for WriteRequest {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        let StoredRequest { surface, verb, options } = StoredRequest::deserialize(from)?;
        let verb = verbs::from_json(&verb, options).ok_or_else(|| D::Error::custom("the verb is not known"))?;
        Ok(WriteRequest { surface, verb })
    }
}
