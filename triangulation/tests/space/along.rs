//! What a segment meets, against exact arithmetic over all simplices, on small grids where it runs
//! through vertices, along edges and within facets.

use std::cell::Cell;
use std::cmp::Ordering;

use breakline_triangulation::geometry::{Geometry, Space, WeightedSpace};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    Basic, Delaunay, Locate, Regular, SpacePassage, StraightLine, Triangulation,
};
use testkit::random::Random;

use crate::TINY;

type Whole = [i128; 3];

/// The points of a simplex in units of half a step of the grid.
fn determinant(rows: [Whole; 3]) -> i128 {
    let [a, b, c] = rows;
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1)
}

fn volume([a, b, c, d]: [Whole; 4]) -> i128 {
    determinant([b, c, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k])))
}

/// A fraction with a positive denominator.
#[derive(Debug, Clone, Copy)]
struct Fraction(i128, i128);

impl Fraction {
    fn new(numerator: i128, denominator: i128) -> Self {
        Fraction(numerator * denominator.signum(), denominator.abs())
    }

    fn order(self, other: Self) -> Ordering {
        (self.0 * other.1).cmp(&(other.0 * self.1))
    }
}

/// Returns from where to where the segment is in the relative interior of a simplex, as fractions
/// of its length. `None` if it does not meet that.
fn stay(simplex: &[Whole], [a, b]: [Whole; 2]) -> Option<[Fraction; 2]> {
    // Complete to a tetrahedron; coordinates of the corners that are added have to be zero.
    let origin = simplex[0];
    let axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let shifted = |by: Whole| [0, 1, 2].map(|k| origin[k] + by[k]);
    let mut full = None;
    for mask in 0..8 {
        let added = (0..3)
            .filter(|k| mask >> k & 1 == 1)
            .map(|k| shifted(axes[k]));
        let corners: Vec<Whole> = simplex.iter().copied().chain(added).collect();
        if let Ok(corners) = <[Whole; 4]>::try_from(corners)
            && volume(corners) != 0
        {
            full = Some(corners);
        }
    }
    let corners = full.expect("a simplex that is not flat");
    let sign = volume(corners).signum();
    let (mut from, mut to) = ((Fraction(0, 1), false), (Fraction(1, 1), false));
    for i in 0..4 {
        let at = |p: Whole| {
            let mut replaced = corners;
            replaced[i] = p;
            volume(replaced) * sign
        };
        // The coordinate is `p + t q`.
        let (p, q) = (at(a), at(b) - at(a));
        let must_be_zero = i >= simplex.len();
        if q == 0 {
            if must_be_zero != (p == 0) || p < 0 {
                return None;
            }
            continue;
        }
        let root = Fraction::new(-p, q);
        if must_be_zero || q > 0 {
            match root.order(from.0) {
                Ordering::Greater => from = (root, !must_be_zero),
                Ordering::Equal => from.1 |= !must_be_zero,
                Ordering::Less if must_be_zero => return None,
                Ordering::Less => {}
            }
        }
        if must_be_zero || q < 0 {
            match root.order(to.0) {
                Ordering::Less => to = (root, !must_be_zero),
                Ordering::Equal => to.1 |= !must_be_zero,
                Ordering::Greater if must_be_zero => return None,
                Ordering::Greater => {}
            }
        }
    }
    let is_met = match from.0.order(to.0) {
        Ordering::Less => true,
        Ordering::Equal => !from.1 && !to.1,
        Ordering::Greater => false,
    };
    is_met.then_some([from.0, to.0])
}

