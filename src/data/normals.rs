/// Returns the unit normal of each of `count` vertices: the mean of those of its faces, weighted by
/// their areas. Each face is given by its corners and their positions; a vertex without a face has
/// the z axis.
///
/// # Complexity
/// Linear.
pub(crate) fn vertex_normals(
    count: usize,
    faces: impl Iterator<Item = ([u32; 3], [[f64; 3]; 3])>,
) -> Vec<[f64; 3]> {
    let mut normals = vec![[0.0; 3]; count];
    for (face, [a, b, c]) in faces {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let turn = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            u[i] * v[j] - u[j] * v[i]
        };
        for vertex in face {
            let normal: &mut [f64; 3] = &mut normals[vertex as usize];
            (0..3).for_each(|k| normal[k] += turn(k));
        }
    }
    for normal in &mut normals {
        *normal = unit(*normal).unwrap_or([0.0, 0.0, 1.0]);
    }
    normals
}

/// Returns a vector of length 1; `None` if it has no direction.
pub(crate) fn unit(p: [f64; 3]) -> Option<[f64; 3]> {
    let length = p.iter().map(|c| c * c).sum::<f64>().sqrt();
    length.is_normal().then(|| p.map(|c| c / length))
}
