//! Lines and areas of all kinds: what can be asked for, and how layers become lines of a TIN.

use std::ops::Range;
use std::path::Path;

use super::crossings::LineNames;
use super::layers::{self, Layers};
use super::notes::{LevelRing, LineInput};
use super::shapes::{self, Drawn};
use crate::data::{Layer, Shape};
use crate::error::{Error, Result, Setting, wording};
use crate::io::OnDamage;
use crate::run::context::Journal;
use crate::run::context::notice::LoweredRiver;
use crate::run::context::units::Units;
use crate::run::request::input::Input;
use crate::run::request::lines::{
    FlatRule, LineRequest, LineRole, LowerEdge, PerRecord, WallOptions,
};
use crate::run::sources::extents::LineExtents;
use crate::run::sources::systems::Stated;
use crate::run::sources::transforms::Transforms;
use crate::terrain::{
    Flat, FlatHeight, River, RiverHeights, RiverLowering, TinBuilder, Wall, densified,
};

/// The default distance between the upper and the lower edge of a wall. Steps between waters are as
/// wide.
pub(crate) const WALL_WIDTH_METRES: f64 = 0.01;

/// The layers of a request, by what they are used as.
pub(crate) struct LineLayers<'a> {
    request: &'a LineRequest,
    groups: Vec<(LineRole, Layers<'a>)>,
}

/// The lines that were added to a builder.
pub(crate) struct Added {
    pub(crate) names: LineNames,
    pub(crate) inputs: Vec<LineInput>,
    pub(crate) extents: LineExtents,
    /// The closed lines of one height.
    pub(crate) level_rings: Vec<LevelRing>,
    /// Lakes whose shores differ in height: their names, their heights and the differences.
    pub(crate) uneven_shores: Vec<(String, f64, f64)>,
    /// Rivers whose banks rise, or differ across.
    pub(crate) uneven: Vec<(String, RiverHeights)>,
    /// Rivers that are lowered to others.
    pub(crate) lowered: Vec<LoweredRiver>,
    /// Rivers that overlap themselves, and where.
    pub(crate) overlaps: Vec<(String, [f64; 2])>,
}

impl<'a> LineLayers<'a> {
    /// Reads the layers of a request, in a fixed order of their roles.
    ///
    /// # Errors
    /// If one cannot be read or lacks an attribute, or the run is canceled.
    pub(crate) fn read(
        request: &'a LineRequest,
        breaklines: &'a [Input<Layer>],
        boundary: &'a [Input<Layer>],
        cut: OnDamage,
        journal: &Journal,
    ) -> Result<Self> {
        let all = [(LineRole::Breaklines, breaklines)]
            .into_iter()
            .chain(request.inputs());
        let mut groups = Vec::new();
        for (role, inputs) in all.chain([(LineRole::Boundary, boundary)]) {
            let columns: Vec<&str> = request.column(role).into_iter().collect();
            groups.push((role, layers::read(inputs, &columns, cut, journal)?));
        }
        Ok(LineLayers { request, groups })
    }

