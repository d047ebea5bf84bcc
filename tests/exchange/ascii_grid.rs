//! ESRI ASCII grids as DEMs.

use breakline::data::Frame;
use breakline::io::{ascii_grid, geotiff};

use crate::program::{folder_with, run_in};
use crate::refused;

#[test]
fn corners_centers_and_rectangular_cells_are_understood() {
    let folder = folder_with(&[]);
    let path = folder.path().join("a.asc");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let opened = ascii_grid::open(&path)?;
        let (grid, warnings) = opened.read_grid_with(&|_| Ok(()))?;
        assert!(warnings.is_empty());
        breakline::Result::Ok(grid)
    };
    let text = "ncols 3\nnrows 2\nxllcorner 100.5\nyllcorner 200\ncellsize 2\n\
                NODATA_value -99\n1 2.5 -99\n4e0 nan\n6\n";
    let grid = read(text).unwrap();
    assert_eq!(grid.frame, Frame::north_up(100.5, 204.0, 2.0, 3, 2));
    let bits: Vec<Option<f64>> = grid
        .values
        .iter()
        .map(|z| Some(*z).filter(|z| !z.is_nan()))
        .collect();
    assert_eq!(
        bits,
        [Some(1.0), Some(2.5), None, Some(4.0), None, Some(6.0)]
    );
    let centers = text
        .replace("xllcorner 100.5", "XLLCENTER\t101.5")
        .replace("yllcorner 200", "YllCenter 201")
        .replace('\n', "\r\n");
    assert_eq!(read(&centers).unwrap().frame, grid.frame);
    let sides = text.replace("cellsize 2", "dx 2\ndy 3");
    let frame = read(&sides).unwrap().frame;
    assert_eq!(frame.transform, [100.5, 2.0, 0.0, 206.0, 0.0, -3.0]);
    let changes = [
        (
            "ncols 3",
            "ncols 4",
            "line 10: the file ends after 6 of 4 x 2 cells",
        ),
        (
            "ncols 3",
            "ncols 2",
            "line 8: 'nan' follows the last of 2 x 2 cells",
        ),
        (
            "ncols 3",
            "ncols 30000000000",
            "header: a raster of 30000000000 x 2 cells",
        ),
        (
            "ncols 3",
            "ncols 2000000000",
            "header: 2000000000 x 2 cells need more text",
        ),
        (
            "ncols 3",
            "ncols -3",
            "line 1: -3 is out of range for the number of columns",
        ),
        (
            "nrows 2\n",
            "",
            "header: the header does not state ncols and nrows",
        ),
        (
            "cellsize 2",
            "cellsize 0",
            "line 5: a cell of 0, expected a positive size",
        ),
        (
            "cellsize 2",
            "cellsize 0,5",
            "line 5: '0,5' has a comma, expected a decimal point",
        ),
        (
            "cellsize 2",
            "cellsise 2",
            "line 5: 'cellsise' is not a key of an ASCII grid",
        ),
        (
            "cellsize 2\n",
            "",
            "header: the header does not state cellsize",
        ),
        (
            "xllcorner 100.5\n",
            "",
            "header: the header does not state xllcorner",
        ),
        ("2.5", "2,5", "line 7: '2,5' is not a height"),
        ("2.5", "inf", "line 7: 'inf' is not a height"),
    ];
    refused::with_each_change(text, "a.asc: ", read, &changes);
}

#[test]
fn a_dem_comes_back_to_the_bit_and_is_used_like_a_geotiff() {
    let points: String = (0..100)
        .map(|i| (f64::from(i % 10), f64::from(i / 10)))
        .map(|(x, y)| {
            format!(
                "{} {} {}\n",
                500_000.1 + x,
                5_400_000.3 + y,
                100.0 + (x * y).sin()
            )
        })
        .collect();
    let folder = folder_with(&[("a.xyz", &points)]);
    let dem = |name: &str| {
        let args = [
            "dem",
            "a.xyz",
            "--a-srs",
            "EPSG:25832",
            "--resolution",
            "0.3",
            "-o",
            name,
        ];
        run_in(&folder, &args).works(&["written"]);
    };
    dem("a.tif");
    dem("a.asc");
    let text = std::fs::read_to_string(folder.path().join("a.asc")).unwrap();
    assert!(
        text.starts_with("ncols 30\nnrows 30\nxllcorner 500000.1\nyllcorner 5400000.3\ncellsize 0.3\nNODATA_value -9999\n"),
        "{}",
        &text[..200]
    );
    assert!(folder.path().join("a.prj").exists());
    let tif = geotiff::open(folder.path().join("a.tif"))
        .unwrap()
        .read_grid()
        .unwrap();
    let asc = ascii_grid::open(folder.path().join("a.asc")).unwrap();
    let (asc, _) = asc.read_grid_with(&|_| Ok(())).unwrap();
    assert_eq!(asc.frame, tif.frame);
    assert_eq!(asc.crs.as_ref().unwrap().epsg, Some(25832));
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|z| (*z as f32).to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&asc.values), bits(&tif.values));
    run_in(&folder, &["info", "a.asc"]).ends(0, &["ESRI ASCII grid", "EPSG:25832"]);
    // Decimals are read as doubles, which differ from the floats of the other in the last digits.
    let contours = |input: &str, output: &str| {
        run_in(&folder, &["contour", input, "-i", "0.25", "-o", output]).works(&["contours"]);
        let text = std::fs::read_to_string(folder.path().join(output)).unwrap();
        text.matches("LineString").count()
    };
    let lines = contours("a.tif", "one.geojson");
    assert!(lines > 10);
    assert_eq!(contours("a.asc", "other.geojson"), lines);
    run_in(
        &folder,
        &[
            "dem",
            "a.xyz",
            "--a-srs",
            "EPSG:25832",
            "--align-to",
            "a.asc",
            "-o",
            "b.tif",
        ],
    )
    .works(&["written"]);
    run_in(
        &folder,
        &["dem", "a.xyz", "-o", "a.prj.asc", "--resolution", "1"],
    )
    .works(&["written"]);
    assert!(
        !folder.path().join("a.prj.prj").exists(),
        "no system is known"
    );
}

#[test]
fn a_mark_of_utf8_is_no_part_of_the_header() {
    let folder = folder_with(&[]);
    let path = folder.path().join("a.asc");
    let text =
        "\u{feff}ncols 2\r\nnrows 1\r\nxllcorner 0\r\nyllcorner 0\r\ncellsize 2\r\n5 -9999\r\n";
    std::fs::write(&path, text).unwrap();
    let (grid, _) = ascii_grid::open(&path)
        .unwrap()
        .read_grid_with(&|_| Ok(()))
        .unwrap();
    assert!(grid.values[0] == 5.0 && grid.values[1].is_nan());
    let info = run_in(&folder, &["info", "a.asc"]).stdout;
    assert!(info.contains("2 x 1 cells"), "{info}");
}

#[test]
fn a_height_that_stands_for_none_is_refused() {
    let folder = folder_with(&[("p.xyz", "0 0 -9999\n2 0 -9999\n0 2 -9999\n2 2 -9999\n")]);
    let run = run_in(
        &folder,
        &["dem", "p.xyz", "--resolution", "1", "-o", "a.asc"],
    );
    run.fails(
        1,
        &[
            "a.asc: row 1, column 1: the height -9999 stands for a cell without data",
            "write .tif",
        ],
    );
    assert!(!folder.path().join("a.asc").exists());
}
