//! Points from file to file, judged by the crate `las`, by bytes and by counting.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use breakline::crs::Crs;
use breakline::data::{LasHead, PointBatch, PointSource, Return};
use breakline::io::OnDamage;
use breakline::io::las::{Detail, ReadOptions, Rounding};
use breakline::io::{OutputSet, las as ours, points};
use breakline::run::{Context, PointsReport, PointsRequest, SystemOptions, Withheld, write_points};
use las::{Builder, Point, Transform, Vector, Version, Vlr, Writer};

/// The records of a file, its lattice in bits, and its head, as our reader has them.
struct Whole {
    records: Vec<u8>,
    head: LasHead,
    bounds: [[f64; 3]; 2],
    returns: BTreeMap<u8, u64>,
    count: u64,
}

fn read(path: &Path) -> breakline::Result<Whole> {
    let mut source = ours::open_with(
        path,
        ReadOptions {
            cut: OnDamage::Refuse,
            detail: Detail::Records,
        },
    )?;
    let mut whole = Whole {
        records: Vec::new(),
        head: source.info().head.clone().unwrap(),
        bounds: [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]],
        returns: BTreeMap::new(),
        count: 0,
    };
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            return Ok(whole);
        }
        whole.count += batch.len() as u64;
        whole.records.extend_from_slice(&batch.records);
        batch
            .return_number
            .iter()
            .for_each(|&number| *whole.returns.entry(number).or_default() += 1);
        for (axis, column) in [&batch.x, &batch.y, &batch.z].into_iter().enumerate() {
            for &value in column {
                whole.bounds[0][axis] = whole.bounds[0][axis].min(value);
                whole.bounds[1][axis] = whole.bounds[1][axis].max(value);
            }
        }
    }
}

fn request(files: &[&Path]) -> PointsRequest {
    PointsRequest {
        files: files.iter().map(|path| path.to_path_buf()).collect(),
        ..PointsRequest::default()
    }
}

fn copy(request: &PointsRequest, target: &Path) -> breakline::Result<PointsReport> {
    let set = OutputSet::default();
    let report = write_points(request, set.at(target), &Context::default())?;
    set.commit()?;
    Ok(report)
}

