//! Reading GLB.

use serde_json::Value;

use super::{BIN, BYTE, EXTRAS, FLOAT, INT, JSON, MAGIC, SHORT, VERSION};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::Watch;
use crate::io::bytes::little_endian::{array_at, f32_at, u8_at, u16_at, u32_at};

/// What is read whatever wrote it.
const PLAIN: &str = "export plain triangles as one GLB file";

/// Reads all triangles of the nodes with meshes, which may be translated. Coordinates are the sums
/// of the local origin and the 32-bit floats.
///
/// Rotated and scaled nodes, compressed and sparse arrays are refused.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let (text, data) = chunks(bytes)?;
    let json: Value = serde_json::from_slice(text)
        .map_err(|error| Error::format(format!("not JSON: {error}")).at("chunk 0"))?;
    let file = File { json: &json, data };
    file.require_known()?;
    let mut triangles = Triangles {
        crs: system(&json["asset"]["extras"][EXTRAS])?,
        ..Triangles::default()
    };
    for (number, node) in list(&json["nodes"]).iter().enumerate() {
        watch(0)?;
        let at = |e: Error| e.within(format!("node {number}"));
        let Some(mesh) = node.get("mesh") else {
            continue;
        };
        let translation = translation(node).map_err(at)?;
        let mesh = file.item("meshes", mesh).map_err(at)?;
        for primitive in list(&mesh["primitives"]) {
            file.add(primitive, translation, &mut triangles)
                .map_err(at)?;
        }
    }
    if triangles.faces.is_empty() {
        return Err(Error::format("no node has a mesh of triangles").at("nodes"));
    }
    Ok(triangles)
}

/// Returns the two chunks: the text and the arrays.
fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8])> {
    let number = |at: usize| array_at(bytes, at).map(u32::from_le_bytes);
    if !bytes.starts_with(MAGIC) {
        return Err(Error::format("the file does not begin with 'glTF'").at("byte 0"));
    }
    match number(4) {
        Some(VERSION) => (),
        Some(version) => {
            return Err(
                Error::unsupported(format!("version {version} of glTF, expected 2"))
                    .at("byte 4")
                    .cure("export it as glTF 2.0"),
            );
        }
        None => return Err(Error::format("the file ends within its header").at("byte 4")),
    }
    let stated = number(8).map(u64::from);
    if stated != Some(bytes.len() as u64) {
        let stated = stated.unwrap_or_default();
        return Err(Error::format(format!(
            "the header states {stated} bytes, the file has {}",
            bytes.len()
        ))
        .at("byte 8")
        .cure("get the whole file"));
    }
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = number(at).and_then(|length| usize::try_from(length).ok());
        let is_kind = bytes.get(at + 4..at + 8) == Some(kind);
        let end = length.and_then(|length| (at + 8).checked_add(length));
        let found = end.and_then(|end| bytes.get(at + 8..end));
        found.filter(|_| is_kind).ok_or_else(|| {
            let kind = String::from_utf8_lossy(&kind[..3]).into_owned();
            Error::format(format!(
                "the chunk {kind} is missing, or longer than the file"
            ))
            .at(format!("byte {at}"))
        })
    };
    let text = chunk(12, JSON)?;
    let data = chunk(20 + text.len(), BIN)?;
    Ok((text, data))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |list| list)
}

fn system(extras: &Value) -> Result<Option<Crs>> {
    let crs = match (extras["wkt"].as_str(), extras["epsg"].as_u64()) {
        (Some(wkt), _) if !wkt.is_empty() => Crs::from_wkt(wkt),
        (_, Some(code)) => Crs::from_user(&format!("EPSG:{code}")),
        _ => return Ok(None),
    };
    crs.map(Some)
        .map_err(|e| e.at("coordinate system in asset.extras"))
}

/// Returns what is added to the positions of a node, in map axes.
fn translation(node: &Value) -> Result<[f64; 3]> {
    for turned in ["matrix", "rotation", "scale"] {
        if node.get(turned).is_some() {
            return Err(Error::unsupported(format!("the node has a {turned}"))
                .cure("apply all transformations, then write the file again"));
        }
    }
    let Some(stated) = node.get("translation") else {
        return Ok([0.0; 3]);
    };
    let numbers: Vec<f64> = list(stated).iter().filter_map(Value::as_f64).collect();
    match numbers[..] {
        // The difference is never -0.
        [x, up, south] => Ok([x, 0.0 - south, up]),
        _ => Err(Error::format(format!(
            "the translation is {stated}, expected three numbers"
        ))),
    }
}

/// An array of numbers.
struct Array<'a> {
    data: &'a [u8],
    /// Bytes from one element to the next.
    stride: usize,
    count: usize,
    kind: u64,
}

impl Array<'_> {
    fn position(&self, number: usize) -> [f64; 3] {
        let start = number * self.stride;
        [0, 4, 8].map(|at| f64::from(f32_at(self.data, start + at)))
    }

    fn index(&self, number: usize) -> u32 {
        let start = number * self.stride;
        match self.kind {
            BYTE => u32::from(u8_at(self.data, start)),
            SHORT => u32::from(u16_at(self.data, start)),
            _ => u32_at(self.data, start),
        }
    }
}

/// The bytes of a position.
const POSITION_BYTES: usize = 12;

/// How often nodes may show all positions of a file.
const MOST_COPIES: usize = 16;

