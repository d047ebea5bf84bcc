//! Several products of one surface, by a run file.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{FromArgMatches, Parser};
use serde_json::{Value, json};

use super::accuracy::Accuracy;
use super::asked::Asked;
use super::compare::Comparison;
use super::drape::Drape;
use super::product::{Outcome, Product, in_lines};
use super::profile::ProfileAsked;
use super::sample::Sample;
use super::volume::Volume;
use super::write;
use crate::cli::input::args::{Cli, RunArgs, SurfaceArgs, Verb};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::input::run_file::{ProductWords, RunFile, Vocabulary, refusal};
use crate::cli::report::commands::command_line;
use crate::cli::report::console::{Console, Verbosity};
use crate::cli::report::run_plan::{self, PlannedFiles, PlannedSurface, RunPlan, texts};
use crate::cli::report::stdout::print;
use crate::cli::report::summary::print_surface;
use crate::cli::report::written::{Shown, note_meshes, print_file, print_summary, summary_json};
use crate::cli::{Exit, RunOptions, RunTables};
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::targets::{ProductFiles, require_apart};
use crate::run::{Context, Origin, SharedProduct, SharedSurfaces, SurfaceProduct, SurfaceReport};
use crate::terrain::Method;

/// Makes the products of a run file.
pub(crate) fn run(args: &RunArgs, console: &Console) -> Result<Exit> {
    let file = RunFile::read(&args.input)?;
    let options = RunOptions {
        overwrite: args.overwrite,
        memory: args.memory.memory,
        dry_run: args.dry_run,
    };
    let parsed = Parsed::of(&file, &options)?;
    let mut planned = Planned::of(&file, &parsed, &options, console)?;
    if args.dry_run {
        let plan = planned.plan(&console.context())?;
        print(&match args.json {
            true => in_lines(&run_plan::json(&plan)),
            false => run_plan::text(&plan),
        })?;
        return Ok(Exit::Done);
    }
    let shown = Shown::new(console, None);
    let done = planned.make(&shown.context(), console)?;
    done.files.iter().for_each(|path| print_file(path, console));
    match args.json {
        true => print(&in_lines(&done.json(&planned)))?,
        false => done.print_answers()?,
    }
    let is_failure =
        |outcome: &Outcome| matches!(outcome, Outcome::Answer(answer) if answer.is_failure);
    Ok(match done.outcomes.iter().any(is_failure) {
        true => Exit::Failed,
        false => Exit::Done,
    })
}

/// Makes the products of a run file or of tables, and returns their report; with
/// [`dry_run`](RunOptions::dry_run), what would be made.
///
/// # Errors
/// Those of [`run`].
pub(crate) fn report_of(
    tables: RunTables<'_>,
    options: &RunOptions,
    context: &Context,
) -> Result<Value> {
    let file = match tables {
        RunTables::File(path) => RunFile::read(path)?,
        RunTables::Json(text) => RunFile::of_json(text)?,
    };
    let console = Console::new(Verbosity::Silent);
    let parsed = Parsed::of(&file, options)?;
    let mut planned = Planned::of(&file, &parsed, options, &console)?;
    if options.dry_run {
        return planned.plan(context).map(|plan| run_plan::json(&plan));
    }
    let done = planned.make(context, &console)?;
    Ok(done.json(&planned))
}

/// The options of a run file, as the command line has them.
struct Parsed {
    surface: SurfaceArgs,
    products: Vec<(ProductWords, Verb)>,
}

impl Parsed {
    fn of(file: &RunFile, options: &RunOptions) -> Result<Self> {
        let vocabulary = Vocabulary::new();
        let locations = Vocabulary::surface_locations(file);
        let words = vocabulary.surface_words(file)?;
        let matches = vocabulary
            .surface_command()
            .try_get_matches_from(words)
            .map_err(|e| file.located(refusal(&e, &locations), "[input]"))?;
        let surface = SurfaceArgs::from_arg_matches(&matches)
            .map_err(|e| file.located(refusal(&e, &locations), "[input]"))?;
        let parse = |mut product: ProductWords| {
            if options.overwrite && !product.words.iter().any(|word| word == "--overwrite") {
                product.words.push("--overwrite".into());
            }
            let words = std::iter::once("breakline".into()).chain(product.words.iter().cloned());
            let cli = Cli::try_parse_from(words)
                .map_err(|e| file.located(refusal(&e, &product.locations), &product.location))?;
            Ok((product, cli.verb))
        };
        Ok(Parsed {
            surface,
            products: vocabulary
                .products(file)?
                .into_iter()
                .map(parse)
                .collect::<Result<_>>()?,
        })
    }
}