/// Checks the header of an output against its points, counted, and against the crate `las`.
fn check_header(path: &Path, expected: &Whole) {
    let reader = las::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let header = reader.header();
    assert_eq!(
        header.number_of_points(),
        expected.count,
        "{}",
        path.display()
    );
    assert!(header.generating_software().starts_with("breakline "));
    let bounds = header.bounds();
    assert_eq!(
        [bounds.min.x, bounds.min.y, bounds.min.z],
        expected.bounds[0],
        "{}",
        path.display()
    );
    assert_eq!(
        [bounds.max.x, bounds.max.y, bounds.max.z],
        expected.bounds[1],
        "{}",
        path.display()
    );
    for number in 1..=5 {
        let counted = expected.returns.get(&number).copied().unwrap_or(0);
        assert_eq!(
            header.number_of_points_by_return(number).unwrap_or(0),
            counted,
            "{} {number}",
            path.display()
        );
    }
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_below(&path));
        } else if path.extension().is_some_and(|e| e == "las" || e == "laz") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_byte_of_every_real_record_stays() {
    let folder = tempfile::tempdir().unwrap();
    let (mut copied, mut judged) = (0, 0);
    for path in files_below(&testkit::shared("lidar")) {
        let name = path.display();
        let Ok(whole) = read(&path) else { continue };
        for extension in ["las", "laz"] {
            let target = folder.path().join(format!("copy.{extension}"));
            match copy(&request(&[&path]), &target) {
                Ok(report) => assert_eq!(
                    (report.read, report.written.count),
                    (whole.count, whole.count),
                    "{name}"
                ),
                Err(error) => {
                    let text = error.to_string();
                    let known = ["waveforms", "no points in the input", "not a LAS file"];
                    assert!(known.iter().any(|known| text.contains(known)), "{error}");
                    assert!(!target.exists());
                    continue;
                }
            }
            let back = read(&target).unwrap();
            assert!(
                back.records == whole.records,
                "{name}: records differ as {extension}"
            );
            assert_eq!(back.head.records, whole.head.records, "{name}");
            assert_eq!(back.head.late_records, whole.head.late_records, "{name}");
            check_header(&target, &whole);
            copied += 1;
            // The crate refuses files that we read, and panics on some.
            let judge = || las::Reader::from_path(&path).and_then(|mut reader| reader.read_all());
            if let Ok(Ok(theirs)) = std::panic::catch_unwind(judge) {
                let ours = las::Reader::from_path(&target).unwrap().read_all().unwrap();
                assert!(
                    ours.raw_bytes() == theirs.raw_bytes(),
                    "{name}: the crate las reads other records"
                );
                judged += 1;
            }
            fs::remove_file(&target).unwrap();
        }
    }
    assert!(
        copied > 120 && judged > 120,
        "{copied} copied, {judged} judged"
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn damaged_files_give_an_error_and_no_output() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("copy.laz");
    let mut refused = 0;
    for path in files_below(&testkit::shared("lidar/broken")) {
        match copy(&request(&[&path]), &target) {
            Ok(_) => {
                let (before, after) = (read(&path).unwrap(), read(&target).unwrap());
                assert!(before.records == after.records, "{}", path.display());
                fs::remove_file(&target).unwrap();
            }
            Err(_) => {
                assert_eq!(
                    fs::read_dir(folder.path()).unwrap().count(),
                    0,
                    "{}",
                    path.display()
                );
                refused += 1;
            }
        }
    }
    assert!(refused > 15, "{refused}");
}

/// What a file of the crate `las` is made of.
struct Spec {
    version: (u8, u8),
    format: u8,
    extra: u16,
    scale: f64,
    offset: f64,
    points: usize,
}

const SPEC: Spec = Spec {
    version: (1, 4),
    format: 6,
    extra: 0,
    scale: 0.01,
    offset: 500_000.0,
    points: 200,
};

fn write(path: &Path, spec: &Spec, vlrs: Vec<Vlr>) {
    let mut format = las::point::Format::new(spec.format).unwrap();
    format.extra_bytes = spec.extra;
    format.is_compressed = path.extension().is_some_and(|e| e == "laz");
    let axis = Transform {
        scale: spec.scale,
        offset: spec.offset,
    };
    let mut builder = Builder::from(spec.version);
    builder.version = Version::new(spec.version.0, spec.version.1);
    builder.point_format = format;
    builder.transforms = Vector {
        x: axis,
        y: axis,
        z: axis,
    };
    builder.vlrs = vlrs;
    let mut writer = Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    for i in 0..spec.points {
        let at = |step: usize| spec.offset + ((i * step) % 1000) as f64 * spec.scale;
        let return_number = (1 + i % if format.is_extended { 15 } else { 5 }) as u8;
        let point = Point {
            x: at(7),
            y: at(13),
            z: at(29),
            intensity: i as u16,
            return_number,
            number_of_returns: return_number,
            classification: las::point::Classification::new((i % 5) as u8).unwrap(),
            is_withheld: i % 10 == 3,
            gps_time: format.has_gps_time.then_some(i as f64 * 0.25),
            color: format.has_color.then(|| las::Color::new(i as u16, 2, 3)),
            nir: format.has_nir.then_some(9),
            waveform: format.has_waveform.then(Default::default),
            extra_bytes: vec![i as u8; spec.extra.into()],
            ..Point::default()
        };
        writer.write_point(point).unwrap();
    }
    fs::write(path, writer.into_inner().unwrap().into_inner()).unwrap();
}

#[test]
fn every_version_and_point_format_is_copied() {
    let folder = tempfile::tempdir().unwrap();
    for minor in 0..=4 {
        let formats = match minor {
            0 | 1 => 0..=1,
            2 => 0..=3,
            3 => 0..=5,
            _ => 0..=10,
        };
        for format in formats {
            for extra in [0, 5] {
                let spec = Spec {
                    version: (1, minor),
                    format,
                    extra,
                    ..SPEC
                };
                let path = folder.path().join("a.las");
                write(&path, &spec, Vec::new());
                let target = folder.path().join("b.laz");
                let result = copy(&request(&[&path]), &target);
                if matches!(format, 4 | 5 | 9 | 10) {
                    assert!(result.unwrap_err().to_string().contains("waveforms"));
                    continue;
                }
                result.unwrap();
                let (before, after) = (read(&path).unwrap(), read(&target).unwrap());
                assert!(
                    before.records == after.records,
                    "1.{minor}, format {format}, {extra} extra bytes"
                );
                assert_eq!(after.head.header[24..26], before.head.header[24..26]);
                check_header(&target, &before);
                let theirs = las::Reader::from_path(&target).unwrap().read_all().unwrap();
                assert!(theirs.raw_bytes() == before.records);
            }
        }
    }
}

/// The records of one length for which `keep` holds.
fn kept(whole: &Whole, keep: impl Fn(usize) -> bool) -> Vec<u8> {
    let records = whole
        .records
        .chunks_exact(usize::from(whole.head.record_length));
    records
        .enumerate()
        .filter(|(i, _)| keep(*i))
        .flat_map(|(_, record)| record.to_vec())
        .collect()
}

#[test]
fn points_are_selected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.las");
    write(&path, &SPEC, Vec::new());
    let whole = read(&path).unwrap();
    let target = folder.path().join("b.las");
    let run = |request: PointsRequest| {
        let report = copy(&request, &target).unwrap();
        (read(&target).unwrap().records, report)
    };
    let all = || request(&[&path]);

    let (records, report) = run(PointsRequest {
        classes: vec![2, 4],
        ..all()
    });
    assert!(records == kept(&whole, |i| [2, 4].contains(&(i % 5))));
    assert_eq!((report.written.count, report.other_class), (80, 120));
    let (records, _) = run(PointsRequest {
        returns: vec![Return::Number(1), Return::Number(15)],
        ..all()
    });
    assert!(records == kept(&whole, |i| [1, 15].contains(&(1 + i % 15))));
    let (records, report) = run(PointsRequest {
        withheld: Withheld::Drop,
        ..all()
    });
    assert!(records == kept(&whole, |i| i % 10 != 3));
    assert_eq!(report.withheld, 20);

    // The border of a triangle and of a box is in them: whole steps from the offset.
    let column_and_row = |i: usize| [(i * 7) % 1000, (i * 13) % 1000];
    let corners = [[0, 0], [700, 0], [0, 700], [0, 0]]
        .map(|p: [i32; 2]| p.map(|c| 500_000.0 + f64::from(c) * 0.01));
    let ring: Vec<String> = corners.iter().map(|[x, y]| format!("[{x},{y}]")).collect();
    let polygon = folder.path().join("p.geojson");
    fs::write(
        &polygon,
        format!(
            r#"{{"type":"Polygon","coordinates":[[{}]]}}"#,
            ring.join(",")
        ),
    )
    .unwrap();
    let (records, report) = run(PointsRequest {
        boundary: vec![polygon],
        ..all()
    });
    let strictly = kept(&whole, |i| {
        column_and_row(i)[0] + column_and_row(i)[1] < 700
    })
    .len();
    assert!(records.len() >= strictly && report.outside > 0);
    let within = |i: usize| column_and_row(i)[0] + column_and_row(i)[1] <= 700;
    assert!(records.len() <= kept(&whole, within).len());
    let bounds = breakline::data::Bounds {
        min: [500_001.0, 500_000.0, f64::NEG_INFINITY],
        max: [500_005.0, 500_009.0, f64::INFINITY],
    };
    let (records, _) = run(PointsRequest {
        bounds: Some(bounds),
        ..all()
    });
    assert!(
        records
            == kept(&whole, |i| (100..=500).contains(&column_and_row(i)[0])
                && column_and_row(i)[1] <= 900)
    );

    let error = copy(
        &PointsRequest {
            classes: vec![77],
            ..all()
        },
        &folder.path().join("none.las"),
    )
    .unwrap_err();
    assert!(
        error.to_string().contains("no point is left of 200 read"),
        "{error}"
    );
    assert!(!folder.path().join("none.las").exists());
}

