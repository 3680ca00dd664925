"""The page of the house is drawn from the import contracts as they are."""

import subprocess
import sys

from tests.support.places import ROOT


def test_the_page_of_the_house_is_up_to_date():
    done = subprocess.run([sys.executable, "docs/house.py", "--check"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
