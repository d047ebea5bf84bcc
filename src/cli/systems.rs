//! Which coordinate system the input is in, and what has to be reprojected.

use std::path::{Path, PathBuf};

use super::talk::Talk;
use crate::crs::{Crs, CrsKind};
use crate::error::{Error, Result};
use crate::run::units::Units;

/// What the user asked for.
#[derive(Debug, Clone, Default)]
pub(super) struct Wish {
    /// Takes the place of what the files say.
    pub(super) assign: Option<Crs>,
    /// Everything is reprojected to this.
    pub(super) target: Option<Crs>,
    pub(super) degrees: Degrees,
}

/// What to do about coordinates in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Degrees {
    #[default]
    Refuse,
    Allow,
}

/// What to do about coordinates that are in the wrong system. Without PROJ, `--t-srs` is no cure.
const REPROJECT: &str = if cfg!(feature = "proj") {
    "reproject with --t-srs EPSG:CODE"
} else {
    "reproject first (ogr2ogr, gdalwarp, pdal): this build is without PROJ"
};

/// A file and the system that it states.
#[derive(Debug, Clone)]
pub(super) struct Stated {
    pub(super) path: PathBuf,
    pub(super) crs: Option<Crs>,
    pub(super) role: Role,
}

/// What a file is there for. Where all else is equal, the definition of the later one is taken:
/// that of a `.prj` has shortened names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    Lines,
    Ground,
    /// A surface that is there already; it is not reprojected.
    Whole,
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Systems {
    /// What each file is reprojected from; `None` where its coordinates are taken as they are.
    pub(super) from: Vec<Option<Crs>>,
    /// The system of the result.
    pub(super) crs: Option<Crs>,
}

/// Parses what was typed for an option.
pub(super) fn parse(option: &str, typed: Option<&str>) -> Result<Option<Crs>> {
    let Some(text) = typed else { return Ok(None) };
    Crs::from_user(text).map(Some).map_err(|e| {
        let error = Error::usage(format!("{option} {text}: {e}"));
        match e.cure_text() {
            Some(cure) => error.cure(cure),
            None => error,
        }
    })
}

/// Brings the systems of all files together.
///
/// # Errors
/// If two files state different systems, the result would be in degrees or geocentric, or there is
/// nothing to reproject from.
pub(super) fn reconcile(files: &[Stated], wish: &Wish, talk: &Talk) -> Result<Systems> {
    let stated = assigned(files, wish, talk);
    let systems = match &wish.target {
        Some(target) => reproject(&stated, target, talk)?,
        None => Systems { from: vec![None; stated.len()], crs: agree(&stated, talk)? },
    };
    match &systems.crs {
        Some(crs) => judge(crs, &stated, wish.degrees, talk)?,
        None => talk.note("no coordinate system is stated: lengths are in the units of the data"),
    }
    Ok(systems)
}

/// The same where some files are not asked; they are not reprojected.
///
/// # Errors
/// As [`reconcile`].
pub(super) fn reconcile_some(files: &[Option<Stated>], wish: &Wish, talk: &Talk) -> Result<Systems> {
    let asked: Vec<Stated> = files.iter().flatten().cloned().collect();
    let Systems { from, crs } = reconcile(&asked, wish, talk)?;
    let mut from = from.into_iter();
    let from = files.iter().map(|file| file.as_ref().and_then(|_| from.next().flatten())).collect();
    Ok(Systems { from, crs })
}

fn assigned(files: &[Stated], wish: &Wish, talk: &Talk) -> Vec<Stated> {
    let Some(assign) = &wish.assign else { return files.to_vec() };
    files
        .iter()
        .map(|file| {
            if let Some(crs) = file.crs.as_ref().filter(|crs| !crs.is_same(assign)) {
                let path = file.path.display();
                talk.note(format_args!("{path} states {crs}; {assign} is taken, as --a-srs says"));
            }
            Stated { crs: Some(assign.clone()), ..file.clone() }
        })
        .collect()
}

/// The one system of all files that state any.
fn agree(files: &[Stated], talk: &Talk) -> Result<Option<Crs>> {
    let mut known = files.iter().filter_map(|file| file.crs.as_ref().map(|crs| (file, crs)));
    let Some(mut best) = known.next() else { return Ok(None) };
    for (file, crs) in known {
        if !crs.is_same(best.1) {
            return Err(two_systems(best, (file, crs)));
        }
        // The most complete definition, whatever the order of the files.
        if rank(file, crs) > rank(best.0, best.1) {
            best = (file, crs);
        }
    }
    let best = best.1;
    for file in files.iter().filter(|file| file.crs.is_none()) {
        talk.note(format_args!(
            "{} states no coordinate system; {best} is taken, as in the others",
            file.path.display()
        ));
    }
    Ok(Some(best.clone()))
}

fn rank<'a>(file: &Stated, crs: &'a Crs) -> impl PartialOrd + use<'a> {
    (crs.vertical_epsg, crs.vertical_unit.is_some(), crs.epsg, file.role, crs.wkt.as_deref(), crs.name.as_str())
}

fn two_systems((a, a_crs): (&Stated, &Crs), (b, b_crs): (&Stated, &Crs)) -> Error {
    Error::unsupported(format!(
        "two coordinate systems: {} is in {a_crs}, {} in {b_crs}",
        a.path.display(),
        b.path.display()
    ))
    .cure(format!("{REPROJECT}; or say with --a-srs CRS what all files are in"))
}