#[test]
fn files_of_scales_that_go_together_merge_without_a_loss() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, target] = ["a.las", "b.laz", "c.laz"].map(|name| folder.path().join(name));
    write(&a, &SPEC, Vec::new());
    write(
        &b,
        &Spec {
            scale: 0.001,
            offset: 499_000.0,
            ..SPEC
        },
        Vec::new(),
    );
    copy(&request(&[&a, &b]), &target).unwrap();
    let [mut one, mut two, mut both] =
        [&a, &b, &target].map(|path| las::Reader::from_path(path).unwrap());
    assert_eq!(
        both.header().transforms().x,
        Transform {
            scale: 0.001,
            offset: 499_000.0
        }
    );
    let [one, two, both] = [&mut one, &mut two, &mut both].map(|reader| reader.read_all().unwrap());
    assert_eq!(both.len(), 400);
    let expected = one.points().chain(two.points()).map(Result::unwrap);
    for (found, expected) in both.points().map(Result::unwrap).zip(expected) {
        assert!((found.x - expected.x).abs() < 1e-9 && (found.z - expected.z).abs() < 1e-9);
        // All else is as it was.
        assert_eq!(
            Point {
                x: 0.0,
                y: 0.0,
                z: 0.0,
                ..found
            },
            Point {
                x: 0.0,
                y: 0.0,
                z: 0.0,
                ..expected
            }
        );
    }
}

