//! Jobs that are found by their folders: whose they are, and what is kept of a request.

use std::fmt::Debug;
use std::path::Path;

use breakline::error::{Kind, Result, Setting};
use breakline::io::formats::Product;
use breakline::run::{
    self, BadFiles, Context, DemOptions, Division, Execution, Existing, FoundJob, FrameOptions,
    HillshadeOptions, Input, JobCommand, Keeps, LightOptions, Outputs, Source, StoredJob, Summary,
    SurfaceProduct, SurfaceRequest, Targets, TileOptions, Tiles, Verb, WriteReport, WriteRequest,
};

use super::{bytes, output_of, valley};
use crate::program::{files_of, run_in};

fn request(verb: impl Verb + 'static) -> WriteRequest {
    let source = Source::of_points(&[valley().into()]);
    WriteRequest::new(
        SurfaceRequest {
            source,
            ..SurfaceRequest::default()
        },
        verb,
    )
}

fn tiles() -> TileOptions {
    TileOptions {
        division: Division::Grid([2, 2]),
        ..TileOptions::default()
    }
}

fn command(targets: &Targets) -> JobCommand {
    JobCommand::new(&request(DemOptions::default()), targets, &tiles()).unwrap()
}

fn plan(command: &JobCommand, folder: &Path) -> Result<StoredJob> {
    run::plan_job(command, folder, &Context::default())
}

#[test]
fn a_job_is_for_the_same_outputs_and_the_same_bad_files() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["a.tif", "b.tif"].map(|name| Targets::of(folder.path().join(name)));
    let planned = command(&one);
    let job = plan(&planned, &folder.path().join("j")).unwrap();
    job.require_for(&planned).unwrap();
    StoredJob::read(job.folder())
        .unwrap()
        .require_for(&planned)
        .unwrap();

    let replacing = Targets {
        existing: Existing::Replace,
        ..one.clone()
    };
    let skipping = TileOptions {
        bad: BadFiles::Skip,
        ..tiles()
    };
    let with_tiles =
        |tiles| JobCommand::new(&request(DemOptions::default()), &one, &tiles).unwrap();
    let coarse = FrameOptions {
        resolution: Some(3.0),
        ..FrameOptions::default()
    };
    let coarse = request(DemOptions {
        frame: coarse,
        ..DemOptions::default()
    });
    for (asked, what) in [
        (command(&other), "the output"),
        (command(&replacing), "overwrite"),
        (with_tiles(skipping), "skip-bad"),
        (with_tiles(TileOptions::default()), "tiles"),
        (
            JobCommand::new(&coarse, &one, &tiles()).unwrap(),
            "resolution",
        ),
        (
            JobCommand::new(&request(HillshadeOptions::default()), &one, &tiles()).unwrap(),
            "the verb",
        ),
    ] {
        let error = job.require_for(&asked).unwrap_err();
        assert_eq!(error.kind(), Kind::OtherJob, "{error}");
        assert!(
            error
                .to_string()
                .ends_with(&format!("what differs: {what}")),
            "{error}"
        );
    }
}

#[test]
fn a_job_that_was_replaced_is_not_taken_for_the_one_before() {
    let folder = tempfile::tempdir().unwrap();
    let context = Context::default();
    let [one, other] = ["a.tif", "b.tif"].map(|name| Targets::of(folder.path().join(name)));
    let before = plan(&command(&one), &folder.path().join("j")).unwrap();
    let opened = before.job().unwrap();
    run::remove_job(before.folder(), &context).unwrap();
    let is_gone = || {
        let errors = [
            before.job().err(),
            before.remove(&context).err(),
            run::run_job(&before, &context).err(),
            run::run_task(&opened, 0, &one, &context).err(),
        ];
        for error in errors {
            let error = error.unwrap();
            assert!(
                error.kind() == Kind::OtherJob && error.to_string().contains("removed or replaced"),
                "{error}"
            );
        }
    };
    is_gone();
    let now = plan(&command(&other), before.folder()).unwrap();
    is_gone();
    assert!(!one.files[0].exists());
    run::run_job(&now, &context).unwrap();
    assert!(other.files[0].exists() && !one.files[0].exists());
    now.remove(&context).unwrap();
    assert_eq!(files_of(folder.path()), ["b.tif"]);
}

