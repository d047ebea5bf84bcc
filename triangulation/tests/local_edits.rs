//! Local edits give the same result as a new construction: the same points, triangles, constraints
//! and chains.
//!
//! With `BREAKLINE_EDITS=100000` in the environment, this many edits of each kind of coordinates
//! are compared.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Crossing, Plane, Terrain};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{ConstrainedDelaunay, Level, LineId, OnCrossing, Rounding};
use testkit::random::{Random, ulps};

type Bits = Vec<u64>;
type SiteSets = BTreeSet<Vec<Bits>>;

/// Everything observable of a triangulation, independent of its numbering.
#[derive(Debug, PartialEq)]
struct Seen {
    points: BTreeSet<Bits>,
    triangles: SiteSets,
    constraints: SiteSets,
    chains: Vec<Vec<Bits>>,
    crossings: BTreeSet<Bits>,
    rounding: Option<Rounding>,
}

trait Coordinates: Crossing<Point: PartialEq + std::fmt::Debug> + Default {
    fn bits(p: &Self::Point) -> Bits;
    fn point(random: &mut Random, at: [f64; 2]) -> Self::Point;
}

impl Coordinates for Plane {
    fn bits(p: &[f64; 2]) -> Bits {
        p.iter().map(|x| (x + 0.0).to_bits()).collect()
    }

    fn point(_: &mut Random, at: [f64; 2]) -> [f64; 2] {
        at
    }
}

/// The height is a function of the site: points on one site are equal.
impl Coordinates for Terrain {
    fn bits(p: &[f64; 3]) -> Bits {
        p.iter().map(|x| (x + 0.0).to_bits()).collect()
    }

    fn point(_: &mut Random, [x, y]: [f64; 2]) -> [f64; 3] {
        [x, y, (x * 7.0 + y * 3.0) % 11.0]
    }
}

fn seen<G: Coordinates>(t: &ConstrainedDelaunay<G>, lines: &[LineId]) -> Seen {
    let at = |v: &VertexId| G::bits(t.point(*v));
    let sorted = |vertices: &[VertexId]| {
        let mut sites: Vec<Bits> = vertices.iter().map(at).collect();
        sites.sort_unstable();
        sites
    };
    Seen {
        points: t.tds().vertices().map(|v| at(&v)).collect(),
        triangles: t
            .finite_cells()
            .map(|cell| sorted(t.tds().cell_vertices(cell)))
            .collect(),
        constraints: t.constrained_edges().map(|edge| sorted(&edge)).collect(),
        chains: lines
            .iter()
            .map(|&line| t.chain(line).iter().map(at).collect())
            .collect(),
        crossings: t.crossings().iter().map(at).collect(),
        rounding: t.rounding(),
    }
}

/// Points and lines as they were given.
struct Model<G: Coordinates> {
    points: Vec<G::Point>,
    lines: Vec<(LineId, Vec<G::Point>)>,
}

impl<G: Coordinates> Model<G> {
    fn built(&self) -> (ConstrainedDelaunay<G>, Vec<LineId>) {
        let mut all = self.points.clone();
        let mut indexed: Vec<Vec<u32>> = Vec::new();
        for (_, line) in &self.lines {
            indexed.push((all.len() as u32..(all.len() + line.len()) as u32).collect());
            all.extend(line);
        }
        let (t, _) =
            ConstrainedDelaunay::from_lines(G::default(), &all, &indexed, OnCrossing::Split)
                .unwrap();
        let ids = t.lines().collect();
        (t, ids)
    }

    /// Makes one random edit of both; returns its name.
    fn edit(
        &mut self,
        t: &mut ConstrainedDelaunay<G>,
        random: &mut Random,
        site: &Site,
        most: usize,
    ) -> String {
        let draw = |random: &mut Random| {
            let at = site(random);
            G::point(random, at)
        };
        let kind = if self.lines.len() > most {
            3 + random.below(2)
        } else {
            random.below(12)
        };
        let same = |p: &G::Point, q: &G::Point| G::bits(p)[..2] == G::bits(q)[..2];
        match kind {
            0..3 => {
                let count = 1 + random.index(3) / 2;
                let mut line = || (0..1 + random.index(4)).map(|_| draw(random)).collect();
                let new: Vec<Vec<G::Point>> = (0..count).map(|_| line()).collect();
                let ids = t.insert_lines(&new).unwrap();
                let name = format!("lines {new:?}");
                self.lines.extend(ids.into_iter().zip(new));
                name
            }
            3 | 4 if !self.lines.is_empty() => {
                let (line, gone) = self.lines.remove(random.index(self.lines.len()));
                assert!(t.remove_line(line));
                format!("without {gone:?}")
            }
            5 if !self.lines.is_empty() => {
                let at = random.index(self.lines.len());
                let vertex = random.index(self.lines[at].1.len());
                if let Some(rest) = t.split_line(self.lines[at].0, vertex) {
                    let tail = self.lines[at].1[vertex..].to_vec();
                    self.lines[at].1.truncate(vertex + 1);
                    self.lines.push((rest, tail));
                }
                "split".to_owned()
            }
            6 if !self.lines.is_empty() => {
                let (i, j) = (
                    random.index(self.lines.len()),
                    random.index(self.lines.len()),
                );
                if t.join_lines(self.lines[i].0, self.lines[j].0) {
                    let tail = self.lines[j].1[1..].to_vec();
                    self.lines[i].1.extend(tail);
                    self.lines.remove(j);
                }
                "join".to_owned()
            }
            7 | 8 if t.vertex_count() > 3 => {
                let vertices: Vec<VertexId> = t.tds().vertices().collect();
                let vertex = random.pick(&vertices);
                let p = *t.point(vertex);
                if kind == 8 && self.lines.len() > most / 2 {
                    let Ok((_, gone)) = t.remove_with_lines(vertex) else {
                        return "kept".to_owned();
                    };
                    self.lines.retain(|(line, _)| !gone.contains(line));
                } else if t.remove(vertex).is_err() {
                    return "kept".to_owned();
                }
                self.points.retain(|q| !same(q, &p));
                if random.below(2) == 0 {
                    let q = draw(random); // moved
                    self.points.push(q);
                    t.insert(q).unwrap();
                    return format!("moved {p:?} to {q:?}");
                }
                format!("without {p:?}")
            }
            9 if !t.crossings().is_empty() => {
                let crossing = random.pick(t.crossings());
                let at = t.geometry().plan(t.point(crossing));
                let p = G::point(random, at);
                self.points.push(p);
                t.insert(p).unwrap();
                format!("given crossing {p:?}")
            }
            _ => {
                let p = draw(random);
                self.points.push(p);
                t.insert(p).unwrap();
                format!("with {p:?}")
            }
        }
    }
}

