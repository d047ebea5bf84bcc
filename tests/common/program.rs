//! The program as it is run, in a temporary folder. Not a part of `mod.rs`, which the fuzzer takes
//! in, too: there is no program there.
#![allow(dead_code)]

use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// What came out of a run.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// Fails unless the run ended with this code and said all of this on stderr.
    #[track_caller]
    pub(crate) fn fails(&self, code: i32, said: &[&str]) {
        assert_eq!(self.code, code, "{}", self.stderr);
        says(&self.stderr, said);
        assert!(self.stderr.contains("error: "), "{}", self.stderr);
    }

    /// Fails unless the run ended well and said all of this on stderr.
    #[track_caller]
    pub(crate) fn works(&self, said: &[&str]) {
        assert_eq!(self.code, 0, "{}", self.stderr);
        says(&self.stderr, said);
    }

    /// Fails unless the run ended with this code and said all of this, wherever.
    #[track_caller]
    pub(crate) fn ends(&self, code: i32, said: &[&str]) {
        let all = format!("{}{}", self.stdout, self.stderr);
        assert_eq!(self.code, code, "{all}");
        says(&all, said);
    }
}

#[track_caller]
fn says(text: &str, said: &[&str]) {
    for part in said {
        assert!(text.contains(part), "expected `{part}` in:\n{text}");
    }
}

pub(crate) fn run_in(folder: &TempDir, args: &[&str]) -> Run {
    run_with(folder, args, "")
}

pub(crate) fn run_with(folder: &TempDir, args: &[&str], stdin: &str) -> Run {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
    let output = command
        .current_dir(folder.path())
        .args(args)
        .write_stdin(stdin)
        .output()
        .unwrap();
    Run {
        code: output.status.code().expect("the program was killed"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

pub(crate) fn folder_with(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

/// The names in a folder, sorted.
pub(crate) fn files_of(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
