//! What a job was planned for, kept with it: whoever finds the folder can do its tasks.

use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::folder::{COMMAND, NEXT_COMMAND, StoredPlan};
use super::plan;
use super::request::{self, Options};
use super::tile_options::TileOptions;
use crate::error::{Command, Error, Result, Wording, wording};
use crate::io::layer;
use crate::run::products::surface::{Source, SurfaceRequest};
use crate::run::sources::checksum::checksum;
use crate::run::verbs::targets::Targets;
use crate::run::verbs::{self, WriteRequest};

/// What a job is planned for, with whole names, so that any process can do its tasks.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JobCommand {
    /// The request.
    pub request: WriteRequest,
    /// The outputs.
    pub targets: Targets,
    /// The options of the tiles, without the folder of the job.
    pub tiles: TileOptions,
    /// The words of a command line, to be shown; none if it was not typed.
    pub words: Vec<String>,
}

impl JobCommand {
    /// Returns the command with these options. Names that are relative begin in the working folder,
    /// which is not asked for if there are none.
    ///
    /// # Errors
    /// If a name is empty, or the working folder is not known; if points are in memory, or come
    /// from the standard input, a pipe or a device.
    pub fn new(request: &WriteRequest, targets: &Targets, tiles: &TileOptions) -> Result<Self> {
        let mut targets = targets.clone();
        whole_names(|visit| targets.each_file(visit))?;
        let tiles = TileOptions {
            folder: None,
            ..tiles.clone()
        };
        Ok(JobCommand {
            request: whole(request)?,
            targets,
            tiles,
            words: Vec::new(),
        })
    }

    /// Reads the command that is kept with a job; `None` if none is kept: then only the call that
    /// planned the job goes on with it.
    ///
    /// # Errors
    /// If it is damaged, or that of another job.
    pub(super) fn read(folder: &Path, stored: &StoredPlan) -> Result<Option<Self>> {
        let Some(sum) = stored.command else {
            return Ok(None);
        };
        let path = folder.join(COMMAND);
        let text = std::fs::read_to_string(&path).map_err(|e| Error::from(e).in_file(&path))?;
        let of_job = |text: &String| u64::from(checksum(text.as_bytes())) == sum;
        // An update that was interrupted has not renamed it.
        let next = || std::fs::read_to_string(folder.join(NEXT_COMMAND)).ok();
        let text = Some(text).filter(of_job).or_else(|| next().filter(of_job));
        let command = text.and_then(|text| serde_json::from_str(&text).ok());
        command.map(Some).ok_or_else(|| {
            Error::format("the command of the job is damaged, or that of another one")
                .in_file(path)
                .cure(wording![
                    "plan the job again: ",
                    Command::JobClean.on(folder.display().to_string()),
                    " removes this one"
                ])
        })
    }

    /// Returns an error if this is not the same as what is asked for now.
    pub(super) fn require_same(&self, asked: &JobCommand, folder: &Path) -> Result<()> {
        let (own, asked) = (self.options()?, asked.options()?);
        if own == asked {
            Ok(())
        } else {
            Err(request::other_command(&own, &asked, folder))
        }
    }

    fn options(&self) -> Result<Options> {
        let JobCommand {
            request,
            targets,
            tiles,
            ..
        } = self;
        let mut options = request::asked(request, tiles)?;
        request::add_targets(&mut options, targets, tiles);
        Ok(options)
    }

    /// Returns the text that is kept with a job that was planned for these options.
    ///
    /// # Errors
    /// If something of it cannot be stored: what is in memory, a name that is not Unicode, a number
    /// that is not finite, a verb that is not one of this crate.
    pub(super) fn to_text(&self, planned: &Options) -> Result<String> {
        let mut files = self.request.files();
        self.targets
            .clone()
            .each_file(&mut |file| files.push(file.clone()));
        if let Some(path) = files.iter().find(|path| path.to_str().is_none()) {
            return Err(
                Error::unsupported("the name is not valid Unicode, which a job needs")
                    .in_file(path),
            );
        }
        let verb = self.request.verb.as_ref();
        if verbs::to_json(verb).is_none() {
            return Err(Error::unsupported(format!(
                "a job cannot keep the verb `{}`, which is not of this crate",
                verb.name()
            ))
            .cure("write the result in one call"));
        }
        let refused = |what: Wording| {
            Error::unsupported(wording!["the request cannot be kept with a job: ", what])
                .cure("write what is in memory to a file first, and use numbers that are finite")
        };
        let text = serde_json::to_string(self).map_err(|e| refused(e.to_string().into()))?;
        // A number that is not finite would come back as if it was not given.
        let kept: JobCommand =
            serde_json::from_str(&text).map_err(|e| refused(e.to_string().into()))?;
        let kept = request::asked(&kept.request, &kept.tiles)?;
        if kept != *planned {
            return Err(refused(wording![
                request::differing(planned, &kept),
                " would be lost"
            ]));
        }
        Ok(text)
    }
}

/// Returns a request with whole names.
///
/// # Errors
/// If a name is empty, or the working folder is not known; if points cannot be read again.
pub(super) fn whole(request: &WriteRequest) -> Result<WriteRequest> {
    let WriteRequest {
        mut surface,
        mut verb,
    } = request.clone();
    // The standard input has no whole name: it would become that of a file.
    if let Source::Points(points) = &surface.source {
        plan::require_readable_again(points)?;
    }
    whole_names(|visit| surface.each_file(visit))?;
    if let Some(file) = verb.also_reads() {
        let mut file = file.clone();
        whole_names(|visit| visit(&mut file))?;
        let other = verb
            .reading(file.clone())
            .filter(|other| other.also_reads() == Some(&file));
        verb = other.ok_or_else(|| {
            Error::unsupported("the verb cannot read this file under its whole name").in_file(&file)
        })?;
    }
    Ok(WriteRequest { surface, verb })
}

/// Makes names whole that a function visits.
fn whole_names(each_file: impl FnOnce(&mut dyn FnMut(&mut PathBuf))) -> Result<()> {
    let mut result = Ok(());
    each_file(&mut |file| match whole_name(file) {
        Ok(whole) => *file = whole,
        Err(error) if result.is_ok() => result = Err(Error::from(error).in_file(&*file)),
        Err(_) => {}
    });
    result
}

/// Returns the whole name of a file, followed by the names of a layer and the condition that the
/// path may have. Those are no path: two slashes in them are not one.
fn whole_name(path: &Path) -> std::io::Result<PathBuf> {
    let file = path.to_str().map(layer::file_of);
    let Some((text, file)) = path.to_str().zip(file.and_then(Path::to_str)) else {
        return std::path::absolute(path);
    };
    let mut whole = std::path::absolute(file)?.into_os_string();
    whole.push(&text[file.len()..]);
    Ok(whole.into())
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
        let (verb, options) = verbs::to_json(verb.as_ref())
            .ok_or_else(|| S::Error::custom("the verb is not of this crate"))?;
        StoredRequest {
            surface: surface.clone(),
            verb: verb.to_owned(),
            options,
        }
        .serialize(to)
    }
}

impl<'de> Deserialize<'de> for WriteRequest {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        let StoredRequest {
            surface,
            verb,
            options,
        } = StoredRequest::deserialize(from)?;
        let verb = verbs::from_json(&verb, options)
            .ok_or_else(|| D::Error::custom("the verb is not known"))?;
        Ok(WriteRequest { surface, verb })
    }
}
