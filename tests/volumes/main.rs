//! Volumes between surfaces: against rational numbers, closed forms and laws.

mod changes;
mod judge;

use breakline::data::{Mesh, Surface};
use breakline::terrain::{TinBuilder, Volume, VolumeBase, Zones, volumes};
use testkit::random::Random;

use crate::judge::{exact, judge};

type Ring = Vec<[f64; 2]>;

fn between(a: &dyn Surface, b: &dyn Surface) -> Volume {
    volumes(a, VolumeBase::Surface(b), None, 1.0).unwrap()[0]
}

fn above(a: &dyn Surface, level: f64) -> Volume {
    volumes(a, VolumeBase::Level(level), None, 1.0).unwrap()[0]
}

/// A surface over the triangulation of points; `None` if they have no triangle.
fn surface(points: Vec<[f64; 3]>) -> Option<Mesh> {
    let mut builder = TinBuilder::default();
    let column = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
    builder.add_points(&column(0), &column(1), &column(2));
    let tin = builder
        .build()
        .ok()
        .filter(|tin| tin.report().triangles > 0)?;
    let vertices = (0..tin.vertex_count() as u32)
        .map(|v| tin.position(v))
        .collect();
    let faces = (0..tin.face_count() as u32)
        .filter_map(|face| tin.face(face))
        .collect();
    Some(Mesh::new(vertices, faces, &[], None).unwrap())
}

/// Points on a small grid, where surfaces share corners and sides; at random they are moved far
/// from the origin, and by steps that are no powers of two.
fn points(random: &mut Random, count: usize, shift: [f64; 3], step: f64) -> Vec<[f64; 3]> {
    (0..count)
        .map(|_| {
            let [x, y, z] = [6, 6, 3].map(|n| random.around(n) as f64);
            [shift[0] + step * x, shift[1] + step * y, shift[2] + z / 2.0]
        })
        .collect()
}

fn assert_near(found: f64, expected: f64, within: f64, what: &str) {
    assert!(
        (found - expected).abs() <= within,
        "{what}: {found} for {expected}, within {within}"
    );
}

/// The parts of two small surfaces, at most, each of which is rounded to 2^-100 or 2^-99.
const GRAINS: f64 = 64.0 / (1_u128 << 100) as f64;

/// A difference that is more than the rounding of heights: 16 units of the largest one.
fn least_difference(a: &Mesh, b: &Mesh) -> f64 {
    let heights = [a, b]
        .into_iter()
        .flat_map(|mesh| (0..mesh.vertex_count() as u32).map(|v| mesh.position(v)[2].abs()));
    16.0 * f64::EPSILON * heights.fold(0.0, f64::max)
}

/// The area of the box around two surfaces in plan, and its volume.
fn around(a: &Mesh, b: &Mesh) -> [f64; 2] {
    let points = || {
        [a, b]
            .into_iter()
            .flat_map(|mesh| (0..mesh.vertex_count() as u32).map(|v| mesh.position(v)))
    };
    let size = |k: usize| {
        let along = || points().map(move |p| p[k]);
        along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
    };
    let area = size(0) * size(1);
    [area, area * size(2)]
}

#[test]
fn volumes_are_those_of_rational_numbers() {
    let count = std::env::var("BREAKLINE_VOLUMES").map_or(400, |n| n.parse().unwrap());
    let mut judged = 0;
    for seed in 0..count {
        let mut random = Random(seed);
        let shift = random.pick(&[[0.0; 3], [885_000.25, 6_297_000.5, 1200.0]]);
        let step = random.pick(&[1.0, 0.37, 125.0]);
        let counts = [3 + random.index(9), 3 + random.index(9)];
        let [a, b] = counts.map(|count| surface(points(&mut random, count, shift, step)));
        let (Some(a), Some(b)) = (a, b) else { continue };
        judged += 1;
        let found = between(&a, &b);
        let expected = judge(&a, &b, &exact(least_difference(&a, &b)));
        let number = |x: &dashu_ratio::RBig| x.to_f64().value();
        let all = number(&(&expected.volumes[0] + &expected.volumes[1]));
        // Parts are added as multiples of 2^-100 of what the box around both can hold, which shows
        // where surfaces share a few roundings of their corners only.
        let [box_area, box_volume] = around(&a, &b);
        let volume = GRAINS * box_volume
            + 1e-12
                * if all > 0.0 {
                    all
                } else {
                    // Where both are about equal, the height range of the grid counts.
                    3.0 * number(&expected.common)
                };
        let area = GRAINS * box_area + 1e-12 * number(&expected.common);
        let pairs = [
            ("cut", found.cut, &expected.volumes[0], volume),
            ("fill", found.fill, &expected.volumes[1], volume),
            ("common area", found.common_area, &expected.common, area),
        ];
        for (what, found, expected, within) in pairs {
            let error = number(&(exact(found) - expected)).abs();
            assert!(
                error <= within,
                "seed {seed}, {what}: {found}, off by {error}"
            );
        }
        // What is level but for the rounding of heights is of any of the three areas.
        let sure = |k: usize| number(&expected.areas[k]);
        let level = number(&expected.common) - sure(0) - sure(1);
        assert_near(
            found.cut_area,
            sure(0),
            level + 1e-9 * sure(0) + area,
            &format!("seed {seed}, cut area"),
        );
        assert_near(
            found.fill_area,
            sure(1),
            level + 1e-9 * sure(1) + area,
            &format!("seed {seed}, fill area"),
        );
        let exchanged = between(&b, &a);
        assert_eq!(
            (found.cut, found.fill),
            (exchanged.fill, exchanged.cut),
            "seed {seed}"
        );
        assert_eq!(
            (found.surface_only_area, found.base_only_area),
            (exchanged.base_only_area, exchanged.surface_only_area),
            "seed {seed}"
        );
    }
    assert!(judged > count * 9 / 10, "{judged}");
}

