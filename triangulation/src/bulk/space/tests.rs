//! Holds the filter against exact arithmetic, and gives the builder predicates that contradict each
//! other.

use std::cmp::Ordering;

use testkit::random::Random;

use crate::bulk::Grain;
use crate::geometry::{Coordinates, Geometry, Space, WeightedSpace};
use crate::kernel::{Adaptive, Fast, InSphere, Kernel, Orientation3, PowerTest3};
use crate::num::Sign;
use crate::parallel::on_threads;
use crate::tds::VertexId;

use super::blocks::Blocks;
use super::mesh::Extent;
use super::order::rounds;
use super::part::Built;
use super::predicates::Precision;
use super::source::with_source;
use super::sphere::{self, Frame, Origin};
use super::{build, by_blocks, whole};

const FRAME: Frame = Frame {
    middle: [0.0; 3],
    scale: 1.0,
};

/// Returns a number whose magnitude is spread over `2^-exponents..1`, of either sign.
fn spread(random: &mut Random, exponents: usize) -> f64 {
    let size = 2f64.powi(-(random.index(exponents) as i32)) * (0.5 + 0.5 * random.unit());
    if random.below(2) == 0 { size } else { -size }
}

/// Returns the exact side, and the sure side if there is one, of `q` and the sphere through four
/// points.
fn sides_of(points: [[f64; 3]; 4], q: [f64; 3]) -> (Sign, Option<Sign>) {
    let exact = Adaptive::sign(&InSphere([points[0], points[1], points[2], points[3], q]));
    let [points, [q, ..]] = [points, [q; 4]].map(|points| points.map(|[x, y, z]| [x, y, z, 0.0]));
    let (exact_by_power, sure) = powers_of(points, q, 0.0, 0.0);
    assert_eq!(
        exact_by_power,
        exact * Adaptive::sign(&Orientation3(points.map(site)))
    );
    (exact_by_power, sure)
}

