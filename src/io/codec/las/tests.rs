//! Tests that read files written by the `las` crate.

use std::io::Cursor;

use las::point::{Classification, Format};
use las::{Builder, Color, Point, Transform, Vector, Version, Vlr, Writer};

use super::{LasReader, from_stream, from_stream_with};
use crate::crs::{Crs, GeoKeys};
use crate::data::{Lattice, PointBatch, PointFlags, PointSource};
use crate::error::{Kind, Result, Wording};
use crate::io::OnDamage;
use crate::io::bytes::little_endian::{u32_at, u64_at};

const SCALE: [f64; 3] = [0.01, 0.001, 0.1];
const OFFSET: [f64; 3] = [500_000.0, -5_300_000.0, 12.5];

/// Every point format with each version that supports it.
fn kinds() -> impl Iterator<Item = ((u8, u8), u8)> {
    let formats_of = |minor| match minor {
        0 | 1 => 0..=1,
        2 => 0..=3,
        3 => 0..=5,
        _ => 0..=10,
    };
    (0..=4).flat_map(move |minor| formats_of(minor).map(move |format| ((1, minor), format)))
}

/// The integers of point `i`: small, large, and of both signs.
fn lattice(i: usize) -> [i32; 3] {
    let wave = |step: usize| ((i * step) % 20_011) as i32 - 10_000;
    [wave(7) * 1000, wave(131), i32::MIN + i as i32 * 3]
}

/// Classes, flags and returns that take all values of the point format.
fn attributes(i: usize, is_extended: bool) -> (u8, u8, u8) {
    let (classes, flags, returns) = if is_extended {
        (256, 16, 15)
    } else {
        (32, 8, 5)
    };
    let class = match i % classes {
        // The crate does not write the class for overlap.
        12 => 13,
        class => class as u8,
    };
    (class, (i / 3 % flags) as u8, (1 + i % returns) as u8)
}

struct Spec {
    version: (u8, u8),
    format: u8,
    extra_bytes: u16,
    is_compressed: bool,
    points: usize,
    records: Vec<Vlr>,
    late_records: Vec<Vlr>,
}

impl Spec {
    fn new(version: (u8, u8), format: u8) -> Self {
        let (records, late_records) = Default::default();
        Spec {
            version,
            format,
            extra_bytes: 0,
            is_compressed: false,
            points: 1000,
            records,
            late_records,
        }
    }

    fn write(self) -> Vec<u8> {
        let mut format = Format::new(self.format).unwrap();
        format.is_compressed = self.is_compressed;
        format.extra_bytes = self.extra_bytes;
        let [x, y, z] = [0, 1, 2].map(|i| Transform {
            scale: SCALE[i],
            offset: OFFSET[i],
        });
        let mut builder = Builder::from(self.version);
        builder.version = Version::new(self.version.0, self.version.1);
        builder.point_format = format;
        builder.transforms = Vector { x, y, z };
        builder.generating_software = "tests".into();
        builder.vlrs.extend(self.records);
        builder.evlrs.extend(self.late_records);
        let mut writer =
            Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
        for i in 0..self.points {
            let [x, y, z] = coordinates(i);
            let (class, flags, return_number) = attributes(i, format.is_extended);
            let point = Point {
                x,
                y,
                z,
                return_number,
                number_of_returns: return_number,
                classification: Classification::new(class).unwrap(),
                is_synthetic: flags & PointFlags::SYNTHETIC != 0,
                is_key_point: flags & PointFlags::KEY_POINT != 0,
                is_withheld: flags & PointFlags::WITHHELD != 0,
                is_overlap: flags & PointFlags::OVERLAP != 0,
                scanner_channel: if format.is_extended {
                    (i / 11 % 4) as u8
                } else {
                    0
                },
                intensity: i as u16,
                user_data: i as u8,
                gps_time: format.has_gps_time.then_some(i as f64 * 0.5),
                color: format.has_color.then(|| Color::new(i as u16, 1, 2)),
                nir: format.has_nir.then_some(7),
                waveform: format.has_waveform.then(Default::default),
                extra_bytes: vec![i as u8; self.extra_bytes.into()],
                ..Point::default()
            };
            writer.write_point(point).unwrap();
        }
        writer.into_inner().unwrap().into_inner()
    }
}

