//! Outputs by drivers, in tiles.

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
    let header = std::fs::read_to_string(folder.path().join("a.hdr")).unwrap();
    assert!(header.contains("interleave = bil"), "{header}");
    // Where nothing has changed, the output stays; else it is written again, by the driver.
    let update = |said: &[&str]| {
        let options = [&written[..], &tiles, &["--update"]].concat();
        run_verb(&folder, &["dem"], &options).works(said);
    };
    update(&[]);
    let points = folder.path().join("points.xyz");
    let more = std::fs::read_to_string(&points).unwrap() + "500003.5 5300002.5 150\n";
    std::fs::write(&points, more).unwrap();
    update(&["written     a.dat"]);
    let cells = open_raster(folder.path().join("a.dat")).unwrap();
    assert!(cells.read_grid().unwrap().values.contains(&150.0));
    let plan = [
        "job",
        "plan",
        "other",
        "--",
        "dem",
        "points.xyz",
        "--of",
        "HFA",
        "-o",
        "c.img",
    ];
    super::run_in(&folder, &plan).works(&[]);
    super::run_in(&folder, &["job", "run", "other"]).works(&[]);
    assert!(open_raster(folder.path().join("c.img")).is_ok());
}
