/// An integer lattice in space, as in the header of a LAS file.
///
/// `n` steps on an axis stand for the coordinate `n * scale + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// The length of a step on each axis.
    pub scale: [f64; 3],
    /// The coordinates of the origin.
    pub offset: [f64; 3],
}

impl Lattice {
    /// Returns the coordinates of a point of the lattice, rounded like a reader of LAS does.
    #[inline]
    pub fn point(&self, steps: [i32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| f64::from(steps[k]) * self.scale[k] + self.offset[k])
    }

    /// Returns the steps to the nearest point of the lattice; `None` if they do not fit into 32
    /// bits.
    #[inline]
    pub fn nearest(&self, point: [f64; 3]) -> Option<[i32; 3]> {
        let range = f64::from(i32::MIN)..=f64::from(i32::MAX);
        let steps = [0, 1, 2].map(|k| ((point[k] - self.offset[k]) / self.scale[k]).round());
        steps
            .iter()
            .all(|step| range.contains(step))
            .then(|| steps.map(|step| step as i32))
    }

    /// Returns the steps to a point; `None` if it is not a [point](Self::point) of the lattice.
    #[inline]
    pub fn steps(&self, point: [f64; 3]) -> Option<[i32; 3]> {
        self.nearest(point)
            .filter(|&steps| self.point(steps) == point)
    }

    /// Returns the embedding of this lattice in a finer one; `None` if the other lacks some of its
    /// points.
    ///
    /// A step here must be a whole number of steps there, and so must the distance between the
    /// origins, up to the rounding of coordinates to doubles.
    pub fn embed(&self, into: &Lattice) -> Option<Embedding> {
        let mut embedding = Embedding {
            factor: [1; 3],
            shift: [0; 3],
        };
        for k in 0..3 {
            let (factor, shift) = (
                self.scale[k] / into.scale[k],
                (self.offset[k] - into.offset[k]) / into.scale[k],
            );
            // Scales and offsets in decimals are rounded themselves.
            let size = (self.offset[k].abs() + into.offset[k].abs()) / into.scale[k];
            embedding.factor[k] = whole(factor, factor).filter(|&factor| factor > 0)?;
            embedding.shift[k] = whole(shift, size)?;
        }
        Some(embedding)
    }
}

/// Rounds `x` if it is whole up to a few roundings of numbers as large as `size`.
fn whole(x: f64, size: f64) -> Option<i32> {
    let tolerance = (4.0 * f64::EPSILON * size.abs()).min(0.01);
    let is_whole = (x - x.round()).abs() <= tolerance && x.abs() < f64::from(i32::MAX);
    is_whole.then_some(x.round() as i32)
}

/// Maps the points of a lattice to those of a finer one; see [`Lattice::embed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Embedding {
    factor: [i32; 3],
    shift: [i32; 3],
}

impl Embedding {
    /// Returns the same point in steps of the finer lattice; `None` if these exceed 32 bits.
    #[inline]
    pub fn steps(&self, steps: [i32; 3]) -> Option<[i32; 3]> {
        let mut there = [0; 3];
        for k in 0..3 {
            there[k] = steps[k]
                .checked_mul(self.factor[k])?
                .checked_add(self.shift[k])?;
        }
        Some(there)
    }
}
