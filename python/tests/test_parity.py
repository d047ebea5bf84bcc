"""Every verb of the program is a function, and every option a parameter.

The program describes itself (`breakline describe --json`), so that nothing new is forgotten.
"""

import inspect
import typing

import breakline
import pytest
from breakline._breakline import settings
from breakline._names import Shading
from breakline._surface import DEFAULTS, FOR_ANY, Building
from breakline._written import HOW, Writing

PROGRAM = breakline.describe()
VERBS = {verb["name"].replace("-", "_"): verb for verb in PROGRAM["verbs"]}

#: Options of the program whose parameters here have other names.
RENAMED = {"a-srs": "crs", "t-srs": "to_crs", "te": "extent", "class": "classes", "return": "returns", "3d": "in_space", "2d": "in_plane"}

#: Verbs that are no functions, and why.
NO_FUNCTIONS = {
    "completions": "of the shell",
    "man": "pages for the shell",
    "demo": "writes files to look at and prints commands to type",
    "job": "breakline.Job does the tasks of batch queues; breakline.dask does those of a cluster",
}

#: Options that are no parameters of any function, and what there is instead.
ELSEWHERE = {
    "quiet": "messages are warnings and Tin.notices",
    "verbose": "messages are warnings and Tin.notices",
    "json": "functions return dictionaries",
    "parse": "the letters of LAStools; columns=(1, 2, 3) says the same",
    "crossing-report": "Tin.report['crossing_heights']",
    "dry-run": "breakline.Job.plan(...).tasks()",
    # The wheel has no GDAL. Run files (`breakline.run`) have the words of the program.
    **dict.fromkeys(("of", "driver", "co", "creation-options", "lco", "layer-options"), "breakline.run({'dem': {'of': ...}})"),
}

#: Verbs that return what has a method `write`, which takes `output` and `overwrite`.
RASTERS = ("dem", "hillshade", "slope", "aspect", "curvature", "roughness", "tri", "tpi")
WRITTEN = {
    **dict.fromkeys(("tin", "simplify"), breakline.Tin),
    "contour": breakline.Contours,
    "color_relief": breakline.Relief,
    **dict.fromkeys(RASTERS, breakline.Raster),
}

#: Options that a verb does not need because of what it returns.
OF_RESULTS = {
    "check": {"overwrite"},
    "volume": {"output", "overwrite"},
    "compare": {"output", "overwrite", "overviews", "classes"},
    "sample": {"output", "overwrite"},
    "accuracy": {"output", "overwrite", "histogram"},
    # `breakline.simplify` takes what `tin` takes, and returns a Tin.
    "tin": {"max-error", "target", "line-tolerance"},
}

#: Names of positional arguments.
POSITIONAL = {"inputs": {"points", "inputs", "a", "surfaces"}, "input": {"path"}, "files": {"path"}, "from": {"from_crs"}, "to": {"to_crs"}}


def parameters(function):
    """Return the parameters of a function, with those of `tin` where they are passed on."""
    own = inspect.signature(function).parameters
    passes = any(parameter.kind is parameter.VAR_KEYWORD for parameter in own.values())
    passed = inspect.signature(breakline.tin).parameters if passes else {}
    passed = {name: value for name, value in passed.items() if name not in HOW}
    return {**passed, **{name: value for name, value in own.items() if value.kind is not value.VAR_KEYWORD}}


def parameter_name(verb, option):
    """Return the name of the parameter for an option of a verb."""
    return RENAMED.get(option, option.replace("-", "_"))


def test_every_setting_is_a_parameter_or_is_elsewhere():
    functions = [getattr(breakline, verb) for verb in sorted(set(VERBS) - set(NO_FUNCTIONS))]
    methods = [breakline.Tin.dem, breakline.Tin.hillshade, breakline.Tin.contours, *(of.write for of in WRITTEN.values())]
    known = {name for function in functions + methods for name in inspect.signature(function).parameters}
    named = dict(settings())
    assert named["wall-bottom"] == "wall_bottom" and named["target-crs"] == "to_crs"
    assert {parameter for parameter in named.values() if parameter} <= known
    assert {setting for setting, parameter in named.items() if parameter is None} <= set(ELSEWHERE)


@pytest.mark.parametrize("verb", sorted(VERBS))
def test_a_verb_is_a_function_and_its_options_are_parameters(verb):
    if verb in NO_FUNCTIONS:
        assert not hasattr(breakline, verb)
        return
    found = parameters(getattr(breakline, verb))
    for option in [*VERBS[verb]["options"], *PROGRAM["options"]]:
        name = option["name"]
        if name in ELSEWHERE or name in OF_RESULTS.get(verb, ()) or verb == "describe":
            continue
        if option["positional"]:
            assert POSITIONAL[name] & set(found), name
        elif name in ("output", "overwrite", "plain") and verb in WRITTEN:
            write = inspect.signature(WRITTEN[verb].write).parameters
            assert {"path", "overwrite", "plain"} & {"path", "overwrite", name} <= set(write)
        else:
            assert parameter_name(verb, name) in found, f"{verb} --{name}"


