//! Triangulations in space: the files of TetGen (Si 2015, "TetGen, a Delaunay-Based Quality
//! Tetrahedral Mesh Generator"; the formats are those of version 1.6), of MEDIT and of VTK.
//!
//! | file | contains | read | written |
//! |---|---|---|---|
//! | `.node` | vertices with attributes and boundary markers | yes | yes |
//! | `.weights` | the weight of each vertex, one a line | next to points | no |
//! | `.ele` | tetrahedra | yes, with the `.node` next to it | yes |
//! | `.face` | the facets of the convex hull, with marker 1 | no | yes |
//! | `.edge` | all edges, with marker 1 on the convex hull and 0 within | no | yes |
//! | `.neigh` | the neighbors of the tetrahedra | next to an `.ele` | yes |
//! | `.mesh` | vertices, facets of the convex hull, tetrahedra (MEDIT, ASCII) | no | yes |
//! | `.vtu` | vertices and tetrahedra (VTK's unstructured grid, for ParaView) | no | yes |
//!
//! Numbers, names and errors are as in [Triangle's files](super::triangle). The corners of a
//! tetrahedron are in the order that VTK and MEDIT ask for: seen from the fourth, the first three
//! turn clockwise; so its volume is positive. Neighbor `i` lies opposite corner `i`. Facets of the
//! hull turn counter-clockwise as seen from outside. `.mesh` numbers from 1, `.vtu` from 0.

mod medit;
mod tetrahedralized;
mod vtu;

use std::io::{self, Write};
use std::path::Path;

use super::triangle::{Nodes, Numbering, counted, extension, listed, node, read_rows};
use crate::error::{Error, Result, Wording};
use crate::io::Destination;
use crate::io::bytes::watch::{Watch, unwatched};

pub(crate) use tetrahedralized::FACETS;
pub use tetrahedralized::Tetrahedralized;

/// Returns the dimension that the first line of a `.node` file states.
///
/// # Errors
/// If the file cannot be read or does not begin with the number of vertices.
pub fn dimension(path: &Path) -> Result<u32> {
    read_rows(path, &unwatched, &mut Vec::new(), |mut rows| {
        node::dimension(&mut rows)
    })
}

/// Reads a `.node` file of dimension 3; returns it with warnings.
///
/// # Errors
/// If the file is damaged; the error names the file and the line.
pub fn read_nodes(path: &Path, watch: Watch) -> Result<(Nodes<3>, Vec<Wording>)> {
    let (listed, warnings) = node::read_alone(path, watch)?;
    Ok((listed.nodes, warnings))
}

/// Reads a `.weights` file: one number a line, `count` of them; returns them with warnings.
///
/// # Errors
/// If there are fewer or more, or one is not a finite number; the error names the file and the
/// line.
pub fn read_weights(path: &Path, count: usize, watch: Watch) -> Result<(Vec<f64>, Vec<Wording>)> {
    let mut warnings = Vec::new();
    let weights = read_rows(path, watch, &mut warnings, |mut rows| {
        let mut weights = Vec::new();
        for i in 0..count {
            weights.push(
                rows.expect(|| format!("weight {} of {count}", i + 1), "WEIGHT")?
                    .finite("weight")?,
            );
        }
        rows.end("the last weight")?;
        Ok(weights)
    })?;
    Ok((weights, warnings))
}

/// Reads an `.ele` file of tetrahedra and the `.node` next to it, with the neighbors that the
/// `.neigh` next to it states; without one there are none. Returns them with warnings.
///
/// # Errors
/// If a file is damaged; the error names the file and the line.
pub fn read(path: &Path, watch: Watch) -> Result<(Tetrahedralized, Vec<Wording>)> {
    let (nodes, mut warnings) = read_nodes(&path.with_extension("node"), watch)?;
    let numbering = Numbering {
        first: nodes.first_number,
        count: nodes.points.len(),
    };
    let tetrahedra = read_rows(path, watch, &mut warnings, |mut rows| {
        let (mut header, count) = counted(&mut rows, "tetrahedra", "TETRAHEDRA 4 ATTRIBUTES")?;
        let corner_count: usize = header.within_or("number of vertices of a tetrahedron", 4)?;
        if corner_count != 4 && corner_count != 10 {
            return Err(header.wrong(format!(
                "a tetrahedron has {corner_count} vertices, expected 4 or 10"
            )));
        }
        let tetrahedra = listed(
            &mut rows,
            count,
            "tetrahedron",
            "NUMBER VERTEX VERTEX VERTEX VERTEX",
            |row, _| {
                let mut corners = [0; 4];
                for corner in &mut corners {
                    *corner = numbering.vertex(row, "corner")?;
                }
                Ok(corners)
            },
        )?;
        rows.end("the last tetrahedron")?;
        Ok(tetrahedra)
    })?;
    let beside = path.with_extension("neigh");
    let neighbors = match beside.exists() {
        true => read_neighbors(
            &beside,
            nodes.first_number,
            tetrahedra.len(),
            watch,
            &mut warnings,
        )?,
        false => Vec::new(),
    };
    Ok((
        Tetrahedralized {
            nodes,
            tetrahedra,
            neighbors,
        },
        warnings,
    ))
}

