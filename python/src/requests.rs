//! Arguments become requests.

use std::path::PathBuf;
use std::sync::Arc;

use breakline::crs::Crs;
use breakline::data::{
    Bounds, ColorMatch, Column, Lattice, Layer, PointBatch, PointFlags, Return, Shape, returns,
};
use breakline::io::OnDamage;
use breakline::io::geotiff::Overviews;
use breakline::io::points;
use breakline::run::proj::TransformOptions;
use breakline::run::{
    self, ColorReliefOptions, Degrees, EdgeLimit, FlatOptions, FlatRule, FrameOptions, Input,
    LightOptions, LineRequest, LowerEdge, MapOptions, MapPreset, MemoryPoints, PerRecord,
    QuantityOptions, ReplacedPoints, Smoothing, SystemOptions, TinRequest, WallOptions,
    WrittenEdges,
};
use breakline::terrain::ground::GroundOptions;
use breakline::terrain::{
    CellPoint, Classes, CrossingRule, DuplicateRule, Gradient, HighSide, LabelTops, Method,
    Quantity, Ruggedness, Shading, Thinning,
};
use breakline::triangulation::OnCrossing;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::{self, Failure};

/// Returns what a name stands for.
pub(crate) fn choose<T: Copy>(parameter: &str, name: &str, table: &[(&str, T)]) -> PyResult<T> {
    table
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, value)| *value)
        .ok_or_else(|| {
            let known: Vec<&str> = table.iter().map(|(known, _)| *known).collect();
            errors::usage(
                &format!("{parameter} has an unknown value"),
                &format!("'{name}'"),
                &format!("use one of {}", known.join(", ")),
            )
        })
}

const DUPLICATES: [(&str, DuplicateRule); 5] = [
    ("lowest", DuplicateRule::Lowest),
    ("highest", DuplicateRule::Highest),
    ("mean", DuplicateRule::Mean),
    ("first", DuplicateRule::First),
    ("last", DuplicateRule::Last),
];

const ON_CROSSING: [(&str, OnCrossing); 2] =
    [("split", OnCrossing::Split), ("reject", OnCrossing::Reject)];

const METHODS: [(&str, Method); 6] = [
    ("linear", Method::Linear),
    ("nearest", Method::Nearest),
    ("natural", Method::Natural),
    ("laplace", Method::Laplace),
    ("smooth", Method::Smooth),
    ("idw", Method::Idw),
];

/// Returns the method of interpolation with a name.
pub(crate) fn method(name: &str) -> PyResult<Method> {
    choose("method", name, &METHODS)
}

const GRADIENTS: [(&str, Gradient); 3] = [
    ("horn", Gradient::Horn),
    ("zevenbergen-thorne", Gradient::ZevenbergenThorne),
    ("faces", Gradient::Faces),
];

const CURVATURES: [(&str, Quantity); 2] = [
    ("profile", Quantity::ProfileCurvature),
    ("plan", Quantity::PlanCurvature),
];

const RUGGEDNESS: [(&str, Ruggedness); 2] =
    [("riley", Ruggedness::Riley), ("wilson", Ruggedness::Wilson)];

const SHADINGS: [(&str, Shading); 4] = [
    ("standard", Shading::Standard),
    ("combined", Shading::Combined),
    ("multidirectional", Shading::Multidirectional),
    ("igor", Shading::Igor),
];

const MATCHES: [(&str, ColorMatch); 3] = [
    ("linear", ColorMatch::Linear),
    ("nearest", ColorMatch::Nearest),
    ("exact", ColorMatch::Exact),
];

/// A color ramp by its name or in a file, and the colors of heights between those of the ramp.
type ColorArguments = (PathBuf, String);

/// What a color relief is drawn by: its frame, the method of interpolation and the colors.
pub(crate) type ReliefArguments = (FrameArguments, String, ColorArguments);

/// Returns the options of a color relief.
pub(crate) fn relief_options(
    (frame, method_name, (ramp, matching)): ReliefArguments,
) -> PyResult<ColorReliefOptions> {
    Ok(ColorReliefOptions {
        ramp: run::color_ramp(&ramp).map_err(Failure)?,
        matching: choose("match", &matching, &MATCHES)?,
        frame: frame.options()?,
        method: method(&method_name)?,
    })
}

