//! What is used of the library PROJ, with a safe interface.

// The exception of decision 113: the safe bindings of PROJ have no heights, no epochs and no lists
// of operations, so it is called here, and here only.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr::{self, NonNull};
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};

use proj_sys::*;

use super::facts::OperationArea;

/// The name by which PROJ 9.6 opens the database that is built into it. Other versions do not know
/// it; then a file `proj.db` is looked for, as PROJ does.
const BUILT_IN: &CStr = c"__embedded_proj_db__";

/// A context of PROJ. Its pointer keeps it in the thread that made it, with all that is made in it.
pub(super) struct Library(NonNull<PJ_CONTEXT>);

/// A coordinate system, an operation, or several operations of which PROJ chooses one for each
/// point.
pub(super) struct Object {
    object: NonNull<PJ>,
    library: Rc<Library>,
}

/// Which operations are considered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Choice {
    /// Operations that ignore a difference of datums.
    pub(super) ballpark: bool,
    /// Nothing but the best operation, even if a grid that it needs is missing.
    pub(super) only_best: bool,
}

/// A grid that an operation needs.
pub(super) struct NeededGrid {
    pub(super) name: String,
    /// Where it can be downloaded, if PROJ knows that.
    pub(super) url: Option<String>,
    /// The file that was found.
    pub(super) file: Option<String>,
}

impl Library {
    /// Opens the database that is built in, so that an older `proj.db` beside the grids does no
    /// harm.
    ///
    /// # Errors
    /// If there is no memory for it.
    pub(super) fn open() -> Result<Rc<Self>, String> {
        let create = || {
            // SAFETY: it takes nothing; null, for no memory, is refused. It copies the context that
            // all threads share, which `can_read` may change meanwhile: see decision 113.
            let context = NonNull::new(unsafe { proj_context_create() });
            let library = Library(context.ok_or("PROJ could not be started")?);
            // SAFETY: the context is live. Errors are returned, not printed.
            unsafe { proj_log_level(library.0.as_ptr(), PJ_LOG_LEVEL_PJ_LOG_NONE) };
            Ok::<_, String>(library)
        };
        let library = create()?;
        // SAFETY: the context is live, the name ends with a zero, and null means "none".
        let is_open = unsafe {
            proj_context_set_database_path(
                library.0.as_ptr(),
                BUILT_IN.as_ptr(),
                ptr::null(),
                ptr::null(),
            )
        };
        Ok(Rc::new(if is_open != 0 { library } else { create()? }))
    }

    /// Returns the folder of the user in which PROJ looks for grids.
    pub(super) fn folder(&self) -> String {
        // SAFETY: the context is live, and owns the text that is returned.
        unsafe { text(proj_context_get_user_writable_directory(self.0.as_ptr(), 0)) }
            .unwrap_or_default()
    }

    /// Returns the version of PROJ.
    pub(super) fn version() -> String {
        // SAFETY: the text is static, and PROJ writes the same bytes in each call.
        unsafe { text(proj_info().version) }.unwrap_or_default()
    }

    /// Returns what went wrong in the call before.
    fn error(&self) -> String {
        // SAFETY: the context is live, and owns the text until its next call.
        let message = unsafe {
            let number = proj_context_errno(self.0.as_ptr());
            text(proj_context_errno_string(self.0.as_ptr(), number))
        };
        message.unwrap_or_else(|| "PROJ gives no reason".to_owned())
    }
}

impl Drop for Library {
    fn drop(&mut self) {
        // SAFETY: the context is live, and nothing that is made in it is any more: each `Object`
        // keeps its library.
        unsafe { proj_context_destroy(self.0.as_ptr()) };
    }
}

impl Object {
    /// Returns the owner of an object that a function of PROJ returned; `None` for a null pointer.
    ///
    /// # Safety
    /// The pointer is null, or an object that was made in the context and belongs to the caller.
    unsafe fn take(library: &Rc<Library>, object: *mut PJ) -> Option<Object> {
        Some(Object {
            object: NonNull::new(object)?,
            library: library.clone(),
        })
    }

    fn context(&self) -> *mut PJ_CONTEXT {
        self.library.0.as_ptr()
    }

