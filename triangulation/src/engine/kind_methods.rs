//! Methods that all kinds have, word for word.
//!
//! Each kind expands them in its own `impl` blocks, whose bounds then hold, so that users call them
//! without importing a trait and find them in the documentation of the kind. A kind has functions
//! `over`, which adds its law to a [`Triangulation`](crate::Triangulation), `with_inner`, which
//! converts that, and `insert_at`, which inserts at a location.

/// `new` and `with_capacity`.
macro_rules! construction_methods {
    () => {
        /// Returns an empty triangulation. Its cells have no payload;
        /// [`with_cell_data`](Self::with_cell_data) adds one.
        pub fn new(geometry: G) -> Self {
            Self::over($crate::triangulation::Triangulation::new(geometry))
        }

        /// Like [`new`](Self::new), but with room for that many vertices.
        pub fn with_capacity(geometry: G, vertices: usize) -> Self {
            Self::over($crate::triangulation::Triangulation::with_capacity(
                geometry, vertices,
            ))
        }
    };
}

/// `from_points_with`, given the type with payloads `V`.
macro_rules! from_points_with_method {
    ($with_data:ty) => {
        /// Like [`from_points`](Self::from_points), but with payloads. `data` is called once for
        /// each vertex, with the position of the first point at that vertex, in increasing order.
        ///
        /// # Errors
        /// See [`from_points`](Self::from_points).
        pub fn from_points_with<V>(
            geometry: G,
            points: &[G::Point],
            data: impl FnMut(usize) -> V,
        ) -> Result<($with_data, Vec<$crate::tds::VertexId>), $crate::error::InputError> {
            let (triangulation, vertices) = Self::from_points(geometry, points)?;
            Ok((
                triangulation.with_inner(|inner| inner.with_data_of_points(&vertices, data)),
                vertices,
            ))
        }
    };
}

/// The payloads of vertices and cells, given the types with other payloads, and how those of cells
/// are replaced and found.
macro_rules! payload_methods {
    (
        vertices: <$w:ident $(: $default:path)?> $with_vertex_data:ty,
        cells: <$d:ident> $with_cell_data:ty, $replace:ident, $data_of:path $(,)?
    ) => {
        /// Returns the triangulation with new payloads of its vertices. `data` is called in order
        /// of the vertex numbers, removed vertices included. Linear time; nothing but payloads is
        /// copied. To change some payloads, use [`vertex_data_mut`](Self::vertex_data_mut).
        pub fn with_vertex_data<$w $(: $default)?>(
            self,
            data: impl FnMut($crate::tds::VertexId) -> $w,
        ) -> $with_vertex_data {
            self.with_inner(|inner| inner.with_vertex_data(data))
        }

        /// Returns the triangulation with new payloads of its cells. `data` is called in order of
        /// the cell numbers, infinite cells included. Linear time; nothing but payloads is copied.
        /// To change some payloads, use [`cell_data_mut`](Self::cell_data_mut).
        pub fn with_cell_data<$d: Copy + Default>(
            self,
            data: impl FnMut($crate::tds::CellId) -> $d,
        ) -> $with_cell_data {
            self.with_inner(|inner| inner.$replace(data))
        }

        /// The vertices with their payloads, mutable, in order of their numbers: those that are in
        /// cells, without the infinite one.
        pub fn vertex_data_iter_mut(&mut self) -> impl Iterator<Item = ($crate::tds::VertexId, &mut V)> {
            self.inner.tds.vertex_data_iter_mut()
        }

        /// All cells with their payloads, mutable, the infinite ones included, in order of their
        /// numbers.
        pub fn cell_data_iter_mut(&mut self) -> impl Iterator<Item = ($crate::tds::CellId, &mut C)> {
            self.inner.tds.cell_data_iter_mut().map(|(cell, data)| (cell, $data_of(data)))
        }

        /// Returns the payload of a vertex, mutable. O(1).
        ///
        /// # Panics
        /// If no vertex ever had this number, and for the infinite vertex.
        pub fn vertex_data_mut(&mut self, vertex: $crate::tds::VertexId) -> &mut V {
            self.inner.tds.vertex_data_mut(vertex)
        }

        /// Returns the payload of a cell, mutable. O(1).
        ///
        /// # Panics
        /// If no cell ever had this number.
        pub fn cell_data_mut(&mut self, cell: $crate::tds::CellId) -> &mut C {
            $data_of(self.inner.tds.cell_data_mut(cell))
        }
    };
}

