//! Groups of things that are numbered from 0.

/// Disjoint sets; each is named by its smallest member.
pub(super) struct Groups {
    /// A smaller member of the same group, or the same.
    towards_first: Vec<u32>,
}

impl Groups {
    /// Makes each of so many things a group of its own.
    pub(super) fn new(count: usize) -> Self {
        Groups {
            towards_first: (0..count as u32).collect(),
        }
    }

    /// Joins the groups of two things.
    pub(super) fn join(&mut self, [s, t]: [u32; 2]) {
        let (s, t) = (self.first(s), self.first(t));
        self.towards_first[s.max(t) as usize] = s.min(t);
    }

    /// Returns the first member of a group.
    pub(super) fn first(&mut self, mut member: u32) -> u32 {
        while self.towards_first[member as usize] != member {
            let smaller = self.towards_first[member as usize];
            self.towards_first[member as usize] = self.towards_first[smaller as usize];
            member = self.towards_first[member as usize];
        }
        member
    }
}
