//! Triangulations in space.

mod along;
mod alpha;
mod boxes;
mod bulk;
mod bulk_regular;
mod compact;
mod dual;
mod edits;
mod facts;
mod gabriel;
mod hull;
mod location;
mod natural;
mod queries;
mod regular;
mod removal;
mod sequences;
mod within_box;
mod zones;

/// 2^-1070, by its bits: `powi` divides 1 by 2^1070, which is infinite, unless the compiler
/// computes it.
const TINY: f64 = f64::from_bits(1 << 4);
