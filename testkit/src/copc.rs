//! Small COPC files.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use laz::laszip::LasZipCompressor;
use laz::{LazVlr, LazVlrBuilder};

/// Bytes of a record of point format 6.
pub const RECORD: usize = 30;

/// The step of coordinates.
pub const STEP: f64 = 0.01;

/// Where the record that describes the octree is.
pub const INFO: usize = 429;

/// Bytes of an entry of the hierarchy.
pub const ENTRY: usize = 32;

const HEADER: usize = 375;

/// How points are divided among nodes.
pub struct Tree {
    /// The lowest corner of the root, in steps.
    pub low: [i32; 3],
    /// The length of its edges, in steps: a power of two.
    pub side: i32,
    /// The most points of a node that has others below it.
    pub most: usize,
    /// The levels that each page of the hierarchy lists.
    pub levels_of_page: u32,
}

/// A node with points.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    pub level: u32,
    pub at: [i32; 3],
    /// Where its chunk is in the file.
    pub start: usize,
    pub bytes: usize,
    pub points: usize,
}

impl Node {
    /// Returns the lowest corner in steps, and the length of the edges.
    pub fn cube(&self, tree: &Tree) -> ([i32; 3], i32) {
        let side = tree.side >> self.level;
        ([0, 1, 2].map(|k| tree.low[k] + self.at[k] * side), side)
    }
}

/// A file, and what is where in it.
pub struct Copc {
    pub bytes: Vec<u8>,
    /// In the order of their chunks.
    pub nodes: Vec<Node>,
    /// Where each page of the hierarchy is, and how long it is.
    pub pages: Vec<(usize, usize)>,
}

type Key = (u32, [i32; 3]);

/// Returns a COPC file of point format 6 with these points, in steps. The time of a point is its
/// position in the list, its class is 2 for even ones, else 1.
///
/// Each point is in the highest node that has room for it. The chunks are in no particular order.
pub fn copc(points: &[[i32; 3]], tree: &Tree) -> Copc {
    let mut nodes: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
    for (i, point) in points.iter().enumerate() {
        let mut key: Key = (0, [0; 3]);
        loop {
            let list = nodes.entry(key).or_default();
            if list.len() < tree.most || tree.side >> key.0 <= 1 {
                list.push(i);
                break;
            }
            let side = tree.side >> (key.0 + 1);
            let last = (1 << (key.0 + 1)) - 1;
            let at = [0, 1, 2].map(|k: usize| ((point[k] - tree.low[k]) / side).clamp(0, last));
            key = (key.0 + 1, at);
        }
    }
    let laz = LazVlrBuilder::default()
        .with_point_format(6, 0)
        .unwrap()
        .with_variable_chunk_size()
        .build();
    let mut laszip = Vec::new();
    laz.write_to(&mut laszip).unwrap();
    let points_start = INFO + 160 + 54 + laszip.len();

    let mut order: Vec<&Key> = nodes.keys().collect();
    order.sort_by_key(|(level, [x, y, z])| (x * 31 + y * 17 + z * 7) % 11 + (*level as i32 % 3));
    let mut cursor = Cursor::new(vec![0; points_start]);
    cursor.set_position(points_start as u64);
    let mut compressor = LasZipCompressor::new(cursor, laz).unwrap();
    let mut chunks = Vec::new();
    let mut start = points_start + 8;
    for (i, key) in order.iter().enumerate() {
        if i > 0 {
            compressor.finish_current_chunk().unwrap();
            let end = compressor.get().position() as usize;
            chunks.push((start, end - start));
            start = end;
        }
        for &point in &nodes[*key] {
            compressor
                .compress_one(&record(points[point], point))
                .unwrap();
        }
    }
    compressor.done().unwrap();
    let mut bytes = compressor.into_inner().into_inner();
    let table = u64::from_le_bytes(bytes[points_start..points_start + 8].try_into().unwrap());
    chunks.push((start, table as usize - start));
    let with_chunks = order.iter().zip(chunks).map(|(key, (start, bytes))| Node {
        level: key.0,
        at: key.1,
        start,
        bytes,
        points: nodes[*key].len(),
    });
    let nodes: Vec<Node> = with_chunks.collect();

    let evlr_start = bytes.len();
    let pages = hierarchy(&nodes, tree.levels_of_page, evlr_start + 60);
    let hierarchy: Vec<u8> = pages.iter().flat_map(|(_, page)| page.clone()).collect();
    bytes.extend([0; 2]);
    bytes.extend(padded::<16>("copc"));
    bytes.extend(1000_u16.to_le_bytes());
    bytes.extend((hierarchy.len() as u64).to_le_bytes());
    bytes.extend(padded::<32>("EPT Hierarchy"));
    bytes.extend(hierarchy);
    let pages: Vec<(usize, usize)> = pages
        .iter()
        .map(|(start, page)| (*start, page.len()))
        .collect();

    let mut head = Vec::new();
    head.extend(header(points, evlr_start, points_start));
    head.extend(record_header("copc", 1, 160));
    let half = f64::from(tree.side) * STEP / 2.0;
    let center = tree.low.map(|low| f64::from(low) * STEP + half);
    let info = [
        center[0],
        center[1],
        center[2],
        half,
        f64::from(tree.side) * STEP / 16.0,
    ];
    head.extend(info.iter().flat_map(|number| number.to_le_bytes()));
    head.extend((pages[0].0 as u64).to_le_bytes());
    head.extend((pages[0].1 as u64).to_le_bytes());
    head.resize(INFO + 160, 0);
    head.extend(record_header(
        LazVlr::USER_ID,
        LazVlr::RECORD_ID,
        laszip.len() as u16,
    ));
    head.extend(laszip);
    bytes[..head.len()].copy_from_slice(&head);
    Copc {
        bytes,
        nodes,
        pages,
    }
}

