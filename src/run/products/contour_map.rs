//! Contours of a surface for a map: lines, the areas between them, and labels.

use super::contour::ContourOptions;
use super::map_options::MapOptions;
use super::surface::{Model, SurfaceProduct};
use crate::crs::Crs;
use crate::data::{Attributes, Layer, Shape, Value};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::contours::{self, ContourSummary, MapSheet};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::lines::layers;
use crate::run::sources::systems::reproject_first;
use crate::run::sources::tin_parts;
use crate::terrain::{self, ContourLabel, LabelRules, MapContours, MapLine, MapRules};

/// Contours for a map, with what belongs to them.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ContourMap {
    /// The lines, and the areas between them if they were asked for.
    pub contours: MapContours,
    /// The labels, if they were asked for.
    pub labels: Vec<ContourLabel>,
    /// The coordinate system.
    pub crs: Option<Crs>,
    /// What was assumed, in the order in which it was found.
    pub notices: Vec<Notice>,
    options: MapOptions,
    /// The height of labels, in plan.
    text_height: f64,
}

/// What was written of a map, counted.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct MapSummary {
    /// The lines that were drawn.
    pub drawn: ContourSummary,
    /// The number of lines that were left out.
    pub left_out: usize,
    /// The largest difference between the height of a line and the surface along it, in the unit of
    /// heights; `None` if lines are exact.
    pub deviation: Option<f64>,
    /// The number of areas, if they were asked for.
    pub bands: Option<usize>,
    /// The number of labels, if they were asked for.
    pub labels: Option<usize>,
}

/// Draws contours for a map.
///
/// # Errors
/// If a level or a rule is not valid, the coordinates are in degrees or in another unit than the
/// heights while a rule has lengths, there is not enough memory, the surface is damaged, or the run
/// is canceled.
///
/// # Complexity
/// That of [`terrain::map_contours`]. A surface in parts stays in its files; the lines, and about
/// 100 bytes for each vertex, are in memory.
pub fn contour_map(
    surface: &SurfaceProduct,
    options: &ContourOptions,
    context: &Context,
) -> Result<ContourMap> {
    let journal = Journal::new(context);
    context.check()?;
    let levels = options.to_levels()?;
    let map = &options.map;
    map.check()?;
    let rules = map.to_rules(&levels);
    rules.check(&levels)?;
    let lengths = MapRules {
        with_bands: false,
        keep_depressions: false,
        ..rules
    };
    if lengths != MapRules::default() || map.labels.is_some() {
        require_lengths(surface.crs())?;
    }
    options
        .notice(surface.crs())
        .into_iter()
        .for_each(|notice| journal.add(notice));
    let heights = Units::of(surface.crs());
    let tolerance = rules.tolerance(&levels);
    let extent = surface.extent();
    if !rules.has_digits(&levels, &extent) {
        journal.add(Notice::CoarseCoordinates {
            largest: (0..3).map(|axis| extent.largest(axis)).fold(0.0, f64::max),
            tolerance: heights.height(tolerance),
        });
    }
    let exact = match &surface.model {
        // Lines that end at vertices are joined by what parts know of these.
        Model::Parts(parts) if rules.keeps_exact() => {
            Some(tin_parts::contours(parts, &levels, context)?)
        }
        _ => None,
    };
    let contours = surface.with_linked_faces(context, |faces| {
        if !rules.keeps_exact() {
            memory::require_for_smoothing(faces.vertex_count())?;
        }
        let size = match terrain::map_work(faces, &rules) {
            0 => Size::Uncounted,
            work => Size::Items(work),
        };
        let finding = context.start(Stage::FindingContours, size)?;
        let polled = Watched::polled(faces, context)?;
        // Most calls only ask whether to go on.
        let go_on = |work| match work {
            0 => context.check(),
            _ => finding.add(work),
        };
        let found = match exact {
            Some(lines) => terrain::map_of_contours(&polled, lines, &levels, &rules),
            None => terrain::map_contours_while(&polled, &levels, &rules, &go_on),
        };
        // A run that was canceled ends the surface early, which may look like an error.
        polled.end()?;
        let found = found?;
        finding.end()?;
        Ok(found)
    })?;
    if contours.deviation > tolerance {
        journal.add(Notice::BeyondTolerance {
            deviation: heights.height(contours.deviation),
            tolerance: heights.height(tolerance),
        });
    }
    let index_step = map.index_step();
    let label_rules = LabelRules::of_interval(levels.interval());
    let text_height = map.label_height.unwrap_or(label_rules.height);
    let labels = map.labels.map(|tops| {
        let rules = LabelRules {
            height: text_height,
            tops,
            ..label_rules
        };
        let is_labeled = |line: &MapLine| index_step.is_none_or(|step| is_index(line, step));
        terrain::contour_labels(&contours.lines, is_labeled, &rules)
    });
    Ok(ContourMap {
        contours,
        labels: labels.unwrap_or_default(),
        crs: surface.crs().cloned(),
        notices: journal.take(),
        options: *map,
        text_height,
    })
}

/// Returns an error if lengths in plan and heights are not in one unit.
fn require_lengths(crs: Option<&Crs>) -> Result<()> {
    let units = Units::of(crs);
    if units.is_angular() {
        return Err(Error::unsupported(
            "the coordinates are in degrees: contours for maps need lengths",
        )
        .cure(reproject_first()));
    }
    match units.disagreement() {
        Some((plan, height)) => Err(Error::unsupported(format!(
            "the plan is in {plan} and heights in {height}: contours for maps need one unit for both"
        ))
        .cure(reproject_first())),
        None => Ok(()),
    }
}

fn is_index(line: &MapLine, step: u32) -> bool {
    line.number.rem_euclid(i64::from(step.max(1))) == 0
}

