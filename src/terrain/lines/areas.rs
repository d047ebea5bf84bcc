//! Areas of water and walls: which points they replace, and the heights of all vertices in water.

use rustc_hash::{FxHashMap, FxHashSet};

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ops::Range;

use super::divided::Divided;
use super::lake_levels::{JoinedLake, LakeLevels};
use super::{Flat, River, RiverWater, Wall};
use crate::error::{Error, Result, Setting, wording};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::inside::{Inside, sides};
use crate::terrain::near_lines::NearLines;
use crate::terrain::regions::Domain;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::LineId;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::VertexId;

/// An area of water, and the numbers of the lines around it.
#[derive(Debug, Clone)]
pub(crate) struct Water {
    /// All lines of the water.
    pub(crate) lines: Range<usize>,
    /// The lines that bound the area together.
    pub(crate) rim: Vec<usize>,
    pub(crate) level: WaterLevel,
}

impl Water {
    /// Returns the lake and the number of its first line; `None` for a river.
    fn lake(&self) -> Option<(&Flat, usize)> {
        match &self.level {
            WaterLevel::Flat(flat) => Some((flat, self.lines.start)),
            WaterLevel::River(_) => None,
        }
    }
}

/// The heights of water.
#[derive(Debug, Clone)]
pub(crate) enum WaterLevel {
    Flat(Flat),
    River(River),
}

impl WaterLevel {
    /// The rings around the water, in plan.
    pub(crate) fn rings(&self) -> Rings {
        match self {
            WaterLevel::Flat(flat) => rings_of(flat),
            WaterLevel::River(river) => vec![river.ring()],
        }
    }
}

/// The rings of a polygon, in plan.
pub(crate) type Rings = Vec<Vec<[f64; 2]>>;

/// The rings of a lake, in plan.
fn rings_of(flat: &Flat) -> Rings {
    flat.rings
        .iter()
        .map(|ring| ring.iter().map(|p| [p[0], p[1]]).collect())
        .collect()
}

/// The points that areas of water and walls replace.
#[derive(Debug, Clone, Default)]
pub(crate) struct Replaced {
    polygons: Vec<Rings>,
    /// Shores, by the distance up to which points outside are replaced, too.
    buffers: Vec<(f64, Vec<Rings>)>,
    /// Rings whose vertices were computed: a point on one of them may be outside by rounding.
    computed: Vec<Rings>,
}

/// How far rounding moves a computed vertex, in units in the last place of the largest coordinate.
const ROUNDING: f64 = 4.0;

impl Replaced {
    pub(crate) fn add_flat(&mut self, flat: &Flat) {
        let rings = rings_of(flat);
        if flat.buffer > 0.0 {
            match self
                .buffers
                .iter_mut()
                .find(|(buffer, _)| *buffer == flat.buffer)
            {
                Some((_, shores)) => shores.push(rings.clone()),
                None => self.buffers.push((flat.buffer, vec![rings.clone()])),
            }
        }
        self.polygons.push(rings);
    }

    pub(crate) fn add_river(&mut self, river: &River) {
        let ring = river.ring();
        self.polygons.push(vec![ring.clone()]);
        self.computed.push(vec![ring]);
    }

