//! Parts of requests in a form that can be stored.

use serde::{Deserialize, Serialize};

use crate::triangulation::OnCrossing;

/// Boxes whose heights do not count, as west, south, east, north.
pub(crate) mod in_plan {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::data::Bounds;

    pub(crate) fn serialize<S: Serializer>(
        bounds: &Option<Bounds>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        bounds.map(corners).serialize(to)
    }

    /// Returns what counts of a box.
    pub(crate) fn corners(Bounds { min, max }: Bounds) -> [f64; 4] {
        [min[0], min[1], max[0], max[1]]
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Option<Bounds>, D::Error> {
        let corners = Option::<[f64; 4]>::deserialize(from)?;
        Ok(corners.map(|[x0, y0, x1, y1]| Bounds {
            min: [x0, y0, f64::NEG_INFINITY],
            max: [x1, y1, f64::INFINITY],
        }))
    }
}

/// Frames that can be used.
pub(crate) mod frame {
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::data::Frame;

    pub(crate) fn serialize<S: Serializer>(
        frame: &Option<Frame>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        frame
            .map(
                |Frame {
                     width,
                     height,
                     transform,
                 }| (width, height, transform),
            )
            .serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Option<Frame>, D::Error> {
        let stated = Option::<(usize, usize, [f64; 6])>::deserialize(from)?;
        let checked = |(width, height, transform)| {
            Frame {
                width,
                height,
                transform,
            }
            .checked()
        };
        stated.map(checked).transpose().map_err(D::Error::custom)
    }
}

/// What to do where segments cross.
#[derive(Serialize, Deserialize)]
#[serde(remote = "OnCrossing")]
pub(crate) enum Crossing {
    Reject,
    Split,
}
