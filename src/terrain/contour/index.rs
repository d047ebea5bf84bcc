/// Sorted levels with a search by height, in constant time if they are evenly spaced.
pub(super) struct LevelIndex {
    levels: Vec<f64>,
    /// The range of the levels is divided into as many equal steps as there are levels. For each
    /// step, the level at which the search for a height in it starts, upward.
    starts: Vec<u32>,
    low: f64,
    steps_per_unit: f64,
}

impl LevelIndex {
    /// The levels must be ascending.
    pub(super) fn new(levels: Vec<f64>) -> Self {
        let low = levels.first().copied().unwrap_or(0.0);
        let high = levels.last().copied().unwrap_or(0.0);
        let steps_per_unit = Some(levels.len() as f64 / (high - low))
            .filter(|s| s.is_finite())
            .unwrap_or(0.0);
        let mut index = LevelIndex {
            starts: Vec::new(),
            low,
            steps_per_unit,
            levels,
        };
        let mut starts = vec![0; index.levels.len() + 1];
        for i in (0..index.levels.len()).rev() {
            starts[index.step(index.levels[i])] = i as u32;
        }
        // A step without a level has that of the step before.
        for i in 1..starts.len() {
            starts[i] = starts[i].max(starts[i - 1]);
        }
        index.starts = starts;
        index
    }

    pub(super) fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// The index of the first level at a height or above.
    pub(super) fn first_from(&self, height: f64) -> usize {
        let mut i = self.starts[self.step(height)] as usize;
        while i < self.levels.len() && self.levels[i] < height {
            i += 1;
        }
        i
    }

    /// The step of a height; monotone. The conversion maps heights below all levels to 0.
    fn step(&self, height: f64) -> usize {
        (((height - self.low) * self.steps_per_unit) as usize).min(self.levels.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_search_finds() {
        let even: Vec<f64> = (0..50).map(|i| 3.0 + 0.1 * f64::from(i)).collect();
        let uneven: Vec<f64> = (0..50).map(|i| f64::from(i).powi(5)).collect();
        let huge = vec![-f64::MAX, 0.0, f64::MAX];
        for levels in [
            vec![],
            vec![2.0],
            vec![1.0, 1.0_f64.next_up()],
            huge,
            even,
            uneven,
        ] {
            let index = LevelIndex::new(levels.clone());
            let between = (-40..1200).map(|i| 0.01 * f64::from(i));
            for height in
                between.chain(levels.iter().flat_map(|l| [l.next_down(), *l, l.next_up()]))
            {
                assert_eq!(
                    index.first_from(height),
                    levels.partition_point(|l| *l < height),
                    "{height} in {levels:?}"
                );
            }
        }
    }
}
