//! Voronoi and power diagrams: centers in rational arithmetic, cells cut by all bisectors, edges
//! and facets by what is nearest to their points.

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::kernel::{Wide, power_center_in_space};
use breakline_triangulation::tds::space::Edge;
use breakline_triangulation::tds::{CellId, Tds, VertexId};
use breakline_triangulation::{Delaunay, Regular, VoronoiEdge, VoronoiFacet, VoronoiSolid};
use dashu_ratio::RBig;
use testkit::random::{Random, ulps};

type Site = [f64; 3];
type Weighted = [f64; 4];

fn minus(p: Site, q: Site) -> Site {
    [0, 1, 2].map(|k| p[k] - q[k])
}

fn cross(p: Site, q: Site) -> Site {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i])
}

fn dot(p: Site, q: Site) -> f64 {
    (0..3).map(|k| p[k] * q[k]).sum()
}

fn power(p: &Weighted, at: Site) -> f64 {
    (0..3).map(|k| (at[k] - p[k]).powi(2)).sum::<f64>() - p[3]
}

/// Returns points on tiny grids, of which some are flat or on one line, or anywhere.
fn points(random: &mut Random, round: usize, with_weights: bool) -> Vec<Weighted> {
    let sides = [[2, 2, 2], [3, 3, 3], [4, 4, 1], [5, 1, 1], [0, 0, 0]][round % 5];
    let weights = if with_weights { 1 + random.below(7) } else { 1 };
    (0..1 + random.index(16))
        .map(|_| {
            let [x, y, z] = sides.map(|side| {
                if side == 0 {
                    random.unit() * 4.0
                } else {
                    random.below(side) as f64
                }
            });
            [x, y, z, random.below(weights) as f64]
        })
        .collect()
}

/// Returns twice the volume by which four points are not coplanar.
fn determinant(rows: &[[RBig; 3]; 3]) -> RBig {
    let minor = |i: usize, j: usize| &rows[1][i] * &rows[2][j] - &rows[1][j] * &rows[2][i];
    &rows[0][0] * minor(1, 2) - &rows[0][1] * minor(0, 2) + &rows[0][2] * minor(0, 1)
}

/// Asserts that a center, relative to the first corner, is correct to within 2^-40 of its distance.
/// Returns false for coplanar points, which have none.
fn judge_center(corners: [Weighted; 4]) -> bool {
    let exact = corners.map(|p| p.map(|x| RBig::try_from(x).unwrap()));
    let rows = [1, 2, 3].map(|i| [0, 1, 2].map(|k| &exact[i][k] - &exact[0][k]));
    let right = [0, 1, 2].map(|i| {
        let square = rows[i].iter().fold(RBig::ZERO, |sum, x| sum + x * x);
        (square - &exact[i + 1][3] + &exact[0][3]) / RBig::from(2)
    });
    let below = determinant(&rows);
    if below == RBig::ZERO {
        return false;
    }
    let found = power_center_in_space(corners).map(|x| RBig::try_from(x).unwrap());
    let [mut error, mut length] = [RBig::ZERO, RBig::ZERO];
    for axis in 0..3 {
        let mut replaced = rows.clone();
        (0..3).for_each(|i| replaced[i][axis] = right[i].clone());
        let expected = determinant(&replaced) / &below;
        let difference = &found[axis] - &expected;
        error += &difference * &difference;
        length += &expected * &expected;
    }
    assert!(
        error * RBig::try_from(2f64.powi(80)).unwrap() <= length,
        "{corners:?}"
    );
    true
}

#[test]
fn centers_are_right_however_flat_the_tetrahedron() {
    let mut random = Random(1);
    let mut judged = 0;
    for round in 0..2000 {
        let mut corners = [0; 4].map(|_| [0; 3].map(|_| random.unit() * 100.0 + 5e5));
        if round % 2 == 0 {
            // In a plane, except for some last bits.
            let [s, t] = [0; 2].map(|_| random.unit() * 3.0 - 1.0);
            corners[3] = [0, 1, 2].map(|k| {
                let along =
                    s * (corners[1][k] - corners[0][k]) + t * (corners[2][k] - corners[0][k]);
                ulps(corners[0][k] + along, random.around(3))
            });
        }
        if round % 5 == 0 {
            corners = corners.map(|p| p.map(|x| x * 2f64.powi(80)));
        }
        let weight =
            |random: &mut Random| random.around(9) as f64 * [0.0, 1.0, 1e-9, 1e9][round % 4];
        judged += usize::from(judge_center(
            corners.map(|[x, y, z]| [x, y, z, weight(&mut random)]),
        ));
    }
    assert!(judged > 1900, "{judged}");
    assert!(judge_center([
        [0.0; 4],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 2f64.powi(-120), 0.0]
    ]));
    assert!(judge_center([
        [0.0; 4],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1e-290, 0.0]
    ]));
}

