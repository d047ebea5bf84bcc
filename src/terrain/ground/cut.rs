//! Minimum cuts of sparse graphs (Boykov and Kolmogorov 2004).
//!
//! Two trees grow from the terminals; where they meet, flow is pushed along the path, and nodes
//! that lose their parent look for another. Capacities are integers, so that the result is exact.

use std::collections::VecDeque;

/// An arc from one node to another, as its source has it.
#[derive(Debug, Clone, Copy)]
struct Arc {
    head: u32,
    /// The index of the arc that goes back.
    back: u32,
    /// What may still flow.
    left: i32,
}

/// The largest capacity that is accepted: two of them can be added.
pub(super) const MOST: i32 = i32::MAX / 4;

/// The tree that a node is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tree {
    Free,
    Source,
    Sink,
}

/// Parents that are no arcs.
const NONE: u32 = u32::MAX;
const TERMINAL: u32 = u32::MAX - 1;
const ORPHAN: u32 = u32::MAX - 2;

struct Flow {
    /// The arcs of node `n` are those from `first[n]` to `first[n + 1]`.
    first: Vec<u32>,
    arcs: Vec<Arc>,
    /// What may still flow from the source to a node, or to the sink if negative.
    terminal: Vec<i32>,
    tree: Vec<Tree>,
    /// The arc from a node to its parent.
    parent: Vec<u32>,
    /// How far a node is from its terminal, and when that was last known.
    distance: Vec<u32>,
    known: Vec<u32>,
    now: u32,
    active: VecDeque<u32>,
    is_active: Vec<bool>,
    orphans: VecDeque<u32>,
}

/// Returns which nodes are on the source's side of the minimum cut. Of several cuts of the same
/// capacity, the one with the smallest such side is chosen; there is only one, so the result does
/// not depend on the order of the links.
///
/// `links` gives pairs of nodes, and `capacities` those of the arcs from the first to the second
/// and the other way round. `terminals` has the capacity of the arc from the source to each node,
/// or, negative, that to the sink. Capacities above [`MOST`] are taken as that.
pub(super) fn source_side(
    terminals: &[i32],
    links: impl Iterator<Item = [u32; 2]> + Clone,
    capacities: impl Iterator<Item = [i32; 2]>,
) -> Vec<bool> {
    let mut flow = Flow::new(terminals, links, capacities);
    flow.run();
    flow.tree.iter().map(|&tree| tree == Tree::Source).collect()
}

impl Flow {
    fn new(
        terminals: &[i32],
        links: impl Iterator<Item = [u32; 2]> + Clone,
        capacities: impl Iterator<Item = [i32; 2]>,
    ) -> Flow {
        let count = terminals.len();
        let mut first = vec![0u32; count + 1];
        for end in links.clone().flatten() {
            first[end as usize + 1] += 1;
        }
        for node in 0..count {
            first[node + 1] += first[node];
        }
        let mut next = first.clone();
        let mut arcs = vec![
            Arc {
                head: 0,
                back: 0,
                left: 0
            };
            first[count] as usize
        ];
        for ([a, b], capacities) in links.zip(capacities) {
            let (there, back) = (next[a as usize], next[b as usize] + u32::from(a == b));
            next[a as usize] += 1;
            next[b as usize] += 1;
            let [forward, backward] = capacities.map(|capacity| capacity.clamp(0, MOST));
            arcs[there as usize] = Arc {
                head: b,
                back,
                left: forward,
            };
            arcs[back as usize] = Arc {
                head: a,
                back: there,
                left: backward,
            };
        }
        let mut flow = Flow {
            first,
            arcs,
            terminal: terminals
                .iter()
                .map(|left| (*left).clamp(-MOST, MOST))
                .collect(),
            tree: vec![Tree::Free; count],
            parent: vec![NONE; count],
            distance: vec![0; count],
            known: vec![0; count],
            now: 0,
            active: VecDeque::new(),
            is_active: vec![false; count],
            orphans: VecDeque::new(),
        };
        for node in 0..count {
            if flow.terminal[node] != 0 {
                flow.tree[node] = match flow.terminal[node] > 0 {
                    true => Tree::Source,
                    false => Tree::Sink,
                };
                flow.parent[node] = TERMINAL;
                flow.distance[node] = 1;
                flow.activate(node as u32);
            }
        }
        flow
    }

    fn activate(&mut self, node: u32) {
        if !std::mem::replace(&mut self.is_active[node as usize], true) {
            self.active.push_back(node);
        }
    }

    fn arcs_of(&self, node: u32) -> std::ops::Range<u32> {
        self.first[node as usize]..self.first[node as usize + 1]
    }

    /// Returns what may flow along an arc of a node of this tree, away from the source's end.
    fn onward(&self, arc: u32, tree: Tree) -> i32 {
        match tree {
            Tree::Source => self.arcs[arc as usize].left,
            _ => self.arcs[self.arcs[arc as usize].back as usize].left,
        }
    }

    fn run(&mut self) {
        let mut current = None;
        loop {
            let node = match current.take().or_else(|| self.active.pop_front()) {
                Some(node) => node,
                None => return,
            };
            self.is_active[node as usize] = false;
            if self.parent[node as usize] == NONE {
                continue;
            }
            if let Some(meeting) = self.grow(node) {
                self.now += 1;
                // There may be more paths from here.
                self.is_active[node as usize] = true;
                self.augment(meeting);
                self.adopt();
                current = Some(node);
            }
        }
    }

