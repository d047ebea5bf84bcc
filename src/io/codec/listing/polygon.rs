use crate::data::{not_finite, orientation};
use crate::error::{Error, Result};
use crate::triangulation::num::Sign;

/// Polygons that are read between two calls of a watch.
pub(crate) const POLYGONS_AT_ONCE: usize = 1 << 16;

/// Divides a polygon into a fan of triangles around one of its corners, and adds them to `faces`.
///
/// The choice of the corner matters: if three corners are collinear, a fan around the wrong one has
/// a triangle without area. Polygons that are triangles are added unchecked;
/// [`Mesh::new`](crate::data::Mesh::new) checks them.
///
/// # Errors
/// If there are fewer than three corners, a corner is not a vertex, a corner of a polygon with four
/// or more has no finite position in plan, or no fan is valid. A valid fan exists for every polygon
/// that is convex in plan, and for some others.
pub(crate) fn add_polygon(
    vertices: &[[f64; 3]],
    corners: &[u32],
    faces: &mut Vec<[u32; 3]>,
) -> Result<()> {
    let count = corners.len();
    if count < 3 {
        return Err(Error::format(format!(
            "a face has {count} corners, expected 3 or more"
        )));
    }
    if let Some(v) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
        return Err(Error::format(format!(
            "a face names vertex {v}, but there are {} vertices",
            vertices.len()
        )));
    }
    if let &[a, b, c] = corners {
        faces.push([a, b, c]);
        return Ok(());
    }
    if count > MAX_CORNERS {
        return Err(Error::limit(format!(
            "a face has {count} corners; at most {MAX_CORNERS} are divided"
        )));
    }
    let lacks_position = |v: &&u32| vertices[**v as usize][..2].iter().any(|c| !c.is_finite());
    if let Some(&v) = corners.iter().find(lacks_position) {
        return Err(not_finite(v as usize, vertices[v as usize]));
    }
    let fan = |start: usize| {
        (1..count - 1).map(move |i| [start, start + i, start + i + 1].map(|k| corners[k % count]))
    };
    let turns = |start: usize, sign: Sign| {
        fan(start).all(|face| orientation(face.map(|v| vertices[v as usize])) == sign)
    };
    let fits = |start: &usize| turns(*start, Sign::Positive) || turns(*start, Sign::Negative);
    let start = (0..count).find(fits).ok_or_else(|| {
        Error::unsupported(format!(
            "a face has {count} corners, and none of them sees all others in plan"
        ))
        .cure("divide the polygons of the mesh into triangles")
    })?;
    faces.extend(fan(start));
    Ok(())
}

/// Limit for the corners of a polygon: trying all fans takes time quadratic in their number.
const MAX_CORNERS: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans_avoid_triangles_without_area() {
        let p = |x: f64, y: f64| [x, y, 0.0];
        let vertices = [
            p(0.0, 0.0),
            p(1.0, 0.0),
            p(2.0, 0.0),
            p(2.0, 2.0),
            p(0.0, 2.0),
            p(1.0, 1.0),
        ];
        let divided = |corners: &[u32]| {
            let mut faces = Vec::new();
            add_polygon(&vertices, corners, &mut faces)
                .map(|()| faces)
                .map_err(|e| e.to_string())
        };
        assert_eq!(divided(&[0, 2, 3, 4]), Ok(vec![[0, 2, 3], [0, 3, 4]]));
        assert_eq!(
            divided(&[0, 1, 2, 3, 4]),
            Ok(vec![[1, 2, 3], [1, 3, 4], [1, 4, 0]])
        );
        assert_eq!(
            divided(&[4, 3, 2, 1, 0]),
            Ok(vec![[4, 3, 2], [4, 2, 1], [4, 1, 0]])
        );
        assert_eq!(divided(&[0, 2, 3, 5]), Ok(vec![[2, 3, 5], [2, 5, 0]]));
        assert_eq!(
            divided(&[0, 1]),
            Err("a face has 2 corners, expected 3 or more".into())
        );
        assert_eq!(
            divided(&[0, 1, 2, 9]),
            Err("a face names vertex 9, but there are 6 vertices".into())
        );
    }

    #[test]
    fn refuses_corners_without_position() {
        let square = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for (corner, axis) in (0..4).flat_map(|corner| [(corner, 0), (corner, 1)]) {
                let mut vertices = square;
                vertices[corner][axis] = odd;
                let error = add_polygon(&vertices, &[0, 1, 2, 3], &mut Vec::new())
                    .unwrap_err()
                    .to_string();
                let [x, y, z] = vertices[corner];
                assert_eq!(
                    error,
                    format!("vertex {corner} is at {x} {y} {z}, expected finite coordinates")
                );
            }
            // The height does not affect how a polygon is divided.
            let mut vertices = square;
            vertices[2][2] = odd;
            let mut faces = Vec::new();
            assert!(add_polygon(&vertices, &[0, 1, 2, 3], &mut faces).is_ok() && faces.len() == 2);
        }
    }

    #[test]
    fn refuses_what_no_fan_fits() {
        let s_shape = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [1.0, 2.0],
            [1.0, 1.0],
            [0.0, 1.0],
        ];
        let vertices = s_shape.map(|[x, y]| [x, y, 0.0]);
        let error = add_polygon(&vertices, &[0, 1, 2, 3, 4, 5, 6, 7], &mut Vec::new()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a face has 8 corners, and none of them sees all others in plan"
        );
    }
}
