//! Surfaces in another system than that of their files.

use super::{output_of, valley};

#[test]
fn a_target_that_is_the_system_of_the_files_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("dem {} --resolution 2", valley());
    let (whole, _) = output_of(&folder, &words, "whole.tif");
    let same = format!("{words} --t-srs EPSG:25832");
    for tiles in ["", "--tiles 3x3"] {
        let (dem, said) = output_of(&folder, &format!("{same} {tiles}"), "dem.tif");
        assert!(dem == whole, "{said}");
    }
}

#[cfg(not(feature = "proj"))]
#[test]
fn without_proj_tiles_say_what_one_piece_says() {
    use super::program::files_of;
    use super::run;
    let folder = tempfile::tempdir().unwrap();
    for tiles in ["", " --tiles 3x3"] {
        let words = format!("dem {} --t-srs EPSG:25833 -o dem.tif{tiles}", valley());
        run(&folder, &words).fails(1, &["from EPSG:25832", "to EPSG:25833", "needs PROJ"]);
    }
    assert!(files_of(folder.path()).is_empty());
}

#[cfg(feature = "proj")]
mod with_proj {
    use std::collections::BTreeSet;

    use tempfile::TempDir;

    use super::super::update::stamps;
    use super::super::{assert_parts_are_whole, bytes, layer, output_of, run, valley};

    fn fixture(name: &str) -> String {
        valley().replace("valley.laz", name)
    }

    /// What a run assumes and warns of.
    fn notices(said: &str) -> BTreeSet<&str> {
        let is_notice = |line: &&str| line.starts_with("note: ") || line.starts_with("warning: ");
        said.lines().filter(is_notice).collect()
    }

    /// Fails unless a product is the same with and without tiles, and says the same.
    #[track_caller]
    fn assert_same(folder: &TempDir, words: &str, tiles: &str, extension: &str) -> Vec<u8> {
        let [whole, tiled] = ["whole", "tiled"].map(|name| format!("{name}.{extension}"));
        let (whole, of_whole) = output_of(folder, words, &whole);
        let (tiled, of_tiles) = output_of(folder, &format!("{words} {tiles}"), &tiled);
        assert!(tiled == whole, "{words} {tiles}: {of_tiles}");
        assert_eq!(notices(&of_tiles), notices(&of_whole), "{words} {tiles}");
        assert!(of_tiles.contains("reproject"), "{of_tiles}");
        whole
    }

    /// Writes a part of the valley, in another system.
    fn write_part(folder: &TempDir, name: &str, bounds: &str, system: &str) {
        let cut = format!("points {} --bounds {bounds}", valley());
        output_of(folder, &cut, "part.laz");
        output_of(folder, &format!("points part.laz --t-srs {system}"), name);
    }

    /// The valley in four files: two of its own system, one of the next zone, one in degrees.
    fn four(folder: &TempDir) {
        for (name, bounds, system) in [
            ("a.laz", "688000,5261000,688200,5261150", "EPSG:25832"),
            ("b.laz", "688200.001,5261000,688500,5261150", "EPSG:25833"),
            ("c.laz", "688000,5261150.001,688200,5261400", "EPSG:25832"),
            (
                "d.laz",
                "688200.001,5261150.001,688500,5261400",
                "EPSG:4258",
            ),
        ] {
            write_part(folder, name, bounds, system);
        }
    }

    #[test]
    fn reprojected_tiles_have_the_bytes_of_one_piece() {
        let folder = tempfile::tempdir().unwrap();
        let valley = valley();
        let [edges, area] = ["breaklines.shp", "boundary.shp"].map(fixture);
        for (words, tiles) in [
            ("--resolution 2".to_owned(), "--tiles 4x3"),
            (
                "--class 2,5 --max-edge auto --resolution 1.5".to_owned(),
                "--tiles 1x9",
            ),
            (format!("--breaklines {edges}"), "--tiles 5x5"),
            (
                format!("--breaklines {edges} --boundary {area}"),
                "--tiles auto --memory 16MB",
            ),
            (format!("--flat {area} --flat-height 400"), "--tiles 3x2"),
            (
                "--bounds 236050,5264010,236350,5264230".to_owned(),
                "--tiles 3x3",
            ),
        ] {
            let words = format!("{valley} --t-srs EPSG:25833 {words}");
            assert_same(&folder, &format!("dem {words}"), tiles, "tif");
        }
        let words = format!("{valley} --t-srs EPSG:3857 --breaklines {edges}");
        assert_same(
            &folder,
            &format!("contour {words} --interval 2"),
            "--tiles 4x4",
            "geojson",
        );
        let words = format!("hillshade {valley} --t-srs EPSG:3035 --resolution 2");
        assert_same(&folder, &words, "--tiles 4x4", "tif");
        assert_parts_are_whole(&folder, &format!("{valley} --t-srs EPSG:25833"));
    }

