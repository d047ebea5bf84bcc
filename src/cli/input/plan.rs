//! From the options of a surface to a request.

use std::path::PathBuf;

use super::args::{
    ClassRange, CrossingZArg, DriverArgs, DuplicatesArg, EdgeLength, FrameArgs, LineArgs,
    OnCrossingArg, OutputArgs, ReturnRange, SurfaceArgs, SystemArgs,
};
use super::inputs;
use crate::cli::report::console::Console;
use crate::crs::Crs;
use crate::error::{Error, Result};
use crate::run::{
    Degrees, EdgeLimit, Existing, FlatOptions, FlatRule, FrameOptions, Input, LineRequest,
    LowerEdge, MemoryPoints, ReplacedPoints, Source, SurfaceRequest, SystemOptions, Targets,
    TinRequest, WallOptions, is_of_lines,
};
use crate::terrain::Classes;
use crate::terrain::ground::GroundOptions;

/// The request for a surface, and what is written with all that is made of it.
#[derive(Debug, Clone)]
pub(crate) struct SurfacePlan {
    pub(crate) request: SurfaceRequest,
    /// The tables; no output is named yet.
    pub(crate) targets: Targets,
}

impl SurfacePlan {
    /// Returns the request that the options mean.
    ///
    /// # Errors
    /// If files are missing, kinds of input are mixed or options do not go together.
    pub(crate) fn resolve(args: &SurfaceArgs, console: &Console) -> Result<Self> {
        let files = match args.inputs.as_slice() {
            [] => Vec::new(), // lines alone
            inputs => inputs::expand(inputs, console)?,
        };
        let systems = systems_of(args)?;
        let mut building = TinRequest {
            breaklines: layers(&args.breaklines)?,
            boundary: layers(&args.boundary)?,
            lines: line_request(&args.lines)?,
            ..TinRequest::default()
        };
        building.check_layers()?;
        let source = match Source::of_files(&files)? {
            Source::Points(points) => {
                let (of_lines, points): (Vec<_>, Vec<_>) = points
                    .points
                    .into_iter()
                    .partition(|input| is_of_lines(input.path()));
                for path in of_lines.iter().map(Input::path) {
                    let path = path.to_path_buf();
                    console.note(format_args!("{}: lines are breaklines", path.display()));
                    building.breaklines.push(Input::File(path));
                }
                Source::Points(Box::new(tin_request(points, building, args)))
            }
            Source::Mesh(path) => Source::Mesh(as_it_is(path, args)?),
            Source::Raster(path) => Source::Raster(as_it_is(path, args)?),
        };
        let targets = Targets {
            crossings: args.crossing_report.clone(),
            replaced: args.lines.flat_points.clone(),
            also_read: inputs::lists(&args.inputs).collect(),
            ..Targets::default()
        };
        Ok(SurfacePlan {
            request: SurfaceRequest { source, systems },
            targets,
        })
    }

    /// Returns a request for each input: a surface of its own. The options of building a TIN apply
    /// to all inputs of points. The first input is `given`, if that is there already.
    ///
    /// # Errors
    /// Those of [`resolve`](Self::resolve).
    pub(crate) fn resolve_each(
        args: &SurfaceArgs,
        given: Option<&SurfacePlan>,
        console: &Console,
    ) -> Result<Vec<Self>> {
        let alone = |input: &PathBuf| SurfaceArgs {
            inputs: vec![input.clone()],
            ..args.clone()
        };
        let each: Vec<SurfaceArgs> = args.inputs.iter().map(alone).collect();
        let source = |(i, args): (usize, &SurfaceArgs)| match given.filter(|_| i == 0) {
            Some(plan) => Ok(plan.request.source.clone()),
            None => Source::of_files(&inputs::expand(&args.inputs, console)?),
        };
        let sources = each
            .iter()
            .enumerate()
            .map(source)
            .collect::<Result<Vec<_>>>()?;
        let is_built = |source: &Source| matches!(source, Source::Points(_));
        let any_is_built = sources.iter().any(is_built);
        let plan = |(args, source): (&SurfaceArgs, Source)| match any_is_built && !is_built(&source)
        {
            // The options are for the other one.
            true => Self::as_it_is(source, args),
            false => Self::resolve(args, console),
        };
        let others = each.iter().zip(sources).skip(given.iter().count());
        given
            .cloned()
            .map(Ok)
            .into_iter()
            .chain(others.map(plan))
            .collect()
    }

