//! How work is counted, and stopped.

use crate::error::Result;

/// A function that counts work, and can stop it. It is called again and again, from many threads,
/// with the work since the last call: in vertices, each of which counts [a few
/// times](super::map_work). If it returns an error, the work ends with that error.
pub type GoOn<'a> = &'a (dyn Fn(u64) -> Result<()> + Sync);
