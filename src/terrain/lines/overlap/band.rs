//! Steps at the borders of overlaps: parallel lines on which rivers have their own heights again.

use std::collections::BTreeMap;

use super::parallel::{Beside, beside};
use super::strand::Strand;
use super::{Body, Scene, WaterOverlap};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::lines::river::cross;
use crate::terrain::nearest::{nearest_part, squared_distance};

/// A segment of the border of a river.
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
struct Cut {
    part: f64,
    at: [f64; 2],
    /// The segment of a strand.
    on: Option<[usize; 2]>,
}

/// Adds the lines beside the borders of overlaps, wherever there is a step. They end on the banks
/// of the outer river, which get vertices there. Returns the largest step of each pair of waters.
pub(super) fn add(scene: &Scene, strands: &mut Vec<Strand>) -> Vec<WaterOverlap> {
    let borders = Boxes::new(border_sides(strands));
    let zones = scene.meetings.zones(scene.waters, 2.0 * scene.width);
    let mut steps: BTreeMap<[usize; 2], (f64, [f64; 2])> = BTreeMap::new();
    let mut added: Vec<Strand> = Vec::new();
    for inner in 0..scene.waters.len() {
        let outer = scene.meetings.outside_of(inner);
        if outer.is_empty() {
            continue;
        }
        let is_near = |side: [[f64; 2]; 2]| zones.find_in(Extent::of_plan(side), |_| Some(())).is_some();
        for line in scene.waters[inner].level.rings().iter().flat_map(|ring| beside(ring, scene.width, is_near)) {
            let cuts = cuts(&line, &borders, &outer, scene.rounding);
            for pair in cuts.windows(2) {
                let portion = portion(&line, [pair[0], pair[1]]);
                let found = steps_of(scene, &portion, inner, &outer);
                let Some(&(river, ..)) = found.first() else { continue };
                for (river, step, at) in found {
                    let largest = steps.entry([inner, river]).or_insert((step, at));
                    // The order in which they are found must not matter.
                    if (step, at) > *largest {
                        *largest = (step, at);
                    }
                }
                let ends = portion.ends.map(|[x, y]| [x, y, scene.height(river, [x, y])]);
                added.push(Strand::new(river, ends));
                for Cut { at, on, .. } in cuts.iter().filter(|cut| portion.ends.contains(&cut.at)) {
                    if let Some([strand, segment]) = *on {
                        strands[strand].want(segment, *at);
                    }
                }
            }
        }
    }
    strands.append(&mut added);
    largest_steps(scene, steps)
}

/// The largest step of each pair of waters, of whichever of them is the inner one, in descending
/// order.
fn largest_steps(scene: &Scene, steps: BTreeMap<[usize; 2], (f64, [f64; 2])>) -> Vec<WaterOverlap> {
    let is_smaller = |[inner, outer]: [usize; 2], step: f64| {
        steps.get(&[outer, inner]).is_some_and(|other| other.0 > step || other.0 == step && outer < inner)
    };
    let first = |water: usize| scene.waters[water].lines.start;
    let largest = steps.iter().filter(|(pair, (step, _))| !is_smaller(**pair, *step));
    let mut found: Vec<WaterOverlap> =
        largest.map(|(pair, &(step, at))| WaterOverlap { lines: pair.map(first), step, at }).collect();
    found.sort_by(|p, q| q.step.total_cmp(&p.step).then(p.lines.cmp(&q.lines)));
    found
}

/// The segments of the borders of all rivers.
pub(super) fn border_sides(strands: &[Strand]) -> Vec<BorderSide> {
    let mut sides = Vec::new();
    for (number, strand) in strands.iter().enumerate().filter(|(_, strand)| strand.is_border) {
        let side = |(segment, ends)| BorderSide { strand: number, segment, water: strand.water, ends };
        sides.extend(strand.segments().map(side));
    }
    sides
}