#[test]
fn listing_and_threads_do_not_show() {
    let mut random = Random(7);
    let shift = [500_000.3, 4_000_000.7, 50.0];
    let [a, b] = [5000, 3000].map(|count| {
        let mut point = || {
            let [x, y] = [random.unit(), random.unit()];
            [
                shift[0] + 100.0 * x,
                shift[1] + 100.0 * y,
                shift[2] + (7.0 * x).sin() + random.unit(),
            ]
        };
        surface((0..count).map(|_| point()).collect()).unwrap()
    });
    let expected = between(&a, &b);
    assert!(expected.cut > 100.0 && expected.fill > 100.0);
    let shuffled = shuffled(&a, &mut random);
    assert_eq!(between(&shuffled, &b), expected);
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert_eq!(one.install(|| between(&shuffled, &b)), expected);
}

/// The same triangles with other numbers, each from another corner.
fn shuffled(mesh: &Mesh, random: &mut Random) -> Mesh {
    let count = mesh.vertex_count();
    let mut order: Vec<u32> = (0..count as u32).collect();
    random.shuffle(&mut order);
    let mut vertices = vec![[0.0; 3]; count];
    (0..count).for_each(|v| vertices[order[v] as usize] = mesh.position(v as u32));
    let mut faces: Vec<[u32; 3]> = (0..mesh.face_count() as u32)
        .filter_map(|face| mesh.face(face))
        .map(|corners| {
            let mut corners = corners.map(|v| order[v as usize]);
            corners.rotate_left(random.index(3));
            corners
        })
        .collect();
    random.shuffle(&mut faces);
    Mesh::new(vertices, faces, &[], None).unwrap()
}

#[test]
fn a_surface_and_itself_enclose_nothing() {
    let mut random = Random(3);
    let mut point = || {
        let [x, y, z] = [200_000, 200_000, 20_000].map(|n| random.below(n) as f64 / 1024.0);
        [x + 1_000_000.0, y + 5_000_000.0, z]
    };
    let mesh = surface((0..2000).map(|_| point()).collect()).unwrap();
    let area = above(&mesh, 0.0).common_area;
    for other in [shuffled(&mesh, &mut random), halved(&mesh)] {
        let found = between(&mesh, &other);
        assert!(found.cut + found.fill <= 1e-12 * area * 20.0, "{found:?}");
        assert_near(found.common_area, area, 1e-12 * area, "area");
        assert!(found.surface_only_area <= 1e-12 * area && found.base_only_area <= 1e-12 * area);
    }
}

/// The same surface with each triangle divided at the middle of its sides.
fn halved(mesh: &Mesh) -> Mesh {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for face in 0..mesh.face_count() as u32 {
        let Some([a, b, c]) = mesh.triangle(face) else {
            continue;
        };
        let middle = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| (p[k] + q[k]) / 2.0);
        let first = vertices.len() as u32;
        vertices.extend([a, b, c, middle(b, c), middle(c, a), middle(a, b)]);
        let corners = [[0, 5, 4], [1, 3, 5], [2, 4, 3], [3, 4, 5]];
        faces.extend(corners.map(|corners| corners.map(|k| first + k)));
    }
    Mesh::new(vertices, faces, &[], None).unwrap()
}

/// A pyramid over a square with sides of 2, shifted, with its peak at the middle.
fn pyramid(shift: [f64; 2], base: f64, peak: f64) -> Mesh {
    let corner = |x: f64, y: f64, z: f64| [shift[0] + x, shift[1] + y, z];
    let vertices = vec![
        corner(-1.0, -1.0, base),
        corner(1.0, -1.0, base),
        corner(1.0, 1.0, base),
        corner(-1.0, 1.0, base),
        corner(0.0, 0.0, peak),
    ];
    let faces = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    Mesh::new(vertices, faces, &[], None).unwrap()
}

