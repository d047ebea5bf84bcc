use super::Exit;
use super::args::TinArgs;
use super::outputs;
use super::plan::SurfacePlan;
use super::summary::tell_surface;
use super::talk::Talk;
use crate::error::Result;
use crate::io::formats::Product;
use crate::run;

/// Builds a TIN and writes it as a mesh.
pub(super) fn run(args: &TinArgs, talk: &Talk) -> Result<Exit> {
    let plan = SurfacePlan::resolve(&args.surface, talk)?;
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Surface, |_| ()), &plan)?;
    let product = run::triangles(&plan.request, &talk.context())?;
    outputs.add_report(&plan, &product)?;
    for target in &outputs.targets {
        let written = run::write_mesh(product.triangles()?, target.within(&outputs.set), &talk.context())?;
        outputs::tell_lost(&target.path, written.lost_edges, ".ply keeps them", talk);
        if let Some(([x, y, z], beside)) = written.origin {
            let (mesh, beside) = (target.path.display(), beside.display());
            talk.note(format_args!("{mesh}: coordinates are relative to {x} {y} {z}, as {beside} says"));
        }
    }
    tell_surface(&product, talk);
    outputs.commit(talk)?;
    Ok(Exit::Done)
}