/// How contours become those of a map, under the names in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct MapArguments {
    preset: Option<String>,
    /// Lines are smoothed.
    smooth: bool,
    /// How far; half of the interval if it is `None`.
    tolerance: Option<f64>,
    simplify: Option<f64>,
    min_length: Option<f64>,
    min_area: Option<f64>,
    keep_depressions: bool,
    index_every: Option<u32>,
    bands: bool,
    in_plane: bool,
    /// Where the tops of labels are; `None` without labels.
    labels: Option<String>,
    label_height: Option<f64>,
}

const PRESETS: [(&str, MapPreset); 1] = [("cartographic", MapPreset::Cartographic)];

const LABELS: [(&str, LabelTops); 2] = [
    ("readable", LabelTops::Readable),
    ("uphill", LabelTops::Uphill),
];

/// Returns the options of contours for maps.
pub(crate) fn map_options(given: MapArguments) -> PyResult<MapOptions> {
    let preset = given.preset.as_deref();
    let labels = given.labels.as_deref();
    Ok(MapOptions {
        preset: preset
            .map(|name| choose("preset", name, &PRESETS))
            .transpose()?,
        smooth: given.smooth.then(|| {
            given
                .tolerance
                .map_or(Smoothing::HalfInterval, Smoothing::Within)
        }),
        simplify: given.simplify,
        min_length: given.min_length,
        min_area: given.min_area,
        keep_depressions: given.keep_depressions,
        index_every: given.index_every,
        bands: given.bands,
        without_heights: given.in_plane,
        labels: labels
            .map(|name| choose("labels", name, &LABELS))
            .transpose()?,
        label_height: given.label_height,
    })
}

/// How slopes are shaded, the direction of the light and its angle above the horizon, and the
/// factor for heights.
pub(crate) type LightArguments = (String, Option<f64>, Option<f64>, Option<f64>);

/// Returns the options of the light of a hillshade.
pub(crate) fn light_options(
    (shading, azimuth, altitude, z_factor): LightArguments,
) -> PyResult<LightOptions> {
    Ok(LightOptions {
        shading: choose("shading", &shading, &SHADINGS)?,
        azimuth,
        altitude,
        z_factor,
    })
}

/// Returns the quantity that a verb computes in cells, given its formula and whether it is in
/// percent; `None` if there is no such verb.
pub(crate) fn quantity(verb: &str, formula: &str, percent: bool) -> PyResult<Option<Quantity>> {
    let gradient = || choose("formula", formula, &GRADIENTS);
    Ok(Some(match verb {
        "slope" if percent => Quantity::SlopePercent(gradient()?),
        "slope" => Quantity::SlopeDegrees(gradient()?),
        "aspect" => Quantity::Aspect(gradient()?),
        "curvature" => choose("formula", formula, &CURVATURES)?,
        "roughness" => Quantity::Roughness,
        "tri" => Quantity::Ruggedness(choose("formula", formula, &RUGGEDNESS)?),
        "tpi" => Quantity::Position,
        _ => return Ok(None),
    }))
}

/// Returns the options of a verb that computes a quantity in cells: its name and formula, whether
/// it is in percent, and the factor for heights.
pub(crate) fn quantity_options(
    frame: FrameOptions,
    method_name: &str,
    (verb, formula, percent, z_factor): &(String, String, bool, Option<f64>),
) -> PyResult<QuantityOptions> {
    let quantity = quantity(verb, formula, *percent)?.ok_or_else(|| no_verb(verb))?;
    Ok(QuantityOptions {
        quantity,
        frame,
        method: method(method_name)?,
        z_factor: *z_factor,
    })
}

/// Returns the error for a verb that does not exist.
pub(crate) fn no_verb(name: &str) -> PyErr {
    errors::usage(
        "there is no such verb",
        &format!("'{name}'"),
        "use dem, hillshade, color_relief, slope, aspect, curvature, roughness, tri, tpi, contour or tin",
    )
}

/// Returns the rule for crossing segments with a name.
pub(crate) fn on_crossing(name: &str) -> PyResult<OnCrossing> {
    choose("on_crossing", name, &ON_CROSSING)
}

fn crossing_rule(name: &str) -> PyResult<CrossingRule> {
    if name == "error" {
        return Ok(CrossingRule::Refuse);
    }
    choose("crossing_z", name, &DUPLICATES).map(CrossingRule::Choose)
}

