"""The documentation: links resolve, files that are named exist, every decision has a status."""

import importlib
import re
import shlex
import tomllib
from pathlib import Path

import pytest

from mmweaver import PRESETS
from mmweaver.cli.main import build_parser
from mmweaver.core.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")] + [
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "model_cards").glob("*.md")),
    ROOT / "SECURITY.md",
    ROOT / "CODE_OF_CONDUCT.md",
    ROOT / "src" / "mmweaver" / "weights" / "README.md",
]
DECISIONS = sorted(path for path in (ROOT / "docs" / "decisions").glob("*.md") if path.name != "README.md")
SOURCE = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Source"]
# where a file of the repository is found by those who have no clone
OURS = (f"{SOURCE}/blob/main/", f"{SOURCE}/".replace("github.com", "raw.githubusercontent.com") + "main/")
READ_ELSEWHERE = ["README.md", "src/mmweaver/weights/README.md"]  # by PyPI and the Hub; and the model cards
READ_ELSEWHERE += [f"model_cards/{page.name}" for page in sorted((ROOT / "model_cards").glob("*.md"))]
WRITTEN_BY_MAKE_DOCS = ("reference/", "gallery/")
PACKAGE = ROOT / "src" / "mmweaver"


def _prose(page: Path) -> str:
    """The page without its blocks of code."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"^    .*$", "", text, flags=re.MULTILINE)


def _anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as Python-Markdown and GitHub name them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    words = (re.sub(r"[^\w\- ]", "", re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading).lower()) for heading in headings)
    return {re.sub(r"[ ]+", "-", heading.strip()) for heading in words}


def _links(page: Path) -> list[str]:
    """The targets of a page's links and pictures."""
    return re.findall(r"\]\(([^)\s]+)\)", _prose(page))


@pytest.mark.parametrize("name", READ_ELSEWHERE)
def test_pages_that_are_read_elsewhere_have_absolute_links(name: str):
    relative = [target for target in _links(ROOT / name) if not target.startswith(("https://", "#"))]
    assert not relative, f"{name} is shown outside the repository"
    if name == "README.md":
        assert sum(target.startswith(OURS) for target in _links(ROOT / name)) > 15
        assert any(target.startswith(OURS[1]) for target in _links(ROOT / name)), "its picture"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_resolve(page: Path):
    for target in _links(page):
        place, _, anchor = target.partition("#")
        own = next((place.removeprefix(home) for home in OURS if place.startswith(home)), None)
        if own is None and (re.match(r"(https?|mailto):", target) or place.startswith(WRITTEN_BY_MAKE_DOCS)):
            continue
        file = ROOT / own if own is not None else (page.parent / place).resolve() if place else page
        assert file.exists(), f"{page.relative_to(ROOT)} links to {target}"
        if anchor and file.suffix == ".md":
            assert anchor in _anchors(file), f"{page.relative_to(ROOT)} links to {target}"


def _commands(page: Path) -> list[str]:
    """The mmweaver commands of a page's indented blocks, without comments."""
    text = page.read_text(encoding="utf-8").replace("\\\n", " ")
    lines = re.findall(r"^    (.*\bmmweaver .*)$", text, flags=re.MULTILINE)
    parts = [part.strip() for line in lines for part in re.split(r"&&|\||#|;|>", line)]
    return [part for part in parts if part.startswith("mmweaver ") and "..." not in part]


def test_commands_of_pages_are_understood():
    parser = build_parser()
    seen = 0
    for page in PAGES:
        for command in _commands(page):
            words = shlex.split(command)[1:]
            if "--config" in words:  # whose file has the rest
                continue
            try:
                parser.parse_args(words)
            except InputError as error:
                pytest.fail(f"{page.relative_to(ROOT)}: {command}: {error}")
            seen += 1
    assert seen > 100


def test_source_files_that_pages_name_exist():
    """`propagation/reference_sum.py` is named from the package's folder, `studies/run.py` from the repository's."""
    for page in PAGES:
        if page.name == "CHANGELOG.md":  # tells of files as they were
            continue
        for name in re.findall(r"`((?:[\w.]+/)+[\w]+\.(?:py|md|toml))`", _prose(page)):
            assert any((root / name).exists() for root in (ROOT, PACKAGE)), f"{page.relative_to(ROOT)} names {name}"


def test_every_decision_is_listed_once_under_its_title():
    listed = re.findall(r"^- (.*)$", (DECISIONS[0].parent / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    titles = [f"[{page.read_text(encoding='utf-8').splitlines()[0][2:]}]({page.name})" for page in DECISIONS]
    assert sorted(listed) == sorted(titles)


def test_contributing_has_the_packages_in_the_order_of_the_import_contract():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (contract,) = [one for one in settings["tool"]["importlinter"]["contracts"] if one["type"] == "layers"]
    layers = [re.sub(r"[()]", "", layer) for layer in contract["layers"]]
    listed = re.search(r"((?:^      .*\n)+)", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert listed
    assert [line.strip() for line in listed[1].splitlines()] == layers


def test_every_page_is_in_the_navigation_of_the_site():
    navigation = (ROOT / "zensical.toml").read_text(encoding="utf-8")
    for page in sorted((ROOT / "docs").glob("*.md")):
        assert f'"{page.name}"' in navigation, f"add {page.name} to nav in zensical.toml"


def test_every_preset_is_in_the_page_of_radars():
    page = (ROOT / "docs" / "radars.md").read_text(encoding="utf-8")
    for name, radar in PRESETS.items():
        (row,) = [line for line in page.splitlines() if line.startswith("| ") and f"`{name}`" in line]
        first, last = radar.range_m[0], radar.range_m[-1]
        bins = f"{len(radar.range_m)} of {100 * radar.range_resolution_m:.2f} cm, {first:.2f} to {last:.2f} m"
        assert bins.replace(" 0.00 ", " 0 ") in row, name
        assert f"{radar.num_loops} of {radar.velocity_resolution_mps:.3f} m/s" in row, name


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 110


def test_the_site_lists_every_decision_whatever_its_title(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Titles may hold quotation marks; the navigation is read as TOML."""
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    navigation = importlib.import_module("build_docs").decision_navigation
    (tmp_path / "README.md").write_text((ROOT / "docs" / "decisions" / "README.md").read_text(encoding="utf-8"))
    subjects = tomllib.loads(f"nav = [{navigation(tmp_path)}]")["nav"]
    listed = {page for subject in subjects for pages in subject.values() for one in pages for page in one.values()}
    assert listed == {f"decisions/{page.name}" for page in DECISIONS}


def test_the_site_shows_the_readme_with_its_own_pages_and_pictures(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    page = importlib.import_module("build_docs").with_local_links((ROOT / "README.md").read_text(encoding="utf-8"))
    assert not any(home in page for home in OURS)
    assert "](docs/images/studio.png)" in page
