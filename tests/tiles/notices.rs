//! What one piece reports, tiles report, too.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use breakline::crs::Crs;
use breakline::data::{Bounds, Return};
use breakline::error::Wording;
use breakline::run::{
    self, Context, ContourOptions, Degrees, DemOptions, Division, EdgeLimit, Execution,
    FlatOptions, FrameOptions, HillshadeOptions, Input, JobCommand, LightOptions, LineRequest,
    LowerEdge, MapOptions, Monitor, Notice, PerRecord, Progress, Severity, Size, Source, Stage,
    StoredJob, SurfaceRequest, SystemOptions, Targets, TileOptions, TinRequest, Verb, WallOptions,
    WriteRequest,
};
use breakline::terrain::Classes;
use testkit::lidar::{las, las_with_heights_in_feet, tile};

use super::layer;

/// The kinds of notices that tiles do not have, and why.
const NOT_IN_TILES: &[(&str, &str)] = &[
    ("LittleMemory", "tiles are chosen to fit into memory"),
    ("MemoryUnused", "tiles cannot be made"),
    (
        "BuiltInFiles",
        "of verbs that ask a surface, such as `volume`",
    ),
    ("OutputMayNotFit", "depends on the disk"),
    ("Triangulated", "a time; each task has its own"),
    ("Uncertain", "tiles use all points, whatever the bounds"),
    ("FilesOutside", "tiles use all points, whatever the bounds"),
    ("NodesRead", "tiles use all points, whatever the bounds"),
    (
        "PartForLinear",
        "of other methods than linear, which tiles refuse",
    ),
    ("Reprojecting", "needs PROJ, see the tests of reprojection"),
    ("Transform", "needs PROJ, see the tests of reprojection"),
    ("FlatTriangles", "of surfaces of lines; tiles need points"),
    ("RidgesAdded", "tiles refuse --add-ridges"),
    ("GroundFound", "tiles refuse --ground"),
    ("GroundInDoubt", "of `ground`"),
    ("OctreeLeftOut", "of `ground`"),
    ("Simplified", "of `tin`, in one piece only"),
    ("HeightsAboveEllipsoid", "of `terrain-tiles`"),
    ("BeyondBound", "of `terrain-tiles`"),
    ("BeyondTolerance", "of numbers with too few digits"),
    ("DelaunayUnchecked", "of `check`"),
    ("RegionAreasUnused", "of `triangulate`"),
    ("SeedUnused", "of `triangulate`"),
    ("PolygonsOutside", "of `volume`"),
    ("FacesOverlap", "of `volume`"),
    ("RingsOverlap", "of `volume`"),
    ("PolygonsPartlyOutside", "of `volume`"),
    ("LinesOff", "of `drape` and `profile`"),
    ("LinesPartlyOff", "of `drape` and `profile`"),
    ("LinesWithoutLength", "of `drape` and `profile`"),
    ("SectionsCross", "of `profile`"),
    ("AttributesLeftOut", "of `drape`"),
    ("PointsOutside", "of `sample`"),
    ("CheckpointsOutside", "of `accuracy`"),
    ("FewCheckpoints", "of `accuracy`"),
    ("HeightsInMeters", "of `accuracy`"),
    ("FirstOfBands", "of rasters, which have no tiles"),
];

/// The kinds of notices that only tiles have, and why.
const IN_TILES_ONLY: &[(&str, &str)] = &[
    ("TasksMayNotFit", "depends on the disk"),
    (
        "OfTask",
        "a notice of any kind, as the file of a task keeps it",
    ),
    ("Skipped", "of `--skip-bad`, see the tests of bad input"),
];

/// A request, and notices that one piece must have.
struct Case {
    request: TinRequest,
    systems: SystemOptions,
    verb: Arc<dyn Verb>,
    kinds: &'static [&'static str],
}

/// Keeps all notices.
#[derive(Default)]
struct Collector(Mutex<Vec<Notice>>);

impl Monitor for Collector {
    fn start(&self, _: Stage, _: Size) -> Box<dyn Progress> {
        Box::new(())
    }

    fn notice(&self, notice: &Notice) {
        self.0.lock().unwrap().push(notice.clone());
    }
}

/// The name of the kind of a notice.
fn kind(notice: &Notice) -> String {
    let text = format!("{notice:?}");
    text.split([' ', '(', '{']).next().unwrap().to_owned()
}

