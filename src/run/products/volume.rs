//! Cut and fill between a surface and its base.

use std::path::{Path, PathBuf};

use super::overlaps::overlaps;
use super::surface::{Model, SurfaceProduct};
use super::together::{COMPARE_EXTENTS, no_overlap};
use crate::crs::Crs;
use crate::data::{Layer, Mesh, Surface};
use crate::error::{Error, Result, Setting, wording};
use crate::io::{OnDamage, no_such_field};
use crate::run::context::notice::{Notice, PartlyCounted};
use crate::run::context::units::Units;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Stage};
use crate::run::lines::layers::{self, Layers};
use crate::run::lines::shapes::{self, Rings, at_record};
use crate::run::request::input::Input;
use crate::run::sources::systems::{self, Stated, SystemOptions, reproject_first};
use crate::terrain::{self, Method, Nesting, Sampler, Volume, Zones};

/// How often each face is visited for the volumes of a surface.
const VISITS: u64 = 3;

/// The meters in an international yard.
const YARD: f64 = 0.9144;

/// The meters in a foot.
const FOOT: f64 = 0.3048;

/// The square feet in an acre.
const ACRE: f64 = 43_560.0;

/// The share of the area of a polygon that makes no difference: corners on the rim of a surface, or
/// on another ring, are rounded.
const ROUNDED: f64 = 1e-6;

/// What a surface is compared with.
#[derive(Debug, Clone, Copy)]
pub enum VolumeBase<'a> {
    /// Another surface.
    Surface(&'a SurfaceProduct),
    /// Level planes at these heights, one after another.
    Levels(&'a [f64]),
    /// In each polygon, the triangulation of its vertices, at the heights that the surface has
    /// there: the ground under a stockpile that is outlined at its foot.
    Rim,
}

/// What ground takes when it is dug out and when it is compacted. By default, what it takes in
/// place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bulking {
    /// The volume of loose ground, as a multiple of its volume in place: 1.25 if it swells by a
    /// quarter.
    pub swell: f64,
    /// The volume of compacted ground, as a multiple of its volume in place: 0.9 if it shrinks by a
    /// tenth.
    pub shrink: f64,
}

/// The ground that is moved to get from a surface to its base, in volumes that depend on whether it
/// is in place or loose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Earthwork {
    /// The volume of the cut once it is loose: what is hauled.
    pub loose_cut: f64,
    /// The volume in place of the ground that the fill takes.
    pub bank_fill: f64,
    /// The ground that is left over, in place: the cut minus what the fill takes. Negative if some
    /// is missing.
    pub balance: f64,
}

impl Bulking {
    /// Returns what is moved for a volume.
    fn earthwork(self, of: &Volume) -> Earthwork {
        let bank_fill = of.fill / self.shrink;
        Earthwork {
            loose_cut: of.cut * self.swell,
            bank_fill,
            balance: of.cut - bank_fill,
        }
    }

    /// Returns an error for a factor that no ground has: it may be meant as a percentage, or as the
    /// part that is added.
    fn check(self) -> Result<()> {
        for (factor, setting, [least, most]) in [
            (self.swell, Setting::Swell, [1.0, 5.0]),
            (self.shrink, Setting::Shrink, [0.2, 2.0]),
        ] {
            if !(least..=most).contains(&factor) {
                return Err(Error::usage(wording![
                    "the factor of ",
                    setting,
                    format!(" is {factor}: expected a number from {least} to {most}")
                ])
                .cure("give the volume as a multiple of that in place, such as 1.25 or 0.9"));
            }
        }
        Ok(())
    }
}

/// How volumes are computed. By default, of all of the surface.
#[derive(Debug, Clone, Default)]
pub struct VolumeOptions {
    /// Polygons: each has volumes of its own.
    pub within: Option<Input<Layer>>,
    /// The attribute of these polygons that names them.
    pub name_by: Option<String>,
    /// The coordinate system of these polygons, whatever their file states.
    pub assign: Option<Crs>,
    /// The unit of the result; cubic meters if it is `None` and units are known.
    pub unit: Option<VolumeUnit>,
    /// What ground takes when it is moved; rows then have [`Earthwork`].
    pub bulking: Option<Bulking>,
    /// What messages call the surface and its base, such as the names of their files.
    pub names: [PathBuf; 2],
}

