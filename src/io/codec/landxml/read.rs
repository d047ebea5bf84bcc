//! Reading LandXML as a stream.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};

use super::kind_of;
use super::system::{Stated, unit_of};
use crate::data::{EdgeKind, Triangles};
use crate::error::{Error, Result, Wording};
use crate::io::Watch;
use crate::io::bytes::rows::shown;
use crate::io::bytes::watch::{Meter, bytes_of};
use crate::io::codec::listing::ids::Ids;
use crate::io::codec::listing::polygon;

/// Reads the surface with a name, or the only one.
///
/// Hidden faces (`i="1"`) are holes. Breaklines become kinds of edges where they are edges of the
/// surface; a warning counts the others.
pub(crate) fn read(path: &Path, name: Option<&str>, watch: Watch) -> Result<Triangles> {
    let bytes = bytes_of(path, watch)?;
    let text = match std::str::from_utf8(&bytes) {
        Ok(text) => text,
        Err(_) if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") => {
            return Err(Error::unsupported("the text is UTF-16").cure("save it as UTF-8"));
        }
        Err(error) => {
            return Err(Error::format("the text is not UTF-8")
                .at(line(&bytes, error.valid_up_to()))
                .cure("save it as UTF-8"));
        }
    };
    let mut reader = Reader::from_str(text);
    let mut parser = Parser::new(name);
    let mut meter = Meter::new(watch, text.len());
    loop {
        let before = position(&reader);
        meter.left(text.len().saturating_sub(before))?;
        let event = reader.read_event().map_err(|error| {
            Error::format(format!("not XML: {error}"))
                .at(line(&bytes, reader.error_position() as usize))
                .cure("get the whole file, or write it again")
        })?;
        let is_end = matches!(event, Event::Eof);
        let taken = match event {
            Event::Start(start) => parser.start(&start),
            Event::Empty(start) => parser.start(&start).and_then(|()| parser.end()),
            Event::End(_) => parser.end(),
            Event::Text(text) => parser.text(&text.into_inner()),
            Event::CData(text) => parser.text(&text.into_inner()),
            Event::GeneralRef(name) => parser.text(&format!("&{};", &*name.into_inner())),
            Event::Eof => parser.finish(),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => Ok(()),
        };
        taken.map_err(|error| match error.location() {
            None => error.at(line(&bytes, first_of(text, before))),
            Some(_) => error,
        })?;
        if is_end {
            return parser.triangles();
        }
    }
}

fn position(reader: &Reader<&[u8]>) -> usize {
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

/// Returns the position of the first character from a position on that is not blank.
fn first_of(text: &str, from: usize) -> usize {
    let rest = text.as_bytes().get(from..).unwrap_or_default();
    let blanks = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
    from + if blanks < rest.len() { blanks } else { 0 }
}

/// Returns the number of the line that has a byte.
fn line(bytes: &[u8], at: usize) -> String {
    let before = &bytes[..at.min(bytes.len())];
    let breaks = before.iter().filter(|&&b| b == b'\n').count();
    format!("line {}", breaks + 1)
}

/// The elements that are understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Element {
    Root,
    Units,
    Unit,
    Surfaces,
    /// A surface that is read.
    Surface,
    Source,
    Breaklines,
    Breakline,
    BreaklinePoints,
    Definition,
    Points,
    Point,
    Faces,
    Face,
    Other,
}

impl Element {
    fn within(parent: Option<Element>, name: &str) -> Self {
        match (parent, name) {
            (None, _) => Element::Root,
            (Some(Element::Root), "Units") => Element::Units,
            (Some(Element::Units), "Metric" | "Imperial") => Element::Unit,
            (Some(Element::Root), "Surfaces") => Element::Surfaces,
            (Some(Element::Surfaces), "Surface") => Element::Surface,
            (Some(Element::Surface), "SourceData") => Element::Source,
            (Some(Element::Source), "Breaklines") => Element::Breaklines,
            (Some(Element::Breaklines), "Breakline") => Element::Breakline,
            (Some(Element::Breakline), "PntList3D") => Element::BreaklinePoints,
            (Some(Element::Surface), "Definition") => Element::Definition,
            (Some(Element::Definition), "Pnts") => Element::Points,
            (Some(Element::Points), "P") => Element::Point,
            (Some(Element::Definition), "Faces") => Element::Faces,
            (Some(Element::Faces), "F") => Element::Face,
            _ => Element::Other,
        }
    }

