use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::driver::DriverArgs;
use super::parse::{
    ClassRange, Corners, ReturnRange, ThinRule, altitude, finite, positive, smallest_angle,
};
use super::reading::{LevelArgs, ReadArgs};
use super::surface::{OnCrossingArg, SurfaceArgs};
use super::systems::SystemArgs;
use super::tiles::TileArgs;
use crate::io::geotiff::Overviews;
use crate::run::{Alpha, Arithmetic, FrameOptions, PlanLength};
use crate::terrain::{CellPoint, Method, Shading};

/// The files to write.
#[derive(Debug, Clone, Args)]
pub(crate) struct OutputArgs {
    /// File to write, format by extension (repeatable)
    ///
    /// The files of a run appear together at its end, or not at all. Pipes and devices, such as
    /// `/dev/stdout`, are written directly.
    #[arg(short, long, required = true, value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,

    /// Replace files that exist
    ///
    /// The new files keep the mode of the old ones. A symbolic link is followed; a read-only file
    /// is refused.
    #[arg(long)]
    pub(crate) overwrite: bool,
}

/// Size and position of a raster.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Raster")]
pub(crate) struct FrameArgs {
    /// Size of a cell [default: 1]
    ///
    /// In the units of the coordinate system. Cells start at multiples of this size, so that
    /// neighboring rasters fit together.
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) resolution: Option<f64>,

    /// Extent of the raster [default: that of the surface]
    ///
    /// Enlarged to whole cells. The values are separated by commas or blanks.
    #[arg(long, value_name = "XMIN,YMIN,XMAX,YMAX", allow_hyphen_values = true)]
    pub(crate) te: Option<Corners>,

    /// Raster whose grid of cells is used
    ///
    /// The grid continues beyond the edges of that raster; the extent is that of the surface, or
    /// `--te`.
    #[arg(long, value_name = "RASTER", conflicts_with = "resolution")]
    pub(crate) align_to: Option<PathBuf>,
}

/// The overviews of a raster.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Raster")]
pub(crate) struct OverviewArgs {
    /// Smaller images in a GeoTIFF, from which programs draw it at once
    ///
    /// Without them a large raster is written sooner, and is a quarter smaller.
    #[arg(long, value_enum, value_name = "WHICH", default_value_t)]
    pub(crate) overviews: OverviewsArg,
}

impl OverviewArgs {
    /// Returns the options of a frame with these overviews.
    pub(crate) fn of(&self, frame: FrameOptions) -> FrameOptions {
        FrameOptions {
            overviews: self.overviews.into(),
            ..frame
        }
    }
}

/// Which overviews a raster has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum OverviewsArg {
    /// Each half as large as the one before, down to 512 columns and rows
    #[default]
    Auto,
    /// No smaller images
    None,
}

impl From<OverviewsArg> for Overviews {
    fn from(arg: OverviewsArg) -> Self {
        match arg {
            OverviewsArg::Auto => Overviews::Auto,
            OverviewsArg::None => Overviews::None,
        }
    }
}

/// The cells in which a TIN is drawn, and its heights there. A DEM keeps its cells.
#[derive(Debug, Clone, Args)]
pub(crate) struct CellArgs {
    #[command(flatten)]
    pub(crate) frame: FrameArgs,

    /// How heights between the vertices are computed
    ///
    /// `linear` has kinks at all edges; `natural` is smooth except at vertices and breaklines, and
    /// stays between the heights of its neighbors; `smooth` has kinks at breaklines only, and may
    /// overshoot.
    #[arg(
        long,
        value_enum,
        value_name = "METHOD",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) method: MethodArg,
}