/// Insertion with payloads, given the documentation of `insert_with` and the trait of strategies.
macro_rules! insertion_methods {
    ($(#[$documentation:meta])* by $strategy:path) => {
        $(#[$documentation])*
        pub fn insert_with(
            &mut self,
            p: G::Point,
            data: V,
        ) -> Result<$crate::engine::Inserted<V>, $crate::error::PointError> {
            self.insert_by(&mut $crate::locate::Near(None), p, data)
        }

        /// Like [`insert_with`](Self::insert_with), but the search for the point starts at a cell:
        /// the strategy [`Near`](crate::Near).
        ///
        /// # Errors
        /// See [`insert_with`](Self::insert_with).
        pub fn insert_near(
            &mut self,
            p: G::Point,
            data: V,
            near: Option<$crate::tds::CellId>,
        ) -> Result<$crate::engine::Inserted<V>, $crate::error::PointError> {
            self.insert_by(&mut $crate::locate::Near(near), p, data)
        }

        /// Like [`insert_with`](Self::insert_with), but locates the point by a
        /// [strategy](crate::Locate), which is notified of the new vertex if it is in cells.
        ///
        /// # Errors
        /// See [`insert_with`](Self::insert_with).
        pub fn insert_by(
            &mut self,
            strategy: &mut impl $strategy,
            p: G::Point,
            data: V,
        ) -> Result<$crate::engine::Inserted<V>, $crate::error::PointError> {
            $crate::engine::insert::insert_located(self, strategy, p, data, Self::insert_at)
        }
    };
}

/// `insert`, for vertices without payloads.
macro_rules! insert_method {
    () => {
        /// Inserts a point and returns its vertex, or the one that is there already; see
        /// [`insert_with`](Self::insert_with). To insert many points, use
        /// [`insert_all`](Self::insert_all).
        ///
        /// # Errors
        /// See [`insert_with`](Self::insert_with).
        pub fn insert(
            &mut self,
            p: G::Point,
        ) -> Result<$crate::tds::VertexId, $crate::error::PointError> {
            Ok(self.insert_with(p, ())?.vertex)
        }
    };
}

/// `remove_by`, given the trait of strategies.
macro_rules! remove_by_method {
    ($strategy:path) => {
        /// Like [`remove`](Self::remove), but also notifies a location [strategy](crate::Locate).
        ///
        /// # Errors
        /// See [`remove`](Self::remove).
        pub fn remove_by(
            &mut self,
            strategy: &mut impl $strategy,
            vertex: $crate::tds::VertexId,
        ) -> Result<G::Point, $crate::error::RemovalError> {
            self.remove(vertex).inspect(|_| strategy.removed(vertex))
        }
    };
}

/// `remove_all`, for kinds that can remove each vertex.
macro_rules! remove_all_method {
    () => {
        /// Removes many vertices, and returns the point of each. One that is named twice is removed
        /// once.
        ///
        /// # Errors
        /// If there is no such vertex; nothing has changed then.
        ///
        /// # Complexity
        /// That of each removal.
        pub fn remove_all(
            &mut self,
            vertices: &[$crate::tds::VertexId],
        ) -> Result<Vec<G::Point>, $crate::error::RemovalError> {
            if !vertices.iter().all(|&vertex| self.has_point(vertex)) {
                return Err($crate::error::RemovalError::NoVertex);
            }
            for &vertex in vertices {
                if self.has_point(vertex) {
                    self.remove(vertex)?;
                }
            }
            Ok(vertices.iter().map(|&vertex| *self.point(vertex)).collect())
        }
    };
}

pub(crate) use {
    construction_methods, from_points_with_method, insert_method, insertion_methods,
    payload_methods, remove_all_method, remove_by_method,
};
