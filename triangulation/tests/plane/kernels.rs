//! Every kind of triangulation of the plane with every kernel: changing one type gives the
//! triangles of exact arithmetic.

use std::collections::BTreeSet;

use crate::chosen::{Chosen, plane, weighted};
use breakline_triangulation::kernel::{
    Adaptive, Exact, Expansions, Fast, Fixed, Interval, Kernel, Lattice, Wide,
};
use breakline_triangulation::{
    ConstrainedDelaunay, Delaunay, Level, OnCrossing, Regular, Triangulation,
};
use testkit::random::Random;

type Cells = BTreeSet<Vec<Vec<i64>>>;

fn cells<G, const N: usize, V, C>(t: &Triangulation<G, N, V, C>) -> Cells
where
    G: breakline_triangulation::geometry::Coordinates<N>,
    C: Copy + Default,
{
    testkit::cells::cells(t, |p| p.as_ref().iter().map(|x| *x as i64).collect())
}

/// Returns points in space, and lines between them that may cross in plan, and then at points of
/// the grid.
struct Case {
    points: Vec<[f64; 3]>,
    lines: Vec<[u32; 2]>,
}

fn case(random: &mut Random) -> Case {
    let (count, side) = (3 + random.index(20), random.pick(&[2, 3, 6, 1 << 22]));
    let points: Vec<[f64; 3]> = (0..count)
        .map(|_| [(); 3].map(|()| random.around(side) as f64))
        .collect();
    let mut lines: Vec<[u32; 2]> = Vec::new();
    for _ in 0..random.index(6) {
        lines.push([(); 2].map(|()| random.index(count) as u32));
        let plan: Vec<[f64; 2]> = points.iter().map(|&[x, y, _]| [x, y]).collect();
        let plane = plane::<Exact>();
        if ConstrainedDelaunay::<_>::from_lines(plane, &plan, &lines, OnCrossing::Reject).is_err() {
            lines.pop();
        }
    }
    Case { points, lines }
}

/// The result of each kind for the case.
fn build<K: Kernel>(Case { points, lines }: &Case) -> [Cells; 3] {
    let plan: Vec<[f64; 2]> = points.iter().map(|&[x, y, _]| [x, y]).collect();
    let (in_bulk, _) = Delaunay::from_points(plane::<K>(), &plan).unwrap();
    let mut one_by_one = Delaunay::<_, 3>::new(plane::<K>());
    for &p in &plan {
        one_by_one.insert(p).unwrap();
    }
    let rule = OnCrossing::Reject;
    let (constrained, _) =
        ConstrainedDelaunay::<_>::from_lines(plane::<K>(), &plan, lines, rule).unwrap();
    assert_eq!(
        constrained.check(Level::Law),
        [],
        "{:?} {plan:?} {lines:?}",
        K::default()
    );
    [cells(&in_bulk), cells(&one_by_one), cells(&constrained)]
}

#[test]
fn one_answer() {
    let mut random = Random(1);
    for _ in 0..500 {
        let case = case(&mut random);
        let expected = build::<Exact>(&case);
        let found = [
            build::<Adaptive>(&case),
            build::<Expansions>(&case),
            build::<Interval>(&case),
            build::<Fixed>(&case),
            build::<Fixed<31>>(&case),
            build::<Lattice>(&case),
            build::<Wide>(&case),
        ];
        assert!(
            found.iter().all(|found| *found == expected),
            "{:?} {:?}",
            case.points,
            case.lines
        );
        // Without a guarantee, and right where nothing is rounded.
        if case.points.as_flattened().iter().all(|x| x.abs() < 100.0) {
            assert_eq!(build::<Fast>(&case), expected);
        }
    }
}

/// Points whose weights are their heights: the same points are hidden, and the others have the same
/// triangles.
#[test]
fn one_regular_triangulation() {
    fn build<K: Kernel>(points: &[[f64; 3]]) -> (Cells, Vec<usize>) {
        let mut t: Regular<Chosen<3>, 3> = Regular::new(weighted::<K>());
        for &p in points {
            t.insert(p).unwrap();
        }
        assert_eq!(t.check(Level::Law), [], "{:?} {points:?}", K::default());
        let mut hidden: Vec<usize> = t.hidden().map(|v| v.index()).collect();
        hidden.sort_unstable();
        (cells(&t), hidden)
    }
    let mut random = Random(3);
    let (mut triangles, mut hidden) = (0, 0);
    for _ in 0..400 {
        let Case { mut points, .. } = case(&mut random);
        if random.below(4) == 0 {
            points.iter_mut().for_each(|[x, y, _]| *y = *x);
        }
        let expected = build::<Exact>(&points);
        let found = [
            build::<Adaptive>(&points),
            build::<Expansions>(&points),
            build::<Interval>(&points),
            build::<Fixed>(&points),
            build::<Lattice>(&points),
            build::<Wide>(&points),
        ];
        assert!(found.iter().all(|found| *found == expected), "{points:?}");
        (triangles, hidden) = (triangles + expected.0.len(), hidden + expected.1.len());
    }
    assert!(triangles > 1000 && hidden > 500, "{triangles} {hidden}");
}

/// Where lines cross, each kernel has sites of its own: multiples of its step.
#[test]
fn crossings() {
    fn check<K: Kernel>(Case { points, .. }: &Case) -> usize {
        let plan: Vec<[f64; 2]> = points.iter().map(|&[x, y, _]| [x, y]).collect();
        let lines: Vec<[u32; 2]> = (0..points.len() as u32 / 2)
            .map(|i| [2 * i, 2 * i + 1])
            .collect();
        let rule = OnCrossing::Split;
        let (t, _) =
            ConstrainedDelaunay::<_>::from_lines(plane::<K>(), &plan, &lines, rule).unwrap();
        assert_eq!(t.check(Level::Law), [], "{:?} {points:?}", K::default());
        assert!(
            t.points()
                .iter()
                .all(|[x, y]| K::RANGE.admits(*x) && K::RANGE.admits(*y))
        );
        t.crossings().len()
    }
    let mut random = Random(2);
    let mut count = 0;
    for _ in 0..300 {
        let case = case(&mut random);
        count += check::<Exact>(&case)
            + check::<Interval>(&case)
            + check::<Fixed>(&case)
            + check::<Lattice>(&case);
    }
    assert!(count > 1000, "{count}");
}
