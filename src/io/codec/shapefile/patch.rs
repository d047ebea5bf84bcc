//! The faces of multipatches, which are strips, fans and rings in space.

type Ring = Vec<[f64; 3]>;

// Part types (ESRI Shapefile Technical Description, 1998, page 20).
const STRIP: i32 = 0;
const FAN: i32 = 1;
const OUTER: i32 = 2;
const INNER: i32 = 3;
const FIRST: i32 = 4;
const RING: i32 = 5;

/// The content of a multipatch.
#[derive(Debug, Default)]
pub(super) struct Patch {
    /// Its faces, each with its rings: the triangles of strips and fans, and outer rings with the
    /// inner rings that follow them.
    pub(super) faces: Vec<Vec<Ring>>,
    /// Rings that were not closed and have been closed.
    pub(super) unclosed: usize,
    /// Parts whose type is none of the format's, which are dropped.
    pub(super) unknown: usize,
}

/// Returns the faces of the parts of a multipatch.
pub(super) fn assemble(parts: Vec<Ring>, kinds: &[i32]) -> Patch {
    let Patch {
        mut faces,
        mut unclosed,
        mut unknown,
    } = Patch::default();
    // The kind of the parts that are holes of the last face.
    let mut hole = None;
    for (part, &kind) in parts.into_iter().zip(kinds) {
        let is_hole = hole == Some(kind);
        match kind {
            // Every second triangle of a strip is reversed, so that all have the same orientation.
            STRIP => faces.extend(part.windows(3).enumerate().map(|(n, w)| match n % 2 {
                0 => triangle(w[0], w[1], w[2]),
                _ => triangle(w[1], w[0], w[2]),
            })),
            FAN => faces.extend(
                part.windows(2)
                    .skip(1)
                    .map(|w| triangle(part[0], w[0], w[1])),
            ),
            OUTER | INNER | FIRST | RING => {
                let ring = closed(part, &mut unclosed);
                match faces.last_mut().filter(|_| is_hole) {
                    Some(face) => face.push(ring),
                    None => faces.push(vec![ring]),
                }
            }
            _ => unknown += 1,
        }
        hole = match kind {
            OUTER => Some(INNER),
            FIRST => Some(RING),
            _ => hole.filter(|_| is_hole),
        };
    }
    Patch {
        faces,
        unclosed,
        unknown,
    }
}

fn triangle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Vec<Ring> {
    vec![vec![a, b, c, a]]
}

/// Returns a ring that ends where it begins. Unlike those of polygons, rings may be vertical: ends
/// that differ in height alone are not the same.
fn closed(mut ring: Ring, unclosed: &mut usize) -> Ring {
    if let (Some(&first), Some(&last)) = (ring.first(), ring.last())
        && first != last
    {
        *unclosed += 1;
        ring.push(first);
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(parts: &[Ring], kinds: &[i32]) -> Vec<Vec<Ring>> {
        let Patch {
            faces,
            unclosed,
            unknown,
        } = assemble(parts.to_vec(), kinds);
        assert_eq!((unclosed, unknown), (0, 0));
        faces
    }

    fn square(from: f64, to: f64, z: f64) -> Ring {
        vec![
            [from, from, z],
            [to, from, z],
            [to, to, z],
            [from, to, z],
            [from, from, z],
        ]
    }

    #[test]
    fn strips_and_fans_are_triangles_of_one_side() {
        let corners = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]];
        let strip = run(&[corners], &[STRIP]);
        assert_eq!(
            strip[1],
            [[[0., 1., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]]
        );
        let mut around = square(0., 2., 0.);
        around.pop();
        let fan = run(&[around.clone()], &[FAN]);
        let [a, b, c, d] = around[..] else {
            panic!("{around:?}")
        };
        assert_eq!(fan, [[[a, b, c, a]], [[a, c, d, a]]]);
        assert!(run(&[vec![[1.; 3]], vec![[1.; 3]]], &[STRIP, FAN]).is_empty());
    }

    #[test]
    fn inner_rings_belong_to_the_face_before_them() {
        let [a, b, c] = [(0., 10.), (1., 2.), (4., 5.)].map(|(from, to)| square(from, to, 3.));
        let all = [a.clone(), b.clone(), c.clone()];
        assert_eq!(run(&all, &[OUTER, INNER, INNER]), [all.to_vec()]);
        assert_eq!(run(&all, &[FIRST, RING, RING]), [all.to_vec()]);
        assert_eq!(
            run(&all, &[OUTER, INNER, OUTER]),
            [vec![a.clone(), b.clone()], vec![c.clone()]]
        );
        for kinds in [
            [RING, RING, RING],
            [INNER, INNER, INNER],
            [OUTER, RING, INNER],
            [FIRST, INNER, RING],
        ] {
            assert_eq!(
                run(&all, &kinds),
                [vec![a.clone()], vec![b.clone()], vec![c.clone()]],
                "{kinds:?}"
            );
        }
    }

    #[test]
    fn rings_are_closed_also_vertical_ones() {
        let wall = vec![[7., 0., 0.], [7., 3., 0.], [7., 3., 2.], [7., 0., 2.]];
        let Patch {
            faces,
            unclosed,
            unknown,
        } = assemble(vec![wall.clone(), wall], &[FIRST, 9]);
        assert_eq!((faces.len(), unclosed, unknown), (1, 1, 1));
        assert_eq!((faces[0][0].len(), faces[0][0][4]), (5, [7., 0., 0.]));
    }
}
