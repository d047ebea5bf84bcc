//! What the options of a surface mean.

use std::path::{Path, PathBuf};

use super::args::{Corners, CrossingZArg, DuplicatesArg, EdgeLength, OnCrossingArg, SurfaceArgs};
use super::inputs;
use super::open::{self, Content, content};
use super::systems::{self, Degrees, Wish};
use super::talk::Talk;
use crate::error::{Error, Result};
use crate::io::points::Options;
use crate::terrain::{Classes, CrossingRule, DuplicateRule};
use crate::triangulation::OnCrossing;

/// What a surface is made of, and how.
#[derive(Debug)]
pub(super) struct SurfacePlan {
    pub(super) from: From,
    pub(super) wish: Wish,
    /// All files that are read.
    pub(super) inputs: Vec<PathBuf>,
}

/// Where the surface comes from.
#[derive(Debug)]
pub(super) enum From {
    /// It is built.
    Points(Box<PointPlan>),
    /// It is there already.
    Mesh(PathBuf),
    /// It is made of the cells of a raster.
    Raster(PathBuf),
}

/// How a TIN is built.
#[derive(Debug)]
pub(super) struct PointPlan {
    pub(super) files: Vec<PathBuf>,
    pub(super) read: Options,
    pub(super) classes: Classes,
    pub(super) breaklines: Vec<PathBuf>,
    pub(super) boundary: Vec<PathBuf>,
    pub(super) bounds: Option<Corners>,
    /// As typed; the default depends on the coordinate system.
    pub(super) max_edge: Option<EdgeLength>,
    pub(super) duplicates: DuplicateRule,
    pub(super) on_crossing: OnCrossing,
    pub(super) crossing_heights: CrossingRule,
    /// As typed; the default depends on the coordinate system.
    pub(super) crossing_tolerance: Option<f64>,
    pub(super) crossing_report: Option<PathBuf>,
}

impl SurfacePlan {
    /// Works out what was typed.
    ///
    /// # Errors
    /// If files are missing, kinds of input are mixed or options do not go together.
    pub(super) fn resolve(args: &SurfaceArgs, talk: &Talk) -> Result<Self> {
        let files = inputs::expand(&args.inputs, talk)?;
        let wish = Wish {
            assign: systems::parse("--a-srs", args.a_srs.as_deref())?,
            target: systems::parse("--t-srs", args.t_srs.as_deref())?,
            degrees: if args.force_degrees { Degrees::Allow } else { Degrees::Refuse },
        };
        inputs::require(args.breaklines.iter().chain(&args.boundary))?;
        refuse_other_kinds("--breaklines takes lines or polygons", &args.breaklines)?;
        refuse_other_kinds("--boundary takes polygons or closed lines", &args.boundary)?;
        let mut inputs = files.clone();
        inputs.extend(args.breaklines.iter().chain(&args.boundary).cloned());
        let ready = files.iter().find(|path| matches!(content(path), Content::Mesh | Content::Raster));
        let from = match ready {
            None => From::Points(Box::new(PointPlan::new(files, args))),
            Some(path) if files.len() > 1 => {
                return Err(Error::usage("the file is a whole surface, and other files are given with it")
                    .in_file(path)
                    .cure("give one .ply or one raster alone, or points only"));
            }
            Some(path) => {
                refuse_building_options(args, path)?;
                match content(path) {
                    Content::Mesh => From::Mesh(path.clone()),
                    _ => From::Raster(path.clone()),
                }
            }
        };
        Ok(SurfacePlan { from, wish, inputs })
    }

    /// The table of crossings that is written on the way.
    pub(super) fn crossing_report(&self) -> Option<&Path> {
        match &self.from {
            From::Points(points) => points.crossing_report.as_deref(),
            From::Mesh(_) | From::Raster(_) => None,
        }
    }
}

impl PointPlan {
    fn new(files: Vec<PathBuf>, args: &SurfaceArgs) -> Self {
        let classes = match args.class.as_slice() {
            [] => Classes::GroundOrAll,
            classes => Classes::Only(classes.to_vec()),
        };
        let duplicates = match args.duplicates {
            DuplicatesArg::Lowest => DuplicateRule::Lowest,
            DuplicatesArg::Highest => DuplicateRule::Highest,
            DuplicatesArg::Mean => DuplicateRule::Mean,
            DuplicatesArg::First => DuplicateRule::First,
            DuplicatesArg::Last => DuplicateRule::Last,
        };
        let on_crossing = match args.on_crossing {
            OnCrossingArg::Split => OnCrossing::Split,
            OnCrossingArg::Reject => OnCrossing::Reject,
        };
        let crossing_heights = match args.crossing_z {
            CrossingZArg::Lowest => CrossingRule::Choose(DuplicateRule::Lowest),
            CrossingZArg::Highest => CrossingRule::Choose(DuplicateRule::Highest),
            CrossingZArg::Mean => CrossingRule::Choose(DuplicateRule::Mean),
            CrossingZArg::First => CrossingRule::Choose(DuplicateRule::First),
            CrossingZArg::Last => CrossingRule::Choose(DuplicateRule::Last),
            CrossingZArg::Error => CrossingRule::Refuse,
        };
        PointPlan {
            files,
            read: args.read.options(),
            classes,
            breaklines: args.breaklines.clone(),
            boundary: args.boundary.clone(),
            bounds: args.bounds,
            max_edge: args.max_edge,
            duplicates,
            on_crossing,
            crossing_heights,
            crossing_tolerance: args.crossing_tolerance,
            crossing_report: args.crossing_report.clone(),
        }
    }
}

/// What is known to hold no lines or polygons is not handed to a reader of them.
fn refuse_other_kinds(wanted: &str, paths: &[PathBuf]) -> Result<()> {
    for path in paths {
        let what = match content(path) {
            Content::Raster => "a raster",
            Content::Mesh => "a mesh",
            Content::Picture => "a picture",
            Content::Plane => "a file of Triangle's",
            Content::Points if open::is_lidar(path) => "lidar points",
            Content::Points | Content::Layer => continue,
        };
        return Err(Error::usage(format!("{wanted}, this is {what}")).in_file(path));
    }
    Ok(())
}

/// A surface that is there already is taken as it is.
fn refuse_building_options(args: &SurfaceArgs, path: &Path) -> Result<()> {
    let given = [
        (!args.breaklines.is_empty(), "--breaklines"),
        (!args.boundary.is_empty(), "--boundary"),
        (args.bounds.is_some(), "--bounds"),
        (args.max_edge.is_some(), "--max-edge"),
        (!args.class.is_empty(), "--class"),
        (args.duplicates != DuplicatesArg::default(), "--duplicates"),
        (args.on_crossing != OnCrossingArg::default(), "--on-crossing"),
        (args.crossing_z != CrossingZArg::default(), "--crossing-z"),
        (args.crossing_tolerance.is_some(), "--crossing-tolerance"),
        (args.crossing_report.is_some(), "--crossing-report"),
        (args.t_srs.is_some(), "--t-srs"),
        (args.read.columns.is_some(), "--columns"),
        (args.read.parse.is_some(), "--parse"),
        (args.read.partial, "--partial"),
    ];
    match given.iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => {
            Err(Error::usage(format!("{option} is for building a TIN, but the input is a whole surface"))
                .in_file(path)
                .cure("leave the option out, or give the points that the surface was made of"))
        }
        None => Ok(()),
    }
}
