//! Volumes from the definition, in rational numbers: each triangle of one surface against each of
//! the other.

use breakline::data::Surface;
use dashu_ratio::RBig;

type Exact = [RBig; 2];

/// Cut, fill, and their areas, as [`breakline::terrain::Volume`] has them; the areas are those
/// where heights differ by more than is asked for.
#[derive(Debug, Default)]
pub(crate) struct Judged {
    pub(crate) volumes: [RBig; 2],
    pub(crate) areas: [RBig; 2],
    pub(crate) common: RBig,
}

pub(crate) fn judge(a: &dyn Surface, b: &dyn Surface, least: &RBig) -> Judged {
    let mut sum = Judged::default();
    let others = triangles(b);
    for one in triangles(a) {
        for other in &others {
            let mut polygon: Vec<Exact> = one.iter().map(plan).collect();
            for j in 0..3 {
                let line = [plan(&other[j]), plan(&other[(j + 1) % 3])];
                polygon = kept(&polygon, |p| turn(&line[0], &line[1], p));
            }
            let above = |p: &Exact| height(&one, p) - height(other, p);
            sum.common += area(&polygon);
            let cut = kept(&polygon, above);
            sum.volumes[0] += integral(&cut, above);
            sum.areas[0] += area(&kept(&polygon, |p| above(p) - least));
            let below = |p: &Exact| -above(p);
            let fill = kept(&polygon, below);
            sum.volumes[1] += integral(&fill, below);
            sum.areas[1] += area(&kept(&polygon, |p| below(p) - least));
        }
    }
    sum
}

pub(crate) fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

fn triangles(surface: &dyn Surface) -> Vec<[[RBig; 3]; 3]> {
    (0..surface.face_count() as u32)
        .filter_map(|face| surface.triangle(face))
        .map(|corners| corners.map(|p| p.map(exact)))
        .collect()
}

fn plan([x, y, _]: &[RBig; 3]) -> Exact {
    [x.clone(), y.clone()]
}

fn turn(a: &Exact, b: &Exact, p: &Exact) -> RBig {
    (&b[0] - &a[0]) * (&p[1] - &a[1]) - (&b[1] - &a[1]) * (&p[0] - &a[0])
}

/// The part of a convex polygon where a linear function is not negative.
fn kept(polygon: &[Exact], of: impl Fn(&Exact) -> RBig) -> Vec<Exact> {
    let mut found = Vec::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (at_p, at_q) = (of(p), of(q));
        if at_p >= RBig::ZERO {
            found.push(p.clone());
        }
        if (at_p < RBig::ZERO) != (at_q < RBig::ZERO) && at_p != RBig::ZERO && at_q != RBig::ZERO {
            let t = &at_p / (&at_p - &at_q);
            found.push([0, 1].map(|k| &p[k] + &t * (&q[k] - &p[k])));
        }
    }
    found
}

/// The height of the plane of a triangle.
fn height(triangle: &[[RBig; 3]; 3], p: &Exact) -> RBig {
    let [a, b, c] = [0, 1, 2].map(|i| plan(&triangle[i]));
    let all = turn(&a, &b, &c);
    let parts = [turn(&b, &c, p), turn(&c, &a, p), turn(&a, &b, p)];
    (0..3)
        .map(|i| &parts[i] * &triangle[i][2])
        .fold(RBig::ZERO, |sum, part| sum + part)
        / all
}

/// The triangles of a fan over a polygon, each with its area.
fn fan(polygon: &[Exact]) -> impl Iterator<Item = ([&Exact; 3], RBig)> {
    (2..polygon.len()).map(|i| {
        let corners = [&polygon[0], &polygon[i - 1], &polygon[i]];
        let area = turn(corners[0], corners[1], corners[2]) / RBig::from(2);
        (corners, area)
    })
}

fn area(polygon: &[Exact]) -> RBig {
    fan(polygon).fold(RBig::ZERO, |sum, (_, area)| sum + area)
}

fn integral(polygon: &[Exact], of: impl Fn(&Exact) -> RBig) -> RBig {
    fan(polygon).fold(RBig::ZERO, |sum, (corners, area)| {
        let heights = corners.iter().fold(RBig::ZERO, |sum, p| sum + of(p));
        sum + area * heights / RBig::from(3)
    })
}
