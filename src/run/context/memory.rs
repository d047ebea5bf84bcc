//! The free memory, checked before large work.

use std::path::{Path, PathBuf};

use super::notice::Notice;
use super::units::bytes;
use crate::error::{Command, Error, Result, Setting, wording};

/// Bytes per point while a TIN is built and written, without the coordinates; measured: 65 to 75.
const BYTES_A_POINT: u64 = 72;

/// Bytes per point, including the coordinates.
const BYTES_A_POINT_READ: u64 = BYTES_A_POINT + 24;

/// Bytes per point in columns: coordinates, class, flags, return number.
const BYTES_OF_COLUMNS: u64 = 27;

/// Bytes per point while points in space are triangulated and written, without the coordinates:
/// 400 of the triangulation and 330 of the lists, where a point has seven cells.
const BYTES_A_POINT_OF_SPACE: u64 = 730;

/// Bytes per triangle while parts are joined to a mesh: its vertices, links and kinds, and the
/// table of edges that finds the links.
const BYTES_A_JOINED_TRIANGLE: u64 = 90;

/// Bytes per vertex while heights are smoothed for a map.
const BYTES_A_SMOOTHED_VERTEX: u64 = 100;

/// Bytes per byte of a mesh file while it is read, including the triangles.
const BYTES_A_MESH_BYTE: u64 = 3;

/// Bytes per point while the ground is found, with the coordinates.
const BYTES_A_FILTERED_POINT: u64 = 200;

/// Bytes per point while the ground is found in tiles, whose points come from files with their
/// numbers.
const BYTES_A_TILED_POINT: u64 = 280;

/// A need below this is not checked.
const LITTLE: u64 = 64 << 20;

/// The free memory, and what limits it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Left {
    bytes: u64,
    of: &'static str,
}

/// Returns an error if there is not enough memory to build a TIN of this many points, which are in
/// memory already.
///
/// # Errors
/// Names the memory needed, the free memory, and what to do.
pub(crate) fn require_for_points(count: usize) -> Result<()> {
    require(
        count as u64 * BYTES_A_POINT,
        &format!("a surface of {count} points"),
    )
    .map_err(|e| {
        e.cure(wording![
            "use fewer points: a part of the area (",
            Setting::Bounds,
            "), a class (",
            Setting::Class,
            "); or write the surface in parts (.tins) with ",
            Command::Tin,
            ", which works in tiles: heights at points and along lines, volumes, rasters and contours are computed from part to part"
        ])
    })
}

/// Returns an error if there is not enough memory to find the ground among this many points.
///
/// # Errors
/// Names the memory needed, the free memory, and what to do.
pub(crate) fn require_for_ground(count: u64) -> Result<()> {
    let what = format!("the ground among {count} points");
    require(count.saturating_mul(BYTES_A_FILTERED_POINT), &what).map_err(|e| {
        e.cure(wording![
            Command::Ground,
            " works in tiles: write its classes, and use those"
        ])
    })
}

/// Returns the number of points among which the ground can be found with so many bytes of memory.
pub(crate) fn filtered_in(bytes: u64) -> usize {
    usize::try_from(bytes / BYTES_A_TILED_POINT).unwrap_or(usize::MAX)
}

/// Returns an error if there is not enough memory to double the columns of this many points, as a
/// list that grows may.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_columns(count: usize) -> Result<()> {
    require(
        count as u64 * BYTES_OF_COLUMNS,
        &format!("columns of {count} points"),
    )
    .map_err(|e| {
        e.cure(wording![
            "use fewer points: a part of the area (",
            Setting::Bounds,
            "), a class (",
            Setting::Class,
            ")"
        ])
    })
}

/// Returns an error unless there is memory for as many bytes again as points hold already.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_held(bytes: usize) -> Result<()> {
    require(bytes as u64, "more points than are held already").map_err(|e| {
        e.cure(wording![
            "use fewer points: a larger length for ",
            Setting::Thin,
            ", or a part of the area (",
            Setting::Bounds,
            ")"
        ])
    })
}

