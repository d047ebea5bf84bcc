//! Which points of two banks are opposite each other.

use super::sites::{distance, flat};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::nearest::{nearest_part, squared_distance};

/// How much of the even distribution is mixed to the nearest points: many vertices of the outer
/// bank of a bend are nearest to one point of the inner bank, and their level lines must not meet
/// there.
const EVEN: f64 = 0.05;

/// Fractions that differ by less are the same position.
const TIE: f64 = 1e-7;

/// A bank, with positions on it as fractions of its length.
struct Bank<'a> {
    line: &'a [[f64; 3]],
    /// The position of each vertex.
    fractions: Vec<f64>,
    segments: Boxes<Part>,
}

/// A segment of a bank, and its number.
#[derive(Debug, Clone, Copy)]
struct Part(usize, [[f64; 2]; 2]);

impl Boxed for Part {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.1)
    }
}

/// Pairs of points on both banks, strictly advancing on each: one for each vertex of either.
///
/// Each vertex and the nearest point of the other bank are a pair of positions. The pairs are made
/// ascending on both banks, and define a map from one bank to the other, linear in between.
///
/// # Complexity
/// O(n log n) for n vertices, if few segments are about as near to a vertex as the nearest.
pub(super) fn stations(left: &[[f64; 3]], right: &[[f64; 3]]) -> Vec<[[f64; 3]; 2]> {
    let [left, right] = [left, right].map(Bank::new);
    let vertices = |bank: &Bank| {
        bank.line
            .iter()
            .copied()
            .zip(bank.fractions.clone())
            .collect::<Vec<_>>()
    };
    let mut pairs: Vec<[f64; 2]> = vertices(&left)
        .into_iter()
        .map(|(p, u)| [u, right.nearest(flat(p))])
        .collect();
    pairs.extend(
        vertices(&right)
            .into_iter()
            .map(|(p, v)| [left.nearest(flat(p)), v]),
    );
    pairs.sort_by(|p, q| {
        (p[0] + p[1])
            .total_cmp(&(q[0] + q[1]))
            .then(p[0].total_cmp(&q[0]))
    });
    let [u, v] =
        [0, 1].map(|bank| ascending(&pairs.iter().map(|pair| pair[bank]).collect::<Vec<f64>>()));
    let even = |(u, v): (&f64, &f64)| {
        [u, v].map(|position| (1.0 - EVEN) * position + EVEN * (u + v) / 2.0)
    };
    let mut map: Vec<[f64; 2]> = u.iter().zip(&v).map(even).collect();
    // The ends of the banks belong together, and to nothing else.
    map.retain(|pair| {
        pair.iter()
            .all(|position| (TIE..=1.0 - TIE).contains(position))
    });
    map.insert(0, [0.0, 0.0]);
    map.dedup_by(|p, q| p[0] - q[0] < TIE || p[1] - q[1] < TIE);
    map.push([1.0, 1.0]);
    let across = |from: usize, position: f64| {
        let next = map
            .partition_point(|pair| pair[from] <= position)
            .clamp(1, map.len() - 1);
        let [low, high] = [map[next - 1], map[next]];
        let part = (position - low[from]) / (high[from] - low[from]);
        (low[1 - from] + part * (high[1 - from] - low[1 - from])).clamp(0.0, 1.0)
    };
    let mut found: Vec<[f64; 2]> = left
        .inner()
        .map(|u| [u, right.at_vertex(across(0, u))])
        .collect();
    found.extend(right.inner().map(|v| [left.at_vertex(across(1, v)), v]));
    found.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    found.dedup();
    found.retain(|[u, v]| *u > 0.0 && *v > 0.0 && *u < 1.0 && *v < 1.0);
    let inner = found.iter().map(|[u, v]| [left.point(*u), right.point(*v)]);
    let [first, last] = [0.0, 1.0].map(|position| [left.point(position), right.point(position)]);
    std::iter::once(first).chain(inner).chain([last]).collect()
}

impl<'a> Bank<'a> {
    /// Prepares a line of at least two vertices, each of which differs from the next in plan.
    fn new(line: &'a [[f64; 3]]) -> Self {
        let mut sum = 0.0;
        let lengths = line.windows(2).map(|pair| {
            sum += distance(pair[0], pair[1]);
            sum
        });
        let lengths: Vec<f64> = std::iter::once(0.0).chain(lengths).collect();
        let whole = lengths[lengths.len() - 1];
        let parts = line
            .windows(2)
            .enumerate()
            .map(|(k, pair)| Part(k, [flat(pair[0]), flat(pair[1])]));
        let segments = Boxes::new(parts.collect());
        Bank {
            line,
            fractions: lengths.into_iter().map(|length| length / whole).collect(),
            segments,
        }
    }

    /// The positions of the vertices between the ends.
    fn inner(&self) -> impl Iterator<Item = f64> + '_ {
        self.fractions[1..self.fractions.len() - 1].iter().copied()
    }

    /// The position that is nearest to a point; of several, the first.
    fn nearest(&self, q: [f64; 2]) -> f64 {
        let mut best = (f64::INFINITY, 0, 0.0);
        self.segments.around(q, &mut Vec::new(), |&Part(k, ends)| {
            let squared = squared_distance(ends, q);
            if (squared, k) < (best.0, best.1) {
                best = (squared, k, nearest_part(ends, q));
            }
            best.0
        });
        let (_, k, part) = best;
        self.fractions[k] + part * (self.fractions[k + 1] - self.fractions[k])
    }

    /// The point at a position.
    fn point(&self, position: f64) -> [f64; 3] {
        let k = self
            .fractions
            .partition_point(|fraction| *fraction <= position)
            .saturating_sub(1);
        match self.line.get(k + 1) {
            Some(next) if position > self.fractions[k] => {
                let part =
                    (position - self.fractions[k]) / (self.fractions[k + 1] - self.fractions[k]);
                [0, 1, 2].map(|axis| self.line[k][axis] + part * (next[axis] - self.line[k][axis]))
            }
            _ => self.line[k],
        }
    }

    /// The position itself, or that of a vertex which is almost there.
    fn at_vertex(&self, position: f64) -> f64 {
        let next = self
            .fractions
            .partition_point(|fraction| *fraction < position - TIE);
        self.fractions
            .get(next)
            .copied()
            .filter(|fraction| *fraction <= position + TIE)
            .unwrap_or(position)
    }
}

/// The ascending sequence that is nearest to numbers, by least squares (pool adjacent violators).
fn ascending(numbers: &[f64]) -> Vec<f64> {
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for &number in numbers {
        let mut block = (number, 1);
        while let Some(&(mean, count)) = blocks.last()
            && mean > block.0
        {
            block.0 = (mean * count as f64 + block.0 * block.1 as f64) / (count + block.1) as f64;
            block.1 += count;
            blocks.pop();
        }
        blocks.push(block);
    }
    blocks
        .into_iter()
        .flat_map(|(mean, count)| std::iter::repeat_n(mean, count))
        .collect()
}
