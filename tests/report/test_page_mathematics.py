"""The mathematics of the page by itself, under node; and what the page shares with the program."""

import runpy
import subprocess

from tests.support.places import ROOT


def test_the_tests_of_the_page_pass():
    done = subprocess.run(["node", ROOT / "page/test.mjs"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "# fail 0" in done.stdout
    assert "# pass 0" not in done.stdout


def test_codes_and_constants_of_the_page_are_those_of_the_program():
    codes = runpy.run_path(str(ROOT / "page/codes.py"))
    assert codes["FILE"].read_text(encoding="utf-8") == codes["text"](), "run: python page/codes.py"
