use super::Bounds;
use crate::error::{Error, Plain, Result};

/// The largest number of columns or rows of a frame, which is that of GDAL.
pub const MAX_SIDE: usize = i32::MAX as usize;

/// The smallest ratio of a pixel's width to the distance of neighboring doubles at its coordinates.
///
/// Rounded cell centers then stay within 2^-13 of a cell of their exact positions.
const MIN_PIXEL: f64 = (1u64 << 13) as f64;

/// The size and georeference of a raster.
///
/// `transform` is in GDAL's order and meaning: the outer corner of the first pixel is at
/// `(t[0], t[3])`, a step of one column adds `(t[1], t[4])`, a step of one row adds `(t[2], t[5])`.
/// A north-up raster has `t[2] = t[4] = 0` and `t[5] < 0`. Readers convert PixelIsPoint files to
/// this form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The affine transform from pixel corners to coordinates, see above.
    pub transform: [f64; 6],
}

/// A rectangle of cells in a raster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub column: usize,
    /// First row.
    pub row: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Frame {
    /// Creates a north-up frame of square cells with its outer top left corner at `(left, top)`.
    pub fn north_up(left: f64, top: f64, resolution: f64, width: usize, height: usize) -> Self {
        Frame {
            width,
            height,
            transform: [left, resolution, 0.0, top, 0.0, -resolution],
        }
    }

    /// Creates the smallest north-up frame around `bounds` whose grid lines are multiples of
    /// `resolution`.
    ///
    /// So the frames of neighboring tiles share a grid. Multiples are those of decimal numbers:
    /// 0.1 x 3 is 0.3.
    ///
    /// # Errors
    /// If the resolution is not a positive number or too fine for the coordinates, the bounds are
    /// empty or not finite, or a side exceeds [`MAX_SIDE`].
    pub fn snapped(bounds: &Bounds, resolution: f64) -> Result<Self> {
        check_extent(bounds, resolution)?;
        let left = whole_below(bounds.min[0] / resolution);
        let right = whole_above(bounds.max[0] / resolution).max(left + 1.0);
        let bottom = whole_below(bounds.min[1] / resolution);
        let top = whole_above(bounds.max[1] / resolution).max(bottom + 1.0);
        let (width, height) = size(right - left, top - bottom)?;
        let corner = (multiple(left, resolution), multiple(top, resolution));
        Frame::north_up(corner.0, corner.1, resolution, width, height).checked()
    }

    /// Creates the smallest north-up frame that covers `bounds` and shares their top left corner.
    ///
    /// # Errors
    /// Those of [`snapped`](Frame::snapped).
    pub fn covering(bounds: &Bounds, resolution: f64) -> Result<Self> {
        check_extent(bounds, resolution)?;
        let cells =
            |axis: usize| whole_above((bounds.max[axis] - bounds.min[axis]) / resolution).max(1.0);
        let (width, height) = size(cells(0), cells(1))?;
        Frame::north_up(bounds.min[0], bounds.max[1], resolution, width, height).checked()
    }

    /// Creates the smallest frame around `bounds` on the grid of `other`, extended beyond its
    /// edges.
    ///
    /// # Errors
    /// If the bounds are empty or not finite, `other` cannot be inverted, or a side exceeds
    /// [`MAX_SIDE`].
    pub fn aligned_to(other: &Frame, bounds: &Bounds) -> Result<Self> {
        check_bounds(bounds)?;
        let to_pixels = other.checked()?.inverse();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (x, y) in [
            (bounds.min[0], bounds.min[1]),
            (bounds.max[0], bounds.min[1]),
            (bounds.min[0], bounds.max[1]),
            (bounds.max[0], bounds.max[1]),
        ] {
            for (i, value) in to_pixels.apply(x, y).into_iter().enumerate() {
                low[i] = low[i].min(value);
                high[i] = high[i].max(value);
            }
        }
        let low = low.map(whole_below);
        let cells = |i: usize| whole_above(high[i]).max(low[i] + 1.0) - low[i];
        let (width, height) = size(cells(0), cells(1))?;
        let mut transform = other.transform;
        [transform[0], transform[3]] = other.to_map(low[0], low[1]);
        Frame {
            width,
            height,
            transform,
        }
        .checked()
    }

    /// Returns the box around the outer corners of all cells; without heights.
    pub fn extent(&self) -> Bounds {
        let mut bounds = Bounds::default();
        let (width, height) = (self.width as f64, self.height as f64);
        for (column, row) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
            let [x, y] = self.to_map(column, row);
            bounds.add([x, y, f64::NAN]);
        }
        bounds
    }

    /// Returns the frame if it is valid.
    ///
    /// # Errors
    /// If it has no cell, a side exceeds [`MAX_SIDE`], the transform is not finite or has no
    /// inverse, or the pixels are too small for doubles to distinguish their centers.
    pub fn checked(self) -> Result<Self> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 {
            return Err(Error::usage(format!(
                "a raster of {width} x {height} cells"
            )));
        }
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(too_large(width as f64, height as f64));
        }
        let t = &self.transform;
        if t.iter().any(|v| !v.is_finite()) {
            return Err(Error::format(format!(
                "the geotransform {t:?} is not finite"
            )));
        }
        let determinant = t[1] * t[5] - t[2] * t[4];
        let pixel = determinant.abs() / t[1].hypot(t[4]).max(t[2].hypot(t[5]));
        if pixel.is_nan() || pixel <= 0.0 {
            return Err(Error::format(format!(
                "the geotransform {t:?} has no inverse"
            )));
        }
        let end = self.to_map(width as f64, height as f64);
        let largest = [t[0], t[3], end[0], end[1]]
            .into_iter()
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let finest = largest * f64::EPSILON * MIN_PIXEL;
        if pixel < finest {
            return Err(Error::usage(format!(
                "cells of {pixel:.3e} are too small for coordinates of {largest}"
            ))
            .cure(format!("take a resolution above {finest:.3e}")));
        }
        Ok(self)
    }

    /// Converts pixels to coordinates (`column + 0.5` is a cell's center).
    pub fn to_map(&self, column: f64, row: f64) -> [f64; 2] {
        let t = &self.transform;
        [
            t[0] + column * t[1] + row * t[2],
            t[3] + column * t[4] + row * t[5],
        ]
    }

    /// Returns the conversion from coordinates to pixels.
    pub fn inverse(&self) -> ToPixels {
        let t = &self.transform;
        let determinant = t[1] * t[5] - t[2] * t[4];
        ToPixels {
            corner: [t[0], t[3]],
            columns: [t[5] / determinant, -t[2] / determinant],
            rows: [-t[4] / determinant, t[1] / determinant],
        }
    }

    /// Returns the center of a cell.
    ///
    /// If the grid lines are multiples of the cell's size, as with [`snapped`](Self::snapped), a
    /// cell has the same center in all rasters of these lines, bit for bit.
    pub fn center(&self, column: usize, row: usize) -> [f64; 2] {
        self.centers()(column, row)
    }

    /// Returns the function from column and row to the [center](Self::center), for many cells.
    pub(crate) fn centers(&self) -> impl Fn(usize, usize) -> [f64; 2] + use<> {
        let frame = *self;
        let t = frame.transform;
        let lines = (t[2] == 0.0 && t[4] == 0.0)
            .then(|| [GridLines::new(t[0], t[1]), GridLines::new(t[3], t[5])]);
        move |column, row| match &lines {
            Some([columns, rows]) => [columns.center(column), rows.center(row)],
            None => frame.to_map(column as f64 + 0.5, row as f64 + 0.5),
        }
    }

    /// Returns true if a cell has the same center, bit for bit, in all rasters that share grid
    /// lines with this one.
    pub fn has_shared_centers(&self) -> bool {
        let t = &self.transform;
        let are_shared = |origin, step| GridLines::new(origin, step).first.is_some();
        t[2] == 0.0 && t[4] == 0.0 && are_shared(t[0], t[1]) && are_shared(t[3], t[5])
    }

    /// Returns the frame of the cells from column and row `from` up to those of `to`, which are not
    /// included, counted in this frame and possibly outside of it. Its cells have the same
    /// [centers](Self::center). `None` if this frame is rotated, its grid lines are not multiples
    /// of the size of its cells, or the other frame would be empty or too large.
    pub(crate) fn on_its_lines(&self, from: [i64; 2], to: [i64; 2]) -> Option<Self> {
        let t = &self.transform;
        if t[2] != 0.0 || t[4] != 0.0 {
            return None;
        }
        let line = |axis: usize| {
            let (origin, step) = [(t[0], t[1]), (t[3], t[5])][axis];
            GridLines::new(origin, step).line(from[axis])
        };
        let (left, top) = (line(0)?, line(1)?);
        let side = |axis: usize| usize::try_from(to[axis].checked_sub(from[axis])?).ok();
        let frame = Frame {
            width: side(0)?,
            height: side(1)?,
            transform: [left, t[1], 0.0, top, 0.0, t[5]],
        };
        frame.checked().ok()
    }

    /// Returns true if rows run from north to south and columns from west to east, without
    /// rotation.
    pub fn is_north_up(&self) -> bool {
        let t = &self.transform;
        t[2] == 0.0 && t[4] == 0.0 && t[1] > 0.0 && t[5] < 0.0
    }

    /// Returns the window of the whole raster.
    pub fn window(&self) -> Window {
        Window {
            column: 0,
            row: 0,
            width: self.width,
            height: self.height,
        }
    }

    /// Checks that `window` lies inside the raster and has `cells` cells.
    ///
    /// # Errors
    /// If one of these is not the case; the message says which.
    pub fn check_window(&self, window: Window, cells: usize) -> Result<()> {
        let Window {
            column,
            row,
            width,
            height,
        } = window;
        let inside =
            |first: usize, count: usize, limit: usize| first <= limit && count <= limit - first;
        if !inside(column, width, self.width) || !inside(row, height, self.height) {
            return Err(Error::usage(format!(
                "a window of {width} x {height} cells at column {column} and row {row} of a raster of {} x {}",
                self.width, self.height
            )));
        }
        if width.checked_mul(height) != Some(cells) {
            return Err(Error::usage(format!(
                "a block of {cells} values for {width} x {height} cells"
            )));
        }
        Ok(())
    }
}

