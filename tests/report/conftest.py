"""The review page in a browser: modules of tests that have the `path` of a page get a `browser` and, for each test, a `page`."""

import pytest

from tests.support.browser import launch, opened


@pytest.fixture(scope="module")
def playwright():
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")
    with sync_api.sync_playwright() as playwright:
        yield playwright


@pytest.fixture(scope="module")
def browser(playwright):
    browser = launch(playwright)
    yield browser
    browser.close()


@pytest.fixture
def page(browser, path):
    """A page that is ready; in the end it must have said nothing on the console."""
    context = browser.new_context(viewport={"width": 1366, "height": 768}, reduced_motion="reduce")
    page = opened(context, path)
    yield page
    said = page.said
    context.close()
    assert said == []
