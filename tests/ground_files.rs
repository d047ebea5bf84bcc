//! Files that are classified: nothing but classes may change. The judge compares bytes, with a
//! header, records and chunks that it reads itself.
//!
//! | variable | sets the number of |
//! |---|---|
//! | `BREAKLINE_FLIPS` | changed bytes of each file |

use std::fs;
use std::io::Cursor;
use std::path::Path;

use breakline::run::{Context, Existing, GroundReport, GroundRequest, write_ground};
use breakline::terrain::ground::{GroundOptions, PointClass, classify};
use laz::laszip::ChunkTable;
use laz::{LasZipCompressor, LasZipDecompressor, LazVlr, LazVlrBuilder};
use testkit::copc::{Tree, copc};
use testkit::random::Random;

/// Bytes of a record, by point format.
const LENGTHS: [usize; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];

/// Where the time of a point is in its record.
const TIMES: [Option<usize>; 11] = [
    None,
    Some(20),
    None,
    Some(20),
    Some(20),
    Some(20),
    Some(22),
    Some(22),
    Some(22),
    Some(22),
    Some(22),
];

/// Where the packet of a waveform is in a record.
const PACKETS: [Option<usize>; 11] = [
    None,
    None,
    None,
    None,
    Some(28),
    Some(34),
    None,
    None,
    None,
    Some(30),
    Some(38),
];

/// Every version with the point formats that it has.
fn kinds() -> impl Iterator<Item = (u8, u8)> {
    let last_of = |minor| match minor {
        0 | 1 => 1,
        2 => 3,
        3 => 5,
        _ => 10,
    };
    (0..=5).flat_map(move |minor| (0..=last_of(minor)).map(move |format| (minor, format)))
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Packed {
    No,
    /// In chunks of so many points.
    Fixed(u32),
    /// In chunks of 1, 2, 3 and so on points.
    Variable,
}

/// A file to be made.
#[derive(Debug, Clone, Copy)]
struct Spec {
    minor: u8,
    format: u8,
    extra_bytes: usize,
    points: usize,
    packed: Packed,
    /// Also waveforms in the file and extended records.
    has_late: bool,
}

/// Where parts of a file are.
#[derive(Debug)]
struct Parts<'a> {
    bytes: &'a [u8],
    header: &'a [u8],
    records: Vec<&'a [u8]>,
    /// Between the last record and the points.
    padding: &'a [u8],
    points_start: usize,
    late: Vec<&'a [u8]>,
    waveforms: u64,
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> u64 {
    let mut wide = [0; 8];
    wide[..N].copy_from_slice(&bytes[at..at + N]);
    u64::from_le_bytes(wide)
}

impl<'a> Parts<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let header = &bytes[..number::<2>(bytes, 94) as usize];
        let minor = header[25];
        let read = |mut at: usize, count: u64, long: bool| {
            let mut records = Vec::new();
            for _ in 0..count {
                let length = match long {
                    true => 60 + number::<8>(bytes, at + 20) as usize,
                    false => 54 + number::<2>(bytes, at + 20) as usize,
                };
                records.push(&bytes[at..at + length]);
                at += length;
            }
            (records, at)
        };
        let (records, end) = read(header.len(), number::<4>(bytes, 100), false);
        let points_start = number::<4>(bytes, 96) as usize;
        let late = match minor >= 4 {
            true => {
                read(
                    number::<8>(bytes, 235) as usize,
                    number::<4>(bytes, 243),
                    true,
                )
                .0
            }
            false => Vec::new(),
        };
        Parts {
            bytes,
            header,
            records,
            padding: &bytes[end..points_start],
            points_start,
            late,
            waveforms: if minor >= 3 {
                number::<8>(bytes, 227)
            } else {
                0
            },
        }
    }

    fn count(&self) -> usize {
        match self.header[25] >= 4 {
            true => number::<8>(self.bytes, 247) as usize,
            false => number::<4>(self.bytes, 107) as usize,
        }
    }

    fn length(&self) -> usize {
        number::<2>(self.bytes, 105) as usize
    }

    fn format(&self) -> u8 {
        self.header[104] & 0x7f
    }

    fn laszip(&self) -> Option<LazVlr> {
        let of_laszip = |record: &&&[u8]| is_of(record, "laszip encoded");
        let record = self.records.iter().find(of_laszip)?;
        Some(LazVlr::from_buffer(&record[54..]).unwrap())
    }

    fn is_compressed(&self) -> bool {
        self.header[104] & 0x80 != 0
    }

    /// The points as records.
    fn points(&self) -> Vec<u8> {
        let size = self.count() * self.length();
        if !self.is_compressed() {
            return self.bytes[self.points_start..][..size].to_vec();
        }
        let mut cursor = Cursor::new(self.bytes);
        cursor.set_position(self.points_start as u64);
        let mut points = vec![0; size];
        LasZipDecompressor::new(cursor, self.laszip().unwrap())
            .unwrap()
            .decompress_many(&mut points)
            .unwrap();
        points
    }

    /// The points of each chunk, if chunks differ, else the bytes.
    fn chunks(&self) -> Vec<u64> {
        let laszip = self.laszip().unwrap();
        let mut cursor = Cursor::new(self.bytes);
        cursor.set_position(self.points_start as u64);
        let table = ChunkTable::read_from(&mut cursor, &laszip).unwrap();
        let of = |entry: &laz::laszip::ChunkTableEntry| match laszip.uses_variable_size_chunks() {
            true => entry.point_count,
            false => u64::from(laszip.chunk_size()),
        };
        table.as_ref().iter().map(of).collect()
    }

    /// The bytes of waveforms, to the end of the file or of their record.
    fn packets(&self) -> &'a [u8] {
        match self.waveforms {
            0 => &[],
            start if self.header[25] == 3 => &self.bytes[start as usize..],
            start => {
                let length = 60 + number::<8>(self.bytes, start as usize + 20) as usize;
                &self.bytes[start as usize..][..length]
            }
        }
    }
}

