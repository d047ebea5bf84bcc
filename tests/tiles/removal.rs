//! What jobs remove, and what they leave to others.

use std::path::PathBuf;

use flate2::Crc;

use super::{bytes, mark_of, plan_valley, program, run, valley};
use program::files_of;

/// Two jobs whose plans are equal, one of which still writes.
#[test]
fn temporary_files_of_an_equal_job_stay() {
    let folder = tempfile::tempdir().unwrap();
    for job in ["j", "k"] {
        run(
            &folder,
            &format!(
                "job plan {job} -- dem {} --tiles 2x2 -o {job}.tif",
                valley()
            ),
        )
        .works(&[]);
    }
    let live = folder
        .path()
        .join(format!(".breakline-{}-live", mark_of(&folder, "k")));
    std::fs::write(&live, "being written").unwrap();
    run(&folder, "job run j").works(&[]);
    assert!(live.exists());
    std::fs::remove_file(live).unwrap();
    run(&folder, "job run k").works(&[]);
    let [one, other] = ["j.tif", "k.tif"].map(|name| bytes(folder.path().join(name)));
    assert!(one == other);
}

/// A TIN in parts is written to a folder first, here next to the files of the job.
#[test]
fn a_job_whose_folder_has_its_output_goes_on_and_is_removed() {
    let folder = tempfile::tempdir().unwrap();
    let job = folder.path().join("j");
    let planned = format!(
        "job plan j -- tin {} --tiles 2x2 -o j/out.tins --overwrite",
        valley()
    );
    std::fs::create_dir(&job).unwrap();
    for end in ["job run j", "job clean j"] {
        run(&folder, &planned).works(&[]);
        let own = job.join(format!(
            ".breakline-{}-zz.unfinished",
            mark_of(&folder, "j")
        ));
        // What another run is about to write here.
        let other = job.join(".breakline-0123456789abcdef-zz.unfinished");
        for left in [&own, &other] {
            std::fs::create_dir_all(left).unwrap();
            std::fs::write(left.join("000000.tin"), "half").unwrap();
        }
        run(&folder, end).works(&[]);
        assert!(
            !own.exists() && other.join("000000.tin").exists(),
            "{end}: {:?}",
            files_of(&job)
        );
        if end == "job run j" {
            run(&folder, "job clean j").works(&[]);
            assert!(job.join("out.tins").exists());
        }
        assert!(!job.join("tasks").exists() && !job.join("plan.json").exists());
    }
}

/// A plan may state whatever it likes: only files that are there are looked at.
#[test]
fn a_job_of_countless_tasks_is_removed() {
    let folder = tempfile::tempdir().unwrap();
    let plan = format!(
        r#"{{"version":"0","request":{{}},"layout":[],"tasks":{}}}"#,
        u64::MAX
    );
    let mut sum = Crc::new();
    sum.update(plan.as_bytes());
    let tasks = folder.path().join("j/tasks");
    std::fs::create_dir_all(&tasks).unwrap();
    std::fs::write(
        folder.path().join("j/plan.json"),
        format!("{:08x}\n{plan}", sum.sum()),
    )
    .unwrap();
    for name in ["000000.task", "123456789.task", "1.task", "+00001.task"] {
        std::fs::write(tasks.join(name), "x").unwrap();
    }
    run(&folder, "job clean j").works(&[]);
    assert_eq!(files_of(&tasks), ["+00001.task", "1.task"]);
}

#[test]
fn who_cannot_clean_a_job_learns_what_to_delete() {
    let folder = tempfile::tempdir().unwrap();
    plan_valley(&folder);
    run(&folder, "job run j --task 0").works(&[]);
    let path: PathBuf = folder.path().join("j/plan.json");
    let mut plan = bytes(&path);
    plan[50] ^= 1;
    std::fs::write(&path, plan).unwrap();
    let before = files_of(&folder.path().join("j/tasks"));
    for words in ["job clean j", "job run j"] {
        run(&folder, words).fails(
            1,
            &[
                "j/plan.json: this is not the plan of a job",
                "by hand: plan.json and tasks/*.task",
            ],
        );
    }
    assert_eq!(files_of(&folder.path().join("j/tasks")), before);
}
