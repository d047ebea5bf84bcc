//! What water promises, asked of a finished surface.

use breakline::data::{Bounds, Surface};
use breakline::run::{Context, DemOptions, FrameOptions, SurfaceProduct, dem, elevations};
use breakline::terrain::Method;

use super::levels::{self, Station};
use super::plane::{
    Site, cross, distance, distance_to_line, from_to, heights_in, is_within, nearest,
};
use super::scene::{STEP, Scene};

/// How many positions were judged.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    pub(crate) vertices: usize,
    pub(crate) on_banks: usize,
    pub(crate) cells: usize,
    /// Vertices on upper edges of walls, in addition.
    pub(crate) on_walls: usize,
    /// Among these, where rivers overlap.
    pub(crate) in_overlaps: usize,
    /// Among these, in the step beside an overlap or a shore.
    pub(crate) in_steps: usize,
    /// Cells and positions on banks that are too near to a border to be judged, in addition.
    pub(crate) skipped: usize,
}

impl Counts {
    pub(crate) fn plus(self, other: Self) -> Self {
        Counts {
            vertices: self.vertices + other.vertices,
            on_banks: self.on_banks + other.on_banks,
            cells: self.cells + other.cells,
            on_walls: self.on_walls + other.on_walls,
            in_overlaps: self.in_overlaps + other.in_overlaps,
            in_steps: self.in_steps + other.in_steps,
            skipped: self.skipped + other.skipped,
        }
    }

    pub(crate) fn all(&self) -> usize {
        self.vertices + self.on_banks + self.cells
    }
}

/// How far outside of an overlap the step may reach, as a factor of its width: its corners are
/// mitered.
const REACH: f64 = 2.5;

/// Water between two level lines: left, right, next left, next right.
struct Stretch {
    corners: [Site; 4],
    heights: [f64; 4],
}

impl Stretch {
    /// The sides, around.
    fn sides(&self) -> [[Site; 2]; 4] {
        let [a, b, c, d] = self.corners;
        [[a, b], [b, d], [d, c], [c, a]]
    }

    /// The distance from a site, 0 within.
    fn distance(&self, p: Site) -> f64 {
        let turns = self
            .sides()
            .map(|[q, r]| cross(from_to(q, r), from_to(q, p)));
        if turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0) {
            return 0.0;
        }
        distance(self.nearest(p), p)
    }

    /// The nearest site on the border.
    fn nearest(&self, p: Site) -> Site {
        let sites = self.sides().map(|side| nearest(side, p));
        sites
            .into_iter()
            .min_by(|q, r| distance(*q, p).total_cmp(&distance(*r, p)))
            .expect("four sides")
    }

    /// An upper bound of the slope.
    fn slope(&self) -> f64 {
        let [low, high] = [f64::min, f64::max]
            .map(|of| self.heights.into_iter().reduce(of).expect("four heights"));
        let [a, b, c, d] = self.corners;
        let far = |side: [Site; 2], p: Site| distance(nearest(side, p), p);
        let height = far([a, b], c)
            .min(far([a, b], d))
            .min(far([c, d], a))
            .min(far([c, d], b));
        (high - low) / height
    }
}

/// The water of a river.
struct River {
    stretches: Vec<Stretch>,
    /// The ring around it.
    ring: Vec<Site>,
}

impl River {
    fn new(stations: &[Station]) -> Self {
        let stretch = |pair: &[Station]| {
            let ([a, b], [c, d]) = (pair[0].ends, pair[1].ends);
            let ([e, f], [g, h]) = (pair[0].heights, pair[1].heights);
            Stretch {
                corners: [a, b, c, d],
                heights: [e, f, g, h],
            }
        };
        let lefts = stations.iter().map(|station| station.ends[0]);
        let rights = stations.iter().rev().map(|station| station.ends[1]);
        let mut ring: Vec<Site> = lefts.chain(rights).collect();
        ring.push(ring[0]);
        River {
            stretches: stations.windows(2).map(stretch).collect(),
            ring,
        }
    }

    /// The distance from a site, 0 within.
    fn distance(&self, p: Site) -> f64 {
        self.stretches
            .iter()
            .map(|stretch| stretch.distance(p))
            .fold(f64::INFINITY, f64::min)
    }