fn coordinates(i: usize) -> [f64; 3] {
    let steps = lattice(i);
    [0, 1, 2].map(|axis| f64::from(steps[axis]) * SCALE[axis] + OFFSET[axis])
}

fn read(bytes: &[u8]) -> Result<(LasReader, PointBatch)> {
    read_with(bytes, OnDamage::Refuse)
}

/// Checks that a file that was cut is refused, then reads what is there.
fn read_cut(bytes: &[u8]) -> (LasReader, PointBatch) {
    let error = read(bytes).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with(&format!("test: byte {}: the ", bytes.len())),
        "{error}"
    );
    assert!(error.cure_text().unwrap().plain().contains("partial"));
    read_with(bytes, OnDamage::Accept).unwrap()
}

fn read_with(bytes: &[u8], cut: OnDamage) -> Result<(LasReader, PointBatch)> {
    let mut reader = from_stream_with(bytes, "test", cut)?;
    let (mut all, mut batch) = (PointBatch::default(), PointBatch::default());
    loop {
        reader.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((reader, all));
        }
        all.x.append(&mut batch.x);
        all.y.append(&mut batch.y);
        all.z.append(&mut batch.z);
        all.class.append(&mut batch.class);
        all.flags.append(&mut batch.flags);
        all.return_number.append(&mut batch.return_number);
    }
}

/// Checks all points of [`Spec::write`], bit by bit.
fn check_points(all: &PointBatch, points: usize, is_extended: bool) {
    assert_eq!(all.len(), points);
    for i in 0..points {
        assert_eq!([all.x[i], all.y[i], all.z[i]], coordinates(i), "point {i}");
        let found = (all.class[i], all.flags[i].0, all.return_number[i]);
        assert_eq!(found, attributes(i, is_extended), "point {i}");
    }
}

#[test]
fn every_version_and_point_format() {
    for (version, format) in kinds() {
        for is_compressed in [false, true] {
            for extra_bytes in [0, 3] {
                let bytes = Spec {
                    is_compressed,
                    extra_bytes,
                    ..Spec::new(version, format)
                }
                .write();
                let (reader, all) = read(&bytes).unwrap();
                let packing = if is_compressed { ", LAZ" } else { "" };
                let name = format!("LAS 1.{}, point format {format}{packing}", version.1);
                assert_eq!(reader.info().format, name);
                assert_eq!(reader.info().count, Some(1000));
                assert_eq!(
                    reader.info().lattice,
                    Some(Lattice {
                        scale: SCALE,
                        offset: OFFSET
                    })
                );
                assert_eq!(reader.header().software, "tests");
                assert!(
                    reader.info().warnings.is_empty() && reader.warnings().is_empty(),
                    "{name}"
                );
                check_points(&all, 1000, format >= 6);
            }
        }
    }
}

#[test]
fn version_5_is_read_as_4() {
    let mut bytes = Spec::new((1, 4), 9).write();
    bytes[25] = 5;
    let (reader, all) = read(&bytes).unwrap();
    assert!(reader.info().format.starts_with("LAS 1.5"));
    check_points(&all, 1000, true);
}

/// Several chunks, the last one incomplete, in more than one group.
#[test]
fn many_chunks_come_in_order() {
    for format in [1, 6] {
        for points in [50_000, 420_001] {
            let bytes = Spec {
                is_compressed: true,
                points,
                ..Spec::new((1, 4), format)
            }
            .write();
            check_points(&read(&bytes).unwrap().1, points, format >= 6);
        }
    }
}

