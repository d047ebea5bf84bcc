//! Writers, timed apart from what makes what they write.
//!
//! ```text
//! bench_writers LINES.fgb | SURFACE.ply | POINTS.laz [EXTENSION...]
//! ```
//!
//! Reads the file, writes it in each format that its kind is written in, or in those named, three
//! times each, and prints the shortest time and the size. Outputs are in a folder that is removed.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use breakline::io::formats::{self, Content, Product};
use breakline::io::{layer, mesh};
use breakline::run::{Context, PointsRequest, write_points};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let Some(file) = arguments.next() else {
        return Err("a file is needed".into());
    };
    let path = Path::new(&file);
    let named: Vec<String> = arguments.collect();
    let format = formats::detect_file(path)?.ok_or("an unknown format")?;
    let start = Instant::now();
    let (product, write): (Product, Box<Write>) = match format.content {
        Content::Layer => {
            let options = layer::Options {
                keeps_attributes: true,
                ..layer::Options::default()
            };
            let lines = layer::read_with(path, &options, &|_| Ok(()))?;
            let write = move |to: &Path| layer::write_lines(to, &lines).map(drop);
            (Product::Lines, Box::new(write))
        }
        Content::Mesh => {
            let surface = mesh::read(path)?;
            let write = move |to: &Path| mesh::write(to, &surface).map(drop);
            (Product::Surface, Box::new(write))
        }
        Content::Points => {
            let request = PointsRequest {
                files: vec![path.to_owned()],
                ..PointsRequest::default()
            };
            let write =
                move |to: &Path| write_points(&request, to.into(), &Context::default()).map(drop);
            (Product::Points, Box::new(write))
        }
        _ => return Err("neither lines, a surface nor points".into()),
    };
    println!("read {file} in {:.2} s", start.elapsed().as_secs_f64());
    for extension in formats::extensions(product) {
        // A .tin needs a triangulation, and a .tins tiles.
        if named.iter().any(|name| name == extension)
            || named.is_empty() && !extension.starts_with("tin")
        {
            timed(extension, &*write)?;
        }
    }
    Ok(())
}

type Write = dyn Fn(&Path) -> breakline::Result<()>;

fn timed(extension: &str, write: &Write) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir_in(".")?;
    let target = folder.path().join(format!("a.{extension}"));
    let mut shortest = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        write(&target)?;
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    let sizes = std::fs::read_dir(folder.path())?.map(|entry| Ok(entry?.metadata()?.len()));
    let bytes = sizes.sum::<std::io::Result<u64>>()?;
    println!(
        "{extension:10} {shortest:7.3} s {:8.1} MB",
        bytes as f64 / 1e6
    );
    Ok(())
}
