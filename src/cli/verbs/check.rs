use std::path::Path;

use crate::cli::Exit;
use crate::cli::input::args::CheckArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::summary::{counted, print_surface};
use crate::cli::report::written::print_file;
use crate::data::SurfaceFacts;
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::{self, CheckProduct, Existing, SpaceCheck, SpaceLaw, SurfaceReport, Targets};

/// Lists the flaws of a TIN, or of a mesh that may not be a surface.
pub(crate) fn run(args: &CheckArgs, console: &Console) -> Result<Exit> {
    if let [path] = &args.surface.inputs[..]
        && run::is_of_space(path)
    {
        let law = if args.weighted {
            SpaceLaw::Regular
        } else {
            SpaceLaw::Delaunay
        };
        return check_space(path, law, console);
    }
    if args.weighted {
        return Err(Error::usage("--weighted is for the tetrahedra of an .ele")
            .cure("leave out --weighted"));
    }
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let targets = Targets {
        existing: Existing::of(args.overwrite),
        ..plan.targets
    };
    let read = targets.with_lists(plan.request.files());
    targets.check_tables(&read)?;
    let outputs = OutputSet::default();
    let CheckProduct {
        mut product, flaws, ..
    } = run::check(&plan.request, &console.context())?;
    targets.write_tables(&product, &outputs)?;
    for flaw in &flaws {
        print(&format!("{flaw}\n"))?;
    }
    print_surface(&SurfaceReport::take(&mut product)?, console);
    outputs
        .commit()?
        .iter()
        .for_each(|path| print_file(path, console));
    let SurfaceFacts {
        vertices,
        triangles,
        edges,
        ..
    } = product.facts()?;
    let what = format!(
        "{vertices} vertices, {triangles} triangles, {} constrained edges",
        edges.total()
    );
    match flaws.len() {
        0 => {
            print(&format!("{what}: no flaw found\n"))?;
            Ok(Exit::Done)
        }
        count => {
            print(&format!("{what}: {}\n", counted(count as u64, "flaw")))?;
            Ok(Exit::Failed)
        }
    }
}

/// Lists the flaws of tetrahedra.
fn check_space(path: &Path, law: SpaceLaw, console: &Console) -> Result<Exit> {
    let SpaceCheck {
        vertices,
        tetrahedra,
        flaws,
        ..
    } = run::check_space(path, law, &console.context())?;
    for flaw in &flaws {
        print(&format!("{flaw}\n"))?;
    }
    let what = format!("{vertices} vertices, {tetrahedra} tetrahedra");
    match flaws.len() {
        0 => print(&format!("{what}: no flaw found\n")).map(|()| Exit::Done),
        count => {
            print(&format!("{what}: {}\n", counted(count as u64, "flaw"))).map(|()| Exit::Failed)
        }
    }
}
