//! Points that are mapped to sites: the triangles are those of the sites in the plane, whatever a
//! point is.

use std::fmt::Debug;

use breakline_triangulation::geometry::{Coordinates, Mapped, Metric, Plane, seen_along};
use breakline_triangulation::kernel::{Exact, Fixed};
use breakline_triangulation::{Delaunay, Level, Triangulation};
use testkit::random::Random;

/// Returns the triangles by the positions of their points, each from its smallest corner on:
/// orientation counts.
fn triangles<G: Coordinates<3>, V, C: Copy + Default>(
    t: &Triangulation<G, 3, V, C>,
    positions: &[usize],
) -> Vec<[usize; 3]> {
    let mut triangles: Vec<[usize; 3]> = t
        .finite_cells()
        .filter(|_| t.dimension() == 2)
        .map(|cell| {
            let [a, b, c] = [0, 1, 2].map(|i| positions[t.tds().vertex(cell, i).index()]);
            [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

/// Compares bulk and one-by-one construction with the plane. Returns the number of triangles.
fn same<G>(geometry: G, points: &[G::Point], site: impl Fn(&G::Point) -> [f64; 2]) -> usize
where
    G: Coordinates<3> + Metric + Clone,
    G::Point: Debug,
{
    let sites: Vec<[f64; 2]> = points.iter().map(&site).collect();
    let positions = |vertices: &[breakline_triangulation::tds::VertexId]| {
        let mut first = vec![usize::MAX; vertices.len()];
        for (i, v) in vertices.iter().enumerate().rev() {
            first[v.index()] = i;
        }
        first
    };
    let (plane, vertices) = Delaunay::from_points(Plane::<Exact>::default(), &sites).unwrap();
    let expected = triangles(&plane, &positions(&vertices));
    let (bulk, vertices) = Delaunay::from_points(geometry.clone(), points).unwrap();
    assert_eq!(bulk.check(Level::Law), [], "{points:?}");
    assert_eq!(
        triangles(&bulk, &positions(&vertices)),
        expected,
        "{points:?}"
    );
    let mut one_by_one = Delaunay::<G, 3>::new(geometry);
    let vertices: Vec<_> = points
        .iter()
        .map(|&p| one_by_one.insert(p).unwrap())
        .collect();
    for three in points.windows(3) {
        let [q, a, b] = [0, 1, 2].map(|i| &three[i]);
        let expected = Plane::<Exact>::default().compare_distance(&site(q), &site(a), &site(b));
        assert_eq!(
            one_by_one.geometry().compare_distance(q, a, b),
            expected,
            "{three:?}"
        );
    }
    assert_eq!(
        triangles(&one_by_one, &positions(&vertices)),
        expected,
        "{points:?}"
    );
    expected.len()
}

type Site = fn(&[f64; 3]) -> [f64; 2];

#[derive(Clone, Copy, Debug)]
struct Sample {
    at: (f32, f32),
    #[allow(dead_code, reason = "carried along")]
    name: char,
}

#[test]
fn triangles_are_those_of_the_sites() {
    let mut random = Random(1);
    let mut count = 0;
    for _ in 0..400 {
        let side = random.pick(&[2, 4, 1000]);
        let mut grid = || random.around(side) as f64;
        let points: Vec<[f64; 3]> = (0..20).map(|_| [grid(), grid(), grid()]).collect();
        // Functions of one type, so that triangulations are compiled once.
        let [upright, scaled]: [Site; 2] = [|p| [p[0], p[2]], |p| [0.3 * p[0], 0.1 * p[1]]];
        count += same(Mapped::new(upright), &points, upright);
        count += same(Mapped::new(scaled), &points, scaled);
        count += same(
            Mapped::new(|p: &[f64; 3]| [p[1], p[2]]).with_kernel::<Fixed>(),
            &points,
            |p| [p[1], p[2]],
        );
        let samples: Vec<Sample> = points
            .iter()
            .map(|p| Sample {
                at: (0.7 * p[0] as f32, 0.7 * p[1] as f32),
                name: 'a',
            })
            .collect();
        let at = |s: &Sample| [s.at.0.into(), s.at.1.into()];
        count += same(Mapped::new(at), &samples, at);
    }
    assert!(count > 10_000, "{count}");
}

/// Every direction: the normal is mapped to the origin, lengths and angles perpendicular to it are
/// kept, and so is orientation.
#[test]
fn planes_by_their_normals() {
    let mut random = Random(2);
    for round in 0..2000 {
        let size = [1.0, 1e300, 1e-300, 5e-324][round % 4];
        let normal = [(); 3].map(|()| size * random.around(3) as f64);
        let Some(seen) = seen_along(normal) else {
            assert_eq!(normal, [0.0; 3]);
            continue;
        };
        let direction = normal.map(|x| x / size);
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        let site = |p: [f64; 3]| seen(&p);
        assert!(site(direction).iter().all(|x| x.abs() < 1e-14 * length));
        let (p, q) = (
            [(); 3].map(|()| random.unit()),
            [(); 3].map(|()| random.unit()),
        );
        // The area that two vectors span, seen from there, is a determinant.
        let volume: f64 = (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                direction[i] * (p[j] * q[k] - p[k] * q[j])
            })
            .sum();
        let ([px, py], [qx, qy]) = (site(p), site(q));
        assert!(
            (px * qy - py * qx - volume / length).abs() < 1e-14,
            "{normal:?}"
        );
        let along: f64 = p.iter().zip(direction).map(|(p, d)| p * d / length).sum();
        let squared: f64 = p.iter().map(|x| x * x).sum();
        assert!(
            (px * px + py * py + along * along - squared).abs() < 1e-14,
            "{normal:?}"
        );
        let points: Vec<[f64; 3]> = (0..12)
            .map(|_| [(); 3].map(|()| random.around(3) as f64))
            .collect();
        same(Mapped::new(seen), &points, seen);
    }
    let on = |normal| seen_along(normal).unwrap()(&[0.1, 0.2, 0.3]);
    assert_eq!(on([0.0, 0.0, 5.0]), [0.1, 0.2]);
    assert_eq!(on([0.0, 0.0, -1.0]), [0.1, -0.2]);
    assert_eq!(on([2.0, 0.0, 0.0]), [-0.3, 0.2]);
    assert!(
        seen_along([f64::NAN, 0.0, 1.0]).is_none()
            && seen_along([f64::INFINITY, 0.0, 1.0]).is_none()
    );
}

#[test]
fn sites_that_no_kernel_admits_are_refused() {
    let mut t = Delaunay::<_, 3>::new(Mapped::new(|p: &[f64; 2]| p.map(|x| 1.0 / x)));
    assert!(
        t.insert([1.0, 0.0]).is_err()
            && t.insert([1e-300, 1.0]).is_err()
            && t.insert([1.0, 2.0]).is_ok()
    );
    let mut t = Delaunay::<_, 3>::new(
        Mapped::new(|p: &[f64; 2]| p.map(|x| x / 2.0)).with_kernel::<Fixed>(),
    );
    assert!(t.insert([1.0, 0.0]).is_err() && t.insert([2.0, -4.0]).is_ok());
}
