//! Terrain surfaces from lidar points and breaklines: TIN, DEM, contours and meshes.
//!
//! Underneath is a crate of exact triangulations, which can be used on its own.
//!
//! # From a LAZ file to contours
//!
//! ```
//! use breakline::{Result, data::Surface, io, terrain};
//!
//! # fn main() -> Result<()> {
//! # let folder = tempfile::tempdir()?;
//! # let out = folder.path().join("contours.shp");
//! let mut points = io::points::open("fixtures/valley.laz")?;
//! let mut ground = terrain::Selection::default(); // class 2 if there is any, never withheld points
//! ground.add_source(&mut *points)?;
//!
//! let mut builder = terrain::TinBuilder::default();
//! builder.crs = points.info().crs.clone();
//! builder.add_owned_points(ground.finish().0);
//! for line in io::layer::read("fixtures/breaklines.shp")?.lines() {
//!     builder.add_breakline(line);
//! }
//! let tin = builder.build()?;
//!
//! let every_metre = terrain::Levels::every(1.0, 0.0)?;
//! io::contours::write(&out, &mut terrain::contours(&tin, &every_metre)?, tin.crs())?;
//! # Ok(())
//! # }
//! ```
//!
//! The command line does the same: `breakline contour valley.laz --breaklines breaklines.shp
//! --interval 1 -o contours.shp`.
//!
//! # Triangulations
//!
//! ```
//! use breakline::triangulation::geometry::Plane;
//! use breakline::triangulation::{Delaunay, Level};
//!
//! let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! let (delaunay, vertices) = Delaunay::from_points(Plane::default(), &points)?;
//! assert_eq!(delaunay.finite_cells().count(), 2);
//! assert_eq!(*delaunay.point(vertices[2]), [1.0, 1.0]);
//! assert!(delaunay.check(Level::Law).is_empty());
//! # let _: &Delaunay<Plane, 3> = &delaunay;
//! # Ok::<(), breakline::triangulation::InputError>(())
//! ```
//!
//! A triangulation combines three independent choices: a [geometry](triangulation::geometry) says
//! what a point is, a [kernel](triangulation::kernel) how exactly predicates are computed, and the
//! kind of [`triangulation`] which law holds. If you know CGAL, spade or Triangle, the
//! [guide](triangulation::guide) maps their calls to ours.
//!
//! # Features
//!
//! | feature | default | without it |
//! |---|---|---|
//! | `cli` | yes | no command line program, and none of its dependencies |
//! | `geo` | yes | no conversions to the types of the crate `geo` |
//! | `png` | yes | PNG images are refused; the error names the feature |
//! | `zstd` | yes | GeoTIFF with ZSTD compression is refused; the error names the feature |
//! | `gdal`, `proj` | no | files that only GDAL reads, and reprojection, are refused; the error names the feature |
//! | `serde` | no | triangulations do not implement the traits of serde |
//!
//! # Modules
//!
//! Each module depends only on those above it in this table.
//!
//! | module | contains |
//! |---|---|
//! | [`triangulation`] | the crate `breakline-triangulation`: numbers, predicates, geometry, combinatorics, all kinds of triangulations |
//! | [`error`] | the error of all other modules: who can act on it, where it happened, the cure |
//! | [`crs`] | coordinate systems: names, codes, units |
//! | [`data`] | plain records that formats and algorithms share |
//! | [`terrain`] | TIN, contours, DEM, hillshade |
//! | [`io`] | formats: LAS, GeoTIFF, shapefile, PLY and others |
//! | [`run`] | the verbs of the program: each turns a request into a product |
//! | `cli` | the command line; not part of the public API |

#[cfg(feature = "cli")]
#[doc(hidden)] // the program as a function, not covered by semantic versioning
pub mod cli;
pub mod crs;
pub mod data;
pub mod error;
pub mod io;
pub mod run;
pub mod terrain;

pub use breakline_triangulation as triangulation;
pub use error::{Error, Result};