type Site = dyn Fn(&mut Random) -> [f64; 2];

/// Returns the percentage of edits that arranged all lines anew.
fn compare<G: Coordinates>(seed: u64, few: usize, most: usize, site: &Site) -> usize {
    let count = std::env::var("BREAKLINE_EDITS")
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(few);
    let mut random = Random(seed);
    let (mut done, mut anew) = (0, 0);
    while done < count {
        let points = (0..3 + random.index(8))
            .map(|_| site(&mut random))
            .collect::<Vec<_>>();
        let points: Vec<G::Point> = points
            .into_iter()
            .map(|at| G::point(&mut random, at))
            .collect();
        let mut t: ConstrainedDelaunay<G> = ConstrainedDelaunay::from_points(G::default(), &points)
            .unwrap()
            .0;
        let mut model = Model {
            points,
            lines: Vec::new(),
        };
        let mut names = Vec::new();
        for _ in 0..60 {
            let before = format!(
                "{:?} {:?}",
                model.points,
                model.lines.iter().map(|(_, l)| l).collect::<Vec<_>>()
            );
            names.push(model.edit(&mut t, &mut random, site, most));
            done += 1;
            let (fresh, fresh_ids) = model.built();
            let history = || {
                format!(
                    "seed {seed}, edit {done}: {before}: {}",
                    names[names.len() - 1]
                )
            };
            assert_eq!(t.check(Level::Law), [], "{}", history());
            if fresh.dimension() == 2 {
                let ids: Vec<LineId> = model.lines.iter().map(|(line, _)| *line).collect();
                let (there, anew) = (seen(&t, &ids), seen(&fresh, &fresh_ids));
                assert_eq!(there.rounding, anew.rounding, "{}", history());
                assert_eq!(there.points, anew.points, "{}", history());
                assert_eq!(there.crossings, anew.crossings, "{}", history());
                assert_eq!(there.chains, anew.chains, "{}", history());
                let only = |p: &SiteSets, q: &SiteSets| -> Vec<Vec<Vec<f64>>> {
                    p.difference(q)
                        .map(|c| {
                            c.iter()
                                .map(|b| b.iter().map(|&x| f64::from_bits(x)).collect())
                                .collect()
                        })
                        .collect()
                };
                let apart = [
                    only(&there.constraints, &anew.constraints),
                    only(&anew.constraints, &there.constraints),
                ];
                assert!(apart.iter().all(Vec::is_empty), "{apart:?} {}", history());
                assert!(there == anew, "{}", history());
            }
        }
        anew += t.rearrangements();
    }
    100 * anew / done
}

#[test]
fn on_small_grids() {
    let anew = compare::<Plane>(1, 2400, 12, &|random| {
        [random.below(7) as f64 + 64.0, random.below(7) as f64 + 64.0]
    });
    assert!(anew < 25, "{anew} % of the edits arranged all lines anew");
}

#[test]
fn around_zero() {
    compare::<Plane>(2, 1200, 8, &|random| {
        [random.below(7) as f64 - 3.0, random.below(7) as f64 - 3.0]
    });
}

/// Heights at crossings come from all lines there.
#[test]
fn with_heights() {
    compare::<Terrain>(3, 1200, 12, &|random| {
        [
            random.below(9) as f64 + 128.0,
            random.below(9) as f64 + 256.0,
        ]
    });
}

#[test]
fn in_centimeters_far_away() {
    compare::<Plane>(4, 1200, 12, &|random| {
        [
            500_000.0 + random.below(300) as f64 * 0.01,
            4_649_000.0 + random.below(8) as f64 * 0.01,
        ]
    });
}

#[test]
fn a_rounding_apart() {
    let anew = compare::<Plane>(5, 2400, 10, &|random| {
        [
            ulps(500_000.37, random.around(4)),
            ulps(4_649_000.12, random.around(4)),
        ]
    });
    assert!(anew < 25, "{anew} % of the edits arranged all lines anew");
}

#[test]
fn off_the_grid() {
    compare::<Plane>(6, 1200, 10, &|random| {
        let mut fine =
            || ulps(0.5, random.around(3)) * if random.below(4) == 0 { 64.0 } else { 1.0 };
        [fine(), fine()]
    });
    let anew = compare::<Plane>(7, 1200, 12, &|random| {
        [10.0 * random.unit(), 10.0 * random.unit()]
    });
    assert!(anew < 25, "{anew} % of the edits arranged all lines anew");
}