    /// Returns the coordinate systems that the layers state, in order.
    pub(crate) fn stated(&self) -> impl Iterator<Item = Option<Stated>> + '_ {
        self.groups
            .iter()
            .flat_map(|(_, layers)| layers)
            .map(|(path, layer)| Some(Stated::by_layer(path, layer)))
    }

    /// Returns true if there are lines or areas that points are not needed for.
    pub(crate) fn has_lines_with_heights(&self) -> bool {
        let has = |role: &LineRole| {
            !matches!(
                role,
                LineRole::Draped | LineRole::Holes | LineRole::Boundary
            )
        };
        self.groups
            .iter()
            .any(|(role, layers)| has(role) && !layers.is_empty())
    }

    /// Returns true if the surface is cut to a boundary.
    pub(crate) fn has_boundary(&self) -> bool {
        self.groups
            .iter()
            .any(|(role, layers)| *role == LineRole::Boundary && !layers.is_empty())
    }

    /// Adds all lines and areas to a builder, in the coordinate system of the result.
    ///
    /// # Errors
    /// If a record is not what its option takes; the error names file, record and cure.
    pub(crate) fn add_to(
        &self,
        builder: &mut TinBuilder,
        by_file: &[Option<usize>],
        transforms: &Transforms,
        units: &Units,
    ) -> Result<Added> {
        let paths = self
            .groups
            .iter()
            .flat_map(|(_, layers)| layers)
            .map(|(path, _)| path.to_path_buf())
            .collect();
        let mut adding = Adding {
            request: self.request,
            builder,
            transforms,
            units,
            added: Added {
                names: LineNames::new(paths),
                inputs: Vec::new(),
                extents: LineExtents::default(),
                level_rings: Vec::new(),
                uneven_shores: Vec::new(),
                uneven: Vec::new(),
                lowered: Vec::new(),
                overlaps: Vec::new(),
            },
            rivers: Vec::new(),
            lowerings: Vec::new(),
            role: LineRole::Breaklines,
            file: 0,
            next: 0,
        };
        let mut by_file = by_file.iter();
        for (role, layers) in &self.groups {
            adding.role = *role;
            let by_layer: Vec<Option<usize>> =
                by_file.by_ref().take(layers.len()).copied().collect();
            // Lines that depend on those of other layers.
            let mut joined = match role {
                LineRole::Rivers => Joined::Rivers(adding.rivers(layers, &by_layer)?.into_iter()),
                LineRole::Walls => Joined::Walls(adding.walls(layers, &by_layer)?.into_iter()),
                _ => Joined::Nothing,
            };
            for ((path, layer), transform) in layers.iter().zip(by_layer) {
                let first = adding.next;
                let lines = match &mut joined {
                    Joined::Rivers(by_layer) => {
                        adding.add_rivers(by_layer.next().unwrap_or_default())
                    }
                    Joined::Walls(by_layer) => {
                        adding.add_walls(by_layer.next().unwrap_or_default())
                    }
                    Joined::Nothing => adding.add_layer(*role, layer, path, transform)?,
                };
                let numbers = first..adding.next;
                let path = path.to_path_buf();
                adding.added.inputs.push(LineInput {
                    role: *role,
                    path,
                    lines,
                    edges: 0,
                    numbers,
                });
                adding.file += 1;
            }
        }
        adding.name_lowered();
        Ok(adding.added)
    }
}

/// Lines that depend on those of other layers, by layer.
enum Joined {
    Walls(std::vec::IntoIter<Vec<(Drawn, Wall)>>),
    Rivers(std::vec::IntoIter<Vec<(Drawn, River)>>),
    Nothing,
}

/// Lines on their way from layers to a builder.
struct Adding<'a> {
    request: &'a LineRequest,
    builder: &'a mut TinBuilder,
    transforms: &'a Transforms,
    units: &'a Units,
    added: Added,
    /// The number of the first line of each river.
    rivers: Vec<usize>,
    lowerings: Vec<RiverLowering>,
    /// What the lines of the current layer are used as.
    role: LineRole,
    /// The position of the current layer among all.
    file: usize,
    /// The number of the next line of the builder.
    next: usize,
}

