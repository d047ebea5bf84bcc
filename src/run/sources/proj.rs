//! Reprojection with [PROJ](https://proj.org), behind the feature `proj`.
//!
//! Coordinates are always easting (or longitude) first. Plan coordinates are left to PROJ, which
//! picks, point by point, the best operation for which it has grids. None of the large grids are
//! included, so it may fall back on an operation with an accuracy of meters, or of unknown
//! accuracy; [`Transform::warnings`](crate::crs::Transform::warnings) lists the operations that
//! were used and their accuracy. Heights are converted between units, but never between vertical
//! datums; a warning says so where it matters.

/// Returns the operation that transforms coordinates from one system to another.
///
/// It may be used from many threads; each gets its own PROJ context. Only the source may be a
/// geocentric system: its X, Y and Z are first converted to longitude, latitude and ellipsoidal
/// height.
///
/// # Errors
/// If PROJ does not know one of the systems or no operation between them; without the feature
/// `proj`, always.
#[cfg(not(feature = "proj"))]
pub fn transform(
    from: &crate::crs::Crs,
    to: &crate::crs::Crs,
) -> crate::error::Result<Box<dyn crate::crs::Transform>> {
    Err(crate::error::Error::unsupported(format!(
        "reprojecting from {from} to {to} needs PROJ, which this build does not have"
    ))
    .cure(crate::error::wording![
        "build with ",
        crate::error::Feature::Proj,
        " (needs g++, make, cmake, sqlite3)"
    ]))
}

#[cfg(feature = "proj")]
pub use with_proj::transform;

#[cfg(feature = "proj")]
mod with_proj {
    use std::cell::RefCell;
    use std::collections::{BTreeSet, VecDeque};
    use std::rc::Rc;
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::sync::{Mutex, PoisonError};

    use proj::{Proj, ProjInfo};

    use crate::crs::{Crs, CrsKind, Transform};
    use crate::error::{Error, Result, Setting, wording};

    /// PROJ objects that a thread keeps. If more transforms are used at once, objects are created
    /// again on use.
    const KEPT: usize = 8;

    /// An accuracy worse than this, in meters, is reported, because lidar is better.
    const REPORTED: f64 = 0.1;

    thread_local! {
        static OBJECTS: RefCell<VecDeque<(u64, Rc<Proj>)>> = const { RefCell::new(VecDeque::new()) };
    }

    static NEXT: AtomicU64 = AtomicU64::new(0);

    struct Operation {
        /// Its key in [`OBJECTS`].
        id: u64,
        from: Crs,
        to: Crs,
        /// The definitions that PROJ receives; they do not cover heights.
        definitions: (String, String),
        /// The transform from a geocentric source to the geographic system on the same datum.
        geocentric: Option<proj_core::Transform>,
        /// The factor from units of height in the source to those in the target.
        height: f64,
        warnings: Mutex<BTreeSet<String>>,
    }

    /// See the documented [`transform`](super::transform).
    pub fn transform(from: &Crs, to: &Crs) -> Result<Box<dyn Transform>> {
        for crs in [from, to] {
            if crs.kind == CrsKind::Local {
                return Err(Error::usage(format!(
                    "{crs} is a local system: its position on the earth is unknown"
                ))
                .cure(wording!["state the system with ", Setting::Crs]));
            }
        }
        if to.kind == CrsKind::Geocentric && !from.is_same(to) {
            return Err(
                Error::unsupported(format!("reprojecting to {to}, which is geocentric"))
                    .cure("choose a projected system, such as EPSG:25832"),
            );
        }
        let (geocentric, base) = match from.kind {
            CrsKind::Geocentric => {
                let (first, base) = from_geocentric(from)?;
                (Some(first), base)
            }
            _ => (None, definition(from)),
        };
        let heights = heights(from, to);
        let operation = Operation {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            definitions: (base, definition(to)),
            geocentric,
            height: heights.0,
            warnings: Mutex::new(heights.1.into_iter().collect()),
            from: from.clone(),
            to: to.clone(),
        };
        // Created now, so that an impossible operation fails before anything is read.
        let object = operation.object()?;
        operation.record_accuracy(&object.proj_info());
        Ok(Box::new(operation))
    }

    /// Returns a definition that PROJ understands: the code of the horizontal part, or the full
    /// definition.
    fn definition(crs: &Crs) -> String {
        match crs.epsg {
            Some(code) => format!("EPSG:{code}"),
            None => crs.to_wkt(),
        }
    }

    fn from_geocentric(from: &Crs) -> Result<(proj_core::Transform, String)> {
        let failed =
            |reason: String| Error::unsupported(format!("reprojecting from {from}: {reason}"));
        let code = from
            .epsg
            .ok_or_else(|| failed("a geocentric system without an EPSG code".into()))?;
        let source = proj_core::lookup_epsg(code)
            .ok_or_else(|| failed("it is not in the registry".into()))?;
        let base = source
            .base_geographic_crs_epsg()
            .ok_or_else(|| failed("its datum is unknown".into()))?;
        let target =
            proj_core::lookup_epsg(base).ok_or_else(|| failed("its datum is unknown".into()))?;
        let first = proj_core::Transform::from_crs_defs(&source, &target)
            .map_err(|error| failed(error.to_string()))?;
        Ok((first, format!("EPSG:{base}")))
    }