fn is_of(record: &[u8], user: &str) -> bool {
    record[2..18].starts_with(user.as_bytes())
}

/// A record of any bytes, with its header.
fn record(user: &str, id: u16, length: usize, is_long: bool, random: &mut Random) -> Vec<u8> {
    let mut any =
        |count: usize| -> Vec<u8> { (0..count).map(|_| random.index(256) as u8).collect() };
    let mut bytes = any(2);
    bytes.extend(user.as_bytes());
    bytes.resize(18, 0);
    bytes.extend(id.to_le_bytes());
    match is_long {
        true => bytes.extend((length as u64).to_le_bytes()),
        false => bytes.extend((length as u16).to_le_bytes()),
    }
    bytes.extend(any(32 + length));
    bytes
}

/// Points of any bytes; their positions are those of a small area.
fn any_points(spec: Spec, random: &mut Random) -> Vec<u8> {
    let length = LENGTHS[usize::from(spec.format)] + spec.extra_bytes;
    let mut points = Vec::new();
    for i in 0..spec.points {
        let start = points.len();
        points.extend((0..length).map(|_| random.index(256) as u8));
        let position = [
            (i % 25) as i32 * 100 + random.index(40) as i32,
            (i / 25) as i32 * 100 + random.index(40) as i32,
            random.index(300) as i32 + 900 * i32::from(random.index(6) == 0),
        ];
        points[start..start + 12].copy_from_slice(&position.map(i32::to_le_bytes).concat());
        // The crate `laz` relies on numbers that wrap around, which is an error in builds that
        // check them. Others get any bytes.
        if cfg!(debug_assertions) {
            let record = &mut points[start..];
            if let Some(at) = TIMES[usize::from(spec.format)] {
                record[at..at + 8].copy_from_slice(&(i as f64).to_le_bytes());
            }
            if let Some(at) = PACKETS[usize::from(spec.format)] {
                record[at + 1..][..28].fill(0);
                record[at + 1..][..2].copy_from_slice(&(i as u16).to_le_bytes());
            }
        }
    }
    points
}

