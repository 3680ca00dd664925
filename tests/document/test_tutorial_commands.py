"""The commands of the README and of the tutorial do what their text says: run in their order, as they stand there."""

import json
import re
import shlex
import shutil
import tomllib
from typing import NamedTuple

import pytest

from docs import gallery
from tests.support.forked import run
from tests.support.places import ROOT

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
#: A word of a sentence that names a file or a folder.
_FILE = re.compile(r"`([\w./-]+(?:\.(?:step|glb|json|html|npz|toml|png)|/))`")
#: What a text promises of the command that stands before it; nothing promised is 0.
_CODE = re.compile(r"exit code (\d+)")
#: Words that make ready what the commands run in, and what shows that they do: no test installs anything.
_READY = {
    "sh setup.sh": lambda: _setup_takes(""),
    "sh setup.sh dev": lambda: _setup_takes("dev"),
    ". .venv/bin/activate": lambda: _in_file("setup.sh", r"-m venv \.venv$"),
    ".venv/bin/python -m pytest -n auto": lambda: _in_file("pyproject.toml", '"pytest-xdist'),
}


class Block(NamedTuple):
    """A code fence: its kind, its text, and the prose from there to the next one."""

    kind: str
    text: str
    after: str


def blocks(page):
    """Name all code fences of a page, in their order."""
    prose = re.split(_FENCE, page)
    return [Block(kind, text, after) for kind, text, after in zip(prose[1::3], prose[2::3], prose[3::3], strict=True)]


def commands(block):
    """Split a shell fence into its commands: lines, and what `&&` joins."""
    lines = block.text.replace("\\\n", " ").splitlines()
    return [part.strip() for line in lines for part in line.split(" && ") if part.strip()]


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def _in_file(name, pattern):
    assert re.search(pattern, read(name), re.MULTILINE), f"{name} has no {pattern}"


def _setup_takes(word):
    # The case of no word is that of the empty one.
    _in_file("setup.sh", rf"""^    {word or '""'}\) extra=""")


def follow(page, folder):
    """Follow a page: run its commands and its Python in a folder, and look for the files that it names.

    Returns
    -------
    dict
        What each program printed, by its command.
    """
    printed = {}
    for block in blocks(page):
        if block.kind == "python":
            exec(compile(block.text, "the page", "exec"), {})
        for command in commands(block) if block.kind == "sh" else ():
            if command in _READY:
                _READY[command]()
                continue
            program, *words = shlex.split(command)
            assert program in ("plan-cutters", ".venv/bin/plan-cutters"), f"neither run nor known: {command}"
            done = run(*words, cwd=folder)
            expected = int((_CODE.search(block.after) or [0, 0])[1])
            assert done.returncode == expected, f"{command}: exit code {done.returncode}\n{done.stderr}"
            printed[command] = done.stdout
        if block.kind == "sh":
            places = [folder, *folder.glob("*-plan")]
            for name in _FILE.findall(block.after):
                assert any((place / name).exists() for place in places), f"{name} is not there after {block.text}"
    return printed


@pytest.fixture
def work(tmp_path, monkeypatch):
    """A folder with the samples, and nothing else."""
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told(text):
    """A summary as it is compared: notes change in number, and the path of the page is the reader's."""
    return re.sub(r"^\d+ notes", "N notes", text.partition("\nReview page")[0].rstrip(), flags=re.MULTILINE)


@pytest.mark.slow("plans with all that is found by default")
def test_commands_of_the_readme_run(work):
    (printed,) = follow(read("README.md"), work).values()
    assert printed.startswith("Take ")
    assert (work / "peaks_and_valleys-plan" / "review.html").exists()


@pytest.mark.slow("plans with all that is found by default")
def test_commands_of_the_tutorial_run(work):
    printed = follow(read("docs/tutorial.md"), work)
    assert len(printed) == 4
    (summary,) = [text for command, text in printed.items() if "--answers" in command]
    assert told(summary) == told(read("docs/pictures/summary.txt"))
    assert (work / "map.png").exists()
    assert len(list((work / "drawings").iterdir())) == len(tomllib.loads(read("samples/shop.toml"))["tool"])


def test_the_readme_shows_a_part_of_the_gallery():
    """`docs/gallery.py` writes the command, all that it prints and the headline in one go."""
    (shown,) = [block.text for block in blocks(read("README.md")) if block.kind == "text"]
    (part,) = [row for row in gallery.table()["part"] if row["name"] == gallery.FRONT]
    typed = gallery.printed(part["command"], "").rstrip()
    assert shown.startswith(f"{typed}\n")
    assert " ".join(shown.removeprefix(typed).split()).startswith(
        json.loads(read(f"docs/gallery/{gallery.FRONT}.json"))["headline"]
    )


def spoken(page):
    """Commands that stand in a sentence."""
    return re.findall(r"`(plan-cutters(?: [^`]+)?)`", re.sub(_FENCE, "", page))


@pytest.mark.parametrize("page", ["README.md", "docs/tutorial.md"])
def test_commands_and_options_in_sentences_exist(page):
    for command in spoken(read(page)):
        words = shlex.split(command)[1:]
        assert not words or run(*words, bare=True).returncode == 0, command
    prose = re.sub(_FENCE, "", read(page))
    options = known_options()
    assert set(re.findall(r"`(--?[a-z][\w-]*)", prose)) <= options
    for word in re.findall(r"`sh setup\.sh ?(\w*)`", prose):
        _setup_takes(word)


@pytest.mark.parametrize("page", ["README.md", "docs/tutorial.md"])
def test_commands_in_fences_can_be_typed(page):
    """What they do is run in a part of all runs."""
    typed = [shlex.split(each) for block in blocks(read(page)) if block.kind == "sh" for each in commands(block)]
    mine = [words[1:] for words in typed if words[0].endswith("plan-cutters")]
    assert mine
    for words in mine:
        assert {each.partition("=")[0] for each in words if re.match("--?[a-z]", each)} <= known_options(), words
        assert all((ROOT / each).exists() for each in words if each.startswith("samples/")), words


def known_options():
    """All options of all commands, and -n of setup's tests."""
    from plan_cutters.command import entry

    found = set()
    for name in entry.commands():
        command = entry.module_of(f"plan-cutters {name}").command
        found |= {name for each in command.params for name in (*each.opts, *each.secondary_opts)}
    return found


SPOILT = [
    ("plan-cutters tools samples/shop.toml", "plan-cutters tools samples/shop.toml --drawn"),
    ("plan-cutters tools samples/shop.toml", "plan-cutters tolls samples/shop.toml"),
    ("samples/shop.toml --draw", "samples/shops.toml --draw"),
    ("`drawings/` then has", "`paintings/` then has"),
    ("sh setup.sh\n", "sh setup.sh hots\n"),
    ("```sh\nsh setup.sh", "```sh\ngit clone somewhere\nsh setup.sh"),
    ("`drawings/` then has", "That ends with exit code 1. `drawings/` then has"),
]


@pytest.mark.parametrize(("right", "wrong"), SPOILT)
def test_a_wrong_word_fails(work, right, wrong):
    """Of the tutorial only its beginning: what follows is as long as the whole."""
    beginning = read("docs/tutorial.md").partition("## 3.")[0]
    assert right in beginning
    with pytest.raises(AssertionError):
        follow(beginning.replace(right, wrong), work)


def test_the_beginning_of_the_tutorial_is_right_as_it_stands(work):
    assert len(follow(read("docs/tutorial.md").partition("## 3.")[0], work)) == 1