fn site([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// Returns the exact side, and the sure side if there is one, of `q` and the sphere orthogonal to
/// four points with weights between `greatest` and `greatest - range`.
fn powers_of(
    points: [[f64; 4]; 4],
    q: [f64; 4],
    greatest: f64,
    range: f64,
) -> (Sign, Option<Sign>) {
    let [a, b, c, d] = points;
    let arrows = [a, b, c].map(|p| {
        let [x, y, z, square] = sphere::arrow(site(d), site(p));
        [x, y, z, square - (p[3] - d[3])]
    });
    let lack = |p: [f64; 4]| (greatest - p[3]) * FRAME.scale * FRAME.scale;
    let origin = Origin {
        at: FRAME.of(site(d)),
        lack: lack(d),
        range,
    };
    let row = sphere::through([arrows.each_ref(); 4], origin, FRAME.scale)[0];
    let query = sphere::query(FRAME.of(site(q)), lack(q));
    let sides = sphere::sides([row; 4], query);
    assert_eq!(sides.marked, 0);
    let exact = Adaptive::sign(&PowerTest3([a, b, c, d, q]))
        * Adaptive::sign(&Orientation3(points.map(site)));
    let sure = (sides.sure & 1 == 1).then_some(if sides.inside & 1 == 1 {
        Sign::Positive
    } else {
        Sign::Negative
    });
    assert_eq!(sphere::is_inside(row, query), sure == Some(Sign::Positive));
    (exact, sure)
}

/// Points close to the sphere, at any relative distance; spheres of all sizes; tetrahedra from
/// regular ones to slivers.
#[test]
fn what_is_sure_is_right() {
    let mut random = Random(3);
    let (mut sure, mut sure_inside, rounds) = (0, 0, 200_000);
    for _ in 0..rounds {
        let center = [0, 1, 2].map(|_| 0.5 * spread(&mut random, 12));
        let radius = spread(&mut random, 20).abs() * 0.5;
        let flat = spread(&mut random, 24);
        let mut on_sphere = |near: f64| {
            let v = [0, 1, 2].map(|_| random.unit() - 0.5);
            let v = [v[0], v[1], v[2] * near];
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-3);
            [0, 1, 2].map(|axis| center[axis] + radius * v[axis] / length)
        };
        let points = [0; 4].map(|_| on_sphere(flat));
        let at = on_sphere(1.0);
        let off = spread(&mut random, 30);
        let q = [0, 1, 2]
            .map(|axis| (center[axis] + (at[axis] - center[axis]) * (1.0 + off)).clamp(-1.0, 1.0));
        let (exact, decided) = sides_of(points, q);
        if let Some(decided) = decided {
            assert_eq!(decided, exact, "{points:?} {q:?}");
            sure += 1;
            sure_inside += usize::from(decided == Sign::Positive);
        }
    }
    assert!(
        sure > rounds / 4 && sure_inside > rounds / 20,
        "{sure} and {sure_inside} of {rounds}: hardly a test"
    );
}

/// Weights that differ by as much as the squared distances do, or by far more or less; positions of
/// all distances; some points close to the sphere, because their weights are chosen so.
#[test]
fn what_is_sure_of_weights_is_right() {
    let mut random = Random(5);
    let (mut sure, mut sure_inside, rounds) = (0, 0, 200_000);
    for _ in 0..rounds {
        let (size, flat, range) = (
            spread(&mut random, 12).abs(),
            spread(&mut random, 20).abs(),
            spread(&mut random, 30).abs(),
        );
        let middle = [0; 3].map(|_| (1.0 - size) * (2.0 * random.unit() - 1.0));
        let greatest = if random.below(2) == 0 {
            0.0
        } else {
            spread(&mut random, 6)
        };
        let lowest = if random.below(4) == 0 { 1e-3 } else { 1.0 };
        let mut point = |flat: f64| {
            let [x, y, z] = [1.0, 1.0, flat].map(|most| size * most * (2.0 * random.unit() - 1.0));
            [
                middle[0] + x,
                middle[1] + y,
                middle[2] + z,
                greatest - range * lowest * random.unit(),
            ]
        };
        let points = [0; 4].map(|_| point(flat));
        let mut q = point(1.0);
        // Moves the weight of q toward the sphere, as far as floating point can.
        let power = |w: f64| {
            PowerTest3([
                points[0],
                points[1],
                points[2],
                points[3],
                [q[0], q[1], q[2], w],
            ])
        };
        let (mut low, mut high) = (greatest - range, greatest);
        let sign = Adaptive::sign(&power(low));
        for _ in 0..random.below(40) {
            let mid = 0.5 * (low + high);
            if Adaptive::sign(&power(mid)) == sign {
                low = mid
            } else {
                high = mid
            }
        }
        q[3] = if random.below(2) == 0 { low } else { high };
        let (exact, decided) = powers_of(points, q, greatest, range);
        if let Some(decided) = decided {
            assert_eq!(decided, exact, "{points:?} {q:?}");
            sure += 1;
            sure_inside += usize::from(decided == Sign::Positive);
        }
    }
    assert!(
        sure > rounds / 8 && sure_inside > rounds / 50,
        "{sure} and {sure_inside} of {rounds}: hardly a test"
    );
}

#[test]
fn one_evaluation_is_never_wrong() {
    let mut random = Random(3);
    let mut sure = 0;
    let unknown = Precision::of([1.0; 3], [0.1].into_iter());
    for round in 0..20_000 {
        // Nearly on one sphere, from 1 down to a few roundings off it.
        let off = 0.5f64.powi(round % 56);
        let sites = [0; 5].map(|_| {
            let [x, y, z] = [0; 3].map(|_| random.around(1000) as f64 / 1000.0 + 1e-4);
            let length =
                (x * x + y * y + z * z).sqrt() * (1.0 + off * random.around(1000) as f64 / 1000.0);
            [x / length, y / length, z / length]
        });
        if let Some(sign) = unknown.side_of_sphere(sites) {
            sure += 1;
            assert_eq!(sign, Adaptive::sign(&InSphere(sites)), "{sites:?}");
        }
    }
    assert!((10_000..20_000).contains(&sure), "{sure}");
}

#[test]
fn small_multiples_of_a_unit_are_decided_by_one_evaluation() {
    let mut random = Random(4);
    let mut ties = 0;
    for round in 0..20_000 {
        // Far from the origin in every third round. Ties are frequent in small cubes.
        let size = [2, 16, 256, 511][round % 4];
        let (unit, origin) = (
            [1.0, 0.125, 3.0 * 64.0][round % 3],
            [0.0, -7.0, 1e6][round % 3],
        );
        let sites = [0; 5].map(|_| [0; 3].map(|_| origin + unit * random.index(size + 1) as f64));
        let numbers = sites.into_iter().flatten();
        let precision = Precision::of([size as f64 * unit; 3], numbers.chain([unit]));
        let expected = Adaptive::sign(&InSphere(sites));
        ties += usize::from(expected == Sign::Zero);
        if let Some(sign) = precision.side_of_sphere(sites) {
            assert_eq!(sign, expected, "{sites:?}");
        } else {
            assert_eq!((unit, size >= 256), (192.0, true), "{sites:?}");
        }
    }
    assert!(ties > 1_000, "{ties}");
}

#[test]
fn differences_that_are_too_large_are_not_taken_as_exact() {
    // The largest difference to the last site is 2 r; the unit is 1.
    let precision = Precision::of([1e6; 3], [1.0, 1024.0].into_iter());
    let on_sphere = |r: f64| {
        [
            [r, 0.0, 0.0],
            [0.0, r, 0.0],
            [0.0, 0.0, r],
            [-r, 0.0, 0.0],
            [0.0, -r, 0.0],
        ]
    };
    assert_eq!(precision.side_of_sphere(on_sphere(128.0)), Some(Sign::Zero));
    assert_eq!(precision.side_of_sphere(on_sphere(1024.0)), None);
}

#[test]
fn nothing_is_sure_of_a_flat_cell_or_an_infinite_one() {
    let (a, b, c, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.25, 0.0]);
    assert_eq!(sides_of([a, b, c, d], [0.1, 0.2, 0.3]).1, None);
    let arrows = [a, b, [f64::NAN; 3]].map(|p| sphere::arrow(d, p));
    let row = sphere::through(
        [arrows.each_ref(); 4],
        Origin {
            at: d,
            lack: 0.0,
            range: 0.0,
        },
        1.0,
    )[0];
    assert!(row[3].is_nan() && !sphere::is_marked(row));
}