/// The grid lines across an axis of a raster that is not rotated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GridLines {
    origin: f64,
    step: f64,
    /// The number of the first line, if the lines are multiples of the step.
    first: Option<f64>,
}

impl GridLines {
    pub(crate) fn new(origin: f64, step: f64) -> Self {
        let first = (origin / step).round();
        let first = (multiple(first, step) == origin && first.abs() < MOST_LINES).then_some(first);
        GridLines {
            origin,
            step,
            first,
        }
    }

    /// Returns the position of a line, counted from the first; `None` if lines are not multiples of
    /// the step, or this one is too far away.
    fn line(&self, i: i64) -> Option<f64> {
        let number = self.first? + i as f64;
        (number.abs() < MOST_LINES).then(|| multiple(number, self.step))
    }

    /// Returns the center between a line and the next one, counted from the first.
    ///
    /// A center between multiples of the step is computed from its number among all multiples. So
    /// it does not depend on where the raster begins, which rounding would otherwise make visible.
    #[inline]
    pub(crate) fn center(&self, i: usize) -> f64 {
        match self.first {
            Some(first) => multiple(first + (i as f64 + 0.5), self.step),
            None => self.origin + (i as f64 + 0.5) * self.step,
        }
    }
}

/// Numbers of lines below this are exact together with a half.
const MOST_LINES: f64 = (1u64 << 51) as f64;

