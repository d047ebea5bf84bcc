//! Sequences of insertions and removals: what remains is the triangulation of the remaining points;
//! for Delaunay, regular and constrained Delaunay, with every exact arithmetic, on tiny grids.
//!
//! The environment sets the number of sequences of each kind and arithmetic:
//!
//! ```text
//! BREAKLINE_SEQUENCES=50000 cargo test --release -p breakline-triangulation --test plane sequences
//! ```

use std::collections::BTreeSet;

use crate::chosen::{Chosen, plane, weighted};
use breakline_triangulation::geometry::Coordinates;
use breakline_triangulation::kernel::{
    Adaptive, Exact, Expansions, Fixed, Interval, Lattice, Wide,
};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    ConstrainedDelaunay, Delaunay, Level, LineId, Regular, RemovalError, Triangulation,
};
use testkit::random::Random;

fn sequences() -> u64 {
    std::env::var("BREAKLINE_SEQUENCES")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(150)
}

/// Once with each arithmetic.
fn with_each<G: Copy>(seed: u64, geometries: &[G], sequence: fn(&mut Random, G)) {
    for (k, &geometry) in (0..).zip(geometries) {
        let mut random = Random(seed + 100 * k);
        (0..sequences()).for_each(|_| sequence(&mut random, geometry));
    }
}

/// The dimension, the finite cells as sorted sites, and the sites of vertices.
type Shape = (i32, BTreeSet<Vec<[i64; 2]>>, BTreeSet<[i64; 2]>);

fn shape<G, V, C>(t: &Triangulation<G, 3, V, C>) -> Shape
where
    G: Coordinates<3>,
    C: Copy + Default,
{
    // Crossings included.
    let whole = |c: G::Coordinates| [0, 1].map(|k| (c.as_ref()[k] * 1e6) as i64);
    let seen = t
        .tds()
        .vertices()
        .map(|v| whole(t.geometry().coordinates(t.point(v))))
        .collect();
    (t.dimension(), testkit::cells::cells(t, whole), seen)
}

fn tiny<const D: usize>(random: &mut Random, side: u64) -> [f64; D] {
    std::array::from_fn(|_| random.below(side) as f64)
}

fn delaunay(random: &mut Random, geometry: Chosen<2>) {
    let side = 1 + random.below(5);
    let mut t: Delaunay<Chosen<2>, 3> = Delaunay::new(geometry);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for _ in 0..4 + random.index(16) {
        let p = tiny(random, side);
        let at = points.iter().position(|q| *q == p);
        let vertex = t.insert(p).unwrap();
        match at {
            Some(at) if random.below(4) > 0 => {
                points.swap_remove(at);
                assert_eq!(t.remove(vertex), Ok(p));
            }
            Some(_) => {}
            None => points.push(p),
        }
    }
    assert_eq!(t.check(Level::Law), []);
    let (fresh, _) = Delaunay::from_points(geometry, &points).unwrap();
    assert_eq!(shape(&t), shape(&fresh), "{points:?}");
}

