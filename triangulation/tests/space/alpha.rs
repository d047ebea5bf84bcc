//! Alpha shapes, held against all of their cells in exact rational arithmetic.

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{AlphaShape, AlphaShapes, AlphaState, Delaunay, Regular};
use dashu_ratio::RBig;
use testkit::random::Random;

type Whole = [i64; 4];

/// A squared radius as a fraction with a positive denominator.
type Fraction = (i128, i128);

fn minor([a, b, c]: [[i128; 3]; 3]) -> i128 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// By Cramer's rule: `2 p . center = |p|^2 - (w_p - w_d)` for the three vectors `p` from `d`.
fn squared_radius(corners: [Whole; 4]) -> Fraction {
    let d = corners[3];
    let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|axis| i128::from(corners[i][axis] - d[axis])));
    let right = [0, 1, 2]
        .map(|i| rows[i].iter().map(|x| x * x).sum::<i128>() - i128::from(corners[i][3] - d[3]));
    let below = 2 * minor(rows);
    let center = [0, 1, 2].map(|axis| {
        let mut replaced = rows;
        (0..3).for_each(|i| replaced[i][axis] = right[i]);
        minor(replaced)
    });
    (
        center.iter().map(|x| x * x).sum::<i128>() - i128::from(d[3]) * below * below,
        below * below,
    )
}

fn less((a, b): Fraction, (c, d): Fraction) -> bool {
    a * d < c * b
}

/// Compares all shapes with those of the radii of all cells.
fn judge<'t>(
    shapes: &'t AlphaShapes<'t>,
    finite: &[CellId],
    neighbors: impl Fn(CellId) -> Vec<CellId>,
    corners: impl Fn(CellId) -> [VertexId; 4],
    point: impl Fn(VertexId) -> Whole,
) {
    let radius: BTreeMap<CellId, Fraction> = finite
        .iter()
        .map(|&cell| (cell, squared_radius(corners(cell).map(&point))))
        .collect();
    let mut sorted: Vec<Fraction> = radius.values().copied().collect();
    sorted.sort_by(|&p, &q| {
        if less(p, q) {
            std::cmp::Ordering::Less
        } else {
            i32::from(less(q, p)).cmp(&0)
        }
    });
    sorted.dedup_by(|p, q| !less(*p, *q) && !less(*q, *p));
    assert_eq!(shapes.alphas().len(), sorted.len());
    for (&alpha, &(above, below)) in shapes.alphas().iter().zip(&sorted) {
        let expected = above as f64 / below as f64;
        assert!(
            (alpha - expected).abs() <= 1e-12 * expected.abs(),
            "{alpha} {expected}"
        );
    }
    let all: BTreeSet<VertexId> = finite.iter().flat_map(|&cell| corners(cell)).collect();
    let solid = |limit: Fraction| -> BTreeSet<CellId> {
        finite
            .iter()
            .copied()
            .filter(|cell| !less(limit, radius[cell]))
            .collect()
    };
    let components = |cells: &BTreeSet<CellId>| {
        let (mut left, mut count) = (cells.clone(), 0);
        while let Some(first) = left.pop_first() {
            count += 1;
            let mut stack = vec![first];
            while let Some(cell) = stack.pop() {
                stack.extend(
                    neighbors(cell)
                        .into_iter()
                        .filter(|neighbor| left.remove(neighbor)),
                );
            }
        }
        count
    };
    for wanted in 0..3 {
        let expected = sorted.iter().copied().find(|&limit| {
            let cells = solid(limit);
            cells
                .iter()
                .flat_map(|&cell| corners(cell))
                .collect::<BTreeSet<_>>()
                == all
                && components(&cells) <= wanted
        });
        let found = shapes.with_components(wanted);
        assert_eq!(
            found.map(|shape| shape.cells().collect::<BTreeSet<_>>()),
            expected.map(&solid),
            "{wanted}"
        );
    }
    let step = 1 + sorted.len() / 6;
    for (&limit, &alpha) in sorted.iter().zip(shapes.alphas()).step_by(step) {
        let (shape, expected) = (shapes.at(alpha), solid(limit));
        assert_eq!(shape.cells().collect::<BTreeSet<_>>(), expected);
        assert_eq!(shape.components(), components(&expected));
        assert!(
            finite
                .iter()
                .all(|&cell| shape.contains(cell) == expected.contains(&cell))
        );
        judge_boundary(&shape, &neighbors, &corners, &point);
    }
}

