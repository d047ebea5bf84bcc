//! Outputs by drivers, run_verb in tiles.

use breakline::io::gdal::open_raster;

use super::program::files_of;
use super::{run_verb, surface};

#[test]
fn tiles_give_the_same_rasters_and_layers() {
    let folder = surface();
    run_verb(&folder, &["dem"], &["-o", "a.img", "-o", "a.tif"]).works(&[]);
    let tiles = ["--tiles", "2x2"];
    run_verb(&folder, &["dem"], &[&["-o", "b.img"], &tiles[..]].concat())
        .works(&["written     b.img"]);
    let cells = |name: &str| {
        let grid = open_raster(folder.path().join(name))
            .unwrap()
            .read_grid()
            .unwrap();
        grid.values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<u64>>()
    };
    assert_eq!(cells("a.img"), cells("b.img"));
    run_verb(&folder, &["contour"], &["-o", "a.mif"]).works(&[]);
    run_verb(
        &folder,
        &["contour"],
        &[&["-o", "b.mif"], &tiles[..]].concat(),
    )
    .works(&[]);
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(text("a.mid"), text("b.mid"));
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.contains("job") || name.starts_with('.'))
    );
}

#[test]
fn a_job_keeps_its_driver() {
    let folder = surface();
    let tiles = ["--tiles", "2x2", "--job", "job"];
    let written = ["-of", "ENVI", "-o", "a.dat", "-co", "INTERLEAVE=BIL"];
    run_verb(&folder, &["dem"], &[&written[..], &tiles].concat()).works(&[]);
    // As it was written, it is found again.
    run_verb(
        &folder,
        &["dem"],
        &[&written[..], &tiles, &["--resume"]].concat(),
    )
    .works(&[]);
    let header = std::fs::read_to_string(folder.path().join("a.hdr")).unwrap();
    assert!(header.contains("interleave = bil"), "{header}");
    super::run_in(
        &folder,
        &[
            "job",
            "plan",
            "dem",
            "points.xyz",
            "-of",
            "HFA",
            "-o",
            "c.img",
            "--job",
            "other",
        ],
    )
    .works(&[]);
    super::run_in(&folder, &["job", "run", "other"]).works(&[]);
    assert!(open_raster(folder.path().join("c.img")).is_ok());
}
