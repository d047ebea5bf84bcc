//! Lines and areas of all kinds: what can be asked for, and how layers become lines of a TIN.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::context::Journal;
use super::crossings::LineNames;
use super::input::Input;
use super::layers::{self, Layers};
use super::lines::{self, Drawn};
use super::notice::Notice;
use super::systems::{Role, Stated};
use super::transforms::Transforms;
use super::units::Units;
use crate::data::{Bounds, EdgeKind, Layer, Shape};
use crate::error::{Error, Result};
use crate::terrain::{Flat, FlatHeight, HighSide, Inside, River, RiverHeights, Tin, TinBuilder, Wall, densified};
use crate::triangulation::LineId;

/// The default distance between the upper and the lower edge of a wall.
const WALL_WIDTH_METRES: f64 = 0.01;

/// Lines and areas besides breaklines and the boundary. Where kinds meet, the first of these
/// counts: holes, flats, rivers, walls, breaklines, soft lines.
#[derive(Debug, Clone, Default)]
pub struct LineRequest {
    /// Lines with heights whose edges are in the surface, but that smooth methods of interpolation
    /// pass over.
    pub soft: Vec<Input<Layer>>,
    /// Lines that get their heights from the finished surface.
    pub draped: Vec<Input<Layer>>,
    /// The upper edges of walls, with heights. A record with two parts is one wall: its upper and
    /// its lower edge, where they are drawn.
    pub walls: Vec<Input<Layer>>,
    /// Options of walls.
    pub wall: WallOptions,
    /// Areas without data: they are left out of the finished surface.
    pub holes: Vec<Input<Layer>>,
    /// Level water: polygons, or lines that close, each with one height.
    pub flats: Vec<Input<Layer>>,
    /// Options of level water.
    pub flat: FlatOptions,
    /// Rivers: a record with two parts is one river between two banks; otherwise each record is a
    /// bank, and two consecutive ones are one river.
    pub rivers: Vec<Input<Layer>>,
    /// The width of rivers: if it is given, each line runs along the middle of one.
    pub river_width: Option<PerRecord>,
    /// The largest distance in plan between vertices of breaklines and soft lines; more are added.
    pub densify: Option<f64>,
}

/// A number for all records, or the attribute that has one for each.
#[derive(Debug, Clone, PartialEq)]
pub enum PerRecord {
    /// This number.
    Number(f64),
    /// The numbers of this attribute.
    Field(String),
}

/// How the lower edge of a wall follows from the upper one, and where it lies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallOptions {
    /// The heights of the lower edge; `None` if each record has both edges.
    pub lower: Option<LowerEdge>,
    /// The distance between the edges in plan, in units of the coordinate system. `None` is 0.01
    /// metres.
    pub width: Option<f64>,
    /// The side of the line on which the ground is higher.
    pub high: HighSide,
}

/// The height of the lower edge of a wall.
#[derive(Debug, Clone, PartialEq)]
pub enum LowerEdge {
    /// The height itself.
    Height(PerRecord),
    /// How far it is below the upper edge.
    Drop(PerRecord),
}

/// The height of level water, and which points it replaces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FlatOptions {
    /// The height.
    pub height: FlatRule,
    /// The largest difference between heights of a level shore. `None` is 0.01 metres, or 0.01
    /// units if the unit is not known.
    pub tolerance: Option<f64>,
    /// Points up to this distance outside of the shore are left out, too.
    pub buffer: f64,
}

/// Which height level water has.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum FlatRule {
    /// That of its shore, which must be level.
    #[default]
    OfShore,
    /// The lowest of its shore.
    Lowest,
    /// The mean of the vertices of its shore.
    Mean,
    /// A number, or that of an attribute.
    Given(PerRecord),
}

/// What lines of a layer are used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LineRole {
    /// Hard breaklines.
    Breaklines,
    /// Soft lines.
    Soft,
    /// Walls.
    Walls,
    /// Level water.
    Flats,
    /// Rivers.
    Rivers,
    /// Draped lines.
    Draped,
    /// Areas without data.
    Holes,
    /// The boundary.
    Boundary,
}

