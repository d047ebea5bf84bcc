//! What the cells of Voronoi and power diagrams have of a box: drawn where decisions are close, and
//! judged by exact volumes, in the plane (`D` is 2) and in space (3).

use std::rc::Rc;

use dashu_ratio::RBig;

use super::random::{Random, ulps};

/// Sites with weights, all different.
pub type Sites<const D: usize> = Vec<([f64; D], f64)>;

/// Returns how many boxes are drawn.
pub fn count() -> usize {
    std::env::var("BREAKLINE_BOXES")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(120)
}

/// Returns sites on grids, of whole numbers and of others, near them, on lines and planes, or
/// anywhere. Weights move the borders of cells to other lattices, or through one point.
pub fn sites<const D: usize>(random: &mut Random, round: usize, is_weighted: bool) -> Sites<D> {
    let spacing = [1.0, 0.1, 0.1, 1.0, 0.1, 0.25][round % 6];
    let origin = [0.0, 0.0, 1.0 / 3.0, 0.0, 500_000.0, -0.5][round % 6];
    let (flat, at) = (random.index(D + 1), random.below(3) as f64);
    let center: [f64; D] = std::array::from_fn(|_| random.below(4) as f64 / 2.0);
    let kind = random.below(3);
    let mut sites: Sites<D> = Vec::new();
    for _ in 0..2 + random.index(9) {
        let mut step: [f64; D] = std::array::from_fn(|_| random.below(3) as f64);
        match round % 6 {
            3 => step = step.map(|_| 3.0 * random.unit()),
            5 => step[..flat].fill(at),
            _ => {}
        }
        let mut site = step.map(|x| origin + x * spacing);
        if round % 6 == 2 {
            site = site.map(|x| ulps(x, random.around(2)));
        }
        let weight = match kind {
            0 => random.below(4) as f64 * spacing * spacing / 2.0,
            // The same power to all sites at the center.
            1 => (0..D)
                .map(|k| ((step[k] - center[k]) * spacing).powi(2))
                .sum(),
            _ => random.unit() * spacing * spacing,
        };
        if sites.iter().all(|&(other, _)| other != site) {
            sites.push((site, if is_weighted { weight } else { 0.0 }));
        }
    }
    sites
}

/// Returns a box, as its lowest and its highest corner: a third of them with sides through sites,
/// halfway between two, or off these by a rounding; a third through the given centers, where cells
/// meet; others anywhere.
pub fn window<const D: usize>(
    random: &mut Random,
    round: usize,
    sites: &Sites<D>,
    centers: &[[f64; D]],
) -> [[f64; D]; 2] {
    let mut side = |axis: usize| {
        let mut of = || random.pick(sites).0[axis];
        let [p, q, r, s] = [of(), of(), of(), of()];
        match round % 3 {
            0 => ulps(p / 2.0 + q / 2.0, random.below(2) as i64 * random.around(1)),
            1 if !centers.is_empty() => random.pick(centers)[axis],
            _ => p + (q - p) * 2.0 * random.unit() + (r - s) * random.unit(),
        }
    };
    let corners: [[f64; 2]; D] = std::array::from_fn(|axis| [side(axis), side(axis)]);
    [f64::min, f64::max].map(|of| corners.map(|[p, q]| of(p, q)))
}

/// Asserts that cells, one for each site, have the volumes that they should have, and fill the box.
pub fn judge<const D: usize>(sites: &Sites<D>, within: [[f64; D]; 2], found: &[f64]) {
    let all = sites.iter().map(|(site, _)| site).chain(&within);
    let widths = (0..D).map(|k| {
        let along = all.clone().map(|p| p[k]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    });
    let size = widths.fold(0.0, f64::max).powi(D as i32);
    let whole: f64 = (0..D).map(|k| within[1][k] - within[0][k]).product();
    for (k, &found) in found.iter().enumerate() {
        let right = volume_of_cell(sites, k, within).to_f64().value();
        let error = (found - right).abs();
        assert!(
            error <= 1e-11 * size,
            "cell {k} has {found} instead of {right} in {within:?}: {sites:?}"
        );
    }
    let sum: f64 = found.iter().sum();
    assert!(
        (sum - whole).abs() <= 1e-11 * size,
        "{sum} instead of {whole} in {within:?}: {sites:?}"
    );
}

/// A position, shared by simplices.
type Corner<const D: usize> = Rc<[RBig; D]>;

/// A linear function: its gradient, and its value at the origin.
type Linear<const D: usize> = ([RBig; D], RBig);

fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("it is finite")
}

