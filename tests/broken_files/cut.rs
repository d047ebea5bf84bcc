//! Files that are cut at each of their bytes, and files with changed bytes.

use std::path::{Path, PathBuf};

use breakline::data::{Frame, Grid, Layer, PointBatch, PointSource, Shape, Triangles};
use breakline::error::Wording;
use breakline::io::{
    OnDamage, ascii_grid, contours, geotiff, las, layer, mesh, points, tetgen, text, triangle,
};
use breakline::run::{self, Context, PointsRequest, Source, SurfaceRequest};
use breakline::terrain::TinBuilder;
use testkit::lidar::{las as las_bytes, tile};
use testkit::random::Random;

/// What was read: all numbers, in order, and the warnings.
type Read = breakline::Result<(Vec<u64>, Vec<Wording>)>;

/// What a reader does with a file that was cut, according to `docs/formats.md`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Fate {
    /// An error.
    Error,
    /// An error; a warning, if a part is accepted.
    ErrorUnlessPartial,
    /// Like that, but only a warning in the middle of the last line.
    ErrorUnlessPartialOrOpenLine,
    /// An error, or a warning in the middle of the last line.
    ErrorOrOpenLine,
    /// A warning in the middle of a line. Between two lines, nothing: nothing shows it.
    OpenLineOnly,
    /// An error in the middle of a line. Between two lines, nothing: nothing shows it.
    ErrorInLine,
    /// Nothing is missing, or a warning: the file is only beside another one.
    Beside,
}

struct Sample {
    /// The file that is damaged.
    damaged: PathBuf,
    /// The file that is read.
    path: PathBuf,
    fate: Fate,
    read: fn(&Path, OnDamage) -> Read,
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Vec<u64> {
    numbers.into_iter().map(f64::to_bits).collect()
}

fn all_points(mut source: impl PointSource) -> Read {
    let (mut found, mut batch) = (Vec::new(), PointBatch::default());
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((
                found,
                [&source.info().warnings[..], source.warnings()].concat(),
            ));
        }
        (0..batch.len()).for_each(|i| found.extend(bits([batch.x[i], batch.y[i], batch.z[i]])));
    }
}

fn of_layer(path: &Path, cut: OnDamage) -> Read {
    let Layer {
        shapes, warnings, ..
    } = layer::read_with(
        path,
        &layer::Options {
            cut,
            ..layer::Options::default()
        },
        &|_| Ok(()),
    )?;
    Ok((
        bits(shapes.iter().flat_map(Shape::vertices).flatten().copied()),
        warnings,
    ))
}

fn of_mesh(path: &Path, _: OnDamage) -> Read {
    let Triangles {
        vertices,
        faces,
        warnings,
        ..
    } = mesh::read_triangles(path)?;
    Ok((
        [
            bits(vertices.into_flattened()),
            faces.into_flattened().into_iter().map(u64::from).collect(),
        ]
        .concat(),
        warnings,
    ))
}

fn of_tin(path: &Path, _: OnDamage) -> Read {
    let source = Source::Mesh(path.to_path_buf());
    let found = run::check(
        &SurfaceRequest {
            source,
            ..SurfaceRequest::default()
        },
        &Context::default(),
    )?;
    let facts = found.product.facts()?;
    Ok((
        vec![facts.triangles as u64],
        found
            .flaws
            .iter()
            .map(|flaw| flaw.to_string().into())
            .collect(),
    ))
}

fn of_graph(path: &Path, _: OnDamage) -> Read {
    let graph = triangle::read(path)?;
    let ends = graph
        .segments
        .iter()
        .flat_map(|segment| segment.ends)
        .map(u64::from);
    let holes = graph.holes.iter().flat_map(|hole| hole.at);
    Ok((
        [
            bits(graph.nodes.points.into_flattened()),
            ends.collect(),
            bits(holes),
        ]
        .concat(),
        graph.warnings,
    ))
}

