//! Walls: an upper and a lower edge next to each other.

use super::joints;
use super::offset::offset_between;
use crate::error::{Error, Result, Setting, wording};

/// On which side of a wall, seen in the direction of its line, the ground is higher.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum HighSide {
    /// On the left.
    #[default]
    Left,
    /// On the right.
    Right,
}

/// A wall, a kerb or a quay: a face so steep that it is taken for vertical.
///
/// A surface has one height at each position, so the two edges lie next to each other in plan:
///
/// ```text
///    high ground                 high ___________ upper edge: the line as given
///   ---->-------->---- upper                     |
///   - - -> - - - ->- - lower                     |  width, 1 cm
///    low ground                                   \__________ low
/// ```
///
/// The upper edge is the line as it was given. Points between the edges are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    pub(crate) upper: Vec<[f64; 3]>,
    pub(crate) lower: Vec<[f64; 3]>,
    /// Polygons between the edges, as rings; each point in one of them is left out.
    pub(crate) areas: Vec<Vec<Vec<[f64; 2]>>>,
}

/// The narrowest wall, in units in the last place of the largest coordinate: crossings are rounded
/// to such units, and must not exchange the edges.
const NARROWEST: f64 = 1000.0;

/// The least distance between lines next to each other, for a largest coordinate.
pub(crate) fn narrowest(largest: f64) -> f64 {
    NARROWEST * (largest.next_up() - largest)
}

impl Wall {
    /// Returns a wall from its upper edge and the height of the lower edge at each of its vertices.
    ///
    /// # Errors
    /// If the line has fewer than two distinct vertices or not as many lower heights, the wall has
    /// no height anywhere or its lower edge is above the upper one, or if it is narrower than
    /// rounding allows.
    pub fn new(upper: &[[f64; 3]], lower: &[f64], width: f64, high: HighSide) -> Result<Self> {
        Self::continued(upper, lower, width, high, [None, None])
    }

    /// Like [`new`](Wall::new), for one of several walls that meet at their ends: their lower edges
    /// meet, too. `neighbors` are those of [`neighbors`](Wall::neighbors). The edges are those of
    /// one wall with the vertices of all, at any angle.
    ///
    /// # Errors
    /// Those of [`new`](Wall::new).
    pub fn continued(
        upper: &[[f64; 3]],
        lower: &[f64],
        width: f64,
        high: HighSide,
        neighbors: [Option<[f64; 2]>; 2],
    ) -> Result<Self> {
        if lower.len() != upper.len() {
            return Err(Error::format(format!(
                "{} vertices, but {} lower heights",
                upper.len(),
                lower.len()
            )));
        }
        let mut vertices: Vec<([f64; 3], f64)> =
            upper.iter().copied().zip(lower.iter().copied()).collect();
        vertices.dedup_by(|(p, _), (q, _)| p[..2] == q[..2]);
        if vertices.len() < 2 {
            return Err(
                Error::format("the wall has fewer than two distinct vertices")
                    .cure("remove the record, or give the line its vertices"),
            );
        }
        check_heights(&vertices)?;
        let largest = vertices
            .iter()
            .flat_map(|(p, _)| [p[0].abs(), p[1].abs()])
            .fold(0.0, f64::max);
        let narrowest = narrowest(largest);
        if !(width >= narrowest && width.is_finite()) {
            return Err(Error::usage(format!(
                "a wall of width {width}, expected at least {narrowest:e}"
            )));
        }
        let sites: Vec<[f64; 2]> = vertices.iter().map(|(p, _)| [p[0], p[1]]).collect();
        // The lower edge is on the right, also where the wall turns back.
        let parallel = offset_between(
            &low_on_the_right(sites, high),
            low_on_the_right(neighbors, high),
            -width,
        );
        let beside = low_on_the_right(parallel, high);
        let lower: Vec<[f64; 3]> = beside
            .into_iter()
            .zip(&vertices)
            .map(|([x, y], &(_, low))| [x, y, low])
            .collect();
        let upper: Vec<[f64; 3]> = vertices.into_iter().map(|(p, _)| p).collect();
        // One for each segment: in a sharp bend they overlap.
        let area = |(p, q): (&[[f64; 3]], &[[f64; 3]])| vec![in_plan(&[p[0], p[1], q[1], q[0]])];
        let areas = upper.windows(2).zip(lower.windows(2)).map(area).collect();
        Ok(Wall {
            upper,
            lower,
            areas,
        })
    }

