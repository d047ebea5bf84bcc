//! Surfaces in the formats of CAD programs, web viewers and mesh programs, and heights as text:
//! written, read again, files of other programs, damaged files.
//!
//! | variable | sets the number of |
//! |---|---|
//! | `BREAKLINE_MUTATIONS` | damaged files of each format |

#[path = "../common/bumps.rs"]
mod bumps;
#[path = "../common/program.rs"]
mod program;

mod ascii_grid;
mod damage;
mod drawing;
mod dxf_read;
mod landxml;
mod matrix;
mod model;
mod refused;
mod rounded;
mod sample;