impl LineRole {
    /// Returns the option of the program that takes such lines.
    pub fn option(self) -> &'static str {
        match self {
            LineRole::Breaklines => "--breaklines",
            LineRole::Soft => "--soft-lines",
            LineRole::Walls => "--walls",
            LineRole::Flats => "--flat",
            LineRole::Rivers => "--rivers",
            LineRole::Draped => "--draped-lines",
            LineRole::Holes => "--holes",
            LineRole::Boundary => "--boundary",
        }
    }

    /// Returns the kind of edges that such lines become; `None` for areas to clip to.
    fn edges(self) -> Option<EdgeKind> {
        match self {
            LineRole::Breaklines => Some(EdgeKind::Breakline),
            LineRole::Soft => Some(EdgeKind::Soft),
            LineRole::Walls => Some(EdgeKind::Wall),
            LineRole::Flats => Some(EdgeKind::Shore),
            LineRole::Rivers => Some(EdgeKind::Bank),
            LineRole::Draped => Some(EdgeKind::Draped),
            LineRole::Holes | LineRole::Boundary => None,
        }
    }
}

/// How many lines of an input were used.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LineInput {
    /// What they were used as.
    pub role: LineRole,
    /// The file.
    pub path: PathBuf,
    /// The lines, walls, lakes, rivers or areas; each part of a line counts.
    pub lines: usize,
    /// The distinct edges that they became, before the surface was clipped. Draped lines and areas
    /// to clip to are counted with the edges of the surface only.
    pub edges: usize,
    /// The numbers of the lines of the TIN.
    numbers: Range<usize>,
}

/// The layers of a request, by what they are used as.
pub(super) struct LineLayers<'a> {
    request: &'a LineRequest,
    groups: Vec<(LineRole, Layers<'a>)>,
}

/// The lines that were added to a builder.
pub(super) struct Added {
    pub(super) names: LineNames,
    pub(super) inputs: Vec<LineInput>,
    /// The box around all lines with heights.
    pub(super) extent: Bounds,
    /// The closed lines of one height.
    pub(super) level_rings: Vec<LevelRing>,
    /// Rivers whose banks rise, or differ across.
    pub(super) uneven: Vec<(String, RiverHeights)>,
}

/// A closed line of one height, that may be a shore.
pub(super) struct LevelRing {
    pub(super) line: usize,
    pub(super) ring: Vec<[f64; 2]>,
    pub(super) height: f64,
}

impl LineRequest {
    /// Returns the inputs with what they are used as.
    pub(super) fn inputs(&self) -> [(LineRole, &[Input<Layer>]); 6] {
        [
            (LineRole::Soft, &self.soft),
            (LineRole::Walls, &self.walls),
            (LineRole::Flats, &self.flats),
            (LineRole::Rivers, &self.rivers),
            (LineRole::Draped, &self.draped),
            (LineRole::Holes, &self.holes),
        ]
    }

    /// Returns the attribute that is needed of each record.
    fn column(&self, role: LineRole) -> Option<&str> {
        let number = match role {
            LineRole::Walls => match self.wall.lower.as_ref()? {
                LowerEdge::Height(number) | LowerEdge::Drop(number) => number,
            },
            LineRole::Flats => match &self.flat.height {
                FlatRule::Given(number) => number,
                FlatRule::OfShore | FlatRule::Lowest | FlatRule::Mean => return None,
            },
            LineRole::Rivers => self.river_width.as_ref()?,
            _ => return None,
        };
        match number {
            PerRecord::Field(name) => Some(name),
            PerRecord::Number(_) => None,
        }
    }
}

impl PerRecord {
    /// Returns the number of a record, counted from 0; NaN if it has none.
    fn of(&self, layer: &Layer, fid: usize) -> f64 {
        match self {
            PerRecord::Number(number) => *number,
            PerRecord::Field(name) => {
                layer.column(name).and_then(|column| column.values.get(fid)).copied().unwrap_or(f64::NAN)
            }
        }
    }
}

