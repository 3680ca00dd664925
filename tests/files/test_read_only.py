"""Places that cannot be written to: one line says which, and what to do."""

import errno
import os
import tempfile
from pathlib import Path

import pytest

from plan_cutters.command import map as map_command
from plan_cutters.errors import PlanError
from plan_cutters.report.drawing import posture_map
from plan_cutters_batch import run
from plan_cutters_ci.changed import command as changed


def read_only(*given, **words):
    raise OSError(errno.EROFS, os.strerror(errno.EROFS), *map(str, given[:1]))


@pytest.mark.parametrize(
    "work",
    [lambda: run.opened(None).__enter__(), lambda: changed.main(["--base", "main"], standalone_mode=False)],
    ids=["batch", "changed"],
)
def test_no_folder_for_temporary_files_is_one_line(work, monkeypatch):
    def nowhere():
        raise FileNotFoundError(errno.ENOENT, "No usable temporary directory found")

    monkeypatch.setattr(tempfile, "gettempdir", nowhere)
    with pytest.raises(PlanError, match="name one with TMPDIR") as caught:
        work()
    assert "\n" not in str(caught.value)


def test_a_map_in_a_read_only_folder_names_the_file_that_was_asked_for(tmp_path, monkeypatch):
    monkeypatch.setattr(posture_map, "draw_map", lambda found, tilt, title, lines, asides: read_only(asides[1]))
    monkeypatch.setattr(Path, "unlink", read_only)
    with pytest.raises(PlanError, match="Read-only file system") as caught:
        map_command._draw(None, (0.0, 1.0), ["title"], [tmp_path / "one.png", tmp_path / "two.svg"])
    assert str(caught.value).startswith(str(tmp_path / "two.svg"))


def test_a_cause_that_is_not_the_systems_is_told(tmp_path, monkeypatch):
    """As matplotlib's, where its cache has no place."""

    def without_number(*given):
        raise OSError("a writable cache directory is needed; set MPLCONFIGDIR")

    monkeypatch.setattr(posture_map, "draw_map", without_number)
    with pytest.raises(PlanError, match="set MPLCONFIGDIR"):
        map_command._draw(None, (0.0, 1.0), ["title"], [tmp_path / "one.png"])
