use std::collections::BTreeSet;

use super::{bytes_of, frame_over, open, tin_of};
use breakline::data::{Frame, Grid, Surface};
use breakline::io::mesh;
use breakline::terrain::{self, Dem, Levels, SurfaceFlaw};
use testkit::random::Random;

/// Uses a file in every way; returns true if any damage was noticed.
fn use_it(bytes: Vec<u8>, frame: Frame, with_files: bool) -> bool {
    let Ok(opened) = open(bytes) else { return true };
    let levels = Levels::every(0.5, 0.1).unwrap();
    if let Ok(lines) = terrain::contours(&opened, &levels) {
        // A wrong height may be so large that the lines would be endless, too.
        for line in lines.take(100_000) {
            assert!(line.points.iter().flatten().all(|c| c.is_finite()));
        }
    }
    let drawn = Dem::new(&opened, frame).and_then(|dem| Grid::collect(&dem));
    assert!(drawn.is_ok() || opened.ensure_intact().is_err());
    if with_files {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ply");
        let done = mesh::write(path.as_path(), &opened);
        assert!(done.is_ok() == path.exists() && (done.is_ok() || opened.ensure_intact().is_err()));
    }
    drop(bytes_of(&opened));
    let checked = opened.check();
    // What a check accepts can be used without damage.
    assert!(checked.is_err() || opened.ensure_intact().is_ok() && drawn.is_ok());
    checked.is_err()
}

fn intact() -> Vec<(Vec<u8>, Frame)> {
    let tins = (0..40).filter_map(tin_of);
    let files: Vec<_> = tins.map(|tin| (bytes_of(&tin), frame_over(&tin))).collect();
    assert!(files.len() > 20);
    files
}

#[test]
fn no_byte_of_a_file_leads_to_a_panic() {
    let files = intact();
    let mut noticed = 0;
    for seed in 0..4000 {
        let mut random = Random(seed);
        let (mut bytes, frame) = files[seed as usize % files.len()].clone();
        // The header, the triangulation or anything.
        let from = if random.below(8) == 0 { 0 } else { 48 };
        for _ in 0..1 + random.below(4) {
            let at = from + random.index(bytes.len() - from);
            bytes[at] = match random.below(3) {
                0 => bytes[at] ^ 1 << random.below(8),
                1 => random.below(256) as u8,
                _ => [0, 1, 0x7F, 0xFF][random.index(4)],
            };
        }
        noticed += usize::from(use_it(bytes, frame, seed % 50 == 0));
    }
    assert!(noticed > 2500, "{noticed}");
}

/// Numbers that exist, in the wrong rows: links that do not link back, corners of others.
#[test]
fn possible_numbers_in_wrong_rows_lead_to_no_endless_walk() {
    let files = intact();
    for seed in 0..4000 {
        let mut random = Random(seed);
        let (mut bytes, frame) = files[seed as usize % files.len()].clone();
        let rows = bytes.len() / 4;
        for _ in 0..1 + random.below(30) {
            // From a word nearby, where rows are of the same kind.
            let to = random.index(rows);
            let from = (to + random.index(60)).saturating_sub(30).min(rows - 1);
            bytes.copy_within(4 * from..4 * from + 4, 4 * to);
        }
        use_it(bytes, frame, false);
    }
}

#[test]
fn no_truncated_file_is_opened() {
    for (bytes, _) in intact().into_iter().take(5) {
        for length in 0..bytes.len() {
            assert!(
                open(bytes[..length].to_vec()).is_err(),
                "{length} of {}",
                bytes.len()
            );
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(open(longer).is_err());
    }
}

#[test]
fn messages_name_file_and_cure() {
    let tin = tin_of(1).unwrap();
    let bytes = bytes_of(&tin);
    let mut messages = BTreeSet::new();
    let mut note = |bytes: Vec<u8>| {
        let error = open(bytes).unwrap_err();
        assert_eq!(error.path(), Some("some.tin".as_ref()));
        assert!(
            error
                .cure_text()
                .is_some_and(|cure| cure.plain().contains("`tin`")),
            "{error:?}"
        );
        messages.insert(error.to_string());
    };
    note(b"solid".to_vec());
    let mut old = bytes.clone();
    old[8] = 1;
    note(old);
    note(bytes[..200].to_vec());
    let mut plain = Vec::new();
    tin.triangulation().write_compact(&mut plain).unwrap();
    note(plain);
    let expected = [
        "200 bytes where",
        "a compact triangulation of version 1; the known version is 2",
        "a triangulation without the section `inside` of a TIN",
        "not a compact triangulation: wrong magic bytes",
    ];
    assert!(
        messages
            .iter()
            .zip(expected)
            .all(|(found, part)| found.contains(part)),
        "{messages:?}"
    );

    // A coordinate that is not a number, of a vertex that a face has.
    let opened = open(bytes.clone()).unwrap();
    let vertex = (0..opened.face_count() as u32)
        .find_map(|face| opened.face(face))
        .unwrap()[0];
    let mut damaged = bytes;
    damaged[48 + 24 * vertex as usize..][..8].copy_from_slice(&f64::NAN.to_le_bytes());
    let opened = open(damaged).unwrap();
    opened.ensure_intact().unwrap();
    let _ = opened.position(vertex);
    let error = opened.ensure_intact().unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with(&format!("some.tin: vertex {vertex} ")),
        "{error}"
    );
    assert!(
        error
            .cure_text()
            .is_some_and(|cure| cure.plain().contains("`check some.tin`"))
    );
}

/// Where the rows of a section begin, and how many bytes they have together.
fn section(bytes: &[u8], tag: &[u8; 8]) -> (usize, usize) {
    let at = bytes.windows(8).rposition(|word| word == tag).unwrap();
    (
        at + 16,
        u64::from_le_bytes(bytes[at + 8..at + 16].try_into().unwrap()) as usize,
    )
}

#[test]
fn a_kind_that_differs_between_the_two_faces_of_an_edge_is_found() {
    let mut changed = 0;
    for (bytes, _) in intact().into_iter().take(12) {
        let opened = open(bytes.clone()).unwrap();
        assert!(
            !terrain::surface_flaws(&opened)
                .iter()
                .any(|flaw| matches!(flaw, SurfaceFlaw::Kinds(..)))
        );
        let (first, length) = section(&bytes, b"fragment");
        // Some rows of each file: every change is a check of the whole.
        for row in (first..first + length).step_by(28).step_by(17) {
            for side in 0..3 {
                let neighbor = &bytes[row + 12 + 4 * side..][..4];
                if neighbor == [0xFF; 4] {
                    continue;
                }
                let mut bad = bytes.clone();
                let kind = &mut bad[row + 24 + side];
                *kind = u8::from(*kind == 0);
                let opened = open(bad).unwrap();
                let flaws = terrain::surface_flaws(&opened);
                let is_found = flaws
                    .iter()
                    .any(|flaw| matches!(flaw, SurfaceFlaw::Kinds(..)));
                assert!(is_found || opened.check().is_err(), "{flaws:?}");
                changed += 1;
            }
        }
    }
    assert!(changed > 15, "{changed}");
}
