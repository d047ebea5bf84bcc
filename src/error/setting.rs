//! Names for what texts mention: settings of requests, commands, and features of a build.

/// Defines the settings, all of them as a list, and their names.
macro_rules! settings {
    ($($setting:ident = $name:literal,)+) => {
        /// Something that a caller can set in a request.
        ///
        /// Errors and notices mention settings as values of this type, and each caller shows them
        /// by the names that it has: the command line as options, Python as parameters.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Setting {
            $(#[doc = concat!("The setting `", $name, "`.")] $setting,)+
        }

        impl Setting {
            /// All settings.
            pub const ALL: &'static [Setting] = &[$(Setting::$setting),+];

            /// Returns the name of the setting, as in plans and where a caller has no names of its
            /// own.
            pub fn name(self) -> &'static str {
                match self {
                    $(Setting::$setting => $name,)+
                }
            }
        }
    };
}

settings! {
    AccuracyClass = "accuracy-class",
    AddRidges = "add-ridges",
    AlignTo = "align-to",
    Along = "along",
    Alpha = "alpha",
    Altitude = "altitude",
    Azimuth = "azimuth",
    Bands = "bands",
    Base = "base",
    Boundary = "boundary",
    Bounds = "bounds",
    Breaklines = "breaklines",
    Buffer = "buffer",
    Class = "class",
    Columns = "columns",
    Convex = "convex",
    CopcResolution = "copc-resolution",
    CreationOptions = "creation-options",
    CrossingReport = "crossing-report",
    CrossingTolerance = "crossing-tolerance",
    CrossingZ = "crossing-z",
    Crs = "crs",
    Datum = "datum",
    Densify = "densify",
    DrapedLines = "draped-lines",
    Driver = "driver",
    DropWithheld = "drop-withheld",
    Duplicates = "duplicates",
    Epoch = "epoch",
    Exaggeration = "exaggeration",
    Extent = "extent",
    Fill = "fill",
    Flat = "flat",
    FlatBuffer = "flat-buffer",
    FlatHeight = "flat-height",
    FlatPoints = "flat-points",
    FlatTolerance = "flat-tolerance",
    ForceDegrees = "force-degrees",
    Formula = "formula",
    Ground = "ground",
    GroupBy = "group-by",
    Holes = "holes",
    InSpace = "in-space",
    IndexEvery = "index-every",
    Interval = "interval",
    Job = "job",
    KeepDepressions = "keep-depressions",
    Kernel = "kernel",
    LabelHeight = "label-height",
    Labels = "labels",
    LabelsOutput = "labels-output",
    LayerOptions = "layer-options",
    Levels = "levels",
    Lines = "lines",
    LineTolerance = "line-tolerance",
    Match = "match",
    MaxAdded = "max-added",
    MaxArea = "max-area",
    MaxEdge = "max-edge",
    MaxEdgeInside = "max-edge-inside",
    MaxError = "max-error",
    MaxLevel = "max-level",
    Memory = "memory",
    Method = "method",
    MinAngle = "min-angle",
    MinArea = "min-area",
    MinLength = "min-length",
    OnCrossing = "on-crossing",
    Overviews = "overviews",
    Overwrite = "overwrite",
    Parse = "parse",
    Partial = "partial",
    Percent = "percent",
    Plain = "plain",
    Prefix = "prefix",
    Preset = "preset",
    Ramp = "ramp",
    RegionAreas = "region-areas",
    RequireGrids = "require-grids",
    Resolution = "resolution",
    Resume = "resume",
    Return = "return",
    RiverWidth = "river-width",
    Rivers = "rivers",
    Round = "round",
    Seed = "seed",
    Shading = "shading",
    Shrink = "shrink",
    Simplify = "simplify",
    SkipBad = "skip-bad",
    Smooth = "smooth",
    SoftLines = "soft-lines",
    Start = "start",
    Stations = "stations",
    Step = "step",
    Swell = "swell",
    Target = "target",
    TargetCrs = "target-crs",
    Thin = "thin",
    ThinKeep = "thin-keep",
    Tile = "tile",
    Tiles = "tiles",
    TwoDimensions = "2d",
    Unit = "unit",
    Update = "update",
    Vegetated = "vegetated",
    VerticalOffset = "vertical-offset",
    WallBottom = "wall-bottom",
    WallDrop = "wall-drop",
    WallHigh = "wall-high",
    WallWidth = "wall-width",
    Walls = "walls",
    Weighted = "weighted",
    Within = "within",
    ZFactor = "z-factor",
}

