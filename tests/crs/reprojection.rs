//! Reprojection, with PROJ or without.

#[cfg(not(feature = "proj"))]
#[test]
fn without_proj_the_error_says_how_to_get_it() {
    let crs = |code| breakline::crs::Crs::from_epsg(code).unwrap();
    let error = breakline::run::proj::transform(&crs(4326), &crs(32633), &Default::default())
        .err()
        .unwrap();
    assert!(
        error
            .to_string()
            .contains("EPSG:4326 (WGS 84) to EPSG:32633"),
        "{error}"
    );
    assert!(
        error
            .cure_text()
            .unwrap()
            .plain()
            .contains("feature `proj`")
    );
}

#[cfg(feature = "proj")]
mod with_proj {
    use breakline::crs::Crs;
    use breakline::crs::Transform;
    use breakline::error::Result;
    use breakline::run::proj::{self, TransformOptions};

    fn crs(text: &str) -> Crs {
        Crs::from_user(text).unwrap()
    }

    fn transform(from: &Crs, to: &Crs) -> Result<Box<dyn Transform>> {
        proj::transform(from, to, &TransformOptions::default())
    }

    fn check(from: &str, to: &str, point: [f64; 3], wanted: [f64; 3], within: f64) -> Vec<String> {
        let operation = transform(&crs(from), &crs(to)).unwrap();
        let mut points = [point];
        operation.transform(&mut points).unwrap();
        let off = points[0]
            .iter()
            .zip(wanted)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(
            off < within,
            "{from} to {to}: {:?} instead of {wanted:?}",
            points[0]
        );
        let warnings = operation.warnings();
        eprintln!("{from} to {to}: {warnings:?}");
        warnings
    }

    #[test]
    fn places_are_where_proj_says() {
        // cs2cs of PROJ 9.6 (Debian's 9.1 agrees to the last digit).
        let none = check(
            "EPSG:4326",
            "EPSG:32633",
            [15.5, 47.0, 9.0],
            [538012.75499, 5205285.41538, 9.0],
            1e-4,
        );
        assert!(none.is_empty(), "{none:?}");
        check(
            "EPSG:32633",
            "EPSG:4326",
            [538012.75499, 5205285.41538, 9.0],
            [15.5, 47.0, 9.0],
            1e-9,
        );
        // Feet to metres, heights too.
        let feet = check(
            "EPSG:2264+6360",
            "EPSG:32119+5703",
            [2_000_000.0, 0.0, 3937.0],
            [609_601.219_202_4, 0.0, 1200.0],
            1e-3,
        );
        assert!(feet.is_empty(), "{feet:?}");
    }

    #[test]
    fn helmert_paths_are_taken_and_their_accuracy_is_reported() {
        // cs2cs of PROJ 9.1 without grids (which prints the Austrian northing first).
        for (code, position, wanted) in [
            ("EPSG:27700", [-1.5, 52.5], [434_039.457_29, 289_239.281_09]),
            (
                "EPSG:2056",
                [7.5, 47.0],
                [2_604_667.476_42, 1_205_439.960_18],
            ),
            ("EPSG:31287", [13.5, 47.5], [412_608.702_49, 400_070.560_75]),
        ] {
            let [x, y] = position;
            let warnings = check(
                "EPSG:4326",
                code,
                [x, y, 100.0],
                [wanted[0], wanted[1], 100.0],
                1e-4,
            );
            assert!(
                warnings.iter().any(|text| text.contains("accura")),
                "{code}: {warnings:?}"
            );
            // Two millimetres: in plan, PROJ drops the height between the ellipsoids on both ways.
            check(
                code,
                "EPSG:4326",
                [wanted[0], wanted[1], 100.0],
                [x, y, 100.0],
                2e-8,
            );
        }
    }

    #[test]
    fn heights_that_stay_are_reported() {
        let warnings = check(
            "EPSG:4326+5773",
            "EPSG:4979",
            [15.5, 47.0, 300.0],
            [15.5, 47.0, 300.0],
            1e-9,
        );
        assert!(
            warnings
                .iter()
                .any(|text| text.contains("heights keep their datum")),
            "{warnings:?}"
        );
        let warnings = check(
            "EPSG:25832+7837",
            "EPSG:25833",
            [700_000.0, 5_300_000.0, 300.0],
            [250_912.281_132, 5_301_906.474_428, 300.0],
            1e-5,
        );
        assert!(
            warnings
                .iter()
                .any(|text| text.contains("heights are left as they are")),
            "{warnings:?}"
        );
    }

    #[test]
    fn geocentric_files_become_maps() {
        // cs2cs EPSG:4978 EPSG:4979
        let warnings = check(
            "EPSG:4978",
            "EPSG:4326",
            [4_194_423.0, 1_162_702.0, 4_647_245.0],
            [15.493_474_331_5, 47.067_133_849, 537.325_021_646_9],
            1e-6,
        );
        assert!(
            warnings.iter().any(|text| text.contains("ellipsoid")),
            "{warnings:?}"
        );
        assert!(transform(&crs("EPSG:4326"), &crs("EPSG:4978")).is_err());
    }

    #[test]
    fn definitions_without_a_code_are_reprojected() {
        let own =
            Crs::from_wkt(&crs("EPSG:25832").to_prj().replace("500000.0", "500010.0")).unwrap();
        assert_eq!(own.epsg, None);
        let operation = transform(&own, &crs("EPSG:25832")).unwrap();
        let mut points = [[600_010.0, 5_300_000.0, 1.0]];
        operation.transform(&mut points).unwrap();
        assert!((points[0][0] - 600_000.0).abs() < 1e-6, "{points:?}");
    }

    #[test]
    fn a_point_that_fails_is_named_with_both_systems() {
        let operation = transform(&crs("EPSG:4326"), &crs("EPSG:32633")).unwrap();
        let error = operation
            .transform(&mut [[15.0, 47.0, 0.0], [15.0, 4700.0, 0.0]])
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("(15, 4700)")
                && error.contains("EPSG:4326")
                && error.contains("EPSG:32633"),
            "{error}"
        );
        let local = Crs::from_wkt("LOCAL_CS[\"site\",UNIT[\"metre\",1]]").unwrap();
        assert!(
            transform(&local, &crs("EPSG:32633"))
                .err()
                .unwrap()
                .to_string()
                .contains("local")
        );
    }

    #[test]
    fn threads_agree() {
        let operation = transform(&crs("EPSG:31287"), &crs("EPSG:25833")).unwrap();
        let run = || {
            let mut points: Vec<[f64; 3]> = (0..1000)
                .map(|i| [400_000.0 + f64::from(i), 400_000.0, 0.0])
                .collect();
            operation.transform(&mut points).unwrap();
            points
        };
        let here = run();
        std::thread::scope(|scope| {
            for thread in (0..4).map(|_| scope.spawn(run)).collect::<Vec<_>>() {
                assert_eq!(thread.join().unwrap(), here);
            }
        });
    }
}