    /// Returns the factor for heights, and a warning about them if there is one.
    fn heights(from: &Crs, to: &Crs) -> (f64, Option<String>) {
        let (Some(source), target) = (&from.vertical_unit, &to.vertical_unit) else {
            let nothing = to.vertical_epsg.map(|code| {
                format!(
                    "heights are left as they are: {from} does not state their vertical system, EPSG:{code} is assumed"
                )
            });
            return (1.0, nothing);
        };
        if from.kind == CrsKind::Geocentric {
            let unit = target.as_ref().map_or(1.0, |unit| unit.factor);
            let warning = to.vertical_epsg.map(|code| {
                format!("heights are kept above the ellipsoid: they are not those of EPSG:{code}")
            });
            return (
                1.0 / unit,
                warning.or_else(|| Some("heights are above the ellipsoid".to_owned())),
            );
        }
        let factor = target
            .as_ref()
            .map_or(1.0, |target| source.factor / target.factor);
        let same = match (from.vertical_epsg, to.vertical_epsg) {
            (Some(a), Some(b)) => {
                a == b || vertical_datum(a).is_some() && vertical_datum(a) == vertical_datum(b)
            }
            (None, None) => true,
            _ => false,
        };
        let name = |code: Option<u32>| {
            code.map_or("heights above the ellipsoid".to_owned(), |code| {
                format!("EPSG:{code}")
            })
        };
        let warning = match target {
            None => from.vertical_epsg.map(|code| {
                format!(
                    "heights are left as they are, in {} (EPSG:{code}): {to} states no vertical system",
                    source.name
                )
            }),
            Some(_) if same => None,
            Some(target) => Some(format!(
                "heights keep their datum{}: they are not transformed from {} to {}",
                if (factor - 1.0).abs() > 1e-12 { format!(" (in {})", target.name) } else { String::new() },
                name(from.vertical_epsg),
                name(to.vertical_epsg),
            )),
        };
        (factor, warning)
    }

    fn vertical_datum(code: u32) -> Option<u32> {
        proj_core::lookup_vertical_epsg(code)?.vertical_datum_epsg()
    }

    impl Operation {
        /// Returns this thread's PROJ object.
        fn object(&self) -> Result<Rc<Proj>> {
            let kept = OBJECTS.with_borrow(|kept| {
                kept.iter()
                    .find(|entry| entry.0 == self.id)
                    .map(|entry| entry.1.clone())
            });
            if let Some(object) = kept {
                return Ok(object);
            }
            let (from, to) = &self.definitions;
            let object = Proj::new_known_crs(from, to, None).map_err(|error| {
                Error::unsupported(format!(
                    "PROJ has no operation from {} to {}: {error}",
                    self.from, self.to
                ))
                .cure(wording![
                    "name other systems with ",
                    Setting::Crs,
                    " (of the input) or ",
                    Setting::TargetCrs
                ])
            })?;
            let object = Rc::new(object);
            OBJECTS.with_borrow_mut(|kept| {
                kept.push_back((self.id, object.clone()));
                if kept.len() > KEPT {
                    kept.pop_front();
                }
            });
            Ok(object)
        }

        /// Records the accuracy of the operation that was used last.
        fn record_accuracy(&self, info: &ProjInfo) {
            let name = info
                .description
                .as_deref()
                .unwrap_or("an operation without a name");
            // Before the first point, PROJ has not yet chosen among several operations.
            if info.id.as_deref() == Some("unknown") && name.starts_with("unavailable until") {
                return;
            }
            let (from, to) = (&self.from, &self.to);
            let warning = if info.accuracy < 0.0 {
                format!("the accuracy of the operation from {from} to {to} is unknown ({name})")
            } else if info.accuracy > REPORTED {
                format!(
                    "the operation from {from} to {to} is accurate to {} m ({name})",
                    info.accuracy
                )
            } else {
                return;
            };
            self.warnings
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(warning);
        }

        fn one(&self, object: &Proj, point: [f64; 3]) -> std::result::Result<[f64; 3], String> {
            let mut start = point;
            if let Some(first) = &self.geocentric {
                let position = first
                    .convert_3d((point[0], point[1], point[2]))
                    .map_err(|error| error.to_string())?;
                start = [position.0, position.1, position.2];
            }
            let (x, y) = object
                .convert((start[0], start[1]))
                .map_err(|error| error.to_string())?;
            if x.is_finite() && y.is_finite() {
                Ok([x, y, start[2] * self.height])
            } else {
                Err("it is outside of the area of the operation".to_owned())
            }
        }
    }

    impl Transform for Operation {
        fn transform(&self, points: &mut [[f64; 3]]) -> Result<()> {
            let object = self.object()?;
            for point in points.iter_mut() {
                *point = self.one(&object, *point).map_err(|reason| {
                    let [x, y, _] = point;
                    Error::format(format!(
                        "point ({x}, {y}) cannot be transformed from {} to {}: {reason}",
                        self.from, self.to
                    ))
                    .cure(wording![
                        "check that the file's coordinate system is what it says (",
                        Setting::Crs,
                        " overrides it)"
                    ])
                })?;
            }
            if !points.is_empty() {
                self.record_accuracy(&object.proj_info());
            }
            Ok(())
        }

        fn warnings(&self) -> Vec<String> {
            self.warnings
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .iter()
                .cloned()
                .collect()
        }
    }
}
