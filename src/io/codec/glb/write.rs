//! Writing GLB.

use std::io::Write;

use serde_json::{Value, json};

use super::{BIN, BYTE, EXTRAS, FLOAT, INT, JSON, MAGIC, VERSION};
use crate::crs::Crs;
use crate::data::{Bounds, ColorMatch, Colors, vertex_normals};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::bytes::lines::{row_of, write_rows};
use crate::io::codec::listing::loss::{Loss, local_origin};
use crate::io::codec::listing::{Listing, Remarks, crs_text};
use crate::io::codec::ramp;

/// The ramp for the colors of vertices.
const RAMP: &str = "elevation";

/// Writes positions, normals, colors by height and triangles.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<Remarks> {
    let mut bounds = Bounds::default();
    mesh.vertices().for_each(|p| bounds.add(p));
    let origin = local_origin(&bounds);
    let local = Local { origin };
    let mut extent = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for p in mesh.vertices() {
        for (axis, value) in local.floats(p).into_iter().enumerate() {
            if !value.is_finite() {
                return Err(Error::limit("the surface is too large for 32-bit floats")
                    .cure("write .ply, which has doubles"));
            }
            extent[0][axis] = extent[0][axis].min(value);
            extent[1][axis] = extent[1][axis].max(value);
        }
    }
    let arrays = Arrays::of(mesh)?;
    let text = description(mesh, &arrays, &local, extent, crs).to_string();
    let head = head(text, arrays.length)?;
    let mut output = target.create()?;
    output.write_all(&head)?;
    write_arrays(&mut output, mesh, &local, &bounds)?;
    target.put(output)?;
    let loss = Loss::of(mesh, |p| local.read_back(p));
    Ok(Remarks {
        notes: loss.notes("32-bit floats", origin),
        ..Remarks::default()
    })
}

/// Returns the bytes of a file before those of its arrays, of which there are `length`.
///
/// # Errors
/// If the file would be too large.
pub(crate) fn head(mut text: String, length: u64) -> Result<Vec<u8>> {
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let total = 12 + 8 + text.len() as u64 + 8 + length;
    let sizes = [text.len() as u64, length, total].map(u32::try_from);
    let [Ok(text_size), Ok(bin_size), Ok(total)] = sizes else {
        return Err(Error::limit(format!(
            "{total} bytes; a GLB file has up to {}",
            u32::MAX
        )));
    };
    let mut head = Vec::with_capacity(28 + text.len());
    head.extend(MAGIC);
    head.extend(VERSION.to_le_bytes());
    head.extend(total.to_le_bytes());
    head.extend(text_size.to_le_bytes());
    head.extend(JSON);
    head.extend(text.as_bytes());
    head.extend(bin_size.to_le_bytes());
    head.extend(BIN);
    Ok(head)
}

/// Where positions are counted from.
struct Local {
    origin: [f64; 3],
}

impl Local {
    /// Returns a position as glTF has it: east, up, south.
    fn floats(&self, p: [f64; 3]) -> [f32; 3] {
        let [x, y, z] = [0, 1, 2].map(|axis| p[axis] - self.origin[axis]);
        [x, z, -y].map(|c| c as f32)
    }

    /// Returns the position that a reader finds.
    fn read_back(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, z, south] = self.floats(p).map(f64::from);
        let [ox, oy, oz] = self.origin;
        [ox + x, oy - south, oz + z]
    }
}

/// The positions of the arrays in the second chunk.
struct Arrays {
    /// Where positions, normals, colors and indices begin.
    starts: [u64; 4],
    sizes: [u64; 4],
    length: u64,
}

impl Arrays {
    fn of(mesh: &Listing) -> Result<Self> {
        let (vertices, faces) = (mesh.vertex_count as u64, mesh.face_count as u64);
        if vertices == 0 || faces == 0 {
            return Err(Error::unsupported(
                "glTF has no empty arrays: there are no triangles",
            ));
        }
        let sizes = [12 * vertices, 12 * vertices, 4 * vertices, 12 * faces];
        let mut length = 0;
        let starts = sizes.map(|size| {
            let start = length;
            length += size;
            start
        });
        Ok(Arrays {
            starts,
            sizes,
            length,
        })
    }
}

fn description(
    mesh: &Listing,
    arrays: &Arrays,
    local: &Local,
    extent: [[f32; 3]; 2],
    crs: Option<&Crs>,
) -> Value {
    let [x, y, z] = local.origin;
    let mut extras = json!({
        "origin": [x, y, z],
        "axes": "x east, y up, z south; add the origin (easting, northing, height)",
    });
    if let (Some(crs), Some(extras)) = (crs, extras.as_object_mut()) {
        if let Some(code) = crs.epsg {
            extras.insert("epsg".to_owned(), json!(code));
        }
        extras.insert("wkt".to_owned(), json!(crs_text::wkt(crs)));
    }
    let version = env!("CARGO_PKG_VERSION");
    let targets = [34962, 34962, 34962, 34963];
    let views: Vec<Value> = (0..4)
        .map(|i| {
            json!({
                "buffer": 0,
                "byteOffset": arrays.starts[i],
                "byteLength": arrays.sizes[i],
                "target": targets[i],
            })
        })
        .collect();
    let [min, max] = extent.map(|corner| corner.map(f64::from));
    let vertices = mesh.vertex_count;
    json!({
        "asset": {
            "version": "2.0",
            "generator": format!("breakline {version}"),
            "extras": { EXTRAS: extras },
        },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "surface", "translation": [x, z, -y + 0.0] }],
        "meshes": [{
            "primitives": [{
                "attributes": { "POSITION": 0, "NORMAL": 1, "COLOR_0": 2 },
                "indices": 3,
                "material": 0,
                "mode": 4,
            }],
        }],
        "materials": [{
            "name": "terrain",
            "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 1 },
        }],
        "accessors": [
            {
                "bufferView": 0, "componentType": FLOAT, "type": "VEC3", "count": vertices,
                "min": min, "max": max,
            },
            { "bufferView": 1, "componentType": FLOAT, "type": "VEC3", "count": vertices },
            {
                "bufferView": 2, "componentType": BYTE, "type": "VEC4", "count": vertices,
                "normalized": true,
            },
            {
                "bufferView": 3, "componentType": INT, "type": "SCALAR",
                "count": 3 * mesh.face_count as u64,
            },
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": arrays.length }],
    })
}

fn write_arrays(
    output: &mut dyn Write,
    mesh: &Listing,
    local: &Local,
    bounds: &Bounds,
) -> Result<()> {
    let floats = |p: [f32; 3]| row_of(p.map(f32::to_le_bytes));
    write_rows(output, mesh.vertices().map(|p| floats(local.floats(p))))?;
    let normals = vertex_normals(mesh.vertex_count, mesh.faces().zip(mesh.triangles())).into_iter();
    write_rows(
        output,
        normals.map(|[x, y, z]| floats([x, z, -y].map(|c| c as f32))),
    )?;
    let colors = colors(bounds);
    write_rows(output, mesh.vertices().map(|[_, _, z]| colors.of(z as f32)))?;
    let faces = mesh.faces();
    write_rows(output, faces.map(|face| row_of(face.map(u32::to_le_bytes))))?;
    Ok(())
}

/// Returns the colors of heights.
fn colors(bounds: &Bounds) -> Colors {
    let range = [bounds.min[2], bounds.max[2]];
    ramp::built_in(RAMP)
        .unwrap_or_default()
        .over(Some(range), ColorMatch::Linear)
}
