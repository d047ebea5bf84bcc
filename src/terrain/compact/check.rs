use super::layout::{OpenSide, SIDE};
use super::{CompactTin, Damage, Found};
use crate::data::{Surface, SurfaceFacts};
use crate::error::Result;
use crate::triangulation::Level;

impl<B: AsRef<[u8]> + Sync> CompactTin<B> {
    /// Checks all bytes: that the triangulation is one and satisfies the constrained Delaunay law,
    /// that all faces, links and vertices are possible, and that the counts and the extent are
    /// those of the faces. The shape of fragments is not checked; see
    /// [`surface_flaws`](crate::terrain::surface_flaws).
    ///
    /// # Errors
    /// The first damage that is found.
    ///
    /// # Complexity
    /// Linear.
    pub fn check(&self) -> Result<()> {
        self.find_damage().map_err(|damage| self.error(&damage))?;
        let counted = SurfaceFacts::of(self);
        self.ensure_intact()?;
        if counted == *self.facts() {
            Ok(())
        } else {
            Err(self.error(&Damage::Facts))
        }
    }

    fn find_damage(&self) -> Found<()> {
        self.triangulation.check(Level::Law)?;
        for vertex in 0..self.vertex_numbers() as u32 {
            self.point(vertex)?;
        }
        for face in 0..self.face_numbers() as u32 {
            if self.corners(face)?.is_some() {
                for i in 0..3 {
                    self.linked_neighbor(face, i)?;
                    self.kind(face, i)?;
                }
            }
        }
        let rows = self
            .triangulation
            .bytes()
            .get(self.sides.clone())
            .unwrap_or_default()
            .as_chunks::<SIDE>()
            .0;
        let key = |row: usize| rows.get(row).map(OpenSide::key);
        match (1..rows.len()).find(|&row| key(row - 1) >= key(row)) {
            Some(row) => Err(Damage::Side(row)),
            None => Ok(()),
        }
    }
}