fn layer(
    format: &str,
    crs: &Option<Crs>,
    names: &[&str],
    records: impl Iterator<Item = (Shape, Vec<Value>)>,
) -> Layer {
    let (mut shapes, mut rows) = (Vec::new(), Vec::new());
    for (i, (shape, mut row)) in records.enumerate() {
        row.insert(0, Value::Whole(i as i64 + 1));
        shapes.push(shape);
        rows.push(row);
    }
    let names: Vec<String> = std::iter::once(&"ID")
        .chain(names)
        .map(|&name| name.to_owned())
        .collect();
    Layer {
        format: format.to_owned(),
        shapes,
        crs: crs.clone(),
        fields: names.clone(),
        attributes: Some(Attributes { names, rows }),
        ..Layer::default()
    }
}

impl ContourMap {
    /// Returns the lines with attributes: `ID` (from 1), `ELEV`, `DEPRESSION` (1 for a ring with
    /// lower ground inside, else 0) and, if index contours are marked, `INDEX` (1 or 0). Vertices
    /// have the height of their line, unless they were asked for without heights.
    pub fn lines(&self) -> Layer {
        let index_step = self.options.index_step();
        let record = |of: &MapLine| {
            let level = of.line.level;
            let z = self.height(level);
            let points = of.line.points.iter().map(|&[x, y]| [x, y, z]).collect();
            let mut row = vec![
                Value::Number(level),
                Value::Whole(i64::from(of.is_depression)),
            ];
            let index = index_step.map(|step| is_index(of, step));
            row.extend(index.map(|is_index| Value::Whole(i64::from(is_index))));
            (Shape::Lines(vec![points]), row)
        };
        let names = ["ELEV", "DEPRESSION", "INDEX"];
        let names = &names[..if index_step.is_some() { 3 } else { 2 }];
        layer(
            "contours",
            &self.crs,
            names,
            self.contours.lines.iter().map(record),
        )
    }

    /// Returns the height of a vertex at a level.
    fn height(&self, level: f64) -> f64 {
        match self.options.without_heights {
            true => f64::NAN,
            false => level,
        }
    }

    /// Returns the areas between the lines as polygons with attributes: `ID`, `ELEV_MIN` and
    /// `ELEV_MAX`, the names that `gdal_contour -p` has.
    pub fn bands(&self) -> Layer {
        let record = |band: &terrain::Band| {
            let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|&[x, y]| [x, y, f64::NAN]).collect();
            let row = [band.low, band.high].map(Value::Number).to_vec();
            (Shape::Polygon(band.rings.iter().map(ring).collect()), row)
        };
        let bands = self.contours.bands.iter().map(record);
        layer("bands", &self.crs, &["ELEV_MIN", "ELEV_MAX"], bands)
    }

    /// Returns the labels as points with attributes: `ID`, `ELEV` and `ROTATION`, the direction of
    /// the text in degrees counter-clockwise from the x axis.
    pub fn labels(&self) -> Layer {
        let record = |label: &ContourLabel| {
            let [x, y] = label.at;
            let row = [label.level, label.rotation].map(Value::Number).to_vec();
            (Shape::Points(vec![[x, y, self.height(label.level)]]), row)
        };
        let labels = self.labels.iter().map(record);
        layer("labels", &self.crs, &["ELEV", "ROTATION"], labels)
    }

    /// Returns the counts.
    pub fn summary(&self) -> MapSummary {
        let mut drawn = ContourSummary::default();
        for line in &self.contours.lines {
            drawn.add(&line.line);
        }
        let options = &self.options;
        MapSummary {
            left_out: self.contours.traced - drawn.lines,
            drawn,
            deviation: options.moves_lines().then_some(self.contours.deviation),
            bands: options.bands.then_some(self.contours.bands.len()),
            labels: options.labels.map(|_| self.labels.len()),
        }
    }

    /// Writes the areas if they were asked for, else the lines, in the format that the extension of
    /// `target` names. What the format cannot keep is a notice.
    ///
    /// # Errors
    /// If the format cannot be written, has no room for them, or the file cannot be written.
    pub fn write(&self, target: Destination, context: &Context) -> Result<()> {
        self.write_shapes(None, target, context)
    }

    /// Like [`write`](Self::write), with the labels in the same file: GeoPackage has a second layer
    /// for them, and DXF texts.
    ///
    /// # Errors
    /// Those of [`write`](Self::write).
    pub fn write_with_labels(&self, target: Destination, context: &Context) -> Result<()> {
        let labels = self.labels();
        self.write_shapes(Some(&labels), target, context)
    }

    fn write_shapes(
        &self,
        labels: Option<&Layer>,
        target: Destination,
        context: &Context,
    ) -> Result<()> {
        let shapes = match self.options.bands {
            true => {
                contours::require_areas(target)?;
                self.bands()
            }
            false => self.lines(),
        };
        self.write_sheet([Some(&shapes), labels], target, context)
    }

    fn write_sheet(
        &self,
        [shapes, labels]: [Option<&Layer>; 2],
        target: Destination,
        context: &Context,
    ) -> Result<()> {
        let sheet = MapSheet {
            shapes,
            labels,
            text_height: self.text_height,
        };
        let path = target.path();
        let warnings = target.put_whole(|target| contours::write_map(target, &sheet))?;
        layers::note_warnings(path, warnings, context);
        Ok(())
    }

    /// Writes the labels: as texts in a drawing, else as points.
    ///
    /// # Errors
    /// If the format cannot be written, or the file cannot be written.
    pub fn write_labels(&self, target: Destination, context: &Context) -> Result<()> {
        self.write_sheet([None, Some(&self.labels())], target, context)
    }
}
