//! Numbers of points that a file names by ids.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The numbers of points by their ids.
#[derive(Default)]
pub(crate) struct Ids {
    /// `PERF:` the first id, if each id is one more than the last; then no table is needed.
    first: u64,
    count: u32,
    table: HashMap<u64, u32>,
}

impl Ids {
    /// Adds the id of the next point; returns false if another has it.
    pub(crate) fn add(&mut self, id: u64, number: u32) -> bool {
        if number == 0 {
            self.first = id;
        }
        let is_next = self.table.is_empty() && id.wrapping_sub(self.first) == u64::from(number);
        self.count = number + 1;
        if is_next {
            return true;
        }
        if self.table.is_empty() {
            let before = (0..number).map(|n| (self.first.wrapping_add(u64::from(n)), n));
            self.table.extend(before);
        }
        match self.table.entry(id) {
            Entry::Occupied(_) => false,
            Entry::Vacant(free) => {
                free.insert(number);
                true
            }
        }
    }

    /// Returns the number of the point with an id.
    pub(crate) fn number(&self, id: u64) -> Option<u32> {
        if !self.table.is_empty() {
            return self.table.get(&id).copied();
        }
        let number = u32::try_from(id.wrapping_sub(self.first)).ok()?;
        (number < self.count).then_some(number)
    }
}
