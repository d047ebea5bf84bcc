//! Transforms by PROJ, from many threads.

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeSet, VecDeque};
use std::fmt::Write;
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use super::candidates::{Ends, plain_name, position};
use super::facts::{GridState, OperationFacts, OperationGrid};
use super::library::{Choice, Library, Object};
use super::options::TransformOptions;
use super::routes::{self, Route};
use crate::crs::{Crs, CrsKind, Transform};
use crate::error::{Error, Feature, Result, Setting, Wording, wording};

/// PROJ objects that a thread keeps. If more transforms are used at once, objects are created
/// again on use.
const KEPT: usize = 8;

/// An accuracy worse than this, in meters, is reported, because lidar is better.
const REPORTED: f64 = 0.1;

/// The most grids that a message names; there may be dozens, one for each state of a country.
const NAMED: usize = 3;

thread_local! {
    static LIBRARY: OnceCell<Rc<Library>> = const { OnceCell::new() };
    static OBJECTS: RefCell<VecDeque<(u64, Rc<Object>)>> = const { RefCell::new(VecDeque::new()) };
}

static NEXT: AtomicU64 = AtomicU64::new(0);

/// The transform from one system to another on a route; any thread can use it.
pub(super) struct Operation {
    /// Its key in [`OBJECTS`].
    id: u64,
    from: Crs,
    to: Crs,
    pub(super) route: Route,
    choice: Choice,
    epoch: Option<f64>,
    candidates: OnceLock<Vec<OperationFacts>>,
    notes: Mutex<Notes>,
}

#[derive(Default)]
struct Notes {
    warnings: BTreeSet<String>,
    /// The operations that were used.
    used: BTreeSet<String>,
}

/// See the documented [`transform`](super::transform).
pub(super) fn transform(
    from: &Crs,
    to: &Crs,
    options: &TransformOptions,
) -> Result<Box<dyn Transform>> {
    Ok(Box::new(Operation::best(from, to, options)?))
}

/// Returns this thread's library.
///
/// # Errors
/// If PROJ cannot be started.
pub(super) fn library() -> Result<Rc<Library>> {
    LIBRARY.with(|kept| {
        if let Some(library) = kept.get() {
            return Ok(library.clone());
        }
        let library = Library::open().map_err(Error::unsupported)?;
        Ok(kept.get_or_init(|| library).clone())
    })
}

impl Operation {
    /// Returns the transform of plan and heights, if there is one; else that in plan, with a
    /// warning about heights.
    pub(super) fn best(from: &Crs, to: &Crs, options: &TransformOptions) -> Result<Operation> {
        refuse(from, to)?;
        let (in_plan, kept) = routes::in_plan(from, to);
        let mut warnings = Vec::new();
        if let Some(route) = routes::with_heights(from, to) {
            let with_heights = Operation::new(from, to, route, options);
            // Created now, so that an impossible operation fails before anything is read.
            if with_heights.object().is_ok() && with_heights.is_usable() {
                return Ok(with_heights);
            }
            let (reason, cure) = with_heights.why_not();
            match kept {
                Some(kept) if !options.require_grids => {
                    warnings.push(format!("{kept}: {reason}; {}", cure.plain()));
                }
                // No warning: both systems count heights from an ellipsoid, so they are kept.
                None if !options.require_grids => {}
                _ => {
                    let error = Error::unsupported(format!(
                        "heights cannot be transformed from {from} to {to}: {reason}"
                    ));
                    return Err(error.cure(cure));
                }
            }
        } else {
            warnings.extend(kept);
        }
        let plan = Operation::new(from, to, in_plan, options);
        plan.notes().warnings.extend(warnings);
        let object = plan.object()?;
        plan.record(&object, None);
        Ok(plan)
    }

    pub(super) fn new(from: &Crs, to: &Crs, route: Route, options: &TransformOptions) -> Operation {
        let choice = Choice {
            // Heights that a ballpark transform leaves as they are look like transformed ones.
            ballpark: !route.has_heights() && !options.require_grids,
            only_best: options.require_grids,
        };
        Operation {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            from: from.clone(),
            to: to.clone(),
            route,
            choice,
            epoch: options.epoch.or(from.epoch()),
            candidates: OnceLock::new(),
            notes: Mutex::default(),
        }
    }