/// Returns how much each notice matters, with its text and its details.
fn texts(notices: &[Notice]) -> BTreeSet<(Severity, String, Vec<String>)> {
    let data = |text: &Wording| format!("{text:?}");
    let each = |notice: &Notice| {
        (
            notice.severity(),
            data(&notice.text()),
            notice.details().iter().map(data).collect(),
        )
    };
    notices.iter().map(each).collect()
}

impl Case {
    fn request(&self) -> WriteRequest {
        let source = Source::Points(Box::new(self.request.clone()));
        let surface = SurfaceRequest {
            source,
            systems: self.systems.clone(),
        };
        WriteRequest {
            surface,
            verb: Arc::clone(&self.verb),
        }
    }

    /// A file of the product.
    fn target(&self, folder: &Path) -> Targets {
        let name = if self.verb.name() == "contour" {
            "out.geojson"
        } else {
            "out.tif"
        };
        Targets::of(folder.join(name))
    }
}

fn notices_of_whole(case: &Case, folder: &Path) -> Vec<Notice> {
    let collector = Collector::default();
    let context = Context {
        monitor: &collector,
        ..Context::default()
    };
    let targets = case.target(folder);
    run::write(&case.request(), &targets, &Execution::Whole, &context).unwrap();
    fs::remove_file(&targets.files[0]).unwrap();
    collector.0.into_inner().unwrap()
}

fn notices_of_tiles(case: &Case, division: Division, folder: &Path) -> Vec<Notice> {
    let collector = Collector::default();
    let context = Context {
        monitor: &collector,
        ..Context::default()
    };
    let (request, targets, job) = (case.request(), case.target(folder), folder.join("job"));
    let options = TileOptions {
        division,
        ..TileOptions::default()
    };
    let command = JobCommand::new(&request, &targets, &options).unwrap();
    let planned = run::plan_job(&command, &job, &context).unwrap();
    let tasks = planned.job().unwrap();
    let lock = tasks.lock(&Context::default()).unwrap();
    tasks.run(&lock, &Context::default()).unwrap();
    drop(lock);
    // As another process would go on.
    run::run_job(&StoredJob::read(&job).unwrap(), &context).unwrap();
    fs::remove_file(&targets.files[0]).unwrap();
    planned.remove(&context).unwrap();
    collector.0.into_inner().unwrap()
}

/// Files of points and of lines.
struct Files<'a>(&'a Path);

impl Files<'_> {
    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    /// A square of 4 by 4 points of one class.
    fn tile(&self, name: &str, corner: [f64; 2], class: u8) -> PathBuf {
        self.write(name, las(&tile(corner, class), Some(25832)))
    }

    /// Points of a slope in a text, in steps of 1.
    fn slope(&self, name: &str, size: u32, step: f64) -> PathBuf {
        let at = |i: u32| [f64::from(i % size) * step, f64::from(i / size) * step];
        let rows: Vec<String> = (0..size * size)
            .map(at)
            .map(|[x, y]| format!("{x} {y} {}\n", 10.0 + x / 8.0))
            .collect();
        self.write(name, rows.concat())
    }

    fn lines(&self, name: &str, kind: &str, lines: &[&[[f64; 3]]]) -> PathBuf {
        self.write(
            name,
            layer(
                &lines.iter().map(|line| line.to_vec()).collect::<Vec<_>>(),
                kind,
            ),
        )
    }
}

fn points(files: &[&PathBuf]) -> TinRequest {
    TinRequest {
        points: files
            .iter()
            .map(|&path| Input::File(path.clone()))
            .collect(),
        ..TinRequest::default()
    }
}

fn layers<T>(files: &[&PathBuf]) -> Vec<Input<T>> {
    files
        .iter()
        .map(|&path| Input::File(path.clone()))
        .collect()
}

fn heights() -> Arc<dyn Verb> {
    Arc::new(DemOptions::default())
}

fn case(request: TinRequest, kinds: &'static [&'static str]) -> Case {
    Case {
        request,
        systems: SystemOptions::default(),
        verb: heights(),
        kinds,
    }
}