/// A unit of volumes; areas are in its squares, with acre-feet in acres.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VolumeUnit {
    /// Cubic meters.
    CubicMeters,
    /// Cubic yards, of 0.9144 meters.
    CubicYards,
    /// Cubic feet, of 0.3048 meters.
    CubicFeet,
    /// Acre-feet, of 43 560 cubic feet.
    AcreFeet,
}

impl VolumeUnit {
    /// Returns the symbols of volumes and of areas, such as "m3" and "m2".
    pub fn symbols(self) -> [&'static str; 2] {
        match self {
            VolumeUnit::CubicMeters => ["m3", "m2"],
            VolumeUnit::CubicYards => ["yd3", "yd2"],
            VolumeUnit::CubicFeet => ["ft3", "ft2"],
            VolumeUnit::AcreFeet => ["acre-ft", "acre"],
        }
    }

    /// Returns the [symbols](Self::symbols) of a unit, or words if it is not known.
    pub(crate) fn symbols_of(unit: Option<VolumeUnit>) -> [&'static str; 2] {
        unit.map_or(["cubic units", "square units"], VolumeUnit::symbols)
    }

    /// Returns the square meters in its unit of areas, and the meters in its unit of heights.
    fn area_and_height(self) -> [f64; 2] {
        match self {
            VolumeUnit::CubicMeters => [1.0; 2],
            VolumeUnit::CubicYards => [YARD * YARD, YARD],
            VolumeUnit::CubicFeet => [FOOT * FOOT, FOOT],
            VolumeUnit::AcreFeet => [ACRE * FOOT * FOOT, FOOT],
        }
    }
}

/// The volumes in one polygon, or of all of the surface, above one base.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct VolumeRow {
    /// The record of the polygon, counted from 1; `None` if there are no polygons.
    pub record: Option<usize>,
    /// The name of the polygon, if names were asked for; empty if it has none.
    pub name: Option<String>,
    /// The height of the base, if it is level.
    pub level: Option<f64>,
    /// The area of the polygon itself, wherever the surface is; `None` if there are no polygons.
    pub polygon_area: Option<f64>,
    /// The volumes and areas.
    pub volume: Volume,
    /// What is moved, if [`Bulking`] is known.
    pub earthwork: Option<Earthwork>,
}