impl<'a> LineLayers<'a> {
    /// Reads the layers of a request, in a fixed order of their roles.
    ///
    /// # Errors
    /// If one cannot be read or lacks an attribute, or the run is canceled.
    pub(super) fn read(
        request: &'a LineRequest,
        breaklines: &'a [Input<Layer>],
        boundary: &'a [Input<Layer>],
        journal: &Journal,
    ) -> Result<Self> {
        let all = [(LineRole::Breaklines, breaklines)].into_iter().chain(request.inputs());
        let mut groups = Vec::new();
        for (role, inputs) in all.chain([(LineRole::Boundary, boundary)]) {
            let columns: Vec<&str> = request.column(role).into_iter().collect();
            groups.push((role, layers::read(inputs, &columns, journal)?));
        }
        Ok(LineLayers { request, groups })
    }

    /// Returns the coordinate systems that the layers state, in order.
    pub(super) fn stated(&self) -> impl Iterator<Item = Option<Stated>> + '_ {
        self.groups
            .iter()
            .flat_map(|(_, layers)| layers)
            .map(|(path, layer)| Some(Stated { path: path.to_path_buf(), crs: layer.crs.clone(), role: Role::Lines }))
    }

    /// Returns true if there are lines or areas that points are not needed for.
    pub(super) fn has_lines_with_heights(&self) -> bool {
        let has = |role: &LineRole| !matches!(role, LineRole::Draped | LineRole::Holes | LineRole::Boundary);
        self.groups.iter().any(|(role, layers)| has(role) && !layers.is_empty())
    }

    /// Returns true if the surface is cut to a boundary.
    pub(super) fn has_boundary(&self) -> bool {
        self.groups.iter().any(|(role, layers)| *role == LineRole::Boundary && !layers.is_empty())
    }

    /// Adds all lines and areas to a builder, in the coordinate system of the result.
    ///
    /// # Errors
    /// If a record is not what its option takes; the error names file, record and cure.
    pub(super) fn add_to(
        &self,
        builder: &mut TinBuilder,
        by_file: &[Option<usize>],
        transforms: &Transforms,
        units: &Units,
    ) -> Result<Added> {
        let paths = self.groups.iter().flat_map(|(_, layers)| layers).map(|(path, _)| path.to_path_buf()).collect();
        let mut adding = Adding {
            request: self.request,
            builder,
            transforms,
            units,
            added: Added {
                names: LineNames::new(paths),
                inputs: Vec::new(),
                extent: Bounds::default(),
                level_rings: Vec::new(),
                uneven: Vec::new(),
            },
            file: 0,
            next: 0,
        };
        let mut by_file = by_file.iter();
        for (role, layers) in &self.groups {
            for (path, layer) in layers {
                let transform = by_file.next().copied().flatten();
                let first = adding.next;
                let lines = adding.add_layer(*role, layer, path, transform)?;
                let numbers = first..adding.next;
                let path = path.to_path_buf();
                adding.added.inputs.push(LineInput { role: *role, path, lines, edges: 0, numbers });
                adding.file += 1;
            }
        }
        Ok(adding.added)
    }
}

/// Lines on their way from layers to a builder.
struct Adding<'a> {
    request: &'a LineRequest,
    builder: &'a mut TinBuilder,
    transforms: &'a Transforms,
    units: &'a Units,
    added: Added,
    /// The position of the current layer among all.
    file: usize,
    /// The number of the next line of the builder.
    next: usize,
}

