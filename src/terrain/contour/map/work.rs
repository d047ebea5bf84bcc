//! How work is counted, and stopped.

use crate::error::Result;

/// Is called again and again while work is done, from many threads, with the work since the last
/// call: in vertices, each of which counts [a few times](super::map_work). The work ends with the
/// error that it returns.
pub type GoOn<'a> = &'a (dyn Fn(u64) -> Result<()> + Sync);