/// Cases of points and systems.
fn cases_of_points(files: &Files) -> Vec<Case> {
    let [a, b] = [("a.las", 0.0), ("b.las", 10.0)].map(|(name, x)| files.tile(name, [x, 0.0], 2));
    let high = files.tile("high.las", [20.0, 0.0], 5);
    let in_feet = las_with_heights_in_feet(&[([5.0, 5.0, 1.0], 2)], 25832);
    let in_feet = files.write("feet.las", in_feet);
    let far = files.tile("far.las", [1e5, 0.0], 2);
    let text = files.slope("t.xyz", 8, 1.0);
    let at = |k: u32| [1e10 + f64::from(k % 9), f64::from(k / 9)];
    let rows = (0..81).map(|k| format!("{} {} {}\n", at(k)[0], at(k)[1], k % 9));
    let coarse = files.write("coarse.xyz", rows.collect::<String>());
    let wide = files.slope("w.xyz", 8, 60.0);
    let rails: Vec<String> = (0..40)
        .map(|i| format!("{} {} {i}\n", 5 * i, f64::from(i % 2) * 0.2 - 300.0))
        .collect();
    let rails = files.write("rails.xyz", rails.concat());
    let beside = files.write(
        "beside.xyz",
        (0..400)
            .map(|i| format!("{} {} 7\n", 10 * (i % 20) + i / 20 % 3, 30 + 10 * (i / 20)))
            .collect::<String>(),
    );
    let empty = files.write("e.las", las(&[], Some(25832)));
    // Half of the points are missing.
    let whole = fs::read(&a).unwrap();
    let cut = files.write("cut.las", &whole[..whole.len() - 160]);
    // Its first line states another number of points.
    let counted = files.write(
        "counted.pts",
        format!("70\n{}", fs::read_to_string(&text).unwrap()),
    );
    let partial = |request: TinRequest| {
        let mut request = request;
        request.read.cut = breakline::io::OnDamage::Accept;
        request
    };
    let only = |classes: &[u8], request: TinRequest| TinRequest {
        classes: Classes::Only(classes.to_vec()),
        ..request
    };
    let bounds = |min: f64, max: f64| Bounds {
        min: [min, min, 0.0],
        max: [max, max, 0.0],
    };
    let system = |name: &str| Some(Crs::from_user(name).unwrap());
    let te = |min: f64, max: f64| {
        let frame = FrameOptions {
            extent: Some(bounds(min, max)),
            ..FrameOptions::default()
        };
        DemOptions {
            frame,
            ..DemOptions::default()
        }
    };
    let shaded_degrees = |z_factor: Option<f64>, kinds| Case {
        systems: SystemOptions {
            assign: system("EPSG:4326"),
            degrees: Degrees::Allow,
            ..SystemOptions::default()
        },
        verb: Arc::new(HillshadeOptions {
            frame: FrameOptions {
                resolution: Some(1.0),
                ..FrameOptions::default()
            },
            light: LightOptions {
                z_factor,
                ..LightOptions::default()
            },
            ..HillshadeOptions::default()
        }),
        ..case(
            TinRequest {
                max_edge: EdgeLimit::Unlimited,
                ..points(&[&text])
            },
            kinds,
        )
    };
    let diagonal: Vec<([f64; 3], u8)> = (0..40)
        .map(|i| ([f64::from(i), f64::from(i + i % 2), 1.0], 2))
        .collect();
    let diagonal = files.write("d.las", las(&diagonal, Some(25832)));
    vec![
        case(
            points(&[&a, &b, &text]),
            &[
                "Opened",
                "WithoutClasses",
                "PointsRead",
                "GroundUsed",
                "PointsWithoutClassUsed",
            ],
        ),
        case(
            points(&[&a, &text]),
            &["SystemOfOthers", "StandardEdgeLimit", "DefaultResolution"],
        ),
        case(points(&[&a, &b, &high]), &["NoPointUsed"]),
        case(points(&[&a, &empty, &b]), &["NoPointUsed"]),
        case(points(&[&high]), &["AllClassesUsed"]),
        case(only(&[2], points(&[&text])), &["NoPointOfClass"]),
        case(
            only(&[2, 5, 7], points(&[&a, &high, &text])),
            &["NoPointOfClass"],
        ),
        case(
            TinRequest {
                classes: Classes::AllButNoise,
                returns: vec![Return::FIRST],
                ..points(&[&a, &text])
            },
            &["NoiseUnused", "PointsWithoutReturnUsed"],
        ),
        case(points(&[&text]), &["NoSystem"]),
        case(points(&[&wide]), &["EdgeLimitUnusual"]),
        case(points(&[&rails, &text]), &["CapsLost"]).of(te(0.0, 4.0)),
        case(points(&[&rails, &beside]), &["CapsLost"]).of(te(40.0, 180.0)),
        case(points(&[&a, &far]), &["FarApart"]).of(te(0.0, 4.0)),
        case(
            TinRequest {
                max_edge: EdgeLimit::Length(5.0),
                ..points(&[&a, &far])
            },
            &["HullLost"],
        )
        .of(te(0.0, 4.0)),
        case(partial(points(&[&cut, &b])), &["Reader"]),
        case(partial(points(&[&counted])), &["Reader"]),
        case(
            TinRequest {
                max_edge: EdgeLimit::Unlimited,
                ..points(&[&a])
            },
            &["NoEdgeLimit"],
        ),
        case(
            TinRequest {
                max_edge: EdgeLimit::Auto,
                ..points(&[&a, &b, &text])
            },
            &["EdgeLimit"],
        ),
        // One piece says how far out it has read; tiles read all points.
        case(
            TinRequest {
                bounds: Some(bounds(0.5, 2.5)),
                ..points(&[&a])
            },
            &["BoundsBuffer"],
        ),
        Case {
            systems: SystemOptions {
                assign: system("EPSG:25833"),
                ..SystemOptions::default()
            },
            ..case(points(&[&a]), &["Reassigned"])
        },
        Case {
            systems: SystemOptions {
                assign: system("EPSG:25832+6360"),
                ..SystemOptions::default()
            },
            verb: Arc::new(HillshadeOptions::default()),
            ..case(points(&[&text]), &["DifferentUnits", "HeightFactor"])
        },
        case(points(&[&a, &in_feet]), &["HeightsOfOthers"]),
        shaded_degrees(None, &["AnglesAsLengths"]),
        shaded_degrees(Some(2.0), &["SteepAngles"]),
        case(points(&[&text]), &["ExtentApart"]).of(te(100.0, 104.0)),
        // Within the extent of the points, but not on the surface.
        case(
            TinRequest {
                max_edge: EdgeLimit::Length(3.0),
                ..points(&[&diagonal])
            },
            &[],
        )
        .of(DemOptions {
            frame: FrameOptions {
                extent: Some(Bounds {
                    min: [30.0, 0.0, 0.0],
                    max: [39.0, 9.0, 0.0],
                }),
                ..FrameOptions::default()
            },
            ..DemOptions::default()
        }),
        case(points(&[&text]), &["DefaultInterval"]).of(ContourOptions::default()),
        case(points(&[&coarse]), &["CoarseCoordinates"]).of(ContourOptions {
            map: MapOptions {
                min_area: Some(4.0),
                ..MapOptions::default()
            },
            ..ContourOptions::default()
        }),
    ]
}

