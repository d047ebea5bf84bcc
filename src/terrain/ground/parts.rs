//! Nodes of a graph in parts that hang together.

/// Numbers in disjoint sets.
pub(super) struct Parts(Vec<u32>);

impl Parts {
    /// Puts each number in a part of its own.
    pub(super) fn of(count: usize) -> Parts {
        Parts((0..count as u32).collect())
    }

    /// Returns the least number of the part.
    pub(super) fn root(&mut self, mut number: u32) -> u32 {
        loop {
            let parent = self.0[number as usize];
            if parent == number {
                return number;
            }
            // Halves the way for whoever comes next.
            self.0[number as usize] = self.0[parent as usize];
            number = parent;
        }
    }

    /// Makes one part of those of two numbers.
    pub(super) fn join(&mut self, [a, b]: [u32; 2]) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
