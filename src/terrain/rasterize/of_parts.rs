//! The heights or gradients of a surface in parts, which are opened where they are needed.

use std::sync::{Arc, Mutex, PoisonError};

use super::draw;
use super::face_index::FaceIndex;
use super::gradients::GradientSource;
use super::placement::Placement;
use super::value::CellValue;
use crate::crs::Crs;
use crate::data::{BlockSource, Bounds, Frame, Surface, Window};
use crate::error::Result;

/// Parts that stay open, the last ones that were used.
const MOST_OPEN: usize = 32;

/// A raster of the heights of a surface in parts, or of the gradients of its faces: that of
/// [`Dem`](super::Dem) or [`GradientMap`](super::GradientMap) for the whole, bit for bit.
///
/// Memory is needed for the parts that a few windows meet.
pub struct DemOfParts<'a, S> {
    frame: Frame,
    placement: Placement,
    crs: Option<Crs>,
    /// The cells whose centers each part may contain.
    windows: Vec<Option<Window>>,
    open: &'a (dyn Fn(usize) -> Result<S> + Sync),
    /// The last one was used last.
    recent: Mutex<Vec<(usize, Arc<Opened<S>>)>>,
}

/// A part, with the faces that its windows meet.
struct Opened<S> {
    surface: S,
    index: FaceIndex,
}

impl<'a, S: Surface> DemOfParts<'a, S> {
    /// Prepares the raster. `extents` are the boxes around the parts, which `open` opens by their
    /// positions; it may be called several times for the same one.
    ///
    /// # Errors
    /// Those of [`Frame::checked`].
    ///
    /// # Complexity
    /// Linear in the parts. Opening one takes time linear in its faces, and 4 bytes for each face
    /// that has a cell; up to 32 stay open.
    pub fn new(
        frame: Frame,
        crs: Option<Crs>,
        extents: &[Bounds],
        open: &'a (dyn Fn(usize) -> Result<S> + Sync),
    ) -> Result<Self> {
        let frame = frame.checked()?;
        let placement = Placement::new(&frame);
        let windows = extents
            .iter()
            .map(|extent| window_of(extent, &placement))
            .collect();
        Ok(DemOfParts {
            frame,
            placement,
            crs,
            windows,
            open,
            recent: Mutex::default(),
        })
    }

    fn opened(&self, part: usize, window: Window) -> Result<Arc<Opened<S>>> {
        let lock = || self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        let mut recent = lock();
        if let Some(at) = recent.iter().position(|(number, _)| *number == part) {
            let found = recent.remove(at);
            let opened = Arc::clone(&found.1);
            recent.push(found);
            return Ok(opened);
        }
        drop(recent);
        // Two threads may open the same part; others need not wait for it.
        let surface = (self.open)(part)?;
        let index = FaceIndex::new(&surface, &self.placement, window);
        let opened = Arc::new(Opened { surface, index });
        let mut recent = lock();
        if recent.len() >= MOST_OPEN {
            recent.remove(0);
        }
        recent.push((part, Arc::clone(&opened)));
        Ok(opened)
    }
}

/// Returns the window of the cells whose centers a part may contain; `None` if there are none.
fn window_of(extent: &Bounds, placement: &Placement) -> Option<Window> {
    if extent.is_empty() {
        return None;
    }
    let Bounds {
        min: [x0, y0, _],
        max: [x1, y1, _],
    } = *extent;
    let corners =
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| placement.to_plane([x, y, 0.0]));
    let cells = |k: usize| {
        let axis = if k == 0 {
            placement.columns
        } else {
            placement.rows
        };
        let along = corners.map(|corner| corner[k]);
        let (low, high) = along
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &c| {
                (l.min(c), h.max(c))
            });
        let cells = axis.cells(low, high);
        // One more cell on both sides: the box is rounded where the raster is rotated.
        (!cells.is_empty()).then(|| cells.start.saturating_sub(1)..(cells.end + 1).min(axis.count))
    };
    let (columns, rows) = (cells(0)?, cells(1)?);
    Some(Window {
        column: columns.start,
        row: rows.start,
        width: columns.len(),
        height: rows.len(),
    })
}

impl<S: Surface + Send> BlockSource for DemOfParts<'_, S> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.values(window, out)
    }
}

impl<S: Surface + Send> GradientSource for DemOfParts<'_, S> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn gradients(&self, window: Window, out: &mut [[f64; 2]]) -> Result<()> {
        self.values(window, out)
    }
}

impl<S: Surface + Send> DemOfParts<'_, S> {
    fn values<V: CellValue>(&self, window: Window, out: &mut [V]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        out.fill(V::NONE);
        let meet = |of_part: &Window| {
            of_part.column < window.column + window.width
                && window.column < of_part.column + of_part.width
                && of_part.row < window.row + window.height
                && window.row < of_part.row + of_part.height
        };
        for (part, of_part) in self.windows.iter().enumerate() {
            let Some(of_part) = of_part.filter(meet) else {
                continue;
            };
            let opened = self.opened(part, of_part)?;
            draw(
                &opened.surface,
                &opened.index,
                &self.placement,
                window,
                &mut V::ink(out),
            );
            opened.surface.ensure_intact()?;
        }
        Ok(())
    }
}
