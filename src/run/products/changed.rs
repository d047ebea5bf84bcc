//! The areas in which two surfaces differ by more than a height.

use super::surface::SurfaceProduct;
use super::volume::{Scale, VolumeUnit};
use crate::crs::Crs;
use crate::data::{Attributes, Layer, Shape, Value};
use crate::error::Result;
use crate::io::Destination;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Stage};
use crate::run::lines::layers;
use crate::terrain::{self, ChangedArea};

/// How often each face is visited.
const VISITS: u64 = 2;

/// Which areas are listed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaOptions {
    /// Areas in which the surfaces differ by more than this height, in the unit of the data.
    pub height: f64,
    /// Smaller areas are left out; in the unit of the result: square meters if units are known.
    pub min_area: f64,
}

/// The areas in which two surfaces differ by more than a height, as polygons.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ChangedAreas {
    /// The areas, those with the largest volumes first. Areas and volumes are in the unit; heights
    /// are in that of the data.
    pub areas: Vec<ChangedArea>,
    /// The unit of volumes, whose squares are that of areas; `None` if no coordinate system is
    /// known: then they are in cubes of the unit of the data.
    pub unit: Option<VolumeUnit>,
    /// How many areas were left out because they are small.
    pub left_out: usize,
    /// The coordinate system of the polygons.
    pub crs: Option<Crs>,
}

/// Finds the areas in which two surfaces in one system differ.
///
/// # Errors
/// Those of [`terrain::changed_areas`], if the system is in degrees, and if the run is canceled.
///
/// # Complexity
/// That of [`terrain::changed_areas`].
pub(super) fn changed_areas(
    [first, second]: [&SurfaceProduct; 2],
    crs: Option<Crs>,
    options: &AreaOptions,
    context: &Context,
) -> Result<ChangedAreas> {
    let scale = Scale::new(crs.as_ref(), None)?;
    let found = first.with_unlinked_faces(context, |first| {
        second.with_unlinked_faces(context, |second| {
            let first = Watched::faces(first, VISITS, Stage::ComparingTriangles, context)?;
            let second = Watched::polled(second, context)?;
            let found = terrain::changed_areas([&first, &second], options.height);
            first.end()?;
            second.end()?;
            found
        })
    })?;
    let all = found.len();
    let scaled = found.into_iter().map(|area| ChangedArea {
        area: area.area * scale.area,
        volume: area.volume * scale.volume,
        ..area
    });
    let areas: Vec<ChangedArea> = scaled
        .filter(|area| area.area >= options.min_area)
        .collect();
    Ok(ChangedAreas {
        left_out: all - areas.len(),
        areas,
        unit: scale.unit,
        crs,
    })
}

impl ChangedAreas {
    /// Returns the areas as polygons with attributes: `CHANGE` (`raised` or `lowered`), `AREA`,
    /// `VOLUME`, `LARGEST`, the largest difference, and where it is, `LARGEST_X` and `LARGEST_Y`.
    pub fn layer(&self) -> Layer {
        let names = [
            "CHANGE",
            "AREA",
            "VOLUME",
            "LARGEST",
            "LARGEST_X",
            "LARGEST_Y",
        ];
        let row = |area: &ChangedArea| {
            let change = if area.is_raised() {
                "raised"
            } else {
                "lowered"
            };
            let [x, y] = area.at;
            let numbers = [area.area, area.volume, area.largest, x, y].map(Value::Number);
            let change = Value::Text(change.to_owned());
            std::iter::once(change).chain(numbers).collect()
        };
        let shape = |area: &ChangedArea| {
            let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|&[x, y]| [x, y, f64::NAN]).collect();
            Shape::Polygon(area.rings.iter().map(ring).collect())
        };
        Layer {
            format: "polygons".to_owned(),
            shapes: self.areas.iter().map(shape).collect(),
            crs: self.crs.clone(),
            fields: names.map(str::to_owned).to_vec(),
            attributes: Some(Attributes {
                names: names.map(str::to_owned).to_vec(),
                rows: self.areas.iter().map(row).collect(),
            }),
            ..Layer::default()
        }
    }

    /// Writes the [polygons](Self::layer) in the format that the extension of `target` names. What
    /// the format cannot keep is a notice.
    ///
    /// # Errors
    /// If the format cannot be written, has no room for the polygons, or the file cannot be
    /// written.
    pub fn write(&self, target: Destination, context: &Context) -> Result<()> {
        layers::write(&self.layer(), target, context)
    }
}