/// The header of a file is damaged when it is planned, and repaired then.
#[test]
fn whoever_has_a_job_has_it_after_it_was_planned_again() {
    let folder = tempfile::tempdir().unwrap();
    let context = Context::default();
    let repaired = folder.path().join("b.laz");
    std::fs::write(&repaired, &bytes(valley())[..10]).unwrap();
    let surface = SurfaceRequest {
        source: Source::of_points(&[valley().into(), repaired.clone()]),
        ..SurfaceRequest::default()
    };
    let tiles = TileOptions {
        bad: BadFiles::Skip,
        ..tiles()
    };
    let command = JobCommand::new(
        &WriteRequest::new(surface, DemOptions::default()),
        &Targets::of(folder.path().join("a.tif")),
        &tiles,
    );
    let job = plan(&command.unwrap(), &folder.path().join("j")).unwrap();
    let copy = job.clone();
    run::run_job(&job, &context).unwrap();
    assert!(job.job().unwrap().has_holes(&context).unwrap());
    std::fs::copy(valley(), &repaired).unwrap();
    run::run_job(&job, &context).unwrap();
    for job in [&job, &copy] {
        assert!(!job.job().unwrap().has_holes(&context).unwrap());
        let again = run::run_job(job, &context).unwrap();
        assert!(
            matches!(
                again,
                WriteReport::Kept {
                    has_holes: false,
                    ..
                }
            ),
            "{again:?}"
        );
    }
    copy.remove(&context).unwrap();
    assert_eq!(files_of(folder.path()), ["a.tif", "b.laz"]);
}

/// A job whose command is not known can be removed, but only that one.
#[test]
fn a_job_without_a_command_is_found_and_is_itself_only() {
    let folder = tempfile::tempdir().unwrap();
    let context = Context::default();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    run(&format!("dem {} -o d.tif --tiles 2x2 --job j", valley())).works(&[]);
    let before = FoundJob::read(&folder.path().join("j")).unwrap();
    let error = before.stored().unwrap_err();
    assert!(error.to_string().contains("goes on itself"), "{error}");
    before.clone().remove(&context).unwrap();
    let now = plan(
        &command(&Targets::of(folder.path().join("a.tif"))),
        before.folder(),
    );
    for error in [before.remove(&context).err(), before.stored().err()] {
        assert_eq!(error.unwrap().kind(), Kind::OtherJob);
    }
    now.unwrap().remove(&context).unwrap();
}

/// Its name is not taken for that of a file, not even if there is one.
#[test]
fn the_standard_input_is_not_for_a_job() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    for _ in 0..2 {
        for more in ["", &format!("{} --skip-bad ", valley())] {
            run(&format!("job plan j -- dem - {more}-o d.tif"))
                .fails(2, &["-: tiles are made of files, which can be read again"]);
        }
        std::fs::copy(valley(), folder.path().join("-")).unwrap();
    }
    assert_eq!(files_of(folder.path()), ["-"]);
    // Under another name it is a file.
    run("job plan j -- dem ./- -o d.tif").works(&[]);
}

#[test]
fn the_cure_for_a_file_that_has_changed_names_the_job() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    std::fs::copy(valley(), folder.path().join("a.laz")).unwrap();
    let words = "dem a.laz -o d.tif --tiles 2x2 --job j";
    run(words).works(&[]);
    std::fs::write(folder.path().join("a.laz"), &bytes(valley())[..1000]).unwrap();
    run(&format!("{words} --resume --overwrite")).fails(
        2,
        &[
            "a.laz: the file has changed since the job was planned",
            "plan the job again: `breakline job clean j` removes this one",
        ],
    );
}

#[test]
fn what_is_left_of_a_job_is_done_once() {
    let folder = tempfile::tempdir().unwrap();
    let context = Context::default();
    let output = folder.path().join("a.tif");
    let job = plan(&command(&Targets::of(&output)), &folder.path().join("j")).unwrap();
    assert!(matches!(
        run::run_job(&job, &context).unwrap(),
        WriteReport::Written(_)
    ));
    let before = std::fs::metadata(&output).unwrap().modified().unwrap();
    let again = run::run_job(&job, &context).unwrap();
    assert!(
        matches!(
            again,
            WriteReport::Kept {
                has_holes: false,
                ..
            }
        ),
        "{again:?}"
    );
    assert_eq!(
        std::fs::metadata(&output).unwrap().modified().unwrap(),
        before
    );
    // Another file in its place is not overwritten unasked.
    std::fs::write(&output, "mine").unwrap();
    assert_eq!(run::run_job(&job, &context).unwrap_err().kind(), Kind::Io);
    let mut replacing = job.clone();
    replacing.command.targets.existing = Existing::Replace;
    run::run_job(&replacing, &context).unwrap();
    assert!(bytes(&output).len() > 4);
    job.remove(&context).unwrap();
    assert!(run::run_job(&job, &context).is_err());
    assert!(StoredJob::find(job.folder()).unwrap().is_none());
    assert_eq!(files_of(folder.path()), ["a.tif"]);
}

