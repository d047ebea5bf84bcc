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

/// The bits of a number below its scale: eight scales for each power of two.
const SHIFT: u32 = 49;

/// The number of words of scales, one for each bit of a word.
const WORDS: usize = 64;

/// Returns the scale of a positive number. Powers of two up to the 256th have scales of their own,
/// in both directions; all numbers beyond share the first or the last.
fn scale(x: f64) -> usize {
    const FIRST: u64 = (1023 - 256) << (52 - SHIFT);
    let scale = (x.to_bits() >> SHIFT).saturating_sub(FIRST);
    (scale as usize).min(64 * WORDS - 1)
}

/// Stands for no entry: entries are numbered from 1.
const NONE: u32 = 0;

/// The first and the last entry of a scale.
#[derive(Debug, Clone, Copy)]
struct Ends {
    first: u32,
    last: u32,
}

/// Triangles by their shortest edges: the shortest first, up to a factor of 1.06; of those, the
/// first that was queued. What is repaired on a small scale is not disturbed again from a larger
/// one (Shewchuk 2002).
///
/// The order within a scale decides how many vertices are added where many edges have the same
/// length. With the last that was queued first, one place is refined at all scales before its
/// neighbors are: a disk of 200 vertices gets 1 291 at 33 degrees instead of 588.
///
/// `PERF:` in arrays, without an allocation for each scale. Lists are created for the words that
/// occur, mostly two or three of them.
#[derive(Debug)]
pub(super) struct Queue {
    /// Triangles, each with the next entry of its scale, or with the next free one.
    entries: Vec<(BadTriangle, u32)>,
    free: u32,
    /// The entries of the scales of a word.
    lists: Vec<[Ends; 64]>,
    /// The index in `lists` of each word's entries, counted from 1; 0 if the word has not occurred.
    list_of: [u8; WORDS],
    /// A bit for each scale that has entries, and one for each word of these that is not zero.
    scales: [u64; WORDS],
    words: u64,
}

impl Default for Queue {
    fn default() -> Self {
        Queue {
            entries: Vec::with_capacity(64),
            free: NONE,
            lists: Vec::new(),
            list_of: [0; WORDS],
            scales: [0; WORDS],
            words: 0,
        }
    }
}

impl Queue {
    pub(super) fn push(&mut self, bad: BadTriangle) {
        let scale = scale(bad.shortest);
        let (word, bit) = (scale / 64, scale % 64);
        if self.list_of[word] == 0 {
            let (first, last) = (NONE, NONE);
            self.lists.push([Ends { first, last }; 64]);
            self.list_of[word] = self.lists.len() as u8;
        }
        let new = if self.free == NONE {
            self.entries.push((bad, NONE));
            self.entries.len() as u32
        } else {
            let free = self.free;
            let entry = &mut self.entries[free as usize - 1];
            self.free = std::mem::replace(entry, (bad, NONE)).1;
            free
        };
        let ends = &mut self.lists[self.list_of[word] as usize - 1][bit];
        if ends.first == NONE {
            ends.first = new;
            self.scales[word] |= 1 << bit;
            self.words |= 1 << word;
        } else {
            self.entries[ends.last as usize - 1].1 = new;
        }
        ends.last = new;
    }

    pub(super) fn pop(&mut self) -> Option<BadTriangle> {
        if self.words == 0 {
            return None;
        }
        let word = self.words.trailing_zeros() as usize;
        let bit = self.scales[word].trailing_zeros() as usize;
        let ends = &mut self.lists[self.list_of[word] as usize - 1][bit];
        let first = ends.first;
        let (bad, next) = &mut self.entries[first as usize - 1];
        ends.first = std::mem::replace(next, self.free);
        self.free = first;
        if ends.first == NONE {
            self.scales[word] &= !(1 << bit);
            if self.scales[word] == 0 {
                self.words &= !(1 << word);
            }
        }
        Some(*bad)
    }
}

#[cfg(test)]
mod tests {
    use super::{BadTriangle, Queue, scale};
    use crate::tds::{CellId, VertexId};

    /// Compares with a sorted list: the smallest scale first, and of it the first entry.
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
                list.push((scale(shortest), step));
            } else {
                let least = list.iter().map(|&(scale, _)| scale).min();
                let at = list.iter().position(|&(scale, _)| Some(scale) == least);
                let expected = at.map(|at| CellId::new(list.remove(at).1));
                assert_eq!(queue.pop().map(|bad| bad.cell), expected);
            }
        }
    }
}