    /// Returns, for each of several upper edges, the vertices before and after it that
    /// [`continued`](Wall::continued) needs.
    ///
    /// At a vertex where edges end, each lower edge meets that of the next wall on its side, by
    /// angle. If that one has its lower edge on its other side, the lower edge ends short of it.
    /// Corners within an edge, closed ones included, depend on nothing else.
    ///
    /// # Complexity
    /// O(n) for n vertices, if few walls meet at one of them.
    pub fn neighbors(uppers: &[&[[f64; 3]]], high: HighSide) -> Vec<[Option<[f64; 2]>; 2]> {
        let lines: Vec<Vec<[f64; 2]>> = uppers
            .iter()
            .map(|upper| low_on_the_right(in_plan(upper), high))
            .collect();
        joints::neighbors(&lines)
            .into_iter()
            .map(|ends| low_on_the_right(ends, high))
            .collect()
    }

    /// Returns a wall from both of its edges, which may be drawn in opposite directions.
    ///
    /// # Errors
    /// If an edge has fewer than two distinct vertices, the edges are the same in plan, or the
    /// lower one is higher on average.
    pub fn between(upper: &[[f64; 3]], lower: &[[f64; 3]]) -> Result<Self> {
        let [upper, mut lower] = [upper, lower].map(|edge| {
            let mut edge = edge.to_vec();
            edge.dedup_by(|p, q| p[..2] == q[..2]);
            edge
        });
        if upper.len() < 2 || lower.len() < 2 {
            return Err(
                Error::format("an edge of the wall has fewer than two distinct vertices")
                    .cure("remove the record, or give the line its vertices"),
            );
        }
        let gap = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let [a, b, c, d] = [
            upper[0],
            upper[upper.len() - 1],
            lower[0],
            lower[lower.len() - 1],
        ];
        if gap(a, d) + gap(b, c) < gap(a, c) + gap(b, d) {
            lower.reverse();
        }
        let same = |(p, q): (&[f64; 3], &[f64; 3])| p[..2] == q[..2];
        if upper.len() == lower.len() && upper.iter().zip(&lower).all(same) {
            return Err(
                Error::format("both edges of the wall are the same in plan").cure(wording![
                    "draw them apart, or give the upper edge alone, with ",
                    Setting::WallBottom,
                    " or ",
                    Setting::WallDrop
                ]),
            );
        }
        let mean = |edge: &[[f64; 3]]| edge.iter().map(|p| p[2]).sum::<f64>() / edge.len() as f64;
        if mean(&lower) >= mean(&upper) {
            return Err(Error::format(format!(
                "the second part of the wall, its lower edge, is at {} on average, not below the first at {}",
                mean(&lower),
                mean(&upper)
            ))
            .cure("the first part of the record is the upper edge"));
        }
        let areas = vec![rings(&upper, &lower)];
        Ok(Wall {
            upper,
            lower,
            areas,
        })
    }
}

