//! A DEM simplified to a bound, timed.
//!
//! ```text
//! bench_simplify DEM.tif BOUND
//! ```

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::error::Error;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use breakline::io::raster;
use breakline::terrain::{SimplifyLimit, SimplifyRule, simplify_cells};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(file), Some(bound)) = (arguments.next(), arguments.next()) else {
        return Err("a DEM and a bound are needed".into());
    };
    let grid = raster::open(&file)?.read_grid()?;
    let rule = SimplifyRule {
        limit: SimplifyLimit::MaxError(bound.parse()?),
        line_tolerance: None,
    };
    let start = Instant::now();
    let (_, report) = simplify_cells(&grid, &rule, &AtomicBool::new(false))?;
    println!("{:.2} s  {report:?}", start.elapsed().as_secs_f64());
    Ok(())
}