#[test]
fn the_names_of_a_command_are_whole() {
    let tin = run::TinRequest {
        points: vec![Input::from("a.laz"), Input::from("./b/c.laz")],
        breaklines: vec![Input::from("l.gpkg:roads:z")],
        boundary: vec![Input::from("b.geojson")],
        lines: run::LineRequest {
            walls: vec![Input::from("w.shp")],
            ..run::LineRequest::default()
        },
        ..run::TinRequest::default()
    };
    let surface = SurfaceRequest {
        source: Source::Points(Box::new(tin)),
        ..SurfaceRequest::default()
    };
    let frame = FrameOptions {
        align_to: Some("r.tif".into()),
        ..FrameOptions::default()
    };
    let targets = Targets {
        also_read: vec!["list.txt".into()],
        ..Targets::of("d.tif")
    };
    for request in [
        WriteRequest::new(
            surface.clone(),
            DemOptions {
                frame: frame.clone(),
                ..DemOptions::default()
            },
        ),
        WriteRequest::new(
            surface.clone(),
            HillshadeOptions {
                frame: frame.clone(),
                ..HillshadeOptions::default()
            },
        ),
    ] {
        let command = JobCommand::new(&request, &targets, &TileOptions::default()).unwrap();
        let here = std::env::current_dir().unwrap();
        let names = [
            "a.laz",
            "b/c.laz",
            "l.gpkg:roads:z",
            "w.shp",
            "b.geojson",
            "r.tif",
        ];
        assert_eq!(command.request.files(), names.map(|name| here.join(name)));
        assert_eq!(command.targets.files, [here.join("d.tif")]);
        assert_eq!(command.targets.also_read, [here.join("list.txt")]);
    }
    let empty = WriteRequest::new(SurfaceRequest::default(), DemOptions::default());
    assert!(JobCommand::new(&empty, &Targets::of(""), &TileOptions::default()).is_err());
}

/// Planned with relative names of all kinds, a job is done by others, and by its own command.
#[test]
fn relative_names_mean_the_files_where_the_job_was_planned() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(valley(), folder.path().join("a.laz")).unwrap();
    let line = super::layer(
        &[vec![
            [688_050.0, 5_261_050.0, 800.0],
            [688_300.0, 5_261_250.0, 801.0],
        ]],
        "LineString",
    );
    std::fs::write(folder.path().join("l.geojson"), line).unwrap();
    output_of(&folder, "dem a.laz --resolution 4", "grid.tif");
    let words = "dem a.laz --breaklines l.geojson --align-to grid.tif";
    let (whole, _) = output_of(&folder, words, "whole.tif");
    let run = |folder, words: &str| run_in(folder, &words.split(' ').collect::<Vec<_>>());
    let elsewhere = tempfile::tempdir().unwrap();
    for (job, task) in [("j", None), ("k", Some(0))] {
        run(
            &folder,
            &format!("job plan {job} -- {words} -o {job}.tif --tiles 2x2"),
        )
        .works(&[]);
        let path = folder.path().join(job).to_str().unwrap().to_owned();
        match task {
            None => run(&elsewhere, &format!("job run {path}")).works(&[]),
            Some(task) => {
                run(&elsewhere, &format!("job run {path} --task {task}")).works(&[]);
                let resume = format!("{words} --tiles 2x2 --job {job} --resume -o {job}.tif");
                run(&folder, &resume).works(&["resumed     1 of"]);
                // The same names, but other files.
                run(
                    &elsewhere,
                    &resume.replace(&format!("--job {job}"), &format!("--job {path}")),
                )
                .fails(1, &["a.laz"]);
            }
        }
        assert!(bytes(folder.path().join(format!("{job}.tif"))) == whole);
    }
    assert!(files_of(elsewhere.path()).is_empty());
}

