//! Writing UGRID, with 64-bit offsets (CDF-2).

use std::io::Write;

use super::classic::{ATTRIBUTES, CHAR, DIMENSIONS, DOUBLE, INT, VARIABLES};
use crate::crs::{Crs, CrsKind};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::bytes::lines::{row_of, write_rows};
use crate::io::codec::listing::{Listing, Remarks, crs_text};

/// The dimensions.
const NODES: u32 = 0;
const FACES: u32 = 1;
const CORNERS: u32 = 2;

/// An attribute of the file or of a variable.
enum Value {
    Text(String),
    Int(i32),
}

type Attribute = (&'static str, Value);

struct Variable {
    name: &'static str,
    dimensions: &'static [u32],
    attributes: Vec<Attribute>,
    kind: u32,
    /// Bytes of its values.
    size: u64,
}

/// Writes the mesh: coordinates and heights of its nodes as doubles, and the nodes of its faces.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<Remarks> {
    let (nodes, faces) = (mesh.vertex_count as u64, mesh.face_count as u64);
    let most = u64::from(u32::MAX) - 3;
    if 8 * nodes > most || faces > i32::MAX as u64 {
        return Err(Error::limit(format!(
            "{nodes} vertices and {faces} triangles; a file of UGRID has up to {} and {}",
            most / 8,
            i32::MAX
        )));
    }
    let variables = variables(nodes, faces, crs);
    let mut output = target.create()?;
    output.write_all(&header([nodes, faces, 3], &variables))?;
    // The mesh and the system are names alone.
    let names = variables.iter().filter(|v| v.dimensions.is_empty());
    for _ in names {
        output.write_all(&0i32.to_be_bytes())?;
    }
    for axis in 0..3 {
        write_rows(&mut output, mesh.vertices().map(|p| p[axis].to_be_bytes()))?;
    }
    let faces = mesh.faces();
    write_rows(
        &mut output,
        faces.map(|face| row_of(face.map(u32::to_be_bytes))),
    )?;
    target.put(output)?;
    Ok(Remarks::default())
}

fn text(name: &'static str, value: impl Into<String>) -> Attribute {
    (name, Value::Text(value.into()))
}

/// Returns the variables, in the order of their values.
fn variables(nodes: u64, faces: u64, crs: Option<&Crs>) -> Vec<Variable> {
    let scalar = |name, attributes| Variable {
        name,
        dimensions: &[],
        attributes,
        kind: INT,
        size: 4,
    };
    let mesh = vec![
        text("cf_role", "mesh_topology"),
        text("long_name", "triangulated surface"),
        ("topology_dimension", Value::Int(2)),
        text("node_coordinates", "mesh2d_node_x mesh2d_node_y"),
        text("face_node_connectivity", "mesh2d_face_nodes"),
        text("face_dimension", "nmesh2d_face"),
    ];
    let mut all = vec![scalar("mesh2d", mesh)];
    if let Some(crs) = crs {
        let wkt = crs_text::wkt(crs);
        let mut system = vec![text("name", crs.name.clone())];
        if let Some(code) = crs.epsg.and_then(|code| i32::try_from(code).ok()) {
            system.push(("epsg", Value::Int(code)));
            system.push(text("EPSG_code", format!("EPSG:{code}")));
        }
        system.extend([text("crs_wkt", wkt.clone()), text("wkt", wkt)]);
        all.push(scalar("projected_coordinate_system", system));
    }
    let is_angular = crs.is_some_and(|crs| crs.kind == CrsKind::Geographic);
    let plan = crs.map_or("1", |crs| crs.unit.symbol());
    let [x, y] = match is_angular {
        true => [["longitude", "degrees_east"], ["latitude", "degrees_north"]],
        false => [
            ["projection_x_coordinate", plan],
            ["projection_y_coordinate", plan],
        ],
    };
    let heights = crs.and_then(|crs| crs.vertical_unit.as_ref());
    let height = match (heights, is_angular) {
        (Some(unit), _) => unit.symbol(),
        (None, true) => "m",
        (None, false) => plan,
    };
    let on_nodes = |name, mut attributes: Vec<Attribute>| {
        attributes.extend([text("mesh", "mesh2d"), text("location", "node")]);
        if crs.is_some() {
            attributes.push(text("grid_mapping", "projected_coordinate_system"));
        }
        Variable {
            name,
            dimensions: &[NODES],
            attributes,
            kind: DOUBLE,
            size: 8 * nodes,
        }
    };
    for (name, [standard, unit]) in [("mesh2d_node_x", x), ("mesh2d_node_y", y)] {
        let attributes = vec![text("standard_name", standard), text("units", unit)];
        all.push(on_nodes(name, attributes));
    }
    all.push(on_nodes(
        "mesh2d_node_z",
        vec![
            text("standard_name", "altitude"),
            text("long_name", "height of the nodes"),
            text("units", height),
            text("coordinates", "mesh2d_node_x mesh2d_node_y"),
        ],
    ));
    all.push(Variable {
        name: "mesh2d_face_nodes",
        dimensions: &[FACES, CORNERS],
        attributes: vec![
            text("cf_role", "face_node_connectivity"),
            text("long_name", "nodes of the faces, counter-clockwise"),
            ("start_index", Value::Int(0)),
        ],
        kind: INT,
        size: 12 * faces,
    });
    all
}