impl Setting {
    /// Returns the setting with this name.
    pub fn from_name(name: &str) -> Option<Setting> {
        Setting::ALL
            .iter()
            .copied()
            .find(|setting| setting.name() == name)
    }

    /// Returns the setting switched on.
    pub fn on(self) -> Term {
        Term::On(self)
    }

    /// Returns the setting with a word or another text as its value, or a name that stands for one,
    /// such as `FILE`.
    pub fn text(self, value: impl Into<String>) -> Term {
        Term::Text(self, value.into())
    }

    /// Returns the setting with a number as its value, or a name that stands for one, such as
    /// `LENGTH`.
    pub fn number(self, value: impl Into<String>) -> Term {
        Term::Number(self, value.into())
    }
}

/// What a text mentions, and each caller names in its own words.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Term {
    /// A setting.
    Setting(Setting),
    /// A setting that is switched on.
    On(Setting),
    /// A setting whose value is a text.
    Text(Setting, String),
    /// A setting whose value is a number.
    Number(Setting, String),
    /// A command, and the file that it is run on, if the text names one.
    Command(Command, Option<String>),
    /// How to build this program with a feature.
    Build(Feature),
}

/// A command that a text refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// Shows what is in a file.
    Info,
    /// Writes points.
    Points,
    /// Finds the ground among points.
    Ground,
    /// Builds a surface.
    Tin,
    /// Triangulates plain points or graphs.
    Triangulate,
    /// Triangulates points in space.
    TriangulateInSpace,
    /// Checks a surface.
    Check,
    /// Does the tasks of a job.
    JobRun,
    /// Does tasks of a job together with other processes.
    JobWork,
    /// Verifies the tasks of a job that are done.
    JobVerify,
    /// Removes a job.
    JobClean,
}

impl Command {
    /// All commands.
    pub const ALL: &'static [Command] = &[
        Command::Info,
        Command::Points,
        Command::Ground,
        Command::Tin,
        Command::Triangulate,
        Command::TriangulateInSpace,
        Command::Check,
        Command::JobRun,
        Command::JobWork,
        Command::JobVerify,
        Command::JobClean,
    ];

    /// Returns the command, run on this file.
    pub fn on(self, file: impl Into<String>) -> Term {
        Term::Command(self, Some(file.into()))
    }

    /// Returns what the command does, as a name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Command::Info => "info",
            Command::Points => "points",
            Command::Ground => "ground",
            Command::Tin => "tin",
            Command::Triangulate => "triangulate",
            Command::TriangulateInSpace => "triangulate in space",
            Command::Check => "check",
            Command::JobRun => "job run",
            Command::JobWork => "job work",
            Command::JobVerify => "job verify",
            Command::JobClean => "job clean",
        }
    }
}

/// A feature that this program can be built with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Files that only GDAL reads.
    Gdal,
    /// GeoPackage, by SQLite.
    Gpkg,
    /// Reprojection with PROJ.
    Proj,
    /// PROJ's grids in GeoTIFF.
    ProjTiff,
}

impl Feature {
    /// All features that texts mention.
    pub const ALL: &'static [Feature] = &[
        Feature::Gdal,
        Feature::Gpkg,
        Feature::Proj,
        Feature::ProjTiff,
    ];

    /// Returns the name of the feature in the manifest.
    pub fn name(self) -> &'static str {
        match self {
            Feature::Gdal => "gdal",
            Feature::Gpkg => "gpkg",
            Feature::Proj => "proj",
            Feature::ProjTiff => "proj-tiff",
        }
    }
}

impl Term {
    /// Returns the term for a caller without names of its own.
    pub(super) fn plain(&self) -> String {
        match self {
            Term::Setting(setting) | Term::On(setting) => setting.name().to_owned(),
            Term::Text(setting, value) | Term::Number(setting, value) => {
                format!("{} {value}", setting.name())
            }
            Term::Command(command, None) => format!("`{}`", command.name()),
            Term::Command(command, Some(file)) => format!("`{} {file}`", command.name()),
            Term::Build(feature) => format!("the feature `{}`", feature.name()),
        }
    }
}