/// Returns the pages, the first of which is at `start`, each with its position.
fn hierarchy(nodes: &[Node], levels: u32, start: usize) -> Vec<(usize, Vec<u8>)> {
    // A page is that of the node whose level is a multiple of the levels of pages.
    let page_of = |level: u32, at: [i32; 3]| -> Key {
        let up = level % levels;
        (level - up, at.map(|at| at >> up))
    };
    let mut lists: BTreeMap<Key, Vec<&Node>> = BTreeMap::new();
    for node in nodes {
        lists
            .entry(page_of(node.level, node.at))
            .or_default()
            .push(node);
    }
    let below = |key: &Key| -> Vec<Key> {
        let of_page = |other: &&Key| {
            other.0 == key.0 + levels && page_of(other.0 - 1, other.1.map(|at| at >> 1)) == *key
        };
        lists.keys().filter(of_page).copied().collect()
    };
    let (mut starts, mut end) = (BTreeMap::new(), start);
    for (key, list) in &lists {
        let bytes = ENTRY * (list.len() + below(key).len());
        starts.insert(*key, (end, bytes));
        end += bytes;
    }
    let page = |(key, list): (&Key, &Vec<&Node>)| {
        let nodes = list.iter().map(|node| {
            entry(
                (node.level, node.at),
                node.start,
                node.bytes,
                node.points as i32,
            )
        });
        let pages = below(key).into_iter().map(|key| {
            let (start, bytes) = starts[&key];
            entry(key, start, bytes, -1)
        });
        (starts[key].0, nodes.chain(pages).flatten().collect())
    };
    lists.iter().map(page).collect()
}

fn entry((level, at): Key, start: usize, bytes: usize, points: i32) -> Vec<u8> {
    let mut entry = level.to_le_bytes().to_vec();
    entry.extend(at.iter().flat_map(|at| at.to_le_bytes()));
    entry.extend((start as u64).to_le_bytes());
    entry.extend((bytes as i32).to_le_bytes());
    entry.extend(points.to_le_bytes());
    entry
}

fn record(point: [i32; 3], i: usize) -> [u8; RECORD] {
    let mut record = [0; RECORD];
    let mut slots = record.chunks_exact_mut(4);
    point
        .iter()
        .zip(&mut slots)
        .for_each(|(steps, slot)| slot.copy_from_slice(&steps.to_le_bytes()));
    record[14] = 0x11;
    record[16] = 1 + u8::from(i.is_multiple_of(2));
    record[22..30].copy_from_slice(&(i as f64).to_le_bytes());
    record
}

fn header(points: &[[i32; 3]], evlr_start: usize, points_start: usize) -> Vec<u8> {
    let mut header = b"LASF".to_vec();
    header.resize(24, 0);
    header.extend([1, 4]);
    header.resize(94, 0);
    header.extend((HEADER as u16).to_le_bytes());
    header.extend((points_start as u32).to_le_bytes());
    header.extend(2_u32.to_le_bytes());
    header.push(6 | 0x80);
    header.extend((RECORD as u16).to_le_bytes());
    header.resize(131, 0);
    header.extend([STEP; 3].iter().flat_map(|step| step.to_le_bytes()));
    header.extend([0; 24]);
    for axis in 0..3 {
        let values = || points.iter().map(|point| point[axis]);
        for steps in [values().max(), values().min()] {
            let value = f64::from(steps.unwrap_or(0)) * STEP;
            header.extend(value.to_le_bytes());
        }
    }
    header.extend([0; 8]);
    header.extend((evlr_start as u64).to_le_bytes());
    header.extend(1_u32.to_le_bytes());
    header.extend((points.len() as u64).to_le_bytes());
    header.extend((points.len() as u64).to_le_bytes());
    header.resize(HEADER, 0);
    header
}

fn record_header(user: &str, id: u16, length: u16) -> Vec<u8> {
    let mut bytes = vec![0; 2];
    bytes.extend(padded::<16>(user));
    bytes.extend(id.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    bytes.extend([0; 32]);
    bytes
}

fn padded<const N: usize>(text: &str) -> [u8; N] {
    let mut field = [0; N];
    (&mut field[..]).write_all(text.as_bytes()).unwrap();
    field
}