/// Returns an error if there is not enough memory to triangulate this many points in space.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_space(count: usize) -> Result<()> {
    require(
        count as u64 * BYTES_A_POINT_OF_SPACE,
        &format!("a triangulation of {count} points in space"),
    )
    .map_err(|e| {
        e.cure(wording![
            "use fewer points: ",
            Command::Points,
            " selects them by area or class"
        ])
    })
}

/// Returns an error if there is not enough memory for a raster of this many cells.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_cells(count: u64) -> Result<()> {
    require(
        count.saturating_mul(8),
        &format!("a raster of {count} cells"),
    )
    .map_err(|e| e.cure("use a part of it: gdal_translate -srcwin or -projwin cuts one out"))
}

/// Returns an error if there is not enough memory for the mesh in a file.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_mesh(path: &Path) -> Result<()> {
    let length = std::fs::metadata(path).map_or(0, |data| data.len());
    require(
        length.saturating_mul(BYTES_A_MESH_BYTE),
        &format!("a mesh in a file of {}", bytes(length)),
    )
    .map_err(|e| {
        e.in_file(path)
            .cure("build it from fewer points, or in parts")
    })
}

/// Returns an error if there is not enough memory to join parts with this many triangles.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_parts(triangles: usize) -> Result<()> {
    require(
        (triangles as u64).saturating_mul(BYTES_A_JOINED_TRIANGLE),
        &format!("a mesh of {triangles} triangles"),
    )
    .map_err(|e| {
        e.cure(
            "rasters with linear heights, contours, heights at positions and along lines, and volumes need no mesh",
        )
    })
}

/// Returns an error if there is not enough memory to smooth the heights of this many vertices,
/// which stay in their files.
///
/// # Errors
/// Those of [`require_for_points`].
pub(crate) fn require_for_smoothing(vertices: usize) -> Result<()> {
    require(
        (vertices as u64).saturating_mul(BYTES_A_SMOOTHED_VERTEX),
        &format!("contours for a map, of {vertices} vertices,"),
    )
    .map_err(|e| {
        e.cure(wording![
            "draw the map in parts (",
            Setting::Bounds,
            "), or exact contours, which need less"
        ])
    })
}

/// Returns a notice if this many points, all used, would need more than the free memory.
pub(crate) fn excess_of(points: u64) -> Option<Notice> {
    let need = need_of(points);
    let left = left().filter(|left| need > LITTLE && need > left.bytes)?;
    Some(Notice::LittleMemory {
        need,
        left: left.bytes,
        limit: left.of,
    })
}

/// Returns the free memory; two gigabytes if the system does not say how much is free.
pub(crate) fn free() -> u64 {
    left().map_or(2 << 30, |left| left.bytes)
}

/// Returns half of the free memory, or the little that is never asked for, if that is more.
pub(crate) fn half_of_free() -> u64 {
    (free() / 2).max(LITTLE)
}

/// Returns about how much memory a surface of this many points needs, with the points.
pub(crate) fn need_of(points: u64) -> u64 {
    points.saturating_mul(BYTES_A_POINT_READ)
}

fn require(need: u64, what: &str) -> Result<()> {
    if need <= LITTLE {
        return Ok(());
    }
    match left() {
        Some(left) if need > left.bytes => Err(Error::limit(format!(
            "{what} takes about {} of memory, and {} are left {}",
            bytes(need),
            bytes(left.bytes),
            left.of
        ))),
        _ => Ok(()),
    }
}

/// Returns the smallest free memory of all limits that the system reports.
fn left() -> Option<Left> {
    let limits = [
        (of_machine(), "on this machine"),
        (
            of_groups(),
            "in this container (limit of its control group)",
        ),
        (
            of_addresses(),
            "by the limit of the address space (ulimit -v)",
        ),
    ];
    limits
        .into_iter()
        .filter_map(|(bytes, of)| Some(Left { bytes: bytes?, of }))
        .min_by_key(|left| left.bytes)
}

/// Returns the memory that is free or can be freed, including swap.
fn of_machine() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    Some(kilobytes(&text, "MemAvailable:")? + kilobytes(&text, "SwapFree:").unwrap_or(0))
}