/// Returns the vertices of a passage, sorted, and true if it is an interval rather than one point.
fn spanned<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    passage: SpacePassage,
) -> (Vec<VertexId>, bool) {
    let without = |cell, i: usize| -> Vec<VertexId> {
        let corners = t.tds().cell_vertices(cell).iter().enumerate();
        corners.filter(|&(k, _)| k != i).map(|(_, &v)| v).collect()
    };
    let (mut vertices, is_long) = match passage {
        SpacePassage::Cell(cell) => (without(cell, 4), true),
        SpacePassage::Facet(cell, i) => (without(cell, i), false),
        SpacePassage::WithinFacet(cell, i) => (without(cell, i), true),
        SpacePassage::Edge(edge) => (t.tds().edge_ends(edge).to_vec(), false),
        SpacePassage::Along(ends) => (ends.to_vec(), true),
        SpacePassage::Vertex(vertex) => (vec![vertex], false),
    };
    vertices.sort_unstable();
    (vertices, is_long)
}

/// All finite vertices, edges, triangles and tetrahedra.
fn simplices<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
) -> Vec<Vec<VertexId>> {
    let mut all: Vec<Vec<VertexId>> = t.tds().vertices().map(|v| vec![v]).collect();
    all.extend(
        t.tds()
            .finite_edges()
            .map(|edge| spanned(t, SpacePassage::Edge(edge)).0),
    );
    match t.dimension() {
        3 => {
            all.extend(
                t.tds()
                    .finite_facets()
                    .map(|(cell, i)| spanned(t, SpacePassage::Facet(cell, i)).0),
            );
            all.extend(
                t.finite_cells()
                    .map(|cell| spanned(t, SpacePassage::Cell(cell)).0),
            );
        }
        2 => all.extend(
            t.finite_cells()
                .map(|cell| spanned(t, SpacePassage::Facet(cell, 3)).0),
        ),
        _ => {}
    }
    all
}

/// Compares what segments meet with a search through all simplices; adds up the kinds of passages.
fn judge<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    whole: impl Fn(&G::Point) -> Whole,
    segments: &[[G::Point; 2]],
    kinds: &mut [usize; 6],
) {
    let all = simplices(t);
    let sites: Vec<Whole> = t.points().iter().map(&whole).collect();
    for segment @ [a, b] in segments {
        let ends = [whole(a), whole(b)];
        let stay_of = |vertices: &Vec<VertexId>| {
            stay(
                &vertices
                    .iter()
                    .map(|v| sites[v.index()])
                    .collect::<Vec<_>>(),
                ends,
            )
            .map(|stay| (stay, vertices.clone()))
        };
        let mut expected: Vec<_> = all.iter().filter_map(stay_of).collect();
        let middle =
            |[from, to]: [Fraction; 2]| Fraction(from.0 * to.1 + to.0 * from.1, from.1 * to.1);
        expected.sort_by(|(s, _), (t, _)| middle(*s).order(middle(*t)));
        let is_long = |[from, to]: [Fraction; 2]| from.order(to).is_lt() && ends[0] != ends[1];
        let expected: Vec<(Vec<VertexId>, bool)> = expected
            .into_iter()
            .map(|(stay, vertices)| (vertices, is_long(stay)))
            .collect();
        let near = t.tds().cells().nth(segments.len() % 3);
        let met: Vec<SpacePassage> = t.along(segment.each_ref(), near).collect();
        let mut found: Vec<(Vec<VertexId>, bool)> =
            met.iter().map(|&passage| spanned(t, passage)).collect();
        if let ([(vertices, is_long)], true) = (&mut found[..], ends[0] == ends[1]) {
            *is_long &= vertices.len() < 4;
        }
        assert_eq!(found, expected, "{segment:?} in {:?}", t.points());
        for passage in met {
            kinds[match passage {
                SpacePassage::Cell(_) => 0,
                SpacePassage::Facet(cell, i) => {
                    let is_full = t.dimension() == 3 && !t.tds().is_infinite(cell);
                    if let Some(corners) = is_full.then(|| t.cell_points(cell)).flatten() {
                        let side = |p| {
                            let mut replaced = corners;
                            replaced[i] = p;
                            t.geometry().orientation(replaced)
                        };
                        assert!(
                            side(a) != Sign::Negative && side(b) != Sign::Positive,
                            "out of the cell"
                        );
                    }
                    1
                }
                SpacePassage::WithinFacet(..) => 2,
                SpacePassage::Edge(_) => 3,
                SpacePassage::Along([from, to]) => {
                    let order = t.geometry().compare(t.point(from), t.point(to));
                    assert_eq!(order, t.geometry().compare(a, b), "toward the end");
                    4
                }
                SpacePassage::Vertex(_) => 5,
            }] += 1;
        }
    }
}