/// A conversion from coordinates to pixels: the inverse of a frame's transform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToPixels {
    corner: [f64; 2],
    columns: [f64; 2],
    rows: [f64; 2],
}

impl ToPixels {
    /// Returns column and row of a position; the center of the first cell is `[0.5, 0.5]`.
    pub fn apply(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = (x - self.corner[0], y - self.corner[1]);
        [
            self.columns[0] * x + self.columns[1] * y,
            self.rows[0] * x + self.rows[1] * y,
        ]
    }

    /// Returns the change of column and row per map unit along x.
    pub fn along_x(&self) -> [f64; 2] {
        [self.columns[0], self.rows[0]]
    }

    /// Returns the change of column and row per map unit along y.
    pub fn along_y(&self) -> [f64; 2] {
        [self.columns[1], self.rows[1]]
    }

    /// Converts a gradient per column and row to one per map unit along x and y.
    pub fn gradient(&self, per_column: f64, per_row: f64) -> [f64; 2] {
        [
            per_column * self.columns[0] + per_row * self.rows[0],
            per_column * self.columns[1] + per_row * self.rows[1],
        ]
    }
}

/// The distance, in cells, within which a bound counts as lying on a grid line: decimal bounds are
/// rarely exact multiples of a decimal resolution.
fn slack(cells: f64) -> f64 {
    (4.0 * f64::EPSILON * cells.abs()).max(1e-9)
}

