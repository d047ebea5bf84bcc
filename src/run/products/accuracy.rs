//! The vertical accuracy of a surface, by checkpoints.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::sample::none_inside;
use super::surface::SurfaceProduct;
use crate::crs::{Crs, Unit};
use crate::data::{Columns, PointBatch, PointSource, Shape};
use crate::error::{Error, Result, Setting, wording};
use crate::io::no_such_field;
use crate::io::points::Options;
use crate::io::text::Axes;
use crate::io::text::table::{self, TableBatch};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::request::input::{Input, MemoryPoints, is_read_once};
use crate::run::sources::open::{self, Content, content, is_lidar};
use crate::run::sources::systems::{self, Role, Stated, SystemOptions};
use crate::terrain::{ErrorStatistics, Histogram, Method, Sampler};

/// The least number of checkpoints by which a product may be assessed (ASPRS 2023, edition 2).
const FEWEST: usize = 30;

/// How accuracy is assessed. By default, by all checkpoints together, without a decision.
#[derive(Debug, Clone, Default)]
pub struct AccuracyOptions {
    /// How the file of checkpoints is read.
    pub read: Options,
    /// The coordinate system of the checkpoints, whatever their file states.
    pub assign: Option<Crs>,
    /// The field by which checkpoints are grouped: a column of text, an attribute of a layer, or
    /// `class` of LAS.
    pub group_by: Option<String>,
    /// The group of each checkpoint, if these are in memory; empty if they are not grouped.
    pub groups: Vec<String>,
    /// The groups in vegetation: their accuracy is stated, but not tested.
    pub vegetated: Vec<String>,
    /// The accuracy class: the largest RMSE of heights that meets it.
    pub class: Option<HeightMeasure>,
    /// The RMSE of the checkpoints themselves, by their survey.
    pub checkpoint_error: Option<HeightMeasure>,
    /// How heights between the vertices of a TIN are computed.
    pub method: Method,
    /// What messages call the surface, such as the name of its file.
    pub surface: PathBuf,
}

/// A difference of heights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeightMeasure {
    /// In meters.
    Meters(f64),
    /// In the unit of the heights of the data.
    Units(f64),
}

/// The units in which a measure may be written, with their meters.
const UNITS: &[(&str, f64)] = &[
    ("mm", 0.001),
    ("cm", 0.01),
    ("m", 1.0),
    ("in", 0.0254),
    ("ft", 0.3048),
];

/// Parses `10cm`, `0.1 m`, or `0.1` in the unit of the heights of the data.
impl FromStr for HeightMeasure {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let text = text.trim();
        let end = text
            .find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E'))
            .unwrap_or(text.len());
        let (number, unit) = text.split_at(end);
        let wrong = || "expected a length such as 10cm, 0.1m or 0.1".to_owned();
        let number: f64 = number.trim().parse().map_err(|_| wrong())?;
        if !(number.is_finite() && number >= 0.0) {
            return Err("expected a length that is not negative".to_owned());
        }
        if unit.is_empty() {
            return Ok(HeightMeasure::Units(number));
        }
        let known = UNITS
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(unit));
        match known {
            Some((_, meters)) => Ok(HeightMeasure::Meters(number * meters)),
            None => Err(format!("`{unit}` is not one of mm, cm, m, in and ft")),
        }
    }
}

/// A checkpoint, and the surface there.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CheckpointRow {
    /// The number of its line or record in the file, from 1.
    pub number: u64,
    /// The checkpoint.
    pub point: [f64; 3],
    /// The height of the surface; NaN outside of it.
    pub surface: f64,
    /// The group, if checkpoints are grouped.
    pub group: Option<String>,
}

impl CheckpointRow {
    /// Returns the height of the surface above the checkpoint; NaN outside of it.
    pub fn difference(&self) -> f64 {
        self.surface - self.point[2]
    }
}

/// Which checkpoints statistics are of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CheckpointSet {
    /// All.
    All,
    /// Those that are not in vegetation.
    NonVegetated,
    /// Those in vegetation.
    Vegetated,
    /// Those of one group.
    Group(String),
}