    /// The lowest and highest height that the river may have at the nearest position, and what
    /// rounding may change.
    fn heights(&self, p: Site, rounding: f64) -> Heights {
        let least = self.distance(p) + rounding;
        let near = self
            .stretches
            .iter()
            .filter(|stretch| stretch.distance(p) <= least);
        let heights = near.map(|stretch| {
            let q = if stretch.distance(p) > rounding {
                stretch.nearest(p)
            } else {
                p
            };
            let [low, high] = heights_in(stretch.corners, stretch.heights, q);
            Heights {
                low,
                high,
                off: 4.0 * rounding * stretch.slope(),
            }
        });
        heights
            .reduce(Heights::hull)
            .expect("a river has a stretch")
    }
}

/// The heights that are right.
#[derive(Debug, Clone, Copy)]
struct Heights {
    low: f64,
    high: f64,
    off: f64,
}

impl Heights {
    fn hull(self, other: Self) -> Self {
        Heights {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            off: self.off.max(other.off),
        }
    }

    /// The lower of two heights.
    fn lower(self, other: Self) -> Self {
        Heights {
            low: self.low.min(other.low),
            high: self.high.min(other.high),
            off: self.off.max(other.off),
        }
    }
}

/// What a position is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Within {
    Lake,
    River,
    Overlap,
    Step,
}

struct Judge<'a> {
    scene: &'a Scene,
    rivers: Vec<River>,
    rounding: f64,
}

/// Where a position comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// A vertex: one at a border is on it.
    Vertex,
    /// A position next to a bank.
    Bank,
    /// A cell: at a border it may be beyond.
    Cell,
}