fn read_neighbors(
    path: &Path,
    first: u32,
    count: usize,
    watch: Watch,
    warnings: &mut Vec<Wording>,
) -> Result<Vec<[Option<u32>; 4]>> {
    let numbering = Numbering { first, count };
    read_rows(path, watch, warnings, |mut rows| {
        let (header, stated) = counted(&mut rows, "tetrahedra", "TETRAHEDRA 4")?;
        if stated != count {
            return Err(header.wrong(format!(
                "there are {stated} tetrahedra, but the .ele file has {count}"
            )));
        }
        let pattern = "NUMBER NEIGHBOR NEIGHBOR NEIGHBOR NEIGHBOR, -1 for none";
        let neighbors = listed(&mut rows, count, "tetrahedron", pattern, |row, _| {
            let mut around = [None; 4];
            for beside in &mut around {
                *beside = numbering.neighbor(row, "tetrahedron")?;
            }
            Ok(around)
        })?;
        rows.end("the last tetrahedron")?;
        Ok(neighbors)
    })
}

/// Writes a triangulation in space; the extension of each target decides the format.
///
/// # Errors
/// If an extension is not one of those [above](self) or a file cannot be written.
pub fn write(targets: &[Destination], triangulated: &Tetrahedralized) -> Result<()> {
    for target in targets {
        let mut output = target.create()?;
        let written = match extension(&target.format_path()).as_str() {
            "node" => {
                node::write(&mut output, &triangulated.nodes).and_then(|()| sign(&mut output))
            }
            "ele" => write_tetrahedra(&mut output, triangulated).and_then(|()| sign(&mut output)),
            "face" => write_hull(&mut output, triangulated).and_then(|()| sign(&mut output)),
            "edge" => write_edges(&mut output, triangulated).and_then(|()| sign(&mut output)),
            "neigh" => write_neighbors(&mut output, triangulated).and_then(|()| sign(&mut output)),
            "mesh" => medit::write(&mut output, triangulated),
            "vtu" => vtu::write(&mut output, triangulated),
            _ => {
                return Err(Error::usage(
                    "the file's extension is not that of a triangulation in space",
                )
                .in_file(target.path())
                .cure("use .node, .ele, .face, .edge, .neigh, .mesh or .vtu"));
            }
        };
        written.map_err(|e| Error::from(e).in_file(target.path()))?;
        target.put(output)?;
    }
    Ok(())
}

fn sign(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "# Generated by breakline")
}

fn write_tetrahedra(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    writeln!(out, "{}  4  0", triangulated.tetrahedra.len())?;
    for (number, corners) in (first as usize..).zip(&triangulated.tetrahedra) {
        let [a, b, c, d] = corners.map(|v| v + first);
        writeln!(out, "{number:5}    {a}  {b}  {c}  {d}")?;
    }
    Ok(())
}

fn write_hull(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    writeln!(out, "{}  1", triangulated.hull().count())?;
    for (number, corners) in (first as usize..).zip(triangulated.hull()) {
        let [a, b, c] = corners.map(|v| v + first);
        writeln!(out, "{number:5}    {a}  {b}  {c}    1")?;
    }
    Ok(())
}

fn write_edges(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    let edges = triangulated.edges();
    writeln!(out, "{}  1", edges.len())?;
    for (number, (ends, is_on_hull)) in (first as usize..).zip(edges) {
        let [a, b] = ends.map(|v| v + first);
        writeln!(out, "{number:5}    {a}  {b}    {}", u8::from(is_on_hull))?;
    }
    Ok(())
}

fn write_neighbors(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    writeln!(out, "{}  4", triangulated.neighbors.len())?;
    for (number, around) in (first as usize..).zip(&triangulated.neighbors) {
        let [a, b, c, d] =
            around.map(|beside| beside.map_or(-1, |beside| i64::from(beside) + i64::from(first)));
        writeln!(out, "{number:5}    {a}  {b}  {c}  {d}")?;
    }
    Ok(())
}