/// Show what is in files: counts, bounds, classes, coordinate system, defects
///
/// Reads points, vector layers, rasters and meshes to their end. If a file cannot be read, that is
/// reported, the other files are still shown, and the exit code is 1.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline info tile.laz edges.shp dem.tif
  breakline info --json tiles/*.laz | jq '.[].count'")]
pub(crate) struct InfoArgs {
    /// Files, globs, `@list.txt` or `-`
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,

    /// Print a JSON array with one object per file and exact numbers
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) levels: LevelArgs,
}

/// Select, clip and merge points, with all their attributes
///
/// Points are written in the order of the files. From LAS and LAZ to LAS and LAZ every byte of a
/// point record is kept: times, colors, extra bytes. The coordinate system and the other records
/// come from the first file. Files with different point formats, extra bytes or kinds of GPS time
/// cannot be merged, nor can waveforms. If scales and offsets differ, the first that can represent
/// all points exactly is used; if none can, `--round` is needed. Text (.xyz, .txt, .csv) gets the
/// coordinates, .csv also the class.
///
/// `.copc.laz` is written as COPC: the points are in the order of an octree, so that viewers and
/// `--bounds` read a part of it. Point formats 0 to 3 become 6 or 7 there, without loss.
///
/// `--a-srs` changes only what the output states. `--t-srs` changes coordinates: scales become
/// powers of ten that are at least as fine, and offsets follow from the extent.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline points tiles/*.laz --class ground,water --boundary site.shp -o site.laz
  breakline points a.las b.las -o merged.laz
  breakline points tiles/*.laz --class ground --thin grid:1 --thin-keep lowest -o thin.laz
  breakline points tile.laz --a-srs EPSG:25832+7837 -o tile-with-crs.laz
  breakline points tiles/*.laz -o all.copc.laz")]
pub(crate) struct PointsArgs {
    /// Files, globs, `@list.txt` or `-` (stdin)
    ///
    /// Points from LAS, LAZ, COPC, text (x y z) and vector layers. LAS and LAZ can be written only
    /// from LAS, LAZ and COPC.
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Classes to write, such as `2,8`, `0-31` or `ground` [default: all]
    ///
    /// Points of formats without classes are always written.
    #[arg(
        long,
        value_name = "CLASS,..",
        value_delimiter = ',',
        help_heading = "Selection"
    )]
    pub(crate) class: Vec<ClassRange>,

    /// Returns to write: `first`, `last`, `single`, `all`, or numbers such as `1,2` [default: all]
    ///
    /// `first` and `last` include pulses with a single return. Points of formats without returns
    /// are always written.
    #[arg(
        long = "return",
        value_name = "RETURN,..",
        value_delimiter = ',',
        help_heading = "Selection"
    )]
    pub(crate) returns: Vec<ReturnRange>,

    /// Leave out points that are flagged as withheld
    #[arg(long, help_heading = "Selection")]
    pub(crate) drop_withheld: bool,

    /// Clip to a rectangle, including its border
    ///
    /// Files that state that they lie outside are not read; of COPC files, only the nodes that meet
    /// the rectangle.
    #[arg(
        long,
        value_name = "XMIN,YMIN,XMAX,YMAX",
        allow_hyphen_values = true,
        help_heading = "Selection"
    )]
    pub(crate) bounds: Option<Corners>,

    /// Clip to polygons, including their borders (repeatable)
    ///
    /// Points inside any of the polygons are kept. Lines that close to rings count as one polygon.
    /// `FILE:LAYER` names the layer of a file with several.
    #[arg(long, value_name = "FILE[:LAYER]", help_heading = "Selection")]
    pub(crate) boundary: Vec<PathBuf>,

    /// Write a file for each square of this side, into the folder OUT
    ///
    /// A number in the units of the coordinates, or with `m` or `km`. Tiles begin at multiples of
    /// it, and their files have the names X_Y of their lower left corners and the extension of the
    /// first input, .las or .laz. The folder is created if it does not exist. All files appear
    /// together at the end, or none. Needs disk space for all points, uncompressed.
    #[arg(
        long,
        value_name = "LENGTH",
        allow_negative_numbers = true,
        help_heading = "Tiles"
    )]
    pub(crate) tile: Option<PlanLength>,

    /// Points of other tiles up to this distance from a tile are in its file, too
    #[arg(
        long,
        value_name = "LENGTH",
        requires = "tile",
        allow_negative_numbers = true,
        help_heading = "Tiles"
    )]
    pub(crate) buffer: Option<PlanLength>,

    /// Flag the points of the buffer as withheld
    ///
    /// Without it they are as they were, and surfaces of a tile use them. With it, `points
    /// --drop-withheld` makes one file of tiles again, in which no point is twice.
    #[arg(long, requires = "buffer", help_heading = "Tiles")]
    pub(crate) flag_buffer: bool,

    /// Leave out points: `grid:SIZE`, `poisson:DISTANCE`, `nth:N` or `random:SHARE`
    ///
    /// `grid:1` keeps one point of each cell of 1 x 1, and cells begin at multiples of their size:
    /// files that are thinned one by one agree. `poisson:1` keeps points that are at least 1 apart
    /// in plan, and leaves out only those that are closer to one of them. `nth:10` keeps the first
    /// of every ten. `random:0.1` keeps a tenth; a smaller share is part of a larger one. Points
    /// are selected first, then thinned; those that stay keep their order and all attributes.
    /// Lengths are in the units of the output's coordinates.
    #[arg(long, value_name = "RULE:NUMBER", help_heading = "Selection")]
    pub(crate) thin: Option<ThinRule>,

    /// Which point of a cell to keep, with `--thin grid:SIZE` [default: center]
    #[arg(
        long,
        value_enum,
        value_name = "POINT",
        requires = "thin",
        help_heading = "Selection"
    )]
    pub(crate) thin_keep: Option<CellPointArg>,

    /// Seed of `--thin poisson:DISTANCE` and `--thin random:SHARE` [default: 0]
    ///
    /// With another seed, other points are kept; with the same seed, the same points.
    #[arg(long, value_name = "N", requires = "thin", help_heading = "Selection")]
    pub(crate) seed: Option<u64>,

    /// Round coordinates to the nearest step of the first file's scale
    ///
    /// For files whose scales and offsets do not fit together. No coordinate moves by more than
    /// half a step.
    #[arg(long, help_heading = "Selection")]
    pub(crate) round: bool,

    #[command(flatten)]
    pub(crate) systems: SystemArgs,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) levels: LevelArgs,
}

/// Which point of a cell is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CellPointArg {
    /// The nearest to the center of the cell
    Center,
    /// The lowest
    Lowest,
    /// The highest
    Highest,
}

impl From<CellPointArg> for CellPoint {
    fn from(arg: CellPointArg) -> Self {
        match arg {
            CellPointArg::Center => CellPoint::Center,
            CellPointArg::Lowest => CellPoint::Lowest,
            CellPointArg::Highest => CellPoint::Highest,
        }
    }
}

/// Build a TIN of points and breaklines
///
/// Every breakline becomes edges of the TIN; everywhere else the triangulation is Delaunay, and it
/// does not depend on the order of the input. Formats: .tin (opened in milliseconds by `dem`,
/// `contour`, `hillshade`, `check`, `info` and `tin`), .ply (binary, with breaklines and coordinate
/// system; the same verbs read it), .obj, .off, .xml (LandXML), .dxf, .glb (glTF), .2dm, .nc
/// (UGRID), .cityjson, and .stl (relative to a local origin, which is printed and written to a file
/// next to it). A .tin must not change while a verb reads it.
///
/// A surface that is larger than memory is written in parts, to .tins: an index, and a folder with
/// a .tin for each tile. All verbs read the index as one surface.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline tin tiles/*.laz --breaklines edges.shp --boundary site.shp -o ground.ply
  breakline tin tiles/*.laz -o ground.tin
  breakline tin country/*.laz -o country.tins --memory 8GB
  breakline tin dem.tif --max-error 0.5 -o dem.tin")]
pub(crate) struct TinArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Write only vertices and triangles, not which edges are on lines
    ///
    /// For programs that do not read the .ply otherwise, such as meshio. The lines are then not in
    /// the file: `check`, smooth methods of interpolation and `tin` do not know them.
    #[arg(long)]
    pub(crate) plain: bool,

    #[command(flatten)]
    pub(crate) limit: LimitArgs,

    #[command(flatten)]
    pub(crate) tiles: TileArgs,
}

/// How far a surface is simplified.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Simplification")]
pub(crate) struct LimitArgs {
    /// Leave out vertices as long as every height stays within this of the surface
    ///
    /// Heights are those of all vertices, or of all cells of a raster. None is moved. What is left
    /// is measured at the end, and the largest error is printed.
    #[arg(long, value_name = "HEIGHT", value_parser = finite, allow_negative_numbers = true, group = "limit")]
    pub(crate) max_error: Option<f64>,

    /// Leave out vertices until at most N are left, with as small an error as is found
    #[arg(long, value_name = "N", group = "limit")]
    pub(crate) target: Option<u64>,

    /// How far the vertices of a line that are left out may be from it, in plan [default: the bound
    /// of errors; 0 in degrees]
    ///
    /// No point changes from one side of a line to the other. Lakes stay level and walls stand, and
    /// the outer border of the surface stays where it is.
    #[arg(long, value_name = "LENGTH", value_parser = finite, allow_negative_numbers = true, requires = "limit")]
    pub(crate) line_tolerance: Option<f64>,
}

/// Simplify a TIN, a mesh or a DEM to an error bound
///
/// Vertices are left out as long as every height that was given stays within the bound of the
/// surface: those of all vertices of a TIN or a mesh, of all points, or of all cells of a raster.
/// The heights that stay are not changed. Lines stay, with fewer vertices; lakes stay level, walls
/// stand. Like `tin` with the same options; outputs are those of `tin`.
#[derive(Debug, Clone, Args)]
#[command(group(clap::ArgGroup::new("needed").args(["max_error", "target"]).required(true)))]
#[command(after_long_help = "\
Example:
  breakline simplify ground.tin --max-error 0.1 -o light.tin
  breakline simplify dem.tif --target 100000 -o dem.ply")]
pub(crate) struct SimplifyArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Write only vertices and triangles, not which edges are on lines
    #[arg(long)]
    pub(crate) plain: bool,

    #[command(flatten)]
    pub(crate) limit: LimitArgs,
}

/// Triangulate points and segments in the plane, or points in space; Triangle's and TetGen's files
///
/// Reads a .node or .poly file of Triangle (Shewchuk) and writes its constrained Delaunay
/// triangulation. Points are added only where segments cross, unless a smallest angle or a largest
/// area is given. If a .poly has segments, triangles outside of its outer boundary or in a hole are
/// removed, and each triangle gets the attribute of its region. Vertices keep their numbers,
/// attributes and markers; a vertex at the position of an earlier one has no triangle.
///
/// Points in space (a .node of dimension 3, or --3d) become tetrahedra, in TetGen's files (.node,
/// .ele, .face, .edge, .neigh), .vtu or .mesh, and an alpha shape in .ply, .obj, .off or .stl.
///
/// As with Triangle, an .ele is written together with its .node (and, if the input is a .poly, its
/// .poly); .poly and .edge are written together with their .node. For x.poly, write x.1.ele: inputs
/// are never replaced.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline triangulate plate.poly -o plate.1.ele -o plate.1.neigh
  breakline triangulate points.node -o points.1.ele -o points.off
  breakline triangulate -pq30a0.5 plate.poly -o plate.1.ele
  breakline triangulate --3d tree.laz --alpha auto -o tree.stl -o tree.vtu
  breakline check plate.1.ele")]
pub(crate) struct TriangulateArgs {
    /// A .node or .poly file; in space also LAS, LAZ, text, PLY, OBJ or OFF
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Triangulate in space: tetrahedra (assumed for a .node of dimension 3)
    ///
    /// Points of all classes are used. Only --weighted, --alpha and --kernel apply then.
    #[arg(long = "3d", help_heading = "Space")]
    pub(crate) space: bool,

    /// Points have weights: a regular triangulation
    ///
    /// Weights are in the .weights next to the file, one number a line, the first attribute of a
    /// .node, or the column of a text after the coordinates. They become the first attribute of the
    /// .node that is written.
    #[arg(long, help_heading = "Space")]
    pub(crate) weighted: bool,

    /// Write the alpha shape to .ply, .obj, .off or .stl
    ///
    /// It consists of the tetrahedra whose sphere has at most this squared radius. `auto` is the
    /// smallest that is one solid with all points.
    #[arg(long, value_name = "SQUARED_RADIUS|auto", value_parser = alpha, allow_negative_numbers = true, help_heading = "Space")]
    pub(crate) alpha: Option<Alpha>,

    /// Keep the whole convex hull
    ///
    /// Holes are still removed. Without segments the hull is always kept.
    #[arg(long, help_heading = "Triangulation")]
    pub(crate) convex: bool,

    /// What to do where two segments cross between their ends
    #[arg(
        long,
        value_enum,
        value_name = "RULE",
        default_value_t,
        help_heading = "Triangulation"
    )]
    pub(crate) on_crossing: OnCrossingArg,

    /// Add vertices until no angle is smaller (also `-q[DEGREES]`: 20)
    ///
    /// Up to 20.7 degrees are always reached, up to about 33 nearly always, except where segments
    /// meet at small angles. Triangles with smaller angles are counted. `-q`, `-a`, `-S`, `-p` and
    /// `-c` are typed as for Triangle, alone or in one word: `-pq30a0.5`. `-q` is not `--quiet`
    /// here; that is `-Q`.
    #[arg(long, value_name = "DEGREES", value_parser = smallest_angle, help_heading = "Quality")]
    pub(crate) min_angle: Option<f64>,

    /// Add vertices until no triangle is larger (also `-aAREA`)
    #[arg(long, value_name = "AREA", value_parser = positive, help_heading = "Quality")]
    pub(crate) max_area: Option<f64>,

    /// Apply the largest areas of the .poly's regions (also `-a`)
    #[arg(long, help_heading = "Quality")]
    pub(crate) region_areas: bool,

    /// Stop after this many added vertices, and write the result so far (also `-S[COUNT]`: 0)
    ///
    /// Triangles that do not meet the limits are then counted. Without this option it is an error
    /// if 1 000 000 vertices are not enough, and nothing is written: some angles are never reached,
    /// however many vertices are added.
    #[arg(long, value_name = "COUNT", help_heading = "Quality")]
    pub(crate) max_added: Option<usize>,

    /// The arithmetic that decides on which side of a line a point lies
    #[arg(
        long,
        value_enum,
        value_name = "KERNEL",
        default_value_t,
        help_heading = "Triangulation"
    )]
    pub(crate) kernel: KernelArg,
}

impl TriangulateArgs {
    /// Returns the first option given that is only for the plane.
    pub(crate) fn option_of_the_plane(&self) -> Option<&'static str> {
        let given = [
            (self.convex, "--convex"),
            (
                self.on_crossing != OnCrossingArg::default(),
                "--on-crossing",
            ),
            (self.min_angle.is_some(), "--min-angle"),
            (self.max_area.is_some(), "--max-area"),
            (self.region_areas, "--region-areas"),
            (self.max_added.is_some(), "--max-added"),
        ];
        given
            .into_iter()
            .find(|(is_given, _)| *is_given)
            .map(|(_, name)| name)
    }

    /// Returns the first option given that is only for space.
    pub(crate) fn option_of_space(&self) -> Option<&'static str> {
        let given = [
            (self.weighted, "--weighted"),
            (self.alpha.is_some(), "--alpha"),
        ];
        given
            .into_iter()
            .find(|(is_given, _)| *is_given)
            .map(|(_, name)| name)
    }
}

fn alpha(text: &str) -> Result<Alpha, String> {
    match text {
        "auto" => Ok(Alpha::OneSolid),
        _ => positive(text)
            .map(Alpha::Given)
            .map_err(|error| format!("{error}, or `auto`")),
    }
}

/// The arithmetic of the predicates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum KernelArg {
    /// Exact, as fast as floating point where that is certain
    #[default]
    Adaptive,
    /// Exact, with numbers of any length; slow
    Exact,
    /// Plain floating point, for experiments: a wrong result is an error, and the run may not end
    Fast,
}

impl From<KernelArg> for Arithmetic {
    fn from(arg: KernelArg) -> Self {
        match arg {
            KernelArg::Adaptive => Arithmetic::Adaptive,
            KernelArg::Exact => Arithmetic::Exact,
            KernelArg::Fast => Arithmetic::Fast,
        }
    }
}

/// Write a DEM: heights of the TIN at the centers of cells
///
/// Heights are linear on each triangle, or by another --method, and nodata (-9999) where there is
/// none. The output is a tiled GeoTIFF of 32-bit floats, compressed with DEFLATE. It is computed
/// block by block on all cores and may be larger than memory. So may the points: then the work is
/// done in tiles (--tiles, --memory).
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline dem tile.laz --breaklines edges.shp --resolution 0.5 -o dem.tif
  breakline dem ground.tin --method natural -o round.tif
  breakline dem ground.ply --te 688000 5261000 688400 5261300 -o dem.tif
  breakline dem ground.ply --align-to ortho.tif -o dem.tif")]
pub(crate) struct DemArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
    #[command(flatten)]
    pub(crate) overviews: OverviewArgs,

    #[command(flatten)]
    pub(crate) tiles: TileArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}

/// How heights between the vertices are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum MethodArg {
    /// Linear on each triangle
    #[default]
    Linear,
    /// The height of the nearest vertex
    Nearest,
    /// Natural neighbors, Sibson's weights; breaklines are respected
    Natural,
    /// Natural neighbors, Laplace's weights; breaklines are respected
    Laplace,
    /// Clough-Tocher elements; breaklines are respected
    Smooth,
    /// Inverse distance weighting: power 2, the 12 nearest vertices
    #[value(alias = "invdist")]
    Idw,
}

impl From<MethodArg> for Method {
    fn from(arg: MethodArg) -> Self {
        match arg {
            MethodArg::Linear => Method::Linear,
            MethodArg::Nearest => Method::Nearest,
            MethodArg::Natural => Method::Natural,
            MethodArg::Laplace => Method::Laplace,
            MethodArg::Smooth => Method::Smooth,
            MethodArg::Idw => Method::Idw,
        }
    }
}

/// Shade a TIN or a DEM as the sun would
///
/// Brightness is 1 to 255, and 0 where there is no surface. The output is a GeoTIFF (.tif) or a
/// .png. The hillshade of a DEM has the cells of the DEM: `--resolution`, `--te`, `--align-to` and
/// `--method` are for TINs.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline hillshade ground.ply --resolution 0.5 -o shade.png
  breakline hillshade dem.tif --azimuth 300 --z-factor 2 -o shade.tif
  breakline hillshade dem.tif --shading multidirectional -o shade.tif")]
pub(crate) struct HillshadeArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
    #[command(flatten)]
    pub(crate) overviews: OverviewArgs,

    /// How shades follow from slopes
    ///
    /// Names are those of the options of gdaldem, which shades as `standard` without them.
    #[arg(
        long,
        value_enum,
        value_name = "SHADING",
        default_value_t,
        help_heading = "Light"
    )]
    pub(crate) shading: ShadingArg,

    /// Direction that the light comes from, in degrees clockwise from north [default: 315]
    ///
    /// Not for `multidirectional`, which has four.
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, help_heading = "Light")]
    pub(crate) azimuth: Option<f64>,

    /// Angle of the light above the horizon, in degrees [default: 45]
    ///
    /// Not for `igor`.
    #[arg(long, value_name = "DEGREES", value_parser = altitude, allow_negative_numbers = true, help_heading = "Light")]
    pub(crate) altitude: Option<f64>,

    /// Factor for heights [default: 1, or what converts them to the units of x and y]
    ///
    /// By default, heights in feet over coordinates in metres are multiplied by 0.3048, and degrees
    /// are taken as the lengths that they have in the middle of the raster, shorter in x than in y.
    #[arg(long, value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true, help_heading = "Light")]
    pub(crate) z_factor: Option<f64>,

    #[command(flatten)]
    pub(crate) tiles: TileArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}

/// How shades follow from slopes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum ShadingArg {
    /// Bright where the surface faces the light
    #[default]
    Standard,
    /// Also darker the steeper the surface is, on either side
    Combined,
    /// Four lights, from the southwest to the north: no slope is all dark
    Multidirectional,
    /// White, but for steep slopes away from the light: to lay over colors
    Igor,
}

impl From<ShadingArg> for Shading {
    fn from(arg: ShadingArg) -> Self {
        match arg {
            ShadingArg::Standard => Shading::Standard,
            ShadingArg::Combined => Shading::Combined,
            ShadingArg::Multidirectional => Shading::Multidirectional,
            ShadingArg::Igor => Shading::Igor,
        }
    }
}

/// Prove a TIN correct, or list its flaws
///
/// Checks a surface from a file (.tin, .ply, .obj, .off, or .ele with its .node), or the TIN of
/// points and breaklines: links between neighbors, manifold, orientation, no overlaps, Delaunay
/// between breaklines. The breaklines of an .ele are the segments of the .poly next to it; .obj and
/// .off have no breaklines, and the Delaunay law is not checked for them. Flaws number vertices,
/// faces and edges from 0 and give their positions. The exit code is 1 if there is any. Tetrahedra
/// (an .ele with a .node of dimension 3) are checked, too: neighbors, orientation, a convex hull,
/// Delaunay.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline check ground.ply
  breakline check plate.1.ele")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    /// The vertices of tetrahedra have weights: check that they are regular
    ///
    /// Weights are the first attribute of the .node, or in a .weights next to it.
    #[arg(long)]
    pub(crate) weighted: bool,

    /// Replace an existing crossing report
    #[arg(long)]
    pub(crate) overwrite: bool,
}

/// Describe the program: all verbs with their options, values and defaults
///
/// For programs that wrap this one, and for tests of them.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline describe --json | jq '.verbs[].name'")]
pub(crate) struct DescribeArgs {
    /// Print a JSON object, with all texts of the help
    #[arg(long)]
    pub(crate) json: bool,
}

/// Try everything on a small valley that comes with the program
///
/// Writes the data to a folder, then runs `info`, `tin`, `check`, `dem`, `hillshade` and `contour`
/// on it and prints each command. Existing files are replaced.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline demo valley")]
pub(crate) struct DemoArgs {
    /// Folder to write to
    #[arg(value_name = "DIR", default_value = "breakline-demo")]
    pub(crate) folder: PathBuf,
}
