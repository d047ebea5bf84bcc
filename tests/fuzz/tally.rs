//! What a run has tried: how many segments and crossings the sets had.

use std::fmt;

use testkit::case::Case;
use testkit::judge::crossing_count;

/// The first number of each bin.
const SEGMENTS: [usize; 8] = [0, 3, 10, 20, 30, 40, 50, 61];
const CROSSINGS: [usize; 8] = [0, 1, 10, 30, 100, 300, 1000, 2000];

#[derive(Default)]
pub(crate) struct Tally {
    sets: u64,
    segments: [u64; 8],
    crossings: [u64; 8],
    most: [usize; 2],
    sum: [u64; 2],
}

impl Tally {
    pub(crate) fn add(&mut self, case: &Case) {
        let numbers = [case.segment_count(), crossing_count(case)];
        self.sets += 1;
        self.segments[bin(&SEGMENTS, numbers[0])] += 1;
        self.crossings[bin(&CROSSINGS, numbers[1])] += 1;
        for (i, n) in numbers.into_iter().enumerate() {
            self.most[i] = self.most[i].max(n);
            self.sum[i] += n as u64;
        }
    }

    pub(crate) fn merge(&mut self, other: &Tally) {
        self.sets += other.sets;
        for i in 0..8 {
            self.segments[i] += other.segments[i];
            self.crossings[i] += other.crossings[i];
        }
        for i in 0..2 {
            self.most[i] = self.most[i].max(other.most[i]);
            self.sum[i] += other.sum[i];
        }
    }
}

fn bin(bins: &[usize; 8], n: usize) -> usize {
    bins.partition_point(|&first| first <= n) - 1
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = [
            ("segments", SEGMENTS, self.segments),
            ("crossings", CROSSINGS, self.crossings),
        ];
        writeln!(f, "  {} sets", self.sets)?;
        for (i, (name, bins, counts)) in rows.into_iter().enumerate() {
            let mean = self.sum[i] as f64 / self.sets.max(1) as f64;
            write!(f, "  {name:9} mean {mean:.1}, most {}; ", self.most[i])?;
            let cells: Vec<String> = (0..8)
                .map(|k| match bins.get(k + 1) {
                    Some(next) if next - 1 > bins[k] => {
                        format!("{}-{}: {}", bins[k], next - 1, counts[k])
                    }
                    Some(_) => format!("{}: {}", bins[k], counts[k]),
                    None => format!("{}+: {}", bins[k], counts[k]),
                })
                .collect();
            writeln!(f, "{}", cells.join(", "))?;
        }
        Ok(())
    }
}
