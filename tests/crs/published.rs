//! Transforms against points that others have published.
//!
//! Each value was looked up in a text of who published it:
//! - GIGS: the test data set of the IOGP of 2022-10-12 (`IOGP-GIGS/GIGSTestDataset`), with the
//!   number of the series and its part. Geocentric coordinates have the digits of version 2.0 of
//!   2011, as PROJ has it in `test/gigs`.
//! - G7-2: the worked examples of EPSG's guidance note 7 part 2 with the code of the method, as the
//!   EPSG dataset gives them in its table of coordinate operation methods. The geocentric
//!   coordinates of 9602 have the digits of the note itself, which PROJ quotes in its page on
//!   topocentric conversions.
//! - GDA2020: the technical manual of that datum, version 1.0, as PROJ has it in
//!   `test/gie/GDA.gie`.
//! - EPSG 5438: the transformation of that code in the EPSG dataset.
//!
//! `docs/reprojection.md` names published points that differ by more than a millimeter, and why.

use breakline::crs::{Crs, Transform};
use breakline::run::proj::{TransformOptions, transform};

/// Degrees in a millimeter on the equator, about.
const MILLIMETER: f64 = 1e-3 / 111_320.0;

struct Pair {
    source: &'static str,
    from: &'static str,
    to: &'static str,
    point: [f64; 3],
    wanted: [f64; 3],
    /// Half a unit of the last digit that was published, of the point or of the result, in units of
    /// the result.
    rounded: f64,
}

const fn pair(
    source: &'static str,
    from: &'static str,
    to: &'static str,
    point: [f64; 3],
    wanted: [f64; 3],
    rounded: f64,
) -> Pair {
    Pair {
        source,
        from,
        to,
        point,
        wanted,
        rounded,
    }
}

/// Degrees of degrees, minutes and seconds.
const fn dms(degrees: f64, minutes: f64, seconds: f64) -> f64 {
    degrees + minutes / 60.0 + seconds / 3600.0
}

