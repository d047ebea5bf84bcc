//! The heights along a line from the definition, in rational numbers: each segment against each
//! face.

use breakline::data::Surface;
use dashu_ratio::RBig;

type Exact = [RBig; 2];

/// A point of a line on a surface: the number of its segment and the fraction of it, and the
/// position.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judged {
    pub(crate) along: (usize, RBig),
    pub(crate) at: [RBig; 3],
}

pub(crate) fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

/// Returns the parts of a line on a surface: a point wherever the line passes an edge, a vertex, or
/// a vertex of its own.
pub(crate) fn judge(surface: &dyn Surface, line: &[[f64; 2]]) -> Vec<Vec<Judged>> {
    let faces: Vec<[[RBig; 3]; 3]> = (0..surface.face_count() as u32)
        .filter_map(|face| surface.triangle(face))
        .map(|corners| corners.map(|p| p.map(exact)))
        .collect();
    let mut all: Vec<Vec<Judged>> = Vec::new();
    for (number, ends) in line.windows(2).enumerate() {
        if ends[0] == ends[1] {
            continue;
        }
        let [a, b] = [ends[0], ends[1]].map(|p| p.map(exact));
        for part in covered(&faces, &a, &b) {
            let points = part.into_iter().map(|(t, z)| {
                let [x, y] = [0, 1].map(|k| &a[k] + &t * (&b[k] - &a[k]));
                Judged {
                    along: (number, t),
                    at: [x, y, z],
                }
            });
            let points: Vec<Judged> = points.collect();
            match all.last_mut() {
                Some(known) if goes_on(known, &points[0], line) => {
                    known.extend(points.into_iter().skip(1));
                }
                _ => all.push(points),
            }
        }
    }
    all
}

/// Returns true if a part begins where the segment before has ended: at the end of that segment.
fn goes_on(known: &[Judged], first: &Judged, line: &[[f64; 2]]) -> bool {
    let (number, t) = &first.along;
    let is_at_vertex = |last: &Judged| {
        let between = &line[last.along.0 + 1..=*number];
        last.along.1 == RBig::ONE && between.iter().all(|p| *p == line[*number])
    };
    *t == RBig::ZERO && known.last().is_some_and(is_at_vertex)
}

/// Returns the fractions of a segment at which it meets edges and vertices, with the heights there:
/// a list for each part of it on the surface.
fn covered(faces: &[[[RBig; 3]; 3]], a: &Exact, b: &Exact) -> Vec<Vec<(RBig, RBig)>> {
    let mut found: Vec<[(RBig, RBig); 2]> = Vec::new();
    for face in faces {
        let [mut first, mut last] = [RBig::ZERO, RBig::ONE];
        for k in 0..3 {
            let [p, q] = [&face[k], &face[(k + 1) % 3]];
            let (at_a, at_b) = (turn(p, q, a), turn(p, q, b));
            if at_a < RBig::ZERO && at_b < RBig::ZERO {
                last = RBig::from(-1);
            } else if (at_a < RBig::ZERO) != (at_b < RBig::ZERO) {
                let t = &at_a / (&at_a - &at_b);
                if at_a < RBig::ZERO {
                    first = first.max(t);
                } else {
                    last = last.min(t);
                }
            }
        }
        if first < last {
            let at = |t: RBig| {
                let p = [0, 1].map(|k| &a[k] + &t * (&b[k] - &a[k]));
                let z = height(face, &p);
                (t, z)
            };
            found.push([at(first), at(last)]);
        }
    }
    found.sort();
    let mut parts: Vec<Vec<(RBig, RBig)>> = Vec::new();
    let mut end = RBig::from(-1);
    for [first, last] in found {
        if first.0 > end {
            parts.push(Vec::new());
        }
        end = end.max(last.0.clone());
        let part = parts.last_mut().expect("one was pushed");
        part.extend([first, last]);
    }
    for part in &mut parts {
        part.sort();
        part.dedup();
    }
    parts
}

fn turn(p: &[RBig; 3], q: &[RBig; 3], r: &Exact) -> RBig {
    (&q[0] - &p[0]) * (&r[1] - &p[1]) - (&q[1] - &p[1]) * (&r[0] - &p[0])
}

/// The height of the plane of a triangle.
fn height(face: &[[RBig; 3]; 3], at: &Exact) -> RBig {
    let [a, b, c] = face;
    let all = turn(a, b, &[c[0].clone(), c[1].clone()]);
    let parts = [turn(b, c, at), turn(c, a, at), turn(a, b, at)];
    (0..3).fold(RBig::ZERO, |sum, i| sum + &parts[i] * &face[i][2]) / all
}