fn regular(random: &mut Random, geometry: Chosen<3>) {
    let (side, weights) = (1 + random.below(5), 1 + random.below(12));
    let mut t: Regular<Chosen<3>, 3> = Regular::new(geometry);
    let mut points: Vec<([f64; 3], VertexId)> = Vec::new();
    for _ in 0..4 + random.index(16) {
        if points.is_empty() || random.below(5) > 1 {
            let [x, y, _]: [f64; 3] = tiny(random, side);
            let p = [x, y, random.below(weights) as f64];
            let vertex = t.insert(p).unwrap();
            let there = points.iter().find(|(q, _)| *q == p).map(|&(_, v)| v);
            assert!(there.is_none_or(|there| there == vertex));
            if there.is_none() {
                points.push((p, vertex));
            }
        } else {
            let (p, vertex) = points.swap_remove(random.index(points.len()));
            assert_eq!(t.remove(vertex), Ok(p));
        }
    }
    assert_eq!(t.check(Level::Law), []);
    let points: Vec<[f64; 3]> = points.into_iter().map(|(p, _)| p).collect();
    let (fresh, _) = Regular::<_, 3>::from_points(geometry, &points).unwrap();
    assert_eq!(shape(&t), shape(&fresh), "{points:?}");
    let hidden = |t: &Regular<Chosen<3>, 3>| {
        t.hidden()
            .map(|v| t.point(v).map(|x| x as i64))
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(hidden(&t), hidden(&fresh), "{points:?}");
}

fn constrained(random: &mut Random, geometry: Chosen<2>) {
    let side = 2 + random.below(4);
    let mut t: ConstrainedDelaunay<Chosen<2>> = ConstrainedDelaunay::new(geometry);
    let mut lines: Vec<(Vec<[f64; 2]>, LineId)> = Vec::new();
    // Vertices that were given as points.
    let mut points: BTreeSet<[u64; 2]> = BTreeSet::new();
    let mut history = Vec::new();
    let key = |p: [f64; 2]| p.map(f64::to_bits);
    for _ in 0..4 + random.index(10) {
        match random.below(6) {
            0 | 1 => {
                let p = tiny(random, side);
                history.push(format!("point {p:?}"));
                t.insert(p).unwrap();
                points.insert(key(p));
            }
            2 | 3 => {
                let line: Vec<[f64; 2]> = (0..2 + random.index(2))
                    .map(|_| tiny(random, side))
                    .collect();
                history.push(format!("line {line:?}"));
                let ids = t.insert_lines(&[&line]).unwrap();
                lines.push((line, ids[0]));
            }
            4 if !lines.is_empty() => {
                let (_, id) = lines.swap_remove(random.index(lines.len()));
                history.push(format!("no line {id:?}"));
                assert!(t.remove_line(id));
            }
            _ => {
                let vertices: Vec<VertexId> = t.tds().vertices().collect();
                let Some(&vertex) = vertices.get(random.index(vertices.len().max(1))) else {
                    continue;
                };
                let p = *t.point(vertex);
                history.push(format!("no point {p:?}"));
                let users: BTreeSet<LineId> = lines
                    .iter()
                    .filter(|(line, _)| line.contains(&p))
                    .map(|&(_, id)| id)
                    .collect();
                if random.below(3) == 0 && !t.is_added(vertex) {
                    let (gone, with) = t.remove_with_lines(vertex).unwrap();
                    assert_eq!((gone, with.into_iter().collect()), (p, users.clone()));
                    lines.retain(|(_, id)| !users.contains(id));
                    points.remove(&key(p));
                    continue;
                }
                match t.remove(vertex) {
                    Ok(gone) => {
                        assert!(gone == p && users.is_empty());
                        assert!(points.remove(&key(p)), "it was given as a point");
                    }
                    Err(RemovalError::Line(id)) => assert!(users.contains(&id)),
                    Err(RemovalError::Crossing) => assert!(!points.contains(&key(p))),
                    Err(_) => unreachable!(),
                }
            }
        }
    }
    assert_eq!(t.check(Level::Law), [], "{history:#?}");
    let mut fresh: ConstrainedDelaunay<Chosen<2>> = ConstrainedDelaunay::new(geometry);
    points
        .iter()
        .for_each(|p| _ = fresh.insert(p.map(f64::from_bits)).unwrap());
    let rest: Vec<&Vec<[f64; 2]>> = lines.iter().map(|(line, _)| line).collect();
    fresh.insert_lines(&rest).unwrap();
    assert_eq!(shape(&t), shape(&fresh), "{history:#?}");
    let constraints = |t: &ConstrainedDelaunay<Chosen<2>>| {
        let ends = |[a, b]: [VertexId; 2]| {
            let mut ends = [a, b].map(|v| t.point(v).map(f64::to_bits));
            ends.sort_unstable();
            ends
        };
        t.constrained_edges().map(ends).collect::<BTreeSet<_>>()
    };
    assert_eq!(constraints(&t), constraints(&fresh), "{history:#?}");
}

/// Every exact arithmetic.
macro_rules! each {
    ($geometry:ident) => {
        &[
            $geometry::<Adaptive>(),
            $geometry::<Exact>(),
            $geometry::<Expansions>(),
            $geometry::<Interval>(),
            $geometry::<Fixed>(),
            $geometry::<Lattice>(),
            $geometry::<Wide>(),
        ]
    };
}

#[test]
fn of_delaunay() {
    with_each(41, each!(plane), delaunay);
}

#[test]
fn of_regular() {
    with_each(42, each!(weighted), regular);
}

#[test]
fn of_constrained_delaunay() {
    with_each(43, each!(plane), constrained);
}
