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

/// Returns the processes that have tasks for which a function returns true, by leases that have not
/// expired; `last` is the number of the last task, the output.
pub(super) fn of_tasks(
    folder: &Path,
    last: usize,
    is_meant: impl Fn(usize) -> bool,
) -> Vec<Awaited> {
    let leases = leases_in(folder).unwrap_or_default().into_iter();
    leases
        .filter(|(task, lease)| is_meant(*task) && !lease.has_expired)
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

/// Returns true if all leases of a job that have not expired were last written at least `silent`
/// ago, and expire `within` some time unless they are written again.
pub(super) fn leases_expire(folder: &Path, silent: Duration, within: Duration) -> bool {
    // Dates of files may be coarse.
    let silent = silent.saturating_sub(Duration::from_secs(2));
    let leases = leases_in(folder).unwrap_or_default();
    let mut live = leases.values().filter(|lease| !lease.has_expired);
    live.all(|lease| lease.age >= silent && lease.left <= within)
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
    let others = named_in_lists(&folder.join(LOCK)).map(|file| holders_in(&list, &file));
    others.into_iter().flatten().map(of).collect()
}

/// Returns the processes that have locked a file, from the list of all locks. The list names files
/// by device and number, such as `08:01:1234`.
fn holders_in(list: &str, file: &str) -> Vec<u32> {
    let holder = |line: &str| {
        // Such as `7: FLOCK ADVISORY READ 4711 08:01:1234 0 EOF`.
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "FLOCK", _, _, process, of_file, ..] = words[..] else {
            return None;
        };
        let process = process.parse().ok()?;
        (of_file == file && process != std::process::id()).then_some(process)
    };
    list.lines().filter_map(holder).collect()
}

/// Returns what Linux names a file in the list of locks; `None` if that cannot be found out.
#[cfg(target_os = "linux")]
fn named_in_lists(path: &Path) -> Option<String> {
    use std::os::fd::AsRawFd;
    use std::os::unix::fs::MetadataExt;
    let file = std::fs::File::open(path).ok()?;
    let number = file.metadata().ok()?.ino();
    let opened = std::fs::read_to_string(format!("/proc/self/fdinfo/{}", file.as_raw_fd())).ok()?;
    let mounts = std::fs::read_to_string("/proc/self/mountinfo").ok()?;
    name_of(&opened, &mounts, number)
}

#[cfg(not(target_os = "linux"))]
fn named_in_lists(_path: &Path) -> Option<String> {
    None
}

/// Returns the name of an open file, from what the system says of it and the list of mounts. The
/// device that `stat` states differs on Btrfs and others, and so may `number_of_stat`.
#[cfg(target_os = "linux")]
fn name_of(opened: &str, mounts: &str, number_of_stat: u64) -> Option<String> {
    let said = |name: &str| {
        let said = opened.lines().find_map(|line| line.strip_prefix(name))?;
        Some(said.trim())
    };
    let mount = said("mnt_id:")?;
    // Such as `36 35 98:0 / /mnt rw - ext4 /dev/sda1 rw`.
    let device = mounts.lines().find_map(|line| {
        let mut words = line.split_whitespace();
        (words.next() == Some(mount)).then(|| words.nth(1))?
    });
    let (major, minor) = device?.split_once(':')?;
    let [major, minor]: [u32; 2] = [major.parse().ok()?, minor.parse().ok()?];
    // Older systems do not state it.
    let number = said("ino:").and_then(|number| number.parse().ok());
    let number = number.unwrap_or(number_of_stat);
    Some(format!("{major:02x}:{minor:02x}:{number}"))
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
                    5: FLOCK  ADVISORY  READ 17 08:01:77 0 EOF\n\
                    6: FLOCK\n";
        assert_eq!(holders_in(list, "08:01:77"), [12, 17]);
        assert_eq!(holders_in(list, "00:2f:77"), [16]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_device_of_a_file_is_that_of_its_mount() {
        let mounts =
            "24 1 0:22 / /sys rw - sysfs sysfs rw\n36 35 253:10 / /mnt rw - ext4 /dev/a rw\n";
        let opened = "pos:\t0\nflags:\t0100000\nmnt_id:\t36\nino:\t77\n";
        assert_eq!(name_of(opened, mounts, 5).unwrap(), "fd:0a:77");
        let older = "pos:\t0\nmnt_id:\t24\n";
        assert_eq!(name_of(older, mounts, 5).unwrap(), "00:16:5");
        assert_eq!(name_of("pos:\t0\n", mounts, 5), None);
        // This process is found by the name of the file that it has locked.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        let file = std::fs::File::create(&path).unwrap();
        file.lock().unwrap();
        let list = std::fs::read_to_string("/proc/locks").unwrap();
        let name = named_in_lists(&path).unwrap();
        assert!(
            list.contains(&format!(" {} {name} ", std::process::id())),
            "{name}"
        );
    }
}