    fn pointer(&self) -> *mut PJ {
        self.object.as_ptr()
    }

    /// Returns the system with a definition that PROJ reads: a code or WKT.
    ///
    /// # Errors
    /// If PROJ does not know it.
    pub(super) fn system(library: &Rc<Library>, definition: &str) -> Result<Object, String> {
        let words = CString::new(definition).map_err(|_| "a zero in its definition".to_owned())?;
        // SAFETY: the context is live, the text ends with a zero, and the object is the caller's.
        let object =
            unsafe { Object::take(library, proj_create(library.0.as_ptr(), words.as_ptr())) };
        object.ok_or_else(|| library.error())
    }

    /// Returns the system with heights above its ellipsoid, in meters.
    ///
    /// # Errors
    /// If it cannot have them.
    pub(super) fn with_ellipsoidal_heights(&self) -> Result<Object, String> {
        // SAFETY: context and object are live; null means "the same name".
        let object = unsafe {
            let object = proj_crs_promote_to_3D(self.context(), ptr::null(), self.pointer());
            Object::take(&self.library, object)
        };
        object.ok_or_else(|| self.library.error())
    }

    /// Returns the system with an epoch of its coordinates; `None` for one whose coordinates do not
    /// change.
    pub(super) fn at_epoch(&self, epoch: f64) -> Option<Object> {
        // SAFETY: context and object are live.
        unsafe {
            let object = proj_coordinate_metadata_create(self.context(), self.pointer(), epoch);
            Object::take(&self.library, object)
        }
    }

    /// Returns what transforms coordinates from one system to another, easting or longitude first.
    ///
    /// # Errors
    /// If PROJ has no such operation.
    pub(super) fn operation(from: &Object, to: &Object, choice: Choice) -> Result<Object, String> {
        let yes = |on: bool| if on { "YES" } else { "NO" };
        let texts = [
            format!("ALLOW_BALLPARK={}", yes(choice.ballpark)),
            format!("ONLY_BEST={}", yes(choice.only_best)),
        ];
        let texts = texts.map(|text| CString::new(text).unwrap_or_default());
        let options = [texts[0].as_ptr(), texts[1].as_ptr(), ptr::null()];
        let library = &from.library;
        // SAFETY: context and objects are live; null means "no area"; the list of options ends with
        // null, and its texts live longer than the call.
        let raw = unsafe {
            let object = proj_create_crs_to_crs_from_pj(
                from.context(),
                from.pointer(),
                to.pointer(),
                ptr::null_mut(),
                options.as_ptr(),
            );
            Object::take(library, object)
        };
        raw.and_then(|raw| raw.normalized())
            .ok_or_else(|| match library.error() {
                reason if reason.is_empty() => "no operation is known".to_owned(),
                reason => reason,
            })
    }

    /// Returns the operation with easting or longitude first.
    fn normalized(&self) -> Option<Object> {
        // SAFETY: context and object are live.
        unsafe {
            let object = proj_normalize_for_visualization(self.context(), self.pointer());
            Object::take(&self.library, object)
        }
    }

    /// Returns the operations from one system to another, the best first, as if all grids were
    /// installed.
    pub(super) fn candidates(from: &Object, to: &Object, ballpark: bool) -> Vec<Object> {
        let library = &from.library;
        let context = from.context();
        // SAFETY: the context is live; null means "any authority".
        let factory =
            unsafe { proj_create_operation_factory_context(context, ptr::null::<c_char>()) };
        if factory.is_null() {
            return Vec::new();
        }
        // SAFETY: context, factory and objects are live, and the factory is ended once.
        let list = unsafe {
            proj_operation_factory_context_set_allow_ballpark_transformations(
                context,
                factory,
                c_int::from(ballpark),
            );
            proj_operation_factory_context_set_spatial_criterion(
                context,
                factory,
                PROJ_SPATIAL_CRITERION_PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION,
            );
            proj_operation_factory_context_set_grid_availability_use(
                context,
                factory,
                PROJ_GRID_AVAILABILITY_USE_PROJ_GRID_AVAILABILITY_KNOWN_AVAILABLE,
            );
            let list = proj_create_operations(context, from.pointer(), to.pointer(), factory);
            proj_operation_factory_context_destroy(factory);
            list
        };
        if list.is_null() {
            return Vec::new();
        }
        // SAFETY: the list is live, its items belong to the caller, and it is ended once.
        unsafe {
            let items = (0..proj_list_get_count(list))
                .filter_map(|i| Object::take(library, proj_list_get(context, list, i)))
                .collect();
            proj_list_destroy(list);
            items
        }
    }