/// Returns the header, with the offset of each variable.
fn header(sizes: [u64; 3], variables: &[Variable]) -> Vec<u8> {
    let mut begins = vec![0; variables.len()];
    let length = encoded(sizes, variables, &begins).len() as u64;
    let mut at = length;
    for (begin, variable) in begins.iter_mut().zip(variables) {
        *begin = at;
        at += variable.size;
    }
    encoded(sizes, variables, &begins)
}

fn encoded(sizes: [u64; 3], variables: &[Variable], begins: &[u64]) -> Vec<u8> {
    let mut out = Vec::from(*b"CDF\x02");
    let number = |out: &mut Vec<u8>, n: u64| {
        // Sizes of 4 GiB and more are stated as 2^32 - 1.
        out.extend(u32::try_from(n).unwrap_or(u32::MAX).to_be_bytes());
    };
    // No records.
    number(&mut out, 0);
    number(&mut out, u64::from(DIMENSIONS));
    number(&mut out, 3);
    for (name, size) in ["nmesh2d_node", "nmesh2d_face", "three"].iter().zip(sizes) {
        padded(&mut out, name.as_bytes());
        number(&mut out, size);
    }
    let generator = format!("breakline {}", env!("CARGO_PKG_VERSION"));
    let global = [
        text("Conventions", "CF-1.8 UGRID-1.0"),
        text("source", generator),
    ];
    attributes(&mut out, &global);
    number(&mut out, u64::from(VARIABLES));
    number(&mut out, variables.len() as u64);
    for (variable, begin) in variables.iter().zip(begins) {
        padded(&mut out, variable.name.as_bytes());
        number(&mut out, variable.dimensions.len() as u64);
        for dimension in variable.dimensions {
            number(&mut out, u64::from(*dimension));
        }
        attributes(&mut out, &variable.attributes);
        number(&mut out, u64::from(variable.kind));
        number(&mut out, variable.size);
        out.extend(begin.to_be_bytes());
    }
    out
}

fn attributes(out: &mut Vec<u8>, list: &[Attribute]) {
    out.extend(ATTRIBUTES.to_be_bytes());
    out.extend((list.len() as u32).to_be_bytes());
    for (name, value) in list {
        padded(out, name.as_bytes());
        match value {
            Value::Text(text) => {
                out.extend(CHAR.to_be_bytes());
                padded(out, text.as_bytes());
            }
            Value::Int(number) => {
                out.extend(INT.to_be_bytes());
                out.extend(1u32.to_be_bytes());
                out.extend(number.to_be_bytes());
            }
        }
    }
}

/// Appends the length of a text and the text, padded to four bytes.
fn padded(out: &mut Vec<u8>, text: &[u8]) {
    out.extend((text.len() as u32).to_be_bytes());
    out.extend(text);
    out.resize(out.len().next_multiple_of(4), 0);
}
