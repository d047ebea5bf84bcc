//! Reading DXF drawings in text: lines, polylines and points of a layer or of all.
//!
//! A drawing is pairs of lines: a code, and a value. Code 0 begins an entity, 8 is its layer; 10,
//! 20 and 30 are x, y and z, also 11, 21 and 31 of the end of a line.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::str::FromStr;

use crate::data::{Layer, Shape};
use crate::error::{Error, Result, Wording};
use crate::io::bytes::code_page::utf8_or_windows_1252;
use crate::io::bytes::rows::shown;
use crate::io::bytes::watch::{Meter, Watch, bytes_of};
use crate::io::codec::listing::crs_text;
use crate::io::options::layer::Options;

/// Reads LINE, POLYLINE, LWPOLYLINE and POINT. A warning counts other entities, and arcs in
/// polylines, which become straight.
///
/// # Errors
/// If the drawing is binary, cut or damaged; if no layer has the requested name; if attributes are
/// requested, which only GDAL reads.
pub(crate) fn read(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let bytes = bytes_of(path, watch)?;
    parse(&bytes, options, watch).map_err(|e| e.in_file(path))
}

fn parse(bytes: &[u8], options: &Options, watch: Watch) -> Result<Layer> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(Error::unsupported("a binary drawing").cure("save it as DXF in text"));
    }
    if options.height_field.is_some() || !options.columns.is_empty() {
        return Err(Error::unsupported("a drawing has no attributes")
            .cure("name its layer alone, as in FILE:LAYER"));
    }
    let mut drawing = Drawing::new(options.layer);
    let mut pairs = Pairs {
        rest: bytes,
        line: 0,
        meter: Meter::new(watch, bytes.len()),
    };
    while let Some(pair) = pairs.next()? {
        if drawing.take(pair)? {
            return drawing.finish();
        }
    }
    Err(Error::format("the file ends before EOF")
        .at(format!("line {}", pairs.line))
        .cure("get the whole file"))
}

/// A code and its value, with the line of the value.
#[derive(Clone, Copy)]
struct Pair<'a> {
    code: i32,
    value: &'a [u8],
    line: usize,
}

impl Pair<'_> {
    fn number(&self) -> Result<f64> {
        let number = parsed(self.value).filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.wrong("a finite number"))
    }

    fn flags(&self) -> Result<u32> {
        parsed(self.value).ok_or_else(|| self.wrong("flags"))
    }

    #[cold]
    fn wrong(&self, expected: &str) -> Error {
        let (shown, code) = (shown(self.value), self.code);
        Error::format(format!(
            "'{shown}' is the value of code {code}, expected {expected}"
        ))
        .at(format!("line {}", self.line))
    }
}

/// Parses a text of a drawing.
fn parsed<T: FromStr>(text: &[u8]) -> Option<T> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

struct Pairs<'a> {
    rest: &'a [u8],
    line: usize,
    meter: Meter<'a>,
}

impl<'a> Pairs<'a> {
    fn next(&mut self) -> Result<Option<Pair<'a>>> {
        self.meter.left(self.rest.len())?;
        let Some(code) = self.text() else {
            return Ok(None);
        };
        let code = parsed(code).ok_or_else(|| {
            Error::format(format!("'{}' is not a code of DXF", shown(code)))
                .at(format!("line {}", self.line))
                .cure("get the whole file, or save the drawing again")
        })?;
        let line = self.line + 1;
        Ok(self.text().map(|value| Pair { code, value, line }))
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n');
        let line = &self.rest[..end.unwrap_or(self.rest.len())];
        self.rest = match end {
            Some(end) => &self.rest[end + 1..],
            None => &[],
        };
        self.line += 1;
        Some(line.trim_ascii())
    }
}

/// The values of an entity that are used.
#[derive(Default)]
struct Entity {
    kind: String,
    layer: String,
    /// Corners 0 and 1 of a line, or the position of a vertex; NaN for what is not stated.
    at: [[f64; 3]; 2],
    /// The vertices of a polyline.
    vertices: Vec<[f64; 3]>,
    /// The height of all vertices of an LWPOLYLINE.
    elevation: f64,
    flags: u32,
    arcs: usize,
    /// The third number of the direction that is up for the entity.
    up: f64,
    /// Whether it is on a sheet, not in the map.
    is_on_paper: bool,
    line: usize,
}

/// Flags of polylines.
const CLOSED: u32 = 1;
const IN_SPACE: u32 = 8;
/// Polygon meshes (16) and polyface meshes (64).
const MESHES: u32 = 16 | 64;
/// A vertex that shapes a spline, but is not on it.
const CONTROL: u32 = 16;

/// A drawing while it is read.
struct Drawing<'a> {
    wanted: Option<&'a str>,
    /// The name of the current section; empty between sections.
    section: Vec<u8>,
    entity: Entity,
    /// A POLYLINE whose vertices follow.
    polyline: Option<Entity>,
    layers: BTreeSet<String>,
    shapes: Vec<Shape>,
    others: BTreeMap<String, usize>,
    arcs: usize,
    system: String,
}