    fn notes(&self) -> std::sync::MutexGuard<'_, Notes> {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns this thread's PROJ object.
    pub(super) fn object(&self) -> Result<Rc<Object>> {
        let kept = OBJECTS.with_borrow(|kept| {
            kept.iter()
                .find(|entry| entry.0 == self.id)
                .map(|entry| entry.1.clone())
        });
        if let Some(object) = kept {
            return Ok(object);
        }
        let object = Ends::of(&library()?, &self.route, self.epoch)
            .and_then(|ends| ends.operation(self.choice));
        let object = Rc::new(object.map_err(|reason| self.no_operation(&reason))?);
        OBJECTS.with_borrow_mut(|kept| {
            kept.push_back((self.id, object.clone()));
            if kept.len() > KEPT {
                kept.pop_front();
            }
        });
        Ok(object)
    }

    fn no_operation(&self, reason: &str) -> Error {
        let grids = match self.choice.only_best {
            true => self.missing(None),
            false => None,
        };
        if let Some((text, cure)) = grids {
            return Error::unsupported(format!(
                "the best operation from {} to {} cannot be used: {text}",
                self.from, self.to
            ))
            .cure(cure);
        }
        Error::unsupported(format!(
            "PROJ has no operation from {} to {}: {reason}",
            self.from, self.to
        ))
        .cure(wording![
            "name other systems with ",
            Setting::Crs,
            " (of the input) or ",
            Setting::TargetCrs
        ])
    }

    /// Returns all operations on the route, the best first, as if all grids were installed.
    pub(super) fn candidates(&self) -> &[OperationFacts] {
        self.candidates.get_or_init(|| {
            let ends = library()
                .ok()
                .and_then(|library| Ends::of(&library, &self.route, self.epoch).ok());
            ends.map_or(Vec::new(), |ends| ends.candidates(self.route.has_heights()))
        })
    }

    /// Returns true if all grids of an operation are there and can be read: PROJ opens some only
    /// when they are used.
    fn is_usable(&self) -> bool {
        self.candidates().iter().any(OperationFacts::is_usable)
    }

    /// Returns why heights cannot be transformed, and the cure.
    fn why_not(&self) -> (String, Wording) {
        self.missing(None).unwrap_or_else(|| {
            (
                "PROJ knows no operation between them".to_owned(),
                wording![
                    "name other systems with ",
                    Setting::Crs,
                    " or ",
                    Setting::TargetCrs
                ],
            )
        })
    }

    /// Returns which grids are missing for the best operation at a position, in words, and where to
    /// put them; `None` if it needs none that is not installed.
    fn missing(&self, at: Option<[f64; 2]>) -> Option<(String, Wording)> {
        let best = self
            .candidates()
            .iter()
            .find(|candidate| candidate.covers(at) && !candidate.is_ballpark)?;
        let missing: Vec<&OperationGrid> = best.missing().collect();
        if missing.is_empty() {
            return None;
        }
        let accuracy = match best.accuracy {
            Some(accuracy) => format!(" ({}, accurate to {accuracy} m)", best.name),
            None => format!(" ({})", best.name),
        };
        let mut text = format!("the best operation{accuracy} needs ");
        for (i, grid) in missing.iter().take(NAMED).enumerate() {
            let state = match grid.state {
                GridState::Unreadable => ", which this build cannot read",
                _ => ", which is not installed",
            };
            let comma = if i > 0 { ", " } else { "" };
            let _ = write!(text, "{comma}the grid {}{state}", grid.name);
        }
        if missing.len() > NAMED {
            let _ = write!(text, ", and {} more", missing.len() - NAMED);
        }
        Some((text, cure_of(&missing)))
    }

    /// Reports the operation that was used last, once: its accuracy if it is poor, and that a
    /// better one needs a grid.
    fn record(&self, object: &Object, at: Option<[f64; 3]>) {
        let Some((name, accuracy)) = object.used() else {
            return;
        };
        let name = plain_name(&name);
        if !self.notes().used.insert(name.clone()) {
            return;
        }
        let (from, to) = (&self.from, &self.to);
        let mut found = Vec::new();
        if !(0.0..=REPORTED).contains(&accuracy) {
            let mut warning = if accuracy < 0.0 {
                format!("the accuracy of the operation from {from} to {to} is unknown ({name})")
            } else {
                format!("the operation from {from} to {to} is accurate to {accuracy} m ({name})")
            };
            if let Some((better, cure)) = self.better(accuracy, at) {
                let _ = write!(warning, "; {better}: {}", cure.plain());
            }
            found.push(warning);
        }
        let is_used = |candidate: &&OperationFacts| candidate.name == name && candidate.needs_epoch;
        if self.epoch.is_none() && self.candidates().iter().any(|one| is_used(&one)) {
            found.push(format!(
                "the operation from {from} to {to} depends on the epoch of the coordinates, which is not stated: that of \
                 the operation is assumed ({name})"
            ));
        }
        self.notes().warnings.extend(found);
    }

