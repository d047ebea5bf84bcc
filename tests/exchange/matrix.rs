//! What each format of surfaces keeps: a table that is made by writing and reading, and stands in
//! the documentation.

use std::path::Path;

use breakline::data::{EdgeKind, Surface};
use breakline::io::formats::{self, FORMATS, Product};
use breakline::io::mesh;

use crate::sample::{content, field};

/// Yes, no, or a dash where nothing is read back.
fn mark(kept: Option<bool>) -> &'static str {
    match kept {
        Some(true) => "yes",
        Some(false) => "no",
        None => "-",
    }
}

fn row(name: &str, extension: &str, folder: &Path) -> String {
    let field = field(Some("EPSG:25832+7837"));
    let path = folder.join(format!("a.{extension}"));
    mesh::write(&path, &field).unwrap();
    let back = mesh::read(&path).ok();
    let positions = |sides: Vec<[([u64; 3], EdgeKind); 3]>| {
        sides
            .into_iter()
            .map(|face| face.map(|side| side.0))
            .collect::<Vec<_>>()
    };
    let kept = |judge: &dyn Fn(&breakline::data::Mesh) -> bool| mark(back.as_ref().map(judge));
    let system = kept(&|back| {
        back.crs()
            .is_some_and(|crs| crs.is_same(field.crs().unwrap()))
    });
    let vertical = kept(&|back| {
        back.crs()
            .is_some_and(|crs| crs.vertical_epsg == field.crs().unwrap().vertical_epsg)
    });
    let exact = kept(&|back| {
        let sorted = |surface| {
            let mut all = positions(content(surface));
            all.iter_mut().for_each(|face| {
                let first = (0..3).min_by_key(|&i| face[i]).unwrap();
                face.rotate_left(first);
            });
            all.sort_unstable();
            all
        };
        sorted(back) == sorted(&field)
    });
    let lines = kept(&|back| content(back) == content(&field));
    let read = if back.is_some() { "yes" } else { "no" };
    format!("| {name} | {read} | yes | {system} | {vertical} | {exact} | {lines} |\n")
}

#[test]
fn the_page_says_what_formats_of_surfaces_keep() {
    let folder = tempfile::tempdir().unwrap();
    let mut table = String::from(
        "| format | read | written | system kept | its heights | coordinates exact | lines by kind |\n\
         |---|---|---|---|---|---|---|\n",
    );
    // A .tin needs a triangulation of points, and a .tins tiles.
    let formats = FORMATS
        .iter()
        .filter(|format| format.writes(Product::Surface) && !format.name.starts_with("TIN"));
    for format in formats {
        table += &row(format.name, format.extensions[0], folder.path());
    }
    let page = include_str!("../../docs/formats.md");
    assert!(
        page.contains(&table),
        "docs/formats.md must have this table:\n{table}"
    );
    assert!(formats::markdown().contains("| LandXML |"));
}
