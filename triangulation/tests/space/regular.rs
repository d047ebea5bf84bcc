//! Regular triangulations of tiny grids in space, where weights, sites and powers tie all the time,
//! compared with the lower hull.
//!
//! With `BREAKLINE_HULLS=100000` in the environment, this many sets of points are tried.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Space, Weighted, WeightedSpace};
use breakline_triangulation::kernel::{
    Adaptive, Exact, Expansions, Interval, Kernel, Lattice, Wide,
};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level, Regular, RemovalError};
use dashu_int::IBig;
use testkit::random::Random;

/// x, y, z and weight.
type Point = [i64; 4];

fn lift([x, y, z, w]: Point) -> i64 {
    x * x + y * y + z * z - w
}

/// Six times the volume of a tetrahedron: positive if it is right-handed.
fn volume([a, b, c, d]: [Point; 4]) -> i64 {
    let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Returns the cells of the lower hull of the lifted points. Ties are broken by raising the lifts
/// by powers of a small number, the largest point most.
fn lower_hull(points: &BTreeSet<Point>) -> BTreeSet<[Point; 4]> {
    // In order of site and weight, the heaviest of a site last.
    let sorted: Vec<Point> = points.iter().copied().collect();
    let heaviest = |k: &usize| {
        sorted
            .get(k + 1)
            .is_none_or(|next| next[..3] != sorted[*k][..3])
    };
    let sites: Vec<Point> = (0..sorted.len())
        .filter(heaviest)
        .map(|k| sorted[k])
        .collect();
    let lifts: Vec<IBig> = (sites.iter().zip(0..))
        .map(|(&p, rank)| {
            (IBig::from(lift(p)) << (24 * sites.len() + 24)) + (IBig::ONE << (24 * rank))
        })
        .collect();
    let mut cells = BTreeSet::new();
    for i in 0..sites.len() {
        for j in i + 1..sites.len() {
            for k in j + 1..sites.len() {
                for l in k + 1..sites.len() {
                    let at = |corners: [usize; 4]| volume(corners.map(|at| sites[at]));
                    let size = at([i, j, k, l]);
                    let is_above = |q: usize| {
                        let parts = [
                            at([q, j, k, l]),
                            at([i, q, k, l]),
                            at([i, j, q, l]),
                            at([i, j, k, q]),
                        ];
                        let hyperplane: IBig = parts
                            .into_iter()
                            .zip([i, j, k, l])
                            .map(|(part, corner)| IBig::from(part) * &lifts[corner])
                            .sum();
                        (hyperplane - IBig::from(size) * &lifts[q]) * IBig::from(size.signum())
                            < IBig::ZERO
                    };
                    if size != 0
                        && (0..sites.len()).all(|q| [i, j, k, l].contains(&q) || is_above(q))
                    {
                        cells.insert([i, j, k, l].map(|at| sites[at]));
                    }
                }
            }
        }
    }
    cells
}

type Weights<K> = Regular<WeightedSpace<K>, 4>;

fn whole<K: Kernel>(t: &Weights<K>, vertex: VertexId) -> Point {
    t.point(vertex).map(|x| x as i64)
}

fn sorted_cells<K: Kernel>(t: &Weights<K>) -> BTreeSet<Vec<Point>> {
    let corners = |cell| {
        let mut corners: Vec<Point> = t
            .tds()
            .cell_vertices(cell)
            .iter()
            .map(|&v| whole(t, v))
            .collect();
        corners.sort_unstable();
        corners
    };
    t.finite_cells().map(corners).collect()
}

fn judge<K: Kernel>(t: &Weights<K>, points: &BTreeSet<Point>) {
    assert_eq!(t.check(Level::Law), [], "{points:?}");
    let there: BTreeSet<Point> = t
        .tds()
        .vertices()
        .chain(t.hidden())
        .map(|v| whole(t, v))
        .collect();
    assert_eq!(there, *points);
    assert_eq!(
        t.vertex_count() + t.hidden().len(),
        points.len(),
        "{points:?}"
    );
    let expected = lower_hull(points);
    if t.dimension() == 3 {
        let expected: BTreeSet<Vec<Point>> =
            expected.into_iter().map(|cell| cell.to_vec()).collect();
        assert_eq!(sorted_cells(t), expected, "{points:?}");
        let seen: BTreeSet<Point> = t.tds().vertices().map(|v| whole(t, v)).collect();
        assert_eq!(seen, expected.into_iter().flatten().collect(), "{points:?}");
    } else {
        assert_eq!(expected.len(), 0, "{points:?}");
        // In a plane and on a line: one result, whatever the order.
        let mut anew: Weights<K> = Regular::new(WeightedSpace::default());
        points
            .iter()
            .rev()
            .for_each(|p| _ = anew.insert(p.map(|x| x as f64)).unwrap());
        assert_eq!(sorted_cells(t), sorted_cells(&anew), "{points:?}");
    }
}

fn rounds(least: usize) -> usize {
    std::env::var("BREAKLINE_HULLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(least)
}

/// Points on a grid, often flat, of few weights.
fn points(random: &mut Random) -> impl Fn(&mut Random) -> Point + use<> {
    let sizes = random.pick(&[[2, 2, 2], [3, 3, 3], [3, 3, 1], [4, 1, 1], [3, 2, 2]]);
    let weights = 1 + random.below(12);
    move |random| {
        let [x, y, z] = sizes.map(|size| random.below(size) as i64);
        [x, y, z, random.below(weights) as i64]
    }
}

fn sequence<K: Kernel>(random: &mut Random) {
    let mut t: Weights<K> = Regular::new(WeightedSpace::default());
    let mut there = BTreeSet::new();
    let point = points(random);
    for step in 0..24 {
        let p = point(random);
        let double = p.map(|x| x as f64);
        if there.len() < 9 && random.below(5) > 1 {
            let is_new = there.insert(p);
            let slots = t.tds().vertex_slots();
            let vertex = t.insert(double).unwrap();
            assert_eq!(whole(&t, vertex), p);
            assert!(is_new || t.tds().vertex_slots() == slots);
        } else {
            let all: Vec<VertexId> = t.tds().vertices().chain(t.hidden()).collect();
            if all.is_empty() {
                continue;
            }
            let vertex = random.pick(&all);
            assert!(there.remove(&whole(&t, vertex)));
            if random.below(2) == 0 {
                let moved = t.move_to(vertex, double).unwrap();
                assert_eq!((whole(&t, moved), moved == vertex), (p, there.insert(p)));
            } else {
                t.remove(vertex).unwrap();
                assert_eq!(t.remove(vertex), Err(RemovalError::NoVertex));
            }
        }
        if step % 4 == 3 {
            judge(&t, &there);
        }
    }
    for vertex in t.tds().vertices().chain(t.hidden()).collect::<Vec<_>>() {
        there.remove(&whole(&t, vertex));
        t.remove(vertex).unwrap();
    }
    assert_eq!(
        (t.dimension(), t.tds().cell_count(), there.len()),
        (-1, 0, 0)
    );
}

#[test]
fn points_come_and_go() {
    let mut random = Random(31);
    for round in 0..rounds(240) {
        match round % 6 {
            0 => sequence::<Adaptive>(&mut random),
            1 => sequence::<Exact>(&mut random),
            2 => sequence::<Expansions>(&mut random),
            3 => sequence::<Interval>(&mut random),
            4 => sequence::<Lattice>(&mut random),
            _ => sequence::<Wide>(&mut random),
        }
    }
}

/// The Delaunay triangulation, built at once and one by one, is the lower hull.
#[test]
fn the_delaunay_triangulation_is_the_lower_hull() {
    let mut random = Random(35);
    for _ in 0..rounds(300) {
        let sizes = random.pick(&[[2, 2, 2], [3, 3, 3], [3, 2, 2], [6, 6, 6]]);
        let sites: Vec<[f64; 3]> = (0..random.index(11))
            .map(|_| sizes.map(|size| random.below(size) as f64))
            .collect();
        let (bulk, _) = Delaunay::<Space, 4>::from_points(Space::new(), &sites).unwrap();
        let mut one_by_one = Delaunay::<Space, 4>::new(Space::new());
        sites
            .iter()
            .for_each(|&p| _ = one_by_one.insert(p).unwrap());
        let expected = lower_hull(
            &sites
                .iter()
                .map(|p| [p[0], p[1], p[2], 0.0].map(|x| x as i64))
                .collect(),
        );
        let expected: BTreeSet<Vec<[i64; 3]>> = expected
            .into_iter()
            .map(|cell| cell.map(|[x, y, z, _]| [x, y, z]).to_vec())
            .collect();
        for t in [bulk, one_by_one] {
            let found = testkit::cells::cells(&t, |p| p.map(|x| x as i64));
            assert_eq!(t.dimension() == 3, !expected.is_empty(), "{sites:?}");
            assert!(t.dimension() < 3 || found == expected, "{sites:?}");
        }
    }
}

/// With equal weights, the cells are those of the Delaunay triangulation.
#[test]
fn equal_weights_change_nothing() {
    let mut random = Random(32);
    for round in 0..200 {
        let side = [2, 3, 5][round % 3];
        let sites: Vec<[f64; 3]> = (0..1 + random.index(30))
            .map(|_| [0; 3].map(|_| random.below(side) as f64))
            .collect();
        let weight = random.below(9) as f64 - 4.0;
        let weighted: Vec<[f64; 4]> = sites.iter().map(|&[x, y, z]| [x, y, z, weight]).collect();
        let (regular, _) = Regular::from_points(WeightedSpace::new(), &weighted).unwrap();
        let (delaunay, _) = Delaunay::from_points(Space::new(), &sites).unwrap();
        let mut cells: Vec<Vec<[i64; 3]>> = Vec::new();
        for cell in delaunay.finite_cells() {
            let vertices = delaunay.tds().cell_vertices(cell);
            let mut corners: Vec<[i64; 3]> = vertices
                .iter()
                .map(|&v| delaunay.point(v).map(|x| x as i64))
                .collect();
            corners.sort_unstable();
            cells.push(corners);
        }
        let expected: BTreeSet<Vec<[i64; 3]>> = cells.into_iter().collect();
        let found = sorted_cells(&regular);
        let found: BTreeSet<Vec<[i64; 3]>> = found
            .into_iter()
            .map(|cell| cell.into_iter().map(|[x, y, z, _]| [x, y, z]).collect())
            .collect();
        assert_eq!(found, expected, "{sites:?}");
        assert_eq!(regular.hidden().len(), 0);
    }
}

/// In a plane, cells and hidden points are those of the plane.
#[test]
fn a_plane_in_space_is_the_plane() {
    let mut random = Random(33);
    for _ in 0..400 {
        let (side, weights) = (1 + random.below(5), 1 + random.below(12));
        let points: Vec<[f64; 3]> = (0..random.index(20))
            .map(|_| {
                [
                    random.below(side),
                    random.below(side),
                    random.below(weights),
                ]
                .map(|x| x as f64)
            })
            .collect();
        let in_space: Vec<[f64; 4]> = points.iter().map(|&[x, y, w]| [x, y, 7.0, w]).collect();
        let (flat, _) = Regular::from_points(Weighted::new(), &points).unwrap();
        let (space, _) = Regular::from_points(WeightedSpace::new(), &in_space).unwrap();
        let plan = |v: VertexId| space.point(v).map(|x| x as i64);
        let hidden: BTreeSet<[i64; 3]> = space
            .hidden()
            .map(|v| {
                let [x, y, _, w] = plan(v);
                [x, y, w]
            })
            .collect();
        assert_eq!(
            hidden,
            flat.hidden()
                .map(|v| flat.point(v).map(|x| x as i64))
                .collect(),
            "{points:?}"
        );
        let sorted = |mut corners: Vec<[i64; 3]>| {
            corners.sort_unstable();
            corners
        };
        let cells: BTreeSet<Vec<[i64; 3]>> = space
            .finite_cells()
            .map(|cell| {
                let vertices = space.tds().cell_vertices(cell).iter();
                sorted(
                    vertices
                        .map(|&v| {
                            let [x, y, _, w] = plan(v);
                            [x, y, w]
                        })
                        .collect(),
                )
            })
            .collect();
        let expected: BTreeSet<Vec<[i64; 3]>> = flat
            .finite_cells()
            .map(|cell| {
                let vertices = flat.tds().cell_vertices(cell).iter();
                sorted(vertices.map(|&v| flat.point(v).map(|x| x as i64)).collect())
            })
            .collect();
        assert_eq!(cells, expected, "{points:?}");
    }
}

/// Without weights, a second point on a site is the first.
#[test]
fn points_without_weights_are_not_hidden() {
    let mut t = Regular::<Space, 4>::new(Space::new());
    let first = t.insert([1.0; 3]).unwrap();
    assert_eq!(t.insert([1.0; 3]), Ok(first));
    assert_eq!(t.hidden().len(), 0);
}
