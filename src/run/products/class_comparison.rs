//! Two classifications of the same points.

use std::collections::BTreeMap;
use std::path::Path;

use super::ground::GROUND;
use crate::data::{PointBatch, PointSource};
use crate::error::{Error, Plain, Result};
use crate::io::points;
use crate::run::context::{Context, Journal, Size, Stage};

/// Two files may round the same coordinate differently, by this share of it.
const ROUNDING: f64 = 1e-12;

/// How many points have which class in two files.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ClassComparison {
    /// The number of points that have these classes, the one in the first file and the other in the
    /// second.
    pub pairs: BTreeMap<[u8; 2], u64>,
}

/// How well the ground (class 2) of a first classification agrees with that of a second: shares,
/// from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundAgreement {
    /// Type I error: the share of the second's ground points that are not ground in the first. NaN
    /// if the second has no ground.
    pub lost: f64,
    /// Type II error: the share of the second's other points that are ground in the first. NaN if
    /// the second has ground only.
    pub kept: f64,
    /// Total error: the share of all points that are ground in only one of the two. NaN without
    /// points.
    pub total: f64,
    /// Cohen's kappa (1960): 1 if the two agree, 0 if they agree no more often than by chance. NaN
    /// if both have ground only, or none.
    pub kappa: f64,
}

impl ClassComparison {
    fn of(table: &[u64]) -> Self {
        let counts = (0..=u16::MAX).zip(table).filter(|(_, count)| **count > 0);
        ClassComparison {
            pairs: counts
                .map(|(pair, count)| (pair.to_be_bytes(), *count))
                .collect(),
        }
    }

    /// Returns the number of points.
    pub fn points(&self) -> u64 {
        self.pairs.values().sum()
    }

    /// Returns the number of points whose classes differ.
    pub fn changed(&self) -> u64 {
        self.count(|[first, second]| first != second)
    }

    /// Returns how well the ground (class 2) of the first agrees with that of the second.
    pub fn ground(&self) -> GroundAgreement {
        let count = |first: bool, second: bool| {
            let is = |pair: [u8; 2]| pair.map(|class| class == GROUND) == [first, second];
            self.count(is) as f64
        };
        let [both, lost] = [true, false].map(|first| count(first, true));
        let [kept, none] = [true, false].map(|first| count(first, false));
        let all = both + lost + kept + none;
        let by_chance = ((both + lost) * (both + kept) + (none + lost) * (none + kept)) / all;
        GroundAgreement {
            lost: lost / (both + lost),
            kept: kept / (kept + none),
            total: (lost + kept) / all,
            kappa: (both + none - by_chance) / (all - by_chance),
        }
    }

    fn count(&self, is_counted: impl Fn([u8; 2]) -> bool) -> u64 {
        let pairs = self.pairs.iter().filter(|(pair, _)| is_counted(**pair));
        pairs.map(|(_, count)| count).sum()
    }
}

/// Counts the points of two files by their classes in both. The files have the same points in the
/// same order.
///
/// # Errors
/// If a file has no classes, a point is at another position, one file has more points, a file is
/// damaged, or the run is canceled.
///
/// # Complexity
/// Linear; a batch of each file is in memory.
pub fn compare_classes(files: [&Path; 2], context: &Context) -> Result<ClassComparison> {
    let journal = Journal::new(context);
    let mut sides = [Side::open(files[0])?, Side::open(files[1])?];
    let size = match sides[0].source.info().count {
        Some(count) => Size::Items(count),
        None => Size::Uncounted,
    };
    let work = journal.start(Stage::ReadingPoints, size)?;
    // Of each class in the first file, those of the second.
    let mut table = vec![0u64; 1 << 16];
    let mut number = 0;
    loop {
        let [first, second] = &mut sides;
        let counts = [first.fill()?, second.fill()?];
        let count = counts[0].min(counts[1]);
        if count == 0 {
            return match counts {
                [0, 0] => work.end().map(|()| ClassComparison::of(&table)),
                [0, _] => Err(first.ends(number, second.path)),
                _ => Err(second.ends(number, first.path)),
            };
        }
        for k in 0..count {
            let [p, q] = [&*first, &*second].map(|side| side.position(k));
            let is_near = |axis: usize| (p[axis] - q[axis]).abs() <= ROUNDING * p[axis].abs();
            if !(0..3).all(is_near) {
                return Err(elsewhere(
                    [first.path, second.path],
                    number + k as u64,
                    [p, q],
                ));
            }
            let classes = [&*first, &*second].map(|side| side.batch.class[side.next + k]);
            table[usize::from(u16::from_be_bytes(classes))] += 1;
        }
        first.next += count;
        second.next += count;
        number += count as u64;
        work.add(count as u64)?;
    }
}

#[cold]
fn elsewhere([a, b]: [&Path; 2], number: u64, [p, q]: [[f64; 3]; 2]) -> Error {
    let text = |p: [f64; 3]| p.map(|value| Plain(value).to_string()).join(" ");
    Error::format(format!(
        "point {number} (counted from 0) is at {}, and in {} at {}",
        text(p),
        b.display(),
        text(q)
    ))
    .in_file(a)
    .cure("compare files of the same points in the same order")
}

/// A file that is read.
struct Side<'a> {
    path: &'a Path,
    source: Box<dyn PointSource + Send>,
    batch: PointBatch,
    /// The next point of the batch.
    next: usize,
}

impl<'a> Side<'a> {
    fn open(path: &'a Path) -> Result<Self> {
        Ok(Side {
            path,
            source: points::open(path).map_err(|error| error.in_file(path))?,
            batch: PointBatch::default(),
            next: 0,
        })
    }

    /// Returns how many points are left of the batch, of the next one if none is.
    fn fill(&mut self) -> Result<usize> {
        if self.next == self.batch.len() {
            self.source.read(&mut self.batch)?;
            self.next = 0;
            if self.batch.class.len() != self.batch.len() {
                return Err(Error::format("the points have no classes")
                    .in_file(self.path)
                    .cure("compare files of LAS or LAZ, or text with a column `class`"));
            }
        }
        Ok(self.batch.len() - self.next)
    }

    fn position(&self, k: usize) -> [f64; 3] {
        let at = self.next + k;
        [self.batch.x[at], self.batch.y[at], self.batch.z[at]]
    }

    #[cold]
    fn ends(&self, count: u64, other: &Path) -> Error {
        Error::format(format!("{count} points, and {} has more", other.display()))
            .in_file(self.path)
            .cure("compare files of the same points in the same order")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ground_of_two_classifications_is_scored() {
        // By hand: 40 in both, 10 lost, 5 kept, 45 of neither.
        let pairs = [
            ([2, 2], 40),
            ([1, 2], 10),
            ([2, 6], 5),
            ([1, 1], 30),
            ([5, 6], 15),
        ];
        let comparison = ClassComparison {
            pairs: pairs.into(),
        };
        assert_eq!((comparison.points(), comparison.changed()), (100, 30));
        let ground = comparison.ground();
        assert_eq!((ground.lost, ground.kept, ground.total), (0.2, 0.1, 0.15));
        // By chance: 0.45 * 0.5 + 0.55 * 0.5 = 0.5.
        assert!((ground.kappa - 0.7).abs() < 1e-12);
        assert!(ClassComparison::default().ground().total.is_nan());
    }
}
