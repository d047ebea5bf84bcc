mod bins;
mod canvas;
mod drawing;
mod face_index;
mod gradients;
mod of_parts;
mod placement;
mod scan;
mod value;

pub use canvas::{Canvas, CanvasBlock};
use drawing::Drawing;
use face_index::FaceIndex;
pub use gradients::{GradientMap, GradientSource};
pub use of_parts::DemOfParts;
use placement::{Centers, Placement};
use scan::{Ink, NO_FACE, Numbers, Scan};
pub use value::CellValue;
use value::Heights;

use super::interpolate::{Interpolant, Method, QueryBuffers};
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Surface, Window};
use crate::error::Result;

/// A raster of the heights of a surface, sampled at the centers of the cells.
///
/// Heights are linear on each triangle, or [by another method](Self::with_method), and NaN outside
/// of the surface. A cell whose center lies on
/// the rim of the surface belongs to it. A cell at a vertex has the height of the vertex, one on a
/// breakline that of the breakline. Values depend on the surface alone: not on the requested block,
/// nor on the numbering of vertices and faces (if faces do not overlap).
///
/// The frame may be south-up, rotated, larger than the surface, or cover a part of it.
#[derive(Debug)]
pub struct Dem<'a, S: ?Sized> {
    surface: &'a S,
    frame: Frame,
    placement: Placement,
    faces: Faces,
    /// Unless heights are linear.
    interpolant: Option<Interpolant<'a, S>>,
}

/// How the face of a cell is found.
#[derive(Debug)]
enum Faces {
    /// All cells were drawn: there are few for each face.
    Drawn(Drawing),
    /// Windows are drawn on demand.
    Indexed(FaceIndex),
}

impl<'a, S: Surface + ?Sized> Dem<'a, S> {
    /// Prepares the raster. If it has at most two cells for each face, all of them are drawn now.
    /// Otherwise the faces are indexed by their positions, and cells are drawn when they are asked
    /// for.
    ///
    /// # Errors
    /// Those of [`Frame::checked`].
    ///
    /// # Complexity
    /// Linear in the faces, on all threads; cells take 8 bytes each, the index up to about 6 per
    /// face.
    pub fn new(surface: &'a S, frame: Frame) -> Result<Self> {
        let frame = frame.checked()?;
        let placement = Placement::new(&frame);
        let faces = match Drawing::new(surface, &placement, &frame) {
            Some(drawing) => Faces::Drawn(drawing),
            None => Faces::Indexed(FaceIndex::new(surface, &placement, frame.window())),
        };
        Ok(Dem {
            surface,
            frame,
            placement,
            faces,
            interpolant: None,
        })
    }

    /// Chooses how heights between the vertices are computed.
    ///
    /// # Errors
    /// Those of [`Interpolant::new`].
    ///
    /// # Complexity
    /// That of [`Interpolant::new`].
    pub fn with_method(mut self, method: Method) -> Result<Self> {
        self.interpolant = match method {
            Method::Linear => None,
            _ => Some(Interpolant::new(self.surface, method)?),
        };
        Ok(self)
    }

    /// Draws the faces that meet a window into its cells.
    fn draw(&self, index: &FaceIndex, window: Window, ink: &mut impl Ink) {
        draw(self.surface, index, &self.placement, window, ink);
    }

    /// Returns the face of each cell of a window.
    fn faces_in(&self, window: Window) -> Vec<u32> {
        let mut cells = vec![NO_FACE; window.width * window.height];
        match &self.faces {
            Faces::Drawn(drawing) => drawing.faces(window, &mut cells),
            Faces::Indexed(index) => {
                let cells = &mut cells;
                self.draw(index, window, &mut Numbers { cells, face: 0 });
            }
        }
        cells
    }

    /// Computes the heights of a window: finds the face of each cell, then goes from cell to cell.
    fn interpolate(&self, interpolant: &Interpolant<S>, window: Window, out: &mut [f32]) {
        let faces = self.faces_in(window);
        let mut scratch = QueryBuffers::default();
        let center = self.frame.centers();
        let cells = out
            .iter_mut()
            .zip(faces)
            .enumerate()
            .filter(|(_, (_, face))| *face != NO_FACE);
        for (i, (height, face)) in cells {
            let q = center(
                window.column + i % window.width,
                window.row + i / window.width,
            );
            *height = interpolant.height_in(face, q, &mut scratch) as f32;
        }
    }
}

