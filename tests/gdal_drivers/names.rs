//! Inputs that are not files: in archives, on servers, in databases, parts of files.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Command;

use tempfile::TempDir;

use super::program::{Run, files_of, run_in};
use super::{run_verb, surface};

/// Runs the program without a proxy.
fn run(folder: &TempDir, args: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_breakline"))
        .current_dir(folder.path())
        .args(args)
        .env("no_proxy", "*")
        .env("GDAL_HTTP_TIMEOUT", "20")
        .output()
        .unwrap();
    Run {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Returns a ZIP archive of files that are stored as they are.
fn zip(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let mut sum = flate2::Crc::new();
        sum.update(bytes);
        let at = archive.len() as u32;
        let size = (bytes.len() as u32).to_le_bytes();
        let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0x50];
        common.extend(sum.sum().to_le_bytes());
        common.extend([size, size].concat());
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        archive.extend(b"PK\x03\x04");
        archive.extend(&common);
        archive.extend(name.as_bytes());
        archive.extend(bytes);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend(at.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let start = archive.len() as u32;
    archive.extend(&directory);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    let count = (files.len() as u16).to_le_bytes();
    archive.extend([count, count].concat());
    archive.extend((directory.len() as u32).to_le_bytes());
    archive.extend(start.to_le_bytes());
    archive.extend([0, 0]);
    archive
}

/// The files of the contours.
const LINES: [&str; 4] = ["lines.shp", "lines.shx", "lines.dbf", "lines.prj"];

fn bytes_of(folder: &TempDir, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap()
}

/// A folder with the surface, a DEM, its contours as a shapefile, and archives of both.
fn archives() -> TempDir {
    let folder = surface();
    run_verb(&folder, &["dem"], &["-o", "dem.tif"]).works(&[]);
    run_verb(
        &folder,
        &["contour", "--interval", "5"],
        &["-o", "lines.shp"],
    )
    .works(&[]);
    let names = ["dem.tif"].into_iter().chain(LINES);
    let files: Vec<(&str, Vec<u8>)> = names.map(|name| (name, bytes_of(&folder, name))).collect();
    std::fs::write(folder.path().join("all.zip"), zip(&files)).unwrap();
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(&bytes_of(&folder, "dem.tif")).unwrap();
    std::fs::write(folder.path().join("dem.tif.gz"), packed.finish().unwrap()).unwrap();
    folder
}

#[test]
fn archives_are_read_in_place() {
    let folder = archives();
    let read = |name: &str| bytes_of(&folder, name);
    run(&folder, &["hillshade", "dem.tif", "-o", "direct.tif"]).works(&[]);
    for name in ["/vsizip/all.zip/dem.tif", "/vsigzip/dem.tif.gz"] {
        run(&folder, &["hillshade", name, "-o", "by.tif", "--overwrite"]).works(&[]);
        assert_eq!(read("direct.tif"), read("by.tif"), "{name}");
    }
    run(
        &folder,
        &[
            "tin",
            "points.xyz",
            "--breaklines",
            "lines.shp:ELEV",
            "--a-srs",
            "EPSG:25832",
            "-o",
            "a.ply",
        ],
    )
    .works(&[]);
    let lines = "/vsizip/all.zip/lines.shp:ELEV";
    run(
        &folder,
        &[
            "tin",
            "points.xyz",
            "--breaklines",
            lines,
            "--a-srs",
            "EPSG:25832",
            "-o",
            "b.ply",
        ],
    )
    .works(&[]);
    assert_eq!(read("a.ply"), read("b.ply"));
    let info = run(
        &folder,
        &[
            "info",
            "/vsizip/all.zip/lines.shp",
            "/vsizip/all.zip/dem.tif",
        ],
    );
    info.ends(0, &["GDAL ESRI Shapefile", "GDAL GTiff", "25832"]);
    // By a list, and by a run file.
    std::fs::write(
        folder.path().join("list.txt"),
        "/vsizip/all.zip/lines.shp:ELEV\n",
    )
    .unwrap();
    run(&folder, &["tin", "@list.txt", "-o", "c.ply"]).works(&["lines are breaklines"]);
}

#[test]
fn what_is_not_there_is_an_error_in_the_words_of_gdal() {
    let folder = archives();
    for (args, said) in [
        (
            &["hillshade", "/vsizip/all.zip/none.tif", "-o", "x.tif"][..],
            "error: /vsizip/all.zip/none.tif: GDAL: ",
        ),
        (
            &[
                "tin",
                "points.xyz",
                "--breaklines",
                "/vsizip/none.zip/a.shp",
                "-o",
                "x.ply",
            ],
            "error: /vsizip/none.zip/a.shp: GDAL: ",
        ),
        (
            &["info", "/vsizip/all.zip/none.laz"],
            "/vsizip/all.zip/none.laz: GDAL: ",
        ),
        (&["info", "NETCDF:none.nc:z"], "NETCDF:none.nc:z: "),
        (
            &["info", "/vsicurl/http://127.0.0.1:1/a.tif"],
            "/vsicurl/http://127.0.0.1:1/a.tif: ",
        ),
    ] {
        let run = run(&folder, args);
        assert_eq!(run.code, 1, "{args:?}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{args:?}: {}", run.stderr);
        assert!(
            !run.stderr.contains("no such file") && run.stderr.contains("hint: "),
            "{}",
            run.stderr
        );
    }
    assert!(!folder.path().join("x.tif").exists() && !folder.path().join("x.ply").exists());
}

#[test]
fn passwords_are_nowhere() {
    let folder = surface();
    let connection = "PG:host=127.0.0.1 port=1 dbname=gis user=me password=s3cret";
    let url = "PG:postgresql://me:s3cret@127.0.0.1:1/gis:lines";
    for args in [
        &[
            "tin",
            "points.xyz",
            "--breaklines",
            connection,
            "-o",
            "a.ply",
        ][..],
        &[
            "tin",
            "points.xyz",
            "--breaklines",
            url,
            "-o",
            "a.ply",
            "-v",
        ],
        &["info", connection, "--json"],
        &["contour", "points.xyz", "-o", url],
        &[
            "contour",
            "points.xyz",
            "--output=PG:port=1 host=127.0.0.1 password='s3cret':lines",
        ],
        &[
            "job",
            "plan",
            "job",
            "--",
            "dem",
            "points.xyz",
            "--breaklines",
            url,
            "-o",
            "a.tif",
        ],
        &[
            "dem",
            "points.xyz",
            "--breaklines",
            url,
            "-o",
            "a.tif",
            "--tiles",
            "2x2",
        ],
    ] {
        let run = run(&folder, args);
        assert_ne!(run.code, 0, "{args:?}");
        let said = format!("{}{}", run.stdout, run.stderr);
        assert!(
            !said.contains("s3cret") && said.contains("***"),
            "{args:?}: {said}"
        );
    }
    for name in files_of(folder.path()) {
        let path = folder.path().join(&name);
        let text = std::fs::read(&path).unwrap_or_default();
        assert!(!text.windows(6).any(|part| part == b"s3cret"), "{name}");
    }
    run_in(&folder, &["contour", "points.xyz", "-o", "PG:dbname=gis"]).fails(
        2,
        &["without the name of a table", "write PG:dbname=gis:TABLE"],
    );
    run_in(
        &folder,
        &["contour", "points.xyz", "-o", "/vsizip/a.zip/b.mif"],
    )
    .fails(
        2,
        &["outputs are files, or for lines also tables of databases"],
    );
}

/// A server of files, with the parts of them that are asked for.
fn serve(files: HashMap<String, Vec<u8>>) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            // The client may go whenever it has enough.
            let _ = answer(stream, &files);
        }
    });
    port
}

