//! A surface as lists of exact numbers.

use breakline::data::Surface;
use dashu_ratio::RBig;

pub(crate) type Exact = [RBig; 3];

/// The faces of a surface.
pub(crate) struct Found {
    pub(crate) vertices: Vec<Option<Exact>>,
    pub(crate) faces: Vec<[usize; 3]>,
    /// Sides without a face beyond, counter-clockwise.
    pub(crate) rim: Vec<[usize; 2]>,
}

pub(crate) fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("coordinates are finite")
}

/// Twice the area of a triangle in plan, positive if it is counter-clockwise.
pub(crate) fn turn(a: &[RBig], b: &[RBig], c: &[RBig]) -> RBig {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

impl Found {
    /// # Errors
    /// If neighbors disagree.
    pub(crate) fn new(surface: &dyn Surface) -> Result<Self, String> {
        let mut vertices = vec![None; surface.vertex_count()];
        let (mut faces, mut rim) = (Vec::new(), Vec::new());
        for face in 0..surface.face_count() as u32 {
            let Some(corners) = surface.face(face) else {
                continue;
            };
            faces.push(corners.map(|v| v as usize));
            for (i, v) in corners.into_iter().enumerate() {
                let position = surface.position(v);
                if !position.iter().all(|x| x.is_finite()) {
                    return Err(format!("vertex {v} is at {position:?}"));
                }
                vertices[v as usize].get_or_insert_with(|| position.map(exact));
                let ends = |face: [u32; 3], i: usize| {
                    [face[(i + 1) % 3] as usize, face[(i + 2) % 3] as usize]
                };
                let [from, to] = ends(corners, i);
                let Some(beyond) = surface.neighbor(face, i) else {
                    rim.push([from, to]);
                    continue;
                };
                let theirs = surface
                    .face(beyond)
                    .ok_or(format!("face {beyond}, beside {face}, is none"))?;
                let is_same = |&k: &usize| {
                    ends(theirs, k) == [to, from] && surface.neighbor(beyond, k) == Some(face)
                };
                if !(0..3).any(|k| is_same(&k)) {
                    return Err(format!("faces {face} and {beyond} do not share a side"));
                }
            }
        }
        Ok(Found {
            vertices,
            faces,
            rim,
        })
    }

    pub(crate) fn at(&self, vertex: usize) -> &Exact {
        self.vertices[vertex]
            .as_ref()
            .expect("vertices of faces are known")
    }

    pub(crate) fn corners(&self, face: [usize; 3]) -> [&Exact; 3] {
        face.map(|vertex| self.at(vertex))
    }
}