/// A file of any bytes, as far as a file may have any.
fn file(spec: Spec, random: &mut Random) -> Vec<u8> {
    let Spec {
        minor,
        format,
        extra_bytes,
        points: count,
        ..
    } = spec;
    let length = LENGTHS[usize::from(format)] + extra_bytes;
    let size = match minor {
        0..=2 => 227,
        3 => 235,
        4 => 375,
        _ => 393,
    };
    // Also a header with fields of its producer.
    let size = size + random.index(2) * 9;
    let mut header: Vec<u8> = (0..size).map(|_| random.index(256) as u8).collect();
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, b"LASF");
    put(6, &[1, 0]);
    put(24, &[1, minor]);
    put(94, &(size as u16).to_le_bytes());
    put(104, &[format]);
    put(105, &(length as u16).to_le_bytes());
    put(107, &(count as u32).to_le_bytes());
    for axis in 0..3 {
        put(131 + 8 * axis, &0.01_f64.to_le_bytes());
        put(155 + 8 * axis, &(100.0 * axis as f64).to_le_bytes());
        put(179 + 16 * axis, &1e6_f64.to_le_bytes());
        put(187 + 16 * axis, &(-1e6_f64).to_le_bytes());
    }
    if minor >= 3 {
        put(227, &[0; 8]);
    }
    if minor >= 4 {
        put(235, &[0; 12]);
        put(247, &(count as u64).to_le_bytes());
    }

    let mut records = vec![
        record("LASF_Spec", 4, 192, false, random),
        record("LAStools", 30, 21, false, random),
        record("any", 7, random.index(90), false, random),
    ];
    let laszip = match spec.packed {
        Packed::No => None,
        Packed::Fixed(points) => Some(LazVlrBuilder::default().with_fixed_chunk_size(points)),
        Packed::Variable => Some(LazVlrBuilder::default().with_variable_chunk_size()),
    };
    let laszip = laszip.map(|builder| {
        let builder = builder.with_point_format(format, extra_bytes as u16);
        builder.unwrap().build()
    });
    if let Some(laszip) = &laszip {
        let mut payload = Vec::new();
        laszip.write_to(&mut payload).unwrap();
        let mut of_laszip = record(
            LazVlr::USER_ID,
            LazVlr::RECORD_ID,
            payload.len(),
            false,
            random,
        );
        of_laszip[54..].copy_from_slice(&payload);
        records.insert(random.index(4), of_laszip);
    }
    let padding = record("", 0, random.index(9), false, random);
    let padding = &padding[54..];
    let points_start = size + records.concat().len() + padding.len();
    header[96..100].copy_from_slice(&(points_start as u32).to_le_bytes());
    header[100..104].copy_from_slice(&(records.len() as u32).to_le_bytes());

    let mut bytes = [&header[..], &records.concat(), padding].concat();
    let points = any_points(spec, random);
    match laszip {
        None => bytes.extend(points),
        Some(laszip) => {
            bytes[104] |= 0x80;
            let mut cursor = Cursor::new(bytes);
            cursor.set_position(points_start as u64);
            let is_variable = laszip.uses_variable_size_chunks();
            let mut compressor = LasZipCompressor::new(cursor, laszip).unwrap();
            let (mut of_chunk, mut left) = (1_usize, 1_usize);
            for point in points.chunks_exact(length) {
                if is_variable && left == 0 {
                    compressor.finish_current_chunk().unwrap();
                    of_chunk += 1;
                    left = of_chunk;
                }
                left = left.saturating_sub(1);
                compressor.compress_one(point).unwrap();
            }
            compressor.done().unwrap();
            bytes = compressor.into_inner().into_inner();
        }
    }
    if spec.has_late && minor >= 3 {
        let start = (bytes.len() as u64).to_le_bytes();
        bytes[227..235].copy_from_slice(&start);
        if minor >= 4 {
            bytes[235..243].copy_from_slice(&start);
            bytes[243..247].copy_from_slice(&3_u32.to_le_bytes());
            bytes.extend(record("LASF_Spec", 65535, 100, true, random));
            bytes.extend(record("any", 3, 0, true, random));
            bytes.extend(record("LASF_Projection", 9, 70_000, true, random));
        } else {
            bytes.extend(record("LASF_Spec", 65535, 100, true, random));
        }
    }
    bytes
}

