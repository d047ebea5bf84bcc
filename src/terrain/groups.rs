//! Things by number that are joined to groups.

/// A union-find structure.
#[derive(Debug, Clone, Default)]
pub(super) struct Groups(Vec<u32>);

impl Groups {
    /// Returns the number of things.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// Adds a thing as a group of its own; returns its number.
    pub(super) fn add(&mut self) -> u32 {
        self.0.push(self.0.len() as u32);
        self.0.len() as u32 - 1
    }

    /// Returns the number that stands for the group of a thing: the smallest in it.
    pub(super) fn find(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            // Shortens the path for the next search.
            self.0[of as usize] = self.0[self.0[of as usize] as usize];
            of = self.0[of as usize];
        }
        of
    }

    /// Joins the groups of two things.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
