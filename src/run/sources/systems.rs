//! The coordinate system of the result, and which files have to be reprojected.

use std::path::{Path, PathBuf};

use super::proj::TransformOptions;
use crate::crs::{Crs, CrsKind};
use crate::data::{Layer, PointInfo};
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;

/// Options of coordinate systems. By default all files that state a system must state the same,
/// files that state none are taken to be in it, and nothing is reprojected.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct SystemOptions {
    /// The coordinate system of all input, whatever the files state.
    pub assign: Option<Crs>,
    /// The coordinate system of the result: points and lines are reprojected to it, which needs the
    /// feature `proj`.
    pub target: Option<Crs>,
    /// What to do with coordinates in degrees.
    pub degrees: Degrees,
    /// How coordinates are reprojected.
    pub transform: TransformOptions,
}

/// What to do with coordinates in degrees, which are not lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Degrees {
    /// They are an error.
    #[default]
    Refuse,
    /// They are used as lengths.
    Allow,
}

/// Returns the hint for coordinates in the wrong system. Without PROJ, there is no target system.
pub(crate) fn reproject_first() -> Wording {
    match cfg!(feature = "proj") {
        true => wording!["reproject with ", Setting::TargetCrs.text("EPSG:CODE")],
        false => "reproject first (ogr2ogr, gdalwarp, pdal): this build is without PROJ".into(),
    }
}

/// A file and the coordinate system that it states.
#[derive(Debug, Clone)]
pub(crate) struct Stated {
    pub(crate) path: PathBuf,
    pub(crate) crs: Option<Crs>,
    /// What it states, if that is not understood.
    pub(crate) unread: Option<String>,
    pub(crate) role: Role,
}

impl Stated {
    /// Returns what a file of points states.
    pub(crate) fn by_points(path: &Path, info: &PointInfo) -> Self {
        let (crs, unread) = (info.crs.clone(), info.unread_crs.clone());
        Stated {
            path: path.to_path_buf(),
            crs,
            unread,
            role: Role::Ground,
        }
    }

    /// Returns what a file of lines or polygons states.
    pub(crate) fn by_layer(path: &Path, layer: &Layer) -> Self {
        let (crs, unread) = (layer.crs.clone(), layer.unread_crs.clone());
        Stated {
            path: path.to_path_buf(),
            crs,
            unread,
            role: Role::Lines,
        }
    }

    /// Returns this with a coordinate system that is assigned, if any, whatever the file states.
    pub(crate) fn assigned(self, crs: Option<&Crs>, journal: &Journal) -> Self {
        let Some(assigned) = crs else {
            return self;
        };
        if let Some(stated) = self.crs.filter(|stated| !stated.is_same(assigned)) {
            journal.add(Notice::Reassigned {
                path: self.path.clone(),
                stated: Box::new(stated),
                assigned: Box::new(assigned.clone()),
            });
        }
        Stated {
            crs: Some(assigned.clone()),
            unread: None,
            path: self.path,
            role: self.role,
        }
    }

    /// Returns true if the file states the same system as another one, or neither states any.
    pub(crate) fn agrees_with(&self, other: &Stated) -> bool {
        match (&self.crs, &other.crs) {
            (Some(a), Some(b)) => a.is_same(b),
            (None, None) => self.unread == other.unread,
            _ => false,
        }
    }
}

/// The role of a file in the input. If all else is equal, the definition of the later role is used:
/// that of a `.prj` has shortened names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Lines,
    Ground,
    /// A surface that was read; it is not reprojected.
    Whole,
}

/// The coordinate system of the result, and the one that each file is reprojected from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Systems {
    /// The system that each file is reprojected from; `None` if its coordinates are used as they
    /// are.
    pub(crate) from: Vec<Option<Crs>>,
    /// The system of the result.
    pub(crate) crs: Option<Crs>,
}