/// Returns the volume of the part of tetrahedra in which linear functions are not positive.
fn volume_of_part(mut solids: Vec<[Site; 4]>, functions: &[&dyn Fn(Site) -> f64]) -> f64 {
    for function in functions {
        let mut left = Vec::new();
        // Corners with the values there; that of a cut is zero.
        let mut open: Vec<[(Site, f64); 4]> = solids
            .iter()
            .map(|solid| solid.map(|p| (p, function(p))))
            .collect();
        while let Some(solid) = open.pop() {
            let inside = solid.iter().position(|&(_, value)| value < 0.0);
            let outside = solid.iter().position(|&(_, value)| value > 0.0);
            if let (Some(i), Some(j)) = (inside, outside) {
                let [(p, at_p), (q, at_q)] = [solid[i], solid[j]];
                let along = at_p / (at_p - at_q);
                let cut = [0, 1, 2].map(|k| p[k] + along * (q[k] - p[k]));
                for end in [i, j] {
                    let mut half = solid;
                    half[end] = (cut, 0.0);
                    open.push(half);
                }
            } else if inside.is_some() {
                left.push(solid.map(|(p, _)| p));
            }
        }
        solids = left;
    }
    solids
        .iter()
        .map(|[a, b, c, d]| dot(minus(*b, *a), cross(minus(*c, *a), minus(*d, *a))).abs() / 6.0)
        .sum()
}

/// Cuts a box into six tetrahedra around its diagonal.
fn six_tetrahedra([low, high]: [Site; 2]) -> Vec<[Site; 4]> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let along = |order: [usize; 3]| {
        let mut at = low;
        let mut step = |axis: usize| {
            at[axis] = high[axis];
            at
        };
        [low, step(order[0]), step(order[1]), step(order[2])]
    };
    orders.map(along).to_vec()
}

/// What a diagram returns.
struct Diagram<'t> {
    tds: &'t Tds<4>,
    dimension: i32,
    point: &'t dyn Fn(VertexId) -> Weighted,
    cell: &'t dyn Fn(VertexId, [Site; 2]) -> VoronoiSolid,
    facet: &'t dyn Fn(Edge, [Site; 2]) -> Option<VoronoiFacet>,
    edge: &'t dyn Fn((CellId, usize)) -> Option<VoronoiEdge<3>>,
}