impl Adding<'_> {
    /// Adds the lines of a layer; returns their number.
    fn add_layer(&mut self, role: LineRole, layer: &Layer, path: &Path, transform: Option<usize>) -> Result<usize> {
        let in_layer = |line: &Drawn, error: Error| lines::at_record(error, path, line.fid + 1);
        match role {
            LineRole::Holes if layer.shapes.is_empty() => Ok(0),
            LineRole::Boundary | LineRole::Holes => {
                let polygons = layers::polygons(layer, path, role.option(), transform, self.transforms)?;
                for rings in &polygons {
                    if role == LineRole::Holes {
                        self.builder.add_hole(rings);
                    } else {
                        self.builder.add_boundary(rings);
                    }
                }
                Ok(polygons.len())
            }
            LineRole::Draped => {
                let mut drawn = lines::in_plan(layer, path, role.option())?;
                for line in &mut drawn {
                    line.points.iter_mut().for_each(|p| p[2] = 0.0);
                    self.transforms.apply(transform, &mut line.points).map_err(|e| e.in_file(path))?;
                    let sites: Vec<[f64; 2]> = line.points.iter().map(|p| [p[0], p[1]]).collect();
                    self.builder.add_draped_line(&sites);
                }
                Ok(drawn.len())
            }
            LineRole::Breaklines | LineRole::Soft => {
                let mut drawn = lines::with_heights(layer, path, role.option())?;
                for line in &mut drawn {
                    self.transform(line, path, transform)?;
                    let points = match self.request.densify {
                        Some(spacing) => &densified(&line.points, spacing),
                        None => &line.points,
                    };
                    if role == LineRole::Soft {
                        self.builder.add_soft_line(points);
                    } else {
                        self.builder.add_breakline(points);
                    }
                    self.note_level_ring(line);
                    self.name(line, self.next..self.next + 1);
                }
                Ok(drawn.len())
            }
            LineRole::Walls => {
                let walls = records(lines::with_heights(layer, path, role.option())?);
                for mut parts in walls.iter().cloned() {
                    for part in &mut parts {
                        self.transform(part, path, transform)?;
                    }
                    let wall = self.wall(&parts, layer).map_err(|error| in_layer(&parts[0], error))?;
                    for wall in &wall {
                        let numbers = self.builder.add_wall(wall);
                        self.name(&parts[0], numbers);
                    }
                }
                Ok(walls.len())
            }
            LineRole::Flats => self.add_flats(layer, path, transform),
            LineRole::Rivers => self.add_rivers(layer, path, transform),
        }
    }

    /// Transforms a line to the coordinate system of the result, and adds it to the extent.
    fn transform(&mut self, line: &mut Drawn, path: &Path, transform: Option<usize>) -> Result<()> {
        self.transforms.apply(transform, &mut line.points).map_err(|e| e.in_file(path))?;
        line.points.iter().for_each(|&vertex| self.added.extent.add(vertex));
        Ok(())
    }

    /// Names lines of the builder after a line of a layer.
    fn name(&mut self, line: &Drawn, numbers: Range<usize>) {
        self.next = numbers.end;
        numbers.for_each(|_| self.added.names.add(self.file, line));
    }

    fn note_level_ring(&mut self, line: &Drawn) {
        let (Some(first), Some(last)) = (line.points.first(), line.points.last()) else { return };
        let tolerance = self.flat_tolerance();
        if line.points.len() > 3
            && first[..2] == last[..2]
            && line.points.iter().all(|p| (p[2] - first[2]).abs() <= tolerance)
        {
            let ring = line.points.iter().map(|p| [p[0], p[1]]).collect();
            self.added.level_rings.push(LevelRing { line: self.next, ring, height: first[2] });
        }
    }

    fn flat_tolerance(&self) -> f64 {
        self.request.flat.tolerance.unwrap_or_else(|| self.units.height_of_metres(FLAT_TOLERANCE_METRES))
    }

    /// The walls of a record.
    fn wall(&self, parts: &[Drawn], layer: &Layer) -> Result<Vec<Wall>> {
        let WallOptions { lower, width, high } = &self.request.wall;
        let width = width.unwrap_or_else(|| self.units.of_metres(WALL_WIDTH_METRES));
        match lower {
            Some(edge) => parts
                .iter()
                .map(|part| {
                    let number = match edge {
                        LowerEdge::Height(number) | LowerEdge::Drop(number) => number.of(layer, part.fid),
                    };
                    if !number.is_finite() {
                        return Err(Error::format("the record has no height of the lower edge of the wall")
                            .cure("fill the attribute of --wall-bottom or --wall-drop, or remove the record"));
                    }
                    let low = part.points.iter().map(|p| match edge {
                        LowerEdge::Height(_) => number,
                        LowerEdge::Drop(_) => p[2] - number,
                    });
                    Wall::new(&part.points, &low.collect::<Vec<f64>>(), width, *high)
                })
                .collect(),
            None => match parts {
                [upper, lower] => Ok(vec![Wall::between(&upper.points, &lower.points)?]),
                _ => Err(Error::format("the lower edge of the wall is not known").cure(
                    "give its height with --wall-bottom or --wall-drop, or make each record of two parts: the upper \
                     and the lower edge",
                )),
            },
        }
    }

    fn add_flats(&mut self, layer: &Layer, path: &Path, transform: Option<usize>) -> Result<usize> {
        let needs_heights = !matches!(self.request.flat.height, FlatRule::Given(_));
        let drawn = match needs_heights {
            true => lines::with_heights(layer, path, LineRole::Flats.option())?,
            false => lines::in_plan(layer, path, LineRole::Flats.option())?,
        };
        let lakes = records(drawn);
        for mut rings in lakes.iter().cloned() {
            let first = rings[0].clone();
            let height = match &self.request.flat.height {
                FlatRule::OfShore => FlatHeight::OfShore { tolerance: self.flat_tolerance() },
                FlatRule::Lowest => FlatHeight::Lowest,
                FlatRule::Mean => FlatHeight::Mean,
                FlatRule::Given(number) => FlatHeight::Given(number.of(layer, first.fid)),
            };
            if !needs_heights {
                rings.iter_mut().flat_map(|ring| &mut ring.points).for_each(|p| p[2] = 0.0);
            }
            for ring in &mut rings {
                self.transform(ring, path, transform)?;
            }
            let rings: Vec<Vec<[f64; 3]>> = rings.into_iter().map(|ring| ring.points).collect();
            let flat = Flat::new(&rings, height).map_err(|e| lines::at_record(e, path, first.fid + 1))?;
            let numbers = self.builder.add_flat(flat.with_buffer(self.request.flat.buffer));
            self.name(&first, numbers);
        }
        Ok(lakes.len())
    }

    fn add_rivers(&mut self, layer: &Layer, path: &Path, transform: Option<usize>) -> Result<usize> {
        for (record, shape) in (1..).zip(&layer.shapes) {
            let error = match shape {
                Shape::Polygon(_) => Error::format("a polygon is not a bank")
                    .cure("divide its ring into the two banks of the river, or use --flat for level water"),
                Shape::Lines(parts) if parts.iter().any(|part| part.len() < 2) => {
                    Error::format("a part of the record has fewer than two vertices")
                        .cure("remove it, so that banks are paired as they are meant to be")
                }
                _ => continue,
            };
            return Err(lines::at_record(error, path, record));
        }
        let by_record = records(lines::with_heights(layer, path, LineRole::Rivers.option())?);
        let rivers = match &self.request.river_width {
            Some(_) => by_record.into_iter().flatten().map(|line| vec![line]).collect(),
            None => banks(by_record, path)?,
        };
        for mut parts in rivers.iter().cloned() {
            for part in &mut parts {
                self.transform(part, path, transform)?;
            }
            let river = match (&self.request.river_width, parts.as_slice()) {
                (Some(width), [middle, ..]) => River::along(&middle.points, width.of(layer, middle.fid)),
                (_, [left, right, ..]) => River::between(&left.points, &right.points),
                _ => continue, // banks come in pairs
            };
            let river = river.map_err(|e| lines::at_record(e, path, parts[0].fid + 1))?;
            let heights = river.heights();
            let numbers = self.builder.add_river(river);
            self.name(&parts[0], numbers.clone());
            if heights.largest_rise.max(heights.largest_difference) > self.flat_tolerance() {
                self.added.uneven.push((self.added.names.name(numbers.start), heights));
            }
        }
        Ok(rivers.len())
    }
}

