use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::parse::{Corners, altitude, finite, positive, smallest_angle};
use super::{ReadArgs, SurfaceArgs};
use crate::cli::classes;
use crate::triangulation::OnCrossing;

/// Where the result goes.
#[derive(Debug, Clone, Args)]
pub(in crate::cli) struct OutputArgs {
    /// File to write, format by extension (repeatable)
    ///
    /// All files of a run appear at its end, or none. Pipes and devices, such as `/dev/stdout`, are written directly.
    #[arg(short, long, required = true, value_name = "OUT")]
    pub(in crate::cli) output: Vec<PathBuf>,

    /// Replace files that exist
    ///
    /// They keep their mode; a symbolic link is followed, a read-only file refused.
    #[arg(long)]
    pub(in crate::cli) overwrite: bool,
}

/// Size and place of a raster.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Raster")]
pub(in crate::cli) struct FrameArgs {
    /// Size of a cell [default: 1]
    ///
    /// In the units of the coordinate system. Cells start at multiples of it, so that neighboring
    /// rasters fit together.
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(in crate::cli) resolution: Option<f64>,

    /// Extent of the raster [default: that of the surface]
    ///
    /// Grown outward to whole cells. With commas or blanks between the values.
    #[arg(long, value_name = "XMIN,YMIN,XMAX,YMAX", allow_hyphen_values = true)]
    pub(in crate::cli) te: Option<Corners>,

    /// Raster whose cells are to be matched
    ///
    /// The cells are those of its grid, continued beyond its edges; the extent is that of the
    /// surface, or of `--te`.
    #[arg(long, value_name = "RASTER", conflicts_with = "resolution")]
    pub(in crate::cli) align_to: Option<PathBuf>,
}

