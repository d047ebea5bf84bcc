//! Makes a failing set small, as long as it fails by the same law.

use testkit::case::{Case, Point};

/// `fails` names the law that a set breaks.
pub(crate) fn shrink(case: Case, law: &str, fails: impl Fn(&Case) -> Option<String>) -> Case {
    let still = |case: &Case| fails(case).is_some_and(|other| other == law);
    let mut best = case;
    if !still(&best) {
        return best; // only the judges of a sample saw it
    }
    loop {
        let before = best.clone();
        for step in [as_segments, without_lines, without_points, with_fewer_bits] {
            best = step(best, &still);
        }
        if best == before {
            return best;
        }
    }
}

type Still<'a> = &'a dyn Fn(&Case) -> bool;

fn or(best: Case, try_it: Case, still: Still) -> Case {
    if try_it != best && still(&try_it) {
        try_it
    } else {
        best
    }
}

/// Polylines cut up; at once, or the last part of one.
fn as_segments(best: Case, still: Still) -> Case {
    let cut = best
        .lines
        .iter()
        .flat_map(|line| line.windows(2).map(<[u32]>::to_vec))
        .collect();
    let try_it = Case {
        points: best.points.clone(),
        lines: cut,
    };
    let mut best = or(best, try_it, still);
    for line in 0..best.lines.len() {
        while best.lines[line].len() > 2 {
            let mut try_it = best.clone();
            try_it.lines[line].pop();
            let shorter = or(best.clone(), try_it, still);
            if shorter == best {
                break;
            }
            best = shorter;
        }
    }
    best
}

/// Ever shorter runs of lines left out.
fn without_lines(mut best: Case, still: Still) -> Case {
    let mut run = best.lines.len();
    while run > 0 {
        let mut at = 0;
        while at < best.lines.len() {
            let mut try_it = best.clone();
            try_it.lines.drain(at..(at + run).min(best.lines.len()));
            if still(&try_it) {
                best = try_it
            } else {
                at += run
            }
        }
        run /= 2;
    }
    best
}

/// Points that no line needs left out: all, or one by one.
fn without_points(mut best: Case, still: Still) -> Case {
    let is_free = |case: &Case, i: usize| !case.lines.iter().flatten().any(|&at| at as usize == i);
    let drop = |case: &Case, keep: &dyn Fn(usize) -> bool| {
        let mut new_index = Vec::new();
        let mut points = Vec::new();
        for (i, &p) in case.points.iter().enumerate() {
            new_index.push(points.len() as u32);
            if keep(i) {
                points.push(p);
            }
        }
        let lines = case
            .lines
            .iter()
            .map(|line| line.iter().map(|&i| new_index[i as usize]).collect())
            .collect();
        Case { points, lines }
    };
    let bare = drop(&best, &|i| !is_free(&best, i));
    best = or(best, bare, still);
    for i in (0..best.points.len()).rev() {
        if is_free(&best, i) {
            let fewer = drop(&best, &|other| other != i);
            best = or(best, fewer, still);
        }
    }
    best
}

/// Coordinates with low bits cleared: of all points on an axis, or of one.
fn with_fewer_bits(mut best: Case, still: Still) -> Case {
    let clear = |x: f64, bits: u32| f64::from_bits(x.to_bits() >> bits << bits);
    for bits in [52, 48, 44, 40, 36, 32, 28, 24, 20, 16, 12, 8, 6, 4, 3, 2, 1] {
        for axis in 0..2 {
            let mut try_it = best.clone();
            try_it
                .points
                .iter_mut()
                .for_each(|p| p[axis] = clear(p[axis], bits));
            best = or(best, try_it, still);
        }
    }
    for i in 0..best.points.len() {
        for axis in 0..2 {
            let simpler = |p: Point, bits: u32| {
                let mut p = p;
                p[axis] = clear(p[axis], bits);
                p
            };
            for bits in [52, 44, 36, 28, 20, 12, 8, 4, 2, 1] {
                let mut try_it = best.clone();
                try_it.points[i] = simpler(try_it.points[i], bits);
                best = or(best, try_it, still);
            }
        }
    }
    best
}
