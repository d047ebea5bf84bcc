use super::args::TinArgs;
use super::open::{self, MeshFormat};
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::talk::Talk;
use super::{Exit, gather};
use crate::error::Result;

const FORMATS: &[Format<MeshFormat>] = &[
    Format { extension: "ply", kind: MeshFormat::Ply, companions: &[] },
    Format { extension: "obj", kind: MeshFormat::Obj, companions: &[] },
    Format { extension: "stl", kind: MeshFormat::Stl, companions: &[] },
];

/// Builds a TIN and writes it as a mesh.
pub(super) fn run(args: &TinArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let targets = outputs::resolve(&args.output, FORMATS, &plan.inputs)?;
    let gathered = gather::surface(&mut plan, talk)?;
    let surface = gathered.surface.as_ref();
    for target in &targets {
        for note in open::write_mesh(&target.path, target.kind, surface).map_err(|e| e.in_file(&target.path))? {
            talk.note(format_args!("{}: {note}", target.path.display()));
        }
    }
    gathered.made.tell(surface, talk);
    outputs::tell(&targets, talk);
    Ok(Exit::Done)
}