fn of_space(path: &Path, _: OnDamage) -> Read {
    let (space, warnings) = tetgen::read(path, &|_| Ok(()))?;
    let corners = space
        .tetrahedra
        .into_flattened()
        .into_iter()
        .map(u64::from)
        .collect();
    Ok((
        [bits(space.nodes.points.into_flattened()), corners].concat(),
        warnings,
    ))
}

/// A file of each format, with the files beside it.
fn samples(folder: &Path) -> Vec<Sample> {
    let at = |name: &str| folder.join(name);
    let written = |name: &str, bytes: &[u8]| {
        std::fs::write(at(name), bytes).unwrap();
        at(name)
    };
    let mut all = Vec::new();
    let mut add = |path: PathBuf, fate, read| {
        all.push(Sample {
            damaged: path.clone(),
            path,
            fate,
            read,
        })
    };

    let of_las = |path: &Path, cut| all_points(las::open_with(path, cut)?);
    add(
        written("a.las", &las_bytes(&tile([0.0, 0.0], 2), None)),
        Fate::ErrorUnlessPartial,
        of_las,
    );
    let request = PointsRequest {
        files: vec![at("a.las")],
        ..PointsRequest::default()
    };
    run::write_points(&request, at("a.laz").as_path().into(), &Context::default()).unwrap();
    add(at("a.laz"), Fate::ErrorUnlessPartial, of_las);

    let of_text = |path: &Path, cut| {
        all_points(text::open(
            path,
            points::Options {
                cut,
                ..points::Options::default()
            },
        )?)
    };
    let lines = "0.5 10.25 12\n20.5 10.25 13.75\n20.5 30.25 14\n0.5 30.25 15.5\n";
    add(
        written("a.xyz", lines.as_bytes()),
        Fate::OpenLineOnly,
        of_text,
    );
    add(
        written("a.csv", lines.replace(' ', ",").as_bytes()),
        Fate::OpenLineOnly,
        of_text,
    );
    add(
        written("a.pts", format!("4\n{lines}").as_bytes()),
        Fate::ErrorUnlessPartialOrOpenLine,
        of_text,
    );

    let line = |z: f64| breakline::data::ContourLine {
        level: z,
        points: vec![[0.0, z], [10.5, z], [20.0, z + 1.0]],
    };
    for (name, fate) in [
        ("a.shp", Fate::ErrorUnlessPartial),
        ("a.geojson", Fate::Error),
        ("a.geojsonl", Fate::ErrorInLine),
    ] {
        contours::write(
            at(name).as_path(),
            &mut (0..5).map(|z| line(f64::from(z))),
            None,
        )
        .unwrap();
        add(at(name), fate, of_layer);
    }

    let grid = Grid {
        frame: Frame::north_up(0.0, 0.0, 1.0, 9, 7),
        crs: None,
        values: (0..63).map(f64::from).collect(),
    };
    geotiff::write(
        at("a.tif").as_path(),
        &grid,
        geotiff::WriteOptions::default(),
    )
    .unwrap();
    add(at("a.tif"), Fate::Error, |path, _| {
        let reader = geotiff::open(path)?;
        let warnings = reader.info().warnings.clone();
        Ok((bits(reader.read_grid()?.values), warnings))
    });

    let text = "ncols 3\nnrows 2\nxllcorner 0.5\nyllcorner 1\ncellsize 2\n1 2.5 3\n4 -9999 6.25\n";
    add(
        written("a.asc", text.as_bytes()),
        Fate::ErrorOrOpenLine,
        |path, _| {
            let grid = ascii_grid::open(path)?;
            let (cells, warnings) = grid.read_grid_with(&|_| Ok(()))?;
            Ok((bits(cells.values), warnings))
        },
    );

    let mut builder = TinBuilder::default();
    let column = |value: fn(i32) -> i32| (0..25).map(|i| f64::from(value(i))).collect::<Vec<f64>>();
    builder.add_points(
        &column(|i| i % 5),
        &column(|i| i / 5),
        &column(|i| i * i % 7),
    );
    builder.add_breakline(&[[0.0, 0.0, 3.0], [3.5, 1.5, 4.0]]);
    let tin = builder.build().unwrap();
    for (name, fate) in [
        ("a.ply", Fate::Error),
        ("a.xml", Fate::Error),
        ("a.glb", Fate::Error),
        ("a.nc", Fate::Error),
        ("a.2dm", Fate::ErrorOrOpenLine),
        ("a.off", Fate::ErrorOrOpenLine),
        ("a.obj", Fate::OpenLineOnly),
    ] {
        mesh::write(at(name).as_path(), &tin).unwrap();
        add(at(name), fate, of_mesh);
    }
    mesh::write(at("a.tin").as_path(), &tin).unwrap();
    add(at("a.tin"), Fate::Error, of_tin);
    mesh::write(at("a.stl").as_path(), &tin).unwrap();
    add(at("a.stl"), Fate::Error, |path, _| {
        let solid = mesh::describe_solid(path).unwrap()?;
        Ok((vec![solid.triangles as u64], Vec::new()))
    });
    let ascii = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                 element face 2\nproperty list uchar int vertex_indices\nend_header\n\
                 0 0 1\n1 0 2\n1 1 3\n0 1 4\n3 0 1 2\n3 0 2 3\n";
    add(
        written("ascii.ply", ascii.as_bytes()),
        Fate::ErrorOrOpenLine,
        of_mesh,
    );

    let node = "4 2 0 0\n1 0 0.5\n2 10 0.5\n3 10 12.25\n4 0 12.25\n";
    add(
        written("alone.node", node.as_bytes()),
        Fate::ErrorOrOpenLine,
        of_graph,
    );
    let poly =
        "4 2 0 0\n1 0 0.5\n2 10 0.5\n3 10 12.25\n4 0 12.25\n2 0\n1 1 2\n2 3 4\n1\n1 3.5 11.75\n";
    add(
        written("alone.poly", poly.as_bytes()),
        Fate::ErrorOrOpenLine,
        of_graph,
    );
    written("b.node", node.as_bytes());
    add(
        written("b.ele", b"2 3 0\n1 1 2 3\n2 1 3 4\n"),
        Fate::ErrorOrOpenLine,
        of_mesh,
    );
    written("b.neigh", b"2 3\n1 -1 2 -1\n2 -1 -1 1\n");
    written("b.edge", b"1 1\n1 1 3 12\n");
    let space = "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1.25\n";
    written("c.node", space.as_bytes());
    add(
        written("c.ele", b"2 4 0\n1 1 2 3 4\n2 2 3 4 5\n"),
        Fate::ErrorOrOpenLine,
        of_space,
    );
    for (damaged, path, fate, read) in [
        (
            "b.node",
            "b.ele",
            Fate::ErrorOrOpenLine,
            of_mesh as fn(&Path, OnDamage) -> Read,
        ),
        ("b.neigh", "b.ele", Fate::ErrorOrOpenLine, of_mesh),
        ("b.edge", "b.ele", Fate::ErrorOrOpenLine, of_mesh),
        ("c.node", "c.ele", Fate::ErrorOrOpenLine, of_space),
        ("a.shx", "a.shp", Fate::Beside, of_layer),
        ("a.dbf", "a.shp", Fate::Beside, of_layer),
    ] {
        all.push(Sample {
            damaged: at(damaged),
            path: at(path),
            fate,
            read,
        });
    }
    all
}