#[test]
fn thinned_sources_have_parts_all_over() {
    for (format, is_compressed) in [(1, false), (1, true), (6, true)] {
        let bytes = Spec {
            is_compressed,
            points: 420_001,
            ..Spec::new((1, 4), format)
        }
        .write();
        for (spacing, firsts) in [
            (100_000, &[0, 100_000, 200_000, 300_000, 400_000][..]),
            (150_000, &[0, 150_000, 300_000]),
            (1 << 40, &[0]),
        ] {
            let mut reader = from_stream(&bytes[..], "test").unwrap();
            assert!(reader.thin(spacing));
            let mut batch = PointBatch::default();
            let mut found = Vec::new();
            loop {
                reader.read(&mut batch).unwrap();
                if batch.is_empty() {
                    break;
                }
                found.extend(batch.x.iter().copied());
            }
            let parts = firsts
                .iter()
                .flat_map(|&first| first..(first + 50_000).min(420_001));
            assert!(
                found.into_iter().eq(parts.map(|i| coordinates(i)[0])),
                "{format} {spacing}"
            );
        }
        let mut reader = from_stream(&bytes[..], "test").unwrap();
        assert!(reader.thin(0) && reader.warnings().is_empty());
        let mut batch = PointBatch::default();
        reader.read(&mut batch).unwrap();
        assert!(!batch.is_empty());
    }
}

#[test]
fn one_thread_gives_what_many_give() {
    let bytes = Spec {
        is_compressed: true,
        points: 120_000,
        ..Spec::new((1, 4), 7)
    }
    .write();
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        check_points(&pool.install(|| read(&bytes).unwrap().1), 120_000, true);
    }
}

/// The offset of the chunk table's position, and that position.
fn table_of(bytes: &[u8]) -> (usize, usize) {
    let points = u32_at(bytes, 96) as usize;
    (points, u64_at(bytes, points) as usize)
}

#[test]
fn without_a_chunk_table_points_are_found_all_the_same() {
    for (format, word) in [
        (3, "one after the other"),
        (8, "found by their own headers"),
    ] {
        let whole = Spec {
            is_compressed: true,
            points: 120_000,
            ..Spec::new((1, 4), format)
        }
        .write();
        let (pointer, table) = table_of(&whole);
        let mut lost = whole.clone();
        lost[pointer..pointer + 8].fill(0xff);
        let mut garbage = whole.clone();
        garbage[table + 4..].fill(0x55);
        let mut shifted = whole.clone();
        shifted[table + 8..].fill(0);
        for bytes in [lost, garbage, shifted, whole[..table].to_vec()] {
            let (reader, all) = read(&bytes).unwrap();
            check_points(&all, 120_000, format >= 6);
            assert!(
                reader
                    .info()
                    .warnings
                    .iter()
                    .any(|w| w.plain().contains(word)),
                "{:?}",
                reader.info().warnings
            );
        }
    }
}

#[test]
fn a_cut_laz_file_gives_the_points_before_the_cut() {
    let whole = Spec {
        is_compressed: true,
        points: 120_000,
        ..Spec::new((1, 4), 3)
    }
    .write();
    let (reader, all) = read_cut(&whole[..whole.len() / 2]);
    assert!((40_000..80_000).contains(&all.len()), "{}", all.len());
    check_points(&all, all.len(), false);
    assert!(
        reader.warnings()[0].plain().contains("of 120000 are read"),
        "{:?}",
        reader.warnings()
    );

    let whole = Spec {
        is_compressed: true,
        points: 120_000,
        ..Spec::new((1, 4), 8)
    }
    .write();
    let (reader, all) = read_cut(&whole[..whole.len() / 2]);
    check_points(&all, 50_000, true);
    assert!(
        reader
            .info()
            .warnings
            .iter()
            .any(|w| w.plain().contains("holds 50000 in whole chunks"))
    );
}