    /// Returns true if the text of the element is read.
    fn has_text(self) -> bool {
        matches!(
            self,
            Element::Point | Element::Face | Element::BreaklinePoints
        )
    }
}

/// A face, until all points are known.
struct Polygon {
    number: usize,
    corners: std::ops::Range<usize>,
}

struct Parser<'a> {
    /// The surface to read; `None` for the only one.
    wanted: Option<&'a str>,
    open: Vec<(Element, String)>,
    /// The names of the surfaces with triangles, in order.
    names: Vec<String>,
    /// The name of the current surface.
    current: String,
    /// Whether the current surface is the one that is read.
    is_read: bool,
    stated: Stated,
    text: String,
    /// The id of the current point.
    id: u64,
    is_hidden: bool,
    kind: EdgeKind,
    vertices: Vec<[f64; 3]>,
    ids: Ids,
    /// The ids of the corners of all faces.
    corners: Vec<u64>,
    polygons: Vec<Polygon>,
    face_count: usize,
    lines: Vec<(EdgeKind, Vec<[f64; 3]>)>,
    warnings: Vec<Wording>,
}

impl<'a> Parser<'a> {
    fn new(wanted: Option<&'a str>) -> Self {
        Parser {
            wanted,
            open: Vec::new(),
            names: Vec::new(),
            current: String::new(),
            is_read: false,
            stated: Stated::default(),
            text: String::new(),
            id: 0,
            is_hidden: false,
            kind: EdgeKind::Breakline,
            vertices: Vec::new(),
            ids: Ids::default(),
            corners: Vec::new(),
            polygons: Vec::new(),
            face_count: 0,
            lines: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn start(&mut self, start: &BytesStart) -> Result<()> {
        let name = start.local_name();
        let name = name.as_ref();
        let parent = self.open.last().map(|(element, _)| *element);
        let element = Element::within(parent, name);
        // Names are kept for messages only, and for few elements.
        let kept = match element {
            Element::Point | Element::Face => String::new(),
            _ => name.chars().take(40).collect(),
        };
        self.open.push((element, kept));
        let value = |name: &str| value_of(start, name);
        match element {
            Element::Root if name != "LandXML" => {
                return Err(Error::unsupported(format!(
                    "the file begins with the element '{}', expected 'LandXML'",
                    shown(name.as_bytes())
                ))
                .cure("write it as LandXML 1.2"));
            }
            Element::Unit => {
                let unit = |name: Option<String>| {
                    name.map(|name| {
                        unit_of(&name).ok_or_else(|| {
                            Error::unsupported(format!(
                                "'{}' is not a unit of length",
                                shown(name.as_bytes())
                            ))
                            .cure("use meter, foot or USSurveyFoot")
                        })
                    })
                    .transpose()
                };
                self.stated.linear = unit(value("linearUnit")?)?;
                self.stated.elevation = unit(value("elevationUnit")?)?;
            }
            Element::Other if parent == Some(Element::Root) && name == "CoordinateSystem" => {
                self.stated.epsg = value("epsgCode")?;
                self.stated.wkt = value("ogcWktCode")?;
                let names = [value("name")?, value("desc")?];
                self.stated.name = names.into_iter().flatten().find(|name| !name.is_empty());
            }
            Element::Surface => {
                self.current = value("name")?.unwrap_or_default();
                self.is_read = match self.wanted {
                    Some(wanted) => wanted == self.current,
                    None => self.names.is_empty(),
                };
            }
            Element::Breakline => {
                let [name, kind] = ["name", "brkType"].map(value);
                let (name, kind) = (name?.unwrap_or_default(), kind?.unwrap_or_default());
                self.kind = kind_of(&name, &kind);
            }
            Element::Definition => self.definition(value("surfType")?)?,
            Element::Point if self.is_read => {
                let id = value("id")?;
                let parsed = id.as_ref().and_then(|id| id.trim().parse().ok());
                self.id = parsed.ok_or_else(|| {
                    let id = id.as_deref().unwrap_or_default();
                    let shown = shown(id.as_bytes());
                    Error::format(format!("'{shown}' is not the id of a point"))
                        .cure("write the file again: an id is a positive whole number")
                })?;
            }
            Element::Face => self.is_hidden = value("i")?.is_some_and(|i| i.trim() == "1"),
            _ => (),
        }
        Ok(())
    }

    /// Begins the triangles of a surface.
    fn definition(&mut self, kind: Option<String>) -> Result<()> {
        let (name, is_read) = (&self.current, self.is_read);
        self.names.push(name.clone());
        match kind.as_deref() {
            Some("grid") if is_read => Err(Error::unsupported(format!(
                "the surface '{}' is a grid, expected a TIN",
                shown(name.as_bytes())
            ))
            .cure("write it as a TIN")),
            _ if is_read && !self.vertices.is_empty() => Err(Error::format(format!(
                "two surfaces have the name '{}'",
                shown(name.as_bytes())
            ))
            .cure("give each surface a name of its own")),
            _ => Ok(()),
        }
    }

    fn text(&mut self, text: &str) -> Result<()> {
        let takes = self
            .open
            .last()
            .is_some_and(|(element, _)| element.has_text());
        if takes && self.is_read {
            self.text.push_str(text);
        }
        Ok(())
    }

    fn end(&mut self) -> Result<()> {
        let Some((element, _)) = self.open.pop() else {
            return Ok(());
        };
        if !element.has_text() || !self.is_read {
            return Ok(());
        }
        let text = std::mem::take(&mut self.text);
        match element {
            Element::Point => self.point(&text)?,
            Element::Face => self.face(&text)?,
            _ => self.line(&text)?,
        }
        // Its memory is used again.
        self.text = text;
        self.text.clear();
        Ok(())
    }

    fn point(&mut self, text: &str) -> Result<()> {
        let mut numbers = [0.0; 3];
        let mut words = text.split_ascii_whitespace();
        for (number, what) in numbers.iter_mut().zip(["northing", "easting", "height"]) {
            *number = finite(words.next(), what)?;
        }
        if let Some(more) = words.next() {
            return Err(surplus(more, "the height of a point"));
        }
        let [north, east, z] = numbers;
        let number = u32::try_from(self.vertices.len())
            .map_err(|_| Error::limit(format!("more than {} points", u32::MAX)))?;
        if !self.ids.add(self.id, number) {
            return Err(Error::format(format!("two points have the id {}", self.id))
                .cure("write the file again: an id names one point"));
        }
        self.vertices.push([east, north, z]);
        Ok(())
    }

    fn face(&mut self, text: &str) -> Result<()> {
        let number = self.face_count;
        self.face_count += 1;
        let first = self.corners.len();
        for word in text.split_ascii_whitespace() {
            self.corners.push(word.parse().map_err(|_| {
                let shown = shown(word.as_bytes());
                Error::format(format!("'{shown}' is not the id of a point"))
            })?);
        }
        let corners = first..self.corners.len();
        if corners.len() < 3 {
            let count = corners.len();
            return Err(Error::format(format!(
                "a face has {count} corners, expected 3 or more"
            )));
        }
        if self.is_hidden {
            self.corners.truncate(first);
            return Ok(());
        }
        self.polygons.push(Polygon { number, corners });
        Ok(())
    }

    fn line(&mut self, text: &str) -> Result<()> {
        let mut points = Vec::new();
        let mut words = text.split_ascii_whitespace().peekable();
        while words.peek().is_some() {
            let mut number = |what| finite(words.next(), what);
            let [north, east, z] = [number("northing")?, number("easting")?, number("height")?];
            points.push([east, north, z]);
        }
        self.lines.push((self.kind, points));
        Ok(())
    }

    /// Ends the file.
    fn finish(&mut self) -> Result<()> {
        match self.open.last() {
            Some((_, name)) => {
                let name = match name.as_str() {
                    "" => "P or F",
                    name => name,
                };
                Err(
                    Error::format(format!("the file ends within the element '{name}'"))
                        .cure("get the whole file"),
                )
            }
            None => self.require_one(),
        }
    }

    /// Returns an error unless one surface was chosen.
    fn require_one(&self) -> Result<()> {
        let list = || {
            let names = self.names.iter().map(|name| shown(name.as_bytes()));
            let names: Vec<String> = names.collect();
            names.join(", ")
        };
        let error = match (self.wanted, self.names.len()) {
            (_, 0) => Error::format("there is no surface of triangles")
                .cure("export the surface with its triangles"),
            (None, 1) => return Ok(()),
            (None, count) => Error::usage(format!("the file has {count} surfaces: {}", list()))
                .cure("name one after the file, as in FILE:NAME"),
            (Some(wanted), _) if self.names.iter().any(|name| name == wanted) => return Ok(()),
            (Some(wanted), _) => Error::usage(format!("there is no surface '{wanted}'"))
                .cure(format!("name one of {}", list())),
        };
        Err(error.at("Surfaces"))
    }

    fn triangles(mut self) -> Result<Triangles> {
        let mut faces = Vec::with_capacity(self.polygons.len());
        let mut numbers = Vec::new();
        for polygon in &self.polygons {
            let at_face = |e: Error| e.at(format!("face {}", polygon.number));
            numbers.clear();
            for &id in &self.corners[polygon.corners.clone()] {
                let number = self
                    .ids
                    .number(id)
                    .ok_or_else(|| at_face(Error::format(format!("no point has the id {id}"))))?;
                numbers.push(number);
            }
            polygon::add_polygon(&self.vertices, &numbers, &mut faces).map_err(at_face)?;
        }
        let (lines, lost) = edges_on_lines(&self.lines, &self.vertices, &faces);
        if lost > 0 {
            self.warnings.push(
                format!("{lost} segments of breaklines are not edges of the surface: they have no effect")
                    .into(),
            );
        }
        let (crs, warning) = self.stated.system().map_err(|e| e.at("CoordinateSystem"))?;
        self.warnings.extend(warning);
        Ok(Triangles {
            vertices: self.vertices,
            faces,
            lines,
            crs,
            warnings: self.warnings,
            ..Triangles::default()
        })
    }
}

/// Returns the edges of faces that lines pass, with the kinds of the lines, and the number of
/// segments that are not edges. Of several lines along an edge, the kind with the lowest rank
/// counts.
fn edges_on_lines(
    lines: &[(EdgeKind, Vec<[f64; 3]>)],
    vertices: &[[f64; 3]],
    faces: &[[u32; 3]],
) -> (Vec<([u32; 2], EdgeKind)>, usize) {
    if lines.is_empty() {
        return (Vec::new(), 0);
    }
    let key = |p: &[f64; 3]| [p[0], p[1]].map(|c| (c + 0.0).to_bits());
    let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
    let on_lines: HashSet<[u64; 2]> = lines.iter().flat_map(|(_, line)| line).map(key).collect();
    let mut at: HashMap<[u64; 2], u32> = HashMap::new();
    for (number, vertex) in (0..).zip(vertices) {
        if on_lines.contains(&key(vertex)) {
            at.entry(key(vertex)).or_insert(number);
        }
    }
    let ends: HashSet<u32> = at.values().copied().collect();
    let mut edges: HashSet<[u32; 2]> = HashSet::new();
    for &[a, b, c] in faces {
        let sides = [(a, b), (b, c), (c, a)].into_iter();
        let near = sides.filter(|(a, b)| ends.contains(a) && ends.contains(b));
        edges.extend(near.map(|(a, b)| edge(a, b)));
    }
    let mut found = Vec::new();
    let mut lost = 0;
    for (kind, line) in lines {
        for pair in line.windows(2) {
            let ends = [&pair[0], &pair[1]].map(|p| at.get(&key(p)).copied());
            match ends {
                [Some(a), Some(b)] if edges.contains(&edge(a, b)) => {
                    found.push((edge(a, b), *kind));
                }
                _ => lost += 1,
            }
        }
    }
    // An edge that is listed with several kinds has the last.
    found.sort_unstable_by_key(|(ends, kind)| (*ends, std::cmp::Reverse(kind.rank())));
    found.dedup();
    (found, lost)
}

fn finite(word: Option<&str>, what: &str) -> Result<f64> {
    let word = word.ok_or_else(|| Error::format(format!("a point without {what}")))?;
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(Error::format(format!(
            "the {what} is '{}', expected a finite number",
            shown(word.as_bytes())
        ))),
    }
}

fn surplus(word: &str, last: &str) -> Error {
    let word = shown(word.as_bytes());
    Error::format(format!("'{word}' follows {last}"))
        .cure("a point is 'northing easting height', with decimal points")
}

/// Returns the value of an attribute, if it is there.
fn value_of(start: &BytesStart, name: &str) -> Result<Option<String>> {
    for attribute in start.attributes() {
        let broken = |error: &dyn std::fmt::Display| {
            Error::format(format!("not XML: {error}")).cure("write the file again")
        };
        let attribute: Attribute = attribute.map_err(|error| broken(&error))?;
        if attribute.key.local_name().as_ref() == name {
            let value = attribute
                .normalized_value(quick_xml::XmlVersion::Implicit1_0)
                .map_err(|error| broken(&error))?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}