impl CheckpointSet {
    /// Returns what outputs call it: `all`, `non-vegetated`, `vegetated`, or `group`.
    pub fn kind(&self) -> &'static str {
        match self {
            CheckpointSet::All => "all",
            CheckpointSet::NonVegetated => "non-vegetated",
            CheckpointSet::Vegetated => "vegetated",
            CheckpointSet::Group(_) => "group",
        }
    }

    /// Returns the name of the group; `None` if it is not one.
    pub fn group(&self) -> Option<&str> {
        match self {
            CheckpointSet::Group(name) => Some(name.as_str()),
            CheckpointSet::All | CheckpointSet::NonVegetated | CheckpointSet::Vegetated => None,
        }
    }
}

/// The accuracy by some checkpoints.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SetAccuracy {
    /// Which checkpoints.
    pub set: CheckpointSet,
    /// The statistics of the differences.
    pub statistics: ErrorStatistics,
    /// The RMSE with that of the checkpoints themselves.
    pub rmse: f64,
}

/// Whether a surface meets an accuracy class.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ClassDecision {
    /// The largest RMSE that meets the class, in the unit of the heights.
    pub limit: f64,
    /// The checkpoints that decide.
    pub set: CheckpointSet,
    /// Their RMSE, with that of the checkpoints themselves.
    pub rmse: f64,
}

impl ClassDecision {
    /// Returns true if the class is met.
    pub fn is_met(&self) -> bool {
        self.rmse <= self.limit
    }
}