#[test]
fn known_solids_have_their_volumes() {
    for shift in [[0.0, 0.0], [437_512.25, 5_812_004.5]] {
        let hill = pyramid(shift, 10.0, 13.0);
        // A third of the base times the height; above a level, smaller by its cube.
        for (level, cut, fill) in [(10.0, 4.0, 0.0), (11.5, 0.5, 2.5), (13.0, 0.0, 8.0)] {
            let found = above(&hill, level);
            assert_near(found.cut, cut, 1e-12 * (cut + fill), "cut");
            assert_near(found.fill, fill, 1e-12 * (cut + fill), "fill");
            assert_near(found.common_area, 4.0, 1e-12, "area");
        }
        assert_near(above(&hill, 11.5).cut_area, 1.0, 1e-12, "cut area");
        // A hill and its reflection: equal at half the height.
        let valley = pyramid(shift, 13.0, 10.0);
        let found = between(&hill, &valley);
        assert_near(found.cut, 1.0, 1e-12, "cut");
        assert_near(found.fill, 5.0, 1e-11, "fill");
        assert_near(found.net(), -4.0, 1e-11, "net");
        // Half of it beside the other.
        let beside = pyramid([shift[0] + 1.0, shift[1]], 0.0, 0.0);
        let found = between(&hill, &beside);
        assert_near(found.cut, 22.0, 1e-10, "cut over half");
        for area in [
            found.common_area,
            found.surface_only_area,
            found.base_only_area,
        ] {
            assert_near(area, 2.0, 1e-12, "areas");
        }
        let far = pyramid([shift[0] + 10.0, shift[1]], 0.0, 0.0);
        let found = between(&hill, &far);
        assert_eq!((found.cut, found.fill, found.common_area), (0.0, 0.0, 0.0));
        assert_near(found.surface_only_area, 4.0, 1e-12, "alone");
    }
}

fn square(min: [f64; 2], max: [f64; 2]) -> Ring {
    vec![min, [max[0], min[1]], max, [min[0], max[1]], min]
}

#[test]
fn zones_of_a_partition_sum_to_the_whole() {
    let mut random = Random(11);
    let mut draw = |count: usize| {
        let point = |_| {
            let [x, y] = [random.unit(), random.unit()].map(|c| 50.0 * c);
            [x, y, (x / 9.0).sin() * (y / 7.0).cos() + random.unit()]
        };
        surface((0..count).map(point).collect()).unwrap()
    };
    let (a, b) = (draw(800), draw(500));
    let hole = square([20.0, 20.0], [30.0, 30.0]);
    // The plan in three: left, right without a square, and the square.
    let zones = Zones::new(&[
        vec![square([-1.0, -1.0], [17.3, 51.0])],
        vec![square([17.3, -1.0], [51.0, 51.0]), hole.clone()],
        vec![hole.clone()],
    ])
    .unwrap();
    for base in [VolumeBase::Surface(&b), VolumeBase::Level(0.4)] {
        let whole = volumes(&a, base, None, 1.0).unwrap()[0];
        let rows = volumes(&a, base, Some(&zones), 1.0).unwrap();
        assert_eq!(rows.len(), zones.count());
        assert!(rows.iter().all(|row| row.cut > 1.0 && row.fill > 1.0));
        let sum = |of: fn(&Volume) -> f64| rows.iter().map(of).sum::<f64>();
        let tolerance = 1e-12 * (whole.cut + whole.fill);
        assert_near(sum(|row| row.cut), whole.cut, tolerance, "cut");
        assert_near(sum(|row| row.fill), whole.fill, tolerance, "fill");
        let area = 1e-12 * whole.common_area;
        assert_near(sum(|row| row.common_area), whole.common_area, area, "area");
        assert_near(sum(|row| row.cut_area), whole.cut_area, area, "cut area");
        assert_near(
            sum(|row| row.surface_only_area),
            whole.surface_only_area,
            area,
            "area of the surface alone",
        );
        assert_near(rows[2].common_area, 100.0, 1e-10, "square");
    }
}

