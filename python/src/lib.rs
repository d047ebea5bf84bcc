//! The module `breakline._breakline`: arrays become requests, products become arrays.
//!
//! Everything is one call of `breakline::run`. What a user sees is the Python package around it, in
//! `package/breakline`.

#![allow(
    clippy::too_many_arguments,
    reason = "functions have the parameters of those in Python"
)]

use pyo3::prelude::*;

mod accuracy;
mod arrays;
mod compare;
mod errors;
mod files;
mod ground;
mod names;
mod notices;
mod profile;
mod reports;
mod requests;
mod runs;
mod spatial;
mod surface;
mod terrain_tiles;
mod triangle;
mod volume;
mod work;
mod write;

/// Arrays in, arrays out: the functions behind the package.
#[pymodule]
mod _breakline {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::accuracy::accuracy;
    #[pymodule_export]
    use super::compare::compare;
    #[pymodule_export]
    use super::files::{
        check_space, class_numbers, crs, describe, info, is_of_space, main, read_points,
        triangulate, triangulate_space, write_points,
    };
    #[pymodule_export]
    use super::ground::{ground_classes, write_ground};
    #[pymodule_export]
    use super::names::settings;
    #[pymodule_export]
    use super::profile::{drape, profile};
    #[pymodule_export]
    use super::runs::run;
    #[pymodule_export]
    use super::surface::{Surface, check_file, edge_kinds, write_cells, write_contours};

    #[pymodule_export]
    use super::spatial::{CubicValues, Tessellation, Values, convex_hull, nested_lists};

    #[pymodule_export]
    use super::terrain_tiles::terrain_tiles;

    #[pymodule_export]
    use super::triangle::{TriangleSwitches, triangulate_arrays};

    #[pymodule_export]
    use super::volume::volume;

    #[pymodule_export]
    use super::write::{Job, job_folder, kind_of, write};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // A decoder's panic that is caught and becomes an error is not printed.
        let print = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !breakline::io::is_contained() {
                print(panic);
            }
        }));
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
