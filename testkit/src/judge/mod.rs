//! What a constrained Delaunay triangulation of points and lines must be, derived from the
//! definition and checked the slow way, in whole numbers of any size. No predicate of the crate is
//! used, except in its own check.
//!
//! | | every | some |
//! |---|---|---|
//! | the crate's check finds nothing | x | |
//! | the constrained edges are the chains of the lines, as `lines` says | x | |
//! | added vertices and the lines of an edge are reported correctly: `identity` | | x |
//! | given segments that cross meet near by, and no vertex is there without a reason: `crossings` | | x |
//! | the triangles tile the hull and obey the law: `plane` | | x |
//! | in another order the result is the same: `order` | | x |

mod crossings;
mod identity;
mod lines;
mod order;
mod plane;
mod scene;

use breakline_triangulation::Level;
use dashu_int::IBig;

use super::case::Case;
use super::random::Random;
use super::subject::{Built, build};
use scene::Scene;

/// An error says what is wrong: the law that is broken, and where.
pub type Verdict = Result<(), String>;

/// Returns how many pairs of given segments cross in their interiors.
pub fn crossing_count(case: &Case) -> usize {
    crossings::count(case)
}

/// Checks what can be checked for every input of a long run.
pub fn judge(case: &Case, built: &Built) -> Verdict {
    let flaws = built.triangulation.check(Level::Law);
    if let Some(flaw) = flaws.first() {
        return Err(format!(
            "check: {} flaws, the first is {flaw:?}",
            flaws.len()
        ));
    }
    scene::judge_grid(case, built)?;
    let verdict = match Scene::<i128>::new(case, built) {
        Some(scene) => lines::judge(&scene),
        None => lines::judge(&Scene::<IBig>::new(case, built).expect("these have no limit")),
    };
    let is_off_grid = built.rounding.is_some_and(|rounding| !rounding.on_grid);
    verdict.map_err(|what| {
        if is_off_grid {
            format!("off the grid: {what}")
        } else {
            what
        }
    })
}

/// Checks what takes longer than building the triangulation.
pub fn judge_slowly(case: &Case, built: &Built) -> Verdict {
    let scene = Scene::<IBig>::new(case, built).expect("these have no limit");
    crossings::judge(&scene)?;
    identity::judge(built)?;
    plane::judge(built)
}

/// Checks that the same set in another order gives the same triangulation.
pub fn judge_order(case: &Case, built: &Built, random: &mut Random) -> Verdict {
    order::judge(case, built, random)
}

/// Builds a case and runs all checks.
pub fn pass(case: &Case) -> Verdict {
    let built = build(case).map_err(|refused| format!("refused: {refused}"))?;
    judge(case, &built)?;
    judge_slowly(case, &built)?;
    judge_order(case, &built, &mut Random(1))
}
