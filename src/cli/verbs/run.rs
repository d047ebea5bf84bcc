//! Several products of one surface, by a run file.

use std::path::{Path, PathBuf};

use clap::{FromArgMatches, Parser};
use serde_json::{Value, json};

use super::accuracy::Accuracy;
use super::asked::Asked;
use super::compare::Comparison;
use super::drape::Drape;
use super::product::{Outcome, Product, ProductPlan, in_lines};
use super::profile::ProfileAsked;
use super::sample::Sample;
use super::volume::Volume;
use super::write;
use crate::cli::input::args::{Cli, RunArgs, SurfaceArgs, Verb};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::input::run_file::{LIST, ProductWords, RunFile, Vocabulary, refusal};
use crate::cli::report::commands::command_line;
use crate::cli::report::console::{Console, Verbosity};
use crate::cli::report::run_plan::{self, PlannedFiles, PlannedSurface, RunPlan, texts};
use crate::cli::report::stdout::print;
use crate::cli::report::summary::print_surface;
use crate::cli::report::written::{Shown, note_meshes, print_file, print_summary, summary_json};
use crate::cli::{Exit, RunOptions, RunTables};
use crate::error::{Error, Result};
use crate::io::{OutputSet, is_standard_output};
use crate::run::is_read_once;
use crate::run::targets::{ProductFiles, is_same, require_apart};
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
        false => done.print_answers(&planned)?,
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

/// What to do if a product needs what another one makes.
const OF_ANOTHER: &str = "another product makes it: products do not read what others of their run \
    make; use a second run file";

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
        let surface = vocabulary
            .surface_command()
            .try_get_matches_from(words)
            .and_then(|matches| SurfaceArgs::from_arg_matches(&matches))
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

    fn any_has_two_surfaces(&self) -> bool {
        self.products.iter().any(|(words, _)| words.is_of_several)
    }

    /// Returns an error with the cure for a file that another product makes.
    fn of_other_outputs(&self, error: Error, words: &ProductWords) -> Error {
        let is_output_of = |of: &ProductWords, path: &Path| {
            let outputs = of.words.iter().filter_map(|word| word.to_str());
            let mut outputs = outputs.filter_map(|word| word.strip_prefix("--output="));
            outputs.any(|output| is_same(Path::new(output), path))
        };
        let is_of_another = |path: &Path| {
            let mut others = self.products.iter().map(|(other, _)| other);
            !is_output_of(words, path) && others.any(|other| is_output_of(other, path))
        };
        match error.path().is_some_and(is_of_another) {
            true => error.cure(OF_ANOTHER),
            false => error,
        }
    }
}

/// Products whose options and outputs are checked, and their surfaces.
struct Planned<'a> {
    list: Vec<PlannedProduct<'a>>,
    surfaces: SharedSurfaces,
    /// The files of the surface, if one word stands for several.
    listed: Vec<PathBuf>,
}

struct PlannedProduct<'a> {
    words: &'a ProductWords,
    product: Box<dyn Product + 'a>,
    /// The numbers of its surfaces.
    surfaces: Vec<usize>,
}

impl PlannedProduct<'_> {
    fn files(&self) -> &ProductFiles {
        &self.product.plan().files
    }
}