impl Judge<'_> {
    /// What a position is in, and its right heights; `None` outside of water.
    fn expected(&self, p: Site) -> Option<(Within, Heights)> {
        let reach = REACH * STEP + self.rounding;
        let mut steps: Vec<f64> = Vec::new();
        for lake in &self.scene.lakes {
            let off = lake
                .rings
                .iter()
                .map(|ring| distance_to_line(ring, p))
                .fold(f64::INFINITY, f64::min);
            if off <= self.rounding || is_within(&lake.rings, p) {
                return Some((
                    Within::Lake,
                    Heights {
                        low: lake.level,
                        high: lake.level,
                        off: 0.0,
                    },
                ));
            }
            if off <= reach {
                steps.push(lake.level);
            }
        }
        let here: Vec<&River> = self
            .rivers
            .iter()
            .filter(|river| river.distance(p) <= self.rounding)
            .collect();
        let all: Vec<Heights> = here
            .iter()
            .map(|river| river.heights(p, self.rounding))
            .collect();
        let lowest = all.iter().copied().reduce(Heights::lower)?;
        let own = if all.len() > 1 {
            Within::Overlap
        } else {
            Within::River
        };
        let beside = self
            .rivers
            .iter()
            .filter(|river| (self.rounding..=reach).contains(&river.distance(p)));
        let beside: Vec<Heights> = beside.map(|river| river.heights(p, reach)).collect();
        // Beside an overlap in which the other river is higher, there is no step. It may be lower
        // within the width of the step.
        let near = here
            .iter()
            .flat_map(|river| &river.stretches)
            .filter(|stretch| stretch.distance(p) <= reach);
        let rise = near
            .map(|stretch| stretch.slope() * reach)
            .fold(0.0, f64::max);
        let is_step = steps.iter().any(|level| {
            [lowest.low, lowest.high]
                .iter()
                .any(|own| (level - own).abs() > 1e-9)
        }) || beside
            .iter()
            .any(|other| other.low < lowest.high + rise - 1e-9);
        if !is_step {
            return Some((own, lowest));
        }
        let of_lakes = steps.iter().map(|&level| Heights {
            low: level,
            high: level,
            off: 0.0,
        });
        let of_rivers = beside.into_iter().map(|other| lowest.lower(other));
        let stepped = of_lakes.chain(of_rivers).fold(lowest, Heights::hull);
        // A triangle of the step may reach along it to the next level line.
        let near = self
            .rivers
            .iter()
            .flat_map(|river| &river.stretches)
            .filter(|stretch| stretch.distance(p) <= reach);
        let heights = near.flat_map(|stretch| stretch.heights);
        let all = heights
            .map(|height| Heights {
                low: height,
                high: height,
                off: 0.0,
            })
            .fold(stepped, Heights::hull);
        Some((Within::Step, all))
    }

    /// Returns true if a position is so near to a border of water that it may be on either side.
    fn is_at_border(&self, p: Site) -> bool {
        let shores = self.scene.lakes.iter().flat_map(|lake| &lake.rings);
        shores
            .chain(self.rivers.iter().map(|river| &river.ring))
            .any(|ring| distance_to_line(ring, p) <= self.rounding)
    }

    /// Returns true if there may be no surface.
    fn is_left_out(&self, p: Site) -> bool {
        let is_out = |[min, max]: [Site; 2]| {
            (0..2).any(|k| p[k] < min[k] + self.rounding || p[k] > max[k] - self.rounding)
        };
        self.scene.bounds.is_some_and(is_out)
            || self.scene.holes.iter().any(|hole| {
                is_within(std::slice::from_ref(hole), p)
                    || distance_to_line(hole, p) <= self.rounding
            })
    }

    /// A vertex on the upper edges of walls, outside of water, has the lowest of their heights.
    fn judge_walls(&self, [x, y, z]: [f64; 3], counts: &mut Counts) -> Result<(), String> {
        let p = [x, y];
        // At a given vertex, lines that pass do not count.
        let own = |p: Site| {
            let here = self
                .scene
                .walls
                .iter()
                .flatten()
                .filter(|vertex| vertex[..2] == p);
            here.map(|vertex| vertex[2]).reduce(f64::min)
        };
        let heights = self
            .scene
            .walls
            .iter()
            .flat_map(|wall| wall.windows(2))
            .filter_map(|pair| {
                let ends = [pair[0], pair[1]].map(|end| [end[0], end[1]]);
                let q = nearest(ends, p);
                let part = distance(ends[0], q) / distance(ends[0], ends[1]);
                let [from, to] = ends.map(|end| own(end).expect("a vertex of a wall"));
                (distance(p, q) <= self.rounding).then_some(from + part * (to - from))
            });
        let own = own(p);
        let lowest = own.unwrap_or_else(|| heights.fold(f64::INFINITY, f64::min));
        let shores = self.scene.lakes.iter().flat_map(|lake| &lake.rings);
        let is_water = self
            .rivers
            .iter()
            .any(|river| river.distance(p) <= self.rounding)
            || self
                .scene
                .lakes
                .iter()
                .any(|lake| is_within(&lake.rings, p))
            || shores
                .into_iter()
                .any(|ring| distance_to_line(ring, p) <= self.rounding);
        // Points on lines between their vertices keep their heights.
        let is_point = || {
            self.scene
                .points
                .iter()
                .any(|point| distance([point[0], point[1]], p) <= self.rounding)
        };
        // A cut has the heights of the surface, which falls from a wall to water that it crosses.
        let bounds = self
            .scene
            .bounds
            .map(|[[a, b], [c, d]]| vec![[a, b], [c, b], [c, d], [a, d], [a, b]]);
        let plan = |line: &Vec<[f64; 3]>| line.iter().map(|p| [p[0], p[1]]).collect::<Vec<Site>>();
        let draped = self.scene.draped.iter().map(plan);
        let mut cuts = self.scene.holes.iter().cloned().chain(draped).chain(bounds);
        let mut is_cut = || cuts.any(|cut| distance_to_line(&cut, p) <= self.rounding);
        if lowest.is_infinite() || is_water || is_point() && own.is_none() || is_cut() {
            return Ok(());
        }
        counts.on_walls += 1;
        if (z - lowest).abs() > 1e-6 {
            return Err(format!(
                "{z} at {p:?}, on the upper edge of a wall at {lowest}"
            ));
        }
        Ok(())
    }

    fn judge(
        &self,
        p: Site,
        z: Option<f64>,
        from: Origin,
        counts: &mut Counts,
    ) -> Result<(), String> {
        let Some((within, right)) = self.expected(p) else {
            return Ok(());
        };
        if from == Origin::Cell && self.is_at_border(p) {
            counts.skipped += 1;
            return Ok(());
        }
        let Some(z) = z.filter(|z| z.is_finite()) else {
            if self.is_left_out(p) {
                return Ok(());
            }
            return Err(format!("no surface at {p:?}, {within:?} ({from:?})"));
        };
        match from {
            Origin::Vertex => counts.vertices += 1,
            Origin::Bank => counts.on_banks += 1,
            Origin::Cell => counts.cells += 1,
        }
        match within {
            Within::Overlap => counts.in_overlaps += 1,
            Within::Step => counts.in_steps += 1,
            Within::Lake | Within::River => (),
        }
        // A position next to a bank may be in a step of some height.
        let off = match (within, from) {
            (Within::Lake, Origin::Vertex | Origin::Cell) => 0.0,
            (_, Origin::Bank) => 1e-9 + right.off + 40.0 * self.rounding / STEP,
            _ => 1e-9 + right.off,
        };
        let mut range = [right.low - off, right.high + off];
        if from == Origin::Cell {
            range = range.map(|bound| f64::from(bound as f32)); // as cells are
        }
        if range[0] <= z && z <= range[1] {
            return Ok(());
        }
        Err(format!(
            "{z} at {p:?}, expected {} to {} ({from:?}, {within:?})",
            right.low, right.high
        ))
    }
}

