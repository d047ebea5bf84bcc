//! The index of a surface that is kept in parts.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use super::attributes::{Attributes, box_from_json, box_to_json, parse, wrong};
use crate::crs::Crs;
use crate::data::{Bounds, SurfaceFacts};
use crate::error::Result;

/// The name of the version, with which the index begins, and the version.
const VERSION: (&str, u64) = ("breakline_tin_parts", 2);

/// A surface in parts: what is true of the whole, and the file of each part.
///
/// Each part is a [`CompactTin`](super::CompactTin) in a file of its own. The files are in a folder
/// next to the index.
#[derive(Debug, Clone, PartialEq)]
pub struct TinIndex {
    /// The coordinate system, if it is known.
    pub crs: Option<Crs>,
    /// The counts and the extent of the whole.
    pub facts: SurfaceFacts,
    /// The area of all triangles in plan, in square units of the data.
    pub area: f64,
    /// The name of the folder of the parts.
    pub folder: String,
    /// The parts.
    pub parts: Vec<TinIndexPart>,
}

/// A part, as the index describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct TinIndexPart {
    /// The name of its file.
    pub file: String,
    /// The tile whose points it has; `None` if it has triangles between tiles.
    pub tile: Option<u32>,
    /// The length of the file, in bytes.
    pub bytes: u64,
    /// The CRC-32 of the file.
    pub checksum: u32,
    /// The number of its triangles.
    pub triangles: u64,
    /// The box around them.
    pub extent: Bounds,
}

impl TinIndex {
    /// Returns the index as text: JSON, with a line for each part.
    ///
    /// # Complexity
    /// Linear in the parts.
    pub fn to_text(&self) -> String {
        let TinIndex {
            crs,
            facts,
            area,
            folder,
            parts,
        } = self;
        let attributes = Attributes {
            crs: crs.clone(),
            facts: facts.clone(),
        };
        let surface = attributes.to_json();
        let (name, version) = VERSION;
        let mut text = format!(
            "{{\"{name}\":{version},\n\"surface\":{surface},\n\"area\":{},\n",
            json!(area)
        );
        // Writing to a string does not fail.
        let _ = write!(text, "\"folder\":{},\n\"parts\":[", json!(folder));
        for (
            number,
            TinIndexPart {
                file,
                tile,
                bytes,
                checksum,
                triangles,
                extent,
            },
        ) in parts.iter().enumerate()
        {
            let row = json!({
                "file": file, "tile": tile, "bytes": bytes, "checksum": checksum, "triangles": triangles,
                "extent": box_to_json(extent),
            });
            let _ = write!(text, "{}\n{row}", if number == 0 { "" } else { "," });
        }
        text + "\n]}\n"
    }

    /// Reads an index, also one that was written again by another program, with other spaces or in
    /// another order.
    ///
    /// # Errors
    /// If the text is not that of an index, or has another version; the error names a value that is
    /// missing or wrong.
    ///
    /// # Complexity
    /// Linear in the bytes.
    pub fn from_text(text: &[u8]) -> Result<Self> {
        let value = parse(text)?;
        let (name, version) = VERSION;
        if value[name].as_u64() != Some(version) {
            return Err(wrong("the version of the index"));
        }
        let Attributes { crs, facts } = Attributes::from_value(&value["surface"])
            .map_err(|e| e.within("the value `surface`"))?;
        let folder = value["folder"]
            .as_str()
            .filter(|name| is_name(name))
            .ok_or_else(|| wrong("folder"))?;
        let part = |(number, value): (usize, &Value)| {
            let read = || {
                Some(TinIndexPart {
                    file: value["file"]
                        .as_str()
                        .filter(|name| is_name(name))?
                        .to_owned(),
                    tile: match &value["tile"] {
                        Value::Null => None,
                        tile => Some(u32::try_from(tile.as_u64()?).ok()?),
                    },
                    bytes: value["bytes"].as_u64()?,
                    checksum: u32::try_from(value["checksum"].as_u64()?).ok()?,
                    triangles: value["triangles"].as_u64()?,
                    extent: box_from_json(&value["extent"])?,
                })
            };
            read().ok_or_else(|| wrong(&format!("part {number}")))
        };
        let parts = value["parts"].as_array().ok_or_else(|| wrong("parts"))?;
        Ok(TinIndex {
            crs,
            facts,
            area: value["area"].as_f64().ok_or_else(|| wrong("area"))?,
            folder: folder.to_owned(),
            parts: parts.iter().enumerate().map(part).collect::<Result<_>>()?,
        })
    }
}

/// Returns true for the name of a file or folder: no path that leads elsewhere.
fn is_name(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!((components.next(), components.next()), (Some(std::path::Component::Normal(only)), None) if only == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::LineEdges;

    fn index() -> TinIndex {
        let extent = Bounds {
            min: [0.1, -2.0, 3.0],
            max: [9.0, 1e7, 4.5],
        };
        let part = |number: u32| TinIndexPart {
            file: format!("{number}.tin"),
            tile: Some(number).filter(|number| *number > 0),
            bytes: 1 << 40,
            checksum: u32::MAX - number,
            triangles: 7,
            extent: if number == 2 {
                Bounds::default()
            } else {
                extent
            },
        };
        let facts = SurfaceFacts {
            vertices: 9,
            triangles: 21,
            edges: LineEdges::default(),
            extent,
        };
        let crs = Some(Crs::from_epsg(25832).unwrap());
        TinIndex {
            crs,
            facts,
            area: 0.1 + 0.2,
            folder: "hills.tins.0f".to_owned(),
            parts: (0..3).map(part).collect(),
        }
    }

    #[test]
    fn an_index_reads_as_it_was_written() {
        let empty = TinIndex {
            parts: Vec::new(),
            crs: None,
            ..index()
        };
        for index in [index(), empty] {
            assert_eq!(
                TinIndex::from_text(index.to_text().as_bytes()).unwrap(),
                index
            );
            // Sorted, and with spaces.
            let value: Value = serde_json::from_str(&index.to_text()).unwrap();
            let again = serde_json::to_string_pretty(&value).unwrap();
            assert!(!again.starts_with("{\"breakline"));
            assert_eq!(TinIndex::from_text(again.as_bytes()).unwrap(), index);
        }
    }

    #[test]
    fn damage_is_an_error() {
        let whole = index().to_text();
        let last = whole.trim_end().len();
        for end in 0..last {
            assert!(
                TinIndex::from_text(&whole.as_bytes()[..end]).is_err(),
                "length {end}"
            );
        }
        for (from, to) in [
            ("1.tin", "a/b"),
            ("1.tin", ".."),
            ("1.tin", ""),
            ("hills.tins.0f", "/etc"),
            ("hills.tins.0f", "."),
            ("parts\":2", "parts\":1"),
            ("\"tile\":1", "\"tile\":-1"),
            ("\"area\":0", "\"area\":\"a"),
        ] {
            assert!(whole.contains(from));
            assert!(
                TinIndex::from_text(whole.replace(from, to).as_bytes()).is_err(),
                "{to}"
            );
        }
    }
}
