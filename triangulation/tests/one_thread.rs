//! Construction on a pool of one thread, which must not wait for itself.

#![cfg(feature = "parallel")]

use std::sync::mpsc;
use std::time::Duration;

use breakline_triangulation::Delaunay;
use breakline_triangulation::geometry::Plane;
use testkit::random::Random;

/// Many points within squares within squares, each of which is one site on the curve through the
/// one around it.
#[test]
fn dense_ranges_within_dense_ranges() {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .unwrap();
    let mut random = Random(1);
    let mut points: Vec<[f64; 2]> = [1.0, 1e-10, 1e-20, 1e-30].map(|x| [x, x]).into();
    points.extend((0..40_000).map(|_| [random.unit() * 1e-35, random.unit() * 1e-35]));
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let (delaunay, _) = Delaunay::from_points(Plane::new(), &points).unwrap();
        sender.send(delaunay.vertex_count()).unwrap();
    });
    // Not a measure of speed: the alternative is to wait for ever.
    assert_eq!(receiver.recv_timeout(Duration::from_secs(300)), Ok(40_004));
}