/// Returns the coordinate system that a text names or defines.
pub(crate) fn crs(text: Option<&str>) -> PyResult<Option<Crs>> {
    Ok(text.map(Crs::from_user).transpose().map_err(Failure)?)
}

/// A box in plan: west, south, east, north.
pub(crate) fn bounds(corners: Option<[f64; 4]>) -> Option<Bounds> {
    corners.map(|[x0, y0, x1, y1]| Bounds {
        min: [x0, y0, f64::NEG_INFINITY],
        max: [x1, y1, f64::INFINITY],
    })
}

/// A coordinate of many points: numbers, or whole steps of a lattice.
#[derive(FromPyObject)]
pub(crate) enum Axis<'py> {
    Numbers(PyReadonlyArray1<'py, f64>),
    Steps(PyReadonlyArray1<'py, i32>),
}

/// Points in arrays.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct PointColumns<'py> {
    axes: [Axis<'py>; 3],
    scale: [f64; 3],
    offset: [f64; 3],
    classes: Option<PyReadonlyArray1<'py, u8>>,
    flags: Option<PyReadonlyArray1<'py, u8>>,
    return_number: Option<PyReadonlyArray1<'py, u8>>,
    return_count: Option<PyReadonlyArray1<'py, u8>>,
    crs: Option<String>,
}

impl Axis<'_> {
    /// Returns the numbers, copied so that other threads may change the array meanwhile.
    fn read(&self, axis: usize, lattice: &Lattice) -> Vec<f64> {
        match self {
            Axis::Numbers(numbers) => numbers.as_array().iter().copied().collect(),
            Axis::Steps(steps) => {
                let on_axis = |&step: &i32| {
                    let mut all = [0; 3];
                    all[axis] = step;
                    lattice.point(all)[axis]
                };
                steps.as_array().iter().map(on_axis).collect()
            }
        }
    }
}

impl PointColumns<'_> {
    fn count(&self) -> usize {
        match &self.axes[0] {
            Axis::Numbers(numbers) => numbers.as_array().len(),
            Axis::Steps(steps) => steps.as_array().len(),
        }
    }

    fn read(&self) -> PyResult<MemoryPoints> {
        let lattice = Lattice {
            scale: self.scale,
            offset: self.offset,
        };
        let [x, y, z] = [0, 1, 2].map(|k| self.axes[k].read(k, &lattice));
        let bytes = |column: &Option<PyReadonlyArray1<'_, u8>>| -> Vec<u8> {
            column
                .as_ref()
                .map(|column| column.as_array().iter().copied().collect())
                .unwrap_or_default()
        };
        let flags = bytes(&self.flags).into_iter().map(PointFlags).collect();
        let points = PointBatch {
            x,
            y,
            z,
            class: bytes(&self.classes),
            flags,
            return_number: bytes(&self.return_number),
            return_count: bytes(&self.return_count),
            ..PointBatch::default()
        };
        Ok(MemoryPoints {
            points,
            crs: crs(self.crs.as_deref())?,
        })
    }
}

/// Points in a file, or in arrays.
#[derive(FromPyObject)]
pub(crate) enum PointInput<'py> {
    File(PathBuf),
    Columns(PointColumns<'py>),
}

/// Returns the inputs of points.
pub(crate) fn point_inputs(inputs: &[PointInput<'_>]) -> PyResult<Vec<Input<MemoryPoints>>> {
    let read = |input: &PointInput<'_>| match input {
        PointInput::File(path) => Ok(Input::File(path.clone())),
        PointInput::Columns(columns) => Ok(Input::Memory(Arc::new(columns.read()?))),
    };
    inputs.iter().map(read).collect()
}

/// Returns the number of points in arrays; `None` if there are files.
pub(crate) fn count(inputs: &[PointInput<'_>]) -> Option<usize> {
    let count = |input: &PointInput<'_>| match input {
        PointInput::File(_) => None,
        PointInput::Columns(columns) => Some(columns.count()),
    };
    inputs.iter().map(count).sum()
}

/// Lines and polygons in arrays: all vertices one after the other, the number of vertices of each
/// part, and for each shape its kind (1 line, 2 polygon) and the number of its parts.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Shapes<'py> {
    vertices: PyReadonlyArray2<'py, f64>,
    parts: Vec<usize>,
    shapes: Vec<(u8, usize)>,
    columns: Vec<(String, Vec<f64>)>,
    crs: Option<String>,
}

