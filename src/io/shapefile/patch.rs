//! Converts multipatches, which are strips, fans and rings in space, to triangles.

type Triangle = [[f64; 3]; 3];

/// Rings with more vertices are left out: at worst the time grows with the cube of their number,
/// here to about a second.
const MAX_RING: usize = 1_000;

// Part types (ESRI Shapefile Technical Description, 1998, page 20).
const STRIP: i32 = 0;
const FAN: i32 = 1;
const OUTER: i32 = 2;
const INNER: i32 = 3;
const FIRST: i32 = 4;
const RING: i32 = 5;

/// Returns the triangles of the parts, and the number of parts that have none.
///
/// Rings are triangulated in the coordinate plane in which they appear widest; inner rings are
/// holes of the ring before them.
pub(super) fn triangles(parts: &[Vec<[f64; 3]>], kinds: &[i32]) -> (Vec<Triangle>, usize) {
    let mut out = Vec::new();
    let mut unfilled = 0;
    let mut i = 0;
    while i < parts.len().min(kinds.len()) {
        let part = &parts[i];
        let mut next = i + 1;
        match kinds[i] {
            // Every second triangle of a strip is reversed, so that all have the same orientation.
            STRIP => out.extend(part.windows(3).enumerate().map(|(n, w)| match n % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[1], w[0], w[2]],
            })),
            FAN => out.extend(part.windows(2).skip(1).map(|w| [part[0], w[0], w[1]])),
            kind @ (OUTER | INNER | FIRST | RING) => {
                let hole = if kind == OUTER { INNER } else { RING };
                while kind != INNER && kind != RING && kinds.get(next) == Some(&hole) && next < parts.len() {
                    next += 1;
                }
                match fill(part, &parts[i + 1..next]) {
                    Some(filled) => out.extend(filled),
                    None => unfilled += next - i,
                }
            }
            _ => unfilled += 1,
        }
        i = next;
    }
    (out, unfilled)
}

/// Triangulates a ring with holes by ear clipping (Meisters 1975); bridges from their rightmost
/// vertices join holes to the ring (Eberly 2002). Returns `None` for a ring that has no area, or
/// crosses itself so that no ear is left.
fn fill(outer: &[[f64; 3]], holes: &[Vec<[f64; 3]>]) -> Option<Vec<Triangle>> {
    if outer.len() + holes.iter().map(Vec::len).sum::<usize>() > MAX_RING {
        return None;
    }
    let normal = newell(outer);
    let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))?;
    if normal[axis] == 0.0 || !normal[axis].is_finite() {
        return None;
    }
    // The cyclic order of the two other axes preserves the sign of the area.
    let flat = |p: &[f64; 3]| [p[(axis + 1) % 3], p[(axis + 2) % 3]];
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut ring = |source: &[[f64; 3]], positive: bool| -> Vec<usize> {
        let open = match source {
            [first, middle @ .., last] if first == last => &source[..=middle.len()],
            _ => source,
        };
        let from = points.len();
        points.extend_from_slice(open);
        let mut ids: Vec<usize> = (from..points.len()).collect();
        if (newell(source)[axis] > 0.0) != positive {
            ids.reverse();
        }
        ids
    };
    let mut path = ring(outer, true);
    let mut holes: Vec<Vec<usize>> = holes.iter().map(|hole| ring(hole, false)).collect();
    let at = |id: usize| flat(&points[id]);
    let right = |ids: &[usize]| ids.iter().copied().max_by(|&a, &b| at(a)[0].total_cmp(&at(b)[0]));
    holes.retain(|hole| hole.len() > 2);
    holes.sort_by(|a, b| {
        let x = |ids: &[usize]| right(ids).map_or(0.0, |id| at(id)[0]);
        x(b).total_cmp(&x(a))
    });
    while let Some(hole) = (!holes.is_empty()).then(|| holes.remove(0)) {
        let start = hole.iter().position(|&id| Some(id) == right(&hole))?;
        let from = at(hole[start]);
        let clear = |k: &usize| {
            let to = at(path[*k]);
            let n = path.len();
            is_within_corner(to, at(path[(k + n - 1) % n]), at(path[(k + 1) % n]), from)
                && [&path, &hole].into_iter().chain(&holes).all(|ring| {
                    (0..ring.len()).all(|i| !segments_meet(from, to, at(ring[i]), at(ring[(i + 1) % ring.len()])))
                })
        };
        let door = (0..path.len())
            .filter(clear)
            .min_by(|&a, &b| distance(at(path[a]), from).total_cmp(&distance(at(path[b]), from)))?;
        let detour: Vec<usize> = hole[start..].iter().chain(&hole[..=start]).copied().chain([path[door]]).collect();
        path.splice(door + 1..door + 1, detour);
    }

    let turned = normal[axis] < 0.0;
    let mut out = Vec::with_capacity(path.len());
    while path.len() > 2 {
        let n = path.len();
        let ear = (0..n).find(|&k| {
            let [a, b, c] = [path[(k + n - 1) % n], path[k], path[(k + 1) % n]];
            let turn = area(at(a), at(b), at(c));
            turn == 0.0
                || turn > 0.0
                    && path.iter().all(|&id| {
                        let p = at(id);
                        [a, b, c].iter().any(|&corner| at(corner) == p)
                            || !(area(at(a), at(b), p) >= 0.0
                                && area(at(b), at(c), p) >= 0.0
                                && area(at(c), at(a), p) >= 0.0)
                    })
        })?;
        let [a, b, c] = [path[(ear + n - 1) % n], path[ear], path[(ear + 1) % n]];
        path.remove(ear);
        if area(at(a), at(b), at(c)) > 0.0 {
            let [a, b, c] = [a, b, c].map(|id| points[id]);
            out.push(if turned { [a, c, b] } else { [a, b, c] });
        }
    }
    Some(out)
}