/// The cure that each error names, done.
#[test]
fn a_job_whose_command_is_damaged_can_be_removed_and_planned_again() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    let planned = format!("job plan j -- dem {} -o d.tif --tiles 2x2", valley());
    let command = folder.path().join("j/command.json");
    for damaged in [None, Some(""), Some("{\"request\":"), Some("[]")] {
        run(&planned).works(&[]);
        match damaged {
            Some(text) => std::fs::write(&command, text).unwrap(),
            None => std::fs::remove_file(&command).unwrap(),
        }
        for words in ["job run j", "job run j --task 0", "job status j"] {
            run(words).fails(1, &["command.json"]);
        }
        run("job clean j").works(&[]);
        assert!(files_of(folder.path()).is_empty(), "{damaged:?}");
    }
    // A job that keeps none.
    std::fs::write(folder.path().join("d.tif"), "mine").unwrap();
    run(&format!("dem {} --tiles 2x2 --job j -o e.tif", valley())).works(&[]);
    run("job run j").fails(2, &["goes on itself", "--resume"]);
    run("job clean j").works(&[]);
    assert_eq!(files_of(folder.path()), ["d.tif", "e.tif"]);
}

/// A verb that only its own process knows, with the name and the options of another one.
#[derive(Debug)]
struct Own(DemOptions);

impl Verb for Own {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn product(&self) -> Product {
        self.0.product()
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        self.0.list(add);
    }

    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        self.0.write(surface, outputs, context)
    }

    fn keeps(&self) -> Keeps<'_> {
        self.0.keeps()
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        self.0.write_tiles(tiles, outputs, context)
    }
}

#[test]
fn what_would_not_come_back_as_it_was_is_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let targets = Targets::of(folder.path().join("d.tif"));
    let light = |z_factor| LightOptions {
        z_factor,
        ..LightOptions::default()
    };
    let shades = |light| {
        request(HillshadeOptions {
            light,
            ..HillshadeOptions::default()
        })
    };
    let line = super::layer(
        &[vec![
            [688_050.0, 5_261_050.0, 800.0],
            [688_300.0, 5_261_250.0, 801.0],
        ]],
        "LineString",
    );
    let path = folder.path().join("l.geojson");
    std::fs::write(&path, line).unwrap();
    let line = breakline::io::layer::read(path.to_str().unwrap()).unwrap();
    std::fs::remove_file(path).unwrap();
    let in_memory = Source::Points(Box::new(run::TinRequest {
        points: vec![Input::File(valley().into())],
        breaklines: vec![Input::Memory(line.into())],
        ..run::TinRequest::default()
    }));
    let in_memory = SurfaceRequest {
        source: in_memory,
        ..SurfaceRequest::default()
    };
    for (request, said) in [
        (shades(light(Some(f64::INFINITY))), "z-factor would be lost"),
        (shades(light(Some(f64::NAN))), "z-factor would be lost"),
        (
            shades(LightOptions {
                azimuth: Some(f64::NAN),
                ..LightOptions::default()
            }),
            "azimuth would be lost",
        ),
        (
            request(Own(DemOptions::default())),
            "a job cannot keep the verb `dem`, which is not of this crate",
        ),
        (
            WriteRequest::new(in_memory, DemOptions::default()),
            "an input is in memory",
        ),
    ] {
        let command = JobCommand::new(&request, &targets, &tiles()).unwrap();
        let error = plan(&command, &folder.path().join("j")).unwrap_err();
        assert!(
            error.kind() == Kind::Unsupported && error.to_string().contains(said),
            "{error}"
        );
        assert!(files_of(folder.path()).is_empty());
    }
    // The heights of a box do not count.
    let extent = Some(breakline::data::Bounds {
        min: [688_000.0, 5_261_000.0, 1.0],
        max: [688_100.0, 5_261_100.0, 2.0],
    });
    let frame = FrameOptions {
        extent,
        ..FrameOptions::default()
    };
    let command = JobCommand::new(
        &request(DemOptions {
            frame,
            ..DemOptions::default()
        }),
        &targets,
        &tiles(),
    )
    .unwrap();
    let job = plan(&command, &folder.path().join("j")).unwrap();
    run::run_job(&job, &Context::default()).unwrap();
}

