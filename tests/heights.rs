//! Heights of a surface at any position.

use breakline::terrain::TinBuilder;

/// A position that is not finite has no height; one below the range of the arithmetic counts as
/// zero.
#[test]
fn heights_are_told_where_there_is_a_surface_only() {
    let mut builder = TinBuilder::default();
    builder.add_points(&[-1.0, 1.0, 0.0], &[-1.0, -1.0, 1.0], &[3.0, 3.0, 3.0]);
    let tin = builder.build().unwrap();
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200, -f64::MAX] {
        for [x, y] in [[odd, 0.0], [0.0, odd], [odd, odd], [odd, 1e-300]] {
            assert_eq!(tin.elevation(x, y), None, "{x} {y}");
        }
    }
    for tiny in [0.0, 1e-200, -1e-300, 5e-324] {
        assert_eq!(tin.elevation(tiny, -tiny), Some(3.0));
    }
}
