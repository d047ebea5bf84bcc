//! Steps at the borders of overlaps: parallel lines on which rivers have their own heights again.

use std::collections::{BTreeMap, BTreeSet};

use super::parallel::{Beside, beside};
use super::scene::{Body, Scene, WaterOverlap};
use super::strand::Strand;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::lines::river::cross;
use crate::terrain::nearest::{nearest_part, squared_distance};

/// A segment of the border of a water.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderSide {
    pub(super) strand: usize,
    pub(super) segment: usize,
    pub(super) water: usize,
    pub(super) ends: [[f64; 3]; 2],
}

impl Boxed for BorderSide {
    fn extent(&self) -> Extent {
        Extent::of(self.ends)
    }
}

/// Where a line beside a border meets the border of the river that it is in.
#[derive(Debug, Clone, Copy)]
struct BorderCrossing {
    part: f64,
    at: [f64; 2],
    /// The segment of a strand.
    on: Option<[usize; 2]>,
}

/// A part of a line beside a border, between borders of the rivers outside.
#[derive(Debug, Clone)]
struct Portion {
    ends: [[f64; 2]; 2],
    /// The rivers that it runs in, in order.
    rivers: Vec<usize>,
    /// The segments of strands that it ends on, and where.
    on: Vec<([usize; 2], [f64; 2])>,
}

/// Adds the lines beside the borders of overlaps with a step. They end on the banks of the outer
/// river, which get vertices there. Returns the largest step of each pair of waters.
///
/// Where there is a step anywhere between two waters, the line is whole: next to a bank or a corner
/// a step may be shorter than the line beside it is away. Where there is none, it changes nothing.
pub(super) fn add(scene: &Scene, strands: &mut Vec<Strand>) -> Vec<WaterOverlap> {
    let borders = Boxes::new(border_sides(strands));
    let zones = scene.meetings.zones(scene.waters, 2.0 * scene.width);
    let mut largest: BTreeMap<[usize; 2], (f64, [f64; 2])> = BTreeMap::new();
    let mut added: Vec<Strand> = Vec::new();
    for inner in 0..scene.waters.len() {
        let outer = scene.meetings.outside_of(inner);
        if outer.is_empty() {
            continue;
        }
        let is_near =
            |side: [[f64; 2]; 2]| zones.find_in(Extent::of_plan(side), |_| Some(())).is_some();
        let mut portions: Vec<Portion> = Vec::new();
        let mut lower_than: BTreeSet<usize> = BTreeSet::new();
        for line in scene.waters[inner]
            .level
            .rings()
            .iter()
            .flat_map(|ring| beside(ring, scene.width, is_near))
        {
            let cuts = cuts(&line, &borders, &outer, scene.rounding);
            let stops: Vec<&[BorderCrossing]> = cuts.chunk_by(|p, q| p.at == q.at).collect();
            let mut seen: BTreeSet<usize> = BTreeSet::new();
            for pair in stops.windows(2) {
                let ends = [pair[0][0].at, pair[1][0].at];
                let rivers = rivers_beside(scene, ends, inner, &outer);
                for river in rivers.iter().copied().filter(|river| seen.insert(*river)) {
                    let steps = steps_along(scene, line.side, inner, river);
                    if steps.is_any {
                        lower_than.insert(river);
                    }
                    if let Some(found) = steps.largest {
                        let largest = largest.entry([inner, river]).or_insert(found);
                        // The order in which they are found must not matter.
                        if found > *largest {
                            *largest = found;
                        }
                    }
                }
                let on = pair
                    .iter()
                    .copied()
                    .flatten()
                    .filter_map(|cut| cut.on.map(|on| (on, cut.at)))
                    .collect();
                portions.push(Portion { ends, rivers, on });
            }
        }
        for Portion { ends, rivers, on } in portions {
            let Some(&river) = rivers.iter().find(|river| lower_than.contains(river)) else {
                continue;
            };
            added.push(Strand::new(
                river,
                ends.map(|[x, y]| [x, y, scene.height(river, [x, y])]),
            ));
            on.into_iter()
                .for_each(|([strand, segment], at)| strands[strand].want(segment, at));
        }
    }
    strands.append(&mut added);
    largest_steps(scene, largest)
}

/// The largest step of each pair of waters, of whichever of them is the inner one, in descending
/// order.
fn largest_steps(scene: &Scene, steps: BTreeMap<[usize; 2], (f64, [f64; 2])>) -> Vec<WaterOverlap> {
    let is_smaller = |[inner, outer]: [usize; 2], step: f64| {
        steps
            .get(&[outer, inner])
            .is_some_and(|other| other.0 > step || other.0 == step && outer < inner)
    };
    let first = |water: usize| scene.waters[water].lines.start;
    let largest = steps
        .iter()
        .filter(|(pair, (step, _))| !is_smaller(**pair, *step));
    let mut found: Vec<WaterOverlap> = largest
        .map(|(pair, &(step, at))| WaterOverlap {
            lines: pair.map(first),
            step,
            at,
        })
        .collect();
    found.sort_by(|p, q| q.step.total_cmp(&p.step).then(p.lines.cmp(&q.lines)));
    found
}

/// The segments of the borders of all waters that take part.
pub(super) fn border_sides(strands: &[Strand]) -> Vec<BorderSide> {
    let mut sides = Vec::new();
    for (number, strand) in strands
        .iter()
        .enumerate()
        .filter(|(_, strand)| strand.is_border)
    {
        let side = |(segment, ends)| BorderSide {
            strand: number,
            segment,
            water: strand.water,
            ends,
        };
        sides.extend(strand.segments().map(side));
    }
    sides
}