/// Parses a value such as `MemFree:  1234 kB`; returns bytes.
fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    rest.trim()
        .strip_suffix("kB")?
        .trim()
        .parse::<u64>()
        .ok()?
        .checked_mul(1024)
}

#[cfg(unix)]
fn of_addresses() -> Option<u64> {
    use rustix::process::{Resource, getrlimit};
    let limit = getrlimit(Resource::As).current?;
    let used = kilobytes(
        &std::fs::read_to_string("/proc/self/status").ok()?,
        "VmSize:",
    )?;
    Some(limit.saturating_sub(used))
}

#[cfg(not(unix))]
fn of_addresses() -> Option<u64> {
    None
}

/// The files of a control group, by version.
struct GroupFiles {
    root: &'static str,
    limit: &'static str,
    used: &'static str,
    cache: &'static str,
}

const VERSION_1: GroupFiles = GroupFiles {
    root: "/sys/fs/cgroup/memory",
    limit: "memory.limit_in_bytes",
    used: "memory.usage_in_bytes",
    cache: "total_inactive_file",
};

const VERSION_2: GroupFiles = GroupFiles {
    root: "/sys/fs/cgroup",
    limit: "memory.max",
    used: "memory.current",
    cache: "inactive_file",
};

/// Returns the smallest free memory of the control group of this process and of those that contain
/// it.
fn of_groups() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let (files, path) = text.lines().find_map(group)?;
    let own = PathBuf::from(format!("{}{path}", files.root));
    let groups = own
        .ancestors()
        .take_while(|folder| folder.starts_with(files.root));
    groups.filter_map(|folder| files.left(folder)).min()
}

/// Parses a line such as `0::/user.slice` or `5:cpu,memory:/docker/12ab`.
fn group(line: &str) -> Option<(&'static GroupFiles, &str)> {
    let mut parts = line.splitn(3, ':');
    let (number, names, path) = (parts.next()?, parts.next()?, parts.next()?);
    match names {
        "" if number == "0" => Some((&VERSION_2, path)),
        _ if names.split(',').any(|name| name == "memory") => Some((&VERSION_1, path)),
        _ => None,
    }
}

impl GroupFiles {
    fn left(&self, folder: &Path) -> Option<u64> {
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
        let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
        // "max" where there is no limit.
        let (limit, used) = (number(self.limit)?, number(self.used)?);
        // Cached files are dropped when memory is needed.
        let statistics = read("memory.stat").unwrap_or_default();
        let cache = statistics
            .lines()
            .find_map(|line| line.strip_prefix(self.cache)?.trim().parse::<u64>().ok());
        Some(limit.saturating_sub(used.saturating_sub(cache.unwrap_or(0))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_groups_of_both_versions() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("memory.max", "1000\n");
        write("memory.current", "700\n");
        assert_eq!(VERSION_2.left(folder.path()), Some(300));
        write("memory.stat", "anon 500\ninactive_file 150\n");
        assert_eq!(VERSION_2.left(folder.path()), Some(450));
        write("memory.max", "max\n");
        assert_eq!(VERSION_2.left(folder.path()), None);
        write("memory.limit_in_bytes", "900\n");
        write("memory.usage_in_bytes", "950\n");
        assert_eq!(VERSION_1.left(folder.path()), Some(0));
        let path = |line: &'static str| group(line).map(|(files, path)| (files.limit, path));
        assert_eq!(path("0::/a/b"), Some(("memory.max", "/a/b")));
        assert_eq!(
            path("4:cpu,memory:/x"),
            Some(("memory.limit_in_bytes", "/x"))
        );
        assert_eq!(path("4:cpuset:/x"), None);
    }

    #[test]
    fn need_is_held_against_what_is_left() {
        assert_eq!(
            kilobytes("A: 1 kB\nMemAvailable:   12 kB\n", "MemAvailable:"),
            Some(12 << 10)
        );
        require(LITTLE, "little").unwrap();
        if left().is_some() {
            let error = require_for_points(1 << 50).unwrap_err();
            assert!(
                error
                    .to_string()
                    .starts_with("a surface of 1125899906842624 points takes about 81064793"),
                "{error}"
            );
            assert!(excess_of(1 << 50).is_some());
        }
    }
}
