//! Readers of points against real files, and against files that are broken.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use breakline::crs::CrsKind;
use breakline::data::{Bounds, Lattice, PointBatch, PointInfo, PointSource};
use breakline::error::{Kind, Wording};
use breakline::io::{las, points};
use serde_json::Value;

/// What reading a file to its end gives.
#[derive(Debug, Default)]
struct Summary {
    count: u64,
    bounds: Bounds,
    classes: BTreeMap<u8, u64>,
    returns: BTreeMap<u8, u64>,
    /// Sums of the integers that the coordinates were made of, where the format has them.
    lattice_sums: [i128; 3],
    warnings: Vec<String>,
}

fn summarize(source: &mut (impl PointSource + ?Sized)) -> breakline::Result<Summary> {
    let mut summary = Summary::default();
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            break;
        }
        let length = batch.len();
        assert_eq!([batch.y.len(), batch.z.len()], [length; 2]);
        assert_eq!(
            [
                batch.class.len(),
                batch.flags.len(),
                batch.return_number.len()
            ],
            [length; 3]
        );
        summary.count += length as u64;
        for i in 0..length {
            summary.bounds.add([batch.x[i], batch.y[i], batch.z[i]]);
            *summary.classes.entry(batch.class[i]).or_default() += 1;
            *summary.returns.entry(batch.return_number[i]).or_default() += 1;
        }
        if let Some(Lattice { scale, offset }) = source.info().lattice {
            for (axis, column) in [&batch.x, &batch.y, &batch.z].into_iter().enumerate() {
                let steps = column
                    .iter()
                    .map(|value| ((value - offset[axis]) / scale[axis]).round() as i128);
                summary.lattice_sums[axis] += steps.sum::<i128>();
            }
        }
    }
    source.read(&mut batch)?;
    assert!(batch.is_empty(), "the end stays the end");
    summary.warnings = source
        .info()
        .warnings
        .iter()
        .chain(source.warnings())
        .map(Wording::plain)
        .collect();
    Ok(summary)
}

/// The facts of the shared folder, by path.
///
/// Fractions are kept as text: the JSON reader rounds some of them wrongly, and Python wrote NaN
/// and Infinity, which JSON does not have.
fn facts() -> BTreeMap<String, Value> {
    let text = std::fs::read_to_string(testkit::shared("FACTS.json")).unwrap();
    let mut quoted = String::with_capacity(text.len());
    for (i, part) in text.split('"').enumerate() {
        let is_string = i % 2 == 1;
        if i > 0 {
            quoted.push('"');
        }
        if is_string {
            quoted.push_str(part);
            continue;
        }
        for token in part.split_inclusive(|c: char| "[]{},: \n".contains(c)) {
            let (word, end) = token.split_at(
                token
                    .trim_end_matches(|c: char| "[]{},: \n".contains(c))
                    .len(),
            );
            let is_fraction = word.contains(['.', 'e', 'N', 'I']) && word.parse::<f64>().is_ok();
            let mark = if is_fraction { "\"" } else { "" };
            quoted.extend([mark, word, mark, end]);
        }
    }
    serde_json::from_str(&quoted).unwrap()
}

fn is_las(path: &str) -> bool {
    path.ends_with(".las") || path.ends_with(".laz")
}

