/// The weights of vertices; those of a Delaunay triangulation are all equal.
///
/// The power test does not change if all weights grow by the same number. In the filter the
/// greatest is taken to be zero: then no squared radius is negative, and nothing is lost where it
/// is computed.
pub(super) struct Weights {
    /// Empty if all are equal.
    each: Vec<f64>,
    greatest: f64,
    /// No two differ by more.
    range: f64,
}

impl Weights {
    /// Returns weights that are numbers. The least and the greatest are those of more vertices than
    /// these, perhaps.
    pub(super) fn new([least, greatest]: [f64; 2], weights: impl Iterator<Item = f64>) -> Self {
        if least == greatest {
            return Weights {
                each: Vec::new(),
                greatest: 0.0,
                range: 0.0,
            };
        }
        Weights {
            each: weights.collect(),
            greatest,
            range: greatest - least,
        }
    }

    /// Returns true if vertices may be hidden.
    pub(super) fn may_hide(&self) -> bool {
        !self.each.is_empty()
    }

    /// Returns a number that no difference of two weights exceeds.
    pub(super) fn range(&self) -> f64 {
        self.range
    }

    /// Returns the weight of a vertex; that of the infinite one is not a number.
    #[inline(always)]
    pub(super) fn of(&self, vertex: u32) -> f64 {
        self.each.get(vertex as usize).copied().unwrap_or(f64::NAN)
    }

    /// Returns how much a finite vertex lacks of the greatest weight.
    #[inline(always)]
    pub(super) fn lack(&self, vertex: u32) -> f64 {
        self.each
            .get(vertex as usize)
            .map_or(0.0, |weight| self.greatest - weight)
    }
}
