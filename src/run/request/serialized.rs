//! Parts of requests in a form that can be stored.

use serde::{Deserialize, Serialize};

use crate::triangulation::OnCrossing;

/// Boxes whose heights do not count, as west, south, east, north.
pub(crate) mod in_plan {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::data::Bounds;

    pub(crate) fn serialize<S: Serializer>(bounds: &Option<Bounds>, to: S) -> Result<S::Ok, S::Error> {
        bounds.map(corners).serialize(to)
    }

    /// Returns what counts of a box.
    pub(crate) fn corners(Bounds { min, max }: Bounds) -> [f64; 4] {
        [min[0], min[1], max[0], max[1]]
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Bounds>, D::Error> {
        let corners = Option::<[f64; 4]>::deserialize(from)?;
        Ok(corners.map(|[x0, y0, x1, y1]| Bounds { min: [x0, y0, f64::NEG_INFINITY], max: [x1, y1, f64::INFINITY] }))
    }
}

/// What to do where segments cross.
#[derive(Serialize, Deserialize)]
#[serde(remote = "OnCrossing")]
pub(crate) enum Crossing {
    Reject,
    Split,
}
