"""The plan that is forged."""

import pytest

from tests.support.written_plan import Written, write


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("operations")
    write(out)
    return out


@pytest.fixture(scope="session")
def written(folder):
    return Written(folder)