/// Products whose options and outputs are checked, and their surfaces.
struct Planned<'a> {
    list: Vec<PlannedProduct<'a>>,
    surfaces: SharedSurfaces,
    /// How many names the inputs of the surface have.
    inputs: usize,
}

struct PlannedProduct<'a> {
    words: &'a ProductWords,
    product: Box<dyn Product + 'a>,
    /// The numbers of its surfaces.
    surfaces: Vec<usize>,
}

impl<'a> Planned<'a> {
    fn of(
        file: &RunFile,
        parsed: &'a Parsed,
        options: &RunOptions,
        console: &Console,
    ) -> Result<Self> {
        let shared = SurfacePlan::resolve(&parsed.surface, console)
            .map_err(|e| file.located(e, "[input]"))?;
        let mut surfaces = SharedSurfaces::new(options.memory);
        let mut list = Vec::new();
        for (words, verb) in &parsed.products {
            let product =
                product_of(verb, &shared, console).map_err(|e| file.located(e, &words.location))?;
            let of_product = product.surfaces().iter();
            let add = |plan: &SurfacePlan| {
                surfaces.add(&plan.request, product.method(), product.needs_whole())
            };
            let numbers = of_product.map(add);
            list.push(PlannedProduct {
                words,
                surfaces: numbers.collect(),
                product,
            });
        }
        let files = list
            .iter()
            .map(|PlannedProduct { product, .. }| ProductFiles {
                writes: product.writes(),
                reads: product.reads(),
            });
        let mut files: Vec<ProductFiles> = files.collect();
        // Nobody writes it.
        files.push(ProductFiles {
            writes: Vec::new(),
            reads: file.name().map(PathBuf::from).into_iter().collect(),
        });
        require_apart(&files).map_err(|(number, e)| match list.get(number) {
            Some(of) => e.within(format_args!(
                "product {} ({})",
                number + 1,
                of.words.location
            )),
            None => e,
        })?;
        Ok(Planned {
            list,
            surfaces,
            inputs: parsed.surface.inputs.len(),
        })
    }

    /// Makes all products, each surface once. All files appear at the end, or none.
    fn make(&mut self, context: &Context, console: &Console) -> Result<Done> {
        let mut set = OutputSet::default();
        let mut done = Done::default();
        let count = self.list.len();
        for number in 0..count {
            let PlannedProduct {
                words,
                product,
                surfaces,
            } = &self.list[number];
            for &surface in surfaces {
                if let Some(report) = self.surfaces.open(surface, context)? {
                    print_surface(&report, console);
                    done.surfaces.push(report);
                }
            }
            console.line(format_args!(
                "product     {} of {count}: {}{}",
                number + 1,
                words.verb,
                listed(&product.writes())
            ));
            let of = surfaces
                .iter()
                .filter_map(|&surface| self.surfaces.get(surface));
            let of: Vec<&SurfaceProduct> = of.collect();
            let outcome = product
                .make(&of, &mut set, context)
                .map_err(|e| e.within(format_args!("product {} ({})", number + 1, words.verb)))?;
            match &outcome {
                Outcome::Written(summary) => {
                    note_meshes(summary, console);
                    let crs = of.first().and_then(|surface| surface.crs());
                    print_summary(summary, crs, console);
                }
                Outcome::Answer(answer) => answer.lines.iter().for_each(|line| console.line(line)),
            }
            done.outcomes.push(outcome);
            let later = &self.list[number + 1..];
            let is_last = |surface: &&usize| !later.iter().any(|of| of.surfaces.contains(surface));
            let last: Vec<usize> = surfaces.iter().filter(is_last).copied().collect();
            last.into_iter()
                .for_each(|surface| self.surfaces.close(surface));
        }
        done.files = set.commit()?;
        Ok(done)
    }

    /// Returns what would be made.
    fn plan(&self, context: &Context) -> Result<RunPlan> {
        let surface = |number: usize| -> Result<PlannedSurface> {
            Ok(PlannedSurface {
                reads: self.surfaces.files(number),
                estimate: self.surfaces.estimate(number, context)?,
            })
        };
        let product = |of: &PlannedProduct| PlannedFiles {
            verb: of.words.verb.clone(),
            surfaces: of.surfaces.clone(),
            reads: of.product.reads(),
            writes: of.product.writes(),
            command: command_line(&self.single(of)),
        };
        let surfaces = (0..self.surfaces.len()).map(surface);
        Ok(RunPlan {
            surfaces: surfaces.collect::<Result<_>>()?,
            products: self.list.iter().map(product).collect(),
        })
    }