/// Volumes between a surface and its base.
#[derive(Debug)]
#[non_exhaustive]
pub struct VolumeProduct {
    /// The rows, by level and then by polygon.
    pub rows: Vec<VolumeRow>,
    /// The unit; `None` if no coordinate system is known: then volumes are in cubes of the unit of
    /// the data.
    pub unit: Option<VolumeUnit>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Computes cut and fill between a surface and its base, exactly on the triangles of both; a raster
/// is a surface between the centers of its cells. Where only one of both is, nothing counts but its
/// area.
///
/// Lengths and heights in different units are converted.
///
/// # Errors
/// If the surface and its base have no area in common, or none in any polygon; if the coordinate
/// systems differ or are in degrees, the unit of the result cannot be known, the polygons lack the
/// attribute of their names, a polygon has no area, a level is not finite, or a factor of
/// [`Bulking`] is out of range; if the base is the rim, and there are no polygons or one is not on
/// the surface; if a file is damaged, and if the run is canceled.
///
/// # Complexity
/// That of [`terrain::volumes`](crate::terrain::volumes), once for each level, or for each outline
/// if the base is the rim.
pub fn volume(
    surface: &SurfaceProduct,
    base: VolumeBase<'_>,
    options: &VolumeOptions,
    context: &Context,
) -> Result<VolumeProduct> {
    let journal = Journal::new(context);
    context.check()?;
    options.bulking.map_or(Ok(()), Bulking::check)?;
    let layers = match (&options.within, &options.name_by) {
        (Some(within), Some(_)) => vec![layers::read_whole(within, &journal)?],
        (within, _) => layers::read(within.as_slice(), &[], OnDamage::Refuse, &journal)?,
    };
    let crs = common_system(surface, base, &layers, options, &journal)?;
    let scale = Scale::new(crs.as_ref(), options.unit)?;
    let name_by = options.name_by.as_deref();
    let outlines = layers
        .first()
        .map(|layer| Outlines::read(layer, name_by))
        .transpose()?;
    let computing = Computing {
        outlines: outlines.as_ref(),
        height_unit: scale.height_unit,
        context,
    };
    let mut rows = surface.with_unlinked_faces(context, |faces| match base {
        VolumeBase::Surface(base) => {
            base.with_unlinked_faces(context, |base| computing.above_surface(faces, base))
        }
        VolumeBase::Levels(levels) => computing.above_levels(faces, levels),
        VolumeBase::Rim => computing.above_rims(faces),
    })?;
    for row in &mut rows {
        row.volume = scale.applied(&row.volume);
        row.polygon_area = row.polygon_area.map(|area| area * scale.area);
        row.earthwork = options
            .bulking
            .map(|bulking| bulking.earthwork(&row.volume));
    }
    require_any(&rows, outlines.as_ref(), base, &options.names)?;
    note_overlaps(surface, &options.names[0], &journal);
    if let VolumeBase::Surface(base) = base {
        note_overlaps(base, &options.names[1], &journal);
    }
    if let Some(outlines) = &outlines {
        outlines.note_flaws(&rows, scale.unit, &journal);
    }
    Ok(VolumeProduct {
        rows,
        unit: scale.unit,
        notices: journal.take(),
    })
}

/// Returns an error if two surfaces, or the surface and all polygons, have nothing in common.
fn require_any(
    rows: &[VolumeRow],
    outlines: Option<&Outlines>,
    base: VolumeBase,
    names: &[PathBuf; 2],
) -> Result<()> {
    if rows.iter().any(|row| row.volume.common_area > 0.0) {
        return Ok(());
    }
    match (outlines, base) {
        (Some(outlines), _) => Err(Error::usage(
            "no polygon is where the surface and its base are",
        )
        .in_file(outlines.path)
        .cure(COMPARE_EXTENTS)),
        (None, VolumeBase::Surface(_)) => Err(no_overlap(names)),
        // A mesh may stand upright.
        (None, VolumeBase::Levels(_) | VolumeBase::Rim) => Ok(()),
    }
}

/// Adds a notice if faces of a mesh overlap: those of a TIN and of a raster do not.
fn note_overlaps(product: &SurfaceProduct, name: &Path, journal: &Journal) {
    if let Model::Mesh(mesh) = &product.model
        && let Some(first) = overlaps(mesh.as_ref()).first()
    {
        journal.add(Notice::FacesOverlap(name.to_path_buf(), first.to_string()));
    }
}

/// Returns the coordinate system of the surface, its base and the polygons, if any states one.
fn common_system(
    surface: &SurfaceProduct,
    base: VolumeBase,
    layers: &Layers,
    options: &VolumeOptions,
    journal: &Journal,
) -> Result<Option<Crs>> {
    let [of_surface, of_base] = &options.names;
    let mut stated = vec![surface.stated(of_surface)];
    if let VolumeBase::Surface(base) = base {
        stated.push(base.stated(of_base));
    }
    for (path, layer) in layers {
        stated.push(Stated::by_layer(path, layer).assigned(options.assign.as_ref(), journal));
    }
    Ok(systems::unify(&stated, &SystemOptions::default(), journal)?.crs)
}

/// The factors that convert areas and volumes from the units of the data.
pub(super) struct Scale {
    pub(super) area: f64,
    pub(super) volume: f64,
    /// The unit of the heights in units of the plan.
    pub(super) height_unit: f64,
    pub(super) unit: Option<VolumeUnit>,
}

impl Scale {
    pub(super) fn new(crs: Option<&Crs>, asked: Option<VolumeUnit>) -> Result<Self> {
        let units = Units::of(crs);
        match (units.in_metres(), crs) {
            (Some([plan, height]), _) => {
                let unit = asked.unwrap_or(VolumeUnit::CubicMeters);
                let [of_area, of_height] = unit.area_and_height();
                let area = plan * plan / of_area;
                Ok(Scale {
                    area,
                    volume: area * (height / of_height),
                    height_unit: height / plan,
                    unit: Some(unit),
                })
            }
            (None, Some(crs)) => Err(Error::unsupported(format!(
                "the coordinates are in degrees ({crs}), which have no area"
            ))
            .cure(reproject_first())),
            (None, None) if asked.is_some() => Err(Error::usage(
                "no coordinate system is known, so volumes cannot be converted to a unit",
            )
            .cure(wording![
                "state the system with ",
                Setting::Crs.text("CRS"),
                ", or leave out ",
                Setting::Unit
            ])),
            (None, None) => Ok(Scale {
                area: 1.0,
                volume: 1.0,
                height_unit: 1.0,
                unit: None,
            }),
        }
    }

