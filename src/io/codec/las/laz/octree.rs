//! The octree of a COPC file (COPC 1.0): which chunk holds the points of which node.
//!
//! All pages of the hierarchy are read, 32 bytes for each node, so that each chunk is known to
//! belong to one node: an index that omits points is noticed. The chunk table of LASzip says
//! where chunks are; what the hierarchy says must agree.

use std::collections::{HashMap, HashSet};

use super::table::Chunk;
use crate::data::{Bounds, PointBatch};
use crate::error::{Command, Error, Result, wording};
use crate::io::bytes::little_endian::{f64_at, u32_at, u64_at};
use crate::io::codec::las::input::Input;
use crate::io::codec::las::node::{DEEPEST, ENTRY, INFO, Key};

/// The place of the record that describes the octree, in errors.
const RECORD: &str = "record \"copc\"";

/// The rounding of the numbers from which borders of nodes are computed, in units of the last
/// place.
const ROUNDING: f64 = 16.0;

/// How far points may be outside of the octree, as a share of its side. A shared file has points
/// 0.00001 of it outside.
const OUTSIDE: f64 = 1.0 / 1024.0;

/// The octree of a file.
#[derive(Debug)]
pub(super) struct Octree {
    /// The lowest corner of the root, in plan.
    low: [f64; 2],
    /// The length of its edges.
    side: f64,
    /// The distance of points on the first level.
    spacing: f64,
    /// By how much points may be outside of their node, because coordinates are rounded.
    slack: [f64; 2],
    /// The node of each chunk.
    nodes: Vec<Key>,
}

/// A part of the hierarchy, which lists nodes below one.
struct Page {
    key: Key,
    start: u64,
    bytes: u64,
}

impl Octree {
    /// Reads the hierarchy. `info` is the record that describes it, `scale` the step of
    /// coordinates, `chunks` are those of the whole file.
    ///
    /// # Errors
    /// If the hierarchy is damaged, or does not agree with the chunks.
    pub(super) fn read(
        input: &mut Input,
        info: &[u8],
        scale: [f64; 3],
        chunks: &[Chunk],
    ) -> Result<Self> {
        let mut octree = Octree::of(info, scale)?;
        let first = Page {
            key: Key::ROOT,
            start: u64_at(info, 40),
            bytes: u64_at(info, 48),
        };
        octree.nodes = Hierarchy::read(input, first, chunks)?.nodes_of(chunks)?;
        Ok(octree)
    }

    fn of(info: &[u8], scale: [f64; 3]) -> Result<Self> {
        if info.len() < INFO {
            return Err(damaged(
                format!("it has {} bytes, expected {INFO}", info.len()),
                RECORD.to_owned(),
            ));
        }
        let [x, y, half, spacing] = [0, 8, 24, 32].map(|start| f64_at(info, start));
        let (low, side) = ([x - half, y - half], 2.0 * half);
        let is_cube = half > 0.0
            && [low[0], low[1], low[0] + side, low[1] + side, side]
                .iter()
                .all(|c| c.is_finite());
        if !is_cube {
            return Err(damaged(
                format!("the octree is said to be {side} wide around {x} {y}"),
                RECORD.to_owned(),
            ));
        }
        let slack = [0, 1].map(|k: usize| {
            let farthest = low[k].abs().max((low[k] + side).abs());
            scale[k].abs() + ROUNDING * f64::EPSILON * farthest
        });
        Ok(Octree {
            low,
            side,
            spacing,
            slack,
            nodes: Vec::new(),
        })
    }

    /// Returns true if a chunk may have points in a window, in plan, and for that of the root: its
    /// points show whether the octree is where the points are.
    pub(super) fn meets(&self, chunk: &Chunk, window: &Bounds) -> bool {
        let key = self.node(chunk);
        let [min, max] = self.cell(key);
        key == Key::ROOT || (0..2).all(|k| min[k] <= window.max[k] && window.min[k] <= max[k])
    }

    /// Returns the level of a chunk, from 0 on.
    pub(super) fn level(&self, chunk: &Chunk) -> u32 {
        self.node(chunk).level
    }

    /// Returns the first level on which points are at most `spacing` apart.
    ///
    /// # Errors
    /// If the file does not say how far apart they are.
    pub(super) fn level_of(&self, spacing: f64) -> Result<u32> {
        if !(self.spacing > 0.0 && self.spacing.is_finite()) {
            return Err(damaged(
                format!(
                    "the points of its first level are said to be {} apart",
                    self.spacing
                ),
                RECORD.to_owned(),
            ));
        }
        let is_fine = |&level: &u32| self.spacing / side_count(level) <= spacing;
        Ok((0..DEEPEST).find(is_fine).unwrap_or(DEEPEST))
    }

    /// Returns an error if a point of a chunk is outside of its node: other points may be, too, and
    /// some of those may have been left out.
    pub(super) fn check(&self, chunk: &Chunk, batch: &PointBatch) -> Result<()> {
        let key = self.node(chunk);
        let [min, max] = self.cell(key);
        let is_in =
            |&(&x, &y): &(&f64, &f64)| min[0] <= x && x <= max[0] && min[1] <= y && y <= max[1];
        let mut points = batch.x.iter().zip(&batch.y);
        match points.find(|point| !is_in(point)) {
            None => Ok(()),
            Some((x, y)) => Err(damaged(
                format!(
                    "the point at {x} {y} is outside of its node {key}, which is from {} {} to \
                     {} {}",
                    min[0], min[1], max[0], max[1]
                ),
                format!("chunk {} at byte {}", chunk.number, chunk.start),
            )),
        }
    }

    fn node(&self, chunk: &Chunk) -> Key {
        self.nodes[chunk.number - 1]
    }