#[test]
fn an_order_has_each_rank_once() {
    for count in [0, 1, 2, 999, 1001, 8001, 100_000] {
        let ranks: Vec<u32> = (0..count as u32).collect();
        let mut order = rounds(&ranks);
        // All rounds but the last have a sixteenth of the points, from all over the curve.
        let sampled = order
            .iter()
            .take(count / 16)
            .filter(|&&rank| (rank as usize) < count / 2)
            .count();
        assert!(
            count < 100_000 || sampled.abs_diff(count / 32) < count / 400,
            "{sampled}"
        );
        order.sort_unstable();
        assert!(order.into_iter().eq(0..count as u32));
    }
}

/// Predicates of points, and sites that are elsewhere.
struct Contradictory;

impl Geometry<4> for Contradictory {
    type Point = [f64; 3];

    fn admits(&self, _: &[f64; 3]) -> bool {
        true
    }

    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        Space::new().compare(p, q)
    }

    fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
        Space::new().orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
        Space::new().side_of_sphere(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
        Space::new().orientation_in_flat(simplex)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        Space::new().side_of_sphere_in_flat(simplex, q)
    }
}

impl Coordinates<4> for Contradictory {
    type Coordinates = [f64; 3];

    fn coordinates(&self, p: &[f64; 3]) -> [f64; 3] {
        *p
    }

    fn exact_site(&self, [x, y, z]: &[f64; 3]) -> Option<[f64; 4]> {
        Some([
            x + 0.3 * (7.0 * y).sin(),
            y - 0.4 * (5.0 * z + x).cos(),
            z * x,
            0.0,
        ])
    }
}

#[test]
fn contradictions_end_construction_and_nothing_else() {
    let mut random = Random(4);
    let (mut built, rounds) = ([0, 0], 4_000);
    for round in 0..rounds {
        let count = 5 + random.index(if round % 8 == 0 { 300 } else { 40 });
        let side = if round % 2 == 0 { 4 } else { 1 << 20 };
        let points: Vec<[f64; 3]> = (0..count)
            .map(|_| [0; 3].map(|_| random.below(side) as f64 * 0.1))
            .collect();
        let grain = Grain::default();
        let results = [
            build(&Contradictory, &points, grain),
            build(&Space::<Fast>::default(), &points, grain),
        ];
        for (built, result) in built.iter_mut().zip(results) {
            *built += usize::from(result.is_some());
        }
    }
    assert!(built[0] < rounds, "hardly a test");
}