/// The vertical accuracy of a surface.
#[derive(Debug)]
#[non_exhaustive]
pub struct AccuracyProduct {
    /// All checkpoints, in the order of their file.
    pub rows: Vec<CheckpointRow>,
    /// What the numbers of rows count: lines or records.
    pub counted_by: &'static str,
    /// The columns of the coordinates, if the checkpoints are text.
    pub columns: Option<Columns>,
    /// The statistics: of all, then of those without and with vegetation, then of each group. A set
    /// without a checkpoint on the surface is left out.
    pub sets: Vec<SetAccuracy>,
    /// The differences of all checkpoints, in bins.
    pub histogram: Option<Histogram>,
    /// The decision, if a class is asked for.
    pub decision: Option<ClassDecision>,
    /// The RMSE of the checkpoints themselves, in the unit of the heights.
    pub checkpoint_error: f64,
    /// The unit of the heights, if it is known.
    pub unit: Option<Unit>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Compares the heights of a surface with those of checkpoints, in the terms of the ASPRS
/// Positional Accuracy Standards for Digital Geospatial Data, edition 2 (2023). Heights of the
/// surface are those of the cells of a DEM.
///
/// # Errors
/// If the checkpoints cannot be read or have no heights, the field or a group does not exist, the
/// coordinate systems differ, no checkpoint is on the surface, or none of those that would decide;
/// if a file is damaged, and if the run is canceled.
///
/// # Complexity
/// That of [`Sampler::samples`], and O(n log n) for the statistics of n checkpoints, which are all
/// in memory.
pub fn accuracy(
    surface: &SurfaceProduct,
    checkpoints: &Input<MemoryPoints>,
    options: &AccuracyOptions,
    context: &Context,
) -> Result<AccuracyProduct> {
    let journal = Journal::new(context);
    context.check()?;
    let mut read = Checkpoints::read(checkpoints, options, &journal)?;
    let path = checkpoints.path();
    let of_checkpoints = Stated {
        path: path.to_path_buf(),
        crs: read.crs.clone(),
        unread: read.unread_crs.clone(),
        role: Role::Ground,
    };
    let stated = [
        surface.stated(&options.surface),
        of_checkpoints.assigned(options.assign.as_ref(), &journal),
    ];
    let crs = systems::unify(&stated, &SystemOptions::default(), &journal)?.crs;
    if let Some(notice) = surface.unread_by(options.method) {
        journal.add(notice);
    }
    read.check(&options.vegetated, path)?;
    read.sample(surface, path, options, &journal)?;
    let scale = Scale::new(crs.as_ref(), options, &journal);
    let assessment = Assessment::new(&read.rows, &options.vegetated, scale.checkpoint_error);
    let decision = decide(&assessment, scale.class, path, &journal)?;
    let differences: Vec<f64> = assessment.differences(&CheckpointSet::All);
    Ok(AccuracyProduct {
        counted_by: read.counted_by,
        columns: read.columns,
        sets: assessment.sets(),
        histogram: Histogram::of(&differences),
        decision,
        checkpoint_error: scale.checkpoint_error,
        unit: scale.unit,
        rows: read.rows,
        notices: journal.take(),
    })
}

/// Compares the accuracy of the decisive checkpoints with the limit of a class; `None` if there is
/// no limit. Adds a notice if these checkpoints are few.
///
/// # Errors
/// If there is a limit, and none of these checkpoints is on the surface.
fn decide(
    assessment: &Assessment<'_>,
    class: Option<f64>,
    path: &Path,
    journal: &Journal,
) -> Result<Option<ClassDecision>> {
    let tested = assessment.accuracy(assessment.decisive());
    if let Some(tested) = &tested
        && tested.statistics.count < FEWEST
    {
        journal.add(Notice::FewCheckpoints(tested.statistics.count));
    }
    match (class, tested) {
        (None, _) => Ok(None),
        (Some(limit), Some(SetAccuracy { set, rmse, .. })) => {
            Ok(Some(ClassDecision { limit, set, rmse }))
        }
        (Some(_), None) => Err(Error::usage(
            "no checkpoint outside of vegetation is on the surface: nothing decides",
        )
        .in_file(path)
        .cure(wording![
            "name fewer groups with ",
            Setting::Vegetated,
            ", or leave out ",
            Setting::AccuracyClass
        ])),
    }
}

/// The checkpoints of a file.
struct Checkpoints {
    rows: Vec<CheckpointRow>,
    counted_by: &'static str,
    columns: Option<Columns>,
    crs: Option<Crs>,
    unread_crs: Option<String>,
}

impl Checkpoints {
    fn read(
        input: &Input<MemoryPoints>,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let group_by = options.group_by.as_deref();
        let path = match input {
            Input::Memory(_) => return Self::of_memory(input, options, journal),
            Input::File(path) if is_lidar(path) => {
                return Self::of_lidar(input, options, journal);
            }
            Input::File(path) => path,
        };
        match content(path) {
            Content::Layer if !is_read_once(path) => {
                Self::of_layer(path, group_by, options, journal)
            }
            _ => Self::of_text(path, group_by, options, journal),
        }
    }

    fn of_text(
        path: &Path,
        group_by: Option<&str>,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let mut table = table::open(path, options.read, Axes::Space)?;
        let column = match group_by {
            None => None,
            Some(name) => Some(table.column(name).ok_or_else(|| {
                let error = Error::usage(format!("there is no column {name}")).in_file(path);
                match table.names() {
                    [] => error.cure("put a header before the points that names the columns"),
                    names => error.cure(format!("name one of {}", names.join(", "))),
                }
            })?),
        };
        let mut rows = Vec::new();
        let mut batch = TableBatch::default();
        loop {
            table.read(&mut batch)?;
            if batch.is_empty() {
                break;
            }
            let mut groups = match column {
                Some(column) => table.fields(&batch, column)?.into_iter(),
                None => Vec::new().into_iter(),
            };
            let points = batch
                .positions
                .iter()
                .zip(&batch.heights)
                .zip(&batch.numbers);
            rows.extend(points.map(|((&[x, y], &z), &number)| CheckpointRow {
                number,
                point: [x, y, z],
                surface: f64::NAN,
                group: groups.next(),
            }));
        }
        journal.add_warnings(path, table.warnings());
        Ok(Checkpoints {
            rows,
            counted_by: "line",
            columns: Some(table.columns()),
            crs: None,
            unread_crs: None,
        })
    }