/// Returns true if `p` lies within the angle at corner `q`, with the inside to the left of its
/// edges (O'Rourke 1998, InCone).
fn is_within_corner(q: [f64; 2], before: [f64; 2], after: [f64; 2], p: [f64; 2]) -> bool {
    if area(q, after, before) >= 0.0 {
        area(q, p, before) > 0.0 && area(p, q, after) > 0.0
    } else {
        !(area(q, p, after) >= 0.0 && area(p, q, before) >= 0.0)
    }
}

/// Returns true if two segments share more than a common end.
fn segments_meet(p: [f64; 2], q: [f64; 2], a: [f64; 2], b: [f64; 2]) -> bool {
    if [a, b].iter().any(|end| *end == p || *end == q) {
        return false;
    }
    let [d1, d2, d3, d4] = [area(p, q, a), area(p, q, b), area(a, b, p), area(a, b, q)];
    if d1 * d2 > 0.0 || d3 * d4 > 0.0 {
        return false;
    }
    // If collinear, they meet if their boxes do.
    d1 != 0.0 || d2 != 0.0 || (0..2).all(|i| p[i].min(q[i]) <= a[i].max(b[i]) && a[i].min(b[i]) <= p[i].max(q[i]))
}

fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns twice the area vector of a ring.
fn newell(ring: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    // Relative to the first vertex, so that small rings keep their precision at large coordinates.
    let from_first = |p: &[f64; 3]| [p[0] - ring[0][0], p[1] - ring[0][1], p[2] - ring[0][2]];
    for pair in ring.windows(2) {
        let [a, b] = [from_first(&pair[0]), from_first(&pair[1])];
        for (axis, sum) in sum.iter_mut().enumerate() {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += a[u] * b[v] - a[v] * b[u];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(parts: &[Vec<[f64; 3]>], kinds: &[i32]) -> (Vec<Triangle>, usize) {
        triangles(parts, kinds)
    }

    fn total(triangles: &[Triangle]) -> [f64; 3] {
        triangles.iter().fold([0.0; 3], |sum, t| {
            let n = newell(&[t[0], t[1], t[2], t[0]]);
            [0, 1, 2].map(|i| sum[i] + n[i] / 2.0)
        })
    }

    fn square(from: f64, to: f64, z: f64) -> Vec<[f64; 3]> {
        vec![[from, from, z], [to, from, z], [to, to, z], [from, to, z], [from, from, z]]
    }

    #[test]
    fn strips_and_fans() {
        let corners = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]];
        let (strip, _) = run(&[corners], &[STRIP]);
        assert_eq!((strip.len(), total(&strip)), (2, [0., 0., 1.]));
        let mut around = square(0., 2., 0.);
        around.pop();
        let (fan, _) = run(&[around], &[FAN]);
        assert_eq!((fan.len(), total(&fan)), (2, [0., 0., 4.]));
    }

    #[test]
    fn rings_with_holes_keep_area_and_side() {
        for up in [true, false] {
            let mut outer = square(0., 10., 3.);
            if !up {
                outer.reverse();
            }
            let parts = [outer, square(1., 2., 3.), square(4., 5., 3.), square(1., 2., 3.)];
            let (filled, unfilled) = run(&parts[..3], &[OUTER, INNER, INNER]);
            assert_eq!(unfilled, 0);
            assert_eq!(total(&filled), [0., 0., if up { 98. } else { -98. }]);
            assert!(filled.iter().all(|t| (total(&[*t])[2] > 0.0) == up));
        }
    }

    #[test]
    fn a_vertical_ring_is_filled_in_its_own_plane() {
        // An L in the plane x = 7.
        let ell: Vec<_> = [[0., 0.], [3., 0.], [3., 1.], [1., 1.], [1., 3.], [0., 3.], [0., 0.]]
            .map(|[y, z]: [f64; 2]| [7., y, z])
            .to_vec();
        let (filled, _) = run(&[ell], &[FIRST]);
        assert_eq!((filled.len(), total(&filled)), (4, [5., 0., 0.]));
    }

    #[test]
    fn what_cannot_be_filled_is_counted() {
        let line = vec![[0., 0., 0.], [1., 1., 1.], [0., 0., 0.]];
        assert_eq!(run(&[line.clone(), line.clone()], &[OUTER, INNER]).1, 2);
        assert_eq!(run(&[line], &[9]).1, 1);
        assert_eq!(run(&[vec![[0.; 3]; MAX_RING + 1]], &[RING]).1, 1);
        assert_eq!(run(&[vec![[1.; 3]]], &[STRIP]).0, [] as [Triangle; 0]);
    }
}