struct File<'a> {
    json: &'a Value,
    data: &'a [u8],
}

impl<'a> File<'a> {
    fn require_known(&self) -> Result<()> {
        let required = list(&self.json["extensionsRequired"]);
        if let Some(name) = required.first() {
            return Err(
                Error::unsupported(format!("the file needs the extension {name}"))
                    .at("extensionsRequired")
                    .cure("write it without compression"),
            );
        }
        if list(&self.json["nodes"])
            .iter()
            .any(|node| node.get("children").is_some())
        {
            return Err(Error::unsupported("nodes have children")
                .at("nodes")
                .cure("apply all transformations, and write one mesh"));
        }
        Ok(())
    }

    /// Returns an item of a list by its number.
    fn item(&self, name: &str, number: &Value) -> Result<&'a Value> {
        let found = number
            .as_u64()
            .and_then(|number| usize::try_from(number).ok())
            .and_then(|number| list(&self.json[name]).get(number));
        found.ok_or_else(|| Error::format(format!("{number} is not the number of one of {name}")))
    }

    fn add(&self, primitive: &Value, from: [f64; 3], triangles: &mut Triangles) -> Result<()> {
        let mode = primitive.get("mode").and_then(Value::as_u64).unwrap_or(4);
        if mode != 4 {
            return Err(Error::unsupported(format!(
                "a primitive of mode {mode}, expected triangles (4)"
            ))
            .cure(PLAIN));
        }
        let positions = self.array(&primitive["attributes"]["POSITION"], "VEC3", &[FLOAT])?;
        let first = triangles.vertices.len();
        // Many nodes may show one array: a small file must not become a large mesh.
        let most = MOST_COPIES.saturating_mul(self.data.len() / POSITION_BYTES);
        if first + positions.count > most.min(u32::MAX as usize - 1) {
            let error = format!(
                "its nodes show more than {most} vertices, {MOST_COPIES} times what {} bytes hold",
                self.data.len()
            );
            return Err(Error::limit(error).cure("write one mesh, without copies"));
        }
        let [ox, oy, oz] = from;
        let local = |[x, up, south]: [f64; 3]| [ox + x, oy - south, oz + up];
        triangles
            .vertices
            .extend((0..positions.count).map(|number| local(positions.position(number))));
        let indices: Vec<u32> = match primitive.get("indices") {
            Some(indices) => {
                let indices = self.array(indices, "SCALAR", &[INT, SHORT, BYTE])?;
                (0..indices.count).map(|i| indices.index(i)).collect()
            }
            None => (0..positions.count as u32).collect(),
        };
        if !indices.len().is_multiple_of(3) {
            return Err(Error::format(format!(
                "{} corners are not those of triangles",
                indices.len()
            )));
        }
        if let Some(index) = indices.iter().find(|&&i| i as usize >= positions.count) {
            let count = positions.count;
            return Err(Error::format(format!(
                "a triangle names vertex {index}, but there are {count} vertices"
            )));
        }
        let faces = indices.chunks_exact(3).map(|face| {
            let number = |k: usize| face[k] + first as u32;
            [number(0), number(1), number(2)]
        });
        triangles.faces.extend(faces);
        Ok(())
    }

    /// Returns the array of an accessor, all of which is there.
    fn array(&self, number: &Value, shape: &str, kinds: &[u64]) -> Result<Array<'a>> {
        let accessor = self.item("accessors", number)?;
        let at = |e: Error| e.within(format!("accessor {number}"));
        let kind = accessor["componentType"].as_u64().unwrap_or_default();
        if accessor["type"] != shape || !kinds.contains(&kind) {
            return Err(at(Error::unsupported(format!(
                "numbers of type {kind} {}, expected {shape}",
                accessor["type"]
            ))
            .cure(PLAIN)));
        }
        if accessor.get("sparse").is_some() {
            return Err(at(Error::unsupported("a sparse array").cure(PLAIN)));
        }
        let view = self
            .item("bufferViews", &accessor["bufferView"])
            .map_err(at)?;
        if view["buffer"].as_u64().unwrap_or(0) != 0 {
            return Err(at(Error::unsupported("numbers in another file").cure(PLAIN)));
        }
        let size = match kind {
            BYTE => 1,
            SHORT => 2,
            _ => 4,
        } * if shape == "VEC3" { 3 } else { 1 };
        let field = |value: &Value, name: &str, default: u64| {
            let stated = value.get(name).map_or(Some(default), Value::as_u64);
            stated.and_then(|number| usize::try_from(number).ok())
        };
        let slice = || {
            let start = field(view, "byteOffset", 0)?;
            let length = field(view, "byteLength", u64::MAX)?;
            let view_data = self.data.get(start..start.checked_add(length)?)?;
            let data = view_data.get(field(accessor, "byteOffset", 0)?..)?;
            let stride = field(view, "byteStride", size as u64)?;
            let count = field(accessor, "count", u64::MAX)?;
            let end = match count {
                0 => 0,
                _ => (count - 1).checked_mul(stride)?.checked_add(size)?,
            };
            (stride >= size && end <= data.len()).then_some(Array {
                data,
                stride,
                count,
                kind,
            })
        };
        slice().ok_or_else(|| {
            at(Error::format(
                "the array is not within the bytes of the file",
            ))
        })
    }
}
