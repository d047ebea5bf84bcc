use std::path::PathBuf;

use serde_json::{Value, json};

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use crate::cli::Exit;
use crate::cli::input::args::DrapeArgs;
use crate::cli::input::inputs;
use crate::cli::input::outputs::{Formats, Target};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::counted;
use crate::data::{Layer, Shape};
use crate::error::Result;
use crate::io::OutputSet;
use crate::io::formats::Product as Contents;
use crate::run::{self, Context, DrapeOptions, DrapeProduct, Input, SurfaceProduct};

/// Drapes lines over a surface.
pub(crate) fn run(args: &DrapeArgs, console: &Console) -> Result<Exit> {
    let drape = Drape::of(args, console)?;
    let surface = pair::read_one(&drape, &args.memory, console)?;
    let json = args.json.then_some(product::in_lines as _);
    product::finish(&drape, &[surface], json, console)
}

/// Lines that are to be draped.
pub(super) struct Drape<'a> {
    args: &'a DrapeArgs,
    plan: ProductPlan,
    targets: Vec<Target<()>>,
}

impl<'a> Drape<'a> {
    /// Returns what is asked for.
    ///
    /// # Errors
    /// If files are missing, options do not go together or an output cannot be written.
    pub(super) fn of(args: &'a DrapeArgs, console: &Console) -> Result<Self> {
        inputs::require([&args.lines])?;
        pair::refuse_tables(&args.surface, "drape")?;
        let surface = SurfacePlan::resolve(&args.surface, console)?;
        let options = args.driver.options();
        let formats = Formats::of_product(Contents::Lines, &options);
        let lines = args.lines.clone();
        let (plan, targets) = ProductPlan::resolve(vec![surface], [lines], &args.output, formats)?;
        Ok(Drape {
            args,
            plan,
            targets,
        })
    }
}

impl Product for Drape<'_> {
    fn plan(&self) -> &ProductPlan {
        &self.plan
    }

    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome> {
        let args = self.args;
        let [surface] = surfaces else {
            return Err(pair::no_surface());
        };
        let options = DrapeOptions {
            lines: Input::File(args.lines.clone()),
            assign: self.plan.assigned(),
            step: args.step,
            name: args
                .surface
                .inputs
                .first()
                .cloned()
                .unwrap_or_else(|| PathBuf::from("of lines")),
        };
        let product = run::drape(surface, &options, context)?;
        for target in &self.targets {
            product.write(target.within(set), context)?;
        }
        let (parts, vertices) = sizes(&product.layer);
        let line = format!(
            "lines       {}, {} on the surface with {vertices} vertices",
            counted(product.layer.shapes.len() as u64, "record"),
            counted(parts, "part")
        );
        Ok(Outcome::Answer(Answer {
            lines: vec![line],
            json: as_json(&product),
            ..Answer::default()
        }))
    }
}

/// Returns the numbers of parts and of vertices of the lines of a layer.
fn sizes(layer: &Layer) -> (u64, u64) {
    let lines = layer.shapes.iter().map(|shape| match shape {
        Shape::Lines(parts) => (parts.len() as u64, shape.vertices().count() as u64),
        _ => (0, 0),
    });
    lines.fold((0, 0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
}

fn as_json(product: &DrapeProduct) -> Value {
    let (parts, vertices) = sizes(&product.layer);
    json!({
        "records": product.layer.shapes.len(),
        "parts": parts,
        "vertices": vertices,
        "off": product.off,
        "partly_off": product.partly_off,
    })
}