/// Returns an error if the lower edge is above the upper one anywhere, or as high as it everywhere.
fn check_heights(vertices: &[([f64; 3], f64)]) -> Result<()> {
    if let Some(([x, y, z], low)) = vertices.iter().find(|(p, low)| *low > p[2]) {
        return Err(Error::format(format!(
            "at {x} {y} the lower edge of the wall is at {low}, above the upper at {z}"
        ))
        .cure(wording![
            "the line has the heights of the upper edge; ",
            Setting::WallBottom,
            " or ",
            Setting::WallDrop,
            " give the lower one"
        ]));
    }
    if vertices.iter().all(|(p, low)| *low == p[2]) {
        return Err(
            Error::format("the wall has no height: upper and lower edge are the same").cure(
                wording![
                    "give the lower edge with ",
                    Setting::WallBottom,
                    " or ",
                    Setting::WallDrop,
                    ", or use ",
                    Setting::Breaklines
                ],
            ),
        );
    }
    Ok(())
}

/// The rings around the area between two edges.
fn rings(upper: &[[f64; 3]], lower: &[[f64; 3]]) -> Vec<Vec<[f64; 2]>> {
    let [upper, mut lower] = [upper, lower].map(in_plan);
    if upper.len() > 2 && upper.first() == upper.last() {
        return vec![upper, lower];
    }
    lower.reverse();
    vec![[upper, lower].concat()]
}

fn in_plan(line: &[[f64; 3]]) -> Vec<[f64; 2]> {
    line.iter().map(|p| [p[0], p[1]]).collect()
}

