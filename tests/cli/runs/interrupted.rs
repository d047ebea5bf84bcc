//! Runs that fail late or are canceled leave nothing.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use breakline::cli::{RunOptions, RunTables, run_products};
use breakline::error::Kind;
use breakline::run::{Context, Monitor, Notice, Progress, Size, Stage};

use super::super::{bytes, files_of};
use super::{DEM, assert_unchanged, folder, remove_others, run};

#[test]
fn a_product_that_fails_late_leaves_nothing() {
    let text = format!(
        "{DEM}[[product]]\nverb = \"sample\"\nat = \"edge.geojson\"\noutput = \"s.geojson\"\n"
    );
    let folder = folder(&text);
    let before = files_of(folder.path());
    run(&folder, "site.toml").fails(1, &["edge.geojson: product 2 (sample), "]);
    assert_unchanged(&folder, &before);
    // What is there stays.
    std::fs::write(folder.path().join("dem.tif"), "kept").unwrap();
    run(&folder, "site.toml --overwrite").fails(1, &["product 2 (sample)"]);
    assert_eq!(bytes(&folder, "dem.tif"), b"kept");
}

#[test]
fn a_canceled_run_leaves_nothing() {
    let folder = folder(DEM);
    let before = files_of(folder.path());
    let canceled = AtomicBool::new(true);
    let context = Context {
        cancel: &canceled,
        ..Context::default()
    };
    let file = folder.path().join("site.toml");
    let error = run_products(RunTables::File(&file), &RunOptions::default(), &context);
    assert_eq!(error.unwrap_err().kind(), Kind::Canceled);
    assert_unchanged(&folder, &before);
}

/// Cancels a run when its stage of a number begins.
struct CancelAt<'a> {
    stages: AtomicUsize,
    number: usize,
    cancel: &'a AtomicBool,
}

impl Monitor for CancelAt<'_> {
    fn start(&self, _: Stage, _: Size) -> Box<dyn Progress> {
        if self.stages.fetch_add(1, Ordering::Relaxed) == self.number {
            self.cancel.store(true, Ordering::Relaxed);
        }
        Box::new(())
    }

    fn notice(&self, _: &Notice) {}
}

#[test]
fn a_run_that_is_canceled_in_the_middle_leaves_nothing() {
    let text = "[input]\nfiles = \"a.xyz\"\n[[product]]\nverb = \"dem\"\noutput = \"dem.tif\"\n\
        [[product]]\nverb = \"compare\"\nfiles = \"flat.xyz\"\n\
        [[product]]\nverb = \"sample\"\nat = \"at.csv\"\noutput = \"s.csv\"\n";
    let folder = folder(text);
    let before = files_of(folder.path());
    let file = folder.path().join("site.toml");
    let mut canceled = 0;
    for number in 0.. {
        let cancel = AtomicBool::new(false);
        let monitor = CancelAt {
            stages: AtomicUsize::new(0),
            number,
            cancel: &cancel,
        };
        let context = Context {
            monitor: &monitor,
            cancel: &cancel,
        };
        match run_products(RunTables::File(&file), &RunOptions::default(), &context) {
            Err(error) => {
                assert_eq!(error.kind(), Kind::Canceled, "stage {number}: {error}");
                assert_unchanged(&folder, &before);
                canceled += 1;
            }
            // The flag may come too late for the last stages.
            Ok(_) => remove_others(folder.path(), &before),
        }
        if !cancel.into_inner() {
            break;
        }
    }
    assert!(canceled >= 4, "{canceled} canceled");
}
