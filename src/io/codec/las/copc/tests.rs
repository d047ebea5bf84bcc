//! The division is judged by its laws, and is the same wherever the records are.

use std::collections::{BTreeMap, BTreeSet};

use testkit::random::Random;

use super::divide::{Cube, Divider, Node, Sizes};
use super::hierarchy::{Chunk, Hierarchy};
use super::list::List;
use super::widen::Widening;
use crate::data::{Bounds, Lattice, PointBatch};
use crate::error::Kind;
use crate::io::bytes::little_endian::{u32_at, u64_at};
use crate::io::codec::las::Detail;
use crate::io::codec::las::header::Header;
use crate::io::codec::las::node::{ENTRY, Key};
use crate::io::codec::las::record::RecordLayout;

const STRIDE: usize = 16;

const LATTICE: Lattice = Lattice {
    scale: [0.5, 0.5, 0.25],
    offset: [10.0, -3.0, 0.0],
};

const SIZES: Sizes = Sizes {
    leaf: 40,
    least: 5,
    most: 1000,
    held: u64::MAX,
};

/// Records of points on a small grid, many at one position, each with its number.
fn records(count: u32, side: usize) -> Vec<u8> {
    let mut random = Random(11);
    let record = |number: u32| {
        let steps = [0, 1, 2].map(|k| random.index([side, side, 4][k]) as i32 - 7);
        let mut record: Vec<u8> = steps.iter().flat_map(|at| at.to_le_bytes()).collect();
        record.extend(number.to_le_bytes());
        record
    };
    (0..count).flat_map(record).collect()
}

fn cube(side: f64) -> Cube {
    let bounds = Bounds {
        min: LATTICE.point([-7; 3]),
        max: LATTICE.point([side as i32 - 8, side as i32 - 8, -4]),
    };
    Cube::around(&bounds, LATTICE).unwrap()
}

fn divided(records: &[u8], side: f64, sizes: Sizes) -> crate::error::Result<Vec<Node>> {
    let divider = Divider {
        cube: cube(side),
        sizes,
        stride: STRIDE,
    };
    let mut all = Vec::new();
    let mut list = List::held(STRIDE, records.to_vec());
    let scratch = || Ok(tempfile::tempfile()?);
    if list.bytes() > sizes.held {
        list = list.file(tempfile::tempfile()?)?;
    }
    divider.divide(Key::ROOT, list, &scratch, &mut |nodes| {
        all.extend(nodes);
        Ok(())
    })?;
    Ok(all)
}

#[test]
fn each_point_is_in_one_node_and_within_it() {
    for (count, side) in [(1, 8), (40, 8), (41, 8), (3000, 8), (3000, 512), (5000, 64)] {
        let all = records(count, side);
        let nodes = divided(&all, side as f64, SIZES).unwrap();
        let mut found = BTreeSet::new();
        let mut keys = BTreeSet::new();
        let cube = cube(side as f64);
        for Node { key, records } in &nodes {
            assert!(keys.insert(*key) && !records.is_empty());
            assert!(
                key.level == 0 || keys.contains(&key.on(key.level - 1)),
                "{key}"
            );
            let width = 2.0 * cube.half / f64::from(1 << key.level);
            for record in records.chunks_exact(STRIDE) {
                let number = u32::from_le_bytes(record[12..].try_into().unwrap());
                assert!(found.insert(number));
                assert_eq!(record, &all[number as usize * STRIDE..][..STRIDE]);
                for k in 0..3 {
                    let steps = i32::from_le_bytes(record[4 * k..][..4].try_into().unwrap());
                    let at = f64::from(steps) * LATTICE.scale[k] + LATTICE.offset[k];
                    let low = cube.center[k] - cube.half + f64::from(key.at[k]) * width;
                    assert!(low <= at + 1e-9 && at <= low + width + 1e-9, "{key} {at}");
                }
            }
        }
        assert_eq!(found.len(), count as usize);
        // Of a few more than a leaf has, too few may be left for nodes below.
        assert!((nodes.len() == 1) == (count <= 41), "{count} {side}");
    }
}

/// A node that has others below it has a point of each cell in which it was given one, and few of
/// another.
#[test]
fn the_points_of_a_level_are_spread_evenly() {
    let side = 512;
    let nodes = divided(&records(20_000, side), side as f64, SIZES).unwrap();
    let cube = cube(side as f64);
    let cell = |record: &[u8], level: u32| {
        let width = 2.0 * cube.half / f64::from(1_u32 << (7 + level));
        [0, 1, 2].map(|k| {
            let steps = i32::from_le_bytes(record[4 * k..][..4].try_into().unwrap());
            let at = f64::from(steps) * LATTICE.scale[k] + LATTICE.offset[k];
            ((at - cube.center[k] + cube.half) / width) as u32
        })
    };
    let root = &nodes[0];
    assert_eq!(root.key, Key::ROOT);
    let cells_of = |records: &[u8]| -> BTreeMap<[u32; 3], usize> {
        let mut counts = BTreeMap::new();
        for record in records.chunks_exact(STRIDE) {
            *counts.entry(cell(record, 0)).or_default() += 1;
        }
        counts
    };
    let own = cells_of(&root.records);
    let all: Vec<u8> = nodes.iter().flat_map(|node| node.records.clone()).collect();
    assert!(cells_of(&all).keys().eq(own.keys()));
    // Not more than those that nodes below would have had too few of.
    let double: usize = own.values().map(|count| count - 1).sum();
    assert!(double < 8 * SIZES.least as usize, "{double}");
}