fn with_diagram(points: &[Weighted], is_weighted: bool, judge: impl FnOnce(&Diagram<'_>)) {
    if is_weighted {
        let (t, _) = Regular::from_points(WeightedSpace::new(), points).unwrap();
        judge(&Diagram {
            tds: t.tds(),
            dimension: t.dimension(),
            point: &|v| *t.point(v),
            cell: &|v, within| t.power_cell(v, within),
            facet: &|edge, within| t.power_facet(edge, within),
            edge: &|facet| t.power_edge(facet),
        });
    } else {
        let sites: Vec<Site> = points.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
        let (t, _) = Delaunay::from_points(Space::new(), &sites).unwrap();
        judge(&Diagram {
            tds: t.tds(),
            dimension: t.dimension(),
            point: &|v| {
                let [x, y, z] = *t.point(v);
                [x, y, z, 0.0]
            },
            cell: &|v, within| t.voronoi_cell(v, within),
            facet: &|edge, within| t.voronoi_facet(edge, within),
            edge: &|facet| t.voronoi_edge(facet),
        });
    }
}

/// Returns the vector perpendicular to a polygon, as long as its area is large.
fn area_vector(polygon: &[Site]) -> Site {
    let mut sum = [0.0; 3];
    for pair in polygon[1..].windows(2) {
        let normal = cross(minus(pair[0], polygon[0]), minus(pair[1], polygon[0]));
        sum = [0, 1, 2].map(|k| sum[k] + normal[k] / 2.0);
    }
    sum
}

#[test]
fn cells_fill_the_box_and_are_cut_by_all_bisectors() {
    let mut random = Random(2);
    for round in 0..500 {
        let is_weighted = round % 2 == 1;
        let low = [0; 3].map(|_| random.around(2) as f64 + 0.25 * random.unit());
        let within = [low, low.map(|x| x + 1.0 + random.below(6) as f64)];
        let whole: f64 = minus(within[1], within[0]).iter().product();
        with_diagram(
            &points(&mut random, round, is_weighted),
            is_weighted,
            |diagram| {
                let sites: Vec<Weighted> = diagram.tds.vertices().map(diagram.point).collect();
                let mut sum = 0.0;
                for vertex in diagram.tds.vertices() {
                    let here = (diagram.point)(vertex);
                    let cell = (diagram.cell)(vertex, within);
                    sum += cell.volume;
                    let others: Vec<_> = sites
                        .iter()
                        .filter(|&&other| other[..3] != here[..3])
                        .map(|other| move |at: Site| power(&here, at) - power(other, at))
                        .collect();
                    let functions: Vec<&dyn Fn(Site) -> f64> =
                        others.iter().map(|f| f as &dyn Fn(Site) -> f64).collect();
                    let expected = volume_of_part(six_tetrahedra(within), &functions);
                    assert!(
                        (cell.volume - expected).abs() < 1e-9 * whole,
                        "{expected} {} {sites:?}",
                        cell.volume
                    );

                    // The surface is closed, and each facet is turned away from the vertex.
                    let closed = cell
                        .facets
                        .iter()
                        .map(|facet| area_vector(&facet.corners))
                        .fold([0.0; 3], |sum, area| [0, 1, 2].map(|k| sum[k] + area[k]));
                    assert!(
                        closed.iter().all(|x| x.abs() < 1e-9 * whole),
                        "{closed:?} {sites:?}"
                    );
                    for facet in &cell.facets {
                        let Some(beyond) = facet.beyond else { continue };
                        let there = (diagram.point)(beyond);
                        let across = [0, 1, 2].map(|k| there[k] - here[k]);
                        assert!(dot(across, area_vector(&facet.corners)) > -1e-12 * whole);
                    }
                }
                assert!(
                    (sum - whole).abs() < 1e-9 * whole,
                    "{sum} {whole} {sites:?}"
                );
            },
        );
    }
}

/// Asserts that the points have the same power to some vertices, and less to no other.
fn judge_least(diagram: &Diagram<'_>, at: Site, of: &[VertexId]) {
    let here = power(&(diagram.point)(of[0]), at);
    let size = 1e-8 * (1.0 + dot(at, at));
    assert!(
        of.iter()
            .all(|&v| (power(&(diagram.point)(v), at) - here).abs() < size),
        "{at:?} {of:?}"
    );
    assert!(
        diagram
            .tds
            .vertices()
            .all(|v| power(&(diagram.point)(v), at) > here - size),
        "{at:?} {of:?}"
    );
}

#[test]
fn edges_and_facets_are_nearest_to_their_vertices() {
    let mut random = Random(3);
    let (mut kinds, mut facets) = ([0; 3], 0);
    for round in 0..600 {
        let is_weighted = round % 2 == 1;
        with_diagram(
            &points(&mut random, round, is_weighted),
            is_weighted,
            |diagram| {
                let tds = diagram.tds;
                let (width, dimension) = (
                    if diagram.dimension == 3 { 0..4 } else { 3..4 },
                    diagram.dimension,
                );
                for (cell, i) in tds
                    .cells()
                    .flat_map(|cell| width.clone().map(move |i| (cell, i)))
                {
                    let Some(edge) = (diagram.edge)((cell, i)) else {
                        let corners = tds.cell_vertices(cell).iter().enumerate();
                        let is_infinite = corners
                            .clone()
                            .any(|(k, &v)| k != i && v == VertexId::INFINITE);
                        assert!(dimension < 2 || is_infinite);
                        continue;
                    };
                    let corners = tds
                        .cell_vertices(cell)
                        .iter()
                        .enumerate()
                        .filter(|&(k, _)| k != i);
                    let corners: Vec<VertexId> = corners.map(|(_, &v)| v).collect();
                    let along = |p: Site, d: Site, s: f64| [0, 1, 2].map(|k| p[k] + s * d[k]);
                    let (kind, sites) = match edge {
                        VoronoiEdge::Segment([p, q]) => {
                            (0, [0.0, 0.3, 1.0].map(|s| along(p, minus(q, p), s)))
                        }
                        VoronoiEdge::Ray { from, direction } => {
                            (1, [0.0, 0.7, 9.0].map(|s| along(from, direction, s)))
                        }
                        VoronoiEdge::Line { through, direction } => {
                            (2, [-7.0, 0.0, 9.0].map(|s| along(through, direction, s)))
                        }
                    };
                    kinds[kind] += 1;
                    sites
                        .into_iter()
                        .for_each(|at| judge_least(diagram, at, &corners));
                    assert_eq!(kind == 2, dimension == 2);
                }
                let within = [[-9.0; 3], [9.0; 3]];
                for (cell, i, j) in tds.edges() {
                    let ends = tds.edge_ends((cell, i, j));
                    let Some(facet) = (diagram.facet)((cell, i, j), within) else {
                        assert!(ends.contains(&VertexId::INFINITE));
                        continue;
                    };
                    facets += usize::from(facet.corners.len() > 2);
                    assert_eq!(facet.beyond, Some(ends[1]));
                    facet
                        .corners
                        .iter()
                        .for_each(|&at| judge_least(diagram, at, &ends));
                    // It is that of the cells on both sides.
                    let back = (diagram.facet)((cell, j, i), within).unwrap();
                    let areas = [&facet, &back].map(|facet| match facet.corners.len() {
                        0..3 => 0.0,
                        _ => dot(area_vector(&facet.corners), area_vector(&facet.corners)).sqrt(),
                    });
                    assert!(
                        (areas[0] - areas[1]).abs() < 1e-9 * (1.0 + areas[0]),
                        "{areas:?}"
                    );
                }
            },
        );
    }
    assert!(
        kinds.iter().all(|&count| count > 300) && facets > 1000,
        "{kinds:?} {facets}"
    );
}

/// Numbers of no vertex, and boxes without bounds, have no cell; magnitudes without room do no
/// harm.
#[test]
fn what_has_no_cell() {
    let corners = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 1.0, 1.0],
    ];
    let (mut t, v) = Delaunay::from_points(Space::new(), &corners).unwrap();
    let _ = t.remove(v[4]);
    let cube = [[4.0, 0.0, 4.0], [0.0, 4.0, 0.0]];
    for gone in [v[4], VertexId::INFINITE, VertexId::new(99)] {
        assert!(t.voronoi_cell(gone, cube).facets.is_empty());
    }
    assert!((t.voronoi_cell(v[0], cube).volume - 8.0).abs() < 1e-12);
    for beyond in [f64::NAN, f64::INFINITY] {
        assert!(
            t.voronoi_cell(v[0], [[0.0; 3], [1.0, beyond, 1.0]])
                .facets
                .is_empty()
        );
    }
    for cell in t.tds().cells() {
        assert_eq!(
            t.circumcenter(cell),
            (!t.tds().is_infinite(cell)).then_some([2.0; 3])
        );
        assert!(
            t.voronoi_edge((cell, 4)).is_none() && t.voronoi_facet((cell, 1, 1), cube).is_none()
        );
        assert!(t.voronoi_facet((cell, 1, 7), cube).is_none());
    }

    let far = [
        [1e300, 0.0, 0.0],
        [-1e300, 1.0, 0.0],
        [0.0, 1e300, 1e-300],
        [1e-300, 0.0, 0.0],
        [0.0, 0.0, 1e300],
    ];
    let (t, vertices) = Delaunay::from_points(Space::<Wide>::default(), &far).unwrap();
    for v in vertices {
        t.voronoi_cell(v, [[0.0; 3], [1.0; 3]]);
    }
    assert_eq!(
        t.tds()
            .facets()
            .filter_map(|facet| t.voronoi_edge(facet))
            .count(),
        t.tds().finite_facets().count()
    );
}
