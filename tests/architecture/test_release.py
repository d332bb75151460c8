"""What a release says of itself, in every place, is one thing: version, date, addresses."""

import re
import tomllib
from pathlib import Path
from typing import Any

import yaml

from mmweaver.core.constants import __version__

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FORMS = ROOT / ".github" / "ISSUE_TEMPLATE"
README = (ROOT / "README.md").read_text(encoding="utf-8")


def _citation(name: str) -> str:
    """A value of the first level of CITATION.cff."""
    found = re.search(rf'^{name}: "?([^"\n]+)"?$', (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)
    assert found, name
    return found[1]


def test_the_newest_entry_of_the_changelog_is_this_version_with_a_date():
    headings = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    released = [heading for heading in headings if heading != "Unreleased"]
    assert released[0] == f"{__version__} ({_citation('date-released')})"
    assert re.fullmatch(r"\d{4}-\d{2}-\d{2}", _citation("date-released"))
    assert headings.count("Unreleased") <= 1


def test_the_citation_names_version_and_addresses():
    assert _citation("version") == __version__
    assert _citation("repository-code") == PROJECT["urls"]["Source"]
    assert _citation("url") == PROJECT["urls"]["Documentation"]


def test_addresses_of_the_repository_begin_alike():
    urls = PROJECT["urls"]
    assert {"Homepage", "Documentation", "Source", "Issues", "Changelog", "Paper"} == set(urls)
    assert urls["Issues"] == f"{urls['Source']}/issues"
    changelog = urls["Changelog"].removeprefix(f"{urls['Source']}/blob/main/")
    assert (ROOT / changelog).is_file()
    for name in ("SECURITY.md", "CODE_OF_CONDUCT.md", ".github/ISSUE_TEMPLATE/config.yml"):
        text = (ROOT / name).read_text(encoding="utf-8")
        of_hub = set(re.findall(r"https://github\.com/[\w-]+/[\w-]+", text))
        assert of_hub <= {urls["Source"]}, name


def test_the_readme_installs_this_version_with_the_pytorch_that_it_needs():
    assert set(re.findall(r"mmweaver-([\d.]+)-py3", README)) == {__version__}
    (torch,) = [one for one in PROJECT["dependencies"] if one.startswith("torch")]
    assert f'pip install "{torch}" --index-url' in README


def is_older_name(needs: list[str]) -> bool:
    """Whether an extra is another one under the name that it had before."""
    return len(needs) == 1 and needs[0].startswith("mmweaver[")


def test_the_readme_names_every_extra_that_a_command_needs():
    of_developers = {"dev", "docs", "peers", "codecs"}
    (section,) = re.findall(r"^## Install\n(.*?)^## ", README, re.DOTALL | re.MULTILINE)
    named = set(re.findall(r"`(\w+)`", section))
    optional = PROJECT["optional-dependencies"]
    extras = {name for name, needs in optional.items() if not is_older_name(needs)} - of_developers
    assert extras <= named
    assert set(re.findall(r"\[(\w+)\]", section)) <= extras


def _workflow(name: str) -> dict[str, Any]:
    return yaml.safe_load((ROOT / ".github" / "workflows" / name).read_text(encoding="utf-8"))


def test_a_release_has_no_more_rights_than_it_needs_and_is_published_once_somebody_approves():
    release = _workflow("release.yml")
    jobs = release["jobs"]
    assert release["permissions"] == {"contents": "read"}
    assert {name: job["permissions"] for name, job in jobs.items() if "permissions" in job} == {
        "attach": {"contents": "write"}, "publish": {"id-token": "write"},
    }  # fmt: skip
    assert [jobs[name]["needs"] for name in ("test", "attach", "publish")] == ["build", "test", "attach"]
    assert [name for name, job in jobs.items() if "environment" in job] == ["publish"]
    assert not any("checkout" in step.get("uses", "") for step in jobs["test"]["steps"]), "the artifact alone"


def test_actions_of_all_workflows_are_of_one_major_version_each():
    workflows = [_workflow(path.name) for path in sorted((ROOT / ".github" / "workflows").glob("*.yml"))]
    steps = [step for workflow in workflows for job in workflow["jobs"].values() for step in job["steps"]]
    used = {step["uses"] for step in steps if "uses" in step}
    assert all(re.fullmatch(r"actions/[\w-]+@v\d+|pypa/gh-action-pypi-publish@release/v1", action) for action in used)
    assert len({action.partition("@")[0] for action in used}) == len(used)


def test_forms_of_issues_ask_for_what_is_needed():
    forms = {path.stem: yaml.safe_load(path.read_text(encoding="utf-8")) for path in FORMS.glob("*.yml")}
    del forms["config"]
    assert set(forms) == {"bug", "feature", "recording"}
    for form in forms.values():
        assert form["name"]
        assert form["description"]
        assert all(field["type"] in ("input", "textarea") and field["attributes"]["label"] for field in form["body"])
    required = {field["id"] for field in forms["bug"]["body"] if field.get("validations", {}).get("required")}
    assert required == {"version", "command", "input", "expected"}