#[test]
fn what_would_be_lost_is_refused_unless_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, target] = ["a.las", "b.las", "c.las"].map(|name| folder.path().join(name));
    write(&a, &SPEC, Vec::new());
    for (other, message) in [
        (
            Spec {
                scale: 0.003,
                ..SPEC
            },
            "are not all steps of",
        ),
        (
            Spec { format: 7, ..SPEC },
            "different point formats: 6 and 7",
        ),
        (Spec { extra: 2, ..SPEC }, "different extra bytes"),
    ] {
        write(&b, &other, Vec::new());
        let error = copy(&request(&[&a, &b]), &target).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
        assert!(!target.exists());
    }
    write(
        &b,
        &Spec {
            scale: 0.003,
            ..SPEC
        },
        Vec::new(),
    );
    copy(
        &PointsRequest {
            rounding: Rounding::Nearest,
            ..request(&[&a, &b])
        },
        &target,
    )
    .unwrap();
    let [mut two, mut both] = [&b, &target].map(|path| las::Reader::from_path(path).unwrap());
    let (two, both) = (two.read_all().unwrap(), both.read_all().unwrap());
    for (found, expected) in both.x().skip(200).zip(two.x()) {
        assert!(
            (found - expected).abs() <= 0.005 + 1e-9,
            "{found} {expected}"
        );
    }

    let text = folder.path().join("a.xyz");
    fs::write(&text, "1 2 3\n").unwrap();
    let error = copy(&request(&[&text]), &target).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("only if they come from LAS or LAZ"),
        "{error}"
    );
}

fn system(code: u32) -> Option<Crs> {
    Some(Crs::from_epsg(code).unwrap())
}

/// Returns the records of a file that state a coordinate system, by number.
fn stated(head: &LasHead) -> Vec<u16> {
    let all = head.records.iter().chain(&head.late_records);
    let of_system = all.filter(|record| record[2..].starts_with(b"LASF_Projection\0"));
    of_system
        .map(|record| u16::from_le_bytes([record[18], record[19]]))
        .collect()
}

#[test]
fn an_assigned_system_is_stated_and_nothing_else_changes() {
    let folder = tempfile::tempdir().unwrap();
    let [path, one, two] = ["a.las", "b.laz", "c.las"].map(|name| folder.path().join(name));
    let other = Vlr {
        user_id: "other".into(),
        record_id: 7,
        description: "kept".into(),
        data: vec![1, 2, 3],
    };
    for (version, format, records) in [
        ((1, 0), 0, &[34735, 34737][..]),
        ((1, 4), 3, &[34735, 34737]),
        ((1, 4), 6, &[2112]),
        ((1, 4), 8, &[2112]),
    ] {
        write(
            &path,
            &Spec {
                version,
                format,
                ..SPEC
            },
            vec![other.clone()],
        );
        let before = read(&path).unwrap();
        let assign = |code, files: &[&Path], target: &Path| {
            let systems = SystemOptions {
                assign: system(code),
                ..SystemOptions::default()
            };
            copy(
                &PointsRequest {
                    systems,
                    ..request(files)
                },
                target,
            )
            .unwrap()
        };
        assert_eq!(assign(3005, &[&path], &one).crs, system(3005));
        // Replaced, not added.
        assign(25832, &[&one], &two);
        for (file, code) in [(&one, 3005), (&two, 25832)] {
            let source = ours::open(file).unwrap();
            assert!(
                source
                    .info()
                    .crs
                    .as_ref()
                    .unwrap()
                    .is_same(&system(code).unwrap()),
                "{version:?} {format} {code}"
            );
            assert!(
                source.info().warnings.is_empty(),
                "{:?}",
                source.info().warnings
            );
            let after = read(file).unwrap();
            assert!(after.records == before.records);
            assert_eq!(stated(&after.head), records, "{version:?} {format}");
            assert_eq!(after.head.header[6] & 16 != 0, records == [2112]);
            assert!(
                before
                    .head
                    .records
                    .iter()
                    .all(|record| after.head.records.contains(record))
            );
            check_header(file, &before);
        }
        // Files of different systems are merged if all are said to be in one.
        let error = copy(&request(&[&one, &two]), &folder.path().join("d.las")).unwrap_err();
        assert!(
            error.to_string().contains("two coordinate systems"),
            "{error}"
        );
        let merged = folder.path().join("e.las");
        assign(25833, &[&one, &two], &merged);
        assert_eq!(stated(&read(&merged).unwrap().head), records);
    }
}

