"""Examples in docstrings: each public function and method has one, and all of them are true."""

import doctest
import importlib
import inspect
import pkgutil
import shutil

import breakline
import pytest
from conftest import FIXTURES, judge

MODULES = ["breakline", "breakline.spatial", "breakline.triangle"]
SQUARE = "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"


def public(module):
    """Yield the names and values of functions, classes and methods that users call."""
    for name in module.__all__:
        value = getattr(module, name)
        if inspect.isfunction(value):
            yield name, value
        elif inspect.isclass(value) and value.__module__.startswith("breakline") and not issubclass(value, Exception):
            for method, function in inspect.getmembers(value):
                function = getattr(function, "__func__", function)
                if not method.startswith("_") and inspect.isfunction(function):
                    yield f"{name}.{method}", function


@pytest.mark.parametrize("module", MODULES)
def test_each_public_function_and_method_has_an_example(module):
    functions = dict(public(importlib.import_module(module)))
    assert len(functions) > 2
    assert [name for name, function in functions.items() if ">>>" not in (function.__doc__ or "")] == []


@pytest.mark.filterwarnings("ignore::breakline.BreaklineWarning")
def test_examples_are_true(tmp_path, monkeypatch):
    for package in ("geopandas", "matplotlib", "pyarrow", "xarray"):
        judge(package)
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    shutil.copy(FIXTURES / "valley.laz", tmp_path)
    (tmp_path / "square.poly").write_text(SQUARE)
    found = pkgutil.walk_packages(breakline.__path__, "breakline.")
    modules = [module.name for module in found if module.name not in ("breakline.__main__", "breakline._breakline")]
    tried = 0
    for name in ["breakline", *modules]:
        failed, of = doctest.testmod(importlib.import_module(name))
        assert failed == 0, f"{name}: {failed} of {of} examples, printed above"
        tried += of
    assert tried > 80