/// A site in half steps, in a grid, a slanted plane, or on a slanted line.
fn site(random: &mut Random, round: usize, steps: i64) -> [i64; 3] {
    let sizes = [
        [2, 2, 2],
        [3, 3, 3],
        [4, 2, 1],
        [4, 3, 0],
        [3, 0, 0],
        [1, 1, 1],
    ][round % 6];
    let [x, y, z] = sizes.map(|size| {
        let margin = i64::from(steps == 1);
        random.below(((size + 2 * margin) * (2 / steps) + 1) as u64) as i64 * steps - 2 * margin
    });
    match round / 6 % 3 {
        0 => [x, y, z],
        1 => [x + y, y - x, z - y],
        _ => [z, x - z, 2 * x + y],
    }
}

#[test]
fn segments_meet_what_they_meet_in_order() {
    let mut random = Random(61);
    let mut kinds = [[0; 6]; 4];
    for round in 0..1500 {
        // The arithmetic of `Wide` is exact at any scale.
        let scale = [1.0, TINY, 2f64.powi(1010)][round % 7 % 3];
        let point = |site: [i64; 3]| site.map(|x| x as f64 * 0.5 * scale);
        let whole = |p: &[f64; 3]| p.map(|x| (x / scale * 2.0) as i128);
        let count = if round % 11 == 0 { 1 } else { random.index(16) };
        let points: Vec<[f64; 3]> = (0..count)
            .map(|_| point(site(&mut random, round, 2)))
            .collect();
        // Where the points are flat, most segments are in their plane or on their line.
        let segments: Vec<[[f64; 3]; 2]> = (0..12)
            .map(|k| {
                let mut kind = if k < 8 { round } else { round / 6 * 6 + k % 3 };
                if k == 11 {
                    kind = round / 18 * 18 + 13;
                }
                let mut end = || point(site(&mut random, kind, 1));
                let a = end();
                [a, if k == 3 { a } else { end() }]
            })
            .collect();
        let space = Space::<Wide>::default();
        let of_dimension = |t: &Triangulation<_, 4>| t.dimension().max(0) as usize;
        match round % 5 {
            0 => {
                let (t, _) = Basic::<_, 4>::from_points(space, &points).unwrap();
                judge(&t, whole, &segments, &mut kinds[of_dimension(&t)]);
            }
            _ => {
                let (t, _) = Delaunay::<_, 4>::from_points(space, &points).unwrap();
                judge(&t, whole, &segments, &mut kinds[of_dimension(&t)]);
            }
        }
    }
    // Tetrahedra in dimension 3 only; a facet is crossed from dimension 2 on.
    for (dimension, kinds) in kinds.iter().enumerate() {
        let possible = [
            dimension > 2,
            dimension > 1,
            dimension > 1,
            dimension > 0,
            dimension > 0,
            true,
        ];
        assert!(
            (0..6).all(|k| if possible[k] {
                kinds[k] > 5
            } else {
                kinds[k] == 0
            }),
            "{dimension}: {kinds:?}"
        );
    }
}