/// Cases of lines and areas.
fn cases_of_lines(files: &Files) -> Vec<Case> {
    let text = files.slope("s.xyz", 9, 1.0);
    let ground = las(
        &[tile([0.0, 0.0], 2), tile([900.0, 0.0], 5)].concat(),
        Some(25832),
    );
    let ground = files.write("g.las", ground);
    let line =
        |name: &str, from: [f64; 3], to: [f64; 3]| files.lines(name, "LineString", &[&[from, to]]);
    let ring = |[x, y]: [f64; 2], z: f64, size: f64| {
        [
            [0.0, 0.0],
            [size, 0.0],
            [size, size],
            [0.0, size],
            [0.0, 0.0],
        ]
        .map(|[u, v]| [x + u, y + v, z])
    };
    let breaklines = |layer: PathBuf| TinRequest {
        breaklines: layers(&[&layer]),
        ..points(&[&text])
    };
    let with = |lines: LineRequest| TinRequest {
        lines,
        ..points(&[&text])
    };
    let crossing = files.lines(
        "cross.geojson",
        "LineString",
        &[
            &[[1.3, 1.3, 10.0], [6.3, 6.1, 10.0]],
            &[[1.3, 6.3, 14.0], [6.3, 1.7, 14.0]],
        ],
    );
    let level = files.lines(
        "level.geojson",
        "LineString",
        &[&ring([2.5, 2.5], 10.0, 4.0)],
    );
    let lake = files.lines("lake.geojson", "Polygon", &[&ring([2.5, 2.5], 10.0, 3.0)]);
    let beside = [
        [5.5, 2.5, 10.1],
        [7.5, 2.5, 10.2],
        [7.5, 5.5, 10.1],
        [5.5, 5.5, 10.1],
        [5.5, 2.5, 10.1],
    ];
    let beyond = ring([0.5, -3.5], 9.0, 4.0);
    let lakes = files.lines(
        "lakes.geojson",
        "Polygon",
        &[&ring([2.5, 2.5], 10.0, 3.0), &beside, &beyond],
    );
    let hole = files.lines("hole.geojson", "Polygon", &[&ring([2.5, 2.5], 0.0, 2.0)]);
    let hole_apart = files.lines(
        "hole_apart.geojson",
        "Polygon",
        &[&ring([50.0, 2.5], 0.0, 2.0)],
    );
    let lower = files.lines(
        "lower.geojson",
        "LineString",
        &[
            &[[1.5, 2.5, 12.0], [6.5, 2.5, 10.0]],
            &[[1.5, 4.5, 12.0], [6.5, 4.5, 10.0]],
            &[[3.0, 7.0, 13.0], [3.0, 4.5, 9.0]],
            &[[4.0, 7.0, 13.0], [4.0, 4.5, 9.0]],
        ],
    );
    let uneven = files.lines(
        "uneven.geojson",
        "LineString",
        &[
            &[[1.5, 2.5, 10.0], [4.0, 2.5, 12.0], [6.5, 2.5, 9.0]],
            &[[1.5, 4.5, 10.5], [4.0, 4.5, 12.5], [6.5, 4.5, 9.0]],
        ],
    );
    let folded = line_of_river(files);
    let wall = [[1.0, 4.0, 15.0], [4.0, 4.0, 15.0], [7.0, 4.0, 15.0]];
    let wall = files.lines("wall.geojson", "LineString", &[&wall]);
    let drop = WallOptions {
        lower: Some(LowerEdge::Drop(PerRecord::Number(1.0))),
        ..WallOptions::default()
    };
    let draped = |layer: PathBuf| LineRequest {
        draped: layers(&[&layer]),
        ..LineRequest::default()
    };
    let holes = |layer: PathBuf| LineRequest {
        holes: layers(&[&layer]),
        ..LineRequest::default()
    };
    let rivers = |layer: PathBuf| LineRequest {
        rivers: layers(&[&layer]),
        ..LineRequest::default()
    };
    vec![
        case(
            breaklines(line("l.geojson", [1.5, 1.5, 11.0], [6.5, 2.5, 12.0])),
            &["LayerRead"],
        ),
        case(
            breaklines(crossing.clone()),
            &["CrossingsRounded", "CrossingHeights"],
        ),
        // Beyond the bounds nobody has to know.
        case(
            TinRequest {
                bounds: Some(Bounds {
                    min: [0.5, 6.5, 0.0],
                    max: [7.5, 7.5, 0.0],
                }),
                ..breaklines(crossing.clone())
            },
            &["CrossingsRounded"],
        ),
        case(
            breaklines(line(
                "far.geojson",
                [5000.0, 1.5, 11.0],
                [5006.0, 2.5, 12.0],
            )),
            &["BreaklinesApart"],
        ),
        case(
            breaklines(line("long.geojson", [1.5, 1.5, 11.0], [506.0, 2.5, 12.0])),
            &["BreaklinesBeyond"],
        ),
        // The points of other classes reach as far as the line.
        case(
            TinRequest {
                breaklines: layers(&[&line(
                    "beyond.geojson",
                    [1.5, 1.5, 11.0],
                    [800.0, 2.5, 12.0],
                )]),
                ..points(&[&ground])
            },
            &["BreaklinesBeyond"],
        ),
        case(breaklines(level.clone()), &["LevelRings"]),
        case(
            TinRequest {
                lines: LineRequest {
                    flats: layers(&[&lake]),
                    walls: layers(&[&wall]),
                    wall: drop,
                    flat: FlatOptions::default(),
                    ..LineRequest::default()
                },
                ..points(&[&text])
            },
            &["WallsInWater"],
        ),
        case(
            with(LineRequest {
                flats: layers(&[&lakes]),
                ..LineRequest::default()
            }),
            &["UnevenShores", "LakesJoined", "WatersEnded"],
        ),
        case(with(rivers(uneven)), &["RiverHeights"]),
        case(with(rivers(lower)), &["RiversLowered"]),
        case(
            with(LineRequest {
                flats: layers(&[&lake]),
                river_width: Some(PerRecord::Number(1.0)),
                ..rivers(line("over.geojson", [1.2, 4.1, 13.0], [7.3, 4.3, 12.0]))
            }),
            &["WaterOverlaps"],
        ),
        case(
            with(LineRequest {
                river_width: Some(PerRecord::Number(3.0)),
                ..rivers(folded)
            }),
            &["RiverOverlap"],
        ),
        case(
            with(draped(line(
                "above.geojson",
                [50.0, 1.0, 0.0],
                [60.0, 2.0, 0.0],
            ))),
            &["LinesApart"],
        ),
        case(
            with(draped(line("on.geojson", [1.5, 1.2, 0.0], [6.5, 2.7, 0.0]))),
            &[],
        ),
        case(with(holes(hole_apart.clone())), &["LinesApart"]),
        case(with(holes(hole.clone())), &[]),
        case(
            TinRequest {
                boundary: layers(&[&hole]),
                ..with(holes(hole_apart))
            },
            &[],
        ),
        case(
            with(LineRequest {
                holes: layers(&[&hole]),
                ..draped(level)
            }),
            &[],
        ),
    ]
}

