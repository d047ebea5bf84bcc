//! What a run file would make.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::commands::quoted;
use super::summary::counted;
use crate::run::SurfaceEstimate;
use crate::run::units::bytes;

/// What would be made, and of what.
#[derive(Debug)]
pub(crate) struct RunPlan {
    pub(crate) surfaces: Vec<PlannedSurface>,
    pub(crate) products: Vec<PlannedFiles>,
    /// The list that single commands read, if one of them reads several files as one surface.
    pub(crate) list: String,
    /// What that list has; empty if it is not needed.
    pub(crate) listed: Vec<PathBuf>,
}

/// A surface that would be built or read.
#[derive(Debug)]
pub(crate) struct PlannedSurface {
    pub(crate) reads: Vec<PathBuf>,
    /// What it will need; `None` if it is read from a file.
    pub(crate) estimate: Option<SurfaceEstimate>,
}

/// A product that would be made.
#[derive(Debug)]
pub(crate) struct PlannedFiles {
    pub(crate) verb: String,
    /// The numbers of its surfaces.
    pub(crate) surfaces: Vec<usize>,
    pub(crate) reads: Vec<PathBuf>,
    pub(crate) writes: Vec<PathBuf>,
    /// The single command that makes the same.
    pub(crate) command: String,
}

/// Returns a plan as an object.
pub(crate) fn json(plan: &RunPlan) -> Value {
    let surface = |surface: &PlannedSurface| {
        let estimate = surface.estimate.as_ref();
        json!({
            "reads": texts(&surface.reads),
            "points": estimate.map(|estimate| estimate.points),
            "memory": estimate.map(|estimate| estimate.memory),
            "in_files": estimate.map(|estimate| estimate.in_files),
        })
    };
    let product = |product: &PlannedFiles| {
        json!({
            "verb": product.verb,
            "surfaces": product.surfaces,
            "reads": texts(&product.reads),
            "writes": texts(&product.writes),
            "command": product.command,
        })
    };
    json!({
        "surfaces": plan.surfaces.iter().map(surface).collect::<Vec<_>>(),
        "products": plan.products.iter().map(product).collect::<Vec<_>>(),
        "lists": match plan.listed.is_empty() {
            true => json!({}),
            false => json!({ &plan.list: texts(&plan.listed) }),
        },
    })
}

/// Returns a plan as text: the surfaces, the products with their files, and the single commands.
pub(crate) fn text(plan: &RunPlan) -> String {
    let mut text = String::new();
    let mut line = |name: &str, what: &str| text += &format!("{name:<11} {what}\n");
    for (number, surface) in plan.surfaces.iter().enumerate() {
        let how = match &surface.estimate {
            None => "read from its file".to_owned(),
            Some(estimate) => {
                let where_built = match estimate.in_files {
                    true => "built in tiles, used in its files",
                    false => "built in one piece",
                };
                format!(
                    "about {}, {} of memory, {where_built}",
                    counted(estimate.points, "point"),
                    bytes(estimate.memory)
                )
            }
        };
        line(&format!("surface {}", number + 1), &how);
        line("", &format!("of {}", texts(&surface.reads).join(", ")));
    }
    for (number, product) in plan.products.iter().enumerate() {
        let numbers: Vec<String> = product
            .surfaces
            .iter()
            .map(|of| (of + 1).to_string())
            .collect();
        let files = match texts(&product.writes).join(", ") {
            files if files.is_empty() => "no file".to_owned(),
            files => files,
        };
        let what = format!(
            "{} of surface {}: {files}",
            product.verb,
            numbers.join(" and ")
        );
        line(&format!("product {}", number + 1), &what);
        let of_surfaces = product
            .surfaces
            .iter()
            .filter_map(|&of| plan.surfaces.get(of));
        let known: Vec<&PathBuf> = of_surfaces.flat_map(|surface| &surface.reads).collect();
        let mut others = product.reads.clone();
        others.retain(|path| !known.contains(&path));
        if !others.is_empty() {
            line("", &format!("also reads {}", texts(&others).join(", ")));
        }
    }
    text += "\nThe same by single commands:\n";
    if !plan.listed.is_empty() {
        let files: Vec<String> = texts(&plan.listed)
            .iter()
            .map(|file| quoted(file))
            .collect();
        text += &format!("  printf '%s\\n' {} > {}\n", files.join(" "), plan.list);
    }
    for product in &plan.products {
        text += &format!("  {}\n", product.command);
    }
    text
}

/// Returns paths as they are shown.
pub(crate) fn texts(paths: &[PathBuf]) -> Vec<String> {
    let shown = paths.iter().map(|path| path.display().to_string());
    shown.collect()
}
