//! LandXML 1.2: surfaces of triangles, as programs of surveyors and for machine control exchange
//! them.
//!
//! | element | content |
//! |---|---|
//! | `Units` | the unit of all coordinates: meter, foot, US survey foot |
//! | `CoordinateSystem` | `epsgCode`, and WKT in `ogcWktCode` |
//! | `Surfaces/Surface` | one surface, with its name |
//! | `SourceData/Breaklines` | lines, with their kind |
//! | `SourceData/Boundaries` | the rim of the surface, and of its holes |
//! | `Definition/Pnts/P` | a vertex: northing, easting, height |
//! | `Definition/Faces/F` | a face: the `id` of three vertices; `i="1"` hides it |

mod read;
mod system;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;

use crate::data::EdgeKind;

/// Returns the `brkType` of lines of a kind: lines that do not change the surface are
/// "nondestructive".
fn break_type(kind: EdgeKind) -> &'static str {
    match kind {
        EdgeKind::Wall => "wall",
        EdgeKind::Clip | EdgeKind::Draped => "nondestructive",
        _ => "standard",
    }
}

/// Returns the kind of lines with a name and a `brkType`. Lines that this program wrote have the
/// noun of their kind as name, since LandXML has fewer types than there are kinds.
fn kind_of(name: &str, break_type: &str) -> EdgeKind {
    let named = EdgeKind::ALL
        .into_iter()
        .find(|kind| kind.is_constrained() && kind.noun() == name);
    named.unwrap_or(match break_type {
        "wall" => EdgeKind::Wall,
        "nondestructive" => EdgeKind::Draped,
        _ => EdgeKind::Breakline,
    })
}
