//! The division of the plane into tiles, and the tree over them.

use super::Tile;

/// A division of the plane into tiles by cuts along the axes, each of which divides what the cuts
/// before it left. Tiles at the rim are infinite.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(into = "Vec<Node>", try_from = "Vec<Node>")]
pub struct TileLayout {
    /// The root is the first.
    nodes: Vec<Node>,
}

/// A tile, or a part of the plane with a cut through it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Node {
    /// A tile, by its number.
    Tile(u32),
    /// A cut: coordinates below it belong to the first part, it and those above to the second.
    Cut {
        /// 0 if the cut is at an x, 1 if it is at a y.
        axis: usize,
        /// The coordinate.
        at: f64,
        /// The positions of both parts in the list of nodes, which are larger than its own.
        parts: [u32; 2],
    },
}

impl From<TileLayout> for Vec<Node> {
    fn from(layout: TileLayout) -> Self {
        layout.nodes
    }
}

impl TryFrom<Vec<Node>> for TileLayout {
    type Error = &'static str;

    fn try_from(nodes: Vec<Node>) -> Result<Self, Self::Error> {
        TileLayout::from_nodes(nodes).ok_or("tiles and cuts do not form a tree")
    }
}

/// Points that are spread evenly over a box, as far as is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// The lowest coordinates, included.
    pub min: [f64; 2],
    /// The highest coordinates, included.
    pub max: [f64; 2],
    /// The number of points.
    pub count: f64,
}

/// A step of a triangulation in tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct TileStep {
    /// What the step covers.
    pub tile: Tile,
    /// What it does.
    pub work: Work,
}

/// What a [`TileStep`] does.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// Triangulates the points of the tile with this number.
    Leaf(u32),
    /// Merges the residuals of these steps, which come before it.
    Merge(Vec<usize>),
}

/// The largest number of residuals that are merged at once. Small ones cost more messages, large
/// ones more memory.
const FAN: usize = 16;

/// Cuts do not divide further than this: sites that coincide cannot be separated.
const DEEPEST: usize = 40;

impl TileLayout {
    /// Returns columns by rows of tiles of the same size over a box.
    pub fn grid(min: [f64; 2], max: [f64; 2], counts: [usize; 2]) -> Self {
        let mut layout = TileLayout { nodes: Vec::new() };
        let at = |axis: usize, i: usize| {
            min[axis] + (max[axis] - min[axis]) * (i as f64 / counts[axis] as f64)
        };
        layout.add_grid(&at, [0, 0], counts, counts[0]);
        layout
    }

    fn add_grid(
        &mut self,
        at: &dyn Fn(usize, usize) -> f64,
        from: [usize; 2],
        to: [usize; 2],
        columns: usize,
    ) -> u32 {
        let here = self.nodes.len();
        let size = [to[0] - from[0], to[1] - from[1]];
        self.nodes
            .push(Node::Tile((from[1] * columns + from[0]) as u32));
        let axis = usize::from(size[1] > size[0]);
        if size[axis] > 1 {
            let middle = from[axis] + size[axis] / 2;
            let (mut low_to, mut high_from) = (to, from);
            (low_to[axis], high_from[axis]) = (middle, middle);
            let parts = [
                self.add_grid(at, from, low_to, columns),
                self.add_grid(at, high_from, to, columns),
            ];
            self.nodes[here] = Node::Cut {
                axis,
                at: at(axis, middle),
                parts,
            };
        }
        here as u32
    }

    /// Returns one tile for each box, numbered like the boxes; `None` if no cuts separate them.
    /// Boxes that touch are not separate: both may have points there. Cuts are in the middle of
    /// gaps.
    ///
    /// # Complexity
    /// O(n log^2 n) for n boxes in a grid, O(n^2 log n) at worst.
    pub fn of_boxes(boxes: &[Spread]) -> Option<Self> {
        let mut layout = TileLayout { nodes: Vec::new() };
        let mut all: Vec<u32> = (0..boxes.len() as u32).collect();
        (!all.is_empty() && layout.add_boxes(boxes, &mut all)).then_some(layout)
    }

