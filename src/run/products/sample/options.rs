//! What is added to points, and where they are written.

use std::io::Write;
use std::path::PathBuf;

use crate::crs::Crs;
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::points::Options;
use crate::terrain::Method;

/// What is added to points. By default, the height.
#[derive(Debug, Clone)]
pub struct SampleOptions {
    /// What is added, in this order.
    pub add: Vec<SampledField>,
    /// What the names of new columns begin with.
    pub prefix: String,
    /// How heights between the vertices of a TIN are computed.
    pub method: Method,
    /// How the file of points is read. Without columns of text, a header or the first two are used.
    pub read: Options,
    /// The coordinate system of these points, whatever their file states.
    pub assign: Option<Crs>,
    /// What messages call the surface, such as the name of its file.
    pub surface: PathBuf,
}

impl Default for SampleOptions {
    fn default() -> Self {
        SampleOptions {
            add: vec![SampledField::Height],
            prefix: String::new(),
            method: Method::Linear,
            read: Options::default(),
            assign: None,
            surface: PathBuf::new(),
        }
    }
}

/// What is added to a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampledField {
    /// The height, as `surface_z`.
    Height,
    /// The slope in degrees above the horizon, as `slope`.
    Slope,
    /// The slope in percent, as `slope_pct`: 100 is 45 degrees.
    SlopePercent,
    /// The direction in which the surface falls, in degrees clockwise from north, as `aspect`; none
    /// where it is level.
    Aspect,
    /// The rise per unit of x and of y, as `gradient_x` and `gradient_y`, in units of the data.
    Gradient,
    /// How far the point is above the surface, as `HeightAboveGround`, which is PDAL's name;
    /// negative below it. Only for points with heights, of LAS and LAZ.
    Above,
}

impl SampledField {
    /// All fields, with the names by which callers ask for them.
    pub const ALL: &'static [(SampledField, &'static str)] = &[
        (SampledField::Height, "height"),
        (SampledField::Slope, "slope"),
        (SampledField::SlopePercent, "slope-percent"),
        (SampledField::Aspect, "aspect"),
        (SampledField::Gradient, "gradient"),
        (SampledField::Above, "height-above"),
    ];

    /// Returns the names of the new columns.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            SampledField::Height => &["surface_z"],
            SampledField::Slope => &["slope"],
            SampledField::SlopePercent => &["slope_pct"],
            SampledField::Aspect => &["aspect"],
            SampledField::Gradient => &["gradient_x", "gradient_y"],
            SampledField::Above => &["HeightAboveGround"],
        }
    }

    /// Returns true if lengths and heights have to be in known proportion.
    pub(super) fn has_lengths(self) -> bool {
        match self {
            SampledField::Height | SampledField::Gradient | SampledField::Above => false,
            SampledField::Slope | SampledField::SlopePercent | SampledField::Aspect => true,
        }
    }
}

impl SampleOptions {
    /// Returns an error if something is added that depends on the heights of the points.
    pub(super) fn require_no_heights(&self) -> Result<()> {
        match self.add.contains(&SampledField::Above) {
            true => Err(Error::unsupported(
                "heights above the surface are added to LAS and LAZ only",
            )
            .cure("save the points as one of these, or add the height of the surface")),
            false => Ok(()),
        }
    }

    /// Returns the names of all new columns.
    pub fn column_names(&self) -> Vec<String> {
        let names = self.add.iter().flat_map(|field| field.columns());
        names.map(|name| format!("{}{name}", self.prefix)).collect()
    }
}

/// Where sampled points are written.
pub enum SampleTarget<'a> {
    /// A file, in the format of the points.
    File(Destination<'a>),
    /// A stream, for points of text and GeoJSON.
    Stream(&'a mut dyn Write),
}
