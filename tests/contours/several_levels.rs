//! Contours of several levels against a judge that compares all arcs, without rounding.

use super::{bits, draw};
use breakline::data::ContourLine;
use breakline::terrain::{Tin, TinBuilder};
use dashu_ratio::RBig;
use testkit::random::{Random, ulps};

fn tin(points: &[[f64; 3]]) -> Tin {
    let mut builder = TinBuilder::default();
    let column = |axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<f64>>();
    builder.add_points(&column(0), &column(1), &column(2));
    builder.build().unwrap()
}

/// Returns the side of the line from `a` to `b` that `c` lies on.
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i32 {
    let [a, b, c] = [a, b, c].map(|p| p.map(|x| RBig::try_from(x).unwrap()));
    let left = (&b[0] - &a[0]) * (&c[1] - &a[1]);
    let right = (&b[1] - &a[1]) * (&c[0] - &a[0]);
    left.cmp(&right) as i32
}

/// Returns true if two segments cross in their interiors.
fn cross([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let is_apart = |axis: usize| {
        let [a, b, c, d] = [a, b, c, d].map(|p| p[axis]);
        a.max(b) < c.min(d) || c.max(d) < a.min(b)
    };
    !is_apart(0)
        && !is_apart(1)
        && side(a, b, c) * side(a, b, d) < 0
        && side(c, d, a) * side(c, d, b) < 0
}

/// Returns the number of pairs of arcs that cross.
fn crossings(lines: &[ContourLine]) -> usize {
    let sorted = |a: [f64; 2], b: [f64; 2]| if a <= b { [a, b] } else { [b, a] };
    let mut arcs: Vec<[[f64; 2]; 2]> = lines
        .iter()
        .flat_map(|line| line.points.windows(2).map(|p| sorted(p[0], p[1])))
        .collect();
    arcs.sort_by(|p, q| p.partial_cmp(q).unwrap());
    arcs.dedup();
    let mut count = 0;
    for (i, &arc) in arcs.iter().enumerate() {
        count += arcs[..i].iter().filter(|&&other| cross(arc, other)).count();
    }
    count
}

const OFFSETS: [f64; 5] = [0.25, 1.0, 1e3, 5e6, 1e9];

/// Points within some steps of an `f64` of a line or of each other, some of them beside ordinary
/// ones.
fn narrow_points(random: &mut Random, round: usize) -> Vec<[f64; 3]> {
    let offset = OFFSETS[random.index(5)];
    let length = [1.0, 100.0, 1e5][random.index(3)];
    let count = [4, 6, 10][random.index(3)];
    let whole_heights = random.below(2) == 0;
    let mut steps = |x: f64, many: i64| ulps(x, random.around(many));
    let mut sites: Vec<[f64; 2]> = Vec::new();
    for i in 0..count {
        let along = length * ((i * 37 + round) % 101) as f64 / 101.0;
        sites.push(match round % 6 {
            0 => [offset + along, steps(offset + 1.0, 2)],
            1 => [steps(offset + 1.0, 4), steps(offset + 1.0, 4)],
            2 => [offset + along, steps(offset + along / 3.0, 2)],
            3 => {
                let end = if i % 2 == 0 { 0.0 } else { length };
                [steps(offset + end, 2), steps(offset + 0.37 * end, 2)]
            }
            4 if i == 0 => [offset, offset + 0.3],
            4 => [offset + length, steps(offset + 0.7 * length, 6)],
            _ if i % 2 == 0 => [offset + along, steps(offset + 0.5 * length, 1)],
            _ => [
                offset + along,
                offset + length * ((i * 53) % 101) as f64 / 101.0,
            ],
        });
    }
    sites
        .into_iter()
        .map(|[x, y]| {
            let z = 10.0 * random.unit() - 5.0;
            [x, y, if whole_heights { z.round() } else { z }]
        })
        .collect()
}

fn levels(random: &mut Random) -> Vec<f64> {
    let mut levels: Vec<f64> = (-4..5).map(f64::from).collect();
    levels.extend((0..4).map(|_| 10.0 * random.unit() - 5.0));
    let first = 8.0 * random.unit() - 4.0;
    let close = random.below(2) * 6;
    levels.extend((0..close as i64).map(|i| ulps(first, i)));
    levels
}

#[test]
fn arcs_of_several_levels_do_not_cross() {
    let mut random = Random(18);
    for round in 0..120 {
        let points = narrow_points(&mut random, round);
        let lines = draw(&tin(&points), &levels(&mut random));
        assert_eq!(crossings(&lines), 0, "round {round}: {points:?}");
    }
}

/// An ordinary triangle beside a narrow one, whose arcs do not cross: each level is as it is alone.
#[test]
fn arcs_that_cross_nothing_stay() {
    let y = 1.0 + f64::EPSILON;
    let points = [
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 4.0],
        [0.5, y, 2.0],
        [0.5, 9.0, 8.0],
    ];
    let tin = tin(&points);
    let levels = [0.5, 1.5, 2.5, 3.5];
    let alone: Vec<ContourLine> = levels
        .iter()
        .flat_map(|&level| draw(&tin, &[level]))
        .collect();
    assert_eq!(bits(&draw(&tin, &levels)), bits(&alone));
}