    fn add_boxes(&mut self, boxes: &[Spread], of: &mut [u32]) -> bool {
        let here = self.nodes.len();
        self.nodes.push(Node::Tile(of[0]));
        if of.len() == 1 {
            return true;
        }
        // The gap nearest to the middle of the list, of both axes.
        let mut best: Option<(usize, usize, f64)> = None;
        for axis in 0..2 {
            of.sort_by(|&a, &b| {
                boxes[a as usize].min[axis].total_cmp(&boxes[b as usize].min[axis])
            });
            let mut reach = f64::NEG_INFINITY;
            for i in 1..of.len() {
                reach = reach.max(boxes[of[i - 1] as usize].max[axis]);
                let next = boxes[of[i] as usize].min[axis];
                let off = |i: usize| i.abs_diff(of.len() / 2);
                let middle = f64::midpoint(reach, next);
                if reach < middle && best.is_none_or(|(_, known, _)| off(i) < off(known)) {
                    best = Some((axis, i, middle));
                }
            }
        }
        let Some((axis, count, at)) = best else {
            return false;
        };
        of.sort_by(|&a, &b| boxes[a as usize].min[axis].total_cmp(&boxes[b as usize].min[axis]));
        let (low, high) = of.split_at_mut(count);
        let first = self.nodes.len() as u32;
        if !self.add_boxes(boxes, low) {
            return false;
        }
        let second = self.nodes.len() as u32;
        self.nodes[here] = Node::Cut {
            axis,
            at,
            parts: [first, second],
        };
        self.add_boxes(boxes, high)
    }

    /// Returns tiles with at most about `most` points each, if points are spread as is stated.
    ///
    /// # Complexity
    /// Linear in the boxes for each level of cuts.
    pub fn balanced(spreads: &[Spread], most: f64) -> Self {
        let mut layout = TileLayout { nodes: Vec::new() };
        let mut tiles = 0;
        layout.add_balanced(spreads.to_vec(), most, &mut tiles, 0);
        layout
    }

    fn add_balanced(
        &mut self,
        spreads: Vec<Spread>,
        most: f64,
        tiles: &mut u32,
        depth: usize,
    ) -> u32 {
        let here = self.nodes.len();
        self.nodes.push(Node::Tile(*tiles));
        let count: f64 = spreads.iter().map(|spread| spread.count).sum();
        let side = |axis: usize| {
            let low = spreads
                .iter()
                .map(|spread| spread.min[axis])
                .fold(f64::INFINITY, f64::min);
            let high = spreads
                .iter()
                .map(|spread| spread.max[axis])
                .fold(f64::NEG_INFINITY, f64::max);
            [low, high]
        };
        let sides = [side(0), side(1)];
        let axis = usize::from(sides[1][1] - sides[1][0] > sides[0][1] - sides[0][0]);
        let [low, high] = sides[axis];
        if count <= most
            || depth == DEEPEST
            || low.partial_cmp(&high) != Some(std::cmp::Ordering::Less)
        {
            *tiles += 1;
            return here as u32;
        }
        let below = |at: f64| {
            spreads
                .iter()
                .map(|spread| spread.split(axis, at)[0].count)
                .sum::<f64>()
        };
        let (mut from, mut to) = (low, high);
        for _ in 0..40 {
            let middle = f64::midpoint(from, to);
            *(if below(middle) < count / 2.0 {
                &mut from
            } else {
                &mut to
            }) = middle;
        }
        let half = |k: usize| -> Vec<Spread> {
            spreads
                .iter()
                .map(|spread| spread.split(axis, to)[k])
                .filter(|spread| spread.count > 0.0)
                .collect()
        };
        let halves = [half(0), half(1)];
        drop(spreads);
        let parts = halves.map(|half| self.add_balanced(half, most, tiles, depth + 1));
        self.nodes[here] = Node::Cut {
            axis,
            at: to,
            parts,
        };
        here as u32
    }

    /// Returns the layout with these tiles and cuts; `None` if they do not form a tree.
    pub fn from_nodes(nodes: Vec<Node>) -> Option<Self> {
        let mut uses = vec![0; nodes.len()];
        for (here, node) in nodes.iter().enumerate() {
            let Node::Cut { axis, at, parts } = node else {
                continue;
            };
            let is_later = |part: &u32| *part as usize > here && (*part as usize) < nodes.len();
            if *axis > 1 || !at.is_finite() || !parts.iter().all(is_later) {
                return None;
            }
            parts.iter().for_each(|&part| uses[part as usize] += 1);
        }
        let mut numbers: Vec<u32> = nodes.iter().filter_map(|node| node.tile()).collect();
        numbers.sort_unstable();
        let is_tree = uses.first() == Some(&0) && uses[1..].iter().all(|&count| count == 1);
        (is_tree && numbers.into_iter().eq(0..nodes.len().div_ceil(2) as u32))
            .then_some(TileLayout { nodes })
    }

    /// Returns the tiles and cuts; the root is the first.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns the number of tiles.
    pub fn tile_count(&self) -> usize {
        self.nodes.len().div_ceil(2)
    }

    /// Returns the number of the tile that owns a position, in as many steps as cuts are nested.
    pub fn tile_of(&self, position: [f64; 2]) -> u32 {
        let mut here = 0;
        loop {
            match self.nodes[here] {
                Node::Tile(number) => return number,
                Node::Cut { axis, at, parts } => {
                    here = parts[usize::from(position[axis] >= at)] as usize
                }
            }
        }
    }