    fn of_layer(
        path: &Path,
        group_by: Option<&str>,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let (cut, context) = (options.read.cut, &journal.context);
        let layer = match group_by {
            None => open::layer(path, &[], cut, context),
            Some(_) => open::whole_layer(path, cut, context),
        };
        let layer = layer.map_err(|e| e.in_file(path))?;
        journal.add_warnings(path, &layer.warnings);
        let groups = match group_by {
            None => None,
            Some(field) => {
                let kept = layer.attributes.as_ref();
                let known = kept.map_or(&[][..], |attributes| &attributes.names);
                let groups = kept.and_then(|attributes| attributes.texts(field));
                Some(groups.ok_or_else(|| {
                    no_such_field(field, known.iter().map(String::as_str)).in_file(path)
                })?)
            }
        };
        let mut rows = Vec::new();
        for (i, shape) in layer.shapes.iter().enumerate() {
            let Shape::Points(points) = shape else {
                continue;
            };
            let group = groups
                .as_ref()
                .map(|groups| groups.get(i).cloned().unwrap_or_default());
            for &point in points {
                rows.push(CheckpointRow {
                    number: layer.record(i) as u64,
                    point,
                    surface: f64::NAN,
                    group: group.clone(),
                });
            }
        }
        Ok(Checkpoints {
            rows,
            counted_by: "record",
            columns: None,
            crs: layer.crs,
            unread_crs: layer.unread_crs,
        })
    }

