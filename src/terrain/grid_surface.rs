use std::ops::Range;

use crate::crs::Crs;
use crate::data::{EdgeKind, Frame, Grid, Surface, higher, lower, range_of_finite};
use crate::error::{Error, Result};

/// A surface over the cell centers of a raster, for contours of a DEM.
///
/// The centers of four neighboring cells are the corners of a quad. A fifth vertex in its middle
/// divides the quad into four triangles. It is at the mean of their heights, or at the height that
/// three of them have:
///
/// ```text
/// +-------+
/// | \   / |
/// |   x   |
/// | /   \ |
/// +-------+
/// ```
///
/// So no diagonal is preferred: rotated or mirrored rasters give rotated or mirrored surfaces, and
/// a saddle has its pass in the middle, at the height of bilinear interpolation. (With the same
/// diagonal in all quads, contours of valleys along it are smooth and others ragged; a diagonal
/// chosen by the heights jumps when these change a little.) At the border of flat ground, where
/// three cells are equal, the mean would make its contour a staircase along the cells; so the flat
/// ground ends at the diagonal.
///
/// A quad with one missing cell (NaN, or infinite) is one triangle; with two or more missing cells
/// it is empty. Faces are computed on request: the surface needs no memory in addition to the
/// raster.
///
/// Vertices are numbered by cell, row by row, and then by quad; faces by quad, four numbers each.
#[derive(Debug, Clone, Copy)]
pub struct GridSurface<'a> {
    grid: &'a Grid,
    /// The row of the raster that the first row of the grid is.
    first_row: usize,
    /// The number of quads in a row, and of rows of quads.
    quads: [usize; 2],
    /// The corners of a quad, counter-clockwise in plan, as offsets of column and row.
    corners: [[usize; 2]; 4],
    /// Division by the numbers of cells and of quads in a row.
    by_row_of_cells: Divisor,
    by_row_of_quads: Divisor,
    /// True if no cell is missing.
    is_complete: bool,
}

/// The number of quads that are compared with levels together.
const BLOCK: usize = 64;

/// Which corners of a quad have values.
enum Quad {
    Whole,
    /// All corners but this one.
    Without(usize),
    Nothing,
}

impl Quad {
    fn of(corners: [f64; 4]) -> Self {
        match corners.map(f64::is_finite) {
            [true, true, true, true] => Quad::Whole,
            [false, true, true, true] => Quad::Without(0),
            [true, false, true, true] => Quad::Without(1),
            [true, true, false, true] => Quad::Without(2),
            [true, true, true, false] => Quad::Without(3),
            _ => Quad::Nothing,
        }
    }
}

impl<'a> GridSurface<'a> {
    /// Creates the surface over a raster.
    ///
    /// # Errors
    /// If the raster has more faces than can be numbered (about a billion quads), or its transform
    /// is singular.
    pub fn new(grid: &'a Grid) -> Result<Self> {
        let frame = &grid.frame;
        let quads = [
            frame.width.saturating_sub(1),
            frame.height.saturating_sub(1),
        ];
        let cells = frame.width.checked_mul(frame.height);
        if cells != Some(grid.values.len()) {
            return Err(Error::usage(format!(
                "raster of {} x {} cells has {} values",
                frame.width,
                frame.height,
                grid.values.len()
            )));
        }
        // There are more faces than vertices, except in single rows.
        let largest =
            (4 * (quads[0] as u128) * (quads[1] as u128)).max(2 * grid.values.len() as u128);
        if largest > u128::from(u32::MAX) {
            return Err(Error::limit(format!(
                "raster of {} x {} cells is too large for contours, at most {} cells can be drawn at a time",
                frame.width,
                frame.height,
                u32::MAX / 4
            ))
            .cure("use a part of it, or a coarser raster"));
        }
        let t = &frame.transform;
        let area = t[1] * t[5] - t[2] * t[4];
        if !(area != 0.0 && area.is_finite()) {
            return Err(Error::format(format!(
                "raster transform {t:?} has cells without area"
            )));
        }
        let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
        if area < 0.0 {
            corners.reverse();
        }
        Ok(GridSurface {
            grid,
            first_row: 0,
            quads,
            corners,
            by_row_of_cells: Divisor::new(frame.width),
            by_row_of_quads: Divisor::new(quads[0]),
            is_complete: range_of_finite(&grid.values).is_some(),
        })
    }

