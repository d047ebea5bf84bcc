//! Points of a line at regular distances.

use crate::data::{LinePoint, Multiples, Stretch};

/// Returns the points of a stretch at all multiples of a step along its line, besides its ends, the
/// points at `kept` distances, and both heights of each step of the surface. Heights are exact, as
/// the surface is straight between the points of a stretch.
///
/// # Complexity
/// Linear in the points of the stretch and of the result.
pub(crate) fn stepped(stretch: &Stretch, step: f64, kept: &[f64]) -> Stretch {
    let mut found = Stretch::new();
    let Some(first) = stretch.first() else {
        return found;
    };
    found.push(*first);
    let mut number = (first.along / step).floor() + 1.0;
    let multiples = Multiples::of(step);
    for pair in stretch.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        while multiples.at(number) < to.along {
            let along = multiples.at(number);
            if along > from.along {
                found.push(between(from, to, along));
            }
            number += 1.0;
        }
        let is_last = std::ptr::eq(&pair[1], &stretch[stretch.len() - 1]);
        let is_at_step = multiples.at(number) == to.along;
        let is_kept = kept.binary_search_by(|at| at.total_cmp(&to.along)).is_ok();
        if is_last || is_at_step || is_kept {
            found.push(to);
        } else if from.along == to.along {
            // A step of the surface.
            if found.last() != Some(&from) {
                found.push(from);
            }
            found.push(to);
        }
    }
    found
}

/// Returns the point between two others at a distance.
fn between(from: LinePoint, to: LinePoint, along: f64) -> LinePoint {
    let part = (along - from.along) / (to.along - from.along);
    LinePoint {
        along,
        at: [0, 1, 2].map(|k| from.at[k] + part * (to.at[k] - from.at[k])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point([along, z]: [f64; 2]) -> LinePoint {
        LinePoint {
            along,
            at: [along, 0.0, z],
        }
    }

    fn of(points: &[[f64; 2]], step: f64, kept: &[f64]) -> Vec<[f64; 2]> {
        let stretch: Stretch = points.iter().map(|p| point(*p)).collect();
        let found = stepped(&stretch, step, kept);
        found.iter().map(|p| [p.along, p.at[2]]).collect()
    }

    #[test]
    fn points_are_at_multiples_of_the_step_and_at_ends() {
        let line = [[0.5, 1.0], [1.5, 3.0], [2.0, 3.0], [4.5, 8.0]];
        assert_eq!(
            of(&line, 1.0, &[]),
            [
                [0.5, 1.0],
                [1.0, 2.0],
                [2.0, 3.0],
                [3.0, 5.0],
                [4.0, 7.0],
                [4.5, 8.0]
            ]
        );
        assert_eq!(
            of(&line, 2.0, &[1.5]),
            [[0.5, 1.0], [1.5, 3.0], [2.0, 3.0], [4.0, 7.0], [4.5, 8.0]]
        );
        assert_eq!(of(&line, 100.0, &[]), [[0.5, 1.0], [4.5, 8.0]]);
        assert_eq!(of(&line[..1], 1.0, &[]), [[0.5, 1.0]]);
    }

    #[test]
    fn steps_of_the_surface_stay() {
        let wall = [[0.0, 0.0], [1.25, 5.0], [1.25, 9.0], [3.0, 16.0]];
        assert_eq!(
            of(&wall, 1.0, &[]),
            [
                [0.0, 0.0],
                [1.0, 4.0],
                [1.25, 5.0],
                [1.25, 9.0],
                [2.0, 12.0],
                [3.0, 16.0]
            ]
        );
    }
}
