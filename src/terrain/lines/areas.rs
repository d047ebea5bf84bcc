//! Areas of water and walls: which points they replace, and the heights of all vertices in water.

use rustc_hash::{FxHashMap, FxHashSet};

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ops::Range;

use super::{Flat, River, RiverWater, Wall};
use crate::error::{Error, Result, Setting, wording};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::inside::{Inside, sides};
use crate::terrain::near_lines::NearLines;
use crate::terrain::regions::{self, Domain, Faces};
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::LineId;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};

/// An area of water, and the numbers of the lines around it.
#[derive(Debug, Clone)]
pub(crate) struct Water {
    /// All lines of the water.
    pub(crate) lines: Range<usize>,
    /// The lines that bound the area together.
    pub(crate) rim: Vec<usize>,
    pub(crate) level: WaterLevel,
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

/// The cells of a triangulation, divided by the lines around water.
struct Divided<'a> {
    triangulation: &'a ConstrainedDelaunay<Terrain>,
    /// For each edge on such lines, from the smaller vertex to the larger, the areas that it
    /// bounds, each as often as lines around it run along the edge.
    domains: FxHashMap<[VertexId; 2], Vec<Domain>>,
}

impl Faces for Divided<'_> {
    fn beyond(&self, face: u32, side: usize, domains: &mut Vec<Domain>) -> Option<u32> {
        let (tds, cell) = (self.triangulation.tds(), CellId::new(face as usize));
        if self.triangulation.is_constrained(cell, side) {
            let [p, q] = tds.edge_ends(cell, side);
            domains.extend(
                self.domains
                    .get(&[p.min(q), p.max(q)])
                    .into_iter()
                    .flatten(),
            );
        }
        Some(tds.neighbor(cell, side).index() as u32)
    }
}

/// The cells in water, once all vertices there have its height.
#[derive(Debug, Default)]
pub(crate) struct Leveled {
    /// For each cell number, true if the cell lies in water; empty if there is none.
    pub(crate) is_water: Vec<bool>,
    /// The bits of the sites of all vertices there.
    pub(crate) sites: FxHashSet<[u64; 2]>,
}

/// Gives all vertices in water its height, shores and banks included.
///
/// In a lake that is the height of the lake, to the last bit. In a river it is the height between
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
    let divided = Divided::by_rims(triangulation, waters);
    let Some(labels) = divided.labels() else {
        return Ok(Leveled::default());
    };
    let around = divided.areas_around(&labels);
    let heights = WaterHeights {
        waters,
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
    Ok(Leveled { is_water, sites })
}

/// Which areas of water the cells of a triangulation lie in.
struct Labels {
    /// For each cell number, its label: an index into `areas`.
    of_cells: Vec<u32>,
    /// The areas of each label; none for the first.
    areas: Vec<Vec<Domain>>,
}

impl<'a> Divided<'a> {
    /// Divides a triangulation by the lines around waters; each water is a domain.
    fn by_rims(triangulation: &'a ConstrainedDelaunay<Terrain>, waters: &[Water]) -> Self {
        let mut domains: FxHashMap<[VertexId; 2], Vec<Domain>> = FxHashMap::default();
        for (domain, water) in waters.iter().enumerate() {
            for &line in &water.rim {
                for pair in triangulation.chain(LineId::new(line)).windows(2) {
                    domains
                        .entry([pair[0].min(pair[1]), pair[0].max(pair[1])])
                        .or_default()
                        .push(domain);
                }
            }
        }
        Divided {
            triangulation,
            domains,
        }
    }

    /// The areas that each cell lies in; `None` if there are no cells.
    fn labels(&self) -> Option<Labels> {
        let tds = self.triangulation.tds();
        let start = tds.cell_of(VertexId::INFINITE)?;
        let mut areas: Vec<Vec<Domain>> = vec![Vec::new()];
        let of_cells = regions::label(
            self,
            tds.cell_slots(),
            start.index() as u32,
            Vec::new(),
            |within| {
                if within.is_empty() {
                    return 0;
                }
                areas.push(within.to_vec());
                areas.len() as u32 - 1
            },
        );
        Some(Labels { of_cells, areas })
    }

    /// The areas around each vertex that lies in water or on its border, ordered by vertex. An area
    /// may be named several times.
    fn areas_around(&self, labels: &Labels) -> Vec<(VertexId, Vec<Domain>)> {
        let tds = self.triangulation.tds();
        let mut around: FxHashMap<VertexId, Vec<Domain>> = FxHashMap::default();
        for cell in tds
            .cells()
            .filter(|cell| labels.of_cells[cell.index()] != 0)
        {
            let within = &labels.areas[labels.of_cells[cell.index()] as usize];
            for &vertex in tds
                .corners(cell)
                .iter()
                .filter(|vertex| **vertex != VertexId::INFINITE)
            {
                around.entry(vertex).or_default().extend(within);
            }
        }
        // Where rounding brought banks together, a line around water may reach a vertex by the
        // edges on which it leaves it, so that no water lies between them.
        for (edge, areas) in &self.domains {
            for vertex in edge {
                if let Some(others) = around.get_mut(vertex) {
                    others.extend(areas);
                }
            }
        }
        let mut vertices: Vec<(VertexId, Vec<Domain>)> = around.into_iter().collect();
        vertices.sort_unstable_by_key(|(vertex, _)| *vertex);
        vertices
    }
}

/// What the heights of vertices in water follow from.
struct WaterHeights<'a> {
    waters: &'a [Water],
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
                WaterLevel::Flat(flat) => Some((area, flat.height)),
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
