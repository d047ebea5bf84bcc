//! The operations between two systems, with what each needs.

use std::rc::Rc;

use super::facts::{GridState, OperationFacts, OperationGrid};
use super::library::{Choice, Library, NeededGrid, Object, can_read};
use super::routes::{Route, Side};

/// What PROJ writes around the name of an operation whose axes it has swapped.
const AXES_SWAPPED: &str = "axis order change (2D)";

/// Returns what is known of an operation.
fn facts_of(object: &Object, has_heights: bool) -> OperationFacts {
    OperationFacts {
        name: object.name(),
        code: object.code(),
        accuracy: object.accuracy(),
        area: object.area(),
        grids: object.grids().into_iter().map(found).collect(),
        is_ballpark: object.is_ballpark(),
        has_heights,
        needs_epoch: object.needs_epoch(),
        is_used: false,
        steps: object.steps(),
    }
}

/// Returns a grid with its state.
fn found(grid: NeededGrid) -> OperationGrid {
    let state = match &grid.file {
        None => GridState::Missing,
        Some(file) if is_readable(file) => GridState::Installed,
        Some(_) => GridState::Unreadable,
    };
    OperationGrid {
        name: grid.name,
        url: grid.url,
        file: grid.file,
        state,
    }
}

/// Returns true unless a file is known to be unreadable. PROJ describes only grids of shifts and of
/// heights; a GeoTIFF may be a grid of another kind.
fn is_readable(file: &str) -> bool {
    let extension = file.rsplit('.').next().unwrap_or_default();
    let is_described = matches!(extension, "gtx" | "gsb")
        || cfg!(not(feature = "proj-tiff")) && extension == "tif";
    !is_described || can_read(file)
}

/// Returns the name of an operation without PROJ's words for swapped axes.
pub(super) fn plain_name(name: &str) -> String {
    let parts: Vec<&str> = name
        .split(" + ")
        .filter(|part| {
            !part.starts_with(AXES_SWAPPED) && *part != format!("Inverse of {AXES_SWAPPED}")
        })
        .collect();
    if parts.is_empty() {
        return name.to_owned();
    }
    parts.join(" + ")
}

/// The systems at both ends of a route, in PROJ.
pub(super) struct Ends {
    pub(super) from: Object,
    pub(super) to: Object,
}

impl Ends {
    /// Finds both systems. Coordinates of the first one are of an epoch, if one is stated and they
    /// change with time.
    ///
    /// # Errors
    /// If PROJ does not know one of them.
    pub(super) fn of(
        library: &Rc<Library>,
        route: &Route,
        epoch: Option<f64>,
    ) -> Result<Self, String> {
        let system = |side: &Side| {
            let system = Object::system(library, &side.definition)?;
            match side.is_raised {
                true => system.with_ellipsoidal_heights(),
                false => Ok(system),
            }
        };
        let from = system(&route.from)?;
        let from = epoch.and_then(|epoch| from.at_epoch(epoch)).unwrap_or(from);
        Ok(Ends {
            from,
            to: system(&route.to)?,
        })
    }

    /// Returns the operation from one to the other.
    ///
    /// # Errors
    /// If PROJ has none, or only the best one is allowed and a grid for it is missing.
    pub(super) fn operation(&self, choice: Choice) -> Result<Object, String> {
        Object::operation(&self.from, &self.to, choice)
    }

    /// Returns all operations, the best first, as if all grids were installed. On routes with
    /// heights, ballpark operations are left out: they do not transform these.
    pub(super) fn candidates(&self, has_heights: bool) -> Vec<OperationFacts> {
        let objects = Object::candidates(&self.from, &self.to, !has_heights);
        objects
            .iter()
            .map(|object| facts_of(object, has_heights))
            .collect()
    }
}

/// Returns the longitude and latitude of a position; `None` if they are not known.
pub(super) fn position(library: &Rc<Library>, from: &Side, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let from = Object::system(library, &from.definition).ok()?;
    let to = Object::system(library, "EPSG:4326").ok()?;
    let choice = Choice {
        ballpark: true,
        only_best: false,
    };
    let operation = Object::operation(&from, &to, choice).ok()?;
    let [x, y, ..] = operation.forward([x, y, 0.0, f64::INFINITY]).ok()?;
    Some([x, y])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_without_swapped_axes() {
        assert_eq!(
            plain_name("axis order change (2D) + UTM zone 32N"),
            "UTM zone 32N"
        );
        assert_eq!(
            plain_name("Inverse of UTM zone 32N + axis order change (2D)"),
            "Inverse of UTM zone 32N"
        );
        assert_eq!(
            plain_name("axis order change (2D)"),
            "axis order change (2D)"
        );
    }
}
