//! Coordinate systems against real files, and against GDAL's reading of our text and keys (if its
//! tools are installed).

#[cfg(all(feature = "proj", feature = "cli"))]
mod heights;
mod keys;
#[cfg(feature = "proj")]
mod published;
mod real;
mod reprojection;
mod texts;

use std::process::Command;

/// The systems that a `.prj` must carry through other programs.
const CODES: &[u32] = &[
    25832, 32633, 26915, 3005, 2154, 27700, 2056, 31287, 3857, 4326, 2264, 2994, 6880, 28992, 3031,
    32661, 3035, 5070, 27572, 5514, 2953, 3395, 2193, 31467, 28356, 4258, 4269, 2949, 32128,
];

/// The output of a program; `None`, with a note, if it is not installed.
fn output(program: &str, args: &[&str]) -> Option<String> {
    match Command::new(program).args(args).output() {
        Ok(done) => Some(
            String::from_utf8_lossy(&done.stdout).into_owned()
                + &String::from_utf8_lossy(&done.stderr),
        ),
        Err(_) => {
            eprintln!("skipped: {program} is not installed");
            None
        }
    }
}

/// The code that a text of GDAL's ends with.
fn last_epsg(text: &str) -> Option<u32> {
    let at = text.rfind("\"EPSG\",")? + 7;
    text[at..]
        .trim_start_matches('"')
        .split(|c: char| !c.is_ascii_digit())
        .next()?
        .parse()
        .ok()
}

/// Invented systems, one for every method that GeoKeys can represent, as GDAL writes them.
fn custom() -> Vec<String> {
    let projected = |method: &str, parameters: &str, unit: &str| {
        format!(
            "PROJCS[\"of nobody\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],\
             PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"{method}\"],{parameters},\
             PARAMETER[\"false_easting\",1234.5],PARAMETER[\"false_northing\",-77],{unit}]"
        )
    };
    let metre = "UNIT[\"metre\",1]";
    let foot = "UNIT[\"US survey foot\",0.304800609601219]";
    let plain = "PARAMETER[\"latitude_of_origin\",47.25],PARAMETER[\"central_meridian\",13.5]";
    let scaled = format!("{plain},PARAMETER[\"scale_factor\",0.9997]");
    let conic = "PARAMETER[\"standard_parallel_1\",46],PARAMETER[\"standard_parallel_2\",48.75]";
    let center = "PARAMETER[\"latitude_of_center\",47.25],PARAMETER[\"longitude_of_center\",13.5]";
    let pole = "PARAMETER[\"latitude_of_origin\",-70],PARAMETER[\"central_meridian\",13.5]";
    vec![
        projected("Transverse_Mercator", &scaled, metre),
        projected("Transverse_Mercator", &scaled, foot),
        projected("Lambert_Conformal_Conic_1SP", &scaled, metre),
        projected(
            "Lambert_Conformal_Conic_2SP",
            &format!("{plain},{conic}"),
            foot,
        ),
        projected(
            "Albers_Conic_Equal_Area",
            &format!("{center},{conic}"),
            metre,
        ),
        projected("Oblique_Stereographic", &scaled, metre),
        projected(
            "Polar_Stereographic",
            &format!("{pole},PARAMETER[\"scale_factor\",1]"),
            metre,
        ),
        projected(
            "Mercator_1SP",
            "PARAMETER[\"central_meridian\",13.5],PARAMETER[\"scale_factor\",0.97]",
            metre,
        ),
        projected(
            "Mercator_2SP",
            "PARAMETER[\"central_meridian\",13.5],PARAMETER[\"standard_parallel_1\",42]",
            metre,
        ),
        projected("Lambert_Azimuthal_Equal_Area", center, metre),
        projected("Cassini_Soldner", plain, metre),
        projected("Polyconic", plain, metre),
        projected(
            "Hotine_Oblique_Mercator_Azimuth_Center",
            &format!(
                "{center},PARAMETER[\"azimuth\",50],PARAMETER[\"rectified_grid_angle\",50],PARAMETER[\"scale_factor\",0.9999]"
            ),
            metre,
        ),
        projected(
            "Bonne",
            "PARAMETER[\"standard_parallel_1\",44],PARAMETER[\"central_meridian\",3]",
            metre,
        ),
    ]
}
