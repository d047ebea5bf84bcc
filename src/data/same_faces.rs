//! What surfaces have in common that change something else of another one than its faces.

/// Implements the methods of a [`Surface`](crate::data::Surface) that return the faces of another
/// one, which is in a field.
///
/// [`corners_in`](crate::data::Surface::corners_in) is among them: by it, a reader notices that a
/// run is canceled.
macro_rules! same_faces {
    ($field:tt) => {
        fn vertex_count(&self) -> usize {
            self.$field.vertex_count()
        }

        fn face_count(&self) -> usize {
            self.$field.face_count()
        }

        fn face(&self, face: u32) -> Option<[u32; 3]> {
            self.$field.face(face)
        }

        fn corners_in(&self, numbers: std::ops::Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
            self.$field.corners_in(numbers, faces);
        }

        fn crs(&self) -> Option<&crate::crs::Crs> {
            self.$field.crs()
        }

        fn ensure_intact(&self) -> crate::error::Result<()> {
            self.$field.ensure_intact()
        }
    };
}

pub(crate) use same_faces;