    fn of_lidar(
        input: &Input<MemoryPoints>,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<Self> {
        if let Some(name) = &options.group_by
            && !name.eq_ignore_ascii_case("class")
        {
            return Err(
                Error::usage(format!("points of LAS are not grouped by {name}"))
                    .in_file(input.path())
                    .cure(wording!["group them by ", Setting::GroupBy.text("class")]),
            );
        }
        let is_grouped = options.group_by.is_some();
        let (read, _) = Self::of_points(input, options, journal, |batch, i, _| {
            let class = batch.class.get(i).filter(|_| is_grouped);
            class.map(u8::to_string)
        })?;
        Ok(read)
    }

    fn of_memory(
        input: &Input<MemoryPoints>,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let groups = &options.groups;
        let (read, points) = Self::of_points(input, options, journal, |_, _, before| {
            groups.get(before).cloned()
        })?;
        if !groups.is_empty() && groups.len() != points {
            return Err(
                Error::usage(format!("{} groups for {points} checkpoints", groups.len()))
                    .cure("pass a group for each checkpoint"),
            );
        }
        Ok(read)
    }

    /// Reads points without those that are withheld, with the group that a function returns for a
    /// position in a batch and in the whole. Also returns how many points there are in the whole.
    fn of_points(
        input: &Input<MemoryPoints>,
        options: &AccuracyOptions,
        journal: &Journal,
        group: impl Fn(&PointBatch, usize, usize) -> Option<String>,
    ) -> Result<(Self, usize)> {
        let path = input.path();
        let mut source: Box<dyn PointSource + Send> =
            open::points(input, options.read, &journal.context).map_err(|e| e.in_file(path))?;
        let (crs, unread_crs) = (source.info().crs.clone(), source.info().unread_crs.clone());
        journal.add_warnings(path, &source.info().warnings);
        let mut rows: Vec<CheckpointRow> = Vec::new();
        let mut batch = PointBatch::default();
        let mut before = 0;
        loop {
            journal.context.check()?;
            source.read(&mut batch).map_err(|e| e.in_file(path))?;
            if batch.is_empty() {
                break;
            }
            let is_withheld = |i: usize| batch.flags.get(i).is_some_and(|f| f.is_withheld());
            for i in (0..batch.len()).filter(|&i| !is_withheld(i)) {
                rows.push(CheckpointRow {
                    number: (before + i) as u64 + 1,
                    point: [batch.x[i], batch.y[i], batch.z[i]],
                    surface: f64::NAN,
                    group: group(&batch, i, before + i),
                });
            }
            before += batch.len();
        }
        journal.add_warnings(path, source.warnings());
        if rows.is_empty() && before > 0 {
            return Err(Error::format("all points are withheld")
                .in_file(path)
                .cure("withheld points are deleted ones: name a file with others"));
        }
        let read = Checkpoints {
            rows,
            counted_by: "point",
            columns: None,
            crs,
            unread_crs,
        };
        Ok((read, before))
    }

    /// Returns an error if there are no checkpoints, one is not finite, or a group in vegetation
    /// has none.
    fn check(&self, vegetated: &[String], path: &Path) -> Result<()> {
        if self.rows.is_empty() {
            return Err(Error::format("the file has no points").in_file(path));
        }
        let is_finite = |row: &&CheckpointRow| row.point.iter().all(|c| c.is_finite());
        if let Some(row) = self.rows.iter().find(|row| !is_finite(row)) {
            return Err(
                Error::format("the checkpoint has no height, or is not finite")
                    .at(format!("{} {}", self.counted_by, row.number))
                    .in_file(path)
                    .cure(
                        "leave it out; if a field of a layer has the heights, name it: FILE:FIELD",
                    ),
            );
        }
        check_groups(&self.rows, vegetated, path)
    }

    /// Computes the height of the surface at each checkpoint. Checkpoints outside are a notice.
    ///
    /// # Errors
    /// If all are outside, the surface is damaged, or the run is canceled.
    fn sample(
        &mut self,
        surface: &SurfaceProduct,
        path: &Path,
        options: &AccuracyOptions,
        journal: &Journal,
    ) -> Result<()> {
        let count = self.rows.len() as u64;
        let work = journal.start(Stage::ComputingHeights, Size::Items(count))?;
        let positions: Vec<[f64; 2]> = self
            .rows
            .iter()
            .map(|row| [row.point[0], row.point[1]])
            .collect();
        let samples = surface.with_faces_for(options.method, &journal.context, |faces| {
            Sampler::new(faces, options.method)?.samples(&positions)
        })?;
        for (row, sample) in self.rows.iter_mut().zip(samples) {
            row.surface = sample.height;
        }
        work.add(count)?;
        work.end()?;
        let outside: Vec<u64> = self
            .rows
            .iter()
            .filter(|row| row.surface.is_nan())
            .map(|row| row.number)
            .collect();
        if outside.len() == self.rows.len() {
            return Err(none_inside(count, path, &options.surface));
        }
        if !outside.is_empty() {
            journal.add(Notice::CheckpointsOutside {
                path: path.to_path_buf(),
                counted_by: self.counted_by,
                numbers: outside,
            });
        }
        Ok(())
    }
}

/// Returns an error for a group in vegetation that no checkpoint is in.
fn check_groups(rows: &[CheckpointRow], vegetated: &[String], path: &Path) -> Result<()> {
    let groups = groups_of(rows);
    match vegetated
        .iter()
        .find(|name| !groups.contains(name.as_str()))
    {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = groups.into_iter().collect();
            Err(
                Error::usage(format!("no checkpoint is in the group {name}"))
                    .in_file(path)
                    .cure(format!("the groups are {}", known.join(", "))),
            )
        }
    }
}

fn groups_of(rows: &[CheckpointRow]) -> BTreeSet<&str> {
    rows.iter().filter_map(|row| row.group.as_deref()).collect()
}

/// The differences of checkpoints, by sets.
struct Assessment<'a> {
    /// The differences at the checkpoints of each group that are on the surface.
    groups: BTreeMap<Option<&'a str>, Vec<f64>>,
    vegetated: &'a [String],
    checkpoint_error: f64,
}

impl<'a> Assessment<'a> {
    fn new(rows: &'a [CheckpointRow], vegetated: &'a [String], checkpoint_error: f64) -> Self {
        let mut groups: BTreeMap<Option<&str>, Vec<f64>> = BTreeMap::new();
        for row in rows.iter().filter(|row| !row.difference().is_nan()) {
            let group = groups.entry(row.group.as_deref()).or_default();
            group.push(row.difference());
        }
        Assessment {
            groups,
            vegetated,
            checkpoint_error,
        }
    }