fn triple(value: &Value) -> [f64; 3] {
    let list = value.as_array().unwrap();
    [0, 1, 2].map(|i| match &list[i] {
        Value::String(text) => text.parse().unwrap(),
        number => number.as_f64().unwrap(),
    })
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_lidar_file_gives_what_is_known_of_it() {
    let facts = facts();
    let mut seen = 0;
    for (path, fact) in &facts {
        if !path.starts_with("lidar/") || path.contains("/broken/") || !is_las(path) {
            continue;
        }
        // Its header counts points that are not there.
        let cut = if path.ends_with("1.2-no-points.las") {
            breakline::io::OnDamage::Accept
        } else {
            breakline::io::OnDamage::Refuse
        };
        let mut source = las::open_with(testkit::shared(path), cut).unwrap();
        let found = summarize(&mut source).unwrap_or_else(|error| panic!("{path}: {error}"));
        let info = source.info();
        let version = fact["hdr_version"].as_str().unwrap();
        let format = format!("LAS {version}, point format {}", fact["hdr_pdrf"]);
        assert!(info.format.starts_with(&format), "{path}: {}", info.format);
        assert_eq!(
            info.format.ends_with("LAZ") || info.format.ends_with("COPC"),
            path.ends_with("laz"),
            "{path}"
        );
        assert_eq!(info.count, fact["point_count"].as_u64(), "{path}");
        let lattice = Lattice {
            scale: triple(&fact["scale"]),
            offset: triple(&fact["offset"]),
        };
        assert_eq!(info.lattice, Some(lattice), "{path}");
        if info.count > Some(0) {
            let bounds = info.bounds.unwrap();
            assert_eq!(
                (bounds.min, bounds.max),
                (triple(&fact["hdr_min"]), triple(&fact["hdr_max"])),
                "{path}"
            );
        }
        check_crs(path, info, fact);
        if fact.get("read_points").is_some() {
            assert_eq!(Some(found.count), fact["read_points"].as_u64(), "{path}");
            let classes: BTreeMap<u8, u64> =
                serde_json::from_value(fact["classes"].clone()).unwrap();
            assert_eq!(found.classes, classes, "{path}");
        }
        if fact.get("min").is_some() {
            assert_eq!(found.bounds.min, triple(&fact["min"]), "{path}");
            assert_eq!(found.bounds.max, triple(&fact["max"]), "{path}");
            let sums = fact["sum_int_xyz"].as_array().unwrap();
            assert_eq!(
                found.lattice_sums,
                [0, 1, 2].map(|i| i128::from(sums[i].as_i64().unwrap())),
                "{path}"
            );
        }
        seen += 1;
    }
    assert_eq!(seen, 70, "files of the shared folder");
}

/// Files whose keys give a code for metres and feet as the unit. The coordinates are in feet, which
/// has a code of its own.
const IN_FEET: &str = "lidar/formats/lazrs/point-version-1-point-wise.";

fn check_crs(path: &str, info: &PointInfo, fact: &Value) {
    let found = info.crs.as_ref();
    match &fact["crs"] {
        Value::Number(_) if path.starts_with(IN_FEET) => {
            assert_eq!(found.unwrap().epsg, Some(2271))
        }
        Value::Number(code) => {
            assert_eq!(found.unwrap().epsg.map(u64::from), code.as_u64(), "{path}")
        }
        // One bracket too many, which that reader does not forgive.
        Value::String(text) if text == "unparsable" => {
            assert_eq!(found.unwrap().epsg, Some(32610), "{path}")
        }
        Value::String(name) => assert_eq!(&found.unwrap().name, name, "{path}"),
        _ => {
            // Where that reader had records to read, we may understand more of them.
            let records = fact["vlr"].as_array().into_iter().flatten();
            if !records
                .into_iter()
                .any(|record| record.as_str().unwrap().starts_with("LASF_Projection"))
            {
                assert_eq!(found, None, "{path}");
            }
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn geocentric_coordinates_are_known_as_such() {
    let source = las::open(testkit::shared("lidar/formats/lone-star.copc.laz")).unwrap();
    assert_eq!(
        source.info().crs.as_ref().unwrap().kind,
        CrsKind::Geocentric
    );
}

/// Files whose header counts by return are the truth (they are wrong in some).
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn returns_are_those_of_the_header() {
    for path in [
        "lidar/bcts/bcts_1.laz",
        "lidar/ign_0292_6833/test_semis_2023_0292_6833_LA93_IGN69.laz",
    ] {
        let mut source = las::open(testkit::shared(path)).unwrap();
        let found = summarize(&mut source).unwrap();
        let stated: BTreeMap<u8, u64> =
            (1..).zip(source.header().returns.iter().copied()).collect();
        // The header has no place for points that state return 0.
        let from_one: BTreeMap<u8, u64> = found
            .returns
            .into_iter()
            .filter(|&(number, _)| number > 0)
            .collect();
        assert_eq!(from_one, stated, "{path}");
    }
}

/// The oldest kind of LAZ, one run of points without chunks, holds the points of `simple.las`.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn laz_without_chunks_equals_its_las() {
    let laz = testkit::shared("lidar/formats/simple-laszip-compressor-version-1.2r0.laz");
    let las = testkit::shared("lidar/formats/simple.las");
    let (mut a, mut b) = (las::open(laz).unwrap(), las::open(las).unwrap());
    let (mut left, mut right) = (PointBatch::default(), PointBatch::default());
    a.read(&mut left).unwrap();
    b.read(&mut right).unwrap();
    assert_eq!(left.len(), 1065);
    assert_eq!(
        (left.x, left.y, left.z, left.class),
        (right.x, right.y, right.z, right.class)
    );
    assert_eq!(
        (left.flags, left.return_number),
        (right.flags, right.return_number)
    );
}

/// What becomes of a broken file.
enum Fate {
    /// All points; none of the warnings is about points.
    Full(u64),
    /// These points and a warning that says this.
    Warned(u64, &'static str),
    /// An error that says this, unless cut files are accepted: then these points, and a warning.
    Cut(u64, &'static str),
    /// An error of this kind that says this.
    Refused(Kind, &'static str),
}

use Fate::{Cut, Full, Refused, Warned};

#[rustfmt::skip]
const BROKEN: &[(&str, Fate)] = &[
    ("1.2-empty-geotiff-vlrs.las", Full(43)),
    ("Semis_2022_0906_6665_LA93_IGN69_nok.laz", Refused(Kind::Format, "header has 0 bytes, a LAS 1.4 header has at least 375")),
    ("bad-geotiff-keys.las", Full(10)),
    ("bad_vlr_count.las", Warned(10, "states 3 variable length records; 2 were found")),
    ("broken_size.laz", Refused(Kind::Unsupported, "compressor 1 with version 6 of Point10")),
    ("broken_type.laz", Refused(Kind::Format, "unknown kind 22 of field")),
    ("broken_version.laz", Refused(Kind::Unsupported, "compressor 1 with version 6 of Point10")),
    ("garbage_nVariableLength.las", Cut(718, "states 719 points, but the file holds 718 and 14 bytes of another")),
    ("gps-time-nan.las", Full(1)),
    ("malformed_extrabytes.las", Full(10)),
    ("mut_Topography__truncated_half.laz", Cut(37_110, "the file ends within its compressed points: 37110 of 73403")),
    ("mut_point-time-color__bad_signature.las", Refused(Kind::Format, "begins with \"LASX\", expected \"LASF\"")),
    ("mut_point-time-color__bbox_inverted.las", Warned(1065, "extent in the header is not a box")),
    ("mut_point-time-color__chunktable_ptr_garbage.laz", Warned(1065, "lies beyond the end of the file at byte 17546")),
    ("mut_point-time-color__chunktable_ptr_minus1.laz", Warned(1065, "decoded one after the other")),
    ("mut_point-time-color__count_max.las", Cut(1065, "states 4294967295 points, but the file holds 1065")),
    ("mut_point-time-color__count_too_large.las", Cut(1065, "states 2065 points, but the file holds 1065")),
    ("mut_point-time-color__count_zero.las", Warned(0, "states 0 points, but 36210 bytes follow it, room for 1065")),
    ("mut_point-time-color__empty.las", Refused(Kind::Format, "the file is empty")),
    ("mut_point-time-color__header_size_small.las", Refused(Kind::Format, "header has 100 bytes, a LAS 1.2 header has at least 227")),
    ("mut_point-time-color__offset_in_header.las", Refused(Kind::Format, "begin at byte 100, within the header of 227")),
    ("mut_point-time-color__offset_inf.las", Refused(Kind::Format, "x offset is inf")),
    ("mut_point-time-color__offset_past_eof.las", Refused(Kind::Format, "begin at byte 36537, but the file has 36437")),
    ("mut_point-time-color__only_signature.las", Refused(Kind::Format, "ends after 4 bytes")),
    ("mut_point-time-color__payload_bitflips.laz", Refused(Kind::Format, "(points 0 to 1064): the compressed points are damaged")),
    ("mut_point-time-color__pdrf_11.las", Refused(Kind::Unsupported, "point format 11; supported are 0 to 10")),
    ("mut_point-time-color__reclen_too_small.las", Refused(Kind::Format, "records of 12 bytes; point format 3 has at least 34")),
    ("mut_point-time-color__reclen_zero.las", Refused(Kind::Format, "records of 0 bytes; point format 3 has at least 34")),
    ("mut_point-time-color__scale_nan.las", Refused(Kind::Format, "scale is NaN")),
    ("mut_point-time-color__scale_zero.las", Refused(Kind::Format, "scale is 0")),
    ("mut_point-time-color__truncated_half.laz", Cut(510, "the file ends within its compressed points: 510 of 1065")),
    ("mut_point-time-color__truncated_midrecord.las", Cut(532, "states 1065 points, but the file holds 532 and 11 bytes of another")),
    ("mut_point-time-color__version_9_9.las", Refused(Kind::Unsupported, "LAS version 9.9; supported are 1.0 to 1.5")),
    ("mut_point-time-color__vlr_count_huge.las", Warned(1065, "states 2147483647 variable length records; 0 were found")),
    ("nocrs.las", Full(30)),
    ("spec_3.las", Full(10)),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_broken_file_has_its_fate() {
    let folder = testkit::shared("lidar/broken");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| is_las(name))
        .collect();
    names.sort();
    let mut listed: Vec<&str> = BROKEN.iter().map(|(name, _)| *name).collect();
    listed.sort_unstable();
    assert_eq!(names, listed);
    let facts = facts();
    for (name, fate) in BROKEN {
        let path = folder.join(name);
        let started = Instant::now();
        let mut result = las::open(&path).and_then(|mut source| summarize(&mut source));
        if let (Cut(_, words), Err(error)) = (fate, &result) {
            assert_eq!(
                (error.kind(), error.path()),
                (Kind::Format, Some(path.as_path())),
                "{error}"
            );
            assert!(error.to_string().contains(words), "{error}");
            assert!(
                error.cure_text().unwrap().plain().contains("partial"),
                "{error}"
            );
            result = las::open_with(&path, breakline::io::OnDamage::Accept)
                .and_then(|mut source| summarize(&mut source));
        } else {
            assert!(!matches!(fate, Cut(..)), "{name}");
        }
        assert!(
            started.elapsed() < Duration::from_secs(5),
            "{name} took {:?}",
            started.elapsed()
        );
        match (fate, result) {
            (Full(count), Ok(found)) => {
                assert_eq!(found.count, *count, "{name}");
                assert!(
                    !found.warnings.iter().any(|w| w.contains("point")),
                    "{name}: {:?}",
                    found.warnings
                );
                compare_with_fact(&path, &found, &facts[&format!("lidar/broken/{name}")]);
            }
            (Warned(count, words) | Cut(count, words), Ok(found)) => {
                assert_eq!(found.count, *count, "{name}: {:?}", found.warnings);
                assert!(
                    found.warnings.iter().any(|w| w.contains(words)),
                    "{name}: {:?}",
                    found.warnings
                );
                compare_with_fact(&path, &found, &facts[&format!("lidar/broken/{name}")]);
            }
            (Refused(kind, words), Err(error)) => {
                assert_eq!(error.kind(), *kind, "{error}");
                assert!(error.to_string().contains(words), "{error}");
                assert_eq!(error.path(), Some(path.as_path()));
                let text = error.to_string();
                assert!(
                    ["byte ", "record ", "chunk "]
                        .iter()
                        .any(|at| text.contains(&format!(": {at}"))),
                    "{text}"
                );
                assert!(error.cure_text().is_some(), "{text}");
            }
            (_, Ok(found)) => panic!("{name}: read {} points, {:?}", found.count, found.warnings),
            (_, Err(error)) => panic!("{name}: {error}"),
        }
    }
}

/// Where another reader got all the points, ours are the same.
fn compare_with_fact(path: &Path, found: &Summary, fact: &Value) {
    check_crs(
        &path.to_string_lossy(),
        las::open_with(path, breakline::io::OnDamage::Accept)
            .unwrap()
            .info(),
        fact,
    );
    if fact.get("sum_int_xyz").is_none() {
        return;
    }
    let sums = fact["sum_int_xyz"].as_array().unwrap();
    assert_eq!(
        found.lattice_sums,
        [0, 1, 2].map(|i| i128::from(sums[i].as_i64().unwrap())),
        "{}",
        path.display()
    );
}

/// What a cut or damaged LAZ file still gives are points of the whole file.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn points_before_the_damage_are_good() {
    for (cut, whole) in [
        (
            "mut_Topography__truncated_half.laz",
            "quebec_lidR/Topography.laz",
        ),
        (
            "mut_point-time-color__truncated_half.laz",
            "formats/lazrs/point-time-color.las",
        ),
        (
            "mut_point-time-color__chunktable_ptr_garbage.laz",
            "formats/lazrs/point-time-color.las",
        ),
    ] {
        let cut = testkit::shared(&format!("lidar/broken/{cut}"));
        let whole = testkit::shared(&format!("lidar/{whole}"));
        let (part, all) = (columns(&cut), columns(&whole));
        let count = part.len();
        assert!(count > 500);
        assert_eq!(part.x, all.x[..count], "{}", cut.display());
        assert_eq!(part.y, all.y[..count]);
        assert_eq!(part.z, all.z[..count]);
        assert_eq!(part.class, all.class[..count]);
    }
}

/// All points of a file that are there.
fn columns(path: &Path) -> PointBatch {
    let mut source = las::open_with(path, breakline::io::OnDamage::Accept).unwrap();
    let (mut all, mut batch) = (PointBatch::default(), PointBatch::default());
    loop {
        source.read(&mut batch).unwrap();
        if batch.is_empty() {
            return all;
        }
        all.x.append(&mut batch.x);
        all.y.append(&mut batch.y);
        all.z.append(&mut batch.z);
        all.class.append(&mut batch.class);
        all.flags.append(&mut batch.flags);
        all.return_number.append(&mut batch.return_number);
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_stream_gives_what_its_file_gives() {
    for path in [
        "lidar/formats/lazrs/point10.laz",
        "lidar/formats/simple.las",
    ] {
        let file = testkit::shared(path);
        let mut from_file = las::open(&file).unwrap();
        let mut from_stream =
            las::from_stream(std::fs::File::open(&file).unwrap(), PathBuf::from("stream")).unwrap();
        let (a, b) = (
            summarize(&mut from_file).unwrap(),
            summarize(&mut from_stream).unwrap(),
        );
        assert_eq!((a.count, a.lattice_sums), (b.count, b.lattice_sums));
        assert_eq!(a.count, 1065);
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn points_are_opened_by_what_they_are() {
    for (path, format, count) in [
        (
            "lidar/formats/simple_with_page.copc.laz",
            "LAS 1.4, point format 7, COPC",
            1065,
        ),
        (
            "lidar/formats/lazrs/point-color.las",
            "LAS 1.2, point format 2",
            1065,
        ),
    ] {
        let file = testkit::shared(path);
        let mut source = points::open(&file).unwrap();
        assert_eq!(source.info().format, format);
        assert_eq!(summarize(source.as_mut()).unwrap().count, count);
        // Named as something else, it is known by its first bytes.
        let folder = tempfile::tempdir().unwrap();
        let renamed = folder.path().join("points.txt");
        std::fs::copy(&file, &renamed).unwrap();
        assert_eq!(points::open(&renamed).unwrap().info().format, format);
    }
    let mut source = points::open(testkit::shared("shp/shapelib_eg/masspntz.shp")).unwrap();
    let mut batch = PointBatch::default();
    source.read(&mut batch).unwrap();
    assert_eq!(batch.len(), 815);
    assert!(batch.z.iter().all(|z| (678.0..1050.0).contains(z)));
    let lines = testkit::shared("shp/shapelib_eg/brklinz.shp");
    let error = points::open(&lines).map(|_| ()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("has no points, but 122 other shapes"),
        "{error}"
    );
    assert_eq!(error.path(), Some(lines.as_path()));
    let error = points::open(testkit::shared("dem/bigtujunga.tif"))
        .map(|_| ())
        .unwrap_err();
    assert_eq!(error.kind(), Kind::Unsupported);
    assert!(
        error
            .to_string()
            .contains("a TIFF file; points are read from LAS"),
        "{error}"
    );
}

/// Points written as text come back as they were.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn text_of_real_points_is_read_back() {
    use std::fmt::Write as _;
    let all = columns(&testkit::shared("lidar/lake_breakline/lake.laz"));
    let mut text = String::from("Easting;Northing;Height;Class\n");
    for i in 0..all.len() {
        writeln!(
            text,
            "{};{};{};{}",
            all.x[i], all.y[i], all.z[i], all.class[i]
        )
        .unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lake.csv");
    // One line with a decimal comma among lines with points.
    let (first, rest) = text.split_at(text.len() / 2);
    std::fs::write(&path, format!("{first}{}", rest.replace('.', ","))).unwrap();
    let error = summarize(&mut *points::open(&path).unwrap())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("has a comma and") && error.contains("has a point"),
        "{error}"
    );
    std::fs::write(&path, text.replace('.', ",")).unwrap();
    let mut source = points::open(&path).unwrap();
    assert!(source.info().has_classes);
    let (mut read, mut batch) = (PointBatch::default(), PointBatch::default());
    loop {
        source.read(&mut batch).unwrap();
        if batch.is_empty() {
            break;
        }
        read.x.append(&mut batch.x);
        read.y.append(&mut batch.y);
        read.z.append(&mut batch.z);
        read.class.append(&mut batch.class);
    }
    assert_eq!(
        (read.x, read.y, read.z, read.class),
        (all.x, all.y, all.z, all.class)
    );
}

/// Bytes changed at random: an answer, in time, whatever they are.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn changed_bytes_do_not_bring_it_down() {
    let mut state = 1_u64;
    let mut random = move || {
        // Knuth's MMIX generator.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    for path in [
        "lidar/formats/lazrs/point-time-color.laz",
        "lidar/formats/1_4_w_evlr.laz",
        "lidar/formats/1.2-with-color.copc.laz",
        "lidar/formats/simple-laszip-compressor-version-1.2r0.laz",
        "lidar/formats/test1_4.las",
    ] {
        let file = testkit::shared(path);
        let bytes = std::fs::read(file).unwrap();
        for round in 0..200 {
            let mut changed = bytes.clone();
            for _ in 0..=random() % 4 {
                // Two of three rounds change the head, where one byte means most.
                let at = if round % 3 == 0 {
                    random() % changed.len()
                } else {
                    random() % 600
                };
                changed[at] = random() as u8;
            }
            if round % 7 == 0 {
                changed.truncate(random() % bytes.len());
            }
            let started = Instant::now();
            let result = las::from_stream(&changed[..], "changed")
                .and_then(|mut source| summarize(&mut source));
            assert!(
                started.elapsed() < Duration::from_secs(5),
                "{path}, round {round}: {:?}",
                result.map(|s| s.count)
            );
        }
    }
}
