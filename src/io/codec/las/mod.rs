//! LAS and LAZ: lidar points.
//!
//! Reads LAS 1.0 to 1.4, and files that claim to be 1.5; point formats 0 to 10, uncompressed or
//! compressed by LASzip. COPC is read as the LAZ file that it is, with all of its points, or the
//! nodes of its octree that meet a window, see
//! [`PointSource::narrow`](crate::data::PointSource::narrow).
//!
//! Headers, records and coordinate systems are read by this module, in two steps: from bytes to
//! fields (`raw`, without checks), and from fields to checked values (`header`). The `laz` crate
//! decompresses. A coordinate is `X * scale + offset` in f64. No allocation relies on numbers in
//! the file, and a panic of the decoder becomes an error.
//!
//! # Damaged files
//!
//! | damage | result |
//! |---|---|
//! | not LAS, header cut, unknown version or point format | error |
//! | record length too small for the point format | error |
//! | scale zero, infinite or NaN; offset infinite or NaN | error |
//! | points said to begin within the header or beyond the end of the file | error |
//! | number of variable length records too large, record longer than the space for it | warning |
//! | coordinate system empty or not understood | warning, and no coordinate system |
//! | extent that is not a box | warning, and no extent |
//! | count larger than the file holds, file cut within a record | error; with [`OnDamage::Accept`](crate::io::OnDamage) whole records, and a warning |
//! | count smaller than the room for points | the points that are stated, and a warning |
//! | count 0 in front of points | no points, and a warning |
//! | LAZ: chunk table missing or damaged, chunks of one size | all points, by one thread, and a warning |
//! | LAZ: the same, formats 6 to 10 | all points of whole chunks, and a warning |
//! | LAZ: the same, formats 0 to 5, chunks of many sizes | error |
//! | LAZ: file cut | error; with [`OnDamage::Accept`](crate::io::OnDamage) points up to the cut (formats 6 to 10: whole chunks), and a warning |
//! | LAZ: more points than so few bytes can hold | error |
//! | LAZ: a chunk does not end where it should | error that names its points; the chunks before it are good |
//! | COPC: octree damaged, or not that of the chunks | error if nodes are chosen by it; with [`OnDamage::Accept`](crate::io::OnDamage) all points, and a warning |

mod copc;
mod copied;
mod extra;
mod head;
mod header;
mod input;
mod laz;
mod merge;
mod node;
mod packed;
mod plain;
mod raw;
mod reader;
mod record;
mod records;
mod reference;
mod system;
#[cfg(test)]
mod tests;
mod write;

pub use crate::io::options::las::{Detail, ReadOptions};
pub use copied::copy_with_classes;
pub use extra::{add_numbers, append_numbers};
pub use header::{Header, RecordInfo};
pub use merge::Rounding;
pub use reader::{LasReader, from_stream, from_stream_with, open, open_with, stated};
pub use record::put_coordinates;
pub use system::state_system;
pub use write::{LasWriter, Packing, create};
