//! Checks that given segments that cross have a common vertex there, and that vertices were added
//! for no other reason.

use breakline_triangulation::geometry::{Geometry, Plane};
use breakline_triangulation::num::Sign;
use dashu_int::IBig;

use super::scene::{Scene, cross, magnitude};
use super::{Verdict, lines};
use crate::case::Case;
use crate::subject::AnyFinite;

/// A position as numerators over one positive denominator.
struct Fraction {
    numerators: [IBig; 2],
    denominator: IBig,
}

impl Fraction {
    /// Returns where two segments cross; `None` unless they cross in their interiors.
    fn crossing(scene: &Scene<IBig>, [a, b]: [usize; 2], [c, d]: [usize; 2]) -> Option<Fraction> {
        let zero = IBig::from(0);
        let sides = [
            scene.turn(a, b, c) * scene.turn(a, b, d),
            scene.turn(c, d, a) * scene.turn(c, d, b),
        ];
        if sides.iter().any(|side| *side >= zero) {
            return None;
        }
        let [ab, cd] = [scene.difference(a, b), scene.difference(c, d)];
        let (along, whole) = (
            cross(scene.difference(a, c), cd.clone()),
            cross(ab.clone(), cd),
        );
        let sign = if whole < zero {
            IBig::from(-1)
        } else {
            IBig::from(1)
        };
        let [dx, dy] = ab.map(|length| length * &along * &sign);
        let denominator = magnitude(whole);
        let [x, y] = scene.sites[a].clone().map(|x| x * &denominator);
        Some(Fraction {
            numerators: [x + dx, y + dy],
            denominator,
        })
    }

    fn is_near(&self, crossing: &[IBig; 2], bound: &[IBig; 2]) -> bool {
        (0..2).all(|axis| {
            let off = &crossing[axis] * &self.denominator - &self.numerators[axis];
            magnitude(off) <= &bound[axis] * &self.denominator
        })
    }
}

pub(crate) fn judge(scene: &Scene<IBig>) -> Verdict {
    let mut parts = Vec::new();
    for line in 0..scene.chains.len() {
        parts.extend(lines::parts(scene, line)?);
    }
    let mut unexplained: Vec<usize> = (0..scene.sites.len()).collect();
    unexplained.retain(|v| !scene.vertices.contains(v));
    for (i, (ends, chain)) in parts.iter().enumerate() {
        for (others, other) in &parts[..i] {
            let Some(crossing) = Fraction::crossing(scene, *ends, *others) else {
                continue;
            };
            let meets =
                |v: &&usize| other.contains(v) && crossing.is_near(&scene.sites[**v], &scene.bound);
            if !chain.iter().any(|v| meets(&v)) {
                let names = [ends[0], ends[1], others[0], others[1]].map(|v| scene.name(v));
                return Err(format!(
                    "no common vertex where {} - {} crosses {} - {}",
                    names[0], names[1], names[2], names[3]
                ));
            }
            unexplained.retain(|&v| !crossing.is_near(&scene.sites[v], &scene.bound));
        }
    }
    // Off the grid, bent parts may cross where the given segments do not, and have a vertex there.
    let is_on_grid = scene.back.iter().all(|back| *back == IBig::from(0));
    match unexplained.first() {
        Some(&v) if is_on_grid => Err(format!("needless: {} is near no crossing", scene.name(v))),
        _ => Ok(()),
    }
}

/// Returns how many pairs of given segments cross in their interiors; by the crate's predicates,
/// for statistics only.
pub(crate) fn count(case: &Case) -> usize {
    let geometry = Plane::<AnyFinite>::default();
    let ends = |s: &[u32]| [&case.points[s[0] as usize], &case.points[s[1] as usize]];
    let segments: Vec<_> = case
        .lines
        .iter()
        .flat_map(|line| line.windows(2).map(ends))
        .collect();
    let apart = |[a, b]: [&[f64; 2]; 2], [c, d]: [&[f64; 2]; 2]| {
        geometry.orientation([a, b, c]) * geometry.orientation([a, b, d]) == Sign::Negative
    };
    let crosses = |i: usize| {
        let is_crossed =
            |other: &&[&[f64; 2]; 2]| apart(segments[i], **other) && apart(**other, segments[i]);
        segments[..i].iter().filter(is_crossed).count()
    };
    (0..segments.len()).map(crosses).sum()
}
