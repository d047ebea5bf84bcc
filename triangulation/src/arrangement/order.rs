//! An ordered list that is searched with a predicate: a skip list (Pugh 1990).

/// The number of levels. Each level has a quarter of the nodes of the one below.
const LEVELS: usize = 12;

/// A list of some of the numbers below a limit, in an order that the caller maintains by where it
/// inserts and what it exchanges.
#[derive(Debug, Clone)]
pub(super) struct Order {
    /// For each node, the index of the first of its links, which are stored level by level. The
    /// last node is the head, where the list begins and ends.
    starts: Vec<u32>,
    /// The nodes before and after, for each node and level.
    links: Vec<[u32; 2]>,
    /// Maps each node to the number that it holds, and in `nodes` each number to its node.
    held: Vec<u32>,
    nodes: Vec<u32>,
}

impl Order {
    /// Returns an empty list for numbers below a limit.
    pub(super) fn of(limit: usize) -> Self {
        let head = limit as u32;
        let mut starts = Vec::with_capacity(limit + 2);
        let mut sum = 0;
        for node in 0..head {
            starts.push(sum);
            sum += levels(node) as u32;
        }
        starts.extend([sum, sum + LEVELS as u32]);
        let links = vec![[head; 2]; sum as usize + LEVELS];
        let numbers: Vec<u32> = (0..head).collect();
        Order {
            starts,
            links,
            held: numbers.clone(),
            nodes: numbers,
        }
    }

    fn head(&self) -> u32 {
        self.held.len() as u32
    }

    fn links(&mut self, node: u32, level: usize) -> &mut [u32; 2] {
        &mut self.links[self.starts[node as usize] as usize + level]
    }

    fn next(&self, node: u32, level: usize) -> u32 {
        self.links[self.starts[node as usize] as usize + level][1]
    }

    /// Returns the position after all numbers for which `is_before` is true, which come first in
    /// the list: the node before the position, on each level.
    pub(super) fn position(&self, is_before: impl Fn(u32) -> bool) -> [u32; LEVELS] {
        let mut position = [self.head(); LEVELS];
        let mut at = self.head();
        let mut refused = self.head();
        for level in (0..LEVELS).rev() {
            loop {
                let next = self.next(at, level);
                // A number that was refused on the level above need not be tested again.
                if next == refused || next == self.head() || !is_before(self.held[next as usize]) {
                    refused = next;
                    break;
                }
                at = next;
            }
            position[level] = at;
        }
        position
    }

    /// Inserts a number at a position. Each number can be inserted once.
    pub(super) fn insert(&mut self, number: u32, position: &[u32; LEVELS]) {
        let node = number; // unused so far
        for (level, &before) in position.iter().enumerate().take(levels(node)) {
            let behind = self.next(before, level);
            *self.links(node, level) = [before, behind];
            self.links(before, level)[1] = node;
            self.links(behind, level)[0] = node;
        }
    }

    /// Removes a number.
    pub(super) fn remove(&mut self, number: u32) {
        let node = self.nodes[number as usize];
        for level in 0..levels(node) {
            let [before, behind] = *self.links(node, level);
            self.links(before, level)[1] = behind;
            self.links(behind, level)[0] = before;
        }
    }

    /// Exchanges the positions of two numbers.
    pub(super) fn exchange(&mut self, p: u32, q: u32) {
        self.nodes.swap(p as usize, q as usize);
        for number in [p, q] {
            self.held[self.nodes[number as usize] as usize] = number;
        }
    }

    /// Returns the number before `number`.
    pub(super) fn below(&self, number: u32) -> Option<u32> {
        self.beside(number, 0)
    }

    /// Returns the number after `number`.
    pub(super) fn above(&self, number: u32) -> Option<u32> {
        self.beside(number, 1)
    }

    fn beside(&self, number: u32, side: usize) -> Option<u32> {
        let node = self.nodes[number as usize];
        let beside = self.links[self.starts[node as usize] as usize][side];
        self.held.get(beside as usize).copied() // the head holds nothing
    }
}

/// Returns the number of levels of a node: pseudo-random.
fn levels(node: u32) -> usize {
    let mixed = node.wrapping_add(1).wrapping_mul(0x9E37_79B9);
    1 + ((mixed ^ mixed >> 15)
        .wrapping_mul(0x85EB_CA6B)
        .leading_zeros() as usize
        / 2)
    .min(LEVELS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_like_any() {
        let mut order = Order::of(1000);
        let mut naive: Vec<u32> = Vec::new();
        let mut state = 1u32;
        let mut below = |n: usize| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as usize % n
        };
        for number in 0..1000 {
            let at = below(naive.len() + 1);
            let first = naive[..at].to_vec();
            order.insert(number, &order.position(|other| first.contains(&other)));
            naive.insert(at, number);
            if naive.len() > 2 {
                let i = below(naive.len() - 1);
                order.exchange(naive[i], naive[i + 1]);
                naive.swap(i, i + 1);
            }
            if number % 3 == 0 {
                order.remove(naive.remove(below(naive.len())));
            }
        }
        for pair in naive.windows(2) {
            assert_eq!(
                (order.above(pair[0]), order.below(pair[1])),
                (Some(pair[1]), Some(pair[0]))
            );
        }
        assert_eq!(
            (order.below(naive[0]), order.above(naive[naive.len() - 1])),
            (None, None)
        );
    }
}