/// Tell what is in files: counts, bounds, classes, coordinate system, defects
///
/// Points, vector layers, rasters and meshes, each read to its end. A file that cannot be read is
/// reported, the others are shown all the same, and the exit code is 1.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline info tile.laz edges.shp dem.tif
  breakline info --json tiles/*.laz | jq '.[].count'")]
pub(in crate::cli) struct InfoArgs {
    /// Files, globs, `@list.txt` or `-`
    #[arg(required = true, value_name = "FILE")]
    pub(in crate::cli) files: Vec<PathBuf>,

    /// Print a JSON array, one object a file, with exact numbers
    #[arg(long)]
    pub(in crate::cli) json: bool,

    #[command(flatten)]
    pub(in crate::cli) read: ReadArgs,
}

/// Select, clip and merge points, with all that their files say of them
///
/// Points come in the order of the files. From LAS and LAZ to LAS and LAZ every byte of a point record stays: times, colors,
/// extra bytes; coordinate system and other records of the first file come along. Files of different point formats, extra
/// bytes, kinds of GPS time or coordinate systems do not go into one, nor do waveforms. Of different scales and offsets the
/// first is taken that has the points of all; where there is none, `--round` is needed. To .xyz, .txt and .csv go the
/// coordinates, to .csv the class, too.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline points tiles/*.laz --class ground,water --boundary site.shp -o site.laz
  breakline points a.las b.las -o merged.laz")]
pub(in crate::cli) struct PointsArgs {
    /// Files, globs, `@list.txt` or `-` (stdin)
    ///
    /// Points from LAS, LAZ, COPC, text (x y z) and vector layers; LAS and LAZ are written from LAS, LAZ and COPC only.
    #[arg(required = true, value_name = "IN")]
    pub(in crate::cli) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,

    /// Classes to write, as `2,8` or `ground` [default: all]
    ///
    /// Points of formats without classes are always written.
    #[arg(long, value_name = "CLASS,..", value_parser = classes::parse, value_delimiter = ',', help_heading = "Selection")]
    pub(in crate::cli) class: Vec<u8>,

    /// Return numbers to write, as `1,2` [default: all]
    #[arg(long = "return", value_name = "N,..", value_delimiter = ',', help_heading = "Selection")]
    pub(in crate::cli) returns: Vec<u8>,

    /// Leave out points that are marked as withheld
    #[arg(long, help_heading = "Selection")]
    pub(in crate::cli) drop_withheld: bool,

    /// Clip to a rectangle, its border included
    #[arg(long, value_name = "XMIN,YMIN,XMAX,YMAX", allow_hyphen_values = true, help_heading = "Selection")]
    pub(in crate::cli) bounds: Option<Corners>,

    /// Clip to polygons, their borders included (repeatable)
    ///
    /// What is inside of any polygon stays. Lines are taken for one polygon if they close to rings.
    #[arg(long, value_name = "FILE", help_heading = "Selection")]
    pub(in crate::cli) boundary: Vec<PathBuf>,

    /// Move coordinates to the nearest step of the first file's scale
    ///
    /// For files whose scales and offsets do not go together; by half a step at most.
    #[arg(long, help_heading = "Selection")]
    pub(in crate::cli) round: bool,

    #[command(flatten)]
    pub(in crate::cli) read: ReadArgs,
}

/// Build a TIN of points and breaklines
///
/// Every breakline is there, edge by edge; between them the triangulation is Delaunay, and the same
/// whatever the order of the input. Formats: .ply (binary, with breaklines and coordinate system;
/// what `dem`, `contour`, `hillshade`, `check` and `info` read back), .obj, .off, .stl (from a local
/// origin, which is printed and written beside it).
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline tin tiles/*.laz --breaklines edges.shp --boundary site.shp -o ground.ply")]
pub(in crate::cli) struct TinArgs {
    #[command(flatten)]
    pub(in crate::cli) surface: SurfaceArgs,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,
}

/// Triangulate points and segments of the plane, with Triangle's files
///
/// Reads a .node or .poly file of Triangle (Shewchuk) and writes its constrained Delaunay triangulation;
/// points are added only where segments cross, unless angles or areas are asked for. Of a .poly with segments, what is outside of its outer
/// boundary or in a hole is eaten away; regional attributes go to the triangles. Vertices keep their
/// numbers, attributes and markers; those at the place of an earlier one have no triangle.
///
/// An .ele comes with its .node (and, of a .poly, its .poly) beside it, as Triangle writes them; .poly
/// and .edge come with their .node. Of x.poly, write x.1.ele: inputs are never replaced.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline triangulate plate.poly -o plate.1.ele -o plate.1.neigh
  breakline triangulate points.node -o points.1.ele -o points.off
  breakline triangulate -pq30a0.5 plate.poly -o plate.1.ele
  breakline check plate.1.ele")]
pub(in crate::cli) struct TriangulateArgs {
    /// A .node or .poly file
    #[arg(value_name = "IN")]
    pub(in crate::cli) input: PathBuf,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,

    /// Keep the whole convex hull
    ///
    /// Holes are eaten away all the same. Without segments the hull is always kept.
    #[arg(long, help_heading = "Triangulation")]
    pub(in crate::cli) convex: bool,

    /// What to do where two segments cross between their ends
    #[arg(long, value_enum, value_name = "RULE", default_value_t, help_heading = "Triangulation")]
    pub(in crate::cli) on_crossing: OnCrossingArg,

    /// Add vertices until no angle is smaller (also `-q[DEGREES]`: 20)
    ///
    /// Up to 20.7 degrees are always reached, up to about 33 nearly always; not where segments meet at
    /// small angles. Triangles that fall short are counted. `-q`, `-a`, `-S`, `-p` and `-c` are written as
    /// for Triangle, alone or in one word: `-pq30a0.5`; they are not `--quiet` here, which is `-Q`.
    #[arg(long, value_name = "DEGREES", value_parser = smallest_angle, help_heading = "Quality")]
    pub(in crate::cli) min_angle: Option<f64>,

    /// Add vertices until no triangle is larger (also `-aAREA`)
    #[arg(long, value_name = "AREA", value_parser = positive, help_heading = "Quality")]
    pub(in crate::cli) max_area: Option<f64>,

    /// Keep to the largest areas of the .poly's regions (also `-a`)
    #[arg(long, help_heading = "Quality")]
    pub(in crate::cli) region_areas: bool,

    /// Stop after so many added vertices, and write what is there (also `-S[COUNT]`: 0)
    ///
    /// Triangles that fall short are counted, then. Without this option it is an error if 1 000 000 are not
    /// enough, and nothing is written: some angles are never reached, whatever the number.
    #[arg(long, value_name = "COUNT", help_heading = "Quality")]
    pub(in crate::cli) max_added: Option<usize>,

    /// The arithmetic that decides on which side a point lies
    #[arg(long, value_enum, value_name = "KERNEL", default_value_t, help_heading = "Triangulation")]
    pub(in crate::cli) kernel: KernelArg,
}

/// What to do where two segments cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(in crate::cli) enum OnCrossingArg {
    /// Add a vertex
    #[default]
    Split,
    /// End with an error that names both
    Reject,
}

impl From<OnCrossingArg> for OnCrossing {
    fn from(arg: OnCrossingArg) -> Self {
        match arg {
            OnCrossingArg::Split => OnCrossing::Split,
            OnCrossingArg::Reject => OnCrossing::Reject,
        }
    }
}

/// The arithmetic of the predicates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(in crate::cli) enum KernelArg {
    /// Exact, as fast as floating point where that is certain
    #[default]
    Adaptive,
    /// Exact, with numbers of any length, and slow
    Exact,
    /// Plain floating point, for experiments: a wrong result is an error, and it may not come to an end
    Fast,
}

/// Write a DEM: heights of the TIN at the centers of cells
///
/// Linear on the triangles; nodata (-9999) where there is none. GeoTIFF, Float32, tiled, DEFLATE.
/// Written block by block by all cores, so that its size is not limited by memory.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline dem tile.laz --breaklines edges.shp --resolution 0.5 -o dem.tif
  breakline dem ground.ply --te 688000 5261000 688400 5261300 -o dem.tif
  breakline dem ground.ply --align-to ortho.tif -o dem.tif")]
pub(in crate::cli) struct DemArgs {
    #[command(flatten)]
    pub(in crate::cli) surface: SurfaceArgs,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,
    #[command(flatten)]
    pub(in crate::cli) frame: FrameArgs,
}

/// Draw contours of a TIN or of a DEM
///
/// Straight from the triangles (of a DEM: between the centers of its cells), joined as long as they
/// go, high ground on the right. .shp (PolyLineZ with field ELEV) or .geojson.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline contour tile.laz --breaklines edges.shp --interval 0.5 -o contours.shp
  breakline contour dem.tif --levels 100,105.5,120 -o contours.geojson")]
pub(in crate::cli) struct ContourArgs {
    #[command(flatten)]
    pub(in crate::cli) surface: SurfaceArgs,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,

    /// Height between contours [default: 1]
    ///
    /// In the units of the heights.
    #[arg(long, value_name = "HEIGHT", value_parser = positive, allow_negative_numbers = true, help_heading = "Levels")]
    pub(in crate::cli) interval: Option<f64>,

    /// A height that contours are counted from
    #[arg(long, value_name = "HEIGHT", value_parser = finite, default_value = "0", allow_hyphen_values = true, help_heading = "Levels")]
    pub(in crate::cli) base: f64,

    /// These heights instead of an interval, as `100,105.5`
    #[arg(
        long,
        value_name = "HEIGHT,..",
        value_parser = finite,
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with_all = ["interval", "base"],
        help_heading = "Levels"
    )]
    pub(in crate::cli) levels: Vec<f64>,
}

/// Shade a TIN or a DEM as the sun would
///
/// Brightness 1 to 255, 0 where there is no surface. GeoTIFF (.tif) or .png. A DEM keeps its cells:
/// `--resolution`, `--te` and `--align-to` are for TINs.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline hillshade ground.ply --resolution 0.5 -o shade.png
  breakline hillshade dem.tif --azimuth 300 --z-factor 2 -o shade.tif")]
pub(in crate::cli) struct HillshadeArgs {
    #[command(flatten)]
    pub(in crate::cli) surface: SurfaceArgs,
    #[command(flatten)]
    pub(in crate::cli) output: OutputArgs,
    #[command(flatten)]
    pub(in crate::cli) frame: FrameArgs,

    /// Where the light comes from, in degrees clockwise from north
    #[arg(long, value_name = "DEGREES", value_parser = finite, default_value = "315", allow_hyphen_values = true, help_heading = "Light")]
    pub(in crate::cli) azimuth: f64,

    /// How high the light stands above the horizon, in degrees
    #[arg(long, value_name = "DEGREES", value_parser = altitude, allow_negative_numbers = true, default_value = "45", help_heading = "Light")]
    pub(in crate::cli) altitude: f64,

    /// What heights are multiplied by [default: 1, or what brings them to the units of the plan]
    ///
    /// Heights in feet over a plan in metres count 0.3048 unless this says otherwise.
    #[arg(long, value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true, help_heading = "Light")]
    pub(in crate::cli) z_factor: Option<f64>,
}

/// Prove a TIN right, or list its flaws
///
/// Looks at a mesh from a file (.ply, .obj, .off, or .ele with its .node), or at the TIN of points and
/// breaklines: links, manifold, orientation without overlaps, Delaunay between breaklines. The breaklines of an
/// .ele are the segments of the .poly beside it; .obj and .off do not tell them, and are not asked for the Delaunay
/// law. Flaws count vertices, faces and edges from 0 and give their places. Exit code 1 when there is any.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline check ground.ply
  breakline check plate.1.ele")]
pub(in crate::cli) struct CheckArgs {
    #[command(flatten)]
    pub(in crate::cli) surface: SurfaceArgs,

    /// Replace a crossing report that exists
    #[arg(long)]
    pub(in crate::cli) overwrite: bool,
}

/// Try everything on a small valley that comes with the program
///
/// Writes the data into a folder, then runs `info`, `tin`, `dem`, `hillshade`, `contour` and `check`
/// on it and prints each command. What is there is replaced.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline demo valley")]
pub(in crate::cli) struct DemoArgs {
    /// Folder to write to
    #[arg(value_name = "DIR", default_value = "breakline-demo")]
    pub(in crate::cli) folder: PathBuf,
}