/// Asserts that neighbors are mutual, that each pair shares a facet, and that each vertex in a cell
/// has one. Returns the sorted cells.
fn sorted_cells(built: &Built) -> Vec<[VertexId; 4]> {
    for (number, cell) in built.links.iter().enumerate() {
        for (i, neighbor) in cell.neighbors.iter().enumerate() {
            let beyond = &built.links[neighbor.index()];
            let back = beyond
                .neighbors
                .iter()
                .position(|n| n.index() == number)
                .expect("mutual");
            let facets = [(cell, i), (beyond, back)].map(|(cell, i)| {
                let mut facet = cell.vertices.to_vec();
                facet.remove(i);
                facet.sort_unstable();
                facet
            });
            assert_eq!(facets[0], facets[1]);
        }
    }
    for (vertex, cell) in built.of_vertices.iter().enumerate() {
        let vertex = VertexId::new(vertex);
        let has = |cell: &crate::tds::Links<4>| cell.vertices.contains(&vertex);
        assert_eq!(
            built.links.get(cell.index()).is_some_and(has),
            built.links.iter().any(has)
        );
    }
    let mut cells: Vec<_> = built.links.iter().map(|cell| cell.vertices).collect();
    cells.iter_mut().for_each(|cell| cell.sort_unstable());
    cells.sort_unstable();
    cells
}

/// Compares blocks of distinct points with the whole. `None` if the points of a block are coplanar.
fn judge_blocks<G: Coordinates<4>>(geometry: &G, points: &[G::Point], levels: u32) -> Option<()> {
    with_source(geometry, points, |source| {
        let extent = Extent::of(source);
        let mut sites: Vec<[f64; 3]> = (0..source.count as u32)
            .map(|rank| source.position(rank))
            .collect();
        let blocks = Blocks::of(&mut sites, levels, extent.frame)?;
        let built = by_blocks(source, extent, &blocks, Grain::default())?;
        let whole = whole(source, extent, Grain::default()).expect("blocks span the space");
        assert_eq!(sorted_cells(&built), sorted_cells(&whole));
        Some(())
    })
}

#[test]
fn blocks_have_the_cells_of_the_whole() {
    let mut random = Random(11);
    let (mut built, rounds) = (0, 600);
    for round in 0..rounds {
        let count = 12 + random.index(if round % 20 == 0 { 1500 } else { 120 });
        let levels = 1 + random.index(3) as u32;
        let mut points: Vec<[f64; 3]> = (0..count)
            .map(|_| match round % 5 {
                // Ties are the rule.
                0 => [0; 3].map(|_| random.below(6) as f64),
                1 => [
                    random.below(4) as f64,
                    random.below(30) as f64,
                    random.below(30) as f64,
                ],
                // On two sides of a gap, and thin.
                2 => [
                    random.below(2) as f64 * 9.0 + random.unit(),
                    random.unit(),
                    random.unit() * 1e-3,
                ],
                3 => [0; 3].map(|_| spread(&mut random, 40)),
                _ => [0; 3].map(|_| random.unit()),
            })
            .collect();
        points.sort_unstable_by(|p, q| p.partial_cmp(q).expect("numbers"));
        points.dedup();
        let range = [0.0, 1e-3, 0.1, 4.0][round / 5 % 4];
        let weighted: Vec<[f64; 4]> = points
            .iter()
            .map(|&[x, y, z]| [x, y, z, range * random.unit()])
            .collect();
        built += judge_blocks(&Space::<Adaptive>::new(), &points, levels)
            .into_iter()
            .count();
        built += judge_blocks(&WeightedSpace::<Adaptive>::default(), &weighted, levels)
            .into_iter()
            .count();
    }
    assert!(built > rounds, "{built} of {}: hardly a test", 2 * rounds);
}

#[test]
fn blocks_give_the_same_numbers_on_any_number_of_threads() {
    let mut random = Random(12);
    let points: Vec<[f64; 3]> = (0..4000).map(|_| [0; 3].map(|_| random.unit())).collect();
    let built = |threads| {
        on_threads(threads, || {
            with_source(&Space::<Adaptive>::new(), &points, |source| {
                let extent = Extent::of(source);
                let blocks = Blocks::of(&mut points.clone(), 2, extent.frame).expect("blocks");
                let built = by_blocks(source, extent, &blocks, Grain::default()).expect("cells");
                (built.links, built.of_vertices, built.of_infinite)
            })
        })
    };
    let one = built(1);
    for threads in [2, 4] {
        assert!(built(threads) == one, "{threads}");
    }
}
