//! The distances of all sites from a finished surface.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::error::{Slopes, decided, exceeds};
use super::lattice::Lattice;
use super::sites::Sites;
use crate::data::Surface;
use crate::terrain::Tin;
use crate::triangulation::Location;
use crate::triangulation::tds::CellId;

/// How far sites are from a surface.
pub(super) struct Distances {
    /// The sites that are further off than the bound, in the order of their numbers.
    pub(super) beyond: Vec<u32>,
    pub(super) largest: f64,
    pub(super) root_mean_square: f64,
}

/// How many sites are summed up together: the result does not depend on the number of threads.
const TOGETHER: usize = 1 << 16;

/// Measures all sites. `site_of` has the site of each vertex.
///
/// # Complexity
/// Linear for a lattice; else a walk for each site; on all threads.
pub(super) fn measure(sites: &Sites, tin: &Tin, site_of: &[u32], bound: f64) -> Distances {
    match sites {
        Sites::Scattered { positions, order } => of_scattered(positions, order, tin, bound),
        Sites::Lattice { lattice, .. } => of_lattice(sites, lattice, tin, site_of, bound),
    }
}

impl Distances {
    /// Sums up some sites: `error` returns the distance of each, NaN where there is none.
    fn of(mut beyond: Vec<u32>, count: usize, error: impl Fn(usize) -> f64 + Sync) -> Self {
        beyond.sort_unstable();
        beyond.dedup();
        let parts = (0..count.div_ceil(TOGETHER)).into_par_iter().map(|part| {
            let (mut count_of, mut squares, mut largest) = (0_u64, 0.0, 0.0);
            let sites = part * TOGETHER..count.min((part + 1) * TOGETHER);
            for error in sites.map(&error).filter(|error| !error.is_nan()) {
                count_of += 1;
                squares += error * error;
                largest = f64::max(largest, error);
            }
            (count_of, squares, largest)
        });
        let parts: Vec<(u64, f64, f64)> = parts.collect();
        let known: u64 = parts.iter().map(|(count_of, ..)| count_of).sum();
        let squares: f64 = parts.iter().map(|(_, squares, _)| squares).sum();
        Distances {
            beyond,
            largest: parts.iter().fold(0.0, |most, part| f64::max(most, part.2)),
            root_mean_square: (squares / known.max(1) as f64).sqrt(),
        }
    }
}

/// The corners of a face in the order of their positions: the same plane whatever the numbers.
fn sorted(mut corners: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    corners.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    corners
}

/// The distance of a site from a face, above the bound if, and only if, the real number is.
fn distance(corners: [[f64; 3]; 3], q: [f64; 3], bound: f64) -> f64 {
    let (error, uncertainty) = match Slopes::of(sorted(corners)) {
        Some(slopes) => (slopes.residual(q).abs(), slopes.uncertainty),
        None => (bound, f64::INFINITY),
    };
    decided(error, uncertainty, bound, || exceeds(corners, q, bound))
}

/// Measures sites in an order in which each is near to the one before.
fn of_scattered(positions: &[[f64; 3]], order: &[u32], tin: &Tin, bound: f64) -> Distances {
    let triangulation = tin.triangulation();
    let error_of = |near: &mut Option<CellId>, q: [f64; 3]| {
        let location = triangulation.locate(&q, *near);
        *near = location.cell(triangulation).or(*near);
        match location {
            Location::Vertex(vertex) => (q[2] - triangulation.point(vertex)[2]).abs(),
            Location::Cell { cell, .. } => match triangulation.cell_points(cell) {
                Some(corners) => distance(corners.map(|p| *p), q, bound),
                None => f64::INFINITY,
            },
            _ => f64::INFINITY,
        }
    };
    let errors: Vec<f64> = order
        .par_iter()
        .with_min_len(1 << 12)
        .map_init(
            || None,
            |near, &site| error_of(near, positions[site as usize]),
        )
        .collect();
    let is_beyond = |(&site, &error): (&u32, &f64)| (error > bound).then_some(site);
    let beyond = order.iter().zip(&errors).filter_map(is_beyond).collect();
    Distances::of(beyond, errors.len(), |k| errors[k])
}

/// Measures the cells of a lattice, by the columns of each face.
fn of_lattice(
    sites: &Sites,
    lattice: &Lattice,
    tin: &Tin,
    site_of: &[u32],
    bound: f64,
) -> Distances {
    // A cell on an edge is measured twice; the larger one counts, whoever comes first.
    let errors: Vec<AtomicU64> = (0..lattice.heights.len())
        .into_par_iter()
        .map(|_| AtomicU64::new(0))
        .collect();
    let faces = (0..tin.face_count() as u32).into_par_iter();
    let beyond: Vec<u32> = faces
        .with_min_len(1 << 10)
        .flat_map_iter(|face| {
            let mut beyond = Vec::new();
            let Some(vertices) = tin.face(face) else {
                return beyond;
            };
            let corners = vertices.map(|vertex| site_of[vertex as usize]);
            let columns = match lattice.columns(corners) {
                Ok(columns) => columns,
                Err(flat) => return flat.into_iter().collect(),
            };
            let uncertainty = columns.uncertainty();
            for column in columns.all() {
                for k in 0..column.heights.len() {
                    let site = column.first + k as u32;
                    let mut error = column.residual(k).abs();
                    if error.is_nan() || corners.contains(&site) {
                        continue;
                    }
                    if (error - bound).abs() <= uncertainty {
                        let positions = corners.map(|corner| sites.position(corner));
                        error = distance(positions, sites.position(site), bound);
                    }
                    errors[site as usize].fetch_max(error.to_bits(), Ordering::Relaxed);
                    if error > bound {
                        beyond.push(site);
                    }
                }
            }
            beyond
        })
        .collect();
    Distances::of(beyond, errors.len(), |site| {
        match lattice.heights[site].is_nan() {
            true => f64::NAN,
            false => f64::from_bits(errors[site].load(Ordering::Relaxed)),
        }
    })
}
