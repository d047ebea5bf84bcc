//! The methods that are the same in all surfaces that have the faces of another one.

/// Implements the methods by which a [`Surface`](crate::data::Surface) has the faces of the one in
/// a field.
///
/// [`corners_in`](crate::data::Surface::corners_in) must be among them: its default would ask for
/// single faces, and not notice that a run is canceled.
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