impl<'a> Drawing<'a> {
    fn new(wanted: Option<&'a str>) -> Self {
        Drawing {
            wanted,
            section: Vec::new(),
            entity: Entity::default(),
            polyline: None,
            layers: BTreeSet::new(),
            shapes: Vec::new(),
            others: BTreeMap::new(),
            arcs: 0,
            system: String::new(),
        }
    }

    /// Takes a pair; returns true at the end of the drawing.
    fn take(&mut self, pair: Pair) -> Result<bool> {
        if pair.code == 999 {
            let text = String::from_utf8_lossy(pair.value);
            self.system += crs_text::crs_comment(&text).unwrap_or_default();
            return Ok(false);
        }
        if pair.code != 0 {
            if self.entity.kind == "SECTION" && pair.code == 2 {
                self.section = pair.value.to_vec();
            } else if self.section == b"ENTITIES" {
                self.value(pair)?;
            }
            return Ok(false);
        }
        let ended = std::mem::take(&mut self.entity);
        if self.section == b"ENTITIES" {
            self.ended(ended)?;
        }
        match pair.value {
            b"EOF" if self.polyline.is_some() => {
                return Err(
                    Error::format("a polyline without SEQEND").at(format!("line {}", pair.line))
                );
            }
            b"EOF" => return Ok(true),
            b"ENDSEC" => self.section.clear(),
            _ => (),
        }
        self.entity = Entity {
            kind: String::from_utf8_lossy(pair.value)
                .chars()
                .take(40)
                .collect(),
            at: [[f64::NAN; 3]; 2],
            elevation: f64::NAN,
            up: 1.0,
            line: pair.line,
            ..Entity::default()
        };
        Ok(false)
    }

    /// Takes a value of an entity.
    fn value(&mut self, pair: Pair) -> Result<()> {
        let entity = &mut self.entity;
        let is_light = entity.kind == "LWPOLYLINE";
        match pair.code {
            8 => entity.layer = name(pair.value),
            10 if is_light => entity.vertices.push([pair.number()?, f64::NAN, f64::NAN]),
            20 if is_light => {
                let y = pair.number()?;
                if let Some(last) = entity.vertices.last_mut() {
                    last[1] = y;
                }
            }
            10 | 20 | 30 => entity.at[0][(pair.code / 10 - 1) as usize] = pair.number()?,
            11 | 21 | 31 if entity.kind == "LINE" => {
                entity.at[1][(pair.code / 10 - 1) as usize] = pair.number()?;
            }
            38 if is_light => entity.elevation = pair.number()?,
            42 if is_light || entity.kind == "VERTEX" => {
                entity.arcs += usize::from(pair.number()? != 0.0);
            }
            70 if is_light || matches!(entity.kind.as_str(), "VERTEX" | "POLYLINE") => {
                entity.flags = pair.flags()?;
            }
            67 => entity.is_on_paper = pair.flags()? == 1,
            230 => entity.up = pair.number()?,
            _ => (),
        }
        Ok(())
    }

    fn ended(&mut self, entity: Entity) -> Result<()> {
        let damage = |text: &str, line: usize| Error::format(text).at(format!("line {line}"));
        match (entity.kind.as_str(), &mut self.polyline) {
            ("VERTEX", Some(polyline)) => {
                if entity.flags & CONTROL == 0 {
                    let [x, y, z] = entity.at[0];
                    let z = match polyline.flags & IN_SPACE {
                        0 => polyline.at[0][2],
                        _ => z,
                    };
                    polyline.vertices.push([x, y, z]);
                    polyline.arcs += entity.arcs;
                }
            }
            ("SEQEND", Some(_)) => {
                if let Some(polyline) = self.polyline.take() {
                    self.line(polyline)?;
                }
            }
            (kind, Some(_)) => {
                let text = format!("the entity '{kind}' follows a vertex of a polyline");
                return Err(damage(&text, entity.line));
            }
            ("VERTEX", None) => return Err(damage("a vertex outside of polylines", entity.line)),
            ("POLYLINE", None) if entity.flags & MESHES == 0 => {
                self.polyline = Some(entity);
            }
            ("POLYLINE", None) => {
                // Its vertices are read, and left out.
                self.count(&entity, "polyface mesh");
                self.polyline = Some(Entity {
                    kind: String::new(),
                    ..entity
                });
            }
            ("LWPOLYLINE", None) => {
                let mut entity = entity;
                for vertex in &mut entity.vertices {
                    vertex[2] = entity.elevation;
                }
                self.line(entity)?;
            }
            ("LINE", None) => self.line(Entity {
                vertices: entity.at.to_vec(),
                ..entity
            })?,
            ("POINT", None) => {
                if self.is_wanted(&entity) {
                    require_stated(&entity.at[..1], &entity)?;
                    self.shapes.push(Shape::Points(vec![entity.at[0]]));
                }
            }
            ("" | "SECTION" | "ENDSEC" | "SEQEND" | "ATTRIB", None) => (),
            (kind, None) => {
                let kind = kind.to_owned();
                self.count(&entity, &kind);
            }
        }
        Ok(())
    }