/// Returns the coordinate system of the result for the systems of all files.
///
/// # Errors
/// If two files state different systems, the result would be in degrees or geocentric, or there is
/// nothing to reproject from.
pub(crate) fn reconcile(
    files: &[Stated],
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Systems> {
    let stated = assigned(files, options, journal);
    let systems = common(&stated, options, journal)?;
    match &systems.crs {
        Some(crs) => judge(crs, &stated, options.degrees, journal)?,
        None => journal.add(Notice::NoSystem),
    }
    Ok(systems)
}

/// Like [`reconcile`], for results that need no lengths: the system may be of any kind, or unknown.
///
/// # Errors
/// If two files state different systems, or there is nothing to reproject from.
pub(crate) fn unify(
    files: &[Stated],
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Systems> {
    common(&assigned(files, options, journal), options, journal)
}

fn common(stated: &[Stated], options: &SystemOptions, journal: &Journal) -> Result<Systems> {
    match &options.target {
        Some(target) => reproject(stated, target, journal),
        None => Ok(Systems {
            from: vec![None; stated.len()],
            crs: agree(stated, journal)?,
        }),
    }
}

/// Like [`reconcile`], but ignores the files that are `None`; these are not reprojected.
///
/// # Errors
/// Those of [`reconcile`].
pub(crate) fn reconcile_some(
    files: &[Option<Stated>],
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Systems> {
    let asked: Vec<Stated> = files.iter().flatten().cloned().collect();
    let Systems { from, crs } = reconcile(&asked, options, journal)?;
    let mut from = from.into_iter();
    let from = files
        .iter()
        .map(|file| file.as_ref().and_then(|_| from.next().flatten()))
        .collect();
    Ok(Systems { from, crs })
}

fn assigned(files: &[Stated], options: &SystemOptions, journal: &Journal) -> Vec<Stated> {
    let assign = options.assign.as_ref();
    files
        .iter()
        .map(|file| file.clone().assigned(assign, journal))
        .collect()
}

/// Returns the common system of all files that state one.
fn agree(files: &[Stated], journal: &Journal) -> Result<Option<Crs>> {
    require_understood(files)?;
    let mut known = files
        .iter()
        .filter_map(|file| file.crs.as_ref().map(|crs| (file, crs)));
    let Some(mut best) = known.next() else {
        return Ok(None);
    };
    for (file, crs) in known {
        if !crs.is_same(best.1) {
            return Err(two_systems(best, (file, crs)));
        }
        // Choose the most complete definition, whatever the order of the files.
        if rank(file, crs) > rank(best.0, best.1) {
            best = (file, crs);
        }
    }
    let best = best.1;
    let unit = |crs: &Crs| Units::of(Some(crs)).height(0.0).unit;
    for (file, crs) in files.iter().filter_map(|f| Some((f, f.crs.as_ref()?))) {
        if let (Some(own), Some(taken)) = (unit(crs), unit(best))
            && !own.is_same(&taken)
        {
            let path = file.path.clone();
            journal.add(Notice::HeightsOfOthers(path, taken.name));
        }
    }
    for file in files.iter().filter(|file| file.crs.is_none()) {
        journal.add(Notice::SystemOfOthers(
            file.path.clone(),
            Box::new(best.clone()),
        ));
    }
    Ok(Some(best.clone()))
}

/// Returns an error if a file states something that is not understood, and another file states
/// something else: whether they agree is not known.
fn require_understood(files: &[Stated]) -> Result<()> {
    let stating = |file: &&Stated| file.crs.is_some() || file.unread.is_some();
    let Some((file, text)) = files
        .iter()
        .find_map(|file| Some((file, file.unread.as_ref()?)))
    else {
        return Ok(());
    };
    let Some(other) = files
        .iter()
        .filter(stating)
        .find(|other| !file.agrees_with(other))
    else {
        return Ok(());
    };
    let theirs = match (&other.crs, &other.unread) {
        (Some(crs), _) => format!("is in {crs}"),
        (None, stated) => format!("states {}", quoted(stated.as_deref().unwrap_or_default())),
    };
    Err(Error::unsupported(format!(
        "a coordinate system that is not understood: {} states {}, {} {theirs}",
        file.path.display(),
        quoted(text),
        other.path.display()
    ))
    .cure(wording![
        "state the system of all files with ",
        Setting::Crs.text("CRS")
    ]))
}

/// Returns what a file states as its coordinate system, as messages show it.
pub(crate) fn quoted(stated: &str) -> String {
    const MAX_SHOWN: usize = 100;
    let dots = if stated.chars().count() > MAX_SHOWN {
        "..."
    } else {
        ""
    };
    format!(
        "\"{}{dots}\"",
        stated
            .chars()
            .take(MAX_SHOWN)
            .collect::<String>()
            .escape_debug()
    )
}

fn rank<'a>(file: &Stated, crs: &'a Crs) -> impl PartialOrd + use<'a> {
    (
        crs.vertical_epsg,
        crs.vertical_unit.is_some(),
        crs.epsg,
        file.role,
        crs.wkt.as_deref(),
        crs.name.as_str(),
    )
}

fn two_systems((a, a_crs): (&Stated, &Crs), (b, b_crs): (&Stated, &Crs)) -> Error {
    let shown = |crs: &Crs| match (a_crs.to_string() == b_crs.to_string(), &crs.vertical_unit) {
        (true, Some(unit)) => format!("{crs} with heights in units of the {}", unit.name),
        _ => crs.to_string(),
    };
    Error::unsupported(format!(
        "two coordinate systems: {} is in {}, {} in {}",
        a.path.display(),
        shown(a_crs),
        b.path.display(),
        shown(b_crs)
    ))
    .cure(wording![
        reproject_first(),
        "; or state the system of all files with ",
        Setting::Crs.text("CRS")
    ])
}

fn reproject(files: &[Stated], target: &Crs, journal: &Journal) -> Result<Systems> {
    let mut from = Vec::with_capacity(files.len());
    let common = if files.iter().any(|file| file.crs.is_none()) {
        agree(files, journal)?
    } else {
        None
    };
    for file in files {
        let common = common.as_ref().filter(|_| file.unread.is_none());
        let Some(crs) = file.crs.as_ref().or(common) else {
            return Err(Error::unsupported(
                "the file states no coordinate system to reproject from",
            )
            .in_file(&file.path)
            .cure(wording!["state its system with ", Setting::Crs.text("CRS")]));
        };
        from.push(Some(crs.clone()).filter(|crs| !crs.is_same(target)));
    }
    Ok(Systems {
        from,
        crs: Some(target.clone()),
    })
}

/// Returns an error if the coordinates of a system are not lengths in a plane.
fn judge(crs: &Crs, files: &[Stated], degrees: Degrees, journal: &Journal) -> Result<()> {
    let file = files.iter().find(|file| file.crs.is_some());
    let in_file = |error: Error| match file {
        Some(file) => error.in_file(&file.path),
        None => error,
    };
    match crs.kind {
        CrsKind::Geocentric => {
            let error = Error::unsupported(format!("{crs} is geocentric: its z axis is not up"));
            return Err(in_file(error).cure(wording![reproject_first(), ", to a projected system"]));
        }
        CrsKind::Geographic if degrees == Degrees::Refuse => {
            let unit = &crs.unit.name;
            let error = Error::unsupported(format!(
                "{crs} is geographic: its unit, the {unit}, is not a length"
            ));
            let cure = match file {
                Some(Stated {
                    role: Role::Whole, ..
                }) => wording![
                    "build it from points in a projected system, or continue with ",
                    Setting::ForceDegrees.on()
                ],
                // The format implies degrees, but the file may contain something else.
                Some(file) if is_geojson(&file.path) => wording![
                    "GeoJSON without a `crs` member is in degrees: say with ",
                    Setting::Crs.text("EPSG:CODE"),
                    " if it is not (of a local system: ",
                    Setting::Crs,
                    " 'LOCAL_CS[\"local\",UNIT[\"metre\",1]]'); if it is, ",
                    reproject_first()
                ],
                _ => wording![
                    reproject_first(),
                    ", to a projected system, or continue with ",
                    Setting::ForceDegrees.on()
                ],
            };
            return Err(in_file(error).cure(cure));
        }
        _ => {}
    }
    if let Some((plan, height)) = Units::of(Some(crs)).disagreement() {
        journal.add(Notice::DifferentUnits(plan.to_owned(), height.to_owned()));
    }
    Ok(())
}

fn is_geojson(path: &Path) -> bool {
    path.extension().is_some_and(|e| {
        ["geojson", "json"]
            .iter()
            .any(|known| e.eq_ignore_ascii_case(known))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::Unit;
    use crate::error::Part;
    use crate::run::context::Context;

    fn crs(code: u32, kind: CrsKind) -> Crs {
        let unit = Unit {
            name: "metre".to_owned(),
            factor: 1.0,
        };
        Crs {
            name: format!("S{code}"),
            epsg: Some(code),
            vertical_epsg: None,
            kind,
            unit,
            vertical_unit: None,
            wkt: None,
        }
    }

    fn files(systems: &[Option<u32>]) -> Vec<Stated> {
        (0..)
            .zip(systems)
            .map(|(i, &code)| Stated {
                path: format!("f{i}").into(),
                crs: code.map(|code| crs(code, CrsKind::Projected)),
                unread: None,
                role: Role::Ground,
            })
            .collect()
    }

    fn quiet() -> Journal<'static> {
        Journal::new(&Context::default())
    }

    #[test]
    fn a_file_without_a_system_takes_that_of_the_others() {
        let systems = reconcile(
            &files(&[None, Some(25832), None]),
            &SystemOptions::default(),
            &quiet(),
        )
        .unwrap();
        assert_eq!(systems.crs.unwrap().epsg, Some(25832));
        assert_eq!(systems.from, [None, None, None]);
    }

    #[test]
    fn two_systems_are_an_error_that_names_both_and_the_files() {
        let error = reconcile(
            &files(&[None, Some(25832), Some(3005)]),
            &SystemOptions::default(),
            &quiet(),
        )
        .unwrap_err();
        let text = error.to_string();
        for part in ["f1", "EPSG:25832", "f2", "EPSG:3005"] {
            assert!(text.contains(part), "{text}");
        }
    }

    #[test]
    fn units_of_heights_are_named_where_they_are_what_differs() {
        let of = |factors: [Option<f64>; 2]| {
            let mut files = files(&[Some(26910), Some(26910)]);
            for (file, factor) in files.iter_mut().zip(factors) {
                let unit = factor.map(|factor| Unit {
                    name: format!("unit of {factor}"),
                    factor,
                });
                file.crs.as_mut().unwrap().vertical_unit = unit;
            }
            let journal = quiet();
            let found = unify(&files, &SystemOptions::default(), &journal);
            (found.map_err(|e| e.to_string()), journal.take())
        };
        let (found, _) = of([Some(1.0), Some(0.3048)]);
        let text = found.unwrap_err();
        for part in [
            "f0 is in EPSG:26910 (S26910) with heights in units of the unit of 1, f1",
            "unit of 0.3048",
        ] {
            assert!(text.contains(part), "{text}");
        }
        let (found, notices) = of([None, Some(0.3048)]);
        assert!(found.is_ok());
        let notice = Notice::HeightsOfOthers("f0".into(), "unit of 0.3048".to_owned());
        assert_eq!(notices, [notice]);
        assert_eq!(of([None, Some(1.0)]).1, []);
    }

    #[test]
    fn what_is_not_understood_is_an_error_where_it_decides() {
        let with = |systems: &[Option<u32>], unread: &[Option<&str>]| {
            let mut files = files(systems);
            files
                .iter_mut()
                .zip(unread)
                .for_each(|(file, unread)| file.unread = unread.map(str::to_owned));
            files
        };
        let options = SystemOptions::default();
        for (systems, unread) in [
            (&[Some(25832), None][..], &[None, Some("urn:x")][..]),
            (&[None, Some(25832)], &[Some("urn:x"), None]),
            (&[None, None], &[Some("urn:x"), Some("urn:y")]),
            (&[None, None, Some(25832)], &[Some("urn:x"), None, None]),
        ] {
            let error = reconcile(&with(systems, unread), &options, &quiet()).unwrap_err();
            assert!(
                error.to_string().contains("not understood: f")
                    && error.to_string().contains("\"urn:x\""),
                "{error}"
            );
            assert!(
                error
                    .cure_text()
                    .unwrap()
                    .parts()
                    .contains(&Part::Term(Setting::Crs.text("CRS")))
            );
            let assigned = SystemOptions {
                assign: Some(crs(1, CrsKind::Projected)),
                ..SystemOptions::default()
            };
            assert!(reconcile(&with(systems, unread), &assigned, &quiet()).is_ok());
            let target = SystemOptions {
                target: Some(crs(1, CrsKind::Projected)),
                ..SystemOptions::default()
            };
            assert!(reconcile(&with(systems, unread), &target, &quiet()).is_err());
        }
        // Nothing to decide: no other file states a system, or all state the same.
        for unread in [&[Some("urn:x"), None], &[Some("urn:x"), Some("urn:x")]] {
            assert_eq!(
                reconcile(&with(&[None, None], unread), &options, &quiet())
                    .unwrap()
                    .crs,
                None
            );
        }
    }

    #[test]
    fn what_is_assigned_stands_for_what_is_stated() {
        let options = SystemOptions {
            assign: Some(crs(1, CrsKind::Projected)),
            ..SystemOptions::default()
        };
        let systems =
            reconcile(&files(&[None, Some(25832), Some(3005)]), &options, &quiet()).unwrap();
        assert_eq!(systems.crs, options.assign);
    }

    #[test]
    fn a_target_makes_different_systems_one() {
        let options = SystemOptions {
            target: Some(crs(25832, CrsKind::Projected)),
            ..SystemOptions::default()
        };
        let systems = reconcile(&files(&[Some(25832), Some(3005)]), &options, &quiet()).unwrap();
        assert_eq!(systems.crs, options.target);
        assert_eq!(systems.from, [None, Some(crs(3005, CrsKind::Projected))]);
        assert!(
            reconcile(&files(&[None]), &options, &quiet()).is_err(),
            "nothing to reproject from"
        );
        assert!(
            reconcile(&files(&[None, Some(1), Some(2)]), &options, &quiet()).is_err(),
            "which of the two?"
        );
    }

    #[test]
    fn degrees_and_geocentric_are_refused() {
        let of = |kind, degrees| {
            let stated = [Stated {
                path: "f".into(),
                crs: Some(crs(1, kind)),
                unread: None,
                role: Role::Ground,
            }];
            reconcile(
                &stated,
                &SystemOptions {
                    degrees,
                    ..SystemOptions::default()
                },
                &quiet(),
            )
        };
        let refused = of(CrsKind::Geographic, Degrees::Refuse).unwrap_err();
        assert!(
            refused
                .cure_text()
                .unwrap()
                .plain()
                .contains("force-degrees")
        );
        assert!(of(CrsKind::Geographic, Degrees::Allow).is_ok());
        assert!(
            of(CrsKind::Geocentric, Degrees::Allow)
                .unwrap_err()
                .cure_text()
                .unwrap()
                .plain()
                .contains("reproject")
        );
        assert!(of(CrsKind::Local, Degrees::Refuse).is_ok());
    }
}