    /// Transforms a position: x, y, z and time.
    ///
    /// # Errors
    /// If the operation has no value there.
    pub(super) fn forward(&self, position: [f64; 4]) -> Result<[f64; 4], String> {
        // SAFETY: the object is live. A coordinate is a union of views of the same four numbers,
        // each of which can be read.
        let moved = unsafe {
            let coordinate = PJ_COORD { v: position };
            proj_trans(self.pointer(), PJ_DIRECTION_PJ_FWD, coordinate).v
        };
        if moved[..3].iter().all(|number| number.is_finite()) {
            return Ok(moved);
        }
        // SAFETY: context and object are live; the context owns the text until its next call.
        let reason = unsafe {
            let number = proj_errno(self.pointer());
            proj_errno_reset(self.pointer());
            match number {
                0 => None,
                number => text(proj_context_errno_string(self.context(), number)),
            }
        };
        Err(reason.unwrap_or_else(|| "it is outside of the area of the operation".to_owned()))
    }

    /// Returns the name and the accuracy in meters of the operation that was used last, or of the
    /// only one; `None` before PROJ has chosen among several. The accuracy is negative if it is not
    /// known.
    pub(super) fn used(&self) -> Option<(String, f64)> {
        // SAFETY: the object is live, and owns the texts of the record, which are copied here.
        unsafe {
            let info = proj_pj_info(self.pointer());
            let id = text(info.id).unwrap_or_default();
            let name = text(info.description).unwrap_or_default();
            // Before the first point, PROJ has not yet chosen.
            let is_open = id == "unknown" && name.starts_with("unavailable until");
            (!is_open).then_some((name, info.accuracy))
        }
    }

    /// Returns the operation that was used last.
    pub(super) fn last_used(&self) -> Option<Object> {
        // SAFETY: the object is live, and the caller owns what is returned.
        unsafe {
            let object = proj_trans_get_last_used_operation(self.pointer());
            Object::take(&self.library, object)
        }
    }

    /// Returns the name of the operation or of the system.
    pub(super) fn name(&self) -> String {
        // SAFETY: the object is live, and owns the text.
        unsafe { text(proj_get_name(self.pointer())) }.unwrap_or_default()
    }

    /// Returns the code of the operation or of the system, such as `EPSG:1149`.
    pub(super) fn code(&self) -> Option<String> {
        // SAFETY: the object is live, and owns the texts.
        unsafe {
            let authority = text(proj_get_id_auth_name(self.pointer(), 0))?;
            Some(format!(
                "{authority}:{}",
                text(proj_get_id_code(self.pointer(), 0))?
            ))
        }
    }

    /// Returns the accuracy of the operation in meters, if it is known. A conversion keeps the
    /// datum and is exact, although PROJ states no accuracy for it.
    pub(super) fn accuracy(&self) -> Option<f64> {
        // SAFETY: context and object are live.
        let (accuracy, kind) = unsafe {
            (
                proj_coordoperation_get_accuracy(self.context(), self.pointer()),
                proj_get_type(self.pointer()),
            )
        };
        match kind {
            PJ_TYPE_PJ_TYPE_CONVERSION => Some(0.0),
            _ => (accuracy >= 0.0).then_some(accuracy),
        }
    }

    /// Returns true if the operation ignores a difference of datums.
    pub(super) fn is_ballpark(&self) -> bool {
        // SAFETY: context and object are live.
        let is = unsafe {
            proj_coordoperation_has_ballpark_transformation(self.context(), self.pointer())
        };
        is == 1
    }

