use crate::data::{Frame, GridLines, ToPixels};

/// The plane in which faces are scanned: columns and rows of cell centers ascend along its axes.
///
/// For a raster that is not rotated this is the map itself, mirrored if columns or rows descend.
/// Coordinates are exact then, and a vertex at a cell's center stays there. A rotated raster is
/// scanned in pixels.
#[derive(Debug)]
pub(super) struct Placement {
    mapping: Mapping,
    pub(super) columns: Axis,
    pub(super) rows: Axis,
}

#[derive(Debug)]
enum Mapping {
    Mirror([f64; 2]),
    Pixels(ToPixels, [f64; 2]),
}

/// The centers of columns or rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    origin: f64,
    lines: GridLines,
    per_step: f64,
    /// The number of columns or rows.
    pub(super) count: usize,
}

impl Placement {
    pub(super) fn new(frame: &Frame) -> Self {
        let t = &frame.transform;
        if t[2] == 0.0 && t[4] == 0.0 {
            let signs = [t[1].signum(), t[5].signum()];
            return Placement {
                mapping: Mapping::Mirror(signs),
                columns: Axis::new(signs[0] * t[0], signs[0] * t[1], frame.width),
                rows: Axis::new(signs[1] * t[3], signs[1] * t[5], frame.height),
            };
        }
        Placement {
            mapping: Mapping::Pixels(frame.inverse(), rounding(frame)),
            columns: Axis::new(0.0, 1.0, frame.width),
            rows: Axis::new(0.0, 1.0, frame.height),
        }
    }

    /// Maps a vertex to the plane of the scan.
    #[inline]
    pub(super) fn to_plane(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match &self.mapping {
            Mapping::Mirror([sign_x, sign_y]) => [sign_x * x, sign_y * y, z],
            Mapping::Pixels(to_pixels, rounding) => {
                let [column, row] = to_pixels.apply(x, y);
                [
                    to_center(column, rounding[0]),
                    to_center(row, rounding[1]),
                    z,
                ]
            }
        }
    }
}

/// The largest rounding error of the conversion of a position to pixels.
fn rounding(frame: &Frame) -> [f64; 2] {
    let end = frame.to_map(frame.width as f64, frame.height as f64);
    let reach = [0, 1].map(|i| frame.transform[3 * i].abs().max(end[i].abs()));
    let to_pixels = frame.inverse();
    let (dx, dy) = (to_pixels.along_x(), to_pixels.along_y());
    [0, 1].map(|i| 8.0 * f64::EPSILON * (reach[0] * dx[i].abs() + reach[1] * dy[i].abs()))
}

/// The center of the pixel if `value` is within `rounding` of it, otherwise `value`.
fn to_center(value: f64, rounding: f64) -> f64 {
    let center = value.floor() + 0.5;
    if (value - center).abs() <= rounding {
        center
    } else {
        value
    }
}

impl Axis {
    fn new(origin: f64, step: f64, count: usize) -> Self {
        Axis {
            origin,
            lines: GridLines::new(origin, step),
            per_step: 1.0 / step,
            count,
        }
    }

    /// The center of one cell, bit for bit that of [`Frame::center`] except for its sign.
    #[inline]
    pub(super) fn center(&self, i: usize) -> f64 {
        self.lines.center(i)
    }

    /// The cells whose centers lie in `low..=high`, or beyond it by less than a rounding error.
    #[inline]
    pub(super) fn cells(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        // `Frame::checked` ensures that a center is within 2^-13 of a cell of its exact position.
        const SLACK: f64 = 1e-3;
        let first = (low - self.origin) * self.per_step - (0.5 + SLACK);
        let end = (high - self.origin) * self.per_step + (0.5 + SLACK);
        let whole = truncated(first);
        let first = whole + usize::from((whole as f64) < first);
        let end = truncated(end).min(self.count);
        first.min(end)..end
    }
}

/// The centers of the columns or rows of a window.
#[derive(Debug)]
pub(super) struct Centers {
    axis: Axis,
    first: usize,
    values: Vec<f64>,
}

impl Centers {
    pub(super) fn new(axis: Axis, first: usize, count: usize) -> Self {
        Centers {
            axis,
            first,
            values: (first..first + count).map(|i| axis.center(i)).collect(),
        }
    }

    /// The center of each column or row of the window.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The first column or row whose center is `value` or more.
    #[inline]
    pub(super) fn at_or_after(&self, value: f64) -> usize {
        let mut i = self.guess(value);
        while i > 0 && self.values[i - 1] >= value {
            i -= 1;
        }
        while i < self.values.len() && self.values[i] < value {
            i += 1;
        }
        i
    }

    /// The first column or row whose center is more than `value`.
    #[inline]
    pub(super) fn after(&self, value: f64) -> usize {
        let mut i = self.guess(value);
        while i > 0 && self.values[i - 1] > value {
            i -= 1;
        }
        while i < self.values.len() && self.values[i] <= value {
            i += 1;
        }
        i
    }

    /// An estimate that rounding can make wrong by one cell, so that the searches above are short.
    #[inline]
    fn guess(&self, value: f64) -> usize {
        let cell = (value - self.axis.origin) * self.axis.per_step + 0.5 - self.first as f64;
        truncated(cell).min(self.values.len())
    }
}

/// Rounds down to a cell; 0 if `value` is negative or NaN.
///
/// PERF: one instruction on the baseline x86-64, where `floor` is a call into the C library and a
/// cast to `usize` takes five. `MAX_SIDE` fits.
#[inline]
fn truncated(value: f64) -> usize {
    (value as i32).max(0) as usize
}