    #[test]
    fn files_of_several_systems_become_one_surface() {
        let folder = tempfile::tempdir().unwrap();
        four(&folder);
        // A layer in degrees, and text, which states no extent.
        let line = vec![[11.4965, 47.4762, 500.0], [11.5005, 47.4778, 510.0]];
        let line = layer(&[line], "LineString").replace("EPSG::25832", "EPSG::4258");
        std::fs::write(folder.path().join("line.geojson"), line).unwrap();
        output_of(&folder, "points a.laz --class 2", "a.xyz");
        for (words, tiles) in [
            ("a.laz b.laz c.laz d.laz", "--tiles auto"),
            ("a.laz b.laz c.laz d.laz --max-edge auto", "--tiles 6x5"),
            ("c.laz d.laz b.laz --breaklines line.geojson", "--tiles 3x3"),
            (
                "d.laz b.laz --class 2,5 --duplicates highest",
                "--memory 16MB --tiles auto",
            ),
        ] {
            let words = format!("dem {words} --t-srs EPSG:32632 --resolution 2");
            assert_same(&folder, &words, tiles, "tif");
        }
        let text = "dem a.xyz --a-srs EPSG:25832 --t-srs EPSG:31254 --max-edge auto";
        assert_same(&folder, text, "--tiles 3x3", "tif");
    }

    #[test]
    fn jobs_of_reprojected_files_go_on_and_are_updated() {
        let folder = tempfile::tempdir().unwrap();
        four(&folder);
        let words = "dem a.laz b.laz c.laz d.laz --t-srs EPSG:25832 --resolution 2";
        let (whole, _) = output_of(&folder, words, "whole.tif");
        run(
            &folder,
            &format!("job plan j -- {words} -o dem.tif --tiles 4x4"),
        )
        .works(&[]);
        for task in 0..4 {
            run(&folder, &format!("job run j --task {task}")).works(&[]);
        }
        run(&folder, "job work j").works(&[]);
        let dem = folder.path().join("dem.tif");
        assert!(bytes(&dem) == whole);
        // A file that is replaced by one of another system.
        let part = "688250,5261150.001,688500,5261400";
        write_part(&folder, "d.laz", part, "EPSG:3857");
        run(&folder, "job run j --update").works(&[]);
        let (whole, _) = output_of(&folder, words, "whole.tif");
        assert!(bytes(&dem) == whole);
        // Nothing has changed: no task is done again.
        let before = stamps(&folder, "j");
        run(&folder, "job run j --update").works(&[]);
        assert!(stamps(&folder, "j") == before);
    }

    #[test]
    fn a_file_that_is_skipped_leaves_its_hole_where_it_is_in_the_result() {
        let folder = tempfile::tempdir().unwrap();
        four(&folder);
        let path = folder.path().join("b.laz");
        let good = bytes(&path);
        std::fs::write(&path, &good[..good.len() / 2]).unwrap();
        let words = "dem a.laz b.laz c.laz d.laz --t-srs EPSG:25832 --resolution 2 -o dem.tif";
        let tiled = run(&folder, &format!("{words} --tiles 4x4 --skip-bad"));
        tiled.ends(3, &["b.laz", "is left empty"]);
        std::fs::write(&path, good).unwrap();
        let again = format!("{words} --tiles 4x4 --resume --overwrite");
        run(&folder, &again).works(&[]);
        let whole = words.replace("dem.tif", "whole.tif");
        run(&folder, &whole).works(&[]);
        let [whole, dem] = ["whole.tif", "dem.tif"].map(|name| bytes(folder.path().join(name)));
        assert!(dem == whole);
    }

    /// A header that lies by more than what boxes are enlarged by.
    #[test]
    fn a_point_outside_of_its_extent_is_an_error_in_another_system_too() {
        let folder = tempfile::tempdir().unwrap();
        let points: Vec<([f64; 3], u8)> = (0..400)
            .map(|i| ([f64::from(i % 20), f64::from(i / 20), 5.0], 2))
            .map(|([x, y, z], class)| ([688_000.0 + x, 5_261_000.0 + y, z], class))
            .collect();
        let mut file = testkit::lidar::las(&points, Some(25832));
        // The largest x.
        file[179..187].copy_from_slice(&688_010.0_f64.to_le_bytes());
        std::fs::write(folder.path().join("a.las"), file).unwrap();
        run(
            &folder,
            "dem a.las --t-srs EPSG:25833 --tiles 2x2 -o dem.tif",
        )
        .fails(
            1,
            &[
                "a.las",
                "there is a point at",
                "reprojected from EPSG:25832",
                "true header",
            ],
        );
    }
}