/// Each edge has as many triangles in one direction as in the other; the surface has the volume of
/// the solid; and singular vertices are those whose triangles no path across edges connects.
fn judge_boundary(
    shape: &AlphaShape,
    neighbors: impl Fn(CellId) -> Vec<CellId>,
    corners: impl Fn(CellId) -> [VertexId; 4],
    point: impl Fn(VertexId) -> Whole,
) {
    let boundary = shape.boundary();
    let facets = shape
        .cells()
        .flat_map(&neighbors)
        .filter(|&neighbor| !shape.contains(neighbor))
        .count();
    assert_eq!(boundary.triangles.len(), facets);
    let site = |v: VertexId| [0, 1, 2].map(|axis| i128::from(point(v)[axis]));
    let surface: i128 = boundary
        .triangles
        .iter()
        .map(|triangle| minor(triangle.map(site)))
        .sum();
    let solid: i128 = shape
        .cells()
        .map(|cell| {
            let [a, b, c, d] = corners(cell).map(site);
            minor([a, b, c].map(|p| [0, 1, 2].map(|axis| p[axis] - d[axis]))).abs()
        })
        .sum();
    assert_eq!(surface, solid, "outward");
    assert!((shape.volume() - solid as f64 / 6.0).abs() <= 1e-12 * solid as f64);

    let mut directed: BTreeMap<[VertexId; 2], usize> = BTreeMap::new();
    for &[a, b, c] in &boundary.triangles {
        [[a, b], [b, c], [c, a]]
            .into_iter()
            .for_each(|edge| *directed.entry(edge).or_default() += 1);
    }
    for (&[a, b], &count) in &directed {
        assert_eq!(directed.get(&[b, a]), Some(&count));
        assert_eq!(
            boundary.singular_edges.contains(&[a.min(b), a.max(b)]),
            count > 1
        );
    }
    let vertices: BTreeSet<VertexId> = boundary.triangles.iter().flatten().copied().collect();
    for vertex in vertices {
        let mut left: Vec<[VertexId; 3]> = boundary
            .triangles
            .iter()
            .filter(|triangle| triangle.contains(&vertex))
            .copied()
            .collect();
        let mut stack = vec![left.pop().unwrap()];
        while let Some(triangle) = stack.pop() {
            let touches =
                |other: &[VertexId; 3]| other.iter().filter(|v| triangle.contains(v)).count() >= 2;
            let (next, rest): (Vec<_>, Vec<_>) = left.into_iter().partition(touches);
            left = rest;
            stack.extend(next);
        }
        assert_eq!(
            boundary.singular_vertices.contains(&vertex),
            !left.is_empty()
        );
    }
}

#[test]
fn shapes_on_grids_are_those_of_exact_radii() {
    let mut random = Random(31);
    let mut solids = 0;
    for round in 0..250 {
        let (count, side) = (random.index(30), [3, 4, 7, 40][round % 4]);
        let points: Vec<Whole> = (0..count)
            .map(|_| {
                let [x, y, z] = [0; 3].map(|_| random.below(side) as i64);
                [
                    x,
                    y,
                    z,
                    if round % 3 == 0 {
                        random.below(6) as i64
                    } else {
                        0
                    },
                ]
            })
            .collect();
        let numbers: Vec<[f64; 4]> = points.iter().map(|p| p.map(|x| x as f64)).collect();
        if round % 3 == 0 {
            let (t, _) =
                Regular::<WeightedSpace, 4>::from_points(WeightedSpace::default(), &numbers)
                    .unwrap();
            let finite: Vec<CellId> = if t.dimension() == 3 {
                t.finite_cells().collect()
            } else {
                Vec::new()
            };
            let tds = t.tds();
            judge(
                &t.alpha_shapes(),
                &finite,
                |c| tds.cell_neighbors(c).to_vec(),
                |c| tds.cell_vertices(c).try_into().unwrap(),
                |v| t.point(v).map(|x| x as i64),
            );
            solids += usize::from(finite.len() > 1);
        } else {
            let sites: Vec<[f64; 3]> = numbers.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
            let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &sites).unwrap();
            let finite: Vec<CellId> = if t.dimension() == 3 {
                t.finite_cells().collect()
            } else {
                Vec::new()
            };
            let tds = t.tds();
            let point = |v: VertexId| {
                let [x, y, z] = t.point(v).map(|x| x as i64);
                [x, y, z, 0]
            };
            judge(
                &t.alpha_shapes(),
                &finite,
                |c| tds.cell_neighbors(c).to_vec(),
                |c| tds.cell_vertices(c).try_into().unwrap(),
                point,
            );
            solids += usize::from(finite.len() > 1);
        }
    }
    assert!(solids > 150, "{solids}: hardly a test");
}