/// The ends of a line and where it meets the borders of some rivers, in order.
fn cuts(line: &Beside, borders: &Boxes<BorderSide>, rivers: &[usize], rounding: f64) -> Vec<Cut> {
    let [from, to] = line.ends;
    let mut cuts = vec![Cut { part: 0.0, at: from, on: None }, Cut { part: 1.0, at: to, on: None }];
    borders.find_in(Extent::of_plan(line.ends).grown(rounding), |side| {
        if rivers.contains(&side.water) {
            let met = meeting_points(line.ends, side.ends, rounding).into_iter();
            let on = Some([side.strand, side.segment]);
            cuts.extend(met.map(|at| Cut { part: nearest_part(line.ends, at), at, on }));
        }
        None::<()>
    });
    cuts.sort_by(|p, q| {
        (p.part.total_cmp(&q.part)).then(p.at[0].total_cmp(&q.at[0])).then(p.at[1].total_cmp(&q.at[1]))
    });
    cuts
}

/// The points that a line shares with a side: those of their ends that lie on the other one, but
/// for rounding, or else where they cross, computed on the side.
fn meeting_points(line: [[f64; 2]; 2], side: [[f64; 3]; 2], rounding: f64) -> Vec<[f64; 2]> {
    let line = line.map(|[x, y]| [x, y, 0.0]);
    let flat = |[x, y, _]: [f64; 3]| [x, y];
    let is_on = move |on: [[f64; 3]; 2], p: [f64; 3]| squared_distance(on.map(flat), flat(p)) <= rounding * rounding;
    let ends = |of: [[f64; 3]; 2], on: [[f64; 3]; 2]| of.into_iter().filter(move |p| is_on(on, *p)).map(flat);
    let touching: Vec<[f64; 2]> = ends(line, side).chain(ends(side, line)).collect();
    if !touching.is_empty() || !cross(&line, &side) {
        return touching;
    }
    let [p, q] = line.map(|p| [p[0] - side[0][0], p[1] - side[0][1]]);
    let along = [side[1][0] - side[0][0], side[1][1] - side[0][1]];
    let turn = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let [before, after] = [turn(along, p), turn(along, q)];
    let part = before / (before - after);
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
    let at = [0, 1].map(|axis| p[axis] + part * (q[axis] - p[axis]));
    let along_side = nearest_part([[0.0; 2], along], at);
    vec![[0, 1].map(|axis| side[0][axis] + along_side * along[axis])]
}

/// The part of a line between two cuts.
fn portion(line: &Beside, cuts: [Cut; 2]) -> Beside {
    let foot = |part: f64| [0, 1].map(|axis| line.feet[0][axis] + part * (line.feet[1][axis] - line.feet[0][axis]));
    Beside { ends: cuts.map(|cut| cut.at), feet: cuts.map(|cut| foot(cut.part)) }
}

/// The rivers that a line beside a water runs in, with the largest steps along it and where they
/// are; none if it is within the water, or there is no step.
fn steps_of(scene: &Scene, line: &Beside, inner: usize, outer: &[usize]) -> Vec<(usize, f64, [f64; 2])> {
    let [from, to] = line.ends;
    let middle = [0, 1].map(|axis| (from[axis] + to[axis]) / 2.0);
    if from == to || [from, middle, to].iter().all(|&p| scene.contains(inner, p)) {
        return Vec::new();
    }
    let rivers = outer.iter().filter(|river| scene.contains(**river, middle));
    let steps = rivers.map(|&river| {
        let (step, at) = largest_step(scene, line.feet, inner, river);
        (river, step, at)
    });
    steps.filter(|(_, step, _)| *step > scene.tolerance).collect()
}

/// The largest step along a part of the border of a water, and where it is.
fn largest_step(scene: &Scene, feet: [[f64; 2]; 2], inner: usize, river: usize) -> (f64, [f64; 2]) {
    let Some(Body::River(water)) = &scene.bodies[river] else { return (0.0, feet[0]) };
    let is_lake = matches!(scene.bodies[inner], Some(Body::Lake { .. }));
    let mut largest = (f64::NEG_INFINITY, feet[0]);
    // Heights are linear between the edges of triangles.
    for part in water.parts_of(feet).into_iter().chain([0.0, 1.0]) {
        let at = [0, 1].map(|axis| feet[0][axis] + part * (feet[1][axis] - feet[0][axis]));
        let step = water.height(at) - scene.height(inner, at);
        let step = if is_lake { step.abs() } else { step };
        if (step, at) > largest {
            largest = (step, at);
        }
    }
    largest
}
