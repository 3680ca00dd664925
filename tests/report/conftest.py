"""The review page in a browser: where a module has a `planned` result, or the `path` of a page, tests get a `page`."""

import pytest

from tests.support.browser import SCREENS, opened


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


@pytest.fixture
def at(browser, path):
    """Open the page at a screen in a scheme; in the end no page has said anything on its console."""
    contexts, pages = [], []

    def open_(screen="desk", scheme="light", where=path, **more):
        width, height = SCREENS[screen]
        touch = {"has_touch": True, "is_mobile": True} if screen == "phone" else {}
        viewport = {"width": width, "height": height}
        context = browser.new_context(
            **{"viewport": viewport, "reduced_motion": "reduce", "color_scheme": scheme, **touch, **more}
        )
        contexts.append(context)
        pages.append(opened(context, where))
        return pages[-1]

    yield open_
    for context in contexts:
        context.close()
    assert [page.said for page in pages] == [[]] * len(pages)
