//! The plan of a job as it is stored: JSON.

use serde_json::{Value, json};

use super::plan::Plan;

/// The version that plans name, and are read by.
const VERSION: &str = env!("CARGO_PKG_VERSION");

impl Plan {
    pub(super) fn to_json(&self) -> Value {
        let mut value = json!(self);
        value["version"] = json!(VERSION);
        value
    }

    /// Returns the plan that a value states, without the names of files; `None` if it does not, or
    /// is that of another version.
    pub(super) fn from_json(value: &Value) -> Option<Self> {
        if value["version"] != VERSION {
            return None;
        }
        let plan: Plan = serde_json::from_value(value.clone()).ok()?;
        let mut tiles: Vec<u32> = plan.files.iter().filter_map(|file| file.tile).collect();
        tiles.sort_unstable();
        let are_tiles = tiles.windows(2).all(|pair| pair[0] < pair[1])
            && (tiles.last()).is_none_or(|&last| (last as usize) < plan.layout.tile_count());
        are_tiles.then_some(plan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::Crs;

    #[test]
    fn systems_come_back_as_they_were() {
        let of_wkt = |wkt: &str| Crs::from_user(wkt).unwrap();
        let local = r#"LOCAL_CS["mine",UNIT["US survey foot",0.304800609601219]]"#;
        let mut all: Vec<Crs> = [25832, 4326, 4979, 2994, 7415]
            .map(|code| Crs::from_epsg(code).unwrap())
            .into();
        all.push(of_wkt(local));
        all.push(of_wkt("EPSG:25832+7837"));
        for crs in all {
            let text = serde_json::to_string(&crs).unwrap();
            assert_eq!(serde_json::from_str::<Crs>(&text).unwrap(), crs);
        }
        assert!(serde_json::from_value::<Crs>(json!({"name": "a", "kind": "round"})).is_err());
    }
}
