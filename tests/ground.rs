//! The ground of real samples, with reference labels.

use std::sync::atomic::AtomicBool;

use breakline::data::PointBatch;
use breakline::terrain::ground::{GroundOptions, PointClass, classify};

/// The total error of a sample, in percent.
fn error(path: &str) -> f64 {
    let mut source = breakline::io::points::open(testkit::shared(path)).unwrap();
    let (mut points, mut is_ground) = (Vec::new(), Vec::new());
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch).unwrap();
        if batch.is_empty() {
            break;
        }
        points.extend((0..batch.len()).map(|at| [batch.x[at], batch.y[at], batch.z[at]]));
        is_ground.extend(batch.class.iter().map(|&class| class == 2));
    }
    let found = classify(&points, &GroundOptions::default(), &AtomicBool::new(false)).unwrap();
    let wrong = found
        .iter()
        .zip(&is_ground)
        .filter(|(found, is_ground)| (**found == PointClass::Ground) != **is_ground);
    100.0 * wrong.count() as f64 / points.len() as f64
}

/// By `examples/isprs`, on the day this was written, the mean was 2.85.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn the_mean_error_of_the_filter_test_is_below_three_percent() {
    let samples = [11, 12, 21, 22, 23, 31, 41, 42];
    let errors = samples.map(|sample| error(&format!("lidar/isprs_filtertest/samp{sample}.laz")));
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(mean < 3.0, "{mean}: {errors:?}");
    assert!(errors.iter().all(|&error| error < 7.5), "{errors:?}");
}