    /// Adds a line, unless another layer is wanted.
    fn line(&mut self, entity: Entity) -> Result<()> {
        if entity.kind.is_empty() || !self.is_wanted(&entity) {
            return Ok(());
        }
        require_stated(&entity.vertices, &entity)?;
        let mut vertices = entity.vertices;
        if entity.flags & CLOSED != 0 {
            vertices.extend(vertices.first().copied());
        }
        self.arcs += entity.arcs;
        if vertices.len() > 1 {
            self.shapes.push(Shape::Lines(vec![vertices]));
        }
        Ok(())
    }

    /// Returns true if an entity is in the layer that is read, and lies in the axes of the drawing.
    fn is_wanted(&mut self, entity: &Entity) -> bool {
        let is_upright = entity.up == 1.0 || entity.kind == "LINE" || entity.kind == "POINT";
        if !is_upright {
            self.count(entity, "entity in tilted axes");
        } else if entity.is_on_paper {
            self.count(entity, "entity on paper");
        }
        self.is_in_layer(entity) && is_upright && !entity.is_on_paper
    }

    fn is_in_layer(&mut self, entity: &Entity) -> bool {
        if !self.layers.contains(&entity.layer) {
            self.layers.insert(entity.layer.clone());
        }
        self.wanted
            .is_none_or(|wanted| wanted.eq_ignore_ascii_case(&entity.layer))
    }

    fn count(&mut self, entity: &Entity, kind: &str) {
        if self.is_in_layer(entity) {
            *self.others.entry(kind.to_owned()).or_default() += 1;
        }
    }

    fn finish(self) -> Result<Layer> {
        let is_there = |wanted: &str| {
            let mut layers = self.layers.iter();
            layers.any(|layer| layer.eq_ignore_ascii_case(wanted))
        };
        if let Some(wanted) = self.wanted.filter(|wanted| !is_there(wanted)) {
            let names: Vec<&str> = self.layers.iter().map(String::as_str).collect();
            return Err(Error::usage(format!("there is no layer \"{wanted}\""))
                .at("ENTITIES")
                .cure(format!("name one of {}", names.join(", "))));
        }
        if let (Some(faces), None) = (self.others.get("3DFACE"), self.wanted) {
            return Err(Error::unsupported(format!(
                "the drawing holds a surface of {faces} faces (3DFACE), which is not read"
            ))
            .at("ENTITIES")
            .cure(
                "name the layer of its lines, as in FILE:LAYER, or save the surface as LandXML",
            ));
        }
        let mut warnings: Vec<Wording> = Vec::new();
        if !self.others.is_empty() {
            let others = self
                .others
                .iter()
                .map(|(kind, count)| format!("{count} {kind}"));
            let others: Vec<String> = others.collect();
            warnings.push(format!("left out: {}", others.join(", ")).into());
        }
        if self.arcs > 0 {
            warnings.push(format!("{} arcs in polylines are read as straight", self.arcs).into());
        }
        Ok(Layer {
            format: "DXF".to_owned(),
            shapes: self.shapes,
            crs: crs_text::parse(&self.system)?,
            warnings,
            ..Layer::default()
        })
    }
}

/// Returns a name: in UTF-8 as of AutoCAD 2007, else in the code page of who wrote it, which is
/// Windows-1252 unless the drawing says otherwise; signs that it lacks are `\U+` and 4 digits.
fn name(bytes: &[u8]) -> String {
    const ESCAPE: &str = "\\U+";
    let text = utf8_or_windows_1252(bytes);
    let mut parts = text.split(ESCAPE);
    let mut name = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (digits, rest) = part.split_at_checked(4).unwrap_or(("", part));
        let code = u32::from_str_radix(digits, 16).ok();
        match code.and_then(char::from_u32) {
            Some(sign) => name.extend([String::from(sign), rest.to_owned()]),
            None => name.extend([ESCAPE, part]),
        }
    }
    name
}

/// Returns an error if a vertex has no x or no y. One without a height has none: it is not at 0.
fn require_stated(vertices: &[[f64; 3]], entity: &Entity) -> Result<()> {
    let is_stated = |[x, y, _]: &[f64; 3]| !x.is_nan() && !y.is_nan();
    match vertices.iter().all(is_stated) {
        true => Ok(()),
        false => Err(
            Error::format(format!("the entity '{}' lacks an x or a y", entity.kind))
                .at(format!("line {}", entity.line))
                .cure("get the whole file, or save the drawing again"),
        ),
    }
}