    /// Returns the grids of an operation that is more accurate at a position than this.
    fn better(&self, accuracy: f64, at: Option<[f64; 3]>) -> Option<(String, Wording)> {
        let at = at.and_then(|[x, y, _]| self.position([x, y]));
        let best = self
            .candidates()
            .iter()
            .find(|candidate| candidate.covers(at) && !candidate.is_ballpark)?;
        let is_better = accuracy < 0.0 || best.accuracy.is_some_and(|best| best < accuracy);
        self.missing(at).filter(|_| is_better)
    }

    /// Returns the longitude and latitude of a position in the source.
    pub(super) fn position(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        if self.from.kind == CrsKind::Geocentric {
            return None;
        }
        position(&library().ok()?, &self.route.from, [x, y])
    }

    /// Transforms one point.
    ///
    /// # Errors
    /// The reason why it cannot be transformed.
    pub(super) fn one(
        &self,
        object: &Object,
        [x, y, z]: [f64; 3],
    ) -> std::result::Result<[f64; 3], String> {
        let epoch = self.epoch.unwrap_or(f64::INFINITY);
        let moved = object.forward([x, y, self.route.before(z), epoch])?;
        Ok([moved[0], moved[1], self.route.after(z, moved[2])])
    }

    fn refused(&self, [x, y, _]: [f64; 3], reason: &str) -> Error {
        let mut error = format!(
            "point ({x}, {y}) cannot be transformed from {} to {}: {reason}",
            self.from, self.to
        );
        match self.missing(self.position([x, y])) {
            Some((text, cure)) => {
                let _ = write!(error, "; {text}");
                Error::format(error).cure(cure)
            }
            None => Error::format(error).cure(wording![
                "check that the file's coordinate system is what it says (",
                Setting::Crs,
                " overrides it)"
            ]),
        }
    }
}

impl Transform for Operation {
    fn transform(&self, points: &mut [[f64; 3]]) -> Result<()> {
        let object = self.object()?;
        let mut last = None;
        for point in points.iter_mut() {
            let from = *point;
            *point = self
                .one(&object, from)
                .map_err(|reason| self.refused(from, &reason))?;
            last = Some(from);
        }
        if last.is_some() {
            self.record(&object, last);
        }
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        self.notes().warnings.iter().cloned().collect()
    }
}

/// Returns an error for systems that PROJ transforms nothing from or to.
fn refuse(from: &Crs, to: &Crs) -> Result<()> {
    for crs in [from, to] {
        if crs.kind == CrsKind::Local {
            return Err(Error::usage(format!(
                "{crs} is a local system: its position on the earth is unknown"
            ))
            .cure(wording!["state the system with ", Setting::Crs]));
        }
    }
    if to.kind == CrsKind::Geocentric && !from.is_same(to) {
        return Err(
            Error::unsupported(format!("reprojecting to {to}, which is geocentric"))
                .cure("choose a projected system, such as EPSG:25832"),
        );
    }
    Ok(())
}

/// Returns where to get grids, and where to put them.
fn cure_of(missing: &[&OperationGrid]) -> Wording {
    let mut cures = Vec::new();
    if missing.iter().any(|grid| grid.state == GridState::Missing) {
        let url = missing.iter().find_map(|grid| grid.url.as_deref());
        cures.push(format!("put {} into {}", url.unwrap_or("it"), folders()).into());
    }
    let file_of = |grid: &OperationGrid| grid.file.clone().unwrap_or(grid.name.clone());
    let (tiff, others): (Vec<String>, Vec<String>) = missing
        .iter()
        .map(|grid| file_of(grid))
        .partition(|file| file.ends_with(".tif"));
    if cfg!(not(feature = "proj-tiff")) && !tiff.is_empty() {
        cures.push(wording![
            "build with ",
            Feature::ProjTiff,
            ", which reads grids in GeoTIFF"
        ]);
    }
    if let Some(file) = others.first() {
        cures.push(format!("replace {file}, which is not a grid").into());
    }
    Wording::join(cures, ", and ")
}

/// Returns where PROJ looks for grids, in words.
fn folders() -> String {
    let own = library().map_or(String::new(), |library| library.folder());
    match std::env::var("PROJ_DATA") {
        Ok(folder) if !folder.is_empty() => format!("{folder} (PROJ_DATA)"),
        _ => format!("{own}, or into a folder that PROJ_DATA names"),
    }
}
