//! Where the points of large files are, for tiles that suit them.

use super::planned_file::PlannedFile;
use crate::data::PointBatch;
use crate::error::{Kind, Result};
use crate::run::context::{Context, Size, Stage};
use crate::run::products::tin::TinRequest;
use crate::run::sources::open;
use crate::run::sources::transforms::TargetSystem;
use crate::terrain::tiles::Spread;
use crate::terrain::{Classes, Selection};

/// A file with at least this many tiles' worth of points is looked into: others are taken to be
/// even.
const LARGE: f64 = 8.0;

/// Positions that stand for the points of a tile.
const POSITIONS_A_TILE: f64 = 100.0;

/// Returns boxes that stand for the points of the files that are used; of large files, positions of
/// some of them. Points of these classes are used, in this system; a tile shall have about
/// `average` of them.
///
/// # Complexity
/// Linear in the files. Of large ones, some 50 000 points are read for each tile: a tenth if a tile
/// has 500 000, all if it has 50 000.
pub(super) fn spreads(
    files: &[PlannedFile],
    request: &TinRequest,
    (classes, to): (&[u8], TargetSystem),
    average: f64,
    context: &Context,
) -> Result<Vec<Spread>> {
    let mut all = Vec::new();
    for file in files {
        let sampled = if file.count as f64 >= LARGE * average {
            sampled(file, request, (classes, to), average, context)
        } else {
            Ok(Vec::new())
        };
        match sampled {
            Ok(found) if found.is_empty() => all.push(file.spread()),
            Ok(mut found) => all.append(&mut found),
            Err(error) if error.kind() == Kind::Canceled => return Err(error),
            // The task that reads the file says so, or skips it.
            Err(_) => all.push(file.spread()),
        }
    }
    Ok(all)
}

/// Returns positions of points that are used, each of which stands for as many points; none if the
/// file has to be read whole to find out.
fn sampled(
    file: &PlannedFile,
    request: &TinRequest,
    (classes, to): (&[u8], TargetSystem),
    average: f64,
    context: &Context,
) -> Result<Vec<Spread>> {
    let mut source = open::points(&request.points[file.input], request.read, context)?;
    if !source.thin(average as u64) {
        return Ok(Vec::new());
    }
    let work = context.start(Stage::ReadingPoints, Size::Unknown)?;
    let extent = file.spread();
    let transforms = file.transforms(to, context)?;
    let mut selection =
        Selection::new(Classes::Only(classes.to_vec()), None).with_returns(request.returns.clone());
    let mut batch = PointBatch::default();
    let (mut read, mut positions) = (0, Vec::new());
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            break;
        }
        work.add(batch.len() as u64)?;
        transforms.of_file(0).apply_to_batch(&mut batch)?;
        selection.add(&batch)?;
        let used = selection.take_points();
        let wanted = (batch.len() as f64 / average * POSITIONS_A_TILE).max(POSITIONS_A_TILE);
        let step = (used.len() as f64 / wanted).ceil().max(1.0) as usize;
        let own = used
            .chunks(step)
            .enumerate()
            .map(|(k, some)| some[scattered(k) % some.len()]);
        let own: Vec<[f64; 2]> = own
            .map(|[x, y, _]| [x, y])
            .filter(|&position| extent.holds(position))
            .collect();
        let share = used.len() as f64 / own.len().max(1) as f64;
        positions.extend(own.into_iter().map(|position| (position, share)));
        read += batch.len() as u64;
    }
    let scale = file.count as f64 / read.max(1) as f64;
    Ok(positions
        .into_iter()
        .map(|(at, share)| Spread {
            min: at,
            max: at,
            count: share * scale,
        })
        .collect())
}

/// Returns a number that has no rhythm, as scanners and their flights have one.
fn scattered(k: usize) -> usize {
    ((k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as usize
}

#[cfg(test)]
mod tests {
    use std::slice::from_ref;

    use super::*;
    use crate::run::job::planned_file::FileState;
    use crate::run::request::input::Input;
    use crate::run::sources::proj::TransformOptions;
    use crate::terrain::tiles::TileLayout;
    use testkit::random::Random;

    /// Points are not reprojected.
    const AS_READ: TargetSystem = TargetSystem {
        crs: None,
        options: &TransformOptions {
            require_grids: false,
            epoch: None,
        },
    };

    /// Points along a diagonal, and half of them in one corner.
    fn crowded(count: usize) -> Vec<[f64; 3]> {
        let mut random = Random(7);
        let mut at = |i: usize| match i % 2 {
            0 => [0, 1].map(|_| i as f64 * 1e-3 + random.unit()),
            _ => [0, 1].map(|_| random.unit()),
        };
        (0..count).map(&mut at).map(|[x, y]| [x, y, 0.0]).collect()
    }

    #[test]
    fn tiles_of_crowded_points_are_no_larger_than_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.las");
        let points = crowded(400_000);
        let of_class: Vec<([f64; 3], u8)> = points
            .iter()
            .enumerate()
            .map(|(i, &point)| (point, (i % 3) as u8))
            .collect();
        std::fs::write(&path, testkit::lidar::las(&of_class, None)).unwrap();
        let request = TinRequest {
            points: vec![Input::File(path.clone())],
            ..TinRequest::default()
        };
        let (average, most) = (10_000.0, 20_000);
        let file = PlannedFile {
            input: 0,
            path: path.clone(),
            name: 0,
            tile: None,
            state: FileState {
                size: 0,
                modified: 0,
                beside: 0,
            },
            count: points.len() as u64,
            from: None,
            min: [0.0; 2],
            max: [402.0; 2],
            is_of_any_system: false,
        };
        let largest = |spreads: &[Spread]| {
            let layout = TileLayout::balanced(spreads, average);
            let mut counts = vec![0; layout.tile_count()];
            points
                .iter()
                .for_each(|&[x, y, _]| counts[layout.tile_of([x, y]) as usize] += 1);
            counts.into_iter().max().unwrap()
        };
        assert!(largest(&[file.spread()]) > 10 * most);
        let found = spreads(
            from_ref(&file),
            &request,
            (&[0, 1, 2], AS_READ),
            average,
            &Context::default(),
        )
        .unwrap();
        assert!(largest(&found) <= most, "{}", largest(&found));
        let count = |spreads: &[Spread]| {
            spreads
                .iter()
                .map(|spread| spread.count)
                .sum::<f64>()
                .round()
        };
        assert_eq!(count(&found), 400_000.0);
        let of_one = spreads(
            from_ref(&file),
            &request,
            (&[2], AS_READ),
            average,
            &Context::default(),
        )
        .unwrap();
        assert_eq!(count(&of_one), 133_333.0);
        // Few points are taken to be even, and so are those of a file that cannot be read.
        assert_eq!(
            spreads(
                from_ref(&file),
                &request,
                (&[2], AS_READ),
                1e6,
                &Context::default()
            )
            .unwrap(),
            [file.spread()]
        );
        std::fs::write(&path, "LASF").unwrap();
        assert_eq!(
            spreads(
                from_ref(&file),
                &request,
                (&[2], AS_READ),
                average,
                &Context::default()
            )
            .unwrap(),
            [file.spread()]
        );
    }
}