fn value<const D: usize>((gradient, constant): &Linear<D>, at: &[RBig; D]) -> RBig {
    (0..D).fold(constant.clone(), |sum, k| sum + &gradient[k] * &at[k])
}

/// Returns the volume of the part of a box in which a site has the least power, by the definition:
/// the simplices of the box are cut by the borders to all other sites.
fn volume_of_cell<const D: usize>(sites: &Sites<D>, of: usize, within: [[f64; D]; 2]) -> RBig {
    let (site, weight) = sites[of];
    let mut simplices = simplices_of_box(within);
    for &(other, other_weight) in sites.iter().filter(|&&(other, _)| other != site) {
        // Positive where the other has less power.
        let squares = |p: [f64; D]| {
            p.map(|x| exact(x) * exact(x))
                .into_iter()
                .fold(RBig::ZERO, |sum, x| sum + x)
        };
        let constant = squares(site) - exact(weight) - squares(other) + exact(other_weight);
        let gradient = std::array::from_fn(|k| RBig::from(2) * (exact(other[k]) - exact(site[k])));
        simplices = simplices
            .into_iter()
            .flat_map(|simplex| part(simplex, &(gradient.clone(), constant.clone())))
            .collect();
    }
    let factorial = (1..=D as u32).product::<u32>();
    simplices
        .iter()
        .fold(RBig::ZERO, |sum, simplex| sum + volume(simplex))
        / RBig::from(factorial)
}

/// Returns simplices that fill a box: one for each order of the axes, along which it walks from the
/// lowest corner to the highest.
fn simplices_of_box<const D: usize>(within: [[f64; D]; 2]) -> Vec<Vec<Corner<D>>> {
    let [low, high] = within.map(|corner| corner.map(exact));
    let mut walks = vec![vec![Rc::new(low)]];
    for _ in 0..D {
        let step = |walk: Vec<Corner<D>>| {
            let here = walk[walk.len() - 1].clone();
            let high = &high;
            (0..D).filter_map(move |axis| {
                let been = walk.windows(2).any(|pair| pair[0][axis] != pair[1][axis]);
                let mut there = (*here).clone();
                there[axis] = high[axis].clone();
                (!been && there[axis] != here[axis])
                    .then(|| [walk.clone(), vec![Rc::new(there)]].concat())
            })
        };
        walks = walks.into_iter().flat_map(step).collect();
    }
    walks
}

/// Returns simplices that fill the part of one in which a function is not positive.
fn part<const D: usize>(simplex: Vec<Corner<D>>, function: &Linear<D>) -> Vec<Vec<Corner<D>>> {
    let mut parts = Vec::new();
    let with_values = simplex
        .into_iter()
        .map(|corner| (value(function, &corner), corner))
        .collect::<Vec<_>>();
    let mut open = vec![with_values];
    while let Some(simplex) = open.pop() {
        let inside = simplex.iter().position(|(value, _)| *value < RBig::ZERO);
        let outside = simplex.iter().position(|(value, _)| *value > RBig::ZERO);
        if let (Some(i), Some(j)) = (inside, outside) {
            // Both halves, on the two sides of where the edge crosses the border.
            let ((at_p, p), (at_q, q)) = (&simplex[i], &simplex[j]);
            let along = at_p / (at_p - at_q);
            let border: Corner<D> =
                Rc::new(std::array::from_fn(|k| &p[k] + &along * (&q[k] - &p[k])));
            for end in [i, j] {
                let mut half = simplex.clone();
                half[end] = (RBig::ZERO, border.clone());
                open.push(half);
            }
        } else if inside.is_some() {
            parts.push(simplex.into_iter().map(|(_, corner)| corner).collect());
        }
    }
    parts
}

/// Returns the volume of a simplex, times `D!`.
fn volume<const D: usize>(simplex: &[Corner<D>]) -> RBig {
    let row = |corner: &Corner<D>| (0..D).map(|k| &corner[k] - &simplex[0][k]).collect();
    let determinant = determinant(&simplex[1..].iter().map(row).collect::<Vec<_>>());
    if determinant < RBig::ZERO {
        -determinant
    } else {
        determinant
    }
}

/// Along the first column.
fn determinant(rows: &[Vec<RBig>]) -> RBig {
    let mut sum = if rows.is_empty() {
        RBig::ONE
    } else {
        RBig::ZERO
    };
    for (i, row) in rows.iter().enumerate() {
        let others = rows.iter().enumerate().filter(|&(j, _)| j != i);
        let minor =
            &row[0] * determinant(&others.map(|(_, row)| row[1..].to_vec()).collect::<Vec<_>>());
        sum = if i % 2 == 0 { sum + minor } else { sum - minor };
    }
    sum
}