#[test]
fn the_nodes_do_not_depend_on_where_records_are_held() {
    for (count, side) in [(3000, 8), (3000, 512)] {
        let all = records(count, side);
        let expected = divided(&all, side as f64, SIZES).unwrap();
        assert!(expected.len() > 3);
        for held in [0, 1000, 20_000] {
            let sizes = Sizes { held, ..SIZES };
            assert!(
                divided(&all, side as f64, sizes).unwrap() == expected,
                "{held}"
            );
        }
    }
    let all = records(3000, 8);
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let alone = one.install(|| divided(&all, 8.0, SIZES).unwrap());
    assert!(alone == divided(&all, 8.0, SIZES).unwrap());
}

#[test]
fn each_node_is_on_one_page_below_the_first() {
    let mut random = Random(2);
    let mut keys = BTreeSet::from([Key::ROOT]);
    for _ in 0..40 {
        let mut key = Key::ROOT;
        for _ in 0..random.index(13) {
            key = key.below(random.index(8));
            keys.insert(key);
        }
    }
    let chunk = |(number, &key): (usize, &Key)| Chunk {
        key,
        start: 500 + number as u64,
        bytes: number as u32,
        points: number as i32 + 1,
    };
    let chunks: Vec<Chunk> = keys.iter().enumerate().map(chunk).collect();
    let start = 10_000;
    let Hierarchy { pages, first } = Hierarchy::of(&chunks, start);
    let mut listed = BTreeMap::new();
    let mut waiting = vec![(Key::ROOT, start, first)];
    let (mut read, mut count) = (0, 0);
    while let Some((above, at, bytes)) = waiting.pop() {
        (read, count) = (read + bytes, count + 1);
        let page = &pages[(at - start) as usize..][..bytes as usize];
        for entry in page.chunks_exact(ENTRY) {
            let key = Key::of(entry).unwrap();
            assert!(key.is_part_of(above) && key.level <= above.level + 5);
            let (at, bytes) = (u64_at(entry, 16), u32_at(entry, 24));
            match u32_at(entry, 28).cast_signed() {
                -1 => waiting.push((key, at, bytes.into())),
                points => drop(listed.insert(key, (at, bytes, points))),
            }
        }
    }
    let expected = chunks.iter().map(|c| (c.key, (c.start, c.bytes, c.points)));
    assert!(listed == expected.collect());
    assert!(read == pages.len() as u64 && count > 20, "{count}");
}

#[test]
fn too_many_points_at_one_position_are_an_error() {
    let all = records(1, 8).repeat(1200);
    let error = divided(&all, 8.0, SIZES).unwrap_err();
    assert_eq!(error.kind(), Kind::Limit);
    assert!(error.cure_text().is_some());
    // Levels take some of them.
    assert!(divided(&all[..STRIDE * 1010], 8.0, SIZES).is_ok());
}

/// A reader of the new records has the values of the old ones, and each field can be got back.
#[test]
fn wider_records_have_the_same_values() {
    let mut random = Random(5);
    for (format, length) in [(0, 20), (1, 28), (2, 26), (3, 34), (3, 41)] {
        let widening = Widening::of(format, length).unwrap();
        let new_length = usize::from(widening.length().unwrap());
        let (mut old, mut new) = (Vec::new(), Vec::new());
        for _ in 0..300 {
            let mut record: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
            record[16] = (random.below(181) as i8).wrapping_sub(90).cast_unsigned();
            widening.append(&record, &mut new);
            old.extend(record);
        }
        let columns = |format: u8, length: usize, records: &[u8]| {
            let mut header = vec![0; 375];
            header[..4].copy_from_slice(b"LASF");
            header[24..26].copy_from_slice(&[1, 4]);
            header[94..96].copy_from_slice(&375_u16.to_le_bytes());
            header[96..100].copy_from_slice(&375_u32.to_le_bytes());
            header[104] = format;
            header[105..107].copy_from_slice(&(length as u16).to_le_bytes());
            for at in [131, 139, 147] {
                header[at..at + 8].copy_from_slice(&0.5_f64.to_le_bytes());
            }
            let header = Header::check(&header, 375, &mut Vec::new()).unwrap();
            let mut batch = PointBatch::default();
            RecordLayout::new(&header, Detail::Columns).append(records, &mut batch);
            batch
        };
        let before = columns(format, length.into(), &old);
        let after = columns(widening.format(), new_length, &new);
        assert_eq!((before.x, before.y, before.z), (after.x, after.y, after.z));
        assert_eq!((before.class, before.flags), (after.class, after.flags));
        assert_eq!(before.return_number, after.return_number);
        assert_eq!(before.return_count, after.return_count);
        let pairs = old
            .chunks_exact(length.into())
            .zip(new.chunks_exact(new_length));
        for (old, new) in pairs {
            assert_eq!(old[12..14], new[12..14]);
            assert_eq!(old[14] >> 6, new[15] >> 6);
            assert_eq!(old[17], new[17]);
            let angle = f64::from(i16::from_le_bytes([new[18], new[19]])) * 0.006;
            assert_eq!(old[16].cast_signed(), angle.round() as i8);
            assert_eq!(old[18..20], new[20..22]);
            let (time, rest) = if matches!(format, 1 | 3) {
                (&old[20..28], &old[28..])
            } else {
                (&[0; 8][..], &old[20..])
            };
            assert_eq!((time, rest), (&new[22..30], &new[30..]));
        }
    }
    assert!((4..11).all(|format| Widening::of(format, 60).is_none()));
    assert!(Widening::of(0, u16::MAX).unwrap().length().is_err());
}