/// The class of a record.
fn class(record: &[u8], format: u8) -> u8 {
    if format < 6 {
        record[15] & 0x1f
    } else {
        record[16]
    }
}

fn is_withheld(record: &[u8], format: u8) -> bool {
    let bit = if format < 6 { 0x80 } else { 0x04 };
    record[15] & bit != 0
}

fn position(record: &[u8]) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let steps = i32::from_le_bytes(record[4 * axis..][..4].try_into().unwrap());
        f64::from(steps) * 0.01 + 100.0 * axis as f64
    })
}

/// The records with the classes that they are to get.
fn expected(points: &[u8], length: usize, format: u8, request: &GroundRequest) -> Vec<u8> {
    let from = match request.from_classes.is_empty() {
        true => vec![0, 1, 2],
        false => request.from_classes.clone(),
    };
    let mut points = points.to_vec();
    let is_chosen =
        |record: &[u8]| from.contains(&class(record, format)) && !is_withheld(record, format);
    let chosen = || {
        points
            .chunks_exact(length)
            .filter(|record| is_chosen(record))
    };
    let positions: Vec<[f64; 3]> = chosen().map(position).collect();
    let never = std::sync::atomic::AtomicBool::new(false);
    let found = classify(&positions, &request.options, &never).unwrap();
    let mut found = found.into_iter();
    for record in points
        .chunks_exact_mut(length)
        .filter(|record| is_chosen(record))
    {
        let new = match found.next().unwrap() {
            PointClass::Ground => 2,
            PointClass::Object => 1,
            PointClass::LowNoise => 7,
            PointClass::HighNoise => {
                if format < 6 {
                    7
                } else {
                    18
                }
            }
        };
        if format < 6 {
            record[15] = record[15] / 32 * 32 + new;
        } else {
            record[16] = new;
        }
    }
    points
}

/// Compares a copy with its source, byte by byte.
#[track_caller]
fn judge(source: &[u8], copy: &[u8], request: &GroundRequest) {
    let (before, after) = (Parts::of(source), Parts::of(copy));
    // Places; the number of records; whether points are compressed.
    let mut may_differ = vec![false; before.header.len()];
    let mut fields = vec![(96, 8), (104, 1)];
    let minor = before.header[25];
    if minor >= 3 {
        fields.push((227, 8));
    }
    if minor >= 4 {
        fields.push((235, 12));
    }
    fields
        .iter()
        .for_each(|&(at, length)| may_differ[at..at + length].fill(true));
    assert_eq!(before.header.len(), after.header.len());
    for (at, may_differ) in may_differ.iter().enumerate() {
        assert!(
            *may_differ || before.header[at] == after.header[at],
            "byte {at}"
        );
    }
    assert_eq!(before.format(), after.format());
    let is_kept = |record: &&&[u8]| !is_of(record, "laszip encoded") && !is_of(record, "copc");
    let kept = |records: &[&[u8]]| -> Vec<Vec<u8>> {
        records
            .iter()
            .filter(is_kept)
            .map(|record| record.to_vec())
            .collect()
    };
    assert_eq!(kept(&before.records), kept(&after.records));
    assert_eq!(before.padding, after.padding);
    assert_eq!(kept(&before.late), kept(&after.late));
    assert_eq!(before.packets(), after.packets());
    let (length, format) = (before.length(), before.format());
    let classes = expected(&before.points(), length, format, request);
    assert!(classes == after.points(), "points differ");
}