    /// Calls `each` with the number of each tile that has a part of a closed box.
    pub fn tiles_in(&self, min: [f64; 2], max: [f64; 2], each: &mut dyn FnMut(u32)) {
        let mut open = vec![0];
        while let Some(here) = open.pop() {
            match self.nodes[here as usize] {
                Node::Tile(number) => each(number),
                Node::Cut { axis, at, parts } => {
                    if min[axis] < at {
                        open.push(parts[0]);
                    }
                    if max[axis] >= at {
                        open.push(parts[1]);
                    }
                }
            }
        }
    }

    /// Returns the steps of a triangulation, such that each step comes after those that it merges,
    /// and soon after them. The last one covers the plane.
    pub fn steps(&self) -> Vec<TileStep> {
        let mut steps = Vec::new();
        let open = self.gather(0, Tile::PLANE, &mut steps);
        if open.len() > 1 {
            steps.push(TileStep {
                tile: Tile::PLANE,
                work: Work::Merge(open),
            });
        }
        steps
    }

    /// Adds the steps for a node. Returns those that are to be merged.
    fn gather(&self, node: u32, tile: Tile, steps: &mut Vec<TileStep>) -> Vec<usize> {
        match self.nodes[node as usize] {
            Node::Tile(number) => {
                steps.push(TileStep {
                    tile,
                    work: Work::Leaf(number),
                });
                vec![steps.len() - 1]
            }
            Node::Cut { axis, at, parts } => {
                let mut halves = [tile; 2];
                (halves[0].max[axis], halves[1].min[axis]) = (at, at);
                let mut open = [0, 1].map(|k| (self.gather(parts[k], halves[k], steps), halves[k]));
                // The longer list first.
                open.sort_by_key(|(open, _)| std::cmp::Reverse(open.len()));
                for i in 0..2 {
                    if open[0].0.len() + open[1].0.len() > FAN {
                        let merged = std::mem::take(&mut open[i].0);
                        steps.push(TileStep {
                            tile: open[i].1,
                            work: Work::Merge(merged),
                        });
                        open[i].0.push(steps.len() - 1);
                    }
                }
                let [(mut all, _), (others, _)] = open;
                all.extend(others);
                all.sort_unstable();
                all
            }
        }
    }
}

impl Node {
    fn tile(&self) -> Option<u32> {
        match *self {
            Node::Tile(number) => Some(number),
            Node::Cut { .. } => None,
        }
    }
}

