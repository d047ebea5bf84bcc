mod parts;
mod scenes;
mod tiles;

use std::sync::atomic::AtomicBool;

use super::*;

/// Numbers that look random, the same in each run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % u64::from(limit)) as u32
    }

    /// Between 0 and 1.
    fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 20)) / f64::from(1 << 20)
    }
}

fn classes(points: &[[f64; 3]], options: &GroundOptions) -> Vec<PointClass> {
    classify(points, options, &AtomicBool::new(false)).unwrap()
}
