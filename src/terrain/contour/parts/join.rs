use super::{ContourParts, LevelParts, LevelSide, LineEnd, NO_HEIGHTS, OpenLine};
use crate::data::ContourLine;
use crate::error::{Error, Result};
use crate::terrain::contour::cut::Direction;
use crate::terrain::contour::find;
use crate::terrain::contour::join::{End, Joined, chain, pair};
use crate::terrain::contour::line::finish_level;
use crate::terrain::contour::narrow::{Bends, NarrowArcs};
use crate::terrain::in_order::in_order;
use rayon::prelude::*;

impl ContourParts {
    /// Merges the parts of several tasks, so that less is left to join: lines are joined where they
    /// cross an edge between two of the tasks.
    ///
    /// # Errors
    /// If the parts contradict each other, as those of one task given twice do.
    pub fn merged(parts: Vec<ContourParts>) -> Result<Self> {
        let mut heights = NO_HEIGHTS;
        let mut levels = Vec::new();
        for part in parts {
            heights = find::joined(heights, part.heights);
            levels.extend(part.levels);
        }
        Ok(ContourParts {
            heights,
            levels: merge_levels(levels)?,
        })
    }
}

/// Finds where arcs are bent, lest they cross those of other levels.
#[derive(Default)]
pub struct BendFinder(NarrowArcs);

impl BendFinder {
    /// Adds a level, given its parts from all tasks. One whose parts [may not
    /// bend](LevelParts::may_bend) can be left out.
    ///
    /// # Errors
    /// Those of [`join_level`].
    pub fn add(&mut self, level: f64, parts: Vec<LevelParts>) -> Result<()> {
        let narrow = parts.iter().map(|part| &part.narrow[..]);
        let sites: Vec<[f64; 2]> = narrow.collect::<Vec<_>>().concat();
        if !sites.is_empty() {
            let lines = join_level(level, parts, &Bends::default())?;
            self.0.add(&lines, &sites);
        }
        Ok(())
    }

    /// Returns the bends, when all levels have been added.
    pub fn finish(self) -> Bends {
        self.0.bends()
    }
}

/// Returns the contours of a level from the parts of all tasks, sorted by their points: those of
/// [`contours`](crate::terrain::contours) for the whole surface.
///
/// The order of the parts does not matter. A task that is missing is not noticed: lines end where
/// its triangles would be. [The module](super) shows how the levels are found.
///
/// # Errors
/// If parts are of another level, or contradict each other, as those of one task given twice do.
///
/// # Complexity
/// `n log n` for `n` parts, and for the lines. Memory: that of the parts, and 250 bytes per open
/// one; where rounding shows, 250 bytes per arc, as in `contours`.
pub fn join_level(level: f64, parts: Vec<LevelParts>, bends: &Bends) -> Result<Vec<ContourLine>> {
    let LevelParts {
        touches_vertices,
        closed,
        open,
        ..
    } = gathered(level, parts)?;
    let mut next = vec![None; open.len()];
    follow_edges(level, &open, &mut next)?;
    follow_vertices(level, &open, &mut next)?;
    let mut joined: Vec<Joined> = closed
        .into_iter()
        .map(|points| Joined {
            points,
            closed: true,
        })
        .collect();
    chain(
        open.into_iter().map(|line| line.points).collect(),
        &next,
        |line, _| joined.push(line),
    );
    Ok(finish_level(level, joined, touches_vertices, bends))
}

/// Merges parts of the same level; ascending.
pub(super) fn merge_levels(mut parts: Vec<LevelParts>) -> Result<Vec<LevelParts>> {
    parts.sort_by(|a, b| a.level.total_cmp(&b.level));
    let mut groups: Vec<Vec<LevelParts>> = Vec::new();
    for part in parts {
        match groups
            .last_mut()
            .filter(|group| group[0].level == part.level)
        {
            Some(group) => group.push(part),
            None => groups.push(vec![part]),
        }
    }
    // The first error is returned, whatever the threads do.
    let merged: Vec<Result<LevelParts>> = groups
        .into_par_iter()
        .map(|group| merged(group[0].level, group))
        .collect();
    merged.into_iter().collect()
}

/// Merges the parts of a level. Lines that end at a vertex stay open: other parts may have arcs
/// there.
fn merged(level: f64, parts: Vec<LevelParts>) -> Result<LevelParts> {
    let LevelParts {
        touches_vertices,
        mut closed,
        open,
        sides,
        narrow,
        ..
    } = gathered(level, parts)?;
    let mut next = vec![None; open.len()];
    follow_edges(level, &open, &mut next)?;
    let (points, ends): (Vec<_>, Vec<_>) = open
        .into_iter()
        .map(|line| (line.points, line.ends))
        .unzip();
    let mut open = Vec::new();
    chain(
        points,
        &next,
        |Joined {
             points,
             closed: is_closed,
         },
         [first, last]| match is_closed {
            true => closed.push(points),
            false => open.push(OpenLine {
                points,
                ends: [ends[first][0], ends[last][1]],
            }),
        },
    );
    Ok(LevelParts {
        level,
        touches_vertices,
        closed,
        open,
        sides,
        narrow,
    })
}

