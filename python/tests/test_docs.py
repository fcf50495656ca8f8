"""Every example in the documentation runs, and everything public has documentation."""

import doctest
import inspect
import re
from pathlib import Path

import pytest

import taut
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


@pytest.mark.parametrize("public", [taut.Ellipsoid, taut.Solution, taut.SphereSearch, taut.Tiles], ids=lambda c: c.__name__)
def test_examples_of_methods_run(public):
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    # Without a module: classes say that they are of `taut`, their methods are of the file they are in.
    for test in doctest.DocTestFinder().find(public, module=False, globs={}):
        runner.run(test)
    assert runner.summarize().failed == 0
    assert runner.tries > 0


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