/// The banks of each river, as pairs: the two parts of a record, or two consecutive records of one
/// part.
fn banks(by_record: Vec<Vec<Drawn>>, path: &Path) -> Result<Vec<Vec<Drawn>>> {
    let cure = "a river needs two banks: two parts of a record, or two records of one part each; or give --river-width";
    let mut pairs: Vec<Vec<Drawn>> = Vec::new();
    for parts in by_record {
        let record = parts[0].fid + 1;
        let is_open = pairs.last().is_some_and(|pair| pair.len() == 1);
        match (parts.len(), pairs.last_mut().filter(|_| is_open)) {
            (1, Some(open)) => open.extend(parts),
            (1 | 2, None) => pairs.push(parts),
            (count, _) => {
                let error = Error::format(format!("the record has {count} parts, expected 1 or 2 banks"));
                let error = if is_open {
                    Error::format("the record has two banks, but the record before has one without an opposite bank")
                } else {
                    error
                };
                return Err(lines::at_record(error.cure(cure), path, record));
            }
        }
    }
    match pairs.last() {
        Some(pair) if pair.len() == 1 => {
            Err(lines::at_record(Error::format("the bank has no opposite bank").cure(cure), path, pair[0].fid + 1))
        }
        _ => Ok(pairs),
    }
}