/// Among all cells, those that have the vertices.
#[test]
fn a_simplex_is_inside_with_all_of_its_cells() {
    let mut random = Random(33);
    let mut seen = [0; 3];
    for round in 0..60 {
        let sizes = [[3, 3, 3], [5, 4, 3], [40, 40, 40], [4, 4, 1]][round % 4];
        let points: Vec<[f64; 3]> = (0..random.index(30))
            .map(|_| sizes.map(|size| random.below(size) as f64))
            .collect();
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &points).unwrap();
        let (tds, shapes) = (t.tds(), t.alpha_shapes());
        let alphas = shapes.alphas();
        for alpha in [0, alphas.len() / 3, alphas.len() - alphas.len().min(1)]
            .map(|k| alphas.get(k).copied())
        {
            let shape = shapes.at(alpha.unwrap_or(f64::INFINITY));
            let mut judge = |vertices: &[VertexId], found: AlphaState| {
                let has_all =
                    |&cell: &CellId| vertices.iter().all(|&v| tds.index_of(cell, v).is_some());
                let around: Vec<CellId> = tds.cells().filter(has_all).collect();
                let within = around.iter().filter(|&&cell| shape.contains(cell)).count();
                let expected = match within {
                    0 => AlphaState::Exterior,
                    _ if within == around.len() => AlphaState::Interior,
                    _ => AlphaState::Regular,
                };
                assert_eq!(found, expected, "{points:?} {vertices:?}");
                seen[found as usize] += 1;
            };
            tds.cells()
                .for_each(|cell| judge(tds.cell_vertices(cell), shape.classify_cell(cell)));
            tds.edges()
                .for_each(|edge| judge(&tds.edge_ends(edge), shape.classify_edge(edge)));
            tds.vertices()
                .for_each(|vertex| judge(&[vertex], shape.classify_vertex(vertex)));
            for (cell, i) in tds.facets() {
                let mut vertices = tds.cell_vertices(cell).to_vec();
                vertices.remove(i);
                judge(&vertices, shape.classify_facet((cell, i)));
            }
        }
    }
    assert!(
        seen.iter().all(|&count| count > 300),
        "{seen:?}: hardly a test"
    );
}

#[test]
fn the_shape_of_a_ball_is_a_closed_manifold_of_its_volume() {
    let mut random = Random(32);
    let mut last = 0.4;
    for count in [500, 4000, 16_000] {
        let mut points = Vec::new();
        while points.len() < count {
            let p = [0; 3].map(|_| 2.0 * random.unit() - 1.0);
            if p.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                points.push(p);
            }
        }
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &points).unwrap();
        let shapes = t.alpha_shapes();
        let spacing = (4.0 * std::f64::consts::PI / 3.0 / count as f64).cbrt();
        let shape = shapes.at(9.0 * spacing * spacing);
        let off = (shape.volume() / (4.0 * std::f64::consts::PI / 3.0) - 1.0).abs();
        assert!(off < 0.75 * last, "{count}: {off}");
        last = off;
        assert_eq!(shape.components(), 1);
        assert!(shape.boundary().is_manifold());
        assert!(shapes.with_components(1).unwrap().alpha() < shape.alpha());
    }
}

