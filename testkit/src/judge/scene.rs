//! Coordinates as whole numbers.

use std::collections::HashSet;
use std::ops::{Add, Mul, Neg, Sub};

use dashu_int::IBig;

use super::Verdict;
use crate::case::{Case, Point};
use crate::subject::Built;

/// Whole numbers without rounding.
pub(crate) trait Number:
    Clone
    + Ord
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + From<i8>
{
    /// Returns `mantissa * 2^shift`; `None` if it is too large. `judge` multiplies two differences
    /// of such numbers and adds two of the products.
    fn shifted(mantissa: i64, shift: u32) -> Option<Self>;
}

impl Number for i128 {
    fn shifted(mantissa: i64, shift: u32) -> Option<i128> {
        let bits = 64 - mantissa.unsigned_abs().leading_zeros();
        (bits + shift <= 60).then(|| i128::from(mantissa) << shift)
    }
}

impl Number for IBig {
    fn shifted(mantissa: i64, shift: u32) -> Option<IBig> {
        Some(IBig::from(mantissa) << shift as usize)
    }
}

pub(crate) fn magnitude<N: Number>(x: N) -> N {
    if x < N::from(0) { -x } else { x }
}

/// Returns `x` as `mantissa * 2^exponent` with an odd mantissa, or `None` for zero.
fn parts(x: f64) -> Option<(i64, i32)> {
    let bits = x.to_bits();
    let (biased, fraction) = ((bits >> 52 & 0x7FF) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if biased == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, biased - 1075)
    };
    let zeros = mantissa.trailing_zeros();
    (mantissa != 0).then(|| {
        (
            (mantissa >> zeros) * if x < 0.0 { -1 } else { 1 },
            exponent + zeros as i32,
        )
    })
}

/// Returns the unit in the last place of the largest magnitude on each axis among the points of
/// lines, and whether all points are multiples of it. (Of the other points, only those on lines
/// would matter.)
fn grid(case: &Case) -> ([f64; 2], bool) {
    let drawn = || {
        case.lines
            .iter()
            .flatten()
            .map(|&i| case.points[i as usize])
    };
    let unit = [0, 1].map(|axis| {
        let largest = drawn().map(|p| p[axis].abs()).fold(0.0, f64::max);
        if largest == f64::MAX {
            largest - largest.next_down()
        } else {
            largest.next_up() - largest
        }
    });
    let is_multiple =
        |x: f64, unit: f64| parts(x).is_none_or(|(_, low)| low >= parts(unit).unwrap().1);
    (
        unit,
        case.points
            .iter()
            .all(|p| is_multiple(p[0], unit[0]) && is_multiple(p[1], unit[1])),
    )
}

/// Checks that the program's grid is no coarser than this one, and that it knows if all points are
/// on it.
pub(crate) fn judge_grid(case: &Case, built: &Built) -> Verdict {
    let Some(rounding) = built.rounding else {
        return Ok(());
    };
    let (unit, on_grid) = grid(case);
    let is_coarser = (0..2).any(|axis| rounding.unit[axis] > unit[axis]);
    if is_coarser || (on_grid && !rounding.on_grid) {
        return Err(format!("grid: {rounding:?}; should be {unit:?}, {on_grid}"));
    }
    Ok(())
}

/// A triangulation and its input on a grid so fine that all coordinates are whole numbers. Each
/// axis has its own grid.
pub(crate) struct Scene<'a, N> {
    pub(crate) case: &'a Case,
    /// The sites of the triangulation's vertices.
    pub(crate) sites: Vec<[N; 2]>,
    /// The vertex of each input point.
    pub(crate) vertices: Vec<usize>,
    pub(crate) chains: Vec<Vec<usize>>,
    /// True if there are no triangles.
    pub(crate) is_collinear: bool,
    /// The constrained edges, the smaller vertex first.
    pub(crate) constrained: HashSet<[usize; 2]>,
    /// How far from the given segment a vertex of its chain may lie, on each axis.
    pub(crate) bound: [N; 2],
    /// How far the chain may go back, on each axis.
    pub(crate) back: [N; 2],
}

