//! Heights in colors.

use super::{SLOPE, bytes, files_of, folder_with, run_in};

/// All cells of a GeoTIFF with four bytes each.
fn colors(bytes: Vec<u8>) -> (u32, Vec<[u8; 4]>) {
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).unwrap();
    let (width, _) = decoder.dimensions().unwrap();
    assert_eq!(
        decoder.colortype().unwrap(),
        tiff::ColorType::RGBA(8),
        "GDAL and others read opacity"
    );
    let tiff::decoder::DecodingResult::U8(samples) = decoder.read_image().unwrap() else {
        panic!("not bytes")
    };
    let pixels = samples.as_chunks::<4>().0.to_vec();
    (width, pixels)
}

#[test]
fn slopes_of_faces_are_those_of_triangles() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let of = |words: &[&str]| {
        let mut all = vec!["slope", "--formula", "faces", "-o", "s.tif", "--overwrite"];
        all.extend(words);
        run_in(&folder, &all)
    };
    of(&["a.xyz", "--percent"]).works(&["100"]);
    run_in(&folder, &["dem", "a.xyz", "-o", "d.tif"]).works(&[]);
    of(&["d.tif"]).fails(
        2,
        &[
            "--formula is that of faces, and a raster has none",
            "pass points, a .tin or a .ply",
        ],
    );
    of(&["a.xyz", "--method", "smooth"]).fails(2, &["leave out --method"]);
    run_in(
        &folder,
        &["tri", "a.xyz", "--formula", "faces", "-o", "t.tif"],
    )
    .fails(2, &["faces"]);
}

#[test]
fn of_several_bands_the_first_is_named() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["color-relief", "a.xyz", "-o", "c.tif"]).works(&[]);
    run_in(&folder, &["hillshade", "c.tif", "-o", "h.tif"])
        .works(&["note: c.tif: band 1 of 4 is used"]);
}

#[test]
fn overviews_may_be_left_out_in_one_piece_and_in_tiles() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let of = |words: &[&str]| {
        let common = [
            "a.xyz",
            "--resolution",
            "0.005",
            "-o",
            "out.tif",
            "--overwrite",
        ];
        run_in(&folder, &[words, &common].concat()).works(&[]);
        bytes(&folder, "out.tif")
    };
    for verb in ["dem", "hillshade", "slope"] {
        let whole = of(&[verb]);
        let without = of(&[verb, "--overviews", "none"]);
        assert!(without.len() < whole.len(), "{verb}");
        assert!(of(&[verb, "-co", "OVERVIEWS=NONE"]) == without, "{verb}");
        assert!(of(&[verb, "--overviews", "none", "--tiles", "2x2"]) == without);
        assert!(of(&[verb, "--overviews", "auto", "--tiles", "2x2"]) == whole);
        let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(without)).unwrap();
        assert!(!decoder.more_images());
        let cells = format!("{:?}", decoder.read_image().unwrap());
        let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(whole)).unwrap();
        assert!(format!("{:?}", decoder.read_image().unwrap()) == cells && decoder.more_images());
    }
}

#[test]
fn colors_follow_from_heights_in_a_tin_and_in_a_dem() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        (
            "r.txt",
            "nv 1 2 3 4\n10 blue\n11:0,100\t0 128 # here\n/ end\n13 red\n",
        ),
    ]);
    let dem = ["dem", "a.xyz", "--resolution", "1", "--te", "-1,0,3,3"];
    run_in(&folder, &[&dem[..], &["-o", "d.tif"]].concat()).works(&[]);
    // Heights of a row: none, 10.5, 11.5, 12.5.
    let linear = [
        [1, 2, 3, 4],
        [0, 50, 128, 192],
        [64, 75, 0, 160],
        [191, 25, 0, 223],
    ];
    let nearest = [
        [1, 2, 3, 4],
        [0, 100, 0, 128],
        [0, 100, 0, 128],
        [255, 0, 0, 255],
    ];
    for (matching, expected) in [("linear", linear), ("nearest", nearest)] {
        for surface in [
            &["d.tif"][..],
            &["a.xyz", "--resolution", "1", "--te", "-1,0,3,3"],
        ] {
            let mut words = vec!["color-relief", "--ramp", "r.txt", "--match", matching];
            words.extend(surface);
            words.extend(["-o", "c.tif", "-o", "c.png", "--overwrite"]);
            run_in(&folder, &words).works(&[
                "4 x 3 cells",
                "written     c.tif",
                "written     c.png",
            ]);
            let (width, found) = colors(bytes(&folder, "c.tif"));
            assert_eq!(width, 4);
            for row in found.chunks(4) {
                assert_eq!(row, expected, "{matching} of {surface:?}");
            }
            assert!(files_of(folder.path()).contains(&"c.pgw".to_owned()));
            run_in(&folder, &["info", "c.png"]).works(&[]);
        }
    }
    run_in(&folder, &["info", "c.tif"]).works(&[]);
    // As gdaldem is typed.
    let typed = [
        "color-relief",
        "d.tif",
        "r.txt",
        "g.tif",
        "-alpha",
        "-nearest_color_entry",
    ];
    run_in(&folder, &typed).works(&["written     g.tif"]);
    assert_eq!(bytes(&folder, "g.tif"), bytes(&folder, "c.tif"));
}

#[test]
fn ramps_that_are_built_in_go_from_the_lowest_to_the_highest_cell() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let words = "color-relief a.xyz --resolution 1 --ramp gray -o c.tif";
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
    let grays: Vec<u8> = colors(bytes(&folder, "c.tif"))
        .1
        .iter()
        .map(|c| c[0])
        .collect();
    assert_eq!(grays, [0, 128, 255, 0, 128, 255, 0, 128, 255]);
    // By default, colors that are not gray.
    run_in(&folder, &["color-relief", "a.xyz", "-o", "d.tif"]).works(&[]);
    let [red, green, ..] = colors(bytes(&folder, "d.tif")).1[0];
    assert_ne!(red, green);
}

#[test]
fn what_is_no_ramp_is_refused_and_nothing_is_written() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("bad.txt", "0 red\n100 1 2 256\n"),
        ("r.png", "0 red\n100 blue\n"),
    ]);
    let before = files_of(folder.path());
    for (code, words, said) in [
        (
            2,
            "--ramp rainbow -o c.tif",
            "--ramp rainbow: there is no such ramp",
        ),
        (2, "--ramp rainbow -o c.tif", "elevation, gray, viridis"),
        (
            1,
            "--ramp bad.txt -o c.tif",
            "bad.txt: line 2: `256` in a color",
        ),
        (1, "--ramp bad.txt -o c.tif", "`50% red`"),
        (2, "--match best -o c.tif", "linear, nearest, exact"),
        (2, "-o c.doc", ".tif, .tiff, .png"),
        (2, "--ramp r.png -o r.png --overwrite", "one of the inputs"),
    ] {
        let words = format!("color-relief a.xyz {words}");
        run_in(&folder, &words.split(' ').collect::<Vec<_>>()).fails(code, &[said]);
    }
    assert_eq!(files_of(folder.path()), before);
}