fn reproject(files: &[Stated], target: &Crs, talk: &Talk) -> Result<Systems> {
    let mut from = Vec::with_capacity(files.len());
    let common = if files.iter().any(|file| file.crs.is_none()) { agree(files, talk)? } else { None };
    for file in files {
        let Some(crs) = file.crs.as_ref().or(common.as_ref()) else {
            return Err(Error::unsupported("the file states no coordinate system to reproject from")
                .in_file(&file.path)
                .cure("say what it is in with --a-srs CRS"));
        };
        from.push(Some(crs.clone()).filter(|crs| !crs.is_same(target)));
    }
    Ok(Systems { from, crs: Some(target.clone()) })
}

/// Refuses systems whose coordinates are no lengths in a plane.
fn judge(crs: &Crs, files: &[Stated], degrees: Degrees, talk: &Talk) -> Result<()> {
    let file = files.iter().find(|file| file.crs.is_some());
    let in_file = |error: Error| match file {
        Some(file) => error.in_file(&file.path),
        None => error,
    };
    match crs.kind {
        CrsKind::Geocentric => {
            let error = Error::unsupported(format!("{crs} is geocentric: its z axis is not up"));
            return Err(in_file(error).cure(format!("{REPROJECT}, to a projected system")));
        }
        CrsKind::Geographic if degrees == Degrees::Refuse => {
            let unit = &crs.unit.name;
            let error = Error::unsupported(format!("{crs} is geographic: its unit, the {unit}, is no length"));
            let cure = match file {
                Some(Stated { role: Role::Whole, .. }) => {
                    "make it of points in a projected system (a raster: gdalwarp), or go on with --force-degrees"
                        .to_owned()
                }
                // What the format takes for granted, where it is not what the file holds.
                Some(file) if is_geojson(&file.path) => format!(
                    "GeoJSON without a `crs` member is in degrees: say with --a-srs EPSG:CODE if it is not (of a local system: \
                     --a-srs 'LOCAL_CS[\"local\",UNIT[\"metre\",1]]'); if it is, {REPROJECT}"
                ),
                _ => format!("{REPROJECT}, to a projected system, or go on with --force-degrees"),
            };
            return Err(in_file(error).cure(cure));
        }
        _ => {}
    }
    if let Some((plan, height)) = Units::of(Some(crs)).disagreement() {
        talk.note(format_args!("the plan is in units of the {plan}, heights are in units of the {height}"));
    }
    Ok(())
}

fn is_geojson(path: &Path) -> bool {
    path.extension().is_some_and(|e| ["geojson", "json"].iter().any(|known| e.eq_ignore_ascii_case(known)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::Unit;

    fn crs(code: u32, kind: CrsKind) -> Crs {
        let unit = Unit { name: "metre".to_owned(), factor: 1.0 };
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
                role: Role::Ground,
            })
            .collect()
    }

    fn quiet() -> Talk {
        Talk::new(&super::super::args::TalkArgs { quiet: true, verbose: false, threads: None })
    }

    #[test]
    fn a_file_without_a_system_takes_that_of_the_others() {
        let systems = reconcile(&files(&[None, Some(25832), None]), &Wish::default(), &quiet()).unwrap();
        assert_eq!(systems.crs.unwrap().epsg, Some(25832));
        assert_eq!(systems.from, [None, None, None]);
    }

    #[test]
    fn two_systems_are_an_error_that_names_both_and_the_files() {
        let error = reconcile(&files(&[None, Some(25832), Some(3005)]), &Wish::default(), &quiet()).unwrap_err();
        let text = error.to_string();
        for part in ["f1", "EPSG:25832", "f2", "EPSG:3005"] {
            assert!(text.contains(part), "{text}");
        }
    }

    #[test]
    fn what_is_assigned_takes_the_place_of_what_is_stated() {
        let wish = Wish { assign: Some(crs(1, CrsKind::Projected)), ..Wish::default() };
        let systems = reconcile(&files(&[None, Some(25832), Some(3005)]), &wish, &quiet()).unwrap();
        assert_eq!(systems.crs, wish.assign);
    }

    #[test]
    fn a_target_makes_different_systems_one() {
        let wish = Wish { target: Some(crs(25832, CrsKind::Projected)), ..Wish::default() };
        let systems = reconcile(&files(&[Some(25832), Some(3005)]), &wish, &quiet()).unwrap();
        assert_eq!(systems.crs, wish.target);
        assert_eq!(systems.from, [None, Some(crs(3005, CrsKind::Projected))]);
        assert!(reconcile(&files(&[None]), &wish, &quiet()).is_err(), "nothing to reproject from");
        assert!(reconcile(&files(&[None, Some(1), Some(2)]), &wish, &quiet()).is_err(), "which of the two?");
    }

    #[test]
    fn degrees_and_geocentric_are_refused() {
        let of = |kind, degrees| {
            let stated = [Stated { path: "f".into(), crs: Some(crs(1, kind)), role: Role::Ground }];
            reconcile(&stated, &Wish { degrees, ..Wish::default() }, &quiet())
        };
        assert!(of(CrsKind::Geographic, Degrees::Refuse).unwrap_err().cure_text().unwrap().contains("--force-degrees"));
        assert!(of(CrsKind::Geographic, Degrees::Allow).is_ok());
        assert!(of(CrsKind::Geocentric, Degrees::Allow).unwrap_err().cure_text().unwrap().contains("reproject"));
        assert!(of(CrsKind::Local, Degrees::Refuse).is_ok());
    }
}
