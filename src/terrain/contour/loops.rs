//! Lines that pass a point twice, cut there.

use super::join::around;
use std::cmp::Ordering;

/// Calls `found` with the simple lines that a line consists of, if it is not simple itself: none
/// passes a point twice. A closed one does not repeat its first point. Returns false for a simple
/// line.
///
/// Between two passages of a point lies a loop, which becomes a line of its own; the rest goes on
/// from the point. Loops of two points, which enclose nothing, are left out. Where the rest of an
/// open line would cross the loop, it ends at the point instead: it comes from one side of the loop
/// and goes on at the other, through a gap in the data.
///
/// # Complexity
/// Linear.
pub(super) fn cut_loops(
    line: &[[f64; 2]],
    is_closed: bool,
    mut found: impl FnMut(Vec<[f64; 2]>, bool),
) -> bool {
    let Some(sites) = Sites::of(line) else {
        return false;
    };
    // The points since the start, without loops; and where each site is among them.
    let mut simple: Vec<usize> = Vec::new();
    let mut position = vec![None; sites.count];
    let points_of = |numbers: &[usize]| numbers.iter().map(|&i| line[i]).collect::<Vec<_>>();
    for (i, &site) in sites.of_points.iter().enumerate() {
        if let Some(start) = site.and_then(|site: usize| position[site]) {
            let is_crossed = !is_closed && crosses_loop(line, &simple, start, i);
            if simple.len() - start > 2 {
                found(points_of(&simple[start..]), true);
            }
            if is_crossed {
                found(points_of(&simple[..=start]), false);
            }
            let kept = if is_crossed { 0 } else { start };
            for passed in simple.drain(kept..) {
                if let Some(site) = sites.of_points[passed] {
                    position[site] = None;
                }
            }
        }
        if let Some(site) = site {
            position[site] = Some(simple.len());
        }
        simple.push(i);
    }
    if simple.len() > if is_closed { 2 } else { 1 } {
        found(points_of(&simple), is_closed);
    }
    true
}

/// Returns true if an open line without the loop that starts at `simple[start]` and ends at point
/// `last` would cross it there.
fn crosses_loop(line: &[[f64; 2]], simple: &[usize], start: usize, last: usize) -> bool {
    let Some(before) = start.checked_sub(1) else {
        return false;
    };
    let (Some(&after), Some(&first)) = (line.get(last + 1), simple.get(start + 1)) else {
        return false;
    };
    let center = line[last];
    let [before, first, back] = [simple[before], first, last - 1].map(|i| line[i]);
    // In the circle from `before` on, the rest of the line lies between the ends of the loop.
    let turns = |p, q| around(center, p, q) == Ordering::Less;
    let is_between = |p, from, to| match turns(from, to) {
        true => turns(from, p) && turns(p, to),
        false => turns(from, p) || turns(p, to),
    };
    is_between(first, before, after) != is_between(back, before, after)
}

/// Which points of a line are the same, if any are.
struct Sites {
    /// The number of the site of each point that shares it with another one.
    of_points: Vec<Option<usize>>,
    count: usize,
}

impl Sites {
    /// Returns the sites of points; `None` if each has its own.
    fn of(points: &[[f64; 2]]) -> Option<Self> {
        let mut sites: Option<Sites> = None;
        each_repeated(points, |first, again| {
            let sites = sites.get_or_insert_with(|| Sites {
                of_points: vec![None; points.len()],
                count: 0,
            });
            let new = sites.count;
            let site = *sites.of_points[first].get_or_insert(new);
            sites.of_points[again] = Some(site);
            sites.count += usize::from(site == new);
        });
        sites
    }
}