#[test]
fn zones_take_any_rings() {
    let hill = pyramid([0.0, 0.0], 0.0, 3.0);
    let inside = |rings: Vec<Ring>| {
        let zones = Zones::new(&[rings]).unwrap();
        volumes(&hill, VolumeBase::Level(0.0), Some(&zones), 1.0).unwrap()[0]
    };
    let whole = inside(vec![square([-5.0, -5.0], [5.0, 5.0])]);
    assert_near(whole.cut, 4.0, 1e-12, "whole");
    // Without the last vertex, clockwise, with a side passed twice.
    let mut open = square([0.0, -1.0], [1.0, 1.0]);
    open.pop();
    open.reverse();
    assert_near(inside(vec![open.clone()]).cut, 2.0, 1e-12, "open");
    open.insert(1, [7.0, 0.0]);
    open.insert(1, open[0]);
    assert!(inside(vec![open]).cut > 0.0);
    // A bow tie: two triangles that meet in the middle.
    let tie = vec![[-1.0, -1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0]];
    assert_near(inside(vec![tie]).common_area, 2.0, 1e-12, "bow tie");
    for nothing in [
        vec![],
        vec![vec![]],
        vec![vec![[0.0, 0.0]]],
        vec![vec![[0.0, 0.0], [1.0, 0.0]]],
    ] {
        assert_eq!(inside(nothing), Volume::default());
    }
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let error = Zones::new(&[vec![vec![[0.0, 0.0], [bad, 0.0], [0.0, 1.0]]]]).unwrap_err();
        assert!(
            error.to_string().contains("[0.0, 0.0, 0.0]") || error.to_string().contains("0.0"),
            "{error}"
        );
    }
}

#[test]
fn nothing_is_computed_of_what_is_no_number() {
    let hill = pyramid([0.0, 0.0], 0.0, 3.0);
    for level in [f64::NAN, f64::INFINITY] {
        let error = volumes(&hill, VolumeBase::Level(level), None, 1.0).unwrap_err();
        assert!(error.to_string().contains("is not a height"), "{error}");
    }
    let error = volumes(&hill, VolumeBase::Level(1e300), None, 1.0).unwrap_err();
    assert!(error.to_string().contains("extend over 1e300"), "{error}");
    let tiny = pyramid([0.0, 0.0], 0.0, 1e-200);
    let error = volumes(&tiny, VolumeBase::Level(0.0), None, 1.0).unwrap_err();
    assert!(error.to_string().contains("extend over 1e-200"), "{error}");
}

#[test]
fn what_has_no_face_has_no_volume() {
    let nothing = Mesh::new(vec![[0.0; 3]], vec![], &[], None).unwrap();
    let hill = pyramid([0.0, 0.0], 0.0, 3.0);
    assert_eq!(between(&nothing, &nothing), Volume::default());
    assert_eq!(above(&nothing, 7.0), Volume::default());
    let found = between(&hill, &nothing);
    let alone = Volume {
        surface_only_area: 4.0,
        slope_area: found.slope_area,
        ..Volume::default()
    };
    assert_eq!(found, alone);
    assert_eq!(between(&nothing, &hill).base_only_area, 4.0);
}

#[test]
fn areas_along_slopes_depend_on_the_units_of_heights() {
    let hill = pyramid([437_512.25, 5_812_004.5], 10.0, 13.0);
    let beside = pyramid([437_513.25, 5_812_004.5], 10.0, 10.0);
    let left = Zones::new(&[vec![square(
        [437_511.0, 5_812_003.0],
        [437_512.25, 5_812_006.0],
    )]]);
    let left = left.unwrap();
    for height_unit in [1.0, 0.3048, 1e-3_f64] {
        // Four faces of 1 in plan; they rise by 3 units over 1.
        let along = (1.0 + (3.0 * height_unit).powi(2)).sqrt();
        for base in [VolumeBase::Level(11.0), VolumeBase::Surface(&beside)] {
            let slope_area =
                |zones| volumes(&hill, base, zones, height_unit).unwrap()[0].slope_area;
            assert_near(slope_area(None), 4.0 * along, 1e-12 * along, "whole");
            assert_near(
                slope_area(Some(&left)),
                2.0 * along,
                1e-12 * along,
                "left half",
            );
        }
    }
}

#[test]
fn slivers_and_tiny_triangles_beside_large_ones_are_as_exact() {
    // A fan of slivers over the square of a pyramid, in which triangles of all sizes meet.
    let hill = pyramid([0.0, 0.0], 0.0, 3.0);
    for count in [1u32, 7, 1000] {
        for width in [1e-3, 1e-9, 1e-13, 1e-200] {
            let mut vertices = vec![[-1.0, -1.0, 5.0]];
            let ys = (0..=count).map(|i| -1.0 + width * f64::from(i) / f64::from(count));
            vertices.extend(ys.chain([1.0]).map(|y| [1.0, y, 5.0]));
            vertices.dedup();
            vertices.push([-1.0, 1.0, 5.0]);
            let last = vertices.len() as u32 - 1;
            let faces = (1..last).map(|i| [0, i, i + 1]).collect();
            let fan = Mesh::new(vertices, faces, &[], None).unwrap();
            let found = between(&hill, &fan);
            assert_near(found.fill, 16.0, 16e-12, "fill");
            assert_near(found.common_area, 4.0, 4e-12, "area");
            assert_eq!(found.cut, 0.0);
        }
    }
}
