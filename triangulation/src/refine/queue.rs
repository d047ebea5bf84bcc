use crate::tds::{CellId, VertexId};

/// A triangle that is to be destroyed, with its corners as they were: its number may have been
/// reused since.
#[derive(Debug, Clone, Copy)]
pub(super) struct BadTriangle {
    pub(super) cell: CellId,
    pub(super) corners: [VertexId; 3],
    /// The square of the length of its shortest edge.
    pub(super) shortest: f64,
}

/// The number of words of scales: floating-point numbers have 11 bits of exponent, and the first
/// bit of the fraction counts.
const WORDS: usize = (1 << 12) / 64;

/// Stands for no entry: entries are numbered from 1.
const NONE: u32 = 0;

/// Triangles by their shortest edges: the shortest first, up to a factor of 1.23; of those, the
/// last that was queued. What is repaired on a small scale is not disturbed again from a larger one
/// (Shewchuk 2002).
///
/// `PERF:` with the first that was queued instead, 370 000 vertices (`la` of Triangle's samples,
/// area 0.001) took about 1.4 times as long, measured next to Triangle in the same minute, and
/// there were as many: the last is still in the cache. In arrays, a push takes 56 instructions
/// instead of 196 with a map of lists (`la`, callgrind), and no scale needs an allocation. Stacks
/// are created for the words that occur, mostly one: all of them are 17 000 instructions, of 230
/// 000 that a small refinement takes (`double_hex3`).
#[derive(Debug)]
pub(super) struct Queue {
    /// Triangles, each with the entry below it on the stack of its scale, or on that of free
    /// entries.
    entries: Vec<(BadTriangle, u32)>,
    free: u32,
    /// The topmost entries of the scales of a word.
    tops: Vec<[u32; 64]>,
    /// The index in `tops` of each word's entries, counted from 1; 0 if the word has not occurred.
    stacks: [u8; WORDS],
    /// A bit for each scale that has entries, and one for each word of these that is not zero.
    scales: [u64; WORDS],
    words: u64,
}

impl Default for Queue {
    fn default() -> Self {
        Queue {
            entries: Vec::new(),
            free: NONE,
            tops: Vec::new(),
            stacks: [0; WORDS],
            scales: [0; WORDS],
            words: 0,
        }
    }
}

impl Queue {
    pub(super) fn push(&mut self, bad: BadTriangle) {
        let scale = (bad.shortest.to_bits() >> 51) as usize; // there is no sign
        let (word, bit) = (scale / 64 % WORDS, scale % 64);
        if self.stacks[word] == 0 {
            self.tops.push([NONE; 64]);
            self.stacks[word] = self.tops.len() as u8;
        }
        let top = &mut self.tops[self.stacks[word] as usize - 1][bit];
        let below = std::mem::replace(top, self.free);
        if self.free == NONE {
            self.entries.push((bad, below));
            *top = self.entries.len() as u32;
        } else {
            let entry = &mut self.entries[self.free as usize - 1];
            self.free = std::mem::replace(entry, (bad, below)).1;
        }
        self.scales[word] |= 1 << bit;
        self.words |= 1 << word;
    }

    pub(super) fn pop(&mut self) -> Option<BadTriangle> {
        if self.words == 0 {
            return None;
        }
        let word = self.words.trailing_zeros() as usize;
        let bit = self.scales[word].trailing_zeros() as usize;
        let top = &mut self.tops[self.stacks[word] as usize - 1][bit];
        let entry = &mut self.entries[*top as usize - 1];
        let (bad, below) = *entry;
        entry.1 = self.free;
        self.free = std::mem::replace(top, below);
        if below == NONE {
            self.scales[word] &= !(1 << bit);
            if self.scales[word] == 0 {
                self.words &= !(1 << word);
            }
        }
        Some(bad)
    }
}

#[cfg(test)]
mod tests {
    use super::{BadTriangle, Queue};
    use crate::tds::{CellId, VertexId};

    /// Compares with a sorted list: the smallest scale first, and of it the last entry.
    #[test]
    fn the_shortest_come_first() {
        let (mut queue, mut list) = (Queue::default(), Vec::new());
        let mut state = 1u64;
        for step in 0..20_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let random = state >> 33;
            if random % 5 < 3 - step as u64 / 10_000 {
                let shortest = [1e-300, 0.9, 1.0, 1.4, 1.5, 2.0, 1e300, f64::INFINITY, 0.0]
                    [random as usize / 5 % 9];
                queue.push(BadTriangle {
                    cell: CellId::new(step),
                    corners: [VertexId::INFINITE; 3],
                    shortest,
                });
                list.push((shortest.to_bits() >> 51, step));
            } else {
                let least = list.iter().map(|&(scale, _)| scale).min();
                let at = list.iter().rposition(|&(scale, _)| Some(scale) == least);
                let expected = at.map(|at| CellId::new(list.remove(at).1));
                assert_eq!(queue.pop().map(|bad| bad.cell), expected);
            }
        }
    }
}