    /// Returns the request for a surface that is read, whatever options there are of building one.
    fn as_it_is(source: Source, args: &SurfaceArgs) -> Result<Self> {
        let systems = SystemOptions {
            target: None,
            ..systems_of(args)?
        };
        Ok(SurfacePlan {
            request: SurfaceRequest { source, systems },
            targets: Targets {
                also_read: inputs::lists(&args.inputs).collect(),
                ..Targets::default()
            },
        })
    }

    /// Returns the targets with these outputs.
    pub(crate) fn targets(&self, args: &OutputArgs) -> Targets {
        let existing = Existing::of(args.overwrite);
        Targets {
            files: args.output.clone(),
            existing,
            ..self.targets.clone()
        }
    }

    /// Like [`targets`](Self::targets), but a driver of GDAL may write the outputs.
    pub(crate) fn driven_targets(&self, args: &OutputArgs, driver: &DriverArgs) -> Targets {
        Targets {
            driver: driver.options(),
            ..self.targets(args)
        }
    }
}

/// Returns the frame of a raster, with the usual overviews.
///
/// # Errors
/// If the raster to align to does not exist.
pub(crate) fn frame(args: &FrameArgs) -> Result<FrameOptions> {
    inputs::require(&args.align_to)?;
    let extent = args.te.map(|corners| corners.bounds());
    Ok(FrameOptions {
        resolution: args.resolution,
        extent,
        align_to: args.align_to.clone(),
        ..FrameOptions::default()
    })
}

/// Returns the coordinate systems of a surface, and what to do with degrees.
fn systems_of(args: &SurfaceArgs) -> Result<SystemOptions> {
    let degrees = if args.force_degrees {
        Degrees::Allow
    } else {
        Degrees::Refuse
    };
    Ok(SystemOptions {
        degrees,
        ..systems(&args.systems)?
    })
}

/// Returns the coordinate systems that the options name.
///
/// # Errors
/// If one is not known.
pub(crate) fn systems(args: &SystemArgs) -> Result<SystemOptions> {
    Ok(SystemOptions {
        assign: system("--a-srs", args.a_srs.as_deref())?,
        target: system("--t-srs", args.t_srs.as_deref())?,
        transform: (&args.transform).into(),
        ..SystemOptions::default()
    })
}

/// Parses the coordinate system of an option.
///
/// # Errors
/// If it is not known.
pub(crate) fn system(option: &str, typed: Option<&str>) -> Result<Option<Crs>> {
    let Some(text) = typed else { return Ok(None) };
    Crs::from_user(text).map(Some).map_err(|e| {
        let error = Error::usage(format!("{option} {text}: {e}"));
        match e.cure_text() {
            Some(cure) => error.cure(cure.clone()),
            None => error,
        }
    })
}

