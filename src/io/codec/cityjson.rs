//! CityJSON 2.0: the surface as a TINRelief, with whole numbers as coordinates.

use std::io::Write;

use serde_json::{Map, Value, json};

use super::listing::loss::Loss;
use super::listing::{Listing, Remarks};
use crate::crs::{Crs, CrsKind};
use crate::data::Bounds;
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::bytes::lines::write_lines;

/// The steps of coordinates, in plan and of heights: thousandths, and about as much in degrees.
const STEP: f64 = 1e-3;
const STEP_OF_DEGREES: f64 = 1e-8;

/// The largest whole number that doubles hold, and readers of JSON keep.
const LARGEST: f64 = (1u64 << 53) as f64;

/// Writes the surface as one object with the name of the file.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<Remarks> {
    let mut bounds = Bounds::default();
    mesh.vertices().for_each(|p| bounds.add(p));
    let lattice = Lattice::of(&bounds, crs)?;
    let name = target.path().file_stem().unwrap_or_default();
    let name = name.to_string_lossy();
    let mut metadata = Map::new();
    if !bounds.is_empty() {
        let extent = [bounds.min, bounds.max].concat();
        metadata.insert("geographicalExtent".to_owned(), json!(extent));
    }
    if let Some(code) = crs.and_then(|crs| crs.epsg) {
        let system = format!("https://www.opengis.net/def/crs/EPSG/0/{code}");
        metadata.insert("referenceSystem".to_owned(), json!(system));
    }
    let metadata = Value::Object(metadata);
    let Lattice { step, origin } = lattice;
    let transform = json!({ "scale": step, "translate": origin });
    let mut output = target.create()?;
    writeln!(
        output,
        "{{\"type\":\"CityJSON\",\"version\":\"2.0\",\n\"transform\":{transform},\n\
         \"metadata\":{metadata},\n\"CityObjects\":{{{}:{{\"type\":\"TINRelief\",\
         \"geometry\":[{{\"type\":\"CompositeSurface\",\"lod\":\"1\",\"boundaries\":[",
        json!(name)
    )?;
    // A comma before each but the first.
    let comma = |first: bool| if first { "" } else { "," };
    let faces = mesh.faces().enumerate();
    write_lines(&mut output, faces, |text, (number, [a, b, c])| {
        writeln!(text, "{}[[{a},{b},{c}]]", comma(number == 0))
    })?;
    writeln!(output, "]}}]}}}},\n\"vertices\":[")?;
    let vertices = mesh.vertices().enumerate();
    write_lines(&mut output, vertices, |text, (number, p)| {
        let [x, y, z] = lattice.whole(p);
        writeln!(text, "{}[{x},{y},{z}]", comma(number == 0))
    })?;
    writeln!(output, "]}}")?;
    target.put(output)?;
    let loss = Loss::of(mesh, |p| lattice.read_back(p));
    let kind = format!("whole numbers of {} and {}", step[0], step[2]);
    let mut notes = loss.notes(&kind, origin);
    if let Some(crs) = crs.filter(|crs| crs.epsg.is_none()) {
        notes.push(format!(
            "the coordinate system has no EPSG code, and is left out: {crs}"
        ));
    }
    Ok(Remarks {
        notes,
        ..Remarks::default()
    })
}

/// The whole numbers that stand for coordinates.
struct Lattice {
    step: [f64; 3],
    origin: [f64; 3],
}

impl Lattice {
    fn of(bounds: &Bounds, crs: Option<&Crs>) -> Result<Self> {
        let in_plan = match crs.is_some_and(|crs| crs.kind == CrsKind::Geographic) {
            true => STEP_OF_DEGREES,
            false => STEP,
        };
        let step = [in_plan, in_plan, STEP];
        let origin = match bounds.is_empty() {
            true => [0.0; 3],
            false => bounds.min.map(f64::floor),
        };
        let lattice = Lattice { step, origin };
        match bounds.is_empty() || lattice.whole(bounds.max).iter().all(|c| *c <= LARGEST) {
            true => Ok(lattice),
            false => Err(
                Error::limit("the surface is too large for whole numbers of thousandths")
                    .cure("write .ply, which has doubles"),
            ),
        }
    }

    fn whole(&self, p: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| ((p[k] - self.origin[k]) / self.step[k]).round())
    }

    /// Returns the position that a reader finds.
    fn read_back(&self, p: [f64; 3]) -> [f64; 3] {
        let whole = self.whole(p);
        [0, 1, 2].map(|k| whole[k] * self.step[k] + self.origin[k])
    }
}