    /// Returns the corners of a node in plan, enlarged by what rounding may add. Points just
    /// outside of the octree, which programs write, are in the nodes at its border.
    fn cell(&self, Key { level, at }: Key) -> [[f64; 2]; 2] {
        let count = side_count(level);
        let step = self.side / count;
        let slack = |k: usize, number: f64| match number == 0.0 || number == count {
            true => self.slack[k] + self.side * OUTSIDE,
            false => self.slack[k],
        };
        let border = |k: usize, number: f64| self.low[k] + number * step;
        let [low, high] = [0.0, 1.0].map(|up| at.map(|at| f64::from(at) + up));
        [
            [0, 1].map(|k| border(k, low[k]) - slack(k, low[k])),
            [0, 1].map(|k| border(k, high[k]) + slack(k, high[k])),
        ]
    }
}

/// Returns how many nodes there are on a level along each axis.
fn side_count(level: u32) -> f64 {
    (1_u64 << level) as f64
}

/// The entries of all pages, while they are read.
struct Hierarchy {
    /// All nodes, also those without points.
    nodes: HashSet<Key>,
    /// The node of each chunk.
    of_chunks: Vec<Option<Key>>,
}

impl Hierarchy {
    fn read(input: &mut Input, first: Page, chunks: &[Chunk]) -> Result<Self> {
        let starts: HashMap<u64, usize> = (0..)
            .zip(chunks)
            .map(|(i, chunk)| (chunk.start, i))
            .collect();
        let mut hierarchy = Hierarchy {
            nodes: HashSet::new(),
            of_chunks: vec![None; chunks.len()],
        };
        let (mut pages, mut keys_of_pages) = (vec![first], HashSet::from([Key::ROOT]));
        // A page that is listed twice would list its nodes twice; pages that overlap end here.
        let mut room = input.length;
        while let Some(Page { key, start, bytes }) = pages.pop() {
            let is_there = start
                .checked_add(bytes)
                .is_some_and(|end| end <= input.length);
            if bytes == 0 || !bytes.is_multiple_of(ENTRY as u64) || !is_there || bytes > room {
                let what = format!(
                    "the page of node {key} is said to have {bytes} bytes, expected entries of \
                     {ENTRY} bytes within the {} of the file",
                    input.length
                );
                return Err(damaged(what, format!("byte {start}")));
            }
            room -= bytes;
            let page = input.bytes(start, bytes as usize)?;
            for (entry, at) in page
                .as_chunks::<ENTRY>()
                .0
                .iter()
                .zip((start..).step_by(ENTRY))
            {
                let below = hierarchy
                    .add(entry, key, &starts, chunks)
                    .map_err(|what| damaged(what, format!("byte {at}")))?;
                let Some(below) = below else { continue };
                if !keys_of_pages.insert(below.key) {
                    let what = format!("node {} has a second page", below.key);
                    return Err(damaged(what, format!("byte {at}")));
                }
                pages.push(below);
            }
        }
        Ok(hierarchy)
    }

    /// Adds an entry of the page of a node. Returns the page, if it is one.
    fn add(
        &mut self,
        entry: &[u8; ENTRY],
        above: Key,
        starts: &HashMap<u64, usize>,
        chunks: &[Chunk],
    ) -> std::result::Result<Option<Page>, String> {
        let Some(key) = Key::of(entry) else {
            let [level, x, y, z] = [0, 4, 8, 12].map(|start| u32_at(entry, start).cast_signed());
            return Err(format!("there is no node {level}-{x}-{y}-{z} in an octree"));
        };
        if !key.is_part_of(above) {
            return Err(format!(
                "node {key} is on the page of node {above}, which it is not part of"
            ));
        }
        let start = u64_at(entry, 16);
        let [bytes, points] = [24, 28].map(|start| u32_at(entry, start).cast_signed());
        let stated = || {
            format!("node {key} is said to have {points} points in {bytes} bytes at byte {start}")
        };
        let (Ok(bytes), -1..) = (u64::try_from(bytes), points) else {
            return Err(stated());
        };
        if points == -1 {
            return Ok(Some(Page { key, start, bytes }));
        }
        if !self.nodes.insert(key) {
            return Err(format!("node {key} is listed a second time"));
        }
        if points > 0 {
            let chunk = starts.get(&start).copied().filter(|&chunk| {
                chunks[chunk].bytes == bytes && chunks[chunk].points == points as u64
            });
            let Some(chunk) = chunk else {
                return Err(format!("{}, where no such chunk is", stated()));
            };
            if let Some(other) = self.of_chunks[chunk].replace(key) {
                return Err(format!("node {key} has the points of node {other}"));
            }
        }
        Ok(None)
    }

    /// Returns the node of each chunk.
    ///
    /// # Errors
    /// If a node has none above it, or a chunk no node.
    fn nodes_of(self, chunks: &[Chunk]) -> Result<Vec<Key>> {
        let is_known = |key: &Key| key.level == 0 || self.nodes.contains(&key.on(key.level - 1));
        let of_chunk = |(chunk, key): (&Chunk, Option<Key>)| {
            let what = match key {
                Some(key) if is_known(&key) => return Ok(key),
                Some(key) => format!("node {key} is not below another node"),
                None => format!("no node has the points of chunk {}", chunk.number),
            };
            Err(damaged(what, format!("chunk at byte {}", chunk.start)))
        };
        chunks
            .iter()
            .zip(self.of_chunks.iter().copied())
            .map(of_chunk)
            .collect()
    }
}

#[cold]
fn damaged(what: String, location: String) -> Error {
    Error::format(format!("the octree is damaged: {what}"))
        .at(location)
        .cure(wording![
            "copy or download the file again, or use a copy without an octree, as ",
            Command::Points,
            " writes it of the whole file"
        ])
}