#[rustfmt::skip]
const PAIRS: &[Pair] = &[
    // Transverse Mercator.
    pair("GIGS 5101.2", "EPSG:4326", "EPSG:32631", [-2.0, 60.0, 0.0], [221_288.77, 6_661_953.041, 0.0], 0.0005),
    pair("GIGS 5101.2", "EPSG:4326", "EPSG:32631", [-2.0, 20.0, 0.0], [-23_538.687, 2_219_308.238, 0.0], 0.0005),
    pair("GIGS 5101.3", "EPSG:4283", "EPSG:28354", [146.0, -40.0, 0.0], [926_893.302, 5_560_253.083, 0.0], 0.0005),
    // Lambert conic conformal, with one and two parallels, in meters, grads and both feet.
    pair("GIGS 5102.1", "EPSG:4230", "EPSG:2192", [5.0, 55.0, 0.0], [772_213.973, 3_118_310.947, 0.0], 0.0005),
    pair("GIGS 5102.1", "EPSG:4230", "EPSG:2192", [4.0, 51.0, 0.0], [717_027.292, 2_668_695.784, 0.0], 0.0005),
    pair("GIGS 5102.2", "EPSG:4807", "EPSG:27572", [2.958_634_255_6, 60.0, 0.0], [776_020.989, 3_005_978.979, 0.0], 0.0005),
    pair("GIGS 5102.2", "EPSG:4807", "EPSG:27572", [1.847_523_144_4, 56.666_666_666_7, 0.0], [717_027.602, 2_668_679.866, 0.0], 0.0005),
    pair("G7-2 9801", "EPSG:4242", "EPSG:24200", [-dms(76.0, 56.0, 37.26), dms(17.0, 55.0, 55.80), 0.0], [255_966.58, 142_493.51, 0.0], 0.005),
    pair("GIGS 5103.1", "EPSG:4313", "EPSG:31370", [5.0, 55.0, 0.0], [190_604.967, 633_523.672, 0.0], 0.0005),
    pair("GIGS 5103.1", "EPSG:4313", "EPSG:31370", [4.0, 50.0, 0.0], [123_652.406, 76_521.628, 0.0], 0.0005),
    pair("GIGS 5103.2", "EPSG:4152", "EPSG:2921", [-110.0, 45.0, 0.0], [2_029_255.572, 4_985_920.564, 0.0], 0.0005),
    pair("GIGS 5103.2", "EPSG:4152", "EPSG:2921", [-108.0, 41.0, 0.0], [2_606_245.515, 3_543_182.547, 0.0], 0.0005),
    pair("GIGS 5103.3", "EPSG:4152", "EPSG:3568", [-110.0, 45.0, 0.0], [2_029_251.514, 4_985_910.592, 0.0], 0.0005),
    pair("GIGS 5103.3", "EPSG:4152", "EPSG:3568", [-108.0, 41.0, 0.0], [2_606_240.302, 3_543_175.461, 0.0], 0.0005),
    pair("G7-2 9802", "EPSG:4267", "EPSG:32040", [-96.0, 28.5, 0.0], [2_963_503.91, 254_759.80, 0.0], 0.005),
    // Oblique projections.
    pair("GIGS 5104", "EPSG:4289", "EPSG:28992", [5.0, 56.0, 0.0], [130_792.264, 890_981.281, 0.0], 0.0005),
    pair("G7-2 9809", "EPSG:4289", "EPSG:28992", [6.0, 53.0, 0.0], [196_105.283, 557_057.739, 0.0], 0.0005),
    pair("GIGS 5106", "EPSG:4742", "EPSG:3376", [117.0, 10.0, 0.0], [808_784.981, 1_107_678.473, 0.0], 0.0005),
    pair("G7-2 9815", "EPSG:4298", "EPSG:29873", [dms(115.0, 48.0, 19.8196), dms(5.0, 23.0, 14.1129), 0.0], [679_245.73, 596_562.78, 0.0], 0.005),
    // The latitude was published to 0.001 seconds, which are 31 mm.
    pair("G7-2 9819", "EPSG:4156", "EPSG:5514", [dms(16.0, 50.0, 59.179), dms(50.0, 12.0, 32.442), 0.0], [-568_991.00, -1_050_538.64, 0.0], 0.0155),
    // Others.
    pair("G7-2 9806", "EPSG:4302", "EPSG:30200", [-62.0, 10.0, 0.0], [66_644.94, 82_536.22, 0.0], 0.005),
    pair("GIGS 5109", "EPSG:4283", "EPSG:3577", [140.0, 0.0, 0.0], [966_973.979, -30_285.601, 0.0], 0.0005),
    pair("GIGS 5112", "EPSG:4284", "EPSG:3388", [54.0, 20.5, 0.0], [248_556.44, 1_724_781.5, 0.0], 0.005),
    pair("G7-2 9804", "EPSG:4257", "EPSG:3001", [120.0, -3.0, 0.0], [5_009_726.58, 569_150.82, 0.0], 0.005),
    pair("G7-2 1024", "EPSG:4326", "EPSG:3857", [-dms(100.0, 20.0, 0.0), dms(24.0, 22.0, 54.433), 0.0], [-11_169_055.58, 2_800_000.00, 0.0], 0.005),
    pair("G7-2 9820", "EPSG:4258", "EPSG:3035", [5.0, 50.0, 0.0], [3_962_799.45, 2_999_718.85, 0.0], 0.005),
    // Axes that others have in another order: north before east, and west and south.
    pair("G7-2 9810", "EPSG:4326", "EPSG:32661", [44.0, 73.0, 0.0], [3_320_416.75, 632_668.43, 0.0], 0.005),
    pair("GIGS 5113", "EPSG:4148", "EPSG:2049", [21.5, -25.0, 0.0], [-50_475.46, 2_766_147.248, 0.0], 0.005),
    // Three dimensions, and another meridian in grads.
    pair("GIGS 5201", "EPSG:4978", "EPSG:4979", [-962_479.592_4, 555_687.851_7, 6_260_738.652_6], [150.0, 80.0, 1214.137], 0.0005),
    pair("GIGS 5201", "EPSG:4978", "EPSG:4979", [2_764_210.405_4, 4_787_752.865, 3_170_468.519_9], [60.0, 30.0, 189.569], 0.0005),
    pair("G7-2 9602", "EPSG:4978", "EPSG:4979", [3_771_793.968, 140_253.342, 5_124_304.349], [dms(2.0, 7.0, 46.38), dms(53.0, 48.0, 33.82), 73.0], 0.0005),
    pair("GIGS 5208", "EPSG:4275", "EPSG:4807", [5.0, 55.0, 0.0], [2.958_634_255_6, 61.111_111_111_1, 0.0], 0.0),
    pair("GDA2020 3.1", "EPSG:4939", "EPSG:7843", [133.885_513_29, -23.670_123_89, 603.3466], [133.885_521_6, -23.670_110_14, 603.2489], 0.0005),
    // Heights in feet of both kinds, and between vertical datums: by an offset, and by an offset
    // and a slope.
    pair("1 ftUS is 1200/3937 m", "EPSG:2264+6360", "EPSG:32119+5703", [2_000_000.0, 0.0, 3937.0], [609_601.219_202, 0.0, 1200.0], 0.000_000_5),
    pair("1 ft is 0.3048 m", "EPSG:2992+8228", "EPSG:2991+5703", [1_312_335.958_005, 0.0, 1000.0], [400_000.0, 0.0, 304.8], 0.000_000_5),
    pair("EPSG 5438, 28 m", "EPSG:4200+5705", "EPSG:4200+5611", [50.0, 42.0, 2.55], [50.0, 42.0, 30.55], 0.0),
    pair("G7-2 9657", "EPSG:4258+5728", "EPSG:4258+5730", [dms(9.0, 40.0, 0.0), dms(47.0, 20.0, 0.0), 473.0], [dms(9.0, 40.0, 0.0), dms(47.0, 20.0, 0.0), 472.69], 0.005),
];