/// Returns all parts of a level in one, with the arcs along edges whose two sides are among them.
fn gathered(level: f64, parts: Vec<LevelParts>) -> Result<LevelParts> {
    let mut parts = parts.into_iter();
    let mut all = parts.next().unwrap_or_else(|| LevelParts::new(level));
    let mut is_level = all.level == level;
    for part in parts {
        is_level &= part.level == level;
        all.touches_vertices |= part.touches_vertices;
        all.closed.extend(part.closed);
        all.open.extend(part.open);
        all.sides.extend(part.sides);
        all.narrow.extend(part.narrow);
    }
    if !is_level {
        return Err(Error::usage(format!(
            "parts of several levels are joined, expected level {level} only"
        )));
    }
    all.sides
        .sort_unstable_by_key(|side| (sorted(side), side.vertices));
    let mut unmatched = Vec::new();
    for sides in all.sides.chunk_by(|a, b| sorted(a) == sorted(b)) {
        match *sides {
            [side] => unmatched.push(side),
            [a, b] if a.is_opposite(&b) => all.open.extend(a.arc_to(&b)),
            _ => return Err(contradiction(level, sides[0].at[0])),
        }
    }
    all.sides = unmatched;
    Ok(all)
}

fn sorted(side: &LevelSide) -> [super::VertexKey; 2] {
    let [a, b] = side.vertices;
    [a.min(b), a.max(b)]
}

impl LevelSide {
    /// Returns true if the other side belongs to the same edge.
    fn is_opposite(&self, other: &LevelSide) -> bool {
        let [a, b] = other.vertices;
        let [p, q] = other.at;
        self.vertices == [b, a] && self.at == [q, p]
    }

    /// The arc along the edge, if ground falls from one side to the other.
    fn arc_to(&self, other: &LevelSide) -> Option<OpenLine> {
        let high = match (self.is_high, other.is_high) {
            (true, false) => self,
            (false, true) => other,
            _ => return None,
        };
        let ([to, from], [q, p]) = (high.vertices, high.at);
        let ends = [
            LineEnd::Vertex {
                vertex: from,
                toward: q,
            },
            LineEnd::Vertex {
                vertex: to,
                toward: p,
            },
        ];
        Some(OpenLine {
            points: vec![p, q],
            ends,
        })
    }
}

/// Finds the lines that follow each other across edges.
fn follow_edges(level: f64, open: &[OpenLine], next: &mut [Option<usize>]) -> Result<()> {
    let ends = ends_at(open, |end, center| match end {
        LineEnd::Edge(edge) => Some((edge, center)),
        LineEnd::Vertex { .. } => None,
    });
    follow(level, ends, |a, b| a.direction == b.direction, next)
}

/// Finds the lines that follow each other at vertices.
fn follow_vertices(level: f64, open: &[OpenLine], next: &mut [Option<usize>]) -> Result<()> {
    let ends = ends_at(open, |end, _| match end {
        LineEnd::Vertex { vertex, toward } => Some((vertex, toward)),
        LineEnd::Edge(_) => None,
    });
    follow(level, ends, |a, b| a.toward == b.toward, next)
}

/// The ends of lines for which `key_of` returns the key of a node, and the direction from it.
fn ends_at<K>(
    open: &[OpenLine],
    key_of: impl Fn(LineEnd, [f64; 2]) -> Option<(K, [f64; 2])>,
) -> Vec<(K, End)> {
    let mut ends = Vec::new();
    for (
        line,
        OpenLine {
            points,
            ends: [start, end],
        },
    ) in open.iter().enumerate()
    {
        let (first, last) = (points[0], points[points.len() - 1]);
        for (end, center, direction) in [
            (*start, first, Direction::Forward),
            (*end, last, Direction::Backward),
        ] {
            let found = key_of(end, center);
            ends.extend(found.map(|(key, toward)| {
                (
                    key,
                    End {
                        center,
                        toward,
                        direction,
                        line,
                    },
                )
            }));
        }
    }
    ends
}

/// Applies the turn rule at each node. Two ends at one node cannot both exist if `is_same` is true.
fn follow<K: Ord>(
    level: f64,
    mut ends: Vec<(K, End)>,
    is_same: impl Fn(&End, &End) -> bool,
    next: &mut [Option<usize>],
) -> Result<()> {
    let by_direction = |a: &End, b: &End| {
        let by_toward = in_order(&a.toward, &b.toward);
        by_toward.then_with(|| {
            (a.direction == Direction::Forward).cmp(&(b.direction == Direction::Forward))
        })
    };
    ends.sort_unstable_by(|(a, end), (b, other)| a.cmp(b).then_with(|| by_direction(end, other)));
    for node in ends.chunk_by(|a, b| a.0 == b.0) {
        let group: Vec<End> = node.iter().map(|(_, end)| *end).collect();
        if group
            .windows(2)
            .any(|pair| pair[0].center != pair[1].center || is_same(&pair[0], &pair[1]))
        {
            return Err(contradiction(level, group[0].center));
        }
        pair(group, next);
    }
    Ok(())
}

#[cold]
fn contradiction(level: f64, at: [f64; 2]) -> Error {
    Error::format(format!(
        "the parts of level {level} contradict each other at {at:?}"
    ))
    .cure("give the parts of each task once, and all of one triangulation")
}
