//! A bumpy field at map coordinates, whose numbers are hard to write.

/// Returns `n` x `n` vertices, row by row.
pub(crate) fn vertices(n: u32) -> Vec<[f64; 3]> {
    let at = |i: u32| {
        let (x, y) = (f64::from(i % n), f64::from(i / n));
        [
            512_000.1 + 1.3 * x,
            5_403_000.7 + y / 3.0,
            250.0 + (x * y / 7.0).sin(),
        ]
    };
    (0..n * n).map(at).collect()
}

/// Returns two faces for each cell between the vertices, except for some: a cell has the number of
/// its first vertex.
pub(crate) fn faces(n: u32, left_out: &[u32]) -> Vec<[u32; 3]> {
    let cells = (0..n * (n - 1)).filter(|i| i % n < n - 1 && !left_out.contains(i));
    cells
        .flat_map(|i| [[i, i + 1, i + n + 1], [i, i + n + 1, i + n]])
        .collect()
}
