"""Every example in the documentation runs, and everything public has documentation."""

import doctest
import importlib
import inspect
import re
from importlib.util import find_spec
from pathlib import Path

import pytest

import taut
import taut.spatial
from taut import _ball, _centers, _classify, _curve, _delaunay, _ellipsoid, _generate, _memory, _robust, _terrain, _tiles, _verify
from taut import inscribe


FLAGS = doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL


MODULES = [
    *[taut, _ball, _centers, _classify, _curve, _delaunay, _ellipsoid, _generate, _memory, _robust, _terrain, _tiles],
    *[_verify, inscribe],
]


@pytest.mark.parametrize("module", MODULES, ids=lambda m: m.__name__)
def test_examples_run(module):
    failed, attempted = doctest.testmod(module, optionflags=FLAGS)
    assert failed == 0
    assert attempted > 0


# Of these with methods that have examples.
CLASSES = [
    *[taut.Ball, taut.Centers, taut.Ellipsoid, taut.RobustEllipsoid, taut.Solution, taut.SphereSearch, taut.Tiles],
    taut.spatial.Triangulation,
]

# What these need beside NumPy.
OPTIONAL = {
    "taut.spatial": "scipy",
    "taut.spatial._drop_ins": "scipy",
    "taut.spatial._hull": "numpy",
    "taut.sklearn": "sklearn",
    "taut.sklearn._classifier": "sklearn",
    "taut.sklearn._cluster": "sklearn",
    "taut.sklearn._covariance": "sklearn",
    "taut.sklearn._enclosing": "sklearn",
}


@pytest.mark.parametrize("name", OPTIONAL)
def test_examples_of_submodules_run(name):
    if find_spec(OPTIONAL[name]) is None:
        pytest.skip(f"{OPTIONAL[name]} is not installed")
    failed, attempted = doctest.testmod(importlib.import_module(name), optionflags=FLAGS)
    assert failed == 0
    assert attempted > 0


@pytest.mark.parametrize("name, needed", [("taut.spatial", "scipy"), ("taut.sklearn", "sklearn")])
def test_everything_in_submodules_is_documented(name, needed):
    if find_spec(needed) is None:
        pytest.skip(f"{needed} is not installed")
    module = importlib.import_module(name)
    for public in (getattr(module, public) for public in module.__all__):
        assert inspect.getdoc(public)
        for attribute, member in vars(public).items() if inspect.isclass(public) else ():
            if callable(member) and not attribute.startswith("_"):
                assert inspect.getdoc(member), attribute


@pytest.mark.parametrize("public", CLASSES, ids=lambda c: c.__name__)
def test_examples_of_methods_run(public):
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    # Without a module: classes say that they are of `taut`, their methods are of the file they are in.
    for test in doctest.DocTestFinder().find(public, module=False, globs={}):
        runner.run(test)
    assert runner.summarize().failed == 0
    assert runner.tries > 0


FUNCTIONS = [function for function in map(taut.__dict__.get, taut.__all__) if inspect.isfunction(function)]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
def test_every_function_has_an_example_that_runs(function):
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    for test in doctest.DocTestFinder(recurse=False).find(function, globs={}):
        runner.run(test)
    assert runner.tries > 0
    assert runner.summarize().failed == 0


@pytest.mark.parametrize("name", taut.__all__)
def test_everything_public_is_documented(name):
    public = getattr(taut, name)
    if name == "__version__":
        return
    assert inspect.getdoc(public)
    if inspect.isclass(public):
        for attribute, member in vars(public).items():
            if callable(member) and not attribute.startswith("_"):
                assert inspect.getdoc(member), attribute


def test_short_names_are_those_of_all_inscribed_shapes():
    long_names = {name.removeprefix("inscribed_") for name in taut.__all__ if name.startswith("inscribed_")}
    assert {*long_names, "triangle_rows"} == set(inscribe.__all__)
    for name in long_names:
        assert getattr(inscribe, name) is getattr(taut, f"inscribed_{name}")


ROOT = Path(__file__).parents[2]
PAGES = sorted(str(page.relative_to(ROOT)) for page in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")] if "```pycon" in page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES)
def test_examples_of_the_pages_run(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"```pycon\n(.*?)```", text, re.DOTALL)
    assert blocks
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    for block in blocks:
        runner.run(doctest.DocTestParser().get_doctest(block, {}, page, page, 0))
    assert runner.summarize().failed == 0


def test_examples_are_in_blocks_that_run():
    assert len(PAGES) > 20
    for page in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")]:
        assert "```python\n>>>" not in page.read_text(encoding="utf-8"), page


def test_the_comparison_names_what_there_is():
    rows = [line for line in (ROOT / "docs/compare.md").read_text(encoding="utf-8").splitlines() if line.startswith("|")]
    names = {name for row in rows for name in re.findall(r"`taut\.([\w.]+)`", row.split("|")[2])}
    assert len(names) > 25
    for name in names:
        assert name in taut.__all__, name