    pub(crate) fn add_wall(&mut self, wall: &Wall) {
        self.polygons.extend(wall.areas.iter().cloned());
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// Removes the points that are replaced, and returns them in order.
    ///
    /// # Complexity
    /// O(n log n) for n sides of areas, and for each point linear in the sides at about its y.
    pub(crate) fn split_off(&self, points: &mut Vec<[f64; 3]>) -> Vec<[f64; 3]> {
        let inside = Inside::new(&self.polygons);
        let largest = self
            .computed
            .iter()
            .flatten()
            .flatten()
            .flatten()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        let rounded = (ROUNDING * f64::EPSILON * largest, &self.computed);
        let buffers = self
            .buffers
            .iter()
            .map(|(buffer, shores)| (*buffer, shores))
            .chain([rounded]);
        let sides_of =
            |rings: &[Rings]| NearLines::new(rings.iter().flatten().flat_map(|ring| sides(ring)));
        let near: Vec<(f64, NearLines)> = buffers
            .map(|(distance, rings)| (distance, sides_of(rings)))
            .collect();
        let mut replaced = Vec::new();
        points.retain(|&p| {
            let site = [p[0], p[1]];
            let is_replaced = inside.contains(site)
                || near
                    .iter()
                    .any(|(buffer, shores)| shores.pass(site, *buffer));
            if is_replaced {
                replaced.push(p);
            }
            !is_replaced
        });
        replaced
    }
}

/// The cells in water, once all vertices there have its height.
#[derive(Debug, Default)]
pub(crate) struct Leveled {
    /// For each cell number, true if the cell lies in water; empty if there is none.
    pub(crate) is_water: Vec<bool>,
    /// The bits of the sites of all vertices there.
    pub(crate) sites: FxHashSet<[u64; 2]>,
    /// The lakes that have the height of another one.
    pub(crate) joined: Vec<JoinedLake>,
}

/// Gives all vertices in water its height, shores and banks included.
///
/// In a lake that is the height of the lake, to the last bit; in lakes that meet, that of the
/// largest. In a river it is the height between
/// the level lines; where rivers overlap, the lowest. A lake counts before a river.
///
/// `given` are the heights that the vertices of the lines around rivers were given with, by the
/// numbers of the lines. `overlapping` are the pairs of rivers that overlap: where their banks lie
/// on each other, rounding decides which of them is outside.
///
/// # Errors
/// If lakes of different heights overlap or touch.
///
/// # Complexity
/// Linear in the cells; for vertices in rivers, also logarithmic in the number of level lines.
pub(crate) fn level(
    triangulation: &mut ConstrainedDelaunay<Terrain>,
    waters: &[Water],
    given: &[(usize, Vec<f64>)],
    overlapping: &[[usize; 2]],
    name: &dyn Fn(usize) -> String,
) -> Result<Leveled> {
    if waters.is_empty() {
        return Ok(Leveled::default());
    }
    let rims = waters.iter().enumerate().flat_map(|(area, water)| {
        let lines = water.rim.iter();
        lines.map(move |&line| (area, LineId::new(line)))
    });
    let divided = Divided::by_rims(triangulation, rims);
    let Some(labels) = divided.labels() else {
        return Ok(Leveled::default());
    };
    let around = divided.areas_around(&labels);
    let flats: Vec<Option<(&Flat, usize)>> = waters.iter().map(Water::lake).collect();
    let lakes = LakeLevels::new(&flats, around.iter().map(|(_, areas)| areas.as_slice()));
    let heights = WaterHeights {
        waters,
        lakes: &lakes,
        own: own_heights(triangulation, waters, given),
        surfaces: waters.iter().map(|_| OnceCell::new()).collect(),
        pairs: overlapping.iter().copied().collect(),
        reaches: reaches_of(waters, overlapping),
        rounding: rounding_of(
            around
                .iter()
                .map(|(vertex, _)| *triangulation.point(*vertex)),
        ),
    };
    let mut new_heights: Vec<(VertexId, f64)> = Vec::with_capacity(around.len());
    for (vertex, mut areas) in around {
        let [x, y, _] = *triangulation.point(vertex);
        heights.add_near(&mut areas, [x, y]);
        let height = match heights.of_lakes(&areas, [x, y], name)? {
            Some(height) => Some(height),
            None => heights.of_rivers(&areas, vertex, [x, y]),
        };
        new_heights.extend(height.map(|height| (vertex, height)));
    }
    let is_water = labels.of_cells.iter().map(|label| *label != 0).collect();
    let mut sites = FxHashSet::default();
    for (vertex, height) in new_heights {
        let [x, y, _] = *triangulation.point(vertex);
        sites.insert([x.to_bits(), y.to_bits()]);
        triangulation.replace_point(vertex, [x, y, height]);
    }
    Ok(Leveled {
        is_water,
        sites,
        joined: lakes.joined,
    })
}

/// What the heights of vertices in water follow from.
struct WaterHeights<'a> {
    waters: &'a [Water],
    lakes: &'a LakeLevels,
    /// The heights that vertices around rivers were given with.
    own: FxHashMap<(Domain, VertexId), f64>,
    /// The surface of each river, once it is needed.
    surfaces: Vec<OnceCell<RiverWater>>,
    /// The pairs of rivers that overlap.
    pairs: FxHashSet<[Domain; 2]>,
    /// The stretches of the second of each pair.
    reaches: Boxes<Reach>,
    /// How far rounding moves vertices.
    rounding: f64,
}