#[test]
fn a_damaged_chunk_is_an_error_and_those_before_it_are_good() {
    for format in [3, 8] {
        let mut bytes = Spec {
            is_compressed: true,
            points: 120_000,
            ..Spec::new((1, 4), format)
        }
        .write();
        let (start, table) = table_of(&bytes);
        // In the last of three chunks; in the sizes of its layers or its first difference.
        let chunks = super::laz::chunks_of(&bytes);
        let last = chunks[2] as usize;
        assert!(start < last && last < table);
        bytes[last + 40..last + 60].fill(0xa5);
        let mut reader = from_stream(&bytes[..], "test").unwrap();
        let mut batch = PointBatch::default();
        let mut good = 0;
        let error = loop {
            match reader.read(&mut batch) {
                Ok(()) => good += batch.len(),
                Err(error) => break error,
            }
        };
        assert_eq!(good, 100_000);
        assert!(
            error.to_string().starts_with("test: chunk 3 at byte "),
            "{error}"
        );
        assert!(
            error
                .to_string()
                .contains("(points 100000 to 119999): the compressed points are damaged"),
            "{error}"
        );
        reader.read(&mut batch).unwrap();
        assert!(batch.is_empty());
    }
}

#[test]
fn a_cut_las_file_gives_its_whole_records() {
    let whole = Spec {
        points: 300_000,
        ..Spec::new((1, 2), 0)
    }
    .write();
    let (reader, all) = read_cut(&whole[..whole.len() - 25]);
    check_points(&all, 299_998, false);
    let warning = &reader.info().warnings[0];
    let warning = warning.plain();
    assert!(
        warning.contains("states 300000 points, but the file holds 299998 and 15 bytes of another"),
        "{warning}"
    );
}

#[test]
fn more_points_than_bytes_can_hold_are_refused_at_once() {
    for (minor, format) in [(2, 3), (4, 3), (4, 6)] {
        let mut bytes = Spec {
            is_compressed: true,
            ..Spec::new((1, minor), format)
        }
        .write();
        let (count, room) = if minor == 4 { (247, 8) } else { (107, 4) };
        let stated = u64::from(u32::MAX) + u64::from(minor == 4);
        bytes[count..count + room].copy_from_slice(&stated.to_le_bytes()[..room]);
        for cut in [OnDamage::Refuse, OnDamage::Accept] {
            let error = read_with(&bytes, cut).unwrap_err();
            assert_eq!(error.kind(), Kind::Limit, "{error}");
            assert!(
                error.to_string().contains(&format!("{stated} points in ")),
                "{error}"
            );
        }
    }
}

#[test]
fn records_after_the_points_are_not_points() {
    let late = Vlr {
        user_id: "tests".into(),
        record_id: 7,
        description: "late".into(),
        data: vec![1; 999],
    };
    let mut bytes = Spec {
        late_records: vec![late],
        ..Spec::new((1, 4), 6)
    }
    .write();
    let (reader, _) = read(&bytes).unwrap();
    let record = reader.header().records.last().unwrap();
    assert_eq!(
        (record.user_id.as_str(), record.record_id, record.length),
        ("tests", 7, 999)
    );
    // A count of records that would reach into the points.
    bytes[247..255].copy_from_slice(&1010_u64.to_le_bytes());
    bytes[107..111].fill(0);
    let error = read(&bytes).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("states 1010 points, but the file holds 1000"),
        "{error}"
    );
    let (reader, all) = read_with(&bytes, OnDamage::Accept).unwrap();
    check_points(&all, 1000, true);
    assert!(
        reader.info().warnings[0]
            .plain()
            .contains("states 1010 points, but the file holds 1000")
    );
}

#[test]
fn a_record_longer_than_its_space_is_a_warning() {
    let record = Vlr {
        user_id: "tests".into(),
        record_id: 7,
        description: "".into(),
        data: vec![1; 9],
    };
    let mut bytes = Spec {
        records: vec![record],
        ..Spec::new((1, 2), 1)
    }
    .write();
    bytes[227 + 20..227 + 22].copy_from_slice(&10_u16.to_le_bytes());
    let (reader, all) = read(&bytes).unwrap();
    check_points(&all, 1000, false);
    let warning = &reader.info().warnings[0];
    let warning = warning.plain();
    assert!(
        warning.contains("record 1 (tests, 7) states 10 bytes, but 9 are left"),
        "{warning}"
    );
}