fn whole_below(cells: f64) -> f64 {
    (cells + slack(cells)).floor()
}

fn whole_above(cells: f64) -> f64 {
    (cells - slack(cells)).ceil()
}

/// `count * resolution` as in decimal arithmetic. If the resolution is one divided by a whole
/// number, this divides by that number, because 10 is exact as a double and 1/10 is not.
fn multiple(count: f64, resolution: f64) -> f64 {
    let parts = (1.0 / resolution).round();
    if parts.abs() >= 1.0 && 1.0 / parts == resolution {
        count / parts
    } else {
        count * resolution
    }
}

fn check_bounds(bounds: &Bounds) -> Result<()> {
    let plan = [bounds.min[0], bounds.min[1], bounds.max[0], bounds.max[1]];
    if bounds.is_empty() || plan.iter().any(|v| !v.is_finite()) {
        let [xmin, ymin, xmax, ymax] = plan;
        return Err(Error::usage(format!(
            "the bounds {xmin} {ymin} {xmax} {ymax} are empty or not finite"
        ))
        .cure("give them as xmin ymin xmax ymax"));
    }
    Ok(())
}

fn check_extent(bounds: &Bounds, resolution: f64) -> Result<()> {
    if !(resolution > 0.0 && resolution.is_finite()) {
        return Err(Error::usage(format!(
            "the resolution is {resolution}, expected a positive number"
        )));
    }
    check_bounds(bounds)
}

fn size(width: f64, height: f64) -> Result<(usize, usize)> {
    if width > MAX_SIDE as f64 || height > MAX_SIDE as f64 {
        return Err(too_large(width, height));
    }
    Ok((width as usize, height as usize))
}