fn classified(
    source: &Path,
    copy: &Path,
    request: &GroundRequest,
) -> breakline::Result<GroundReport> {
    let request = GroundRequest {
        files: vec![source.to_path_buf()],
        ..request.clone()
    };
    write_ground(&request, copy, Existing::Keep, &Context::default())
}

/// Classifies bytes to bytes.
fn round(folder: &Path, spec: Spec, source: &[u8], to: &str, request: &GroundRequest) -> Vec<u8> {
    let from = if spec.packed == Packed::No {
        "las"
    } else {
        "laz"
    };
    let path = folder.join(format!("source.{from}"));
    let copy = folder.join(format!("copy.{to}"));
    fs::write(&path, source).unwrap();
    classified(&path, &copy, request).unwrap_or_else(|e| panic!("{spec:?}: {e}"));
    let bytes = fs::read(&copy).unwrap();
    fs::remove_file(copy).unwrap();
    bytes
}

#[test]
fn all_formats_and_versions_keep_every_byte_but_the_class() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(40);
    for (minor, format) in kinds() {
        for packed in [Packed::No, Packed::Fixed(60), Packed::Variable] {
            let spec = Spec {
                minor,
                format,
                extra_bytes: random.index(3) * 5,
                points: random.index(4) * 100,
                packed,
                has_late: random.index(3) > 0,
            };
            let source = file(spec, &mut random);
            let request = GroundRequest {
                from_classes: [vec![], vec![0, 5, 9, 30, 200], (0..=255).collect()]
                    [random.index(3)]
                .clone(),
                options: GroundOptions {
                    noise: random.index(2) > 0,
                    ..GroundOptions::default()
                },
                ..GroundRequest::default()
            };
            for to in ["las", "laz"] {
                let copy = round(folder.path(), spec, &source, to, &request);
                judge(&source, &copy, &request);
                let (before, after) = (Parts::of(&source), Parts::of(&copy));
                assert_eq!(after.is_compressed(), to == "laz");
                if packed == Packed::No && to == "las" {
                    // Also all fields.
                    assert_eq!(source.len(), copy.len());
                    assert_eq!(before.header, after.header);
                }
                // Without points, there may be a chunk, or none.
                if packed != Packed::No && to == "laz" && spec.points > 0 {
                    assert_eq!(before.laszip(), after.laszip());
                    assert_eq!(before.chunks(), after.chunks(), "{spec:?}");
                }
            }
            // If no class changes, nothing does.
            let nothing = GroundRequest {
                from_classes: vec![255],
                ..GroundRequest::default()
            };
            if format < 6 && spec.points > 0 {
                let to = if packed == Packed::No { "las" } else { "laz" };
                let copy = round(folder.path(), spec, &source, to, &nothing);
                assert!(copy == source, "{spec:?}");
            }
        }
    }
}

