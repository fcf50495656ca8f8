"""Every example in the documentation runs, and everything public has documentation."""

import doctest
import inspect

import pytest

import taut
from taut import _ball, _generate, _verify


@pytest.mark.parametrize("module", [taut, _ball, _generate, _verify], ids=lambda m: m.__name__)
def test_examples_run(module):
    flags = doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL
    # The classes of the compiled part are found as members of `taut`, which they say they are.
    failed, attempted = doctest.testmod(module, optionflags=flags)
    assert failed == 0
    assert attempted > 0


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