fn replace(path: &Path, bytes: &[u8]) {
    std::fs::remove_file(path).unwrap();
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn a_file_that_was_cut_is_an_error_or_a_warning_and_never_silently_smaller() {
    let folder = tempfile::tempdir().unwrap();
    for Sample {
        damaged,
        path,
        fate,
        read,
    } in samples(folder.path())
    {
        let name = damaged.file_name().unwrap().to_str().unwrap();
        let bytes = std::fs::read(&damaged).unwrap();
        let (whole, warnings) =
            read(&path, OnDamage::Refuse).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(
            warnings.is_empty() && !whole.is_empty(),
            "{name}: {warnings:?}"
        );
        // All bytes of small files, and some of others.
        let step = bytes.len().div_ceil(400);
        for end in (1..bytes.len())
            .step_by(step)
            .chain(bytes.len().saturating_sub(40).max(1)..bytes.len())
        {
            replace(&damaged, &bytes[..end]);
            let is_between_lines = bytes[end - 1] == b'\n' || bytes[end] == b'\n';
            for cut in [OnDamage::Refuse, OnDamage::Accept] {
                let found = match read(&path, cut) {
                    Err(error) => {
                        assert_ne!(fate, Fate::Beside, "{name} cut at {end}: {error}");
                        continue;
                    }
                    Ok(found) => found,
                };
                let is_reported = !found.1.is_empty();
                let is_right = found.0 == whole
                    || match fate {
                        Fate::Error => false,
                        Fate::ErrorUnlessPartial => is_reported && cut == OnDamage::Accept,
                        Fate::ErrorUnlessPartialOrOpenLine => {
                            is_reported && (cut == OnDamage::Accept || !is_between_lines)
                        }
                        Fate::ErrorOrOpenLine => is_reported && !is_between_lines,
                        Fate::OpenLineOnly => is_reported || is_between_lines,
                        Fate::ErrorInLine => is_between_lines,
                        Fate::Beside => is_reported,
                    };
                assert!(
                    is_right,
                    "{name} cut at {end} of {}, {cut:?}: {} numbers, {:?}",
                    bytes.len(),
                    found.0.len(),
                    found.1
                );
            }
        }
        replace(&damaged, &bytes);
    }
}

#[test]
fn changed_bytes_are_an_answer_and_counts_that_shrink_are_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(35);
    for Sample {
        damaged,
        path,
        fate,
        read,
    } in samples(folder.path())
    {
        let name = damaged.file_name().unwrap().to_str().unwrap().to_owned();
        let bytes = std::fs::read(&damaged).unwrap();
        let whole = read(&path, OnDamage::Refuse).unwrap().0;
        for _ in 0..crate::cases("BREAKLINE_FLIPS", 150) {
            let mut bad = bytes.clone();
            let at = random.index(bad.len());
            bad[at] ^= 1 << random.index(8);
            replace(&damaged, &bad);
            for cut in [OnDamage::Refuse, OnDamage::Accept] {
                let Ok((found, warnings)) = read(&path, cut) else {
                    continue;
                };
                // A line of text may become a comment, or two lines one.
                let is_text = matches!(fate, Fate::OpenLineOnly | Fate::ErrorInLine);
                // A raster of fewer rows or columns is one, too.
                let is_raster = name.ends_with(".tif");
                let is_smaller =
                    found.len() < whole.len() && warnings.is_empty() && !is_text && !is_raster;
                assert!(
                    !is_smaller,
                    "{name}, byte {at}: {} instead of {}",
                    found.len(),
                    whole.len()
                );
            }
        }
        replace(&damaged, &bytes);
    }
}

#[test]
fn a_companion_that_is_missing_is_named_where_it_is_needed() {
    let folder = tempfile::tempdir().unwrap();
    let all = samples(folder.path());
    for (missing, path, is_needed) in [
        ("b.node", "b.ele", true),
        ("c.node", "c.ele", true),
        ("b.neigh", "b.ele", false),
        ("b.edge", "b.ele", false),
    ] {
        let (missing, path) = (folder.path().join(missing), folder.path().join(path));
        let bytes = std::fs::read(&missing).unwrap();
        std::fs::remove_file(&missing).unwrap();
        let read = all.iter().find(|sample| sample.path == path).unwrap().read;
        match read(&path, OnDamage::Refuse) {
            Err(error) => assert!(
                is_needed && error.to_string().contains(missing.to_str().unwrap()),
                "{error}"
            ),
            Ok(_) => assert!(!is_needed, "{}", missing.display()),
        }
        std::fs::write(&missing, bytes).unwrap();
    }
}
