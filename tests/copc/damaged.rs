//! Damage of the index of an octree: each is an error that names the place, or changes no point.

use std::collections::BTreeSet;

use breakline::data::PointSource;
use breakline::error::Kind;
use breakline::io::OnDamage;
use breakline::io::las::{self as ours, Detail};
use testkit::copc::{ENTRY, INFO, RECORD, STEP};

use crate::{TREE, file_of, open, rest, square, within};

/// Each byte of the index, with its lowest or its highest bit flipped: an error that names the
/// place, or what reading everything gives. Only what says where nodes are may be wrong without
/// being found out, of nodes that are not read; then points are missing, but none is wrong.
#[test]
fn a_damaged_index_is_an_error_or_adds_nothing() {
    let file = file_of(300);
    let window = square([0.0, 505.0], 4.0);
    let all = within(
        rest(&mut open(&file.bytes, Detail::Records).unwrap()).unwrap(),
        &window,
    );
    let expected: BTreeSet<&[u8]> = all.records.chunks_exact(RECORD).collect();
    let of_cubes = (INFO..INFO + 32).map(|at| (at, true));
    let of_info = (INFO + 32..INFO + 160).map(|at| (at, false));
    let of_pages = file
        .pages
        .iter()
        .flat_map(|&(start, bytes)| (0..bytes).map(move |at| (start + at, at % ENTRY < 16)));
    let (mut errors, mut fewer, mut total) = (0, 0, 0);
    for (at, is_position) in of_cubes.chain(of_info).chain(of_pages) {
        for bit in [0, 7] {
            let mut bytes = file.bytes.clone();
            bytes[at] ^= 1 << bit;
            let mut source = open(&bytes, Detail::Records).unwrap();
            let read = source
                .narrow(&window)
                .and_then(|_| rest(&mut source))
                .map(|read| within(read, &window).records);
            total += 1;
            match read {
                Ok(read) if read == all.records => {}
                Ok(read) => {
                    assert!(is_position, "byte {at}, bit {bit}");
                    let mut records = read.chunks_exact(RECORD);
                    assert!(records.all(|record| expected.contains(record)));
                    fewer += 1;
                }
                Err(error) => {
                    errors += 1;
                    assert_eq!(error.kind(), Kind::Format);
                    let text = error.to_string();
                    assert!(text.starts_with("made.copc.laz: "), "{text}");
                    assert!(text.contains("the octree is damaged: "), "{text}");
                    assert!(error.cure_text().is_some());
                }
            }
            // Without bounds the index does not matter.
            if at % 97 == 0 {
                let whole = rest(&mut open(&bytes, Detail::Columns).unwrap()).unwrap();
                assert_eq!(whole.len(), 300);
            }
        }
    }
    assert!(errors * 2 > total, "{errors} of {total}");
    assert!(fewer * 50 < total, "{fewer} of {total}");
}

fn entry(bytes: &mut [u8], at: usize, key: [i32; 4], start: u64, size: i32, points: i32) {
    let mut put = |offset: usize, value: &[u8]| {
        bytes[at + offset..at + offset + value.len()].copy_from_slice(value)
    };
    key.iter()
        .enumerate()
        .for_each(|(i, number)| put(4 * i, &number.to_le_bytes()));
    put(16, &start.to_le_bytes());
    put(24, &size.to_le_bytes());
    put(28, &points.to_le_bytes());
}

#[test]
fn what_is_wrong_with_an_index_is_named() {
    let file = file_of(300);
    let refusal = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = file.bytes.clone();
        change(&mut bytes);
        let mut source = open(&bytes, Detail::Columns).unwrap();
        let read = source
            .narrow(&square([0.0, 505.0], 4.0))
            .and_then(|_| rest(&mut source));
        let mut partial =
            ours::from_stream_with(&bytes[..], "made.copc.laz", OnDamage::Accept).unwrap();
        let part = partial.narrow(&square([0.0, 505.0], 4.0)).unwrap();
        // With what is left of damaged files, all is read.
        if part.is_none() {
            assert_eq!(partial.warnings().len(), 1);
            assert_eq!(rest(&mut partial).unwrap().len(), 300);
        }
        read.map(|_| ()).unwrap_err().to_string()
    };
    let (page, _) = file.pages[0];
    let last = file.bytes.len() as u64;
    let node = file.nodes.iter().find(|node| node.level == 1).unwrap();
    type Change<'a> = &'a dyn Fn(&mut Vec<u8>);
    let cases: [(Change<'_>, &str); 9] = [
        (
            &|b| entry(b, page, [0, 1, 0, 0], 0, 0, 0),
            "there is no node 0-1-0-0 in an octree",
        ),
        (
            &|b| entry(b, page, [-1, 0, 0, 0], 0, 0, 0),
            "there is no node -1-0-0-0",
        ),
        (
            &|b| entry(b, page, [3, 0, 0, 0], 0, -5, 1),
            "node 3-0-0-0 is said to have 1 points in -5 bytes",
        ),
        (
            &|b| entry(b, page, [9, 0, 0, 0], last, 40, 7),
            "where no such chunk is",
        ),
        (
            &|b| {
                entry(
                    b,
                    page,
                    [9, 0, 0, 0],
                    node.start as u64,
                    node.bytes as i32,
                    node.points as i32,
                )
            },
            "has the points of node",
        ),
        (
            &|b| entry(b, page, [0, 0, 0, 0], page as u64, ENTRY as i32, -1),
            "node 0-0-0-0 has a second page",
        ),
        (
            &|b| {
                entry(
                    b,
                    page,
                    [9, 1, 1, 1],
                    (page + ENTRY) as u64,
                    ENTRY as i32,
                    -1,
                )
            },
            "which it is not part of",
        ),
        (
            &|b| entry(b, page, [9, 1, 1, 1], last, 32, -1),
            "the page of node 9-1-1-1 is said to have 32 bytes",
        ),
        (
            &|b| b[INFO + 24..INFO + 32].copy_from_slice(&f64::NAN.to_le_bytes()),
            "the octree is said to be NaN wide",
        ),
    ];
    for (change, expected) in cases {
        let text = refusal(change);
        assert!(text.contains(expected), "{text}\n{expected}");
    }
    // Nodes that are smaller than their points are wide.
    let half = f64::from(TREE.side) * STEP / 4.0;
    let text = refusal(&|b| b[INFO + 24..INFO + 32].copy_from_slice(&half.to_le_bytes()));
    assert!(text.contains("is outside of its node"), "{text}");
    // A chunk that no node has.
    let text = refusal(&|b| entry(b, page, [9, 1, 1, 1], 0, 0, 0));
    assert!(
        text.contains("no node has the points of chunk") || text.contains("is not below"),
        "{text}"
    );
}
