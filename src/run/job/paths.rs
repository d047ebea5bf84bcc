//! The names of files of tasks in the folder of a job.

use std::path::{Path, PathBuf};

/// The file that is locked while a process works on the job; it is empty.
pub(super) const LOCK: &str = "lock";

/// The folder of the files of tasks.
const TASKS: &str = "tasks";

/// Returns the folder of the files of tasks.
pub(super) fn tasks_in(folder: &Path) -> PathBuf {
    folder.join(TASKS)
}

/// Returns the path of the file of a task.
pub(super) fn task_path(folder: &Path, task: usize) -> PathBuf {
    tasks_in(folder).join(format!("{task:06}.task"))
}

/// Returns the path of the lease of a task: beside its file, so that who creates the one has the
/// list of files that a network file system shows of the other at that moment.
pub(super) fn lease_path(folder: &Path, task: usize) -> PathBuf {
    tasks_in(folder).join(format!("{task:06}.lease"))
}

/// Returns the number of the task whose file has this name; `None` if it is none.
pub(super) fn task_of(path: &Path) -> Option<usize> {
    number_in(path, ".task", task_path)
}

/// Returns the number of the task whose lease has this name; `None` if it is none.
pub(super) fn task_of_lease(path: &Path) -> Option<usize> {
    number_in(path, ".lease", lease_path)
}

fn number_in(path: &Path, end: &str, path_of: fn(&Path, usize) -> PathBuf) -> Option<usize> {
    let name = path.file_name()?.to_str()?;
    let task = name.strip_suffix(end)?.parse().ok()?;
    (path_of(Path::new(""), task).file_name()?.to_str()? == name).then_some(task)
}
