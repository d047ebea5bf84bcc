//! Writing LandXML.

use std::io::Write;

use super::break_type;
use super::system::{elevation_name, unit_names};
use crate::crs::{Crs, CrsKind, Unit};
use crate::data::doubled_area;
use crate::error::{Error, Result};
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::lines::write_lines;
use crate::io::codec::listing::lines::{self, Lines};
use crate::io::codec::listing::{Listing, Remarks, crs_text};
use crate::io::codec::xml::escaped;
use crate::io::{Destination, Output};

/// The date and time that LandXML requires: the same surface gives the same bytes on any day.
const DATE: &str = "date=\"1970-01-01\" time=\"00:00:00\"";

/// Writes the surface with its lines and boundaries. Numbers are the shortest that read back as the
/// same double.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<Remarks> {
    let units = Units::of(crs)?;
    let name = target.path().file_stem().unwrap_or_default();
    let name = escaped(&name.to_string_lossy());
    let mut output = target.create()?;
    writeln!(
        output,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\" \
         xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:schemaLocation=\"http://www.landxml.org/schema/LandXML-1.2 \
         http://www.landxml.org/schema/LandXML-1.2/LandXML-1.2.xsd\" version=\"1.2\" {DATE}>"
    )?;
    writeln!(output, "<Units>{}</Units>", units.element)?;
    if let Some(crs) = crs {
        write_system(&mut output, crs)?;
    }
    let version = env!("CARGO_PKG_VERSION");
    writeln!(
        output,
        "<Application name=\"breakline\" version=\"{version}\"></Application>"
    )?;
    writeln!(
        output,
        "<Surfaces>\n<Surface name=\"{name}\">\n<SourceData>"
    )?;
    write_boundaries(&mut output, mesh)?;
    write_breaklines(&mut output, mesh)?;
    writeln!(
        output,
        "</SourceData>\n<Definition surfType=\"TIN\">\n<Pnts>"
    )?;
    let vertices = (1u64..).zip(mesh.vertices());
    write_lines(&mut output, vertices, |text, (id, [x, y, z])| {
        let [x, y, z] = [x, y, z].map(Decimal);
        writeln!(text, "<P id=\"{id}\">{y} {x} {z}</P>")
    })?;
    writeln!(output, "</Pnts>\n<Faces>")?;
    write_lines(&mut output, mesh.faces(), |text, face| {
        let [a, b, c] = face.map(|v| u64::from(v) + 1);
        writeln!(text, "<F>{a} {b} {c}</F>")
    })?;
    writeln!(
        output,
        "</Faces>\n</Definition>\n</Surface>\n</Surfaces>\n</LandXML>"
    )?;
    target.put(output)?;
    Ok(Remarks {
        notes: units.notes,
        ..Remarks::default()
    })
}

/// The element for the units of a surface, and what it cannot say.
struct Units {
    element: String,
    notes: Vec<String>,
}

impl Units {
    fn of(crs: Option<&Crs>) -> Result<Self> {
        if crs.is_some_and(|crs| crs.kind == CrsKind::Geographic) {
            let error = Error::unsupported("LandXML has no surfaces in degrees");
            return Err(error.cure("write .ply, or reproject to a system in meters or feet"));
        }
        let mut notes = Vec::new();
        let plan = crs.map_or_else(Unit::metre, |crs| crs.unit.clone());
        if crs.is_none() {
            notes.push("the unit is not known; the file states meters".to_owned());
        }
        let Some(names) = unit_names(&plan) else {
            return Err(Error::unsupported(format!(
                "LandXML does not have the unit {}",
                plan.name
            ))
            .cure("write .ply, or reproject to a system in meters or feet"));
        };
        let heights = crs.and_then(|crs| crs.vertical_unit.as_ref());
        let mut elevation = String::new();
        if let Some(unit) = heights.filter(|unit| !unit.is_same(&plan)) {
            match elevation_name(unit) {
                Some(name) => elevation = format!(" elevationUnit=\"{name}\""),
                None => notes.push(format!(
                    "heights are in {}: only the attribute ogcWktCode states it",
                    unit.name
                )),
            }
        }
        let others = match names.element {
            "Metric" => {
                "areaUnit=\"squareMeter\" volumeUnit=\"cubicMeter\" temperatureUnit=\"celsius\" \
                 pressureUnit=\"milliBars\""
            }
            _ => {
                "areaUnit=\"squareFoot\" volumeUnit=\"cubicFeet\" temperatureUnit=\"fahrenheit\" \
                 pressureUnit=\"inchHG\""
            }
        };
        let element = format!(
            "<{0} linearUnit=\"{1}\" {others}{elevation}></{0}>",
            names.element, names.linear
        );
        Ok(Units { element, notes })
    }
}

fn write_system(output: &mut Output, crs: &Crs) -> Result<()> {
    let wkt = crs_text::wkt(crs);
    write!(output, "<CoordinateSystem name=\"{}\"", escaped(&crs.name))?;
    if let Some(code) = crs.epsg {
        write!(output, " epsgCode=\"{code}\"")?;
    }
    if !wkt.is_empty() {
        write!(output, " ogcWktCode=\"{}\"", escaped(&wkt))?;
    }
    writeln!(output, "></CoordinateSystem>")?;
    Ok(())
}

fn write_boundaries(output: &mut Output, mesh: &Listing) -> Result<()> {
    let rings = lines::rings(mesh.surface);
    if rings.is_empty() {
        return Ok(());
    }
    writeln!(output, "<Boundaries>")?;
    for ring in rings {
        let closed = ring.iter().chain(ring.first());
        let ring: Vec<[f64; 3]> = closed.map(|&v| mesh.surface.position(v)).collect();
        let kind = match doubled_area(&ring) < 0.0 {
            true => "void",
            false => "outer",
        };
        write!(output, "<Boundary bndType=\"{kind}\" edgeTrim=\"false\">")?;
        write_points(output, ring)?;
        writeln!(output, "</Boundary>")?;
    }
    writeln!(output, "</Boundaries>")?;
    Ok(())
}

fn write_breaklines(output: &mut Output, mesh: &Listing) -> Result<()> {
    let all = lines::lines(mesh.surface);
    if all.is_empty() {
        return Ok(());
    }
    writeln!(output, "<Breaklines>")?;
    for Lines { kind, lines } in all {
        let (name, kind) = (kind.noun(), break_type(kind));
        for line in lines {
            write!(output, "<Breakline brkType=\"{kind}\" name=\"{name}\">")?;
            write_points(output, line.iter().map(|&v| mesh.surface.position(v)))?;
            writeln!(output, "</Breakline>")?;
        }
    }
    writeln!(output, "</Breaklines>")?;
    Ok(())
}

fn write_points(output: &mut Output, points: impl IntoIterator<Item = [f64; 3]>) -> Result<()> {
    write!(output, "<PntList3D>")?;
    for (number, p) in points.into_iter().enumerate() {
        let between = if number == 0 { "" } else { " " };
        let [x, y, z] = p.map(Decimal);
        write!(output, "{between}{y} {x} {z}")?;
    }
    write!(output, "</PntList3D>")?;
    Ok(())
}