impl WaterHeights<'_> {
    fn surface(&self, area: Domain, river: &River) -> &RiverWater {
        self.surfaces[area].get_or_init(|| RiverWater::new(river))
    }

    /// Adds the rivers to the areas around a position that overlap one of these and are as close as
    /// rounding goes. Then each area is named once, in order.
    fn add_near(&self, areas: &mut Vec<Domain>, [x, y]: [f64; 2]) {
        let mut near: Vec<Domain> = Vec::new();
        self.reaches
            .find_in(Extent::of_plan([[x, y]]).grown(self.rounding), |reach| {
                let is_other = !areas.contains(&reach.area) && !near.contains(&reach.area);
                if is_other
                    && areas
                        .iter()
                        .any(|area| self.pairs.contains(&[*area, reach.area]))
                    && let WaterLevel::River(river) = &self.waters[reach.area].level
                    && self
                        .surface(reach.area, river)
                        .is_near([x, y], self.rounding)
                {
                    near.push(reach.area);
                }
                None::<()>
            });
        areas.extend(near);
        areas.sort_unstable();
        areas.dedup();
    }

    /// The height of the lakes among some areas; `None` if there are none.
    ///
    /// # Errors
    /// If their heights differ.
    fn of_lakes(
        &self,
        areas: &[Domain],
        at: [f64; 2],
        name: &dyn Fn(usize) -> String,
    ) -> Result<Option<f64>> {
        let mut lakes = areas
            .iter()
            .filter_map(|&area| match &self.waters[area].level {
                WaterLevel::Flat(_) => Some((area, self.lakes.of(area))),
                WaterLevel::River(_) => None,
            });
        let Some((first, height)) = lakes.next() else {
            return Ok(None);
        };
        match lakes.find(|(_, other)| *other != height) {
            Some(other) => Err(two_lakes([(first, height), other], at, self.waters, name)),
            None => Ok(Some(height)),
        }
    }

    /// The lowest height of the rivers among some areas at a vertex; `None` if there are none.
    fn of_rivers(&self, areas: &[Domain], vertex: VertexId, at: [f64; 2]) -> Option<f64> {
        let rivers = areas
            .iter()
            .filter_map(|&area| match &self.waters[area].level {
                WaterLevel::River(river) => Some(match self.own.get(&(area, vertex)) {
                    Some(height) => *height,
                    None => self.surface(area, river).height(at),
                }),
                WaterLevel::Flat(_) => None,
            });
        Some(rivers.fold(f64::INFINITY, f64::min)).filter(|lowest| lowest.is_finite())
    }
}

/// A stretch of a river, and the number of its area.
#[derive(Debug, Clone, Copy)]
struct Reach {
    area: Domain,
    extent: Extent,
}

impl Boxed for Reach {
    fn extent(&self) -> Extent {
        self.extent
    }
}

/// The stretches of the rivers that are the second of some pairs.
fn reaches_of(waters: &[Water], pairs: &[[Domain; 2]]) -> Boxes<Reach> {
    let areas: BTreeSet<Domain> = pairs.iter().map(|[_, area]| *area).collect();
    let mut reaches = Vec::new();
    for area in areas {
        let WaterLevel::River(river) = &waters[area].level else {
            continue;
        };
        let extent = |stretch| Extent::of(river.triangles(stretch).concat());
        reaches.extend((0..river.stretch_count()).map(|stretch| Reach {
            area,
            extent: extent(stretch),
        }));
    }
    Boxes::new(reaches)
}

/// How far rounding moves computed vertices among these.
pub(crate) fn rounding_of(vertices: impl Iterator<Item = [f64; 3]>) -> f64 {
    let largest = vertices.fold(0.0_f64, |most, [x, y, _]| most.max(x.abs()).max(y.abs()));
    ROUNDING * f64::EPSILON * largest
}

/// The heights that the lines around each river were given with at their vertices; the lowest if
/// they differ.
fn own_heights(
    triangulation: &ConstrainedDelaunay<Terrain>,
    waters: &[Water],
    given: &[(usize, Vec<f64>)],
) -> FxHashMap<(Domain, VertexId), f64> {
    let rivers = waters
        .iter()
        .enumerate()
        .filter(|(_, water)| matches!(water.level, WaterLevel::River(_)));
    let areas: FxHashMap<usize, Domain> = rivers
        .flat_map(|(area, water)| water.rim.iter().map(move |&line| (line, area)))
        .collect();
    let mut own: FxHashMap<(Domain, VertexId), f64> = FxHashMap::default();
    for (line, heights) in given {
        let Some(&area) = areas.get(line) else {
            continue;
        };
        for (&vertex, &height) in triangulation
            .line_vertices(LineId::new(*line))
            .iter()
            .zip(heights)
        {
            let lowest = own.entry((area, vertex)).or_insert(height);
            *lowest = lowest.min(height);
        }
    }
    own
}

#[cold]
fn two_lakes(
    lakes: [(Domain, f64); 2],
    [x, y]: [f64; 2],
    waters: &[Water],
    name: &dyn Fn(usize) -> String,
) -> Error {
    let [(first, height), (other, different)] = lakes.map(|(area, height)| {
        (
            name(waters[area].rim.first().copied().unwrap_or_default()),
            height,
        )
    });
    Error::format(format!(
        "two lakes meet at {x} {y} with different heights: {height} of {first}, {different} of {other}"
    ))
    .cure(wording!["correct the shores, or give both lakes one height with ", Setting::FlatHeight])
}