    fn applied(&self, of: &Volume) -> Volume {
        Volume {
            cut: of.cut * self.volume,
            fill: of.fill * self.volume,
            cut_area: of.cut_area * self.area,
            fill_area: of.fill_area * self.area,
            common_area: of.common_area * self.area,
            surface_only_area: of.surface_only_area * self.area,
            base_only_area: of.base_only_area * self.area,
            slope_area: of.slope_area * self.area,
        }
    }
}

/// The polygons of a layer.
struct Outlines<'a> {
    path: &'a Path,
    /// Their records, counted from 1.
    records: Vec<usize>,
    /// Their names, if these were asked for.
    names: Option<Vec<String>>,
    rings: Vec<Rings>,
    zones: Zones,
    /// The records of polygons whose rings overlap each other.
    overlapping: Vec<usize>,
}

impl<'a> Outlines<'a> {
    fn read(
        (path, layer): &'a (&Path, std::borrow::Cow<'_, Layer>),
        name_by: Option<&str>,
    ) -> Result<Self> {
        let polygons = shapes::outlines(layer, path, Setting::Within)?;
        let (records, rings): (Vec<usize>, Vec<Rings>) = polygons
            .into_iter()
            .map(|polygon| (polygon.record, polygon.rings))
            .unzip();
        let zones = Zones::new(&rings).map_err(|e| e.in_file(path))?;
        if let Some(empty) = (0..records.len()).find(|&zone| zones.is_empty(zone)) {
            let error =
                Error::format("the polygon has no area").cure("repair or remove the record");
            return Err(at_record(error, path, records[empty]));
        }
        let names = name_by
            .map(|field| names_of(layer, field, &records))
            .transpose()
            .map_err(|e| e.in_file(path))?;
        let overlap = |zone: usize| Nesting::of(&rings[zone]).map(|found| found.overlap);
        let mut overlapping = Vec::new();
        for (zone, &record) in records.iter().enumerate() {
            if overlap(zone).map_err(|e| at_record(e, path, record))? > ROUNDED * zones.area(zone) {
                overlapping.push(record);
            }
        }
        Ok(Outlines {
            path,
            records,
            names,
            rings,
            zones,
            overlapping,
        })
    }

    /// Adds notices of the polygons whose rings overlap, in which there is nothing, or that are
    /// only in part where the surface and its base are.
    fn note_flaws(&self, rows: &[VolumeRow], unit: Option<VolumeUnit>, journal: &Journal) {
        if !self.overlapping.is_empty() {
            let records = self.overlapping.clone();
            journal.add(Notice::RingsOverlap(self.path.to_path_buf(), records));
        }
        // All levels have the same areas.
        let rows = rows.iter().take(self.records.len());
        let areas = rows.filter_map(|row| {
            let counted = row.volume.common_area;
            Some((row.record?, row.polygon_area?, counted))
        });
        let (outside, others): (Vec<_>, Vec<_>) =
            areas.partition(|(_, _, counted)| *counted == 0.0);
        if !outside.is_empty() {
            let records = outside.into_iter().map(|(record, ..)| record).collect();
            journal.add(Notice::PolygonsOutside(self.path.to_path_buf(), records));
        }
        let partly = others
            .into_iter()
            .filter(|(_, area, counted)| *counted < (1.0 - ROUNDED) * area)
            .map(|(record, area, counted)| PartlyCounted {
                record,
                area,
                counted,
            });
        let partly: Vec<_> = partly.collect();
        if !partly.is_empty() {
            journal.add(Notice::PolygonsPartlyOutside {
                path: self.path.to_path_buf(),
                partly,
                unit: VolumeUnit::symbols_of(unit)[1],
            });
        }
    }
}