    /// Creates the surface over some rows of a raster, from `first_row` on. The grid has the rows,
    /// and the transform of the raster.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub(crate) fn of_rows(grid: &'a Grid, first_row: usize) -> Result<Self> {
        Ok(GridSurface {
            first_row,
            ..Self::new(grid)?
        })
    }

    /// Row and column in the raster of a vertex that is the center of a cell. No side of a raster
    /// has more than 2^32 cells.
    pub(crate) fn cell_of(&self, vertex: u32) -> [u32; 2] {
        let [column, row] = self.by_row_of_cells.column_and_row(vertex);
        [(self.first_row + row) as u32, column as u32]
    }

    /// The faces of the first and of the last row of quads, with their vertices.
    pub(crate) fn faces_of_first_and_last_row(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        let (count, of_row) = (self.face_count(), 4 * self.quads[0]);
        let last = of_row.max(count.saturating_sub(of_row));
        let numbers = (0..of_row.min(count)).chain(last..count);
        numbers.filter_map(|face| Some((face as u32, self.face(face as u32)?)))
    }

    /// Column and row of a face's quad, and the position of the face among its four.
    fn quad_of(&self, face: u32) -> ([usize; 2], usize) {
        let quad = self.by_row_of_quads.column_and_row(face / 4);
        (quad, face as usize % 4)
    }

    #[inline]
    fn quad(&self, [column, row]: [usize; 2]) -> Quad {
        if self.is_complete {
            return Quad::Whole;
        }
        Quad::of(
            self.corners
                .map(|[right, down]| self.grid.value(column + right, row + down)),
        )
    }

    /// Implements [`heights_in`](Surface::heights_in) for the faces of a quad, numbered from
    /// `first`.
    #[inline]
    fn heights_between(
        &self,
        cells: [[f64; 2]; 2],
        first: u32,
        numbers: &Range<u32>,
        is_wanted: &dyn Fn(f64, f64) -> bool,
        faces: &mut Vec<(u32, [f64; 3])>,
    ) {
        let corner = |i: usize| {
            let [right, down] = self.corners[i % 4];
            cells[down][right]
        };
        let mut add = |which: usize, [a, b, c]: [f64; 3]| {
            let face = first + which as u32;
            if numbers.contains(&face) && is_wanted(a.min(b).min(c), a.max(b).max(c)) {
                faces.push((face, [a, b, c]));
            }
        };
        let [[a, b], [c, d]] = cells;
        if [a, b, c, d].map(f64::is_finite) == [true; 4] {
            let center = center(cells);
            let low = lower(lower(lower(a, b), lower(c, d)), center);
            let high = higher(higher(higher(a, b), higher(c, d)), center);
            if is_wanted(low, high) {
                (0..4).for_each(|i| add(i, [corner(i), corner(i + 1), center]));
            }
        } else if let Quad::Without(i) = Quad::of([0, 1, 2, 3].map(corner)) {
            add(0, [1, 2, 3].map(|step| corner(i + step)));
        }
    }

    fn corner(&self, [column, row]: [usize; 2], i: usize) -> u32 {
        let [right, down] = self.corners[i % 4];
        ((row + down) * self.grid.frame.width + column + right) as u32
    }

    fn face_at(&self, [column, row]: [usize; 2], which: usize) -> u32 {
        (4 * (row * self.quads[0] + column) + which) as u32
    }

    /// The quad across side `i`, which runs from corner `i` to the next.
    fn quad_across(&self, [column, row]: [usize; 2], i: usize) -> Option<[usize; 2]> {
        let (a, b) = (self.corners[i % 4], self.corners[(i + 1) % 4]);
        let step = |at: usize, a: usize, b: usize, count: usize| match (a, b) {
            (0, 0) => at.checked_sub(1),
            (1, 1) => Some(at + 1).filter(|&at| at < count),
            _ => Some(at),
        };
        Some([
            step(column, a[0], b[0], self.quads[0])?,
            step(row, a[1], b[1], self.quads[1])?,
        ])
    }
}

/// The height in the middle of four cells: that of three of them, or the mean.
fn center(cells: [[f64; 2]; 2]) -> f64 {
    let [[a, b], [c, d]] = cells;
    // Three of the four contain a diagonal.
    if a == d && (a == b || a == c) {
        return a;
    }
    if b == c && (b == a || b == d) {
        return b;
    }
    let [a, b, c, d] = [a, b, c, d].map(|height| 0.25 * height);
    // Summed by diagonals: the result is the same if the raster is rotated.
    (a + d) + (b + c)
}

/// A number of columns that divides by a multiplication. All numbers have 32 bits.
#[derive(Debug, Clone, Copy)]
struct Divisor {
    columns: u32,
    /// 2^64 / columns, rounded up: exact for dividends of 32 bits (Lemire, Kaser and Kurz, "Faster
    /// remainder by direct computation", 2019).
    reciprocal: u128,
}

impl Divisor {
    fn new(columns: usize) -> Self {
        // Numbers are divided only if there are columns.
        let columns = columns.max(1) as u32;
        Divisor {
            columns,
            reciprocal: (1_u128 << 64).div_ceil(u128::from(columns)),
        }
    }