#[test]
fn counts_that_disagree_are_reported() {
    let mut bytes = Spec::new((1, 4), 1).write();
    bytes[107..111].copy_from_slice(&999_u32.to_le_bytes());
    let (reader, all) = read(&bytes).unwrap();
    assert_eq!(all.len(), 1000);
    assert!(
        reader.info().warnings[0]
            .plain()
            .contains("states 1000 points, and 999 for old readers")
    );
}

fn projection(record_id: u16, data: Vec<u8>) -> Vlr {
    Vlr {
        user_id: "LASF_Projection".into(),
        record_id,
        description: "".into(),
        data,
    }
}

/// The records for one system as WKT and another as GeoTIFF keys.
fn two_systems(wkt: u32, keys: u32) -> Vec<Vlr> {
    let crs = |code| Crs::from_epsg(code).unwrap();
    let keys = GeoKeys::from_crs(&crs(keys));
    let directory = keys
        .directory
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    let doubles = keys
        .doubles
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    vec![
        projection(34735, directory),
        projection(34736, doubles),
        projection(34737, keys.ascii.into_bytes()),
        projection(2112, [crs(wkt).to_prj().as_bytes(), b"\0"].concat()),
    ]
}

#[test]
fn of_two_coordinate_systems_the_header_takes_one() {
    for (wkt, keys, is_set, taken) in [
        (25832, 25832, true, 25832),
        (25832, 25833, true, 25832),
        (25832, 25833, false, 25833),
    ] {
        let mut bytes = Spec {
            records: two_systems(wkt, keys),
            ..Spec::new((1, 4), 1)
        }
        .write();
        bytes[6] = if is_set {
            bytes[6] | 16
        } else {
            bytes[6] & !16
        };
        let (reader, _) = read(&bytes).unwrap();
        assert_eq!(reader.info().crs.as_ref().unwrap().epsg, Some(taken));
        let warned = reader
            .info()
            .warnings
            .iter()
            .map(Wording::plain)
            .any(|warning| {
                warning.contains("two coordinate systems")
                    && warning.contains("25832")
                    && warning.contains("25833")
            });
        assert_eq!(warned, wkt != keys, "{:?}", reader.info().warnings);
    }
    // Records of one kind count whatever the bit says; WKT after the points does too.
    for (records, late_records) in [
        (two_systems(25832, 25832).split_off(3), Vec::new()),
        (Vec::new(), two_systems(25832, 25832).split_off(3)),
        (two_systems(25832, 25832).drain(..3).collect(), Vec::new()),
    ] {
        let mut bytes = Spec {
            records,
            late_records,
            ..Spec::new((1, 4), 1)
        }
        .write();
        for bit in [0, 16] {
            bytes[6] = bytes[6] & !16 | bit;
            let (reader, _) = read(&bytes).unwrap();
            assert_eq!(reader.info().crs.as_ref().unwrap().epsg, Some(25832));
            assert!(
                reader.info().warnings.is_empty(),
                "{:?}",
                reader.info().warnings
            );
        }
    }
}

#[test]
fn text_that_is_not_wkt_is_a_warning() {
    for (text, word) in [
        (&b"nonsense[\0"[..], "not understood"),
        (b" \0", "is empty"),
        (b"", "is empty"),
    ] {
        let (reader, all) = read(
            &Spec {
                records: vec![projection(2112, text.to_vec())],
                ..Spec::new((1, 4), 6)
            }
            .write(),
        )
        .unwrap();
        assert_eq!(all.len(), 1000);
        assert_eq!(reader.info().crs, None);
        assert!(
            reader.info().warnings[0].plain().contains(word),
            "{:?}",
            reader.info().warnings
        );
    }
}
