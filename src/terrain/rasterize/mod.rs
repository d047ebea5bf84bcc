mod bins;
mod canvas;
mod face_index;
mod of_parts;
mod placement;
mod scan;

pub use canvas::{Canvas, CanvasBlock};
use face_index::FaceIndex;
pub use of_parts::DemOfParts;
use placement::{Centers, Placement};
use scan::{Heights, Ink, Number, Scan};

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
    index: FaceIndex,
    /// Unless heights are linear.
    interpolant: Option<Interpolant<'a, S>>,
}

/// A cell whose center is in no face.
const NO_FACE: u32 = u32::MAX;

impl<'a, S: Surface + ?Sized> Dem<'a, S> {
    /// Prepares the raster by a spatial index of the faces. No cell is computed yet.
    ///
    /// # Errors
    /// Those of [`Frame::checked`].
    ///
    /// # Complexity
    /// Linear in the faces; the index takes up to about 6 bytes per face.
    pub fn new(surface: &'a S, frame: Frame) -> Result<Self> {
        let frame = frame.checked()?;
        let placement = Placement::new(&frame);
        let all = Window {
            column: 0,
            row: 0,
            width: frame.width,
            height: frame.height,
        };
        let index = FaceIndex::new(surface, &placement, all);
        Ok(Dem {
            surface,
            frame,
            placement,
            index,
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
    fn draw<T, I: Ink<T>>(&self, window: Window, cells: &mut [T], ink: impl Fn(u32) -> I) {
        draw(
            self.surface,
            &self.index,
            &self.placement,
            window,
            cells,
            ink,
        );
    }

    /// Computes the heights of a window: finds the face of each cell, then goes from cell to cell.
    fn interpolate(&self, interpolant: &Interpolant<S>, window: Window, out: &mut [f32]) {
        let mut faces = vec![NO_FACE; out.len()];
        self.draw(window, &mut faces, Number);
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

/// Draws the faces of a surface that meet a window into its cells.
fn draw<T, I: Ink<T>, S: Surface + ?Sized>(
    surface: &S,
    index: &FaceIndex,
    placement: &Placement,
    window: Window,
    cells: &mut [T],
    ink: impl Fn(u32) -> I,
) {
    let Window {
        column,
        row,
        width,
        height,
    } = window;
    let columns = Centers::new(placement.columns, column, width);
    let rows = Centers::new(placement.rows, row, height);
    let mut scan = Scan {
        columns: &columns,
        rows: &rows,
        cells,
    };
    for (faces, rows, columns) in index.bins_in(row..row + height, column..column + width) {
        let rows = rows.start - row..rows.end - row;
        let columns = columns.start - column..columns.end - column;
        for &face in faces {
            let Some(corners) = surface.triangle(face) else {
                continue;
            };
            let corners = corners.map(|p| placement.to_plane(p));
            scan.draw(corners, &rows, &columns, &ink(face));
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
        match &self.interpolant {
            None => self.draw(window, out, |_| Heights),
            Some(interpolant) => self.interpolate(interpolant, window, out),
        }
        self.surface.ensure_intact()
    }
}
