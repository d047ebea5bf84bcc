//! Translation of what users of GDAL and LAStools type by habit; `docs/from-gdal.md` has the table
//! for them.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::CommandFactory;

use super::args::{Cli, expand_switches, finite};
use super::condition;
use crate::error::{Error, Result};
use crate::io::formats::{self, Product};
use crate::io::gdal;
use crate::io::profiles;

/// Words that are typed by habit, and what they mean.
struct Habit {
    typed: &'static [&'static str],
    /// The verbs it applies to; all but `triangulate` if empty.
    verbs: &'static [&'static str],
    meaning: Meaning,
}

/// What a word means, in options of this program.
#[derive(Clone, Copy)]
enum Meaning {
    /// An option with the same values.
    Same(&'static str),
    /// These words.
    Words(&'static [&'static str]),
    /// An option with one number; two equal numbers count as one.
    Square(&'static str),
    /// An option with four numbers, which may be separate words.
    Corners(&'static str),
    /// An option with all numbers that follow.
    List(&'static str),
    /// The next word is an input; if it is a number, it is the value of this option.
    Input(Option<&'static str>),
    /// The name of a format, which must agree with the extension of the output.
    Format,
    /// A creation option, `NAME=VALUE`.
    Creation,
    /// The condition for the records of the layer that was named just before.
    Condition,
    /// What this program does anyway.
    Nothing,
    /// Not possible; the hint says what is.
    Refused(&'static str),
}

use Meaning::{
    Condition, Corners, Creation, Format, Input, List, Nothing, Refused, Same, Square, Words,
};

/// The verbs whose outputs drivers of GDAL may write: rasters, then those of lines.
const DRIVEN: &[&str] = &[
    "dem",
    "hillshade",
    "color-relief",
    "slope",
    "aspect",
    "curvature",
    "roughness",
    "tri",
    "tpi",
    "compare",
    "contour",
    "drape",
];
const RASTERS: &[&str] = DRIVEN.split_at(DRIVEN.len() - 2).0;
const CONTOUR: &[&str] = &["contour"];
const SHADE: &[&str] = &["hillshade"];
const COLOR: &[&str] = &["color-relief"];
/// The verbs that choose points.
const OF_POINTS: &[&str] = &[
    "tin",
    "simplify",
    "dem",
    "contour",
    "hillshade",
    "color-relief",
    "slope",
    "aspect",
    "curvature",
    "roughness",
    "tri",
    "tpi",
    "volume",
    "compare",
    "profile",
    "drape",
    "terrain-tiles",
    "sample",
    "accuracy",
    "check",
    "points",
];
const SURFACES: &[&str] = OF_POINTS.split_at(OF_POINTS.len() - 1).0;
/// The verbs that `gdaldem` has, too, with formulas to choose from.
const BY_FORMULA: &[&str] = &["slope", "aspect", "tri"];

/// The habits; the first that fits applies.
#[rustfmt::skip]
const HABITS: &[Habit] = &[
    Habit { typed: &["--resolution", "-tr", "--tr", "-step", "--step"], verbs: RASTERS, meaning: Square("--resolution") },
    Habit { typed: &["--te", "-te"], verbs: RASTERS, meaning: Corners("--te") },
    Habit { typed: &["--bounds"], verbs: &[], meaning: Corners("--bounds") },
    Habit { typed: &["--te", "-te", "-spat", "-projwin"], verbs: &[],
        meaning: Refused("--bounds XMIN,YMIN,XMAX,YMAX clips the surface; --te is the extent of a raster") },
    Habit { typed: &["-tr", "--tr", "-step"], verbs: &[], meaning: Refused("--resolution is for rasters, such as those of `dem` and `hillshade`") },
    Habit { typed: &["-ts", "-outsize"], verbs: &[], meaning: Refused("--resolution LENGTH is the size of a cell") },
    Habit { typed: &["-a_srs", "--a_srs", "-s_srs", "--s_srs", "--s-srs", "-s-srs", "-a-srs"], verbs: &[], meaning: Same("--a-srs") },
    Habit { typed: &["-t_srs", "--t_srs", "-t-srs"], verbs: &[], meaning: Same("--t-srs") },
    Habit { typed: &["--crs", "-crs"], verbs: &[], meaning: Refused("--a-srs states the system of the input, --t-srs reprojects to another") },
    Habit { typed: &["-odir", "-odix", "-otif", "-opng", "-oasc", "-obil", "-olaz", "-olas"], verbs: &[],
        meaning: Refused("-o FILE names the output; its extension selects the format") },
    Habit { typed: &["-of", "-f"], verbs: DRIVEN, meaning: Same("--of") },
    Habit { typed: &["-co", "--co"], verbs: DRIVEN, meaning: Creation },
    Habit { typed: &["-lco"], verbs: DRIVEN, meaning: Same("--lco") },
    Habit { typed: &["-of", "--of", "-f"], verbs: &[], meaning: Format },
    Habit { typed: &["-co", "--co", "-lco", "--lco"], verbs: &[],
        meaning: Refused("creation options are for rasters and for layers of lines") },
    Habit { typed: &["-overwrite"], verbs: &[], meaning: Same("--overwrite") },
    Habit { typed: &["-quiet"], verbs: &[], meaning: Same("--quiet") },
    Habit { typed: &["-cutline", "--cutline"], verbs: &[], meaning: Same("--boundary") },
    Habit { typed: &["-i"], verbs: CONTOUR, meaning: Input(Some("--interval")) },
    Habit { typed: &["-i", "--input"], verbs: &[], meaning: Input(None) },
    Habit { typed: &["-keep_class", "--keep_class", "-keep_classification"], verbs: &["ground"], meaning: List("--from-class") },
    Habit { typed: &["-keep_class", "--keep_class", "-keep_classification"], verbs: &[], meaning: List("--class") },
    Habit { typed: &["-drop_class", "--drop_class"], verbs: &[], meaning: Refused("--class N,.. lists the classes to use") },
    Habit { typed: &["-keep_every_nth"], verbs: &["points"], meaning: Refused("--thin nth:N keeps the first of every N points") },
    Habit { typed: &["-keep_random_fraction"], verbs: &["points"], meaning: Refused("--thin random:SHARE keeps a share of the points") },
    Habit { typed: &["-parse", "-iparse"], verbs: &[], meaning: Same("--parse") },
    Habit { typed: &["-kill", "-concavity"], verbs: SURFACES, meaning: Same("--max-edge") },
    Habit { typed: &["-first_only", "-keep_first"], verbs: OF_POINTS, meaning: Words(&["--return", "first"]) },
    Habit { typed: &["-last_only", "-keep_last"], verbs: OF_POINTS, meaning: Words(&["--return", "last"]) },
    Habit { typed: &["-first_only", "-keep_first"], verbs: &["ground"], meaning: Words(&["--return", "first"]) },
    Habit { typed: &["-last_only", "-keep_last"], verbs: &["ground"], meaning: Words(&["--return", "last"]) },
    Habit { typed: &["-keep_single"], verbs: OF_POINTS, meaning: Words(&["--return", "single"]) },
    Habit { typed: &["-keep_return"], verbs: OF_POINTS, meaning: List("--return") },
    Habit { typed: &["-keep_xy", "-inside"], verbs: OF_POINTS, meaning: Corners("--bounds") },
    Habit { typed: &["-lakes"], verbs: SURFACES, meaning: Same("--flat") },
    Habit { typed: &["--where", "-where"], verbs: &[], meaning: Condition },
    Habit { typed: &["-creeks"], verbs: SURFACES, meaning: Same("--breaklines") },
    Habit { typed: &["-iso_every"], verbs: CONTOUR, meaning: Same("--interval") },
    Habit { typed: &["-iso_value"], verbs: CONTOUR, meaning: List("--levels") },
    Habit { typed: &["-smooth"], verbs: CONTOUR, meaning: Refused("--smooth TOLERANCE keeps lines this near to the surface; without a number, within half of the interval") },
    Habit { typed: &["-clean"], verbs: CONTOUR, meaning: Same("--min-length") },
    Habit { typed: &["-simplify"], verbs: CONTOUR, meaning: Same("--simplify") },
    Habit { typed: &["-p"], verbs: CONTOUR, meaning: Same("--bands") },
    Habit { typed: &["-amin", "-amax"], verbs: CONTOUR, meaning: Refused("--bands has the fields ELEV_MIN and ELEV_MAX") },
    Habit { typed: &["-p"], verbs: &["slope"], meaning: Same("--percent") },
    Habit { typed: &["-alg"], verbs: BY_FORMULA, meaning: Same("--formula") },
    Habit { typed: &["-compute_edges"], verbs: RASTERS, meaning: Nothing },
    Habit { typed: &["-s"], verbs: &["slope"], meaning: Refused("--z-factor FACTOR multiplies heights: 1 divided by the scale of gdaldem") },
    Habit { typed: &["-zero_for_flat"], verbs: &["aspect"], meaning: Refused("level cells have nodata, -9999") },
    Habit { typed: &["-trigonometric"], verbs: &["aspect"], meaning: Refused("directions are clockwise from north: 90 - direction is the angle") },
    Habit { typed: &["-p"], verbs: &[], meaning: Refused("switches of Triangle are for `breakline triangulate`") },
    Habit { typed: &["-fl"], verbs: CONTOUR, meaning: List("--levels") },
    Habit { typed: &["-off"], verbs: CONTOUR, meaning: Same("--base") },
    Habit { typed: &["-3d"], verbs: CONTOUR, meaning: Nothing },
    Habit { typed: &["-a"], verbs: CONTOUR, meaning: Refused("the heights are always in the field ELEV") },
    Habit { typed: &["-a"], verbs: &["dem"], meaning: Same("--method") },
    Habit { typed: &["-az"], verbs: SHADE, meaning: Same("--azimuth") },
    Habit { typed: &["-alt"], verbs: SHADE, meaning: Same("--altitude") },
    Habit { typed: &["-combined"], verbs: SHADE, meaning: Words(&["--shading", "combined"]) },
    Habit { typed: &["-multidirectional"], verbs: SHADE, meaning: Words(&["--shading", "multidirectional"]) },
    Habit { typed: &["-igor"], verbs: SHADE, meaning: Words(&["--shading", "igor"]) },
    Habit { typed: &["-alpha"], verbs: COLOR, meaning: Nothing },
    Habit { typed: &["-nearest_color_entry", "--nearest"], verbs: COLOR, meaning: Words(&["--match", "nearest"]) },
    Habit { typed: &["-exact_color_entry", "--exact"], verbs: COLOR, meaning: Words(&["--match", "exact"]) },
    Habit { typed: &["-z"], verbs: SHADE, meaning: Same("--z-factor") },
    Habit { typed: &["-a_nodata", "-dstnodata", "-nodata"], verbs: &[], meaning: Refused("nodata is -9999, but 0 in shades") },
];

/// Programs of others, and the verb that does the same.
const VERBS: &[(&str, &str)] = &[
    ("lasmerge", "points"),
    ("las2las", "points"),
    ("lasground", "ground"),
    ("lasground_new", "ground"),
    ("las2tin", "tin"),
    ("las2dem", "dem"),
    ("blast2dem", "dem"),
    ("las2iso", "contour"),
    ("gdal_contour", "contour"),
    ("lasinfo", "info"),
    ("gdalinfo", "info"),
    ("gdalsrsinfo", "crs"),
    ("TRI", "tri"),
    ("TPI", "tpi"),
    ("ogrinfo", "info"),
];

/// Programs of others that no verb replaces, and what there is instead.
const OF_OTHERS: &[(&str, &str)] = &[
    (
        "lasclip",
        "`breakline points IN --boundary AREA.shp -o OUT.laz` keeps the points in polygons",
    ),
    (
        "lasgrid",
        "`breakline dem IN --return first -o OUT.tif` makes a surface model",
    ),
    (
        "lasheight",
        "`breakline sample GROUND --at IN --add height-above -o OUT.laz` writes heights above a surface",
    ),
    (
        "lasclassify",
        "`breakline ground IN -o OUT.laz` classifies the ground; buildings and plants are not distinguished",
    ),
    (
        "lasthin",
        "`breakline points IN --thin grid:1 --thin-keep lowest -o OUT.laz` keeps one point of each cell",
    ),
    (
        "lastile",
        "`breakline points IN --tile 1km --buffer 20m -o FOLDER` writes points in tiles; verbs work in tiles by themselves \
         where memory is short: `--tiles`",
    ),
];

/// Translates habits to options of this program where the meaning is certain; leaves all other
/// words as they are.
///
/// # Errors
/// If a habit has no equivalent; the hint says what to type instead.
pub(crate) fn understood(args: impl IntoIterator<Item = OsString>) -> Result<Vec<OsString>> {
    let mut args: Vec<OsString> = args.into_iter().map(without_secrets).collect();
    let Some(at) = verb_position(&args) else {
        return Ok(args);
    };
    let rest = args.split_off(at + 1);
    let Some(verb) = verb(&args[at])? else {
        // What it might be is said where the words are parsed.
        args.extend(rest);
        return Ok(args);
    };
    args[at] = verb.clone().into();
    if verb == "triangulate" {
        args.extend(expand_switches(rest)?);
        return Ok(args);
    }
    let (words, formats) = translated(&verb, rest)?;
    let (words, targets) = with_output(&verb, with_ramp(&verb, words))?;
    formats
        .iter()
        .try_for_each(|format| confirm(format, &targets))?;
    args.extend(words);
    Ok(args)
}

/// Returns a word without the passwords in the name of a data set, which may follow an option.
fn without_secrets(word: OsString) -> OsString {
    let Some(text) = word.to_str() else {
        return word;
    };
    let (option, value) = match text.split_once('=') {
        Some((option, value)) if option.starts_with("--") => (&text[..=option.len()], value),
        _ => ("", text),
    };
    match gdal::without_secrets(value) {
        Cow::Owned(hidden) => format!("{option}{hidden}").into(),
        Cow::Borrowed(_) => word,
    }
}

/// Returns the position of the verb, if there is one.
fn verb_position(args: &[OsString]) -> Option<usize> {
    let is_value = |i: usize| i > 0 && args[i - 1] == "--threads";
    let is_verb = |&i: &usize| !is_value(i) && !args[i].to_string_lossy().starts_with('-');
    (1..args.len()).find(is_verb)
}

/// Returns the verb of this program that a word means; `None` if it is not known.
///
/// # Errors
/// If it is known that something else was meant; the hint says what to type.
fn verb(typed: &OsStr) -> Result<Option<String>> {
    let word = typed.to_string_lossy();
    let is_ours = Cli::command().find_subcommand(&*word).is_some() || word == "help";
    if let Some((_, ours)) = VERBS.iter().find(|(theirs, _)| *theirs == word) {
        return Ok(Some((*ours).to_owned()));
    }
    if let Some((_, instead)) = OF_OTHERS.iter().find(|(theirs, _)| *theirs == word) {
        return Err(Error::usage(format!("`{word}` is not a verb")).cure(*instead));
    }
    if !is_ours && (Path::new(typed).extension().is_some() || Path::new(typed).exists()) {
        return Err(
            Error::usage(format!("expected a verb, found `{word}`")).cure(format!(
                "`breakline info {word}` shows what is in it; `breakline --help` lists the verbs"
            )),
        );
    }
    Ok(is_ours.then(|| word.into_owned()))
}

/// Returns the translated words after the verb, and the names of formats among them.
fn translated(verb: &str, words: Vec<OsString>) -> Result<(Vec<OsString>, Vec<String>)> {
    let ours = Vec::with_capacity(words.len());
    let mut translation = Translation {
        verb,
        rest: words.into(),
        ours,
        formats: Vec::new(),
    };
    while let Some(word) = translation.rest.pop_front() {
        if word == "--" {
            translation.ours.push(word);
            break;
        }
        let text = word.to_string_lossy().into_owned();
        let attached = text.split_once('=').filter(|_| text.starts_with("--"));
        let name = attached.map_or(text.as_str(), |(name, _)| name);
        let fits = |habit: &&Habit| {
            habit.typed.contains(&name) && (habit.verbs.is_empty() || habit.verbs.contains(&verb))
        };
        let Some(Habit { meaning, .. }) = HABITS.iter().find(fits) else {
            translation.ours.push(word);
            continue;
        };
        if let Some((_, value)) = attached {
            translation.rest.push_front(value.into());
        }
        translation.add(name, *meaning)?;
    }
    translation.ours.extend(translation.rest);
    Ok((translation.ours, translation.formats))
}

/// Words after a verb, while they are translated.
struct Translation<'a> {
    verb: &'a str,
    /// The words that are not translated yet.
    rest: VecDeque<OsString>,
    /// The translated ones.
    ours: Vec<OsString>,
    /// The names of formats that were typed.
    formats: Vec<String>,
}

impl Translation<'_> {
    /// Translates a word with a meaning, and its values.
    ///
    /// # Errors
    /// If this program has no equivalent, or not for these values.
    fn add(&mut self, name: &str, meaning: Meaning) -> Result<()> {
        match meaning {
            Same(option) => self.ours.push(option.into()),
            Words(words) => self.ours.extend(words.iter().map(OsString::from)),
            Square(option) => self.add_square(name, option)?,
            Corners(option) => {
                self.ours.push(option.into());
                match &self.numbers(4)[..] {
                    corners @ [_, _, _, _] => self.ours.push(corners.join(",").into()),
                    fewer => fewer
                        .iter()
                        .rev()
                        .for_each(|number| self.rest.push_front(number.into())),
                }
            }
            List(option) => {
                self.ours.push(option.into());
                let values = self.numbers(usize::MAX);
                if !values.is_empty() {
                    self.ours.push(values.join(",").into());
                }
            }
            Input(option) => {
                let is_number = |word: &OsString| {
                    word.to_str().is_some_and(|t| finite(t).is_ok()) && !Path::new(word).exists()
                };
                let option = option.filter(|_| self.rest.front().is_some_and(is_number));
                self.ours.extend(option.map(OsString::from));
            }
            Format => {
                let value = self.value();
                self.formats.push(value);
            }
            Creation => {
                let value = self.value();
                let is_overviews = value.eq_ignore_ascii_case("OVERVIEWS=NONE");
                match is_overviews && RASTERS.contains(&self.verb) {
                    // Colors never have overviews.
                    true if self.verb == "color-relief" => {}
                    true => self
                        .ours
                        .extend(["--overviews", "none"].map(OsString::from)),
                    false => self.ours.extend(["--co".into(), value.into()]),
                }
            }
            Condition => {
                let condition = self.value();
                condition::add(name, &condition, self.verb, &mut self.ours)?;
            }
            Nothing => {}
            Refused(cure) => {
                let verb = self.verb;
                return Err(
                    Error::usage(format!("{name} is not an option of `breakline {verb}`"))
                        .cure(cure),
                );
            }
        }
        Ok(())
    }

    /// Adds the size of a cell, which may have been typed once for each axis.
    fn add_square(&mut self, name: &str, option: &str) -> Result<()> {
        match &self.numbers(2)[..] {
            // GDAL writes the height of a cell with a minus where rows go down.
            [x, y] if finite(x).map(f64::abs) != finite(y).map(f64::abs) => {
                return Err(Error::usage(format!("{name} {x} {y}: cells are square"))
                    .cure(format!("{option} {x}, or {option} {y}")));
            }
            [x, ..] => self.ours.extend([option.into(), x.into()]),
            [] => self.ours.push(option.into()),
        }
        Ok(())
    }

    /// Removes and returns the next word, empty if there is none.
    fn value(&mut self) -> String {
        self.rest
            .pop_front()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    }

    /// Removes and returns the numbers at the front, at most `most`.
    fn numbers(&mut self, most: usize) -> Vec<String> {
        let is_number = |word: &&OsString| word.to_str().is_some_and(|text| finite(text).is_ok());
        let count = self.rest.iter().take(most).take_while(is_number).count();
        self.rest
            .drain(..count)
            .map(|word| word.to_string_lossy().into_owned())
            .collect()
    }
}

/// Returns the words with `--ramp` before a text file that follows a raster: `gdaldem color-relief`
/// has its ramp there, and a raster is the only input.
fn with_ramp(verb: &str, mut words: Vec<OsString>) -> Vec<OsString> {
    let content = |word: &OsString| formats::of_name(Path::new(word)).map(|format| format.content);
    if COLOR.contains(&verb) && !words.iter().any(|word| word == "--ramp") {
        let is_ramp = |pair: &[OsString]| {
            content(&pair[0]) == Some(formats::Content::Raster)
                && Path::new(&pair[1]).extension().is_some_and(|e| e == "txt")
        };
        if let Some(at) = words.windows(2).position(is_ramp) {
            words.insert(at + 1, "--ramp".into());
        }
    }
    words
}

/// Returns the words, and the outputs among them. If none is named, the last file is the output if
/// it does not exist and has the extension of a format that the verb writes, as in
/// `gdal_contour IN OUT`.
fn with_output(verb: &str, mut words: Vec<OsString>) -> Result<(Vec<OsString>, Vec<PathBuf>)> {
    let command = Cli::command();
    let options: Vec<&clap::Arg> = command
        .find_subcommand(verb)
        .into_iter()
        .flat_map(clap::Command::get_arguments)
        .chain(command.get_arguments())
        .collect();
    let takes_value = |is_it: &dyn Fn(&clap::Arg) -> bool| {
        options
            .iter()
            .any(|option| is_it(option) && option.get_action().takes_values())
    };
    let (mut files, mut targets) = (Vec::new(), Vec::new());
    let mut i = 0;
    while i < words.len() && words[i] != "--" {
        let text = words[i].to_string_lossy();
        let is_short = text.len() > 1
            && text.starts_with('-')
            && !text.starts_with("--")
            && finite(&text).is_err();
        // The letter of an option with a value, and the part of the word that is the value.
        let mut of_value = None;
        if is_short {
            let letters = text.char_indices().skip(1).collect::<Vec<_>>();
            for &(at, letter) in &letters {
                if takes_value(&|option| option.get_short() == Some(letter)) {
                    of_value = Some((letter, &text[at + letter.len_utf8()..]));
                    break;
                }
                let is_known = options
                    .iter()
                    .any(|option| option.get_short() == Some(letter));
                if letters.len() > 1 && !is_known {
                    return Err(Error::usage(format!(
                        "{text} is not an option of `breakline {verb}`"
                    ))
                    .cure(format!(
                        "long options begin with two dashes: `breakline {verb} --help` lists them"
                    )));
                }
            }
        }
        let is_output = text == "--output" || of_value == Some(('o', ""));
        if is_output {
            targets.extend(words.get(i + 1).map(PathBuf::from));
        } else if let Some(('o', target)) = of_value {
            targets.push(target.into());
        } else if let Some(target) = text.strip_prefix("--output=") {
            targets.push(target.into());
        }
        let is_followed = match text.strip_prefix("--") {
            Some(long) => {
                let next = words.get(i + 1).map(|word| word.to_string_lossy());
                let is_option =
                    next.is_none_or(|next| next.starts_with('-') && finite(&next).is_err());
                let may_lack_value = |option: &clap::Arg| {
                    let values = option.get_num_args();
                    values.is_some_and(|values| values.min_values() == 0)
                };
                takes_value(&|option| {
                    option.get_long() == Some(long) && !(is_option && may_lack_value(option))
                })
            }
            None => of_value.is_some_and(|(_, value)| value.is_empty()),
        };
        if !text.starts_with('-') || text == "-" {
            files.push(i);
        }
        i += if is_followed { 2 } else { 1 };
    }
    if let (true, [_, .., last]) = (targets.is_empty(), &files[..]) {
        let path = PathBuf::from(&words[*last]);
        let extension = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase();
        // A driver writes any name.
        let is_driven =
            DRIVEN.contains(&verb) && words.iter().any(|word| word == "--of") && !path.exists();
        if is_driven || written(verb).contains(&extension.as_str()) {
            if path.exists() && !words.iter().any(|word| word == "--overwrite") {
                let name = path.display();
                return Err(Error::usage("no output is named").cure(format!(
                    "to replace {name}, which exists: -o {name} --overwrite"
                )));
            }
            words.insert(*last, "-o".into());
            targets.push(path);
        }
    }
    Ok((words, targets))
}

/// Returns the extensions of the formats that a verb writes.
fn written(verb: &str) -> Vec<&'static str> {
    match verb {
        "points" => formats::extensions(Product::Points),
        "ground" => vec!["las", "laz"],
        "tin" | "simplify" => formats::extensions(Product::Surface),
        "dem" | "slope" | "aspect" | "curvature" | "roughness" | "tri" | "tpi" => {
            formats::extensions(Product::Heights)
        }
        "contour" => formats::extensions(Product::Contours),
        "profile" => profiles::EXTENSIONS.to_vec(),
        "drape" => formats::extensions(Product::Lines),
        "hillshade" => formats::extensions(Product::Shades),
        "color-relief" => formats::extensions(Product::Colors),
        _ => Vec::new(),
    }
}

/// Returns an error unless there are outputs and all have the extension of this format.
fn confirm(format: &str, targets: &[PathBuf]) -> Result<()> {
    let is_named = |known: &&formats::Format| {
        known
            .gdal_names
            .iter()
            .any(|name| name.eq_ignore_ascii_case(format))
    };
    let extensions = formats::FORMATS
        .iter()
        .find(is_named)
        .map_or(&[][..], |known| known.extensions);
    let is_of = |target: &PathBuf| {
        extensions.iter().any(|known| {
            target
                .extension()
                .is_some_and(|extension| extension.eq_ignore_ascii_case(known))
        })
    };
    if !targets.is_empty() && targets.iter().all(is_of) {
        return Ok(());
    }
    Err(Error::usage(format!(
        "-of {format}: the extension of the output selects the format"
    ))
    .cure("leave -of out, and give the output the extension, as in -o dem.tif"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Result<String> {
        let words = understood(line.split(' ').map(OsString::from))?;
        Ok(words
            .iter()
            .map(|word| word.to_string_lossy())
            .collect::<Vec<_>>()
            .join(" "))
    }

    #[test]
    fn what_is_certain_is_done() {
        for (typed, expected) in [
            (
                "b dem --te -10 -2.5 1e3 4 a.laz -o b.tif",
                "b dem --te -10,-2.5,1e3,4 a.laz -o b.tif",
            ),
            (
                "b dem a.laz --bounds 1 2 3 4 -te 5 6 7 8",
                "b dem a.laz --bounds 1,2,3,4 --te 5,6,7,8",
            ),
            ("b dem --te 1,2,3,4 5 6 7 8", "b dem --te 1,2,3,4 5 6 7 8"),
            ("b dem --te 1 2 3 a.laz", "b dem --te 1 2 3 a.laz"),
            (
                "b dem --te=1,2,3,4 --class 1 2 3 4",
                "b dem --te 1,2,3,4 --class 1 2 3 4",
            ),
            ("b dem -- --te 1 2 3 4", "b dem -- --te 1 2 3 4"),
            (
                "b dem -tr 0.5 0.50 a.laz -o b.tif",
                "b dem --resolution 0.5 a.laz -o b.tif",
            ),
            (
                "b dem --tr=2 --resolution 0.5 0.5 a.laz",
                "b dem --resolution 2 --resolution 0.5 a.laz",
            ),
            (
                "b --threads 2 las2dem -i a.laz -step 2 -keep_class 2 8 -o b.tif",
                "b --threads 2 dem a.laz --resolution 2 --class 2,8 -o b.tif",
            ),
            (
                "b dem -of gtiff -co TILED=YES -a_srs EPSG:25832 -overwrite a.laz -o b.TIF",
                "b dem --of gtiff --co TILED=YES --a-srs EPSG:25832 --overwrite a.laz -o b.TIF",
            ),
            (
                "b contour -f KML -lco A=B -co OVERVIEWS=NONE a.tif b.kml",
                "b contour --of KML --lco A=B --co OVERVIEWS=NONE a.tif -o b.kml",
            ),
            (
                "b hillshade -co OVERVIEWS=NONE a.tif -o b.tif",
                "b hillshade --overviews none a.tif -o b.tif",
            ),
            (
                "b dem a.laz --s-srs EPSG:1 b.tif",
                "b dem a.laz --a-srs EPSG:1 -o b.tif",
            ),
            ("b dem a.laz -qo b.tif", "b dem a.laz -qo b.tif"),
            (
                "b las2dem -i a.laz -first_only -lakes w.shp -creeks c.shp:Z -keep_xy 1 2 3 4 -o b.tif",
                "b dem a.laz --return first --flat w.shp --breaklines c.shp:Z --bounds 1,2,3,4 -o b.tif",
            ),
            (
                "b las2iso -i a.laz -iso_every 10 -keep_return 1 2 -o b.shp",
                "b contour a.laz --interval 10 --return 1,2 -o b.shp",
            ),
            // A word that is not a verb is left to the parser.
            ("b foo -tr 1 2 -lakes", "b foo -tr 1 2 -lakes"),
            (
                "b dem a.laz b.tif -tr 1 -1",
                "b dem a.laz -o b.tif --resolution 1",
            ),
            (
                "b dem a.laz --class 2 b.tif -q",
                "b dem a.laz --class 2 -o b.tif -q",
            ),
            (
                "b gdal_contour -i 10 -off 5 -3d nowhere.tif out.shp",
                "b contour --interval 10 --base 5 nowhere.tif -o out.shp",
            ),
            (
                "b contour -fl 10 -2 -i in.tif -o c.shp",
                "b contour --levels 10,-2 in.tif -o c.shp",
            ),
            (
                "b hillshade -az 300 -alt 30 -z 2 a.tif s.png",
                "b hillshade --azimuth 300 --altitude 30 --z-factor 2 a.tif -o s.png",
            ),
            (
                "b color-relief -alpha a.tif ramp.txt -nearest_color_entry c.tif",
                "b color-relief a.tif --ramp ramp.txt --match nearest -o c.tif",
            ),
            ("b color-relief a.txt b.txt", "b color-relief a.txt b.txt"),
            (
                "b hillshade -multidirectional a.tif s.png",
                "b hillshade --shading multidirectional a.tif -o s.png",
            ),
            // Outputs of another verb, outputs with an option, inputs alone.
            ("b tin a.xyz b.tif", "b tin a.xyz b.tif"),
            ("b tin a.xyz b.ply -oc.ply", "b tin a.xyz b.ply -oc.ply"),
            ("b contour a.shp", "b contour a.shp"),
            ("b info a.laz b.tif", "b info a.laz b.tif"),
            (
                "b triangulate -a1e-7 x.poly",
                "b triangulate --max-area=1e-7 x.poly",
            ),
            ("b tim", "b tim"),
            ("b", "b"),
        ] {
            assert_eq!(words(typed).unwrap(), expected, "{typed}");
        }
    }

    #[test]
    fn what_is_not_certain_is_answered_with_our_words() {
        for (typed, message, cure) in [
            (
                "b dem -tr 1 2 a.laz -o b.tif",
                "-tr 1 2: cells are square",
                "--resolution 1, or --resolution 2",
            ),
            (
                "b tin -te 1 2 3 4 a.laz",
                "-te is not an option of `breakline tin`",
                "--bounds",
            ),
            (
                "b points -of LAZ a.laz -o b.las",
                "-of LAZ: the extension",
                "-o dem.tif",
            ),
            (
                "b tin -co COMPRESS=LZW a.laz -o b.ply",
                "-co is not an option of `breakline tin`",
                "rasters and for layers",
            ),
            (
                "b a.laz -o b.tif",
                "expected a verb, found `a.laz`",
                "breakline info a.laz",
            ),
            (
                "b dem -drop_class 7 a.laz",
                "-drop_class is not an option",
                "--class N",
            ),
            ("b dem -odir out a.laz", "-odir is not an option", "-o FILE"),
            (
                "b dem a.laz -o b.tif -hillshade",
                "-hillshade is not an option",
                "two dashes",
            ),
            (
                "b dem a.laz --crs EPSG:1 -o b.tif",
                "--crs is not an option",
                "--a-srs",
            ),
            (
                "b triangulate -tr 1 1 x.poly",
                "`-tr`: of Triangle's switches",
                "two dashes",
            ),
        ] {
            let error = words(typed).unwrap_err();
            assert!(error.to_string().starts_with(message), "{error}");
            assert!(
                error.cure_text().unwrap().plain().contains(cure),
                "{error:?}"
            );
        }
    }
}