impl Adding<'_> {
    /// Adds the lines of a layer; returns their number.
    fn add_layer(
        &mut self,
        role: LineRole,
        layer: &Layer,
        path: &Path,
        transform: Option<usize>,
    ) -> Result<usize> {
        match role {
            LineRole::Holes if layer.shapes.is_empty() => Ok(0),
            LineRole::Boundary | LineRole::Holes => {
                let polygons =
                    layers::polygons(layer, path, role.setting(), transform, self.transforms)?;
                for polygon in &polygons {
                    if role == LineRole::Holes {
                        self.builder.add_hole(&polygon.rings);
                    } else {
                        self.builder.add_boundary(&polygon.rings);
                    }
                }
                Ok(polygons.len())
            }
            LineRole::Draped => {
                let mut drawn = shapes::in_plan(layer, path, role.setting())?;
                for line in &mut drawn {
                    line.points.iter_mut().for_each(|p| p[2] = 0.0);
                    self.transforms
                        .apply(transform, &mut line.points)
                        .map_err(|e| e.in_file(path))?;
                    let sites: Vec<[f64; 2]> = line.points.iter().map(|p| [p[0], p[1]]).collect();
                    self.builder.add_draped_line(&sites);
                }
                Ok(drawn.len())
            }
            LineRole::Breaklines | LineRole::Soft => {
                let mut drawn = shapes::with_heights(layer, path, role.setting())?;
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
                    self.added.level_rings.extend(LevelRing::of(
                        &line.points,
                        self.next,
                        self.flat_tolerance(),
                    ));
                    self.name(line, self.next..self.next + 1);
                }
                Ok(drawn.len())
            }
            LineRole::Flats => self.add_flats(layer, path, transform),
            LineRole::Walls | LineRole::Rivers => Ok(0), // joined with those of other layers
        }
    }

    /// Transforms a line to the coordinate system of the result, and adds it to the extent.
    fn transform(&mut self, line: &mut Drawn, path: &Path, transform: Option<usize>) -> Result<()> {
        self.transforms
            .apply(transform, &mut line.points)
            .map_err(|e| e.in_file(path))?;
        let extent = match self.role {
            LineRole::Flats | LineRole::Rivers => &mut self.added.extents.waters,
            _ => &mut self.added.extents.with_heights,
        };
        line.points.iter().for_each(|&vertex| extent.add(vertex));
        Ok(())
    }

    /// Names lines of the builder after a line of a layer.
    fn name(&mut self, line: &Drawn, numbers: Range<usize>) {
        self.next = numbers.end;
        numbers.for_each(|_| self.added.names.add(self.file, line));
    }

    fn flat_tolerance(&self) -> f64 {
        self.request
            .flat
            .tolerance
            .unwrap_or_else(|| self.units.height_of_metres(FLAT_TOLERANCE_METRES))
    }

    /// The largest difference of heights of a shore whose lowest is the height of the lake.
    fn shore_tolerance(&self) -> f64 {
        self.request
            .flat
            .tolerance
            .unwrap_or_else(|| self.units.height_of_metres(SHORE_TOLERANCE_METRES))
    }

    /// The walls of all layers, by layer: where one ends, others may go on.
    fn walls(
        &mut self,
        layers: &Layers,
        by_layer: &[Option<usize>],
    ) -> Result<Vec<Vec<(Drawn, Wall)>>> {
        match &self.request.wall.lower {
            Some(edge) => self.walls_above(edge, layers, by_layer),
            None => {
                let layers = layers.iter().zip(by_layer);
                layers
                    .map(|((path, layer), transform)| self.walls_between(layer, path, *transform))
                    .collect()
            }
        }
    }

    /// Walls of which the upper edges are drawn.
    fn walls_above(
        &mut self,
        edge: &LowerEdge,
        layers: &Layers,
        by_layer: &[Option<usize>],
    ) -> Result<Vec<Vec<(Drawn, Wall)>>> {
        let WallOptions { width, high, .. } = self.request.wall;
        let width = width.unwrap_or_else(|| self.units.of_metres(WALL_WIDTH_METRES));
        let mut edges: Vec<(usize, Drawn, Vec<f64>)> = Vec::new();
        for (number, ((path, layer), transform)) in layers.iter().zip(by_layer).enumerate() {
            for mut line in shapes::with_heights(layer, path, Setting::Walls)? {
                let lower = self.lower_edge(&mut line, edge, layer, path, *transform)?;
                edges.push((number, line, lower));
            }
        }
        let uppers: Vec<&[[f64; 3]]> = edges
            .iter()
            .map(|(_, line, _)| line.points.as_slice())
            .collect();
        let neighbors = Wall::neighbors(&uppers, high);
        let mut walls: Vec<Vec<(Drawn, Wall)>> = layers.iter().map(|_| Vec::new()).collect();
        for ((number, line, lower), neighbors) in edges.into_iter().zip(neighbors) {
            let wall = Wall::continued(&line.points, &lower, width, high, neighbors);
            let wall =
                wall.map_err(|error| shapes::at_record(error, layers[number].0, line.record))?;
            walls[number].push((line, wall));
        }
        Ok(walls)
    }

    /// Walls of which both edges are drawn.
    fn walls_between(
        &mut self,
        layer: &Layer,
        path: &Path,
        transform: Option<usize>,
    ) -> Result<Vec<(Drawn, Wall)>> {
        let mut walls: Vec<(Drawn, Wall)> = Vec::new();
        for mut parts in records(shapes::with_heights(layer, path, Setting::Walls)?) {
            for part in &mut parts {
                self.transform(part, path, transform)?;
            }
            let wall = match parts.as_slice() {
                [upper, lower] => Wall::between(&upper.points, &lower.points),
                _ => Err(
                    Error::format("the lower edge of the wall is not known").cure(wording![
                        "give its height with ",
                        Setting::WallBottom,
                        " or ",
                        Setting::WallDrop,
                        ", or make each record of two parts: the upper and the lower edge"
                    ]),
                ),
            };
            let line = parts.swap_remove(0);
            let wall = wall.map_err(|error| shapes::at_record(error, path, line.record))?;
            walls.push((line, wall));
        }
        Ok(walls)
    }

    fn add_walls(&mut self, walls: Vec<(Drawn, Wall)>) -> usize {
        for (line, wall) in &walls {
            let numbers = self.builder.add_wall(wall);
            self.name(line, numbers);
        }
        walls.len()
    }

    /// Transforms the upper edge of a wall to the coordinate system of the result; returns the
    /// heights of the lower edge. Attributes are in the units of the layer, numbers in those of the
    /// result.
    fn lower_edge(
        &mut self,
        line: &mut Drawn,
        edge: &LowerEdge,
        layer: &Layer,
        path: &Path,
        transform: Option<usize>,
    ) -> Result<Vec<f64>> {
        let (LowerEdge::Height(of_record) | LowerEdge::Drop(of_record)) = edge;
        let number = of_record.of(layer, line.at);
        if !number.is_finite() {
            let error = Error::format("the record has no height of the lower edge of the wall")
                .cure(wording![
                    "fill the attribute of ",
                    Setting::WallBottom,
                    " or ",
                    Setting::WallDrop,
                    ", or remove the record"
                ]);
            return Err(shapes::at_record(error, path, line.record));
        }
        let below = |upper: &[[f64; 3]]| -> Vec<[f64; 3]> {
            let low = |p: &[f64; 3]| match edge {
                LowerEdge::Height(_) => number,
                LowerEdge::Drop(_) => p[2] - number,
            };
            upper.iter().map(|p| [p[0], p[1], low(p)]).collect()
        };
        let mut lower = match of_record {
            PerRecord::Field(_) => below(&line.points),
            PerRecord::Number(_) => Vec::new(),
        };
        self.transforms
            .apply(transform, &mut lower)
            .map_err(|e| e.in_file(path))?;
        self.transform(line, path, transform)?;
        if lower.is_empty() {
            lower = below(&line.points);
        }
        Ok(lower.iter().map(|p| p[2]).collect())
    }

    fn add_flats(&mut self, layer: &Layer, path: &Path, transform: Option<usize>) -> Result<usize> {
        let needs_heights = !matches!(self.request.flat.height, FlatRule::Given(_));
        let drawn = match needs_heights {
            true => shapes::with_heights(layer, path, Setting::Flat)?,
            false => shapes::in_plan(layer, path, Setting::Flat)?,
        };
        let lakes = records(drawn);
        for mut rings in lakes.iter().cloned() {
            let first = rings[0].clone();
            let height = match &self.request.flat.height {
                FlatRule::OfShore => FlatHeight::OfShore {
                    tolerance: self.shore_tolerance(),
                },
                FlatRule::Lowest => FlatHeight::Lowest,
                FlatRule::Mean => FlatHeight::Mean,
                FlatRule::Given(number) => {
                    FlatHeight::Given(self.water_level(number, layer, &first, path, transform)?)
                }
            };
            if !needs_heights {
                rings
                    .iter_mut()
                    .flat_map(|ring| &mut ring.points)
                    .for_each(|p| p[2] = 0.0);
            }
            for ring in &mut rings {
                self.transform(ring, path, transform)?;
            }
            let rings: Vec<Vec<[f64; 3]>> = rings.into_iter().map(|ring| ring.points).collect();
            let flat =
                Flat::new(&rings, height).map_err(|e| shapes::at_record(e, path, first.record))?;
            let (height, spread) = (flat.height(), flat.spread());
            let numbers = self
                .builder
                .add_flat(flat.with_buffer(self.request.flat.buffer));
            let line = numbers.start;
            self.name(&first, numbers);
            let is_chosen = self.request.flat.height == FlatRule::OfShore;
            if is_chosen && spread > self.flat_tolerance() {
                let name = self.added.names.name(line);
                self.added.uneven_shores.push((name, height, spread));
            }
        }
        Ok(lakes.len())
    }

    /// The given height of a lake, in the units of the result: attributes are in those of the
    /// layer.
    fn water_level(
        &self,
        number: &PerRecord,
        layer: &Layer,
        ring: &Drawn,
        path: &Path,
        transform: Option<usize>,
    ) -> Result<f64> {
        let height = number.of(layer, ring.at);
        match (number, ring.points.first()) {
            (PerRecord::Field(_), Some(&[x, y, _])) if height.is_finite() => {
                let mut on_shore = [[x, y, height]];
                self.transforms
                    .apply(transform, &mut on_shore)
                    .map_err(|e| e.in_file(path))?;
                Ok(on_shore[0][2])
            }
            _ => Ok(height),
        }
    }

    /// The rivers of all layers, by layer: where one ends, another may go on.
    fn rivers(
        &mut self,
        layers: &Layers,
        by_layer: &[Option<usize>],
    ) -> Result<Vec<Vec<(Drawn, River)>>> {
        let mut lines: Vec<(usize, Drawn)> = Vec::new();
        let mut rivers: Vec<River> = Vec::new();
        for (number, ((path, layer), transform)) in layers.iter().zip(by_layer).enumerate() {
            for (line, river) in self.rivers_of(layer, path, *transform)? {
                lines.push((number, line));
                rivers.push(river);
            }
        }
        self.lowerings = River::join(&mut rivers, self.units.of_metres(WALL_WIDTH_METRES));
        let mut by_number: Vec<Vec<(Drawn, River)>> = layers.iter().map(|_| Vec::new()).collect();
        for ((number, line), river) in lines.into_iter().zip(rivers) {
            by_number[number].push((line, river));
        }
        Ok(by_number)
    }

    fn add_rivers(&mut self, rivers: Vec<(Drawn, River)>) -> usize {
        let count = rivers.len();
        for (line, river) in rivers {
            let heights = river.heights();
            let overlap = river.overlap();
            let numbers = self.builder.add_river(river);
            let name = |adding: &Self| adding.added.names.name(numbers.start);
            self.name(&line, numbers.clone());
            self.rivers.push(numbers.start);
            if heights.largest_rise.max(heights.largest_difference) > self.flat_tolerance() {
                self.added.uneven.push((name(self), heights));
            }
            if let Some(at) = overlap {
                self.added.overlaps.push((name(self), at));
            }
        }
        count
    }

    /// Names the rivers that were lowered, and those that they were lowered to.
    fn name_lowered(&mut self) {
        let name = |river: usize| self.added.names.name(self.rivers[river]);
        let visible = self
            .lowerings
            .iter()
            .filter(|lowering| lowering.by > self.flat_tolerance());
        let named = visible.map(
            |&RiverLowering {
                 river,
                 to,
                 by,
                 from,
             }| LoweredRiver {
                name: name(river),
                to: name(to),
                by: self.units.height(by),
                from,
            },
        );
        self.added.lowered = named.collect();
    }

    fn rivers_of(
        &mut self,
        layer: &Layer,
        path: &Path,
        transform: Option<usize>,
    ) -> Result<Vec<(Drawn, River)>> {
        for (at, shape) in layer.shapes.iter().enumerate() {
            let error = match shape {
                Shape::Polygon(_) => Error::format("a polygon is not a bank").cure(wording![
                    "divide its ring into the two banks of the river, or use ",
                    Setting::Flat,
                    " for level water"
                ]),
                Shape::Lines(parts) if parts.iter().any(|part| part.len() < 2) => {
                    Error::format("a part of the record has fewer than two vertices")
                        .cure("remove it, so that banks are paired as they are meant to be")
                }
                _ => continue,
            };
            return Err(shapes::at_record(error, path, layer.record(at)));
        }
        let by_record = records(shapes::with_heights(layer, path, Setting::Rivers)?);
        let rivers = match &self.request.river_width {
            Some(_) => by_record
                .into_iter()
                .flatten()
                .map(|line| vec![line])
                .collect(),
            None => banks(by_record, path)?,
        };
        let mut named: Vec<(Drawn, River)> = Vec::with_capacity(rivers.len());
        for mut parts in rivers {
            let length = |part: &Drawn| {
                part.points
                    .windows(2)
                    .map(|pair| distance(pair[0], pair[1]))
                    .sum::<f64>()
            };
            let in_layer = length(&parts[0]);
            for part in &mut parts {
                self.transform(part, path, transform)?;
            }
            let river = match (&self.request.river_width, parts.as_slice()) {
                (Some(width @ PerRecord::Field(_)), [middle, ..]) => {
                    // Attributes are in the units of the layer.
                    let width = width.of(layer, middle.at) * (length(middle) / in_layer);
                    River::along(&middle.points, width)
                }
                (Some(PerRecord::Number(width)), [middle, ..]) => {
                    River::along(&middle.points, *width)
                }
                (_, [left, right, ..]) => River::between(&left.points, &right.points),
                _ => continue, // banks come in pairs
            };
            let line = parts.swap_remove(0);
            let river = river.map_err(|e| shapes::at_record(e, path, line.record))?;
            named.push((line, river));
        }
        Ok(named)
    }
}