fn answer(mut stream: TcpStream, files: &HashMap<String, Vec<u8>>) -> std::io::Result<()> {
    let mut lines = BufReader::new((&mut stream).take(1 << 16)).lines();
    let first = lines.next().unwrap_or_else(|| Ok(String::new()))?;
    let mut range = None;
    for line in lines {
        let line = line?.to_ascii_lowercase();
        if line.is_empty() {
            break;
        }
        range = line
            .strip_prefix("range: bytes=")
            .map(str::to_owned)
            .or(range);
    }
    let mut words = first.split(' ');
    let (method, path) = (
        words.next().unwrap_or_default(),
        words.next().unwrap_or_default(),
    );
    let Some(bytes) = files.get(path) else {
        return stream.write_all(
            b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n",
        );
    };
    let ends = range.as_deref().and_then(|range| range.split_once('-'));
    let (status, part) = match ends {
        Some((start, end)) => {
            let start: usize = start.parse().unwrap_or(0).min(bytes.len());
            let end = end
                .parse()
                .map_or(bytes.len(), |end: usize| (end + 1).min(bytes.len()));
            let status = format!(
                "206 Partial Content\r\nContent-Range: bytes {start}-{}/{}",
                end.max(1) - 1,
                bytes.len()
            );
            (status, &bytes[start..end.max(start)])
        }
        None => ("200 OK".to_owned(), &bytes[..]),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nAccept-Ranges: bytes\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        part.len()
    )?;
    match method {
        "HEAD" => Ok(()),
        _ => stream.write_all(part),
    }
}

#[test]
fn files_on_a_server_are_read() {
    let folder = archives();
    let read = |name: &str| bytes_of(&folder, name);
    let files = ["dem.tif", "all.zip"].into_iter().chain(LINES);
    let port = serve(files.map(|name| (format!("/{name}"), read(name))).collect());
    run(&folder, &["hillshade", "dem.tif", "-o", "direct.tif"]).works(&[]);
    for name in [
        format!("/vsicurl/http://127.0.0.1:{port}/dem.tif"),
        format!("/vsizip//vsicurl/http://127.0.0.1:{port}/all.zip/dem.tif"),
    ] {
        run(
            &folder,
            &["hillshade", &name, "-o", "by.tif", "--overwrite"],
        )
        .works(&[]);
        assert_eq!(read("direct.tif"), read("by.tif"), "{name}");
    }
    let lines = format!("/vsicurl/http://127.0.0.1:{port}/lines.shp:ELEV");
    run(&folder, &["tin", &lines, "-o", "a.ply"]).works(&["lines are breaklines"]);
    let missing = format!("/vsicurl/http://127.0.0.1:{port}/none.tif");
    run(&folder, &["info", &missing]).fails(1, &[&missing, "404"]);
    // What a server has may change at any time.
    let lines = [
        "--breaklines",
        &lines,
        "--tiles",
        "2x2",
        "-o",
        "t.tif",
        "--a-srs",
        "EPSG:25832",
    ];
    run(&folder, &[&["dem", "points.xyz"], &lines[..]].concat())
        .fails(2, &["this one is no file", "copy it to a file"]);
}
