use super::patch::Patch;
use super::{ContourParts, LevelParts, NO_HEIGHTS, join};
use crate::data;
use crate::error::{Error, Result};
use crate::terrain::Levels;
use crate::terrain::contour::find::{self, LevelArcs};
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::contour::narrow::Narrowness;
use crate::terrain::contour::trace;
use crate::terrain::tiles::TileTriangle;

/// Collects the triangles of a task and returns their parts of contours.
///
/// # Complexity
/// `n log n` for `n` triangles that meet a level; one that meets none costs a comparison.
/// Memory: that of the parts, up to 150 bytes per level within the heights of the task, and 10 MB
/// for triangles.
pub struct ContourCollector {
    levels: Levels,
    /// The lowest and the highest height so far.
    heights: [f64; 2],
    /// The levels within a range that contains these heights.
    index: LevelIndex,
    range: [f64; 2],
    /// Triangles that meet a level, of which no parts were made yet.
    patch: Patch,
    /// How many of these there may be.
    patch_size: usize,
    /// In the order in which they were made: a level can occur several times.
    parts: Vec<LevelParts>,
    error: Option<Error>,
}

/// The number of triangles from which parts are made together: some 10 MB. Lines end at the edge of
/// these, and are joined afterwards.
const PATCH_SIZE: usize = 1 << 16;

impl ContourCollector {
    /// Creates a collector for contours at some levels.
    pub fn new(levels: &Levels) -> Self {
        Self::with_patch_size(levels, PATCH_SIZE)
    }

    pub(super) fn with_patch_size(levels: &Levels, patch_size: usize) -> Self {
        ContourCollector {
            levels: levels.clone(),
            heights: NO_HEIGHTS,
            index: LevelIndex::new(Vec::new()),
            range: NO_HEIGHTS,
            patch: Patch::default(),
            patch_size,
            parts: Vec::new(),
            error: None,
        }
    }

    /// Adds a triangle of the task. Each triangle of the whole must be added in one task, once.
    ///
    /// An error is returned by [`finish`](Self::finish).
    pub fn add(&mut self, triangle: &TileTriangle) {
        if self.error.is_none() {
            self.error = self.try_add(triangle).err();
        }
    }

    fn try_add(&mut self, triangle: &TileTriangle) -> Result<()> {
        let [a, b, c] = triangle.corners.map(|corner| corner.position[2]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if let Some(corner) = triangle
            .corners
            .iter()
            .find(|corner| corner.position.iter().any(|x| !x.is_finite()))
        {
            return Err(Error::format(format!(
                "{:?} is not a finite point",
                corner.position
            )));
        }
        self.heights = find::joined(self.heights, [low, high]);
        if low < self.range[0] || high > self.range[1] {
            self.widen_index()?;
        }
        if self
            .index
            .levels()
            .get(self.index.first_from(low))
            .is_some_and(|&level| level <= high)
        {
            self.patch.push(triangle);
            if self.patch.face_count() >= self.patch_size {
                self.make_parts()?;
            }
        }
        Ok(())
    }

    /// Finds the levels within the heights so far, and far beyond them if there are not too many:
    /// heights that rise bit by bit must not need them each time.
    fn widen_index(&mut self) -> Result<()> {
        let ([low, high], [from, to]) = (self.heights, self.range);
        let widened = |share: f64| {
            let more = share * (high - low);
            [
                if low < from { low - more } else { from },
                if high > to { high + more } else { to },
            ]
        };
        let found = [1.0, 1.0 / 16.0, 1.0 / 256.0]
            .into_iter()
            .find_map(|share| {
                let range = widened(share);
                Some((range, self.levels.within(range[0], range[1]).ok()?))
            });
        let (range, levels) = match found {
            Some(found) => found,
            None => (self.heights, self.levels.within(low, high)?),
        };
        self.range = range;
        self.index = LevelIndex::new(levels);
        Ok(())
    }

    /// Makes parts from the triangles that are waiting.
    fn make_parts(&mut self) -> Result<()> {
        let patch = std::mem::take(&mut self.patch).linked()?;
        let mesh = &patch.mesh;
        let [low, high] = find::height_range(mesh);
        let band = self.index.first_from(low)..self.index.first_from(high.next_up());
        let found = find::crossed(mesh, &self.index, band.clone());
        let counts = find::counts_of(&found, band.clone());
        let arcs = LevelArcs::new(mesh, &self.index, &found, band.clone(), &counts);
        let keyed = patch.keyed();
        let mut parts =
            trace::each_level(mesh, &self.index, band.clone(), &arcs, |level, traces| {
                keyed.parts(level, traces)
            });
        for (level, side) in keyed.level_sides(data::corners(mesh), &self.index) {
            parts[level - band.start].sides.push(side);
        }
        let narrowness = Narrowness::of(&self.levels);
        for (level, sites) in patch.narrow_sites(&self.index, narrowness) {
            parts[level - band.start].narrow = sites;
        }
        self.parts
            .extend(parts.into_iter().filter(|parts| !parts.is_empty()));
        Ok(())
    }

    /// Returns the parts of all triangles.
    ///
    /// # Errors
    /// If more than [`MAX_LEVELS`](crate::terrain::MAX_LEVELS) levels lie within the heights of the
    /// task, a vertex is not finite, or two triangles are on the same side of an edge.
    pub fn finish(mut self) -> Result<ContourParts> {
        if let Some(error) = self.error {
            return Err(error);
        }
        self.make_parts()?;
        Ok(ContourParts {
            heights: self.heights,
            levels: join::merge_levels(self.parts)?,
        })
    }
}
