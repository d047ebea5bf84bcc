use super::TinReport;
use crate::crs::Crs;
use crate::data::Surface;

/// A surface of triangles over points and breaklines.
#[derive(Debug)]
pub struct Tin {
    pub(super) report: TinReport,
    pub(super) crs: Option<Crs>,
}

impl Tin {
    /// What went in and what became of it.
    pub fn report(&self) -> &TinReport {
        &self.report
    }
}

impl Surface for Tin {
    fn vertex_count(&self) -> usize {
        0
    }

    fn position(&self, _vertex: u32) -> [f64; 3] {
        [0.0; 3]
    }

    fn face_count(&self) -> usize {
        0
    }

    fn face(&self, _face: u32) -> Option<[u32; 3]> {
        None
    }

    fn neighbor(&self, _face: u32, _i: usize) -> Option<u32> {
        None
    }

    fn is_constrained(&self, _face: u32, _i: usize) -> bool {
        false
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }
}