    /// Column and row of a number that counts row by row.
    #[inline]
    fn column_and_row(self, number: u32) -> [usize; 2] {
        let row = ((self.reciprocal * u128::from(number)) >> 64) as u32;
        [(number - row * self.columns) as usize, row as usize]
    }
}

impl Surface for GridSurface<'_> {
    fn vertex_count(&self) -> usize {
        self.grid.values.len() + self.quads[0] * self.quads[1]
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        let frame = &self.grid.frame;
        let cells = self.grid.values.len() as u32;
        if vertex < cells {
            let [column, row] = self.by_row_of_cells.column_and_row(vertex);
            let [x, y] = frame.to_map(column as f64 + 0.5, (self.first_row + row) as f64 + 0.5);
            return [x, y, self.grid.value(column, row)];
        }
        let [column, row] = self.by_row_of_quads.column_and_row(vertex - cells);
        let [x, y] = frame.to_map(column as f64 + 1.0, (self.first_row + row) as f64 + 1.0);
        [
            x,
            y,
            center(
                [0, 1].map(|down| [0, 1].map(|right| self.grid.value(column + right, row + down))),
            ),
        ]
    }

    fn is_between(&self, vertex: u32) -> bool {
        vertex as usize >= self.grid.values.len()
    }

    fn face_count(&self) -> usize {
        4 * self.quads[0] * self.quads[1]
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        if face as usize >= self.face_count() {
            return None;
        }
        let (at, which) = self.quad_of(face);
        match self.quad(at) {
            Quad::Whole => {
                let center = (self.grid.values.len() + face as usize / 4) as u32;
                Some([self.corner(at, which), self.corner(at, which + 1), center])
            }
            // Corner 1 of the face is opposite the missing one.
            Quad::Without(i) if which == 0 => Some([1, 2, 3].map(|step| self.corner(at, i + step))),
            _ => None,
        }
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let (at, which) = self.quad_of(face);
        let side = match self.quad(at) {
            Quad::Whole => match i {
                0 => return Some(self.face_at(at, (which + 1) % 4)),
                1 => return Some(self.face_at(at, (which + 3) % 4)),
                _ => which,
            },
            Quad::Without(missing) => match i {
                0 => missing + 2,
                2 => missing + 1,
                _ => return None,
            },
            Quad::Nothing => return None,
        };
        let beyond = self.quad_across(at, side)?;
        match self.quad(beyond) {
            Quad::Whole => Some(self.face_at(beyond, (side + 2) % 4)),
            Quad::Without(_) => Some(self.face_at(beyond, 0)),
            Quad::Nothing => None,
        }
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        if self.neighbor(face, i).is_some() {
            EdgeKind::Plain
        } else {
            EdgeKind::Rim
        }
    }

    fn faces_at(&self, [x, y]: [f64; 2], _near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        /// The distance from the border of a quad, in cells, within which rounding may hide on
        /// which side a position is: `Frame::checked` ensures that a center is within 2^-13 of a
        /// cell of its exact position.
        const SLACK: f64 = 1e-3;
        let [column, row] = self.grid.frame.inverse().apply(x, y);
        let quads = |at: f64, count: usize| {
            let [first, end] = [at - SLACK, at + SLACK].map(|at| at.max(0.0).min(count as f64));
            first.floor() as usize..(end.floor() as usize + 1).min(count)
        };
        // The first quad begins at the center of the first cell.
        let columns = quads(column - 0.5, self.quads[0]);
        for row in quads(row - 0.5 - self.first_row as f64, self.quads[1]) {
            for column in columns.clone() {
                faces.extend((0..4).map(|which| self.face_at([column, row], which)));
            }
        }
        true
    }

    fn heights_in(
        &self,
        numbers: Range<u32>,
        is_wanted: &dyn Fn(f64, f64) -> bool,
        faces: &mut Vec<(u32, [f64; 3])>,
    ) {
        let [across, width] = [self.quads[0] as u32, self.grid.frame.width as u32];
        let end = numbers.end.div_ceil(4);
        let mut quad = numbers.start / 4;
        while quad < end {
            // A row of quads, or the requested part of it.
            let (column, row) = (quad % across, quad / across);
            let count = (across - column).min(end - quad);
            let upper = &self.grid.values[(row * width + column) as usize..][..=count as usize];
            let lower =
                &self.grid.values[((row + 1) * width + column) as usize..][..=count as usize];
            for start in (0..count as usize).step_by(BLOCK) {
                let block = (count as usize - start).min(BLOCK);
                let [upper, lower] = [upper, lower].map(|row| &row[start..=start + block]);
                // `PERF:` quads that are far from all levels are skipped together.
                let range = range_of_finite(upper).zip(range_of_finite(lower));
                let is_near = range.is_none_or(|([a, b], [c, d])| is_wanted(a.min(c), b.max(d)));
                if is_near {
                    for (at, (upper, lower)) in (quad..).zip(upper.windows(2).zip(lower.windows(2)))
                    {
                        let cells = [[upper[0], upper[1]], [lower[0], lower[1]]];
                        self.heights_between(cells, 4 * at, &numbers, is_wanted, faces);
                    }
                }
                quad += block as u32;
            }
        }
    }

    fn has_lines(&self) -> bool {
        false
    }

    fn least_width(&self) -> f64 {
        let Frame {
            width,
            height,
            transform: t,
        } = self.grid.frame;
        let area = (t[1] * t[5] - t[2] * t[4]).abs();
        let sides = t[1].abs() + t[2].abs() + t[4].abs() + t[5].abs();
        let [rows, width] = [self.first_row + height, width].map(|count| count as f64);
        let size = [0, 3].map(|i| t[i].abs() + width * t[i + 1].abs() + rows * t[i + 2].abs());
        // Twice the area of a face is at least half the area of a cell. Half of that is left for
        // the rounding of positions.
        0.25 * area / sides / (f64::EPSILON * size[0].max(size[1]))
    }

    fn crs(&self) -> Option<&Crs> {
        self.grid.crs.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::thin::{STEPS, is_thin};

    fn surface_test(frame: Frame, hole_every: u32, check: impl Fn(&GridSurface)) {
        let cell = |i: u32| match i.wrapping_mul(2_654_435_769) >> 29 {
            _ if i.is_multiple_of(hole_every) => f64::NAN,
            height => f64::from(height) + f64::from(i / 100),
        };
        let grid = Grid {
            frame,
            crs: None,
            values: (1..).take(frame.width * frame.height).map(cell).collect(),
        };
        check(&GridSurface::new(&grid).unwrap());
    }

    const TRANSFORMS: [[f64; 6]; 3] = [
        [0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
        [512_000.1, 0.3, 0.1, 5_403_000.7, -0.2, -0.3],
    ];

    /// The faces of a range whose heights meet a range: with many holes, some and none.
    #[test]
    fn heights_are_those_of_the_faces() {
        for (transform, hole_every) in TRANSFORMS.into_iter().zip([8, 500, 100_000]) {
            for [width, height] in [[7, 9], [150, 5]] {
                let frame = Frame {
                    width,
                    height,
                    transform,
                };
                surface_test(frame, hole_every, |surface| {
                    let count = surface.face_count() as u32;
                    let ranges = [
                        (0, count),
                        (1, count - 1),
                        (5, 6),
                        (22, 75),
                        (24, 24),
                        (30, 31),
                    ];
                    for (start, end) in ranges {
                        for level in [0.0, 1.0, 2.25, 5.0, 7.0, 8.0] {
                            let is_wanted = |low: f64, high: f64| low < level && level <= high;
                            let mut found = Vec::new();
                            surface.heights_in(start..end, &is_wanted, &mut found);
                            let heights =
                                |face| Some((face, surface.triangle(face)?.map(|p| p[2])));
                            let expected =
                                (start..end).filter_map(heights).filter(|(_, [a, b, c])| {
                                    is_wanted(a.min(*b).min(*c), a.max(*b).max(*c))
                                });
                            assert_eq!(
                                found,
                                expected.collect::<Vec<_>>(),
                                "{start}..{end} at {level}"
                            );
                        }
                    }
                });
            }
        }
    }

    #[test]
    fn no_face_is_narrower_than_stated() {
        for transform in TRANSFORMS {
            let frame = Frame {
                width: 6,
                height: 5,
                transform,
            };
            surface_test(frame, 8, |surface| {
                let least = surface.least_width();
                for corners in (0..surface.face_count() as u32).filter_map(|f| surface.triangle(f))
                {
                    assert!(!is_thin(corners, STEPS / least), "{corners:?} {least}");
                }
            });
        }
    }

    #[test]
    fn a_divisor_divides() {
        let numbers = [
            0,
            1,
            2,
            3,
            63,
            64,
            65,
            12_345,
            65_535,
            65_536,
            u32::MAX - 1,
            u32::MAX,
        ];
        for columns in numbers.into_iter().filter(|&columns| columns > 0) {
            let divisor = Divisor::new(columns as usize);
            for number in numbers {
                let expected = [number % columns, number / columns].map(|n| n as usize);
                assert_eq!(
                    divisor.column_and_row(number),
                    expected,
                    "{number} / {columns}"
                );
            }
        }
    }
}