/// The middle of a river that turns back on itself.
fn line_of_river(files: &Files) -> PathBuf {
    files.lines(
        "folded.geojson",
        "LineString",
        &[&[[1.0, 4.0, 12.0], [7.0, 4.0, 11.0], [1.0, 4.8, 10.0]]],
    )
}

impl Case {
    fn of(self, verb: impl Verb + 'static) -> Self {
        Case {
            verb: Arc::new(verb),
            ..self
        }
    }
}

#[test]
fn tiles_report_what_the_whole_reports() {
    let folder = tempfile::tempdir().unwrap();
    let files = Files(folder.path());
    let left_out: BTreeMap<&str, &str> = NOT_IN_TILES.iter().copied().collect();
    let (mut seen, mut faults) = (BTreeSet::new(), Vec::new());
    for (number, case) in cases_of_points(&files)
        .into_iter()
        .chain(cases_of_lines(&files))
        .enumerate()
    {
        let mut whole = notices_of_whole(&case, folder.path());
        let kinds: BTreeSet<String> = whole.iter().map(kind).collect();
        let missing: Vec<_> = case
            .kinds
            .iter()
            .filter(|kind| !kinds.contains(**kind))
            .collect();
        if !missing.is_empty() {
            faults.push(format!("case {number}: no {missing:?} in {kinds:?}"));
        }
        seen.extend(kinds);
        whole.retain(|notice| !left_out.contains_key(kind(notice).as_str()));
        for division in [Division::Grid([3, 2]), Division::Auto] {
            let tiled = notices_of_tiles(&case, division, folder.path());
            let (tiled, whole) = (texts(&tiled), texts(&whole));
            let differ: Vec<_> = tiled
                .symmetric_difference(&whole)
                .map(|row| (tiled.contains(row), row))
                .collect();
            if !differ.is_empty() {
                faults.push(format!(
                    "case {number}, {division:?}; true is in tiles: {differ:?}"
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    // Each kind of the enum is either seen, or has a reason not to be.
    let all = kinds_of_notices();
    assert!(all.len() > 30, "{all:?}");
    for name in all {
        let excused = NOT_IN_TILES
            .iter()
            .chain(IN_TILES_ONLY)
            .any(|(kind, _)| *kind == name);
        assert!(
            seen.contains(&name) != excused || left_out.contains_key(name.as_str()),
            "{name}"
        );
    }
}

/// Returns the names of all kinds, from the source of the enum.
fn kinds_of_notices() -> BTreeSet<String> {
    let source = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/src/run/context/notice.rs"
    ))
    .unwrap();
    let (_, rest) = source.split_once("pub enum Notice {\n").unwrap();
    let (body, _) = rest.split_once("\n}\n").unwrap();
    let rows = body.lines().filter_map(|line| {
        line.strip_prefix("    ")
            .filter(|row| row.starts_with(char::is_uppercase))
    });
    rows.map(|row| row.split(['(', ' ', ',', '{']).next().unwrap().to_owned())
        .collect()
}
