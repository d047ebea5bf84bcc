//! Points on a lattice: the cells of a raster, found by columns instead of lists.

use super::error::{Slopes, Worst, larger};

/// Heights at all positions of a lattice, column by column, each from the south. The number of a
/// site is its position in this list. NaN is a cell without a height.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    pub(super) rows: u32,
    pub(super) heights: Vec<f64>,
}

/// One column of a triangle: the sites from `first` on, and the height of the plane there.
pub(super) struct Column<'a> {
    pub(super) first: u32,
    pub(super) heights: &'a [f64],
    pub(super) base: f64,
    pub(super) step: f64,
}

impl Column<'_> {
    #[inline(always)]
    pub(super) fn residual(&self, k: usize) -> f64 {
        self.heights[k] - (self.base + self.step * k as f64)
    }

    /// The largest distance from the plane; cells without a height do not count.
    #[inline(always)]
    fn largest(&self) -> f64 {
        // PERF: compilers do not reorder the maximum of floating point numbers; four at a time.
        let mut largest = [0.0_f64; 4];
        let mut at = [0.0, 1.0, 2.0, 3.0];
        let (fours, rest) = self.heights.as_chunks::<4>();
        for four in fours {
            for lane in 0..4 {
                let error = (four[lane] - (self.base + self.step * at[lane])).abs();
                largest[lane] = larger(error, largest[lane]);
                at[lane] += 4.0;
            }
        }
        for (lane, z) in rest.iter().enumerate() {
            let error = (z - (self.base + self.step * at[lane])).abs();
            largest[lane] = larger(error, largest[lane]);
        }
        largest.into_iter().fold(0.0, f64::max)
    }
}

impl Lattice {
    /// Column and row of a site.
    #[inline(always)]
    pub(super) fn position(&self, site: u32) -> [i32; 2] {
        [(site / self.rows) as i32, (site % self.rows) as i32]
    }

    /// Calls a function with each column of a triangle, from west to east, until it returns false.
    /// Sites on edges belong to the columns. The second argument is a bound of the rounding errors
    /// of [`Column::residual`].
    ///
    /// The corners may be in any order; the result does not depend on it.
    ///
    /// # Errors
    /// If the triangle has no area, so that nothing can be measured: the first site on it that is
    /// none of its corners, if there is any.
    #[inline]
    pub(super) fn columns(
        &self,
        mut corners: [u32; 3],
        mut visit: impl FnMut(&Column, f64) -> bool,
    ) -> Result<(), Option<u32>> {
        corners.sort_unstable();
        let [a, b, c] = corners.map(|site| self.position(site));
        let site =
            |p: [i32; 2], n: u32| [f64::from(p[0]), f64::from(p[1]), self.heights[n as usize]];
        let Some(slopes) = Slopes::of([
            site(a, corners[0]),
            site(b, corners[1]),
            site(c, corners[2]),
        ]) else {
            return Err(self.between(corners));
        };
        let [gx, gy] = slopes.along;
        let [ab, ac, bc] = [Edge::of(a, b), Edge::of(a, c), Edge::of(b, c)];
        for x in a[0]..=c[0] {
            let long = if a[0] == c[0] {
                (a[1], a[1])
            } else {
                ac.rows_at(x)
            };
            let short = if x < b[0] {
                ab.rows_at(x)
            } else if x > b[0] {
                bc.rows_at(x)
            } else {
                (b[1], b[1])
            };
            // Each is the last row at or below the edge, and the first at or above it.
            let (low, high) = if long <= short {
                (long.1, short.0)
            } else {
                (short.1, long.0)
            };
            if low > high {
                continue;
            }
            let first = x as usize * self.rows as usize + low as usize;
            let column = Column {
                first: first as u32,
                heights: &self.heights[first..=first + (high - low) as usize],
                base: slopes.origin[2] + gx * f64::from(x - a[0]) + gy * f64::from(low - a[1]),
                step: gy,
            };
            if !visit(&column, slopes.uncertainty) {
                break;
            }
        }
        Ok(())
    }

    /// The first site with a height between the first and the last of three sites on a line, except
    /// the one in the middle.
    fn between(&self, [a, b, c]: [u32; 3]) -> Option<u32> {
        let [p, r] = [a, c].map(|site| self.position(site));
        let (dx, dy) = (r[0] - p[0], r[1] - p[1]);
        let steps = gcd(dx.unsigned_abs(), dy.unsigned_abs()) as i32;
        let at = |k: i32| {
            let [x, y] = [p[0] + dx / steps * k, p[1] + dy / steps * k];
            x as u32 * self.rows + y as u32
        };
        let is_site = |site: &u32| *site != b && !self.heights[*site as usize].is_nan();
        (1..steps).map(at).find(is_site)
    }

    /// The worst cell of a triangle, by rounded numbers, and a bound of their errors. Ends early
    /// above `limit`.
    #[inline]
    pub(super) fn worst(&self, corners: [u32; 3], limit: f64) -> (Worst, f64) {
        let mut worst = Worst::NONE;
        let mut bound = 0.0;
        let of_flat = self.columns(corners, |column, uncertainty| {
            bound = uncertainty;
            let largest = column.largest();
            if largest > worst.error {
                let at = (0..column.heights.len()).find(|&k| column.residual(k).abs() == largest);
                worst = Worst {
                    error: largest,
                    site: column.first + at.unwrap_or(0) as u32,
                };
            }
            worst.error <= limit
        });
        match of_flat {
            Err(Some(site)) => (
                Worst {
                    error: f64::MAX,
                    site,
                },
                0.0,
            ),
            _ => (worst, bound),
        }
    }
}

/// An edge between lattice points, from west to east.
#[derive(Clone, Copy)]
struct Edge {
    from: [i32; 2],
    width: i32,
    height: i64,
}

impl Edge {
    #[inline(always)]
    fn of(p: [i32; 2], q: [i32; 2]) -> Self {
        Edge {
            from: p,
            width: q[0] - p[0],
            height: i64::from(q[1] - p[1]),
        }
    }

    /// The last row at or below the edge in a column, and the first at or above it.
    #[inline(always)]
    fn rows_at(&self, x: i32) -> (i32, i32) {
        let width = i64::from(self.width);
        let rise = self.height * i64::from(x - self.from[0]);
        let (down, rest) = match (i32::try_from(rise), self.width) {
            // PERF: divisions of 32 bits are several times faster.
            (Ok(rise), width) => (rise.div_euclid(width), i64::from(rise.rem_euclid(width))),
            _ => (rise.div_euclid(width) as i32, rise.rem_euclid(width)),
        };
        let low = self.from[1] + down;
        (low, low + i32::from(rest != 0))
    }
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}
