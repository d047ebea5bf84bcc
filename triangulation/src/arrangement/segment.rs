//! Sites, and segments between them.

use std::cmp::Ordering;

/// Work on fewer segments or sites than this is done by one thread, without trees: waking another
/// thread or building a tree takes longer.
pub(super) const FEW: usize = 256;

pub(super) type Site = [f64; 2];
/// Returns the site of a given number. `PERF:` a trait object, because a type parameter would
/// compile the whole module anew for each caller, while calls by pointer take no measurable time.
pub(super) type SiteOf<'a> = dyn Fn(u32) -> Site + Sync + 'a;
pub(super) type Segment = [Site; 2];

/// Compares by x, then by y, coordinates whose zeros have one sign.
pub(super) fn lexicographic(p: Site, q: Site) -> Ordering {
    p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
}