#[test]
fn replaced_points_are_not_kept_in_tiles() {
    let points = run::TinRequest {
        points: vec![Input::File(valley().into())],
        replaced: run::ReplacedPoints::Keep,
        ..run::TinRequest::default()
    };
    let surface = SurfaceRequest {
        source: Source::Points(Box::new(points)),
        ..SurfaceRequest::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let command = JobCommand::new(
        &WriteRequest::new(surface, DemOptions::default()),
        &Targets::of(folder.path().join("d.tif")),
        &tiles(),
    );
    let error = plan(&command.unwrap(), &folder.path().join("j")).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("flat-points does not work with tiles yet"),
        "{error}"
    );
}

/// The plan is made here, and the tasks run elsewhere, with less memory.
#[test]
fn the_memory_of_a_task_is_that_of_where_it_runs() {
    let folder = tempfile::tempdir().unwrap();
    let targets = Targets::of(folder.path().join("d.tif"));
    let with = |task_memory| {
        let tiles = TileOptions {
            division: Division::Auto,
            task_memory: Some(task_memory),
            ..TileOptions::default()
        };
        JobCommand::new(&request(DemOptions::default()), &targets, &tiles).unwrap()
    };
    let job = plan(&with(2_200_000), &folder.path().join("j")).unwrap();
    let size = job.job().unwrap().size();
    assert!(size.task_memory == 2_200_000 && size.tiles > 1, "{size:?}");
    // The same, planned for other machines, goes on.
    job.require_for(&with(3_000_000)).unwrap();
}

#[test]
fn what_reads_all_tasks_can_be_canceled() {
    let folder = tempfile::tempdir().unwrap();
    let targets = Targets::of(folder.path().join("d.tif"));
    let stored = plan(&command(&targets), &folder.path().join("j")).unwrap();
    run::run_job(&stored, &Context::default()).unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let context = Context {
        cancel: &cancel,
        ..Context::default()
    };
    let job = stored.job().unwrap();
    for error in [
        job.tasks(&targets.files, &context).err(),
        job.done(&context).err(),
        job.has_holes(&context).err(),
        job.has_written(&targets.files, &context).err(),
        job.remove_damaged(&context).err(),
        job.lock(&context).err(),
        stored.remove(&context).err(),
        run::run_job(&stored, &context).err(),
        run::remove_job(stored.folder(), &context).err(),
    ] {
        assert_eq!(error.unwrap().kind(), Kind::Canceled);
    }
    assert!(
        job.has_written(&targets.files, &Context::default())
            .unwrap()
    );
}

/// Whoever cannot see what is shown meanwhile learns it from the error.
#[test]
fn an_error_of_a_job_says_where_tasks_are_kept_and_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut damaged = bytes(valley());
    // The compressed points, which begin after the header and its records, not the table behind.
    let start = u32::from_le_bytes(damaged[96..100].try_into().unwrap()) as usize + 8;
    let end = damaged.len() - 40;
    damaged[start..end].fill(0xff);
    let path = folder.path().join("a.laz");
    std::fs::write(&path, damaged).unwrap();
    // With a class, planning reads headers only.
    let points = run::TinRequest {
        points: vec![Input::File(path)],
        classes: breakline::terrain::Classes::Only(vec![2]),
        ..run::TinRequest::default()
    };
    let surface = SurfaceRequest {
        source: Source::Points(Box::new(points)),
        ..SurfaceRequest::default()
    };
    let request = WriteRequest::new(surface, DemOptions::default());
    let targets = Targets::of(folder.path().join("d.tif"));
    let context = Context::default();
    let own = run::write(&request, &targets, &Execution::Tiles(tiles()), &context).unwrap_err();
    let job = plan(
        &JobCommand::new(&request, &targets, &tiles()).unwrap(),
        &folder.path().join("j"),
    )
    .unwrap();
    let stored = run::run_job(&job, &context).unwrap_err();
    let [own_folder, job_folder] = [targets.job_folder().unwrap(), job.folder().to_path_buf()];
    for (error, said) in [
        (
            own,
            format!(
                "finished tasks are kept in {}: go on with resume",
                own_folder.display()
            ),
        ),
        (
            stored,
            format!(
                "finished tasks are kept in {0}: go on with `job run {0}`",
                job_folder.display()
            ),
        ),
    ] {
        assert_eq!(error.kind(), Kind::Format);
        let cure = error.cure_text().unwrap().plain();
        assert!(cure.ends_with(&said), "{cure}");
    }
}