#[test]
fn what_has_no_volume_has_no_shape() {
    let flat: Vec<[f64; 3]> = (0..9)
        .map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0])
        .collect();
    for points in [&flat[..0], &flat[..1], &flat[..3], &flat] {
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), points).unwrap();
        let shapes = t.alpha_shapes();
        assert!(shapes.alphas().is_empty() && shapes.with_components(1).is_none());
        let shape = shapes.at(f64::INFINITY);
        assert_eq!(
            (
                shape.volume().to_bits(),
                shape.components(),
                shape.boundary().triangles.len()
            ),
            (0, 0, 0)
        );
        assert!(!shape.contains(CellId::new(1000)));
        assert_eq!(shape.classify_cell(CellId::new(1000)), AlphaState::Exterior);
    }
}

/// By the formula of [`squared_radius`], of any doubles.
fn exact_squared_radius(corners: [[f64; 4]; 4]) -> RBig {
    let corners = corners.map(|p| p.map(|x| RBig::try_from(x).unwrap()));
    let d = &corners[3];
    let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|axis| &corners[i][axis] - &d[axis]));
    let lift = |i: usize| {
        rows[i]
            .iter()
            .map(|x| x * x)
            .fold(RBig::ZERO, |sum, x| sum + x)
            - &corners[i][3]
            + &d[3]
    };
    let right = [0, 1, 2].map(lift);
    let minor = |[a, b, c]: &[[RBig; 3]; 3]| {
        &a[0] * (&b[1] * &c[2] - &b[2] * &c[1]) - &a[1] * (&b[0] * &c[2] - &b[2] * &c[0])
            + &a[2] * (&b[0] * &c[1] - &b[1] * &c[0])
    };
    let below = minor(&rows) * RBig::from(2);
    let squares = [0, 1, 2].map(|axis| {
        let mut replaced = rows.clone();
        (0..3).for_each(|i| replaced[i][axis] = right[i].clone());
        let center = minor(&replaced) / &below;
        &center * &center
    });
    squares
        .into_iter()
        .fold(RBig::ZERO, |sum, square| sum + square)
        - &d[3]
}

/// Compares the order of all cells with that of exact radii.
fn judge_order(shapes: &AlphaShapes, corners: impl Fn(CellId) -> [[f64; 4]; 4]) {
    let radii: Vec<RBig> = shapes
        .at(f64::INFINITY)
        .cells()
        .map(|cell| exact_squared_radius(corners(cell)))
        .collect();
    assert!(radii.is_sorted());
    let different: BTreeSet<RBig> = radii.into_iter().collect();
    assert_eq!(shapes.alphas().len(), different.len());
    for (&alpha, radius) in shapes.alphas().iter().zip(&different) {
        let expected = radius.to_f64().value();
        assert!(
            (alpha - expected).abs() <= 1e-12 * expected.abs(),
            "{alpha} {expected}"
        );
    }
}

/// On decimal grids, far away, of many digits, with weights: cells whose radii are equal, or differ
/// in the last of many digits.
#[test]
fn the_order_of_radii_is_exact() {
    let mut random = Random(34);
    for round in 0..60 {
        let side = [3, 4, 30, 1 << 16, 1 << 40][round % 5];
        let [scale, origin] = [[1.0, 0.0], [0.1, 0.0], [0.1, 1e5], [0.25, -3.0]][round / 5 % 4];
        let mut number = || origin + scale * random.below(side) as f64;
        let sites: Vec<[f64; 3]> = (0..20).map(|_| [number(), number(), number()]).collect();
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &sites).unwrap();
        judge_order(&t.alpha_shapes(), |cell| {
            t.cell_points(cell)
                .unwrap()
                .map(|&[x, y, z]| [x, y, z, 0.0])
        });
        // A thousandth is no multiple of the square of their step.
        let unit = if round % 2 == 0 { scale * scale } else { 0.001 };
        let weighted: Vec<[f64; 4]> = sites
            .iter()
            .map(|&[x, y, z]| [x, y, z, unit * random.below(3) as f64])
            .collect();
        let (t, _) =
            Regular::<WeightedSpace, 4>::from_points(WeightedSpace::default(), &weighted).unwrap();
        judge_order(&t.alpha_shapes(), |cell| {
            t.cell_points(cell).unwrap().map(|p| *p)
        });
    }
}

