//! Reading UGRID.

use super::classic::{Classic, Variable};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::Watch;
use crate::io::codec::listing::polygon::{self, POLYGONS_AT_ONCE};

/// Reads the mesh of faces, with the heights of its nodes.
///
/// Heights are the variable on the nodes with the `standard_name` "altitude", else the one whose
/// name ends in `z`.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let file = Classic::open(bytes)?;
    let is_mesh = |variable: &&Variable| {
        variable.text("cf_role") == Some("mesh_topology")
            && variable.text("face_node_connectivity").is_some()
    };
    let mesh = file.variables.iter().find(is_mesh).ok_or_else(|| {
        Error::unsupported("there is no mesh of faces (UGRID): the file may have a raster")
            .at("header")
            .cure("convert a raster with gdal_translate to GeoTIFF")
    })?;
    let stated = |name: &str| {
        mesh.text(name).ok_or_else(|| {
            Error::format(format!("the mesh does not state {name}"))
                .at(format!("variable {}", mesh.name))
        })
    };
    let names: Vec<&str> = stated("node_coordinates")?.split_whitespace().collect();
    let &[x, y, ..] = &names[..] else {
        return Err(
            Error::format(format!("the nodes have the coordinates {names:?}"))
                .at(format!("variable {}", mesh.name)),
        );
    };
    let [x, y] = [file.variable(x)?, file.variable(y)?];
    let heights = heights(&file, [x, y])?;
    let [xs, ys, mut zs] = [
        measured(&file, x)?,
        measured(&file, y)?,
        measured(&file, heights)?,
    ];
    // Depths, as models of the sea have them.
    if heights.text("positive") == Some("down") {
        zs.iter_mut().for_each(|z| *z = -*z);
    }
    if xs.len() != ys.len() {
        let counts = format!("{} and {} coordinates", xs.len(), ys.len());
        return Err(Error::format(counts).at(format!("variable {}", y.name)));
    }
    watch(0)?;
    let vertices: Vec<[f64; 3]> = xs
        .into_iter()
        .zip(ys)
        .zip(zs)
        .map(|((x, y), z)| [x, y, z])
        .collect();
    let faces = faces(&file, stated("face_node_connectivity")?, &vertices, watch)?;
    Ok(Triangles {
        vertices,
        faces,
        crs: system(&file, heights)?,
        ..Triangles::default()
    })
}

/// Returns the values of a variable, unpacked.
///
/// # Errors
/// If they are not within the file, or some are missing.
fn measured(file: &Classic, variable: &Variable) -> Result<Vec<f64>> {
    let mut values = file.values(variable)?;
    let fill = variable.number("_FillValue");
    if let Some(fill) = fill.or(variable.number("missing_value")) {
        let missing = values.iter().filter(|&&value| value == fill).count();
        if missing > 0 {
            let count = values.len();
            return Err(
                Error::format(format!("{missing} of {count} values are missing ({fill})"))
                    .at(format!("variable {}", variable.name))
                    .cure("give each node of the mesh a value"),
            );
        }
    }
    let stated = |name: &str, default: f64| variable.number(name).unwrap_or(default);
    let (scale, offset) = (stated("scale_factor", 1.0), stated("add_offset", 0.0));
    if (scale, offset) != (1.0, 0.0) {
        values.iter_mut().for_each(|v| *v = *v * scale + offset);
    }
    Ok(values)
}

/// Returns the variable with the heights of nodes.
fn heights<'a>(file: &'a Classic, [x, y]: [&Variable; 2]) -> Result<&'a Variable> {
    let on_nodes = |variable: &&Variable| {
        variable.dimensions == x.dimensions && ![&x.name, &y.name].contains(&&variable.name)
    };
    let of_nodes = || file.variables.iter().filter(on_nodes);
    of_nodes()
        .find(|variable| variable.text("standard_name") == Some("altitude"))
        .or_else(|| of_nodes().find(|variable| variable.name.ends_with(['z', 'Z'])))
        .ok_or_else(|| Error::format("the nodes have no heights").at("header"))
}

fn faces(file: &Classic, name: &str, vertices: &[[f64; 3]], watch: Watch) -> Result<Vec<[u32; 3]>> {
    let variable = file.variable(name)?;
    let wrong = |text: String| Error::format(text).at(format!("variable {name}"));
    let &[_, most] = &variable.dimensions[..] else {
        return Err(wrong(
            "expected two dimensions: faces, and their corners".to_owned(),
        ));
    };
    let most = usize::try_from(file.sizes[most]).unwrap_or(usize::MAX);
    let first = variable.number("start_index").unwrap_or(0.0);
    let fill = variable.number("_FillValue");
    let numbers = file.values(variable)?;
    let mut faces = Vec::with_capacity(numbers.len() / most.max(1));
    let mut corners = Vec::new();
    for (number, row) in numbers.chunks_exact(most.max(1)).enumerate() {
        if number.is_multiple_of(POLYGONS_AT_ONCE) {
            watch(0)?;
        }
        corners.clear();
        for &node in row.iter().filter(|node| Some(**node) != fill) {
            let index = node - first;
            if !(index >= 0.0 && index < f64::from(u32::MAX)) || index.fract() != 0.0 {
                return Err(wrong(format!("face {number} names node {node}")));
            }
            corners.push(index as u32);
        }
        polygon::add_polygon(vertices, &corners, &mut faces)
            .map_err(|e| e.at(format!("variable {name}, face {number}")))?;
    }
    Ok(faces)
}

fn system(file: &Classic, heights: &Variable) -> Result<Option<Crs>> {
    let name = heights
        .text("grid_mapping")
        .unwrap_or("projected_coordinate_system");
    let Some(variable) = file.variables.iter().find(|variable| variable.name == name) else {
        return Ok(None);
    };
    let wkt = variable.text("crs_wkt").or(variable.text("wkt"));
    let crs = match (wkt, variable.number("epsg")) {
        (Some(wkt), _) if !wkt.is_empty() => Crs::from_wkt(wkt),
        // Others write 0 where none is known.
        (_, Some(code)) if code != 0.0 => Crs::from_user(&format!("EPSG:{code}")),
        _ => return Ok(None),
    };
    crs.map(Some)
        .map_err(|e| e.at(format!("variable {}", variable.name)))
}