/// Calls `found` for each point that is the same as one before it, with the number of the first of
/// these and its own.
///
/// `PERF:` most lines have few points or none twice. Few are compared with each other; the others
/// are entered into a table of their numbers, by hash.
fn each_repeated(points: &[[f64; 2]], mut found: impl FnMut(usize, usize)) {
    const FEW: usize = 12;
    if points.len() <= FEW {
        for (i, point) in points.iter().enumerate() {
            if let Some(first) = points[..i].iter().position(|before| before == point) {
                found(first, i);
            }
        }
        return;
    }
    let mut table = vec![0_u32; (2 * points.len()).next_power_of_two()];
    let last_slot = table.len() - 1;
    let shift = 64 - table.len().trailing_zeros();
    for (i, point) in points.iter().enumerate() {
        let [x, y] = point.map(f64::to_bits);
        let mixed = (x ^ y.rotate_left(32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut slot = (mixed >> shift) as usize;
        loop {
            match table[slot] {
                0 => {
                    // No line has as many points as there are numbers.
                    table[slot] = i as u32 + 1;
                    break;
                }
                number if points[number as usize - 1] == *point => {
                    found(number as usize - 1, i);
                    break;
                }
                _ => slot = (slot + 1) & last_slot,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines that `names` is cut into; a closed one ends as it begins.
    fn cut(names: &str) -> Vec<String> {
        let at = |b: u8| [f64::from(b % 5), f64::from(b / 5)];
        let mut points: Vec<_> = names.bytes().map(at).collect();
        let is_closed = points.len() > 2 && points.first() == points.last();
        points.truncate(points.len() - usize::from(is_closed));
        let mut lines = Vec::new();
        let mut add = |mut line: Vec<[f64; 2]>, is_closed| {
            line.extend_from_within(..usize::from(is_closed));
            lines.push(
                line.iter()
                    .map(|p| (p[0] + 5.0 * p[1]) as u8 as char)
                    .collect(),
            );
        };
        if !cut_loops(&points, is_closed, &mut add) {
            add(points, is_closed);
        }
        lines
    }

    #[test]
    fn a_simple_line_stays() {
        for line in ["ab", "abc", "abca", "azbyda"] {
            assert_eq!(cut(line), [line]);
        }
    }

    #[test]
    fn a_loop_becomes_a_line() {
        assert_eq!(cut("abcdefca"), ["cdefc", "abca"]);
        // One within another, two at one point, and at the start.
        assert_eq!(cut("abcdefdgcha"), ["defd", "cdgc", "abcha"]);
        assert_eq!(cut("abcdefbghba"), ["bcdefb", "bghb"]);
        assert_eq!(cut("abcadea"), ["abca", "adea"]);
    }

    #[test]
    fn loops_that_enclose_nothing_vanish() {
        assert_eq!(cut("abcba"), [""; 0]);
        assert_eq!(cut("abcbda"), ["abda"]);
    }

    /// Whatever their number: few points are compared with each other, many by hash.
    #[test]
    fn repeated_points_are_found() {
        let at = |i: usize| [0.1 * i as f64, -3.0];
        for count in [2, 5, 12, 13, 40, 1000] {
            let mut points: Vec<_> = (0..count).map(at).collect();
            assert!(Sites::of(&points).is_none(), "{count}");
            points.extend([at(count - 1), at(0), at(count - 1)]);
            let mut found = Vec::new();
            each_repeated(&points, |first, again| found.push([first, again]));
            let expected = [[count - 1, count], [0, count + 1], [count - 1, count + 2]];
            assert_eq!(found, expected);
            assert_eq!(Sites::of(&points).map(|sites| sites.count), Some(2));
        }
    }

    /// From one side of the loop through a gap in the data to the other.
    #[test]
    fn an_open_line_ends_where_it_would_cross_its_loop() {
        let [v, start, end] = [[0.0, 0.0], [-0.2, 1.0], [-1.0, -0.2]];
        let around = [[-0.2, -1.0], [2.0, 0.0], [0.0, 2.0], [-1.0, 0.2]];
        let line = [&[start, v][..], &around, &[v, end]].concat();
        let mut lines = Vec::new();
        cut_loops(&line, false, |line, is_closed| {
            lines.push((line, is_closed))
        });
        let ring = [&[v][..], &around].concat();
        assert_eq!(
            lines,
            [(ring, true), (vec![start, v], false), (vec![v, end], false)]
        );
    }
}