#[cold]
fn too_large(width: f64, height: f64) -> Error {
    Error::limit(format!(
        "a raster of {} x {} cells; a side has at most {MAX_SIDE}",
        Plain(width),
        Plain(height)
    ))
    .cure("take a coarser resolution or smaller bounds")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(xmin: f64, ymin: f64, xmax: f64, ymax: f64) -> Bounds {
        Bounds {
            min: [xmin, ymin, 0.0],
            max: [xmax, ymax, 0.0],
        }
    }

    #[test]
    fn snapped_frames_lie_on_multiples_and_cover_the_bounds() {
        let frame =
            Frame::snapped(&bounds(885024.09, 629400.0, 885217.09, 629699.99), 1.0).unwrap();
        assert_eq!(frame, Frame::north_up(885024.0, 629700.0, 1.0, 194, 300));
        let frame = Frame::snapped(&bounds(-0.3, -7.0, 0.1, 0.3), 0.1).unwrap();
        assert_eq!(frame, Frame::north_up(-0.3, 0.3, 0.1, 4, 73));
        let frame = Frame::snapped(&bounds(500000.3, 5400000.7, 500001.1, 5400001.7), 0.1).unwrap();
        assert_eq!(frame, Frame::north_up(500000.3, 5400001.7, 0.1, 8, 10));
        let frame = Frame::snapped(&bounds(10.0, 10.0, 10.0, 10.0), 5.0).unwrap();
        assert_eq!(frame, Frame::north_up(10.0, 15.0, 5.0, 1, 1));
    }

    #[test]
    fn covering_frames_begin_at_the_corner() {
        let frame = Frame::covering(&bounds(0.25, 0.25, 10.25, 5.35), 0.1).unwrap();
        assert_eq!(frame, Frame::north_up(0.25, 5.35, 0.1, 100, 51));
    }

    #[test]
    fn aligned_frames_share_the_grid() {
        let north_up = Frame::north_up(0.25, 100.5, 2.0, 7, 9);
        let frame = Frame::aligned_to(&north_up, &bounds(-3.0, 90.0, 4.25, 110.5)).unwrap();
        assert_eq!(frame, Frame::north_up(-3.75, 110.5, 2.0, 4, 11));
        let south_up = Frame {
            transform: [0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            ..north_up
        };
        let frame = Frame::aligned_to(&south_up, &bounds(1.5, 2.5, 3.5, 3.5)).unwrap();
        assert_eq!(
            frame,
            Frame {
                width: 3,
                height: 2,
                transform: [1.0, 1.0, 0.0, 2.0, 0.0, 1.0]
            }
        );
        let rotated = Frame {
            transform: [10.0, 0.6, -0.8, 20.0, 0.8, 0.6],
            ..north_up
        };
        let inside = bounds(11.0, 21.0, 17.0, 29.0);
        let frame = Frame::aligned_to(&rotated, &inside).unwrap();
        for (x, y) in [(11.0, 21.0), (17.0, 21.0), (11.0, 29.0), (17.0, 29.0)] {
            let [column, row] = frame.inverse().apply(x, y);
            assert!(column > -1e-9 && column < frame.width as f64 + 1e-9);
            assert!(row > -1e-9 && row < frame.height as f64 + 1e-9);
        }
        let [column, row] = rotated
            .inverse()
            .apply(frame.transform[0], frame.transform[3]);
        assert!((column - column.round()).abs() < 1e-12 && (row - row.round()).abs() < 1e-12);
    }

    /// Also with steps that are not exact, and with rows that descend.
    #[test]
    fn a_cell_has_the_same_center_in_all_rasters_of_a_grid() {
        for resolution in [1.0, 0.1, 0.3, 0.7, 2.5, 1.0 / 3.0] {
            let whole =
                Frame::snapped(&bounds(-500.0, 5e6, 300.0, 5e6 + 900.0), resolution).unwrap();
            let part =
                Frame::snapped(&bounds(17.3, 5e6 + 40.0, 44.0, 5e6 + 321.7), resolution).unwrap();
            assert!(whole.has_shared_centers() && part.has_shared_centers());
            let [column, row] = whole
                .inverse()
                .apply(part.transform[0], part.transform[3])
                .map(|at| at.round() as usize);
            for k in 0..part.width.min(part.height) {
                assert_eq!(
                    part.center(k, k),
                    whole.center(column + k, row + k),
                    "{resolution}"
                );
                let [x, y] = part.to_map(k as f64 + 0.5, k as f64 + 0.5);
                assert!(
                    (part.center(k, k)[0] - x).abs() < 1e-12
                        && (part.center(k, k)[1] - y).abs() < 1e-8
                );
            }
        }
        assert!(!Frame::north_up(0.25, 0.25, 1.0, 4, 4).has_shared_centers());
        let rotated = Frame {
            width: 4,
            height: 5,
            transform: [0.0, 0.6, -0.8, 0.0, -0.8, -0.6],
        };
        assert!(!rotated.has_shared_centers());
    }

    #[test]
    fn pixels_and_back() {
        let frame = Frame {
            width: 4,
            height: 5,
            transform: [5e5, 0.6, -0.8, 5.4e6, -0.8, -0.6],
        };
        let [x, y] = frame.center(3, 2);
        let [column, row] = frame.inverse().apply(x, y);
        assert!((column - 3.5).abs() < 1e-8 && (row - 2.5).abs() < 1e-8);
    }

    #[test]
    fn says_what_is_wrong() {
        let message = |result: Result<Frame>| result.unwrap_err().to_string();
        let unit = bounds(0.0, 0.0, 1.0, 1.0);
        assert_eq!(
            message(Frame::snapped(&unit, 0.0)),
            "the resolution is 0, expected a positive number"
        );
        assert_eq!(
            message(Frame::snapped(&unit, f64::NAN)),
            "the resolution is NaN, expected a positive number"
        );
        let empty = message(Frame::snapped(&Bounds::default(), 1.0));
        assert_eq!(
            empty,
            "the bounds inf inf -inf -inf are empty or not finite"
        );
        let large = message(Frame::snapped(&bounds(0.0, 0.0, 3e6, 1.0), 0.001));
        assert_eq!(
            large,
            "a raster of 3000000000 x 1000 cells; a side has at most 2147483647"
        );
        let fine = message(Frame::snapped(&bounds(5e6, 5e6, 5e6, 5e6), 1e-7));
        assert_eq!(
            fine,
            "cells of 1.000e-7 are too small for coordinates of 5000000.0000001"
        );
        let singular = Frame {
            width: 1,
            height: 1,
            transform: [0.0, 1.0, 1.0, 0.0, 1.0, 1.0],
        };
        assert_eq!(
            message(singular.checked()),
            "the geotransform [0.0, 1.0, 1.0, 0.0, 1.0, 1.0] has no inverse"
        );
        let window = Window {
            column: 1,
            row: 0,
            width: usize::MAX,
            height: 1,
        };
        assert!(
            Frame::north_up(0.0, 0.0, 1.0, 4, 4)
                .check_window(window, 4)
                .is_err()
        );
    }
}