/// Returns the values of an attribute of some records.
///
/// # Errors
/// If the layer has no attribute of this name.
fn names_of(layer: &Layer, field: &str, records: &[usize]) -> Result<Vec<String>> {
    let kept = layer.attributes.as_ref();
    let known = kept.map_or(&[][..], |attributes| &attributes.names);
    let texts = kept
        .and_then(|attributes| attributes.texts(field))
        .ok_or_else(|| no_such_field(field, known.iter().map(String::as_str)))?;
    let value = |record: &usize| texts.get(record.checked_sub(1)?).cloned();
    Ok(records
        .iter()
        .map(|record| value(record).unwrap_or_default())
        .collect())
}

/// What volumes are computed in, and under which context.
struct Computing<'a> {
    outlines: Option<&'a Outlines<'a>>,
    /// The unit of the heights in units of the plan.
    height_unit: f64,
    context: &'a Context<'a>,
}

impl Computing<'_> {
    fn above_surface(&self, surface: &dyn Surface, base: &dyn Surface) -> Result<Vec<VolumeRow>> {
        // Most of the time passes with the larger one.
        let is_swapped = surface.face_count() < base.face_count();
        let watched = |surface, is_larger: bool| match is_larger {
            true => Watched::faces(surface, VISITS, Stage::ComputingVolumes, self.context),
            false => Watched::polled(surface, self.context),
        };
        let surface = watched(surface, !is_swapped)?;
        let base = watched(base, is_swapped)?;
        let found = self.volumes(&surface, terrain::VolumeBase::Surface(&base), self.zones())?;
        surface.end()?;
        base.end()?;
        Ok(self.rows(None, found).collect())
    }

    fn above_levels(&self, surface: &dyn Surface, levels: &[f64]) -> Result<Vec<VolumeRow>> {
        let visits = VISITS * levels.len() as u64;
        let watched = Watched::faces(surface, visits, Stage::ComputingVolumes, self.context)?;
        let mut rows = Vec::new();
        for &level in levels {
            let found = self.volumes(&watched, terrain::VolumeBase::Level(level), self.zones())?;
            rows.extend(self.rows(Some(level), found));
        }
        watched.end()?;
        Ok(rows)
    }

    fn above_rims(&self, surface: &dyn Surface) -> Result<Vec<VolumeRow>> {
        let Some(Outlines {
            path,
            records,
            names,
            rings,
            ..
        }) = self.outlines
        else {
            return Err(
                Error::usage("the base is the rim of polygons, but there are none").cure(wording![
                    "name the outlines with ",
                    Setting::Within.text("FILE")
                ]),
            );
        };
        let visits = VISITS * records.len() as u64;
        let watched = Watched::faces(surface, visits, Stage::ComputingVolumes, self.context)?;
        let sampler = Sampler::new(surface, Method::Linear)?;
        let mut rows = Vec::new();
        for (zone, (&record, rings)) in records.iter().zip(rings).enumerate() {
            let outline = Zones::new(std::slice::from_ref(rings))?;
            let base = rim_base(&outline, &sampler).map_err(|e| at_record(e, path, record))?;
            let above = terrain::VolumeBase::Surface(&base);
            let found = self.volumes(&watched, above, Some(&outline))?;
            rows.extend(found.into_iter().map(|volume| VolumeRow {
                record: Some(record),
                name: names.as_ref().map(|names| names[zone].clone()),
                level: None,
                polygon_area: Some(outline.area(0)),
                volume: volume.level_within_rounding(&base),
                earthwork: None,
            }));
        }
        watched.end()?;
        Ok(rows)
    }

    fn volumes(
        &self,
        surface: &dyn Surface,
        base: terrain::VolumeBase<'_>,
        zones: Option<&Zones>,
    ) -> Result<Vec<Volume>> {
        terrain::volumes(surface, base, zones, self.height_unit)
    }

    fn zones(&self) -> Option<&Zones> {
        self.outlines.map(|outlines| &outlines.zones)
    }

    fn rows(
        &self,
        level: Option<f64>,
        found: Vec<Volume>,
    ) -> impl Iterator<Item = VolumeRow> + use<'_> {
        found
            .into_iter()
            .enumerate()
            .map(move |(zone, volume)| VolumeRow {
                record: self.outlines.map(|outlines| outlines.records[zone]),
                name: self
                    .outlines
                    .and_then(|of| Some(of.names.as_ref()?[zone].clone())),
                level,
                polygon_area: self.outlines.map(|of| of.zones.area(zone)),
                volume,
                earthwork: None,
            })
    }
}

