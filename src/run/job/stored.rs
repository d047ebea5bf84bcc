//! The plan of a job as it is stored: JSON.

use serde_json::{Value, json};

use super::plan::Plan;
use super::planned_file::{FileState, PlannedFile};
use crate::data::Frame;
use crate::terrain::tiles::{Layout, Node};

impl Plan {
    pub(super) fn to_json(&self) -> Value {
        let file = |file: &PlannedFile| {
            json!({
                "path": file.path, "input": file.input, "state": file.state.to_json(),
                "count": file.count, "min": file.min, "max": file.max, "is_of_any_system": file.is_of_any_system,
            })
        };
        let node = |node: &Node| match node {
            Node::Tile(number) => json!(number),
            Node::Cut { axis, at, parts } => json!([axis, at, parts[0], parts[1]]),
        };
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "request": self.request,
            "files": self.files.iter().map(file).collect::<Vec<_>>(),
            "others": self.others.iter().map(|(path, state)| json!([path, state.to_json()])).collect::<Vec<_>>(),
            "skipped": self.skipped,
            "skips_bad": self.skips_bad,
            "divides": self.divides,
            "has_lines": self.has_lines,
            "has_clip": self.has_clip,
            "layout": self.layout.nodes().iter().map(node).collect::<Vec<_>>(),
            "crs": self.crs,
            "classes": self.classes,
            "max_edge": self.max_edge,
            "frame": self.frame.map(|frame| json!([frame.width, frame.height, frame.transform])),
            "task_memory": self.task_memory,
        })
    }

    /// Returns the plan that a value states; `None` if it does not, or is that of another version.
    pub(super) fn from_json(value: &Value) -> Option<Self> {
        if value["version"] != env!("CARGO_PKG_VERSION") {
            return None;
        }
        let whole = |value: &Value| usize::try_from(value.as_u64()?).ok();
        let number = |value: &Value| u32::try_from(value.as_u64()?).ok();
        let file = |value: &Value| {
            Some(PlannedFile {
                path: serde_json::from_value(value["path"].clone()).ok()?,
                input: whole(&value["input"])?,
                state: FileState::from_json(&value["state"])?,
                count: value["count"].as_u64()?,
                min: serde_json::from_value(value["min"].clone()).ok()?,
                max: serde_json::from_value(value["max"].clone()).ok()?,
                is_of_any_system: value["is_of_any_system"].as_bool()?,
            })
        };
        let other =
            |value: &Value| Some((serde_json::from_value(value[0].clone()).ok()?, FileState::from_json(&value[1])?));
        let node = |value: &Value| match value {
            Value::Array(parts) if parts.len() == 4 => Some(Node::Cut {
                axis: whole(&parts[0])?,
                at: parts[1].as_f64()?,
                parts: [number(&parts[2])?, number(&parts[3])?],
            }),
            value => number(value).map(Node::Tile),
        };
        let nodes = value["layout"].as_array()?.iter().map(node).collect::<Option<_>>()?;
        let class = |value: &Value| u8::try_from(value.as_u64()?).ok();
        let frame = |value: &Value| {
            let transform = serde_json::from_value(value[2].clone()).ok()?;
            Frame { width: whole(&value[0])?, height: whole(&value[1])?, transform }.checked().ok()
        };
        Some(Plan {
            request: serde_json::from_value(value["request"].clone()).ok()?,
            files: value["files"].as_array()?.iter().map(file).collect::<Option<_>>()?,
            others: value["others"].as_array()?.iter().map(other).collect::<Option<_>>()?,
            skipped: serde_json::from_value(value["skipped"].clone()).ok()?,
            skips_bad: value["skips_bad"].as_bool()?,
            divides: value["divides"].as_bool()?,
            has_lines: value["has_lines"].as_bool()?,
            has_clip: value["has_clip"].as_bool()?,
            layout: Layout::from_nodes(nodes)?,
            crs: serde_json::from_value(value["crs"].clone()).ok()?,
            classes: value["classes"].as_array()?.iter().map(class).collect::<Option<_>>()?,
            max_edge: value["max_edge"].as_f64(),
            frame: match &value["frame"] {
                Value::Null => None,
                value => Some(frame(value)?),
            },
            task_memory: value["task_memory"].as_u64()?,
        })
        .filter(|plan| plan.divides || plan.files.len() == plan.layout.tile_count())
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
        let mut all: Vec<Crs> = [25832, 4326, 4979, 2994, 7415].map(|code| Crs::from_epsg(code).unwrap()).into();
        all.push(of_wkt(local));
        all.push(of_wkt("EPSG:25832+7837"));
        for crs in all {
            let text = serde_json::to_string(&crs).unwrap();
            assert_eq!(serde_json::from_str::<Crs>(&text).unwrap(), crs);
        }
        assert!(serde_json::from_value::<Crs>(json!({"name": "a", "kind": "round"})).is_err());
    }
}