/// The ends of a line and where it meets the borders of some rivers, given in order, in order.
fn cuts(
    line: &Beside,
    borders: &Boxes<BorderSide>,
    rivers: &[usize],
    rounding: f64,
) -> Vec<BorderCrossing> {
    let [from, to] = line.ends;
    let mut cuts = vec![
        BorderCrossing {
            part: 0.0,
            at: from,
            on: None,
        },
        BorderCrossing {
            part: 1.0,
            at: to,
            on: None,
        },
    ];
    borders.find_in(Extent::of_plan(line.ends).grown(rounding), |side| {
        if rivers.binary_search(&side.water).is_ok() {
            let met = meeting_points(line.ends, side.ends, rounding).into_iter();
            let on = Some([side.strand, side.segment]);
            cuts.extend(met.map(|at| BorderCrossing {
                part: nearest_part(line.ends, at),
                at,
                on,
            }));
        }
        None::<()>
    });
    cuts.sort_by(|p, q| {
        (p.part.total_cmp(&q.part))
            .then(p.at[0].total_cmp(&q.at[0]))
            .then(p.at[1].total_cmp(&q.at[1]))
    });
    cuts
}

/// The points that a line shares with a side: those of their ends that lie on the other one, but
/// for rounding, or else where they cross, computed on the side.
fn meeting_points(line: [[f64; 2]; 2], side: [[f64; 3]; 2], rounding: f64) -> Vec<[f64; 2]> {
    let line = line.map(|[x, y]| [x, y, 0.0]);
    let flat = |[x, y, _]: [f64; 3]| [x, y];
    let is_on = move |on: [[f64; 3]; 2], p: [f64; 3]| {
        squared_distance(on.map(flat), flat(p)) <= rounding * rounding
    };
    let ends = |of: [[f64; 3]; 2], on: [[f64; 3]; 2]| {
        of.into_iter().filter(move |p| is_on(on, *p)).map(flat)
    };
    let touching: Vec<[f64; 2]> = ends(line, side).chain(ends(side, line)).collect();
    if !touching.is_empty() || !cross(&line, &side) {
        return touching;
    }
    let [p, q] = line.map(|p| [p[0] - side[0][0], p[1] - side[0][1]]);
    let along = [side[1][0] - side[0][0], side[1][1] - side[0][1]];
    let turn = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let [before, after] = [turn(along, p), turn(along, q)];
    let part = before / (before - after);
    let part = if part.is_finite() {
        part.clamp(0.0, 1.0)
    } else {
        0.5
    };
    let at = [0, 1].map(|axis| p[axis] + part * (q[axis] - p[axis]));
    let along_side = nearest_part([[0.0; 2], along], at);
    vec![[0, 1].map(|axis| side[0][axis] + along_side * along[axis])]
}

/// The outer rivers that a part of a line beside a water runs in; none if it is within the water.
fn rivers_beside(
    scene: &Scene,
    [from, to]: [[f64; 2]; 2],
    inner: usize,
    outer: &[usize],
) -> Vec<usize> {
    let middle = [0, 1].map(|axis| (from[axis] + to[axis]) / 2.0);
    if [from, middle, to].iter().all(|&p| scene.contains(inner, p)) {
        return Vec::new();
    }
    let mut rivers = scene.meetings.rivers_at(middle);
    rivers.retain(|river| outer.binary_search(river).is_ok());
    rivers
}

/// The steps along a side of the border of a water to a river outside.
#[derive(Debug, Clone, Copy)]
struct Steps {
    is_any: bool,
    /// The largest that can be seen, and where it is.
    largest: Option<(f64, [f64; 2])>,
}

/// Finds the steps along a side of the ring around a water.
fn steps_along(scene: &Scene, side: [[f64; 2]; 2], inner: usize, river: usize) -> Steps {
    let mut steps = Steps {
        is_any: false,
        largest: None,
    };
    let Some(Body::River(water)) = &scene.bodies[river] else {
        return steps;
    };
    let is_lake = matches!(scene.bodies[inner], Some(Body::Lake { .. }));
    let at = |part: f64| [0, 1].map(|axis| side[0][axis] + part * (side[1][axis] - side[0][axis]));
    // Heights are linear between the edges of triangles.
    let mut parts: Vec<f64> = water.parts_of(side, scene.rounding);
    parts.extend(scene.sight.parts_of(side));
    parts.extend([0.0, 1.0]);
    parts.sort_by(f64::total_cmp);
    parts.dedup();
    let is_seen: Vec<bool> = parts
        .windows(2)
        .map(|pair| scene.is_seen(at((pair[0] + pair[1]) / 2.0), inner))
        .collect();
    for (k, part) in parts.iter().enumerate() {
        let q = at(*part);
        let step = water.height(q) - scene.height(inner, q);
        let step = if is_lake { step.abs() } else { step };
        if step > scene.tolerance && water.is_near(q, scene.rounding) {
            steps.is_any = true;
            if is_seen[k.saturating_sub(1)..(k + 1).min(is_seen.len())].contains(&true) {
                let is_largest = steps.largest.is_none_or(|largest| (step, q) > largest);
                steps.largest = if is_largest {
                    Some((step, q))
                } else {
                    steps.largest
                };
            }
        }
    }
    steps
}
