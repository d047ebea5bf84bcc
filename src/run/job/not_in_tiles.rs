//! What tiles cannot do yet.

use crate::error::{Command, Error, Result, Setting, Wording, wording};
use crate::run::products::surface::{Source, SurfaceRequest};
use crate::run::products::tin::{ReplacedPoints, TinRequest};
use crate::run::sources::systems::SystemOptions;
use crate::run::verbs::WriteRequest;
use crate::terrain::Method;

/// What a request has and tiles do not: the whole surface is built in memory for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotInTiles {
    /// Vertices are added on ridges and valleys.
    Ridges,
    /// The ground is searched among all points.
    Ground,
    /// Longest edges anywhere, where there is water.
    EdgesBesideWater,
    /// The crossings of lines are listed.
    CrossingReport,
    /// Points that lines replace are kept, and listed.
    ReplacedPoints,
    /// Heights are not linear.
    Method,
}

impl NotInTiles {
    /// Returns what a request for a surface has and tiles do not.
    pub(super) fn of(request: &TinRequest) -> Option<Self> {
        let known = [
            (NotInTiles::Ridges, request.lines.add_ridges),
            (NotInTiles::Ground, request.ground.is_some()),
            (
                NotInTiles::EdgesBesideWater,
                request.max_edge_inside.is_some() && request.lines.has_water(),
            ),
            (
                NotInTiles::ReplacedPoints,
                request.replaced == ReplacedPoints::Keep,
            ),
        ];
        known
            .into_iter()
            .find(|(_, is_given)| *is_given)
            .map(|(what, _)| what)
    }

    /// Returns the settings that ask for it.
    fn settings(self) -> Wording {
        match self {
            NotInTiles::Ridges => Setting::AddRidges.into(),
            NotInTiles::Ground => Setting::Ground.into(),
            NotInTiles::EdgesBesideWater => {
                wording![
                    Setting::MaxEdgeInside,
                    " together with ",
                    Setting::Flat,
                    " or ",
                    Setting::Rivers
                ]
            }
            NotInTiles::CrossingReport => Setting::CrossingReport.into(),
            NotInTiles::ReplacedPoints => Setting::FlatPoints.into(),
            NotInTiles::Method => Setting::Method.into(),
        }
    }
}

impl From<NotInTiles> for Error {
    #[cold]
    fn from(what: NotInTiles) -> Self {
        if what == NotInTiles::Method {
            let cure = wording![
                Command::Tin,
                " writes the surface in parts (.tins), of which any method takes heights in memory; or leave out ",
                what.settings(),
                ", or ",
                Setting::Tiles
            ];
            return Error::unsupported("tiles have linear heights only").cure(cure);
        }
        let whole = " the whole surface is built in memory";
        Error::unsupported(wording![what.settings(), " does not work with tiles yet"]).cure(
            wording!["leave one of them out: without ", Setting::Tiles, whole],
        )
    }
}

/// Returns the request of the points of a surface.
pub(super) fn tiled(wanted: &WriteRequest) -> Result<(&TinRequest, &SystemOptions)> {
    let SurfaceRequest { source, systems } = &wanted.surface;
    let Source::Points(points) = source else {
        return Err(
            Error::usage("tiles are made of points, but the input is a surface already")
                .cure("leave out the options of tiles"),
        );
    };
    if wanted.verb.method() != Method::Linear {
        return Err(NotInTiles::Method.into());
    }
    Ok((points, systems))
}
