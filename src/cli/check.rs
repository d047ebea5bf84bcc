use super::args::CheckArgs;
use super::outputs::{self, Existing};
use super::plan::{From, SurfacePlan};
use super::summary::SurfaceFacts;
use super::systems::Degrees;
use super::talk::Talk;
use super::{Exit, gather, open, print};
use crate::error::Result;

/// Lists the flaws of a TIN, or of a mesh that may be none.
pub(super) fn run(args: &CheckArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    // Nothing that is checked is a length.
    plan.wish.degrees = Degrees::Allow;
    let outputs = outputs::resolve_report(Existing::of(args.overwrite), &plan)?;
    let (gathered, flaws) = match &plan.from {
        From::Mesh(path) => {
            if !open::keeps_lines(path) {
                talk.note(format_args!(
                    "{}: the format does not tell breaklines from other edges: the Delaunay law is not checked",
                    path.display()
                ));
            }
            gather::mesh_with_flaws(path, &plan.wish, talk)?
        }
        From::Points(_) | From::Raster(_) => {
            let gathered = gather::surface(&mut plan, &outputs.set, talk)?;
            let flaws = open::flaws(gathered.surface.as_ref(), talk);
            (gathered, flaws)
        }
    };
    let surface = gathered.surface.as_ref();
    for flaw in &flaws {
        print(&format!("{flaw}\n"))?;
    }
    gathered.made.tell(surface, talk);
    outputs.commit(talk)?;
    let SurfaceFacts { vertices, triangles, breaklines, clips, .. } = SurfaceFacts::of(surface);
    let what = format!("{vertices} vertices, {triangles} triangles, {} constrained edges", breaklines + clips);
    match flaws.len() {
        0 => {
            print(&format!("{what}: no flaw found\n"))?;
            Ok(Exit::Done)
        }
        count => {
            print(&format!("{what}: {count} flaws\n"))?;
            Ok(Exit::Failed)
        }
    }
}
