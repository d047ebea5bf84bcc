//! Which processes have what others wait for.

use std::path::Path;
use std::time::Duration;

use super::lease::{TaskLease, leases_in};
use super::paths::LOCK;
use crate::run::context::event::Awaited;

/// Returns who has tasks, or the whole of a job, as far as that is known. `last` is the number of
/// the last task.
pub(super) fn of_job(folder: &Path, last: usize) -> Vec<Awaited> {
    let mut all = of_tasks(folder, last, |_| true);
    all.extend(holders(folder));
    all
}

/// Returns who has those tasks for which a function returns true; `last` is the number of the last
/// one, the output.
pub(super) fn of_tasks(
    folder: &Path,
    last: usize,
    is_meant: impl Fn(usize) -> bool,
) -> Vec<Awaited> {
    let leases = leases_in(folder).unwrap_or_default().into_iter();
    leases
        .filter(|(task, _)| is_meant(*task))
        .map(|(task, lease)| {
            let TaskLease { worker, age, .. } = lease;
            let what = if task == last {
                "has the output".to_owned()
            } else {
                format!("does task {task}")
            };
            Awaited {
                who: worker.map_or("an unknown process".to_owned(), |one| one.to_string()),
                what,
                silent: Some(age),
            }
        })
        .collect()
}

/// Returns the processes on this host that have locked a folder, other than this one. Linux lists
/// them; elsewhere there are none.
pub(super) fn holders(folder: &Path) -> Vec<Awaited> {
    let of = |process: u32| Awaited {
        who: format!("process {process} on this machine"),
        what: match is_stopped(process) {
            true => "has the lock of the job and is stopped".to_owned(),
            false => "has the lock of the job".to_owned(),
        },
        silent: None::<Duration>,
    };
    let list = std::fs::read_to_string("/proc/locks").unwrap_or_default();
    let others = inode_of(&folder.join(LOCK)).map(|file| holders_in(&list, file));
    others.into_iter().flatten().map(of).collect()
}

/// Returns the processes that have locked the file with this number, from the list of all locks.
fn holders_in(list: &str, file: u64) -> Vec<u32> {
    let holder = |line: &str| {
        // Such as `7: FLOCK ADVISORY READ 4711 08:01:1234 0 EOF`.
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "FLOCK", _, _, process, of_file, ..] = words[..] else {
            return None;
        };
        let is_of_file = of_file.rsplit(':').next()?.parse() == Ok(file);
        let process = process.parse().ok()?;
        (is_of_file && process != std::process::id()).then_some(process)
    };
    list.lines().filter_map(holder).collect()
}

#[cfg(unix)]
fn inode_of(path: &Path) -> Option<u64> {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata(path).ok().map(|about| about.ino())
}

#[cfg(not(unix))]
fn inode_of(_path: &Path) -> Option<u64> {
    None
}

/// Returns true if a process is stopped, as far as the system says.
fn is_stopped(process: u32) -> bool {
    let state = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // The name of the program, in parentheses, may contain anything.
    let after = state.rsplit_once(") ").map(|(_, after)| after);
    after.is_some_and(|after| after.starts_with(['T', 't']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holders_of_a_lock_are_found_in_the_list_of_the_system() {
        let list = "1: FLOCK  ADVISORY  READ 12 08:01:77 0 EOF\n\
                    1: -> FLOCK  ADVISORY  WRITE 13 08:01:77 0 EOF\n\
                    2: POSIX  ADVISORY  WRITE 14 08:01:77 0 EOF\n\
                    3: FLOCK  ADVISORY  WRITE 15 08:01:78 0 EOF\n\
                    4: FLOCK  ADVISORY  READ 16 00:2f:77 0 EOF\n\
                    5: FLOCK\n";
        assert_eq!(holders_in(list, 77), [12, 16]);
    }
}