impl Shapes<'_> {
    fn read(&self) -> PyResult<Layer> {
        let mut vertices = arrays::points::<3>(&self.vertices).into_iter();
        let mut parts = self
            .parts
            .iter()
            .map(|&count| vertices.by_ref().take(count).collect::<Vec<_>>());
        let shapes = self.shapes.iter().map(|&(kind, count)| {
            let parts = parts.by_ref().take(count).collect();
            if kind == 2 {
                Shape::Polygon(parts)
            } else {
                Shape::Lines(parts)
            }
        });
        let shapes = shapes.collect();
        let columns: Vec<Column> = self
            .columns
            .iter()
            .map(|(name, values)| Column {
                name: name.clone(),
                values: values.clone(),
            })
            .collect();
        let fields = columns.iter().map(|column| column.name.clone()).collect();
        Ok(Layer {
            shapes,
            crs: crs(self.crs.as_deref())?,
            fields,
            columns,
            ..Layer::default()
        })
    }
}

/// A vector layer in a file, or in arrays.
#[derive(FromPyObject)]
pub(crate) enum LayerInput<'py> {
    File(PathBuf),
    Shapes(Shapes<'py>),
}

fn layers(inputs: &[LayerInput<'_>]) -> PyResult<Vec<Input<Layer>>> {
    inputs.iter().map(layer).collect()
}

/// Returns a layer as an input; that of arrays is copied.
pub(crate) fn layer(input: &LayerInput<'_>) -> PyResult<Input<Layer>> {
    match input {
        LayerInput::File(path) => Ok(Input::File(path.clone())),
        LayerInput::Shapes(shapes) => Ok(Input::Memory(Arc::new(shapes.read()?))),
    }
}

/// A number, or a name.
#[derive(FromPyObject)]
pub(crate) enum NumberOrName {
    Number(f64),
    Name(String),
}

impl NumberOrName {
    fn per_record(&self) -> PerRecord {
        match self {
            NumberOrName::Number(number) => PerRecord::Number(*number),
            NumberOrName::Name(name) => PerRecord::Field(name.clone()),
        }
    }
}

/// Options of reading files of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ReadArguments {
    columns: Option<String>,
    partial: bool,
    copc_resolution: Option<f64>,
}

impl ReadArguments {
    pub(crate) fn options(&self) -> PyResult<points::Options> {
        let columns = self.columns.as_deref().map(|text| {
            text.parse().map_err(|why: String| {
                errors::usage(
                    &format!("columns: {why}"),
                    &format!("'{text}'"),
                    "write 'PNEZD', 'XYZ' or (2, 1, 3)",
                )
            })
        });
        let cut = if self.partial {
            OnDamage::Accept
        } else {
            OnDamage::Refuse
        };
        Ok(points::Options {
            columns: columns.transpose()?,
            cut,
            resolution: self.copc_resolution,
            ..points::Options::default()
        })
    }
}

/// Coordinate systems of the input and of the result.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SystemArguments {
    crs: Option<String>,
    to_crs: Option<String>,
    force_degrees: bool,
    require_grids: bool,
    epoch: Option<f64>,
}

impl SystemArguments {
    pub(crate) fn options(&self) -> PyResult<SystemOptions> {
        let degrees = if self.force_degrees {
            Degrees::Allow
        } else {
            Degrees::Refuse
        };
        Ok(SystemOptions {
            assign: crs(self.crs.as_deref())?,
            target: crs(self.to_crs.as_deref())?,
            degrees,
            transform: TransformOptions {
                require_grids: self.require_grids,
                epoch: self.epoch,
            },
        })
    }
}

/// Options of building a surface, under the names that they have in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SurfaceArguments<'py> {
    breaklines: Vec<LayerInput<'py>>,
    boundary: Vec<LayerInput<'py>>,
    bounds: Option<[f64; 4]>,
    max_edge: Option<NumberOrName>,
    max_edge_inside: Option<f64>,
    classes: Option<Vec<u8>>,
    returns: Option<Vec<String>>,
    ground: bool,
    duplicates: String,
    on_crossing: String,
    crossing_z: String,
    crossing_tolerance: Option<f64>,
    soft_lines: Vec<LayerInput<'py>>,
    draped_lines: Vec<LayerInput<'py>>,
    walls: Vec<LayerInput<'py>>,
    wall_bottom: Option<NumberOrName>,
    wall_drop: Option<NumberOrName>,
    wall_width: Option<f64>,
    wall_high: String,
    holes: Vec<LayerInput<'py>>,
    flat: Vec<LayerInput<'py>>,
    flat_height: Option<NumberOrName>,
    flat_tolerance: Option<f64>,
    flat_buffer: f64,
    flat_points: bool,
    rivers: Vec<LayerInput<'py>>,
    river_width: Option<NumberOrName>,
    densify: Option<f64>,
    add_ridges: bool,
}

