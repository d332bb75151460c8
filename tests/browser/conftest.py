"""One studio and one page of it for the tests of a file."""

from collections.abc import Iterator
from typing import Any

import pytest

from tests.browser.chromium import FLAGS, READY, Running, needs_browser, running_studio


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    path = needs_browser()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    needs_browser()
    with running_studio("--workers", "1", log=tmp_path_factory.mktemp("studio") / "log") as found:
        yield found


@pytest.fixture(scope="module")
def visited(browser: Any, address: str) -> Iterator[tuple[Any, list[str], list[str]]]:
    """The page after loading, all requests it made, and what it complained of."""
    page = browser.new_page(viewport={"width": 1280, "height": 860}, bypass_csp=True, reduced_motion="reduce")
    asked: list[str] = []
    complaints: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(address)
    page.wait_for_selector(READY, timeout=120_000)
    yield page, asked, complaints
    page.close()


@pytest.fixture
def page(visited: tuple[Any, list[str], list[str]]) -> Any:
    return visited[0]
