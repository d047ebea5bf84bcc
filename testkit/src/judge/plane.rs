//! Checks that the triangles tile the convex hull, and that no vertex lies in the circle of a
//! triangle that it sees.

use std::collections::HashMap;

use dashu_ratio::RBig;

use super::Verdict;
use crate::subject::Built;

type Site = [RBig; 2];

fn turn([ax, ay]: &Site, [bx, by]: &Site, [cx, cy]: &Site) -> RBig {
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// Returns a positive number if `q` lies inside the circle through a counter-clockwise triangle.
fn in_circle(triangle: [&Site; 3], q: &Site) -> RBig {
    let [a, b, c] = triangle.map(|p| {
        let [x, y] = [&p[0] - &q[0], &p[1] - &q[1]];
        let lift = &x * &x + &y * &y;
        [x, y, lift]
    });
    let minor = |u: &[RBig; 3], v: &[RBig; 3]| &u[0] * &v[1] - &u[1] * &v[0];
    minor(&b, &c) * &a[2] - minor(&a, &c) * &b[2] + minor(&a, &b) * &c[2]
}

/// Returns twice the area of the hull, by Andrew's chains (1979).
fn hull_area(sites: &[Site]) -> RBig {
    let mut sorted: Vec<&Site> = sites.iter().collect();
    sorted.sort();
    let mut area = RBig::ZERO;
    for _ in 0..2 {
        let mut chain: Vec<&Site> = Vec::new();
        for p in &sorted {
            while chain.len() > 1
                && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= RBig::ZERO
            {
                chain.pop();
            }
            chain.push(p);
        }
        area += chain
            .windows(2)
            .map(|s| &s[0][0] * &s[1][1] - &s[0][1] * &s[1][0])
            .fold(RBig::ZERO, |a, b| a + b);
        sorted.reverse();
    }
    area
}

pub(crate) fn judge(built: &Built) -> Verdict {
    let t = &built.triangulation;
    if t.dimension() < 2 {
        return Ok(());
    }
    let sites: Vec<Site> = t
        .points()
        .iter()
        .map(|p| p.map(|x| RBig::try_from(x).expect("coordinates are finite")))
        .collect();
    let mut opposite: HashMap<[usize; 2], usize> = HashMap::new();
    let mut area = RBig::ZERO;
    for cell in t.finite_cells() {
        let [a, b, c] = *t.tds().corners(cell);
        let [a, b, c] = [a.index(), b.index(), c.index()];
        let size = turn(&sites[a], &sites[b], &sites[c]);
        if size <= RBig::ZERO {
            return Err(format!("triangle {a} {b} {c} is not counter-clockwise"));
        }
        area += size;
        for (from, to, far) in [(a, b, c), (b, c, a), (c, a, b)] {
            if opposite.insert([from, to], far).is_some() {
                return Err(format!("two triangles on one side of the edge {from} {to}"));
            }
        }
    }
    if area != hull_area(&sites) {
        return Err("the triangles do not tile the hull".to_owned());
    }
    for [a, b] in t.constrained_edges().map(|edge| edge.map(|v| v.index())) {
        if !opposite.contains_key(&[a, b]) && !opposite.contains_key(&[b, a]) {
            return Err(format!("constrained edge {a} {b} is not an edge"));
        }
    }
    let constrained: std::collections::HashSet<[usize; 2]> = t
        .constrained_edges()
        .map(|edge| edge.map(|v| v.index()))
        .collect();
    for (&[a, b], &c) in opposite
        .iter()
        .filter(|([a, b], _)| a < b && !constrained.contains(&[*a, *b]))
    {
        let Some(&d) = opposite.get(&[b, a]) else {
            continue;
        };
        if in_circle([a, b, c].map(|v| &sites[v]), &sites[d]) > RBig::ZERO {
            return Err(format!("vertex {d} lies in the circle of {a} {b} {c}"));
        }
    }
    Ok(())
}