impl SurfaceArguments<'_> {
    /// Returns true if the surface has more than points: lines, areas or a boundary.
    pub(crate) fn have_lines(&self) -> bool {
        let layers = [
            &self.breaklines,
            &self.boundary,
            &self.soft_lines,
            &self.draped_lines,
            &self.walls,
            &self.holes,
            &self.flat,
            &self.rivers,
        ];
        layers.iter().any(|layers| !layers.is_empty())
    }

    /// Returns the request for a TIN of these points.
    pub(crate) fn request(
        &self,
        points: &[PointInput<'_>],
        read: &ReadArguments,
    ) -> PyResult<TinRequest> {
        let returns = returns_of(self.returns.as_deref())?;
        Ok(TinRequest {
            points: point_inputs(points)?,
            read: read.options()?,
            classes: Classes::of(self.classes.as_deref().unwrap_or_default(), &returns),
            returns,
            ground: self.ground.then(GroundOptions::default),
            breaklines: layers(&self.breaklines)?,
            boundary: layers(&self.boundary)?,
            lines: self.lines()?,
            bounds: bounds(self.bounds),
            max_edge: self.edge_limit()?,
            max_edge_inside: positive("max_edge_inside", self.max_edge_inside)?,
            replaced: if self.flat_points {
                ReplacedPoints::Keep
            } else {
                ReplacedPoints::Drop
            },
            duplicates: choose("duplicates", &self.duplicates, &DUPLICATES)?,
            on_crossing: on_crossing(&self.on_crossing)?,
            crossing_heights: crossing_rule(&self.crossing_z)?,
            crossing_tolerance: not_negative("crossing_tolerance", self.crossing_tolerance)?,
        })
    }

    fn edge_limit(&self) -> PyResult<EdgeLimit> {
        match &self.max_edge {
            None => Ok(EdgeLimit::Standard),
            Some(NumberOrName::Number(length)) if length.is_infinite() => Ok(EdgeLimit::Unlimited),
            Some(NumberOrName::Number(length)) => {
                Ok(positive("max_edge", Some(*length))?
                    .map_or(EdgeLimit::Standard, EdgeLimit::Length))
            }
            Some(NumberOrName::Name(name)) => choose(
                "max_edge",
                name,
                &[("auto", EdgeLimit::Auto), ("none", EdgeLimit::Unlimited)],
            ),
        }
    }

    fn lines(&self) -> PyResult<LineRequest> {
        let lower = match (&self.wall_bottom, &self.wall_drop) {
            (Some(height), None) => Some(LowerEdge::Height(height.per_record())),
            (None, Some(drop)) => Some(LowerEdge::Drop(drop.per_record())),
            (None, None) => None,
            (Some(_), Some(_)) => {
                return Err(errors::usage(
                    "wall_bottom and wall_drop are given",
                    "both",
                    "use one of them",
                ));
            }
        };
        let high = choose(
            "wall_high",
            &self.wall_high,
            &[("left", HighSide::Left), ("right", HighSide::Right)],
        )?;
        let height = match &self.flat_height {
            None => FlatRule::OfShore,
            Some(NumberOrName::Name(name)) if name == "lowest" => FlatRule::Lowest,
            Some(NumberOrName::Name(name)) if name == "mean" => FlatRule::Mean,
            Some(given) => FlatRule::Given(given.per_record()),
        };
        Ok(LineRequest {
            soft: layers(&self.soft_lines)?,
            draped: layers(&self.draped_lines)?,
            walls: layers(&self.walls)?,
            wall: WallOptions {
                lower,
                width: positive("wall_width", self.wall_width)?,
                high,
            },
            holes: layers(&self.holes)?,
            flats: layers(&self.flat)?,
            flat: FlatOptions {
                height,
                tolerance: not_negative("flat_tolerance", self.flat_tolerance)?,
                buffer: not_negative("flat_buffer", Some(self.flat_buffer))?.unwrap_or_default(),
            },
            rivers: layers(&self.rivers)?,
            river_width: self.river_width.as_ref().map(NumberOrName::per_record),
            densify: positive("densify", self.densify)?,
            add_ridges: self.add_ridges,
        })
    }
}

