//! Jobs that are found by their folders: whose they are, and what is kept of a request.

use std::fmt::Debug;
use std::path::Path;

use breakline::error::{Kind, Result, Setting};
use breakline::io::formats::Product;
use breakline::run::{
    self, BadFiles, Context, DemOptions, Division, Existing, FrameOptions, HillshadeOptions, Input, JobCommand, Keeps,
    LightOptions, Outputs, Source, StoredJob, Summary, SurfaceProduct, SurfaceRequest, Targets, TileOptions, Tiles,
    Verb, WriteReport, WriteRequest,
};

use super::{bytes, output_of, valley};
use crate::program::{files_of, run_in};

fn request(verb: impl Verb + 'static) -> WriteRequest {
    let source = Source::of_points(&[valley().into()]);
    WriteRequest::new(SurfaceRequest { source, ..SurfaceRequest::default() }, verb)
}

fn tiles() -> TileOptions {
    TileOptions { division: Division::Grid([2, 2]), ..TileOptions::default() }
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
    StoredJob::read(job.folder()).unwrap().require_for(&planned).unwrap();

    let replacing = Targets { existing: Existing::Replace, ..one.clone() };
    let skipping = TileOptions { bad: BadFiles::Skip, ..tiles() };
    let with_tiles = |tiles| JobCommand::new(&request(DemOptions::default()), &one, &tiles).unwrap();
    let coarse = FrameOptions { resolution: Some(3.0), ..FrameOptions::default() };
    let coarse = request(DemOptions { frame: coarse, ..DemOptions::default() });
    for (asked, what) in [
        (command(&other), "the output"),
        (command(&replacing), "overwrite"),
        (with_tiles(skipping), "skip-bad"),
        (with_tiles(TileOptions::default()), "tiles"),
        (JobCommand::new(&coarse, &one, &tiles()).unwrap(), "resolution"),
        (JobCommand::new(&request(HillshadeOptions::default()), &one, &tiles()).unwrap(), "the verb"),
    ] {
        let error = job.require_for(&asked).unwrap_err();
        assert_eq!(error.kind(), Kind::OtherJob, "{error}");
        assert!(error.to_string().ends_with(&format!("what differs: {what}")), "{error}");
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
            assert!(error.kind() == Kind::OtherJob && error.to_string().contains("removed or replaced"), "{error}");
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

#[test]
fn what_is_left_of_a_job_is_done_once() {
    let folder = tempfile::tempdir().unwrap();
    let context = Context::default();
    let output = folder.path().join("a.tif");
    let job = plan(&command(&Targets::of(&output)), &folder.path().join("j")).unwrap();
    assert!(matches!(run::run_job(&job, &context).unwrap(), WriteReport::Written(_)));
    let before = std::fs::metadata(&output).unwrap().modified().unwrap();
    let again = run::run_job(&job, &context).unwrap();
    assert!(matches!(again, WriteReport::Kept { has_holes: false, .. }), "{again:?}");
    assert_eq!(std::fs::metadata(&output).unwrap().modified().unwrap(), before);
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
        lines: run::LineRequest { walls: vec![Input::from("w.shp")], ..run::LineRequest::default() },
        ..run::TinRequest::default()
    };
    let surface = SurfaceRequest { source: Source::Points(Box::new(tin)), ..SurfaceRequest::default() };
    let frame = FrameOptions { align_to: Some("r.tif".into()), ..FrameOptions::default() };
    let targets = Targets { also_read: vec!["list.txt".into()], ..Targets::of("d.tif") };
    for request in [
        WriteRequest::new(surface.clone(), DemOptions { frame: frame.clone(), ..DemOptions::default() }),
        WriteRequest::new(surface.clone(), HillshadeOptions { frame: frame.clone(), ..HillshadeOptions::default() }),
    ] {
        let command = JobCommand::new(&request, &targets, &TileOptions::default()).unwrap();
        let here = std::env::current_dir().unwrap();
        let names = ["a.laz", "b/c.laz", "l.gpkg:roads:z", "w.shp", "b.geojson", "r.tif"];
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
    let line = super::layer(&[vec![[688_050.0, 5_261_050.0, 800.0], [688_300.0, 5_261_250.0, 801.0]]], "LineString");
    std::fs::write(folder.path().join("l.geojson"), line).unwrap();
    output_of(&folder, "dem a.laz --resolution 4", "grid.tif");
    let words = "dem a.laz --breaklines l.geojson --align-to grid.tif";
    let (whole, _) = output_of(&folder, words, "whole.tif");
    let run = |folder, words: &str| run_in(folder, &words.split(' ').collect::<Vec<_>>());
    let elsewhere = tempfile::tempdir().unwrap();
    for (job, task) in [("j", None), ("k", Some(0))] {
        run(&folder, &format!("job plan {job} -- {words} -o {job}.tif --tiles 2x2")).works(&[]);
        let path = folder.path().join(job).to_str().unwrap().to_owned();
        match task {
            None => run(&elsewhere, &format!("job run {path}")).works(&[]),
            Some(task) => {
                run(&elsewhere, &format!("job run {path} --task {task}")).works(&[]);
                let resume = format!("{words} --tiles 2x2 --job {job} --resume -o {job}.tif");
                run(&folder, &resume).works(&["resumed     1 of"]);
                // The same names, but other files.
                run(&elsewhere, &resume.replace(&format!("--job {job}"), &format!("--job {path}")))
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

    fn write(&self, surface: &SurfaceProduct, outputs: &Outputs, context: &Context) -> Result<Summary> {
        self.0.write(surface, outputs, context)
    }

    fn keeps(&self) -> Keeps<'_> {
        self.0.keeps()
    }

    fn write_tiles(&self, tiles: &dyn Tiles, outputs: &Outputs, context: &Context) -> Result<Summary> {
        self.0.write_tiles(tiles, outputs, context)
    }
}

#[test]
fn what_would_not_come_back_as_it_was_is_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let targets = Targets::of(folder.path().join("d.tif"));
    let light = |z_factor| LightOptions { z_factor, ..LightOptions::default() };
    let shades = |light| request(HillshadeOptions { light, ..HillshadeOptions::default() });
    let line = super::layer(&[vec![[688_050.0, 5_261_050.0, 800.0], [688_300.0, 5_261_250.0, 801.0]]], "LineString");
    let path = folder.path().join("l.geojson");
    std::fs::write(&path, line).unwrap();
    let line = breakline::io::layer::read(path.to_str().unwrap()).unwrap();
    std::fs::remove_file(path).unwrap();
    let in_memory = Source::Points(Box::new(run::TinRequest {
        points: vec![Input::File(valley().into())],
        breaklines: vec![Input::Memory(line.into())],
        ..run::TinRequest::default()
    }));
    let in_memory = SurfaceRequest { source: in_memory, ..SurfaceRequest::default() };
    for (request, said) in [
        (shades(light(Some(f64::INFINITY))), "z-factor would be lost"),
        (shades(light(Some(f64::NAN))), "z-factor would be lost"),
        (shades(LightOptions { azimuth: f64::NAN, ..LightOptions::default() }), "cannot be kept with a job"),
        (request(Own(DemOptions::default())), "a job cannot keep the verb `dem`, which is not of this crate"),
        (WriteRequest::new(in_memory, DemOptions::default()), "an input is in memory"),
    ] {
        let command = JobCommand::new(&request, &targets, &tiles()).unwrap();
        let error = plan(&command, &folder.path().join("j")).unwrap_err();
        assert!(error.kind() == Kind::Unsupported && error.to_string().contains(said), "{error}");
        assert!(files_of(folder.path()).is_empty());
    }
    // The heights of a box do not count.
    let extent =
        Some(breakline::data::Bounds { min: [688_000.0, 5_261_000.0, 1.0], max: [688_100.0, 5_261_100.0, 2.0] });
    let frame = FrameOptions { extent, ..FrameOptions::default() };
    let command = JobCommand::new(&request(DemOptions { frame, ..DemOptions::default() }), &targets, &tiles()).unwrap();
    let job = plan(&command, &folder.path().join("j")).unwrap();
    run::run_job(&job, &Context::default()).unwrap();
}