/// A job that was planned for one output goes on to another: the folder alone does not know of it.
#[test]
fn a_job_that_goes_on_to_another_output_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    std::fs::copy(valley(), folder.path().join("a.laz")).unwrap();
    let words = "dem a.laz --class 2 --tiles 2x2";
    run(&format!("job plan j -- {words} -o d.tif")).works(&[]);
    let whole = bytes(valley());
    let mut damaged = whole.clone();
    let (start, end) = (damaged.len() / 4, damaged.len() - 40);
    damaged[start..end].fill(0xff);
    std::fs::write(folder.path().join("a.laz"), damaged).unwrap();
    run(&format!("{words} --resume --job j -o other.tif")).fails(1, &["go on with --resume\n"]);
    run("job run j").fails(1, &["go on with `breakline job run "]);
}

/// What a dry run shows is what the run would meet.
#[test]
fn a_dry_run_shows_the_job_that_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    let words = format!("dem {} -o d.tif --tiles 2x2 --job j", valley());
    run(&words).works(&[]);
    let end = "--overwrite --dry-run";
    run(&format!("{words} {end} --resume")).works(&["tiles       4 (of 1 files", "folder      j"]);
    run(&format!("{words} {end} --resume --class 5"))
        .fails(2, &["is that of another command; what differs: --class"]);
    for end in [end, "--overwrite"] {
        run(&format!("{words} {end}")).fails(
            2,
            &[
                "there is a job in this folder already",
                "go on with it (--resume)",
            ],
        );
    }
    run(&format!("{words} {end}").replace("--job j", "--job k"))
        .works(&["tiles       4 (of 1 files", "folder      k"]);
}

/// A plan has no names: any name will do that the system has.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_unicode_are_read_in_tiles_too() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let [points, grid] = [b"a\xff.laz", b"g\xff.tif"]
        .map(|name| folder.path().join(std::ffi::OsStr::from_bytes(name)));
    std::fs::copy(valley(), &points).unwrap();
    output_of(
        &folder,
        &format!("dem {} --resolution 4", valley()),
        "grid.tif",
    );
    std::fs::rename(folder.path().join("grid.tif"), &grid).unwrap();
    let frame = FrameOptions {
        align_to: Some(grid),
        ..FrameOptions::default()
    };
    let source = Source::of_points(&[points]);
    let surface = SurfaceRequest {
        source,
        ..SurfaceRequest::default()
    };
    let request = WriteRequest::new(
        surface,
        DemOptions {
            frame,
            ..DemOptions::default()
        },
    );
    let [one, other] = ["one.tif", "other.tif"].map(|name| Targets::of(folder.path().join(name)));
    let context = Context::default();
    run::write(&request, &one, &Execution::Whole, &context).unwrap();
    run::write(&request, &other, &Execution::Tiles(tiles()), &context).unwrap();
    assert!(bytes(&one.files[0]) == bytes(&other.files[0]));
    // To be kept, it would have to be written as text.
    let other = Targets::of(folder.path().join("third.tif"));
    let error = plan(
        &JobCommand::new(&request, &other, &tiles()).unwrap(),
        &folder.path().join("j"),
    )
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("not valid Unicode, which a job needs"),
        "{error}"
    );
}

/// Its own command goes on with a job where the folder is, and the inputs are, now.
#[test]
fn a_job_moves_with_its_inputs() {
    let [before, now] = [0, 1].map(|_| tempfile::tempdir().unwrap());
    std::fs::copy(valley(), before.path().join("a.laz")).unwrap();
    let words = "dem a.laz --tiles 2x2 --job j";
    let (whole, _) = output_of(&before, words, "d.tif");
    for name in ["a.laz", "j"] {
        std::fs::rename(before.path().join(name), now.path().join(name)).unwrap();
    }
    std::fs::remove_file(now.path().join("j/tasks/000006.task")).unwrap();
    let (moved, said) = output_of(&now, &format!("{words} --resume"), "d.tif");
    assert!(
        moved == whole && said.contains("resumed     6 of 7 tasks are done"),
        "{said}"
    );
}