impl Spread {
    /// Returns true if a position is in the box.
    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        self.min[0] <= x && x <= self.max[0] && self.min[1] <= y && y <= self.max[1]
    }

    /// Returns the parts below and above a cut.
    fn split(&self, axis: usize, at: f64) -> [Spread; 2] {
        let length = self.max[axis] - self.min[axis];
        let share = if length > 0.0 {
            ((at - self.min[axis]) / length).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(self.max[axis] < at))
        };
        let mut parts = [*self; 2];
        (parts[0].count, parts[1].count) = (self.count * share, self.count * (1.0 - share));
        (parts[0].max[axis], parts[1].min[axis]) = (self.max[axis].min(at), self.min[axis].max(at));
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// Every position is in the tile that is said to own it, and in no other; merges join tiles to
    /// rectangles.
    fn check(layout: &TileLayout, random: &mut Random) {
        let steps = layout.steps();
        let tile = |number: u32| {
            steps
                .iter()
                .find(|step| step.work == Work::Leaf(number))
                .unwrap()
                .tile
        };
        let mut cuts = vec![-1.0, 0.0, 0.5, 1.0, 2.0];
        cuts.extend(layout.nodes().iter().filter_map(|node| match node {
            Node::Cut { at, .. } => Some(*at),
            Node::Tile(_) => None,
        }));
        for _ in 0..200 {
            let position = [0, 1].map(|_| {
                cuts[random.index(cuts.len())] + [0.0, 1e-3, random.unit()][random.index(3)]
            });
            let owner = layout.tile_of(position);
            for number in 0..layout.tile_count() as u32 {
                assert_eq!(tile(number).holds(position), number == owner);
            }
            let far = position.map(|at| at + [0.0, 0.7][random.index(2)]);
            let mut met = Vec::new();
            layout.tiles_in(position, far, &mut |number| met.push(number));
            met.sort_unstable();
            let meets = |number: &u32| {
                let Tile { min, max } = tile(*number);
                (0..2).all(|k| position[k] < max[k] && far[k] >= min[k])
            };
            assert!(
                met.into_iter()
                    .eq((0..layout.tile_count() as u32).filter(meets))
            );
        }
        let mut merged = vec![0; steps.len()];
        for (at, step) in steps.iter().enumerate() {
            let Work::Merge(parts) = &step.work else {
                continue;
            };
            assert!((2..=FAN).contains(&parts.len()));
            for &part in parts {
                assert!(part < at);
                merged[part] += 1;
                let Tile { min, max } = steps[part].tile;
                assert!((0..2).all(|k| step.tile.min[k] <= min[k] && max[k] <= step.tile.max[k]));
            }
        }
        let (root, others) = merged.split_last().unwrap();
        assert!(
            *root == 0
                && others.iter().all(|&count| count == 1)
                && steps.last().unwrap().tile.is_plane()
        );
        assert_eq!(
            TileLayout::from_nodes(layout.nodes().to_vec()).as_ref(),
            Some(layout)
        );
    }

    #[test]
    fn tiles_cover_the_plane_once() {
        let mut random = Random(2);
        for counts in [[1, 1], [4, 4], [7, 3], [1, 20], [9, 9]] {
            let layout = TileLayout::grid([0.0, -1.0], [10.0, 3.0], counts);
            assert_eq!(layout.tile_count(), counts[0] * counts[1]);
            check(&layout, &mut random);
        }
        let spread = |x: f64, y: f64, size: f64, count: f64| Spread {
            min: [x, y],
            max: [x + size, y + size],
            count,
        };
        let files = [
            spread(0.0, 0.0, 9.9, 500.0),
            spread(10.0, 0.0, 9.9, 4_000.0),
            spread(0.0, 10.0, 0.0, 90.0),
        ];
        let layout = TileLayout::balanced(&files, 100.0);
        assert!(
            (46..=92).contains(&layout.tile_count()),
            "{}",
            layout.tile_count()
        );
        check(&layout, &mut random);
        // Sites that coincide end the division.
        check(
            &TileLayout::balanced(&[spread(1.0, 1.0, 0.0, 1e9)], 10.0),
            &mut random,
        );
        check(&TileLayout::balanced(&[], 10.0), &mut random);
    }

    #[test]
    fn files_that_are_tiles_keep_their_numbers() {
        let mut random = Random(3);
        let tile = |column: usize, row: usize| {
            let min = [column as f64 * 10.0, row as f64 * 10.0];
            Spread {
                min,
                max: min.map(|at| at + 9.99),
                count: 1.0,
            }
        };
        let mut files: Vec<Spread> = (0..35).map(|k| tile(k % 7, k / 7)).collect();
        files.remove(11);
        let layout = TileLayout::of_boxes(&files).unwrap();
        check(&layout, &mut random);
        for (number, file) in files.iter().enumerate() {
            assert_eq!(
                (layout.tile_of(file.min), layout.tile_of(file.max)),
                (number as u32, number as u32)
            );
        }
        // Touching, and overlapping without a cut between.
        assert_eq!(
            TileLayout::of_boxes(&[
                tile(0, 0),
                Spread {
                    min: [9.99, 0.0],
                    ..tile(1, 0)
                }
            ]),
            None
        );
        let wheel = [
            [0.0, 0.0, 2.0, 1.0],
            [2.5, 0.0, 3.5, 2.0],
            [1.5, 2.5, 3.5, 3.5],
            [0.0, 1.5, 1.0, 3.5],
        ];
        let wheel = wheel.map(|[x, y, x1, y1]| Spread {
            min: [x, y],
            max: [x1, y1],
            count: 1.0,
        });
        assert_eq!(TileLayout::of_boxes(&wheel), None);
        assert_eq!(TileLayout::of_boxes(&[]), None);
    }

    #[test]
    fn lists_that_are_no_division_are_refused() {
        let cut = |parts| Node::Cut {
            axis: 0,
            at: 1.0,
            parts,
        };
        for nodes in [
            vec![],
            vec![Node::Tile(1)],
            vec![cut([1, 2]), Node::Tile(0), Node::Tile(0)],
            vec![cut([1, 1]), Node::Tile(0), Node::Tile(1)],
            vec![cut([1, 3]), Node::Tile(0), Node::Tile(1)],
            vec![cut([0, 1]), Node::Tile(0), Node::Tile(1)],
            vec![
                Node::Cut {
                    axis: 2,
                    at: 1.0,
                    parts: [1, 2],
                },
                Node::Tile(0),
                Node::Tile(1),
            ],
            vec![
                Node::Cut {
                    axis: 0,
                    at: f64::NAN,
                    parts: [1, 2],
                },
                Node::Tile(0),
                Node::Tile(1),
            ],
        ] {
            assert_eq!(TileLayout::from_nodes(nodes.clone()), None, "{nodes:?}");
        }
    }
}
