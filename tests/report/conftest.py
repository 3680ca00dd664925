"""The review page in a browser: where a module has a `planned` result, or the `path` of a page, tests get a `page`."""

import pytest

from tests.support.browser import opened


@pytest.fixture(scope="module")
def path(planned, tmp_path_factory):
    """The page of what the module has planned."""
    from plan_cutters.report.page.write import write_html

    path = tmp_path_factory.mktemp("page") / "review.html"
    write_html(planned, None, path)
    return path


@pytest.fixture
def page(browser, path):
    """A page that is ready; in the end it must have said nothing on the console."""
    context = browser.new_context(viewport={"width": 1366, "height": 768}, reduced_motion="reduce")
    page = opened(context, path)
    yield page
    said = page.said
    context.close()
    assert said == []