    /// Returns the checkpoints that decide on a class.
    fn decisive(&self) -> CheckpointSet {
        match self.vegetated.is_empty() {
            true => CheckpointSet::All,
            false => CheckpointSet::NonVegetated,
        }
    }

    fn sets(&self) -> Vec<SetAccuracy> {
        let mut sets = vec![CheckpointSet::All];
        if !self.vegetated.is_empty() {
            sets.extend([CheckpointSet::NonVegetated, CheckpointSet::Vegetated]);
        }
        let groups = self.groups.keys().flatten();
        sets.extend(groups.map(|&name| CheckpointSet::Group(name.to_owned())));
        sets.into_iter()
            .filter_map(|set| self.accuracy(set))
            .collect()
    }

    fn accuracy(&self, set: CheckpointSet) -> Option<SetAccuracy> {
        let statistics = ErrorStatistics::of(&self.differences(&set))?;
        Some(SetAccuracy {
            set,
            statistics,
            rmse: statistics.rmse_with(self.checkpoint_error),
        })
    }

    /// Returns the differences at the checkpoints of a set that are on the surface.
    fn differences(&self, set: &CheckpointSet) -> Vec<f64> {
        let is_vegetated = |group: Option<&str>| {
            group.is_some_and(|group| self.vegetated.iter().any(|n| n == group))
        };
        let of_groups = |is_in: &dyn Fn(Option<&str>) -> bool| {
            let groups = self.groups.iter().filter(|(group, _)| is_in(**group));
            groups.flat_map(|(_, group)| group).copied().collect()
        };
        match set {
            CheckpointSet::All => of_groups(&|_| true),
            CheckpointSet::NonVegetated => of_groups(&|group| !is_vegetated(group)),
            CheckpointSet::Vegetated => of_groups(&is_vegetated),
            CheckpointSet::Group(name) => {
                let group = self.groups.get(&Some(name.as_str()));
                group.cloned().unwrap_or_default()
            }
        }
    }
}

/// The measures of a run, in the unit of the heights.
struct Scale {
    class: Option<f64>,
    checkpoint_error: f64,
    unit: Option<Unit>,
}

impl Scale {
    fn new(crs: Option<&Crs>, options: &AccuracyOptions, journal: &Journal) -> Self {
        let units = Units::of(crs);
        let unit = units.height(0.0).unit;
        let measures = [options.class, options.checkpoint_error];
        let is_in_meters =
            |measure: &Option<HeightMeasure>| matches!(measure, Some(HeightMeasure::Meters(_)));
        if unit.is_none() && measures.iter().any(is_in_meters) {
            journal.add(Notice::HeightsInMeters);
        }
        let in_units = |measure: HeightMeasure| match measure {
            HeightMeasure::Meters(meters) => units.height_of_metres(meters),
            HeightMeasure::Units(value) => value,
        };
        let [class, checkpoint_error] = measures.map(|measure| measure.map(in_units));
        Scale {
            class,
            checkpoint_error: checkpoint_error.unwrap_or(0.0),
            unit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_have_a_unit_or_that_of_the_data() {
        let meters = HeightMeasure::Meters;
        for (text, expected) in [
            ("10cm", Some(meters(0.1))),
            ("2 mm", Some(meters(0.002))),
            ("1M", Some(meters(1.0))),
            ("1e-1m", Some(meters(0.1))),
            ("0.5ft", Some(meters(0.1524))),
            ("0.25", Some(HeightMeasure::Units(0.25))),
            ("0", Some(HeightMeasure::Units(0.0))),
            ("cm", None),
            ("-1cm", None),
            ("1km", None),
            ("inf", None),
            ("nan", None),
            ("", None),
        ] {
            let found = text.parse::<HeightMeasure>().ok();
            assert_eq!(found, expected, "{text}");
        }
    }
}
