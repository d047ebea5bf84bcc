//! The options of verbs as jobs keep them.

use std::any::Any;
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::Verb;
use super::tin::SurfaceOptions;
use crate::run::products::cells::{DemOptions, HillshadeOptions, QuantityOptions};
use crate::run::products::contour::ContourOptions;
use crate::run::products::relief::ColorReliefOptions;

/// How the options of a verb are kept with a job.
struct StoredVerb {
    verb: &'static str,
    to_json: fn(&dyn Any) -> Option<Value>,
    from_json: fn(Value) -> Option<Arc<dyn Verb>>,
}

impl StoredVerb {
    const fn of<V: Verb + Serialize + DeserializeOwned>(verb: &'static str) -> Self {
        StoredVerb {
            verb,
            to_json: |verb| serde_json::to_value(verb.downcast_ref::<V>()?).ok(),
            from_json: |options| {
                serde_json::from_value::<V>(options)
                    .ok()
                    .map(|verb| Arc::new(verb) as _)
            },
        }
    }
}

/// The verbs that jobs can keep.
const STORED: &[StoredVerb] = &[
    StoredVerb::of::<DemOptions>("dem"),
    StoredVerb::of::<HillshadeOptions>("hillshade"),
    StoredVerb::of::<ColorReliefOptions>("color-relief"),
    StoredVerb::of::<QuantityOptions>("slope"),
    StoredVerb::of::<ContourOptions>("contour"),
    StoredVerb::of::<SurfaceOptions>("tin"),
];

/// Returns the name and the options of a verb in a form that can be kept; `None` if jobs cannot
/// keep it.
pub(crate) fn to_json(verb: &dyn Verb) -> Option<(&'static str, Value)> {
    STORED
        .iter()
        .find_map(|stored| Some((stored.verb, (stored.to_json)(verb)?)))
}

/// Returns the verb with a name and these options; `None` if there is none, or they are not those
/// of the verb.
pub(crate) fn from_json(name: &str, options: Value) -> Option<Arc<dyn Verb>> {
    STORED
        .iter()
        .find(|stored| stored.verb == name)
        .and_then(|stored| (stored.from_json)(options))
}