fn crs(text: &str) -> Crs {
    Crs::from_user(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn moved(operation: &dyn Transform, point: [f64; 3]) -> [f64; 3] {
    let mut points = [point];
    operation.transform(&mut points).unwrap();
    points[0]
}

fn between(from: &str, to: &str, options: &TransformOptions) -> Box<dyn Transform> {
    transform(&crs(from), &crs(to), options).unwrap_or_else(|e| panic!("{from} to {to}: {e}"))
}

/// The differences on each axis, in millimeters.
fn off(to: &Crs, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let plan = match to.length_unit() {
        Some(unit) => unit.factor * 1e3,
        // Angles as if on the equator, where they are longest.
        None => to.unit.factor.to_degrees() / MILLIMETER,
    };
    let height = to.vertical_unit.as_ref().map_or(1.0, |unit| unit.factor) * 1e3;
    [0, 1, 2].map(|k| (a[k] - b[k]).abs() * if k < 2 { plan } else { height })
}

#[test]
fn points_are_where_others_have_them_to_a_millimeter() {
    assert!(PAIRS.len() >= 30);
    let mut wrong = Vec::new();
    for Pair {
        source,
        from,
        to,
        point,
        wanted,
        rounded,
    } in PAIRS
    {
        let target = crs(to);
        let found = moved(&*between(from, to, &TransformOptions::default()), *point);
        let rounding = match target.length_unit() {
            Some(unit) => rounded * unit.factor * 1e3,
            None => rounded * 1e3,
        };
        let worst = off(&target, found, *wanted).into_iter().fold(0.0, f64::max);
        eprintln!("{source}: {from} to {to}: off by {worst:.4} mm, published to {rounding:.4} mm");
        if worst > 1.0 + rounding {
            wrong.push(format!(
                "{source}, {from} to {to}: {found:?}, published {wanted:?}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn points_come_back_to_where_they_were() {
    for Pair {
        from, to, point, ..
    } in PAIRS.iter().filter(|pair| pair.from != "EPSG:4978")
    {
        let there = moved(&*between(from, to, &TransformOptions::default()), *point);
        let back = moved(&*between(to, from, &TransformOptions::default()), there);
        let worst = off(&crs(from), back, *point)
            .into_iter()
            .fold(0.0, f64::max);
        // PROJ's inverse of the equal area of Europe is good to a third of that.
        assert!(
            worst < 1.0,
            "{from} to {to}: {point:?} comes back as {back:?}"
        );
    }
}

/// The example of the manual for plate motion: coordinates of 2018 in ITRF2014, and in GDA2020.
#[test]
fn an_epoch_moves_coordinates_with_their_plate() {
    let geocentric = [-4_052_052.658_8, 4_212_835.993_8, -2_545_104.694_6];
    let published = [-4_052_052.737_3, 4_212_835.983_5, -2_545_104.586_7];
    let target = crs("EPSG:7843");
    let wanted = moved(
        &*between("EPSG:7842", "EPSG:7843", &TransformOptions::default()),
        published,
    );
    let at = |epoch| {
        let options = TransformOptions {
            epoch,
            ..TransformOptions::default()
        };
        let operation = between("EPSG:7789", "EPSG:7843", &options);
        let found = moved(&*operation, geocentric);
        let worst = off(&target, found, wanted).into_iter().fold(0.0, f64::max);
        (worst, operation.warnings())
    };
    let (off_at_epoch, warnings) = at(Some(2018.0));
    assert!(off_at_epoch < 1.0, "{off_at_epoch} mm");
    assert!(
        !warnings.iter().any(|text| text.contains("epoch")),
        "{warnings:?}"
    );
    // Two years are 14 cm.
    let (off_without, warnings) = at(None);
    assert!((100.0..200.0).contains(&off_without), "{off_without} mm");
    assert!(
        warnings.iter().any(|text| text.contains("epoch")),
        "{warnings:?}"
    );
}