/// Returns the lines and areas that the options name.
///
/// # Errors
/// If a file is missing.
fn line_request(args: &LineArgs) -> Result<LineRequest> {
    let lower = match (&args.wall_bottom, &args.wall_drop) {
        (Some(height), _) => Some(LowerEdge::Height(height.0.clone())),
        (None, Some(drop)) => Some(LowerEdge::Drop(drop.0.clone())),
        (None, None) => None,
    };
    Ok(LineRequest {
        soft: layers(&args.soft_lines)?,
        draped: layers(&args.draped_lines)?,
        walls: layers(&args.walls)?,
        wall: WallOptions {
            lower,
            width: args.wall_width,
            high: args.wall_high.into(),
        },
        holes: layers(&args.holes)?,
        flats: layers(&args.flat)?,
        flat: FlatOptions {
            height: args
                .flat_height
                .as_ref()
                .map_or(FlatRule::OfShore, |height| height.0.clone()),
            tolerance: args.flat_tolerance,
            buffer: args.flat_buffer,
        },
        rivers: layers(&args.rivers)?,
        river_width: args.river_width.as_ref().map(|width| width.0.clone()),
        densify: args.densify,
        add_ridges: args.add_ridges,
    })
}

fn layers<T>(typed: &[PathBuf]) -> Result<Vec<Input<T>>> {
    let files = inputs::expand_layers(typed)?;
    Ok(files.into_iter().map(Input::File).collect())
}

fn tin_request(
    points: Vec<Input<MemoryPoints>>,
    building: TinRequest,
    args: &SurfaceArgs,
) -> TinRequest {
    let returns = ReturnRange::all(&args.returns);
    TinRequest {
        points,
        read: args.read.options(),
        classes: Classes::of(&ClassRange::all(&args.class), &returns),
        returns,
        ground: args.ground.then(GroundOptions::default),
        bounds: args.bounds.map(|corners| corners.bounds()),
        max_edge: match args.max_edge {
            Some(EdgeLength::None) => EdgeLimit::Unlimited,
            Some(EdgeLength::Auto) => EdgeLimit::Auto,
            Some(EdgeLength::Length(length)) => EdgeLimit::Length(length),
            None => EdgeLimit::Standard,
        },
        max_edge_inside: args.max_edge_inside,
        replaced: match args.lines.flat_points {
            Some(_) => ReplacedPoints::Keep,
            None => ReplacedPoints::Drop,
        },
        duplicates: args.duplicates.into(),
        on_crossing: args.on_crossing.into(),
        crossing_heights: args.crossing_z.into(),
        crossing_tolerance: args.crossing_tolerance,
        ..building
    }
}

/// Returns the path of an input that is a surface already.
///
/// # Errors
/// If an option was typed that is only for building a TIN.
fn as_it_is(path: PathBuf, args: &SurfaceArgs) -> Result<PathBuf> {
    let lines = &args.lines;
    let given = [
        (!args.breaklines.is_empty(), "--breaklines"),
        (!args.boundary.is_empty(), "--boundary"),
        (args.bounds.is_some(), "--bounds"),
        (args.max_edge.is_some(), "--max-edge"),
        (args.max_edge_inside.is_some(), "--max-edge-inside"),
        (lines.flat_points.is_some(), "--flat-points"),
        (lines.densify.is_some(), "--densify"),
        (lines.add_ridges, "--add-ridges"),
        (!args.class.is_empty(), "--class"),
        (!args.returns.is_empty(), "--return"),
        (args.ground, "--ground"),
        (args.duplicates != DuplicatesArg::default(), "--duplicates"),
        (
            args.on_crossing != OnCrossingArg::default(),
            "--on-crossing",
        ),
        (args.crossing_z != CrossingZArg::default(), "--crossing-z"),
        (args.crossing_tolerance.is_some(), "--crossing-tolerance"),
        (args.crossing_report.is_some(), "--crossing-report"),
        (args.systems.t_srs.is_some(), "--t-srs"),
        (args.read.columns.is_some(), "--columns"),
        (args.read.parse.is_some(), "--parse"),
        (args.read.partial, "--partial"),
    ];
    let files = lines
        .files()
        .map(|(option, paths)| (!paths.is_empty(), option));
    match given.iter().chain(&files).find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(Error::usage(format!(
            "{option} is for building a TIN, but the input is a surface already"
        ))
        .in_file(path)
        .cure("leave the option out, or pass the points that the surface was built from")),
        None => Ok(path),
    }
}
