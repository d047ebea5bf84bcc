//! Lidar and breaklines in; TIN, DEM, contours and mesh out. And, underneath, triangulations that
//! never fail.
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
//! # Ok::<(), breakline::triangulation::Refused>(())
//! ```
//!
//! What a point is, how exactly its predicates are computed and which law the triangulation obeys are
//! three choices that do not depend on each other: a [geometry](triangulation::geometry), a [kernel](triangulation::kernel), a
//! kind of [`triangulation`]. The [guide](triangulation::guide) is for those who come from CGAL, spade or Triangle.
//!
//! # Features
//!
//! | feature | default | without it |
//! |---|---|---|
//! | `cli` | yes | no program, and no crates for a command line |
//! | `geo` | yes | no conversions to the types of the crate `geo` |
//! | `png` | yes | pictures are refused, with the feature's name |
//! | `zstd` | yes | GeoTIFF with ZSTD is refused, with the feature's name |
//! | `gdal`, `proj` | no | files that only GDAL reads, and reprojection, are refused, with the feature's name |
//! | `serde` | no | triangulations are not saved and read with serde |
//!
//! # The floors
//!
//! Each module uses only those above it in this list.
//!
//! | module | holds |
//! |---|---|
//! | [`triangulation`] | the crate `breakline-triangulation`: numbers, predicates, geometry, combinatorics, all kinds of triangulations |
//! | [`crs`] | coordinate systems: names, codes, units |
//! | [`data`] | plain records between formats and algorithms |
//! | [`terrain`] | TIN, contours, DEM, hillshade |
//! | [`io`] | formats: LAS, GeoTIFF, shapefile, PLY and others |
//! | [`run`] | what a verb of the program does, from a request to a product |
//! | `cli` | the command line; not for other programs |

#[cfg(feature = "cli")]
#[doc(hidden)] // the program as a function: no part of what the library promises
pub mod cli;
pub mod crs;
pub mod data;
pub mod error;
pub mod io;
pub mod run;
pub mod terrain;

pub use breakline_triangulation as triangulation;
pub use error::{Error, Result};