/// Where points of lines are not on the grid to which crossings are rounded, a chain may be off by
/// this many halves of its unit.
const HALVES_OFF_GRID: i8 = 4;

impl<'a, N: Number> Scene<'a, N> {
    /// Returns `None` if the number type cannot hold the coordinates.
    pub(crate) fn new(case: &'a Case, built: &Built) -> Option<Self> {
        let t = &built.triangulation;
        let unit = |axis: usize| {
            built
                .rounding
                .and_then(|rounding| parts(rounding.unit[axis]))
        };
        let half = [0, 1].map(|axis| unit(axis).map_or(-1074, |(_, exponent)| exponent) - 1);
        let lowest = [0, 1].map(|axis| {
            let exponents = t
                .points()
                .iter()
                .filter_map(|p| parts(p[axis]))
                .map(|(_, exponent)| exponent);
            let coarsest = if built.rounding.is_some() {
                half[axis]
            } else {
                i32::MAX
            };
            exponents.fold(coarsest, i32::min)
        });
        let whole = |x: f64, axis: usize| {
            let (mantissa, exponent) = parts(x).unwrap_or((0, lowest[axis]));
            N::shifted(mantissa, exponent.abs_diff(lowest[axis]))
        };
        let site = |&[x, y]: &Point| Some([whole(x, 0)?, whole(y, 1)?]);
        let zero = [N::from(0), N::from(0)];
        let (bound, back) = match built.rounding {
            // A line that crosses nothing is not moved.
            None => (zero.clone(), zero),
            Some(rounding) => {
                let half = [0, 1].map(|axis| N::shifted(1, half[axis].abs_diff(lowest[axis])));
                let [Some(x), Some(y)] = half else {
                    return None;
                };
                let halves = if rounding.on_grid { 1 } else { HALVES_OFF_GRID };
                let bound = [x, y].map(|half| half * N::from(halves));
                (bound.clone(), if rounding.on_grid { zero } else { bound })
            }
        };
        Some(Scene {
            case,
            sites: t.points().iter().map(site).collect::<Option<_>>()?,
            vertices: built.vertices.iter().map(|v| v.index()).collect(),
            chains: built
                .chains
                .iter()
                .map(|chain| chain.iter().map(|v| v.index()).collect())
                .collect(),
            is_collinear: t.dimension() < 2,
            constrained: t
                .constrained_edges()
                .map(|[a, b]| [a.index(), b.index()])
                .collect(),
            bound,
            back,
        })
    }

    pub(crate) fn difference(&self, a: usize, b: usize) -> [N; 2] {
        [0, 1].map(|axis| self.sites[b][axis].clone() - self.sites[a][axis].clone())
    }

    /// Returns twice the area of a triangle, positive if counter-clockwise.
    pub(crate) fn turn(&self, a: usize, b: usize, c: usize) -> N {
        cross(self.difference(a, b), self.difference(a, c))
    }

    /// Returns true if the vertex lies between the two on both axes, or outside by at most the
    /// bound.
    pub(crate) fn is_within(&self, v: usize, [a, b]: [usize; 2], bound: &[N; 2]) -> bool {
        (0..2).all(|axis| {
            let [p, a, b] = [v, a, b].map(|v| &self.sites[v][axis]);
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            low.clone() - bound[axis].clone() <= *p && *p <= high.clone() + bound[axis].clone()
        })
    }

    /// Returns a readable name of a vertex and its position.
    pub(crate) fn name(&self, built: usize) -> String {
        match self.vertices.iter().position(|&v| v == built) {
            Some(point) => format!("point {point} {:?}", self.case.points[point]),
            None => format!("added vertex {built}"),
        }
    }
}

pub(crate) fn cross<N: Number>([ax, ay]: [N; 2], [bx, by]: [N; 2]) -> N {
    ax * by - ay * bx
}