    /// Returns the words of the single command. A list stands for several files that are one of the
    /// surfaces of a verb.
    fn single(&self, of: &PlannedProduct) -> Vec<OsString> {
        let mut words = of.words.words.clone();
        if of.words.is_of_several
            && self.inputs > 1
            && let Some(word) = words.get_mut(1)
        {
            *word = "@files.txt".into();
        }
        words
    }
}

/// What was made.
#[derive(Default)]
struct Done {
    outcomes: Vec<Outcome>,
    surfaces: Vec<SurfaceReport>,
    files: Vec<PathBuf>,
}

impl Done {
    /// Returns the reports of all products.
    fn json(&self, planned: &Planned) -> Value {
        let surface = |report: &SurfaceReport| {
            let [vertices, triangles] = match &report.origin {
                Origin::Built(built) => [Some(built.tin.vertices), Some(built.tin.triangles)],
                Origin::Triangles(facts) => [Some(facts.vertices), Some(facts.triangles)],
                Origin::Cells(_) => [None, None],
            };
            json!({
                "vertices": vertices,
                "triangles": triangles,
                "min": report.extent.min,
                "max": report.extent.max,
                "crs": report.crs.as_ref().map(|crs| crs.describe()),
            })
        };
        let product = |(of, outcome): (&PlannedProduct, &Outcome)| {
            let report = match outcome {
                Outcome::Written(summary) => summary_json(summary),
                Outcome::Answer(answer) => answer.json.clone(),
            };
            json!({
                "verb": of.words.verb,
                "files": texts(&of.product.writes()),
                "report": report,
            })
        };
        json!({
            "surfaces": self.surfaces.iter().map(surface).collect::<Vec<_>>(),
            "products": planned.list.iter().zip(&self.outcomes).map(product).collect::<Vec<_>>(),
            "files": texts(&self.files),
        })
    }

    /// Prints what was asked for besides files.
    fn print_answers(&self) -> Result<()> {
        let texts = self.outcomes.iter().filter_map(|outcome| match outcome {
            Outcome::Answer(answer) if !answer.text.is_empty() => Some(answer.text.as_str()),
            _ => None,
        });
        let texts: Vec<&str> = texts.collect();
        print(&texts.join("\n"))
    }
}

/// Returns what a verb makes, of a surface whose plan is known.
fn product_of<'a>(
    verb: &'a Verb,
    shared: &SurfacePlan,
    console: &Console,
) -> Result<Box<dyn Product + 'a>> {
    Ok(match verb {
        Verb::Volume(args) => Box::new(Volume::of(args, Some(shared), console)?),
        Verb::Compare(args) => Box::new(Comparison::of(args, Some(shared), console)?),
        Verb::Profile(args) => Box::new(ProfileAsked::of(args, Some(shared), console)?),
        Verb::Drape(args) => Box::new(Drape::of(args, console)?),
        Verb::Accuracy(args) => Box::new(Accuracy::of(args, console)?),
        Verb::Sample(args) if args.output.is_none() => {
            return Err(Error::usage("no output is named").cure("add output = \"FILE\""));
        }
        Verb::Sample(args) => Box::new(Sample::of(args, console)?),
        other => Box::new(Written::of(write::asked(other, console)?)?),
    })
}

/// What is written of a surface.
struct Written {
    product: SharedProduct,
    plan: [SurfacePlan; 1],
}

impl Written {
    fn of(
        Asked {
            request, targets, ..
        }: Asked,
    ) -> Result<Self> {
        let plan = SurfacePlan {
            request: request.surface.clone(),
            targets: targets.clone(),
        };
        Ok(Written {
            product: SharedProduct::new(request, targets)?,
            plan: [plan],
        })
    }
}

impl Product for Written {
    fn surfaces(&self) -> &[SurfacePlan] {
        &self.plan
    }

    fn method(&self) -> Method {
        self.product.method()
    }

    fn needs_whole(&self) -> Option<Error> {
        self.product.needs_whole()
    }

    fn reads(&self) -> Vec<PathBuf> {
        self.product.reads()
    }

    fn writes(&self) -> Vec<PathBuf> {
        self.product.writes()
    }

    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome> {
        let [surface] = surfaces else {
            return Err(Error::usage("the surface is missing"));
        };
        self.product
            .write(surface, set, context)
            .map(Outcome::Written)
    }
}

/// Returns the names of files after a comma; nothing if there are none.
fn listed(files: &[PathBuf]) -> String {
    match texts(files).join(", ") {
        names if names.is_empty() => names,
        names => format!(", {names}"),
    }
}
