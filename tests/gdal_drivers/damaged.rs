//! Damaged files of formats that only GDAL reads: an error or values, and never a panic or a part
//! of an output.

use testkit::random::Random;

use super::program::{files_of, run_in};
use super::{run_verb, surface};

/// Changes of each file.
const CHANGES: usize = 100;

/// Changes for which the whole program is run.
const RUNS: usize = 4;

#[test]
fn damage_ends_in_values_or_an_error() {
    let folder = surface();
    let rasters = [("HFA", "a.img"), ("netCDF", "a.nc"), ("GSBG", "a.grd")];
    let layers = [
        ("GML", "a.gml"),
        ("SQLite", "a.sqlite"),
        ("MapInfo File", "a.tab"),
    ];
    let mut random = Random(5);
    let (mut read, mut refused) = (0, 0);
    let mut count = |is_read: bool| *(if is_read { &mut read } else { &mut refused }) += 1;
    for (driver, name) in rasters.iter().chain(&layers) {
        let is_raster = rasters.contains(&(driver, name));
        let verb = if is_raster { "dem" } else { "contour" };
        run_verb(&folder, &[verb], &["-of", driver, "-o", name, "-q"]).works(&[]);
        let path = folder.path().join(name);
        let whole = std::fs::read(&path).unwrap();
        for change in 0..CHANGES {
            let mut bytes = whole.clone();
            if change % 4 == 0 {
                bytes.truncate(random.index(whole.len()));
            } else {
                for _ in 0..1 + change % 3 {
                    let at = random.index(bytes.len());
                    bytes[at] = random.below(256) as u8;
                }
            }
            std::fs::write(&path, &bytes).unwrap();
            match is_raster {
                true => {
                    let opened = breakline::io::gdal::open_raster(&path);
                    // A header may state any size.
                    let opened = opened.ok().filter(|raster| {
                        raster.frame().width.saturating_mul(raster.frame().height) < 1 << 24
                    });
                    count(opened.is_some_and(|raster| raster.read_grid().is_ok()));
                }
                false => count(breakline::io::gdal::read_layer(&path, None).is_ok()),
            }
            if change % (CHANGES / RUNS) == 0 {
                let before = files_of(folder.path());
                let args = match is_raster {
                    true => ["hillshade", name, "-o", "out.tif"],
                    false => ["tin", name, "-o", "out.ply"],
                };
                let run = run_in(&folder, &args);
                assert!(matches!(run.code, 0..=2), "{}", run.stderr);
                assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
                for out in ["out.tif", "out.ply"] {
                    let out = folder.path().join(out);
                    assert_eq!(
                        out.exists(),
                        run.code == 0 && args[3] == out.file_name().unwrap().to_str().unwrap()
                    );
                    let _ = std::fs::remove_file(out);
                }
                let after = files_of(folder.path());
                assert!(
                    after
                        .iter()
                        .all(|name| before.contains(name) || name.ends_with(".aux.xml")),
                    "{after:?}"
                );
            }
        }
        std::fs::write(&path, &whole).unwrap();
    }
    assert!(read > 20 && refused > 20, "{read} {refused}");
}