/// Adds a notice about rivers whose banks contradict water, with the worst of them.
pub(super) fn note_uneven(uneven: &[(String, RiverHeights)], units: &Units, journal: &Journal) {
    let worst = |(_, heights): &&(String, RiverHeights)| heights.largest_rise.max(heights.largest_difference);
    let Some((name, heights)) = uneven.iter().max_by(|p, q| worst(p).total_cmp(&worst(q))) else { return };
    journal.add(Notice::RiverHeights {
        rivers: uneven.len(),
        name: name.clone(),
        rising: heights.rising,
        largest_rise: units.height(heights.largest_rise),
        rise_at: heights.rise_at,
        largest_difference: units.height(heights.largest_difference),
        difference_at: heights.difference_at,
    });
}

/// The default tolerance of level shores.
const FLAT_TOLERANCE_METRES: f64 = 0.01;

/// The lines of each record.
fn records(drawn: Vec<Drawn>) -> Vec<Vec<Drawn>> {
    drawn.chunk_by(|p, q| p.fid == q.fid).map(<[Drawn]>::to_vec).collect()
}

/// Adds notices about closed lines of one height around points of other heights: they may be shores
/// that were meant to be level.
pub(super) fn note_level_rings(
    rings: &[LevelRing],
    points: &[[f64; 3]],
    names: &LineNames,
    tolerance: f64,
    units: &Units,
    journal: &Journal,
) {
    if rings.is_empty() {
        return;
    }
    let polygons: Vec<Vec<Vec<[f64; 2]>>> = rings.iter().map(|ring| vec![ring.ring.clone()]).collect();
    let inside = Inside::new(&polygons);
    // For each ring, the number of points inside that differ, and the largest difference.
    let mut found = vec![(0_usize, 0.0_f64); rings.len()];
    for [x, y, z] in points {
        let Some(at) = inside.first_around([*x, *y]) else { continue };
        let difference = (z - rings[at].height).abs();
        if difference > tolerance {
            found[at] = (found[at].0 + 1, found[at].1.max(difference));
        }
    }
    let most = found.iter().enumerate().filter(|(_, (count, _))| *count > 0).max_by(|p, q| p.1.1.total_cmp(&q.1.1));
    if let Some((at, (_, largest))) = most {
        journal.add(Notice::LevelRings {
            rings: found.iter().filter(|(count, _)| *count > 0).count(),
            points: found.iter().map(|(count, _)| count).sum(),
            name: names.name(rings[at].line),
            largest: units.height(*largest),
        });
    }
}

/// Counts the distinct edges of the lines of each input.
pub(super) fn count_edges(inputs: &mut [LineInput], tin: &Tin) {
    let triangulation = tin.triangulation();
    for input in inputs.iter_mut().filter(|input| input.role.edges().is_some()) {
        let mut edges: Vec<[u32; 2]> = Vec::new();
        // Level lines across rivers are not banks.
        for line in input.numbers.clone().filter(|&line| tin.line_kind(line) == input.role.edges()) {
            let chain = triangulation.chain(LineId::new(line));
            edges.extend(chain.windows(2).map(|pair| {
                let [a, b] = [pair[0], pair[1]].map(|vertex| vertex.index() as u32);
                [a.min(b), a.max(b)]
            }));
        }
        edges.sort_unstable();
        edges.dedup();
        input.edges = edges.len();
    }
}