/// Returns the height of a triangle at a position, bit for bit that of a cell of a north-up raster
/// there before it is rounded to 32 bits; `None` outside.
///
/// The position must be finite.
pub(super) fn height_at(corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> Option<f64> {
    // In the plane of the scan, in which the rows of such a raster ascend.
    scan::height_at(corners.map(|[x, y, z]| [x, -y, z]), [x, -y])
}

/// Draws the faces of a surface that meet a window into its cells.
fn draw<S: Surface + ?Sized>(
    surface: &S,
    index: &FaceIndex,
    placement: &Placement,
    window: Window,
    ink: &mut impl Ink,
) {
    let Window {
        column,
        row,
        width,
        height,
    } = window;
    let columns = Centers::new(placement.columns, column, width);
    let rows = Centers::new(placement.rows, row, height);
    let scan = Scan {
        columns: &columns,
        rows: &rows,
    };
    for (faces, rows, columns) in index.bins_in(row..row + height, column..column + width) {
        let rows = rows.start - row..rows.end - row;
        let columns = columns.start - column..columns.end - column;
        for &face in faces {
            let Some(corners) = surface.triangle(face) else {
                continue;
            };
            ink.of_face(face, &corners);
            scan.draw(corners.map(|p| placement.to_plane(p)), &rows, &columns, ink);
        }
    }
}

impl<S: Surface + ?Sized> BlockSource for Dem<'_, S> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.surface.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        out.fill(f32::NAN);
        match (&self.interpolant, &self.faces) {
            (None, Faces::Drawn(drawing)) => drawing.heights(window, out),
            (None, Faces::Indexed(index)) => self.draw(index, window, &mut Heights(out)),
            (Some(interpolant), _) => self.interpolate(interpolant, window, out),
        }
        self.surface.ensure_intact()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;
    use crate::terrain::TinBuilder;
    use testkit::random::Random;

    /// Points on centers of cells and beside them.
    fn points(random: &mut Random, count: usize, size: f64) -> Vec<[f64; 3]> {
        (0..count)
            .map(|_| [0, 1, 2].map(|_| (random.unit() * size * 4.0).round() / 4.0))
            .collect()
    }

    fn assert_drawn_as_indexed(surface: &dyn Surface, frame: Frame, method: Method) {
        let drawn = Dem::new(surface, frame).unwrap();
        assert!(matches!(drawn.faces, Faces::Drawn(_)));
        let placement = Placement::new(&frame);
        let index = FaceIndex::new(surface, &placement, frame.window());
        let indexed = Dem {
            faces: Faces::Indexed(index),
            ..Dem::new(surface, frame).unwrap()
        };
        let [drawn, indexed] = [drawn, indexed].map(|dem| dem.with_method(method).unwrap());
        for window in [
            frame.window(),
            Window {
                column: 3,
                row: 5,
                width: 1,
                height: 7,
            },
        ] {
            let [mut found, mut expected] = [0, 1].map(|_| vec![0.0; window.width * window.height]);
            drawn.fill(window, &mut found).unwrap();
            indexed.fill(window, &mut expected).unwrap();
            assert!(expected.iter().any(|z| !z.is_nan()));
            let bits = |cells: &[f32]| cells.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
            assert!(bits(&found) == bits(&expected), "{window:?} {method:?}");
        }
    }

    #[test]
    fn cells_that_are_drawn_at_once_are_those_of_windows() {
        let mut random = Random(76);
        for transform in [
            [-1.0, 1.0, 0.0, 41.0, 0.0, -1.0],
            [40.0, -0.7, 0.0, 3.0, 0.0, 0.7],
            [20.0, 0.6, -0.8, 0.0, 0.8, 0.6],
        ] {
            let frame = Frame {
                width: 45,
                height: 40,
                transform,
            };
            for method in [Method::Linear, Method::Nearest] {
                let mut builder = TinBuilder::default();
                builder.add_owned_points(points(&mut random, 900, 40.0));
                assert_drawn_as_indexed(&builder.build().unwrap(), frame, method);
            }
        }
    }

    #[test]
    fn where_faces_overlap_the_last_one_counts_on_any_number_of_threads() {
        let mut random = Random(77);
        let vertices = (0..30_000)
            .map(|_| [0, 1, 2].map(|_| random.unit() * 40.0))
            .collect();
        let faces = (0..10_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Mesh::new(vertices, faces, &[], None).unwrap();
        let frame = Frame::north_up(-1.0, 41.0, 1.0, 45, 45);
        for threads in 1..4 {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| assert_drawn_as_indexed(&mesh, frame, Method::Linear));
        }
    }
}