@pytest.mark.parametrize("verb", sorted(set(VERBS) - set(NO_FUNCTIONS) - {"describe"}))
def test_parameters_are_options(verb):
    known = {parameter_name(verb, option["name"]) for option in [*VERBS[verb]["options"], *PROGRAM["options"]]}
    known |= {"points", "inputs", "path", "progress"}
    if verb in WRITTEN or verb in ("check", "volume", "compare", "drape", "profile", "sample", "accuracy", "terrain_tiles"):
        known |= {"bounds"}
    if verb in ("volume", "compare"):
        known |= {"a", "b"}
    if verb == "profile":
        known |= {"surfaces"}
    if verb == "crs":
        known |= {"from_crs", "to_crs"}
    assert set(parameters(getattr(breakline, verb))) <= known


@pytest.mark.parametrize("verb", sorted(set(VERBS) - set(NO_FUNCTIONS)))
def test_defaults_and_values_are_those_of_the_program(verb):
    if verb == "describe":
        return
    found = parameters(getattr(breakline, verb))
    for option in VERBS[verb]["options"]:
        parameter = found.get(parameter_name(verb, option["name"]))
        if parameter is None or option["positional"] or not option["takes_value"]:
            continue
        default = option.get("default", [None])[0]
        if isinstance(parameter.default, float):
            assert parameter.default == float(default)
        elif isinstance(parameter.default, str):
            assert parameter.default == default


def test_defaults_are_those_of_the_signature():
    parameters = inspect.signature(breakline.tin).parameters
    assert {name: value.default for name, value in parameters.items() if name not in FOR_ANY} == {**DEFAULTS, **HOW}


def test_type_checkers_know_all_parameters_and_what_is_returned():
    assert set(Building.__annotations__) == {*DEFAULTS, *FOR_ANY} - {"points", "threads", "progress"}
    assert set(Writing.__annotations__) == {*Building.__annotations__, *HOW, "threads", "progress"} - {"output"}
    if not hasattr(typing, "get_overloads"):
        pytest.skip("overloads are not kept before Python 3.11")
    for verb, made in [("tin", "Tin"), ("dem", "Raster"), ("hillshade", "Raster"), ("contour", "Contours")]:
        function = getattr(breakline, verb)
        overloads = typing.get_overloads(function)
        assert [one.__annotations__["return"] for one in overloads] == [made, "Written"]
        named = {name for one in overloads for name in inspect.signature(one).parameters}
        own = set(inspect.signature(function).parameters)
        assert own - named <= set(Writing.__annotations__) | {"surface"} and named - own <= {"surface", "writing"}


SQUARE = [[0, 0, 1], [10, 0, 1], [10, 10, 3], [0, 10, 3], [4, 5, 2]]


@pytest.mark.parametrize("option", ["duplicates", "on-crossing", "crossing-z", "wall-high"])
def test_every_value_of_an_option_is_understood(option):
    (found,) = (one for one in VERBS["tin"]["options"] if one["name"] == option)
    for value in found["values"]:
        breakline.tin(SQUARE, **{option.replace("-", "_"): value["value"]})


def test_every_method_is_understood():
    (found,) = (option for option in VERBS["dem"]["options"] if option["name"] == "method")
    tin = breakline.tin(SQUARE)
    for value in found["values"]:
        assert tin.dem(2, method=value["value"]).shape == (5, 5)


def test_every_shading_is_understood():
    (found,) = (option for option in VERBS["hillshade"]["options"] if option["name"] == "shading")
    tin = breakline.tin(SQUARE)
    named = [value["value"] for value in found["values"]]
    assert named == list(typing.get_args(Shading))
    shades = [tin.hillshade(2, shading=name).array for name in named]
    assert all((a != b).any() for a, b in zip(shades, shades[1:]))
    with pytest.raises(breakline.UsageError, match="azimuth.*four lights"):
        tin.hillshade(2, shading="multidirectional", azimuth=10.0)
    with pytest.raises(breakline.UsageError, match="shading"):
        tin.hillshade(2, shading="moon")


def test_functions_and_classes_are_documented():
    for name in breakline.__all__:
        thing = getattr(breakline, name)
        if callable(thing):
            assert (thing.__doc__ or "").strip(), name
