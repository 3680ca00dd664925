"""Tests on real files say which one they miss where the files are not at hand; files of tests are shared out whole.

What a module of tests has planned once for all of them is then planned in one process only. The longest files begin and the
shortest end, so that no process is left alone with one of them at the end; what needs kernels that no one has compiled yet begins
beside what needs none.
What has been imported stays to the end: the collector of garbage passes over it.
"""

import gc
import os
import signal
import sys
from pathlib import Path

import pytest
from hypothesis import settings

from tests.support import kept, record, seconds, slow
from tests.support.skips import strict

# A machine that is busy with something else is no fault; what else holds here, as in CI, stays.
settings.register_profile("suite", settings(), deadline=None)
settings.load_profile("suite")

# No test finds what another one left, and what a test puts in place of a stage is called.
os.environ["PLAN_CUTTERS_CACHE"] = ""

# Byte code is made once, for this process and for all that tests start.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

#: What begins: a file of tests that has all kernels compiled, and beside it folders that need none. Then the longest files.
COMPILING, BESIDE = "ahead", ("library", "machines", "plan_file", "house")
FIRST = ("cli", "feel", "files", "lifetime", "setup_ranking", "batch_command")
#: Folders of short files, with which all processes end together.
LAST = ("document", "files")


def _rank(path):
    """The place of a file of tests in the order in which they begin; of equals the one whose name comes first."""
    stem, folder = path.stem.removeprefix("test_"), path.parent.name
    order = [stem == COMPILING, *(folder == each for each in BESIDE), *(stem == each for each in FIRST), folder not in LAST, True]
    return order.index(True)


def pytest_addoption(parser):
    parser.addoption("--slow", default="none", help="which slow tests take part: none, all, commit, or a part such as 3/11")
    parser.addoption("--keep", action="store_true", help="write anew what is kept of the program's answers (tests/*/kept)")
    parser.addoption("--record", action="store_true", help="write what a whole run found into docs/nightly.md")


def pytest_configure(config):
    config.slow_parts = slow.chosen(config.getoption("slow"))
    seconds.register(config)
    if config.getoption("record") and not hasattr(config, "workerinput"):
        if config.getoption("slow") != "all" or config.option.keyword or config.option.markexpr or config.args != ["tests"]:
            raise pytest.UsageError("--record: it is for a whole run, with --slow all and no selection")
        config.pluginmanager.register(record.Record(), "record of the run")


def pytest_report_header(config):
    return f"slow tests: {config.getoption('slow')}"


def pytest_terminal_summary(terminalreporter, config):
    if told := slow.summary(terminalreporter.stats, config.slow_parts):
        terminalreporter.line(told)


def pytest_sessionstart():
    gc.disable()


@pytest.fixture(autouse=True)
def _signals():
    """A command that runs in this process ignores signals at its end; children of later tests would, too."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.getsignal(number) for number in numbers}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport():
    return strict((yield))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report():
    return strict((yield))


def pytest_collection_finish():
    """Keep what was imported and collected out of every later search for garbage, and whole in copies of this process."""
    gc.freeze()
    gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    whole = not any("::" in each for each in config.args)
    items[:], left = slow.select(items, config.slow_parts, whole)
    config.hook.pytest_deselected(items=left)
    for item in items:
        for value in item.callspec.params.values() if hasattr(item, "callspec") else ():
            if isinstance(value, Path) and not value.exists():
                item.add_marker(pytest.mark.skip(reason=f"the real file {value.name} is not at hand (shared/data/cad)"))
    items.sort(key=lambda item: _rank(item.path))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    if config.option.dist != "load":  # asked for in person
        return None
    from xdist.scheduler import LoadFileScheduling

    config.option.loadscopereorder = False
    return LoadFileScheduling(config, log)


@pytest.fixture
def keeps(request):
    """`keeps(name, found)`: what is found agrees with what is kept of it in the folder `kept` beside the file of tests."""
    return lambda name, found: kept.compare(request.config, request.path.parent / "kept" / f"{name}.json", found)


@pytest.fixture(scope="module")
def playwright():
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")
    with sync_api.sync_playwright() as playwright:
        yield playwright


@pytest.fixture(scope="module")
def browser(playwright):
    """A browser without a screen, for the module."""
    from tests.support.browser import launch

    browser = launch(playwright)
    yield browser
    browser.close()