    /// Returns true if the operation depends on the epoch of the coordinates.
    pub(super) fn needs_epoch(&self) -> bool {
        // SAFETY: context and object are live.
        let needs = unsafe {
            proj_coordoperation_requires_per_coordinate_input_time(self.context(), self.pointer())
        };
        needs == 1
    }

    /// Returns where the operation is meant to be used, if that is stated.
    pub(super) fn area(&self) -> Option<OperationArea> {
        let [mut west, mut south, mut east, mut north] = [0.0; 4];
        let mut name: *const c_char = ptr::null();
        // SAFETY: context and object are live, as are the variables for results. The object owns
        // the text.
        unsafe {
            let is_known = proj_get_area_of_use(
                self.context(),
                self.pointer(),
                &mut west,
                &mut south,
                &mut east,
                &mut north,
                &mut name,
            );
            // PROJ returns -1000 if the area is unknown.
            (is_known == 1 && west >= -360.0).then(|| OperationArea {
                name: text(name).unwrap_or_default(),
                west,
                south,
                east,
                north,
            })
        }
    }

    /// Returns the grids that the operation needs.
    pub(super) fn grids(&self) -> Vec<NeededGrid> {
        // SAFETY: context and object are live.
        let count =
            unsafe { proj_coordoperation_get_grid_used_count(self.context(), self.pointer()) };
        (0..count).filter_map(|i| self.grid(i)).collect()
    }

    fn grid(&self, number: c_int) -> Option<NeededGrid> {
        let [mut name, mut full, mut package, mut url] = [ptr::null::<c_char>(); 4];
        let [mut direct, mut open, mut is_there] = [0; 3];
        // SAFETY: context and object are live, as are the variables for results. The object owns
        // the texts.
        unsafe {
            let is_known = proj_coordoperation_get_grid_used(
                self.context(),
                self.pointer(),
                number,
                &mut name,
                &mut full,
                &mut package,
                &mut url,
                &mut direct,
                &mut open,
                &mut is_there,
            );
            (is_known == 1).then(|| NeededGrid {
                name: text(name).unwrap_or_default(),
                url: text(url).filter(|url| !url.is_empty()),
                file: text(full).filter(|_| is_there == 1),
            })
        }
    }

    /// Returns the steps of the operation as PROJ writes them, one in each text.
    pub(super) fn steps(&self) -> Vec<String> {
        // SAFETY: context and object are live, null means "no options", and the object owns the
        // text.
        let whole = unsafe {
            text(proj_as_proj_string(
                self.context(),
                self.pointer(),
                PJ_PROJ_STRING_TYPE_PJ_PROJ_5,
                ptr::null(),
            ))
        };
        let whole = whole.unwrap_or_default();
        let steps: Vec<String> = whole
            .trim_start_matches("+proj=pipeline")
            .split("+step")
            .map(|step| step.trim().to_owned())
            .filter(|step| !step.is_empty())
            .collect();
        steps
    }
}

impl Drop for Object {
    fn drop(&mut self) {
        // SAFETY: the object is live, and so is its context, which `library` keeps.
        unsafe { proj_destroy(self.pointer()) };
    }
}

/// Returns true if PROJ can read a grid, and not only find it: without support for TIFF, it finds
/// those that it cannot read.
pub(super) fn can_read(grid: &str) -> bool {
    /// PROJ looks for the grid in the context that all threads share.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let Ok(name) = CString::new(grid) else {
        return false;
    };
    let _held = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    // SAFETY: the text ends with a zero. Null is the shared context, which one thread at a time
    // uses here; for `Library::open`, which copies it, see decision 113. The format is a text of
    // less than eight bytes and a zero.
    unsafe {
        proj_log_level(ptr::null_mut(), PJ_LOG_LEVEL_PJ_LOG_NONE);
        let info = proj_grid_info(name.as_ptr());
        text(info.format.as_ptr()).is_some_and(|format| format != "missing")
    }
}

/// Copies a text of PROJ; `None` for a null pointer.
///
/// # Safety
/// The pointer is null, or a text that ends with a zero and does not change during the call.
unsafe fn text(pointer: *const c_char) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: it is such a text, as the caller ensures.
    let text = unsafe { CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().into_owned())
}
