//! Centers of triangles, judged by rational numbers.

use dashu_ratio::RBig;

fn exact(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

/// Asserts that a center, relative to the first of three weighted corners, is correct to within
/// 2^-40 of its distance; flat triangles have none.
pub(crate) fn judge(corners: [[f64; 3]; 3], center: [f64; 2]) {
    let [a, b, c] = corners.map(|p| p.map(exact));
    let [u, v] = [&b, &c].map(|p| [&p[0] - &a[0], &p[1] - &a[1]]);
    let area = (&u[0] * &v[1] - &u[1] * &v[0]) * RBig::from(2);
    if area == RBig::ZERO {
        return;
    }
    let lift = |[x, y]: &[RBig; 2], p: &[RBig; 3]| x * x + y * y - &p[2] + &a[2];
    let [lu, lv] = [lift(&u, &b), lift(&v, &c)];
    let expected = [
        (&lu * &v[1] - &lv * &u[1]) / &area,
        (&lv * &u[0] - &lu * &v[0]) / &area,
    ];
    let center = center.map(exact);
    let squared = |p: [RBig; 2]| &p[0] * &p[0] + &p[1] * &p[1];
    let error = squared([&center[0] - &expected[0], &center[1] - &expected[1]]);
    assert!(
        error * exact(2f64.powi(80)) <= squared(expected),
        "{corners:?}"
    );
}
