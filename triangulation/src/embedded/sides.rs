//! The side of a facet, and the spheres, in which a point lies.

use std::borrow::Borrow;

use crate::geometry::{Geometry, in_sphere, in_sphere_of_flat};
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId};

use super::{Embedded, PointOf};

/// Returns the points of a cell of any dimension, with `q` in place of the vertex at `replaced`.
/// All others are finite.
pub(crate) fn points_with<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    replaced: usize,
    q: &PointOf<T, N>,
) -> Result<Vec<PointOf<T, N>>, T::Error> {
    let corners = t.complex().corners(cell)?;
    let vertices = corners[..t.complex().width()].iter().enumerate();
    vertices
        .map(|(i, &v)| {
            if i == replaced {
                Ok(*q)
            } else {
                Ok(*t.point(v)?.borrow())
            }
        })
        .collect()
}

/// Returns the orientation of a cell with `q` in place of one vertex; all others are finite.
/// Positive if `q` and the cell are on the same side of the facet opposite that vertex (or, with
/// the infinite vertex replaced, if `q` is beyond the hull there).
#[inline(always)]
pub(crate) fn side_of_facet<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    replaced: usize,
    q: &PointOf<T, N>,
) -> Result<Sign, T::Error> {
    if t.complex().width() < N {
        return side_of_facet_in_flat(t, cell, replaced, q);
    }
    let corners = t.complex().corners(cell)?;
    let mut simplex = [T::point_ref(q); N];
    for i in 0..N {
        if i != replaced {
            simplex[i] = t.point(corners[i])?;
        }
    }
    Ok(t.geometry()
        .orientation(simplex.each_ref().map(Borrow::borrow)))
}

#[cold]
fn side_of_facet_in_flat<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    replaced: usize,
    q: &PointOf<T, N>,
) -> Result<Sign, T::Error> {
    let points = points_with(t, cell, replaced, q)?;
    Ok(t.geometry()
        .orientation_in_flat(&points.iter().collect::<Vec<_>>()))
}

/// Returns true if `q` lies outside of the line or plane of all points, which a finite cell spans.
pub(crate) fn leaves_flat<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
) -> Result<bool, T::Error> {
    let points = points_with(t, cell, usize::MAX, q)?;
    let mut simplex: Vec<&PointOf<T, N>> = points.iter().collect();
    simplex.push(q);
    let sign = match <[&PointOf<T, N>; N]>::try_from(simplex) {
        Ok(full) => t.geometry().orientation(full),
        Err(flat) => t.geometry().orientation_in_flat(&flat),
    };
    Ok(sign != Sign::Zero)
}

/// Returns the points of a finite cell of full dimension.
#[inline(always)]
pub(crate) fn simplex<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
) -> Result<[T::PointRef<'_>; N], T::Error> {
    let corners = t.complex().corners(cell)?;
    let mut simplex = [t.point(corners[0])?; N];
    for i in 1..N {
        simplex[i] = t.point(corners[i])?;
    }
    Ok(simplex)
}

/// Returns true if a new point `q` destroys the cell under the empty sphere law, ties decided. The
/// sphere of an infinite cell is the open half space beyond its finite facet, together with the
/// inside of the facet's own sphere.
#[inline(always)]
pub(crate) fn in_conflict<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
) -> Result<bool, T::Error> {
    if t.complex().width() < N {
        return in_conflict_in_flat(t, cell, q);
    }
    match t.complex().index_of(cell, VertexId::INFINITE)? {
        None => Ok(in_sphere(
            t.geometry(),
            simplex(t, cell)?.each_ref().map(Borrow::borrow),
            q,
        )),
        Some(infinite) => beyond_hull(t, cell, infinite, q),
    }
}

fn beyond_hull<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    infinite: usize,
    q: &PointOf<T, N>,
) -> Result<bool, T::Error> {
    Ok(match side_of_facet(t, cell, infinite, q)? {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => {
            let corners = t.complex().corners(cell)?;
            let mut facet = [T::point_ref(q); N];
            let finite = corners[..t.complex().width()]
                .iter()
                .filter(|&&v| v != VertexId::INFINITE);
            let mut length = 0;
            for &v in finite {
                facet[length] = t.point(v)?;
                length += 1;
            }
            in_sphere_of_flat(
                t.geometry(),
                &facet.each_ref().map(Borrow::borrow)[..length],
                q,
            )
        }
    })
}

#[cold]
fn in_conflict_in_flat<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
) -> Result<bool, T::Error> {
    let complex = t.complex();
    match complex.index_of(cell, VertexId::INFINITE)? {
        None => {
            let points = points_with(t, cell, usize::MAX, q)?;
            Ok(in_sphere_of_flat(
                t.geometry(),
                &points.iter().collect::<Vec<_>>(),
                q,
            ))
        }
        Some(infinite) if complex.width() == 2 => {
            // The end of a line: the edge inwards shows which direction is out.
            let inner = complex.inner(cell)?;
            let end = complex.vertex(cell, 1 - infinite)?;
            let at = complex.index_of(inner, end)?;
            complex.ensure(inner, || at.is_some())?;
            Ok(match side_of_facet(t, inner, 1 - at.unwrap_or(0), q)? {
                Sign::Negative => true,
                Sign::Zero => in_sphere_of_flat(t.geometry(), &[t.point(end)?.borrow()], q), // on its site
                Sign::Positive => false,
            })
        }
        Some(infinite) => beyond_hull(t, cell, infinite, q),
    }
}
