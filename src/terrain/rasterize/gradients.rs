//! The gradients of the faces of a surface, in cells.

use super::draw;
use super::face_index::FaceIndex;
use super::placement::Placement;
use super::value::CellValue;
use crate::crs::Crs;
use crate::data::{Frame, Surface, Window};
use crate::error::Result;

/// A source of the gradients of a surface in any block of a raster, as
/// [`BlockSource`](crate::data::BlockSource) is one of numbers.
pub trait GradientSource: Sync {
    /// The size and georeference of the whole raster.
    fn frame(&self) -> Frame;

    /// Coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;

    /// Fills `out` with the rise per unit of x and of y in each cell of a window, row by row; NaN
    /// where there is no surface.
    ///
    /// # Errors
    /// Only if the source reads from something that can fail.
    fn gradients(&self, window: Window, out: &mut [[f64; 2]]) -> Result<()>;
}

impl<S: GradientSource + ?Sized> GradientSource for Box<S> {
    fn frame(&self) -> Frame {
        (**self).frame()
    }

    fn crs(&self) -> Option<&Crs> {
        (**self).crs()
    }

    fn gradients(&self, window: Window, out: &mut [[f64; 2]]) -> Result<()> {
        (**self).gradients(window, out)
    }
}

/// A raster of the gradients of the faces at the centers of the cells.
///
/// A gradient is that of a [`Sample`](crate::terrain::Sample) at the center: on an edge or a
/// vertex, that of the steepest face around. A cell whose center lies on the rim of the surface
/// belongs to it. Values depend on the surface alone: not on the requested block, nor on the
/// numbering of vertices and faces.
#[derive(Debug)]
pub struct GradientMap<'a, S: ?Sized> {
    surface: &'a S,
    frame: Frame,
    placement: Placement,
    index: FaceIndex,
}

impl<'a, S: Surface + ?Sized> GradientMap<'a, S> {
    /// Prepares the raster.
    ///
    /// # Errors
    /// Those of [`Frame::checked`].
    ///
    /// # Complexity
    /// Linear in the faces, on all threads, with up to about 6 bytes for each.
    pub fn new(surface: &'a S, frame: Frame) -> Result<Self> {
        let frame = frame.checked()?;
        let placement = Placement::new(&frame);
        let index = FaceIndex::new(surface, &placement, frame.window());
        Ok(GradientMap {
            surface,
            frame,
            placement,
            index,
        })
    }
}

impl<S: Surface + ?Sized> GradientSource for GradientMap<'_, S> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.surface.crs()
    }

    fn gradients(&self, window: Window, out: &mut [[f64; 2]]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        out.fill(CellValue::NONE);
        let mut ink = CellValue::ink(out);
        draw(self.surface, &self.index, &self.placement, window, &mut ink);
        self.surface.ensure_intact()
    }
}