/// The banks of each river, as pairs: the two parts of a record, or two consecutive records of one
/// part.
fn banks(by_record: Vec<Vec<Drawn>>, path: &Path) -> Result<Vec<Vec<Drawn>>> {
    let cure = wording![
        "a river needs two banks: two parts of a record, or two records of one part each; or give ",
        Setting::RiverWidth
    ];
    let mut pairs: Vec<Vec<Drawn>> = Vec::new();
    for parts in by_record {
        let record = parts[0].record;
        let is_open = pairs.last().is_some_and(|pair| pair.len() == 1);
        match (parts.len(), pairs.last_mut().filter(|_| is_open)) {
            (1, Some(open)) => open.extend(parts),
            (1 | 2, None) => pairs.push(parts),
            (count, _) => {
                let error = Error::format(format!(
                    "the record has {count} parts, expected 1 or 2 banks"
                ));
                let error = if is_open {
                    Error::format(
                        "the record has two banks, but the record before has one without an opposite bank",
                    )
                } else {
                    error
                };
                return Err(shapes::at_record(error.cure(cure), path, record));
            }
        }
    }
    match pairs.last() {
        Some(pair) if pair.len() == 1 => Err(shapes::at_record(
            Error::format("the bank has no opposite bank").cure(cure),
            path,
            pair[0].record,
        )),
        _ => Ok(pairs),
    }
}

/// Differences of heights in water up to this are not reported.
const FLAT_TOLERANCE_METRES: f64 = 0.01;

/// The default tolerance of shores: those that were drawn on a lidar survey differ by its noise.
const SHORE_TOLERANCE_METRES: f64 = 0.3;

/// The lines of each record.
fn records(drawn: Vec<Drawn>) -> Vec<Vec<Drawn>> {
    drawn
        .chunk_by(|p, q| p.at == q.at)
        .map(<[Drawn]>::to_vec)
        .collect()
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}
