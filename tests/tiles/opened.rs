//! Points that are larger than memory: verbs that ask a surface have the results of one piece.

use std::fmt::{Debug, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use breakline::data::{Bounds, Layer, Shape};
use breakline::error::Kind;
use breakline::run::{
    self, AccuracyOptions, AreaOptions, CompareOptions, Context, DrapeOptions, EdgeLimit,
    Execution, Existing, FrameOptions, Input, Model, Monitor, Notice, ProfileOptions, Progress,
    SampleOptions, SampledField, SectionOptions, SectionStations, Size, Source, Stage,
    SurfaceOptions, SurfaceProduct, SurfaceRequest, Targets, TileOptions, TinRequest, VolumeBase,
    VolumeOptions, WriteRequest,
};
use breakline::terrain::Method;
use tempfile::TempDir;
use testkit::random::Random;

use super::layer;

/// So little that any points are larger.
const LITTLE: Option<u64> = Some(1);

/// Points on a small grid, in files by columns: many triangles are decided by ties, and lines run
/// along edges between tiles.
fn tiles(random: &mut Random, folder: &TempDir) -> Vec<PathBuf> {
    let column = |number: usize| {
        let name = folder.path().join(format!("{number}.xyz"));
        let row = |_| {
            let x = 10 * number + random.index(9);
            format!("{x} {} {}\n", random.index(31), random.index(12))
        };
        let rows: String = (0..150).map(row).collect();
        std::fs::write(&name, rows).unwrap();
        name
    };
    (0..4).map(column).collect()
}

/// Lines between positions of the grid and half-way between them, some beyond the surface.
fn lines(random: &mut Random, count: usize) -> Vec<Vec<[f64; 3]>> {
    let mut point = || {
        let [x, y] = [45, 37].map(|side| random.index(2 * side) as f64 / 2.0 - 3.0);
        [x, y, random.index(9) as f64]
    };
    (0..count)
        .map(|_| vec![point(), point(), point()])
        .collect()
}

fn in_memory(lines: Vec<Vec<[f64; 3]>>) -> Input<Layer> {
    Input::Memory(Arc::new(Layer {
        shapes: lines
            .into_iter()
            .map(|line| Shape::Lines(vec![line]))
            .collect(),
        ..Layer::default()
    }))
}

/// All that is asked of a surface, as text: numbers are exact.
fn asked(surface: &SurfaceProduct, base: &SurfaceProduct, random: &mut Random) -> String {
    let context = Context::default();
    let mut text = String::new();
    let mut add = |what: &dyn Debug| writeln!(text, "{what:?}").unwrap();
    let names = || [PathBuf::from("a"), PathBuf::from("b")];

    let positions: Vec<[f64; 2]> = (0..400)
        .map(|_| [45, 37].map(|side| random.index(2 * side) as f64 / 2.0 - 3.0))
        .collect();
    let options = SampleOptions {
        add: vec![
            SampledField::Height,
            SampledField::Slope,
            SampledField::Aspect,
        ],
        ..SampleOptions::default()
    };
    add(&run::sample_positions(surface, &positions, &options, &context).unwrap());

    let points: Vec<[f64; 3]> = positions.iter().map(|&[x, y]| [x, y, 5.0]).collect();
    let checkpoints = Input::of_points(&points, None);
    let options = AccuracyOptions::default();
    let product = run::accuracy(surface, &checkpoints, &options, &context).unwrap();
    add(&(product.rows, product.sets, product.histogram));

    let options = VolumeOptions {
        names: names(),
        ..VolumeOptions::default()
    };
    for base in [
        VolumeBase::Levels(&[0.0, 3.5, 7.0]),
        VolumeBase::Surface(base),
    ] {
        add(&run::volume(surface, base, &options, &context).unwrap().rows);
    }

    let along = lines(random, 60);
    let sections = SectionOptions {
        at: SectionStations::Every(2.0),
        start: 0.0,
        widths: [6.0, 5.0],
        angle: 90.0,
        format: Default::default(),
    };
    for (step, sections) in [(None, None), (Some(0.7), None), (None, Some(sections))] {
        let options = ProfileOptions {
            along: in_memory(along.clone()),
            assign: None,
            step,
            sections,
            names: names().to_vec(),
        };
        let product = run::profile(&[surface, base], &options, &context).unwrap();
        add(&product.profiles.list);
    }
    let options = DrapeOptions {
        lines: in_memory(along),
        assign: None,
        step: None,
        name: "a".into(),
    };
    let product = run::drape(surface, &options, &context).unwrap();
    add(&(product.layer.shapes, product.off, product.partly_off));

    let options = CompareOptions {
        frame: FrameOptions {
            resolution: Some(0.5),
            ..FrameOptions::default()
        },
        areas: Some(AreaOptions {
            height: 2.0,
            min_area: 0.0,
        }),
        names: names(),
        ..CompareOptions::default()
    };
    let product = run::compare([surface, base], &options, &context).unwrap();
    add(&(product.difference.values, product.statistics, product.worst));
    add(&product.areas);
    text
}

fn request(request: TinRequest) -> SurfaceRequest {
    SurfaceRequest {
        source: Source::Points(Box::new(request)),
        ..SurfaceRequest::default()
    }
}

/// The surface in many small parts.
fn in_parts(wanted: &SurfaceRequest, folder: &TempDir) -> SurfaceProduct {
    let context = Context::default();
    let target = folder.path().join("parts.tins");
    let targets = Targets {
        existing: Existing::Replace,
        ..Targets::of(&target)
    };
    let tiles = TileOptions {
        division: "5x3".parse().unwrap(),
        ..TileOptions::default()
    };
    let write = WriteRequest::new(wanted.clone(), SurfaceOptions::default());
    run::write(&write, &targets, &Execution::Tiles(tiles), &context).unwrap();
    let source = Source::of_files(&[target]).unwrap();
    let read = SurfaceRequest {
        source,
        ..SurfaceRequest::default()
    };
    let product = run::surface(&read, &context).unwrap();
    let Model::Parts(tin) = &product.model else {
        panic!("{:?}", product.model);
    };
    assert!(tin.index().parts.len() > 5);
    product
}

#[test]
fn larger_points_are_asked_as_in_one_piece() {
    for seed in 1..=2 {
        let mut random = Random(seed);
        let folder = tempfile::tempdir().unwrap();
        let points = || -> Vec<Input<_>> {
            let files = tiles(&mut Random(seed + 7), &folder);
            files.into_iter().map(Input::File).collect()
        };
        let breaklines = folder.path().join("lines.geojson");
        std::fs::write(&breaklines, layer(&lines(&mut random, 6), "LineString")).unwrap();
        let plain = || TinRequest {
            points: points(),
            ..TinRequest::default()
        };
        let with_lines = TinRequest {
            breaklines: vec![Input::File(breaklines)],
            ..plain()
        };
        // Parts have fragments then, and gaps.
        let cut = TinRequest {
            bounds: Some(Bounds::around(&[[1.3, 2.6, 0.0], [37.1, 27.4, 0.0]])),
            max_edge: EdgeLimit::Length(3.5),
            ..plain()
        };
        let context = Context::default();
        let base = TinRequest {
            points: vec![Input::of_points(
                &[
                    [0.0, 0.0, 4.0],
                    [40.0, 0.0, 4.0],
                    [40.0, 31.0, 7.0],
                    [0.0, 31.0, 5.0],
                ],
                None,
            )],
            max_edge: EdgeLimit::Unlimited,
            ..TinRequest::default()
        };
        let base = run::surface(&request(base), &context).unwrap();
        for (number, wanted) in [plain(), with_lines, cut].into_iter().enumerate() {
            let wanted = request(wanted);
            let whole = run::surface(&wanted, &context).unwrap();
            assert!(matches!(whole.model, Model::Tin(_)));
            let opened = run::open_surface(&wanted, Method::Linear, LITTLE, &context).unwrap();
            let expected = asked(&whole, &base, &mut Random(seed + 20));
            for surface in [opened, in_parts(&wanted, &folder)] {
                assert!(matches!(surface.model, Model::Parts(_)));
                let found = asked(&surface, &base, &mut Random(seed + 20));
                for (whole, parts) in expected.lines().zip(found.lines()) {
                    assert!(whole.len() > 100, "{whole}");
                    assert_eq!(whole, parts, "{seed} {number}");
                }
                assert_eq!(expected.len(), found.len());
            }
        }
    }
}

/// Cancels when a stage begins, and keeps the folder of the files.
struct Canceler {
    at: Stage,
    cancel: AtomicBool,
    folder: std::sync::Mutex<Option<PathBuf>>,
}

impl Monitor for Canceler {
    fn start(&self, stage: Stage, _: Size) -> Box<dyn Progress> {
        self.cancel.fetch_or(stage == self.at, Ordering::Relaxed);
        Box::new(())
    }

    fn notice(&self, notice: &Notice) {
        if let Notice::BuiltInFiles { folder, .. } = notice {
            assert!(folder.is_dir());
            *self.folder.lock().unwrap() = Some(folder.clone());
        }
    }
}

#[test]
fn no_file_is_left_once_the_surface_is_gone_or_an_error_ends_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let files = tiles(&mut Random(3), &folder);
    let open = |files: &[PathBuf], at: Stage| {
        let canceler = Canceler {
            at,
            cancel: AtomicBool::new(false),
            folder: Default::default(),
        };
        let context = Context {
            monitor: &canceler,
            cancel: &canceler.cancel,
        };
        let wanted = SurfaceRequest {
            source: Source::of_files(files).unwrap(),
            ..SurfaceRequest::default()
        };
        let opened = run::open_surface(&wanted, Method::Linear, LITTLE, &context);
        let folder = canceler.folder.into_inner().unwrap().unwrap();
        (opened, folder)
    };
    let (opened, scratch) = open(&files, Stage::Simplifying);
    let opened = opened.unwrap();
    let there = |folder: &Path| std::fs::read_dir(folder).map_or(0, Iterator::count);
    assert_eq!(there(&scratch), 2, "the index and the folder of its parts");
    assert!(matches!(
        opened.notices[..],
        [Notice::BuiltInFiles { .. }, ..]
    ));
    drop(opened);
    assert!(!scratch.exists());

    for stage in [Stage::RunningTasks, Stage::WritingFaces] {
        let (opened, scratch) = open(&files, stage);
        assert_eq!(opened.unwrap_err().kind(), Kind::Canceled, "{stage:?}");
        assert!(!scratch.exists(), "{stage:?}");
    }
    std::fs::write(&files[2], "20 1 1\n21 1 1\nnonsense\n").unwrap();
    let (opened, scratch) = open(&files, Stage::Simplifying);
    let error = opened.unwrap_err();
    assert!(
        error.path().is_some_and(|path| path.ends_with("2.xyz")),
        "{error}"
    );
    // There is nothing to go on with.
    assert!(
        !format!("{:?}", error.cure_text()).contains("Resume"),
        "{error}"
    );
    assert!(!scratch.exists());
}