    /// Lets a node's tree grow from it; returns the arc, from the source's tree to the sink's, at
    /// which it meets the other tree.
    fn grow(&mut self, node: u32) -> Option<u32> {
        let tree = self.tree[node as usize];
        for arc in self.arcs_of(node) {
            if self.onward(arc, tree) == 0 {
                continue;
            }
            let Arc { head, back, .. } = self.arcs[arc as usize];
            let other = head as usize;
            if self.tree[other] == Tree::Free {
                self.tree[other] = tree;
                self.parent[other] = back;
                self.known[other] = self.known[node as usize];
                self.distance[other] = self.distance[node as usize] + 1;
                self.activate(head);
            } else if self.tree[other] != tree {
                return Some(match tree {
                    Tree::Source => arc,
                    _ => back,
                });
            } else if self.known[other] <= self.known[node as usize]
                && self.distance[other] > self.distance[node as usize]
            {
                // A shorter way to the terminal.
                self.parent[other] = back;
                self.known[other] = self.known[node as usize];
                self.distance[other] = self.distance[node as usize] + 1;
            }
        }
        None
    }

    /// Pushes as much as fits along the path through an arc.
    fn augment(&mut self, meeting: u32) {
        let ends = [
            self.arcs[self.arcs[meeting as usize].back as usize].head,
            self.arcs[meeting as usize].head,
        ];
        let mut most = self.arcs[meeting as usize].left;
        for (end, tree) in ends.into_iter().zip([Tree::Source, Tree::Sink]) {
            let mut node = end;
            loop {
                let parent = self.parent[node as usize];
                if parent == TERMINAL {
                    most = most.min(self.terminal[node as usize].abs());
                    break;
                }
                most = most.min(self.toward(parent, tree));
                node = self.arcs[parent as usize].head;
            }
        }
        self.push(meeting, most);
        for (end, tree) in ends.into_iter().zip([Tree::Source, Tree::Sink]) {
            let mut node = end;
            loop {
                let parent = self.parent[node as usize];
                if parent == TERMINAL {
                    self.terminal[node as usize] -= match tree {
                        Tree::Source => most,
                        _ => -most,
                    };
                    if self.terminal[node as usize] == 0 {
                        self.parent[node as usize] = ORPHAN;
                        self.orphans.push_front(node);
                    }
                    break;
                }
                let head = self.arcs[parent as usize].head;
                match tree {
                    Tree::Source => self.push(self.arcs[parent as usize].back, most),
                    _ => self.push(parent, most),
                }
                if self.toward(parent, tree) == 0 {
                    self.parent[node as usize] = ORPHAN;
                    self.orphans.push_front(node);
                }
                node = head;
            }
        }
    }

    /// Returns what may flow along an arc to the parent, in the direction from source to sink.
    fn toward(&self, parent: u32, tree: Tree) -> i32 {
        self.onward(self.arcs[parent as usize].back, tree)
    }

    fn push(&mut self, arc: u32, amount: i32) {
        let back = self.arcs[arc as usize].back;
        self.arcs[arc as usize].left -= amount;
        self.arcs[back as usize].left += amount;
    }

    /// Finds new parents for nodes that lost theirs, or sets them free.
    fn adopt(&mut self) {
        while let Some(node) = self.orphans.pop_front() {
            let tree = self.tree[node as usize];
            let mut best = None;
            for arc in self.arcs_of(node) {
                let head = self.arcs[arc as usize].head;
                if self.tree[head as usize] != tree || self.toward(arc, tree) == 0 {
                    continue;
                }
                if let Some(distance) = self.distance_of(head)
                    && best.is_none_or(|(least, _)| distance < least)
                {
                    best = Some((distance, arc));
                }
            }
            if let Some((distance, arc)) = best {
                self.parent[node as usize] = arc;
                self.known[node as usize] = self.now;
                self.distance[node as usize] = distance + 1;
                continue;
            }
            for arc in self.arcs_of(node) {
                let head = self.arcs[arc as usize].head;
                if self.tree[head as usize] != tree {
                    continue;
                }
                if self.toward(arc, tree) > 0 {
                    self.activate(head);
                }
                let parent = self.parent[head as usize];
                if parent < ORPHAN && self.arcs[parent as usize].head == node {
                    self.parent[head as usize] = ORPHAN;
                    self.orphans.push_back(head);
                }
            }
            self.tree[node as usize] = Tree::Free;
            self.parent[node as usize] = NONE;
        }
    }

    /// Returns how far a node is from its terminal, or none if an orphan is on the way.
    fn distance_of(&mut self, node: u32) -> Option<u32> {
        let (mut at, mut steps) = (node, 0);
        let total = loop {
            if self.known[at as usize] == self.now {
                break steps + self.distance[at as usize];
            }
            match self.parent[at as usize] {
                TERMINAL => {
                    self.known[at as usize] = self.now;
                    self.distance[at as usize] = 1;
                    break steps + 1;
                }
                ORPHAN | NONE => return None,
                parent => {
                    at = self.arcs[parent as usize].head;
                    steps += 1;
                }
            }
        };
        // What was found holds for all nodes on the way.
        let (mut at, mut distance) = (node, total);
        while self.known[at as usize] != self.now {
            self.known[at as usize] = self.now;
            self.distance[at as usize] = distance;
            distance -= 1;
            at = self.arcs[self.parent[at as usize] as usize].head;
        }
        Some(total)
    }
}