#[test]
fn an_octree_is_left_out_and_the_points_keep_their_chunks() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(41);
    let points: Vec<[i32; 3]> = (0..900)
        .map(|_| [0, 0, 0].map(|_| random.index(2048) as i32))
        .collect();
    let tree = Tree {
        low: [0; 3],
        side: 2048,
        most: 40,
        levels_of_page: 2,
    };
    let octree = copc(&points, &tree);
    let mut source = octree.bytes;
    // Another extended record, after the hierarchy.
    source.extend(record("any", 3, 500, true, &mut random));
    source[243..247].copy_from_slice(&2_u32.to_le_bytes());
    let path = folder.path().join("tile.copc.laz");
    fs::write(&path, &source).unwrap();
    let request = GroundRequest::default();
    let out = folder.path().join("out");
    let report = classified(&path, &out, &request).unwrap();
    assert_eq!(report.files[0].output, out.join("tile.laz"));
    let copy = fs::read(out.join("tile.laz")).unwrap();
    judge(&source, &copy, &request);
    let after = Parts::of(&copy);
    assert!(
        !after
            .records
            .iter()
            .chain(&after.late)
            .any(|record| is_of(record, "copc"))
    );
    assert_eq!((after.records.len(), after.late.len()), (1, 1));
    let sizes: Vec<u64> = octree.nodes.iter().map(|node| node.points as u64).collect();
    assert_eq!(after.chunks(), sizes);
    let notices: Vec<String> = report.notices.iter().map(|n| format!("{n:?}")).collect();
    assert!(
        notices.iter().any(|n| n.starts_with("OctreeLeftOut")),
        "{notices:?}"
    );
    // Without it, no extended record is left.
    let end = source.len() - Parts::of(&source).late[1].len();
    source.truncate(end);
    source[243..247].copy_from_slice(&1_u32.to_le_bytes());
    fs::write(&path, &source).unwrap();
    let plain = folder.path().join("plain.las");
    classified(&path, &plain, &request).unwrap();
    let copy = fs::read(plain).unwrap();
    judge(&source, &copy, &request);
    assert_eq!(number::<8>(&copy, 235), 0);
    // An octree has another order of points.
    let error = classified(&path, &folder.path().join("a.copc.laz"), &request).unwrap_err();
    assert!(error.to_string().contains("order of an octree"), "{error}");
}

#[test]
fn a_damaged_file_is_refused_and_nothing_is_left() {
    let flips = std::env::var("BREAKLINE_FLIPS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(15);
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(42);
    // Hardly a point has it: files are tested here, not the filter.
    let request = GroundRequest {
        from_classes: vec![254],
        ..GroundRequest::default()
    };
    let mut written = 0;
    for (minor, format) in [(0, 0), (2, 3), (3, 4), (4, 6), (4, 7), (4, 10), (5, 8)] {
        for packed in [Packed::No, Packed::Fixed(60), Packed::Variable] {
            let spec = Spec {
                minor,
                format,
                extra_bytes: 2,
                points: 90,
                packed,
                has_late: true,
            };
            let source = file(spec, &mut random);
            let from = if packed == Packed::No { "las" } else { "laz" };
            let path = folder.path().join(format!("source.{from}"));
            for round in 0..flips {
                let mut bytes = source.clone();
                if round % 3 == 0 {
                    bytes.truncate(random.index(bytes.len()));
                } else {
                    // Mostly where numbers are that others depend on.
                    let most = [400, bytes.len()][random.index(2)].min(bytes.len());
                    for _ in 0..=random.index(3) {
                        bytes[random.index(most)] = random.index(256) as u8;
                    }
                }
                fs::write(&path, &bytes).unwrap();
                let to = ["las", "laz"][round % 2];
                let copy = folder.path().join(format!("copy.{to}"));
                match classified(&path, &copy, &request) {
                    Ok(_) => {
                        written += 1;
                        let copied = fs::read(&copy).unwrap();
                        if (from, to) == ("las", "las") {
                            // What is odd stays odd; classes are behind this.
                            let start = number::<4>(&bytes, 96) as usize;
                            assert_eq!(copied.len(), bytes.len());
                            assert!(copied[..start] == bytes[..start], "{spec:?}");
                        }
                        fs::remove_file(&copy).unwrap();
                    }
                    Err(error) => {
                        assert!(error.path().is_some(), "{spec:?}: {error}");
                        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().collect();
                        assert_eq!(left.len(), 1, "{left:?}");
                    }
                }
            }
            fs::remove_file(&path).unwrap();
        }
    }
    // Some bytes mean nothing.
    assert!(written > 0);
}