/// Tetrahedra of six times the volume 1, far below what floating point can tell.
#[test]
fn the_radius_of_a_sliver_is_right() {
    let mut random = Random(35);
    for _ in 0..50 {
        let mut vectors = [[1i64, 0, 0], [0, 1, 0], [0, 0, 1]];
        while vectors.as_flattened().iter().all(|x| x.abs() < 1 << 25) {
            let [from, to] = random.pick(&[[0, 1], [1, 2], [2, 0], [1, 0], [2, 1], [0, 2]]);
            (0..3).for_each(|axis| vectors[to][axis] += vectors[from][axis]);
        }
        let sites: Vec<[f64; 3]> = vectors
            .iter()
            .map(|v| v.map(|x| x as f64))
            .chain([[0.0; 3]])
            .collect();
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &sites).unwrap();
        assert_eq!(t.finite_cells().count(), 1);
        judge_order(&t.alpha_shapes(), |cell| {
            t.cell_points(cell)
                .unwrap()
                .map(|&[x, y, z]| [x, y, z, 0.0])
        });
    }
}

/// Radii that overflow, vanish, or differ by less than a rounding.
#[test]
fn shapes_at_the_ends_of_floating_point() {
    for size in [1e-310, 1e-100, 1.0, 1e100, 1e300] {
        let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f64 * size);
        let mut points: Vec<[f64; 3]> = (0..8).map(corner).collect();
        points.push([0.5 * size, 0.5 * size, 0.25 * size]);
        let (t, _) = Delaunay::<Space<breakline_triangulation::kernel::Exact>, 4>::from_points(
            Space::default(),
            &points,
        )
        .unwrap();
        let shapes = t.alpha_shapes();
        assert!(shapes.alphas().len() > 1 && shapes.alphas().is_sorted());
        let shape = shapes.with_components(1).unwrap();
        assert!(shape.boundary().is_manifold());
        assert_eq!(
            shapes.at(f64::INFINITY).cells().count(),
            t.finite_cells().count()
        );
    }
    let far = 1e8;
    let points: Vec<[f64; 3]> = (0..27)
        .map(|i| [i % 3, i / 3 % 3, i / 9].map(|x| far + f64::from(x)))
        .collect();
    let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), &points).unwrap();
    assert_eq!(t.alpha_shapes().alphas(), [0.75]);
}

/// The first three numbers of each line of a file of points; of an `.off` file, those of its
/// vertices.
pub(crate) fn points_of(path: &std::path::Path) -> Vec<[f64; 3]> {
    let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let mut count = usize::MAX;
    if path.extension().is_some_and(|extension| extension == "off") {
        count = lines
            .nth(1)
            .unwrap()
            .split_whitespace()
            .next()
            .unwrap()
            .parse()
            .unwrap();
    }
    let numbers = |line: &str| {
        let mut numbers = line
            .split_whitespace()
            .map(|number| number.parse().unwrap());
        [0; 3].map(|_| numbers.next().unwrap())
    };
    lines.take(count).map(numbers).collect()
}

/// The results of CGAL 5.5: `Alpha_shape_3` with exact comparison, regularized, and
/// `find_optimal_alpha(1)`.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn optimal_shapes_of_scans_are_those_of_cgal() {
    let folder = testkit::shared("points3d");
    for (file, alpha, facets, cells) in [
        ("armadillo.off", 140.281_084_927_385, 19_850, 146_487),
        ("half.xyz", 0.223_727_707_696_444, 768, 693),
        ("kitten.xyz", 0.056_529_961_423_974, 5_498, 25_994),
        ("ocean_r.xyz", 0.403_976_209_912_914, 2_620, 83_164),
        ("oneK.xyz", 0.016_074_782_699_769_3, 912, 5_268),
        ("sphere_1k.xyz", 0.952_128_527_323_368, 2_148, 3_219),
    ] {
        let (t, _) =
            Delaunay::<Space, 4>::from_points(Space::default(), &points_of(&folder.join(file)))
                .unwrap();
        let shapes = t.alpha_shapes();
        let shape = shapes.with_components(1).unwrap();
        assert!(
            (shape.alpha() / alpha - 1.0).abs() < 1e-12,
            "{file}: {} {alpha}",
            shape.alpha()
        );
        assert_eq!(
            (shape.boundary().triangles.len(), shape.cells().count()),
            (facets, cells),
            "{file}"
        );
        assert_eq!(shape.components(), 1);
    }
}