#[test]
fn reprojecting_to_the_same_system_changes_no_record() {
    let folder = tempfile::tempdir().unwrap();
    let [path, target] = ["a.las", "b.las"].map(|name| folder.path().join(name));
    write(&path, &SPEC, Vec::new());
    let systems = SystemOptions {
        assign: system(25832),
        target: system(25832),
        ..SystemOptions::default()
    };
    copy(
        &PointsRequest {
            systems,
            ..request(&[&path])
        },
        &target,
    )
    .unwrap();
    assert!(read(&path).unwrap().records == read(&target).unwrap().records);
    // Nothing is known of where the points are.
    let systems = SystemOptions {
        target: system(25832),
        ..SystemOptions::default()
    };
    let error = copy(
        &PointsRequest {
            systems,
            ..request(&[&path])
        },
        &folder.path().join("c.las"),
    )
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("no coordinate system to reproject from"),
        "{error}"
    );
}

#[cfg(feature = "proj")]
#[test]
fn reprojected_points_are_within_half_a_step_and_keep_their_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let [path, target] = ["a.las", "b.laz"].map(|name| folder.path().join(name));
    for format in [1, 7] {
        write(
            &path,
            &Spec {
                format,
                extra: 3,
                ..SPEC
            },
            Vec::new(),
        );
        let coordinates = |path: &Path| {
            let (mut source, mut batch) = (ours::open(path).unwrap(), PointBatch::default());
            source.read(&mut batch).unwrap();
            (0..batch.len())
                .map(|i| [batch.x[i], batch.y[i], batch.z[i]])
                .collect::<Vec<_>>()
        };
        let mut expected = coordinates(&path);
        for (code, step) in [(25833, 0.01), (4326, 1e-7)] {
            let systems = SystemOptions {
                assign: system(25832),
                target: system(code),
                ..SystemOptions::default()
            };
            let report = copy(
                &PointsRequest {
                    systems,
                    ..request(&[&path])
                },
                &target,
            )
            .unwrap();
            assert_eq!(report.crs, system(code));
            let (before, after) = (read(&path).unwrap(), read(&target).unwrap());
            let there = breakline::run::proj::transform(
                &system(25832).unwrap(),
                &system(code).unwrap(),
                &Default::default(),
            )
            .unwrap();
            expected.copy_from_slice(&coordinates(&path));
            there.transform(&mut expected).unwrap();
            for (found, expected) in coordinates(&target).iter().zip(&expected) {
                assert!(
                    (0..2).all(|k| (found[k] - expected[k]).abs() <= 0.5001 * step),
                    "{found:?} {expected:?}"
                );
                assert_eq!(
                    found[2], expected[2],
                    "the same heights, on the same lattice"
                );
            }
            let length = usize::from(before.head.record_length);
            for (before, after) in before
                .records
                .chunks_exact(length)
                .zip(after.records.chunks_exact(length))
            {
                assert_eq!(before[8..], after[8..]);
            }
            check_header(&target, &after);
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn the_bytes_depend_on_neither_threads_nor_the_day() {
    let folder = tempfile::tempdir().unwrap();
    let source = testkit::shared("lidar/fusa/fusa.laz");
    let outputs = [1, 2, 5].map(|threads| {
        let target = folder.path().join(format!("{threads}.laz"));
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| copy(&request(&[&source]), &target).map(drop))
            .unwrap();
        fs::read(target).unwrap()
    });
    assert!(outputs[0] == outputs[1] && outputs[0] == outputs[2]);
    // The date is that of the source.
    assert_eq!(outputs[0][90..94], fs::read(source).unwrap()[90..94]);
}

#[test]
fn points_are_written_as_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.las");
    write(&path, &Spec { points: 3, ..SPEC }, Vec::new());
    for (name, text) in [
        (
            "b.xyz",
            "500000 500000 500000\n500000.07 500000.13 500000.29\n500000.14 500000.26 500000.58\n",
        ),
        (
            "b.csv",
            "x,y,z,class\n500000,500000,500000,0\n500000.07,500000.13,500000.29,1\n500000.14,500000.26,500000.58,2\n",
        ),
    ] {
        let target = folder.path().join(name);
        copy(&request(&[&path]), &target).unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), text);
        let mut back = points::open(&target).unwrap();
        let mut batch = PointBatch::default();
        back.read(&mut batch).unwrap();
        assert_eq!(batch.x, [500_000.0, 500_000.07, 500_000.14]);
    }
}
