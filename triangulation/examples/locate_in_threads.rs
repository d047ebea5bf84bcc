//! Locates a million points from four threads.

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::{Delaunay, Location};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sites =
        |n: u32, step: f64| (0..n * n).map(move |k| [k % n, k / n].map(|i| f64::from(i) * step));
    let corners: Vec<[f64; 2]> = sites(100, 1.0).collect();
    let (t, _) = Delaunay::from_points(Plane::new(), &corners)?;
    let queries: Vec<[f64; 2]> = sites(1000, 0.099).collect();
    let locate = |some: &[[f64; 2]]| {
        let (mut near, mut inside) = (None, 0);
        for q in some {
            let Location::Cell { cell, .. } = t.locate(q, near) else {
                continue;
            };
            (near, inside) = (Some(cell), inside + 1); // the next one is not far
        }
        inside
    };
    let inside: usize = std::thread::scope(|scope| {
        let threads: Vec<_> = queries
            .chunks(250_000)
            .map(|some| scope.spawn(move || locate(some)))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().expect("queries do not panic"))
            .sum()
    });
    assert_eq!(inside, 999_999, "all but the one on a vertex");
    Ok(())
}
