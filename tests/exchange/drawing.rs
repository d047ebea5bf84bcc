//! Surfaces as DXF drawings, read by a naive reader.

use std::collections::BTreeMap;

use breakline::data::Surface;
use breakline::io::mesh;

use crate::sample::field;

/// The kind of an entity, its layer, and its groups.
type Entity<'a> = (&'a str, &'a str, Vec<(u16, &'a str)>);

/// The entities of a drawing: kind, layer, and the codes and values after it.
fn entities(text: &str) -> Vec<Entity<'_>> {
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    let pairs = lines
        .chunks(2)
        .map(|pair| (pair[0].parse().unwrap(), pair[1]));
    let mut found: Vec<Entity> = Vec::new();
    let behind = pairs.skip_while(|pair| *pair != (2, "ENTITIES")).skip(1);
    for (code, value) in behind {
        match (code, found.last_mut()) {
            (0, _) => found.push((value, "", Vec::new())),
            (8, Some(last)) => last.1 = value,
            (_, Some(last)) => last.2.push((code, value)),
            _ => panic!("{code} {value}"),
        }
    }
    found
}

fn corner(values: &[(u16, &str)], which: u16) -> [u64; 3] {
    [10, 20, 30].map(|axis| {
        let (_, value) = values
            .iter()
            .find(|(code, _)| *code == axis + which)
            .unwrap();
        value.parse::<f64>().unwrap().to_bits()
    })
}

#[test]
fn a_drawing_has_triangles_boundaries_and_lines_on_layers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dxf");
    let field = field(Some("EPSG:25832"));
    let summary = mesh::write(&path, &field).unwrap();
    assert_eq!((summary.faces, summary.lost_edges), (46, 0));
    assert_eq!(
        summary.notes,
        [
            "a drawing has no coordinate system, which is a comment at most: EPSG:25832 (ETRS89 / UTM zone 32N)"
        ]
    );
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("999\ncrs: EPSG:25832\n0\nSECTION\n"));
    let entities = entities(&text);
    let mut faces = entities.iter().filter(|entity| entity.0 == "3DFACE");
    for number in 0..field.face_count() as u32 {
        let (_, layer, values) = faces.next().unwrap();
        let corners = field.triangle(number).unwrap().map(|p| p.map(f64::to_bits));
        let found = [0, 1, 2].map(|which| corner(values, which));
        assert_eq!((*layer, found), ("SURFACE", corners));
        assert_eq!(corner(values, 3), corners[2]);
    }
    assert!(faces.next().is_none());
    let mut lines: BTreeMap<&str, usize> = BTreeMap::new();
    for (kind, layer, _) in &entities {
        if *kind == "VERTEX" {
            *lines.entry(layer).or_default() += 1;
        }
    }
    // The rim has 20 edges, the hole 6; each ring ends where it begins.
    let expected = [
        ("BANKS", 3),
        ("BOUNDARY", 28),
        ("BREAKLINES", 4),
        ("CLIP_LINES", 4),
        ("DRAPED_LINES", 4),
        ("SHORES", 2),
        ("SOFT_LINES", 4),
        ("WALLS", 4),
    ];
    let found: Vec<(&str, usize)> = lines.into_iter().collect();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    assert_eq!(found[1], expected[1]);
    // Ten edges on lines, in chains: one vertex more than edges in each.
    let on_lines: usize = found
        .iter()
        .filter(|line| line.0 != "BOUNDARY")
        .map(|line| line.1)
        .sum();
    let chains = entities
        .iter()
        .filter(|entity| entity.0 == "POLYLINE" && entity.1 != "BOUNDARY")
        .count();
    assert_eq!(on_lines, 10 + chains);
}