#[test]
fn in_a_regular_triangulation() {
    let mut random = Random(62);
    for round in 0..100 {
        let weighted =
            |[x, y, z]: [i64; 3], weight: u64| [x as f64, y as f64, z as f64, weight as f64];
        let mut draw = |steps| weighted(site(&mut random, round, steps), random.below(4));
        let points: Vec<[f64; 4]> = (0..14).map(|_| draw(2)).collect();
        let (t, _) = Regular::<_, 4>::from_points(<WeightedSpace>::new(), &points).unwrap();
        let segments: Vec<[[f64; 4]; 2]> = (0..6).map(|_| [draw(1), draw(1)]).collect();
        judge(
            &t,
            |p| [p[0], p[1], p[2]].map(|x| x as i128),
            &segments,
            &mut [0; 6],
        );
    }
}

/// The number of vertices, edges in one point and along, facets in one point and within, and cells.
fn counts(t: &Delaunay<Space, 4>, a: [f64; 3], b: [f64; 3]) -> [usize; 6] {
    let mut counts = [0; 6];
    for passage in t.along([&a, &b], None) {
        counts[match passage {
            SpacePassage::Vertex(_) => 0,
            SpacePassage::Edge(_) => 1,
            SpacePassage::Along(_) => 2,
            SpacePassage::Facet(..) => 3,
            SpacePassage::WithinFacet(..) => 4,
            SpacePassage::Cell(_) => 5,
        }] += 1;
    }
    counts
}

/// The queries of CGAL's test of its simplex traverser that do not depend on ties.
#[test]
fn two_tetrahedra_in_a_box() {
    let inner = [
        [-2.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 1.0, -1.0],
        [0.0, -1.0, -1.0],
        [0.0, 0.0, 1.0],
    ];
    let corners = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|side| f64::from(20 * side - 10)));
    let points: Vec<[f64; 3]> = inner.into_iter().chain(corners).collect();
    let (t, v) = Delaunay::from_points(Space::new(), &points).unwrap();
    assert!(
        [0, 1]
            .iter()
            .all(|&k| t.tds().cell_with(&[v[k], v[2], v[3], v[4]]).is_some())
    );
    let on_axis = |a: f64, b: f64| counts(&t, [a, 0.0, 0.0], [b, 0.0, 0.0]);
    assert_eq!(on_axis(-1.0, 1.0), [0, 0, 0, 1, 0, 2]);
    assert_eq!(on_axis(-1.0, 2.0), [1, 0, 0, 1, 0, 2]);
    assert_eq!(on_axis(2.0, -1.0), [1, 0, 0, 1, 0, 2]);
    assert_eq!(on_axis(-2.0, 2.0), [2, 0, 0, 1, 0, 2]);
    assert_eq!(on_axis(2.0, -2.0), [2, 0, 0, 1, 0, 2]);
    // Along an edge from its one end to the other.
    assert_eq!(counts(&t, points[0], points[2]), [2, 0, 1, 0, 0, 0]);
}

/// Through vertices, edges and facets of a 5 x 5 x 5 grid, whatever the diagonals are.
#[test]
fn walks_across_a_lattice() {
    let points: Vec<[f64; 3]> = (0..125)
        .map(|k| [k / 25, k / 5 % 5, k % 5].map(f64::from))
        .collect();
    let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
    for axis in 0..3 {
        let turned = |[x, y, z]: [f64; 3]| {
            let mut p = [x, y, z];
            p.rotate_right(axis);
            p
        };
        let across = |y: f64, z: f64| {
            let [a, b] = [[-1.0, y, z], [6.0, y, z]].map(turned);
            let (there, back) = (counts(&t, a, b), counts(&t, b, a));
            assert_eq!(there, back);
            there
        };
        assert_eq!(across(2.0, 2.0), [5, 0, 4, 0, 0, 0]);
        assert_eq!(
            across(0.0, 4.0),
            [5, 0, 4, 0, 0, 0],
            "along an edge of the hull"
        );
        // The square in each plane has a diagonal.
        assert_eq!(across(2.0, 2.5), [0, 9, 0, 0, 8, 0]);
        assert_eq!(
            across(4.0, 0.25),
            [0, 9, 0, 0, 8, 0],
            "in a face of the hull"
        );
        let [vertices, edges, along, facets, within, cells] = across(2.25, 2.625);
        assert_eq!(
            [vertices, edges, along, within, facets],
            [0, 0, 0, 0, cells + 1]
        );
        assert!(
            (12..=24).contains(&cells),
            "three to six cells in a cube: {cells}"
        );
        assert_eq!(across(4.25, 2.0), [0; 6]);
        assert_eq!(
            counts(&t, turned([-1.0, 2.0, 2.0]), turned([2.0, 2.0, 2.0])),
            [3, 0, 2, 0, 0, 0]
        );
    }
    // Through five vertices, and at least one passage between two of them.
    let [vertices, _, along, _, within, cells] = counts(&t, [-1.0; 3], [5.0; 3]);
    assert!(vertices == 5 && along + within + cells >= 4);
    let all: Vec<[[f64; 3]; 2]> = (0..40)
        .map(|k| {
            let mut random = Random(k);
            [0; 2].map(|_| [0; 3].map(|_| random.below(13) as f64 / 2.0 - 1.0))
        })
        .collect();
    judge(&t, |p| p.map(|x| (x * 2.0) as i128), &all, &mut [0; 6]);
}

