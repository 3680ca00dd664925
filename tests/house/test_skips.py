"""What is skipped fails in CI, unless it is about what `setup.sh dev` does not bring."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.support.places import ROOT

TESTS = {
    "test_program.py": "import pytest\ndef test_page(): pytest.skip('no browser is installed')\n",
    "test_module.py": "import pytest\npytest.importorskip('no_such_module')\ndef test_it(): pass\n",
    "test_mark.py": "import pytest\n@pytest.mark.skipif(True, reason='needs Linux')\ndef test_it(): pass\n",
    "test_brought.py": "import pytest\ndef test_host(): pytest.skip('FreeCAD is not installed (freecadcmd)')\n"
    "@pytest.mark.xfail(strict=True)\ndef test_fault(): assert False\n",
}


@pytest.mark.parametrize(
    ("ci", "code", "summary"),
    [({"CI": "true"}, 1, "1 failed, 1 skipped, 1 xfailed, 2 errors in "), ({}, 0, "4 skipped, 1 xfailed in ")],
    ids=str,
)
def test_a_skipped_test_fails_in_ci(tmp_path, ci, code, summary):
    for name, text in TESTS.items():
        (tmp_path / name).write_text(text)
    shutil.copy(ROOT / "tests/conftest.py", tmp_path)
    words = ["-q", "-rs", "--continue-on-collection-errors", "-p", "no:cacheprovider", "--rootdir", tmp_path, tmp_path]
    inherited = {key: value for key, value in os.environ.items() if key != "CI" and not key.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *map(str, words)], cwd=tmp_path, env={**inherited, **ci, "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stdout.splitlines()[-1].startswith(summary), done.stdout + done.stderr
    assert done.returncode == code
    assert "FreeCAD is not installed" in done.stdout
