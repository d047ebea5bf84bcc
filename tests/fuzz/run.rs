//! One family over a range of seeds, on all cores.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::families::Family;
use crate::shrink::shrink;
use crate::tally::Tally;
use testkit::case::Case;
use testkit::judge;
use testkit::random::Random;
use testkit::subject::build;

/// One set in so many is judged by what takes longer than to build it.
const SAMPLE: u64 = 64;

/// Seeds that a thread takes at a time.
const BATCH: u64 = 64;

/// A run stops when it knows of so many failures.
const ENOUGH: usize = 5;

/// Nothing takes so long that does not hang.
const PATIENCE: Duration = Duration::from_secs(120);

/// Tries all seeds; prints what was tried and what failed. Whether nothing did.
pub(crate) fn run(family: &Family, seeds: Range<u64>) -> bool {
    let start = Instant::now();
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let next = AtomicU64::new(seeds.start);
    let total = Mutex::new(Tally::default());
    let failures = Mutex::new(Vec::new());
    let running: Vec<Mutex<Option<(u64, Instant)>>> =
        (0..threads).map(|_| Mutex::new(None)).collect();
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let workers: Vec<_> = running
            .iter()
            .map(|mine| {
                scope.spawn(|| {
                    let mut tally = Tally::default();
                    loop {
                        let from = next.fetch_add(BATCH, Ordering::Relaxed);
                        if from >= seeds.end || failures.lock().unwrap().len() >= ENOUGH {
                            break;
                        }
                        for seed in from..seeds.end.min(from + BATCH) {
                            *mine.lock().unwrap() = Some((seed, Instant::now()));
                            let case = family.case(seed);
                            tally.add(&case);
                            if let Err(what) = trial(&case, seed) {
                                failures.lock().unwrap().push((seed, what));
                            }
                        }
                    }
                    *mine.lock().unwrap() = None;
                    total.lock().unwrap().merge(&tally);
                })
            })
            .collect();
        let watch = scope.spawn(|| {
            while !is_done.load(Ordering::Relaxed) {
                std::thread::park_timeout(Duration::from_secs(5));
                for (seed, since) in running.iter().filter_map(|at| *at.lock().unwrap()) {
                    if since.elapsed() > PATIENCE {
                        eprintln!(
                            "{} seed {seed} hangs\n{}",
                            family.name,
                            family.case(seed).to_poly()
                        );
                        std::process::exit(1);
                    }
                }
            }
        });
        workers
            .into_iter()
            .for_each(|worker| worker.join().unwrap());
        is_done.store(true, Ordering::Relaxed);
        watch.thread().unpark();
    });
    println!(
        "\n{} seeds {}..{}, {:.0} s",
        family.name,
        seeds.start,
        seeds.end,
        start.elapsed().as_secs_f64()
    );
    print!("{}", total.into_inner().unwrap());
    let mut failures = failures.into_inner().unwrap();
    failures.sort();
    for (seed, what) in &failures {
        let path = std::env::temp_dir().join(format!("breakline-{}-{seed}.poly", family.name));
        println!("FAILED seed {seed}: {what}");
        save_small(family.case(*seed), *seed, what, &path);
    }
    failures.is_empty()
}

/// One set from a file, by all judges; what fails is written beside it, made small.
pub(crate) fn run_file(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).expect("the file can be read");
    let case = Case::from_poly(&text);
    let verdict = trial(&case, 0);
    match &verdict {
        Ok(()) => println!("{}: all holds", path.display()),
        Err(what) => {
            println!("FAILED {}: {what}", path.display());
            save_small(case, 0, what, &path.with_extension("small.poly"));
        }
    }
    verdict.is_ok()
}

fn save_small(case: Case, seed: u64, what: &str, path: &Path) {
    let small = shrink(case, kind(what), |case| {
        trial(case, seed).err().map(|what| kind(&what).to_owned())
    });
    let what_now = trial(&small, seed)
        .err()
        .unwrap_or_else(|| "not so a second time".to_owned());
    std::fs::write(path, small.to_poly()).expect("the folder can be written");
    println!("  made small: {what_now}\n  {}", path.display());
}

/// Builds and judges one set; by the slow judges, too, for one seed in some.
fn trial(case: &Case, seed: u64) -> Result<(), String> {
    let judged = || {
        let built = build(case).map_err(|refused| format!("refused: {refused}"))?;
        judge::judge(case, &built)?;
        if seed.is_multiple_of(SAMPLE / 2) {
            judge::judge_order(case, &built, &mut Random(seed))?;
        }
        if seed.is_multiple_of(SAMPLE) {
            judge::judge_slowly(case, &built)?;
        }
        Ok(())
    };
    catch_unwind(AssertUnwindSafe(judged)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Err(format!("panic: {}", text.unwrap_or_default()))
    })
}

/// The law that was broken, without the place.
fn kind(what: &str) -> &str {
    let what = what.strip_prefix("off the grid: ").unwrap_or(what);
    let what = what.strip_prefix("line ").map_or(what, |rest| {
        rest.split_once(": ").map_or(rest, |(_, what)| what)
    });
    what.split_once(':').map_or(what, |(kind, _)| kind)
}