impl<'a> Planned<'a> {
    fn of(
        file: &RunFile,
        parsed: &'a Parsed,
        options: &RunOptions,
        console: &Console,
    ) -> Result<Self> {
        let resolved = SurfacePlan::resolve(&parsed.surface, console);
        let shared = match resolved {
            Ok(plan) => Some(plan),
            // The options may be for the other surface of a product: each resolves its own.
            Err(_) if parsed.surface.inputs.len() == 1 && parsed.any_has_two_surfaces() => None,
            Err(e) => return Err(file.of_surface(e, &Vocabulary::surface_locations(file))),
        };
        let mut surfaces = SharedSurfaces::new(options.memory);
        let mut list = Vec::new();
        for (words, verb) in &parsed.products {
            let product = product_of(verb, shared.as_ref(), console)
                .map_err(|e| file.of_product(parsed.of_other_outputs(e, words), words))?;
            let of_product = product.plan().surfaces.iter();
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
        require_one_reader(&list, &surfaces).map_err(|(words, e)| file.of_product(e, words))?;
        // No product writes it.
        let run_file = ProductFiles {
            writes: Vec::new(),
            reads: file.name().map(PathBuf::from).into_iter().collect(),
        };
        let of_products = list.iter().map(PlannedProduct::files);
        let files: Vec<&ProductFiles> = of_products.chain([&run_file]).collect();
        require_apart(&files).map_err(|(number, e)| match list.get(number) {
            Some(of) => file.of_product(e, of.words),
            None => e,
        })?;
        let has_list = |of: &PlannedProduct| of.words.words.iter().any(|word| word == LIST);
        let listed = match list.iter().any(has_list) {
            true => parsed.surface.inputs.clone(),
            false => Vec::new(),
        };
        Ok(Planned {
            list,
            surfaces,
            listed,
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
                listed(&product.plan().files.writes)
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
            reads: of.files().reads.clone(),
            writes: of.files().writes.clone(),
            command: command_line(&of.words.words),
        };
        let surfaces = (0..self.surfaces.len()).map(surface);
        Ok(RunPlan {
            surfaces: surfaces.collect::<Result<_>>()?,
            products: self.list.iter().map(product).collect(),
            list: LIST.trim_start_matches('@').to_owned(),
            listed: self.listed.clone(),
        })
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
                "files": texts(&of.files().writes),
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
    fn print_answers(&self, planned: &Planned) -> Result<()> {
        let of_products = planned.list.iter().zip(&self.outcomes);
        let texts = of_products.filter_map(|(of, outcome)| match outcome {
            Outcome::Answer(answer) if !answer.text.is_empty() => Some(format!(
                "product {}: {}\n{}",
                of.words.number, of.words.verb, answer.text
            )),
            _ => None,
        });
        let texts: Vec<String> = texts.collect();
        print(&texts.join("\n"))
    }
}

/// Makes sure that what can be read only once, such as the standard input, is read once, and that
/// the standard output has nothing but answers. Returns an error with the product that it is about.
fn require_one_reader<'a>(
    list: &[PlannedProduct<'a>],
    surfaces: &SharedSurfaces,
) -> std::result::Result<(), (&'a ProductWords, Error)> {
    // The file, and the surface that is built of it; a product that reads it itself has none.
    let mut read: Vec<(PathBuf, Option<usize>)> = Vec::new();
    for of_product in list {
        let of_surface = |&number: &usize| {
            let files = surfaces.files(number).into_iter();
            files.map(move |file| (file, Some(number)))
        };
        let mut own: Vec<(PathBuf, Option<usize>)> =
            of_product.surfaces.iter().flat_map(of_surface).collect();
        let others = of_product.files().reads.iter().cloned();
        let others = others.map(|file| (file, None));
        let others: Vec<_> = others
            .filter(|(file, _)| own.iter().all(|(known, _)| known != file))
            .collect();
        own.extend(others);
        own.retain(|(file, _)| is_read_once(file));
        for (i, (file, of)) in own.iter().enumerate() {
            let is_again = read
                .iter()
                .any(|(known, known_of)| known == file && (of.is_none() || known_of != of))
                || own[..i].iter().any(|(known, _)| known == file);
            if is_again {
                let error = Error::usage(format!(
                    "`{}` is named twice, and can be read once",
                    file.display()
                ));
                return Err((of_product.words, error.cure("name a file for one of them")));
            }
        }
        read.extend(own);
        let mut writes = of_product.files().writes.iter();
        if let Some(path) = writes.find(|path| is_standard_output(path)) {
            let error = Error::usage("the output of a run file is not the standard output")
                .in_file(path)
                .cure("name a file: those of all products appear at the end, or none");
            return Err((of_product.words, error));
        }
    }
    Ok(())
}

/// Returns what a verb makes; `shared` is the plan of its surface if it is known.
fn product_of<'a>(
    verb: &'a Verb,
    shared: Option<&SurfacePlan>,
    console: &Console,
) -> Result<Box<dyn Product + 'a>> {
    Ok(match verb {
        Verb::Volume(args) => Box::new(Volume::of(args, shared, console)?),
        Verb::Compare(args) => Box::new(Comparison::of(args, shared, console)?),
        Verb::Profile(args) => Box::new(ProfileAsked::of(args, shared, console)?),
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
    plan: ProductPlan,
}

impl Written {
    fn of(
        Asked {
            request, targets, ..
        }: Asked,
    ) -> Result<Self> {
        let surface = SurfacePlan {
            request: request.surface.clone(),
            targets: targets.clone(),
        };
        let product = SharedProduct::new(request, targets)?;
        let files = ProductFiles {
            writes: product.writes(),
            reads: product.reads(),
        };
        Ok(Written {
            product,
            plan: ProductPlan {
                surfaces: vec![surface],
                files,
            },
        })
    }
}

impl Product for Written {
    fn plan(&self) -> &ProductPlan {
        &self.plan
    }

    fn method(&self) -> Method {
        self.product.method()
    }

    fn needs_whole(&self) -> Option<Error> {
        self.product.needs_whole()
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