/// Returns the triangles of a polygon, at the heights of a surface.
///
/// # Errors
/// If a vertex is not on the surface.
fn rim_base(zone: &Zones, surface: &Sampler<'_, dyn Surface + '_>) -> Result<Mesh> {
    let corners: Vec<[f64; 2]> = zone.triangles().flatten().collect();
    let mut vertices = Vec::with_capacity(corners.len());
    for (sample, [x, y]) in surface.samples(&corners)?.iter().zip(corners) {
        if !sample.is_some() {
            let error = format!("the outline leaves the surface at {x} {y}");
            return Err(Error::format(error).cure("draw the outline within the surface"));
        }
        vertices.push([x, y, sample.height]);
    }
    let faces = (0..vertices.len() as u32 / 3)
        .map(|face| [0, 1, 2].map(|k| 3 * face + k))
        .collect();
    Mesh::new(vertices, faces, &[], None)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::error::Kind;
    use crate::run::context::{Monitor, Progress, Size};

    /// Cancels the run as soon as volumes are computed.
    struct Cancels<'a>(&'a AtomicBool);

    impl Monitor for Cancels<'_> {
        fn start(&self, stage: Stage, _: Size) -> Box<dyn Progress> {
            self.0
                .fetch_or(stage == Stage::ComputingVolumes, Ordering::Relaxed);
            Box::new(())
        }

        fn notice(&self, _: &Notice) {}
    }

    #[test]
    fn a_canceled_run_returns_no_volumes() {
        let corners = vec![[0.0, 0.0, 1.0], [9.0, 0.0, 2.0], [0.0, 9.0, 3.0]];
        let mesh = Mesh::new(corners, vec![[0, 1, 2]], &[], None).unwrap();
        let product = SurfaceProduct::from(Model::Mesh(Box::new(mesh)));
        let bases = [
            VolumeBase::Surface(&product),
            VolumeBase::Levels(&[1.0, 2.0]),
        ];
        for base in bases {
            let options = VolumeOptions::default();
            let done = volume(&product, base, &options, &Context::default()).unwrap();
            assert_eq!(done.rows[0].volume.common_area, 40.5);
            let cancel = AtomicBool::new(false);
            let context = Context {
                monitor: &Cancels(&cancel),
                cancel: &cancel,
            };
            let error = volume(&product, base, &options, &context).unwrap_err();
            assert_eq!(error.kind(), Kind::Canceled);
        }
    }
}
