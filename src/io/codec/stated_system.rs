//! The coordinate system of a layer, as databases state it: an authority with a number, and a text.

use crate::crs::Crs;
use crate::data::Layer;

/// Returns the EPSG code of a system; `None` if it has none, or has heights, which the code does
/// not state: it is that of the system in plan.
pub(crate) fn code_of(crs: &Crs) -> Option<i32> {
    let code = crs.epsg.filter(|_| crs.vertical_unit.is_none())?;
    i32::try_from(code).ok()
}

/// Sets the system of a layer: that of the number if it is one of EPSG's that is known, else that
/// of the text. One that is not understood is a warning.
pub(crate) fn read(organization: &str, code: i64, definition: String, layer: &mut Layer) {
    let by_code = organization
        .eq_ignore_ascii_case("EPSG")
        .then(|| u32::try_from(code).ok())
        .flatten()
        .and_then(|code| Crs::from_epsg(code).ok());
    match by_code.map_or_else(|| Crs::from_wkt(&definition), Ok) {
        Ok(crs) => layer.crs = crs.unless_undefined(),
        Err(error) => {
            let unread = format!("the coordinate system is not understood: {error}");
            layer.warnings.push(unread.into());
            layer.unread_crs = Some(definition);
        }
    }
}
