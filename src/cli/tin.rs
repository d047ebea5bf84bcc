use super::args::TinArgs;
use super::open;
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::talk::Talk;
use super::{Exit, gather};
use crate::error::Result;

pub(super) const FORMATS: &[Format<()>] = &[
    Format { extension: "ply", kind: (), companions: &[] },
    Format { extension: "obj", kind: (), companions: &[] },
    Format { extension: "off", kind: (), companions: &[] },
    Format { extension: "stl", kind: (), companions: &["stl.origin.txt"] },
];

/// Builds a TIN and writes it as a mesh.
pub(super) fn run(args: &TinArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let outputs = outputs::resolve_with_report(&args.output, FORMATS, &plan)?;
    let gathered = gather::surface(&mut plan, &outputs.set, talk)?;
    let surface = gathered.surface.as_ref();
    for target in &outputs.targets {
        let written = open::write_mesh(target.within(&outputs.set), surface, talk)?;
        outputs::tell_lost(&target.path, written.lost_edges, ".ply keeps them", talk);
        if let Some(([x, y, z], beside)) = written.origin {
            let (mesh, beside) = (target.path.display(), beside.display());
            talk.note(format_args!("{mesh}: coordinates are relative to {x} {y} {z}, as {beside} says"));
        }
    }
    gathered.made.tell(surface, talk);
    outputs.commit(talk)?;
    Ok(Exit::Done)
}