/// Returns a list along a wall in the direction in which the lower edge is on the right; maps it
/// back, too.
fn low_on_the_right<T, List: AsMut<[T]>>(mut list: List, high: HighSide) -> List {
    if high == HighSide::Right {
        list.as_mut().reverse();
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: [[f64; 3]; 3] = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [8.0, 0.0, 4.0]];

    #[test]
    fn the_lower_edge_is_beside_the_upper_one() {
        let wall = Wall::new(&LINE, &[3.0, 3.0, 4.0], 0.5, HighSide::Left).unwrap();
        assert_eq!(wall.upper, LINE);
        assert_eq!(
            wall.lower,
            [[0.0, -0.5, 3.0], [4.0, -0.5, 3.0], [8.0, -0.5, 4.0]]
        );
        assert_eq!(
            wall.areas[0],
            [[[0.0, 0.0], [4.0, 0.0], [4.0, -0.5], [0.0, -0.5]]]
        );
        let wall = Wall::new(&LINE, &[3.0, 3.0, 4.0], 0.5, HighSide::Right).unwrap();
        assert_eq!(wall.lower[0], [0.0, 0.5, 3.0]);
    }

    #[test]
    fn walls_that_continue_each_other_meet_below() {
        let corner = [[8.0, 0.0, 4.0], [8.0, 6.0, 4.0]];
        let first = Wall::continued(
            &LINE,
            &[1.0; 3],
            0.5,
            HighSide::Left,
            [None, Some([8.0, 6.0])],
        )
        .unwrap();
        let second = Wall::continued(
            &corner,
            &[1.0; 2],
            0.5,
            HighSide::Left,
            [Some([4.0, 0.0]), None],
        )
        .unwrap();
        assert_eq!(first.lower[2], second.lower[0]);
        let joined = [LINE.as_slice(), &corner[1..]].concat();
        let whole = Wall::new(&joined, &[1.0; 4], 0.5, HighSide::Left).unwrap();
        assert_eq!(
            [first.lower.as_slice(), &second.lower[1..]].concat(),
            whole.lower
        );
        // Drawn in both directions: a wall with two sides, whose lower edges meet around its ends.
        let back = [LINE[2], LINE[0]];
        let there = Wall::continued(
            &LINE,
            &[1.0; 3],
            0.5,
            HighSide::Left,
            [Some([4.0, 0.0]), Some([4.0, 0.0])],
        );
        let back = Wall::continued(
            &back,
            &[1.0; 2],
            0.5,
            HighSide::Left,
            [Some([4.0, 0.0]), Some([4.0, 0.0])],
        );
        let [there, back] = [there, back].map(|wall| wall.unwrap().lower);
        assert_eq!(there, [[-1.0, 0.0, 1.0], [4.0, -0.5, 1.0], [9.0, 0.0, 1.0]]);
        assert_eq!(back, [there[2], there[0]]);
    }

    /// The lower edges of the parts of a line, in any order and direction of the whole, are those
    /// of the whole.
    #[test]
    fn a_wall_in_parts_is_that_in_one() {
        // Sharp turns to both sides, back on itself, a segment shorter than the width, and around.
        let line = [
            [0.0, 0.0],
            [10.0, 0.0],
            [1.0, -5.0],
            [4.0, 9.0],
            [4.0, 3.0],
            [4.0, 7.0],
            [4.001, 7.0],
            [0.0, 0.0],
        ]
        .map(|[x, y]| [x, y, 10.0]);
        for high in [HighSide::Left, HighSide::Right] {
            let open = Wall::new(&line[..7], &[5.0; 7], 0.1, high).unwrap().lower;
            let ring = Wall::new(&line, &[5.0; 8], 0.1, high).unwrap().lower;
            for cuts in 0..1 << 6 {
                let mut cuts: Vec<usize> = (1..7).filter(|k| cuts >> (k - 1) & 1 == 1).collect();
                for (count, whole) in [(7, &open), (8, &ring)] {
                    cuts.retain(|&cut| cut < count - 1);
                    let from = std::iter::once(0).chain(cuts.iter().copied());
                    let to = cuts.iter().copied().chain([count - 1]);
                    let mut parts: Vec<&[[f64; 3]]> =
                        from.zip(to).map(|(from, to)| &line[from..=to]).collect();
                    parts.reverse();
                    let neighbors = Wall::neighbors(&parts, high);
                    let lower = parts.iter().zip(neighbors).map(|(part, ends)| {
                        Wall::continued(part, &vec![5.0; part.len()], 0.1, high, ends)
                            .unwrap()
                            .lower
                    });
                    let mut lower: Vec<Vec<[f64; 3]>> = lower.collect();
                    lower.reverse();
                    let mut joined = lower.concat();
                    joined.dedup();
                    assert_eq!(&joined, whole, "{cuts:?} {high:?}");
                }
            }
        }
    }

    #[test]
    fn two_edges_stay_where_they_are() {
        let lower = [[8.0, 0.5, 1.0], [0.0, 0.5, 2.0]]; // drawn the other way
        let wall = Wall::between(&LINE, &lower).unwrap();
        assert_eq!(
            (wall.upper, wall.lower),
            (LINE.to_vec(), vec![lower[1], lower[0]])
        );
        assert!(
            Wall::between(&lower, &LINE)
                .unwrap_err()
                .to_string()
                .contains("not below the first")
        );
        assert!(
            Wall::between(&LINE, &LINE)
                .unwrap_err()
                .to_string()
                .contains("the same in plan")
        );
        assert!(Wall::between(&LINE, &lower[..1]).is_err());
    }

    #[test]
    fn what_is_no_wall_is_refused() {
        let message = |line: &[[f64; 3]], low: &[f64], width| {
            Wall::new(line, low, width, HighSide::Left)
                .unwrap_err()
                .to_string()
        };
        assert!(message(&LINE, &[5.0, 5.0, 4.0], 0.1).contains("no height"));
        assert!(
            message(&LINE, &[5.0, 6.0, 4.0], 0.1)
                .starts_with("at 4 0 the lower edge of the wall is at 6")
        );
        assert!(message(&LINE[..1], &[5.0], 0.1).contains("two distinct vertices"));
        assert!(message(&[LINE[0], LINE[0]], &[1.0, 2.0], 0.1).contains("two distinct vertices"));
        assert!(message(&LINE, &[1.0], 0.1).contains("3 vertices, but 1 lower heights"));
        for width in [1e-15, 0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                message(&LINE, &[1.0; 3], width).contains("a wall of width"),
                "{width}"
            );
        }
    }
}