#[test]
fn nothing_is_met_by_what_is_not_a_segment() {
    let mut t = Delaunay::<Space, 4>::new(Space::new());
    let (origin, nan) = ([0.0; 3], [f64::NAN, 0.0, 0.0]);
    assert_eq!(t.along([&origin, &[1.0; 3]], None).count(), 0);
    for p in [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]] {
        t.insert(p).unwrap();
        assert_eq!(
            t.along([&origin, &nan], None).count() + t.along([&nan, &origin], None).count(),
            0
        );
        assert_eq!(t.along([&[f64::INFINITY; 3], &nan], None).count(), 0);
        assert_eq!(t.along([&origin, &origin], None).count(), 1);
    }
}

/// Space with signs that are wrong now and then, as those of a kernel without guarantee are.
#[derive(Debug, Clone, Copy, Default)]
struct Erring(Space);

thread_local!(static SEED: Cell<Option<u64>> = const { Cell::new(None) });

/// Returns the sign, or any other every fourth time while there is a seed.
fn erring(sign: Sign) -> Sign {
    let Some(mut random) = SEED.get().map(Random) else {
        return sign;
    };
    let any = random.pick(&[Sign::Negative, Sign::Zero, Sign::Positive]);
    let drawn = random.pick(&[sign, sign, sign, any]);
    SEED.set(Some(random.0));
    drawn
}

impl Geometry<4> for Erring {
    type Point = [f64; 3];

    fn admits(&self, p: &[f64; 3]) -> bool {
        self.0.admits(p)
    }

    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        self.0.compare(p, q)
    }

    fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
        erring(self.0.orientation(simplex))
    }

    fn side_of_sphere(&self, simplex: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
        self.0.side_of_sphere(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
        erring(self.0.orientation_in_flat(simplex))
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        self.0.side_of_sphere_in_flat(simplex, q)
    }
}

/// Whatever the predicates return, a walk ends, and nothing panics.
#[test]
fn walks_end_with_wrong_signs() {
    let mut random = Random(63);
    let mut longest = 0;
    for round in 0..300 {
        SEED.set(None);
        let mut t = Delaunay::<_, 4>::new(Erring::default());
        for _ in 0..30 {
            t.insert(site(&mut random, round, 2).map(|x| x as f64))
                .unwrap();
        }
        SEED.set(Some(round as u64));
        for _ in 0..20 {
            let [a, b] = [0; 2].map(|_| site(&mut random, round, 1).map(|x| x as f64));
            let count = t.along([&a, &b], None).count();
            assert!(count <= 15 * t.tds().cell_slots());
            longest = longest.max(count);
            StraightLine(t.tds().vertices().next()).locate(&t, &b);
        }
    }
    assert!(longest > 10, "{longest}");
}