/// Returns what a file says of edges, by the parameter `plain`.
pub(crate) fn written_edges(plain: bool) -> WrittenEdges {
    if plain {
        WrittenEdges::Plain
    } else {
        WrittenEdges::WithLines
    }
}

/// Returns the returns that words mean: numbers, ranges and names; none, which means all, without
/// words or if one of them is `all`.
pub(crate) fn returns_of(words: Option<&[String]>) -> PyResult<Vec<Return>> {
    let mut found = Vec::new();
    for word in words.unwrap_or_default() {
        let meant = returns::parse(word).map_err(|_| {
            errors::usage(
                "returns has an unknown value",
                word,
                "pass 'first', 'last', 'single', 'all', numbers, or ranges such as '2-15'",
            )
        })?;
        if meant.is_empty() {
            return Ok(Vec::new());
        }
        found.extend(meant);
    }
    Ok(found)
}

const CELL_POINTS: [(&str, CellPoint); 3] = [
    ("center", CellPoint::Center),
    ("lowest", CellPoint::Lowest),
    ("highest", CellPoint::Highest),
];

/// Returns the rule that points are thinned by, if any.
pub(crate) fn thinning(
    rule: Option<&str>,
    keep: Option<&str>,
    seed: Option<u64>,
) -> PyResult<Option<Thinning>> {
    let keep = keep
        .map(|name| choose("thin_keep", name, &CELL_POINTS))
        .transpose()?;
    let Some(rule) = rule else {
        return if keep.is_some() || seed.is_some() {
            Err(errors::usage(
                "thin_keep and seed are of a rule to thin points by",
                "thin=None",
                "pass thin, too",
            ))
        } else {
            Ok(None)
        };
    };
    let parsed = Thinning::parse(rule).map_err(|why| {
        errors::usage(
            &format!("thin: {why}"),
            &format!("'{rule}'"),
            "pass 'grid:SIZE', 'poisson:DISTANCE', 'nth:N' or 'random:SHARE'",
        )
    })?;
    Ok(Some(parsed.with(keep, seed).map_err(Failure)?))
}

/// Returns a number if it is not below zero, and finite.
fn not_negative(parameter: &str, number: Option<f64>) -> PyResult<Option<f64>> {
    match number {
        Some(number) if !(number >= 0.0 && number.is_finite()) => Err(errors::usage(
            &format!("{parameter} is {number}"),
            &number.to_string(),
            "pass a number that is not below zero",
        )),
        _ => Ok(number),
    }
}

/// Returns a number if it is above zero and finite.
pub(crate) fn positive(parameter: &str, number: Option<f64>) -> PyResult<Option<f64>> {
    match number {
        Some(number) if !(number > 0.0 && number.is_finite()) => Err(errors::usage(
            &format!("{parameter} is not a finite number above zero"),
            &number.to_string(),
            "use a number above zero, or None",
        )),
        number => Ok(number),
    }
}

/// Size and position of a raster.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct FrameArguments {
    resolution: Option<f64>,
    extent: Option<[f64; 4]>,
    align_to: Option<PathBuf>,
    overviews: String,
}

const OVERVIEWS: [(&str, Overviews); 2] = [("auto", Overviews::Auto), ("none", Overviews::None)];

/// Returns the overviews with a name.
pub(crate) fn overviews(name: &str) -> PyResult<Overviews> {
    choose("overviews", name, &OVERVIEWS)
}

impl FrameArguments {
    pub(crate) fn options(&self) -> PyResult<FrameOptions> {
        if self.resolution.is_some() && self.align_to.is_some() {
            return Err(errors::usage(
                "resolution and align_to are given",
                "both",
                "use one of them",
            ));
        }
        Ok(FrameOptions {
            resolution: positive("resolution", self.resolution)?,
            extent: bounds(self.extent),
            align_to: self.align_to.clone(),
            overviews: overviews(&self.overviews)?,
        })
    }
}

/// Returns the bytes that a text states.
pub(crate) fn memory(text: &str) -> PyResult<u64> {
    run::memory_of(text).map_err(|why| {
        errors::usage(
            &format!("memory: {why}"),
            &format!("'{text}'"),
            "write '200MB'",
        )
    })
}
