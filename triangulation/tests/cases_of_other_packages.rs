//! The shared cases of other triangulation packages, compared with the counts in their README and
//! with a judge of our own.
#![allow(clippy::print_stdout)]

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

use breakline_triangulation::Delaunay;
use breakline_triangulation::geometry::Plane;
use testkit::case::Case;
use testkit::judge;
use testkit::random::Random;
use testkit::subject::{Built, build};

/// A file in the format that ../shared/data/README.md describes.
struct Stated {
    case: Case,
    facts: HashMap<String, usize>,
    /// The peers' products, and their numbers of triangles.
    peers: Vec<(String, usize)>,
}

impl Stated {
    fn read(path: &Path) -> Stated {
        let text = std::fs::read_to_string(path).unwrap();
        let mut rows = text
            .lines()
            .map(|row| row.split_whitespace().collect::<Vec<_>>());
        let mut stated = Stated {
            case: Case::default(),
            facts: HashMap::new(),
            peers: Vec::new(),
        };
        while let Some(row) = rows.next() {
            let mut take = |count: &str| {
                rows.by_ref()
                    .take(count.parse().unwrap())
                    .collect::<Vec<_>>()
            };
            match row[..] {
                ["vertices", count, "2"] => {
                    let point = |row: Vec<&str>| [row[0].parse().unwrap(), row[1].parse().unwrap()];
                    stated.case.points = take(count).into_iter().map(point).collect();
                }
                ["edges", count] => {
                    let line = |row: Vec<&str>| row.iter().map(|i| i.parse().unwrap()).collect();
                    stated.case.lines = take(count).into_iter().map(line).collect();
                }
                ["holes", count] => drop(take(count)),
                ["expect", tag, count] => stated.peers.push((tag.to_owned(), take(count).len())),
                ["fact", key, value] => stated
                    .facts
                    .extend(value.parse().map(|value| (key.to_owned(), value))),
                _ => {}
            }
        }
        stated
    }
}

/// Returns our values for the facts that are compared, by name. The counts of an unconstrained
/// triangulation always hold; those of edges hold as far as no line is split.
fn ours(stated: &Stated, built: &Built) -> Vec<(&'static str, usize)> {
    let Stated { case, facts, .. } = stated;
    let (delaunay, _) = Delaunay::from_points(Plane::default(), &case.points).unwrap();
    let _: &Delaunay<Plane, 3> = &delaunay;
    let t = &built.triangulation;
    let triangles = if t.dimension() == 2 {
        t.finite_cells().count()
    } else {
        0
    };
    let is_hull = |cell| t.tds().is_infinite(cell);
    let mut ours = vec![
        ("unique_vertices", delaunay.vertex_count()),
        (
            "delaunay_triangles",
            if delaunay.dimension() == 2 {
                delaunay.finite_cells().count()
            } else {
                0
            },
        ),
        ("cdt_triangles_convex_hull", triangles),
    ];
    if t.vertex_count() == delaunay.vertex_count() && t.dimension() == 2 {
        ours.push((
            "hull_boundary_points",
            t.tds().cells().filter(|&cell| is_hull(cell)).count(),
        ));
    }
    if facts.contains_key("edge_proper_crossings") {
        ours.push((
            "edge_proper_crossings",
            judge::crossing_count(&without_repeats(case)),
        ));
    }
    let is_split = [
        "edge_proper_crossings",
        "edge_collinear_overlaps",
        "vertex_on_edge_interior",
    ];
    if is_split
        .iter()
        .all(|fact| facts.get(*fact).is_none_or(|&count| count == 0))
    {
        ours.push(("edges_unique", t.constrained_edges().count()));
    }
    ours
}

/// Returns the case with every pair of points joined at most once.
fn without_repeats(case: &Case) -> Case {
    let mut seen = HashSet::new();
    let mut lines = case.lines.clone();
    lines.retain(|line| {
        let mut ends =
            [0, 1].map(|end| case.points[line[end] as usize].map(|x| (x + 0.0).to_bits()));
        ends.sort_unstable();
        ends[0] != ends[1] && seen.insert(ends)
    });
    Case {
        points: case.points.clone(),
        lines,
    }
}

/// Peers that triangulate the whole hull, without points of their own.
fn is_of_hull(tag: &str, facts: &HashMap<String, usize>) -> bool {
    tag == "triangle"
        || (tag.ends_with("_super")
            && facts
                .get("edge_proper_crossings")
                .is_none_or(|&count| count == 0))
}

/// Returns the faults of a case, and counts what was compared.
fn compare(path: &Path, compared: &mut BTreeMap<String, usize>) -> Result<(), String> {
    let stated = Stated::read(path);
    let built = build(&stated.case).map_err(|refused| refused.to_string())?;
    judge::judge(&stated.case, &built)?;
    judge::judge_order(&stated.case, &built, &mut Random(1))?;
    if stated.case.points.len() < 3000 {
        judge::judge_slowly(&stated.case, &built)?;
    }
    let ours = ours(&stated, &built);
    for (fact, ours) in &ours {
        let Some(&known) = stated.facts.get(*fact) else {
            continue;
        };
        *compared.entry((*fact).to_owned()).or_default() += 1;
        if *ours != known {
            return Err(format!("{fact}: {ours}, should be {known}"));
        }
    }
    let triangles = built.triangulation.finite_cells().count();
    for (tag, known) in stated
        .peers
        .iter()
        .filter(|(tag, _)| is_of_hull(tag, &stated.facts))
    {
        *compared.entry("peers".to_owned()).or_default() += 1;
        if triangles != *known {
            return Err(format!("{triangles} triangles, {tag} has {known}"));
        }
    }
    Ok(())
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    entries
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn known_counts() {
    let folder = testkit::shared("tri2d");
    let mut faults = Vec::new();
    println!("| family | files | passed | compared |\n|---|---|---|---|");
    for family in entries(&folder) {
        let name = family.file_name().unwrap().to_string_lossy();
        if name == "weighted" {
            continue; // there is no regular triangulation
        }
        let files = entries(&family);
        let mut compared = BTreeMap::new();
        let before = faults.len();
        for file in &files {
            if let Err(what) = compare(file, &mut compared) {
                faults.push(format!(
                    "{}: {what}",
                    file.strip_prefix(&folder).unwrap().display()
                ));
            }
        }
        let compared: Vec<String> = compared
            .iter()
            .map(|(what, count)| format!("{what} {count}"))
            .collect();
        let passed = files.len() - (faults.len() - before);
        println!(
            "| {name} | {} | {passed} | {} |",
            files.len(),
            compared.join(", ")
        );
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
