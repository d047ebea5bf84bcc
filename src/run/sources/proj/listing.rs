//! The operations between two systems, and which of them is used.

use super::facts::OperationFacts;
use super::options::TransformOptions;
#[cfg(feature = "proj")]
use super::{candidates::plain_name, library::Library, operation::Operation, routes};
use crate::crs::Crs;
use crate::error::Result;

/// The operations between two systems, and which of them is used.
#[derive(Debug, Clone, PartialEq)]
pub struct Operations {
    /// The system of the source.
    pub from: Crs,
    /// The system of the result.
    pub to: Crs,
    /// True if heights are transformed; else they keep their datum.
    pub heights_are_transformed: bool,
    /// The warnings that a transform of points would have.
    pub warnings: Vec<String>,
    /// The operations, the best first, as if all grids were installed.
    pub operations: Vec<OperationFacts>,
    /// The point that was transformed, if one was given.
    pub point: Option<TransformedPoint>,
    /// The version of PROJ.
    pub version: String,
}

/// A point before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct TransformedPoint {
    /// The coordinates in the source, easting or longitude first.
    pub from: [f64; 3],
    /// The coordinates in the result, easting or longitude first.
    pub to: [f64; 3],
    /// The name of the operation that was used.
    pub operation: String,
    /// The steps of that operation, with those that swap axes.
    pub steps: Vec<String>,
}

/// Returns the operations from one system to another. The point `at`, if one is given, is
/// transformed by the operation that is used there; its height may be `NaN`.
///
/// # Errors
/// If PROJ does not know one of the systems or no operation between them, or the point lies outside
/// of the area of the operation; without the feature `proj`, always.
#[cfg(feature = "proj")]
pub fn operations(
    from: &Crs,
    to: &Crs,
    options: &TransformOptions,
    at: Option<[f64; 3]>,
) -> Result<Operations> {
    use crate::crs::Transform;

    let chosen = Operation::best(from, to, options)?;
    let point = match at {
        Some(point) => {
            let mut moved = [point];
            chosen.transform(&mut moved)?;
            let object = chosen.object()?;
            let name = object.used().map(|(name, _)| plain_name(&name));
            let steps = object.last_used().map(|used| used.steps());
            Some(TransformedPoint {
                from: point,
                to: moved[0],
                operation: name.unwrap_or_default(),
                steps: steps.unwrap_or_default(),
            })
        }
        None => None,
    };
    let position = at.and_then(|[x, y, _]| chosen.position([x, y]));
    let mut operations = Vec::new();
    // Those that would transform heights, if their grids were installed.
    if let Some(route) = routes::with_heights(from, to).filter(|_| !chosen.route.has_heights()) {
        operations.extend_from_slice(Operation::new(from, to, route, options).candidates());
    }
    let others = operations.len();
    operations.extend_from_slice(chosen.candidates());
    let used = match &point {
        Some(point) => operations[others..]
            .iter()
            .position(|one| one.name == point.operation),
        None => first_usable(&operations[others..]),
    };
    if let Some(used) = used {
        operations[others + used].is_used = true;
    }
    operations.retain(|one| one.is_used || one.covers(position));
    Ok(Operations {
        from: from.clone(),
        to: to.clone(),
        heights_are_transformed: chosen.route.has_heights(),
        warnings: chosen.warnings(),
        operations,
        point,
        version: Library::version(),
    })
}

/// Returns an error: the operations need the feature `proj`.
#[cfg(not(feature = "proj"))]
pub fn operations(
    from: &Crs,
    to: &Crs,
    _options: &TransformOptions,
    _at: Option<[f64; 3]>,
) -> Result<Operations> {
    Err(super::options::needs_proj(from, to))
}

/// Returns the index of the operation that PROJ uses inside of its area.
#[cfg(feature = "proj")]
fn first_usable(candidates: &[OperationFacts]) -> Option<usize> {
    let is_usable =
        |one: &OperationFacts, ballpark: bool| one.is_usable() && one.is_ballpark == ballpark;
    let first = |ballpark| candidates.iter().position(|one| is_usable(one, ballpark));
    first(false).or_else(|| first(true))
}
