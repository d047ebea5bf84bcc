use std::path::PathBuf;

use serde_json::json;

use super::pair;
use crate::cli::Exit;
use crate::cli::input::args::DrapeArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::input::{inputs, outputs};
use crate::cli::report::console::Console;
use crate::cli::report::escape;
use crate::cli::report::stdout::print;
use crate::cli::report::summary::{counted, print_surface};
use crate::cli::report::written::commit;
use crate::data::{Layer, Shape};
use crate::error::Result;
use crate::io::formats::Product;
use crate::run::{self, DrapeOptions, DrapeProduct, Input, SurfaceReport};
use crate::terrain::Method;

/// Drapes lines over a surface.
pub(crate) fn run(args: &DrapeArgs, console: &Console) -> Result<Exit> {
    inputs::require([&args.lines])?;
    pair::refuse_tables(&args.surface, "drape")?;
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let mut read = plan.targets.with_lists(plan.request.files());
    read.push(args.lines.clone());
    let outputs = outputs::resolve(
        &args.output,
        &outputs::formats_of(Product::Lines, |_| ()),
        &read,
    )?;
    let context = console.context();
    let memory = args.memory.memory;
    let mut surface = run::open_surface(&plan.request, Method::Linear, memory, &context)?;
    print_surface(&SurfaceReport::take(&mut surface)?, console);
    let options = DrapeOptions {
        lines: Input::File(args.lines.clone()),
        assign: pair::assigned(&plan),
        step: args.step,
        name: args
            .surface
            .inputs
            .first()
            .cloned()
            .unwrap_or_else(|| PathBuf::from("of lines")),
    };
    let product = run::drape(&surface, &options, &context)?;
    for target in &outputs.targets {
        product.write(target.within(&outputs.set), &context)?;
    }
    commit(outputs, console)?;
    let (parts, vertices) = sizes(&product.layer);
    console.line(format_args!(
        "lines       {}, {} on the surface with {vertices} vertices",
        counted(product.layer.shapes.len() as u64, "record"),
        counted(parts, "part")
    ));
    if args.json {
        print(&as_json(&product))?;
    }
    Ok(Exit::Done)
}

/// Returns the numbers of parts and of vertices of the lines of a layer.
fn sizes(layer: &Layer) -> (u64, u64) {
    let lines = layer.shapes.iter().map(|shape| match shape {
        Shape::Lines(parts) => (parts.len() as u64, shape.vertices().count() as u64),
        _ => (0, 0),
    });
    lines.fold((0, 0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
}

fn as_json(product: &DrapeProduct) -> String {
    let (parts, vertices) = sizes(&product.layer);
    let all = json!({
        "records": product.layer.shapes.len(),
        "parts": parts,
        "vertices": vertices,
        "off": product.off,
        "partly_off": product.partly_off,
    });
    escape::json(&format!("{all:#}\n"))
}