/// Judges the surface of a scene.
///
/// # Errors
/// The first position with a wrong height.
pub(crate) fn judge(scene: &Scene) -> Result<Counts, String> {
    let product = match scene.build() {
        Ok(product) => product,
        Err(error) if error.to_string().starts_with("no triangle is left") => {
            return Ok(Counts::default());
        }
        Err(error) => return Err(format!("refused: {error}")),
    };
    let rounding = scene.rounding();
    let rivers = levels::of(&scene.rivers, rounding)
        .iter()
        .map(|stations| River::new(stations))
        .collect();
    let judge = Judge {
        scene,
        rivers,
        rounding,
    };
    let mut counts = Counts::default();
    judge_vertices(&judge, &product, &mut counts)?;
    judge_banks(&judge, &product, &mut counts)?;
    judge_cells(&judge, &product, &mut counts)?;
    Ok(counts)
}

fn judge_vertices(
    judge: &Judge,
    product: &SurfaceProduct,
    counts: &mut Counts,
) -> Result<(), String> {
    let surface: &dyn Surface = product.triangles().map_err(|error| error.to_string())?;
    let faces = (0..surface.face_count() as u32).filter_map(|face| surface.face(face));
    let mut vertices: Vec<u32> = faces.flatten().collect();
    vertices.sort_unstable();
    vertices.dedup();
    for [x, y, z] in vertices.into_iter().map(|vertex| surface.position(vertex)) {
        judge.judge([x, y], Some(z), Origin::Vertex, counts)?;
        judge.judge_walls([x, y, z], counts)?;
    }
    Ok(())
}

/// Positions between the vertices of banks, inside by rounding: the sides of a vertex that was
/// computed on a bank are not exactly on it, and what is between it and them is of any slope.
fn judge_banks(judge: &Judge, product: &SurfaceProduct, counts: &mut Counts) -> Result<(), String> {
    const PARTS: usize = 9;
    let mut sites: Vec<Site> = Vec::new();
    for ring in judge.rivers.iter().map(|river| &river.ring) {
        let area: f64 = ring
            .windows(2)
            .map(|pair| cross(from_to(ring[0], pair[0]), from_to(ring[0], pair[1])))
            .sum();
        for pair in ring.windows(2) {
            let along = from_to(pair[0], pair[1]);
            let by = area.signum() * judge.rounding / along[0].hypot(along[1]);
            let inward = [-by * along[1], by * along[0]];
            let at = |k: usize| {
                [0, 1].map(|axis| {
                    pair[0][axis] + k as f64 / PARTS as f64 * along[axis] + inward[axis]
                })
            };
            sites.extend((1..PARTS).map(at));
        }
    }
    if sites.is_empty() {
        return Ok(());
    }
    let found = elevations(product, &sites, Method::Linear, &Context::default())
        .map_err(|error| error.to_string())?;
    for (p, z) in sites.into_iter().zip(found) {
        judge.judge(p, Some(z), Origin::Bank, counts)?;
    }
    Ok(())
}

fn judge_cells(judge: &Judge, product: &SurfaceProduct, counts: &mut Counts) -> Result<(), String> {
    let ([min, max], size) = judge.scene.frame();
    let extent = Bounds {
        min: [min[0], min[1], 0.0],
        max: [max[0], max[1], 0.0],
    };
    let frame = FrameOptions {
        resolution: Some(size),
        extent: Some(extent),
        ..FrameOptions::default()
    };
    let options = DemOptions {
        frame,
        ..DemOptions::default()
    };
    let context = Context::default();
    let cells = dem(product, &options, &context).and_then(|cells| cells.collect(&context));
    let grid = cells.map_err(|error| error.to_string())?;
    let [x0, dx, _, y0, _, dy] = grid.frame.transform;
    for (k, &z) in grid.values.iter().enumerate() {
        let [column, row] = [k % grid.frame.width, k / grid.frame.width].map(|n| n as f64 + 0.5);
        judge.judge(
            [x0 + column * dx, y0 + row * dy],
            Some(z),
            Origin::Cell,
            counts,
        )?;
    }
    Ok(())
}
